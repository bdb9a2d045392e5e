"""What all bearings have in common: elements, rings and the room between them."""

from __future__ import annotations

import dataclasses
import math
from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.typing import Layers
from nacre.hertz import contact_modulus
from nacre.results.values import decode

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


def above(name: str, value: Any, least: float = 0.0) -> None:
    """Raise a `ValueError` unless a value is a finite number above `least`."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{name} must be a number, got {value!r}")
    if not (math.isfinite(value) and value > least):
        bound = "" if least == -math.inf else f" and above {least:g}"
        raise ValueError(f"{name} must be finite{bound}, got {value!r}")


def check_flag(name: str, value: Any) -> None:
    """Raise a `TypeError` unless a value is True or False."""
    if not isinstance(value, bool):
        raise TypeError(f"{name} must be True or False, got {value!r}")


def pair(name: str, value: Any) -> tuple[Any, Any]:
    """Return two values, of the inner and the outer ring."""
    if isinstance(value, str) or not isinstance(value, Iterable):
        raise TypeError(f"{name} must be two values, got {value!r}")
    if len(found := tuple(value)) != 2:
        raise ValueError(f"{name} must be two values, got {value!r}")
    return found[0], found[1]


def millimetres(length: float) -> str:
    """Return a length in words."""
    return f"{length * 1e3:.6g} mm"


def substrate(body: Layers) -> core.Elastic:
    """Return the elastic constants of a body below its layers."""
    found = body.substrate if isinstance(body, core.HalfSpace) else body
    assert isinstance(found, core.Elastic)
    return found


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
    diameter: float
    """Diameter of an element [m]."""
    pitch_diameter: float | None = None
    """Diameter of the circle of the elements' centres [m]."""
    clearance: float | None = None
    """Diametral clearance [m], below 0 with preload; 0 by default."""
    element: Layers = STEEL
    """Body of the elements."""
    inner: Layers = STEEL
    """Body of the inner ring."""
    outer: Layers = STEEL
    """Body of the outer ring."""
    capacity: float | None = None
    """Dynamic load rating C_r [N]; by default that of ISO 281."""
    rating_factor: float = 1.1
    """Factor b_m of ISO 281 for the rating."""
    density: float = 7850.0
    """Density of the elements [kg/m³], for the centrifugal force."""

    kind: ClassVar[str]
    """Name in case files."""
    rolls: ClassVar[bool]
    """Whether the elements are rollers, in line contact."""
    leans: ClassVar[bool]
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
        if isinstance(self.count, bool) or not isinstance(self.count, int):
            raise TypeError(f"count must be an integer, got {self.count!r}")
        if self.count < 2:
            raise ValueError(f"count must be at least 2, got {self.count}")
        above("diameter", self.diameter)
        for name in ("rating_factor", "density"):
            above(name, getattr(self, name))
        if self.capacity is not None:
            above("capacity", self.capacity)
        if self.clearance is not None:
            above("clearance", self.clearance, -math.inf)
        for name in ("element", *RINGS):
            body = getattr(self, name)
            if not isinstance(body, core.Elastic | core.HalfSpace):
                raise TypeError(f"{name} must be an Elastic or a HalfSpace, got {body!r}")
            if isinstance(body, core.HalfSpace):
                if not isinstance(body.substrate, core.Elastic):
                    raise ValueError(f"{name} must have an elastic substrate, got {body!r}")
                if body.ends != (None, None):
                    raise ValueError(f"{name} must have no ends: those of rollers are free_ends")

    def _check_given_pitch(self) -> None:
        """Raise an error unless the pitch diameter is given, and in range."""
        if self.pitch_diameter is None:
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
        apart = pitch * math.sin(math.pi / self.count)
        if apart < diameter:
            most = math.floor(math.pi / math.asin(diameter / pitch))
            raise ValueError(
                f"count must be at most {most}: on a pitch circle of {millimetres(pitch)}, "
                f"{self.count} elements are {millimetres(apart)} apart, less than their diameter, "
                f"{millimetres(diameter)}"
            )
        if self.play < -4 * DEEPEST * diameter:
            raise ValueError(
                f"clearance must be at least {millimetres(-4 * DEEPEST * diameter)}, where "
                f"contacts of steel carry {HIGHEST / 1e9:g} GPa and are no longer small; "
                f"got {millimetres(self.play)}"
            )

    @property
    def pitch(self) -> float:
        """Pitch diameter [m]."""
        assert self.pitch_diameter is not None
        return self.pitch_diameter

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
        return self.clearance or 0.0

    @property
    def gamma(self) -> float:
        """Ratio ``γ = D cos α / d_m``, with the nominal contact angle."""
        return self.diameter * math.cos(self.nominal_angle) / self.pitch

    @property
    def nominal_angle(self) -> float:
        """Nominal contact angle α [rad]."""
        return 0.0

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
        found = 1 / self.radius + (1, -1)[number] / self.raceways[number]
        return np.full(np.shape(x), found)

    @cached_property
    def modulus(self) -> tuple[float, float]:
        """Contact moduli E* of the substrates, of elements and both rings [Pa]."""
        element = substrate(self.element)
        one, other = (contact_modulus(element, substrate(getattr(self, ring))) for ring in RINGS)
        return one, other

    @property
    def layered(self) -> bool:
        """Whether a body has layers."""
        bodies = (self.element, self.inner, self.outer)
        return any(isinstance(body, core.HalfSpace) and body.layers for body in bodies)

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

    def _arguments(self) -> dict[str, Any]:
        """Return what makes the bearing again, for files and journals of studies."""
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}


def decoded(data: Any) -> Bearing:
    """Return the bearing that plain data describe; other data raise an error."""
    ((name, given),) = data.items()
    return KNOWN[name](**decode(given))


def laminae_of(length: float, laminae: int) -> Array:
    """Return the middles of laminae along a roller [m]."""
    return (np.arange(laminae) + 0.5) / laminae * length - length / 2
