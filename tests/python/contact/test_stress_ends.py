"""Stress at the free ends of bodies, and beyond them, where there is no material."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, STEEL
from nacre import plot

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # the ends are sharp

LAYER = nacre.Layer(nacre.Elastic(400e9, 0.25), 1e-5)
LOW, HIGH = -9e-5, 4.5e-5
"""The body has both ends, the counterbody the lower one."""
GRID = nacre.Grid((20, 12), (3e-4, 1.8e-4))
CELL = 1.5e-5


@pytest.fixture(scope="module")
def solution() -> nacre.Solution:
    body = nacre.HalfSpace(STEEL, [LAYER], ends=(LOW, HIGH))
    counterbody = nacre.HalfSpace(STEEL, ends=(LOW - 2 * CELL, None))
    return nacre.Contact(body, GRID, counterbody).solve(BALL, load=10.0)


@pytest.mark.parametrize("cells", [60, 80])
def test_the_end_face_of_a_solved_contact_bears_no_traction(cells: int) -> None:
    # The contact reaches the end: from a cell below the surface on, 3e-3 of the peak pressure.
    end = 4e-5
    body = nacre.HalfSpace(STEEL, ends=(None, end))
    grid = nacre.Grid((cells, cells), (4e-4, 4e-4))
    solution = nacre.Contact(body, grid).solve(BALL, load=10.0)
    depths = np.array([1.0, 2.0, 4.0, 8.0]) * grid.spacing[0]
    face = solution.stress(depths, x=end)
    assert face.uncertainty is not None
    assert np.abs(face.xx).max() < 3e-3 * solution.peak_pressure
    assert (np.abs(face.xx).max(axis=1) < face.uncertainty).all()
    assert max(np.abs(face.xy).max(), np.abs(face.xz).max()) < 1e-12 * solution.peak_pressure
    assert np.abs(face.yy).max() > 0.03 * solution.peak_pressure
    # On the edge itself, cells do not resolve what keeps the face free.
    surface = solution.stress(0.0, x=end)
    assert surface.uncertainty is not None
    pressure = solution.pressure[solution.x < end][-1]
    assert np.abs(surface.zz + pressure).max() < surface.uncertainty


@pytest.mark.parametrize(
    ("member", "low", "high"), [("body", LOW, HIGH), ("counterbody", LOW - 2 * CELL, np.inf)]
)
def test_each_body_has_its_own_ends(
    solution: nacre.Solution, member: Any, low: float, high: float
) -> None:
    plan = solution.stress_plan(member)
    plane = plan.stress(2e-5, displacement=True)
    beyond = (plane.x < low) | (plane.x > high)
    assert beyond.any()
    names = "xx yy zz xy yz xz ux uy uz von_mises tresca max_shear".split()
    for field in [getattr(plane, name) for name in names] + plane.principal:
        np.testing.assert_array_equal(np.isnan(field).all(axis=1), beyond)
        np.testing.assert_array_equal(np.isnan(field).any(axis=1), beyond)
    for name in ("von_mises", "tension", "zz"):
        value, (x, _, _) = plane.peak(name)
        assert np.isfinite(value)
        assert low < x < high
    line = plan.stress([0.0, 2e-5], y=1e-6)
    np.testing.assert_array_equal(np.isnan(line.zz), [beyond, beyond])
    outside = plan.stress(2e-5, x=low - 1e-7)
    assert np.isnan(outside.zz).all()
    assert outside.uncertainty is not None
    assert np.isnan(outside.uncertainty).all()
    assert outside.warnings == []
    with pytest.raises(ValueError, match="in the body"):
        outside.peak()
    assert np.isfinite(plan.stress(2e-5, x=low, y=0.0).zz)
    for layer in plan.summary().layers:
        for peak in (layer.von_mises, layer.tension, layer.max_shear):
            assert np.isfinite(peak[0])
            assert low < peak[1][0] < high


def test_stresses_with_places_beyond_an_end_are_equal_to_their_copies(
    solution: nacre.Solution,
) -> None:
    field = solution.stress([1e-5, 2e-5], displacement=True)
    assert (
        field == pickle.loads(pickle.dumps(field)) == nacre.types.Stress.from_dict(field.to_dict())
    )
    assert field == solution.stress_plan().stress([1e-5, 2e-5], displacement=True)
    assert field != solution.stress([1e-5, 3e-5], displacement=True)
    assert field != solution.stress([1e-5, 2e-5], body="counterbody", displacement=True)


def test_the_vtk_file_has_nothing_beyond_an_end(solution: nacre.Solution, tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.read(solution.save(tmp_path / "a.vtr", depths=[5e-6, 2e-5]))
    beyond = (GRID.x < LOW) | (GRID.x > HIGH)
    for name in ("stress_xx", "von_mises", "max_shear", "tension"):
        values = np.asarray(mesh.point_data[name]).reshape((*GRID.shape, 2), order="F")
        np.testing.assert_array_equal(np.isnan(values).any(axis=(1, 2)), beyond)
        np.testing.assert_array_equal(np.isnan(values).all(axis=(1, 2)), beyond)


@pytest.mark.parametrize("quantity", ["von_mises", "xx", "tension"])
def test_pictures_leave_out_what_is_beyond_an_end(solution: nacre.Solution, quantity: str) -> None:
    axes = plot.stress_section(solution, quantity, rows=8)
    axes.figure.canvas.draw()
    (mesh, *_) = axes.collections
    drawn = np.ma.getmaskarray(np.ma.asarray(mesh.get_array()))
    np.testing.assert_array_equal(drawn[0], (GRID.x < LOW) | (GRID.x > HIGH))
    assert np.isfinite(mesh.get_clim()).all()
    assert "nan" not in axes.get_title(loc="left") + axes.get_title()


def test_interface_maps_and_places_beyond_an_end(solution: nacre.Solution) -> None:
    for quantity in ("shear", "normal"):
        axes = plot.interface_map(solution, quantity=quantity)
        axes.figure.canvas.draw()
        assert np.isfinite(axes.collections[0].get_clim()).all()
    refused = r"^at must be in the body, whose ends are"
    with pytest.raises(ValueError, match=refused):
        plot.stress_section(solution, along="y", at=HIGH + CELL)
    with pytest.raises(ValueError, match=refused):
        plot.stress_depth(solution, at=(LOW - CELL, 0.0))
    plot.stress_section(solution, along="y", at=HIGH, rows=4)
    plot.stress_depth(solution, at=(HIGH, 0.0), points=4)


@pytest.mark.parametrize(
    ("rows", "beside", "error"),
    # More rows have other nodes of the interpolation below the face; more columns hold more of the
    # excess.
    [(43, 0, 1e-7), (32, 7, 1e-4)],
)
def test_cells_without_pressure_change_little(rows: int, beside: int, error: float) -> None:
    # What ends add is computed in the cells that are wanted, from those that are loaded.
    def bell(t: Any) -> Any:
        return np.clip(1.0 - t * t, 0.0, None) ** 3

    body = nacre.HalfSpace(nacre.Elastic(1.0, 0.3), ends=(0.0, None))
    fields = []
    for rows_here, beside_here in ((32, 0), (rows, beside)):
        columns = 32 + 2 * beside_here
        size = (rows_here / 8, columns / 8)
        grid = nacre.Grid((rows_here, columns), size, center=(rows_here / 16, 0.0))
        pressure = bell((grid.x[:, None] - 0.7) / 0.6) * bell(grid.y / 0.5)
        field = nacre.stress(body, grid, pressure, [0.05, 0.5, 2.0])
        kept = np.s_[:, :32, beside_here : beside_here + 32]
        fields.append([field.xx[kept], field.yy[kept], field.zz[kept], field.xz[kept]])
    assert np.abs(np.subtract(fields[0], fields[1])).max() <= error


def test_what_is_left_out_far_from_an_end_is_small() -> None:
    # The excess beside the end is dropped ten widths away, where it is less than 1e-3 of the peak
    # pressure.
    body = nacre.HalfSpace(nacre.Elastic(1.0, 0.3), ends=(0.0, 40.0))
    grid = nacre.Grid((320, 24), (40.0, 1.5), center=(20.0, 0.0))
    pressure = np.sqrt(np.clip(1.0 - (grid.y / 0.5) ** 2, 0.0, None)) * np.ones((320, 1))
    field = nacre.stress(body, grid, pressure, [0.2, 0.5])
    for component in (field.xx, field.yy, field.zz, field.xz, field.xy):
        jumps = np.abs(np.diff(component[:, 40:280], n=2, axis=1))
        assert jumps.max() < 1e-3
