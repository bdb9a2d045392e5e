"""Shakedown and fatigue: what each depth needs, and limits over friction."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nacre._tools.extras import extra
from nacre._tools.units import Scale
from nacre.plot.stress import enlarge_depth
from nacre.plot.style import COLOURS, checked_axes, look, new_axes, styled
from nacre.results.quantities import PROFILE

with extra("plot"):
    from matplotlib.axes import Axes

if TYPE_CHECKING:
    from nacre.fatigue.map import ShakedownMap
    from nacre.fatigue.summary import FatigueSummary

BARE = 0.03
"""Part of the height that stays free above curves."""


def fatigue_depth(summary: FatigueSummary, *, axes: Axes | None = None) -> Axes:
    """Draw what a material needs at each depth, with the interfaces.

    Beside it, a new figure enlarges layers thinner than a twentieth of the depth.

    Parameters
    ----------
    summary
        Summary of `nacre.fatigue.assess`.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    TypeError
        If `axes` are no axes of Matplotlib.

    Examples
    --------
    >>> from nacre import plot
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid.line(96, 3e-4)
    >>> solution = nacre.solve(nacre.Cylinder(5e-3), steel, load=1e5, grid=grid)
    >>> plot.fatigue_depth(nacre.fatigue.assess(solution)).get_ylabel()
    'stress [MPa]'
    """
    labels = {row.name: row.label for row in PROFILE}
    deepest = float(summary.depths.max())
    highest = max(float(np.abs(values).max()) for values in summary.profiles.values())
    scale = Scale.of(highest, "Pa")
    interfaces = [face.depth for face in summary.interfaces]

    def draw(axes: Axes, bottom: float) -> None:
        length = Scale.of(bottom, "m")
        for number, (name, values) in enumerate(summary.profiles.items()):
            curve = (length.factor * summary.depths, scale.factor * values)
            axes.plot(*curve, **look(number), label=labels.get(name, name))
        for interface in interfaces:
            axes.axvline(length.factor * interface, color="0.5", linewidth=0.8)
        axes.set_xlabel(f"z [{length.unit}]")
        axes.set_xlim(0.0, length.factor * bottom or 1.0)

    with styled():
        is_new, axes = axes is None, checked_axes(axes) or new_axes(0.75, 0.45)
        draw(axes, deepest)
        if is_new:
            enlarge_depth(axes, interfaces, deepest, draw)
        axes.set_ylabel(f"stress [{scale.unit}]")
        axes.set_ylim(min(0.0, axes.get_ylim()[0]), (1.0 + BARE) * scale.factor * highest)
        axes.legend()
    return axes


def shakedown_map(limits: ShakedownMap, *, label: str = "", axes: Axes | None = None) -> Axes:
    """Draw the shakedown limits of each layer over the coefficient of friction.

    Below a solid line the layer shakes down; below the thin one of its colour nothing yields.

    Parameters
    ----------
    limits
        Map of `nacre.fatigue.shakedown_map`.
    label
        Words before the names of the layers in the legend, for several maps in one picture.
    axes
        Axes to draw into, such as those of another map; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    TypeError
        If `axes` are no axes of Matplotlib.

    Examples
    --------
    >>> from nacre import plot
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid.line(96, 3e-4)
    >>> solution = nacre.solve(nacre.Cylinder(5e-3), steel, load=1e5, grid=grid)
    >>> shakedown_map = nacre.fatigue.shakedown_map(solution, friction=[0.0, 0.2])
    >>> plot.shakedown_map(shakedown_map).get_ylabel()
    'peak pressure / shear yield stress'
    """
    order = np.argsort(limits.friction)
    friction = limits.friction[order]
    with styled():
        axes = checked_axes(axes) or new_axes(0.75, 0.5)
        drawn = sum(not str(line.get_label()).startswith("_") for line in axes.lines)
        for number, name in enumerate(limits.names):
            colour = COLOURS[(drawn + number) % len(COLOURS)]
            line_label = f"{label}, {name}" if label else name
            axes.plot(friction, limits.limits[number][order], color=colour, label=line_label)
            axes.plot(friction, limits.first_yield[number][order], color=colour, linewidth=0.6)
        axes.set(xlabel="coefficient of friction", ylabel="peak pressure / shear yield stress")
        axes.set_ylim(bottom=0.0)
        axes.set_title("shakedown limits; thin: first yield")
        axes.legend()
    return axes
