"""The convolution is the double sum and SciPy's operator; compliances are the closed forms."""

import subprocess
import sys
import threading

import numpy as np
import numpy.typing as npt
import pytest
from scipy.sparse.linalg import aslinearoperator, cg

import nacre

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(420e9, 0.2), 2e-6)])
GRID = nacre.Grid(shape=(12, 9), size=(1.2e-5, 6e-6))
# Transforms of a hundred numbers, relative to the largest one.
ROUNDING = 1e-13


def double_sum(
    coefficients: npt.NDArray[np.float64], pressure: npt.NDArray[np.float64]
) -> npt.NDArray[np.float64]:
    nx, ny = pressure.shape
    i, j = np.arange(nx), np.arange(ny)
    matrix = coefficients[
        np.abs(i[:, None, None, None] - i[None, None, :, None]),
        np.abs(j[None, :, None, None] - j[None, None, None, :]),
    ]
    found: npt.NDArray[np.float64] = np.einsum("ijkl,kl->ij", matrix, pressure)
    return found


def close(a: npt.NDArray[np.float64], b: npt.NDArray[np.float64]) -> bool:
    return bool(np.abs(a - b).max() <= ROUNDING * np.abs(b).max())


@pytest.fixture
def pressure() -> npt.NDArray[np.float64]:
    return np.random.default_rng(3).standard_normal(GRID.shape)


def test_it_is_the_double_sum(pressure: npt.NDArray[np.float64]) -> None:
    coefficients = nacre.influence_coefficients(COATED, GRID)
    convolution = nacre.Convolution(coefficients)
    assert convolution.shape == GRID.shape
    assert np.array_equal(convolution.coefficients, coefficients)
    assert close(convolution.apply(pressure), double_sum(coefficients, pressure))


def test_both_bodies_add(pressure: npt.NDArray[np.float64]) -> None:
    both = nacre.Convolution.of_bodies(COATED, GRID, STEEL, method="plain", refinement=2)
    parts = [nacre.influence_coefficients(body, GRID, "plain", 2) for body in (COATED, STEEL)]
    assert np.array_equal(both.coefficients, parts[0] + parts[1])
    one = nacre.Convolution.of_bodies(COATED, GRID)
    assert np.array_equal(one.coefficients, nacre.influence_coefficients(COATED, GRID))


def test_it_gives_the_displacement_of_a_solution() -> None:
    grid = nacre.Grid(shape=(24, 20), size=(3e-4, 2e-4))
    solution = nacre.solve(nacre.Sphere(5e-3), COATED, STEEL, grid=grid, load=10.0)
    convolution = nacre.Convolution.of_bodies(COATED, grid, STEEL)
    assert close(convolution.apply(solution.pressure), solution.displacement)


def test_threads_change_no_bit(pressure: npt.NDArray[np.float64]) -> None:
    one, two = (nacre.Convolution.of_bodies(COATED, GRID, threads=n) for n in (1, 2))
    assert (one.threads, two.threads) == (1, 2)
    assert one.apply(pressure).tobytes() == two.apply(pressure).tobytes()


def test_lists_and_other_orders_are_welcome(pressure: npt.NDArray[np.float64]) -> None:
    convolution = nacre.Convolution.of_bodies(STEEL, GRID)
    expected = convolution.apply(pressure)
    for other in (pressure.tolist(), np.asfortranarray(pressure), pressure[::-1][::-1]):
        assert np.array_equal(convolution.apply(other), expected)


def test_scipy_takes_it_as_a_symmetric_operator(pressure: npt.NDArray[np.float64]) -> None:
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
    np.testing.assert_allclose(found.reshape(GRID.shape), expected, rtol=1e-8)


def test_it_can_be_applied_in_several_threads_at_once(pressure: npt.NDArray[np.float64]) -> None:
    convolution = nacre.Convolution.of_bodies(COATED, GRID)
    expected, found = convolution.apply(pressure), []
    threads = [
        threading.Thread(target=lambda: found.append(convolution.apply(pressure))) for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4
    assert all(np.array_equal(one, expected) for one in found)


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        ("Convolution([1.0, 2.0])", ValueError, "coefficients must have two dimensions"),
        ("Convolution([[1.0, float('nan')]])", ValueError, r"coefficients is not finite at"),
        ("Convolution(np.zeros((0, 2)))", ValueError, r"coefficients.*\[0, 2\]"),
        ("Convolution([[1.0]], threads=0)", ValueError, "threads must be .*at least 1, got 0"),
        ("Convolution([['a']])", TypeError, "coefficients must be a real array"),
        ("CONVOLUTION.apply(np.zeros((9, 12)))", ValueError, r"shape \[12, 9\].*\[9, 12\]"),
        ("CONVOLUTION.apply(np.full((12, 9), np.nan))", ValueError, "pressure is not finite at"),
        ("CONVOLUTION.apply(1j * np.ones((12, 9)))", TypeError, "pressure must be a real array"),
        (
            "Convolution.of_bodies(STEEL, GRID, method='x')",
            ValueError,
            "method must be .*'x'|\"x\"",
        ),
        ("Convolution.of_bodies(STEEL, GRID, mehtod='exact')", TypeError, "got 'mehtod'"),
        ("Convolution.of_bodies('steel', GRID)", TypeError, "must be a HalfSpace or an Elastic"),
        ("surface_compliance(STEEL, 0.0)", ValueError, "wavenumber must be .*above 0, got 0"),
        ("surface_compliance(STEEL, ['a'])", TypeError, "wavenumber must be a real array"),
        ("surface_compliance('steel', 1.0)", TypeError, "must be a HalfSpace or an Elastic"),
    ],
)
def test_bad_input_is_refused(call: str, kind: type[Exception], message: str) -> None:
    names = globals() | vars(nacre) | {"CONVOLUTION": nacre.Convolution.of_bodies(STEEL, GRID)}
    with pytest.raises(kind, match=message):
        eval(call, names)


def test_without_scipy_all_but_the_operator_works() -> None:
    script = (
        "import sys; sys.modules['scipy'] = None; sys.modules['scipy.sparse.linalg'] = None\n"
        "import nacre\n"
        "convolution = nacre.Convolution([[1.0, 0.5]])\n"
        "convolution.apply([[1.0, 2.0]])\n"
        "convolution.as_linear_operator()\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
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
        np.testing.assert_allclose(found * alpha * material.shear, expected, rtol=1e-14)


def test_the_normal_compliance_is_the_frequency_response() -> None:
    alpha = np.geomspace(1e2, 1e8, 30)
    compliance = nacre.surface_compliance(COATED, alpha)
    assert np.array_equal(compliance.c11, nacre.frequency_response(COATED, alpha))
    assert compliance.c11.flags.c_contiguous


def test_a_number_gives_numbers() -> None:
    compliance = nacre.surface_compliance(COATED, 1e5)
    assert [type(value) for value in compliance] == [float] * 4
    assert compliance._fields == ("c11", "c12", "c22", "ct")
