"""Bodies that are functions of the wavenumber have the contacts of closed forms and half-spaces."""

import copy
import pickle
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.special import k0, k1

import nacre
from bodies import BALL, COATED, STEEL, quiet
from nacre import indent
from support import assert_close

Array = npt.NDArray[np.float64]

STIFFNESS = 2e14
"""Stiffness of beds [Pa/m]."""
GRID = nacre.Grid(shape=(48, 40), size=(3.2e-4, 3e-4))
BOWL = nacre.Paraboloid(5e-3, 5e-3)
ROUNDING = 1e-13
"""Coefficients of the same response: sums of a few hundred terms in another order."""
TABLES = 1e-11
"""Coefficients of the same response with other lengths, over the largest: 3e-12 at most here."""


def bed(alpha: Array) -> Array:
    return np.full_like(alpha, 1 / STIFFNESS)


def of(body: nacre.HalfSpace | nacre.Elastic) -> nacre.Response:
    """Return the response of a body as a function."""
    return nacre.Response(lambda alpha: nacre.frequency_response(body, alpha))


def test_a_winkler_bed_is_its_springs() -> None:
    body = nacre.Response(bed)
    solution = nacre.solve(BOWL, body, grid=GRID, approach=2e-6)
    expected = STIFFNESS * np.maximum(2e-6 - BOWL.gaps(GRID), 0.0)
    assert_close(solution.pressure, expected, atol=1e-8 * expected.max())
    loaded = nacre.solve(BOWL, body, grid=GRID, load=solution.load)
    assert abs(loaded.approach / 2e-6 - 1) < 1e-8
    # W = π k R δ², up to the cells on the edge.
    assert abs(solution.load / (np.pi * STIFFNESS * 5e-3 * 2e-6**2) - 1) < 2e-3
    same = nacre.Response(np.zeros_like, local=1 / STIFFNESS)
    assert nacre.solve(BOWL, same, grid=GRID, approach=2e-6).load == solution.load
    assert body.limits == (0.0, 0.0)


def test_a_bed_with_a_shear_layer_has_its_closed_form() -> None:
    """Paraboloid on p = k w - G ∇²w: tests/contact/foundation.rs derives it."""
    stiffness, shear, radius = 2.0, 0.5, 1e4
    length = (shear / stiffness) ** 0.5
    body = nacre.Response(lambda alpha: 1 / (stiffness + shear * alpha**2))
    approach = 0.5 / radius + length / radius * k0(1 / length) / k1(1 / length)
    load = np.pi * (stiffness * (approach - 0.25 / radius) + 2 * shear / radius)
    grid = nacre.Grid(shape=(128, 128), size=(2.6, 2.6))
    solution = nacre.solve(nacre.Paraboloid(radius, radius), body, grid=grid, load=load)
    assert abs(solution.approach / approach - 1) < 1e-3
    central = stiffness * approach + 2 * shear / radius
    assert abs(solution.central_pressure / central - 1) < 1e-3


def test_the_function_of_a_half_space_gives_its_numbers() -> None:
    body = nacre.Response(lambda alpha: 2 / (STEEL.plane_strain_modulus * alpha))
    assert_close(body.limits, 2 / STEEL.plane_strain_modulus, rtol=1e-15)
    found, expected = (nacre.influence_coefficients(one, GRID) for one in (body, STEEL))
    assert_close(found, expected, rtol=1e-15)
    one, other = (quiet(nacre.solve, BALL, body, grid=GRID, load=10.0) for body in (body, STEEL))
    assert_close(one.pressure, other.pressure, atol=ROUNDING * other.peak_pressure)
    assert abs(one.approach / other.approach - 1) < ROUNDING


GRIDS = {
    "open": GRID,
    "line": nacre.Grid.line(64, 4e-4),
    "periodic": nacre.Grid((16, 12), (1.6e-4, 1.2e-4), periodic=(True, True)),
    "periodic along y": nacre.Grid((16, 12), (1.6e-4, 1.2e-4), periodic=(False, True)),
}
BODIES = {
    "hard coating": COATED,
    "soft coating": nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(3e9, 0.4), 5e-6)]),
    "on a rigid base": nacre.HalfSpace(nacre.RIGID, [nacre.Layer(STEEL, 30e-6)]),
    "two layers": nacre.HalfSpace(
        STEEL, [*COATED.layers, nacre.Layer(nacre.Elastic(70e9, 0.3), 1e-3)]
    ),
}


@pytest.mark.parametrize("grid", GRIDS.values(), ids=GRIDS)
@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_the_function_of_a_coated_body_gives_its_numbers(
    body: nacre.HalfSpace, grid: nacre.Grid
) -> None:
    found, expected = (nacre.influence_coefficients(one, grid) for one in (of(body), body))
    assert_close(found, expected, atol=TABLES * expected.max())


def test_a_coated_contact_is_that_of_its_function() -> None:
    body = of(COATED)
    one, other = (nacre.solve(BALL, one, STEEL, grid=GRID, load=20.0) for one in (body, COATED))
    assert_close(one.pressure, other.pressure, atol=1e-8 * other.peak_pressure)
    carried = nacre.solve(BALL, STEEL, body, grid=GRID, load=20.0)
    assert abs(carried.approach / one.approach - 1) < 1e-12
    # The grid that nacre chooses depends on the lengths of the body, to a factor of ten.
    chosen = nacre.solve(BALL, body, STEEL, load=20.0)
    assert abs(chosen.peak_pressure / other.peak_pressure - 1) < 0.01
    alpha = np.geomspace(1e-3, 1e9, 50)
    assert_close(
        nacre.frequency_response(body, alpha), nacre.frequency_response(COATED, alpha), rtol=1e-12
    )


def test_springs_add_to_a_half_space() -> None:
    """Springs in the function itself are refused: they hide the rest at short waves."""
    springs = 1e-17
    body = nacre.Response(lambda alpha: nacre.frequency_response(COATED, alpha), local=springs)
    rise = nacre.influence_coefficients(body, GRID) - nacre.influence_coefficients(of(COATED), GRID)
    expected = np.zeros(GRID.shape)
    expected[0, 0] = springs
    assert_close(rise, expected, atol=1e-15 * nacre.influence_coefficients(body, GRID).max())
    with pytest.raises(ValueError, match="give the constant as local"):
        nacre.Response(lambda alpha: nacre.frequency_response(COATED, alpha) + springs)


def test_a_measured_compliance_is_a_table() -> None:
    alpha = np.geomspace(1e2, 1e6, 30)
    measured = 1 / (1e14 + 1e9 * alpha)
    body = nacre.Response(lambda given: np.interp(np.log(given), np.log(alpha), measured))
    solution = nacre.solve(BALL, body, grid=GRID, load=5.0)
    whole = nacre.Response(lambda given: 1 / (1e14 + 1e9 * given))
    expected = nacre.solve(BALL, whole, grid=GRID, load=5.0)
    # The chords of the table.
    assert abs(solution.approach / expected.approach - 1) < 0.02


def test_the_function_is_called_once_for_all_plans() -> None:
    calls = []

    def function(alpha: Array) -> Array:
        calls.append(alpha.shape)
        return bed(alpha)

    body = nacre.Response(function)
    contact = nacre.Contact(body, GRID)
    cases: list[dict[str, Any]] = [{"shape": BOWL, "load": load} for load in (5.0, 10.0)]
    loads = [solution.load for solution in contact.solve_many(cases)]
    nacre.solve(BOWL, body, grid=GRID, load=1.0)
    assert_close(loads, [5.0, 10.0], rtol=1e-10)
    assert calls == [body.wavenumbers.shape]
    assert np.array_equal(body.values, bed(body.wavenumbers))


def test_values_are_kept_without_the_function(tmp_path: Path) -> None:
    body = of(COATED)
    for again in (pickle.loads(pickle.dumps(body)), copy.deepcopy(body)):
        assert again == body
        assert hash(again) == hash(body)
    assert body != of(STEEL) != nacre.Response(bed) != nacre.Response(bed, local=1e-15)
    contact = nacre.Contact(body, GRID, nacre.Response(bed))
    assert pickle.loads(pickle.dumps(contact)) == contact
    solution = contact.solve(BALL, load=10.0)
    assert solution.report.body == body
    assert pickle.loads(pickle.dumps(solution)) == solution
    assert nacre.Solution.from_dict(solution.to_dict()) == solution
    found = nacre.load(solution.save(tmp_path / "bed.nc"))
    assert found == solution
    assert found.report.counterbody == nacre.Response(bed)


def test_results_say_that_a_body_is_a_response() -> None:
    solution = nacre.solve(BOWL, nacre.Response(bed), STEEL, grid=GRID, load=10.0)
    assert re.search(r"body +a response\n", str(solution))
    assert "a response" in solution._repr_html_()
    assert "E*" not in str(solution)
    line = nacre.solve(nacre.Cylinder(5e-3), of(STEEL), grid=nacre.Grid.line(64, 2e-4), load=1e4)
    assert "from the surface" in str(line)
    assert repr(nacre.Response(bed)) == ("<Response: limits (0.0, 0.0) 1/Pa, springs 5e-15 m/Pa>")
    assert "<Response: limits" in repr(nacre.Contact(nacre.Response(bed), GRID))


def test_derivatives_are_those_of_other_numbers() -> None:
    solution = nacre.solve(BALL, of(STEEL), grid=GRID, load=10.0)
    found = solution.gradient("approach")
    expected = nacre.solve(BALL, STEEL, grid=GRID, load=10.0).gradient("approach")
    assert list(found) == [path for path in expected if not path.startswith("body.")]
    assert abs(found["shape.radius"] / expected["shape.radius"] - 1) < 1e-6
    with pytest.raises(ValueError, match=r"body\.substrate\.young has no derivative"):
        solution.gradient("approach", ["body.substrate.young"])


def test_a_study_tells_responses_apart(tmp_path: Path) -> None:
    beds = {"soft": nacre.Response(bed), "hard": nacre.Response(lambda alpha: bed(alpha) / 4)}
    case = {"shape": BOWL, "grid": GRID, "approach": 2e-6}
    study = nacre.sweep(case, {"body": beds}, outputs=["load"], store=tmp_path / "beds.nc")
    assert abs(float(study["load"][1] / study["load"][0]) - 4) < 1e-6


def solved() -> nacre.Solution:
    return nacre.solve(BOWL, nacre.Response(bed), grid=GRID, load=10.0)


REFUSED: dict[str, Callable[[], object]] = {
    "stresses need a body that is a stack of layers": lambda: solved().stress(1e-6),
    "stresses need a body": lambda: solved().stress_summary(),
    "stresses need a HalfSpace": lambda: nacre.plot.stress_section(solved()),
    "friction needs bodies with a substrate": lambda: nacre.Contact(
        nacre.Response(bed), GRID
    ).slide(BOWL, load=1.0, friction=0.3, force=(0.1, None)),
}


@pytest.mark.parametrize("words", REFUSED)
def test_what_a_response_does_not_tell_is_refused(words: str) -> None:
    with pytest.raises(ValueError, match=words):
        REFUSED[words]()


LAYERED: dict[str, Callable[[Any], object]] = {
    "compliance": lambda body: nacre.surface_compliance(body, 1.0),
    "indentation": lambda body: indent.Indentation(body, indent.Tip.paraboloid(1e-6)),
    "stress": lambda body: nacre.stress(body, GRID, np.ones(GRID.shape), 1e-6),
}


@pytest.mark.parametrize("call", LAYERED.values(), ids=LAYERED)
def test_layers_are_asked_for(call: Callable[[Any], object]) -> None:
    with pytest.raises(TypeError, match=r"must be a HalfSpace or an Elastic, got <Response"):
        call(nacre.Response(bed))


def steps(alpha: Array) -> Array:
    return np.where(alpha < 1e4, -1.0, 1.0) / alpha


WRONG: dict[str, tuple[type[Exception], Callable[..., Any]]] = {
    r"function must be a function of an array of wavenumbers, got 1.0": (TypeError, 1.0),  # type: ignore[dict-item]
    r"function\(wavenumbers\) must have the shape of the wavenumbers, \(37121,\), got shape \[\]": (
        ValueError,
        lambda alpha: 1e-12,
    ),
    r"got shape \[2, 37121\]": (ValueError, lambda alpha: [alpha, alpha]),
    r"function\(wavenumbers\) must be a real array, got dtype complex128": (
        TypeError,
        lambda alpha: 1j / alpha,
    ),
    r"function\(wavenumbers\) must be a real array, got dtype object": (
        TypeError,
        lambda alpha: None,
    ),
    r"must be finite and at least 0 everywhere, and above 0 somewhere, got NaN at 6.*e-26": (
        ValueError,
        lambda alpha: alpha * np.nan,
    ),
    r"must be finite and at least 0 everywhere.*, got inf at 1": (
        ValueError,
        lambda alpha: np.where(alpha < 0.9999, 1 / alpha, np.inf),
    ),
    r"must be finite and at least 0 everywhere.*, got -": (ValueError, steps),
    r"above 0 somewhere, got 0": (ValueError, np.zeros_like),
    r"must settle before 1.*e25": (ValueError, lambda alpha: alpha**-0.5),
    r"must settle before 6.*e-26": (ValueError, lambda alpha: alpha**-1.5),
}


@pytest.mark.parametrize("words", WRONG)
def test_errors_say_what_the_function_must_do(words: str) -> None:
    kind, function = WRONG[words]
    with pytest.raises(kind, match=words):
        nacre.Response(function)


def test_an_error_of_the_function_is_raised_as_it_is() -> None:
    error = RuntimeError("out of range")

    def function(alpha: Array) -> Array:
        raise error

    with pytest.raises(RuntimeError) as raised:
        nacre.Response(function)
    assert raised.value is error
    with pytest.raises(ValueError, match="local must be finite and at least 0, got -1"):
        nacre.Response(bed, local=-1.0)
    with pytest.raises(TypeError, match="real number"):
        nacre.Response(bed, local="soft")  # type: ignore[arg-type]
