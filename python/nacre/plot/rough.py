"""Statistics of rough contacts: load curves, distributions, patches, open gaps, spectra."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from nacre._tools.extras import extra
from nacre._tools.groups import names_itself
from nacre._tools.units import Scale, symbol
from nacre.plot.drawer import draw
from nacre.plot.style import COLOURMAP, COLOURS, lengths, new_axes, next_look, styled
from nacre.results.charts import Axis, Chart, Curve
from nacre.results.patches import CURVE, crosses, patch_labels

with extra("plot"):
    from matplotlib.axes import Axes
    from matplotlib.colors import ListedColormap

if TYPE_CHECKING:
    import xarray

    from nacre._core import HeightMap
    from nacre.contact.solution import Solution


def heights(surface: HeightMap, axes: Axes | None = None) -> Axes:
    """Draw the heights of a map from above, about their mean.

    Parameters
    ----------
    surface
        A height map.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Examples
    --------
    >>> from nacre import plot
    >>> wave = 1e-6 * np.sin(2 * np.pi * np.arange(64) / 64)[:, None] * np.ones(64)
    >>> plot.heights(nacre.HeightMap(wave, 1e-6)).get_xlabel()
    'x [µm]'
    """
    values = surface.heights - surface.heights.mean()
    sides = [
        centre + step * count * np.array([-0.5, 0.5])
        for centre, step, count in zip(surface.center, surface.spacing, values.shape, strict=True)
    ]
    (first, second), same = lengths(np.array(sides))
    scale = Scale.of(float(np.abs(values).max()), "m")
    with styled():
        axes = axes or new_axes(0.6, 0.5)
        extent = (*(first.factor * sides[0]), *(second.factor * sides[1]))
        picture = axes.imshow(
            scale.factor * values.T, origin="lower", extent=extent, cmap=COLOURMAP, aspect="auto"
        )
        axes.figure.colorbar(picture, ax=axes, label=f"height [{scale.unit}]")
        axes.set(xlabel=f"x [{first.unit}]", ylabel=f"y [{second.unit}]")
        axes.grid(visible=False)
        if same:
            axes.set_aspect("equal")
    return axes


@names_itself
def load_curve(
    curve: xarray.Dataset, quantity: str = "corrected_share", axes: Axes | None = None, **style: Any
) -> Axes:
    """Draw a column of `rough.load_curve` over the mean pressure, both logarithmic.

    Parameters
    ----------
    curve
        Table of `nacre.rough.load_curve`.
    quantity
        Name of the column, such as "corrected_share" or "mean_gap".
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
        If there is no such column.
    """
    if quantity not in CURVE:
        raise ValueError(f"quantity must be one of {', '.join(CURVE)}, got {quantity!r}")
    words, unit = CURVE[quantity]
    pressure = Scale.of(float(curve["pressure"].max()), "Pa")
    values = curve[quantity].values
    scale = None if unit in ("1", "Pa/m") else Scale.of(float(np.abs(values).max()), unit)
    unit_symbol = symbol(unit) if scale is None else scale.unit
    with styled():
        axes = axes or new_axes(0.7, 0.5)
        look: dict[str, object] = {"marker": "o", "markersize": 3, **next_look(axes), **style}
        x, y = pressure.factor * curve["pressure"].values, (scale.factor if scale else 1) * values
        axes.loglog(x, y, **look)
        label = words if unit == "1" else f"{words} [{unit_symbol}]"
        axes.set(xlabel=f"mean pressure [{pressure.unit}]", ylabel=label)
    return axes


@names_itself
def distribution(density: xarray.DataArray, axes: Axes | None = None, **style: Any) -> Axes:
    """Draw a distribution of `rough.pressure_distribution` or `rough.gap_distribution`.

    Parameters
    ----------
    density
        Density over pressure or gap.
    axes
        Axes to draw into; a new figure by default.
    style
        Passed on to `matplotlib.axes.Axes.plot`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; the title states the share at zero.
    """
    name = str(density.dims[0])
    unit = "Pa" if name == "pressure" else "m"
    places = density[name].values
    scale = Scale.of(float(places.max()), unit)
    curve = Curve(scale.factor * places, density.values / scale.factor)
    title = f"share at 0: {100 * density.attrs['share_at_zero']:.1f} %"
    names = Axis(f"{name} [{scale.unit}]"), Axis(f"density [1/{scale.unit}]")
    return draw(Chart("", [curve], names, title=title), axes, (0.7, 0.5), **style)


def patches(solution: Solution, axes: Axes | None = None) -> Axes:
    """Draw the contact from above, the largest patch apart, and the gap that leaks.

    Parameters
    ----------
    solution
        Solution to draw.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; the title counts the patches, and says along which sides the gap is open.

    Raises
    ------
    ValueError
        If the grid is one of strips.
    """
    grid = solution.report.grid
    if grid.is_line:
        raise ValueError("the grid of a solution must have cells along x for a map, got a line")
    labels = patch_labels(solution.in_contact, grid)
    sizes = np.bincount(labels.ravel(), minlength=2)[1:]
    kinds = np.where(labels == 0, 0, np.where(labels == 1 + np.argmax(sizes), 2, 1))
    ends = [(c - side / 2, c + side / 2) for c, side in zip(grid.center, grid.size, strict=True)]
    scales, same = lengths(ends)
    corners = [
        scale.factor * np.linspace(low, high, cells + 1)
        for scale, (low, high), cells in zip(scales, ends, grid.shape, strict=True)
    ]
    gap = ~solution.in_contact
    along = [name for axis, name in enumerate("xy") if crosses(gap, grid, axis)]
    count = int((sizes > 0).sum())
    words = f"{count} {'patch' if count == 1 else 'patches'}"
    with styled():
        axes = axes or new_axes(0.6, 0.55)
        colours = ListedColormap(["white", COLOURS[3], COLOURS[0]])
        axes.pcolormesh(*corners, kinds.T, cmap=colours, vmin=0, vmax=2, rasterized=True)
        axes.grid(visible=False)
        axes.set(xlabel=f"x [{scales[0].unit}]", ylabel=f"y [{scales[1].unit}]")
        axes.set_title(f"{words}; the gap is open along {' and '.join(along) or 'no side'}")
        if same:
            axes.set_aspect("equal")
    return axes


def spectrum(spectra: xarray.Dataset, axes: Axes | None = None) -> Axes:
    """Draw the spectra of `rough.spectrum`, both logarithmic.

    Parameters
    ----------
    spectra
        Spectra of the undeformed and of the deformed surface.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.
    """
    largest = max(float(spectra[name].max()) for name in ("undeformed", "deformed"))
    wavenumbers, curves = spectra["wavenumber"], []
    for name in ("undeformed", "deformed"):
        density = spectra[name].values
        # What is rounding beside the largest is not drawn.
        visible = density > 1e-20 * largest
        curves.append(Curve(wavenumbers.values[visible], density[visible], name))
    wavenumber, density_axis = (
        Axis(f"{name} [{values.attrs['units']}]", scale="log")
        for name, values in (("wavenumber", wavenumbers), ("spectral density", spectra["deformed"]))
    )
    return draw(Chart("", curves, (wavenumber, density_axis)), axes, (0.7, 0.5))
