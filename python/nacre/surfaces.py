"""Measured surfaces from files."""

from __future__ import annotations

import os
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from nacre import _core as core
from nacre._extras import extra

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
TRENDS = ("none", "mean", "plane", "quadratic")
LEAST_MEASURED = 0.5
"""Least share of points that must be measured; below it most of the surface would be a guess."""


def read(
    path: str | os.PathLike[str],
    *,
    spacing: float | tuple[float, float] | None = None,
    unit: str | None = None,
    detrend: str = "plane",
    channel: str | int | None = None,
) -> core.HeightMap:
    """Read a measured surface; see `HeightMap.read`."""
    path = Path(path)
    if detrend not in TRENDS:
        raise ValueError(f"detrend must be one of {', '.join(TRENDS)}, got {detrend!r}")
    if unit is not None and unit not in METRES:
        raise ValueError(f"unit must be one of {', '.join(METRES)}, got {unit!r}")
    if not path.is_file():
        raise FileNotFoundError(f"{str(path)!r} is not a file")
    plain = {".npy": _npy, ".csv": _csv, ".xyz": _xyz}
    if path.suffix.lower() in plain:
        if channel is not None:
            raise ValueError(f"channel must be left out: {path.suffix} has none, got {channel!r}")
        heights, found, unit_found = plain[path.suffix.lower()](path)
        metres = METRES[unit or unit_found or "m"]
        heights = heights * metres
        sides = None if found is None else (found[0] * metres, found[1] * metres)
    else:
        heights, sides = _measured(path, unit, channel)
    if spacing is None:
        spacing = sides
    if spacing is None:
        raise ValueError(f"spacing must be given: {str(path)!r} does not have it")
    heights = _filled(path, heights)
    return core.HeightMap(_without_trend(heights, detrend), spacing)


def _npy(path: Path) -> tuple[Array, None, None]:
    return _matrix(path, np.load(path, allow_pickle=False)), None, None


def _csv(path: Path) -> tuple[Array, tuple[float, float] | None, str | None]:
    """Return heights, one line for each x; ``# unit: um`` and ``# spacing: dx dy`` may precede."""
    said = _said(path)
    heights = _matrix(path, _table(path))
    spacing = None
    if "spacing" in said:
        numbers = [float(number) for number in said["spacing"].replace(",", " ").split()]
        spacing = (numbers[0], numbers[-1])
    return heights, spacing, _unit(path, said)


def _xyz(path: Path) -> tuple[Array, tuple[float, float], str | None]:
    """Return heights and spacing of points x, y, z on a grid, in any order; some may be missing."""
    points = _table(path)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"{str(path)!r} must have three columns x, y, z, got shape {points.shape}")
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
        if np.abs(place - place.round()).max() > 0.05:
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
    return heights, (steps[0], steps[1]), _unit(path, _said(path))


def _measured(
    path: Path, unit: str | None, channel: str | int | None
) -> tuple[Array, tuple[float, float]]:
    """Return heights and spacing of an instrument's file, in metres, by SurfaceTopography."""
    with extra("surfaces"), warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)  # a warning that MPI is missing
        import SurfaceTopography

    try:
        with SurfaceTopography.open_topography(str(path)) as reader:
            index = None
            if isinstance(channel, str):
                names = [c.name for c in reader.channels]
                if channel not in names:
                    raise ValueError(f"channel must be one of {', '.join(names)}, got {channel!r}")
                index = names.index(channel)
            elif channel is not None:
                index = int(channel)
            surface = reader.topography(channel_index=index)
    except (OSError, ValueError):
        raise
    except Exception as error:  # readers raise anything for a damaged file
        raise ValueError(f"{str(path)!r} cannot be read: {error}") from error
    found = unit or surface.unit
    if found not in METRES:
        raise ValueError(f"unit must be given: {str(path)!r} has {surface.unit!r}")
    if surface.dim != 2:
        raise ValueError(f"{str(path)!r} must hold a surface, got a line")
    heights = np.ma.filled(np.ma.masked_invalid(surface.heights()).astype(np.float64), np.nan)
    sides = [
        size / cells for size, cells in zip(surface.physical_sizes, heights.shape, strict=True)
    ]
    metres = METRES[found]
    return heights * metres, (sides[0] * metres, sides[1] * metres)


def _said(path: Path) -> dict[str, str]:
    """Return names and values of the comment lines ``# name: value``."""
    said: dict[str, str] = {}
    with path.open(encoding="utf-8", errors="replace") as file:
        for line in file:
            if not line.startswith("#"):
                break
            name, colon, value = line[1:].partition(":")
            if colon:
                said[name.strip().lower()] = value.strip()
    return said


def _unit(path: Path, said: dict[str, str]) -> str | None:
    unit = said.get("unit", "").replace("μ", "µ") or None
    if unit is not None and unit not in METRES:
        raise ValueError(
            f"{str(path)!r} must have one of the units {', '.join(METRES)}, got {unit!r}"
        )
    return unit


def _table(path: Path) -> Array:
    """Return the numbers of a text file; empty fields and words are missing points."""
    rows: list[list[float]] = []
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            text = line.strip()
            if not text or text.startswith("#"):
                continue
            comma = next((mark for mark in (",", ";", "\t") if mark in text), None)
            fields = [f.strip() for f in text.split(comma)] if comma else re.split(r"\s+", text)
            rows.append([_number(field) for field in fields])
            if len(rows[-1]) != len(rows[0]):
                message = f"{len(rows[0])} numbers in each line, line {number} has {len(rows[-1])}"
                raise ValueError(f"{str(path)!r} must have {message}")
    if not rows:
        raise ValueError(f"{str(path)!r} must hold numbers, got none")
    return np.array(rows)


def _number(field: str) -> float:
    try:
        return float(field)
    except ValueError:
        return float("nan")


def _matrix(path: Path, heights: npt.NDArray[Any]) -> Array:
    if heights.ndim != 2 or heights.dtype.kind not in "biuf":
        raise ValueError(
            f"{str(path)!r} must hold a real matrix of heights, got {heights.dtype} of shape "
            f"{heights.shape}"
        )
    return heights.astype(np.float64)


def _filled(path: Path, heights: Array) -> Array:
    """Return heights whose missing points are filled harmonically, without new peaks or pits."""
    missing = ~np.isfinite(heights)
    count = int(missing.sum())
    if count == 0:
        return heights
    measured = heights.size - count
    if measured < LEAST_MEASURED * heights.size:
        raise ValueError(
            f"{str(path)!r} must have at least half its points measured, got {measured} of "
            f"{heights.size}"
        )
    warnings.warn(
        f"{count} of {heights.size} heights are missing and were filled smoothly from around them",
        core.NacreWarning,
        stacklevel=4,
    )
    return _harmonic(heights, missing)


def _harmonic(heights: Array, missing: npt.NDArray[np.bool_]) -> Array:
    """Solve the discrete Laplace equation over the missing points, by conjugate gradients."""
    scale = float(np.ptp(heights[~missing])) or 1.0
    base = float(heights[~missing].mean())
    known = np.where(missing, 0.0, (heights - base) / scale)

    def neighbours(field: Array) -> Array:
        total = np.zeros_like(field)
        total[1:] += field[:-1]
        total[:-1] += field[1:]
        total[:, 1:] += field[:, :-1]
        total[:, :-1] += field[:, 1:]
        return total

    degree = neighbours(np.ones_like(known))

    def apply(field: Array) -> Array:
        return np.where(missing, degree * field - neighbours(field), 0.0)

    filled = np.zeros_like(known)
    residual = np.where(missing, neighbours(known), 0.0)
    direction, size = residual.copy(), float((residual**2).sum())
    first = size
    for _ in range(10 * int(missing.sum())):
        if size <= 1e-24 * first:
            break
        image = apply(direction)
        step = size / float((direction * image).sum())
        filled += step * direction
        residual -= step * image
        before, size = size, float((residual**2).sum())
        direction = residual + size / before * direction
    return np.where(missing, base + scale * filled, heights)


def _without_trend(heights: Array, detrend: str) -> Array:
    """Subtract the mean, the plane or the paraboloid that fits best."""
    if detrend == "none":
        return heights
    x, y = (np.linspace(-1, 1, cells) for cells in heights.shape)
    x, y = np.broadcast_arrays(x[:, np.newaxis], y)
    terms = [np.ones_like(x)]
    if detrend in ("plane", "quadratic"):
        terms += [x, y]
    if detrend == "quadratic":
        terms += [x**2, x * y, y**2]
    basis = np.stack([term.ravel() for term in terms], axis=1)
    best, *_ = np.linalg.lstsq(basis, heights.ravel())
    return heights - (basis @ best).reshape(heights.shape)
