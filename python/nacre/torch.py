"""Contacts as functions that PyTorch differentiates and maps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple, NoReturn, Protocol, TypeAlias

import nacre._core as core
from nacre._tools.extras import extra
from nacre._tools.typing import Body, Matrix, Vector
from nacre.design.differentiable import SECOND, Array, Differentiable, Outputs

with extra("torch"):
    import torch

__all__ = ["Result", "solver"]
__dir__ = __all__.copy

Value: TypeAlias = "float | Vector | Matrix | torch.Tensor"
Tensors: TypeAlias = "torch.Tensor | tuple[torch.Tensor, ...]"
Dimensions = tuple[int | None, ...]
"""Dimension of each argument that a map goes along; None where it is the same for all."""
Looped: TypeAlias = "tuple[Tensors, Dimensions | int]"
Inputs: TypeAlias = "tuple[Differentiable, tuple[str, ...], torch.Tensor]"


class Batch(Protocol):
    """What PyTorch says of a map."""

    batch_size: int


class Context(Protocol):
    """What PyTorch keeps of a call for its derivatives."""

    contact: Differentiable
    names: tuple[str, ...]
    saved_tensors: tuple[torch.Tensor, ...]

    def mark_non_differentiable(self, *tensors: torch.Tensor) -> None:
        """Say which results have no derivative."""

    def save_for_backward(self, *tensors: torch.Tensor) -> None:
        """Keep tensors for the reverse mode."""

    def save_for_forward(self, *tensors: torch.Tensor) -> None:
        """Keep tensors for the forward mode."""


class Result(NamedTuple):
    """Solved contact, as tensors of PyTorch.

    Attributes
    ----------
    pressure : torch.Tensor
        Pressure of each cell ``(nx, ny)`` [Pa].
    outputs : dict of torch.Tensor
        The outputs, by name.
    in_contact : torch.Tensor
        Whether each cell has a pressure ``(nx, ny)``; it has no derivative.
    """

    pressure: torch.Tensor
    outputs: dict[str, torch.Tensor]
    in_contact: torch.Tensor


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
    ``(nx, ny)``. The result is a `Result`. It works with ``backward``, `torch.func.grad`,
    `torch.func.jvp`, `torch.func.vmap` (one solve after the other) and what is made of them, in
    float64 and on the CPU.

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
        If an argument cannot be right. Of a call: if a parameter or the gap has the wrong path,
        dtype, device or shape. A solve that fails raises its own error.

    Warns
    -----
    nacre.NacreWarning
        If a cell is about to join or to leave the contact, where derivatives jump.

    Notes
    -----
    Derivatives of the second order do not exist, and raise.

    Examples
    --------
    >>> import torch, nacre.torch
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid(shape=(64, 64), size=(2e-4, 2e-4))
    >>> solve = nacre.torch.solver(nacre.Sphere(5e-3), steel, grid=grid, load=10.0)
    >>> load = torch.tensor(10.0, dtype=torch.float64, requires_grad=True)
    >>> approach = solve({"load": load}).outputs["approach"]
    >>> approach.log().backward()
    >>> round(load.grad.item() * load.item(), 2)  # δ ~ W^(2/3)
    0.67
    """
    keywords = {**arguments, "shape": shape, "body": body, "counterbody": counterbody, "grid": grid}
    contact = Differentiable(keywords, outputs, keep)

    def solve(parameters: Mapping[str, Value], gap: Value | None = None) -> Result:
        if not isinstance(parameters, Mapping):
            raise TypeError(f"parameters must be a dict of paths and numbers, got {parameters!r}")
        names = tuple(sorted(parameters))
        contact.check(names, gap is not None)
        tensors = [_float_tensor(f"parameters[{name!r}]", parameters[name], ()) for name in names]
        if gap is not None:
            tensors.append(_float_tensor("gap", gap, contact.grid.shape))
        flat = [tensor.reshape(-1) for tensor in tensors]
        x = torch.cat(flat or [torch.zeros(0, dtype=torch.float64)])
        pressure, values, in_contact = _Solve.apply(contact, names, x)
        shape = contact.grid.shape
        by_name = {name: values[k] for k, name in enumerate(contact.outputs)}
        return Result(pressure.reshape(shape), by_name, in_contact.reshape(shape))

    return solve


def _float_tensor(name: str, value: Value, shape: tuple[int, ...]) -> torch.Tensor:
    """Return a tensor of float64 on the CPU."""
    if not isinstance(value, torch.Tensor):
        try:
            value = torch.tensor(core.real_array(name, value), dtype=torch.float64)
        except TypeError:
            raise TypeError(f"{name} must be a number or a tensor, got {value!r}") from None
    if value.dtype != torch.float64 or tuple(value.shape) != shape or value.device.type != "cpu":
        raise TypeError(
            f"{name} must be float64 of shape {shape} on the CPU, "
            f"got {value.dtype} of shape {tuple(value.shape)} on {value.device}"
        )
    return value


def _tensor(array: Array) -> torch.Tensor:
    return torch.tensor(array, dtype=torch.float64)


def _batch_results(
    function: Callable[..., Tensors], info: Batch, in_dims: Dimensions, *arguments: torch.Tensor
) -> Looped:
    """Return the results of a function for each element of a batch, stacked."""

    def element(k: int) -> Tensors:
        pairs = zip(arguments, in_dims, strict=True)
        return function(*(a.select(dim, k) if isinstance(dim, int) else a for a, dim in pairs))

    rows = [element(k) for k in range(info.batch_size)]
    if isinstance(rows[0], tuple):
        return tuple(torch.stack(column) for column in zip(*rows, strict=True)), (0,) * len(rows[0])
    return torch.stack(rows), 0


class _Solve(torch.autograd.Function):  # type: ignore[misc]
    """Pressures, outputs and flags of contact at a vector."""

    @staticmethod
    def forward(contact: Differentiable, names: tuple[str, ...], x: torch.Tensor) -> Tensors:
        pressure, values = contact.values(names, x.detach().numpy())
        return _tensor(pressure), _tensor(values), torch.tensor(pressure > 0)

    @staticmethod
    def setup_context(ctx: Context, inputs: Inputs, output: tuple[torch.Tensor, ...]) -> None:
        ctx.contact, ctx.names, x = inputs
        ctx.mark_non_differentiable(output[2])
        ctx.save_for_backward(x)
        ctx.save_for_forward(x)

    @staticmethod
    def backward(ctx: Context, *weights: torch.Tensor) -> tuple[None, None, torch.Tensor]:
        (x,) = ctx.saved_tensors
        return None, None, _Pull.apply(ctx.contact, ctx.names, x, *weights[:2])

    @staticmethod
    def jvp(ctx: Context, *rates: torch.Tensor) -> tuple[torch.Tensor | None, ...]:
        (x,) = ctx.saved_tensors
        return *_Push.apply(ctx.contact, ctx.names, x, rates[2]), None

    @staticmethod
    def vmap(info: Batch, in_dims: Dimensions, *arguments: torch.Tensor) -> Looped:
        return _batch_results(_Solve.apply, info, in_dims, *arguments)


class _First(torch.autograd.Function):  # type: ignore[misc]
    """A derivative, which has no derivatives itself."""

    @staticmethod
    def setup_context(ctx: object, inputs: object, output: object) -> None:
        pass

    @staticmethod
    def backward(ctx: object, *weights: object) -> NoReturn:
        raise TypeError(SECOND)

    @staticmethod
    def jvp(ctx: object, *rates: object) -> NoReturn:
        raise TypeError(SECOND)


class _Pull(_First):
    """Derivatives of a weighted sum of pressures and outputs by the vector."""

    @staticmethod
    def forward(
        contact: Differentiable,
        names: tuple[str, ...],
        x: torch.Tensor,
        pressure: torch.Tensor,
        outputs: torch.Tensor,
    ) -> torch.Tensor:
        x, pressure, outputs = (tensor.detach().numpy() for tensor in (x, pressure, outputs))
        pulled = contact.pressure_pull(names, x, pressure)
        return _tensor(pulled + contact.outputs_pull(names, x, outputs))

    @staticmethod
    def vmap(info: Batch, in_dims: Dimensions, *arguments: torch.Tensor) -> Looped:
        return _batch_results(_Pull.apply, info, in_dims, *arguments)


class _Push(_First):
    """Rates of pressures and outputs along a rate of the vector."""

    @staticmethod
    def forward(
        contact: Differentiable, names: tuple[str, ...], x: torch.Tensor, rate: torch.Tensor
    ) -> Tensors:
        x, rate = x.detach().numpy(), rate.detach().numpy()
        pressure = contact.pressure_push(names, x, rate)
        return _tensor(pressure), _tensor(contact.outputs_push(names, x, rate))

    @staticmethod
    def vmap(info: Batch, in_dims: Dimensions, *arguments: torch.Tensor) -> Looped:
        return _batch_results(_Push.apply, info, in_dims, *arguments)
