"""Depth, force and time among the columns of a table, in SI units."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.arguments import name_or_number
from nacre._tools.text import Column, unit_of
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
OTHER_QUANTITIES = frozenset(
    "amp amplitude area cantilever contact creep critical deflection demand dev deviation drift "
    "dyn dynamic elastic error final friction harmonic horizontal initial lateral limit loss max "
    "maximum min minimum modulus motor offset peak piezo plastic rate recovered reference residual "
    "set setpoint shear stage std stiffness storage tangential target thermal threshold transverse "
    "uncorrected yield zero".split()
)
"""Words of names that are another quantity than the depth, the force and the time of each point."""
SECOND = frozenset({"act", "actual", "average", "mean"})
"""Words of names that give way to a name without them."""
HEIGHT = frozenset({"height", "z", "piezo"})
"""First words of the height of a cantilever's base, which falls as the tip goes in."""
FEW = 20
"""Most columns that a message lists; of more, it lists the likely ones."""


def quantities(
    where: str,
    table: Table,
    asked: Mapping[str, str | int | None],
    units: Mapping[str, str],
    spring_constant: float | None,
) -> tuple[Array, Array, Array | None]:
    """Return depth [m], force [N] and, if the table has it, time [s].

    `where` names the file in messages; the others are keywords of `read`. With a spring constant,
    the column of the depth is the height of a cantilever's base.
    """
    if spring_constant is not None and asked["depth"] is None:
        asked = {**asked, "depth": _height(where, table)}
    chosen = {quantity: _chosen(where, table, quantity, one) for quantity, one in asked.items()}
    rows = _filled(table, [index for _, index in chosen.values() if index is not None])
    found: dict[str, Array | None] = {}
    for quantity, (sign, index) in chosen.items():
        found[quantity] = None
        if index is not None:
            size = sign * _unit(where, table, quantity, index, units)
            found[quantity] = size * _values(where, table, quantity, index, rows)
    depth, force, time = (found[quantity] for quantity in DIMENSIONS)
    assert depth is not None
    assert force is not None
    if spring_constant is not None:
        depth = -(depth + force / spring_constant)
    if time is not None and asked["time"] is None and (np.diff(time) < 0).any():
        warnings.warn(
            f"the time of {where} was left out, since it falls; time= can choose another column",
            core.NacreWarning,
            stacklevel=3,
        )
        time = None
    return depth, force, time


def _filled(table: Table, columns: Sequence[int]) -> int:
    """Return the number of rows up to the last that is not blank in all of these columns."""
    rows = len(table.rows)
    while rows > 0 and not any(table.rows[rows - 1][index] for index in columns):
        rows -= 1
    return rows


def has_curve(table: Table, asked: Mapping[str, str | int | None], is_spring: bool) -> bool:
    """Return whether a table has a depth and a force."""
    try:
        if not (is_spring and asked["depth"] is None and _height("", table) is not None):
            _chosen("", table, "depth", asked["depth"])
        _chosen("", table, "force", asked["force"])
    except ValueError:
        return False
    return True


def _height(where: str, table: Table) -> int:
    """Return the column of the height of a cantilever's base, the measured one if there are two."""
    words = [re.findall(r"[^\W\d_]+", column.name.lower()) for column in table.columns]
    hits = [k for k, name in enumerate(words) if name and name[0] in HEIGHT]
    hits = [k for k in hits if "measured" in words[k]] or hits
    if len(hits) == 1:
        return hits[0]
    raise ValueError(
        f"depth must be given, as the column of the height: {_listed(where, table, 'depth')}"
    )


def _chosen(
    where: str, table: Table, quantity: str, asked: str | int | None
) -> tuple[float, int | None]:
    """Return the sign and the number of a quantity's column; none only for a time."""
    if asked is None:
        index = _known(where, table, quantity)
        if index is None and quantity != "time":
            first = [column.name.lower().split()[:1] for column in table.columns]
            hint = ""
            if quantity == "depth" and any(HEIGHT & set(words) for words in first):
                hint = "; spring_constant= in N/m makes it of a height and the force"
            raise ValueError(f"{quantity} must be given: {_listed(where, table, quantity)}{hint}")
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
    words = {i: set(re.findall(r"[^\W\d_]+", column.name.lower())) for i, column in columns}
    hits = [i for i, column in columns if column.unit and known & words[i]]
    hits = [i for i in hits if not OTHER_QUANTITIES & words[i]]
    if len(hits) > 1:
        hits = [i for i in hits if not SECOND & words[i]]
    return hits[0] if len(hits) == 1 else None


def _asked(where: str, table: Table, quantity: str, asked: str | int) -> int:
    asked = name_or_number(quantity, asked)
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
        if asked.isdecimal() and int(asked) < table.width:  # "-3" has the sign of its own
            return int(asked)
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
    listed = list(enumerate(table.columns))
    which = "the columns"
    if table.width > FEW:
        likely = [(i, column) for i, column in listed if _is_likely(column, quantity)][:FEW]
        listed = likely or listed[:FEW]
        which = f"{table.width} columns, {'likely ' if likely else ''}among them"
    names = ", ".join(f"{i} {c.heading[:60]!r}" for i, c in listed)[:1000]
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
    found: Sequence[Table],
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
    if len(found) == 1 and segment in (None, "all"):
        parts = _parts(found[0]) if segment else []
        return dict(enumerate(parts or found))
    if len(found) == 1 and (parts := _parts(found[0])):
        found = parts
    if isinstance(segment, int):
        if 0 <= segment < len(found):
            return {segment: found[segment]}
    else:
        curves = {number: table for number, table in enumerate(found) if has_curve(table)}
        if segment == "all":
            return curves or dict(enumerate(found))
        if len(curves) == 1:
            return curves
    listed = ", ".join(
        f"{number} {f'{table.title[:60]!r} ' if table.title else ''}({len(table.rows)} rows from "
        f"line {table.lines[0]})"
        for number, table in enumerate(found)
    )
    requirement = "given" if segment is None else f"one of the file's, got {segment}"
    raise ValueError(
        f"segment must be {requirement}: {where} has {len(found)} tables, {listed}; 'all' gives a "
        "list"
    )


def _parts(table: Table) -> list[Table]:
    """Return the parts of a table that a column of segments tells apart by text or number."""
    for index, column in enumerate(table.columns):
        labels = [row[index] for row in table.rows]
        changes = sum(one != other for one, other in pairwise(labels))
        kinds = list(dict.fromkeys(labels))
        if _plain(column.name) != "segment" or len(kinds) < 2 or not all(kinds):
            continue
        if changes != len(kinds) - 1:  # a segment comes again
            continue
        parts = []
        for label in kinds:
            kept = [k for k, one in enumerate(labels) if one == label]
            rows, lines = [table.rows[k] for k in kept], [table.lines[k] for k in kept]
            parts.append(replace(table, rows=rows, lines=lines, title=label))
        return parts
    return []
