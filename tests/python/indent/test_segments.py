"""A loading ends, and an unloading begins, where the force is held; what is cut is said."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import pytest

from nacre.indent import Curve
from support import assert_close

Array = npt.NDArray[np.float64]


class Trial(NamedTuple):
    depth: Array
    force: Array
    arrival: int
    """Last point of the loading."""
    departure: int
    """First point of the unloading."""


def indent(
    *,
    points: int = 150,
    hold: int = 50,
    creep: float = 0.02,
    relaxation: float = 0.0,
    before: int = 0,
) -> Trial:
    """Return a cone to depth and force 1, a hold that creeps or relaxes, and a law of 1.4 back."""
    rise = np.linspace(0.005, 1, points)
    since = np.arange(1, hold + 1) / max(hold, 1)
    deep = 1 + creep * np.log1p(10 * since) / np.log1p(10)
    force = 1 - relaxation * (1 - np.exp(-4 * since))
    top, load = (deep[-1], force[-1]) if hold else (1.0, 1.0)
    back = np.linspace(top, 0.51 * top, points + 1)[1:]
    fall = load * ((back / top - 0.5) / 0.5) ** 1.4
    return Trial(
        np.concatenate([np.linspace(-0.5, 0, before), rise, deep, back]),
        np.concatenate([np.zeros(before), rise**2, force, fall]),
        before + points - 1,
        before + points + hold - 1,
    )


def constant_strain_rate() -> Trial:
    rise = np.exp(5 * (np.linspace(0, 1, 200) - 1))
    after = indent(points=100)
    depth = np.concatenate([rise, after.depth[100:]])
    return Trial(depth, np.concatenate([rise**2, after.force[100:]]), 199, 249)


def hold_on_the_way() -> Trial:
    """Half the way up, the force oscillates about a hold of 80 points."""
    one, at = indent(), 100
    wave = one.force[at] + 0.005 * np.sin(np.arange(80))
    creep = one.depth[at] + np.linspace(0, 0.01, 80)
    depth = np.concatenate([one.depth[:at], creep, one.depth[at:] + 0.01])
    force = np.concatenate([one.force[:at], wave, one.force[at:]])
    return Trial(depth, force, one.arrival + 80, one.departure + 80)


def cycles(*loads: float) -> Trial:
    """Return loadings to these forces, each unloaded to a tenth."""
    depth: list[Array] = []
    force: list[Array] = []
    for load in loads:
        deep = load**0.5
        rise = np.linspace(0.3 * deep if depth else 0.005, deep, 60)
        back = np.linspace(deep, 0.3 * deep, 41)[1:]
        depth += [rise, back]
        force += [rise**2, load * ((back / deep - 0.25) / 0.75) ** 1.4]
    first = int(np.argmax(np.array(loads) == max(loads)))
    last = len(loads) - 1 - int(np.argmax(np.array(loads[::-1]) == max(loads)))
    return Trial(np.concatenate(depth), np.concatenate(force), 100 * first + 59, 100 * last + 59)


def dense() -> Trial:
    return indent(points=1500, hold=1000)


TRIALS: dict[str, Callable[[], Trial]] = {
    "hold": indent,
    "creep of a tenth": lambda: indent(creep=0.1),
    "depth falls in the hold": lambda: indent(creep=-0.01),
    "no hold": lambda: indent(hold=0),
    "relaxation": lambda: indent(creep=0.0, relaxation=0.1),
    "long hold": lambda: indent(points=60, hold=400),
    "few points": lambda: indent(points=15, hold=5),
    "approach": lambda: indent(before=300),
    "constant strain rate": constant_strain_rate,
    "hold on the way": hold_on_the_way,
    "cycles that rise": lambda: cycles(0.25, 0.5, 1.0),
    "equal cycles": lambda: cycles(1.0, 1.0, 1.0),
    "cycles that fall": lambda: cycles(1.0, 0.5),
    "dense": dense,
}


@pytest.mark.parametrize("noise", [0.0, 0.001, 0.005, 0.02])
@pytest.mark.parametrize("kind", TRIALS)
def test_a_hold_is_cut_from_loading_and_unloading(kind: str, noise: float) -> None:
    trial = TRIALS[kind]()
    slope = trial.force[trial.arrival] - trial.force[trial.arrival - 1]
    # Within some points, or the points in which the force rises by one standard deviation.
    allowed = 0 if noise == 0 else 2 + noise / slope
    for seed in range(4):
        rng = np.random.default_rng(seed)
        force = trial.force + noise * rng.standard_normal(trial.force.size)
        curve = Curve(trial.depth, force)
        assert abs(len(curve.loading()) - 1 - trial.arrival) <= allowed
        assert abs(len(curve) - len(curve.unloading()) - trial.departure) <= allowed


def test_a_loading_without_hold_keeps_its_end() -> None:
    rise = np.linspace(0.005, 1, 150)
    one = Curve(rise, rise**2)
    assert one.loading() == one
    assert one.loading().note == ""
    with pytest.raises(ValueError, match="at least 3 points in a hold at its largest force, got 1"):
        one.hold()
    with pytest.raises(ValueError, match="must have a hold during unloading, got none"):
        one.drift_hold()


def with_drift(noise: float = 0.0, rate: float = 0.05e-9) -> Curve:
    """10 mN in 30 s, held for 20 s, back to a tenth, held for 60 s, and off, with drift."""
    time = np.linspace(0, 150, 601)
    force = np.interp(time, [0, 30, 50, 77, 137, 140, 150], [0, 10e-3, 10e-3, 1e-3, 1e-3, 0, 0])
    elastic = 500e-9 * np.sqrt(force / 10e-3)
    rng = np.random.default_rng(1)
    depth = elastic + rate * time + noise * rng.standard_normal(time.size)
    return Curve(depth, force, time=time, name="B2")


@pytest.mark.parametrize("noise", [0.0, 0.2e-9])
def test_the_hold_of_the_unloading_is_cut_and_tells_the_drift(noise: float) -> None:
    one = with_drift(noise)
    drift = one.drift()
    assert drift.points == 241  # 60 s at 4 points a second
    # The error of a slope: noise / sqrt(sum of squares of the times about their mean).
    spread = noise / np.sqrt(241 * 60**2 / 12)
    assert abs(drift.rate - 0.05e-9) <= 4 * spread + 1e-12 * 0.05e-9
    assert drift.error == pytest.approx(spread, rel=0.2, abs=1e-20)
    assert_close(one.drift_hold().force, 1e-3, rtol=1e-12)
    back = one.unloading()
    assert back.force.min() == pytest.approx(1e-3, rel=0.12)
    assert back.note.startswith("hold of 80 points at 100 % of the largest force, depth +")
    assert "points at 10 % of the largest force" in back.note
    assert back.note in repr(back)
    assert pickle.loads(pickle.dumps(back)).note == back.note
    still = one.shifted(drift=drift.rate)
    assert still.drift().rate == pytest.approx(0, abs=1e-15)
    assert one.hold().force.min() == one.force.max()


def test_without_a_hold_in_the_unloading_the_end_of_the_other_tells_the_drift() -> None:
    one = with_drift()
    assert one.time is not None
    short = Curve(one.depth[:300], one.force[:300], time=one.time[:300])
    assert short.drift().rate == pytest.approx(0.05e-9, rel=1e-9)
    with pytest.raises(ValueError, match="must have a time for its drift"):
        Curve(one.depth, one.force).drift()
    with pytest.raises(ValueError, match="drift must be 0 for a curve without a time, got 1e-09"):
        Curve(one.depth, one.force).shifted(drift=1e-9)
    with pytest.raises(ValueError, match="hold of 3 points at different times, got 1"):
        Curve(one.depth[:100], one.force[:100], time=one.time[:100]).drift()


def test_a_baseline_after_contact_is_no_hold() -> None:
    one = indent()
    depth = np.concatenate([one.depth, np.linspace(0.5, 0.0, 300)])
    curve = Curve(depth, np.concatenate([one.force, np.zeros(300)]))
    assert len(curve.unloading()) == len(curve) - one.departure
