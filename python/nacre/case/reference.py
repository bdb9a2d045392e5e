"""The reference of case files, made from their JSON schema; and places in a case, for errors."""

from __future__ import annotations

import functools
import json
import re
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Any

from pydantic import TypeAdapter

from nacre.case.bearing import BearingCase
from nacre.case.indent import IndentCase
from nacre.case.schema import CaseTable, Keys

Node = dict[str, Any]
"""A part of a JSON schema."""

WIDTH = 88
"""Width of the text of the reference."""
UNIT = re.compile(r"\s*(\[(?:N m|N/m|m²/N|Pa|m|N)\])")
INTRODUCTION = (
    "A case file is TOML. Numbers are in the units that the key units names, SI by default; N, m, "
    "Pa below stand for its force, length and stress. A number may have a unit of its own, as a "
    'text: "5 mm", "210 GPa", "1500/min", "1e-6 mm³/(N m)".'
)
ITEMS = {"number": "finite numbers", "integer": "integers above 0", "string": "texts"}
VALUES = {
    "boolean": "true or false",
    "integer": "an integer",
    "number": "a finite number",
    "object": "a table",
    "string": "a text",
}


@functools.cache
def schema() -> Node:
    """Return the JSON schema of case files, for editors too."""
    all_kinds: Any = CaseTable | IndentCase | BearingCase
    return {"title": "case file of nacre", **TypeAdapter(all_kinds).json_schema()}


def for_editors(node: Any) -> Any:
    """Return a part of a JSON schema whose numbers may be texts with units."""
    if isinstance(node, list):
        return [for_editors(item) for item in node]
    if not isinstance(node, dict):
        return node
    inner = {key: for_editors(item) for key, item in node.items()}
    return inner | {"type": ["number", "string"]} if inner.get("type") == "number" else inner


def options(node: Node) -> Iterator[Node]:
    """Yield the alternatives of a part, itself if there are none; references are followed."""
    if "$ref" in node:
        yield from options(schema()["$defs"][node["$ref"].rpartition("/")[2]])
    elif inner := node.get("anyOf", node.get("oneOf")):
        for option in inner:
            yield from options(option)
    elif node.get("type") != "null":
        yield node


def kind_of(table: Node) -> str | None:
    """Return the kind of a table, where its kind decides on its keys."""
    kind: str | None = table.get("properties", {}).get("kind", {}).get("const")
    return kind


def words(node: Node) -> str:
    """Return the words for the values that a part allows."""
    if "words" in node:
        return str(node["words"])
    if "oneOf" in node:
        return "a table with the key kind"
    if "anyOf" in node:
        inner = [option for option in node["anyOf"] if option.get("type") != "null"]
        return alternatives(dict.fromkeys(map(words, inner)))
    if "$ref" in node:
        return "a table"
    if "const" in node:
        return json.dumps(node["const"])
    if "enum" in node:
        return alternatives(map(json.dumps, node["enum"]))
    if node.get("type") == "array":
        return _list(node)
    if "exclusiveMinimum" in node:
        return "an integer above 0"
    return VALUES.get(node.get("type", ""), "any value")


def _list(node: Node) -> str:
    items = node["items"]
    several = ITEMS.get(items.get("type"), "tables" if list(tables(items)) else "values")
    if items.get("type") == "boolean":
        return "a pair of true or false"
    if node.get("minItems") == node.get("maxItems") == 2:
        return f"a pair of {several}"
    return f"a list of {several}" + (f", at most {node['maxItems']}" if "maxItems" in node else "")


def alternatives(names: Iterable[str]) -> str:
    """Return names with "or" before the last one."""
    *first, last = names
    return f"{', '.join(first)} or {last}" if first else last


def nearest(name: str, names: Iterable[str]) -> list[str]:
    """Return names, those that are most like `name` first."""
    return sorted(names, key=lambda candidate: -SequenceMatcher(None, name, candidate).ratio())


def tables(node: Node) -> Iterator[Node]:
    """Yield the tables that a part allows."""
    return (option for option in options(node) if "properties" in option)


def sections() -> Iterator[tuple[str, Node]]:
    """Yield title and schema of the tables of the reference, the whole files first."""
    definitions = schema()["$defs"]

    def kinds(table: str, key: str, title: str) -> Iterator[tuple[str, Node]]:
        for option in tables(definitions[table]["properties"][key]):
            yield f'`[{title}]` with `kind = "{kind_of(option)}"`', option

    yield "Whole file of a contact", definitions["CaseTable"]
    yield "Whole file of an indentation", definitions["IndentCase"]
    yield "Whole file of a bearing", definitions["BearingCase"]
    yield "`[materials.NAME]`", definitions["Material"]
    yield from kinds("CaseTable", "shape", "shape")
    yield from kinds("RollerShape", "profile", "shape.profile")
    yield "`[body]` and `[counterbody]`", definitions["Body"]
    yield "`[[body.layers]]`", definitions["Layer"]
    yield "`interface` of a layer: `interface = { normal = ... }`", definitions["Spring"]
    yield "`bond_strength` of a layer: `bond_strength = { shear = ... }`", definitions["Bond"]
    yield "`[grid]`", definitions["Grid"]
    yield "`[solve]`", definitions["Solve"]
    yield "`[solve.eccentricity]`, `[solve.moment]` and `[solve.tilt]`", definitions["Along"]
    yield "`[slide]`", definitions["Slide"]
    yield "`[[slide.steps]]`", definitions["Step"]
    yield "`[slide.shift]` and `[slide.force]`", definitions["Along"]
    yield "`[roll]`", definitions["Roll"]
    yield "`[roll.creepage]` and `[roll.force]`", definitions["Rolling"]
    yield "`[wear]`", definitions["Wear"]
    yield "`[stress]`", definitions["Stress"]
    yield "`[conductance]`", definitions["Conductance"]
    yield "`[fatigue]`", definitions["Fatigue"]
    for option in tables(definitions["Fatigue"]["properties"]["criteria"]["items"]):
        yield f'`[[fatigue.criteria]]` with `kind = "{kind_of(option)}"`', option
    yield from kinds("IndentCase", "tip", "tip")
    yield from kinds("IndentCase", "adhesion", "adhesion")
    yield "`[indent]`", definitions["Indent"]
    yield from kinds("BearingCase", "bearing", "bearing")
    yield from kinds("PairKind", "first", "bearing.first")
    yield "`[bearing.raceway_crown]`", definitions["Rings"]
    yield "`[bearing.solve]`", definitions["BearingSolve"]
    yield "`[bearing.solve.force]` and `[bearing.solve.displacement]`", definitions["InSpace"]
    yield "`[bearing.solve.moment]` and `[bearing.solve.tilt]`", definitions["About"]
    yield "`[bearing.life]`", definitions["BearingLife"]
    yield "`[[bearing.life.spectrum]]`", definitions["Duty"]
    yield "`[bearing.oil]`", definitions["BearingOil"]
    yield "`[bearing.film]`", definitions["BearingFilm"]
    yield "`[sweep]`", definitions["Sweep"]
    yield "`[report]`", definitions["Head"]
    yield 'Ranges in `[sweep]`: `parameters."solve.load" = { ... }`', definitions["Range"]


def text() -> str:
    """Return the reference as Markdown that can be read as it is."""
    lines = textwrap.wrap(INTRODUCTION, WIDTH)
    for title, table in sections():
        description = table.get("description", "")  # without docstrings there is none
        summary = " ".join(description.split("\n\n")[0].split()).replace("``", "`")
        lines += ["", f"## {title}", "", *textwrap.wrap(summary, WIDTH), ""]
        required = table.get("required", [])
        keys = [(name, node) for name, node in table["properties"].items() if "const" not in node]
        # Keys that must be given come first, and the common ones of shapes last.
        for name, node in sorted(keys, key=lambda key: (key[0] not in required, key[0] == "shift")):
            item = _key(name, node, name in required)
            lines += textwrap.wrap(item, WIDTH, subsequent_indent="  ", break_on_hyphens=False)
    return "\n".join(lines)


def _key(name: str, node: Node, required: bool) -> str:
    """Return the item of a key: its values with their unit, its default, and its meaning."""
    description = node.get("description", "").replace("``", "`")
    value = words(node).removeprefix("a ").removeprefix("an ")
    unit = UNIT.search(description)
    default = "; required" if required else ""
    if node.get("default") not in (None, [], {}):
        default = f"; default `{json.dumps(node['default'])}`"
    return (
        f"- `{name}`: {value}{f' {unit[1]}' if unit else ''}{default}. {UNIT.sub('', description)}"
    )


def table_for(data: object) -> type[Keys]:
    """Return the table for a case: a bearing; or with a tip or ``indent`` an indentation."""
    keys = data.keys() if isinstance(data, dict) else set()
    if "bearing" in keys:
        return BearingCase
    return IndentCase if {"tip", "indent"} & keys else CaseTable


@dataclass(frozen=True)
class Place:
    """A place in a case: the key of a value, what it may be, and the value."""

    path: tuple[int | str, ...]
    node: Node
    value: object

    @property
    def key(self) -> str:
        """Key as users write it: names with dots, numbers in brackets."""
        dotted = "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in self.path)
        return dotted.removeprefix(".")

    def tables(self) -> list[Node]:
        """Return the tables that the value may be; by its kind, where it has one."""
        nodes = list(tables(self.node))
        kind = self.value.get("kind") if isinstance(self.value, dict) else None
        return [table for table in nodes if kind and kind_of(table) == kind] or nodes

    def keys(self) -> list[str]:
        """Return the keys that a table here may have."""
        return list(dict.fromkeys(name for table in self.tables() for name in table["properties"]))

    def kinds(self) -> list[str]:
        """Return the kinds that a table here may have."""
        return [kind for table in tables(self.node) if (kind := kind_of(table))]

    def words(self) -> str:
        """Return the words for the values that are possible here."""
        return words(self.node)

    def inside(self, step: int | str) -> Place | None:
        """Return the place of an item or of a key of the value, if there is one."""
        value, node = self.value, None
        if isinstance(step, int) and isinstance(value, list):
            lists = [option["items"] for option in options(self.node) if "items" in option]
            # Numbers in a list are described with the list.
            node = next((item for item in lists if list(tables(item))), None)
            value = value[step]
        elif isinstance(step, str) and isinstance(value, dict):
            properties = [
                table["properties"] for table in self.tables() if step in table["properties"]
            ]
            extras = [option.get("additionalProperties") for option in options(self.node)]
            if properties:
                node = properties[0][step]
            elif step in value:
                node = next((extra for extra in extras if extra), None)
            value = value.get(step)
        return None if node is None else Place((*self.path, step), node, value)


def place(data: object, location: Iterable[int | str]) -> Place:
    """Return the deepest place of a case that a location leads to.

    A location may hold names of alternatives between its keys, which are passed over.
    """
    here = Place((), schema()["$defs"][table_for(data).__name__], data)
    for step in location:
        here = here.inside(step) or here
    return here
