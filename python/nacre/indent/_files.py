"""Files of indentations and of fits: NetCDF to come back to, and tables."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import nacre._core as core
from nacre._disk import STATE, replacing, write_dataset
from nacre._extras import extra
from nacre.units import INDENT_UNITS, PARAMETERS, symbol, system
from nacre.values import encode

if TYPE_CHECKING:
    import xarray

    from nacre.indent._result import Fit
    from nacre.indent.solution import IndentSolution

NAMES = {
    "load": "load, below 0 where the tip is pulled",
    "approach": "approach",
    "radius": "contact radius",
    "stiffness": "stiffness of this contact area",
    "outer_radius": "radius up to which the surfaces attract each other",
    "central_pressure": "pressure on the axis",
}
ARGUMENTS = ("body", "tip", "counterbody", "adhesion")
PULLED = ("pull_off_load", "pull_off_approach", "pull_off_radius")

UNITS = PARAMETERS | {
    "work": "N/m",
    "flat": "m",
    "strength": "Pa",
    "contact_point": "m",
    "drift": "m/s",
    "compliance": "m/N",
    "force_offset": "N",
    "force_slope": "N/m",
}
"""SI units of parameters by the last part of their names."""


def unit_of(name: str) -> str:
    """Return the SI unit of a parameter; "" where it has none."""
    return UNITS.get(name.rpartition(".")[2], "")


def indentation(solution: IndentSolution) -> xarray.Dataset:
    """Return the contacts with units and all that they depend on."""
    with extra("files"):
        import xarray

    arrays = {name: np.asarray(getattr(solution, name)) for name in NAMES}
    given, rank = solution.given, arrays[solution.given].ndim
    dims = (given,) if rank == 1 else tuple(f"{given}_{k}" for k in range(rank))
    dataset = xarray.Dataset({name: (dims, values) for name, values in arrays.items()})
    dataset = dataset.set_coords(given)
    for name, words in NAMES.items():
        dataset[name].attrs = {"units": symbol(INDENT_UNITS[name]), "long_name": words}
    dataset.attrs = _attributes("indentation of a coated body", solution)
    dataset.attrs |= {name: getattr(solution, name) for name in ("given", "branch", "control")}
    if solution.adhesion is not None:
        dataset.attrs |= {name: getattr(solution, name) for name in PULLED}
    dataset.attrs[STATE] = json.dumps(solution.to_dict())
    return dataset


def estimates(fit: Fit) -> xarray.Dataset:
    """Return the parameters of a fit, and its points, those of all curves one after another."""
    with extra("files"):
        import xarray

    names = list(fit.estimates)
    low, high = np.array([fit.intervals[name] for name in names]).T
    both = ("parameter", "other_parameter")
    columns: dict[str, Any] = {
        "estimate": ("parameter", list(fit.estimates.values())),
        "standard_error": ("parameter", [fit.standard_errors[name] for name in names]),
        "low": ("parameter", low),
        "high": ("parameter", high),
        "covariance": (both, fit.covariance),
        "correlation": (both, fit.correlation),
    }
    points = {
        "depth": ("m", "depth as measured", [curve.depth for curve in fit.curves]),
        "force": ("N", "force as measured", [curve.force for curve in fit.curves]),
        "load": ("N", "load of the model", fit.loads),
        "approach": ("m", "depth without nuisances", fit.approaches),
        "residual": ("N" if fit.noise == "absolute" else "1", "residual", fit.residuals),
    }
    columns |= {name: ("point", np.concatenate(parts)) for name, (_, _, parts) in points.items()}
    numbers = np.repeat(np.arange(len(fit.curves)), [len(curve) for curve in fit.curves])
    coords = {"parameter": names, "other_parameter": names, "curve": ("point", numbers)}
    dataset = xarray.Dataset(columns, coords | {"unit": ("parameter", _units(fit))})
    for name, (unit, words, _) in points.items():
        dataset[name].attrs = {"units": symbol(unit), "long_name": words}
    dataset["low"].attrs["long_name"] = "lower end of the interval of 95 %"
    dataset["high"].attrs["long_name"] = "upper end of the interval of 95 %"
    dataset.attrs = _attributes("fit of indentation curves", fit)
    dataset.attrs |= {
        name: getattr(fit, name) for name in ("chi2", "dof", "sigma", "noise", "floor")
    }
    dataset.attrs["warnings"] = "\n".join(fit.warnings)
    dataset.attrs["reasons"] = "\n".join(f"{name}: {text}" for name, text in fit.reasons.items())
    dataset.attrs[STATE] = json.dumps(fit.to_dict())
    return dataset


def _attributes(title: str, found: IndentSolution | Fit) -> dict[str, Any]:
    return {
        "title": title,
        "source": f"nacre {core.__version__}",
        "unit_system": system().name,
        **{name: json.dumps(encode(getattr(found, name))) for name in ARGUMENTS},
    }


def _units(fit: Fit) -> list[str]:
    return [symbol(unit_of(name)) for name in fit.estimates]


def save(
    found: IndentSolution | Fit, rows: Iterable[list[Any]], path: str | os.PathLike[str]
) -> Path:
    """Write a file, whole or not at all; its ending chooses the kind. Tables have these rows."""
    path = Path(path)
    if path.suffix.lower() not in (".nc", ".csv"):
        raise ValueError(f"path must end in .nc or .csv, got {str(path)!r}")
    with replacing(path) as temporary:
        if path.suffix.lower() == ".nc":
            write_dataset(found.to_xarray(), temporary)
            return path
        with temporary.open("w", newline="", encoding="utf-8") as file:
            file.write(f"# source: nacre {core.__version__}\n")
            csv.writer(file).writerows(rows)
    return path


def contact_rows(solution: IndentSolution) -> Iterator[list[Any]]:
    """Yield the rows of a table of contacts."""
    columns = [np.ravel(getattr(solution, name)).tolist() for name in NAMES]
    yield [f"{name} [{symbol(INDENT_UNITS[name])}]" for name in NAMES]
    yield from map(list, zip(*columns, strict=True))


def parameter_rows(fit: Fit) -> Iterator[list[Any]]:
    """Yield the rows of a table of parameters."""
    yield ["parameter", "unit", "estimate", "standard error", "low", "high", "not identifiable"]
    for name, unit in zip(fit.estimates, _units(fit), strict=True):
        numbers = [fit.estimates[name], fit.standard_errors[name], *fit.intervals[name]]
        yield [name, unit, *numbers, fit.reasons.get(name, "")]
