"""Modified rating life of ISO 281: reliability, lubrication, contamination, fatigue load limit.

``L_nm = a_1 a_ISO L_10``, ISO 281:2007, formula (23). The standard was read in its Russian
adoption, GOST 18855-2013; exponents that are not legible there are those of programs that quote
the standard, and a_ISO is continuous with them. The contamination factor by filters and classes of
cleanliness, annex A of the standard, is left out.
"""

from __future__ import annotations

import dataclasses
import math
from collections import deque
from typing import Literal, NamedTuple

import numpy as np

import nacre._core as core
from nacre._tools.notices import heard, warn
from nacre.bearing.geometry import LARGEST, RINGS, Bearing, Ring, above
from nacre.bearing.iso import is_thrust
from nacre.bearing.kinds import CurvedRaceways, RollerBearing, checked_bearing
from nacre.bearing.plausible import doubts_on
from nacre.bearing.static import STEEL, element_load, static_rating, total_load
from nacre.contact import Contact
from nacre.results.verdict import SINGULAR

RELIABILITY = {
    **{0.9: 1.0, 0.95: 0.64, 0.96: 0.55, 0.97: 0.47, 0.98: 0.37, 0.99: 0.25, 0.992: 0.22},
    **{0.994: 0.19, 0.996: 0.16, 0.998: 0.12, 0.999: 0.093},
    **{0.9992: 0.087, 0.9994: 0.080, 0.9995: 0.077},
}
"""Factors a_1 by reliability: ISO 281:2007, table 12."""
SLOPE = 1.5
"""Slope of the Weibull distribution of that table, ``a_1 = 0.05 + 0.95 (ln S/ln 0.9)^(1/1.5)``."""
SMALL = {
    "extreme cleanliness": (1.0, 1.0),
    "high cleanliness": (0.6, 0.8),
    "normal cleanliness": (0.5, 0.6),
    "slight contamination": (0.3, 0.5),
    "typical contamination": (0.1, 0.3),
    "severe contamination": (0.0, 0.1),
    "very severe contamination": (0.0, 0.0),
}
"""Ranges of the contamination factor e_C below `LARGE`: ISO 281:2007, table 13."""
LARGE_RANGES = SMALL | {
    "high cleanliness": (0.8, 0.9),
    "normal cleanliness": (0.6, 0.8),
    "slight contamination": (0.4, 0.6),
    "typical contamination": (0.2, 0.4),
}
"""The same of larger bearings."""
LARGE = 0.1
"""Pitch diameter [m] from which bearings are the larger ones of table 13 and of annex B."""
SLOW = 1000.0
"""Revolutions per minute below which the reference viscosity has another formula."""
LEAST_RATIO, MOST_RATIO = 0.1, 4.0
"""Viscosity ratios below which a_ISO is not defined, and above which it does not rise."""
MOST_FACTOR, MOST_ADDITIVES = 50.0, 3.0
"""Largest a_ISO; and largest one that additives give: ISO 281:2007, 9.3.3.4 to 9.3.3.7, 9.3.3.3."""
CLEAN = 0.2
"""Least e_C at which additives may be counted: ISO 281:2007, 9.3.3.3."""
MOST_VISCOUS = 0.01
"""Kinematic viscosity above that of any oil in a bearing [m²/s]: ISO VG 3200 has 3.2e-3."""
LIMIT = 1.5e9
"""Pressure at the fatigue load limit [Pa]: ISO 281:2007, 9.3 and annex B."""
CELLS = (120, 48)
"""Cells of a profiled contact: its peak pressure is right to 1e-3."""
PRECISION = 1e-4
"""Relative error at which the pressure counts as `LIMIT`, a tenth of that of the cells."""

STEPS = 20
"""Solves for a load after which a contact counts as one without a limit; five are usual."""
KEPT: deque[tuple[RollerBearing, float | None]] = deque(maxlen=64)
"""Bearings of bare steel, and the loads at which their contacts have `LIMIT`."""

Element = Literal["ball", "roller"]


class _Factor(NamedTuple):
    """Numbers of a_ISO: ``0.1 [1 − (c − A/κ^B)^m (e_C C_u/P/t)^n]^(−k)``."""

    c: float
    m: float
    n: float
    k: float
    ranges: tuple[tuple[float, float, float], ...]
    """Upper ends of the ranges of κ, with A and B."""
    thrust: float


FACTORS = {
    "ball": _Factor(
        *(2.5671, 0.83, 1 / 3, 9.3),
        ((0.4, 2.2649, 0.054381), (1.0, 1.9987, 0.19087), (math.inf, 1.9987, 0.071739)),
        thrust=3.0,
    ),
    "roller": _Factor(
        *(1.5859, 1.0, 0.4, 9.185),
        ((0.4, 1.3993, 0.054381), (1.0, 1.2348, 0.19087), (math.inf, 1.2348, 0.071739)),
        thrust=2.5,
    ),
}
"""ISO 281:2007, formulae (31) to (42)."""


def reliability_factor(reliability: float) -> float:
    """Life modification factor a_1 for reliability: ISO 281:2007, table 12.

    Parameters
    ----------
    reliability : float
        Share S of bearings that reach the life, from 0.9 to 0.9995.

    Returns
    -------
    float
        Factor: 1 at 90 %.

    Raises
    ------
    ValueError
        If the reliability is not in the range of the table.

    Notes
    -----
    The table is that of a Weibull distribution with the slope 1.5 and a life that all reach, 0.05
    L_10, to 6e-3: the factor is linear in ``(ln S/ln 0.9)^(1/1.5)``. Between the rows of the table
    nacre takes that line through both of them (derived), so that tabulated factors are exact.

    Examples
    --------
    >>> from nacre.bearing import reliability_factor
    >>> reliability_factor(0.95), round(reliability_factor(0.93), 3)
    (0.64, 0.792)
    """
    value = core.real("reliability", reliability)
    for known, factor in RELIABILITY.items():
        if math.isclose(known, value, rel_tol=1e-9):
            return factor
    least, most = min(RELIABILITY), max(RELIABILITY)
    if not least < value < most:
        raise ValueError(
            f"reliability must be a share from {least:g} to {most:g}, got {reliability!r}"
        )
    logarithms, factors = np.log(list(RELIABILITY)), list(RELIABILITY.values())
    lives = (logarithms / logarithms[0]) ** (1 / SLOPE)
    life = (math.log(value) / logarithms[0]) ** (1 / SLOPE)
    return float(np.interp(life, lives[::-1], factors[::-1]))


def reference_viscosity(speed: float, pitch_diameter: float) -> float:
    """Kinematic viscosity ν_1 for adequate lubrication [m²/s]: ISO 281:2007, (28) and (29).

    ``45000 n^(−0.83) d_m^(−0.5)`` mm²/s below 1000 revolutions per minute and
    ``4500 n^(−0.5) d_m^(−0.5)`` above (1/min, mm); at 1000 they differ by 2 %.

    Parameters
    ----------
    speed : float
        Angular velocity [rad/s].
    pitch_diameter : float
        Pitch diameter d_m [m].

    Returns
    -------
    float
        Viscosity [m²/s].

    Examples
    --------
    >>> import math
    >>> from nacre.bearing import reference_viscosity
    >>> round(reference_viscosity(3000 * math.pi / 30, 72.5e-3) * 1e6, 2)
    9.65
    """
    above("speed", abs(core.real("speed", speed)), unit="rad/s")
    return _reference_viscosity(float(speed), _usual_pitch(pitch_diameter))


def _reference_viscosity(speed: float, pitch_diameter: float) -> float:
    """Return what `reference_viscosity` documents, of checked numbers."""
    per_minute = abs(speed) * 30 / math.pi
    factor, power = (45000.0, -0.83) if per_minute < SLOW else (4500.0, -0.5)
    return float(factor * per_minute**power / math.sqrt(pitch_diameter * 1e3) * 1e-6)


def _usual_pitch(pitch_diameter: float) -> float:
    """Return a pitch diameter that is typed alone, and warn where it may be in millimetres."""
    pitch, most = above("pitch_diameter", pitch_diameter), LARGEST["pitch_diameter"]
    if pitch > most:
        raise ValueError(
            f"pitch_diameter must be at most {most:g} m, got {pitch_diameter!r} m: is it in mm?"
        )
    for text in doubts_on("pitch_diameter", pitch):
        warn(text)
    return pitch


def contamination_range(contamination: str, pitch_diameter: float) -> tuple[float, float]:
    """Range of the contamination factor e_C of a degree of cleanliness: ISO 281:2007, table 13.

    Parameters
    ----------
    contamination : str
        "extreme cleanliness", "high cleanliness", "normal cleanliness", "slight contamination",
        "typical contamination", "severe contamination" or "very severe contamination".
    pitch_diameter : float
        Pitch diameter d_m [m]: from 100 mm on the factors are larger.

    Returns
    -------
    tuple of float
        Lower and upper end.

    Raises
    ------
    ValueError
        If the table has no such degree.

    Examples
    --------
    >>> from nacre.bearing import contamination_range
    >>> contamination_range("normal cleanliness", 65e-3)
    (0.5, 0.6)
    """
    return _contamination_range(contamination, _usual_pitch(pitch_diameter))


def _contamination_range(contamination: str, pitch_diameter: float) -> tuple[float, float]:
    """Return what `contamination_range` documents, of a checked pitch diameter."""
    table = SMALL if pitch_diameter < LARGE else LARGE_RANGES
    if not isinstance(contamination, str) or contamination not in table:
        names = ", ".join(f'"{name}"' for name in table)
        raise ValueError(f"contamination must be one of {names}, got {contamination!r}")
    return table[contamination]


def life_modification_factor(
    viscosity_ratio: float, limit_ratio: float, element: Element, *, thrust: bool = False
) -> float:
    """Life modification factor a_ISO: ISO 281:2007, formulae (31) to (42).

    Parameters
    ----------
    viscosity_ratio : float
        Viscosity ratio κ, at least 0.1; above 4 it counts as 4.
    limit_ratio : float
        ``e_C C_u/P``: contamination factor times fatigue load limit over equivalent load.
    element : {"ball", "roller"}
        Rolling elements.
    thrust : bool, optional
        Whether the bearing is a thrust bearing.

    Returns
    -------
    float
        Factor, from 0.1 to 50.

    Raises
    ------
    ValueError
        If κ is below 0.1, where the factor is not defined, or `limit_ratio` below 0.

    Notes
    -----
    Balls, ``0.1 [1 − (2.5671 − A/κ^B)^0.83 (e_C C_u/P)^(1/3)]^(−9.3)``; rollers,
    ``0.1 [1 − (1.5859 − A/κ^B) (e_C C_u/P)^0.4]^(−9.185)``, whose A and B differ below κ = 0.4 and
    1. Where the bracket is not above 0, the factor is the largest, 50.

    Examples
    --------
    >>> from nacre.bearing import life_modification_factor
    >>> round(life_modification_factor(0.4, 5.0, "ball"), 1)
    16.9
    """
    kappa = above("viscosity_ratio", viscosity_ratio)
    ratio = core.real("limit_ratio", limit_ratio)
    if kappa < LEAST_RATIO:
        raise ValueError(
            f"viscosity_ratio must be at least {LEAST_RATIO:g}, below which ISO 281 has no a_ISO, "
            f"got {viscosity_ratio!r}"
        )
    if not ratio >= 0:
        raise ValueError(f"limit_ratio must be at least 0, got {limit_ratio!r}")
    if not isinstance(element, str) or element not in FACTORS:
        raise ValueError(f'element must be "ball" or "roller", got {element!r}')
    known = FACTORS[element]
    kappa = min(kappa, MOST_RATIO)
    a, b = next((a, b) for end, a, b in known.ranges if kappa < end)
    # At κ = 0.1 the difference is 0 but for the rounding of the standard's numbers.
    oil = max(0.0, known.c - a / kappa**b) ** known.m
    base = 1 - oil * (ratio / (known.thrust if thrust else 1.0)) ** known.n
    least = (0.1 / MOST_FACTOR) ** (1 / known.k)
    return float(0.1 * max(base, least) ** -known.k)


def fatigue_load_limit(bearing: Bearing) -> float:
    """Fatigue load limit C_u of ISO 281 [N]: the heaviest element then has 1500 MPa.

    Parameters
    ----------
    bearing : CylindricalRoller, DeepGrooveBall, or another
        Bearing; its bodies count as steel without layers.

    Returns
    -------
    float
        Limit [N], the axial one of thrust bearings.

    Notes
    -----
    ISO 281:2007, annex B: ``C_u = 0.2288 i Z Q_u cos α`` of balls, times ``(100/d_m)^0.5`` above
    100 mm, with the smaller Q_u of both rings, which follows from Hertz; ``0.2453 i Z Q_u cos α``
    of rollers, times ``(100/d_m)^0.3``, with Q_u of the contact of the profiled roller, which is
    solved here, untilted: the standard excludes Hertz's line contact. ``C_u = Z Q_u sin α`` of
    thrust bearings is derived. The pressure of straight rollers has no limit at their ends: they
    have the limit of `simple_fatigue_load_limit`, and a warning says so.

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall, fatigue_load_limit
    >>> bearing = DeepGrooveBall(count=9, diameter=9.525e-3, pitch_diameter=46e-3)  # 6206
    >>> round(fatigue_load_limit(bearing))
    587
    """
    bearing = checked_bearing(bearing)
    if isinstance(bearing, RollerBearing):
        load = _roller_load(bearing)
    else:
        load = element_load(bearing, LIMIT)
    if load is None:
        warn(
            "the fatigue load limit is C_0/8.2: the pressure of the contact has no limit at its "
            "ends, a profile gives it one"
        )
        return simple_fatigue_load_limit(bearing)
    return total_load(bearing, load, bearing.standards.limit_share) * _size_factor(bearing)


def simple_fatigue_load_limit(bearing: Bearing) -> float:
    """Fatigue load limit by the simple formulae of ISO 281: C_0/22 or C_0/8.2 [N].

    Parameters
    ----------
    bearing : CylindricalRoller, DeepGrooveBall, or another
        Bearing.

    Returns
    -------
    float
        Limit [N], C_0/22 of balls and C_0/8.2 of rollers; above a pitch diameter of 100 mm times
        ``(100/d_m)^0.5`` or ``(100/d_m)^0.3``: ISO 281:2007, annex B, (B.18) to (B.21).

    Examples
    --------
    >>> from nacre.bearing import CylindricalRoller, simple_fatigue_load_limit
    >>> bearing = CylindricalRoller(
    ...     count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3
    ... )
    >>> round(simple_fatigue_load_limit(bearing))
    6102
    """
    return static_rating(bearing) / bearing.standards.static_over_limit * _size_factor(bearing)


def _size_factor(bearing: Bearing) -> float:
    """Return the factor by which limits of larger bearings are smaller."""
    return float(min(1.0, LARGE / bearing.pitch) ** bearing.standards.size_power)


def _roller_load(bearing: RollerBearing) -> float | None:
    """Return the load at which a contact of a profiled roller has `LIMIT` [N], the smaller one.

    None where the pressure at its ends has no limit. That of an equal bearing is kept: profiles
    have no hash.
    """
    bare = dataclasses.replace(bearing, element=STEEL, inner=STEEL, outer=STEEL)
    for known, load in [*KEPT]:
        if known == bare:
            return load
    loads = [_contact_load(bare, ring) for ring in RINGS]
    least = min((load for load in loads if load is not None), default=None)
    KEPT.append((bare, least))
    return least


def _contact_load(bearing: RollerBearing, ring: Ring) -> float | None:
    """Return the load at which a contact of a roller has `LIMIT` [N], or None."""
    load, line = _hertz_load(bearing, ring)
    body, counterbody = bearing.bodies(ring)
    plan = Contact(body, bearing.grid(ring, line, CELLS), counterbody)
    power, contact, last = 2.0, None, None
    for _ in range(STEPS):
        with heard():
            contact = plan.solve(bearing.shape(ring), load=load, initial=contact)
        peak = contact.peak_pressure
        if not SINGULAR.isdisjoint(contact.report.warning_kinds):
            break
        if abs(LIMIT / peak - 1) < PRECISION:
            return load
        if last is not None and last[1] != peak:
            power = math.log(load / last[0]) / math.log(peak / last[1])
        last = load, peak
        load *= (LIMIT / peak) ** power
    return None


def _hertz_load(bearing: RollerBearing, ring: Ring) -> tuple[float, float]:
    """Return Hertz's load at `LIMIT` [N], and that per length in the middle [N/m]."""
    if isinstance(bearing, CurvedRaceways):
        unit = bearing.ellipse(ring, 1.0)
        load = (LIMIT / unit.peak_pressure) ** 3
        # Semi-axes are as the cube root of the load.
        return load, 0.75 * load / (unit.semi_axes[0] * math.cbrt(load))
    modulus, curvature = bearing.modulus[RINGS.index(ring)], float(bearing.curvature(ring))
    line = math.pi * LIMIT**2 / (modulus * curvature)
    return line * bearing.length, line


class Lubrication(NamedTuple):
    """Lubrication of a bearing, of which one of the first three numbers is known."""

    viscosity_ratio: float | None
    """Viscosity ratio κ."""
    kinematic_viscosity: float | None
    """Kinematic viscosity at the temperature of operation [m²/s]."""
    film_ratio: float | None
    """Ratio λ of film and roughness: ``κ = λ^1.3``, ISO 281:2007, (30)."""
    contamination: str | float | None
    """Degree of cleanliness of table 13, or e_C."""
    additives: bool
    """Whether extreme-pressure additives work."""

    @property
    def is_known(self) -> bool:
        """Whether there is a_ISO."""
        return any(value is not None for value in self[:4])

    def check(self, bearing: Bearing) -> None:
        """Raise an error unless κ follows from one argument, and e_C is given, in range."""
        names = self._fields[:3]
        ways = [name for name in names if getattr(self, name) is not None]
        if self.is_known and len(ways) != 1:
            known = " and ".join(ways) or "none"
            raise ValueError(f"exactly one of {', '.join(names)} must be given, got {known}")
        if ways and self.contamination is None:
            raise ValueError(f"contamination must be given beside {ways[0]}")
        for name in ways:
            above(name, getattr(self, name))
        if (self.kinematic_viscosity or 0.0) > MOST_VISCOUS:
            raise ValueError(
                f"kinematic_viscosity must be at most {MOST_VISCOUS:g} m²/s, got "
                f"{self.kinematic_viscosity!r} m²/s: is it in mm²/s, or a dynamic one in Pa s?"
            )
        if not isinstance(self.additives, bool):
            raise TypeError(f"additives must be True or False, got {self.additives!r}")
        if self.additives and not ways:
            raise ValueError(f"exactly one of {', '.join(names)} must be given beside additives")
        if ways:
            self.cleanliness(bearing)

    def kappa(self, bearing: Bearing, speed: float) -> float:
        """Return the viscosity ratio at a speed [rad/s]."""
        if self.viscosity_ratio is not None:
            return float(self.viscosity_ratio)
        if self.film_ratio is not None:
            return float(self.film_ratio**1.3)
        assert self.kinematic_viscosity is not None
        if speed == 0:
            raise ValueError(
                "speed must be given, in rad/s, in solve or life, for a kinematic_viscosity"
            )
        return float(self.kinematic_viscosity) / _reference_viscosity(speed, bearing.pitch)

    def doubts(self, kappa: float) -> list[str]:
        """Return what an unusual viscosity ratio, or the number from which it follows, asks."""
        if self.film_ratio is not None:
            return doubts_on("film_ratio", self.film_ratio)
        is_viscosity = self.kinematic_viscosity is not None
        name = "kinematic_viscosity over ν_1" if is_viscosity else "viscosity_ratio"
        return doubts_on(name, kappa)

    def cleanliness(self, bearing: Bearing) -> tuple[float, str]:
        """Return e_C, and where it is from in words: of a range it is the middle."""
        if isinstance(self.contamination, str):
            low, high = _contamination_range(self.contamination, bearing.pitch)
            middle = (low + high) / 2
            return middle, f"{self.contamination}, e_C {middle:.3g} of {low:g} to {high:g}"
        value = core.real("contamination", self.contamination)
        if not 0 <= value <= 1:
            raise ValueError(
                f"contamination must be a degree of cleanliness, or e_C from 0 to 1, "
                f"got {self.contamination!r}"
            )
        return value, f"e_C {value:g}"

    def factor(self, bearing: Bearing, speed: float, limit: float, load: float) -> float:
        """Return a_ISO under an equivalent load [N] with a fatigue load limit [N].

        With additives that work κ is 1 where it is below and e_C at least 0.2, and a_ISO at most 3:
        ISO 281:2007, 9.3.3.3; never less than without (derived).
        """
        contamination, _ = self.cleanliness(bearing)
        kappa = self.kappa(bearing, speed)
        element = bearing.standards.element
        ratio, thrust = contamination * limit / load if load > 0 else math.inf, is_thrust(bearing)
        if self.additives and kappa < 1 and contamination >= CLEAN:
            best = min(MOST_ADDITIVES, life_modification_factor(1.0, ratio, element, thrust=thrust))
            if kappa < LEAST_RATIO:
                return best
            return max(best, life_modification_factor(kappa, ratio, element, thrust=thrust))
        return life_modification_factor(kappa, ratio, element, thrust=thrust)
