"""Best profiles of a roller by `nacre.design.optimise`: docs/optimal_profiles.csv.

A steel roller of 10 mm × 12 mm on a race of 50 mm starts straight. Its drop rises from each column
of cells to the next by a parameter of its own, and the norm of the pressure is minimised at
exponents of 16, 64 and 256 in turn. The drop at the middle is 0. The CSV has two studies.

`lundberg`: the best profile of a bare roller without tilt, at its design load. Over the middle 90 %
of the length, it is compared with Lundberg's profile; with the displacement of the pressure that
Lundberg assumes, Hertz's across the roller and equal up to the ends, by quadrature; and with the
profile of equal peaks in all columns, which an iteration without derivatives finds. Deviations are
in percent of Lundberg's drop at 0.45 of the length.

`coated`: the profiles that are best for a bare and for a coated roller at tilts of 0, 0.5 and
1 mrad, and both profiles on the coated roller: the largest pressure and the largest tension in the
coating, over the tilts. Both are taken inside 0.485 of the length, too: the ends are sharp edges,
where pressures and tensions grow as cells shrink.

    .venv/bin/python benches/profiles.py
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.integrate import quad

import nacre
from nacre import design

ROOT = Path(__file__).resolve().parents[1]
Array = npt.NDArray[np.float64]

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
MODULUS = STEEL.plane_strain_modulus / 2
RADIUS, COUNTER_RADIUS, LENGTH = 5e-3, 25e-3, 12e-3
EXPONENTS = (16.0, 64.0, 256.0)
TILTS = (0.0, 0.5e-3, 1e-3)
COATINGS = {
    "polymer, 100 µm, 3.5 GPa": (500.0, nacre.Layer(nacre.Elastic(3.5e9, 0.4), 100e-6), 8.0),
    "ceramic, 50 µm, 400 GPa": (1e3, nacre.Layer(nacre.Elastic(400e9, 0.2), 50e-6), 2.0),
}
"""Load, coating, and half the width of the grid over that of Hertz's contact of the bare roller."""
BAR = 3.0
"""Largest deviation from Lundberg's profile [%] that counts as equal."""


def hertz(load: float) -> nacre.hertz.Line:
    """Return Hertz's contact of the straight roller, without ends."""
    radius = nacre.hertz.equivalent_radius(RADIUS, COUNTER_RADIUS)
    return nacre.hertz.Line(radius, MODULUS, load / LENGTH)


def shape(x: Array, drop: Array) -> nacre.Roller:
    """Return the roller with these drops at columns x > 0, and on the other side."""
    # Cells are averages: the drop goes on to the end as it rose before.
    end = drop[-1] + (drop[-1] - drop[-2]) * (LENGTH / 2 - x[-1]) / (x[-1] - x[-2])
    place, height = np.array([0.0, *x, LENGTH / 2]), np.array([0.0, *drop, end])
    profile = np.r_[-place[:0:-1], place], np.r_[height[:0:-1], height]
    return nacre.Roller(RADIUS, length=LENGTH, profile=profile, counter_radius=COUNTER_RADIUS)


def columns(grid: nacre.Grid) -> Array:
    """Return the places of the columns of cells at x > 0."""
    return grid.x[grid.x > 0]


def optimised(
    grid: nacre.Grid,
    load: float,
    body: nacre.HalfSpace | nacre.Elastic = STEEL,
    tilts: Sequence[float] = (0.0,),
    exponents: Sequence[float] = EXPONENTS,
    tolerance: float = 1e-5,
) -> tuple[Array, list[design.Optimum]]:
    """Return the best drops of the columns, and the optimum of each exponent."""
    x = columns(grid)
    amplitude = load / (math.pi * LENGTH * MODULUS)
    start = dict.fromkeys([f"rise{k}" for k in range(len(x))], 0.0)

    def build(**rises: float) -> dict[str, Any]:
        made = shape(x, np.cumsum(list(rises.values())))
        return {"shape": made, "body": body, "counterbody": STEEL, "threads": 1}

    found = []
    for exponent in exponents:
        best = design.optimise(
            build,
            start,
            objective=("pressure_norm", exponent),
            across=exponent,
            cases=[{"load": load, "tilt": (tilt, None)} for tilt in tilts],
            bounds=dict.fromkeys(start, (0.0, 4 * amplitude)),
            grid=grid,
            tolerance=tolerance,
            max_solves=5000,
        )
        start = best.values
        found.append(best)
    return np.cumsum(list(start.values())), found


def equal_peaks(
    grid: nacre.Grid, load: float, spread: float = 5e-4, most: int = 80
) -> tuple[Array, float]:
    """Return the drops with which all columns have the same largest pressure, and their spread.

    An excess of pressure is a line load too much, as p² is proportional to the line load. Its
    displacement, as of sources half a contact's half width away, is added to the drop.
    """
    x = columns(grid)
    step = x[1] - x[0]
    near = hertz(load).half_width / 2
    towards = [np.abs(x[:, None] - x), x[:, None] + x]
    rise = sum(
        np.arcsinh((d + step / 2) / near) - np.arcsinh((d - step / 2) / near) for d in towards
    )
    drop = nacre.LogarithmicProfile.lundberg(LENGTH, load, MODULUS).drop_at(x)
    plan = nacre.Contact(STEEL, grid, STEEL, threads=1)
    last, width = None, math.inf
    for _ in range(most):
        last = plan.solve(shape(x, drop), load=load, tolerance=1e-9, initial=last)
        peaks = last.pressure.max(axis=1)[grid.x > 0]
        width = float(np.ptp(peaks) / peaks.mean())
        if width < spread:
            break
        excess = 2 * (peaks / peaks.mean() - 1) * load / LENGTH
        drop = drop + 0.6 * rise @ excess / (math.pi * MODULUS)
        drop = drop - (drop[0] - (drop[1] - drop[0]) / 8)  # a parabola through the middle
    return drop, width


def uniform_drop(x: Array, load: float) -> Array:
    """Return the drop that an equal Hertzian pressure up to the ends needs at x, on the axis."""
    line = hertz(load)

    def displacement(place: float) -> float:
        def share(angle: float) -> float:
            y = line.half_width * math.sin(angle)
            ends = ((LENGTH / 2 - place) / y, (LENGTH / 2 + place) / y)
            return math.cos(angle) ** 2 * sum(map(math.asinh, ends))

        total = 2 * line.half_width * quad(share, 0.0, math.pi / 2, epsabs=0.0, epsrel=1e-9)[0]
        return float(line.peak_pressure * total / (math.pi * MODULUS))

    return displacement(0.0) - np.array([displacement(float(place)) for place in x])


def deviation(x: Array, drop: Array, other: Array, load: float) -> float:
    """Return the largest difference of drops over the middle 90 %, in percent of Lundberg's."""
    edge = 0.45 * LENGTH
    size = nacre.LogarithmicProfile.lundberg(LENGTH, load, MODULUS).drop_at(edge)
    difference = np.abs(np.interp([*x[x < edge], edge], x, drop - other))
    return float(100 * difference.max() / size)


def lundberg_rows(load: float, cells: tuple[int, int]) -> Iterator[tuple[str, float]]:
    """Yield the figures of a bare roller at its design load."""
    line = hertz(load)
    grid = nacre.Grid(cells, (LENGTH, 3.2 * line.half_width))
    x = columns(grid)
    profile = nacre.LogarithmicProfile.lundberg(LENGTH, load, MODULUS)
    lundberg = profile.drop_at(x)
    drop, found = optimised(grid, load)
    peaks = found[-1].solutions[0].pressure.max(axis=1)
    even, spread = equal_peaks(grid, load)
    shaped = nacre.Roller(RADIUS, length=LENGTH, profile=profile, counter_radius=COUNTER_RADIUS)
    solved = nacre.solve(shaped, STEEL, counterbody=STEEL, grid=grid, load=load)
    yield "Hertz's pressure [MPa]", line.peak_pressure / 1e6
    yield "half width over length [%]", 100 * line.half_width / LENGTH
    yield "deviation of the optimum [%]", deviation(x, drop, lundberg, load)
    yield (
        "deviation of equal pressure, by quadrature [%]",
        deviation(x, uniform_drop(x, load), lundberg, load),
    )
    yield "deviation of equal peaks [%]", deviation(x, even, lundberg, load)
    yield "optimum from equal peaks [%]", deviation(x, drop, even, load)
    yield "spread of the peaks, optimum [%]", 100 * np.ptp(peaks) / peaks.mean()
    yield "spread of the peaks, equal peaks [%]", 100 * spread
    yield "largest pressure over Hertz's, optimum", peaks.max() / line.peak_pressure
    yield "largest pressure over Hertz's, Lundberg", solved.pressure.max() / line.peak_pressure
    yield "solves", sum(best.solves for best in found)


def coated_rows(name: str, cells: tuple[int, int]) -> Iterator[tuple[str, float]]:
    """Yield the figures of a coating."""
    load, layer, half_widths = COATINGS[name]
    grid = nacre.Grid(cells, (LENGTH, 2 * half_widths * hertz(load).half_width))
    x = columns(grid)
    coated = nacre.HalfSpace(STEEL, layers=[layer])
    plan = nacre.Contact(coated, grid, STEEL, threads=1)
    tops: dict[tuple[str, float], tuple[float, float]] = {}
    bodies: dict[str, nacre.HalfSpace | nacre.Elastic] = {"bare": STEEL, "coated": coated}
    for best_for, body in bodies.items():
        drop, _ = optimised(grid, load, body, TILTS)
        for place in (0.1, 0.2, 0.3, 0.4, 0.45):
            at = float(np.interp(place * LENGTH, x, drop))
            yield f"best for {best_for}: drop at {place} L [µm]", 1e6 * at
        yield f"best for {best_for}: drop of the last column [µm]", 1e6 * float(drop[-1])
        solutions = [
            plan.solve(shape(x, drop), load=load, tilt=(tilt, None), tolerance=1e-9)
            for tilt in TILTS
        ]
        for reach in (0.5, 0.485):
            inside = np.abs(grid.x) < reach * LENGTH
            pressure = max(s.pressure[inside].max() for s in solutions) / 1e6
            tension = max(tension_of(s, layer.thickness)[inside].max() for s in solutions) / 1e6
            tops[best_for, reach] = pressure, tension
            yield f"best for {best_for}: pressure inside {reach} L [MPa]", pressure
            yield f"best for {best_for}: tension inside {reach} L [MPa]", tension
    for reach in (0.5, 0.485):
        for k, name in enumerate(("pressure", "tension")):
            gain = 1 - tops["coated", reach][k] / tops["bare", reach][k]
            yield f"gain in {name} inside {reach} L [%]", 100 * gain


def tension_of(solution: nacre.Solution, thickness: float) -> Array:
    """Return the largest principal stress at nine depths of the coating, for each column."""
    depths = np.linspace(0.0, 1.0 - 1e-9, 9) * thickness
    largest: Array = solution.stress(depths).principal[0]
    return np.asarray(largest.max(axis=(0, 2)))


def main() -> int:
    """Run both studies; return 1 if the profile for 1 kN is not Lundberg's within the bar."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=ROOT / "docs/optimal_profiles.csv")
    options = parser.parse_args()
    warnings.filterwarnings("ignore", category=nacre.NacreWarning)
    rows: list[list[Any]] = []
    cases = [(load, (192, 25)) for load in (200.0, 1e3, 2e3, 5e3)]
    for load, cells in [*cases, (1e3, (384, 33))]:
        rows += [["lundberg", f"{load:g} N", *cells, *row] for row in lundberg_rows(load, cells)]
        show(rows)
    for name in COATINGS:
        for cells in ((96, 33), (192, 65), (384, 97)):
            rows += [["coated", name, *cells, *row] for row in coated_rows(name, cells)]
            show(rows)
    with options.output.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["study", "case", "cells x", "cells y", "quantity", "value"])
        writer.writerows([*row[:-1], f"{row[-1]:.5g}"] for row in rows)
    measured = [row[-1] for row in rows if row[1] == "1000 N" and row[4].startswith("deviation")]
    return 0 if max(measured) < BAR else 1


def show(rows: list[list[Any]]) -> None:
    """Print the rows of the last case."""
    for row in rows:
        if row[:4] == rows[-1][:4]:
            print(*row[:4], f"{row[4]}: {row[5]:.5g}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
