"""Optimisation finds known optima with few solves, respects limits, and refuses what cannot be."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

import nacre
from nacre.design import Optimum, optimise

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
BALL = {"shape": nacre.Sphere(5e-3), "body": STEEL}
CELLS = nacre.Grid((24, 24), (3e-4, 3e-4))
LENGTH, LOAD, ORDER = 12e-3, 5e3, 16.0
TILTS = (0.0, 0.5e-3, 1e-3)
ROLLER_CELLS = nacre.Grid((32, 12), (LENGTH, 1e-3))
NAMES = ("k1", "k2", "zm")
BOUNDS = {"k1": (0.1, 20.0), "k2": (0.05, 1.0), "zm": (1e-6, 1e-4)}


def roller(k1: float, k2: float, zm: float) -> dict[str, Any]:
    """Return Fujiwara and Kawase's roller of 10 mm × 12 mm on a race of 50 mm."""
    modulus = STEEL.plane_strain_modulus / 2
    profile = nacre.LogarithmicProfile.fujiwara_kawase(LENGTH, LOAD, modulus, k1, k2, zm)
    shape = nacre.Roller(radius=5e-3, length=LENGTH, profile=profile, counter_radius=25e-3)
    return {"shape": shape, "body": STEEL, "counterbody": STEEL}


@pytest.fixture(scope="module")
def best() -> Optimum:
    return optimise(
        roller,
        {"k1": 1.0, "k2": 0.6, "zm": 1e-5},
        objective=("pressure_norm", ORDER),
        across=ORDER,
        cases=[{"load": LOAD, "tilt": (tilt, None)} for tilt in TILTS],
        bounds=BOUNDS,
        grid=ROLLER_CELLS,
    )


@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")
def test_a_roller_is_that_of_nelder_and_mead_with_fewer_solves(best: Optimum) -> None:
    plan = nacre.Contact(STEEL, ROLLER_CELLS, STEEL)
    last: dict[float, nacre.Solution] = {}
    solves = 0

    def norm(x: Any) -> float:
        nonlocal solves
        shape, total = roller(*np.exp(x))["shape"], 0.0
        for tilt in TILTS:
            motion: Any = {"load": LOAD, "tilt": (tilt, None), "initial": last.get(tilt)}
            last[tilt] = plan.solve(shape, tolerance=1e-9, **motion)
            solves += 1
            total += np.prod(ROLLER_CELLS.spacing) * (last[tilt].pressure ** ORDER).sum()
        return float((total / len(TILTS)) ** (1 / ORDER)) / best.objective

    found = minimize(
        norm,
        np.log([2.0, 0.9, 1.5e-5]),
        method="Nelder-Mead",
        bounds=np.log([BOUNDS[name] for name in NAMES]),
        options={"xatol": 1e-3, "fatol": 1e-4, "maxfev": 45},
    )
    # Nelder and Mead may be a little better or worse, as both stop early.
    assert found.fun == pytest.approx(1.0, abs=1e-3)
    assert best.solves < solves


def test_the_course_falls_and_ends_at_the_optimum(best: Optimum) -> None:
    table = best.course
    assert list(table) == ["solves", "objective", "excess", *NAMES]
    assert best.termination == "converged"
    assert np.all(np.diff(table["objective"]) < 0)
    assert np.all(np.diff(table["solves"]) > 0)
    assert table["objective"][-1] == best.objective
    assert {name: table[name][-1] for name in NAMES} == best.values
    assert table["solves"][0] == 6  # three tilts, each with the derivative of one output
    norms = [
        (np.prod(ROLLER_CELLS.spacing) * (s.pressure**ORDER).sum()) ** (1 / ORDER)
        for s in best.solutions
    ]
    mean = float(np.mean(np.power(norms, ORDER)) ** (1 / ORDER))
    assert best.objective == pytest.approx(mean, rel=1e-6)


def test_the_report_and_the_picture_show_the_course(best: Optimum) -> None:
    text = str(best)
    assert "k1" in text
    assert f"{best.solves} solves" in text
    axes = best.plot()
    assert [line.get_label() for line in axes.lines] == ["objective", *NAMES]
    assert axes.lines[0].get_ydata()[-1] == pytest.approx(  # type: ignore[index]
        best.objective / best.course["objective"][0]
    )


def test_a_limit_is_reached_and_kept() -> None:
    rows: list[dict[str, float]] = []
    best = optimise(
        BALL,
        {"shape.radius": 5e-3},
        objective="participation_area",
        cases=[{"load": 10.0}, {"load": 20.0}],
        bounds={"shape.radius": (1e-3, 2e-2)},
        constraints=[("located_peak", 1.5e9)],
        across=1.0,
        grid=CELLS,
        progress=rows.append,
    )
    ((output, limit, reached),) = best.limits
    assert (output, limit) == ("located_peak", 1.5e9)
    assert reached[0] < reached[1] == pytest.approx(1.5e9, rel=2e-3)
    assert best.excess < 1e-3
    # Hertz: p0³ = 6 W E*² / (π³ R²), and E* = E/(1 − ν²) against a rigid ball.
    modulus = STEEL.plane_strain_modulus
    radius = np.sqrt(6 * 20.0 * modulus**2 / (np.pi * 1.5e9) ** 3)
    assert best.values["shape.radius"] == pytest.approx(radius, rel=0.03)  # 5 cells along a radius
    assert rows[-1]["objective"] == pytest.approx(best.objective, rel=1e-3)
    assert "limit 1.5e+09 on located_peak" in str(best)


def test_slopes_are_those_of_differences() -> None:
    from nacre._parameters import scales_of
    from nacre._problem import Problem

    coated = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(400e9, 0.2), 2e-5)])
    start = {"body.layers[0].thickness": 2e-5, "body.substrate.young": 2e11, "shape.radius": 5e-3}
    build = {"shape": nacre.Sphere(5e-3), "body": coated, "load": 10.0}
    stress = {"stress": "plane_shear", "interface": 0, "sharpness": 200.0}
    scales = scales_of(start, {})
    problem = Problem(build, scales, "approach", [{"load": 8.0}, {}], [(stress, 1e9)], 4.0)
    x = np.array([scale.x(start[scale.name]) for scale in scales])
    problem.begin(x, CELLS)
    point = problem.at(x)
    for i, step in enumerate(1e-4 * np.eye(3)):
        more, less = problem.at(x + step), problem.at(x - step)
        # The contact of 24 cells keeps its cells, and differences are as good as their step.
        slope = (more.value - less.value) / 2e-4
        assert point.slope[i] == pytest.approx(slope, rel=1e-4)
        # The largest slack is 1: differences of it leave 1e-16 over their step.
        assert point.d_slack[:, i] == pytest.approx(
            (more.slack - less.slack) / 2e-4, rel=1e-4, abs=1e-8
        )


def test_solves_end_at_their_number() -> None:
    best = optimise(
        BALL,
        {"shape.radius": 5e-3},
        objective="approach",
        cases=[{"load": 10.0}],
        grid=CELLS,
        max_solves=2,
    )
    assert (best.termination, best.solves, best.values) == (
        "solve limit",
        2,
        {"shape.radius": 5e-3},
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"start": {}}, "start must be a mapping of one parameter or more"),
        ({"start": {"shape.radios": 1.0}}, r"got 'shape.radios': no radios"),
        ({"start": {"shape": 1.0}}, "start must name numbers, got"),
        ({"start": {"edge": 1.0}}, "start must name parameters by path, got 'edge'"),
        ({"start": {"shape.radius": np.nan}}, "must be finite"),
        ({"bounds": {"radius": (0.0, 1.0)}}, r"bounds must be of parameters in start.*radius"),
        ({"bounds": {"shape.radius": (1.0, 2.0)}}, "must be in its bounds"),
        ({"bounds": {"shape.radius": (5e-3, 5e-3)}}, "must differ"),
        ({"cases": []}, "cases must be a sequence of one mapping or more"),
        ({"cases": [{"loads": 1.0}]}, "arguments of nacre.solve.*loads"),
        ({"constraints": ["approach"]}, "pairs of an output and its limit"),
        ({"constraints": [("approach", -1.0)]}, "the limit of 'approach' must be positive"),
        ({"grid": 32}, "grid must be a Grid"),
        ({"tolerance": 0.0}, "tolerance must be above 0"),
        ({"objective": "contact_area"}, "participation area"),
    ],
)
def test_bad_input_is_refused(change: dict[str, Any], message: str) -> None:
    asked: dict[str, Any] = {
        "build": BALL,
        "start": {"shape.radius": 5e-3},
        "objective": "approach",
        "cases": [{"load": 10.0}],
        "grid": CELLS,
    }
    with pytest.raises((ValueError, TypeError), match=message):
        optimise(**(asked | change))


def test_the_edge_of_a_shape_is_no_parameter() -> None:
    with pytest.raises(ValueError, match="must not move the edge of the shape"):
        optimise(
            {"shape": nacre.FlatPunch(1e-4), "body": STEEL},
            {"shape.radius": 1e-4},
            objective="approach",
            cases=[{"load": 10.0}],
            grid=CELLS,
        )
