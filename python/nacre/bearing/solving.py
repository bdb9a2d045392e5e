"""The solve of a bearing: what is asked is checked, solved, and made a solution."""

from __future__ import annotations

import math
import warnings
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.progress import check_progress, lasting
from nacre._tools.typing import among
from nacre.bearing.equilibrium import Problem, State, kinematics_of
from nacre.bearing.geometry import HIGHEST, RINGS, Bearing, above, pair
from nacre.bearing.iso import hertz_pressures
from nacre.bearing.laws import LAMINAE, STANDARD, Hertzian, Slices, Solved, binned, law
from nacre.bearing.solution import EDGE, BearingReport, BearingSolution, Model, carrying
from nacre.contact.solution import Solution

Array = npt.NDArray[np.float64]

CELLS = {True: (3 * LAMINAE, 48), False: (96, 96)}
"""Cells of contacts of rollers and of balls by default.

With these the load of a ball at a given approach is right to 1e-4, the peak pressure of a roller
to 1e-3, and the pressure near its edge, where it is steep, to 2 %: measured against twice as many.
"""
STEEPEST = 0.02
"""Largest prescribed tilt without a warning: about a degree, where bearings bear minutes."""
TURNED = 1e6
"""Largest angle of the elements [rad], which is right to 1e-10."""
FASTEST = 1e3
"""Largest speed of the elements [m/s], at which rings of steel burst."""
FINER = 0.1
"""Tolerance of the contacts over that of the bearing, which their sums inherit."""


def _asked(
    bearing: Bearing, given: Mapping[str, Any]
) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Return loads, displacements, and which of the five directions are loaded, checked."""
    values: dict[str, list[float | None]] = {}
    for name, length in (("force", 3), ("displacement", 3), ("moment", 2), ("tilt", 2)):
        told = (None,) * length if given[name] is None else given[name]
        if isinstance(told, str) or not isinstance(told, Iterable):
            raise TypeError(f"{name} must be {length} numbers or None, got {told!r}")
        found = [*told]
        if len(found) != length:
            raise ValueError(f"{name} must be {length} numbers or None, got {told!r}")
        most = _most(bearing, name)
        for value in found:
            if value is not None and (
                isinstance(value, bool) or not isinstance(value, int | float | np.number)
            ):
                raise TypeError(f"{name} must be {length} numbers or None, got {told!r}")
            if value is not None and not math.isfinite(value):
                raise ValueError(f"{name} must be finite, got {told!r}")
            if value is not None and abs(value) > most:
                raise ValueError(f"{name} must be at most {most:.3g}, got {told!r}")
        values[name] = found
    loads = values["force"] + values["moment"]
    moved = values["displacement"] + values["tilt"]
    words = ["force", "force", "force", "moment", "moment"]
    others = ["displacement", "displacement", "displacement", "tilt", "tilt"]
    axes = "xyzxy"
    for k in range(5):
        if loads[k] is not None and moved[k] is not None:
            raise ValueError(
                f"{words[k]} and {others[k]} must not both be given "
                f"{'about' if k > 2 else 'along'} {axes[k]}, got {loads[k]!r} and {moved[k]!r}"
            )
    if bearing.aligns:
        loads[3:] = [moment or None for moment in loads[3:]]  # it has no moment, which is 0
    if bearing.aligns and loads[3:] != [None, None]:
        raise ValueError(
            f"moment must be None or 0: a spherical roller bearing aligns itself and carries none, "
            f"got {given['moment']!r}"
        )
    axial = not bearing.rolls or bearing.nominal_angle > 0
    if not axial:
        loads[2], moved[2] = loads[2] or None, moved[2] or None
    if not axial and (loads[2] is not None or moved[2] is not None):
        name, value = ("force", loads[2]) if moved[2] is None else ("displacement", moved[2])
        raise ValueError(
            f"{name} along z must be None or 0: rollers without a contact angle carry none, "
            f"got {value!r}"
        )
    if bearing.rows == 1 and loads[2] is not None:
        _check_cone(bearing, math.hypot(*(loads[k] or 0.0 for k in range(2))), loads[2])
    free = np.array([value is not None for value in loads])
    return np.array([v or 0.0 for v in loads]), np.array([v or 0.0 for v in moved]), free


def _most(bearing: Any, name: str) -> float:
    """Return the largest value along a direction: beyond it nothing is a bearing any more.

    Forces are ten times those of `HIGHEST` on all of the elements' cross-sections.
    """
    wide = bearing.length if bearing.rolls else bearing.diameter
    force = 10 * HIGHEST * bearing.elements * bearing.diameter * wide
    limits = {"force": force, "moment": force * bearing.pitch, "tilt": 1.0}
    return float(limits.get(name, bearing.diameter))


def _check_cone(bearing: Bearing, radial: float, axial: float) -> None:
    """Raise a `ValueError` unless an axial force keeps the rings of a bearing together."""
    pushed = radial * math.tan(bearing.nominal_angle)
    if bearing.nominal_angle > 0 and axial < pushed:
        raise ValueError(
            f"force along z must be at least {pushed:.6g} N, by which the radial force pushes "
            f"the rings apart, got {axial!r}"
        )


def _check_sides(bearing: Bearing, problem: Problem, state: State, tolerance: float) -> None:
    """Raise a `ValueError` where a bearing with a contact angle bears where it has no shoulder.

    A row carries at positive angles towards its own side alone. Balls that nothing but their
    centrifugal force presses on the outer ring are at its bottom.
    """
    if bearing.leans or not bearing.nominal_angle:
        return
    angles = problem.kinematics.angles(problem.kinematics.motion @ state.ring, state.own)[:, 0]
    angles = np.repeat([1.0, -1.0][: bearing.rows], bearing.count) * angles
    carried = carrying(state.reaction.force[..., 0])[:, 0]
    least = float(angles[carried].min(initial=math.inf))
    if least <= tolerance:
        raise ValueError(
            f"force or displacement along z must be larger: an element bears at a contact angle "
            f"of {math.degrees(least):.3g} degrees, where the rings have no shoulder"
        )
    if bearing.rows == 1 and problem.free[2]:
        total = state.wanting + problem.loads
        slack = tolerance * float(state.reaction.force[..., 0].sum())
        _check_cone(bearing, math.hypot(*total[:2]), float(total[2]) + slack)


def solved(bearing: Bearing, given: Mapping[str, Any]) -> BearingSolution:
    """Return the solution of what a user asked of a bearing with these arguments of `solve`."""
    loads, moved, free = _asked(bearing, given)
    model, cells, tolerance = given["model"], given["cells"], given["tolerance"]
    for name in ("rotation", "speed"):
        above(name, given[name], -math.inf)
    if abs(given["rotation"]) > TURNED:
        raise ValueError(f"rotation must be at most {TURNED:g} rad, got {given['rotation']!r}")
    if abs(given["speed"]) * bearing.pitch / 2 > FASTEST:
        raise ValueError(
            f"speed must be at most {2 * FASTEST / bearing.pitch:.3g} rad/s, where elements move "
            f"at {FASTEST:g} m/s, got {given['speed']!r}"
        )
    for name in ("max_iterations", "threads"):
        value = given[name]
        if name == "threads" and value is None:
            continue
        if isinstance(value, bool) or not isinstance(value, int):
            raise TypeError(f"{name} must be an integer, got {value!r}")
        if value < 1:
            raise ValueError(f"{name} must be at least 1, got {value!r}")
    if not among(model, ("solved", "iso16281")):
        raise ValueError(f'model must be "solved" or "iso16281", got {model!r}')
    check_progress(given["progress"])
    above("tolerance", tolerance)
    if tolerance >= 1:
        raise ValueError(f"tolerance must be above 0 and below 1, got {tolerance!r}")
    if cells is None:
        cells = CELLS[bearing.rolls]
    cells = pair("cells", cells)
    if any(isinstance(one, bool) or not isinstance(one, int) for one in cells):
        raise TypeError(f"cells must be two integers, got {cells!r}")
    if min(cells) < 8 or (bearing.rolls and cells[0] % LAMINAE):
        multiple = f", the first a multiple of {LAMINAE}" if bearing.rolls else ""
        raise ValueError(f"cells must be two numbers of at least 8{multiple}, got {cells!r}")
    angles = given["rotation"] + 2 * math.pi * np.arange(bearing.count) / bearing.count
    angles = np.tile(angles, bearing.rows)
    kinematics = kinematics_of(bearing, angles)
    centrifugal = bearing.mass * bearing.pitch / 2 * given["speed"] ** 2
    problem = Problem(kinematics, law(bearing, model), loads, free, centrifugal)
    limit = given["max_iterations"]
    pressed = _pressed(problem.law, centrifugal)
    with lasting("bearing") as bar:

        def tell(done: int, balance: float) -> object:
            if given["progress"] is not None:
                return given["progress"](done, balance)
            if bar is not None:
                bar(f"step {done}, balance {balance:.0e}")
            return None

        first = None if model == "solved" else tell
        ring, own = problem.start(moved, pressed)
        rough = tolerance if first else min(1e-6, math.sqrt(tolerance))
        state, done, ended = problem.solve(
            ring, own, rough, 10 * limit if first is None else limit, first
        )
        if ended == "converged":
            _check_sides(bearing, problem, state, rough)
        if model == "solved":
            lines = _lines(bearing, problem.law, state)
            contacts = Solved(bearing, lines, cells, FINER * tolerance, given["threads"])
            problem = Problem(kinematics, contacts, loads, free, centrifugal)
            state, done, ended = problem.solve(state.ring, state.own, tolerance, limit, tell)
            if ended == "converged":
                _check_sides(bearing, problem, state, tolerance)
    found = _found(bearing, given, problem, state, angles, (done, ended), cells)
    for message in found.report.warnings:
        warnings.warn(message, core.NacreWarning, stacklevel=3)
    if given["check"] and ended == "iteration limit":
        error = core.ConvergenceError(
            f"balance {state.balance:.2e} above {tolerance:.0e} after {done} steps; raise "
            "max_iterations or the tolerance"
        )
        error.solution = found
        raise error
    return found


def _pressed(law: Any, force: float) -> float:
    """Return a guess of the approach of an element that is pressed on the outer ring."""
    if force == 0:
        return 0.0
    spring = law.spring[1]
    if isinstance(law, Hertzian):
        return float((force / spring) ** (2 / 3))
    return float((force / spring[0] / LAMINAE) ** 0.9)


def _lines(bearing: Any, law: Any, state: State) -> Array:
    """Return the expected loads of the contacts by which their grids are chosen."""
    places = state.places
    if not state.reaction.force.any():
        # Nothing touches: grids for an approach of a millionth of the diameter.
        places = np.zeros_like(places)
        places[..., 0] = 1e-6 * bearing.diameter
    if isinstance(law, Slices):
        lines: Array = law.loads(places).max(-1) * LAMINAE / bearing.length
        return lines
    return law(places).force[..., 0]  # type: ignore[no-any-return]


def _found(
    bearing: Bearing,
    given: Mapping[str, Any],
    problem: Problem,
    state: State,
    angles: Array,
    ended: tuple[int, str],
    cells: tuple[int, int],
) -> BearingSolution:
    """Return the solution that a state is."""
    places, force = state.places, state.reaction.force
    loads = force[..., 0]
    laminae, pressures, sizes = None, None, None
    contacts: dict[tuple[int, int], Solution] = {}
    if isinstance(problem.law, Solved):
        contacts = dict(state.reaction.contacts)
        peaks = np.zeros(loads.shape)
        sizes = problem.law.sizes()
        if bearing.rolls:
            laminae, pressures = (
                np.zeros((*loads.shape, LAMINAE)),
                np.zeros((*loads.shape, LAMINAE)),
            )
        for key, contact in contacts.items():
            peaks[key] = contact.peak_pressure
            if laminae is not None and pressures is not None:
                laminae[key], pressures[key] = binned(bearing, contact)
    elif isinstance(problem.law, Slices):
        laminae = problem.law.loads(places)
        pressures = hertz_pressures(bearing, laminae, np.full(2, STANDARD))
        peaks = pressures.max(-1)
    else:
        assert isinstance(problem.law, Hertzian)
        peaks = problem.law.pressures(loads)
    edges = np.full(loads.shape, np.nan)
    if pressures is not None:
        outer = round(EDGE * LAMINAE)
        edges = np.maximum(pressures[..., :outer].max(-1), pressures[..., -outer:].max(-1))
    kinematics = problem.kinematics
    normals = kinematics.angles(kinematics.motion @ state.ring, state.own)
    total = state.wanting + problem.loads
    kept = {key: one for key, one in contacts.items() if carrying(loads)[key]}
    notes = (
        *_implausible(bearing, given, peaks),
        *_beyond_shoulders(bearing, normals, peaks),
        *_notes(bearing, given["model"], kept),
    )
    return BearingSolution(
        bearing=bearing,
        model=given["model"],
        rotation=float(given["rotation"]),
        speed=float(given["speed"]),
        displacement=tuple(state.ring[:3].tolist()),
        tilt=tuple(state.ring[3:].tolist()),
        force=tuple(total[:3].tolist()),
        moment=tuple(total[3:].tolist()),
        angles=angles,
        approaches=places[..., 0].copy(),
        tilts=places[..., 1].copy(),
        loads=loads.copy(),
        moments=force[..., 1] * bearing.leans,
        peak_pressures=peaks,
        edge_pressures=edges,
        contact_angles=normals,
        lamina_loads=laminae,
        lamina_pressures=pressures,
        tangent=(state.tangent + state.tangent.T) / 2,
        grid_sizes=sizes,
        cells=None if sizes is None else cells,
        report=BearingReport(ended[1], ended[0], state.balance, notes),  # type: ignore[arg-type]
        _contacts=dict(contacts),
    )


def _implausible(bearing: Bearing, given: Mapping[str, Any], peaks: Array) -> Iterable[str]:
    """Yield warnings of tilts and pressures that no bearing has."""
    tilts = () if given["tilt"] is None else given["tilt"]
    steepest = max((abs(tilt) for tilt in tilts if tilt is not None), default=0.0)
    if steepest > STEEPEST and not bearing.aligns:
        yield f"tilt is a slope: 2' are 5.8e-4; {steepest:g} is far above those of bearings"
    if (peak := float(peaks.max())) > HIGHEST:
        yield (
            f"the peak pressure is {peak / 1e9:.4g} GPa: above {HIGHEST / 1e9:g} GPa, contacts "
            "are neither elastic nor small"
        )


def _beyond_shoulders(bearing: Any, normals: Array, peaks: Array) -> Iterable[str]:
    """Yield a warning where contacts of balls reach beyond the shoulders of the rings."""
    if bearing.rolls:
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


def _notes(bearing: Bearing, model: Model, contacts: Mapping[Any, Solution]) -> Iterable[str]:
    """Yield warnings: those of contacts by kind, and what the standard's contacts leave out."""
    if model == "iso16281":
        if bearing.layered:
            yield "layers are not counted: the contacts of ISO/TS 16281 are bare"
        moduli = np.array(bearing.modulus)
        if bearing.rolls and np.abs(moduli / STANDARD - 1).max() > 0.05:
            yield "moduli are not counted: the laminae of ISO/TS 16281 are those of steel"
        return
    texts: dict[str, str] = {}
    kinds: Counter[str] = Counter()
    for contact in contacts.values():
        report = contact.report
        for kind, text in zip(report.warning_kinds, report.warnings, strict=True):
            texts.setdefault(kind, text)
            kinds[kind] += 1
    for kind, number in kinds.items():
        yield f"{number} of {len(contacts)} contacts: {texts[kind]}"
