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
Direction = tuple[float, float]
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
