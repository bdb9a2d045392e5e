"""Shakedown and fatigue of solved contacts, against two independent programs.

`tests/data/fatigue` says how its numbers were made: a rigid cylinder on a half-space, bare or
with one coat, in units of the bare Hertz contact at the same load; errors of 2e-5.
"""

from __future__ import annotations

import dataclasses
import functools
import json
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import STEEL, coated, quiet
from histories import KINDS, PLANES, made
from nacre import fatigue
from nacre.fatigue.history import Rolling
from support import DATA

LOAD, RADIUS = 1e5, 5e-3
WIDTH = (4 * LOAD * RADIUS / (np.pi * STEEL.plane_strain_modulus)) ** 0.5
PEAK = 2 * LOAD / (np.pi * WIDTH)
BELOW, SURFACE, EDGE = 1e-3, 5e-3, 1e-2
"""Relative errors with some hundred cells across: below the surface, at it with friction, and of
values that the edge of the contact decides."""


def rows(name: str) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(
        (DATA / "fatigue" / f"{name}.json").read_text(encoding="utf-8")
    )["rows"]
    return found


@functools.cache
def cylinder(
    ratio: float | None = None,
    thickness: float | None = None,
    half_width: float = 1.0,
    cells: int = 160,
    poisson: float = 0.3,
) -> nacre.Solution:
    """Solve a cylinder on a coat of a thickness in half-widths, of a ratio of moduli."""
    body: Any = nacre.Elastic(STEEL.young, poisson)
    if ratio is not None and thickness is not None:
        body = coated(ratio * STEEL.young, thickness * WIDTH)
    grid = nacre.Grid.line(cells, 2.5 * half_width * WIDTH)
    solution: nacre.Solution = quiet(
        nacre.solve, nacre.Cylinder(RADIUS), body, load=LOAD, grid=grid
    )
    return solution


BARE, COATED = rows("shakedown_bare"), rows("shakedown_coated")


@pytest.mark.parametrize("row", BARE, ids=[f"mu {row['mu']}" for row in BARE])
def test_bare_cylinder(row: dict[str, Any]) -> None:
    (layer,) = fatigue.assess(cylinder(), friction=row["mu"]).layers
    limit, place = PEAK / layer.shakedown[0], layer.shakedown[1]
    tolerance = SURFACE if row["decided"] == "surface" else BELOW
    assert limit == pytest.approx(row["limit"], rel=tolerance)
    # The maximum is flat in depth.
    assert place[2] / WIDTH == pytest.approx(row["z_over_b"], abs=5e-3)
    assert PEAK / layer.first_yield[0] == pytest.approx(row["first_yield"], rel=BELOW)
    tresca = fatigue.assess(cylinder(), friction=row["mu"], rule="in_plane_tresca").layers[0]
    expected = row["tresca_in_plane_limit"]
    assert PEAK / tresca.shakedown[0] == pytest.approx(expected, rel=tolerance)
    assert tresca.shakedown[2][0] == 0.0


@pytest.mark.parametrize(
    "row",
    [
        pytest.param(row, marks=[pytest.mark.slow] if number % 10 else [])
        for number, row in enumerate(COATED)
    ],
    ids=[f"{row['E1_over_E2']} {row['h_over_b0']} {row['mu']}" for row in COATED],
)
def test_coated_cylinder(row: dict[str, Any]) -> None:
    half_width = row["half_width_over_b0"]
    # Cells are a quarter of the thinnest coat at most, and half of that where its surface decides.
    thin = row["h_over_b0"] < 0.2 and row["mu"] > 0
    solution = cylinder(row["E1_over_E2"], row["h_over_b0"], half_width, 320 if thin else 160)
    assert solution.peak_pressure / PEAK == pytest.approx(row["peak_pressure_over_p0"], rel=1e-3)
    summary = quiet(fatigue.assess, solution, friction=row["mu"])
    coat, substrate = summary.layers
    (depth,) = summary.interfaces
    above, below = np.flatnonzero(summary.depths == depth.depth)
    found = {
        "coat": (coat.shakedown[0], coat.first_yield[0]),
        "substrate": (substrate.shakedown[0], substrate.first_yield[0]),
        "interface_coat_side": [summary.profiles[n][above] for n in ("shakedown", "first_yield")],
        "interface_substrate_side": [
            summary.profiles[n][below] for n in ("shakedown", "first_yield")
        ],
    }
    for name, needed in found.items():
        expected = row[name]
        surface = expected.get("z_over_b0", 1.0) < 1e-3 and row["mu"] > 0
        tolerance = SURFACE if surface else BELOW
        assert PEAK / needed[0] == pytest.approx(expected["limit"], rel=tolerance), name
        assert PEAK / needed[1] == pytest.approx(expected["first_yield"], rel=BELOW), name


CONTACTS = [row for row in rows("criteria") if row["kind"] in ("contact", "worst_depth")]
HALF_WIDTHS = {2.0: 0.9, 0.5: 1.13, None: 1.0}


@functools.cache
def judged(
    ratio: float | None, thickness: float | None, cells: int, friction: float, depth: float | None
) -> Any:
    """Return the summary by all criteria with all factors, at all depths or at one.

    Results are named by the classes of criteria, of which each factor has its own.
    """
    solution = cylinder(ratio, thickness, HALF_WIDTHS[ratio], cells)
    criteria = [
        type(f"{kind.__name__} {factor}", (kind,), {})(**dataclasses.asdict(made(name, factor)))
        for name, kind in KINDS.items()
        for factor in (0.0, 0.2, 0.4)
        if factor > 0 or name not in PLANES
        if depth is not None or name not in PLANES
    ]
    depths: list[float] | None = None
    if depth is not None:
        interface = quiet(solution.stress_plan).body.interfaces[0] if depth == thickness else None
        depths = [depth * WIDTH if interface is None else interface]
    return quiet(fatigue.assess, solution, criteria=criteria, friction=friction, depths=depths)


@pytest.mark.parametrize(
    "row",
    [
        pytest.param(row, marks=[pytest.mark.slow] if number % 4 else [])
        for number, row in enumerate(CONTACTS)
    ],
    ids=[
        f"{row.get('E1_over_E2')} {row['mu']} {row.get('z_over_b0')} {row['side']}"
        for row in CONTACTS
    ],
)
def test_criteria_of_contacts(row: dict[str, Any]) -> None:
    contact = row.get("E1_over_E2"), row.get("h_over_b0")
    # The stress at the edge errs by up to 6e-4 of the peak pressure with 240 cells, as its root.
    # Without friction it is all of the tension, a third of what Crossland's criterion adds.
    at_edge = row["mu"] == 0 and row.get("z_over_b0") == 0
    place = 480 if at_edge else 240, row["mu"], row.get("z_over_b0")
    number = 0 if row["side"] in ("coat", "bare") else -1
    layer = judged(*contact, *place).layers[number]
    for name in KINDS:
        for factor, expected in row.get(name, {}).items():
            surface = row.get("edge_peak", False)
            if isinstance(expected, dict):
                surface = expected["z_over_b0"] == 0 and row["mu"] > 0
                expected = expected["value"]
            found = layer.criteria[f"{KINDS[name].__name__} {float(factor)}"][0] / PEAK
            tolerance = 3e-3 if name in ("dang_van", "matake") else BELOW
            assert found == pytest.approx(expected, rel=EDGE if surface else tolerance), name
    expected = row["range_of_sigma_yz"]
    expected = expected["-"]["value"] if isinstance(expected, dict) else expected
    # Cells cut the range at the surface off: 2 μ (p0 − cell).
    assert layer.orthogonal_shear[0] / PEAK == pytest.approx(expected, rel=BELOW, abs=1e-9)


@functools.cache
def by_dang_van(friction: float, *coat: float) -> Any:
    return fatigue.assess(cylinder(*coat), friction=friction, criteria=[made("dang_van", 0.3)])


@pytest.mark.parametrize("thickness", [0.1, 0.5, 2.0])
@pytest.mark.parametrize("friction", [0.0, pytest.param(0.2, marks=pytest.mark.slow)])
def test_equal_layers_are_no_layers(thickness: float, friction: float) -> None:
    bare, summary = by_dang_van(friction), by_dang_van(friction, 1.0, thickness)
    for name, expected in bare.profiles.items():
        found = summary.profiles[name].max()
        assert found == pytest.approx(expected.max(), rel=1e-3), name
    above, below = np.flatnonzero(summary.depths == summary.interfaces[0].depth)
    for values in summary.profiles.values():
        assert values[above] == pytest.approx(values[below], rel=1e-6)


@pytest.mark.slow
def test_the_limit_is_below_both_bounds() -> None:
    for friction in (0.0, 0.1, 0.3):
        summary = fatigue.assess(cylinder(2.0, 0.3), friction=friction)
        needed = summary.profiles
        # The range of σ_yz is between its extremes, one of them is half of it at least.
        assert np.all(needed["shakedown"] >= 0.5 * needed["orthogonal_shear"] * (1 - 1e-12))
        assert np.all(needed["shakedown"] >= 0.5 * needed["first_yield"] * (1 - 1e-12))
        assert np.all(needed["shakedown"] <= needed["first_yield"])


@pytest.mark.parametrize("part", np.linspace(0.05, 0.15, 5))
def test_the_place_of_the_edge_within_its_cell_does_not_matter(part: float) -> None:
    """The edge lies 0.05 cells outside a centre to 0.05 inside, where states nearly coincide."""
    step = 2 * WIDTH / (76.8 + 2 * part)
    grid = nacre.Grid.line(96, 96 * step)
    solution = nacre.solve(nacre.Cylinder(RADIUS), STEEL, load=LOAD, grid=grid)
    (layer,) = fatigue.assess(solution, friction=0.4, depths=[0.0]).layers
    assert PEAK / layer.shakedown[0] == pytest.approx(2.3162, rel=SURFACE)


def test_incompressible_surface_shakes_down_at_one_over_friction() -> None:
    """ν = ½: von Mises and Tresca in the plane agree, so that the limit is 1/μ."""
    (layer,) = fatigue.assess(cylinder(poisson=0.5), friction=0.4).layers
    assert cylinder(poisson=0.5).peak_pressure / layer.shakedown[0] == pytest.approx(2.5, rel=5e-3)


def test_the_residual_stress_of_the_optimum_makes_first_yield_the_limit() -> None:
    (layer,) = fatigue.assess(cylinder(), friction=0.1).layers
    k, (_, _, z), residual = layer.shakedown
    rolling = Rolling(cylinder(), "body", None, None, None)
    history = rolling.stress([z], "below", True)[0].at(0.1)
    history[..., :2] += residual
    # The states of the grid, without those between them.
    assert fatigue.shakedown(history).first_yield[0] == pytest.approx(k, rel=1e-5)


def test_equal_residual_stresses_change_first_yield_alone() -> None:
    plain, stressed = (
        fatigue.assess(cylinder(), residual=residual, depths=[0.5 * WIDTH]).layers[0]
        for residual in (None, [-0.3e9])
    )
    assert stressed.shakedown[0] == pytest.approx(plain.shakedown[0], rel=1e-12)
    assert stressed.shakedown[2] == pytest.approx([r + 0.3e9 for r in plain.shakedown[2]], rel=1e-9)
    assert stressed.first_yield[0] != pytest.approx(plain.first_yield[0], rel=1e-2)


@pytest.mark.parametrize(("friction", "expected"), [(0.0, 4.675), (0.2, 3.683)])
def test_point_contact(friction: float, expected: float) -> None:
    """Bare circle, ν = .3: the numbers of one program, for residual stresses of the depth alone."""
    ball = nacre.solve(nacre.Sphere(RADIUS), STEEL, load=10.0)
    radius = (0.75 * 10.0 * RADIUS / STEEL.plane_strain_modulus) ** (1 / 3)
    pressure = 1.5 * 10.0 / (np.pi * radius**2)
    summary = quiet(fatigue.assess, ball, friction=friction)
    assert summary.is_estimate
    assert "estimate" in str(summary)
    # 64 cells along the diameter.
    assert pressure / summary.layers[0].shakedown[0] == pytest.approx(expected, rel=2e-3)


def test_the_middle_of_a_long_roller_is_a_line_contact() -> None:
    shape = nacre.Paraboloid(100.0, RADIUS)
    grid = nacre.Grid((48, 96), (48e-3, 2.5 * WIDTH))
    roller = quiet(nacre.solve, shape, STEEL, grid=grid, load=LOAD * 30e-3)
    line = nacre.solve(
        nacre.Cylinder(RADIUS),
        STEEL,
        grid=nacre.Grid.line(96, 2.5 * WIDTH),
        load=float(roller.line_load.max()),
    )
    found, expected = (quiet(fatigue.assess, one, friction=0.1) for one in (roller, line))
    for name, needed in expected.profiles.items():
        # Its half-length is 200 half-widths or more, and its pressure falls along it.
        assert found.profiles[name].max() == pytest.approx(needed.max(), rel=5e-3)
    assert abs(found.layers[0].shakedown[1][0]) < 2e-3


def test_known_tractions_of_full_slip_are_those_of_friction() -> None:
    grid = nacre.Grid.line(160, 2.5 * WIDTH)
    slid = nacre.slide(
        nacre.Cylinder(RADIUS),
        STEEL,
        STEEL,
        load=0.5 * LOAD,
        grid=grid,
        friction=0.1,
        shift=(0.0, 1e-3),
    )
    assert slid.report.full_slip
    limits = fatigue.DangVan(bending=520e6, torsion=330e6)
    known = quiet(fatigue.assess, slid, criteria=[limits])
    given = quiet(fatigue.assess, slid.normal, friction=0.1, criteria=[limits])
    # Between the edges, tractions are uniform over cells. Without the edges, the yield stress that
    # the surface needs is 2 % too small.
    for name in ("shakedown", "first_yield", "orthogonal_shear", "DangVan"):
        for region in (known.depths > 0.1 * WIDTH, known.depths == 0.0):
            found = known.profiles[name][region].max()
            same = given.depths > 0.1 * WIDTH if known.depths[region].all() else given.depths == 0.0
            assert found == pytest.approx(given.profiles[name][same].max(), rel=2e-3), name
    with pytest.raises(ValueError, match="friction must be 0: the tractions are known"):
        fatigue.assess(slid, friction=0.1)


def test_both_bodies_of_equal_constants_need_the_same() -> None:
    solution = nacre.solve(
        nacre.Cylinder(RADIUS), STEEL, STEEL, load=LOAD, grid=nacre.Grid.line(96, 2e-4)
    )
    one = fatigue.assess(solution, friction=0.2)
    # The traction is the other way, and the sign of friction changes no result.
    other = fatigue.assess(solution, friction=0.2, body="counterbody")
    for name, needed in one.profiles.items():
        assert other.profiles[name].max() == pytest.approx(needed.max(), rel=1e-6)


def test_the_history_beyond_the_grid_is_that_of_a_wider_grid() -> None:
    """The largest tension trails near y = −2 z/μ: 12 half-widths behind."""
    narrow = cylinder(2.0, 1.0, 1.0, 160)
    wide = nacre.solve(
        nacre.Cylinder(RADIUS),
        narrow.report.body,
        load=LOAD,
        grid=nacre.Grid.line(160 * 16, 2.5 * WIDTH * 16),
    )
    z = 1.2 * WIDTH
    criteria = [made("findley", 0.4)]
    for depth in (0.5 * WIDTH, z):
        one, other = (
            fatigue.assess(solution, friction=0.2, criteria=criteria, depths=[depth]).layers[-1]
            for solution in (narrow, wide)
        )
        found, expected = one.criteria["Findley"], other.criteria["Findley"]
        assert found[0] == pytest.approx(expected[0], rel=3e-4)


@pytest.mark.slow
def test_map_of_shakedown_is_the_summary_at_each_friction() -> None:
    solution = cylinder(2.0, 0.3)
    found = fatigue.shakedown_map(solution, friction=[0.2, 0.0])
    assert found.limits.shape == found.first_yield.shape == found.depths.shape == (2, 2)
    for number, friction in enumerate([0.2, 0.0]):
        summary = fatigue.assess(solution, friction=friction)
        for layer, part in enumerate(summary.layers):
            k, (_, _, z), _ = part.shakedown
            assert found.limits[layer, number] == solution.peak_pressure / k
            assert found.depths[layer, number] == z


def test_a_stiff_coat_of_a_third_of_the_half_width_lowers_the_limit_of_the_substrate() -> None:
    (bare,) = fatigue.assess(cylinder()).layers
    _, substrate = fatigue.assess(cylinder(2.0, 0.3, 0.9)).layers
    assert PEAK / bare.shakedown[0] == pytest.approx(4.0, rel=1e-3)
    assert PEAK / substrate.shakedown[0] == pytest.approx(3.4998, rel=1e-3)


def test_matake_says_where_its_plane_may_jump() -> None:
    history = np.zeros((2, 6))
    # Two shears in different planes, of which one is half a per cent less.
    history[0, 4], history[1, 3] = 1.0, 0.995
    twice = np.vstack([history, -history])
    _, _, gap = made("matake", 0.2)._equivalent_stress(twice[None])
    assert 0.0 < gap[0] < 0.011
