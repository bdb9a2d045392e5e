"""Foundations of the tables of case files: types of values with their words, and descriptions."""

from __future__ import annotations

import inspect
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, PositiveInt, create_model


@dataclass(frozen=True)
class Words:
    """Words for a type of values, in the reference and in errors."""

    text: str


Number = Annotated[FiniteFloat, Words("a finite number")]
Count = Annotated[PositiveInt, Words("an integer above 0")]
Text = Annotated[str, Words("a text")]
Numbers = Annotated[list[FiniteFloat], Words("a list of finite numbers")]
Pair = Annotated[
    list[FiniteFloat], Field(min_length=2, max_length=2), Words("a pair of finite numbers")
]
Counts = Annotated[
    list[PositiveInt], Field(min_length=2, max_length=2), Words("a pair of integers above 0")
]

Flags = Annotated[list[bool], Field(min_length=2, max_length=2), Words("a pair of true or false")]


class Table(BaseModel):
    """A table with the named keys and no others."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


def described(thing: Any) -> dict[str, str]:
    """Return the descriptions of the parameters in a NumPy-style docstring, by name."""
    text = inspect.cleandoc(thing.__doc__ or "")
    section = re.search(
        r"^Parameters\n-+\n(.*?)(?:\n\n\w+\n-+\n|\Z)", text, re.DOTALL | re.MULTILINE
    )
    found: dict[str, str] = {}
    for names, lines in re.findall(
        r"^(\w+(?:, \w+)*) : .*\n((?:[ \t]+.*(?:\n|\Z)|\n)+)",
        section[1] if section else "",
        re.MULTILINE,
    ):
        found |= dict.fromkeys(names.split(", "), " ".join(lines.split()))
    return found


def table_of(
    kind: str, maker: Any, base: type[Table], own: Mapping[str, Any] | None = None
) -> type[Any]:
    """Return the table of what a callable makes, with a key for each of its parameters.

    A parameter is a number where `own` has no other type for it.
    """
    told = described(maker)
    fields: dict[str, Any] = {
        "kind": (Literal[kind], Field(description="Kind, which decides on the other keys."))
    }
    for one in inspect.signature(maker).parameters.values():
        hint, description = (own or {}).get(one.name, Number), told.get(one.name)
        if one.default is one.empty:
            fields[one.name] = (hint, Field(description=description))
        else:
            hint = hint | None if one.default is None else hint
            fields[one.name] = (hint, Field(default=one.default, description=description))
    summary = inspect.cleandoc(maker.__doc__ or "").partition("\n")[0]
    name = kind.title().replace("_", "") + base.__name__
    made: type[Any] = create_model(name, __base__=base, __doc__=summary, **fields)
    return made
