"""CSV files of results, for spreadsheets: rows after a block of comments ``# name: value``."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.units import symbol
from nacre.results.quantities import VECTOR, Quantity

Array = npt.NDArray[np.float64]
Part = tuple[slice | int, slice | int]
"""Index of rows and columns of cells."""

SOURCE = f"nacre {core.__version__}"
"""What wrote a file."""


class HasQuantities(Protocol):
    """A result that declares quantities."""

    @property
    def _QUANTITIES(self) -> tuple[Quantity, ...]: ...

    def _si(self, row: Quantity) -> str: ...

    def to_dict(self) -> dict[str, object]:
        """Return the named state."""


class Gridded(HasQuantities, Protocol):
    """A solved contact on a grid, with friction or without."""

    @property
    def _TITLE(self) -> str: ...

    @property
    def _warnings(self) -> Sequence[str]: ...

    @property
    def grid(self) -> core.Grid:
        """Grid."""

    @property
    def x(self) -> Array:
        """Cell centres along x [m]."""

    @property
    def y(self) -> Array:
        """Cell centres along y [m]."""

    def _attributes(self) -> dict[str, object]: ...


class Peaked(Gridded, Protocol):
    """A solved contact with a largest pressure."""

    @property
    def pressure(self) -> Array:
        """Pressure [Pa]."""

    @property
    def peak_position(self) -> tuple[float, float]:
        """Centre of the cell of the largest pressure [m]."""


def numbers(result: HasQuantities) -> Iterator[tuple[Quantity, Any]]:
    """Yield the numbers of a contact, those that it has, with their quantities.

    One that is NaN along both axes, as the moment of a periodic contact, is none.
    """
    for row in result._QUANTITIES:
        is_number = not row.dims or row.dims[0] == "axis"
        if is_number and (value := row.of(result)) is not None and not np.isnan(value).all():
            yield row, value


def fields(result: HasQuantities) -> dict[Quantity, Array]:
    """Return the fields of a contact that tables and pictures show, by their quantities."""
    state, arrays = result.to_dict(), {}
    for row in result._QUANTITIES:
        if row.is_field and (row.follows or isinstance(row.within(state), np.ndarray)):
            arrays[row] = row.of(result)
    return arrays


def heading(row: Quantity, result: HasQuantities, axis: str = "") -> str:
    """Return the heading of a quantity, with the unit that is set."""
    unit = symbol(result._si(row))
    name = f"{row.name} {axis}".rstrip().replace("_", " ")
    return f"{name} [{unit}]" if unit else name


def columns(result: HasQuantities) -> dict[str, Array]:
    """Return a column for each field of a contact, two of a vector, by their headings."""
    arrays = {}
    for row, values in fields(result).items():
        components = zip("xy", values, strict=True) if row.dims == VECTOR else [("", values)]
        for axis, data in components:
            arrays[heading(row, result, axis)] = data.astype(int) if data.dtype == bool else data
    return arrays


def write_rows(path: Path, rows: Iterable[Iterable[object]], **comments: object) -> None:
    """Write rows, the heading first, after comments."""
    with path.open("w", newline="", encoding="utf-8") as file:
        file.writelines(f"# {name}: {value}\n" for name, value in comments.items())
        csv.writer(file).writerows(rows)


def write_sections(result: Peaked, path: Path) -> None:
    """Write the sections along x and along y through the largest pressure."""
    i, j = (
        int(np.argmin(np.abs(side - place)))
        for side, place in zip((result.x, result.y), result.peak_position, strict=True)
    )
    _write(result, path, {"x": (slice(None), j), "y": (i, slice(None))})


def write_cells(result: Gridded, path: Path) -> None:
    """Write every cell, after a block of comments with the numbers."""
    grid = result.grid
    comments = {
        "source": SOURCE,
        "cells": "{} x {}, y varies fastest".format(*grid.shape),
        f"spacing [{symbol('m')}]": "{} {}".format(*grid.spacing),
        **{heading(row, result): _plain(value) for row, value in numbers(result)},
        **{
            name: attribute
            for name, attribute in result._attributes().items()
            if name != "warnings"
        },
        **{f"warning {k}": text for k, text in enumerate(result._warnings, start=1)},
    }
    _write(result, path, {"": (slice(None), slice(None))}, **comments)


def _write(result: Gridded, path: Path, blocks: Mapping[str, Part], **comments: object) -> None:
    """Write parts of the grid, each with its name in a column of its own if it has one."""
    x, y = np.meshgrid(result.x, result.y, indexing="ij")
    positions = {f"{name} [{symbol('m')}]": side for name, side in (("x", x), ("y", y))}
    table = positions | columns(result)

    def rows() -> Iterator[list[object]]:
        for name, block in blocks.items():
            values = (np.ravel(column[block]).tolist() for column in table.values())
            yield from ([name, *row] if name else list(row) for row in zip(*values, strict=True))

    head = [*(["along"] if "x" in blocks else []), *table]
    write_rows(path, [head, *rows()], **comments)


def _plain(value: npt.ArrayLike) -> str:
    return " ".join(str(number) for number in np.ravel(value).tolist())
