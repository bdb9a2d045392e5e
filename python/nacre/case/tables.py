"""Foundations of the tables of case files: types of values, and descriptions."""

from __future__ import annotations

import inspect
import re
from collections import defaultdict
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    FiniteFloat,
    PositiveInt,
    create_model,
)

TWO = Field(min_length=2, max_length=2)
Number = FiniteFloat


def _integer(value: Any) -> Any:
    """Return a whole float as an integer, as calls take it."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


Count = Annotated[PositiveInt, BeforeValidator(_integer)]
Numbers = list[FiniteFloat]
Pair = Annotated[Numbers, TWO]
Counts = Annotated[list[Count], TWO]
Flags = Annotated[list[bool], TWO]


def with_words(words: str) -> Any:
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

    def pair(self) -> tuple[Any, ...]:
        """Return both values."""
        return tuple(value for _, value in self)


def _keyword(value: Any) -> Any:
    if isinstance(value, Directions):
        return value.pair()
    if isinstance(value, list):
        return tuple(value)
    return value


def described(thing: Any) -> dict[str, str]:
    """Return the descriptions of the parameters in a NumPy-style docstring, by name.

    Without docstrings, as of ``python -OO``, all are empty.
    """
    if thing.__doc__ is None:
        return defaultdict(str)
    text = inspect.cleandoc(thing.__doc__)
    section = re.search(
        r"^Parameters\n-+\n(.*?)(?:\n\n\w+\n-+\n|\Z)", text, re.DOTALL | re.MULTILINE
    )
    descriptions: dict[str, str] = {}
    for names, lines in re.findall(
        r"^(\w+(?:, \w+)*) : .*\n((?:[ \t]+.*(?:\n|\Z)|\n)+)",
        section[1] if section else "",
        re.MULTILINE,
    ):
        descriptions |= dict.fromkeys(names.split(", "), " ".join(lines.split()))
    return descriptions


def table_of(
    kind: str, maker: Any, base: type[Table], own: Mapping[str, Any] | None = None
) -> type[Any]:
    """Return the table of what a callable makes, with a key for each of its parameters.

    A parameter is a number where `own` has no other type for it.
    """
    descriptions = described(maker)
    fields: dict[str, Any] = {
        "kind": (Literal[kind], Field(description="Kind, which decides on the other keys."))
    }
    for one in inspect.signature(maker).parameters.values():
        hint, description = (own or {}).get(one.name, Number), descriptions.get(one.name)
        if one.default is one.empty:
            fields[one.name] = (hint, Field(description=description))
        else:
            hint = hint | None if one.default is None else hint
            fields[one.name] = (hint, Field(default=one.default, description=description))
    summary = inspect.cleandoc(maker.__doc__ or "").partition("\n")[0]
    name = kind.title().replace("_", "") + base.__name__
    table: type[Any] = create_model(name, __base__=base, __doc__=summary, **fields)
    return table
