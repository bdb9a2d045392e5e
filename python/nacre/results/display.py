"""Printed forms of results: a line, a table; in a notebook with a small map."""

from __future__ import annotations

import base64
import dataclasses
import functools
import html
import io
import math
import re
import shutil
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import dropwhile
from typing import TYPE_CHECKING, Any, ParamSpec, Protocol, TypeVar, runtime_checkable

import numpy as np
import numpy.typing as npt

from nacre._core import Elastic, Free, HalfSpace, Response, Rigid, Spring
from nacre._tools.typing import Planned
from nacre._tools.units import (
    SI,
    Scale,
    System,
    Within,
    display_units,
    printable,
    rounded,
    system,
    written,
)
from nacre.results.quantities import Quantity
from nacre.results.rows import Row, remark

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

P = ParamSpec("P")
T = TypeVar("T")
R = TypeVar("R")

ALT = "picture of the result, x to the right"
WIDE = 480
"""Pixels along the longer side of a picture."""
NOISE = 1e-9
"""Share of its largest possible value below which a position or a moment is printed as 0."""
SLIGHT = 1e-8
"""Share of a vector below which a component is printed as 0."""
ORDINALS = ("first", "second", "third", "fourth", "fifth")
LAYER_ROWS = 4
"""Largest number of layers that get a row each."""
GLUE = "\N{NO-BREAK SPACE}"
NARROWEST = 20
"""Least letters of a line that is wrapped beside its label."""
_width: ContextVar[int | None] = ContextVar("width of printed lines", default=None)
_units: ContextVar[str | None] = ContextVar(
    "units in which numbers in SI are printed", default=None
)


class InLayer(Protocol):
    """A row of a table of layers."""

    @property
    def layer(self) -> int:
        """Number of the layer."""

    @property
    def name(self) -> str | None:
        """Name of the layer."""

    @property
    def depths(self) -> tuple[float, float]:
        """Depths of its faces; the lower one is infinite for the substrate."""


@runtime_checkable
class AtInterface(Protocol):
    """A row of a table of interfaces."""

    @property
    def interface(self) -> int:
        """Number of the interface."""


class Estimates(Protocol):
    """A report with discretisation errors."""

    @property
    def discretisation(self) -> Mapping[str, float | None] | None:
        """Errors by name."""


class Estimated(Protocol):
    """A result whose report has discretisation errors."""

    @property
    def report(self) -> Estimates:
        """Report."""


def in_si(function: Callable[P, T]) -> Callable[P, T]:
    """Return a function of what is in SI whatever units are set, as the numbers of bearings are."""

    @functools.wraps(function)
    def inside(*args: P.args, **kwargs: P.kwargs) -> T:
        with Within(SI):
            return function(*args, **kwargs)

    return inside


@contextmanager
def shown_in(units: str) -> Iterator[None]:
    """Print numbers that are in SI in other units within the context."""
    token = _units.set(units)
    try:
        yield
    finally:
        _units.reset(token)


def shown_system() -> System:
    """Return the units in which numbers are shown."""
    return system() if (units := _units.get()) is None else System(units)


@contextmanager
def wrapped() -> Iterator[None]:
    """Print lines and tables no wider than the terminal within the context; 80 if unknown."""
    token = _width.set(shutil.get_terminal_size((80, 24)).columns)
    try:
        yield
    finally:
        _width.reset(token)


def wrap(line: str, indent: int = 2) -> list[str]:
    """Return a line in lines no wider than the terminal within `wrapped`, the next ones indented.

    They keep some `NARROWEST` letters for words, and words and numbers keep theirs.
    """
    width = _width.get()
    if width is None or len(line) <= width:
        return [line]
    lines = textwrap.TextWrapper(
        max(width, indent + NARROWEST),
        subsequent_indent=" " * indent,
        break_long_words=False,
        break_on_hyphens=False,
    )
    # A number stays beside the next digits or its unit.
    return [part.replace(GLUE, " ") for part in lines.wrap(re.sub(r"(?<=\d) (?=\S)", GLUE, line))]


def number(value: float, unit: str, digits: int = 4) -> str:
    """Return a number, whose SI unit is given, with the unit that is set or `shown_in`."""
    scale = scale_of(value, unit)
    return f"{rounded(scale.factor * value, digits)} {scale.unit}".rstrip()


def numbered(key: str, label: str, value: float, unit: str, digits: int = 4) -> Row:
    """Return the row of a number."""
    return Row(key, label, number(value, unit, digits), value, unit)


def column(
    heading: str, values: Sequence[float], unit: str, digits: int = 4
) -> tuple[str, list[str]]:
    """Return the heading of a column of numbers, with their one unit, and their texts."""
    scale = scale_of(max((abs(v) for v in values if math.isfinite(v)), default=0.0), unit)
    texts = [rounded(scale.factor * value, digits) for value in values]
    return f"{heading} [{scale.unit}]" if scale.unit else heading, texts


def scale_of(largest: float, unit: str) -> Scale:
    """Return the scale of numbers, whose SI unit is given, in units set or `shown_in`."""
    if (units := _units.get()) is None:
        return Scale.of(largest, unit)
    with display_units(units):
        return Scale.in_unit(largest, unit)


def scale_in(largest: float, unit: str) -> Scale:
    """Return the scale of numbers in any unit, in units set or `shown_in`."""
    if (units := _units.get()) is None:
        return Scale.in_unit(largest, unit)
    with display_units(units):
        return Scale.in_unit(largest, unit)


def share(error: float, value: float) -> str:
    """Return an error in per cent of a value; "" where there is none."""
    if error == 0:
        return ""
    if error >= abs(value):
        return "> 100 %"
    percent = 100 * error / abs(value)
    return f"{rounded(percent, 2)} %" if percent >= 0.01 else "< 0.01 %"


def rows(
    result: R,
    table: Iterable[Quantity],
    texts: Mapping[str, Callable[[R], str | None]],
    line: bool,
    rolls: bool = False,
) -> list[Row]:
    """Return the printed rows of quantities; a text in place of a number may leave one out."""
    printed = []
    for quantity in table:
        if not quantity.label:
            continue
        value, unit = quantity.of(result), quantity.si(line=line, rolls=rolls)
        if (text_of := texts.get(quantity.name)) is not None:
            text = text_of(result)
        elif value is None:
            text = None
        elif quantity.dims:
            text = pair(without_rounding(value), unit)
        else:
            text = written(value, unit)
        printed += [] if text is None else [Row(quantity.name, quantity.label, text, value, unit)]
    return printed


def along(texts: Sequence[str | None], mark: str = ", ", form: str = "({})") -> str | None:
    """Return texts along x and y, that of one axis with its name, or None where there is none."""
    named = [(axis, text) for axis, text in zip("xy", texts, strict=True) if text is not None]
    if len(named) == 1:
        return f"{named[0][1]} along {named[0][0]}"
    return form.format(mark.join(text for _, text in named)) if named else None


def without_rounding(values: Sequence[float]) -> list[float]:
    """Return two components; one that is rounding beside the other is 0."""
    largest = max(map(abs, values))
    return [value if abs(value) > SLIGHT * largest else 0.0 for value in values]


def pair(values: Iterable[float], unit: str) -> str:
    """Return components with their unit, one of all."""
    numbers = [*values]
    scale = scale_of(max((abs(v) for v in numbers if math.isfinite(v)), default=0.0), unit)
    texts = (f"{rounded(scale.factor * v, 4)} {scale.unit}".rstrip() for v in numbers)
    return f"({', '.join(texts)})"


def fields(instance: Any, units: Mapping[str, str]) -> list[Row]:
    """Return the printed rows of the public fields of a dataclass, some of which have SI units."""
    names = [field.name for field in dataclasses.fields(instance) if field.name[0] != "_"]
    values = {name: getattr(instance, name) for name in names if name != "warnings"}
    return [
        Row(name, name.replace("_", " "), _field(value, unit := units.get(name, "")), value, unit)
        for name, value in values.items()
        if not (value is None or (isinstance(value, Mapping | tuple | list) and not value))
    ]


def _field(value: object, unit: str) -> str:
    """Return a field in words: numbers with their unit, a peak and its place, an array's range."""
    if isinstance(value, float | np.floating):
        return number(float(value), unit)
    if isinstance(value, np.ndarray):
        ends = [np.fmin.reduce(value, None), np.fmax.reduce(value, None)] if value.size else []
        return " × ".join(map(str, value.shape)) + f": {' to '.join(_field(v, unit) for v in ends)}"
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_field(item, unit)}" for name, item in value.items())
    if isinstance(value, tuple | list):
        if len(value) > 1 and isinstance(value[1], tuple):
            return f"{_field(value[0], unit)} at {pair(value[1], 'm')}"
        return f"({', '.join(_field(item, unit) for item in value)})"
    return str(value)


def text(rows: Sequence[Row], warnings: Sequence[str]) -> str:
    """Return the table that ``print`` shows: names and values, and warnings below."""
    width = max(len(row.label) for row in rows)
    lines = [
        line
        for row in rows
        for line in (
            wrap(f"{row.label:{width}}  {row.text}", width + 2) if row.label else wrap(row.text)
        )
    ]
    notes = [line for warning in warnings for line in wrap(f"warning: {warning}")]
    return printable("\n".join([*lines, *notes]))


def part(place: InLayer | AtInterface) -> str:
    """Return number and name of a layer, or number of an interface, in a summary."""
    if isinstance(place, AtInterface):
        return f"interfaces[{place.interface}]"
    if place.depths[1] == np.inf:
        return "the substrate"
    return layer_name(place.layer, place.name)


def part_in_words(place: InLayer | AtInterface, layers: Sequence[InLayer]) -> str:
    """Return a part of a body with its preposition, as "of the coating" or "below DLC"."""
    layer = layers[place.interface] if isinstance(place, AtInterface) else place
    if layer.depths[1] == np.inf:
        return "of the substrate"
    name = layer_in_words(layer.layer, layer.name, len(layers) - 1)
    return f"{'below' if isinstance(place, AtInterface) else 'of'} {name}"


def layer_in_words(number: int, name: str | None, count: int) -> str:
    """Return a layer by its name, or by its place among some layers."""
    if name is not None or count == 1:
        return name or "the coating"
    return f"the {ORDINALS[number]} layer" if number < len(ORDINALS) else f"layer {number + 1}"


def layer_name(number: int, name: str | None) -> str:
    """Return number and name of a layer."""
    return f"layers[{number}]" if name is None else f"layers[{number}] {name}"


def markup(
    rows: Sequence[Sequence[str]],
    warnings: Sequence[str] = (),
    picture: bytes | None = None,
    head: Sequence[str] = (),
    notes: Sequence[str] = (),
    verdict: Sequence[str] = (),
) -> str:
    """Return what a notebook shows of any result: a table, a picture beside it, and notes below.

    The sentences of a verdict stand above the table.
    """
    lines = [*notes, *(f"warning: {text}" for text in warnings)]
    cells = [*([_cells("th", head)] if head else []), *(_cells("td", row) for row in rows)]
    encoded = "" if picture is None else base64.b64encode(picture).decode()
    kind = "svg+xml" if picture is not None and picture.startswith(b"<svg") else "png"
    image = picture and (
        f"<img alt='{ALT}' style='border:1px solid #bbb; max-width:{WIDE}px' "
        f"src='data:image/{kind};base64,{encoded}'>"
    )
    return (
        "".join(f"<p>{html.escape(sentence)}</p>" for sentence in verdict)
        + f"<div style='display:flex; gap:16px; align-items:flex-start'>"
        f"<table>{''.join(cells)}</table>{image or ''}</div>"
        + "".join(f"<p>{html.escape(note)}</p>" for note in lines)
    )


def _cells(tag: str, row: Sequence[str]) -> str:
    """Return a row of a table of HTML."""
    cell = f"<{tag} style='text-align:left; padding:1px 12px 1px 0'>"
    return f"<tr>{''.join(f'{cell}{html.escape(text)}</{tag}>' for text in row)}</tr>"


def aligned(rows: Sequence[Sequence[str]], side: str = ">") -> list[str]:
    """Return the lines of a table whose columns are as wide as their widest cells.

    Within `wrapped` the headings of a wider table are broken, and it is continued below, by its
    first column, if it is wider yet.
    """
    most = _width.get()
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    if most is not None and sum(widths) + 2 * (len(widths) - 1) > most:
        rows = _with_broken_heads(rows)
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    blocks: list[list[int]] = [[0]]
    for k in range(1, len(widths)):
        taken = sum(widths[place] + 2 for place in blocks[-1])
        if most is not None and len(blocks[-1]) > 1 and taken + widths[k] > most:
            blocks.append([0])
        blocks[-1].append(k)
    parts = [
        ["  ".join(f"{row[k]:{side}{widths[k]}}" for k in block).rstrip() for row in rows]
        for block in blocks
    ]
    filled = (dropwhile(lambda line: not line, part) for part in parts)  # heads of fewer lines
    return [line for number, part in enumerate(filled) for line in ([""] * (number > 0) + [*part])]


def _with_broken_heads(rows: Sequence[Sequence[str]]) -> list[Sequence[str]]:
    """Return the rows of a table whose headings, the first row, are no wider than their cells."""
    head, *cells = rows
    narrowest = [max(map(len, column)) for column in zip(*cells, strict=True)] or [1] * len(head)
    lines = [
        textwrap.wrap(name, max(least, *map(len, name.split()), 1)) if name else []
        for name, least in zip(head, narrowest, strict=True)
    ]
    most = max(map(len, lines))
    padded = [[""] * (most - len(words)) + words for words in lines]
    return [*zip(*padded, strict=True), *cells]


def loaded_parts(pressure: npt.NDArray[np.float64]) -> list[tuple[int, int]]:
    """Return the first and last cells along x and y of the contact and a margin around it."""
    extents = []
    for axis, cells in enumerate(pressure.shape):
        loaded = np.flatnonzero(pressure.any(axis=1 - axis))
        low, high = (loaded[0], loaded[-1]) if loaded.size else (0, cells - 1)
        margin = 1 + (high - low) // 10
        extents.append((max(low - margin, 0), min(high + margin, cells - 1)))
    return extents


def figure_of(axes: Axes) -> Figure:
    """Return the figure that axes are drawn in."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    return figure


def drawn(draw: Callable[[], Axes]) -> bytes | None:
    """Return a PNG of the picture of which `draw` returns the axes; without Matplotlib, none."""
    try:
        from matplotlib import pyplot
    except ImportError:
        return None
    figure, file = figure_of(draw()), io.BytesIO()
    figure.savefig(file, format="png", dpi=100)
    pyplot.close(figure)
    return file.getvalue()


def estimated(solution: Estimated, name: str, unit: str, digits: int = 4) -> str:
    """Return a number, with the discretisation error where it is estimated."""
    value = getattr(solution, name)
    error = (solution.report.discretisation or {}).get(name, 0.0)
    if error is None:
        return f"{number(value, unit, digits)} (error not known: see the warning)"
    return number(value, unit, digits) + plus_minus(error, value)


def estimated_row(solution: Estimated, quantity: Quantity, digits: int = 4) -> Row:
    """Return the row of a number, with the discretisation error where it is estimated."""
    name, unit = quantity.name, quantity.si()
    text = estimated(solution, name, unit, digits)
    error = (solution.report.discretisation or {}).get(name)
    return Row(name, quantity.label, text, getattr(solution, name), unit, error)


def plus_minus(error: float, value: float) -> str:
    """Return what is said of an error of a value: nothing where it is rounding."""
    share = abs(error / value) if value else 0.0
    return f" ± {rounded(100 * share, 1)} %" if share > NOISE else ""


def body(name: str, body: Planned | None) -> list[Row]:
    """Describe a body: its substrate, a row for each layer or one for many, and its free ends."""
    if body is None:
        return [remark(name, "rigid")]
    if isinstance(body, Response):
        return [remark(name, "a response")]
    layers = [
        Row(
            f"{name}.layers[{number}]",
            f"  {layer_name(number, layer.name)}",
            f"{written(layer.thickness, 'm', 3)}, {_material(layer.material)}"
            f"{_spring(layer.interface)}",
        )
        for number, layer in enumerate(body.layers)
    ]
    if len(layers) > LAYER_ROWS:
        depth = written(body.interfaces[-1], "m", 3)
        layers = [Row(f"{name}.layers", "  layers", f"{len(layers)}, together {depth}")]
    places = [f"x = {written(x, 'm')}" for x in body.ends if x is not None]
    label = "  free end" if len(places) == 1 else "  free ends"
    ends = [Row(f"{name}.ends", label, " and ".join(places))] if places else []
    return [remark(name, _material(body.substrate)), *layers, *ends]


def moduli(*members: Planned | None) -> list[Row]:
    """Return the contact modulus of the substrates; with coatings also of the surfaces.

    There is none where a body is a response.
    """
    bodies = [body for body in members if isinstance(body, HalfSpace)]
    if any(isinstance(body, Response) for body in members):
        return []
    bases = [body.substrate for body in bodies]
    tops = [body.layers[0].material if body.layers else body.substrate for body in bodies]
    of_surfaces = Row("surface_modulus", "E* (surfaces)", _modulus(tops))
    if any(isinstance(base, Free) for base in bases):
        return [of_surfaces]
    label = "E* (substrates)" if tops != bases else "E*"
    of_substrates = Row("contact_modulus", label, _modulus(bases))
    return [of_substrates, of_surfaces] if tops != bases else [of_substrates]


def _modulus(materials: Sequence[Elastic | Rigid | Free]) -> str:
    compliance = sum(1 / m.plane_strain_modulus for m in materials if isinstance(m, Elastic))
    return written(1 / compliance, "Pa") if compliance else "rigid"


def _spring(interface: str | Spring) -> str:
    """Describe the springs below a layer."""
    if not isinstance(interface, Spring):
        return ""
    directions = (("normal", interface.normal), ("tangential", interface.tangential))
    stiffnesses = [f"{name} {written(k, 'Pa/m', 3)}" for name, k in directions if k is not None]
    return f", on springs: {', '.join(stiffnesses)}"


def _material(material: Elastic | Rigid | Free) -> str:
    if isinstance(material, Rigid):
        return "a rigid base"
    if isinstance(material, Free):
        return "a free base"
    return f"E {written(material.young, 'Pa', 3)}, ν {material.poisson:g}"
