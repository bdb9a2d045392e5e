"""Pictures of coatings under indentation: limits of bulk formulae, pull-off, information."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre.plot.drawer import draw
from nacre.plot.style import look, new_axes, styled
from nacre.results.charts import Axis, Chart, Curve

with extra("plot"):
    from matplotlib.axes import Axes


LABELS = {"hertz": "Hertz", "oliver_pharr": "Oliver and Pharr", "stiffness": r"$S/2a$"}


def bulk_limit(
    ratios: npt.ArrayLike, limits: dict[str, npt.NDArray[np.float64]], axes: Axes | None = None
) -> Axes:
    """Draw the limits of `nacre.indent.charts.bulk_limit` over the ratios of moduli."""
    curves = [Curve(np.asarray(ratios), y, LABELS[name]) for name, y in limits.items()]
    sides = Axis(r"$E_1/E_2$", scale="log"), Axis("largest $a/h$", scale="log")
    return draw(Chart("", curves, sides), axes, (0.7, 0.5))


def pull_off(
    thickness: npt.ArrayLike, forces: dict[float, npt.NDArray[np.float64]], axes: Axes | None = None
) -> Axes:
    """Draw forces of `nacre.indent.charts.pull_off_over_thickness` by the ratio of moduli."""
    with styled():
        axes = axes or new_axes(0.7, 0.5)
        for number, (ratio, values) in enumerate(forces.items()):
            label = rf"$E_1/E_2 = {ratio:g}$"
            axes.semilogx(np.asarray(thickness), values, label=label, **look(number))
        axes.axhline(1.5, color="0.6", linewidth=0.6)
        axes.set(xlabel=r"thickness $h/a_0$", ylabel=r"pull-off over $\pi w R$")
        axes.legend()
    return axes


def information(
    reach: npt.ArrayLike, deviations: dict[str, npt.NDArray[np.float64]], axes: Axes | None = None
) -> Axes:
    """Draw deviations of `nacre.indent.charts.information` over the largest contact radius."""
    labels = {"young": r"$\sigma(\ln E_1)$", "thickness": r"$\sigma(\ln h)$"}
    curves = [Curve(np.asarray(reach), y, labels[name]) for name, y in deviations.items()]
    sides = Axis("largest $a/h$", scale="log"), Axis("standard deviation", scale="log")
    return draw(Chart("", curves, sides), axes, (0.7, 0.5))
