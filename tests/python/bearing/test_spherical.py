"""Spherical rollers align themselves, and carry what barrels in groove and sphere carry."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import quiet
from nacre import plot
from nacre.bearing import (
    BearingSolution,
    CylindricalRoller,
    LundbergPalmgren,
    SphericalRoller,
    film_thickness,
    life_ratio,
    rating,
)
from nacre.bearing.contact_laws import Solved, binned
from nacre.bearing.equilibrium import Barrels
from nacre.bearing.iso import reference_life
from support import assert_close

SIZE: dict[str, Any] = {
    "count": 19,
    "diameter": 12e-3,
    "length": 11e-3,
    "pitch_diameter": 82e-3,
    "profile_radius": 46.5e-3,
}
ANGLE = 0.17
FORCE = (20e3, 1e3, 2e3)
COARSE: dict[str, Any] = {"cells": (40, 12)}
STANDARD: dict[str, Any] = {"model": "iso16281"}
BOTH = pytest.mark.parametrize(
    "options",
    [pytest.param(COARSE, marks=pytest.mark.slow), STANDARD],
    ids=["solved", "standard"],
)
Array = np.ndarray[Any, Any]


def spherical(**given: Any) -> SphericalRoller:
    return SphericalRoller(**{"contact_angle": ANGLE} | SIZE | given)


@BOTH
def test_forces_balance_and_pass_through_the_centre(options: dict[str, Any]) -> None:
    bearing = spherical(clearance=10e-6)
    solution = quiet(bearing.solve, force=FORCE, **options)
    assert solution.report.balance <= 1e-9
    scale = float(solution.loads.sum()) / 2
    normals, angles = solution.contact_angles, solution.angles
    assert_close(normals[:, 0], normals[:, 1], atol=1e-6)
    for ring in range(2):
        load, normal = solution.loads[:, ring], normals[:, ring]
        total = [
            load @ (np.cos(normal) * np.cos(angles)),
            load @ (np.cos(normal) * np.sin(angles)),
            load @ np.sin(normal),
        ]
        assert_close(total, FORCE, atol=2e-9 * scale)
    assert solution.moment == (0.0, 0.0)
    assert not solution.moments.any()
    assert not solution.tilts.any()


def test_tilt_about_the_centre_is_followed() -> None:
    bearing = spherical()
    level = bearing.solve(force=FORCE, **STANDARD)
    tilted = bearing.solve(force=FORCE, tilt=(0.01, 0.03), **STANDARD)
    np.testing.assert_array_equal(tilted.loads, level.loads)
    assert not tilted.stiffness()[3:].any()
    # In space: the ring, its rollers and its axes turn about the centre by any angle. The centre of
    # the circle of each groove keeps its distance from that of the sphere, where the sum of the
    # radii, less that of both approaches, is.
    turn = 0.05
    about_x = np.array(
        [
            [1.0, 0.0, 0.0],
            [0.0, math.cos(turn), -math.sin(turn)],
            [0.0, math.sin(turn), math.cos(turn)],
        ]
    )
    between = sum(bearing.grooves) - bearing.diameter
    side = np.repeat([1.0, -1.0], 19)
    centres = between * np.stack(
        [
            math.cos(ANGLE) * np.cos(tilted.angles),
            math.cos(ANGLE) * np.sin(tilted.angles),
            math.sin(ANGLE) * side,
        ],
        axis=-1,
    )
    moved = (centres + np.array(tilted.displacement)) @ about_x.T
    both = np.linalg.norm(moved, axis=1) - between
    # What is along the track counts in space, and not in the plane of the axis: δ²/2 over the sum.
    bar = float(np.sum(np.square(tilted.displacement))) / (2 * between)
    loaded = tilted.loads[:, 0] > 0
    assert_close(tilted.approaches.sum(1)[loaded], both[loaded], atol=bar)
    assert bar < 1e-3 * both.max()


@pytest.mark.slow
@BOTH
def test_rotated_and_mirrored_loads(options: dict[str, Any]) -> None:
    bearing = spherical()
    one = quiet(bearing.solve, force=FORCE, **options)
    bar = 1e-9 * one.largest_load
    turned = quiet(bearing.solve, force=FORCE, rotation=2 * math.pi / 19, **options)
    rolled = np.roll(turned.loads.reshape(2, 19, 2), 1, axis=1).reshape(-1, 2)
    assert_close(rolled, one.loads, atol=bar)
    other = quiet(bearing.solve, force=(20e3, 1e3, -2e3), **options)
    assert_close(np.roll(other.loads, 19, axis=0), one.loads, atol=bar)
    across = quiet(bearing.solve, force=(20e3, -1e3, 2e3), **options)
    back = np.r_[-np.arange(19) % 19, 19 + -np.arange(19) % 19]
    assert_close(across.loads[back], one.loads, atol=bar)


def test_radial_load_is_shared_by_both_rows() -> None:
    solution = spherical().solve(force=(20e3, 0.0, 0.0), **STANDARD)
    assert_close(solution.loads[:19], solution.loads[19:], rtol=1e-9)
    assert abs(solution.displacement[2]) < 1e-12
    assert solution.stiffness()[2, 2] > 0
    axial = spherical().solve(force=(0.0, 0.0, 5e3), **STANDARD)
    assert not axial.loads[19:].any()
    share = 5e3 / 19 / np.sin(axial.contact_angles[:19])
    assert_close(axial.loads[:19], share, rtol=1e-9)


def test_clearance_is_that_of_the_radius() -> None:
    tight, loose = (
        spherical(count=18, clearance=s).solve(force=(20e3, 0.0, 0.0), rotation=0.0, **STANDARD)
        for s in (0.0, 1e-9)
    )
    # Of the roller at the load the play goes first, and half of the diametral one. The others lose
    # the same, whatever their angle, so that it is a little more.
    change = loose.displacement[0] - tight.displacement[0]
    assert 0.5e-9 < change < 0.7e-9


def test_half_of_the_diametral_clearance_brings_a_barrel_to_both_rings() -> None:
    # Along the radius, whatever the contact angle: what it leaves is of second order in it.
    bearing = spherical(contact_angle=0.3, clearance=1e-6)
    barrels = Barrels(bearing, np.zeros(38))
    apart = np.linalg.norm(barrels.start + np.array([0.5e-6, 0.0]), axis=1) - barrels.groove.sum()
    assert_close(apart, 0.0, atol=1e-11)


@pytest.mark.slow
def test_barrel_row_is_a_cylindrical_one_with_the_drop_of_the_barrel() -> None:
    row = SphericalRoller(**SIZE, contact_angle=0.0, rows=1)
    x = np.linspace(-5.5e-3, 5.5e-3, 201)
    sphere = 41e-3 + 6e-3
    net = (46.5e-3 - np.sqrt(46.5e-3**2 - x**2)) - (sphere - np.sqrt(sphere**2 - x**2))
    size = {name: value for name, value in SIZE.items() if name != "profile_radius"}
    flat = CylindricalRoller(**size, profile=nacre.SampledProfile(x, net))
    found, expected = (
        bearing.solve(force=(10e3, 500.0, None), **STANDARD) for bearing in (row, flat)
    )
    # Displacements are those of a circle about the groove's centre: δ²/2 over 82 mm.
    bar = expected.largest_load
    assert_close(found.loads, expected.loads, atol=2e-4 * bar)
    solved, other = (
        quiet(bearing.solve, force=(10e3, 500.0, None), **COARSE) for bearing in (row, flat)
    )
    # Solved barrels are thinner at their ends, by 0.33 mm of 6, too.
    assert_close(solved.loads, other.loads, atol=0.01 * bar)
    with pytest.raises(
        ValueError, match="force along z must be None or 0: rollers without a contact"
    ):
        row.solve(force=(1.0, None, 1.0))


def test_gap_is_that_of_barrel_and_sphere() -> None:
    bearing = spherical()
    radius = 41e-3 / math.cos(ANGLE) + 6e-3
    assert bearing.grooves == pytest.approx((radius, radius), rel=1e-14)
    grid = nacre.Grid((110, 2), (11e-3, 6e-4))
    x, y = grid.x[:, None], grid.y
    own = 6e-3 - (46.5e-3 - np.sqrt(46.5e-3**2 - x**2))
    # Heights above the axis of the roller, of the sphere and of the barrel.
    sphere = np.sqrt(radius**2 - x**2 - y**2) - (radius - 6e-3)
    exact = sphere - np.sqrt(own**2 - y**2)
    # The sphere's sections at x have the radius √(R² − x²), not R: 0.6 % of a seventh.
    assert_close(bearing.shape("outer").gaps(grid), exact, rtol=1e-3, atol=2e-9)
    # On the way to the middle of the cells: drop and curvature are those of the shape.
    fine = nacre.Grid((40, 2), (11e-3, 2e-5))
    across = bearing.curvature("inner", fine.x)[:, None] * fine.y**2 / 2
    parabola = bearing.drop("inner")[:, None] + across
    # Means over cells of 0.28 mm: (dx²/24)(1/R_p − 1/R) = 2e-9 m.
    assert_close(bearing.shape("inner").gaps(fine), parabola, atol=3e-9)
    tight = spherical(groove_radius=47e-3)
    assert tight.drop("inner")[0] < bearing.drop("inner")[0]
    np.testing.assert_array_equal(tight.drop("outer"), bearing.drop("outer"))
    points, weights = np.polynomial.legendre.leggauss(20)
    radii = 6e-3 - (46.5e-3 - np.sqrt(46.5e-3**2 - (5.5e-3 * points) ** 2))
    mass = 7850 * math.pi * (weights @ radii**2) * 5.5e-3
    assert bearing.mass == pytest.approx(mass, rel=1e-11)


def test_centrifugal_force_is_shared_with_the_ribs() -> None:
    bearing = spherical(rows=1)
    solution = bearing.solve(force=(0.0, 0.0, 2e3), speed=400.0, **STANDARD)
    pull = bearing.mass * 41e-3 * (400.0 / 2 * (1 - 12 / 82 * math.cos(ANGLE))) ** 2
    rise = np.diff(solution.loads, axis=1)
    # Across the line of both centres; its angle moves by the displacement over 83 mm.
    assert_close(rise, pull * math.cos(ANGLE), rtol=1e-3, each=True)
    # The rib of the inner ring takes the rest; the outer ring has what the inner one carries.
    outer = solution.loads[:, 1] @ np.sin(solution.contact_angles[:, 1])
    assert outer == pytest.approx(2e3, rel=1e-4)
    assert solution.force[2] == pytest.approx(2e3, rel=1e-8)


LIGHT = (500.0, 0.0, 0.0)


def hertz(bearing: SphericalRoller, ring: int, load: float) -> nacre.hertz.Ellipse:
    """Return the contact at the middle of a barrel, of radii that are written anew."""
    modulus = 210e9 / (1 - 0.3**2) / 2
    sphere = 41e-3 / math.cos(ANGLE) + 6e-3
    rolling = (41e-3 / math.cos(ANGLE) - 6e-3, -sphere)[ring]
    return nacre.hertz.Ellipse(46.5e-3, 6e-3, modulus, load, -sphere, rolling)


def test_light_barrels_are_hertz_ellipses() -> None:
    bearing = spherical(free_ends=False)
    solution = bearing.solve(force=LIGHT, cells=(80, 32))
    assert solution.lamina_loads is not None
    assert solution.grid_sizes is not None
    bounds = np.linspace(-5.5e-3, 5.5e-3, 41)
    for ring in range(2):
        load = float(solution.loads[0, ring])
        ellipse = hertz(bearing, ring, load)
        a, _ = ellipse.semi_axes
        # Measured: 1e-3 and 3e-4.
        assert solution.peak_pressures[0, ring] == pytest.approx(ellipse.peak_pressure, rel=3e-3)
        assert solution.approaches[0, ring] == pytest.approx(ellipse.approach, rel=1e-3)
        assert 2 * a < solution.grid_sizes[0, ring, 0] < 5.3e-3
        # Loads per length are those of a parabola, and laminae their integrals.
        part = np.clip(bounds / a, -1.0, 1.0)
        expected = np.diff(0.75 * load * (part - part**3 / 3))
        found = solution.lamina_loads[0, ring]
        assert_close(found, expected, atol=2e-3 * expected.max())
        assert found.sum() == pytest.approx(load, rel=1e-12)
        # The largest pressure of a lamina is that nearest to the middle, or of a cell across there.
        nearer = np.minimum(np.abs(bounds[1:]), np.abs(bounds[:-1]))
        cell = solution.grid_sizes[0, ring, 0] / 80
        low, high = (
            ellipse.peak_pressure * np.sqrt(np.maximum(1 - (np.maximum(x, 0.0) / a) ** 2, 0.0))
            for x in (nearer + cell / 2, nearer - cell / 2)
        )
        assert solution.lamina_pressures is not None
        pressures = solution.lamina_pressures[0, ring]
        bar = 3e-3 * ellipse.peak_pressure
        inside = nearer + cell < a
        assert (pressures >= low - bar)[inside].all()
        assert (pressures <= high + bar)[inside].all()
        np.testing.assert_array_equal(pressures > 0, found > 0)
    assert solution.edge_pressure == 0.0


def test_ends_beyond_the_grid_are_free() -> None:
    bearing = spherical()
    solution = bearing.solve(force=LIGHT, cells=(80, 32))
    contact = solution.contact(0, "outer")
    assert contact is not None
    assert contact.grid.size[0] < 0.5 * bearing.length
    body, barrel = contact.report.body, contact.report.counterbody
    assert isinstance(barrel, nacre.HalfSpace)
    assert barrel.ends == (-5.5e-3, 5.5e-3)
    whole = nacre.Grid((240, 48), (11e-3, 1.2e-4))
    place = float(solution.approaches[0, 1])
    wide = nacre.solve(bearing.shape("outer"), body, barrel, grid=whole, approach=place)
    assert contact.load == pytest.approx(wide.load, rel=3e-3)
    # Free ends take 5 % of the load at this approach.
    alone = (place / hertz(bearing, 1, 1.0).approach) ** 1.5
    assert contact.load < 0.97 * alone
    laminae, pressures = binned(bearing, wide)
    # Six cells a lamina, as those of heavy barrels are.
    cells = wide.line_load.reshape(40, 6) * wide.grid.spacing[0]
    assert_close(laminae, cells.sum(1), rtol=1e-12, atol=1e-15 * wide.load)
    np.testing.assert_array_equal(pressures, wide.pressure.reshape(40, -1).max(1))
    assert solution.lamina_loads is not None
    short = solution.lamina_loads[0, 1]
    assert_close(short, laminae, atol=3e-3 * laminae.max())


def test_barrels_that_outgrow_their_grids_are_solved_on_longer_ones() -> None:
    bearing = spherical(free_ends=False)
    lines = np.full((38, 2), 1.0)  # N/m: a thousandth of what comes
    law = Solved(bearing, lines, (40, 24), 1e-9, 1)
    light = law.sizes()[0, 0, 0]
    load = 5e3
    places = np.full((38, 2, 2), -1e-6)
    places[..., 1] = 0.0
    places[0, 0, 0] = hertz(bearing, 0, load).approach
    found = law(places)
    assert light < 1e-3
    assert law.sizes()[0, 0, 0] == pytest.approx(bearing.length, rel=1e-15)
    # Hertz's ellipse of 5 kN is 14 mm long, longer than the barrel.
    assert 0.7 * load < found.force[0, 0, 0] < load


def test_rating_counts_rows() -> None:
    # In mm and N, written anew; f_c is that of the table, 87.9 at γ = 0.144, of three digits.
    bearing = spherical()
    gamma = 12 * math.cos(ANGLE) / 82
    ratio = (1 - gamma) / (1 + gamma)
    factor = 0.83 * 551.13373 * 0.377 * gamma ** (2 / 9) * (1 - gamma) ** (29 / 27)
    factor /= (1 + gamma) ** 0.25
    factor *= (1 + (1.04 * ratio ** (143 / 108)) ** 4.5) ** (-2 / 9)
    assert factor == pytest.approx(87.9, rel=2e-3)
    expected = 1.15 * factor * (2 * 11 * math.cos(ANGLE)) ** (7 / 9) * 19**0.75 * 12 ** (29 / 27)
    assert rating(bearing) == pytest.approx(expected, rel=1e-12)
    single = spherical(rows=1)
    assert expected / rating(single) == pytest.approx(2 ** (7 / 9), rel=1e-12)
    # Two rows with the loads of one: as weak as two bearings in a row, and rated as such.
    loads = np.random.default_rng(5).uniform(0.0, 50.0, (19, 2, 40))
    one = reference_life(single, loads, 1.0)
    both = reference_life(bearing, np.concatenate([loads, loads]), 1.0)
    assert_close(both.capacities, one.capacities, rtol=1e-12)
    assert both.l10r / one.l10r == pytest.approx(2 ** (-8 / 9), rel=1e-12)
    solution = bearing.solve(force=FORCE, **STANDARD)
    assert solution.life().l10r == solution.life(edge=None).l10r
    assert "barrels have none of the standard's edge factors" in str(solution.life())


@pytest.mark.slow
def test_lives_films_files_and_pictures(tmp_path: Path) -> None:
    bearing = spherical(count=7)
    light, heavy = (
        quiet(bearing.solve, force=(load, 0.0, 0.0), cells=(40, 16)) for load in (1.5e3, 3e3)
    )
    # Between Hertz's point, L ∝ W^−3, and line contact, L ∝ W^−4.
    ratio = life_ratio(heavy, light, LundbergPalmgren()).ratio
    assert 1 / 16 < ratio < 1 / 7
    assert light.life("pressure").l10r > heavy.life("pressure").l10r
    contact = light.contact(7, "outer")
    assert contact is not None
    film = film_thickness(contact, speed=5.0, viscosity=0.02, pressure_viscosity=20e-9)
    middle = 1 / float(light.bearing.curvature("outer"))
    assert film.radius == pytest.approx(middle, rel=0.01)
    back = nacre.load(light.save(tmp_path / "spherical.nc"))
    assert isinstance(back, BearingSolution)
    assert back == light
    again = back.contact(7, "outer")
    assert again is not None
    assert again.load == pytest.approx(contact.load, rel=1e-8)
    # Seven lines have the verdict and what was solved, one the error of the peak: there is no
    # pressure at the edge.
    assert light.edge_pressure == 0.0
    assert light.save(tmp_path / "spherical.csv").read_text("utf-8").count("\n") == 14 + 1 + 7 + 1
    assert light.save(tmp_path / "spherical.png").stat().st_size > 10_000
    with pytest.raises(ValueError, match="element must be from 0 to 13, got 14"):
        light.contact(14, "outer")


def test_pictures_show_both_rows() -> None:
    solution = spherical().solve(force=FORCE, **STANDARD)
    axes = plot.load_distribution(solution)
    heights = [bar.get_height() for bar in list[Any](axes.patches)]
    assert_close(heights, solution.loads[:, 0] / 1e3)
    legend: Any = axes.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["row 1", "row 2"]
    fast = spherical().solve(force=FORCE, speed=400.0, **STANDARD)
    legend = plot.load_distribution(fast).get_legend()
    words = [f"row {row}, {ring}" for row in (1, 2) for ring in ("inner", "outer")]
    assert [text.get_text() for text in legend.get_texts()] == words
