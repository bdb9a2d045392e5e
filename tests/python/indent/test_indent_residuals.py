"""Fits say where residuals are no noise, choose the kind of noise, and end on exact data."""

from __future__ import annotations

import json
import math
import pickle
import warnings
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.special import betainc

import nacre
from nacre.indent import Curve, Fit, Indentation, Tip, fit
from nacre.indent._profile import Estimate
from nacre.indent._residuals import LEVEL, FixedParameters, durbin_watson, examine
from support import assert_close

FILM = {"thickness": 1e-6, "poisson": 0.4, "radius": 5e-6}
YOUNG = "body.layers[0].material.young"
DEPTH = np.linspace(10e-9, 200e-9, 60)


def film(young: float = 3e9, **numbers: float) -> nacre.HalfSpace:
    given = FILM | numbers
    layer = nacre.Layer(nacre.Elastic(young, given["poisson"]), given["thickness"])
    return nacre.HalfSpace(nacre.Elastic(70e9, 0.22), [layer])


BALL = Tip.sphere(FILM["radius"])
LOAD = Indentation(film(), BALL).curve(approach=DEPTH).load
TIME = 30 * LOAD / LOAD[-1]  # a load that grows at a constant rate


def noisy(seed: int, share: float = 0.01, same: float = 0.0, rho: float = 0.0) -> np.ndarray:
    first, second = np.random.default_rng(seed).standard_normal((2, DEPTH.size))
    for k in range(1, DEPTH.size):
        first[k] = rho * first[k - 1] + math.sqrt(1 - rho**2) * first[k]
    force: np.ndarray = LOAD * np.exp(share * first) + LOAD[-1] * same * second
    return force


def quick(data: Any, body: nacre.HalfSpace, tip: Tip = BALL, **options: Any) -> Fit:
    return fit(data, body, tip, [YOUNG], profile=False, **options)


WRONG: dict[str, tuple[np.ndarray | float, dict[str, float], str]] = {
    "contact point 2 nm": (2e-9, {}, "contact_point"),
    "contact point 5 nm": (5e-9, {}, "contact_point"),
    "drift 0.2 nm/s": (0.2e-9 * TIME, {}, "drift"),
    "compliance 1 nm/mN": (1e-6 * LOAD, {}, "compliance"),
    "thickness + 30 %": (0.0, {"thickness": 1.3e-6}, "body.layers[0].thickness"),
    "radius + 20 %": (0.0, {"radius": 6e-6}, "tip.radius"),
    "Poisson's ratio - 0.1": (0.0, {"poisson": 0.3}, "body.layers[0].material.poisson"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_with_a_model_is_named(name: str) -> None:
    # Bias is four to hundred standard errors, and the score tests' chance of a miss below 1e-2.
    shift, numbers, cause = WRONG[name]
    for seed in range(2):
        curve = Curve(DEPTH + shift, noisy(seed), time=TIME)
        body, tip = film(2e9, **numbers), Tip.sphere(numbers.get("radius", FILM["radius"]))
        with pytest.warns(nacre.NacreWarning, match="model does not describe the data") as caught:
            found = quick(curve, body, tip)
        assert found.warnings == (str(caught[0].message),)
        assert cause in found.warnings[0]
        assert not all(found.identifiable.values())
        assert f"warning: {found.warnings[0]}" in str(found)
        # What residuals showed of the bias is part of the interval, which was ± 0.3 %.
        assert np.ptp(found.intervals[YOUNG]) > 0.02 * found.estimates[YOUNG]


def test_correlated_noise_is_seen_and_widens_the_interval() -> None:
    # Points that are correlated by r count as (1 − r)/(1 + r), and Durbin and Watson's ratio is
    # 2 (1 − r), within 1/n. The load grows with the modulus by a power of 1 at most, so that σ/√n
    # is the least error under noise.
    for seed in range(3):
        with pytest.warns(nacre.NacreWarning, match="Durbin and Watson"):
            found = quick((DEPTH, noisy(seed, rho=0.9)), film(2e9))
        rest = found.residuals[0]
        wider = 4 / (np.diff(rest) @ np.diff(rest) / (rest @ rest)) - 1
        assert wider > 4
        least = (1 - 1 / 60) * math.sqrt(wider / DEPTH.size) * found.sigma
        assert found.standard_errors[YOUNG] / found.estimates[YOUNG] > least


@pytest.mark.quick
def test_correlated_points_count_as_fewer(monkeypatch: pytest.MonkeyPatch) -> None:
    # Of the mean of n points that are correlated by r the variance is (1 + r)/(1 − r) times that of
    # free ones. Beside the mean, Durbin and Watson's ratio is due to be 2, so that r = 1 − ratio/2.
    nothing = FixedParameters([], np.zeros((200, 0)))
    monkeypatch.setattr(FixedParameters, "of", lambda *_: nothing)
    noise = np.random.default_rng(7).standard_normal(200)
    rest = np.convolve(noise, 0.8 ** np.arange(200))[:200]
    rest -= rest.mean()
    one = np.ones(1)
    best = Estimate(one, 1.0, 1.0, 1.96, np.eye(1), np.eye(1), 1.0, one)
    model: Any = SimpleNamespace(
        **{"at": lambda x: (rest, np.ones((200, 1))), "names": ["mean"], "free": [], "dof": 199},
        **{"depth": rest, "slices": [slice(0, 200)], "is_known": False, "noise": "relative"},
        weight=one,
    )
    r = 1 - np.diff(rest) @ np.diff(rest) / (rest @ rest) / 2
    assert 0.6 < r < 0.9
    covariance = examine(model, best).estimate.covariance
    assert covariance[0, 0] == pytest.approx((1 + r) / (1 - r), rel=1e-9)


def test_freeing_what_is_named_mends_the_fit() -> None:
    curve = Curve(DEPTH + 5e-9, noisy(1))
    found = fit(curve, film(2e9), BALL, [YOUNG], nuisance=["contact_point"])
    assert all(found.identifiable.values())
    assert not found.warnings
    low, high = found.intervals[YOUNG]
    assert low < 3e9 < high


def test_right_models_are_not_warned_of() -> None:
    # Of each test LEVEL are false alarms, 0.2 of these 30 curves; warnings are errors here.
    for seed in range(10):
        assert quick((DEPTH, noisy(seed)), film(2e9)).noise in ("relative", "mixed")
        assert quick((DEPTH, noisy(seed, 0, 0.002)), film(2e9)).noise in ("absolute", "mixed")
        assert not quick((DEPTH, noisy(seed, 0.01, 0.001)), film(2e9)).reasons


def test_the_chance_of_durbins_and_watsons_ratio() -> None:
    rng = np.random.default_rng(5)
    x = np.linspace(0.1, 1, 24)
    basis, _ = np.linalg.qr(np.stack([x, x**1.5], axis=1))
    parts = [slice(0, 10), slice(10, 24)]
    rest = rng.standard_normal((4000, 24))
    rest -= rest @ basis @ basis.T
    ratios, dues, chances = np.array([durbin_watson(r, basis, parts) for r in rest]).T
    # Moments of rᵀAr/rᵀr by dense matrices: tr MA/dof, and 2 (tr (MA)² − (tr MA)²/dof) over
    # dof (dof + 2).
    step = np.diff(np.eye(24), axis=0)
    step = step[np.arange(23) != 9]  # points 9 and 10 are in two parts
    both, dof = (np.eye(24) - basis @ basis.T) @ step.T @ step, 22
    mean = np.trace(both) / dof
    variance = 2 * (np.trace(both @ both) - dof * mean**2) / (dof * (dof + 2))
    a = mean / 4
    total = a * (1 - a) / (variance / 16) - 1
    assert_close(dues, mean, rtol=1e-12)
    due = betainc(a * total, (1 - a) * total, ratios / 4)
    assert_close(chances, due, rtol=1e-9)
    # The standard error of counts of chances: the beta variable is nearly exact.
    for level in (10 * LEVEL, 0.5, 0.9):
        count = 4000 * level
        assert abs((chances < level).sum() - count) < 4 * math.sqrt(count * (1 - level))
    neighbours = [np.diff(r[part]) @ np.diff(r[part]) for r in rest[:3] for part in parts]
    direct = np.add.reduceat(neighbours, [0, 2, 4]) / (rest[:3] ** 2).sum(axis=1)
    assert_close(ratios[:3], direct, rtol=1e-12)


def test_the_kind_of_noise_is_found() -> None:
    assert quick((DEPTH, noisy(3)), film(2e9)).noise == "relative"
    found = quick((DEPTH, noisy(3, 0, 0.002)), film(2e9))
    # The standard error of a standard deviation of 60 points is 9 %.
    assert found.noise == "absolute"
    assert found.sigma == pytest.approx(0.002 * LOAD[-1], rel=0.3)
    both = quick((DEPTH, noisy(3, 0.01, 0.001)), film(2e9))
    assert both.noise == "mixed"
    # σ√(F² + c²) = √((0.01 F)² + (0.001 F₁)²): c = 0.1 F₁, found on a grid of factors of √10.
    assert 0.01 < both.floor < 0.5
    assert "% of the largest" in str(both)
    for copy in (
        Fit.from_dict(json.loads(json.dumps(both.to_dict()))),
        pickle.loads(pickle.dumps(both)),
    ):
        assert str(copy) == str(both)
        assert (copy.noise, copy.floor, copy.warnings) == (both.noise, both.floor, both.warnings)
        assert copy.sensitivity == both.sensitivity


def test_negative_forces_have_another_noise_than_relative() -> None:
    force = noisy(4, 0, 0.05)
    assert force.min() < 0
    assert quick((DEPTH, force), film(2e9)).noise == "absolute"


def test_a_noise_larger_than_sigma_is_warned_of() -> None:
    with pytest.warns(nacre.NacreWarning, match="does not describe the data"):
        quick((DEPTH, noisy(5)), film(2e9), noise="relative", sigma=0.005)
    with pytest.raises(ValueError, match="noise must be 'relative' or 'absolute' where sigma"):
        quick((DEPTH, noisy(5)), film(2e9), sigma=0.01)


@pytest.mark.parametrize("start", [3e9, 1e9])
@pytest.mark.parametrize("more", [[], ["body.layers[0].thickness"]])
@pytest.mark.parametrize("nuisance", [[], ["contact_point"]])
def test_fits_of_exact_data_end(start: float, more: list[str], nuisance: list[str]) -> None:
    found = fit((DEPTH, LOAD), film(start), BALL, [YOUNG, *more], nuisance=nuisance)
    # Loads of curves are interpolated to 1e-9, and steps end at 1e-8.
    assert found.estimates[YOUNG] == pytest.approx(3e9, rel=1e-6)
    assert all(found.identifiable.values())
    assert "residuals are rounding" in str(found)
    assert found.evaluations < 300


def test_a_radius_on_a_bare_body_is_not_seen_and_its_weight_is_told() -> None:
    # Hertz' force goes with E √R/(1 − ν²): residuals know nothing of R and ν.
    young = "body.substrate.young"
    bare = nacre.HalfSpace(nacre.Elastic(3e9, 0.4))
    load = Indentation(bare, Tip.paraboloid(5e-6)).curve(approach=DEPTH).load
    force = load * np.exp(0.01 * np.random.default_rng(6).standard_normal(DEPTH.size))
    found = fit((DEPTH, force), bare, Tip.paraboloid(6e-6), [young])
    assert all(found.identifiable.values())
    low, high = found.intervals[young]
    assert not low < 3e9 < high
    rates = found.sensitivity[young]
    assert rates["tip.radius"] == pytest.approx(-0.5, rel=1e-6)
    assert rates["body.substrate.poisson"] == pytest.approx(-2 * 0.4 / (1 - 0.4**2), rel=1e-6)
    assert "-0.5 % for 1 % of tip.radius" in str(found)


def test_sensitivities_are_changes_of_the_estimate() -> None:
    force, step = noisy(7), 1e-3
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", nacre.NacreWarning)
        rates = quick((DEPTH, force), film(), noise="relative").sensitivity[YOUNG]
        for name, numbers, shift in (
            ("body.layers[0].thickness", {"thickness": 1e-6}, 0.0),
            ("tip.radius", {"radius": 5e-6}, 0.0),
            ("contact_point", {}, np.ptp(DEPTH)),
        ):
            ends = []
            for side in (-step, step):
                given = {key: value * math.exp(side) for key, value in numbers.items()}
                tip = Tip.sphere(given.get("radius", 5e-6))
                data = DEPTH - 0.1 * side * shift, force
                found = quick(data, film(**given), tip, noise="relative")
                ends.append(math.log(found.estimates[YOUNG]))
            due = (ends[1] - ends[0]) / (2 * step * (0.1 if shift else 1.0))
            # Residuals of 1 % have a part in the change that the sensitivity leaves out.
            assert rates[name] == pytest.approx(due, rel=0.02), name
