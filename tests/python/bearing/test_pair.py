"""Pairs of bearings are in the equilibrium that a program of their equations finds, too."""

from __future__ import annotations

import dataclasses
import functools
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
    """Force of a ball between both rings over their approach^1.5: Johnson, eqs (4.26) and (4.28)."""
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
    return softness**-1.5


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
    if not bearing.rolls:
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
    load, moment = roller_force(
        bearing, (q[:3] + np.cross(turn, place) + z * axial) @ normal, turn @ about
    )
    total = np.cross(place, load * normal) + moment * about
    return np.concatenate([load * normal, total[:2]])


def shaft_forces(pair: Pair, settings: Any, q: Array) -> Array:
    """Forces and moments on the shaft ``(2, 5)`` that both bearings balance."""
    sides, signs = (-pair.distance / 2, pair.distance / 2), SIGNS[pair.arrangement]
    totals = []
    for one, side, sign, z in zip((pair.first, pair.second), sides, signs, settings, strict=True):
        angles = 2 * math.pi * np.arange(one.count) / one.count
        totals.append(sum(element_force(one, side, sign, z, float(phi), q) for phi in angles))
    return np.array(totals)


def settings_of(pair: Pair) -> Array:
    """How far both rings are set along their thrusts by the preload, by bisection."""
    bearings = pair.first, pair.second
    touching = [b.play / (2 * math.tan(b.contact_angle)) if b.rolls else 0.0 for b in bearings]
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
    settings = [brentq(lambda z, k=k: thrusts(z, z)[k] - force, 0.0, 1e-4, **precise) for k in (0, 1)]
    return np.array(touching) + settings


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
    return 1e-5 * x / arm


LOADS = {
    "axial": (0.0, 0.0, 250.0, 0.0, 0.0),
    "radial": (600.0, -150.0, 0.0, 0.0, 0.0),
    "moment": (100.0, 0.0, 50.0, 4.0, -6.0),
}
PRELOADS: dict[str, dict[str, float]] = {
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
    np.testing.assert_allclose(moved, q * arm, rtol=1e-8, atol=1e-8 * np.abs(q * arm).max())
    bar = 1e-8 * np.abs(forces).max()
    parts = zip((solution.first, solution.second), SIGNS[arrangement], forces, strict=True)
    for one, sign, expected in parts:
        own = np.array([*one.force[:2], sign * one.force[2]])
        np.testing.assert_allclose(own, expected[:3], rtol=1e-8, atol=bar)
    np.testing.assert_allclose(solution.force, force[:3], atol=bar)
    np.testing.assert_allclose(solution.moment, force[3:], atol=bar)
