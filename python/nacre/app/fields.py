"""Fields of the page's cards: numbers of a case as they are typed, in units of their own."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import reduce
from operator import getitem
from typing import Any, NamedTuple

import numpy as np

from nacre._tools.units import System, number_in, size_of
from nacre.case.reference import UNIT, options, place
from nacre.case.typed import si_unit
from nacre.results.parameters import quantity_of

SCALES: dict[str, Callable[[float], float]] = {
    "1/min": lambda value: value * 2 * math.pi / 60,
    "′": lambda value: math.tan(math.radians(value / 60)),
    "°": math.radians,
}
"""Numbers of a case by those in units that no system has: rad/s, slopes and radians."""
LIMITS = {"stress": ("yield_stress", "strength"), "fatigue": ("shear_yield",)}
"""Limits of materials, which may be empty, by the tables of a case that take them."""

EMPTY = {"required_distance", "required_life", *LIMITS["stress"], *LIMITS["fatigue"]}
"""Keys that may be empty, besides those of bonds."""


class FieldError(ValueError):
    """A value that a field cannot have; `path` names the field."""

    def __init__(self, path: str, message: str) -> None:
        super().__init__(message)
        self.path = path


class Field(NamedTuple):
    """A number of a case, as it is typed."""

    path: str
    """Path of the number in the case."""
    label: str
    """What it is."""
    unit: str = ""
    """Unit in which it is typed."""
    default: float | None = None
    """Number at the start; None of an empty field."""
    low: float = -math.inf
    """Smallest number."""
    high: float = math.inf
    """Largest number."""
    slides: str = ""
    """Slider: "log", "linear", or none."""
    help: str = ""
    """What it is in a sentence, and where to find it."""
    may_be_empty: bool = False
    """Whether the number may be missing."""
    is_count: bool = False
    """Whether it is a whole number."""

    @property
    def size(self) -> float:
        """Size of the unit in SI."""
        return (size_of(self.unit) or ("", 1.0))[1]

    def number(self, typed: object) -> float | None:
        """Return the number that was typed, in the unit of the field; None of an empty one."""
        text = str(typed).strip().replace(",", ".").replace("−", "-")
        if not text and self.may_be_empty:
            return None
        try:
            value = float(text)
        except ValueError:
            value = math.nan
            with suppress(ValueError):
                value = number_in(self.unit, text)
        low, high = (np.format_float_positional(end, trim="-") for end in (self.low, self.high))
        must = f"between {low} and {high}" if math.isfinite(self.high) else "a finite number"
        must = f"{must} {self.unit}".rstrip()
        if math.isfinite(value) and self.low <= value <= self.high:
            if not self.is_count or value == round(value):
                return value
            must = "a whole number"
        raise FieldError(
            self.path, f"{self.label} must be {must}, got {str(typed)[:40] or 'nothing'}"
        )

    def in_case(self, value: float, units: str) -> float:
        """Return a number of the field in the units of a case."""
        if self.is_count:
            return round(value)
        if self.unit in SCALES:
            return SCALES[self.unit](value)
        return tidy(value * self._factor(units))

    def typed(self, entry: Any, units: str) -> float | None:
        """Return an entry of a case, the largest of a list, in the unit of the field."""
        largest = max(entry) if isinstance(entry, list) else entry
        return None if largest is None else tidy(largest / self._factor(units))

    def _factor(self, units: str) -> float:
        """Return the size of the unit in that of a case."""
        dimension, size = size_of(self.unit) or ("", 1.0)
        return size / System(units).unit(dimension)[0]


def tidy(value: float) -> float:
    """Return a number without the rounding of its unit: 0.002 in place of 0.0020000000000000005."""
    return float(f"{value:.12g}")


def keys_of(path: str) -> list[Any]:
    """Return the keys and the numbers in lists along a path."""
    steps = re.findall(r"\[(\d+)\]|([^.\[\]]+)", path)
    return [int(number) if number else key for number, key in steps]


def entry_at(data: Any, path: str) -> Any:
    """Return the entry of a case at a path, or None."""
    try:
        return reduce(getitem, keys_of(path), data)
    except LookupError:
        return None


def field_of(
    data: Mapping[str, Any], path: str, helps: Mapping[str, str] | None = None, **own: Any
) -> Field:
    """Return the field of a number of a case: as the schema has it, but for what is its `own`.

    `helps`, by names of quantities, are in place of the texts of the schema.
    """
    keys, units = keys_of(path), data.get("units", "SI")
    names = [key for key in keys if isinstance(key, str)]
    node = place(data, keys).node
    text = " ".join(str(node.get("description", "")).split())
    quantity = quantity_of(".".join(names))
    one = Field(
        path,
        label=" ".join(map(str, keys[1:])).replace("_", " ") or path,
        unit=System(units).unit(si_unit(data, tuple(keys)))[1],
        help=UNIT.sub("", text) if helps is None else helps.get(quantity, ""),
        may_be_empty=names[-1] in EMPTY or "bond_strength" in names,
        is_count=any(
            "integer" in (option.get("type"), option.get("items", {}).get("type"))
            for option in options(node)
        ),
    )._replace(**own)
    default = one.typed(entry_at(data, path), units)
    return one._replace(**({"default": default} | own))
