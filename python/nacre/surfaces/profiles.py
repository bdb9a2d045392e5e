"""Profiles of rollers, wheels and rails, in text and in files of instruments."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from nacre import _core as core
from nacre._tools.notices import warn
from nacre._tools.text import decoded, is_text
from nacre._tools.typing import Vector
from nacre._tools.units import written
from nacre.surfaces.heights import (
    AXES,
    DROPS,
    LEAST_MEASURED,
    METRES,
    NUMBERED,
    TIMES,
    Table,
    Text,
    first_words,
    is_counter,
    is_doubtful,
    is_strict,
    metres,
    without_sentinels,
)
from nacre.surfaces.scans import scan

Array = npt.NDArray[np.float64]

SIMPACK = (".prr", ".prw")
"""Endings of Simpack's profiles of rails and of wheels."""
IN_BRACKETS = re.compile(r"[(\[{]\s*([^()\[\]{}]+?)\s*[)\]}]\s*$")
"""What ends a heading in brackets: a unit, known or not."""
MINIPROF = (".ban", ".whl")
"""Endings of MiniProf's profiles of rails and of wheels."""
FAR, LEAST_REST = 1000.0, 5
"""Distance of a drop from all others, over their span, from which it is no height, and fewest
others: profiles with a step or a chamfer have other points on it."""


def read_profile(
    path: str | os.PathLike[str],
    *,
    unit: str | tuple[str, str] | None = None,
    x: str | int | None = None,
    drop: str | int | None = None,
    height: str | int | None = None,
    spacing: float | None = None,
    smooth: bool = True,
    corners: Vector | None = None,
    smoothing: float | None = None,
) -> core.SampledProfile:
    r"""Read a measured profile of a roller from a file.

    Lines above the table, names and units of columns, delimiter and decimal mark are found from
    the file, and signs with which a program marks points are skipped. Simpack's profiles of rails
    (``.prr``) and wheels (``.prw``) are known, and MiniProf's (``.ban``, ``.whl``) are in mm. Heads
    of SMD (ISO 5436-2), SDF (ISO 25178-71) and PRF have the spacing and the units. Line scans in
    other files of instruments are read by SurfaceTopography, with ``nacre-contact[surfaces]``.

    Parameters
    ----------
    path : str or path
        Text file with a column of positions, and one of drops or of heights, or with `spacing` of
        drops or heights alone; or a line scan.
    unit : str or pair of str, optional
        Unit of the columns ("um", "mm", ...), or of the positions and of the other column, where
        the file names none. Heights without a unit have that of the positions.
    x : str or int, optional
        Column of the positions: its name or its number from 0. By default the one with the name x,
        or the only one in order.
    drop, height : str or int, optional
        Column of the drops, or of heights, of which the drop is the distance from the highest. By
        default the one with such a name. Of line scans `height` is the channel.
    spacing : float, optional
        Distance between positions [m], in place of a column of positions.
    smooth, corners, smoothing : optional
        How the stations are joined, true edges [m], and a wavelength against noise [m], as those of
        `SampledProfile`.

    Returns
    -------
    SampledProfile
        Positions in ascending order, and drops [m]. Simpack's have the origin of the file.

    Raises
    ------
    ValueError
        If the table, a column or a unit cannot be found, or a position comes twice.
    FileNotFoundError
        If there is no such file.

    Warns
    -----
    NacreWarning
        If points were not measured, and are bridged; if one height is far from all others, as a
        mark of a missing point is; if heights name no unit.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "crown.csv"
    >>> _ = path.write_text("x (mm);drop (um)\n-10;5,0\n0;0,0\n10;5,0\n", encoding="utf-8")
    >>> nacre.SampledProfile.read(path).drop
    array([5.e-06, 0.e+00, 5.e-06])
    """
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{str(path)!r} is not a file")
    if drop is not None and height is not None:
        raise ValueError(
            "drop and height must not both be given: the drop is one below the highest"
        )
    if spacing is not None:
        if x is not None:
            raise ValueError(f"x must be left out where spacing is given, got {x!r}")
        if not 0 < (spacing := core.real("spacing", spacing)) < np.inf:
            raise ValueError(f"spacing must be finite and above 0, got {spacing:g}")
    given = {"unit": unit, "x": x, "drop": drop, "height": height, "spacing": spacing}
    if path.suffix.lower() in SIMPACK:
        places, drops = _simpack(path)
    elif (profile := scan(path)) is not None:
        if wrong := [f"{name}={value!r}" for name, value in given.items() if value is not None]:
            raise ValueError(
                f"{' and '.join(wrong)} must be left out: the head of {str(path)!r} says what its "
                f"numbers are"
            )
        places, drops = profile[0], _depths(profile[1])
    elif is_text(path.read_bytes()):
        places, drops = _table(path, unit, x, drop, height, spacing)
    else:
        places, drops = _scan(path, unit, {k: given[k] for k in ("x", "drop", "spacing")}, height)
    order = np.argsort(places, kind="stable")
    places, drops = _measured_points(path, places[order], drops[order])
    twice = np.flatnonzero(np.diff(places) <= 0)
    if twice.size:
        raise ValueError(
            f"{str(path)!r} must have each position once, {places[twice[0]]:.6g} m comes twice: "
            f"leave out what overhangs"
        )
    return core.SampledProfile(places, drops, smooth, corners, smoothing)


def _table(
    path: Path,
    unit: str | tuple[str, str] | None,
    x: str | int | None,
    drop: str | int | None,
    height: str | int | None,
    spacing: float | None,
) -> tuple[Array, Array]:
    """Return positions and drops of a table [m]."""
    file = Text.of(path)
    table = file.channel_table(None, keyword="")
    unit = unit or (file.unit() if table.width == 1 else None)
    values, words = np.array(table.rows), first_words(table.headings)
    if len(values) < 2 or (table.width < 2 and spacing is None):
        raise ValueError(
            f"{str(path)!r} must have two columns, positions and drops or heights, of two rows or "
            f"more, got {table.width} of {len(values)}; spacing= goes with drops or heights alone"
        )
    counted = int(table.width > 2 and is_counter(values[:, 0]) and not words)
    first = _word_column(words, AXES[0])
    if first is None:
        columns = [k for k in range(counted, table.width) if is_strict(values[:, k])]
        timed = [k for k in columns if words and words[k] in TIMES | NUMBERED]
        columns = [k for k in columns if k not in timed]
        is_clear = table.width - counted == 2 or len(columns) < 2
        first = (columns[0] if timed and columns else counted) if is_clear else None
        if words and first is not None and is_doubtful(table.headings[first]):
            first = None
    place = None if spacing is not None else _column(path, table, "x", x, first)
    only = 0 if table.width == 1 and not words else None
    is_drop = drop is not None or (height is None and _word_column(words, DROPS) is not None)
    if is_drop:
        vertical = _column(path, table, "drop", drop, _word_column(words, DROPS, only))
    else:
        vertical = _column(path, table, "height", height, _word_column(words, AXES[2], only))
    sizes = _sizes(path, table, unit, vertical if place is None else place, vertical)
    heights = without_sentinels(values[:, vertical]) * sizes[1]
    drops = heights if is_drop else _depths(heights)
    if place is None:
        return np.arange(len(values), dtype=np.float64) * (spacing or 0.0), drops
    is_named = path.suffix.lower() in MINIPROF or (table.headings and table.headings[place].unit)
    if not (is_named or isinstance(unit, tuple)) and is_counter(values[:, place]):
        hint = "; x= can name other ones" if x is None else ""
        raise ValueError(
            f"unit must be a pair, of positions and heights, or spacing= given: the positions of "
            f"{str(path)!r} count points, and may be no lengths{hint}"
        )
    return values[:, place] * sizes[0], drops


def _sizes(
    path: Path, table: Table, unit: str | tuple[str, str] | None, place: int, vertical: int
) -> list[float]:
    """Return the units of positions and of heights [m]."""
    lengths = unit if isinstance(unit, tuple) else (unit, unit)
    usual = "mm" if path.suffix.lower() in MINIPROF else None
    units = [
        keyword_unit or (table.headings[column].unit if table.headings else None) or usual
        for column, keyword_unit in ((place, lengths[0]), (vertical, lengths[1]))
    ]
    heading = table.headings[vertical].heading if table.headings else ""
    if units[1] is None and (bracket := IN_BRACKETS.search(heading)):
        units[1] = bracket[1]
    if units[0] is not None and units[1] is None and metres(units[0]) is not None:
        units[1] = units[0]
        warn(
            f"the heights of {str(path)!r} name no unit, and were read in that of the positions, "
            f"{units[0]}: unit= can be a pair"
        )
    sizes = []
    for name, unit_name in zip(
        ("heights" if place == vertical else "x", "heights"), units, strict=True
    ):
        size = metres(unit_name or "")
        if size is None:
            got = "names none" if unit_name is None else f"got {unit_name!r}"
            raise ValueError(
                f"unit must be one of {', '.join(METRES)} for the {name} of {str(path)!r}, {got}; "
                f"unit= can be a pair"
            )
        sizes.append(size)
    return sizes


def _scan(
    path: Path,
    unit: str | tuple[str, str] | None,
    others: Mapping[str, object],
    height: str | int | None,
) -> tuple[Array, Array]:
    """Return positions and drops of a line scan in a file of an instrument [m]."""
    from nacre.surfaces.instruments import line_scan

    for keyword, column in others.items():
        if column is not None:
            raise ValueError(
                f"{keyword} must be left out for the line scan in {str(path)!r}, whose heights are "
                f"a channel, got {column!r}"
            )
    places, heights, file_unit = line_scan(path, height)
    lengths = unit if isinstance(unit, tuple) else (unit, unit)
    sizes = [metres(keyword_unit or file_unit or "") for keyword_unit in lengths]
    if sizes[0] is None or sizes[1] is None:
        raise ValueError(
            f"unit must be one of {', '.join(METRES)} for {str(path)!r}, which names {file_unit!r}"
        )
    return places * sizes[0], _depths(without_sentinels(heights) * sizes[1])


def _depths(heights: Array) -> Array:
    """Return distances from the highest of the heights that were measured."""
    return float(heights.max(initial=-np.inf, where=np.isfinite(heights))) - heights


def _measured_points(path: Path, places: Array, drops: Array) -> tuple[Array, Array]:
    """Return what was measured, and warn of the rest, and of a drop far from all others."""
    measured = np.isfinite(places) & np.isfinite(drops)
    count, points = int((~measured).sum()), places.size
    places, drops = places[measured], drops[measured]
    if len(places) < 2 or len(places) < LEAST_MEASURED * points:
        raise ValueError(
            f"{str(path)!r} must have at least half its points measured, and two, got "
            f"{len(places)} of {points}"
        )
    if count:
        gap = float(np.diff(places).max())
        warn(
            f"{count} of {points} points of {str(path)!r} are missing and were bridged smoothly, "
            f"the widest gap is {written(gap, 'm')}"
        )
    farthest = float(drops[np.argmax(np.abs(drops - np.median(drops)))])
    bulk = drops[drops != farthest]
    away = float(np.abs(farthest - bulk).min()) if bulk.size else 0.0
    if bulk.size >= LEAST_REST and away > FAR * np.ptp(bulk):
        far, span = written(farthest, "m"), written(float(np.ptp(bulk)), "m")
        warn(
            f"{points - count - bulk.size} of {points} drops of {str(path)!r}, {far}, is far from "
            f"the others, which span {span}: is it the mark of a missing point?"
        )
    return places, drops


def _word_column(
    words: Sequence[str], headings: frozenset[str], only: int | None = None
) -> int | None:
    """Return the only column whose heading begins with one of some words, or the `only` one."""
    hits = [k for k, word in enumerate(words) if word in headings]
    return hits[0] if len(hits) == 1 else only


def _column(
    path: Path, table: Table, keyword: str, choice: str | int | None, usual: int | None
) -> int:
    """Return the number of a column, by its name or number, or the usual one."""
    names = [column.name for column in table.headings]
    if choice is None and usual is not None:
        return usual
    if isinstance(choice, str) and names.count(choice) == 1:
        return names.index(choice)
    if choice is not None and not isinstance(choice, str):
        choice = core.integer(keyword, choice)
        if 0 <= choice < table.width:
            return choice
    listing = ", ".join(f"{k} {name!r}" for k, name in enumerate(names)) or (
        f"{table.width} columns without names, first {', '.join(f'{v:g}' for v in table.rows[0])}"
    )
    keywords = "drop= or height=" if keyword == "height" else f"{keyword}="
    got = "" if choice is None else f", got {choice!r}"
    raise ValueError(
        f"{keywords} must name a column of {str(path)!r} by its name or number{got}: it has "
        f"{listing}"
    )


def _simpack(path: Path) -> tuple[Array, Array]:
    """Return positions and drops of a rail or a wheel [m], whose z points down."""
    header: dict[str, float] = {}
    rows: list[list[float]] = []
    head, begin, points = decoded(path).partition("point.begin")
    for key, value in re.findall(r"^\s*([\w.]+)\s*=\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?)", head, re.M):
        header[key.lower()] = float(value)
    for line in points.partition("point.end")[0].splitlines():
        fields = line.partition("!")[0].split()
        if len(fields) >= 2:
            rows.append([float(fields[0]), float(fields[1])])
    if not begin or len(rows) < 2:
        raise ValueError(f"{str(path)!r} must have points between point.begin and point.end")
    if header.get("rotate", 0.0) != 0:
        raise ValueError(f"{str(path)!r} must not be rotated, got rotate = {header['rotate']:g}")
    if not (factor := header.get("units.len.f", 0.0)) > 0:
        raise ValueError(f"{str(path)!r} must name its unit of length, units.len.f, above 0")
    shift = [header.get("shift.y", 0.0), header.get("shift.z", 0.0)]
    y, z = (np.array(rows) + shift).T / factor
    y = -y if header.get("mirror.y") == 1 else y
    z = -z if header.get("mirror.z") == 1 else z
    is_wheel = header.get("type", float(path.suffix.lower() == ".prw")) == 1
    return y, -z if is_wheel else z
