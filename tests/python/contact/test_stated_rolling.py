"""Stated errors of line contacts with friction, at random places of the grid."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import nacre

STEEL = nacre.Elastic(210e9, 0.3)
MODULUS = 210e9 / 0.91 / 2
HALF, RADIUS = 1e-4, 50e-3
"""Half-width and radius: a circle differs from a parabola by (a/R)², 4e-6."""
LOAD = math.pi * HALF**2 * MODULUS / (4 * RADIUS)  # Hertz: a² = 4WR/πE*

CLAIMS = {
    "creepage": "stated-rolling-creepage",
    "force": "stated-rolling-force",
    "dissipated": "stated-rolling-dissipated",
    "stick_share": "stated-rolling-stick-share",
}


def _grid(rng: np.random.Generator, most: float = 200) -> nacre.Grid:
    """Return a grid with 20 to `most` cells across the contact, at a random place."""
    wider = rng.uniform(1.25, 2.0)
    cells = round(wider * math.exp(rng.uniform(math.log(20), math.log(most))))
    width = 2 * HALF * wider
    return nacre.Grid.line(cells, width, center=rng.uniform(-0.5, 0.5) * width / cells)


def _carter(seed: int, count: int) -> dict[str, np.ndarray]:
    """Return stated and true errors by name, from `count` placings.

    Carter: with r = √(1 - F/μW), the creepage is (μa/R)(1 - r), and the share r sticks.
    """
    rng = np.random.default_rng(seed)
    errors: dict[str, list[tuple[float, float]]] = {}
    for number in range(count):
        grid = _grid(rng)
        friction, share = rng.uniform(0.1, 0.8), rng.uniform(0.05, 0.98)
        force, sticks = share * friction * LOAD, math.sqrt(1 - share)
        creepage = friction * HALF / RADIUS * (1 - sticks)
        given = "force" if number % 2 else "creepage"
        exact = {"creepage": creepage, "force": force}
        exact |= {"dissipated": force * creepage, "stick_share": sticks}
        motion: dict[str, Any] = {given: (exact[given], None)}
        solution = nacre.roll(
            nacre.Cylinder(RADIUS),
            STEEL,
            STEEL,
            grid=grid,
            load=LOAD,
            friction=friction,
            direction="+y" if rng.random() < 0.5 else "-y",
            threads=1,
            **motion,
        )
        stated = solution.report.discretisation
        assert stated is not None
        own = {"creepage": solution.creepage, "force": solution.force}
        own |= {"dissipated": solution.dissipated, "stick_share": solution.stick_share}
        for name in exact.keys() - {given}:
            size = float(np.linalg.norm(own[name]))  # a force that is given along y has no x
            errors.setdefault(name, []).append((stated[name], abs(size - exact[name])))
    return {name: np.array(pairs).T for name, pairs in errors.items()}


@pytest.mark.parametrize("count", [30, pytest.param(300, marks=pytest.mark.slow)])
def test_errors_of_rolling_are_within_those_stated(
    count: int, claim: Callable[[str, float], None]
) -> None:
    for name, (stated, true) in _carter(1, count).items():
        assert np.mean(true <= stated) >= 0.99, name
        median = float(np.median(stated / true))
        if count > 100:
            claim(CLAIMS[name], median)
        assert 2 <= median <= 20, name


@pytest.mark.parametrize("count", [20, pytest.param(300, marks=pytest.mark.slow)])
def test_errors_of_sliding_are_within_those_stated(count: int) -> None:
    # Cattaneo's superposition: the tractions are μ times the pressure under W less that under
    # W - Q/μ on the half-width c = a √(1 - Q/μW), and so is the shift, with Hertz's
    # u(0) = (A W/π)(ln(2l/a) + ½) from the surface at l.
    rng, within = np.random.default_rng(2), []
    for _ in range(count):
        grid = _grid(rng)
        friction, share = rng.uniform(0.1, 0.7), rng.uniform(0.05, 0.97)
        left = math.sqrt(1 - share)
        sunk = [
            2 * load / (math.pi * MODULUS) * (math.log(2 * grid.size[1] / half) + 0.5)
            for load, half in ((LOAD, HALF), (LOAD * left**2, HALF * left))
        ]
        force = share * friction * LOAD
        solution = nacre.slide(
            nacre.Cylinder(RADIUS),
            *(STEEL, STEEL),
            grid=grid,
            load=LOAD,
            friction=friction,
            force=(None, force),
            threads=1,
        )
        stated = solution.report.discretisation
        assert stated is not None
        assert solution.shift is not None
        assert stated["torque"] == 0
        shift = abs(solution.shift[1] - friction * (sunk[0] - sunk[1]))
        sticks = abs(solution.stick_share - left)
        within += [shift <= stated["shift"], sticks <= stated["stick_share"]]
    assert np.mean(within) >= (0.99 if count > 100 else 0.97)


def test_the_torque_of_a_line_contact_has_an_error() -> None:
    keywords: dict[str, Any] = {
        "load": LOAD,
        "friction": 0.3,
        "creepage": (3e-4, 2e-4),
        "direction": "+y",
    }
    solution, fine = (
        nacre.roll(
            nacre.Cylinder(RADIUS), STEEL, STEEL, grid=nacre.Grid.line(n, 2.6e-4), **keywords
        )
        for n in (64, 512)
    )
    stated = solution.report.discretisation
    assert stated is not None
    assert abs(solution.torque - fine.torque) <= stated["torque"] <= 0.05 * abs(fine.torque)
