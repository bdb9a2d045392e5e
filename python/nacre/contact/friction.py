"""Results of contacts with friction: one step of a history, or rolling, and its report."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self, SupportsIndex, Unpack, overload

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.units import energy, printable, rounded, symbol, written
from nacre.contact import plausible
from nacre.contact.normal import NormalContact
from nacre.contact.solution import NOT_COUNTED, Solution, datum_words
from nacre.contact.stresses import DepthOptions, depth_charts
from nacre.results import display, files, tables, values
from nacre.results.base import Result, Warned, as_text, checked
from nacre.results.charts import Axis, Picture, contact_charts, contact_map, loop_chart
from nacre.results.quantities import (
    AXIS,
    CELLS,
    VECTOR,
    Declared,
    Quantity,
    declared,
    derived,
    frozen,
    quantities_of,
    quantity,
)
from nacre.results.report import (
    Rows,
    Table,
    input_rows,
    notebook_picture,
    other_numbers,
    table,
)
from nacre.results.rows import Row, remark
from nacre.results.shown import Printed, Shown

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Field = npt.NDArray[np.float64]

VECTORS = ("traction", "displacement", "slip")
"""Fields with components along x and y."""
SLIDES, ROLLS = ("shift", "twist"), ("creepage", "spin", "direction")
"""Numbers of the motion in sliding and in rolling."""


LAW = (
    "Coulomb: the traction is at most friction times pressure, and opposes the slip; shifts and "
    "creepages are those of rigid bodies"
)
"""What a report says of friction."""


NORMAL = {name: name for name in ("load", "approach", "pressure", "gap", "coefficients")}
NORMAL |= {"displacement": "normal_displacement", "x": "x", "y": "y"}
"""Quantities of the normal contact that one with friction has too, and their names there."""


@frozen()
class FrictionReport(Result):
    """Report of a contact with friction: its course, and how well the laws hold.

    Errors are computed afresh at the end, with the operator of the whole grid.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=9, friction=0.3, force=(1, 0))
    >>> ball.report.termination, ball.report.violation < 1e-8, ball.report.full_slip
    ('converged', True, False)
    """

    _COMPILED = True
    _LATER = ("coupling_energy", "warnings")

    termination: Literal["running", "converged", "iteration limit", "stopped"]
    """How the iteration ended: "converged", "iteration limit" or "stopped"; "running" in progress.
    """
    convolutions: int = quantity()
    """Convolutions of the solve: tangential ones of the window of the contact.

    They are from two components to two.
    """
    sweeps: int
    """Solves of the pressure for given tractions, and of tractions for given pressure."""
    violation: float
    """Largest slip of a sticking cell, or slip across the traction, over the largest displacement.
    """
    imbalance: float
    """Largest error of a given force or torque, over the largest that friction can carry."""
    excess: float
    """Largest traction above its bound, over the largest bound."""
    pressure_change: float
    """Change of the pressure in the last sweep, over the peak; 0 without coupling."""
    coupling_energy: float
    """Elastic energy of the pressure and the normal displacement that tractions make [J].

    It is 0 without coupling, and part of `FrictionSolution.tangential_energy`.
    """
    coupled: bool
    """Whether tractions and pressure act on each other."""
    full_slip: bool
    """Whether all cells in contact slip."""
    discretisation: dict[str, float] | None
    """Estimated errors of sliding and of steady rolling due to the size of the cells, by name.

    ``force`` [N], ``torque`` [N m], ``dissipated`` [J], in rolling [N], and ``stick_share``;
    ``shift`` [m] and ``twist`` [rad] of sliding, ``creepage`` of rolling. Forces, shifts and
    creepages have the length of their error; it is 0 for what is given. `None` in rolling cell by
    cell and with ``order=1``, and where a warning says why.
    """
    order: int
    """Order of steady rolling in the length of a cell; 0 in sliding and in rolling cell by cell."""
    tolerance: float
    """Tolerance that was asked for."""
    seconds: float = dataclasses.field(compare=False)
    """Seconds that the step took, without planning; they do not count in comparisons."""
    warnings: tuple[str, ...] = ()
    """Warnings about the solution; each was also issued as a `nacre.NacreWarning`."""

    @property
    def converged(self) -> bool:
        """Whether the tolerance was met."""
        return self.termination == "converged"

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        checked_warnings = cls._checked({"warnings": state.pop("warnings") or ()})
        known = {name: value for name, value in state.items() if value is not None}
        return dataclasses.replace(super()._restored(known), **checked_warnings)

    def __repr__(self) -> str:
        """Return how the iteration ended."""
        return (
            f"<FrictionReport: {self.termination}, {self.convolutions} convolutions, "
            f"violation {self.violation:.1e}, imbalance {self.imbalance:.1e}>"
        )


def _with_friction(_: type) -> tuple[Quantity, ...]:
    """Return the quantities of a contact with friction: of its normal contact, and its own."""
    own, reported = declared(FrictionSolution), declared(FrictionReport)
    return (
        *(
            dataclasses.replace(row, name=NORMAL[row.name], path=f"normal.{row.name}", label="")
            for row in quantities_of(Solution)
            if row.name in NORMAL
        ),
        *(row for row in own if not row.is_field),
        *(dataclasses.replace(row, path=f"report.{row.name}") for row in reported),
        *(row for row in own if row.is_field),
    )


@frozen()
class FrictionSolution(NormalContact, Shown, Result):
    """A contact with friction: one step of a history, or rolling.

    Fields are at cell centres, and read-only. Tractions act on the body, and their opposites on
    the counterbody. Displacements are those of the body less those of the counterbody; slip is
    that of the counterbody over the body.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=9, friction=0.3, force=(1, 0))
    >>> ball.traction.shape == (2, *ball.pressure.shape), bool(ball.stick.any())
    (True, True)
    """

    _QUANTITIES = Declared(_with_friction)
    _TITLE = "contact of coated bodies with friction"

    _solved: core.FrictionSolved
    """Solution of the compiled module."""
    force: tuple[float, float] = quantity("N", "N/m", AXIS, "force")
    """Force of the tractions on the body [N] along x and y."""
    torque: float = quantity("N m", "N", label="torque")
    """Torque of the tractions about the origin [N m], on the body."""
    shift: tuple[float, float] | None = quantity("m", dims=AXIS, label="shift")
    """Shift of the counterbody over the body [m] since the first touch; `None` in rolling.

    In line contact it is counted from the bare substrate's surface, as `Grid.line` says.
    """
    twist: float | None = quantity("rad", label="twist")
    """Twist of the counterbody over the body [rad] since the first touch; `None` in rolling."""
    creepage: tuple[float, float] | None = quantity(dims=AXIS, label="creepage")
    """Creepages along and across: along the direction of rolling e and along z × e.

    They are `None` in sliding.
    """
    spin: float | None = quantity("1/m", label="spin")
    """Spin [1/m]; `None` in sliding."""
    direction: Literal["+x", "-x", "+y", "-y"] | None
    """Direction of rolling, "+x", "-x", "+y" or "-y"; `None` in sliding."""
    dissipated: float = quantity("J", "J/m", label="dissipated", rolling=("J/m", "J/m²"))
    """Energy that friction dissipates [J] in the step.

    In rolling it is that of the distance rolled [N], the power over the speed.
    """
    tangential_energy: float | None = quantity("J", "J/m")
    """Elastic energy that tractions add [J] to that of the bodies.

    It is ``½ sum (q · u + p v) dA`` with the normal displacement v that the tractions make, which
    is 0 without coupling. The energy of the pressure alone is that of `normal`. With coupling, what
    the tractions add may be below 0. `None` in line contact below stiff layers that move less than
    the bare substrate's surface from which `shift` is counted.
    """
    report: FrictionReport
    """Course of the solve, and how well the laws hold."""

    @classmethod
    def _of(cls, solved: core.FrictionSolved, shape: core.Shape | None = None) -> Self:
        """Return a solution of the compiled module."""
        numbers = {**dict.fromkeys(SLIDES + ROLLS), **solved.numbers()}
        normal = Solution._of(solved.normal(), shape)
        warnings = tuple(normal.report.warnings)
        report = FrictionReport(**numbers.pop("report"), warnings=warnings)
        solution = cls(solved, report=report, **numbers)
        solution.__dict__["normal"] = normal
        texts = (text for _, text in plausible.of_friction(solution))
        solution.__dict__["report"] = dataclasses.replace(report, warnings=(*warnings, *texts))
        return solution

    @functools.cached_property
    def normal(self) -> Solution:
        """Normal contact: pressure, gap, approach, tilt."""
        return Solution._of(self._solved.normal())

    @property
    @derived("J", "J/m")
    def elastic_energy(self) -> float | None:
        """Elastic energy of pressure and tractions [J] together, of both bodies.

        It changes by the work of the forces less the energy `dissipated`. `None` as
        `tangential_energy`.
        """
        if self.tangential_energy is None:
            return None
        return self.normal.elastic_energy + self.tangential_energy

    @property
    @derived()
    def stick_share(self) -> float:
        """Share of the contact that sticks: of its cells; 0 where nothing touches."""
        return int(self.stick.sum()) / max(int((self.pressure > 0).sum()), 1)

    @functools.cached_property
    @derived("Pa", dims=VECTOR)
    def traction(self) -> Field:
        """Traction on the body, ``(2, nx, ny)`` [Pa], along x and y."""
        return self._solved.field("traction")

    @functools.cached_property
    @derived("m", dims=VECTOR)
    def displacement(self) -> Field:
        """Displacement of the body less counterbody, ``(2, nx, ny)`` [m], along x and y."""
        return self._solved.field("displacement")

    @functools.cached_property
    @derived("m", dims=VECTOR, rolling=("", ""))
    def slip(self) -> Field:
        """Slip in the step; over the way in rolling [m, 1], ``(2, nx, ny)``.

        It is that of the counterbody over the body, in rolling the slip velocity over the speed of
        rolling; 0 outside the contact.
        """
        return self._solved.field("slip")

    @functools.cached_property
    @derived(dims=CELLS, follows=True)
    def stick(self) -> npt.NDArray[np.bool_]:
        """Whether a cell sticks, ``(nx, ny)``.

        It is in contact, and its traction is below the bound.
        """
        return self._solved.field("stick")

    @functools.cached_property
    def bound(self) -> Field:
        """Bound of the traction, friction times pressure, ``(nx, ny)`` [Pa]."""
        return self._solved.field("bound")

    @functools.cached_property
    @derived(dims=CELLS)
    def friction(self) -> float | Field:
        """Coefficient of friction: a number, or one for each cell ``(nx, ny)``."""
        return self._solved.field("friction")

    @functools.cached_property
    def dissipation(self) -> Field:
        """Energy that friction dissipates by area, traction times slip, ``(nx, ny)``.

        It is that of the step [J/m²], or in rolling that of the distance rolled [J/m³].
        """
        return self._solved.field("dissipation")

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw stick and slip, with arrows of the traction; needs ``nacre-contact[plot]``.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Axes to draw into; a new figure by default.

        Returns
        -------
        matplotlib.axes.Axes
            Axes of the picture.

        Raises
        ------
        TypeError
            If `axes` are not axes.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=9, friction=0.3, force=(1, 0))
        >>> ball.plot().get_xlabel()
        'x [µm]'
        """
        from nacre import plot

        return plot.friction(self, axes)

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of the fields, with units and the problem; needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Fields on x and y; main numbers and the report as attributes.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=9, friction=0.3, force=(1, 0))
        >>> dataset = ball.to_xarray()
        >>> dataset.traction.dims, dataset.traction.units
        (('component', 'x', 'y'), 'Pa')
        """
        return files.gridded(self)

    def __repr__(self) -> str:
        """Return the main numbers in a line."""
        nx, ny = self.grid.shape
        unit = "N/m" if self.grid.is_line else "N"
        motion = ("shift", "m") if self.shift is not None else ("creepage", "")
        values = getattr(self, motion[0]) or (0.0, 0.0)
        values = display.without_rounding(values)
        components = display.pair(values, "m") if motion[1] else "({:.4g}, {:.4g})".format(*values)
        force = display.pair(display.without_rounding(self.force), unit)
        end = "converged" if self.report.converged else "not converged"
        return printable(
            f"<FrictionSolution on {nx} x {ny} cells: "
            f"force {force}, {motion[0]} {components}, {end}>"
        )

    def _rows(self) -> list[Row]:
        """Return the numbers of the normal contact, and those of friction."""
        grid = next(row for row in self.normal._remarks() if row.key == "grid")
        return [*self.normal._rows(), grid, *_friction_rows(self)]

    def _remarks(self) -> list[Row]:
        return [remark("ended", _ending(self.report))]

    def _inputs(self) -> Rows:
        friction = {"friction": self.friction, "direction": self.direction}
        motion = "shift" if self.direction is None else "creepage"
        # What is given has no error.
        given = "force" if (self.report.discretisation or {}).get(motion) else motion
        rows = [row for row in _friction_rows(self) if row.key == given]
        return [*self.normal._inputs(), *input_rows(friction), *rows]

    def _report_rows(self) -> Rows:
        friction = [*_friction_rows(self), *self._remarks()]
        return [*self.normal._report_rows(), *friction, *other_numbers(self)]

    def _charts(self, **stress: Unpack[DepthOptions]) -> Sequence[Picture]:
        """Return the charts of a report; `stress` has keywords of stresses, for their picture."""
        return [*self._contact_charts(), *depth_charts(self, **stress)]

    def _contact_charts(self) -> list[Picture]:
        """Return the charts of pressure, and of where the contact sticks and slips."""
        charts = contact_charts(self)
        if self.grid.is_line or not charts:
            return charts
        bound = np.where(self.bound > 0, self.bound, np.inf)
        share = np.hypot(*self.traction) / bound
        caption = "Traction over friction times pressure: slip if it is 1."
        axis = Axis("traction over its bound", "", (0.0, 1.0))
        return [*charts, contact_map(self, share, axis, caption)]

    def _notebook_picture(self) -> bytes | None:
        return notebook_picture(self._contact_charts())

    @property
    def _warnings(self) -> Sequence[str]:
        return self.report.warnings

    def _writers(self) -> dict[str, Callable[[Path], object]]:
        return files.writers(self, self.plot)

    def _model(self) -> Rows:
        normal = [row for row in self.normal._model() if row.key != "not_counted"]
        ended = remark("friction ended", _ending(self.report))
        return [*normal, remark("friction", LAW), ended, remark("not counted", NOT_COUNTED)]

    def _si(self, row: Quantity) -> str:
        """Return the SI unit of a quantity of this contact."""
        return row.si(line=self.grid.is_line, rolls=self.direction is not None)

    def _attributes(self) -> dict[str, object]:
        """Return what files say of the contact besides its numbers and fields."""
        report, friction = self.report, self.friction
        names = ("termination", "violation", "imbalance", "tolerance")
        return {
            **({} if self.direction is None else {"direction": self.direction}),
            **({} if isinstance(friction, np.ndarray) else {"friction": friction}),
            **{name: getattr(report, name) for name in names},
            "warnings": "\n".join(self._warnings),
        }

    @classmethod
    def _names(cls) -> list[str]:
        return ["normal", "friction", *VECTORS, "motion", "report"]

    def _state(self) -> dict[str, object]:
        normal = self.normal.to_dict()
        for key in values.heading("Solution"):
            del normal[key]
        motion = SLIDES if self.direction is None else ROLLS
        return {
            "normal": normal,
            "friction": self.friction,
            **{name: getattr(self, name) for name in VECTORS},
            "motion": {name: values.encode(getattr(self, name)) for name in motion},
            # The normal contact has the warnings.
            "report": {k: v for k, v in self.report._state().items() if k != "warnings"},
        }

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        if not isinstance(state["normal"], dict):
            raise ValueError(f"normal must be a dict of named fields, got {state['normal']!r}")
        with values.refusing(cls.__name__):
            normal = Solution.from_dict(values.heading("Solution") | state["normal"])
            fields = {name: state[name] for name in ("friction", *VECTORS)}
            beside = {name: state[name] for name in ("motion", "report")}
            text = as_text(cls.__name__, beside)
            return cls._of(core.FrictionSolved(normal._solved, rest=text, **fields))


class History(list[FrictionSolution], Shown, Warned):
    """Steps of sliding or rolling, in their order: a list, which is printed and saved as a whole.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> steps = [{"force": (force, None)} for force in (2.0, -2.0)]
    >>> loop = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, steps=steps)
    >>> loop.to_xarray().traction.dims, len(loop)
    (('step', 'component', 'x', 'y'), 2)
    """

    _QUANTITIES = Declared(_with_friction)
    _TITLE = "history of a contact with friction; numbers and pressures are of the last step"

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings about all steps, each once."""
        return tuple(dict.fromkeys(text for step in self for text in step.report.warnings))

    def numbers(self) -> xarray.Dataset:
        """Dataset of the numbers of all steps; needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Load, force, torque, dissipated energy, share of the contact that sticks and others over
            ``step``; shift and twist of sliding, creepage and spin of rolling.
        """
        return self._dataset({}, {})

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of all fields and numbers over ``step``; needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Fields on step, x and y; numbers on step.
        """
        state = self.to_dict()
        state["steps"] = [dict(step) for step in state["steps"]]
        arrays = [files.take_arrays(step, self._QUANTITIES) for step in state["steps"]]
        fields: dict[str, list[object]] = {}
        for row in self._QUANTITIES:
            columns = [step.get(row.name) for step in arrays]
            if row.follows or all(values is not None for values in columns):
                fields[row.name] = [row.of(step) for step in self]
            else:  # of some steps alone, as a coefficient of friction that becomes a field
                for step, values in zip(state["steps"], columns, strict=True):
                    if values is not None:
                        row.put(step, values.tolist())
        return self._dataset(fields, state)

    def _dataset(self, fields: Mapping[str, object], state: Mapping[str, object]) -> xarray.Dataset:
        """Return the Dataset of the numbers, and of these fields."""
        steps = checked(self)
        columns: dict[str, object] = {}
        for row in self._QUANTITIES:
            if row.name in fields:
                values = np.array(fields[row.name])
                plain = values.astype(np.int8) if values.dtype == bool else values
                columns[row.name] = ("step", *row.dims), plain
            elif row.dims in ((), AXIS) and row.of(steps[0]) is not None:
                dims = ("step", "component") if row.dims else ("step",)
                columns[row.name] = dims, np.array([row.of(step) for step in steps])
        columns["termination"] = "step", [step.report.termination for step in steps]
        coordinates: dict[str, object] = {"step": np.arange(len(steps)), "component": ["x", "y"]}
        if fields:
            coordinates |= {"x": steps[0].x, "y": steps[0].y}
        units = ((row, steps[0]._si(row)) for row in self._QUANTITIES)
        title = "history of a contact with friction"
        rolls = {} if steps[0].direction is None else {"direction": steps[0].direction}
        return files.dataset(title, units, columns, coordinates, state, **rolls)

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw the force of sliding as a function of the shift, or the last step of rolling.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Axes to draw into; a new figure by default.

        Returns
        -------
        matplotlib.axes.Axes
            Axes of the picture.

        Raises
        ------
        TypeError
            If `axes` are not axes.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> steps = [{"force": (force, None)} for force in (2.0, -2.0)]
        >>> loop = nacre.slide(
        ...     nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, steps=steps
        ... )
        >>> loop.plot().get_xlabel()
        'shift along x [nm]'
        """
        from nacre import plot

        first = checked(self)[0].shift
        if first is None:
            return plot.friction(self[-1], axes)
        ranges = [np.ptp([step.force[axis] for step in self]) for axis in range(2)]
        return plot.loop(self, "xy"[int(np.argmax(ranges))], axes)

    def _inputs(self) -> Rows:
        return checked(self)[-1]._inputs()

    def _report_rows(self) -> Rows:
        """Return the numbers of the last step."""
        return checked(self)[-1]._report_rows()

    def _charts(self, **stress: Unpack[DepthOptions]) -> Sequence[Picture]:
        """Return the charts of a report: force over shift, and those of the last step."""
        forces = np.array([step.force for step in self])
        axis = int(np.argmax(np.ptp(forces, axis=0)))
        is_sliding = all(step.shift is not None for step in self)
        loop = [loop_chart(self, axis)] if is_sliding else []
        return [*loop, *checked(self)[-1]._charts(**stress)]

    def _notebook_picture(self) -> bytes | None:
        return display.drawn(self.plot) if self else None

    def _tables(self) -> Sequence[Table]:
        return [table("Steps", self._file_rows())]

    def _model(self) -> Rows:
        return checked(self)[-1]._model()

    def _file_rows(self) -> list[list[object]]:
        """Return the numbers of each step, after their headings."""
        first = checked(self)[0]
        quantities = [row for row, _ in tables.numbers(first)]
        axes = [("x", "y") if row.dims else ("",) for row in quantities]
        heads = [
            tables.heading(row, first, axis)
            for row, names in zip(quantities, axes, strict=True)
            for axis in names
        ]
        rows = [
            [k, *np.hstack([np.ravel(row.of(step)) for row in quantities]).tolist()]
            for k, step in enumerate(self)
        ]
        ends = (step.report.termination for step in self)
        table_rows = [[*row, end] for row, end in zip(rows, ends, strict=True)]
        return [["step", *heads, "termination"], *table_rows]

    def to_dict(self) -> dict[str, Any]:
        """Return the named states of the steps, as plain data; see `FrictionSolution.to_dict`."""
        return values.heading("History") | {"steps": [step._state() for step in self]}

    @classmethod
    def from_dict(cls, data: Mapping[str, object]) -> Self:
        """Return the history whose named state `to_dict` returned, to the bit.

        Parameters
        ----------
        data : dict
            Named state; lists may stand for arrays, as in JSON.

        Returns
        -------
        History
            The steps.

        Raises
        ------
        ValueError
            As `FrictionSolution.from_dict`.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> steps = [{"force": (force, None)} for force in (2.0, -2.0)]
        >>> loop = nacre.slide(
        ...     nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, steps=steps
        ... )
        >>> nacre.types.History.from_dict(loop.to_dict()) == loop
        True
        """
        state = values.checked_state(data, "History", ["steps"])
        head = values.heading("FrictionSolution")
        with values.refusing("History"):
            return cls(FrictionSolution.from_dict(head | step) for step in state["steps"])

    def __repr__(self) -> str:
        """Return the number of steps and the last one."""
        last = f", the last {self[-1]!r}" if self else ""
        return f"<History of {len(self)} steps{last}>"

    @overload
    def __getitem__(self, place: SupportsIndex) -> FrictionSolution: ...
    @overload
    def __getitem__(self, place: slice) -> Self: ...
    def __getitem__(self, place: SupportsIndex | slice) -> FrictionSolution | Self:
        """Return a step, or the history of some of them."""
        if isinstance(place, slice):
            return type(self)(super().__getitem__(place))
        return super().__getitem__(place)

    def __add__(self, other: Any) -> Any:
        """Return the history of these steps and others."""
        return type(self)([*self, *other])

    def copy(self) -> Self:
        """Return a history of the same steps."""
        return type(self)(self)

    def _rows(self) -> list[Row]:
        return [] if self else [Row("steps", "", "a history of 0 steps")]

    def _table(self) -> Printed | None:
        """Return the table of the steps."""
        if not self:
            return None
        head, *rows = _step_rows(self)
        return Printed(head, rows, side=">")


values.RESULTS["History"] = History


def _friction_rows(solution: FrictionSolution) -> list[Row]:
    """Return the main numbers of friction."""
    report, rolls = solution.report, solution.shift is None
    rows = display.rows(solution, solution._QUANTITIES, TEXTS, solution.grid.is_line, rolls)
    touching, sticking = int((solution.pressure > 0).sum()), int(solution.stick.sum())
    share = (report.discretisation or {}).get("stick_share", 0.0)
    error = f" ± {np.ceil(share * touching):.0f}" if share > 0 else ""
    state = "all slips" if report.full_slip else f"{sticking}{error} of {touching} cells stick"
    return [
        *rows,
        *([remark("rolls", f"towards {solution.direction}")] if rolls else []),
        remark("friction", state if touching else "nothing touches"),
    ]


def _ending(report: FrictionReport) -> str:
    """Return how the iteration of friction ended."""
    coupled = f", {report.sweeps} sweeps" if report.coupled else ""
    accuracy = f"violation {report.violation:.0e}, imbalance {report.imbalance:.0e}"
    return f"{report.termination}, {accuracy}{coupled}"


def _with_error(solution: FrictionSolution, name: str, text: str, size: float, unit: str) -> str:
    """Return what is said of a number of friction, with its discretisation error if it has one.

    The error is one of its `size`, or has a unit where it is larger.
    """
    error = (solution.report.discretisation or {}).get(name, 0.0)
    if error <= display.NOISE * size:
        return text
    if error < size:
        return f"{text} ± {rounded(100 * error / size, 1)} %"
    return f"{text} ± {written(error, unit, 1) if unit else rounded(error, 1)}"


def _force(solution: FrictionSolution) -> str:
    unit = "N/m" if solution.grid.is_line else "N"
    text = display.pair(display.without_rounding(solution.force), unit)
    return _with_error(solution, "force", text, float(np.hypot(*solution.force)), unit)


def _creepage(solution: FrictionSolution) -> str | None:
    if (creepage := solution.creepage) is None:
        return None
    components = "({:.4g}, {:.4g})".format(*display.without_rounding(creepage))
    return _with_error(solution, "creepage", components, float(np.hypot(*creepage)), "")


def _torque(solution: FrictionSolution) -> str | None:
    if solution.grid.is_line:
        return None
    noise = display.SLIGHT * max(solution.grid.size) * max(map(abs, solution.force))
    torque = solution.torque if abs(solution.torque) > noise else 0.0
    return _with_error(solution, "torque", written(torque, "N m"), abs(torque), "N m")


def _shift(solution: FrictionSolution) -> str | None:
    if (shift := solution.shift) is None:
        return None
    text = display.pair(display.without_rounding(shift), "m")
    text = _with_error(solution, "shift", text, float(np.hypot(*shift)), "m")
    return text + datum_words(solution.normal.report)


def _twist(solution: FrictionSolution) -> str | None:
    if (twist := solution.twist) is None or solution.grid.is_line:
        return None
    return _with_error(solution, "twist", f"{twist:.4g} rad", abs(twist), "rad")


def _dissipated(solution: FrictionSolution) -> str:
    # Power over speed in rolling, and rounding where nothing slips.
    work = max(map(abs, solution.force)) * max(map(abs, solution.shift or (1.0,)))
    lost = solution.dissipated if solution.dissipated > display.SLIGHT * work else 0.0
    unit = energy(solution.grid.is_line, solution.shift is None)
    return _with_error(solution, "dissipated", written(lost, unit), lost, unit)


def _component(
    solution: FrictionSolution, name: Literal["force", "shift"], component: float
) -> str:
    """Return a component of a force or a shift, with the error of the vector."""
    unit = "m" if name == "shift" else ("N/m" if solution.grid.is_line else "N")
    text = written(component, unit)
    return _with_error(solution, name, text, abs(component), unit) if component else text


TEXTS: dict[str, Callable[[FrictionSolution], str | None]] = {
    "force": _force,
    "torque": _torque,
    "shift": _shift,
    "twist": _twist,
    "creepage": _creepage,
    "spin": lambda s: None if s.spin is None else f"{s.spin:.4g} /{symbol('m')}",
    "dissipated": _dissipated,
}
"""Values of a contact with friction that are more than a number with its unit."""


def _step_rows(steps: Sequence[FrictionSolution]) -> list[list[str]]:
    """Return the rows of a table of the steps of a history, the heading first."""
    rolls = steps[0].shift is None
    motion_name = "creepage" if rolls else "shift"
    rows = [["step", "force x", "force y", f"{motion_name} 1" if rolls else "shift x"]]
    rows[0] += [f"{motion_name} 2" if rolls else "shift y", "dissipated", "ended"]
    motions = [(step.creepage if rolls else step.shift) or (0.0, 0.0) for step in steps]
    moves = np.reshape(display.without_rounding(np.ravel(motions).tolist()), (-1, 2))
    pulls = np.reshape(
        display.without_rounding(np.ravel([step.force for step in steps]).tolist()), (-1, 2)
    )
    for number, (step, motion, pull) in enumerate(zip(steps, moves, pulls, strict=True)):
        motion_cells = [
            f"{component:.4g}" if rolls else _component(step, "shift", component)
            for component in motion
        ]
        force_cells = [_component(step, "force", component) for component in pull]
        outcome = [_dissipated(step), step.report.termination]
        rows.append([str(number), *force_cells, *motion_cells, *outcome])
    return rows
