"""Keys of the cases of a study, the same in any process and on any day."""

from __future__ import annotations

import hashlib
import json
import types
from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from nacre._core import __version__
from nacre.values import encode


def key_of(
    arguments: Mapping[str, Any], outputs: Mapping[str, Any], stress: Mapping[str, Any]
) -> str:
    """Return a key that differs between cases, and between the outputs that are kept."""
    kept = {name: o if isinstance(o, str) else code_of(o) for name, o in outputs.items()}
    # Threads change no bit of a solution.
    asked = {name: value for name, value in arguments.items() if name != "threads"}
    what = {"nacre": __version__, "solve": encode(asked, digest=True), "outputs": kept}
    if stress:
        what["stress"] = code_of(sorted(stress.items()))
    return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()


def code_of(value: Any, seen: frozenset[int] = frozenset()) -> Any:
    """Return plain data for what a function does: its byte code, and the values that it uses.

    An object of a library is represented by its name.
    """
    if id(value) in seen:
        return "itself"
    seen |= {id(value)}
    if isinstance(value, types.CodeType):
        constants = [code_of(constant, seen) for constant in value.co_consts]
        return [hashlib.sha256(value.co_code).hexdigest(), constants, list(value.co_names)]
    if isinstance(value, types.FunctionType):
        used = [cell.cell_contents for cell in value.__closure__ or ()]
        used += [value.__defaults__, value.__kwdefaults__]
        names = (name for name in value.__code__.co_names if name in value.__globals__)
        mine = {name: value.__globals__[name] for name in names}
        used += [v for v in mine.values() if getattr(v, "__module__", "") == value.__module__]
        used += [v for v in mine.values() if isinstance(v, int | float | str | np.ndarray)]
        return [code_of(value.__code__, seen), [code_of(one, seen) for one in used]]
    if isinstance(value, partial):
        return [code_of(part, seen) for part in (value.func, value.args, value.keywords)]
    if isinstance(value, tuple | list):
        return [code_of(item, seen) for item in value]
    try:
        return encode(value, digest=True)
    except TypeError:
        return [type(value).__qualname__, getattr(value, "__qualname__", None) or repr(value)]
