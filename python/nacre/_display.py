"""What a solution prints: a short table; in a notebook with a small map of the pressure."""

from __future__ import annotations

import base64
import html
import struct
import zlib

import numpy as np
import numpy.typing as npt

from nacre._core import RIGID, Elastic, HalfSpace, Rigid, Solution
from nacre.units import written

WIDEST = 240
"""Pixels along the longer side of the small map."""

# Matplotlib's viridis at nine places.
VIRIDIS = (
    (68, 1, 84),
    (71, 44, 122),
    (59, 81, 139),
    (44, 113, 142),
    (33, 144, 141),
    (39, 173, 129),
    (92, 200, 99),
    (170, 220, 50),
    (253, 231, 37),
)


def figures(solution: Solution) -> list[tuple[str, str]]:
    """Return names and values of the key figures, with units."""
    line = solution.report.grid.is_line
    force, moment = ("N/m", "N") if line else ("N", "N m")
    extent, report = solution.contact_extent, solution.report
    sides = [written(high - low, "m") for low, high in extent]
    touching = solution.contact_area > 0
    nx, ny = report.grid.shape
    rows = [
        ("load", written(solution.load, force)),
        ("acts at", _pair(solution.eccentricity, "m") if touching else "nothing touches"),
        ("moment", _pair(solution.moment, moment)),
        ("approach", written(solution.approach, "m")),
        ("tilt", f"({solution.tilt[0]:.4g}, {solution.tilt[1]:.4g})"),
        ("peak pressure", written(solution.peak_pressure, "Pa")),
        ("at", _pair(solution.peak_position, "m")),
        ("contact", sides[1] if line else f"{sides[0]} × {sides[1]}"),
        ("area", written(solution.contact_area, "m" if line else "m²")),
        ("counterbody", _body(report.counterbody)),
        ("E*", written(_modulus(solution), "Pa")),
        ("grid", f"{nx} × {ny} cells"),
        ("ended", f"{report.termination}, residual {report.residual:.0e}"),
    ]
    return rows if touching else [row for row in rows if row[0] not in ("at", "contact", "area")]


def text(solution: Solution) -> str:
    """Return the table that ``print(solution)`` shows."""
    rows = figures(solution)
    width = max(len(name) for name, _ in rows)
    lines = [f"{name:{width}}  {value}" for name, value in rows]
    lines += [f"warning: {warning}" for warning in solution.report.warnings]
    return "\n".join(lines)


def markup(solution: Solution) -> str:
    """Return the table and the small map, for a notebook."""
    cell = "style='text-align:left; padding:1px 12px 1px 0'"
    rows = "".join(
        f"<tr><td {cell}>{html.escape(name)}</td><td {cell}>{html.escape(value)}</td></tr>"
        for name, value in figures(solution)
    )
    notes = "".join(f"<p>warning: {html.escape(text)}</p>" for text in solution.report.warnings)
    picture = base64.b64encode(thumbnail(solution.pressure)).decode()
    image = (
        f"<img alt='pressure, x to the right' style='border:1px solid #bbb; max-width:{WIDEST}px' "
        f"src='data:image/png;base64,{picture}'>"
    )
    return (
        f"<div style='display:flex; gap:16px; align-items:flex-start'><table>{rows}</table>"
        f"{image}</div>{notes}"
    )


def thumbnail(pressure: npt.NDArray[np.float64]) -> bytes:
    """Return a small PNG of the contact: x to the right, y upwards, white where nothing touches."""
    parts = []
    for axis, cells in enumerate(pressure.shape):
        loaded = np.flatnonzero(pressure.any(axis=1 - axis))
        low, high = (loaded[0], loaded[-1]) if loaded.size else (0, cells - 1)
        margin = 1 + (high - low) // 10
        parts.append((max(low - margin, 0), min(high + margin, cells - 1)))
    spans = [high - low + 1 for low, high in parts]
    # Whatever its shape, it stays legible: at least a quarter as high as wide.
    size = [max(WIDEST // 4, WIDEST * span // max(spans)) for span in spans]
    rows, columns = (
        np.linspace(low, high, count).round().astype(int)
        for (low, high), count in zip(parts[::-1], size[::-1], strict=True)
    )
    field = pressure[np.ix_(columns, rows[::-1])].T
    level = field / (pressure.max() or 1.0) * (len(VIRIDIS) - 1)
    channels = [np.interp(level, range(len(VIRIDIS)), anchor) for anchor in zip(*VIRIDIS)]  # noqa: B905
    pixels = np.where(field[..., np.newaxis] > 0, np.stack(channels, axis=-1), 255)
    return _png(pixels.round().astype(np.uint8))


def _png(pixels: npt.NDArray[np.uint8]) -> bytes:
    """Return (height, width, 3) pixels as a PNG file."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        check = zlib.crc32(kind + data)
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", check)

    height, width, _ = pixels.shape
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    lines = b"".join(b"\0" + line.tobytes() for line in pixels)
    parts = chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(lines, 9)), chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


def _pair(values: tuple[float, float], unit: str) -> str:
    return f"({written(values[0], unit)}, {written(values[1], unit)})"


def _body(body: HalfSpace | None) -> str:
    """Describe a body in a few words."""
    if body is None:
        return "rigid"
    layers = "".join(f"{written(layer.thickness, 'm', 3)} of {_material(layer.material)} on " for layer in body.layers)
    return layers + _material(body.substrate)


def _material(material: Elastic | Rigid) -> str:
    if isinstance(material, Rigid):
        return "a rigid base"
    return f"E {written(material.young, 'Pa', 3)}, ν {material.poisson:g}"
