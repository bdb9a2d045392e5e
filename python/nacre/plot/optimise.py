"""Picture of an optimisation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nacre._tools.extras import extra
from nacre.plot.style import new_axes, next_look, styled

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
    table = optimum.course
    lines = {"objective": table["objective"] / table["objective"][0]}
    if np.isfinite(table["excess"]).all():
        lines["largest share of a limit"] = 1 + table["excess"]
    for name in optimum.values:
        first = table[name][0]
        lines[name] = table[name] / first if first else table[name]
    with styled():
        axes = axes or new_axes(0.6, 0.42)
        for name, values in lines.items():
            look = next_look(axes) | {"marker": "o", "ms": 3}
            axes.plot(table["solves"], values, label=name, **look)
        axes.set_xlabel("solves, of contacts and of derivatives")
        axes.set_ylabel("share of the start")
        if all((values > 0).all() for values in lines.values()):
            axes.set_yscale("log")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.legend(loc="upper left", bbox_to_anchor=(0, -0.2))
    return axes
