"""Charts as data: what a picture shows, for the drawers of SVG and of Matplotlib."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from nacre._tools.units import Scale, symbol
from nacre.results import display
from nacre.results.tables import Gridded, Peaked

Array = npt.NDArray[np.float64]
Ends = tuple[float, float]
Look = Literal["line", "solid", "dashed", "thin", "marked", "points", "graded"]
"""How a curve is drawn: a thin one has the colour of that before, graded ones those of a map."""

THIN, ENLARGED = 0.1, 3.0
"""Share of the depth below which layers are enlarged, and their thicknesses that are drawn then."""
NEAREST = 1.5
"""Distance in cells from the outermost of a contact within which its edge is."""
NO_EDGE: Array = np.empty((0, 2))
LINE = 0.01
"""Width of a line over the height of a picture: curves that are nearer look alike."""
HEADROOM = 0.05
"""Share of the range that stays free beyond curves, where they do not end at 0."""


class Step(Gridded, Protocol):
    """A step of sliding or rolling."""

    @property
    def shift(self) -> tuple[float, float] | None:
        """Shift along x and y [m]; none of rolling."""

    @property
    def force(self) -> tuple[float, float]:
        """Tangential force along x and y."""


class Axis(NamedTuple):
    """What is drawn along an axis; the ends are those of the numbers by default.

    Numbers are in the units that are set; their unit is named by that of SI.
    """

    name: str
    unit: str = ""
    ends: Ends | None = None
    scale: Literal["linear", "log"] = "linear"
    has_zero: bool = True
    """Whether a linear axis of y has 0 among its numbers."""
    is_exact: bool = False
    """Whether numbers are in this very unit, whatever units are set, as those of Datasets."""

    def units(self, largest: float) -> tuple[Scale, str]:
        """Return the scale of numbers of which the largest is given, and the label."""
        scale = display.scale_in(largest, self.unit if self.is_exact else symbol(self.unit))
        return scale, f"{self.name} [{scale.unit}]".strip() if scale.unit else self.name


class Curve(NamedTuple):
    """Numbers along x and y."""

    x: Array
    y: Array
    label: str = ""
    look: Look = "line"


class Chart(NamedTuple):
    """Curves over their axes."""

    caption: str
    """What it shows."""
    curves: Sequence[Curve]
    axes: tuple[Axis, Axis]
    marks: Sequence[float] = ()
    """Places along x of lines."""
    inset: Ends | None = None
    """Part of x that is drawn again, larger."""
    title: str = ""
    """What stands above it where there is no caption."""


class Bars(NamedTuple):
    """Loads ``(Z, n)`` around a ring, at angles from x [rad], n beside each other."""

    caption: str
    angles: Array
    loads: Array
    axis: Axis
    labels: Sequence[str] = ()


class Map(NamedTuple):
    """Values of cells ``(nx, ny)``, x to the right and y upwards; NaN stays white.

    The axes are those of x and y, whose ends are those of the map, and of the values.
    """

    caption: str
    values: Array
    axes: tuple[Axis, Axis, Axis]


Picture = Chart | Bars | Map


def enlarged_depth(interfaces: Sequence[float], bottom: float) -> float:
    """Return the depth to which a picture enlarges thin layers; 0 where there are none."""
    thin = [depth for depth in interfaces if depth < THIN * bottom]
    return ENLARGED * max(thin, default=0.0)


def section(result: Peaked, axis: int, edge: Array = NO_EDGE) -> tuple[Array, Array]:
    """Return places along x or y through the largest pressure, where it is loaded, and it there.

    It falls to 0 at the edge, of which points (x, y) are given, and else in the next cell.
    """
    pressure, centres = result.pressure, (result.x, result.y)
    row = np.unravel_index(pressure.argmax(), pressure.shape)[1 - axis]
    line, ends = np.take(pressure, row, axis=1 - axis), []
    for cell, outwards, end in ends_along(result, axis, float(centres[1 - axis][row]), edge):
        ends.append(end)
        if outwards * (centres[axis][cell] - end) > 0:
            line[cell] = 0.0
    low, high = display.loaded_parts(pressure)[axis]
    places = np.concatenate([centres[axis][low : high + 1], ends])
    order = places.argsort(kind="stable")
    return places[order], np.concatenate([line[low : high + 1], np.zeros(len(ends))])[order]


def ends_along(
    result: Peaked, axis: int, at: float, edge: Array
) -> Iterator[tuple[int, int, float]]:
    """Yield the ends of the contact on a line along x or y, of whose edge points (x, y) are given.

    Each has its outermost cell, 1 or -1 for the side on which it is, and its place [m].
    """
    centres, turned = (result.x, result.y), [axis, 1 - axis]
    points, sides = edge[:, turned], np.array(result.grid.spacing)[turned]
    row = np.abs(centres[1 - axis] - at).argmin()
    loaded = np.take(result.pressure, row, axis=1 - axis) > 0
    for cell in np.flatnonzero(np.diff(loaded)).tolist():
        outermost, outwards = (cell, 1) if loaded[cell] else (cell + 1, -1)
        away = np.abs(points - (centres[axis][outermost], at)) / sides
        near = points[(away <= NEAREST).all(axis=1)]
        if near.size:
            along, across = near[near[:, 1].argsort()].T
            yield outermost, outwards, float(np.interp(at, across, along))


def contact_charts(result: Peaked) -> list[Picture]:
    """Return the pressure of a contact along x and y through its largest, and over the cells."""
    if not result.pressure.any():
        return []
    pressure = Axis("pressure", "Pa")
    sections = [
        Chart(
            f"Pressure along {'xy'[axis]} through the largest value.",
            [Curve(*section(result, axis))],
            (Axis("xy"[axis], "m"), pressure),
        )
        for axis in ((1,) if result.grid.is_line else (0, 1))
    ]
    if result.grid.is_line:
        return [*sections]
    (along_x,), (along_y,) = (chart.curves for chart in sections)
    if _are_alike(along_x, along_y):
        caption = sections[0].caption.removesuffix(".")
        sections = [sections[0]._replace(caption=f"{caption}; along y it is the same.")]
    caption = "Pressure over the contact, with separate scales of x and y; white: no contact."
    return [*sections, contact_map(result, result.pressure, pressure, caption)]


def _are_alike(first: Curve, second: Curve) -> bool:
    """Return whether two curves are on top of each other in a picture."""
    return all(
        one.shape == other.shape and np.allclose(one, other, 0.0, LINE * np.ptp(one))
        for one, other in ((first.x, second.x), (first.y, second.y))
    )


def contact_map(result: Peaked, values: Array, axis: Axis, caption: str) -> Map:
    """Return the map of values ``(nx, ny)`` in the contact, white where nothing touches."""
    pressure, places = result.pressure, (result.x, result.y)
    cells = [slice(low, high + 1) for low, high in display.loaded_parts(pressure)]
    x, y = (
        Axis(name, "m", (float(side[span][0] - step / 2), float(side[span][-1] + step / 2)))
        for name, side, span, step in zip("xy", places, cells, result.grid.spacing, strict=True)
    )
    loaded = np.where(pressure > 0, values, np.nan)[cells[0], cells[1]]
    return Map(caption, loaded, (x, y, axis))


def loop_chart(steps: Sequence[Step], axis: int) -> Chart:
    """Return the force over the shift, along x or y, of steps of sliding."""
    shifts = np.array([step.shift[axis] for step in steps if step.shift is not None])
    forces = np.array([step.force[axis] for step in steps])
    unit, name = "N/m" if steps[0].grid.is_line else "N", "xy"[axis]
    axes = Axis(f"shift along {name}", "m"), Axis(f"force along {name}", unit)
    return Chart(
        "Tangential force over shift, all steps.", [Curve(shifts, forces, look="marked")], axes
    )
