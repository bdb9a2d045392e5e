"""Roller bearings by what a catalogue or a drawing says of them; radii of contacts follow."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre.bearing.bearings import Solvable
from nacre.bearing.geometry import RINGS, Ring, above, laminae_of, millimetres, pair

Array = npt.NDArray[np.float64]
Profile = core.LogarithmicProfile | core.SampledProfile | Literal["iso16281"] | None

SAMPLES = 401
"""Points of a profile to which the crown of a raceway is added; some 3 for each cell."""


@dataclass(frozen=True, kw_only=True)
class _Rollers(Solvable):
    """Bearing with one row of rollers on straight or crowned raceways."""

    length: float
    """Effective length of a roller [m]."""
    profile: Profile = "iso16281"
    """Profile of the rollers; None for straight ones."""
    raceway_crown: tuple[float | None, float | None] = (None, None)
    """Radii of crowns of both raceways [m]; None for straight ones."""
    free_ends: bool = True
    """Whether the ends of the rollers are free surfaces."""

    rolls: ClassVar[bool] = True
    leans: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Check the arguments."""
        super().__post_init__()
        above("length", self.length)
        self._check_pitch()
        if self.profile not in ("iso16281", None) and not isinstance(
            self.profile, core.LogarithmicProfile | core.SampledProfile
        ):
            raise ValueError(f'profile must be a profile, "iso16281" or None, got {self.profile!r}')
        object.__setattr__(self, "raceway_crown", pair("raceway_crown", self.raceway_crown))
        for radius in self.raceway_crown:
            if radius is not None:
                above("raceway_crown", radius, -math.inf)
            if radius == 0:
                raise ValueError("raceway_crown must not be 0: None makes a raceway straight")
        if not isinstance(self.free_ends, bool):
            raise TypeError(f"free_ends must be True or False, got {self.free_ends!r}")
        self._check_room()
        for ring in RINGS:
            self.drop(ring)

    @abstractmethod
    def _check_pitch(self) -> None:
        """Raise an error unless pitch and angles are in range."""

    @property
    def apex(self) -> float | None:
        """Distance of the apex of rollers and raceways from the middle of a roller [m]."""
        return None

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
            return core.LogarithmicProfile.iso16281(self.diameter, self.length)
        return self.profile

    def _profile_of(self, ring: Ring) -> core.LogarithmicProfile | core.SampledProfile:
        """Return the profile of a roller with the crown of a raceway."""
        profile, crown = self._profile(), self.raceway_crown[RINGS.index(ring)]
        if crown is None:
            return profile
        # Logarithmic profiles have no finite drop at their very ends.
        x = np.linspace(-0.5, 0.5, SAMPLES) * self.length * (1 - 1 / SAMPLES)
        drop = profile.drop_at(x) + x**2 / (2 * crown)
        if not np.isfinite(drop).all():
            raise ValueError("profile must be at least as long as the roller beside raceway_crown")
        return core.SampledProfile(x, drop - drop.min())

    def drop(self, ring: Ring, laminae: int = 40) -> Array:
        """Drop of profile and crown at the middles of laminae [m], infinite beyond the profile."""
        x = laminae_of(self.length, laminae)
        crown = self.raceway_crown[RINGS.index(ring)]
        profile = self._profile()
        found = np.asarray(profile.drop_at(x), dtype=np.float64)
        found = found if crown is None else found + x**2 / (2 * crown)
        if not np.isfinite(found).any():
            raise ValueError(
                f"profile must cover the roller of {millimetres(self.length)}, got {profile}"
            )
        return found - min(0.0, float(found.min()))

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
        return core.Roller(
            radius=self.radius,
            length=self.length,
            profile=self._profile_of(ring),
            counter_radius=inner if ring == "inner" else -outer,
            apex=self.apex,
        )


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
    profile : LogarithmicProfile, SampledProfile, {"iso16281"} or None, optional
        Profile of the rollers: that of ISO/TS 16281, which for long rollers is that of needles; any
        of nacre's; None for straight ones.
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

    raceway_diameters: tuple[float, float] | None = None
    """Diameters of inner and outer raceway [m]; None where the pitch diameter is given."""

    kind: ClassVar[str] = "cylindrical_roller"

    def _check_pitch(self) -> None:
        if self.raceway_diameters is None:
            if self.pitch_diameter is None:
                raise ValueError("pitch_diameter or raceway_diameters must be given, got neither")
            above("pitch_diameter", self.pitch_diameter)
        else:
            given = [n for n in ("pitch_diameter", "clearance") if getattr(self, n) is not None]
            if given:
                raise ValueError(f"{given[0]} must not be given beside raceway_diameters")
            both = pair("raceway_diameters", self.raceway_diameters)
            object.__setattr__(self, "raceway_diameters", both)
            for value in both:
                above("raceway_diameters", value)

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
    profile : LogarithmicProfile, SampledProfile, {"iso16281"} or None, optional
        Profile of the rollers, from the big end at x < 0 to the small one: that of ISO/TS 16281;
        any of nacre's; None for straight ones.
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

    Examples
    --------
    >>> import math
    >>> from nacre.bearing import TaperedRoller
    >>> bearing = TaperedRoller(
    ...     count=17, diameter=8e-3, length=11e-3, pitch_diameter=48e-3, contact_angle=0.25
    ... )
    >>> round(math.degrees(2 * bearing.roller_angle), 2)
    3.99
    >>> solution = bearing.solve(force=(0.0, 0.0, 5000.0), model="iso16281")
    >>> round(float(solution.loads[0, 0] * 17 * math.sin(0.25)))
    5000
    """

    contact_angle: float
    """Contact angle of the outer ring [rad]."""

    kind: ClassVar[str] = "tapered_roller"

    def _check_pitch(self) -> None:
        self._check_given_pitch()
        above("contact_angle", self.contact_angle)
        if self.contact_angle > math.pi / 4:
            raise ValueError(f"contact_angle must be at most π/4, got {self.contact_angle!r}")
        if self.length >= 2 * self.apex:
            raise ValueError(
                f"length must be below {millimetres(2 * self.apex)}, where the roller ends at its "
                f"apex, got {millimetres(self.length)}"
            )

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
        return super().curvature(ring) / (1 - np.asarray(x) / self.apex)

    @property
    def mass(self) -> float:
        """Mass of a roller [kg], without its profile."""
        long = self.length * math.cos(self.roller_angle)
        share = 1 + (self.length / self.apex) ** 2 / 12
        return self.density * math.pi / 4 * self.diameter**2 * long * share
