"""Answers to the questions of the page: a function of a case and a stage, and of nothing else."""

from __future__ import annotations

import html
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np

import nacre
import nacre._core as core
from nacre._tools.typing import Field
from nacre.bearing import BearingSolution, PairSolution
from nacre.bearing.kinds import RollerBearing
from nacre.case import Case, CaseError, toml
from nacre.case.results import DEPTH_OPTIONS, last_of, report_of, results_of
from nacre.contact.friction import FrictionSolution
from nacre.contact.solution import Solution
from nacre.contact.stresses import depth_pictures
from nacre.indent import IndentSolution
from nacre.indent import solve as solve_indentation
from nacre.indent._reading import Reading, apparent_modulus, substrate_verdict
from nacre.results import display, report
from nacre.results.svg import Axis, Curve, bars, lines
from nacre.results.verdict import Verdict
from nacre.results.verdict import measured as with_error

Answer = dict[str, Any]
Contact = Solution | FrictionSolution
Going = Callable[[], bool]
"""Function that says whether the answer is still wanted."""

STAGES = ("draft", "full", "stress")
"""Stages of an answer, each of which names the next."""
ROLLER_CELLS, FEWEST_CELLS = 16384, 4096
"""Largest number of cells of a draft: of rollers; and of others, the fewest that nacre takes."""
DRAFT = {"step_tolerance": 1e-2}
"""How exact the steps of a draft of wear are, where the case says nothing."""
EVERY = 3
"""Loads of which one is in a draft of an indentation."""
CONTACT_ROWS = {"load", "approach", "tilt", "peak pressure", "contact", "area"}
BEARING_ROWS = {"displacement", "tilt", "largest load", "peak pressure", "edge pressure", "loaded"}
BEARING_ROWS |= {"first bearing", "second bearing"}
"""Numbers that the page shows."""
EXTREMES = {"von_mises": "largest von Mises stress", "tension": "largest tension"}
"""Extremes of stresses that the page shows."""
DIGITS = 5
"""Digits of the main number."""
ERRORS = (ArithmeticError, LookupError, MemoryError, TypeError, ValueError)
"""What calculations raise."""


class Measured(NamedTuple):
    """What a case reads from files, which happens once, at the start."""

    arguments: Answer
    """Arguments in place of those of the case on the page."""
    tables: Answer
    """Tables of the case file, which have other ones in their place on the page."""
    files: report.Rows
    """Files, with their SHA-256."""


NONE = Measured({}, {}, ())


class Printed(Protocol):
    """A result that is printed as rows of names and values."""

    def _rows(self) -> list[tuple[str, str]]: ...


class Stopped(Exception):
    """The answer is no longer wanted."""


def answer(
    case: Case, stage: str, going: Going = lambda: True, measured: Measured = NONE
) -> Answer:
    """Return what the page shows of a case at a stage.

    Parameters
    ----------
    case
        Case.
    stage
        One of `STAGES`; or "case" for its file, or "report".
    going
        Function that says whether the answer is still wanted.
    measured
        What was read from files at the start.

    Returns
    -------
    dict
        Parts of the page by name, and the next stage; or an error in a sentence.

    Raises
    ------
    Stopped
        If the answer was no longer wanted.
    """
    try:
        # Bearings are in SI, and shown in the units of the case.
        units = display.shown_in if case.kind == "bearing" else nacre.display_units
        with units(case.units):
            arguments = case.arguments() | measured.arguments
            if stage == "case":
                return {"case": file_text(case, measured)}
            if stage == "report":
                return {"report": _report(case, arguments, going, measured)}
            return SOLVERS[case.kind](case, arguments, stage, going)
    except ERRORS as error:
        if not going():
            raise Stopped from error
        return {"error": " ".join(str(error).split())[:600] or type(error).__name__}


def file_text(case: Case, measured: Measured = NONE) -> str:
    """Return the case file of what the page shows."""
    notes = f"{case.name}: nacre solve FILE", f"written by nacre {core.__version__}"
    return toml.text(case.data | measured.tables, notes)


def _contact(case: Case, arguments: Answer, stage: str, going: Going) -> Answer:
    """Return the answer on a contact: coated beside bare, and with the last stage its stresses."""
    if stage == "draft" and "grid" not in arguments:
        is_long = isinstance(arguments["shape"], core.Roller)
        arguments = arguments | {"max_cells": ROLLER_CELLS if is_long else FEWEST_CELLS}
    solution = _solved_contact(case, arguments, going)
    bare = _bare(case, arguments, going)
    rows = _selected(solution, CONTACT_ROWS)
    beside = [] if bare is None else _selected(bare, CONTACT_ROWS)
    parts: Answer = {
        "peak": ("peak pressure", display.number(solution.peak_pressure, "Pa", DIGITS)),
        "rows": _rows(rows, beside),
        "picture-1": _pressures(solution, bare),
        "warnings": list(solution._warnings),
    }
    if stage != "stress":
        return _answer(parts, "full" if stage == "draft" else "stress")
    keywords = case.stress() or {}
    try:
        summary = solution.stress_summary(**keywords, progress=lambda _: going())
    except ValueError as error:
        verdict = Verdict("unknown", f"Cannot tell: {error}.", (), None, None, None)
        return _answer(parts | _judged(verdict))
    _check(going)
    if bare is not None:
        of_bare = {k: v for k, v in keywords.items() if k in ("body", "friction", "direction")}
        beside += _extremes(bare.stress_summary(**of_bare, progress=lambda _: going()))
        _check(going)
    parts["rows"] = _rows(rows + _extremes(summary), beside)
    parts["picture-2"] = _stresses(solution, bare, keywords)
    parts["warnings"] = list(dict.fromkeys([*parts["warnings"], *summary.warnings]))
    return _answer(parts | _judged(summary.verdict))


def _solved_contact(case: Case, arguments: Answer, going: Going) -> Contact:
    """Return the solution of a contact, the last one of a history."""
    outcome = getattr(nacre, case.friction or "solve")(
        **arguments, progress=lambda *_: going(), check=False
    )
    _check(going)
    solution: Contact = last_of(outcome)
    if not solution.report.converged:
        raise CaseError("no solution was found: the solve did not converge")
    return solution


def _bare(case: Case, arguments: Answer, going: Going) -> Contact | None:
    """Return the solution without layers, or None where there are none or friction is solved."""
    body = arguments["body"]
    if case.friction or not isinstance(body, core.HalfSpace) or not body.layers:
        return None
    if not isinstance(body.substrate, core.Elastic):
        return None
    bare = core.HalfSpace(body.substrate, ends=body.ends)
    try:
        return _solved_contact(case, arguments | {"body": bare}, going)
    except ERRORS:
        _check(going)
        return None


def _wear(case: Case, arguments: Answer, stage: str, going: Going) -> Answer:
    """Return the answer on wear: the worn contact beside the new one, and the depth removed."""
    if stage == "draft":
        arguments = DRAFT | arguments
        arguments |= {} if "grid" in arguments else {"max_cells": FEWEST_CELLS}
    try:
        history = nacre.wear(**arguments, progress=lambda _: going())
    except nacre.ConvergenceError as error:
        _check(going)
        raise CaseError(f"no history was found: {error}") from error
    _check(going)
    new, worn = (history.states[k].solution for k in (0, -1))
    parts: Answer = {
        "peak": ("last peak pressure", display.number(worn.peak_pressure, "Pa", DIGITS)),
        "rows": _rows(history._rows()),
        "picture-1": _pressures(worn, new, ("worn", "new")),
        "picture-2": _figure(*history._depth_picture()),
        "warnings": list(history.warnings),
    }
    return _answer(parts | _judged(history.verdict), "full" if stage == "draft" else None)


def _bearing(case: Case, arguments: Answer, stage: str, going: Going) -> Answer:
    """Return the answer on a bearing; the last stage compares it with aligned rings."""
    bearing = arguments.pop("bearing")
    draft = {"model": "iso16281", "cells": None} if stage == "draft" else {}
    keywords = arguments | draft | {"progress": lambda *_: going(), "check": False}
    solution = bearing.solve(**keywords)
    _check(going)
    if not solution.report.converged:
        raise CaseError("no equilibrium was found: the solve did not converge")
    life = case.life()
    rows = _selected(solution, BEARING_ROWS)
    rows += [] if life is None else solution.life(**life)._rows()
    is_tilted = any(arguments.get("tilt") or ())
    is_pair = isinstance(solution, PairSolution)
    aligned = None
    if is_tilted and not is_pair and stage != "full":
        aligned = bearing.solve(**keywords | {"tilt": (0.0, 0.0)})
        _check(going)
    parts = {
        "peak": ("peak pressure", display.number(solution.peak_pressure, "Pa", DIGITS)),
        "rows": _rows(rows),
        "picture-1": _ring(solution.first) if is_pair else _along_roller(solution, aligned),
        "picture-2": _ring(solution.second if is_pair else solution),
        "warnings": list(solution.report.warnings),
    }
    is_compared = is_tilted and isinstance(bearing, RollerBearing)
    following = {"draft": "full", "full": "stress" if is_compared else None}
    return _answer(parts | _judged(solution.verdict), following.get(stage))


def _indentation(case: Case, arguments: Answer, stage: str, going: Going) -> Answer:
    """Return the answer on an indentation, with and without the substrate."""
    variable = next(name for name in ("load", "approach", "radius") if name in arguments)
    values = np.atleast_1d(np.asarray(arguments[variable], dtype=float))
    if stage == "draft":
        values = values[::-1][::EVERY][::-1]
    arguments = arguments | {variable: values}
    solution = solve_indentation(**arguments)
    _check(going)
    last = int(np.argmax(solution.approach))
    numbers = {
        name: display.number(float(getattr(solution, path)[last]), unit)
        for name, path, unit in (
            ("largest load", "load", "N"),
            ("largest depth", "approach", "m"),
            ("contact radius there", "radius", "m"),
            ("stiffness there", "stiffness", "N/m"),
            ("central pressure there", "central_pressure", "Pa"),
        )
    }
    parts: Answer = {
        "peak": ("largest depth", display.number(float(solution.approach[last]), "m", DIGITS)),
        "rows": _rows([*numbers.items()]),
        "picture-1": _loads(arguments, solution, variable),
        "warnings": list(solution.warnings),
    }
    reading = apparent_modulus(solution)
    _check(going)
    if reading is not None:
        parts["picture-2"] = _moduli(reading)
    parts |= _judged(substrate_verdict(reading))
    return _answer(parts, "full" if stage == "draft" else None)


SOLVERS = {"contact": _contact, "wear": _wear, "bearing": _bearing, "indent": _indentation}
"""Functions of the kinds of cases."""


def _report(case: Case, arguments: Answer, going: Going, measured: Measured) -> str:
    """Return the report of a case, as a page of HTML."""
    results = results_of(case, arguments, {"progress": lambda *_: going()})
    _check(going)
    text = file_text(case, measured)
    return report_of(case, results, text, Path(case.name).stem, measured.files)


def _check(going: Going) -> None:
    if not going():
        raise Stopped


def _answer(parts: Answer, following: str | None = None) -> Answer:
    return {"parts": parts, "next": following}


def _judged(verdict: Verdict) -> Answer:
    """Return the verdict as a part of the page."""
    return {"verdict": {"level": verdict.level, "words": verdict.words, "lines": verdict.lines}}


def _selected(result: Printed, names: set[str]) -> list[tuple[str, str]]:
    return [row for row in result._rows() if row[0] in names]


def _extremes(summary: nacre.types.StressSummary) -> list[tuple[str, str]]:
    """Return the largest stresses of all layers and the substrate."""
    rows = []
    for name, label in EXTREMES.items():
        worst = max(summary.layers, key=lambda part: getattr(part, name)[0])
        text = with_error(getattr(worst, name)[0], worst.uncertainty.get(name))
        rows.append((label, text))
    return rows


def _rows(rows: Sequence[tuple[str, str]], bare: Sequence[tuple[str, str]] | None = None) -> str:
    """Return a table of numbers, those of a bare body beside them."""
    beside = dict(bare or ())
    lines = []
    for name, text in rows:
        other = f"<td>{html.escape(beside.get(name, ''))}</td>" if bare else ""
        lines.append(f"<tr><th>{html.escape(name)}</th><td>{html.escape(text)}</td>{other}</tr>")
    head = "<tr><th></th><th>coated</th><th>bare</th></tr>" if bare else ""
    return f"<table>{head}{''.join(lines)}</table>"


def _figure(caption: str, drawing: str) -> str:
    words = html.escape(caption)
    drawing = drawing.replace("<svg", f"<svg role='img' aria-label='{words}'", 1)
    return f"<figure>{drawing}<figcaption>{words}</figcaption></figure>"


def _section(solution: Contact, axis: int | None = None) -> tuple[int, Field, Field]:
    """Return the longer axis of a contact, or another, places along it and the pressure there."""
    pressure = solution.pressure
    if axis is None:
        spans = [high - low for low, high in solution.contact_extent]
        axis = int(spans[1] > spans[0]) if np.isfinite(spans).all() else 1
        axis = 1 if pressure.shape[0] == 1 else axis
    peak = np.unravel_index(pressure.argmax(), pressure.shape)
    low, high = display.loaded_parts(pressure)[axis]
    cells = slice(low, high + 1)
    places = (solution.x, solution.y)[axis][cells]
    return axis, places, np.take(pressure, peak[1 - axis], axis=1 - axis)[cells]


def _pressures(
    solution: Contact, other: Contact | None, names: tuple[str, str] = ("coated", "bare")
) -> str:
    """Return the picture of the pressure along the longer side of a contact, and of another."""
    axis, x, pressure = _section(solution)
    curves = [Curve(x, pressure, "" if other is None else names[0])]
    if other is not None:
        curves.append(Curve(*_section(other, axis)[1:], names[1], "dashed"))
    drawing = lines(curves, (Axis("xy"[axis], "m"), Axis("pressure", "Pa")))
    return _figure("Pressure through the largest.", drawing)


def _stresses(solution: Contact, bare: Contact | None, keywords: Answer) -> str:
    """Return the picture of the von Mises stress against depth, coated and bare."""
    options = {name: keywords[name] for name in DEPTH_OPTIONS if name in keywords}
    return "".join(_figure(*one) for one in depth_pictures(solution, bare, **options))


def _along_roller(solution: BearingSolution, aligned: BearingSolution | None) -> str:
    """Return the picture of the pressure along the heaviest element, and of aligned rings."""
    curves = [Curve(*_profile(solution), "as it stands" if aligned else "")]
    if aligned is not None:
        curves.append(Curve(*_profile(aligned), "aligned", "dashed"))
    drawing = lines(curves, (Axis("x", "m"), Axis("pressure", "Pa")))
    return _figure("Pressure along the heaviest element, inner ring.", drawing)


def _profile(solution: BearingSolution) -> tuple[Field, Field]:
    """Return places along the heaviest element, and the largest pressure there."""
    heaviest = int(solution.loads[:, 0].argmax())
    if solution.lamina_pressures is not None:
        assert isinstance(solution.bearing, RollerBearing)
        pressure = solution.lamina_pressures[heaviest, 0]
        places = ((np.arange(pressure.size) + 0.5) / pressure.size - 0.5) * solution.bearing.length
        return places, pressure
    if solution.model != "solved" or (contact := solution.contact(heaviest, "inner")) is None:
        return np.zeros(1), solution.peak_pressures[heaviest, :1]
    return contact.x, contact.pressure.max(axis=1)


def _ring(solution: BearingSolution) -> str:
    """Return the picture of the loads around the ring."""
    count, rows = solution.bearing.count, solution.bearing.rows
    loads = solution.loads.reshape(rows, count, 2)[:, :, 0].T
    angles = solution.angles.reshape(rows, count).T
    drawing = bars(angles, loads, Axis("load on the inner ring", "N"))
    return _figure("Loads of the elements around the ring, x to the right.", drawing)


def _loads(arguments: Answer, solution: IndentSolution, variable: str) -> str:
    """Return the picture of load over depth, and of the film without a substrate."""
    body = arguments["body"]
    layers = body.layers if isinstance(body, core.HalfSpace) else []
    curves = [Curve(solution.approach, solution.load, "on the substrate" if layers else "")]
    if layers:
        bare = solve_indentation(**arguments | {"body": core.HalfSpace(layers[0].material)})
        curves.append(Curve(bare.approach, bare.load, "film alone", "dashed"))
    drawing = lines(curves, (Axis("depth", "m"), Axis("load", "N")))
    return _figure("Load over depth.", drawing)


def _moduli(reading: Reading) -> str:
    """Return the picture of the modulus that a bare film of each depth's load would have."""
    curves = [
        Curve(reading.depths, reading.moduli, "read as a bare film"),
        Curve(reading.depths, np.full(reading.depths.size, reading.modulus), "film", "dashed"),
    ]
    drawing = lines(curves, (Axis("depth", "m"), Axis("apparent modulus", "Pa")))
    return _figure("Apparent modulus over depth.", drawing)
