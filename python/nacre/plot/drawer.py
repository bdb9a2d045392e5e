"""The drawer of charts: what is data in `nacre.results.charts`, with Matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre.plot.style import COLOURMAP, checked_axes, new_axes, next_look, styled
from nacre.results.charts import Axis, Chart, Curve, Ends
from nacre.results.svg import GRADED

with extra("plot"):
    import matplotlib as mpl
    from matplotlib.axes import Axes

LOOKS: dict[str, dict[str, Any]] = {
    "line": {},
    "solid": {"linestyle": "-"},
    "dashed": {"linestyle": "--"},
    "marked": {"marker": "."},
    "points": {"linestyle": "none", "marker": "o", "markersize": 3},
}
"""Properties of curves beside their colours."""


def draw(
    chart: Chart,
    axes: Axes | None = None,
    size: tuple[float, float] = (0.5, 0.4),
    legend: dict[str, Any] | None = None,
    **style: Any,
) -> Axes:
    """Draw a chart into axes, or into a new figure of that size, which has the inset beside it."""
    with styled():
        is_new, axes = axes is None, checked_axes(axes) or new_axes(*size)
        panels = [(axes, chart.axes[0])]
        if is_new and chart.inset is not None:
            grid = axes.figure.add_gridspec(1, 2, width_ratios=(3, 2))
            axes.set_subplotspec(grid[0])
            beside = axes.figure.add_subplot(grid[1], sharey=axes)
            beside.tick_params(labelleft=False)
            panels.append((beside, chart.axes[0]._replace(ends=chart.inset)))
        has_zero = chart.axes[1].has_zero and chart.axes[1].scale == "linear"
        low, high = chart.axes[0].ends or (-np.inf, np.inf)
        visible = [curve.y[(curve.x >= low) & (curve.x <= high)] for curve in chart.curves]
        y, y_label = _units(chart.axes[1], visible)
        for panel, axis in panels:
            x, x_label = _units(axis, [curve.x for curve in chart.curves])
            for curve, look in zip(chart.curves, _looks(panel, chart.curves), strict=True):
                points = x.factor * curve.x, y.factor * curve.y
                (line,) = panel.plot(*points, **look | style)
                if curve.label:
                    line.set_label(curve.label)
                if has_zero:  # it may be the edge
                    line.sticky_edges.y.append(0.0)
            for mark in chart.marks:
                panel.axvline(x.factor * mark, color="0.5", linewidth=0.8)
            panel.set_xlabel(x_label)
            if axis.ends is not None:
                panel.set_xlim(*(x.factor * end for end in axis.ends))
        axes.set(ylabel=y_label, xscale=chart.axes[0].scale, yscale=chart.axes[1].scale)
        if chart.title:
            axes.set_title(chart.title)
        if chart.axes[1].ends is not None:
            axes.set_ylim(*(y.factor * end for end in chart.axes[1].ends))
        elif has_zero:
            axes.update_datalim([(0.0, 0.0)], updatex=False)
            axes.autoscale_view()
        if any(curve.label for curve in chart.curves):
            axes.legend(**legend or {})
    return axes


def _units(axis: Axis, values: Sequence[npt.ArrayLike] | Sequence[Ends]) -> tuple[Any, str]:
    """Return the scale and the label of an axis with these numbers, or with its own ends."""
    arrays = [np.ravel(numbers) for numbers in ([axis.ends] if axis.ends else values)]
    finite = (np.abs(numbers[np.isfinite(numbers)]) for numbers in arrays)
    return axis.units(max((float(numbers.max(initial=0.0)) for numbers in finite), default=0.0))


def _looks(axes: Axes, curves: Sequence[Curve]) -> Any:
    """Yield the look of each curve after those that nacre drew before it."""
    colours = mpl.colormaps[COLOURMAP](np.linspace(0.0, GRADED, len(curves)))
    for curve, colour in zip(curves, colours, strict=True):
        if curve.look == "thin":
            yield {"color": axes.lines[-1].get_color(), "linewidth": 0.6}
        elif curve.look == "graded":
            yield {"color": colour}
        else:
            yield next_look(axes) | LOOKS[curve.look]
