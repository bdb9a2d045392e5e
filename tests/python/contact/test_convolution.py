"""The convolution is the double sum and SciPy's operator; compliances are the closed forms."""

import numpy as np
import numpy.typing as npt
import pytest
from scipy.sparse.linalg import aslinearoperator, cg

import nacre
from bodies import BALL, STEEL
from support import assert_close, python

Array = npt.NDArray[np.float64]
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(420e9, 0.2), 2e-6)])
GRID = nacre.Grid(shape=(12, 9), size=(1.2e-5, 6e-6))
# Transforms of a hundred numbers, relative to the largest one.
ROUNDING = 1e-13


def close(a: Array, b: Array) -> bool:
    return bool(np.abs(a - b).max() <= ROUNDING * np.abs(b).max())


@pytest.fixture
def pressure() -> Array:
    return np.random.default_rng(3).standard_normal(GRID.shape)


def test_both_bodies_add(pressure: Array) -> None:
    both = nacre.Convolution.of_bodies(COATED, GRID, STEEL)
    assert both.shape == GRID.shape
    parts = [nacre.influence_coefficients(body, GRID) for body in (COATED, STEEL)]
    assert np.array_equal(both.coefficients, parts[0] + parts[1])
    one = nacre.Convolution.of_bodies(COATED, GRID)
    assert np.array_equal(one.coefficients, nacre.influence_coefficients(COATED, GRID))


def test_it_gives_the_displacement_of_a_solution() -> None:
    grid = nacre.Grid(shape=(24, 20), size=(3e-4, 2e-4))
    solution = nacre.solve(BALL, COATED, STEEL, grid=grid, load=10.0)
    convolution = nacre.Convolution.of_bodies(COATED, grid, STEEL)
    assert close(convolution.apply(solution.pressure), solution.displacement)


def test_lists_and_other_orders_are_welcome(pressure: Array) -> None:
    convolution = nacre.Convolution.of_bodies(STEEL, GRID)
    expected = convolution.apply(pressure)
    for other in (pressure.tolist(), np.asfortranarray(pressure), pressure[::-1][::-1]):
        assert np.array_equal(convolution.apply(other), expected)


def test_scipy_takes_it_as_a_symmetric_operator(pressure: Array) -> None:
    convolution = nacre.Convolution.of_bodies(COATED, GRID)
    operator = aslinearoperator(convolution.as_linear_operator())
    cells = pressure.size
    assert operator.shape == (cells, cells)
    assert operator.dtype == np.float64
    assert np.array_equal(operator @ pressure.ravel(), convolution.apply(pressure).ravel())
    other = np.roll(pressure, 5).ravel()
    forward, back = other @ (operator @ pressure.ravel()), (operator.H @ other) @ pressure.ravel()
    assert abs(forward - back) <= ROUNDING * np.abs(other) @ np.abs(operator @ pressure.ravel())
    dense = operator @ np.eye(cells)
    assert np.abs(dense - dense.T).max() <= ROUNDING * dense.max()


def test_conjugate_gradients_of_scipy_invert_it() -> None:
    convolution = nacre.Convolution.of_bodies(COATED, GRID)
    expected = np.linspace(1.0, 2.0, 12 * 9).reshape(GRID.shape)
    displacement = convolution.apply(expected).ravel()
    found, failed = cg(convolution.as_linear_operator(), displacement, rtol=1e-12)
    assert failed == 0
    assert_close(found.reshape(GRID.shape), expected, rtol=1e-8)


def test_without_scipy_all_but_the_operator_works() -> None:
    script = (
        "import sys; sys.modules['scipy'] = None; sys.modules['scipy.sparse.linalg'] = None\n"
        "import nacre\n"
        "convolution = nacre.Convolution([[1.0, 0.5]])\n"
        "convolution.apply([[1.0, 2.0]])\n"
        "convolution.as_linear_operator()\n"
    )
    done = python("-c", script)
    assert done.stderr.splitlines()[-1] == (
        "ModuleNotFoundError: this needs scipy: pip install scipy"
    )


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_compliance_of_a_half_space_is_the_closed_form(poisson: float) -> None:
    material = nacre.Elastic(young=2.0, poisson=poisson)
    alpha = np.array([[0.5, 1.0, 2.0], [3.0, 4.0, 5.0]])
    c11, c12, c22, ct = nacre.surface_compliance(material, alpha)
    # alpha c11 = alpha c22 = (1 - nu)/G, alpha c12 = (1 - 2 nu)/2G, alpha ct = 1/G; to rounding
    for found, expected in (
        (c11, 1 - poisson),
        (c22, 1 - poisson),
        (c12, (1 - 2 * poisson) / 2),
        (ct, 1.0),
    ):
        assert found.shape == alpha.shape
        assert_close(found * alpha * material.shear, expected, rtol=1e-14, atol=1e-16)


def test_the_normal_compliance_is_the_frequency_response_and_a_number_gives_numbers() -> None:
    alpha = np.geomspace(1e2, 1e8, 30)
    compliance = nacre.surface_compliance(COATED, alpha)
    assert np.array_equal(compliance.c11, nacre.frequency_response(COATED, alpha))
    assert compliance.c11.flags.c_contiguous
    single = nacre.surface_compliance(COATED, 1e5)
    assert [type(value) for value in single] == [float] * 4
    assert single._fields == ("c11", "c12", "c22", "ct")
