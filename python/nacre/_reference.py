"""The reference of case files, made from their schema: tables, keys, values, units, defaults."""

from __future__ import annotations

import json
import re
import textwrap
import types
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import TypeAdapter

from nacre._case_tables import Table, Words
from nacre._friction_tables import Along, Roll, Rolling, Slide, Step
from nacre._indent_tables import TABLES as MADE
from nacre._indent_tables import Indent, IndentCase
from nacre._schema import (
    Bodies,
    Body,
    CaseTable,
    Grid,
    Layer,
    Material,
    Range,
    Solve,
    Stress,
    Sweep,
)
from nacre._shape_tables import PROFILE_TABLES, TABLES

WIDTH = 88
"""Width of the text that `nacre schema` prints."""
UNIT = re.compile(r"\s*\[(N m|N/m|Pa|m|N)\]")


@dataclass(frozen=True)
class Key:
    """A key of a table."""

    name: str
    value: str
    unit: str
    default: str
    meaning: str


@dataclass(frozen=True)
class Section:
    """A table of the reference."""

    title: str
    summary: str
    keys: Sequence[Key]


def words(hint: Any, metadata: Iterable[Any] = ()) -> str:
    """Return the words for a type of values."""
    for one in metadata:
        if isinstance(one, Words):
            return one.text
    origin, parts = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return words(parts[0], parts[1:])
    if origin is Literal:
        return alternatives(json.dumps(part) for part in parts)
    if origin in (Union, types.UnionType):
        return alternatives(dict.fromkeys(words(one) for one in parts if one is not type(None)))
    if isinstance(hint, type) and issubclass(hint, Table):
        return "a table"
    if hint is bool:
        return "true or false"
    return "any value"


def alternatives(names: Iterable[str]) -> str:
    """Return names with "or" before the last one."""
    *first, last = names
    return f"{', '.join(first)} or {last}" if first else last


def nearest(name: str, names: Iterable[str]) -> list[str]:
    """Return names, those that are most like `name` first."""
    return sorted(names, key=lambda one: -SequenceMatcher(None, name, one).ratio())


def sections() -> Iterator[Section]:
    """Yield the tables of the reference, the whole file first."""
    yield _section("Whole file of a contact", CaseTable)
    yield _section("Whole file of an indentation", IndentCase)
    yield _section("`[materials.NAME]`", Material)
    for kind, table in TABLES.items():
        yield _section(f'`[shape]` with `kind = "{kind}"`', table)
    for kind, table in PROFILE_TABLES.items():
        yield _section(f'`[shape.profile]` with `kind = "{kind}"`', table)
    yield _section("`[body]` and `[counterbody]`", Body)
    yield _section("`[[body.layers]]`", Layer)
    yield _section("`[grid]`", Grid)
    yield _section("`[solve]`", Solve)
    yield _section("`[solve.eccentricity]`, `[solve.moment]` and `[solve.tilt]`", Along)
    yield _section("`[slide]`", Slide)
    yield _section("`[[slide.steps]]`", Step)
    yield _section("`[slide.shift]` and `[slide.force]`", Along)
    yield _section("`[roll]`", Roll)
    yield _section("`[roll.creepage]` and `[roll.force]`", Rolling)
    yield _section("`[stress]`", Stress)
    for family, made in MADE.items():
        for kind, one in made.items():
            yield _section(f'`[{family.lower()}]` with `kind = "{kind}"`', one)
    yield _section("`[indent]`", Indent)
    yield _section("`[sweep]`", Sweep)
    yield _section('Ranges in `[sweep]`: `parameters."solve.load" = { ... }`', Range)


def _section(title: str, table: type[Table]) -> Section:
    keys = []
    for name, field in table.model_fields.items():
        if name == "kind":
            continue
        told = field.description or ""
        unit = UNIT.search(told)
        value = words(field.annotation, field.metadata).removeprefix("a ").removeprefix("an ")
        if field.is_required():
            default = "required"
        else:
            given = field.default
            default = "" if given is None or given in ([], {}) else json.dumps(given)
        meaning = UNIT.sub("", told)
        keys.append(Key(name, value, unit[1] if unit else "", default, meaning))
    # Keys that must be given come first, and the common ones of shapes last.
    keys.sort(key=lambda key: (key.default != "required", key.name == "shift"))
    summary = " ".join((table.__doc__ or "").split("\n\n")[0].split())
    return Section(title, summary, keys)


INTRODUCTION = (
    "A case file is TOML. Numbers are in the units that the key units names, SI by default; N, m, "
    "Pa below stand for its force, length and stress."
)


def text() -> str:
    """Return the reference as plain text."""
    lines = [*textwrap.wrap(INTRODUCTION, WIDTH)]
    for section in sections():
        lines += [
            "",
            section.title.replace("`", ""),
            *textwrap.wrap(section.summary.replace("`", ""), WIDTH),
        ]
        for key in section.keys:
            unit = f" [{key.unit}]" if key.unit else ""
            default = {"required": "; required", "": ""}.get(
                key.default, f"; default {key.default}"
            )
            lines.append(f"  {key.name}: {key.value}{unit}{default}")
            lines += textwrap.wrap(
                key.meaning.replace("`", ""),
                WIDTH,
                initial_indent=" " * 6,
                subsequent_indent=" " * 6,
            )
    return "\n".join(lines)


def markdown() -> str:
    """Return the reference as Markdown, a heading and a table for each table of a case file."""
    lines = [INTRODUCTION]
    for section in sections():
        lines += ["", f"## {section.title}", "", section.summary.replace("``", "`"), ""]
        if not section.keys:
            continue
        lines += ["| key | value | unit | default | meaning |", "|---|---|---|---|---|"]
        for key in section.keys:
            default = key.default if key.default in ("", "required") else f"`{key.default}`"
            meaning = key.meaning.replace("``", "`")
            cells = (f"`{key.name}`", key.value, key.unit, default, meaning)
            lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def schema() -> dict[str, Any]:
    """Return the JSON schema of case files, for editors."""
    both: Any = CaseTable | IndentCase
    return {"title": "case file of nacre", **TypeAdapter(both).json_schema()}


def table_for(data: Any) -> type[Bodies]:
    """Return the table for a case: one with a tip or a table ``indent`` is an indentation."""
    return IndentCase if isinstance(data, dict) and {"tip", "indent"} & data.keys() else CaseTable


@dataclass(frozen=True)
class Place:
    """A place in a case: the key of a value, the types that it may have, and the value."""

    path: tuple[int | str, ...]
    hint: Any
    metadata: Sequence[Any]
    value: Any

    @property
    def key(self) -> str:
        """Key as users write it: names with dots, numbers in brackets."""
        said = "".join(f"[{one}]" if isinstance(one, int) else f".{one}" for one in self.path)
        return said.removeprefix(".")

    def tables(self) -> list[type[Table]]:
        """Return the tables that the value may be; by its kind, where it has one."""
        found = list(_tables(self.hint))
        kind = self.value.get("kind") if isinstance(self.value, dict) else None
        return [one for one in found if kind in _kinds(one)] or found

    def keys(self) -> list[str]:
        """Return the keys that a table here may have."""
        return list(dict.fromkeys(name for one in self.tables() for name in one.model_fields))

    def kinds(self) -> list[str]:
        """Return the kinds that a table here may have."""
        return [kind for one in _tables(self.hint) for kind in _kinds(one)]

    def words(self) -> str:
        """Return the words for the values that are possible here."""
        return words(self.hint, self.metadata)


def place(data: Any, location: Iterable[int | str]) -> Place:
    """Return the deepest place of a case that a location leads to.

    A location may hold names of alternatives between its keys, which are passed over.
    """
    here = Place((), table_for(data), (), data)
    for part in location:
        here = _inside(here, part) or here
    return here


def _inside(here: Place, part: int | str) -> Place | None:
    value = here.value
    if isinstance(part, int):
        inner = next(_parts(here.hint, list), None)
        # Numbers in a list are described with the list.
        if inner is None or not isinstance(value, list) or not list(_tables(inner)):
            return None
        return Place((*here.path, part), inner, (), value[part])
    if not isinstance(value, dict):
        return None
    for table in here.tables():
        if (field := table.model_fields.get(part)) is not None:
            inner = value.get(part)
            return Place((*here.path, part), field.annotation, field.metadata, inner)
    inner = next(_parts(here.hint, dict), None)
    if inner is None or part not in value:
        return None
    return Place((*here.path, part), inner, (), value[part])


def _parts(hint: Any, kind: type) -> Iterator[Any]:
    """Yield the types of the items of lists or dictionaries that a type allows."""
    origin, parts = get_origin(hint), get_args(hint)
    if origin is kind:
        yield parts[-1]
    elif origin in (Union, types.UnionType):
        for one in parts:
            yield from _parts(one, kind)
    elif origin is Annotated:
        yield from _parts(parts[0], kind)


def _tables(hint: Any) -> Iterator[type[Table]]:
    """Yield the tables that a type allows."""
    if isinstance(hint, type) and issubclass(hint, Table):
        yield hint
    elif get_origin(hint) in (Union, types.UnionType):
        for one in get_args(hint):
            yield from _tables(one)
    elif get_origin(hint) is Annotated:
        yield from _tables(get_args(hint)[0])


def _kinds(table: type[Table]) -> tuple[str, ...]:
    field = table.model_fields.get("kind")
    return get_args(field.annotation) if field else ()
