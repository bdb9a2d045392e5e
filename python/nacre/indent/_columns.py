"""Depth, force and time among the columns of a table, in SI units and with nacre's signs."""

from __future__ import annotations

import itertools
import re
import warnings
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre.indent._text import Column, Table, unit_of

Array = npt.NDArray[np.float64]

DIMENSIONS = {"depth": "m", "force": "N", "time": "s"}
"""Quantities of a curve, which are keywords of `read`, and their SI units."""
UNIT_NAMES = {"m": "length", "N": "force", "s": "time"}
INTO = (
    *("displacementintosurface", "indentationdepth", "penetrationdepth", "indentation"),
    *("penetration", "depth", "pd", "h", "displacement", "disp", "eindringtiefe"),
)
"""Names of a depth."""
FALLING = ("verticaltipposition", "tipsampleseparation", "tipposition", "separation")
"""Names of the distance between tip and sample, which is −depth but for its zero."""
HEIGHTS = (
    *("smoothedmeasuredheight", "heightmeasuredsmoothed", "smoothedstraingaugeheight"),
    *("headheightmeasuredsmoothed", "measuredheight", "heightmeasured", "straingaugeheight"),
    *("headheightmeasured", "capacitivesensorheight", "height"),
)
"""Names of the position of a cantilever's base: depth is −(height + force/spring constant)."""
NAMES = {
    "depth": INTO + FALLING + HEIGHTS,
    "force": (
        *("loadonsample", "force", "load", "fn", "f", "p", "normalforce", "normalload"),
        *("vdeflection", "verticaldeflection", "indentload", "kraft", "prüfkraft", "last"),
    ),
    "time": ("seriestime", "timeonsample", "time", "t", "zeit"),
}
"""Names of columns in small letters, without blanks and marks, the best first.

They are those of text exports of KLA, Agilent and MTS (displacement into surface, load on sample),
Bruker and Hysitron (depth, load), Anton Paar and CSM (Pd, Fn), Fischer (h, F), Micro Materials,
Optics11 (indentation, load) and JPK (vertical tip position, vDeflection, heights).
"""
WORDS = {
    "depth": {"depth", "indentation", "displacement", "penetration", "eindringtiefe"},
    "force": {"load", "force", "kraft", "prüfkraft"},
    "time": {"time", "zeit"},
}
"""Words of longer names, such as ``Corrected depth (nm)``, where only one column has one."""
DEEPEST = 0.01
"""Share of the points whose mean force tells the sign of a force: enough to outweigh noise."""


class Chosen(NamedTuple):
    """A column that holds a quantity."""

    place: int
    size: float
    """The column's unit in SI, negative where the sign changes."""
    is_height: bool = False
    """Whether the column is the position of a cantilever's base."""


def quantities(
    where: str,
    group: Sequence[Table],
    asked: Mapping[str, str | int | None],
    units: Mapping[str, str],
) -> tuple[Array, Array, Array | None]:
    """Return depth [m], force [N] and, if all tables have it, time [s] of the tables, joined.

    `where` names the file in messages; `asked` and `units` are keywords of `read`.
    """
    depths, forces, times = [], [], []
    columns = []
    for table in group:
        chosen = {name: _chosen(where, table, name, asked[name], units) for name in DIMENSIONS}
        depth, force, time = chosen["depth"], chosen["force"], chosen["time"]
        assert depth is not None
        assert force is not None
        depths.append(_values(where, table, "depth", depth))
        forces.append(_values(where, table, "force", force))
        times.append(None if time is None else _values(where, table, "time", time))
        columns.append((depth, table.columns[force.place]))
    joined = np.concatenate(forces)
    if asked["force"] is None:
        joined = _pressing(where, np.concatenate(depths), joined, columns[0][1])
    starts = np.cumsum([0, *(part.size for part in depths)])
    for number, (table, (depth, _)) in enumerate(zip(group, columns, strict=True)):
        if depth.is_height:
            part = joined[starts[number] : starts[number + 1]]
            depths[number] = depths[number] - part / _spring_constant(where, table, depth)
    whole = _joined(times)
    if whole is not None and asked["time"] is None and (np.diff(whole) < 0).any():
        warnings.warn(
            f"the time of {where} was left out, since it falls; time= can choose another column",
            core.NacreWarning,
            stacklevel=3,
        )
        whole = None
    return np.concatenate(depths), joined, whole


def _chosen(
    where: str,
    table: Table,
    quantity: str,
    asked: str | int | None,
    units: Mapping[str, str],
) -> Chosen | None:
    """Return the column of a quantity; None only for a time that the table does not have."""
    sign, index = 1.0, None
    if isinstance(asked, str) and asked.startswith("-"):
        sign, asked = -1.0, asked[1:].strip()
    if asked is None:
        index = _known(where, table, quantity)
        if index is None and quantity == "time":
            return None
        if index is None:
            raise ValueError(f"{quantity} must be given: {_listed(where, table, quantity)}")
    else:
        index = _asked(where, table, quantity, asked)
    column = table.columns[index]
    given = units.get(quantity, column.unit)
    if given is None and quantity == "time":
        given = "s"
    if given is None:
        heading = repr(column.heading[:60]) if column.heading else f"column {index}"
        raise ValueError(
            f"units must be given: {where} names no unit of {UNIT_NAMES[DIMENSIONS[quantity]]} for "
            f"{heading}, such as units={{'depth': 'nm', 'force': 'mN'}}"
        )
    unit = unit_of(given)
    if unit is None or unit[0] != DIMENSIONS[quantity]:
        raise ValueError(
            f"{quantity} must have a unit of {UNIT_NAMES[DIMENSIONS[quantity]]}, got {given!r} for "
            f"{column.heading or f'column {index}'!r} of {where}"
        )
    if quantity != "depth" or sign < 0:
        return Chosen(index, sign * unit[1])
    names = {_plain(column.name), _plain(column.also)}
    is_height = not names.isdisjoint(HEIGHTS)
    falls = is_height or not names.isdisjoint(FALLING)
    return Chosen(index, -unit[1] if falls else unit[1], is_height)


def _plain(name: str) -> str:
    return re.sub(r"[\W_]+", "", name.lower())


def _known(where: str, table: Table, quantity: str) -> int | None:
    """Return the column whose name is known, or None; several of the best name are an error."""

    def suits(column: Column) -> bool:
        if column.unit is None:
            return True
        unit = unit_of(column.unit)
        return unit is not None and unit[0] == DIMENSIONS[quantity]

    columns = [(i, column) for i, column in enumerate(table.columns) if suits(column)]
    for name in NAMES[quantity]:
        hits = [i for i, c in columns if name in (_plain(c.name), _plain(c.also))]
        if len(hits) > 1:
            raise ValueError(
                f"{quantity} must be given: {len(hits)} columns have the name "
                f"{table.columns[hits[0]].name!r}; {_listed(where, table, quantity)}"
            )
        if hits:
            return hits[0]
    words = [set(re.findall(r"[^\W\d_]+", column.name.lower())) for _, column in columns]
    hits = [
        i
        for (i, column), said in zip(columns, words, strict=True)
        if column.unit and said & WORDS[quantity]
    ]
    return hits[0] if len(hits) == 1 else None


def _asked(where: str, table: Table, quantity: str, asked: str | int) -> int:
    if isinstance(asked, bool) or not isinstance(asked, str | int):
        raise TypeError(f"{quantity} must be the name or the number of a column, got {asked!r}")
    if isinstance(asked, int):
        if 0 <= asked < table.width:
            return asked
    else:
        written = [(c.heading, c.name, c.also) for c in table.columns]
        plain = [tuple(map(_plain, names)) for names in written]
        for wanted, columns in ((asked, written), (_plain(asked), plain)):
            hits = [i for i, names in enumerate(columns) if wanted and wanted in names]
            if len(hits) == 1:
                return hits[0]
    raise ValueError(
        f"{quantity} must name one column, got {asked!r}: {_listed(where, table, quantity)}"
    )


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


def _values(where: str, table: Table, quantity: str, chosen: Chosen) -> Array:
    """Return a column in SI units; each of its fields must be a finite number."""
    values = np.empty(len(table.rows))
    for row, line in enumerate(table.lines):
        value = table.number(row, chosen.place)
        if value is None or not np.isfinite(value):
            raise ValueError(
                f"{quantity} must be finite: line {line} of {where} has "
                f"{table.rows[row][chosen.place][:60]!r}"
            )
        values[row] = value
    return chosen.size * values


def _spring_constant(where: str, table: Table, depth: Chosen) -> float:
    text = table.said.get("springconstant", "")
    try:
        constant = float(text)
    except ValueError:
        constant = 0.0
    if not 0 < constant < np.inf:
        raise ValueError(
            f"depth must be given: {table.columns[depth.place].heading!r} of {where} is the "
            f"position of the cantilever, and there is no springConstant to find the tip's; "
            f"{_listed(where, table, 'depth')}"
        )
    return constant


def _pressing(where: str, depth: Array, force: Array, column: Column) -> Array:
    """Return a force that is positive in compression, by the force at the greatest depth."""
    deepest = np.argsort(depth, kind="stable")[-max(1, round(DEEPEST * depth.size)) :]
    middle = float(np.median(force))
    down, up = middle - float(force.min()), float(force.max()) - middle
    there = float(force[deepest].mean())
    if there < 0 and middle - there > max(0.5 * down, up):
        warnings.warn(
            f"{column.heading or 'force'!r} of {where} falls to {force.min():.4g} N at the "
            f"greatest depth: its sign was changed, so that compression is positive; "
            f"force='-{column.name}' says so",
            core.NacreWarning,
            stacklevel=4,
        )
        return -force
    return force


def _joined(times: Sequence[Array | None]) -> Array | None:
    """Return the times of segments; one that begins again goes on after the one before."""
    parts: list[Array] = []
    for part in times:
        if part is None:
            return None
        start = parts[-1][-1] if parts and part[0] < parts[-1][-1] else 0.0
        parts.append(part + start)
    return np.concatenate(parts)


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


def title(found: Sequence[Table], table: Table) -> str:
    """Return the name of a table, or else its number."""
    return table.said.get("segment") or str([other is table for other in found].index(True))


def chosen_segments(
    where: str, found: Sequence[Table], segment: int | str | None
) -> Sequence[Sequence[Table]]:
    """Return the tables of each curve that the keyword `segment` of `read` asks for."""
    if segment == "all":
        return [[table] for table in found]
    if isinstance(segment, bool) or not isinstance(segment, int | str | None):
        raise TypeError(f"segment must be a number or a name, got {segment!r}")
    requirement = f"one of the file's, got {segment!r}"
    if segment is None:
        if len(found) == 1 or _is_one_curve(found):
            return [found]
        requirement = "given"
    elif isinstance(segment, int):
        if 0 <= segment < len(found):
            return [[found[segment]]]
    else:
        named = [table for table in found if table.said.get("segment") == segment]
        if len(named) == 1:
            return [named]
    listed = ", ".join(
        f"{title(found, table)} ({len(table.rows)} rows from line {table.lines[0]})"
        for table in found
    )
    raise ValueError(
        f"segment must be {requirement}: {where} has {len(found)} tables, {listed}; their numbers "
        f"are 0 to {len(found) - 1}, and 'all' gives a list"
    )


def _is_one_curve(found: Sequence[Table]) -> bool:
    """Return whether the tables are segments of one curve, numbered as JPK does."""
    numbers = [table.said.get("segmentindex", "") for table in found]
    return all(map(str.isdigit, numbers)) and all(
        int(first) < int(second) for first, second in itertools.pairwise(numbers)
    )
