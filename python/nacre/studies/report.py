"""Reports of studies: their Dataset as a page to print and to sign."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nacre._tools.units import display_units, symbol
from nacre.results import display, files
from nacre.results.charts import Axis, Chart, Curve, Picture
from nacre.results.parameters import VALUES
from nacre.results.quantities import ERROR
from nacre.results.report import Rows, Table, label_of, table, write
from nacre.results.rows import Row, remark
from nacre.results.shown import Shown
from nacre.results.verdict import LEVELS
from nacre.studies.outputs import TEXTS

if TYPE_CHECKING:
    import xarray

MOST_CURVES = 7
"""Largest number of curves in a picture: there are so many colours."""
MODEL = [
    remark("theory", "each case is a solve of its own; ± is the error due to the size of the cells")
]


@dataclass(frozen=True)
class Study(Shown):
    """A Dataset of a study, of which a report is written."""

    dataset: xarray.Dataset

    def _title(self) -> str:
        return str(self.dataset.attrs.get("title", "study"))

    def _inputs(self) -> Rows:
        names = (str(name) for name in self.dataset.coords if name != "axis")
        return [Row(name, label_of(name), self._values(name)) for name in names]

    @property
    def _outputs(self) -> list[str]:
        """Names of the outputs that are numbers of each case."""
        names = [str(name) for name in self.dataset.data_vars if name not in TEXTS]
        return [n for n in names if not n.endswith(ERROR) and self.dataset[n].dims == self._dims]

    def _report_rows(self) -> Rows:
        dataset = self.dataset
        failed = int((dataset["error"] != "").sum()) if "error" in dataset else 0
        cases = int(np.prod([dataset.sizes[dim] for dim in self._dims]))
        ranges = [Row(name, label_of(name), self._range(name)) for name in self._outputs]
        rows = [remark("cases", f"{cases}, {failed} failed")]
        if "verdict" in dataset:
            counts = Counter(np.ravel(dataset["verdict"].values).tolist())
            rows.append(
                remark("verdicts", ", ".join(f"{counts[k]} {k}" for k in LEVELS[::-1] if counts[k]))
            )
        return [*rows, *ranges]

    def _charts(self) -> Sequence[Picture]:
        return [chart for name in self._outputs for chart in self._charts_of(name)]

    def _model(self) -> Rows:
        return MODEL

    @property
    def _dims(self) -> tuple[object, ...]:
        """Return the dimensions along which cases lie."""
        if "error" in self.dataset:
            return self.dataset["error"].dims
        return max((array.dims for array in self.dataset.data_vars.values()), key=len, default=())

    def _unit(self, name: str) -> str:
        """Return the unit of a variable, or of a parameter by its name; "" where it has none."""
        usual = symbol(VALUES.get(name.rpartition(".")[2], ""))
        unit = str(self.dataset[name].attrs.get("units", usual))
        return "" if unit == "1" else unit

    def _head(self, name: str) -> str:
        words = label_of(name)
        return f"{words} [{unit}]" if (unit := self._unit(name)) else words

    def _number(self, name: str, value: object) -> str:
        """Return a value of a variable, with its unit."""
        if not isinstance(value, float | int) or isinstance(value, bool):
            return str(value)
        scale = display.scale_in(value, self._unit(name))
        return f"{scale.factor * value:.5g} {scale.unit}".rstrip()

    def _values(self, name: str) -> str:
        values = np.ravel(self.dataset[name].values).tolist()
        return ", ".join(self._number(name, value) for value in dict.fromkeys(values))

    def _range(self, name: str) -> str:
        """Return the smallest and the largest value."""
        values = np.ravel(self.dataset[name].values).astype(float)
        finite = values[np.isfinite(values)]
        if not finite.size:
            return "not known"
        ends = (self._number(name, float(end)) for end in (finite.min(), finite.max()))
        return " to ".join(dict.fromkeys(ends))

    def _tables(self) -> Sequence[Table]:
        """Return the table of all cases, and that of those that failed."""
        names = self._outputs
        kept = [*names, *(name + ERROR for name in names if name + ERROR in self.dataset)]
        kept += [name for name in ("verdict", "error") if name in self.dataset]
        rows = self.dataset[kept]
        frame = rows.to_dataframe().reset_index()
        places = [str(name) for name in frame.columns if name in self.dataset.coords]
        columns = {self._head(name): frame[name].tolist() for name in places}
        if "verdict" in frame:
            columns["verdict"] = frame["verdict"].tolist()
        for name in names:
            columns[self._head(name)] = frame[name].tolist()
            if name + ERROR in frame:
                pairs = zip(frame[name + ERROR], frame[name], strict=True)
                columns[f"± of {label_of(name)}"] = [
                    display.share(e, v) if np.isfinite(e) and np.isfinite(v) else ""
                    for e, v in pairs
                ]
        if (doubts := self._doubts()) and any(doubts):
            columns["resolved"] = ["no" if doubt else "yes" for doubt in doubts]
        tables = [table("Cases", [[*columns], *zip(*columns.values(), strict=True)])]
        if "error" in frame and (wrong := frame[frame["error"] != ""]).size:
            cells = [[*map(str, row)] for row in wrong[[*places, "error"]].values.tolist()]
            tables.append(Table("Cases that failed", [*map(label_of, places), "error"], cells))
        return tables

    def _doubts(self) -> list[bool]:
        """Return whether the cells of each case are too large for some of its numbers."""
        if "warnings" not in self.dataset or self.dataset["warnings"].dims != self._dims:
            return []
        return ["uncertain" in text for text in np.ravel(self.dataset["warnings"].values).tolist()]

    def _charts_of(self, name: str) -> list[Chart]:
        """Return the chart of an output over the first parameter that is a number."""
        output = self.dataset[name]
        along = [
            dim
            for dim in output.dims
            if dim in output.coords
            and output.coords[dim].dtype.kind in "fiu"
            and output.sizes[dim] > 1
        ]
        if output.dtype.kind not in "fiu" or output.dims != self._dims:
            return []
        if not along or not np.isfinite(output).any():
            return []
        x, dims = str(along[0]), [dim for dim in output.dims if dim != along[0]]
        flat = output.stack(others=dims) if dims else output.expand_dims("others")
        curves = []
        for k in range(min(flat.sizes["others"], MOST_CURVES)):
            line = flat.isel(others=k)
            places = ", ".join(
                f"{label_of(str(dim))} {self._number(str(dim), line[dim].item())}" for dim in dims
            )
            curves.append(Curve(output[x].values, line.values, places))
            if name + ERROR in self.dataset:  # ± as thin lines
                error = self.dataset[name + ERROR].transpose(*output.dims)
                error = error.stack(others=dims) if dims else error.expand_dims("others")
                bounds = (line + sign * error.isel(others=k).values for sign in (-1.0, 1.0))
                curves += [Curve(output[x].values, bound.values, "", "thin") for bound in bounds]
        low, high = float(output.min()), float(output.max())
        margin = (high - low) / 10
        # Of values that hardly change, 0 is not shown.
        ends = (low - margin, high + margin) if 0 < margin < low / 20 else None
        axes = (self._axis(x), self._axis(name)._replace(ends=ends))
        return [Chart(f"{label_of(name)} over {label_of(x)}.", curves, axes)]

    def _axis(self, name: str) -> Axis:
        return Axis(label_of(name), self._unit(name), is_exact=True)

    @property
    def _warnings(self) -> Sequence[str]:
        if "warnings" not in self.dataset:
            return []
        texts = np.ravel(self.dataset["warnings"].values).tolist()
        return list(dict.fromkeys(line for text in texts for line in text.splitlines()))


def save_report(
    dataset: xarray.Dataset,
    path: str | os.PathLike[str],
    *,
    case: str | None = None,
    inputs: Sequence[tuple[str, str]] = (),
    head: Mapping[str, str] | None = None,
) -> Path:
    """Write the report of a study, whole or not at all: a page of HTML to print and to sign.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset that `nacre.sweep` returned.
    path : str or os.PathLike
        File to write, ``.html``.
    case : str, optional
        Text of the case file, which the page holds in full.
    inputs : sequence of tuple, optional
        Further inputs: names and texts.
    head : mapping of str to str, optional
        Texts of the head: project, part, load case, drawn by, checked by.

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
    >>> from nacre.studies.report import save_report
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> case = {"shape": nacre.Sphere(5e-3), "body": steel, "max_cells": 4096}
    >>> study = nacre.sweep(case, {"load": [5.0, 10.0]})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_report(study, f"{folder}/study.html").name
    'study.html'
    """
    with display_units(str(dataset.attrs.get("unit_system", "SI"))):
        rows = [remark(name, text) for name, text in inputs]
        return files.save(
            path, {".html": lambda file: write(file, [Study(dataset)], case, rows, head)}
        )
