"""The contacts of Spinu et al., a coated sphere and a coated roller of finite length, solved."""

from __future__ import annotations

import itertools
import math
import os
import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

import nacre

Array = npt.NDArray[np.float64]

RATIOS = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Ratio of Young's moduli of the coating and the substrate, E1/E2."""

SUBSTRATE = nacre.Elastic(young=210e9, poisson=0.3)

# The sphere is the paraboloid of the reference values; load and radius are free, h/a_H = 1 is not.
SPHERE_RADIUS = 10e-3
HERTZ_RADIUS = 0.1e-3
SPHERE_LOAD = 4 / 3 * SUBSTRATE.plane_strain_modulus * HERTZ_RADIUS**3 / SPHERE_RADIUS
HERTZ_PRESSURE = 1.5 * SPHERE_LOAD / (math.pi * HERTZ_RADIUS**2)
HERTZ_APPROACH = HERTZ_RADIUS**2 / SPHERE_RADIUS

ROLLER_RADIUS = 5e-3
HALF_FLAT = 19.13e-3 / 2
"""L, half the length of the roller's cylindrical part [m]."""
CROWN_RADIUS = 7.5
ROLLER = nacre.Roller(ROLLER_RADIUS, flat_length=2 * HALF_FLAT, crown_radius=CROWN_RADIUS)
ROLLER_LOAD = 1e3

MAIN_THICKNESS = 0.04e-3
PRINTED_THICKNESS = 0.2e-3


@dataclass(frozen=True)
class Series:
    """One contact under a rigid body, solved for every ratio of moduli.

    `eccentricity` is None where tilting is locked. `quick_cells` are those of a first look.
    """

    name: str
    shape: nacre.Paraboloid | nacre.Roller
    load: float
    thickness: float
    eccentricity: tuple[float, float] | None
    size: tuple[float, float]
    cells: tuple[int, int]
    quick_cells: tuple[int, int]

    @property
    def title(self) -> str:
        """Name and thickness of the coating."""
        return f"{self.name}, h = {1e3 * self.thickness:g} mm"

    def body(self, ratio: float) -> nacre.HalfSpace:
        """Return the half-space whose coating has `ratio` times the substrate's modulus."""
        coating = nacre.Elastic(young=ratio * SUBSTRATE.young, poisson=SUBSTRATE.poisson)
        return nacre.HalfSpace(SUBSTRATE, layers=[nacre.Layer(coating, thickness=self.thickness)])

    def grid(self, *, quick: bool) -> nacre.Grid:
        """Return the grid, which holds the contact of the softest coating with a margin."""
        return nacre.Grid(shape=self.quick_cells if quick else self.cells, size=self.size)


def _roller(name: str, thickness: float, eccentricity: float) -> Series:
    # Odd numbers of cells put cell centres on both axes, where the figures are cut.
    return Series(
        name,
        ROLLER,
        ROLLER_LOAD,
        thickness,
        eccentricity=(eccentricity, 0.0),
        size=(31e-3, 0.18e-3),
        cells=(1125, 201),
        quick_cells=(225, 45),
    )


SPHERE = Series(
    "sphere",
    nacre.Paraboloid(SPHERE_RADIUS, SPHERE_RADIUS),
    SPHERE_LOAD,
    thickness=HERTZ_RADIUS,
    eccentricity=None,
    size=(6 * HERTZ_RADIUS, 6 * HERTZ_RADIUS),
    cells=(512, 512),
    quick_cells=(128, 128),
)
CENTRED = tuple(
    _roller("roller, centred", thickness, 0.0) for thickness in (MAIN_THICKNESS, PRINTED_THICKNESS)
)
ECCENTRIC = tuple(
    _roller("roller, e/L = 0.3", thickness, 0.3 * HALF_FLAT)
    for thickness in (MAIN_THICKNESS, PRINTED_THICKNESS)
)
SERIES = (SPHERE, CENTRED[0], ECCENTRIC[0], CENTRED[1], ECCENTRIC[1])
PROBLEM = (
    f"A rigid sphere (R = {1e3 * SPHERE_RADIUS:g} mm, W = {SPHERE_LOAD:.1f} N, hence a_H = "
    f"{1e3 * HERTZ_RADIUS:g} mm) and a rigid roller (R = {1e3 * ROLLER_RADIUS:g} mm, cylindrical "
    f"part 2L = {2e3 * HALF_FLAT:g} mm, R_a = {1e3 * CROWN_RADIUS:g} mm, W = {ROLLER_LOAD:g} N) "
    "on a coating of modulus E₁ and thickness h, bonded to a half-space of modulus "
    f"E₂ = {1e-9 * SUBSTRATE.young:g} GPa; ν = {SUBSTRATE.poisson:g} in both."
)
"""The problem in words."""


@dataclass(frozen=True)
class Result:
    """The solution of one series for one ratio of moduli."""

    series: Series
    ratio: float
    solution: nacre.Solution

    @property
    def riser(self) -> float:
        """Peak over central pressure."""
        return self.solution.peak_pressure / self.solution.central_pressure

    @property
    def half_width(self) -> float:
        """Half-width of the contact along y at x = 0 [m]."""
        return half_width(*self.profile("y"))

    def profile(self, axis: Literal["x", "y"]) -> tuple[Array, Array]:
        """Return coordinates [m] and pressures [Pa] of the line of cells along `axis`.

        The line is the one whose cell centres are nearest to the origin.
        """
        x, y, pressure = self.solution.x, self.solution.y, self.solution.pressure
        if axis == "x":
            return x, pressure[:, np.argmin(np.abs(y))]
        return y, pressure[np.argmin(np.abs(x)), :]


def solve(
    *,
    threads: int | None = None,
    quick: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> list[Result]:
    """Solve every case of Spinu et al.

    Parameters
    ----------
    threads
        Cases that are solved at a time, each on one thread; all of the machine's by default.
    quick
        Take coarse grids, for a first look: pressures err by a few per cent.
    progress
        Called after each solve with the number of solves done and that of all.

    Returns
    -------
    list of Result
        Series by series, in each the ratios from soft to stiff.

    Raises
    ------
    nacre.ConvergenceError
        Where a solve does not converge; a note says which.
    """
    if threads is None:
        threads = os.cpu_count() or 1
    cases = list(itertools.product(SERIES, RATIOS))
    stop = threading.Event()
    with ThreadPoolExecutor(threads) as pool:
        futures = [pool.submit(_solve, *case, quick=quick, stop=stop) for case in cases]
        try:
            for done, future in enumerate(as_completed(futures), start=1):
                future.result()
                if progress is not None:
                    progress(done, len(cases))
        except BaseException:
            stop.set()
            pool.shutdown(cancel_futures=True)
            raise
    return [future.result() for future in futures]


def _solve(series: Series, ratio: float, *, quick: bool, stop: threading.Event) -> Result:
    contact = nacre.Contact(series.body(ratio), series.grid(quick=quick), threads=1)
    try:
        solution = contact.solve(
            series.shape,
            load=series.load,
            eccentricity=series.eccentricity,
            progress=lambda report: not stop.is_set(),
        )
    except nacre.ConvergenceError as error:
        error.add_note(f"{series.title}, E1/E2 = {ratio:g}")
        raise
    return Result(series, ratio, solution)


def of_series(results: Iterable[Result], series: Series) -> list[Result]:
    """Return the results of one series, from soft to stiff."""
    return [result for result in results if result.series == series]


def half_width(y: Array, pressure: Array) -> float:
    """Return where `pressure` ends along `y`, for a contact symmetric in y.

    p² is linear in y² under a cylinder, and nearly so with a coating: it is continued to zero from
    the cells next to the outermost, whose own pressure is the least exact.
    """
    loaded = np.flatnonzero((pressure > 0) & (y >= 0))
    if len(loaded) < 3:
        return float(y[loaded[-1]] + 0.5 * (y[1] - y[0]))
    inner = loaded[-6:-1]
    slope, offset = np.polyfit(y[inner] ** 2, pressure[inner] ** 2, 1)
    return math.sqrt(-offset / slope)
