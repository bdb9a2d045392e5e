"""Solved bearings: loads, tilts and pressures of all elements, and how they came about."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.groups import keyword_units, with_units
from nacre._tools.notices import warn
from nacre._tools.typing import among
from nacre._tools.units import rounded, symbol
from nacre.bearing.arguments import Model, Operation
from nacre.bearing.contact_laws import LAMINAE
from nacre.bearing.geometry import RINGS, Bearing, Ring, above, bearing_from
from nacre.bearing.iso import Edge, pressure_factors
from nacre.bearing.kinds import RollerBearing
from nacre.bearing.modified import Lubrication
from nacre.bearing.rating_life import BearingLife, Duty, life_of, required
from nacre.bearing.static import StaticLoad, static_load_of
from nacre.bearing.verdict import bearing_verdict
from nacre.contact import Contact
from nacre.contact.solution import Solution
from nacre.contact.stresses import SIZE_ERRORS
from nacre.results import display, files
from nacre.results.base import Result
from nacre.results.charts import Axis, Bars, Chart, Curve, Look, Picture, contact_charts
from nacre.results.quantities import AXIS, Quantity, derived, frozen, quantity
from nacre.results.report import ANGLE, MINUTES, Rows, Table, input_rows, notebook_picture, table
from nacre.results.rows import Row, remark
from nacre.results.shown import Printed, Shown
from nacre.results.values import decode, encode, refusing
from nacre.results.verdict import Verdict, asked

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

    from nacre.bearing.film import Film

Array = npt.NDArray[np.float64]

SLIGHT = 1e-8
"""Share of loads and approaches below which a number is printed as 0."""
ROUNDING = 1e-9
"""Share of all loads together below which the load of a contact is rounding."""
EDGE = 0.1
"""Share of the length at either end of a roller in which the edge pressure is looked for."""
ARRAYS = (
    "angles",
    "approaches",
    "tilts",
    "loads",
    "moments",
    "peak_pressures",
    "edge_pressures",
    "contact_angles",
    "lamina_loads",
    "lamina_pressures",
    "grid_sizes",
    "tangent",
)
"""Arrays in the state of a solution."""
ANGLES = {"angles": ("°", math.degrees(1.0)), "tilt": ("mrad", 1e3), "tilts": ("mrad", 1e3)}
"""Units in which angles are printed, and how many there are in a radian."""
ASKED = {"life": "BearingLife", "film": "Film"}
"""What was asked for of a solution, which its verdict has, by names in its state, and classes."""
VECTORS = ("displacement", "tilt", "force", "moment")
"""Numbers of the ring in the state of a solution."""
PER_CONTACT, PER_LAMINA = ("element", "ring"), ("element", "ring", "lamina")
"""Dimensions of numbers of each contact of a bearing, and of its laminae."""
NOT_COUNTED = "lubrication, cage, friction, heat, and the bending of rings and housing"
"""What a report says of the model."""


def _angles(name: str, values: Iterable[float]) -> list[str]:
    """Return angles in the units in which they are printed."""
    return [rounded(ANGLES[name][1] * value, 4) for value in values]


def edge_pressure(pressures: Array) -> Array:
    """Return the largest pressures of laminae ``(…, laminae)`` in the outer tenths of a roller."""
    outer = round(EDGE * LAMINAE)
    ends: Array = np.concatenate([pressures[..., :outer], pressures[..., -outer:]], axis=-1)
    return ends.max(-1)  # type: ignore[no-any-return]


def carrying(loads: Array) -> npt.NDArray[np.bool_]:
    """Return which contacts carry more than rounding."""
    is_carrying: npt.NDArray[np.bool_] = loads > ROUNDING * loads.sum()
    return is_carrying


@dataclass(frozen=True, repr=False)
class BearingReport(Result):
    """Report of a solved bearing: how it came about.

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall
    >>> bearing = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    >>> report = bearing.solve(force=(1000.0, 0.0, None), model="iso16281").report
    >>> report.converged, report.balance < 1e-9
    (True, True)
    """

    termination: Literal["converged", "iteration limit", "no descent", "stopped"]
    """End of the iteration; "no descent" where no step lowers the energy by more than rounding."""
    iterations: int
    """Newton steps of the ring with solved contacts, or with those of the standard."""
    balance: float
    """Largest mismatch of forces and moments of ring and elements, relative."""
    warnings: tuple[str, ...]
    """Warnings; each was also issued as a `nacre.NacreWarning`."""
    discretisation: dict[str, float | None] | None = None
    """Errors due to the size of the cells, estimated; None of the standard's contacts.

    The keys are ``peak_pressure`` and, of rollers, ``edge_pressure`` [Pa]. The most loaded elements
    are solved again on half the cells, under the same loads and moments. A pressure without a
    limit, as at sharp ends, has none, `None`; a warning says so.
    """
    load_error: float | None = None
    """Error of loads due to the size of the cells, estimated, as a share that a life feels.

    None of the standard's contacts, which are formulas, and where it is not known.
    """
    contact_kinds: tuple[str, ...] | None = None
    """Kinds of warnings of contacts that carry 1 % of the largest load or more; None of old files.
    """

    _LATER = ("discretisation", "load_error", "contact_kinds")

    @property
    def converged(self) -> bool:
        """Whether the tolerance was met."""
        return self.termination == "converged"

    def __repr__(self) -> str:
        """Return how the iteration ended."""
        return (
            f"<BearingReport: {self.termination} after {self.iterations} steps, "
            f"balance {self.balance:.1e}; {len(self.warnings)} warnings>"
        )


def stiffness_table(tangent: Array) -> Table:
    """Return the table of a stiffness ``(5, 5)``, in the units that are shown."""
    units = display.shown_system()
    size, metre = units.unit("m")
    lengths, angles, moments = np.array([size] * 3 + [1e-3] * 2), "mrad", units.unit("N m")[1]
    tangent = tangent * lengths / np.array([1.0] * 3 + [size] * 2)[:, None] / units.unit("N")[0]
    force = units.unit("N")[1]
    title = (
        f"Stiffness: F over δ in {force}/{metre}, F over θ in {force}/{angles}, "
        f"M over δ in {force}, M over θ in {moments}/{angles}"
    )
    head = ["", *(f"{name}_{axis}" for name, axis in zip("δδδθθ", "xyzxy", strict=True))]
    names = [f"{name}_{axis}" for name, axis in zip("FFFMM", "xyzxy", strict=True)]
    rows = ([name, *row] for name, row in zip(names, tangent.tolist(), strict=True))
    return table(title, [head, *rows])


class Equilibrium(Shown, Result, is_base=True):
    """Base of equilibria: displacements, forces and stiffness of a ring or of a shaft."""

    _IN_SI = True

    displacement: tuple[float, float, float]
    tilt: tuple[float, float]
    force: tuple[float, float, float]
    moment: tuple[float, float]
    tangent: Array
    report: BearingReport

    @property
    def _warnings(self) -> Sequence[str]:
        return self.report.warnings

    def _ended(self) -> Row:
        """Return how the iteration ended."""
        report = self.report
        ended = f"{report.termination} after {report.iterations} steps"
        return remark("ended", f"{ended}, balance {report.balance:.0e}")

    def _vector_texts(self) -> dict[str, str]:
        """Return the displacements and forces to the bit, by name."""
        return {name: " ".join(f"{v:.17g}" for v in getattr(self, name)) for name in VECTORS}

    def _check_vectors(self) -> None:
        """Raise a `ValueError` unless displacements, forces and stiffness have their lengths."""
        lengths = zip(VECTORS, (3, 2, 3, 2), strict=True)
        if any(len(getattr(self, name)) != length for name, length in lengths):
            raise ValueError("displacement, tilt, force and moment must have 3, 2, 3 and 2 numbers")
        if self.tangent.shape != (5, 5):
            raise ValueError(f"tangent must have the shape (5, 5), got {self.tangent.shape}")

    def __eq__(self, other: object) -> bool:
        """Return whether all numbers are equal; NaN is equal to NaN."""
        if not isinstance(other, type(self)):
            return NotImplemented
        return repr(self._state()) == repr(other._state())

    __hash__ = None  # type: ignore[assignment]


@frozen(eq=False)
class BearingSolution(Equilibrium):
    """A solved bearing. Arrays have a row for each element, and columns for inner and outer ring.

    Elements of two rows are numbered row by row.

    Examples
    --------
    >>> from nacre.bearing import CylindricalRoller
    >>> bearing = CylindricalRoller(
    ...     count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3, clearance=41e-6
    ... )
    >>> solution = bearing.solve(force=(4450.0, 0.0, None), tilt=(None, 6e-4))
    >>> solution.loads.shape, solution.report.converged
    ((14, 2), True)
    """

    _TITLE = "bearing"
    _LATER = ("rotating", "loaded_directions", "required_life", "static_safety", "life", "film")

    bearing: Bearing
    """Bearing that was solved."""
    model: Model
    """Contacts: "solved" by nacre, or "iso16281"."""
    rotation: float
    """Angle of element 0 from the x axis [rad]."""
    speed: float
    """Angular velocity of the ring that rotates [rad/s]."""
    rotating: Ring
    """Ring that rotates."""
    loaded_directions: tuple[bool, bool, bool, bool, bool] | None
    """Whether forces along x, y and z and moments about x and y were given; None of old files."""
    displacement: tuple[float, float, float] = quantity(
        "m", dims=("direction",), label="displacement"
    )
    """Displacement of the ring [m]: of the inner ring against the outer one along x, y and z."""
    tilt: tuple[float, float] = quantity(dims=AXIS, label="tilt")
    """Slopes of the inner ring: about x and y."""
    force: tuple[float, float, float] = quantity("N", dims=("direction",), label="force")
    """Force on the inner ring [N], which the elements balance, along x, y and z."""
    moment: tuple[float, float] = quantity("N m", dims=AXIS, label="moment")
    """Moment on the inner ring [N m], about x and y."""
    angles: Array = quantity("rad", dims=("element",))
    """Angles of the elements ``(Z,)`` [rad], from x."""
    approaches: Array = quantity("m", dims=PER_CONTACT)
    """Approaches of the contacts ``(Z, 2)`` [m], below 0 where nothing touches."""
    tilts: Array = quantity(dims=PER_CONTACT, label="tilt")
    """Slopes of the elements to the rings, ``(Z, 2)``: to the raceways; 0 of balls."""
    loads: Array = quantity("N", dims=PER_CONTACT, label="load", after="approaches")
    """Forces of the contacts ``(Z, 2)`` [N]."""
    moments: Array = quantity("N m", dims=PER_CONTACT, after="tilts")
    """First moments of the pressure ``(Z, 2)`` [N m], about the middles of the elements."""
    peak_pressures: Array = quantity("Pa", dims=PER_CONTACT, label="peak pressure")
    """Largest pressures ``(Z, 2)`` [Pa]."""
    edge_pressures: Array = quantity("Pa", dims=PER_CONTACT, label="edge pressure")
    """Pressures at the edges ``(Z, 2)`` [Pa], NaN of balls.

    They are the largest ones in the outer tenths of the length of a roller.
    """
    contact_angles: Array = quantity("rad", dims=PER_CONTACT)
    """Contact angles ``(Z, 2)`` [rad], below 0 in a second row; 0 of cylindrical rollers."""
    lamina_loads: Array | None = quantity("N", dims=PER_LAMINA)
    """Loads of laminae ``(Z, 2, 40)`` [N], 40 along each contact; None of balls."""
    lamina_pressures: Array | None = quantity("Pa", dims=PER_LAMINA)
    """Largest pressures of laminae ``(Z, 2, 40)`` [Pa]; None of balls."""
    tangent: Array
    """Stiffness of the bearing ``(5, 5)``, which `stiffness` returns."""
    grid_sizes: Array | None
    """Sides of the grids of the contacts ``(Z, 2, 2)`` [m]; None for the standard's contacts."""
    cells: tuple[int, int] | None
    """Cells of each grid; None for the standard's contacts."""
    report: BearingReport
    """Report: how the solution came about."""
    required_life: float | None = None
    """Life that is required [h], which the verdict judges; None without."""
    static_safety: float | None = None
    """Static safety that is required; None where it is the usual one."""
    _contacts: dict[tuple[int, int], Solution] = field(default_factory=dict, repr=False)
    """Contacts that are known, by element and ring."""
    _life: BearingLife | None = field(default=None, repr=False)
    _film: Film | None = field(default=None, repr=False)
    """Life and film that were asked for, which the verdict has."""

    @property
    @derived("N", label="largest load", after="moment")
    def largest_load(self) -> float:
        """Largest force of a contact [N]."""
        return float(self.loads.max())

    @property
    @derived("Pa", label="peak pressure")
    def peak_pressure(self) -> float:
        """Largest pressure [Pa], of all contacts."""
        return float(self.peak_pressures.max())

    @property
    @derived("Pa", label="edge pressure")
    def edge_pressure(self) -> float:
        """Largest pressure in outer tenths [Pa], of a roller; NaN of balls."""
        return float(self.edge_pressures.max())

    @property
    @derived("million revolutions")
    def reference_life(self) -> float:
        """Life of ISO/TS 16281 [million revolutions], with the standard's edge factors."""
        return self._reference().l10r

    def _reference(self) -> BearingLife:
        """Return the life without lubrication and without warnings, for its verdict."""
        oil = Lubrication(None, None, None, None, additives=False)
        life = life_of(self, "standard", None, None, 0.9, oil, None, None)
        return required(life, self.required_life)

    @property
    @derived()
    def loaded(self) -> int:
        """Number of loaded elements: those that both rings load."""
        return int(carrying(self.loads).all(axis=1).sum())

    @property
    @derived("rad/s", label="cage speed")
    def cage_speed(self) -> float:
        """Speed of the elements about the axis [rad/s], that of the bearing."""
        return self.bearing.cage_speed(self.speed, self.rotating)

    @asked
    def verdict(
        self, required_life: float | None = None, static_safety: float | None = None
    ) -> Verdict:
        """Verdict: life, static safety, and peak pressure against that of the static rating.

        It is bad where the life is shorter than the required one, the static safety less, or the
        pressure above 4000 MPa of rollers and 4200 MPa of balls: ISO 76. From 1.5 of each, less its
        error, it is good; fair with edge stress, and with tilts, loads and films beyond the usual.

        Parameters
        ----------
        required_life : float, optional
            Life that is required [h], by default that of `solve`, or of the life of a case.
        static_safety : float, optional
            Static safety that is required, by default that of `solve`, else 1.5 of rollers and 1 of
            balls.

        Returns
        -------
        Verdict
            Verdict; unknown where no life and no static safety is required.

        Raises
        ------
        ValueError
            If a limit is not above 0, or a life is required of a bearing at rest.

        Examples
        --------
        >>> from nacre.bearing import DeepGrooveBall
        >>> bearing = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
        >>> solution = bearing.solve(
        ...     force=(1000.0, 0.0, None), speed=100.0, model="iso16281", required_life=20e3
        ... )
        >>> solution.verdict().level, solution.verdict(required_life=250e3).level
        ('good', 'bad')
        """
        life = required(self._life or self._reference(), required_life)
        return bearing_verdict({"": self}, life, self._safety(static_safety))

    def _safety(self, static_safety: float | None) -> float | None:
        """Return the static safety that is required, if any, checked."""
        if static_safety is None:
            return self.static_safety
        return above("static_safety", static_safety)

    def stiffness(self) -> Array:
        """Exact tangent stiffness ``(5, 5)`` of forces and moments over displacements and tilts.

        The elements are in equilibrium with it. It is 0 along directions in which nothing is
        elastic.

        Returns
        -------
        numpy.ndarray
            Derivatives of ``(F_x, F_y, F_z, M_x, M_y)`` on the inner ring with respect to
            ``(δ_x, δ_y, δ_z, θ_x, θ_y)``, in N/m, N and N m.

        Examples
        --------
        >>> import numpy as np
        >>> from nacre.bearing import DeepGrooveBall
        >>> bearing = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
        >>> axial = bearing.solve(force=(0.0, 0.0, 1000.0), model="iso16281").stiffness()
        >>> bool(np.allclose(axial, axial.T)), bool(axial[2, 2] > 0)
        (True, True)
        """
        return self.tangent.copy()

    def contact(self, element: int, ring: Ring) -> Solution | None:
        """Contact of an element and a ring, with its pressure, stresses and gradients.

        Parameters
        ----------
        element : int
            Number of the element.
        ring : {"inner", "outer"}
            Ring. Its body is the `body` of the contact, and the element the `counterbody`.

        Returns
        -------
        Solution or None
            Contact; None where nothing touches. That of a loaded file is solved again.

        Raises
        ------
        ValueError
            If there is no such element or ring, or the contacts are those of the standard.

        Examples
        --------
        >>> from nacre.bearing import DeepGrooveBall
        >>> bearing = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
        >>> solution = bearing.solve(force=(20.0, 0.0, None))
        >>> contact = solution.contact(0, "inner")
        >>> bool(abs(contact.load / solution.loads[0, 0] - 1) < 1e-8)
        True
        """
        if self.model != "solved" or self.grid_sizes is None or self.cells is None:
            raise ValueError('model must be "solved" for a contact, got "iso16281"')
        if not among(ring, RINGS):
            raise ValueError(f'ring must be "inner" or "outer", got {ring!r}')
        element = core.integer("element", element)
        last = self.bearing.elements - 1
        if not 0 <= element <= last:
            raise ValueError(f"element must be from 0 to {last}, got {element!r}")
        number = RINGS.index(ring)
        if not self.loads[element, number] > 0:
            return None
        key = element, number
        if key not in self._contacts:
            body, counterbody = self.bearing.bodies(ring)
            size = tuple(self.grid_sizes[key].tolist())
            plan = Contact(body, core.Grid(self.cells, size), counterbody)
            self._contacts[key] = plan.solve(
                self.bearing.shape(ring),
                approach=float(self.approaches[key]),
                tilt=(float(self.tilts[key]), None),
                tolerance=1e-10,
            )
        return self._contacts[key]

    def edge_factors(self) -> Array:
        """Solved pressures of laminae over those of Hertz under their loads.

        They are the factors of ISO/TS 16281, equations 58 and 59, with the moduli of the substrates
        in place of the standard's steel.

        Returns
        -------
        numpy.ndarray
            Factors ``(Z, 2, 40)``; 1 where a lamina has no load.

        Raises
        ------
        ValueError
            If the elements are balls, or the contacts those of the standard.

        Examples
        --------
        >>> from nacre.bearing import CylindricalRoller
        >>> bearing = CylindricalRoller(
        ...     count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3, clearance=41e-6
        ... )
        >>> factors = bearing.solve(force=(4450.0, 0.0, None)).edge_factors()
        >>> bool(0.95 < factors[0, 0, 20] < 1.05)
        True
        """
        if self.lamina_loads is None or self.lamina_pressures is None:
            raise ValueError("the elements must be rollers for edge factors, got balls")
        if self.model != "solved":
            raise ValueError(
                'edge must be "standard" or None for contacts of the standard, whose '
                'pressure is not known, got "pressure"'
            )
        assert isinstance(self.bearing, RollerBearing)
        return pressure_factors(self.bearing, self.lamina_loads, self.lamina_pressures)

    @with_units(speed="rad/s", kinematic_viscosity="m²/s", fatigue_load_limit="N")
    def life(
        self,
        edge: Edge = "standard",
        *,
        rotating: Ring | None = None,
        speed: float | None = None,
        reliability: float = 0.9,
        viscosity_ratio: float | None = None,
        kinematic_viscosity: float | None = None,
        film_ratio: float | None = None,
        contamination: str | float | None = None,
        additives: bool = False,
        fatigue_load_limit: float | None = None,
        spectrum: Iterable[Duty] | None = None,
        required_life: float | None = None,
    ) -> BearingLife:
        """Rate the bearing by ISO/TS 16281 and, with a lubrication, by a_ISO of ISO 281.

        Parameters
        ----------
        edge : {"standard", "pressure"} or None, optional
            Factors by which the loads of the laminae are multiplied: those of the standard, which
            hold for its profile, medium loads and tilts below 4', and which barrels have not; the
            solved pressure over that of Hertz; or none. Balls have none.
        rotating : {"inner", "outer"}, optional
            Ring that rotates against the load; by default the one that rotates in `solve`.
        speed : float, optional
            Angular velocity of the ring that rotates [rad/s], for hours; by default that of
            `solve`.
        reliability : float, optional
            Share of bearings that reach the life, from 0.9 to 0.9995: `reliability_factor`.
        viscosity_ratio : float, optional
            Viscosity ratio κ, at least 0.1. It, or one of the two arguments below, makes the life
            the modified one, ``a_1 a_ISO L_10r``; `contamination` must be given, too.
        kinematic_viscosity : float, optional
            Kinematic viscosity ν of the oil at the temperature of operation [m²/s]; κ = ν/ν_1, with
            ν_1 of `reference_viscosity`.
        film_ratio : float, optional
            Ratio λ of film and roughness, as that of `film_thickness`; κ = λ^1.3.
        contamination : str or float, optional
            Degree of cleanliness, as in `contamination_range`, whose middle is taken; or the factor
            e_C, from 0 to 1.
        additives : bool, optional
            Whether extreme-pressure additives are proven to work: κ then counts as 1 where it is
            below and e_C at least 0.2, and a_ISO is at most 3.
        fatigue_load_limit : float, optional
            Limit C_u [N]; by default that of `nacre.bearing.fatigue_load_limit`, which solves the
            contacts of profiled rollers.
        spectrum : list of tuple, optional
            Load spectrum in place of the solved load: tuples of the share of the time, the forces
            along x, y and z [N] and the speed [rad/s]. Shares sum to 1. Each load is solved with
            moments, tilts and displacements of this solution, and lives add up by Miner's rule.
        required_life : float, optional
            Life that is required [h], which decides the verdict; it needs a speed. By default that
            of `solve`.

        Returns
        -------
        BearingLife
            Life in revolutions and hours, L_10r in millions of revolutions, equivalent load, and
            what they are made of.

        Raises
        ------
        ValueError
            If an argument is out of range, factors from the pressure are asked of contacts that
            are those of the standard, κ follows from none or several of its arguments, or a
            spectrum lacks a load.

        Notes
        -----
        ISO 281:2007, formula (23), with P that of the reference life (ISO/TS 16281). The latter's
        a_ISO of each lamina of a roller, and the annex of ISO 281 on filters, are left out.

        Examples
        --------
        >>> from nacre.bearing import CylindricalRoller
        >>> bearing = CylindricalRoller(
        ...     count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3, clearance=41e-6
        ... )
        >>> solution = bearing.solve(force=(4450.0, 0.0, None), speed=100.0, model="iso16281")
        >>> round(solution.life().l10r), round(solution.life(edge=None).l10r)
        (4997, 5184)
        >>> oil = {"kinematic_viscosity": 20e-6, "contamination": "normal cleanliness"}
        >>> life = solution.life(**oil)
        >>> round(life.viscosity_ratio, 1), life.modification_factor > 1
        (1.1, True)
        """
        lubrication = Lubrication(
            viscosity_ratio, kinematic_viscosity, film_ratio, contamination, additives
        )
        life = life_of(
            self, edge, rotating, speed, reliability, lubrication, fatigue_load_limit, spectrum
        )
        for text in life.notes:
            warn(text)
        return required(life, self.required_life if required_life is None else required_life)

    def static_load(self) -> StaticLoad:
        """Rate the bearing at rest by ISO 76: rating, equivalent static load and safety factor.

        The equivalent load P_0 is by the standard's definition that which gives the heaviest
        element the same load, ``P_0 = Q_max i Z cos α/5``, so that clearance, tilt and moments
        count; `equivalent_static_load` has the standard's factors for usual bearings.

        Returns
        -------
        StaticLoad
            Rating C_0, load P_0 and ``s_0 = C_0/P_0``.

        Examples
        --------
        >>> from nacre.bearing import DeepGrooveBall
        >>> bearing = DeepGrooveBall(count=9, diameter=9.525e-3, pitch_diameter=46e-3)
        >>> solution = bearing.solve(force=(2000.0, 0.0, None), model="iso16281")
        >>> solution.static_load().safety > 5
        True
        """
        return static_load_of(self)

    def plot(self, axes: Axes | Mapping[str, Axes] | None = None) -> dict[str, Axes]:
        """Draw loads over the angle, and the pressure along the heaviest element.

        Needs ``nacre-contact[plot]``.

        Parameters
        ----------
        axes : dict of matplotlib.axes.Axes, optional
            Axes "loads", which must be polar, and "pressure"; a new figure by default.

        Returns
        -------
        dict of matplotlib.axes.Axes
            The axes, by name.

        Examples
        --------
        >>> from nacre.bearing import DeepGrooveBall
        >>> bearing = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
        >>> sorted(bearing.solve(force=(20.0, 0.0, None)).plot())
        ['loads', 'pressure']
        """
        from nacre import plot

        return plot.bearing(self, axes)

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of all numbers over elements, rings and laminae; needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Numbers by name, with units.
        """
        variables = {}
        for row in self._QUANTITIES:
            if (value := row.of(self)) is not None:
                variables[row.name] = (row.dims, np.asarray(value))
        coordinates = {"ring": list(RINGS)}
        table = [(row, row.si()) for row in self._QUANTITIES]
        with self._units():
            return files.dataset(self._TITLE, table, variables, coordinates, self.to_dict())

    def _comments(self) -> dict[str, object]:
        errors = self.report.discretisation or {}
        error_columns = {f"{name}_discretisation": error for name, error in errors.items() if error}
        return super()._comments() | {
            "model": self.model,
            **self._vector_texts(),
            **error_columns,
            **self._numbered_warnings(),
        }

    def _columns(self) -> list[tuple[Quantity, str, Array]]:
        """Return quantity, heading and values of the columns of the table of elements."""
        columns: list[tuple[Quantity, str, Array]] = []
        for row in self._QUANTITIES:
            if row.name == "angles":
                columns.append((row, "angle", self.angles))
            elif row.dims == PER_CONTACT and row.label:
                for k, ring in enumerate(RINGS):
                    columns.append((row, f"{row.label} {ring}", row.of(self)[:, k]))
        return columns

    def _file_rows(self) -> list[list[object]]:
        return self._elements(lambda _, value: value)

    def _elements(self, shown: Callable[[str, float], float]) -> list[list[object]]:
        """Return the table of the elements, with numbers as they are shown."""
        columns = self._columns()
        units = [(name, symbol(row.si())) for row, name, _ in columns]
        heads = [f"{name} [{unit}]" if unit else name for name, unit in units]
        rows: list[list[object]] = [
            [j, *(shown(row.name, float(values[j])) for row, _, values in columns)]
            for j in range(self.bearing.elements)
        ]
        return [["element", *heads], *rows]

    def _inputs(self) -> Rows:
        names = ("bearing", "model", "rotation", "speed", "rotating", "cells")
        units = keyword_units(type(self.bearing), Operation)
        inputs = input_rows({name: getattr(self, name) for name in names}, units)
        return [*inputs, *self._given()]

    def _given(self) -> Iterator[Row]:
        """Yield the loads and motions that were given along each direction."""
        names = (("displacement", "force"),) * 3 + (("tilt", "moment"),) * 2
        for k, is_loaded in enumerate(self.loaded_directions or ()):
            name, axis = names[k][is_loaded], "xyzxy"[k]
            value, unit = self._rounded(name, float(getattr(self, name)[k % 3])), ""
            if name == "tilt":
                text = f"{rounded(MINUTES * value, ANGLE)} minutes of arc"
            else:
                unit = next(row.si() for row in self._QUANTITIES if row.name == name)
                text = display.number(value, unit, ANGLE)
            yield Row(f"{name}_{axis}", f"{name} along {axis}", text, value, unit)

    def _report_rows(self) -> Rows:
        """Return the numbers, the dimensions that follow from others, and the rating."""
        bearing, unit = self.bearing, "m"
        dimensions = {
            "pitch_diameter": (bearing.pitch, unit),
            "clearance": (bearing.play, unit),
            "rating": (float(bearing.capacity or 0.0), "N"),
        }
        rows = [
            display.numbered(name, name.replace("_", " "), *number)
            for name, number in dimensions.items()
        ]
        return [*self._rows(), *rows]

    def _tables(self) -> Sequence[Table]:
        def shown(name: str, value: float) -> float:
            rounded = self._rounded(name, value)  # rounding is 0
            return MINUTES * rounded if name == "tilts" else rounded

        head, *rows = self._elements(shown)
        words = [f"{name} [minutes]" if str(name).startswith("tilt ") else name for name in head]
        elements = [words, *rows]
        return [
            table("Elements and rings", elements),
            stiffness_table(self.tangent),
        ]

    def _model(self) -> Rows:
        errors = [remark("±", SIZE_ERRORS)] if self.report.discretisation else []
        return [*self._remarks(), *errors, remark("not counted", NOT_COUNTED)]

    def _notebook_picture(self) -> bytes | None:
        return notebook_picture([self._ring_chart()])

    def _charts(self) -> list[Picture]:
        """Return the charts of loads around the ring, and of the pressure of the heaviest."""
        heaviest = int(self.loads[:, 0].argmax())
        if self.lamina_pressures is None:
            contact = self.contact(heaviest, "inner") if self.model == "solved" else None
            return [self._ring_chart(), *([] if contact is None else contact_charts(contact))]
        looks: tuple[Look, Look] = "line", "dashed"
        curves = [
            Curve(*self._profile(heaviest, k), f"{RINGS[k]} ring", looks[k])
            for k in range(len(RINGS))
        ]
        axes = Axis("x along the element", "m"), Axis("pressure", "Pa")
        caption = f"Largest pressure along element {heaviest}."
        return [self._ring_chart(), Chart(caption, curves, axes)]

    def _ring_chart(self, rings: int = len(RINGS)) -> Bars:
        """Return the loads around the ring, by row and ring; of the inner ring alone if 1."""
        count, rows = self.bearing.count, self.bearing.rows
        loads = self.loads.reshape(rows, count, 2)[..., :rings].transpose(1, 0, 2)
        angles = np.repeat(self.angles.reshape(rows, count).T, rings, axis=1)
        words = [f"row {k + 1}" * (rows > 1) for k in range(rows)]
        names = [f"{name} ring" for name in RINGS] if rings > 1 else [""]
        labels = [", ".join(filter(None, (row, name))) for row in words for name in names]
        caption = "Loads of the elements, x to the right."
        loads, axis = loads.reshape(count, -1), Axis("load of each element", "N")
        return Bars(caption, angles, loads, axis, labels)

    def _profile(self, element: int, ring: int) -> tuple[Array, Array]:
        """Return places along an element, and the largest pressures there; none of balls' peaks."""
        if self.lamina_pressures is not None:
            pressures = self.lamina_pressures[element, ring]
            length = getattr(self.bearing, "length", 1.0)
            return ((np.arange(pressures.size) + 0.5) / pressures.size - 0.5) * length, pressures
        contact = self.contact(element, RINGS[ring]) if self.model == "solved" else None
        if contact is None:
            return np.zeros(0), np.zeros(0)
        return contact.x, contact.pressure.max(axis=1)

    def _rows(self) -> list[Row]:
        kinds, rows = {row.name: row for row in self._QUANTITIES}, []
        for row in (kinds[name] for name in VECTORS):
            values = [self._rounded(row.name, value) for value in row.of(self)]
            angles = f"({', '.join(_angles(row.name, values))}) mrad" if row.name == "tilt" else ""
            text = angles or display.pair(values, row.si())
            rows.append(Row(row.name, row.label, text, values, row.si()))
        for name in ("largest_load", "peak_pressure", "edge_pressure"):
            if not math.isnan(getattr(self, name)):
                rows.append(display.estimated_row(self, kinds[name], self._digits(name)))
        if self.speed:
            row = kinds["cage_speed"]
            rows.append(display.numbered(row.name, row.label, self.cage_speed, row.si()))
        loaded = f"{self.loaded} of {self.bearing.elements} elements"
        return [*rows, Row("loaded", "loaded", loaded, self.loaded)]

    def _remarks(self) -> list[Row]:
        contacts = "solved contacts" if self.model == "solved" else "ISO/TS 16281, a model"
        if self._sharp:
            contacts += "; ends are sharp: their pressure has no limit, and grows with the cells"
        return [remark("contacts", contacts), self._ended()]

    def _printed(self, row: Quantity, name: str, values: Array) -> list[str]:
        """Return heading and cells of a column of the table of elements, in one unit."""
        numbers = [self._rounded(row.name, float(value)) for value in values]
        if row.name in ANGLES:
            return [f"{name} [{ANGLES[row.name][0]}]", *_angles(row.name, numbers)]
        heading, texts = display.column(name, numbers, row.si(), self._digits(row.name))
        return [heading, *texts]

    def _rounded(self, name: str, value: float) -> float:
        """Return a number as it is printed: 0 where it is rounding beside loads and approaches."""
        deepest, arm = float(self.approaches.max(initial=0.0)), self.bearing.pitch / 2
        scale = {"displacement": deepest, "force": self.largest_load, "tilt": deepest / arm}
        scale |= {"tilts": deepest / arm, "moment": self.largest_load * arm}
        return 0.0 if abs(value) < SLIGHT * scale.get(name, 0.0) else value

    def _digits(self, name: str) -> int:
        """Return how many digits are printed; pressures at sharp ends grow with the cells."""
        return 2 if name.startswith(("peak_pressure", "edge_pressure")) and self._sharp else 4

    @property
    def _sharp(self) -> bool:
        """Whether solved contacts of straight rollers reach their ends, where they are singular."""
        straight = getattr(self.bearing, "profile", "") is None
        return straight and self.model == "solved" and bool(np.nanmax(self.edge_pressures) > 0)

    def _table(self) -> Printed | None:
        """Return the table of the loaded elements."""
        columns = [(r, n, v) for r, n, v in self._columns() if not np.isnan(v).all()]
        loaded = np.flatnonzero(carrying(self.loads).any(axis=1))
        if not loaded.size:
            return None
        cells = [["element", *map(str, loaded)]]
        cells += [self._printed(row, name, values[loaded]) for row, name, values in columns]
        head, *rows = zip(*cells, strict=True)
        return Printed(head, rows, side=">")

    @classmethod
    def _names(cls) -> list[str]:
        words = ["bearing", "model", "rotation", "speed", "rotating", "loaded_directions", *VECTORS]
        return [*words, *ARRAYS, "cells", "report", "required_life", "static_safety", *ASKED]

    def _state(self) -> dict[str, object]:
        state = {name: getattr(self, name) for name in ("model", "rotation", "speed", "rotating")}
        state |= {name: list(getattr(self, name)) for name in (*VECTORS,)}
        arrays = {name: getattr(self, name) for name in ARRAYS}
        state |= {name: None if a is None else a.tolist() for name, a in arrays.items()}
        state["loaded_directions"] = self.loaded_directions and list(self.loaded_directions)
        cells = None if self.cells is None else list(self.cells)
        state |= {"required_life": self.required_life, "static_safety": self.static_safety}
        state |= {"bearing": encode(self.bearing), "cells": cells, "report": self.report._state()}
        return state | {name: encode(getattr(self, f"_{name}")) for name in ASKED}

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        with refusing(cls.__name__):
            fields = dict(state)
            fields["bearing"] = bearing_from(state["bearing"])
            if state.get("rotating") is None:  # states of 0.1.0, whose speed is that of the cage
                fields["rotating"] = "inner"
                fields["speed"] = state["speed"] / fields["bearing"].cage_speed(1.0)
            if (loaded := state.get("loaded_directions")) is not None:
                fields["loaded_directions"] = tuple(map(bool, loaded))
            else:
                fields["loaded_directions"] = None
            for name in VECTORS:
                fields[name] = tuple(map(float, state[name]))
            for name in ARRAYS:
                if state[name] is not None:
                    fields[name] = np.array(state[name], dtype=np.float64)
            fields["cells"] = None if state["cells"] is None else tuple(state["cells"])
            fields["report"] = BearingReport._restored(dict(state["report"]))
            fields |= {f"_{name}": decode(fields.pop(name, None)) for name in ASKED}
            solution = cls(**fields)
            solution._check()
            return solution

    def _check(self) -> None:
        """Raise a `ValueError` unless all fields fit each other."""
        if not isinstance(self.bearing, Bearing):
            raise ValueError(f"bearing must be a bearing, got {self.bearing!r}")
        for name, kind in ASKED.items():
            if type(asked := getattr(self, f"_{name}")).__name__ not in (kind, "NoneType"):
                raise ValueError(f"{name} must be a {kind} or None, got {asked!r}")
        if self.rotating not in RINGS:
            raise ValueError(f'rotating must be "inner" or "outer", got {self.rotating!r}')
        if self.model not in ("solved", "iso16281"):
            raise ValueError(f"model must be one of nacre's, got {self.model!r}")
        count = self.bearing.elements
        arrays = [name for name in ARRAYS if name != "tangent"]
        shapes: dict[str, tuple[int, ...]] = dict.fromkeys(arrays, (count, 2))
        shapes |= {"angles": (count,), "grid_sizes": (count, 2, 2)}
        shapes |= dict.fromkeys(("lamina_loads", "lamina_pressures"), (count, 2, LAMINAE))
        for name, shape in shapes.items():
            value = getattr(self, name)
            may_lack = name == "grid_sizes" or name.startswith("lamina")
            if value is None and may_lack:
                continue
            if np.shape(value) != shape:
                raise ValueError(f"{name} must have the shape {shape}, got {np.shape(value)}")
        self._check_vectors()
