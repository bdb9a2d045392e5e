"""Heat or current through a joint of rough surfaces: `nacre.design.joint_conductance`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.notices import heard
from nacre._tools.progress import lasting
from nacre._tools.typing import AnyPath, Body, Field, Matrix
from nacre._tools.units import rounded
from nacre.contact import Contact
from nacre.contact.conductance import Conductivities, Kind, conductivities_of
from nacre.fatigue.summary import numbers, read_fields, word
from nacre.hertz import contact_modulus
from nacre.results import display, files
from nacre.results.charts import Axis, Chart, Curve
from nacre.results.quantities import Quantity, frozen, quantity
from nacre.results.report import Table
from nacre.results.shown import Printed, TableResult
from nacre.results.tables import SOURCE, heading, write_rows
from nacre.rough import corrected_area, map_grid, spectral_slope

if TYPE_CHECKING:
    from matplotlib.axes import Axes

UNITS = {"thermal": "W/K/m²", "electrical": "S/m²"}
FACTOR, EXPONENT = 1.55, 0.94
"""Numbers of Mikic's correlation (1974); some programs have 1.54. They are those of spots with half
the area in which Gaussian heights overlap, within 6 % for x from 5e-7 to 0.01."""


@frozen(eq=False)
class JointConductance(TableResult):
    """Conductance per area of a joint over its mean pressure, from `joint_conductance`."""

    _TITLE = "conductance of a joint"

    pressure: Field = quantity("Pa", dims=("pressure",))
    """Mean pressure [Pa]."""
    conductance: Field = quantity("W/K/m²", dims=("pressure",))
    """Conductance per area [W/K/m², S/m²]: the mean of several surfaces."""
    uncertainty: Field = quantity("W/K/m²", dims=("pressure",))
    """Estimated error of the conductance by the size of the cells [W/K/m², S/m²]."""
    deviation: Field | None = quantity("W/K/m²", dims=("pressure",))
    """Standard deviation of the mean of surfaces [W/K/m², S/m²]; None for one surface."""
    share: Field = quantity(dims=("pressure",))
    """Share of the area in contact: as `nacre.rough.corrected_area` has it."""
    mikic: Field | None = quantity("W/K/m²", dims=("pressure",))
    """Conductance per area by Mikic's elastic correlation [W/K/m², S/m²], without a film.

    It is h = 1.55 k (m/σ) x^0.94 of x = √2 p/(E* m), with k = 2 k₁k₂/(k₁ + k₂), the rms height σ
    and the mean slope m of profiles, the rms slope over √π as for Gaussian heights that are alike
    in all directions. None unless the surfaces are maps and the bodies have no layers.
    """
    conducted: Kind
    """What is conducted: "thermal" or "electrical"."""
    surfaces: int
    """Number of surfaces."""
    notes: tuple[str, ...]
    """What limits the validity: warnings of the contacts, the first of each kind."""

    def _state(self) -> dict[str, object]:
        return {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in super()._state().items()
        }

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        def column(values: Iterable[float] | None) -> Field | None:
            return None if values is None else numbers(values)

        readers: dict[str, Any] = dict.fromkeys((row.name for row in cls._QUANTITIES), column)
        readers |= {"conducted": word, "surfaces": int, "notes": lambda t: tuple(map(word, t))}
        return cls(**read_fields(cls.__name__, state, **readers))

    def __eq__(self, other: object) -> bool:
        """Return whether all fields are equal."""
        return isinstance(other, JointConductance) and self._state() == other._state()

    def __repr__(self) -> str:
        """Return how many pressures and surfaces there are."""
        return f"<JointConductance: pressures {self.pressure.size}, surfaces {self.surfaces}>"

    def _si(self, row: Quantity) -> str:
        return UNITS[self.conducted] if row.unit == UNITS["thermal"] else row.si()

    def _table(self) -> Printed:
        def column(head: str, values: Field, unit: str) -> tuple[str, list[str]]:
            return display.column(head, values.tolist(), unit)

        def shares(head: str, values: Field) -> tuple[str, list[str]]:
            return head, [f"{rounded(100 * value, 2)} %" for value in values.tolist()]

        unit, value = UNITS[self.conducted], self.conductance
        columns = [column("mean pressure", self.pressure, "Pa"), column("conductance", value, unit)]
        columns.append(shares("±", self.uncertainty / value))
        if self.deviation is not None:
            columns.append(shares(f"± of {self.surfaces} surfaces", self.deviation / value))
        columns.append(shares("in contact", self.share))
        if self.mikic is not None:
            changes = (self.mikic / value - 1).tolist()
            columns.append(("Mikic", [f"{100 * change:+.2g} %" for change in changes]))
        heads, texts = zip(*columns, strict=True)
        return Printed(heads, [*zip(*texts, strict=True)], (), ">")

    def _tables(self) -> Sequence[Table]:
        printed = self._table()
        return [Table("Conductance", printed.head, printed.rows)]

    def _charts(self) -> list[Chart]:
        curves = [Curve(self.pressure, self.conductance, "computed", "marked")]
        if self.mikic is not None:
            curves.append(Curve(self.pressure, self.mikic, "Mikic", "thin"))
        unit = UNITS[self.conducted]
        axes = Axis("mean pressure", "Pa", scale="log"), Axis("conductance", unit, scale="log")
        return [Chart("Conductance per area over the mean pressure.", curves, axes)]

    def _file_rows(self) -> list[tuple[object, ...]]:
        columns = (row.of(self).tolist() for row in self._known)
        return [tuple(heading(row, self) for row in self._known), *zip(*columns, strict=True)]

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw the conductance over the mean pressure, with Mikic's correlation as a thin line.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Axes to draw on; new ones by default.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.
        """
        from nacre.plot.drawer import draw

        return draw(self._charts()[0], axes, (0.6, 0.45))

    def save_table(self, path: AnyPath, *, program: Literal["calculix", "moose"]) -> Path:
        """Write the conductance over the pressure as a program of finite elements reads it.

        Both interpolate linearly and keep the first and the last value beyond the pressures, so a
        first row says that nothing is conducted without pressure. Numbers are in the units that
        are set.

        Parameters
        ----------
        path : str or os.PathLike
            File to write: ``.inp`` for CalculiX, ``.csv`` for MOOSE.
        program : {"calculix", "moose"}
            "calculix": the card ``*GAP CONDUCTANCE`` to include after ``*SURFACE BEHAVIOR``, with
            conductance, pressure and temperature in each line, as ``gapconductances.f`` of CalculiX
            reads them. "moose": the ``data_file`` of a ``PiecewiseLinear`` with
            ``format = columns``, of pressure and conductance. ``GapConductance`` multiplies this
            ``gap_conductivity_function`` of the contact pressure, its
            ``gap_conductivity_function_variable``, by ``gap_conductivity`` and divides by
            ``min_gap``: make both equal.

        Returns
        -------
        pathlib.Path
            The file.

        Raises
        ------
        ValueError
            If the program is another one, or the file has another ending.
        """
        pairs = [(0.0, 0.0), *zip(self.pressure.tolist(), self.conductance.tolist(), strict=True)]
        card = [f"** {SOURCE}", "*GAP CONDUCTANCE"]  # of numbers, 20 characters are read
        card += [f"{value:.12g}, {pressure:.12g}, 0." for pressure, value in pairs]
        writers: dict[str, dict[str, Callable[[Path], object]]] = {
            "calculix": {".inp": lambda path: path.write_text("\n".join([*card, ""]), "utf-8")},
            "moose": {".csv": lambda path: write_rows(path, pairs, source=SOURCE)},
        }
        if program not in writers:
            raise ValueError(f"program must be one of {(*writers,)}, got {program!r}")
        return files.save(path, writers[program])


def joint_conductance(
    surface: core.Shape | Sequence[core.Shape],
    body: Body,
    counterbody: Body | None = None,
    *,
    pressures: Sequence[float],
    conductivity: Conductivities,
    counter_conductivity: Conductivities | None = None,
    film: npt.ArrayLike = 0.0,
    hardness: float | Matrix | None = None,
    kind: Kind = "thermal",
    grid: core.Grid | None = None,
    progress: Callable[[float], object] | None = None,
) -> JointConductance:
    """Conductance per area of a joint under each mean pressure, for programs of finite elements.

    A surface that repeats is pressed in, and heat or current flows through the cells that touch:
    it is a joint in vacuum, without gas in the gaps and without radiation.

    Parameters
    ----------
    surface : Shape or sequence of Shape
        Surface, such as a `HeightMap` that repeats; or several random ones, of which the mean is
        returned with its standard deviation.
    body, counterbody
        Bodies, as in `nacre.solve`.
    pressures : sequence of float
        Mean pressures [Pa], above 0 and rising. Each solve starts from the one before; with a
        hardness, the surfaces keep their dents.
    conductivity, counter_conductivity, film, kind
        As in `Solution.conductance`.
    hardness : float or array_like, optional
        Hardness [Pa], as in `Contact.solve`.
    grid : Grid, optional
        Cells of a period along x and y; those of the maps by default.
    progress : callable, optional
        Function that gets the share of the solves that is done. By default a terminal or a
        notebook shows a bar after two seconds.

    Returns
    -------
    JointConductance
        Table with a row for each pressure.

    Raises
    ------
    ValueError
        If the pressures do not rise from above 0, there is no surface, the grid does not repeat
        along x and y, or `Solution.conductance` refuses a number.

    Examples
    --------
    >>> from nacre import design
    >>> waves = {"hurst": 0.8, "shortest": 16e-6, "longest": 64e-6, "rms_slope": 0.1}
    >>> surface = nacre.rough.random_surface((64, 64), (64e-6, 64e-6), rng=1, **waves)
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> joint = design.joint_conductance(
    ...     surface, steel, steel, pressures=[50e6, 100e6], conductivity=46.0,
    ...     counter_conductivity=46.0,
    ... )
    >>> (joint.conductance / 1e6).round(2)
    array([0.15, 0.27])
    """
    shapes = [surface] if isinstance(surface, core.Shape) else list(surface)
    if not shapes:
        raise ValueError("surface must be a shape or several, got none")
    loads = core.real_array("pressures", pressures)
    rise = loads.ndim == 1 and (np.diff(loads, prepend=0.0) > 0).all()
    if not (rise and loads.size and np.isfinite(loads).all()):
        raise ValueError(f"pressures must be numbers above 0 that rise, got {pressures!r}")
    conduction: dict[str, Any] = {
        "conductivity": conductivity,
        "counter_conductivity": counter_conductivity,
        "film": film,
        "kind": kind,
    }
    per_surface = np.empty((len(shapes), loads.size, 3))
    notes: dict[str, str] = {}  # of a kind, the first
    with lasting("joint", progress) as tell, heard():  # the result has the warnings
        for j, shape in enumerate(shapes):
            cells = _cells(shape, grid)
            contact, last = Contact(body, cells, counterbody), None
            area = cells.size[0] * cells.size[1]
            for k, load in enumerate((loads * area).tolist()):
                last = contact.solve(shape, load=load, hardness=hardness, initial=last)
                conductance, report = last.conductance(**conduction), last.report
                error = conductance.conductance * conductance.uncertainty / conductance.resistance
                per_surface[j, k] = conductance.conductance, error, corrected_area(last) / area
                notes = dict(zip(report.warning_kinds, report.warnings, strict=False)) | notes
                if tell is not None:
                    tell((j * loads.size + k + 1) / per_surface[..., 0].size)
    n, (mean, error, share) = len(shapes), per_surface.mean(axis=0).T
    deviation = per_surface[..., 0].std(axis=0, ddof=1) / math.sqrt(n) if n > 1 else None
    columns = loads, mean, error, deviation, share, _mikic(shapes, contact, loads, conduction)
    return JointConductance(*columns, kind, n, (*notes.values(),))


def _cells(shape: core.Shape, grid: core.Grid | None) -> core.Grid:
    """Return the grid of a surface, which must repeat along x and y."""
    if grid is None:
        if not isinstance(shape, core.HeightMap):
            raise ValueError("grid must be given for a surface that is not a map")
        grid = map_grid(shape)
    if grid.is_line or not all(grid.periodic):
        raise ValueError(f"grid must repeat along x and y, got {grid!r}")
    return grid


def _mikic(
    shapes: Sequence[core.Shape], contact: Contact, pressures: Field, conduction: Mapping[str, Any]
) -> Field | None:
    """Return the mean by Mikic's correlation, or None where it does not apply."""
    maps = [shape for shape in shapes if isinstance(shape, core.HeightMap)]
    pair: tuple[Any, Any] = contact.body, contact.counterbody
    bodies = [body for body in pair if body is not None]
    if len(maps) < len(shapes) or any(getattr(body, "layers", True) for body in bodies):
        return None
    resistivity = sum(
        1 / conductivities_of(name, conduction[name], body, conduction["kind"])[-1]
        for name, body in zip(("conductivity", "counter_conductivity"), pair, strict=True)
    )
    slopes = np.array([[spectral_slope(heights) / math.sqrt(math.pi)] for heights in maps])
    deviations = np.array([[surface.heights.std()] for surface in maps])
    modulus = contact_modulus(*(body.substrate for body in bodies))
    strain = math.sqrt(2) * pressures / (modulus * slopes)
    by_surface = FACTOR * 2 / resistivity * slopes / deviations * strain**EXPONENT
    return np.asarray(by_surface.mean(axis=0))
