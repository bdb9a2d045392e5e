"""Catalogues: ratings compared with those printed, and balls estimated from them."""

from __future__ import annotations

import math
import warnings
from typing import Any, NamedTuple

import nacre._core as core
from nacre._tools.groups import names_itself
from nacre.bearing.balls import DeepGrooveBall
from nacre.bearing.geometry import SMALLEST, WIDEST, Bearing, above
from nacre.bearing.iso import rating
from nacre.bearing.kinds import checked_bearing
from nacre.bearing.static import static_rating

TOLERANCE = 0.05
"""Difference of ratings that a catalogue may have: fifteen of ball bearings are within 0.8 %."""
FEWEST, MOST = 5, 40
"""Numbers of balls between which an estimate is looked for."""
ROOM = 0.95
"""Largest share of the pitch circle that balls fill: a cage is between them."""
SETTLED = 1e-9
"""Relative change of a diameter below which it is that of a static rating."""


class CatalogueCheck(NamedTuple):
    """Ratings of a catalogue over those calculated, less 1; None where there is none."""

    capacity: float | None
    """Of the dynamic rating C."""
    static_capacity: float | None
    """Of the static rating C_0."""

    def __str__(self) -> str:
        """Return a line for each rating."""
        names = ("C of the catalogue", "ISO 281"), ("C_0 of the catalogue", "ISO 76")
        rows = zip(names, self, strict=True)
        return "\n".join(
            f"{name}: {100 * value:+.2g} % from that of {standard} for this geometry"
            for (name, standard), value in rows
            if value is not None
        )


def check(
    bearing: Bearing, *, capacity: float | None = None, static_capacity: float | None = None
) -> CatalogueCheck:
    """Compare the ratings of a bearing by its geometry with those of a catalogue.

    Where they differ, the number of elements, their size, or b_m are not those of the catalogue's
    bearing, or its maker rates it above ISO 281.

    Parameters
    ----------
    bearing : CylindricalRoller, DeepGrooveBall, or another
        Bearing.
    capacity : float, optional
        Dynamic load rating C of the catalogue [N].
    static_capacity : float, optional
        Static load rating C_0 of the catalogue [N].

    Returns
    -------
    CatalogueCheck
        Ratings of the catalogue over those of ISO 281 and ISO 76, less 1. A `NacreWarning` says
        where one is beyond 5 %.

    Raises
    ------
    ValueError
        If there is no rating, or one is not finite and above 0.

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall, check
    >>> bearing = DeepGrooveBall(count=9, diameter=7.9375e-3, pitch_diameter=38.5e-3)  # 6205
    >>> print(check(bearing, capacity=14e3))
    C of the catalogue: -0.11 % from that of ISO 281 for this geometry
    """
    bearing = checked_bearing(bearing)
    if capacity is None and static_capacity is None:
        raise ValueError("capacity or static_capacity must be given, got neither")
    return CatalogueCheck(
        _difference("capacity", capacity, bearing.standard_capacity, "ISO 281"),
        _difference("static_capacity", static_capacity, static_rating(bearing), "ISO 76"),
    )


def _difference(name: str, printed: float | None, own: float, standard: str) -> float | None:
    """Return a rating over that of the geometry, less 1, and warn where they differ."""
    if printed is None:
        return None
    difference = above(name, printed) / own - 1
    if abs(difference) > TOLERANCE:
        warnings.warn(
            f"{name} of the catalogue, {printed:.6g} N, differs by {100 * difference:+.2g} % from "
            f"that of {standard} for this geometry, {own:.6g} N",
            core.NacreWarning,
            stacklevel=3,
        )
    return difference


@names_itself
def estimated_balls(
    *, bore: float, outside_diameter: float, capacity: float, static_capacity: float, **others: Any
) -> DeepGrooveBall:
    """Estimate number and size of the balls of a deep-groove bearing from its catalogue.

    The pitch diameter is taken as the mean of bore and outside diameter. Each number of balls has a
    diameter with the static rating C_0 of ISO 76; the number whose dynamic rating is nearest to C
    is taken (derived). Makers who rate above ISO 281 make it wrong.

    Parameters
    ----------
    bore, outside_diameter : float
        Boundary dimensions d and D [m].
    capacity, static_capacity : float
        Ratings C and C_0 of the catalogue [N].
    **others
        Other arguments of `DeepGrooveBall`.

    Returns
    -------
    DeepGrooveBall
        Bearing. A `NacreWarning` says that count, diameter and pitch diameter are estimates.

    Raises
    ------
    ValueError
        If an argument is out of range, or no bearing has both ratings within 5 %.

    Examples
    --------
    >>> import warnings
    >>> from nacre.bearing import estimated_balls
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore")
    ...     bearing = estimated_balls(  # 6206
    ...         bore=30e-3, outside_diameter=62e-3, capacity=19.5e3, static_capacity=11.3e3
    ...     )
    >>> bearing.count, round(bearing.diameter * 1e3, 2)
    (9, 9.55)
    """
    bore, outside = above("bore", bore), above("outside_diameter", outside_diameter, bore)
    capacity, static = above("capacity", capacity), above("static_capacity", static_capacity)
    pitch = (bore + outside) / 2
    dimensions = {"pitch_diameter": pitch, **others}
    candidates = []
    for count in range(FEWEST, MOST + 1):
        diameter = _diameter(count, static, pitch, (outside - bore) / 2, dimensions)
        if diameter is not None:
            candidates.append(DeepGrooveBall(count=count, diameter=diameter, **dimensions))
    best = min(candidates, key=lambda bearing: abs(rating(bearing) / capacity - 1), default=None)
    if best is None or abs(rating(best) / capacity - 1) > TOLERANCE:
        raise ValueError(
            f"capacity and static_capacity must be those of balls between the rings within "
            f"{100 * TOLERANCE:g} %, got {capacity:.6g} and {static:.6g} N"
        )
    warnings.warn(
        f"count {best.count}, diameter {best.diameter * 1e3:.4g} mm and pitch_diameter "
        f"{pitch * 1e3:.4g} mm are estimates from the ratings of the catalogue",
        core.NacreWarning,
        stacklevel=2,
    )
    return best


def _diameter(
    count: int, static: float, pitch: float, room: float, dimensions: Any
) -> float | None:
    """Return the diameter with which balls have a static rating; None where rings hold none."""
    largest = min(room, pitch * math.sin(ROOM * math.pi / count))
    low, high = max(SMALLEST, 0.01 * largest, 1.01 * pitch / WIDEST), largest

    def rating_of(diameter: float) -> float:
        return static_rating(DeepGrooveBall(count=count, diameter=diameter, **dimensions))

    if not (low < high and rating_of(low) < static < rating_of(high)):
        return None
    while high / low - 1 > SETTLED:  # the rating rises with the diameter
        middle = math.sqrt(low * high)
        low, high = (middle, high) if rating_of(middle) < static else (low, middle)
    return low
