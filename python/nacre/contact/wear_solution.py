"""Histories of wear: what sliding takes off both bodies, and when a layer is through."""

from __future__ import annotations

import base64
import dataclasses
import json
import math
import os
import time
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import MISSING, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Required, Self

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.disk import check_folder
from nacre._tools.groups import Group, keyword
from nacre._tools.notices import warn
from nacre._tools.progress import check_progress, lasting
from nacre._tools.typing import AnyPath, Body, Field, Matrix
from nacre._tools.units import Scale, rounded, symbol, system, travelled, written
from nacre.contact.arguments import (
    MOTION,
    STEP,
    FrictionOptions,
    FrictionStep,
    GridKeywords,
    Motion,
    MotionKeywords,
    Rolling,
    Setup,
    SolveOptions,
)
from nacre.contact.solution import Solution
from nacre.results import display, files, values
from nacre.results.base import Result, same
from nacre.results.journal import Journal, Record
from nacre.results.parameters import INPUTS
from nacre.results.quantities import WEAR
from nacre.results.report import Picture, Rows, Table, contact_pictures, table
from nacre.results.rows import Row, remark
from nacre.results.shown import Shown
from nacre.results.svg import Axis, Curve, lines
from nacre.results.tables import heading
from nacre.results.verdict import MARGIN, Level, Verdict, level_of, number

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Rate = float | Mapping[str | int, float]
"""Wear rate of a body, or of its layers by number, name and "substrate"."""
Scheme = Literal["trapezoidal", "euler"]
Thickness = Literal["frozen", "first order"]
Unit = Literal["m", "cycles", "passes"]
MODEL = (
    "wear by Archard's law, with a rate that is known; no third body, no running-in of the rate, "
    "no change of friction, and layers {}: `thickness_error` says what that costs"
)
DISTANCES = ("sliding", "cycles", "passes")
"""Keywords of the distance, one of which is given."""
STEP_TOLERANCE = 1e-3
"""Error that a step may add by default."""
SAME = ("shape", "body", "counterbody", "thickness")
"""Inputs that stay where a history goes on; so do the kind of distance, and load or approach."""
MOST_ENDS = 1_000_000
"""Largest number of equal steps: some days of line contacts on coarse grids."""
UNASKED = "No distance is required: verdict_for(distance) judges it."
ROUNDING = 1e-12
"""Part of a distance below which another is none."""
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


@dataclass(frozen=True, eq=False)
class Wearing:
    """Bodies and their wear rates."""

    body: Body
    counterbody: Body | None
    rates: Rates
    grows: bool
    """Whether the grid grows with the contact."""


@dataclass(frozen=True, eq=False)
class Sliding(Group):
    """What slides how far: one of three distances, and where it slips."""

    sliding: float | None = keyword("m")
    cycles: float | None = keyword()
    slide: Mapping[str, object] | None = keyword()
    passes: float | None = keyword()
    roll: Mapping[str, object] | None = keyword()
    slip: Matrix | None = keyword()

    def __post_init__(self) -> None:
        """Raise a `ValueError` unless one distance is given, with what belongs to it."""
        if len(known := [name for name in DISTANCES if getattr(self, name) is not None]) != 1:
            several = " and ".join(known) or "none"
            raise ValueError(f"one of sliding, cycles and passes must be given, got {several}")
        distance = core.real(known[0], getattr(self, known[0]))
        if not 0.0 <= distance < math.inf:
            raise ValueError(f"{known[0]} must be finite and at least 0, got {distance:g}")
        for name, one in (("slide", "cycles"), ("roll", "passes")):
            if (getattr(self, name) is None) != (getattr(self, one) is None):
                raise ValueError(f"{name} must be given with {one}, and {one} with {name}")
            if not isinstance(keywords := getattr(self, name), Mapping | None):
                raise TypeError(f"{name} must be a mapping of keywords, got {keywords!r}")
        if self.slip is not None and self.sliding is None:
            raise ValueError("slip must be given with sliding: slide and roll have their own")
        if self.slip is not None:
            core.real_array("slip", self.slip)

    @property
    def unit(self) -> Unit:
        """Unit of the distance."""
        return "cycles" if self.cycles is not None else "m" if self.passes is None else "passes"

    @property
    def name(self) -> str:
        """Keyword of the distance."""
        return "sliding" if self.unit == "m" else self.unit

    @property
    def distance(self) -> float:
        """The distance."""
        return core.real(self.name, getattr(self, self.name))

    @property
    def friction(self) -> FrictionOptions | None:
        """How tractions are found."""
        keywords = self.slide if self.roll is None else self.roll
        return None if keywords is None else FrictionOptions.of(keywords)

    @property
    def cycle(self) -> list[FrictionStep] | None:
        """Steps of one cycle."""
        if self.slide is None:
            return None
        rest = self._rest(self.slide, ("steps", "friction"))
        given = rest.get("steps", ())
        if not isinstance(given, Sequence) or not all(isinstance(one, Mapping) for one in given):
            raise TypeError(f"steps of slide must be a list of mappings, got {given!r}")
        steps = [{**step} for step in given]
        if not steps or rest.get("friction") is None:
            raise ValueError("slide must have friction, and steps of one cycle")
        if wrong := {key for step in steps for key in step} - {*STEP} | {
            key for step in steps for key in step if key in MOTION
        }:
            raise ValueError(f"steps of slide must not have {', '.join(sorted(map(str, wrong)))}")
        steps[0].setdefault("friction", rest["friction"])
        return [FrictionStep.of(step) for step in steps]

    @property
    def rolling(self) -> Rolling | None:
        """Rolling of one pass."""
        if self.roll is None:
            return None
        names = ("friction", "creepage", "force", "spin", "direction", "order")
        rest = self._rest(self.roll, names)
        return Rolling(self.motion or Motion(), **rest)

    motion: Motion | None = None
    """Motion along z, for rolling."""

    @staticmethod
    def _rest(keywords: Mapping[str, object], names: Sequence[str]) -> dict[str, Any]:
        """Return those keywords that are no options, which must be among the names."""
        options = ("tolerance", "max_convolutions", "coupling")
        rest = {key: value for key, value in keywords.items() if key not in options}
        if wrong := set(rest) - set(names):
            raise ValueError(f"slide and roll must not have {', '.join(sorted(map(str, wrong)))}")
        return rest


@dataclass(frozen=True, eq=False)
class WearControl(Group):
    """Steps of a history of wear, and where it begins and ends."""

    steps: int | npt.ArrayLike | Literal["auto"] = keyword(default="auto")
    step_tolerance: float = keyword(default=STEP_TOLERANCE)
    scheme: Scheme = keyword(default="trapezoidal")
    thickness: Thickness = keyword(default="frozen")
    initial: WearHistory | Matrix | None = keyword("m")
    until: Literal["through"] | None = keyword()
    store: AnyPath | None = keyword()
    tolerance: float = keyword(default=1e-8)
    max_iterations: int | None = keyword()
    progress: WearProgress | None = keyword()

    def __post_init__(self) -> None:
        """Raise an error unless it ends in one of the ways that there are, and can be stored."""
        if not (self.until is None or (isinstance(self.until, str) and self.until == "through")):
            raise ValueError(f'until must be None or "through", got {self.until!r}')
        if not isinstance(self.store, str | os.PathLike | None):
            raise TypeError(f"store must be a path, got {self.store!r}")
        if self.store is not None and Path(self.store).suffix.lower() != ".nc":
            raise ValueError(f"store must end in .nc, got {str(self.store)!r}")
        tolerance = core.real("step_tolerance", self.step_tolerance)
        if not isinstance(self.steps, str) and tolerance != STEP_TOLERANCE:
            raise ValueError(
                "step_tolerance must not be given beside steps, whose lengths it would choose, "
                f"got {tolerance:g}"
            )
        check_progress(self.progress)

    @property
    def journal(self) -> Path | None:
        """File beside the store to which each state is added."""
        return None if self.store is None else Path(self.store).with_suffix(".journal")

    def stored(self) -> WearHistory | None:
        """Return the history of the store; None where there is none."""
        if self.store is None or not Path(self.store).is_file():
            return None
        if not isinstance(stored := files.load(self.store), WearHistory):
            raise ValueError(f"store must be a history of wear, got a {type(stored).__name__}")
        return stored

    def depths(self, history: WearHistory | None) -> tuple[Any, Any] | None:
        """Return the depths removed from both bodies before."""
        if history:
            return history.states[-1].depth, history.states[-1].counter_depth
        if self.initial is None or isinstance(self.initial, WearHistory):
            return None
        depth = core.real_array("initial", self.initial)
        return depth, np.zeros(depth.shape)

    def ends(self, distance: float) -> list[float] | None:
        """Return the ends of the steps; None where they are chosen."""
        if isinstance(self.steps, str):
            if self.steps != "auto":
                raise ValueError(
                    f'steps must be "auto", a number or their ends, got {self.steps!r}'
                )
            return None
        ends = core.real_array("steps", self.steps)
        if ends.ndim > 1 or ends.size == 0:
            raise ValueError(
                f'steps must be "auto", a number or their ends, got an array of shape {ends.shape}'
            )
        if ends.ndim == 0:
            count = core.integer("steps", self.steps)
            if not 1 <= count <= MOST_ENDS:
                raise ValueError(f"steps must be at least 1 and at most {MOST_ENDS}, got {count}")
            ends = distance * np.arange(1, count + 1) / count
        if not math.isclose(ends[-1], distance, rel_tol=1e-12):
            raise ValueError(
                f"steps must end at {distance:g}, the whole distance, got {ends[-1]:g}"
            )
        return [float(end) for end in ends] if distance > 0 else []


class WearKeywords(MotionKeywords, total=False):
    """Keywords of `Contact.wear`."""

    rate: Required[Rate]
    counter_rate: Rate
    sliding: float | None
    cycles: float | None
    slide: Mapping[str, object] | None
    passes: float | None
    roll: Mapping[str, object] | None
    slip: Matrix | None
    steps: int | npt.ArrayLike | Literal["auto"]
    step_tolerance: float
    scheme: Scheme
    thickness: Thickness
    initial: WearHistory | Matrix | None
    until: Literal["through"] | None
    store: AnyPath | None
    tolerance: float
    max_iterations: int | None
    progress: WearProgress | None


class PlannedWearKeywords(WearKeywords, GridKeywords):
    """Keywords of `nacre.wear`."""


KEYWORDS = (Setup, Motion, SolveOptions, FrictionStep, Rolling, FrictionOptions, Rates, Sliding)
"""Groups of the keywords of contacts that are numbers of a case."""


@dataclass(frozen=True, eq=False)
class WearOptions:
    """What wears how far, as the compiled module reads it."""

    rate: list[float]
    counter_rate: list[float]
    distance: float
    slip: Matrix | None
    cycle: list[FrictionStep] | None
    rolling: Rolling | None
    friction: FrictionOptions | None
    steps: list[float] | None
    step_tolerance: float
    scheme: str
    thickness: str
    until_through: bool
    initial: tuple[Any, Any] | None
    goes_on: bool
    tolerance: float
    max_iterations: int | None
    grows: bool


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
        return f"<WearThrough: {self._words(None)}>"

    def _words(self, unit: Unit | None) -> str:
        """Return layer, distance in the unit of a history, and place."""
        at = ", ".join(written(x, "m") for x in self.position)
        distance = self._travelled(unit) if unit else f"{self.distance:.4g}"
        return f"{self.layer} of the {self.body} after {distance}, at ({at})"

    def _travelled(self, unit: Unit) -> str:
        """Return the distance and its error in the unit of a history."""
        distance = travelled(self.distance, unit)
        if self.uncertainty is None:
            return distance
        return f"{distance} ± {travelled(self.uncertainty, unit)}"


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


@dataclass(frozen=True, repr=False, eq=False)
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
    depth: Field
    """Depth that is removed from the body, ``(nx, ny)`` [m]."""
    counter_depth: Field
    """Depth that is removed from the counterbody, ``(nx, ny)`` [m]."""
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
    _QUANTITIES = WEAR

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

    @property
    def distance(self) -> Field:
        """Sliding distance [m], cycles or passes, from 0, ``(n + 1,)``."""
        return self._per_state(lambda state: state.distance)

    @property
    def volume(self) -> Field:
        """Volume removed from body and counterbody [m³], ``(n + 1, 2)``; [m²] in line contact."""
        return self._per_state(lambda state: state.volume)

    @property
    def peak_pressure(self) -> Field:
        """Largest pressure [Pa], ``(n + 1,)``."""
        return self._per_state(lambda state: state.solution.peak_pressure)

    @property
    def contact_area(self) -> Field:
        """Area in contact [m²], ``(n + 1,)``; [m] in line contact."""
        return self._per_state(lambda state: state.solution.contact_area)

    @property
    def approach(self) -> Field:
        """Approach of the origin [m], ``(n + 1,)``."""
        return self._per_state(lambda state: state.solution.approach)

    @property
    def load(self) -> Field:
        """Normal force [N], ``(n + 1,)``; [N/m] in line contact."""
        return self._per_state(lambda state: state.solution.load)

    @property
    def deepest(self) -> Field:
        """Largest depth removed from body and counterbody [m], ``(n + 1, 2)``."""
        return self._per_state(lambda state: (state.depth.max(), state.counter_depth.max()))

    @property
    def life(self) -> WearThrough | None:
        """First layer that is through; None where none is."""
        return self.events[0] if self.events else None

    @property
    def worn_volume(self) -> float:
        """Volume removed from both bodies at the end [m³]; [m²] in line contact."""
        return float(self.volume[-1].sum())

    @property
    def warnings(self) -> tuple[str, ...]:
        """What limits the validity, and was warned of."""
        return self.report.warnings

    @property
    def verdict(self) -> Verdict:
        """Verdict: whether a layer is through, after which distance and where.

        It is unknown: `verdict_for` judges a distance that is required.
        """
        return self._judged(None)

    def verdict_for(self, required: float) -> Verdict:
        """Return the verdict on a distance after which no layer may be through.

        Parameters
        ----------
        required : float
            Distance [m], cycles or passes, above 0.

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
        >>> history.verdict_for(0.5).level
        'good'
        """
        distance = core.real("required", required)
        if not 0 < distance < math.inf:
            raise ValueError(f"required must be above 0 and finite, got {distance:g}")
        return self._judged(distance)

    def _judged(self, required: float | None) -> Verdict:
        """Return the verdict, on a required distance where there is one."""
        reached, life = float(self.distance[-1]), self.life
        needed = "" if required is None else f", {travelled(required, self.unit)} required"
        report, worn = self.states[0].solution.report, float(self.deepest[-1].max())
        has_layers = any(map(_layers, (report.body, report.counterbody)))
        lines = () if required is not None or not has_layers else (UNASKED,)
        level: Level = "unknown"
        if life is None:
            end = travelled(reached, self.unit)
            words = f"{'No layer is through' if has_layers else 'Worn'} after {end}{needed}"
            words += f": {number(worn, 'm')} {'worn ' if has_layers else ''}at most."
            if not worn > 0:
                return Verdict("unknown", f"Cannot tell: nothing has worn after {end}.", lines)
            rings = any(state.rings for state in self.states)
            if required is not None and has_layers and self.report.converged and not rings:
                level = "good" if reached >= MARGIN * required else "fair"
                level = level if reached >= required else "unknown"
            return Verdict(level, words, lines)
        axes = "y" if self.states[0].solution.grid.is_line else "xy"
        places = [f"{axis} = {number(life.position['xy'.index(axis)], 'm')}" for axis in axes]
        when = f"after {life._travelled(self.unit)}" if life.distance > 0 else "from the start"
        words = f"{life.layer} of the {life.body}: through {when} at {', '.join(places)}{needed}."
        if required is None:
            return Verdict("unknown", words, lines, None, life.layer, None)
        factor = life.distance / required
        share = None if not factor or life.uncertainty is None else life.uncertainty / life.distance
        return Verdict(level_of(factor, share), words, lines, factor, life.layer, share)

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
        rest = [{**one._state(), "states": len(one)} for one in (self, other)]
        return same(*rest) and self.states == other.states

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
            row.name: (row.dims, getattr(self, row.name))
            for row in WEAR
            if row.dims[:1] == ("step",)
        }
        columns |= {
            "depth": (("x", "y"), last.depth),
            "counter_depth": (("x", "y"), last.counter_depth),
            "pressure": (("x", "y"), last.solution.pressure),
            PACKED: (("number",), packed),
        }
        grid = last.solution.grid
        coordinates = {"x": grid.x, "y": grid.y, "member": ["body", "counterbody"]}
        units = [(row, self._si(row)) for row in WEAR]
        return files.dataset(self._TITLE, units, columns, coordinates, state)

    def _si(self, row: Any) -> str:
        """Return the SI unit of a quantity of this history."""
        if row.name == "distance":
            return self.unit if self.unit == "m" else ""
        return row.si(line=self.states[0].solution.grid.is_line)  # type: ignore[no-any-return]

    @classmethod
    def _unpacked(cls, state: dict[str, Any], arrays: Mapping[str, Field]) -> dict[str, Any]:
        """Return the state with the arrays of its file in their places."""
        numbers = _arrays(arrays[PACKED])
        return _filled(state, numbers)  # type: ignore[no-any-return]

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        with values.refusing(cls.__name__):
            parts = {
                name: tuple(
                    kind.from_dict(values.heading(kind.__name__) | one) for one in state[name]
                )
                for name, kind in (("states", WearState), ("events", WearThrough))
            }
            report = WearReport.from_dict(values.heading("WearReport") | state["report"])
            if not parts["states"]:
                raise ValueError("states must hold one at least")
            return cls(unit=state["unit"], inputs=dict(state["inputs"]), report=report, **parts)  # type: ignore[arg-type]

    @classmethod
    def _kept(cls, records: Mapping[str, Record]) -> Self:
        """Return the history that a journal keeps."""
        with values.refusing(cls.__name__):
            states = []
            for record in records.values():
                numbers = np.frombuffer(base64.b64decode(record["numbers"]))
                states += _filled(record["states"], _arrays(numbers))
            rest = {key: record[key] for key in ("events", "unit", "report", "inputs")}
        return cls._restored({"states": states, **rest})

    def _keep(self, journal: Journal, first: int = 0) -> None:
        """Add states to a journal, each with all that is known beside it."""
        for place in range(first, len(self)) if journal.path else ():
            one = dataclasses.replace(self, states=(self.states[place],))
            plain, numbers = _packed(one._state())
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
        for row in (row for row in WEAR if row.dims[:1] == ("step",)):
            numbers = np.asarray(getattr(self, row.name))
            for part, name in enumerate(("body", "counterbody") if numbers.ndim == 2 else ("",)):
                heads.append(heading(row, self, name))
                columns.append(numbers[:, part] if numbers.ndim == 2 else numbers)
        return [heads, *(list(row) for row in zip(*(c.tolist() for c in columns), strict=True))]

    def _comments(self) -> dict[str, object]:
        return {"verdict": self.verdict.words}

    def _inputs(self) -> Rows:
        return [remark(name, self._input(name, text)) for name, text in self.inputs.items()]

    def _pictures(self) -> Sequence[Picture]:
        axis = Axis("distance", self.unit if self.unit == "m" else "")
        pictures = [
            Picture(
                f"{words} over the distance.",
                lines([Curve(self.distance, numbers)], (axis, Axis(words.lower(), unit))),
            )
            for words, numbers, unit in (
                ("Deepest wear", self.deepest.sum(axis=1), "m"),
                ("Peak pressure", self.peak_pressure, "Pa"),
            )
        ]
        return [*pictures, *contact_pictures(self.states[-1].solution), self._depth_picture()]

    def _report_rows(self) -> Rows:
        return [*self._rows(), *self._remarks()]

    def _tables(self) -> Sequence[Table]:
        return [table("Steps", self._file_rows())]

    def _model(self) -> Rows:
        return [remark("model", MODEL.format(THICKNESSES[self._thickness]))]

    def _depth_picture(self) -> Picture:
        """Return the picture of the last depth of both bodies together, through its deepest."""
        last = self.states[-1]
        grid, depth = last.solution.grid, last.depth + last.counter_depth
        i, j = np.unravel_index(int(depth.argmax()), depth.shape)
        curve = Curve(grid.y, depth[i]) if grid.is_line else Curve(grid.x, depth[:, j])
        axes = Axis("y" if grid.is_line else "x", "m"), Axis("depth removed", "m")
        return Picture("Depth removed in the end, through the deepest.", lines([curve], axes))

    def _input(self, name: str, text: str) -> str:
        """Return an input in words with its unit."""
        if name == "sliding":
            return travelled(float(text), "m")
        unit = INPUTS[name] if name in ("rate", "counter_rate", "load", "approach") else ""
        if name == "load" and self.states[0].solution.grid.is_line:
            unit = "N/m"
        return f"{text} {symbol(unit)}".rstrip()

    def _rows(self) -> list[Row]:
        line = self.states[0].solution.grid.is_line
        report, last = self.report, self.states[-1]
        volumes = _alike(self.volume[-1], "m²" if line else "m³")
        error = report.step_error
        errors = "" if error is None else f", error of a cell {error:.1g} of the peak"
        texts = [
            ("distance", travelled(last.distance, self.unit)),
            ("worn volume", f"{volumes[0]} of the body, {volumes[1]} of the counterbody"),
            ("deepest", written(float(self.deepest[-1].max()), "m")),
            ("peak pressure", _fromto(self.peak_pressure, "Pa")),
            ("contact area", _fromto(self.contact_area, "m" if line else "m²")),
            *[("through", event._words(self.unit)) for event in self.events],
            ("steps", f"{report.steps}{errors}"),
        ]
        if report.thickness_error is not None:
            words = THICKNESSES[self._thickness]
            texts.append(("layers", f"{words}, error {report.thickness_error:.1g} of the peak"))
        return [remark(*text) for text in texts]

    def _remarks(self) -> list[Row]:
        return [remark("ended", "at its end" if self.report.converged else "stopped")]

    def __repr__(self) -> str:
        """Return the verdict in a line."""
        return f"<WearHistory of {len(self.states)} states: {self.verdict.words}>"


PACKED = "packed"
"""Name of the variable that holds all arrays of a history of wear, one after the other."""


def _bare(solution: Solution) -> dict[str, object]:
    state = solution.to_dict()
    return {key: value for key, value in state.items() if key not in values.heading("Solution")}


def _packed(state: Any) -> tuple[Any, Field]:
    """Return a state with the shapes of its arrays in their places, and the numbers of all."""
    parts: list[Field] = []

    def shapes(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            parts.append(np.ravel(value).astype(np.float64))
            return {"shape": list(value.shape)}
        if isinstance(value, dict):
            return {key: shapes(item) for key, item in value.items()}
        return [shapes(item) for item in value] if isinstance(value, list | tuple) else value

    plain = shapes(state)
    return plain, np.concatenate(parts)


def _arrays(numbers: Field) -> Callable[[Sequence[int]], Field]:
    """Return a function that gives the next array of a shape out of these numbers."""
    place = 0

    def take(shape: Sequence[int]) -> Field:
        nonlocal place
        count = math.prod(shape)
        part = numbers[place : place + count]
        place += count
        return part.reshape(tuple(shape))

    return take


def _filled(value: Any, take: Callable[[Sequence[int]], Field]) -> Any:
    if isinstance(value, dict):
        if value.keys() == {"shape"} and isinstance(value["shape"], list):
            return take(value["shape"])
        return {key: _filled(item, take) for key, item in value.items()}
    return [_filled(item, take) for item in value] if isinstance(value, list) else value


def _fromto(numbers: Field, unit: str) -> str:
    return " to ".join(_alike(numbers[[0, -1]], unit))


def _alike(numbers: Field, unit: str) -> list[str]:
    """Return numbers in the unit of the largest one."""
    scale = Scale.of(float(np.abs(numbers).max()), unit)
    return [f"{rounded(scale.factor * number, 4)} {scale.unit}" for number in numbers]


def rates(name: str, rate: Any, body: Body | None) -> list[float]:
    """Return the rates of the layers of a body and of its substrate, or one for all."""
    if isinstance(rate, int | float | np.number) and not isinstance(rate, bool):
        return [float(rate)]
    if not isinstance(body, core.HalfSpace):
        raise ValueError(f"{name} must be a number for a body without layers, got {rate!r}")
    by_layer: Any = core.layer_values(body, name, rate)
    count = len(body.layers) + 1
    by_layer = [*by_layer, *[None] * (count - len(by_layer))]
    names = [*_layers(body), "substrate"]
    elastic = not isinstance(body.substrate, core.Rigid | core.Free)
    missing = [one for one, value in zip(names, by_layer, strict=True) if value is None]
    if not elastic and missing == ["substrate"]:
        by_layer[-1], missing = 0.0, []
    if missing:
        raise ValueError(f"{name} must hold a rate for {', '.join(missing)}, got {rate!r}")
    return [float(value) for value in by_layer]


def _layers(body: object) -> list[str]:
    """Return numbers and names of the layers of a body."""
    layers = body.layers if isinstance(body, core.HalfSpace) else ()
    return [display.layer_name(number, layer.name) for number, layer in enumerate(layers)]


def wear_history(
    shape: core.Shape,
    motion: Motion,
    bodies: Wearing,
    sliding: Sliding,
    control: WearControl,
    on: Setup | core.Plan,
) -> WearHistory:
    """Return the history of wear of a shape, after that to go on from."""
    sliding = dataclasses.replace(sliding, motion=motion)
    stored = control.stored()
    if control.journal is not None:
        check_folder(control.journal)
    with Journal(control.journal, "history of wear") as journal:
        kept = WearHistory._kept(journal.records) if journal.records else None
        journal.records.clear()
        if kept and len(kept) >= len(stored or ()):
            stored = kept
        elif stored:
            stored._keep(journal)
        return _gone_on(shape, motion, bodies, sliding, control, on, journal, stored)


def _gone_on(
    shape: core.Shape,
    motion: Motion,
    bodies: Wearing,
    sliding: Sliding,
    control: WearControl,
    on: Setup | core.Plan,
    journal: Journal,
    stored: WearHistory | None,
) -> WearHistory:
    """Return the history of wear after a stored one, or after that to go on from."""
    start = time.perf_counter()
    initial = control.initial if isinstance(control.initial, WearHistory) else None
    if initial and stored and len(stored) < len(initial):  # killed before it began
        stored = None
    before = stored or initial
    inputs = _inputs(shape, motion, bodies, sliding, control)
    base = 0.0
    if initial is not None:
        inputs, base = _joined(initial, inputs, sliding), float(initial.distance[-1])
    if stored and (other := _other(stored.inputs, inputs)):
        was, now = (one.get(other, "none") for one in (stored.inputs, inputs))
        raise ValueError(f"store must be a history of the same {other}, {now}, got {was}")
    if isinstance(on, Setup) and on.grid is None and before:
        on = dataclasses.replace(on, grid=before.states[-1].solution.grid, max_cells=None)
    own = on.grid if isinstance(on, Setup) else on.grid()
    if before and own != (grid := before.states[-1].solution.grid):
        name = "store" if stored else "initial"
        raise ValueError(f"{name} must be a history on the same grid, {own!r}, got {grid!r}")
    if initial and not stored:
        dataclasses.replace(initial, inputs=inputs)._keep(journal)
    states = list(before.states) if before else []
    events = list(before.events) if before else []
    offset = states[-1].distance if states else 0.0
    ends = control.ends(sliding.distance)
    distance = base + sliding.distance - offset
    if ends is not None:
        ends = [base + end - offset for end in ends if base + end - offset > ROUNDING * offset]
    distance = distance if distance > ROUNDING * offset else 0.0
    options = WearOptions(
        rate=rates("rate", bodies.rates.rate, bodies.body),
        counter_rate=rates("counter_rate", bodies.rates.counter_rate, bodies.counterbody),
        distance=distance,
        slip=sliding.slip,
        cycle=sliding.cycle,
        rolling=sliding.rolling,
        friction=sliding.friction,
        steps=ends,
        step_tolerance=control.step_tolerance,
        scheme=control.scheme,
        thickness=control.thickness,
        until_through=control.until is not None,
        initial=control.depths(before),
        # A store that ends where it was to end does not go on.
        goes_on=before is not None and not stored,
        tolerance=control.tolerance,
        max_iterations=control.max_iterations,
        grows=bodies.grows,
    )
    regrids, earlier = 0, before.report if before else None
    wrong, peak_error = (earlier.step_error if earlier else None) or 0.0, 0.0
    settled = earlier is None or NOT_SETTLED not in earlier.warnings
    members = (bodies.body, bodies.counterbody)
    first_notes = _rate_notes(options)
    for note in first_notes:  # before what may take long
        warn(note)
    idle: set[str] = set()
    if earlier is not None:
        idle = {reason for reason, note in NOTHING_WORN.items() if note in earlier.warnings}

    def history(*, converged: bool, thickness: float | None = None) -> WearHistory:
        report = WearReport(
            steps=len(states) - 1,
            step_error=states[-1].step_error,
            thickness_error=thickness,
            regrids=regrids + (earlier.regrids if earlier else 0),
            converged=converged,
            warnings=(
                *first_notes,
                *(NOTHING_WORN[reason] for reason in sorted(idle)),
                *_notes(
                    states,
                    events,
                    control.thickness,
                    thickness,
                    peak_error=peak_error if options.steps is not None else 0.0,
                    settled=settled,
                ),
            ),
            seconds=time.perf_counter() - start + (earlier.seconds if earlier else 0.0),
        )
        return WearHistory(tuple(states), tuple(events), sliding.unit, report, inputs)

    converged = False
    try:
        steps = core.wear(shape, motion, options, on)
        with lasting("wear", control.progress) as tell:
            for distance, depths, solved, through, step_errors, why_idle, signs, grown in steps:
                error, peak_error = step_errors
                rings, at_event = signs
                if why_idle is not None:
                    idle.add(why_idle)
                regrids, settled = grown, settled and at_event
                if before and distance == 0.0:
                    continue
                state = WearState(
                    offset + distance, *depths, Solution._of(solved, shape), wrong + error, rings
                )
                states.append(state)
                events += [_event(one, offset, wrong, members) for one in through]
                history(converged=False)._keep(journal, len(states) - 1)
                if control.progress is not None:
                    if control.progress(state) is False:
                        break
                elif tell is not None and options.distance > 0:
                    tell(min(distance / options.distance, 1.0))
            else:
                converged = True
        thickness = steps.thickness_error() if converged else None
    except BaseException as error:
        if states:
            error.history = history(converged=False)  # type: ignore[attr-defined]
        raise
    whole = history(converged=converged, thickness=thickness)
    if control.store is not None:
        whole.save(control.store)
    for note in whole.warnings[len(first_notes) :]:
        warn(note)
    return whole


def _rate_notes(options: WearOptions) -> list[str]:
    """Return what is wrong with rates that no test has measured, in the units that are set."""
    size, unit = system().unit("m²/N")
    notes = []
    for name, rates in (("rate", options.rate), ("counter_rate", options.counter_rate)):
        for words, low, high in (("more", MOST_RATE, math.inf), ("less", 0.0, LEAST_RATE)):
            notes += [
                f"{name} is in {unit}, and {rate:.3g} {unit} are {1e9 * size * rate:.3g} "
                f"mm³/(N m), {words} than dry wear takes off: 1 mm³/(N m) is {1e-9 / size:.3g} "
                f"{unit}"
                for rate in [rate for rate in rates if low < rate * size < high][:1]
            ]
    return notes


def _event(
    event: Mapping[str, Any], offset: float, wrong: float, members: tuple[Any, Any]
) -> WearThrough:
    """Return an event after an offset whose pressure was so wrong."""
    kind: Literal["body", "counterbody"] = "body" if event["member"] == "body" else "counterbody"
    layer = _layers(members[kind == "counterbody"])[event["layer"]]
    x, y = event["position"]
    distance = offset + event["distance"]
    error = event["error"] + wrong * distance
    return WearThrough(distance, (x, y), event["layer"], layer, kind, error)


def _inputs(
    shape: object, motion: Motion, bodies: Wearing, sliding: Sliding, control: WearControl
) -> dict[str, str]:
    """Return the inputs in words."""
    initial = None if isinstance(control.initial, WearHistory) else control.initial
    named = {
        "shape": shape,
        "body": bodies.body,
        "counterbody": bodies.counterbody or "rigid",
        **{name: value for name in MOTION if (value := getattr(motion, name)) is not None},
        "rate": bodies.rates.rate,
        "counter_rate": bodies.rates.counter_rate,
        "slide": sliding.slide,
        "roll": sliding.roll,
        "slip": None if sliding.slip is None else np.asarray(sliding.slip, dtype=np.float64),
        sliding.name: sliding.distance,
        "initial": None if initial is None else core.real_array("initial", initial),
        "scheme": control.scheme,
        "thickness": control.thickness,
    }
    return {name: _words(value) for name, value in named.items() if value is not None}


def _words(value: object) -> str:
    """Return a value in words, with the check sum of what they leave out of arrays."""
    text = str(value)
    if "..." not in text:
        return text
    plain = json.dumps(values.encode(value, digest=True))
    return f"{text}, CRC {zlib.crc32(plain.encode()):08x}"


def _joined(before: WearHistory, now: Mapping[str, str], sliding: Sliding) -> dict[str, str]:
    """Return the inputs of a history and of what follows, which has the same bodies and motion.

    Others may differ, and name both and the distance at which they change.
    """
    was, after = before.inputs, float(before.distance[-1])
    place = f"{after:g} {symbol('m') if before.unit == 'm' else before.unit}"
    joined = {}
    for name in dict.fromkeys((*was, *now)):
        first, then = was.get(name, "none"), now.get(name, "none")
        kind = name in (sliding.name, "load", "approach")
        if first != then and (name in SAME or (kind and "none" in (first, then))):
            raise ValueError(f"initial must be a history of the same {name}, {then}, got {first}")
        alike = first == then or name == "initial" or first.endswith(f", then {then}")
        joined[name] = first if alike else f"{first} up to {place}, then {then}"
    return joined | {sliding.name: str(after + sliding.distance)}


def _other(before: Mapping[str, str], now: Mapping[str, str]) -> str | None:
    """Return the first name whose words differ; None where all are alike."""
    names = (*now, *before)
    return next((name for name in names if before.get(name) != now.get(name)), None)


def _notes(
    states: Sequence[WearState],
    events: Sequence[WearThrough],
    model: Thickness,
    error: float | None,
    *,
    peak_error: float,
    settled: bool,
) -> tuple[str, ...]:
    """Return what the user should know."""
    notes = [text for text in states[-1].solution.report.warnings]
    if peak_error > LARGEST_STEP_ERROR:
        cure = ', or scheme="euler"' if any(state.rings for state in states) else ""
        notes.append(
            f"the last peak pressure errs by some {100 * peak_error:.0f} % by the length of the "
            f"steps: take shorter steps{cure}"
        )
    first, last = states[0].solution.load, states[-1].solution.load
    if last < NOTHING_PRESSES * first:
        notes.append(
            "nothing presses any more at this approach, and no more is worn: the load has fallen "
            f"to {last / first:.1g} of the first"
        )
    if not settled:
        notes.append(NOT_SETTLED)
    deepest, width = _deepest(states[-1]), _narrowest(states[-1].solution)
    if deepest > width > 0:
        notes.append(
            f"{number(deepest, 'm')} are worn off a contact that is {number(width, 'm')} wide, "
            "which wear of a surface does not do: look at the rate, which is in m²/N, 1e-9 of "
            "that in mm³/(N m), and at the distance"
        )
    part, frozen = _worn_part(states[-1]), model == "frozen"
    went_on = events and events[0].distance < states[-1].distance
    if went_on or _worn_part(states[0]) >= 1.0:
        rest = "still has it" if frozen else "lacks it there to first order only"
        notes.append(
            f"a layer is through, and the elastic contact {rest}: what follows errs by an unknown "
            "part, to either side"
        )
    elif frozen and error is not None and error > MOST_THINNING:
        notes.append(
            "the worn layer counts as thick as before: the pressure errs by some "
            f"{100 * error:.0f} %"
        )
    elif not frozen and (part > FIRST_ORDER or (error or 0.0) > MOST_THINNING):
        size = "by an unknown part" if error is None else f"by some {100 * error:.2g} %"
        notes.append(
            f"thinner layers count to first order, and {part:.0%} of one is worn: the pressure "
            f"errs {size}"
        )
    return tuple(dict.fromkeys(notes))


def _deepest(state: WearState) -> float:
    """Return the largest depth that is removed from one body."""
    return float(max(state.depth.max(), state.counter_depth.max()))


def _narrowest(solution: Solution) -> float:
    """Return the width of the contact along the axis along which it is narrower; NaN if endless."""
    along_x, along_y = (end - start for start, end in solution.contact_extent)
    return float(along_y if solution.grid.is_line else min(along_x, along_y))


def _worn_part(state: WearState) -> float:
    """Return the largest part of a top layer's thickness that is worn; 0 without layers."""
    report = state.solution.report
    members = ((report.body, state.depth), (report.counterbody, state.counter_depth))
    return max(
        float(depth.max()) / body.layers[0].thickness
        if isinstance(body, core.HalfSpace) and body.layers
        else 0.0
        for body, depth in members
    )


NOT_SETTLED = (
    "the distance at which a layer is through did not settle, and a step ends near it: take "
    "shorter steps"
)
"""Warning of a search for an event that ended before it was there."""
NOTHING_WORN = {
    "sticks": "no cell slips in the steps of slide, and nothing is worn: give more force or shift, "
    "or smaller cells, of which those at the rim slip first",
    "does-not-return": "the steps of slide slip the first time alone, and nothing is worn by "
    "further cycles: give the steps of a cycle, which end where they begin, as to and fro",
}
"""Warnings of cycles that wear nothing, by the reason."""
MOST_RATE = 1e-9
"""Rate [m²/N] from which on there is a warning: 1 mm³/(N m).

Archard's K = κH is at most some 0.1, that of abrasion (NPTEL, course 112104122, lecture 7.5), and
the hardness of soft metals some 0.3 GPa: κ is at most 3e-10 m²/N.
"""
LEAST_RATE = 1e-18
"""Rate [m²/N] below which there is a warning: 1e-9 mm³/(N m), that of the least worn diamond."""
LARGEST_STEP_ERROR = 0.1
"""Error of the peak by the length of given steps from which on there is a warning."""
NOTHING_PRESSES = 1e-3
"""Part of the first load, at a given approach, that is as good as none: a step's usual error."""
MOST_THINNING = 0.05
"""Error of the pressure by the thickness of layers from which on there is a warning."""
FIRST_ORDER = 0.4
"""Part of the thickness up to which thinner layers were compared with exact ones: peaks on hard
coats err by 0.3 to 1.6 %, on soft ones by 4 to 8 %."""
