"""Parameters of an optimisation: what SciPy varies."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import nacre._core as core

Bounds = Mapping[str, tuple[float | None, float | None]]

REACH = 0.25
"""Change of a logarithm, or share of a width, that counts as a step of one."""
FARTHEST = math.log(100.0)
"""Largest change of a logarithm without a bound: a line search that is lost stays near numbers."""


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
    for name, first in start.items():
        value = core.real(f"start[{name!r}]", first)
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
