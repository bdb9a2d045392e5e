"""Stress from Python: shapes, sections, both bodies, residual stress, summary, errors, progress."""

import csv
import math
import os
import pickle
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, COATED, HARD, ROD, STEEL, quiet
from nacre import fatigue
from nacre._tools.units import written
from support import assert_close, interrupted

GRID = nacre.Grid(shape=(41, 31), size=(4.1e-4, 3.1e-4))

# Sums over a thousand cells, of numbers of the order of the peak pressure.
ROUNDING = 1e-12


@pytest.fixture(scope="module")
def solution() -> nacre.Solution:
    """Press a sphere of another material into the coated body."""
    return nacre.solve(BALL, COATED, HARD, grid=GRID, load=5.0)


def same(a: Any, b: Any, solution: nacre.Solution) -> None:
    assert_close(a, b, rtol=0.0, atol=ROUNDING * solution.peak_pressure)


def test_axes_that_are_numbers_are_dropped(solution: nacre.Solution) -> None:
    depths = [0.0, 10e-6, 50e-6]
    assert solution.stress(depths).xx.shape == (3, 41, 31)
    assert solution.stress(10e-6).von_mises.shape == (41, 31)
    assert solution.stress([10e-6]).max_shear.shape == (1, 41, 31)
    assert solution.stress(depths, y=0.0).tresca.shape == (3, 41)
    assert solution.stress(depths, x=0.0).zz.shape == (3, 31)
    assert solution.stress(depths, x=0.0, y=0.0).principal[0].shape == (3,)
    assert solution.stress(10e-6, x=0.0, y=0.0).xz.shape == ()
    assert solution.stress([]).xx.shape == (0, 41, 31)


def test_sections_are_those_of_the_planes(solution: nacre.Solution) -> None:
    depths = np.array([0.0, 5e-6, 40e-6])
    planes = solution.stress(depths, friction=0.2, direction=(1.0, 0.0), displacement=True)
    along = solution.stress(
        depths, friction=0.2, direction=(1.0, 0.0), displacement=True, y=GRID.y[12]
    )
    between = solution.stress(
        depths, x=0.5 * (GRID.x[3] + GRID.x[4]), friction=0.2, direction=(1.0, 0.0)
    )
    for name in ("xx", "yy", "zz", "xy", "yz", "xz"):
        plane = getattr(planes, name)
        assert np.array_equal(getattr(along, name), plane[:, :, 12])
        middle = 0.5 * (plane[:, 3] + plane[:, 4])
        same(getattr(between, name), middle, solution)
    assert np.array_equal(along.uz, planes.uz[:, :, 12])
    assert np.array_equal(along.y, [GRID.y[12]])


def test_the_free_function_takes_pressure_as_uniform(solution: nacre.Solution) -> None:
    # Five cells deep a solution's stresses differ by the edge alone, which it knows.
    depths = [0.0, 5e-5]
    field = nacre.stress(
        COATED, GRID, solution.pressure, depths, friction=0.1, direction=(1.0, 0.0)
    )
    known = solution.stress(depths, friction=0.1, direction=(1.0, 0.0))
    assert_close(known.xx[1], field.xx[1], rtol=0.0, atol=1e-3 * solution.peak_pressure)
    assert np.abs(known.xx[0] - field.xx[0]).max() > 1e-3 * solution.peak_pressure
    assert np.array_equal(known.zz[0], -solution.pressure)
    same(known.zz[0], field.zz[0], solution)
    same(-field.zz[0], solution.pressure, solution)
    assert field.body == COATED
    assert field.friction == (0.1, 0.0)


def test_displacements_of_both_surfaces_are_that_of_the_solution(solution: nacre.Solution) -> None:
    body = solution.stress(0.0, displacement=True)
    counterbody = solution.stress(0.0, displacement=True, body="counterbody")
    assert counterbody.body == nacre.HalfSpace(HARD)
    total = body.uz + counterbody.uz
    # Influence coefficients keep 1e-9, those of stress 1e-9 of the largest.
    assert_close(total, solution.displacement, rtol=3e-9)
    with pytest.raises(AttributeError, match=r"^displacements were not evaluated"):
        _ = solution.stress(0.0).uz


NARROW = nacre.Grid((41, 64), (4.1e-4, 2e-4))


def test_friction_acts_along_the_rolling_direction(tmp_path: Path) -> None:
    roller = nacre.Roller(5e-3, flat_length=1e-4, crown_radius=0.01)
    solution = nacre.solve(roller, COATED, HARD, grid=NARROW, load=5.0)
    assert roller.rolling_direction == solution.report.rolling_direction == (0.0, 1.0)
    field = solution.stress(0.0, friction=0.3)
    assert field.friction == (0.0, 0.3)
    assert solution.stress(0.0, friction=0.3, body="counterbody").friction == (0.0, -0.3)
    # Files and pickles keep it.
    again = nacre.load(solution.save(tmp_path / "roller.nc"))
    assert again.stress(0.0, friction=0.3) == field
    assert pickle.loads(pickle.dumps(solution)).report.rolling_direction == (0.0, 1.0)


def test_below_a_body_of_revolution_friction_acts_along_x(
    solution: nacre.Solution, tmp_path: Path
) -> None:
    along: dict[str, Any] = {"friction": 0.3, "direction": (1, 0)}
    plan = solution.stress_plan()
    assert BALL.is_round
    assert solution.report.rolling_direction == (1.0, 0.0)
    for kept in (solution, nacre.load(solution.save(tmp_path / "ball.nc"))):
        assert kept.stress(0.0, friction=0.3) == plan.stress(0.0, friction=0.3)
        assert kept.stress(0.0, friction=0.3) == solution.stress(0.0, **along)
        assert kept.stress_summary(friction=0.3) == solution.stress_summary(**along)
    assert solution.verdict(friction=0.3) == solution.verdict(**along)
    # Rolling has its own: the section along y.
    across = fatigue.assess(solution, friction=0.3, direction=(0, 1))
    assert fatigue.assess(solution, friction=0.3) == across


@pytest.mark.filterwarnings("ignore")
def test_friction_is_asked_for_its_direction(solution: nacre.Solution) -> None:
    message = r"^direction must be given where friction is above 0: only rollers, cylinders and li"
    oval, ended = nacre.Paraboloid(5e-3, 4e-3), nacre.HalfSpace(STEEL, ends=(-9.5e-5, None))
    assert not oval.is_round
    for shape, body, motion in (
        (oval, COATED, {}),
        (BALL.shifted(1e-5, 0.0), COATED, {}),
        (BALL, COATED, {"tilt": (1e-3, None)}),
        (BALL, COATED, {"eccentricity": (1e-5, None)}),
        (BALL, ended, {}),
        (BALL, COATED, {"hardness": np.full(GRID.shape, 9e9)}),
    ):
        pressed = nacre.solve(shape, body, grid=GRID, load=1.0, **motion)
        plan = pressed.stress_plan()
        for call in (pressed.stress, plan.stress):
            with pytest.raises(ValueError, match=message):
                call(0.0, friction=0.1)
        with pytest.raises(ValueError, match=message):
            pressed.stress_summary(friction=0.1)
        assert pressed.report.rolling_direction is None
    with pytest.raises(ValueError, match=message):
        nacre.stress(COATED, GRID, solution.pressure, 0.0, friction=0.1)
    # A report of an earlier version does not know it, and reads as one without.
    roller = nacre.solve(nacre.Roller(5e-3, 1e-4, 0.01), COATED, grid=NARROW, load=5.0)
    state = roller.to_dict()
    del state["report"]["rolling_direction"]
    with pytest.raises(ValueError, match=message):
        nacre.Solution.from_dict(state).stress(0.0, friction=0.1)


@pytest.mark.parametrize("cells", [64, 128])
def test_the_uncertainty_of_known_tractions_holds_at_the_surface(cells: int) -> None:
    """In full slip, against tractions that follow the pressure within cells."""
    grid = nacre.Grid(shape=(cells, cells), size=(2.4e-4, 2.4e-4))
    slid = nacre.slide(BALL, STEEL, STEEL, load=10.0, grid=grid, friction=0.3, shift=(1e-4, 0.0))
    assert slid.report.full_slip
    within = slid.normal.stress(0.0, friction=0.3, direction=(1.0, 0.0))
    uniform = slid.stress(0.0)
    assert within.uncertainty is not None
    assert uniform.uncertainty is not None
    largest = max(
        float(np.abs(uniform.components[name] - within.components[name]).max())
        for name in ("xx", "yy", "xy")
    )
    assert largest > 3.0 * within.uncertainty[0]
    assert largest <= uniform.uncertainty[0] < 3.0 * largest
    # Between centres they follow the pressure within cells.
    x, y = grid.x[cells // 2], grid.y[cells // 2] + 0.25 * grid.spacing[1]
    one = slid.stress(0.0, x=float(x), y=float(y))
    assert one.uncertainty is not None
    assert one.uncertainty[0] < 0.2 * uniform.uncertainty[0]


def test_a_line_contact_slides_across_its_strips_and_has_the_same_datum() -> None:
    grid = nacre.Grid.line(64, 3e-4)
    solution = nacre.solve(ROD, COATED, grid=grid, load=2e4)
    field = solution.stress(0.0, friction=0.1)
    assert field.friction == (0.0, 0.1)
    uniform = nacre.stress(COATED, grid, solution.pressure, 0.0, friction=0.1)
    assert uniform.friction == (0.0, 0.1)
    surface = solution.stress(0.0, displacement=True)
    assert_close(surface.uz, solution.displacement, rtol=1e-8)


def test_a_stress_says_how_well_its_depth_is_resolved(solution: nacre.Solution) -> None:
    field = solution.stress([0.0, 5e-6, 40e-6, 4e-4])
    errors = field.uncertainty
    assert errors is not None
    assert (np.diff(errors) < 0.0).all()
    assert errors[0] < 0.2 * solution.peak_pressure
    assert errors[-1] < 1e-6 * solution.peak_pressure
    assert pickle.loads(pickle.dumps(field)).uncertainty.tolist() == errors.tolist()
    assert nacre.stress(COATED, GRID, solution.pressure, 0.0).uncertainty is None
    coating, substrate = solution.stress_summary().layers
    assert coating.uncertainty.keys() == {"von_mises", "tension", "max_shear"}
    value, _ = substrate.von_mises
    # Other places, and the width of some ten cells, leave more uncertain than the place does.
    assert 0.0 < substrate.uncertainty["von_mises"] < 5e-2 * value


def test_stresses_that_cells_do_not_resolve_are_warned_of() -> None:
    # A soft coating of an eighth of a cell: the tension on its faces is off by as much as itself.
    coating = nacre.Layer(nacre.Elastic(4.6e9, 0.45), 1.25e-6)
    body = nacre.HalfSpace(STEEL, [coating])
    solution = nacre.solve(nacre.Sphere(2e-2), body, grid=GRID, approach=1e-6)
    with pytest.warns(nacre.NacreWarning, match=r"^the extremes in layers\[0\] are uncertain, "):
        summary = solution.stress_summary()
    coating_stress = summary.layers[0]
    assert coating_stress.uncertainty["tension"] > 0.25 * coating_stress.tension[0]
    # A quarter is warned of.
    assert coating_stress.uncertainty["von_mises"] < 0.25 * coating_stress.von_mises[0]
    assert "von Mises by" not in summary.warnings[0]
    # Errors must fall to a quarter of the stress or a fiftieth of the largest one.
    largest = max(layer.von_mises[0] for layer in summary.layers)
    times = math.ceil(
        max(
            error / max(0.25 * getattr(coating_stress, name)[0], 0.02 * largest)
            for name, error in coating_stress.uncertainty.items()
        )
    )
    cells = f"cells {times} times smaller" if times < 10 else "much smaller cells"
    named = f"due to the size of the cells: take {cells}"
    assert summary.warnings[0].endswith(named)
    assert f"warning: {summary.warnings[0]}" in str(summary)
    # A sharp edge has no pressure to reconstruct.
    with pytest.warns(nacre.NacreWarning, match="reaches a sharp edge"):
        punch = nacre.solve(nacre.FlatPunch(1e-4), STEEL, grid=GRID, load=5.0)
    with pytest.warns(nacre.NacreWarning, match=r"^at the surface the stress is uncertain by "):
        field = punch.stress([0.0, 1e-4])
    assert len(field.warnings) == 1
    assert punch.stress(1e-4).warnings == []


def test_residual_stress_is_added_in_its_layer(solution: nacre.Solution) -> None:
    depths = [10e-6, 30e-6]
    without = solution.stress(depths)
    both: list[Any] = [{0: -2e9, "substrate": 1e8}, [-2e9, 1e8]]
    for residual in both:
        field = solution.stress(depths, residual=residual)
        for name in ("xx", "yy"):
            added = getattr(field, name) - getattr(without, name)
            assert_close(added[0], -2e9, rtol=1e-12)
            assert_close(added[1], 1e8, rtol=1e-12)
        assert np.array_equal(field.zz, without.zz)
        assert np.array_equal(field.xy, without.xy)


def test_invariants_are_those_of_the_components(solution: nacre.Solution) -> None:
    field = solution.stress([3e-6, 30e-6], friction=0.4, direction=(1.0, 1.0), y=0.0)
    tensor = np.array(
        [
            [field.xx, field.xy, field.xz],
            [field.xy, field.yy, field.yz],
            [field.xz, field.yz, field.zz],
        ]
    )
    values = np.linalg.eigvalsh(np.moveaxis(tensor, (0, 1), (-2, -1)))[..., ::-1]
    for k in range(3):
        same(field.principal[k], values[..., k], solution)
    same(field.tresca, values[..., 0] - values[..., 2], solution)
    same(field.max_shear, 0.5 * field.tresca, solution)
    deviator = values - values.mean(axis=-1, keepdims=True)
    same(field.von_mises, np.sqrt(1.5 * (deviator**2).sum(axis=-1)), solution)
    value, (x, y, z) = field.peak("tension")
    assert value == field.principal[0].max()
    assert field.principal[0][list(field.z).index(z), list(field.x).index(x)] == value
    assert y == 0.0


@pytest.mark.slow
def test_the_summary_holds_the_extremes(solution: nacre.Solution, tmp_path: Path) -> None:
    summary = solution.stress_summary(
        yield_stress={"substrate": 2e9},
        strength=[1e9, None],
        friction=0.2,
        direction=(1.0, 0.0),
        residual={0: -1e9},
    )
    coating, substrate = summary.layers
    (interface,) = summary.interfaces
    depths = np.linspace(0.0, 20e-6, 41)
    fine = solution.stress(
        depths, side="above", friction=0.2, direction=(1.0, 0.0), residual={0: -1e9}
    )
    # Parabolas between depths: the second order of what is left between them.
    assert coating.von_mises[0] == pytest.approx(fine.von_mises.max(), rel=2e-3)
    assert coating.tension[0] == pytest.approx(fine.principal[0].max(), rel=2e-3)
    fine = solution.stress(20e-6 + np.linspace(0.0, 150e-6, 76), friction=0.2, direction=(1.0, 0.0))
    value, (_, _, z) = substrate.von_mises
    assert value == pytest.approx(fine.von_mises.max(), rel=1e-3)
    assert z == pytest.approx(fine.peak("von_mises")[1][2], abs=3e-6)
    assert substrate.max_shear[0] == pytest.approx(fine.max_shear.max(), rel=1e-3)
    assert substrate.yield_safety_factor == 2e9 / value
    assert coating.yield_safety_factor is None
    assert coating.strength_safety_factor == pytest.approx(1e9 / coating.tension[0])
    assert substrate.strength_safety_factor is None
    above = solution.stress(
        20e-6, side="above", friction=0.2, direction=(1.0, 0.0), residual={0: -1e9}
    )
    below = solution.stress(20e-6, friction=0.2, direction=(1.0, 0.0))
    assert interface.depth == 20e-6
    assert interface.shear[0] == pytest.approx(np.hypot(below.xz, below.yz).max(), rel=1e-12)
    assert interface.tension[0] == pytest.approx(below.zz.max(), rel=1e-9)
    assert interface.compression[0] == pytest.approx(below.zz.min(), rel=1e-12)
    jump = [getattr(below, name) - getattr(above, name) for name in ("xx", "yy", "xy")]
    largest = abs(jump[0] + jump[1]) / 2 + np.hypot((jump[0] - jump[1]) / 2, jump[2])
    assert interface.jump is not None
    assert interface.jump[0] == pytest.approx(largest.max(), rel=1e-12)
    assert nacre.load(summary.save(tmp_path / "a.nc")) == summary
    frame = summary.to_xarray().to_dataframe().set_index(["part", "quantity"])
    shear = frame.loc[("interfaces[0]", "shear")]
    assert (shear.value, (shear.x, shear.y, shear.z)) == interface.shear
    mises = frame.loc[("the substrate", "von_mises")]
    assert (mises.value, mises.uncertainty) == (
        substrate.von_mises[0],
        substrate.uncertainty["von_mises"],
    )
    assert mises.safety_factor == substrate.yield_safety_factor
    with summary.save(tmp_path / "a.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if line[0] != "#"))
    assert [float(row["value"]) for row in rows] == frame.value.tolist()
    lines = str(summary).split("\n\n")[1].splitlines()  # below the verdict
    assert max(len(line) for line in lines if not line.startswith("warning")) <= 100
    assert [line.split("  ")[0] for line in lines if line[0] not in " w"] == [
        "layers[0], 0 m to 20 µm",
        "substrate",
        "interfaces[0] at 20 µm",
        "friction 0.2, traction along (1, 0)",
    ]
    assert "safety factor" in lines[0]
    (row,) = (line for line in lines if line.startswith("substrate"))
    assert written(value, "Pa") in row
    assert row.endswith(f"  {2e9 / value:.3g}")
    assert summary.finished


@pytest.mark.slow
def test_names_of_layers_are_keys_and_are_shown() -> None:
    hard, soft = nacre.Elastic(420e9, 0.3), nacre.Elastic(250e9, 0.3)
    layers = [
        nacre.Layer(hard, 2e-6, name="TiN"),
        nacre.Layer(soft, 1e-6),
        nacre.Layer(hard, 2e-6, name="TiN"),
        nacre.Layer(soft, 3e-6, name="CrN"),
    ]
    solution = nacre.solve(BALL, nacre.HalfSpace(STEEL, layers), load=10.0)
    assert "layers[0] TiN" in str(solution)
    assert "layers[1]   " in str(solution)
    # A name stands for all layers that have it.
    named = solution.stress_summary(strength={"TiN": 1e9, "CrN": 2e9}, residual={"TiN": -1e9})
    numbered = solution.stress_summary(
        strength={0: 1e9, 2: 1e9, 3: 2e9}, residual={0: -1e9, 2: -1e9}
    )
    assert named == numbered
    assert [layer.name for layer in named.layers] == ["TiN", None, "TiN", "CrN", None]
    assert nacre.types.StressSummary.from_dict(named.to_dict()) == named
    rows = [line.split("  ")[0] for line in str(named).splitlines()]
    assert "layers[0] TiN, 0 m to 2 µm" in rows
    assert "layers[1], 2 µm to 3 µm" in rows
    assert "interfaces[3] below CrN at 8 µm" in rows
    with pytest.raises(ValueError, match=r"names of layers \(TiN, TiN, CrN\), got 'DLC'"):
        solution.stress_summary(strength={"DLC": 1.0})


def test_fields_are_values(solution: nacre.Solution) -> None:
    field = solution.stress(
        [0.0, 30e-6], y=0.0, friction=0.1, direction=(1.0, 0.0), displacement=True
    )
    assert field != solution.stress([0.0, 30e-6], y=0.0)
    assert repr(field).startswith("<Stress: depths 2 from 0")
    assert not field.xx.flags.writeable


# Plans, progress and interrupts.


@pytest.mark.parametrize("body", ["body", "counterbody"])
def test_a_plan_gives_the_bits_of_the_solution(solution: nacre.Solution, body: Any) -> None:
    plan = solution.stress_plan(body, threads=1)
    report = solution.report
    assert plan.body == (report.body if body == "body" else report.counterbody)
    sliding: dict[str, Any] = {"friction": 0.2, "direction": (1.0, 0.0)}
    section: dict[str, Any] = {"y": 0.0, "side": "above", "displacement": True}
    limits: dict[str, Any] = {"yield_stress": {"substrate": 2e9}, "residual": [-1e9]}
    for _ in range(2):
        assert plan.stress(1e-5, **sliding) == solution.stress(1e-5, body=body, **sliding)
        whole = solution.stress([0.0, 2e-5], body=body, **section)
        assert plan.stress([0.0, 2e-5], **section) == whole
        assert plan.summary(**limits) == solution.stress_summary(body=body, **limits)


@pytest.mark.parametrize("body", ["body", "counterbody"])
def test_a_summary_says_along_which_direction_friction_acts(body: Any, tmp_path: Path) -> None:
    """The direction is across the axis of a roller unless it is given, as in `stress`."""
    roller = nacre.Roller(5e-3, flat_length=2e-3, crown_radius=0.5)
    grid = nacre.Grid((24, 24), (4e-3, 2e-4))
    solution = nacre.solve(roller, STEEL, STEEL, load=100.0, grid=grid)
    sign = 1 if body == "body" else -1
    along: dict[str, Any] = {"direction": (3.0, -4.0)}
    across: dict[str, Any] = {}
    for given, (x, y) in ((across, (0.0, 1.0)), (along, (0.6, -0.8))):
        sliding: dict[str, Any] = {"friction": 0.1, **given}
        summary = solution.stress_summary(body=body, **sliding)
        assert summary.friction == pytest.approx((0.1 * sign * x, 0.1 * sign * y), rel=1e-15)
        field = solution.stress(1e-5, body=body, **sliding)
        assert summary.friction == pytest.approx(field.friction, rel=1e-15)
        assert solution.stress_plan(body).summary(**sliding) == summary
        said = f"friction 0.1, traction along ({sign * x + 0.0:g}, {sign * y:g})"
        assert said in str(summary).splitlines()
        assert f"<p>{said}" in summary._repr_html_()
        assert nacre.load(summary.save(tmp_path / "a.nc")) == summary
        assert f"# friction: {summary.friction}" in summary.save(tmp_path / "a.csv").read_text()
    frictionless = solution.stress_summary(body=body)
    assert frictionless.friction == (0.0, 0.0)
    assert "friction" not in str(frictionless)
    # Files of earlier versions do not know it.
    state = summary.to_dict()
    del state["friction"]
    assert nacre.types.StressSummary.from_dict(state).friction is None
    with pytest.raises(ValueError, match='key "friction" does not fit'):
        nacre.types.StressSummary.from_dict(state | {"friction": [1.0]})


def test_extremes_of_partial_slip_beyond_the_grid() -> None:
    """Below a stiff coating the interface is pulled outside the contact."""
    body = nacre.HalfSpace(
        nacre.Elastic(70e9, 0.3), [nacre.Layer(nacre.Elastic(420e9, 0.2), 20e-6)]
    )
    slip: dict[str, Any] = {"load": 50.0, "friction": 0.3, "force": (10.0, 5.0)}
    radius = 0.17e-3  # of the contact
    tensions = []
    for wide in (1, 4):
        grid = nacre.Grid((48 * wide, 48 * wide), (2.4 * radius * wide, 2.4 * radius * wide))
        solution = nacre.slide(nacre.Sphere(10e-3), body, grid=grid, **slip)
        tensions.append(solution.stress_summary().interfaces[0].tension)
    (narrow, (x, y, _)), (wide_value, _) = tensions
    assert max(abs(x), abs(y)) > 1.2 * radius
    assert narrow == pytest.approx(wide_value, rel=2e-3)  # growth at which the search ends


def test_refinement_keeps_an_extreme_beyond_the_grid() -> None:
    """The tension that trails a sliding ball: 20.90 MPa on a wide and finer grid."""
    body = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(300e9, 0.2), 20e-6)])
    grid = nacre.Grid((24, 24), (2.1e-4, 2.1e-4))
    solution = nacre.solve(nacre.Sphere(12.7e-3), body, load=7.15, grid=grid)
    sliding: dict[str, Any] = {"friction": 0.2, "direction": (1.0, 0.0)}
    errors = []
    for refine in (None, 0.05):
        coating, substrate = solution.stress_summary(**sliding, refine=refine).layers
        value, (x, _, _) = substrate.tension
        assert x < -0.5 * grid.size[0]
        errors.append(substrate.uncertainty["tension"])
        # Merging leaves 0.2 % of stresses beyond the grid; below the edge, cells leave much more.
        assert abs(value - 20.90e6) < min(errors[-1], 0.02 * value)
    # An extreme counts as known within `refine` of 8 % of the largest von Mises stress.
    assert errors[1] < max(errors[0], 0.05 * 0.08 * coating.von_mises[0])


def test_an_interface_under_compression_has_no_tension_far_away() -> None:
    """Below a soft coating, compression everywhere leaves no tension, wherever one looks."""
    body = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(100e9, 0.3), 20e-6)])
    grid = nacre.Grid((64, 64), (2e-4, 2e-4))
    solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0, grid=grid)
    tension, (x, y, _) = solution.stress_summary().interfaces[0].tension
    assert abs(tension) < 1e-6 * solution.peak_pressure
    assert max(abs(x), abs(y)) < 1e-2


class StopError(Exception):
    """Raised by a callback."""


@pytest.mark.parametrize("planned", [False, True])
def test_progress_stops_and_raises(solution: nacre.Solution, planned: bool, tmp_path: Path) -> None:
    plan: Any = solution.stress_plan()
    stress = plan.stress if planned else solution.stress
    summary = plan.summary if planned else solution.stress_summary
    parts: list[float] = []
    stress([0.0, 1e-6, 2e-6], progress=parts.append)
    assert parts == sorted(parts)
    assert (parts[0], parts[-1]) == (0.0, 1.0)
    stopped = stress([0.0, 1e-6, 2e-6], progress=lambda part: part < 0.5)
    assert stopped.xx.shape == (1, 41, 31)
    assert list(stopped.z) == [0.0]
    assert not summary(progress=lambda part: part < 0.1).finished
    nothing = summary(progress=lambda _: False)
    assert nacre.load(nothing.save(tmp_path / "a.nc")) == nothing
    assert nothing.to_xarray().attrs["finished"] == "False"
    assert "# finished: False" in nothing.save(tmp_path / "a.csv").read_text()

    def fail(part: float) -> None:
        raise StopError

    with pytest.raises(StopError):
        stress([0.0, 1e-5], progress=fail)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_interrupts_a_plan() -> None:
    # Hundreds of layers make a depth slow.
    setup = """
import nacre, numpy as np
from bodies import BALL, HARD, STEEL
body = nacre.HalfSpace(STEEL, 300 * [nacre.Layer(HARD, 1e-6)])
grid = nacre.Grid(shape=(64, 64), size=(3e-4, 3e-4))
plan = nacre.solve(BALL, body, grid=grid, load=5.0).stress_plan()
depths = np.linspace(0.0, 1e-3, 10_000)
"""
    assert interrupted(setup, "plan.stress(depths, friction=0.3, direction=(1.0, 0.0))") == 0


def test_refined_extremes_agree_with_a_finer_grid() -> None:
    """On a patch of finer cells, extremes of a thin stiff coating are those of a finer grid.

    The bar is the sum of both estimated errors, and the patch must keep what was asked for.
    """
    steel = nacre.Elastic(210e9, 0.3)
    body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(400e9, 0.25), 4e-6)])
    width, cells = 4e-4, 48
    grid = nacre.Grid.line(cells, width)
    finer = nacre.Grid.line(8 * cells, width)
    solve = partial(nacre.solve, nacre.Cylinder(5e-3), body, steel, load=1e5)
    refined = solve(grid=grid).stress_summary(friction=0.2, refine=0.05)
    fine = solve(grid=finer).stress_summary(friction=0.2)
    for part, name in ((0, "tension"), (0, "von_mises")):
        value, _ = getattr(refined.layers[part], name)
        error = refined.layers[part].uncertainty[name]
        assert error <= 0.05 * value or error < 0.02 * refined.layers[0].von_mises[0]
        expected = getattr(fine.layers[part], name)[0]
        assert abs(value - expected) <= error + fine.layers[part].uncertainty[name]
    shear, error = refined.interfaces[0].shear[0], refined.interfaces[0].uncertainty["shear"]
    assert error <= 0.05 * shear
    expected, own = fine.interfaces[0].shear[0], fine.interfaces[0].uncertainty["shear"]
    assert abs(shear - expected) <= error + own


def test_refine_may_be_true_or_false() -> None:
    pressed = quiet(
        nacre.solve, nacre.Cylinder(5e-3), STEEL, load=1e5, grid=nacre.Grid.line(24, 4e-4)
    )
    summary = partial(pressed.stress_summary, friction=0.2)
    assert summary(refine=True) == summary(refine=0.05) != summary() == summary(refine=False)
    assert pressed.verdict(friction=0.2, refine=True) == summary(refine=0.05).verdict()


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*uncertain", "ignore:a body with layers has a free end")
def test_the_shear_below_a_thin_coat_of_a_roller_with_free_ends_is_refined() -> None:
    """Cells thrice as wide as the coat is thick leave the shear at its interface unknown.

    Refined, it is that on a grid with cells an eighth as wide. Cells beside the ends stay as wide
    as they are, and their error is that of the extreme.
    """
    half = 1e-3
    coat = nacre.Layer(nacre.Elastic(600e9, 0.25), 4e-6)
    body = nacre.HalfSpace(STEEL, [coat], ends=(-half, half))
    profile = nacre.LogarithmicProfile.iso16281(10e-3, 2 * half)
    roller = nacre.Roller(radius=5e-3, profile=profile, length=2 * half)
    solve = partial(nacre.solve, roller, body, STEEL, load=300.0)
    coarse = solve(grid=nacre.Grid((24, 24), (2 * half, 3e-4)))
    (rough,) = coarse.stress_summary().interfaces
    (refined,) = coarse.stress_summary(refine=0.05).interfaces
    fine = solve(grid=nacre.Grid((24, 192), (2 * half, 3e-4)))
    (expected,) = fine.stress_summary().interfaces
    missing = expected.shear[0] - rough.shear[0]
    assert 0.2 * expected.shear[0] < missing < rough.uncertainty["shear"]
    assert refined.shear[0] == pytest.approx(expected.shear[0], rel=5e-3)
    assert refined.uncertainty["shear"] < rough.uncertainty["shear"]


@pytest.mark.slow
@pytest.mark.parametrize("body", ["body", "counterbody"])
def test_bare_bodies_on_coarse_cells_are_refined(body: Any) -> None:
    """Friction at the surface, on cells that do not resolve it; Hertz' contact of one modulus."""
    grid = nacre.Grid(shape=(16, 16), size=(3e-4, 3e-4))
    coarse = nacre.solve(BALL, STEEL, STEEL, grid=grid, load=10.0)
    sliding = {"friction": 0.2, "direction": (0.0, 1.0), "body": body}
    (plain,) = coarse.stress_summary(**sliding).layers
    (refined,) = coarse.stress_summary(**sliding, refine=0.02).layers
    fine = nacre.Grid(shape=(256, 256), size=(3e-4, 3e-4))
    resolved = nacre.solve(BALL, STEEL, STEEL, grid=fine, load=10.0)
    (expected,) = resolved.stress_summary(**sliding).layers
    assert refined.uncertainty["tension"] < 0.5 * plain.uncertainty["tension"]
    value, error = refined.tension[0], refined.uncertainty["tension"]
    assert abs(value - expected.tension[0]) <= error + expected.uncertainty["tension"]


def test_refine_refuses_what_it_cannot_refine() -> None:
    """Periodic grids, yielded surfaces, known tractions, and plans have no finer cells."""
    steel = nacre.Elastic(210e9, 0.3)
    ball = nacre.Sphere(5e-3)
    grid = nacre.Grid((32, 32), (4e-4, 4e-4))
    yielded = nacre.solve(ball, steel, load=10.0, grid=grid, hardness=1e9)
    with pytest.raises(ValueError, match="refine must be None where the surface has yielded"):
        yielded.stress_summary(refine=0.05)
    wide = nacre.Grid((32, 32), (4e-4, 4e-4), periodic=(True, True))
    repeated = nacre.solve(ball, steel, load=10.0, grid=wide)
    with pytest.raises(ValueError, match="refine must be None on a periodic grid"):
        repeated.stress_summary(refine=0.05)
    shift: dict[str, Any] = {"friction": 0.3, "shift": (1e-8, 0.0)}
    slid = quiet(nacre.slide, ball, steel, steel, load=10.0, grid=grid, **shift)
    last = slid[-1] if isinstance(slid, list) else slid
    with pytest.raises(ValueError, match="refine must be None where the tractions"):
        last.stress_summary(refine=0.05)


def test_the_tension_at_the_edge_of_a_ball_is_known_to_six_per_cent() -> None:
    """Hertz: (1 − 2ν) p0/3 at the edge, of p0³ = 6 W E*²/π³R² (Johnson 1985, ch. 3 and 4)."""
    solution = nacre.solve(BALL, STEEL, load=10.0)
    summary = solution.stress_summary()
    assert not summary.warnings
    (body,) = summary.layers
    modulus = nacre.hertz.contact_modulus(STEEL)
    peak = (6 * 10.0 * modulus**2 / (math.pi**3 * BALL.radius**2)) ** (1 / 3)
    expected = (1 - 2 * STEEL.poisson) / 3 * peak
    value, error = body.tension[0], body.uncertainty["tension"]
    assert abs(value - expected) <= error < 0.06 * expected
    assert value == pytest.approx(expected, rel=5e-3)  # 0.2 % on some 70 cells across


@pytest.mark.filterwarnings("ignore:the extremes")  # whose errors are large enough to say it
@pytest.mark.parametrize("radius", [0.5, 2.0])
def test_elongated_cells_have_errors_of_their_size(radius: float) -> None:
    """Ellipses of 18 and 40 to 1 whose cells are up to 40 times as long as wide.

    At their narrow ends the edge turns within one cell. Stated errors hold there, and are no more
    than half the tension: without a bound they were up to a thousand times the tension.
    """
    coating = nacre.Layer(nacre.Elastic(300e9, 0.2), 2e-6)
    body = nacre.HalfSpace(STEEL, [coating])
    shape = nacre.Paraboloid(radius, 5e-3)
    extent = nacre.solve(shape, body, load=50.0).contact_extent
    size = (2.5 * extent[0][1], 2.5 * extent[1][1])

    def tension(cells: tuple[int, int]) -> tuple[float, float]:
        solution = nacre.solve(shape, body, load=50.0, grid=nacre.Grid(cells, size))
        layer = solution.stress_summary().layers[0]
        assert layer.uncertainty["tension"] is not None
        return layer.tension[0], layer.uncertainty["tension"]

    finest, _ = tension((640, 160))
    for cells in ((80, 40), (80, 80), (160, 40), (160, 80), (160, 160)):
        value, stated = tension(cells)
        assert abs(value - finest) < stated < 0.5 * value, cells


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:the extremes")
def test_random_slender_contacts_are_within_their_errors() -> None:
    """Bare and coated ellipses on cells up to 33 times as long as wide, against finer cells.

    The largest tension may lie at an end that the cells do not show, which its bound must reach.
    """
    rng = np.random.default_rng(17)
    for k in range(16):
        radius = np.exp(rng.uniform(np.log(0.05), np.log(3)))
        coating = nacre.Elastic(210e9 * np.exp(rng.uniform(np.log(0.3), np.log(3))), 0.25)
        thickness = np.exp(rng.uniform(np.log(1e-6), np.log(2e-5)))
        body = nacre.HalfSpace(STEEL, [nacre.Layer(coating, thickness)] if k % 4 else [])
        shape = nacre.Paraboloid(radius, 5e-3)
        extent = nacre.solve(shape, body, load=50.0, max_cells=16384).contact_extent
        size = (2.4 * extent[0][1], 2.4 * extent[1][1])
        cells = int(rng.integers(50, 160)), int(rng.integers(40, 100))
        options = {"friction": 0.1, "direction": (1, 0)} if k % 2 else {}

        def extremes(
            x: int, y: int, problem: Any = (shape, body, cells, size, options)
        ) -> list[tuple[float, float]]:
            shape, body, cells, size, options = problem
            grid = nacre.Grid((x * cells[0], y * cells[1]), size)
            summary = nacre.solve(shape, body, load=50.0, grid=grid).stress_summary(**options)
            return [
                (getattr(layer, name)[0], layer.uncertainty[name])
                for layer in summary.layers
                for name in ("von_mises", "tension", "max_shear")
            ]

        for (value, error), (finer, rest) in zip(extremes(1, 1), extremes(4, 2), strict=True):
            assert abs(value - finer) <= error + rest, (k, value, finer)
