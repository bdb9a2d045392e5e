"""`solve` meets what is asked, tells how it went, and leaves Python alive while it works."""

import math
import os
import re
import threading
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, STEEL, coated, quiet
from support import HANG, interrupted, python

COATED = coated(420e9, 40e-6)
PARABOLOID = nacre.Paraboloid(5e-3, 5e-3)
GRID = nacre.Grid(shape=(64, 60), size=(4e-4, 4e-4))
CONTACT = nacre.Contact(COATED, GRID)
LOAD = 10.0

BALANCE = 1e-12  # force and moments are restored after each step
CONVERGED = 1e-6  # of the peak pressure, for solutions of tolerance 1e-8
SIMILAR = 1e-9  # of the peak, where only rounding differs

SCRIPT = """
import nacre
steel = nacre.Elastic(young=210e9, poisson=0.3)
sphere = nacre.Sphere(5e-3)
"""


def largest_difference(a: nacre.Solution, b: nacre.Solution) -> float:
    return float(np.abs(a.pressure - b.pressure).max() / b.peak_pressure)


# Controls.

CONTROLS: list[dict[str, Any]] = [
    {"load": LOAD, "eccentricity": (2e-5, None), "moment": (None, -1e-4)},
    {"load": LOAD, "tilt": (2e-3, None), "eccentricity": (None, -1e-5)},
    {"approach": 5e-7, "moment": (1e-4, None), "tilt": (None, 1e-3)},
]
"""All mixtures are those of tests/contact/invariants.rs."""


@pytest.mark.parametrize("controls", CONTROLS)
def test_what_is_asked_is_met(controls: dict[str, Any]) -> None:
    solution = CONTACT.solve(PARABOLOID, **controls)
    assert solution.report.converged
    assert solution.report.motion == controls
    free = BALANCE * 0.5 * max(GRID.size) * solution.load
    for name, asked in controls.items():
        found = getattr(solution, name)
        if name in ("load", "approach"):
            assert found == pytest.approx(asked, rel=BALANCE)
            continue
        scale = {"eccentricity": solution.load, "moment": 1.0, "tilt": 0.0}[name]
        for one, due in zip(found, asked, strict=True):
            assert due is None or scale * abs(one - due) <= free
            assert due is None or scale > 0 or one == due


@pytest.mark.parametrize("field", ["gap", "displacement", "pressure"])
def test_no_field_holds_nan_and_only_gaps_are_infinite(field: str) -> None:
    with pytest.warns(nacre.NacreWarning, match="sharp edge"):
        solution = CONTACT.solve(nacre.FlatPunch(1e-4), load=LOAD)
    array = getattr(solution, field)
    cannot_touch = np.hypot(*np.meshgrid(solution.x, solution.y, indexing="ij")) > 1e-4
    np.testing.assert_array_equal(~np.isfinite(array), cannot_touch & (field == "gap"))
    assert not solution.in_contact[cannot_touch].any()


# Bodies.


def test_a_material_is_a_half_space_and_both_bodies_are_pressed() -> None:
    def pressed(*bodies: Any) -> nacre.Solution:
        return nacre.solve(BALL, *bodies, load=LOAD, grid=GRID)

    of_material, of_body = pressed(STEEL), pressed(nacre.HalfSpace(STEEL))
    np.testing.assert_array_equal(of_material.pressure, of_body.pressure)
    # Two equal bodies are one of half the modulus.
    one_of_half = pressed(nacre.Elastic(105e9, 0.3))
    assert largest_difference(pressed(STEEL, STEEL), one_of_half) < SIMILAR


# The grid that is chosen.

WITHOUT_GRID: dict[str, tuple[nacre.types.Shape, float]] = {
    "sphere": (BALL, 10.0),
    "sphere elsewhere": (BALL.shifted(1e-3, -2e-3), 10.0),
    "paraboloid": (PARABOLOID, 1.0),
    "elliptic": (nacre.Paraboloid(50e-3, 5e-3), 10.0),
    "roller": (nacre.Roller(5e-3, flat_length=1e-3, crown_radius=1.0), 20.0),
}


@pytest.mark.parametrize(("shape", "load"), WITHOUT_GRID.values(), ids=WITHOUT_GRID.keys())
def test_a_grid_is_chosen(shape: nacre.types.Shape, load: float) -> None:
    solution = nacre.solve(shape, COATED, load=load, tolerance=1e-5)
    assert solution.load == pytest.approx(load, rel=BALANCE)
    grid, extent = solution.report.grid, solution.contact_extent
    widths = [high - low for low, high in extent]
    cells = [width / spacing for width, spacing in zip(widths, grid.spacing, strict=True)]
    assert min(cells) >= 64
    for axis in (0, 1):
        low = grid.center[axis] - 0.5 * grid.size[axis]
        high = grid.center[axis] + 0.5 * grid.size[axis]
        for margin in (extent[axis][0] - low, high - extent[axis][1]):
            assert 0.2 < margin / widths[axis] < 0.35


def test_the_cells_of_a_chosen_grid_are_limited_at_a_stated_cost() -> None:
    roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5)
    free = nacre.solve(roller, STEEL, load=1e3)
    assert free.pressure.size > 16384
    capped = nacre.solve(roller, STEEL, load=1e3, max_cells=16384)
    assert capped.pressure.size <= 16384
    found, fine = (s.report.discretisation for s in (capped, free))
    assert found is not None
    assert fine is not None
    cost, least = (estimate["peak_pressure"] for estimate in (found, fine))
    assert cost is not None
    assert least is not None
    assert cost > least
    assert abs(capped.peak_pressure - free.peak_pressure) < 3 * cost
    # A contact of friction is on the same grid.
    slid = nacre.slide(roller, STEEL, STEEL, load=1e3, friction=0.1, max_cells=16384)
    assert slid.pressure.size <= 16384
    with pytest.raises(ValueError, match="max_cells must be an integer of at least 4096, got 100"):
        nacre.solve(roller, STEEL, load=1e3, max_cells=100)
    with pytest.raises(ValueError, match="max_cells must not be given beside grid"):
        nacre.solve(BALL, STEEL, load=1.0, grid=GRID, max_cells=4096)


def test_a_punch_has_a_grid_that_holds_it() -> None:
    with pytest.warns(nacre.NacreWarning, match="sharp edge"):
        solution = nacre.solve(nacre.FlatPunch(1e-3), COATED, load=LOAD)
    assert solution.contact_area == pytest.approx(math.pi * 1e-6, rel=0.02)  # cells on the rim
    assert not solution.in_contact[[0, -1], :].any()
    assert not solution.in_contact[:, [0, -1]].any()


@pytest.mark.parametrize("moved", [False, True])
def test_a_height_map_is_solved_on_its_own_grid(moved: bool) -> None:
    heights = 1e-9 * np.random.default_rng(1).standard_normal((30, 40))
    rough = nacre.HeightMap(heights, spacing=(1e-6, 2e-6), center=(1e-5, 0.0))
    shape = rough + BALL.shifted(1e-5, 0.0)
    if moved:
        shape = shape.shifted(0.0, 3e-5)
    grid = nacre.solve(shape, STEEL, load=0.05).report.grid
    assert grid.shape == (30, 40)
    assert grid.spacing == pytest.approx((1e-6, 2e-6))
    assert grid.center == pytest.approx((1e-5, 3e-5 if moved else 0.0))


def test_a_shape_without_end_needs_a_grid() -> None:
    cylinder = nacre.Cylinder(5e-3)
    with pytest.raises(ValueError, match="grid must be given"):
        nacre.solve(cylinder, STEEL, load=LOAD)
    with pytest.warns(nacre.NacreWarning, match="edge of the grid"):
        nacre.solve(cylinder, STEEL, load=LOAD, grid=GRID)


# Where it starts, and how it ends.


def test_the_elastic_energy_is_that_of_hertz() -> None:
    # Johnson, Contact Mechanics, (4.23): W is proportional to δ^(3/2), and U = (2/5) W δ.
    solution = nacre.solve(BALL, STEEL, load=10.0)
    hertz = 0.4 * solution.load * solution.approach
    assert solution.elastic_energy == pytest.approx(hertz, rel=1e-3)
    assert solution.to_xarray().attrs["elastic_energy"] == solution.elastic_energy
    line = nacre.solve(nacre.Cylinder(5e-3), STEEL, load=1e5, grid=nacre.Grid.line(64, 4e-4))
    strip = nacre.Grid((16, 64), (1e-3, 4e-4), periodic=(True, False))
    length = strip.size[0]
    whole = nacre.solve(nacre.Cylinder(5e-3), STEEL, load=1e5 * length, grid=strip)
    assert line.elastic_energy * length == pytest.approx(whole.elastic_energy, rel=1e-6)


def test_a_solution_is_taken_to_start_from() -> None:
    first = CONTACT.solve(BALL, load=LOAD)
    again = CONTACT.solve(BALL, load=LOAD, initial=first)
    from_array = CONTACT.solve(BALL, load=LOAD, initial=first.pressure)
    assert again.report.iterations < first.report.iterations / 2
    np.testing.assert_array_equal(from_array.pressure, again.pressure)
    assert largest_difference(again, first) < CONVERGED


def test_an_unfinished_solution_is_carried_by_its_error_or_returned_unchecked() -> None:
    with pytest.raises(nacre.ConvergenceError, match="after 2 iterations") as caught:
        CONTACT.solve(BALL, load=LOAD, max_iterations=2)
    unfinished = caught.value.solution
    assert type(unfinished) is nacre.Solution
    assert unfinished.report.termination == "iteration limit"
    assert not unfinished.report.converged
    assert unfinished.report.iterations == 2
    assert unfinished.report.residual > 1e-8
    assert unfinished.load == pytest.approx(LOAD, rel=BALANCE)
    unchecked = CONTACT.solve(BALL, load=LOAD, max_iterations=2, check=False)
    assert unchecked.report.termination == "iteration limit"
    np.testing.assert_array_equal(unchecked.pressure, unfinished.pressure)


def test_an_error_is_not_preceded_by_warnings_of_what_it_carries(
    recwarn: pytest.WarningsRecorder,
) -> None:
    few = nacre.Grid((16, 16), (4e-4, 4e-4))
    for unfinished in (
        lambda: nacre.solve(BALL, COATED, load=20.0, max_iterations=2),
        lambda: nacre.slide(
            BALL, COATED, load=10.0, grid=few, friction=0.3, force=(2.0, 0.0), max_convolutions=1
        ),
    ):
        with pytest.raises(nacre.ConvergenceError) as caught:
            unfinished()
        assert caught.value.solution.report.warnings  # of a draft, which say nothing of the contact
    assert list(recwarn) == []


def test_a_report_tells_what_was_done() -> None:
    solution = nacre.solve(BALL, COATED, load=LOAD, grid=GRID, tolerance=1e-6)
    report = solution.report
    assert (report.converged, report.termination) == (True, "converged")
    assert report.iterations > 0
    assert report.convolutions > 0
    assert report.residual <= 1e-6
    assert report.overlap <= 1e-6
    assert max(report.balance) < BALANCE
    assert len(report.warnings) == 0
    assert report.grid == GRID
    assert report.seconds > 0.0
    touching = np.isfinite(solution.gap)
    work = (solution.pressure * solution.displacement)[touching].sum()
    residual = (solution.pressure * np.abs(solution.gap))[touching].sum() / work
    assert report.residual == pytest.approx(residual, rel=1e-6)


def test_a_report_holds_what_repeats_the_run() -> None:
    given = nacre.influence_coefficients(COATED, GRID, "image", 2)
    given += nacre.influence_coefficients(STEEL, GRID, "image", 2)
    contact = nacre.Contact(COATED, GRID, STEEL, coefficients=given)
    asked: dict[str, Any] = {"load": LOAD, "eccentricity": (1e-5, None), "tilt": (None, 1e-4)}
    first = contact.solve(BALL, tolerance=1e-7, **asked)
    report = first.report
    assert report.motion == asked
    assert first.coefficients is not None
    np.testing.assert_array_equal(first.coefficients, given)
    again = nacre.Contact(
        report.body, report.grid, report.counterbody, coefficients=first.coefficients
    ).solve(BALL, tolerance=report.tolerance, **report.motion)
    np.testing.assert_array_equal(again.pressure, first.pressure)


# Progress.


def test_progress_is_told_of_each_iteration() -> None:
    told: list[nacre.types.Report] = []
    solution = CONTACT.solve(BALL, load=LOAD, progress=told.append)
    assert all(type(report) is nacre.types.Report for report in told)
    assert len(told) > 2
    assert {report.termination for report in told} == {"running"}
    assert told[-1].residual < told[0].residual
    seconds = [report.seconds for report in told]
    assert seconds == sorted(seconds)
    assert largest_difference(solution, CONTACT.solve(BALL, load=LOAD)) == 0.0


@pytest.mark.parametrize("error", [ZeroDivisionError("mine"), KeyboardInterrupt(), SystemExit(3)])
@pytest.mark.parametrize("grid", [GRID, None], ids=["grid", "no grid"])
def test_an_exception_of_progress_is_raised_as_it_is(
    error: BaseException, grid: nacre.Grid | None
) -> None:
    calls = 0

    def progress(report: nacre.types.Report) -> None:
        nonlocal calls
        calls += 1
        raise error

    with pytest.raises(type(error)) as caught:
        nacre.solve(BALL, COATED, load=LOAD, grid=grid, progress=progress)
    assert caught.value is error
    assert calls == 1


@pytest.mark.parametrize("no", [False, np.False_], ids=["bool", "numpy.bool"])
def test_progress_that_returns_false_stops(no: object) -> None:
    calls = 0

    def progress(report: nacre.types.Report) -> object:
        nonlocal calls
        calls += 1
        return no if calls == 3 else None

    # Unfinished, it may be anything, with warnings.
    solution = quiet(CONTACT.solve, BALL, load=LOAD, progress=progress)
    assert calls == 3
    assert solution.report.termination == "stopped"
    assert not solution.report.converged
    assert solution.load == pytest.approx(LOAD, rel=BALANCE)
    # That stops the search for a grid, too.
    searched = quiet(nacre.solve, BALL, COATED, load=LOAD, progress=lambda report: no)
    assert searched.report.termination == "stopped"


@pytest.mark.parametrize("answer", [None, True, np.True_, 1, "text"])
def test_progress_that_returns_anything_else_goes_on(answer: object) -> None:
    assert CONTACT.solve(BALL, load=LOAD, progress=lambda report: answer).report.converged


# Warnings.

SHARP = nacre.Roller(5e-3, flat_length=1e-3, crown_radius=1.0, length=1.1e-3)
SHARP_GRID = nacre.Grid(shape=(65, 64), size=(1.3e-3, 3e-4))

EDGED = nacre.HalfSpace(STEEL, ends=SHARP.ends)
COATED_EDGE = nacre.HalfSpace(STEEL, COATED.layers, ends=SHARP.ends)
SPOTS = nacre.HeightMap(1e-6 * (np.indices((24, 24)).sum(axis=0) % 4 == 0), 1e-5) + BALL


def roller(*bodies: Any) -> nacre.Solution:
    return nacre.solve(SHARP, *bodies, grid=SHARP_GRID, load=50.0)


WARNINGS: dict[str, tuple[Callable[[], nacre.Solution], str]] = {
    "grid edge": (lambda: CONTACT.solve(BALL, load=1e3), r"edge of the grid"),
    "sharp end of a roller": (lambda: roller(STEEL), r"reaches the end .* along x"),
    "free end of a roller": (
        lambda: roller(STEEL, EDGED),
        r"free end of one body along x, beyond which the other extends",
    ),
    "free end of a coated roller": (
        lambda: roller(STEEL, COATED_EDGE),
        r"body with layers has a free end: what the end adds .* is a model, with an error",
    ),
    "sharp edge of a punch": (
        lambda: nacre.solve(nacre.FlatPunch(1e-4), STEEL, load=LOAD),
        r"reaches a sharp edge",
    ),
    "rim of a height map": (
        lambda: nacre.solve(nacre.HeightMap(np.zeros((20, 20)), 1e-5), STEEL, load=LOAD),
        r"rim of the measured map along y",
    ),
    "coarse spots": (
        lambda: nacre.solve(SPOTS, STEEL, load=LOAD),
        r"spots .* only \d\.\d cells wide",
    ),
    "coarse": (lambda: CONTACT.solve(BALL, load=0.05), r"only \d cells wide along y"),
    "large contact": (
        lambda: nacre.solve(nacre.Sphere(1e-4), STEEL, load=50.0),
        r"not small compared with the radius .* 0\.[2-9]",
    ),
}


@pytest.mark.parametrize(("call", "message"), WARNINGS.values(), ids=WARNINGS.keys())
def test_each_warning_is_issued_and_reported(
    call: Callable[[], nacre.Solution], message: str
) -> None:
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always")
        solution = call()
    messages = [str(warning.message) for warning in issued]
    assert any(re.search(message, text) for text in messages), messages
    assert messages == list(solution.report.warnings)
    kinds = solution.report.warning_kinds
    assert len(kinds) == len(messages)
    # A warning that is counted by its kind comes back from a file.
    assert nacre.types.Report.from_dict(solution.report.to_dict()).warning_kinds == kinds
    assert {warning.category for warning in issued} == {nacre.NacreWarning}
    # They point at the call, which is above.
    assert {warning.filename for warning in issued} == {__file__}
    here = test_each_warning_is_issued_and_reported.__code__.co_firstlineno
    assert all(warning.lineno < here for warning in issued)
    assert solution.report.converged


def test_a_contact_of_spots_prints_its_share_of_the_grid() -> None:
    spots = quiet(nacre.solve, SPOTS, STEEL, load=LOAD)
    assert f"share          {100 * spots.contact_share:.3g} % of the grid" in str(spots)
    assert "share" not in str(nacre.solve(BALL, STEEL, load=LOAD))


def test_a_peak_beside_the_middle_is_printed_in_the_middle() -> None:
    ball = CONTACT.solve(BALL, load=LOAD)
    half = [pytest.approx(0.5 * side) for side in ball.report.grid.spacing]
    assert [*map(abs, ball.peak_position)] == half
    middle = re.compile(r"\nat +\(0 m, 0 m\)\n")
    assert middle.search(str(ball))
    assert not middle.search(str(CONTACT.solve(BALL.shifted(2e-5, 0.0), load=LOAD)))


@pytest.mark.parametrize("body", [STEEL, coated(20e9, 20e-6)])
def test_the_error_of_a_cylinder_without_a_grid_names_one(
    body: nacre.Elastic | nacre.HalfSpace,
) -> None:
    cylinder = nacre.Cylinder(5e-3)
    with pytest.raises(ValueError, match=r"grid must be given") as caught:
        nacre.solve(cylinder, body, load=1e5)
    named = re.search(r"Grid\.line\((\d+), (\S+)\)", str(caught.value))
    assert named is not None
    solution = nacre.solve(
        cylinder, body, load=1e5, grid=nacre.Grid.line(int(named[1]), float(named[2]))
    )
    assert solution.report.warnings == []
    assert solution.in_contact.mean() > 0.25


def test_a_warning_can_be_made_an_error() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", nacre.NacreWarning)
        with pytest.raises(nacre.NacreWarning, match="edge of the grid"):
            CONTACT.solve(BALL, load=1e3)


# Threads, processes, signals.


# Enough cells, and enough of them in contact, for the work to be shared among threads.
FINE_GRID = nacre.Grid(shape=(280, 270), size=(4e-4, 4e-4))
HEAVY = 250.0


@pytest.mark.slow
def test_solves_of_one_plan_may_wait_for_each_other() -> None:
    # More solves than threads: were a thread held by each that waits, the third would not begin.
    contact = nacre.Contact(COATED, FINE_GRID, threads=2)
    expected = contact.solve(BALL, load=HEAVY).pressure
    for _ in range(4):
        meeting = threading.Barrier(3)

        def solve(meeting: threading.Barrier = meeting) -> nacre.Solution:
            def wait(report: nacre.types.Report) -> None:
                if report.iterations == 1:
                    meeting.wait(timeout=HANG)  # raises where one of them does not come

            return contact.solve(BALL, load=HEAVY, progress=wait)

        with ThreadPoolExecutor(3) as executor:
            for solved in [executor.submit(solve) for _ in range(3)]:
                np.testing.assert_array_equal(solved.result().pressure, expected)


@pytest.mark.slow
def test_other_threads_run_during_a_solve() -> None:
    # The solve never ends by itself, since no gap is that small. The other thread, which runs only
    # where the solve lets it, ends it.
    script = f"""{SCRIPT}
import sys, threading
contact = nacre.Contact(steel, nacre.Grid(shape=(280, 270), size=(4e-4, 4e-4)), threads=1)
begin, seen = threading.Event(), []

def look():
    begin.wait()
    seen.append(True)

threading.Thread(target=look, daemon=True).start()
sys.setswitchinterval(1e6)
begin.set()
contact.solve(
    sphere, load=250.0, tolerance=1e-300, max_iterations=10**9, algorithm="polonsky-keer",
    progress=lambda report: not seen, check=False,
)
"""
    assert python("-c", script).returncode == 0


@pytest.mark.skipif(os.name != "posix", reason="sends a signal to a process")
@pytest.mark.parametrize(
    "solve",
    [
        "contact.solve(sphere, load=250.0, **endless)",
        "contact.solve(sphere, load=250.0, algorithm='polonsky-keer', **endless)",
        "contact.solve_many(2 * [{'shape': sphere, 'load': 250.0}], **endless)",
    ],
)
def test_ctrl_c_stops_a_solve(solve: str) -> None:
    # No gap is as small as the tolerance: iterations without end.
    setup = f"""{SCRIPT}
contact = nacre.Contact(steel, nacre.Grid(shape=(280, 270), size=(4e-4, 4e-4)))
endless = dict(tolerance=1e-300, max_iterations=10**12)
"""
    assert interrupted(setup, solve) == (2 if "many" in solve else 0)


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_plan_solves_in_a_forked_child() -> None:
    script = f"""{SCRIPT}
import os, signal, warnings
warnings.simplefilter("ignore", DeprecationWarning)  # that there are threads is the point
contact = nacre.Contact(steel, nacre.Grid(shape=(280, 270), size=(4e-4, 4e-4)), threads=2)
pressure = contact.solve(sphere, load=250.0).pressure
child = os.fork()
if child == 0:
    signal.alarm(600)  # a child that hangs
    same = (contact.solve(sphere, load=250.0).pressure == pressure).all()
    os._exit(0 if same else 1)
_, status = os.waitpid(child, 0)
assert os.waitstatus_to_exitcode(status) == 0, status
assert (contact.solve(sphere, load=250.0).pressure == pressure).all()
"""
    assert python("-c", script).returncode == 0
