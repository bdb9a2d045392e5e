"""Solutions in files: NetCDF to come back to, VTK for ParaView, CSV for spreadsheets."""

from __future__ import annotations

import csv
import json
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._extras import extra
from nacre._vtk import write_stress, write_surface
from nacre.units import UNITS
from nacre.values import decode, encode

if TYPE_CHECKING:
    import xarray

AnyPath = str | os.PathLike[str]

FIGURES = (
    "load",
    "approach",
    "tilt",
    "eccentricity",
    "moment",
    "peak_pressure",
    "peak_position",
    "central_pressure",
    "contact_area",
    "contact_extent",
)
"""Key figures that files carry as attributes, in SI units."""

NAMES = {
    "pressure": "pressure",
    "gap": "gap; infinite where the shape cannot touch",
    "displacement": "normal displacement of both bodies together",
    "line_load": "force per length along x",
}
FIELDS = ("pressure", "gap", "displacement")
"""Fields of the state that files hold as variables."""
STATE = "nacre_solution"
"""Attribute that holds the rest of the state, as JSON."""


def to_xarray(solution: core.Solution) -> xarray.Dataset:
    """Return the fields with coordinates, units and the whole problem.

    Attributes hold the key figures, and bodies, motion and options as JSON. A repetition needs only
    the shape besides, whose gap is `gap - displacement + approach + tilt_x x + tilt_y y`.
    """
    with extra("files"):
        import xarray

    report = solution.report
    fields = {name: (("x", "y"), getattr(solution, name)) for name in FIELDS}
    dataset = xarray.Dataset(
        {**fields, "line_load": (("x",), solution.line_load)},
        coords={"x": solution.x, "y": solution.y},
    )
    for name, words in NAMES.items():
        dataset[name].attrs = {"units": UNITS[name], "long_name": words}
    for name in ("x", "y"):
        dataset[name].attrs = {"units": "m", "long_name": f"{name} of the cell centre"}
    dataset.attrs = {
        "title": "contact of coated bodies",
        "source": f"nacre {core.__version__}",
        **{name: np.ravel(getattr(solution, name)) for name in FIGURES},
        **{
            name: json.dumps(encode(getattr(report, name)))
            for name in ("body", "counterbody", "grid", "motion", "discretisation")
        },
        "method": report.method,
        "refinement": report.refinement,
        "tolerance": report.tolerance,
        "termination": report.termination,
        "solver": report.solver or "unknown",
        "residual": report.residual,
        "overlap": report.overlap,
        "balance": np.array(report.balance),
        "iterations": report.iterations,
        "warnings": "\n".join(report.warnings),
        STATE: json.dumps(_state(solution)),
    }
    for name in FIGURES:
        if dataset.attrs[name].size == 1:
            dataset.attrs[name] = float(dataset.attrs[name][0])
    return dataset


def save(
    solution: core.Solution,
    path: AnyPath,
    depths: npt.ArrayLike | None = None,
    options: Mapping[str, Any] | None = None,
) -> Path:
    """Write a file, whole or not at all; its ending chooses the kind."""
    path = Path(path)
    writers: dict[str, Callable[[core.Solution, Path], None]] = {
        ".nc": _write_netcdf,
        ".vtr": write_surface,
        ".csv": _write_csv,
    }
    if path.suffix not in writers:
        raise ValueError(f"path must end in {', '.join(writers)}, got {str(path)!r}")
    if depths is None and options:
        raise TypeError(f"{', '.join(sorted(options))}: without depths there are no such options")
    if depths is not None and path.suffix != ".vtr":
        raise ValueError(f"path must end in .vtr where depths are given, got {str(path)!r}")
    with replacing(path) as temporary:
        if depths is None:
            writers[path.suffix](solution, temporary)
        else:
            write_stress(solution, temporary, depths, options or {})
    return path


def load(path: AnyPath) -> core.Solution:
    """Solution from a NetCDF file that `Solution.save` wrote, bit for bit; needs ``nacre-contact[files]``.

    Parameters
    ----------
    path : str or os.PathLike
        File to read; older versions of nacre may have written it.

    Returns
    -------
    Solution
        Solution that was saved.

    Raises
    ------
    ValueError
        If the file holds no solution of nacre's, or a newer version wrote it.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     nacre.load(solution.save(f"{folder}/ball.nc")) == solution
    True
    """
    with extra("files"):
        import h5netcdf  # noqa: F401
        import xarray

    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{str(path)!r} is not a file")
    try:
        with xarray.open_dataset(path, engine="h5netcdf") as dataset:
            state = json.loads(dataset.attrs[STATE])
            fields = {name: dataset[name].to_numpy() for name in FIELDS}
    except (KeyError, OSError, ValueError) as error:
        raise ValueError(f"{str(path)!r} must be a solution that nacre saved") from error
    try:
        if "format" not in state:
            return _load_format0(state, fields)
        return core.Solution.from_dict(state | fields)
    except ValueError as error:
        raise ValueError(f"{str(path)!r}: {error}") from error


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
    dataset.to_netcdf(path, engine="h5netcdf", encoding=encoding)


def _state(solution: core.Solution) -> dict[str, Any]:
    """Return the named state of a solution without its fields."""
    return {name: value for name, value in solution.to_dict().items() if name not in FIELDS}


def _load_format0(state: dict[str, Any], fields: Mapping[str, Any]) -> core.Solution:
    """Return the solution of a file that was written before states had names."""
    from nacre import _format0

    report = _format0._restore_report(decode(state["report"]))
    motion = state["approach"], state["tilt"]
    return _format0._restore_solution(tuple(fields.values()), motion, report)


def _write_netcdf(solution: core.Solution, path: Path) -> None:
    write_dataset(to_xarray(solution), path)


def _write_csv(solution: core.Solution, path: Path) -> None:
    """Write the sections along x and along y through the largest pressure."""
    i, j = (
        int(np.argmin(np.abs(side - place)))
        for side, place in zip((solution.x, solution.y), solution.peak_position, strict=True)
    )
    names = FIELDS
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["along", "x [m]", "y [m]", *(f"{n} [{UNITS[n]}]" for n in names)])
        for along, rows in (
            ("x", [(k, j) for k in range(solution.x.size)]),
            ("y", [(i, k) for k in range(solution.y.size)]),
        ):
            for k, m in rows:
                values = (getattr(solution, name)[k, m].item() for name in names)
                writer.writerow([along, solution.x[k].item(), solution.y[m].item(), *values])
