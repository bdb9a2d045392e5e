"""Bad input of friction is refused by a message that names the argument and what it was."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest

import nacre

NAN, INF = float("nan"), float("inf")
STEEL = nacre.Elastic(210e9, 0.3)
BALL, ROD = nacre.Sphere(5e-3), nacre.Cylinder(5e-3)
GRID = nacre.Grid((32, 28), (2e-4, 1.8e-4))
CONTACT = nacre.Contact(STEEL, GRID, STEEL)
LINE = nacre.Contact(STEEL, nacre.Grid.line(64, 4e-4), STEEL)
HELD: dict[str, Any] = {"load": 10.0, "friction": 0.3}
LAST = CONTACT.slide(BALL, **HELD, force=(1.0, None))
ROLLED = CONTACT.roll(BALL, **HELD, direction="+x")
ENDS = nacre.HalfSpace(STEEL, ends=(-1e-3, 1e-3))
LOOSE = nacre.HalfSpace(STEEL, [nacre.Layer(STEEL, 1e-5, "frictionless")])


def slide(**keywords: Any) -> Any:
    return CONTACT.slide(BALL, **HELD | keywords)


def roll(**keywords: Any) -> Any:
    return CONTACT.roll(BALL, **HELD | {"direction": "+x"} | keywords)


def history(*steps: Any, **keywords: Any) -> Any:
    return CONTACT.slide(BALL, steps, **HELD | keywords)


ONE = {"force": (1.0, None)}

VALUE_ERRORS = {
    # friction
    "slide(friction=-0.1)": r"friction must be finite and at least 0, got -0\.1",
    "slide(friction=NAN)": r"friction must be finite.*got NaN",
    "slide(friction=INF)": r"friction must be finite.*got inf",
    "slide(friction=None)": r"first step must have a coefficient of friction",
    "roll(friction=None)": r"friction must be given in rolling",
    "slide(friction=np.ones((3, 4)))": r"friction: expected shape \[32, 28\], got \[3, 4\]",
    "slide(friction=np.zeros((0, 0)))": r"friction: expected shape \[32, 28\], got \[0, 0\]",
    "roll(friction=np.ones((28, 32)))": r"friction: expected shape \[32, 28\], got \[28, 32\]",
    "slide(friction=np.full((32, 28), NAN))": r"friction must be finite.*got NaN",
    "slide(friction=np.full((32, 28), -2))": r"friction must be .*at least 0, got -2",
    # motion
    "slide(shift=(NAN, None))": r"shift must be finite, got NaN",
    "slide(shift=(None, -INF))": r"shift must be finite, got -inf",
    "slide(force=(NAN, None))": r"force must be finite, got NaN",
    "slide(force=(10**400, None))": r"force must be finite, got inf",
    "slide(twist=NAN)": r"twist must be finite, got NaN",
    "slide(torque=INF)": r"torque must be finite, got inf",
    "slide(shift=(1e-7, None), force=(1.0, None))": r"shift and force along one axis.*not both",
    "slide(twist=1e-3, torque=1e-6)": r"twist and torque, one must be given, not both",
    "roll(creepage=(NAN, None))": r"creepage must be finite, got NaN",
    "roll(force=(None, INF))": r"force must be finite, got inf",
    "roll(spin=NAN)": r"spin must be finite, got NaN",
    "roll(creepage=(0, None), force=(1, None))": r"creepage and force along one axis.*not both",
    "roll(direction=None)": r"direction must be \"\+x\", .* any direction",
    "roll(direction='x')": r"direction must be \"\+x\", .*got \"x\"",
    "roll(cells=0)": r"cells must be an integer of at least 1, got 0",
    "roll(cells=10**30)": r"cells must be an integer that this machine can count to, got 10000",
    "roll(initial=LAST)": r"initial must be given with cells",
    "roll(load=1e3)": r"contact must end a cell or more before the edge of the grid",
    # load
    "slide(load=None)": r"first step must have a load or an approach",
    "slide(load=0.0)": r"load must be .*above 0, got 0",
    "slide(approach=1e-6)": r"exactly one of load and approach",
    "roll(load=None)": r"exactly one of load and approach",
    # line contact
    "LINE.slide(ROD, load=1e4, friction=0.3, twist=1e-3)": r"twist and torque must not .* line",
    "LINE.slide(ROD, load=1e4, friction=0.3, torque=0)": r"twist and torque must not .* line",
    "LINE.roll(ROD, load=1e4, friction=0.3, spin=1.0)": r"in line contact.*spin 0",
    "LINE.roll(ROD, load=1e4, friction=0.3, direction='+x')": r"in line contact.*\+y or -y",
    # histories
    "history(ONE, force=(1.0, None))": r"shift, force, twist and torque must be .* in the steps",
    "history(ONE, twist=0.0)": r"shift, force, twist and torque must be .* in the steps",
    "history(ONE, {'force': (NAN, None)})": r"force must be finite, got NaN",
    "history(ONE, {'load': -3})": r"load must be .*above 0, got -3",
    "history(ONE, {'friction': -1})": r"friction must be .*at least 0, got -1",
    "CONTACT.slide(BALL, [ONE])": r"first step must have a load or an approach",
    # search
    "slide(tolerance=0)": r"tolerance must be above 0 and below 1, got 0",
    "roll(tolerance=NAN)": r"tolerance must be above 0 and below 1, got NaN",
    "slide(max_convolutions=0)": r"max_convolutions must be an integer of at least 1, got 0",
    # bodies
    "nacre.slide(BALL, ENDS, STEEL, **HELD)": r"friction needs bodies that go on along x",
    "nacre.slide(BALL, STEEL, LOOSE, **HELD)": r"friction needs .*without frictionless interfaces",
    "nacre.roll(BALL, LOOSE, direction='+x', **HELD)": r"without frictionless interfaces",
    "nacre.slide(ROD, STEEL, **HELD)": r"grid must be given",
    "nacre.slide(BALL, STEEL, friction=0.3)": r"load or approach must be given",
    "nacre.slide(BALL, STEEL, threads=0, **HELD)": r"threads must be .*at least 1, got 0",
    # coefficients
    "coefficients(STEEL, STEEL, (1e-3, 0.0))": r"semi_axes must be finite and above 0, got 0",
    "coefficients(STEEL, STEEL, (NAN, 1.0))": r"semi_axes must be finite and above 0, got NaN",
    "coefficients(STEEL, STEEL, (1.0, 1.0), cells=4)": r"cells must be .* at least 8, got 4",
    "coefficients(LOOSE, STEEL, (1.0, 1.0))": r"without frictionless interfaces",
    # results
    "LAST.save('a.txt')": r"path must end in \.nc, \.vtr, \.csv.*got 'a\.txt'",
    "LAST.stress_plan().stress(0.0, friction=0.1)": r"friction must be 0: the tractions",
    "LAST.stress(-1.0)": r"z must be .*at least 0",
    "nacre.friction.history([])": r"solutions must hold at least one solution, got none",
    "curve(creepages=[[1e-3]])": r"creepages must be a sequence of numbers, got shape \(1, 1\)",
    "curve(creepages=[])": r"creepages must be a sequence of numbers, got shape \(0,\)",
    "curve(creepages=1e-3)": r"creepages must be a sequence of numbers, got shape \(\)",
    "curve(creepages=[1e-3], force=(1, None))": r"force must not be given: creepages say",
    "curve(creepages=[1e-3], cells=3)": r"cells must not be given: creepages say",
    "nacre.friction.history([LAST, ROLLED])": r"solutions must all slide or all roll",
    "nacre.plot.loop([])": r"solutions must hold at least one solution, got none",
}

TYPE_ERRORS = {
    "slide(friction='rough')": r"friction must be a real array, got dtype <U5",
    "slide(friction=1j)": r"friction must be a real array, got dtype complex128",
    "slide(friction=np.ma.masked_equal(np.ones((32, 28)), 2))": r"friction must .*without a mask",
    "slide(shift=1e-6)": r"shift must be a pair of numbers or None, got 1e-06",
    "slide(shift=(1e-6,))": r"shift must be a pair.*got \(1e-06,\)",
    "slide(shift='ab')": r"shift must be a pair.*got 'ab'",
    "slide(force=(1j, None))": r"force must be a pair.*got \(1j, None\)",
    "slide(twist='x')": r"twist must be a real number, got 'x'",
    "slide(torque=[1])": r"torque must be a real number, got \[1\]",
    "slide(coupling='no')": r"coupling must be a bool, got 'no'",
    "slide(check='no')": r"check must be a bool, got 'no'",
    "slide(progress=3)": r"progress must be callable, got 3",
    "slide(initial=3)": r"initial must be a nacre\.types\.FrictionSolution, got 3",
    "slide(initial=LAST.normal)": r"initial must be a nacre\.types\.FrictionSolution, got <Sol",
    "LAST.stress(0.0, friction=0.1)": r"unexpected keyword argument 'friction'",
    "slide(max_iterations=3)": r"unexpected keyword argument 'max_iterations'",
    "slide(creepage=(1e-3, None))": r"unexpected keyword argument 'creepage'",
    "roll(creepage=1e-3)": r"creepage must be a pair.*got 0\.001",
    "roll(spin='x')": r"spin must be a real number, got 'x'",
    "roll(cells=2.5)": r"cells must be an integer, got 2\.5",
    "roll(twist=3)": r"unexpected keyword argument 'twist'",
    "history(ONE, 3)": r"a step must be a mapping of keywords of `slide`, got 3",
    "history(ONE, None)": r"a step must be a mapping.*got None",
    "history(ONE, {'shift': 3})": r"(?s)shift must be a pair.*step 1",
    "history(ONE, {'colour': 1})": r"(?s)keys of a step must be among load, .*'colour'.*step 1",
    "history({3: 4})": r"(?s)keys of a step must be among .* got 3.*step 0",
    "history(ONE, {'tolerance': 1e-6})": r"keys of a step must be among .* got 'tolerance'",
    "CONTACT.slide(BALL, ONE, **HELD)": r"a step must be a mapping.*got 'force'",
    "CONTACT.slide('ball', **HELD)": r"shape must be a nacre\.Shape, got 'ball'",
    "nacre.slide(BALL, STEEL, grid=3, **HELD)": r"grid must be a nacre\.Grid, got 3",
    "nacre.slide(BALL, nacre.RIGID, STEEL, **HELD)": r"body.*must be a HalfSpace.*got RIGID",
    "nacre.slide(BALL, STEEL, weight=1, **HELD)": r"unexpected keyword argument 'weight'",
    "nacre.roll(BALL, STEEL, weight=1, direction='+x', **HELD)": r"keyword argument 'weight'",
    "coefficients('steel', STEEL, (1.0, 1.0))": r"must be a HalfSpace or an Elastic, got 'steel'",
    "coefficients(STEEL, 3, (1.0, 1.0))": r"must be a HalfSpace or an Elastic, got 3",
    "coefficients(STEEL, STEEL, ('a', 1.0))": r"(?s)pair of numbers, got \('a', 1.0\).*semi_axes",
    "coefficients(STEEL, STEEL, (1.0, 1.0), cells=8.5)": r"(?s)integer.*cells",
    "LAST.plot(3)": r"axes must be axes of Matplotlib, got 3",
    "curve(creepages=['fast'])": r"creepages must be real numbers.*'fast'",
    "curve(creepages=[1j])": r"creepages must be real numbers.*1j",
    "curve(creepages=np.ma.masked_equal([1e-3, 2e-3], 1e-3))": r"creepages must .*without a mask",
    "nacre.friction.history([3])": r"solutions must be a sequence of FrictionSolution, got \[3\]",
    "nacre.friction.history(LAST)": r"solutions must be a sequence of FrictionSolution, got <Fric",
    "nacre.friction.history(None)": r"solutions must be a sequence of FrictionSolution, got None",
    "nacre.plot.loop(LAST)": r"solutions must be a sequence of FrictionSolution, got <Fric",
    "nacre.plot.loop([LAST], axes=3)": r"axes must be axes of Matplotlib, got 3",
    "nacre.plot.creep_curve(None, axes=3)": r"axes must be axes of Matplotlib, got 3",
    "nacre.plot.friction(3)": r"solution must be a FrictionSolution, got 3",
    "curve(creepages=[1e-3], colour=3)": r"unexpected keyword argument 'colour'",
    "nacre.types.FrictionSolution()": r"FrictionSolution",
}

OTHER = nacre.Contact(STEEL, nacre.Grid((16, 20), (2e-4, 1.8e-4)), STEEL)
NAMES = globals() | {
    "coefficients": nacre.creep_coefficients,
    "curve": partial(
        nacre.friction.creep_curve, BALL, STEEL, STEEL, grid=GRID, direction="+x", **HELD
    ),
}


@pytest.mark.parametrize(("call", "message"), VALUE_ERRORS.items(), ids=VALUE_ERRORS)
def test_bad_values_are_refused(call: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        eval(call, NAMES)


@pytest.mark.parametrize(("call", "message"), TYPE_ERRORS.items(), ids=TYPE_ERRORS)
def test_bad_types_are_refused(call: str, message: str) -> None:
    with pytest.raises(TypeError, match=message):
        eval(call, NAMES)


def test_a_list_or_an_array_is_as_good_as_a_tuple() -> None:
    kinds: tuple[Any, ...] = (list, np.array)
    for like in kinds:
        found = slide(force=like((1.0, 0.0)))
        assert found.force == pytest.approx((1.0, 0.0), abs=1e-7)
    steps = [ONE, {"force": [2.0, None]}]
    several: tuple[Any, ...] = (tuple(steps), iter(steps), np.array(steps, dtype=object))
    for many in several:
        found = CONTACT.slide(BALL, many, **HELD)
        assert [s.force[0] for s in found] == pytest.approx([1.0, 2.0])


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"force": (NAN, None)}, "force must be finite"),
        ({"force": (3.1, None)}, "force must be below what friction bears"),
        ({"friction": np.ones((3, 3))}, "friction: expected shape"),
    ],
)
def test_an_error_in_a_step_keeps_the_steps_before_it(wrong: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message) as caught:
        history(ONE, wrong, ONE)
    (kept,) = getattr(caught.value, "solutions")  # noqa: B009
    assert kept == LAST or kept.traction.tobytes() == LAST.traction.tobytes()


OTHER_ERRORS: dict[str, tuple[type[Exception], str]] = {
    "OTHER.slide(BALL, initial=LAST, **HELD)": (ValueError, "initial must be a solution on"),
    "slide(shift=(1e300, None))": (ValueError, "shift must be at most a million times"),
    "roll(creepage=(1e300, None))": (ValueError, "creepage must be at most a million"),
    "roll(spin=1e300)": (ValueError, "spin must be at most a million over"),
    "slide(force=(1.0, None), max_convolutions=1)": (nacre.ConvergenceError, "max_convolutions"),
    "slide(torque=1.0)": (ValueError, "torque must be below what friction bears"),
    "slide(steps=3)": (TypeError, "steps must be"),
    "nacre.slide(BALL, STEEL, steps=[], **HELD)": (ValueError, "steps must"),
    "roll(direction=3)": (TypeError, "direction must be"),
    "slide(friction=np.ones(28))": (ValueError, "friction must have two dimensions"),
    "coefficients(STEEL, STEEL, (1.0, 1.0), cells=-4)": (ValueError, "cells must be .*at least 8"),
    "coefficients(STEEL, STEEL, 1.0)": (TypeError, "pair of numbers"),
    "coefficients(ENDS, STEEL, (1.0, 1.0))": (ValueError, "go on along x"),
}


@pytest.mark.parametrize("call", OTHER_ERRORS)
def test_what_cannot_be_is_refused(call: str) -> None:
    kind, message = OTHER_ERRORS[call]
    with pytest.raises(kind, match=message):
        eval(call, NAMES)


def test_semi_axes_may_be_a_list() -> None:
    nacre.creep_coefficients(STEEL, STEEL, [1.0, 1.0], cells=8)  # type: ignore[arg-type]


def test_rolling_that_is_stopped_at_once_gives_the_unfinished_solution() -> None:
    assert roll(progress=lambda *_: False).report.termination == "stopped"


def test_a_step_keeps_the_tilt_of_the_step_before() -> None:
    _, second = history({"tilt": (1e-3, None), "load": 10.0}, {"load": 9.0})
    assert second.normal.tilt == (1e-3, 0.0)
