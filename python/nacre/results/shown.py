"""What every result does with what it says: print, notebook, report and files, made once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple

import numpy as np

from nacre._tools.typing import AnyPath
from nacre._tools.units import SI, Within, printable
from nacre.results import display, files, report
from nacre.results.base import Fields, Result, Warned
from nacre.results.charts import Picture
from nacre.results.quantities import AXIS, Quantity
from nacre.results.report import Rows, Sections, Table
from nacre.results.rows import Row, remark
from nacre.results.tables import heading
from nacre.results.verdict import verdict_on

if TYPE_CHECKING:
    import xarray


class Printed(NamedTuple):
    """A table that is printed, with notes below it."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    notes: Sequence[str] = ()
    side: Literal["<", ">"] = "<"
    """Side on which cells are aligned."""


class Shown(Fields):
    """Base of results that say what they have: rows, tables, pictures, inputs and remarks.

    A class overrides what it has; printed forms, reports and files follow.
    """

    _TITLE: ClassVar[str]
    """What the result is, in files."""
    _IN_SI: Any = False
    """Whether numbers are in SI whatever units are set, as those of bearings are."""

    def _title(self) -> str:
        """Return what the result is, in a report."""
        return self._TITLE

    def _rows(self) -> list[Row]:
        """Return the main numbers."""
        return []

    def _remarks(self) -> list[Row]:
        """Return how the result came about, which is printed below the numbers."""
        return []

    def _table(self) -> Printed | None:
        """Return the table that is printed."""
        return None

    def _inputs(self) -> Rows:
        """Return the inputs in a report."""
        return ()

    def _report_rows(self) -> Rows:
        """Return the numbers in a report."""
        return self._rows()

    def _charts(self) -> Sequence[Picture]:
        """Return the charts of a report."""
        return ()

    def _tables(self) -> Sequence[Table]:
        """Return the tables of a report."""
        return ()

    def _model(self) -> Rows:
        """Return theory, limits and how the result came about, in a report."""
        return self._remarks()

    @property
    def _warnings(self) -> Sequence[str]:
        """Warnings."""
        return tuple(getattr(self, "warnings", ()))

    def _sentences(self) -> tuple[str, ...]:
        """Return the sentences of the verdict, if there is one."""
        verdict = verdict_on(self)
        return () if verdict is None else verdict.sentences

    def _notebook_picture(self) -> bytes | None:
        """Return the picture in a notebook."""
        return None

    def _file_rows(self) -> Iterable[Iterable[object]] | None:
        """Return the rows of the table in a ``.csv``, the heading first; None without a table."""
        return None

    def _comments(self) -> dict[str, object]:
        """Return what stands above the table of a ``.csv``."""
        sentences = " ".join(self._sentences())
        return {"verdict": sentences} if sentences else {}

    def _numbered_warnings(self) -> dict[str, object]:
        """Return the warnings by number, for files."""
        return {f"warning {k}": text for k, text in enumerate(self._warnings, start=1)}

    def _units(self) -> AbstractContextManager[None]:
        """Return the context in which the result is shown."""
        return Within(SI) if self._IN_SI else nullcontext()

    def _sections(self, **stress: Any) -> Sections:
        """Return what stands in a report; keywords of stresses are those of their picture."""
        with self._units():
            return Sections(
                self._title(),
                self._inputs(),
                self._report_rows(),
                report.drawn(self._charts(**stress)),
                self._tables(),
                self._model(),
                self._warnings,
            )

    def __repr__(self) -> str:
        """Return the numbers in a line."""
        with self._units():
            rows = [*self._rows(), *self._remarks()]
        numbers = ", ".join(f"{row.label} {row.text}" for row in rows)
        return printable(f"<{type(self).__name__}: {numbers}>")

    def __str__(self) -> str:
        """Return the verdict, if there is one, the numbers, and the table."""
        with self._units():
            rows, table = [*self._rows(), *self._remarks()], self._table()
            sentences = [line for text in self._sentences() for line in display.wrap(text)]
            lines = [*sentences, ""] if sentences else []
            notes = (f"warning: {text}" for text in self._warnings)
            warnings = [line for note in notes for line in display.wrap(note)]
        if rows:
            lines += [display.text(rows, ()), *warnings, *([""] if table else [])]
        if table:
            lines += display.aligned([table.head, *table.rows], table.side)
            lines += [line for note in table.notes for line in display.wrap(note)]
        return printable("\n".join(lines if rows else [*lines, *warnings]))

    def _repr_html_(self) -> str:
        with self._units():
            verdict, picture = self._sentences(), self._notebook_picture()
            rows, table = [*self._rows(), *self._remarks()], self._table()
        if rows or table is None:
            cells = [[text for text in (row.label, row.text) if text] for row in rows]
            return display.markup(cells, self._warnings, picture, verdict=verdict)
        notes = table.notes
        return display.markup(table.rows, self._warnings, picture, table.head, notes, verdict)

    def save(self, path: AnyPath) -> Path:
        """Write a file, whole or not at all.

        Parameters
        ----------
        path : str or os.PathLike
            File to write. Its ending chooses the content: ``.nc`` is everything, as NetCDF, which
            `nacre.load` reads and which needs ``nacre-contact[files]``; ``.csv`` is the table;
            ``.png``, ``.pdf`` and ``.svg`` are the picture of `plot`, where there is one; ``.html``
            is a report: verdict, inputs, numbers, pictures, limits and warnings on a page to print
            and to sign; ``.vtr`` is the fields of a contact, for ParaView.

        Returns
        -------
        pathlib.Path
            The file.

        Raises
        ------
        ValueError
            If the file has another ending.
        OSError
            If the file cannot be written.

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
        with self._units():
            return files.save(path, self._writers() | report.writer(self))

    def _writers(self) -> dict[str, Callable[[Path], object]]:
        """Return the writers of all files but the report, by their endings."""
        rows, result, writers = self._file_rows(), self, {}
        if rows is not None:
            writers = files.tabular(result, rows, **self._comments())  # type: ignore[arg-type]
        plot = getattr(self, "plot", None)
        return writers | (files.pictures(lambda: files.first_axes(plot())) if plot else {})


class TableResult(Shown, Warned, Result, is_base=True):
    """Base of results that are a list of numbers, a row for each of their quantities.

    The class is `frozen` and needs a `_TITLE`.
    """

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
        with self._units():
            table = [(row, self._si(row)) for row in self._known]
            variables = {row.name: (row.dims, np.asarray(row.of(self))) for row in self._known}
            state = self.to_dict()
            files.take_arrays(state, self._QUANTITIES)
            grid = getattr(self, "grid", None)
            places = {} if grid is None else {"x": grid.x, "y": grid.y}
            return files.dataset(self._TITLE, table, variables, places, state)

    def _file_rows(self) -> Iterable[Iterable[object]]:
        cells: list[tuple[str, object]] = []
        for row in self._known:
            values = np.ravel(row.of(self)).tolist()
            names = ["x", "y"] if row.dims == AXIS else [f"{k}" for k in range(1, 1 + len(values))]
            heads = [heading(row, self, name) for name in (names if row.dims else [""])]
            cells += zip(heads, values, strict=True)
        return zip(*cells, strict=True)

    def _si(self, row: Quantity) -> str:
        """Return the SI unit of a quantity of this result; that in a line contact may differ."""
        return row.si()

    def _rows(self) -> list[Row]:
        rows = []
        for row in (row for row in self._known if row.label):
            value, unit = row.of(self), self._si(row)
            text = (display.pair if row.dims else display.number)(value, unit)
            rows.append(Row(row.name, row.label, text, value, unit))
        return rows

    def _remarks(self) -> list[Row]:
        model = getattr(self, "model", "")
        return [remark("model", model)] if model else []

    def _report_rows(self) -> Rows:
        return [*self._rows(), *report.other_numbers(self)]

    def _model(self) -> Rows:
        return [row._replace(label="theory") for row in self._remarks()]
