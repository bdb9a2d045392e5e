"""SciPy's linear operator for a convolution."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import nacre._core as core

if TYPE_CHECKING:
    from scipy.sparse.linalg import LinearOperator


def linear_operator(convolution: core.Convolution) -> LinearOperator:
    """Return the symmetric operator on pressures that are flattened in C order."""
    try:
        from scipy.sparse.linalg import LinearOperator
    except ModuleNotFoundError as missing:
        message = "this needs scipy: pip install scipy"
        raise ModuleNotFoundError(message, name=missing.name) from missing

    shape = convolution.shape
    cells = shape[0] * shape[1]

    def apply(pressure: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
        return convolution.apply(pressure.reshape(shape)).ravel()

    return LinearOperator((cells, cells), matvec=apply, rmatvec=apply, dtype=np.float64)
