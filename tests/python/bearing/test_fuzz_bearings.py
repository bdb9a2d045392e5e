"""Random bearings of all kinds under any load are in equilibrium, or refused for a reason.

Cases that are the same in every run; ``NACRE_FUZZ`` tries many others. Kinematics, contact laws and
the possible loads are written anew here. The energy is convex, so that what fulfils them all is the
solution. Balls and barrels with a contact angle carry to one side: where that is why a load is
refused, the equilibrium on shoulders that are not there is solved and looked at.
"""

from __future__ import annotations

import math
import re
from typing import Any
from unittest.mock import patch

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

import nacre
import support
from bodies import quiet
from nacre.bearing import (
    AngularContactBall,
    BearingSolution,
    CylindricalRoller,
    DeepGrooveBall,
    SphericalRoller,
    TaperedRoller,
    rating,
)
from nacre.hertz import Ellipse
from support import assert_close

Array = npt.NDArray[np.float64]

KINDS = [CylindricalRoller, TaperedRoller, SphericalRoller, DeepGrooveBall, AngularContactBall]
seeds = st.integers(0, 2**32 - 1)
BALANCE = 1e-9
"""Tolerance of forces and moments over those of all elements: the default of `solve`."""
ROUNDING = 1e-12
"""Of positions over the pitch diameter: some 1e4 units in the last place."""


def draw_bearing(draw: np.random.Generator, kind: type[Any]) -> Any:
    """Return a bearing of a kind; sizes that it refuses are drawn again."""
    while True:
        count, diameter = int(draw.integers(2, 30)), 10 ** draw.uniform(-3, -1.4)
        sizes: dict[str, Any] = {
            "count": count,
            "diameter": diameter,
            "pitch_diameter": diameter * (draw.uniform(1.02, 1.8) / math.sin(math.pi / count) + 1),
        }
        if kind is not AngularContactBall:
            sizes["clearance"] = diameter * draw.uniform(-5e-4, 4e-3)
        if kind not in (CylindricalRoller, DeepGrooveBall):
            sizes["contact_angle"] = math.radians(draw.uniform(8, 40))
        if kind in (DeepGrooveBall, AngularContactBall):
            sizes["osculation"] = tuple(draw.uniform(0.51, 0.54, 2))
        else:
            sizes["length"] = length = diameter * draw.uniform(0.6, 3)
        if kind in (CylindricalRoller, TaperedRoller):
            crowns = length * 10 ** draw.uniform(2, 5, 2) * draw.choice([-1, 1], 2)
            sizes["raceway_crown"] = [None if draw.random() < 0.5 else c for c in crowns.tolist()]
            x = np.linspace(-0.5, 0.5, 21) * length
            drop = diameter * (1e-4 * draw.random() + 5e-4 * (x / length) ** 2)
            sizes["profile"] = draw.choice(["iso16281", None, nacre.SampledProfile(x, drop)])  # type: ignore[arg-type]
        if kind is SphericalRoller:
            wide = sizes["pitch_diameter"] / math.cos(sizes["contact_angle"]) + diameter
            sizes["profile_radius"] = wide / 2 * draw.uniform(0.9, 0.99)
            sizes["rows"] = int(draw.integers(1, 3))
        try:
            return kind(**sizes)
        except ValueError:
            continue


def draw_loads(draw: np.random.Generator, bearing: Any) -> dict[str, Any]:
    """Return loads of both signs, displacements and tilts for `solve`."""
    size = rating(bearing) * 10 ** draw.uniform(-4, -0.3)
    force = [None if draw.random() < 0.2 else float(f) for f in size * draw.normal(size=3)]
    moved = [None] * 3
    if isinstance(bearing, CylindricalRoller):
        force[2] = None
    elif isinstance(bearing, AngularContactBall | TaperedRoller) or bearing.rows == 1:
        force[2] = force[2] and abs(force[2]) if draw.random() < 0.7 else force[2]
    if force[0] is None and draw.random() < 0.5:
        moved[0] = float(draw.uniform(-2e-3, 2e-3) * bearing.diameter)  # type: ignore[call-overload]
    options: dict[str, Any] = {
        "force": force,
        "displacement": moved,
        "tilt": [float(t) for t in draw.normal(size=2) * 10 ** draw.uniform(-4, -2.7)],
        "rotation": float(draw.uniform(0, 7)),
    }
    if draw.random() < 0.4 and not bearing.aligns:
        options["moment"] = [float(m) for m in draw.normal(size=2) * size * bearing.pitch / 20]
        options["tilt"] = [None, None]
    if draw.random() < 0.5:
        options["speed"] = float(draw.uniform(-2, 2) / bearing.diameter)
        options["rotating"] = str(draw.choice(["inner", "outer"]))
    return options


class Geometry:
    """What holds in a bearing, written anew: u and ψ of rollers, the places of groove centres."""

    def __init__(self, bearing: Any, options: dict[str, Any]) -> None:
        single = options["rotation"] + 2 * math.pi * np.arange(bearing.count) / bearing.count
        self.bearing, self.angles = bearing, np.tile(single, bearing.rows)
        self.cos, self.sin = np.cos(self.angles), np.sin(self.angles)
        self.alpha = bearing.nominal_angle
        self.beta = bearing.roller_angle if isinstance(bearing, TaperedRoller) else 0.0
        self.side = np.repeat([1.0, -1.0][: bearing.rows], bearing.count)
        gamma = bearing.diameter * math.cos(self.alpha - self.beta) / bearing.pitch
        turn = -1 if options.get("rotating", "inner") == "inner" else 1
        cage = options.get("speed", 0.0) / 2 * (1 + turn * gamma)
        self.pull = bearing.mass * bearing.pitch / 2 * cage**2
        self.normal = math.cos(self.alpha - self.beta) / math.cos(self.beta)
        half_pitch, own = bearing.pitch / 2, bearing.diameter / 2
        if bearing.carries_moments:
            self.lever = half_pitch * math.sin(self.alpha) + own * math.sin(self.beta)
            return
        if bearing.aligns:
            self.grooves, self.lever = np.array(bearing.grooves) - own, 0.0
            start = self.grooves.sum() - bearing.play * math.cos(self.alpha) / 2
            self.start = start * np.array([[math.cos(self.alpha), math.sin(self.alpha)]])
            self.start = self.start * np.stack([np.ones_like(self.side), self.side], axis=1)
            return
        self.grooves = (np.array(bearing.osculation) - 0.5) * bearing.diameter
        between = self.grooves.sum()
        self.start = np.array([[between - bearing.play / 2, 0.0]])
        free = math.acos(1 - max(0.0, bearing.play) / (2 * between))
        if self.alpha:
            free = self.alpha
            self.start = between * np.array([[math.cos(free), math.sin(free)]])
        self.lever = -(half_pitch + self.grooves[0] * math.cos(free))

    def turned(self, about: Any) -> Array:
        """Return the slopes ψ at the elements."""
        psi: Array = about[1] * self.cos - about[0] * self.sin
        return psi

    def possible(self, loads: Array, free: npt.NDArray[np.bool_]) -> bool:
        """Return whether pushing contacts can balance loads, by SciPy's linear programme."""
        cos, sin = math.cos(self.alpha), math.sin(self.alpha)
        bearing, zero = self.bearing, np.zeros_like(self.cos)
        across = np.stack([self.cos, self.sin, zero, zero, zero])
        along = np.stack([zero, zero, zero + 1, -self.lever * -self.sin, -self.lever * self.cos])
        if bearing.carries_moments:
            drops = [bearing.drop(ring) for ring in ("inner", "outer")]
            ends = np.flatnonzero(np.isfinite(drops).all(axis=0))[[0, -1]]
            slope = np.stack([zero, zero, zero, -self.sin, self.cos])
            along[3:] = -self.lever * slope[3:]
            along[2] = sin
            unit = cos * across + along
            columns = [unit + ((k + 0.5) / 40 - 0.5) * bearing.length * slope for k in ends]
            thrust = self.normal * sin * self.pull * bearing.count
        elif bearing.aligns:
            along[3:] = 0.0
            columns = [cos * across + sin * self.side * along]
            thrust = cos * sin * self.pull * bearing.count * (bearing.rows == 1)
        else:
            columns = [across, along] if self.alpha else [across, along, -along]
            thrust = 0.0
        arm = np.array([1, 1, 1, bearing.pitch, bearing.pitch])
        wanted = (loads - [0, 0, thrust, 0, 0]) / arm
        matrix = np.concatenate(columns, axis=1) / arm[:, None]
        size = np.linalg.norm(wanted[free])
        if size == 0:
            return True
        found = linprog(
            np.ones(matrix.shape[1]), A_eq=matrix[free], b_eq=wanted[free] / size, method="highs"
        )
        return bool(found.status == 0)


def check_rollers(geometry: Geometry, solution: BearingSolution) -> None:
    """Compare with the equations of cylindrical and tapered rollers, and their laminae."""
    bearing: Any = geometry.bearing
    cos, sin = math.cos(geometry.alpha), math.sin(geometry.alpha)
    x, y, z = solution.displacement
    psi = geometry.turned(solution.tilt)
    moved = cos * (x * geometry.cos + y * geometry.sin) + sin * z - geometry.lever * psi
    small = ROUNDING * bearing.pitch
    assert_close(solution.approaches.sum(1), moved - bearing.play * cos / 2, atol=small)
    assert_close(solution.tilts.sum(1), psi, atol=1e-12)
    inner, moments = solution.loads[:, 0], solution.moments[:, 0]
    about = moments - geometry.lever * inner
    pull = geometry.normal * geometry.pull
    total = [
        cos * inner @ geometry.cos,
        cos * inner @ geometry.sin,
        sin * inner.sum() + sin * pull * bearing.count,
        -about @ geometry.sin,
        about @ geometry.cos,
    ]
    scale = solution.loads.sum()
    check_loads(solution, total, scale, bearing.length)
    turn = pull * bearing.diameter / 2 * math.sin(geometry.beta)
    assert_close(solution.loads[:, 1] - inner, pull, atol=BALANCE * scale)
    assert_close(solution.moments[:, 1] - moments, turn, atol=BALANCE * scale * bearing.length)
    if solution.model == "iso16281":
        lamina = np.stack([bearing.drop(ring) for ring in ("inner", "outer")])
        along = ((np.arange(40) + 0.5) / 40 - 0.5) * bearing.length
        deep = solution.approaches[..., None] + solution.tilts[..., None] * along - lamina
        spring = 35948 * (bearing.length * 1e3) ** (8 / 9) / 40
        loads = spring * (2e3 * np.maximum(deep, 0.0)) ** (10 / 9)
        assert_close(loads.sum(-1), solution.loads, rtol=1e-9, atol=1e-12 * scale)


def check_loads(solution: BearingSolution, total: Any, scale: float, arm: float) -> None:
    """Compare the loads of the ring with the sums over its elements."""
    arms = np.array([1, 1, 1, arm, arm])
    assert_close(
        np.array([*solution.force, *solution.moment]) / arms, total / arms, atol=BALANCE * scale
    )


def check_balls(geometry: Geometry, solution: BearingSolution) -> None:
    """Compare with the equations of balls and barrels between two circles, and their laws."""
    bearing: Any = geometry.bearing
    x, y, z = solution.displacement
    lean = 0.0 if bearing.aligns else -geometry.lever
    axial = z - lean * geometry.turned(solution.tilt)
    moved = np.stack([x * geometry.cos + y * geometry.sin, axial], axis=1)
    normals = np.stack([np.cos(solution.contact_angles), np.sin(solution.contact_angles)], axis=2)
    arms = (geometry.grooves + solution.approaches)[..., None] * normals
    assert_close(arms.sum(1), geometry.start + moved, atol=ROUNDING * bearing.pitch)
    forces = solution.loads[..., None] * normals
    scale = solution.loads.sum()
    pull = np.array([geometry.pull, 0.0])
    if bearing.aligns:
        cos, sin = math.cos(geometry.alpha), math.sin(geometry.alpha)
        pull = geometry.pull * np.stack(
            [np.full_like(geometry.side, cos**2), cos * sin * geometry.side], axis=1
        )
    assert_close(forces[:, 1] - forces[:, 0], pull + 0 * forces[:, 0], atol=2 * BALANCE * scale)
    across, along = forces[:, 0].T
    total = [
        across @ geometry.cos,
        across @ geometry.sin,
        along.sum(),
        lean * along @ geometry.sin,
        -lean * along @ geometry.cos,
    ]
    if bearing.rows == 1 and bearing.aligns:
        total[2] += cos * sin * geometry.pull * bearing.count
    check_loads(solution, total, scale, bearing.pitch / 2)
    if solution.model == "iso16281" and not bearing.aligns:
        for (j, r), load in np.ndenumerate(solution.loads):
            if load > 1e-9 * scale:
                (own_x, own_y), (one, other) = bearing.own_radii, bearing.radii[r]
                hertz = Ellipse(own_x, own_y, bearing.modulus[r], load, one, other)
                assert solution.approaches[j, r] == pytest.approx(hertz.approach, rel=1e-6)
            else:
                assert solution.approaches[j, r] < 1e-6 * bearing.diameter


def bears_to_one_side(geometry: Geometry, solution: BearingSolution, *, held: bool) -> bool:
    """Return whether balls and barrels bear on shoulders that exist, and the rings stay together.

    They do so where the axis is `held`.
    """
    if not geometry.alpha or geometry.bearing.carries_moments:
        return True
    carried = solution.loads[:, 0] > 1e-8 * solution.loads.max()
    angles = geometry.side * solution.contact_angles[:, 0]
    apart = not held and pushes_apart(geometry, solution.force)
    return not ((angles[carried] < 0).any() or apart)


def pushes_apart(geometry: Geometry, force: Any) -> bool:
    """Return whether a radial force pushes the rings of one row apart."""
    bearing = geometry.bearing
    if bearing.carries_moments or bearing.rows == 2 or not geometry.alpha:
        return False
    return bool(force[2] < math.hypot(force[0], force[1]) * math.tan(geometry.alpha))


def check(seed: int, kind: type[Any], **how: Any) -> str:
    """Solve a random bearing, compare, and return how it ended: in equilibrium or refused."""
    draw = np.random.default_rng(seed)
    bearing = draw_bearing(draw, kind)
    options = draw_loads(draw, bearing)
    geometry = Geometry(bearing, options)
    asked = [*options["force"], *options.get("moment", (None, None))]
    loads = np.array([load or 0.0 for load in asked])
    free = np.array([load is not None for load in asked])
    apart = free[2] and pushes_apart(geometry, loads)
    if not geometry.possible(loads, free) or apart:
        with pytest.raises(ValueError, match=r"contacts|pushes the rings apart"):
            quiet(bearing.solve, **options, **how)
        return "refused"
    try:
        solution = quiet(bearing.solve, **options, **how)
        ended = "equilibrium"
    except ValueError as refusal:
        if not re.search("the rings have no shoulder|pushes the rings apart", str(refusal)):
            raise
        with patch("nacre.bearing.solving.check_sides"):
            solution = quiet(bearing.solve, **options, **how)
        ended = "refused"
    one_sided = bears_to_one_side(geometry, solution, held=not free[2])
    assert one_sided == (ended == "equilibrium")
    assert solution.report.converged
    scale = float(solution.loads.sum())
    arm = np.array([1, 1, 1, bearing.pitch, bearing.pitch])
    given = np.array([*solution.force, *solution.moment])
    if scale > 0 or loads.any():
        assert_close((given / arm)[free], (loads / arm)[free], atol=2e-9 * scale)
    (check_rollers if bearing.carries_moments else check_balls)(geometry, solution)
    return ended


@pytest.mark.parametrize("kind", KINDS)
@support.fuzz(12)
@given(seeds)
def test_bearings_of_the_standard(kind: type[Any], seed: int) -> None:
    check(seed, kind, model="iso16281")


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@support.fuzz(1)
@given(seeds)
def test_bearings_of_solved_contacts(kind: type[Any], seed: int) -> None:
    cells = (40, 16) if kind not in (DeepGrooveBall, AngularContactBall) else (16, 16)
    check(seed, kind, cells=cells)
