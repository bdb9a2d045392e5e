"""Tapered rollers are in equilibrium with rings and rib, and are cylindrical ones without angle."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre.bearing import (
    BearingSolution,
    CylindricalRoller,
    LundbergPalmgren,
    TaperedRoller,
    film_thickness,
    life_ratio,
    load_integrals,
    rating,
)
from support import assert_close

SIZE: dict[str, Any] = {
    "count": 17,
    "diameter": 8e-3,
    "length": 11e-3,
    "pitch_diameter": 48e-3,
}
ANGLE = 0.25
COARSE: dict[str, Any] = {"cells": (40, 24)}
STANDARD: dict[str, Any] = {"model": "iso16281"}
BOTH = pytest.mark.parametrize(
    "options",
    [pytest.param(COARSE, marks=pytest.mark.slow), STANDARD],
    ids=["solved", "standard"],
)
Array = np.ndarray[Any, Any]


def tapered(**given: Any) -> TaperedRoller:
    return TaperedRoller(**{"contact_angle": ANGLE} | SIZE | given)


def test_cones_of_rollers_and_raceways_share_one_apex() -> None:
    bearing = tapered()
    beta = bearing.roller_angle
    # The apex on the bearing's axis, from the axis of a roller and from the line of either contact.
    middle = np.array([24e-3, 0.0])
    towards = np.array([-math.sin(ANGLE - beta), math.cos(ANGLE - beta)])
    apex = middle + 24e-3 / math.sin(ANGLE - beta) * towards
    assert abs(apex[0]) < 1e-16
    across = np.array([math.cos(ANGLE - beta), math.sin(ANGLE - beta)])
    for sign, angle in zip((-1, 1), bearing.contact_angles, strict=True):
        place = middle + sign * 4e-3 * across
        line = np.array([-math.sin(angle), math.cos(angle)])
        assert_close(place + bearing.apex * line, apex, atol=1e-15)
        # Radii normal to the line: half of the diameter of the cone over the cosine of its angle.
        radius = bearing.raceways[(sign + 1) // 2]
        assert radius == pytest.approx(place[0] / math.cos(angle), rel=1e-12)
    assert bearing.radius == pytest.approx(4e-3 / math.cos(beta), rel=1e-14)
    for ring, sign in (("inner", 1), ("outer", -1)):
        shape: Any = bearing.shape(ring)  # type: ignore[arg-type]
        race = bearing.raceways[0 if sign > 0 else 1]
        x = np.array([-5e-3, 0.0, 5e-3])
        share = 1 - x / bearing.apex
        expected = (1 / bearing.radius + sign / race) / share
        assert_close(bearing.curvature(ring, x), expected, rtol=1e-12)  # type: ignore[arg-type]
        grid = nacre.Grid((11, 2), (11e-3, 2e-5))
        across_it = shape.gaps(grid) - shape.gaps(nacre.Grid((11, 2), (11e-3, 4e-9)))
        parabola = (5e-6) ** 2 / 2 * bearing.curvature(ring, grid.x)  # type: ignore[arg-type]
        # The drop of the profile, 50 µm at the very ends, changes the roller's own radius by 1 %.
        assert_close(across_it[1:-1, 0], parabola[1:-1], rtol=3e-3, each=True)
    # A frustum: its volume by the prismoidal rule, exact for squares of a linear radius.
    radii = 4e-3 * (1 - np.array([-5.5e-3, 0.0, 5.5e-3]) / bearing.apex)
    volume = math.pi * (radii**2 @ [1, 4, 1]) / 6 * 11e-3 * math.cos(beta)
    assert bearing.mass == pytest.approx(7850 * volume, rel=1e-12)


@BOTH
@pytest.mark.parametrize("speed", [0.0, 400.0])
def test_forces_of_contacts_and_rib_balance(options: dict[str, Any], speed: float) -> None:
    bearing = tapered(clearance=5e-6)
    solution = bearing.solve(
        force=(3000.0, 500.0, 4000.0), tilt=(2e-4, 4e-4), speed=speed, **options
    )
    assert solution.report.balance <= 1e-9
    beta = bearing.roller_angle
    axis = np.array([-math.sin(ANGLE - beta), math.cos(ANGLE - beta)])
    across = np.array([axis[1], -axis[0]])
    cage = speed / 2 * (1 - 8 / 48 * math.cos(ANGLE - beta))
    pull = np.array([bearing.mass * 24e-3 * cage**2, 0.0])
    total, moments = np.zeros(3), np.zeros(2)
    scale = float(solution.loads.sum()) / 2

    def turn(at: Array, force: Array) -> float:
        return float(at[1] * force[0] - at[0] * force[1])

    for j, angle in enumerate(solution.angles):
        forces, places = [], []
        for r, sign in enumerate((-1, 1)):
            contact = bearing.contact_angles[r]
            normal = np.array([math.cos(contact), math.sin(contact)])
            line = np.array([-normal[1], normal[0]])
            load = solution.loads[j, r]
            offset = solution.moments[j, r] / load if load > 0 else 0.0
            forces.append(-sign * load * normal)
            places.append(sign * 4e-3 * across + offset * line)
        rib = -axis @ (forces[0] + forces[1] + pull) * axis
        # On the roller: what is across its axis, and moments about its middle.
        assert abs(across @ (forces[0] + forces[1] + pull)) < 2e-9 * scale
        turned = sum(turn(at, force) for at, force in zip(places, forces, strict=True))
        assert abs(turned) < 2e-9 * scale * SIZE["length"]
        # On the ring: the force of the rib acts along the axis of the roller.
        on_ring = forces[0] + rib
        around = turn(places[0] + [24e-3, 0.0], forces[0]) + turn(np.array([24e-3, 0.0]), rib)
        total += [on_ring[0] * math.cos(angle), on_ring[0] * math.sin(angle), on_ring[1]]
        moments += [-around * math.sin(angle), around * math.cos(angle)]
    assert_close(total, solution.force, atol=2e-9 * scale)
    assert_close(moments, solution.moment, atol=2e-9 * scale * 24e-3)
    assert_close(solution.force, (3000.0, 500.0, 4000.0), atol=1e-9 * scale)


@BOTH
def test_no_angle_is_a_cylindrical_roller(options: dict[str, Any]) -> None:
    asked: dict[str, Any] = {"force": (3000.0, 200.0, None), "tilt": (1e-4, 3e-4)} | options
    size = SIZE | {"clearance": 5e-6}
    flat = CylindricalRoller(**size).solve(**asked)
    same: Any = "iso16281_cylindrical"
    cone = TaperedRoller(**size, contact_angle=1e-12, profile=same).solve(**asked)
    bar = 1e-9 * flat.largest_load
    assert_close(cone.loads, flat.loads, atol=bar)
    assert_close(cone.displacement, flat.displacement, rtol=1e-9, atol=1e-15)
    assert cone.peak_pressure == pytest.approx(flat.peak_pressure, rel=1e-9)
    stiffness = flat.stiffness()
    unit = np.sqrt(np.diag(stiffness))
    unit[2] = unit[0]
    assert_close(
        cone.stiffness() / np.outer(unit, unit), stiffness / np.outer(unit, unit), atol=1e-9
    )
    assert cone.life().l10r == pytest.approx(flat.life().l10r, rel=1e-9)


@pytest.mark.slow
@BOTH
def test_rotated_and_mirrored_loads(options: dict[str, Any]) -> None:
    bearing = tapered()
    force, tilt = (3000.0, 500.0, 4000.0), (1e-4, 3e-4)
    one = bearing.solve(force=force, tilt=tilt, rotation=0.0, **options)
    bar = 1e-9 * one.largest_load
    turned = bearing.solve(force=force, tilt=tilt, rotation=2 * math.pi / 17, **options)
    assert_close(np.roll(turned.loads, 1, axis=0), one.loads, atol=bar)
    mirrored = bearing.solve(force=(3000.0, -500.0, 4000.0), tilt=(-1e-4, 3e-4), **options)
    assert_close(mirrored.loads[-np.arange(17) % 17], one.loads, atol=bar)


def test_axial_load_is_shared_and_the_play_is_taken_up() -> None:
    loads = tapered().solve(force=(0.0, 0.0, 5000.0), **STANDARD)
    assert_close(loads.loads, 5000.0 / 17 / math.sin(ANGLE), rtol=1e-9)
    loose = tapered(clearance=40e-6).solve(force=(0.0, 0.0, 5000.0), **STANDARD)
    moved = loose.displacement[2] - loads.displacement[2]
    assert moved == pytest.approx(20e-6 / math.tan(ANGLE), rel=1e-9)
    assert_close(loose.contact_angles[0], tapered().contact_angles, rtol=1e-15)


@pytest.mark.parametrize("axial", [1e-6, 10e-6, 60e-6])
def test_sjovalls_integrals_hold_for_many_rollers(axial: float) -> None:
    # J is the limit of many elements, whose sum converges faster than 1/Z².
    bearing = TaperedRoller(
        count=120,
        diameter=2e-3,
        length=4e-3,
        pitch_diameter=100e-3,
        contact_angle=ANGLE,
        profile=None,
    )
    solution = bearing.solve(displacement=(10e-6, 0.0, axial), **STANDARD)
    epsilon = 0.5 * (1 + axial * math.tan(ANGLE) / 10e-6)
    radial, along = load_integrals(epsilon, 10 / 9)
    most = 120 * solution.largest_load
    assert solution.force[0] == pytest.approx(most * math.cos(ANGLE) * radial, rel=1e-3)
    assert solution.force[2] == pytest.approx(most * math.sin(ANGLE) * along, rel=1e-3)


def test_rating_is_that_of_iso_281() -> None:
    # In mm and N, written anew; f_c is that of the table, 88.6 at γ = 0.16, of three digits.
    bearing = tapered()
    gamma = 8 * math.cos(ANGLE) / 48
    ratio = (1 - gamma) / (1 + gamma)
    factor = 0.83 * 551.13373 * 0.377 * gamma ** (2 / 9) * (1 - gamma) ** (29 / 27)
    factor /= (1 + gamma) ** 0.25
    factor *= (1 + (1.04 * ratio ** (143 / 108)) ** 4.5) ** (-2 / 9)
    assert factor == pytest.approx(88.6, rel=2e-3)
    expected = 1.1 * factor * (11 * math.cos(ANGLE)) ** (7 / 9) * 17**0.75 * 8 ** (29 / 27)
    assert rating(bearing) == pytest.approx(expected, rel=1e-12)
    life = bearing.solve(force=(0.0, 0.0, 5000.0), **STANDARD).life(edge=None)
    share = (1.038 * ratio ** (143 / 108)) ** 4.5
    inner = expected / (0.83 * 0.378 * 17 * math.cos(ANGLE)) * (1 + share) ** (2 / 9)
    outer = expected / (0.83 * 0.364 * 17 * math.cos(ANGLE)) * (1 + 1 / share) ** (2 / 9)
    assert_close(life.ring_capacities, (inner, outer), rtol=1e-12)


def test_profile_of_the_standard_is_that_of_tapered_rollers() -> None:
    # 0.00045 D ln(1/(1 − (2x/L)²)) at 0.9 of the half-length; 0.00035 D of cylindrical rollers.
    log = -math.log1p(-(0.9**2))
    for word, amplitude in (("iso16281", 0.00045), ("iso16281_cylindrical", 0.00035)):
        bearing = tapered(profile=word)
        found = bearing._profile().drop_at(0.45 * SIZE["length"])
        assert found == pytest.approx(amplitude * SIZE["diameter"] * log, rel=1e-12)
    cylinder = CylindricalRoller(**SIZE)
    other = dataclasses.replace(cylinder, profile="iso16281_cylindrical")
    np.testing.assert_array_equal(other.drop("inner"), cylinder.drop("inner"))
    with pytest.raises(ValueError, match='"iso16281", "iso16281_cylindrical" or None, got'):
        tapered(profile="iso")


def test_pressure_falls_towards_the_thick_end() -> None:
    # Straight rollers of half-spaces under a uniform line load: p ∝ R^(−1/2), less their ends.
    bearing = tapered(profile=None)
    solution = bearing.solve(force=(0.0, 0.0, 5000.0), **STANDARD)
    assert solution.lamina_loads is not None
    assert solution.lamina_pressures is not None
    line = 5000.0 / 17 / math.sin(ANGLE) / 11e-3
    assert_close(solution.lamina_loads, line * 11e-3 / 40, rtol=1e-9)
    x = (np.arange(40) + 0.5) / 40 * 11e-3 - 5.5e-3
    moduli = 210e9 / (2 * 0.91)
    radius = (1 - x / bearing.apex) / (1 / bearing.radius + 1 / bearing.raceways[0])
    hertz = np.sqrt(line * moduli / (math.pi * radius))
    assert_close(solution.lamina_pressures[0, 0], hertz, rtol=1e-9)
    solved = tapered().solve(force=(0.0, 0.0, 5000.0), cells=(120, 48))
    assert solved.lamina_pressures is not None
    factors = solved.edge_factors()[0, 0]
    # In the middle of the standard's profile laminae have Hertz's pressure; cells of b/16: 1e-3.
    # Between these laminae 1/√R changes by 1.3 %.
    assert_close(factors[14:26], 1.0, atol=5e-3)


@pytest.mark.slow
def test_lives_films_files_and_pictures(tmp_path: Path) -> None:
    light, heavy = (tapered().solve(force=(0.0, 0.0, load), **COARSE) for load in (5000.0, 10000.0))
    # L ∝ W^−4 under Hertz's line pressure; the profile spreads heavier loads farther.
    ratio = life_ratio(heavy, light, LundbergPalmgren()).ratio
    assert 1 / 16 < ratio < 1 / 9
    assert light.life().l10r > heavy.life().l10r
    assert heavy.life("pressure").l10r > 0
    contact = light.contact(3, "outer")
    assert contact is not None
    film = film_thickness(contact, speed=5.0, viscosity=0.02, pressure_viscosity=20e-9)
    # The heaviest section is near the middle, where R changes by 9 % in a mm.
    middle = 1 / (1 / light.bearing.radius - 1 / light.bearing.raceways[1])
    assert film.radius == pytest.approx(middle, rel=0.05)
    back = nacre.load(light.save(tmp_path / "tapered.nc"))
    assert isinstance(back, BearingSolution)
    assert back == light
    again = back.contact(3, "outer")
    assert again is not None
    assert again.load == pytest.approx(contact.load, rel=1e-8)
    assert light.save(tmp_path / "tapered.png").stat().st_size > 10_000


def test_a_radial_load_on_a_held_ring_makes_an_axial_one() -> None:
    held = tapered().solve(force=(1000.0, None, None), **STANDARD)
    assert held.force[2] > 255.342
