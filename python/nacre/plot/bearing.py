"""Pictures of bearings: loads around the ring, and pressure along the elements."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre._tools.units import written
from nacre.plot.drawer import draw
from nacre.plot.style import STYLE, WIDTH, look, styled
from nacre.results.charts import Axis, Chart, Curve
from nacre.results.display import in_si

with extra("plot"):
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes
    from matplotlib.ticker import MaxNLocator

if TYPE_CHECKING:
    from nacre.bearing.pair import PairSolution
    from nacre.bearing.solution import BearingSolution

Array = npt.NDArray[np.float64]
Ring = Literal["inner", "outer"]

RINGS: tuple[Ring, Ring] = ("inner", "outer")
MOST = 7
"""Largest number of curves: there are so many colours."""


@in_si
def bearing(
    solution: BearingSolution, axes: Axes | Mapping[str, Axes] | None = None
) -> dict[str, Axes]:
    """Draw the loads of all elements, and the pressure along the heaviest one.

    Parameters
    ----------
    solution
        Solved bearing.
    axes
        Axes "loads", which must be polar, and "pressure"; a new figure by default.

    Returns
    -------
    dict of matplotlib.axes.Axes
        The axes, by name.

    Raises
    ------
    ValueError
        If there is no part of that name.

    Examples
    --------
    >>> from nacre import plot
    >>> from nacre.bearing import DeepGrooveBall
    >>> ball = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    >>> drawn = plot.bearing(ball.solve(force=(1000.0, 0.0, None), model="iso16281"))
    >>> sorted(drawn)
    ['loads', 'pressure']
    """
    with styled():
        if axes is None:
            figure = plt.figure(figsize=(WIDTH, 0.42 * WIDTH), layout="constrained")
            panels = figure.subplot_mosaic(
                [["loads", "pressure"]],
                width_ratios=[1, 1.5],
                per_subplot_kw={"loads": {"projection": "polar"}},
            )
        elif isinstance(axes, Mapping):
            panels = dict(axes)
        else:
            panels = {"loads": axes}
        if unknown := [name for name in panels if name not in ("loads", "pressure")]:
            raise ValueError(f"axes must be named loads and pressure, got {unknown[0]!r}")
        if "loads" in panels:
            load_distribution(solution, axes=panels["loads"])
        if "pressure" in panels:
            element = int(solution.loads[:, 0].argmax())
            elements_pressure(solution, [element], axes=panels["pressure"])
        return panels


@in_si
def bearing_pair(solution: PairSolution) -> dict[str, Axes]:
    """Draw the loads of both bearings of a pair, and the pressure along the heaviest elements.

    Parameters
    ----------
    solution
        Solved pair.

    Returns
    -------
    dict of matplotlib.axes.Axes
        The axes, by name: those of `bearing` after "first" and "second".

    Examples
    --------
    >>> from nacre import plot
    >>> from nacre.bearing import AngularContactBall, Pair
    >>> ball = AngularContactBall(
    ...     count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
    ... )
    >>> pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
    >>> sorted(plot.bearing_pair(pair.solve(model="iso16281")))
    ['first loads', 'first pressure', 'second loads', 'second pressure']
    """
    charts = ("loads", "pressure")
    names = [[f"{which} {chart}" for chart in charts] for which in ("first", "second")]
    with styled():
        figure = plt.figure(figsize=(WIDTH, 0.8 * WIDTH), layout="constrained")
        polar: dict[str | tuple[str, ...], dict[str, object]] = {
            row[0]: {"projection": "polar"} for row in names
        }
        panels: dict[str, Axes] = figure.subplot_mosaic(
            names,  # type: ignore[arg-type]  # Matplotlib's types know no lists of lists
            width_ratios=[1, 1.5],
            per_subplot_kw=polar,
        )
        for row, solved in zip(names, solution.bearings, strict=True):
            bearing(solved, {chart: panels[name] for chart, name in zip(charts, row, strict=True)})
            pressure = panels[row[1]]
            title = f"{row[1].partition(' ')[0]} bearing, {pressure.get_title(loc='left')}"
            pressure.set_title(title, loc="left")
    return dict(panels)


@in_si
def load_distribution(solution: BearingSolution, *, axes: Axes | None = None) -> Axes:
    """Draw the loads of the elements around the bearing, x to the right.

    Parameters
    ----------
    solution
        Solved bearing.
    axes
        Polar axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Examples
    --------
    >>> from nacre import plot
    >>> from nacre.bearing import DeepGrooveBall
    >>> ball = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    >>> solution = ball.solve(force=(1000.0, 0.0, None), model="iso16281")
    >>> plot.load_distribution(solution).name
    'polar'
    """
    loads, highest = solution.loads, float(solution.loads.max(initial=0.0))
    same = np.allclose(loads[:, 0], loads[:, 1], rtol=1e-3, atol=1e-6 * highest)
    ring = solution._ring_chart(1 if same else len(RINGS))
    scale, _ = ring.axis.units(highest)
    with styled():
        if axes is None:
            figure = plt.figure(figsize=(0.5 * WIDTH, 0.5 * WIDTH), layout="constrained")
            axes = figure.add_subplot(projection="polar")
        count, series = ring.loads.shape
        width = 2 * np.pi / count
        share = 0.5 / series
        for number, label in enumerate(ring.labels):
            places = ring.angles[:, number] + (number - (series - 1) / 2) * share * width
            heights = scale.factor * ring.loads[:, number]
            words = label.removesuffix(" ring") if solution.bearing.rows > 1 else label
            axes.bar(places, heights, share * width, color=look(number)["color"], label=words)
        axes.set_axisbelow(True)
        highest *= scale.factor
        ticks = [tick for tick in MaxNLocator(3).tick_values(0.0, highest) if 0 < tick <= highest]
        axes.set_yticks(ticks, [])
        axes.set_xticks(solution.angles[:count], [f"{j}" for j in range(count)])
        axes.set_title(f"load of each element [{scale.unit}]", loc="center")
        # Between two elements, on the left.
        beside = solution.rotation + (math.floor(count / 2) + 0.5) * width
        paper = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
        for tick in ticks:  # those of Matplotlib lie below the bars
            style = {"size": STYLE["ytick.labelsize"], "ha": "center", "va": "center"}
            axes.text(beside, tick, f"{tick:g}", bbox=paper, **style)
        if any(ring.labels):
            axes.legend(loc="upper left", bbox_to_anchor=(-0.1, -0.08), ncols=2)
    return axes


@in_si
def elements_pressure(
    solution: BearingSolution,
    elements: list[int] | None = None,
    *,
    ring: Ring | None = None,
    axes: Axes | None = None,
) -> Axes:
    """Draw the largest pressure across the contact along the axis of elements.

    Of balls whose contacts are those of the standard, the peaks over the angle are drawn.

    Parameters
    ----------
    solution
        Solved bearing.
    elements
        Numbers of the elements; by default those that carry most, seven at most.
    ring
        Ring, "inner" or "outer"; by default both of one element, and the inner one of several.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        If there is no such ring.

    Examples
    --------
    >>> from nacre import plot
    >>> from nacre.bearing import CylindricalRoller
    >>> bearing = CylindricalRoller(
    ...     count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3, clearance=41e-6
    ... )
    >>> solution = bearing.solve(force=(4450.0, 0.0, None), model="iso16281")
    >>> plot.elements_pressure(solution).get_ylabel()
    'pressure [GPa]'
    """
    if ring not in (*RINGS, None):
        raise ValueError(f'ring must be "inner" or "outer", got {ring!r}')
    if elements is None:
        order = np.argsort(-solution.loads[:, 0], kind="stable")[:MOST]
        elements = [int(j) for j in order if solution.loads[j, 0] > 0]
    rings: list[Ring] = (
        [ring] if ring is not None else [*RINGS] if len(elements) == 1 else ["inner"]
    )
    pressure = Axis("pressure", "Pa")
    if solution.model != "solved" and solution.lamina_pressures is None:
        peaks = [
            Curve(solution.angles, solution.peak_pressures[:, k], f"{name} ring", "points")
            for k, name in enumerate(RINGS)
        ]
        places = Axis("angle", "rad"), pressure._replace(ends=(0.0, 1.08 * solution.peak_pressure))
        chart = Chart("", peaks, places, title="peak pressures, Hertz")
        return draw(chart, axes, (0.8, 0.45), markersize=6)
    curves = [(j, r, *solution._profile(j, RINGS.index(r))) for j in elements for r in rings]
    curves = [curve for curve in curves if curve[2].size]
    drawn: list[tuple[list[int], Ring, Array, Array]] = []
    for element, name, x, values in curves:  # elements on both sides of the load are alike
        for alike, which, _, known in drawn:
            if which == name and np.allclose(known, values, rtol=1e-6, atol=1.0):
                alike.append(element)
                break
        else:
            drawn.append(([element], name, x, values))
    chart_curves = []
    for alike, which, x, values in drawn:
        element_label = f"element{'s' * (len(alike) > 1)} {', '.join(map(str, sorted(alike)))}"
        label = f"{which} ring" if len(elements) == 1 else element_label
        peak = written(float(values.max()), "Pa", 3)
        chart_curves.append(Curve(x, values, f"{label} (peak {peak})"))
    title = f"element {elements[0]}" if len(elements) == 1 else f"{rings[0]} ring"
    if solution.model == "iso16281":
        title += ", Hertz's pressure of laminae"
    chart = Chart("", chart_curves, (Axis("x along the element", "m"), pressure), title=title)
    legend = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.2), "ncols": 2}
    return draw(chart, axes, (0.8, 0.45), legend)
