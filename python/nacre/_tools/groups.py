"""Keywords in groups: each is declared once, with its type, its default and its SI unit."""

from __future__ import annotations

import dataclasses
import functools
import inspect
from collections.abc import Callable, Mapping
from dataclasses import MISSING
from typing import Any, Self, TypeVar, get_type_hints

F = TypeVar("F", bound=Callable[..., Any])


def keyword(unit: str = "", *, line: str | None = None, default: Any = None) -> Any:
    """Return a field of a `Group` that is a keyword.

    Parameters
    ----------
    unit : str
        SI unit; "" where the keyword has none.
    line : str, optional
        SI unit in line contact, where it is another one.
    default
        Default; `dataclasses.MISSING` where the keyword must be given.
    """
    units = {"unit": (unit, unit if line is None else line)}
    return dataclasses.field(default=default, metadata=units)


class Group:
    """Base of frozen dataclasses whose fields made by `keyword` are keywords of functions."""

    @classmethod
    def keywords(cls) -> dict[str, dataclasses.Field[Any]]:
        """Return the fields that are keywords, by name."""
        fields = dataclasses.fields(cls)  # type: ignore[arg-type]
        return {field.name: field for field in fields if "unit" in field.metadata}

    @classmethod
    def of(cls, keywords: Mapping[str, Any], *carried: Any) -> Self:
        """Return the group of its own keywords; `carried` are the fields that are none."""
        own = {name: keywords[name] for name in cls.keywords() if name in keywords}
        return cls(*carried, **own)

    def replaced(self, **fields: Any) -> Self:
        """Return the group with other values, as the compiled module reads them."""
        return dataclasses.replace(self, **fields)  # type: ignore[type-var]


def keyword_units(*groups: type[Group], line: bool = False) -> dict[str, str]:
    """Return the SI units of the keywords of groups, by name; "" where there is none."""
    return {
        name: field.metadata["unit"][line]
        for group in groups
        for name, field in group.keywords().items()
    }


def grouped(*groups: type[Group], leave: tuple[str, ...] = ()) -> Callable[[F], F]:
    """Return a decorator that gives a function the keywords of groups and refuses all others."""

    def decorate(function: F) -> F:
        written = inspect.signature(function)
        own = [p for p in written.parameters.values() if p.kind is not p.VAR_KEYWORD]
        taken = {parameter.name for parameter in own} | {*leave}
        hints, added = dict(function.__annotations__), []
        hints.pop("keywords", None)
        for group in groups:
            types = get_type_hints(group)
            for name, field in group.keywords().items():
                if name in taken:
                    continue
                taken.add(name)
                default = inspect.Parameter.empty if field.default is MISSING else field.default
                added.append(
                    inspect.Parameter(
                        name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=field.type
                    )
                )
                hints[name] = types[name]
        signature = written.replace(parameters=[*own, *added])

        @functools.wraps(function)
        def call(*values: Any, **keywords: Any) -> Any:
            try:
                signature.bind(*values, **keywords)
            except TypeError as error:
                raise TypeError(f"{function.__name__}() {error}") from None
            return function(*values, **keywords)

        call.__signature__ = signature  # type: ignore[attr-defined]
        call.groups = groups  # type: ignore[attr-defined]
        call.__annotations__ = hints
        return call  # type: ignore[return-value]

    return decorate
