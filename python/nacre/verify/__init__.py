"""Printed numbers of other programs, standards and papers, computed again by the installed nacre.

``nacre verify`` prints the table. `rows` has it as values:

>>> from nacre import verify
>>> [row.verdict for row in verify.rows(["dang_van"])]
['right']
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from importlib import resources
from typing import NotRequired, TypedDict

__all__ = ["Row", "names", "rows"]
__dir__ = __all__.copy


@dataclass(frozen=True)
class Row:
    """One printed number beside the one that nacre computes."""

    case: str
    """Name of the case."""
    quantity: str
    """What the number is, with its unit."""
    source: str
    """Who printed it."""
    expected: float
    """Number as printed; an integer is a count, which must be met exactly."""
    got: float
    """Number of nacre."""
    tolerance: float
    """Largest difference that is right, in the unit of the number."""

    @property
    def verdict(self) -> str:
        """``"right"`` or ``"wrong"``; a number that is none is wrong."""
        return "right" if abs(self.got - self.expected) <= self.tolerance else "wrong"

    def to_dict(self) -> dict[str, object]:
        """Return fields and verdict as plain data."""
        return asdict(self) | {"verdict": self.verdict}


class Printed(TypedDict):
    """A case of ``printed.toml``: a number may differ by absolute + relative × number."""

    source: str
    problem: str
    bar: str
    absolute: NotRequired[float]
    relative: NotRequired[float]
    expected: dict[str, float]


@cache
def printed() -> Mapping[str, Printed]:
    """Return the cases of ``printed.toml``: source, tolerance and expected numbers by name."""
    text = resources.files("nacre.verify").joinpath("printed.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def names() -> tuple[str, ...]:
    """Return the names of all cases."""
    return tuple(printed())


def rows(cases: Iterable[str] | None = None) -> Iterator[Row]:
    """Compute the cases, one after the other, and yield their rows.

    Parameters
    ----------
    cases : iterable of str, optional
        Names of `names`; all by default.

    Yields
    ------
    Row
        Expected and computed number, and the tolerance.

    Raises
    ------
    ValueError
        If there is no such case.
    """
    wanted = list(names() if cases is None else cases)
    for name in wanted:
        if name not in printed():
            raise ValueError(f"cases must be of {', '.join(names())}, got {name!r}")
    return (row for name in wanted for row in _case_rows(name))


def _case_rows(name: str) -> Iterator[Row]:
    from nacre.verify.cases import CASES  # all of nacre, for what is computed alone

    case = printed()[name]
    computed = CASES[name]()
    for quantity, expected in case["expected"].items():
        tolerance = case.get("absolute", 0.0) + case.get("relative", 0.0) * abs(expected)
        yield Row(
            name,
            quantity,
            case["source"],
            expected,
            computed[quantity],
            0.0 if isinstance(expected, int) else tolerance,
        )
