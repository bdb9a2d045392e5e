"""Two bearings with contact angles on one shaft, preloaded: one equilibrium of both.

The inner rings move with the shaft, which is rigid, and the outer ones stand still. Contacts and
kinematics are those of the single bearings; each ring is set along the axis by its preload.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import KW_ONLY, dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, Unpack, get_args

import numpy as np
import numpy.typing as npt

from nacre._tools.arguments import read_fields
from nacre._tools.groups import grouped, in_unit, keyword_units, names_itself
from nacre._tools.notices import heard
from nacre._tools.typing import among
from nacre._tools.units import rounded
from nacre.bearing.arguments import BearingKeywords, BearingOptions, Operation, RingConditions
from nacre.bearing.balls import AngularContactBall
from nacre.bearing.cone import check_carried
from nacre.bearing.contact_laws import Law, Reaction, Several, are_equal
from nacre.bearing.equilibrium import Problem, Shaft, State
from nacre.bearing.geometry import Ring, above, bearing_from
from nacre.bearing.iso import Edge
from nacre.bearing.life import LINE, POINT
from nacre.bearing.rating_life import LATER, basic_row, compared, hours_per_revolution, required
from nacre.bearing.rollers import TaperedRoller
from nacre.bearing.solution import (
    VECTORS,
    BearingReport,
    BearingSolution,
    Equilibrium,
    stiffness_table,
)
from nacre.bearing.solving import (
    as_arrays,
    centrifugal_force,
    check_sides,
    element_angles,
    find_equilibrium,
    issue,
    largest_of,
    read_conditions,
    solution_of,
    solve_bearing,
    solved_contacts,
)
from nacre.bearing.verdict import bearing_verdict, life_verdict
from nacre.results import display, files
from nacre.results.charts import Picture
from nacre.results.quantities import AXIS, frozen, quantity
from nacre.results.report import Rows, Table, input_rows
from nacre.results.rows import Row, remark
from nacre.results.shown import TableResult
from nacre.results.values import decode, encode, refusing
from nacre.results.verdict import Verdict, asked, merged

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Array = npt.NDArray[np.float64]
Arrangement = Literal["O", "X", "tandem"]
ARRANGEMENTS = '"O" (back to back, DB), "X" (face to face, DF) or "tandem" (DT)'
"""Arrangements in words."""
Single = AngularContactBall | TaperedRoller

NAMES = ("first", "second")
"""Names of both bearings."""
THRUSTS: dict[str, tuple[int, int]] = {"O": (1, -1), "X": (-1, 1), "tandem": (1, 1)}
"""Directions along z of the thrusts on the shaft that first and second bearing carry."""
FARTHEST = 100.0
"""Largest distance over the pitch diameter: shafts as long bend more than their bearings."""
PRELOAD_STEPS = 50
"""Newton steps, at least, for the place of the rings without load: it takes some five."""
STANDSTILL = Operation(0.0, 0.0, "inner")
"""Operation in which bearings are preloaded."""


@dataclass(frozen=True)
class Pair:
    """Two single-row angular contact ball or tapered roller bearings on one rigid shaft.

    z is the axis of the shaft. The first bearing is at ``z = -distance/2`` and the second one at
    ``z = distance/2``; moments and displacements are about the middle between them. Both inner
    rings move with the shaft, and the outer rings stand still.

    Parameters
    ----------
    first, second : AngularContactBall or TaperedRoller
        Bearings, both of one kind.
    arrangement : {"O", "X", "tandem"}
        "O", back to back: the lines of contact meet the axis outside of the bearings, and the first
        one carries the thrust on the shaft along z, the second one that against it. "X", face to
        face: they meet it towards the middle, and the first bearing carries the thrust against z.
        "tandem": both carry that along z.
    distance : float
        Distance of the reference points of both bearings [m]: the middles of tapered rollers, or
        the centres of the inner grooves of balls in contact, ``(f_i − 1/2) D sin α`` from the
        middles of the balls, along the thrust that the bearing carries.
    preload_force : float, optional
        Axial force of each bearing without load, at standstill [N]. "O" and "X" alone have one.
    preload_distance : float, optional
        How far the rings of both bearings together are pressed along the axis beyond touching [m];
        below 0 they have as much axial play. Without either preload they just touch.

    Raises
    ------
    TypeError
        If a bearing is of another kind.
    ValueError
        If an argument is out of range, the bearings differ in kind, both preloads are given, or
        there is a preload in tandem, where no bearing holds against it.

    Examples
    --------
    >>> import math
    >>> from nacre.bearing import AngularContactBall, Pair
    >>> ball = AngularContactBall(
    ...     count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=math.radians(25)
    ... )
    >>> pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
    >>> solution = pair.solve(force=(0.0, 0.0, 300.0), model="iso16281")
    >>> [round(one.force[2]) for one in (solution.first, solution.second)]
    [371, 71]
    """

    first: Single
    """Bearing at ``z = -distance/2``."""
    second: Single
    """Bearing at ``z = distance/2``."""
    _: KW_ONLY
    arrangement: Arrangement
    """Arrangement."""
    distance: float = field(metadata=in_unit("m"))
    """Distance of the reference points of both bearings [m]."""
    preload_force: float | None = field(default=None, metadata=in_unit("N"))
    """Axial force of each bearing without load [N]."""
    preload_distance: float | None = field(default=None, metadata=in_unit("m"))
    """How far the rings of both bearings together are pressed beyond touching [m]."""

    def __post_init__(self) -> None:
        """Check the arguments."""
        for name, bearing in zip(NAMES, self.bearings, strict=True):
            if not isinstance(bearing, Single):
                raise TypeError(
                    f"{name} must be an AngularContactBall or a TaperedRoller, which carry thrust "
                    f"to one side, got {bearing!r}"
                )
        if type(self.first) is not type(self.second):
            raise ValueError(
                f"second must be of the kind of first, {type(self.first).__name__}, "
                f"got {self.second!r}"
            )
        if not among(self.arrangement, get_args(Arrangement)):
            raise ValueError(f"arrangement must be {ARRANGEMENTS}, got {self.arrangement!r}")
        read_fields(self)
        above("distance", self.distance)
        most = FARTHEST * max(bearing.pitch for bearing in self.bearings)
        if self.distance > most:
            raise ValueError(
                f"distance must be at most {most:.3g} m, {FARTHEST:g} pitch diameters: bearings "
                f"are in N, m, Pa and kg; got {self.distance!r}"
            )
        self._check_preload()

    def _check_preload(self) -> None:
        """Raise a `ValueError` unless there is one preload at most, in range."""
        force, distance = self.preload_force, self.preload_distance
        if force is not None and distance is not None:
            raise ValueError(
                "preload_force and preload_distance must not both be given, "
                f"got {force!r} and {distance!r}"
            )
        if self.arrangement == "tandem" and (force or distance):
            name = "preload_force" if force else "preload_distance"
            raise ValueError(
                f"{name} must be None in tandem, where no bearing holds against a preload, "
                f"got {force or distance!r}"
            )
        limits = [largest_of(bearing) for bearing in self.bearings]
        largest_force = min(limit["force"] for limit in limits)
        if force is not None and not 0 <= force <= largest_force:
            raise ValueError(
                f"preload_force must be from 0 to {largest_force:.3g} N, got {force!r}"
            )
        farthest = min(limit["displacement"] for limit in limits) / 10
        if distance is not None and not abs(distance) <= farthest:
            raise ValueError(
                f"preload_distance must be at most {farthest:.3g} m, a tenth of the diameter of an "
                f"element, got {distance!r}"
            )

    @property
    def bearings(self) -> tuple[Single, Single]:
        """Both bearings."""
        return self.first, self.second

    @grouped(RingConditions, Operation, BearingOptions)
    def solve(self, **keywords: Unpack[BearingKeywords]) -> PairSolution:
        """Equilibrium of the shaft and of all elements of both bearings.

        Each of the five degrees of freedom of the shaft is loaded, prescribed, or neither: it is
        then locked at 0. Displacements count from the place of the shaft without load at
        standstill; with play, from the middle of it.

        Parameters
        ----------
        force : sequence of float or None, optional
            Forces ``(x, y, z)`` on the shaft [N]; along an axis with a number the displacement is
            found. None stands for None along all axes, here and below.
        displacement : sequence of float or None, optional
            Displacements ``(x, y, z)`` of the shaft in the middle between the bearings [m].
        moment : sequence of float or None, optional
            Moments about x and y on the shaft, about the middle between the bearings [N m].
        tilt : sequence of float or None, optional
            Slopes of the shaft about x and y: tangents of its angles.
        rotation : float, optional
            Angle of element 0 of both bearings from the x axis [rad].
        speed : float, optional
            Angular velocity of the rings that rotate [rad/s]. Centrifugal forces add to the
            preload, whose distance stays.
        rotating : {"inner", "outer"}, optional
            Rings that rotate.
        model : {"solved", "iso16281"}, optional
            Contacts that nacre solves, or those of ISO/TS 16281, as of single bearings.
        cells : tuple of int, optional
            Cells of a contact, as of single bearings.
        tolerance : float, optional
            Largest mismatch of forces and moments, relative to those of the elements.
        max_iterations : int, optional
            Newton steps before it gives up.
        threads : int, optional
            Number of contacts that are solved side by side; by default as for `nacre.Contact`.
        progress : callable, optional
            Function that is called with the number of Newton steps and the mismatch after each;
            returning False stops, and gives the unfinished solution.
        check : bool, optional
            Whether to raise an error if the tolerance was not met.
        required_life : float, optional
            Life of both that is required [h], which the verdict judges; it needs a speed.
        static_safety : float, optional
            Static safety s_0 that is required of each; by default 1.5 of rollers and 1 of balls.

        Returns
        -------
        PairSolution
            Loads of the shaft, and the solution of each bearing.

        Raises
        ------
        ValueError
            If an argument is out of range, a degree of freedom is both loaded and prescribed, or
            no equilibrium carries the loads together.
        ConvergenceError
            If the tolerance was not met; the unfinished solution is its `solution`.

        Examples
        --------
        >>> import math
        >>> from nacre.bearing import Pair, TaperedRoller
        >>> tapered = TaperedRoller(
        ...     count=17, diameter=8e-3, length=11e-3, pitch_diameter=48e-3, contact_angle=0.25
        ... )
        >>> pair = Pair(tapered, tapered, arrangement="X", distance=50e-3, preload_distance=10e-6)
        >>> solution = pair.solve(force=(4000.0, 0.0, 0.0), moment=(0.0, 0.0), model="iso16281")
        >>> [round(one.force[0]) for one in (solution.first, solution.second)]
        [2000, 2000]
        """
        ring, operation = RingConditions.of(keywords), Operation.of(keywords)
        return solve_pair(self, ring, operation, BearingOptions.of(keywords))

    def _arguments(self) -> dict[str, object]:
        """Return what makes the pair again, for files."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def _ways(pair: Pair) -> list[Array]:
    """Return how the ring of each bearing moves with the shaft ``(5, 5)``.

    Its axes are a mirror image of the shaft's where it carries the thrust against z.
    """
    ways = []
    for side, sign in zip((-0.5, 0.5), THRUSTS[pair.arrangement], strict=True):
        way, z = np.eye(5), side * pair.distance
        way[0, 4], way[1, 3] = z, -z
        ways.append(np.diag([1, 1, sign, sign, sign]) @ way)
    return ways


def _touching(bearing: Single) -> float:
    """Return the displacement of the inner ring along z at which all elements touch [m]."""
    if isinstance(bearing, TaperedRoller):
        return bearing.play / (2 * math.tan(bearing.nominal_angle))
    return 0.0


def _settings(pair: Pair, options: BearingOptions) -> Array:
    """Return the displacements along z of both inner rings without load, each in its own axes."""
    settings = np.array([_touching(bearing) for bearing in pair.bearings])
    if pair.preload_force:
        axial = RingConditions((None, None, pair.preload_force), None, None, None)
        alone = [solve_bearing(pair.first, axial, STANDSTILL, options)]
        if pair.second == pair.first:
            alone *= 2
        else:
            alone += [solve_bearing(pair.second, axial, STANDSTILL, options)]
        return np.array([solution.displacement[2] for solution in alone])
    settings += (pair.preload_distance or 0.0) / 2
    if (pair.preload_distance or 0.0) > 0 and pair.first != pair.second:
        free = RingConditions((None, None, 0.0), None, None, None)
        _, state, _ = _equilibrium(pair, free, STANDSTILL, options, settings)
        settings += np.array(THRUSTS[pair.arrangement]) * state.ring[2]
    return settings


def _read(pair: Pair, conditions: RingConditions) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Return loads, displacements, and which of the five directions are loaded, checked."""
    first, second = (largest_of(bearing) for bearing in pair.bearings)
    largest = {name: first[name] + second[name] for name in first} | {"tilt": 1.0}
    largest["moment"] += (first["force"] + second["force"]) * pair.distance
    return as_arrays(*read_conditions(conditions, largest))


def _equilibrium(
    pair: Pair,
    conditions: RingConditions,
    operation: Operation,
    options: BearingOptions,
    settings: Array,
) -> tuple[Problem, State, tuple[int, str]]:
    """Return the equilibrium of the shaft with rings that are set so far along their axes."""
    loads, moved, free = _read(pair, conditions)
    bearings = pair.bearings
    motions = [bearing.motion(element_angles(bearing, operation.rotation)) for bearing in bearings]
    shaft = Shaft(motions, _ways(pair), settings)
    counts = [bearing.elements for bearing in bearings]
    laws = [bearing.law(options.model) for bearing in bearings]
    forces = [centrifugal_force(bearing, operation) for bearing in bearings]
    pressed = [law.approach(force) for law, force in zip(laws, forces, strict=True)]
    problem = Problem(shaft, Several(laws, counts), loads, free, np.repeat(forces, counts)[:, None])
    check_carried(shaft.generators(), loads, problem.thrust, free, shaft.arm)

    def contacts(state: State) -> Several:
        places = [state.places[rows] for rows in shaft.slices]
        if pair.first == pair.second and are_equal(*places):
            return Several([solved_contacts(pair.first, laws[0], places[0], options)] * 2, counts)
        each = zip(bearings, laws, places, strict=True)
        return Several([solved_contacts(*contact, options) for contact in each], counts)

    def check(problem: Problem, state: State, tolerance: float) -> None:
        each = zip(NAMES, bearings, _problems(problem, state), strict=True)
        for name, bearing, (local, equilibrium) in each:
            remedy = f"preload or thrust of the {name} bearing"
            check_sides(bearing, local, equilibrium, tolerance, remedy)

    start = problem.start(moved, np.repeat(pressed, counts))
    return find_equilibrium(problem, start, contacts, check, options)


def _problems(problem: Problem, state: State) -> Iterator[tuple[Problem, State]]:
    """Yield problem and state of each bearing, in its own axes."""
    shaft, laws = problem.kinematics, problem.law
    assert isinstance(shaft, Shaft)
    assert isinstance(laws, Several)
    for k, (rows, reaction) in enumerate(
        zip(shaft.slices, laws.split(state.reaction), strict=True)
    ):
        ring = shaft.ways[k] @ state.ring
        ring[2] += shaft.set_to[k]
        none = np.zeros(5, dtype=bool)
        force = np.asarray(problem.centrifugal)[rows]
        local = Problem(shaft.parts[k], laws.laws[k], np.zeros(5), none, force)
        equilibrium = replace(local, law=_constant(reaction)).state(ring, state.own[rows])
        equilibrium.balance = state.balance
        yield local, equilibrium


def _constant(reaction: Reaction) -> Law:
    """Return a law that has one reaction."""
    return lambda _: reaction


def _check_tandem(pair: Pair, solutions: Iterable[BearingSolution], loaded: bool) -> None:
    """Raise a `ValueError` unless an axial force keeps the rings of balls in tandem together."""
    if pair.arrangement != "tandem" or not pair.first.needs_thrust or not loaded:
        return
    pushed = axial = 0.0
    for solution in solutions:
        pushed += math.hypot(*solution.force[:2]) * math.tan(solution.bearing.nominal_angle)
        axial += solution.force[2]
    if axial < pushed:
        raise ValueError(
            f"force along z must be at least {pushed:.6g} N, by which the radial forces push the "
            f"rings apart, got {axial:.6g}"
        )


def solve_pair(
    pair: Pair, conditions: RingConditions, operation: Operation, options: BearingOptions
) -> PairSolution:
    """Return the solution of what a user asked of a pair."""
    for bearing in pair.bearings:
        operation, options = operation.checked(bearing), options.checked(bearing)
    with heard():
        limit = max(PRELOAD_STEPS, options.max_iterations)
        quiet = replace(options, max_iterations=limit, progress=None, check=True)
        settings = _settings(pair, quiet)
    problem, state, ending = _equilibrium(pair, conditions, operation, options, settings)
    equilibria = zip(pair.bearings, _problems(problem, state), strict=True)
    first, second = (
        solution_of(bearing, operation, options, local, equilibrium, ending)
        for bearing, (local, equilibrium) in equilibria
    )
    if ending[1] == "converged":
        _check_tandem(pair, (first, second), bool(problem.free[2]))
    total = (state.wanting + problem.loads).tolist()
    notes = tuple(
        f"{name} bearing: {text}"
        for name, solution in zip(NAMES, (first, second), strict=True)
        for text in solution.report.warnings
    )
    solution = PairSolution(
        pair=pair,
        displacement=tuple(state.ring[:3].tolist()),
        tilt=tuple(state.ring[3:].tolist()),
        force=tuple(total[:3]),
        moment=tuple(total[3:]),
        first=first,
        second=second,
        tangent=(state.tangent + state.tangent.T) / 2,
        report=BearingReport(ending[1], ending[0], state.balance, notes),  # type: ignore[arg-type]
    )
    issue(solution, options)
    return solution


@frozen()
class PairLife(TableResult):
    """Reference rating lives of ISO/TS 16281 of a pair: a model, at 90 % reliability.

    Both bearings survive independently, so that ``L^-e = L_1^-e + L_2^-e`` with the Weibull slope
    e of Lundberg and Palmgren, 10/9 of balls and 9/8 of rollers; Harris, Rolling Bearing Analysis.

    Examples
    --------
    >>> from nacre.bearing import AngularContactBall, Pair
    >>> ball = AngularContactBall(
    ...     count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
    ... )
    >>> pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
    >>> life = pair.solve(force=(2000.0, 0.0, 0.0), model="iso16281").life()
    >>> round(life.revolutions / min(life.first, life.second), 3)
    0.536
    """

    _TITLE = "reference rating life of a pair of bearings"
    _IN_SI = True

    revolutions: float = quantity(label="life of both")
    """Life of both in revolutions: 10 % of such pairs lose a bearing in it."""
    hours: float | None = quantity()
    """Life of both in hours: of operation; None where the bearings are at rest."""
    first: float = quantity(label="first bearing")
    """Life of the first bearing in revolutions; infinite without load."""
    second: float = quantity(label="second bearing")
    """Life of the second bearing in revolutions; infinite without load."""
    basic_life: float | None = quantity()
    """Basic rating life L_10 of ISO 281 of both in millions of revolutions; None if not known."""
    model: str
    """Model in words."""
    reliability: float = 0.9
    """Share of pairs that reach the life."""
    modification_factor: float | None = None
    """Factor a_ISO of the bearing that lives shorter; None without lubrication."""
    required_life: float | None = None
    """Life that is required [h], which decides the verdict; None without."""

    uncertainty: float | None = None
    """Estimated error, as a share of the life, as that of a single bearing."""
    doubt: str | None = None
    """What leaves the verdict unknown; None without."""
    caution: str | None = None
    """What leaves the verdict fair at best; None without."""
    comparison: str | None = None
    """Why the basic life differs, or is not known, as that of a single bearing."""
    notes: tuple[str, ...] = ()
    """Numbers beyond their plausible ranges, which were warned of."""

    _LATER = ("reliability", "modification_factor", "required_life", *LATER)
    _of: ClassVar[str] = "both bearings, "

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        usual = {"reliability": state.get("reliability") or 0.9}
        return super()._restored(state | usual | {"notes": tuple(state.get("notes") or ())})

    @asked
    def verdict(self, required_life: float | None = None) -> Verdict:
        """Verdict: how long both live; `BearingLife.verdict` says more."""
        return life_verdict(required(self, required_life))

    def _rows(self) -> list[Row]:
        rows = []
        for row in (row for row in self._QUANTITIES if row.label):
            life = row.of(self)
            text = f"{rounded(life / 1e6, 4)} million revolutions"
            words = "infinite: no element is loaded"
            rows.append(Row(row.name, row.label, text if life < math.inf else words, life))
        if self.hours is not None and math.isfinite(self.hours):
            rows.append(Row("hours", "hours", rounded(self.hours, 4), self.hours))
        if self.basic_life is not None and math.isfinite(self.basic_life):
            rows.append(basic_row(self.basic_life, hours_per_revolution(self)))
        return rows

    def _remarks(self) -> list[Row]:
        return [*compared(self.comparison), *super()._remarks()]

    def _report_rows(self) -> Rows:
        return self._rows()


def _both(lives: Array, slope: float) -> tuple[float, Array]:
    """Return the life of both bearings, and the weights of the failures of each."""
    shortest = float(lives.min())
    shares = shortest / lives if math.isfinite(shortest) else np.ones(2)
    weights = shares**slope
    return shortest * float(weights.sum()) ** (-1 / slope), weights


@frozen(eq=False)
class PairSolution(Equilibrium):
    """A solved pair of bearings on a shaft.

    Each bearing is a `BearingSolution` in its own axes, in which z presses its inner ring into
    contact: ``first.force[2]`` is the thrust that it carries. Where that is against z of the shaft,
    the bearing is seen in a mirror: its z, its moments and its tilts are opposite to the shaft's,
    while x, y and the angles of elements are the same. Its displacements count from where its
    rings are in the middle of each other and, of balls, touch.

    Examples
    --------
    >>> from nacre.bearing import AngularContactBall, Pair
    >>> ball = AngularContactBall(
    ...     count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
    ... )
    >>> pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
    >>> solution = pair.solve(force=(500.0, 0.0, 0.0), moment=(0.0, 0.0), model="iso16281")
    >>> solution.first.loaded, solution.report.converged
    (12, True)
    """

    _TITLE = "pair of bearings"
    _DERIVED = ("_life",)
    _LATER = ("life",)

    pair: Pair
    """Pair that was solved."""
    displacement: tuple[float, float, float] = quantity(
        "m", dims=("direction",), label="displacement"
    )
    """Displacement of the shaft [m], in the middle between the bearings, along x, y and z."""
    tilt: tuple[float, float] = quantity(dims=AXIS, label="tilt")
    """Slopes of the shaft: about x and y."""
    force: tuple[float, float, float] = quantity("N", dims=("direction",), label="force")
    """Force on the shaft [N], which both bearings balance, along x, y and z."""
    moment: tuple[float, float] = quantity("N m", dims=AXIS, label="moment")
    """Moment on the shaft [N m], about x and y and the middle between the bearings."""
    first: BearingSolution
    """Solution of the first bearing, in its own axes."""
    second: BearingSolution
    """Solution of the second bearing, in its own axes."""
    tangent: Array
    """Stiffness of the pair ``(5, 5)``, which `stiffness` returns."""
    report: BearingReport
    """Report: how the solution came about, with the warnings of both bearings."""
    _life: PairLife | None = field(default=None, repr=False)
    """Life that was asked for, which the verdict has."""

    @property
    def bearings(self) -> tuple[BearingSolution, BearingSolution]:
        """Solutions of both bearings."""
        return self.first, self.second

    @property
    def required_life(self) -> float | None:
        """Life of both that is required [h]; None without."""
        return self.first.required_life

    @asked
    def verdict(
        self, required_life: float | None = None, static_safety: float | None = None
    ) -> Verdict:
        """Verdict: life of both, loads and pressures of each; `BearingSolution.verdict` says more.

        Parameters
        ----------
        required_life : float, optional
            Life of both that is required [h], by default that of `solve`.
        static_safety : float, optional
            Static safety that is required of each, by default that of `solve`.

        Returns
        -------
        Verdict
            Verdict; unknown where no life and no static safety is required.
        """
        life = required(self._life or self.life(), required_life)
        parts = {f"of the {k} bearing": s for k, s in zip(NAMES, self.bearings, strict=True)}
        return bearing_verdict(parts, life, self.first._safety(static_safety))

    @property
    def peak_pressure(self) -> float:
        """Largest pressure of all contacts [Pa]."""
        return max(solution.peak_pressure for solution in self.bearings)

    @property
    def edge_pressure(self) -> float:
        """Largest pressure in the outer tenths of a roller of either bearing [Pa]; NaN of balls."""
        return max(bearing.edge_pressure for bearing in self.bearings)

    @property
    def largest_load(self) -> float:
        """Largest force of a contact [N]."""
        return max(solution.largest_load for solution in self.bearings)

    def stiffness(self) -> Array:
        """Exact tangent stiffness ``(5, 5)`` of forces and moments over displacements and tilts.

        Returns
        -------
        numpy.ndarray
            Derivatives of ``(F_x, F_y, F_z, M_x, M_y)`` on the shaft with respect to
            ``(δ_x, δ_y, δ_z, θ_x, θ_y)``, in N/m, N and N m.

        Examples
        --------
        >>> from nacre.bearing import AngularContactBall, Pair
        >>> ball = AngularContactBall(
        ...     count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
        ... )
        >>> pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
        >>> axial = pair.solve(model="iso16281").stiffness()[2, 2]
        >>> one = ball.solve(force=(None, None, 200.0), model="iso16281").stiffness()[2, 2]
        >>> bool(abs(axial / one - 2) < 1e-6)
        True
        """
        return self.tangent.copy()

    def plot(self) -> dict[str, Axes]:
        """Draw loads over the angle and pressures of both bearings.

        Needs ``nacre-contact[plot]``.

        Returns
        -------
        dict of matplotlib.axes.Axes
            The axes, by name, as those of `nacre.plot.bearing_pair`.

        Examples
        --------
        >>> from nacre.bearing import AngularContactBall, Pair
        >>> ball = AngularContactBall(
        ...     count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
        ... )
        >>> pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
        >>> len(pair.solve(model="iso16281").plot())
        4
        """
        from nacre import plot

        return plot.bearing_pair(self)

    @names_itself
    def life(
        self, edge: Edge = "standard", *, rotating: Ring | None = None, **modification: Any
    ) -> PairLife:
        """Rate the bearings by ISO/TS 16281: lives of each and of both together.

        Parameters
        ----------
        edge : {"standard", "pressure"} or None, optional
            Factors for the edges of rollers, as those of `BearingSolution.life`.
        rotating : {"inner", "outer"}, optional
            Rings that rotate against the load; by default those that rotate in `solve`.
        **modification
            Reliability, lubrication, speed and required life, as those of `BearingSolution.life`.

        Returns
        -------
        PairLife
            Lives in revolutions and hours.

        Raises
        ------
        ValueError
            If there is no such kind of factors, factors from the pressure are asked of contacts
            that are those of the standard, or there is a spectrum.

        Examples
        --------
        >>> from nacre.bearing import AngularContactBall, Pair
        >>> ball = AngularContactBall(
        ...     count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
        ... )
        >>> pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
        >>> life = pair.solve(force=(0.0, 0.0, 2000.0), model="iso16281").life()
        >>> life.second  # it has lost contact
        inf
        """
        if modification.pop("spectrum", None) is not None:
            raise ValueError("spectrum must not be given: solve the pair under each of its loads")
        hours_required = modification.pop("required_life", None) or self.required_life
        first, second = (
            solution.life(edge, rotating=rotating, **modification) for solution in self.bearings
        )
        slope = LINE if isinstance(self.pair.first, TaperedRoller) else POINT
        lives = np.array([first.revolutions, second.revolutions])
        both, shares = _both(lives, slope)
        shorter = min(first, second, key=lambda life: life.revolutions)
        basic = [life for life in (first.basic_life, second.basic_life) if life is not None]
        # Each error counts by the share of failures that are those of the bearing.
        errors = np.array([first.uncertainty, second.uncertainty], dtype=np.float64)
        error = float(np.average(errors, weights=shares))
        hours = [life.hours for life in (first, second) if life.hours is not None]
        life = PairLife(
            revolutions=both,
            hours=_both(np.array(hours), slope)[0] if len(hours) == 2 else None,
            first=first.revolutions,
            second=second.revolutions,
            model=first.model,
            reliability=first.reliability,
            modification_factor=shorter.modification_factor,
            uncertainty=None if math.isnan(error) else error,
            doubt=merged(first.doubt, second.doubt),
            caution=merged(first.caution, second.caution),
            basic_life=_both(np.array(basic), slope)[0] if len(basic) == 2 else None,
            comparison=first.comparison or second.comparison,
            notes=tuple(dict.fromkeys([*first.notes, *second.notes])),
        )
        return required(life, hours_required)

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of the shaft's numbers and of both bearings'; needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Numbers by name, with units; those of a bearing begin with ``first_`` or ``second_``.
        """
        table, variables = [], {}
        for prefix, solution in (("", self), *zip(NAMES, self.bearings, strict=True)):
            for row in solution._QUANTITIES:
                if (value := row.of(solution)) is not None:
                    name = f"{prefix}_{row.name}".strip("_")
                    dims = [f"{prefix}_{dim}" if dim == "element" else dim for dim in row.dims]
                    table.append((row.renamed(name), row.si()))
                    variables[name] = (dims, np.asarray(value))
        with self._units():
            return files.dataset(self._TITLE, table, variables, {}, self.to_dict())

    def _inputs(self) -> Rows:
        values = {field.name: getattr(self.pair, field.name) for field in fields(self.pair)}
        names = ("model", "rotation", "speed", "rotating", "cells")
        values |= {name: getattr(self.first, name) for name in names}
        if self.pair.second == self.pair.first:
            values["second"] = "as the first"
        units = keyword_units(type(self.pair), type(self.pair.first), Operation)
        loads = [row for row in self._rows() if row.key in ("force", "moment")]
        return [*input_rows(values, units), *loads]

    def _report_rows(self) -> Rows:
        rows = [
            row._replace(key=f"{name}.{row.key}", label=f"{name}: {row.label}")
            for name, bearing in zip(NAMES, self.bearings, strict=True)
            for row in bearing._report_rows()
        ]
        return [*(() if self._life is None else self._life._rows()), *self._rows(), *rows]

    def _charts(self) -> Sequence[Picture]:
        return [
            picture._replace(caption=f"{name.capitalize()} bearing. {picture.caption}")
            for name, bearing in zip(NAMES, self.bearings, strict=True)
            for picture in bearing._charts()
        ]

    def _tables(self) -> Sequence[Table]:
        tables = [
            elements._replace(title=f"{elements.title}, {name} bearing")
            for name, bearing in zip(NAMES, self.bearings, strict=True)
            for elements in bearing._tables()
        ]
        return [stiffness_table(self.tangent), *tables]

    def _model(self) -> Rows:
        return [*self.first._model(), *(() if self._life is None else self._life._model())]

    def _notebook_picture(self) -> bytes | None:
        return self._heavier._notebook_picture()

    def _comments(self) -> dict[str, object]:
        numbers = {"model": self.first.model, **self._vector_texts()}
        return super()._comments() | numbers | self._numbered_warnings()

    def _file_rows(self) -> Iterable[Iterable[object]]:
        (heads, *first), (_, *second) = (solution._file_rows() for solution in self.bearings)
        yield ["bearing", *heads]
        for name, elements in zip(NAMES, (first, second), strict=True):
            yield from ([name, *row] for row in elements)

    @property
    def _heavier(self) -> BearingSolution:
        """Bearing with the larger load of an element."""
        return max(self.bearings, key=lambda bearing: bearing.largest_load)

    def _rows(self) -> list[Row]:
        rows = []
        for row in self._QUANTITIES:
            values = [self._heavier._rounded(row.name, value) for value in row.of(self)]
            text = display.pair(values, row.si())
            rows.append(Row(row.name, row.label, text, values, row.si()))
        for name, bearing in zip(NAMES, self.bearings, strict=True):
            forces = {"thrust": bearing.force[2], "radial": math.hypot(*bearing.force[:2])}
            texts = [
                f"{word} {display.number(self._heavier._rounded('force', value), 'N')}"
                for word, value in forces.items()
            ]
            digits = bearing._digits("peak_pressure")
            pressure = display.estimated(bearing, "peak_pressure", "Pa", digits)
            texts += [f"peak pressure {pressure}"]
            texts += [f"{bearing.loaded} of {bearing.bearing.elements} loaded"]
            rows.append(remark(f"{name} bearing", ", ".join(texts)))
        return rows

    def _remarks(self) -> list[Row]:
        contacts = "ISO/TS 16281, a model" if self.first.model != "solved" else "solved contacts"
        return [remark("contacts", contacts), self._ended()]

    def _state(self) -> dict[str, object]:
        state = {name: list(getattr(self, name)) for name in VECTORS}
        results = {name: getattr(self, name)._state() for name in (*NAMES, "report")}
        pair = {name: encode(value) for name, value in self.pair._arguments().items()}
        life = encode(self._life)
        return {"pair": pair, **state, **results, "tangent": self.tangent.tolist(), "life": life}

    @classmethod
    def _names(cls) -> list[str]:
        return [*super()._names(), "life"]

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        with refusing(cls.__name__):
            arguments = dict(state["pair"])
            bearings: dict[str, Any] = {name: bearing_from(arguments.pop(name)) for name in NAMES}
            first, second = (BearingSolution._restored(dict(state[name])) for name in NAMES)
            vectors: dict[str, Any] = {name: tuple(map(float, state[name])) for name in VECTORS}
            solution = cls(
                pair=Pair(**bearings, **arguments),
                first=first,
                second=second,
                **vectors,
                tangent=np.array(state["tangent"], dtype=np.float64),
                report=BearingReport._restored(dict(state["report"])),
                _life=decode(state["life"]),
            )
            solution._check()
            return solution

    def _check(self) -> None:
        """Raise a `ValueError` unless all fields fit each other."""
        for name in NAMES:
            if getattr(self, name).bearing != getattr(self.pair, name):
                raise ValueError(f"{name} must be a solution of that bearing of the pair")
        if not isinstance(self._life, PairLife | None):
            raise ValueError(f"life must be a PairLife or None, got {self._life!r}")
        self._check_vectors()
