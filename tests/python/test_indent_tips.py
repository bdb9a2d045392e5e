"""Cones by slope or half angle, and warnings of contacts that are too deep for small slopes."""

from __future__ import annotations

import json
import math
import pickle
import warnings
from collections.abc import Callable

import numpy as np
import pytest

import nacre
from nacre.indent import Indentation, IndentSolution, Tip, fit, solve
from nacre.values import decode, encode

STEEL = nacre.Elastic(210e9, 0.3)
ANGLE = np.deg2rad(70.3)


@pytest.mark.parametrize(
    ("by_angle", "by_slope"),
    [
        (Tip.cone(half_angle=ANGLE), Tip.cone(1 / math.tan(ANGLE))),
        (
            Tip.rounded_cone(radius=1e-7, half_angle=ANGLE),
            Tip.rounded_cone(1 / math.tan(ANGLE), 1e-7),
        ),
        (Tip.flat_cone(1e-7, half_angle=ANGLE), Tip.flat_cone(1e-7, 1 / math.tan(ANGLE))),
    ],
)
def test_a_half_angle_is_a_slope(by_angle: Tip, by_slope: Tip) -> None:
    assert by_angle.numbers == pytest.approx(by_slope.numbers, rel=1e-15)
    assert by_angle.numbers["slope"] == pytest.approx(0.35805, rel=1e-4)
    assert pickle.loads(pickle.dumps(by_angle)) == by_angle
    assert eval(repr(by_angle), {"Tip": Tip}) == by_angle
    assert decode(json.loads(json.dumps(encode(by_angle)))) == by_angle


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Tip.cone(70), "slope must be above 0 and at most 5.*half_angle=.*got 70"),
        (lambda: Tip.cone(half_angle=70), "half_angle must be between 0 and pi/2.*deg2rad.*70"),
        (lambda: Tip.cone(), "exactly one of slope and half_angle"),
        (lambda: Tip.cone(0.3, half_angle=1.2), "exactly one of slope and half"),
        (lambda: Tip.rounded_cone(70, 1e-7), "slope must be .*half_angle="),
        (lambda: Tip.flat_cone(1e-7, 70), "slope must be .*half_angle=.*got 70"),
        (lambda: Tip.flat_cone(1e-7), "exactly one of slope"),
        (lambda: Tip.cone(half_angle=0.1), "slope must be .* at most 5"),
        (lambda: Tip.sphere(5e-324), "radius must be between 1e-100 and 1e100"),
    ],
)
def test_ambiguous_numbers_are_refused(call: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()


def test_a_radius_is_needed() -> None:
    with pytest.raises(TypeError, match="radius must be given"):
        Tip.rounded_cone(0.3)


@pytest.mark.parametrize(
    ("tip", "shallow", "deep"),
    [
        # The slope is a/√(R²−a²) of a sphere, a/R of a paraboloid; at 0.5 δ is 0.215 R and 0.25 R.
        (Tip.sphere(5e-6), 1.05e-6, 1.15e-6),
        (Tip.sphere(5e-6), 1e-7, 10e-6),
        (Tip.paraboloid(5e-6), 1.2e-6, 1.3e-6),
        # δ over a is π/2 times the slope of a cone, and so it is taken of a punch.
        (Tip.flat_punch(1e-6), 0.75e-6, 0.8e-6),
    ],
)
def test_deep_contacts_are_warned_of(tip: Tip, shallow: float, deep: float) -> None:
    test = Indentation(STEEL, tip)
    assert not test.at(approach=shallow).warnings
    assert not test.curve(approach=[shallow]).warnings
    assert not solve(STEEL, tip, approach=shallow).warnings
    for call in (
        lambda: test.at(approach=[shallow, deep]),
        lambda: test.curve(approach=[shallow, deep]),
        lambda: solve(STEEL, tip, approach=[shallow, deep]),
    ):
        with pytest.warns(nacre.NacreWarning, match="too deep for its radius") as told:
            found = call()
        assert [str(one.message) for one in told] == list(found.warnings)
    assert "warning: the contact is too deep" in str(found)
    assert isinstance(found, IndentSolution)
    assert IndentSolution.from_dict(found.to_dict()) == found


def test_steep_cones_are_warned_of_and_berkovichs_is_not() -> None:
    assert not Indentation(STEEL, Tip.berkovich()).at(load=1e-3).warnings
    with pytest.warns(nacre.NacreWarning, match="up to 0.60"):
        Indentation(STEEL, Tip.cone(0.6)).at(load=1e-3)


def test_a_fit_is_warned_of_once() -> None:
    pytest.importorskip("scipy")
    tip, depth = Tip.sphere(5e-6), np.linspace(1e-7, 2e-6, 20)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", nacre.NacreWarning)
        load = Indentation(STEEL, tip).curve(approach=depth).load
    noise = np.exp(0.01 * np.random.default_rng(1).standard_normal(20))
    with pytest.warns(nacre.NacreWarning, match="too deep") as told:
        found = fit((depth, load * noise), STEEL, tip, ["body.substrate.young"], profile=False)
    assert [str(one.message) for one in told] == list(found.warnings)
    assert "warning: the contact is too deep" in str(found)
