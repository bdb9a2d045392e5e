"""Verdicts on bearings: life, and the largest pressure against that of the static rating."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from nacre._tools.units import plain
from nacre.results import display
from nacre.results.verdict import (
    DIGITS,
    NO_LIMIT,
    UNCONVERGED,
    Demand,
    Verdict,
    beside,
    level_of,
    measured,
    outcome_of,
    times,
)

if TYPE_CHECKING:
    from nacre.bearing.rating_life import BearingLife
    from nacre.bearing.solution import BearingSolution

MILLION = 1e6
MINUTES = 60.0
"""Those of an hour."""
LEVELS = ("bad", "fair", "good", "unknown")
"""Levels, the worst first; a bearing without load has none."""
UNKNOWN = "The error of the peak pressure is not known: a warning says why."
BARE = "Layers are not counted in the life: it is that of bare rings."


def life_verdict(life: BearingLife) -> Verdict:
    """Return the verdict on a life, of which nothing is required."""
    lines = ("No limit given: no life is required.",)
    return Verdict("unknown", _lives(life), lines)


@display.in_si
def bearing_verdict(solution: BearingSolution) -> Verdict:
    """Return the verdict on a bearing: its largest pressure decides."""
    lives = _lives(solution.life())
    bare = [BARE] if solution.bearing.layered else []
    errors = solution.report.discretisation or {}
    peak, edge = (
        Demand("", "", getattr(solution, name), errors.get(name))
        for name in ("peak_pressure", "edge_pressure")
    )
    if not peak.value > 0:
        return Verdict("unknown", lives, tuple(bare))
    factor = solution.bearing.standards.static_pressure / peak.value
    level, pressure = level_of(factor, peak.share), _static_comparison(peak, factor)
    sentences = [pressure, lives] if level == "bad" else [lives, pressure]
    has_edge_stress = edge.value + (edge.error or 0.0) >= peak.value
    if not math.isnan(edge.value):
        ratio = plain(edge.value / peak.value, DIGITS)
        words = "edge stress" if has_edge_stress else "no edge stress"
        sentences.append(f"Edge {measured(edge.value, edge.error)}, {ratio} of the peak: {words}.")
    is_known = errors.get("peak_pressure", 0.0) is not None
    if not is_known:
        sentences.append(f"{NO_LIMIT[0].upper()}{NO_LIMIT[1:]}." if solution._sharp else UNKNOWN)
    if level == "good" and (has_edge_stress or not is_known):
        level = "fair"
    if not solution.report.converged:
        level, sentences = "unknown", [f"Cannot tell: {UNCONVERGED}.", *sentences]
    words, *lines = [*sentences, *bare]
    decided_by = "edge pressure" if edge.value >= peak.value else "peak pressure"
    return Verdict(level, words, tuple(lines), factor, decided_by, peak.share)


def pair_verdict(bearings: Mapping[str, BearingSolution]) -> Verdict:
    """Return the verdict on bearings on one shaft, by name: the worst decides, and comes first."""
    verdicts = [(name, bearing_verdict(bearing)) for name, bearing in bearings.items()]
    verdicts.sort(key=lambda row: (LEVELS.index(row[1].level), row[1].factor or math.inf))
    words, *lines = [
        f"{name} bearing: {s}" for name, verdict in verdicts for s in verdict.sentences
    ]
    name, worst = verdicts[0]
    decided_by = worst.decided_by and f"{name} bearing, {worst.decided_by}"
    return replace(worst, words=words, lines=tuple(lines), decided_by=decided_by)


def _lives(life: BearingLife) -> str:
    """Return how long a bearing lives, in hours where it turns."""
    if not math.isfinite(life.revolutions):
        return "Lives without end: no element is loaded."
    is_modified = life.modification_factor is not None
    name = f"L{plain(100 * (1 - life.reliability), DIGITS)}{'m' if is_modified else 'r'}"
    model = "ISO 281, with a_ISO" if is_modified else "ISO/TS 16281, without lubrication"
    basis = f"{plain(100 * life.reliability, DIGITS)} %, {model}"
    turns = f"{plain(life.revolutions / MILLION, DIGITS)} million revolutions"
    if not math.isfinite(life.hours):
        return f"Lives {turns} ({name}; {basis})."
    rate = plain(life.revolutions / life.hours / MINUTES, DIGITS)
    return f"Lives {plain(life.hours, DIGITS)} h ({name} {turns} at {rate}/min; {basis})."


def _static_comparison(peak: Demand, factor: float) -> str:
    """Return the largest pressure against that of the static rating."""
    limit, ratio = f"the {beside(peak.value, factor * peak.value)} of ISO 76", times(factor)
    comparisons = f"above {limit} ({ratio})", f"about {limit} ({ratio})", f"{ratio} below {limit}"
    comparison = comparisons[outcome_of(factor, peak.share)]
    return f"Peak pressure {measured(peak.value, peak.error)}, {comparison}."
