"""A contact is a function of PyTorch, with derivatives of both modes, also in torch.func."""

import doctest
import subprocess
import sys
import threading
from typing import Any

import numpy as np
import pytest

import nacre

torch = pytest.importorskip("torch")
# PyTorch scripts its own decompositions where forward derivatives are first asked for.
pytestmark = pytest.mark.filterwarnings("ignore:.*torch.jit:FutureWarning")

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
WEIGHTS = torch.tensor(np.random.default_rng(2).normal(size=GRID.shape) / 1e10)
STEP, BAR = 1e-5, 1e-6
"""Steps of logarithms, within the valid ones, and what differences of them are worth."""


def solver(**changes: Any) -> Any:
    import nacre.torch

    outputs = {"approach": "approach", "norm": ("pressure_norm", 16.0)}
    given = {"shape": BALL, "body": COATED, "grid": GRID, "load": 10.0, "outputs": outputs}
    return nacre.torch.solver(**{**given, "tolerance": 1e-12, **changes})


def zero(**options: Any) -> Any:
    return torch.zeros(len(NUMBERS), dtype=torch.float64, **options)


def numbers(logarithms: Any) -> dict[str, Any]:
    pairs = zip(NUMBERS.items(), torch.exp(logarithms), strict=True)
    return {name: value * factor for (name, value), factor in pairs}


def objective(solve: Any) -> Any:
    """Return a sum of pressures and outputs, of order 1, of logarithms and a gap."""

    def value(logarithms: Any, gap: Any = None) -> Any:
        found = solve(numbers(logarithms), gap)
        weighted = (WEIGHTS * found.pressure).sum()
        return weighted + found.outputs["norm"] / 1e9 + found.outputs["approach"] * 1e6

    return value


def check(function: Any, *arguments: Any) -> None:
    assert torch.autograd.gradcheck(
        function, arguments, eps=STEP, atol=BAR, rtol=BAR, check_forward_ad=True
    )


def test_derivatives_are_true() -> None:
    check(objective(solver()), zero(requires_grad=True))


def test_derivatives_of_fields_are_true() -> None:
    solve = solver()

    def fields(logarithms: Any) -> Any:
        found = solve(numbers(logarithms))
        return found.pressure[10:13] / 1e9, found.outputs["approach"] * 1e6, found.in_contact

    check(lambda logarithms: fields(logarithms)[:2], zero(requires_grad=True))
    assert not fields(zero(requires_grad=True))[2].requires_grad


def test_derivatives_by_a_gap_are_true() -> None:
    alone, added = objective(solver(shape=None)), objective(solver())
    rng = np.random.default_rng(1)
    gap = torch.tensor(rng.normal(size=GRID.shape), requires_grad=True)
    # In nanometres; the derivative along three directions.
    directions = torch.tensor(rng.normal(size=(3, *GRID.shape)))

    def along(steps: Any) -> Any:
        return added(zero(), 1e-9 * (gap.detach() + torch.tensordot(steps, directions, 1)))

    check(along, torch.zeros(3, dtype=torch.float64, requires_grad=True))
    whole = torch.tensor(BALL.gaps(GRID), requires_grad=True)
    # Without a shape, paths of the shape are unknown.
    found = solver(shape=None)({}, whole)
    (field,) = torch.autograd.grad(found.outputs["approach"], whole)
    assert field.sum().item() == pytest.approx(1.0, rel=1e-8)
    with pytest.raises(ValueError, match=r"got 'shape\.radius'"):
        alone(zero(), whole)


def test_transforms_agree() -> None:
    value, here = objective(solver()), zero()
    gradient = torch.func.grad(value)(here)
    assert torch.equal(torch.func.jacrev(value)(here), gradient)
    assert torch.allclose(torch.func.jacfwd(value)(here), gradient, rtol=1e-7, atol=1e-7)
    _, rate = torch.func.jvp(value, (here,), (torch.ones_like(here),))
    assert rate.item() == pytest.approx(gradient.sum().item(), rel=1e-7)
    many = torch.stack([here, here + 0.01, here - 0.02])
    for transform in (torch.func.grad, torch.func.jacfwd):
        alone = torch.stack([transform(value)(one) for one in many])
        assert torch.equal(torch.func.vmap(transform(value))(many), alone)
    values = torch.func.vmap(value, in_dims=1)(many.T)
    assert torch.equal(values, torch.stack([value(one) for one in many]))


def test_a_mapped_gap_and_a_fixed_load() -> None:
    solve = solver()
    gaps = torch.tensor(1e-9 * np.random.default_rng(1).normal(size=(2, *GRID.shape)))
    found = torch.func.vmap(lambda gap: solve({"load": 12.0}, gap))(gaps)
    assert found.pressure.shape == (2, *GRID.shape)
    for k, gap in enumerate(gaps):
        alone = solve({"load": np.float64(12.0)}, gap.numpy())
        assert torch.equal(found.pressure[k], alone.pressure)
        assert torch.equal(found.in_contact[k], alone.in_contact)
        assert found.outputs["norm"][k] == alone.outputs["norm"]


def test_results_are_those_of_nacre() -> None:
    found = solver()({})
    solution = nacre.solve(BALL, COATED, grid=GRID, load=10.0, tolerance=1e-12)
    assert np.array_equal(found.pressure.numpy(), solution.pressure)
    assert found.outputs["approach"].item() == solution.approach
    assert np.array_equal(found.in_contact.numpy(), solution.pressure > 0)


def test_an_optimiser_finds_a_thickness() -> None:
    solve = solver()
    measured = solve({"body.layers[0].thickness": 24e-6}).pressure
    log = torch.tensor(np.log(16e-6), requires_grad=True)
    descent = torch.optim.LBFGS([log], lr=0.5, max_iter=20, tolerance_grad=1e-12)

    def misfit() -> Any:
        descent.zero_grad()
        pressure = solve({"body.layers[0].thickness": torch.exp(log)}).pressure
        value = ((pressure - measured) ** 2).sum() / 1e16
        value.backward()
        return value

    descent.step(misfit)
    assert log.exp().item() == pytest.approx(24e-6, rel=1e-4)


def test_a_failing_solve_raises() -> None:
    thickness = torch.tensor(-1e-6, dtype=torch.float64, requires_grad=True)
    with pytest.raises(ValueError, match="thickness must be") as raised:
        solver()({"body.layers[0].thickness": thickness})
    assert "at body.layers[0].thickness = -1e-06" in raised.value.__notes__[0]
    # A centred ball has four equal cells at its peak.
    grid = nacre.Grid(shape=(16, 16), size=(2e-4, 2e-4))
    with pytest.raises(ValueError, match="two cells have the largest pressure"):
        solver(grid=grid, outputs=["cell_peak"])({})


def test_a_kink_is_told() -> None:
    grid = nacre.Grid(shape=(16, 16), size=(2e-4, 2e-4))
    solve = solver(body=STEEL, grid=grid, tolerance=1e-13, outputs=["approach"])
    low, high = 10.0, 15.0
    few = solve({"load": low}).in_contact.sum()
    while (middle := 0.5 * (low + high)) not in (low, high):
        more = solve({"load": middle}).in_contact.sum() > few
        low, high = (low, middle) if more else (middle, high)
    load = torch.tensor(high, dtype=torch.float64, requires_grad=True)
    approach = solve({"load": load}).outputs["approach"]
    with pytest.warns(nacre.NacreWarning, match="about to join or to leave"):
        approach.backward()


def test_threads_share_a_function() -> None:
    gradient = torch.func.grad(objective(solver(keep=1)))
    points = [zero() + 0.01 * k for k in range(4)]
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
    assert all(torch.equal(one, expected[k]) for (_, k), one in found.items())


def test_derivatives_of_the_second_order_are_refused() -> None:
    value = objective(solver())
    jacfwd, jacrev = torch.func.jacfwd, torch.func.jacrev
    for second in (torch.func.hessian(value), jacrev(jacrev(value)), jacfwd(jacfwd(value))):
        with pytest.raises(TypeError, match="first derivatives only"):
            second(zero())
    here = zero(requires_grad=True)
    (gradient,) = torch.autograd.grad(value(here), here, create_graph=True)
    with pytest.raises(TypeError, match="first derivatives only"):
        gradient.sum().backward()


@pytest.mark.parametrize(
    ("parameters", "gap", "message"),
    [
        ({"load": torch.tensor(10.0)}, None, r"'load'\] must be float64 of shape \(\).*float32"),
        ({"load": torch.ones(1, dtype=torch.float64)}, None, r"of shape \(1,\)"),
        (
            {"load": torch.ones((), dtype=torch.float64, device="meta")},
            None,
            "on the CPU, got torch.float64 of shape .* on meta",
        ),
        ({"load": "ten"}, None, "must be a number or a tensor, got 'ten'"),
        ({}, np.zeros(3), r"gap must be float64 of shape \(24, 22\).*\(3,\)"),
        (1.0, None, r"must be a dict of paths and numbers, got 1\.0"),
    ],
)
def test_arguments_are_checked(parameters: Any, gap: Any, message: str) -> None:
    with pytest.raises(TypeError, match=message):
        solver()(parameters, gap)


def test_nacre_alone_does_not_import_torch() -> None:
    code = "import sys, nacre; assert 'torch' not in sys.modules and 'torch' in dir(nacre)"
    subprocess.run([sys.executable, "-c", code], check=True)
    assert callable(nacre.torch.solver)


def test_the_example_is_true() -> None:
    import nacre.torch

    result = doctest.testmod(nacre.torch)
    assert (result.attempted > 0, result.failed) == (True, 0)
