"""Boundary of nacre.indent with Python, and charts over coatings."""

from __future__ import annotations

import json
import math
import os
import pickle
import signal
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import nacre
from nacre.indent import Adhesion, Indentation, Tip, fit
from nacre.indent.charts import bulk_limit, information, pull_off_over_thickness
from nacre.indent.classical import gao_weights

DATA = Path(__file__).parents[1] / "data"
STEEL = nacre.Elastic(210e9, 0.3)


def test_states_have_the_shape_of_what_is_given() -> None:
    test = Indentation(STEEL, Tip.paraboloid(1e-5))
    assert np.ndim(test.at(load=1e-3).approach) == 0
    assert test.at(load=[[1e-3, 2e-3]]).approach.shape == (1, 2)


def test_exactly_one_of_load_approach_and_radius_is_given() -> None:
    test = Indentation(STEEL, Tip.paraboloid(1e-5))
    with pytest.raises(ValueError, match="load"):
        test.at(load=1e-3, approach=1e-9)


def test_values_survive_pickles() -> None:
    for value in (Tip.paraboloid(1e-5), Tip.cone(0.3), Adhesion.jkr(0.1), Adhesion.dmt(0.1)):
        assert pickle.loads(pickle.dumps(value)) == value


def test_jkr_on_a_bare_body_is_the_closed_form() -> None:
    radius, work = 1e-5, 0.1
    test = Indentation(STEEL, Tip.paraboloid(radius), adhesion=Adhesion.jkr(work))
    # Johnson, Kendall and Roberts 1971: 3/2 πwR.
    assert test.pull_off().load == pytest.approx(-1.5 * math.pi * work * radius, rel=1e-9)


def test_pull_off_is_that_of_the_reference() -> None:
    for row in json.loads((DATA / "jkr.json").read_text())["table"]:
        if row["E1_over_E2"] in (0.1, 4.0):
            (force,) = pull_off_over_thickness(row["E1_over_E2"], [row["h_over_a0"]])
            # The digits that pull-off by this program and the reference share at least.
            assert force == pytest.approx(row["load_control"]["pull_off_over_piwR"], rel=1e-8)


@pytest.mark.parametrize(
    ("ratio", "limits"),
    [
        (0.1, (0.0128, 0.011, 0.0128)),
        (0.5, (0.0243, 0.0208, 0.0243)),
        (2.0, (0.0141, 0.0121, 0.0142)),
    ],
)
def test_limits_of_bulk_formulae(ratio: float, limits: tuple[float, float, float]) -> None:
    # Limits of an error of 1 %, found by another program to three digits.
    found = bulk_limit([ratio])
    for values, limit in zip(found.values(), limits, strict=True):
        assert values[0] == pytest.approx(limit, rel=0.01)


YOUNG, POISSON, THICKNESS = (
    "body.layers[0].material.young",
    "body.layers[0].material.poisson",
    "body.layers[0].thickness",
)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("thickness", [0.1, 1.0, 3.0])
def test_gaos_functions_are_derivatives_of_the_punchs_stiffness(
    poisson: float, thickness: float
) -> None:
    # Gao, Chiu and Lee (1992): a punch on a layer that differs from its substrate by d ln G and dν
    # has d ln S = I0 d ln G + I1 dν/(1 − ν), exactly to first order.
    steel = nacre.Elastic(1.0, poisson)
    body = nacre.HalfSpace(steel, [nacre.Layer(steel, thickness)])
    state = Indentation(body, Tip.flat_punch(1.0)).at(approach=0.1)
    found = state.derivatives([YOUNG, POISSON])
    shear, lateral = gao_weights(thickness, poisson)
    assert found[YOUNG].stiffness / state.stiffness == pytest.approx(shear, rel=1e-12)
    # At fixed shear modulus instead of Young's: d ln G/dν = −1/(1 + ν) at fixed E.
    own = found[POISSON].stiffness / state.stiffness + shear / (1 + poisson)
    assert own * (1 - poisson) == pytest.approx(lateral, rel=1e-12)


@pytest.mark.parametrize("ratio", [0.2, 10.0])
def test_information_is_what_a_fit_states(ratio: float) -> None:
    layer = nacre.Layer(nacre.Elastic(ratio, 0.3), 1.0)
    body = nacre.HalfSpace(nacre.Elastic(1.0, 0.3), [layer])
    tip = Tip.paraboloid(1e3)
    test = Indentation(body, tip)
    depth = np.linspace(0.05, 1.0, 60) * test.at(radius=1.5).approach
    force = test.curve(approach=depth).load
    free = [YOUNG, THICKNESS]
    found = fit((depth, force), body, tip, free, noise="relative", sigma=0.01, profile=False)
    least = information(ratio, [1.5])
    # Without noise the fit ends at the truth, to 1e-5 of an error.
    assert least["young"][0] == pytest.approx(found.standard_errors[YOUNG] / ratio, rel=1e-4)
    assert least["thickness"][0] == pytest.approx(found.standard_errors[THICKNESS], rel=1e-4)


def test_derivatives_are_by_path_in_the_shape_of_the_state() -> None:
    test = Indentation(STEEL, Tip.paraboloid(1e-5), adhesion=Adhesion.jkr(0.1))
    state = test.at(load=[1e-3, 2e-3])
    found = state.derivatives()
    assert list(found) == test.parameters == list(found)
    assert found["adhesion.work"].approach.shape == (2,)
    h = 1e-6
    more, less = (
        Indentation(STEEL, Tip.paraboloid(1e-5 * (1 + s)), adhesion=Adhesion.jkr(0.1)).at(
            load=[1e-3, 2e-3]
        )
        for s in (h, -h)
    )
    slope = (more.approach - less.approach) / (2e-5 * h)
    assert found["tip.radius"].approach == pytest.approx(slope, rel=1e-7)
    assert set(state.stress([0.0, 1e-7], 1e-7)) == {"rr", "tt", "zz", "rz", "von_mises"}
    assert state.stress([0.0, 1e-7], 1e-7)["zz"].shape == (2, 2)


def test_pressures_are_in_proportion_to_moduli_work_and_strength() -> None:
    # At a given radius: derivatives over logarithms add up to the pressure, of shapes to nothing.
    layer = nacre.Layer(nacre.Elastic(3e9, 0.4), 1e-6)
    body = nacre.HalfSpace(nacre.Elastic(70e9, 0.22), [layer])
    adhesion = Adhesion.maugis(work=0.05, strength=50e6)
    state = Indentation(body, Tip.sphere(5e-6), adhesion=adhesion).at(radius=[3e-7, 6e-7])
    numbers = {
        YOUNG: 3e9,
        "body.substrate.young": 70e9,
        "adhesion.work": 0.05,
        "adhesion.strength": 50e6,
    }
    found = state.derivatives(list(numbers))
    assert list(found) == list(numbers)
    inside, outside = [0.0, 1e-7], [7e-7, 2e-6]
    pressure = sum(found[path].pressure(inside) * value for path, value in numbers.items())
    assert pressure == pytest.approx(state.pressure(inside), rel=1e-9)
    moved = sum(found[path].displacement(outside) * value for path, value in numbers.items())
    assert np.abs(moved).max() < 1e-9 * state.displacement(outside).max()
    wider = sum(found[path].outer_radius * value for path, value in numbers.items())
    assert np.abs(wider).max() < 1e-9 * state.outer_radius.min()
    assert np.abs(found["adhesion.strength"].outer_radius).min() * 50e6 > 1e-9


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Tip.sphere(-1.0), "radius must be finite and above 0, got -1"),
        (lambda: nacre.indent.slope_of(70.3), "half_angle must be between 0 and pi/2"),
        (lambda: Tip.profile([0.0, 2.0, 1.0], [0.0, 0.1, 0.2]), "profile radii must be ascending"),
        (lambda: Tip.profile([0.0, 1.0], [0.0, 0.1]), "profile"),
        (lambda: Tip.area_function([1.0, -1.0], 1.0), "area function must be above 0"),
        (lambda: Adhesion.maugis(0.1, 0.0), "strength must be finite and above 0"),
        (lambda: bare().at(), "exactly one of load, approach and radius"),
        (lambda: bare().at(load=-1.0), "load must be above 0, or nothing touches, got -1"),
        (lambda: bare().at(radius=1.0), "radius must be below the radius of the sphere, got 1"),
        (lambda: bare().at(load=[]), "array is empty"),
        (lambda: bare().at(load=1.0, branch="upper"), 'branch must be "stable" or "unstable"'),
        (lambda: bare().pull_off(), "give an adhesion"),
        (lambda: bare().curve(approach=np.ones((1, 1))), "approach must have one dimension"),
        (lambda: bare().curve(approach=[1e-9], wrt=["tip.size"]), "wrt must be paths among"),
        (lambda: bare().at(load=1e-3).pressure(-1.0), "r must be finite and at least 0, got -1"),
        (lambda: bare().at(load=1e-3).stress(0.0, 0.0), "z must be at least 1e-2"),
        (lambda: bulk_limit([0.1], error=0.0), "error must be above 0"),
        (lambda: pull_off_over_thickness(0.0, [1.0]), "young must be finite and above 0"),
    ],
)
def test_bad_input_is_refused(call: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()


def bare() -> Indentation:
    return Indentation(STEEL, Tip.sphere(1e-5))


def test_an_interrupt_ends_long_work_at_once() -> None:
    # A contact of 400 thicknesses takes some tenths of a second.
    film = nacre.Layer(nacre.Elastic(1e9, 0.3), 1e-7)
    test = Indentation(nacre.HalfSpace(STEEL, [film]), Tip.paraboloid(1.0))
    sent = []

    def interrupt() -> None:
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.5, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        test.at(radius=np.full(1000, 4e-5))
    # A fifth of a second is what users are promised; the rest is for a busy machine.
    assert time.perf_counter() - sent[0] < 1.0
