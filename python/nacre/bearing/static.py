"""Static load rating of ISO 76, equivalent static load and static safety.

Formulae and tables of ISO 76:2006 were read in its Russian adoption, GOST 18854-2013. A bearing's
static rating is the load at which its heaviest element has a pressure of 4200 MPa, of balls, or
4000 MPa, of rollers, if half of the elements are loaded: ``F = Z Q cos α/5``.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

import nacre._core as core
from nacre.bearing.geometry import Bearing
from nacre.bearing.iso import GROOVES, is_thrust
from nacre.bearing.kinds import BallBearing, CurvedRaceways, RollerBearing, checked_bearing
from nacre.hertz import Ellipse, contact_modulus
from nacre.results.quantities import frozen, quantity
from nacre.results.shown import TableResult

if TYPE_CHECKING:
    from nacre.bearing.solution import BearingSolution

STEEL = core.Elastic(young=207e9, poisson=0.3)
"""Steel of ISO 76:2006: with it Hertz's formulae give all rows of its table 1 that were read."""
SHARE = 5.0
"""Load of the heaviest element over the mean one, ``Q Z cos α/F``: ISO 76:2006, as of balls."""
AXIAL = {5: 0.52, 10: 0.50, 15: 0.46, 20: 0.42, 25: 0.38, 30: 0.33, 35: 0.29, 40: 0.26, 45: 0.22}
"""Factors Y_0 of angular contact ball bearings by contact angle [°]: ISO 76:2006, table 2."""


def element_load(bearing: BallBearing, pressure: float) -> float:
    """Return the load at which a ball of steel has this pressure on a ring [N], the smaller one.

    Grooves are those of the tables, or wider ones. Hertz; ISO 281:2007, annex B, has the same.
    """
    modulus = contact_modulus(STEEL, STEEL)
    widest = GROOVES[is_thrust(bearing)][1]
    grooves = map(max, bearing.osculation, widest)
    loads = []
    for number, groove in enumerate(grooves):
        rolling = bearing.radii[number][1]
        radii = (*bearing.own_radii, modulus, 1.0, -groove * bearing.diameter, rolling)
        loads.append((pressure / Ellipse(*radii).peak_pressure) ** 3)
    return min(loads)


def total_load(bearing: Bearing, load: float, share: float) -> float:
    """Return the load of a bearing whose heaviest element carries `load` [N].

    The load is the axial one of thrust bearings, whose elements share it equally, and else a radial
    one, of which the heaviest element carries `share` times the mean.
    """
    elements = bearing.elements * load
    angle = bearing.nominal_angle
    return float(elements * (math.sin(angle) if is_thrust(bearing) else math.cos(angle) / share))


def static_rating(bearing: Bearing) -> float:
    """Load rating C_0 of ISO 76 [N], of a bearing at rest, of steel without layers.

    It is the radial rating C_0r; of ball bearings with a contact angle above 45°, which are thrust
    bearings, the axial one C_0a.

    Parameters
    ----------
    bearing : CylindricalRoller, DeepGrooveBall, or another
        Bearing of `nacre.bearing`.

    Returns
    -------
    float
        Rating [N].

    Notes
    -----
    Balls: ``C_0r = f_0 i Z D² cos α``, ISO 76:2006, formula (1). f_0 is what Hertz's formulae give
    for 4200 MPa, E = 207 GPa and ν = 0.3 (derived), which is that of table 1 to its last digit;
    grooves wider than its 0.52 and 0.53 of the diameter lower it. ``C_0a = f_0 Z D² sin α`` of
    thrust bearings, with grooves of 0.54, is derived in the same way.

    Rollers: ``C_0r = 44 (1 − γ) i Z L D cos α`` (mm, N), ISO 76:2006, formula (7).

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall, static_rating
    >>> bearing = DeepGrooveBall(count=9, diameter=9.525e-3, pitch_diameter=46e-3)  # 6206
    >>> round(static_rating(bearing))
    11256
    """
    bearing = checked_bearing(bearing)
    if isinstance(bearing, RollerBearing):
        size = bearing.elements * bearing.length * bearing.diameter * 1e6
        return float(44 * (1 - bearing.gamma) * size * math.cos(bearing.nominal_angle))
    return total_load(bearing, element_load(bearing, bearing.standards.static_pressure), SHARE)


def equivalent_static_load(bearing: Bearing, radial: float, axial: float = 0.0) -> float:
    """Equivalent static load P_0 of ISO 76 [N].

    Parameters
    ----------
    bearing : CylindricalRoller, DeepGrooveBall or AngularContactBall
        Bearing, of a contact angle up to 45°.
    radial, axial : float
        Forces F_r and F_a [N], at least 0.

    Returns
    -------
    float
        Load [N], ``X_0 F_r + Y_0 F_a`` and at least F_r: ISO 76:2006, 5.2 and table 2. Between
        the table's contact angles Y_0 is linear.

    Raises
    ------
    ValueError
        If a force is below 0, rollers without a contact angle have an axial one, or the bearing is
        a tapered, spherical or thrust one, whose factors are not in nacre:
        `BearingSolution.static_load` takes the loads of the elements.

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall, equivalent_static_load
    >>> bearing = DeepGrooveBall(count=9, diameter=9.525e-3, pitch_diameter=46e-3)
    >>> equivalent_static_load(bearing, radial=1000.0, axial=2000.0)
    1600.0
    """
    bearing = checked_bearing(bearing)
    is_roller = isinstance(bearing, RollerBearing)
    is_barrel = is_roller and isinstance(bearing, CurvedRaceways)
    if is_thrust(bearing) or is_barrel or (is_roller and bearing.nominal_angle):
        raise ValueError(
            f"bearing must be a cylindrical roller bearing, or a ball bearing of a contact angle "
            f"up to 45°, for the factors of ISO 76, got a {type(bearing).__name__}"
        )
    radial, axial = checked_forces(radial, axial)
    if is_roller:
        if axial:
            raise ValueError(f"axial must be 0 of rollers without a contact angle, got {axial!r}")
        return radial
    factors = (0.6, 0.5)
    if angle := math.degrees(bearing.nominal_angle):
        factors = 0.5, float(np.interp(angle, list(AXIAL), list(AXIAL.values())))
    return max(radial, factors[0] * radial + factors[1] * axial)


def checked_forces(radial: float, axial: float) -> tuple[float, float]:
    """Return finite forces of at least 0, or raise an error."""
    forces = {"radial": core.real("radial", radial), "axial": core.real("axial", axial)}
    for name, force in forces.items():
        if not (math.isfinite(force) and force >= 0):
            raise ValueError(f"{name} must be finite and at least 0, got {force!r}")
    return forces["radial"], forces["axial"]


@frozen()
class StaticLoad(TableResult):
    """Static rating, equivalent load and safety of a loaded bearing, after ISO 76.

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall
    >>> bearing = DeepGrooveBall(count=9, diameter=9.525e-3, pitch_diameter=46e-3)
    >>> static = bearing.solve(force=(2000.0, 0.0, None), model="iso16281").static_load()
    >>> round(static.rating), 1700 < static.equivalent_load < 2000
    (11256, True)
    """

    _TITLE = "static load of a bearing"
    _IN_SI = True

    rating: float = quantity("N", label="static rating")
    """Static load rating C_0 [N]."""
    equivalent_load: float = quantity("N", label="equivalent load")
    """Equivalent static load P_0 [N]."""
    safety: float = quantity(label="static safety")
    """Static safety factor: ``s_0 = C_0/P_0``; infinite without load."""
    model: str
    """Model in words."""


def static_load_of(solution: BearingSolution) -> StaticLoad:
    """Return the static load of a solved bearing, by the load of its heaviest element."""
    bearing = solution.bearing
    rating = static_rating(bearing)
    load = total_load(bearing, solution.largest_load, SHARE)
    safety = rating / load if load > 0 else math.inf
    return StaticLoad(rating, load, safety, "ISO 76, by the solved load of the heaviest element")
