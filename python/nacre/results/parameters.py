"""Units of arguments: as the classes of values and the groups of keywords declare them."""

from __future__ import annotations

import inspect
import re
from collections.abc import Mapping

import nacre._core as core
from nacre.results.values import FIELDS


def _units_of_values() -> dict[str, str]:
    """Return the SI units of the arguments of materials, bodies, grids, profiles and shapes.

    Their docstrings have the units in brackets; an argument has the same unit in all of them.
    """
    texts = {
        name: str(getattr(kind, name).__doc__)
        for kind in (*FIELDS, core.Grid)
        for name in inspect.signature(kind).parameters
    }
    units = {name: re.search(r"\[(?:1|(.+?))\]", text) for name, text in texts.items()}
    return {name: unit[1] or "" for name, unit in units.items() if unit}


VALUES = _units_of_values()
"""SI units of the arguments of values, by name."""
PARAMETERS = VALUES | {
    "load": "N",
    "approach": "m",
    "eccentricity": "m",
    "moment": "N m",
    "tilt": "rad",
    "twist": "rad",
    "torque": "N m",
    "depth": "m",
    "diameter": "m",
    "pitch_diameter": "m",
    "clearance": "m",
    "hardness": "Pa",
    "work": "N/m",
    "flat": "m",
    "strength": "Pa",
    "compliance": "m/Pa",
    "force": "N",
    "displacement": "m",
    "yield_stress": "Pa",
    "shear_yield": "Pa",
    "rate": "m²/N",
    "counter_rate": "m²/N",
    "sliding": "m",
}
"""SI units of parameters of studies and fits, by the last part of their names."""
BY_LAYER = ("rate", "counter_rate")
"""Parameters that may have a number for each layer, by its name."""
LENGTHS = (
    *("radii", "groove_radius", "profile_radius", "raceway_crown", "raceway_diameters"),
    *("shoulder_height", "shift", "width"),
)
INPUTS = PARAMETERS | dict.fromkeys(LENGTHS, "m")
INPUTS |= {"bending": "Pa", "torsion": "Pa", "residual": "Pa", "peak_pressure": "Pa"}
INPUTS |= {"capacity": "N", "rotation": "rad", "speed": "rad/s", "density": "kg/m³"}
INPUTS |= {"poisson": "", "exponent": "", "slope": "", "contact_angle": "rad"}
"""SI units of all arguments of contacts, indentations and bearings, by their names."""


def quantity_of(path: str) -> str:
    """Return the name of the quantity at a path: a component is of the quantity above it.

    So is the rate of a layer.

    >>> quantity_of("body.layers[0].thickness"), quantity_of("bearing.solve.tilt.y")
    ('thickness', 'tilt')
    """
    *_, outer, name = ["", *path.split(".")]
    return outer if name in ("x", "y", "z") or outer in BY_LAYER else name


def parameter_unit(path: str, units: Mapping[str, str]) -> str:
    """Return the SI unit of the number at a path: that of its name in `units` or `PARAMETERS`.

    >>> parameter_unit("body.layers[0].thickness", {}), parameter_unit("solve.tilt.y", {})
    ('m', 'rad')
    """
    quantity = quantity_of(path)
    return units.get(quantity, PARAMETERS[quantity]) if quantity in PARAMETERS else ""
