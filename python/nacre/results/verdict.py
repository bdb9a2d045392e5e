"""Verdicts: whether a result holds, in a sentence with the number that decides and its error."""

from __future__ import annotations

import functools
import math
import tomllib
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from importlib import resources
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeVar

from nacre._tools.units import plain, printable
from nacre.results import display
from nacre.results.base import Result

Level = Literal["good", "fair", "bad", "unknown"]
LEVELS = ("bad", "unknown", "fair", "good")
"""Levels of verdicts, the worst first."""
Method = TypeVar("Method", bound=Callable[..., Any])

MARGIN = 1.5
"""Safety factor, less its error, from which a verdict is good."""
DIGITS = 3
"""Digits of the numbers in a verdict."""
MOST_PARTS = 2 * display.LAYER_ROWS
"""Largest number of layers and interfaces without a limit that get a sentence each."""
SLIGHT = 0.01
"""Share of the largest stress below which another is no demand."""
MARK = "; "
"""What stands between reasons."""
MILLION = 1e6
"""Hours from which lives are not told apart."""
SINGULAR = {"grid edge", "sharp end", "free end", "sharp edge", "map rim"}
"""Warnings of contacts whose pressure has no limit on ever finer cells."""
UNCONVERGED = "the solution has not converged"
UNKNOWN_ERROR = "the error of the value that decides is not known"


class Doubt(NamedTuple):
    """What a warning means for a verdict."""

    level: Literal[Level, "any"]
    """Level that it leaves at most."""
    reason: str
    leaves_model: bool = False
    """Whether the result is outside the model."""


def _doubts(table: str) -> dict[str, Doubt]:
    """Return a table of ``warnings.toml``."""
    rows = tomllib.loads(resources.files(__package__).joinpath("warnings.toml").read_text("utf-8"))
    return {key: Doubt(**row) for key, row in rows[table].items()}


KINDS, TEXTS = _doubts("kinds"), _doubts("texts")
"""What warnings mean for verdicts: of contacts by their kind, of others by words of their text."""
OUTSIDE = {doubt.reason for doubt in (*KINDS.values(), *TEXTS.values()) if doubt.leaves_model}
"""Reasons that lie outside the model."""


def doubts_about(notices: Iterable[str]) -> Iterator[Doubt]:
    """Yield what warnings mean, contacts' by their kind and others by their text."""
    for notice in notices:
        if notice in KINDS:
            yield KINDS[notice]
        else:
            yield from (doubt for words, doubt in TEXTS.items() if words in notice)


def reasons(notices: Iterable[str], level: Level) -> tuple[str, ...]:
    """Return the reasons of warnings, by kind or text, that leave this level at most."""
    doubts = (doubt for doubt in doubts_about(notices) if doubt.level == level)
    return tuple(dict.fromkeys(doubt.reason for doubt in doubts))


def joined(notices: Iterable[str], level: Level) -> str | None:
    """Return the reasons in one text, as results keep them, or None without any."""
    return MARK.join(reasons(notices, level)) or None


def split(text: str | None) -> list[str]:
    """Return the reasons of a text."""
    return [] if text is None else text.split(MARK)


def merged(*texts: str | None) -> str | None:
    """Return the reasons of texts in one, each once, or None without any."""
    return MARK.join(dict.fromkeys(reason for text in texts for reason in split(text))) or None


if TYPE_CHECKING:

    def asked(method: Method) -> Method:
        """Return the method."""
        return method

else:

    class asked:  # a decorator
        """Method `verdict` of a result; its use as an attribute is deprecated."""

        def __init__(self, method: Callable[..., Verdict]) -> None:
            """Keep the method."""
            self.method = method
            functools.update_wrapper(self, method)

        def __get__(self, result: object, owner: type) -> Callable[..., Verdict]:
            """Return the method, bound to a result."""
            return self.method if result is None else _Question(self.method, result)


class _Question(functools.partial[Any]):
    """Bound method `verdict`, which answers as the verdict itself where that is not called."""

    def __getattr__(self, name: str) -> Any:
        """Return an attribute of the verdict, with a warning."""
        if name.startswith("__"):
            raise AttributeError(name)
        message = f"verdict is a method: write verdict().{name}"
        warnings.warn(message, DeprecationWarning, stacklevel=2)
        return getattr(self(), name)

    def __str__(self) -> str:
        """Return the sentences."""
        return str(self())

    __repr__ = __str__


def verdict_on(result: object) -> Verdict | None:
    """Return the verdict on a result that knows all limits, None where it has to be asked."""
    verdict = getattr(result, "verdict", None)
    return verdict() if isinstance(verdict, _Question) else None


def worst_of(verdicts: Iterable[Verdict | None]) -> Verdict | None:
    """Return the worst verdict, with the sentences of the others below; None of none."""
    ranked = sorted(filter(None, verdicts), key=lambda verdict: LEVELS.index(verdict.level))
    if not ranked:
        return None
    first, *others = ranked
    lines = (line for verdict in others for line in verdict.sentences)
    return replace(first, lines=tuple(dict.fromkeys([*first.lines, *lines])))


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
    Safety factor 2.79 ± ... %: von Mises stress of the substrate, ... limit 2200 MPa (given).
    >>> verdict.level, verdict.decided_by
    ('good', 'von Mises stress of the substrate')
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
    question: str | None = None
    """Question that the verdict answers; None where nobody asked one."""
    inside_model: bool | None = True
    """Whether no warning says that the result is outside the model; None in older files."""

    _LATER = ("doubts", "question", "inside_model")

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
    """Quantity of a part, and the limit that it must keep, where one is given."""

    quantity: str
    part: str
    """Part with its preposition, such as "of the substrate" or "below the coating"; may be ""."""
    value: float
    error: float | None = None
    """Estimated error; None where it is not known."""
    depth: float | None = None
    limit: float | None = None
    origin: str = "given"
    """Where the limit is from, such as "ISO 76"."""
    unit: str = "Pa"
    at_least: bool = False
    """Whether the limit is the least value, as of lives and distances."""
    sentence: str | None = None
    """Sentence to say in place of that on the safety factor."""
    leads: bool = False
    """Whether the sentence comes first, unless another demand fails."""

    @property
    def name(self) -> str:
        """Quantity and part."""
        return f"{self.quantity} {self.part}".rstrip()

    @property
    def factor(self) -> float | None:
        """Safety factor: how many times the value may grow, or shrink, to the limit."""
        if self.limit is None:
            return None
        above, below = (self.value, self.limit) if self.at_least else (self.limit, self.value)
        return above / below if below else math.inf

    @property
    def share(self) -> float | None:
        """Error as a share of the value."""
        return None if self.error is None or not self.value else self.error / abs(self.value)

    @property
    def outcome(self) -> int:
        """0 of a limit that is surely broken, 1 where the error does not tell, 2 of one kept."""
        if self.limit is None or abs(self.value - self.limit) < (self.error or 0.0):
            return 1
        if (self.value >= self.limit) == self.at_least or self.value == self.limit:
            return 2
        return 1 if self.error is None else 0

    @property
    def level(self) -> Level:
        """Level of this demand alone."""
        if self.limit is None or self.error is None:
            return "unknown"
        if self.outcome == 0:
            return "bad"
        if self.at_least:
            has_margin = self.value - self.error >= MARGIN * self.limit
        else:
            has_margin = MARGIN * (self.value + self.error) <= self.limit
        return "good" if self.outcome == 2 and has_margin else "fair"


def judged(
    demands: Iterable[Demand],
    *,
    doubts: Sequence[str] = (),
    cautions: Sequence[str] = (),
    notes: Sequence[str] = (),
    unasked: str | None = None,
    question: str | None = None,
) -> Verdict:
    """Return the verdict on demands: the worst outcome decides, of these the smallest factor.

    What fails is bad whatever the doubts. Else it is unknown with a doubt, where no limit is given,
    where the error of what decides is not known, or where nobody asked, which `unasked` says; fair
    with a caution, with a demand that has no limit, or that holds by less than the margin with its
    error; and good without all of these.
    """
    demands = list(demands)
    needs = [demand for demand in demands if demand.limit is None]
    limited = [demand for demand in demands if demand.limit is not None]
    limited.sort(key=lambda demand: (demand.outcome, demand.factor or 0.0))
    worst = limited[0] if limited else None
    levels = {demand.level for demand in limited}
    level: Level
    if worst is not None and worst.level == "bad":
        level = "bad"
    elif worst is None or worst.level == "unknown" or doubts or unasked is not None:
        level = "unknown"
    else:
        level = "fair" if needs or cautions or levels != {"good"} else "good"
    doubtful = [*doubts]
    if not doubts and worst is not None and worst.level == "unknown":
        doubtful = [UNKNOWN_ERROR]
    if not (limited or needs or doubts):
        doubtful = ["nothing is loaded"]
    is_open = level == "unknown" and bool(doubtful)
    limited.sort(key=lambda demand: (demand.outcome != 0, not demand.leads))
    leading = [demand.sentence for demand in needs if demand.leads and demand.sentence]
    failing = [_sentence(demand, False) for demand in limited if demand.outcome == 0]
    keeping = [_sentence(demand, is_open) for demand in limited if demand.outcome != 0]
    sentences = [
        *failing,
        *([f"Cannot tell: {MARK.join(doubtful)}."] if doubtful else []),
        *leading,
        *keeping,
        *_needs([demand for demand in needs if not demand.leads]),
        *([f"With care: {MARK.join(cautions)}."] if cautions else []),
        *notes,
        *([] if unasked is None else [unasked]),
    ]
    return Verdict(
        level,
        sentences[0],
        tuple(sentences[1:]),
        worst and worst.factor,
        worst and worst.name,
        worst and worst.share,
        (*doubts, *cautions) or None,
        question,
        OUTSIDE.isdisjoint((*doubts, *cautions)),
    )


def _sentence(demand: Demand, is_open: bool) -> str:
    """Return the outcome of a demand with a limit: factor, quantity, value, place and limit."""
    if demand.sentence is not None:
        return demand.sentence
    value, limit = demand.value, demand.limit
    assert limit is not None
    assert demand.factor is not None
    start = "As it stands, safety" if is_open and demand.outcome else "Safety"
    outcomes = ", too small", ", below 1" if demand.error is None else ", may be below 1", ""
    factor = factor_text(demand.factor) + with_error(value, demand.error)
    return (
        f"{start} factor {factor}{outcomes[demand.outcome]}: {demand.name}, "
        f"{number(value, demand.unit)}{_place(demand)}, "
        f"limit {beside(value, limit, demand.unit, DIGITS + 1)} ({demand.origin})."
    )


def with_error(value: float, error: float | None, unit: str | None = None) -> str:
    """Return the error of a value after ±, as a share, where it is known.

    An error above the value is a share of nothing: it is written in the unit, where that is given.
    """
    if error is not None and unit is not None and error >= abs(value):
        return f" ± {number(error, unit)}"
    share = display.share(error or 0.0, value)
    return f" ± {share.replace('< ', '').replace('>', 'over')}" if share else ""


def _needs(demands: Sequence[Demand]) -> list[str]:
    """Return what parts without a limit need; of many, the largest of each quantity."""
    if len({demand.part for demand in demands}) <= MOST_PARTS:
        return [_need(demand) for demand in demands]
    sentences = []
    for quantity in dict.fromkeys(demand.quantity for demand in demands):
        alike = [demand for demand in demands if demand.quantity == quantity]
        largest = max(alike, key=lambda demand: demand.value)
        sentences.append(_need(largest, f", the largest of {len(alike)}"))
    return sentences


def _need(demand: Demand, further: str = "") -> str:
    if demand.sentence is not None:
        return demand.sentence
    name, value = demand.name, measured(demand.value, demand.error, demand.unit)
    return f"{name[0].upper()}{name[1:]}: {value}{_place(demand)}{further}; no limit is given."


def _place(demand: Demand) -> str:
    if demand.depth is None:
        return ""
    return f" at {number(demand.depth, 'm')}" if demand.depth > 0 else " at the surface"


def number(value: float, unit: str) -> str:
    """Return a number with its unit, without an exponent."""
    return beside(value, value, unit)


def beside(value: float, limit: float, unit: str = "Pa", digits: int = DIGITS) -> str:
    """Return a limit in the unit in which a value is printed."""
    scale = display.scale_of(value, unit)
    return f"{plain(scale.factor * limit, digits)} {scale.unit}".rstrip()


def measured(value: float, error: float | None, unit: str = "Pa") -> str:
    """Return a number with its error, as a share, where that is known."""
    return number(value, unit) + with_error(value, error, unit)


def factor_text(factor: float) -> str:
    """Return a safety factor in digits; one below 1 is not rounded to 1."""
    return plain(factor if factor >= 1 else min(factor, 0.999), DIGITS)
