"""What the title of Spinu et al. asks for: their roller on a race, with ends that are free.

The paper computes on half-spaces that go on past the roller's ends. Here the roller is of the
race's material and ends at its two faces; the race goes on.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import nacre
from nacre.plot.style import WIDTH, styled
from paper.cases import CROWN_RADIUS, HALF_FLAT, ROLLER_LOAD, ROLLER_RADIUS, SUBSTRATE, Array
from paper.figures import Drawing, Row, finish, rows_of

LENGTH = 2 * HALF_FLAT
MODULUS = SUBSTRATE.plane_strain_modulus / 2
"""Contact modulus E* of two bodies of the paper's steel [Pa]."""

ROLLERS = {
    "straight, sharp ends": nacre.Roller(
        ROLLER_RADIUS, flat_length=LENGTH, crown_radius=CROWN_RADIUS, length=LENGTH
    ),
    "crowned over its outer halves": nacre.Roller(
        ROLLER_RADIUS, flat_length=LENGTH / 2, crown_radius=CROWN_RADIUS, length=LENGTH
    ),
    "logarithmic (Lundberg)": nacre.Roller(
        ROLLER_RADIUS,
        profile=nacre.LogarithmicProfile.lundberg(LENGTH, ROLLER_LOAD, MODULUS),
    ),
}
"""The paper's roller with three profiles, all of the length 2L."""

ECCENTRICITIES = {"centred": 0.0, "$e/L$ = 0.3": 0.3 * HALF_FLAT}
BODIES = {"half-space": False, "free ends": True}
LOOKS: dict[str, dict[str, Any]] = {
    "half-space": {"color": "#D55E00", "linestyle": (0, (4, 1.5))},
    "free ends": {"color": "#0072B2", "linestyle": "-"},
}
TITLE = "The paper's roller of finite length on a race of its own material, which goes on"


@dataclass(frozen=True)
class FiniteResult:
    """The solution of one roller, with its ends or on half-spaces."""

    roller: str
    eccentricity: str
    bodies: str
    solution: nacre.Solution

    def along_axis(self) -> tuple[Array, Array]:
        """Return coordinates [m] and pressures [Pa] of the cells along y = 0."""
        solution = self.solution
        return solution.x, solution.pressure[:, np.argmin(np.abs(solution.y))]


def solve(
    *, quick: bool = False, progress: Callable[[nacre.types.Report], object] | None = None
) -> list[FiniteResult]:
    """Solve the paper's roller with three profiles, centred and off centre, with and without ends.

    Parameters
    ----------
    quick
        Take coarse grids, for a first look.
    progress
        As in `nacre.solve`.

    Returns
    -------
    list of FiniteResult
        Rollers in their order; for each the eccentricities, and for each of these the bodies.
    """
    hertz = nacre.hertz.Line(ROLLER_RADIUS, MODULUS, ROLLER_LOAD / LENGTH)
    # Odd numbers of cells across put centres on the axis.
    cells = (256, 31) if quick else (1024, 63)
    grid = nacre.Grid(shape=cells, size=(LENGTH, 6.0 * hertz.half_width))
    results = []
    for bodies, free in BODIES.items():
        steel = nacre.HalfSpace(SUBSTRATE, ends=(-HALF_FLAT, HALF_FLAT) if free else None)
        contact = nacre.Contact(SUBSTRATE, grid, counterbody=steel)
        for roller, shape in ROLLERS.items():
            for name, eccentricity in ECCENTRICITIES.items():
                with warnings.catch_warnings():
                    # The pressure at sharp ends is what the figure is about.
                    warnings.simplefilter("ignore", nacre.NacreWarning)
                    solution = contact.solve(
                        shape,
                        load=ROLLER_LOAD,
                        eccentricity=(eccentricity, 0.0),
                        progress=progress,
                    )
                results.append(FiniteResult(roller, name, bodies, solution))
    return results


def draw(results: list[FiniteResult]) -> Drawing:
    """Draw the pressure along the axis: a row for each roller, a column for each eccentricity."""
    with styled():
        figure = Figure(figsize=(WIDTH, 0.95 * WIDTH), layout="constrained")
        panels = figure.subplots(len(ROLLERS), len(ECCENTRICITIES), sharex=True, sharey="row")
        rows: list[Row] = []
        for line, roller in zip(panels, ROLLERS, strict=True):
            for axes, eccentricity in zip(line, ECCENTRICITIES, strict=True):
                axes.set_title(f"{roller}, {eccentricity}", fontsize=9)
                for result in results:
                    if (result.roller, result.eccentricity) != (roller, eccentricity):
                        continue
                    x, pressure = result.along_axis()
                    position, pressure = 1e3 * x, 1e-6 * pressure
                    axes.plot(position, pressure, **LOOKS[result.bodies])
                    key = (roller, eccentricity.replace("$", ""), result.bodies)
                    rows += rows_of(*key, position, pressure)
                axes.set(xlabel="$x$ [mm]", ylabel="pressure [MPa]")
                axes.label_outer()
            pressures = [float(row[-1]) for row in rows if row[0] == roller]
            line[0].set_ylim(0, 1.05 * max(pressures))
        handles = [Line2D([], [], **look, label=name) for name, look in LOOKS.items()]
        figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), title=TITLE)
        header = ("roller", "load", "bodies", "x [mm]", "pressure [MPa]")
        return finish(figure, header, rows)
