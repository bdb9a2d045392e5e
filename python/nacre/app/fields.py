"""Fields of the page's cards: numbers of a case as they are typed, in units of their own."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import reduce
from itertools import pairwise
from operator import getitem
from typing import Any, NamedTuple

import numpy as np

from nacre._tools.units import System, number_in
from nacre.case.reference import UNIT, options, place
from nacre.case.typed import si_unit
from nacre.results.parameters import BY_LAYER, quantity_of

SLOPE = "′"
"""Unit of tilts, which are slopes in a case: the tangents of angles."""
LIMITS = {"stress": ("yield_stress", "strength"), "fatigue": ("shear_yield",)}
"""Limits of materials, which may be empty, by the tables of a case that take them."""

EMPTY = {"required_distance", "required_life", "required_resistance", "static_safety"}
EMPTY |= {key for keys in LIMITS.values() for key in keys}
"""Keys that may be empty, besides those of bonds."""


RINGS = ("osculation", "raceway_diameters")
"""Pairs of numbers of the inner and the outer ring; others are along x and y."""
PARTS = {"layers": "layer", "steps": "step", "criteria": "criterion"}
"""Words for the members of lists."""


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
    si: str = ""
    """SI unit of the number."""
    default: float | str | None = None
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
    choices: Sequence[str] = ()
    """Words, of which one is chosen in place of a number."""

    @property
    def size(self) -> float:
        """Size of the unit in SI."""
        return self._in(self.si)

    def number(self, typed: object) -> float | str | None:
        """Return the number that was typed, in the unit of the field; None of an empty one."""
        if self.choices:
            if typed in self.choices:
                return str(typed)
            words = ", ".join(self.choices)
            raise FieldError(self.path, f"{self.label} must be one of {words}, got {typed!s:.40}")
        text = str(typed).strip().replace(",", ".").replace("−", "-")
        if not text and self.may_be_empty:
            return None
        try:
            value = float(text.removesuffix("°C"))
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

    def in_case(self, value: float | str, units: str) -> float | str:
        """Return a number of the field in the units of a case."""
        if isinstance(value, str):
            return value
        if self.is_count:
            return round(value)
        if self.unit == SLOPE:
            return math.tan(math.radians(value / 60))
        return tidy(value * self._in(System(units).unit(self.si)[1]))

    def typed(self, entry: Any, units: str) -> float | str | None:
        """Return an entry of a case, the largest of a list, in the unit of the field."""
        largest = max(entry) if isinstance(entry, list) else entry
        if largest is None or isinstance(largest, str):
            return largest
        return tidy(largest / self._in(System(units).unit(self.si)[1]))

    def _in(self, unit: str) -> float:
        """Return the size of the unit of the field in another one of its kind."""
        if self.unit in (unit, "°C"):  # a case has temperatures in °C
            return 1.0
        return number_in(unit, f"1 {self.unit}")


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
    data: Mapping[str, Any],
    path: str,
    texts: Mapping[str, Any] | None = None,
    has_units: bool = True,
    **own: Any,
) -> Field:
    """Return the field of a number of a case: as the schema has it, but for what is its `own`.

    `texts` are labels, units and helps by names of quantities, in place of those of the schema.
    """
    texts = {"labels": {}, "units": {}, "help": {}, **(texts or {})}
    keys, units = keys_of(path), data.get("units", "SI")
    names = [key for key in keys if isinstance(key, str)]
    node = place(data, keys).node
    text = " ".join(str(node.get("description", "")).split())
    quantity, si = quantity_of(".".join(names)), si_unit(data, tuple(keys))
    kinds = [kind for option in options(node) for kind in (option, option.get("items", {}))]
    one = Field(
        path,
        label=label_of(keys, quantity, texts["labels"]),
        unit=System(units).unit(si)[1],
        si=si,
        help=texts["help"].get(quantity, UNIT.sub("", text)),
        may_be_empty=names[-1] in EMPTY or "bond_strength" in names,
        is_count=any(kind.get("type") == "integer" for kind in kinds),
        choices=next((kind["enum"] for kind in kinds if "enum" in kind), ()),
    )
    shown = [unit for dimension, unit in texts.get("shown", {}).items() if dimension == si]
    for unit in texts["units"].get(quantity, shown) if has_units else ():
        with suppress(ValueError):
            number_in(si, f"1 {unit}")
            one = one._replace(unit=unit)
            break
    one = one._replace(**own)
    default = one.typed(entry_at(data, path), units)
    return one._replace(**({"default": default} | own))


def label_of(keys: Sequence[Any], quantity: str, labels: Mapping[str, str]) -> str:
    """Return the label of a number: its quantity, its direction and what it belongs to.

    >>> label_of(["bearing", "solve", "tilt", "y"], "tilt", {})
    'tilt about y'
    >>> label_of(["materials", "steel", "poisson"], "poisson", {"poisson": "Poisson's ratio"})
    "Poisson's ratio of steel"
    """
    words, last = [labels.get(quantity, quantity.replace("_", " "))], keys[-1]
    if isinstance(last, int):
        words.append(("inner ring", "outer ring")[last] if quantity in RINGS else "")
        words[-1] = words[-1] or (f"along {'xy'[last]}" if last < 2 else f"{last + 1}")
    elif last in ("x", "y", "z"):
        words.append(f"{'about' if quantity in ('moment', 'tilt') else 'along'} {last}")
    elif last != quantity:
        words.append(f"of {last}" if quantity in BY_LAYER else str(last).replace("_", " "))
    if keys[0] == "materials":
        words.append(f"of {keys[1]}")
    words += [f"of the {key} bearing" for key in keys if key in ("first", "second")]
    members = pairwise(keys)
    words += [f"of {PARTS[key]} {item + 1}" for key, item in members if key in PARTS]
    return " ".join(words)
