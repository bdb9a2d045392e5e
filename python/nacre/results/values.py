"""Values of nacre as plain data, exactly: for files, and to tell one case from another.

A material, layer, body, grid, profile or shape becomes its constructor call:
``{"Sphere": {"radius": 0.005}}``; so do tips and adhesion, ``{"Tip.cone": {"slope": 0.3}}``.
Numbers keep every bit. A result, such as a solution, becomes the
dictionary that its `to_dict` returns.
"""

from __future__ import annotations

import functools
import hashlib
import inspect
import operator
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from typing import Any

import numpy as np

import nacre._core as core

FORMAT = 1
"""Number of the format in which states are written."""

FIELDS: dict[type, tuple[str, ...]] = {
    kind: tuple(inspect.signature(kind).parameters)
    for kind in vars(core).values()
    if isinstance(kind, type)
    and kind is not core.Shape
    and issubclass(
        kind,
        core.Elastic
        | core.Spring
        | core.Layer
        | core.HalfSpace
        | core.LogarithmicProfile
        | core.SampledProfile
        | core.Shape,
    )
}
"""Arguments of each class's constructor, which are attributes of the same names."""
CONSTRUCTORS: dict[str, Callable[..., object]] = {
    f"{kind.__name__}.{name}": getattr(kind, name)
    for kind in (core.Tip, core.Adhesion)
    for name, member in vars(kind).items()
    if isinstance(member, staticmethod) and not name.startswith("_")
}
"""Static methods that make tips and adhesion, by their names in data."""


def _stored(make: Callable[..., object]) -> tuple[str, ...]:
    """Return the names of the arguments that are stored: a half angle is stored as its slope."""
    return tuple(name for name in inspect.signature(make).parameters if name != "half_angle")


CALLS: dict[str, tuple[Callable[..., object], tuple[str, ...]]] = {
    **{kind.__name__: (kind, fields) for kind, fields in FIELDS.items()},
    **{name: (make, _stored(make)) for name, make in CONSTRUCTORS.items()},
    **{
        name: (make, _stored(make))
        for name, make in (
            ("Response", core.Response._of),
            ("Grid.line", core.Grid.line),
            ("Grid", core.Grid),
        )
    },
}
"""Callables by their names in data, each with its arguments."""
LATER = {
    "name",
    "apex",
    "counter_radius",
    "counter_radius_x",
    "counter_radius_y",
    "ends",
    "periodic",
    "corners",
    "smoothing",
}
"""Arguments that format 1 had not at first. Where they say nothing they are left out: older data
are still read, and older studies found again. Versions that do not know them refuse them by
name."""
ABSENT = (None, (None, None), (False, False))
"""Values of those arguments that say nothing; the second one is of ends."""
LATE = ("nacre.types", "nacre.indent", "nacre.rough", "nacre.bearing", "nacre.design")
"""Modules with results that ``import nacre`` does not import."""
RESULTS: dict[str, Any] = {}
"""Classes of results by their names."""
START = ("traction", "displacement", "friction", "motion")
"""Fields of a contact with friction on which a history depends that goes on from it."""


def encode(value: object, *, digest: bool = False) -> Any:
    """Return plain data (numbers, text, lists, dictionaries) that stands for `value`.

    With `digest`, an array is replaced by its shape and SHA-256, and a solution by its pressure or
    what a history needs to go on, which is enough to compare. A value that is neither one of
    nacre's nor plain is a `TypeError`.
    """

    def of(value: Any) -> object:
        if value is None or isinstance(value, bool | str):
            return value
        if isinstance(value, int | np.integer):
            return int(value)
        if isinstance(value, float | np.floating):
            return float(value)
        if type(value) is RESULTS.get("History"):
            return of(value.to_dict())
        if isinstance(value, tuple | list):
            return [of(item) for item in value]
        if isinstance(value, Mapping):
            return {str(key): of(item) for key, item in value.items()}
        if isinstance(value, np.ndarray):
            if not digest:
                return value.tolist()
            array = np.ascontiguousarray(value, dtype=np.float64)
            return {"array": [list(array.shape), hashlib.sha256(array.tobytes()).hexdigest()]}
        if isinstance(value, core.Rigid):
            return "rigid"
        if isinstance(value, core.Free):
            return "free"
        if digest and type(value) is RESULTS.get("Solution"):
            return {"Solution": of(value.pressure)}
        if digest and type(value) is RESULTS.get("FrictionSolution"):
            state, normal = value.to_dict(), value.normal
            start = {name: of(state[name]) for name in START}
            start |= {"pressure": of(normal.pressure), "pressed": of(normal.report.motion)}
            return {"FrictionSolution": start}
        if RESULTS.get(type(value).__name__) is type(value):
            return of(value.to_dict())
        if isinstance(value, core.Response):
            return {"Response": {"values": of(value.values), "local": value.local}}
        if hasattr(value, "_arguments"):
            return as_call(value, value._arguments())
        raise TypeError(f"a {type(value).__name__} is not a value that can be kept: {value!r}")

    def as_call(value: Any, arguments: dict[str, Any]) -> dict[str, object]:
        if "parts" in arguments:
            return {"sum": of(arguments["parts"])}
        if "." in arguments:
            return {"shifted": [of(arguments["."]), *arguments["shift"]]}
        name, make = type(value).__name__, value.__reduce__()[0]
        maker = getattr(make, "func", make).__name__
        # JSON has no infinite radii, and a shape takes None for one.
        shown = {
            k: None if isinstance(v, float) and np.isinf(v) else v for k, v in arguments.items()
        }
        fields = {k: of(v) for k, v in shown.items() if not (k in LATER and v in ABSENT)}
        return {name if maker == name or maker.startswith("_") else f"{name}.{maker}": fields}

    return of(value)


def heading(kind: str) -> dict[str, object]:
    """Return the head of the plain data of a result: format, version and kind."""
    return {"format": FORMAT, "nacre": core.__version__, "kind": kind}


def checked_state(
    data: Mapping[str, object], kind: str, names: Collection[str], later: Collection[str] = ()
) -> dict[str, Any]:
    """Return the fields of a result's plain data, which must be of this kind and have these names.

    Those of `later` may be missing, and are None then. Raises `ValueError` where the data are
    otherwise, or the format is unknown.
    """
    if not isinstance(data, Mapping):
        raise ValueError(f"{kind} must be a dict of named fields, got {data!r}")
    state = dict(data)
    for key in ("format", "nacre", "kind"):
        if key not in state:
            raise ValueError(f'{kind}: the key "{key}" is missing')
    check_format(state.pop("format"), writer := state.pop("nacre"), f"this {kind}")
    if not isinstance(writer, str):
        raise ValueError(f'the key "nacre" must hold a version, got {writer!r}')
    if (stored_kind := state.pop("kind")) != kind:
        raise ValueError(f'the key "kind" must be "{kind}", got "{stored_kind}"')
    return with_names(kind, state, names, later)


def with_names(
    place: str, data: Mapping[str, object], names: Collection[str], later: Collection[str] = ()
) -> dict[str, object]:
    """Return data with these names and no others; those of `later` may be missing, and are None."""
    state = dict.fromkeys(later) | dict(data)
    for key in names:
        if key not in state:
            raise ValueError(f'{place}: the key "{key}" is missing')
    for key in state:
        if key not in names:
            raise ValueError(f"{place}: the key {key!r} is unknown")
    return state


def check_format(number: object, writer: object, what: str) -> None:
    """Raise a `ValueError` if `what` has a format that this version does not know."""
    if type(number) is not int or not 1 <= number <= FORMAT:
        raise ValueError(
            f"{what} has format {number}, written by nacre {writer}; nacre {core.__version__} "
            f"reads formats from 1 to {FORMAT}: another version may read it"
        )


@contextmanager
def refusing(kind: str) -> Iterator[None]:
    """Make a `ValueError` of the errors that data raise which do not describe a value of a kind."""
    try:
        yield
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError) as error:
        reason = f"{type(error).__name__}: {error}"
        raise ValueError(f"the data do not describe a {kind}: {reason}") from error


def decode(data: object) -> Any:
    """Return the value that `encode` made into `data`; lists become tuples.

    Raises `ValueError` where a key is missing or unknown, or holds a value that does not fit.
    """
    try:
        return _decoded(data)
    except RecursionError as error:
        raise ValueError("the data must not be nested this deeply") from error


def _decoded(data: object) -> Any:
    if isinstance(data, list):
        return tuple(_decoded(item) for item in data)
    if data == "rigid":
        return core.RIGID
    if data == "free":
        return core.FREE
    if not isinstance(data, dict):
        return data
    if {"format", "nacre", "kind"} <= data.keys():
        return result_class(data["kind"]).from_dict(data)
    if len(data) == 1:
        ((name, content),) = data.items()
        if name == "sum":
            return functools.reduce(operator.add, _sum(content))
        if name == "shifted":
            shape, x, y = _shifted(content)
            try:
                return shape.shifted(x, y)
            except TypeError as error:
                raise ValueError(f"{name}: {error}") from error
        if name in CALLS:
            return _construct(name, *CALLS[name], content)
    return {key: _decoded(item) for key, item in data.items()}


def result_class(kind: object) -> Any:
    """Return the class of results of this name; that of some may have to be imported."""
    if isinstance(kind, str) and kind not in RESULTS:
        for module in LATE:
            import_module(module)
    if not isinstance(kind, str) or kind not in RESULTS:
        raise ValueError(f"the key 'kind' must name a result of nacre, got {kind!r}")
    return RESULTS[kind]


def _construct(
    name: str, make: Callable[..., object], expected: tuple[str, ...], content: object
) -> object:
    """Call `make` with named arguments, all of them and no others."""
    if not isinstance(content, dict):
        raise ValueError(f"{name} must be a dict of named fields, got {content!r}")
    for key in expected:
        if key not in content and key not in LATER:
            raise ValueError(f"{name}: the key {key!r} is missing")
    for key in content:
        if key not in expected:
            raise ValueError(f"{name}: the key {key!r} is unknown")
    try:
        return make(**_decoded(content))
    except (TypeError, OverflowError) as error:
        raise ValueError(f"{name}: {error}") from error


def _sum(content: object) -> tuple[core.Shape, ...]:
    """Return the shapes of a sum, one at least."""
    if not isinstance(content, list) or not content:
        raise ValueError(f"sum must be a list of one shape or more, got {content!r}")
    shapes: tuple[core.Shape, ...] = _decoded(content)
    for shape in shapes:
        if not isinstance(shape, core.Shape):
            raise ValueError(f"sum must hold shapes, got {shape!r}")
    return shapes


def _shifted(content: object) -> tuple[core.Shape, float, float]:
    """Return a shape and its shifts along x and y."""
    if not isinstance(content, list) or len(content) != 3:
        raise ValueError(f"shifted must be a list of a shape and two numbers, got {content!r}")
    shape, x, y = _decoded(content)
    if not isinstance(shape, core.Shape):
        raise ValueError(f"shifted must hold a shape, got {shape!r}")
    return shape, x, y
