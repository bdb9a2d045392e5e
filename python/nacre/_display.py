"""Printed forms of results: a line, a table; in a notebook with a small map."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from nacre._core import Elastic, HalfSpace, Response, Rigid
from nacre._typing import Planned
from nacre.units import printable, rounded, written

if TYPE_CHECKING:
    from nacre.solution import Report, Solution
    from nacre.stresses import InterfaceStress, LayerStress, StressSummary

Peak = tuple[float, tuple[float, float, float]]

WIDEST = 240
"""Pixels along the longer side of the small map."""
NOISE = 1e-9
"""Share of its largest possible value below which a position or a moment is printed as 0."""
LAYER_ROWS = 4
"""Largest number of layers that get a row each."""
UNFINISHED = "stopped before all depths were done"


def numbers(solution: Solution) -> list[tuple[str, str]]:
    """Return names and values of the main numbers, with units."""
    line = solution.report.grid.is_line
    force, moment = ("N/m", "N") if line else ("N", "N m")
    extent, report = solution.contact_extent, solution.report
    # Rounding leaves moments of 1e-16 of the largest possible ones: a reader wants to see 0.
    arms = [NOISE * side for side in report.grid.size]
    sides = [written(high - low, "m") for low, high in extent]
    touching = solution.contact_area > 0
    nx, ny = report.grid.shape
    repeats = [name for name, is_so in zip("xy", report.grid.periodic, strict=True) if is_so]
    period = f", periodic along {' and '.join(repeats)}" if repeats else ""
    rows = [
        ("load", written(solution.load, force)),
        ("acts at", _pair(solution.eccentricity, "m", arms) if touching else "nothing touches"),
        ("moment", _pair(solution.moment, moment, [solution.load * arm for arm in arms])),
        ("approach", _approach(solution)),
        ("tilt", f"({solution.tilt[0]:.4g}, {solution.tilt[1]:.4g})"),
        ("motion", motion(report.motion)),
        ("peak pressure", _estimated(solution, "peak_pressure", "Pa")),
        ("at", _pair(solution.peak_position, "m", arms)),
        ("contact", sides[1] if line else f"{sides[0]} × {sides[1]}"),
        ("area", written(solution.contact_area, "m" if line else "m²")),
        *_yielded(solution),
        *_body("body", report.body),
        *_body("counterbody", report.counterbody),
        *_moduli(report.body, report.counterbody),
        ("grid", f"{nx} × {ny} cells{period}"),
        ("ended", f"{report.termination}{_fallback(report)}, residual {report.residual:.0e}"),
    ]
    left = set() if touching else {"at", "contact", "area"}
    if len(repeats) == 2:
        # The load of one period acts nowhere in particular.
        left |= {"acts at", "moment", "tilt"}
    return [row for row in rows if row[0] not in left]


def _yielded(solution: Solution) -> list[tuple[str, str]]:
    """Return the hardness, and the permanent indentation where there is one."""
    hardness, deepest = solution.hardness, solution.indentation.max()
    rows = []
    if hardness is not None:
        ends = np.min(hardness), np.max(hardness)
        words = [written(float(end), "Pa") for end in ends]
        rows.append(("hardness", words[0] if ends[0] == ends[1] else " to ".join(words)))
    if deepest > 0:
        rows.append(("indentation", f"{written(float(deepest), 'm')} at most, permanent"))
    return rows


def _fallback(report: Report) -> str:
    """Return the solver that ended the solve, where a cascade fell back to it."""
    return "" if report.solver in (None, "preconditioned") else f" by the {report.solver} solver"


def motion(motion: Mapping[str, Any]) -> str:
    """Return which degrees of freedom are loaded, given and locked, in words."""
    said = []
    for axis, name in enumerate("xy"):
        asked = [
            key
            for key in ("eccentricity", "moment", "tilt")
            if motion.get(key, (None,) * 2)[axis] is not None
        ]
        kind = {"eccentricity": "free", "moment": "free", "tilt": "given"}
        said.append(f"{name} {kind[asked[0]] if asked else 'locked'}")
    control = "load" if "load" in motion else "approach"
    return f"{control}; tilt {', '.join(said)}"


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


def text(solution: Solution) -> str:
    """Return the table that ``print(solution)`` shows."""
    rows = numbers(solution)
    width = max(len(name) for name, _ in rows)
    lines = [f"{name:{width}}  {value}" for name, value in rows]
    lines += [f"warning: {warning}" for warning in solution.report.warnings]
    return printable("\n".join(lines))


def stresses(summary: StressSummary) -> str:
    """Return the table that ``print(solution.stress_summary())`` shows."""
    rows = _peaks(summary)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
    lines += [f"warning: {warning}" for warning in summary.warnings]
    return printable("\n".join(lines if summary.finished else [*lines, UNFINISHED]))


def stresses_markup(summary: StressSummary) -> str:
    """Return the table of a stress summary, for a notebook."""
    heading, *rows = _peaks(summary)
    lines = [_cells("th", heading), *(_cells("td", row) for row in rows)]
    table = f"<table>{''.join(lines)}</table>"
    notes = [f"warning: {html.escape(warning)}" for warning in summary.warnings]
    notes += [] if summary.finished else [UNFINISHED]
    return table + "".join(f"<p>{note}</p>" for note in notes)


def _share(error: float, value: float) -> str:
    """Return an error in per cent of a value."""
    if error >= abs(value):
        return "> 100 %"
    percent = 100 * error / abs(value)
    return f"{percent:.2g} %" if percent >= 0.01 else "< 0.01 %"


def _peaks(summary: StressSummary) -> list[list[str]]:
    """Return the rows of the table of a stress summary, the heading first."""
    rows = [["", "largest", "value", "±", "z", "x, y", "safety factor"]]

    def add(name: str, peak: Peak | None, error: float | None, factor: float | None = None) -> None:
        if peak is None:
            return
        value, (x, y, z) = peak
        share = "" if error is None else _share(error, value)
        place = f"{written(x, 'm', 3)}, {written(y, 'm', 3)}"
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


def _layer(layer: LayerStress) -> str:
    """Return number and name of a layer in a summary."""
    if layer.depths[1] == np.inf:
        return "the substrate"
    return _named(layer.layer, layer.name)


def _named(number: int, name: str | None) -> str:
    return f"layers[{number}]" if name is None else f"layers[{number}] {name}"


def markup(solution: Solution) -> str:
    """Return the table and, with Matplotlib, the small map, for a notebook."""
    rows = "".join(_cells("td", row) for row in numbers(solution))
    notes = "".join(f"<p>warning: {html.escape(text)}</p>" for text in solution.report.warnings)
    picture = thumbnail(solution.pressure)
    image = picture and (
        f"<img alt='pressure, x to the right' style='border:1px solid #bbb; max-width:{WIDEST}px' "
        f"src='data:image/png;base64,{base64.b64encode(picture).decode()}'>"
    )
    return (
        f"<div style='display:flex; gap:16px; align-items:flex-start'><table>{rows}</table>"
        f"{image or ''}</div>{notes}"
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


def table(head: Sequence[str], rows: Sequence[Sequence[str]], notes: Sequence[str]) -> str:
    """Return a table with notes below, for a notebook."""
    cells = _cells("th", head) + "".join(_cells("td", row) for row in rows)
    return f"<table>{cells}</table>" + "".join(f"<p>{html.escape(note)}</p>" for note in notes)


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


def _estimated(solution: Solution, name: str, unit: str) -> str:
    """Return a number, with the discretisation error where it is estimated."""
    value = getattr(solution, name)
    error = (solution.report.discretisation or {}).get(name, 0.0)
    if error is None:
        return f"{written(value, unit)} (error not known: see the warning)"
    share = abs(error / value) if value else 0.0
    return written(value, unit) + (f" ± {rounded(100 * share, 1)} %" if share > NOISE else "")


def _approach(solution: Solution) -> str:
    """Return the approach with its error, or with the datum that it depends on and no error."""
    report = solution.report
    repeats = (True, False) if report.grid.is_line else report.grid.periodic
    if sum(repeats) != 1 or all(map(_is_held, (report.body, report.counterbody))):
        return _estimated(solution, "approach", "m")
    datum = report.grid.size[repeats.index(False)]
    return f"{written(solution.approach, 'm')}, from the surface {written(datum, 'm')} away"


def _pair(values: tuple[float, float], unit: str, noise: Sequence[float]) -> str:
    kept = (0.0 if abs(v) < limit else v for v, limit in zip(values, noise, strict=True))
    return f"({', '.join(written(value, unit) for value in kept)})"


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
            f"  {_named(number, layer.name)}",
            f"{written(layer.thickness, 'm', 3)}, {_material(layer.material)}",
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
    rows = [("E* (substrates)" if tops != bases else "E*", _modulus(bases))]
    return rows + ([("E* (surfaces)", _modulus(tops))] if tops != bases else [])


def _modulus(materials: Sequence[Elastic | Rigid]) -> str:
    compliance = sum(1 / m.plane_strain_modulus for m in materials if isinstance(m, Elastic))
    return written(1 / compliance, "Pa") if compliance else "rigid"


def _material(material: Elastic | Rigid) -> str:
    if isinstance(material, Rigid):
        return "a rigid base"
    return f"E {written(material.young, 'Pa', 3)}, ν {material.poisson:g}"
