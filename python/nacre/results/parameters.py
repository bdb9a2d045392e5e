"""Units of the arguments of values, which the docstrings of their classes declare."""

from __future__ import annotations

import re

from nacre.results.values import CALLS


def _units_of_values() -> dict[str, str]:
    """Return the SI units of the arguments of materials, bodies, grids, profiles, shapes and tips.

    Docstrings of attributes and of calls have the units in brackets after the names; an argument
    has the same unit in all of them.
    """
    units = {}
    for call, names in CALLS.values():
        for name in names:
            own = getattr(getattr(call, name, None), "__doc__", None)
            before = "" if own else rf"\b{name}`? (?:: [^\[\n]*\n +[^\[\n]*)?"
            if unit := re.search(rf"{before}\[(?:1|(.+?))\]", own or call.__doc__ or ""):
                units[name] = (unit[1] or "").replace("J/m^2", "N/m")
    return units


VALUES = _units_of_values()
"""SI units of the arguments of values, by name."""
COMPONENTS = ("x", "y", "z", "along", "across", "inner", "outer")
"""Keys of the components of a quantity."""
BY_LAYER = ("rate", "counter_rate", "residual", "conductivity", "counter_conductivity")
"""Quantities that may have a number for each layer, by its name."""


def quantity_of(path: str) -> str:
    """Return the name of the quantity at a path: a component is of the quantity above it.

    So is the number of a layer.

    >>> quantity_of("body.layers[0].thickness"), quantity_of("bearing.solve.tilt.y")
    ('thickness', 'tilt')
    """
    *_, outer, name = ["", *re.sub(r"\[\d+\]", "", path).split(".")]
    return outer if name in COMPONENTS or outer in BY_LAYER else name
