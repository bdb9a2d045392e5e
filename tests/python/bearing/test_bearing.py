"""Bearings are in equilibrium, symmetric, and carry what their contacts carry."""

from __future__ import annotations

import copy
import dataclasses
import math
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
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
from nacre.bearing.contact_laws import Slices, Solved
from nacre.bearing.solution import carrying
from support import assert_close

STEEL = nacre.Elastic(young=206e9, poisson=0.3)
DLC = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(300e9, 0.25), 3e-6, name="DLC")])
ROLLERS: dict[str, Any] = {
    "count": 14,
    "diameter": 10e-3,
    "length": 9.6e-3,
    "pitch_diameter": 65e-3,
    "clearance": 41e-6,
}
TAPERED: dict[str, Any] = {
    "count": 17,
    "diameter": 8e-3,
    "length": 11e-3,
    "pitch_diameter": 48e-3,
    "contact_angle": 0.25,
}
BARRELS: dict[str, Any] = {
    "count": 9,
    "diameter": 12e-3,
    "length": 11e-3,
    "pitch_diameter": 62e-3,
    "contact_angle": 0.23,
    "profile_radius": 35e-3,
}
BALLS: dict[str, Any] = {"count": 7, "diameter": 11.5e-3, "pitch_diameter": 43.5e-3}
COARSE: dict[str, Any] = {"cells": (40, 24)}
FEWEST: dict[str, Any] = {"cells": (40, 12)}
STANDARD: dict[str, Any] = {"model": "iso16281"}
TILT = math.tan(math.radians(2 / 60))


@pytest.fixture(scope="module")
def coated() -> BearingSolution:
    """Return a bearing of 14 rollers between coated rings, tilted by 2'."""
    bearing = CylindricalRoller(**ROLLERS, inner=DLC, outer=DLC)
    return bearing.solve(force=(4450.0, 0.0, None), tilt=(None, TILT), cells=(80, 32))


def test_forces_and_moments_balance(coated: BearingSolution) -> None:
    report, angles = coated.report, coated.angles
    assert report.converged
    assert report.balance <= 1e-9
    assert report.iterations <= 10  # the bar
    loads, moments = coated.loads, coated.moments
    scale = float(loads.sum()) / 2
    assert_close(loads[:, 0], loads[:, 1], atol=1e-9 * scale, rtol=0)
    assert_close(moments[:, 0], moments[:, 1], atol=1e-9 * scale * 9.6e-3, rtol=0)
    assert loads[:, 0] @ np.cos(angles) == pytest.approx(4450.0, abs=1e-9 * scale)
    # The ring is not free to tilt: its moment is that of the rollers.
    assert moments[:, 0] @ np.cos(angles) == pytest.approx(coated.moment[1], rel=1e-9)


def test_contacts_are_those_that_were_solved(coated: BearingSolution) -> None:
    contact = coated.contact(0, "inner")
    assert contact is not None
    assert contact.load == coated.loads[0, 0]
    assert contact.peak_pressure == coated.peak_pressures[0, 0]
    assert contact.report.body == DLC
    assert coated.contact(7, "inner") is None
    assert coated.lamina_loads is not None
    assert_close(coated.lamina_loads.sum(-1), coated.loads, rtol=1e-12)
    # Gradients of one contact stay available.
    assert contact.gradient("peak_pressure", ["approach"])["approach"] > 0


def test_pressure_leans_towards_the_tilt(coated: BearingSolution) -> None:
    # The ring tilts by ψ, the roller takes half of it; at x > 0 the pressure is higher.
    assert 0 < coated.tilts[0, 0] < TILT
    assert coated.tilts[0].sum() == pytest.approx(TILT, rel=1e-9)
    assert coated.lamina_pressures is not None
    assert coated.lamina_pressures[0, 0, 20:].max() > coated.lamina_pressures[0, 0, :20].max()


@pytest.mark.parametrize("options", [COARSE, STANDARD], ids=["solved", "standard"])
def test_rotation_by_a_pitch_changes_nothing(options: dict[str, Any]) -> None:
    bearing = CylindricalRoller(**ROLLERS)
    asked: dict[str, Any] = {"force": (4450.0, 300.0, None), "tilt": (1e-4, 5e-4)} | options
    one, other = (
        bearing.solve(**asked, rotation=rotation) for rotation in (0.1, 0.1 + 2 * math.pi / 14)
    )
    rolled = np.roll(other.loads, 1, axis=0)
    assert_close(rolled, one.loads, atol=1e-9 * one.largest_load)


@pytest.mark.parametrize("options", [COARSE, STANDARD], ids=["solved", "standard"])
def test_mirrored_load_mirrors_the_loads(options: dict[str, Any]) -> None:
    bearing = CylindricalRoller(**ROLLERS)
    one = bearing.solve(force=(4450.0, 300.0, None), tilt=(1e-4, 5e-4), **options)
    other = bearing.solve(force=(4450.0, -300.0, None), tilt=(-1e-4, 5e-4), **options)
    mirrored = other.loads[-np.arange(14) % 14]
    assert_close(mirrored, one.loads, atol=1e-9 * one.largest_load)


def reaction(bearing: Any, place: Any, options: dict[str, Any]) -> np.ndarray[Any, Any]:
    x, y, z, about_x, about_y = place.tolist()
    along = (x, y, z if bearing.carries_thrust else None)
    asked = {"displacement": along, "tilt": (about_x, about_y), "tolerance": 1e-11} | options
    found = quiet(bearing.solve, **asked)
    return np.array([*found.force, *found.moment])


@pytest.mark.parametrize(
    ("bearing", "options", "steps"),
    [
        (CylindricalRoller(**ROLLERS), STANDARD, (1e-10, 1e-10, 0, 1e-8, 1e-8)),
        # A step is so short that no cell joins the contact: derivatives are those of the cells.
        pytest.param(
            *(CylindricalRoller(**ROLLERS), FEWEST, (2e-11, 2e-11, 0, 1e-9, 1e-9)),
            marks=pytest.mark.slow,
        ),
        (TaperedRoller(**TAPERED), STANDARD | {"speed": 500.0}, (1e-10,) * 3 + (1e-8,) * 2),
        pytest.param(
            TaperedRoller(**TAPERED), FEWEST, (2e-11,) * 3 + (1e-9,) * 2, marks=pytest.mark.slow
        ),
        (SphericalRoller(**BARRELS), STANDARD | {"speed": 500.0}, (1e-10,) * 3 + (0, 0)),
        pytest.param(
            SphericalRoller(**BARRELS), FEWEST, (2e-11,) * 3 + (0, 0), marks=pytest.mark.slow
        ),
        (DeepGrooveBall(**BALLS), STANDARD | {"speed": 500.0}, (1e-9,) * 3 + (1e-8,) * 2),
    ],
    ids=[
        "rollers, standard",
        "rollers, solved",
        "tapered, standard",
        "tapered, solved",
        "barrels, standard",
        "barrels, solved",
        "balls",
    ],
)
def test_stiffness_is_the_derivative(
    bearing: Any, options: dict[str, Any], steps: tuple[float, ...]
) -> None:
    force: Any = (1000.0, 200.0, 500.0) if bearing.nominal_angle == 0 else (1500.0, 300.0, 3000.0)
    force = (4450.0, 300.0, None) if isinstance(bearing, CylindricalRoller) else force
    solution = quiet(bearing.solve, force=force, tilt=(1e-4, 5e-4), tolerance=1e-11, **options)
    place = np.array([*solution.displacement, *solution.tilt])
    stiffness = solution.stiffness()
    scale = np.sqrt(np.diag(stiffness))
    for k, step in enumerate(steps):
        if step == 0:
            assert not stiffness[k].any()
            continue
        moved = np.zeros(5)
        moved[k] = step
        change = reaction(bearing, place + moved, options)
        change = (change - reaction(bearing, place - moved, options)) / (2 * step)
        unit = np.where(scale > 0, scale, 1.0) * scale[k]
        assert_close(change / unit, stiffness[:, k] / unit, atol=1e-6)  # the bar


@pytest.mark.filterwarnings("ignore:contacts with the .* beyond its shoulder")  # some loads do that
@pytest.mark.parametrize("seed", range(12))
def test_random_bearings_find_their_equilibrium(seed: int) -> None:
    draw = np.random.default_rng(seed)
    count, diameter = int(draw.integers(5, 30)), 10 ** draw.uniform(-3, -1.5)
    pitch = diameter * (draw.uniform(1.02, 1.6) / math.sin(math.pi / count) + 0.4)
    given: dict[str, Any] = {
        "count": count,
        "diameter": diameter,
        "pitch_diameter": pitch,
        "clearance": diameter * draw.uniform(-5e-4, 4e-3),
    }
    bearing: Any = DeepGrooveBall(**given)
    if seed % 2:
        bearing = CylindricalRoller(**given, length=diameter * draw.uniform(0.8, 5))
    load = rating(bearing) * 10 ** draw.uniform(-3, -0.3) * draw.normal(size=3)
    force = (load[0], load[1], None if seed % 2 else load[2])
    tilt = draw.normal(size=2) * 1e-3
    rotation, speed = draw.uniform(0, 1), draw.uniform(0, 2) / diameter
    solution = bearing.solve(
        force=force, tilt=tilt, rotation=rotation, speed=speed, model="iso16281"
    )
    assert solution.report.balance <= 1e-9
    scale = solution.loads.sum()
    for found, asked in zip(solution.force, force, strict=True):
        assert asked is None or found == pytest.approx(asked, abs=1e-9 * scale)
    assert np.linalg.eigvalsh(solution.stiffness()).min() > -1e-9 * scale / diameter


def test_centrifugal_force_presses_on_the_outer_ring() -> None:
    bearing = CylindricalRoller(**ROLLERS)
    solution = bearing.solve(force=(4450.0, 0.0, None), speed=500.0, **STANDARD)
    mass = 7850 * math.pi / 4 * 10e-3**2 * 9.6e-3
    force = mass * 32.5e-3 * (500.0 / 2 * (1 - 10 / 65)) ** 2  # at the speed of the cage
    assert_close(np.diff(solution.loads, axis=1).ravel(), force, rtol=1e-7)
    balls = DeepGrooveBall(**BALLS).solve(force=(0.0, 0.0, 1000.0), speed=1000.0, **STANDARD)
    radial = balls.loads * np.cos(balls.contact_angles)
    cage = 1000.0 / 2 * (1 - 11.5 / 43.5)
    mass = 7850 * math.pi / 6 * 11.5e-3**3
    assert_close(np.diff(radial, axis=1), mass * 21.75e-3 * cage**2, rtol=1e-6)


def test_unloaded_rollers_at_speed_rest_on_the_outer_ring() -> None:
    bearing = CylindricalRoller(**ROLLERS)
    cage = 300.0
    speed = 2 * cage / (1 - 10 / 65)
    solution = bearing.solve(displacement=(0.0, 0.0, None), speed=speed, **COARSE)
    mass = 7850 * math.pi / 4 * 10e-3**2 * 9.6e-3
    assert_close(solution.loads[:, 1], mass * 32.5e-3 * cage**2, rtol=1e-8)
    assert not solution.loads[:, 0].any()


def test_preload_loads_all_rollers_alike() -> None:
    bearing = CylindricalRoller(**ROLLERS | {"clearance": -20e-6})
    solution = bearing.solve(displacement=(0.0, 0.0, None), **COARSE)
    assert solution.loaded == 14
    assert_close(solution.loads, solution.loads[0, 0], rtol=1e-8)
    # Both contacts together approach by half of the preload's amount.
    assert_close(solution.approaches.sum(1), 10e-6, rtol=1e-12)


@pytest.mark.parametrize(
    ("load", "solved", "slices"),
    # 209-like roller under one load, both races together; the first column was computed by another
    # program over nacre's contacts, in the half-space model, on its own cells: 3e-3.
    [(200.0, 3.182e-6, 3.351e-6), (960.0, 9.537e-6, 9.502e-6), (1929.0, 15.880e-6, 15.548e-6)],
)
def test_rollers_approach_as_laminae(load: float, solved: float, slices: float) -> None:
    bearing = CylindricalRoller(**ROLLERS | {"clearance": 0.0}, free_ends=False)
    ends = CylindricalRoller(**ROLLERS | {"clearance": 0.0})
    grid = nacre.Grid((160, 64), (9.6e-3, 6e-4))
    half, free = 0.0, 0.0
    for ring in ("inner", "outer"):
        steel = nacre.Elastic(young=210e9, poisson=0.3)
        roller = nacre.HalfSpace(steel, ends=(-4.8e-3, 4.8e-3))
        shape = bearing.shape(ring)
        half += nacre.Contact(steel, grid, steel).solve(shape, load=load).approach
        free += nacre.Contact(steel, grid, roller).solve(shape, load=load).approach
    assert bearing.shape("inner") == ends.shape("inner")
    assert half == pytest.approx(solved, rel=3e-3)
    places = np.zeros((1, 2, 2))
    places[..., 0] = slices / 2
    # The power 10/9 of four printed digits.
    assert_close(Slices(bearing)(places).force[..., 0], load, rtol=2e-3, each=True)
    assert half == pytest.approx(slices, rel=0.06)  # the bar
    assert free > half  # ends make rollers softer


def test_crowned_raceway_adds_its_drop() -> None:
    crowned = CylindricalRoller(**ROLLERS, raceway_crown=(10.0, None))
    plain = CylindricalRoller(**ROLLERS)
    x = (np.arange(40) + 0.5) / 40 * 9.6e-3 - 4.8e-3
    assert_close(crowned.drop("inner") - plain.drop("inner"), x**2 / 20, atol=1e-18)
    np.testing.assert_array_equal(crowned.drop("outer"), plain.drop("outer"))
    grid = nacre.Grid((96, 8), (9.0e-3, 1e-5))
    more = crowned.shape("inner").gaps(grid) - plain.shape("inner").gaps(grid)
    # Between samples of the logarithm that are 24 µm apart a cubic is off by 1e-5 of the drop.
    expected = grid.x[:, None] ** 2 / 20 + 0 * grid.y
    assert_close(more, expected, atol=1e-9)


def test_raceways_stand_for_pitch_and_clearance() -> None:
    given = {k: v for k, v in ROLLERS.items() if k not in ("pitch_diameter", "clearance")}
    bearing = CylindricalRoller(**given, raceway_diameters=(55e-3, 75.041e-3))
    assert bearing.play == pytest.approx(41e-6, rel=1e-9)
    assert bearing.raceways == (27.5e-3, 37.5205e-3)


@pytest.mark.parametrize("count", [19, 20, 24, 25])
def test_elements_that_touch_fill_the_circle(count: int) -> None:
    # By rounding, 20 and 24 are less than a diameter apart, and 25 are one more than have room.
    diameter = ROLLERS["diameter"]
    full = ROLLERS | {"pitch_diameter": diameter / math.sin(math.pi / count), "count": count}
    assert CylindricalRoller(**full).count == count
    with pytest.raises(ValueError, match=f"count must be at most {count}:"):
        CylindricalRoller(**full | {"count": count + 1})


def test_iteration_limit_and_stop_leave_the_unfinished_solution() -> None:
    bearing = CylindricalRoller(**ROLLERS)
    asked: dict[str, Any] = {"force": (4450.0, 0.0, None)} | COARSE
    with pytest.raises(nacre.ConvergenceError, match="after 1 steps") as error:
        bearing.solve(**asked, max_iterations=1)
    assert error.value.solution.report.termination == "iteration limit"
    calls: list[int] = []

    def stop(done: int, balance: float) -> bool:
        calls.append(done)
        return done < 1

    stopped = bearing.solve(**asked, progress=stop)
    assert (stopped.report.termination, calls) == ("stopped", [0, 1])


def test_standard_says_what_it_leaves_out() -> None:
    soft = nacre.Elastic(young=100e9, poisson=0.3)
    for given, words in (({"inner": DLC}, "layers are not counted"), ({"element": soft}, "moduli")):
        with pytest.warns(nacre.NacreWarning, match=words):
            CylindricalRoller(**ROLLERS, **given).solve(force=(100.0, None, None), **STANDARD)
    solution = CylindricalRoller(**ROLLERS).solve(force=(100.0, None, None), **STANDARD)
    with pytest.raises(ValueError, match='model must be "solved" for a contact'):
        solution.contact(0, "inner")
    with pytest.raises(ValueError, match="whose pressure is not known"):
        solution.life("pressure")


def test_coating_makes_contacts_stiffer_or_softer() -> None:
    # The load shares stay; a soft layer lets the rollers sink more.
    soft = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(50e9, 0.3), 20e-6)])
    depths = [
        CylindricalRoller(**ROLLERS, inner=body)
        .solve(force=(4450.0, 0.0, None), **COARSE)
        .displacement[0]
        for body in (soft, STEEL, DLC)
    ]
    assert depths[0] > depths[1] > depths[2]


def test_solution_is_saved_loaded_pickled_and_printed(
    coated: BearingSolution, tmp_path: Path
) -> None:
    back = nacre.load(coated.save(tmp_path / "bearing.nc"))
    assert back == coated
    assert pickle.loads(pickle.dumps(coated)) == coated
    assert copy.deepcopy(coated) == coated
    assert back.bearing == coated.bearing
    # That of a file is solved again, without a warm start.
    again, known = back.contact(1, "outer"), coated.contact(1, "outer")
    assert again is not None
    assert known is not None
    assert again.peak_pressure == pytest.approx(known.peak_pressure, rel=1e-7)
    text = coated.save(tmp_path / "bearing.csv").read_text("utf-8")
    assert text.count("\n") == 14 + 1 + 7 + 2  # elements, heading, comments, errors
    assert "loaded         5 of 14 elements" in str(coated)
    assert "<table" in coated._repr_html_()
    assert coated.save(tmp_path / "bearing.png").stat().st_size > 10_000
    life = coated.life("pressure")
    assert nacre.load(life.save(tmp_path / "life.nc")) == life
    damaged = coated.to_dict() | {"loads": [[1.0]]}
    with pytest.raises(ValueError, match="loads must have the shape"):
        BearingSolution.from_dict(damaged)


def test_bearings_are_in_si_whatever_units_are_set(tmp_path: Path) -> None:
    bearing = DeepGrooveBall(**BALLS)
    solution = bearing.solve(force=(50.0, 0.0, None), cells=(32, 32))
    ratio = nacre.bearing.life_ratio(solution, solution, nacre.bearing.LundbergPalmgren())
    found = solution, solution.life(), ratio

    def told() -> list[str]:
        pages = [one.save(tmp_path / "a.csv").read_text("utf-8") for one in found]
        sets = [one.to_xarray() for one in found]
        units = [str({name: one[name].attrs for name in one}) + str(one.attrs) for one in sets]
        labels = [axes.get_xlabel() + axes.get_title() for axes in solution.plot().values()]
        forms = [form(one) for one in found for form in (repr, str)]
        return [*pages, *units, *labels, *forms, *(one._repr_html_() for one in found)]

    expected = told()
    with nacre.display_units("N-mm-MPa"):
        assert told() == expected
        assert nacre.display_units("N-mm-MPa").before.name == "N-mm-MPa"


def test_implausible_tilts_and_pressures_are_warned_of() -> None:
    rollers, balls = CylindricalRoller(**ROLLERS), DeepGrooveBall(**BALLS)
    with pytest.warns(nacre.NacreWarning):
        tilted = rollers.solve(displacement=(1e-5, 0.0, None), tilt=(None, 0.5), **STANDARD)
    tilt, peak = tilted.report.warnings
    assert tilt.startswith("the tilt of the ring, a slope, is 0.5: far above those of bearings")
    assert peak.startswith("the peak pressure is ")
    assert ": above 5 GPa, contacts" in peak
    with pytest.warns(nacre.NacreWarning):
        pressed = balls.solve(force=(1e5, 0.0, None), **STANDARD)
    peak, shoulder = pressed.report.warnings
    assert re.match("the peak pressure is .* GPa: above 5 GPa", peak)
    # Such a contact is as wide as the ball, and beyond every shoulder.
    assert shoulder.startswith("contacts with the inner ring reach 90 degrees")


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_huge_loads_overflow_nothing() -> None:
    lines = np.array([[0.0, 6e9]])
    contacts = Solved(CylindricalRoller(**ROLLERS), lines, (40, 24), 1e-9, 1)
    assert contacts.halved.tolist() == [[3, 0]]


def test_contacts_that_carry_rounding_are_not_told() -> None:
    bearing = AngularContactBall(
        count=8, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=math.radians(25)
    )
    solution = bearing.solve(force=(500.0, 0.0, 500.0), **STANDARD)
    loads = solution.loads.copy()
    light = int(loads[:, 0].argmin())
    loads[light] = 2e-13
    found = dataclasses.replace(solution, loads=loads)
    assert found.loaded == solution.loaded - (solution.loads[light] > 0).all()
    rows = str(found).split("\n\n")[1].splitlines()[1:]
    assert f"{light}" not in [row.split()[0] for row in rows]
    assert carrying(np.zeros((2, 2))).sum() == 0


def test_swapped_raceways_are_refused() -> None:
    given = {name: ROLLERS[name] for name in ("count", "diameter", "length")}
    message = r"raceway_diameters must be \(inner, outer\), the inner one the smaller, got"
    with pytest.raises(ValueError, match=message):
        CylindricalRoller(**given, raceway_diameters=(83e-3, 61e-3))


def test_pressures_at_sharp_ends_have_two_digits() -> None:
    sharp = CylindricalRoller(**ROLLERS, profile=None)
    solved = quiet(sharp.solve, force=(4000.0, 0.0, None), cells=(40, 24))
    text = str(solved)
    assert f"peak pressure  {solved.peak_pressure / 1e9:.2g} GPa" in text
    assert "ends are sharp: their pressure has no limit" in text
    rounded = quiet(CylindricalRoller(**ROLLERS).solve, force=(4000.0, 0.0, None), cells=(40, 24))
    assert f"peak pressure  {rounded.peak_pressure / 1e9:.4g} GPa" in str(rounded)
    assert "sharp" not in str(rounded) + str(sharp.solve(force=(1000.0, 0.0, None), **STANDARD))
