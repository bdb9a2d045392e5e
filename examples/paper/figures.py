"""The six figures of Spinu et al., drawn with Matplotlib at the width of a page."""

from __future__ import annotations

import io
import itertools
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from nacre.plot.style import WIDTH, styled
from paper.cases import (
    CENTRED,
    ECCENTRIC,
    HALF_FLAT,
    RATIOS,
    SPHERE,
    Array,
    Result,
    Series,
    half_width,
    of_series,
)
from paper.evaluation import references, sphere_profile, thickness_note

# Colours of the palette of Okabe and Ito: soft coatings cold, stiff ones warm.
COLOURS = ("#0072B2", "#56B4E9", "#000000", "#E69F00", "#D55E00")
DASHES = ((0, (6, 1.5)), (0, (6, 1.5, 1, 1.5)), "-", (0, (3, 1)), (0, (1, 0.7)))
LOOKS: dict[float, dict[str, Any]] = {
    ratio: {"color": colour, "linestyle": dashes}
    for ratio, colour, dashes in zip(RATIOS, COLOURS, DASHES, strict=True)
}
MARKS: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markersize": 4,
    "markerfacecolor": "none",
    "markeredgewidth": 0.8,
    "color": "0.3",
    "clip_on": False,
}

Axis = Literal["x", "y"]
Row = Sequence[str | float]


@dataclass(frozen=True)
class Drawing:
    """A figure as a PNG file, and the numbers it shows."""

    png: bytes
    header: Sequence[str]
    rows: list[Row]


def draw(results: Iterable[Result]) -> list[Drawing]:
    """Draw figures 1 to 6 from the results of all cases."""
    results = list(results)
    return [figure(number, results) for number in FIGURES]


def figure(number: int, results: Iterable[Result]) -> Drawing:
    """Draw one of figures 1 to 6 from the results of all cases.

    Raises
    ------
    ValueError
        If Spinu et al. have no figure of that number.
    """
    if number not in FIGURES:
        raise ValueError(f"number must be one of {', '.join(map(str, FIGURES))}, got {number!r}")
    with styled():
        return FIGURES[number](list(results))


def _sphere(results: list[Result]) -> Drawing:
    """Draw p/p_H over r/a_H for every ratio, with the reference values."""
    figure = Figure(figsize=(WIDTH, 0.6 * WIDTH), layout="constrained")
    axes = figure.add_subplot()
    axes.set_title("Rigid paraboloid on a coated half-space, $h / a_\\mathrm{H} = 1$, $\\nu = 0.3$")
    axes.set_xlabel("$r\\,/\\,a_\\mathrm{H}$")
    axes.set_ylabel("$p\\,/\\,p_\\mathrm{H}$")
    rows: list[Row] = []
    for result, reference in zip(of_series(results, SPHERE), references(), strict=True):
        radius, pressure = _loaded(*sphere_profile(result))
        look = LOOKS[result.ratio]
        axes.plot(radius, pressure, **look)
        axes.plot(
            reference.radius[::2], reference.pressure[::2], **MARKS | {"color": look["color"]}
        )
        rows += rows_of("computed", result.ratio, radius, pressure)
        rows += rows_of("reference", result.ratio, reference.radius, reference.pressure)
    axes.set(xlim=(0, 1.55), ylim=(0, None))
    axes.legend(handles=[*_ratio_handles(), Line2D([], [], **MARKS, label="reference values")])
    return finish(figure, ("source", "E1/E2", "r/a_H", "p/p_H"), rows)


def _profiles(
    results: list[Result], layout: list[list[tuple[Series, Axis]]], height: float
) -> Drawing:
    """Draw pressure along x or y for every ratio, one panel for each entry of `layout`."""
    figure = Figure(figsize=(WIDTH, height * WIDTH), layout="constrained")
    mixed = len({axis for _, axis in layout[0]}) > 1
    panels = figure.subplots(
        len(layout),
        len(layout[0]),
        sharex="col" if mixed else "all",
        sharey="all",
        squeeze=False,
        width_ratios=(2.2, 1) if mixed else None,
    )
    rows: list[Row] = []
    flat = itertools.chain.from_iterable(layout)
    for axes, (series, axis), letter in zip(panels.flat, flat, "abcd", strict=False):
        for result in of_series(results, series):
            position, pressure = result.profile(axis)
            position, pressure = _loaded(1e3 * position, 1e-6 * pressure)
            axes.plot(position, pressure, **LOOKS[result.ratio])
            rows += rows_of(axis, 1e3 * series.thickness, result.ratio, position, pressure)
        if axis == "x":
            _landmarks(axes, series)
        cut = "y = 0" if axis == "x" else "x = 0"
        axes.set_title(f"({letter}) $h$ = {1e3 * series.thickness:g} mm, ${cut}$")
        axes.set(xlabel=f"${axis}$ [mm]", ylabel="pressure [MPa]")
        axes.label_outer()
    panels[0, 0].set_ylim(0, 1.05 * max(float(row[-1]) for row in rows))
    figure.legend(handles=_ratio_handles(), loc="outside upper center", ncols=len(LOOKS))
    note = textwrap.fill(thickness_note(results), 116)
    figure.supxlabel(note, x=0.01, ha="left", fontsize=8, linespacing=1.3)
    return finish(figure, ("along", "h [mm]", "E1/E2", "position [mm]", "pressure [MPa]"), rows)


def _landmarks(axes: Axes, series: Series) -> None:
    """Mark the ends of the cylindrical part, and the load where it is off centre."""
    text: dict[str, Any] = {"textcoords": "offset points", "color": "0.4", "fontsize": 8}
    for end in (-HALF_FLAT, HALF_FLAT):
        axes.axvline(1e3 * end, color="0.6", linewidth=0.7, zorder=0)
    axes.annotate("end of the cylindrical part", (-1e3 * HALF_FLAT, 0), xytext=(4, 5), **text)
    if series in ECCENTRIC and series.eccentricity:
        at = 1e3 * series.eccentricity[0]
        axes.plot(at, 0, color="0.4", marker="^", clip_on=False)
        axes.annotate("load", (at, 0), xytext=(6, 5), **text)


def _surface(results: list[Result], series: Series) -> Drawing:
    """Draw the pressure for E1 = E2 over the plane of contact."""
    result = next(r for r in of_series(results, series) if r.ratio == 1)
    x, y, pressure = _mesh(result)
    figure = Figure(figsize=(WIDTH, 0.55 * WIDTH))
    place = (-0.07, 0.0, 1.07, 1.02)
    # Any: Matplotlib's three-dimensional axes are not typed.
    axes: Any = figure.add_axes(place, projection="3d", computed_zorder=False)
    corners = np.stack([pressure[:-1, :-1], pressure[1:, :-1], pressure[:-1, 1:], pressure[1:, 1:]])
    colours = mpl.colormaps["viridis"](corners.mean(axis=0) / pressure.max())
    facets = {"rstride": 1, "cstride": 1, "shade": False, "antialiased": False, "clip_on": False}
    axes.plot_surface(x, y, pressure, facecolors=colours, **facets)
    # Lines where the surface does not hide them: sections on the near side, and the ridge.
    line: dict[str, Any] = {"color": "black", "linewidth": 0.7, "zorder": 3, "clip_on": False}
    near = slice(0, y.shape[1] // 2 + 1)
    sections = [int(np.argmin(np.abs(x[:, 0] - position))) for position in range(-10, 15, 5)]
    for i in sections:
        axes.plot(x[i, near], y[i, near], pressure[i, near], **line)
    ridge = (slice(sections[0], None), near.stop - 1)
    axes.plot(x[ridge], y[ridge], pressure[ridge], **line)
    axes.set(xlabel="$x$ [mm]", ylabel="$y$ [mm]", zlabel="pressure [MPa]")
    axes.set(xlim=(-15, 15), ylim=(-0.05, 0.05))
    axes.set_zlim(bottom=0)
    axes.set_yticks(np.arange(-0.04, 0.05, 0.02))
    axes.tick_params(pad=1)
    axes.set_box_aspect((2.4, 1, 0.9), zoom=1.2)
    axes.view_init(elev=28, azim=-60)
    load = "centred" if series in CENTRED else "at $e/L = 0.3$"
    figure.text(0.02, 0.94, f"$E_1 = E_2$: the same for every $h$; load {load}")
    rows = [row for columns in zip(x, y, pressure, strict=True) for row in rows_of(*columns)]
    return finish(figure, ("x [mm]", "y [mm]", "pressure [MPa]"), rows)


def _mesh(result: Result) -> tuple[Array, Array, Array]:
    """Return x, y [mm] and pressure [MPa] at nodes that follow the edge of the contact.

    Nodes are close where the pressure is steep. Along x they are among the cell centres; along y
    p² is interpolated in y², in which it is nearly linear.
    """
    solution = result.solution
    steps = np.sin(np.linspace(-0.5, 0.5, 141) * np.pi)
    ends = np.flatnonzero(solution.pressure.any(axis=1))[[0, -1]]
    lines = np.unique(np.interp(steps, (-1, 1), ends).round().astype(int))
    x = np.concatenate(([0.0], solution.x[lines], [0.0]))
    x[[0, -1]] = solution.contact_extent[0]
    y, pressure = np.zeros((2, len(x), 81))
    across = np.sin(np.linspace(-0.5, 0.5, 81) * np.pi)
    for k, i in enumerate(lines, start=1):
        edge = half_width(solution.y, solution.pressure[i])
        y[k] = edge * across
        # The outermost cell has the least accurate pressure: the edge replaces it.
        inner = np.flatnonzero((solution.y >= 0) & (solution.pressure[i] > 0))
        inner = inner[: max(1, len(inner) - 1)]
        places, pressures = solution.y[inner], solution.pressure[i, inner]
        squares = np.interp(y[k] ** 2, [*places**2, edge**2], [*pressures**2, 0])
        pressure[k] = np.sqrt(squares)
    return 1e3 * np.tile(x[:, np.newaxis], y.shape[1]), 1e3 * y, 1e-6 * pressure


def _loaded(position: Array, pressure: Array) -> tuple[Array, Array]:
    """Cut off the cells without pressure on both sides, except for one on each."""
    loaded = np.flatnonzero(pressure)
    part = slice(max(0, loaded[0] - 1), loaded[-1] + 2)
    return position[part], pressure[part]


def rows_of(*columns: str | float | Array) -> list[Row]:
    """Return rows of the values in `columns`; a value that is no array is repeated in every row."""
    arrays = [column for column in columns if isinstance(column, np.ndarray)]
    return [
        (*(column for column in columns if not isinstance(column, np.ndarray)), *values)
        for values in zip(*arrays, strict=True)
    ]


def _ratio_handles() -> list[Line2D]:
    names = ("1/4", "1/2", "1", "2", "4")
    return [
        Line2D([], [], **look, label=f"$E_1/E_2$ = {name}")
        for look, name in zip(LOOKS.values(), names, strict=True)
    ]


def finish(figure: Figure, header: Sequence[str], rows: list[Row]) -> Drawing:
    """Return a figure as PNG, with the numbers that it shows."""
    png = io.BytesIO()
    figure.savefig(png, format="png", dpi=300)
    return Drawing(png.getvalue(), header, rows)


_MAIN, _PRINTED = ECCENTRIC
FIGURES: dict[int, Callable[[list[Result]], Drawing]] = {
    1: _sphere,
    2: lambda results: _profiles(results, [[(series, "x")] for series in CENTRED], height=0.75),
    3: lambda results: _profiles(results, [[(series, "y") for series in CENTRED]], height=0.55),
    4: lambda results: _surface(results, CENTRED[0]),
    5: lambda results: _profiles(
        results, [[(s, "x"), (s, "y")] for s in (_MAIN, _PRINTED)], height=0.85
    ),
    6: lambda results: _surface(results, _MAIN),
}
"""Functions that draw the figures from the results of all cases."""
