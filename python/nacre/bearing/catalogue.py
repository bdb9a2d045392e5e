"""Catalogues: ratings compared with those printed, and balls estimated from them."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import nacre._core as core
from nacre._tools.groups import names_itself
from nacre._tools.notices import warn
from nacre.bearing.balls import AngularContactBall, DeepGrooveBall
from nacre.bearing.geometry import SMALLEST, WIDEST, Bearing, above
from nacre.bearing.iso import rating
from nacre.bearing.kinds import BallBearing, checked_bearing
from nacre.bearing.static import static_rating

TOLERANCE = 0.05
"""Difference of ratings that a catalogue may have: fifteen of ball bearings are within 0.8 %."""
IMPROVED = 0.07
"""Largest excess over ISO 281 of a maker's improved class: 4, 5 and 6 % of a 6305, a 6309
and a 6205."""
FEWEST, MOST = 5, 40
"""Numbers of balls between which an estimate is looked for."""
ROOM = 0.95
"""Largest share of the pitch circle that balls fill: a cage is between them."""
THINNEST = 0.2
"""Least share of the room between bore and outside diameter that a ball takes: 0.5 to 0.65 are
usual; ratings in kN would make it 0.02."""
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


def compare_ratings(
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
    >>> from nacre.bearing import DeepGrooveBall, compare_ratings
    >>> bearing = DeepGrooveBall(count=9, diameter=7.9375e-3, pitch_diameter=38.5e-3)  # 6205
    >>> print(compare_ratings(bearing, capacity=14e3))
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
        warn(
            f"{name} of the catalogue, {printed:.6g} N, differs by {100 * difference:+.2g} % from "
            f"that of {standard} for this geometry, {own:.6g} N"
        )
    return difference


@names_itself
def estimated_balls(
    *,
    bore: float,
    outside_diameter: float,
    capacity: float,
    static_capacity: float,
    contact_angle: float | None = None,
    count: int | None = None,
    **others: Any,
) -> DeepGrooveBall | AngularContactBall:
    """Estimate number and size of the balls of a bearing from its catalogue.

    The pitch diameter is taken as the mean of bore and outside diameter. Each number of balls has a
    diameter with the static rating C_0 of ISO 76; the number whose dynamic rating is nearest to C
    is taken (derived). Makers who rate above ISO 281 make it wrong: all other numbers are named for
    which C is from 5 % below to 7 % above ISO 281.

    Parameters
    ----------
    bore, outside_diameter : float
        Boundary dimensions d and D [m].
    capacity, static_capacity : float
        Ratings C and C_0 of the catalogue [N].
    contact_angle : float, optional
        Contact angle [rad] of an angular contact bearing; without, it is a deep-groove bearing.
    count : int, optional
        Number of balls, where it is known, as from a picture or by eye.
    **others
        Other arguments of `DeepGrooveBall` or `AngularContactBall`.

    Returns
    -------
    DeepGrooveBall or AngularContactBall
        Bearing. A `NacreWarning` says that count, diameter and pitch diameter are estimates, and
        which other counts and diameters may be meant.

    Raises
    ------
    ValueError
        If an argument is out of range, or no bearing has both ratings.

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
    if wrong := sorted(others.keys() & {"diameter", "pitch_diameter"}):
        raise TypeError(f"{wrong[0]} must be left out: it is estimated, got {others[wrong[0]]!r}")
    bore, outside = above("bore", bore), above("outside_diameter", outside_diameter, bore)
    capacity, static = above("capacity", capacity), above("static_capacity", static_capacity)
    pitch = (bore + outside) / 2
    dimensions: dict[str, Any] = {"pitch_diameter": pitch} | others
    kind = DeepGrooveBall if contact_angle is None else AngularContactBall
    if contact_angle is not None:
        dimensions["contact_angle"] = contact_angle
    if count is not None and (count := core.integer("count", count)) < 2:
        raise ValueError(f"count must be at least 2, got {count}")
    candidates: list[tuple[float, DeepGrooveBall | AngularContactBall]] = []
    for number in range(FEWEST, MOST + 1) if count is None else [count]:
        make = partial(kind, count=number, **dimensions)
        if (diameter := _diameter(make, number, static, pitch, (outside - bore) / 2)) is not None:
            bearing = make(diameter=diameter)
            candidates.append((capacity / rating(bearing) - 1, bearing))
    candidates.sort(key=lambda candidate: abs(candidate[0]))
    fitting = [bearing for excess, bearing in candidates if -TOLERANCE <= excess <= IMPROVED]
    if not fitting:
        balls = "balls" if count is None else f"{count} balls"
        raise ValueError(
            f"capacity and static_capacity must be those of {balls} between the rings, C from "
            f"{100 * TOLERANCE:g} % below to {100 * IMPROVED:g} % above ISO 281, got "
            f"{capacity:.6g} and {static:.6g} N: are they in N?"
        )
    best, *alternatives = fitting
    words = [f"{ball.count} of {ball.diameter * 1e3:.4g} mm" for ball in alternatives]
    more = f"; others are {', '.join(words)}: count the balls, and give count" if words else ""
    warn(
        f"count {best.count}, diameter {best.diameter * 1e3:.4g} mm and pitch_diameter "
        f"{pitch * 1e3:.4g} mm are estimates from the ratings of the catalogue{more}"
    )
    return best


def _diameter(
    make: Callable[..., BallBearing], count: int, static: float, pitch: float, room: float
) -> float | None:
    """Return the diameter with which balls have a static rating; None where rings hold none."""
    largest = min(room, pitch * math.sin(ROOM * math.pi / count))
    low, high = max(SMALLEST, THINNEST * room, 1.01 * pitch / WIDEST), largest

    def rating_of(diameter: float) -> float:
        return static_rating(make(diameter=diameter))

    if not (low < high and rating_of(low) < static < rating_of(high)):
        return None
    while high / low - 1 > SETTLED:  # the rating rises with the diameter
        middle = math.sqrt(low * high)
        low, high = (middle, high) if rating_of(middle) < static else (low, middle)
    return low
