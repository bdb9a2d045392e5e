"""Measured surfaces from files, and from SurfaceTopography."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

import numpy as np
import numpy.typing as npt

from nacre import _core as core
from nacre._tools.arguments import name_or_number
from nacre._tools.notices import warn
from nacre._tools.progress import lasting
from nacre._tools.typing import AnyPath, Pair, Topography
from nacre.surfaces import heights as _heights
from nacre.surfaces.heights import LEAST_MEASURED, METRES, NO_MAP, Heights, without_sentinels
from nacre.surfaces.missing import harmonic
from nacre.surfaces.scans import scan

Array = npt.NDArray[np.float64]

TRENDS = ("none", "mean", "plane", "quadratic")
TALLEST = 10.0
"""Largest ratio of height to side of a map; surfaces have less than 1, and a wrong unit 1e3."""
STEEPEST = 50.0
"""Largest median slope between neighbours along x and y; surfaces have less than 5."""
SAMPLED_LINES = 256
"""Lines along each axis whose slopes are looked at, at least; all of smaller maps."""
FLATTEST, WIDEST = 1e-6, 0.5
"""Least ratio of height to side of a map that is wider than this [m]."""


def read_map(
    path: AnyPath | Topography,
    *,
    spacing: float | Pair | None = None,
    unit: str | None = None,
    detrend: Literal["none", "mean", "plane", "quadratic"] = "plane",
    channel: str | int | None = None,
    transpose: bool = False,
    periodic: tuple[bool, bool] = (False, False),
) -> core.HeightMap:
    """Read a measured surface from a file, or take one from SurfaceTopography.

    Files of instruments are read by SurfaceTopography, with ``nacre-contact[surfaces]``. Missing
    points are filled smoothly from their surroundings; a `nacre.NacreWarning` tells how many there
    were.

    Parameters
    ----------
    path : str, os.PathLike or topography
        A file ``.npy`` holds a matrix of heights ``(nx, ny)``. A table in text, whatever its
        ending, holds points of a grid, with columns x, y and z in any order, or a matrix of
        heights, with one line for each x in a ``.csv`` and one for each y in any other and below
        the head of an instrument. Heads, headings, units such as ``# unit: um`` and
        ``# spacing: 0.5 0.5``, decimal commas, and numbers that stand for missing points are
        recognised; a profile is refused. Xarray reads its own NetCDF files, whose coordinates need
        units, and SurfaceTopography any other file. A topography is an object of that library.
    spacing : float or tuple of float, optional
        Distances between samples ``(dx, dy)`` [m]; needed where the file does not give them.
    unit : str, optional
        Unit of the numbers in the file ("nm", "um", "mm", ...). By default the unit that the file
        names. Where it names none, numbers in ``.npy`` and ``.csv`` are metres, unless the heights
        would span more than ten times the map; anything else needs a unit.
    detrend : {"plane", "none", "mean", "quadratic"}, optional
        Surface that is subtracted: the plane, the mean or the paraboloid that fits best.
    channel : str or int, optional
        Channel of the instrument, or table of the text, that is read: its name or its number;
        needed where a file has several with heights.
    transpose : bool, optional
        Whether to swap x and y of the file. Instruments export a ``.csv`` as an image, with one
        line for each y: that needs ``transpose=True``. The first line then has the smallest y. A
        `spacing` that is given is not swapped.
    periodic : tuple of bool, optional
        Whether the surface repeats along x and along y.

    Returns
    -------
    HeightMap
        The surface.

    Raises
    ------
    ValueError
        If the file cannot be understood, its unit or spacing is not known, or less than half of it
        was measured.
    TypeError
        If an argument is of the wrong kind.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     np.save(f"{folder}/flat.npy", np.zeros((4, 3)))
    ...     nacre.HeightMap.read(f"{folder}/flat.npy", spacing=1e-6, unit="nm").heights.shape
    (4, 3)
    """
    if detrend not in TRENDS:
        raise ValueError(f"detrend must be one of {', '.join(TRENDS)}, got {detrend!r}")
    if unit is not None and unit not in METRES:
        raise ValueError(f"unit must be one of {', '.join(METRES)}, got {unit!r}")
    if channel is not None:
        channel = name_or_number("channel", channel)
    name, surface = _read_heights(path, channel)
    heights, sides = surface.heights, surface.spacing
    if transpose:
        heights, sides = heights.T, None if sides is None else (sides[1], sides[0])
    factor = _metres(name, surface, unit)
    is_known = unit is not None or surface.unit is not None
    note, scale = surface.note, 1.0 if surface.has_metres else factor
    del surface  # the map in the file's unit
    heights = heights * factor
    is_spacing_given = spacing is not None
    if spacing is None:
        if sides is None:
            raise ValueError(f"spacing must be given: {name}{note} does not have it")
        spacing = sides[0] * scale, sides[1] * scale
    _check_size(name, heights, spacing, is_known, is_spacing_given)
    wraps = core.HeightMap(np.zeros((2, 2)), 1.0, periodic=periodic).periodic
    heights = _filled_heights(name, heights, detrend, wraps)
    try:
        heights -= _trend(heights, detrend)
        return core.HeightMap(heights, spacing, periodic=periodic)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from error


def _read_heights(path: AnyPath | Topography, channel: str | int | None) -> tuple[str, Heights]:
    """Return a name for messages, and the heights."""
    if not isinstance(path, str | os.PathLike):
        if not hasattr(path, "heights"):
            raise TypeError(f"path must be a path or a topography, got {path!r}")
        if channel is not None:
            raise ValueError(f"channel must be left out: a topography has none, got {channel!r}")
        from nacre.surfaces.instruments import of_topography

        return "the topography", of_topography(path)
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{str(path)!r} is not a file")
    ending = path.suffix.lower()
    if ending == ".npy":
        if channel is not None:
            raise ValueError(f"channel must be left out: .npy has none, got {channel!r}")
        surface = _heights.npy(path)
    elif scan(path) is not None:
        raise ValueError(f"{str(path)!r} {NO_MAP.format('')}")
    elif channel is None and (points := _heights.zygo(path)) is not None:
        surface = points
    elif ending in (".csv", ".xyz"):
        surface = _heights.text(path, channel)
    elif ending == ".nc":
        from nacre.surfaces.instruments import netcdf

        surface = netcdf(path, channel)
    else:
        from nacre.surfaces.instruments import instrument

        surface = instrument(path, channel)
    return repr(str(path)), surface._replace(heights=without_sentinels(surface.heights))


def _metres(name: str, surface: Heights, unit: str | None) -> float:
    """Return the length of the unit [m]."""
    is_named = unit is not None and METRES[unit] in map(_heights.metres, surface.axis_units)
    unit_name = surface.unit if unit is None or is_named else unit
    if unit_name is None and not surface.is_metric:
        sizes = f"its heights span {_span(surface.heights):.4g}"
        if surface.spacing is not None:
            nx, ny = surface.heights.shape
            dx, dy = surface.spacing
            sizes += f" and its sides {(nx - 1) * dx:.4g} x {(ny - 1) * dy:.4g}"
        raise ValueError(f"unit must be given: {name} names none; {sizes}")
    length = _heights.metres(unit_name or "m")
    if length is None:
        raise ValueError(
            f"unit must be given: {name} has {unit_name!r}, which is none of {', '.join(METRES)}"
        )
    return length


def _check_size(
    name: str, heights: Array, spacing: float | tuple[float, float], is_known: bool, is_given: bool
) -> None:
    """Refuse heights that do not go with the sides of the map, as where a unit is wrong."""
    try:
        dx, dy = (float(d) for d in np.broadcast_to(np.asarray(spacing, dtype=np.float64), 2))
    except (TypeError, ValueError):
        return  # HeightMap refuses it
    lx, ly, span = heights.shape[0] * dx, heights.shape[1] * dy, _span(heights)
    side = max(lx, ly)
    if not (side > 0 and span > 0):
        return
    sizes = f"heights would span {span:.4g} m on a map of {lx:.4g} m x {ly:.4g} m"
    if not is_known and span > TALLEST * side:
        raise ValueError(f"unit must be given: {name} names none, and in metres its {sizes}")
    every = [cells // SAMPLED_LINES or 1 for cells in heights.shape]
    steps = [
        np.diff(heights[:, :: every[1]], axis=0) / dx,
        np.diff(heights[:: every[0]], axis=1) / dy,
    ]
    slopes = [np.abs(step[np.isfinite(step)]) for step in steps]
    slope = min(float(np.median(steps)) if steps.size else 0.0 for steps in slopes)
    is_flat = side > WIDEST and span < FLATTEST * side
    if span > TALLEST * side or slope > STEEPEST or is_flat:
        remedy = (
            "check spacing=, in metres, and unit="
            if is_given
            else "x, y and z seem to have different units: give spacing=, in metres, and unit= of "
            "the heights"
        )
        raise ValueError(f"spacing must go with the heights: in {name} {sizes}; {remedy}")


def _span(heights: Array) -> float:
    lowest, highest = _heights.extremes(heights)
    return max(highest - lowest, 0.0)


def _filled_heights(name: str, heights: Array, detrend: str, wraps: tuple[bool, bool]) -> Array:
    """Return heights whose missing points are filled harmonically, without new peaks or pits.

    Where the surface repeats, its ends are neighbours once it has no trend.
    """
    missing = ~np.isfinite(heights)
    count = int(missing.sum())
    if count == 0:
        return heights
    measured = heights.size - count
    if measured < LEAST_MEASURED * heights.size:
        raise ValueError(
            f"{name} must have at least half its points measured, got {measured} of {heights.size}"
        )
    warn(f"{count} of {heights.size} heights are missing and were filled smoothly from around them")
    trend = _trend(heights, detrend if any(wraps) else "none")
    with lasting(f"filling {count} heights") as tell:
        return harmonic(heights - trend, wraps, tell or (lambda share: None)) + trend


def _trend(heights: Array, detrend: str) -> Array:
    """Return the mean, the plane or the paraboloid that fits measured heights best, or zeros."""
    if detrend == "none":
        return np.zeros_like(heights)
    degree = {"mean": 0, "plane": 1, "quadratic": 2}[detrend]
    powers = [(k, n - k) for n in range(degree + 1) for k in range(n + 1)]
    # The normal equations, whose sums over the map are products with powers of x and of y.
    x, y = (np.vander(np.linspace(-1, 1, cells), 5, increasing=True) for cells in heights.shape)
    moments, sums = np.outer(x.sum(axis=0), y.sum(axis=0)), x.T @ heights @ y
    if not np.isfinite(sums).all():
        measured = np.isfinite(heights)
        moments, sums = x.T @ measured @ y, x.T @ np.where(measured, heights, 0.0) @ y
    gram = [[moments[i + k, j + n] for k, n in powers] for i, j in powers]
    # Terms that are equal on few lines share a coefficient.
    best, *_ = np.linalg.lstsq(gram, [sums[power] for power in powers], rcond=1e-12)
    coefficients = np.zeros((3, 3))
    for power, value in zip(powers, best, strict=True):
        coefficients[power] = value
    trend: Array = x[:, :3] @ coefficients @ y[:, :3].T
    return trend
