"""Tables of numbers in text files, with the names and units of their columns.

A file is decoded, its delimiter and decimal mark are found from all its lines, rows of numbers that
follow each other become a table, and the lines above a table name its columns.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from nacre._tools.text import MISSING, Column, column_of, decoded, fields_of
from nacre._tools.text import unit_of as unit_of
from nacre._tools.units import size_of

DELIMITERS = ("\t", ";", ",", " ")
"""Marks between fields, the likeliest first; a blank stands for any white space."""
LEAST_ROWS = 3
"""Fewest rows of a table; a curve needs as many points, and metadata have less in most files."""
SAMPLE = 1000
"""Lines from which the delimiter is found: spread evenly, so that a long head does not decide."""
HEAD = 6
"""Lines above a table in which the names of its columns are looked for: names, units, a rule, and
what instruments write between, such as the number of points."""

LONGEST_LINE = 4000
"""Most characters of a line with headings: the time that they take grows with a power of it."""


def _grammar(decimal: str, thousands: str) -> re.Pattern[str]:
    d, t = re.escape(decimal), re.escape(thousands)
    grouped = rf"[1-9]\d{{0,2}}(?:{t}\d{{3}})+(?:{d}\d*)?"
    return re.compile(rf"[+-]?(?:{grouped}|\d+(?:{d}\d*)?|{d}\d+)(?:[eE][+-]?\d+)?")


NUMBERS = {".": _grammar(".", ","), ",": _grammar(",", ".")}
"""Numbers with a decimal point and with a decimal comma; the other mark may group thousands."""
WORDS = frozenset({"nan", "inf", "+inf", "-inf", "+nan", "-nan"})
"""Words, in small letters, that stand in a row of numbers where one is missing or infinite."""

OTHERS = frozenset({"v", "mv", "hz", "khz", "deg", "°", "%", "none", "-", "#", "a.u.", "1"})
"""What a row of units may hold, in small letters, beside units that can be computed with."""


@dataclass
class Table:
    """Rows of numbers that follow each other, as text, with what the file says about them."""

    width: int
    """Number of columns."""
    rows: list[list[str]] = field(default_factory=list)
    """Fields of each row."""
    lines: list[int] = field(default_factory=list)
    """Line of each row in the file, from 1."""
    columns: list[Column] = field(default_factory=list)
    """Headings; those that the file does not give are empty."""
    decimal: str = "."
    """Decimal mark."""
    above: str = ""
    """The nearest line above the table."""
    title: str = ""
    """The line above those that name the columns."""
    head: str = ""
    """All lines above the table."""

    def number(self, row: int, column: int) -> float | None:
        """Return a number of the table; None where the field holds another text or none."""
        text = self.rows[row][column]
        if text.lower() in WORDS:
            return float(text)
        if not NUMBERS[self.decimal].fullmatch(text):
            return None
        return float(
            text.replace(".", "").replace(",", ".")
            if self.decimal == ","
            else text.replace(",", "")
        )


def tables(
    path: Path, delimiter: str | None, decimal: str | None, encoding: str | None
) -> list[Table]:
    """Return the tables of a text file, in order."""
    lines = decoded(path, encoding).replace("\u2212", "-").splitlines()
    if delimiter is None:
        delimiter = _delimiter(lines, decimal)
    runs = list(_runs(path, lines, delimiter))
    if not runs:
        raise ValueError(
            f"{str(path)!r} must hold a table of {LEAST_ROWS} rows of two or more numbers, found "
            f"none with {delimiter!r} between the fields; delimiter and encoding can be given"
        )
    for table, above in runs:
        table.decimal = decimal or _decimal(path, table)
        table.above = above[0] if above else ""
        table.columns, used = _columns(table, above, delimiter)
        table.title = above[used] if 0 < used < len(above) else ""
        table.head = "\n".join(reversed(above))
    return [table for table, _ in runs]


def _is_number(text: str, decimals: Sequence[str] = (".", ",")) -> bool:
    if text.isdigit():
        return True
    return text.lower() in WORDS or any(NUMBERS[mark].fullmatch(text) for mark in decimals)


def _is_row(fields: Sequence[str], delimiter: str, decimals: Sequence[str] = (".", ",")) -> bool:
    """Return whether a line has two numbers or more, and fewer texts than numbers."""
    texts = [t for t in fields if not _is_number(t, decimals) and t.lower() not in MISSING | {""}]
    # The comma of "0,5 1,2" does not separate fields, and leaves "5 1".
    if delimiter == "," and any(re.search(r"\d[;\s]\s*[\d.+-]", text) for text in texts):
        return False
    numbers = sum(_is_number(text, decimals) for text in fields)
    return numbers >= 2 and numbers > len(texts)


def _delimiter(lines: Sequence[str], decimal: str | None) -> str:
    """Return the mark between fields by which most lines are rows of numbers."""
    sample = lines[:: max(1, len(lines) // SAMPLE)]
    decimals = (".", ",") if decimal is None else (decimal,)

    def rows(mark: str) -> int:
        used = [line for line in sample if mark == " " or mark in line]
        return sum(_is_row(fields_of(line, mark), mark, decimals) for line in used)

    return max(DELIMITERS, key=rows)  # the first of equals


def _runs(path: Path, lines: Sequence[str], delimiter: str) -> Iterator[tuple[Table, list[str]]]:
    """Yield the tables, and the lines above each, the nearest first."""
    above: list[str] = []
    run: Table | None = None
    for number, line in enumerate(lines, 1):
        line = line.strip(" \r\n\f\v\0\x1a")
        if not line.strip():
            continue
        fields = [] if line.startswith(("#", "%")) else fields_of(line, delimiter)
        if _is_row(fields, delimiter):
            if run is not None and delimiter != " " and len(run.rows) >= LEAST_ROWS:
                fields += [""] * (run.width - len(fields))  # a test beside it that is longer
            if run is not None and len(fields) != run.width and len(run.rows) >= LEAST_ROWS:
                raise ValueError(
                    f"{str(path)!r} must have as many fields in each row, line {number} has "
                    f"{len(fields)} and the line before {run.width}"
                )
            if run is None or len(fields) != run.width:
                run = Table(len(fields))
            run.rows.append(fields)
            run.lines.append(number)
            if len(run.rows) == LEAST_ROWS:
                yield run, above[: 1 - LEAST_ROWS][::-1]
                above = []
            elif len(run.rows) < LEAST_ROWS:
                above.append(line)
            continue
        if run is not None and len(run.rows) >= LEAST_ROWS and len(fields) == run.width:
            wrong = [text for text in fields if not _is_number(text)]
            if sum(map(bool, wrong)) < sum(map(bool, fields)):
                example = max(wrong, key=bool)  # a text rather than a field that is empty
                raise ValueError(
                    f"{str(path)!r} must hold numbers in each row, line {number} has "
                    f"{example[:60]!r}"
                )
        run = None
        above.append(line.lstrip("#% ") if line.startswith(("#", "%")) else line)


def _decimal(path: Path, table: Table) -> str:
    """Return the decimal mark that all numbers of a table agree on."""
    if not any("," in text for row in table.rows for text in row):
        return "."
    points = commas = doubtful = ""
    for text in (text for row in table.rows for text in row if "," in text or "." in text):
        point, comma = (NUMBERS[mark].fullmatch(text) is not None for mark in ".,")
        if point and comma:
            doubtful = doubtful or (text if "," in text else "")
        elif point:
            points = points or text
        elif comma:
            commas = commas or text
    if points and commas:
        raise ValueError(
            f"{str(path)!r} must have decimal points or decimal commas, has both {points[:60]!r} "
            f"and {commas[:60]!r}"
        )
    if doubtful and not points and not commas:
        raise ValueError(
            f"decimal must be given: in {str(path)!r} each comma may be a decimal comma or group "
            f"thousands, as in {doubtful[:60]!r}; decimal=',' or decimal='.'"
        )
    return "," if commas else "."


def _columns(table: Table, above: Sequence[str], delimiter: str) -> tuple[list[Column], int]:
    """Return the columns of a table, and how many of the lines above, the nearest first, say it."""
    empty = [Column("", "", None)] * table.width
    candidates = [
        line
        for line in above[: 2 * HEAD]
        if len(line) <= LONGEST_LINE and re.search(r"[^\W_]", line)
    ][:HEAD]
    for line, after in zip(candidates, ["", *candidates], strict=False):
        headings = _headings(line, delimiter, table.width)
        if headings is None or _are_units(headings):
            continue
        columns = [column_of(heading) for heading in headings]
        beneath = _headings(after, delimiter, table.width)
        if beneath is not None and _are_units(beneath):
            columns = [
                Column(f"{heading} ({text.strip('()[]{} ')})", heading, text.strip("()[]{} "))
                if text
                else column
                for heading, text, column in zip(headings, beneath, columns, strict=True)
            ]
        return columns, above.index(line) + 1
    return empty, 0


def _headings(line: str, delimiter: str, width: int) -> list[str] | None:
    """Return the texts of a line that are as many as columns, or None; numbers are not texts."""
    ways = [fields_of(line, delimiter)]
    if delimiter == " ":
        in_quotes = re.findall(r'"([^"]*)"', line)
        wide = [text.strip() for text in re.split(r"\t|\s{2,}", line.strip())]
        with_units = re.findall(r"[^\s(\[]+(?:\s*[(\[][^)\]]*[)\]])?|[(\[][^)\]]*[)\]]", line)
        ways = [in_quotes, wide, with_units, *ways]
    for texts in ways:
        while len(texts) > width and not texts[-1]:
            texts = texts[:-1]
        some = [text for text in texts if text]
        # A mark at the end of each row makes a column without a name.
        if len(texts) == width - 1 and len(some) > 1:
            texts = [*texts, ""]
        if len(texts) == width and some and not any(_is_number(text) for text in some):
            return texts
    return None


def _are_units(texts: Sequence[str]) -> bool:
    """Return whether most of these texts are units, in brackets or not."""
    some = [text.strip("()[]{} ") for text in texts if text]
    known = [
        text
        for text in some
        if unit_of(text) or size_of(text.replace("u", "µ")) or text.lower() in OTHERS
    ]
    return 2 * len(known) > len(some)
