"""Random fits end, with finite numbers or a clear refusal, and come back from plain data.

A few fits that are the same in every run; ``make fuzz`` tries many others.
"""

from __future__ import annotations

import json
import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import nacre
from bodies import quiet
from nacre.indent import Curve, Fit, Indentation, Tip, fit
from support import fuzz, powers

PATHS = (
    "body.layers[0].material.young",
    "body.layers[0].thickness",
    "body.layers[0].material.poisson",
    "body.substrate.young",
    "tip.radius",
)
MOST = 2000
"""Evaluations that no fit of four parameters exceeds: two dozen minima of at most 60 each."""


@fuzz(5)
@given(
    contrast=powers(-2, 2),
    poisson=st.floats(0.05, 0.49),
    reach=powers(-2, 0.3),
    guess=st.lists(powers(-0.3, 0.3), min_size=5, max_size=5),
    free=st.lists(st.sampled_from(PATHS), min_size=1, max_size=2, unique=True),
    nuisance=st.lists(
        st.sampled_from(["contact_point", "drift", "compliance"]), max_size=2, unique=True
    ),
    noise=st.tuples(*[st.sampled_from([0.0, 1e-12, 1e-3, 0.1])] * 2),
    zero=st.sampled_from([0.0, 0.02, -0.1]),
    seed=st.integers(0, 2**32),
    profile=st.booleans(),
)
def test_random_fits_end(
    contrast: float,
    poisson: float,
    reach: float,
    guess: list[float],
    free: list[str],
    nuisance: list[str],
    noise: tuple[float, float],
    zero: float,
    seed: int,
    profile: bool,
) -> None:
    true = [70e9 * contrast, 1e-6, poisson, 70e9, 1e-5]

    def system(values: list[float]) -> tuple[nacre.HalfSpace, Tip]:
        young, thickness, ratio, substrate, radius = values
        layer = nacre.Layer(nacre.Elastic(young, ratio), thickness)
        return nacre.HalfSpace(nacre.Elastic(substrate, 0.3), [layer]), Tip.paraboloid(radius)

    # The deepest contact has a radius of `reach` thicknesses.
    depth = np.linspace(0.02, 1, 25) * (reach * 1e-6) ** 2 / 1e-5
    load = Indentation(*system(true)).curve(approach=depth).load
    share, same = np.random.default_rng(seed).standard_normal((2, depth.size))
    force = load * np.exp(noise[0] * share) + noise[1] * load[-1] * same
    curve = Curve(depth * (1 + zero), force, time=np.linspace(0, 1, depth.size) ** 2)
    start = [
        value * (factor if path in free and not path.endswith("poisson") else 1.0)
        for value, factor, path in zip(true, guess, PATHS, strict=True)
    ]
    try:
        found = quiet(fit, curve, *system(start), free, nuisance=nuisance, profile=profile)
    except ValueError as error:
        assert str(error)  # noqa: PT017 a refusal says why
        return
    assert found.evaluations < MOST
    assert all(map(math.isfinite, found.estimates.values()))
    for name, (low, high) in found.intervals.items():
        assert low <= found.estimates[name] <= high
    assert not (found.warnings and all(found.identifiable.values()))
    assert str(Fit.from_dict(json.loads(json.dumps(found.to_dict())))) == str(found)
