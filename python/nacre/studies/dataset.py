"""Datasets of studies: the parameters of each case, and the results of all."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

import nacre._core as core
from nacre._tools.groups import keyword_units
from nacre._tools.units import SI, Within, symbol, system
from nacre.contact.wear_solution import KEYWORDS
from nacre.results import quantities
from nacre.results.journal import Record
from nacre.results.parameters import parameter_unit, quantity_of
from nacre.results.quantities import ERROR
from nacre.studies.outputs import (
    ESTIMATED,
    ESTIMATED_OF_RINGS,
    ESTIMATED_OF_WEAR,
    OF_CONTACTS,
    Output,
    axes,
    errors,
)

if TYPE_CHECKING:
    import xarray


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


def assemble(
    coordinates: xarray.Dataset,
    records: Sequence[Record],
    outputs: Mapping[str, Output],
    named: bool,
) -> xarray.Dataset:
    """Return the Dataset of all cases, whose parameters are `named` arguments, or a function's.

    The Dataset of bearings is in SI.
    """
    if any(record.get("bears") for record in records) and system() is not SI:
        with Within(SI):
            return assemble(coordinates, records, outputs, named)
    dims, shape = coordinates["case"].dims, coordinates["case"].shape
    dataset = coordinates.drop_vars("case")
    kinds = {
        kind: any(record.get(kind) for record in records)
        for kind in ("line", "rolls", "indents", "bears", "wears")
    }
    units = quantities.units(**kinds)
    if any(record.get("counts") for record in records):  # cycles or passes
        units = {name: unit for name, unit in units.items() if name not in ("life", "distance")}
    axes_of_outputs = axes("bearing" if kinds["bears"] else "contact")
    for name, output in outputs.items():
        arrays = [np.array(r["values"][name]) if "values" in r else None for r in records]
        shapes = [a.shape for a in arrays if a is not None]
        rank = max((len(s) for s in shapes), default=0)
        inner = tuple(max(s[k] if k < len(s) else 1 for s in shapes) for k in range(rank))
        # Arrays that are shorter than others end in NaN, like cases that failed.
        columns = np.full((len(records), *inner), np.nan)
        for row, array in enumerate(arrays):
            if array is not None:
                place: tuple[int | slice, ...] = (row, *(slice(0, n) for n in array.shape))
                columns[place] = array
        extra_dims = (
            ("axis",) if output in axes_of_outputs else tuple(f"{name}_{k}" for k in range(rank))
        )
        if output in axes_of_outputs:
            dataset = dataset.assign_coords(axis=["x", "y"])
            if rank == 0:  # every case failed
                columns = np.full((len(records), 2), np.nan)
                inner = (2,)
        dataset[name] = ((*dims, *extra_dims), columns.reshape((*shape, *inner)))
        if isinstance(output, str) and output in units:
            # Results of bearings are in SI, whatever the units of the case.
            own = units[output] if kinds["bears"] else symbol(units[output])
            dataset[name].attrs["units"] = own
    names = {*outputs, *map(str, dataset.coords)}
    estimated: Sequence[str] = ESTIMATED_OF_RINGS if kinds["bears"] else ESTIMATED
    if kinds["indents"]:
        estimated = ()
    elif kinds["wears"]:
        estimated = ESTIMATED_OF_WEAR
    elif not kinds["bears"]:
        estimated = OF_CONTACTS
    for name, quantity in errors(outputs, names, estimated).items():
        numbers = [r.get("values", {}).get(name, np.nan) for r in records]
        dataset[name] = (dims, np.array(numbers, dtype=np.float64).reshape(shape))
        cause = "length of the steps" if kinds["wears"] else "size of the cells"
        words = f"error of {name.removesuffix(ERROR)} due to the {cause}, estimated"
        dataset[name].attrs = {"long_name": words}
        if quantity in units:
            dataset[name].attrs["units"] = symbol(units[quantity])
    for name, texts in {
        "error": [r.get("error", "") for r in records],
        "warnings": ["\n".join(r.get("warnings", [])) for r in records],
    }.items():
        dataset[name] = (dims, np.array(texts, dtype=np.str_).reshape(shape))
    is_contact = not (kinds["indents"] or kinds["bears"])
    declared = keyword_units(*KEYWORDS, line=kinds["line"]) if is_contact else {}
    for name in map(str, dataset.coords):
        # What the parameters of a function are is not known; those of bearings are in SI.
        is_known = named or kinds["bears"] or "." in name
        unit = declared.get(quantity_of(name), parameter_unit(name, units))
        if is_known and unit:
            dataset[name].attrs["units"] = symbol(unit)
    dataset.attrs = {
        "title": "study of bearings" if kinds["bears"] else "study of coated contacts",
        "source": f"nacre {core.__version__}",
        "unit_system": "SI" if kinds["bears"] else system().name,
    }
    return dataset


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
