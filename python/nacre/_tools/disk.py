"""Files, whole or not at all: any dataset as NetCDF, and the content of those that nacre wrote.

HDF5 may hang or crash on a damaged file, beyond any signal. So a file ends in a seal, which HDF5
ignores: a mark of its kind and the SHA-256 of all before. Only a file with a right seal is opened,
and of it only arrays that are stored plainly, which take no more room in memory than in the file.
A checksum is no signature: it finds damage, not malice.
"""

from __future__ import annotations

import hashlib
import os
import secrets
import shutil
import sys
from collections.abc import Collection, Iterator
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra

if TYPE_CHECKING:
    import xarray

STATE = "nacre_solution"
"""Attribute that holds the rest of the state, as JSON."""
PICTURES = (".png", ".pdf", ".svg")
"""Endings of pictures."""
FILMS = (".gif", ".mp4")
"""Endings of films."""
RESULT, STUDY = b"\nnacre result\n\0\0", b"\nnacre study\n\0\0\0"
"""Marks of a result that `nacre.load` reads, and of a study."""
TEMPORARY = ".nacre-tmp"
"""What follows the name in that of a temporary file."""
MARK, SEAL = 16, 48
"""Bytes of a mark, and of a mark and a digest: the last ones of a file."""


def check_folder(path: Path) -> None:
    """Raise a `FileNotFoundError` unless the folder of a file exists."""
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{str(path.parent)!r} is not a folder")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary file that replaces `path` at once in the end; an error leaves no file.

    A link stays, and a file that is there keeps its mode.
    """
    check_folder(path)
    path = Path(os.path.realpath(path))
    check_folder(path)
    with naming(path), _temporary(path) as temporary:
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        if path.exists():
            shutil.copymode(path, temporary)
        os.replace(temporary, path)
        sync_folder(path)


def name_of(path: Path) -> str:
    """Return the name of a file without its ending; of a temporary one, that of its file."""
    name, mark, _ = path.stem.partition(TEMPORARY)
    return name[1:] if mark else name


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Name a file in errors of the system that name none, such as those of a full disk."""
    try:
        yield
    except OSError as error:
        if error.errno is not None and error.filename is None:
            error.filename = str(path)
        raise


def sync_folder(path: Path) -> None:
    """Write the name of a file to the disk, where the system lets folders be written so."""
    with suppress(OSError):
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


@contextmanager
def _temporary(path: Path) -> Iterator[Path]:
    """Yield a new file beside another, locked until the end; one that a kill left is removed.

    While another process writes it, it has another name. Its ending is that of the other.
    """
    ending, mode = path.suffix.lower(), 0o600 if path.exists() else 0o666
    names = [f".{path.stem}{TEMPORARY}{own}{ending}" for own in ("", secrets.token_hex(4))]
    first, second = map(path.with_name, names)
    with suppress(OSError), first.open("rb+") as left:
        if _is_ours(left, first, without_locks=False):
            first.unlink()
    try:
        temporary, file = first, _new(first, mode)
    except OSError:
        temporary, file = second, _new(second, mode)
    with file:
        try:
            if sys.platform == "win32":
                file.close()  # an open file cannot be renamed there
            yield temporary
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def _new(path: Path, mode: int) -> IO[bytes]:
    """Return a new file, locked; whatever has its name is an error."""
    file = os.fdopen(os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL, mode), "rb+")
    if not _is_ours(file, path, without_locks=True):
        file.close()
        raise BlockingIOError(f"{str(path)!r} is taken")
    return file


def _is_ours(file: IO[bytes], path: Path, *, without_locks: bool) -> bool:
    """Lock an open file, and return whether no other process has it and it still has its name."""
    if sys.platform == "win32":
        return without_locks
    import fcntl

    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return os.path.samestat(os.fstat(file.fileno()), os.lstat(path))
    except (BlockingIOError, FileNotFoundError):
        return False
    except OSError:  # no locks on this disk
        return without_locks


def write_dataset(dataset: xarray.Dataset, path: Path, mark: bytes = RESULT) -> None:
    """Write any dataset as NetCDF, to the bit, with a seal."""
    with extra("files"):
        import h5netcdf  # noqa: F401

    encoding = {name: {"_FillValue": None} for name in dataset.variables}
    # HDF5 writes to memory: on a full disk it would crash when the process ends. A client of Dask
    # would have a lock for all its workers, which a file in memory cannot have.
    dask = sys.modules.get("dask")
    with dask.config.set(scheduler="threads") if dask else nullcontext():
        content = dataset.to_netcdf(engine="h5netcdf", encoding=encoding)
    with path.open("wb") as file:
        file.write(content)
        file.write(mark + hashlib.sha256(content).digest())


def is_study(path: Path) -> bool:
    """Return whether a file ends as a study does; its content is not read."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return _seal(file)[:MARK] == STUDY


def read(path: Path, names: Collection[str]) -> tuple[str, dict[str, npt.NDArray[np.float64]]]:
    """Return the state of a result as text, and those of its variables that have these names."""
    import h5py

    with path.open("rb") as file:
        seal = _seal(file)
        size = file.tell()
        if seal[:MARK] == STUDY:
            raise ValueError("it is a study, which xarray.load_dataset reads")
        if seal[:MARK] != RESULT:
            raise ValueError(
                "its end is not that of a file of nacre: it is another file, or it was cut, "
                "changed, or saved again by another program"
            )
        if _digest(file, size - SEAL) != seal[MARK:]:
            raise ValueError("its content is not what was saved: it was changed or damaged")
        file.seek(0)
        try:
            with h5py.File(file, "r") as content:
                state = content.attrs[STATE]
                items = {}
                for name in names:
                    if name not in content:
                        continue
                    if content.get(name, getclass=True, getlink=True) is not h5py.HardLink:
                        raise ValueError(f"{name} is a link")
                    items[name] = content[name]
                for name, item in items.items():
                    stored = not (item.chunks or item.external or item.is_virtual)
                    if item.dtype.kind != "f" or not stored:
                        raise ValueError(f"{name} must be real numbers that are stored plainly")
                if sum(item.nbytes for item in items.values()) > size:
                    raise ValueError("its arrays are larger than the file")
                arrays = {name: np.asarray(item[()]) for name, item in items.items()}
        except Exception as error:  # whatever HDF5 says of a file that it cannot read
            raise ValueError(f"it is no result that nacre wrote: {error}") from error
    if not isinstance(state, str):
        raise ValueError(f"the attribute {STATE} must be a text, got {state!r:.60}")
    return state, arrays


def _seal(file: IO[bytes]) -> bytes:
    """Return the last bytes of a file, and leave it at its end."""
    file.seek(max(0, file.seek(0, os.SEEK_END) - SEAL))
    return file.read()


def _digest(file: IO[bytes], size: int) -> bytes:
    """Return the SHA-256 of the beginning of a file, read in pieces."""
    digest = hashlib.sha256()
    file.seek(0)
    while size > 0 and (piece := file.read(min(size, 1 << 20))):
        digest.update(piece)
        size -= len(piece)
    return digest.digest()
