"""Heights in files of instruments, and in objects of SurfaceTopography, which reads those files."""

from __future__ import annotations

import io
import math
import re
import struct
import warnings
import zipfile
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre._tools.text import is_text, listed
from nacre._tools.typing import Topography
from nacre.surfaces.heights import NO_MAP, OFF, Heights, Text, metres

Array = npt.NDArray[np.float64]
Content = TypeVar("Content")

TABLES = ("asc", "xyz")
"""Formats of SurfaceTopography for tables in text, which take any numbers for heights."""
ENDINGS = ("txt", "asc", "dat")
"""Endings of tables in text, some of which other formats have, too."""
HEADED = ("di", "ezd", "nmm", "mnt")
"""Formats without a mark at the beginning, which may begin with text."""
NANOSCOPE = re.compile(rb"[\\?]\*File list")
"""First line of a NanoScope image, whose ending is a number."""
RATIO, LEAST_UNPACKED = 100, 1 << 24
"""Most bytes that a part of an X3P may unpack to: over those of the file, or these. Heights of 8
bytes a point shrink to a half or a tenth."""
UNPROPORTIONAL = "must hold nothing out of proportion: {} would unpack to {} bytes"
COMPRESSED = 15
"""Kind of a compressed element in a file of MATLAB's."""
REVISION = re.compile(rb"(<(?:\w+:)?Revision>)[^<]*5436[^<]*(</)")
"""Name of the standard in an X3P."""


def instrument(path: Path, channel: str | int | None) -> Heights:
    """Return the heights in an instrument's file, in the unit of the file.

    Readers of the file's ending are asked first, then those of its first bytes. Text that none of
    them knows is a table. Readers of formats without a mark are asked where no reader has the
    ending. Readers without heights are passed over.
    """

    def table(likely: bool) -> Heights | None:
        try:
            text = Text.of(path)
        except ValueError as error:
            has_numbers = not re.search("must be text|got none$", str(error))
            if has_numbers and (not likely or path.suffix.lower().lstrip(".") in ENDINGS):
                raise
            return None
        return _table(text, channel)

    return _first_content(
        path, channel, lambda reader: _heights(reader, channel, _largest_part(path)), table
    )


def netcdf(path: Path, channel: str | int | None) -> Heights:
    """Return the heights in a file of NetCDF, by xarray where SurfaceTopography does not know it.

    The coordinates x and y have units, or the spacing is not known.
    """
    with suppress(ValueError, ModuleNotFoundError):
        if (known := instrument(path, channel)).spacing is not None:
            return known
    with extra("files"):
        import xarray
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of HDF5 without dimensions
            file = xarray.open_dataset(path, decode_times=False, create_default_indexes=False)
        with file:
            arrays = [a for a in file.data_vars.values() if a.ndim == 2 and a.dtype.kind in "biuf"]
            if not arrays:
                raise Unfound("the file must hold heights, an array of two dimensions, got none")
            if all(1 in a.shape for a in arrays):
                raise Unfound("the file " + NO_MAP.format(f" in {str(arrays[0].name)!r}"))
            channels = [
                SimpleNamespace(
                    name=a.name,
                    dim=2,
                    nb_grid_pts=a.shape,
                    unit=a.attrs.get("units", a.attrs.get("unit")),
                )
                for a in arrays
            ]
            chosen = _channel(SimpleNamespace(channels=channels), channel, 2)
            array = next(a for a in arrays if a.name == chosen.name)
            if array.nbytes > _largest_part(path):
                raise Unfound("the file " + UNPROPORTIONAL.format(repr(array.name), array.nbytes))
            heights = array.values.astype(np.float64)
            steps = [_step(file[name]) if name in file else None for name in map(str, array.dims)]
    except Unfound as error:
        raise ValueError(f"{error}; the file is {str(path)!r}") from None
    except Exception as error:  # xarray raises anything for a damaged file
        raise ValueError(
            f"{str(path)!r} cannot be read: {' '.join(str(error).split())[:200]}"
        ) from error
    ascending = tuple(slice(None, None, -1 if step and step < 0 else 1) for step in steps)
    heights, (dx, dy) = heights[ascending], (abs(step) if step else None for step in steps)
    if [str(name).lower() for name in array.dims] == ["y", "x"]:
        heights, dx, dy = heights.T, dy, dx
    return Heights(
        heights,
        (dx, dy) if dx and dy else None,
        chosen.unit if isinstance(chosen.unit, str) else None,
        False,
        note=", whose coordinates have no unit of length,",
        has_metres=True,
    )


def _step(coordinate: Any) -> float | None:
    """Return the distance between the places of a map [m], or None where they are no lengths."""
    size = metres(str(coordinate.attrs.get("units", "")))
    if size is None or coordinate.ndim != 1 or coordinate.size < 2:
        return None
    places = coordinate.values.astype(np.float64)
    step = float(places[-1] - places[0]) / (places.size - 1)
    even = places[0] + step * np.arange(places.size)
    if step == 0 or not (np.abs(places - even) <= OFF * abs(step)).all():
        raise ValueError(f"its places along {coordinate.name} must be on a regular grid")
    return float(step * size)


def line_scan(path: Path, channel: str | int | None) -> tuple[Array, Array, str | None]:
    """Return places and heights of a line in an instrument's file, and the unit of the file."""
    return _first_content(path, channel, lambda reader: _line(reader, channel), lambda likely: None)


def _first_content(
    path: Path,
    channel: str | int | None,
    take: Callable[[Reader], Content],
    table: Callable[[bool], Content | None],
) -> Content:
    """Return what the first reader of SurfaceTopography has that knows the file.

    `table` reads text that no likely reader knows; it is called with whether there were some.
    """
    with extra("surfaces"), warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)  # a warning that MPI is missing
        from SurfaceTopography.IO import MagicMatch, readers

    _check_sizes(path)
    content, ending = path.read_bytes(), path.suffix.lower().lstrip(".")
    instruments = [reader for reader in readers if reader.format() not in TABLES]
    match = {reader: reader.can_read(content[:512]) for reader in instruments}
    nanoscope = [cls for cls in instruments if cls.format() == "di" and NANOSCOPE.match(content)]
    likely = [cls for cls in instruments if ending in (cls.file_extensions() or ())]
    likely = nanoscope + [cls for cls in likely if cls not in nanoscope]
    likely += [cls for cls in instruments if match[cls] == MagicMatch.YES and cls not in likely]
    reasons: dict[str, str] = {}

    def read_first(candidates: Sequence[Any]) -> Content | None:
        for reader in candidates:
            try:
                with reader(_x3p_copy(path) if reader.format() == "x3p" else str(path)) as opened:
                    return take(opened)
            except Unfound as error:
                raise ValueError(f"{error}; the file is {str(path)!r}") from None
            except Other as error:
                raise ValueError(f"{str(path)!r} {error}") from None
            except Exception as error:  # readers raise anything for a damaged or another file
                reason = f"no {error}" if isinstance(error, KeyError) else str(error)
                reasons[reader.name()] = reason or type(error).__name__
        return None

    if (surface := read_first(likely)) is not None:
        return surface
    reasons_text = "; ".join(
        f"{name}: {' '.join(text.split())[:200]}" for name, text in reasons.items()
    )
    is_plain = is_text(content)
    if is_plain and (surface := table(bool(likely))) is not None:
        return surface
    if any(ending in (reader.file_extensions() or ()) for reader in likely):
        raise ValueError(f"{str(path)!r} cannot be read: {reasons_text}")
    maybe = [cls for cls in instruments if match[cls] == MagicMatch.MAYBE and cls not in likely]
    surface = read_first([cls for cls in maybe if not is_plain or cls.format() in HEADED])
    if surface is not None:
        return surface
    if likely:
        raise ValueError(
            f"{str(path)!r} has no format that SurfaceTopography reads; {reasons_text}"
        )
    raise ValueError(
        f"{str(path)!r} has no format that SurfaceTopography reads; nacre itself reads .npy, "
        ".csv and .xyz"
    )


def _largest_part(path: Path) -> int:
    """Return how many bytes a part of a file may unpack to."""
    return max(RATIO * path.stat().st_size, LEAST_UNPACKED)


def _check_sizes(path: Path) -> None:
    """Refuse an archive with a part out of proportion; `_x3p_copy` looks at the parts of an X3P."""
    parts: list[tuple[str, int]] = []
    if path.suffix.lower() == ".mat":
        with suppress(struct.error, zlib.error):  # of a damaged file
            parts = [("a matrix", size) for size in _sizes_in_mat(path.read_bytes())]
    elif path.suffix.lower() != ".x3p" and zipfile.is_zipfile(path):
        with suppress(zipfile.BadZipFile), zipfile.ZipFile(path) as archive:
            parts = [(item.filename, item.file_size) for item in archive.infolist()]
    for name, size in parts:
        if size > _largest_part(path):
            raise ValueError(f"{str(path)!r} {UNPROPORTIONAL.format(repr(name[:60]), size)}")


def _sizes_in_mat(content: bytes) -> Iterator[int]:
    """Yield the bytes that the compressed elements of a file of MATLAB's version 5 unpack to."""
    tag = struct.Struct("<II" if content[126:128] == b"IM" else ">II")
    at = 128
    while at + tag.size <= len(content):
        kind, size = tag.unpack_from(content, at)
        at += tag.size
        if kind == COMPRESSED:
            yield tag.unpack(zlib.decompressobj().decompress(content[at : at + 100], tag.size))[1]
        at += size


class Other(ValueError):
    """Heights of another dimension than is asked for; the message goes on after a file's name."""


class Unfound(ValueError):
    """A channel that a file does not have, or several of which none is certain."""


def _table(text: Text, channel: str | int | None) -> Heights:
    """Return the heights of a table; SurfaceTopography knows the heads of a matrix."""
    from SurfaceTopography.IO import AscReader

    has_channels = all(table.title.startswith("#") for table in text.tables[1:])
    if len(text.tables) > 1 and not has_channels:
        text.tables = [text.channel_table(channel)]
        channel = None
    first = text.tables[0]
    points = text.points(first)
    if points is not None:
        return points
    own = text.matrix(first)
    if not text.above and channel is None:
        return own._replace(is_metric=False)
    # Without what was left out, with a line for each y, and between the same lines of the file.
    first.rows = own.heights.T.tolist()
    first.lines = np.linspace(first.lines[0], first.lines[-1], len(first.rows)).tolist()
    try:
        with AscReader(io.StringIO(text.plain())) as reader:
            heights = _heights(reader, channel)
    except Unfound as error:
        raise ValueError(f"{error}; the file is {str(text.path)!r}") from None
    except Exception:
        return own._replace(is_metric=False)
    if heights.unit is None and heights.spacing is None:
        return own._replace(heights=heights.heights, is_metric=False)
    return heights._replace(is_metric=False)


def _x3p_copy(path: Path) -> str | io.BytesIO:
    """Return an X3P whose name of the standard has a hyphen, and that has no folder.

    Other programs write a dash there, and put all files in a folder. What the index, main.xml, does
    not name is left out.
    """
    buffer = io.BytesIO()
    try:
        with zipfile.ZipFile(path) as archive, zipfile.ZipFile(buffer, "w") as copy:
            members = {item.filename: item for item in archive.infolist()}
            main = next(name for name in members if name.rpartition("/")[2] == "main.xml")
            folder = main.removesuffix("main.xml")
            named: set[bytes] = set()
            for name in (main, *(name for name in members if name != main)):
                if name != main and name.removeprefix(folder).encode() not in named:
                    continue
                if (size := members[name].file_size) > _largest_part(path):
                    raise Other(UNPROPORTIONAL.format(repr(name[:60]), size))
                content = archive.read(name)
                if name == main:
                    content = REVISION.sub(rb"\1ISO5436 - 2000\2", content)
                    named = {text.strip() for text in re.findall(b">([^<>]*)<", content)}
                copy.writestr(name.removeprefix(folder), content)
    except Other:
        raise
    except Exception:  # the reader says what is wrong
        return str(path)
    buffer.seek(0)
    return buffer


class Channel(Protocol):
    """A channel of SurfaceTopography."""

    name: str
    dim: int
    physical_sizes: Sequence[float] | None
    nb_grid_pts: Sequence[int]
    unit: object

    def topography(self, **sizes: tuple[float, ...]) -> Any:
        """Return a map or a line."""


class Reader(Protocol):
    """A reader of SurfaceTopography."""

    channels: Sequence[Channel]


def _heights(reader: Reader, channel: str | int | None, most: float = math.inf) -> Heights:
    """Return the heights of a channel, which must be a map of at most so many bytes."""
    maps = [item for item in reader.channels if _dim(item) == 2]
    lines = [item for item in reader.channels if _dim(item) == 1]
    if lines and not maps:
        raise Other(NO_MAP.format(f" in the channel {lines[0].name!r}"))
    if not maps:
        names = ", ".join(repr(item.name) for item in reader.channels) or _titles(reader) or "none"
        raise ValueError(f"the file holds no channel with heights; its channels are {names}")
    map_channel = _channel(reader, channel, 2)
    if (size := 8 * math.prod(map_channel.nb_grid_pts or ())) > most:
        raise Other(UNPROPORTIONAL.format(repr(map_channel.name), size))
    # A file without sizes needs some, which are not used.
    lacking = map_channel.physical_sizes is None and map_channel.nb_grid_pts is not None
    sizes = {"physical_sizes": tuple(map(float, map_channel.nb_grid_pts))} if lacking else {}
    heights = of_topography(map_channel.topography(**sizes))
    return heights._replace(spacing=None) if lacking else heights


def _line(reader: Reader, channel: str | int | None) -> tuple[Array, Array, str | None]:
    """Return places and heights of a channel, which must be a line, and their unit."""
    if all(_dim(item) != 1 for item in reader.channels):
        raise Other("holds no profile: its heights must be a line; HeightMap.read reads a map")
    profile = _channel(reader, channel, 1)
    line = profile.topography()
    positions = line.positions()
    if line.dim == 2:
        positions = positions[int(np.argmax(line.nb_grid_pts))]
    places, heights = (
        np.ma.filled(np.ma.masked_invalid(values).astype(np.float64), np.nan).ravel()
        for values in (positions, line.heights())
    )
    return places, heights, line.unit if isinstance(line.unit, str) else None


def _titles(reader: object) -> str:
    """Return the titles of channels of Gwyddion that hold no heights, with their units."""
    metadata = getattr(reader, "_metadata", {})
    fields = [name for name in metadata if re.fullmatch(r"/\d+/data", str(name))]
    return ", ".join(repr(metadata.get(f"{name}/title") or name) for name in fields)


def of_topography(surface: Topography) -> Heights:
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


def _channel(reader: Reader, choice: str | int | None, dim: int) -> Channel:
    """Return the channel that is chosen, or the only one with heights of this dimension."""
    channels = [(k, item) for k, item in enumerate(reader.channels) if _dim(item) == dim]
    heights = [(k, item) for k, item in channels if _kind(item) == "height"] or channels
    chosen = [item for k, item in channels if choice in (k, item.name)]
    if choice is None and len(heights) == 1:
        return heights[0][1]
    if choice is not None and len(chosen) == 1:
        return chosen[0]
    texts = []
    for number, item in heights if choice is None else channels:
        size = " x ".join(map(str, item.nb_grid_pts)) if item.nb_grid_pts else "of unknown size"
        unit = getattr(item, "data_unit", None) or item.unit
        texts.append(f"{number} {item.name!r} ({size}, {f'in {unit}' if unit else 'no unit'})")
    keyword = "channel" if dim == 2 else "height"
    given, got = ("given, as ", "") if choice is None else ("", f", got {choice!r}")
    raise Unfound(f"{keyword} must be {given}one of {listed(texts)}{got}")


def _dim(channel: Channel) -> int:
    """Return 2 for a map, and 1 for a line, also where it is the only one of a map."""
    return 1 if channel.dim == 2 and 1 in (channel.nb_grid_pts or ()) else channel.dim


def _kind(channel: Channel) -> str:
    """Return what a channel holds; heights where SurfaceTopography does not say."""
    return str(getattr(getattr(channel, "data_kind", None), "value", "height"))
