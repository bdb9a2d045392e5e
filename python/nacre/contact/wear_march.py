"""The march of wear: keywords, steps by the compiled module, stores, and what is warned of."""

from __future__ import annotations

import dataclasses
import json
import math
import os
import time
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Required

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.disk import check_folder
from nacre._tools.groups import Group, keyword
from nacre._tools.notices import warn
from nacre._tools.progress import check_progress, lasting
from nacre._tools.typing import AnyPath, Body, Matrix
from nacre._tools.units import symbol, system
from nacre.contact import plausible
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
from nacre.contact.layers import layer_names, layer_numbers
from nacre.contact.solution import Solution
from nacre.results import files, values
from nacre.results.journal import Journal
from nacre.results.verdict import number

if TYPE_CHECKING:
    pass

from nacre.contact.wear_solution import (
    Rate,
    Rates,
    Scheme,
    Thickness,
    Unit,
    WearHistory,
    WearProgress,
    WearReport,
    WearState,
    WearThrough,
)

DISTANCES = ("sliding", "cycles", "passes")
"""Keywords of the distance, one of which is given."""
STEP_TOLERANCE = 1e-3
"""Error that a step may add by default."""
SAME = ("shape", "body", "counterbody", "thickness")
"""Inputs that stay where a history goes on; so do the kind of distance, and load or approach."""
MOST_ENDS = 1_000_000
"""Largest number of equal steps: some days of line contacts on coarse grids."""
ROUNDING = 1e-12
"""Part of a distance below which another is none."""
NOT_SETTLED = (
    "the distance at which a layer is worn through did not settle, and a step ends near it: take "
    "shorter steps"
)
"""Warning of a search for an event that ended before it was there."""
NOTHING_WORN = {
    "sticks": "no cell slips in the steps of slide, and nothing is worn: give more force or shift, "
    "or smaller cells, of which those at the rim slip first",
    "does-not-return": "the steps of slide slip only in the first cycle, and nothing is worn by "
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
        for name, count in (("slide", "cycles"), ("roll", "passes")):
            if (getattr(self, name) is None) != (getattr(self, count) is None):
                raise ValueError(f"{name} must be given with {count}, and {count} with {name}")
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
        keywords = self._rest(self.slide, ("steps", "friction"))
        given = keywords.get("steps", ())
        if not isinstance(given, Sequence) or not all(isinstance(step, Mapping) for step in given):
            raise TypeError(f"steps of slide must be a list of mappings, got {given!r}")
        steps = [{**step} for step in given]
        if not steps or keywords.get("friction") is None:
            raise ValueError("slide must have friction, and steps of one cycle")
        if wrong := {key for step in steps for key in step} - {*STEP} | {
            key for step in steps for key in step if key in MOTION
        }:
            raise ValueError(f"steps of slide must not have {', '.join(sorted(map(str, wrong)))}")
        steps[0].setdefault("friction", keywords["friction"])
        return [FrictionStep.of(step) for step in steps]

    @property
    def rolling(self) -> Rolling | None:
        """Rolling of one pass."""
        if self.roll is None:
            return None
        names = ("friction", "creepage", "force", "spin", "direction", "order")
        keywords = self._rest(self.roll, names)
        return Rolling(self.motion or Motion(), **keywords)

    motion: Motion | None = None
    """Motion along z, for rolling."""

    @staticmethod
    def _rest(keywords: Mapping[str, object], names: Sequence[str]) -> dict[str, Any]:
        """Return those keywords that are no options, which must be among the names."""
        options = ("tolerance", "max_convolutions", "coupling")
        named = {key: value for key, value in keywords.items() if key not in options}
        if wrong := set(named) - set(names):
            raise ValueError(f"slide and roll must not have {', '.join(sorted(map(str, wrong)))}")
        return named


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
        march = WearMarch(shape, motion, bodies, sliding, control, on, journal, stored)
        history = march.run()
        if control.store is not None:
            history.save(control.store)
    for text in march.later_warnings(history):
        warn(text)
    return history


class WearMarch:
    """A history of wear while it is computed: its states, its events, and what is warned of."""

    def __init__(
        self,
        shape: core.Shape,
        motion: Motion,
        bodies: Wearing,
        sliding: Sliding,
        control: WearControl,
        on: Setup | core.Plan,
        journal: Journal,
        stored: WearHistory | None,
    ) -> None:
        self.start = time.perf_counter()
        self.shape, self.motion, self.bodies = shape, motion, bodies
        self.sliding, self.control, self.journal = sliding, control, journal
        initial = control.initial if isinstance(control.initial, WearHistory) else None
        if initial and stored and len(stored) < len(initial):  # killed before it began
            stored = None
        self.before = stored or initial
        self.inputs = _inputs(shape, motion, bodies, sliding, control)
        if initial is not None:
            self.inputs = _joined(initial, self.inputs, sliding)
        self._check_store(stored)
        self.on = self._setup(on, "store" if stored else "initial")
        if initial and not stored:
            dataclasses.replace(initial, inputs=self.inputs)._keep(journal)
        self.states = list(self.before.states) if self.before else []
        self.events = list(self.before.events) if self.before else []
        self.offset = self.states[-1].distance if self.states else 0.0
        base = 0.0 if initial is None else float(initial.distance[-1])
        self.options = self._options(base, goes_on=initial is not None and not stored)
        self.earlier = self.before.report if self.before else None
        known = self.earlier.warnings if self.earlier else ()
        self.idle = {reason for reason, text in NOTHING_WORN.items() if text in known}
        self.settled = NOT_SETTLED not in known
        self.step_error = (self.earlier.step_error if self.earlier else None) or 0.0
        self.peak_error, self.regrids = 0.0, 0
        doubts = plausible.of_coefficient((sliding.slide or sliding.roll or {}).get("friction"))
        self.rate_warnings = [*_rate_warnings(self.options), *(text for _, text in doubts)]

    def _check_store(self, stored: WearHistory | None) -> None:
        """Raise a `ValueError` if a store is of other inputs."""
        if stored and (name := _first_difference(stored.inputs, self.inputs)):
            was, now = (inputs.get(name, "none") for inputs in (stored.inputs, self.inputs))
            raise ValueError(f"store must be a history of the same {name}, {now}, got {was}")

    def _setup(self, on: Setup | core.Plan, name: str) -> Setup | core.Plan:
        """Return the setup or the plan, on the grid of the history before."""
        if isinstance(on, Setup) and on.grid is None and self.before:
            on = dataclasses.replace(on, grid=self.before.states[-1].solution.grid, max_cells=None)
        own = on.grid if isinstance(on, Setup) else on.grid()
        if self.before and own != (grid := self.before.states[-1].solution.grid):
            raise ValueError(f"{name} must be a history on the same grid, {own!r}, got {grid!r}")
        return on

    def _options(self, base: float, *, goes_on: bool) -> WearOptions:
        """Return what wears how far after the states that are known.

        Distances count from `base`. A store that ends where it was to end does not go on.
        """
        bodies, sliding, control, offset = self.bodies, self.sliding, self.control, self.offset
        ends = control.ends(sliding.distance)
        if ends is not None:
            ends = [base + end - offset for end in ends if base + end - offset > ROUNDING * offset]
        distance = base + sliding.distance - offset
        return WearOptions(
            rate=layer_numbers("rate", bodies.rates.rate, bodies.body, "rate"),
            counter_rate=layer_numbers(
                "counter_rate", bodies.rates.counter_rate, bodies.counterbody, "rate"
            ),
            distance=distance if distance > ROUNDING * offset else 0.0,
            slip=sliding.slip,
            cycle=sliding.cycle,
            rolling=sliding.rolling,
            friction=sliding.friction,
            steps=ends,
            step_tolerance=control.step_tolerance,
            scheme=control.scheme,
            thickness=control.thickness,
            until_through=control.until is not None,
            initial=control.depths(self.before),
            goes_on=goes_on,
            tolerance=control.tolerance,
            max_iterations=control.max_iterations,
            grows=bodies.grows,
        )

    def run(self) -> WearHistory:
        """Return the whole history; an error carries what is finished as `history`."""
        for text in self.rate_warnings:  # before what may take long
            warn(text)
        try:
            steps = core.wear(self.shape, self.motion, self.options, self.on)
            with lasting("wear", self.control.progress) as tell:
                converged = all(self._add(step, tell) for step in steps)
            thickness = steps.thickness_error() if converged else None
        except BaseException as error:
            if self.states:
                error.history = self.history(converged=False)  # type: ignore[attr-defined]
            raise
        return self.history(converged=converged, thickness=thickness)

    def _add(self, step: Any, tell: Callable[[float], object] | None) -> bool:
        """Add a step of the compiled module, and return whether the march goes on."""
        (
            distance,
            (depth, counter_depth),
            solved,
            through,
            (error, self.peak_error),
            idle,
            signs,
            regrids,
        ) = step
        rings, at_event = signs
        if idle is not None:
            self.idle.add(idle)
        self.regrids, self.settled = regrids, self.settled and at_event
        if self.before and distance == 0.0:
            return True
        solution = Solution._of(solved, self.shape)
        state = WearState(
            self.offset + distance, depth, counter_depth, solution, self.step_error + error, rings
        )
        self.states.append(state)
        self.events += [self._event(event) for event in through]
        self.history(converged=False)._keep(self.journal, len(self.states) - 1)
        if self.control.progress is not None:
            return self.control.progress(state) is not False
        if tell is not None and self.options.distance > 0:
            tell(min(distance / self.options.distance, 1.0))
        return True

    def _event(self, event: Mapping[str, Any]) -> WearThrough:
        """Return an event of the compiled module, with its distance and error from the start."""
        kind: Literal["body", "counterbody"] = (
            "body" if event["member"] == "body" else "counterbody"
        )
        body = self.bodies.body if kind == "body" else self.bodies.counterbody
        layer, (x, y) = layer_names(body)[event["layer"]], event["position"]
        distance = self.offset + event["distance"]
        error = event["error"] + self.step_error * distance
        return WearThrough(distance, (x, y), event["layer"], layer, kind, error)

    def history(self, *, converged: bool, thickness: float | None = None) -> WearHistory:
        """Return the history up to the last state."""
        earlier, states = self.earlier, self.states
        report = WearReport(
            steps=len(states) - 1,
            step_error=states[-1].step_error,
            thickness_error=thickness,
            regrids=self.regrids + (earlier.regrids if earlier else 0),
            converged=converged,
            warnings=(
                *self.rate_warnings,
                *(NOTHING_WORN[reason] for reason in sorted(self.idle)),
                *_warnings_of(
                    states,
                    self.events,
                    self.control.thickness,
                    thickness,
                    peak_error=self.peak_error if self.options.steps is not None else 0.0,
                    settled=self.settled,
                ),
            ),
            seconds=time.perf_counter() - self.start + (earlier.seconds if earlier else 0.0),
        )
        events = tuple(self.events)
        return WearHistory(tuple(states), events, self.sliding.unit, report, self.inputs)

    def later_warnings(self, history: WearHistory) -> Sequence[str]:
        """Return the warnings that were not issued before the march."""
        return history.warnings[len(self.rate_warnings) :]


def _rate_warnings(options: WearOptions) -> list[str]:
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


def _first_difference(before: Mapping[str, str], now: Mapping[str, str]) -> str | None:
    """Return the first name whose words differ; None where all are alike."""
    names = (*now, *before)
    return next((name for name in names if before.get(name) != now.get(name)), None)


def _warnings_of(
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
        change = "still has it" if frozen else "lacks it there to first order only"
        notes.append(
            f"a layer is worn through, and the elastic contact {change}: later results have an "
            "unknown error, to either side"
        )
    elif frozen and error is not None and error > MOST_THINNING:
        notes.append(
            "the elastic contact keeps the initial thickness of the worn layer: the error of the "
            f"pressure is some {100 * error:.0f} %"
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
