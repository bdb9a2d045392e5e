"""Pairs of bearings are in the equilibrium that a program of their equations finds, too."""

from __future__ import annotations

import dataclasses
import functools
import json
import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, root
from scipy.special import ellipe, ellipk

import nacre
from bodies import quiet
from nacre.bearing import (
    AngularContactBall,
    CylindricalRoller,
    DeepGrooveBall,
    Pair,
    PairSolution,
    SphericalRoller,
    TaperedRoller,
)
from nacre.case import Case, CaseError
from support import Capture, assert_close, command, written

Array = np.ndarray[Any, Any]
STANDARD: dict[str, Any] = {"model": "iso16281"}
EXACT: dict[str, Any] = STANDARD | {"tolerance": 1e-12}
BALL = AngularContactBall(
    count=9, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=math.radians(25)
)
OTHER_BALL = dataclasses.replace(BALL, count=11, diameter=9e-3, contact_angle=math.radians(40))
TAPERED = TaperedRoller(
    count=13, diameter=8e-3, length=11e-3, pitch_diameter=48e-3, contact_angle=0.25, clearance=8e-6
)
OTHER_TAPERED = dataclasses.replace(TAPERED, count=17, contact_angle=0.4, clearance=0.0)
SIGNS = {"O": (1, -1), "X": (-1, 1), "tandem": (1, 1)}
MODULUS = 210e9 / (2 * (1 - 0.3**2))  # of two bodies of steel


@functools.cache
def hertz_spring(bearing: AngularContactBall) -> float:
    """Force of a ball over the approach^1.5 of both rings: Johnson, eqs (4.26) and (4.28)."""
    wide, softness = bearing.pitch / math.cos(bearing.contact_angle), 0.0
    for sign, osculation in zip((1, -1), bearing.osculation, strict=True):
        along = 2 / bearing.diameter - 1 / (osculation * bearing.diameter)
        rolling = 2 / bearing.diameter + sign * 2 / (wide - sign * bearing.diameter)

        def integrals(axes: float) -> tuple[float, float, float]:
            m = 1 - axes**-2
            return m, float(ellipk(m)), float(ellipe(m))

        def excess(axes: float, ratio: float = rolling / along) -> float:
            _, k, e = integrals(axes)
            return (axes**2 * e - k) / (k - e) - ratio

        axes = brentq(excess, 1.0001, 1e3, xtol=1e-14, rtol=1e-14)
        m, k, e = integrals(axes)
        # With the smaller semi-axis b: p0 = c b, δ = c K b²/E* and W = 2/3 π c (a/b) b³.
        c = along / 2 * MODULUS * axes**2 * m / (k - e)
        spring = 2 / 3 * math.pi * c * axes * (MODULUS / (c * k)) ** 1.5
        softness += spring ** (-2 / 3)
    return float(softness**-1.5)


def roller_force(bearing: Any, u: float, slope: float) -> tuple[float, float]:
    """Force and moment of a roller between rings that approach and tilt: both contacts alike."""
    x = ((np.arange(40) + 0.5) / 40 - 0.5) * bearing.length
    drop = 0.00045 * bearing.diameter * np.log(1 / (1 - (2 * x / bearing.length) ** 2))
    play = bearing.play * math.cos(bearing.contact_angle)
    deep = np.maximum(u / 2 - play / 4 + slope / 2 * x - drop, 0.0) * 1e3
    loads = 2 ** (10 / 9) * 35948 * (bearing.length * 1e3) ** (8 / 9) / 40 * deep ** (10 / 9)
    return float(loads.sum()), float(loads @ x)


def element_force(bearing: Any, side: float, sign: int, z: float, phi: float, q: Array) -> Array:
    """Force and moment on the shaft that an element balances, about the middle of the pair.

    The ring of the bearing in the plane `side` is moved by z along its thrust before the shaft is.
    """
    alpha = bearing.contact_angle
    radial, axial = np.array([math.cos(phi), math.sin(phi), 0.0]), np.array([0.0, 0.0, sign])
    turn = np.array([q[3], q[4], 0.0])
    if not isinstance(bearing, TaperedRoller):
        # The ball lies on the line of the grooves' centres.
        offsets = [(f - 0.5) * bearing.diameter for f in bearing.osculation]
        place = (bearing.pitch / 2 + offsets[0] * math.cos(alpha)) * radial + [0.0, 0.0, side]
        line = sum(offsets) * (math.cos(alpha) * radial + math.sin(alpha) * axial) + z * axial
        moved = q[:3] + np.cross(turn, place)
        line = line + (moved @ radial) * radial + (moved @ axial) * axial
        far = float(np.linalg.norm(line))
        load = hertz_spring(bearing) * max(far - sum(offsets), 0.0) ** 1.5
        force = load * line / far
        return np.concatenate([force, np.cross(place, force)[:2]])
    # Both contacts and the rib meet on the roller's axis, D/2 sin β/sin α outside of its middle.
    normal = math.cos(alpha) * radial + math.sin(alpha) * axial
    more = bearing.diameter / 2 * math.sin(bearing.roller_angle) / math.sin(alpha)
    place = (bearing.pitch / 2 + more) * radial + [0.0, 0.0, side]
    about = sign * np.array([-math.sin(phi), math.cos(phi), 0.0])  # the axis of slopes
    u = float((q[:3] + np.cross(turn, place) + z * axial) @ normal)
    load, moment = roller_force(bearing, u, float(turn @ about))
    total = np.cross(place, load * normal) + moment * about
    return np.concatenate([load * normal, total[:2]])


def shaft_forces(pair: Pair, settings: Any, q: Array) -> Array:
    """Return forces and moments on the shaft ``(2, 5)`` that both bearings balance."""
    sides, signs = (-pair.distance / 2, pair.distance / 2), SIGNS[pair.arrangement]
    totals = []
    for one, side, sign, z in zip((pair.first, pair.second), sides, signs, settings, strict=True):
        angles = 2 * math.pi * np.arange(one.count) / one.count
        totals.append(sum(element_force(one, side, sign, z, float(phi), q) for phi in angles))
    return np.array(totals)


def settings_of(pair: Pair) -> Array:
    """How far both rings are set along their thrusts by the preload, by bisection."""
    bearings = pair.first, pair.second
    is_tapered = isinstance(pair.first, TaperedRoller)
    touching = [b.play / (2 * math.tan(b.contact_angle)) if is_tapered else 0.0 for b in bearings]
    precise: dict[str, float] = {"xtol": 1e-19, "rtol": 1e-14}

    def thrusts(one: float, other: float) -> Array:
        forces = shaft_forces(pair, (touching[0] + one, touching[1] + other), np.zeros(5))
        return np.abs(forces[:, 2])

    if pair.preload_force is None:
        both = float(pair.preload_distance or 0.0)

        def excess(one: float) -> float:
            first, second = thrusts(one, both - one)
            return float(first - second)

        one = brentq(excess, 0.0, both, **precise)
        return np.array([touching[0] + one, touching[1] + both - one])
    force = pair.preload_force
    settings = [
        brentq(lambda z, k=k: thrusts(z, z)[k] - force, 0.0, 1e-4, **precise) for k in (0, 1)
    ]
    return np.array([touching[k] + settings[k] for k in (0, 1)])


def balanced(pair: Pair, settings: Array, loads: Array) -> Array:
    """Displacements of the shaft under loads, with all five directions free."""
    arm = np.array([1.0, 1.0, 1.0, 0.02, 0.02])
    scale = float(np.abs(loads / arm).max())

    def mismatch(x: Array) -> Array:
        q = 1e-5 * x / arm
        mismatched: Array = (shaft_forces(pair, settings, q).sum(0) - loads) / arm / scale
        return mismatched

    x = root(mismatch, np.zeros(5), options={"xtol": 1e-13}).x
    for _ in range(3):  # Newton's steps on difference quotients
        steps = 1e-5 * np.eye(5)
        slopes = np.array([mismatch(x + h) - mismatch(x - h) for h in steps]).T / 2e-5
        x = x - np.linalg.solve(slopes, mismatch(x))
    assert np.abs(mismatch(x)).max() < 1e-11
    q: Array = 1e-5 * x / arm
    return q


LOADS = {
    "axial": (0.0, 0.0, 250.0, 0.0, 0.0),
    "radial": (600.0, -150.0, 0.0, 0.0, 0.0),
    "moment": (100.0, 0.0, 50.0, 4.0, -6.0),
}
PRELOADS: dict[str, dict[str, Any]] = {
    "force": {"preload_force": 300.0},
    "distance": {"preload_distance": 9e-6},
}


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("preload", PRELOADS)
@pytest.mark.parametrize("arrangement", ["O", "X"])
@pytest.mark.parametrize(
    "bearings", [(BALL, OTHER_BALL), (TAPERED, OTHER_TAPERED)], ids=["balls", "tapered"]
)
def test_a_program_of_the_equations_finds_the_same(
    bearings: Any, arrangement: Any, preload: str, load: str
) -> None:
    pair = Pair(*bearings, arrangement=arrangement, distance=70e-3, **PRELOADS[preload])
    force = np.array(LOADS[load])
    solution = quiet(pair.solve, force=force[:3], moment=force[3:], **EXACT)
    settings = settings_of(pair)
    q = balanced(pair, settings, force)
    forces = shaft_forces(pair, settings, q)
    arm = np.array([1.0, 1.0, 1.0, 0.02, 0.02])
    moved = np.array([*solution.displacement, *solution.tilt]) * arm
    # Both balance to 1e-11 of the loads, and contacts are some 10 µm deep.
    assert_close(moved, q * arm, rtol=1e-8, atol=1e-8 * np.abs(q * arm).max())
    bar = 1e-8 * np.abs(forces).max()
    parts = zip((solution.first, solution.second), SIGNS[arrangement], forces, strict=True)
    for one, sign, expected in parts:
        own = np.array([*one.force[:2], sign * one.force[2]])
        assert_close(own, expected[:3], rtol=1e-8, atol=bar)
    assert_close(solution.force, force[:3], atol=bar)
    assert_close(solution.moment, force[3:], atol=bar)


KINDS = pytest.mark.parametrize("bearing", [BALL, TAPERED], ids=["balls", "tapered"])


def pair_of(bearing: Any, arrangement: Any = "O", **given: Any) -> Pair:
    given = {"preload_force": 300.0} | given if "preload_distance" not in given else given
    return Pair(bearing, bearing, **{"arrangement": arrangement, "distance": 60e-3} | given)


@KINDS
@pytest.mark.parametrize("arrangement", ["O", "X"])
@pytest.mark.parametrize(
    "options", [EXACT, {"cells": (40, 16), "threads": 1}], ids=["standard", "solved"]
)
def test_without_load_both_carry_the_preload(
    bearing: Any, arrangement: Any, options: dict[str, Any]
) -> None:
    few = dataclasses.replace(bearing, count=3)
    solution = quiet(pair_of(few, arrangement).solve, force=(0.0, 0.0, 0.0), **options)
    # The tolerance of the balance, of the loads of the elements.
    bar = 1e-9 * float(solution.first.loads.sum())
    for one in (solution.first, solution.second):
        assert_close(one.force, (0.0, 0.0, 300.0), atol=bar)
    assert_close(solution.force, 0.0, atol=bar)
    assert_close(solution.displacement, 0.0, atol=1e-9 * 5e-6)


@KINDS
def test_each_bearing_alone_has_the_same_loads(bearing: Any) -> None:
    pair = pair_of(bearing, "O", preload_distance=10e-6)
    together = pair.solve(force=(500.0, 100.0, 200.0), moment=(3.0, -2.0), rotation=0.1, **EXACT)
    total = np.zeros(5)
    for one, side in ((together.first, -30e-3), (together.second, 30e-3)):
        alone = bearing.solve(
            displacement=one.displacement, tilt=one.tilt, rotation=0.1, speed=0.0, **EXACT
        )
        bar = 1e-10 * alone.largest_load
        assert_close(alone.loads, one.loads, atol=bar)
        assert_close(alone.force, one.force, atol=bar)
        assert_close(alone.stiffness(), one.stiffness(), rtol=1e-6, atol=1e-3)
        sign = -np.sign(side)  # "O": the first one carries the thrust along z
        force = np.array([*one.force[:2], sign * one.force[2]])
        about = sign * np.array([*one.moment, 0.0]) + np.cross([0.0, 0.0, side], force)
        total += [*force, *about[:2]]
    expected = [*together.force, *together.moment]
    assert_close(total, expected, rtol=1e-9, atol=1e-9 * 500.0)


@KINDS
def test_an_x_pair_is_an_o_pair_whose_levers_are_the_other_way(bearing: Any) -> None:
    # Swapped bearings a distance -d apart are the other arrangement; of one mirrored along z, the
    # thrust and the moments change their signs, and the bearings their places.
    unlike = dataclasses.replace(bearing, count=bearing.count - 2)
    one = Pair(bearing, unlike, arrangement="O", distance=60e-3, preload_force=300.0)
    mirrored = Pair(unlike, bearing, arrangement="O", distance=60e-3, preload_force=300.0)
    a = one.solve(force=(400.0, 50.0, 150.0), moment=(2.0, -5.0), **EXACT)
    b = mirrored.solve(force=(400.0, 50.0, -150.0), moment=(-2.0, 5.0), **EXACT)
    bar = 1e-9 * a.largest_load
    assert_close(a.first.loads, b.second.loads, atol=bar)
    assert_close(a.second.loads, b.first.loads, atol=bar)
    mirror = np.diag([1, 1, -1, -1, -1])
    unit = np.sqrt(np.diag(a.stiffness()))
    difference = (a.stiffness() - mirror @ b.stiffness() @ mirror) / np.outer(unit, unit)
    assert_close(difference, 0.0, atol=1e-7)
    # Face to face, without a moment about the middle, a radial load divides alike.
    faces = dataclasses.replace(one, arrangement="X")
    o, x = (p.solve(force=(300.0, 0.0, 0.0), tilt=(0.0, 0.0), **EXACT) for p in (one, faces))
    assert_close(x.first.loads, o.first.loads, atol=bar)
    assert_close(x.second.loads, o.second.loads, atol=bar)


@KINDS
@pytest.mark.parametrize("arrangement", ["O", "X", "tandem"])
def test_stiffness_is_the_derivative_of_the_forces(bearing: Any, arrangement: Any) -> None:
    # Straight rollers, all of whose laminae stay in contact: one that opens has no derivative.
    preload = 400.0
    if isinstance(bearing, TaperedRoller):
        bearing, preload = dataclasses.replace(bearing, profile=None), 4000.0
    pair = pair_of(bearing, arrangement, preload_force=None if arrangement == "tandem" else preload)
    base: Any = np.array([0.4e-6, -0.2e-6, 0.5e-6, 5e-6, -8e-6])
    if arrangement == "tandem":
        base[2] += 15e-6
    rigid = pair.solve(displacement=base[:3], tilt=base[3:], **EXACT).stiffness()
    assert np.array_equal(rigid, rigid.T)
    arm = np.array([1.0, 1.0, 1.0, 0.03, 0.03])
    columns = []
    for k in range(5):
        step = 4e-9 * np.eye(5)[k] / arm
        ends = [
            pair.solve(displacement=q[:3], tilt=q[3:], **EXACT) for q in (base - step, base + step)
        ]
        less, more = (np.array([*end.force, *end.moment]) for end in ends)
        columns.append((more - less) / (8e-9 / arm[k]))
    # Deflections are some µm: the error of second order is (step/deflection)²/24, and 4e-7.
    errors = (np.array(columns).T - rigid) / np.outer(arm, arm)
    assert np.abs(errors).max() < 1e-6 * np.abs(rigid / np.outer(arm, arm)).max()
    np.testing.assert_array_less(0.0, np.linalg.eigvalsh(rigid / np.outer(arm, arm)))


def test_stiffness_and_loss_of_contact_are_those_of_textbooks() -> None:
    # With a small preload the contact angle stays, F = K δ^1.5 of each: F_a = F_v [(1+x)^1.5 −
    # (1−x)^1.5]. The stiffness is twice that of one, and at x = 1 F_a = 2^1.5 F_v.
    preload = 0.5
    pair = pair_of(BALL, "O", preload_force=preload)
    alone = BALL.solve(force=(None, None, preload), **EXACT).stiffness()
    free = pair.solve(force=(0.0, 0.0, 0.0), **EXACT).stiffness()
    assert free[2, 2] == pytest.approx(2 * alone[2, 2], rel=1e-8)
    assert free[0, 0] == pytest.approx(2 * alone[0, 0], rel=1e-8)
    # Deflections are 0.1 µm, the grooves' centres 0.5 mm apart: angles change by some 1e-4.
    for share, loaded in ((0.998, 9), (1.002, 0)):
        pressed = pair.solve(force=(0.0, 0.0, share * 2**1.5 * preload), **EXACT)
        assert pressed.second.loaded == loaded
        assert pressed.first.loaded == 9
    x = 0.5
    load = preload * ((1 + x) ** 1.5 - (1 - x) ** 1.5)
    half = pair.solve(force=(0.0, 0.0, load), **EXACT)
    assert half.first.force[2] == pytest.approx(preload * 1.5**1.5, rel=1e-3)
    start = BALL.solve(force=(None, None, preload), **EXACT).displacement[2]
    assert half.displacement[2] == pytest.approx(x * start, rel=1e-3)


def test_the_lever_of_a_tilt_is_that_of_the_pressure_centres() -> None:
    # Lines of contact meet the axis at the pressure centres, about which a bearing carries no
    # moment: K_θ = 2 k_r a², with a = d/2 ± r tan α, r the radius of the grooves' centres.
    r = BALL.pitch / 2 + 0.02 * BALL.diameter * math.cos(BALL.contact_angle)
    alone = BALL.solve(force=(None, None, 0.5), **EXACT).stiffness()
    tilts = []
    for arrangement, way in (("O", 1), ("X", -1)):
        pair = pair_of(BALL, arrangement, preload_force=0.5)
        stiffness = pair.solve(force=(0.0, 0.0, 0.0), **EXACT).stiffness()
        lever = 30e-3 + way * r * math.tan(BALL.contact_angle)
        # Contacts turn under their loads: some δ over the distance of the grooves, 2e-4.
        assert stiffness[3, 3] == pytest.approx(2 * alone[0, 0] * lever**2, rel=2e-3)
        tilts.append(stiffness[3, 3])
    assert tilts[0] > 3 * tilts[1]


def test_play_is_a_preload_below_zero() -> None:
    # Both rings touch after half of the play to either side.
    pair = pair_of(TAPERED, "X", preload_distance=-10e-6)
    assert quiet(pair.solve, force=(0.0, 0.0, 0.0), **STANDARD).largest_load == 0.0
    pushed = pair.solve(force=(0.0, 0.0, 2000.0), **EXACT)
    alone = TAPERED.solve(force=(None, None, 2000.0), **EXACT)
    touching = 8e-6 / (2 * math.tan(0.25))
    assert pushed.displacement[2] == pytest.approx(
        alone.displacement[2] - touching + 5e-6, rel=1e-8
    )
    assert pushed.first.loaded == 0
    assert pushed.second.force[2] == pytest.approx(2000.0, rel=1e-9)


@KINDS
def test_in_tandem_both_carry_half(bearing: Any) -> None:
    pair = Pair(bearing, bearing, arrangement="tandem", distance=20e-3)
    solution = pair.solve(force=(0.0, 0.0, 1000.0), **EXACT)
    alone = bearing.solve(force=(None, None, 500.0), **EXACT)
    assert_close(solution.first.loads, alone.loads, rtol=1e-9)
    assert_close(solution.second.loads, alone.loads, rtol=1e-9)


@KINDS
def test_at_speed_centrifugal_forces_balance(bearing: Any) -> None:
    unlike = dataclasses.replace(bearing, count=bearing.count - 2)
    pair = Pair(bearing, unlike, arrangement="O", distance=60e-3, preload_force=300.0)
    spinning = pair.solve(force=(300.0, 0.0, 0.0), moment=(0.0, 0.0), speed=1500.0, **EXACT)
    for one in (spinning.first, spinning.second):
        alone = one.bearing.solve(  # type: ignore[attr-defined]
            displacement=one.displacement, tilt=one.tilt, speed=1500.0, **EXACT
        )
        assert_close(alone.loads, one.loads, atol=1e-9 * one.largest_load)
        assert_close(alone.force, one.force, atol=1e-9 * one.largest_load)
    # On the shaft: also what elements at speed push the rings along the axis.
    thrusts = spinning.first.force[2], spinning.second.force[2]
    assert thrusts[0] == pytest.approx(thrusts[1], rel=1e-9)
    assert abs(thrusts[0] - 300.0) > 3.0


def test_lives_of_both_together() -> None:
    for bearing, slope in ((BALL, 10 / 9), (TAPERED, 9 / 8)):
        solution = pair_of(bearing).solve(
            force=(900.0, 0.0, 500.0), moment=(0.0, 0.0), rotating="outer", **STANDARD
        )
        life = solution.life()
        lives = [
            one.life(rotating="outer").revolutions for one in (solution.first, solution.second)
        ]
        assert [life.first, life.second] == lives
        # A tenth fails: Σ (L/L_k)^e = 1.
        assert sum((life.revolutions / one) ** slope for one in lives) == pytest.approx(
            1, rel=1e-12
        )
        assert life != solution.life(rotating="inner")
    idle = pair_of(BALL, preload_force=0.0).solve(force=(0.0, 0.0, 500.0), **STANDARD).life()
    assert idle.second == math.inf
    assert idle.revolutions == pytest.approx(idle.first, rel=1e-12)
    assert "infinite: no element is loaded" in str(idle)


def test_pairs_are_printed_kept_and_warned_of(tmp_path: Path) -> None:
    pair = Pair(BALL, OTHER_BALL, arrangement="X", distance=40e-3, preload_distance=5e-6)
    with pytest.warns(nacre.NacreWarning, match="^first bearing: contacts with the"):
        solution = pair.solve(force=(0.0, 0.0, -60e3), moment=(0.0, 0.0), **STANDARD)
    assert any(text.startswith("first bearing: ") for text in solution.report.warnings)
    assert not any(text.startswith("second bearing: ") for text in solution.report.warnings)
    text = str(solution)
    assert "warning: first bearing: " in text
    assert "0 of 11 loaded" in text
    assert "first bearing" in solution._repr_html_()
    assert "converged" in repr(solution)
    for back in (
        nacre.load(solution.save(tmp_path / "pair.nc")),
        pickle.loads(pickle.dumps(solution)),
        PairSolution.from_dict(solution.to_dict()),
    ):
        assert back == solution
        assert back.pair == pair
    life = solution.life()
    assert nacre.load(life.save(tmp_path / "life.nc")) == life
    rows = solution.save(tmp_path / "pair.csv").read_text().splitlines()
    assert sum(row.startswith("first,") for row in rows) == BALL.count
    assert sum(row.startswith("second,") for row in rows) == OTHER_BALL.count
    fields = solution.to_xarray()
    np.testing.assert_array_equal(fields["second_loads"], solution.second.loads)
    assert fields["first_loads"].units == "N"
    np.testing.assert_array_equal(fields["force"], solution.force)
    damaged = solution.to_dict() | {"tilt": [0.0]}
    with pytest.raises(ValueError, match="must have 3, 2, 3 and 2 numbers"):
        PairSolution.from_dict(damaged)


OUTSIDE: dict[str, tuple[dict[str, Any], str]] = {
    "no thrust alone": ({"first": CylindricalRoller(count=14, diameter=10e-3, length=9.6e-3,
        pitch_diameter=65e-3)}, "first must be an AngularContactBall or a TaperedRoller"),
    "both ways": ({"second": DeepGrooveBall(count=7, diameter=8e-3, pitch_diameter=39e-3)},
        "second must be an AngularContactBall or a TaperedRoller"),
    "rows": ({"first": SphericalRoller(count=19, diameter=12e-3, length=11e-3, pitch_diameter=82e-3,
        contact_angle=0.17, profile_radius=46.5e-3)}, "first must be an AngularContactBall"),
    "kinds": ({"second": TAPERED}, "second must be of the kind of first, AngularContactBall"),
    "arrangement": ({"arrangement": "V"}, r"O. .back to back, DB.*got 'V'"),
    "distance": ({"distance": 0.0}, "distance must be finite and above 0"),
    "millimetres": ({"distance": 60.0}, "distance must be at most 4.6 m"),
    "words": ({"distance": "wide"}, "distance must be"),
    "both": ({"preload_force": 1.0, "preload_distance": 1e-6}, "must not both be given"),
    "tandem": ({"arrangement": "tandem", "preload_force": 1.0}, "preload_force must be None in"),
    "pull": ({"preload_force": -1.0}, "preload_force must be from 0 to"),
    "far": ({"preload_distance": 5e-3}, "preload_distance must be at most 0.00111 m"),
    "nan": ({"preload_distance": math.nan}, "preload_distance must be"),
}  # fmt: skip


@pytest.mark.parametrize("name", OUTSIDE)
def test_pairs_outside_of_the_model_are_refused(name: str) -> None:
    given, message = OUTSIDE[name]
    arguments: dict[str, Any] = {"arrangement": "O", "distance": 60e-3} | given
    bearings = [arguments.pop(key, BALL) for key in ("first", "second")]
    with pytest.raises((TypeError, ValueError), match=message):
        Pair(*bearings, **arguments)


def test_loads_without_equilibrium_are_refused() -> None:
    tandem = Pair(BALL, BALL, arrangement="tandem", distance=20e-3)
    with pytest.raises(ValueError, match="force along z must be at least"):
        tandem.solve(force=(100.0, 0.0, -10.0), moment=(0.0, 0.0), **STANDARD)
    with pytest.raises(ValueError, match="by which the radial forces push the rings apart"):
        tandem.solve(force=(100.0, 0.0, 30.0), moment=(0.0, 0.0), **STANDARD)
    apart = pair_of(dataclasses.replace(BALL, contact_angle=0.1), preload_force=1.0)
    with pytest.raises(ValueError, match="preload or thrust of the second bearing must be larger"):
        apart.solve(displacement=(60e-6, 0.0, 80e-6), **STANDARD)
    with pytest.raises(ValueError, match="force and displacement must not both be given along x"):
        pair_of(BALL).solve(force=(1.0, None, None), displacement=(1e-6, None, None))
    with pytest.raises(ValueError, match="moment must be at most"):
        pair_of(BALL).solve(moment=(1e12, 0.0))
    with pytest.raises(ValueError, match='model must be "solved" or "iso16281"'):
        pair_of(BALL).solve(model="iso")  # type: ignore[arg-type]
    unfinished = pair_of(BALL).solve(
        force=(500.0, 0.0, 0.0), progress=lambda *_: False, check=False, **STANDARD
    )
    assert unfinished.report.termination == "stopped"
    with pytest.raises(nacre.ConvergenceError, match="raise max_iterations") as error:
        pair_of(BALL).solve(
            force=(5000.0, 0.0, 0.0), moment=(9.0, 0.0), max_iterations=1, **STANDARD
        )
    assert isinstance(error.value.solution, PairSolution)


CASE = """
units = "N-mm-MPa"

[bearing]
kind = "pair"
arrangement = "X"
distance = 50
preload_distance = 0.01

[bearing.first]
kind = "tapered_roller"
count = 17
diameter = 8
length = 11
pitch_diameter = 48
contact_angle = 0.25

[bearing.second]
kind = "tapered_roller"
count = 18
diameter = 8
length = 11
pitch_diameter = 50
contact_angle = 0.25

[bearing.solve]
force = { x = 4000, y = 0, z = 500 }
moment = { x = 0, y = 2000 }
model = "iso16281"

[bearing.life]
speed = 100
"""


def test_a_case_file_describes_a_pair(tmp_path: Path, capsys: Capture) -> None:
    sizes: dict[str, Any] = {"diameter": 8e-3, "length": 11e-3, "contact_angle": 0.25}
    first = TaperedRoller(count=17, pitch_diameter=48e-3, **sizes)
    second = TaperedRoller(count=18, pitch_diameter=50e-3, **sizes)
    pair = Pair(first, second, arrangement="X", distance=50e-3, preload_distance=10e-6)
    load: dict[str, Any] = {"force": (4000.0, 0.0, 500.0), "moment": (0.0, 2.0)}
    solution = quiet(pair.solve, **load, model="iso16281")
    path = written(tmp_path, CASE)
    assert Case.read(path).arguments()["bearing"] == pair
    assert command("solve", str(path), "--json") == 0
    numbers = json.loads(capsys.readouterr().out)
    lengths = {"displacement": 1e-3, "force": 1.0, "moment": 1e-3}
    for name, unit in lengths.items():
        expected = np.array(getattr(solution, name)) / unit
        assert_close(numbers[name], expected, rtol=1e-9, atol=1e-9)
    peak = solution.second.peak_pressures / 1e6
    assert_close(numbers["second"]["peak_pressures"], peak, rtol=1e-9)
    stiffness = solution.stiffness()
    assert numbers["tangent"][2][2] == pytest.approx(stiffness[2, 2] / 1e3, rel=1e-9)
    assert numbers["tangent"][4][4] == pytest.approx(stiffness[4, 4] * 1e3, rel=1e-9)
    assert numbers["life"]["hours"] == pytest.approx(solution.life(speed=100.0).hours, rel=1e-9)
    rated = solution.life(speed=100.0).verdict()
    assert numbers["verdict"]["bearing"]["words"] == numbers["verdict"]["life"]["words"]
    assert numbers["verdict"]["bearing"]["words"] == rated.words


def test_the_second_bearing_of_a_case_is_like_the_first(tmp_path: Path) -> None:
    single = CASE.partition("[bearing.second]")[0] + CASE[CASE.index("[bearing.solve]") :]
    pair = Case.read(written(tmp_path, single)).arguments()["bearing"]
    assert pair.second == pair.first
    wrong = CASE.replace("count = 18", "count = 1")
    with pytest.raises(CaseError, match=r"bearing\.second: count must be"):
        Case.read(written(tmp_path, wrong)).arguments()
    wrong = CASE.replace("distance = 50\n", "distance = -50\n")
    with pytest.raises(CaseError, match="bearing: distance must be"):
        Case.read(written(tmp_path, wrong)).arguments()
    film = CASE + "\n[bearing.film]\nspeed = 1\nviscosity = 1e-8\npressure_viscosity = 0.02\n"
    with pytest.raises(CaseError, match="film"):
        Case.read(written(tmp_path, film))


def test_the_verdict_of_a_pair_is_that_of_its_worse_bearing() -> None:
    heavy: dict[str, Any] = {"force": (0.0, 0.0, 80e3), "moment": (0.0, 0.0)}
    pair = Pair(BALL, OTHER_BALL, arrangement="O", distance=30e-3, preload_force=200.0)
    solution = quiet(pair.solve, **heavy, model="iso16281")
    singles = dict(zip(("first", "second"), solution.bearings, strict=True))
    assert {one.verdict().level for one in singles.values()} == {"bad", "unknown"}
    verdict = solution.verdict()
    worse = max(singles, key=lambda name: singles[name].peak_pressure)
    assert verdict.level == "bad"
    assert verdict.decided_by == f"peak pressure of the {worse} bearing"
    assert verdict.factor == singles[worse].verdict().factor
    own = singles[worse].verdict().words
    assert verdict.words == own.replace("pressure", f"pressure of the {worse} bearing", 1)
    assert str(solution).startswith(verdict.words)
    light = quiet(pair.solve, force=(500.0, 0.0, 0.0), moment=(0.0, 0.0), model="iso16281")
    factors = [one.verdict().factor or math.inf for one in light.bearings]
    assert light.verdict().factor == min(factors)
    # The life of both comes first, which is shorter than that of either.
    assert light.verdict().words == light.life().verdict().words
    assert light.life().revolutions < min(one.life().revolutions for one in light.bearings)
