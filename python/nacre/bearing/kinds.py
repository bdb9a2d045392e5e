"""Kinds of bearings by their contacts: rollers touch along lines, balls and barrels in ellipses."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import ClassVar

import numpy as np

import nacre._core as core
from nacre._tools.typing import Layers
from nacre.bearing.contact_laws import LAMINAE, Hertzian, Slices
from nacre.bearing.geometry import (
    BALLS,
    RINGS,
    ROLLERS,
    Array,
    Bearing,
    Ring,
    Standards,
    laminae_of,
)
from nacre.hertz import Ellipse

WIDER = 1.5
"""Width of a grid over that of the widest contact that is expected; wider ones are solved again."""
PLANE = 1e6
"""Radius of a surface that is plane across its profile [m]: it drops by 1e-14 m in 0.1 mm."""


class CurvedRaceways(Bearing):
    """Bearing whose raceways are curved along the elements, too: contacts are ellipses."""

    carries_moments: ClassVar[bool] = False

    @property
    @abstractmethod
    def own_radii(self) -> tuple[float, float]:
        """Radii of an element in its middle, along x and y [m]."""

    @property
    @abstractmethod
    def radii(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Signed radii of the raceways of inner and outer ring, along x and y [m]."""

    def ellipse(self, ring: Ring, load: float) -> Ellipse:
        """Return Hertz's contact of an element that carries a load [N]."""
        number = RINGS.index(ring)
        (own_x, own_y), (x, y) = self.own_radii, self.radii[number]
        return Ellipse(own_x, own_y, self.modulus[number], load, x, y)


class BallBearing(CurvedRaceways):
    """Bearing with balls."""

    osculation: tuple[float, float]
    """Radii of the grooves of inner and outer ring over the diameter of a ball."""

    standards: ClassVar[Standards] = BALLS
    usual_cells: ClassVar[tuple[int, int]] = (96, 96)
    width_power: ClassVar[int] = 3

    @property
    @abstractmethod
    def shoulders(self) -> tuple[float, float]:
        """Angles from the bottoms of the grooves of both rings to their shoulders [rad]."""

    @abstractmethod
    def spread(self, ring: Ring, pressure: float) -> float:
        """Return half of the angle at which the centre of a ball sees its contact [rad]."""

    def law(self, model: str) -> Hertzian:
        """Return the contacts of the standard, or those for a first guess of solved ones."""
        return Hertzian(self)

    def grid(self, ring: Ring, load: float, cells: tuple[int, int]) -> core.Grid:
        """Return a grid for a contact that carries a load [N]."""
        a, b = self.ellipse(ring, load).semi_axes
        return core.Grid(cells, (2 * WIDER * a, 2 * WIDER * b))


class RollerBearing(Bearing):
    """Bearing with rollers."""

    length: float
    """Effective length of a roller [m]."""
    free_ends: bool
    """Whether the ends of the rollers are free surfaces."""

    standards: ClassVar[Standards] = ROLLERS
    usual_cells: ClassVar[tuple[int, int]] = (3 * LAMINAE, 48)
    cells_multiple: ClassVar[int] = LAMINAE
    width_power: ClassVar[int] = 2

    @property
    def apex(self) -> float | None:
        """Distance of the apex of rollers and raceways from the middle of a roller [m]."""
        return None

    @abstractmethod
    def _profile(self) -> core.LogarithmicProfile | core.SampledProfile:
        """Return the profile of a roller."""

    @abstractmethod
    def _own_drop(self, x: Array) -> Array:
        """Return the drop of that profile at x along a roller [m], infinite beyond it."""

    @abstractmethod
    def _crown(self, ring: Ring, x: Array) -> Array:
        """Return the drop of a raceway at x along it [m]."""

    @abstractmethod
    def _crown_points(self, ring: Ring) -> int:
        """Return the number of points between which cubics are that drop; 0 where it is 0."""

    def drop(self, ring: Ring, laminae: int = LAMINAE) -> Array:
        """Drop of a roller from the raceway at the middles of laminae [m]."""
        x = laminae_of(self.length, laminae)
        return self._own_drop(x) + self._crown(ring, x)

    def shape(self, ring: Ring) -> core.Shape:
        """Return the gap between a roller and a raceway.

        Parameters
        ----------
        ring : {"inner", "outer"}
            Ring of the raceway.

        Returns
        -------
        Shape
            Shape for `nacre.solve`: x along the roller, y in the direction of rolling.
        """
        inner, outer = self.raceways
        roller = core.Roller(
            radius=self.radius,
            length=self.length,
            profile=self._profile(),
            counter_radius=inner if ring == "inner" else -outer,
            apex=self.apex,
        )
        if not (points := self._crown_points(ring)):
            return roller
        x = np.linspace(-0.5, 0.5, points) * self.length
        crown = core.SampledProfile(x, self._crown(ring, x))
        return roller + core.Roller(PLANE, length=float(x[-1] - x[0]), profile=crown)

    @property
    def carries_thrust(self) -> bool:
        """Whether contacts have forces along the bearing's axis: those at an angle."""
        return self.nominal_angle > 0

    @property
    def reach(self) -> float:
        """Half of the length of a roller [m]."""
        return self.length / 2

    def law(self, model: str) -> Slices:
        """Return the contacts of the standard, or those for a first guess of solved ones."""
        return Slices(self, standard=model == "iso16281")

    def grid(self, ring: Ring, load: float, cells: tuple[int, int]) -> core.Grid:
        """Return a grid for a contact whose largest load per length is this [N/m]."""
        ends = np.array([-0.5, 0.0, 0.5]) * self.length
        curvature = float(self.curvature(ring, ends).min())
        half = math.sqrt(4 * load / (math.pi * self.modulus[RINGS.index(ring)] * curvature))
        return core.Grid(cells, (self._loaded_length(ring, load), 2 * WIDER * half))

    def _loaded_length(self, ring: Ring, line: float) -> float:
        """Return how much of a roller a contact needs whose largest load per length is this [m]."""
        return self.length

    def bodies(self, ring: Ring) -> tuple[Layers, Layers]:
        """Return the bodies of a contact: ring and roller, with free ends or without."""
        body, element = super().bodies(ring)
        if self.free_ends:
            layers = element.layers if isinstance(element, core.HalfSpace) else ()
            base = element.substrate if isinstance(element, core.HalfSpace) else element
            element = core.HalfSpace(base, layers, ends=(-self.reach, self.reach))
        return body, element


def checked_bearing(bearing: object) -> RollerBearing | BallBearing:
    """Return a bearing of either kind, or raise a `TypeError`."""
    if not isinstance(bearing, RollerBearing | BallBearing):
        raise TypeError(f"bearing must be a bearing, got {bearing!r}")
    return bearing
