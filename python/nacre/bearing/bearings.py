"""Bearings by what a catalogue or a drawing says of them; radii of contacts follow."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre.bearing.geometry import (
    RINGS,
    Bearing,
    Ring,
    above,
    laminae_of,
    millimetres,
    pair,
)
from nacre.bearing.solution import BearingSolution
from nacre.bearing.solving import solved

Array = npt.NDArray[np.float64]
Along = Sequence[float | None]
Profile = core.LogarithmicProfile | core.SampledProfile | Literal["iso16281"] | None

SAMPLES = 401
"""Points of a profile to which the crown of a raceway is added; some 3 for each cell."""


class Solvable(Bearing):
    """A bearing that can be solved."""

    def solve(
        self,
        *,
        force: Along = (None, None, None),
        displacement: Along = (None, None, None),
        moment: Along = (None, None),
        tilt: Along = (None, None),
        rotation: float = 0.0,
        speed: float = 0.0,
        model: Literal["solved", "iso16281"] = "solved",
        cells: tuple[int, int] | None = None,
        tolerance: float = 1e-9,
        max_iterations: int = 50,
        threads: int | None = None,
        progress: Any = None,
        check: bool = True,
    ) -> BearingSolution:
        """Load, tilt and pressure of every element under a load or displacement of the inner ring.

        Each of the five degrees of freedom of the inner ring is loaded, prescribed, or neither: it
        is then locked at 0.

        Parameters
        ----------
        force : sequence of float or None, optional
            Forces ``(x, y, z)`` on the inner ring [N]; along an axis with a number the displacement
            is found.
        displacement : sequence of float or None, optional
            Displacements ``(x, y, z)`` of the inner ring against the outer one [m].
        moment : sequence of float or None, optional
            Moments about x and y on the inner ring [N m]; the tilt about an axis with a number is
            found.
        tilt : sequence of float or None, optional
            Slopes of the inner ring about x and y: tangents of its angles.
        rotation : float, optional
            Angle of element 0 from the x axis [rad].
        speed : float, optional
            Angular velocity of the elements about the bearing's axis, that of the cage [rad/s]; its
            centrifugal force presses them on the outer ring.
        model : {"solved", "iso16281"}, optional
            Contacts that nacre solves; or those of ISO/TS 16281: 40 laminae of rollers, Hertz's
            ellipses of balls.
        cells : tuple of int, optional
            Cells of a contact along the axis of the element and across it; by default (120, 48) of
            rollers, a multiple of 40 laminae, and (96, 96) of balls.
        tolerance : float, optional
            Largest mismatch of forces and moments, relative to those of the elements.
        max_iterations : int, optional
            Newton steps before it gives up.
        threads : int, optional
            Number of contacts that are solved side by side; by default as for `nacre.Contact`.
        progress : callable, optional
            Function that is called with the number of Newton steps and the mismatch after each;
            returning False stops, and gives the unfinished solution.
        check : bool, optional
            Whether to raise an error if the tolerance was not met.

        Returns
        -------
        BearingSolution
            Loads, tilts and pressures of all elements.

        Raises
        ------
        ValueError
            If an argument is out of range, a degree of freedom is both loaded and prescribed, or
            the bearing cannot carry a load along it.
        ConvergenceError
            If the tolerance was not met; the unfinished solution is its `solution`.

        Examples
        --------
        >>> from nacre.bearing import CylindricalRoller
        >>> bearing = CylindricalRoller(
        ...     count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3, clearance=41e-6
        ... )
        >>> standard = bearing.solve(force=(4450.0, 0.0, None), model="iso16281")
        >>> round(float(standard.loads.max()))
        1929
        """
        return solved(self, locals())


@dataclass(frozen=True, kw_only=True)
class CylindricalRoller(Solvable):
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

    length: float
    """Effective length of a roller [m]."""
    raceway_diameters: tuple[float, float] | None = None
    """Diameters of inner and outer raceway [m]; None where the pitch diameter is given."""
    profile: Profile = "iso16281"
    """Profile of the rollers; None for straight ones."""
    raceway_crown: tuple[float | None, float | None] = (None, None)
    """Radii of crowns of both raceways [m]; None for straight ones."""
    free_ends: bool = True
    """Whether the ends of the rollers are free surfaces."""

    kind: ClassVar[str] = "cylindrical_roller"
    rolls: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Check the arguments."""
        super().__post_init__()
        above("length", self.length)
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
            Shape for `nacre.solve`: x along the axis of the roller, y in the direction of rolling.
        """
        inner, outer = self.raceways
        radius = inner if ring == "inner" else -outer
        return core.Roller(
            radius=self.diameter / 2,
            length=self.length,
            profile=self._profile_of(ring),
            counter_radius=radius,
        )


@dataclass(frozen=True, kw_only=True)
class _Balls(Solvable):
    """Bearing with one row of balls in grooves."""

    osculation: tuple[float, float] = (0.52, 0.53)
    """Radii of the grooves of inner and outer ring over the diameter of a ball."""
    rating_factor: float = 1.3
    """Factor b_m of ISO 281 for the rating."""

    rolls: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Check the arguments."""
        super().__post_init__()
        if self.pitch_diameter is None:
            raise ValueError("pitch_diameter must be given")
        above("pitch_diameter", self.pitch_diameter)
        object.__setattr__(self, "osculation", pair("osculation", self.osculation))
        for value in self.osculation:
            above("osculation", value, 0.5)
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
    def mass(self) -> float:
        """Mass of a ball [kg]."""
        return self.density * math.pi / 6 * self.diameter**3

    @property
    def radii(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Signed radii of the raceways of inner and outer ring, along x and y [m]."""
        groove = [-f * self.diameter for f in self.osculation]
        inner, outer = self.raceways
        return (groove[0], inner), (groove[1], -outer)

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
        return core.Paraboloid(self.diameter / 2, self.diameter / 2, along, rolling)


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

    Parameters
    ----------
    count : int
        Number of balls.
    diameter : float
        Diameter D of a ball [m].
    pitch_diameter : float
        Diameter d_m of the circle of the balls' centres [m].
    contact_angle : float
        Contact angle without load [rad], above 0 and below π/2.
    osculation : tuple of float, optional
        Radii of the grooves of inner and outer ring over the diameter of a ball, above 0.5.
    element, inner, outer : HalfSpace or Elastic, optional
        Bodies of balls and rings; steel with E = 210 GPa by default.
    capacity : float, optional
        Dynamic load rating C_r [N]; by default that of ISO 281.
    rating_factor : float, optional
        Factor b_m of ISO 281.
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

    contact_angle: float
    """Contact angle without load [rad]."""

    kind: ClassVar[str] = "angular_contact_ball"

    def __post_init__(self) -> None:
        """Check the arguments."""
        above("contact_angle", self.contact_angle)
        if self.contact_angle >= math.pi / 2:
            raise ValueError(f"contact_angle must be below π/2, got {self.contact_angle!r}")
        if self.clearance is not None:
            raise ValueError(
                "clearance must not be given: the contact angle says where balls touch"
            )
        super().__post_init__()

    @property
    def nominal_angle(self) -> float:
        """Nominal contact angle α [rad]."""
        return self.contact_angle

    @property
    def free_angle(self) -> float:
        """Contact angle at which the balls touch both rings without load [rad]."""
        return self.contact_angle


KINDS: dict[str, type[Bearing]] = {
    made.kind: made for made in (CylindricalRoller, DeepGrooveBall, AngularContactBall)
}
"""Bearings by their names in case files."""
