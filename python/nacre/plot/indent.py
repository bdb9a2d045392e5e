"""Pictures of fits of indentation curves."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np

from nacre._core import integer
from nacre._tools.extras import extra
from nacre._tools.units import Scale, written
from nacre.plot.drawer import draw
from nacre.plot.style import COLOURS, WIDTH, new_axes, styled

with extra("plot"):
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes

if TYPE_CHECKING:
    from nacre.indent.fit import Fit
    from nacre.indent.solution import IndentSolution

LETTERS = 96
"""Letters of a line of a report; longer ones are wrapped."""
KEEP = textwrap.TextWrapper(LETTERS, drop_whitespace=False, subsequent_indent="    ")
"""Wrapping that keeps the columns of tables."""


def fit_plot(fit: Fit, axes: Axes | None = None, *, curve: int = 0) -> Axes:
    """Draw the data and the model of a fit; without axes, the residuals below, in a new figure.

    Parameters
    ----------
    fit
        A fit.
    axes
        Axes to draw into; a new figure with the residuals by default.
    curve
        Number of the curve.

    Returns
    -------
    matplotlib.axes.Axes
        The axes of data and model.
    """
    curve = integer("curve", curve)
    with styled():
        if axes is not None:
            _draw(fit, axes, curve)
            return axes
        size = (0.6 * WIDTH, 0.55 * WIDTH)
        figure, (upper, lower) = plt.subplots(
            2, 1, figsize=size, layout="constrained", sharex=True, height_ratios=(3, 1)
        )
        _draw(fit, upper, curve)
        upper.set_xlabel("")
        _residuals(fit, lower, curve)
        figure.align_ylabels()
    axes_of_forces: Axes = upper
    return axes_of_forces


def contacts(solution: IndentSolution, axes: Axes | None = None) -> Axes:
    """Draw the load of contacts as a function of the approach, or of one contact the pressure.

    Parameters
    ----------
    solution
        Contacts of an indentation.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.
    """
    return draw(solution._charts()[0], axes)


def residuals(fit: Fit, axes: Axes | None = None, *, curve: int = 0) -> Axes:
    """Draw the residuals of a fit over depth; the band is two standard deviations of the noise."""
    curve = integer("curve", curve)
    with styled():
        axes = axes or new_axes(0.6, 0.25)
        _residuals(fit, axes, curve)
    return axes


def fit_page(fit: Fit) -> Axes:
    """Draw a page with the data, the residuals, and the table of a fit."""
    rows = [row for line in str(fit).splitlines() for row in KEEP.wrap(line)]
    rows += ["", *_comparison(fit)]
    with styled():
        figure = plt.figure(figsize=(WIDTH, 1.3 * WIDTH), layout="constrained")
        upper: Axes
        upper, lower, below = figure.subplots(3, 1, height_ratios=(3, 1.2, 2.6))
        for number in range(len(fit.curves)):
            _draw(fit, upper, number)
            _residuals(fit, lower, number)
        upper.set_title(", ".join(c.name for c in fit.curves if c.name))
        below.axis("off")
        look = {"family": "monospace", "va": "top", "transform": below.transAxes}
        # A letter is 0.6 of its size wide; the page keeps a margin.
        size = 0.9 * 72 * WIDTH / (0.6 * LETTERS)
        page_text = below.text(0, 1, "\n".join(rows), size=size, **look)
        page_text.set_in_layout(False)
    return upper


def _comparison(fit: Fit) -> list[str]:
    rows = [["formula", "E* of the surface", "bias"]]
    try:
        classical = fit.classical()
    except ValueError as error:  # as of an unloading curve, which no elastic formula is for
        return textwrap.wrap(f"no formula: {error}", LETTERS)
    for row in classical:
        if np.isfinite(row.modulus):
            rows.append([row.method, written(row.modulus, "Pa"), f"{100 * row.bias:+.1f} %"])
        else:
            rows.append([row.method, "no solution", ""])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]


def _draw(fit: Fit, axes: Axes, number: int) -> None:
    curve = fit.curves[number]
    depth = Scale.of(float(np.abs(curve.depth).max()), "m")
    force = Scale.of(float(np.abs(curve.force).max()), "N")
    colour = COLOURS[number % len(COLOURS)]
    order = np.argsort(curve.depth, kind="stable")
    axes.plot(
        depth.factor * curve.depth,
        force.factor * curve.force,
        linestyle="none",
        marker="o",
        ms=3,
        mfc="none",
        color=colour,
        label=curve.name or "data",
    )
    axes.plot(
        depth.factor * curve.depth[order],
        force.factor * fit.loads[number][order],
        color="black" if number == 0 else colour,
        label="fit" if number == 0 else None,
    )
    axes.set_xlabel(f"depth [{depth.unit}]")
    axes.set_ylabel(f"force [{force.unit}]")
    axes.legend()


def _residuals(fit: Fit, axes: Axes, number: int) -> None:
    curve, residuals = fit.curves[number], fit.residuals[number]
    depth = Scale.of(float(np.abs(curve.depth).max()), "m")
    if fit.noise == "absolute":
        scale = Scale.of(float(np.abs(residuals).max()), "N")
        factor, label = scale.factor, f"residual [{scale.unit}]"
    else:
        factor, label = 100.0, "residual [%]"
    axes.axhspan(-2 * factor * fit.sigma, 2 * factor * fit.sigma, color="0.93", zorder=0)
    axes.axhline(0.0, color="0.6", linewidth=0.6)
    colour = COLOURS[number % len(COLOURS)]
    axes.plot(depth.factor * curve.depth, factor * residuals, "o", ms=2.5, color=colour)
    axes.set_xlabel(f"depth [{depth.unit}]")
    axes.set_ylabel(label)
