"""Style of the pictures: the width of a page, small type, colours that everybody can tell apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre._tools.units import Scale

with extra("plot"):
    import matplotlib as mpl
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes

if TYPE_CHECKING:
    from nacre.contact.solution import Solution

WIDTH = 18 / 2.54
"""Width of a page between its margins [inch]."""

STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.linewidth": 0.6,
    "axes.xmargin": 0.02,
    "grid.color": "0.92",
    "grid.linewidth": 0.6,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "legend.handlelength": 2.6,
    "lines.linewidth": 1.3,
    "xtick.labelsize": 8,
    "xtick.major.width": 0.6,
    "ytick.labelsize": 8,
    "ytick.major.width": 0.6,
}

# Colours of the palette of Okabe and Ito.
COLOURS = ("#0072B2", "#D55E00", "#000000", "#56B4E9", "#E69F00", "#009E73", "#CC79A7")
DASHES = ("-", (0, (6, 1.5)), (0, (3, 1)), (0, (6, 1.5, 1, 1.5)), (0, (1, 0.7)))
COLOURMAP = "viridis"
SIGNED = "RdBu_r"
"""Colours of a quantity that may be tension or compression."""
CURVE = "nacre-curve"
"""Group that marks the curves that nacre drew."""
THICKEST = 0.7
"""Largest width of an outline [points]."""
LONGEST = 6.0
"""Side ratio up to which a picture is true to scale."""


@contextmanager
def styled() -> Iterator[None]:
    """Draw in the style of nacre.

    Only these settings are put back afterwards. Matplotlib's ``rc_context`` puts back all of them,
    also the interactive mode, which a notebook's backend switches on when a figure first loads it.
    """
    before = {name: mpl.rcParams[name] for name in STYLE}
    mpl.rcParams.update(STYLE)
    try:
        yield
    finally:
        mpl.rcParams.update(before)


def new_axes(width: float, height: float) -> Axes:
    """Return axes of a new figure whose size is given in widths of a page."""
    size = (width * WIDTH, height * WIDTH)
    return plt.figure(figsize=size, layout="constrained").add_subplot()


def look(number: int) -> dict[str, Any]:
    """Return colour and dashes of the curve with that number."""
    return {"color": COLOURS[number % len(COLOURS)], "linestyle": DASHES[number % len(DASHES)]}


def next_look(axes: Axes) -> dict[str, Any]:
    """Return colour and dashes for one more curve of nacre in these axes."""
    return look(sum(line.get_gid() == CURVE for line in axes.lines)) | {"gid": CURVE}


def lengths(window: Sequence[npt.ArrayLike] | npt.NDArray[np.float64]) -> tuple[list[Scale], bool]:
    """Return the scales of both sides of a picture, and whether they are the same."""
    sides = np.asarray(window, dtype=np.float64)
    widths = np.diff(sides).ravel()
    scales = [Scale.of(float(np.abs(side).max()), "m") for side in sides]
    same = bool(widths.max() <= LONGEST * widths.min())
    return ([min(scales, key=lambda scale: scale.factor)] * 2 if same else scales), same


def extent(solution: Solution) -> npt.NDArray[np.float64]:
    """Return the ends of the contact along x and y, of the grid where a periodic contact has none.

    The second axis of the array is that of the ends.
    """
    grid, ends = solution.grid, np.array(solution.contact_extent)
    whole = np.array(grid.center)[:, np.newaxis] + np.outer(grid.size, [-0.5, 0.5])
    return np.where(np.isnan(ends), whole, ends)


def outline(axes: Axes, solution: Solution, factors: Sequence[float]) -> None:
    """Draw the outline of the contact; a patch gets a line of a sixth of its mean width at most."""
    touching = solution.in_contact
    if not touching.any():
        return
    # The cells of the contact, and those beside them.
    ends = [np.flatnonzero(touching.any(axis=axis))[[0, -1]] for axis in (1, 0)]
    block = tuple(slice(max(first - 1, 0), last + 2) for first, last in ends)
    inside = touching[block]
    # Cells of contact per run of such cells, along each side, in points of the picture.
    width = min(
        inside.sum() / (np.diff(inside.astype(np.int8), axis=axis, prepend=0) == 1).sum() * points
        for axis, points in enumerate(_points_per_cell(axes, solution, factors))
    )
    axes.contour(
        factors[0] * solution.x[block[0]],
        factors[1] * solution.y[block[1]],
        inside.T.astype(float),
        levels=[0.5],
        colors="black",
        linewidths=min(THICKEST, float(width) / 6),
    )


def _points_per_cell(axes: Axes, solution: Solution, factors: Sequence[float]) -> list[float]:
    """Return the sides of a cell in the picture [points], once its limits are set."""
    box = axes.get_window_extent()
    spacing = solution.report.grid.spacing
    widths = [np.ptp(limits) for limits in (axes.get_xlim(), axes.get_ylim())]
    return [
        72 / axes.figure.dpi * pixels * factor * side / width
        for pixels, factor, side, width in zip(
            (box.width, box.height), factors, spacing, widths, strict=True
        )
    ]


def checked_axes(axes: object) -> Axes | None:
    """Return axes of Matplotlib, or None where there are none yet; a `TypeError` for all else."""
    if axes is not None and not isinstance(axes, Axes):
        raise TypeError(f"axes must be axes of Matplotlib, got {axes!r}")
    return axes
