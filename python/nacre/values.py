"""Values of nacre as plain data, exactly: for files, and to tell one case from another.

A value becomes its constructor call: ``{"Sphere": {"radius": 0.005}}``. Numbers
keep every bit.
"""

from __future__ import annotations

import hashlib
import operator
from collections.abc import Mapping
from typing import Any

import numpy as np

import nacre._core as core

FIELDS: dict[type, tuple[str, ...]] = {
    core.Elastic: ("young", "poisson"),
    core.Layer: ("material", "thickness", "interface"),
    core.HalfSpace: ("substrate", "layers"),
    core.LogarithmicProfile: ("amplitude", "length", "flat_length", "end_factor"),
    core.SampledProfile: ("x", "drop"),
    core.Sphere: ("radius",),
    core.Paraboloid: ("radius_x", "radius_y"),
    core.Cylinder: ("radius",),
    core.Roller: ("radius", "flat_length", "crown_radius", "length", "profile"),
    core.FlatPunch: ("radius",),
    core.HeightMap: ("heights", "spacing", "center"),
}


def encode(value: Any, *, digest: bool = False) -> Any:
    """Return plain data (numbers, text, lists, dictionaries) that stands for `value`.

    With `digest`, arrays are stood for by their shape and SHA-256, which is enough to compare.
    Raises `TypeError` where a value is none of nacre's, nor plain.
    """

    def of(value: Any) -> Any:
        if value is None or isinstance(value, bool | str):
            return value
        if isinstance(value, int | np.integer):
            return int(value)
        if isinstance(value, float | np.floating):
            return float(value)
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
        if isinstance(value, core.Grid):
            if value.is_line:
                center = value.center[1]
                return {
                    "Grid.line": {"cells": value.shape[1], "width": value.size[1], "center": center}
                }
            return {
                "Grid": {
                    "shape": of(value.shape),
                    "size": of(value.size),
                    "center": of(value.center),
                }
            }
        if isinstance(value, core.Solution):
            return {"Solution": of(value.pressure)}
        if type(value) in FIELDS:
            fields = {name: of(getattr(value, name)) for name in FIELDS[type(value)]}
            return {type(value).__name__: fields}
        if isinstance(value, core.Shape):
            make, arguments = reduced(value)
            if make is operator.add:
                return {"sum": of(arguments)}
            return {"shifted": [of(arguments[0]), *of(reduced(make)[1][1:])]}
        raise TypeError(f"a {type(value).__name__} is not a value that can be kept: {value!r}")

    return of(value)


def reduced(value: Any) -> tuple[Any, Any]:
    """Return how to make a value: a callable and its arguments."""
    make, arguments, *_ = value.__reduce__()
    return make, arguments


def decode(data: Any) -> Any:
    """Return the value that `encode` made into `data`; lists become tuples."""
    if isinstance(data, list):
        return tuple(decode(item) for item in data)
    if data == "rigid":
        return core.RIGID
    if not isinstance(data, dict):
        return data
    if len(data) == 1:
        ((name, content),) = data.items()
        if name == "Grid.line":
            return core.Grid.line(**content)
        if name == "sum":
            first, second = decode(content)
            return first + second
        if name == "shifted":
            shape, x, y = decode(content)
            return shape.shifted(x, y)
        if name == "Grid" or name in {kind.__name__ for kind in FIELDS}:
            return getattr(core, name)(**decode(content))
    return {key: decode(item) for key, item in data.items()}
