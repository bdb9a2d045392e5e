"""Printed forms of results: a line, a table; in a notebook with a small map."""

from __future__ import annotations

import base64
import functools
import html
import io
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np
import numpy.typing as npt

from nacre._core import Elastic, Free, HalfSpace, Response, Rigid, Spring
from nacre._tools.typing import Planned
from nacre._tools.units import (
    SI,
    Scale,
    Within,
    display_units,
    energy,
    printable,
    rounded,
    symbol,
    written,
)
from nacre.results.quantities import CONTACT, FRICTION, Quantity

if TYPE_CHECKING:
    from nacre.contact.friction import FrictionSolution
    from nacre.contact.solution import Report, Solution
    from nacre.contact.stresses import InterfaceStress, LayerStress, StressSummary
    from nacre.fatigue.summary import InterfaceFatigue, LayerFatigue

P = ParamSpec("P")
T = TypeVar("T")
Texts = Mapping[str, Callable[[Any], str | None]]
Peak = tuple[float, tuple[float, float, float]]

ALT = "the contact, x to the right"
WIDEST, WIDE = 240, 480
"""Pixels along the longer side of the small map, and of a drawn picture."""
NOISE = 1e-9
"""Share of its largest possible value below which a position or a moment is printed as 0."""
SLIGHT = 1e-8
"""Share of a vector below which a component is printed as 0."""
LAYER_ROWS = 4
"""Largest number of layers that get a row each."""
_units: ContextVar[str | None] = ContextVar(
    "units in which numbers in SI are printed", default=None
)
UNFINISHED = "stopped before all depths were done"


def in_si(function: Callable[P, T]) -> Callable[P, T]:
    """Return a function of what is in SI whatever units are set, as the numbers of bearings are."""

    @functools.wraps(function)
    def inside(*args: P.args, **kwargs: P.kwargs) -> T:
        with Within(SI):
            return function(*args, **kwargs)

    return inside


@contextmanager
def shown_in(units: str) -> Iterator[None]:
    """Print numbers that are in SI in other units within the context."""
    token = _units.set(units)
    try:
        yield
    finally:
        _units.reset(token)


def number(value: float, unit: str, digits: int = 4) -> str:
    """Return a number, whose SI unit is given, with the unit that is set or `shown_in`."""
    if (units := _units.get()) is None:
        return written(value, unit, digits)
    with display_units(units):
        scale = Scale.in_unit(value, unit)
    return f"{rounded(scale.factor * value, digits)} {scale.unit}".rstrip()


def numbers(solution: Solution) -> list[tuple[str, str]]:
    """Return names and values of the main numbers, with units."""
    report, touching = solution.report, solution.contact_area > 0
    repeats = [name for name, is_so in zip("xy", report.grid.periodic, strict=True) if is_so]
    left = set() if touching else {"peak_position", "contact_extent", "contact_area"}
    if len(repeats) == 2:
        left.add("tilt")
    texts: Texts = {**NORMAL_TEXTS} | dict.fromkeys(left, _nothing)
    rows = _rows(solution, CONTACT, texts, report.grid.is_line)
    place = 1 + max(k for k, (name, _) in enumerate(rows) if name in ("approach", "tilt"))
    rows.insert(place, ("motion", motion(report.motion)))
    nx, ny = report.grid.shape
    period = f", periodic along {' and '.join(repeats)}" if repeats else ""
    return [
        *rows,
        *_body("body", report.body),
        *_body("counterbody", report.counterbody),
        *_moduli(report.body, report.counterbody),
        ("grid", f"{nx} × {ny} cells{period}"),
        ("ended", f"{report.termination}{_fallback(report)}, residual {report.residual:.0e}"),
    ]


def friction_numbers(solution: FrictionSolution) -> list[tuple[str, str]]:
    """Return names and values of the main numbers of friction, with units."""
    report, rolls = solution.report, solution.shift is None
    rows = _rows(solution, FRICTION, FRICTION_TEXTS, solution.grid.is_line, rolls)
    touching, sticking = int((solution.pressure > 0).sum()), int(solution.stick.sum())
    state = "all slips" if report.full_slip else f"{sticking} of {touching} cells stick"
    coupled = f", {report.sweeps} sweeps" if report.coupled else ""
    accuracy = f"violation {report.violation:.0e}, imbalance {report.imbalance:.0e}"
    return [
        *rows,
        *([("rolls", f"towards {solution.direction}")] if rolls else []),
        ("friction", state if touching else "nothing touches"),
        ("ended", f"{report.termination}, {accuracy}{coupled}"),
    ]


def _rows(
    result: Any, table: Iterable[Quantity], texts: Texts, line: bool, rolls: bool = False
) -> list[tuple[str, str]]:
    """Return the printed rows of quantities; a text in place of a number may leave one out."""
    rows = []
    for row in table:
        if not row.label:
            continue
        if (text_of := texts.get(row.name)) is not None:
            text = text_of(result)
        elif (value := row.of(result)) is None:
            text = None
        elif row.dims:
            text = pair(without_rounding(value), row.si(line=line, rolls=rolls))
        else:
            text = written(value, row.si(line=line, rolls=rolls))
        rows += [] if text is None else [(row.label, text)]
    return rows


def _nothing(_: object) -> None:
    """Leave a row out."""


def _centred(solution: Solution, name: str, unit: str, scale: float = 1.0) -> str | None:
    """Return a position or a moment; rounding leaves 1e-16 of the largest possible one."""
    values: tuple[float, float] = getattr(solution, name)
    limits = [NOISE * scale * side for side in solution.report.grid.size]
    components = [0.0 if abs(v) < limit else v for v, limit in zip(values, limits, strict=True)]
    return _along([None if math.isnan(v) else written(v, unit) for v in components])


def _along(texts: Sequence[str | None], mark: str = ", ", form: str = "({})") -> str | None:
    """Return texts along x and y, that of one axis with its name, or None where there is none."""
    known = [(axis, text) for axis, text in zip("xy", texts, strict=True) if text is not None]
    if len(known) == 1:
        return f"{known[0][1]} along {known[0][0]}"
    return form.format(mark.join(text for _, text in known)) if known else None


def _tilt(solution: Solution) -> str:
    """Return the slopes; a side that they move by rounding of the displacements is not tilted."""
    least = NOISE * float(np.abs(solution.displacement).max())
    sides = zip(solution.tilt, solution.report.grid.size, strict=True)
    return "({:.4g}, {:.4g})".format(*(s if abs(s) * side > least else 0.0 for s, side in sides))


def _place(solution: Solution) -> str | None:
    touches = solution.contact_area > 0
    return _centred(solution, "eccentricity", "m") if touches else "nothing touches"


def _extent(solution: Solution) -> str | None:
    widths = [high - low for low, high in solution.contact_extent]
    sides = [None if math.isnan(width) else written(width, "m") for width in widths]
    return sides[1] if solution.report.grid.is_line else _along(sides, " × ", "{}")


def _contact_share(solution: Solution) -> str | None:
    """Return the share of the area; beside one contact, the area of the grid means nothing."""
    return (
        f"{100 * solution.contact_share:.3g} % of the area" if all(solution.grid.periodic) else None
    )


def _hardness(solution: Solution) -> str | None:
    if (hardness := solution.hardness) is None:
        return None
    words = [written(float(end), "Pa") for end in (np.min(hardness), np.max(hardness))]
    return " to ".join(dict.fromkeys(words))


def _indentation(solution: Solution) -> str | None:
    deepest = float(solution.indentation.max())
    return f"{written(deepest, 'm')} at most, permanent" if deepest > 0 else None


def _with_error(solution: FrictionSolution, name: str, text: str, size: float, unit: str) -> str:
    """Return what is said of a number of rolling, with its discretisation error where there is one.

    The error is one of its `size`, or has a unit where it is larger.
    """
    error = (solution.report.discretisation or {}).get(name, 0.0)
    if error <= NOISE * size:
        return text
    if error < size:
        return f"{text} ± {rounded(100 * error / size, 1)} %"
    return f"{text} ± {written(error, unit, 1) if unit else rounded(error, 1)}"


def _force(solution: FrictionSolution) -> str:
    unit = "N/m" if solution.grid.is_line else "N"
    text = pair(without_rounding(solution.force), unit)
    return _with_error(solution, "force", text, float(np.hypot(*solution.force)), unit)


def _creepage(solution: FrictionSolution) -> str | None:
    if (creepage := solution.creepage) is None:
        return None
    components = "({:.4g}, {:.4g})".format(*without_rounding(creepage))
    return _with_error(solution, "creepage", components, float(np.hypot(*creepage)), "")


def _torque(solution: FrictionSolution) -> str | None:
    if solution.grid.is_line:
        return None
    noise = SLIGHT * max(solution.grid.size) * max(map(abs, solution.force))
    torque = solution.torque if abs(solution.torque) > noise else 0.0
    return _with_error(solution, "torque", written(torque, "N m"), abs(torque), "N m")


def _twist(solution: FrictionSolution) -> str | None:
    is_given = solution.twist is not None and not solution.grid.is_line
    return f"{solution.twist:.4g} rad" if is_given else None


def _dissipated(solution: FrictionSolution) -> str:
    # Power over speed in rolling, and rounding where nothing slips.
    work = max(map(abs, solution.force)) * max(map(abs, solution.shift or (1.0,)))
    lost = solution.dissipated if solution.dissipated > SLIGHT * work else 0.0
    unit = energy(solution.grid.is_line, solution.shift is None)
    return _with_error(solution, "power", written(lost, unit), lost, unit)


NORMAL_TEXTS: Texts = {
    "eccentricity": _place,
    "moment": lambda s: _centred(s, "moment", "N" if s.report.grid.is_line else "N m", s.load),
    "approach": lambda s: _approach(s),
    "tilt": _tilt,
    "peak_pressure": lambda s: estimated(s, "peak_pressure", "Pa"),
    "peak_position": lambda s: _centred(s, "peak_position", "m"),
    "contact_extent": _extent,
    "contact_share": _contact_share,
    "hardness": _hardness,
    "indentation": _indentation,
}
"""Values of a normal contact that are more than a number with its unit."""
FRICTION_TEXTS: Texts = {
    "force": _force,
    "torque": _torque,
    "twist": _twist,
    "creepage": _creepage,
    "spin": lambda s: None if s.spin is None else f"{s.spin:.4g} /{symbol('m')}",
    "dissipated": _dissipated,
}
"""Values of a contact with friction that are more than a number with its unit."""


def without_rounding(values: Sequence[float]) -> list[float]:
    """Return two components; one that is rounding beside the other is 0."""
    largest = max(map(abs, values))
    return [value if abs(value) > SLIGHT * largest else 0.0 for value in values]


def pair(values: Iterable[float], unit: str) -> str:
    """Return components with their units."""
    return f"({', '.join(number(value, unit) for value in values)})"


def _fallback(report: Report) -> str:
    """Return the solver that ended the solve, where a cascade fell back to it."""
    return "" if report.solver in (None, "preconditioned") else f" by the {report.solver} solver"


def motion(motion: Mapping[str, Any]) -> str:
    """Return which degrees of freedom are loaded, given and locked, in words."""
    tilts = []
    for axis, name in enumerate("xy"):
        keys = [
            key
            for key in ("eccentricity", "moment", "tilt")
            if motion.get(key, (None,) * 2)[axis] is not None
        ]
        kind = {"eccentricity": "free", "moment": "free", "tilt": "given"}
        tilts.append(f"{name} {kind[keys[0]] if keys else 'locked'}")
    control = "load" if "load" in motion else "approach"
    return f"{control}; tilt {', '.join(tilts)}"


def line(solution: Solution) -> str:
    """Return the line that ``repr(solution)`` shows."""
    report = solution.report
    nx, ny = report.grid.shape
    counterbody = "rigid" if report.counterbody is None else repr(report.counterbody)
    force = "N/m" if report.grid.is_line else "N"
    return printable(
        f"<Solution on {nx} x {ny} cells, counterbody {counterbody}: "
        f"load {written(solution.load, force, 6)}, "
        f"peak pressure {written(solution.peak_pressure, 'Pa', 6)}, "
        f"approach {written(solution.approach, 'm', 6)}, "
        f"tilt ({solution.tilt[0]:.3e}, {solution.tilt[1]:.3e}), "
        f"{'converged' if report.converged else 'not converged'}>"
    )


def layer_line(layer: LayerStress) -> str:
    """Return the line that the ``repr`` of the extremes of a layer shows."""
    mises, tension = (written(value, "Pa") for value, _ in (layer.von_mises, layer.tension))
    return f"<LayerStress of {_layer(layer)}: von Mises {mises}, tension {tension}>"


def interface_line(face: InterfaceStress) -> str:
    """Return the line that the ``repr`` of the extremes at an interface shows."""
    shear, tension = (written(value, "Pa") for value, _ in (face.shear, face.tension))
    return (
        f"<InterfaceStress of interfaces[{face.interface}] at {written(face.depth, 'm')}: "
        f"shear {shear}, tension {tension}>"
    )


def history(steps: Sequence[FrictionSolution]) -> list[list[str]]:
    """Return the rows of a table of the steps of a history, the heading first."""
    line, rolls = steps[0].grid.is_line, steps[0].shift is None
    force, moved = ("N/m" if line else "N"), ("creepage" if rolls else "shift")
    rows = [["step", "force x", "force y", f"{moved} 1" if rolls else "shift x"]]
    rows[0] += [f"{moved} 2" if rolls else "shift y", "dissipated", "ended"]
    motions = [(step.creepage if rolls else step.shift) or (0.0, 0.0) for step in steps]
    moves = np.reshape(without_rounding(np.ravel(motions).tolist()), (-1, 2))
    pulls = np.reshape(without_rounding(np.ravel([step.force for step in steps]).tolist()), (-1, 2))
    for number, (step, motion, pull) in enumerate(zip(steps, moves, pulls, strict=True)):
        motion_cells = [f"{part:.4g}" if rolls else written(part, "m") for part in motion]
        forces = [written(part, force) for part in pull]
        outcome = [_dissipated(step), step.report.termination]
        rows.append([str(number), *forces, *motion_cells, *outcome])
    return rows


def friction_line(solution: FrictionSolution) -> str:
    """Return the line that ``repr`` of a contact with friction shows."""
    nx, ny = solution.grid.shape
    unit = "N/m" if solution.grid.is_line else "N"
    motion = ("shift", "m") if solution.shift is not None else ("creepage", "")
    values = getattr(solution, motion[0]) or (0.0, 0.0)
    values = without_rounding(values)
    components = pair(values, "m") if motion[1] else "({:.4g}, {:.4g})".format(*values)
    force = pair(without_rounding(solution.force), unit)
    end = "converged" if solution.report.converged else "not converged"
    return printable(
        f"<FrictionSolution on {nx} x {ny} cells: force {force}, {motion[0]} {components}, {end}>"
    )


def text(rows: Sequence[tuple[str, str]], warnings: Sequence[str]) -> str:
    """Return the table that ``print`` shows: names and values, and warnings below."""
    width = max(len(name) for name, _ in rows)
    lines = [f"{name:{width}}  {value}" for name, value in rows]
    return printable("\n".join([*lines, *(f"warning: {warning}" for warning in warnings)]))


def stresses(summary: StressSummary) -> str:
    """Return the table that ``print(solution.stress_summary())`` shows."""
    lines = [*aligned(_peaks(summary), "<"), *_notes(summary)]
    return printable("\n".join([*lines, *(f"warning: {warning}" for warning in summary.warnings)]))


def stresses_markup(summary: StressSummary) -> str:
    """Return the table of a stress summary, for a notebook."""
    head, *rows = _peaks(summary)
    return markup(rows, summary.warnings, head=head, notes=_notes(summary))


def _notes(summary: StressSummary) -> list[str]:
    """Return what stands below the table: the friction, and whether it is unfinished."""
    sliding = []
    friction = summary.friction or (0.0, 0.0)
    if size := float(np.hypot(*friction)):
        x, y = (part / size + 0.0 for part in friction)  # of -0 this makes 0
        sliding = [f"friction {size:.4g}, traction along ({x:.4g}, {y:.4g})"]
    return sliding if summary.finished else [*sliding, UNFINISHED]


def _share(error: float, value: float) -> str:
    """Return an error in per cent of a value."""
    if error == 0:
        return ""
    if error >= abs(value):
        return "> 100 %"
    percent = 100 * error / abs(value)
    return f"{percent:.2g} %" if percent >= 0.01 else "< 0.01 %"


def _peaks(summary: StressSummary) -> list[list[str]]:
    """Return the rows of the table of a stress summary, the heading first."""
    rows = [["", "largest", "value", "±", "z", "x, y", "safety factor"]]
    noise = SLIGHT * max((layer.von_mises[0] for layer in summary.layers), default=0.0)
    peaks = [peak for layer in summary.layers for peak in (layer.von_mises, layer.tension)]
    dust = SLIGHT * max((abs(part) for _, place in peaks for part in place), default=0.0)

    def add(name: str, peak: Peak | None, error: float | None, factor: float | None = None) -> None:
        if peak is None:
            return
        value, (x, y, z) = peak
        if name == "tension" and abs(value) < noise:
            # A tension that falls to nothing far away has no place.
            share = written(error, "Pa") if error is not None and error > noise else ""
            rows.append(["", name, written(0.0, "Pa"), share, "", "", ""])
            return
        share = "" if error is None else _share(error, value)
        place = ", ".join(written(one if abs(one) > dust else 0.0, "m", 3) for one in (x, y))
        number = "" if factor is None else rounded(factor, 3)
        rows.append(["", name, written(value, "Pa"), share, written(z, "m"), place, number])

    for layer in summary.layers:
        start, (top, bottom) = len(rows), layer.depths
        error = layer.uncertainty.get
        add("von Mises", layer.von_mises, error("von_mises"), layer.yield_safety_factor)
        add("tension", layer.tension, error("tension"), layer.strength_safety_factor)
        add("shear", layer.max_shear, error("max_shear"))
        ends = f"{written(top, 'm')} to {written(bottom, 'm')}"
        rows[start][0] = f"{_layer(layer)}, {ends}" if bottom < np.inf else "substrate"
    names = {layer.layer: layer.name for layer in summary.layers}
    for face in summary.interfaces:
        start, above = len(rows), names.get(face.interface)
        error = face.uncertainty.get
        add("tension", face.tension, error("tension"))
        add("compression", face.compression, error("compression"))
        add("shear", face.shear, error("shear"))
        add("in-plane jump", face.jump, error("jump"))
        below = "" if above is None else f" below {above}"
        rows[start][0] = f"interfaces[{face.interface}]{below} at {written(face.depth, 'm')}"
    return rows


def part(part: LayerStress | InterfaceStress | LayerFatigue | InterfaceFatigue) -> str:
    """Return number and name of a layer, or number of an interface, in a summary."""
    number: int | None = getattr(part, "interface", None)
    return _layer(part) if number is None else f"interfaces[{number}]"  # type: ignore[arg-type]


def _layer(layer: LayerStress | LayerFatigue) -> str:
    """Return number and name of a layer in a summary."""
    if layer.depths[1] == np.inf:
        return "the substrate"
    return layer_name(layer.layer, layer.name)


def layer_name(number: int, name: str | None) -> str:
    """Return number and name of a layer."""
    return f"layers[{number}]" if name is None else f"layers[{number}] {name}"


def markup(
    rows: Sequence[Sequence[str]],
    warnings: Sequence[str] = (),
    picture: bytes | None = None,
    head: Sequence[str] = (),
    notes: Sequence[str] = (),
    widest: int = WIDEST,
) -> str:
    """Return what a notebook shows of any result: a table, a picture beside it, and notes below."""
    lines = [*notes, *(f"warning: {text}" for text in warnings)]
    cells = [*([_cells("th", head)] if head else []), *(_cells("td", row) for row in rows)]
    encoded = "" if picture is None else base64.b64encode(picture).decode()
    image = picture and (
        f"<img alt='{ALT}' style='border:1px solid #bbb; max-width:{widest}px' "
        f"src='data:image/png;base64,{encoded}'>"
    )
    return (
        f"<div style='display:flex; gap:16px; align-items:flex-start'>"
        f"<table>{''.join(cells)}</table>{image or ''}</div>"
        + "".join(f"<p>{html.escape(note)}</p>" for note in lines)
    )


def _cells(tag: str, row: Sequence[str]) -> str:
    """Return a row of a table of HTML."""
    cell = f"<{tag} style='text-align:left; padding:1px 12px 1px 0'>"
    return f"<tr>{''.join(f'{cell}{html.escape(text)}</{tag}>' for text in row)}</tr>"


def aligned(rows: Sequence[Sequence[str]], side: str = ">") -> list[str]:
    """Return the lines of a table whose columns are as wide as their widest cells."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(f"{cell:{side}{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]


def thumbnail(pressure: npt.NDArray[np.float64]) -> bytes | None:
    """Return a small PNG of the contact: x to the right, y upwards, white where nothing touches.

    Without Matplotlib there is none.
    """
    try:
        from matplotlib import colormaps
        from matplotlib.image import imsave
    except ImportError:
        return None
    parts = []
    for axis, cells in enumerate(pressure.shape):
        loaded = np.flatnonzero(pressure.any(axis=1 - axis))
        low, high = (loaded[0], loaded[-1]) if loaded.size else (0, cells - 1)
        margin = 1 + (high - low) // 10
        parts.append((max(low - margin, 0), min(high + margin, cells - 1)))
    spans = [high - low + 1 for low, high in parts]
    # A narrow contact stays legible: its map is at least a quarter as high as wide.
    size = [max(WIDEST // 4, WIDEST * span // max(spans)) for span in spans]
    x, y = (
        np.linspace(low, high, count).round().astype(int)
        for (low, high), count in zip(parts, size, strict=True)
    )
    field = np.ma.masked_equal(pressure[np.ix_(x, y)].T, 0.0)
    file = io.BytesIO()
    white = colormaps["viridis"].with_extremes(bad="white")
    imsave(file, field, vmin=0.0, cmap=white, format="png", origin="lower")
    return file.getvalue()


def drawn(draw: Callable[[], Any]) -> bytes | None:
    """Return a PNG of the picture of which `draw` returns the axes; without Matplotlib, none."""
    try:
        from matplotlib import pyplot
    except ImportError:
        return None
    figure, file = draw().figure, io.BytesIO()
    figure.savefig(file, format="png", dpi=100)
    pyplot.close(figure)
    return file.getvalue()


def estimated(solution: Any, name: str, unit: str, digits: int = 4) -> str:
    """Return a number, with the discretisation error where it is estimated."""
    value = getattr(solution, name)
    error = (solution.report.discretisation or {}).get(name, 0.0)
    if error is None:
        return f"{number(value, unit, digits)} (error not known: see the warning)"
    share = abs(error / value) if value else 0.0
    return number(value, unit, digits) + (
        f" ± {rounded(100 * share, 1)} %" if share > NOISE else ""
    )


def _approach(solution: Solution) -> str:
    """Return the approach with its error, or with the datum that it depends on and no error."""
    report = solution.report
    repeats = (True, False) if report.grid.is_line else report.grid.periodic
    if sum(repeats) != 1 or all(map(_is_held, (report.body, report.counterbody))):
        return estimated(solution, "approach", "m")
    datum = report.grid.size[repeats.index(False)]
    return f"{written(solution.approach, 'm')}, from the surface {written(datum, 'm')} away"


def _is_held(body: Planned | None) -> bool:
    """Return whether a body stays in its place far from a load."""
    if isinstance(body, Response):
        return body.limits[0] == 0
    return body is None or isinstance(body.substrate, Rigid)


def _body(name: str, body: Planned | None) -> list[tuple[str, str]]:
    """Describe a body: its substrate, a row for each layer or one for many, and its free ends."""
    if body is None:
        return [(name, "rigid")]
    if isinstance(body, Response):
        return [(name, "a response")]
    layers = [
        (
            f"  {layer_name(number, layer.name)}",
            f"{written(layer.thickness, 'm', 3)}, {_material(layer.material)}"
            f"{_spring(layer.interface)}",
        )
        for number, layer in enumerate(body.layers)
    ]
    if len(layers) > LAYER_ROWS:
        depth = written(body.interfaces[-1], "m", 3)
        layers = [("  layers", f"{len(layers)}, together {depth}")]
    places = [f"x = {written(x, 'm')}" for x in body.ends if x is not None]
    ends = [("  free end" if len(places) == 1 else "  free ends", " and ".join(places))]
    return [(name, _material(body.substrate)), *layers, *(ends if places else [])]


def _moduli(*members: Planned | None) -> list[tuple[str, str]]:
    """Return the contact modulus of the substrates; with coatings also of the surfaces.

    There is none where a body is a response.
    """
    bodies = [body for body in members if isinstance(body, HalfSpace)]
    if any(isinstance(body, Response) for body in members):
        return []
    bases = [one.substrate for one in bodies]
    tops = [one.layers[0].material if one.layers else one.substrate for one in bodies]
    if any(isinstance(base, Free) for base in bases):
        return [("E* (surfaces)", _modulus(tops))]
    rows = [("E* (substrates)" if tops != bases else "E*", _modulus(bases))]
    return rows + ([("E* (surfaces)", _modulus(tops))] if tops != bases else [])


def _modulus(materials: Sequence[Elastic | Rigid | Free]) -> str:
    compliance = sum(1 / m.plane_strain_modulus for m in materials if isinstance(m, Elastic))
    return written(1 / compliance, "Pa") if compliance else "rigid"


def _spring(interface: str | Spring) -> str:
    """Describe the springs below a layer."""
    if not isinstance(interface, Spring):
        return ""
    directions = (("normal", interface.normal), ("tangential", interface.tangential))
    stiffnesses = [f"{name} {written(k, 'Pa/m', 3)}" for name, k in directions if k is not None]
    return f", on springs: {', '.join(stiffnesses)}"


def _material(material: Elastic | Rigid | Free) -> str:
    if isinstance(material, Rigid):
        return "a rigid base"
    if isinstance(material, Free):
        return "a free base"
    return f"E {written(material.young, 'Pa', 3)}, ν {material.poisson:g}"
