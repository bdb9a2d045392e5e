"""Picture of an optimisation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nacre._tools.extras import extra
from nacre.plot.drawer import draw
from nacre.plot.style import styled

with extra("plot"):
    from matplotlib.axes import Axes
    from matplotlib.ticker import MaxNLocator

if TYPE_CHECKING:
    from nacre.design.optimise import Optimum


def course(optimum: Optimum, axes: Axes | None = None) -> Axes:
    """Draw the objective and the parameters of an optimisation against the solves.

    All are shares of their values at the start. With limits, the largest share of a limit that is
    used is drawn, too.

    Parameters
    ----------
    optimum
        Result of `nacre.design.optimise`.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.
    """
    with styled():
        legend = {"loc": "upper left", "bbox_to_anchor": (0, -0.2)}
        axes = draw(optimum._course_chart(), axes, (0.6, 0.42), legend)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    return axes
