"""Cards of the page: cases to start from, and the case that the values of fields make."""

from __future__ import annotations

import copy
import dataclasses
import functools
import math
import tomllib
from collections.abc import Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from importlib import resources
from typing import Any

import numpy as np

import nacre
import nacre._core as core
from nacre._tools.notices import heard
from nacre._tools.typing import AnyPath
from nacre.app.answer import NONE, Measured
from nacre.app.fields import LIMITS, Field, FieldError, entry_at, field_of, keys_of, tidy
from nacre.case import Case, CaseError, templates
from nacre.case.results import files_of
from nacre.case.schema import material_of
from nacre.case.typed import with_numbers

Data = dict[str, Any]

FIRST = ("solve", "indent", "bearing", "body", "tip", "shape")
"""Tables whose numbers come first in a case of the command line."""
MOST_FIELDS = 8
"""Number of main fields of a case of the command line."""
MOST = {"cells": 65_536, "layers": 20, "elements": 200, "steps": 200}
"""Largest numbers of cells, of layers, of rolling elements, and of steps or indentations."""
LOADS = 60
"""Number of loads of an indentation, whose depths are evenly spaced."""
CHOSEN = {"solve.max_cells", "bearing.solve.cells", "grid.cells", "grid.width", "counterbody.ends"}
CHOSEN |= {f"{table}.{key}" for table in ("grid", "shape") for key in ("shape", "size")}
"""Numbers of cells, sizes and ends that cards choose."""
STATIONS = {f"{table}.profile.{key}" for table in ("shape", "bearing") for key in ("x", "drop")}
"""Lists of a measured profile, whose numbers are no fields."""
IDLE = tuple(f".{key}" for keys in LIMITS.values() for key in keys)
"""Ends of the paths of limits, which act in some cases only."""
BONDS = ("shear", "tension")
"""Limits of interfaces."""
REQUIRED = {
    "wear": ("wear.required_distance",),
    "conductance": ("conductance.required_resistance",),
    "bearing": ("bearing.life.required_life", "bearing.solve.static_safety"),
}
"""What has to be reached, by the table of the case."""
MARGIN, WORN = 3.0, 1.5
"""Width of the grid of a line contact over that of the contact on the softest of its materials, and
over that of the groove in which a coating is worn through."""


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
    fields: list[Field]
    """Main fields."""
    more: list[Field]
    """Fields of every other number."""
    measured: Measured = NONE
    """What was read from files at the start."""
    shown: Mapping[str, str] = dataclasses.field(default_factory=dict)
    """Units in which numbers are shown, by their SI units: those in which they are typed."""

    @functools.cached_property
    def by_path(self) -> dict[str, Field]:
        """Fields by path."""
        return {field.path: field for field in (*self.fields, *self.more)}

    def case(self, values: Mapping[str, object]) -> Case:
        """Return the case with the values of some fields, as they were typed."""
        data = self.base
        for path, typed in values.items():
            if (field := self.by_path.get(path)) is None:
                raise FieldError(path, f"{path[:60]} is not a field of this card")
            data = with_value(data, field, field.number(typed))
        check_size(data)
        data = data if self.name == "own" else _solvable_case(data)
        return Case(_with_names(data), self.name)


def with_value(data: Data, field: Field, value: float | str | None) -> Data:
    """Return the data of a case with the value of a field, in the unit of the field."""
    entry: float | str | list[float] | None = None
    if value is not None:
        entry = field.in_case(value, data.get("units", "SI"))
        if field.path == "indent.load" and field.slides and isinstance(entry, float):
            entry = [tidy(entry * (k / LOADS) ** 1.5) for k in range(1, LOADS + 1)]
    return _with_entry(data, field.path, entry)


def _with_entry(data: Data, path: str, entry: object) -> Data:
    """Return the data of a case with another entry at a path, or without one if it is None."""
    data, (*places, key) = copy.deepcopy(data), keys_of(path)
    if entry is None and entry_at(data, path) is None:
        return data
    table: Any = data
    for step in places:
        table = table.setdefault(step, {}) if isinstance(table, dict) else table[step]
    if entry is None:
        table.pop(key, None)
    else:
        table[key] = entry
    return data


def check_size(data: Data) -> None:
    """Raise an error if a case is too large for the page."""
    sizes = list(_sizes(data))
    for name, most in MOST.items():
        size = max((size for what, size in sizes if what == name), default=0)
        if size > most:
            raise CaseError(f"{name} must be at most {most} on the page, got {size:g}")


def _sizes(data: Any) -> Iterator[tuple[str, float]]:
    """Yield the sizes of a case that take time, by what they are."""
    if isinstance(data, list):
        for item in data:
            yield from _sizes(item)
    for key, entry in data.items() if isinstance(data, dict) else ():
        yield from _sizes(entry)
        match key, entry:
            case "shape" | "cells" | "max_cells", int() | float() | list():
                yield "cells", math.prod(np.ravel(entry).tolist())
            case "layers", list():
                yield "layers", len(entry)
            case "count", int() | float():
                yield "elements", entry * data.get("rows", 1)
            case "load" | "approach" | "radius" | "steps", list():
                yield "steps", len(entry)
            case "steps", int() | float():
                yield "steps", entry


def _solvable_case(data: Data) -> Data:
    """Return a case of a template without adhesion of no work, with ends and a grid that hold it.

    A roller's body ends with it. The grid of a line is wide enough by Hertz's formula for the
    softest material, and for the groove in a coating that is worn through.
    """
    if data.get("adhesion", {}).get("work") == 0:
        return _with_entry(data, "adhesion", None)
    if (length := data.get("shape", {}).get("length")) is not None:
        return _with_entry(data, "counterbody.ends", [-length / 2, length / 2])
    if "width" not in data.get("grid", {}):
        return data
    Case(_with_names(data)).arguments()  # checks the numbers from which the width is computed
    compliance = max(
        (1 - material["poisson"] ** 2) / material["young"]
        for material in data["materials"].values()
    )
    load, radius = data["solve"]["load"], data["shape"]["radius"]
    width = MARGIN * 2 * math.sqrt(4 * load * radius * 2 * compliance / math.pi)
    if "wear" in data:
        depth = sum(layer["thickness"] for layer in data["body"].get("layers", ()))
        width += WORN * 2 * math.sqrt(2 * radius * depth)
    return _with_entry(data, "grid.width", float(f"{width:.3g}"))


def _with_names(data: Data) -> Data:
    """Return the data of a case with the name of a card for a material that has its numbers."""
    own, tables = data.get("materials", {}), _tables(data.get("units", "SI"))
    names = {
        key: next((name for name, table in tables.items() if _are_equal(table, numbers)), numbers)
        for key, numbers in own.items()
    }
    return data | ({"materials": names} if own else {})


def _are_equal(table: Data, numbers: Any) -> bool:
    """Return whether two tables have the same numbers, but for their rounding."""
    return (
        isinstance(numbers, dict)
        and table.keys() == numbers.keys()
        and all(math.isclose(table[key], numbers[key]) for key in table)
    )


@functools.cache
def _tables(units: str) -> dict[str, Data]:
    """Return the numbers of all known materials in the units of a case."""
    with heard():  # which the page shows as a source
        return {
            name: material_of(name, units).model_dump(exclude_none=True) for name in nacre.materials
        }


@functools.cache
def cards() -> dict[str, Card]:
    """Return the cards of the templates by name."""
    table = _texts()
    return {name: _card(name, entry, table) for name, entry in table["cards"].items()}


@functools.cache
def _texts() -> dict[str, Any]:
    """Return the descriptions of cards, and labels, units and helps of quantities."""
    return tomllib.loads((resources.files(__package__) / "cards.toml").read_text("utf-8"))


def _card(name: str, entry: Data, texts: Mapping[str, Any]) -> Card:
    """Return the card of a template, with other entries and without some."""
    texts = {**texts, "shown": entry.get("shown", {})}
    data = with_numbers(tomllib.loads(templates.texts()[name]))
    for path in entry.get("without", ()):
        data = _with_entry(data, path, None)
    for path, value in entry.get("changes", {}).items():
        data = _with_entry(data, path, value)
    main, rest = (
        [field_of(data, texts=texts, **description) for description in entry.get(fields, ())]
        for fields in ("fields", "more")
    )
    for field in (*main, *rest):
        data = with_value(data, field, field.default)
    more = _other_fields(data, CHOSEN | {field.path for field in (*main, *rest)}, texts)
    return Card(
        name, entry["group"], entry["title"], data, main, [*rest, *more], NONE, texts["shown"]
    )


def own_card(path: AnyPath) -> Card:
    """Return the card of a case file; what it measures is read here, once.

    The page writes no file: neither that of a study, nor that of a history.
    """
    case = Case.read(path)
    data = _with_entry(case.data, "sweep", None)
    if "wear" in data:
        data = _with_entry(data, "wear.store", None)
    own = dict(data.get("materials", {}))
    for known in case.cards():  # whose numbers become fields
        for name in [key for key, entry in own.items() if entry == known.name] or [known.name]:
            own[name] = _tables(case.units)[known.name]
    data = data | ({"materials": own} if own else {})
    measured = NONE
    if case.measured():
        shape = case.arguments()["shape"]
        measured = Measured({"shape": shape}, {"shape": data["shape"]}, files_of(case))
        data["shape"] = {"kind": "sphere", "radius": 1.0}  # whose place the measured one takes
    elif case.kind in ("contact", "wear") and "grid" not in data:
        data["solve"] = {"max_cells": MOST["cells"]} | data["solve"]
    if case.kind == "contact" and data.keys().isdisjoint({"fatigue", "conductance"}):
        data.setdefault("stress", {})  # which the page shows
    check_size(data)
    fields = _other_fields(data, measured.tables.keys() | STATIONS, _texts(), has_units=False)
    ranks = {table: rank for rank, table in enumerate(FIRST)}
    fields.sort(key=lambda field: ranks.get(field.path.partition(".")[0], len(ranks)))
    main, more = fields[:MOST_FIELDS], fields[MOST_FIELDS:]
    return Card("own", "own file", case.name, data, main, more, measured)


def _other_fields(
    data: Data, left: AbstractSet[str], texts: Mapping[str, Any], has_units: bool = True
) -> list[Field]:
    """Return fields of all numbers and limits that act, but for some paths."""
    limits = list(_limits(data))
    paths = [path for path, _ in core.numbers(data) if not path.endswith(IDLE) or path in limits]
    return [
        field_of(data, path, texts, has_units)
        for path in dict.fromkeys([*paths, *limits])
        if left.isdisjoint({path, path.rpartition("[")[0], path.partition(".")[0]})
    ]


def _limits(data: Data) -> Iterator[str]:
    """Yield the paths of limits that decide a verdict."""
    for table, keys in LIMITS.items():
        if table not in data:
            continue
        member = data[table].get("body", "body")
        layers = data[member].get("layers", [])
        names = [layer["material"] for layer in layers] + [data[member]["substrate"]]
        for name, numbers in data.get("materials", {}).items():
            if name in names and isinstance(numbers, dict):
                yield from (f"materials.{name}.{key}" for key in keys)
        if table == "stress":
            for place in range(len(layers)):
                yield from (f"{member}.layers[{place}].bond_strength.{key}" for key in BONDS)
    yield from (path for table, paths in REQUIRED.items() if table in data for path in paths)
