"""What all results have in common: plain data, equality, pickles.

A result is a frozen dataclass. What the compiled module computes it hands over as fields, with
bodies, grids and arrays apart, and checks again where it is read from a file, as JSON text. The
fields of other results are checked by their annotations.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterable, Mapping
from types import NoneType
from typing import (
    Any,
    ClassVar,
    Literal,
    Protocol,
    Self,
    TypeVar,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre.results import display, values
from nacre.results.quantities import Declared


class Tangential(Protocol):
    """A contact with friction."""

    @property
    def shift(self) -> tuple[float, float] | None:
        """Shift in sliding; None in rolling."""

    @property
    def grid(self) -> core.Grid:
        """Grid."""


FrictionContact = TypeVar("FrictionContact", bound=Tangential)


def _plain(value: object) -> object:
    """Return a field as plain data: arrays stay, and a result in it is its fields."""
    if isinstance(value, np.ndarray):
        return value
    if isinstance(value, Result):
        return value._state()
    if isinstance(value, list):
        return [_plain(item) for item in value]
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    return values.encode(value)


def same(first: object, second: object) -> bool:
    """Return whether plain data are equal but for the seconds that a solve took.

    In arrays, NaN is equal to NaN.
    """
    if isinstance(first, dict) and isinstance(second, dict):
        keys = first.keys() - {"seconds"}
        return first.keys() == second.keys() and all(same(first[key], second[key]) for key in keys)
    if isinstance(first, np.ndarray) and isinstance(second, np.ndarray):
        return np.array_equal(first, second, equal_nan=True)
    return type(first) is type(second) and bool(first == second)


def has_friction(solution: object) -> bool:
    """Return whether this is a contact with friction."""
    return type(solution) is values.RESULTS.get("FrictionSolution")


def checked(solutions: Iterable[FrictionContact]) -> list[FrictionContact]:
    """Return solutions as a list, with one of them at least, and all of one kind.

    Raises
    ------
    TypeError
        If they are no sequence of FrictionSolution.
    ValueError
        If there is none, or some slide and some roll, or some are line contacts.
    """
    contacts = list(solutions) if isinstance(solutions, Iterable) else None
    if contacts is None or not all(map(has_friction, contacts)):
        raise TypeError(f"solutions must be a sequence of FrictionSolution, got {solutions!r}")
    if not contacts:
        raise ValueError("solutions must hold at least one solution, got none")
    if len({(s.shift is None, s.grid.is_line) for s in contacts}) > 1:
        raise ValueError(
            "solutions must all slide or all roll, in line contact or not, got some of each"
        )
    if len({(s.grid.shape, s.grid.size, s.grid.center) for s in contacts}) > 1:
        raise ValueError("solutions must be on one grid, got some on others")
    return contacts


def _finite(value: object) -> object:
    """Return plain data with None in place of infinite numbers, of which JSON has none."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def as_text(kind: str, state: Mapping[str, object], *, infinite: bool = False) -> str:
    """Return the state of a kind of result as JSON text, or raise a `ValueError`.

    JSON has no infinite numbers: they are refused, or null where they may be.
    """
    fields = []
    for key, value in state.items():
        plain = _finite(value) if infinite else value
        try:
            fields.append(f"{json.dumps(key)}: {json.dumps(plain, allow_nan=False)}")
        except (TypeError, ValueError) as error:
            message = f'{kind}: the value of the key "{key}" does not fit: {plain!r}'
            raise ValueError(message) from error
    return "{" + ", ".join(fields) + "}"


def _fitted(kind: object, value: object) -> object:
    """Return plain data as a value of the type of a field, or raise a `TypeError`."""
    origin, types = get_origin(kind), get_args(kind)
    if NoneType in types and origin is not tuple:  # a type or None
        return None if value is None else _fitted(types[0], value)
    if origin is Literal and any(same(value, word) for word in types):
        return value
    if origin is tuple and isinstance(value, list | tuple):
        kinds = types[:1] * len(value) if types[1:] == (...,) else types
        if len(kinds) == len(value):
            return tuple(map(_fitted, kinds, value))
    if origin is dict and isinstance(value, dict):
        return {_fitted(types[0], key): _fitted(types[1], item) for key, item in value.items()}
    if origin is np.ndarray and isinstance(value, list | np.ndarray):
        return np.asarray(value, dtype=float)
    if kind is core.Grid and type(grid := values.decode(value)) is core.Grid:
        return grid
    if kind is float and type(value) is int:
        return float(value)
    if kind in (bool, int, float, str) and type(value) is kind:
        return value
    raise TypeError(f"{value!r} is no {kind}")


class Fields:
    """Base of what is read by its fields: NumPy makes no array of it, notebooks show a table."""

    _QUANTITIES = Declared()
    """Quantities that the class declares."""

    def _repr_html_(self) -> str:
        units = {row.path or row.name: row.unit for row in self._QUANTITIES}
        rows = [(row.label, row.text) for row in display.fields(self, units)]
        return display.markup(rows, getattr(self, "warnings", ()))

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.object_]:
        """Raise a `TypeError` that names a field; arrays of objects hold the whole."""
        if dtype is not None and np.dtype(dtype) == object:
            whole = np.empty((), dtype=object)
            whole[()] = self
            return whole
        names = [name for name in dir(self) if not name.startswith("_")]
        fields = [name for name in names if not callable(getattr(type(self), name, None))]
        first = min((name for name in names if "pressure" in name), key=len, default=fields[0])
        raise TypeError(
            f"an array must be made of a field of a {type(self).__name__}, such as {first}, "
            "got the whole"
        )


@dataclasses.dataclass(frozen=True)
class WarningReport:
    """Report of a result that no iteration ends: what was warned of."""

    warnings: tuple[str, ...]
    """Warnings about the result; each was also issued as a `nacre.NacreWarning`."""


class Warned(Fields):
    """Base of results that have no report of an iteration, but their own warnings."""

    warnings: Any

    @property
    def report(self) -> WarningReport:
        """Report, whose ``warnings`` are those of this result, as of every other one."""
        return WarningReport(tuple(self.warnings))


class Result(Fields):
    """Base of results: each is a dataclass whose fields are its state."""

    _COMPILED: ClassVar[bool] = False
    """Whether the compiled module makes the result, and checks its state."""
    _DERIVED: ClassVar[tuple[str, ...]] = ()
    """Fields that are no part of the state, but follow from it."""
    _LATER: ClassVar[tuple[str, ...]] = ()
    """Fields that states of format 1 did not have at first; without them they are None."""

    def __init_subclass__(cls, *, is_base: bool = False) -> None:
        """Make the class known to files and studies by its name, unless it is a base of others."""
        if not is_base and not cls.__name__.startswith("_"):
            values.RESULTS[cls.__name__] = cls

    @classmethod
    def _names(cls) -> list[str]:
        """Return the names in the state."""
        fields = dataclasses.fields(cls)  # type: ignore[arg-type]
        return [field.name for field in fields if field.name not in cls._DERIVED]

    @classmethod
    def _from_fields(cls, fields: dict[str, Any]) -> Self:
        """Return the result that fields of the compiled module describe."""
        return cls(**fields)

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

    def _state(self) -> dict[str, object]:
        """Return the state as plain data."""
        return {name: _plain(getattr(self, name)) for name in self._names()}

    @classmethod
    def from_dict(cls, data: Mapping[str, object]) -> Self:
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
        return cls._restored(values.checked_state(data, cls.__name__, cls._names(), cls._LATER))

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        """Return the result with these fields, checked."""
        name = cls.__name__
        if cls._COMPILED:
            return cls._from_fields(core.checked(name, as_text(name, state, infinite=True)))
        return cls(**cls._checked(state))

    @classmethod
    def _checked(cls, state: dict[str, object]) -> dict[str, Any]:
        """Return these fields, checked by their annotations."""
        kinds, fields = get_type_hints(cls), {}
        for key, value in state.items():
            try:
                fields[key] = _fitted(kinds[key], value)
            except TypeError as error:
                message = f'{cls.__name__}: the value of the key "{key}" does not fit: {value!r}'
                raise ValueError(message) from error
        return fields

    def __reduce__(self) -> tuple[object, tuple[dict[str, object]]]:
        """Return the function and the state that make the result again."""
        return values.decode, (self.to_dict(),)
