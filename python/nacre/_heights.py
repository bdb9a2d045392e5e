"""Heights in plain files: NumPy arrays, matrices as text, and points as text."""

from __future__ import annotations

import codecs
import re
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

METRES = {
    "m": 1.0,
    "mm": 1e-3,
    "µm": 1e-6,
    "um": 1e-6,
    "nm": 1e-9,
    "pm": 1e-12,
    "Å": 1e-10,
    "A": 1e-10,
    "cm": 1e-2,
}
MISSING = frozenset(
    "|-|--|---|*|***|?|#n/a|bad|invalid|masked|missing|n/a|na|nan|no data|none|null|void".split("|")
)
"""Words, in small letters, that stand for a point that was not measured."""
NUMBER = re.compile(
    r"[+-]?(\d+(\.\d*)?|\.\d+)(e[+-]?\d+)?|[+-]?inf(inity)?|[+-]?nan", re.IGNORECASE
)
LEAST_MEASURED = 0.5
"""Least share of points that must be measured; below it most of the surface would be a guess."""


class Heights(NamedTuple):
    """Heights as a file holds them."""

    heights: Array
    """Heights (nx, ny); NaN where nothing was measured."""
    spacing: tuple[float, float] | None
    """Distances between the points, in the unit of the file."""
    unit: str | None
    """Unit that the file names."""


def npy(path: Path) -> Heights:
    """Return the matrix of a file of NumPy's."""
    try:
        # The map of a file is no larger than the file; to read would first make room.
        heights = np.lib.format.open_memmap(path, mode="r")
    except OSError:
        raise
    except Exception as error:  # a damaged head is read as Python
        raise ValueError(f"{str(path)!r} must hold an array of NumPy's: {error}") from error
    if heights.ndim != 2 or heights.dtype.kind not in "biuf":
        raise ValueError(
            f"{str(path)!r} must hold a real matrix of heights, got {heights.dtype} of shape "
            f"{heights.shape}"
        )
    return Heights(heights.astype(np.float64), None, None)


def csv(path: Path) -> Heights:
    """Return heights, one line for each x; ``# unit: um`` and ``# spacing: dx dy`` may precede."""
    said, lines = _content(path)
    spacing = None
    if "spacing" in said:
        text = said["spacing"]
        # "0,5 0,25" has decimal commas; in "0.5, 0.25" the comma separates.
        fields = text.split() if _has_decimal_commas([text]) else re.split(r"[,;\s]+", text)
        numbers = [_number(field.replace(",", ".")) for field in fields if field]
        if len(numbers) not in (1, 2) or not all(n is not None and 0 < n < np.inf for n in numbers):
            raise ValueError(
                f"{str(path)!r} must have one or two numbers above 0 as spacing, got {text[:60]!r}"
            )
        spacing = numbers[0] or 0.0, numbers[-1] or 0.0
    return Heights(_table(path, lines), spacing, _unit(path, said))


def xyz(path: Path) -> Heights:
    """Return heights of points x, y, z on a grid, in any order; some points may be missing."""
    said, lines = _content(path)
    points = _table(path, lines)
    if points.shape[1] != 3:
        raise ValueError(f"{str(path)!r} must have three columns x, y, z, got {points.shape[1]}")
    if not np.isfinite(points[:, :2]).all():
        raise ValueError(f"{str(path)!r} must have finite x and y at every point")
    places, steps = [], []
    for axis in (0, 1):
        values = np.unique(points[:, axis])
        # Coordinates that differ only by rounding are the same.
        reach = np.ptp(values) or 1.0
        values = values[np.insert(np.diff(values) > 1e-6 * reach, 0, True)]
        if values.size < 2:
            raise ValueError(f"{str(path)!r} must have points at two places along each of x and y")
        step = float(np.median(np.diff(values)))
        place = (points[:, axis] - values[0]) / step
        if not np.abs(place - place.round()).max() <= 0.05:
            raise ValueError(f"{str(path)!r} must have its points on a regular grid")
        places.append(place.round().astype(int))
        steps.append(float(np.ptp(values)) / int(places[-1].max()))
    cells = [int(place.max()) + 1 for place in places]
    if cells[0] * cells[1] * LEAST_MEASURED > len(points):
        raise ValueError(
            f"{str(path)!r} must fill its grid of {cells[0]} x {cells[1]} points, got {len(points)}"
        )
    heights = np.full(cells, np.nan)
    heights[places[0], places[1]] = points[:, 2]
    if not np.array_equal(heights[places[0], places[1]], points[:, 2], equal_nan=True):
        raise ValueError(f"{str(path)!r} must have one height at each place, got several")
    return Heights(heights, (steps[0], steps[1]), _unit(path, said))


def _content(path: Path) -> tuple[dict[str, str], list[tuple[int, str]]]:
    """Return names and values of comments ``# name: value``, and the other lines, numbered."""
    content = path.read_bytes()
    wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    text = content.decode("utf-16" if wide else "utf-8-sig", errors="replace")
    said: dict[str, str] = {}
    lines = []
    for number, line in enumerate(text.splitlines(), start=1):
        stripped = line.strip(" \r\n\f\v\0")
        if stripped.startswith("#"):
            name, colon, value = stripped[1:].partition(":")
            if colon:
                said.setdefault(name.strip().lower(), value.strip())
        elif stripped.strip():
            lines.append((number, stripped))
    return said, lines


def _unit(path: Path, said: dict[str, str]) -> str | None:
    unit = said.get("unit", "").replace("μ", "µ") or None
    if unit is not None and unit not in METRES:
        raise ValueError(
            f"{str(path)!r} must have one of the units {', '.join(METRES)}, got {unit[:60]!r}"
        )
    return unit


def _table(path: Path, lines: Sequence[tuple[int, str]]) -> Array:
    """Return the numbers of a text; empty fields and the words `MISSING` are NaN.

    Lines at the beginning that hold no number are headings, and are left out.
    """
    mark = _separator([text for _, text in lines])
    rows: list[Array] = []
    first = 0
    commas, points = False, False
    for number, text in lines:
        row = _row(path, number, text, mark, heading=not rows)
        if row is None:
            continue
        if mark != ",":
            commas, points = commas or "," in text, points or "." in text
            if commas and points:
                raise ValueError(
                    f"{str(path)!r} must have decimal commas or decimal points, line {number} "
                    f"brings both"
                )
        rows.append(np.array(row))
        if len(rows) == 1:
            first = number
        if len(row) != len(rows[0]):
            message = f"{len(rows[0])} numbers in each line, line {number} has {len(row)}"
            raise ValueError(f"{str(path)!r} must have {message} (line {first} is the first)")
    if not rows:
        raise ValueError(f"{str(path)!r} must hold numbers, got none")
    table = np.array(rows)
    # A mark at the end of every line separates nothing.
    ends = mark is not None and all(
        text.endswith(mark) for number, text in lines if number >= first
    )
    return table[:, :-1] if ends and table.shape[1] > 1 else table


def _row(path: Path, number: int, text: str, mark: str | None, heading: bool) -> list[float] | None:
    """Return the numbers of a line; None where the line may be a heading, and is one."""
    if "_" not in text:
        with suppress(ValueError):
            return [float(field) for field in text.split(mark)]  # the usual line
    fields = [field.strip(" \t\"'") for field in text.split(mark)]
    if mark != ",":
        fields = [field.replace(",", ".") for field in fields]
    if heading and not any(map(_is_value, fields)):
        return None
    row = []
    for field in fields:
        value = _number(field)
        if value is None:
            raise ValueError(f"{str(path)!r} must hold numbers, line {number} has {field[:60]!r}")
        row.append(value)
    return row


def _separator(texts: Sequence[str]) -> str | None:
    """Return the mark between fields; None stands for blanks."""
    for mark in (";", "\t"):
        if any(mark in text.strip() for text in texts):
            return mark
    return "," if any("," in text for text in texts) and not _has_decimal_commas(texts) else None


def _has_decimal_commas(texts: Sequence[str]) -> bool:
    """Return whether blanks separate the fields, and commas stand only within numbers."""
    fields = [text.split() for text in texts]
    numbers = [field for line in fields for field in line if any(map(str.isdigit, field))]
    return (
        all(len(line) > 1 for line in fields)
        and any("," in field for field in numbers)
        and all(NUMBER.fullmatch(field.replace(",", ".", 1)) is not None for field in numbers)
    )


def _is_value(field: str) -> bool:
    return field.lower() == "nan" or NUMBER.fullmatch(field) is not None


def _number(field: str) -> float | None:
    """Return the number in a field, NaN for a word in `MISSING`, and None for any other text."""
    if field.lower() in MISSING:
        return float("nan")
    return float(field) if NUMBER.fullmatch(field) else None


def named(path: Path) -> Any:
    """Return the reader of a file with this ending, or None."""
    return {".npy": npy, ".csv": csv, ".xyz": xyz}.get(path.suffix.lower())
