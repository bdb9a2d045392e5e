"""Heights in files of instruments, and in objects of SurfaceTopography, which reads those files."""

from __future__ import annotations

import contextlib
import io
import re
import warnings
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from nacre._tools.extras import extra
from nacre.surfaces.heights import Heights, Text

TABLES = ("asc", "xyz")
"""Formats of SurfaceTopography for tables in text, which take any numbers for heights."""
ENDINGS = ("txt", "asc", "dat")
"""Endings of tables in text, some of which other formats have, too."""
HEADED = ("di", "ezd", "nmm", "mnt")
"""Formats without a mark at the beginning, which may begin with text."""
REVISION = re.compile(rb"(<(?:\w+:)?Revision>)[^<]*5436[^<]*(</)")
"""Name of the standard in an X3P."""


def instrument(path: Path, channel: str | int | None) -> Heights:
    """Return the heights in an instrument's file, in the unit of the file.

    Readers of the file's ending are asked first, then those of its first bytes. Text that none of
    them knows is a table. Readers of formats without a mark are asked where no reader has the
    ending. Readers without heights are passed over.
    """
    with extra("surfaces"), warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)  # a warning that MPI is missing
        from SurfaceTopography.IO import MagicMatch, readers

    content, ending = path.read_bytes(), path.suffix.lower().lstrip(".")
    others = [reader for reader in readers if reader.format() not in TABLES]
    match = {reader: reader.can_read(content[:512]) for reader in others}
    likely = [reader for reader in others if ending in (reader.file_extensions() or ())]
    likely += [one for one in others if match[one] == MagicMatch.YES and one not in likely]
    reasons: dict[str, str] = {}

    def found(asked: Sequence[Any]) -> Heights | None:
        for reader in asked:
            try:
                with reader(_mended(path) if reader.format() == "x3p" else str(path)) as opened:
                    return _heights(opened, channel)
            except Unfound as error:
                raise ValueError(f"{error}, got {channel!r}") from None
            except Exception as error:  # readers raise anything for a damaged or another file
                said = f"no {error}" if isinstance(error, KeyError) else str(error)
                reasons[reader.name()] = said or type(error).__name__
        return None

    if (heights := found(likely)) is not None:
        return heights
    told = "; ".join(f"{name}: {' '.join(text.split())[:200]}" for name, text in reasons.items())
    is_text = 0 not in content or 0 not in content[:1000:2] or 0 not in content[1:1000:2]
    if is_text:
        try:
            text = Text.of(path)
        except ValueError as error:
            is_table = not re.search("must be text|got none$", str(error))
            if is_table and (not likely or ending in ENDINGS):
                raise
        else:
            return _table(text, channel)
    if any(ending in (reader.file_extensions() or ()) for reader in likely):
        raise ValueError(f"{str(path)!r} cannot be read: {told}")
    maybe = [one for one in others if match[one] == MagicMatch.MAYBE and one not in likely]
    if (heights := found([one for one in maybe if not is_text or one.format() in HEADED])) is None:
        if likely:
            raise ValueError(f"{str(path)!r} has no format that SurfaceTopography reads; {told}")
        raise ValueError(
            f"{str(path)!r} has no format that SurfaceTopography reads; nacre itself reads .npy, "
            ".csv and .xyz"
        )
    return heights


class Unfound(ValueError):
    """A channel that a file does not have."""


def _table(text: Text, channel: str | int | None) -> Heights:
    """Return the heights of a table; SurfaceTopography knows the heads of a matrix."""
    from SurfaceTopography.IO import AscReader

    has_channels = all(found.title.startswith("#") for found in text.tables[1:])
    if len(text.tables) > 1 and not has_channels:
        text.tables = [text.chosen(channel)]
        channel = None
    first = text.tables[0]
    points = text.points(first)
    if points is not None:
        return points
    own = text.matrix(first)
    if not text.above and channel is None:
        return own._replace(is_metric=False)
    # Without what was left out.
    lines = [row[-own.heights.shape[0] :] for row in first.rows[-own.heights.shape[1] :]]
    first.lines, first.rows = first.lines[-len(lines) :], lines
    try:
        with AscReader(io.StringIO(text.plain())) as reader:
            found = _heights(reader, channel)
    except Unfound as error:
        raise ValueError(f"{error}, got {channel!r}") from None
    except Exception:
        return own._replace(is_metric=False)
    if found.unit is None and found.spacing is None:
        return own._replace(heights=found.heights, is_metric=False)
    return found._replace(is_metric=False)


def _mended(path: Path) -> str | io.BytesIO:
    """Return an X3P whose name of the standard has a hyphen, and that has no folder.

    Other programs write a dash there, and put all files in a folder.
    """
    with contextlib.suppress(Exception), zipfile.ZipFile(path) as archive:
        names = archive.namelist()
        main = next(name for name in names if name.rpartition("/")[2] == "main.xml")
        folder = main.removesuffix("main.xml")
        made = io.BytesIO()
        with zipfile.ZipFile(made, "w") as copy:
            for name in names:
                content = archive.read(name)
                if name == main:
                    content = REVISION.sub(rb"\1ISO5436 - 2000\2", content)
                copy.writestr(name.removeprefix(folder), content)
        made.seek(0)
        return made
    return str(path)


def _heights(reader: Any, channel: str | int | None) -> Heights:
    """Return the heights of a channel, which must be a map."""
    maps = [one for one in reader.channels if one.dim == 2]
    if not maps:
        names = ", ".join(repr(one.name) for one in reader.channels) or _others(reader) or "none"
        raise ValueError(f"the file holds no channel with heights; its channels are {names}")
    found = _channel(reader, channel)
    # A file without sizes needs some, which are not used.
    lacking = found.physical_sizes is None and found.nb_grid_pts is not None
    sizes = {"physical_sizes": tuple(map(float, found.nb_grid_pts))} if lacking else {}
    heights = of_topography(found.topography(**sizes))
    return heights._replace(spacing=None) if lacking else heights


def _others(reader: Any) -> str:
    """Return the titles of channels of Gwyddion that hold no heights, with their units."""
    said = getattr(reader, "_metadata", {})
    fields = [name for name in said if re.fullmatch(r"/\d+/data", str(name))]
    return ", ".join(repr(said.get(f"{name}/title") or name) for name in fields)


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
    unit = unit.replace("μ", "µ") if isinstance(unit, str) else None
    return Heights(heights, spacing, unit, False)


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
    raise Unfound(f"channel must be one of {known}")
