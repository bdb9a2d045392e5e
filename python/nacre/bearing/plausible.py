"""Plausible ranges of numbers of a life: beyond them they are likely to be in another unit."""

from __future__ import annotations

import math
from typing import NamedTuple

from nacre._tools.units import plain


class Range(NamedTuple):
    """Plausible range of a quantity, with its reason, and what to ask where a number is beyond."""

    least: float
    most: float
    unit: str
    question: str
    reason: str
    scale: str = ""
    """Quantity of which both ends are shares; none where they are numbers in the unit."""
    word: str = "is unusual"
    """Word for numbers beyond, by which ``warnings.toml`` says what they mean for verdicts."""


NEVER = "is implausible"
OIL = "ISO 281 counts κ above 4 as 4; thicker oils cost friction and heat, so that few have 20"
RANGES = {
    "fatigue_load_limit": Range(
        *(1e-3, 0.5, "N", "is it in N?"),
        "C_0/22 of balls and C_0/8.2 of rollers, a tenth of it where d_m is 10 m: ISO 281, annex B",
        *("C_0", NEVER),
    ),
    "equivalent load": Range(
        *(1e-3, math.inf, "N", "are forces in N?"),
        "makers ask for some C/100 of balls and C/50 of rollers, below which elements slide",
        *("C", NEVER),
    ),
    "viscosity_ratio": Range(0.0, 20.0, "", "is it ν/ν_1, not a percentage?", OIL),
    "film_ratio": Range(
        *(0.0, 10.0, "", "is it film over roughness, not a length?"),
        "it gives κ = λ^1.3 = 20, and films of some µm on roughnesses of some 0.1 µm have 10",
    ),
    "kinematic_viscosity over ν_1": Range(
        *(0.0, 20.0, "", "is it kinematic, not dynamic, and the speed in rad/s?"),
        OIL,
    ),
    "pitch_diameter": Range(
        *(0.0, 1.0, "m", "is it in m, not mm?"),
        "few bearings are larger; those of a millimetre and more in mm are beyond",
    ),
    "life": Range(
        *(1 / 60, 1e9, "h", "is the speed in rad/s, and are forces in N?"),
        "nobody mounts a bearing for a minute; 1e9 h are 100 000 years",
    ),
    "speed times pitch_diameter": Range(
        *(0.0, 100.0, "m/s", "is the speed in rad/s, not in 1/min?"),
        "n d_m of 1e6 mm/min, to which catalogues go, is 105 m/s; spindles and turbines have more",
        word="is high",
    ),
}
"""Plausible ranges of the numbers of a life."""


def doubts_on(name: str, number: float, scale: float = 1.0) -> list[str]:
    """Return what a number beyond its plausible range asks, in a list; an empty one within.

    `scale` is the quantity of which the ends of the range are shares.
    """
    known = RANGES[name]
    below = number < known.least * scale
    if not (below or number > known.most * scale):
        return []
    share = known.least if below else known.most
    unit, side = f" {known.unit}".rstrip(), "below" if below else "above"
    bound = f"{plain(share * scale, 3)}{unit}"
    bound += f", {plain(share, 3)} {known.scale}" if known.scale else ""
    return [f"{name} {plain(number, 3)}{unit} {known.word}, {side} {bound}: {known.question}"]
