"""Pictures of studies: the Datasets of `nacre.design` and `nacre.sweep`."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre._tools.groups import names_itself
from nacre._tools.units import Scale
from nacre.plot.style import COLOURMAP, new_axes, next_look, styled
from nacre.results.parameters import VALUES
from nacre.results.quantities import ERROR, units

with extra("plot"):
    from matplotlib.axes import Axes
    from matplotlib.contour import ContourSet
    from matplotlib.ticker import LogLocator, NullFormatter
    from matplotlib.tri import CubicTriInterpolator, Triangulation

if TYPE_CHECKING:
    import xarray

LABEL = 18.0
"""Distance of a contour's label from the frame [points]: half of its six signs, 7 points high."""


def chart(study: xarray.Dataset, quantity: str = "peak_pressure", axes: Axes | None = None) -> Axes:
    """Draw a quantity against both parameters of a study, such as `nacre.design.coating_chart`.

    Parameters
    ----------
    study
        A Dataset of two parameters; values of either that grow by factors get a logarithmic axis.
    quantity
        What to draw. Its largest estimated error due to the size of the cells is in the label,
        where the study has it.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        If the quantity does not depend on two parameters.
    """
    field = _quantity(study, quantity, 2)
    x, y = (study[str(name)] for name in field.dims)
    scale = _scale(field, quantity)
    with styled():
        axes = axes or new_axes(0.7, 0.5)
        sides = [_side(axes, "x", x), _side(axes, "y", y)]
        values = scale.factor * field.values.T
        known = np.isfinite(values).all() and min(values.shape) > 1
        smooth = _refined(axes, sides, values) if known else [*sides, values]
        filled = axes.contourf(*smooth, levels=24, cmap=COLOURMAP)
        lines = axes.contour(*smooth, levels=8, colors="white", linewidths=0.6)
        _label(axes, lines)
        name = quantity.replace("_", " ")
        errors = _errors(study, quantity)
        label = f"{name} [{scale.unit}]"
        if errors is not None:
            share = np.nanmax(errors / np.abs(field.values))
            label += f", ± {100 * share:.2g} % at most"
        axes.figure.colorbar(filled, ax=axes, label=label)
        axes.grid(visible=False)
    return axes


@names_itself
def curve(
    study: xarray.Dataset, quantity: str = "approach", axes: Axes | None = None, **style: Any
) -> Axes:
    """Draw a quantity against a parameter of a study: `load_curve`, `tilt_curve`.

    A second parameter makes a family of curves: each value of the first one has a curve, which the
    legend names.

    Error bars show the estimated error due to the size of the cells, where the study has it.

    Parameters
    ----------
    study
        A Dataset of one parameter or two. Of a quantity along x and y, as the moment, x is drawn.
    quantity
        What to draw.
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
        If the quantity does not depend on one parameter or two.
    """
    field = _quantity(study, quantity, 1, 2)
    scale = _scale(field, quantity)
    with styled():
        axes = axes or new_axes(0.6, 0.42)
        x = _side(axes, "x", study[str(field.dims[-1])])
        errors = _errors(study, quantity)
        names = [None] if field.ndim == 1 else _labels(study[str(field.dims[0])])
        for number, name in enumerate(names):
            line = next_look(axes) | {"marker": "o", "ms": 3, "label": name} | style
            row = number if field.ndim == 2 else ...
            values = scale.factor * field.values[row]
            if errors is None:
                axes.plot(x, values, **line)
            else:
                axes.errorbar(x, values, scale.factor * errors[row], capsize=0, **line)
        if field.ndim == 2:
            axes.legend()
        axes.set_ylabel(f"{quantity.replace('_', ' ')} [{scale.unit}]")
    return axes


def _refined(
    axes: Axes, sides: Sequence[npt.NDArray[np.float64]], values: npt.NDArray[np.float64]
) -> list[npt.NDArray[np.float64]]:
    """Return sides and values of a table on a mesh eight times as fine.

    A smooth surface of cubics goes through the values, over the sides as the axes show them.
    """
    scales = [axis.get_transform() for axis in (axes.xaxis, axes.yaxis)]
    positions = [scale.transform(side) for scale, side in zip(scales, sides, strict=True)]
    spans = [np.ptp(side) for side in positions]
    fine = [
        np.interp(np.linspace(0, len(side) - 1, 8 * len(side) - 7), np.arange(len(side)), side)
        for side in positions
    ]
    coarse, dense = (
        [axis.ravel() / span for axis, span in zip(np.meshgrid(*mesh), spans, strict=True)]
        for mesh in (positions, fine)
    )
    smooth = CubicTriInterpolator(Triangulation(*coarse), np.ravel(values), kind="min_E")
    fine_values = smooth(*dense).reshape(len(fine[1]), len(fine[0]))
    ends = [scale.inverted().transform(side) for scale, side in zip(scales, fine, strict=True)]
    return [*ends, fine_values]


def _label(axes: Axes, lines: ContourSet) -> None:
    """Write the level of each contour on it, halfway through what is not close to the frame.

    Matplotlib chooses places by how straight a contour is, also where the frame cuts the label.
    """
    box = axes.get_window_extent()
    margin = LABEL * axes.figure.dpi / 72
    low, high = np.array(box.min) + margin, np.array(box.max) - margin
    places = []
    for line in filter(len, itertools.chain(*lines.allsegs)):
        marks = np.arange(len(line))
        steps = np.linspace(0, len(line) - 1, 50 * len(line))
        along = np.stack([np.interp(steps, marks, side) for side in line.T], axis=1)
        pixels = axes.transData.transform(along)
        inside = np.all((pixels > low) & (pixels < high), axis=1)
        if inside.any():
            places.append(along[inside][inside.sum() // 2])
    axes.clabel(lines, fontsize=7, fmt="%.4g", manual=places)


def _labels(values: xarray.DataArray) -> list[str]:
    """Return a parameter's values in words, with its name and unit."""
    name = str(values.name).rpartition(".")[2]
    words = values.attrs.get("long_name", name.replace("_", " "))
    if values.dtype.kind not in "if":
        return [f"{words} {value}" for value in values.values]
    scale = _scale_of(values, float(np.abs(values).max()), VALUES.get(name, ""))
    numbers = (f"{scale.factor * value:.4g} {scale.unit}".rstrip() for value in values.values)
    return [f"{words} {number}" for number in numbers]


def _quantity(study: xarray.Dataset, quantity: str, *parameters: int) -> xarray.DataArray:
    if quantity not in study:
        names = ", ".join(str(name) for name in study.data_vars)
        raise ValueError(f"quantity must be one of {names}, got {quantity!r}")
    field = study[quantity]
    if "axis" in field.dims:
        field = field.sel(axis="x")
    if field.ndim not in parameters:
        raise ValueError(
            f"quantity must depend on {' or '.join(map(str, parameters))} parameters here, "
            f"{quantity} depends on "
            f"{', '.join(map(str, field.dims))}"
        )
    return field


def _errors(study: xarray.Dataset, quantity: str) -> npt.NDArray[np.float64] | None:
    """Return the estimated errors of a quantity, or None where there is not one."""
    if quantity + ERROR not in study or study[quantity].dims != study[quantity + ERROR].dims:
        return None
    errors: npt.NDArray[np.float64] = np.abs(study[quantity + ERROR].values)
    return errors if np.isfinite(errors).any() else None


def _scale(field: xarray.DataArray, quantity: str) -> Scale:
    largest = float(np.nanmax(np.abs(field.values), initial=0.0))
    return _scale_of(field, largest, units().get(quantity, ""))


def _scale_of(array: xarray.DataArray, largest: float, unit: str) -> Scale:
    """Return the scale of an array: from its own units, or else from the SI unit that is given."""
    own = array.attrs.get("units")
    return Scale.of(largest, unit) if own is None else Scale.in_unit(largest, str(own))


def _side(axes: Axes, side: Literal["x", "y"], values: xarray.DataArray) -> npt.NDArray[np.float64]:
    """Label one side of the axes, and return its values in the unit of the label."""
    numbers = values.values.astype(float)
    steps = np.diff(numbers)
    wide = numbers.min() > 0 and numbers.max() >= 8 * numbers.min() and steps[-1] > 3 * steps[0]
    typical = np.sqrt(numbers.min() * numbers.max()) if wide else np.abs(numbers).max()
    parameter = str(values.name).rpartition(".")[2]
    scale = _scale_of(values, float(typical), VALUES.get(parameter, ""))
    name = values.attrs.get("long_name", parameter.replace("_", " "))
    label = f"{name} [{scale.unit}]" if scale.unit else name
    axes.set(**{f"{side}label": label, f"{side}scale": "log" if wide else "linear"})
    axis = getattr(axes, f"{side}axis")
    if wide:
        # Labels at 1, 2 and 5 would collide over more than two decades.
        short = numbers.max() <= 100 * numbers.min()
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if short else (1,)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    elif not scale.unit:
        axes.ticklabel_format(axis=side, scilimits=(-3, 4))
    return scale.factor * numbers
