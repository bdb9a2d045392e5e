"""Arguments as plain arrays: what would be read with another meaning is refused."""

from __future__ import annotations

from typing import Any

import numpy as np

AXES = ("x", "y")
PLAIN_UNITS = frozenset({"", "1", "dimensionless", "m", "N", "Pa", "s", "N/m", "m/N", "N m", "m²"})
"""Units with which the magnitude is what is meant."""


def plain(name: str, value: Any) -> Any:
    """Return an argument as it is, or as an array without labels; refuse masks and units.

    A labelled array (xarray, scipp) with the dimensions y and x becomes one of x and y.

    >>> plain("load", np.ma.masked_array([1.0, 2.0], [True, False]))
    Traceback (most recent call last):
    TypeError: load must be a real array without a mask: fill the missing values first
    """
    if type(value) in (float, int, np.ndarray):
        return value
    if type(value) in (list, tuple):
        for one in value:
            plain(name, one)
        return value
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(
            f"{name} must be a real array without a mask: fill the missing values first"
        )
    if _has_unit(value):
        raise TypeError(
            f"{name} must be a real number or array in SI units, got {str(value)[:60]!r} with a "
            f"unit: convert it, and pass its magnitude"
        )
    dims = getattr(value, "dims", None)
    if dims is None or not hasattr(value, "values"):
        return value
    names = tuple(str(one).lower() for one in dims)
    if len(names) == 2 and set(names) == set(AXES):
        return np.asarray(value.values if names == AXES else value.values.T)
    if set(names) & set(AXES) and names not in (("x",), ("y",), AXES):
        raise ValueError(f"{name} must have the dimensions x and y, got {', '.join(names)}")
    return np.asarray(value.values)


def _has_unit(value: Any) -> bool:
    """Return whether a value carries a unit: of pint, astropy, unyt, quantities or xarray."""
    if hasattr(value, "magnitude") or hasattr(value, "to_base_units"):
        return not getattr(value, "dimensionless", False)
    unit = getattr(value, "unit", None) or getattr(value, "units", None)
    if unit is None or callable(unit):
        return False
    return str(unit) not in PLAIN_UNITS
