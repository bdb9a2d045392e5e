"""Indentations: planned, solved, and the contacts as numbers and fields."""

from __future__ import annotations

import copyreg
import math
import types
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Generic, Literal, Self, get_args, overload

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.groups import with_units
from nacre._tools.notices import warn
from nacre._tools.paths import numbered
from nacre._tools.progress import check_progress
from nacre._tools.typing import Field, Layers, Matrix, Vector, among
from nacre._tools.units import written
from nacre.indent._reading import apparent_modulus, checked_tolerance, substrate_verdict
from nacre.results import display
from nacre.results.base import Fields, Result, Warned
from nacre.results.charts import Axis, Chart, Curve
from nacre.results.quantities import derived, frozen, quantity
from nacre.results.report import Rows, Table, input_rows, table
from nacre.results.rows import Row, remark
from nacre.results.shown import Printed, Shown
from nacre.results.values import decode, encode, refusing
from nacre.results.verdict import Verdict, asked, judged

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from typing_extensions import TypeVar

    Value = TypeVar("Value", bound=float | Field, default=Any)
    """A float of one contact, or an array of several."""
else:
    from typing import TypeVar

    Value = TypeVar("Value")

Variable = Literal["load", "approach", "radius"]
Branch = Literal["stable", "unstable"]
Control = Literal["load", "approach"]
Numbers = float | Vector | Matrix
PointProgress = Callable[[int, int], object]
"""Function that is told the number of finished contacts and of all."""

NUMBERS = ("load", "approach", "radius", "stiffness", "outer_radius", "central_pressure")
"""Numbers of each contact that are kept."""
PULLED = ("pull_off_load", "pull_off_approach", "pull_off_radius")
"""Numbers of the pull-off."""
ARGUMENTS = ("body", "tip", "counterbody", "adhesion")
KINDS: tuple[type | types.UnionType, ...] = (
    core.HalfSpace,
    core.Tip,
    core.HalfSpace | None,
    core.Adhesion | None,
)
"""Classes of the arguments."""
MODEL = (
    (
        "theory",
        "linear elasticity of layered half-spaces under an axisymmetric tip, without friction and "
        "without a grid: integral equations, to rounding",
    ),
    ("not counted", "plastic flow, creep, viscosity, roughness, pile-up, tilt of the sample"),
)
"""What a report says of the model."""
ROWS = 30
"""Largest number of contacts that are printed."""


def holds(*arguments: object) -> bool:
    """Return whether these values are of the kinds that an indentation is made of."""
    return all(isinstance(one, kind) for one, kind in zip(arguments, KINDS, strict=True))


@dataclass(frozen=True)
class StateDerivative(Fields, Generic[Value]):
    """Derivatives of contacts of an indentation with respect to one parameter, in their shape.

    Examples
    --------
    >>> body = nacre.HalfSpace(nacre.Elastic(70e9, 0.33))
    >>> test = nacre.indent.Indentation(body, nacre.indent.Tip.paraboloid(10e-6))
    >>> contact = test.at(load=1e-3)
    >>> change = contact.derivatives(["body.substrate.young"])["body.substrate.young"]
    >>> round(change.approach * 70e9 / contact.approach, 6)  # Hertz: -2/3
    -0.666667
    """

    radius: Value
    """Derivative of the contact radius."""
    load: Value
    """Derivative of the load."""
    approach: Value
    """Derivative of the approach."""
    stiffness: Value
    """Derivative of the stiffness."""
    outer_radius: Value
    """Derivative of the radius up to which the surfaces attract each other."""
    _states: core.IndentStates
    """Contacts of the compiled module."""
    _path: str
    """Path of the parameter."""

    def pressure(self, r: Numbers) -> Any:
        """Return the derivative of the pressure at distances r from the axis [m].

        It is 0 outside of the contact. Its shape is that of the contacts followed by that of r.
        """
        return self._states.field("pressure", r, self._path)

    def displacement(self, r: Numbers) -> Any:
        """Return the derivative of the displacement of both surfaces together.

        It is that at distances r from the axis [m].
        """
        return self._states.field("displacement", r, self._path)


@frozen(eq=False)
class IndentSolution(Shown, Warned, Result, Generic[Value]):
    """Contacts of an indentation, with all that they depend on.

    `Indentation.at` and `nacre.indent.solve` return it. Numbers have the shape of the load,
    approach or radius that was given: each is a float or an array.

    Examples
    --------
    >>> body = nacre.HalfSpace(nacre.Elastic(70e9, 0.33))
    >>> test = nacre.indent.Indentation(body, nacre.indent.Tip.sphere(10e-6))
    >>> contacts = test.at(load=[1e-3, 2e-3])
    >>> contacts.approach.shape, contacts.pressure([0.0, 1e-7, 2e-7]).shape
    ((2,), (2, 3))
    """

    _TITLE = "indentation of a coated body"
    _LATER = ("warnings", "tolerance")

    body: core.HalfSpace
    """Body that is indented."""
    tip: core.Tip
    """Form of the tip."""
    counterbody: core.HalfSpace | None
    """Material of the tip; None where it is rigid."""
    adhesion: core.Adhesion | None
    """Adhesion of the surfaces."""
    given: Variable
    """Which of load, approach and radius was given."""
    branch: Branch
    """Branch of the contacts, "stable" or "unstable"."""
    control: Control
    """What is held while the tip is pulled off."""
    load: Value = quantity("N", label="load")
    """Load, below 0 where the tip is pulled [N]."""
    approach: Value = quantity("m", label="approach")
    """Approach [m]."""
    radius: Value = quantity("m", label="radius")
    """Contact radius [m]."""
    stiffness: Value = quantity("N/m", label="stiffness")
    """Stiffness of this contact area [N/m]: that of unloading, and without adhesion the slope of
    the curve."""
    outer_radius: Value = quantity("m")
    """Radius up to which the surfaces attract each other [m].

    It is that of the contact except for Maugis's adhesion.
    """
    warnings: tuple[str, ...] = ()
    """What makes the contacts doubtful, in sentences, usually none: slopes above 0.5.

    Each was also issued as a `nacre.NacreWarning`.
    """
    tolerance: float | None = None
    """Largest error of the modulus of the film that is tolerated, as a part of it, if given."""

    @classmethod
    def _of(
        cls,
        test: Indentation,
        states: core.IndentStates,
        variable: Variable,
        branch: Branch,
        control: Control,
        tolerance: float | None = None,
    ) -> Self:
        """Return contacts of the compiled module, and issue their warnings."""
        messages = states.warnings()
        # Faster than a call of the class, which is a tenth of a simple contact.
        solution = object.__new__(cls)
        solution.__dict__.update(
            body=test.body,
            tip=test.tip,
            counterbody=test.counterbody,
            adhesion=test.adhesion,
            given=variable,
            branch=branch,
            control=control,
            load=states.number("load"),
            approach=states.number("approach"),
            radius=states.number("radius"),
            stiffness=states.number("stiffness"),
            outer_radius=states.number("outer_radius"),
            warnings=tuple(messages),
            tolerance=tolerance,
            indentation=test,
            _states=states,
        )
        for message in messages:
            warn(message)
        return solution

    @cached_property
    def indentation(self) -> Indentation:
        """Indentation that was solved, planned again if need be."""
        return Indentation(self.body, self.tip, self.counterbody, adhesion=self.adhesion)

    @cached_property
    def _states(self) -> core.IndentStates:
        """Contacts of the compiled module, solved again."""
        arguments: dict[str, Any] = {self.given: getattr(self, self.given)}
        return self.indentation._planned.at(self.branch, **arguments)

    @property
    def state(self) -> Self:
        """The contacts themselves."""
        return self

    @cached_property
    def stiffness_slope(self) -> Value:
        """Derivative of the stiffness with respect to the contact radius [N/m^2]."""
        slope: Value = self._states.number("stiffness_slope")
        return slope

    @cached_property
    @derived("Pa", label="central pressure")
    def central_pressure(self) -> Value:
        """Pressure on the axis [Pa], infinite below a sharp tip."""
        pressure: Value = self.pressure(0.0)
        return pressure

    def pressure(self, r: Numbers) -> Any:
        """Return the pressure [Pa] at distances r from the axis [m].

        It is 0 outside of the contact, and infinite below a sharp tip and at a sharp edge. Its
        shape is that of the contacts followed by that of r.
        """
        return self._states.field("pressure", r)

    def displacement(self, r: Numbers) -> Any:
        """Return the displacement of both surfaces together [m], positive into the bodies.

        It is that at distances r from the axis [m].
        """
        return self._states.field("displacement", r)

    def gap(self, r: Numbers) -> Any:
        """Return the gap between tip and surface [m] at distances r from the axis [m].

        It is infinite beyond the tip.
        """
        return self._states.field("gap", r)

    def stress(self, r: Numbers, z: float) -> dict[str, Any]:
        """Stresses in the body below the surface.

        Parameters
        ----------
        r : array_like
            Distances from the axis [m].
        z : float
            Depth [m], at least 1e-2 of the contact radius. On an interface the stresses are those
            below it.

        Returns
        -------
        dict of str to numpy.ndarray
            rr, tt, zz, rz and von_mises [Pa], tension positive, each in the shape of the contacts
            followed by that of r.

        Raises
        ------
        ValueError
            If the depth is too small or below a rigid base, or a distance is negative.
        """
        return dict(self._states.stress(r, z))

    def derivatives(self, wrt: Sequence[str] | None = None) -> dict[str, StateDerivative[Value]]:
        """Differentiate the contacts with respect to parameters, where what was given is held.

        Parameters
        ----------
        wrt : list of str, optional
            Paths as `Indentation.parameters` lists them; all of them by default.

        Returns
        -------
        dict of str to StateDerivative
            Derivatives of all numbers and fields of the contacts, per unit of the parameter.

        Raises
        ------
        ValueError
            If there is no such parameter.
        """
        states = self._states
        paths = states.parameters() if wrt is None else wrt
        return {
            path: StateDerivative(*states.derivatives(number), states, number)
            for path, number in zip(paths, self.indentation._numbered(paths), strict=True)
        }

    @cached_property
    def _pulled(self) -> dict[str, float]:
        if self.adhesion is None:
            return dict.fromkeys(PULLED, math.nan)
        last = self.indentation.pull_off(self.control)
        return {name: getattr(last, name.removeprefix("pull_off_")) for name in PULLED}

    @property
    @derived("N")
    def pull_off_load(self) -> float:
        """Load of the last stable contact of a tip that is pulled [N]; NaN without adhesion."""
        return self._pulled["pull_off_load"]

    @property
    @derived("m")
    def pull_off_approach(self) -> float:
        """Approach of that contact [m]."""
        return self._pulled["pull_off_approach"]

    @property
    @derived("m")
    def pull_off_radius(self) -> float:
        """Radius of that contact [m]."""
        return self._pulled["pull_off_radius"]

    @classmethod
    def _names(cls) -> list[str]:
        names = ("given", "branch", "control", *NUMBERS, "pull_off", "warnings", "tolerance")
        return [*ARGUMENTS, *names]

    def _state(self) -> dict[str, object]:
        state = {name: encode(getattr(self, name)) for name in ARGUMENTS}
        state |= {name: getattr(self, name) for name in ("given", "branch", "control")}
        state |= {name: np.asarray(getattr(self, name)).tolist() for name in NUMBERS}
        state |= {"pull_off": self._pulled, "warnings": list(self.warnings)}
        return state | {"tolerance": self.tolerance}

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        with refusing("IndentSolution"):
            for name in ARGUMENTS:
                state[name] = decode(state[name])
            for name in NUMBERS:
                values = np.array(state[name], dtype=np.float64)
                state[name] = values if values.ndim else float(values)
            state["warnings"] = tuple(state["warnings"] or ())
            state["tolerance"] = checked_tolerance(state["tolerance"])
            pulled, central = state.pop("pull_off"), state.pop("central_pressure")
            solution = cls(**state)
            solution.__dict__["central_pressure"] = central
            solution.__dict__["_pulled"] = {name: float(pulled[name]) for name in PULLED}
            if not (
                holds(solution.body, solution.tip, solution.counterbody, solution.adhesion)
                and len({np.shape(getattr(solution, name)) for name in NUMBERS}) == 1
                and solution.given in get_args(Variable)
                and solution.branch in get_args(Branch)
                and solution.control in get_args(Control)
                and all(isinstance(text, str) for text in solution.warnings)
            ):
                raise TypeError("its parts do not fit together")
        return solution

    def to_xarray(self) -> xarray.Dataset:
        """Return the contacts with units and all that they depend on.

        Needs ``nacre-contact[files]``.
        """
        from nacre.indent._files import indentation

        return indentation(self)

    def _file_rows(self) -> Iterable[list[object]]:
        from nacre.indent._files import contact_rows

        return contact_rows(self)

    def _inputs(self) -> Rows:
        inputs = {name: getattr(self, name) for name in ARGUMENTS}
        inputs |= {name: getattr(self, name) for name in ("given", "branch", "control")}
        inputs |= {} if self.tolerance is None else {"tolerance": self.tolerance}
        return input_rows(inputs | {"counterbody": self.counterbody or "rigid"})

    def _report_rows(self) -> Rows:
        rows = [remark(name, self._range(name)) for name in NUMBERS[:4]]
        for name, value in self._pulled.items() if self.adhesion is not None else ():
            rows.append(Row(name, name.replace("_", " "), with_unit(value, name), value))
        return rows

    def _charts(self) -> list[Chart]:
        """Return the chart of load over depth, or of the pressure of a single contact."""
        if np.size(self.load) > 1:
            curve = Curve(np.ravel(self.approach), np.ravel(self.load), look="marked")
            return [Chart("Load over depth.", [curve], (Axis("approach", "m"), Axis("load", "N")))]
        edge = float(np.ravel(self.outer_radius)[0])
        x = np.linspace(0.0, 1.1 * edge, 221)[1:]  # a sharp tip presses without limit at 0
        axes = Axis("distance from the axis", "m"), Axis("pressure", "Pa")
        caption = "Pressure over the distance from the axis."
        return [Chart(caption, [Curve(x, np.ravel(self.pressure(x)))], axes)]

    @asked
    def verdict(self, tolerance: float | None = None) -> Verdict:
        """Return the verdict: whether the largest depth tells the modulus of the outermost layer.

        It compares with a bare half-space of the layer that bears the same load at the same depth,
        without adhesion.

        Parameters
        ----------
        tolerance : float, optional
            Largest error of the modulus, as a part of it, such as 0.1: beyond it the verdict is
            bad, and good up to two thirds of it. Without, it is that of `solve`; without that, the
            verdict is unknown.

        Returns
        -------
        Verdict
            Verdict, whose `factor` is the tolerance over the error; unknown of a body without
            layers.

        Raises
        ------
        ValueError
            If the tolerance is not above 0 and finite.

        Examples
        --------
        >>> glass, film = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
        >>> body = nacre.HalfSpace(glass, [nacre.Layer(film, thickness=1e-6)])
        >>> tip = nacre.indent.Tip.sphere(5e-6)
        >>> verdict = nacre.indent.solve(body, tip, load=1e-3).verdict(tolerance=0.1)
        >>> verdict.level, verdict.lines[0]
        ('bad', 'The error is below 10 % only up to 1.91 nm of depth.')
        """
        tolerance = checked_tolerance(tolerance)
        try:
            reading = apparent_modulus(self)
        except ValueError as error:  # as of a ring, or a tip that ends, where adhesion has none
            return judged([], doubts=[f"without adhesion {error}"])
        return substrate_verdict(reading, tolerance)

    def _sentences(self) -> tuple[str, ...]:
        return super()._sentences() if self.body.layers else ()

    def _notebook_picture(self) -> bytes | None:
        return display.drawn(self.plot)

    def _tables(self) -> Sequence[Table]:
        return [table("Contacts", self._file_rows())]

    def _model(self) -> Rows:
        return [remark(*words) for words in MODEL]

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw the load as a function of the approach, or of one contact the pressure.

        Needs ``nacre-contact[plot]``.
        """
        from nacre.plot import indent

        return indent.contacts(self, axes)

    def __eq__(self, other: object) -> bool:
        """Return whether all is equal, to the bit."""
        if not isinstance(other, IndentSolution):
            return NotImplemented
        # Texts tell NaN from other numbers, and equal NaN.
        return str(self.to_dict()) == str(other.to_dict())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Return a line with the numbers of the contact, or their ranges."""
        count = np.size(self.load)
        ranges = ", ".join(f"{name} {self._range(name)}" for name in NUMBERS[:3])
        return f"<IndentSolution: {count} contact{'s' if count != 1 else ''}, {ranges}>"

    def _range(self, name: str) -> str:
        values = np.ravel(getattr(self, name))
        ends = dict.fromkeys(with_unit(float(f(values)), name) for f in (np.min, np.max))
        return " to ".join(ends)

    def _table(self) -> Printed:
        """Return the table of the contacts."""
        quantities = [row for row in self._QUANTITIES if row.label]
        columns = [np.ravel(row.of(self)).tolist() for row in quantities]
        rows = [
            [with_unit(value, column.name) for value, column in zip(row, quantities, strict=True)]
            for row in list(zip(*columns, strict=True))[:ROWS]
        ]
        notes = []
        if (more := np.size(self.load) - ROWS) > 0:
            notes.append(f"and {more} more contacts")
        if self.adhesion is not None:
            pulled = (f"{n.rpartition('_')[2]} {with_unit(v, n)}" for n, v in self._pulled.items())
            notes.append(f"pull-off: {', '.join(pulled)}")
        return Printed([row.label for row in quantities], rows, notes, side=">")


IndentState = IndentSolution
"""Another name of `IndentSolution`."""
UNITS = {row.name: row.unit for row in IndentSolution._QUANTITIES}
"""SI units of the numbers of an indentation."""


@frozen(eq=False, repr=True)
class IndentCurve(Warned):
    """Loads at approaches, with their derivatives; see `Indentation.curve`."""

    approach: Field = quantity("m")
    """Approaches [m]."""
    load: Field = quantity("N")
    """Loads [N]."""
    radius: Field = quantity("m")
    """Contact radii [m]."""
    slope: Field = quantity("N/m")
    """dP/dδ along the curve [N/m]."""
    derivatives: Field
    """Derivatives of the loads at given approach, (points, parameters), per unit of each parameter.
    """
    warnings: list[str]
    """What makes the deepest point doubtful: a list of sentences, usually empty.

    Each was also issued as a `nacre.NacreWarning`.
    """


@frozen(repr=True)
class PullOff(Fields):
    """Last stable state of a tip that is pulled off; see `Indentation.pull_off`."""

    load: float = quantity("N")
    """Load [N], below 0."""
    approach: float = quantity("m")
    """Approach [m]."""
    radius: float = quantity("m")
    """Contact radius [m]; 0 where the surfaces attract each other without touching."""
    outer_radius: float = quantity("m")
    """Radius up to which the surfaces attract each other [m]."""


class Indentation:
    """An axisymmetric tip on a stack of layers, planned once: exact, and without a grid.

    Parameters
    ----------
    body : HalfSpace or Elastic
        Body that is indented.
    tip : Tip
        Form of the tip.
    counterbody : HalfSpace or Elastic, optional
        Material of the tip; rigid by default.
    adhesion : Adhesion, optional
        Adhesion of the surfaces; none by default.

    Raises
    ------
    ValueError
        If a body has free ends, or the tip cannot have this adhesion.

    Examples
    --------
    >>> glass, film = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
    >>> body = nacre.HalfSpace(glass, [nacre.Layer(film, thickness=1e-6)])
    >>> test = nacre.indent.Indentation(body, nacre.indent.Tip.sphere(5e-6))
    >>> contact = test.at(load=1e-3)
    >>> f"{contact.approach * 1e9:.1f} nm, contact radius {contact.radius * 1e9:.0f} nm"
    '115.5 nm, contact radius 938 nm'
    """

    __slots__ = ("_adhesion", "_planned", "_tip")

    _planned: core.Indentation
    _tip: core.Tip
    _adhesion: core.Adhesion | None

    def __new__(
        cls,
        body: Layers,
        tip: core.Tip,
        counterbody: Layers | None = None,
        *,
        adhesion: core.Adhesion | None = None,
    ) -> Self:
        """Plan the indentation."""
        indentation = super().__new__(cls)
        indentation._planned = core.Indentation(body, tip, counterbody, adhesion)
        indentation._tip, indentation._adhesion = tip, adhesion
        return indentation

    @property
    def body(self) -> core.HalfSpace:
        """Body that is indented."""
        return self._planned.body()

    @property
    def counterbody(self) -> core.HalfSpace | None:
        """Material of the tip; None where it is rigid."""
        return self._planned.counterbody()

    @property
    def tip(self) -> core.Tip:
        """Form of the tip."""
        return self._tip

    @property
    def adhesion(self) -> core.Adhesion | None:
        """Adhesion of the surfaces, or None."""
        return self._adhesion

    @property
    def surface_modulus(self) -> float:
        """Contact modulus E* at the surfaces [Pa], which small contacts feel."""
        return self._planned.surface_modulus()

    @property
    def parameters(self) -> list[str]:
        """Paths of the parameters with respect to which there are derivatives."""
        return self._planned.parameters()

    @overload
    def at(
        self,
        *,
        load: float | None = None,
        approach: float | None = None,
        radius: float | None = None,
        branch: Branch = "stable",
        progress: PointProgress | None = None,
    ) -> IndentSolution[float]: ...
    @overload
    def at(
        self,
        *,
        load: Vector | Matrix | None = None,
        approach: Vector | Matrix | None = None,
        radius: Vector | Matrix | None = None,
        branch: Branch = "stable",
        progress: PointProgress | None = None,
    ) -> IndentSolution[Field]: ...
    def at(
        self,
        *,
        load: Numbers | None = None,
        approach: Numbers | None = None,
        radius: Numbers | None = None,
        branch: Branch = "stable",
        progress: PointProgress | None = None,
    ) -> IndentSolution:
        """Contacts by load, approach or contact radius.

        Parameters
        ----------
        load, approach, radius : float or array_like
            Loads [N], approaches [m] or contact radii [m] of any shape; exactly one of them.
        branch : {"stable", "unstable"}, optional
            Branch of the curve where adhesion gives two contacts the same load or approach.
        progress : callable, optional
            Function that is called with the number of finished contacts and of all contacts. Its
            result is ignored.

        Returns
        -------
        IndentSolution
            Contacts in the shape of what was given.

        Raises
        ------
        ValueError
            If not exactly one is given, where nothing touches, where the contact would be larger
            than the tip or than 1024 times the thickness of the top layer, and where it is a ring:
            pressure and gap of every contact are checked.
        """
        return self._at(
            {"load": load, "approach": approach, "radius": radius}, branch, "load", progress
        )

    def _at(
        self,
        numbers: Mapping[Variable, object],
        branch: Branch,
        control: Control,
        progress: PointProgress | None = None,
        tolerance: float | None = None,
    ) -> IndentSolution:
        check_progress(progress)
        values: dict[str, Any] = {str(name): one for name, one in numbers.items()}
        states = self._planned.at(branch, **values, progress=progress)
        # What was given is the value that is not None.
        name = next(name for name, value in numbers.items() if value is not None)
        return IndentSolution._of(self, states, name, branch, control, tolerance=tolerance)

    def curve(self, *, approach: Vector, wrt: Sequence[str] = ()) -> IndentCurve:
        """Compute loads at approaches with their derivatives, by interpolation in the radius.

        The error of the interpolation is 1e-9: for fits.

        Parameters
        ----------
        approach : array_like
            Approaches [m], of one dimension.
        wrt : list of str, optional
            Paths of parameters, as `parameters` lists them.

        Returns
        -------
        IndentCurve
            Load, radius, slope and derivatives, all 0 where nothing touches.

        Raises
        ------
        ValueError
            If the adhesion is Maugis's, the largest approach needs too large a contact, or a
            contact is a ring.
        """
        curve = IndentCurve(*self._planned.curve(approach, self._numbered(wrt)))
        for message in curve.warnings:
            warn(message)
        return curve

    def _numbered(self, paths: Sequence[str]) -> list[str]:
        """Return paths with the numbers of layers in place of their names."""
        return numbered({"body": self.body, "counterbody": self.counterbody}, paths)

    def pull_off(self, control: Control = "load") -> PullOff:
        """Last stable state of the tip as it is pulled off under a given load or approach.

        Parameters
        ----------
        control : {"load", "approach"}, optional
            What is given while it is pulled.

        Returns
        -------
        PullOff
            Load, approach and radii.

        Raises
        ------
        ValueError
            If there is no adhesion.

        Examples
        --------
        >>> test = nacre.indent.Indentation(
        ...     nacre.Elastic(1e6, 0.5),
        ...     nacre.indent.Tip.paraboloid(1e-5),
        ...     adhesion=nacre.indent.Adhesion.jkr(0.05),
        ... )
        >>> last = test.pull_off()
        >>> round(last.load / (-1.5 * 3.141592653589793 * 0.05 * 1e-5), 9)
        1.0
        """
        return PullOff(*self._planned.pull_off(control))

    def snap_in(self, control: Control = "load") -> IndentSolution:
        """Return the contact into which the tip jumps as it comes near.

        It comes near under no load (`control` "load"), or to the approach at which the surfaces
        begin to attract each other ("approach"): 0 for JKR's adhesion, -work/strength for Maugis's.
        """
        states = self._planned.snap_in(control)
        return IndentSolution._of(self, states, control, "stable", control)

    def work_from_pull_off(self, force: float, control: Control = "load") -> float:
        """Return the work of adhesion [J/m^2] from the force of pull-off [N], above 0.

        It is that of JKR's adhesion where this indentation has none, else of its own kind.
        """
        return self._planned.work_from_pull_off(force, control)

    def __repr__(self) -> str:
        """Return the call that makes the plan."""
        others = "" if self.counterbody is None else f", {self.counterbody!r}"
        if self.adhesion is not None:
            others += f", adhesion={self.adhesion!r}"
        return f"Indentation({self.body!r}, {self.tip!r}{others})"

    def __reduce__(self) -> tuple[object, ...]:
        """Return a callable and arguments with which a pickle of any protocol plans again."""
        arguments = (self.body, self.tip, self.counterbody), {"adhesion": self.adhesion}
        return copyreg.__newobj_ex__, (type(self), *arguments)  # type: ignore[attr-defined]


def with_unit(value: float, name: str) -> str:
    """Return a number of an indentation with its unit."""
    return written(value, UNITS[name], 4) if math.isfinite(value) else str(value)


@with_units(load="N", approach="m", radius="m")
def solve(
    body: Layers,
    tip: core.Tip,
    counterbody: Layers | None = None,
    *,
    adhesion: core.Adhesion | None = None,
    load: npt.ArrayLike | None = None,
    approach: npt.ArrayLike | None = None,
    radius: npt.ArrayLike | None = None,
    branch: Branch = "stable",
    control: Control = "load",
    tolerance: float | None = None,
    progress: PointProgress | None = None,
) -> IndentSolution:
    """Solve an indentation to a result that can be saved, and that studies take outputs from.

    Parameters
    ----------
    body : HalfSpace or Elastic
        Body that is indented.
    tip : Tip
        Form of the tip.
    counterbody : HalfSpace or Elastic, optional
        Material of the tip; rigid by default.
    adhesion : Adhesion, optional
        Adhesion of the surfaces; none by default.
    load, approach, radius : float or array_like
        Loads [N], approaches [m] or contact radii [m] of any shape; exactly one of them.
    branch : {"stable", "unstable"}
        Branch of the curve where adhesion gives two contacts the same load or approach.
    control : {"load", "approach"}
        What is held while the tip is pulled off.
    tolerance : float, optional
        Largest error of the modulus of the film, as a part of it, by which its verdict judges.
    progress : callable, optional
        Function that is called with the number of finished contacts and of all contacts. Its result
        is ignored.

    Returns
    -------
    IndentSolution
        Contacts in the shape of what was given.

    Raises
    ------
    ValueError
        If `Indentation` or `Indentation.at` cannot take an argument.

    Warns
    -----
    NacreWarning
        If the slope of the tip within a contact is above 0.5, beyond the theory of small slopes.

    Examples
    --------
    >>> glass, film = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
    >>> body = nacre.HalfSpace(glass, [nacre.Layer(film, thickness=1e-6)])
    >>> found = nacre.indent.solve(body, nacre.indent.Tip.sphere(5e-6), load=1e-3)
    >>> found
    <IndentSolution: 1 contact, load 1 mN, approach 115.5 nm, radius 938.1 nm>
    """
    if not among(branch, get_args(Branch)):
        raise ValueError(f"branch must be 'stable' or 'unstable', got {branch!r}")
    if not among(control, get_args(Control)):
        raise ValueError(f"control must be 'load' or 'approach', got {control!r}")
    test = Indentation(body, tip, counterbody, adhesion=adhesion)
    return test._at(
        {"load": load, "approach": approach, "radius": radius},
        branch,
        control,
        progress,
        checked_tolerance(tolerance),
    )
