"""Sliding and rolling from Python: known numbers, histories, and what interrupts them."""

from __future__ import annotations

import os
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, HELD, STEEL
from support import assert_close, interrupted

SOFT = nacre.Elastic(70e9, 0.2)
GRID = nacre.Grid((40, 36), (2.4e-4, 2.2e-4))
CONTACT = nacre.Contact(STEEL, GRID, STEEL)


def unit(poisson: float) -> nacre.Elastic:
    """Return a material of shear modulus 1."""
    return nacre.Elastic(2 * (1 + poisson), poisson)


def pulled(*forces: float) -> list[dict[str, Any]]:
    """Return the steps of a history of forces along x."""
    return [{"force": (force, None)} for force in forces]


# Known numbers.


def test_a_small_creepage_makes_the_force_of_kalkers_coefficients() -> None:
    body = unit(0.25)
    creep = nacre.creep_coefficients(body, body, (1.0, 1.0))
    contact = nacre.Contact(body, nacre.Grid((76, 76), (76 / 32, 76 / 32)), body)
    load = 4 / 3 / 0.75 / 50.0
    for axis, coefficient in enumerate((creep.c11, creep.c22)):
        keywords: dict[str, Any] = {"load": load, "friction": 1e3, "direction": "+x"}
        keywords["creepage"] = (1e-6, None) if axis == 0 else (None, 1e-6)
        rolled = contact.roll(nacre.Paraboloid(50.0, 50.0), **keywords)
        # Hertz's radius is 1. On 64 cells across, second order is within 0.2 % of the limit.
        assert rolled.force[axis] / 1e-6 == pytest.approx(coefficient, rel=2e-3)


# Histories.


def test_a_history_goes_on_with_the_same_bodies_alone() -> None:
    layer = nacre.HalfSpace(STEEL, [nacre.Layer(SOFT, 1e-6)])
    first = CONTACT.slide(BALL, **HELD, steps=pulled(1.0))
    wrong: list[Any] = [(SOFT, SOFT), (STEEL, None), (STEEL, SOFT), (layer, STEEL)]
    for body, counterbody in wrong:
        contact = nacre.Contact(body, GRID, counterbody)
        for initial in (first, first[-1], nacre.types.History.from_dict(first.to_dict())):
            with pytest.raises(ValueError, match="initial must be a solution of the body"):
                contact.slide(BALL, **HELD, steps=pulled(0.5), initial=initial)
            with pytest.raises(ValueError, match="initial must be a solution of the body"):
                contact.roll(
                    BALL, **HELD, creepage=(1e-4, 0.0), direction="+x", cells=2, initial=initial
                )
        with pytest.raises(ValueError, match="initial must be a solution of the body"):
            nacre.slide(BALL, body, counterbody, **HELD, force=(0.5, None), initial=first)
    # Equal bodies are the same ones, as are those of a file.
    again = nacre.Elastic(STEEL.young, STEEL.poisson)
    saved = nacre.types.History.from_dict(first.to_dict())
    ends = [
        nacre.slide(BALL, body, body, grid=GRID, **HELD, force=(0.5, None), initial=initial)
        for body, initial in ((STEEL, first), (again, saved))
    ]
    np.testing.assert_array_equal(ends[0].traction, ends[1].traction)


@pytest.mark.parametrize("soft", [nacre.Elastic(3e9, 0.2), STEEL])
def test_work_is_stored_or_dissipated(soft: nacre.Elastic) -> None:
    """Unlike bodies couple pressure and tractions: the energy of both together is conserved."""
    grid = nacre.Grid((32, 32), (6e-4, 6e-4)) if soft is not STEEL else GRID
    contact = nacre.Contact(soft, grid, STEEL)
    forces = np.linspace(0.0, 2.5, 26)
    steps: Any = contact.slide(
        BALL, load=10.0, friction=0.3, steps=pulled(*forces.tolist()), tolerance=1e-9
    )
    work = sum(
        0.5 * (a.force[0] + b.force[0]) * (b.shift[0] - a.shift[0])
        + 10.0 * (b.approach - a.approach)
        for a, b in pairwise(steps)
    )
    lost = sum(step.dissipated for step in steps[1:])
    stored = steps[-1].elastic_energy - steps[0].elastic_energy
    # Trapezia of 25 steps, and slip against the traction at the end of a step.
    assert stored + lost == pytest.approx(work, rel=5e-3)
    assert stored > 0.5 * work
    assert (steps[-1].report.coupling_energy != 0) == (soft is not STEEL)


# Fields.


def test_fields_say_the_same_as_the_numbers() -> None:
    pull = CONTACT.slide(BALL, **HELD, force=(2.0, -1.0), twist=1e-4)
    area = np.prod(GRID.spacing)
    x, y = np.meshgrid(pull.x, pull.y, indexing="ij")
    qx, qy = pull.traction
    assert pull.force == pytest.approx((2.0, -1.0), abs=1e-8 * 3.0)
    assert pull.force == pytest.approx(tuple(pull.traction.sum(axis=(1, 2)) * area))
    assert pull.torque == pytest.approx((x * qy - y * qx).sum() * area)
    assert pull.twist == 1e-4
    assert pull.dissipated == pytest.approx((pull.traction * pull.slip).sum() * area)
    assert pull.dissipation.sum() * area == pytest.approx(pull.dissipated)
    energy = 0.5 * (pull.traction * pull.displacement).sum() * area
    assert pull.tangential_energy == pytest.approx(energy)
    np.testing.assert_array_equal(pull.bound, 0.3 * pull.pressure)
    # Coulomb's law and the law of slip, cell by cell.
    size = np.hypot(qx, qy)
    assert (size <= pull.bound * (1 + 1e-12)).all()
    slips = (pull.bound > 0) & ~pull.stick
    assert_close(size[slips], pull.bound[slips], rtol=1e-9)
    largest = np.abs(pull.displacement).max()
    assert np.abs(pull.slip[:, pull.stick]).max() <= 1.01e-8 * largest
    moved = np.stack([pull.shift[0] - 1e-4 * y, pull.shift[1] + 1e-4 * x])
    rest = (moved - pull.displacement - pull.slip)[:, pull.bound > 0]
    assert np.abs(rest).max() <= 1e-12 * largest
    assert pull.normal.load == pytest.approx(10.0)
    assert pull.grid == GRID


def test_fields_are_read_only_arrays_of_the_grid() -> None:
    pull = CONTACT.slide(BALL, **HELD, force=(1.0, None))
    assert pull.stick.dtype == np.bool_
    for name in ("traction", "displacement", "slip", "bound", "dissipation", "stick", "x", "y"):
        field = getattr(pull, name)
        assert field.shape[-1] in GRID.shape
        assert field.flags.c_contiguous
        assert not field.flags.writeable


def test_friction_of_each_cell() -> None:
    even = CONTACT.slide(BALL, **HELD, force=(1.0, None))
    cells = CONTACT.slide(BALL, load=10.0, friction=np.full(GRID.shape, 0.3), force=(1.0, None))
    assert np.shape(cells.friction) == GRID.shape
    assert even.friction == 0.3
    np.testing.assert_array_equal(cells.traction, even.traction)
    # A lubricated half, in any dtype and order.
    half = np.full(GRID.shape, 3, dtype=np.int8, order="F")
    half[20:] = 0
    slid = CONTACT.slide(BALL, load=10.0, friction=half, shift=(1e-4, 0.0))
    np.testing.assert_array_equal(slid.friction, half)
    np.testing.assert_array_equal(slid.bound, half * slid.pressure)


def test_stress_below_carries_the_tractions() -> None:
    pull = CONTACT.slide(BALL, **HELD, force=(2.0, 1.0))
    rounding = 1e-9 * pull.bound.max()
    for body, sign in (("body", -1), ("counterbody", 1)):
        surface = pull.stress(0.0, body=body)
        assert_close(surface.xz, sign * pull.traction[0], rtol=0, atol=rounding)
        assert_close(surface.yz, sign * pull.traction[1], rtol=0, atol=rounding)
    plan = pull.stress_plan()
    assert plan.stress(1e-5) == pull.stress(1e-5)
    assert plan.summary() == pull.stress_summary()
    # Below, stress is that of the pressure and that of the tractions: opposite ones cancel.
    back = CONTACT.slide(BALL, **HELD, force=(-2.0, -1.0))
    pressed, here, there = (s.stress(1e-5) for s in (pull.normal, pull, back))
    for name in ("xx", "zz", "xz", "xy"):
        mean = 0.5 * (getattr(here, name) + getattr(there, name))
        # The tractions are found to 1e-8, and stress is not larger.
        atol = 1e-7 * pull.bound.max()
        assert_close(mean, getattr(pressed, name), rtol=0, atol=atol)
        assert np.abs(getattr(here, name) - mean).max() > 0.1 * pull.bound.max()


# Histories.


def test_a_history_keeps_what_a_step_does_not_give() -> None:
    steps: list[dict[str, Any]] = [{"force": (1.0, None)}, {}, {"load": 12.0}]
    steps.append({"friction": 0.5, "shift": (0.0, 1e-8)})
    loop = CONTACT.slide(BALL, steps, **HELD)
    assert [s.normal.load for s in loop] == pytest.approx([10, 10, 12, 12])
    assert [s.friction for s in loop] == [0.3, 0.3, 0.3, 0.5]
    first = loop[0].shift
    # What is neither moved nor loaded stays.
    assert [s.shift for s in loop] == [first, first, first, (0.0, 1e-8)]
    assert_close(loop[1].force, loop[0].force, atol=1e-7)
    assert loop[1].dissipated == pytest.approx(0, abs=1e-9 * loop[0].dissipated + 1e-20)


def test_sliding_states_its_errors_everywhere(tmp_path: Path) -> None:
    """Errors are printed, saved and stand in studies; what is given has none."""
    grid = nacre.Grid((40, 40), (2.4e-4, 2.4e-4))
    case: dict[str, Any] = {
        "shape": BALL,
        "body": STEEL,
        "counterbody": STEEL,
        "grid": grid,
        **HELD,
    }
    loop = nacre.slide(**case, steps=[{"force": (2.0, 0.0)}, {"shift": (0.0, 0.0)}])
    pulled, pushed = (step.report.discretisation for step in loop)
    assert pulled is not None
    assert pushed is not None
    names = {"force", "torque", "dissipated", "shift", "twist", "stick_share"}
    assert pulled.keys() == pushed.keys() == names
    assert (pulled["force"], pushed["shift"]) == (0.0, 0.0)
    shift = loop[0].shift
    assert shift is not None
    assert 0 < pulled["shift"] < 0.02 * shift[0]
    assert 0 < pushed["force"] < 0.02 * 3.0  # of what friction carries
    (line,) = (row for row in str(loop[0]).splitlines() if row.startswith("shift"))
    assert line.endswith(f"± {100 * pulled['shift'] / shift[0]:.1g} %")
    loaded = nacre.load(loop.save(tmp_path / "a.nc"))
    assert [step.report.discretisation for step in loaded] == [pulled, pushed]
    outputs = ["shift", "dissipated", "stick_share"]
    swept = {"friction": [case.pop("friction")]}
    study = nacre.sweep(case | {"force": (2.0, 0.0)}, swept, outputs=outputs, progress=False)
    for name in outputs:
        assert study[f"{name}_discretisation"].item() == pulled[name]


def test_a_resumed_history_is_the_same_to_the_bit() -> None:
    steps = pulled(2.0, -2.0, 1.0, 2.5)
    contact = nacre.Contact(STEEL, GRID, SOFT)  # pressure and tractions act on each other
    whole = contact.slide(BALL, steps, **HELD)
    first = contact.slide(BALL, steps[:2], **HELD)
    rest = contact.slide(BALL, iter(steps[2:]), initial=first[-1])
    singly = contact.slide(BALL, force=(1.0, None), initial=first[-1])
    called = nacre.slide(BALL, STEEL, SOFT, grid=GRID, steps=steps, **HELD)
    for some in (first + rest, called, [*whole[:2], singly]):
        for found, expected in zip(some, whole, strict=False):
            for name in ("traction", "displacement", "slip", "pressure"):
                assert getattr(found, name).tobytes() == getattr(expected, name).tobytes()
            assert (found.shift, found.twist) == (expected.shift, expected.twist)
    assert whole[0].report.coupled
    assert whole[0].report.sweeps > 1


def test_rolling_cell_by_cell_can_be_resumed() -> None:
    keywords: dict[str, Any] = {**HELD, "creepage": (1e-3, None), "direction": "-x"}
    rolled = CONTACT.roll(BALL, cells=6, **keywords)
    assert len(rolled) == 6
    assert rolled[-1].force[0] < rolled[0].force[0] < 0
    again = CONTACT.roll(BALL, cells=2, initial=rolled[3], **keywords)
    assert [s.traction.tobytes() for s in again] == [s.traction.tobytes() for s in rolled[4:6]]


@pytest.mark.parametrize(
    ("keywords", "said"),
    [
        ({"creepage": (0.05, None)}, None),
        ({"creepage": (0.5, None)}, r"reaches 0\.50.* about 25 %"),
        ({"creepage": (-0.08, 0.08)}, "reaches 0.11"),
        # The contact has a radius of 6.9e-5, within a cell of 6e-6: its edge creeps by 0.2.
        ({"creepage": (0.0, None), "spin": 3e3}, r"reaches 0\.(19|2[01])"),
    ],
)
def test_large_creepages_are_warned_of(keywords: dict[str, Any], said: str | None) -> None:
    roll: dict[str, Any] = {**HELD, "direction": "+x", **keywords}
    if said is None:
        assert CONTACT.roll(BALL, **roll).normal.report.warnings == []
        return
    with pytest.warns(nacre.NacreWarning, match=said):
        rolled = CONTACT.roll(BALL, cells=2, **roll)
    assert [s.normal.report.warning_kinds for s in rolled] == [["large motion"]] * 2


@pytest.mark.parametrize(
    ("keywords", "said"),
    [
        ({"creepage": (0.0, -0.09)}, r"the creepage is 0\.09, .* is it in per cent"),
        ({"creepage": (1e-3, None), "friction": 30.0}, r"friction is 30, .* is it in per cent"),
        ({"creepage": (1e-3, None), "friction": 3.0}, None),
        ({"creepage": (1e-3, None), "friction": 1e3}, None),
    ],
)
def test_percents_are_warned_of(keywords: dict[str, Any], said: str | None) -> None:
    roll: dict[str, Any] = {**HELD, "direction": "+x", **keywords}
    if said is None:
        assert CONTACT.roll(BALL, **roll).report.warnings == ()
        return
    with pytest.warns(nacre.NacreWarning, match=said):
        rolled = CONTACT.roll(BALL, **roll)
    assert len(rolled.report.warnings) == 1
    assert type(rolled).from_dict(rolled.to_dict()).report.warnings == rolled.report.warnings


def test_large_twists_are_warned_of() -> None:
    with pytest.warns(nacre.NacreWarning, match=r"twist is not small: it reaches 0\.20"):
        CONTACT.slide(BALL, **HELD, twist=-0.2)


def test_a_step_keeps_the_tilt_of_the_step_before() -> None:
    steps: list[dict[str, Any]] = [{"tilt": (1e-3, None), "load": 10.0}, {"load": 9.0}]
    _, second = CONTACT.slide(BALL, steps, **HELD)
    assert second.normal.tilt == (1e-3, 0.0)


# How a solve ends.


def test_what_does_not_converge_is_an_error_with_the_solution() -> None:
    with pytest.raises(nacre.ConvergenceError, match="not converged") as caught:
        CONTACT.slide(BALL, **HELD, force=(2.0, None), max_convolutions=2)
    unfinished = caught.value.solution
    assert (unfinished.report.termination, unfinished.report.converged) == (
        "iteration limit",
        False,
    )
    assert unfinished.report.violation > unfinished.report.tolerance == 1e-8
    same = CONTACT.slide(BALL, **HELD, force=(2.0, None), max_convolutions=2, check=False)
    np.testing.assert_array_equal(same.traction, unfinished.traction)
    steps = [{"force": (0.0, None)}, {"force": (2.0, None)}]
    with pytest.raises(nacre.ConvergenceError) as caught:
        CONTACT.slide(BALL, steps, **HELD, max_convolutions=2)
    finished = getattr(caught.value, "solutions")  # noqa: B009
    assert [s.report.converged for s in finished] == [True]
    assert not caught.value.solution.report.converged


def test_the_report_certifies_the_solution() -> None:
    pull = CONTACT.slide(BALL, **HELD, force=(2.0, None), torque=1e-5, tolerance=1e-6)
    report = pull.report
    assert (report.converged, report.termination, report.full_slip) == (True, "converged", False)
    assert report.tolerance == 1e-6
    assert 0 <= report.violation <= 1.01e-6
    assert 0 <= report.imbalance <= 1.01e-6
    assert -1e-12 <= report.excess <= 1e-12
    assert (report.coupled, report.sweeps, report.pressure_change) == (False, 1, 0.0)
    assert report.convolutions > 1
    assert report.seconds > 0
    assert pull.torque == pytest.approx(1e-5, rel=1e-4)
    assert CONTACT.slide(BALL, **HELD, shift=(1e-3, None)).report.full_slip
    uncoupled = nacre.slide(BALL, STEEL, SOFT, grid=GRID, coupling=False, **HELD)
    assert not uncoupled.report.coupled


BEARS = r"force must be below what friction can carry, (3|2\.9999)"


def test_the_force_that_friction_does_not_bear() -> None:
    for force in [(3.0, None), (None, -3.0), (2.2, 2.2)]:
        with pytest.raises(ValueError, match=BEARS):
            CONTACT.slide(BALL, **HELD, force=force)
        with pytest.raises(ValueError, match=BEARS):
            CONTACT.roll(BALL, **HELD, force=force, direction="+x")
    with pytest.raises(ValueError, match=r"friction can carry, 0, was 1:") as caught:
        CONTACT.slide(BALL, [*pulled(2.0), {"approach": -1e-6, "force": (1.0, None)}], **HELD)
    assert len(getattr(caught.value, "solutions")) == 1  # noqa: B009
    assert CONTACT.slide(BALL, **HELD, force=(2.99, None)).force[0] == pytest.approx(2.99)


def test_without_contact_there_is_no_traction() -> None:
    apart = CONTACT.slide(BALL, approach=-1e-6, friction=0.3, shift=(1e-6, 0.0), twist=1e-3)
    assert (apart.force, apart.torque, apart.dissipated) == ((0.0, 0.0), 0.0, 0.0)
    assert (apart.shift, apart.twist) == ((1e-6, 0.0), 1e-3)
    assert not apart.stick.any()
    assert "nothing touches" in str(apart)
    bare = CONTACT.slide(BALL, load=10.0, friction=0, shift=(1e-6, 0.0))
    assert not bare.traction.any()


# Progress and interrupts.


def test_progress_gets_the_step_and_a_report() -> None:
    told: list[tuple[int, nacre.types.FrictionReport]] = []
    CONTACT.slide(BALL, pulled(1.0, 2.0), **HELD, progress=lambda *got: told.append(got))
    assert [number for number, _ in told] == sorted(number for number, _ in told)
    assert {number for number, _ in told} == {0, 1}
    assert all(report.termination == "running" for _, report in told)
    counts = [report.convolutions for number, report in told if number == 1]
    assert counts == sorted(counts)


@pytest.mark.parametrize("no", [False, np.False_], ids=["bool", "numpy.bool"])
def test_progress_that_returns_false_stops(no: object) -> None:
    steps = pulled(1.0, 2.0, 1.0)
    found = CONTACT.slide(BALL, steps, **HELD, progress=lambda n, _: no if n == 1 else None)
    assert [s.report.termination for s in found] == ["converged", "stopped"]
    rolled = CONTACT.roll(BALL, **HELD, direction="+x", progress=lambda *_: no)
    assert rolled.report.termination == "stopped"


@pytest.mark.parametrize("error", [ZeroDivisionError("mine"), KeyboardInterrupt(), SystemExit(3)])
def test_an_exception_of_progress_carries_the_finished_steps(error: BaseException) -> None:
    def progress(number: int, report: nacre.types.FrictionReport) -> None:
        if number == 2:
            raise error

    whole = CONTACT.slide(BALL, pulled(1.0, 2.0), **HELD)
    with pytest.raises(type(error)) as caught:
        CONTACT.slide(BALL, pulled(1.0, 2.0, 1.0), **HELD, progress=progress)
    assert caught.value is error
    found = getattr(error, "solutions")  # noqa: B009
    assert [s.traction.tobytes() for s in found] == [s.traction.tobytes() for s in whole]


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="sends a signal to a process")
@pytest.mark.parametrize(
    "solve",
    [
        "contact.slide(ball, 10**4 * [{'force': (f, None)} for f in (2.0, -2.0)], KEYWORDS)",
        "contact.roll(ball, cells=10**4, creepage=(1e-3, None), direction='+x', KEYWORDS)",
        "contact.roll(ball, spin=30.0, direction='+x', max_convolutions=10**9, KEYWORDS)",
    ],
    ids=["slide", "cells", "steady"],
)
def test_ctrl_c_stops_and_keeps_the_finished_steps(solve: str) -> None:
    tolerance = ", tolerance=1e-300" if "max" in solve else ""
    call = solve.replace("KEYWORDS", f"load=10.0, friction=0.3, progress=watch{tolerance}")
    setup = """
import nacre
steel, ball = nacre.Elastic(210e9, 0.3), nacre.Sphere(5e-3)
contact = nacre.Contact(steel, nacre.Grid((96, 96), (2.4e-4, 2.4e-4)), steel)
calls = 0
def watch(number, report):
    global calls
    calls += 1
    if number == 3 or calls == 2000:
        begin.set()
"""
    finished = interrupted(setup, call, at="event")
    assert finished >= 3 or "max" in solve
