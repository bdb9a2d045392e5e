"""Basic rating life of ISO 281, which catalogues and contracts have: ``(C/P)^p`` with X and Y.

The exponents p are those of `Standards`. The standard's tables of X and Y were not read: those of
deep-groove and of angular contact ball bearings of 15, 30 and 40° are as Koyo's catalogue prints
them, those of 25° as LYC's does, those of 20, 35 and 45° as a program does; those of rollers as two
programs do. Between contact angles and relative loads they are linear. Contact angles of balls
below 15°, and thrust bearings with a radial load, are left out: their factors were not seen.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

import nacre._core as core
from nacre.bearing.geometry import Bearing
from nacre.bearing.iso import is_thrust
from nacre.bearing.kinds import RollerBearing, checked_bearing
from nacre.bearing.static import checked_forces

RELATIVE = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)
"""Relative axial loads ``F_a/(Z D²)`` [N/mm²].

They are ``f_0 F_a/C_0`` of deep-groove bearings, with C_0 of ISO 76:2006, formula (1). Those that
are printed for 15° are 1/cos 15° times as large, which is the same load.
"""
DEEP_GROOVE = (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00)
"""Factors Y of deep-groove ball bearings under these loads; X is 0.56."""
FLATTEST = (1.47, 1.40, 1.30, 1.23, 1.19, 1.12, 1.02, 1.00, 1.00)
"""Factors Y of a contact angle of 15°."""
ANGLES = (15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0)
"""Contact angles of balls with known factors [°]."""
RADIAL = (0.44, 0.43, 0.41, 0.39, 0.37, 0.35, 0.33)
"""Factors X of these contact angles."""
AXIAL = (1.00, 0.87, 0.76, 0.66, 0.57, 0.50)
"""Factors Y of these contact angles, from 20° on."""
SHARES = 1e-3
"""Largest difference of a sum of shares and 1: thirds with three digits are as good."""
UNREAD = (
    "ISO 281's X and Y for this bearing under these forces are not in nacre: it has none for balls "
    "with a contact angle below 15°, thrust bearings with a radial load, and rollers without a "
    "contact angle under an axial load"
)
"""Why a basic life is not known."""
ROLLERS = (
    "L10 has the exponent 10/3, and contacts rated with a factor 0.83; ISO/TS 16281 has the "
    "exponent 4 and no such factor: L10r of rollers is some 2 to 4 times as long, less with "
    "clearance"
)
"""Why both lives of rollers differ."""


def equivalent_dynamic_load(bearing: Bearing, radial: float, axial: float = 0.0) -> float:
    """Equivalent dynamic load P of ISO 281, by its factors X and Y [N].

    Parameters
    ----------
    bearing : CylindricalRoller, DeepGrooveBall, or another
        Bearing.
    radial, axial : float
        Forces F_r and F_a [N], at least 0.

    Returns
    -------
    float
        Load [N], ``X F_r + Y F_a``; F_a of thrust bearings.

    Raises
    ------
    ValueError
        If a force is below 0, or factors X and Y are needed that are not in nacre.

    Notes
    -----
    Of one row ``P = max(F_r, X F_r + Y F_a)``, as X + Y e = 1, to 1 % of the rounded numbers of
    balls: 0.4 and ``0.4 cot α`` of rollers, 0.56 and 1 to 2.3 of deep-groove balls, which fall with
    ``f_0 F_a/C_0``. Of two rows of rollers the larger one of ``F_r + 0.45 cot α F_a`` and ``0.67
    F_r + 0.67 cot α F_a``. Catalogues and programs quote them.

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall, equivalent_dynamic_load
    >>> bearing = DeepGrooveBall(count=9, diameter=9.525e-3, pitch_diameter=46e-3)  # 6206
    >>> round(equivalent_dynamic_load(bearing, radial=1000.0, axial=563.0))
    1523
    """
    load = known_load(bearing, radial, axial)
    if load is None:
        kind = type(bearing).__name__
        raise ValueError(f"{UNREAD}; got {kind} with radial {radial!r} N and axial {axial!r} N")
    return load


def known_load(bearing: Bearing, radial: float, axial: float) -> float | None:
    """Return the equivalent load of ISO 281 [N]; None where its factors are not known."""
    bearing = checked_bearing(bearing)
    radial, axial = checked_forces(radial, axial)
    if is_thrust(bearing):
        return None if radial else axial
    if not axial:
        return radial
    angle = bearing.nominal_angle
    if isinstance(bearing, RollerBearing):
        if not angle:
            return None
        thrust = axial / math.tan(angle)
        if bearing.rows == 1:
            return max(radial, 0.4 * radial + 0.4 * thrust)
        return max(radial + 0.45 * thrust, 0.67 * radial + 0.67 * thrust)
    relative = axial / (bearing.count * (bearing.diameter * 1e3) ** 2)
    x, y = 0.56, np.interp(relative, RELATIVE, DEEP_GROOVE)
    if angle:
        if (degrees := round(math.degrees(angle), 6)) < ANGLES[0]:
            return None
        x = np.interp(degrees, ANGLES, RADIAL)
        y = np.interp(degrees, ANGLES, [np.interp(relative, RELATIVE, FLATTEST), *AXIAL])
    return max(radial, float(x * radial + y * axial))


def basic_life(bearing: Bearing, radial: float, axial: float = 0.0) -> float:
    """Life L_10 of ISO 281 [million revolutions], the basic rating life of catalogues.

    It knows neither clearance nor tilts nor profiles: `BearingSolution.life` has the reference life
    of ISO/TS 16281, which does, beside it.

    Parameters
    ----------
    bearing : CylindricalRoller, DeepGrooveBall, or another
        Bearing; its `capacity` is C.
    radial, axial : float
        Forces F_r and F_a [N], at least 0.

    Returns
    -------
    float
        Life [million revolutions], ``(C/P)^3`` of balls, ``(C/P)^(10/3)`` of rollers, with P of
        `equivalent_dynamic_load`; infinite without load.

    Raises
    ------
    ValueError
        As that function does.

    Examples
    --------
    >>> from nacre.bearing import CylindricalRoller, basic_life
    >>> bearing = CylindricalRoller(
    ...     count=13, diameter=18e-3, length=18e-3, pitch_diameter=96e-3, capacity=137e3
    ... )
    >>> round(basic_life(bearing, radial=10e3))
    6153
    """
    return life_under(bearing, equivalent_dynamic_load(bearing, radial, axial))


def life_under(bearing: Bearing, load: float) -> float:
    """Return the basic life under an equivalent load [N], in millions of revolutions."""
    capacity, power = float(bearing.capacity or 0.0), bearing.standards.life_exponent
    return (capacity / load) ** power if load > 0 else math.inf


def mean_dynamic_load(bearing: Bearing, loads: Sequence[float], shares: Sequence[float]) -> float:
    """Mean of equivalent dynamic loads [N]: under it the basic life is that under all of them.

    Parameters
    ----------
    bearing : CylindricalRoller, DeepGrooveBall, or another
        Bearing, whose elements decide on the exponent.
    loads : sequence of float
        Equivalent loads P [N], at least 0.
    shares : sequence of float
        Shares of the revolutions, which sum to 1.

    Returns
    -------
    float
        Load [N], ``(Σ s P^p)^(1/p)`` with the exponent p of the life: Miner's rule.

    Raises
    ------
    ValueError
        If there is no load or one below 0, or shares are not above 0, as many as loads, with the
        sum 1.

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall, mean_dynamic_load
    >>> bearing = DeepGrooveBall(count=9, diameter=9.525e-3, pitch_diameter=46e-3)
    >>> round(mean_dynamic_load(bearing, loads=[1000.0, 2000.0], shares=[0.75, 0.25]))
    1401
    """
    power = checked_bearing(bearing).standards.life_exponent
    forces, weights = core.real_array("loads", loads), core.real_array("shares", shares)
    if forces.ndim != 1 or not (np.isfinite(forces) & (forces >= 0)).all():
        raise ValueError(f"loads must be a list of finite numbers, at least 0, got {loads!r}")
    if weights.shape != forces.shape or not abs(weights.sum() - 1) <= SHARES or min(weights) <= 0:
        raise ValueError(
            f"shares must be as many as loads, above 0, with the sum 1, got {shares!r} for "
            f"{forces.size} loads"
        )
    largest = float(forces.max()) or 1.0  # without overflow
    mean = float(np.average((forces / largest) ** power, weights=weights))
    return float(largest * mean ** (1 / power))
