"""Answers to the questions of the page: a function of a case and a stage, and of nothing else."""

from __future__ import annotations

import copy
import functools
import html
import math
import pickle
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np

import nacre
import nacre._core as core
from nacre._tools.typing import Field, Member
from nacre._tools.units import chosen, plain, rounded
from nacre.bearing import BearingSolution, PairSolution
from nacre.bearing.kinds import RollerBearing
from nacre.case import Case, CaseError, toml
from nacre.case.results import DEPTH_OPTIONS, last_of, of_last, rated, report_of, results_of
from nacre.contact.friction import FrictionSolution
from nacre.contact.solution import Solution
from nacre.contact.stresses import StressPlan, depth_charts
from nacre.indent import Fit, IndentSolution, fit
from nacre.indent import solve as solve_indentation
from nacre.indent._reading import Reading, apparent_modulus, substrate_verdict
from nacre.indent.solution import UNITS
from nacre.results import display
from nacre.results.charts import NO_EDGE, Axis, Chart, Curve, Look, Picture, section
from nacre.results.report import Rows, in_words
from nacre.results.rows import Row
from nacre.results.svg import drawing
from nacre.results.verdict import Verdict, verdict_on, worst_of
from nacre.results.verdict import measured as with_error

Answer = dict[str, Any]
Contact = Solution | FrictionSolution
Solved = TypeVar("Solved", Contact, BearingSolution)
Going = Callable[[], bool]
"""Function that says whether the answer is still wanted."""
Wanted = Callable[..., bool]
"""Function that raises `Stopped` where the answer is no longer wanted: the progress of solves."""

NEXT = dict(pairwise(("draft", "full", "stress")))
"""The stage after each."""
STAGES = ("draft", *NEXT.values(), "finer")
"""Stages of an answer; the last one is asked for by a button."""
FINER, LARGEST_ERROR = 2, 0.2
"""Cells along a side in place of one, and largest error of stresses, of the last stage."""
COARSE = re.compile(
    r"(?:take|give) (?:a finer (?:or larger )?grid|cells [\d.]+ times smaller|"
    r"(?:much )?smaller cells)"
)
"""Advice of warnings that the button follows."""
ROLLER_CELLS, FEWEST_CELLS = 12288, 4096
"""Largest number of cells of a draft: of rollers, and of others, the fewest that nacre takes.

That of rollers was chosen by trial: with 8192 and 16384 drafts take a third longer.
"""
DRAFT = {"step_tolerance": 1e-2}
"""How exact the steps of a draft of wear are, where the case says nothing."""
STANDARD = "20 %"
"""Largest difference of the standard's contacts, of a draft of a bearing, from solved ones.

By trial over forces, tilts and clearances: 16 % of lives, 14 % of displacements.
"""
RECENT = 4
"""Solutions that are kept: those of two coats, and of their bare bodies."""
EVERY = 3
"""Loads of which one is in a draft of an indentation."""
CONTACT_ROWS = {"load", "approach", "tilt", "peak_pressure", "contact_extent", "contact_area"}
CONTACT_ROWS |= {"force", "shift", "creepage"}
BEARING_ROWS = {"displacement", "tilt", "largest_load", "peak_pressure", "edge_pressure", "loaded"}
BEARING_ROWS |= {"first_bearing", "second_bearing"}
FILM_ROWS = {"central", "minimum", "film_ratio"}
"""Numbers that the page shows."""
INDENT_ROWS = {
    "load": "largest load",
    "approach": "largest depth",
    "radius": "contact radius there",
    "stiffness": "stiffness there",
    "central_pressure": "central pressure there",
}
"""Numbers of an indentation that the page shows, of its largest depth."""
LABELS = {
    "hours": "life in hours",
    "ring_capacities": "ratings of contacts",
    "simple_fatigue_load_limit": "fatigue load limit by C_0 alone",
    "first": "life of the first bearing",
    "second": "life of the second bearing",
}
"""Labels that say more beside others than those of the result."""
PER_LENGTH = {("worn_volume", True), ("contact_area", False)}
"""Rows of line contacts, by their keys and whether their unit is an area."""
SILENT = {"ended"}
"""Rows of a history that say nothing of its numbers."""
PLACES = {
    "displacement": ("along x", "along y", "along z"),
    "tilt": ("along x", "along y"),
    "force": ("along x", "along y"),
    "creepage": ("along x", "along y"),
    "rotation": ("about x", "about y"),
    "ring_capacities": ("inner ring", "outer ring"),
}
"""Words for the components of quantities."""
EXPONENT = re.compile(r"\d[\d.]*e\+\d+")
"""A large number."""
EXTREMES = {"von_mises": "largest von Mises stress", "tension": "largest tension"}
"""Extremes of stresses that the page shows."""
DIGITS = 5
"""Digits of the main number."""
PRESSURE, DEPTH = Axis("pressure", "Pa"), Axis("depth", "m")
"""Axes of pictures."""
LINE_WIDTH = 1.6 / 230
"""Width of a curve over the height of its picture."""
HEAVIEST = "Pressure along the heaviest element, inner ring."
"""Caption of the first picture of a bearing."""
ERRORS = (ArithmeticError, LookupError, MemoryError, RuntimeError, TypeError, ValueError)
"""What calculations raise."""


class Measured(NamedTuple):
    """What a case reads from files, which happens once, at the start."""

    arguments: Answer
    """Arguments in place of those of the case on the page."""
    tables: Answer
    """Tables of the case file, which have other ones in their place on the page."""
    files: Rows
    """Files, with their SHA-256, and what is estimated."""
    notes: Sequence[str] = ()
    """What is estimated, in sentences."""


NONE = Measured({}, {}, ())


@dataclass(frozen=True)
class Question:
    """A contact or a bearing to be solved: equal ones have equal solutions."""

    key: bytes
    """What it is, and in which units."""
    solve: Callable[[], Any] = field(compare=False)
    """Function that solves it."""


class Stopped(Exception):
    """The answer is no longer wanted."""


def answer(
    case: Case,
    stage: str,
    going: Going = lambda: True,
    measured: Measured = NONE,
    shown: Mapping[str, str] | None = None,
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
    shown
        Units of the numbers by their SI units, in place of readable ones; a report has its own.

    Returns
    -------
    dict
        Parts of the page by name, and the next stage; or an error in a sentence.

    Raises
    ------
    Stopped
        If the answer was no longer wanted.
    """

    def wanted(*_: object) -> bool:
        if not going():
            raise Stopped
        return True

    is_finer, case = stage == "finer", finer(case) if stage == "finer" else case
    stage = "stress" if is_finer else stage
    # Bearings are in SI, and shown in the units of the case.
    units = display.shown_in if case.kind == "bearing" else nacre.display_units
    try:
        with units(case.units):
            arguments = case.arguments() | measured.arguments
            if stage == "case":
                return {"case": file_text(case, measured)}
            if stage == "report":
                return {"report": _report(case, arguments, wanted, measured)}
            with chosen(shown or {}):
                reply = SOLVERS[case.kind](case, arguments, stage, wanted)
                reply["parts"]["warnings"] = list(map(in_words, reply["parts"]["warnings"]))
    except ERRORS as error:
        wanted()
        return {"error": " ".join(str(error).split())[:600] or type(error).__name__}

    followed = "solve the case file on finer cells" if is_finer else 'press "Finer"'
    warnings = [*measured.notes, *reply["parts"]["warnings"]]
    reply["parts"]["warnings"] = [COARSE.sub(followed, text) for text in warnings]
    return reply | ({"next": None} if is_finer else {})


def forget() -> None:
    """Drop the solutions that are kept."""
    _recent.cache_clear()


def finer(case: Case) -> Case:
    """Return a case on finer cells, with stresses of a small error."""
    data: dict[str, Any] = copy.deepcopy(case.data)
    grid = data.get("grid", {})
    for key in grid.keys() & {"shape", "cells"}:
        grid[key] = (FINER * np.array(grid[key])).tolist()
    if case.kind == "bearing" and "cells" in data["bearing"]["solve"]:
        data["bearing"]["solve"]["cells"] = [FINER * n for n in data["bearing"]["solve"]["cells"]]
    elif (
        case.kind == "contact"
        and case.friction is None
        and {"periodic", "conductance"}.isdisjoint({*grid, *data})
    ):
        data["stress"] = {"refine": LARGEST_ERROR} | data.get("stress", {})
    elif case.kind in ("contact", "wear") and not grid:
        data["solve"]["max_cells"] = FINER**2 * data["solve"].get("max_cells", FEWEST_CELLS)
    return Case(data, case.name, case.folder)


def file_text(case: Case, measured: Measured = NONE) -> str:
    """Return the case file of what the page shows."""
    notes = [f"{case.name}: nacre solve FILE", f"written by nacre {core.__version__}"]
    notes += [f"{row.label}: {row.text}" for row in measured.files]
    return toml.text(case.data | measured.tables, notes)


def _contact(case: Case, arguments: Answer, stage: str, wanted: Wanted) -> Answer:
    """Return the answer on a contact: coated beside bare, and with the last stage its stresses."""
    if stage == "draft" and "grid" not in arguments:
        is_long = isinstance(arguments["shape"], core.Roller)
        arguments = arguments | {"max_cells": ROLLER_CELLS if is_long else FEWEST_CELLS}
    solution = _solved_contact(case, arguments, wanted)
    bare = _bare(case, arguments, wanted)
    rows, beside = (_selected(contact, CONTACT_ROWS) for contact in (solution, bare))
    peak = ("peak pressure", solution.peak_pressure, "Pa", _share_of_peak(solution))
    if stage != "stress":
        pictures = [_pressures(coated=solution, bare=bare)]
        return _answer(peak, rows, pictures, solution._warnings, None, NEXT.get(stage), beside)
    keywords, warnings = case.stress() or {}, solution._warnings
    options = {name: keywords[name] for name in DEPTH_OPTIONS if name in keywords}
    plan, of_bare = (_planned(contact, options.get("body", "body")) for contact in (solution, bare))
    pictures = [_pressures(coated=plan or solution, bare=of_bare or bare)]
    try:
        results = of_last(case, solution, {"progress": wanted}, plan)
    except ValueError as error:
        verdict: Verdict | None = Verdict("unknown", f"Cannot tell: {error}.")
    else:
        verdict, summary = worst_of(map(verdict_on, results.values())), results.get("stress")
        warnings = [*warnings, *(text for one in results.values() for text in one.warnings)]
        rows += [] if summary is None else _extremes(summary)
        rows += results["conductance"]._rows() if "conductance" in results else []
        if of_bare is not None and summary is not None:
            sliding = {k: v for k, v in options.items() if k not in ("body", "residual")}
            beside += _extremes(of_bare.summary(**sliding, progress=wanted))
        charts = depth_charts(plan or solution, of_bare or bare, **options)
        pictures.append("".join(map(_figure, charts)))
    return _answer(peak, rows, pictures, warnings, verdict, None, beside)


def _planned(contact: Contact | None, body: Member) -> StressPlan | None:
    """Return a plan of the stresses in a body of a contact, or None where there are none."""
    try:
        return None if contact is None else contact.stress_plan(body)
    except ERRORS:
        return None


def _solved_contact(case: Case, arguments: Answer, wanted: Wanted) -> Contact:
    """Return the solution of a contact, the last one of a history."""
    name = case.friction or "solve"

    def solve(**keywords: Any) -> Contact:
        last: Contact = last_of(getattr(nacre, name)(**keywords))
        return last

    return _converged(_solved(case, name, solve, arguments, wanted), "solution")


def _solved(
    case: Case, what: object, solve: Callable[..., Solved], arguments: Answer, wanted: Wanted
) -> Solved:
    """Return a solution, of the most recent ones without a new solve.

    The stages of an answer have the same, and the bare body's is that of every coat.
    """
    wanted()
    asked = functools.partial(solve, **arguments, progress=wanted, check=False)
    solution: Solved = _recent(Question(pickle.dumps((case.units, what, arguments)), asked))
    return solution


@functools.lru_cache(maxsize=RECENT)
def _recent(question: Question) -> Any:
    return question.solve()


def _converged(solution: Solved, what: str) -> Solved:
    if not solution.report.converged:
        raise CaseError(f"no {what} was found: the solve did not converge")
    return solution


def _bare(case: Case, arguments: Answer, wanted: Wanted) -> Contact | None:
    """Return the solution without layers, or None where there are none or friction is solved."""
    body = arguments["body"]
    if case.friction or not isinstance(body, core.HalfSpace) or not body.layers:
        return None
    if not isinstance(body.substrate, core.Elastic):
        return None
    bare = core.HalfSpace(body.substrate, ends=body.ends)
    try:
        return _solved_contact(case, arguments | {"body": bare}, wanted)
    except ERRORS:
        wanted()
        return None


def _wear(case: Case, arguments: Answer, stage: str, wanted: Wanted) -> Answer:
    """Return the answer on wear: the worn contact beside the new one, and the depth removed."""
    grid = arguments.get("grid")
    if stage == "draft" and not (grid and grid.is_line):  # lines are fast enough as they are
        arguments = DRAFT | arguments
        arguments |= {} if grid else {"max_cells": FEWEST_CELLS}
    try:
        history = nacre.wear(**arguments, progress=wanted)
    except nacre.ConvergenceError as error:
        raise CaseError(f"no history was found: {error}") from error
    new, worn = (history.states[k].solution for k in (0, -1))
    pictures = [_pressures(worn=worn, new=new), _figure(history._depth_chart())]
    history = replace(history, required_distance=case.required_distance())
    results = {} if stage == "draft" else of_last(case, worn, {"progress": wanted})
    verdict = worst_of(map(verdict_on, [history, *results.values()]))
    peak = ("last peak pressure", worn.peak_pressure, "Pa", _share_of_peak(worn))
    following = "full" if stage == "draft" else None
    return _answer(
        peak,
        [*history._rows(), *history._remarks()],
        pictures,
        [*history.warnings, *(text for one in results.values() for text in one.warnings)],
        verdict,
        following,
    )


def _bearing(case: Case, arguments: Answer, stage: str, wanted: Wanted) -> Answer:
    """Return the answer on a bearing; the last stage compares it with aligned rings."""
    bearing = arguments.pop("bearing")
    draft = {"model": "iso16281", "cells": None} if stage == "draft" else {}
    keywords = arguments | draft
    solution = _converged(_solved(case, bearing, bearing.solve, keywords, wanted), "equilibrium")
    # A film belongs to solved contacts, which a draft has not.
    results = rated(case, solution, has_film=stage != "draft")
    solution, rows = results["bearing"], _selected(solution, BEARING_ROWS)
    warnings = list(solution.report.warnings)
    if (life := results.get("life")) is not None:
        rows += [*life._rows(), *life._remarks()]
        warnings += life.warnings
    rows += _selected(results.get("film"), FILM_ROWS)
    is_tilted = any(arguments.get("tilt") or ())
    if isinstance(solution, PairSolution):
        rings = [member._ring_chart() for member in solution.bearings]
        pictures = [
            _figure(
                ring._replace(
                    caption=f"{name} bearing: {ring.caption[0].lower()}{ring.caption[1:]}"
                )
            )
            for name, ring in zip(("First", "Second"), rings, strict=True)
        ]
    else:
        profiles = {"as it stands": _profile(solution)}
        if is_tilted and stage != "full":
            aligned = keywords | {"tilt": (0.0, 0.0)}
            profiles["aligned"] = _profile(_solved(case, bearing, bearing.solve, aligned, wanted))
        pictures = [
            _drawn(HEAVIEST, Axis("x", "m"), PRESSURE, profiles),
            _figure(solution._ring_chart()),
        ]
    is_compared = is_tilted and isinstance(bearing, RollerBearing)
    following = NEXT.get(stage) if stage == "draft" or is_compared else None
    peak = ("peak pressure", solution.peak_pressure, "Pa", STANDARD)
    return _answer(peak, rows, pictures, warnings, solution.verdict(), following)


def _indentation(case: Case, arguments: Answer, stage: str, wanted: Wanted) -> Answer:
    """Return the answer on an indentation, with and without the substrate."""
    if "curve" in arguments:
        return _fit_answer(_fitted(arguments, wanted))
    variable = next(name for name in ("load", "approach", "radius") if name in arguments)
    values = np.atleast_1d(np.asarray(arguments[variable], dtype=float))
    if stage == "draft":
        values = values[::-1][::EVERY][::-1]
    arguments = arguments | {variable: values}
    solution = solve_indentation(**arguments, progress=wanted)
    last = int(np.argmax(solution.approach))
    rows = [
        display.numbered(name, label, float(getattr(solution, name)[last]), UNITS[name])
        for name, label in INDENT_ROWS.items()
    ]
    pictures, reading = [_loads(arguments, solution)], apparent_modulus(solution)
    if reading is not None:
        pictures.append(_moduli(reading))
    peak = ("largest depth", float(solution.approach[last]), "m", "")
    verdict, following = substrate_verdict(reading), "full" if stage == "draft" else None
    return _answer(peak, rows, pictures, solution.warnings, verdict, following)


def _fitted(arguments: Answer, wanted: Wanted) -> Fit:
    """Return the modulus of the film, or of a body without one, that fits an opened curve."""
    free = f"body.{'layers[0].material' if arguments['body'].layers else 'substrate'}.young"
    fitted = fit(
        *(arguments["curve"], arguments["body"], arguments["tip"], [free]),
        nuisance=["contact_point"],
        progress=wanted,
    )
    return replace(fitted, tolerance=arguments.get("tolerance"))


def _fit_answer(fitted: Fit) -> Answer:
    """Return the answer on an opened curve: its modulus, and the curve with the model."""
    verdict, (path,) = fitted.verdict(), fitted.free
    pictures = [_figure(chart) for chart in fitted._charts()]
    peak = (str(verdict.decided_by or "modulus"), fitted.estimates[path], "Pa", "")
    return _answer(peak, fitted._report_rows(), pictures, fitted.warnings, verdict, None)


SOLVERS = {"contact": _contact, "wear": _wear, "bearing": _bearing, "indent": _indentation}
"""Functions of the kinds of cases."""


def _report(case: Case, arguments: Answer, wanted: Wanted, measured: Measured) -> str:
    """Return the report of a case, as a page of HTML."""
    if "curve" in arguments:
        results: Answer = {"indent": _fitted(arguments, wanted)}
    else:
        results = results_of(case, arguments, {"progress": wanted})
    wanted()
    text = file_text(case, measured)
    return report_of(case, results, text, Path(case.name).stem, measured.files)


def _answer(
    peak: tuple[str, float, str, str],
    rows: Rows,
    pictures: Sequence[str],
    warnings: Sequence[str],
    verdict: Verdict | None,
    following: str | None,
    beside: Rows = (),
) -> Answer:
    """Return the parts of the page, and the next stage; `peak` has words, number, unit and error.

    The numbers of a draft, after which all cells follow, are "about".
    """
    words, value, unit, share = peak
    text, about = display.number(value, unit, DIGITS), "about" if following == "full" else ""
    if about:
        text = f"about {text}" + (f" ± {share}" if share else "")
    page: Answer = {
        "peak": (words, text),
        "rows": _table(rows, beside, about),
        "warnings": list(dict.fromkeys(warnings)),
    }
    page |= {f"picture-{number}": picture for number, picture in enumerate(pictures, start=1)}
    if verdict is not None:
        page["verdict"] = verdict._state()
        page["verdict"]["words"] = f"About: {verdict.words}" if about else verdict.words
    return {"parts": page, "next": following}


def _share_of_peak(contact: Contact) -> str:
    """Return the error of the largest pressure of a contact, a share; "" of an unknown one."""
    texts = (row.text for row in contact._rows() if row.key == "peak_pressure")
    return next(texts, "").partition(" ± ")[2]


def _selected(result: Any, keys: set[str]) -> list[Row]:
    """Return some of the rows of a result, none of None."""
    return [] if result is None else [row for row in result._rows() if row.key in keys]


def _extremes(summary: nacre.types.StressSummary) -> list[Row]:
    """Return the largest stresses of all layers and the substrate."""
    rows = []
    for name, label in EXTREMES.items():
        worst = max(summary.layers, key=lambda layer: getattr(layer, name)[0])
        value, error = getattr(worst, name)[0], worst.uncertainty.get(name)
        rows.append(Row(name, label, with_error(value, error, "Pa"), value, "Pa", error))
    return rows


def _worded(row: Row, is_ring: bool) -> Row | None:
    """Return a row in words, components with their names; None of one that says nothing.

    The tilt of a ring is about an axis, that of a body a slope along it.
    """
    text, value = row.text, row.value
    if row.key in SILENT or (isinstance(value, float) and not math.isfinite(value)):
        return None
    if row.key == "hours":
        text = f"{plain(value, 4)} h"
    elif row.key in PLACES:
        words = PLACES["rotation" if is_ring and row.key == "tilt" else row.key]
        parts = zip(display.without_rounding(value), words, strict=True)
        text = ", ".join(f"{_component(row, part)} {place}" for part, place in parts if part)
    text = EXPONENT.sub(lambda large: plain(float(large[0]), 4), in_words(text))
    label = LABELS.get(row.key, row.label)
    if (row.key, "²" in text) in PER_LENGTH:
        label += " per length"
    return row._replace(label=label, text=text) if text else None


def _component(row: Row, value: float) -> str:
    """Return a component of a quantity, of a tilt in minutes, of a creepage in %."""
    if row.key == "tilt":
        return f"{rounded(math.degrees(math.atan(value)) * 60, 4)}′"
    if row.key == "creepage":
        return f"{rounded(100 * value, 4)} %"
    return display.number(value, row.unit)


def _table(rows: Rows, beside: Rows, about: str) -> str:
    """Return a table of numbers, those of a bare body beside them; its head says "about"."""
    is_ring = any(row.key == "displacement" for row in rows)
    rows, beside = (
        [worded for row in each if (worded := _worded(row, is_ring))] for each in (rows, beside)
    )
    lines, bare = [], {row.key: row.text for row in beside}
    for row in rows:
        cells = (row.text, bare.get(row.key, "")) if bare else (row.text,)
        texts = "".join(f"<td>{html.escape(cell)}</td>" for cell in cells)
        lines.append(f"<tr><th>{html.escape(row.label)}</th>{texts}</tr>")
    names = [f"{about} {name}".strip() for name in (("coated", "bare") if bare else ("",))]
    head = f"<tr><th></th>{''.join(f'<th>{name}</th>' for name in names)}</tr>"
    return f"<table>{head if any(names) else ''}{''.join(lines)}</table>"


def _figure(picture: Picture) -> str:
    """Return a picture with its caption, which is read out, too."""
    words = html.escape(picture.caption)
    drawn = drawing(picture).replace("<svg", f"<svg role='img' aria-label='{words}'", 1)
    return f"<figure>{drawn}<figcaption>{words}</figcaption></figure>"


def _drawn(caption: str, x: Axis, y: Axis, curves: Mapping[str, tuple[Field, Field]]) -> str:
    """Return a picture of curves by name, the second one dashed; one alone needs no name."""
    looks: tuple[Look, ...] = "line", "dashed"
    drawn = [
        Curve(*curve, name if len(curves) > 1 else "", look)
        for (name, curve), look in zip(curves.items(), looks, strict=False)
    ]
    return _figure(Chart(caption, drawn, (x, y)))


def _pressures(**contacts: Contact | StressPlan | None) -> str:
    """Return the picture of the pressure along the longer side of the first contact.

    That of a plan falls to 0 at the edge of the contact, where it is known within cells.
    """
    drawn = {name: contact for name, contact in contacts.items() if contact is not None}
    first = next(iter(drawn.values()))._normal
    along_x, along_y = np.ptp(first.contact_extent, axis=1)
    axis = 0 if along_x >= along_y and not first.grid.is_line else 1
    curves = {
        name: section(contact._normal, axis, getattr(contact, "edge", NO_EDGE))
        for name, contact in drawn.items()
    }
    places = Axis("xy"[axis], "m")
    caption = f"Pressure along {places.name} through the largest value"
    (name, (x, pressure)), *others = curves.items()
    if len(others) == 1 and _apart(*curves.values()) < LINE_WIDTH:
        other, (beside, second) = others[0]
        inside = pressure > pressure.max() / 2  # where it is not steep
        difference = (pressure - np.interp(x, beside, second))[inside]
        words = f"Difference of the pressures, {name} less {other}, above half of the largest."
        axis_of = Axis("difference", "Pa")
        alone = _drawn(f"{caption}, {name}.", places, PRESSURE, {name: curves[name]})
        return alone + _drawn(words, places, axis_of, {name: (x[inside], difference)})
    return _drawn(f"{caption}.", places, PRESSURE, curves)


def _apart(curve: tuple[Field, Field], reference: tuple[Field, Field]) -> float:
    """Return the largest distance of the points of a curve from another, over their picture."""
    scale = np.ptp(curve, axis=1)[:, None]
    points, line = (np.stack(each) / scale for each in (curve, reference))
    along = np.append(0.0, np.hypot(*np.diff(line)).cumsum())
    steps = np.linspace(0.0, along[-1], max(2, int(4 * along[-1] / LINE_WIDTH)))
    dense = np.stack([np.interp(steps, along, part) for part in line])
    return float(np.hypot(*(points[:, :, None] - dense[:, None])).min(axis=1).max())


def _profile(solution: BearingSolution) -> tuple[Field, Field]:
    """Return places along the heaviest element, and the largest pressure there."""
    heaviest = int(solution.loads[:, 0].argmax())
    places, pressures = solution._profile(heaviest, 0)
    if not places.size:
        return np.zeros(1), solution.peak_pressures[heaviest, :1]
    return places, pressures


def _loads(arguments: Answer, solution: IndentSolution) -> str:
    """Return the picture of load over depth, and of the film without a substrate."""
    curves = {"on the substrate": (solution.approach, solution.load)}
    if layers := solution.body.layers:
        bare = solve_indentation(**arguments | {"body": core.HalfSpace(layers[0].material)})
        curves["film alone"] = bare.approach, bare.load
    return _drawn("Load over depth.", DEPTH, Axis("load", "N"), curves)


def _moduli(reading: Reading) -> str:
    """Return the picture of the modulus that a bare film of each depth's load would have."""
    film = np.full_like(reading.moduli, reading.modulus)
    moduli = {"read as a bare film": reading.moduli, "film": film}
    curves = {name: (reading.depths, values) for name, values in moduli.items()}
    return _drawn("Apparent modulus over depth.", DEPTH, Axis("apparent modulus", "Pa"), curves)
