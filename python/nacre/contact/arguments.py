"""Arguments of contacts in groups: the compiled module reads their fields by name.

They may be arrays, whose equality is no truth value: groups are not compared.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, Self, TypedDict

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.typing import Algorithm, Along, Body, Matrix
from nacre.contact.friction import FrictionReport, FrictionSolution, History
from nacre.hertz import Line

RollingDirection = Literal["+x", "-x", "+y", "-y"]
WIDTHS = 3.0
"""Half-widths of Hertz across a grid that holds a line contact, which takes two of them."""
StepProgress = Callable[[int, FrictionReport], object]
"""Function that is told the number of a step and its report."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of the shape along z."""

    load: float | None = None
    approach: float | None = None
    eccentricity: Along | None = None
    moment: Along | None = None
    tilt: Along | None = None

    @classmethod
    def of(cls, keywords: Mapping[str, Any]) -> Self:
        """Return the motion of those keywords that are among `MOTION`."""
        return cls(**{name: keywords[name] for name in MOTION if name in keywords})


MOTION = tuple(field.name for field in dataclasses.fields(Motion))
"""Keywords of the motion along z."""


@dataclass(frozen=True, eq=False)
class Setup:
    """Bodies and grid of a contact that is planned for one call."""

    body: Body
    counterbody: Body | None
    grid: core.Grid | None
    max_cells: int | None
    threads: int | None

    def __post_init__(self) -> None:
        """Raise a `ValueError` if a grid is given, and how many cells one may have."""
        if self.max_cells is not None and self.grid is not None:
            raise ValueError(
                "max_cells must not be given beside grid: it limits a grid that is chosen"
            )

    def check_end(self, shape: object, load: object, initial: object) -> None:
        """Raise a `ValueError` that names a grid if a cylinder has none."""
        given = self.grid is not None or initial is not None
        if given or not isinstance(shape, core.Cylinder):
            return
        compliance = _compliance(self.body) + _compliance(self.counterbody)
        if compliance > 0 and isinstance(load, int | float) and 0 < load < math.inf:
            half_width = Line(shape.equivalent_radius, 1 / compliance, load).half_width
            raise ValueError(
                "grid must be given for a cylinder, whose contact is as long as the grid, such as "
                f"Grid.line(256, {WIDTHS * half_width:.3g}): {WIDTHS / 2:g} contacts of Hertz "
                f"under a load of {load:g} per unit length"
            )


def _compliance(body: Body | None) -> float:
    """Return 1/E* of the softest material of a body; 0 of a response, which has none."""
    if isinstance(body, core.Elastic):
        return 1 / body.plane_strain_modulus
    if not isinstance(body, core.HalfSpace):
        return 0.0
    parts = (body.substrate, *(layer.material for layer in body.layers))
    return max((_compliance(part) for part in parts if isinstance(part, core.Elastic)), default=0.0)


@dataclass(frozen=True, eq=False)
class SolveOptions:
    """How a solution is found."""

    hardness: float | Matrix | None
    compliance: float | Matrix | None
    tolerance: float
    max_iterations: int | None
    algorithm: Algorithm
    initial: core.Solved | Matrix | None
    progress: Callable[..., object] | None
    check: bool


@dataclass(frozen=True, eq=False)
class FrictionStep:
    """A step of sliding."""

    motion: Motion
    friction: npt.ArrayLike | None = None
    shift: Along | None = None
    force: Along | None = None
    twist: float | None = None
    torque: float | None = None

    def __post_init__(self) -> None:
        """Raise a `TypeError` if the friction is a truth value."""
        _check_friction(self.friction)

    @classmethod
    def of(cls, keywords: Mapping[str, Any]) -> Self:
        """Return the step of these keywords, which are among `STEP`."""
        rest = {name: value for name, value in keywords.items() if name not in MOTION}
        return cls(Motion.of(keywords), **rest)


STEP = (*MOTION, *(field.name for field in dataclasses.fields(FrictionStep)[1:]))
"""Keywords of a step of a history."""


@dataclass(frozen=True, eq=False)
class Rolling:
    """Rolling, steady or by so many cells."""

    motion: Motion
    friction: npt.ArrayLike | None
    creepage: Along | None
    force: Along | None
    spin: float
    direction: RollingDirection | None
    cells: int | None
    order: Literal[1, 2]

    def __post_init__(self) -> None:
        """Raise a `TypeError` if the friction is a truth value."""
        _check_friction(self.friction)


@dataclass(frozen=True, eq=False)
class FrictionOptions:
    """How tractions are found."""

    tolerance: float
    max_convolutions: int
    coupling: bool
    initial: core.FrictionSolved | None
    progress: Callable[[int, str], object] | None
    check: bool


class FrictionKeywords(TypedDict, total=False):
    """Keywords that `slide` and `roll` share."""

    load: float | None
    approach: float | None
    eccentricity: Along | None
    moment: Along | None
    tilt: Along | None
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
    direction: RollingDirection | None
    order: Literal[1, 2]


class GridKeywords(TypedDict, total=False):
    """Keywords of the grid of a contact that is planned for one call."""

    grid: core.Grid | None
    max_cells: int | None
    threads: int | None


class PlannedSlideKeywords(SlideKeywords, GridKeywords):
    """Keywords of `nacre.slide`."""


class PlannedRollKeywords(RollKeywords, GridKeywords):
    """Keywords of `nacre.roll`."""


def _check_friction(friction: npt.ArrayLike | None) -> None:
    """Raise a `TypeError` if a coefficient of friction is a truth value."""
    if np.asarray(friction).dtype.kind == "b":
        raise TypeError(f"friction must be a number, or one for each cell, got {friction!r}")
