"""A contact is a function of its numbers and gaps, whose derivatives are those of its values."""

import threading
import time
from typing import Any

import numpy as np
import pytest

import nacre
from nacre._differentiable import Differentiable

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
HARD = nacre.Elastic(young=420e9, poisson=0.2)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(HARD, thickness=20e-6)])
BALL = nacre.Sphere(5e-3)
GRID = nacre.Grid(shape=(24, 22), size=(2e-4, 1.9e-4))
SHEAR = {"stress": "von_mises", "at": (1e-5, 0.0, 3e-5)}
OUTPUTS = {"approach": "approach", "norm": ("pressure_norm", 16.0), "shear": SHEAR}
NUMBERS = {
    "body.layers[0].material.young": 420e9,
    "body.layers[0].thickness": 20e-6,
    "counterbody.substrate.poisson": 0.3,
    "load": 10.0,
    "shape.radius": 5e-3,
}
DIFFERENCE = 2e-7
"""Relative error of a central difference with relative steps of 1e-5, within the valid step."""


def contact(outputs: Any = OUTPUTS, keep: int = 16, **changes: Any) -> Differentiable:
    given = {"shape": BALL, "body": COATED, "counterbody": STEEL, "grid": GRID, "load": 10.0}
    # Differences of relative steps of 1e-5 lose five digits of the solves.
    return Differentiable({**given, "tolerance": 1e-13, **changes}, outputs, keep)


def check(made: Differentiable, names: tuple[str, ...], x: np.ndarray, step: np.ndarray) -> None:
    """Compare push and pull with differences along a step, and with each other."""
    rng = np.random.default_rng(7)
    ahead, behind = (made.values(names, x + sign * step) for sign in (1, -1))
    pushes = (made.pressure_push, made.outputs_push)
    pulls = (made.pressure_pull, made.outputs_pull)
    for k in range(2):
        rate = pushes[k](names, x, step)
        difference = (ahead[k] - behind[k]) / 2
        assert rate == pytest.approx(difference, rel=DIFFERENCE, abs=DIFFERENCE * abs(rate).max())
        weights = rng.normal(size=len(rate)) / np.where(rate == 0, 1.0, abs(rate))
        pulled = pulls[k](names, x, weights)
        assert pulled @ step == pytest.approx(weights @ rate, rel=1e-6)


def test_derivatives_are_those_of_the_values() -> None:
    names = tuple(NUMBERS)
    x = np.array([*NUMBERS.values()])
    check(contact(), names, x, 1e-5 * x * [1.0, -2.0, 0.5, 1.0, -0.5])


@pytest.mark.parametrize("motion", [{"load": 10.0}, {"load": None, "approach": 6e-7}])
def test_a_gap_is_added_to_the_shape(motion: dict[str, Any]) -> None:
    rng = np.random.default_rng(1)
    (path,) = (name for name, value in motion.items() if value is not None)
    names = (path, "shape.radius")
    gap = 1e-9 * rng.normal(size=GRID.shape)
    x = np.concatenate([[motion[path], 5e-3], gap.ravel()])
    step = np.concatenate([x[:2] * 1e-5, 1e-12 * rng.normal(size=gap.size)])
    made = contact(outputs={"load": "load", **OUTPUTS}, **motion)
    check(made, names, x, step)
    # All of the gap moves the origin of the approach.
    here, lifted = made.values(names, x), made.values(names, x + 0.0)
    assert np.array_equal(here[0], lifted[0])
    shift = np.concatenate([np.zeros(2), np.full(gap.size, 1e-7)])
    if path == "load":
        there = made.values(names, x + shift)
        assert there[1][1] - here[1][1] == pytest.approx(1e-7, rel=1e-6)
        assert there[0] == pytest.approx(here[0], rel=1e-6)
    else:
        there = made.values(names, x + shift + [1e-7, 0.0, *np.zeros(gap.size)])
        assert there[0] == pytest.approx(here[0], rel=1e-6)


def test_a_gap_alone_is_a_whole_shape() -> None:
    made, known = contact(shape=None), contact()
    gap = BALL.gaps(GRID)
    pressure, outputs = made.values((), gap.ravel() + 3e-8)
    expected, others = known.values((), np.zeros(0))
    assert pressure == pytest.approx(expected, rel=1e-9, abs=1e-9 * expected.max())
    assert outputs - [3e-8, 0.0, 0.0] == pytest.approx(others, rel=1e-9)


@pytest.mark.parametrize(
    ("grid", "shape", "load"),
    [
        (nacre.Grid.line(40, 1e-4), nacre.Cylinder(5e-3), 1e4),
        (nacre.Grid((24, 20), (1e-3, 9e-4), periodic=(True, True)), None, 20.0),
        (nacre.Grid((24, 40), (1e-3, 2e-4), periodic=(True, False)), nacre.Cylinder(5e-3), 100.0),
    ],
)
def test_lines_and_periodic_grids_have_gaps(
    grid: nacre.Grid, shape: nacre.types.Shape | None, load: float
) -> None:
    made = Differentiable(
        {"shape": shape, "body": STEEL, "grid": grid, "load": load, "tolerance": 1e-13},
        ["approach"],
        16,
    )
    wave = np.cos(2 * np.pi * np.add.outer(grid.x / grid.size[0], grid.y / grid.size[1]))
    x = np.concatenate([[load], 1e-8 * wave.ravel()])
    step = np.concatenate([[load * 1e-5], 1e-12 * np.random.default_rng(0).normal(size=wave.size)])
    check(made, ("load",), x, step)


def test_kept_solutions_change_no_result() -> None:
    names = tuple(NUMBERS)
    one, none = contact(), contact(keep=1)
    start = np.array([*NUMBERS.values()])
    xs = [start * (1 + 1e-3 * k) for k in range(3)]
    weights = np.random.default_rng(2).normal(size=GRID.shape).ravel()
    for x in [*xs, *xs]:
        fresh = contact()
        assert all(map(np.array_equal, one.values(names, x), fresh.values(names, x)))
        pulled = [made.pressure_pull(names, x, weights) for made in (one, none, fresh)]
        assert np.array_equal(pulled[0], pulled[1])
        assert np.array_equal(pulled[0], pulled[2])


def test_a_derivative_does_not_solve_again() -> None:
    made, names, x = contact(), ("load",), np.array([10.0])
    made.values(names, x)
    point = made.point(names, x)
    made.pressure_pull(names, x, np.ones(GRID.shape[0] * GRID.shape[1]))
    assert made.point(names, x.copy()) is point


def test_threads_share_a_contact() -> None:
    names, xs = ("load",), [np.array([9.0 + 0.25 * k]) for k in range(8)]
    expected = [contact().values(names, x) for x in xs]
    made, found = contact(keep=2), {}

    def run(order: int) -> None:
        for k in range(len(xs))[::order]:
            found[order, k] = made.values(names, xs[k])
            time.sleep(0)

    threads = [threading.Thread(target=run, args=(order,)) for order in (1, -1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for (_, k), values in found.items():
        assert all(map(np.array_equal, values, expected[k]))
    assert len(found) == 16


def kink() -> tuple[Differentiable, float]:
    """Return a contact, and a load at which a cell is about to leave it, by bisection."""
    grid = nacre.Grid(shape=(16, 16), size=(2e-4, 2e-4))
    made = contact(body=STEEL, counterbody=None, grid=grid, outputs=["approach"])

    def cells(load: float) -> int:
        return int((made.values(("load",), np.array([load]))[0] > 0).sum())

    low, high = 10.0, 15.0
    few = cells(low)
    assert cells(high) > few
    while high - low > 1e-14 * high:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (low, middle) if cells(middle) > few else (middle, high)
    return made, high


def test_a_kink_is_told_once() -> None:
    made, load = kink()
    names, x = ("load",), np.array([load])

    def derivatives() -> None:
        made.pressure_push(names, x, np.ones(1))
        made.outputs_pull(names, x, np.ones(1))
        made.pressure_pull(names, x, np.ones(256))

    with pytest.warns(nacre.NacreWarning, match="about to join or to leave") as told:
        derivatives()
    assert len(told) == 1


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"loads": 1.0}, r"arguments of nacre.solve, got \['loads'\]"),
        ({"initial": None}, "must not have"),
        ({"grid": None}, "grid must be a Grid"),
        ({"keep": 0}, "keep must be a number of solutions, 1 or more, got 0"),
        ({"outputs": "approach"}, "a list of words or a dict"),
        ({"outputs": ["approach", "approach"]}, "different words"),
        ({"outputs": [("pressure_norm", 2.0)]}, "a dict that names the others"),
        ({"outputs": {1: "approach"}}, "names of outputs must be text, got 1"),
    ],
)
def test_what_cannot_be_right_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        contact(**changes)


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("tolerance", "must be paths that begin with one of body, counterbody"),
        ("body.layers[1].thickness", "parameters must name parameters .* no 1"),
        ("shape.radios", "no radios"),
        ("shape", "parameters must name numbers of the arguments, got 'shape'"),
        ("approach", "got 'approach'"),
        (3, "got 3"),
    ],
)
def test_what_is_no_path_is_refused(path: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        contact().check([path], gap=False)


def test_a_gap_is_needed_without_a_shape() -> None:
    with pytest.raises(TypeError, match="needs the gap of each cell"):
        contact(shape=None).check([], gap=False)


def test_errors_say_where() -> None:
    with pytest.raises(ValueError, match="poisson") as raised:
        contact().values(("counterbody.substrate.poisson",), np.array([0.7]))
    assert raised.value.__notes__ == [
        "in a differentiable solve, at counterbody.substrate.poisson = 0.7"
    ]
    with pytest.raises(ValueError, match="has no derivative: it changes by whole cells"):
        contact(outputs=["contact_area"]).values((), np.zeros(0))


def test_shifted_shapes_and_their_parts_have_paths() -> None:
    pair = BALL.shifted(2e-5, 0.0) + nacre.Paraboloid(5e-3, 6e-3)
    names = ("shape.parts[0].shift[0]", "shape.parts[0].radius", "shape.parts[1].radius_y")
    made = contact(shape=pair, load=20.0)
    made.check(names, gap=False)
    x = np.array([2e-5, 5e-3, 6e-3])
    check(made, names, x, 1e-5 * x)
