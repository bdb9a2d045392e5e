"""Verdicts: whether a result holds, in a sentence with the number that decides and its error."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from nacre._tools.units import plain, printable
from nacre.results import display
from nacre.results.base import Result

Level = Literal["good", "fair", "bad", "unknown"]

MARGIN = 1.5
"""Limit over value from which a verdict is good."""
DIGITS = 3
"""Digits of the numbers in a verdict."""
MOST_PARTS = 2 * display.LAYER_ROWS
"""Largest number of layers and interfaces without a limit that get a sentence each."""
SLIGHT = 0.01
"""Share of the largest stress below which another is no demand."""
SINGULAR = {"grid edge", "sharp end", "free end", "sharp edge", "map rim"}
"""Warnings of contacts whose pressure has no limit on ever finer cells."""
NO_LIMIT = "the pressure at an edge has no limit, and grows as the cells shrink"
UNCONVERGED = "the solution has not converged"
COARSE = "the cells do not resolve the contact"
UNKNOWN_ERROR = "the error of the value that decides is not known"
KINDS: dict[str, tuple[Level | None, str]] = {
    **dict.fromkeys(sorted(SINGULAR), ("unknown", NO_LIMIT)),
    "coarse": ("unknown", COARSE),
    "coarse spots": ("unknown", COARSE),
    "outside grid": ("unknown", "the largest stresses may lie beyond the grid"),
    "unknown stations": ("unknown", "the errors of the sections along the roller are not known"),
    "coated end": ("fair", "the ends of the layers are left out"),
    "endless crown": ("fair", "a crown reaches beyond the body"),
    "large contact": ("fair", "the contact is large for flat bodies"),
    "large motion": ("fair", "the motion is large for cells that stay where they are"),
    "no estimate": (None, "a missing error counts where it decides"),
    "peak error": ("fair", "the cells leave a large error of the peak pressure"),
    "stations": ("fair", "the sections along the roller leave a large error"),
}
"""Level that a kind of warning of a contact leaves at most, None for any, with the reason."""
UNSURE = "As it stands"
"""Outcome of what holds in a result that is in doubt."""


@dataclass(frozen=True, repr=False)
class Verdict(Result):
    """Verdict on a result: whether it holds, by which factor, and what decides.

    Printing it shows its sentences, in the units that were set when it was made.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=5.0, max_cells=4096)
    >>> verdict = solution.verdict(yield_stress={"substrate": 2.2e9})
    >>> print(verdict)
    Holds, ... times: substrate, von Mises 789 MPa ± ... % at 20.8 µm, of 2200 MPa.
    >>> verdict.level, verdict.decided_by
    ('good', 'substrate, von Mises')
    """

    level: Level
    """Level: "good", "fair", "bad", or "unknown" where no limit is given or none can be judged."""
    words: str
    """Verdict in a sentence."""
    lines: tuple[str, ...] = ()
    """Further sentences: on every other part, and on limits that are missing."""
    factor: float | None = None
    """Limit over the value that decides; None without a limit."""
    decided_by: str | None = None
    """Part and quantity that decide; None without a limit."""
    uncertainty: float | None = None
    """Estimated error of the factor, as a share of it; None where it is not known."""
    doubts: tuple[str, ...] | None = None
    """What leaves the level unknown or fair at most, apart from limits; None without."""

    _LATER = ("doubts",)

    @property
    def sentences(self) -> tuple[str, ...]:
        """All sentences, the verdict first."""
        return (self.words, *self.lines)

    def __str__(self) -> str:
        """Return the sentences, a line for each."""
        return printable("\n".join(self.sentences))

    def __repr__(self) -> str:
        """Return level and verdict in a line."""
        return printable(f"<Verdict: {self.level}. {self.words}>")

    def _repr_html_(self) -> str:
        return display.markup([], verdict=self.sentences)


class Demand(NamedTuple):
    """Stress that a part has to bear, and its limit over that, where one is given."""

    part: str
    quantity: str
    value: float
    error: float | None = None
    """Estimated error; None where it is not known."""
    depth: float | None = None
    factor: float | None = None
    outcomes: tuple[str, str, str] = ("Fails", "Cannot tell", "Holds")
    """Words where the factor is below 1, within its error of 1, and above."""
    need: str = "no limit given, needs to bear"
    """Words before the value where no limit is given."""

    @property
    def share(self) -> float | None:
        """Error as a share of the value."""
        return None if self.error is None or not self.value else self.error / abs(self.value)


def outcome_of(factor: float, share: float | None) -> int:
    """Return 0 of a factor below 1, 2 of one above, and 1 where its error decides.

    The error is a share of the value: with it the value reaches the limit from either side.
    """
    if abs(factor - 1) < (share or 0.0):
        return 1
    return 2 if factor >= 1 else 0


def level_of(factor: float, share: float | None) -> Level:
    """Return the level of a factor whose value has an error, which is a share of it."""
    outcome = outcome_of(factor, share)
    if outcome == 0:
        return "bad"
    if share is None:
        return "unknown"
    return "good" if outcome == 2 and factor >= MARGIN * (1 + share) else "fair"


def doubts_of(kinds: Iterable[str], level: Level) -> str | None:
    """Return the reasons why kinds of warnings leave this level at most, or None without any."""
    reasons = dict.fromkeys(KINDS[kind][1] for kind in kinds if KINDS[kind][0] == level)
    return "; ".join(reasons) or None


def judged(
    demands: Iterable[Demand],
    doubt: str | None = None,
    notes: Sequence[str] = (),
    caution: str | None = None,
) -> Verdict:
    """Return the verdict on parts: the worst outcome decides, of these the smallest factor.

    With a `doubt` nothing holds; what fails does so nevertheless. With a `caution`, a part without
    a limit, or one that holds by less than the margin with its error, it is fair at best.
    """
    needs, ranked = [], []
    for one in demands:
        if one.factor is None:
            needs.append(one)
        else:
            ranked.append((outcome_of(one.factor, one.share), one.factor, one))
    doubts = [] if doubt is None else [f"Cannot tell: {doubt}."]
    notes = [*notes, *([] if caution is None else [f"With care: {caution}."])]
    if not ranked:
        words, *lines = [*doubts, *_needs(needs)] or ["Cannot tell: nothing is loaded."]
        return Verdict("unknown", words, (*lines, *notes))
    outcome, factor, worst = min(ranked, key=lambda row: row[:2])
    level: Level = level_of(factor, worst.share) if doubt is None or outcome == 0 else "unknown"
    if level == "unknown" and not doubts:
        doubts = [f"Cannot tell: {UNKNOWN_ERROR}."]
    others = [level_of(factor, one.share) for _, factor, one in ranked]
    if level == "good" and (needs or caution is not None or set(others) != {"good"}):
        level = "fair"
    ordered = [worst, *(one for _, _, one in ranked if one is not worst)]
    if level == "unknown":
        ordered = [one._replace(outcomes=(one.outcomes[0], UNSURE, UNSURE)) for one in ordered]
    sentences = [_sentence(one) for one in ordered]
    sentences[level == "bad" : 0] = doubts
    words, *lines = [*sentences, *_needs(needs), *notes]
    decided_by = f"{worst.part}, {worst.quantity}"
    reasons = tuple(one for one in (doubt, caution) if one is not None) or None
    return Verdict(level, words, tuple(lines), factor, decided_by, worst.share, reasons)


def _sentence(demand: Demand) -> str:
    """Return the outcome of a demand with a limit: factor, part, value, place and limit."""
    value, factor = demand.value, demand.factor
    assert factor is not None  # has a limit
    return (
        f"{demand.outcomes[outcome_of(factor, demand.share)]}, {times(factor)}: "
        f"{demand.part}, {demand.quantity} {measured(value, demand.error)}{_place(demand)}, "
        f"of {beside(value, factor * value)}."
    )


def _needs(demands: Sequence[Demand]) -> list[str]:
    """Return what parts without a limit need; of many, the largest of each quantity."""
    if len({one.part for one in demands}) <= MOST_PARTS:
        return [_need(one) for one in demands]
    sentences = []
    for quantity in dict.fromkeys(one.quantity for one in demands):
        alike = [one for one in demands if one.quantity == quantity]
        largest = max(alike, key=lambda one: one.value)
        sentences.append(_need(largest, f", the largest of {len(alike)}"))
    return sentences


def _need(demand: Demand, further: str = "") -> str:
    value = measured(demand.value, demand.error)
    return f"{demand.part}: {demand.need} {value} of {demand.quantity}{_place(demand)}{further}."


def _place(demand: Demand) -> str:
    if demand.depth is None:
        return ""
    return f" at {number(demand.depth, 'm')}" if demand.depth > 0 else " at the surface"


def number(value: float, unit: str) -> str:
    """Return a number with its unit, without an exponent."""
    return beside(value, value, unit)


def beside(value: float, limit: float, unit: str = "Pa") -> str:
    """Return a limit in the unit in which a value is printed."""
    scale = display.scale_of(value, unit)
    return f"{plain(scale.factor * limit, DIGITS)} {scale.unit}".rstrip()


def measured(value: float, error: float | None, unit: str = "Pa") -> str:
    """Return a number with its error, as a share, where that is known."""
    share = display.share(error or 0.0, value).replace("< ", "").replace(">", "over")
    return number(value, unit) + (f" ± {share}" if share else "")


def times(factor: float) -> str:
    """Return a factor in words; one below 1 is not rounded to 1."""
    return f"{plain(factor if factor >= 1 else min(factor, 0.999), DIGITS)} times"
