"""Arguments of the solve of a bearing, in groups."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypedDict

import nacre._core as core
from nacre._tools.groups import Group, keyword
from nacre._tools.progress import check_progress
from nacre._tools.typing import among
from nacre.bearing.geometry import RINGS, Bearing, Ring, above

Model = Literal["solved", "iso16281"]
Along = Sequence[float | None] | None

TURNED = 1e6
"""Largest angle of the elements [rad], which is right to 1e-10."""
FASTEST = 1e3
"""Largest speed of the elements [m/s], at which rings of steel burst."""


@dataclass(frozen=True)
class RingConditions(Group):
    """Loads and displacements of the inner ring."""

    force: Along = keyword("N")
    displacement: Along = keyword("m")
    moment: Along = keyword("N m")
    tilt: Along = keyword("rad")


@dataclass(frozen=True)
class Operation(Group):
    """Where the elements are, how fast they move, and what is required of them."""

    rotation: float = keyword("rad", default=0.0)
    speed: float = keyword("rad/s", default=0.0)
    rotating: Ring = keyword(default="inner")
    required_life: float | None = keyword()
    static_safety: float | None = keyword()

    def checked(self, bearing: Bearing) -> Operation:
        """Return the operation with Python's numbers, or raise an error."""
        rotation = above("rotation", self.rotation, -math.inf)
        speed, rotating = above("speed", self.speed, -math.inf, "rad/s"), self.rotating
        if not among(rotating, RINGS):
            raise ValueError(f'rotating must be "inner" or "outer", got {rotating!r}')
        if abs(rotation) > TURNED:
            raise ValueError(f"rotation must be at most {TURNED:g} rad, got {rotation!r} rad")
        if abs(bearing.cage_speed(speed, rotating)) * bearing.pitch / 2 > FASTEST:
            raise ValueError(
                f"speed must be lower: elements must move at {FASTEST:g} m/s at most, "
                f"got {speed!r} rad/s: is it in 1/min?"
            )
        if self.required_life is not None and speed == 0:
            raise ValueError(
                "required_life must be given with a speed, got none: there are no hours"
            )
        needs = {name: getattr(self, name) for name in ("required_life", "static_safety")}
        needs = {k: value if value is None else above(k, value) for k, value in needs.items()}
        return Operation(rotation, speed, rotating, **needs)


@dataclass(frozen=True)
class BearingOptions(Group):
    """How a bearing is solved."""

    model: Model = keyword(default="solved")
    cells: tuple[int, int] | None = keyword()
    tolerance: float = keyword(default=1e-9)
    max_iterations: int = keyword(default=50)
    threads: int | None = keyword()
    progress: Callable[[int, float], object] | None = keyword()
    check: bool = keyword(default=True)

    def checked(self, bearing: Bearing) -> BearingOptions:
        """Return the options with Python's numbers, or raise an error."""
        max_iterations = _positive("max_iterations", self.max_iterations)
        threads = None if self.threads is None else _positive("threads", self.threads)
        if not among(self.model, ("solved", "iso16281")):
            raise ValueError(f'model must be "solved" or "iso16281", got {self.model!r}')
        check_progress(self.progress)
        tolerance = above("tolerance", self.tolerance)
        if tolerance >= 1:
            raise ValueError(f"tolerance must be above 0 and below 1, got {tolerance!r}")
        given = bearing.usual_cells if self.cells is None else self.cells
        one, other = core.vector("cells", 2, given)
        cells = core.integer("cells", one), core.integer("cells", other)
        multiple = bearing.cells_multiple
        if min(cells) < 8 or cells[0] % multiple:
            words = f", the first a multiple of {multiple}" if multiple > 1 else ""
            raise ValueError(f"cells must be two numbers of at least 8{words}, got {cells!r}")
        return replace(
            self, cells=cells, tolerance=tolerance, max_iterations=max_iterations, threads=threads
        )


class BearingKeywords(TypedDict, total=False):
    """Keywords of `solve`, as editors show them."""

    force: Along
    displacement: Along
    moment: Along
    tilt: Along
    rotation: float
    speed: float
    rotating: Ring
    model: Model
    cells: tuple[int, int] | None
    tolerance: float
    max_iterations: int
    threads: int | None
    progress: Callable[[int, float], object] | None
    check: bool
    required_life: float | None
    static_safety: float | None


def _positive(name: str, value: object) -> int:
    """Return an integer of at least 1, or raise an error."""
    number = core.integer(name, value)
    if number < 1:
        raise ValueError(f"{name} must be at least 1, got {number!r}")
    return number
