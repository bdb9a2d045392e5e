"""Files, whole or not at all: any dataset as NetCDF, states with a checksum, and their content."""

from __future__ import annotations

import hashlib
import io
import json
import os
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from nacre._extras import extra
from nacre.values import FORMAT

if TYPE_CHECKING:
    import xarray

STATE = "nacre_solution"
"""Attribute that holds the rest of the state, as JSON."""
CHECKSUM = "nacre_checksum"
"""Attribute that holds the SHA-256 of all that `load` reads; files of older versions lack it."""

DIMENSION = b"This is a netCDF dimension but not a netCDF variable"
"""Beginning of the attribute NAME of what is no variable."""


class Variable(NamedTuple):
    """A variable of a file."""

    dimensions: tuple[str, ...]
    values: npt.NDArray[Any]


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary file that replaces `path` at once in the end; an error leaves no file."""
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{str(path.parent)!r} is not a folder")
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.stem}-") as folder:
        temporary = Path(folder) / path.name
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        os.replace(temporary, path)


def write_dataset(dataset: xarray.Dataset, path: Path) -> None:
    """Write any dataset as NetCDF, to the bit."""
    with extra("files"):
        import h5netcdf  # noqa: F401

    encoding = {
        name: {"_FillValue": None, "zlib": True, "complevel": 4, "shuffle": True}
        for name, variable in dataset.variables.items()
        if variable.dtype.kind == "f" and variable.ndim > 0
    }
    # HDF5 writes to memory: on a full disk it would crash when the process ends.
    path.write_bytes(dataset.to_netcdf(engine="h5netcdf", encoding=encoding))


def read(content: bytes) -> tuple[dict[str, Any], dict[str, Variable]]:
    """Return the attributes of a file from its content, and its variables that hold numbers."""
    import h5py

    try:
        # The content is in memory, so that HDF5 keeps no damaged file open.
        with h5py.File(io.BytesIO(content), "r") as file:
            attributes = {name: file.attrs.get(name) for name in (STATE, CHECKSUM)}
            variables = {
                name: Variable(
                    tuple(d[0].name.rpartition("/")[2] if len(d) else "" for d in item.dims),
                    np.asarray(item[()]),
                )
                for name, item in file.items()
                if isinstance(item, h5py.Dataset)
                and item.dtype.kind in "fiu"
                and not bytes(item.attrs.get("NAME", b"")).startswith(DIMENSION)
            }
    except Exception as error:  # whatever HDF5 says of a damaged file
        raise ValueError("it is no NetCDF file, or a damaged one") from error
    return attributes, variables


def seal(dataset: xarray.Dataset, state: Mapping[str, Any]) -> None:
    """Put a whole state into a dataset that shows its numbers, with a checksum of both."""
    dataset.attrs[STATE] = json.dumps(state)
    shown = {str(name): variable.values for name, variable in dataset.variables.items()}
    dataset.attrs[CHECKSUM] = _checksum(dataset.attrs[STATE], shown)


def check_seal(
    state: Mapping[str, Any], attributes: Mapping[str, Any], variables: Mapping[str, Variable]
) -> None:
    """Raise a `ValueError` if the content of a file is not what `seal` put there."""
    written = state.get("format")
    if isinstance(written, int) and written > FORMAT:
        return  # `from_dict` says so
    shown = {name: variable.values for name, variable in variables.items()}
    if attributes[CHECKSUM] != _checksum(attributes[STATE], shown):
        raise ValueError("its content is not what was saved: it was changed or damaged")


def _checksum(state: str, shown: Mapping[str, npt.NDArray[Any]]) -> str:
    digest = hashlib.sha256(state.encode())
    for name in sorted(name for name, values in shown.items() if values.dtype.kind == "f"):
        digest.update(name.encode())
        digest.update(np.ascontiguousarray(shown[name], dtype="<f8").tobytes())
    return digest.hexdigest()
