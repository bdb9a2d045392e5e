"""Compare `nacre.design.optimise` with Nelder–Mead: `python benches/optimise.py [CELLS_X CELLS_Y]`.

Fujiwara and Kawase's K1, K2 and zm for a steel roller of 10 mm × 12 mm on a race of 50 mm under
5 kN, at tilts of 0, 0.5 and 1 mrad: the norm of exponent 16 over the cells of the three contacts is
minimised. Nelder–Mead has three starts, the same bounds and logarithms, and stops at 1e-4 in both
the parameters and the objective. Every contact counts as a solve, and so does every derivative.
"""

from __future__ import annotations

import sys
import time
import warnings

import numpy as np
from scipy.optimize import minimize

import nacre
from nacre import design

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
MODULUS = STEEL.plane_strain_modulus / 2
LENGTH, LOAD, ORDER = 12e-3, 5e3, 16.0
TILTS = (0.0, 0.5e-3, 1e-3)
BOUNDS = {"k1": (0.1, 20.0), "k2": (0.05, 1.0), "zm": (1e-6, 1e-4)}
STARTS = ((1.0, 0.6, 10e-6), (2.0, 0.9, 30e-6), (0.5, 0.8, 20e-6))


def build(k1: float, k2: float, zm: float) -> dict[str, object]:
    """Return the arguments of a solve for these parameters."""
    profile = nacre.LogarithmicProfile.fujiwara_kawase(LENGTH, LOAD, MODULUS, k1, k2, zm)
    roller = nacre.Roller(radius=5e-3, length=LENGTH, profile=profile, counter_radius=25e-3)
    return {"shape": roller, "body": STEEL, "counterbody": STEEL}


def simplex(start: tuple[float, ...], grid: nacre.Grid) -> tuple[float, list[float], int]:
    """Return the optimum, the parameters and the number of solves of Nelder–Mead."""
    plan = nacre.Contact(STEEL, grid, STEEL)
    last: list[nacre.Solution | None] = [None] * len(TILTS)
    solves = 0

    def norm(x: np.ndarray) -> float:
        nonlocal solves
        shape = build(*np.exp(x))["shape"]
        total = 0.0
        for k, tilt in enumerate(TILTS):
            last[k] = plan.solve(
                shape, load=LOAD, tilt=(tilt, None), tolerance=1e-9, initial=last[k]
            )
            solves += 1
            total += np.prod(grid.spacing) * (last[k].pressure ** ORDER).sum()
        return float((total / len(TILTS)) ** (1 / ORDER))

    box = [tuple(np.log(BOUNDS[name])) for name in BOUNDS]
    first = norm(np.log(start))
    found = minimize(
        lambda x: norm(x) / first,
        np.log(start),
        method="Nelder-Mead",
        bounds=box,
        options={"xatol": 1e-4, "fatol": 1e-4, "maxfev": 400},
    )
    return found.fun * first, list(np.exp(found.x)), solves


def main() -> None:
    """Print a row for each search."""
    cells = tuple(map(int, sys.argv[1:3])) or (64, 24)
    grid = nacre.Grid(cells, (LENGTH, 1e-3))
    for start in STARTS:
        began = time.perf_counter()
        best = design.optimise(
            build,
            dict(zip(BOUNDS, start, strict=True)),
            objective=("pressure_norm", ORDER),
            across=ORDER,
            cases=[{"load": LOAD, "tilt": (tilt, None)} for tilt in TILTS],
            bounds=BOUNDS,
            grid=grid,
        )
        row("gradients", start, best.objective, list(best.values.values()), best.solves, began)
    for start in STARTS:
        began = time.perf_counter()
        row("Nelder–Mead", start, *simplex(start, grid), began)


def row(
    method: str, start: tuple[float, ...], value: float, x: list[float], solves: int, began: float
) -> None:
    """Print the row of a search."""
    found = ", ".join(f"{v:.4g}" for v in x)
    seconds = time.perf_counter() - began
    print(
        f"{method:12} {start}: {value:.6g} at {found}; {solves} solves, {seconds:.0f} s", flush=True
    )


if __name__ == "__main__":
    warnings.filterwarnings("ignore", category=nacre.NacreWarning)
    main()
