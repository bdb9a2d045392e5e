"""Pictures as SVG, from numbers to text: curves, loads around a ring, and maps of cells.

Colours are names of classes, which `STYLE` sets, so that a page can have others in print. Numbers
are in SI, and are drawn in the units that are set.
"""

from __future__ import annotations

import base64
import html
import math
import struct
import zlib
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from nacre._tools.units import Scale, symbol
from nacre.results import display

Array = npt.NDArray[np.float64]
Ends = tuple[float, float]

WIDTH, HEIGHT = 460, 290
LEFT, RIGHT, TOP, BOTTOM = 62, 12, 12, 42
"""Sides of a picture, and what is left free around its curves, in pixels."""
LINE = 16
"""Height of a line of text."""
BAR = 78
"""Width of a colour bar with its numbers."""
MOST_POINTS, MOST_CELLS = 300, 240
"""Largest numbers of points of a curve, and of cells along a side of a map."""
TICKS = 5
"""Number of intervals between ticks, at most."""
HEADROOM = 0.05
"""Share of the range that stays free beyond curves, where they do not end at 0."""
VIRIDIS = "440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725"
"""Colours of Matplotlib's map viridis, at equal distances."""
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#555")
"""Colours of curves that everybody can tell apart: Wong, Nature Methods 8 (2011) 441."""
STYLE = (
    "svg text{font:11px sans-serif;fill:#222}"
    "svg .frame{fill:none;stroke:#888}svg .paper{fill:#fff}svg .grid{stroke:#ddd}"
    "svg .mark{stroke:#666;stroke-dasharray:2 3}svg polyline{fill:none;stroke-width:1.6}"
    "svg .dashed{stroke-dasharray:6 4}svg .bar{stroke-width:7}"
    "svg .middle{text-anchor:middle}svg .end{text-anchor:end}svg image{image-rendering:pixelated}"
    + "".join(f"svg .c{k}{{stroke:{c}}}svg .p{k}{{fill:{c}}}" for k, c in enumerate(COLOURS))
)
"""Style sheet of pictures."""


class Axis(NamedTuple):
    """What is drawn along an axis; the ends are those of the numbers by default."""

    name: str
    unit: str = ""
    ends: Ends | None = None


class Curve(NamedTuple):
    """Numbers along x and y, drawn as a line, a dashed line or points."""

    x: npt.ArrayLike
    y: npt.ArrayLike
    label: str = ""
    look: str = "line"


class Side:
    """An axis in a picture: which coordinate a number has.

    >>> Side(Axis("x", "m", (0.0, 2e-3)), (0.0, 2e-3), 60, 460).at(np.array([5e-4])).tolist()
    [160.0]
    """

    def __init__(self, axis: Axis, ends: Ends, start: float, end: float) -> None:
        self.scale: Scale = display.scale_in(max(map(abs, ends)), symbol(axis.unit))
        self.label = f"{axis.name} [{self.scale.unit}]" if self.scale.unit else axis.name
        self.low, self.high = (self.scale.factor * one for one in ends)
        self.start, self.end = start, end

    def at(self, values: Array) -> Array:
        """Return the coordinates of numbers in SI."""
        return self.place(self.scale.factor * values)

    def place(self, values: Array) -> Array:
        """Return the coordinates of numbers in the unit of the axis."""
        share = (values - self.low) / ((self.high - self.low) or 1.0)
        return self.start + share * (self.end - self.start)

    def ticks(self) -> list[tuple[float, str]]:
        """Return the coordinates of round numbers, and these as text."""
        values = round_numbers(self.low, self.high)
        return [(float(self.place(v)), f"{v:.6g}") for v in values]


def round_numbers(low: float, high: float) -> Array:
    """Return multiples of 1, 2 or 5 times a power of ten between two numbers.

    >>> round_numbers(-0.3, 0.92).tolist()
    [-0.2, 0.0, 0.2, 0.4, 0.6, 0.8]
    """
    if not high > low:
        return np.array([low])
    least = (high - low) / (TICKS + 1.5)
    power = math.floor(math.log10(least))
    step = next(factor for factor in (1, 2, 5, 10) if factor * 10.0**power >= least)
    first, last = (r / (step * 10.0**power) for r in (low, high))
    counts = np.arange(math.ceil(first - 1e-9), math.floor(last + 1e-9) + 1)
    return np.round(counts * step * 10.0**power, max(0, -power)) + 0.0


def lines(
    curves: Sequence[Curve],
    axes: tuple[Axis, Axis],
    marks: Sequence[float] = (),
    inset: Ends | None = None,
    size: tuple[float, float] = (WIDTH, HEIGHT),
) -> str:
    """Return a picture of curves, with vertical lines at `marks`, and a part of x as an inset."""
    drawn = [_thinned(curve) for curve in curves]
    ends = [axis.ends or _ends([c[k] for c in drawn], k == 1) for k, axis in enumerate(axes)]
    labels = [(k, curve.label) for k, curve in enumerate(curves) if curve.label]
    top = TOP + LINE * len(labels)
    x = Side(axes[0], ends[0], LEFT, size[0] - RIGHT)
    y = Side(axes[1], ends[1], size[1] - BOTTOM, top)
    parts = [
        _frame(x, y),
        *(_curve(k, c.look, x, y, d) for k, (c, d) in enumerate(zip(curves, drawn, strict=True))),
    ]
    for mark in x.at(np.array([one for one in marks if ends[0][0] < one < ends[0][1]])):
        parts.append(f"<path class='mark' d='M{mark:.1f} {y.start:.1f}V{y.end:.1f}'/>")
    for row, (k, label) in enumerate(labels):
        height = TOP + LINE * row
        parts.append(f"<path class='c{k % 7}' stroke-width='2' d='M{LEFT} {height}h18'/>")
        parts.append(_text(label, LEFT + 24, height + 4))
    if inset is not None:
        parts.append(_inset(curves, axes, marks, inset, y))
    return _picture(parts, size)


def _inset(
    curves: Sequence[Curve], axes: tuple[Axis, Axis], marks: Sequence[float], ends: Ends, y: Side
) -> str:
    """Return the part of curves between two places, small, in the upper right corner."""
    near = []
    for curve in curves:
        x, values = np.asarray(curve.x, dtype=np.float64), np.asarray(curve.y, dtype=np.float64)
        inside = x <= ends[1]
        near.append(Curve(x[inside], values[inside], "", curve.look))
    size = (0.52 * WIDTH, 0.5 * HEIGHT)
    inner = lines(near, (axes[0]._replace(ends=ends), axes[1]), marks, None, size)
    place = f"<svg x='{WIDTH - RIGHT - size[0] - 4:.1f}' y='{y.end + 4:.1f}' "
    return inner.replace("<svg ", f"{place}width='{size[0]:.1f}' height='{size[1]:.1f}' ", 1)


def bars(
    angles: npt.ArrayLike, loads: npt.ArrayLike, axis: Axis, labels: Sequence[str] = ()
) -> str:
    """Return a picture of loads ``(Z, rings)`` around a ring: bars at angles from x [rad]."""
    places, heights = np.asarray(angles, dtype=np.float64), np.asarray(loads, dtype=np.float64)
    rings = heights.shape[1]
    middle, inner, outer = WIDTH / 2, 44.0, 122.0
    top = TOP + LINE * (len(labels) + 1)
    centre = top + outer + LINE
    radius = Side(axis, (0.0, float(heights.max(initial=0.0)) or 1.0), inner, outer)
    parts = [_text(radius.label, WIDTH / 2, TOP + 4, "middle")]
    for length, number in radius.ticks():
        parts.append(f"<circle class='frame' cx='{middle}' cy='{centre}' r='{length:.1f}'/>")
        parts.append(_text(number, middle + 3, centre - length - 2))
    for k, label in enumerate(labels, start=1):
        parts.append(_text(label, 20, TOP + 4 + LINE * k))
        parts.append(f"<path class='c{k - 1} bar' d='M4 {TOP + LINE * k}h10'/>")
    for ring in range(rings):
        shift = 9.0 / inner * (ring - (rings - 1) / 2)
        for j, (angle, end) in enumerate(
            zip(places + shift, radius.at(heights[:, ring]), strict=True)
        ):
            c, s = math.cos(angle), -math.sin(angle)
            first = f"M{middle + inner * c:.1f} {centre + inner * s:.1f}"
            last = f"L{middle + end * c:.1f} {centre + end * s:.1f}"
            parts.append(f"<path class='c{ring} bar' d='{first}{last}'/>" if end > inner else "")
            if ring == 0:
                x, y = (inner - 12) * np.array([math.cos(places[j]), -math.sin(places[j])])
                parts.append(_text(f"{j}", middle + x, centre + y + 4, "middle"))
    return _picture(parts, (WIDTH, centre + outer + LINE))


def image(values: Array, axes: tuple[Axis, Axis, Axis]) -> str:
    """Return a map of cells ``(nx, ny)``, x to the right and y upwards; NaN stays white.

    The axes are those of x and y, whose ends are those of the map, and of the values.
    """
    finite = values[np.isfinite(values)]
    low, high = axes[2].ends or (0.0, float(finite.max(initial=0.0)) or 1.0)
    spans = [end - start for start, end in (axis.ends or (0.0, 1.0) for axis in axes[:2])]
    widest, highest = WIDTH - LEFT - RIGHT - BAR, 1.2 * HEIGHT
    width = max(60.0, min(widest, highest * spans[0] / spans[1]))
    height = max(60.0, min(highest, width * spans[1] / spans[0]))
    x = Side(axes[0], axes[0].ends or (0.0, 1.0), LEFT, LEFT + width)
    y = Side(axes[1], axes[1].ends or (0.0, 1.0), TOP + height, TOP)
    right = LEFT + width + RIGHT
    colour = Side(axes[2], (low, high), y.start, y.end)
    scale = np.linspace(low, high, 128)[None, :]
    parts = [
        _cells((values - low) / ((high - low) or 1.0), LEFT, TOP, width, height),
        _cells((scale - low) / ((high - low) or 1.0), right, TOP, 12, height),
        _frame(x, y, "frame"),
        *(_text(number, right + 16, place + 4) for place, number in colour.ticks()),
        _text(colour.label, right + 12, TOP + height + 34, "end"),
    ]
    return _picture(parts, (WIDTH, TOP + height + BOTTOM))


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
    nodes = np.array([list(bytes.fromhex(colour)) for colour in VIRIDIS.split()])
    along = np.linspace(0, len(nodes) - 1, 255)
    colours = [np.interp(along, np.arange(len(nodes)), nodes[:, k]).round() for k in range(3)]
    palette = b"\xff\xff\xff" + np.stack(colours, axis=1).astype(np.uint8).tobytes()
    head = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 3, 0, 0, 0)
    lines_of = np.insert(pixels, 0, 0, axis=1).tobytes()  # each begins with its filter, none
    chunks = [
        (b"IHDR", head),
        (b"PLTE", palette),
        (b"IDAT", zlib.compress(lines_of, 9)),
        (b"IEND", b""),
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )


def _thinned(curve: Curve) -> tuple[Array, Array]:
    """Return the finite points of a curve, not too many, its largest and smallest among them."""
    x, y = (np.asarray(part, dtype=np.float64) for part in (curve.x, curve.y))
    finite = np.isfinite(x) & np.isfinite(y)
    x, y = x[finite], y[finite]
    if x.size <= MOST_POINTS:
        return x, y
    places = np.linspace(0, x.size - 1, MOST_POINTS - 2).round().astype(int)
    keep = np.union1d(places, [y.argmax(), y.argmin()])
    return x[keep], y[keep]


def _ends(parts: Sequence[Array], has_zero: bool) -> Ends:
    """Return the ends of numbers; those along y have 0 among them, and room beyond."""
    values = np.concatenate([*parts, [0.0]] if has_zero or not parts else parts)
    low, high = float(values.min(initial=np.inf)), float(values.max(initial=-np.inf))
    if not high > low:
        low = 0.0 if not math.isfinite(low) else min(low, 0.0)
        high = max(low + 1.0 if not high > low else high, high)
    room = HEADROOM * (high - low) if has_zero else 0.0
    return low - room * (low < 0), high + room * (high > 0)


def _frame(x: Side, y: Side, paper: str = "frame paper") -> str:
    """Return the frame of a picture, with ticks and labels."""
    width, height = x.end - x.start, y.start - y.end
    parts = [
        f"<rect class='{paper}' x='{x.start}' y='{y.end}' width='{width:.1f}' height='{height:.1f}'/>"
    ]
    for place, number in x.ticks():
        parts.append(f"<path class='frame' d='M{place:.1f} {y.start:.1f}v4'/>")
        parts.append(_text(number, place, y.start + 16, "middle"))
    for place, number in y.ticks():
        parts.append(f"<path class='frame' d='M{x.start:.1f} {place:.1f}h-4'/>")
        parts.append(_text(number, x.start - 7, place + 4, "end"))
    parts.append(_text(x.label, (x.start + x.end) / 2, y.start + 34, "middle"))
    middle = (y.start + y.end) / 2
    turned = f"<g transform='rotate(-90 12 {middle:.1f})'>"
    return "".join(parts) + turned + _text(y.label, 12, middle + 2, "middle") + "</g>"


def _curve(number: int, look: str, x: Side, y: Side, points: tuple[Array, Array]) -> str:
    """Return a curve, cut off at the ends of y and x."""
    places = np.stack([x.at(points[0]), y.at(points[1])], axis=1)
    if look == "points":
        dots = (
            f"<circle class='p{number % 7}' cx='{a:.1f}' cy='{b:.1f}' r='2.2'/>" for a, b in places
        )
        return "".join(dots)
    text = " ".join(f"{a:.1f},{b:.1f}" for a, b in places)
    return f"<polyline class='c{number % 7} {look}' points='{text}'/>"


def _text(words: str, x: float, y: float, side: str = "start") -> str:
    return f"<text class='{side}' x='{x:.1f}' y='{y:.1f}'>{html.escape(words)}</text>"


def _picture(parts: Sequence[str], size: tuple[float, float]) -> str:
    return f"<svg viewBox='0 0 {size[0]:.0f} {size[1]:.0f}'>{''.join(parts)}</svg>"
