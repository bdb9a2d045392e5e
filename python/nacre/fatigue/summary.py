"""Shakedown and fatigue of a solved contact: what each layer and interface needs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, Self, cast, get_args

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.groups import keyword_units, with_units
from nacre._tools.notices import warn
from nacre._tools.paths import by_layer
from nacre._tools.progress import lasting
from nacre._tools.typing import ByLayer, Direction, Member, Real, Side, among
from nacre._tools.units import printable, written
from nacre.contact import plausible
from nacre.contact.friction import FrictionSolution
from nacre.contact.solution import Solution, check_unyielded
from nacre.contact.stresses import PLACE, check_limits
from nacre.fatigue.criteria import CRITERIA, Criterion, Rule
from nacre.fatigue.history import Rolling, States, refined
from nacre.results import display, files, values
from nacre.results.base import Result, Warned
from nacre.results.charts import Axis, Chart, Curve, enlarged_depth
from nacre.results.quantities import PROFILE, Quantity, frozen, quantity
from nacre.results.report import Rows, Table, input_rows
from nacre.results.rows import remark
from nacre.results.shown import Printed, Shown
from nacre.results.verdict import SLIGHT, Demand, Verdict, asked, factor_text, judged, split

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Array = npt.NDArray[np.float64]
Place = tuple[float, float, float]
Peak = tuple[float, Place]
"""Value, and point (x, y, z) where it occurs."""
Balanced = tuple[float, Place, tuple[float, float]]
"""Yield stress in shear, point, and residual stresses along x and y."""
Need = tuple[str, str, float, float, float, float, float]
"""Cells of a row of the table of what is needed, as `FATIGUE` names them."""
FATIGUE = (
    Quantity("part", "layer or interface"),
    Quantity("quantity", "name of the value"),
    Quantity("value", "value", "Pa"),
    *PLACE,
    Quantity("safety_factor", "yield stress or limit over the value"),
)
"""Columns of the table of a summary of fatigue."""

DEPTHS = np.r_[0.03, 0.07, 0.12:1.38:0.09, 1.5, 1.75, 2.1, 2.6]
"""Depths in a body, in half-widths of the contact: maxima are at .3 to .8 of them as a rule."""
INSIDE = 10
"""Number of depths within a layer, besides."""
ROUNDS = 3
"""How many times the depths of maxima are refined by parabolas."""
CLOSEST = 1e-3
"""Distance of depths in half-widths below which a refined one is no other: maxima are flat."""
SINGLE = ("shakedown", "first_yield")
"""Values with the error of one stress; others, ranges or sums of two, have it twice."""
JUMP = 0.01
"""Part by which another maximum of the shear amplitude may be less for Matake's plane to jump."""
DUST = 1e-9
"""Part of the half-width of the contact below which a place is at 0: the rounding of places."""
UNLOADED = "unloaded"
"""In place of y where the stress-free state, infinitely far away, decides."""
NOISE = 1e-6
"""Part of the peak pressure below which a traction at an interface is printed as 0."""
UNRESOLVED = 0.25
"""Estimated error over a value above which a warning says so, as for summaries of stresses."""
ESTIMATE = (
    "shakedown is an estimate: in a point contact, residual stresses along x and y that depend on "
    "the depth alone are not all that are in equilibrium"
)
UNASKED = "Give a yield stress in shear or a limit of a criterion to judge it."
PLASTICITY = "shakedown of a perfectly plastic material, without hardening, in steady rolling"


@frozen()
class LayerFatigue(Result):
    """What one layer needs, or the substrate.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid.line(96, 3e-4)
    >>> solution = nacre.solve(nacre.Cylinder(5e-3), steel, load=1e5, grid=grid)
    >>> (substrate,) = nacre.fatigue.assess(solution, shear_yield=600e6).layers
    >>> k, (x, y, z), (residual_x, residual_y) = substrate.shakedown
    >>> round(solution.peak_pressure / k, 2)
    4.0
    """

    layer: int
    """Number of the layer, from 0 at the surface; the substrate comes after the last layer."""
    name: str | None
    """Name of the layer; None where it has none."""
    depths: tuple[float, float] = quantity("m")
    """Depths of the two faces [m]; the lower one is infinite for the substrate."""
    shakedown: Balanced = quantity("Pa")
    """Smallest yield stress in shear [Pa] with which it shakes down, point, and residual stresses.

    The residual stresses along x and y [Pa] make it possible there.
    """
    first_yield: Peak = quantity("Pa")
    """Smallest yield stress in shear with which nothing yields [Pa], and point."""
    orthogonal_shear: Peak = quantity("Pa")
    """Largest range of the shear stress yz at a depth [Pa], and point of its largest value."""
    criteria: dict[str, Peak] = quantity("Pa")
    """Equivalent stress of each criterion [Pa], and point, by the name of the criterion."""
    safety_factors: dict[str, float]
    """Yield stress or limit over the value, by name: "shakedown", "first_yield", criteria.

    Those of criteria are of the substrate alone, whose limits the user gives.
    """
    uncertainty: dict[str, float] = quantity("Pa", default_factory=dict)
    """Estimated errors of the values [Pa], by name, due to the size of the cells.

    They are what the largest sum of a value and its error over all depths exceeds the largest value
    by, as for summaries of stresses. Empty in files of earlier versions.
    """

    _LATER = ("uncertainty",)

    @property
    def is_substrate(self) -> bool:
        """Whether it has no end."""
        return bool(self.depths[1] == np.inf)

    def _peaks(self) -> dict[str, Peak]:
        """Return values and points by name."""
        first = {"shakedown": self.shakedown[:2], "first_yield": self.first_yield}
        return {**first, "orthogonal_shear": self.orthogonal_shear, **self.criteria}

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        return cls(
            **read_fields(
                cls.__name__,
                state | {"uncertainty": state.get("uncertainty") or {}},
                layer=int,
                name=lambda name: None if name is None else word(name),
                depths=lambda ends: (float(ends[0]), np.inf if ends[1] is None else float(ends[1])),
                shakedown=_balanced,
                first_yield=_peak,
                orthogonal_shear=_peak,
                criteria=lambda peaks: {name: _peak(peak) for name, peak in peaks.items()},
                safety_factors=_by_name,
                uncertainty=_by_name,
            )
        )

    def __repr__(self) -> str:
        """Return the shakedown in a line."""
        k, factor = self.shakedown[0], self.safety_factors.get("shakedown")
        safety = "" if factor is None else f", safety factor {factor:.3g}"
        return printable(
            f"<LayerFatigue of {display.part(self)}: shakedown with k = {written(k, 'Pa')}{safety}>"
        )


@frozen()
class InterfaceFatigue(Result):
    """Ranges of the tractions at one interface.

    Examples
    --------
    >>> steel, dlc = nacre.Elastic(210e9, 0.3), nacre.Elastic(420e9, 0.3)
    >>> body = nacre.HalfSpace(steel, [nacre.Layer(dlc, 15e-6)])
    >>> grid = nacre.Grid.line(96, 3e-4)
    >>> solution = nacre.solve(nacre.Cylinder(5e-3), body, load=1e5, grid=grid)
    >>> (interface,) = nacre.fatigue.assess(solution).interfaces
    >>> interface.depth, bool(interface.shear_range > 0.0)
    (1.5e-05, True)
    """

    interface: int
    """Number of the interface, from 0 below the first layer."""
    depth: float = quantity("m")
    """Depth of the interface [m]."""
    shear_range: float = quantity("Pa")
    """Range of the shear traction: the largest distance of two of its values [Pa]."""
    tension: float = quantity("Pa")
    """Largest normal traction [Pa], tension where it is positive; 0 of the stress-free state."""

    def __repr__(self) -> str:
        """Return the numbers in a line."""
        shear, tension = written(self.shear_range, "Pa"), written(self.tension, "Pa")
        return printable(
            f"<InterfaceFatigue of interfaces[{self.interface}] at {written(self.depth, 'm')}: "
            f"shear range {shear}, tension {tension}>"
        )


@dataclass(frozen=True, repr=False, eq=False)
class FatigueSummary(Shown, Warned, Result):
    """Shakedown and fatigue of a solved contact in steady rolling, by layers and interfaces.

    Printing it shows a table, and so does a notebook. `assess` makes it.

    Examples
    --------
    >>> steel, dlc = nacre.Elastic(210e9, 0.3), nacre.Elastic(420e9, 0.3)
    >>> body = nacre.HalfSpace(steel, [nacre.Layer(dlc, 15e-6)])
    >>> grid = nacre.Grid.line(96, 3e-4)
    >>> solution = nacre.solve(nacre.Cylinder(5e-3), body, load=1e5, grid=grid)
    >>> summary = nacre.fatigue.assess(solution, shear_yield={"substrate": 600e6})
    >>> coat, steel = summary.layers
    >>> bool(steel.safety_factors["shakedown"] > steel.safety_factors["first_yield"])
    True
    """

    layers: list[LayerFatigue]
    """What the layers need, from the surface down, and the substrate."""
    interfaces: list[InterfaceFatigue]
    """Ranges at the interfaces from the surface down."""
    criteria: tuple[Criterion, ...]
    """Criteria that were asked for."""
    rule: Rule
    """Condition of yield."""
    peak_pressure: float
    """Largest pressure of the contact [Pa]."""
    depths: Array
    """Depths that were evaluated ``(nz,)`` [m]; an interface is there twice, for its two sides."""
    profiles: dict[str, Array]
    """Values at these depths ``(nz,)`` [Pa], by name: "shakedown" …, criteria."""
    is_estimate: bool
    """Whether shakedown is an estimate, as in point contacts and rollers.

    Residual stresses that depend on the depth alone are not all that are in equilibrium there.
    """
    warnings: list[str] = field(default_factory=list)
    """Warnings, each also issued as `NacreWarning`."""
    doubt: str | None = None
    """What leaves the pressure without a certain value, and so all values; None without.

    It has no limit at an edge, the cells do not resolve it, or the solution has not converged.
    """
    caution: str | None = None
    """What leaves the verdict fair at best; None without."""

    _TITLE = "shakedown and fatigue"
    _LATER = ("doubt", "caution")

    @property
    def shear_yield(self) -> Array:
        """Smallest yield stress in shear with which each depth shakes down ``(nz,)`` [Pa]."""
        return self.profiles["shakedown"]

    def _state(self) -> dict[str, object]:
        state = super()._state()
        state["depths"] = self.depths.tolist()
        state["profiles"] = {name: column.tolist() for name, column in self.profiles.items()}
        return state

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        return cls(
            **read_fields(
                cls.__name__,
                state,
                layers=lambda states: [LayerFatigue._restored(layer) for layer in states],
                interfaces=lambda states: [InterfaceFatigue._restored(face) for face in states],
                criteria=lambda entries: checked_criteria(map(values.decode, entries)),
                rule=rule_of,
                peak_pressure=float,
                depths=numbers,
                profiles=lambda rows: {name: numbers(row) for name, row in rows.items()},
                is_estimate=flag,
                warnings=lambda texts: [word(text) for text in texts],
                doubt=lambda text: None if text is None else word(text),
                caution=lambda text: None if text is None else word(text),
            )
        )

    def __eq__(self, other: object) -> bool:
        """Return whether all fields are equal."""
        if not isinstance(other, FatigueSummary):
            return NotImplemented
        return self._state() == other._state()

    @asked
    def verdict(self) -> Verdict:
        """Verdict: the smallest safety factor of shakedown and criteria decides.

        First yield alone does not fail, as residual stresses may end it.

        Returns
        -------
        Verdict
            Verdict; unknown without any limit.
        """
        demands, doubts, cautions = [*self._demands()], split(self.doubt), split(self.caution)
        notes = [] if doubts or cautions else [*self._yields()]
        if self.is_estimate:
            notes.append(f"{ESTIMATE[0].upper()}{ESTIMATE[1:]}.")
        is_limited = any(demand.limit is not None for demand in demands)
        return judged(
            demands,
            doubts=doubts,
            cautions=cautions,
            notes=notes,
            unasked=UNASKED if demands and not is_limited else None,
            question="Does the body shake down and survive all cycles?" if is_limited else None,
        )

    def _demands(self) -> Iterator[Demand]:
        """Yield what layers and interfaces need, with the limits."""
        for layer in self.layers:
            demands = {name: self._demand(layer, name) for name in ("shakedown", *layer.criteria)}
            limited = [demand for demand in demands.values() if demand.limit is not None]
            need = demands["shakedown"]
            yield from limited or ([need] if need.value > 0 else [])
        for face in self.interfaces:
            if face.shear_range > SLIGHT * self.peak_pressure:
                part = display.part_in_words(face, self.layers)
                yield Demand("range of shear", part, face.shear_range, depth=face.depth)

    def _demand(self, layer: LayerFatigue, name: str) -> Demand:
        """Return a value of a layer as a demand."""
        value, (_, _, depth) = layer._peaks()[name]
        words = next((row.told for row in PROFILE if row.name == name), f"stress of {name}")
        part, factor = display.part_in_words(layer, self.layers), layer.safety_factors.get(name)
        limit = None if factor is None else factor * value if value > 0 else np.inf
        sentence = None if limit != np.inf else f"{words[0].upper()}{words[1:]} {part}: none."
        return Demand(
            words, part, value, layer.uncertainty.get(name), depth, limit, sentence=sentence
        )

    def _yields(self) -> Iterator[str]:
        """Yield whether a layer that surely shakes down ever yields."""
        for layer in self.layers:
            demand = self._demand(layer, "shakedown")
            if demand.outcome == 2:
                factor = layer.safety_factors["first_yield"]
                part = demand.part.removeprefix("of ")
                yields = "never yields" if factor >= 1 else "yields at first"
                words = f"{part} shakes down and {yields} (safety factor {factor_text(factor)})."
                yield words[0].upper() + words[1:]

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw what each depth needs; needs ``nacre-contact[plot]``.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Axes to draw into; a new figure by default.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.

        Raises
        ------
        TypeError
            If `axes` are no axes of Matplotlib.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> grid = nacre.Grid.line(96, 3e-4)
        >>> solution = nacre.solve(nacre.Cylinder(5e-3), steel, load=1e5, grid=grid)
        >>> nacre.fatigue.assess(solution).plot().get_xlabel()
        'z [µm]'
        """
        from nacre.plot import fatigue

        return fatigue.fatigue_depth(self, axes=axes)

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of the table and of the values over the depth; needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Part and name of each value, place and safety factor over ``row``, NaN where there is
            none; values over ``depth`` by the names of `profiles`.
        """
        rows = list(self._needs())
        variables: dict[str, object] = {
            column.name: ("row", [row[k] for row in rows]) for k, column in enumerate(FATIGUE)
        }
        table = [(row, row.unit) for row in (*FATIGUE, *PROFILE)]
        profiles = {name: ("depth", column) for name, column in self.profiles.items()}
        depths = {"depth": self.depths}
        attributes = {name: str(value) for name, value in self._comments().items()}
        return files.dataset(
            self._TITLE, table, variables | profiles, depths, self.to_dict(), **attributes
        )

    def _comments(self) -> dict[str, object]:
        criteria = ", ".join(map(repr, self.criteria)) or "none"
        settings = {"rule": self.rule, "criteria": criteria}
        return super()._comments() | settings | self._numbered_warnings()

    def _file_rows(self) -> list[Sequence[object]]:
        return [[row.name for row in FATIGUE], *self._needs()]

    def _needs(self) -> Iterator[Need]:
        """Yield the rows of the table, without the heading."""
        for layer in self.layers:
            for name, (value, place) in layer._peaks().items():
                factor = layer.safety_factors.get(name, np.nan)
                yield display.part(layer), name, value, *place, factor
        for face in self.interfaces:
            for name in ("shear_range", "tension"):
                value = getattr(face, name)
                yield display.part(face), name, value, np.nan, np.nan, face.depth, np.nan

    def _inputs(self) -> Rows:
        inputs: dict[str, object] = {"rule": self.rule.replace("_", " ")}
        inputs |= {f"criterion[{k}]": criterion for k, criterion in enumerate(self.criteria)}
        return input_rows(inputs, keyword_units(Criterion))

    def _report_rows(self) -> Rows:
        return [display.numbered("peak_pressure", "peak pressure", self.peak_pressure, "Pa")]

    def _charts(self) -> list[Chart]:
        """Return the chart of what a material needs at each depth."""
        labels = {row.name: row.label for row in PROFILE}
        curves = [
            Curve(self.depths, values, labels.get(name, name))
            for name, values in self.profiles.items()
        ]
        marks, deepest = [face.depth for face in self.interfaces], float(self.depths.max())
        enlarged = enlarged_depth(marks, deepest)
        axes = Axis("z", "m", (0.0, deepest or 1.0)), Axis("stress", "Pa")
        caption = "Required strength at each depth; dotted: interfaces."
        return [Chart(caption, curves, axes, marks, (0.0, enlarged) if enlarged else None)]

    def _tables(self) -> Sequence[Table]:
        printed = self._table()
        return [Table("What layers and interfaces need", printed.head, printed.rows)]

    def _model(self) -> Rows:
        return [remark("theory", note) for note in self._table().notes]

    def _notebook_picture(self) -> bytes | None:
        return display.drawn(self.plot)

    def _table(self) -> Printed:
        """Return the table of what layers and interfaces need."""
        rows = []
        words = {row.name: row.label for row in PROFILE}
        for layer in self.layers:
            top, bottom = (written(depth, "m") for depth in layer.depths)
            head = display.part(layer) + ("" if layer.is_substrate else f", {top} to {bottom}")
            for name, (value, (_, y, z)) in layer._peaks().items():
                factor = layer.safety_factors.get(name)
                factor_text = "" if factor is None else f"{factor:.3g}"
                places = [written(z, "m", 3), UNLOADED if np.isinf(y) else written(y, "m", 3)]
                label = words.get(name, name)
                rows.append([head, label, written(value, "Pa"), *places, factor_text])
                head = ""
        for face in self.interfaces:
            head = f"interfaces[{face.interface}] at {written(face.depth, 'm')}"
            for label, value in (("shear range", face.shear_range), ("tension", face.tension)):
                # Far from the contact, loads are merged to wide cells.
                stress = value if value > NOISE * self.peak_pressure else 0.0
                rows.append([head, label, written(stress, "Pa"), "", "", ""])
                head = ""
        plane = ", Tresca in the plane of rolling" if self.rule == "in_plane_tresca" else ""
        columns = ("", "limit needed", "value", "z", "y", "safety factor")
        return Printed(columns, rows, [PLASTICITY + plane])

    def __repr__(self) -> str:
        """Return how much the summary holds."""
        names = ", ".join(type(criterion).__name__ for criterion in self.criteria) or "none"
        return (
            f"<FatigueSummary of {len(self.layers)} layers and {len(self.interfaces)} interfaces, "
            f"criteria {names}>"
        )


def read_fields(
    kind: str, state: Mapping[str, object], **readers: Callable[[Any], object]
) -> dict[str, Any]:
    """Return the fields of a kind of result from plain data; wrong ones are a `ValueError`."""
    fields = {}
    for key, read in readers.items():
        try:
            fields[key] = read(state[key])
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            message = f'{kind}: the value of the key "{key}" does not fit: {state.get(key)!r:.100}'
            raise ValueError(message) from error
    return fields


def word(text: object) -> str:
    """Return a text, or raise."""
    if not isinstance(text, str):
        raise TypeError(f"{text!r} is no text")
    return text


def flag(truth: object) -> bool:
    """Return a truth value, or raise."""
    if not isinstance(truth, bool):
        raise TypeError(f"{truth!r} is no bool")
    return truth


def rule_of(name: object) -> Rule:
    """Return a condition of yield, or raise."""
    if not among(name, get_args(Rule)):
        raise ValueError(f"{name!r} is no condition of yield")
    return cast(Rule, name)


def numbers(sequence: Iterable[float]) -> Array:
    """Return an array of numbers, or raise."""
    return np.array([float(number) for number in sequence])


def _by_name(entries: Mapping[str, float]) -> dict[str, float]:
    return {name: float(number) for name, number in entries.items()}


def _balanced(entry: tuple[float, Iterable[float], Iterable[float]]) -> Balanced:
    value, place, (x, y) = entry
    return float(value), _place(place), (float(x), float(y))


def _place(coordinates: Iterable[float]) -> Place:
    x, y, z = (float(value) for value in coordinates)
    return x, y, z


def _peak(entry: tuple[float, Iterable[float]]) -> Peak:
    value, place = entry
    return float(value), _place(place)


class Region(NamedTuple):
    """A layer or the substrate, and its faces."""

    layer: int
    name: str | None
    top: float
    bottom: float


class Row(NamedTuple):
    """What one depth needs."""

    z: float
    values: dict[str, float]
    """Values by name."""
    at: dict[str, float]
    """Places along y, by the same names."""
    residual: tuple[float, float]
    gap: float
    """Part by which the next maximum of the shear amplitude is less, for Matake."""
    uncertainty: dict[str, float]
    """Errors of the values."""
    shear_range: float
    tension: float


@dataclass(frozen=True)
class Assessment:
    """A body that rolls, and what is evaluated in it."""

    rolling: Rolling
    criteria: tuple[Criterion, ...]
    rule: Rule
    residual: list[float]

    def regions(self) -> list[Region]:
        """Return the layers from the surface down, and the substrate unless it is rigid."""
        body = self.rolling.body
        faces = [0.0, *body.interfaces, np.inf]
        names = [*(layer.name for layer in body.layers), None]
        regions = [Region(k, names[k], *ends) for k, ends in enumerate(pairwise(faces))]
        return regions if isinstance(body.substrate, core.Elastic) else regions[:-1]

    def depths(self, region: Region) -> Array:
        """Return depths in a layer, its faces included."""
        width = self.rolling.half_width
        below = DEPTHS * width
        chosen = np.r_[below, region.top + below]
        last = min(region.bottom, region.top + below[-1])
        if region.bottom < np.inf:
            inside = np.linspace(region.top, last, INSIDE + 2)[1:-1]
            chosen = np.r_[chosen, inside]
        chosen = np.sort(chosen[(chosen > region.top) & (chosen < region.bottom)])
        # Those that are close to the one before tell nothing new.
        gap = min(0.02 * width, 0.3 * (last - region.top) / INSIDE)
        distinct: Array = chosen[np.diff(chosen, prepend=region.top) > gap]
        bottom = [region.bottom] if region.bottom < np.inf else []
        return np.concatenate([[region.top], distinct, bottom])

    def rows(
        self, region: Region, depths: Sequence[Array], frictions: Sequence[float]
    ) -> list[list[Row]]:
        """Return what some depths of a layer need, those of each coefficient of friction.

        Stresses are linear in the coefficient: pressure and traction are evaluated once for all.
        """
        every = np.unique(np.concatenate(depths))
        sides: list[tuple[list[float], Side]] = [
            ([z for z in every if z == 0.0], "below"),
            ([z for z in every if z > 0.0 and z != region.bottom], "below"),
            ([z for z in every if z == region.bottom], "above"),
        ]
        rows: list[list[Row]] = [[] for _ in frictions]
        for chosen, side in sides:
            if not chosen:
                continue
            history, errors = self.rolling.stress(chosen, side, any(frictions))
            for k, friction in enumerate(frictions):
                if at := np.flatnonzero(np.isin(chosen, depths[k])).tolist():
                    own = [chosen[n] for n in at]
                    states = history.only(at)
                    rows[k] += self._rows_of(
                        region, own, states, errors[at] @ [1.0, friction], friction
                    )
        return rows

    def _rows_of(
        self, region: Region, depths: list[float], history: States, errors: Array, friction: float
    ) -> list[Row]:
        states = history.at(friction).copy()
        states[..., :2] += self.residual[region.layer]
        y, dense = refined(history, states)
        shaken, at = core.shakedown(dense, self.rule)
        stresses: dict[str, tuple[Array, Array]] = {
            "shakedown": (shaken[:, 0], y[at[:, 0]]),
            "first_yield": (shaken[:, 3], y[at[:, 1]]),
        }
        shear = dense[..., 4]
        stresses["orthogonal_shear"] = np.ptp(shear, axis=1), y[shear.argmax(axis=1)]
        gaps = np.full(len(depths), np.nan)
        for criterion in self.criteria:
            planes = criterion._KIND in ("findley", "matake")
            stress, which, gap = criterion._equivalent_stress(states if planes else dense)
            stresses[type(criterion).__name__] = stress, (history.y if planes else y)[which]
            if criterion._KIND == "matake":
                gaps = gap
        rows = []
        for k, z in enumerate(depths):
            rows.append(
                Row(
                    z=float(z),
                    values={name: float(value[k]) for name, (value, _) in stresses.items()},
                    at={name: float(place[k]) for name, (_, place) in stresses.items()},
                    residual=(float(shaken[k, 1]), float(shaken[k, 2])),
                    gap=float(gaps[k]),
                    uncertainty={
                        name: (1 if name in SINGLE else 2) * float(errors[k]) for name in stresses
                    },
                    shear_range=_range(states[k, :, 4:])
                    if z in (region.top, region.bottom)
                    else 0.0,
                    tension=float(states[k][:, 2].max()),
                )
            )
        return rows

    def evaluate(
        self, region: Region, depths: Array | None, frictions: Sequence[float]
    ) -> list[list[Row]]:
        """Return what a layer needs at depths, or at chosen ones, for each coefficient."""
        chosen = self.depths(region) if depths is None else in_region(region, depths)
        if not len(chosen):
            return [[] for _ in frictions]
        rows = self.rows(region, [chosen] * len(frictions), frictions)
        for _ in range(ROUNDS if depths is None else 0):
            new_depths = [self._vertices(profile) for profile in rows]
            if not any(map(len, new_depths)):
                break
            new = self.rows(region, new_depths, frictions)
            rows = [profile + added for profile, added in zip(rows, new, strict=True)]
        return [sorted(profile, key=lambda row: row.z) for profile in rows]

    def _vertices(self, rows: list[Row]) -> Array:
        """Return the depths at the maxima of parabolas through three depths, where they are new."""
        rows = sorted(rows, key=lambda row: row.z)
        depths = np.array([row.z for row in rows])
        vertices: list[float] = []
        for name in rows[0].values:
            vertex = _vertex(depths, np.array([row.values[name] for row in rows]))
            near = np.r_[depths, vertices]
            least = CLOSEST * self.rolling.half_width
            if vertex is not None and np.abs(near - vertex).min() > least:
                vertices.append(vertex)
        return np.sort(vertices)


def _range(traction: Array) -> float:
    """Return the largest distance of two values of a shear traction ``(times, 2)``."""
    if not traction[:, 1].any():
        return float(np.ptp(traction[:, 0]))
    return float(max(np.hypot(*(traction - point).T).max() for point in traction))


def _vertex(depths: Array, stresses: Array) -> float | None:
    """Return the depth of the maximum of a parabola, or None where it is at an end."""
    k = int(stresses.argmax())
    if k in (0, len(stresses) - 1):
        return None
    (a, b, c), (f, g, h) = depths[k - 1 : k + 2], stresses[k - 1 : k + 2]
    left, right = (b - a) * (g - h), (b - c) * (g - f)
    if left == right:
        return None
    vertex = b - 0.5 * ((b - a) * left - (b - c) * right) / (left - right)
    return float(vertex) if a < vertex < c else None


MOST_FRICTION = 1e100
"""Largest coefficient of friction, beyond which the squares of stresses overflow."""


def checked_criteria(criteria: Iterable[Criterion]) -> tuple[Criterion, ...]:
    """Return criteria, each of another kind."""
    if isinstance(criteria, Criterion) or not isinstance(criteria, Iterable):
        raise TypeError(f"criteria must be a sequence of criteria, got {criteria!r}")
    all_criteria = tuple(criteria)
    for criterion in all_criteria:
        if not isinstance(criterion, Criterion):
            kinds = ", ".join(kind.__name__ for kind in CRITERIA.values())
            raise TypeError(f"criteria must hold {kinds}, got {criterion!r}")
    names = [type(criterion).__name__ for criterion in all_criteria]
    if len(set(names)) < len(names):
        raise ValueError(f"criteria must be of different kinds, got {', '.join(names)}")
    return all_criteria


def layer_values(
    name: str, stress: float | ByLayer | None, body: core.HalfSpace
) -> list[float | None]:
    """Return a value for each layer and the substrate, None where it is not known."""
    count = len(body.layers) + isinstance(body.substrate, core.Elastic)
    if np.ndim(stress) == 0 and not isinstance(stress, Mapping | None):  # type: ignore[arg-type]
        return [core.real(name, stress)] * count
    per_layer: list[float | None] = core.layer_values(body, name, by_layer(stress))
    return per_layer + [None] * (count - len(per_layer))


def checked_depths(depths: npt.ArrayLike | None, body: core.HalfSpace) -> Array | None:
    """Return depths in their order, checked, or None where they are to be chosen."""
    if depths is None:
        return None
    ordered = np.sort(core.real_array("depths", depths).ravel())
    if not ordered.size or not np.isfinite(ordered).all() or ordered[0] < 0:
        raise ValueError(f"depths must be finite and at least 0, one or more, got {depths!r}")
    if not isinstance(body.substrate, core.Elastic) and ordered[-1] > body.interfaces[-1]:
        raise ValueError(
            f"depths must not be below the rigid base at {body.interfaces[-1]:g}, "
            f"got {ordered[-1]:g}"
        )
    return ordered


def assessment_of(
    solution: Solution | FrictionSolution,
    criteria: Iterable[Criterion],
    rule: Rule,
    residual: ByLayer | None,
    body: Member,
    direction: Direction | None,
    x: float | None,
    threads: int | None,
) -> Assessment:
    """Return what is evaluated, checked."""
    if not isinstance(solution, Solution | FrictionSolution):
        raise TypeError(f"solution must be a Solution or a FrictionSolution, got {solution!r}")
    check_unyielded(solution.normal if isinstance(solution, FrictionSolution) else solution)
    if not among(rule, get_args(Rule)):
        raise ValueError(f"rule must be 'von_mises' or 'in_plane_tresca', got {rule!r}")
    all_criteria = checked_criteria(criteria)
    rolling = Rolling(solution, body, direction, x, threads)
    stresses = [value or 0.0 for value in layer_values("residual", residual, rolling.body)]
    if not np.isfinite(stresses).all():
        raise ValueError(f"residual must be finite, got {residual!r}")
    return Assessment(rolling, all_criteria, rule, stresses)


def in_region(region: Region, depths: Array) -> Array:
    """Return those of the depths that are in a layer, both faces included."""
    return depths[(depths >= region.top) & (depths <= region.bottom)]


@with_units(shear_yield="Pa", residual="Pa", x="m", depths="m")
def assess(
    solution: Solution | FrictionSolution,
    *,
    criteria: Iterable[Criterion] = (),
    shear_yield: float | ByLayer | None = None,
    friction: float = 0.0,
    direction: Direction | None = None,
    residual: ByLayer | None = None,
    body: Member = "body",
    x: float | None = None,
    depths: Sequence[float] | Real | None = None,
    rule: Rule = "von_mises",
    threads: int | None = None,
    progress: Callable[[float], object] | None = None,
) -> FatigueSummary:
    """Shakedown and fatigue of a solved contact that rolls or slides along y, steadily.

    Parameters
    ----------
    solution : Solution or FrictionSolution
        Solved contact, not periodic.
    criteria : sequence, optional
        Fatigue criteria, each of another kind: `DangVan`, `Crossland`, `Findley`, `Matake`.
    shear_yield : float, dict or sequence, optional
        Yield stress in shear k [Pa], for safety factors: of all layers, or by layer. A dict maps
        layers to it, by number (0 at the surface) or name, and ``"substrate"``; a sequence holds it
        from the surface down, with None where it is not known.
    friction : float, optional
        Coefficient of friction: adds the traction ``friction * pressure``. It must be 0 where the
        tractions are known, of `nacre.slide` and `nacre.roll`.
    direction : tuple of float or str, optional
        Direction of the traction on the body, ``(x, y)`` or ``"+x"`` to ``"-y"``; by default
        along y.
    residual : dict or sequence, optional
        Residual stress [Pa], equal along x and y, that is added to every state of a layer, the
        unloaded one too; by layer as `shear_yield`.
    body : {"body", "counterbody"}, optional
        Body that is assessed.
    x : float, optional
        Section [m]; by default the middle of the rows with the largest line load. A line contact
        has none.
    depths : array_like, optional
        Depths [m]; by default chosen, with the surface and both sides of each interface, and
        refined where values are largest.
    rule : {"von_mises", "in_plane_tresca"}, optional
        Condition of yield, as in `shakedown`.
    threads : int, optional
        Number of threads of the stresses; by default as for `Contact`.
    progress : callable, optional
        Function that is called with the part of the work that is done, from 0 to 1; without it, a
        terminal or a notebook shows a bar after two seconds.

    Returns
    -------
    FatigueSummary
        Values, points and safety factors by layers and interfaces; printing it shows a table.

    Raises
    ------
    ValueError
        If an argument is out of range, the contact is periodic, nothing touches, or the surfaces
        have yielded.

    Notes
    -----
    A point of the body sees the stresses on the line along y through it, and none far away. Beyond
    the grid of the contact, the history goes on up to some 300 half-widths.

    Shakedown is that of a perfectly plastic material, without hardening: residual stresses along x
    and y, the same along y, may help each depth. In line contacts they are all that are in
    equilibrium. In point contacts and rollers shakedown is an estimate, and so is the choice of the
    section.

    Fatigue limits are those of one material: safety factors of criteria are given for the
    substrate, and values for the layers beside them, whose limits are rarely known.

    Examples
    --------
    >>> steel, dlc = nacre.Elastic(210e9, 0.3), nacre.Elastic(420e9, 0.3)
    >>> body = nacre.HalfSpace(steel, [nacre.Layer(dlc, 15e-6, name="DLC")])
    >>> grid = nacre.Grid.line(96, 3e-4)
    >>> solution = nacre.solve(nacre.Cylinder(5e-3), body, load=1e5, grid=grid)
    >>> criterion = nacre.fatigue.DangVan(bending=520e6, torsion=330e6)
    >>> summary = nacre.fatigue.assess(
    ...     solution, criteria=[criterion], shear_yield={"substrate": 600e6}, friction=0.1
    ... )
    >>> substrate = summary.layers[-1]
    >>> sorted(substrate.safety_factors)
    ['DangVan', 'first_yield', 'shakedown']
    """
    assessment = assessment_of(solution, criteria, rule, residual, body, direction, x, threads)
    limits = layer_values("shear_yield", shear_yield, assessment.rolling.body)
    for limit in limits:
        if limit is not None and not 0.0 < limit < np.inf:
            raise ValueError(f"shear_yield must be finite and above 0, got {limit!r}")
    check_limits("shear_yield", limits, assessment.rolling.body)
    layers = [None] * len(assessment.rolling.body.layers)  # whose limits are not those of criteria
    for criterion in assessment.criteria:
        for name in ("bending", "torsion"):
            check_limits(name, [*layers, getattr(criterion, name)], assessment.rolling.body)
    friction = core.real("friction", friction)
    if not 0.0 <= friction <= MOST_FRICTION:
        raise ValueError(f"friction must be a number, finite and at least 0, got {friction!r}")
    if assessment.rolling.has_tractions and friction:
        raise ValueError(f"friction must be 0: the tractions are known, got {friction:g}")
    ordered_depths = checked_depths(depths, assessment.rolling.body)
    regions, rows_by_region = assessment.regions(), []
    with lasting("fatigue", progress) as tell:
        for done, region in enumerate(regions):
            if tell is not None:
                tell(done / len(regions))
            rows_by_region += assessment.evaluate(region, ordered_depths, [float(friction)])
        if tell is not None:
            tell(1.0)
    notes = [text for _, text in plausible.of_coefficient(friction)]
    return _summarise(assessment, regions, rows_by_region, limits, notes)


def _summarise(
    assessment: Assessment,
    regions: list[Region],
    rows_by_region: list[list[Row]],
    limits: list[float | None],
    warning_texts: list[str],
) -> FatigueSummary:
    """Return the summary of the rows of all layers, and issue its warnings."""
    layers = []
    for region, rows in zip(regions, rows_by_region, strict=True):
        if rows:
            layer, layer_warnings = _layer(assessment, region, rows, limits[region.layer])
            layers.append(layer)
            warning_texts += layer_warnings
    interfaces = []
    for number, depth in enumerate(assessment.rolling.body.interfaces):
        sides = [
            row for rows in rows_by_region[number : number + 2] for row in rows if row.z == depth
        ]
        if sides:
            # Tractions are continuous.
            interfaces.append(
                InterfaceFatigue(number, depth, sides[0].shear_range, sides[0].tension)
            )
    all_rows = [row for rows in rows_by_region for row in rows]
    names = all_rows[0].values
    summary = FatigueSummary(
        layers,
        interfaces,
        assessment.criteria,
        assessment.rule,
        assessment.rolling.peak_pressure,
        np.array([row.z for row in all_rows]),
        {name: np.array([row.values[name] for row in all_rows]) for name in names},
        assessment.rolling.x is not None,
        warning_texts,
        assessment.rolling.doubt,
        assessment.rolling.caution,
    )
    for text in warning_texts:
        warn(text)
    return summary


def unresolved(place: str, best: Mapping[str, Row]) -> list[str]:
    """Return a warning of the extremes in a layer that the cells do not resolve."""
    names = [
        name for name, row in best.items() if row.uncertainty[name] > UNRESOLVED * row.values[name]
    ]
    are = "is" if len(names) == 1 else "are"
    text = f"{', '.join(names)} {are} uncertain due to the size of the cells: take smaller cells"
    return [f"in {place}, {text}"] if names else []


def _at(y: float, rolling: Rolling) -> float:
    """Return a place along y without its rounding."""
    return 0.0 if abs(y) < DUST * rolling.half_width else y


def _layer(
    assessment: Assessment, region: Region, rows: list[Row], limit: float | None
) -> tuple[LayerFatigue, list[str]]:
    """Return what a layer needs, and warnings."""
    best = {name: max(rows, key=lambda row: row.values[name]) for name in rows[0].values}
    x = assessment.rolling.x or 0.0
    peaks: dict[str, Peak] = {
        name: (row.values[name], (x, _at(row.at[name], assessment.rolling), row.z))
        for name, row in best.items()
    }
    criteria = {type(criterion).__name__: criterion for criterion in assessment.criteria}
    factors: dict[str, float] = {}
    for name in ("shakedown", "first_yield"):
        if limit is not None and peaks[name][0] > 0:
            factors[name] = limit / peaks[name][0]
    if region.bottom == np.inf:
        for name, criterion in criteria.items():
            if peaks[name][0] > 0:
                factors[name] = criterion.limit / peaks[name][0]
    layer = LayerFatigue(
        region.layer,
        region.name,
        (region.top, region.bottom),
        (*peaks["shakedown"], best["shakedown"].residual),
        peaks["first_yield"],
        peaks["orthogonal_shear"],
        {name: peaks[name] for name in criteria},
        factors,
        {
            name: max(row.values[name] + row.uncertainty[name] for row in rows) - peak
            for name, (peak, _) in peaks.items()
        },
    )
    place = display.part(layer)
    warning_texts = unresolved(place, best)
    if "Matake" in best and best["Matake"].gap < JUMP:
        warning_texts.append(
            f"in {place}, another plane has a shear amplitude within 1 % of that of Matake's "
            "plane: the choice may jump from one to the other, and its value with it"
        )
    return layer, warning_texts
