"""Profiles of rollers, wheels and rails in text files."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from nacre import _core as core
from nacre._tools.text import decoded
from nacre._tools.typing import Vector
from nacre.surfaces.heights import AXES, METRES, Table, Text, first_words, is_counter, metres

Array = npt.NDArray[np.float64]

DROPS = frozenset({"drop", "drops", "relief"})
"""First words of headings of drops."""
SIMPACK = (".prr", ".prw")
"""Endings of Simpack's profiles of rails and of wheels."""


def read_profile(
    path: str | os.PathLike[str],
    *,
    unit: str | tuple[str, str] | None = None,
    x: str | int | None = None,
    drop: str | int | None = None,
    height: str | int | None = None,
    smooth: bool = True,
    corners: Vector | None = None,
    smoothing: float | None = None,
) -> core.SampledProfile:
    r"""Read a measured profile of a roller from a text file.

    Lines above the table, names and units of columns, delimiter and decimal mark are found from
    the file. Simpack's profiles of rails (``.prr``) and wheels (``.prw``) are known.

    Parameters
    ----------
    path : str or path
        Text file with a column of positions, and one of drops or of heights.
    unit : str or pair of str, optional
        Unit of the columns ("um", "mm", ...), or of the positions and of the other column, where
        the file names none.
    x : str or int, optional
        Column of the positions: its name or its number from 0. By default the one with the name x,
        or the first.
    drop, height : str or int, optional
        Column of the drops, or of heights, of which the drop is the distance from the highest. By
        default the one with such a name.
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
    if path.suffix.lower() in SIMPACK:
        places, drops = _simpack(path)
    else:
        places, drops = _table(path, unit, x, drop, height)
    order = np.argsort(places, kind="stable")
    places, drops = places[order], drops[order]
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
) -> tuple[Array, Array]:
    """Return positions and drops of a table [m]."""
    table = Text.of(path).chosen(None)
    values, words = np.array(table.rows), first_words(table.headings)
    if len(values) < 2 or table.width < 2:
        raise ValueError(
            f"{str(path)!r} must have two columns, positions and drops or heights, of two rows or "
            f"more, got {table.width} of {len(values)}"
        )
    counted = int(table.width > 2 and is_counter(values[:, 0]) and not words)
    first = _named(words, AXES[0])
    place = _column(path, table, "x", x, first if first is not None else counted)
    is_drop = drop is not None or (height is None and _named(words, DROPS) is not None)
    if is_drop:
        other = _column(path, table, "drop", drop, _named(words, DROPS))
    else:
        other = _column(path, table, "height", height, _named(words, AXES[2]))
    lengths = unit if isinstance(unit, tuple) else (unit, unit)
    sizes = []
    for name, column, given in (("x", place, lengths[0]), ("heights", other, lengths[1])):
        said = given or (table.headings[column].unit if table.headings else None)
        size = metres(said or "")
        if size is None:
            got = "names none" if said is None else f"got {said!r}"
            raise ValueError(
                f"unit must be one of {', '.join(METRES)} for the {name} of {str(path)!r}, {got}; "
                f"unit= can be a pair"
            )
        sizes.append(size)
    found = values[:, [place, other]] * sizes
    found = found[np.isfinite(found).all(axis=1)]
    if len(found) < 2:
        raise ValueError(f"{str(path)!r} must have two measured points, got {len(found)}")
    return found[:, 0], found[:, 1] if is_drop else found[:, 1].max() - found[:, 1]


def _named(words: Sequence[str], known: frozenset[str]) -> int | None:
    """Return the only column whose name begins with a known word."""
    hits = [k for k, word in enumerate(words) if word in known]
    return hits[0] if len(hits) == 1 else None


def _column(
    path: Path, table: Table, keyword: str, asked: str | int | None, usual: int | None
) -> int:
    """Return the number of a column, by its name or number, or the usual one."""
    names = [column.name for column in table.headings]
    if asked is None and usual is not None:
        return usual
    if isinstance(asked, str) and names.count(asked) == 1:
        return names.index(asked)
    if asked is not None and not isinstance(asked, str):
        asked = core.integer(keyword, asked)
        if 0 <= asked < table.width:
            return asked
    listed = ", ".join(f"{k} {name!r}" for k, name in enumerate(names)) or (
        f"{table.width} columns without names, first {', '.join(f'{v:g}' for v in table.rows[0])}"
    )
    keywords = "drop= or height=" if keyword == "height" else f"{keyword}="
    got = "" if asked is None else f", got {asked!r}"
    raise ValueError(
        f"{keywords} must name a column of {str(path)!r} by its name or number{got}: it has "
        f"{listed}"
    )


def _simpack(path: Path) -> tuple[Array, Array]:
    """Return positions and drops of a rail or a wheel [m], whose z points down."""
    said: dict[str, float] = {}
    rows: list[list[float]] = []
    head, begin, points = decoded(path).partition("point.begin")
    for key, value in re.findall(r"^\s*([\w.]+)\s*=\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?)", head, re.M):
        said[key.lower()] = float(value)
    for line in points.partition("point.end")[0].splitlines():
        fields = line.partition("!")[0].split()
        if len(fields) >= 2:
            rows.append([float(fields[0]), float(fields[1])])
    if not begin or len(rows) < 2:
        raise ValueError(f"{str(path)!r} must have points between point.begin and point.end")
    if said.get("rotate", 0.0) != 0:
        raise ValueError(f"{str(path)!r} must not be rotated, got rotate = {said['rotate']:g}")
    if not (factor := said.get("units.len.f", 0.0)) > 0:
        raise ValueError(f"{str(path)!r} must name its unit of length, units.len.f, above 0")
    shift = [said.get("shift.y", 0.0), said.get("shift.z", 0.0)]
    y, z = (np.array(rows) + shift).T / factor
    y = -y if said.get("mirror.y") == 1 else y
    z = -z if said.get("mirror.z") == 1 else z
    is_wheel = said.get("type", float(path.suffix.lower() == ".prw")) == 1
    return y, -z if is_wheel else z
