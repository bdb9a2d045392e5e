"""Random calls: every answer is finite and consistent, every refusal a clear error.

A hundred calls that are the same in every run; ``make fuzz`` tries many others.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

import nacre
import support
from bodies import STEEL, quiet
from support import assert_close, powers

fuzz = support.fuzz(25)
REFUSALS = (ValueError, TypeError, nacre.ConvergenceError)

# Anything that a user may pass by mistake.
wrong = st.one_of(
    st.sampled_from([math.nan, math.inf, -math.inf, 0.0, -1.0, 5e-324, 1e308, 10**400, 1e-300]),
    st.sampled_from(["steel", None, True, 1 + 2j, [], (), {}, [1.0], (1.0, None, 2.0), object()]),
    st.floats(),
)


materials = st.builds(nacre.Elastic, powers(8, 12), st.floats(0.0, 0.5))
layers = st.builds(nacre.Layer, materials, powers(-7, -3))
bodies = st.builds(nacre.HalfSpace, materials, st.lists(layers, max_size=2))
radii = powers(-3, 0)
simple = st.one_of(
    st.builds(nacre.Sphere, radii),
    st.builds(nacre.Paraboloid, radii, radii),
    st.builds(nacre.FlatPunch, powers(-4.5, -3)),
    st.builds(nacre.Roller, radii, powers(-3, -2), powers(-1, 1)),
)
shapes = st.one_of(
    simple,
    st.builds(lambda a, b: a + b, simple, simple),
    st.builds(lambda a, x, y: a.shifted(x, y), simple, *[st.floats(-1e-3, 1e-3)] * 2),
)
grids = st.builds(
    nacre.Grid, st.tuples(*[st.integers(3, 33)] * 2), st.tuples(*[powers(-4.3, -2.5)] * 2)
)
depths = powers(-7, -4.5)


def pressed(
    shape: nacre.types.Shape, body: nacre.HalfSpace, **keywords: Any
) -> nacre.Solution | None:
    """Return a converged solution that is in order, or None where nacre refuses with a reason."""
    try:
        solution: nacre.Solution = quiet(nacre.solve, shape, body, threads=1, **keywords)
    except REFUSALS as refusal:
        assert len(str(refusal)) > 10  # noqa: PT017
        return None
    assert solution.report.converged
    assert np.isfinite(solution.pressure).all()
    assert (solution.pressure >= 0).all()
    assert np.isfinite(solution.displacement).all()
    numbers = [solution.load, solution.approach, *solution.tilt, *solution.moment]
    assert np.isfinite(numbers).all()
    return solution


@fuzz
@given(shapes, bodies, grids, depths, st.floats(0.0, 0.5), powers(-6, -3))
def test_stresses_are_finite_and_linear_in_friction(
    shape: nacre.types.Shape,
    body: nacre.HalfSpace,
    grid: nacre.Grid,
    depth: float,
    friction: float,
    z: float,
) -> None:
    assume(np.isfinite(shape.gaps(grid)).any())
    solution = pressed(shape, body, grid=grid, approach=depth)
    assert solution is not None
    none, some, full = (
        solution.stress(z, friction=f, direction=(0.6, 0.8), threads=1)
        for f in (0.0, friction, 1.0)
    )
    for name in ("xx", "yy", "zz", "xy", "yz", "xz"):
        a, b, c = (np.asarray(getattr(field, name)) for field in (none, some, full))
        assert np.isfinite(b).all()
        size = max(np.abs(a).max(), np.abs(c).max())
        assert_close(b, a + friction * (c - a), rtol=0, atol=1e-10 * size)


@fuzz
@given(st.data())
def test_wrong_arguments_are_refused_or_answered(data: st.DataObject) -> None:
    calls: dict[Any, int] = {
        **{nacre.Elastic: 2, nacre.Layer: 2, nacre.HalfSpace: 2, nacre.Grid: 2},
        **{nacre.Sphere: 1, nacre.Paraboloid: 2, nacre.Cylinder: 1, nacre.FlatPunch: 1},
        **{nacre.Roller: 3, nacre.HeightMap: 2, nacre.LogarithmicProfile: 4},
        **{nacre.SampledProfile: 2, nacre.frequency_response: 2},
    }
    call = data.draw(st.sampled_from(list(calls)))
    good = st.one_of(st.just(STEEL), powers(-3, 0), st.just([1.0, 2.0]), st.just((4, 4)))
    arguments = data.draw(st.lists(st.one_of(wrong, good), max_size=calls[call] + 1))
    try:
        said = repr(call(*arguments))
    except REFUSALS as refusal:
        said = f"refused: {refusal}."  # it may show the NaN that it refuses
    assert said
    assert not said.endswith("nan")


@fuzz
@given(
    shapes,
    bodies,
    st.dictionaries(
        st.sampled_from(
            ["load", "approach", "eccentricity", "moment", "tilt", "tolerance", "grid", "threads"]
        ),
        wrong,
        max_size=3,
    ),
)
def test_wrong_keywords_are_refused_or_answered(
    shape: nacre.types.Shape, body: nacre.HalfSpace, keywords: dict[str, Any]
) -> None:
    pressed(shape, body, **({"grid": nacre.Grid((8, 8), (1e-3, 1e-3)), "load": 1.0} | keywords))
