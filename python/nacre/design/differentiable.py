"""A contact as a function of its numbers, which `nacre.jax` and `nacre.torch` differentiate."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.notices import warn
from nacre._tools.paths import DIFFERENTIABLE, holder, put
from nacre.contact import Contact
from nacre.contact.gradient import Gradient, Output
from nacre.contact.solution import Solution
from nacre.studies import ARGUMENTS

Array = npt.NDArray[np.float64]
Value = TypeVar("Value")
Outputs = Sequence[str] | Mapping[str, Output]

ACCURATE = 1e-10
"""Tolerance of solves: errors of a solution enter its derivatives linearly."""
PLANS = 4
"""Plans that are kept; a plan holds the influence coefficients of its bodies."""
ROOTS = (*DIFFERENTIABLE, "shape")
"""Arguments of a solve that have derivatives."""
ABSENT = {"initial", "progress", "check"}
"""Arguments of a solve that a function cannot have: its results depend on its numbers alone."""
SECOND = "a contact has first derivatives only: they cannot be differentiated again"
"""What a derivative of a derivative says."""
PLANNED = ("body", "counterbody", "grid", "threads")
READ: dict[str, Callable[[Solution], float]] = {
    "approach": lambda solution: solution.approach,
    "tilt[0]": lambda solution: solution.tilt[0],
    "tilt[1]": lambda solution: solution.tilt[1],
    "load": lambda solution: solution.load,
}
"""Outputs that a solution holds. Others come with their derivatives."""


@dataclass
class Point:
    """Solved contact, with the derivatives of its outputs once they have been asked for."""

    names: tuple[str, ...]
    shape: core.Shape | None
    solution: Solution
    lowest: float
    gradients: dict[str, Gradient] = field(default_factory=dict)
    issued: set[str] | None = None

    def tell(self, *gradients: Gradient) -> None:
        """Warn of what makes derivatives doubtful, once."""
        sentences = {sentence for gradient in gradients for sentence in gradient.warnings}
        fresh, self.issued = sentences - (self.issued or set()), sentences | (self.issued or set())
        for sentence in sorted(fresh):
            warn(sentence)


class Recent(Generic[Value]):
    """Values of the last keys; threads may share it."""

    def __init__(self, most: int) -> None:
        self.most = most
        self.values: OrderedDict[Hashable, Value] = OrderedDict()
        self.lock = threading.Lock()

    def at(self, key: Hashable, make: Callable[[], Value]) -> Value:
        """Return the value of a key, made where it is not known."""
        with self.lock:
            if key in self.values:
                self.values.move_to_end(key)
                return self.values[key]
        entry = make()
        with self.lock:
            self.values[key] = entry
            while len(self.values) > self.most:
                self.values.popitem(last=False)
        return entry


class Differentiable:
    """A contact on a given grid, as a function of some of its numbers and of an added gap.

    Its argument is one vector: the numbers at `names`, then the gap of each cell if there is one.
    Solutions and plans of the last calls are kept, so that a derivative need not solve again. They
    change no result: every solve starts from nothing.
    """

    def __init__(self, arguments: Mapping[str, Any], outputs: Outputs, keep: int) -> None:
        if unknown := set(arguments) - ARGUMENTS:
            raise TypeError(f"a solver has the arguments of nacre.solve, got {sorted(unknown)}")
        if refused := ABSENT & set(arguments):
            raise TypeError(
                f"a solver must not have {sorted(refused)}: "
                f"its results depend on the parameters of a call alone"
            )
        settings = {name: value for name, value in arguments.items() if value is not None}
        if not isinstance(grid := settings.get("grid"), core.Grid):
            raise TypeError(f"grid must be a Grid, so that cells stay where they are, got {grid!r}")
        keep = core.integer("keep", keep)
        if keep < 1:
            raise ValueError(f"keep must be a number of solutions, 1 or more, got {keep!r}")
        self.grid = grid
        self.cells = self.grid.shape[0] * self.grid.shape[1]
        self.outputs = _outputs_by_name(outputs)
        self.arguments = {"tolerance": ACCURATE, **settings}
        self.shape: core.Shape | None = self.arguments.pop("shape", None)
        self.points: Recent[Point] = Recent(keep)
        self.plans: Recent[Contact] = Recent(PLANS)

    def check(self, names: Iterable[str], gap: bool) -> None:
        """Check the paths of parameters, before there are any numbers."""
        if self.shape is None and not gap:
            raise TypeError("a solver without a shape needs the gap of each cell, got None")
        for path in names:
            if not isinstance(path, str) or path.split(".")[0].split("[")[0] not in ROOTS:
                raise ValueError(
                    f"parameters must be paths that begin with one of {', '.join(ROOTS)}, "
                    f"got {path!r}"
                )
            holder(self._all_arguments(), path, "parameters", "the arguments")

    def point(self, names: tuple[str, ...], x: Array) -> Point:
        """Return the solved contact at a vector."""
        x = np.ascontiguousarray(x, dtype=np.float64)
        digest = hashlib.sha256(x.tobytes()).digest()
        return self.points.at((names, len(x), digest), lambda: self._solved_point(names, x))

    def values(self, names: tuple[str, ...], x: Array) -> tuple[Array, Array]:
        """Return the pressures of the cells and the outputs."""
        point = self.point(names, x)
        hard = [
            name
            for name, output in self.outputs.items()
            if not (isinstance(output, str) and output in READ)
        ]
        gradients = self._gradients(point, hard)
        by_name = {name: gradient.value for name, gradient in gradients.items()}
        for name, output in self.outputs.items():
            if name not in by_name:
                by_name[name] = READ[str(output)](point.solution)
            if output == "approach":
                by_name[name] += point.lowest
        pressure: Array = point.solution.pressure.ravel()
        return pressure, np.array([by_name[name] for name in self.outputs], dtype=np.float64)

    def pressure_push(self, names: tuple[str, ...], x: Array, rates: Array) -> Array:
        """Return the rate of the pressure of each cell along a rate of the vector."""
        if not rates.any():
            return np.zeros(self.cells)
        point, n = self.point(names, x), len(names)
        gap = rates[n:].reshape(self.grid.shape) if len(rates) > n else None
        along = dict(zip(names, rates[:n].tolist(), strict=True))
        if point.issued is None:  # A direction has no warnings, and this gradient needs no solve.
            none = np.zeros(self.grid.shape)
            point.tell(point.solution.vjp(none, [], shape=point.shape))
        direction = point.solution.jvp(along, gap, shape=point.shape)
        pressure: Array = direction.pressure.ravel()
        return pressure

    def pressure_pull(self, names: tuple[str, ...], x: Array, weights: Array) -> Array:
        """Return the derivatives of a weighted sum of the pressures by the vector."""
        if not weights.any():
            return np.zeros(len(x))
        point, weights = self.point(names, x), np.array(weights).reshape(self.grid.shape)
        gradient = point.solution.vjp(weights, list(names), shape=point.shape)
        point.tell(gradient)
        return _row(gradient, names, len(x))

    def outputs_push(self, names: tuple[str, ...], x: Array, rates: Array) -> Array:
        """Return the rates of the outputs along a rate of the vector."""
        if not rates.any():
            return np.zeros(len(self.outputs))
        gradients = self._gradients(self.point(names, x), list(self.outputs))
        return np.array([_row(gradients[name], names, len(x)) @ rates for name in self.outputs])

    def outputs_pull(self, names: tuple[str, ...], x: Array, weights: Array) -> Array:
        """Return the derivatives of a weighted sum of the outputs by the vector."""
        total = np.zeros(len(x))
        if not weights.any():
            return total
        by_name = {name: w for name, w in zip(self.outputs, weights, strict=True) if w}
        gradients = self._gradients(self.point(names, x), list(by_name))
        for name, weight in by_name.items():
            total += weight * _row(gradients[name], names, len(x))
        return total

    def _all_arguments(self) -> dict[str, Any]:
        shape = {} if self.shape is None else {"shape": self.shape}
        return {**self.arguments, **shape}

    def _solved_point(self, names: tuple[str, ...], x: Array) -> Point:
        n = len(names)
        try:
            arguments = self._all_arguments()
            for path, value in zip(names, x[:n].tolist(), strict=True):
                put(arguments, path, value, names="parameters", of="the arguments")
            own_shape, lowest = arguments.pop("shape", None), 0.0
            shape = own_shape
            if len(x) > n:
                gap = x[n:].reshape(self.grid.shape)
                lowest = float(gap.min())
                shape = self._surface(gap) if own_shape is None else own_shape + self._surface(gap)
                # A height map has gaps from its highest sample on: the approach counts from there.
                if "approach" in arguments:
                    arguments["approach"] -= lowest
            plan_arguments = {name: arguments.pop(name) for name in PLANNED if name in arguments}
            plan = self.plans.at(tuple(plan_arguments.items()), lambda: Contact(**plan_arguments))
            return Point(names, own_shape, plan.solve(shape, **arguments), lowest)
        except Exception as error:
            at = ", ".join(f"{k} = {v:.6g}" for k, v in zip(names, x[:n], strict=True))
            error.add_note(f"in a differentiable solve, at {at or 'its arguments'}")
            raise

    def _surface(self, gap: Array) -> core.HeightMap:
        """Return the surface with these gaps, but for a constant; two equal rows for a line."""
        grid = self.grid
        heights = np.tile(-gap, (2, 1)) if grid.is_line else -gap
        return core.HeightMap(heights, grid.spacing, grid.center, grid.periodic)

    def _gradients(self, point: Point, names: list[str]) -> dict[str, Gradient]:
        """Return the derivatives of outputs, those that are not known in one go."""
        if fresh := [name for name in names if name not in point.gradients]:
            outputs = [self.outputs[name] for name in fresh]
            derivatives = point.solution.gradient(outputs, list(point.names), shape=point.shape)
            point.tell(*derivatives)
            point.gradients |= dict(zip(fresh, derivatives, strict=True))
        return {name: point.gradients[name] for name in names}


def _row(gradient: Gradient, names: tuple[str, ...], size: int) -> Array:
    """Return derivatives by a vector of `size`: by the numbers at `names`, then by the gap."""
    numbers = [gradient[name] for name in names]
    gap = gradient.gap.ravel() if size > len(numbers) else np.zeros(0)
    return np.concatenate([np.array(numbers, dtype=np.float64), gap])


def _outputs_by_name(outputs: Outputs) -> dict[str, Output]:
    """Return outputs by name; a word is its own name."""
    if isinstance(outputs, Mapping):
        by_name = dict(outputs)
    elif isinstance(outputs, str) or not isinstance(outputs, Sequence):
        raise TypeError(f"outputs must be a list of words or a dict of names, got {outputs!r}")
    else:
        by_name = {word: word for word in outputs if isinstance(word, str)}
        if len(by_name) < len(outputs):
            raise TypeError(
                f"outputs must be different words, or a dict that names the others, "
                f'such as {{"norm": ("pressure_norm", 16.0)}}, got {outputs!r}'
            )
    for name in by_name:
        if not isinstance(name, str):
            raise TypeError(f"names of outputs must be text, got {name!r}")
    return by_name
