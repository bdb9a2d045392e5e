"""Ball bearings by what a catalogue or a drawing says of them; radii of contacts follow."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, field
from typing import ClassVar

import nacre._core as core
from nacre._tools.groups import in_unit
from nacre.bearing.bearings import Solvable
from nacre.bearing.equilibrium import Balls
from nacre.bearing.geometry import RINGS, Array, Ring, above, millimetres
from nacre.bearing.kinds import BallBearing

FLATTEST = 100.0
"""Largest radius of a groove over the diameter of a ball, which is plane beside it."""


@dataclass(frozen=True, kw_only=True)
class _Balls(BallBearing, Solvable):
    """Bearing with one row of balls in grooves."""

    osculation: tuple[float, float] = (0.52, 0.53)
    """Radii of the grooves of inner and outer ring over the diameter of a ball."""
    rating_factor: float = 1.3
    """Factor b_m of ISO 281 for the rating."""
    shoulder_height: float | None = field(default=None, metadata=in_unit("m"))
    """Height of the shoulders above the bottoms of the grooves [m]; None: a usual one."""

    def __post_init__(self) -> None:
        """Check the arguments."""
        super().__post_init__()
        self._check_given_pitch()
        for value in self.osculation:
            above("osculation", value, 0.5)
            if value > FLATTEST:
                raise ValueError(f"osculation must be at most {FLATTEST:g}, got {value!r}")
        if self.shoulder_height is not None:
            above("shoulder_height", self.shoulder_height)
            if self.shoulder_height > self.radius:
                raise ValueError(
                    f"shoulder_height must be at most the radius of a ball, "
                    f"{millimetres(self.radius)}, got {millimetres(self.shoulder_height)}"
                )
        self._check_room()

    @property
    def between(self) -> float:
        """Distance of the centres of both grooves of unloaded contacts [m]."""
        return (sum(self.osculation) - 1) * self.diameter

    @property
    @abstractmethod
    def free_angle(self) -> float:
        """Contact angle at which the balls touch both rings without load [rad]."""

    @property
    def shoulders(self) -> tuple[float, float]:
        """Angles from the bottoms of the grooves of both rings to their shoulders [rad].

        Without `shoulder_height` shoulders are a quarter of the ball's diameter high, so that both
        leave half of it to the cage; and those of an angular contact bearing hold at least what the
        contact at its angle is at 4200 MPa, the static rating of ISO 76:2006. None is higher than
        the middle of the ball, beyond which no ball could enter.
        """
        angles = []
        for ring, f in zip(RINGS, self.osculation, strict=True):
            height = self.shoulder_height or self.diameter / 4
            middle, angle = (
                math.acos(1 - high / (f * self.diameter)) for high in (self.radius, height)
            )
            if self.shoulder_height is None and self.nominal_angle:
                angle = max(
                    angle, self.nominal_angle + self.spread(ring, self.standards.static_pressure)
                )
            angles.append(min(angle, middle))
        return angles[0], angles[1]

    def spread(self, ring: Ring, pressure: float) -> float:
        """Return half of the angle at which the centre of a ball sees its contact [rad]."""
        unit = self.ellipse(ring, 1.0)
        # Both semi-axes and the pressure are as the cube root of the load.
        half = unit.semi_axes[0] * pressure / unit.peak_pressure
        return math.asin(min(1.0, half / self.radius))

    @property
    def mass(self) -> float:
        """Mass of a ball [kg]."""
        return self.density * math.pi / 6 * self.diameter**3

    @property
    def own_radii(self) -> tuple[float, float]:
        """Radii of a ball along x and y [m]."""
        return self.radius, self.radius

    @property
    def radii(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Signed radii of the raceways of inner and outer ring, along x and y [m]."""
        groove = [-f * self.diameter for f in self.osculation]
        inner, outer = self.raceways
        return (groove[0], inner), (groove[1], -outer)

    def motion(self, angles: Array) -> Balls:
        """Return how balls at these angles move with the inner ring."""
        return Balls(self, angles)

    def shape(self, ring: Ring) -> core.Shape:
        """Return the gap between a ball and a groove.

        Parameters
        ----------
        ring : {"inner", "outer"}
            Ring of the groove.

        Returns
        -------
        Shape
            Shape for `nacre.solve`: x across the groove, y in the direction of rolling.
        """
        along, rolling = self.radii[RINGS.index(ring)]
        return core.Paraboloid(*self.own_radii, along, rolling)


@dataclass(frozen=True, kw_only=True)
class DeepGrooveBall(_Balls):
    """Deep-groove ball bearing. Displacements count from the position in its middle.

    Parameters
    ----------
    count : int
        Number of balls.
    diameter : float
        Diameter D of a ball [m].
    pitch_diameter : float
        Diameter d_m of the circle of the balls' centres [m].
    osculation : tuple of float, optional
        Radii of the grooves of inner and outer ring over the diameter of a ball, above 0.5.
    clearance : float, optional
        Diametral clearance [m], below 0 with preload; 0 by default.
    element, inner, outer : HalfSpace or Elastic, optional
        Bodies of balls and rings; steel with E = 210 GPa by default.
    capacity : float, optional
        Dynamic load rating C_r [N]; by default that of ISO 281.
    rating_factor : float, optional
        Factor b_m of ISO 281.
    shoulder_height : float, optional
        Height of the shoulders of both rings above the bottoms of the grooves [m]: where a contact
        reaches beyond them, a warning says so. By default a quarter of the diameter of a ball.
    density : float, optional
        Density of the balls [kg/m³].

    Raises
    ------
    ValueError
        If an argument is out of range, or the rings do not hold the balls.

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall
    >>> bearing = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    >>> solution = bearing.solve(force=(1000.0, 0.0, None), model="iso16281")
    >>> round(float(solution.loads.max()))
    620
    """

    kind: ClassVar[str] = "deep_groove_ball"

    def __post_init__(self) -> None:
        """Check the arguments."""
        super().__post_init__()
        if self.play >= 2 * self.between:
            raise ValueError(
                f"clearance must be below twice the distance of the grooves' centres, "
                f"{millimetres(2 * self.between)}, got {millimetres(self.play)}"
            )

    @property
    def free_angle(self) -> float:
        """Contact angle at which the balls touch both rings without load [rad]."""
        return math.acos(min(1.0, 1 - self.play / (2 * self.between)))


@dataclass(frozen=True, kw_only=True)
class AngularContactBall(_Balls):
    """Single-row angular contact ball bearing. Positive z presses the inner ring into contact.

    It has one shoulder, and carries thrust along positive z alone.

    Parameters
    ----------
    count : int
        Number of balls.
    diameter : float
        Diameter D of a ball [m].
    pitch_diameter : float
        Diameter d_m of the circle of the balls' centres [m].
    contact_angle : float
        Contact angle without load [rad], above 0 and below π/2. Above π/4 the bearing is a thrust
        bearing of ISO 281: its rating is the axial one, C_a.
    osculation : tuple of float, optional
        Radii of the grooves of inner and outer ring over the diameter of a ball, above 0.5.
    element, inner, outer : HalfSpace or Elastic, optional
        Bodies of balls and rings; steel with E = 210 GPa by default.
    capacity : float, optional
        Dynamic load rating [N], C_r or above π/4 C_a; by default that of ISO 281.
    rating_factor : float, optional
        Factor b_m of ISO 281.
    shoulder_height : float, optional
        Height of the shoulders of both rings above the bottoms of the grooves [m]: where a contact
        reaches beyond them, a warning says so. By default a quarter of the diameter of a ball,
        or as much as the contact at `contact_angle` needs at 4200 MPa, the static rating of ISO 76.
    density : float, optional
        Density of the balls [kg/m³].

    Raises
    ------
    ValueError
        If an argument is out of range, or the rings do not hold the balls.

    Examples
    --------
    >>> import math
    >>> from nacre.bearing import AngularContactBall
    >>> bearing = AngularContactBall(
    ...     count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=math.radians(25)
    ... )
    >>> solution = bearing.solve(force=(0.0, 0.0, 2000.0), model="iso16281")
    >>> bool(solution.contact_angles[0, 0] > math.radians(25))
    True
    """

    contact_angle: float = field(metadata=in_unit("rad"))
    """Contact angle without load [rad]."""

    kind: ClassVar[str] = "angular_contact_ball"

    def __post_init__(self) -> None:
        """Check the arguments."""
        above("contact_angle", self.contact_angle)
        if self.contact_angle >= math.pi / 2:
            raise ValueError(
                f"contact_angle must be below π/2, in radians, got {self.contact_angle!r}"
            )
        self._give_way("clearance")
        super().__post_init__()
        if vars(self)["clearance"] not in (None, self.play):
            raise ValueError(
                "clearance must not be given: the contact angle says where balls touch"
            )

    @property
    def nominal_angle(self) -> float:
        """Nominal contact angle α [rad]."""
        return self.contact_angle

    def _check_loosest(self) -> None:
        """Raise a `ValueError` where a clearance that is given is one of millimetres."""
        if vars(self)["clearance"] is not None:
            super()._check_loosest()

    @property
    def play(self) -> float:
        """Diametral clearance of the rings in the middle of each other [m]."""
        return 2 * self.between * (1 - math.cos(self.contact_angle))

    @property
    def free_angle(self) -> float:
        """Contact angle at which the balls touch both rings without load [rad]."""
        return self.contact_angle
