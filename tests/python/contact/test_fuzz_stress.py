"""Extremes of stress summaries differ by at most their errors from those on four times finer cells.

A few contacts that are the same in every run; ``NACRE_FUZZ`` tries many others.
"""

from __future__ import annotations

import math
import random
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest

import nacre
from bodies import quiet
from support import ASKED

FINER = 4
"""Cells of the reference in one, along each side."""
OUTSIDE = 0.01
"""Share of extremes that may be farther off than they say, without a warning."""
NAMES = {"von_mises": "von Mises", "max_shear": "shear"}
"""Names of extremes in warnings, where they differ from those of attributes."""
YOUNG, RADIUS = 200e9, 10e-3


class Case(NamedTuple):
    """A contact, the grid with so many times finer cells, and the friction."""

    shape: Any
    body: nacre.HalfSpace
    load: float
    grid: Callable[[int], nacre.Grid]
    sliding: dict[str, Any]

    def extremes(
        self, finer: int = 1, refine: float | None = None
    ) -> dict[str, tuple[float, float, bool]]:
        """Return each extreme, its error, and whether a warning names it."""
        grid = self.grid(finer)
        solution = quiet(nacre.solve, self.shape, self.body, load=self.load, grid=grid)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            summary = solution.stress_summary(refine=refine, **self.sliding)
        texts = [str(warning.message) for warning in caught]
        places = [f"layers[{k}]" for k in range(len(summary.interfaces))] + ["the substrate"]
        places += [f"interfaces[{k}]" for k in range(len(summary.interfaces))]
        extremes = {}
        parts: list[Any] = [*summary.layers, *summary.interfaces]
        for place, part in zip(places, parts, strict=True):
            for name, error in part.uncertainty.items():
                word = NAMES.get(name, name)
                is_named = any(f"in {place} " in text and f"{word} by" in text for text in texts)
                extremes[f"{name} in {place}"] = (getattr(part, name)[0], error, is_named)
        return extremes


def random_case(seed: int) -> Case:
    """Return a contact of 16 to 64 cells across, or to 24 where only a few are tried.

    A cylinder or a paraboloid presses on up to two layers of 0.1 to 2 half-widths with 1/4 to 4
    times the modulus of the substrate, without friction or with a coefficient of up to 0.5.
    """
    numbers = np.random.default_rng(seed)

    def between(low: float, high: float) -> float:
        """Return a number that is even in its logarithm."""
        return float(low * (high / low) ** numbers.random())

    def material(young: float) -> nacre.Elastic:
        return nacre.Elastic(young, float(numbers.uniform(0.2, 0.4)))

    half, across = between(5e-5, 2e-4), between(16.0, 64.0 if ASKED else 24.0)
    room = float(numbers.uniform(1.3, 2.0))
    layers = [
        nacre.Layer(material(YOUNG * between(0.25, 4.0)), half * between(0.1, 2.0))
        for _ in range(numbers.choice([0, 1, 1, 2]))
    ]
    body = nacre.HalfSpace(material(YOUNG), layers)
    friction = float(numbers.choice([0.0, 1.0, 1.0, 1.0]) * numbers.uniform(0.0, 0.5))
    angle = float(numbers.uniform(0.0, 2.0 * math.pi))
    sliding = {"friction": friction, "direction": (math.cos(angle), math.sin(angle))}
    off = numbers.uniform(-0.5, 0.5, 2)
    # Loads with which Hertz' contact on a body of the modulus 2e11 has about this half-width.
    if numbers.random() < 0.6:
        rod, load = nacre.Cylinder(RADIUS), math.pi * YOUNG * half**2 / (4.0 * RADIUS)
        strips = nacre.Grid.line(400, 10.0 * half)
        width = np.ptp(quiet(nacre.solve, rod, body, load=load, grid=strips).contact_extent[1])
        cell, count = width / across, math.ceil(room * across)

        def line(finer: int) -> nacre.Grid:
            return nacre.Grid.line(finer * count, count * cell, off[1] * cell)

        return Case(rod, body, load, line, sliding)
    ratio = float(numbers.choice([1.0, between(1.0, 3.0)]))
    ball = nacre.Paraboloid(RADIUS, ratio * RADIUS)
    load = 4.0 * YOUNG * half**3 / (3.0 * RADIUS) * math.sqrt(ratio)
    extent = quiet(nacre.solve, ball, body, load=load, max_cells=2**13).contact_extent
    widths = np.ptp(extent, axis=1)
    cells = widths.min() / across * np.array([1.0, numbers.choice([1.0, between(0.7, 1.4)])])
    nx, ny = (int(count) for count in np.ceil(room * widths / cells))

    def plane(finer: int) -> nacre.Grid:
        size, center = (nx * cells[0], ny * cells[1]), (off[0] * cells[0], off[1] * cells[1])
        return nacre.Grid((finer * nx, finer * ny), size, center)

    return Case(ball, body, load, plane, sliding)


@pytest.mark.slow
def test_extremes_are_within_their_errors() -> None:
    """A friction whose edge the cells do not locate is among them."""
    seeds = [random.SystemRandom().getrandbits(32) for _ in range(int(ASKED or 0))] or range(12)
    outside, count, errors = [], 0, []
    for seed in seeds:
        case = random_case(seed)
        reference = case.extremes(FINER)
        for refine in (None, 0.05):
            for name, (value, error, is_named) in case.extremes(refine=refine).items():
                expected, own_error, _ = reference[name]
                if name.startswith("tension") and max(value, expected) <= 0.0:
                    continue
                count += 1
                errors.append(error / max(abs(value), abs(expected)))
                # Finer cells than those of the reference may be nearer to the truth than it is.
                allowed = error + (0.0 if refine is None else own_error)
                if abs(value - expected) > allowed and not is_named:
                    outside.append((seed, refine, name, value, error, expected))
    assert len(outside) <= OUTSIDE * count, outside
    # An error that holds because it is as large as the stress is of no use.
    assert np.median(errors) < 0.03, np.median(errors)
