"""Reports: a page with all that results say, to print, to sign and to keep.

A page is one file of HTML without scripts and without requests. Each class of results says what
stands in its `Sections`; what they have in common is made here.
"""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Protocol, TypeGuard

import numpy as np
import numpy.typing as npt

from nacre._tools.disk import name_of
from nacre._tools.markup import Markup, Parts, text_of
from nacre._tools.notices import heard
from nacre._tools.units import rounded, symbol
from nacre.results import charts, display, svg, tables
from nacre.results.parameters import VALUES
from nacre.results.quantities import Quantity
from nacre.results.rows import Row, remark
from nacre.results.values import encode
from nacre.results.verdict import Verdict, verdict_on

Array = npt.NDArray[np.float64]
Rows = Sequence[Row]

MOST_ROWS = 300
"""Largest number of rows of a table that stand in a page."""
MOST_LISTED = 12
"""Largest number of numbers in an input that are written out."""
DIGITS, EXACT, ANGLE = 4, 9, 6
"""Digits of numbers in tables, of inputs, and of angles, whose factor to radians is not exact."""
ROUNDING = 1e-12
"""Share below which a number is 0: of the size of a grid its centre, of a load its balance."""
FEMTOMETRE = 1e-15
"""Length [m], moment [N m] and share below which a number is rounding."""
MOST_COLUMNS = 11
"""Largest number of columns on a page; a wider table is continued below, by its first column."""
INFINITE = {"inf": "∞", "-inf": "−∞"}
"""Signs of numbers without a limit."""
UNIT = re.compile(r"(.*) \[(.+)\]")
"""A heading with a unit."""
AXIS = re.compile(r"\b[xyz](?= \[|$)")
"""The axis in the heading of a component."""
LEADING = ("Given", "Results", "Pictures")
"""Chapters before the tables of parts, which are as wide as the page."""
SIGNED = ("project", "part", "load case", "drawn by", "checked by")
"""What a head says beside the name of the case."""
WORDS = {"young": "Young's modulus", "poisson": "Poisson's ratio", "rms_slope": "RMS slope"}
"""Names of quantities whose keys are no words."""
ANGLES = {"rad": (math.degrees(1.0), "°"), "rad/s": (30 / math.pi, "/min")}
"""Units in which a page has angles and speeds, and how many there are in an SI unit."""
MINUTES = 60 * math.degrees(1.0)
"""Minutes of arc in a radian."""
ACCURACIES = ("residual", "balance", "ended", "friction_ended")
"""Keys of rows that say how well a solution holds."""
PATH = re.compile(r"\b[a-z_]\w*(?:\[\d+\])?(?:\.[a-z_]\w*(?:\[\d+\])?)*", re.IGNORECASE)
"""A path of an input, or a word."""
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?")
"""A number in a text."""
GRIDS = {"Grid", "Grid.line"}
BODIES = {"HalfSpace", "Elastic", "Layer", "Spring", "Response", *GRIDS}
"""Classes that need no row of their own among the inputs."""
markup = Parts(text_of("nacre.results", "report.html"))


class Drawing(NamedTuple):
    """A picture as SVG, and what it shows."""

    caption: str
    drawing: str


class Table(NamedTuple):
    """A table of parts: one unit a column."""

    title: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    notes: Sequence[str] = ()


@dataclass(frozen=True)
class Sections:
    """What a report says of a result."""

    title: str
    """What it is."""
    inputs: Rows = ()
    """Inputs by name, with units."""
    numbers: Rows = ()
    """Quantities by name, with units and errors."""
    pictures: Sequence[Drawing] = ()
    """Pictures."""
    tables: Sequence[Table] = ()
    """Parts: elements, layers, steps, cases."""
    model: Rows = ()
    """Theory, grid, how the solution ended, and what is not counted."""
    warnings: Sequence[str] = ()
    """Warnings."""


class Reported(Protocol):
    """A result that a report can be written of."""

    @property
    def _sections(self) -> Callable[..., Sections]: ...


def write(
    path: Path,
    results: Sequence[Reported],
    case: str | None = None,
    inputs: Rows = (),
    signed: Mapping[str, str] | None = None,
) -> None:
    """Write the report of results of one case, whose file is `case`; its name is that of `path`."""
    written = text(name_of(path), results, case, inputs, signed=signed)
    path.write_text(written, encoding="utf-8")


def text(
    name: str,
    results: Sequence[Reported],
    case: str | None = None,
    inputs: Rows = (),
    stress: Mapping[str, object] | None = None,
    signed: Mapping[str, str] | None = None,
) -> str:
    """Return the report of results of one case, whose file is `case`.

    The first result takes keywords of stresses for its picture over depth. `signed` has texts of
    the head, by the names in `SIGNED`.
    """
    with heard() as caught:
        judgements = list(verdicts(results))
        sections = [
            results[0]._sections(**(stress or {})),
            *(result._sections() for result in results[1:]),
        ]
    notes = [Sections("", inputs, warnings=caught)]
    today = datetime.date.today().isoformat()
    return page(name, today, [*sections, *notes], judgements, case, signed)


def writer(result: Reported) -> dict[str, Callable[[Path], None]]:
    """Return the writer of the report of a result, by its ending."""
    return {".html": lambda path: write(path, [result])}


def verdicts(results: Sequence[Reported]) -> Iterator[Verdict]:
    """Yield the verdicts of results, the first of those with equal words.

    One that has to be computed stands only where there is no other.
    """
    known = list(filter(None, map(verdict_on, results)))
    yield from reversed({verdict.words: verdict for verdict in reversed(known)}.values())
    members = (getattr(result, "verdict", None) for result in results)
    for compute in () if known else filter(None, members):
        with suppress(ValueError):  # of contacts whose stresses are not known
            yield compute()


def page(
    name: str,
    date: str,
    sections: Sequence[Sections],
    judgements: Sequence[Verdict],
    case: str | None = None,
    signed: Mapping[str, str] | None = None,
) -> str:
    """Return the page of a report."""
    several = sum(bool(section.title) for section in sections) > 1

    def each(name: str, block: Callable[..., object]) -> list[Markup]:
        """Return a block of each part, with its title where there are several."""
        return [
            markup("part", title=_heading(section.title * several), content=block(content))
            for section in sections
            if (content := getattr(section, name))
        ]

    texts = dict.fromkeys(text for section in sections for text in section.warnings)
    chapters = {
        "Given": each("inputs", _pairs),
        "Results": each("numbers", _pairs),
        "Pictures": each("pictures", _figures),
        "Parts": each("tables", lambda members: [_table(member) for member in members]),
        "Model and limits": each("model", _pairs),
        "Warnings": [markup("note", text=in_words(text)) for text in texts or ["no warnings"]],
        "Case file": case and markup("case", text=case),
    }
    head = {"case": name, "date": date, "computed by": tables.SOURCE, **(signed or {})}
    drawn, checked = (head.pop(key, "") for key in SIGNED[3:])
    first, parts, last = (
        [
            markup("chapter", title=title, content=content)
            for title, content in chapters.items()
            if content and (title in LEADING, title == "Parts") == place
        ]
        for place in ((True, False), (False, True), (False, False))
    )
    return markup(
        "page",
        style=Markup(svg.STYLE),
        title=sections[0].title[:1].upper() + sections[0].title[1:],
        name=name,
        source=tables.SOURCE,
        running="".join(c if c.isalnum() and c.isascii() else f"\\{ord(c):x} " for c in name),
        verdicts=[_verdict(verdict) for verdict in judgements],
        head=_pairs([remark(*pair) for pair in head.items()]),
        drawn=drawn,
        checked=checked,
        chapters=[markup("columns", content=first), *parts, markup("columns", content=last)],
    )


def label_of(path: str) -> str:
    """Return the path of an input in words.

    >>> label_of("body.layers[0].material.young"), label_of("crown_radius")
    ("body, layer 1, Young's modulus", 'crown radius')
    """
    words = []
    for key in path.split("."):
        name, number = re.fullmatch(r"(.*?)(?:\[(\d+)\])?", key).groups()  # type: ignore[union-attr]
        if number is not None:
            name = f"{name.removesuffix('s')} {int(number) + 1}"
        words += [] if name == "material" else [WORDS.get(name, name).replace("_", " ")]
    return ", ".join(words)


def in_words(text: str) -> str:
    """Return a text in which paths of inputs are words.

    >>> in_words("the extremes in interfaces[0] are uncertain; take surface.npy")
    'the extremes in interface 1 are uncertain; take surface.npy'
    """

    def words(path: re.Match[str]) -> str:
        is_input = "." in path[0] and path[0].rpartition(".")[2] in VALUES
        return label_of(path[0]) if "[" in path[0] or is_input else path[0]

    return PATH.sub(words, text)


def _kind(name: str) -> str:
    """Return the name of a class in words, as "angular contact ball" or "JKR"."""
    word = name.rpartition(".")[2]
    if len(word) <= 3:
        return word.upper()
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", word).lower()


def input_rows(values: Mapping[str, object], units: Mapping[str, str] | None = None) -> Rows:
    """Return inputs by path, with units: those of `units` first. Arrays stand by their SHA-256."""
    by_name = VALUES | dict(units or {})
    leaves = (_leaves(name, encode(value, digest=True), by_name) for name, value in values.items())
    return [row for rows in leaves for row in rows]


def _leaves(path: str, value: object, units: Mapping[str, str]) -> Iterator[Row]:
    """Yield the rows of an encoded value."""
    if isinstance(value, Mapping) and value.keys() == {"array"}:
        shape, digest = value["array"]
        words = f"{' × '.join(map(str, shape))} numbers, SHA-256 {digest}"
        yield Row(path, label_of(path), words)
    elif isinstance(value, Mapping):
        is_call = len(value) == 1 and (kind := next(iter(value)))[:1].isupper()
        if is_call and kind not in BODIES:
            yield Row(path, label_of(path), _kind(kind))
        arguments = value[kind] if is_call else value
        if is_call and kind in GRIDS:
            arguments = {**arguments, "center": _without_rounding(arguments)}
        for key, item in arguments.items():
            yield from _leaves(f"{path}.{key}", item, units)
    elif isinstance(value, list) and not all(isinstance(v, float | int | None) for v in value):
        for number, item in enumerate(value):
            yield from _leaves(f"{path}[{number}]", item, units)
    elif value is not None and not (isinstance(value, list) and all(v is None for v in value)):
        # Limits of layers have the unit of the name before.
        names = re.sub(r"\[\d+\]", "", path).split(".")[:-3:-1]
        unit = next((units[name] for name in names if name in units), "")
        yield Row(path, label_of(path), _leaf(value, unit), value, unit)


def _without_rounding(grid: Mapping[str, Any]) -> object:
    """Return the centre of an encoded grid, 0 where it is the rounding of one that was chosen."""
    center, size = np.array(grid["center"]), np.array(grid.get("size", grid.get("width")))
    return np.where(abs(center) > ROUNDING * size, center, 0.0).tolist()


def _leaf(value: object, unit: str) -> str:
    if isinstance(value, list):
        texts = ["–" if entry is None else _leaf(entry, unit) for entry in value]
        more = f" and {len(texts) - MOST_LISTED} more" if len(texts) > MOST_LISTED else ""
        return ", ".join(texts[:MOST_LISTED]) + more
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float | int):
        if unit in ANGLES:
            factor, unit = ANGLES[unit]
            return rounded(factor * value, ANGLE) + unit
        return display.number(value, unit, EXACT)
    return str(value)


def other_numbers(result: tables.HasQuantities) -> list[Row]:
    """Return the quantities of a result that its printed table leaves out, if they are not 0."""
    rows = []
    for row, value in tables.numbers(result):
        is_known = np.isfinite(value).all() and np.any(value)
        if not row.label and "." not in row.path and is_known:
            number, unit = display.pair if row.dims else display.number, result._si(row)
            rows.append(Row(row.name, row.words, number(value, unit), value, unit))
    return rows


def table(
    title: str, rows: Iterable[Iterable[object]], quantities: Iterable[Quantity] = ()
) -> Table:
    """Return a table of rows, the heading first; columns get the units of quantities by name."""
    units = {row.name: symbol(row.unit) for row in quantities}
    columns = {
        str(name): values
        for name, *values in zip(*rows, strict=True)
        if not values or any(value == value and value != "" for value in values)
    }
    largest: dict[str, float] = {}
    for name, values in columns.items():
        stem = AXIS.sub("", name)
        largest[stem] = max([largest.get(stem, 0.0), *map(abs, filter(_is_number, values))])
    cells = [
        _column(name, values, units.get(name, ""), display.SLIGHT * largest[AXIS.sub("", name)])
        for name, values in columns.items()
    ]
    texts = [*zip(*(column for _, column in cells), strict=True)]
    more = len(texts) - MOST_ROWS
    notes = [f"and {more} more rows"] if more > 0 else []
    return Table(title, [name for name, _ in cells], texts[:MOST_ROWS], notes)


def _is_number(value: object) -> TypeGuard[float]:
    return isinstance(value, float | int) and not isinstance(value, bool) and math.isfinite(value)


def _column(
    name: str, values: Sequence[object], unit: str, rounding: float
) -> tuple[str, list[str]]:
    """Return the heading and the cells of a column, in one unit; below `rounding` they are 0."""
    if match := UNIT.fullmatch(name):
        name, unit = match.groups()
    if unit in ANGLES:
        factor, unit = ANGLES[unit]
        values = [factor * value if _is_number(value) else value for value in values]
        rounding *= factor
    largest = max(map(abs, filter(_is_number, values)), default=0.0)
    if not unit or unit.endswith("m"):
        rounding = max(rounding, FEMTOMETRE)
    scale = display.scale_in(largest if largest > rounding else 0.0, unit)

    def cell(value: object) -> str:
        if _is_number(value):
            return rounded(scale.factor * value if abs(value) > rounding else 0.0, DIGITS)
        return "" if value != value else INFINITE.get(str(value), str(value))

    words = name.replace("_", " ")
    return f"{words} [{scale.unit}]" if scale.unit else words, [cell(value) for value in values]


def drawn(pictures: Iterable[charts.Picture]) -> list[Drawing]:
    """Return pictures, drawn in the units that are set now."""
    return [Drawing(picture.caption, svg.drawing(picture)) for picture in pictures]


def notebook_picture(pictures: Sequence[charts.Picture]) -> bytes | None:
    """Return the last picture, if there is one, as a file for a notebook."""
    return svg.alone(svg.drawing(pictures[-1])) if pictures else None


def _heading(title: str) -> Markup | None:
    return markup("heading", title=title) if title else None


def _pairs(rows: Rows) -> Markup:
    """Return a table of names and texts, in which a zero has no exponent."""
    texts = ((row.label, in_words(_readable(row)).replace("0e+00", "0")) for row in rows)
    return markup("pairs", rows=[markup("pair", name=name, text=text) for name, text in texts])


def _readable(row: Row) -> str:
    """Return the text of a row: angles in minutes of arc or degrees, speeds per minute.

    Accuracies that are rounding are 0.
    """
    if row.key.rpartition(".")[2] == "tilt" and row.value is not None:
        bare = row.text.removesuffix(" mrad")
        factor = MINUTES * (1.0 if bare == row.text else 1e-3)
        words = NUMBER.sub(lambda slope: rounded(factor * float(slope[0]), DIGITS), bare)
        return f"{words} minutes of arc"
    if row.key in ACCURACIES:
        return NUMBER.sub(lambda n: "0" if abs(float(n[0])) < ROUNDING else n[0], row.text)
    if row.unit in ANGLES and isinstance(row.value, float):
        return _leaf(row.value, row.unit)
    return row.text


def _figures(pictures: Iterable[Drawing]) -> Markup:
    pairs = ((Markup(picture.drawing), picture.caption) for picture in pictures)
    return markup("figures", figures=[markup("figure", drawing=d, caption=c) for d, c in pairs])


def _table(members: Table) -> Markup:
    """Return a table, in parts as wide as a page, each with the first column."""
    step, widest = MOST_COLUMNS - 1, max(len(members.head), 2)
    blocks = []
    for first in range(1, widest, step):
        head, *rows = (
            [line[0], *line[first : first + step]] for line in (members.head, *members.rows)
        )
        blocks.append(
            markup("table", head=_row("head", head), rows=[_row("cell", row) for row in rows])
        )
    notes = [markup("note", text=in_words(note)) for note in members.notes]
    return markup("part", title=_heading(members.title), content=[*blocks, *notes])


def _row(kind: str, cells: Iterable[str]) -> Markup:
    return markup("row", cells=[markup(kind, text=in_words(text)) for text in cells])


def _verdict(verdict: Verdict) -> Markup:
    """Return a verdict: its level, its sentence, and further lines."""
    lines = [markup("line", text=line) for line in verdict.lines]
    return markup("verdict", level=verdict.level, words=verdict.words, lines=lines)
