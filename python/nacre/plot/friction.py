"""Pictures of friction: stick and slip, loops of force and shift, creep curves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre._tools.groups import names_itself
from nacre._tools.units import Scale, written
from nacre.plot.drawer import draw
from nacre.plot.style import WIDTH, checked_axes, extent, lengths, new_axes, next_look, styled
from nacre.results.base import checked, has_friction
from nacre.results.charts import Axis, Chart, Curve, loop_chart

with extra("plot"):
    from matplotlib.axes import Axes
    from matplotlib.colors import ListedColormap
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

if TYPE_CHECKING:
    import xarray

    from nacre.contact.friction import FrictionSolution

STICK, SLIP = "#CCE6F6", "#E69F00"
"""Colours of cells that stick and slip: orange of the palette of Okabe and Ito, and its blue, so
light that the two differ in print without colours."""
ARROWS = 17
"""Arrows along the longer side of the contact."""


def friction(solution: FrictionSolution, axes: Axes | None = None) -> Axes:
    """Draw where the contact sticks and slips, with arrows of the traction on the body.

    In line contact the tractions are drawn along y, within their bounds.

    Parameters
    ----------
    solution
        Solution of `nacre.slide` or `nacre.roll`.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    TypeError
        If `solution` is not one, or `axes` are not axes.
    """
    if not has_friction(solution):
        raise TypeError(f"solution must be a FrictionSolution, got {solution!r}")
    checked_axes(axes)
    with styled():
        if solution.grid.is_line:
            return _line(solution, axes or new_axes(0.6, 0.4))
        drawn = _map(solution, axes or new_axes(0.9, 0.66))
        if axes is None and drawn.get_aspect() == 1.0:
            # A contact that is wider than high leaves no room empty; the legend needs a third.
            sides = [np.ptp(limits) for limits in (drawn.get_xlim(), drawn.get_ylim())]
            height = np.clip(0.1 + 0.6 * sides[1] / sides[0], 0.33, 0.66)
            if isinstance(drawn.figure, Figure):
                drawn.figure.set_size_inches(0.9 * WIDTH, height * WIDTH)
        return drawn


def _map(solution: FrictionSolution, axes: Axes) -> Axes:
    grid, touching = solution.grid, solution.pressure > 0
    ends = np.array(
        [(c - side / 2, c + side / 2) for c, side in zip(grid.center, grid.size, strict=True)]
    )
    window = ends
    if touching.any():
        contact = extent(solution.normal)
        margin = 0.15 * np.diff(contact) + np.array(grid.spacing)[:, np.newaxis]
        window = np.clip(contact + margin * [-1, 1], ends[:, :1], ends[:, 1:])
    scales, same = lengths(window)
    corners = [
        scale.factor * np.linspace(low, high, cells + 1)
        for scale, (low, high), cells in zip(scales, ends, grid.shape, strict=True)
    ]
    kinds = np.where(touching, np.where(solution.stick, 0.0, 1.0), np.nan)
    colours = ListedColormap([STICK, SLIP])
    axes.pcolormesh(*corners, kinds.T, cmap=colours, vmin=0, vmax=1, rasterized=True)
    axes.grid(visible=False)
    _arrows(solution, axes, [scale.factor for scale in scales], touching)
    axes.set(
        xlabel=f"x [{scales[0].unit}]",
        ylabel=f"y [{scales[1].unit}]",
        xlim=scales[0].factor * window[0],
        ylim=scales[1].factor * window[1],
    )
    _legend(axes)
    if solution.direction is not None:
        _rolling(axes, solution.direction)
    axes.set_title(
        "arrows: traction on the body" + ("" if same else "; x and y to different scales")
    )
    if same:
        axes.set_aspect("equal")
    return axes


def _arrows(
    solution: FrictionSolution,
    axes: Axes,
    factors: Sequence[float],
    touching: npt.NDArray[np.bool_],
) -> None:
    """Draw arrows in some cells; the largest is as long as their distance."""
    if not touching.any():
        return
    rows, columns = (np.flatnonzero(touching.any(axis=1 - axis)) for axis in (0, 1))
    step = max(1, round(max(np.ptp(rows), np.ptp(columns)) / ARROWS))
    # Symmetrical about the middle of the contact.
    picked = [side[(side - (side[0] + side[-1]) // 2) % step == 0] for side in (rows, columns)]
    some = np.ix_(*picked)
    qx, qy = (np.where(touching, traction, np.nan)[some] for traction in solution.traction)
    largest = np.nanmax(np.hypot(qx, qy), initial=0.0)
    if largest <= 0:
        return
    x, y = factors[0] * solution.x[picked[0]], factors[1] * solution.y[picked[1]]
    length = step * max(f * d for f, d in zip(factors, solution.grid.spacing, strict=True))
    arrows = axes.quiver(
        *(x, y, qx.T, qy.T),
        angles="xy",
        scale_units="xy",
        scale=largest / length,
        pivot="mid",
        width=0.004,
        color="black",
    )
    label = written(largest, "Pa", 3)
    axes.quiverkey(arrows, 1.03, 0.74, largest, label, labelpos="E", labelsep=0.1)


def _rolling(axes: Axes, direction: str) -> None:
    """Draw an arrow in the direction of rolling beside the picture."""
    sign, axis = (-1 if direction[0] == "-" else 1), "xy".index(direction[1])
    ends = np.full((2, 2), 0.0)
    ends[:, axis] = 0.05 * sign * np.array([-1, 1])
    start, end = ends + np.array([1.08, 0.58])
    style = {"arrowstyle": "-|>", "color": "0.25", "linewidth": 1.8, "mutation_scale": 14}
    share = "axes fraction"
    axes.annotate("", end, start, share, share, arrowprops=style, annotation_clip=False)
    axes.annotate("rolls", (1.16, 0.58), xycoords=share, va="center", annotation_clip=False)


def _line(solution: FrictionSolution, axes: Axes) -> Axes:
    touching = solution.pressure[0] > 0
    length = Scale.of(float(np.abs(solution.y).max()), "m")
    bound = solution.bound[0]
    scale = Scale.of(float(bound.max()) or 1.0, "Pa")
    y = length.factor * solution.y
    for sign in (-1, 1):
        axes.plot(y, sign * scale.factor * bound, color="0.6", linewidth=0.8)
    for name, traction in zip("xy", solution.traction, strict=True):
        if np.abs(traction).max() > 1e-12 * (bound.max() or 1.0):
            axes.plot(
                y, scale.factor * traction[0], **next_look(axes), label=f"traction along {name}"
            )
    for state, colour in ((solution.stick[0], STICK), (touching & ~solution.stick[0], SLIP)):
        axes.fill_between(
            y,
            0,
            1,
            where=state,
            color=colour,
            alpha=0.35,
            linewidth=0,
            step="mid",
            transform=axes.get_xaxis_transform(),
        )
    inside = y[touching] if touching.any() else y
    margin = 0.1 * np.ptp(inside) + 1e-12
    axes.set(
        xlabel=f"y [{length.unit}]",
        ylabel=f"traction [{scale.unit}]",
        xlim=(inside.min() - margin, inside.max() + margin),
    )
    axes.set_title("grey: bounds")
    _legend(axes)
    return axes


def _legend(axes: Axes) -> None:
    """Explain the colours above the picture, on the right."""
    patches = [Patch(color=STICK, label="sticks"), Patch(color=SLIP, label="slips")]
    handles, _ = axes.get_legend_handles_labels()
    axes.legend(
        handles=[*handles, *patches],
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        borderaxespad=0.0,
    )


@names_itself
def loop(
    solutions: Sequence[FrictionSolution], along: str = "x", axes: Axes | None = None, **style: Any
) -> Axes:
    """Draw the force of a history as a function of the shift.

    Parameters
    ----------
    solutions
        Steps that `nacre.slide` returned.
    along
        Axis of force and shift, "x" or "y".
    axes
        Axes to draw into; a new figure by default.
    **style
        Look of the curve, as for ``Axes.plot``.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    TypeError
        If they are no sequence of FrictionSolution, or `axes` are not axes.
    ValueError
        If there is no solution, one is of rolling, or the axis is another.
    """
    checked_axes(axes)
    solutions = checked(solutions)
    if along not in ("x", "y"):
        raise ValueError(f"along must be 'x' or 'y', got {along!r}")
    if any(solution.shift is None for solution in solutions):
        raise ValueError("solutions must be steps of sliding, got one of rolling")
    return draw(loop_chart(solutions, "xy".index(along)), axes, **style)


@names_itself
def creep_curve(
    dataset: xarray.Dataset,
    axes: Axes | None = None,
    *,
    quantity: str = "traction_ratio",
    **style: Any,
) -> Axes:
    """Draw the traction ratio, a force or the torque as a function of the creepage.

    Parameters
    ----------
    dataset
        Dataset of `nacre.friction.creep_curve`.
    axes
        Axes to draw into; a new figure by default.
    quantity
        Name of the column, such as "lateral_force" or "torque".
    **style
        Look of the curve, as for ``Axes.plot``.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    TypeError
        If `axes` are not axes.
    ValueError
        If there is no such column.
    """
    checked_axes(axes)
    if quantity not in dataset:
        names = ", ".join(map(str, dataset.data_vars))
        raise ValueError(f"quantity must be one of {names}, got {quantity!r}")
    column, creepage = dataset[quantity], dataset.creepage
    label, unit = quantity.replace("_", " "), column.attrs["units"]
    if quantity == "traction_ratio":
        label, unit = "force over friction times load", ""
    x = Axis(f"{creepage.attrs.get('long_name', 'creepage')} [10⁻³]")
    curve = Curve(1e3 * creepage.values, column.values, look="marked")
    return draw(Chart("", [curve], (x, Axis(label, unit, is_exact=True))), axes, **style)
