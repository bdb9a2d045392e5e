"""Pictures as SVG, from numbers to text: curves, loads around a ring, and maps of cells.

Colours are names of classes, which `STYLE` sets, so that a page can have others in print.
"""

from __future__ import annotations

import base64
import html
import math
import struct
import zlib
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from nacre._tools.markup import text_of
from nacre._tools.units import rounded
from nacre.results.charts import HEADROOM, Array, Axis, Bars, Chart, Curve, Ends, Map, Picture

WIDTH, HEIGHT = 460, 290
LEFT, RIGHT, TOP, BOTTOM = 62, 12, 12, 42
"""Sides of a picture, and what is left free around its curves, in pixels."""
LINE = 16
"""Height of a line of text."""
BAR = 78
"""Width of a colour bar with its numbers."""
MOST_POINTS, MOST_CELLS = 300, 240
"""Largest numbers of points of a curve, and of cells along a side of a map."""
ABREAST, STACKED = 52, 32
"""Least distances of ticks along x and along y, where numbers are above each other."""
INNER, OUTER = 56.0, 130.0
"""Radii of the ring from which bars stand out, and of the largest load."""
MOST_NUMBERS = 20
"""Largest number of elements of a ring that are numbered."""
INSET, ABOVE = 0.36, 2.0
"""Size of an inset over that of the picture, and of y over the curves, so that it is free."""
FEW_LABELS, LETTER = 4, 6.5
"""Largest number of labels that are below each other; width of a letter."""
VIRIDIS = "440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725"
"""Colours of Matplotlib's map viridis, at equal distances."""
STYLE = text_of("nacre.results", "svg.css")
"""Style sheet of pictures."""
GRADED = 0.9
"""Largest share of the colour map that curves have: yellow is hard to see on white."""


class Side:
    """An axis in a picture: which coordinate a number has.

    >>> Side(Axis("x", "m", (0.0, 2e-3)), (0.0, 2e-3), 60, 460).at(np.array([5e-4])).tolist()
    [160.0]
    """

    def __init__(self, axis: Axis, ends: Ends, start: float, end: float) -> None:
        self.scale, self.label = axis.units(max(map(abs, ends)))
        self.is_log = axis.scale == "log"
        self.low, self.high = self._along(self.scale.factor * np.array(ends)).tolist()
        self.start, self.end = start, end

    def at(self, values: Array) -> Array:
        """Return the coordinates of numbers in SI."""
        return self.place(self.scale.factor * values)

    def place(self, values: Array) -> Array:
        """Return the coordinates of numbers in the unit of the axis."""
        share = (self._along(values) - self.low) / ((self.high - self.low) or 1.0)
        places: Array = self.start + share * (self.end - self.start)
        return places

    def _along(self, values: Array) -> Array:
        along: Array = np.log10(values) if self.is_log else values
        return along

    def ticks(self) -> list[tuple[float, str]]:
        """Return the coordinates of round numbers, and these as text."""
        apart = ABREAST if self.end > self.start else STACKED
        low, high = sorted((self.low, self.high))
        most = abs(self.end - self.start) / apart
        if self.is_log and high - low < 1.0:  # less than a decade
            values = round_numbers(10.0**low, 10.0**high, most)
        elif self.is_log:
            values = np.array([float(f"{10.0**v:.1g}") for v in round_numbers(low, high, most)])
            values = np.unique(values[(values >= 10.0**low) & (values <= 10.0**high)])
        else:
            values = round_numbers(low, high, most)
        return [(float(self.place(v)), f"{v:.6g}") for v in values]


def round_numbers(low: float, high: float, most: float) -> Array:
    """Return multiples of 1, 2 or 5 times a power of ten between two numbers.

    >>> round_numbers(-0.3, 0.92, 7).tolist()
    [-0.2, 0.0, 0.2, 0.4, 0.6, 0.8]
    """
    if not high > low:
        return np.array([low])
    least = (high - low) / max(most, 2.0)
    power = math.floor(math.log10(least))
    step = next(factor for factor in (1, 2, 5, 10) if factor * 10.0**power >= least)
    first, last = (r / (step * 10.0**power) for r in (low, high))
    counts = np.arange(math.ceil(first - 1e-9), math.floor(last + 1e-9) + 1)
    return np.round(counts * step * 10.0**power, max(0, -power)) + 0.0


def drawing(picture: Picture) -> str:
    """Return the picture of curves, of bars or of a map."""
    if isinstance(picture, Chart):
        return _chart(picture, (WIDTH, HEIGHT))
    return _ring(picture) if isinstance(picture, Bars) else _map(picture)


def _chart(chart: Chart, size: tuple[float, float]) -> str:
    """Return curves, with vertical lines at marks.

    The inset is in the upper right corner, above the curves.
    """
    curves, axes, inset = chart.curves, chart.axes, chart.inset
    points = [_thinned(curve, axes[0].ends or (-math.inf, math.inf)) for curve in curves]
    low, high = _ends(
        [heights for _, heights in points], has_zero=axes[1].has_zero and axes[1].scale == "linear"
    )
    x_ends = axes[0].ends or _ends([places for places, _ in points])
    colours = _colours(curves)
    labels = [(k, curve.label) for k, curve in enumerate(curves) if curve.label]
    columns, column = 1, 40 + LETTER * max((len(label) for _, label in labels), default=0)
    if len(labels) > FEW_LABELS:
        columns = max(1, int((size[0] - LEFT) / column))
    x = Side(axes[0], x_ends, LEFT, size[0] - RIGHT)
    y_ends = axes[1].ends or (low, high * (1.0 if inset is None else ABOVE))
    y = Side(axes[1], y_ends, size[1] - BOTTOM, TOP + LINE * math.ceil(len(labels) / columns))
    elements = [_frame(x, y)]
    elements += [
        _curve(curve.look, colour, x, y, places)
        for curve, colour, places in zip(curves, colours, points, strict=True)
    ]
    for mark in x.at(np.array([place for place in chart.marks if x_ends[0] < place < x_ends[1]])):
        elements.append(f"<path class='mark' d='M{mark:.1f} {y.start:.1f}V{y.end:.1f}'/>")
    for number, (k, label) in enumerate(labels):
        left, top = LEFT + column * (number % columns), TOP + LINE * (number // columns)
        elements.append(f"<path {colours[k]} stroke-width='2' d='M{left:.6g} {top}h18'/>")
        elements.append(_text(label, left + 24, top + 4))
    if inset is not None:
        small = (INSET * size[0], INSET * size[1])
        corner = f"x='{x.end - small[0]:.1f}' y='{y.end + 2:.1f}'"
        units = axes[0]._replace(name="", ends=inset), axes[1]._replace(name="")
        unnamed = [curve._replace(label="") for curve in curves]
        inner = _chart(chart._replace(curves=unnamed, axes=units, inset=None), small)
        size_of = f"width='{small[0]}' height='{small[1]}'"
        elements.append(inner.replace("<svg", f"<svg {corner} {size_of}", 1))
    return _picture(elements, size)


def _colours(curves: Sequence[Curve]) -> list[str]:
    """Return the attributes of the colours of curves."""
    shares, number, colours = np.linspace(0.0, GRADED, len(curves)), -1, []
    for curve, (red, green, blue) in zip(curves, viridis(shares), strict=True):
        number += curve.look != "thin"
        graded = f"stroke='#{red:02x}{green:02x}{blue:02x}'"  # pages allow no style here
        colours.append(graded if curve.look == "graded" else f"class='c{number % 7}'")
    return colours


def _ring(ring: Bars) -> str:
    """Return loads around a ring as bars."""
    heights, labels = ring.loads, ring.labels
    count, series = heights.shape
    places = ring.angles
    x, y = WIDTH / 2, TOP + LINE * (len(labels) + 1) + OUTER
    radius = Side(ring.axis, (0.0, float(heights.max(initial=0.0)) or 1.0), INNER, OUTER)
    width = min(7.0, 0.7 * 2 * math.pi * INNER / (count * series))
    elements = [_text(radius.label, x, TOP + 4, "middle")]
    largest = float(radius.scale.factor * heights.max(initial=0.0))
    last = [(OUTER, f"largest {rounded(largest, 3)}")] if largest else []
    inside = [tick for tick in radius.ticks() if tick[0] < OUTER - LINE]
    for length, number in [*inside, *last]:
        elements.append(f"<circle class='frame' cx='{x}' cy='{y}' r='{length:.1f}'/>")
        elements.append(_text(number, x + 3, y - length - 2))
    for k, label in enumerate(filter(None, labels)):
        elements.append(f"<path class='c{k}' stroke-width='7' d='M4 {TOP + LINE * (k + 1)}h10'/>")
        elements.append(_text(label, 20, TOP + LINE * (k + 1) + 4))
    shifts = 1.2 * width / INNER * (np.arange(series) - (series - 1) / 2)
    for (j, k), end in np.ndenumerate(radius.at(heights)):
        c, s = math.cos(places[j, k] + shifts[k]), -math.sin(places[j, k] + shifts[k])
        ends = f"M{x + INNER * c:.1f} {y + INNER * s:.1f}L{x + end * c:.1f} {y + end * s:.1f}"
        if end > INNER:
            elements.append(f"<path class='c{k}' stroke-width='{width:.1f}' d='{ends}'/>")
        if k == 0 and j % math.ceil(count / MOST_NUMBERS) == 0:
            across, down = math.cos(places[j, 0]), -math.sin(places[j, 0])
            place = x + (INNER - 12) * across, y + (INNER - 12) * down + 4
            elements.append(_text(f"{j}", *place, "middle"))
    return _picture(elements, (WIDTH, y + OUTER + LINE))


def _map(cells: Map) -> str:
    """Return a map of cells, with its colour bar."""
    values, axes = cells.values, cells.axes
    (x_low, x_high), (y_low, y_high) = (axis.ends or (0.0, 1.0) for axis in axes[:2])
    low, high = axes[2].ends or (0.0, float(values[np.isfinite(values)].max(initial=0.0)) or 1.0)
    widest, highest = WIDTH - LEFT - RIGHT - BAR, 1.2 * HEIGHT
    aspect = (x_high - x_low) / (y_high - y_low)
    width = max(60.0, min(widest, highest * aspect))
    height = max(60.0, min(highest, width / aspect))
    x = Side(axes[0], (x_low, x_high), LEFT, LEFT + width)
    y = Side(axes[1], (y_low, y_high), TOP + height, TOP)
    colour, right = Side(axes[2], (low, high), y.start, y.end), x.end + RIGHT
    elements = [
        _cells((values - low) / ((high - low) or 1.0), LEFT, TOP, width, height),
        _cells(np.linspace(0.0, 1.0, 128)[None, :], right, TOP, 12, height),
        _frame(x, y, "frame"),
        *(_text(number, right + 16, place + 4) for place, number in colour.ticks()),
        _text(colour.label, right + 12, TOP + height + 34, "end"),
    ]
    return _picture(elements, (WIDTH, TOP + height + BOTTOM))


def _cells(shares: Array, x: float, y: float, width: float, height: float) -> str:
    """Return an image of shares of the colour map, in place."""
    data = base64.b64encode(png(shares)).decode()
    place = f"x='{x:.1f}' y='{y:.1f}' width='{width:.1f}' height='{height:.1f}'"
    return f"<image {place} preserveAspectRatio='none' href='data:image/png;base64,{data}'/>"


def png(shares: Array) -> bytes:
    """Return a PNG of shares of viridis ``(nx, ny)`` from 0 to 1, y upwards; NaN is white."""
    keep = [np.linspace(0, n - 1, min(n, MOST_CELLS)).round().astype(int) for n in shares.shape]
    rows = shares[np.ix_(*keep)].T[::-1]
    index = 1 + np.round(254 * np.clip(np.nan_to_num(rows), 0.0, 1.0))
    pixels = np.where(np.isfinite(rows), index, 0).astype(np.uint8)
    lines_of = np.insert(pixels, 0, 0, axis=1).tobytes()  # each begins with its filter, none
    chunks = {
        b"IHDR": struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 3, 0, 0, 0),
        b"PLTE": b"\xff\xff\xff" + viridis(np.linspace(0.0, 1.0, 255)).tobytes(),
        b"IDAT": zlib.compress(lines_of, 9),
        b"IEND": b"",
    }
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks.items()
    )


def viridis(shares: Array) -> npt.NDArray[np.uint8]:
    """Return the colours ``(n, 3)`` of Matplotlib's map viridis at shares from 0 to 1."""
    nodes = np.array([list(bytes.fromhex(colour)) for colour in VIRIDIS.split()])
    colours = [np.interp(shares * (len(nodes) - 1), range(len(nodes)), base) for base in nodes.T]
    return np.stack(colours, axis=1).round().astype(np.uint8)


def _thinned(curve: Curve, ends: Ends) -> tuple[Array, Array]:
    """Return the finite points of a curve between two places, not too many, with its extremes."""
    x, y = curve.x, curve.y
    if x.size and curve.look != "points" and np.all(np.diff(x) >= 0):
        between = [end for end in ends if x[0] < end < x[-1] and end not in x]
        places = np.searchsorted(x, between)
        x, y = np.insert(x, places, between), np.insert(y, places, np.interp(between, x, y))
    inside = np.isfinite(x) & np.isfinite(y) & (x >= ends[0]) & (x <= ends[1])
    x, y = x[inside], y[inside]
    if x.size <= MOST_POINTS:
        return x, y
    places = np.linspace(0, x.size - 1, MOST_POINTS - 2).round().astype(int)
    keep = np.union1d(places, [y.argmax(), y.argmin()])
    return x[keep], y[keep]


def _ends(data: Sequence[Array], has_zero: bool = False) -> Ends:
    """Return the ends of numbers; with 0 among them, they have room beyond."""
    values = np.concatenate([*data, [0.0]] if has_zero or not any(map(np.size, data)) else data)
    low, high = float(values.min()), float(values.max())
    if low == high:  # one number, or none
        low, high = min(low, 0.0), max(high, 0.0) or 1.0
    room = HEADROOM * (high - low) if has_zero else 0.0
    return low - room * (low < 0), high + room * (high > 0)


def _frame(x: Side, y: Side, paper: str = "frame paper") -> str:
    """Return the frame of a picture, with ticks and labels."""
    width, height = x.end - x.start, y.start - y.end
    size = f"width='{width:.1f}' height='{height:.1f}'"
    elements = [f"<rect class='{paper}' x='{x.start}' y='{y.end}' {size}/>"]
    for place, number in x.ticks():
        elements.append(f"<path class='frame' d='M{place:.1f} {y.start:.1f}v4'/>")
        elements.append(_text(number, place, y.start + 16, "middle"))
    for place, number in y.ticks():
        elements.append(f"<path class='frame' d='M{x.start:.1f} {place:.1f}h-4'/>")
        elements.append(_text(number, x.start - 7, place + 4, "end"))
    elements.append(_text(x.label, (x.start + x.end) / 2, y.start + 34, "middle"))
    middle = (y.start + y.end) / 2
    turned = f"<g transform='rotate(-90 12 {middle:.1f})'>"
    return "".join(elements) + turned + _text(y.label, 12, middle + 2, "middle") + "</g>"


def _curve(look: str, colour: str, x: Side, y: Side, points: tuple[Array, Array]) -> str:
    """Return a curve, its points, or both."""
    places = [*zip(x.at(points[0]), y.at(points[1]), strict=True)]
    text = " ".join(f"{a:.1f},{b:.1f}" for a, b in places)
    line = f"<g {colour}><polyline class='{look}' points='{text}'/></g>"
    if look not in ("points", "marked"):
        return line
    filled = colour.replace("class='c", "class='p")
    dots = (f"<circle {filled} cx='{a:.1f}' cy='{b:.1f}' r='2.2'/>" for a, b in places)
    return line * (look == "marked") + "".join(dots)


def _text(words: str, x: float, y: float, side: str = "start") -> str:
    return f"<text class='{side}' x='{x:.1f}' y='{y:.1f}'>{html.escape(words)}</text>"


def alone(drawing: str) -> bytes:
    """Return a picture as a file of its own, with its style sheet."""
    head = f"<svg xmlns='http://www.w3.org/2000/svg' width='{WIDTH}'"
    return drawing.replace("<svg", head, 1).replace(">", f"><style>{STYLE}</style>", 1).encode()


def _picture(elements: Sequence[str], size: tuple[float, float]) -> str:
    return f"<svg viewBox='0 0 {size[0]:.0f} {size[1]:.0f}'>{''.join(elements)}</svg>"
