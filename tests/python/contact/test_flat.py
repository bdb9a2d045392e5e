"""A radius that is infinite is flat: in gaps, contacts, files, studies and case files."""

import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import STEEL, quiet
from nacre.case import Case
from support import assert_close

INF, RADIUS, LOAD = math.inf, 5e-3, 1e4
LINE = nacre.Grid.line(257, 2e-4)
GRID = nacre.Grid((16, 96), (1e-3, 2e-4))
ACROSS = nacre.Grid((96, 16), (2e-4, 1e-3))
TURNED = {
    "paraboloid": nacre.Paraboloid(INF, RADIUS),
    "on a plane": nacre.Paraboloid(INF, RADIUS, INF, -INF),
    "plane on a cylinder": nacre.Paraboloid(INF, INF, counter_radius_y=RADIUS),
    "plane on a ring": nacre.Cylinder(INF, counter_radius=RADIUS),
    "cylinder on a plane": nacre.Cylinder(RADIUS, counter_radius=INF),
}
"""The same line contact, whose gaps differ by the parabola's (y/R)²/4 < 1e-4."""
PARABOLA = 1e-4


@pytest.mark.parametrize("name", TURNED)
@pytest.mark.parametrize("grid", [LINE, GRID])
def test_one_direction_may_be_flat(name: str, grid: nacre.Grid) -> None:
    load = LOAD if grid.is_line else LOAD * 1e-3
    found, expected = (
        quiet(nacre.solve, shape, STEEL, load=load, grid=grid)
        for shape in (TURNED[name], nacre.Cylinder(RADIUS))
    )
    assert_close(found.pressure, expected.pressure, rtol=PARABOLA)
    assert found.approach == pytest.approx(expected.approach, rel=PARABOLA)


def test_a_line_contact_is_that_of_hertz() -> None:
    found = quiet(nacre.solve, nacre.Paraboloid(INF, RADIUS), STEEL, load=LOAD, grid=LINE)
    hertz = nacre.hertz.Line(RADIUS, nacre.hertz.contact_modulus(STEEL), LOAD)
    share = 2e-4 / 257 / hertz.half_width
    assert found.peak_pressure == pytest.approx(hertz.peak_pressure, rel=share**2)


def test_the_flat_direction_may_be_y() -> None:
    along_x = quiet(nacre.solve, nacre.Paraboloid(INF, RADIUS), STEEL, load=10.0, grid=GRID)
    along_y = quiet(nacre.solve, nacre.Paraboloid(RADIUS, INF), STEEL, load=10.0, grid=ACROSS)
    # Both are converged to the tolerance of a solve.
    assert_close(along_y.pressure.T, along_x.pressure, rtol=1e-6)


FLAT = {
    "paraboloid": nacre.Paraboloid(INF, INF),
    "cylinder": nacre.Cylinder(INF),
    "moved": nacre.Cylinder(INF).shifted(1e-5, 0.0),
    "a sum": nacre.Cylinder(INF) + nacre.Paraboloid(INF, INF),
}


@pytest.mark.parametrize("name", FLAT)
def test_two_planes_touch_only_where_the_grid_repeats(name: str) -> None:
    for grid in (LINE, GRID, nacre.Grid((8, 8), (1e-3, 1e-3), periodic=(True, False))):
        with pytest.raises(ValueError, match="shape must be curved across the contact: a flat one"):
            nacre.solve(FLAT[name], STEEL, load=10.0, grid=grid)
    with pytest.raises(ValueError, match="grid must be given for a shape without end"):
        nacre.solve(FLAT[name], STEEL, load=10.0)
    grid = nacre.Grid((8, 8), (1e-3, 1e-3), periodic=(True, True))
    found = nacre.solve(FLAT[name], STEEL, load=10.0, grid=grid)
    assert_close(found.pressure, np.full((8, 8), 1e7), rtol=1e-12)


def test_a_line_contact_flat_across_is_refused() -> None:
    with pytest.raises(ValueError, match="shape must be curved across the contact"):
        nacre.solve(nacre.Paraboloid(RADIUS, INF), STEEL, load=LOAD, grid=LINE)


@pytest.mark.parametrize("name", FLAT)
def test_a_plane_adds_nothing_to_a_shape(name: str) -> None:
    ball = nacre.Sphere(RADIUS)
    found = nacre.solve(FLAT[name] + ball, STEEL, load=10.0)
    assert np.array_equal(found.pressure, nacre.solve(ball, STEEL, load=10.0).pressure)


@pytest.mark.parametrize("shape", [*TURNED.values(), *FLAT.values()])
def test_values_are_kept(shape: nacre.types.Shape) -> None:
    assert pickle.loads(pickle.dumps(shape)) == shape
    assert eval(repr(shape), vars(nacre) | {"inf": INF}) == shape


def test_files_and_studies_keep_a_flat_shape(tmp_path: Path) -> None:
    def build(radius: float) -> dict[str, Any]:
        shape = nacre.Paraboloid(radius, RADIUS)
        return {"shape": shape, "body": STEEL, "load": 10.0, "grid": GRID, "threads": 1}

    solution = quiet(nacre.solve, **build(INF))
    solution.save(tmp_path / "a.nc")
    assert nacre.load(tmp_path / "a.nc") == solution
    store = {"store": tmp_path / "s.nc", "progress": False}
    for _ in range(2):  # the second one finds what is there
        study = quiet(nacre.sweep, build, {"radius": [1.0, INF]}, **store)
    assert study["peak_pressure"].values[1] == solution.peak_pressure
    # 1 m across 1 mm drops by 1/8 µm, of 0.1 µm that the bodies yield: not flat.
    assert study["peak_pressure"].values[0] != solution.peak_pressure


def test_gradients_leave_out_what_is_flat() -> None:
    shape = nacre.Paraboloid(INF, RADIUS)
    found = quiet(nacre.solve, shape, STEEL, load=10.0, grid=GRID).gradient("approach", shape=shape)
    assert [name for name in found.keys() if "radius" in name] == ["shape.radius_y"]


CYLINDER = {"kind": "cylinder", "radius": INF, "counter_radius": 2}
TABLES: list[tuple[dict[str, Any], Callable[[], nacre.types.Shape]]] = [
    (CYLINDER, lambda: nacre.Cylinder(INF, 2)),
    ({"kind": "cylinder", "radius": 2, "counter_radius": -INF}, lambda: nacre.Cylinder(2)),
    ({"kind": "paraboloid", "radius_x": INF, "radius_y": 3}, lambda: nacre.Paraboloid(INF, 3)),
    (
        {"kind": "sum", "parts": [CYLINDER, {"kind": "sphere", "radius": 1}]},
        lambda: nacre.Cylinder(INF, 2) + nacre.Sphere(1),
    ),
]


@pytest.mark.parametrize(("table", "shape"), TABLES)
def test_case_files_have_flat_shapes(
    table: dict[str, Any], shape: Callable[[], nacre.types.Shape]
) -> None:
    case = Case(
        {
            **{"units": "SI", "shape": table, "body": {"substrate": {"young": 1, "poisson": 0.3}}},
            "solve": {"load": 1},
        }
    )
    assert case.arguments()["shape"] == shape()
    # In other units the other radii are other numbers, and what is flat stays flat.
    other = case.in_units("N-mm-MPa").arguments()["shape"]
    assert ("inf" in repr(other)) == ("inf" in repr(shape()))


def test_a_flat_ball_is_refused() -> None:
    for make in (nacre.Sphere, nacre.FlatPunch):
        with pytest.raises(ValueError, match="radius must be finite and above 0, got inf"):
            make(INF)
    with pytest.raises(ValueError, match=r"1/radius . 1/counter_radius must be above 0"):
        nacre.hertz.Ellipse(INF, 1.0, contact_modulus=1.0, load=1.0)
    assert nacre.hertz.equivalent_radius(-INF, RADIUS) == RADIUS
