"""Types of arguments and results."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from typing import Literal, Protocol

import numpy as np
import numpy.typing as npt

import nacre._core as core

Field = npt.NDArray[np.float64]
Real = npt.NDArray[np.floating | np.integer]
Vector = Real | Sequence[float]
Matrix = Real | Sequence[Sequence[float] | Real]
Layers = core.HalfSpace | core.Elastic
"""Body whose layers are known, or the material that fills one."""
Body = Layers | core.Response
Planned = core.HalfSpace | core.Response
"""Body of a plan or a report, where a material has become a half-space."""
AnyPath = str | os.PathLike[str]
Pair = tuple[float, float]
Along = tuple[float | None, float | None]
"""Values along x and y; None where one is not given."""
Direction = tuple[float, float] | Literal["+x", "-x", "+y", "-y"]
"""Direction in the plane: its components, of any length, or an axis with its sign."""
AXES: dict[str, Pair] = {"+x": (1.0, 0.0), "-x": (-1.0, 0.0), "+y": (0.0, 1.0), "-y": (0.0, -1.0)}
"""Components of the directions of the axes."""
_WORDS = '"+x", "-x", "+y" or "-y"'
Side = Literal["below", "above"]
Member = Literal["body", "counterbody"]
ByLayer = Mapping[int | str, float] | Sequence[float | None]
"""Values from the surface down; or by number or name of a layer, or "substrate"."""
Algorithm = Literal["cascade", "polonsky-keer"]
Ending = Literal["running", "converged", "iteration limit", "stopped"]
"""How an iteration ended; "running" before its end."""


def among(value: object, words: Collection[str | None]) -> bool:
    """Return whether a value is one of some words; arrays and lists are none."""
    return isinstance(value, str | None) and value in words


def components(direction: Direction | None) -> Pair | None:
    """Return the components of a direction; what is not a direction stays, for other checks."""
    if not isinstance(direction, str):
        return direction
    if direction not in AXES:
        raise ValueError(f"direction must be a pair of numbers, or {_WORDS}, got {direction!r}")
    return AXES[direction]


def along_axis(direction: Direction | None) -> str | None:
    """Return the axis along which a direction lies, with its sign."""
    if direction is None or isinstance(direction, str):
        return direction
    x, y = core.vector("direction", 2, direction)
    x, y = core.real("direction", x), core.real("direction", y)
    if (x == 0) == (y == 0):
        raise ValueError(f"direction must be {_WORDS}, or a pair along an axis, got {direction!r}")
    return next(axis for axis, (a, b) in AXES.items() if a * x + b * y > 0)


class Topography(Protocol):
    """A topography of SurfaceTopography."""

    @property
    def dim(self) -> int:
        """Number of dimensions."""

    @property
    def unit(self) -> str | None:
        """Unit of length."""

    @property
    def physical_sizes(self) -> tuple[float, ...] | None:
        """Side lengths."""

    def heights(self) -> npt.NDArray[np.floating]:
        """Return the heights."""
