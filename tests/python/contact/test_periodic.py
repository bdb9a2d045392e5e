"""Grids that repeat, from Python."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import k0

import nacre
from bodies import BALL, STEEL
from nacre import plot
from nacre.case import Case, CaseError
from support import DATA, assert_close

BODY = nacre.Elastic(1.0, 0.0)
GRID = nacre.Grid((32, 24), (1.0, 0.75), periodic=(True, True))
X, Y = np.meshgrid(GRID.x, GRID.y, indexing="ij")
HEIGHTS = 1e-3 * np.cos(2 * np.pi * X) + 5e-4 * np.cos(2 * np.pi * Y / 0.75)
MAP = nacre.HeightMap(HEIGHTS, 1 / 32, periodic=(True, True))
MEAN = HEIGHTS.max() - HEIGHTS.mean()


def test_a_wave_along_the_period_falls_off_as_bessels_function() -> None:
    """Along y it repeats: û = (2/πE*) ∫ K0(q|x|) dx sinc(q dy/2) over the strip, for all aliases q.

    Abramowitz & Stegun 9.6.21 gives the transform of 1/r.
    """
    n, m, dx, dy = 12, 24, 1.0, 0.5
    grid = nacre.Grid((n, m), (n * dx, m * dy), periodic=(False, True))
    coefficients = nacre.influence_coefficients(BODY, grid)
    for wave in (1, 5):
        found = coefficients @ np.cos(2 * np.pi * wave * np.arange(m) / m)
        for i in (1, 3):
            due = 0.0
            for alias in range(-8, 9):
                q = 2 * np.pi * (wave + alias * m) / (m * dy)
                strip, _ = quad(lambda x, q=q: k0(abs(q) * x), (i - 0.5) * dx, (i + 0.5) * dx)
                due += 2 / np.pi * strip * np.sinc(q * dy / 2 / np.pi)
            assert found[i] == pytest.approx(due, abs=1e-10)


def test_the_map_says_once_that_it_repeats() -> None:
    """Its own grid repeats, so that `solve` needs nothing else; the mean pressure is the load."""
    solution = nacre.solve(MAP, BODY, load=1e-3)
    assert solution.report.grid == GRID
    assert solution.pressure.mean() * 0.75 == pytest.approx(1e-3, rel=1e-12)
    # The mean of the displacement is the datum.
    assert abs(solution.displacement.mean()) < 1e-9 * abs(solution.displacement).max()
    farther = nacre.Grid((32, 24), (1.0, 0.75), (1.0, -0.75))
    assert_close(MAP.gaps(farther), MAP.gaps(GRID), atol=1e-15)
    assert solution.report.warnings == []


def test_it_keeps_its_period_everywhere(tmp_path: Path) -> None:
    solution = nacre.solve(MAP, BODY, load=1e-3)
    for value in (GRID, MAP, MAP.shifted(0.1, 0.2), nacre.Contact(BODY, GRID), solution):
        assert pickle.loads(pickle.dumps(value)) == value
    assert eval(repr(GRID), {"Grid": nacre.Grid}) == GRID
    assert "periodic" not in repr(nacre.Grid((4, 4), (1.0, 1.0)))
    solution.save(tmp_path / "wave.nc")
    assert nacre.load(tmp_path / "wave.nc") == solution
    case = {"shape": MAP, "body": BODY, "grid": GRID}
    study = nacre.sweep(case, {"load": [1e-3, 2e-3]}, store=tmp_path / "s.nc")
    assert study.approach.diff("load").item() > 0


def test_the_table_leaves_out_what_makes_no_sense() -> None:
    solution = nacre.solve(MAP, BODY, load=1e-3)
    text = str(solution)
    assert "periodic" in text
    for row in ("acts at", "moment", "\ntilt"):
        assert row not in text
    share = solution.contact_area / (GRID.size[0] * GRID.size[1])
    assert solution.contact_share == pytest.approx(share, rel=1e-12)
    assert f"share          {100 * share:.3g} % of the area" in text
    assert solution.to_xarray().attrs["contact_share"] == solution.contact_share
    parts = solution.plot()
    axes = parts["map"]
    assert axes.get_title("left") == f"{100 * share:.3g} % of the area touches"
    assert np.ptp(axes.get_xlim()) == pytest.approx(1e3 * GRID.size[0], rel=1e-12)
    assert np.ptp(axes.get_ylim()) == pytest.approx(1e3 * GRID.size[1], rel=1e-12)
    words = " ".join(text.get_text() for text in parts["numbers"].texts).split()
    assert "periodic along x and y" in " ".join(words)
    assert "share" not in str(nacre.solve(BALL, STEEL, load=10.0))


def test_maps_that_repeat_on_grids_that_fit() -> None:
    """A map on two of its periods is the map; below a ball it goes on, however wide the grid is."""
    one = nacre.solve(MAP, BODY, load=1e-3)
    wide = nacre.Grid((64, 24), (2.0, 0.75), periodic=(True, True))
    two = nacre.solve(MAP, BODY, grid=wide, load=2e-3)
    peak = one.pressure.max()
    # Both are to 1e-8; samples of the wave lie at the same places of a period.
    assert_close(two.pressure[16:48], one.pressure, atol=1e-6 * peak)
    ball = nacre.Sphere(5.0) + MAP
    open_ = nacre.solve(ball, BODY, grid=nacre.Grid((80, 80), (2.5, 2.5)), load=1e-2)
    assert open_.report.converged
    piece = nacre.HeightMap(HEIGHTS, 1 / 32)
    along = nacre.HeightMap(HEIGHTS, 1 / 32, periodic=(True, False))
    strip = nacre.Grid((32, 24), (1.0, 0.75), periodic=(True, False))
    for shape, grid in ((piece, nacre.Grid((32, 24), (1.0, 0.75))), (along, strip)):
        with pytest.warns(nacre.NacreWarning, match="reaches the rim of the measured map along y"):
            assert nacre.solve(shape, BODY, grid=grid, load=1e-3).report.converged


def test_an_approach_up_to_full_contact_has_a_solution() -> None:
    """The mean plane stays, so that the approach of full contact is the mean gap."""
    full = nacre.solve(MAP, BODY, load=1.0)
    assert full.contact_area == pytest.approx(0.75)
    assert full.approach == pytest.approx(MEAN, rel=1e-6)
    near = nacre.solve(MAP, BODY, approach=0.99 * MEAN)
    assert near.approach == pytest.approx(0.99 * MEAN)
    told: list[object] = []
    with pytest.raises(ValueError, match="approach must be below"):
        nacre.solve(MAP, BODY, approach=MEAN * (1 + 1e-9), progress=told.append)
    assert not told


def test_case_files(tmp_path: Path) -> None:
    np.save(tmp_path / "wave.npy", HEIGHTS)
    shape = {"kind": "height_map", "path": "wave.npy", "spacing": 1 / 32, "detrend": "none"}
    case: dict[str, Any] = {
        "shape": shape | {"periodic": [True, True]},
        "body": {"substrate": {"young": 1.0, "poisson": 0.0}},
        "solve": {"load": 1e-3},
    }
    found = nacre.solve(**Case(case, folder=tmp_path).arguments())
    assert found.pressure.tobytes() == nacre.solve(MAP, BODY, load=1e-3).pressure.tobytes()
    line = case | {"grid": {"cells": 8, "width": 1.0, "periodic": [False, True]}}
    with pytest.raises(CaseError, match="periodic must not be given"):
        Case(line, folder=tmp_path).arguments()


@pytest.mark.parametrize("name", ["contact_mechanics", "tamaas", "contact_mechanics_layer"])
def test_other_programs_find_the_same_pressure(
    name: str, claim: Callable[[str, float], None]
) -> None:
    """ContactMechanics 1.8.3, also with its layer on a rigid base, and Tamaas 2.9.0.

    Their discretisation is the spectral method; their pressures stand in tests/data, which
    make/periodic_peers.py made. They meet 1e-12 or so of the energy, the square of which is the
    error of a pressure.
    """
    data = json.loads((DATA / "periodic_peers.json").read_text(encoding="utf-8"))
    cells, side, layer = data["cells"], data["side"], data["layer"]
    at = (np.arange(cells) + 0.5) / cells
    heights = sum(
        a * np.cos(2 * np.pi * (k * at[:, None] + m * at[None, :]) + phase)
        for k, m, a, phase in data["waves"]
    )
    shape = nacre.HeightMap(heights - heights.max(), side / cells, periodic=(True, True))
    body = nacre.HalfSpace(BODY)
    if name.endswith("layer"):
        elastic = nacre.Elastic(layer["young"], layer["poisson"])
        body = nacre.HalfSpace(nacre.RIGID, [nacre.Layer(elastic, layer["thickness"])])
    grid = nacre.Grid((cells, cells), (side, side), periodic=(True, True))
    waves = nacre.influence_coefficients(body, grid, "spectral")
    contact = nacre.Contact(body, grid, coefficients=waves)
    found = contact.solve(shape, load=data["mean_pressure"] * side**2, tolerance=1e-12)
    theirs = np.array(data[name])
    assert 0.02 < (theirs > 0).mean() < 0.9
    claim("periodic-peers", float(np.abs(found.pressure - theirs).max() / theirs.max()))


@pytest.mark.slow
def test_stresses_repeat_and_bear_the_load() -> None:
    """A wave on a bare body has σ_zz = −p (1 + qz) e^{−qz} and σ_xx = −p (1 − qz) e^{−qz}.

    The mean pressure does not stretch the body: σ_xx = −ν p/(1 − ν), which is 0 here. The cells
    leave (q dx)²/24 of the wave: 2e-3 at 32 cells.
    """
    heights = 1e-3 * np.cos(2 * np.pi * X)
    wave = nacre.HeightMap(heights, 1 / 32, periodic=(True, True))
    solution = nacre.solve(wave, BODY, load=0.004 * 0.75)
    depths = np.array([0.05, 0.1, 0.3])
    stress = solution.stress(depths)
    q = 2 * np.pi
    amplitude = np.pi * 1e-3
    for k, z in enumerate(depths):
        cosine = amplitude * np.cos(q * X)
        decay = np.exp(-q * z)
        due = -0.004 - cosine * (1 + q * z) * decay
        assert_close(stress.zz[k], due, atol=4e-3 * amplitude)
        assert_close(stress.xx[k], -cosine * (1 - q * z) * decay, atol=4e-3 * amplitude)
        assert stress.zz[k].mean() == pytest.approx(-0.004, rel=1e-9)
    summary = solution.stress_summary(friction=0.2, direction=(0, 1))
    largest = solution.stress(np.linspace(0, 0.6, 31), friction=0.2, direction=(0, 1)).von_mises
    assert summary.layers[0].von_mises[0] == pytest.approx(largest.max(), rel=1e-2)


@pytest.mark.slow
def test_plans_sections_and_files_know_that_stresses_repeat(tmp_path: Path) -> None:
    solution = nacre.solve(MAP, BODY, load=2e-3)
    plan = solution.stress_plan()
    whole = plan.stress([0.02, 0.2])
    section = plan.stress([0.02, 0.2], y=float(GRID.y[5]))
    assert_close(section.zz, whole.zz[..., 5], atol=1e-12)
    solution.save(tmp_path / "below.vtr", depths=[0.0, 0.1])
    assert (tmp_path / "below.vtr").stat().st_size > 1000
    axes = plot.stress_section(solution)
    assert axes.get_xlabel().startswith("x")
