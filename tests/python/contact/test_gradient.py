"""Gradients name parameters by path, know the shape of their solution, and can be stopped."""

import pickle
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, COATED, HARD, STEEL
from support import interrupted

GRID = nacre.Grid(shape=(41, 31), size=(3.1e-4, 2.9e-4))


@pytest.fixture(scope="module")
def solution() -> nacre.Solution:
    return nacre.solve(
        BALL, COATED, STEEL, grid=GRID, load=5.0, eccentricity=(1e-7, None), tolerance=1e-10
    )


def test_a_gradient_is_a_mapping_of_paths(solution: nacre.Solution) -> None:
    gradient = solution.gradient("approach")
    layer, steel = "body.layers[0]", ("substrate.young", "substrate.poisson")
    assert (
        list(gradient)
        == gradient.keys()
        == [
            *(f"{layer}.material.young", f"{layer}.material.poisson", f"{layer}.thickness"),
            *(f"{body}.{number}" for body in ("body", "counterbody") for number in steel),
            *("shape.radius", "load", "eccentricity[0]", "tilt[1]"),
        ]
    )
    assert dict(gradient.items()) == {path: gradient[path] for path in gradient}
    assert len(gradient) == len(gradient.values()) == 11
    assert "load" in gradient
    assert "approach" not in gradient
    with pytest.raises(KeyError, match="none of body"):
        gradient["approach"]
    assert gradient.output == "approach"
    assert gradient.value == pytest.approx(solution.approach, rel=1e-8)
    assert repr(gradient).startswith("Gradient(approach = ")
    assert 0.0 < gradient.margin < 1.0
    assert gradient.warnings == []


def test_the_field_of_the_gap_is_read_only_and_sums_to_one(solution: nacre.Solution) -> None:
    field = solution.gradient("approach", []).gap
    assert field.shape == (41, 31)
    assert field.dtype == np.float64
    assert not field.flags.writeable
    # A gap that is larger everywhere moves the body as far.
    assert field.sum() == pytest.approx(1.0, abs=1e-8)
    assert np.all(field[~solution.in_contact] == 0.0)


def test_derivatives_equal_differences_within_the_valid_step(solution: nacre.Solution) -> None:
    gradient = solution.gradient("peak_pressure", tolerance=1e-11)
    steps = gradient.valid_step
    assert list(steps) == list(gradient)
    step = min(0.3 * steps["load"], 1e-3)
    keywords: dict[str, Any] = {"grid": GRID, "eccentricity": (1e-7, None), "tolerance": 1e-11}

    def peak(load: float) -> float:
        moved = nacre.solve(BALL, COATED, STEEL, load=load, **keywords)
        return moved.gradient("peak_pressure", []).value

    difference = (peak(5.0 + step) - peak(5.0 - step)) / (2.0 * step)
    assert gradient["load"] == pytest.approx(difference, rel=1e-5)


def test_several_outputs_give_a_list(solution: nacre.Solution) -> None:
    stress = {"stress": "von_mises", "interface": 0, "side": "above"}
    outputs: list[Any] = [
        ("pressure_norm", 8.0),
        ("pressure", (0.0, 0.0)),
        "participation_area",
        stress,
    ]
    found = solution.gradient(outputs, ["load", "shape.radius"])
    assert [one.output for one in found] == [
        "pressure_norm 8",
        "pressure at (0, 0)",
        "participation_area",
        "von_mises at interface 0",
    ]
    for one, output in zip(found, outputs, strict=True):
        alone = solution.gradient(output, ["load", "shape.radius"])
        assert alone.items() == one.items()


def test_a_stress_knows_its_friction(solution: nacre.Solution) -> None:
    sliding = {"stress": "xx", "at": (1e-5, 0.0, 1e-5), "friction": 0.1, "direction": (1.0, 0.0)}
    gradient = solution.gradient(sliding)
    assert "friction" in gradient
    free = solution.gradient({**sliding, "friction": 0.0}, ["load"])
    # A component is linear in the coefficient.
    assert gradient.value - free.value == pytest.approx(0.1 * gradient["friction"], rel=1e-9)


def test_products_with_the_jacobian_agree(solution: nacre.Solution) -> None:
    weights = np.random.default_rng(1).normal(size=(41, 31))
    back = solution.vjp(weights, tolerance=1e-11)
    for path in ("load", "shape.radius", "body.layers[0].thickness"):
        ahead = solution.jvp({path: 1.0}, tolerance=1e-11)
        assert (ahead.pressure * weights).sum() == pytest.approx(back[path], rel=1e-7)
    gap = np.random.default_rng(2).normal(size=(41, 31))
    ahead = solution.jvp(gap=gap, tolerance=1e-11)
    assert (ahead.pressure * weights).sum() == pytest.approx((back.gap * gap).sum(), rel=1e-7)
    assert repr(ahead).startswith("Direction(approach=")
    assert ahead.valid_step > 0.0


def test_a_solution_that_was_pickled_takes_its_shape(solution: nacre.Solution) -> None:
    again = pickle.loads(pickle.dumps(solution))
    assert "shape.radius" not in again.gradient("approach")
    known = again.gradient("approach", shape=BALL)
    assert known["shape.radius"] == pytest.approx(solution.gradient("approach")["shape.radius"])


def test_sums_and_shifts_name_their_parts() -> None:
    roller = nacre.Roller(5e-3, profile=nacre.LogarithmicProfile(1e-6, 2e-3, 1e-3, 0.9))
    grid = nacre.Grid(shape=(24, 24), size=(2.4e-3, 9e-5))
    solution = nacre.solve(roller, STEEL, grid=grid, load=50.0)
    assert {"shape.radius", "shape.profile.amplitude", "shape.profile.end_factor"} <= set(
        solution.gradient("approach")
    )
    both = BALL.shifted(1e-6, 0.0) + nacre.Sphere(8e-3)
    paths = nacre.solve(both, STEEL, grid=GRID, load=5.0).gradient("approach").keys()
    assert {"shape.parts[0].radius", "shape.parts[0].shift[0]", "shape.parts[1].radius"} <= set(
        paths
    )


def test_ctrl_c_stops_it() -> None:
    setup = """
import nacre
from bodies import BALL, COATED
grid = nacre.Grid(shape=(512, 512), size=(3e-4, 3e-4))
solution = nacre.solve(BALL, COATED, grid=grid, load=5.0)
many = [("pressure_norm", 8.0)] * 10**4
"""
    assert interrupted(setup, "solution.gradient(many)") == 0


@pytest.mark.parametrize("scale", [1.7, 1e-3])
def test_gradients_scale_with_all_lengths(scale: float) -> None:
    # Radius, thickness and cells by a factor, the load by its square: pressures stay, and each
    # derivative is multiplied by the dimension of the output over that of the parameter.
    def solved(factor: float) -> nacre.Solution:
        body = nacre.HalfSpace(STEEL, [nacre.Layer(HARD, thickness=20e-6 * factor)])
        size = (3.1e-4 * factor, 2.9e-4 * factor)
        return nacre.solve(
            nacre.Sphere(5e-3 * factor),
            body,
            grid=nacre.Grid(shape=(41, 31), size=size),
            load=5.0 * factor**2,
            tolerance=1e-12,
        )

    lengths = {"shape.radius": 1, "body.layers[0].thickness": 1, "load": 2}
    moduli = {"body.layers[0].material.young": 0, "body.substrate.poisson": 0}
    powers = lengths | moduli
    outputs: dict[Any, int] = {"approach": 1, ("pressure_norm", 8.0): 0}
    pairs = zip(
        solved(1.0).gradient(list(outputs), list(powers), tolerance=1e-11),
        solved(scale).gradient(list(outputs), list(powers), tolerance=1e-11),
        outputs.items(),
        strict=True,
    )
    for own, scaled, (output, power) in pairs:
        # A norm over cells is an integral: its area counts.
        power_of = power if power else 2 / 8
        assert scaled.value == pytest.approx(own.value * scale**power_of, rel=1e-9), output
        for path, of in powers.items():
            due = own[path] * scale ** (power_of - of)
            assert scaled[path] == pytest.approx(due, rel=1e-8), (output, path)


def test_the_old_name_of_the_peak_warns_and_gives_the_same(solution: nacre.Solution) -> None:
    peak = solution.gradient("peak_pressure")
    with pytest.warns(DeprecationWarning, match='write "peak_pressure"'):
        old = solution.gradient("located_peak")
    assert old == peak
    assert old.output == "peak_pressure"
    errors = solution.report.discretisation
    assert errors is not None
    error = errors["peak_pressure"]
    assert 0 < abs(peak.value / solution.peak_pressure - 1) < error
