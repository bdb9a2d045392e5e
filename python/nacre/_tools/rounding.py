"""Whole numbers from ratios that carry rounding, such as the number of cells in a length."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

ROUNDING = 1e-9
"""Largest rounding of a ratio, as a part of it or of 1."""


def floor(ratio: npt.ArrayLike) -> npt.NDArray[np.intp]:
    """Return the largest whole numbers that are above ratios by no more than rounding."""
    ratios = np.asarray(ratio, dtype=np.float64)
    return np.floor(ratios + ROUNDING * np.maximum(np.abs(ratios), 1.0)).astype(np.intp)


def ceil(ratio: npt.ArrayLike) -> npt.NDArray[np.intp]:
    """Return the smallest whole numbers that are below ratios by no more than rounding."""
    return -floor(-np.asarray(ratio, dtype=np.float64))
