"""Shakedown and fatigue: what each depth needs, and limits over friction."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nacre._tools.extras import extra
from nacre.plot.drawer import draw

with extra("plot"):
    from matplotlib.axes import Axes

if TYPE_CHECKING:
    from nacre.fatigue.map import ShakedownMap
    from nacre.fatigue.summary import FatigueSummary


def fatigue_depth(summary: FatigueSummary, *, axes: Axes | None = None) -> Axes:
    """Draw what a material needs at each depth, with the interfaces.

    Beside it, a new figure enlarges layers thinner than a tenth of the depth.

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
    return draw(summary._charts()[0], axes, (0.75, 0.45))


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
    return draw(limits._charts(label)[0], axes, (0.75, 0.5))
