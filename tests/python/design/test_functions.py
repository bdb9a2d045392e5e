"""A contact is a function of JAX and of PyTorch, with derivatives of both modes.

Each framework that is installed is tested; ``make torch`` installs PyTorch.
"""

import doctest
import importlib
import subprocess
import sys
import threading
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, COATED, ROD, STEEL
from support import assert_close

# PyTorch scripts its own decompositions where forward derivatives are first asked for.
pytestmark = pytest.mark.filterwarnings("ignore:.*torch.jit:FutureWarning")

GRID = nacre.Grid(shape=(20, 18), size=(2e-4, 1.9e-4))
SQUARE = nacre.Grid(shape=(16, 16), size=(2e-4, 2e-4))
NUMBERS = {
    "body.layers[0].material.young": 420e9,
    "body.layers[0].thickness": 20e-6,
    "counterbody.substrate.poisson": 0.3,
    "load": 10.0,
    "shape.radius": 5e-3,
}
SHEAR = {"stress": "von_mises", "at": (1e-5, 0.0, 3e-5)}
OUTPUTS = {"approach": "approach", "norm": ("pressure_norm", 16.0), "shear": SHEAR}
THICKNESS = "body.layers[0].thickness"
WEIGHTS = np.random.default_rng(2).normal(size=GRID.shape) / 1e10
STEP, BAR = 1e-5, 2e-7
"""Steps of logarithms, within the valid ones, and what differences of them are worth."""


@pytest.fixture(params=["jax", "torch"])
def tools(request: pytest.FixtureRequest) -> Iterator[Any]:
    """Return what both frameworks have, by the same names."""
    framework = pytest.importorskip(request.param)
    module = importlib.import_module(f"nacre.{request.param}")
    if request.param == "torch":

        def check(function: Any, x: Any) -> None:
            here = x.clone().requires_grad_()
            options = {"eps": STEP, "atol": BAR, "rtol": BAR, "check_forward_ad": True}
            assert framework.autograd.gradcheck(function, [here], **options)

        def vector(values: Any) -> Any:
            return framework.tensor(np.asarray(values, dtype=np.float64))

        yield SimpleNamespace(
            name="torch", module=module, np=framework, at=framework.func, check=check, array=vector
        )
        return

    def check_grads_of(function: Any, x: Any) -> None:
        for mode in ("fwd", "rev"):
            check_grads(function, (x,), 1, modes=[mode], eps=STEP, atol=BAR, rtol=BAR)

    from jax.test_util import check_grads

    before = framework.config.jax_enable_x64
    framework.config.update("jax_enable_x64", True)
    xp = framework.numpy
    yield SimpleNamespace(
        name="jax", module=module, np=xp, at=framework, check=check_grads_of, array=xp.asarray
    )
    framework.config.update("jax_enable_x64", before)


@pytest.fixture
def jax(tools: Any) -> Any:
    if tools.name != "jax":
        pytest.skip("not of this framework")
    return tools.at


@pytest.fixture
def torch(tools: Any) -> Any:
    if tools.name != "torch":
        pytest.skip("not of this framework")
    return tools.np


def solver(tools: Any, **changes: Any) -> Any:
    given = {"shape": BALL, "body": COATED, "counterbody": STEEL, "grid": GRID, "load": 10.0}
    # Differences of relative steps of 1e-5 lose five digits of the solves.
    return tools.module.solver(**{**given, "outputs": OUTPUTS, "tolerance": 1e-13, **changes})


def numbers(tools: Any, logarithms: Any) -> dict[str, Any]:
    return {
        name: value * tools.np.exp(logarithms[k]) for k, (name, value) in enumerate(NUMBERS.items())
    }


def zero(tools: Any) -> Any:
    return tools.array(np.zeros(len(NUMBERS)))


def total(found: Any, weights: Any) -> Any:
    """Return a sum of pressures and outputs, of order 1."""
    outputs = {"norm": 0.0, "approach": 0.0, "shear": 0.0} | found.outputs
    scaled = outputs["norm"] / 1e9 + outputs["approach"] * 1e6 + outputs["shear"] / 1e9
    return (weights * found.pressure).sum() + scaled


def objective(tools: Any, solve: Any) -> Any:
    """Return the sum as a function of logarithms and a gap."""
    weights = tools.array(WEIGHTS)
    return lambda logarithms, gap=None: total(solve(numbers(tools, logarithms), gap), weights)


# Derivatives.


def test_derivatives_are_true(tools: Any) -> None:
    solve = solver(tools)
    value = objective(tools, solve)
    for call in (value, *([tools.at.jit(value)] if tools.name == "jax" else [])):
        tools.check(call, zero(tools))

    def fields(logarithms: Any) -> Any:
        found = solve(numbers(tools, logarithms))
        return found.pressure[10:13] / 1e9, found.outputs["approach"] * 1e6

    tools.check(fields, zero(tools))


def test_transforms_agree(tools: Any) -> None:
    value, here, at = objective(tools, solver(tools)), zero(tools), tools.at
    gradient = at.grad(value)(here)
    assert (at.jacrev(value)(here) == gradient).all()
    assert_close(at.jacfwd(value)(here), gradient, rtol=1e-7, atol=1e-7)
    _, rate = at.jvp(value, (here,), (tools.np.ones_like(here),))
    assert float(rate) == pytest.approx(float(gradient.sum()), rel=1e-7)
    many = tools.np.stack([here, here + 0.01, here - 0.02])
    compiled = at.jit if tools.name == "jax" else lambda call: call
    tools.check(compiled(at.vmap(value)), many)
    calls = (value, at.grad(value), at.jacfwd(value))
    for call in calls:
        found, alone = compiled(at.vmap(call))(many), tools.np.stack([call(one) for one in many])
        if tools.name == "torch" or call is calls[1]:
            assert (found == alone).all()
        else:  # compiled, JAX may add the terms of a sum in another order
            assert_close(found, alone, rtol=1e-13, atol=1e-13)


def test_the_pressure_field_and_all_of_both_modes_agree(tools: Any) -> None:
    solve = solver(tools)

    def pressure(logarithms: Any) -> Any:
        return solve(numbers(tools, logarithms)).pressure

    forward = tools.at.jacfwd(pressure)(zero(tools))
    row = tools.at.jacrev(lambda x: pressure(x)[12])(zero(tools))
    assert forward.shape == (*GRID.shape, len(NUMBERS))
    assert abs(forward[12] - row).max() < 1e-7 * abs(row).max()
    load = float(forward[..., list(NUMBERS).index("load")].sum()) * np.prod(GRID.spacing)
    assert load == pytest.approx(10.0, rel=1e-8)  # d(sum p dA)/d(ln W) = W


CASES: dict[str, dict[str, Any]] = {
    "load": {},
    "approach": {"load": None, "approach": 6e-7, "outputs": {"load": "load", **OUTPUTS}},
    "line": {"shape": ROD, "grid": nacre.Grid.line(40, 1e-4), "load": 1e4},
    "periodic": {
        "shape": None,
        "grid": nacre.Grid((24, 20), (1e-3, 9e-4), periodic=(True, True)),
        "load": 20.0,
    },
    "periodic along x": {
        "shape": ROD,
        "grid": nacre.Grid((24, 40), (1e-3, 2e-4), periodic=(True, False)),
        "load": 100.0,
    },
}


@pytest.mark.parametrize("case", CASES)
def test_derivatives_by_a_gap_are_true(tools: Any, case: str) -> None:
    changes = CASES[case]
    on_balls = case in ("load", "approach")
    plain = {} if on_balls else {"body": STEEL, "counterbody": None, "outputs": ["approach"]}
    solve = solver(tools, **plain, **changes)
    grid = changes.get("grid", GRID)
    path = "approach" if changes.get("approach") else "load"
    given = changes.get(path, 10.0)
    rng = np.random.default_rng(1)
    gap = 1e-9 * rng.normal(size=grid.shape)
    if not on_balls:
        x, y = grid.x[:, None] / grid.size[0], grid.y[None, :] / grid.size[1]
        gap = 1e-8 * np.cos(2 * np.pi * (x + y)) * np.ones(grid.shape)
    # Of the motion and of the gap, in nanometres, along three directions.
    directions = tools.array(1e-9 * rng.normal(size=(3, *grid.shape)))
    weights = tools.array(rng.normal(size=grid.shape) / 1e10)

    def along(steps: Any) -> Any:
        moved = tools.array(gap) + tools.np.tensordot(steps[1:], directions, 1)
        return total(solve({path: given * tools.np.exp(steps[0])}, moved), weights)

    tools.check(along, tools.array(np.zeros(4)))


def test_all_of_a_gap_moves_the_origin_of_the_approach(tools: Any) -> None:
    alone, added = solver(tools, shape=None), solver(tools)
    gap, none = tools.array(BALL.gaps(GRID)), tools.array(np.zeros(GRID.shape))
    expected = added({})
    for found in (alone({}, gap + 3e-8), added({}, none + 3e-8)):
        assert_close(
            found.pressure, expected.pressure, rtol=1e-9, atol=1e-9 * float(expected.pressure.max())
        )
        for name, shift in (("approach", 3e-8), ("norm", 0.0), ("shear", 0.0)):
            moved = float(expected.outputs[name]) + shift
            assert float(found.outputs[name]) == pytest.approx(moved, rel=1e-9)
    pushed = solver(tools, load=None, approach=6e-7)
    here, there = pushed({}, none), pushed({"approach": 7e-7}, none + 1e-7)
    assert_close(there.pressure, here.pressure, rtol=1e-6)
    weights = tools.array(WEIGHTS)
    fields = [
        tools.at.grad(lambda x, solve=solve: total(solve({}, x), weights))(at)
        for solve, at in ((alone, gap), (added, none))
    ]
    assert abs(fields[0] - fields[1]).max() < 1e-6 * abs(fields[1]).max()
    approach = tools.at.grad(lambda gap: alone({}, gap).outputs["approach"])(gap)
    assert float(approach.sum()) == pytest.approx(1.0, rel=1e-8)


def test_a_mapped_gap_and_a_fixed_load(tools: Any) -> None:
    solve = solver(tools)
    gaps = tools.array(1e-9 * np.random.default_rng(1).normal(size=(2, *GRID.shape)))
    found = tools.at.vmap(lambda gap: solve({"load": 12.0}, gap))(gaps)
    assert found.pressure.shape == (2, *GRID.shape)
    for k, gap in enumerate(gaps):
        alone = solve({"load": np.float64(12.0)}, np.asarray(gap))
        assert (found.pressure[k] == alone.pressure).all()
        assert (found.in_contact[k] == alone.in_contact).all()
        assert found.outputs["norm"][k] == alone.outputs["norm"]


def test_shifted_shapes_and_their_parts_have_paths(tools: Any) -> None:
    pair = BALL.shifted(2e-5, 0.0) + nacre.Paraboloid(5e-3, 6e-3)
    paths = ("shape.parts[0].shift[0]", "shape.parts[0].radius", "shape.parts[1].radius_y")
    solve, weights = solver(tools, shape=pair, load=20.0), tools.array(WEIGHTS)
    values = dict(zip(paths, (2e-5, 5e-3, 6e-3), strict=True))

    def value(logarithms: Any) -> Any:
        scaled = (value * tools.np.exp(logarithms[k]) for k, value in enumerate(values.values()))
        return total(solve(dict(zip(paths, scaled, strict=True))), weights)

    tools.check(value, tools.array(np.zeros(3)))


# Results.


def test_results_are_those_of_nacre(tools: Any) -> None:
    found = solver(tools)({})
    solution = nacre.solve(BALL, COATED, STEEL, grid=GRID, load=10.0, tolerance=1e-13)
    assert np.array_equal(np.asarray(found.pressure), solution.pressure)
    assert float(found.outputs["approach"]) == solution.approach
    assert np.array_equal(np.asarray(found.in_contact), solution.pressure > 0)
    assert np.asarray(found.pressure).dtype == np.float64
    if tools.name == "jax":
        assert bool(found.ok)
    else:
        assert not solver(tools)(
            {"load": tools.array(10.0).requires_grad_()}
        ).in_contact.requires_grad


def test_kept_solutions_change_no_result(tools: Any) -> None:
    points = [zero(tools) + 1e-3 * k for k in range(3)]
    fresh = [tools.at.grad(objective(tools, solver(tools)))(point) for point in points]
    for keep in (16, 1):
        gradient = tools.at.grad(objective(tools, solver(tools, keep=keep)))
        for point, expected in zip([*points, *points], [*fresh, *fresh], strict=True):
            assert (gradient(point) == expected).all()


def test_a_derivative_does_not_solve_again(tools: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    solves: list[float] = []
    contact = nacre.Contact

    class Counted:
        def __init__(self, **planned: Any) -> None:
            self.plan = contact(**planned)

        def solve(self, *arguments: Any, **motion: Any) -> nacre.Solution:
            solves.append(motion["load"])
            return self.plan.solve(*arguments, **motion)

    monkeypatch.setattr("nacre.design.differentiable.Contact", Counted)
    value, here = objective(tools, solver(tools)), zero(tools)
    for call in (value, tools.at.grad(value), tools.at.jacfwd(value), value):
        call(here)
        assert solves == [10.0]


def test_threads_share_a_function(tools: Any) -> None:
    gradient = tools.at.grad(objective(tools, solver(tools, keep=1)))
    points = [zero(tools) + 0.01 * k for k in range(4)]
    expected = [tools.at.grad(objective(tools, solver(tools)))(point) for point in points]
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
    assert all((one == expected[k]).all() for (_, k), one in found.items())


def test_an_optimiser_finds_a_thickness(torch: Any, tools: Any) -> None:
    solve = solver(tools)
    measured = solve({THICKNESS: 24e-6}).pressure
    log = torch.tensor(np.log(16e-6), requires_grad=True)
    descent = torch.optim.LBFGS([log], lr=0.5, max_iter=20, tolerance_grad=1e-12)

    def misfit() -> Any:
        descent.zero_grad()
        value = ((solve({THICKNESS: torch.exp(log)}).pressure - measured) ** 2).sum() / 1e16
        value.backward()
        return value

    descent.step(misfit)
    assert log.exp().item() == pytest.approx(24e-6, rel=1e-4)


# Errors and warnings.


def test_a_kink_is_told_once(tools: Any) -> None:
    """A load at which a cell is about to leave the contact is found by bisection."""
    solve = solver(
        tools, body=STEEL, counterbody=None, grid=SQUARE, outputs=["approach"], keep=1000
    )
    low, high = 10.0, 15.0
    few = solve({"load": low}).in_contact.sum()
    assert solve({"load": high}).in_contact.sum() > few
    while (middle := 0.5 * (low + high)) not in (low, high):
        more = solve({"load": middle}).in_contact.sum() > few
        low, high = (low, middle) if more else (middle, high)
    load = tools.array(high)

    def derivatives() -> None:
        for transform in (tools.at.grad, tools.at.jacfwd):
            np.asarray(transform(lambda x: solve({"load": x}).pressure[8, 8])(load))
            np.asarray(transform(lambda x: solve({"load": x}).outputs["approach"])(load))

    with pytest.warns(nacre.NacreWarning, match="about to join or to leave") as told:
        derivatives()
    assert len(told) == 1


def test_a_failing_solve_raises_and_says_where(tools: Any) -> None:
    def approach(thickness: Any) -> Any:
        return solver(tools)({THICKNESS: thickness}).outputs["norm"]

    for call in (approach, tools.at.grad(approach)):
        with pytest.raises(ValueError, match="thickness must be") as raised:
            call(tools.array(-1e-6))
        said = "in a differentiable solve, at body.layers[0].thickness = -1e-06"
        assert said in raised.value.__notes__
    with pytest.raises(ValueError, match="has no derivative: it changes by whole cells"):
        solver(tools, outputs=["contact_area"])({})
    # A centred ball has four equal cells at its peak.
    with pytest.raises(ValueError, match="two cells have the largest pressure"):
        solver(tools, grid=SQUARE, outputs=["cell_peak"])({})


def test_a_failing_solve_under_jit_and_vmap_is_flagged(jax: Any, tools: Any) -> None:
    solve, xp = solver(tools), tools.np

    def norm(x: Any) -> Any:
        found = solve({THICKNESS: x})
        return xp.where(found.ok, found.outputs["norm"] / 1e9, -1.0), found

    mapped = jax.jit(jax.vmap(jax.value_and_grad(norm, has_aux=True)))
    with pytest.warns(nacre.NacreWarning, match=r"the results are NaN.*thickness must be.*-1e-06"):
        (values, found), slopes = jax.block_until_ready(mapped(xp.array([-1e-6, 20e-6])))
    assert found.ok.tolist() == [False, True]
    assert (values[0], slopes[0]) == (-1.0, 0.0)
    assert xp.isnan(found.pressure[0]).all()
    assert xp.isnan(found.outputs["approach"][0])
    assert not found.in_contact[0].any()
    assert xp.isfinite(found.pressure[1]).all()
    assert slopes[1] != 0.0
    # Where warnings are errors, as in these tests, NaN has to tell.
    slope = jax.jit(jax.grad(lambda x: solve({THICKNESS: x}).outputs["norm"]))
    assert xp.isnan(slope(-1e-6))


def test_derivatives_of_the_second_order_are_refused(tools: Any) -> None:
    value, at = objective(tools, solver(tools)), tools.at
    seconds = [at.hessian(value), at.jacrev(at.grad(value)), at.jacrev(at.jacrev(value))]
    for second in [*seconds, at.jacfwd(at.jacfwd(value))]:
        with pytest.raises(TypeError, match="first derivatives only"):
            second(zero(tools))
    if tools.name == "torch":
        here = zero(tools).requires_grad_()
        (gradient,) = tools.np.autograd.grad(value(here), here, create_graph=True)
        with pytest.raises(TypeError, match="first derivatives only"):
            gradient.sum().backward()


@pytest.mark.parametrize(
    ("changes", "words"),
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
def test_what_cannot_be_right_is_refused(tools: Any, changes: dict[str, Any], words: str) -> None:
    with pytest.raises((TypeError, ValueError), match=words):
        solver(tools, **changes)


CALLS: list[tuple[Any, Any, str]] = [
    ({"tolerance": 1.0}, None, "must be paths that begin with one of body, counterbody"),
    ({"body.layers[1].thickness": 1.0}, None, "parameters must name parameters .* no 1"),
    ({"shape.radios": 1.0}, None, "no radios"),
    ({"shape": 1.0}, None, "parameters must name numbers of the arguments, got 'shape'"),
    ({"approach": 1.0}, None, "got 'approach'"),
    ({"load[0]": 1.0}, None, r"got 'load\[0\]'"),
    ({3: 1.0}, None, "got 3"),
    ({"load": np.ones(1)}, None, r"'load'\] must be float64 of shape \(\).*got.*of shape \(1,\)"),
    ({"load": np.float32}, None, r"'load'\] must be float64 of shape \(\).*float32"),
    ({}, np.zeros(3), r"gap must be float64 of shape \(20, 18\).*\(3,\)"),
    (1.0, None, r"must be a dict of paths and numbers, got 1\.0"),
]


@pytest.mark.parametrize(("parameters", "gap", "words"), CALLS)
def test_arguments_are_checked(tools: Any, parameters: Any, gap: Any, words: str) -> None:
    xp = tools.np
    if isinstance(parameters, dict):
        single = xp.ones((), dtype=xp.float32)
        made = {np.float32: lambda _: single, np.ndarray: tools.array}
        parameters = {
            name: made.get(value if value is np.float32 else type(value), float)(value)
            for name, value in parameters.items()
        }
    calls = [solver(tools)]
    if tools.name == "jax" and parameters != 1.0 and 3 not in parameters:
        calls.append(tools.at.jit(calls[0]))
    for call in calls:
        with pytest.raises((TypeError, ValueError), match=words):
            call(parameters, None if gap is None else tools.array(gap))


def test_a_gap_is_needed_without_a_shape(tools: Any) -> None:
    with pytest.raises(TypeError, match="needs the gap of each cell"):
        solver(tools, shape=None)({})
    with pytest.raises(ValueError, match=r"got 'shape\.radius'"):
        solver(tools, shape=None)({"shape.radius": 1.0}, tools.array(np.zeros(GRID.shape)))


def test_frameworks_compute_in_float64_on_the_cpu(tools: Any) -> None:
    solve = solver(tools)
    if tools.name == "jax":
        tools.at.config.update("jax_enable_x64", False)
        with pytest.raises(TypeError, match="jax_enable_x64"):
            solve({"load": 10.0})
        return
    xp = tools.np
    elsewhere = xp.ones((), dtype=xp.float64, device="meta")
    for load, words in [
        (elsewhere, "on the CPU, got torch.float64 of shape .* on meta"),
        ("ten", "must be a number or a tensor, got 'ten'"),
    ]:
        with pytest.raises(TypeError, match=words):
            solve({"load": load})


def test_nacre_alone_does_not_import_it_and_the_example_is_true(tools: Any) -> None:
    name = tools.name
    code = f"import sys, nacre; assert {name!r} not in sys.modules and {name!r} in dir(nacre)"
    subprocess.run([sys.executable, "-c", code], check=True)
    assert callable(getattr(nacre, name).solver)
    result = doctest.testmod(tools.module)
    assert (result.attempted > 0, result.failed) == (True, 0)
