"""Verdicts on bearings: life, and the largest pressure against that of the static rating."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from nacre._tools.units import plain
from nacre.bearing.geometry import RINGS, Bearing, substrate
from nacre.results import display
from nacre.results.verdict import (
    DIGITS,
    MARGIN,
    NO_LIMIT,
    TEXTS,
    UNCONVERGED,
    Demand,
    Level,
    Verdict,
    beside,
    factor_text,
    measured,
)

if TYPE_CHECKING:
    from nacre.bearing.pair import PairLife
    from nacre.bearing.rating_life import BearingLife
    from nacre.bearing.solution import BearingSolution

MILLION = 1e6
MINUTES = 60.0
"""Those of an hour."""
LEVELS: tuple[Level, ...] = ("bad", "unknown", "fair", "good")
"""Levels, the worst first."""
STEEL = (190e9, 220e9)
"""Young's moduli of steels [Pa], between which the lives and limits of the standards hold."""
STEEP = (math.radians(4 / 60), math.radians(16 / 60))
"""Tilts that many makers allow rollers and balls."""
UNKNOWN = "The error of the peak pressure is not known: a warning says why."
BARE = "Layers are not counted in the life: it is that of bare rings."
NOT_STEEL = (
    "Cannot tell: lives and limits of ISO are those of bearing steel, and these bodies are not."
)
UNASKED = "No life is required: life(required_life=...) judges it."


def life_verdict(life: BearingLife | PairLife) -> Verdict:
    """Return the verdict on a life, which the required one decides."""
    level, factor, needed = _required(life)
    words, *lines = [_lives(life, needed), *([] if factor is not None else [UNASKED])]
    return Verdict(level, words, tuple(lines), factor, None if factor is None else "life", None)


def _required(life: BearingLife | PairLife) -> tuple[Level, float | None, str]:
    """Return the level of a life, the life over the required one, and what is required."""
    if (required := life.required_life) is None:
        return "unknown", None, ""
    factor = life.hours / required
    level: Level = "bad" if factor < 1 else "fair" if factor < MARGIN else "good"
    outcome = "too short" if factor < 1 else "long enough"
    return level, factor, f", {plain(required, DIGITS)} h required: {outcome}"


@display.in_si
def bearing_verdict(solution: BearingSolution) -> Verdict:
    """Return the verdict on a bearing: of its life and its largest pressure, the worse decides."""
    life = solution._life or solution.life()
    asked, ratio, needed = _required(life)
    lives, bearing = _lives(life, needed), solution.bearing
    bare = [BARE] if bearing.layered else []
    errors = solution.report.discretisation
    peak, edge = (
        # The contacts of the standard are formulas.
        Demand(
            "",
            "",
            getattr(solution, name),
            0.0 if errors is None else errors.get(name),
            limit=bearing.standards.static_pressure,
        )
        for name in ("peak_pressure", "edge_pressure")
    )
    if not peak.value > 0:
        return Verdict("unknown", lives, tuple(bare))
    if not _is_steel(bearing):
        pressure = f"Peak pressure {measured(peak.value, peak.error)}."
        return Verdict("unknown", NOT_STEEL, (pressure, *bare), None, "peak pressure", peak.share)
    factor = bearing.standards.static_pressure / peak.value
    level, pressure = peak.level, _static_comparison(peak, factor)
    sentences = [pressure, lives] if level == "bad" else [lives, pressure]
    has_edge_stress = edge.value + (edge.error or 0.0) >= peak.value
    if not math.isnan(edge.value):
        share = plain(edge.value / peak.value, DIGITS)
        words = "edge stress" if has_edge_stress else "no edge stress"
        sentences.append(f"Edge {measured(edge.value, edge.error)}, {share} of the peak: {words}.")
    if peak.error is None:
        sentences.append(f"{NO_LIMIT[0].upper()}{NO_LIMIT[1:]}." if solution._sharp else UNKNOWN)
    cautions = _cautions(solution, life)
    levels = [level, asked]
    levels += ["fair"] if has_edge_stress or bare or cautions else []
    warned: dict[str, Level] = {
        text: most
        for text in solution.report.warnings
        for words, doubt in TEXTS.items()
        if words in text and (most := doubt.level) is not None
    }
    levels += warned.values()
    doubts = [f"Cannot tell: {text}." for text, most in warned.items() if most == "unknown"]
    if not solution.report.converged:
        doubts.insert(0, f"Cannot tell: {UNCONVERGED}.")
    if doubts:
        levels.append("unknown")
        sentences = [*doubts, *sentences]
    sentences += cautions if ratio is not None else [*cautions, UNASKED]
    words, *lines = [*sentences, *bare]
    decided_by = "edge pressure" if edge.value >= peak.value else "peak pressure"
    return Verdict(_worst(levels), words, tuple(lines), factor, decided_by, peak.share)


def _worst(levels: Sequence[Level]) -> Level:
    return min(levels, key=LEVELS.index)


def _is_steel(bearing: Bearing) -> bool:
    """Return whether both rings are of a steel: their limits are those of the standards."""
    rings = [substrate(getattr(bearing, ring)) for ring in RINGS]
    return all(STEEL[0] <= ring.young <= STEEL[1] for ring in rings)


def _cautions(solution: BearingSolution, life: BearingLife) -> list[str]:
    """Return what is beyond usual loads, tilts and films: it leaves a verdict fair at best."""
    cautions = []
    if life.equivalent_load > life.capacity / 2 > 0:
        share = plain(life.equivalent_load / life.capacity, DIGITS)
        cautions.append(
            f"The equivalent load is {share} of the rating: above half of it, ISO 281 errs."
        )
    steep, tilt = STEEP[math.isnan(solution.edge_pressure)], max(map(abs, solution.tilt))
    if tilt > steep * 1.001 and not solution.bearing.aligns:
        minutes = (plain(math.degrees(angle) * MINUTES, DIGITS) for angle in (tilt, steep))
        cautions.append("The tilt is {}', many makers allow {}'.".format(*minutes))
    film = solution._film
    if film is not None and film.film_ratio < 1:
        ratio = plain(film.film_ratio, DIGITS)
        cautions.append(f"Film ratio λ = {ratio}: the oil film is thinner than the roughness.")
    return cautions


def pair_verdict(life: PairLife, bearings: Mapping[str, BearingSolution]) -> Verdict:
    """Return the verdict on bearings on one shaft, by name: of both, and then of the worse."""
    asked, ratio, _ = _required(life)
    verdicts = [(name, bearing_verdict(bearing)) for name, bearing in bearings.items()]
    verdicts.sort(key=lambda row: (LEVELS.index(row[1].level), row[1].factor or math.inf))
    name, worst = verdicts[0]
    decided_by = worst.decided_by and f"{name} bearing, {worst.decided_by}"
    if worst.level != "bad":  # the one that lives shorter first
        verdicts.sort(key=lambda row: bearings[row[0]].life().revolutions)
    lines = [
        f"{name} bearing: {sentence}"
        for name, one in verdicts
        for sentence in one.sentences
        if sentence != UNASKED
    ]
    lines += [] if ratio is not None else [UNASKED]
    words = life_verdict(life).words
    if worst.level == "bad" and asked != "bad":
        words, lines = lines[0], [words, *lines[1:]]
    level = _worst([worst.level, asked])
    return replace(worst, level=level, words=words, lines=tuple(lines), decided_by=decided_by)


def _lives(life: BearingLife | PairLife, needed: str = "") -> str:
    """Return how long a bearing or a pair lives, in hours where it turns, and what is required."""
    if not math.isfinite(life.revolutions):
        return "Lives without end: no element is loaded."
    is_modified = life.modification_factor is not None
    name = f"L{plain(100 * (1 - life.reliability), DIGITS)}{'m' if is_modified else 'r'}"
    model = "ISO 281, with a_ISO" if is_modified else "ISO/TS 16281, without lubrication"
    basis = f"{life._of}{plain(100 * life.reliability, DIGITS)} %, {model}"
    turns = f"{plain(life.revolutions / MILLION, DIGITS)} million revolutions"
    if not math.isfinite(life.hours):
        return f"Lives {turns} ({name}; {basis}){needed}."
    rate = plain(life.revolutions / life.hours / MINUTES, DIGITS)
    return f"Lives {plain(life.hours, DIGITS)} h ({name} {turns} at {rate}/min; {basis}){needed}."


def _static_comparison(peak: Demand, factor: float) -> str:
    """Return the largest pressure against that of the static rating."""
    limit, ratio = (
        f"the {beside(peak.value, factor * peak.value)} of ISO 76",
        f"{factor_text(factor)} times",
    )
    comparisons = f"above {limit} ({ratio})", f"about {limit} ({ratio})", f"{ratio} below {limit}"
    comparison = comparisons[peak.outcome]
    return f"Peak pressure {measured(peak.value, peak.error)}, {comparison}."
