"""Starts, refusals and numbers of any size: no start changes an answer, no argument makes NaN.

Cases that are the same in every run; ``NACRE_FUZZ`` tries many others.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import nacre
import support
from bodies import BALL, STEEL, quiet
from support import Capture, assert_close, command, written

fuzz = support.fuzz(15)

ALLOY = nacre.Elastic(30e9, 0.35)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(80e9, 0.25), 2e-5)])
GRID = nacre.Grid((32, 32), (8e-4, 8e-4))
CLOSE = 1e-6
"""Differences of pressures over the peak. At a tolerance of 1e-9 they are some 1e-8."""

# Whatever may change between the solve that made a start and the one that takes it.
shapes = st.sampled_from([BALL, nacre.Sphere(2e-2), nacre.Paraboloid(5e-3, 1e-2)])
bodies = st.sampled_from([STEEL, ALLOY, COATED])
straight = st.one_of(
    st.builds(lambda load: {"load": load}, st.sampled_from([2.0, 10.0, 40.0])),
    st.builds(lambda d: {"approach": d}, st.sampled_from([5e-7, 1e-6])),
)
motions = st.one_of(
    straight,
    st.builds(lambda x: {"load": 10.0, "eccentricity": (x, None)}, st.sampled_from([0.0, 2e-5])),
)
tolerances = st.sampled_from([1e-2, 1e-4, 1e-9])
plans = st.tuples(bodies, st.one_of(st.none(), bodies))


def agree(one: Any, other: Any, tolerance: float = CLOSE) -> None:
    peak = max(float(other.pressure.max()), 1e-300)
    assert one.report.converged
    assert_close(one.pressure, other.pressure, atol=tolerance * peak)


@fuzz
@given(shapes, plans, motions, tolerances, shapes, plans, motions)
def test_no_start_changes_a_pressure(
    shape: Any, plan: Any, motion: Any, loose: float, shape2: Any, plan2: Any, motion2: Any
) -> None:
    start = quiet(nacre.solve, shape, *plan, grid=GRID, tolerance=loose, **motion)
    for hardness in (None, 1e9):
        again = dict(grid=GRID, tolerance=1e-9, hardness=hardness, **motion2)
        expected = quiet(nacre.solve, shape2, *plan2, **again)
        agree(quiet(nacre.solve, shape2, *plan2, initial=start, **again), expected)


@fuzz
@given(shapes, bodies, straight, tolerances, shapes, bodies, straight, st.booleans(), st.booleans())
def test_no_start_changes_a_contact_with_friction(
    shape: Any,
    body: Any,
    motion: Any,
    loose: float,
    shape2: Any,
    other_body: Any,
    motion2: Any,
    rolls: bool,
    changes: bool,
) -> None:
    body2 = other_body if changes else body
    # Between equal bodies a press leaves no tractions: there is no history.
    start = quiet(
        nacre.slide, shape, body, body, grid=GRID, friction=0.1, tolerance=loose, **motion
    )
    assert not start.traction.any()
    asked = dict(grid=GRID, friction=0.3, tolerance=1e-9, **motion2)
    if rolls:
        asked |= dict(direction="+x", creepage=(1e-3, None), cells=2)
    else:
        asked |= dict(steps=[{"shift": (1e-7, None)}, {"shift": (0.0, 5e-8)}])
    call = nacre.roll if rolls else nacre.slide
    if body2 != body:  # what has slipped belongs to its bodies
        with pytest.raises(ValueError, match="initial must be a solution of the body"):
            quiet(call, shape2, body2, body2, initial=start, **asked)
        return
    expected = quiet(call, shape2, body2, body2, **asked)
    found = quiet(call, shape2, body2, body2, initial=start, **asked)
    for one, other in zip(found, expected, strict=True):
        agree(one, other)
        assert one.normal.report.residual <= 1e-9
        assert one.pressure.tobytes() == other.pressure.tobytes()
        assert_close(one.traction, other.traction, atol=CLOSE * other.bound.max())


def test_different_bodies_start_from_a_history_alone() -> None:
    """The press before leaves a displacement, whose tractions move the peak by less than a tenth.

    The peak of the ball before, which is four times as large, is 0.4 of that of this one.
    """
    asked: dict[str, Any] = {"load": 10.0, "friction": 0.3, "grid": GRID, "tolerance": 1e-10}
    start = quiet(nacre.slide, nacre.Sphere(2e-2), STEEL, **asked | {"friction": 0.0})
    expected = quiet(nacre.slide, BALL, STEEL, **asked)
    found = quiet(nacre.slide, BALL, STEEL, initial=start, **asked)
    assert found.report.converged
    assert found.normal.report.residual <= 1e-10
    assert found.normal.load == pytest.approx(10.0, rel=1e-12)
    assert found.pressure.max() == pytest.approx(expected.pressure.max(), rel=0.1)


OTHERS = [
    nacre.Grid((32, 32), (6e-4, 6e-4)),
    nacre.Grid((32, 32), (8e-4, 8e-4), center=(2e-4, 0.0)),
    nacre.Grid((30, 32), (8e-4, 8e-4)),
    nacre.Grid((32, 32), (8e-4, 8e-4), periodic=(True, True)),
]


@pytest.mark.filterwarnings("ignore:.* have no estimate of their discretisation error")
@pytest.mark.parametrize("grid", OTHERS, ids=["size", "centre", "cells", "period"])
@pytest.mark.parametrize("hardness", [None, 2e9])
def test_another_grid_is_refused(grid: nacre.Grid, hardness: float | None) -> None:
    start = nacre.solve(BALL, STEEL, STEEL, grid=GRID, load=100.0, hardness=hardness)
    slid = nacre.slide(BALL, STEEL, STEEL, grid=GRID, load=100.0, friction=0.1)
    other = nacre.Contact(STEEL, grid, STEEL)
    match = r"initial must be a solution on the grid of this contact, .* was one on 32 x 32"
    for given_ in (start, slid):
        with pytest.raises(ValueError, match=match):
            other.solve(BALL, load=10.0, initial=given_, hardness=hardness)
        with pytest.raises(ValueError, match=match):
            nacre.solve(BALL, STEEL, STEEL, grid=grid, load=10.0, initial=given_, hardness=hardness)
    if grid.periodic == (False, False):
        with pytest.raises(ValueError, match=match):
            other.slide(BALL, load=10.0, friction=0.1, initial=slid)
        roll: dict[str, Any] = dict(load=10.0, friction=0.1, direction="+x", cells=1)
        with pytest.raises(ValueError, match=match):
            other.roll(BALL, initial=slid, **roll)


def test_the_command_line_starts_from_another_shape(tmp_path: Path, capsys: Capture) -> None:
    text = """
        shape = {{ kind = "sphere", radius = {radius} }}
        body.substrate = {{ young = 210e9, poisson = 0.3 }}
        counterbody.substrate = {{ young = 210e9, poisson = 0.3 }}
        grid = {{ shape = [32, 32], size = [8e-4, 8e-4] }}
        solve.load = 20.0
    """

    def solved(*more: object, radius: float) -> Any:
        path = written(tmp_path, text.format(radius=radius))
        assert command("solve", path, "--json", *more) == 0
        return json.loads(capsys.readouterr().out)["peak_pressure"]

    saved = tmp_path / "small.nc"
    solved("--save", saved, radius=5e-3)
    expected = solved(radius=2e-2)
    assert solved("--initial", saved, radius=2e-2) == pytest.approx(expected, rel=CLOSE)


@pytest.mark.filterwarnings("ignore:.* have no estimate of their discretisation error")
def test_a_stopped_step_can_be_gone_on_with() -> None:
    contact = nacre.Contact(STEEL, GRID, STEEL)
    held: dict[str, Any] = {"load": 20.0, "friction": 0.3}
    steps = [{"force": (4.0, None)}, {"force": (-2.0, None)}, {"shift": (2e-7, None)}]
    whole = contact.slide(BALL, steps, **held)
    for number, after in ((0, 0), (1, 0), (1, 9), (2, 3)):
        calls = 0

        def progress(
            step: int, _: nacre.types.FrictionReport, number: int = number, after: int = after
        ) -> bool:
            nonlocal calls
            calls += step == number
            return step < number or calls <= after

        stopped = contact.slide(BALL, steps, **held, progress=progress)
        assert stopped[-1].report.termination == "stopped"
        rest = contact.slide(BALL, steps[number:], **held, initial=stopped[-1])
        for one, other in zip(rest, whole[number:], strict=True):
            assert one.report.converged
            if number:
                assert one.traction.tobytes() == other.traction.tobytes()
                assert one.shift == other.shift
            # What goes on from a stopped first step does not start from half the cells, as it did.
            largest, error = np.abs(other.traction).max(), one.report.tolerance
            assert_close(one.traction, other.traction, atol=error * largest)
            assert one.shift is not None
            assert other.shift is not None
            assert_close(one.shift, other.shift, rtol=error)


# Numbers of any size.

SMALL = nacre.Grid((16, 16), (5e-4, 5e-4))
PAIR = nacre.Contact(STEEL, SMALL, STEEL, threads=1)
UNLIKE = nacre.Contact(STEEL, SMALL, threads=1)
PRESS: dict[str, Any] = {"load": 20.0, "friction": 0.2}
PULLED = PRESS | {"force": (1.0, None)}
ROLLED = PRESS | {"direction": "+x", "creepage": (1e-3, None)}
NUMBERS = [math.nan, math.inf, -math.inf, 0.0, -1.0, 5e-324, 1e-300, 1e-30, 1e12, 1e30, 1e300]


def field(value: float) -> Any:
    """Return coefficients of cells, one of which is `value`."""
    values = np.full(SMALL.shape, 0.2)
    values[8, 8] = value
    return values


PLACES: dict[str, Any] = {
    "load": lambda v: {"load": v},
    "approach": lambda v: {"load": None, "approach": v},
    "tilt": lambda v: {"tilt": (v, None)},
    "moment": lambda v: {"moment": (None, v)},
    "eccentricity": lambda v: {"eccentricity": (v, None)},
}
FOUND: dict[str, Any] = PLACES | {
    "friction": lambda v: {"friction": v},
    "frictions": lambda v: {"friction": field(v)},
}
CALLS: dict[str, tuple[Any, dict[str, Any], dict[str, Any]]] = {
    "solve": (UNLIKE.solve, {"load": 20.0}, PLACES),
    "yield": (
        UNLIKE.solve,
        {"load": 20.0, "hardness": 1e9},
        PLACES | {"hardness": lambda v: {"hardness": v}, "each": lambda v: {"hardness": field(v)}},
    ),
    "slide": (
        PAIR.slide,
        PULLED,
        FOUND
        | {
            "force": lambda v: {"force": (v, None)},
            "shift": lambda v: {"force": None, "shift": (1e-7, v)},
            "twist": lambda v: {"twist": v},
            "torque": lambda v: {"torque": v},
        },
    ),
    "roll": (
        PAIR.roll,
        ROLLED,
        FOUND
        | {
            "creepage": lambda v: {"creepage": (v, 1e-4)},
            "spin": lambda v: {"spin": v},
            "force": lambda v: {"creepage": None, "force": (v, None)},
        },
    ),
    "unlike": (UNLIKE.slide, PULLED, {"friction": FOUND["friction"], "load": FOUND["load"]}),
}


@pytest.mark.parametrize(
    ("name", "place"), [(name, place) for name in CALLS for place in CALLS[name][2]]
)
def test_numbers_of_any_size_have_an_answer_or_are_refused(name: str, place: str) -> None:
    call, keywords, places = CALLS[name]
    for value in NUMBERS:
        try:
            solution = quiet(call, BALL, **keywords | places[place](value))
        except ValueError as refusal:
            assert len(str(refusal)) > 12, value  # noqa: PT017
            continue
        normal = getattr(solution, "normal", solution)
        assert solution.report.converged, value
        for field_ in ("pressure", "displacement", "traction", "slip"):
            assert np.isfinite(getattr(solution, field_, 0.0)).all(), value
        numbers = [normal.approach, *normal.tilt, *getattr(solution, "force", ())]
        assert np.isfinite(numbers).all(), value


@pytest.mark.parametrize("power", range(4, 17, 2))
@pytest.mark.parametrize("place", ["layer", "below", "substrate"])
def test_derivatives_of_soft_and_stiff_parts_are_numbers_or_refused(place: str, power: int) -> None:
    soft = nacre.Elastic(210e9 / 10.0**power, 0.3)
    inner, outer = nacre.Layer(soft, 2e-5), nacre.Layer(STEEL, 2e-5)
    body = {
        "layer": nacre.HalfSpace(STEEL, [inner]),
        "below": nacre.HalfSpace(STEEL, [outer, inner]),
        "substrate": nacre.HalfSpace(soft, [outer]),
    }[place]
    try:
        solution = quiet(nacre.solve, BALL, body, grid=SMALL, load=1e5 / 10.0**power)
        gradient = quiet(solution.gradient, "approach")
    except (ValueError, nacre.ConvergenceError) as refusal:
        assert "asymptotes" not in str(refusal)  # noqa: PT017
        return
    assert np.isfinite(gradient.gap).all()


@pytest.mark.parametrize("value", [*NUMBERS, 1.7e308])
def test_stresses_and_displacements_are_finite_or_refused(value: float) -> None:
    solution = quiet(PAIR.solve, BALL, load=20.0)
    calls = (
        lambda: solution.stress(value).xx,
        lambda: solution.stress(1e-5, friction=value, direction=(1, 0)).xx,
        lambda: solution.stress(1e-5, friction=0.1, direction=(value, value)).xx,
        lambda: nacre.Convolution.of_bodies(STEEL, SMALL).apply(field(value)),
    )
    for call in calls:
        try:
            assert np.isfinite(call()).all()
        except ValueError as refusal:
            assert len(str(refusal)) > 12  # noqa: PT017
