"""Plausible ranges of numbers of a life: beyond them they are likely to be in another unit."""

from __future__ import annotations

import math
import tomllib
from importlib import resources
from typing import NamedTuple

from nacre._tools.units import plain


class Range(NamedTuple):
    """Plausible range of a quantity, as a table of ``plausible.toml`` has it."""

    question: str
    reason: str
    least: float = 0.0
    most: float = math.inf
    unit: str = ""
    scale: str = ""
    """Quantity of which both ends are shares; none where they are numbers in the unit."""
    word: str = "is unusual"
    """Word for numbers beyond, by which ``warnings.toml`` says what they mean for verdicts."""


FILE = resources.files(__package__).joinpath("plausible.toml")
RANGES = {name: Range(**row) for name, row in tomllib.loads(FILE.read_text("utf-8")).items()}
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
