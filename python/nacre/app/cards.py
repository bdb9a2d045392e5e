"""Cards of the page: cases to start from, and the case that the values of fields make."""

from __future__ import annotations

import functools
import math
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

import nacre._core as core
from nacre._tools.typing import AnyPath
from nacre._tools.units import System
from nacre.app.answer import NONE, Measured
from nacre.app.fields import CARDS, Field, tidy
from nacre.case import Case, CaseError, templates
from nacre.case.bearing import UNITS
from nacre.case.reference import place
from nacre.case.results import files_of
from nacre.results.quantities import BY_LAYER, INPUTS

Data = dict[str, Any]

CHANGES: dict[str, Data] = {
    "bearing": {"bearing": {"raceway_diameters": None, "solve": {"cells": [80, 32]}}},
    "contact": {"solve": {"max_cells": 65536}},
    "roller": {"solve": {"max_cells": 65536}, "stress": {}},
    "line": {"grid": {"cells": 1024}},
    "cone": {"indent": {"approach": None}},
}
"""What cards have in place of what the templates have; None takes a key away."""
LIMITS = ("yield_stress", "strength", "shear_yield")
"""Keys of materials that may be empty."""
FIRST = ("solve", "indent", "bearing", "body", "tip", "shape")
"""Tables whose numbers come first in a case of the command line."""
MOST_FIELDS = 8
"""Largest number of main fields."""
MOST_CELLS, MOST_LAYERS, MOST_ELEMENTS, MOST_STEPS = 65_536, 20, 200, 200
"""Largest numbers of cells, of layers, of rolling elements, and of steps or indentations."""
LOADS = 60
"""Number of loads of an indentation, whose depths are evenly spaced."""
CHOSEN = ("solve.max_cells", "bearing.solve.cells", "grid.cells", "grid.width")
"""Numbers of cells and sizes that cards choose."""
MARGIN = 3.0
"""Width of the grid of a line contact over that of the contact on the softest of its materials."""


DIMENSION = re.compile(r"\s*\[(N m|N/m|m²/N|Pa|m|N)\]")
"""A unit in a text of the schema."""


class FieldError(ValueError):
    """A value that a field cannot have; `path` names the field."""

    def __init__(self, path: str, message: str) -> None:
        super().__init__(message)
        self.path = path


@dataclass(frozen=True, eq=False)
class Card:
    """A case to start from, its main fields, and all other numbers as fields."""

    name: str
    """Name of the template, or "own"."""
    group: str
    """Tab in which it is."""
    title: str
    """What it is, in a menu."""
    base: Data
    """Case in which all fields have their defaults."""
    fields: tuple[Field, ...]
    """Main fields."""
    more: tuple[Field, ...]
    """Fields of every other number."""
    measured: Measured = NONE
    """What was read from files at the start."""

    @functools.cached_property
    def by_path(self) -> dict[str, Field]:
        """Fields by path."""
        return {one.path: one for one in (*self.fields, *self.more)}

    @property
    def units(self) -> str:
        """Units of the case."""
        return str(self.base.get("units", "SI"))

    def case(self, values: Mapping[str, object]) -> Case:
        """Return the case with the values of some fields, as they were typed."""
        data = self.base
        for path, typed in values.items():
            if (one := self.by_path.get(path)) is None:
                raise FieldError(path, f"{path[:60]} is no field of this card")
            data = set_value(data, one, number(one, typed))
        check_size(data)
        return Case(_adjusted(data) if self.name != "own" else data, self.name)


def number(one: Field, typed: object) -> float | None:
    """Return the number that was typed into a field, in its unit; None of an empty one."""
    text = str(typed).strip().replace(",", ".").replace("−", "-")
    if not text and one.may_be_empty:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    unit = f" {one.unit}".rstrip()
    if not (math.isfinite(value) and one.low <= value <= one.high):
        is_free = not math.isfinite(one.high)
        ends = f"between {_plain(one.low)} and {_plain(one.high)}"
        limits = "a finite number" if is_free else ends
        raise FieldError(one.path, f"{one.label} must be {limits}{unit}, got {_short(typed)}")
    if one.is_count and value != round(value):
        raise FieldError(one.path, f"{one.label} must be a whole number, got {_short(typed)}")
    return value


def _plain(value: float) -> str:
    return np.format_float_positional(value, trim="-")


def _short(typed: object) -> str:
    return str(typed)[:40] or "nothing"


def set_value(data: Data, one: Field, value: float | None) -> Data:
    """Return the data of a case with the value of a field, in the unit of the field."""
    units = str(data.get("units", "SI"))
    entry: float | list[float] | None = None if value is None else one.in_case(value, units)
    if one.path == "indent.load" and isinstance(entry, float) and one.slides:
        entry = [tidy(entry * (k / LOADS) ** 1.5) for k in range(1, LOADS + 1)]
    parent, _, key = one.path.rpartition(".")
    if key.endswith("]"):
        return dict(core.with_value(data, one.path, entry))
    table = {name: old for name, old in core.at(data, parent).items() if name != key}
    return dict(core.with_value(data, parent, table if entry is None else table | {key: entry}))


def check_size(data: Data) -> None:
    """Raise an error if a case is too large for the page."""
    bearing, grid, indent = (data.get(name, {}) for name in ("bearing", "grid", "indent"))
    singles = [bearing, *(bearing.get(name, {}) for name in ("first", "second"))]
    bodies = [data.get(name, {}) for name in ("body", "counterbody")]
    bodies += [body for one in singles for body in _bodies(one)]
    steps = [indent.get(name, 0) for name in ("load", "approach", "radius")]
    steps.append(data.get("slide", {}).get("steps", 0))
    steps.append(worn := data.get("wear", {}).get("steps", 0))
    shapes = [grid.get("shape", [0]), bearing.get("solve", {}).get("cells", [0])]
    shapes += [data.get("shape", {}).get("shape", [0]), [grid.get("cells", 0)]]
    shapes.append([data.get("solve", {}).get("max_cells", 0)])
    sizes = {
        "cells": (max(map(math.prod, shapes)), MOST_CELLS),
        "layers": (max(len(body.get("layers", ())) for body in bodies), MOST_LAYERS),
        "elements": (
            max(one.get("count", 0) * one.get("rows", 1) for one in singles),
            MOST_ELEMENTS,
        ),
        "steps": (
            max(
                worn if isinstance(worn, int) else 0,
                *(len(one) if isinstance(one, list) else 0 for one in steps),
            ),
            MOST_STEPS,
        ),
    }
    for name, (size, most) in sizes.items():
        if size > most:
            raise CaseError(f"{name} must be at most {most} on the page, got {size:g}")


def _bodies(bearing: Data) -> Iterator[Data]:
    return (bearing.get(name, {}) for name in ("inner", "outer", "element"))


def _adjusted(data: Data) -> Data:
    """Return a case of a template without adhesion of no work, and a line on a grid that holds it.

    The grid is wide enough by Hertz's formula for the softest material.
    """
    if data.get("adhesion", {}).get("work") == 0:
        return {key: value for key, value in data.items() if key != "adhesion"}
    if "width" not in data.get("grid", {}):
        return data
    compliances = [(1 - one["poisson"] ** 2) / one["young"] for one in data["materials"].values()]
    load, radius = data["solve"]["load"], data["shape"]["radius"]
    width = MARGIN * 2 * math.sqrt(4 * load * radius * 2 * max(compliances) / math.pi)
    return data | {"grid": data["grid"] | {"width": float(f"{width:.3g}")}}


@functools.cache
def cards() -> dict[str, Card]:
    """Return the cards of the templates by name."""
    texts = templates.texts()
    return {name: _card(name, tomllib.loads(texts[name])) for name in CARDS}


def _card(name: str, data: Data) -> Card:
    group, title, fields = CARDS[name]
    data = _merged(data, CHANGES.get(name, {}))
    if name == "cone":
        data["indent"]["load"] = 0.0  # which its field sets
    for layer in data.get("body", {}).get("layers", ()):
        layer["name"] = layer["material"]
    for one in fields:
        data = set_value(data, one, one.default)
    return Card(name, group, title, data, fields, tuple(_others(data, fields)))


def _merged(data: Data, changes: Data) -> Data:
    """Return data with changed keys, in tables too; those of None are taken away."""
    tables = {
        key: _merged(data.get(key, {}), value) if isinstance(value, dict) else value
        for key, value in changes.items()
    }
    return {key: value for key, value in (data | tables).items() if value is not None}


def own_card(path: AnyPath) -> Card:
    """Return the card of a case file; what it measures is read here, once.

    The page writes no file: neither that of a study, nor that of a history.
    """
    case = Case.read(path)
    data: Data = {key: value for key, value in case.data.items() if key != "sweep"}
    if "wear" in data:
        data["wear"] = {key: value for key, value in data["wear"].items() if key != "store"}
    is_measured, measured = bool(case.measured()), NONE
    if is_measured:
        shape = case.arguments()["shape"]
        measured = Measured({"shape": shape}, {"shape": data["shape"]}, files_of(case))
        data["shape"] = {"kind": "sphere", "radius": 1.0}  # whose place the measured one takes
    if case.kind in ("contact", "wear") and "grid" not in data and not is_measured:
        data["solve"] = {"max_cells": MOST_CELLS} | data["solve"]
    check_size(data)
    others = (one for one in _others(data, ()) if one.path.partition(".")[0] not in measured.tables)
    order = sorted(others, key=lambda one: _rank(one.path))
    fields, more = tuple(order[:MOST_FIELDS]), tuple(order[MOST_FIELDS:])
    return Card("own", "own file", case.name, data, fields, more, measured)


def _rank(path: str) -> int:
    table = path.partition(".")[0]
    return FIRST.index(table) if table in FIRST else len(FIRST)


def _others(data: Data, fields: tuple[Field, ...]) -> Iterator[Field]:
    """Yield fields of all numbers that are not in others, and of limits that are missing."""
    paths = {one.path for one in fields} | (set(CHOSEN) if fields else set())
    for path, value in core.numbers(data):
        if not {path, path.rpartition("[")[0]} & paths:
            yield _field(data, path, value)
    for name, table in data.get("materials", {}).items():
        for key in LIMITS if isinstance(table, dict) else ():
            if key not in table and f"materials.{name}.{key}" not in paths:
                yield _field(data, f"materials.{name}.{key}", None)


def _field(data: Data, path: str, value: float | None) -> Field:
    """Return the field of a number, with the unit and the text of the schema."""
    keys = [int(key) if key.isdigit() else key for key in re.findall(r"[^.\[\]]+", path)]
    names = [key for key in keys if isinstance(key, str)]
    node = place(data, keys).node
    text = " ".join(str(node.get("description", "")).split())
    is_part = len(names) > 1 and (names[-1] in "xyz" or names[-2] in BY_LAYER)
    last = names[-2] if is_part else names[-1]
    dimension = (DIMENSION.findall(text) or [UNITS.get(".".join(names[-2:]))])[0]
    dimension = dimension or UNITS.get(last) or INPUTS.get(last, "")
    unit = System(str(data.get("units", "SI"))).unit(dimension)[1] if dimension else ""
    return Field(
        path,
        " ".join(map(str, keys[1:])).replace("_", " ") or path,
        unit,
        value,
        help=DIMENSION.sub("", text),
        may_be_empty=names[-1] in LIMITS,
        is_count="integer" in (node.get("type"), node.get("items", {}).get("type")),
    )
