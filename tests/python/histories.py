"""Criteria of fatigue by the words of case files, and with given factors."""

from __future__ import annotations

import math
from typing import Any

from nacre import fatigue

KINDS: dict[str, Any] = {
    "dang_van": fatigue.DangVan,
    "crossland": fatigue.Crossland,
    "findley": fatigue.Findley,
    "matake": fatigue.Matake,
}
PLANES = ("findley", "matake")


def ratio(kind: str, factor: float) -> float:
    """Return the torsion over the bending limit that gives a factor: the constants, inverted."""
    if kind == "dang_van":
        return factor / 3 + 0.5
    if kind == "crossland":
        return (factor + 3**0.5) / 3
    if kind == "matake":
        return (factor + 1) / 2
    return (factor / math.hypot(1.0, factor) + 1) / 2


BENDING = 1e9
"""Bending limit [Pa]. Stresses of criteria depend on its ratio to the torsion limit alone; `assess`
refuses limits that are not in the units of the moduli."""


def made(kind: str, factor: float) -> Any:
    return KINDS[kind](bending=BENDING, torsion=BENDING * ratio(kind, factor))
