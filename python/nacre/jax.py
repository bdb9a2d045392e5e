"""Contacts as functions that JAX differentiates, compiles and maps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple, NoReturn, Protocol, TypeAlias

import numpy as np

import nacre._core as core
from nacre._tools.extras import extra
from nacre._tools.notices import warn
from nacre._tools.typing import Body, Matrix, Vector
from nacre.design.differentiable import SECOND, Array, Differentiable, Outputs

with extra("jax"):
    import jax
    import jax.numpy as jnp

__all__ = ["Result", "solver"]
__dir__ = __all__.copy

Product = Callable[[tuple[str, ...], Array, Array], Array]
Linear: TypeAlias = "Callable[[jax.Array, jax.Array], jax.Array]"
Value: TypeAlias = "float | Vector | Matrix | jax.Array"


class Result(NamedTuple):
    """Solved contact, as arrays of JAX.

    Attributes
    ----------
    pressure : jax.Array
        Pressure of each cell ``(nx, ny)`` [Pa].
    outputs : dict of jax.Array
        The outputs, by name.
    in_contact : jax.Array
        Whether each cell has a pressure ``(nx, ny)``; it has no derivative.
    ok : jax.Array
        Whether the solve succeeded; it has no derivative. If not, pressure and outputs are NaN.
    """

    pressure: jax.Array
    outputs: dict[str, jax.Array]
    in_contact: jax.Array
    ok: jax.Array


class Solver(Protocol):
    """Function that `solver` returns."""

    def __call__(self, parameters: Mapping[str, Value], gap: Value | None = None) -> Result: ...


def solver(
    shape: core.Shape | None,
    body: Body,
    counterbody: Body | None = None,
    *,
    grid: core.Grid,
    outputs: Outputs = ("approach",),
    keep: int = 16,
    **arguments: object,
) -> Solver:
    """Return a contact as a function of some of its numbers, with derivatives of both modes.

    Call it as ``solve(parameters, gap=None)``. `parameters` is a dict of paths, those of
    `Solution.gradient` such as ``"load"`` or ``"body.layers[0].thickness"``, and numbers that
    replace those given here. `gap` is added to the undeformed gap of the shape in each cell
    ``(nx, ny)``. The result is a `Result`. It works under `jax.grad`, `jax.jvp`, `jax.jit`,
    `jax.vmap` (one solve after the other) and what is made of them, in float64 and on the CPU.

    Parameters
    ----------
    shape : Shape or None
        Undeformed shape. None if the gap of each call is the whole shape.
    body, counterbody : HalfSpace, Elastic or Response
        Bodies, as for `nacre.solve`.
    grid : Grid
        Grid of all solves.
    outputs : list of str or dict, optional
        Outputs of `Solution.gradient`: words, or a dict of any outputs by names of your choice.
    keep : int, optional
        Number of solutions that are kept, so that their derivatives do not solve again.
    **arguments
        Other arguments of `nacre.solve`, such as the load. The tolerance is 1e-10 by default.

    Returns
    -------
    callable
        Function of `parameters` and `gap`.

    Raises
    ------
    TypeError, ValueError
        If an argument cannot be right. Of a call: if JAX computes in float32, or a parameter or the
        gap has the wrong path, dtype or shape. Outside of `jit` and `vmap`, a solve that fails
        raises its own error.

    Warns
    -----
    nacre.NacreWarning
        If a solve fails where it cannot raise, under `jit` and `vmap`, or in a derivative; or if a
        cell is about to join or to leave the contact, where derivatives jump.

    Notes
    -----
    Derivatives of the second order do not exist, and raise. A solve that fails has NaN as its
    derivatives, but 0 where nothing depends on it: ``jnp.where(ok, result, 0.0)`` has none.

    Examples
    --------
    >>> import jax, nacre.jax
    >>> jax.config.update("jax_enable_x64", True)
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid(shape=(64, 64), size=(2e-4, 2e-4))
    >>> solve = nacre.jax.solver(nacre.Sphere(5e-3), steel, grid=grid, load=10.0)
    >>> approach = jax.jit(lambda load: solve({"load": load}).outputs["approach"])
    >>> load = 10.0
    >>> round(float(jax.grad(approach)(load) * load / approach(load)), 2)  # δ ~ W^(2/3)
    0.67
    """
    keywords = {**arguments, "shape": shape, "body": body, "counterbody": counterbody, "grid": grid}
    contact = Differentiable(keywords, outputs, keep)
    functions: dict[tuple[str, ...], Callable[[jax.Array], jax.Array]] = {}

    def solve(parameters: Mapping[str, Value], gap: Value | None = None) -> Result:
        if not isinstance(parameters, Mapping):
            raise TypeError(f"parameters must be a dict of paths and numbers, got {parameters!r}")
        if jax.dtypes.canonicalize_dtype(np.float64) != np.float64:
            raise TypeError(
                "nacre.jax computes in float64, which JAX leaves out unless asked: "
                'jax.config.update("jax_enable_x64", True)'
            )
        names = tuple(sorted(parameters))
        contact.check(names, gap is not None)
        arrays = [_float_array(f"parameters[{name!r}]", parameters[name], ()) for name in names]
        if gap is not None:
            arrays.append(_float_array("gap", gap, contact.grid.shape).ravel())
        x = jnp.concatenate([jnp.atleast_1d(array) for array in arrays] or [jnp.zeros(0)])
        if names not in functions:
            functions[names] = _function(contact, names)
        flat = functions[names](x)
        pressure = flat[1 : contact.cells + 1].reshape(contact.grid.shape)
        values = dict(zip(contact.outputs, flat[contact.cells + 1 :], strict=True))
        return Result(pressure, values, pressure > 0, flat[0] > 0)

    return solve


def _float_array(name: str, value: Value, shape: tuple[int, ...]) -> jax.Array:
    """Return an array of float64."""
    array = value if isinstance(value, jax.Array) else jnp.asarray(core.real_array(name, value))
    if array.dtype != np.float64 or array.shape != shape:
        raise TypeError(
            f"{name} must be float64 of shape {shape}, got {array.dtype} of shape {array.shape}"
        )
    return array


def _function(contact: Differentiable, names: tuple[str, ...]) -> jax.custom_jvp[jax.Array]:
    """Return the function of a vector to (1, pressures, outputs), with its derivatives."""
    cells, count = contact.cells, len(contact.outputs)

    def values(x: Array) -> Array:
        return np.concatenate([[1.0], *contact.values(names, x)])

    def primal(x: jax.Array) -> jax.Array:
        if not isinstance(x, jax.core.Tracer):
            return jnp.asarray(values(np.asarray(x)))  # A solve that fails raises its error.
        return _callback(values, 1 + cells + count, x)

    def rule(primals: tuple[jax.Array], tangents: tuple[jax.Array]) -> tuple[jax.Array, jax.Array]:
        (x,), (rate,) = primals, tangents
        at = first(x)
        return function(x), jnp.concatenate([jnp.zeros(1), pressure(at, rate), outputs(at, rate)])

    first = _first()
    # Compiled once, also for calls that are not.
    pressure = jax.jit(_product(contact.pressure_push, contact.pressure_pull, names, cells))
    outputs = jax.jit(_product(contact.outputs_push, contact.outputs_pull, names, count))
    function = jax.custom_jvp(primal)
    function.defjvp(rule)
    return function


def _first() -> jax.custom_jvp[jax.Array]:
    """Return the identity, which raises where it is differentiated."""

    def rule(primals: object, tangents: object) -> NoReturn:
        raise TypeError(SECOND)

    identity = jax.custom_jvp(lambda x: x)
    identity.defjvp(rule)
    return identity


def _product(push: Product, pull: Product, names: tuple[str, ...], count: int) -> Linear:
    """Return the product J `rate` of a Jacobian (count, len(x)), which JAX may transpose.

    JAX transposes and maps a linear solve whose two solvers are given: here that of a matrix
    with the inverse (1, 0; J, 1), applied to (rate, 0). It never multiplies by the matrix itself.
    """

    def forward(x: Array, rate: Array) -> Array:
        return push(names, x, rate)

    def backward(x: Array, weights: Array) -> Array:
        return pull(names, x, weights)

    def product(x: jax.Array, rate: jax.Array) -> jax.Array:
        size = len(x)

        def solve(_: object, b: jax.Array) -> jax.Array:
            return b.at[size:].add(_callback(forward, count, x, b[:size]))

        def transposed(_: object, b: jax.Array) -> jax.Array:
            return b.at[:size].add(_callback(backward, size, x, b[size:]))

        b = jnp.concatenate([rate, jnp.zeros(count)])
        extended = jax.lax.custom_linear_solve(lambda b: b, b, solve, transposed, symmetric=True)
        return extended[size:]

    return product


def _callback(function: Callable[..., Array], size: int, *arrays: jax.Array) -> jax.Array:
    """Return what a function of arrays returns, NaN where it fails, as an array of JAX."""

    def values_or_nan(*arrays: jax.Array) -> Array:
        try:
            return function(*(np.asarray(array, dtype=np.float64) for array in arrays))
        except Exception as error:
            message = "; ".join([str(error), *getattr(error, "__notes__", [])])
            _warn(f"the results are NaN: {message}")
            return np.full(size, np.nan)

    row = jax.ShapeDtypeStruct((size,), np.float64)
    return jax.pure_callback(values_or_nan, row, *arrays, vmap_method="sequential")


def _warn(message: str) -> None:
    try:
        warn(message)
    except core.NacreWarning:
        pass  # Warnings are errors here, and a callback must not raise: NaN has to tell it.
