"""Results in files: NetCDF to come back to, VTK for ParaView, CSV for spreadsheets, pictures."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from nacre._tools.disk import PICTURES, STATE, read, replacing, write_dataset
from nacre._tools.extras import extra
from nacre._tools.typing import AnyPath
from nacre._tools.units import symbol, system
from nacre.results.display import figure_of
from nacre.results.journal import Journal
from nacre.results.quantities import REMOVED, Quantity
from nacre.results.tables import SOURCE, Gridded, numbers, write_cells, write_rows
from nacre.results.values import check_format, refusing, result_class
from nacre.results.vtk import write_surface

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Array = npt.NDArray[np.float64]


class HasDataset(Protocol):
    """A result with a Dataset."""

    def to_xarray(self) -> xarray.Dataset:
        """Return the Dataset."""


def dataset(
    title: str,
    table: Iterable[tuple[Quantity, str]],
    variables: Mapping[str, object],
    coordinates: Mapping[str, object],
    state: Mapping[str, object],
    **attributes: object,
) -> xarray.Dataset:
    """Return a Dataset of variables with units and words, and all else as attributes."""
    with extra("files"):
        import xarray

    fields = xarray.Dataset(variables, coordinates)
    for row, unit in table:
        if row.name in fields.variables:
            fields[row.name].attrs = {"units": symbol(unit) or "1", "long_name": row.words}
    fields.attrs = {
        "title": title,
        "source": SOURCE,
        "unit_system": system().name,
        **attributes,
        STATE: json.dumps(state),
    }
    return fields


def gridded(result: Gridded) -> xarray.Dataset:
    """Return the fields of a contact with coordinates and units, and the whole problem.

    Attributes hold main numbers, bodies, motion and options, as JSON where they are no numbers.
    """
    table, state = result._QUANTITIES, result.to_dict()
    arrays = take_arrays(state, table)
    variables: dict[str, tuple[tuple[str, ...], npt.NDArray[np.generic]]] = {}
    for row in table:
        if row.name in arrays or row.follows:
            values = np.asarray(arrays.get(row.name, row.of(result)))
            plain = values.astype(np.int8) if values.dtype == bool else values
            variables[row.name] = row.dims, plain
    coordinates: dict[str, object] = {"x": result.x, "y": result.y}
    if any("component" in dims for dims, _ in variables.values()):
        coordinates["component"] = ["x", "y"]
    numbers_by_name = {
        row.name: tuple(np.ravel(value).tolist()) if row.dims else value
        for row, value in numbers(result)
    }
    units = ((row, result._si(row)) for row in table)
    attributes = numbers_by_name | result._attributes()
    return dataset(result._TITLE, units, variables, coordinates, state, **attributes)


def take_arrays(state: dict[str, object], table: Iterable[Quantity]) -> dict[str, Array]:
    """Take the arrays out of a state, and return them by the names of their quantities."""
    arrays = {}
    for row in table:
        if isinstance(values := row.within(state), np.ndarray):
            arrays[row.name] = values
            row.put(state, REMOVED)
    return arrays


def save(path: AnyPath, writers: Mapping[str, Callable[[Path], object]]) -> Path:
    """Write a file, whole or not at all; its ending chooses the writer."""
    path = Path(path)
    ending = path.suffix.lower()
    if ending not in writers:
        endings = (" or " if len(writers) == 2 else ", ").join(writers)
        raise ValueError(f"path must end in {endings}, got {str(path)!r}")
    with replacing(path) as temporary:
        writers[ending](temporary)
    return path


def writers(result: Gridded, draw: Callable[[], Axes]) -> dict[str, Callable[[Path], object]]:
    """Return the writers of a contact by their endings; `draw` returns the axes of its picture."""
    return {
        ".nc": lambda path: write_dataset(gridded(result), path),
        ".vtr": lambda path: write_surface(result, path),
        ".csv": lambda path: write_cells(result, path),
        **pictures(draw),
    }


def tabular(
    result: HasDataset, rows: Iterable[Iterable[object]], **comments: object
) -> dict[str, Callable[[Path], object]]:
    """Return the writers of a result whose tables have these rows, by their endings."""
    return {
        ".nc": lambda path: write_dataset(result.to_xarray(), path),
        ".csv": lambda path: write_rows(path, rows, source=SOURCE, **comments),
    }


def first_axes(axes: Axes | Mapping[str, Axes]) -> Axes:
    """Return axes, the first of several."""
    return next(iter(axes.values())) if isinstance(axes, Mapping) else axes


def pictures(draw: Callable[[], Axes]) -> dict[str, Callable[[Path], object]]:
    """Return the writers of a picture by their endings; `draw` returns its axes."""

    def write(path: Path) -> None:
        axes = draw()
        try:
            fast: Any = {"pil_kwargs": {"compress_level": 2}} if path.suffix == ".png" else {}
            figure_of(axes).savefig(path, dpi=300, **fast)
        finally:
            from matplotlib import pyplot

            pyplot.close(figure_of(axes))

    return dict.fromkeys(PICTURES, write)


def load(path: AnyPath) -> Any:
    """Load a result from a file that its `save` wrote, to the bit.

    Needs ``nacre-contact[files]``. A file ends in a checksum of all before, which other readers of
    NetCDF ignore. It is compared before anything else is read, since HDF5 may hang on a damaged
    file. A file that another program changed or saved again has none, and is refused. The checksum
    finds damage; it is no signature.

    Parameters
    ----------
    path : str or os.PathLike
        File to read; also the ``.journal`` beside the store of a history of wear, which has all
        states up to a kill.

    Returns
    -------
    object
        Result of the class that was saved, a `Solution`, a `History` or another with a method
        `save`.

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
        if path.suffix.lower() == ".journal":
            return result_class("WearHistory")._kept(Journal.stored(path, "history of wear"))
        return _restored(*read(path, _arrays()))
    except ValueError as error:
        raise ValueError(f"{str(path)!r} must be a result that nacre saved: {error}") from error


def _arrays() -> list[str]:
    """Return the names of what files hold as arrays."""
    kinds = map(result_class, ("Solution", "FrictionSolution", "Conductance"))
    rows = [row for kind in kinds for row in kind._QUANTITIES if not row.follows]
    return ["packed", *(row.name for row in rows if len(row.dims) > 1 and row.dims[0] != "axis")]


def _restored(text: str, arrays: Mapping[str, Array]) -> object:
    """Return the result with this state, in which the arrays take their places."""
    try:
        state = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"the attribute {STATE} must hold JSON: {error}") from error
    if not isinstance(state, dict):
        raise ValueError(f"the attribute {STATE} must hold named fields, got {text!r:.60}")
    check_format(state.get("format"), state.get("nacre"), "it")
    kind = result_class(state.get("kind", "Solution"))
    with refusing(kind.__name__):
        if "packed" in arrays and hasattr(kind, "_unpacked"):
            return kind.from_dict(kind._unpacked(state, arrays))
        several = isinstance(state.get("steps"), list) and bool(state["steps"])
        for row in (row for row in kind._QUANTITIES if row.dims):  # numbers are no arrays
            if row.name in arrays and several:
                for step, values in zip(state["steps"], arrays[row.name], strict=True):
                    row.put(step, values)
            elif row.name in arrays:
                row.put(state, arrays[row.name])
    return kind.from_dict(state)
