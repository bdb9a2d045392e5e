"""Units of arguments and parameters: of inputs, studies and fits."""

from __future__ import annotations

import inspect
import re
from collections.abc import Mapping

import nacre._core as core


def _units_of_shapes() -> dict[str, str]:
    """Return the SI units of the arguments of shapes, which their docstrings have in brackets."""
    texts = {
        name: str(getattr(shape, name).__doc__)
        for shape in core.Shape.__subclasses__()
        for name in inspect.signature(shape).parameters
    }
    units = {name: re.search(r"\[(?:1|(.+?))\]", text) for name, text in texts.items()}
    return {name: unit[1] or "" for name, unit in units.items() if unit}


PARAMETERS = _units_of_shapes() | {
    "load": "N",
    "approach": "m",
    "eccentricity": "m",
    "moment": "N m",
    "tilt": "rad",
    "twist": "rad",
    "torque": "N m",
    "young": "Pa",
    "thickness": "m",
    "depth": "m",
    "diameter": "m",
    "pitch_diameter": "m",
    "clearance": "m",
    "hardness": "Pa",
    "work": "N/m",
    "flat": "m",
    "strength": "Pa",
    "contact_point": "m",
    "drift": "m/s",
    "compliance": "m/N",
    "force_offset": "N",
    "force_slope": "N/m",
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
    *("amplitude", "corners", "drop", "ends", "radii", "size", "width"),
    *("groove_radius", "profile_radius", "raceway_crown", "raceway_diameters", "shoulder_height"),
    *("shift", "smoothing", "x"),
)
INPUTS = PARAMETERS | dict.fromkeys(LENGTHS, "m")
INPUTS |= {"normal": "Pa/m", "tangential": "Pa/m", "bending": "Pa", "torsion": "Pa"}
INPUTS |= {"capacity": "N", "force": "N", "rotation": "rad", "speed": "rad/s", "density": "kg/m³"}
INPUTS |= {"yield_stress": "Pa", "residual": "Pa", "poisson": "", "exponent": "", "slope": ""}
INPUTS |= {"contact_angle": "rad", "shear_yield": "Pa", "peak_pressure": "Pa"}
"""SI units of all arguments of contacts, indentations and bearings, by their names."""


def parameter_unit(path: str, units: Mapping[str, str]) -> str:
    """Return the SI unit of the number at a path: that of its name in `units` or `PARAMETERS`.

    A component is of the quantity above it, and so is the rate of a layer.

    >>> parameter_unit("body.layers[0].thickness", {}), parameter_unit("bearing.solve.tilt.y", {})
    ('m', 'rad')
    """
    *_, outer, name = ["", *path.split(".")]
    quantity = outer if name in ("x", "y", "z") or outer in BY_LAYER else name
    return units.get(quantity, PARAMETERS[quantity]) if quantity in PARAMETERS else ""
