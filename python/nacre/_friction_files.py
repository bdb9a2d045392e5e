"""Files of contacts with friction: NetCDF to come back to, VTK, CSV, pictures."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre import values
from nacre._extras import extra
from nacre._friction_display import numbers
from nacre.units import symbol

if TYPE_CHECKING:
    import xarray

    from nacre._friction_result import FrictionSolution
    from nacre.files import AnyPath

NORMAL = ("pressure", "gap", "displacement", "coefficients")
"""Arrays of the normal contact; the displacement is called normal_displacement in Datasets."""
VECTORS = ("traction", "displacement", "slip")
"""Fields with components along x and y."""


def to_xarray(solution: FrictionSolution) -> xarray.Dataset:
    """Return the fields with coordinates, units and the whole problem."""
    with extra("files"):
        import xarray
    from nacre._disk import STATE
    from nacre.units import system

    normal, report = solution.normal, solution.report
    rolls = solution.shift is None
    plane, vector = ("x", "y"), ("component", "x", "y")
    fields: dict[str, tuple[tuple[str, ...], Any, str, str]] = {
        "pressure": (plane, normal.pressure, symbol("Pa"), "pressure"),
        "gap": (plane, normal.gap, symbol("m"), "gap; infinite where the shape cannot touch"),
        "normal_displacement": (
            plane,
            normal.displacement,
            symbol("m"),
            "normal displacement of both bodies together",
        ),
        "traction": (vector, solution.traction, symbol("Pa"), "traction on the body"),
        "displacement": (
            vector,
            solution.displacement,
            symbol("m"),
            "tangential displacement of the body relative to the counterbody",
        ),
        "slip": (
            vector,
            solution.slip,
            "1" if rolls else symbol("m"),
            "slip velocity over the speed of rolling" if rolls else "slip in the step",
        ),
        "stick": (plane, solution.stick.astype(np.int8), "1", "whether a cell sticks"),
    }
    if normal.coefficients is not None:
        words = "influence coefficients that the contact was given"
        offsets = ("offset_x", "offset_y")
        fields["coefficients"] = (offsets, normal.coefficients, symbol("m/Pa"), words)
    if isinstance(solution.friction, np.ndarray):
        fields["friction"] = (plane, solution.friction, "1", "coefficient of friction")
    dataset = xarray.Dataset(
        {name: (dims, values) for name, (dims, values, _, _) in fields.items()},
        coords={"x": solution.x, "y": solution.y, "component": ["x", "y"]},
    )
    for name, (_, _, unit, words) in fields.items():
        dataset[name].attrs = {"units": unit, "long_name": words}
    for name in plane:
        dataset[name].attrs = {"units": symbol("m"), "long_name": f"{name} of the cell centre"}
    state = _state(solution)
    motion = ("shift", "twist") if not rolls else ("creepage", "spin", "direction")
    dataset.attrs = {
        "title": "contact of coated bodies with friction",
        "source": f"nacre {core.__version__}",
        "unit_system": system().name,
        "load": normal.load,
        "approach": normal.approach,
        "force": np.array(solution.force),
        "torque": solution.torque,
        "dissipated": solution.dissipated,
        **{name: getattr(solution, name) for name in motion},
        "termination": report.termination,
        "violation": report.violation,
        "imbalance": report.imbalance,
        "tolerance": report.tolerance,
        "warnings": "\n".join(normal.report.warnings),
        STATE: json.dumps(state),
    }
    if not isinstance(solution.friction, np.ndarray):
        dataset.attrs["friction"] = solution.friction
    return dataset


def _state(solution: FrictionSolution) -> dict[str, Any]:
    """Return the named state without what the Dataset holds as arrays."""
    state = solution.to_dict()
    arrays = {*VECTORS} | ({"friction"} if isinstance(solution.friction, np.ndarray) else set())
    normal = {name: value for name, value in state["normal"].items() if name not in NORMAL}
    return {name: value for name, value in state.items() if name not in arrays} | {"normal": normal}


def restored(
    state: Mapping[str, Any], arrays: Mapping[str, npt.NDArray[np.float64]]
) -> FrictionSolution:
    """Return the solution of a file: its state, and its arrays by their names there."""
    whole = {**state, **{name: arrays[name] for name in VECTORS if name in arrays}}
    places = {name: "normal_displacement" if name == "displacement" else name for name in NORMAL}
    found = {name: arrays[place] for name, place in places.items() if place in arrays}
    whole["normal"] = {**state["normal"], **found}
    if "friction" in arrays:
        whole["friction"] = arrays["friction"]
    solution: FrictionSolution = values.RESULTS["FrictionSolution"].from_dict(whole)
    return solution


def save(solution: FrictionSolution, path: AnyPath) -> Path:
    """Write a file, whole or not at all; its ending chooses the kind."""
    from nacre._disk import PICTURES, replacing, write_dataset

    path = Path(path)
    kinds = (".nc", ".vtr", ".csv", *PICTURES)
    ending = path.suffix.lower()
    if ending not in kinds:
        raise ValueError(f"path must end in {', '.join(kinds)}, got {str(path)!r}")
    with replacing(path) as temporary:
        if ending == ".nc":
            write_dataset(to_xarray(solution), temporary)
        elif ending == ".vtr":
            _write_vtk(solution, temporary)
        elif ending == ".csv":
            _write_cells(solution, temporary)
        else:
            _write_picture(solution, temporary)
    return path


def _write_cells(solution: FrictionSolution, path: Path) -> None:
    """Write every cell, after a block of comments with the main numbers."""
    slip = "slip {} [1]" if solution.shift is None else f"slip {{}} [{symbol('m')}]"
    heads = [
        *(f"{name} [{symbol('m')}]" for name in "xy"),
        f"pressure [{symbol('Pa')}]",
        *(f"traction {name} [{symbol('Pa')}]" for name in "xy"),
        *(slip.format(name) for name in "xy"),
        "stick",
    ]
    x, y = np.meshgrid(solution.x, solution.y, indexing="ij")
    fields = [x, y, solution.pressure, *solution.traction, *solution.slip]
    columns = [np.ravel(field).tolist() for field in fields]
    columns.append(np.ravel(solution.stick).astype(int).tolist())
    with path.open("w", newline="", encoding="utf-8") as file:
        file.write(f"# source: nacre {core.__version__}\n")
        file.writelines(f"# {name}: {value}\n" for name, value in numbers(solution))
        writer = csv.writer(file)
        writer.writerow(heads)
        writer.writerows(zip(*columns, strict=True))


def _write_vtk(solution: FrictionSolution, path: Path) -> None:
    """Write the fields as the cells of a plane, for ParaView."""
    with extra("files"):
        from pyevtk.hl import gridToVTK

    grid = solution.grid
    edges = [
        c + side * (np.arange(cells + 1) / cells - 0.5)
        for c, side, cells in zip(grid.center, grid.size, grid.shape, strict=True)
    ]
    cells: dict[str, Any] = {
        "pressure": np.asfortranarray(solution.pressure[..., np.newaxis]),
        "stick": np.asfortranarray(solution.stick.astype(np.int8)[..., np.newaxis]),
    }
    zero = np.zeros((*grid.shape, 1), order="F")
    for name in VECTORS:
        parts = [np.asfortranarray(part[..., np.newaxis]) for part in getattr(solution, name)]
        cells[name] = (*parts, zero)
    gridToVTK(str(path.with_suffix("")), *edges, np.zeros(1), cellData=cells)


def _write_picture(solution: FrictionSolution, path: Path) -> None:
    """Write the picture that `FrictionSolution.plot` draws."""
    axes: Any = solution.plot()
    try:
        axes.figure.savefig(path, dpi=300)
    finally:
        from matplotlib import pyplot

        pyplot.close(axes.figure)
