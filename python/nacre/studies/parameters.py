"""Parameters of an optimisation: what SciPy varies, and the numbers that paths name."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import nacre._core as core
from nacre.results import values as plain

Bounds = Mapping[str, tuple[float | None, float | None]]

REACH = 0.25
"""Change of a logarithm, or share of a width, that counts as a step of one."""
FARTHEST = math.log(100.0)
"""Largest change of a logarithm without a bound: a line search that is lost stays near numbers."""
MOTIONS = ("eccentricity", "moment", "tilt")
SHIFTS = ("shift[0]", "shift[1]")
KEY = re.compile(r"shift\[[01]\]|\w+")
PATH = re.compile(r"\w+(?:\[\d+\])?(?:\.\w+(?:\[\d+\])?)*")


@dataclass(frozen=True)
class Scale:
    """Parameter, as the number of steps from 0 (of its logarithm from 1) that SciPy varies."""

    name: str
    log: bool
    width: float
    bounds: tuple[float | None, float | None]
    low: float | None = None
    high: float | None = None

    def x(self, value: float) -> float:
        """Return the optimiser's variable at a value."""
        return math.log(value) / REACH if self.log else value / self.width

    def value(self, x: float) -> float:
        """Return the value at the optimiser's variable."""
        return math.exp(REACH * x) if self.log else self.width * x

    def rounded(self, x: float) -> float:
        """Return a value of fifteen digits, so that a start is itself again, and in the bounds."""
        value = float(f"{self.value(x):.15g}")
        ends = [b for b in self.bounds if b is not None and math.isclose(b, value, rel_tol=1e-14)]
        return ends[0] if ends else value


def scales_of(start: Mapping[str, float], bounds: Bounds) -> list[Scale]:
    """Return the scale of each parameter, from its start and its bounds."""
    if not isinstance(start, Mapping) or not start:
        raise TypeError(f"start must be a mapping of one parameter or more, got {start!r}")
    if unknown := set(bounds) - set(start):
        raise ValueError(f"bounds must be of parameters in start, got {sorted(unknown)}")
    scales = []
    for name, value in start.items():
        low, high = bounds.get(name, (None, None))
        low, high = (None if b is None or math.isinf(b) else float(b) for b in (low, high))
        if not math.isfinite(value):
            raise ValueError(f"start[{name!r}] must be finite, got {value!r}")
        if (low is not None and value < low) or (high is not None and value > high):
            raise ValueError(f"start[{name!r}] must be in its bounds {low, high}, got {value!r}")
        if low is not None and low == high:
            raise ValueError(f"bounds[{name!r}] must differ, got {low, high}")
        log = value > 0 and (low is None or low > 0)
        width = REACH * (high - low) if low is not None and high is not None else abs(value) * REACH
        if not log and width == 0:
            raise ValueError(f"bounds[{name!r}] must be two numbers where the start is 0")
        scale = Scale(name, log, width, (low, high))
        ends = [None if b is None else scale.x(b) for b in (low, high)]
        if log:
            x, far = scale.x(value), FARTHEST / REACH
            ends = [x + s * far if e is None else e for s, e in zip((-1, 1), ends, strict=True)]
        scales.append(replace(scale, low=ends[0], high=ends[1]))
    return scales


def numbers(made: Mapping[str, Any]) -> dict[str, float]:
    """Return the numbers of a solve by path, but for those of the shape."""
    found: dict[str, float] = {}
    for side in ("body", "counterbody"):
        body = made.get(side)
        layers = body.layers if isinstance(body, core.HalfSpace) else ()
        base = body.substrate if isinstance(body, core.HalfSpace) else body
        materials = {f"{side}.substrate": base}
        for k, layer in enumerate(layers):
            found[f"{side}.layers[{k}].thickness"] = layer.thickness
            materials[f"{side}.layers[{k}].material"] = layer.material
        for path, material in materials.items():
            if isinstance(material, core.Elastic):
                found |= {f"{path}.young": material.young, f"{path}.poisson": material.poisson}
    found |= {name: made[name] for name in ("load", "approach") if made.get(name) is not None}
    for name in MOTIONS:
        for k, value in enumerate(made.get(name) or ()):
            if value is not None:
                found[f"{name}[{k}]"] = value
    return found


def put(
    made: dict[str, Any], path: str, value: float, *, names: str = "start", of: str = "build"
) -> None:
    """Replace the number at a path of the arguments of a solve.

    Errors say that `names`, which gave the path, must name parameters of the arguments, `of`.
    """
    data, holder, index = _sought(made, path, names, of)
    holder[index] = value
    made |= {root: plain.decode(one) for root, one in data.items()}


def number(made: Mapping[str, Any], path: str, *, names: str, of: str) -> float:
    """Return the number at a path of the arguments of a solve, with the errors of `put`."""
    _, holder, index = _sought(made, path, names, of)
    return float(holder[index])


def _sought(made: Mapping[str, Any], path: str, names: str, of: str) -> tuple[Any, Any, Any]:
    """Return an argument as plain data, what holds the number at a path, and its index there."""
    keys = KEY.findall(path)
    if not PATH.fullmatch(path) or keys[0] not in made:
        raise ValueError(f"{names} must name parameters of {of} by path, got {path!r}")
    root = made[keys[0]]
    if keys[0] in ("body", "counterbody") and isinstance(root, core.Elastic):
        root = core.HalfSpace(root)
    data: Any = {keys[0]: plain.encode(root)}
    holder, index = data, keys[0]
    for key in keys[1:]:
        slot = _slot(holder[index], key)
        if slot is None:
            raise ValueError(
                f"{names} must name parameters of {of} by path, got {path!r}: no {key}"
            )
        holder, index = slot
    if not isinstance(holder[index], int | float):
        raise ValueError(f"{names} must name numbers of {of}, got {path!r}")
    return data, holder, index


def _slot(place: Any, key: str) -> tuple[Any, Any] | None:
    """Return what holds the value at a key of plain data, and its index there."""
    if isinstance(place, dict) and len(place) == 1:
        ((kind, content),) = place.items()
        if kind == "shifted":
            shift = key in SHIFTS
            return (content, 1 + SHIFTS.index(key)) if shift else _slot(content[0], key)
        if kind == "sum" and key == "parts":
            return place, kind
        if kind in plain.CALLS:
            place = content
    if isinstance(place, dict) and key in place:
        return place, key
    if isinstance(place, list) and key.isdecimal() and int(key) < len(place):
        return place, int(key)
    return None
