"""Datasets of studies: the parameters of each case, and the results of all."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.groups import keyword_units
from nacre._tools.units import SI, Within, symbol, system
from nacre.contact.solution import Solution
from nacre.contact.wear_march import KEYWORDS
from nacre.fatigue import assess
from nacre.fatigue.criteria import Criterion
from nacre.results import quantities
from nacre.results.journal import Record
from nacre.results.parameters import VALUES, quantity_of
from nacre.results.quantities import ERROR
from nacre.studies.outputs import (
    ESTIMATED_OF_RINGS,
    ESTIMATED_OF_WEAR,
    OF_CONTACTS,
    Output,
    axes,
    errors,
)

if TYPE_CHECKING:
    import xarray

Array = npt.NDArray[np.float64]


def layout(parameters: Mapping[str, object]) -> tuple[xarray.Dataset, list[dict[str, object]]]:
    """Return the coordinates of a study, and the parameters of each of its cases in order."""
    import xarray

    coordinates: dict[str, object] = {}
    values: dict[str, list[object]] = {}
    places: list[xarray.DataArray] = []
    for name, parameter in parameters.items():
        if isinstance(parameter, xarray.DataArray):
            flat = xarray.DataArray(parameter.data.ravel(), attrs=parameter.attrs)
            numbers = np.asarray(core.plain(name, flat))
            values[name] = [item.item() for item in numbers]
            dims, shape = parameter.dims, parameter.shape
            coordinates |= {str(key): coord for key, coord in parameter.coords.items()}
            coordinates[name] = (dims, numbers.reshape(shape))
        else:
            if isinstance(parameter, str) or not isinstance(parameter, Iterable):
                raise TypeError(f"{name} must be a sequence of values, got {parameter!r}")
            labels: list[object]
            if isinstance(parameter, Mapping):
                labels, values[name] = [str(label) for label in parameter], list(parameter.values())
            else:
                # A column of a table has this method.
                rows = parameter.to_numpy() if hasattr(parameter, "to_numpy") else parameter
                values[name] = [v.item() if isinstance(v, np.generic) else v for v in rows]
                labels = values[name]
                kinds = {type(v) for v in labels}
                if not (kinds <= {int, float} or kinds in ({bool}, {str})):
                    labels = [str(v) if isinstance(v, str) else repr(v) for v in labels]
            dims, shape = (name,), (len(labels),)
            coordinates[name] = ((name,), np.array(labels))
        if not values[name]:
            raise ValueError(f"{name} must have at least one value, got none")
        places.append(xarray.DataArray(np.arange(len(values[name])).reshape(shape), dims=dims))
    grids = xarray.broadcast(*places)
    ranks = [grid.values.ravel() for grid in grids]
    count = ranks[0].size if ranks else 1
    points = [
        {name: values[name][rank[k]] for name, rank in zip(values, ranks, strict=True)}
        for k in range(count)
    ]
    frame = (
        grids[0].copy(data=np.arange(count).reshape(grids[0].shape))
        if grids
        else xarray.DataArray(0)
    )
    dataset = frame.to_dataset(name="case").assign_coords(coordinates)
    return dataset, points


def _arguments(kinds: Mapping[str, bool]) -> dict[str, tuple[Any, ...]]:
    """Return what declares the units of arguments: of tables by name, and of the others at ""."""
    if kinds["indents"]:
        from nacre.indent.solution import solve

        return {"": (solve,)}
    if kinds["bears"]:
        from nacre.bearing.film import film_thickness
        from nacre.bearing.geometry import KNOWN
        from nacre.bearing.pair import Pair
        from nacre.bearing.solution import BearingSolution

        tables = {"film": (film_thickness,), "life": (BearingSolution.life,)}
        return {"": (Pair.solve, Pair, *KNOWN.values()), **tables}
    return {"": (Solution.stress_summary, assess, Criterion, *KEYWORDS)}


def _unit_of(path: str, arguments: Mapping[str, tuple[Any, ...]], line: bool) -> str:
    """Return the SI unit of the argument at a path; "" where it has none."""
    table = next((name for name in path.split(".")[:-1] if name in arguments), "")
    return (VALUES | keyword_units(*arguments[table], line=line)).get(quantity_of(path), "")


def assemble(
    coordinates: xarray.Dataset,
    records: Sequence[Record],
    outputs: Mapping[str, Output],
    named: bool,
) -> xarray.Dataset:
    """Return the Dataset of all cases, whose parameters are `named` arguments, or a function's.

    The Dataset of bearings is in SI, but for the numbers at keys of a case file.
    """
    if any(record.get("bears") for record in records) and system() is not SI:
        with Within(SI):
            dataset = assemble(coordinates, records, outputs, named)
        for name in [name for name in map(str, dataset.coords) if "." in name and not named]:
            if unit := dataset[name].attrs.get("units"):
                dataset[name].attrs["units"] = symbol(unit)
        return dataset
    dims, shape = coordinates["case"].dims, coordinates["case"].shape
    dataset = coordinates.drop_vars("case")
    kinds = {
        kind: any(record.get(kind) for record in records)
        for kind in ("line", "rolls", "indents", "bears", "wears")
    }
    units = quantities.units(**kinds)
    if any(record.get("counts") for record in records):  # cycles or passes
        units = {name: unit for name, unit in units.items() if name not in ("life", "distance")}
    units = units | next((record["units"] for record in records if "units" in record), {})
    axes_of_outputs = axes("bearing" if kinds["bears"] else "contact")
    for name, output in outputs.items():
        values = _values(records, name)
        extra_dims = tuple(f"{name}_{k}" for k in range(values.ndim - 1))
        if output in axes_of_outputs:
            dataset, extra_dims = dataset.assign_coords(axis=["x", "y"]), ("axis",)
            if values.ndim == 1:  # every case failed
                values = np.full((len(records), 2), np.nan)
        dataset[name] = ((*dims, *extra_dims), values.reshape((*shape, *values.shape[1:])))
        if isinstance(output, str) and output in units:
            # Results of bearings are in SI, whatever the units of the case.
            own = units[output] if kinds["bears"] else symbol(units[output])
            dataset[name].attrs["units"] = own
    names = {*outputs, *map(str, dataset.coords)}
    for name, quantity in errors(outputs, names, _estimated_outputs(kinds)).items():
        numbers = [r.get("values", {}).get(name, np.nan) for r in records]
        dataset[name] = (dims, np.array(numbers, dtype=np.float64).reshape(shape))
        cause = "length of the steps" if quantity == "life" else "size of the cells"
        words = f"error of {name.removesuffix(ERROR)} due to the {cause}, estimated"
        dataset[name].attrs = {"long_name": words}
        if quantity in units:
            dataset[name].attrs["units"] = symbol(units[quantity])
    texts_of = {
        "error": [r.get("error", "") for r in records],
        "warnings": ["\n".join(r.get("warnings", [])) for r in records],
        "verdict": [r.get("verdict", "") for r in records],
    }
    if not any(texts_of["verdict"]):  # no limits are given
        del texts_of["verdict"]
    for name, texts in texts_of.items():
        dataset[name] = (dims, np.array(texts, dtype=np.str_).reshape(shape))
    arguments = _arguments(kinds)
    for name in map(str, dataset.coords):
        # What the parameters of a function are is not known; those of bearings are in SI.
        is_known = named or kinds["bears"] or "." in name
        unit = _unit_of(name, arguments, line=kinds["line"])
        if is_known and unit:
            dataset[name].attrs["units"] = symbol(unit)
    dataset.attrs = {
        "title": "study of bearings" if kinds["bears"] else "study of coated contacts",
        "source": f"nacre {core.__version__}",
        "unit_system": "SI" if kinds["bears"] else system().name,
    }
    return dataset


def _values(records: Sequence[Record], name: str) -> Array:
    """Return an output of all cases, NaN where it has none."""
    arrays = [np.array(r["values"][name]) if "values" in r else None for r in records]
    shapes = [a.shape for a in arrays if a is not None]
    rank = max((len(s) for s in shapes), default=0)
    inner = tuple(max(s[k] if k < len(s) else 1 for s in shapes) for k in range(rank))
    # Arrays that are shorter than others end in NaN, like cases that failed.
    values = np.full((len(records), *inner), np.nan)
    for row, array in enumerate(arrays):
        if array is not None:
            place: tuple[int | slice, ...] = (row, *(slice(0, n) for n in array.shape))
            values[place] = array
    return values


def _estimated_outputs(kinds: Mapping[str, bool]) -> Sequence[str]:
    """Return the outputs of cases of a kind that have an estimated error."""
    if kinds["indents"]:
        return ()
    if kinds["wears"]:
        return ESTIMATED_OF_WEAR
    return ESTIMATED_OF_RINGS if kinds["bears"] else OF_CONTACTS


def failure_lines(records: Sequence[Record]) -> list[str]:
    """Return a line on the cases that failed and a line on the cases with warnings, by kind."""
    lines = []
    if failed := sum("error" in record for record in records):
        lines.append(f"{failed} of {len(records)} cases failed: see error in the Dataset")
    texts = [record["warnings"] for record in records if record.get("warnings")]
    if texts:
        kinds = Counter(
            kind
            for record in records
            if record.get("warnings")
            for kind in dict.fromkeys(record["kinds"])
        )
        kind_counts = ", ".join(f"{kind} ({count})" for kind, count in kinds.most_common())
        total = f"{len(texts)} of {len(records)} cases have warnings"
        lines.append(f"{total}: {kind_counts}; see warnings in the Dataset")
    return lines
