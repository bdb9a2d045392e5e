"""Keys of the cases of a study, the same in any process and on any day.

An output function is identified by its source text, the values of its defaults and its closure, and
the object that it is bound to. What it reaches in other ways is not seen; `version=` is for that.
"""

from __future__ import annotations

import functools
import hashlib
import inspect
import json
import pickle
import types
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from nacre._core import __version__
from nacre.results.values import encode


class Identity(NamedTuple):
    """Identity of the outputs of a study."""

    data: dict[str, object]
    """Plain data that differs between outputs."""
    unknown: list[str]
    """Descriptions of what the data cannot tell apart."""


def identity_of(
    outputs: Mapping[str, object],
    options: Mapping[str, Mapping[str, object]],
    version: str | int | None = None,
) -> Identity:
    """Return the identity of outputs, of their options by name, and of a version."""
    unknown: list[str] = []
    output_parts = {
        name: output if isinstance(output, str) else _plain(output, name, unknown)
        for name, output in outputs.items()
    }
    data: dict[str, object] = {"outputs": output_parts}
    for name, keywords in options.items():
        if keywords:
            data[name] = _plain(dict(keywords), name, unknown)
    if version is not None:
        data["version"] = version
    return Identity(data, unknown)


def key_of(arguments: Mapping[str, object], identity: Identity) -> str:
    """Return a key that differs between cases, and between the outputs that are kept."""
    # Threads change no bit of a solution.
    physical = {name: value for name, value in arguments.items() if name != "threads"}
    what = {"nacre": __version__, "solve": encode(physical, digest=True), **identity.data}
    return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()


def _plain(
    value: object, place: str, unknown: list[str], inside: tuple[object, ...] = ()
) -> object:
    """Return plain data for a function or a value, which `place` names; add to `unknown`."""
    if any(value is outer for outer in inside):
        return "recursion"

    def of(item: object, name: str = "") -> object:
        return _plain(item, place + name, unknown, (*inside, value))

    if isinstance(value, list | tuple):
        return [of(item, f"[{k}]") for k, item in enumerate(value)]
    if isinstance(value, dict):
        return [[of(key), of(item, f"[{key!r:.40}]")] for key, item in value.items()]
    if isinstance(value, set | frozenset):  # whose order differs between processes
        return sorted(json.dumps(of(item)) for item in value)
    if isinstance(value, functools.partial):
        return [of(value.func), of(value.args), of(value.keywords)]
    if isinstance(value, types.MethodType):
        return [of(value.__func__), of(value.__self__)]
    if isinstance(value, types.FunctionType):
        closure = zip(value.__code__.co_freevars, value.__closure__ or (), strict=True)
        cells = [
            of(cell.cell_contents, f".{name}")
            for name, cell in closure
            if cell != types.CellType()  # empty
        ]
        source = _source(value.__code__, place, unknown)
        return [source, of(value.__defaults__), of(value.__kwdefaults__), cells]
    if hasattr(value, "__wrapped__"):  # by `functools.cache` and others
        return of(value.__wrapped__)
    if not isinstance(value, np.ndarray):
        try:
            return encode(value, digest=True)
        except TypeError:
            pass  # neither plain nor nacre's
    try:
        content = hashlib.sha256(pickle.dumps(value, protocol=5)).hexdigest()
    except Exception:  # whatever its class raises
        unknown.append(f"{place} (a {type(value).__qualname__})")
        return None
    called = getattr(type(value), "__call__", None)  # noqa: B004  of an object that is an output
    return [content, of(called) if isinstance(called, types.FunctionType) else None]


def _source(code: types.CodeType, place: str, unknown: list[str]) -> str | None:
    """Return the text of a function."""
    try:
        return inspect.getsource(code)
    except (OSError, TypeError):
        unknown.append(f"{place} (has no source text)")
        return None
