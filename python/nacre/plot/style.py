"""Style of the pictures: the width of a page, small type, colours that everybody can tell apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from nacre._extras import extra
from nacre.units import Scale

with extra("plot"):
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes

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
LONGEST = 6.0
"""Side ratio up to which a picture is true to scale."""


def new_axes(width: float, height: float) -> Axes:
    """Return axes of a new figure whose size is given in widths of a page."""
    size = (width * WIDTH, height * WIDTH)
    return plt.figure(figsize=size, layout="constrained").add_subplot()


def look(number: int) -> dict[str, Any]:
    """Return colour and dashes of the curve with that number."""
    return {"color": COLOURS[number % len(COLOURS)], "linestyle": DASHES[number % len(DASHES)]}


def lengths(window: Sequence[npt.ArrayLike] | npt.NDArray[np.float64]) -> tuple[list[Scale], bool]:
    """Return the scales of both sides of a picture, and whether they are the same."""
    sides = np.asarray(window, dtype=np.float64)
    widths = np.diff(sides).ravel()
    scales = [Scale.of(float(np.abs(side).max()), "m") for side in sides]
    same = bool(widths.max() <= LONGEST * widths.min())
    return ([min(scales, key=lambda scale: scale.factor)] * 2 if same else scales), same
