"""Fields of the page's cards: what they change, in which unit, and where the number is found."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from nacre._tools.units import System, size_of

SCALES: dict[str, Callable[[float], float]] = {
    "1/min": lambda value: value * 2 * math.pi / 60,
    "′": lambda value: math.tan(math.radians(value / 60)),
    "°": math.radians,
}
"""Numbers of a case by those in units that no system has: rad/s, slopes and radians."""


class Field(NamedTuple):
    """A number of a case, as it is typed."""

    path: str
    """Path of the number in the case."""
    label: str
    """What it is."""
    unit: str
    """Unit in which it is typed."""
    default: float | None
    """Number at the start; None of an empty field."""
    low: float = -math.inf
    """Smallest number."""
    high: float = math.inf
    """Largest number."""
    slides: str = ""
    """Slider: "log", "linear", or none."""
    help: str = ""
    """What it is in a sentence, and where to find it."""
    may_be_empty: bool = False
    """Whether the number may be missing."""
    is_count: bool = False
    """Whether it is a whole number."""

    def in_case(self, value: float, units: str) -> float:
        """Return a number of the field in the units of a case."""
        if self.is_count:
            return round(value)
        if (scale := SCALES.get(self.unit)) is not None:
            return scale(value)
        return tidy(value * self.size / System(units).unit(self.dimension)[0])

    @property
    def dimension(self) -> str:
        """SI unit of the number."""
        return (size_of(self.unit) or ("", 1.0))[0]

    @property
    def size(self) -> float:
        """Size of the unit in SI."""
        return (size_of(self.unit) or ("", 1.0))[1]


def tidy(value: float) -> float:
    """Return a number without the rounding of its unit: 0.002 in place of 0.0020000000000000005."""
    return float(f"{value:.12g}")


YOUNG = "Young's modulus; a material of the list fills it with its source"
YIELD = "0.2 % offset; of hardened bearing steel some 2000 MPa; empty if unknown"
STRENGTH = (
    "tension at which the coating cracks; empty if unknown: the verdict then says what it must bear"
)
LENGTH = "effective length of a roller, without its chamfers; catalogue L_we"
CLEARANCE = "diametral clearance when mounted; ISO 5753 gives ranges by class"
TILT = "angle between the rings; 1′ is 0.29 mm per metre"
FRICTION = "coefficient of friction: traction over pressure; 0 without sliding"


def _coating(
    young: float, thickness: float, strength: float | None, yield_stress: float
) -> tuple[Field, ...]:
    return (
        Field("body.layers[0].thickness", "coating thickness", "µm", thickness, 0.1, 50, "log"),
        Field("materials.coating.young", "coating modulus", "GPa", young, 1, 1000, "log", YOUNG),
        Field(
            *("materials.coating.strength", "coating strength", "MPa", strength, 1, 1e5, ""),
            *(STRENGTH, True),
        ),
        Field("materials.steel.young", "substrate modulus", "GPa", 210, 1, 700, "", YOUNG),
        Field(
            *("materials.steel.yield_stress", "substrate yield stress", "MPa", yield_stress),
            *(1, 1e5, ""),
            *(YIELD, True),
        ),
    )


def _film(
    thickness: float, young: float, poisson: float, base: str, *of_base: float
) -> tuple[Field, ...]:
    body = f"materials.{base}"
    return (
        Field("body.layers[0].thickness", "film thickness", "nm", thickness, 10, 1e4, "log"),
        Field("materials.film.young", "film modulus", "GPa", young, 0.01, 1000, "log", YOUNG),
        Field("materials.film.poisson", "film Poisson's ratio", "", poisson, 0, 0.499),
        Field(f"{body}.young", "substrate modulus", "GPa", of_base[0], 0.01, 1000, "", YOUNG),
        Field(f"{body}.poisson", "substrate Poisson's ratio", "", of_base[1], 0, 0.499),
    )


def _speed(default: float = 1500) -> Field:
    return Field("bearing.solve.speed", "speed", "1/min", default, 1, 1e5)


BEARING = (
    Field("bearing.count", "rollers", "", 16, 3, 200, is_count=True),
    Field("bearing.diameter", "roller diameter", "mm", 11, 1, 200),
    Field("bearing.length", "roller length", "mm", 12, 1, 300, "", LENGTH),
    Field("bearing.pitch_diameter", "pitch diameter", "mm", 65.5, 5, 2000),
    Field("bearing.clearance", "clearance", "µm", 45, -50, 500, "", CLEARANCE),
    Field("bearing.solve.force.x", "radial load", "kN", 10, 0.1, 1000, "log"),
    Field("bearing.solve.tilt.y", "misalignment", "′", 2, 0, 10, "linear", TILT),
    _speed(),
)
BALL_BEARING = (
    Field("bearing.count", "balls", "", 9, 3, 200, is_count=True),
    Field("bearing.diameter", "ball diameter", "mm", 7.94, 0.5, 200),
    Field("bearing.pitch_diameter", "pitch diameter", "mm", 39.04, 3, 2000),
    Field("bearing.clearance", "clearance", "µm", 12, -50, 500, "", CLEARANCE),
    Field(
        *("bearing.osculation[0]", "groove radius over ball diameter", "", 0.52, 0.505, 0.6, ""),
        "of the inner ring; 0.52 is usual",
    ),
    Field("bearing.solve.force.x", "radial load", "kN", 3, 0.01, 1000, "log"),
    Field("bearing.solve.force.z", "axial load", "kN", 1, 0, 1000, "log"),
    _speed(),
)
CONTACT = (
    Field("shape.radius", "ball radius", "mm", 5, 0.01, 1000),
    Field("solve.load", "load", "N", 20, 0.001, 1e6, "log"),
    Field("stress.friction", "friction", "", 0.1, 0, 1, "", FRICTION),
    *_coating(259, 2, None, 2200),
)
ROLLER = (
    Field("shape.radius", "roller radius", "mm", 5, 0.1, 1000),
    Field("shape.flat_length", "flat length", "mm", 8, 0.1, 300, "", "straight part of the roller"),
    Field("shape.crown_radius", "crown radius", "mm", 300, 10, 1e5, "", "radius of its ends"),
    Field("solve.load", "load", "N", 500, 0.1, 1e6, "log"),
    Field(
        *("solve.eccentricity.x", "eccentricity", "mm", 0.3, 0, 100, ""),
        "distance of the load from the middle of the roller, which tilts it",
    ),
    *(
        one
        for one in _coating(300, 3, None, 2200)
        if "strength" not in one.path and "steel.young" not in one.path
    ),
)
LINE = (
    Field("shape.radius", "cylinder radius", "mm", 10, 0.01, 1e4),
    Field("solve.load", "load per length", "N/mm", 100, 0.01, 1e5, "log"),
    Field("stress.friction", "friction", "", 0.1, 0, 1, "", FRICTION),
    *_coating(300, 3, 1500, 2000),
)
SPHERE = (
    Field("tip.radius", "tip radius", "µm", 5, 0.01, 1000),
    Field("indent.load", "largest load", "mN", 1, 1e-4, 1000, "log"),
    *_film(1000, 3, 0.4, "glass", 70, 0.22),
    Field(
        *("adhesion.work", "work of adhesion", "mJ/m²", 0, 0, 500, ""),
        "energy to part the surfaces, over their area; some 50 mJ/m² of clean polymers",
    ),
)
CONE = (
    Field(
        *("tip.half_angle", "half angle", "°", 70.25, 10, 89, ""),
        "between axis and flank; 70.3° has as much area at each depth as Berkovich's pyramid",
    ),
    Field("indent.load", "largest load", "mN", 1, 1e-4, 1000, "log"),
    *_film(500, 100, 0.25, "silicon", 170, 0.22),
)
CARDS = {
    "bearing": ("Bearing", "cylindrical roller bearing", BEARING),
    "ball-bearing": ("Bearing", "deep-groove ball bearing", BALL_BEARING),
    "contact": ("Coated contact", "ball", CONTACT),
    "roller": ("Coated contact", "roller", ROLLER),
    "line": ("Coated contact", "line", LINE),
    "indentation": ("Indentation", "sphere", SPHERE),
    "cone": ("Indentation", "cone", CONE),
}
"""Group, title and main fields of the cards, by their templates."""
