"""Kinds of bearings by their contacts: rollers touch along lines, balls and barrels in ellipses."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import ClassVar

import numpy as np

import nacre._core as core
from nacre._tools.typing import Layers
from nacre.bearing.contact_laws import Hertzian, Slices
from nacre.bearing.geometry import RINGS, Array, Bearing, Ring
from nacre.hertz import Ellipse

WIDER = 1.5
"""Width of a grid over that of the widest contact that is expected; wider ones are solved again."""


class CurvedRaceways(Bearing):
    """Bearing whose raceways are curved along the elements, too: contacts are ellipses."""

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

    rolls: ClassVar[bool] = False
    leans: ClassVar[bool] = False

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

    rolls: ClassVar[bool] = True

    @abstractmethod
    def drop(self, ring: Ring, laminae: int = 40) -> Array:
        """Drop of a roller from the raceway at the middles of laminae [m]."""

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
