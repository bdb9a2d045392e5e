"""The residual of any pressure, by nacre's exact influence coefficients.

The convolution is SciPy's, so that nacre is not judged by its own: `rfft` on the N rows that hold
data, `fft` on the columns, the product with the kernel's transform, and back. It is also what
nacre's convolution is timed against.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.fft

import nacre

Array = npt.NDArray[np.float64]


class Convolution:
    """The zero-padded convolution with `coefficients` (nx, ny) at offsets ≥ 0."""

    def __init__(self, coefficients: Array, workers: int = 1) -> None:
        self.workers = workers
        nx, ny = coefficients.shape
        kernel = np.zeros((2 * nx, 2 * ny))
        kernel[:nx, :ny] = coefficients
        kernel[nx + 1 :, :] = kernel[nx - 1 : 0 : -1, :]
        kernel[:, ny + 1 :] = kernel[:, ny - 1 : 0 : -1]
        # Even along both axes: the transform is real.
        self.spectrum = np.ascontiguousarray(scipy.fft.rfft2(kernel, workers=workers).real)

    def __call__(self, pressure: Array) -> Array:
        """Return the displacement."""
        (nx, ny), workers = pressure.shape, self.workers
        waves = scipy.fft.rfft(pressure, 2 * ny, axis=1, workers=workers)
        waves = scipy.fft.fft(waves, 2 * nx, axis=0, overwrite_x=True, workers=workers)
        waves *= self.spectrum
        waves = scipy.fft.ifft(waves, axis=0, overwrite_x=True, workers=workers)[:nx]
        rows = scipy.fft.irfft(waves, 2 * ny, axis=1, overwrite_x=True, workers=workers)
        return np.asarray(rows[:, :ny])


@dataclass(frozen=True)
class Verdict:
    """Errors of a pressure as a solution of the problem."""

    residual: float
    """Residual Σ p|g| / Σ p u."""
    overlap: float
    """Overlap max(−g, 0) / max u."""
    balance: float
    """Imbalance |Σ p dA − W| / W."""
    contact: float
    """Share of the cells that touch."""


def judge(
    pressure: Array, gaps: Array, body: nacre.HalfSpace, grid: nacre.Grid, load: float
) -> Verdict:
    """Judge a pressure under load control without tilt, by the definitions of `nacre.types.Report`.

    With the approach that is used, the mean gap over the contact is 0.
    """
    if grid.periodic == (True, True):
        return judge_periodic(pressure, gaps, grid, load)
    displacement = Convolution(nacre.influence_coefficients(body, grid))(pressure)
    touching = pressure > 0
    gap = gaps + displacement
    gap -= gap[touching].mean()
    dx, dy = grid.spacing
    return Verdict(
        residual=float(np.sum(pressure * np.abs(gap)) / np.sum(pressure * displacement)),
        overlap=float(max(-gap.min(), 0.0) / displacement.max()),
        balance=float(abs(pressure.sum() * dx * dy / load - 1)),
        contact=float(touching.mean()),
    )


def judge_periodic(pressure: Array, gaps: Array, grid: nacre.Grid, load: float) -> Verdict:
    """Judge a pressure that repeats on a bare body of E* = 1: every wave q has û = 2 p̂/q.

    The displacement has no mean; residual and overlap are relative to the rms height instead.
    """
    qx, qy = (
        2 * np.pi * scipy.fft.fftfreq(n, spacing)
        for n, spacing in zip(grid.shape, grid.spacing, strict=True)
    )
    q = np.hypot(qx[:, None], qy[None, :])
    q[0, 0] = np.inf
    displacement = scipy.fft.ifft2(2 / q * scipy.fft.fft2(pressure)).real
    touching = pressure > 0
    gap = gaps + displacement
    gap -= gap[touching].mean()
    height = gaps.std()
    dx, dy = grid.spacing
    return Verdict(
        residual=float(np.sum(pressure * np.abs(gap)) / (pressure.sum() * height)),
        overlap=float(max(-gap.min(), 0.0) / height),
        balance=float(abs(pressure.sum() * dx * dy / load - 1)),
        contact=float(touching.mean()),
    )
