"""A ball pulled along two equal bodies, under half of the force that friction bears.

nacre solves Coulomb's law on a half-space; Tamaas, by Kato's algorithm and by Condat's, its
associated form on a periodic one. Their tractions are similar, not equal: only the effort is
compared. Each stops at 1e-8 by its own account.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

import nacre

RADIUS = 50.0
POISSON = 0.42
FRICTION = 0.4
SIDE = 2.0 / 0.83
"""Side of the domain; the radius of the contact is 1."""
LOAD = 4 / 3 / (1 - POISSON) / RADIUS
"""Hertz's load on two bodies of the shear modulus 1."""
FORCE = 0.5 * FRICTION * LOAD
TOLERANCE = 1e-8

Solve = Callable[[], dict[str, Any]]


def with_nacre(cells: int, threads: int) -> Solve:
    """Plan with nacre."""
    body = nacre.Elastic(2 * (1 + POISSON), POISSON)
    grid = nacre.Grid(shape=(cells, cells), size=(SIDE, SIDE))
    contact = nacre.Contact(body, grid, counterbody=body, threads=threads)
    shape = nacre.Paraboloid(RADIUS, RADIUS)
    step: dict[str, Any] = {"load": LOAD, "force": (FORCE, 0.0)}
    # What tractions need is planned with the first of them.
    contact.slide(shape, friction=FRICTION, tolerance=0.1, **step)

    def solve() -> dict[str, Any]:
        found = contact.slide(shape, friction=FRICTION, tolerance=TOLERANCE, **step)
        report = found.report
        return {"work": report.convolutions, "balance": abs(found.force[0] / FORCE - 1)}

    return solve


def with_tamaas(solver: str) -> Callable[[int, int], Solve]:
    """Return what plans with one of its solvers."""

    def plan(cells: int, threads: int) -> Solve:
        import tamaas

        tamaas.set_log_level(tamaas.LogLevel.error)
        model = tamaas.Model(tamaas.model_type.surface_2d, [SIDE, SIDE], [cells, cells])
        # Two equal bodies yield as one of half their modulus does.
        model.E, model.nu = 1 + POISSON, POISSON
        x = ((np.arange(cells) + 0.5) / cells - 0.5) * SIDE
        heights = -(x[:, None] ** 2 + x[None, :] ** 2) / (2 * RADIUS)

        def solve() -> dict[str, Any]:
            model.traction[:] = 0.0
            means = [FORCE / SIDE**2, 0.0, LOAD / SIDE**2]
            getattr(tamaas, solver)(model, heights, TOLERANCE, FRICTION).solve(means)
            return {"balance": float(abs(model.traction[..., 0].mean() / means[0] - 1))}

        return solve

    return plan


PLANS: dict[str, Callable[[int, int], Solve]] = {
    "nacre": with_nacre,
    "Tamaas (Kato)": with_tamaas("Kato"),
    "Tamaas (Condat)": with_tamaas("Condat"),
}


def measure(request: dict[str, Any]) -> dict[str, Any]:
    """Plan and solve; repeat while there is time."""
    begin = time.perf_counter()
    solve = PLANS[request["program"]](request["cells"], request["threads"])
    planning = time.perf_counter() - begin
    times: list[float] = []
    found: dict[str, Any] = {}
    while not times or (len(times) < 5 and sum(times) + times[-1] < request["seconds"]):
        start = time.perf_counter()
        found = solve()
        times.append(time.perf_counter() - start)
    return {"seconds": min(times), "planning": planning} | found
