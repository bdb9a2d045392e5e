"""What is solved. Every program gets the same array of gaps, the same size and the same load.

The body is a half-space of E* = 1 and the shape is rigid; the domain is a square of side 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

import nacre

Array = npt.NDArray[np.float64]
Waves = npt.NDArray[np.complex128]
Name = Literal["hertz", "coated", "rough", "periodic", "opened", "roller"]

SIDE = 2.0
"""Side of the domain."""
TOLERANCE = 1e-8
"""Residual that every program must reach."""

HERTZ_RADIUS = 1e3
CONTACT_RADIUS = SIDE / 6
HERTZ_LOAD = 4 / 3 * CONTACT_RADIUS**3 / HERTZ_RADIUS

HURST = 0.8
LONGEST_WAVE = SIDE / 2
"""Longest wave of the rough surface; longer ones have no amplitude."""
SHORTEST_CELLS = 8
"""Shortest wave in cells. Between both, the spectral density falls as q^(−2(H+1))."""
MEAN_PRESSURE = 0.04
"""Mean pressure in units of E*, for which about 8 % of the cells touch."""
SEED = 2026


@dataclass(frozen=True)
class Problem:
    """One problem on one grid.

    `periodic` is rough, and repeats; all programs take its waves alike, nacre by `coefficients`.
    `opened` is the same surface once, which nacre alone solves.
    `coated` is `hertz` on a layer as thick as the contact radius, of four times the modulus;
    `roller` is that of Spinu et al., on 1024 × 128 cells, under a force at e/L = 0.3. nacre alone
    solves these two.
    """

    name: Name
    cells: int

    @property
    def grid(self) -> nacre.Grid:
        """The grid."""
        if self.name == "roller":
            return nacre.Grid(shape=(self.cells, self.cells // 8), size=(29e-3, 0.16e-3))
        repeats = (self.repeats, self.repeats)
        return nacre.Grid(shape=(self.cells, self.cells), size=(SIDE, SIDE), periodic=repeats)

    @property
    def repeats(self) -> bool:
        """Whether the surface repeats along both sides."""
        return self.name == "periodic"

    def coefficients(self) -> Array | None:
        """Return the influence coefficients that nacre is given; its own where None."""
        if not self.repeats:
            return None
        return nacre.influence_coefficients(self.body, self.grid, "spectral")

    @property
    def body(self) -> nacre.HalfSpace:
        """The elastic body."""
        if self.name == "roller":
            steel, hard = nacre.Elastic(210e9, 0.3), nacre.Elastic(840e9, 0.3)
            return nacre.HalfSpace(steel, layers=[nacre.Layer(hard, thickness=40e-6)])
        bare = nacre.Elastic(young=1.0, poisson=0.0)
        if self.name == "coated":
            hard = nacre.Elastic(young=4.0, poisson=0.0)
            return nacre.HalfSpace(bare, layers=[nacre.Layer(hard, thickness=CONTACT_RADIUS)])
        return nacre.HalfSpace(bare)

    @property
    def load(self) -> float:
        """The force."""
        if self.name == "roller":
            return 1e3
        is_rough = self.name in ("rough", "periodic", "opened")
        return MEAN_PRESSURE * SIDE**2 if is_rough else HERTZ_LOAD

    @property
    def eccentricity(self) -> tuple[float, float] | None:
        """Where the force acts, if tilting is free."""
        return (0.3 * 9.565e-3, 0.0) if self.name == "roller" else None

    def shape(self, gaps: Array | None = None) -> nacre.types.Shape:
        """Return the shape; of the rough surface, that of `gaps`."""
        match self.name:
            case "roller":
                return nacre.Roller(5e-3, flat_length=19.13e-3, crown_radius=7.5)
            case "rough" | "periodic" | "opened":
                gaps = self.gaps() if gaps is None else gaps
                spacing, repeats = SIDE / self.cells, (self.repeats, self.repeats)
                return nacre.HeightMap(-gaps, spacing=spacing, periodic=repeats)
            case "hertz" | "coated":
                return nacre.Paraboloid(HERTZ_RADIUS, HERTZ_RADIUS)

    def gaps(self) -> Array:
        """Return the undeformed gap at cell centres, that of the highest point 0 when rough."""
        if self.name in ("rough", "periodic", "opened"):
            make = rough_heights if self.name == "rough" else periodic_heights
            heights = make(self.cells)
            return np.asarray(heights.max() - heights)
        return self.shape().gaps(self.grid)


def rough_heights(cells: int, seed: int = SEED) -> Array:
    """Return a self-affine surface (cells, cells) of rms slope 1 that is not periodic.

    It is a quarter of a periodic surface of twice the side; the rms slope is that of the quarter,
    of the derivatives of the waves.
    """
    n = 2 * cells
    waves, qx, qy = rough_waves(n, SIDE / cells, seed)

    def quarter(spectrum: Waves) -> Array:
        return np.asarray(np.fft.irfft2(spectrum, s=(n, n))[:cells, :cells])

    slope = np.sqrt(np.mean(quarter(1j * qx * waves) ** 2 + quarter(1j * qy * waves) ** 2))
    return np.ascontiguousarray(quarter(waves) / slope)


def periodic_heights(cells: int, seed: int = SEED) -> Array:
    """Return a self-affine surface (cells, cells) of rms slope 1 and period SIDE."""
    waves, qx, qy = rough_waves(cells, SIDE / cells, seed)
    shape = (cells, cells)
    parts = [np.fft.irfft2(1j * q * waves, s=shape) for q in (qx, qy)]
    slope = np.sqrt(sum(np.mean(part**2) for part in parts))
    return np.ascontiguousarray(np.fft.irfft2(waves, s=shape) / slope)


def rough_waves(n: int, spacing: float, seed: int) -> tuple[Waves, Array, Array]:
    """Return waves of a periodic surface of n × n points, and their wavenumbers along x and y.

    Their phases are random, and their amplitudes those of the spectral density

        C(q) ~ q^(−2(H+1))    for 2π/LONGEST_WAVE ≤ q ≤ 2π/(SHORTEST_CELLS spacings), else 0.
    """
    qx = np.asarray(2 * np.pi * np.fft.fftfreq(n, spacing)[:, None], np.float64)
    qy = np.asarray(2 * np.pi * np.fft.rfftfreq(n, spacing)[None, :], np.float64)
    q = np.hypot(qx, qy)
    inside = (q >= 2 * np.pi / LONGEST_WAVE) & (q <= 2 * np.pi / (SHORTEST_CELLS * spacing))
    amplitude = np.where(inside, q, 1.0) ** -(HURST + 1) * inside
    # The phases of a real white noise: their symmetry is that of a real surface.
    noise = np.fft.rfft2(np.random.default_rng(seed).standard_normal((n, n)))
    return amplitude * noise / np.maximum(np.abs(noise), np.finfo(float).tiny), qx, qy
