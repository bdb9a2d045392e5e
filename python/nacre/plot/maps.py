"""The pressure from above, and the overview of a solution."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre._tools.rounding import ceil, floor
from nacre._tools.units import Scale
from nacre.plot.sections import section
from nacre.plot.style import COLOURMAP, WIDTH, extent, lengths, new_axes, outline, styled

with extra("plot"):
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes

if TYPE_CHECKING:
    from nacre.contact.solution import Solution


LETTERS = 22
"""Letters of a line of the table of numbers; longer ones are wrapped."""
TOGETHER = re.compile(r"(?<=\d) (?=[A-Za-zµ%])|(?<=[=ν±]) ")
"""Spaces within a number with its sign and its unit, at which no line ends."""


def overview(solution: Solution, axes: Axes | Mapping[str, Axes] | None = None) -> dict[str, Axes]:
    """Draw map, sections and main numbers.

    Parameters
    ----------
    solution
        Solution to draw.
    axes
        Where to draw: axes by any of the names "map", "x", "y" and "numbers", as
        ``subplot_mosaic`` makes them, or one for the map; a new figure by default.

    Returns
    -------
    dict of matplotlib.axes.Axes
        The axes, by name.

    Raises
    ------
    ValueError
        If there is no part of that name.
    """
    line = solution.report.grid.is_line
    with styled():
        if axes is None:
            layout: list[Any] = [["y", "numbers"]] if line else [["map", "numbers"], ["x", "y"]]
            size = (WIDTH, (0.42 if line else 0.78) * WIDTH)
            figure = plt.figure(figsize=size, layout="constrained")
            axes = figure.subplot_mosaic(layout, width_ratios=(1.25, 1))
        elif isinstance(axes, Axes):
            axes = {"map": axes}
        panels = dict(axes)
        for name, panel in panels.items():
            if name == "map":
                pressure_map(solution, panel)
            elif name == "x":
                section(solution, "x", axes=panel)
            elif name == "y":
                section(solution, "y", axes=panel)
            elif name == "numbers":
                _numbers(solution, panel)
            else:
                raise ValueError(f"axes must be named map, x, y or numbers, got {name!r}")
    return panels


def pressure_map(solution: Solution, axes: Axes | None = None) -> Axes:
    """Draw the pressure from above, with the outline of the contact.

    A contact much longer than wide is drawn out of scale, and the picture says so. The cross marks
    where the resultant force acts. A direction in which the surfaces repeat is drawn whole; where
    both repeat, the share of the area stands above in place of the cross.

    Parameters
    ----------
    solution
        Solution to draw.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        If the grid is one of strips, `Grid.line`, which has no map.
    """
    grid = solution.report.grid
    if grid.is_line:
        raise ValueError("the grid of a solution must have cells along x for a map, got a line")
    ends = [(c - side / 2, c + side / 2) for c, side in zip(grid.center, grid.size, strict=True)]
    window = _window(solution, np.array(ends))
    scales, same = lengths(window)
    scale = Scale.of(solution.peak_pressure, "Pa")
    with styled():
        axes = axes or new_axes(0.7, 0.5)
        highest = scale.factor * solution.peak_pressure or 1.0
        cells, sides = _cells_within(window, ends, grid.spacing)
        pressure = scale.factor * solution.pressure[cells]
        loaded = np.where(solution.in_contact[cells], pressure, np.nan)
        left, right, bottom, top = (
            length.factor * end for length, pair in zip(scales, sides, strict=True) for end in pair
        )
        image = axes.imshow(
            loaded.T,
            extent=(left, right, bottom, top),
            origin="lower",
            aspect="auto",
            cmap=COLOURMAP,
            vmin=0,
            vmax=highest,
        )
        axes.grid(visible=False)
        colourbar: Any = axes.figure.colorbar(image, ax=axes, label=f"pressure [{scale.unit}]")
        colourbar.outline.set_linewidth(0.6)
        axes.set(
            xlabel=f"x [{scales[0].unit}]",
            ylabel=f"y [{scales[1].unit}]",
            xlim=scales[0].factor * window[0],
            ylim=scales[1].factor * window[1],
        )
        outline(axes, solution, [length.factor for length in scales])
        if solution.contact_area > 0 and not any(grid.periodic):
            _mark_resultant(axes, solution, scales)
        if same:
            axes.set_aspect("equal")
        axes.set_title(_title(solution) + ("" if same else "; x and y to different scales"))
    return axes


def _window(solution: Solution, ends: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the ends of the picture: a margin around the contact, or those of a period."""
    if solution.contact_area <= 0:
        return ends
    grid, contact = solution.report.grid, extent(solution)
    margin = 0.15 * np.diff(contact) + np.array(grid.spacing)[:, np.newaxis]
    around = np.clip(contact + margin * [-1, 1], ends[:, :1], ends[:, 1:])
    return np.where(np.array(grid.periodic)[:, np.newaxis], ends, around)


def _mark_resultant(axes: Axes, solution: Solution, scales: Sequence[Scale]) -> None:
    """Draw a cross where the resultant force acts."""
    at = [length.factor * e for length, e in zip(scales, solution.eccentricity, strict=True)]
    for colour, width in (("black", 2.6), ("white", 1.2)):
        axes.plot(
            *at, color=colour, linestyle="none", marker="+", markersize=8, markeredgewidth=width
        )


def _title(solution: Solution) -> str:
    """Return what the map shows besides the pressure."""
    periodic = solution.report.grid.periodic
    if solution.contact_area <= 0:
        return "nothing touches"
    if all(periodic):
        return f"{100 * solution.contact_share:.3g} % of the area touches"
    if any(periodic):
        return f"periodic along {'xy'[periodic.index(True)]}"
    return "the cross marks the resultant force"


def _cells_within(
    window: npt.NDArray[np.float64], ends: Sequence[tuple[float, float]], spacing: Sequence[float]
) -> tuple[tuple[slice, ...], list[tuple[float, float]]]:
    """Return the cells of a grid within a window ``(2, 2)``, and the ends of their block [m]."""
    cells, sides = [], []
    for (low, high), (start, _), step in zip(window, ends, spacing, strict=True):
        first, last = int(floor((low - start) / step)), int(ceil((high - start) / step))
        cells.append(slice(first, last))
        sides.append((start + first * step, start + last * step))
    return tuple(cells), sides


def _numbers(solution: Solution, axes: Axes) -> None:
    """Write the main numbers into axes of their own."""
    axes.set_axis_off()
    rows = [
        (row.label if number == 0 else "", line.replace("\u00a0", " "))
        for row in (*solution._rows(), *solution._remarks())
        for number, line in enumerate(textwrap.wrap(TOGETHER.sub("\u00a0", row.text), LETTERS))
    ]
    step = 1 / max(16, len(rows))
    for number, (name, value) in enumerate(rows):
        height = 1 - (number + 0.5) * step
        for text, offset, colour in ((name, 0, "0.35"), (value, 68, "black")):
            axes.annotate(
                text,
                (0, height),
                xycoords="axes fraction",
                xytext=(offset, 0),
                textcoords="offset points",
                va="center",
                fontsize=7.5,
                color=colour,
            )
