"""A contact is a function of JAX, with derivatives of both modes under jit and vmap."""

import doctest
import subprocess
import sys
import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import nacre

jax = pytest.importorskip("jax")
jnp = jax.numpy

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
HARD = nacre.Elastic(young=420e9, poisson=0.2)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(HARD, thickness=20e-6)])
GRID = nacre.Grid(shape=(24, 22), size=(2e-4, 1.9e-4))
BALL = nacre.Sphere(5e-3)
NUMBERS = {
    "body.layers[0].material.young": 420e9,
    "body.layers[0].thickness": 20e-6,
    "load": 10.0,
    "shape.radius": 5e-3,
}
ZERO = dict.fromkeys(NUMBERS, 0.0)
GAP = 1e-9 * np.random.default_rng(1).normal(size=GRID.shape)
WEIGHTS = np.random.default_rng(2).normal(size=GRID.shape) / 1e10
STEP, BAR = 1e-5, 1e-6
"""Steps of logarithms, within the valid ones, and what differences of them are worth."""


@pytest.fixture(autouse=True)
def double() -> Iterator[None]:
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", before)


def solver(**changes: Any) -> Any:
    import nacre.jax

    outputs = {"approach": "approach", "norm": ("pressure_norm", 16.0)}
    given = {"shape": BALL, "body": COATED, "grid": GRID, "load": 10.0, "outputs": outputs}
    return nacre.jax.solver(**{**given, "tolerance": 1e-12, **changes})


def objective(solve: Any) -> Any:
    """Return a sum of pressures and outputs, of order 1, of logarithms and a gap."""

    def value(logarithms: Any, gap: Any = None) -> Any:
        numbers = {name: NUMBERS[name] * jnp.exp(log) for name, log in logarithms.items()}
        found = solve(numbers, gap)
        weighted = (WEIGHTS * found.pressure).sum()
        return weighted + found.outputs["norm"] / 1e9 + found.outputs["approach"] * 1e6

    return value


def check(function: Any, *arguments: Any) -> None:
    from jax.test_util import check_grads

    for mode in ("fwd", "rev"):
        check_grads(function, arguments, 1, modes=[mode], eps=STEP, atol=BAR, rtol=BAR)


@pytest.mark.parametrize("compiled", [False, True])
def test_derivatives_are_true(compiled: bool) -> None:
    value = objective(solver())
    check(jax.jit(value) if compiled else value, ZERO)


def test_derivatives_are_true_under_vmap() -> None:
    value = objective(solver())
    logarithms = {name: jnp.array([-0.02, 0.0, 0.01]) for name in NUMBERS}
    check(jax.jit(jax.vmap(value)), logarithms)
    each = [{name: logs[k] for name, logs in logarithms.items()} for k in range(3)]
    found = jax.jit(jax.vmap(jax.grad(value)))(logarithms)
    for k, one in enumerate(each):
        alone = jax.grad(value)(one)
        assert all(found[name][k] == alone[name] for name in NUMBERS)


def test_the_pressure_field_and_all_of_both_modes_agree() -> None:
    solve = solver()

    def pressure(logarithms: Any) -> Any:
        names = sorted(NUMBERS)
        return solve({k: NUMBERS[k] * jnp.exp(logarithms[i]) for i, k in enumerate(names)}).pressure

    zero = jnp.zeros(len(NUMBERS))
    forward, row = jax.jacfwd(pressure)(zero), jax.jacrev(lambda x: pressure(x)[12])(zero)
    assert forward.shape == (*GRID.shape, len(NUMBERS))
    assert abs(forward[12] - row).max() < 1e-7 * abs(row).max()
    load = forward[..., sorted(NUMBERS).index("load")].sum() * np.prod(GRID.spacing)
    assert load == pytest.approx(10.0, rel=1e-8)  # d(sum p dA)/d(ln W) = W


def test_a_gap_has_a_field_of_derivatives() -> None:
    value = objective(solver())
    # In nanometres, with steps of 1e-5 of it.
    check(lambda gap: value(ZERO, 1e-9 * gap), 1e9 * GAP)
    alone = objective(solver(shape=None))
    field = jax.jit(jax.grad(lambda gap: alone({}, gap)))(jnp.asarray(BALL.gaps(GRID)))
    known = jax.grad(lambda gap: value({}, gap))(jnp.zeros(GRID.shape))
    assert abs(field - known).max() < 1e-6 * abs(known).max()
    assert abs((field.sum() - 1e6) / 1e6) < 1e-6  # only the approach moves with the whole gap


def test_results_are_those_of_nacre() -> None:
    found = solver()({})
    solution = nacre.solve(BALL, COATED, grid=GRID, load=10.0, tolerance=1e-12)
    assert np.array_equal(found.pressure, solution.pressure)
    assert found.outputs["approach"] == solution.approach
    assert np.array_equal(found.in_contact, solution.pressure > 0)
    assert found.pressure.dtype == np.float64
    assert bool(found.ok)


def test_a_failing_solve_raises_or_is_flagged() -> None:
    solve = solver()
    wrong = {"body.layers[0].thickness": -1e-6}
    with pytest.raises(ValueError, match="thickness must be"):
        solve(wrong)
    with pytest.raises(ValueError, match="thickness must be"):
        jax.grad(lambda x: solve({"body.layers[0].thickness": x}).outputs["norm"])(-1e-6)

    def norm(x: Any) -> Any:
        found = solve({"body.layers[0].thickness": x})
        return jnp.where(found.ok, found.outputs["norm"] / 1e9, -1.0), found

    xs = jnp.array([-1e-6, 20e-6])
    mapped = jax.jit(jax.vmap(jax.value_and_grad(norm, has_aux=True)))
    with pytest.warns(nacre.NacreWarning, match=r"the results are NaN.*thickness must be.*-1e-06"):
        (values, found), slopes = jax.block_until_ready(mapped(xs))
    assert found.ok.tolist() == [False, True]
    assert values[0] == -1.0
    assert slopes[0] == 0.0
    assert jnp.isnan(found.pressure[0]).all()
    assert jnp.isnan(found.outputs["approach"][0])
    assert not found.in_contact[0].any()
    assert jnp.isfinite(found.pressure[1]).all()
    assert slopes[1] != 0.0

    # Where warnings are errors, as in these tests, NaN has to tell.
    slope = jax.jit(jax.grad(lambda x: solve({"body.layers[0].thickness": x}).outputs["norm"]))
    assert jnp.isnan(slope(-1e-6))


def test_a_kink_is_told() -> None:
    grid = nacre.Grid(shape=(16, 16), size=(2e-4, 2e-4))
    solve = solver(body=STEEL, grid=grid, tolerance=1e-13, outputs=["approach"])
    pressure = jax.jit(lambda load: solve({"load": load}).pressure)
    low, high = 10.0, 15.0
    few = (pressure(low) > 0).sum()
    while (middle := 0.5 * (low + high)) not in (low, high):
        low, high = (low, middle) if (pressure(middle) > 0).sum() > few else (middle, high)
    slope = jax.jit(jax.grad(lambda load: pressure(load)[8, 8]))
    with pytest.warns(nacre.NacreWarning, match="about to join or to leave"):
        slope(high).block_until_ready()


def test_threads_share_a_function() -> None:
    gradient = jax.jit(jax.grad(objective(solver(keep=1))))
    points = [{**ZERO, "load": 0.01 * k} for k in range(4)]
    expected = [gradient(point) for point in points]
    found: dict[tuple[int, int], Any] = {}

    def run(order: int) -> None:
        for k in range(4)[::order]:
            found[order, k] = gradient(points[k])

    threads = [threading.Thread(target=run, args=(order,)) for order in (1, -1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8
    assert all(one == expected[k] for (_, k), one in found.items())


def test_derivatives_of_the_second_order_are_refused() -> None:
    value = objective(solver())
    for second in (jax.hessian(value), jax.jacrev(jax.grad(value)), jax.jacfwd(jax.jacfwd(value))):
        with pytest.raises(TypeError, match="first derivatives only"):
            second(ZERO)


def test_arguments_are_checked_under_jit() -> None:
    solve = solver()
    call = jax.jit(solve)
    with pytest.raises(TypeError, match=r"'load'\] must be float64 of shape \(\), got float32 of"):
        call({"load": jnp.float32(10.0)})
    with pytest.raises(TypeError, match=r"gap must be float64 of shape \(24, 22\), got .* \(3,\)"):
        call({}, jnp.zeros(3))
    with pytest.raises(ValueError, match=r"got 'load\[0\]'"):
        call({"load[0]": 1.0})
    with pytest.raises(TypeError, match=r"must be a dict of paths and numbers, got 1\.0"):
        solve(1.0)
    jax.config.update("jax_enable_x64", False)
    with pytest.raises(TypeError, match="jax_enable_x64"):
        solve({"load": 10.0})


def test_nacre_alone_does_not_import_jax() -> None:
    code = "import sys, nacre; assert 'jax' not in sys.modules and 'jax' in dir(nacre)"
    subprocess.run([sys.executable, "-c", code], check=True)
    assert callable(nacre.jax.solver)


def test_the_example_is_true() -> None:
    import nacre.jax

    result = doctest.testmod(nacre.jax)
    assert (result.attempted > 0, result.failed) == (True, 0)
