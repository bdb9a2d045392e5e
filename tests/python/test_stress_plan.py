"""A plan of stress gives the bits of the solution's methods, for either body; it can be stopped."""

import os
import signal
import threading
import time
from typing import Literal

import numpy as np
import pytest

import nacre

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
HARD = nacre.Elastic(young=420e9, poisson=0.2)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(HARD, thickness=20e-6)])
GRID = nacre.Grid(shape=(41, 31), size=(4.1e-4, 3.1e-4))


@pytest.fixture(scope="module")
def solution() -> nacre.Solution:
    return nacre.solve(nacre.Sphere(5e-3), COATED, HARD, grid=GRID, load=5.0)


@pytest.mark.parametrize("body", ["body", "counterbody"])
def test_it_gives_the_bits_of_the_solution(
    solution: nacre.Solution, body: Literal["body", "counterbody"]
) -> None:
    plan = solution.stress_plan(body, threads=1)
    report = solution.report
    assert plan.body == (report.body if body == "body" else report.counterbody)
    for _ in range(2):
        assert plan.stress(1e-5, friction=0.2, direction=(1.0, 0.0)) == solution.stress(
            1e-5, friction=0.2, direction=(1.0, 0.0), body=body
        )
        section = plan.stress([0.0, 2e-5], y=0.0, side="above", displacement=True)
        whole = solution.stress([0.0, 2e-5], y=0.0, side="above", displacement=True, body=body)
        assert section == whole
        summary = plan.summary(yield_stress={"substrate": 2e9}, residual=[-1e9])
        assert summary == solution.stress_summary(
            yield_stress={"substrate": 2e9},
            residual=[-1e9],
            body=body,
        )


def test_it_outlives_the_name_of_its_solution() -> None:
    plan = nacre.solve(nacre.Sphere(5e-3), COATED, grid=GRID, load=5.0).stress_plan()
    assert plan.stress(0.0).zz.min() < 0.0


def test_it_is_told_and_stopped(solution: nacre.Solution) -> None:
    plan = solution.stress_plan()
    told: list[float] = []
    plan.stress(np.linspace(0.0, 4e-5, 5), progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0
    stopped = plan.stress(np.linspace(0.0, 4e-5, 5), progress=lambda part: part < 0.5)
    assert 0 < stopped.z.size < 5
    assert not plan.summary(progress=lambda part: part < 0.5).finished


def test_an_error_of_the_callback_comes_through(solution: nacre.Solution) -> None:
    def fail(part: float) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        solution.stress_plan().stress([0.0, 1e-5], progress=fail)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_interrupts_it(solution: nacre.Solution) -> None:
    plan = solution.stress_plan()
    timer = threading.Timer(0.3, lambda: signal.raise_signal(signal.SIGINT))
    start = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        plan.stress(np.linspace(0.0, 1e-3, 20_000), friction=0.3, direction=(1.0, 0.0))
    assert time.monotonic() - start < 10.0


def test_bad_arguments_are_refused(solution: nacre.Solution) -> None:
    with pytest.raises(ValueError, match='body must be "body" or "counterbody", got "table"'):
        solution.stress_plan("table")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"threads must be .*at least 1, got 0"):
        solution.stress_plan(threads=0)
    rigid = nacre.solve(nacre.Sphere(5e-3), COATED, grid=GRID, load=5.0)
    with pytest.raises(ValueError, match='body must be "body" where the counterbody is rigid'):
        rigid.stress_plan("counterbody")
    plan = rigid.stress_plan()
    with pytest.raises(TypeError, match=r"StressPlan\.stress must be among .* got 'threads'"):
        plan.stress(0.0, threads=1)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"StressPlan\.summary must be among .* got 'side'"):
        plan.summary(side="above")  # type: ignore[call-arg]
