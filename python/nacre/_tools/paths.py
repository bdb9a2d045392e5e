"""Numbers in the arguments of a call, by path: ``body.layers[0].material.young``.

A layer has its number or its name in a path, in brackets or after a point.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

import nacre._core as core

BODIES = ("body", "counterbody")
DIFFERENTIABLE = (*BODIES, "load", "approach", "eccentricity", "moment", "tilt")
"""Arguments of a solve, beside the shape, that have derivatives."""
LAYER = re.compile(r"(?:(body|counterbody)\.)?layers[.\[]([^.\[\]]+)\]?")
"""Start of a path that leads into a layer."""


def numbers(arguments: Mapping[str, object]) -> dict[str, float]:
    """Return all numbers of arguments by path."""
    return dict(core.numbers(with_half_spaces(arguments)))


def put(
    arguments: dict[str, object],
    path: str,
    value: float,
    *,
    names: str = "start",
    of: str = "build",
) -> None:
    """Replace the number at a path of arguments, with the errors of `holder`."""
    arguments |= core.with_value(holder(arguments, path, names, of), path, value)


def holder(arguments: Mapping[str, object], path: str, names: str, of: str) -> dict[str, object]:
    """Return the argument that holds the number at a path, by name.

    Errors say that `names`, which gave the path, must name parameters of the arguments, `of`.
    """
    name = re.split(r"[.\[]", path)[0]
    message = f"{names} must name parameters of {of} by path, got {path!r}"
    if name not in arguments:
        raise ValueError(message)
    argument = with_half_spaces({name: arguments[name]})
    try:
        number = core.at(argument, path)
    except LookupError as missing:
        raise ValueError(f"{message}: no {missing}") from None
    if not isinstance(number, int | float | np.number):
        raise ValueError(f"{names} must name numbers of {of}, got {path!r}")
    return argument


def with_half_spaces(arguments: Mapping[str, object]) -> dict[str, object]:
    """Return arguments as paths name their numbers: the material of a body is its substrate."""
    return {
        name: core.HalfSpace(value) if name in BODIES and isinstance(value, core.Elastic) else value
        for name, value in arguments.items()
    }


def numbered(arguments: Mapping[str, object], paths: Iterable[str]) -> list[str]:
    """Return paths with the numbers of layers in place of names that one layer of a body has."""

    def in_numbers(path: str) -> str:
        match = LAYER.match(path) if isinstance(path, str) else None
        if match is None or match[1] is None:
            return path
        layers: Any = getattr(arguments.get(match[1]), "layers", ())
        places = [k for k, layer in enumerate(layers) if match[2] in (str(k), layer.name)]
        start = f"{match[1]}.layers[{places[0]}]" if len(places) == 1 else match[0]
        return start + path[match.end() :]

    return [in_numbers(path) for path in paths]


def by_layer(values: Any) -> Any:
    """Return values by layer, with numbers and names in place of paths, ``layers[0]``."""

    def layer(key: object) -> object:
        match = LAYER.fullmatch(key) if isinstance(key, str) else None
        if match is None:
            return key
        return int(match[2]) if match[2].isdecimal() else match[2]

    return {layer(k): v for k, v in values.items()} if isinstance(values, Mapping) else values
