"""Roller bearings by what a catalogue or a drawing says of them; radii of contacts follow."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, Literal, get_args

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.groups import in_unit
from nacre.bearing.bearings import Solvable
from nacre.bearing.equilibrium import Barrels, Rollers
from nacre.bearing.geometry import RINGS, Ring, above, check_flag, millimetres
from nacre.bearing.kinds import WIDER, CurvedRaceways, RollerBearing

Array = npt.NDArray[np.float64]
Word = Literal["iso16281", "iso16281_cylindrical"]
Profile = core.LogarithmicProfile | core.SampledProfile | Word | None

SAMPLES = 401
"""Points of a profile: some 3 for each cell."""
PARABOLA = 9
"""Points of a crown, between which cubics are the parabola."""
TAPERED = 0.00045
"""Amplitude of the profile of tapered rollers over their diameter.

Nguyen-Schäfer, *Computational Tapered and Cylinder Roller Bearings* (Springer 2019), eq. (1.8), as
that of ISO/TS 16281:2008, whose text was not seen.
"""


def _check_angle(angle: float) -> None:
    """Raise an error unless a contact angle is one of a radial bearing."""
    above("contact_angle", angle)
    if angle > math.pi / 4:
        raise ValueError(f"contact_angle must be at most π/4, in radians, got {angle!r}")


@dataclass(frozen=True, kw_only=True)
class _Rollers(RollerBearing, Solvable):
    """Bearing with one row of rollers on straight or crowned raceways."""

    length: float = field(metadata=in_unit("m"))
    """Effective length of a roller [m]."""
    profile: Profile = "iso16281"
    """Profile of the rollers; None for straight ones."""
    raceway_crown: tuple[float | None, float | None] = field(
        default=(None, None), metadata=in_unit("m")
    )
    """Radii of crowns of both raceways [m]; None for straight ones."""
    free_ends: bool = True
    """Whether the ends of the rollers are free surfaces."""

    def __post_init__(self) -> None:
        """Check the arguments."""
        super().__post_init__()
        above("length", self.length)
        self._check_pitch()
        words = (*get_args(Word), None)
        if not isinstance(self.profile, core.LogarithmicProfile | core.SampledProfile) and not (
            isinstance(self.profile, str | None) and self.profile in words
        ):
            choices = ", ".join(f'"{word}"' for word in words[:-1])
            raise ValueError(f"profile must be a profile, {choices} or None, got {self.profile!r}")
        for radius in self.raceway_crown:
            if radius is not None:
                above("raceway_crown", radius, -math.inf)
            if radius == 0:
                raise ValueError("raceway_crown must not be 0: None makes a raceway straight")
            if radius is not None and abs(radius) < self.length:
                raise ValueError(
                    f"raceway_crown must be at least the length of a roller, "
                    f"{millimetres(self.length)}, got {millimetres(radius)}"
                )
        check_flag("free_ends", self.free_ends)
        self._check_room()
        self.drop("inner")  # its profile covers it

    @abstractmethod
    def _check_pitch(self) -> None:
        """Raise an error unless pitch and angles are in range."""

    @property
    def contact_angles(self) -> tuple[float, float]:
        """Contact angles of inner and outer ring [rad]."""
        return 0.0, 0.0

    @property
    def lever(self) -> float:
        """Lever of the force of a contact about the x and y axes [m]."""
        return 0.0

    def _profile(self) -> core.LogarithmicProfile | core.SampledProfile:
        """Return the profile of a roller."""
        half = self.length / 2
        if self.profile is None:
            return core.SampledProfile([-half, half], [0.0, 0.0])
        if isinstance(self.profile, str):
            return self._standard_profile(self.profile)
        return self.profile

    def _standard_profile(self, word: Word) -> core.LogarithmicProfile:
        """Return a profile of ISO/TS 16281."""
        return core.LogarithmicProfile.iso16281(self.diameter, self.length)

    def _crown(self, ring: Ring, x: Array) -> Array:
        """Return the drop of the crown of a raceway at x along it [m].

        That of a concave one is such that it and the profile together drop by 0 at least.
        """
        radius = self.raceway_crown[RINGS.index(ring)]
        if radius is None:
            return np.zeros_like(x)
        along = np.linspace(-0.5, 0.5, SAMPLES) * self.length
        lowest = float((self._profile().drop_at(along) + along**2 / (2 * radius)).min())
        return x**2 / (2 * radius) - min(0.0, lowest)

    def _crown_points(self, ring: Ring) -> int:
        return 0 if self.raceway_crown[RINGS.index(ring)] is None else PARABOLA

    def _own_drop(self, x: Array) -> Array:
        profile = self._profile()
        drops = profile.drop_at(x)
        if not np.isfinite(drops).any():
            raise ValueError(
                f"profile must cover the roller of {millimetres(self.length)}, got {profile}"
            )
        return drops

    def motion(self, angles: Array) -> Rollers:
        """Return how rollers at these angles move with the inner ring."""
        return Rollers(self, angles)


@dataclass(frozen=True, kw_only=True)
class CylindricalRoller(_Rollers):
    """Bearing with one row of cylindrical rollers, or of needles.

    Either the pitch diameter is given, and perhaps the clearance; or the diameters of both
    raceways, from which both follow. A locked ring has no axial force: ribs are not modelled.

    Parameters
    ----------
    count : int
        Number of rollers.
    diameter : float
        Diameter D of a roller [m].
    length : float
        Effective length L_we of a roller [m]; the roller ends there.
    pitch_diameter : float, optional
        Diameter d_m of the circle of the rollers' centres [m].
    raceway_diameters : tuple of float, optional
        Diameters of inner and outer raceway [m], in place of pitch diameter and clearance.
    clearance : float, optional
        Diametral clearance [m], below 0 with preload; 0 by default.
    profile : LogarithmicProfile, SampledProfile, str or None, optional
        Profile of the rollers: "iso16281", that of ISO/TS 16281, which for long rollers is
        that of needles; any of nacre's; None for straight ones.
    raceway_crown : tuple of float or None, optional
        Radii of crowns of inner and outer raceway along the axis [m], below 0 for concave ones;
        None for straight raceways.
    free_ends : bool, optional
        Whether the ends of the rollers are free surfaces, as they are in reality; False treats the
        rollers as half-spaces that continue beyond them.
    element, inner, outer : HalfSpace or Elastic, optional
        Bodies of rollers and rings; steel with E = 210 GPa by default.
    capacity : float, optional
        Dynamic load rating C_r [N]; by default that of ISO 281.
    rating_factor : float, optional
        Factor b_m of ISO 281.
    density : float, optional
        Density of the rollers [kg/m³].

    Raises
    ------
    ValueError
        If an argument is out of range, or the rings do not hold the rollers.

    Examples
    --------
    >>> from nacre.bearing import CylindricalRoller
    >>> bearing = CylindricalRoller(
    ...     count=14, diameter=10e-3, length=9.6e-3, raceway_diameters=(55e-3, 75.041e-3)
    ... )
    >>> round(bearing.pitch * 1e3, 4), round(bearing.play * 1e6, 6)
    (65.0205, 41.0)
    """

    raceway_diameters: tuple[float, float] | None = field(default=None, metadata=in_unit("m"))
    """Diameters of inner and outer raceway [m]; None where the pitch diameter is given."""

    kind: ClassVar[str] = "cylindrical_roller"

    def _check_pitch(self) -> None:
        if self.raceway_diameters is None:
            if vars(self)["pitch_diameter"] is None:
                raise ValueError("pitch_diameter or raceway_diameters must be given, got neither")
            above("pitch_diameter", self.pitch_diameter)
        else:
            both = self.raceway_diameters
            for value in both:
                above("raceway_diameters", value)
            if both[0] >= both[1]:
                raise ValueError(
                    "raceway_diameters must be (inner, outer), the inner one the smaller, "
                    f"got {both!r}"
                )
            for name, follows in (("pitch_diameter", self.pitch), ("clearance", self.play)):
                self._give_way(name)
                if vars(self)[name] not in (None, follows):
                    raise ValueError(f"{name} must not be given beside raceway_diameters")

    @property
    def pitch(self) -> float:
        """Pitch diameter [m]."""
        return super().pitch if self.raceway_diameters is None else sum(self.raceway_diameters) / 2

    @property
    def play(self) -> float:
        """Diametral clearance [m], below 0 with preload."""
        if self.raceway_diameters is None:
            return super().play
        inner, outer = self.raceway_diameters
        return outer - inner - 2 * self.diameter

    @property
    def raceways(self) -> tuple[float, float]:
        """Radii of inner and outer raceway in the direction of rolling [m]."""
        if self.raceway_diameters is None:
            return super().raceways
        return self.raceway_diameters[0] / 2, self.raceway_diameters[1] / 2

    @property
    def mass(self) -> float:
        """Mass of a roller [kg], without its profile."""
        return self.density * math.pi / 4 * self.diameter**2 * self.length


@dataclass(frozen=True, kw_only=True)
class TaperedRoller(_Rollers):
    """Bearing with one row of tapered rollers. Positive z presses the inner ring into contact.

    Rollers and both raceways are cones about one apex on the bearing's axis, so that they roll
    without slip; the angle of the rollers and the inner contact angle follow. The big ends of the
    rollers rest on a rigid rib of the inner ring without friction; its force is along the axes of
    the rollers.

    Parameters
    ----------
    count : int
        Number of rollers.
    diameter : float
        Diameter D of a roller in the middle of its length [m].
    length : float
        Effective length L_we of a roller along the line of contact [m]; the roller ends there.
    pitch_diameter : float
        Diameter d_m of the circle of the middles of the rollers [m].
    contact_angle : float
        Contact angle α of the outer ring [rad], half of the angle of its cone, above 0 and at most
        π/4: the bearing is a radial one.
    clearance : float, optional
        Diametral clearance s [m], below 0 with preload; 0 by default. The axial play is s/(2 tan
        α) to either side.
    profile : LogarithmicProfile, SampledProfile, str or None, optional
        Profile of the rollers, from the big end at x < 0 to the small one: "iso16281", that of
        ISO/TS 16281 for tapered rollers, ``0.00045 D ln(1/(1 − (2x/L)²))``; "iso16281_cylindrical",
        that for cylindrical ones; any of nacre's; None for straight ones.
    raceway_crown : tuple of float or None, optional
        Radii of crowns of inner and outer raceway along the contact [m], below 0 for concave ones;
        None for straight raceways.
    free_ends : bool, optional
        Whether the ends of the rollers are free surfaces, as they are in reality; False treats the
        rollers as half-spaces that continue beyond them.
    element, inner, outer : HalfSpace or Elastic, optional
        Bodies of rollers and rings; steel with E = 210 GPa by default.
    capacity : float, optional
        Dynamic load rating C_r [N]; by default that of ISO 281.
    rating_factor : float, optional
        Factor b_m of ISO 281.
    density : float, optional
        Density of the rollers [kg/m³].

    Raises
    ------
    ValueError
        If an argument is out of range, or the rings do not hold the rollers.

    Notes
    -----
    The half angle β of a roller follows from ``tan β = (D/d_m) sin(α − β)``, and the apex is
    ``D/(2 sin β)`` from the middle of a contact; derived here.

    The profile's 0.00045 D was not compared with the text of ISO/TS 16281:2008. A book and the
    first version of a program have it for tapered rollers of any length; a later version of the
    program has it elsewhere. With ``profile="iso16281_cylindrical"``, 0.00035 D of short rollers
    and 0.0005 D of long ones, lives are some 10 to 20 % longer.

    Examples
    --------
    >>> import math
    >>> from nacre.bearing import TaperedRoller
    >>> bearing = TaperedRoller(
    ...     count=17, diameter=8e-3, length=11e-3, pitch_diameter=48e-3, contact_angle=0.25
    ... )
    >>> round(math.degrees(2 * bearing.roller_angle), 2)
    4.06
    >>> solution = bearing.solve(force=(0.0, 0.0, 5000.0), model="iso16281")
    >>> round(float(solution.loads[0, 0] * 17 * math.sin(0.25)))
    5000
    """

    contact_angle: float = field(metadata=in_unit("rad"))
    """Contact angle of the outer ring [rad]."""

    kind: ClassVar[str] = "tapered_roller"

    def _check_pitch(self) -> None:
        self._check_given_pitch()
        _check_angle(self.contact_angle)
        if self.length >= 2 * self.apex:
            raise ValueError(
                f"length must be below {millimetres(2 * self.apex)}, where the roller ends at its "
                f"apex, got {millimetres(self.length)}"
            )

    def _standard_profile(self, word: Word) -> core.LogarithmicProfile:
        """Return a profile of ISO/TS 16281: that of tapered rollers, or of cylindrical ones."""
        if word == "iso16281":
            return core.LogarithmicProfile(TAPERED * self.diameter, self.length)
        return super()._standard_profile(word)

    @property
    def nominal_angle(self) -> float:
        """Nominal contact angle α [rad], that of the outer ring."""
        return self.contact_angle

    @cached_property
    def roller_angle(self) -> float:
        """Half of the angle β of the cone of a roller [rad]."""
        share, low, high = self.diameter / self.pitch, 0.0, self.contact_angle
        for _ in range(60):
            middle = (low + high) / 2
            below = math.tan(middle) < share * math.sin(self.contact_angle - middle)
            low, high = (middle, high) if below else (low, middle)
        return high

    @property
    def contact_angles(self) -> tuple[float, float]:
        """Contact angles of inner and outer ring [rad]."""
        return self.contact_angle - 2 * self.roller_angle, self.contact_angle

    @property
    def apex(self) -> float:
        """Distance of the apex of rollers and raceways from the middle of a contact [m]."""
        return self.diameter / (2 * math.sin(self.roller_angle))

    @property
    def lever(self) -> float:
        """Lever of the force of a contact about the x and y axes [m].

        The forces of both contacts and of the rib meet on the axis of the roller (derived here).
        """
        own = self.diameter / 2 * math.sin(self.roller_angle)
        return self.pitch / 2 * math.sin(self.contact_angle) + own

    @property
    def radius(self) -> float:
        """Radius of a roller in the middle of a contact, in the direction of rolling [m]."""
        return self.diameter / 2 / math.cos(self.roller_angle)

    @property
    def tracks(self) -> tuple[float, float]:
        """Radii of the tracks of both rings about the bearing's axis [m]."""
        across = self.diameter / 2 * math.cos(self.contact_angle - self.roller_angle)
        return self.pitch / 2 - across, self.pitch / 2 + across

    @property
    def raceways(self) -> tuple[float, float]:
        """Radii of inner and outer raceway in the direction of rolling [m]."""
        inner, outer = (
            track / math.cos(angle)
            for track, angle in zip(self.tracks, self.contact_angles, strict=True)
        )
        return inner, outer

    @property
    def outward(self) -> tuple[tuple[float, float], float]:
        """Parts of the centrifugal force on approach and slope, and on the ring along z."""
        beta = self.roller_angle
        normal = math.cos(self.contact_angle - beta) / math.cos(beta)
        own = normal, normal * self.diameter / 2 * math.sin(beta)
        return own, -normal * math.sin(self.contact_angle)

    def curvature(self, ring: Ring, x: Array | float = 0.0) -> Array:
        """Return the curvature of the gap in the direction of rolling at x along the roller [1/m].

        Parameters
        ----------
        ring : {"inner", "outer"}
            Ring of the raceway.
        x : array_like, optional
            Places along the element from its middle [m].

        Returns
        -------
        numpy.ndarray
            Curvatures: both radii are proportional to the distance from the apex.
        """
        return super().curvature(ring) / (1 - core.real_array("x", x) / self.apex)

    @property
    def mass(self) -> float:
        """Mass of a roller [kg], without its profile."""
        long = self.length * math.cos(self.roller_angle)
        share = 1 + (self.length / self.apex) ** 2 / 12
        return self.density * math.pi / 4 * self.diameter**2 * long * share


def _rise(radius: float, x: Array) -> Array:
    """Return the height of a circle at x above its lowest place [m]."""
    return x**2 / (radius + np.sqrt(radius**2 - x**2))


@dataclass(frozen=True, kw_only=True)
class SphericalRoller(RollerBearing, CurvedRaceways, Solvable):
    """Bearing with barrels on an outer raceway that is a sphere, which aligns itself.

    The outer raceway is a sphere about the bearing's centre, of the radius ``d_m/(2 cos α) + D/2``.
    Without friction its forces pass through the centre, and the rollers follow the inner ring: a
    tilt changes no load, and takes no moment. Forces and displacements are along the axes of the
    inner ring, which turn with it.

    Parameters
    ----------
    count : int
        Number of rollers in a row.
    diameter : float
        Largest diameter D of a roller [m].
    length : float
        Effective length L_we of a roller [m]; the roller ends there.
    pitch_diameter : float
        Diameter d_m of the circles of the middles of the rollers [m].
    contact_angle : float
        Contact angle α of both rows [rad], at most π/4; 0 of one row alone.
    profile_radius : float
        Radius of the profile of the rollers [m], below those of both raceways.
    groove_radius : float, optional
        Radius of the inner raceway along the roller [m]; by default that of the outer one.
    rows : int, optional
        Number of rows, 1 or 2. Positive z presses the inner ring into the first one. Elements are
        numbered row by row, and those of both rows stand at the same angles.
    clearance : float, optional
        Diametral clearance [m], below 0 with preload; 0 by default.
    free_ends : bool, optional
        Whether the ends of the rollers are free surfaces, as they are in reality; False treats the
        rollers as half-spaces that continue beyond them.
    element, inner, outer : HalfSpace or Elastic, optional
        Bodies of rollers and rings; steel with E = 210 GPa by default.
    capacity : float, optional
        Dynamic load rating C_r [N]; by default that of ISO 281.
    rating_factor : float, optional
        Factor b_m of ISO 281.
    density : float, optional
        Density of the rollers [kg/m³].

    Raises
    ------
    ValueError
        If an argument is out of range, or the rings do not hold the rollers.

    Examples
    --------
    >>> from nacre.bearing import SphericalRoller
    >>> bearing = SphericalRoller(
    ...     count=19,
    ...     diameter=12e-3,
    ...     length=11e-3,
    ...     pitch_diameter=82e-3,
    ...     contact_angle=0.17,
    ...     profile_radius=46.5e-3,
    ... )
    >>> round(bearing.raceways[1] * 1e3, 3)
    47.6
    >>> solution = bearing.solve(force=(20e3, 0.0, 2e3), tilt=(None, 0.02), model="iso16281")
    >>> solution.loads.shape, solution.moment
    ((38, 2), (0.0, 0.0))
    """

    length: float = field(metadata=in_unit("m"))
    """Effective length of a roller [m]."""
    contact_angle: float = field(metadata=in_unit("rad"))
    """Contact angle of both rows [rad]."""
    profile_radius: float = field(metadata=in_unit("m"))
    """Radius of the profile of the rollers [m]."""
    groove_radius: float | None = field(default=None, metadata=in_unit("m"))
    """Radius of the inner raceway along the roller [m]; None: that of the outer one."""
    rows: int = 2
    """Number of rows."""
    free_ends: bool = True
    """Whether the ends of the rollers are free surfaces."""
    rating_factor: float = 1.15
    """Factor b_m of ISO 281 for the rating."""

    kind: ClassVar[str] = "spherical_roller"
    aligns: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Check the arguments."""
        super().__post_init__()
        above("length", self.length)
        self._check_given_pitch()
        if self.rows not in (1, 2):
            raise ValueError(f"rows must be 1 or 2, got {self.rows!r}")
        if self.contact_angle != 0:
            _check_angle(self.contact_angle)
        check_flag("free_ends", self.free_ends)
        above("profile_radius", self.profile_radius)
        if self.groove_radius is not None:
            above("groove_radius", self.groove_radius)
        least = min(self.grooves)
        if self.profile_radius >= least:
            raise ValueError(
                f"profile_radius must be below those of the raceways, {millimetres(least)}, "
                f"got {millimetres(self.profile_radius)}"
            )
        half = self.length / 2
        if half >= self.profile_radius or self._own_radius(np.array(half)) <= 0:
            raise ValueError(
                f"length must be below that at which the barrel is pointed, "
                f"got {millimetres(self.length)}"
            )
        self._check_room()
        if self.rows == 2:
            sin, cos = math.sin(self.contact_angle), math.cos(self.contact_angle)
            end = float(self._own_radius(np.array(half)))
            between = self.pitch * sin / cos - self.length * cos - 2 * end * sin
            if between < 0:
                raise ValueError(
                    f"contact_angle must be larger for two rows, whose rollers overlap by "
                    f"{millimetres(-between)}; got {self.contact_angle!r}"
                )

    @property
    def nominal_angle(self) -> float:
        """Nominal contact angle α [rad]."""
        return self.contact_angle

    @property
    def grooves(self) -> tuple[float, float]:
        """Radii of the raceways along the roller [m]."""
        outer = self.raceways[1]
        return self.groove_radius or outer, outer

    @property
    def own_radii(self) -> tuple[float, float]:
        """Radii of a roller in its middle, along x and y [m]."""
        return self.profile_radius, self.radius

    @property
    def radii(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Signed radii of the raceways of inner and outer ring, along x and y [m]."""
        inner, outer = self.raceways
        return (-self.grooves[0], inner), (-self.grooves[1], -outer)

    @property
    def outward(self) -> tuple[tuple[float, float], float]:
        """Parts of the centrifugal force: on an element's coordinates, and on the ring along z."""
        sin, cos = math.sin(self.contact_angle), math.cos(self.contact_angle)
        return (cos**2, cos * sin), -cos * sin if self.rows == 1 else 0.0

    @property
    def mass(self) -> float:
        """Mass of a roller [kg]."""
        half, radius = self.length / 2, self.profile_radius
        away = radius - self.diameter / 2
        under = half * math.sqrt(radius**2 - half**2) + radius**2 * math.asin(half / radius)
        squares = 2 * half * (away**2 + radius**2 - half**2 / 3) - 2 * away * under
        return self.density * math.pi * squares

    def _own_radius(self, x: Array) -> Array:
        """Return the radius of a roller at x along it [m]."""
        return self.diameter / 2 - _rise(self.profile_radius, x)

    def curvature(self, ring: Ring, x: Array | float = 0.0) -> Array:
        """Return the curvature of the gap in the direction of rolling at x along the roller [1/m].

        Parameters
        ----------
        ring : {"inner", "outer"}
            Ring of the raceway.
        x : array_like, optional
            Places along the element from its middle [m].

        Returns
        -------
        numpy.ndarray
            Curvatures, with the radius of the raceway in its middle.
        """
        raceway = super().curvature(ring) - 1 / self.radius
        return 1 / self._own_radius(core.real_array("x", x)) + raceway

    def _profile(self) -> core.SampledProfile:
        x = np.linspace(-0.5, 0.5, SAMPLES) * self.length
        return core.SampledProfile(x, self._own_drop(x))

    def _own_drop(self, x: Array) -> Array:
        return _rise(self.profile_radius, x)

    def _crown(self, ring: Ring, x: Array) -> Array:
        return -_rise(self.grooves[RINGS.index(ring)], x)

    def _crown_points(self, ring: Ring) -> int:
        return SAMPLES

    def motion(self, angles: Array) -> Barrels:
        """Return how barrels at these angles move with the inner ring."""
        return Barrels(self, angles)

    def _loaded_length(self, ring: Ring, line: float) -> float:
        """Return how much of a barrel a contact needs whose largest load per length is this [m]."""
        # In the middle of an ellipse the load per length is 3 W/(4 a), and a = c W^(1/3).
        unit = self.ellipse(ring, 1.0).semi_axes[0]
        return min(self.length, 2 * WIDER * unit * math.sqrt(4 * unit * line / 3))
