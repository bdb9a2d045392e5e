"""What all bearings have in common: elements, rings and the room between them."""

from __future__ import annotations

import dataclasses
import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.arguments import read_fields
from nacre._tools.groups import in_unit
from nacre._tools.rounding import ROUNDING, floor
from nacre._tools.typing import Layers
from nacre._tools.units import system
from nacre.hertz import contact_modulus
from nacre.results.values import decode

if TYPE_CHECKING:
    from nacre.bearing.contact_laws import Hertzian, Slices
    from nacre.bearing.equilibrium import Elements

Array = npt.NDArray[np.float64]
Ring = Literal["inner", "outer"]

RINGS: tuple[Ring, Ring] = ("inner", "outer")
STEEL = core.Elastic(young=210e9, poisson=0.3)
"""Steel of bearings, as ISO/TS 16281 has it: its E and ν give the standard's factor 271."""
HIGHEST = 5e9
"""Largest pressure that any bearing carries [Pa], roughly."""
DEEPEST = 1 / 200
"""Largest preload of a contact over the diameter of the element.

Steel then carries some `HIGHEST`, and the contact is 0.07 of the radius of the element wide: wider
ones are no half-spaces.
"""
LOOSEST = 1 / 10
"""Largest clearance over the diameter of the element: five times that of the loosest group of
ISO 5753-1, some 2 %."""
LARGEST = {
    "diameter": 0.3,
    "length": 1.0,
    "pitch_diameter": 20.0,
    "raceway_diameters": 20.0,
    "profile_radius": 20.0,
    "groove_radius": 20.0,
}
"""Lengths that no bearing exceeds [m]: in mills elements have 0.2 m, slewing rings have 15 m."""
WIDEST = 1000.0
"""Pitch diameter over the diameter of an element that no bearing reaches, and that each has whose
pitch diameter alone is typed in millimetres: slewing rings have some 200."""
SMALLEST = 50e-6
"""Diameter below that of any element [m]: balls of micromachines have 0.28 mm."""
SOFTEST, SOFTEST_LAYER, STIFFEST = 1e9, 1e6, 2e12
"""Least modulus of an element or a ring, that of soft plastics, and of a layer, of rubber; largest
modulus, above that of diamond [Pa]."""
LIGHTEST, HEAVIEST = 100.0, 25e3
"""Least and largest density of an element [kg/m³]: a tenth of that of plastics; above osmium's."""


def above(name: str, value: object, least: float = 0.0, unit: str = "") -> float:
    """Return a finite number above `least`, or raise an error, which says the unit."""
    number = core.real(name, value)
    if not (math.isfinite(number) and number > least):
        bound = "" if least == -math.inf else f" and above {least:g}"
        bound += f", in {unit}" if unit else ""
        raise ValueError(f"{name} must be finite{bound}, got {value!r}")
    return number


def check_flag(name: str, value: object) -> None:
    """Raise a `TypeError` unless a value is True or False."""
    if not isinstance(value, bool):
        raise TypeError(f"{name} must be True or False, got {value!r}")


def _si() -> str:
    """Return a reminder of the units of bearings, whatever units are set."""
    own = "" if system().name == "SI" else f" whatever display_units says, {system().name}"
    return f"bearings are in N, m, Pa and kg{own}"


def millimetres(length: float) -> str:
    """Return a length in words."""
    return f"{length * 1e3:.6g} mm"


def substrate(body: Layers) -> core.Elastic:
    """Return the elastic constants of a body below its layers."""
    material = body.substrate if isinstance(body, core.HalfSpace) else body
    assert isinstance(material, core.Elastic)
    return material


class Follows(float):
    """A number that followed from other arguments.

    Where it follows again it gives way: `dataclasses.replace` hands all attributes on.
    """


class Following:
    """An argument that may be left out: the attribute is then what follows from the others."""

    def __init__(self, source: str, unit: str) -> None:
        """Take the name of the property that follows, and the SI unit, as `keyword_units` reads."""
        self.source, self.unit = source, in_unit(unit)["unit"]

    def __set_name__(self, owner: type, name: str) -> None:
        """Take the name of the argument, under which the instance keeps it."""
        self.name = name

    def __get__(self, bearing: object, owner: type | None = None) -> object:
        """Return the number; of the class None, which is the default of the argument."""
        if bearing is None:
            return None
        argument = vars(bearing)[self.name]
        return Follows(getattr(bearing, self.source)) if argument is None else argument

    def __set__(self, bearing: object, value: object) -> None:
        """Keep the argument."""
        vars(bearing)[self.name] = value


def _following(source: str, unit: str) -> Any:
    """Return a `Following`, whose type is that of its numbers."""
    return Following(source, unit)


class Standards(NamedTuple):
    """Numbers that ISO 76 and ISO 281 have for balls, and others for rollers."""

    element: Literal["ball", "roller"]
    """Rolling elements."""
    life_exponent: float
    """Exponent p of the life ``(C/P)^p``: ISO 281:2007."""
    static_pressure: float
    """Pressure of the static rating [Pa], ISO 76:2006, 3.2.

    Self-aligning ball bearings, of 4.6 GPa, are not among nacre's.
    """
    limit_share: float
    """Load of the heaviest element over the mean one at the fatigue load limit, ISO 281:2007, annex
    B: (B.9) and (B.14)."""
    static_over_limit: float
    """Static rating over the fatigue load limit: annex B, (B.18) to (B.21)."""
    static_safety: float
    """Static safety s_0 that is usually required, of normal operation: ISO 76:2006."""
    size_power: float
    """Power of 100 mm over the pitch diameter by which limits of larger bearings fall: annex B."""


BALLS = Standards("ball", 3.0, 4.2e9, 1 / 0.2288, 22.0, 1.0, 0.5)
ROLLERS = Standards("roller", 10 / 3, 4.0e9, 1 / 0.2453, 8.2, 1.5, 0.3)

KNOWN: dict[str, type[Bearing]] = {}
"""Bearings by the names of their classes, which files have."""


@dataclass(frozen=True, kw_only=True)
class Bearing(ABC):
    """What all bearings have: rows of elements between two rings.

    The bearing's axis is z. Element j stands at the angle ``rotation + 2 π j / count`` from x.
    Rings are rigid in the large, so that only contacts are elastic.
    """

    count: int
    """Number of rolling elements in a row."""
    diameter: float = field(metadata=in_unit("m"))
    """Diameter of an element [m]."""
    pitch_diameter: float | None = _following("pitch", "m")
    """Diameter of the circle of the elements' centres [m]."""
    clearance: float | None = _following("play", "m")
    """Diametral clearance [m], below 0 with preload; 0 by default."""
    element: Layers = STEEL
    """Body of the elements."""
    inner: Layers = STEEL
    """Body of the inner ring."""
    outer: Layers = STEEL
    """Body of the outer ring."""
    capacity: float | None = _following("standard_capacity", "N")
    """Dynamic load rating C_r [N]; by default that of ISO 281."""
    rating_factor: float = 1.1
    """Factor b_m of ISO 281 for the rating."""
    density: float = field(default=7850.0, metadata=in_unit("kg/m³"))
    """Density of the elements [kg/m³], for the centrifugal force."""

    kind: ClassVar[str]
    """Name in case files."""
    standards: ClassVar[Standards]
    """Numbers of the standards for the elements."""
    usual_cells: ClassVar[tuple[int, int]]
    """Cells of a contact by default.

    With these the load of a ball at a given approach is right to 1e-4, the peak pressure of a
    roller to 1e-3, and the pressure near its edge, where it is steep, to 2 %: measured against
    twice as many.
    """
    cells_multiple: ClassVar[int] = 1
    """Number of which the cells along an element are a multiple."""
    width_power: ClassVar[int]
    """Power of the width of a contact in its load, of rollers in that per length."""
    carries_moments: ClassVar[bool] = True
    """Whether the elements tilt against the raceways and carry moments."""
    aligns: ClassVar[bool] = False
    """Whether the bearing aligns itself, so that a tilt of the ring changes nothing."""

    def __init_subclass__(cls) -> None:
        """Make a kind of bearing known to files."""
        super().__init_subclass__()
        if "kind" in vars(cls):
            KNOWN[cls.__name__] = cls

    def __post_init__(self) -> None:
        """Check what all bearings have in common."""
        read_fields(self)
        if self.count < 2:
            raise ValueError(f"count must be at least 2, got {self.count}")
        above("diameter", self.diameter)
        for name in ("rating_factor", "density"):
            above(name, getattr(self, name))
        if not 0.1 <= self.rating_factor <= 10:
            raise ValueError(
                f"rating_factor must be from 0.1 to 10, in ISO 281 it is 1 to 1.3, "
                f"got {self.rating_factor!r}"
            )
        self._give_way("capacity")
        for name, least in (("capacity", 0.0), ("clearance", -math.inf)):
            if (value := vars(self)[name]) is not None:
                above(name, value, least)
        for name in ("element", *RINGS):
            body = getattr(self, name)
            if not isinstance(body, core.Elastic | core.HalfSpace):
                raise TypeError(f"{name} must be an Elastic or a HalfSpace, got {body!r}")
            if isinstance(body, core.HalfSpace):
                if not isinstance(body.substrate, core.Elastic):
                    raise ValueError(f"{name} must have an elastic substrate, got {body!r}")
                if body.ends != (None, None):
                    raise ValueError(f"{name} must have no ends: those of rollers are free_ends")
        self._check_units()

    def _give_way(self, name: str) -> None:
        """Leave an argument out that followed from others of another bearing."""
        if isinstance(vars(self)[name], Follows):
            object.__setattr__(self, name, None)

    def _check_units(self) -> None:
        """Raise a `ValueError` where a number is one of millimetres, megapascals or such."""
        for name, most in LARGEST.items():
            value = vars(self).get(name)
            for length in value if isinstance(value, tuple | list) else (value,):
                if isinstance(length, int | float) and most < length < math.inf:
                    raise ValueError(
                        f"{name} must be at most {most:g} m: {_si()}; got {length:g} m"
                    )
        for name in ("element", *RINGS):
            body = getattr(self, name)
            layers = body.layers if isinstance(body, core.HalfSpace) else ()
            moduli = [(name, substrate(body), SOFTEST)]
            moduli += [
                (f"{name}.layers[{k}]", layer.material, SOFTEST_LAYER)
                for k, layer in enumerate(layers)
            ]
            for place, material, least in moduli:
                if isinstance(material, core.Elastic) and not least <= material.young <= STIFFEST:
                    raise ValueError(
                        f"{place} must have a modulus from {least:g} to {STIFFEST:g} Pa: {_si()}; "
                        f"got {material.young:g} Pa"
                    )
            for k, layer in enumerate(layers):
                if layer.thickness > self.diameter / 2:
                    raise ValueError(
                        f"{name}.layers[{k}] must be thinner than an element, "
                        f"{self.diameter / 2:g} m: {_si()}; got {layer.thickness:g} m"
                    )
        if not LIGHTEST <= self.density <= HEAVIEST:
            raise ValueError(
                f"density must be from {LIGHTEST:g} to {HEAVIEST:g} kg/m³: {_si()}; "
                f"got {self.density!r} kg/m³"
            )
        if self.diameter < SMALLEST:
            raise ValueError(
                f"diameter must be at least {SMALLEST:g} m: {_si()}; got {self.diameter!r} m"
            )

    def _check_given_pitch(self) -> None:
        """Raise an error unless the pitch diameter is given, and in range."""
        if vars(self)["pitch_diameter"] is None:
            raise ValueError("pitch_diameter must be given")
        above("pitch_diameter", self.pitch_diameter)

    def _check_room(self) -> None:
        """Raise a `ValueError` unless the rings hold the elements."""
        pitch, diameter = self.pitch, self.diameter
        if pitch <= diameter:
            raise ValueError(
                f"pitch_diameter must be above the diameter of an element, "
                f"{millimetres(diameter)}, for there is no room for an inner ring; "
                f"got {millimetres(pitch)}"
            )
        if pitch >= WIDEST * diameter:
            raise ValueError(
                f"pitch_diameter must be below {WIDEST:g} diameters of an element, "
                f"{millimetres(WIDEST * diameter)}: {_si()}; got {millimetres(pitch)}"
            )
        apart = pitch * math.sin(math.pi / self.count)
        if apart < (1.0 - ROUNDING) * diameter:
            most = floor(math.pi / math.asin(diameter / pitch))
            raise ValueError(
                f"count must be at most {most}: on a pitch circle of {millimetres(pitch)}, "
                f"{self.count} elements are {millimetres(apart)} apart, less than their diameter, "
                f"{millimetres(diameter)}"
            )
        self._check_loosest()
        capacity, usual = vars(self)["capacity"], self.standard_capacity
        if capacity is not None and not usual / 100 <= capacity <= 100 * usual:
            raise ValueError(
                f"capacity must be in N, some {usual:.3g}, that of ISO 281: {_si()}; "
                f"got {capacity!r} N"
            )
        if self.play < -4 * DEEPEST * diameter:
            raise ValueError(
                f"clearance must be at least {millimetres(-4 * DEEPEST * diameter)}, where "
                f"contacts of steel carry {HIGHEST / 1e9:g} GPa and are no longer small; "
                f"got {millimetres(self.play)}"
            )

    def _check_loosest(self) -> None:
        """Raise a `ValueError` where the clearance is one of millimetres."""
        loosest = LOOSEST * self.diameter
        if self.play > loosest:
            raise ValueError(
                f"clearance must be at most a tenth of the diameter of an element, "
                f"{millimetres(loosest)}: {_si()}; got {millimetres(self.play)}"
            )

    @property
    def pitch(self) -> float:
        """Pitch diameter [m]."""
        pitch: float = vars(self)["pitch_diameter"]
        return pitch

    @property
    def rows(self) -> int:
        """Number of rows of elements."""
        return 1

    @property
    def elements(self) -> int:
        """Number of elements of all rows."""
        return self.rows * self.count

    @property
    def play(self) -> float:
        """Diametral clearance [m], below 0 with preload."""
        return vars(self)["clearance"] or 0.0

    @property
    @abstractmethod
    def standard_capacity(self) -> float:
        """Dynamic load rating of ISO 281 [N], whatever the capacity is."""

    @property
    def gamma(self) -> float:
        """Ratio ``γ = D cos α / d_m``, with the nominal contact angle."""
        return self.diameter * math.cos(self.nominal_angle) / self.pitch

    @property
    def nominal_angle(self) -> float:
        """Nominal contact angle α [rad]."""
        return 0.0

    @property
    def carries_thrust(self) -> bool:
        """Whether contacts have forces along the bearing's axis."""
        return True

    @property
    def needs_thrust(self) -> bool:
        """Whether a thrust alone holds the rings together, as angles follow the load."""
        return not self.carries_moments and self.nominal_angle > 0

    @property
    def radius(self) -> float:
        """Radius of an element in the direction of rolling [m]."""
        return self.diameter / 2

    @property
    def tracks(self) -> tuple[float, float]:
        """Radii of the tracks of both rings about the bearing's axis [m]."""
        inner, outer = self.raceways
        cos = math.cos(self.nominal_angle)
        return inner * cos, outer * cos

    def cage_speed(self, speed: float, rotating: Ring = "inner") -> float:
        """Return the speed of the cage where one ring rotates and the elements roll [rad/s].

        The middle of an element moves half as fast as the track that drives it, as the other one
        stands still: ``ω_c = ω r/(r_i + r_e)`` with the radius r of the driving track, derived
        here. With ``γ = D cos α/d_m`` it is ``ω (1 − γ)/2`` where the inner ring rotates, as NTN's
        instruction manual HV0002 has it in table 5.2, and ``ω (1 + γ)/2`` where the outer one does;
        of tapered rollers γ is ``D cos(α − β)/d_m``.

        Parameters
        ----------
        speed : float
            Angular velocity of the ring that rotates [rad/s].
        rotating : {"inner", "outer"}, optional
            Ring that rotates; the other one stands still.

        Returns
        -------
        float
            Angular velocity of the elements about the bearing's axis, with the nominal contact
            angle [rad/s].

        Examples
        --------
        >>> from nacre.bearing import CylindricalRoller
        >>> bearing = CylindricalRoller(
        ...     count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3
        ... )
        >>> round(bearing.cage_speed(100.0), 3), round(bearing.cage_speed(100.0, "outer"), 3)
        (42.308, 57.692)
        """
        return speed * self.tracks[RINGS.index(rotating)] / sum(self.tracks)

    @property
    def outward(self) -> tuple[tuple[float, float], float]:
        """Parts of the centrifugal force: on an element's coordinates, and on the ring along z."""
        return (1.0, 0.0), 0.0

    @property
    def raceways(self) -> tuple[float, float]:
        """Radii of inner and outer raceway in the direction of rolling [m]."""
        wide = self.pitch / math.cos(self.nominal_angle)
        return (wide - self.diameter) / 2, (wide + self.diameter) / 2

    def curvature(self, ring: Ring, x: Array | float = 0.0) -> Array:
        """Return the curvature of the gap in the direction of rolling [1/m].

        Parameters
        ----------
        ring : {"inner", "outer"}
            Ring of the raceway.
        x : array_like, optional
            Places along the element from its middle [m].

        Returns
        -------
        numpy.ndarray
            Curvatures.
        """
        number = RINGS.index(ring)
        total = 1 / self.radius + (1, -1)[number] / self.raceways[number]
        return np.full(core.real_array("x", x).shape, total)

    @cached_property
    def modulus(self) -> tuple[float, float]:
        """Contact moduli E* of the substrates, of elements and both rings [Pa]."""
        element = substrate(self.element)
        inner, outer = (contact_modulus(element, substrate(getattr(self, ring))) for ring in RINGS)
        return inner, outer

    @property
    def layered(self) -> bool:
        """Whether a body has layers."""
        bodies = (self.element, self.inner, self.outer)
        return any(isinstance(body, core.HalfSpace) and body.layers for body in bodies)

    @property
    def reach(self) -> float:
        """Half of the length of a contact that may be tilted [m], 0 of balls."""
        return 0.0

    @abstractmethod
    def motion(self, angles: Array) -> Elements:
        """Return how elements at these angles move with the inner ring."""

    @abstractmethod
    def law(self, model: str) -> Slices | Hertzian:
        """Return the contacts of the standard, or those for a first guess of solved ones."""

    @abstractmethod
    def grid(self, ring: Ring, load: float, cells: tuple[int, int]) -> core.Grid:
        """Return a grid for a contact that carries a load, per length that of rollers."""

    def bodies(self, ring: Ring) -> tuple[Layers, Layers]:
        """Return the bodies of a contact: ring and element."""
        return getattr(self, ring), self.element

    @abstractmethod
    def shape(self, ring: Ring) -> core.Shape:
        """Return the gap between an element and a raceway.

        Parameters
        ----------
        ring : {"inner", "outer"}
            Ring of the raceway.

        Returns
        -------
        Shape
            Shape for `nacre.solve`: x along the axis of the element, y in the direction of rolling.
        """

    @property
    @abstractmethod
    def mass(self) -> float:
        """Mass of an element [kg]."""

    def _arguments(self) -> dict[str, object]:
        """Return what makes the bearing again, for files and journals of studies."""
        return {field.name: vars(self)[field.name] for field in dataclasses.fields(self)}


def bearing_from(data: Mapping[str, object]) -> Bearing:
    """Return the bearing that plain data describe; other data raise an error."""
    ((name, fields),) = data.items()
    return KNOWN[name](**decode(fields))


def laminae_of(length: float, laminae: int) -> Array:
    """Return the middles of laminae along a roller [m]."""
    return (np.arange(laminae) + 0.5) / laminae * length - length / 2
