"""SI prefixes: numbers between 1 and 1000 on every axis."""

from __future__ import annotations

import math
from dataclasses import dataclass

PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n", -12: "p"}
UNITS = {
    "pressure": "Pa",
    "gap": "m",
    "displacement": "m",
    "line_load": "N/m",
    "load": "N",
    "approach": "m",
    "moment": "N m",
    "peak_pressure": "Pa",
    "central_pressure": "Pa",
    "contact_area": "m²",
    "eccentricity": "m",
    "von_mises": "Pa",
    "tension": "Pa",
    "max_shear": "Pa",
    "coating_tension": "Pa",
    "interface_shear": "Pa",
    "interface_tension": "Pa",
}
"""Units of a solution's quantities, and of the stresses that studies keep."""
PARAMETERS = {
    "load": "N",
    "approach": "m",
    "eccentricity": "m",
    "moment": "N m",
    "tilt": "rad",
    "young": "Pa",
    "thickness": "m",
    "radius": "m",
    "crown_radius": "m",
    "flat_length": "m",
    "depth": "m",
}
"""Units of a study's parameters, by the name of the argument."""


@dataclass(frozen=True)
class Scale:
    """A unit with its prefix, and the factor that turns SI into it."""

    factor: float
    unit: str

    @classmethod
    def of(cls, largest: float, unit: str) -> Scale:
        """Return the scale in which `largest` lies between 1 and 1000, as far as prefixes go."""
        # The prefix of an area is squared: mm² are 1e-6 m².
        power = 2 if unit.endswith("²") else 1
        if not unit or largest == 0 or not math.isfinite(largest):
            return cls(1.0, unit)
        # A number just below 1000 is printed as 1000.
        magnitude = math.floor(math.log10(abs(largest) * (1 + 1e-9)) / (3 * power)) * 3
        exponent = min(max(magnitude, min(PREFIXES)), max(PREFIXES))
        if unit in ("m", "m²"):
            exponent = min(exponent, 0)  # nobody writes kilometres
        return cls(float(f"1e{-exponent * power}"), PREFIXES[exponent] + unit)


def written(value: float, unit: str, digits: int = 4) -> str:
    """Return a number with its unit, prefixed.

    >>> written(1.46806e9, "Pa")
    '1.468 GPa'
    """
    scale = Scale.of(value, unit)
    return f"{scale.factor * value:.{digits}g} {scale.unit}".rstrip()
