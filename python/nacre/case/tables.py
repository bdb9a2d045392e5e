"""Foundations of the tables of case files: types of values, and descriptions."""

from __future__ import annotations

import inspect
import re
import types
from collections import defaultdict
from collections.abc import Callable, Collection, Mapping
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    FiniteFloat,
    PositiveInt,
    create_model,
)
from pydantic.fields import FieldInfo

from nacre._tools.groups import keyword_units

T = TypeVar("T", bound="Table")

TWO = Field(min_length=2, max_length=2)
UNIT = re.compile(r"\[((?:1|N|m|Pa|kg|rad|h)[²³]?(?:[ /](?:m|s|N|Pa)[²³]?)?)\]")
"""A unit in the description of a key."""
Number = FiniteFloat


def _integer(value: object) -> object:
    """Return a whole float as an integer, as calls take it."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


Count = Annotated[PositiveInt, BeforeValidator(_integer)]
Numbers = list[FiniteFloat]
Pair = Annotated[Numbers, TWO]
Counts = Annotated[list[Count], TWO]
Flags = Annotated[list[bool], TWO]


def with_words(words: str) -> object:
    """Return words for a type of values, in the reference and in errors."""
    return Field(json_schema_extra={"words": words})


class Table(BaseModel):
    """A table with the named keys and no others."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    def keywords(self) -> dict[str, Any]:
        """Return the keys that were given, as keywords."""
        values = {name: getattr(self, name) for name in self.model_fields_set}
        return {name: _keyword(value) for name, value in values.items()}


class Directions(Table):
    """Values along two directions."""

    def pair(self) -> tuple[object, ...]:
        """Return both values."""
        return tuple(value for _, value in self)


def _keyword(value: object) -> object:
    if isinstance(value, Directions):
        return value.pair()
    if isinstance(value, list):
        return tuple(value)
    return value


class Along(Directions):
    """A value along x, along y, or both."""

    x: Number | None = Field(None, description="Value along x.")
    y: Number | None = Field(None, description="Value along y.")


AnyAlong = Annotated[
    Along | Pair, with_words("a table with x, y or both, or a pair of finite numbers")
]
TYPES: dict[object, object] = {
    float: Number,
    int: Count,
    bool: bool,
    str: str,
    tuple[float, float]: Pair,
    tuple[int, int]: Counts,
    tuple[bool, bool]: Flags,
    tuple[float | None, float | None]: AnyAlong,
    types.NoneType: types.NoneType,
}
"""Types of case files by those of keywords."""


def case_type(hint: object) -> Any:
    """Return the type that a case file has for that of a keyword, or None if it has none.

    It has none for arrays and objects, nor for values by layer, which stand with the materials.
    """
    is_union = isinstance(hint, types.UnionType) or get_origin(hint) is Union
    parts = get_args(hint) if is_union else (hint,)
    if any(get_origin(part) is Mapping for part in parts):
        return None
    kinds = [part if get_origin(part) is Literal else TYPES.get(part) for part in parts]
    values = [kind for kind in kinds if kind is not None]
    return Union[tuple(values)] if set(values) - {types.NoneType} else None  # noqa: UP007


def unit_of(described: FieldInfo | Mapping[str, Any], line: bool = False) -> str:
    """Return the SI unit of a key, of a table or of its JSON schema; "" where it has none.

    It is that of the keyword, or else the one in its description.
    """
    if isinstance(described, FieldInfo):
        extra: Any = described.json_schema_extra or {}
        described = {"description": described.description, **extra}
    name = "unit_of_lines" if line else "unit"
    units = UNIT.findall(described.get("description") or "")
    return str(described.get(name) or next(iter(units), ""))


def needed(function: Callable[..., object]) -> set[str]:
    """Return the names of the arguments that a function cannot do without."""
    parameters = inspect.signature(function).parameters.values()
    return {one.name for one in parameters if one.default is one.empty}


def signature_fields(
    maker: Callable[..., object],
    own: Mapping[str, Any],
    leave: Collection[str] = (),
    texts: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """Return the fields of a table, one for each parameter that a case file has a type for.

    A parameter has its type in `own`, or the one of its annotation, or is a number in a signature
    of the compiled module, which has no annotations. One whose type in `own` may be None can be
    left out. Descriptions of `texts` go before those of the docstring.
    """
    descriptions, hints = {**parameter_texts(maker), **(texts or {})}, get_type_hints(maker)
    units, line = (keyword_units(maker, line=line) for line in (False, True))
    fields = {}
    for one in inspect.signature(maker).parameters.values():
        hint = own.get(one.name, case_type(hints.get(one.name)) if hints else Number)
        if hint is None or one.name in leave:
            continue
        default = one.default
        if default is one.empty:
            default = None if types.NoneType in get_args(hint) else ...
        hint = hint | None if default is None else hint
        extra: dict[str, Any] = {}  # without a unit, so that words of the type stay
        if unit := units.get(one.name):
            extra["json_schema_extra"] = {"unit": unit, "unit_of_lines": line[one.name]}
        fields[one.name] = (hint, Field(default, description=descriptions.get(one.name), **extra))
    return fields


def from_signature(
    maker: Callable[..., object],
    leave: Collection[str] = (),
    texts: Mapping[str, str] | None = None,
    **own: Any,
) -> Callable[[type[T]], type[T]]:
    """Return a decorator that adds keys for the parameters of a callable to a table.

    Those that the table has already keep its types and descriptions.
    """

    def decorate(table: type[T]) -> type[T]:
        fields = signature_fields(maker, own, {*leave, *table.model_fields}, texts)
        extended: type[T] = create_model(
            table.__name__,
            __base__=table,
            __doc__=table.__doc__,
            __module__=table.__module__,
            **fields,
        )
        return extended

    return decorate


def parameter_texts(thing: object) -> dict[str, str]:
    """Return the descriptions of the parameters in a NumPy-style docstring, by name.

    Without docstrings, as of ``python -OO``, all are empty.
    """
    section = re.search(
        r"^Parameters\n-+\n(.*?)(?:\n\n\w+\n-+\n|\Z)",
        inspect.cleandoc(thing.__doc__ or ""),
        re.DOTALL | re.MULTILINE,
    )
    if section is None:
        return defaultdict(str)
    descriptions: dict[str, str] = {}
    for names, lines in re.findall(
        r"^(\w+(?:, \w+)*) : .*\n((?:[ \t]+.*(?:\n|\Z)|\n)+)", section[1], re.MULTILINE
    ):
        descriptions |= dict.fromkeys(names.split(", "), " ".join(lines.split()))
    return descriptions


def table_of(
    kind: str, maker: Any, base: type[Table], own: Mapping[str, Any] | None = None
) -> type[Any]:
    """Return the table of what a callable makes, with a key for each of its parameters.

    A parameter is a number where `own` has no other type for it.
    """
    fields: dict[str, Any] = {
        "kind": (Literal[kind], Field(description="Kind, which decides on the other keys."))
    }
    fields |= signature_fields(maker, own or {})
    summary = inspect.cleandoc(maker.__doc__ or "").partition("\n")[0]
    name = kind.title().replace("_", "") + base.__name__
    table: type[Any] = create_model(name, __base__=base, __doc__=summary, **fields)
    return table
