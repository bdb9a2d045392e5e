"""The pressure as a relief: a picture with Matplotlib, or an interactive view with PyVista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre._tools.units import Scale
from nacre.plot.style import COLOURMAP, WIDTH, styled

with extra("plot"):
    import matplotlib.pyplot as plt

if TYPE_CHECKING:
    from nacre.contact.solution import Solution

MOST = 120
"""Largest number of facets along one side of a relief; chosen by trial for a quick drawing."""


def relief(solution: Solution, axes: Any = None) -> Any:
    """Draw the pressure as a relief.

    Parameters
    ----------
    solution
        Solution to draw.
    axes
        Three-dimensional axes to draw into; a new figure by default.

    Returns
    -------
    mpl_toolkits.mplot3d.axes3d.Axes3D
        The axes.

    Raises
    ------
    ValueError
        If the grid is one of strips, `Grid.line`, which has no relief.
    """
    x, y, pressure = _contact(solution)
    lengths = [Scale.of(np.abs(side).max(), "m") for side in (x, y)]
    scale = Scale.of(solution.peak_pressure, "Pa")
    with styled():
        if axes is None:
            figure = plt.figure(figsize=(WIDTH, 0.6 * WIDTH))
            axes = figure.add_axes((0.0, 0.0, 0.94, 1.05), projection="3d")
        axes.plot_surface(
            *np.meshgrid(lengths[0].factor * x, lengths[1].factor * y, indexing="ij"),
            scale.factor * pressure,
            cmap=COLOURMAP,
            rstride=1,
            cstride=1,
            linewidth=0,
            antialiased=False,
        )
        axes.set(
            xlabel=f"x [{lengths[0].unit}]",
            ylabel=f"y [{lengths[1].unit}]",
            zlabel=f"pressure [{scale.unit}]",
        )
        axes.set_zlim(bottom=0)
        ratio = float(np.clip(np.ptp(x) / np.ptp(y), 0.4, 2.5))
        axes.set_box_aspect((ratio, 1, 0.7 * max(1, ratio) ** 0.5), zoom=0.95)
        axes.locator_params(axis="y", nbins=5)
        axes.locator_params(axis="x", nbins=7)
        axes.view_init(elev=28, azim=-60)
    return axes


def view(solution: Solution, *, show: bool = True) -> Any:
    """Open an interactive view of the pressure, with PyVista.

    Parameters
    ----------
    solution
        Solution to draw.
    show
        Whether to open the window; without, the plotter is returned to be added to.

    Returns
    -------
    pyvista.Plotter
        The plotter.

    Raises
    ------
    ModuleNotFoundError
        If PyVista is missing.
    ValueError
        If the grid is one of strips, `Grid.line`, which has no relief.
    """
    with extra("view"):
        import pyvista
    x, y, pressure = _contact(solution)
    scale = Scale.of(solution.peak_pressure, "Pa")
    # All three directions fill the same cube: a contact is flat, and may be long.
    cube = np.meshgrid(_unit(x), _unit(y), indexing="ij")
    height = pressure / max(solution.peak_pressure, np.finfo(float).tiny)
    surface = pyvista.StructuredGrid(*(side[..., np.newaxis] for side in (*cube, 0.6 * height)))
    name = f"pressure [{scale.unit}]"
    surface.point_data[name] = (scale.factor * pressure).ravel(order="F")
    plotter: Any = pyvista.Plotter(off_screen=None if show else True)
    look = {"cmap": COLOURMAP, "smooth_shading": True, "show_scalar_bar": False}
    plotter.add_mesh(surface, scalars=name, **look)
    lengths = [Scale.of(np.abs(side).max(), "m") for side in (x, y)]
    ends = [
        s.factor * end for s, side in zip(lengths, (x, y), strict=True) for end in side[[0, -1]]
    ]
    plotter.show_bounds(
        axes_ranges=[*ends, 0, scale.factor * solution.peak_pressure],
        xtitle=f"x [{lengths[0].unit}]".replace("µ", "u"),  # VTK's letters are Latin
        ytitle=f"y [{lengths[1].unit}]".replace("µ", "u"),
        ztitle=name,
        location="outer",
        grid="back",
        ticks="outside",
        font_size=11,
        n_xlabels=4,
        n_ylabels=4,
        n_zlabels=4,
        bold=False,
    )
    plotter.camera_position = [(-1.6, -2.4, 1.7), (0.0, 0.0, 0.2), (0.0, 0.0, 1.0)]
    if show:
        plotter.show()
    return plotter


def _unit(side: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    middle: npt.NDArray[np.float64] = (side - side.mean()) / np.ptp(side)
    return middle


def _contact(solution: Solution) -> tuple[npt.NDArray[np.float64], ...]:
    """Return x, y and pressure of the contact and two cells around it; thinned out if many."""
    if solution.report.grid.is_line:
        raise ValueError("the grid of a solution must have cells along x for a relief, got a line")
    pressure, cells_along = solution.pressure, []
    for axis, cells in enumerate(pressure.shape):
        loaded = np.flatnonzero(pressure.any(axis=1 - axis))
        low, high = (loaded[0] - 2, loaded[-1] + 2) if loaded.size else (0, cells - 1)
        low, high = max(low, 0), min(high, cells - 1)
        count = min(MOST, high - low + 1)
        cells_along.append(np.unique(np.linspace(low, high, count).round().astype(int)))
    return solution.x[cells_along[0]], solution.y[cells_along[1]], pressure[np.ix_(*cells_along)]
