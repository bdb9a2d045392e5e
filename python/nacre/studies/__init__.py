"""Studies: many solves over any parameters, to one Dataset, resumable."""

from __future__ import annotations

import inspect
import os
import sys
import warnings
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, Executor, Future
from contextlib import suppress
from difflib import get_close_matches
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Event, Lock
from typing import TYPE_CHECKING, Any

import nacre._core as core
from nacre._tools.arguments import keywords_of
from nacre._tools.extras import extra
from nacre._tools.notices import heard, warn
from nacre._tools.paths import holder, numbers
from nacre._tools.progress import case_progress
from nacre._tools.threads import thread_pool
from nacre.contact import roll, slide, solve, wear
from nacre.contact.solution import Solution
from nacre.fatigue import assess
from nacre.results.journal import Journal, Record
from nacre.results.verdict import verdict_on, worst_of
from nacre.studies.dataset import assemble, failure_lines, layout
from nacre.studies.identity import Identity, identity_of, key_of
from nacre.studies.outputs import (
    CONDUCTANCES,
    FATIGUES,
    MARGINS,
    STRESSES,
    USUAL,
    CaseKind,
    Output,
    check_direction,
    output_values,
    outputs_by_name,
    plain,
    rolls,
    with_conductance,
)

if TYPE_CHECKING:
    import xarray

    from nacre.contact.friction import FrictionSolution
    from nacre.contact.wear_solution import WearHistory

Case = Mapping[str, object] | Callable[..., Mapping[str, object]]

ARGUMENTS = frozenset(inspect.signature(solve).parameters)
SLIDE = frozenset(inspect.signature(slide).parameters) - ARGUMENTS
ROLL = frozenset(inspect.signature(roll).parameters) - ARGUMENTS
"""Arguments of contacts with friction besides those of `nacre.solve`."""
WEAR = frozenset(inspect.signature(wear).parameters) - {"store", "progress"}
"""Arguments of wear in a study, which has a store of its own."""
NOTES = frozenset(("progress", "check"))
"""Keywords of what a solve says, which studies say themselves."""
STRESS = keywords_of(Solution.stress_summary) - {*NOTES, "threads"}
FATIGUE = keywords_of(assess) - {*NOTES, "threads", "depths"}
CONDUCTANCE = keywords_of(Solution.conductance)
"""Keywords of stresses, fatigue and conductance that studies take."""
OPTIONS: dict[str, tuple[str, Collection[str], Iterable[str]]] = {
    "stress": ("stress_summary", STRESS, STRESSES),
    "fatigue": ("assess", FATIGUE, (*FATIGUES, *MARGINS)),
    "conductance": ("Solution.conductance", CONDUCTANCE, CONDUCTANCES),
}
"""Function, keywords and outputs of each mapping of arguments for outputs."""
UNCOMPARED = (
    "outputs use what cannot be compared with an earlier run: {}; all cases are solved again. Give "
    "version=..., and change it whenever the outputs change"
)
CANCELLED = (
    "the executor has cancelled a case, as a cluster does that is closed or lost; with a store, "
    "the same call solves what is not finished"
)
"""Error of cases that are neither finished nor failed."""


def sweep(
    case: Case,
    parameters: Mapping[str, object],
    *,
    outputs: Sequence[Output] | Mapping[str, Output] | None = None,
    stress: Mapping[str, object] | None = None,
    fatigue: Mapping[str, object] | None = None,
    conductance: Mapping[str, object] | None = None,
    store: str | os.PathLike[str] | None = None,
    version: str | int | None = None,
    executor: Executor | None = None,
    progress: bool | None = None,
    retry: bool = False,
) -> xarray.Dataset:
    """Study that solves every combination of parameters; needs ``nacre-contact[files]``.

    A case that fails is recorded, and does not stop the others. With a `store`, a study that was
    killed continues when the same call is made again.

    Parameters
    ----------
    case : callable or mapping
        Function that takes the parameters by name and returns the arguments of `nacre.solve` as a
        dictionary; it runs in this process, the solves in `executor`. Or a mapping of those
        arguments, some of which the parameters replace. Arguments of `nacre.slide` or `nacre.roll`
        make contacts with friction; of a history, the last step counts. Those of `nacre.wear`, with
        a ``rate``, make histories of wear. Arguments of `nacre.indent.solve`, with a tip, make
        indentations; a ``bearing`` of `nacre.bearing` and the keywords of its ``solve`` make
        bearings.
    parameters : mapping
        Values by name: a sequence, of numbers or of anything else (shapes, bodies); a dictionary of
        labels and values; or an `xarray.DataArray`, whose dimensions are kept: two that share one
        vary together. All others are combined. Beside arguments of a mapping, a name may be the
        path of a number in one, such as ``"body.layers[0].thickness"``, ``"tip.radius"`` or
        ``"bearing.clearance"``.
    outputs : sequence or mapping, optional
        Outputs that are kept of each solution: names of its attributes, and functions of it that
        return a number or an array, by name. By default load, approach, tilt, eccentricity, peak
        pressure and its position, and contact area, except for parameters. Outputs of the stresses
        are the largest values anywhere, ``"von_mises"``, ``"tension"`` (principal) and
        ``"max_shear"``; the largest tension in a layer, ``"coating_tension"``; and the largest
        tractions at an interface, ``"interface_shear"`` and ``"interface_tension"``. The last three
        are NaN without layers. Outputs of `nacre.fatigue` are the largest yield stresses in shear
        that the layers or the substrate need, ``"shakedown"`` and ``"substrate_shakedown"``; the
        largest ranges ``"orthogonal_shear"`` and ``"interface_shear_range"``; and the smallest of
        the safety factors, ``"shakedown_safety_factor"``, ``"first_yield_safety_factor"`` and
        ``"fatigue_safety_factor"``, NaN without a yield stress or criteria. With friction,
        attributes of `FrictionSolution` are outputs, too: ``"force"``, ``"torque"``, ``"shift"``,
        ``"twist"``, ``"creepage"``, ``"dissipated"``.
        Outputs of `conductance` are ``"resistance"`` and ``"conductance"``, with wear at the end.
        Outputs of wear are ``"life"``, the distance or the number of cycles or passes after which
        the first layer is through, NaN where none is until the end; ``"worn_volume"``, of both
        bodies together; and ``"deepest"``, ``"peak_pressure"``, ``"contact_area"``,
        ``"approach"``, ``"load"`` and ``"distance"``, at the end.
        Outputs of an indentation are numbers of `nacre.indent.IndentSolution`, by default load,
        approach, radius, stiffness and central pressure; ``"pull_off_load"`` is NaN without
        adhesion. Outputs of a bearing are numbers of `nacre.bearing.BearingSolution`, by default
        displacement, tilt, largest load, peak and edge pressure; ``"reference_life"`` is that of
        ISO/TS 16281.
    stress : mapping, optional
        Arguments of `Solution.stress_summary` for the outputs of stresses: ``body``, ``friction``,
        ``direction``, ``residual``, ``refine``; and limits, ``yield_stress``, ``strength``,
        ``bond_strength``, for the verdict on each case.
    fatigue : mapping, optional
        Arguments of `nacre.fatigue.assess` for the outputs of fatigue: ``criteria``,
        ``shear_yield``, ``friction``, ``direction``, ``residual``, ``body``, ``x``, ``rule``.
    conductance : mapping, optional
        Arguments of `Solution.conductance` for its outputs: ``conductivity``,
        ``counter_conductivity``, ``film``, ``kind``.
    store : path, optional
        File, ``.nc``, for the finished Dataset: a new one, or a study that is continued and
        replaced. Finished cases are kept beside it at once, in a ``.journal``. A case is solved
        again if its arguments have changed, or the source text of an output function, its defaults,
        the values of its closure or the object that it is bound to. Where these cannot be compared
        with an earlier run (an open file, a lock, a function without source text), a
        `nacre.NacreWarning` says so, and all cases are solved again unless there is a `version`.
        Nothing else is compared: not globals, nor other functions and classes that a function uses,
        nor libraries and files.
    version : str or int, optional
        Version of the output functions: change it when what they use has changed, and all cases are
        solved again. With a version, what cannot be compared counts as unchanged.
    executor : concurrent.futures.Executor, optional
        Executor of the solves; a thread for each core by default. Each solve has one thread, unless
        the case has `threads`.
    progress : bool, optional
        Whether to show the progress on standard error: a bar in a terminal or a notebook, elsewhere
        a line each minute at most. By default, there is no line in the first minute.
    retry : bool, optional
        Whether to try cases again that failed in an earlier run.

    Returns
    -------
    xarray.Dataset
        Outputs with the parameters as coordinates. Where a case failed they are NaN, and ``error``
        holds the reason; ``warnings`` holds the warnings of each solve. With limits, ``verdict`` is
        the level of each case, as `Verdict.level`, "" where it failed. Peak pressure, approach and
        load, resistance and conductance, peak and edge pressure of bearings, what
        `FrictionReport.discretisation` has, and stresses and ranges of stress have their errors due
        to the size of the cells next to them, such as ``peak_pressure_discretisation``, NaN where
        there is no estimate. The executor does not change a bit.

    Warns
    -----
    NacreWarning
        If cases failed or have warnings: a line with their numbers by kind.

    Raises
    ------
    ValueError
        If parameters or outputs cannot be used, or the store has another ending, or is a file but
        no study.
    TypeError
        If the case does not describe a solve, or an argument is of the wrong kind.
    FileNotFoundError
        If the folder of the store does not exist.
    BlockingIOError
        If another call writes the store, in this process or in another.
    concurrent.futures.CancelledError
        If the executor cancels a case, as a cluster does that is closed or lost.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> def ball(thickness, young):
    ...     coating = nacre.Layer(nacre.Elastic(young, 0.3), thickness)
    ...     body = nacre.HalfSpace(steel, layers=[coating])
    ...     return dict(shape=nacre.Sphere(5e-3), body=body, load=10.0)
    >>> study = nacre.sweep(ball, {"thickness": [5e-6, 20e-6], "young": [105e9, 420e9]})
    >>> (study.peak_pressure / 1e9).round(2).values
    array([[1.53, 1.65],
           [1.36, 1.82]])
    """
    with extra("files"):
        import xarray  # noqa: F401

    if not (callable(case) or isinstance(case, Mapping)):
        raise TypeError(f"case must be callable or a mapping of arguments, got {case!r}")
    path = None if store is None else Path(store)
    if path is not None and path.suffix.lower() != ".nc":
        raise ValueError(f"store must end in .nc, got {str(store)!r}")
    _check_store(path)
    coordinates, points = layout(parameters)
    if isinstance(case, Mapping):
        _check_paths(case, points)
    checked_outputs = _checked_outputs(case, points, parameters, outputs)
    options = _options(checked_outputs, stress=stress, fatigue=fatigue, conductance=conductance)
    version = _checked_version(version)
    identity = identity_of(checked_outputs, options, version)
    again = bool(identity.unknown) and version is None
    if again and path is not None:
        warn(UNCOMPARED.format(", ".join(identity.unknown)))
    journal = Journal(path.with_suffix(".journal") if path else None)
    with journal, heard():  # the Dataset has them

        def is_stored(key: str) -> bool:
            record = journal.records.get(key)
            return record is not None and not (again or (retry and "error" in record))

        keys, tasks, failures = _cases(case, points, options["stress"], identity, is_stored)
        for record in failures.values():
            journal.add(record)

        def keep(key: str, result: Record) -> None:
            journal.add({"key": key, "parameters": tasks[key][1], **result})

        arguments_of = {key: arguments for key, (arguments, _) in tasks.items()}
        stored = len(set(keys)) - len(tasks) - len(failures)
        with case_progress(progress, stored + len(tasks), stored) as advance:
            for _ in _run(arguments_of, checked_outputs, options, executor, keep):
                advance()
        records = [journal.records[key] for key in keys]
        dataset = assemble(coordinates, records, checked_outputs, isinstance(case, Mapping))
        if path is not None:
            from nacre._tools.disk import STUDY, replacing, write_dataset

            _check_store(path)  # hours later
            with replacing(path) as temporary:
                write_dataset(dataset, temporary, STUDY)
    for line in failure_lines(records):
        warn(line)
    return dataset


def _check_store(path: Path | None) -> None:
    """Raise an error if the store has no folder, or something that is no study has its name."""
    from nacre._tools.disk import check_folder, is_study

    if path is None:
        return
    check_folder(path)
    if path.exists() and not is_study(path):
        raise ValueError(
            f"store must be a new file or a study, got {str(path)!r}, which is neither"
        )


def _checked_outputs(
    case: Case,
    points: Sequence[dict[str, object]],
    parameters: Mapping[str, object],
    outputs: Sequence[Output] | Mapping[str, Output] | None,
) -> dict[str, Output]:
    """Return the outputs by name, by default the usual ones of what is solved."""
    kind = _case_kind(case, points) if outputs is None or isinstance(case, Mapping) else None
    usual = [name for name in USUAL[kind or "contact"] if name not in parameters]
    by_name = outputs_by_name(usual if outputs is None else outputs, kind)
    if clashes := set(by_name) & set(parameters):
        raise ValueError(f"outputs must have other names than parameters, got {sorted(clashes)}")
    return by_name


def _options(
    outputs: Mapping[str, Output], **given: Mapping[str, object] | None
) -> dict[str, dict[str, object]]:
    """Return the arguments of stresses, fatigue and conductance that are used by some output."""
    words = {output for output in outputs.values() if isinstance(output, str)}
    options = {}
    for name, (function, keywords, names) in OPTIONS.items():
        options[name] = {**(given[name] or {})} if words.intersection(names) else {}
        if unknown := options[name].keys() - keywords:
            raise TypeError(f"{name} must hold arguments of {function}, got {sorted(unknown)}")
    if words.intersection(CONDUCTANCES) and not options["conductance"]:
        raise TypeError(f"conductance must be given for the outputs {', '.join(CONDUCTANCES)}")
    return options


def _checked_version(version: object) -> str | int | None:
    """Return a version with Python's integer, or raise an error."""
    if isinstance(version, str | None):
        return version
    try:
        return core.integer("version", version)
    except TypeError:
        raise TypeError(f"version must be a text or an integer, got {version!r}") from None


def _cases(
    case: Case,
    points: Sequence[dict[str, object]],
    stress: Mapping[str, object],
    identity: Identity,
    is_stored: Callable[[str], bool],
) -> tuple[list[str], dict[str, tuple[dict[str, object], dict[str, object]]], dict[str, Record]]:
    """Return the key of each case; arguments and parameters of those to solve; and failures."""
    keys: list[str] = []
    tasks: dict[str, tuple[dict[str, object], dict[str, object]]] = {}
    failures: dict[str, Record] = {}
    for point in points:
        arguments, failure = _describe(case, point, stress)
        key = key_of(arguments if failure is None else {"failed": point}, identity)
        keys.append(key)
        if is_stored(key):
            continue
        if failure is not None:
            failures[key] = {"key": key, "parameters": _readable(point), "error": failure}
        else:
            tasks[key] = arguments, _readable(point)
    return keys, tasks, failures


def _describe(
    case: Case, point: dict[str, Any], stress: Mapping[str, Any]
) -> tuple[dict[str, object], str | None]:
    """Return the arguments of a solve, or the reason why the case has none."""
    try:
        arguments = _arguments(case, point)
        check_direction(arguments, **stress)
    except (ValueError, ArithmeticError) as error:
        return {}, _reason(error)
    if "tip" in arguments:
        from nacre.indent import solution as indentation

        if unknown := arguments.keys() - inspect.signature(indentation.solve).parameters:
            raise TypeError(
                f"case must give arguments of nacre.indent.solve beside a tip, "
                f"got {sorted(unknown)}"
            )
        return arguments, None
    if "bearing" in arguments:
        from nacre.bearing.bearings import Solvable

        allowed = {"bearing", *keywords_of(Solvable.solve)} - NOTES
        if unknown := arguments.keys() - allowed:
            raise TypeError(
                f"case must give keywords of the solve of a bearing beside it, "
                f"got {sorted(unknown)}"
            )
        return {"threads": 1, **arguments}, None
    if "rate" in arguments:
        if surplus := arguments.keys() - WEAR:
            raise TypeError(
                f"case must give arguments of nacre.wear without store and progress beside a rate, "
                f"got {sorted(surplus)}"
            )
        return {"threads": 1, **arguments}, None
    unknown = set(arguments) - ARGUMENTS
    frictionless = unknown and not {"friction", "steps"} & unknown
    if frictionless or (unknown - SLIDE and unknown - ROLL):
        raise TypeError(
            f"case must give arguments of nacre.solve, nacre.slide, nacre.roll, nacre.wear or "
            f"nacre.indent.solve, got {sorted(unknown)}"
        )
    return {"threads": 1, **arguments}, None


def _arguments(case: Case, point: Mapping[str, object]) -> dict[str, object]:
    """Return the arguments of a solve; names with dots or brackets are paths in a mapping."""
    if not isinstance(case, Mapping):
        keywords = case(**point)
        if not isinstance(keywords, Mapping):
            raise TypeError(
                "case must return the arguments of a solve as a mapping, such as "
                f"dict(shape=..., body=..., load=...), got {keywords!r:.80}"
            )
        return dict(keywords)
    arguments, paths = _split_paths(case, point)
    for path in paths:
        arguments |= core.with_value(_holder(arguments, path), path, point[path])
    if isinstance(fields := arguments.get("bearing"), dict):  # made once: its numbers go together
        arguments["bearing"] = type({**case, **point}["bearing"])(**fields)
    return arguments


def _split_paths(
    case: Mapping[str, object], point: Mapping[str, object]
) -> tuple[dict[str, object], list[str]]:
    """Return arguments before the numbers at paths are replaced, and the paths.

    A bearing that holds such numbers is a dictionary of its fields.
    """
    paths = [name for name in point if "." in name or "[" in name]
    arguments = {**case, **{name: value for name, value in point.items() if name not in paths}}
    if any(path.startswith("bearing.") for path in paths):
        with suppress(KeyError, AttributeError):  # no bearing: the path says so
            bearing: Any = arguments["bearing"]
            arguments["bearing"] = bearing._arguments()
    return arguments, paths


def _holder(arguments: Mapping[str, object], path: str) -> dict[str, object]:
    """Return the argument that holds the number at a path; a bearing may have None there."""
    if path.startswith("bearing."):
        with suppress(LookupError):
            if core.at(arguments, path) is None:
                return {"bearing": arguments["bearing"]}
    return holder(arguments, path, "parameters", "the case")


def _check_paths(case: Mapping[str, object], points: Sequence[Mapping[str, object]]) -> None:
    """Raise a `ValueError` if a path leads to a number in none of the cases."""
    for path in _split_paths(case, points[0])[1]:
        wrong: ValueError | None = None
        for point in points:
            arguments, _ = _split_paths(case, point)
            try:
                _holder(arguments, path)
                break
            except ValueError as error:
                wrong = wrong or error
        else:
            fields = arguments.get("bearing")
            unset = [k for k, v in fields.items() if v is None] if isinstance(fields, dict) else []
            names = [*numbers(arguments), *(f"bearing.{name}" for name in unset)]
            nearest = get_close_matches(path, names, cutoff=0.0)
            raise ValueError(f"{wrong}; the nearest are {', '.join(nearest)}")


def _case_kind(case: Case, points: Sequence[Mapping[str, object]]) -> CaseKind:
    """Return what the cases of a study are, as the first one that is a case."""
    names: set[str] = set()
    if isinstance(case, Mapping):
        names = {*case}.union(*points[:1])
    else:
        for point in points:
            with suppress(ValueError, ArithmeticError):
                names = {*_arguments(case, point)}
                break
    kinds: dict[str, CaseKind] = {"tip": "indent", "bearing": "bearing", "rate": "wear"}
    return next((kind for name, kind in kinds.items() if name in names), "contact")


def _readable(point: Mapping[str, object]) -> dict[str, object]:
    """Return parameters as readable values for the journal."""
    return {k: v if isinstance(v, int | float | str) else repr(v) for k, v in point.items()}


def _run(
    tasks: Mapping[str, dict[str, object]],
    outputs: Mapping[str, Output],
    options: Mapping[str, dict[str, object]],
    executor: Executor | None,
    keep: Callable[[str, Record], None],
) -> Iterator[None]:
    """Solve all tasks; keep their records one at a time, and yield after each.

    A record is kept by the thread that solved it, before that thread begins another case: a kill
    loses only the cases that are being solved.
    """
    pool = executor or thread_pool(default_threads())
    futures: list[Future[Record]] = []
    endings: SimpleQueue[BaseException | None] = SimpleQueue()
    turn, stopped = Lock(), Event()

    def end(key: str, future: Future[Record]) -> None:
        try:
            with turn:
                keep(key, _record(future, tasks[key]))
        except BaseException as error:  # from the executor or the disk: raised below
            endings.put(error)
        else:
            endings.put(None)

    def submit() -> None:
        try:
            for key, arguments in tasks.items():
                if stopped.is_set():
                    return
                task = arguments, dict(outputs), dict(options), os.getpid()
                futures.append(pool.submit(_solve, *task))
                futures[-1].add_done_callback(partial(end, key))
        except BaseException as error:  # from the executor: raised below
            endings.put(error)

    # Ctrl-C interrupts only the main thread. No case is submitted there, so that every case that
    # begins is also kept.
    submitter = thread_pool(1)
    submitter.submit(submit)
    try:
        for _ in tasks:
            while True:
                with suppress(Empty):
                    failure = endings.get(timeout=0.5)  # Ctrl-C is seen in between
                    break
            if failure is not None:
                raise failure
            yield
    finally:
        stopped.set()
        submitter.shutdown()
        for future in futures:
            future.cancel()
        if executor is None:
            pool.shutdown()


def _record(future: Future[Record], arguments: Mapping[str, Any]) -> Record:
    """Return the record of a case; it has failed if each worker of Dask that tried it died."""
    try:
        return future.result()
    except getattr(sys.modules.get("distributed"), "KilledWorker", ()) as error:
        return {"error": _reason(error)} | _marks(arguments)
    except CancelledError as error:
        raise CancelledError(CANCELLED) from error


def default_threads() -> int:
    """Return how many threads plans have by default."""
    return core.Convolution([[1.0]], None).threads()


def _solve(
    arguments: dict[str, Any],
    outputs: dict[str, Output],
    options: dict[str, dict[str, Any]],
    parent: int,
) -> Record:
    """Solve one case, in any process; return its outputs, or the reason why it failed."""
    if os.getpid() != parent:
        warnings.filterwarnings("ignore", category=core.NacreWarning)  # the record has them
    try:
        if "tip" in arguments:
            from nacre.indent import solution as indentation

            contacts = indentation.solve(**arguments)
            notes = {
                "warnings": list(contacts.warnings),
                "kinds": ["steep"] * len(contacts.warnings),
            }
            return {"values": plain(contacts, outputs, "indent"), "indents": True} | notes
        if "bearing" in arguments:
            keywords = {**arguments}
            solved = keywords.pop("bearing").solve(**keywords)
            messages = list(solved.report.warnings)
            notes = {"warnings": messages, "kinds": ["bearing"] * len(messages)}
            notes |= _verdict([solved])
            return {"values": plain(solved, outputs, "bearing"), "bears": True} | notes
        if "rate" in arguments:
            return _wear_outputs(wear(**arguments), outputs, options["conductance"])
        solution = _solution(arguments)
        normal = solution if isinstance(solution, Solution) else solution.normal
        summaries: list[Any] = []
        threads = {"threads": arguments["threads"]}
        rate = partial(assess, solution, **threads, **options["fatigue"])
        values = output_values(solution, outputs, threads | options["stress"], summaries, rate)
        unresolved = [text for summary in summaries for text in summary.warnings]
        values, units = with_conductance(values, normal, outputs, options["conductance"])
        kinds = [warning["kind"] for warning in normal.report.to_dict()["warnings"]]
        record = {
            "values": values,
            "warnings": normal.report.warnings + unresolved,
            "kinds": kinds + ["unresolved stress"] * len(unresolved),
        } | units
        rolling = not isinstance(solution, Solution) and rolls(solution)
        marks = {"line": normal.report.grid.is_line, "rolls": rolling}
        marked = {name: True for name, holds in marks.items() if holds}
        return record | marked | _verdict(summaries)
    except Exception as error:  # whatever it is, the other cases go on
        return {"error": _reason(error)} | _marks(arguments)


def _verdict(results: Sequence[object]) -> Record:
    """Return the worst level of the verdicts on results whose limits are given."""
    verdicts = [verdict for verdict in map(verdict_on, results) if verdict and verdict.question]
    worst = worst_of(verdicts)
    return {"verdict": worst.level} if worst else {}


def _marks(arguments: Mapping[str, Any]) -> Record:
    """Return what the record of a case that failed tells of its kind, by its arguments."""
    grid = arguments.get("grid")
    marks = {
        "indents": "tip" in arguments,
        "bears": "bearing" in arguments,
        "wears": "rate" in arguments,
        "counts": any(arguments.get(name) is not None for name in ("cycles", "passes")),
        "line": isinstance(grid, core.Grid) and grid.is_line,
    }
    return {name: True for name, holds in marks.items() if holds}


def _wear_outputs(
    history: WearHistory, outputs: dict[str, Output], conductance: dict[str, Any]
) -> Record:
    """Return the outputs and the warnings of a history of wear."""
    marks = {
        "wears": True,
        "counts": history.unit != "m",
        "line": history.states[0].solution.grid.is_line,
    }
    worn, values = history.states[-1].solution, plain(history, outputs, "wear")
    values, units = with_conductance(values, worn, outputs, conductance)
    return (
        {
            "values": values,
            "warnings": list(history.warnings),
            "kinds": ["wear"] * len(history.warnings),
        }
        | units
        | {name: True for name, holds in marks.items() if holds}
    )


def _solution(arguments: dict[str, Any]) -> Solution | FrictionSolution:
    """Return the solution of a case: with friction where it has any, and the last of a history."""
    own = set(arguments) - ARGUMENTS
    if not own:
        return solve(**arguments)
    solved = slide(**arguments) if own <= SLIDE else roll(**arguments)
    last: FrictionSolution = solved[-1] if isinstance(solved, list) else solved
    return last


def _reason(error: Exception) -> str:
    """Return an error as a text that every file can hold."""
    text = f"{type(error).__name__}: {error}".replace("\0", "\\0")
    return text.encode("utf-8", "backslashreplace").decode()
