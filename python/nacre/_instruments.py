"""Heights in files of instruments, and in objects of SurfaceTopography, which reads those files."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from nacre._extras import extra
from nacre._heights import Heights


def instrument(path: Path, channel: str | int | None) -> Heights:
    """Return the heights in an instrument's file, in the unit of the file."""
    with extra("surfaces"), warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)  # a warning that MPI is missing
        import SurfaceTopography
        from SurfaceTopography.Exceptions import CannotDetectFileFormat

    try:
        with SurfaceTopography.open_topography(str(path)) as reader:
            found = _channel(reader, channel)
            # A file without sizes needs some, which are not used.
            lacking = found.physical_sizes is None and found.nb_grid_pts is not None
            sizes = {"physical_sizes": tuple(map(float, found.nb_grid_pts))} if lacking else {}
            heights = of_topography(found.topography(**sizes))
    except CannotDetectFileFormat as error:
        raise ValueError(
            f"{str(path)!r} has no format that SurfaceTopography reads; nacre itself reads .npy, "
            ".csv and .xyz"
        ) from error
    except OSError:
        raise
    except Exception as error:  # readers raise anything for a damaged file
        raise ValueError(f"{str(path)!r} cannot be read: {error}") from error
    return heights._replace(spacing=None) if lacking else heights


def of_topography(surface: Any) -> Heights:
    """Return the heights of a topography of SurfaceTopography, in its unit.

    Anything with ``dim``, ``heights()``, ``physical_sizes`` and ``unit`` will do.
    """
    if surface.dim != 2:
        raise ValueError("a surface must have two dimensions, got a line")
    heights = np.ma.filled(np.ma.masked_invalid(surface.heights()).astype(np.float64), np.nan)
    if heights.ndim != 2:
        raise ValueError(f"heights must have two dimensions, got shape {heights.shape}")
    sizes = surface.physical_sizes
    spacing = None
    if sizes is not None:
        spacing = float(sizes[0]) / heights.shape[0], float(sizes[1]) / heights.shape[1]
    unit = surface.unit
    return Heights(heights, spacing, unit.replace("μ", "µ") if isinstance(unit, str) else None)


def _channel(reader: Any, asked: str | int | None) -> Any:
    channels = list(reader.channels)
    names = [channel.name for channel in channels]
    if asked is None:
        return reader.default_channel
    if isinstance(asked, str):
        if asked in names:
            return channels[names.index(asked)]
    elif 0 <= asked < len(channels):
        return channels[asked]
    known = ", ".join(f"{number} ({name})" for number, name in enumerate(names))
    raise ValueError(f"channel must be one of {known}, got {asked!r}")
