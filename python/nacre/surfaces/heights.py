"""Heights in plain files: NumPy arrays, matrices as text, and points as text."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from nacre._tools.text import MISSING, Column, column_of, decoded, fields_of, listed, unit_of

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
NUMBER = re.compile(
    r"[+-]?(\d+(\.\d*)?|\.\d+)(e[+-]?\d+)?|[+-]?inf(inity)?|[+-]?nan", re.IGNORECASE
)
LEAST_MEASURED = 0.5
"""Least share of points that must be measured; below it most of the surface would be a guess."""


COUNTS = (
    re.compile(
        r"(number of )?points( (per|in) (a )?(trace|line|profile))?|horizontal"
        r"|(number of |n ?)?(columns|cols)|nx|(pixels|points) x|x[- ]?(pixels|points)"
    ),
    re.compile(
        r"(number of )?(traces|lines|profiles|scans)|vertical|(number of |n ?)?rows"
        r"|ny|(pixels|points) y|y[- ]?(pixels|points)"
    ),
)
"""Names of the numbers of points along a line of the file, and of lines."""
UNIT = re.compile(r"((z|height|value)[- ]?)?units?( z| of heights?)?")
"""Names of the unit of the heights."""
SPACING = re.compile(
    r"(xy|x/y|x|y|lateral)?[- ]?"
    r"(?:calibration|pixel size|pixel|spacing|pitch|step|sampling|resolution|interval)"
    r"(?: (xy|x/y|x|y))?"
)
"""Names of the distance between points."""
AXES = (
    frozenset("x|lateral|position|distance|abstand|weg|abscisse|posición|posizione".split("|")),
    frozenset({"y"}),
    frozenset("z|height|heights|h|topography|elevation|höhe|hauteur|altura|altezza".split("|")),
)
"""First words of headings of x, y and z."""
BESIDE = frozenset(
    "achse asse axe axis coord coordinate coordinates corrected direction dir eje in lateral "
    "measured normal of profile surface the vertical".split()
)
"""Words of headings that leave places and heights what they are."""
DROPS = frozenset({"drop", "drops", "relief"})
"""First words of headings of drops."""
NUMBERED = frozenset("|i|id|index|line|n|no|nr|number|point|profile|row|scan|trace".split("|"))
"""Headings of a column that counts."""
TIMES = frozenset(
    "time|zeit|temps|tiempo|tempo|speed|velocity|geschwindigkeit|vitesse|velocidad|velocità"
    "|temperature|temperatur|température|temperatura|force|kraft|t".split("|")
)
"""Headings of columns beside a profile that are neither places nor heights."""
FEWEST_LINES, LEAST_ORDERED = 5, 9
"""Fewest lines that are a map whatever their order, and points of which two lines of a rough map
would be in order once in 10⁹ times: 2/10! each."""
SENTINELS = (
    *(-25.4, -25400, -25400000, 2147483640, 2147483647, -2147483648, 32767, -32767, -32768),
    *(9999, -9999, 99999, -99999, 999999, -999999, 1e30, -1e30, 1e37, -1e37, 1e38, -1e38),
)
"""Numbers that stand for what was not measured, where they are far from all others."""
OFF, LEAST_JITTERED = 0.05, 12
"""Largest distance of a point from its place on the grid, in steps, and the fewest points of a grid
that is recognised although its points are off."""
NO_MAP = (
    "holds a profile, places beside heights, not a map: a surface must have two dimensions, got a "
    "line{}; SampledProfile.read reads it for a Roller"
)
"""What is wrong with a profile."""
ZYGO = b"Zygo XYZ Data File"
"""Beginning of Zygo's text form."""
COLUMNS = re.compile(r"ColumnDef\s*=\s*(.+)", re.IGNORECASE)
MARKS = frozenset("\"'*!>?")
"""Signs with which programs mark points, as that of the MiniProf does with a quotation mark."""
FIRST_MARK = re.compile(r"^[\"'*!>?]\s*(?=[+-]?\.?\d)")
LAST_MARK = re.compile(r"(?<=[\d.])\s+[\"'*!?]$")
SAMPLE, LONGEST_SAMPLE = 1000, 200_000
"""Lines from which the separator is found, spread evenly, and about their characters."""
BLOCKS = 8
"""Tables of a file that are read at once if they are the last ones."""


class Heights(NamedTuple):
    """Heights as a file holds them."""

    heights: Array
    """Heights (nx, ny); NaN where nothing was measured."""
    spacing: tuple[float, float] | None
    """Distances between the points, in the unit of the file."""
    unit: str | None
    """Unit that the file names."""
    is_metric: bool = True
    """Whether the numbers are metres where no unit is named."""
    axis_units: tuple[str, ...] = ()
    """Units of columns, in which the numbers are no more."""
    note: str = ""
    """What a message adds to the name of the file."""
    has_metres: bool = False
    """Whether the distances are in metres, and not in the unit of the heights."""


def npy(path: Path) -> Heights:
    """Return the matrix of a file of NumPy's."""
    try:
        # The map of a file is no larger than the file; to read would first make room.
        heights = np.lib.format.open_memmap(path, mode="r")
    except OSError:
        raise
    except Exception as error:  # a damaged head is read as Python
        reason = " ".join(str(error).split())[:200]
        raise ValueError(f"{str(path)!r} must hold an array of NumPy's: {reason}") from error
    if heights.ndim != 2 or not heights.size or heights.dtype.kind not in "biuf":
        raise ValueError(
            f"{str(path)!r} must hold a real matrix of heights, got {heights.dtype} of shape "
            f"{heights.shape}"
        )
    values, name = heights.astype(np.float64), str(path)
    if (columns := _coordinates([], values)) is not None:
        points, steps = _grid(path, values[:, _xyz_columns(name, columns)])
        return _lengths(Heights(points, steps, None, False), values[:, columns[:2]])
    return Heights(_matrix(name, [], values, "array"), None, None)


def zygo(path: Path) -> Heights | None:
    """Return the heights of Zygo's text form; None where a file is another one.

    Its fourth line ends in the numbers of columns and rows, and the seventh number of the eighth
    one is the size of a pixel [m], 0 where it is not known. Between lines ``#`` stand column, row
    and height [µm] of each point.
    """
    with path.open("rb") as file:
        if file.read(len(ZYGO)) != ZYGO:
            return None
    lines = [line.strip() for line in decoded(path).splitlines()]
    try:
        size, start = float(lines[7].split()[6]), lines.index("#") + 1
        rows = [line.split(maxsplit=2) for line in lines[start : lines.index("#", start)]]
        points = [[i, j, "nan" if z == "No Data" else z] for i, j, z in rows]
        cells = tuple(map(int, lines[3].split()[2:4]))
        heights, steps = _grid(path, np.array(points, dtype=np.float64))
    except (ValueError, IndexError) as error:
        raise ValueError(f"{str(path)!r} must be whole, as Zygo's XYZ: {error}") from error
    if heights.shape != cells or steps != (1.0, 1.0):
        raise ValueError(f"{str(path)!r} must have {cells} points, got {heights.shape}")
    return Heights(heights, (size, size) if size > 0 else None, "µm", has_metres=True)


def text(path: Path, channel: str | int | None = None) -> Heights:
    """Return the heights of a table in a text file: points x, y, z on a grid, or a matrix.

    A matrix has one line for each x. Above it may stand ``# unit: um`` and ``# spacing: dx dy``, or
    what instruments write; those write one line for each y. A profile, places beside heights, and
    counters that nothing tells from heights are refused, whatever the ending.
    """
    file = Text.of(path)
    table = file.channel_table(channel)
    return file.points(table) or file.matrix(table)


@dataclass
class Table:
    """Lines of numbers that follow each other."""

    rows: Any
    """Lists of numbers, or an array of them."""
    lines: list[int]
    """Line of each row in the file, from 1."""
    title: str = ""
    """The line above, but for headings of columns."""
    headings: list[Column] = field(default_factory=list)
    """Names and units of the columns; empty where the file has none."""

    @property
    def width(self) -> int:
        """Number of columns."""
        return len(self.rows[0])


@dataclass
class Text:
    """A text file: what it says in names and values, and its tables."""

    path: Path
    comments: dict[str, str]
    """Comments ``# name: value``, names in small letters."""
    head: dict[str, list[str]]
    """Lines of a name and values, names in small letters."""
    above: list[tuple[int, str]]
    """Comments and lines that are no rows, by their numbers."""
    tables: list[Table]
    has_decimal_commas: bool

    @classmethod
    def of(cls, path: Path) -> Text:
        """Read a file; a line of numbers that is damaged is an error."""
        comments, remarks, lines = _content(path)
        mark = _separator([line for _, line in lines])
        file = cls(path, comments, {}, remarks, [], False)
        table: Table | None = None
        breaks: dict[int, tuple[int, int, int]] = {}
        near: list[str] = []
        points = False
        for place, (number, line) in enumerate(lines, start=1):
            row, fields = _row(line, mark)
            if row is None or (table is None and np.isnan(row).all()):
                damaged = table is not None and len(fields) == table.width and line[0] not in "#%"
                if damaged and any(map(_is_value, fields)):
                    wrong = next(text for text in fields if _number(text) is None)
                    raise ValueError(
                        f"{str(path)!r} must hold numbers, line {number} has {wrong[:60]!r}"
                    )
                table = None
                near.append(line)
                file.above.append((number, line))
                file._keep_head_line(line, mark)
                continue
            if mark != ",":
                file.has_decimal_commas |= "," in line
                points = points or "." in line
                if file.has_decimal_commas and points:
                    raise ValueError(
                        f"{str(path)!r} must have decimal commas or decimal points, line {number} "
                        f"brings both"
                    )
            if table is None or len(row) != table.width:
                if table is not None:
                    breaks[len(file.tables)] = table.lines[0], table.width, number
                table = Table([], [])
                if near and (top := _numbers_beside(near[-1], mark, len(row))) is not None:
                    if len(top) < len(row) - 1:
                        raise ValueError(
                            f"{str(path)!r} must hold numbers, the line above line {number} has "
                            f"{near[-1][:60]!r}"
                        )
                    table.rows.append([np.nan, *top])  # places along a line, and a word beside
                    table.lines.append(file.above.pop()[0])
                    near.pop()
                used = len(row) - _trailing_marks(line, mark)
                table.headings, table.title = _headings(near, mark, len(row), used)
                near = []
                file.tables.append(table)
                if len(file.tables) <= BLOCKS and not file.has_decimal_commas:
                    block = _block([text for _, text in lines[place:]], mark, len(row))
                    if block is not None:
                        table.rows = np.vstack([*table.rows, row, block])
                        table.lines += [last for last, _ in lines[place - 1 :]]
                        break
            table.rows.append(row)
            table.lines.append(number)
        file._check(breaks, lines, mark)
        return file

    def _keep_head_line(self, line: str, mark: str | None) -> None:
        """Keep what a line above a table says: a name, values and units."""
        fields = fields_of(line, mark) if mark else [line]
        if not any(fields[1:]):
            fields = re.split(r"\s*[:=]\s*|\t|\s{2,}", " ".join(fields).strip(), maxsplit=1)
        if len(fields) == 1 and (match := NAMED_NUMBER.fullmatch(fields[0])):
            fields = [match[1], match[2]]
        column = column_of(line)
        if column.unit and first_words([column])[0] in AXES[2]:  # a title such as "z [um]"
            self.head.setdefault("z unit", [column.unit])
        name, values = fields[0].strip(" :=").lower(), " ".join(fields[1:]).split()
        if name and values:
            self.head.setdefault(name, [value.replace(",", ".") for value in values])

    def _check(
        self,
        breaks: dict[int, tuple[int, int, int]],
        lines: list[tuple[int, str]],
        mark: str | None,
    ) -> None:
        """Refuse lines of different width, but for counts above a matrix; drop what is no table."""
        for place, (first, width, number) in breaks.items():
            before, table = self.tables[place - 1], self.tables[place]
            sizes = sorted((len(table.rows), table.width))
            if len(before.rows) > 1 or sorted(before.rows[0][:2]) != sizes:
                message = f"{width} numbers in each line, line {number} has {table.width}"
                raise ValueError(
                    f"{str(self.path)!r} must have {message} (line {first} is the first)"
                )
        largest = max(self.tables, key=lambda table: len(table.rows) * table.width, default=None)
        self.tables = [table for table in self.tables if len(table.rows) > 1 < table.width] or (
            [largest] if largest else []
        )
        if not self.tables:
            for number, fields in ((number, _row(line, mark)[1]) for number, line in lines):
                wrong = [text for text in fields if _number(text) is None]
                if 0 < 2 * len(wrong) < len(fields):
                    raise ValueError(
                        f"{str(self.path)!r} must hold numbers, line {number} has {wrong[0][:60]!r}"
                    )
            raise ValueError(f"{str(self.path)!r} must hold numbers, got none")
        texts, defined = dict(lines), self._defined_columns()
        for table in self.tables:
            # Marks at the end of every line separate nothing.
            blank = min(_trailing_marks(texts.get(n, ""), mark) for n in table.lines)
            if blank := min(blank, table.width - 1):
                table.rows = np.array(table.rows)[:, :-blank]
                table.headings = table.headings[: table.width]
            if not table.headings:
                table.headings = defined[: table.width] if len(defined) >= table.width else []

    def _defined_columns(self) -> list[Column]:
        """Return the columns that a line ``ColumnDef=X,Y`` names, as that of a MiniProf does."""
        for _, line in self.above:
            if match := COLUMNS.fullmatch(line):
                return [column_of(name.strip()) for name in match[1].split(",")]
        return []

    def channel_table(self, channel: str | int | None, keyword: str = "channel") -> Table:
        """Return the table that a channel names, or the only one that the head describes.

        `keyword` names the choice in errors; "" where there is none.
        """
        if len(self.tables) == 1:
            if channel is not None:
                ending = self.path.suffix
                raise ValueError(f"channel must be left out: {ending} has none, got {channel!r}")
            return self.tables[0]
        if isinstance(channel, int) and 0 <= channel < len(self.tables):
            return self.tables[channel]
        if isinstance(channel, str):
            hits = [table for table in self.tables if channel.lower() in table.title.lower()]
            if len(hits) == 1:
                return hits[0]
        counts = self.counts()
        first = self.tables[0]
        if channel is None and counts and _extra_columns(first, counts) is not None:
            return first
        tables = [
            f"{k} ({table.title[:60]!r}, {len(table.rows)} lines of {table.width} numbers from "
            f"line {table.lines[0]})"
            for k, table in enumerate(self.tables)
        ]
        requirement = "given" if channel is None else f"one of these, got {channel!r}"
        demand = f"{keyword} must be {requirement}" if keyword else "the file must hold one table"
        raise ValueError(
            f"{demand}: {str(self.path)!r} has {len(self.tables)} tables, {listed(tables)}"
        )

    def counts(self) -> tuple[int, int] | None:
        """Return the numbers of points along x and y that the head gives."""
        sizes = []
        for pattern in COUNTS:
            texts = [values[0] for name, values in self.head.items() if pattern.fullmatch(name)]
            texts += [value for name, value in self.comments.items() if pattern.fullmatch(name)]
            numbers = [float(text) for text in texts if NUMBER.fullmatch(text)]
            counts = {int(number) for number in numbers if math.isfinite(number)}
            sizes.append(counts.pop() if len(counts) == 1 else 0)
        return (sizes[0], sizes[1]) if all(sizes) else None

    def points(self, table: Table) -> Heights | None:
        """Return heights of points x, y, z on a grid; None where these are no points."""
        name, values = str(self.path), np.asarray(table.rows)
        columns = _coordinates(table.headings, values)
        if columns is None:
            if self.path.suffix.lower() != ".xyz":
                return None
            if table.width != 3:
                _refuse_profile(name, table.headings, values)
                raise ValueError(f"{name!r} must have three columns x, y, z, got {table.width}")
            columns = (0, 1, 2)
        columns = _xyz_columns(name, columns)
        heights, steps = _grid(self.path, values[:, columns])
        units = [table.headings[k].unit for k in columns] if table.headings else []
        units = units or [
            self.comments.get(f"{of} units") for of in ("lateral", "lateral", "value")
        ]
        x, y, z = (metres(unit or "") for unit in units)
        if x and y and z:
            axis_units = tuple(str(unit) for unit in units)
            steps = steps[0] * (x / z), steps[1] * (y / z)
            return Heights(heights, steps, units[2], False, axis_units)
        if x and y:
            steps = steps[0] * x, steps[1] * y
            return Heights(heights, steps, self.unit(), False, has_metres=True)
        points = Heights(heights, steps, self.unit(), False)
        return _lengths(points, values[:, columns[:2]], self.spacing())

    def matrix(self, table: Table) -> Heights:
        """Return a matrix of heights, as what it cannot be is refused."""
        name, values, counts = str(self.path), np.asarray(table.rows), self.counts()
        where = f"table from line {table.lines[0]}"
        is_numbered = counts is not None and _extra_columns(table, counts) == 1
        if is_numbered and (np.diff(values[:, 0]) == 1).all():
            values = values[:, 1:]
        else:
            values = _matrix(name, table.headings, values, where)
        if counts is not None and values.shape not in (counts, counts[::-1]):
            raise ValueError(
                f"{name!r} says that it has {counts[0]} x {counts[1]} points, but its {where} has "
                f"{values.shape[0]} lines of {values.shape[1]} numbers"
            )
        spacing = self.spacing()
        is_image = self.path.suffix.lower() != ".csv" or (
            any(pattern.fullmatch(key) for key in self.head for pattern in COUNTS)
            or (spacing is not None and "spacing" not in self.comments)
        )
        if is_image and counts is not None:
            is_image = values.shape == counts[::-1]
        note = f", whose table begins at line {table.lines[0]}," if self.head else ""
        return Heights(values.T if is_image else values, spacing, self.unit(), note=note)

    def plain(self) -> str:
        """Return the text with blanks between numbers, decimal points, and heads as they were."""
        lines = {
            number: re.sub(r"(\d),(\d)", r"\1.\2", line) if self.has_decimal_commas else line
            for number, line in self.above
        }
        for table in self.tables:
            for number, row in zip(table.lines, np.array(table.rows).tolist(), strict=True):
                lines[number] = " ".join(map(repr, row))
        return "\n".join(lines[number] for number in sorted(lines)) + "\n"

    def unit(self) -> str | None:
        """Return the unit of the heights that the file names."""
        candidates = [self.comments.get("unit", "")]
        candidates += [values[-1] for name, values in self.head.items() if UNIT.fullmatch(name)]
        units = [unit.strip("()[] ").replace("μ", "µ") for unit in candidates if unit]
        if not units:
            return None
        if metres(units[0]) is None:
            raise ValueError(
                f"{str(self.path)!r} must have one of the units {', '.join(METRES)}, got "
                f"{units[0][:60]!r}"
            )
        return units[0]

    def spacing(self) -> tuple[float, float] | None:
        """Return the distances between points that the file gives, in the unit of the heights."""
        if "spacing" in self.comments:
            text = self.comments["spacing"]
            # "0,5 0,25" has decimal commas; in "0.5, 0.25" the comma separates.
            fields = text.split() if _has_decimal_commas([text]) else re.split(r"[,;\s]+", text)
            numbers = [_number(field.replace(",", ".")) for field in fields if field]
            if len(numbers) not in (1, 2) or not all(
                n is not None and 0 < n < np.inf for n in numbers
            ):
                raise ValueError(
                    f"{str(self.path)!r} must have one or two numbers above 0 as spacing, got "
                    f"{text[:60]!r}"
                )
            return numbers[0] or 0.0, numbers[-1] or 0.0
        steps = []
        heights = metres(self.unit() or "m") or 1.0
        for axis in "xy":
            for name, values in self.head.items():
                column = column_of(name)
                match, number = SPACING.fullmatch(column.name), _number(values[0])
                unit = metres(values[1] if len(values) > 1 else column.unit or "")
                which = (match[1] or match[2] or "xy") if match else ""
                if number and unit and (axis in which or which == "lateral"):
                    steps.append(number * unit / heights)
                    break
        return (steps[0], steps[1]) if len(steps) == 2 else None


def metres(unit: str) -> float | None:
    """Return the length of a unit [m], None where it is no length."""
    size = unit_of(unit)
    return METRES.get(unit) or (size[1] if size and size[0] == "m" else None)


def without_sentinels(heights: Array) -> Array:
    """Return heights with NaN for numbers such as -25400 that are far from all others."""
    if not {*extremes(heights)} & {*SENTINELS}:
        return heights
    measured = np.isfinite(heights)
    sentinels = measured & np.isin(heights, SENTINELS)
    values = heights[measured & ~sentinels]
    if not sentinels.any() or values.size < LEAST_MEASURED * heights.size:
        return heights
    away = np.maximum(values.min() - heights, heights - values.max())
    return np.where(sentinels & (away > max(np.ptp(values), 1.0)), np.nan, heights)


def extremes(heights: Array) -> tuple[float, float]:
    """Return the smallest and the largest finite height, or inf and -inf where there is none."""
    measured = np.isfinite(heights)
    lowest = heights.min(initial=math.inf, where=measured)
    return float(lowest), float(heights.max(initial=-math.inf, where=measured))


def _extra_columns(table: Table, counts: tuple[int, int]) -> int | None:
    """Return how many columns a table has more than its head says; None where it does not fit."""
    for shape in (counts, counts[::-1]):
        if len(table.rows) == shape[0] and table.width - shape[1] in (0, 1):
            return table.width - shape[1]
    return None


def is_doubtful(column: Column) -> bool:
    """Return whether a heading names a place, a height or a drop beside an unknown word."""
    words, lengths = {*re.split(r"[\W_]+", column.name.lower()), ""}, DROPS.union(*AXES)
    return bool(words & lengths) and not words <= lengths | BESIDE | {""}


def first_words(headings: Sequence[Column]) -> list[str]:
    """Return the first word of each heading, in small letters; all where it `is_doubtful`."""
    names = [column.name.lower().strip() for column in headings]
    pairs = zip(headings, names, strict=True)
    return [name if is_doubtful(top) else re.split(r"[\s_:.-]", name)[0] for top, name in pairs]


def _coordinates(headings: Sequence[Column], values: Array) -> tuple[int, ...] | None:
    """Return the columns of x, y and z, or only of x and y where that of z is not known."""
    width = values.shape[1]
    if width < 3:
        return None
    names = first_words(headings)
    columns = [[k for k, name in enumerate(names) if name in words] for words in AXES]
    if all(len(hits) == 1 for hits in columns):
        return tuple(hits[0] for hits in columns)
    for pair in ((0, 1), (1, 2)):
        if _are_places(values[:, pair]):
            indices = [k for k in range(width) if k not in pair]
            indices = [k for k in indices if not (k == 0 and is_counter(values[:, 0]))]
            indices = [k for k in indices if not (headings and is_doubtful(headings[k]))]
            return (*pair, *indices) if len(indices) == 1 else pair
    return None


def _xyz_columns(name: str, columns: tuple[int, ...]) -> tuple[int, ...]:
    """Return the columns of x, y and z, all of which must be known."""
    if len(columns) != 3:
        raise ValueError(
            f"{name!r} holds points, not a matrix: columns {columns[0]} and {columns[1]} are "
            f"places on a grid; name the columns x, y and z in the line above, or leave those alone"
        )
    return columns


def _are_places(pairs: Array) -> bool:
    """Return whether pairs of numbers are the places of a grid, most of which are taken once."""
    if len(pairs) < 4 or not np.isfinite(pairs).all():
        return False
    if np.unique(pairs[:, 0] + 1j * pairs[:, 1]).size < len(pairs):
        return False
    counts = [len(_distinct(pairs[:, axis])) for axis in (0, 1)]
    return min(counts) > 1 and LEAST_MEASURED * counts[0] * counts[1] <= len(pairs)


def _distinct(values: Array) -> Array:
    """Return coordinates in order, once each but for rounding or the error of a stage."""
    ordered = np.unique(values)
    gaps = np.diff(ordered)
    same = ordered[np.insert(gaps > 1e-6 * (np.ptp(ordered) or 1.0), 0, True)]
    if same.size <= 0.5 * values.size or values.size < LEAST_JITTERED:
        return same
    # Steps of a grid whose places are off by some of a step.
    coarse = ordered[np.insert(gaps > 0.25 * gaps.max(), 0, True)]
    place = (values - coarse[0]) / float(np.median(np.diff(coarse)))
    is_tight = float(np.abs(place - np.median(place - place.round()) - place.round()).max()) <= OFF
    return coarse if is_tight and coarse.size <= 0.5 * values.size else same


def _grid(path: Path, points: Array) -> tuple[Array, tuple[float, float]]:
    """Return heights on a grid of points in any order, and the distances between them."""
    if not np.isfinite(points[:, :2]).all():
        raise ValueError(f"{str(path)!r} must have finite x and y at every point")
    places, steps = [], []
    for axis in (0, 1):
        values = _distinct(points[:, axis])
        if values.size < 2:
            raise ValueError(f"{str(path)!r} must have points at two places along each of x and y")
        step = float(np.median(np.diff(values)))
        place = (points[:, axis] - values[0]) / step
        place -= np.median(place - place.round())
        if not np.abs(place - place.round()).max() <= OFF:
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
    return heights, (steps[0], steps[1])


def _lengths(points: Heights, places: Array, spacing: tuple[float, float] | None = None) -> Heights:
    """Return points with another spacing, if any, where x or y counts from 0 or 1."""
    if any(is_counter(_distinct(column)) for column in places.T):
        note = ", whose x or y counts points and is no length,"
        return points._replace(spacing=spacing, note=note)
    return points


def _rises_evenly(values: Array) -> bool:
    """Return whether at least four numbers are steps of a ladder, but for rounding."""
    if values.size < 4 or not np.isfinite(values).all():
        return False
    steps = np.diff(values)
    if not steps.all():
        return False
    mean = float(steps.mean())
    return bool((np.abs(steps - mean) <= 0.01 * abs(mean)).all())


def is_counter(values: Array) -> bool:
    """Return whether numbers count from 0 or 1."""
    return bool(values.size > 1 and values[0] in (0, 1) and (values[1:] == values[:-1] + 1).all())


def _is_profile(headings: Sequence[Column], values: Array) -> bool:
    """Return whether a table has places in order and one height at each, with times or numbers.

    Without names, two columns are a profile if one is in order; three or four are if all but one or
    two are, as those of a time, a place and a counter.
    """
    words = first_words(headings)
    places, across, up = (any(word in names for word in words) for names in AXES)
    counters = [word for word in words if word in TIMES | NUMBERED]
    if places and up and not across and len(words) <= len(counters) + 2:
        return True
    if any(word in TIMES for word in words) and len(words) <= FEWEST_LINES:
        return True
    for table in (values.T, values):
        lines = table[1:] if len(table) == 3 and is_counter(table[0]) else table
        if len(lines) == 2 and lines.shape[1] >= 4 and any(map(_is_ordered, lines)):
            return True
        if 2 < len(lines) <= FEWEST_LINES:
            strict = [line for line in lines if line.size > LEAST_ORDERED and is_strict(line)]
            if 1 < len(strict) < len(lines):
                return True
    return False


def _is_ordered(line: Array) -> bool:
    steps = np.diff(line[np.isfinite(line)])
    rises = line.size > 4 and ((steps >= 0).all() or (steps <= 0).all())
    return bool(rises and np.count_nonzero(steps) > 0.5 * steps.size) or _rises_evenly(line)


def is_strict(line: Array) -> bool:
    """Return whether each number is above, or each below, the one before."""
    steps = np.diff(line)
    return bool((steps > 0).all() or (steps < 0).all())


def _refuse_profile(name: str, headings: Sequence[Column], values: Array) -> None:
    if _is_profile(headings, values):
        raise ValueError(f"{name!r} {NO_MAP.format('')}")


def _matrix(name: str, headings: Sequence[Column], values: Array, where: str) -> Array:
    """Return heights without the numbers of lines and columns; a profile or places are an error."""
    _refuse_profile(name, headings, values)
    corner = bool(np.isnan(values[0, 0]))
    left, top = values[corner:, 0], values[0, corner:]
    if corner and is_counter(top) and is_counter(left):
        return values[1:, 1:]
    for which, line, lines in (
        ("column", left, values[corner:, 1:].T),
        ("line", top, values[1:, corner:]),
    ):
        if not _rises_evenly(line) or any(map(_rises_evenly, lines)):
            continue
        first = headings[0].name.lower().strip("# .") if headings else None
        if which == "column" and is_counter(line) and first in NUMBERED:
            return values[:, 1:]
        raise ValueError(
            f"{name!r} holds more than heights: the first {which} of its {where} counts or gives "
            f"places, {line[0]:g} to {line[-1]:g} in equal steps; leave it out of the file, or "
            f"give the heights alone as an array, HeightMap(heights, spacing)"
        )
    return values


def _trailing_marks(line: str, mark: str | None) -> int:
    """Return how many marks between fields a line ends in."""
    return len(line) - len(line.rstrip(mark)) if mark else 0


def _headings(
    near: Sequence[str], mark: str | None, width: int, used: int
) -> tuple[list[Column], str]:
    """Return the names of columns by the lines above a table, and the title above those.

    The first row has fields in the columns that are `used`, and marks alone in the rest.
    """
    if not near:
        return [], ""

    def fields_at(line: str) -> list[str]:
        names = fields_of(line, mark or " ")
        while len(names) > used and not names[-1]:
            names.pop()
        return names + [""] * (width - len(names)) if used <= len(names) < width else names

    names = fields_at(near[-1])
    units: list[str] = []
    if len(near) > 1 and len(names) == width and all(_bare_unit(text) for text in names if text):
        units, near = names, near[:-1]
        names = fields_at(near[-1])
    if len(names) != width or not any(names):
        return [], near[-1]
    columns = [column_of(text) for text in names]
    if units:
        columns = [
            column._replace(unit=_bare_unit(u)) for column, u in zip(columns, units, strict=True)
        ]
    return columns, near[-2] if len(near) > 1 else ""


def _numbers_beside(line: str, mark: str | None, width: int) -> list[float] | None:
    """Return the numbers after the first field of a line that is a row but for texts, else None.

    They are none where another field than the first is a text.
    """
    fields = fields_of(line, mark or " ")
    numbers = [_number(field.replace(",", ".")) for field in fields]
    finite = [number for number in numbers if number is not None and np.isfinite(number)]
    if line[0] in "#%" or len(fields) != width or 2 * len(finite) <= max(width, 3):
        return None
    return finite if numbers[0] is None else []


def _bare_unit(text: str) -> str | None:
    bare = text.strip("()[]{} ")
    return bare if unit_of(bare) else None


def _content(path: Path) -> tuple[dict[str, str], list[tuple[int, str]], list[tuple[int, str]]]:
    """Return comments ``# name: value`` by name and as numbered lines, and the other lines.

    A comment that names another channel is a line: it stands between tables.
    """
    named_values: dict[str, str] = {}
    comments: list[tuple[int, str]] = []
    lines: list[tuple[int, str]] = []
    for number, line in enumerate(decoded(path).replace("\u2212", "-").splitlines(), start=1):
        stripped = line.strip(" \r\n\f\v\0\x1a")
        if stripped.startswith(("#", "%")):
            name, colon, value = (text.strip() for text in stripped[1:].partition(":"))
            is_title = name.lower() == "channel" and lines
            (lines if is_title else comments).append((number, stripped))
            if colon:
                named_values.setdefault(name.lower(), value)
        elif stripped.strip():
            lines.append((number, _numbers_text(stripped)))
    return named_values, comments, lines


def _numbers_text(line: str) -> str:
    """Return a line without the mark of a point in front of its numbers, or behind them."""
    if not any(mark in line for mark in MARKS) or line.count('"') > 1:
        return line
    return LAST_MARK.sub("", FIRST_MARK.sub("", line))


def _row(text: str, mark: str | None) -> tuple[list[float] | None, list[str]]:
    """Return the numbers of a line, None where it holds another text, and its fields then."""
    if "_" not in text:
        with suppress(ValueError):
            usual = text if mark == "," else text.replace(",", ".")
            return [float(field) for field in usual.split(mark)], []
    fields = fields_of(text, mark or " ")
    # Where commas separate, those within quotes are decimal.
    numbers = [_number(field.replace(",", ".")) for field in fields]
    row = [number for number in numbers if number is not None]
    return (row if len(row) == len(fields) else None), fields


def _block(texts: Sequence[str], mark: str | None, width: int) -> Array | None:
    """Return the numbers of lines that are all rows of this width with decimal points, or None."""
    if not texts or any("_" in text or (mark != "," and "," in text) for text in texts):
        return None
    try:
        block = np.loadtxt(texts, delimiter=mark, comments=None, ndmin=2)
    except ValueError:
        return None
    return block if block.shape == (len(texts), width) else None


def _separator(texts: Sequence[str]) -> str | None:
    """Return the mark between fields by which most lines are rows; None stands for blanks."""
    most = max(len(texts) // SAMPLE, sum(map(len, texts)) // LONGEST_SAMPLE)
    sample = texts[:: max(1, most)]

    def rows(mark: str | None) -> int:
        parsed_rows = (_row(text, mark)[0] for text in sample if mark is None or mark in text)
        return sum(row is not None and len(row) > 1 for row in parsed_rows)

    return max((";", "\t", ",", None), key=rows)  # the first of equals


def _has_decimal_commas(texts: Sequence[str]) -> bool:
    """Return whether blanks separate the fields, and commas stand only within numbers."""
    fields = [text.split() for text in texts]
    numbers = [field for line in fields for field in line if any(map(str.isdigit, field))]
    return (
        all(len(line) > 1 for line in fields)
        and any("," in field for field in numbers)
        and all(NUMBER.fullmatch(field.replace(",", ".", 1)) is not None for field in numbers)
    )


NAMED_NUMBER = re.compile(r"([^\d]{1,60}?)\s+([+-]?\d[\d.,]{0,30}(?: \S{1,20})?)")


def _is_value(field: str) -> bool:
    return field.lower() == "nan" or NUMBER.fullmatch(field) is not None


def _number(field: str) -> float | None:
    """Return the number in a field, NaN for a word in `MISSING`, and None for any other text."""
    if field.lower() in MISSING:
        return float("nan")
    return float(field) if NUMBER.fullmatch(field) else None
