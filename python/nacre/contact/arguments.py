"""Arguments of contacts in groups: the compiled module reads their fields by name.

They may be arrays, whose equality is no truth value: groups are not compared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, Self, TypedDict

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.groups import Group, keyword
from nacre._tools.typing import Algorithm, Along, Body, Direction, Matrix, along_axis
from nacre.contact.friction import FrictionReport, FrictionSolution, History
from nacre.contact.solution import Report, Solution
from nacre.hertz import Line

WIDTHS = 3.0
"""Half-widths of Hertz across a grid that holds a line contact, which takes two of them."""
Progress = Callable[[Report], object]
StepProgress = Callable[[int, FrictionReport], object]
"""Function that is told the number of a step and its report."""


@dataclass(frozen=True, eq=False)
class Motion(Group):
    """Motion of the shape along z."""

    load: float | None = keyword("N", line="N/m")
    approach: float | None = keyword("m")
    eccentricity: Along | None = keyword("m")
    moment: Along | None = keyword("N m", line="N")
    tilt: Along | None = keyword("rad")


MOTION = tuple(Motion.keywords())
"""Keywords of the motion along z."""


@dataclass(frozen=True, eq=False)
class Setup(Group):
    """Bodies and grid of a contact that is planned for one call."""

    body: Body
    counterbody: Body | None
    grid: core.Grid | None = keyword()
    max_cells: int | None = keyword()
    threads: int | None = keyword()

    def __post_init__(self) -> None:
        """Raise a `ValueError` if a grid is given, and how many cells one may have."""
        if self.max_cells is not None and self.grid is not None:
            raise ValueError(
                "max_cells must not be given beside grid: it limits a grid that is chosen"
            )

    def checked(self, shape: object, keywords: Mapping[str, Any]) -> Self:
        """Return the setup, or raise a `ValueError` that names a grid if a cylinder has none."""
        load, initial = keywords.get("load"), keywords.get("initial")
        given = self.grid is not None or initial is not None
        if given or not isinstance(shape, core.Cylinder) or math.isinf(shape.equivalent_radius):
            return self
        compliance = _compliance(self.body) + _compliance(self.counterbody)
        if compliance > 0 and isinstance(load, int | float) and 0 < load < math.inf:
            half_width = Line(shape.equivalent_radius, 1 / compliance, load).half_width
            raise ValueError(
                "grid must be given for a cylinder, whose contact is as long as the grid, such as "
                f"Grid.line(256, {WIDTHS * half_width:.3g}): {WIDTHS / 2:g} contacts of Hertz "
                f"under a load of {load:g} per unit length"
            )
        return self


def _compliance(body: Body | None) -> float:
    """Return 1/E* of the softest material of a body; 0 of a response, which has none."""
    if isinstance(body, core.Elastic):
        return 1 / body.plane_strain_modulus
    if not isinstance(body, core.HalfSpace):
        return 0.0
    parts = (body.substrate, *(layer.material for layer in body.layers))
    return max((_compliance(part) for part in parts if isinstance(part, core.Elastic)), default=0.0)


@dataclass(frozen=True, eq=False)
class SolveOptions(Group):
    """How a solution is found."""

    hardness: float | Matrix | None = keyword("Pa")
    compliance: float | Matrix | None = keyword("m/Pa")
    tolerance: float = keyword(default=1e-8)
    max_iterations: int | None = keyword()
    algorithm: Algorithm = keyword(default="cascade")
    initial: Solution | FrictionSolution | Matrix | None = keyword("Pa")
    progress: Progress | None = keyword()
    check: bool = keyword(default=True)


@dataclass(frozen=True, eq=False)
class FrictionStep(Group):
    """A step of sliding."""

    motion: Motion
    friction: npt.ArrayLike | None = keyword()
    shift: Along | None = keyword("m")
    force: Along | None = keyword("N", line="N/m")
    twist: float | None = keyword("rad")
    torque: float | None = keyword("N m", line="N")

    def __post_init__(self) -> None:
        """Raise a `TypeError` if the friction is a truth value."""
        _check_friction(self.friction)

    @classmethod
    def of(cls, keywords: Mapping[str, Any], *carried: Any) -> Self:
        """Return the step of its own keywords, with its motion along z."""
        return super().of(keywords, Motion.of(keywords), *carried)


STEP = (*MOTION, *FrictionStep.keywords())
"""Keywords of a step of a history."""


@dataclass(frozen=True, eq=False)
class Rolling(Group):
    """Rolling, steady or by so many cells."""

    motion: Motion
    friction: npt.ArrayLike | None = keyword()
    creepage: Along | None = keyword()
    force: Along | None = keyword("N", line="N/m")
    spin: float = keyword("1/m", default=0.0)
    direction: Direction | None = keyword()
    cells: int | None = keyword()
    order: Literal[1, 2] = keyword(default=2)

    @classmethod
    def of(cls, keywords: Mapping[str, Any], *carried: Any) -> Self:
        """Return the rolling of its own keywords, with its motion along z."""
        return super().of(keywords, Motion.of(keywords), *carried)

    def __post_init__(self) -> None:
        """Name the axis of the direction; a friction that is a truth value is a `TypeError`."""
        _check_friction(self.friction)
        object.__setattr__(self, "direction", along_axis(self.direction))


@dataclass(frozen=True, eq=False)
class FrictionOptions(Group):
    """How tractions are found."""

    tolerance: float = keyword(default=1e-8)
    max_convolutions: int = keyword(default=4000)
    coupling: bool = keyword(default=True)
    initial: FrictionSolution | History | None = keyword()
    progress: StepProgress | None = keyword()
    check: bool = keyword(default=True)


class MotionKeywords(TypedDict, total=False):
    """Keywords of `Motion`, as editors show them."""

    load: float | None
    approach: float | None
    eccentricity: Along | None
    moment: Along | None
    tilt: Along | None


class OptionKeywords(TypedDict, total=False):
    """Keywords of `Contact.solve_many`."""

    hardness: float | Matrix | None
    compliance: float | Matrix | None
    tolerance: float
    max_iterations: int | None
    algorithm: Algorithm
    check: bool


class SolveKeywords(MotionKeywords, OptionKeywords, total=False):
    """Keywords of `Contact.solve`."""

    initial: Solution | FrictionSolution | Matrix | None
    progress: Progress | None


class FrictionKeywords(MotionKeywords, total=False):
    """Keywords that `slide` and `roll` share."""

    friction: npt.ArrayLike | None
    force: Along | None
    tolerance: float
    max_convolutions: int
    coupling: bool
    initial: FrictionSolution | History | None
    progress: StepProgress | None
    check: bool


class SlideKeywords(FrictionKeywords, total=False):
    """Keywords of `Contact.slide`."""

    shift: Along | None
    twist: float | None
    torque: float | None


class RollKeywords(FrictionKeywords, total=False):
    """Keywords of `Contact.roll`."""

    creepage: Along | None
    spin: float
    direction: Direction | None
    order: Literal[1, 2]


class GridKeywords(TypedDict, total=False):
    """Keywords of the grid of a contact that is planned for one call."""

    grid: core.Grid | None
    max_cells: int | None
    threads: int | None


class PlannedSolveKeywords(SolveKeywords, GridKeywords):
    """Keywords of `nacre.solve`."""


class PlannedSlideKeywords(SlideKeywords, GridKeywords):
    """Keywords of `nacre.slide`."""


class PlannedRollKeywords(RollKeywords, GridKeywords):
    """Keywords of `nacre.roll`."""


def _check_friction(friction: npt.ArrayLike | None) -> None:
    """Raise a `TypeError` if a coefficient of friction is a truth value."""
    if np.asarray(friction).dtype.kind == "b":
        raise TypeError(f"friction must be a number, or one for each cell, got {friction!r}")
