"""Tables of case files for contacts with friction."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

import nacre
from nacre._tools.arguments import keywords_of
from nacre.case.tables import Directions, Number, Pair, Table, from_signature, with_words

SHARED = keywords_of(nacre.solve)
"""Keywords that stand in `[solve]`."""
OF_HISTORY = keywords_of(nacre.slide) & keywords_of(nacre.roll) - {"force"}
"""Keywords of how steps are solved, which are those of rolling, too."""


class Rolling(Directions):
    """A value along the direction of rolling, across it, or both."""

    along: Number | None = Field(None, description="Value along the direction of rolling e.")
    across: Number | None = Field(None, description="Value along z × e.")


AnyRolling = Annotated[
    Rolling | Pair, with_words("a table with along, across or both, or a pair of finite numbers")
]


@from_signature(nacre.slide, {*SHARED, *OF_HISTORY})
class Sliding(Table):
    """Keys of a step of sliding."""


class Step(Sliding):
    """A step of a history; what it does not give stays as in the step before."""

    load: Number | None = Field(
        None,
        description="Force that presses the bodies together [N].",
        json_schema_extra={"unit": "N", "unit_of_lines": "N/m"},
    )
    approach: Number | None = Field(None, description="Approach [m], in place of a load.")
    friction: Number | None = Field(None, description="Coefficient of friction, at least 0.")


MOST_STEPS = 10_000
"""Largest number of steps: each takes a tenth of a second at least."""


@from_signature(nacre.slide, SHARED)
class Slide(Sliding):
    """Friction: one tangential step, or a history of steps; load and tilts stand in `[solve]`."""

    friction: Number = Field(description="Coefficient of friction, at least 0.")
    steps: Annotated[list[Step], Field(max_length=MOST_STEPS)] | None = Field(
        None, description="Steps of a history; a line [[slide.steps]] begins each, too."
    )

    def keywords(self) -> dict[str, Any]:
        """Return the keywords of `nacre.slide`."""
        arguments = super().keywords()
        if self.steps is not None:
            arguments["steps"] = [step.keywords() for step in self.steps]
        return arguments


@from_signature(nacre.roll, SHARED, creepage=AnyRolling, force=AnyRolling)
class Roll(Table):
    """Rolling with friction at constant speed; load and tilts stand in `[solve]`."""

    friction: Number = Field(description="Coefficient of friction, at least 0.")
    if TYPE_CHECKING:
        spin: float

    def keywords(self) -> dict[str, Any]:
        """Return the keywords of `nacre.roll`, with one at least that `nacre.slide` has not."""
        return {"spin": self.spin} | super().keywords()
