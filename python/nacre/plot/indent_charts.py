"""Picture of how far bulk formulae hold on coatings."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nacre._extras import extra
from nacre.plot.style import look, new_axes, styled

with extra("plot"):
    from matplotlib.axes import Axes


def bulk_limit(
    ratios: npt.ArrayLike, limits: dict[str, npt.NDArray[np.float64]], axes: Axes | None = None
) -> Axes:
    """Draw the limits of `nacre.indent.charts.bulk_limit` over the ratios of moduli."""
    with styled():
        axes = axes or new_axes(0.7, 0.5)
        for number, (name, values) in enumerate(limits.items()):
            axes.loglog(np.asarray(ratios), values, label=name.replace("_", " "), **look(number))
        axes.set(xlabel="E1/E2", ylabel="largest a/h")
        axes.legend()
    return axes
