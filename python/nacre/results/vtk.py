"""VTK files with rectilinear grids, for ParaView: the surface, and the stresses below it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.extras import extra
from nacre.results.quantities import VECTOR
from nacre.results.tables import Gridded, fields

Array = npt.NDArray[np.float64]

Values = npt.NDArray[Any] | tuple[npt.NDArray[Any], ...]
"""A scalar at all points, or the components of a vector."""
KINDS = {np.ndarray: "scalars", tuple: "vectors"}
COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "xz")
OPTIONS = ("body", "friction", "direction", "residual", "displacement", "threads")
"""Keywords of `Solution.stress` that `Solution.save` takes."""
TOLERANCE = 1e-12
"""Relative distance below which a depth lies on an interface, as in `Solution.stress`."""


class StressPlan(Protocol):
    """A plan of the stress in a body."""

    @property
    def body(self) -> core.HalfSpace:
        """Body."""

    @property
    def stress(self) -> Callable[..., Any]:
        """Function of depths and options that evaluates stresses."""


class Stressed(Protocol):
    """A solved contact whose stresses can be evaluated."""

    @property
    def x(self) -> Array:
        """Cell centres along x [m]."""

    @property
    def y(self) -> Array:
        """Cell centres along y [m]."""

    @property
    def pressure(self) -> Array:
        """Pressure [Pa]."""

    @property
    def stress_plan(self) -> Callable[..., StressPlan]:
        """Function of options that makes a plan of the stress."""


def write_surface(result: Gridded, path: Path) -> None:
    """Write the fields of a contact as the cells of a plane."""
    grid = result.grid
    edges = [
        c + side * (np.arange(cells + 1) / cells - 0.5)
        for c, side, cells in zip(grid.center, grid.size, grid.shape, strict=True)
    ]

    def cell_data(field: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
        plain = field.astype(np.int8) if field.dtype == bool else field
        return plain[..., np.newaxis]

    cells: dict[str, Values] = {}
    for row, values in fields(result).items():
        if row.dims == VECTOR:
            components = [cell_data(component) for component in values]
            cells[row.name] = (*components, np.zeros_like(components[0]))
        else:
            cells[row.name] = cell_data(values)
    _write(path, (*edges, np.zeros(1)), "Cell", cells)


def write_stress(
    solution: Stressed, path: Path, depths: npt.ArrayLike, options: Mapping[str, object]
) -> None:
    """Write stresses at points below the cell centres, and pressure and gap at the same x and y.

    A depth on an interface has two planes of points, above and below the interface.
    """
    if unknown := set(options) - set(OPTIONS):
        names = ", ".join(OPTIONS)
        raise TypeError(f"options must be among {names}, got {', '.join(sorted(unknown))}")
    depths = core.real_array("depths", depths)
    z, planes = _planes(solution, np.atleast_1d(depths), options)
    shape = (*solution.pressure.shape, z.size)
    points: dict[str, Values] = {
        name: np.broadcast_to(getattr(solution, name)[..., np.newaxis], shape)
        for name in ("pressure", "gap")
    }
    points |= {f"stress_{name}": planes[name] for name in COMPONENTS}
    points |= {name: planes[name] for name in ("von_mises", "max_shear", "tension")}
    if "ux" in planes:
        points["displacement"] = tuple(planes[name] for name in ("ux", "uy", "uz"))
    _write(path, (solution.x, solution.y, z), "Point", points)


def _write(path: Path, axes: tuple[Array, ...], place: str, fields: Mapping[str, Values]) -> None:
    """Write fields at the points of a rectilinear grid, or at its cells.

    The numbers are written here, at once: pyevtk packs them one by one.
    """
    with extra("files"):
        from pyevtk.vtk import VtkFile, VtkRectilinearGrid

    first = {
        kind: next((n for n, f in fields.items() if isinstance(f, kind)), None) for kind in KINDS
    }
    file = VtkFile(str(path.with_suffix("")), VtkRectilinearGrid)
    ends: Any = {"start": (0, 0, 0), "end": tuple(axis.size - 1 for axis in axes)}
    file.openGrid(**ends)
    file.openPiece(**ends)
    file.openElement("Coordinates")
    for letter, axis in zip("xyz", axes, strict=True):
        file.addData(f"{letter}_coordinates", axis)
    file.closeElement("Coordinates")
    file.openData(place, **{word: first[kind] for kind, word in KINDS.items()})
    for name, field in fields.items():
        file.addData(name, field)
    file.closeData(place)
    file.closePiece()
    file.closeGrid()
    for values in (*axes, *fields.values()):
        parts = [
            part.ravel(order="F") for part in (values if isinstance(values, tuple) else [values])
        ]
        file.appendHeader(parts[0].dtype.name, parts[0].size, len(parts))
        numbers = parts[0] if len(parts) == 1 else np.stack(parts, axis=-1)
        file.xml.stream.write(np.ascontiguousarray(numbers).data)
    file.save()


def _planes(
    solution: Stressed, depths: Array, options: Mapping[str, object]
) -> tuple[Array, dict[str, Array]]:
    """Return depths, those on an interface twice, and the fields on them: (nx, ny, nz)."""
    if depths.ndim != 1 or depths.size == 0 or (np.diff(depths) <= 0).any():
        raise ValueError(f"depths must be at least one, each above the last, got {depths.tolist()}")
    plan_options = {name: value for name, value in options.items() if name in ("body", "threads")}
    plan = solution.stress_plan(**plan_options)
    on = [np.isclose(depths, face, rtol=TOLERANCE, atol=0.0) for face in plan.body.interfaces]
    above = np.any(on, axis=0) if on else np.full(depths.shape, False)
    # Only an elastic base has a side below.
    elastic = isinstance(plan.body.substrate, core.Elastic)
    below = ~on[-1] if not elastic else np.full(depths.shape, True)
    stress_options = {name: value for name, value in options.items() if name not in plan_options}
    stresses = []
    if above.any():
        stresses.append(plan.stress(depths[above], side="above", **stress_options))
    if below.any():
        stresses.append(plan.stress(depths[below], side="below", **stress_options))
    z = np.concatenate([stress.z for stress in stresses])
    order = np.argsort(z, kind="stable")  # the side above comes first
    names = [*COMPONENTS, "von_mises", "max_shear"]
    names += ["ux", "uy", "uz"] if options.get("displacement") else []
    planes = {name: [getattr(stress, name) for stress in stresses] for name in names}
    planes["tension"] = [stress.principal[0] for stress in stresses]
    return z[order], {
        name: np.concatenate(fields)[order].transpose(1, 2, 0) for name, fields in planes.items()
    }
