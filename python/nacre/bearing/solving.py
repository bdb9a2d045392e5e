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
from nacre._tools.progress import lasting
from nacre.bearing.equilibrium import Problem, State, kinematics_of
from nacre.bearing.geometry import HIGHEST, Bearing, above
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
FINER = 0.1
"""Tolerance of the contacts over that of the bearing, which their sums inherit."""


def _asked(
    bearing: Bearing, given: Mapping[str, Any]
) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Return loads, displacements, and which of the five directions are loaded, checked."""
    values: dict[str, list[float | None]] = {}
    for name, length in (("force", 3), ("displacement", 3), ("moment", 2), ("tilt", 2)):
        values[name] = core.vector(name, length, given[name])
        if not all(value is None or math.isfinite(value) for value in values[name]):
            raise ValueError(f"{name} must be finite, got {given[name]!r}")
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
    if bearing.aligns and values["moment"] != [None, None]:
        raise ValueError(
            f"moment must be None: a spherical roller bearing aligns itself and carries none, "
            f"got {given['moment']!r}"
        )
    axial = not bearing.rolls or bearing.nominal_angle > 0
    if not axial and (loads[2] is not None or moved[2] is not None):
        name, value = ("force", loads[2]) if moved[2] is None else ("displacement", moved[2])
        raise ValueError(
            f"{name} along z must be None: rollers without a contact angle carry none, "
            f"got {value!r}"
        )
    if bearing.rolls and axial and bearing.rows == 1 and loads[2] is not None:
        pushed = math.hypot(*(loads[k] or 0.0 for k in range(2))) * math.tan(bearing.nominal_angle)
        if loads[2] < pushed:
            raise ValueError(
                f"force along z must be at least {pushed:.6g} N, by which the radial force pushes "
                f"the rings apart, got {loads[2]!r}"
            )
    free = np.array([value is not None for value in loads])
    return np.array([v or 0.0 for v in loads]), np.array([v or 0.0 for v in moved]), free


def solved(bearing: Bearing, given: Mapping[str, Any]) -> BearingSolution:
    """Return the solution of what a user asked of a bearing with these arguments of `solve`."""
    loads, moved, free = _asked(bearing, given)
    model, cells = given["model"], given["cells"]
    given = {**given}
    for name in ("rotation", "speed"):
        given[name] = above(name, given[name], -math.inf)
    for name in ("max_iterations", "threads"):
        if name == "threads" and given[name] is None:
            continue
        given[name] = core.integer(name, given[name])
        if given[name] < 1:
            raise ValueError(f"{name} must be at least 1, got {given[name]!r}")
    if model not in ("solved", "iso16281"):
        raise ValueError(f'model must be "solved" or "iso16281", got {model!r}')
    tolerance = above("tolerance", given["tolerance"])
    if tolerance >= 1:
        raise ValueError(f"tolerance must be above 0 and below 1, got {tolerance!r}")
    if cells is None:
        cells = CELLS[bearing.rolls]
    one, other = core.vector("cells", 2, cells)
    cells = core.integer("cells", one), core.integer("cells", other)
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
        if model == "solved":
            lines = _lines(bearing, problem.law, state)
            contacts = Solved(bearing, lines, cells, FINER * tolerance, given["threads"])
            problem = Problem(kinematics, contacts, loads, free, centrifugal)
            state, done, ended = problem.solve(state.ring, state.own, tolerance, limit, tell)
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
    notes = (*_implausible(bearing, given, peaks), *_notes(bearing, given["model"], kept))
    return BearingSolution(
        bearing=bearing,
        model=given["model"],
        rotation=given["rotation"],
        speed=given["speed"],
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
    steepest = max((abs(tilt) for tilt in given["tilt"] if tilt is not None), default=0.0)
    if steepest > STEEPEST and not bearing.aligns:
        yield f"tilt is a slope: 2' are 5.8e-4; {steepest:g} is far above those of bearings"
    if (peak := float(peaks.max())) > HIGHEST:
        yield (
            f"the peak pressure is {peak / 1e9:.4g} GPa: above {HIGHEST / 1e9:g} GPa, contacts "
            "are neither elastic nor small"
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
