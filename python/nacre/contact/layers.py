"""Numbers of the layers of a body, by number or name."""

from __future__ import annotations

from typing import Any

import numpy as np

import nacre._core as core
from nacre._tools.paths import by_layer
from nacre.results import display


def layer_names(body: object) -> list[str]:
    """Return numbers and names of the layers of a body."""
    layers = body.layers if isinstance(body, core.HalfSpace) else ()
    return [display.layer_name(number, layer.name) for number, layer in enumerate(layers)]


def layer_numbers(name: str, given: Any, body: Any, what: str) -> list[float]:
    """Return a number of each layer of a body and of its substrate, or one for all."""
    if isinstance(given, int | float | np.number) and not isinstance(given, bool):
        return [core.real(name, given)]
    if not isinstance(body, core.HalfSpace):
        raise ValueError(f"{name} must be a number for a body without layers, got {given!r}")
    values: Any = core.layer_values(body, name, by_layer(given))
    count = len(body.layers) + 1
    values = [*values, *[None] * (count - len(values))]
    names = [*layer_names(body), "substrate"]
    elastic = not isinstance(body.substrate, core.Rigid | core.Free)
    missing = [layer for layer, value in zip(names, values, strict=True) if value is None]
    if what == "rate" and not elastic and missing == ["substrate"]:
        values[-1], missing = 0.0, []
    if missing:
        raise ValueError(f"{name} must hold a {what} for {', '.join(missing)}, got {given!r}")
    return [float(value) for value in values]
