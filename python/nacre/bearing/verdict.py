"""Verdicts on bearings: what lives, loads and pressures have to keep, and what is in doubt."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from nacre._tools.units import plain
from nacre.bearing.geometry import RINGS, Bearing, substrate
from nacre.results import display
from nacre.results.verdict import (
    DIGITS,
    MARK,
    MILLION,
    UNCONVERGED,
    Demand,
    Verdict,
    beside,
    judged,
    measured,
    reasons,
    split,
    with_error,
)

if TYPE_CHECKING:
    from nacre.bearing.pair import PairLife
    from nacre.bearing.rating_life import BearingLife
    from nacre.bearing.solution import BearingSolution

MINUTES, SECONDS = 60.0, 3600.0
"""Those of an hour."""
FEW = 1e5
"""Revolutions up to which they are not told in millions."""
STEEL = (190e9, 220e9)
"""Young's moduli of steels [Pa], between which the lives and limits of the standards hold."""
STEEP = (math.radians(4 / 60), math.radians(16 / 60))
"""Tilts that many makers allow rollers and balls."""
UNLOADED = "nothing is loaded"
UNASKED = "Give a required life to judge it."
BARE, NOT_STEEL = "layers are not counted", "rings are not of steel"
"""Words of the table of warnings, of layers that are in contacts alone, and of other rings."""


def life_verdict(life: BearingLife | PairLife) -> Verdict:
    """Return the verdict on a life, which the required one decides."""
    doubts = _doubts(life)
    return judged(
        [_life_demand(life)] if _is_known(doubts) else [],
        doubts=doubts,
        cautions=split(life.caution),
        unasked=UNASKED if life.required_life is None and _is_known(doubts) else None,
        question=_question(life, None),
    )


@display.in_si
def bearing_verdict(
    parts: Mapping[str, BearingSolution], life: BearingLife | PairLife, static_safety: float | None
) -> Verdict:
    """Return the verdict on a bearing or on both of a pair, by words for parts."""
    doubts, cautions = _doubts(life), split(life.caution)
    notes: list[str] = []
    is_known = _is_known(doubts)
    demands = [_life_demand(life)] if is_known else []
    for part, bearing in parts.items():
        demands += _static_demands(bearing, part, static_safety, is_known)
        edge, is_edged = _edge(bearing, part)
        notes += edge
        cautions += ["the largest pressure is at an edge"] if is_edged else []
        cautions += _film_cautions(bearing)
    if life.required_life is None and static_safety is not None:  # the question is another
        notes = [str(demand.sentence) for demand in demands[:is_known]] + notes
        demands = demands[is_known:]
    is_asked = life.required_life is not None or static_safety is not None
    return judged(
        demands,
        doubts=doubts,
        cautions=[*dict.fromkeys(cautions)],
        notes=notes,
        unasked=None if is_asked or not is_known else UNASKED,
        question=_question(life, static_safety),
    )


def doubts_and_cautions(solution: BearingSolution, life: BearingLife) -> tuple[str, str]:
    """Return what leaves the life of a solution unknown, and what fair at best: "" for nothing."""
    report, bearing = solution.report, solution.bearing
    notices = [*report.warnings, *(report.contact_kinds or ()), *life.notes]
    notices += [BARE] if bearing.layered else []
    notices += [] if _is_steel(bearing) else [NOT_STEEL]
    notices += ["above half of the rating"] if life.equivalent_load > life.capacity / 2 > 0 else []
    is_ball = math.isnan(solution.edge_pressure)
    if max(map(abs, solution.tilt)) > STEEP[is_ball] * 1.001 and not bearing.aligns:
        notices.append("tilt of balls" if is_ball else "tilt of rollers")
    unfinished = [] if report.converged else [UNCONVERGED]
    doubts = [*unfinished, *reasons(notices, "unknown")]
    return MARK.join(doubts), MARK.join(reasons(notices, "fair"))


def _is_known(doubts: Sequence[str]) -> bool:
    """Return whether lives and limits of ISO are those of a bearing with these doubts."""
    return set(doubts).isdisjoint(reasons([NOT_STEEL], "unknown"))


def _is_steel(bearing: Bearing) -> bool:
    """Return whether both rings are of a steel: their limits are those of the standards."""
    rings = [substrate(getattr(bearing, ring)) for ring in RINGS]
    return all(STEEL[0] <= ring.young <= STEEL[1] for ring in rings)


def _doubts(life: BearingLife | PairLife) -> list[str]:
    """Return what leaves a life unknown."""
    return [*split(life.doubt), *([] if math.isfinite(life.revolutions) else [UNLOADED])]


def _question(life: BearingLife | PairLife, static_safety: float | None) -> str | None:
    """Return what is asked of a bearing."""
    values = {"life": (life.required_life, " h"), "static safety": (static_safety, "")}
    limits = [
        f"a {name} of {plain(value, DIGITS)}{unit}"
        for name, (value, unit) in values.items()
        if value is not None
    ]
    return f"Does it reach {' and '.join(limits)}?" if limits else None


def _life_demand(life: BearingLife | PairLife) -> Demand:
    """Return the life, in hours where it turns."""
    hours = life.hours if life.hours and math.isfinite(life.hours) else None
    value = life.revolutions if hours is None else hours
    error = life.uncertainty
    part, limit = "of both bearings" if life._of else "", life.required_life
    demand = Demand("life", part, value, error and error * value, None, limit, "given", "h", True)
    return demand._replace(sentence=_life_sentence(life, demand, hours), leads=True)


def _life_sentence(life: BearingLife | PairLife, demand: Demand, hours: float | None) -> str:
    """Return how long a bearing or a pair lives, and what is required."""
    if not math.isfinite(life.revolutions):
        return "Lives without end: no element is loaded."
    is_modified = life.modification_factor is not None
    name = f"L{plain(100 * (1 - life.reliability), DIGITS)}{'m' if is_modified else 'r'}"
    model = "ISO 281, with a_ISO" if is_modified else "ISO/TS 16281, without lubrication"
    basis = f"{life._of}{plain(100 * life.reliability, DIGITS)} %, {model}"
    duration = _revolutions(life.revolutions)
    if hours is not None:
        rate = plain(life.revolutions / hours / MINUTES, DIGITS)
        name, duration = f"{name} {duration} at {rate}/min", _duration(hours, demand.limit)
    error = "" if duration.startswith(">") else with_error(demand.value, demand.error)
    needed = ""
    if demand.limit is not None:
        outcome = "too short" if demand.value < demand.limit else "long enough"
        if demand.error is None:
            outcome += " as it stands"
        elif demand.outcome == 1:
            outcome = "about as long"
        needed = f", {plain(demand.limit, DIGITS)} h required: {outcome}"
    return f"Lives {duration}{error} ({name}; {basis}){needed}{_alone(life, hours, demand.limit)}."


def _alone(life: BearingLife | PairLife, hours: float | None, limit: float | None) -> str:
    """Return the lives of both bearings of a pair alone, the shorter one first."""
    if not life._of:
        return ""
    lives = {name: getattr(life, name) for name in ("first", "second")}
    words = {
        name: (
            _revolutions(number)
            if hours is None
            else _duration(number * hours / life.revolutions, limit)
        )
        for name, number in sorted(lives.items(), key=lambda row: row[1])
    }
    if len({*words.values()}) == 1:
        return f"; each bearing {words['first']}"
    return "".join(f"{mark} {k} bearing {words[k]}" for mark, k in zip(";,", words, strict=True))


def _revolutions(number: float) -> str:
    """Return a number of revolutions in words, in millions where they are many."""
    if math.isinf(number):
        return "without end"
    if number < FEW:
        return f"{plain(number, DIGITS)} revolutions"
    return f"{plain(number / MILLION, DIGITS)} million revolutions"


def _duration(hours: float, limit: float | None = None) -> str:
    """Return hours in words: no more than a million unless the limit is, minutes or seconds."""
    if math.isinf(hours):
        return "without end"
    if hours > MILLION and not (limit is not None and limit > MILLION / 2):
        return "> 1 million hours"
    for size, unit in ((1.0, "h"), (MINUTES, "min"), (SECONDS, "s")):
        if hours * size >= 1:
            return f"{plain(hours * size, DIGITS)} {unit}"
    return "< 1 s"


def _static_demands(
    solution: BearingSolution, part: str, static_safety: float | None, is_known: bool
) -> Iterator[Demand]:
    """Yield the static safety and the peak pressure, whose limits are those of ISO 76.

    The safety is that of the load of the heaviest element, after the standard, which knows neither
    profiles nor tilts nor layers. The pressure is compared with the one on which the rating stands,
    and its factor is that of the load under which it grows to it: ``Q ∝ p^n`` with n of 3 of balls
    and of 2 of rollers.
    """
    peak, report, standards = solution.peak_pressure, solution.report, solution.bearing.standards
    known = 0.0 if solution.model == "iso16281" else None  # these contacts are formulas
    share = known if report.load_error is None else report.load_error
    error = known if report.discretisation is None else report.discretisation.get("peak_pressure")
    pressure = Demand("peak pressure", part, peak, error)
    if not is_known:
        yield pressure
    if not is_known or not peak > 0:
        return
    usual = standards.static_safety
    required, origin = (usual, "ISO 76") if static_safety is None else (static_safety, "given")
    value = solution.static_load().safety
    error_of_safety = share and share * value
    kept = required, origin, "", True
    safety = Demand("static safety", part, value, error_of_safety, None, *kept)
    outcome = ": too low" if safety.outcome == 0 else ""
    words = f"{_capitalised(safety)} {plain(value, DIGITS)}, {plain(required, DIGITS)} required"
    yield safety._replace(sentence=f"{words} ({origin}){outcome}.")
    limit, power = standards.static_pressure, solution.bearing.width_power
    value = (limit / peak) ** power
    bound = f"limit {beside(peak, limit)} (ISO 76) at {plain(value, DIGITS)} times the load"
    deviation, kept = (
        error and power * value * error / peak,
        (min(1.0, required), "ISO 76", "", True),
    )
    pressure = Demand(pressure.quantity, part, value, deviation, None, *kept)
    outcome = ": too high" if pressure.outcome == 0 else ""
    words = f"{_capitalised(pressure)} {measured(peak, error)}"
    yield pressure._replace(sentence=f"{words}, {bound}{outcome}.")


def _capitalised(demand: Demand) -> str:
    """Return quantity and part as a sentence begins."""
    return demand.name[0].upper() + demand.name[1:]


def _edge(solution: BearingSolution, part: str) -> tuple[list[str], bool]:
    """Return the pressure at the edges of rollers in words, and whether it is the largest."""
    edge, peak = solution.edge_pressure, solution.peak_pressure
    if math.isnan(edge) or not peak > 0:
        return [], False
    error = (solution.report.discretisation or {}).get("edge_pressure")
    is_edged = edge + (error or 0.0) >= peak
    words = f"{plain(edge / peak, DIGITS)} of the peak: {'' if is_edged else 'no '}edge stress"
    return [f"{f'Edge {part}'.rstrip()} {measured(edge, error)}, {words}."], is_edged


def _film_cautions(solution: BearingSolution) -> Sequence[str]:
    """Return what the film that was asked for leaves fair at best."""
    if (film := solution._film) is None:
        return ()
    thin = f"λ = {plain(film.film_ratio, DIGITS)}: oil film too thin"
    return [*([thin] if film.film_ratio < 1 else []), *reasons(film.notes, "fair")]
