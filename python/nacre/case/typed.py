"""Texts with units in case files: "5 mm" is a number in the units of the file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from typing import Any

from nacre._tools.units import System, number_in
from nacre.case.reference import Place, options, place
from nacre.case.schema import at
from nacre.case.tables import unit_of
from nacre.contact.conductance import units_of

Keys = tuple[int | str, ...]

NUMERIC = re.compile(r"\s*[+\-−]?\.?\d")
"""How a text begins that is meant as a number."""
FIXED = ("const", "enum")
"""Keys of a schema that allow certain texts alone."""
STUDY = ("sweep", "parameters")
"""Place of the values of a study, whose units are those of the keys that they change."""
TWICE = [False, False]
"""Axes along which no grid repeats."""
DISTANCES = ("steps", "required_distance")
"""Keys of wear that are lengths only where its distance is one."""


def with_numbers(data: Mapping[str, object]) -> dict[str, Any]:
    """Return the data of a case with numbers, in its own units, in place of texts with a unit.

    A `WrongValue` names the key, the unit that it must have, and the text. Whatever else is wrong
    stays as it is.
    """
    try:
        system = System(data.get("units", "SI"))  # type: ignore[arg-type]
    except ValueError:
        return dict(data)  # which the schema refuses

    @cache
    def unit(keys: Keys) -> str | None:
        return _unit_of_texts(data, keys, system)

    def read(entry: object, keys: Keys) -> Any:
        if isinstance(entry, Mapping):
            return {key: read(item, (*keys, key)) for key, item in entry.items()}
        if isinstance(entry, list):
            return [read(item, (*keys, number)) for number, item in enumerate(entry)]
        if not (isinstance(entry, str) and NUMERIC.match(entry)):
            return entry
        is_item = isinstance(keys[-1], int)  # all items of a list have the same unit
        wanted = unit((*keys[:-1], 0) if is_item else keys)
        if wanted is None:
            return entry
        with at(Place(keys, {}, entry).key):
            return number_in(wanted, entry)

    numbers: dict[str, Any] = read(data, ())
    return numbers


def _unit_of_texts(data: Mapping[str, object], keys: Keys, system: System) -> str | None:
    """Return the unit of the number at a place of a case; None where there is no number."""
    if keys[:2] == STUDY and len(keys) > 3 and keys[3] != "count":
        keys = (*steps_of(data, str(keys[2])), *keys[4:])
    is_item = isinstance(keys[-1], int)
    keys = keys[:-1] if is_item else keys
    here = place(data, keys)
    kinds = [option.get("items", {}) if is_item else option for option in options(here.node)]
    is_text = any(kind.get("type") == "string" and kind.keys().isdisjoint(FIXED) for kind in kinds)
    if here.path != keys or is_text or not any(kind.get("type") == "number" for kind in kinds):
        return None
    return system.unit(si_unit(data, keys))[1]


def si_unit(data: Mapping[str, Any], keys: Keys) -> str:
    """Return the SI unit of the number at a place of a case: its own, or of what it is a part of.

    It is "" where the number has none.
    """
    if keys[0] == "wear" and keys[-1] in DISTANCES:
        return "m" if "sliding" in data["wear"] else ""
    grid = data.get("grid")
    line = isinstance(grid, Mapping) and "width" in grid
    if keys[0] == "conductance":
        per_area = isinstance(grid, Mapping) and grid.get("periodic", TWICE) != TWICE
        is_electrical = data["conductance"].get("kind") == "electrical"
        kind = "electrical" if is_electrical else "thermal"
        return units_of(kind, line=line, per_area=per_area)[str(keys[1])]
    nodes = [place(data, inner).node for inner in (keys, keys[:-1])]
    return next((unit for node in nodes if (unit := unit_of(node, line))), "")


def steps_of(data: object, path: str) -> Keys:
    """Return the keys and numbers along a path, which may name a layer, as studies do."""
    steps: list[int | str] = []
    for word in re.findall(r"[^.\[\]]+", path):
        step: int | str = word
        for number, item in enumerate(data if isinstance(data, list) else ()):
            if word == str(number) or (isinstance(item, dict) and item.get("name") == word):
                step = number
        steps.append(step)
        try:
            data = data[step]  # type: ignore[index]
        except (LookupError, TypeError):
            data = None
    return tuple(steps)
