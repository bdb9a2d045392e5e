"""Depth, force and time among the columns of a table, in SI units."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre.indent._text import Table, unit_of

Array = npt.NDArray[np.float64]

DIMENSIONS = {"depth": "m", "force": "N", "time": "s"}
"""Quantities of a curve, which are keywords of `read`, and their SI units."""
UNIT_NAMES = {"m": "length", "N": "force", "s": "time"}
NAMES = {
    "depth": ("depth", "displacement", "indentation", "penetration", "h"),
    "force": ("force", "load", "f", "p"),
    "time": ("time", "t"),
}
"""Names of columns in small letters, the best first. The words among them may be part of a name."""


def quantities(
    where: str,
    table: Table,
    asked: Mapping[str, str | int | None],
    units: Mapping[str, str],
) -> tuple[Array, Array, Array | None]:
    """Return depth [m], force [N] and, if the table has it, time [s].

    `where` names the file in messages; `asked` and `units` are keywords of `read`.
    """
    found: dict[str, Array | None] = {}
    for quantity, column in asked.items():
        sign, index = _chosen(where, table, quantity, column)
        found[quantity] = None
        if index is not None:
            size = sign * _unit(where, table, quantity, index, units)
            found[quantity] = size * _values(where, table, quantity, index)
    depth, force, time = (found[quantity] for quantity in DIMENSIONS)
    assert depth is not None
    assert force is not None
    if time is not None and asked["time"] is None and (np.diff(time) < 0).any():
        warnings.warn(
            f"the time of {where} was left out, since it falls; time= can choose another column",
            core.NacreWarning,
            stacklevel=3,
        )
        time = None
    return depth, force, time


def _chosen(
    where: str, table: Table, quantity: str, asked: str | int | None
) -> tuple[float, int | None]:
    """Return the sign and the number of a quantity's column; none only for a time."""
    if asked is None:
        index = _known(where, table, quantity)
        if index is None and quantity != "time":
            raise ValueError(f"{quantity} must be given: {_listed(where, table, quantity)}")
        return 1.0, index
    if isinstance(asked, str) and asked.startswith("-"):
        return -1.0, _asked(where, table, quantity, asked[1:].strip())
    return 1.0, _asked(where, table, quantity, asked)


def _plain(name: str) -> str:
    return re.sub(r"[\W_]+", "", name.lower())


def _known(where: str, table: Table, quantity: str) -> int | None:
    """Return the column whose name is known, or None; several of the best name are an error."""
    columns = [
        (index, column)
        for index, column in enumerate(table.columns)
        if column.unit is None or (unit_of(column.unit) or ("",))[0] == DIMENSIONS[quantity]
    ]
    for name in NAMES[quantity]:
        hits = [index for index, column in columns if _plain(column.name) == name]
        if len(hits) > 1:
            raise ValueError(
                f"{quantity} must be given: {len(hits)} columns have the name "
                f"{table.columns[hits[0]].name!r}; {_listed(where, table, quantity)}"
            )
        if hits:
            return hits[0]
    known = {name for name in NAMES[quantity] if len(name) > 1}
    hits = [
        index
        for index, column in columns
        if column.unit and known & set(re.findall(r"[^\W\d_]+", column.name.lower()))
    ]
    return hits[0] if len(hits) == 1 else None


def _asked(where: str, table: Table, quantity: str, asked: str | int) -> int:
    if isinstance(asked, bool) or not isinstance(asked, str | int):
        raise TypeError(f"{quantity} must be the name or the number of a column, got {asked!r}")
    if isinstance(asked, int):
        if 0 <= asked < table.width:
            return asked
    else:
        written = [(column.heading, column.name) for column in table.columns]
        plain = [tuple(map(_plain, names)) for names in written]
        for wanted, columns in ((asked, written), (_plain(asked), plain)):
            hits = [i for i, names in enumerate(columns) if wanted and wanted in names]
            if len(hits) == 1:
                return hits[0]
    raise ValueError(
        f"{quantity} must name one column, got {asked!r}: {_listed(where, table, quantity)}"
    )


def _unit(where: str, table: Table, quantity: str, index: int, units: Mapping[str, str]) -> float:
    """Return the unit of a column in SI."""
    column = table.columns[index]
    wanted = UNIT_NAMES[DIMENSIONS[quantity]]
    given = units.get(quantity, column.unit or ("s" if quantity == "time" else None))
    named = repr(column.heading[:60]) if column.heading else f"column {index}"
    if given is None:
        raise ValueError(
            f"units must be given: {where} names no unit of {wanted} for {named}, such as "
            f"units={{'depth': 'nm', 'force': 'mN'}}"
        )
    unit = unit_of(given)
    if unit is None or unit[0] != DIMENSIONS[quantity]:
        raise ValueError(
            f"{quantity} must have a unit of {wanted}, got {given!r} for {named} of {where}"
        )
    return unit[1]


def _listed(where: str, table: Table, quantity: str) -> str:
    """Return a sentence that lists the columns, and how to choose one."""
    if not any(column.heading for column in table.columns):
        first = ", ".join(table.rows[0])[:200]
        above = f" below the line {table.above[:60]!r}" if table.above else ""
        return (
            f"the {table.width} columns of {where} have no names; their first row is {first} "
            f"(line {table.lines[0]}{above}). Give depth=, force= and, for a time, time= as "
            f"numbers from 0, and units={{'depth': 'nm', 'force': 'mN'}}"
        )
    names = ", ".join(f"{i} {c.heading[:60]!r}" for i, c in enumerate(table.columns))[:1000]
    return f"{where} has the columns {names}; give {quantity}= a name or a number"


def _values(where: str, table: Table, quantity: str, index: int) -> Array:
    """Return the numbers of a column, all of which must be finite."""
    values = np.empty(len(table.rows))
    for row, line in enumerate(table.lines):
        value = table.number(row, index)
        if value is None or not np.isfinite(value):
            raise ValueError(
                f"{quantity} must be finite: line {line} of {where} has "
                f"{table.rows[row][index][:60]!r}"
            )
        values[row] = value
    return values


def checked_units(units: Mapping[str, str] | None) -> Mapping[str, str]:
    """Return the keyword `units` of `read`, each unit of which is known."""
    if units is None:
        return {}
    if not isinstance(units, Mapping):
        raise TypeError(f"units must be a dict such as {{'depth': 'nm'}}, got {units!r}")
    for name, unit in units.items():
        known = unit_of(unit) if isinstance(unit, str) else None
        if name not in DIMENSIONS or known is None or known[0] != DIMENSIONS[name]:
            raise ValueError(
                "units must give a length for 'depth', a force for 'force' and a time for 'time', "
                f"got {unit!r} for {name!r}"
            )
    return units


def chosen_tables(
    where: str, found: Sequence[Table], segment: int | str | None
) -> Mapping[int, Table]:
    """Return the tables that the keyword `segment` of `read` asks for, by number."""
    if segment == "all":
        return dict(enumerate(found))
    if isinstance(segment, bool) or not isinstance(segment, int | None):
        raise TypeError(f"segment must be a number or 'all', got {segment!r}")
    if segment is None and len(found) == 1:
        return {0: found[0]}
    if segment is not None and 0 <= segment < len(found):
        return {segment: found[segment]}
    listed = ", ".join(
        f"{number} ({len(table.rows)} rows from line {table.lines[0]})"
        for number, table in enumerate(found)
    )
    requirement = "given" if segment is None else f"one of the file's, got {segment}"
    raise ValueError(
        f"segment must be {requirement}: {where} has {len(found)} tables, {listed}; 'all' gives a "
        "list"
    )
