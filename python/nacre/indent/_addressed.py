"""Arguments of an indentation, which a fit writes parameters into."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.notices import heard
from nacre._tools.paths import numbered, numbers
from nacre.indent.solution import Indentation, IndentCurve

Value = TypeVar("Value")
Array = npt.NDArray[np.float64]

INCOMPRESSIBLE = 0.4999
"""Least Poisson's ratio with respect to which no fit has a slope."""


@dataclass(frozen=True)
class System:
    """Arguments of an indentation, which parameters are written into."""

    body: core.HalfSpace
    tip: core.Tip
    counterbody: core.HalfSpace | None
    adhesion: core.Adhesion | None

    @classmethod
    def of(
        cls,
        body: core.HalfSpace | core.Elastic,
        tip: core.Tip,
        counterbody: core.HalfSpace | core.Elastic | None = None,
        adhesion: core.Adhesion | None = None,
    ) -> System:
        """Return the system of these arguments, elastic materials as half-spaces."""
        half_space = core.HalfSpace(body) if isinstance(body, core.Elastic) else body
        if isinstance(counterbody, core.Elastic):
            counterbody = core.HalfSpace(counterbody)
        return cls(half_space, tip, counterbody, adhesion)

    def values(self) -> dict[str, float]:
        """Return the value of each parameter that may be free, by its path."""
        parameters = numbers(vars(self)) | {"tip.area": 1.0}
        indentation = core.Indentation(self.body, self.tip, self.counterbody, self.adhesion)
        return {k: parameters[k] for k in indentation.parameters() if k != "adhesion.strength"}

    def by_number(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Return values by path with the numbers of layers in place of their names."""
        return dict(zip(numbered(vars(self), values), values.values(), strict=True))

    def held(self, free: Sequence[str]) -> dict[str, float]:
        """Return what a fit with these free parameters holds, and of which estimates have a slope.

        An area of the tip stands for a tip without numbers of its own.
        """
        values = self.values()
        of_tip = [path for path in values if path.startswith("tip.")]
        other = of_tip if "tip.area" in free else ["tip.area"] if len(of_tip) > 1 else []
        return {
            path: value
            for path, value in values.items()
            if path not in (*free, *other)
            and (0 <= value < INCOMPRESSIBLE if path.endswith(".poisson") else value > 0)
        }

    def with_values(self, values: Mapping[str, float]) -> System:
        """Return the system with other values of some parameters, but for the area of the tip."""
        fields = vars(self)
        for path, value in values.items():
            if path != "tip.area":
                fields = core.with_value(fields, path, value)
        return System(**fields)

    def narrower_system(self, factor: float) -> System:
        """Return the system with lateral lengths divided by a factor, but for those of the tip."""
        values = {k: v / factor for k, v in self.values().items() if k.endswith(".thickness")}
        if self.adhesion is not None:
            values["adhesion.work"] = self.adhesion.work * factor
        return self.with_values(values)

    def curve(self, approach: Array, wrt: Sequence[str] = ()) -> IndentCurve:
        """Return the loads at these approaches, without issuing the warnings that they hold."""
        indentation = Indentation(self.body, self.tip, self.counterbody, adhesion=self.adhesion)
        with heard():  # of places on the way to a fit
            return indentation.curve(approach=approach, wrt=wrt)
