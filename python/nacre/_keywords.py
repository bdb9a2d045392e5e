"""Types of the keywords of solves and stresses: for type stubs, and for the tables of case files.

The compiled module has the signatures with the defaults; a test compares the two.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict

import numpy as np
import numpy.typing as npt

Along = tuple[float | None, float | None]
"""Values along x and y; None where one is not given."""
Direction = tuple[float, float]
Side = Literal["below", "above"]
Member = Literal["body", "counterbody"]
ByLayer = Mapping[int | str, float] | Sequence[float | None]
"""Values from the surface down; or by number or name of a layer, or "substrate"."""


class Threads(TypedDict, total=False):
    """Number of threads."""

    threads: int | None


class Plan(Threads, total=False):
    """Keywords of `Contact`."""

    coefficients: Sequence[Sequence[float]] | npt.NDArray[np.floating | np.integer] | None


class Motion(TypedDict, total=False):
    """Keywords that say what is asked of the rigid motion."""

    load: float | None
    approach: float | None
    eccentricity: Along | None
    moment: Along | None
    tilt: Along | None


class Search(TypedDict, total=False):
    """Keywords that say how a solution is found."""

    hardness: float | Sequence[Sequence[float]] | npt.NDArray[np.floating | np.integer] | None
    tolerance: float
    max_iterations: int | None
    algorithm: Literal["cascade", "polonsky-keer"]
