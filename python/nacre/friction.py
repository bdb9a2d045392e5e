"""Contacts with friction: sliding, rolling, creep; histories and creep curves, to one Dataset."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._extras import extra
from nacre._friction_display import checked
from nacre._friction_result import FrictionReport, FrictionSolution
from nacre._keywords import Along
from nacre._result import Result
from nacre.units import symbol

if TYPE_CHECKING:
    import xarray

MOTION = ("load", "approach", "eccentricity", "moment", "tilt")
"""Keywords of the motion along z."""
Body = core.HalfSpace | core.Elastic
Told = Callable[[int, FrictionReport], object]
"""Function that is told the number of a step and its report."""


def slide(
    shape: core.Shape,
    body: Body,
    counterbody: Body | None = None,
    *,
    grid: core.Grid | None = None,
    threads: int | None = None,
    steps: Iterable[Mapping[str, Any]] | None = None,
    load: float | None = None,
    approach: float | None = None,
    eccentricity: Along | None = None,
    moment: Along | None = None,
    tilt: Along | None = None,
    friction: npt.ArrayLike | None = None,
    shift: Along | None = None,
    force: Along | None = None,
    twist: float | None = None,
    torque: float | None = None,
    tolerance: float = 1e-8,
    max_convolutions: int = 4000,
    coupling: bool = True,
    initial: FrictionSolution | None = None,
    progress: Told | None = None,
    check: bool = True,
) -> Any:
    """Press a shape into a body and move it tangentially, with friction, in one call.

    It chooses a grid where none is given, plans, and solves.

    Parameters
    ----------
    shape : Shape
        Shape that is pressed in.
    body : HalfSpace or Elastic
        Body that it is pressed into.
    counterbody : HalfSpace or Elastic, optional
        Body that carries the shape and moves over the body; rigid where there is none.
    grid : Grid, optional
        Cells of pressure and traction; by default that of `solve` for the largest load.
    threads : int, optional
        Number of threads; all of the machine's by default.
    steps : iterable of mapping, optional
        Steps of a history, each a mapping of the keywords from `load` to `torque`. Motion along z
        and friction that a step does not give stay as in the step before; at first, they are
        those of the call.
    load, approach, eccentricity, moment, tilt : optional
        Motion along z, as `Contact.solve` explains.
    friction : float or array_like
        Coefficient of friction, at least 0: one number, or one for each cell ``(nx, ny)``.
    shift : tuple of float or None, optional
        Shift ``(d_x, d_y)`` of the counterbody over the body at the end of the step [m], since
        the first touch. None: it stays where it is, unless there is a force.
    force : tuple of float or None, optional
        Forces ``(∬ q_x dA, ∬ q_y dA)`` of the tractions on the body [N]; the shift along an axis
        with a number is found.
    twist : float, optional
        Rotation of the counterbody over the body about the z axis [rad], since the first touch.
    torque : float, optional
        Torque ``∬ (x q_y - y q_x) dA`` of the tractions on the body [N m]; the twist is found.
    tolerance : float, optional
        Largest slip of a sticking cell, or slip across the traction, over the largest
        displacement; also the tolerance of the pressure. Above 0 and below 1.
    max_convolutions : int, optional
        Tangential convolutions of a step before it gives up.
    coupling : bool, optional
        Whether tractions act on the pressure and pressure on the slip. Between equal bodies
        neither is so.
    initial : FrictionSolution, optional
        State to go on from: the last step of an earlier history, on the same grid. It carries
        tractions and shift, and no pressure, which is solved afresh. By default the surfaces have
        not touched.
    progress : callable, optional
        Function that is called with the number of the step and a `FrictionReport` at each
        convolution; returning False stops, and gives the unfinished solution, with tractions and
        shift as before the step: with it as `initial`, the same step goes on.
    check : bool, optional
        Whether to raise an error if the tolerance was not met.

    Returns
    -------
    FrictionSolution or list of FrictionSolution
        Tractions, slip, and all of the normal contact; a list where there are `steps`.

    Raises
    ------
    ValueError
        If an argument is out of range, friction cannot bear the force, a body has free ends or a
        frictionless interface, or is known by its normal response alone.
    ConvergenceError
        If the tolerance was not met; the unfinished solution is its `solution`.

    Notes
    -----
    Coulomb's law holds in each cell. The bodies are half-spaces, and all is quasi-static. Once a
    history has begun, every exception that ends it, `KeyboardInterrupt` included, carries the
    finished steps as `solutions`. With the last of them as `initial`, the history goes on to the
    bit.

    Examples
    --------
    A fretting loop of a ball:

    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> steps = [{"force": (force, None)} for force in (2.0, -2.0, 2.0)]
    >>> loop = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, steps=steps)
    >>> [round(solution.force[0], 6) for solution in loop], loop[2].dissipated > 0
    ([2.0, -2.0, 2.0], True)
    """
    return _solutions(core.slide, locals())


def roll(
    shape: core.Shape,
    body: Body,
    counterbody: Body | None = None,
    *,
    grid: core.Grid | None = None,
    threads: int | None = None,
    load: float | None = None,
    approach: float | None = None,
    eccentricity: Along | None = None,
    moment: Along | None = None,
    tilt: Along | None = None,
    friction: npt.ArrayLike | None = None,
    creepage: Along | None = None,
    force: Along | None = None,
    spin: float = 0.0,
    direction: Literal["+x", "-x", "+y", "-y"] | None = None,
    cells: int | None = None,
    tolerance: float = 1e-8,
    max_convolutions: int = 4000,
    coupling: bool = True,
    initial: FrictionSolution | None = None,
    progress: Told | None = None,
    check: bool = True,
) -> Any:
    """Press a shape into a body, which rolls, in one call.

    It chooses a grid where none is given, plans, and solves.

    Parameters
    ----------
    shape : Shape
        Shape that is pressed in.
    body : HalfSpace or Elastic
        Body that it is pressed into.
    counterbody : HalfSpace or Elastic, optional
        Body that carries the shape; rigid where there is none.
    grid : Grid, optional
        Cells of pressure and traction; by default that of `solve`.
    threads : int, optional
        Number of threads; all of the machine's by default.
    load, approach, eccentricity, moment, tilt : optional
        Motion along z, as `Contact.solve` explains.
    friction : float or array_like
        Coefficient of friction, at least 0: one number, or one for each cell ``(nx, ny)``.
    creepage : tuple of float or None, optional
        Creepages ``(xi, eta)`` of the counterbody over the body, along the direction of rolling e
        and along z × e: relative velocities over the speed of rolling, which are small in the
        linear theory: above 0.1 a warning says so. None: 0, unless there is a force.
    force : tuple of float or None, optional
        Forces of the tractions on the body along e and along z × e [N]; the creepage along an
        axis with a number is found.
    spin : float, optional
        Relative angular velocity about the z axis over the speed of rolling [1/m].
    direction : {"+x", "-x", "+y", "-y"}, optional
        Direction of rolling, in which the leading edge lies; "+y" for shapes that roll across the
        x axis, as rollers do. Other shapes need it.
    cells : int, optional
        Number of cells to roll from `initial` on, or from the first touch. By default the steady
        state is found.
    tolerance, max_convolutions, coupling, initial, progress, check : optional
        How tractions are found, as `slide` explains.

    Returns
    -------
    FrictionSolution or list of FrictionSolution
        Steady state; a list with one solution for each cell rolled where `cells` is given.

    Raises
    ------
    ValueError
        As `slide`; and if the contact touches the edge of the grid in the direction of rolling.
    ConvergenceError
        If the tolerance was not met; the unfinished solution is its `solution`.

    Notes
    -----
    Material flows against the direction of rolling. The change of displacement over a cell stands
    for its derivative (Kalker 1990), so that forces are right to the first order of the cells.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> ball = nacre.Sphere(5e-3)
    >>> pull = {"load": 10.0, "friction": 0.3, "force": (1.5, None)}
    >>> wheel = nacre.roll(ball, steel, steel, **pull, direction="+x")
    >>> round(wheel.force[0], 6), wheel.creepage[0] > 0
    (1.5, True)
    """
    return _solutions(core.roll, locals())


class FrictionMethods:
    """Methods of `Contact` for contacts with friction."""

    def slide(
        self,
        shape: core.Shape,
        steps: Iterable[Mapping[str, Any]] | None = None,
        *,
        load: float | None = None,
        approach: float | None = None,
        eccentricity: Along | None = None,
        moment: Along | None = None,
        tilt: Along | None = None,
        friction: npt.ArrayLike | None = None,
        shift: Along | None = None,
        force: Along | None = None,
        twist: float | None = None,
        torque: float | None = None,
        tolerance: float = 1e-8,
        max_convolutions: int = 4000,
        coupling: bool = True,
        initial: FrictionSolution | None = None,
        progress: Told | None = None,
        check: bool = True,
    ) -> Any:
        """Press a shape into the body and move it tangentially, with friction.

        Parameters
        ----------
        shape : Shape
            Shape that is pressed in.
        steps, load, approach, eccentricity, moment, tilt : optional
            Steps of a history, and motion along z, as `nacre.slide` explains.
        friction, shift, force, twist, torque : optional
            Friction and tangential motion, as `nacre.slide` explains.
        tolerance, max_convolutions, coupling, initial, progress, check : optional
            How tractions are found, as `nacre.slide` explains.

        Returns
        -------
        FrictionSolution or list of FrictionSolution
            Tractions, slip, and all of the normal contact; a list where there are `steps`.

        Raises
        ------
        ValueError
            As `nacre.slide`.
        ConvergenceError
            If the tolerance was not met; the unfinished solution is its `solution`.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(2e-4, 2e-4)), steel)
        >>> ball = contact.slide(nacre.Sphere(5e-3), load=10.0, friction=0.3, force=(1.5, None))
        >>> round(ball.force[0], 6), ball.report.full_slip
        (1.5, False)
        """
        return _solutions(core.slide, locals(), self)

    def roll(
        self,
        shape: core.Shape,
        *,
        load: float | None = None,
        approach: float | None = None,
        eccentricity: Along | None = None,
        moment: Along | None = None,
        tilt: Along | None = None,
        friction: npt.ArrayLike | None = None,
        creepage: Along | None = None,
        force: Along | None = None,
        spin: float = 0.0,
        direction: Literal["+x", "-x", "+y", "-y"] | None = None,
        cells: int | None = None,
        tolerance: float = 1e-8,
        max_convolutions: int = 4000,
        coupling: bool = True,
        initial: FrictionSolution | None = None,
        progress: Told | None = None,
        check: bool = True,
    ) -> Any:
        """Press a shape into the body, which rolls steadily, or cell by cell from a given state.

        Parameters
        ----------
        shape : Shape
            Shape that is pressed in.
        load, approach, eccentricity, moment, tilt : optional
            Motion along z, as `Contact.solve` explains.
        friction, creepage, force, spin, direction, cells : optional
            Friction and rolling, as `nacre.roll` explains.
        tolerance, max_convolutions, coupling, initial, progress, check : optional
            How tractions are found, as `nacre.slide` explains.

        Returns
        -------
        FrictionSolution or list of FrictionSolution
            Steady state; a list with one solution for each cell rolled where `cells` is given.

        Raises
        ------
        ValueError
            As `nacre.roll`.
        ConvergenceError
            If the tolerance was not met; the unfinished solution is its `solution`.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(2e-4, 2e-4)), steel)
        >>> slip = {"load": 10.0, "friction": 0.3, "creepage": (0.02, None)}
        >>> wheel = contact.roll(nacre.Sphere(5e-3), **slip, direction="+x")
        >>> wheel.report.full_slip, round(wheel.force[0], 3)
        (True, 3.0)
        """
        return _solutions(core.roll, locals(), self)


# The class of the compiled module has no base in Python.
for _name in ("slide", "roll"):
    setattr(core.Contact, _name, getattr(FrictionMethods, _name))


def _solutions(
    begin: Callable[[dict[str, Any], Any], core.FrictionSteps],
    given: dict[str, Any],
    contact: object = None,
) -> Any:
    """Return the solutions of a function or method that a user called with these arguments.

    Steps are solved one after another, and warn of what they find; an exception carries those that
    are finished.
    """
    progress = given["progress"]
    if callable(progress):
        given["progress"] = lambda number, text: progress(number, FrictionReport._made(text))
    steps = begin(given, contact)
    solutions: list[FrictionSolution] = []
    try:
        for solved in steps:
            solution = FrictionSolution._of(solved)
            ended = solution.report.termination
            for warning in solution.normal.report.warnings if ended != "stopped" else []:
                warnings.warn(warning, core.NacreWarning, stacklevel=3)
            if given["check"] and ended == "iteration limit":
                error = core.ConvergenceError(solved.not_converged())
                error.solution = solution
                raise error
            solutions.append(solution)
            if ended == "stopped":
                break
    except BaseException as error:
        if steps.several:
            error.solutions = solutions  # type: ignore[attr-defined]
        raise
    return solutions if steps.several else solutions[0]


@dataclass(frozen=True, repr=False)
class CreepCoefficients(Result):
    """Kalker's linear coefficients of an elliptic contact, with their estimated errors.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.25)
    >>> creep = nacre.creep_coefficients(steel, steel, (1e-3, 1e-3))
    >>> round(creep.c11, 1), round(creep.c22, 1), round(creep.c23, 1)
    (4.1, 3.7, 1.5)
    """

    c11: float
    """C11, of the longitudinal creepage: ``F_x = a b G C11 xi``."""
    c22: float
    """C22, of the lateral creepage: ``F_y = a b G C22 eta``."""
    c23: float
    """C23, of the spin in the lateral force: ``F_y = (a b)**1.5 G C23 phi``."""
    c33: float
    """C33, of the spin in the torque: ``M_z = (a b)**2 G C33 phi``."""
    errors: tuple[float, float, float, float]
    """Estimated errors of C11, C22, C23 and C33."""
    shear: float
    """Modulus G [Pa]: 1/G is the mean of 1/G of both substrates."""
    semi_axes: tuple[float, float]
    """Semi-axes ``(a, b)`` [m], a along the direction of rolling."""

    def __repr__(self) -> str:
        """Return the coefficients with their errors."""
        coefficients = (self.c11, self.c22, self.c23, self.c33)
        numbers = zip(("C11", "C22", "C23", "C33"), coefficients, self.errors, strict=True)
        shown = ", ".join(f"{name} {c:.4f} ± {error:.4f}" for name, c, error in numbers)
        return f"<CreepCoefficients: {shown}>"


def creep_coefficients(
    body: core.HalfSpace | core.Elastic,
    counterbody: core.HalfSpace | core.Elastic | None,
    semi_axes: tuple[float, float],
    *,
    cells: int = 64,
) -> CreepCoefficients:
    """Kalker's linear coefficients of two bodies with any layers, by one call.

    Parameters
    ----------
    body, counterbody : HalfSpace, Elastic or None
        Bodies; a counterbody that is `None` is rigid.
    semi_axes : tuple of float
        Semi-axes ``(a, b)`` of the contact [m], a along the direction of rolling.
    cells : int, optional
        Cells along each axis of the ellipse, at least 8. The coefficients are extrapolated from
        these and from half as many.

    Returns
    -------
    CreepCoefficients
        C11, C22, C23 and C33, as Kalker (1990) defines them; those of coated bodies are derived
        here.

    Raises
    ------
    ValueError
        If a semi-axis is not above 0, there are fewer cells, both substrates are rigid, or a body
        has no response along its surface.
    ConvergenceError
        If the iteration did not converge.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.25)
    >>> rubber = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(50e9, 0.25), 0.5e-3)])
    >>> coated = nacre.creep_coefficients(rubber, rubber, (1e-3, 1e-3))
    >>> coated.c11 < 0.5 * nacre.creep_coefficients(steel, steel, (1e-3, 1e-3)).c11
    True
    """
    return CreepCoefficients._made(core.creep_coefficients(body, counterbody, semi_axes, cells))


def history(solutions: Sequence[FrictionSolution]) -> xarray.Dataset:
    """Dataset of the main numbers of a history, step by step; needs ``nacre-contact[files]``.

    Parameters
    ----------
    solutions : sequence of FrictionSolution
        Steps that `nacre.slide` or `Contact.roll` returned.

    Returns
    -------
    xarray.Dataset
        Load, force, torque, dissipated energy, share of the contact that sticks and the number of
        convolutions over ``step``; shift and twist of sliding, creepage of rolling.

    Raises
    ------
    TypeError
        If they are no sequence of FrictionSolution.
    ValueError
        If there is none, or some slide and some roll.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> steps = [{"force": (force, None)} for force in (2.0, -2.0, 2.0)]
    >>> loop = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, steps=steps)
    >>> study = nacre.friction.history(loop)
    >>> study.force.dims, bool((study.dissipated >= 0).all())
    (('step', 'component'), True)
    """
    with extra("files"):
        import xarray

    solutions = checked(solutions)
    line = solutions[0].grid.is_line
    force, rolls = "N/m" if line else "N", solutions[0].shift is None
    touching = [np.count_nonzero(s.pressure) for s in solutions]
    values: dict[str, tuple[tuple[str, ...], Any, str]] = {
        "load": (("step",), [s.normal.load for s in solutions], symbol(force)),
        "force": (("step", "component"), [s.force for s in solutions], symbol(force)),
        "torque": (("step",), [s.torque for s in solutions], symbol("N" if line else "N m")),
        "dissipated": (
            ("step",),
            [s.dissipated for s in solutions],
            symbol(force if rolls else ("N" if line else "N m")),
        ),
        "stick_share": (
            ("step",),
            [s.stick.sum() / max(cells, 1) for s, cells in zip(solutions, touching, strict=True)],
            "1",
        ),
        "convolutions": (("step",), [s.report.convolutions for s in solutions], "1"),
    }
    if all(s.shift is not None for s in solutions):
        values["shift"] = (("step", "component"), [s.shift for s in solutions], symbol("m"))
        values["twist"] = (("step",), [s.twist for s in solutions], "rad")
    if all(s.creepage is not None for s in solutions):
        values["creepage"] = (("step", "component"), [s.creepage for s in solutions], "1")
    dataset = xarray.Dataset(
        {name: (dims, np.asarray(data)) for name, (dims, data, _) in values.items()},
        coords={"step": np.arange(len(solutions)), "component": ["x", "y"]},
    )
    for name, (_, _, unit) in values.items():
        dataset[name].attrs = {"units": unit}
    dataset.attrs = {"title": "history of a contact with friction"}
    dataset.attrs["source"] = f"nacre {core.__version__}"
    return dataset


def creep_curve(
    shape: core.Shape,
    body: core.HalfSpace | core.Elastic,
    counterbody: core.HalfSpace | core.Elastic | None = None,
    *,
    creepages: npt.ArrayLike,
    lateral: bool = False,
    **keywords: Any,
) -> xarray.Dataset:
    """Roll at several creepages, and return the forces; needs ``nacre-contact[files]``.

    Parameters
    ----------
    shape, body, counterbody
        As `nacre.roll`.
    creepages : array_like
        Creepages, one after the other.
    lateral : bool, optional
        Whether they are lateral ones, eta, instead of longitudinal ones, xi.
    **keywords
        Other keywords of `nacre.roll`: load, friction, direction, spin, grid, tolerance.

    Returns
    -------
    xarray.Dataset
        Force along and across rolling, torque, share of the contact that sticks, and power over
        the speed of rolling, over ``creepage``; the force along the creepage over friction
        times load as ``traction_ratio``, NaN where there is neither.

    Raises
    ------
    TypeError
        If creepages are not real numbers.
    ValueError
        If creepages are not a sequence of numbers, or `nacre.roll` would raise.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> curve = nacre.friction.creep_curve(
    ...     nacre.Sphere(5e-3), steel, steel, creepages=[1e-4, 1e-2], load=10.0, friction=0.3,
    ...     direction="+x",
    ... )
    >>> curve.traction_ratio.round(3).values[-1]
    np.float64(1.0)
    """
    with extra("files"):
        import xarray

    if np.ma.isMaskedArray(creepages) or np.asarray(creepages).dtype.kind not in "biuf":
        raise TypeError(f"creepages must be real numbers without a mask, got {creepages!r}")
    values = np.asarray(creepages, dtype=np.float64)
    if values.ndim != 1 or values.size == 0:
        raise ValueError(f"creepages must be a sequence of numbers, got shape {values.shape}")
    for name in ("creepage", "force", "cells", "initial"):
        if name in keywords:
            raise ValueError(f"{name} must not be given: creepages say what is asked")
    plan = {"threads": keywords.pop("threads", None)}
    grid = keywords.pop("grid", None)
    if grid is None:
        motion = {name: keywords[name] for name in MOTION if name in keywords}
        grid = core.solve(shape, body, counterbody, **plan, **motion).report.grid
    contact = core.Contact(body, grid, counterbody, **plan)
    solutions = [
        contact.roll(shape, creepage=(None, value) if lateral else (value, None), **keywords)
        for value in values.tolist()
    ]
    along = {"+x": (0, 1), "-x": (0, -1), "+y": (1, 1), "-y": (1, -1)}
    axis, sign = along[solutions[0].direction]
    # z x e: along +y for rolling towards +x, along -x for rolling towards +y.
    across = 1 - axis, sign if axis == 0 else -sign
    forces = np.array([s.force for s in solutions])
    area = [s.normal.load / (s.pressure.sum() or 1.0) for s in solutions]
    bears = np.array([s.bound.sum() * cell for s, cell in zip(solutions, area, strict=True)])
    bears[bears <= 0] = np.nan  # there is no ratio
    driven = across if lateral else (axis, sign)
    pulled = driven[1] * forces[:, driven[0]]
    line = contact.grid.is_line
    unit = symbol("N/m" if line else "N")
    touching = np.array([np.count_nonzero(s.pressure) for s in solutions])
    columns: dict[str, tuple[Any, str]] = {
        "longitudinal_force": (sign * forces[:, axis], unit),
        "lateral_force": (across[1] * forces[:, across[0]], unit),
        "torque": ([s.torque for s in solutions], symbol("N" if line else "N m")),
        "traction_ratio": (pulled / bears, "1"),
        "stick_share": ([s.stick.sum() for s in solutions] / np.maximum(touching, 1), "1"),
        "power_over_speed": ([s.dissipated for s in solutions], unit),
    }
    dataset = xarray.Dataset(
        {name: ("creepage", np.asarray(data)) for name, (data, _) in columns.items()},
        coords={"creepage": values},
    )
    for name, (_, unit) in columns.items():
        dataset[name].attrs = {"units": unit}
    dataset["creepage"].attrs = {
        "units": "1",
        "long_name": "lateral creepage" if lateral else "longitudinal creepage",
    }
    dataset.attrs = {"title": "creep curve", "source": f"nacre {core.__version__}"}
    return dataset
