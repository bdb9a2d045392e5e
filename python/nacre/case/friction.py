"""Tables of case files for contacts with friction."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

import nacre
from nacre.case.tables import Count, Directions, Number, Pair, Table, described, with_words

SLIDE = described(nacre.slide)
ROLL = described(nacre.roll)


class Along(Directions):
    """A value along x, along y, or both."""

    x: Number | None = Field(None, description="Value along x.")
    y: Number | None = Field(None, description="Value along y.")


class Rolling(Directions):
    """A value along the direction of rolling, across it, or both."""

    along: Number | None = Field(None, description="Value along the direction of rolling e.")
    across: Number | None = Field(None, description="Value along z × e.")


AnyAlong = Annotated[
    Along | Pair, with_words("a table with x, y or both, or a pair of finite numbers")
]
AnyRolling = Annotated[
    Rolling | Pair, with_words("a table with along, across or both, or a pair of finite numbers")
]


class Sliding(Table):
    """Keys of a step of sliding."""

    shift: AnyAlong | None = Field(None, description=SLIDE["shift"])
    force: AnyAlong | None = Field(None, description=SLIDE["force"])
    twist: Number | None = Field(None, description=SLIDE["twist"])
    torque: Number | None = Field(None, description=SLIDE["torque"])


class Step(Sliding):
    """A step of a history; what it does not give stays as in the step before."""

    load: Number | None = Field(None, description="Force that presses the bodies together [N].")
    approach: Number | None = Field(None, description="Approach [m], in place of a load.")
    friction: Number | None = Field(None, description="Coefficient of friction, at least 0.")


MOST_STEPS = 10_000
"""Largest number of steps: each takes a tenth of a second at least."""


class Slide(Sliding):
    """Friction: one tangential step, or a history of steps; load and tilts stand in `[solve]`."""

    friction: Number = Field(description="Coefficient of friction, at least 0.")
    steps: Annotated[list[Step], Field(max_length=MOST_STEPS)] | None = Field(
        None, description="Steps of a history; a line [[slide.steps]] begins each, too."
    )
    coupling: bool = Field(True, description=SLIDE["coupling"])

    def keywords(self) -> dict[str, Any]:
        """Return the keywords of `nacre.slide`."""
        arguments = super().keywords()
        if self.steps is not None:
            arguments["steps"] = [step.keywords() for step in self.steps]
        return arguments


class Roll(Table):
    """Rolling with friction at constant speed; load and tilts stand in `[solve]`."""

    friction: Number = Field(description="Coefficient of friction, at least 0.")
    creepage: AnyRolling | None = Field(None, description=ROLL["creepage"])
    force: AnyRolling | None = Field(None, description=ROLL["force"])
    spin: Number = Field(0.0, description=ROLL["spin"])
    direction: Literal["+x", "-x", "+y", "-y"] | None = Field(None, description=ROLL["direction"])
    cells: Count | None = Field(None, description=ROLL["cells"])
    order: Literal[1, 2] = Field(2, description=ROLL["order"])
    coupling: bool = Field(True, description=ROLL["coupling"])

    def keywords(self) -> dict[str, Any]:
        """Return the keywords of `nacre.roll`, with one at least that `nacre.slide` has not."""
        return {"spin": self.spin} | super().keywords()
