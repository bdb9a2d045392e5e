"""Depth, force and time among the columns of a table, in SI units."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.arguments import name_or_number
from nacre._tools.notices import warn
from nacre._tools.text import Column, listed, unit_of
from nacre.indent._text import Table

Array = npt.NDArray[np.float64]

DIMENSIONS = {"depth": "m", "force": "N", "time": "s"}
"""Quantities of a curve, which are keywords of `read`, and their SI units."""
UNIT_NAMES = {"m": "length", "N": "force", "s": "time"}
NAMES = {
    "depth": (
        *("depth", "displacement", "indentation", "penetration", "disp", "displ"),
        *("eindringtiefe", "tiefe", "profondeur", "profundidad", "profondità", "h"),
    ),
    "force": ("force", "load", "prüfkraft", "kraft", "last", "fuerza", "carga", "forza", "f", "p"),
    "time": ("time", "zeit", "temps", "tiempo", "tempo", "t"),
}
"""Names of columns in small letters, the best first. The words among them may be part of a name."""
BESIDE = frozenset(
    "act actual applied appliquée aplicada applicata average corr corrected corrigée corregida "
    "d da de del della des di du fn in ind indent indenter into korr korrigiert "
    "korrigierte mean measured normal normale of on penetración penetrazione probe "
    "pénétration sample surface test the tip vertical".split()
)
"""Words that leave a quantity what it is; beside any other, such as plastic, none is certain."""
SECOND = frozenset({"act", "actual", "average", "mean"})
"""Words of names that give way to a name without them."""
HEIGHT = frozenset({"height", "z", "piezo"})
"""First words of the height of a cantilever's base, which falls as the tip goes in."""
FEW = 20
"""Most columns that a message lists; of more, it lists the likely ones."""


def quantities(
    where: str,
    table: Table,
    choices: Mapping[str, str | int | None],
    units: Mapping[str, str],
    spring_constant: float | None,
) -> tuple[Array, Array, Array | None]:
    """Return depth [m], force [N] and, if the table has it, time [s].

    `where` names the file in messages; the others are keywords of `read`. With a spring constant,
    the column of the depth is the height of a cantilever's base.
    """
    if spring_constant is not None and choices["depth"] is None:
        choices = {**choices, "depth": _height(where, table)}
    columns = {
        quantity: _signed_column(where, table, quantity, choice)
        for quantity, choice in choices.items()
    }
    rows = _row_count(table, [index for _, index in columns.values() if index is not None])
    by_quantity: dict[str, Array | None] = {}
    for quantity, (sign, index) in columns.items():
        by_quantity[quantity] = None
        if index is not None:
            size = sign * _unit(where, table, quantity, index, units)
            by_quantity[quantity] = size * _values(where, table, quantity, index, rows)
    depth, force, time = (by_quantity[quantity] for quantity in DIMENSIONS)
    assert depth is not None
    assert force is not None
    if spring_constant is not None:
        depth = -(depth + force / spring_constant)
    if time is not None and choices["time"] is None and (np.diff(time) < 0).any():
        warn(f"the time of {where} was left out, since it falls; time= can choose another column")
        time = None
    return depth, force, time


def _row_count(table: Table, columns: Sequence[int]) -> int:
    """Return the number of rows up to the last that is not blank in all of these columns."""
    rows = len(table.rows)
    while rows > 0 and not any(table.rows[rows - 1][index] for index in columns):
        rows -= 1
    return rows


def has_curve(table: Table, choices: Mapping[str, str | int | None], is_spring: bool) -> bool:
    """Return whether a table has a depth and a force."""
    try:
        if is_spring and choices["depth"] is None:
            _height("", table)  # raises an error where there is none
        else:
            _signed_column("", table, "depth", choices["depth"])
        _signed_column("", table, "force", choices["force"])
    except ValueError:
        return False
    return True


def _height(where: str, table: Table) -> int:
    """Return the column of the height of a cantilever's base, the measured one if there are two."""
    words = [re.findall(r"[^\W\d_]+", column.name.lower()) for column in table.columns]
    hits = [k for k, name in enumerate(words) if name and name[0] in HEIGHT]
    hits = [k for k in hits if BESIDE | HEIGHT >= {*words[k]}]
    hits = [k for k in hits if "measured" in words[k]] or hits
    if len(hits) == 1:
        return hits[0]
    listing = _column_listing(where, table, "depth")
    raise ValueError(f"depth must be given, as the column of the height: {listing}")


def _signed_column(
    where: str, table: Table, quantity: str, choice: str | int | None
) -> tuple[float, int | None]:
    """Return the sign and the number of a quantity's column; none only for a time."""
    if choice is None:
        index = _named_column(where, table, quantity)
        if index is None and quantity != "time":
            first = [column.name.lower().split()[:1] for column in table.columns]
            hint = ""
            if quantity == "depth" and any(HEIGHT & set(words) for words in first):
                hint = "; spring_constant= in N/m makes it of a height and the force"
            raise ValueError(
                f"{quantity} must be given: {_column_listing(where, table, quantity)}{hint}"
            )
        return 1.0, index
    if isinstance(choice, str) and choice.startswith("-"):
        return -1.0, _column_index(where, table, quantity, choice[1:].strip())
    return 1.0, _column_index(where, table, quantity, choice)


def _plain(name: str) -> str:
    return re.sub(r"[\W_]+", "", name.lower())


def _named_column(where: str, table: Table, quantity: str) -> int | None:
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
                f"{table.columns[hits[0]].name!r}; {_column_listing(where, table, quantity)}"
            )
        if hits:
            return hits[0]
    known = {name for name in NAMES[quantity] if len(name) > 1}
    usual = BESIDE.union(NAMES[quantity])
    words = {i: set(re.findall(r"[^\W\d_]+", column.name.lower())) for i, column in columns}
    hits = [i for i, column in columns if column.unit and known & words[i] and words[i] <= usual]
    if len(hits) > 1:
        hits = [i for i in hits if not SECOND & words[i]]
    return hits[0] if len(hits) == 1 else None


def _column_index(where: str, table: Table, quantity: str, choice: str | int) -> int:
    choice = name_or_number(quantity, choice)
    if isinstance(choice, int):
        if 0 <= choice < table.width:
            return choice
    else:
        spellings = [(column.heading, column.name) for column in table.columns]
        plain = [tuple(map(_plain, names)) for names in spellings]
        for name, columns in ((choice, spellings), (_plain(choice), plain)):
            hits = [i for i, names in enumerate(columns) if name and name in names]
            if len(hits) == 1:
                return hits[0]
        if choice.isdecimal() and int(choice) < table.width:  # "-3" has the sign of its own
            return int(choice)
    listing = _column_listing(where, table, quantity)
    raise ValueError(f"{quantity} must name one column, got {choice!r}: {listing}")


def _unit(where: str, table: Table, quantity: str, index: int, units: Mapping[str, str]) -> float:
    """Return the unit of a column in SI."""
    column = table.columns[index]
    kind = UNIT_NAMES[DIMENSIONS[quantity]]
    unit_name = units.get(quantity, column.unit or ("s" if quantity == "time" else None))
    label = repr(column.heading[:60]) if column.heading else f"column {index}"
    if unit_name is None:
        raise ValueError(
            f"units must be given: {where} names no unit of {kind} for {label}, such as "
            f"units={{'depth': 'nm', 'force': 'mN'}}"
        )
    unit = unit_of(unit_name)
    if unit is None or unit[0] != DIMENSIONS[quantity]:
        raise ValueError(
            f"{quantity} must have a unit of {kind}, got {unit_name!r} for {label} of {where}"
        )
    return unit[1]


def _column_listing(where: str, table: Table, quantity: str) -> str:
    """Return a sentence that lists the columns, and how to choose one."""
    if not any(column.heading for column in table.columns):
        first = ", ".join(table.rows[0])[:200]
        above = f" below the line {table.above[:60]!r}" if table.above else ""
        return (
            f"the {table.width} columns of {where} have no names; their first row is {first} "
            f"(line {table.lines[0]}{above}). Give depth=, force= and, for a time, time= as "
            f"numbers from 0, and units={{'depth': 'nm', 'force': 'mN'}}"
        )
    columns = list(enumerate(table.columns))
    which = "the columns"
    if table.width > FEW:
        likely = [(i, column) for i, column in columns if _is_likely(column, quantity)][:FEW]
        columns = likely or columns[:FEW]
        which = f"{table.width} columns, {'likely ' if likely else ''}among them"
    names = ", ".join(f"{i} {c.heading[:60]!r}" for i, c in columns)[:1000]
    return f"{where} has {which} {names}; give {quantity}= a name or a number"


def _is_likely(column: Column, quantity: str) -> bool:
    """Return whether a column has the unit of a quantity, or a name with a word for it."""
    unit = unit_of(column.unit or "")
    words = set(re.findall(r"[^\W\d_]+", column.name.lower()))
    if unit is not None:
        return unit[0] == DIMENSIONS[quantity]
    return bool(words & {*NAMES[quantity], *(HEIGHT if quantity == "depth" else ())})


def _values(where: str, table: Table, quantity: str, index: int, rows: int) -> Array:
    """Return the first numbers of a column, all of which must be finite."""
    values = np.empty(rows)
    for row, line in enumerate(table.lines[:rows]):
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
    where: str,
    tables: Sequence[Table],
    segment: int | str | None,
    has_curve: Callable[[Table], bool],
) -> Mapping[int, Table]:
    """Return the tables that the keyword `segment` of `read` asks for, by number.

    Of several, those without a depth or a force are left out where none is asked for by number.
    """
    if segment is not None and segment != "all":
        try:
            segment = core.integer("segment", segment)
        except TypeError:
            raise TypeError(f"segment must be a number or 'all', got {segment!r}") from None
    if len(tables) == 1 and segment in (None, "all"):
        segments = _segments(tables[0]) if segment else []
        return dict(enumerate(segments or tables))
    if len(tables) == 1 and (segments := _segments(tables[0])):
        tables = segments
    if isinstance(segment, int):
        if 0 <= segment < len(tables):
            return {segment: tables[segment]}
    else:
        curves = {number: table for number, table in enumerate(tables) if has_curve(table)}
        if segment == "all":
            return curves or dict(enumerate(tables))
        if len(curves) == 1:
            return curves
    listing = listed(
        [
            f"{number} {f'{table.title[:60]!r} ' if table.title else ''}({len(table.rows)} rows "
            f"from line {table.lines[0]})"
            for number, table in enumerate(tables)
        ]
    )
    requirement = "given" if segment is None else f"one of the file's, got {segment}"
    raise ValueError(
        f"segment must be {requirement}: {where} has {len(tables)} tables, {listing}; 'all' gives "
        "a list"
    )


def _segments(table: Table) -> list[Table]:
    """Return the parts of a table that a column of segments tells apart by text or number."""
    for index, column in enumerate(table.columns):
        labels = [row[index] for row in table.rows]
        changes = sum(before != after for before, after in pairwise(labels))
        kinds = list(dict.fromkeys(labels))
        if _plain(column.name) != "segment" or len(kinds) < 2 or not all(kinds):
            continue
        if changes != len(kinds) - 1:  # a segment comes again
            continue
        segments = []
        for label in kinds:
            indices = [k for k, text in enumerate(labels) if text == label]
            rows, lines = [table.rows[k] for k in indices], [table.lines[k] for k in indices]
            segments.append(replace(table, rows=rows, lines=lines, title=label))
        return segments
    return []
