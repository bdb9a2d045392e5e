"""Reports of studies: their Dataset as a page to print and to sign."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nacre._tools.units import display_units, symbol
from nacre.results import display, files, svg
from nacre.results.parameters import VALUES
from nacre.results.quantities import ERROR
from nacre.results.report import Picture, Rows, Sections, Table, table, write

if TYPE_CHECKING:
    import xarray

MOST_CURVES = 7
"""Largest number of curves in a picture: there are so many colours."""
MODEL = (
    ("theory", "each case is a solve of its own; ± is the error due to the size of the cells"),
)


@dataclass(frozen=True)
class Study:
    """A Dataset of a study, of which a report is written."""

    dataset: xarray.Dataset

    def _sections(self) -> Sections:
        dataset, texts = self.dataset, ("error", "warnings")
        names = [str(name) for name in dataset.data_vars if name not in texts]
        names = [name for name in names if not name.endswith(ERROR)]
        numbers = [name for name in names if dataset[name].dims == self._dims]
        failed = int((dataset["error"] != "").sum()) if "error" in dataset else 0
        cases = int(np.prod([dataset.sizes[dim] for dim in self._dims]))
        return Sections(
            str(dataset.attrs.get("title", "study")),
            [(str(name), self._values(str(name))) for name in dataset.coords if name != "axis"],
            [
                ("cases", f"{cases}, {failed} failed"),
                *((name, self._range(name)) for name in numbers),
            ],
            [picture for name in numbers for picture in self._pictures(name)],
            self._tables(numbers),
            MODEL,
            self._warnings(),
        )

    @property
    def _dims(self) -> tuple[object, ...]:
        """Return the dimensions along which cases lie."""
        if "error" in self.dataset:
            return self.dataset["error"].dims
        return max((one.dims for one in self.dataset.data_vars.values()), key=len, default=())

    def _unit(self, name: str) -> str:
        """Return the unit of a variable, or of a parameter by its name; "" where it has none."""
        usual = symbol(VALUES.get(name.rpartition(".")[2], ""))
        unit = str(self.dataset[name].attrs.get("units", usual))
        return "" if unit == "1" else unit

    def _head(self, name: str) -> str:
        return f"{name} [{unit}]" if (unit := self._unit(name)) else name

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

    def _tables(self, names: list[str]) -> list[Table]:
        """Return the table of all cases, and that of those that failed."""
        kept = [*names, *(name + ERROR for name in names if name + ERROR in self.dataset)]
        rows = self.dataset[[*kept, *(["error"] if "error" in self.dataset else [])]]
        frame = rows.to_dataframe().reset_index()
        places = [str(name) for name in frame.columns if name in self.dataset.coords]
        columns = {self._head(name): frame[name].tolist() for name in places}
        for name in names:
            columns[self._head(name)] = frame[name].tolist()
            if name + ERROR in frame:
                pairs = zip(frame[name + ERROR], frame[name], strict=True)
                columns[f"± of {name}"] = [
                    display.share(e, v) if np.isfinite(e) and np.isfinite(v) else ""
                    for e, v in pairs
                ]
        tables = [table("Cases", [[*columns], *zip(*columns.values(), strict=True)])]
        if "error" in frame and (wrong := frame[frame["error"] != ""]).size:
            cells = [[*map(str, row)] for row in wrong[[*places, "error"]].values.tolist()]
            tables.append(Table("Cases that failed", [*places, "error"], cells))
        return tables

    def _pictures(self, name: str) -> list[Picture]:
        """Return the picture of an output over the first parameter that is a number."""
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
        x, rest = str(along[0]), [dim for dim in output.dims if dim != along[0]]
        flat = output.stack(others=rest) if rest else output.expand_dims("others")
        curves = []
        for k in range(min(flat.sizes["others"], MOST_CURVES)):
            one = flat.isel(others=k)
            places = ", ".join(f"{dim} {self._number(str(dim), one[dim].item())}" for dim in rest)
            curves.append(svg.Curve(output[x].values, one.values, places))
        low, high = float(output.min()), float(output.max())
        margin = (high - low) / 10
        # Of values that hardly change, 0 is not shown.
        ends = (low - margin, high + margin) if 0 < margin < low / 20 else None
        axes = (self._axis(x), self._axis(name)._replace(ends=ends))
        return [Picture(f"{name} over {x}.".replace("_", " "), svg.lines(curves, axes))]

    def _axis(self, name: str) -> svg.Axis:
        return svg.Axis(name.replace("_", " "), self._unit(name))

    def _warnings(self) -> list[str]:
        if "warnings" not in self.dataset:
            return []
        texts = np.ravel(self.dataset["warnings"].values).tolist()
        return list(dict.fromkeys(line for text in texts for line in text.splitlines()))


def save_report(
    dataset: xarray.Dataset,
    path: str | os.PathLike[str],
    *,
    case: str | None = None,
    inputs: Rows = (),
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
        return files.save(path, {".html": lambda file: write(file, [Study(dataset)], case, inputs)})
