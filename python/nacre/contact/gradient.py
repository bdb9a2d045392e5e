"""Derivatives of solved contacts: gradients of outputs, and changes along a direction."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import nacre._core as core
from nacre._tools.paths import LAYER, numbered, numbers
from nacre._tools.renamed import warn_of
from nacre._tools.typing import Field, Pair, components
from nacre.results import display
from nacre.results.base import Fields, same

if TYPE_CHECKING:
    from nacre.contact.solution import Solution

Output = str | tuple[str, float] | tuple[str, Pair] | Mapping[str, object]
"""Output of a contact, as `Solution.gradient` names it."""

WORDS: dict[str, object] = {
    "approach": "approach",
    "tilt[0]": {"tilt": 0},
    "tilt[1]": {"tilt": 1},
    "load": "load",
    "moment[0]": {"moment": 0},
    "moment[1]": {"moment": 1},
    "peak_pressure": "located_peak",
    "cell_peak": "cell_peak",
    "participation_area": "participation_area",
    "area_estimate": "area_estimate",
    "contact_area": "contact_area",
    "contact_extent": "contact_extent",
}
"""Outputs that a word names, as the compiled module describes them."""
MEASURES: dict[str, object] = {
    **{name: {"component": k} for k, name in enumerate(("xx", "yy", "zz", "xy", "yz", "xz"))},
    "von_mises": "von_mises",
    **{f"principal[{k}]": {"principal": k} for k in range(3)},
    "max_shear": "max_shear",
    "plane_shear": "plane_shear",
}
"""Measures of a stress."""
PLACES = ("at", "layer", "interface")
STRESS = ("stress", *PLACES, "depths", "sharpness", "side", "body", "friction", "direction")
"""Keys of a stress."""
SHARPNESS, DEPTHS = 200.0, 9
"""Sharpness of soft maxima, and depths in a layer, where none is given: the soft maximum is below
the largest of 1e5 values by at most 6 % of it."""


def described(output: Output) -> tuple[str, object]:
    """Return the name of an output, and the word or dict by which Rust knows it."""
    if isinstance(output, str):
        if output == "located_peak":
            warn_of('"located_peak"', '"peak_pressure"')
            output = "peak_pressure"
        if output in ("resistance", "conductance"):
            raise ValueError(
                f'output must have derivatives, got "{output}": the conductance changes in steps '
                "with the cells in contact; compare `solution.conductance` of two solutions"
            )
        if output not in WORDS:
            raise ValueError(
                f"output must be {_quoted(WORDS)}, a pair such as "
                f'("pressure_norm", 8.0), or a dict of a stress, got "{output}"'
            )
        return output, WORDS[output]
    if isinstance(output, dict):
        return _stress(output)
    value: object
    try:
        word, value = output
    except (TypeError, ValueError):
        raise TypeError(f"output must be a word, a pair or a dict, got {output!r}") from None
    if word == "pressure_norm":
        power = core.real(word, value)
        return f"pressure_norm {power:g}", {word: power}
    if word in ("pressure", "displacement", "gap"):
        place = _numbers(word, value, 2)
        return f"{word} at {_coordinates(place)}", {word: place}
    raise ValueError(
        'output must be ("pressure_norm", r), ("pressure", (x, y)), ("displacement", (x, y)) or '
        f'("gap", (x, y)), got {output!r}'
    )


def _stress(table: Mapping[str, object]) -> tuple[str, object]:
    """Return the name and the description of a stress."""
    for key in table:
        if key not in STRESS:
            raise ValueError(f'keys of a stress are {", ".join(STRESS)}, got "{key}"')
    if "stress" not in table:
        raise ValueError('a stress must have the key "stress"')
    word = table["stress"]
    if not isinstance(word, str) or word not in MEASURES:
        raise ValueError(f'stress must be {_quoted(MEASURES)}, got "{word}"')
    keys = [key for key in PLACES if key in table]
    if len(keys) != 1:
        raise ValueError('a stress must have exactly one of the keys "at", "layer" and "interface"')
    (key,) = keys
    where, side = table[key], table.get("side", "below")
    sharp = {"sharpness": core.real("sharpness", table.get("sharpness", SHARPNESS))}
    place: dict[str, object]
    if key == "at":
        point = _numbers("at", where, 3)
        name, place = f"{word} at {_coordinates(point)}", {"point": [point, side]}
    elif key == "layer":
        number = _count(key, where)
        layer = {"layer": number, "depths": _count("depths", table.get("depths", DEPTHS))}
        name, place = f"{word} in layer {number}", {"layer": layer | sharp}
    else:
        number = _count(key, where)
        interface = {"interface": number, "side": side}
        name, place = f"{word} at interface {number}", {"interface": interface | sharp}
    direction: Any = table.get("direction")
    stress = {
        "member": table.get("body", "body"),
        "measure": MEASURES[word],
        "place": place,
        "friction": core.real("friction", table.get("friction", 0.0)),
        "direction": None if direction is None else _numbers("direction", components(direction), 2),
    }
    return name, {"stress": stress}


def _quoted(words: Mapping[str, object]) -> str:
    return ", ".join(f'"{word}"' for word in words)


def _coordinates(numbers: list[float]) -> str:
    return f"({', '.join(f'{number:g}' for number in numbers)})"


def _count(name: str, value: object) -> int:
    """Return a number of layers, interfaces or depths."""
    number = core.integer(name, value)
    if number < 0:
        raise ValueError(f"{name} must be at least 0, got {number}")
    return number


def _numbers(name: str, values: object, count: int) -> list[float]:
    """Return so many numbers."""
    numbers = core.vector(name, count, values)
    return [core.real(name, number) for number in numbers]


@dataclass(frozen=True)
class MethodCall:
    """The call of a method of `Solution` that makes a value, for pickles."""

    solution: Solution
    method: str
    arguments: tuple[object, ...]
    keywords: dict[str, object]

    def reduced(self) -> tuple[object, tuple[object, ...]]:
        """Return a callable and arguments that make the value again."""
        return operator.methodcaller(self.method, *self.arguments, **self.keywords), (
            self.solution,
        )


@dataclass(frozen=True, repr=False, eq=False)
class Gradient(Fields):
    """Derivatives of one output of a solved contact, by the paths of the parameters.

    It is a mapping: ``gradient["body.layers[0].material.young"]`` is the derivative per unit of
    that parameter. `Solution.gradient` makes it.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    >>> gradient = solution.gradient("approach")
    >>> round(gradient["load"] * 10.0 / gradient.value, 2)  # δ ~ W^(2/3)
    0.67
    >>> list(gradient)[:2]
    ['body.substrate.young', 'body.substrate.poisson']
    """

    output: str
    """Name of the output."""
    value: float
    """Value of the output."""
    _values: dict[str, float]
    """Derivatives by path."""
    margin: float
    """How far the contact is from one of other cells, where derivatives jump.

    It is the smaller of the least pressure in contact over the peak, and of the least gap outside
    over the largest displacement. It falls with the square of the cells and is usually about 1e-5.
    """
    warnings: list[str]
    """What makes the derivatives doubtful: a list of sentences, usually empty."""
    gap: Field
    """Derivative with respect to the undeformed gap of each cell, ``(nx, ny)``.

    Heights count ``-gap``.
    """
    _linear: core.Linear
    """Linearisation of the compiled module, for steps that are asked for later."""
    _call: MethodCall
    """Call that made it."""

    @cached_property
    def valid_step(self) -> dict[str, float]:
        """Largest change of each parameter, of either sign, for which the contact keeps its cells.

        To first order: no pressure, and no gap up to two cells around the contact, changes its
        sign. Each step takes a linear solve when it is first asked for.
        """
        paths = [path for path in self._values if path != "friction"]
        return dict(zip(paths, self._linear.valid_steps(paths), strict=True))

    def keys(self) -> list[str]:
        """Return the paths of the parameters."""
        return list(self._values)

    def values(self) -> list[float]:
        """Return the derivatives, in the order of the paths."""
        return list(self._values.values())

    def items(self) -> list[tuple[str, float]]:
        """Return paths and derivatives."""
        return list(self._values.items())

    def __getitem__(self, path: str) -> float:
        """Return the derivative with respect to a parameter."""
        try:
            return self._values[self._numbered(path)]
        except KeyError:
            raise KeyError(f'"{path}" is none of {", ".join(self._values)}') from None

    def __contains__(self, path: object) -> bool:
        """Return whether there is a derivative with respect to a parameter."""
        return isinstance(path, str) and self._numbered(path) in self._values

    def _numbered(self, path: str) -> str:
        return in_numbers(self._call.solution, [path])[0]

    def __len__(self) -> int:
        """Return the number of parameters."""
        return len(self._values)

    def __iter__(self) -> Iterator[str]:
        """Return an iterator of the paths."""
        return iter(self._values)

    def __eq__(self, other: object) -> bool:
        """Return whether all derivatives are equal, to the bit."""
        if not isinstance(other, Gradient):
            return NotImplemented
        names = ("output", "value", "_values", "margin", "warnings", "gap")
        return all(same(getattr(self, name), getattr(other, name)) for name in names)

    __hash__ = None  # type: ignore[assignment]

    def _repr_html_(self) -> str:
        rows = [(self.output, f"{self.value:.6e}")]
        rows += [(f"by {path}", f"{value:.6e}") for path, value in self.items()]
        return display.markup(rows, self.warnings)

    def __repr__(self) -> str:
        """Return the output with its value and derivatives."""
        items = ", ".join(f"{path}: {value:.6e}" for path, value in self.items())
        return f"Gradient({self.output} = {self.value:.6e}, {{{items}}})"

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        """Return the call that makes the gradient again."""
        return self._call.reduced()


@dataclass(frozen=True, repr=False, eq=False)
class Direction(Fields):
    """Change of a solved contact along a direction of parameters; `Solution.jvp` makes it.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    >>> change = solution.jvp({"load": 1.0})
    >>> round(change.approach * 10.0 / solution.approach, 2)
    0.67
    """

    pressure: Field
    """Change of the pressure ``(nx, ny)``; 0 outside the contact."""
    approach: float
    """Change of the approach."""
    tilt: Pair
    """Change of the tilts."""
    valid_step: float
    """Largest step along the direction for which the contact keeps its cells to first order.

    Steps may have either sign.
    """
    _call: MethodCall
    """Call that made it."""

    def __eq__(self, other: object) -> bool:
        """Return whether all changes are equal, to the bit."""
        if not isinstance(other, Direction):
            return NotImplemented
        names = ("pressure", "approach", "tilt", "valid_step")
        return all(same(getattr(self, name), getattr(other, name)) for name in names)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Return the changes of the motion."""
        return (
            f"Direction(approach={self.approach:.6e}, "
            f"tilt=({self.tilt[0]:.6e}, {self.tilt[1]:.6e}), valid_step={self.valid_step:.3e})"
        )

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        """Return the call that makes the change again."""
        return self._call.reduced()


def gradients(
    solution: Solution,
    method: str,
    outputs: Sequence[object],
    named_outputs: Sequence[tuple[str, object]],
    wrt: Sequence[str] | None,
    shape: core.Shape | None,
    tolerance: float,
) -> list[Gradient]:
    """Return the gradients that a method of the solution makes of outputs, which are told apart.

    Parameters
    ----------
    solution
        Solution.
    method, outputs
        Name of the method, and what it was given.
    named_outputs
        Name of each output, and its description or its weights of the pressures.
    wrt
        Paths of the parameters, or None for all.
    shape
        Shape; None for that of the solution.
    tolerance
        Tolerance.
    """
    linear, keywords = linearisation(solution, shape, tolerance)
    paths = None if wrt is None else differentiable(solution, wrt)
    derivatives = linear.gradients([output for _, output in named_outputs], paths)
    return [
        Gradient(
            name,
            value,
            dict(values),
            margin,
            warnings,
            gap,
            linear,
            MethodCall(solution, method, (output, wrt), keywords),
        )
        for output, (name, _), (value, values, margin, warnings, gap) in zip(
            outputs, named_outputs, derivatives, strict=True
        )
    ]


def in_numbers(solution: Solution, paths: Iterable[str]) -> list[str]:
    """Return paths with the numbers of layers in place of their names."""
    report = solution.report
    return numbered({"body": report.body, "counterbody": report.counterbody}, paths)


def differentiable(solution: Solution, paths: Iterable[str]) -> list[str]:
    """Return paths of numbers in the terms of Rust; those in bodies must be there."""
    found = in_numbers(solution, paths)
    report = solution.report
    known = numbers({"body": report.body, "counterbody": report.counterbody})
    for path in found:
        if isinstance(path, str) and LAYER.match(path) and path not in known:
            raise ValueError(f"{path} has no derivative: the bodies have {', '.join(known)}")
    return found


def linearisation(
    solution: Solution, shape: core.Shape | None, tolerance: float
) -> tuple[core.Linear, dict[str, object]]:
    """Return the linearisation of a solution, and its options with the shape that is known."""
    shape = solution._shape if shape is None else shape
    linear = core.Linear(solution._solved, shape, tolerance)
    return linear, {"shape": shape, "tolerance": tolerance}
