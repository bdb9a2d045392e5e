"""Results in tables: saved as one, or as a list of numbers, which is printed, too."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from nacre._tools.units import printable
from nacre.results import display, files, report
from nacre.results.base import Result, Warned
from nacre.results.quantities import AXIS, Quantity
from nacre.results.tables import heading

if TYPE_CHECKING:
    import xarray


class Tabular(Result, ABC, is_base=True):
    """Base of results that are saved as NetCDF and as a table."""

    @abstractmethod
    def to_xarray(self) -> xarray.Dataset:
        """Dataset of the result; needs ``nacre-contact[files]``."""

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write a file, whole or not at all.

        Parameters
        ----------
        path : str or os.PathLike
            File to write: ``.nc`` for NetCDF, which `nacre.load` reads and which needs
            ``nacre-contact[files]``, ``.csv`` for the table, or ``.html`` for a report: verdict,
            inputs, numbers, pictures, limits and warnings on a page to print and to sign.

        Returns
        -------
        pathlib.Path
            The file.

        Raises
        ------
        ValueError
            If the file has another ending.

        Examples
        --------
        >>> import tempfile
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid)
        >>> summary = solution.stress_summary()
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     nacre.load(summary.save(f"{folder}/summary.nc")) == summary
        True
        """
        writers = files.tabular(self, self._file_rows(), **self._comments())
        return files.save(path, writers | report.writer(self))

    @abstractmethod
    def _sections(self) -> report.Sections:
        """Return what stands in a report."""

    @abstractmethod
    def _file_rows(self) -> Iterable[Iterable[object]]:
        """Return the rows of the table in a ``.csv``, the heading first."""

    def _comments(self) -> dict[str, object]:
        """Return what stands above the table."""
        return {}


class TableResult(Tabular, Warned, is_base=True):
    """Base of results whose table has a row for each of their quantities.

    The dataclass needs ``repr=False``, and `_QUANTITIES` and `_TITLE`.
    """

    _TITLE: ClassVar[str]
    """What the result is, in files."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """What limits the validity, and was warned of: the notes of a model."""
        return tuple(getattr(self, "notes", ()))

    @property
    def _known(self) -> list[Quantity]:
        """Quantities that the result has: those that are None are left out."""
        return [row for row in self._QUANTITIES if row.of(self) is not None]

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of the numbers, with units; needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Numbers by name.
        """
        table = [(row, self._si(row)) for row in self._known]
        variables = {row.name: (row.dims, np.asarray(row.of(self))) for row in self._known}
        return files.dataset(self._TITLE, table, variables, {}, self.to_dict())

    def _file_rows(self) -> Iterable[Iterable[object]]:
        cells: list[tuple[str, object]] = []
        for row in self._known:
            values = np.ravel(row.of(self)).tolist()
            names = ["x", "y"] if row.dims == AXIS else [f"{k}" for k in range(1, 1 + len(values))]
            heads = [heading(row, self, name) for name in (names if row.dims else [""])]
            cells += zip(heads, values, strict=True)
        return zip(*cells, strict=True)

    def _sections(self) -> report.Sections:
        model = [("theory", text) for text in [getattr(self, "model", "")] if text]
        rows = [row for row in self._rows() if row not in [("model", text) for _, text in model]]
        numbers = [*rows, *report.other_numbers(self)]
        return report.Sections(self._TITLE, (), numbers, model=model, warnings=self.warnings)

    def _si(self, row: Quantity) -> str:
        """Return the SI unit of a quantity of this result; that in a line contact may differ."""
        return row.si()

    def _rows(self) -> list[tuple[str, str]]:
        """Return names and values of the quantities that are printed, with units."""
        return [
            (row.label, (display.pair if row.dims else display.number)(row.of(self), self._si(row)))
            for row in self._known
            if row.label
        ]

    def __repr__(self) -> str:
        """Return the table in a line."""
        rows = ", ".join(" ".join(row) for row in self._rows())
        return printable(f"<{type(self).__name__}: {rows}>")

    def __str__(self) -> str:
        """Return the verdict, if there is one, and a table."""
        verdict = "".join(f"{sentence}\n" for sentence in self._sentences())
        return printable(f"{verdict}\n" if verdict else "") + display.text(self._rows(), [])

    def _repr_html_(self) -> str:
        return display.markup(self._rows(), verdict=self._sentences())

    def _comments(self) -> dict[str, object]:
        sentences = " ".join(self._sentences())
        return {"verdict": sentences} if sentences else {}

    def _sentences(self) -> tuple[str, ...]:
        """Return the sentences of the verdict, if there is one."""
        return self.verdict.sentences if hasattr(self, "verdict") else ()
