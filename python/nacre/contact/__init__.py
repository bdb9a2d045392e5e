"""Contacts: planned, solved, and with friction."""

from __future__ import annotations

import copyreg
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Self, Unpack, overload

import nacre._core as core
from nacre._tools.groups import grouped
from nacre._tools.notices import warn
from nacre._tools.progress import lasting
from nacre._tools.typing import Body, Field, Layers, Matrix, Planned
from nacre.contact.arguments import (
    MOTION,
    STEP,
    FrictionOptions,
    FrictionStep,
    Motion,
    OptionKeywords,
    PlannedRollKeywords,
    PlannedSlideKeywords,
    PlannedSolveKeywords,
    Progress,
    Rolling,
    RollKeywords,
    Setup,
    SlideKeywords,
    SolveKeywords,
    SolveOptions,
    StepProgress,
)
from nacre.contact.friction import FrictionReport, FrictionSolution, History
from nacre.contact.solution import Report, Solution
from nacre.contact.wear_march import (
    PlannedWearKeywords,
    Sliding,
    WearControl,
    Wearing,
    WearKeywords,
    wear_history,
)
from nacre.contact.wear_solution import Rates, WearHistory

MOST_PRINTED = 1000
"""Largest number of coefficients that a plan prints."""


@grouped(Setup, Motion, SolveOptions)
def solve(
    shape: core.Shape,
    body: Body,
    counterbody: Body | None = None,
    **keywords: Unpack[PlannedSolveKeywords],
) -> Solution:
    """Press a shape into a body, in one call: choose a grid where none is given, plan, solve.

    By default the grid of a height map is its own. Other shapes get a grid that holds the whole
    contact, with 64 cells across its narrower width, oblong where the contact is long, and a margin
    of a quarter of the contact on every side. The cells are divided until the estimated error of
    the peak pressure (`Report.discretisation`) is at most 1 %; where that needs more than 2²²
    cells, or does not lower the estimate, a warning says so.

    Parameters
    ----------
    shape : Shape
        Shape that is pressed in.
    body : HalfSpace, Elastic or Response
        Body that it is pressed into.
    counterbody : HalfSpace, Elastic or Response, optional
        Body that carries the shape; rigid where there is none. A roller of finite length ends on
        both sides: ``HalfSpace(steel, ends=roller.ends)``.
    grid : Grid, optional
        Cells of the pressure; by default those of an `initial` solution whose surfaces have a
        permanent indentation. An endless shape, such as a cylinder, needs a grid.
    max_cells : int, optional
        Largest number of cells of the grid that is chosen where none is given, at least 4096; by
        default 2²² (4 194 304). Where the peak pressure needs more, the estimate of its error says
        what the limit costs, and a warning too where that is more than 1 %.
    threads : int, optional
        Number of threads; by default all of the machine's, or what ``NACRE_NUM_THREADS`` says.
    load : float, optional
        Force W that presses the bodies together [N], above 0; a force per length [N/m] on a
        `Grid.line`. Either `load` or `approach` is given.
    approach : float, optional
        Distance by which the shape moves towards the body at x = y = 0 [m], from the position in
        which the plane h = 0 of the shape lies on the surface of the body. Below 0 the bodies are
        apart.
    eccentricity : tuple of float or None, optional
        Point ``(e_x, e_y)`` at which the load acts [m]. Along a direction with a number the shape
        is free to tilt, and the tilt that balances the moment is found; along a direction with
        None it is not, and the tilt is 0 or what `tilt` says. It needs `load`, and the point must
        lie inside the region that can touch.
    moment : tuple of float or None, optional
        First moments of the pressure about x = y = 0, ``(∬ p x dA, ∬ p y dA)`` [N m]: load times
        eccentricity, for contacts under a given approach too. None means the same as in
        `eccentricity`.
    tilt : tuple of float or None, optional
        Slopes ``(s_x, s_y)`` by which the shape is turned [rad]: at positive x, a positive s_x
        brings it nearer to the body. None stands for 0 along a direction without eccentricity or
        moment.
    hardness : float or array_like, optional
        Largest pressure H that the surfaces can carry [Pa], above 0, of all cells or of each,
        ``(nx, ny)``: cells that would carry more yield, and keep a permanent indentation
        (`Solution.indentation`). By default they do not yield.
    compliance : float or array_like, optional
        Compliance c of springs between the surfaces [m/Pa], at least 0, of all cells or of each,
        ``(nx, ny)``: the gap has c p in it, ``g = h + u + c p − δ − s_x x − s_y y``. It is that of
        an elastic bed or of a layer of soft asperities. Values of cells need a grid. By default
        there are none.
    tolerance : float, optional
        Largest `Report.residual` and `Report.overlap` of a converged solution, both relative,
        above 0 and below 1.
    max_iterations : int, optional
        Iterations of one solve before it gives up; 10 000 by default.
    algorithm : {"cascade", "polonsky-keer"}, optional
        Preconditioned conjugate gradients on nested grids, in a window around the contact; or the
        method of Polonsky and Keer (doi:10.1016/S0043-1648(99)00113-1), as a reference.
    initial : Solution, FrictionSolution or array_like, optional
        Pressure to start from ``(nx, ny)`` [Pa], at least 0: a solution close to the one sought,
        on the same grid, such as the previous one of a series. The result does not depend on it,
        except that the surfaces keep the permanent indentation of a solution: a history of loads
        goes from one to the next.
    progress : callable, optional
        Function that is called with a `Report` at each iteration; returning False stops, and gives
        the unfinished solution.
    check : bool, optional
        Whether to raise an error if the tolerance was not met.

    Returns
    -------
    Solution
        Pressure, gap, displacement, approach and tilt.

    Raises
    ------
    ValueError
        If an argument is out of range, the arguments contradict each other, no grid is found, a
        free end of a body lies within a cell, or the counterbody ends within the shape that it
        carries.
    ConvergenceError
        If the tolerance was not met; the unfinished solution is its `solution`.

    See Also
    --------
    Contact.solve : explains the degrees of freedom of the motion.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> dlc = nacre.Elastic(young=420e9, poisson=0.3)
    >>> body = nacre.HalfSpace(steel, layers=[nacre.Layer(dlc, thickness=40e-6)])
    >>> roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5, length=30e-3)
    >>> solution = nacre.solve(roller, body, load=1e3, eccentricity=(2.87e-3, None))
    >>> round(solution.eccentricity[0], 8)
    0.00287
    """
    setup = Setup.of(keywords, body, counterbody).checked(shape, keywords)
    return _solve(shape, setup, keywords)


@overload
def slide(
    shape: core.Shape,
    body: Layers,
    counterbody: Layers | None = None,
    *,
    steps: None = None,
    **keywords: Unpack[PlannedSlideKeywords],
) -> FrictionSolution: ...


@overload
def slide(
    shape: core.Shape,
    body: Layers,
    counterbody: Layers | None = None,
    *,
    steps: Iterable[Mapping[str, object]],
    **keywords: Unpack[PlannedSlideKeywords],
) -> History: ...


@grouped(Setup, Motion, FrictionStep, FrictionOptions)
def slide(
    shape: core.Shape,
    body: Layers,
    counterbody: Layers | None = None,
    *,
    steps: Iterable[Mapping[str, object]] | None = None,
    **keywords: Unpack[PlannedSlideKeywords],
) -> FrictionSolution | History:
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
    steps : iterable of mapping, optional
        Steps of a history, each a mapping of the keywords from `load` to `torque`. Motion along z
        and friction that a step does not give stay as in the step before; at first, they are
        those of the call.
    grid : Grid, optional
        Cells of pressure and traction; by default that of `solve` for the largest load.
    max_cells : int, optional
        Largest number of cells of the grid that is chosen where none is given, at least 4096; by
        default 2²² (4 194 304). Where the peak pressure needs more, the estimate of its error says
        what the limit costs, and a warning too where that is more than 1 %.
    threads : int, optional
        Number of threads; by default all of the machine's, or what ``NACRE_NUM_THREADS`` says.
    load, approach, eccentricity, moment, tilt : optional
        Motion along z, as `Contact.solve` explains.
    friction : float or array_like
        Coefficient of friction, at least 0: one number, or one for each cell ``(nx, ny)``.
    shift : tuple of float or None, optional
        Shift ``(d_x, d_y)`` of the counterbody over the body at the end of the step [m], since
        the first touch. None: it stays where it is, unless there is a force. In line contact it is
        counted from the bare substrate's surface, as `Grid.line` says.
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
    initial : FrictionSolution or History, optional
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
    FrictionSolution or History
        Tractions, slip, and all of the normal contact; a list of them where there are `steps`.

    Raises
    ------
    ValueError
        If an argument is out of range, friction cannot bear the force, a body has free ends or a
        frictionless interface, or is known by its normal response alone.
    ConvergenceError
        If the tolerance was not met; the unfinished solution is its `solution`.

    Notes
    -----
    Coulomb's law holds in each cell. The bodies are half-spaces, and all is quasi-static. The
    history is also found on cells of twice the length: `FrictionReport.discretisation` follows from
    it, and a first step starts there. Once a
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
    setup = Setup.of(keywords, body, counterbody).checked(shape, keywords)
    return _slide(shape, steps, setup, keywords)


@overload
def roll(
    shape: core.Shape,
    body: Layers,
    counterbody: Layers | None = None,
    *,
    cells: None = None,
    **keywords: Unpack[PlannedRollKeywords],
) -> FrictionSolution: ...


@overload
def roll(
    shape: core.Shape,
    body: Layers,
    counterbody: Layers | None = None,
    *,
    cells: int,
    **keywords: Unpack[PlannedRollKeywords],
) -> History: ...


@grouped(Setup, Motion, Rolling, FrictionOptions)
def roll(
    shape: core.Shape, body: Layers, counterbody: Layers | None = None, **keywords: Any
) -> FrictionSolution | History:
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
    max_cells : int, optional
        Largest number of cells of the grid that is chosen where none is given, at least 4096; by
        default 2²² (4 194 304). Where the peak pressure needs more, the estimate of its error says
        what the limit costs, and a warning too where that is more than 1 %.
    threads : int, optional
        Number of threads; by default all of the machine's, or what ``NACRE_NUM_THREADS`` says.
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
    direction : {"+x", "-x", "+y", "-y"} or tuple of float, optional
        Direction of rolling along an axis, in which the leading edge lies; "+y" for shapes that
        roll across the x axis, as rollers do. Other shapes need it.
    cells : int, optional
        Number of cells to roll from `initial` on, or from the first touch. By default the steady
        state is found.
    order : {2, 1}, optional
        Order of the error in the length of a cell. With 1, the slip is that of Kalker's program
        CONTACT, and the solution has no estimate of its discretisation error.
    tolerance, max_convolutions, coupling, initial, progress, check : optional
        How tractions are found, as `slide` explains.

    Returns
    -------
    FrictionSolution or History
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
    for its derivative (Kalker 1990), half a cell ahead of the centre; leading cells and slipping
    ones are corrected for it, so that forces are right to the second order of the cells. The steady
    state is also found on cells of twice the length: that is where the solve starts, and what
    `FrictionReport.discretisation` follows from.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> ball = nacre.Sphere(5e-3)
    >>> pull = {"load": 10.0, "friction": 0.3, "force": (1.5, None)}
    >>> wheel = nacre.roll(ball, steel, steel, **pull, direction="+x")
    >>> round(wheel.force[0], 6), wheel.creepage[0] > 0
    (1.5, True)
    """
    setup = Setup.of(keywords, body, counterbody).checked(shape, keywords)
    return _roll(shape, setup, keywords)


@grouped(Setup, Motion, Rates, Sliding, WearControl)
def wear(
    shape: core.Shape,
    body: Body,
    counterbody: Body | None = None,
    **keywords: Unpack[PlannedWearKeywords],
) -> WearHistory:
    """Slide a shape over a body, and wear both by Archard's law, in one call.

    An automatic grid grows with the contact. Steps are implicit: none is too long to be stable.

    Parameters
    ----------
    shape : Shape
        Shape that is pressed in.
    body : HalfSpace, Elastic or Response
        Body that it is pressed into.
    counterbody : HalfSpace, Elastic or Response, optional
        Body that carries the shape; rigid where there is none.
    grid : Grid, optional
        Cells of the pressure; by default those of `solve`, which grow.
    max_cells, threads : optional
        As `nacre.solve` explains.
    load, approach, eccentricity, moment, tilt : optional
        Motion along z, as `nacre.solve` explains.
    rate : float or mapping
        Specific wear rate κ of the body [m²/N], at least 0: one number, or one of each layer, by
        number or name, and "substrate". 1 m²/N is 1e9 mm³/(N m). Archard's k/H is κ.
    counter_rate : float or mapping, optional
        That of the counterbody, or of the rigid shape.
    sliding : float, optional
        Sliding distance [m], everywhere the same. One of `sliding`, `cycles` and `passes` is given.
    cycles : float, optional
        Number of fretting cycles; `slide` says what a cycle is. The slip is that of the worn bodies
        at the start of each step, in which it stays as it is.
    slide : mapping, optional
        Keywords of `nacre.slide`: `steps` of one cycle, which is made twice, and `friction`. The
        slips of the second time count.
    passes : float, optional
        Number of passes of a wheel; `roll` says how it rolls. A pass takes ``κ ∫ p |slip|`` along
        the rolling direction off the whole track, together κ/μ times what it dissipates, and steps
        are explicit.
    roll : mapping, optional
        Keywords of `nacre.roll`: `friction`, `creepage`, `spin`, `direction` and others.
    slip : array_like, optional
        Slip of each cell per metre of sliding ``(nx, ny)``, at least 0; 1 by default.
    steps : int or array_like, optional
        Number of equal steps, or their ends in ascending order, from above 0 to the whole distance.
        By default as many as keep the error of each within `step_tolerance`. All are made again in
        halves, or whole, for `WearState.step_error` and the uncertainty of the life.
    step_tolerance : float, optional
        Largest error of the pressure that a step may add, over the largest peak of the history; not
        beside given `steps`.
    scheme : {"trapezoidal", "euler"}, optional
        Steps of second order, which may ring where they are too long and given; or of first order,
        which never do.
    thickness : {"frozen", "first order"}, optional
        How thick the layers are in the elastic contact: as before wear, or, to first order in the
        depth, thinner in each cell of the top layers by what is worn there. That takes 3.5 times
        as long, 1.3 times in line contact. Slips of `slide` and `roll`, stiffness, gradients and
        stresses of the solutions are those of layers as thick as before.
    initial : WearHistory or array_like, optional
        History of the same shape, bodies, thickness and kind of motion to go on from, by the
        distance that is given; load, rates, slips and steps may be others. Or depth removed from
        the body before, ``(nx, ny)`` [m].
    until : "through", optional
        Whether it ends where the first layer is through.
    store : str or os.PathLike, optional
        File ``.nc`` for the history in the end. Each state is added to a ``.journal`` beside it
        before the next step; where there is one, the same call goes on from it, with other steps if
        need be. `nacre.load` reads both.
    tolerance, max_iterations : optional
        How each contact is solved, as `nacre.solve` explains.
    progress : callable, optional
        Function that is called with each `WearState`; returning False stops.

    Returns
    -------
    WearHistory
        Worn contacts over the distance, and where layers are through.

    Raises
    ------
    ValueError
        If an argument is out of range, a layer is unknown or has no rate, or not exactly one of
        `sliding`, `cycles` and `passes` is given; or if the history to go on from is another.
    BlockingIOError
        If another call writes the store, in this process or in another.
    ConvergenceError
        If a contact did not converge. This and every other exception carries what is finished as
        `history`.

    Notes
    -----
    The rate is one of a model: measured rates scatter by half and more.
    `WearReport.thickness_error` says what the `thickness` of the layers costs. To first order, the
    peak errs by 0.3 to 1.6 % where 40 % of a hard coat are worn, of a soft one by 4 to 8 %.

    Examples
    --------
    How far until the coat of a roller is through?

    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> dlc = nacre.Elastic(young=300e9, poisson=0.25)
    >>> body = nacre.HalfSpace(steel, layers=[nacre.Layer(dlc, thickness=2e-6)])
    >>> grid, rates = nacre.Grid.line(64, 6e-4), {0: 1e-17, "substrate": 1e-15}
    >>> history = nacre.wear(
    ...     nacre.Cylinder(10e-3), body, load=1e5, grid=grid, rate=rates, sliding=5e3,
    ...     until="through",
    ... )
    >>> abs(history.life.position[1]) < 1e-5
    True
    """
    control = WearControl.of(keywords)
    before = control.initial if isinstance(control.initial, WearHistory) else None
    setup = Setup.of(keywords, body, counterbody).checked(shape, {**keywords, "initial": before})
    bodies = Wearing(body, counterbody, Rates.of(keywords), grows=keywords.get("grid") is None)
    return wear_history(shape, Motion.of(keywords), bodies, Sliding.of(keywords), control, setup)


class Contact:
    """A body on a grid, planned once: influence coefficients and their transform.

    Parameters
    ----------
    body : HalfSpace, Elastic or Response
        Body that the shape is pressed into.
    grid : Grid
        Cells of the pressure.
    counterbody : HalfSpace, Elastic or Response, optional
        Body that carries the shape; rigid where there is none.
    coefficients : array_like, optional
        Influence coefficients ``(nx, ny)`` [m/Pa] of both bodies together, such as those of another
        method of `influence_coefficients`; by default the exact ones of the bodies.
    threads : int, optional
        Number of threads; by default all of the machine's, or what ``NACRE_NUM_THREADS`` says.

    Raises
    ------
    ValueError
        If an argument is out of range.
    MemoryError
        If the grid does not fit into memory: a plan and a solve take up to 170 bytes a cell, with a
        hardness 210.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(4e-4, 4e-4)))
    >>> solution = contact.solve(nacre.Sphere(5e-3), load=10.0)
    >>> round(solution.load, 6)
    10.0
    """

    __slots__ = ("_plan",)

    _plan: core.Plan

    def __new__(
        cls,
        body: Body,
        grid: core.Grid,
        counterbody: Body | None = None,
        *,
        coefficients: Matrix | None = None,
        threads: int | None = None,
    ) -> Self:
        """Plan the contact."""
        contact = super().__new__(cls)
        contact._plan = core.Plan(body, grid, counterbody, coefficients, threads)
        return contact

    @property
    def body(self) -> Planned:
        """Body that the shape is pressed into."""
        return self._plan.body()

    @property
    def counterbody(self) -> Planned | None:
        """Body that carries the shape; rigid where `None`."""
        return self._plan.counterbody()

    @property
    def grid(self) -> core.Grid:
        """Cells of the pressure."""
        return self._plan.grid()

    @property
    def coefficients(self) -> Field | None:
        """Influence coefficients ``(nx, ny)`` [m/Pa] that were given.

        `None` where they are those of the bodies.
        """
        return self._plan.coefficients()

    @property
    def threads(self) -> int:
        """Number of threads of the plan."""
        return self._plan.threads()

    @grouped(Motion, SolveOptions)
    def solve(self, shape: core.Shape, **keywords: Unpack[SolveKeywords]) -> Solution:
        """Press a shape into the body.

        Each of the three degrees of freedom of the rigid motion is prescribed or loaded, in any
        mixture. Exactly one of `load` and `approach` is given, and along x and along y at most one
        of `eccentricity`, `moment` and `tilt`; with none of them the tilt is locked at 0.

        Parameters
        ----------
        shape : Shape
            Shape that is pressed in.
        load, approach, eccentricity, moment, tilt : optional
            Rigid motion, as `nacre.solve` explains.
        hardness, compliance, tolerance, max_iterations, algorithm : optional
            How the solution is found, as `nacre.solve` explains.
        initial, progress, check : optional
            Where it starts, who is told, and whether it must converge, as `nacre.solve` explains.

        Returns
        -------
        Solution
            Pressure, gap, displacement, approach and tilt.

        Raises
        ------
        ValueError
            If an argument is out of range, or the arguments contradict each other.
        ConvergenceError
            If the tolerance was not met; the unfinished solution is its `solution`.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(4e-4, 4e-4)))
        >>> contact.solve(nacre.Sphere(5e-3), approach=-1e-6).load
        0.0
        """
        return _solve(shape, self._plan, keywords)

    @grouped(SolveOptions, leave=("initial",))
    def solve_many(
        self,
        cases: Iterable[Mapping[str, object]],
        *,
        progress: Callable[[int, int], object] | None = None,
        **keywords: Unpack[OptionKeywords],
    ) -> list[Solution]:
        """Solve many load cases side by side, each on a thread of its own.

        Parameters
        ----------
        cases : iterable of mapping
            Cases, each with `shape` and the keywords of `solve` that say how it is pressed: `load`,
            `approach`, `eccentricity`, `moment`, `tilt`.
        progress : callable, optional
            Function that is called with the number of finished cases and of all cases, at most 50
            times a second, and at the end. Its result is ignored.
        hardness, compliance, tolerance, max_iterations, algorithm : optional
            How the solutions are found, as `nacre.solve` explains.
        check : bool, optional
            Whether to raise an error if the tolerance was not met.

        Returns
        -------
        list of Solution
            Solutions in the order of the cases; each has the bits that `solve` gives.

        Raises
        ------
        TypeError
            If a case is not a mapping of keywords of `solve`.
        ValueError
            If a case is out of range. A note of the error says which case it is.
        ConvergenceError
            If the tolerance was not met in a case.

        Notes
        -----
        Once the solves have begun, every exception that ends them, `KeyboardInterrupt` included,
        carries the finished ones as `solutions`: a list in the order of the cases, with `None` for
        a case that is not finished.

        Under a load, successive cases whose shape is the same object share its undeformed gap: they
        take two thirds of the memory.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(4e-4, 4e-4)))
        >>> ball = nacre.Sphere(5e-3)
        >>> cases = [{"shape": ball, "load": load} for load in (5.0, 10.0)]
        >>> [round(solution.load, 6) for solution in contact.solve_many(cases)]
        [5.0, 10.0]
        """
        words = ("a case", "cases", "solve", "in case")
        mappings = _mappings(words, cases, ("shape", *MOTION))
        shape_motions = [(case["shape"], Motion.of(case)) for case in mappings]
        options = SolveOptions.of(keywords).replaced(progress=progress)
        outcomes, failure = self._plan.solve_many(shape_motions, options)
        solutions: list[Solution | None] = []
        for number, ((shape, _), outcome) in enumerate(zip(shape_motions, outcomes, strict=True)):
            solution = None
            if isinstance(outcome, core.Solved):
                try:
                    solution = _checked_solution(outcome, shape, options.check)
                except Exception as error:  # of the tolerance, or a warning that is one
                    error.add_note(f"in case {number}")
                    outcome, solution = error, getattr(error, "solution", None)
            if isinstance(outcome, BaseException):
                failure = failure or outcome
            solutions.append(solution)
        if failure is not None:
            failure.solutions = solutions  # type: ignore[attr-defined]
            raise failure
        return [solution for solution in solutions if solution is not None]

    @overload
    def slide(
        self, shape: core.Shape, steps: None = None, **keywords: Unpack[SlideKeywords]
    ) -> FrictionSolution: ...
    @overload
    def slide(
        self,
        shape: core.Shape,
        steps: Iterable[Mapping[str, object]],
        **keywords: Unpack[SlideKeywords],
    ) -> History: ...

    @grouped(Motion, FrictionStep, FrictionOptions)
    def slide(
        self,
        shape: core.Shape,
        steps: Iterable[Mapping[str, object]] | None = None,
        **keywords: Unpack[SlideKeywords],
    ) -> FrictionSolution | History:
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
        FrictionSolution or History
            Tractions, slip, and all of the normal contact; a list of them where there are `steps`.

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
        return _slide(shape, steps, self._plan, keywords)

    @overload
    def roll(
        self, shape: core.Shape, *, cells: None = None, **keywords: Unpack[RollKeywords]
    ) -> FrictionSolution: ...
    @overload
    def roll(
        self, shape: core.Shape, *, cells: int, **keywords: Unpack[RollKeywords]
    ) -> History: ...

    @grouped(Motion, Rolling, FrictionOptions)
    def roll(self, shape: core.Shape, **keywords: Any) -> FrictionSolution | History:
        """Press a shape into the body, which rolls steadily, or cell by cell from a given state.

        Parameters
        ----------
        shape : Shape
            Shape that is pressed in.
        load, approach, eccentricity, moment, tilt : optional
            Motion along z, as `Contact.solve` explains.
        friction, creepage, force, spin, direction, cells, order : optional
            Friction and rolling, as `nacre.roll` explains.
        tolerance, max_convolutions, coupling, initial, progress, check : optional
            How tractions are found, as `nacre.slide` explains.

        Returns
        -------
        FrictionSolution or History
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
        return _roll(shape, self._plan, keywords)

    @grouped(Motion, Rates, Sliding, WearControl)
    def wear(self, shape: core.Shape, **keywords: Unpack[WearKeywords]) -> WearHistory:
        """Slide a shape over the body, and wear both by Archard's law, on the grid of the plan.

        Parameters
        ----------
        shape : Shape
            Shape that is pressed in.
        load, approach, eccentricity, moment, tilt : optional
            Motion along z, as `nacre.solve` explains.
        rate, counter_rate, sliding, cycles, slide, passes, roll, slip : optional
            What wears and how far, as `nacre.wear` explains.
        steps, step_tolerance, scheme, thickness, initial, until, store : optional
            Steps, as `nacre.wear` explains.
        tolerance, max_iterations : optional
            How each contact is solved, as `nacre.solve` explains.
        progress : callable, optional
            Function that is called with each `WearState`; returning False stops.

        Returns
        -------
        WearHistory
            Worn contacts over the distance, and where layers are through.

        Raises
        ------
        ValueError
            As `nacre.wear`.
        ConvergenceError
            If a contact did not converge.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(4e-4, 4e-4)))
        >>> history = contact.wear(nacre.Sphere(5e-3), load=10.0, rate=1e-16, sliding=1.0, steps=2)
        >>> len(history)
        3
        """
        motion, extent = Motion.of(keywords), Sliding.of(keywords)
        bodies = Wearing(self.body, self.counterbody, Rates.of(keywords), grows=False)
        return wear_history(shape, motion, bodies, extent, WearControl.of(keywords), self._plan)

    def __eq__(self, other: object) -> bool:
        """Return whether body, grid, counterbody, given coefficients and threads are the same."""
        return self._plan == other._plan if isinstance(other, Contact) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Return the call that makes the plan."""
        full = self.coefficients
        coefficients = full if full is None or full.size > MOST_PRINTED else full.tolist()
        return (
            f"Contact({self.body!r}, {self.grid!r}, counterbody={self.counterbody!r}, "
            f"coefficients={coefficients!r}, threads={self._plan.asked_threads()!r})"
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Return a callable and arguments with which a pickle of any protocol plans again."""
        keywords = {"coefficients": self.coefficients, "threads": self._plan.asked_threads()}
        call = (type(self), (self.body, self.grid, self.counterbody), keywords)
        return copyreg.__newobj_ex__, call  # type: ignore[attr-defined]


def _solve(shape: core.Shape, on: Setup | core.Plan, keywords: Mapping[str, Any]) -> Solution:
    """Return the solution of what a user asked."""
    options = SolveOptions.of(keywords)
    state, callback = _initial_state(options.initial), _report_callback(options.progress)
    options = options.replaced(initial=state, progress=callback)
    solved = core.solve(shape, Motion.of(keywords), options, on)
    return _checked_solution(solved, shape, options.check)


def _friction_options(keywords: Mapping[str, Any]) -> FrictionOptions:
    options = FrictionOptions.of(keywords)
    state, callback = _last_state(options.initial), _step_callback(options.progress)
    return options.replaced(initial=state, progress=callback)


def _slide(
    shape: core.Shape,
    steps: Iterable[Mapping[str, object]] | None,
    on: Setup | core.Plan,
    keywords: Mapping[str, Any],
) -> FrictionSolution | History:
    """Return the solution of one step, or the history of several."""
    step, options = FrictionStep.of(keywords), _friction_options(keywords)
    history = _history_steps(steps)
    moves = core.slide(shape, step, history, options, on)
    return _solve_steps(moves, shape, 1 if history is None else len(history), options)


def _roll(
    shape: core.Shape, on: Setup | core.Plan, keywords: Mapping[str, Any]
) -> FrictionSolution | History:
    """Return the solution of steady rolling, or the history of rolling over some cells."""
    rolling, options = Rolling.of(keywords), _friction_options(keywords)
    moves = core.roll(shape, rolling, options, on)
    return _solve_steps(moves, shape, rolling.cells or 1, options)


def _initial_state(
    initial: Solution | FrictionSolution | Matrix | None,
) -> core.Solved | Matrix | None:
    """Return what the compiled module starts a solve from."""
    if isinstance(initial, FrictionSolution):
        return initial.normal._solved
    return initial._solved if isinstance(initial, Solution) else initial


def _last_state(initial: Any) -> core.FrictionSolved | None:
    """Return the state of the compiled module from which a contact with friction goes on."""
    last = initial[-1] if isinstance(initial, History) and initial else initial
    return last._solved if isinstance(last, FrictionSolution) else last


def _report_callback(progress: Progress | None) -> Callable[..., object] | None:
    """Return a function that is called with the parts of a report; the module refuses others."""
    if not callable(progress):
        return progress
    return lambda *parts: progress(Report._of(parts))


def _step_callback(progress: StepProgress | None) -> Callable[..., object] | None:
    """Return a function that is called with the fields of the report of a step, likewise."""
    if not callable(progress):
        return progress
    return lambda number, fields: progress(number, FrictionReport._from_fields(fields))


def _checked_solution(solved: core.Solved, shape: core.Shape, check: bool) -> Solution:
    """Return a solution and issue its warnings, unless its tolerance was not met."""
    solution = Solution._of(solved, shape)
    if check and (missed := solved.not_converged()) is not None:
        error = core.ConvergenceError(missed)
        error.solution = solution
        raise error
    for message in solution.report.warnings:
        warn(message)
    return solution


def _mappings(
    words: tuple[str, str, str, str], entries: Iterable[Mapping[str, object]], names: Sequence[str]
) -> list[dict[str, Any]]:
    """Return cases or steps as dictionaries with these keys.

    The words name one of them, all, their function, and the note of an error before its number.
    """
    one, all_, function, note = words
    try:
        items = iter(entries)
    except TypeError as error:
        raise TypeError(f"{all_} must be an iterable of mappings, got {entries!r}") from error
    mappings = list(items)
    for number, item in enumerate(mappings):
        if not isinstance(item, Mapping):
            message = f"{one} must be a mapping of keywords of `{function}`, got {item!r}"
        elif others := [key for key in item if key not in names]:
            message = f"keys of {one} must be among {', '.join(names)}, got {others[0]!r}"
        elif "shape" in names and item.get("shape") is None:
            message = f"{one} must have a shape"
        else:
            continue
        refusal = TypeError(message)
        refusal.add_note(f"{note} {number}")
        raise refusal
    return [dict(item) for item in mappings]


def _history_steps(steps: Iterable[Mapping[str, object]] | None) -> list[FrictionStep] | None:
    """Return the steps of a history, where there is one."""
    if steps is None:
        return None
    words = ("a step", "steps", "slide", "step")
    return [FrictionStep.of(mapping) for mapping in _mappings(words, steps, STEP)]


def _solve_steps(
    steps: core.FrictionSteps, shape: core.Shape, count: int, options: FrictionOptions
) -> FrictionSolution | History:
    """Return the solutions of so many steps, or that of the only one.

    Steps are solved one after another, and warn of what they find; an exception carries those that
    are finished.
    """
    solutions: list[FrictionSolution] = []
    try:
        with lasting("steps", options.progress) as tell:
            for solved in steps:
                solution = FrictionSolution._of(solved, shape)
                termination = solution.report.termination
                if options.check and termination == "iteration limit":
                    error = core.ConvergenceError(solved.not_converged())
                    error.solution = solution
                    raise error
                for warning in solution.report.warnings if termination != "stopped" else []:
                    warn(warning)
                solutions.append(solution)
                if termination == "stopped":
                    break
                if options.progress is None and tell is not None:
                    tell(len(solutions) / count)
    except BaseException as error:
        if steps.several:
            error.solutions = solutions  # type: ignore[attr-defined]
        raise
    return History(solutions) if steps.several else solutions[0]
