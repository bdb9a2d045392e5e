"""Stress below the surface: fields, their extremes, and plans that evaluate them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypedDict, TypeVar, Unpack, cast

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.groups import names_itself, with_units
from nacre._tools.notices import warn
from nacre._tools.paths import by_layer
from nacre._tools.progress import lasting
from nacre._tools.typing import ByLayer, Direction, Member, Pair, Real, Side, among, components
from nacre._tools.units import rounded, written
from nacre.cards import Limits, materials, names_of, numbers_of
from nacre.contact import plausible
from nacre.results import display, files, values
from nacre.results.base import Result, Warned, as_text, same
from nacre.results.charts import Axis, Chart, Curve, enlarged_depth
from nacre.results.quantities import Quantity, frozen, quantity
from nacre.results.report import Rows, Table
from nacre.results.rows import remark
from nacre.results.shown import Printed, Shown
from nacre.results.verdict import SLIGHT, UNCONVERGED, Demand, Verdict, asked, joined, judged, split

if TYPE_CHECKING:
    import xarray

    from nacre.contact.solution import Solution

Array = npt.NDArray[np.float64]
Depths = float | Sequence[float] | Real
Peak = tuple[float, tuple[float, float, float]]
"""Value, and point (x, y, z) where it occurs."""
Extreme = tuple[str, str, float, float, float, float, float, float]
"""Cells of a row of the table of extremes, as `EXTREMES` names them."""
PLACE = (
    Quantity("x", "x of the place", "m"),
    Quantity("y", "y of the place", "m"),
    Quantity("z", "depth of the place", "m"),
)
"""Columns of the place of an extreme."""
EXTREMES = (
    Quantity("part", "layer or interface"),
    Quantity("quantity", "name of the extreme"),
    Quantity("value", "largest value", "Pa"),
    Quantity("uncertainty", "error due to the size of the cells, estimated", "Pa"),
    *PLACE,
    Quantity("safety_factor", "yield stress or strength over the value"),
)
"""Columns of the table of a stress summary."""
Progress = Callable[[float], object]
Bond = tuple[float | None, float | None]
"""Shear and tension that an interface bears; None where one is not known."""
Bonds = Bond | Mapping[int | str, Bond]
"""Those of all interfaces, or of those below layers, by number or name."""

FACTORS = {"von_mises": "yield_safety_factor", "tension": "strength_safety_factor"}
"""Safety factors that stand with extremes."""
STRESSES = "Fourier transforms of the stress below pressure and traction, exact in the depth"
SIZE_ERRORS = "errors due to the size of the cells, estimated"
"""What a report says of stresses."""
DEPTHS, INSIDE, WORK, MOST_CELLS = (14, 18), 4, 400_000, 1 << 17
"""Depths of the picture of a report, in all, fewest and most, and in each layer; their number times
that of the cells, which takes 0.2 s; most cells of a grid for it."""
BETWEEN = 4
"""Points of that picture for each depth: cubic parabolas between depths, 0.3 % of the largest."""
DEEPEST = 1.25
"""Its depth over the width of the contact."""
WORDS = {"von_mises": "von Mises stress", "tension": "tension"}
"""Words for these extremes."""
UNASKED = "Give a yield stress, a strength or a bond strength to judge them."
LARGEST_CONTACT = 0.5
"""Half-width over radius of a contact beyond which nothing is judged for flat bodies."""
SOFTEST = 1e-6
"""Least limit of a material over its modulus: annealed metals yield at 1e-4 of it."""
UNFINISHED = "stopped before all depths were done"
REFINED = 0.05
"""Largest estimated error of extremes where `refine` is True."""
AXES = ("z", "x", "y")
"""Axes of a field, in their order."""


@dataclass(frozen=True, eq=False)
class StressOptions:
    """Body, traction and residual stress of an evaluation, and how it is done."""

    body: Member
    friction: float
    direction: Pair | None
    residual: ByLayer | None
    threads: int | None
    progress: Progress | None


class SlidingOptions(TypedDict, total=False):
    """Keywords of the stress below a contact that say how it slides."""

    friction: float
    direction: Direction | None
    residual: ByLayer | None


class DepthOptions(SlidingOptions, total=False):
    """Keywords of the picture of the stress over depth."""

    body: Member


@dataclass(frozen=True, eq=False)
class StressFields:
    """Place and kind of the fields that an evaluation returns."""

    side: Side
    x: float | None
    y: float | None
    displacement: bool


@dataclass(frozen=True, eq=False)
class StressLimits:
    """Limits of the materials, and the largest error of the extremes."""

    yield_stress: ByLayer | None
    strength: ByLayer | None
    refine: float | None


@frozen(eq=False)
class Stress(Result, Warned):
    """Stress below the surface, and displacement where it was asked for.

    A field has an axis for depth, x and y unless that one was given as a number: ``(nz, nx, ny)``
    for several depths, ``(nx, ny)`` at one depth, ``(nz, nx)`` on the section ``y = const``.
    Tension is positive; at the surface ``zz`` is minus the pressure. Beyond a free end of the body
    there is no material: fields are NaN.

    Examples
    --------
    Below a sphere the largest shear is 0.31 of the peak pressure, at 0.48 contact radii:

    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    >>> radius = (0.75 * 10.0 * 5e-3 / steel.plane_strain_modulus) ** (1 / 3)
    >>> field = solution.stress(np.linspace(0.3, 0.7, 9) * radius, y=0.0)
    >>> value, (x, y, z) = field.peak("max_shear")
    >>> round(value / solution.peak_pressure, 2), round(z / radius, 1)
    (0.31, 0.5)
    """

    _DERIVED = ("warnings",)
    _LATER = ("uncertainty",)

    z: Array = quantity("m")
    """Depths ``(nz,)`` [m]."""
    x: Array = quantity("m")
    """Coordinates along x ``(nx,)`` [m]."""
    y: Array = quantity("m")
    """Coordinates along y ``(ny,)`` [m]."""
    axes: tuple[str, ...]
    """Axes of the fields: those of "z", "x" and "y" that were not given as a number."""
    body: core.HalfSpace
    """Body in which the stress is."""
    side: Side
    """Side of an interface, for depths that lie on one: "above" or "below"."""
    friction: tuple[float, float]
    """Traction divided by pressure, ``(x, y)``: the coefficient of friction times its direction."""
    uncertainty: Array | None = quantity("Pa")
    """Estimated error of the components at each depth ``(nz,)`` [Pa], due to the size of the cells.

    It belongs to the worst place of a depth, of those that were evaluated: at the edge of the
    contact as a rule. The errors of the pressure itself add to it, which tractions at the surface
    have. Where it is not small compared with the stress, the cells do not resolve the depth, or the
    layer: take smaller cells. `None` for `nacre.stress`, whose pressure is given as uniform over
    cells, and in files of earlier versions.
    """
    components: dict[str, Array] = quantity("Pa")
    """Components ``xx`` to ``xz`` by name [Pa], each ``(nz, nx, ny)`` whatever the `axes`."""
    displacement: dict[str, Array] | None = quantity("m")
    """Displacements ``ux`` to ``uz`` likewise [m]; None without ``displacement=True``."""
    warnings: list[str]
    """Warnings about depths that the cells do not resolve, each also issued as `NacreWarning`."""

    @property
    def xx(self) -> Array:
        """Normal stress along x [Pa]."""
        return self._shaped(self.components["xx"])

    @property
    def yy(self) -> Array:
        """Normal stress along y [Pa]."""
        return self._shaped(self.components["yy"])

    @property
    def zz(self) -> Array:
        """Normal stress along z [Pa]."""
        return self._shaped(self.components["zz"])

    @property
    def xy(self) -> Array:
        """Shear stress in the plane of the surface [Pa]."""
        return self._shaped(self.components["xy"])

    @property
    def yz(self) -> Array:
        """Shear stress along y on planes z = const [Pa]."""
        return self._shaped(self.components["yz"])

    @property
    def xz(self) -> Array:
        """Shear stress along x on planes z = const [Pa]."""
        return self._shaped(self.components["xz"])

    @property
    def ux(self) -> Array:
        """Displacement along x [m]; with ``displacement=True`` only."""
        return self._displacement("ux")

    @property
    def uy(self) -> Array:
        """Displacement along y [m]; with ``displacement=True`` only."""
        return self._displacement("uy")

    @property
    def uz(self) -> Array:
        """Displacement into the body [m]; with ``displacement=True`` only."""
        return self._displacement("uz")

    @cached_property
    def von_mises(self) -> Array:
        """Von Mises' equivalent stress [Pa]."""
        return self._invariants("von_mises")[0]

    @cached_property
    def tresca(self) -> Array:
        """Tresca's equivalent stress: the largest principal stress less the smallest [Pa]."""
        return self._invariants("tresca")[0]

    @cached_property
    def max_shear(self) -> Array:
        """Largest shear stress on any plane: half of Tresca's equivalent stress [Pa]."""
        return self._invariants("max_shear")[0]

    @cached_property
    def principal(self) -> list[Array]:
        """Three principal stresses, the largest first [Pa]."""
        return self._invariants("principal")

    def peak(self, field: str = "von_mises") -> Peak:
        """Largest value of a field, and its point.

        Parameters
        ----------
        field : str, optional
            Name of the field: a component, ``"von_mises"``, ``"tresca"``, ``"max_shear"``, or
            ``"tension"``, the largest principal stress.

        Returns
        -------
        tuple
            Value [Pa] and point ``(x, y, z)`` [m].

        Raises
        ------
        ValueError
            If there is no such field, or no depth was evaluated.

        Examples
        --------
        >>> field = nacre.stress(nacre.Elastic(1.0, 0.3), nacre.Grid((2, 2), (2.0, 2.0)),
        ...                      np.ones((2, 2)), 1.0)
        >>> value, (x, y, z) = field.peak("von_mises")
        >>> z
        1.0
        """
        if field == "tension":
            values = self.principal[0]
        elif field in self.components or field in ("von_mises", "tresca", "max_shear"):
            values = getattr(self, field)
        else:
            raise ValueError(
                'field must be a component, "von_mises", "tresca", "max_shear" or "tension", '
                f'got "{field}"'
            )
        values = values.reshape(self.z.size, self.x.size, self.y.size)
        if np.isnan(values).all():
            raise ValueError(
                "the field must hold at least one depth and point in the body, got none"
            )
        k, i, j = np.unravel_index(np.nanargmax(values), values.shape)
        return float(values[k, i, j]), (float(self.x[i]), float(self.y[j]), float(self.z[k]))

    def _shaped(self, field: Array) -> Array:
        """Return a field without the axes that were given as numbers."""
        return field.squeeze(tuple(k for k, axis in enumerate(AXES) if axis not in self.axes))

    def _displacement(self, name: str) -> Array:
        if self.displacement is None:
            raise AttributeError(
                "displacements were not evaluated: ask for them with displacement=True"
            )
        return self._shaped(self.displacement[name])

    def _invariants(self, name: str) -> list[Array]:
        return [self._shaped(one) for one in core.stress_invariants(self.__dict__, name)]

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        try:
            return cls(**core.checked_stress(state | {"body": values.decode(state["body"])}))
        except TypeError as error:
            raise ValueError(f"Stress: {error}") from error

    def __eq__(self, other: object) -> bool:
        """Return whether all fields are equal; NaN is equal to NaN."""
        if not isinstance(other, Stress):
            return NotImplemented
        return same(self._state(), other._state())

    def __repr__(self) -> str:
        """Return where the stress is, and how well it is known."""
        places = ", ".join(
            f"{name} {_range(getattr(self, axis))}"
            for name, axis in (("depths", "z"), ("x", "x"), ("y", "y"))
        )
        errors = ""
        if self.uncertainty is not None:
            largest = np.fmax.reduce(self.uncertainty, initial=0.0)
            errors = f", uncertain by up to {_short(largest, 1)} Pa"
        return f"<Stress: {places}, side '{self.side}'{errors}>"


def _range(coordinates: Array) -> str:
    """Return the number of coordinates and their ends, in words."""
    if coordinates.size == 0:
        return "none"
    first, last = _short(coordinates[0], 6), _short(coordinates[-1], 6)
    return f"{coordinates.size} from {first} to {last}"


def _short(value: float, digits: int) -> str:
    """Return a number with an exponent as short as can be."""
    digit, _, exponent = f"{value:.{digits}e}".partition("e")
    return f"{digit}e{int(exponent)}" if exponent else digit


class _Extremes(Result):
    """Peaks, and their errors by name; in plain data an error stands with its peak."""

    _COMPILED = True
    _DERIVED = ("uncertainty",)
    _PEAKS: ClassVar[tuple[str, ...]]

    uncertainty: dict[str, float]

    @classmethod
    def _from_fields(cls, fields: dict[str, Any]) -> Self:
        known = {name: fields[name] for name in cls._PEAKS if fields[name] is not None}
        peaks = {name: (peak["value"], peak["at"]) for name, peak in known.items()}
        errors = {name: peak["uncertainty"] for name, peak in known.items()}
        errors = {name: error for name, error in errors.items() if error is not None}
        return cls(**fields | peaks | {"uncertainty": errors})

    def _state(self) -> dict[str, object]:
        state = super()._state()
        for name in self._PEAKS:
            if (peak := getattr(self, name)) is not None:
                value, place = peak
                error = self.uncertainty.get(name)
                state[name] = {"value": value, "at": list(place), "uncertainty": error}
        return state


@frozen()
class LayerStress(_Extremes):
    """Extremes of the stress in one layer, or in the substrate.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid)
    >>> (substrate,) = solution.stress_summary().layers
    >>> value, (x, y, z) = substrate.von_mises
    >>> round(value / solution.peak_pressure, 1), substrate.yield_safety_factor
    (0.6, None)
    """

    _PEAKS = ("von_mises", "tension", "max_shear")

    layer: int
    """Number of the layer, from 0 at the surface; the substrate comes after the last layer."""
    name: str | None
    """Name of the layer; None where it has none."""
    depths: tuple[float, float] = quantity("m")
    """Depths of the two faces [m]; the lower one is infinite for the substrate."""
    von_mises: Peak = quantity("Pa")
    """Largest von Mises stress [Pa], and its point [m]."""
    tension: Peak = quantity("Pa")
    """Largest principal stress [Pa], tension where it is positive, and its point [m]."""
    max_shear: Peak = quantity("Pa")
    """Largest shear stress on any plane [Pa], and its point [m]."""
    yield_safety_factor: float | None
    """Yield stress divided by the largest von Mises stress; None without a yield stress."""
    strength_safety_factor: float | None
    """Strength divided by the largest tension; None without a strength, or without tension."""
    uncertainty: dict[str, float] = quantity("Pa")
    """Estimated errors of the values [Pa], by name, due to the size of the cells.

    Each is the largest sum of a value and its error over all places, less the value: another place,
    which the cells resolve less, may have the extreme. Where it is not small compared with the
    value, take smaller cells, or `refine`. See `Stress.uncertainty`.
    """

    def __repr__(self) -> str:
        """Return von Mises' stress and the tension, in the units that are set."""
        mises, tension = (written(value, "Pa") for value, _ in (self.von_mises, self.tension))
        return f"<LayerStress of {display.part(self)}: von Mises {mises}, tension {tension}>"


@frozen()
class InterfaceStress(_Extremes):
    """Extremes of the tractions at one interface.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
    >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0, grid=grid)
    >>> (interface,) = solution.stress_summary().interfaces
    >>> interface.depth, bool(interface.shear[0] > 0.0)
    (2e-05, True)
    """

    _PEAKS = ("tension", "compression", "shear", "jump")

    interface: int
    """Number of the interface, from 0 below the first layer."""
    depth: float = quantity("m")
    """Depth of the interface [m]."""
    tension: Peak = quantity("Pa")
    """Largest normal traction [Pa], tension where it is positive, and its point [m]."""
    compression: Peak = quantity("Pa")
    """Smallest normal traction [Pa], and its point [m]."""
    shear: Peak = quantity("Pa")
    """Largest shear traction [Pa], and its point [m]."""
    jump: Peak | None = quantity("Pa")
    """Largest jump of the in-plane stress [Pa], and its point [m]; None on a rigid base."""
    uncertainty: dict[str, float] = quantity("Pa")
    """Estimated errors of the values [Pa], by name, due to the size of the cells.

    Each is the largest sum of a value and its error over all places, less the value: another place,
    which the cells resolve less, may have the extreme. Where it is not small compared with the
    value, take smaller cells, or `refine`. See `Stress.uncertainty`.
    """

    def __repr__(self) -> str:
        """Return shear and tension, in the units that are set."""
        shear, tension = (written(value, "Pa") for value, _ in (self.shear, self.tension))
        return (
            f"<InterfaceStress of interfaces[{self.interface}] at {written(self.depth, 'm')}: "
            f"shear {shear}, tension {tension}>"
        )


@dataclass(frozen=True, repr=False)
class StressSummary(Shown, Warned, Result):
    """Extremes of the stress in each layer and at each interface.

    Printing it shows a table, and so does a notebook. Each value comes with its point
    ``(x, y, z)``: a cell centre or, at the surface, a point of the contact's edge
    (`StressPlan.edge`).

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
    >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0, grid=grid)
    >>> summary = solution.stress_summary(yield_stress={"substrate": 2e9})
    >>> coating, substrate = summary.layers
    >>> bool(coating.tension[0] > 0.0 and substrate.yield_safety_factor > 1.0)
    True
    """

    _COMPILED = True
    _DERIVED = ("warnings",)
    _LATER = ("friction", "doubt", "caution", "bond_strength", "origins")
    _TITLE = "stresses"

    layers: list[LayerStress]
    """Extremes in the layers from the surface down, and in the substrate."""
    interfaces: list[InterfaceStress]
    """Extremes at the interfaces from the surface down."""
    finished: bool
    """Whether all depths were evaluated; False where a callback stopped the evaluation."""
    friction: tuple[float, float] | None
    """Traction that was added, divided by pressure, ``(x, y)``, as `Stress.friction`.

    Its direction is the given one, or that in which the shape rolls. `None` in files of earlier
    versions.
    """
    doubt: str | None
    """What leaves the pressure without a certain value, and so the extremes; None without.

    It has no limit at an edge, the cells do not resolve it, or the solution has not converged.
    """
    caution: str | None
    """What leaves the verdict fair at best; None without."""
    bond_strength: tuple[Bond | None, ...] | None
    """Shear and tension that the interfaces bear [Pa], from the surface down; None without."""
    origins: tuple[str | None, ...] | None
    """Cards that yield stresses were taken from, from the surface down; None without."""
    warnings: list[str]
    """Warnings about extremes that the cells do not resolve, each also issued as `NacreWarning`."""

    @classmethod
    def _from_fields(
        cls, fields: dict[str, Any], friction: Pair | None = None, **contact: Any
    ) -> Self:
        layers = [LayerStress._from_fields(layer) for layer in fields["layers"]]
        interfaces = [InterfaceStress._from_fields(face) for face in fields["interfaces"]]
        parts: dict[str, Any] = {"layers": layers, "interfaces": interfaces, "friction": friction}
        added = np.hypot(*friction) if friction is not None else None
        texts = (text for _, text in plausible.of_coefficient(added))
        parts["warnings"] = [*fields["warnings"], *texts]
        state: dict[str, Any] = dict.fromkeys(cls._LATER) | fields | parts | contact
        return cls(**state)

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        contact = cls._checked({name: state.pop(name) for name in cls._LATER})
        fields = core.checked(cls.__name__, as_text(cls.__name__, state, infinite=True))
        return cls._from_fields(fields, **contact)

    @asked
    def verdict(self) -> Verdict:
        """Verdict: the smallest safety factor decides; the limits are those of the summary.

        Of parts without a limit it has the largest tension, of the substrate the largest von Mises
        stress.

        Returns
        -------
        Verdict
            Verdict; unknown without any limit.
        """
        demands, doubts = [*_demands(self)], split(self.doubt)
        is_limited = any(demand.limit is not None for demand in demands)
        return judged(
            demands,
            doubts=doubts if self.finished else [*doubts, UNFINISHED],
            cautions=split(self.caution),
            notes=[*_gaps(self)],
            unasked=UNASKED if demands and not is_limited else None,
            question="Do the largest stresses keep the limits?" if is_limited else None,
        )

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of the table, a row for each extreme; needs ``nacre-contact[files]``.

        ``to_xarray().to_dataframe()`` is the table for pandas.

        Returns
        -------
        xarray.Dataset
            Part and name of each extreme, value, uncertainty, position and safety factor over
            ``row``; NaN where there is none.
        """
        rows = list(self._extremes())
        variables = {
            column.name: ("row", [row[k] for row in rows]) for k, column in enumerate(EXTREMES)
        }
        table = [(row, row.unit) for row in EXTREMES]
        attributes = {name: str(value) for name, value in self._comments().items()}
        title = "extremes of the stress"
        return files.dataset(title, table, variables, {}, self.to_dict(), **attributes)

    def _comments(self) -> dict[str, object]:
        state = {"finished": self.finished, "friction": self.friction}
        return super()._comments() | state | self._numbered_warnings()

    def _file_rows(self) -> list[Sequence[object]]:
        return [[row.name for row in EXTREMES], *self._extremes()]

    def _extremes(self) -> Iterator[Extreme]:
        """Yield the rows of the table, without the heading."""
        parts: list[LayerStress | InterfaceStress] = [*self.layers, *self.interfaces]
        for part in parts:
            for name in part._PEAKS:
                if (peak := getattr(part, name)) is None:
                    continue
                value, place = peak
                error = part.uncertainty.get(name, np.nan)
                factor = getattr(part, FACTORS.get(name, ""), None)
                limit = np.nan if factor is None else factor
                yield display.part(part), name, value, error, *place, limit

    def _inputs(self) -> Rows:
        return [remark("traction", text) for text in _notes(self)]

    def _table(self) -> Printed:
        head, *rows = _peak_rows(self)
        return Printed(head, rows, _notes(self))

    def _tables(self) -> Sequence[Table]:
        head, *rows = _peak_rows(self)
        parts: list[LayerStress | InterfaceStress] = [*self.layers, *self.interfaces]
        for part in parts:
            words = display.part_in_words(part, self.layers).removeprefix("of ")
            rows = [[row[0].replace(display.part(part), words), *row[1:]] for row in rows]
        return [Table("Extremes", head, rows)]

    def _model(self) -> Rows:
        return [remark("theory", STRESSES), remark("±", SIZE_ERRORS)]

    def __repr__(self) -> str:
        """Return how much the summary holds."""
        return f"<StressSummary of {len(self.layers)} layers and {len(self.interfaces)} interfaces>"


@dataclass(frozen=True, repr=False)
class StressPlan:
    """A plan of the stress in one body of a solved contact: made once, evaluated many times.

    `Solution.stress_plan` makes it. An evaluation has the bits of `Solution.stress` and of
    `Solution.stress_summary`, without the time that these take to plan.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    >>> plan = solution.stress_plan()
    >>> peaks = [
    ...     plan.stress(10e-6, friction=mu, direction=(1, 0)).peak()[0] for mu in (0.0, 0.3)
    ... ]
    >>> peaks[0] < peaks[1]
    True
    """

    _plan: core.StressPlan = field(compare=False)
    """Plan of the compiled module."""
    _solution: Stressed
    """Solution, which is pickled in place of the plan."""
    _member: Member
    """Body of the solution."""
    _threads: int | None
    """Number of threads that was asked for."""

    @property
    def body(self) -> core.HalfSpace:
        """Body in which the stress is."""
        return self._plan.body

    @property
    def edge(self) -> Array:
        """Points (x, y) of the smooth edge of the contact ``(n, 2)`` [m], at most one in a cell.

        At the edge the stress at the surface has a kink, and with friction its largest tension:
        ``plan.stress(0.0, x=x, y=y, friction=...)`` gives it. Empty where the edge is not known
        within cells: sharp edges, rough surfaces, contacts of few cells, coatings about as thick as
        a cell, periodic grids. In line contact x is that of the strips' middle.
        """
        return self._plan.edge

    def stress(
        self,
        z: Depths,
        *,
        side: Side = "below",
        x: float | None = None,
        y: float | None = None,
        displacement: bool = False,
        friction: float = 0.0,
        direction: Direction | None = None,
        residual: ByLayer | None = None,
        progress: Progress | None = None,
    ) -> Stress:
        """Stress below the surface, at any depth; see `Solution.stress`.

        Parameters
        ----------
        z : float or array_like
            Depths into the body, at least 0 [m].
        side, x, y, displacement, friction, direction, residual, progress : optional
            As in `Solution.stress`.

        Returns
        -------
        Stress
            Components, invariants and displacement.

        Raises
        ------
        ValueError
            If an argument is out of range.
        MemoryError
            If the fields do not fit.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
        >>> solution.stress_plan().stress(10e-6) == solution.stress(10e-6)
        True
        """
        fields = StressFields(side, x, y, displacement)
        options = StressOptions(
            self._member, friction, components(direction), by_layer(residual), None, progress
        )
        return _warned(Stress(**core.stress(self._plan, z, fields, options)))

    def summary(
        self,
        *,
        yield_stress: Limits | None = None,
        strength: ByLayer | None = None,
        bond_strength: Bonds | None = None,
        friction: float = 0.0,
        direction: Direction | None = None,
        residual: ByLayer | None = None,
        progress: Progress | None = None,
    ) -> StressSummary:
        """Extremes in each layer and at each interface; see `Solution.stress_summary`.

        Parameters
        ----------
        yield_stress, strength, bond_strength : optional
            As in `Solution.stress_summary`.
        friction, direction, residual, progress : optional
            Likewise, with its bar.

        Returns
        -------
        StressSummary
            Peaks and their points; printing it shows a table.

        Raises
        ------
        ValueError
            If an argument is out of range.
        MemoryError
            If the grid does not fit.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
        >>> plan = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid).stress_plan()
        >>> summary = plan.summary(yield_stress={"substrate": 1.8e9})
        >>> bool(summary.layers[0].yield_safety_factor > 1.0)
        True
        """
        options = StressOptions(
            self._member, friction, components(direction), by_layer(residual), None, progress
        )
        limits = yield_stress, strength, bond_strength, None
        return _warned(self._solution._summary(self._plan, options, *limits))

    @property
    def _normal(self) -> Solution:
        return self._solution._normal

    def __repr__(self) -> str:
        """Return which body the plan is of."""
        return f"<StressPlan of the {self._member}>"

    def __reduce__(self) -> tuple[object, tuple[Member, int | None]]:
        """Return the method of the solution that makes the plan again, and its arguments."""
        return self._solution.stress_plan, (self._member, self._threads)


class Stressed:
    """Stresses below a solved contact, with or without friction."""

    _solved: core.Solved | core.FrictionSolved
    report: Any

    @property
    def _normal(self) -> Solution:
        """Contact below the traction; without friction this one."""
        return cast("Solution", getattr(self, "normal", self))

    @names_itself
    def stress(
        self,
        z: Depths,
        *,
        body: Member = "body",
        side: Side = "below",
        x: float | None = None,
        y: float | None = None,
        displacement: bool = False,
        friction: float = 0.0,
        direction: Direction | None = None,
        residual: ByLayer | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Stress:
        """Stress below the surface, at any depth of either body.

        Parameters
        ----------
        z : float or array_like
            Depths into the body, at least 0 [m].
        body : {"body", "counterbody"}, optional
            Body in which stress is evaluated. In the counterbody z points into that body, and x and
            y stay the same.
        side : {"below", "above"}, optional
            Side of an interface, for a depth that lies on one.
        x, y : float, optional
            Place of a vertical section. With one of them, the fields are kept on the line
            ``x = const`` or ``y = const`` at every depth, by linear interpolation between cell
            centres and free ends. With both they are those of the point itself, wherever the
            pressure around it is known within cells; displacements, and what free ends and the
            tractions of `nacre.slide` and `nacre.roll` add, are interpolated.
        displacement : bool, optional
            Whether displacements are evaluated too.
        friction : float, optional
            Coefficient of friction: adds the traction ``friction * pressure``. It must be 0 where
            the tractions are known, of `nacre.slide` and `nacre.roll`.
        direction : tuple of float or str, optional
            Direction ``(x, y)`` of the traction on the body, of any length, or ``"+x"`` to
            ``"-y"``; the traction on the
            counterbody is opposite. By default the direction in which the shape rolls,
            `Report.rolling_direction`: across the axis of a roller or cylinder, and across the
            strips of a line contact; x below a body of revolution that is pressed on its axis, as
            all are alike. Else it must be given where `friction` is above 0.
        residual : dict or sequence, optional
            Residual stress [Pa], equal along x and y, that is added in a layer. A dict maps layers
            to it, by number (0 at the surface) or name, and ``"substrate"``; a sequence holds it
            from the surface down.
        threads : int, optional
            Number of threads; by default all of the machine's, or what ``NACRE_NUM_THREADS`` says.
        progress : callable, optional
            Function that is called with the part of the work that is done, from 0 to 1; returning
            False stops, and gives the depths that are done.

        Returns
        -------
        Stress
            Components, invariants and displacement.

        Raises
        ------
        ValueError
            If an argument is out of range, or the counterbody is rigid.
        MemoryError
            If the fields do not fit.

        Notes
        -----
        The pressure varies within cells: inside the contact with the slopes and curvatures that
        neighbouring cells give, near a smooth edge as a square root. `nacre.stress` takes the
        pressure as uniform over a cell; within some cells of the surface the two differ. The
        tractions of `nacre.slide` and `nacre.roll` are uniform over cells; at single points they
        follow the pressure within the cells around.

        Friction does not change the pressure. That is exact where the bodies are alike or
        incompressible, and a good approximation where the friction is small: the neglected coupling
        changes the pressure by the order of ``friction * (1 - 2 nu) / (2 - 2 nu)``.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
        >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0)
        >>> above = solution.stress(body.interfaces[0], side="above")
        >>> below = solution.stress(body.interfaces[0])
        >>> bool(np.allclose(above.xz, below.xz)), bool(np.allclose(above.xx, below.xx))
        (True, False)
        """
        fields = StressFields(side, x, y, displacement)
        options = StressOptions(
            body, friction, components(direction), by_layer(residual), threads, progress
        )
        return _warned(Stress(**core.stress(self._solved, z, fields, options)))

    @names_itself
    @with_units(yield_stress="Pa", strength="Pa", residual="Pa")
    def stress_summary(
        self,
        *,
        body: Member = "body",
        yield_stress: Limits | None = None,
        strength: ByLayer | None = None,
        bond_strength: Bonds | None = None,
        friction: float = 0.0,
        direction: Direction | None = None,
        residual: ByLayer | None = None,
        refine: bool | float | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> StressSummary:
        """Extremes of the stress in each layer and at each interface, and safety factors.

        Stress is evaluated on the faces of the layers and at some 18 depths inside each, spread
        over its thickness and over the width of the contact. Peaks inside are then refined by
        parabolas through three depths.

        Parameters
        ----------
        body : {"body", "counterbody"}, optional
            Body in which stress is evaluated.
        yield_stress : dict or sequence, optional
            Yield stress [Pa] of layers. A dict maps layers to it, by number (0 at the surface) or
            name, and ``"substrate"``; a sequence holds it from the surface down, with None where it
            is not known. A card of `nacre.materials` stands for its number, in SI.
        strength : dict or sequence, optional
            Tensile strength [Pa] of layers, likewise.
        bond_strength : tuple of float or dict, optional
            Shear and tension that the interfaces bear [Pa], for the verdict: a pair for all, or
            ``{0: (shear, tension)}`` by number, or the name of the layer above. One of them may be
            None.
        refine : bool or float, optional
            Largest estimated error of the extremes, as a part of them, such as 0.01; True is 0.05.
            Patches that hold the places where value and error together exceed an extreme by more
            are solved again on finer cells, until the error is below it or a patch has as many
            cells as the grid or 512 × 512, whichever is more. By default, and with False, the cells
            of the grid are used. Not for `nacre.slide` and `nacre.roll`, periodic grids, surfaces
            that have yielded, given coefficients.
        friction, direction, residual, threads, progress : optional
            As in `stress`; without `progress`, a terminal or a notebook shows a bar after two
            seconds.

        Returns
        -------
        StressSummary
            Peaks and their points; printing it shows a table.

        Raises
        ------
        ValueError
            If an argument is out of range, or the counterbody is rigid; if there is nothing to
            `refine` from.
        MemoryError
            If the grid does not fit.

        Notes
        -----
        The pressure varies within cells, as in `stress`.

        Extremes may lie beyond the grid: below a stiff coating, or with friction, the largest
        tension can be outside the contact. Where an extreme is found in the outermost cells, and as
        far as layers bend under the load, wider grids are searched.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid)
        >>> summary = solution.stress_summary(yield_stress={"substrate": 1.8e9})
        >>> bool(summary.layers[0].yield_safety_factor > 1.0)
        True
        """
        error = (REFINED if refine else None) if isinstance(refine, bool) else refine
        options = StressOptions(
            body, friction, components(direction), by_layer(residual), threads, progress
        )
        limits = yield_stress, strength, bond_strength, error
        return _warned(self._summary(self._solved, options, *limits))

    def _summary(
        self,
        of: core.Solved | core.FrictionSolved | core.StressPlan,
        options: StressOptions,
        yield_stress: Limits | None,
        strength: ByLayer | None,
        bond_strength: Bonds | None,
        refine: float | None,
    ) -> StressSummary:
        """Return the extremes in a body, of the contact or of a plan of it."""
        yields = numbers_of(yield_stress, "yield_stress")
        limits = StressLimits(yields, by_layer(strength), refine)
        member = _check_limits_of(self, options.body, limits)
        contact = {"bond_strength": _bond_strengths(self, options.body, bond_strength)}
        with lasting("stresses", options.progress) as tell:
            fields = core.stress_summary(of, limits, replace(options, progress=tell))
        sliding = self._sliding(options.friction, options.direction, options.body)
        contact |= {"origins": names_of(yield_stress, member)} | _doubts_of(self)
        return StressSummary._from_fields(fields, sliding, **contact)

    def verdict(
        self,
        *,
        body: Member = "body",
        yield_stress: Limits | None = None,
        strength: ByLayer | None = None,
        bond_strength: Bonds | None = None,
        friction: float = 0.0,
        direction: Direction | None = None,
        residual: ByLayer | None = None,
        refine: bool | float | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Verdict:
        """Verdict on the layers: whether they hold, by which factor, and which of them decides.

        Parameters
        ----------
        body, yield_stress, strength, bond_strength : optional
            As in `stress_summary`.
        friction, direction, residual, refine : optional
            As in `stress_summary`.
        threads, progress : optional
            Likewise.

        Returns
        -------
        Verdict
            Verdict of the summary, `StressSummary.verdict`; printing it shows its sentences.

        Raises
        ------
        ValueError
            As `stress_summary`.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=5.0, max_cells=4096)
        >>> solution.verdict(yield_stress={"substrate": 0.5e9}).level
        'bad'
        """
        summary = self.stress_summary(
            body=body,
            yield_stress=yield_stress,
            strength=strength,
            bond_strength=bond_strength,
            friction=friction,
            direction=direction,
            residual=residual,
            refine=refine,
            threads=threads,
            progress=progress,
        )
        return summary.verdict()

    def _sliding(
        self, friction: float, direction: Pair | None, body: Member
    ) -> tuple[float, float]:
        """Return the traction on a body over the pressure, of arguments that were accepted."""
        if friction == 0:
            return (0.0, 0.0)
        rolling = self._normal.report.rolling_direction if direction is None else direction
        assert rolling is not None  # the compiled module refuses friction without a direction
        x, y = rolling
        scale = float(friction) / np.hypot(x, y) * (1 if body == "body" else -1)
        return (float(scale * x), float(scale * y))

    def stress_plan(self, body: Member = "body", threads: int | None = None) -> StressPlan:
        """Plan of the stress in one body, to be evaluated any number of times.

        Parameters
        ----------
        body : {"body", "counterbody"}, optional
            Body in which stress is evaluated.
        threads : int, optional
            Number of threads of the plan; by default as for `Contact`.

        Returns
        -------
        StressPlan
            Plan, which keeps the solution alive.

        Raises
        ------
        ValueError
            If there is no such body, the counterbody is rigid, or `threads` is below 1.
        MemoryError
            If the grid does not fit.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
        >>> plan = solution.stress_plan()
        >>> [plan.stress(z, friction=0.1, direction=(1, 0)).friction for z in (10e-6, 20e-6)]
        [(0.1, 0.0), (0.1, 0.0)]
        """
        return StressPlan(core.stress_plan(self._solved, body, threads), self, body, threads)


def stress(
    body: core.HalfSpace | core.Elastic,
    grid: core.Grid,
    pressure: Real | Sequence[Sequence[float] | Real],
    z: Depths,
    *,
    side: Side = "below",
    x: float | None = None,
    y: float | None = None,
    displacement: bool = False,
    friction: float = 0.0,
    direction: Direction | None = None,
    residual: ByLayer | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Stress:
    """Stress of a body under a pressure, at any depth.

    Parameters
    ----------
    body : HalfSpace or Elastic
        Body under the pressure; its free ends are counted, but not in the stress of friction.
    grid : Grid
        Cells of the pressure.
    pressure : array_like
        Pressure ``(nx, ny)`` on the cells [Pa], uniform over each.
    z : float or array_like
        Depths, at least 0 [m].
    side, x, y, displacement, friction, direction, residual, threads, progress : optional
        As in `Solution.stress`.

    Returns
    -------
    Stress
        Components, invariants and displacement.

    Raises
    ------
    ValueError
        If an argument is out of range.
    MemoryError
        If the fields do not fit.

    Notes
    -----
    The pressure is uniform over a cell. `Solution.stress` uses the pressure within cells of a
    solved contact, and is more accurate within some cells of the surface. Friction does not change
    the pressure, as there.

    Examples
    --------
    The normal stress under a uniformly loaded square, at the surface minus the pressure:

    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid(shape=(65, 65), size=(2e-3, 2e-3))
    >>> field = nacre.stress(steel, grid, np.full((65, 65), 1e9), [0.0, 0.5e-3], y=0.0)
    >>> field.zz.shape
    (2, 65)
    >>> bool(abs(field.zz[0, 32] + 1e9) < 1.0)
    True
    """
    fields = StressFields(side, x, y, displacement)
    options = StressOptions(
        "body", friction, components(direction), by_layer(residual), threads, progress
    )
    return Stress(**core.stress_under(body, grid, pressure, z, fields, options))


StressResult = TypeVar("StressResult", Stress, StressSummary)


def check_limits(name: str, limits: Sequence[float | None], body: core.HalfSpace) -> None:
    """Raise a `ValueError` unless limits are in the units of the moduli.

    They are those of the layers from the surface down, and of the substrate.
    """
    materials = [*(layer.material for layer in body.layers), body.substrate]
    for material, limit in zip(materials, limits, strict=False):
        if limit is None or not isinstance(material, core.Elastic) or not limit > 0:
            continue
        if not SOFTEST * material.young <= limit <= material.young:
            raise ValueError(
                f"{name} must be in the units of the moduli, between {SOFTEST:g} of the modulus "
                f"and itself, {material.young:g}; got {limit:g}"
            )


def _check_limits_of(solution: Stressed, member: Member, limits: StressLimits) -> object:
    """Return a body of a solution, whose limits must be in the units of the moduli."""
    report = solution._normal.report
    body = report.counterbody if among(member, ("counterbody",)) else report.body
    if isinstance(body, core.HalfSpace):
        for name in ("yield_stress", "strength"):
            check_limits(name, core.layer_values(body, name, getattr(limits, name)), body)
    return body


def _warned(result: StressResult) -> StressResult:
    """Issue the warnings of a result, at the line that called its function; return the result."""
    for message in result.warnings:
        warn(message)
    return result


def depth_charts(
    solution: Stressed | StressPlan,
    bare: Stressed | StressPlan | None = None,
    *,
    body: Member = "body",
    **sliding: Unpack[SlidingOptions],
) -> Iterator[Chart]:
    """Yield the chart of the von Mises stress against depth below the largest pressure.

    A `bare` solution, without the layers, is drawn beside the coated one. Plans of `body` stand for
    their solutions. There is none of bodies without stresses, of surfaces that have yielded and of
    large grids.
    """
    normal = solution._normal
    member = normal.report.counterbody if body == "counterbody" else normal.report.body
    if (
        not isinstance(member, core.HalfSpace)
        or not isinstance(member.substrate, core.Elastic)
        or not normal.contact_area > 0
        or normal.indentation.any()
        or normal.pressure.size > MOST_CELLS
    ):
        return
    widths = [high - low for low, high in normal.contact_extent if high > low]
    bottom = DEEPEST * min(widths, default=min(normal.grid.size))
    faces = [0.0, *(z for z in member.interfaces if z < bottom), bottom]
    enlarged = enlarged_depth(faces[1:-1], bottom)
    inset = (0.0, enlarged) if enlarged else None
    ends = sorted({*faces, *(inset or ())})
    count = np.clip(WORK // normal.pressure.size, *DEPTHS) / bottom
    counts = [max(INSIDE, round(count * (end - top))) for top, end in pairwise(ends)]
    parts = zip(pairwise(ends), counts, strict=True)
    within = np.concatenate([np.linspace(top, end, n, endpoint=False) for (top, end), n in parts])
    curve = _over_depth(solution, body, within, faces[1:], sliding)
    curves = [Curve(*curve, "" if bare is None else "coated")]
    if bare is not None:
        sliding.pop("residual", None)
        curve = _over_depth(bare, body, within, faces[1:], sliding)
        curves.append(Curve(*curve, "bare", "dashed"))
    axes = Axis("depth", "m"), Axis("von Mises stress", "Pa")
    words = ["Von Mises stress below the largest pressure"]
    words += ["dotted: interfaces"] if faces[1:-1] else []
    words += ["inset: the first three thicknesses of the coating"] if inset else []
    caption = "; ".join(words) + "."
    yield Chart(caption, curves, axes, faces[1:-1], inset)


def _over_depth(
    solution: Stressed | StressPlan,
    body: Member,
    within: Array,
    faces: list[float],
    sliding: SlidingOptions,
) -> tuple[Array, Array]:
    """Return depths and von Mises stresses; faces are there twice, for their two sides."""
    plan = solution if isinstance(solution, StressPlan) else solution.stress_plan(body)
    x, y = plan._normal.peak_position
    sides: tuple[tuple[Array, Side], ...] = ((within, "below"), (np.array(faces), "above"))
    fields = [plan.stress(z, x=x, y=y, side=side, **sliding) for z, side in sides]
    parts = [np.stack([*one.components.values()]).reshape(6, -1) for one in fields]
    depths, stresses = np.concatenate([within, faces]), np.concatenate(parts, axis=1)
    # The upper side of a face, which comes last here, stands first.
    order = np.lexsort((-np.arange(depths.size), depths))
    tops = np.searchsorted(depths[order], faces[:-1]) + 1
    pieces = [_between(depths[k], stresses[:, k]) for k in np.split(order, tops)]
    z, (xx, yy, zz, xy, yz, xz) = (
        np.concatenate(ones, axis=-1) for ones in zip(*pieces, strict=True)
    )
    squares = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return z, np.sqrt(0.5 * squares + 3.0 * (xy**2 + yz**2 + xz**2))


def _between(x: Array, values: Array) -> tuple[Array, Array]:
    """Return points between those of x, and values ``(n, x)`` there, by cubic parabolas."""
    at = np.interp(np.arange(BETWEEN * (x.size - 1) + 1) / BETWEEN, np.arange(x.size), x)
    nearest = np.clip(np.searchsorted(x, at) - 2, 0, x.size - 4)[:, None] + np.arange(4)
    nodes, own = x[nearest], np.eye(4, dtype=bool)
    ratios = (at[:, None, None] - nodes[:, None]) / np.where(
        own, 1.0, nodes[:, :, None] - nodes[:, None]
    )
    weights = np.where(own, 1.0, ratios).prod(axis=2)
    return at, (values[:, nearest] * weights).sum(axis=2)


def _notes(summary: StressSummary) -> list[str]:
    """Return what stands below the table: the friction, and whether it is unfinished."""
    sliding = []
    friction = summary.friction or (0.0, 0.0)
    if size := float(np.hypot(*friction)):
        x, y = (part / size + 0.0 for part in friction)  # of -0 this makes 0
        sliding = [f"friction {size:.4g}, traction along ({x:.4g}, {y:.4g})"]
    return sliding if summary.finished else [*sliding, UNFINISHED]


def doubt_of(solution: Stressed) -> str | None:
    """Return what leaves the pressure of a solution without a certain value, or None."""
    normal = solution._normal
    if not (solution.report.converged and normal.report.converged):
        return UNCONVERGED
    return joined(kinds_of(normal), "unknown")


def caution_of(solution: Stressed) -> str | None:
    """Return what leaves a verdict on a solution fair at best, or None."""
    return joined(kinds_of(solution._normal), "fair")


def kinds_of(normal: Solution) -> Iterator[str]:
    """Yield the kinds of the warnings of a contact, that of flat bodies by its size."""
    solved = cast(list[dict[str, Any]], normal.report._data["warnings"])
    for warning in solved:
        is_flat = warning["kind"] != "large contact" or warning["figure"] <= LARGEST_CONTACT
        yield warning["kind"] if is_flat else "very large contact"
    yield from normal.report.warning_kinds[len(solved) :]


def _doubts_of(solution: Stressed) -> dict[str, Any]:
    return {"doubt": doubt_of(solution), "caution": caution_of(solution)}


def _bond_strengths(
    solution: Stressed, member: Member, bonds: Bonds | None
) -> tuple[Bond | None, ...] | None:
    """Return shear and tension that each interface bears, checked; None without any."""
    if bonds is None:
        return None
    report = solution._normal.report
    body = report.counterbody if among(member, ("counterbody",)) else report.body
    layers = body.layers if isinstance(body, core.HalfSpace) else ()
    given: dict[Any, Any] = (
        by_layer(bonds) if isinstance(bonds, Mapping) else dict.fromkeys(range(len(layers)), bonds)
    )
    strengths: list[Bond | None] = []
    for k, layer in enumerate(layers):
        names = [name for name in (k, layer.name, f"interfaces[{k}]") if name in given]
        strength = given.pop(names[0]) if names else None
        if strength is not None:
            pair = _shear_and_tension(strength)
            if not all(one is None or 0 < one < np.inf for one in pair):
                raise ValueError(f"bond_strength must be above 0 and finite, got {strength!r}")
            strength = pair
        strengths.append(strength)
    if given:
        raise ValueError(f"bond_strength must be of layers above an interface, got {[*given]!r}")
    return tuple(strengths)


def _shear_and_tension(strength: object) -> Bond:
    """Return shear and tension that an interface bears, or raise a `ValueError`."""
    if not isinstance(strength, Sequence) or len(strength) != 2:
        raise ValueError(f"bond_strength must be (shear, tension) [Pa], got {strength!r}")
    shear, tension = (one if one is None else core.real("bond_strength", one) for one in strength)
    return shear, tension


def _gaps(summary: StressSummary) -> Iterator[str]:
    """Yield sentences on cards that have no yield stress of a layer without a limit."""
    for layer, name in zip(summary.layers, summary.origins or (), strict=False):
        card = materials.get(name) if name is not None else None
        if card is not None and layer.yield_safety_factor is None:
            yield from (f"{gap}." for gap in card.gaps)


def _demands(summary: StressSummary) -> Iterator[Demand]:
    """Yield the stresses of layers and interfaces, with their limits."""
    noise = SLIGHT * max((layer.von_mises[0] for layer in summary.layers), default=0.0)
    for layer in summary.layers:
        peaks = {name: _demand(summary, layer, name, words) for name, words in WORDS.items()}
        limited = [demand for demand in peaks.values() if demand.limit is not None]
        pulled = layer.tension[0] > noise and layer.depths[1] < np.inf
        need = peaks["tension" if pulled else "von_mises"]
        yield from limited
        # The yield stress of a brittle coat says nothing of its tension.
        if need.value > noise and need.limit is None and (pulled or not limited):
            yield need
    for face in summary.interfaces:
        bonds = dict(enumerate(summary.bond_strength or ()))
        for name, limit in zip(
            ("shear", "tension"), bonds.get(face.interface) or (None, None), strict=True
        ):
            demand = _demand(summary, face, name, name, limit)
            if demand.value > noise or limit is not None:
                yield demand


def _demand(
    summary: StressSummary,
    place: LayerStress | InterfaceStress,
    name: str,
    words: str,
    limit: float | None = None,
) -> Demand:
    """Return an extreme as a demand, with a limit that its safety factor may have."""
    value, (_, _, depth) = getattr(place, name)
    factor = getattr(place, FACTORS.get(name, ""), None)
    limit = limit if factor is None else factor * value
    limit = limit if limit is None or value > 0 else np.inf
    part = display.part_in_words(place, summary.layers)
    sentence = None if limit != np.inf else f"{words[0].upper()}{words[1:]} {part}: none."
    cards = dict(enumerate(summary.origins or ())) if name == "von_mises" else {}
    card = cards.get(getattr(place, "layer", -1))
    origin = "given" if card is None else f"card {card}"
    error = place.uncertainty.get(name)
    return Demand(words, part, value, error, depth, limit, origin, sentence=sentence)


def _peak_rows(summary: StressSummary) -> list[list[str]]:
    """Return the rows of the table of a stress summary, the heading first."""
    rows = [["", "largest", "value", "±", "z", "x, y", "safety factor"]]
    noise = display.SLIGHT * max((layer.von_mises[0] for layer in summary.layers), default=0.0)
    peaks = [peak for layer in summary.layers for peak in (layer.von_mises, layer.tension)]
    dust = display.SLIGHT * max((abs(part) for _, place in peaks for part in place), default=0.0)

    def add(name: str, peak: Peak | None, error: float | None, factor: float | None = None) -> None:
        if peak is None:
            return
        value, (x, y, z) = peak
        if name == "tension" and abs(value) < noise:
            # A tension that falls to nothing far away has no place.
            share = written(error, "Pa") if error is not None and error > noise else ""
            rows.append(["", name, written(0.0, "Pa"), share, "", "", ""])
            return
        share = ""
        if error is not None:
            # Of small parts, such as the tension at an interface, a share says nothing.
            is_small = error >= abs(value) and error > 0
            share = written(error, "Pa") if is_small else display.share(error, value)
        place = ", ".join(written(one if abs(one) > dust else 0.0, "m", 3) for one in (x, y))
        number = "" if factor is None else rounded(factor, 3)
        rows.append(["", name, written(value, "Pa"), share, written(z, "m"), place, number])

    for layer in summary.layers:
        start, (top, bottom) = len(rows), layer.depths
        error = layer.uncertainty.get
        add("von Mises", layer.von_mises, error("von_mises"), layer.yield_safety_factor)
        add("tension", layer.tension, error("tension"), layer.strength_safety_factor)
        add("shear", layer.max_shear, error("max_shear"))
        ends = f"{written(top, 'm')} to {written(bottom, 'm')}"
        rows[start][0] = f"{display.part(layer)}, {ends}" if bottom < np.inf else "substrate"
    names = {layer.layer: layer.name for layer in summary.layers}
    for face in summary.interfaces:
        start, above = len(rows), names.get(face.interface)
        error = face.uncertainty.get
        add("tension", face.tension, error("tension"))
        add("compression", face.compression, error("compression"))
        add("shear", face.shear, error("shear"))
        add("in-plane jump", face.jump, error("jump"))
        below = "" if above is None else f" below {above}"
        rows[start][0] = f"interfaces[{face.interface}]{below} at {written(face.depth, 'm')}"
    return rows
