"""Load rating of ISO 281 and reference rating life of ISO/TS 16281; Sjövall's load integrals.

The standards' formulae were taken from programs and books that quote ISO 281:2007, ISO/TR
1281-1:2021 and ISO/TS 16281:2008, now ISO 16281:2025, whose equations may have other numbers; and
compared with printed tables, ratings and lives. Inside these functions lengths are in mm and forces
in N, as in the standards.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre.bearing.contact_laws import LAMINAE
from nacre.bearing.geometry import RINGS, Bearing, above, laminae_of
from nacre.bearing.kinds import BallBearing, RollerBearing, checked_bearing

Array = npt.NDArray[np.float64]
Edge = Literal["standard", "pressure"] | None

REDUCTION = 0.83
"""Factor λν of ISO 281 for radial roller bearings."""
UNIT = 98.0665
"""Constant 0.089 A_1 of ISO/TR 1281-1:2021, formulae (15), (20), of balls (N, mm)."""
GROOVES = {False: ((0.52, 0.52), (0.52, 0.53)), True: ((0.535, 0.535), (0.54, 0.54))}
"""Grooves over the diameter of a ball for which the tables of ISO 281:2007 have their f_c, and the
widest for which it holds, by whether the bearing is a thrust one: tables 1, 2 and 4."""
LARGE_BALL = 25.4
"""Diameter of balls from which ISO 281 has another exponent [mm]."""


def load_integrals(epsilon: float, exponent: float) -> tuple[float, float]:
    """Sjövall's integrals of the load distribution of a bearing.

    ``J = (1/2π) ∫ (1 − (1 − cos ψ)/(2 ε))₊ⁿ [cos ψ] dψ``: a radial load is ``F_r = Z Q_max cos α
    J_r``, an axial one ``F_a = Z Q_max sin α J_a``. Harris, Rolling Bearing Analysis, ch. 7.

    Parameters
    ----------
    epsilon : float
        Load zone ε, above 0: 1/2 where half of the elements are loaded.
    exponent : float
        Exponent n of the deflection in the load: 3/2 of balls, 10/9 of rollers.

    Returns
    -------
    tuple of float
        J_r, with cos ψ, and J_a, without.

    Raises
    ------
    ValueError
        If an argument is not finite and above 0.

    Examples
    --------
    >>> from nacre.bearing import load_integrals
    >>> radial, axial = load_integrals(0.5, 10 / 9)
    >>> round(1 / radial, 3), round(axial / radial, 3)
    (4.085, 1.258)
    """
    epsilon, exponent = above("epsilon", epsilon), above("exponent", exponent)
    last = math.acos(max(-1.0, 1 - 2 * epsilon))
    # Tanh-sinh quadrature of the half zone: the integrand has a power at its end.
    t = np.linspace(-3.6, 3.6, 289)
    from_end = last / (1 + np.exp(math.pi * np.sinh(t)))
    weights = last * math.pi / 4 * np.cosh(t) / np.cosh(math.pi / 2 * np.sinh(t)) ** 2
    psi = last - from_end
    # cos ψ − cos ψ_end without cancellation.
    share = np.sin((last + psi) / 2) * np.sin(from_end / 2) / epsilon
    share = share + 1 - (1 - math.cos(last)) / (2 * epsilon)
    values = weights * np.maximum(share, 0.0) ** exponent * (t[1] - t[0])
    return float((values * np.cos(psi)).sum() / math.pi), float(values.sum() / math.pi)


def rating(bearing: Bearing) -> float:
    """Dynamic load rating of ISO 281 [N], of steel without layers.

    It is the radial rating C_r; of ball bearings with a contact angle above 45°, which are thrust
    bearings, the axial one C_a.

    Parameters
    ----------
    bearing : CylindricalRoller, DeepGrooveBall, or another
        Bearing of `nacre.bearing`; its `rating_factor` is b_m.

    Returns
    -------
    float
        Rating [N]: the load of a life of a million revolutions that 90 % reach.

    Notes
    -----
    Balls: ISO 281:2007, formulae (1) and (2), with f_c of ISO/TR 1281-1:2021, formula (15), which
    is that of table 2 to its last digit; C_a after formulae (18) to (20) of the latter, as a
    program quotes them. Rollers: ISO 281:2007, formula (13), with f_c of ISO/TR 1281-1:2021,
    formula (34), which is that of table 7 to 0.13 %. b_m: ISO 281:2007, tables 1 and 6.

    The tables hold for grooves up to 0.52 (inner ring) and 0.53 (outer ring) of the diameter, in
    thrust bearings 0.54; beyond, f_c falls with the grooves as its formula does (derived: from
    0.52/0.53 to 0.54/0.54 by 1.22 to 1.27, for which annex C of ISO 281:2007 prints 1.24).

    Examples
    --------
    >>> from nacre.bearing import CylindricalRoller, rating
    >>> bearing = CylindricalRoller(
    ...     count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3
    ... )
    >>> round(rating(bearing))
    48417
    """
    bearing = checked_bearing(bearing)
    gamma, diameter = bearing.gamma, bearing.diameter * 1e3
    ratio, cos = (1 - gamma) / (1 + gamma), math.cos(bearing.nominal_angle)
    if isinstance(bearing, RollerBearing):
        shape = 551.13373 * 0.377 * REDUCTION * gamma ** (2 / 9)
        shape *= (1 - gamma) ** (29 / 27) * (1 + gamma) ** -0.25
        shape *= (1 + (1.04 * ratio ** (143 / 108)) ** 4.5) ** (-2 / 9)
        size = (bearing.rows * bearing.length * 1e3 * cos) ** (7 / 9) * diameter ** (29 / 27)
        return float(bearing.rating_factor * shape * size * bearing.count**0.75)
    thrust = is_thrust(bearing)
    table, widest = GROOVES[thrust]
    wider = tuple(map(max, bearing.osculation, widest))
    shape = _shape(ratio, table, thrust) * _shape(ratio, wider, thrust)
    shape *= UNIT * gamma**0.3 * (1 - gamma) ** 1.39 / (1 + gamma) ** (1 / 3)
    shape /= _shape(ratio, widest, thrust)
    sin = math.sin(bearing.nominal_angle)
    shape *= 0.9 * (1 - sin / 3) * sin / cos if thrust else 0.41 * 0.95
    size = diameter**1.8 if diameter <= LARGE_BALL else 3.647 * diameter**1.4
    return float(bearing.rating_factor * shape * cos**0.7 * bearing.count ** (2 / 3) * size)


def is_thrust(bearing: Bearing) -> bool:
    """Return whether a bearing is a thrust bearing of ISO 281: of a contact angle above 45°."""
    return bool(bearing.nominal_angle > math.pi / 4)


def _conformity(grooves: tuple[float, ...]) -> float:
    """Return how much better the inner groove fits the ball than the outer one, in f_c."""
    inner, outer = grooves
    return float((inner / outer * (2 * outer - 1) / (2 * inner - 1)) ** 0.41)


def _shape(ratio: float, grooves: tuple[float, ...], thrust: bool) -> float:
    """Return the part of f_c in which the grooves of a ball bearing are."""
    inside = (1.0 if thrust else 1.04) * ratio**1.72 * _conformity(grooves)
    inner = grooves[0]
    return float((1 + inside ** (10 / 3)) ** -0.3 * (2 * inner / (2 * inner - 1)) ** 0.41)


class ReferenceLife(NamedTuple):
    """Reference rating life, and what it is made of."""

    l10r: float
    """Life L_10r in millions of revolutions; infinite without load."""
    equivalent_load: float
    """Dynamic equivalent reference load [N]."""
    capacities: tuple[float, float]
    """Ratings of the contacts of an element with inner and outer ring [N]."""
    load_power: float
    """Power of the loads of all contacts by which the life falls: 3 of balls, 4 of laminae."""


def capacities(bearing: Bearing, capacity: float) -> tuple[float, float]:
    """Return the ratings Q_ci and Q_ce of the contacts of an element [N].

    ISO/TS 16281:2008, equations (19) and (20) for balls, (21) and (22) for those of thrust
    bearings, (47) and (48) for rollers.
    """
    gamma, count = bearing.gamma, bearing.count
    ratio, cos = (1 - gamma) / (1 + gamma), math.cos(bearing.nominal_angle)
    if isinstance(bearing, RollerBearing):
        share = (1.038 * ratio ** (143 / 108)) ** 4.5
        base = capacity / (REDUCTION * count * cos * bearing.rows ** (7 / 9))
        factors = ((0.378, share), (0.364, 1 / share))
        power = 2 / 9
    else:
        assert isinstance(bearing, BallBearing)
        thrust = is_thrust(bearing)
        share = (1.0 if thrust else 1.044) * ratio**1.72 * _conformity(bearing.osculation)
        share **= 10 / 3
        base = capacity / (count * (math.sin(bearing.nominal_angle) if thrust else cos))
        inner, outer = (1.0, 1.0) if thrust else (0.407, 0.389)
        factors = ((inner, share), (outer, 1 / share))
        power = 0.3
    inner, outer = (base / factor * (1 + inside) ** power for factor, inside in factors)
    return inner, outer


def edge_factors(count: int) -> Array:
    """Factors of ISO/TS 16281:2008 for the stress at the edges of a roller, equation (60).

    They approximate the pressure over that of Hertz in each lamina, for the standard's profile,
    medium loads and misalignments below 4', and are the same for every bearing and load.

    Parameters
    ----------
    count : int
        Number of laminae.

    Returns
    -------
    numpy.ndarray
        Factors ``(count,)``.

    Examples
    --------
    >>> from nacre.bearing import edge_factors
    >>> round(float(edge_factors(40)[0]), 2), round(float(edge_factors(40)[19]), 3)
    (2.33, 1.003)
    """
    count = core.integer("count", count)
    if count < 2:
        raise ValueError(f"count must be a number of laminae of at least 2, got {count!r}")
    core.check_memory("count", count, 48)
    away = np.abs(2 * np.arange(1, count + 1) - count - 1)
    factors = np.ones(count)  # of the lamina in the middle, the limit
    factors[away > 0] -= 0.01 / np.log(1.985 * away[away > 0] / (2 * count - 2))
    return factors


def hertz_pressures(bearing: RollerBearing, loads: Array, moduli: Array) -> Array:
    """Return Hertz's pressures of laminae under their loads ``(Z, 2, laminae)`` [Pa]."""
    count = loads.shape[-1]
    x = laminae_of(bearing.length, count)
    curvature = np.stack([bearing.curvature(ring, x) for ring in RINGS])
    line = loads * count / bearing.length
    pressures: Array = np.sqrt(line * moduli[:, None] * curvature / math.pi)
    return pressures


def pressure_factors(bearing: RollerBearing, loads: Array, pressures: Array) -> Array:
    """Return pressures of laminae over those of Hertz under their loads ``(Z, 2, laminae)``.

    ISO/TS 16281:2008, equations (58) and (59), with the moduli of the substrates in place of the
    standard's constant 271, which is ``√(E/(π (1 − ν²)))`` of its steel: the constant follows from
    Hertz. It is 1 where a lamina has no load.
    """
    hertz = hertz_pressures(bearing, loads, np.array(bearing.modulus))
    return np.where(loads > 0, pressures / np.where(hertz > 0, hertz, 1.0), 1.0)


def _mean(loads: Array, power: float) -> Array:
    """Return the power mean of loads over the elements, without overflow."""
    largest = float(loads.max(initial=0.0)) or 1.0
    mean: Array = np.mean((loads / largest) ** power, axis=0) ** (1 / power) * largest
    return mean


def reference_life(
    bearing: Bearing, loads: Array, factors: Array | float, rotating: str = "inner"
) -> ReferenceLife:
    """Return the reference rating life under loads of elements.

    ISO/TS 16281:2008, equations (61) to (65) for the laminae of rollers ``(Z, 2, laminae)``, with
    factors for the stress at edges; (25) to (29) for balls ``(Z, 2)``. The ring that rotates sees
    the loads of all elements of a row; rows survive independently.
    """
    capacity = bearing.capacity
    assert capacity is not None
    ring_capacities = capacities(bearing, capacity)
    if isinstance(bearing, RollerBearing):
        powers, exponent, life = (4.0, 4.5), 4.5, -8 / 9
        limits = np.array(ring_capacities) * LAMINAE ** (-7 / 9)
    else:
        powers, exponent, life = (3.0, 10 / 3), 10 / 3, -0.9
        limits = np.array(ring_capacities)
    if rotating == "outer":
        powers = powers[::-1]
    rows = (loads * factors).reshape(bearing.rows, bearing.count, *loads.shape[1:])
    sums = sum(
        float(((_mean(row[:, ring], powers[ring]) / limits[ring]) ** exponent).sum())
        for row in rows
        for ring in range(2)
    )
    l10r = sums**life if sums > 0 else math.inf
    return ReferenceLife(l10r, equivalent_load(bearing, l10r), ring_capacities, -exponent * life)


def equivalent_load(bearing: Bearing, l10r: float) -> float:
    """Return the load of a life in millions of revolutions [N]; 0 of an infinite one."""
    return float((bearing.capacity or 0.0) * l10r ** (-1 / bearing.standards.life_exponent))
