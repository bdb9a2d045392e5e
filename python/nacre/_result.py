"""What all results have in common: plain data, equality, pickles.

A result is a frozen dataclass. The compiled module hands it over as JSON text, with bodies, grids
and arrays apart, and checks it again where it is read from a file.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from typing import Any, Self

import nacre._core as core
from nacre import values


def tuples(value: Any) -> Any:
    """Return plain data with tuples in place of lists."""
    if isinstance(value, list):
        return tuple(tuples(item) for item in value)
    if isinstance(value, dict):
        return {key: tuples(item) for key, item in value.items()}
    return value


def as_text(kind: str, state: dict[str, Any]) -> str:
    """Return the state of a kind of result as JSON text, or raise a `ValueError`."""
    try:
        return json.dumps(state)
    except TypeError as error:
        raise ValueError(f"{kind}: {error}: {state}") from error


class Result:
    """Base of results: each is a dataclass whose fields are its state."""

    def __init_subclass__(cls) -> None:
        """Make the class known to files and studies by its name."""
        values.RESULTS[cls.__name__] = cls

    @classmethod
    def _made(cls, text: str) -> Self:
        """Return the result that JSON text of the compiled module describes."""
        return cls(**tuples(json.loads(text)))

    def to_dict(self) -> dict[str, Any]:
        """Named state, as plain data: numbers, text, lists, dictionaries and NumPy arrays.

        Returns
        -------
        dict
            Fields by name. ``format`` is the number of the format, ``nacre`` the version that
            wrote it and ``kind`` the class. Bodies and grids stand in it as the calls that make
            them.
        """
        return values.heading(type(self).__name__) | self._state()

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Value whose named state `to_dict` returned, to the bit.

        Parameters
        ----------
        data : dict
            Named state; lists may stand for arrays, as in JSON.

        Returns
        -------
        object
            Value of this class.

        Raises
        ------
        ValueError
            If the format is newer than this version, or a key is missing, unknown or holds a
            wrong value.
        """
        return cls._restored(values.checked_state(data, cls.__name__, cls._names()))

    @classmethod
    def _names(cls) -> list[str]:
        """Return the names in the state."""
        return [field.name for field in dataclasses.fields(cls)]  # type: ignore[arg-type]

    def _state(self) -> dict[str, Any]:
        """Return the state as plain data."""
        return {name: values.encode(getattr(self, name)) for name in self._names()}

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        """Return the result with these fields, which the compiled module checks."""
        return cls._made(core.checked(cls.__name__, as_text(cls.__name__, state)))

    def __reduce__(self) -> tuple[Any, tuple[dict[str, Any]]]:
        """Return the function and the state that make the result again."""
        return type(self).from_dict, (self.to_dict(),)
