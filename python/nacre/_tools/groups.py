"""Keywords in groups: each is declared once, with its type, its default and its SI unit."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import re
from collections.abc import Callable, Mapping, Sequence
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
    return dataclasses.field(default=default, metadata=in_unit(unit, line))


def in_unit(unit: str, line: str | None = None) -> dict[str, tuple[str, str]]:
    """Return the metadata of a dataclass field that is a number in an SI unit."""
    return {"unit": (unit, unit if line is None else line)}


def with_units(**units: str) -> Callable[[F], F]:
    """Return a decorator that gives arguments of a function, whose signature is its own, units."""

    def decorate(function: F) -> F:
        function.units = units  # type: ignore[attr-defined]
        return function

    return decorate


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


def keyword_units(*declared: Any, line: bool = False) -> dict[str, str]:
    """Return the SI units of arguments, by name, as groups, dataclasses and functions declare them.

    "" is that of a keyword of a group that has none.
    """
    units: dict[str, str] = {}
    for declaration in declared:
        units |= keyword_units(*getattr(declaration, "groups", ()), line=line)
        units |= getattr(declaration, "units", {})
        is_dataclass = dataclasses.is_dataclass(declaration)
        for field in dataclasses.fields(declaration) if is_dataclass else ():
            default = inspect.getattr_static(declaration, field.name, None)
            unit = field.metadata.get("unit", getattr(default, "unit", None))
            if unit is not None:
                units[field.name] = unit[line]
    return units


UNEXPECTED = re.compile(r"unexpected keyword argument '(\w+)'")


def _called(function: Callable[..., object], values: Sequence[object]) -> str:
    """Return the name that users know: that of a method has the class of its object."""
    of, _, name = function.__qualname__.rpartition(".")
    return f"{type(values[0]).__name__}.{name}" if of and values else function.__qualname__


def names_itself(function: F) -> F:
    """Decorate a function that passes keywords on: an error about an unknown one names it."""

    @functools.wraps(function)
    def call(*values: Any, **keywords: Any) -> Any:
        try:
            return function(*values, **keywords)
        except (AttributeError, TypeError) as error:  # Matplotlib's are of attributes
            unknown = UNEXPECTED.search(str(error))
            if unknown is None or unknown[1] not in keywords:
                raise
            words = str(error)[unknown.start() :]
            raise TypeError(f"{_called(function, values)}() got an {words}") from None

    return call  # type: ignore[return-value]


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
                raise TypeError(f"{_called(function, values)}() {error}") from None
            return function(*values, **keywords)

        call.__signature__ = signature  # type: ignore[attr-defined]
        call.groups = groups  # type: ignore[attr-defined]
        call.__annotations__ = hints
        return call  # type: ignore[return-value]

    return decorate
