"""Files of indentations and of fits: NetCDF to come back to, and tables."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from nacre._tools.units import symbol
from nacre.results.files import dataset
from nacre.results.quantities import Quantity
from nacre.results.values import encode

if TYPE_CHECKING:
    import xarray

    from nacre.indent._result import Fit
    from nacre.indent.solution import IndentSolution

ARGUMENTS = ("body", "tip", "counterbody", "adhesion")
MEASURED = Quantity("depth", "depth as measured", "m"), Quantity("force", "force as measured", "N")
"""Numbers at the points of a curve."""


def _each(solution: IndentSolution) -> list[Quantity]:
    """Return the numbers of each contact."""
    return [row for row in solution._QUANTITIES if not row.name.startswith("pull_off")]


def indentation(solution: IndentSolution) -> xarray.Dataset:
    """Return the contacts with units and all that they depend on."""
    arrays = {row.name: np.asarray(row.of(solution)) for row in _each(solution)}
    variable, rank = solution.given, arrays[solution.given].ndim
    dims = (variable,) if rank == 1 else tuple(f"{variable}_{k}" for k in range(rank))
    variables = {name: (dims, values) for name, values in arrays.items()}
    return dataset(
        "indentation of a coated body",
        ((row, row.unit) for row in solution._QUANTITIES),
        variables,
        {variable: variables.pop(variable)},
        solution.to_dict(),
        **_arguments(solution),
        **{name: getattr(solution, name) for name in ("given", "branch", "control")},
        **({} if solution.adhesion is None else solution._pulled),
    )


def estimates(fit: Fit) -> xarray.Dataset:
    """Return the parameters of a fit, and its points, those of all curves one after another."""
    names, whole = list(fit.estimates), fit.uncertainty
    low, high = np.array([fit.intervals[name] for name in names]).T
    both = ("parameter", "other_parameter")
    columns: dict[str, object] = {
        "estimate": ("parameter", list(fit.estimates.values())),
        "standard_error": ("parameter", [fit.standard_errors[name] for name in names]),
        "uncertainty": ("parameter", [whole.get(name, np.nan) for name in names]),
        "low": ("parameter", low),
        "high": ("parameter", high),
        "covariance": (both, fit.covariance),
        "correlation": (both, fit.correlation),
    }
    points = {
        "depth": [curve.depth for curve in fit.curves],
        "force": [curve.force for curve in fit.curves],
        "load": fit.loads,
        "approach": fit.approaches,
        "residual": fit.residuals,
    }
    columns |= {name: ("point", np.concatenate(arrays)) for name, arrays in points.items()}
    numbers = np.repeat(np.arange(len(fit.curves)), [len(curve) for curve in fit.curves])
    coords = {"parameter": names, "other_parameter": names, "curve": ("point", numbers)}
    noise = {"residual": "N" if fit.noise == "absolute" else ""}
    fields = dataset(
        "fit of indentation curves",
        ((row, noise.get(row.name, row.unit)) for row in (*MEASURED, *fit._QUANTITIES)),
        columns,
        coords | {"unit": ("parameter", _units(fit))},
        fit.to_dict(),
        **_arguments(fit),
        **{name: getattr(fit, name) for name in ("chi2", "dof", "sigma", "noise", "floor")},
        **fit._comments(),
        warnings="\n".join(fit.warnings),
        reasons="\n".join(f"{name}: {text}" for name, text in fit.reasons.items()),
    )
    fields["uncertainty"].attrs["long_name"] = "standard error with those of what is held"
    fields["low"].attrs["long_name"] = "lower end of the interval of 95 %"
    fields["high"].attrs["long_name"] = "upper end of the interval of 95 %"
    return fields


def _arguments(source: IndentSolution | Fit) -> dict[str, str]:
    return {name: json.dumps(encode(getattr(source, name))) for name in ARGUMENTS}


def _units(fit: Fit) -> list[str]:
    return [symbol(unit) for unit in fit._parameter_units]


def contact_rows(solution: IndentSolution) -> Iterator[list[object]]:
    """Yield the rows of a table of contacts."""
    contacts = _each(solution)
    columns = [np.ravel(row.of(solution)).tolist() for row in contacts]
    yield [f"{row.name} [{symbol(row.unit)}]" for row in contacts]
    yield from map(list, zip(*columns, strict=True))


def parameter_rows(fit: Fit) -> Iterator[list[object]]:
    """Yield the rows of a table of parameters."""
    errors, whole = ["standard error", "low", "high", "uncertainty"], fit.uncertainty
    yield ["parameter", "unit", "estimate", *errors, "not identifiable"]
    for name, unit in zip(fit.estimates, _units(fit), strict=True):
        numbers = [fit.estimates[name], fit.standard_errors[name], *fit.intervals[name]]
        yield [name, unit, *numbers, whole.get(name, ""), fit.reasons.get(name, "")]
