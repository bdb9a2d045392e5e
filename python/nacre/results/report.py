"""Reports: a page with all that results say, to print, to sign and to keep.

A page is one file of HTML without scripts and without requests. Each class of results says what
stands in its `Sections`; what they have in common is made here.
"""

from __future__ import annotations

import datetime
import math
import re
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Protocol, TypeGuard

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.disk import name_of
from nacre._tools.markup import Markup, Parts, text_of
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
DIGITS, EXACT = 4, 9
"""Digits of numbers in tables, and of inputs."""
ROUNDING = 1e-12
"""Part of the size of a grid below which its centre is 0, as of one that was chosen."""
MOST_COLUMNS = 11
"""Largest number of columns on a page; a wider table is continued below, by its first column."""
INFINITE = {"inf": "∞", "-inf": "−∞"}
"""Signs of numbers without a limit."""
UNIT = re.compile(r"(.*) \[(.+)\]")
"""A heading with a unit."""
AXIS = re.compile(r"\b[xyz](?= \[|$)")
"""The axis in the heading of a component."""
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
    path: Path, results: Sequence[Reported], case: str | None = None, inputs: Rows = ()
) -> None:
    """Write the report of results of one case, whose file is `case`; its name is that of `path`."""
    path.write_text(text(name_of(path), results, case, inputs), encoding="utf-8")


def text(
    name: str,
    results: Sequence[Reported],
    case: str | None = None,
    inputs: Rows = (),
    stress: Mapping[str, object] | None = None,
) -> str:
    """Return the report of results of one case, whose file is `case`.

    The first result takes keywords of stresses for its picture over depth.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", core.NacreWarning)
        judgements = list(verdicts(results))
        sections = [
            results[0]._sections(**(stress or {})),
            *(result._sections() for result in results[1:]),
        ]
    notes = [Sections("", inputs, warnings=[str(warning.message) for warning in caught])]
    today = datetime.date.today().isoformat()
    return page(name, today, [*sections, *notes], judgements, case)


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
        "Warnings": [markup("note", text=text) for text in texts or ["no warnings"]],
        "Case file": case and markup("case", text=case),
    }
    head = [remark("case", name), remark("date", date), remark("computed by", tables.SOURCE)]
    return markup(
        "page",
        style=Markup(svg.STYLE),
        title=sections[0].title[:1].upper() + sections[0].title[1:],
        name=name,
        source=tables.SOURCE,
        verdicts=[_verdict(verdict) for verdict in judgements],
        head=_pairs(head),
        chapters=[
            markup("chapter", title=title, content=content)
            for title, content in chapters.items()
            if content
        ],
    )


def input_rows(values: Mapping[str, object], units: Mapping[str, str] | None = None) -> Rows:
    """Return inputs by path, with units: those of `units` first. Arrays stand by their SHA-256."""
    by_name = VALUES | dict(units or {})
    leaves = (_leaves(name, encode(value, digest=True), by_name) for name, value in values.items())
    return [row for rows in leaves for row in rows]


def _leaves(path: str, value: object, units: Mapping[str, str]) -> Iterator[Row]:
    """Yield the rows of an encoded value."""
    if isinstance(value, Mapping) and value.keys() == {"array"}:
        shape, digest = value["array"]
        yield remark(path, f"{' × '.join(map(str, shape))} numbers, SHA-256 {digest}")
    elif isinstance(value, Mapping):
        is_call = len(value) == 1 and (kind := next(iter(value)))[:1].isupper()
        if is_call and kind not in BODIES:
            yield remark(path, kind)
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
        yield Row(path, path, _leaf(value, unit), value, unit)


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
        return display.number(value, unit, EXACT)
    return str(value)


def other_numbers(result: tables.HasQuantities) -> list[Row]:
    """Return the quantities of a result that its printed table leaves out."""
    rows = []
    for row, value in tables.numbers(result):
        if not row.label and "." not in row.path and np.isfinite(value).all():
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
    largest = max(map(abs, filter(_is_number, values)), default=0.0)
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
    texts = ((row.label, row.text.replace("0e+00", "0")) for row in rows)
    pairs = [markup("pair", name=label, text=text) for label, text in texts]
    return markup("pairs", rows=pairs)


def _figures(pictures: Iterable[Drawing]) -> Markup:
    figures = [
        markup("figure", drawing=Markup(picture.drawing), caption=picture.caption)
        for picture in pictures
    ]
    return markup("figures", figures=figures)


def _table(members: Table) -> Markup:
    """Return a table, in parts as wide as a page, each with the first column."""
    step, widest = MOST_COLUMNS - 1, max(len(members.head), 2)
    blocks = []
    for first in range(1, widest, step):
        head, *rows = (
            [line[0], *line[first : first + step]] for line in (members.head, *members.rows)
        )
        blocks.append(
            markup("table", rows=[_row("head", head), *(_row("cell", row) for row in rows)])
        )
    notes = [markup("note", text=note) for note in members.notes]
    return markup("part", title=_heading(members.title), content=[*blocks, *notes])


def _row(kind: str, cells: Iterable[str]) -> Markup:
    return markup("row", cells=[markup(kind, text=text) for text in cells])


def _verdict(verdict: Verdict) -> Markup:
    """Return a verdict: its level, its sentence, and further lines."""
    lines = [markup("line", text=line) for line in verdict.lines]
    return markup("verdict", level=verdict.level, words=verdict.words, lines=lines)
