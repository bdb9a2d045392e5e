"""Results of a case and their report, for the command line and the page."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import nacre
from nacre._tools.groups import keyword_units
from nacre.bearing import BearingSolution, Film, PairSolution, film_thickness
from nacre.bearing.geometry import RINGS, Ring
from nacre.cards import numbers_of
from nacre.case import Case, CaseError
from nacre.contact.stresses import StressPlan
from nacre.fatigue.criteria import Criterion
from nacre.indent.solution import solve as solve_indentation
from nacre.results import report
from nacre.results.rows import Row, remark

Results = dict[str, Any]
Options = Mapping[str, Any]
DEPTH_OPTIONS = ("body", "friction", "direction", "residual")
"""Keywords of stresses that pictures over depth take, too."""


def results_of(case: Case, arguments: Options, options: Options | None = None) -> Results:
    """Return the results of a case by name, the solution first.

    `options` are further keywords of what takes long: `progress`, `threads`.

    Raises
    ------
    CaseError
        If a result is refused; it names the table of the case.
    """
    return SOLVERS[case.kind](case, dict(arguments), dict(options or {}))


@contextmanager
def naming(case: Case, name: str) -> Iterator[None]:
    """Raise errors of a calculation as a `CaseError` that names a table of the case."""
    try:
        yield
    except (ArithmeticError, TypeError, ValueError) as error:
        # The notes of an error name the step of a history.
        words = ": ".join([name, *getattr(error, "__notes__", []), str(error)])
        raise CaseError(f"{case.name}: {words}") from error


def _contact(case: Case, arguments: Options, options: Options) -> Results:
    name = case.friction or "solve"
    with naming(case, name):
        results = {"solution": getattr(nacre, name)(**arguments, **options)}
    return results | of_last(case, last_of(results["solution"]), options)


def of_last(case: Case, last: Any, options: Options, plan: StressPlan | None = None) -> Results:
    """Return the stresses, the fatigue and the conductance of a contact that the case asks for.

    A plan of the stresses, which cells of the grid alone have, saves the time to make one.
    """
    results = {}
    if (keywords := case.stress()) is not None:
        with naming(case, "stress"):
            if plan is None or keywords.get("refine"):
                results["stress"] = last.stress_summary(**keywords, **options)
            else:
                others = {k: v for k, v in keywords.items() if k not in ("body", "refine")}
                results["stress"] = plan.summary(**others, **options)
    if (keywords := case.fatigue()) is not None:
        with naming(case, "fatigue"):
            results["fatigue"] = nacre.fatigue.assess(last, **keywords, **options)
    if (keywords := case.conductance()) is not None:
        with naming(case, "conductance"):
            required = keywords.pop("required_resistance", None)
            conductance = last._normal.conductance(**keywords)
            results["conductance"] = replace(conductance, required_resistance=required)
    return results


def _wear(case: Case, arguments: Options, options: Options) -> Results:
    with naming(case, "wear"):
        history = nacre.wear(**arguments, **options)
    history = replace(history, required_distance=case.required_distance())
    return {"wear": history} | of_last(case, history.states[-1].solution, options)


def _bearing(case: Case, arguments: Options, options: Options) -> Results:
    keywords = dict(arguments)
    bearing = keywords.pop("bearing")
    with naming(case, "bearing"):
        solution = bearing.solve(**keywords, **options)
    return rated(case, solution)


def rated(case: Case, solution: Any, has_film: bool = True) -> Results:
    """Return a solved bearing that knows the life and the film of the case, and these two."""
    results = {"bearing": solution}
    if (keywords := case.life()) is not None:
        with naming(case, "bearing"):
            results["life"] = solution.life(**keywords)
        results["bearing"] = replace(results["bearing"], _life=results["life"])
    if has_film and (keywords := case.film()) is not None:
        with naming(case, "bearing.film"):
            results["film"] = _film(solution, **keywords)
        results["bearing"] = replace(results["bearing"], _film=results["film"])
    return results


def _film(solution: BearingSolution, ring: Ring, **keywords: float) -> Film:
    """Return the film in the heaviest contact of a ring."""
    heaviest = solution.loads[:, RINGS.index(ring)].argmax()
    if (contact := solution.contact(int(heaviest), ring)) is None:
        raise ValueError("no element is loaded, so that there is no film")
    return film_thickness(contact, **keywords)


def _indentation(case: Case, arguments: Options, options: Options) -> Results:
    with naming(case, "indent"):
        progress = options.get("progress")
        return {"indent": solve_indentation(**arguments, progress=progress)}


SOLVERS: dict[str, Callable[[Case, Options, Options], Results]] = {
    "contact": _contact,
    "wear": _wear,
    "bearing": _bearing,
    "indent": _indentation,
}
"""Functions of the kinds of cases."""


def last_of(outcome: object) -> Any:
    """Return a solution, the last one of a history."""
    return outcome[-1] if isinstance(outcome, nacre.types.History) else outcome


def report_of(case: Case, results: Results, text: str, name: str, files: report.Rows) -> str:
    """Return the report of the results of a case, whose file is `text`.

    Its files are those of `files_of`.
    """
    tables = {"stress": case.stress(), "fatigue": case.fatigue()}
    tables["conductance"] = case.conductance()
    if tables["stress"] is not None:
        cards_or_numbers = tables["stress"].get("yield_stress")
        tables["stress"]["yield_stress"] = numbers_of(cards_or_numbers, "yield_stress")
    of_stress = {} if case.kind == "wear" else tables["stress"] or {}
    sliding = {k: v for k, v in of_stress.items() if k in DEPTH_OPTIONS}
    cards = [
        remark(f"{card.name}, {words}", text)
        for card in case.cards()
        for words, text in [("material", card.title), *card.numbers_in_words]
    ]
    units = keyword_units(nacre.Solution.stress_summary, nacre.fatigue.assess, Criterion)
    if (conductance := results.get("conductance")) is not None:
        units |= conductance._si_units()
    rows = [
        remark("units of the case", case.units),
        *files,
        *cards,
        *report.input_rows(tables, units),
    ]
    shown = dict(results)
    if isinstance(shown.get("bearing"), PairSolution):
        shown.pop("life", None)  # the pair has it among its own numbers
    return report.text(name, [*shown.values()], text, rows, sliding, case.signed)


def files_of(case: Case) -> list[Row]:
    """Return the measured files that a case names, with their SHA-256."""
    return [
        remark(str(path), f"SHA-256 {hashlib.sha256(path.read_bytes()).hexdigest()}")
        for path in case.measured()
    ]
