"""Solutions in files: NetCDF to come back to, VTK for ParaView, CSV for spreadsheets, pictures."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._disk import PICTURES, STATE, read, replacing, write_dataset
from nacre._extras import extra
from nacre._tables import FIELDS, GIVEN, YIELDED, write_cells, write_sections
from nacre._typing import Pair, Topography
from nacre._vtk import write_stress, write_surface
from nacre.units import UNITS, symbol, system
from nacre.values import RESULTS, check_format, encode, refusing

if TYPE_CHECKING:
    import xarray

    from nacre._friction_result import FrictionSolution
    from nacre.indent._result import Fit
    from nacre.indent.solution import IndentSolution
    from nacre.solution import Solution

AnyPath = str | os.PathLike[str]
Array = npt.NDArray[np.float64]


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
"""Main numbers that files carry as attributes, in the units of the computation."""

NAMES = {
    "pressure": "pressure",
    "gap": "gap; infinite where the shape cannot touch",
    "displacement": "normal displacement of both bodies together",
    "indentation": "permanent indentation",
    "hardness": "largest pressure that the surfaces bear",
    "line_load": "force per length along x",
    "coefficients": "influence coefficients that the contact was given",
}
OFFSETS = {"coefficients": ("offset_x", "offset_y")}
"""Dimensions of arrays whose elements are no cells."""
FRICTION = ("traction", "slip", "normal_displacement", "friction")
"""Further variables of contacts with friction."""


def to_xarray(solution: Solution) -> xarray.Dataset:
    """Return the fields with coordinates, units and the whole problem.

    Attributes hold main numbers, bodies, motion and options as JSON. A repetition needs only
    the shape besides, whose gap is `gap - displacement + approach + tilt_x x + tilt_y y`.
    """
    with extra("files"):
        import xarray

    report = solution.report
    state, arrays = _split(solution)
    fields = {name: (OFFSETS.get(name, ("x", "y")), values) for name, values in arrays.items()}
    dataset = xarray.Dataset(
        {**fields, "line_load": (("x",), solution.line_load)},
        coords={"x": solution.x, "y": solution.y},
    )
    for name, words in NAMES.items():
        if name not in dataset:
            continue
        dataset[name].attrs = {"units": symbol(UNITS[name]), "long_name": words}
    for name in ("x", "y"):
        dataset[name].attrs = {"units": symbol("m"), "long_name": f"{name} of the cell centre"}
    dataset.attrs = {
        "title": "contact of coated bodies",
        "source": f"nacre {core.__version__}",
        "unit_system": system().name,
        **{name: np.ravel(getattr(solution, name)) for name in FIGURES},
        **{
            name: json.dumps(encode(getattr(report, name)))
            for name in ("body", "counterbody", "grid", "motion", "discretisation")
        },
        "tolerance": report.tolerance,
        "termination": report.termination,
        "solver": report.solver or "unknown",
        "residual": report.residual,
        "overlap": report.overlap,
        "balance": np.array(report.balance),
        "iterations": report.iterations,
        "warnings": "\n".join(report.warnings),
        STATE: json.dumps(state),
    }
    for name in FIGURES:
        if dataset.attrs[name].size == 1:
            dataset.attrs[name] = float(dataset.attrs[name][0])
    return dataset


def save(
    solution: Solution,
    path: AnyPath,
    depths: npt.ArrayLike | None = None,
    whole: bool = False,
    options: Mapping[str, Any] | None = None,
) -> Path:
    """Write a file, whole or not at all; its ending chooses the kind."""
    path = Path(path)
    writers: dict[str, Callable[[Solution, Path], None]] = {
        ".nc": _write_netcdf,
        ".vtr": write_surface,
        ".csv": write_cells if whole else write_sections,
        **dict.fromkeys(PICTURES, _write_picture),
    }
    ending = path.suffix.lower()
    if ending not in writers:
        raise ValueError(f"path must end in {', '.join(writers)}, got {str(path)!r}")
    if depths is None and options:
        raise TypeError(f"{', '.join(sorted(options))}: without depths there are no such options")
    if depths is not None and ending != ".vtr":
        raise ValueError(f"path must end in .vtr where depths are given, got {str(path)!r}")
    if whole and ending != ".csv":
        raise ValueError(f"path must end in .csv where whole is given, got {str(path)!r}")
    with replacing(path) as temporary:
        if depths is None:
            writers[ending](solution, temporary)
        else:
            write_stress(solution, temporary, depths, options or {})
    return path


def load(path: AnyPath) -> Any:
    """Solution or fit from a file that its `save` wrote, to the bit.

    Needs ``nacre-contact[files]``. A file ends in a checksum of all before, which other readers of
    NetCDF ignore. It is compared before anything else is read, since HDF5 may hang on a damaged
    file. A file that another program changed or saved again has none, and is refused. The checksum
    finds damage; it is no signature.

    Parameters
    ----------
    path : str or os.PathLike
        File to read.

    Returns
    -------
    Solution, FrictionSolution, nacre.indent.IndentSolution or nacre.indent.Fit
        Result that was saved.

    Raises
    ------
    ValueError
        If the file holds no result of nacre's, was changed, damaged or saved again by another
        program, or has a format that this version does not know.
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
        import h5py  # noqa: F401

    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{str(path)!r} is not a file")
    try:
        return _solution(*read(path, (*FIELDS, *YIELDED, *GIVEN, *FRICTION)))
    except ValueError as error:
        raise ValueError(f"{str(path)!r} must be a solution that nacre saved: {error}") from error


def read_map(
    path: AnyPath | Topography,
    *,
    spacing: float | Pair | None = None,
    unit: str | None = None,
    detrend: Literal["none", "mean", "plane", "quadratic"] = "plane",
    channel: str | int | None = None,
    transpose: bool = False,
    periodic: tuple[bool, bool] = (False, False),
) -> core.HeightMap:
    """Read a measured surface from a file, or take one from SurfaceTopography.

    Files of instruments are read by SurfaceTopography, with ``nacre-contact[surfaces]``. Missing
    points are filled smoothly from their surroundings; a `nacre.NacreWarning` tells how many there
    were.

    Parameters
    ----------
    path : str, os.PathLike or topography
        A file ``.npy`` holds a matrix of heights ``(nx, ny)``. A table in text, whatever its
        ending, holds points of a grid, with columns x, y and z in any order, or a matrix of
        heights, with one line for each x in a ``.csv`` and one for each y in any other and below
        the head of an instrument. Heads, headings, units such as ``# unit: um`` and
        ``# spacing: 0.5 0.5``, decimal commas, and numbers that stand for missing points are
        recognised; a profile is refused. SurfaceTopography reads any other file. A topography is
        an object of that library.
    spacing : float or tuple of float, optional
        Distances between samples ``(dx, dy)`` [m]; needed where the file does not give them.
    unit : str, optional
        Unit of the numbers in the file ("nm", "um", "mm", ...). By default the unit that the file
        names. Where it names none, numbers in ``.npy`` and ``.csv`` are metres, unless the heights
        would span more than ten times the map; anything else needs a unit.
    detrend : {"plane", "none", "mean", "quadratic"}, optional
        Surface that is subtracted: the plane, the mean or the paraboloid that fits best.
    channel : str or int, optional
        Channel of the instrument, or table of the text, that is read: its name or its number.
    transpose : bool, optional
        Whether to swap x and y of the file. Instruments export a ``.csv`` as an image, with one
        line for each y: that needs ``transpose=True``. The first line then has the smallest y. A
        `spacing` that is given is not swapped.
    periodic : tuple of bool, optional
        Whether the surface repeats along x and along y.

    Returns
    -------
    HeightMap
        The surface.

    Raises
    ------
    ValueError
        If the file cannot be understood, its unit or spacing is not known, or less than half of it
        was measured.
    TypeError
        If an argument is of the wrong kind.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     np.save(f"{folder}/flat.npy", np.zeros((4, 3)))
    ...     nacre.HeightMap.read(f"{folder}/flat.npy", spacing=1e-6, unit="nm").heights.shape
    (4, 3)
    """
    from nacre import surfaces

    return surfaces.read(
        path,
        spacing=spacing,
        unit=unit,
        detrend=detrend,
        channel=channel,
        transpose=transpose,
        periodic=periodic,
    )


def _split(solution: Solution) -> tuple[dict[str, Any], dict[str, Array]]:
    """Return the named state of a solution without its fields, and the fields."""
    state = solution.to_dict()
    names = [
        name for name in (*FIELDS, *YIELDED, *GIVEN) if isinstance(state.get(name), np.ndarray)
    ]
    fields = {name: state.pop(name) for name in names}
    return state, fields


def _solution(
    text: str, arrays: Mapping[str, Array]
) -> Solution | FrictionSolution | IndentSolution | Fit:
    try:
        state = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"the attribute {STATE} must hold JSON: {error}") from error
    if not isinstance(state, dict):
        raise ValueError(f"the attribute {STATE} must hold named fields, got {text!r:.60}")
    check_format(state.get("format"), state.get("nacre"), "it")
    if state.get("kind") == "FrictionSolution":
        from nacre._friction_files import restored

        with refusing("FrictionSolution"):
            return restored(state, arrays)
    if state.get("kind") in ("IndentSolution", "Fit"):
        from nacre.indent._result import Fit
        from nacre.indent.solution import IndentSolution

        return (Fit if state["kind"] == "Fit" else IndentSolution).from_dict(state)
    solution: Solution = RESULTS["Solution"].from_dict(state | dict(arrays))
    return solution


def _write_netcdf(solution: Solution, path: Path) -> None:
    write_dataset(to_xarray(solution), path)


def _write_picture(solution: Solution, path: Path) -> None:
    """Write the picture that `Solution.plot` draws."""
    axes: Any = next(iter(solution.plot().values()))
    try:
        axes.figure.savefig(path, dpi=300)
    finally:
        from matplotlib import pyplot

        pyplot.close(axes.figure)
