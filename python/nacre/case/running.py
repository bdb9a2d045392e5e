"""What the commands of `nacre.case.commands` do: solve, sweep and indent, save and print."""

from __future__ import annotations

import json
import sys
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import typer

import nacre
from nacre._tools.disk import FILMS, PICTURES, replacing
from nacre._tools.notices import heard
from nacre._tools.progress import alive
from nacre._tools.units import printable, system
from nacre.bearing.pair import NAMES
from nacre.bearing.solution import ASKED
from nacre.case import Case, CaseError
from nacre.case.bearing import ENCODED, scaled, sizes_of
from nacre.case.results import Results, files_of, last_of, naming, report_of, results_of
from nacre.indent.solution import IndentSolution
from nacre.results import files, tables
from nacre.results.display import SLIGHT, aligned, column, shown_in
from nacre.results.quantities import ERROR
from nacre.results.shown import TableResult
from nacre.results.values import result_class
from nacre.results.verdict import verdict_on
from nacre.studies.outputs import check_direction
from nacre.studies.report import save_report

ARTICLES = {"bearing": "a bearing", "indent": "an indentation"}
SAVED = {"contact": {".nc", ".vtr", ".csv", ".html", *PICTURES}}
SAVED["wear"] = SAVED["contact"] | {*FILMS}
"""Endings of the files of contacts and of their wear."""
ROWS = 30
"""Largest number of cases of a study that are printed."""


def solve(
    case: Path, save: Sequence[Path], initial: Path | None, units: str | None, as_json: bool
) -> None:
    """Solve the contact, wear, indentation or bearing of a case file."""
    case_file = _read_case(case, units)
    _solve_kind(case, case_file, save, initial, as_json)
    if case_file.has_sweep:
        print(f"nacre: {case}: nacre sweep solves the study in [sweep]", file=sys.stderr)


def _solve_kind(
    case: Path, case_file: Case, save: Sequence[Path], initial: Path | None, as_json: bool
) -> None:
    """Solve what a case file is."""
    if case_file.kind not in SAVED:
        if initial is not None:
            raise CaseError(f"{case}: --initial must not be given for {ARTICLES[case_file.kind]}")
        solve_case = _solve_bearing if case_file.kind == "bearing" else _solve_indentation
        solve_case(case, case_file, save, as_json)
        return
    arguments = case_file.arguments()
    case_file.fatigue()  # whose limits are checked before the solve
    if initial is not None:
        try:
            arguments["initial"] = nacre.load(initial)
        except (OSError, ValueError) as error:
            raise typer.BadParameter(str(error), param_hint="'--initial'") from error
    for path in save:
        _check_ending(path, SAVED[case_file.kind])
    try:
        check_direction(arguments, **(case_file.stress() or {}))
    except ValueError as error:
        raise CaseError(f"{case}: stress: {error}") from error
    solve_contact = _solve_wear if case_file.kind == "wear" else _solve
    with nacre.display_units(case_file.units):
        solve_contact(case, case_file, arguments, save, as_json)


def _read_case(case: Path, units: str | None) -> Case:
    """Return the case of a file, in other units if these are given."""
    case_file = Case.read(case)
    return case_file if units is None else case_file.in_units(units)


def _solve_bearing(case: Path, case_file: Case, save: Sequence[Path], as_json: bool) -> None:
    """Solve a bearing, save and print it, with its life and a film where they are asked for."""
    for path in save:
        if path.suffix.lower() == ".vtr":
            raise CaseError(
                f"{case}: --save of a bearing must end in .nc, .csv, .html or as a picture"
            )
        _check_ending(path, SAVED["contact"])
    with heard(), alive():  # the printed solution has them
        results = results_of(case_file, case_file.arguments())
    solution = results["bearing"]
    added = {name: result for name, result in results.items() if result is not solution}
    if as_json:
        # What was asked for has names of its own.
        left = {"format", "kind", "lamina_loads", "lamina_pressures", "grid_sizes", "cells", *ASKED}
        with shown_in(case_file.units):
            state = _verdicts(results)
        state |= {k: v for k, v in solution.to_dict().items() if k not in left}
        state |= {name: result._state() for name, result in added.items()}
        print(json.dumps(_plain(_in_units(state, added, case_file.units)), indent=2))
    else:
        with shown_in(case_file.units):
            print("\n\n".join(map(str, (solution, *added.values()))))
    for path in save:
        if path.suffix.lower() == ".html":
            with shown_in(case_file.units):
                _save_report(path, results, case, case_file)
        else:
            solution.save(path)


def _save_report(path: Path, results: Results, case: Path, case_file: Case) -> None:
    """Write a report with the case file, and the files that it names."""
    text, rows = case.read_text(encoding="utf-8-sig"), files_of(case_file)
    page = report_of(case_file, results, text, path.stem, rows)
    files.save(path, {".html": lambda file: file.write_text(page, encoding="utf-8")})


def _in_units(state: dict[str, Any], added: dict[str, TableResult], units: str) -> dict[str, Any]:
    """Return the state of a solved bearing or pair, which is in SI, in the units of its case."""
    sizes = {unit: 1 / size for unit, size in sizes_of(units).items()}
    rows = np.array([sizes["N"]] * 3 + [sizes["N m"]] * 2)
    columns = np.array([sizes["m"]] * 3 + [1.0] * 2)

    def converted(state: dict[str, Any], kinds: Mapping[str, str]) -> dict[str, Any]:
        record = dict(state)
        for name, value in state.items():
            if name in ("bearing", "pair"):
                record[name] = scaled(value, sizes, ENCODED)
            elif name in NAMES and isinstance(value, dict):
                record[name] = converted(value, kinds)
            elif name == "tangent":
                record[name] = (np.asarray(value) * rows[:, None] / columns).tolist()
            elif kinds.get(name) in sizes and value is not None:
                record[name] = (np.asarray(value) * sizes[kinds[name]]).tolist()
        return record

    rows_of_bearings = result_class("BearingSolution")._QUANTITIES
    kinds = {row.name: row.si() for row in rows_of_bearings}
    record = {"units": units} | converted(state, kinds)
    for name, result in added.items():
        record[name] = converted(
            state[name], {row.name: result._si(row) for row in result._QUANTITIES}
        )
    return record


def _verdicts(results: Mapping[str, object]) -> dict[str, object]:
    """Return the verdicts on results, by the names of these; some have none."""
    known = {name: verdict_on(result) for name, result in results.items()}
    verdicts = {name: verdict._state() for name, verdict in known.items() if verdict is not None}
    return {"verdict": verdicts} if verdicts else {}


def _is_open(result: object) -> bool:
    """Return whether a result has no verdict."""
    return verdict_on(result) is None


def _solved(case_file: Case, arguments: dict[str, object]) -> dict[str, Any]:
    """Return the results of a case, without warnings: what is printed has them."""
    with heard(), alive():
        return results_of(case_file, arguments)


def _solve(
    case: Path, case_file: Case, arguments: dict[str, object], save: Sequence[Path], as_json: bool
) -> None:
    """Solve, save and print in the units that are set."""
    results = _solved(case_file, arguments)
    outcome = results["solution"]
    solution = last_of(outcome)  # of a history, the last step is printed
    summaries = {name: result for name, result in results.items() if result is not outcome}
    steps = outcome if isinstance(outcome, nacre.types.History) else None
    if as_json:
        extremes = {k: _numbers_of(v) for k, v in summaries.items()} | _verdicts(summaries)
        history = {"steps": [_friction_numbers(step) for step in steps]} if steps else {}
        print(json.dumps(_plain(_numbers(solution) | history | extremes), indent=2))
    else:
        if steps:
            print(f"{steps}\n\nlast step")
        # A verdict answers what was asked, and comes first.
        print(*sorted([solution, *summaries.values()], key=_is_open), sep="\n\n")
    for path in save:
        if path.suffix.lower() == ".html":
            _save_report(path, results, case, case_file)
        else:
            # The fields of ParaView's file are those of the last step.
            (solution if path.suffix.lower() == ".vtr" else outcome).save(path)


def _solve_wear(
    case: Path, case_file: Case, arguments: dict[str, object], save: Sequence[Path], as_json: bool
) -> None:
    """Wear a contact, save and print its history in the units that are set."""
    results = _solved(case_file, arguments)
    history = results["wear"]
    summaries = {name: result for name, result in results.items() if result is not history}
    if as_json:
        numbers = _wear_numbers(history) | {"units": case_file.units}
        extremes = {k: _numbers_of(v) for k, v in summaries.items()}
        print(json.dumps(_plain(numbers | extremes | _verdicts(results)), indent=2))
    else:
        print(history, *summaries.values(), sep="\n\n")
    for path in save:
        ending = path.suffix.lower()
        if ending == ".html":
            _save_report(path, results, case, case_file)
        elif ending in FILMS:
            history.animate(path)
        else:
            (history.states[-1].solution if ending == ".vtr" else history).save(path)


def sweep(
    case: Path,
    store: Path | None,
    save: Sequence[Path],
    retry: bool,
    units: str | None,
    as_json: bool,
) -> None:
    """Solve the study of a case file, or the rest of it after a kill."""
    case_file = _read_case(case, units)
    study = case_file.study(store)
    for path in save:
        if path.suffix.lower() not in (".csv", ".html"):
            raise CaseError(f"--save must end in .csv or .html, got {str(path)!r}")
    with nacre.display_units(case_file.units), heard() as caught:
        try:
            dataset = nacre.sweep(case_file, retry=retry, **study)
        except (ArithmeticError, TypeError, ValueError) as error:
            raise CaseError(f"{case}: sweep: {error}") from error
    failed = int((dataset.error != "").sum())
    if as_json:
        print(json.dumps(_plain(dataset.to_dict()), indent=2))
    else:
        with shown_in(case_file.units):
            _print_study(dataset)
        where = f"; all in {study['store']}" if "store" in study else ""
        for text in caught:
            if " cases failed" not in text:  # the last line says that
                print(text)
        print(f"{dataset.error.size} cases, {failed} failed{where}")
    for path in save:
        if path.suffix.lower() == ".html":
            paths = ((row.label, row.text) for row in files_of(case_file))
            inputs = [("units of the case", case_file.units), *paths]
            text = case.read_text(encoding="utf-8-sig")
            save_report(dataset, path, case=text, inputs=inputs, head=case_file.signed)
            continue
        with replacing(path) as temporary:
            dataset.to_dataframe().to_csv(temporary)
    if failed:
        raise typer.Exit(1)


def indent(case: Path, save: Sequence[Path], units: str | None, as_json: bool) -> None:
    """Solve the indentation of a case file, as solve does."""
    case_file = _read_case(case, units)
    if case_file.kind != "indent":
        raise CaseError(f"{case}: this case has no [tip] and [indent]: nacre solve")
    _solve_indentation(case, case_file, save, as_json)


def _solve_indentation(case: Path, case_file: Case, save: Sequence[Path], as_json: bool) -> None:
    """Solve an indentation, save and print it."""
    for path in save:
        if path.suffix.lower() not in (".nc", ".csv", ".html"):
            raise CaseError(
                f"--save must end in .nc, .csv or .html for an indentation, got {str(path)!r}"
            )
    arguments = case_file.arguments()
    with nacre.display_units(case_file.units), heard():  # the printed solution has them
        with alive():
            results = results_of(case_file, arguments)
            solution = results["indent"]
            with naming(case_file, "indent"):
                numbers = _indent_numbers(solution)
        print(json.dumps(_plain(numbers | _verdicts(results)), indent=2) if as_json else solution)
        for path in save:
            if path.suffix.lower() == ".html":
                _save_report(path, results, case, case_file)
            else:
                solution.save(path)


def _friction_numbers(solution: nacre.types.FrictionSolution) -> dict[str, object]:
    """Return the main numbers of friction and the named state of its report."""
    return {row.name: value for row, value in tables.numbers(solution)} | {
        "friction_report": {
            name: value for name, value in solution.report.to_dict().items() if name != "kind"
        }
    }


def _numbers_of(result: Any) -> dict[str, object]:
    """Return the state of what is computed of a contact, without fields; of a conductance both."""
    state = {k: v for k, v in result.to_dict().items() if not isinstance(v, np.ndarray)}
    if isinstance(result, nacre.types.Conductance):
        del state["grid"]  # that of the contact
        state["conductance"] = result.conductance
    return state


def _wear_numbers(history: nacre.types.WearHistory) -> dict[str, object]:
    """Return the numbers of each state of a history of wear, its events and its report."""
    return {row.name: row.of(history).tolist() for row in history._step_rows()} | {
        "unit": history.unit,
        "life": None if history.life is None else history.life.distance,
        "events": [event._state() for event in history.events],
        "report": history.report._state(),
        "inputs": history.inputs,
    }


def _numbers(solution: nacre.Solution | nacre.types.FrictionSolution) -> dict[str, object]:
    """Return the main numbers and the named state of the report, with its warnings in words."""
    if isinstance(solution, nacre.types.FrictionSolution):
        return _numbers(solution.normal) | _friction_numbers(solution)
    state = solution.report.to_dict()
    state["units"] = system().name
    state.pop("kind")
    numbers = {row.name: value for row, value in tables.numbers(solution)}
    if solution.hardness is not None:
        hardness = np.unique(solution.hardness)
        numbers["hardness"] = hardness.item() if hardness.size == 1 else hardness[[0, -1]].tolist()
    if solution.indentation.any():
        numbers["indentation"] = float(solution.indentation.max())
    else:
        del numbers["plastic_work"]
    return state | numbers | {"warnings": solution.report.warnings}


def _indent_numbers(solution: IndentSolution) -> dict[str, object]:
    """Return the named state of an indentation, the pull-off only with adhesion."""
    state = solution.to_dict()
    if solution.adhesion is None:
        del state["pull_off"]
    else:
        pulled = state["pull_off"].items()
        state["pull_off"] = {name.removeprefix("pull_off_"): value for name, value in pulled}
    return {name: value for name, value in state.items() if name not in ("format", "kind")}


def _plain(data: object) -> object:
    """Return data for JSON, which has neither NaN nor infinity: they become null."""
    if isinstance(data, dict):
        return {str(key): _plain(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_plain(value) for value in data]
    if isinstance(data, float) and not np.isfinite(data):
        return None
    return data


def _check_ending(path: Path, endings: Collection[str]) -> None:
    if path.suffix.lower() not in endings:
        message = f"must end in {', '.join(sorted(endings))}, got {str(path)!r}"
        raise typer.BadParameter(message, param_hint="'--save'")


def _column(name: str, values: Any, unit: str, errors: Any) -> list[str]:
    """Return heading and cells of a column of a study, with estimated errors."""
    if values.dtype.kind not in "if":
        return [name, *map(str, values)]
    heading, texts = column(name, values.tolist(), unit, digits=5)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(values == 0, 0.0, 100 * np.abs(errors / values))
    return [heading, *(t + _share(share) for t, share in zip(texts, shares, strict=True))]


def _share(share: float) -> str:
    """Return an estimated error in percent; nothing where there is none."""
    if not 100 * SLIGHT < share < np.inf:
        return ""
    return f" ± {share:.1g} %" if share < 9.5 else f" ± {share:.0f} %"


def _print_study(dataset: Any) -> None:
    """Print parameters and numbers of the first cases, and the cases that failed."""
    frame = dataset[[*(n for n in dataset.data_vars if dataset[n].dims == dataset.error.dims)]]
    rows = frame.to_dataframe().reset_index()
    names = [str(name) for name in rows.columns if name not in ("error", "warnings")]
    names = [name for name in names if not name.endswith(ERROR)]
    first, units = rows.head(ROWS), {name: dataset[name].attrs.get("units", "") for name in names}
    errors = {name: first.get(name + ERROR, 0.0) for name in names}
    columns = [_column(name, first[name].to_numpy(), units[name], errors[name]) for name in names]
    print("\n".join(map(printable, aligned([*zip(*columns, strict=True)]))))
    if len(rows) > ROWS:
        print(f"and {len(rows) - ROWS} more cases")
    for _, row in rows[rows["error"] != ""].iterrows():
        print(f"failed at {', '.join(f'{n} = {row[n]}' for n in frame.coords)}: {row['error']}")
