"""Sections through one solution, or through several solutions in one picture."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre._tools.groups import names_itself
from nacre._tools.units import written
from nacre.plot.drawer import draw
from nacre.plot.style import extent
from nacre.results.charts import Axis, Chart, Curve
from nacre.results.quantities import units

with extra("plot"):
    from matplotlib.axes import Axes

if TYPE_CHECKING:
    from nacre.contact.solution import Solution

Array = npt.NDArray[np.float64]
Direction = Literal["x", "y"]
QUANTITIES = ("pressure", "gap", "displacement", "indentation", "line_load")


@names_itself
def section(
    solution: Solution,
    along: Direction = "x",
    at: float | None = None,
    quantity: str = "pressure",
    axes: Axes | None = None,
    **style: Any,
) -> Axes:
    """Draw a quantity along x or y.

    Parameters
    ----------
    solution
        Solution to draw.
    along
        Direction of the section.
    at
        Its place in the other direction [m]; the row of the largest pressure by default. Values are
        those of the nearest row of cells.
    quantity
        "pressure", "gap", "displacement", "indentation" or "line_load".
    axes
        Axes to draw into; a new figure by default.
    style
        Passed on to `matplotlib.axes.Axes.plot`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        If there is no such direction or quantity, or the place is off the grid.
    """
    position, values, place = cut(solution, along, at, quantity)
    sides, title = _sides(along, _window(solution, along, quantity), quantity), ""
    if quantity != "line_load":
        title = f"at {'y' if along == 'x' else 'x'} = {written(place, 'm', 3)}"
    chart = Chart("", [Curve(position, values)], sides, title=title)
    return draw(chart, axes, (1.0, 0.5), **style)


def compare(
    solutions: Mapping[str, Solution] | Iterable[Solution],
    along: Direction = "x",
    *,
    at: float | None = None,
    quantity: str = "pressure",
    axes: Axes | None = None,
) -> Axes:
    """Draw the same section of several solutions.

    Parameters
    ----------
    solutions
        Solutions by name; without names they are numbered.
    along, at, quantity
        As in `section`; where `at` is not given, each is cut through its own largest pressure.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        If there are no solutions, or `section` would raise.

    Examples
    --------
    >>> from nacre import plot
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> loads = {f"{load} N": nacre.solve(nacre.Sphere(5e-3), steel, load=load) for load in (5, 10)}
    >>> plot.compare(loads).get_ylabel()
    'pressure [GPa]'
    """
    if not isinstance(solutions, Mapping):
        solutions = {str(number): s for number, s in enumerate(solutions, start=1)}
    if not solutions:
        raise ValueError("solutions must hold at least one solution, got none")
    cuts = {name: cut(s, along, at, quantity) for name, s in solutions.items()}
    windows = np.array([_window(s, along, quantity) for s in solutions.values()])
    curves = [
        Curve(x, values, f"{name} (peak {written(solutions[name].peak_pressure, 'Pa', 3)})")
        for name, (x, values, _) in cuts.items()
    ]
    window = np.array([windows[:, 0].min(), windows[:, 1].max()])
    legend = {"loc": "upper left", "bbox_to_anchor": (0, -0.16), "ncols": 2}
    return draw(Chart("", curves, _sides(along, window, quantity)), axes, (1.0, 0.55), legend)


def cut(
    solution: Solution, along: str, at: float | None, quantity: str
) -> tuple[Array, Array, float]:
    """Return positions, values there, and the position of the section in the other direction."""
    if along not in ("x", "y"):
        raise ValueError(f"along must be 'x' or 'y', got {along!r}")
    if quantity not in QUANTITIES:
        raise ValueError(f"quantity must be one of {', '.join(QUANTITIES)}, got {quantity!r}")
    if quantity == "line_load":
        if along != "x":
            raise ValueError(f"along must be 'x' for the line load, got {along!r}")
        return solution.x, solution.line_load, 0.0
    axis = "xy".index(along)
    position, across = (solution.x, solution.y) if along == "x" else (solution.y, solution.x)
    place = solution.peak_position[1 - axis] if at is None else float(at)
    grid = solution.report.grid
    low, high = (grid.center[1 - axis] + sign * grid.size[1 - axis] / 2 for sign in (-1, 1))
    if not (low <= place <= high or grid.is_line):
        raise ValueError(f"at must lie on the grid, {low:g} to {high:g}, got {place:g}")
    row = int(np.argmin(np.abs(across - place)))
    field: Array = getattr(solution, quantity)
    return position, np.take(field, row, axis=1 - axis), float(across[row])


def _window(solution: Solution, along: str, quantity: str) -> Array:
    """Return the ends of the range: contact and margin, or the whole grid for other fields.

    Without a contact, and far beyond it, there is nothing to see of the pressure.
    """
    axis = "xy".index(along)
    grid = solution.report.grid
    ends = grid.center[axis] + np.array([-0.5, 0.5]) * grid.size[axis]
    if quantity not in ("pressure", "line_load") or solution.contact_area == 0:
        return ends
    contact = extent(solution)[axis]
    margin = 0.15 * (contact[1] - contact[0]) + grid.spacing[axis]
    low, high = ends
    return np.array([max(contact[0] - margin, low), min(contact[1] + margin, high)])


def _sides(along: str, window: Array, quantity: str) -> tuple[Axis, Axis]:
    """Return the axes of a section within a range."""
    low, high = window.tolist()
    has_zero, name = quantity != "displacement", quantity.replace("_", " ")
    return Axis(along, "m", (low, high)), Axis(name, units()[quantity], has_zero=has_zero)
