"""Tractions at an interface, from above."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, Unpack

import numpy as np
import numpy.typing as npt

from nacre._core import integer
from nacre._tools.extras import extra
from nacre._tools.groups import names_itself
from nacre._tools.typing import Member
from nacre._tools.units import Scale, written
from nacre.plot.stress import around, body_of, colourbar
from nacre.plot.style import COLOURMAP, SIGNED, extent, lengths, new_axes, outline, styled

with extra("plot"):
    from matplotlib.axes import Axes

if TYPE_CHECKING:
    from nacre.contact.solution import Solution
    from nacre.contact.stresses import SlidingOptions, Stress

Array = npt.NDArray[np.float64]


@names_itself
def interface_map(
    solution: Solution,
    interface: int = 0,
    quantity: Literal["shear", "normal"] = "shear",
    *,
    axes: Axes | None = None,
    body: Member = "body",
    threads: int | None = None,
    **options: Unpack[SlidingOptions],
) -> Axes:
    """Draw the traction at an interface from above, with the outline of the contact.

    A map much longer than wide is drawn out of scale, and the picture says so. Beyond a free
    end of the body nothing is drawn.

    Parameters
    ----------
    solution
        Solution to draw.
    interface
        Its number, from 0 below the first layer.
    quantity
        "shear": its magnitude, and arrows along the traction that acts on the layer above;
        "normal": tension positive.
    axes
        Axes to draw into; a new figure by default.
    body, threads, options
        Passed on to `Solution.stress`: `body`, `friction`, `direction`, `threads`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        If there is no such interface or quantity, or the grid is one of strips.

    Examples
    --------
    >>> from nacre import plot
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
    >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0)
    >>> plot.interface_map(solution, friction=0.1, direction=(1, 0)).get_xlabel()
    'x [µm]'
    """
    interface = integer("interface", interface)
    grid = solution.report.grid
    if grid.is_line:
        raise ValueError("the grid of a solution must have cells along x for a map, got a line")
    if quantity not in ("shear", "normal"):
        raise ValueError(f"quantity must be 'shear' or 'normal', got {quantity!r}")
    depth = _depth(solution, body, interface)
    field = solution.stress(depth, side="above", body=body, threads=threads, **options)
    values = field.zz if quantity == "normal" else np.hypot(field.xz, field.yz)
    ends = [(c - side / 2, c + side / 2) for c, side in zip(grid.center, grid.size, strict=True)]
    window = [np.array(side) for side in ends]
    if solution.contact_area > 0:
        narrow = min(float(np.diff(contact)[0]) for contact in extent(solution))
        window = [np.clip(around(solution, axis, narrow), *ends[axis]) for axis in range(len(ends))]
    (across, up), same = lengths(window)
    highest = float(np.nanmax(np.abs(values)))
    scale = Scale.of(highest, "Pa")
    largest = scale.factor * highest or 1.0
    signed = quantity == "normal"
    with styled():
        axes = axes or new_axes(0.7, 0.5)
        corners = [
            length.factor * np.linspace(*side, cells + 1)
            for length, side, cells in zip((across, up), ends, grid.shape, strict=True)
        ]
        mesh = axes.pcolormesh(
            *corners,
            scale.factor * values.T,
            cmap=SIGNED if signed else COLOURMAP,
            vmin=-largest if signed else 0.0,
            vmax=largest,
            rasterized=True,
        )
        axes.grid(visible=False)
        colourbar(axes, mesh, f"{quantity} traction [{scale.unit}]")
        if not signed and highest > 0:
            _arrows(axes, field, (across.factor, up.factor), window)
        axes.set(
            xlabel=f"x [{across.unit}]",
            ylabel=f"y [{up.unit}]",
            xlim=across.factor * window[0],
            ylim=up.factor * window[1],
        )
        outline(axes, solution, (across.factor, up.factor))
        if same:
            axes.set_aspect("equal")
        note = "the contact outlined" if same else "x and y to different scales"
        axes.set_title(f"interfaces[{interface}] at z = {written(depth, 'm', 3)}; {note}")
    return axes


def _depth(solution: Solution, body: Member, interface: int) -> float:
    """Return the depth of an interface [m], or raise a `ValueError` if there is none."""
    depths = body_of(solution, body).interfaces
    if not depths:
        raise ValueError("a solution must have layers for a map of an interface, got a bare body")
    if not 0 <= interface < len(depths):
        raise ValueError(f"interface must be from 0 to {len(depths) - 1}, got {interface}")
    return depths[interface]


def _arrows(
    axes: Axes, field: Stress, factors: tuple[float, float], window: Sequence[Array]
) -> None:
    """Draw the shear traction that acts on the layer above, some 15 arrows along each side."""
    rows, columns = (
        _every(np.flatnonzero((centres > low) & (centres < high)))
        for centres, (low, high) in zip((field.x, field.y), window, strict=True)
    )
    pick = np.ix_(rows, columns)
    axes.quiver(
        factors[0] * field.x[rows],
        factors[1] * field.y[columns],
        field.xz[pick].T,
        field.yz[pick].T,
        color="white",
        pivot="middle",
        scale=14 * float(np.nanmax(np.hypot(field.xz, field.yz))),
        width=0.004,
    )


def _every(cells: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    step = max(1, round(cells.size / 15))
    return cells[step // 2 :: step]
