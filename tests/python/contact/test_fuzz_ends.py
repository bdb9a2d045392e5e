"""Random bodies with free ends, on open grids and on such that repeat along y.

A few calls that are the same in every run; ``NACRE_FUZZ`` tries many others.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

import nacre
import support
from bodies import quiet
from support import assert_close, powers

fuzz = support.fuzz(6)


@st.composite
def bodies(draw: st.DrawFn, edges: np.ndarray, within: int) -> nacre.HalfSpace:
    """Return a body that ends up to so many cells within the grid, outside, or nowhere."""
    material = nacre.Elastic(draw(powers(-0.5, 0.5)), draw(st.floats(0.0, 0.5)))
    coat = nacre.Layer(nacre.Elastic(draw(powers(-0.5, 0.5)), 0.3), draw(powers(-1.5, -0.5)))
    # Coats are a model that holds where they are thin against the body.
    width = edges[-1] - edges[0]
    inside = st.integers(0, within)
    beyond = powers(-1.0, 2.0).map(lambda far: far * width)

    def end(side: int) -> st.SearchStrategy[float | None]:
        at = inside.map(lambda k: edges[-1 - k] if side else edges[k])
        outside = beyond.map(lambda far: edges[-side] + (far if side else -far))
        return st.one_of(st.none(), at, outside)

    ends = (draw(end(0)), draw(end(1)))
    return nacre.HalfSpace(material, [coat] if draw(st.booleans()) else [], ends=ends)


@st.composite
def contacts(draw: st.DrawFn) -> tuple[nacre.Grid, nacre.HalfSpace, nacre.HalfSpace]:
    """Return a grid and two bodies."""
    shape = draw(st.tuples(st.integers(8, 20), st.integers(4, 24)))
    width = draw(powers(-0.7, 0.7))
    grid = nacre.Grid(shape, (1.0, width), center=(draw(st.floats(-1.0, 1.0)), 0.0))
    edges = grid.center[0] - 0.5 + np.arange(shape[0] + 1) / shape[0]
    # What the counterbody carries must not reach beyond its ends.
    return grid, draw(bodies(edges, shape[0] // 2 - 1)), draw(bodies(edges, 0))


def solved(
    pair: tuple[nacre.HalfSpace, nacre.HalfSpace],
    grid: nacre.Grid,
    heights: np.ndarray,
    **motion: Any,
) -> nacre.Solution:
    """Return the contact of two bodies and a map of heights, by the whole operator."""
    shape = nacre.HeightMap(heights, grid.spacing, center=grid.center, periodic=grid.periodic)
    options = {"grid": grid, "tolerance": 1e-10, "threads": 1}
    solution: nacre.Solution = quiet(nacre.solve, shape, *pair, **options, **motion)
    assert solution.report.converged
    assert (solution.pressure >= 0).all()
    gap = solution.gap[np.isfinite(solution.gap)]
    assert (gap >= -1e-6 * np.abs(solution.displacement).max()).all()
    return solution


@fuzz
@given(contacts(), st.integers(0, 99), st.booleans())
def test_a_period_is_half_of_two(
    contact: tuple[nacre.Grid, nacre.HalfSpace, nacre.HalfSpace], seed: int, by_load: bool
) -> None:
    grid, *pair = contact
    heights = np.random.default_rng(seed).uniform(0.0, 1e-3, grid.shape)
    one = nacre.Grid(grid.shape, grid.size, center=grid.center, periodic=(False, True))
    cells, (length, width) = grid.shape, grid.size
    two = nacre.Grid(
        (cells[0], 2 * cells[1]), (length, 2 * width), center=grid.center, periodic=(False, True)
    )
    layers = [layer for body in pair if body.ends is not None for layer in body.layers]
    assume(sum(layer.thickness for layer in layers) <= width)  # else the period is refused
    load = 2e-4 * width
    first = solved((pair[0], pair[1]), one, heights, load=load)
    motion = {"load": 2 * load} if by_load else {"approach": first.approach}
    second = None
    try:
        second = solved((pair[0], pair[1]), two, np.tile(heights, (1, 2)), **motion)
    except ValueError as refusal:
        said = str(refusal)
    if second is None:
        assert "approach cannot be prescribed" in said  # below a stiff coat
        return
    scale = first.peak_pressure
    # Tolerance of the solutions, and the condition of the softest coats.
    assert_close(second.pressure, np.tile(first.pressure, (1, 2)), rtol=0, atol=1e-5 * scale)
    assert abs(second.approach / first.approach - 1) < 1e-6


@fuzz
@given(contacts(), st.integers(0, 99), st.booleans())
def test_mirrored_bodies_have_the_same_contact(
    contact: tuple[nacre.Grid, nacre.HalfSpace, nacre.HalfSpace], seed: int, repeats: bool
) -> None:
    grid, *pair = contact
    heights = np.random.default_rng(seed).uniform(0.0, 1e-3, grid.shape)
    grid = nacre.Grid(grid.shape, grid.size, center=grid.center, periodic=(False, repeats))
    first = solved((pair[0], pair[1]), grid, heights, load=2e-4 * grid.size[1])

    def mirrored(body: nacre.HalfSpace) -> nacre.HalfSpace:
        ends = [None if end is None else -end for end in reversed(body.ends)]
        return nacre.HalfSpace(body.substrate, body.layers, ends=(ends[0], ends[1]))

    x, y = grid.center
    turned = nacre.Grid(grid.shape, grid.size, center=(-x, y), periodic=(False, repeats))
    second = solved((mirrored(pair[0]), mirrored(pair[1])), turned, heights[::-1], load=first.load)
    scale = first.peak_pressure
    assert_close(second.pressure[::-1], first.pressure, rtol=0, atol=1e-5 * scale)
    assert abs(second.approach / first.approach - 1) < 1e-6


@fuzz
@given(powers(-0.3, 1.3), powers(0.0, 1.0), st.integers(6, 20), st.booleans())
def test_short_flush_bodies_have_the_pressure_of_a_line(
    length: float, wide: float, rows: int, repeats: bool
) -> None:
    # For nu = 0 the pressure of a line leaves the faces free, however short the bodies are
    # against the half-width of 1.
    body = nacre.HalfSpace(nacre.Elastic(1e6, 0.0), ends=(-0.5 * length, 0.5 * length))
    cells, width = 4 * int(8 * wide), 4.0 * wide
    assume(cells >= 32)
    grid = nacre.Grid((rows, cells), (length, width), periodic=(False, repeats))
    radius = 1e4
    heights = np.tile(-(grid.y**2) / (2 * radius), (rows, 1))
    load = np.pi * 5e5 / (4 * radius)
    plates = solved((body, body), grid, heights, load=load * length)
    endless = nacre.HalfSpace(nacre.Elastic(1e6, 0.0))
    if repeats:
        grid = nacre.Grid((2, cells), (width, width), periodic=(True, True))
        line = solved((endless, endless), grid, heights[:2], load=load * width)
    else:
        cylinder, strips = nacre.Cylinder(radius), nacre.Grid.line(cells, width)
        line = nacre.solve(cylinder, endless, endless, grid=strips, load=load, tolerance=1e-10)
    error = np.abs(plates.pressure - line.pressure[0]).max() / line.peak_pressure
    said = plates.report.free_ends
    assert said is not None
    assert error < said["error"]
