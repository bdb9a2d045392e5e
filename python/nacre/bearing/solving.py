"""The solve of a bearing: what is asked is checked, solved, and made a solution."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.notices import warn
from nacre._tools.progress import lasting
from nacre.bearing.arguments import BearingOptions, Model, Operation, RingConditions
from nacre.bearing.cone import check_carried
from nacre.bearing.contact_laws import (
    LAMINAE,
    STANDARD,
    Hertzian,
    Law,
    Reaction,
    Several,
    Slices,
    Solved,
    binned,
)
from nacre.bearing.equilibrium import Problem, State
from nacre.bearing.geometry import HIGHEST, RINGS, Bearing
from nacre.bearing.iso import edge_factors, hertz_pressures
from nacre.bearing.kinds import BallBearing, RollerBearing
from nacre.bearing.solution import BearingReport, BearingSolution, carrying, edge_pressure
from nacre.contact.solution import Solution
from nacre.contact.stresses import kinds_of
from nacre.results.verdict import SINGULAR, SLIGHT

if TYPE_CHECKING:
    from nacre.bearing.pair import PairSolution

Array = npt.NDArray[np.float64]

STEEPEST = 0.02
"""Largest tilt without a warning: about a degree, where bearings bear minutes."""
UNKNOWN_RATE = 0.75
"""Power of the size of the cells with which errors fall, where one change shows none: as that of a
contact's own estimate."""
REMEDIES = {
    "iteration limit": "raise max_iterations or the tolerance",
    "no descent": "no step lowers the energy by more than rounding: raise the tolerance",
}
"""What helps where an iteration ended before the tolerance was met."""
FINER = 0.1
"""Tolerance of the contacts over that of the bearing, which their sums inherit."""


def read_conditions(
    ring: RingConditions, largest: Mapping[str, float]
) -> tuple[list[float | None], list[float | None]]:
    """Return loads and displacements along the five directions, none above the largest."""
    values: dict[str, list[float | None]] = {}
    for name, length in (("force", 3), ("displacement", 3), ("moment", 2), ("tilt", 2)):
        numbers = getattr(ring, name)
        values[name] = core.vector(name, length, (None,) * length if numbers is None else numbers)
        known = [value for value in values[name] if value is not None]
        if not all(map(math.isfinite, known)):
            raise ValueError(f"{name} must be finite, got {numbers!r}")
        if max(map(abs, known), default=0.0) > (most := largest[name]):
            raise ValueError(f"{name} must be at most {most:.3g}, got {numbers!r}")
    loads = values["force"] + values["moment"]
    moved = values["displacement"] + values["tilt"]
    words = ["force", "force", "force", "moment", "moment"]
    motions = ["displacement", "displacement", "displacement", "tilt", "tilt"]
    axes = "xyzxy"
    for k in range(5):
        if loads[k] is not None and moved[k] is not None:
            raise ValueError(
                f"{words[k]} and {motions[k]} must not both be given "
                f"{'about' if k > 2 else 'along'} {axes[k]}, got {loads[k]!r} and {moved[k]!r}"
            )
    return loads, moved


def as_arrays(
    loads: Sequence[float | None], moved: Sequence[float | None]
) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Return loads, displacements, and which of the five directions are loaded."""
    free = np.array([value is not None for value in loads])
    return np.array([v or 0.0 for v in loads]), np.array([v or 0.0 for v in moved]), free


def _conditions(
    bearing: Bearing, ring: RingConditions
) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Return loads, displacements, and which of the five directions are loaded, checked."""
    loads, moved = read_conditions(ring, largest_of(bearing))
    if bearing.aligns:
        loads[3:] = [moment or None for moment in loads[3:]]  # it has no moment, which is 0
    if bearing.aligns and loads[3:] != [None, None]:
        raise ValueError(
            f"moment must be None or 0: a spherical roller bearing aligns itself and carries none, "
            f"got {ring.moment!r}"
        )
    if not bearing.carries_thrust:
        loads[2], moved[2] = loads[2] or None, moved[2] or None
    if not bearing.carries_thrust and (loads[2] is not None or moved[2] is not None):
        name, value = ("force", loads[2]) if moved[2] is None else ("displacement", moved[2])
        raise ValueError(
            f"{name} along z must be None or 0: rollers without a contact angle carry none, "
            f"got {value!r}"
        )
    if bearing.rows == 1 and bearing.needs_thrust and loads[2] is not None:
        _check_cone(bearing, math.hypot(*(loads[k] or 0.0 for k in range(2))), loads[2])
    return as_arrays(loads, moved)


def largest_of(bearing: Bearing) -> dict[str, float]:
    """Return the largest values along a direction: beyond them nothing is a bearing any more.

    Forces are ten times those of `HIGHEST` on all of the elements' cross-sections.
    """
    wide = 2 * bearing.reach or bearing.diameter
    force = 10 * HIGHEST * bearing.elements * bearing.diameter * wide
    moment = force * bearing.pitch
    return {"force": force, "moment": moment, "tilt": 1.0, "displacement": bearing.diameter}


def _check_cone(bearing: Bearing, radial: float, axial: float) -> None:
    """Raise a `ValueError` unless an axial force keeps the rings of a bearing together."""
    pushed = radial * math.tan(bearing.nominal_angle)
    if axial < pushed:
        raise ValueError(
            f"force along z must be at least {pushed:.6g} N, by which the radial force pushes "
            f"the rings apart, got {axial!r} N"
        )


def check_sides(
    bearing: Bearing,
    problem: Problem,
    state: State,
    tolerance: float,
    remedy: str = "force or displacement along z",
) -> None:
    """Raise a `ValueError` where a bearing with a contact angle bears where it has no shoulder.

    A row carries at positive angles towards its own side alone. Balls that nothing but their
    centrifugal force presses on the outer ring are at its bottom. A larger `remedy` helps.
    """
    if not bearing.needs_thrust:
        return
    angles = problem.kinematics.angles(problem.kinematics.ring_motion(state.ring), state.own)[:, 0]
    angles = np.repeat([1.0, -1.0][: bearing.rows], bearing.count) * angles
    is_carrying = carrying(state.reaction.force[..., 0])[:, 0]
    least = float(angles[is_carrying].min(initial=math.inf))
    if least <= tolerance:
        raise ValueError(
            f"{remedy} must be larger: an element bears at a contact angle "
            f"of {math.degrees(least):.3g} degrees, where the rings have no shoulder"
        )
    if bearing.rows == 1 and problem.free[2]:
        total = state.wanting + problem.loads
        slack = tolerance * float(state.reaction.force[..., 0].sum())
        _check_cone(bearing, math.hypot(*total[:2]), float(total[2]) + slack)


def element_angles(bearing: Bearing, rotation: float) -> Array:
    """Return the angles of all elements from x [rad]."""
    angles = rotation + 2 * math.pi * np.arange(bearing.count) / bearing.count
    return np.tile(angles, bearing.rows)


def centrifugal_force(bearing: Bearing, operation: Operation) -> float:
    """Return the centrifugal force on an element [N]."""
    cage = bearing.cage_speed(operation.speed, operation.rotating)
    return bearing.mass * bearing.pitch / 2 * cage**2


def solved_contacts(
    bearing: Bearing, law: Slices | Hertzian, places: Array, options: BearingOptions
) -> Solved:
    """Return contacts that nacre solves, on grids for the loads of a first guess.

    Two of them show what the guess lacks.
    """
    lines = law.largest_loads(places)
    if not lines.any():
        lines = lines + law.touching_loads()
    cells = options.cells or bearing.usual_cells
    contacts = Solved(bearing, lines, cells, FINER * options.tolerance, options.threads)
    contacts.match(places)
    return contacts


def find_equilibrium(
    problem: Problem,
    start: tuple[Array, Array],
    contacts: Callable[[State], Solved | Several],
    check: Callable[[Problem, State, float], None],
    options: BearingOptions,
) -> tuple[Problem, State, tuple[int, str]]:
    """Return the equilibrium, with the number of steps and how the iteration ended.

    Solved contacts begin at the equilibrium of a first guess. `check` raises an error where
    contacts bear where no ring is.
    """
    model, tolerance, progress = options.model, options.tolerance, options.progress
    limit = options.max_iterations
    with lasting("bearing") as bar:

        def tell(done: int, balance: float) -> object:
            if progress is not None:
                return progress(done, balance)
            if bar is not None:
                bar(f"step {done}, balance {balance:.0e}")
            return None

        first = None if model == "solved" else tell
        rough = tolerance if first else min(1e-6, math.sqrt(tolerance))
        state, done, ending = problem.solve(
            *start, rough, 10 * limit if first is None else limit, first
        )
        if ending == "converged":
            check(problem, state, rough)
        if model == "solved":
            problem = replace(problem, law=(law := contacts(state)))
            guess, steps = ending, limit if ending == "converged" else 0
            if steps > 0:
                matched = replace(problem, law=law.guess)
                state, _, _ = matched.solve(state.ring, state.own, rough, 10 * limit, None)
            state, done, ending = problem.solve(state.ring, state.own, tolerance, steps, tell)
            if ending == "iteration limit" and guess != "converged":
                ending = guess
            if ending == "converged":
                check(problem, state, tolerance)
    return problem, state, (done, ending)


def issue(solution: BearingSolution | PairSolution, options: BearingOptions) -> None:
    """Warn of what limits a solution, and raise an error if it did not converge."""
    report = solution.report
    for message in report.warnings:
        warn(message)
    if options.check and report.termination in REMEDIES:
        error = core.ConvergenceError(
            f"balance {report.balance:.2e} above {options.tolerance:.0e} after "
            f"{report.iterations} steps; {REMEDIES[report.termination]}"
        )
        error.solution = solution
        raise error


def solve_bearing(
    bearing: Bearing, ring: RingConditions, operation: Operation, options: BearingOptions
) -> BearingSolution:
    """Return the solution of what a user asked of a bearing."""
    loads, moved, free = _conditions(bearing, ring)
    operation, options = operation.checked(bearing), options.checked(bearing)
    angles = element_angles(bearing, operation.rotation)
    kinematics, guess = bearing.motion(angles), bearing.law(options.model)
    centrifugal = centrifugal_force(bearing, operation)
    problem = Problem(kinematics, guess, loads, free, centrifugal)
    check_carried(kinematics.generators(), loads, problem.thrust, free, kinematics.arm)
    problem, state, ending = find_equilibrium(
        problem,
        problem.start(moved, guess.approach(centrifugal)),
        lambda state: solved_contacts(bearing, guess, state.places, options),
        lambda problem, state, tolerance: check_sides(bearing, problem, state, tolerance),
        options,
    )
    solution = solution_of(bearing, operation, options, problem, state, ending)
    issue(solution, options)
    return solution


def solution_of(
    bearing: Bearing,
    operation: Operation,
    options: BearingOptions,
    problem: Problem,
    state: State,
    ending: tuple[int, str],
) -> BearingSolution:
    """Return the solution that a state is."""
    places, force = state.places, state.reaction.force
    loads, contacts = force[..., 0], dict(state.reaction.contacts)
    sizes = problem.law.sizes() if isinstance(problem.law, Solved) else None
    peaks, laminae, pressures = _contact_fields(bearing, problem.law, state)
    edges = np.full(loads.shape, np.nan) if pressures is None else edge_pressure(pressures)
    kinematics = problem.kinematics
    normals = kinematics.angles(kinematics.ring_motion(state.ring), state.own)
    total = state.wanting + problem.loads
    loaded = {key: contact for key, contact in contacts.items() if carrying(loads)[key]}
    notes = (
        *_implausible(bearing, state.ring, peaks),
        *_beyond_shoulders(bearing, normals, peaks),
        *_notes(bearing, options.model, loaded),
    )
    errors, load_error = None, None
    if isinstance(problem.law, Solved):
        errors, load_error = _discretisation(problem.law, state.reaction, peaks, edges)
    noted = [kinds_of(one) for one in loaded.values() if one.load > SLIGHT * loads.max()]
    ended = *ending[::-1], state.balance, notes, errors, load_error
    return BearingSolution(
        bearing=bearing,
        model=options.model,
        rotation=operation.rotation,
        speed=operation.speed,
        rotating=operation.rotating,
        loaded_directions=tuple(problem.free.tolist()),
        displacement=tuple(state.ring[:3].tolist()),
        tilt=tuple(state.ring[3:].tolist()),
        force=tuple(total[:3].tolist()),
        moment=tuple(total[3:].tolist()),
        angles=element_angles(bearing, operation.rotation),
        approaches=places[..., 0].copy(),
        tilts=places[..., 1].copy(),
        loads=loads.copy(),
        moments=force[..., 1] * bearing.carries_moments,
        peak_pressures=peaks,
        edge_pressures=edges,
        contact_angles=normals,
        lamina_loads=laminae,
        lamina_pressures=pressures,
        tangent=(state.tangent + state.tangent.T) / 2,
        grid_sizes=sizes,
        cells=None if sizes is None else options.cells,
        report=BearingReport(*ended, tuple(sorted(set().union(*noted)))),  # type: ignore[arg-type]
        required_life=operation.required_life,
        static_safety=operation.static_safety,
        _contacts=dict(contacts),
    )


def _contact_fields(
    bearing: Bearing, law: Law, state: State
) -> tuple[Array, Array | None, Array | None]:
    """Return the peak pressures, and the loads and pressures of the laminae of rollers."""
    loads = state.reaction.force[..., 0]
    if isinstance(law, Slices):
        assert isinstance(bearing, RollerBearing)
        laminae = law.loads(state.places)
        pressures = hertz_pressures(bearing, laminae, np.full(2, STANDARD))
        return pressures.max(-1), laminae, pressures
    if isinstance(law, Hertzian):
        return law.pressures(loads), None, None
    contacts, peaks = state.reaction.contacts, np.zeros(loads.shape)
    for key, contact in contacts.items():
        peaks[key] = contact.peak_pressure
    if not isinstance(bearing, RollerBearing):
        return peaks, None, None
    fields = np.zeros((2, *loads.shape, LAMINAE))
    for key, contact in contacts.items():
        fields[:, *key] = binned(bearing, contact)
    return peaks, *fields


def _discretisation(
    law: Solved, reaction: Reaction, peaks: Array, edges: Array
) -> tuple[dict[str, float | None], float | None]:
    """Return the errors due to the size of the cells: of peak and edge pressure [Pa], and of loads.

    Both contacts of the elements with the largest pressures are solved on half the cells under the
    same load and moment. None where the pressure has no limit, or half the cells do not carry them.

    The share by which loads err has two parts. An approach that errs by Δδ changes the load Q of a
    contact by K Δδ/Q at most, with its stiffness K: less where a force is given, since all contacts
    err alike. And laminae share the load otherwise, by the change of its mean in a life.
    """
    contacts, load_error = reaction.contacts, 0.0
    bearing = law.bearing
    pressures = [peaks, edges] if isinstance(bearing, RollerBearing) else [peaks]
    names = ("peak_pressure", "edge_pressure")
    errors: dict[str, float | None] = dict.fromkeys(names[: len(pressures)], 0.0)
    heaviest = {int(np.unravel_index(field.argmax(), field.shape)[0]) for field in pressures}
    for key in [key for key in contacts if key[0] in heaviest]:
        coarse = law.coarse_contact(key[1], contacts[key])
        if coarse is None:
            return dict.fromkeys(errors), None
        moved = abs(coarse.approach - contacts[key].approach)
        change = float(reaction.stiffness[key][0, 0]) * moved / contacts[key].load
        singular = not SINGULAR.isdisjoint(coarse.report.warning_kinds)
        values = [coarse.peak_pressure]
        if isinstance(bearing, RollerBearing):
            loads, pressures_of_laminae = binned(bearing, coarse)
            values.append(float(edge_pressure(pressures_of_laminae)))
            change += abs(_mean_load(loads) / _mean_load(binned(bearing, contacts[key])[0]) - 1)
        load_error = max(load_error, change / (2**UNKNOWN_RATE - 1))
        for name, value, field in zip(names, values, pressures, strict=False):
            known = errors[name]
            error = abs(value - float(field[key])) / (2**UNKNOWN_RATE - 1)
            errors[name] = None if singular or known is None else max(known, error)
    return errors, load_error


def _mean_load(loads: Array) -> float:
    """Return the load of laminae that counts in a life, but for a factor: ISO/TS 16281."""
    return float(((edge_factors(LAMINAE) * loads) ** 4.5).sum() ** (1 / 4.5))


def _implausible(bearing: Bearing, ring: Array, peaks: Array) -> Iterable[str]:
    """Yield warnings of tilts and pressures that no bearing has."""
    steepest = float(np.abs(ring[3:]).max())
    if steepest > STEEPEST and not bearing.aligns:
        yield (
            f"the tilt of the ring, a slope, is {steepest:.4g}: far above those of bearings, "
            "2' are 5.8e-4"
        )
    if (peak := float(peaks.max())) > HIGHEST:
        yield (
            f"the peak pressure is {peak / 1e9:.4g} GPa: above {HIGHEST / 1e9:g} GPa, contacts "
            "are neither elastic nor small"
        )


def _beyond_shoulders(bearing: Bearing, normals: Array, peaks: Array) -> Iterable[str]:
    """Yield a warning where contacts of balls reach beyond the shoulders of the rings."""
    if not isinstance(bearing, BallBearing):
        return
    for k, (ring, shoulder) in enumerate(zip(RINGS, bearing.shoulders, strict=True)):
        reached = (
            abs(normal) + bearing.spread(ring, peak)
            for normal, peak in zip(normals[:, k], peaks[:, k], strict=True)
            if peak > 0
        )
        angle = max(reached, default=0.0)
        if angle > shoulder:
            yield (
                f"contacts with the {ring} ring reach {math.degrees(angle):.3g} degrees from the "
                f"bottom of the groove, beyond its shoulder at {math.degrees(shoulder):.3g}, where "
                "they are cut off: their pressure and the life are wrong; shoulder_height says how "
                "high it is"
            )


def _notes(
    bearing: Bearing, model: Model, contacts: Mapping[tuple[int, int], Solution]
) -> Iterable[str]:
    """Yield warnings: those of contacts by kind, and what the standard's contacts leave out."""
    if model == "iso16281":
        if bearing.layered:
            yield "layers are not counted: the contacts of ISO/TS 16281 are bare"
        softer = np.abs(np.array(bearing.modulus) / STANDARD - 1)
        if isinstance(bearing, RollerBearing) and softer.max() > 0.05:
            yield "moduli are not counted: the laminae of ISO/TS 16281 are those of steel"
        return
    texts: dict[str, str] = {}
    kinds: Counter[str] = Counter()
    for contact in contacts.values():
        report = contact.report
        for kind, text in zip(report.warning_kinds, report.warnings, strict=True):
            texts.setdefault(kind, text)
        # Some are said of both axes; of a high pressure the bearing warns.
        kinds.update({kind: 1 for kind in report.warning_kinds if kind != "high pressure"})
    for kind, number in kinds.items():
        yield f"{number} of {len(contacts)} contacts: {texts[kind]}"
