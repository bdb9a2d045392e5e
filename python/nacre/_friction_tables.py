"""Tables of case files for contacts with friction."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

import nacre
from nacre._case_tables import Count, Number, Pair, Table, Words, described

SLIDE = described(nacre.slide)
ROLL = described(nacre.roll)


class Along(Table):
    """A value along x, along y, or both."""

    x: Number | None = Field(None, description="Value along x.")
    y: Number | None = Field(None, description="Value along y.")


class Rolling(Table):
    """A value along the direction of rolling, across it, or both."""

    along: Number | None = Field(None, description="Value along the direction of rolling e.")
    across: Number | None = Field(None, description="Value along z × e.")


AnyAlong = Annotated[Along | Pair, Words("a table with x, y or both, or a pair of finite numbers")]
AnyRolling = Annotated[
    Rolling | Pair, Words("a table with along, across or both, or a pair of finite numbers")
]


def _keywords(table: Table, left_out: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the keys that were given as keywords."""
    found = {
        name: value
        for name, value in table
        if name in table.model_fields_set and name not in left_out
    }
    for name, value in found.items():
        if isinstance(value, Along):
            found[name] = (value.x, value.y)
        elif isinstance(value, Rolling):
            found[name] = (value.along, value.across)
        elif isinstance(value, list):
            found[name] = tuple(value)
    return found


class Step(Table):
    """A step of a history; what it does not give stays as in the step before."""

    load: Number | None = Field(None, description="Force that presses the bodies together [N].")
    approach: Number | None = Field(None, description="Approach [m], in place of a load.")
    friction: Number | None = Field(None, description="Coefficient of friction, at least 0.")
    shift: AnyAlong | None = Field(None, description=SLIDE["shift"])
    force: AnyAlong | None = Field(None, description=SLIDE["force"])
    twist: Number | None = Field(None, description=SLIDE["twist"])
    torque: Number | None = Field(None, description=SLIDE["torque"])


MOST_STEPS = 10_000
"""Largest number of steps: each takes a tenth of a second at least."""
Steps = Annotated[
    list[Step], Field(max_length=MOST_STEPS), Words(f"a list of tables, at most {MOST_STEPS}")
]


class Slide(Table):
    """Friction: one tangential step, or a history of steps; load and tilts stand in `[solve]`."""

    friction: Number = Field(description="Coefficient of friction, at least 0.")
    shift: AnyAlong | None = Field(None, description=SLIDE["shift"])
    force: AnyAlong | None = Field(None, description=SLIDE["force"])
    twist: Number | None = Field(None, description=SLIDE["twist"])
    torque: Number | None = Field(None, description=SLIDE["torque"])
    steps: Steps | None = Field(
        None, description="Steps of a history; a line [[slide.steps]] begins each, too."
    )
    coupling: bool = Field(True, description=SLIDE["coupling"])

    def keywords(self) -> dict[str, Any]:
        """Return the keywords of `nacre.slide`."""
        found = _keywords(self, ("steps",))
        if self.steps is not None:
            found["steps"] = [_keywords(step) for step in self.steps]
        return found


class Roll(Table):
    """Rolling with friction at constant speed; load and tilts stand in `[solve]`."""

    friction: Number = Field(description="Coefficient of friction, at least 0.")
    creepage: AnyRolling | None = Field(None, description=ROLL["creepage"])
    force: AnyRolling | None = Field(None, description=ROLL["force"])
    spin: Number = Field(0.0, description=ROLL["spin"])
    direction: Literal["+x", "-x", "+y", "-y"] | None = Field(None, description=ROLL["direction"])
    cells: Count | None = Field(None, description=ROLL["cells"])
    coupling: bool = Field(True, description=ROLL["coupling"])

    def keywords(self) -> dict[str, Any]:
        """Return the keywords of `nacre.roll`, with one at least that `nacre.slide` has not."""
        return {"spin": self.spin} | _keywords(self)
