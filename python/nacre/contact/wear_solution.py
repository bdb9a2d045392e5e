"""Histories of wear: what sliding takes off both bodies, and when a layer is through."""

from __future__ import annotations

import ast
import base64
import dataclasses
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import MISSING, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np

import nacre._core as core
from nacre._tools.groups import Group, keyword, keyword_units
from nacre._tools.typing import Field
from nacre._tools.units import Scale, rounded, symbol, travelled, written
from nacre.contact.arguments import Motion
from nacre.contact.solution import Solution
from nacre.results import display, files, values
from nacre.results.base import Result, same
from nacre.results.charts import HEADROOM, Axis, Chart, Curve, Picture, contact_charts
from nacre.results.journal import Journal, Record
from nacre.results.quantities import CELLS, Quantity, derived, frozen, quantity
from nacre.results.report import Rows, Table, input_rows, table
from nacre.results.rows import Row, remark
from nacre.results.shown import Shown
from nacre.results.tables import heading
from nacre.results.verdict import (
    Demand,
    Verdict,
    asked,
    beside,
    judged,
    number,
    reasons,
    with_error,
)

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Rate = float | Mapping[str | int, float]
"""Wear rate of a body, or of its layers by number, name and "substrate"."""
Scheme = Literal["trapezoidal", "euler"]
Thickness = Literal["frozen", "first order"]
Unit = Literal["m", "cycles", "passes"]
MODEL = (
    "wear by Archard's law with a known rate; no third body, no running-in of the rate, "
    "no change of friction, and layers {}: `thickness_error` estimates the error"
)
BODIES = ("shape", "body", "counterbody")
"""Inputs that the first contact of a history has."""
MOST_SECTIONS = 8
"""Sections of a chart of worn depths; of more states some are left out."""
DISTANCE = Demand("distance", "", 0.0, 0.0, at_least=True, leads=True)
"""Distance that the layers must last."""
UNASKED = "Give a required distance to judge it."
RATE = "The error of the wear rate is not counted: measured rates scatter by some 50 %."
THICKNESSES: dict[str, str] = {
    "frozen": "as thick as before",
    "first order": "thinner to first order in the depth",
}
"""How thick layers are in the elastic contact, in words."""


@dataclass(frozen=True, eq=False)
class Rates(Group):
    """Wear rates."""

    rate: Rate = keyword("m²/N", default=MISSING)
    counter_rate: Rate = keyword("m²/N", default=0.0)


@dataclass(frozen=True, repr=False)
class WearThrough(Result):
    """A layer is worn through at one place.

    Examples
    --------
    >>> nacre.types.WearThrough(2e3, (0.0, 1e-4), 0, "layers[0] DLC", "body").distance
    2000.0
    """

    distance: float
    """Sliding distance [m], cycles or passes until then."""
    position: tuple[float, float]
    """Centre of the cell [m]."""
    number: int
    """Number of the layer, from the surface down."""
    layer: str
    """Number and name of the layer, "layers[0] DLC"."""
    body: Literal["body", "counterbody"]
    """Whose layer it is."""
    uncertainty: float | None = None
    """Estimated error of the distance by the steps [m], cycles or passes."""

    def __repr__(self) -> str:
        """Return layer, distance and place in a line."""
        return f"<WearThrough: {self._words(f'{self.distance:.4g}')}>"

    def _words(self, distance: str) -> str:
        """Return layer, distance and place."""
        at = ", ".join(written(x, "m") for x in self.position)
        return f"{self.layer} of the {self.body} after {distance}, at ({at})"


@dataclass(frozen=True, repr=False)
class WearReport(Result):
    """How a history of wear came about.

    Examples
    --------
    >>> nacre.types.WearReport(3, 1e-4, None, 0, True, (), 0.5).steps
    3
    """

    steps: int
    """Number of steps."""
    step_error: float | None
    """Estimated error of the last pressure by the steps: the largest of a cell, over the peak.

    It is found with steps of another length. Where a history goes on, that before is added.
    """
    thickness_error: float | None
    """Estimated error of the last pressure by the thickness of the layers, relative to the peak.

    That of layers as thick as before, or of thinner ones to first order: the largest within the
    contact and of the peak, found with layers that are thinner by the mean of the depths. None
    without a layer that wears.
    """
    regrids: int
    """Number of times that the grid grew."""
    converged: bool
    """Whether it reached its end."""
    warnings: tuple[str, ...]
    """What the user should know."""
    seconds: float
    """Time that it took [s]."""

    def __repr__(self) -> str:
        """Return steps and errors in a line."""
        return (
            f"<WearReport: {self.steps} steps, step error {self.step_error}, {self.seconds:.1f} s>"
        )


@frozen(eq=False)
class WearState(Result):
    """A worn contact.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> history = nacre.wear(nacre.Sphere(5e-3), steel, load=10.0, rate=1e-16, sliding=1.0)
    >>> history.states[-1].depth.shape == history.states[-1].solution.pressure.shape
    True
    """

    distance: float
    """Sliding distance [m], cycles or passes."""
    depth: Field = quantity("m", dims=CELLS)
    """Depth removed from the body, ``(nx, ny)`` [m]."""
    counter_depth: Field = quantity("m", dims=CELLS)
    """Depth removed from the counterbody, ``(nx, ny)`` [m]."""
    solution: Solution
    """The contact; its gap has the wear in it."""
    step_error: float | None
    """Estimated error of the pressure by the steps, the largest of a cell relative to the peak."""
    rings: bool
    """Whether pressures rise and fall from step to step, since the steps are too long."""

    @property
    def volume(self) -> tuple[float, float]:
        """Volume removed from body and counterbody [m³]; per length [m²] in line contact."""
        area = math.prod(self.solution.grid.spacing)
        return float(self.depth.sum()) * area, float(self.counter_depth.sum()) * area

    def __eq__(self, other: object) -> bool:
        """Return whether all is equal."""
        return isinstance(other, WearState) and same(self._state(), other._state())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Return distance and deepest wear in a line."""
        deepest = written(float(self.depth.max()), "m")
        return f"<WearState after {self.distance:.4g}: {deepest} deep, {self.solution!r}>"

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        with values.refusing(cls.__name__):
            solution = Solution.from_dict(values.heading("Solution") | state["solution"])
            depths = {}
            for name in ("depth", "counter_depth"):
                depths[name] = np.array(state[name], dtype=np.float64)
                depths[name].setflags(write=False)
                if depths[name].shape != solution.grid.shape:
                    raise ValueError(
                        f"{name} must have the shape of the grid, got {depths[name].shape}"
                    )
            return cls(**state | depths | {"solution": solution})


WearProgress = Callable[[WearState], object]
"""Function that is told each state of a history of wear."""


@dataclass(frozen=True, repr=False, eq=False)
class WearHistory(Shown, Result):
    """A history of wear: `nacre.wear` returns it.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> history = nacre.wear(nacre.Sphere(5e-3), steel, load=10.0, rate=1e-16, sliding=1.0)
    >>> print(f"{history.volume[-1][0]:.6g} m³")
    1e-15 m³
    """

    _TITLE = "wear of a contact"
    _LATER = ("required_distance",)

    states: tuple[WearState, ...]
    """Worn contacts, the first before any sliding."""
    events: tuple[WearThrough, ...]
    """Layers that are worn through, each at its first place; a step ends at each."""
    unit: Unit
    """Unit of the distance."""
    report: WearReport
    """How it came about."""
    inputs: dict[str, str]
    """Inputs in words."""
    required_distance: float | None = None
    """Distance that is required, cycles or passes, which decides the verdict; None without."""

    @property
    @derived("m")
    def life(self) -> WearThrough | None:
        """First layer that is through, and its distance [m]; None where none is."""
        return self.events[0] if self.events else None

    @property
    @derived("m³", "m²")
    def worn_volume(self) -> float:
        """Volume removed from both bodies [m³] at the end; [m²] in line contact."""
        return float(self.volume[-1].sum())

    @property
    @derived("m", dims=("step",))
    def distance(self) -> Field:
        """Sliding distance, cycles or passes [m], from 0, ``(n + 1,)``."""
        return self._per_state(lambda state: state.distance)

    @property
    @derived("m³", "m²", ("step", "member"))
    def volume(self) -> Field:
        """Volume removed [m³] from body and counterbody, ``(n + 1, 2)``; [m²] in line contact."""
        return self._per_state(lambda state: state.volume)

    @property
    @derived("m", dims=("step", "member"))
    def deepest(self) -> Field:
        """Largest depth removed [m] from body and counterbody, ``(n + 1, 2)``."""
        return self._per_state(lambda state: (state.depth.max(), state.counter_depth.max()))

    @property
    @derived("Pa", dims=("step",))
    def peak_pressure(self) -> Field:
        """Largest pressure of a cell [Pa], ``(n + 1,)``."""
        return self._per_state(lambda state: state.solution.peak_pressure)

    @property
    @derived("m²", "m", ("step",))
    def contact_area(self) -> Field:
        """Area in contact [m²], ``(n + 1,)``; [m] in line contact."""
        return self._per_state(lambda state: state.solution.contact_area)

    @property
    @derived("m", dims=("step",))
    def approach(self) -> Field:
        """Approach of the origin [m], ``(n + 1,)``."""
        return self._per_state(lambda state: state.solution.approach)

    @property
    @derived("N", "N/m", ("step",))
    def load(self) -> Field:
        """Normal force [N], ``(n + 1,)``; [N/m] in line contact."""
        return self._per_state(lambda state: state.solution.load)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What limits the validity, and was warned of."""
        return self.report.warnings

    @asked
    def verdict(self, required_distance: float | None = None) -> Verdict:
        """Verdict: whether a layer is through, after which distance and where.

        Parameters
        ----------
        required_distance : float, optional
            Distance [m], cycles or passes, after which no layer may be through; by default that of
            the history. Without it, the verdict is unknown.

        Returns
        -------
        Verdict
            Bad where a layer is through before, good where none is at 1.5 of it.

        Raises
        ------
        ValueError
            If the distance is not above 0 and finite.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> body = nacre.HalfSpace(steel, [nacre.Layer(steel, 2e-6)])
        >>> history = nacre.wear(nacre.Sphere(5e-3), body, load=10.0, rate=1e-16, sliding=1.0)
        >>> history.verdict(required_distance=0.5).level
        'good'
        """
        limit = self.required_distance
        if required_distance is not None:
            limit = core.real("required_distance", required_distance)
            if not 0 < limit < math.inf:
                raise ValueError(f"required_distance must be above 0 and finite, got {limit:g}")
        demand, doubts = self._lasting(limit), []
        if not (self.life or self.deepest[-1].max() > 0):
            doubts.append("nothing has worn")
        if demand is not None and limit is not None and demand.limit is None:
            doubts.append("the history ends before the required distance")
        if not self.report.converged:
            doubts.append("the history was stopped")
        elif any(state.rings for state in self.states):
            doubts.append("the steps are too long, and ring")
        asked_for = None if limit is None or demand is None else travelled(limit, self.unit)
        worn = number(float(self.deepest[-1].max()), "m")
        bare = f"Worn after {travelled(float(self.distance[-1]), self.unit)}: {worn} at most."
        return judged(
            [demand or Demand("depth", "", 0.0, sentence=bare, leads=True)],
            doubts=[*doubts, *reasons(self.warnings, "unknown")] if asked_for else doubts[:1],
            notes=[] if self.life is None else [self._place_of(self.life), RATE],
            cautions=reasons(self.warnings, "fair") if asked_for else (),
            unasked=None if asked_for or demand is None else UNASKED,
            question=asked_for and f"Does every layer last {asked_for}?",
        )

    def _lasting(self, limit: float | None) -> Demand | None:
        """Return the distance that the layers last, with its limit, or None without layers.

        A history in which no layer is through tells of no longer distance.
        """
        report, life = self.states[0].solution.report, self.life
        bodies = {"body": report.body, "counterbody": report.counterbody}
        layers = {
            name: body.layers
            for name, body in bodies.items()
            if isinstance(body, core.HalfSpace) and body.layers
        }
        if not layers:
            return None
        needed = "" if limit is None else f", {travelled(limit, self.unit)} required"
        if life is not None:
            error = self._distance_error(life)
            when, soon = "from the start", ": too soon" if limit and life.distance < limit else ""
            if life.distance > 0:
                when = f"after {self._travelled(life)}"
            else:
                error = 0.0  # that is certain
            sentence = f"Worn through {when}{needed}{soon}."
            return DISTANCE._replace(
                value=life.distance, error=error, limit=limit, unit=self.unit, sentence=sentence
            )
        reached, deepest = (
            float(self.distance[-1]),
            dict(zip(bodies, self.deepest[-1], strict=True)),
        )
        body = max(layers, key=lambda name: deepest[name] / layers[name][0].thickness)
        worn = beside(layers[body][0].thickness, deepest[body], "m").rpartition(" ")[0]
        sentence = (
            f"No layer is worn through after {travelled(reached, self.unit)}{needed}: "
            f"{worn} of {number(layers[body][0].thickness, 'm')} worn at most."
        )
        limit = None if limit is not None and reached < limit else limit
        return DISTANCE._replace(value=reached, limit=limit, unit=self.unit, sentence=sentence)

    def _distance_error(self, event: WearThrough) -> float | None:
        """Return the error of a distance by the steps and by the thickness of the layers.

        Wear is proportional to the pressure, and so is its error by the thickness.
        """
        if event.uncertainty is None:
            return None
        return event.uncertainty + (self.report.thickness_error or 0.0) * event.distance

    def _travelled(self, event: WearThrough) -> str:
        """Return the distance to an event, and its error."""
        share = with_error(event.distance, self._distance_error(event))
        return f"{travelled(event.distance, self.unit)}{share}"

    def _place_of(self, event: WearThrough) -> str:
        """Return which layer is through, and where."""
        solution = self.states[0].solution
        layers = getattr(solution.report, event.body).layers
        name = display.layer_in_words(event.number, layers[event.number].name, len(layers))
        # Beside the size of the grid, a coordinate may be rounding.
        *at, _ = display.without_rounding([*event.position, max(solution.grid.size)])
        axes = "y" if solution.grid.is_line else "xy"
        place = ", ".join(f"{axis} = {number(at['xy'.index(axis)], 'm')}" for axis in axes)
        return f"First worn through: {name} of the {event.body}, at {place}."

    @property
    def _thickness(self) -> str:
        return self.inputs.get("thickness", "frozen")

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Say why there is no gradient."""
            if name == "gradient":
                raise AttributeError(
                    "a history of wear has no gradient: take differences of two histories, such "
                    "as of rates 1 % apart; the solution of a state has one, at its wear"
                )
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def _per_state(self, of: Callable[[WearState], Any]) -> Field:
        return np.array([of(state) for state in self.states])

    def __len__(self) -> int:
        """Return the number of states."""
        return len(self.states)

    def __iter__(self) -> Iterator[WearState]:
        """Iterate over the states."""
        return iter(self.states)

    def __eq__(self, other: object) -> bool:
        """Return whether all is equal."""
        if not isinstance(other, WearHistory):
            return False
        plain = [{**history._state(), "states": len(history)} for history in (self, other)]
        return same(*plain) and self.states == other.states

    __hash__ = None  # type: ignore[assignment]

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of the numbers over ``step`` and of the last fields.

        It needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Distance, volumes, peak, area, approach and load over step; depths and pressure of the
            last state on x and y.
        """
        state, packed = _packed(self.to_dict())
        last = self.states[-1]
        columns: dict[str, object] = {
            row.name: (row.dims, row.of(self)) for row in self._step_rows()
        }
        fields = {row: row.of(last) for row in last._QUANTITIES}
        pressure = next(row for row in last.solution._QUANTITIES if row.name == "pressure")
        fields[pressure] = last.solution.pressure
        columns |= {row.name: (row.dims, values) for row, values in fields.items()}
        columns[PACKED] = ("number",), packed
        grid = last.solution.grid
        coordinates = {"x": grid.x, "y": grid.y, "member": ["body", "counterbody"]}
        rows = [dataclasses.replace(row, told=f"last {row.words}") for row in fields]
        units = [(row, self._si(row)) for row in (*self._step_rows(), *rows)]
        return files.dataset(self._TITLE, units, columns, coordinates, state)

    def _step_rows(self) -> list[Quantity]:
        """Return the quantities of each step."""
        return [row for row in self._QUANTITIES if row.dims]

    def _si(self, row: Quantity) -> str:
        """Return the SI unit of a quantity of this history."""
        if row.name == "distance":
            return self.unit if self.unit == "m" else ""
        return row.si(line=self.states[0].solution.grid.is_line)

    @classmethod
    def _unpacked(cls, state: dict[str, Any], arrays: Mapping[str, Field]) -> dict[str, Any]:
        """Return the state with the arrays of its file in their places."""
        numbers = _arrays(arrays[PACKED])
        return _filled(state, numbers)  # type: ignore[no-any-return]

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        with values.refusing(cls.__name__):
            entries = {
                name: tuple(
                    kind.from_dict(values.heading(kind.__name__) | entry) for entry in state[name]
                )
                for name, kind in (("states", WearState), ("events", WearThrough))
            }
            report = WearReport.from_dict(values.heading("WearReport") | state["report"])
            if not entries["states"]:
                raise ValueError("states must hold one at least")
            entries |= cls._checked({name: state.get(name) for name in cls._LATER})
            return cls(unit=state["unit"], inputs=dict(state["inputs"]), report=report, **entries)  # type: ignore[arg-type]

    @classmethod
    def _kept(cls, records: Mapping[str, Record]) -> Self:
        """Return the history that a journal keeps."""
        with values.refusing(cls.__name__):
            states = []
            for record in records.values():
                numbers = np.frombuffer(base64.b64decode(record["numbers"]))
                states += _filled(record["states"], _arrays(numbers))
            beside = {key: record[key] for key in ("events", "unit", "report", "inputs")}
        return cls._restored({"states": states, **beside})

    def _keep(self, journal: Journal, first: int = 0) -> None:
        """Add states to a journal, each with all that is known beside it."""
        for place in range(first, len(self)) if journal.path else ():
            single = dataclasses.replace(self, states=(self.states[place],))
            plain, numbers = _packed(single._state())
            text = base64.b64encode(numbers.tobytes()).decode()
            journal.append({"key": str(place), "numbers": text, **plain})

    def _state(self) -> dict[str, object]:
        return {
            "states": [
                state._state() | {"solution": _bare(state.solution)} for state in self.states
            ],
            "events": [event._state() for event in self.events],
            "unit": self.unit,
            "report": self.report._state(),
            "inputs": dict(self.inputs),
            "required_distance": self.required_distance,
        }

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw sections of the worn depth through its deepest place, over the distance.

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
        >>> history = nacre.wear(nacre.Sphere(5e-3), steel, load=10.0, rate=1e-16, sliding=1.0)
        >>> history.plot().get_xlabel()
        'x [µm]'
        """
        from nacre import plot

        return plot.wear(self, axes)

    def animate(self, path: str | os.PathLike[str], *, frames_per_second: float = 5.0) -> Path:
        """Write sections of pressure and worn depth, a picture for each state, as a film.

        Parameters
        ----------
        path : str or os.PathLike
            File to write, ``.gif``, or ``.mp4`` where ffmpeg is installed.
        frames_per_second : float, optional
            States in a second, above 0.

        Returns
        -------
        pathlib.Path
            Path of the file.

        Raises
        ------
        ValueError
            If the ending is another, or the number is not above 0.

        Examples
        --------
        >>> import tempfile
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> ball = nacre.Sphere(5e-3)
        >>> history = nacre.wear(ball, steel, load=10.0, rate=1e-16, sliding=1.0, steps=2)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     history.animate(f"{folder}/wear.gif").stat().st_size > 0
        True
        """
        from nacre import plot

        return plot.animate_wear(self, path, frames_per_second)

    def _file_rows(self) -> list[list[object]]:
        """Return the numbers of each state, after their headings."""
        heads, columns = ["step"], [np.arange(len(self.states))]
        for row in self._step_rows():
            numbers = np.asarray(getattr(self, row.name))
            for body, name in enumerate(("body", "counterbody") if numbers.ndim == 2 else ("",)):
                heads.append(heading(row, self, name))
                columns.append(numbers[:, body] if numbers.ndim == 2 else numbers)
        return [heads, *(list(row) for row in zip(*(c.tolist() for c in columns), strict=True))]

    def _comments(self) -> dict[str, object]:
        return {"verdict": self.verdict().words}

    def _inputs(self) -> Rows:
        contact = self.states[0].solution
        rows = [r for r in contact._inputs() if r.key.split(".")[0] in (*BODIES, "grid")]
        units = keyword_units(Motion, Rates, line=contact.grid.is_line)
        for name, text in self.inputs.items():
            value = _value(text)
            if isinstance(value, str) and units.get(name):  # of a history in parts
                value = f"{text} {symbol(units[name])}"
            if name == "sliding" and isinstance(value, float):
                rows.append(remark("sliding", travelled(value, "m")))
            elif name not in BODIES:
                rows += input_rows({name: value}, units)
        return rows

    def _charts(self) -> list[Picture]:
        """Return the charts over the distance, those of the last contact, and the worn depths."""
        axis = Axis("distance", self.unit if self.unit == "m" else "")
        over_distance = [
            Chart(
                f"{words} over the distance.",
                [Curve(self.distance, numbers)],
                (axis, Axis(words.lower(), unit)),
            )
            for words, numbers, unit in (
                ("Deepest wear", self.deepest.sum(axis=1), "m"),
                ("Peak pressure", self.peak_pressure, "Pa"),
            )
        ]
        return [*over_distance, *contact_charts(self.states[-1].solution), self._depth_chart()]

    def _report_rows(self) -> Rows:
        return [*self._rows(), *self._remarks()]

    def _tables(self) -> Sequence[Table]:
        return [table("Steps", self._file_rows())]

    def _model(self) -> Rows:
        return [remark("model", MODEL.format(THICKNESSES[self._thickness]))]

    def _depth_chart(self) -> Chart:
        """Return the chart of depths of both bodies together, through the deepest in the end."""
        count = min(MOST_SECTIONS, len(self))
        numbers = np.unique(np.linspace(0, len(self) - 1, count).round().astype(int))
        depths = [s.depth + s.counter_depth for s in (self.states[k] for k in numbers)]
        grid, last = self.states[-1].solution.grid, depths[-1]
        i, j = np.unravel_index(int(last.argmax()), last.shape)
        x, cells = (grid.y, np.s_[i, :]) if grid.is_line else (grid.x, np.s_[:, j])
        curves = [
            Curve(x, depth[cells], travelled(self.states[k].distance, self.unit), "graded")
            for k, depth in zip(numbers, depths, strict=True)
        ]
        down = (1.0 + HEADROOM) * float(last.max()) or 1.0, 0.0
        axes = Axis("y" if grid.is_line else "x", "m"), Axis("depth removed", "m", down)
        return Chart("Wear depth through its largest final value.", curves, axes)

    def _rows(self) -> list[Row]:
        line = self.states[0].solution.grid.is_line
        report, last = self.report, self.states[-1]
        volumes = _alike(self.volume[-1], "m²" if line else "m³")
        error = report.step_error
        errors = "" if error is None else f", error of a cell {error:.1g} of the peak"
        texts = [
            ("distance", travelled(last.distance, self.unit)),
            ("worn volume", f"{volumes[0]} of the body, {volumes[1]} of the counterbody"),
            ("largest depth", written(float(self.deepest[-1].max()), "m")),
            ("peak pressure", _fromto(self.peak_pressure, "Pa")),
            ("contact area", _fromto(self.contact_area, "m" if line else "m²")),
            *[("worn through", event._words(self._travelled(event))) for event in self.events],
            ("steps", f"{report.steps}{errors}"),
        ]
        if report.thickness_error is not None:
            words = THICKNESSES[self._thickness]
            texts.append(("layers", f"{words}, error {report.thickness_error:.1g} of the peak"))
        return [remark(*text) for text in texts]

    def _remarks(self) -> list[Row]:
        return [remark("ended", "as requested" if self.report.converged else "stopped")]

    def __repr__(self) -> str:
        """Return the verdict in a line."""
        return f"<WearHistory of {len(self.states)} states: {self.verdict().words}>"


PACKED = "packed"
"""Name of the variable that holds all arrays of a history of wear, one after the other."""


def _bare(solution: Solution) -> dict[str, object]:
    state = solution.to_dict()
    return {key: value for key, value in state.items() if key not in values.heading("Solution")}


def _packed(state: Any) -> tuple[Any, Field]:
    """Return a state with the shapes of its arrays in their places, and the numbers of all."""
    arrays: list[Field] = []

    def shapes(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            arrays.append(np.ravel(value).astype(np.float64))
            return {"shape": list(value.shape)}
        if isinstance(value, dict):
            return {key: shapes(item) for key, item in value.items()}
        return [shapes(item) for item in value] if isinstance(value, list | tuple) else value

    plain = shapes(state)
    return plain, np.concatenate(arrays)


def _arrays(numbers: Field) -> Callable[[Sequence[int]], Field]:
    """Return a function that gives the next array of a shape out of these numbers."""
    place = 0

    def take(shape: Sequence[int]) -> Field:
        nonlocal place
        count = math.prod(shape)
        values = numbers[place : place + count]
        place += count
        return values.reshape(tuple(shape))

    return take


def _filled(value: Any, take: Callable[[Sequence[int]], Field]) -> Any:
    if isinstance(value, dict):
        if value.keys() == {"shape"} and isinstance(value["shape"], list):
            return take(value["shape"])
        return {key: _filled(item, take) for key, item in value.items()}
    return [_filled(item, take) for item in value] if isinstance(value, list) else value


def _value(text: str) -> object:
    """Return the value of an input of a history; its text if that is in words."""
    try:
        value = ast.literal_eval(text)
    except (SyntaxError, ValueError):
        return text
    if not isinstance(value, dict):
        return value
    return {f"layer {k + 1}" if isinstance(k, int) else k: item for k, item in value.items()}


def _fromto(numbers: Field, unit: str) -> str:
    return " to ".join(_alike(numbers[[0, -1]], unit))


def _alike(numbers: Field, unit: str) -> list[str]:
    """Return numbers in the unit of the largest one."""
    scale = Scale.of(float(np.abs(numbers).max()), unit)
    return [f"{rounded(scale.factor * number, 4)} {scale.unit}" for number in numbers]


def layer_names(body: object) -> list[str]:
    """Return numbers and names of the layers of a body."""
    layers = body.layers if isinstance(body, core.HalfSpace) else ()
    return [display.layer_name(number, layer.name) for number, layer in enumerate(layers)]
