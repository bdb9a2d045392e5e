"""Equilibria are found where there are any; other loads are refused with what would do."""

from __future__ import annotations

import math
import re
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
    Pair,
    SphericalRoller,
    TaperedRoller,
    equilibrium,
)
from nacre.bearing.contact_laws import Solved
from nacre.contact.solution import Solution
from support import assert_close

SIZE: dict[str, Any] = {"count": 14, "diameter": 10e-3, "length": 9.6e-3, "pitch_diameter": 65e-3}
STANDARD: dict[str, Any] = {"model": "iso16281"}
COARSE: dict[str, Any] = {"cells": (40, 24)}
BOTH = pytest.mark.parametrize("options", [STANDARD, COARSE], ids=["standard", "solved"])
TAPERED = TaperedRoller(
    count=17, diameter=8e-3, length=11e-3, pitch_diameter=48e-3, contact_angle=math.radians(14)
)


@BOTH
@pytest.mark.parametrize("crown", [1e9, -1e9])
def test_a_crown_of_a_plane_changes_nothing(options: dict[str, Any], crown: float) -> None:
    # x²/2R is 1e-14 m at the ends: 1e-9 of the displacement. The profile drops by 5 µm everywhere.
    x = np.linspace(-4.8e-3, 4.8e-3, 61)
    profile = nacre.SampledProfile(x, 5e-6 + 2e-6 * (x / 4.8e-3) ** 2)
    straight, crowned = (
        quiet(
            CylindricalRoller(**SIZE, profile=profile, raceway_crown=crowns).solve,
            force=(1500.0, 0.0, None),
            **options,
        )
        for crowns in ((None, None), (crown, crown))
    )
    assert straight.displacement[0] > 10e-6  # the drop of both contacts
    assert crowned.displacement[0] == pytest.approx(straight.displacement[0], rel=1e-8)
    assert crowned.peak_pressure == pytest.approx(straight.peak_pressure, rel=1e-7)


@pytest.mark.parametrize("crown", [2.0, -2.0])
@pytest.mark.parametrize("ring", ["inner", "outer"])
def test_shapes_drop_as_laminae_do(ring: Any, crown: float) -> None:
    crowned = CylindricalRoller(**SIZE, raceway_crown=(crown, crown))
    straight = CylindricalRoller(**SIZE)
    grid = nacre.Grid((40, 2), (9.6e-3, 2e-12))
    gaps = (crowned.shape(ring).gaps(grid) - straight.shape(ring).gaps(grid))[:, 0]
    # The gap of a cell, which is a lamina here, is its mean: dx²/24R more than that in its middle.
    mean = (9.6e-3 / 40) ** 2 / (24 * crown)
    assert_close(gaps - mean, crowned.drop(ring) - straight.drop(ring), atol=1e-14)
    assert -1e-15 < crowned.drop(ring).min() < 0.03e-6  # the lowest place may be between laminae


@pytest.mark.parametrize("place", [0, 1])
@pytest.mark.parametrize("kind", [CylindricalRoller, TaperedRoller])
@pytest.mark.parametrize(
    ("count", "load", "tilt", "length", "crown"),
    [
        (14, 200.0, 6e-4, 10e-3, 5.0),
        (20, 200.0, 3e-3, 20e-3, 5.0),
        (20, 1500.0, 3e-3, 20e-3, 1.0),
        (14, 8000.0, 2e-3, 15e-3, -20.0),
    ],
)
def test_misaligned_crowned_bearings_converge(
    kind: Any, place: int, count: int, load: float, tilt: float, length: float, crown: float
) -> None:
    sizes = {"count": count, "diameter": 10e-3, "length": length, "pitch_diameter": 75e-3}
    force: tuple[float | None, ...] = (load, 0.0, None)
    if kind is TaperedRoller:
        sizes |= {"contact_angle": 0.25, "count": min(count, 18)}
        force = (load, 0.0, load)
    crowns = (crown, None) if place == 0 else (None, crown)
    bearing = kind(**sizes, clearance=20e-6, raceway_crown=crowns)
    solution = bearing.solve(force=force, tilt=(None, tilt), **STANDARD)
    assert solution.report.balance <= 1e-9
    assert solution.report.iterations <= 10
    assert solution.force[0] == pytest.approx(load, rel=1e-8)


def spied(patch: pytest.MonkeyPatch, owner: Any, name: str) -> list[Any]:
    """Return the list of the arguments of each call of a method, which stays as it is."""
    calls: list[Any] = []
    method = getattr(owner, name)

    def call(*arguments: Any) -> Any:
        calls.append(arguments)
        return method(*arguments)

    patch.setattr(owner, name, call)
    return calls


def test_rollers_that_centrifugal_forces_press_alone_take_short_steps(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # On deflections of nanometres contacts have next to no stiffness: steps were 10 000 times them.
    states = spied(monkeypatch, equilibrium.Problem, "state")
    bearing = CylindricalRoller(
        **SIZE | {"diameter": 14.3e-3, "length": 11e-3, "count": 10, "pitch_diameter": 203e-3},
        clearance=41.6e-6,
        raceway_crown=(50.0, 12.0),
    )
    load: dict[str, Any] = {"force": (-1538.0, -1129.0, None), "moment": (9.4, -7.0)}
    solution = quiet(bearing.solve, **load, speed=4.6, rotating="outer", cells=(40, 16))
    assert solution.report.converged
    assert sum(isinstance(problem.law, Solved) for problem, *_ in states) <= 12


def test_equal_elements_beside_the_load_are_solved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    contacts = spied(monkeypatch, Solved, "_solve")
    bearing = CylindricalRoller(**SIZE | {"clearance": 41e-6})
    load: dict[str, Any] = {"force": (4450.0, 0.0, None), "tilt": (None, 6e-4)}
    mirrored = bearing.solve(**load, **COARSE)
    count = len(contacts)
    turned = bearing.solve(**load, **COARSE, rotation=1e-9)  # no two are equal
    assert len(contacts) - count > 1.5 * count
    assert_close(mirrored.loads, turned.loads, atol=1e-5)
    np.testing.assert_array_equal(mirrored.loads[1:], mirrored.loads[:0:-1])


@pytest.mark.parametrize(("thrust", "bearings"), [(0.0, 1), (2000.0, 2)])
def test_unlike_contacts_of_a_pair_are_solved_three_times(
    monkeypatch: pytest.MonkeyPatch, thrust: float, bearings: int
) -> None:
    pair = Pair(TAPERED, TAPERED, arrangement="X", distance=50e-3, preload_distance=10e-6)
    solves = spied(monkeypatch, Solved, "_within")
    stiffnesses = spied(monkeypatch, Solution, "stiffness")
    solution = quiet(pair.solve, force=(4000.0, 0.0, thrust), moment=(0.0, 0.0), **COARSE)
    assert solution.report.converged
    # Bearings without thrust mirror each other; elements of one do beside the load.
    loaded = [one.loads[:9] for one in solution.bearings[:bearings]]
    unlike = sum(np.count_nonzero(loads) for loads in loaded)
    assert len(solves) <= 3 * unlike + 4 * bearings  # two elements come before all
    assert len(stiffnesses) <= 2 * unlike


def test_contacts_that_stay_in_place_are_not_solved_again() -> None:
    bearing = CylindricalRoller(**SIZE)
    contacts = Solved(bearing, np.full((3, 2), 1e5), (40, 16), 1e-9, 1)
    places = np.zeros((3, 2, 2))
    places[..., 0] = [[3e-6, 4e-6], [5e-6, 6e-6], [7e-6, 8e-6]]
    before = contacts(places)
    places[1, 0] = 5.5e-6, 1e-5
    after = contacts(places)
    moved = [key for key in before.contacts if after.contacts[key] is not before.contacts[key]]
    assert moved == [(1, 0)]
    fields = ("energy", "force", "stiffness")
    for one, other in ((getattr(before, name), getattr(after, name)) for name in fields):
        differs = (one != other).reshape(3, 2, -1).any(axis=2)
        assert differs.tolist() == [[False, False], [True, False], [False, False]]


@pytest.mark.slow
def test_an_element_that_overshoots_settles_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    # At corners idle rollers have next to no stiffness: halving the step of all took 3041 solves.
    solves = spied(monkeypatch, Solved, "_within")
    bearing = CylindricalRoller(
        count=29,
        diameter=0.014305821732970174,
        length=0.010966592693556602,
        pitch_diameter=0.20324615880334643,
        clearance=4.160943291303602e-05,
        raceway_crown=(50.35429680363326, 12.105276049479915),
    )
    solution = quiet(
        bearing.solve,
        force=(-4459.200832920791, -3272.964004876116, None),
        moment=(27.34019391311292, -20.31716588693442),
        rotation=2.245174488993092,
        speed=4.606803045305878,
        rotating="outer",
        cells=(40, 16),
    )
    assert solution.report.converged
    assert len(solves) < 1000


def test_tilted_rollers_between_held_rings_are_in_equilibrium() -> None:
    # Middles are 5 µm apart, and the ends touch. No load is given, and yet there is a balance.
    bearing = CylindricalRoller(**SIZE | {"clearance": 20e-6}, raceway_crown=(None, 2.0))
    solution = quiet(bearing.solve, displacement=(0.0, 0.0, None), tilt=(None, 8e-3), **STANDARD)
    assert (solution.approaches < 0).all()
    assert solution.largest_load > 10.0
    assert solution.report.balance <= 1e-9
    assert_close(solution.loads[:, 0], solution.loads[:, 1], atol=1e-9 * solution.loads.sum())


def test_a_missing_thrust_or_moment_is_named() -> None:
    message = r"force along z must be at least (\S+) N, got 760\.0 N, or moment about y must be at "
    message += r"most (\S+) N m, got 0\.0 N m: contacts only push"
    with pytest.raises(ValueError, match=message) as caught:
        TAPERED.solve(force=(3000.0, 0.0, 760.0), moment=(0.0, 0.0), **STANDARD)
    bounds = re.search(message, str(caught.value))
    assert bounds is not None
    thrust, moment = map(float, bounds.groups())
    # What it asks for is carried, and a thousandth less is not.
    enough = quiet(
        TAPERED.solve, force=(3000.0, 0.0, thrust * 1.001), moment=(0.0, 0.0), **STANDARD
    )
    assert enough.report.converged
    turned = quiet(
        TAPERED.solve, force=(3000.0, 0.0, 760.0), moment=(0.0, moment - 0.01), **STANDARD
    )
    assert turned.report.converged
    with pytest.raises(ValueError, match="at least"):
        TAPERED.solve(force=(3000.0, 0.0, thrust * 0.999), moment=(0.0, 0.0), **STANDARD)


def test_thrust_of_a_polygon_of_rollers() -> None:
    # Between two rollers a radial force needs more thrust: F tan α/cos(π/Z), derived here.
    bearing = TaperedRoller(
        count=5, diameter=8e-3, length=11e-3, pitch_diameter=48e-3, contact_angle=0.25
    )
    asked = {"force": (1000.0, 0.0, 300.0), "rotation": math.pi / 5}
    expected = 1000.0 * math.tan(0.25) / math.cos(math.pi / 5)
    with pytest.raises(ValueError, match=rf"at least {expected:.4g}\d* N, got 300\.0"):
        bearing.solve(**asked, **STANDARD)  # type: ignore[arg-type]


def test_two_rollers_carry_along_one_line() -> None:
    bearing = CylindricalRoller(**SIZE | {"count": 2})
    assert bearing.solve(force=(100.0, 0.0, None), **STANDARD).force[0] == pytest.approx(100.0)
    with pytest.raises(ValueError, match=r"force along y must be at most 0 N, got 100\.0 N"):
        bearing.solve(force=(0.0, 100.0, None), **STANDARD)
    # Along the line at the angle 0.3: 100/tan 0.3.
    with pytest.raises(ValueError, match=r"force along x must be at least 323\.273 N, got"):
        bearing.solve(force=(0.0, 100.0, None), rotation=0.3, **STANDARD)


@pytest.mark.parametrize("ring", ["inner", "outer"])
@pytest.mark.parametrize(
    ("bearing", "gamma"),
    [
        (CylindricalRoller(**SIZE), 10 / 65),
        (TAPERED, 8 / 48 * math.cos(math.radians(14) - TAPERED.roller_angle)),
        (DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3), 11.5 / 43.5),
        (
            AngularContactBall(
                count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.436
            ),
            11.1 / 46 * math.cos(0.436),
        ),
        (
            SphericalRoller(
                count=9,
                diameter=12e-3,
                length=11e-3,
                pitch_diameter=62e-3,
                contact_angle=0.23,
                profile_radius=35e-3,
            ),
            12 / 62 * math.cos(0.23),
        ),
    ],
    ids=lambda value: getattr(value, "kind", ""),
)
def test_the_cage_follows_the_ring(bearing: Any, gamma: float, ring: Any) -> None:
    share = (1 - gamma) / 2 if ring == "inner" else (1 + gamma) / 2
    assert bearing.cage_speed(300.0, ring) == pytest.approx(300.0 * share, rel=1e-12)
    held = (0.0, 0.0, None) if isinstance(bearing, CylindricalRoller) else (0.0, 0.0, 0.0)
    turning = bearing.solve(displacement=held, speed=300.0, rotating=ring, **STANDARD)
    assert turning.cage_speed == pytest.approx(300.0 * share, rel=1e-12)
    # Elements that touch the outer ring alone press on it with the part along its normal.
    pull = bearing.mass * bearing.pitch / 2 * turning.cage_speed**2
    free = turning.loads[:, 0] < 1e-3 * pull
    if isinstance(bearing, CylindricalRoller | DeepGrooveBall):
        assert free.all()
        assert_close(turning.loads[:, 1], pull, rtol=1e-6)
    assert "cage speed" in str(turning)
    assert "cage speed" not in str(bearing.solve(displacement=held, **STANDARD))


def test_lives_have_the_ring_that_rotates() -> None:
    bearing = CylindricalRoller(**SIZE)
    inner, outer = (
        bearing.solve(force=(4450.0, 0.0, None), rotating=ring, **STANDARD)
        for ring in ("inner", "outer")
    )
    np.testing.assert_array_equal(inner.loads, outer.loads)  # at rest nothing else changes
    assert outer.life() == inner.life(rotating="outer") != inner.life()
    assert outer.life(rotating="inner") == inner.life()


def test_moments_are_about_the_middle_of_the_balls() -> None:
    # A force through the pressure centre, where the contacts meet the axis, tilts the ring little:
    # without this moment it does so thirty times as much.
    bearing = AngularContactBall(
        count=24, diameter=8e-3, pitch_diameter=80e-3, contact_angle=math.radians(25)
    )
    moment = -500.0 * 40e-3 * math.tan(math.radians(25))
    through, beside = (
        bearing.solve(force=(500.0, 0.0, 2000.0), moment=(0.0, about), **STANDARD).tilt[1]
        for about in (moment, 0.0)
    )
    assert abs(through) < abs(beside) / 10


def test_tilts_that_moments_cause_are_warned_of() -> None:
    bearing = CylindricalRoller(**SIZE | {"clearance": 60e-6})
    with pytest.warns(nacre.NacreWarning, match=r"the tilt of the ring, a slope, is 0\.\d+: far"):
        solution = bearing.solve(force=(0.0, 0.0, None), moment=(0.0, 90.0), **STANDARD)
    assert abs(solution.tilt[1]) > 0.02


def test_an_end_without_descent_says_so() -> None:
    bearing = CylindricalRoller(**SIZE)
    asked: dict[str, Any] = {"force": (4450.0, 0.0, None), "tilt": (None, 3e-3)}
    with pytest.raises(nacre.ConvergenceError, match="no step lowers the energy") as caught:
        bearing.solve(**asked, tolerance=1e-17, **STANDARD)
    assert caught.value.solution.report.termination == "no descent"


@pytest.fixture(scope="module")
def tilted() -> BearingSolution:
    """Return a tilted bearing on coarse cells."""
    bearing = CylindricalRoller(**SIZE | {"clearance": 41e-6})
    return bearing.solve(force=(4450.0, 0.0, None), tilt=(None, 6e-4), **COARSE)


@pytest.mark.slow
def test_pressures_are_within_their_errors(tilted: BearingSolution) -> None:
    errors = tilted.report.discretisation
    assert errors is not None
    fine = tilted.bearing.solve(  # type: ignore[attr-defined]
        force=(4450.0, 0.0, None),
        tilt=(None, 6e-4),
        cells=(160, 96),  # four times as fine
    )
    for name in ("peak_pressure", "edge_pressure"):
        error = errors[name]
        assert error is not None
        assert abs(getattr(fine, name) - getattr(tilted, name)) < error
        assert error < 0.3 * getattr(tilted, name)
        smaller = fine.report.discretisation[name]
        assert smaller < error
    assert f"± {100 * errors['peak_pressure'] / tilted.peak_pressure:.1g} %" in str(tilted)  # type: ignore[operator]


def test_errors_are_kept(tilted: BearingSolution, tmp_path: Any) -> None:
    back = nacre.load(tilted.save(tmp_path / "tilted.nc"))
    assert back == tilted
    assert back.report.discretisation == tilted.report.discretisation
    text = tilted.save(tmp_path / "tilted.csv").read_text()
    assert "peak_pressure_discretisation" in text
    study = nacre.sweep(
        {"bearing": tilted.bearing, "force": (4450.0, 0.0, None), "tilt": (None, 6e-4), **COARSE},
        {"rotation": [0.0]},
        outputs=["peak_pressure", "edge_pressure"],
    )
    for name in ("peak_pressure", "edge_pressure"):
        kept = float(study[f"{name}_discretisation"][0])
        assert kept == pytest.approx(tilted.report.discretisation[name], rel=1e-9)  # type: ignore[index]


def test_sharp_rollers_have_no_error_and_balls_no_edge() -> None:
    sharp = quiet(
        CylindricalRoller(**SIZE, profile=None).solve, force=(4450.0, 0.0, None), **COARSE
    )
    assert sharp.report.discretisation == {"peak_pressure": None, "edge_pressure": None}
    assert "error not known" in str(sharp)
    ball = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    solved = quiet(ball.solve, force=(1000.0, 0.0, None), cells=(24, 24))
    assert solved.report.discretisation is not None
    assert set(solved.report.discretisation) == {"peak_pressure"}
    standard = ball.solve(force=(1000.0, 0.0, None), **STANDARD)
    assert standard.report.discretisation is None
    # Hertz's ellipses are exact.
    error = solved.report.discretisation["peak_pressure"]
    assert error is not None
    assert abs(standard.peak_pressure - solved.peak_pressure) < error


def test_a_corner_on_the_outermost_cells_has_no_error() -> None:
    # Half the cells end before the point where this load acts.
    bearing = CylindricalRoller(**SIZE | {"clearance": 100e-6}, profile=None)
    solution = quiet(bearing.solve, force=(5.0, 0.0, None), tilt=(None, 2e-3), cells=(40, 16))
    contact = solution.contact(0, "inner")
    assert contact is not None
    assert abs(contact.moment[0]) / contact.load > bearing.length / 2 * (1 - 1 / 20)
    # A contact that is narrow along both axes is one contact.
    assert any(text.startswith("2 of 2 contacts: ") for text in solution.report.warnings)
    assert not any(text.startswith("4 of 2 contacts") for text in solution.report.warnings)
    assert solution.report.discretisation == {"peak_pressure": None, "edge_pressure": None}


def test_states_of_the_first_release_are_read() -> None:
    # Their speed is that of the cage, of a shaft that turns; there are no errors.
    solution = CylindricalRoller(**SIZE).solve(force=(4450.0, 0.0, None), speed=500.0, **STANDARD)
    state = solution.to_dict()
    state["speed"] = solution.cage_speed
    del state["rotating"], state["report"]["discretisation"]
    back = BearingSolution.from_dict(state)
    assert back.speed == pytest.approx(500.0, rel=1e-14)
    assert back.rotating == "inner"
    assert back.report.discretisation is None
