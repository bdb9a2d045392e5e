"""Arguments of Python functions, read as those of the compiled module are."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

import nacre._core as core

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def read_fields(frozen: DataclassInstance) -> None:
    """Make the numbers of a new, frozen dataclass those of Python, or raise an error.

    NumPy's numbers and whole floats become `int` and `float`, and pairs of them tuples. A class of
    floats that is no NumPy's, as that of numbers that follow from others, stays.
    """
    for field in dataclasses.fields(frozen):
        name, kind = field.name, str(field.type).removesuffix(" | None")
        value = vars(frozen)[name]  # an attribute may follow where there is no argument
        own = isinstance(value, float) and not isinstance(value, np.generic)
        if value is None or (kind == "float" and own):
            continue
        if kind == "int":
            object.__setattr__(frozen, name, core.integer(name, value))
        elif kind == "float":
            object.__setattr__(frozen, name, core.real(name, value))
        elif kind.startswith("tuple[float"):
            object.__setattr__(frozen, name, tuple(core.vector(name, 2, value)))


def name_or_number(name: str, value: object) -> str | int:
    """Return the name or the number of a part of a file, or raise a `TypeError`."""
    if isinstance(value, str):
        return value
    try:
        return core.integer(name, value)
    except TypeError:
        raise TypeError(f"{name} must be a name or a number, got {value!r}") from None


def keywords_of(function: Callable[..., object]) -> set[str]:
    """Return the names of the arguments that a function takes by name only."""
    parameters = inspect.signature(function).parameters.values()
    return {parameter.name for parameter in parameters if parameter.kind is parameter.KEYWORD_ONLY}
