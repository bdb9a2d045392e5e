"""Many load cases on one plan: order, errors that say which case, and what an interrupt keeps."""

import signal
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, STEEL
from support import assert_close

CONTACT = nacre.Contact(STEEL, nacre.Grid(shape=(64, 48), size=(3e-4, 3e-4)), threads=2)
CASES = [{"shape": BALL, "load": load} for load in (10.0, 3.0, 5.0, 2.5, 8.0, 4.0)]


def test_solutions_are_in_order_and_those_of_solve() -> None:
    told: list[tuple[int, int]] = []

    def progress(done: int, total: int) -> bool:
        told.append((done, total))
        return False  # is ignored

    solutions = CONTACT.solve_many(CASES, progress=progress)
    assert told[-1] == (len(CASES), len(CASES))
    for case, solution in zip(CASES, solutions, strict=True):
        alone = CONTACT.solve(**case)  # type: ignore[arg-type]
        assert solution.approach == alone.approach
        for field in ("pressure", "gap", "displacement"):
            np.testing.assert_array_equal(getattr(solution, field), getattr(alone, field))


def test_cases_take_every_freedom_and_any_iterable() -> None:
    motions: list[dict[str, Any]] = [
        {"approach": 1e-6, "tilt": (1e-4, None)},
        {"load": 5.0, "eccentricity": (1e-5, None), "moment": (None, 1e-5)},
    ]
    solutions = CONTACT.solve_many({"shape": BALL, **motion} for motion in motions)
    assert [solution.report.motion for solution in solutions] == motions


@pytest.mark.parametrize(
    ("case", "error", "message"),
    [
        ({"shape": BALL, "load": -1.0}, ValueError, "load must be"),
        ({"shape": BALL, "laod": 1.0}, TypeError, "keys of a case must be among shape, load"),
        ({"load": 1.0}, TypeError, "a case must have a shape"),
        ({"shape": 5.0, "load": 1.0}, TypeError, "shape must be a nacre.Shape"),
        (7, TypeError, "a case must be a mapping"),
    ],
)
def test_an_error_says_which_case_it_is_of(case: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message) as raised:
        CONTACT.solve_many([*CASES, case, CASES[0]])
    assert raised.value.__notes__ == [f"in case {len(CASES)}"]
    if case == {"shape": BALL, "load": -1.0}:  # the others are not lost
        solutions = raised.value.solutions  # type: ignore[attr-defined]
        lost = [solution is None for solution in solutions]
        assert lost == [False] * len(CASES) + [True, False]
        np.testing.assert_array_equal(solutions[-1].pressure, solutions[0].pressure)


def test_what_is_no_list_of_cases_is_named() -> None:
    with pytest.raises(TypeError, match="cases must be an iterable of mappings, got 5"):
        CONTACT.solve_many(5)  # type: ignore[arg-type]


def test_a_case_that_misses_its_tolerance_raises_with_all_solutions() -> None:
    with pytest.raises(nacre.ConvergenceError) as raised:
        CONTACT.solve_many(CASES, max_iterations=1, algorithm="polonsky-keer")
    solutions = raised.value.solutions  # type: ignore[attr-defined]
    assert all(not solution.report.converged for solution in solutions)
    unchecked = CONTACT.solve_many(CASES, max_iterations=1, algorithm="polonsky-keer", check=False)
    for solution, same in zip(unchecked, solutions, strict=True):
        np.testing.assert_array_equal(solution.pressure, same.pressure)


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError])
def test_what_interrupts_it_carries_what_was_finished(error: type[BaseException]) -> None:
    told: list[int] = []

    def interrupt(done: int, total: int) -> None:
        if done >= 3:
            told.append(done)
            if error is KeyboardInterrupt:
                signal.raise_signal(signal.SIGINT)
            else:
                raise error

    # Many more than are finished when it is told first.
    cases = CASES * 400
    with pytest.raises(error) as raised:
        CONTACT.solve_many(cases, progress=interrupt)
    solutions = raised.value.solutions  # type: ignore[attr-defined]
    finished = [solution for solution in solutions if solution is not None]
    assert told[-1] <= len(finished) < len(solutions) == len(cases)
    assert all(solution.report.converged for solution in finished)


def test_stiffness_of_a_copy_without_its_plan_is_the_same_to_rounding() -> None:
    """A copy from data plans the free ends anew, and coefficients as far as its contact alone."""
    body = nacre.HalfSpace(nacre.Elastic(210e9, 0.3), ends=(-9e-5, None))
    solution = nacre.solve(BALL, body, load=10.0, grid=nacre.Grid((40, 32), (3e-4, 2e-4)))
    copy = nacre.Solution.from_dict(solution.to_dict())
    stiffness = solution.stiffness()
    # Entries over the geometric mean of their diagonals; some hundred roundings of solves.
    scale = np.sqrt(np.outer(stiffness.diagonal(), stiffness.diagonal()))
    assert_close(copy.stiffness() / scale, stiffness / scale, atol=1e-13)


def test_stiffness_is_a_symmetric_array() -> None:
    solution = CONTACT.solve(BALL, load=10.0)
    stiffness = solution.stiffness()
    assert stiffness.shape == (3, 3)
    # Entries over the geometric mean of their diagonals.
    scale = np.sqrt(np.outer(stiffness.diagonal(), stiffness.diagonal()))
    assert_close(stiffness / scale, stiffness.T / scale, atol=1e-10)
