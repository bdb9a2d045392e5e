"""Surfaces that yield, from Python: what `solve` takes, histories, files, tables, case files."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import nacre
from bodies import BALL, STEEL
from nacre import plot
from nacre.case import Case, CaseError
from support import Capture, command, written

GRID = nacre.Grid((48, 48), (5e-4, 5e-4))
CONTACT = nacre.Contact(STEEL, GRID)
LIMIT = 2e9
LOADED = CONTACT.solve(BALL, load=100.0, hardness=LIMIT)
"""Its elastic peak would be 3.5 GPa."""


def test_the_pressure_ends_at_the_hardness() -> None:
    assert LOADED.pressure.max() == LIMIT == LOADED.hardness
    assert LOADED.load == pytest.approx(100.0, rel=1e-12)
    dented = LOADED.indentation > 0
    assert (LOADED.pressure[dented] == LIMIT).all()
    assert dented.sum() > 100
    # Where they touch, the gap is closed: it contains the indentation.
    assert LOADED.gap[dented] == pytest.approx(0.0, abs=1e-8 * LOADED.displacement.max())
    work = LIMIT * LOADED.indentation.sum() * GRID.spacing[0] * GRID.spacing[1]
    assert LOADED.plastic_work == pytest.approx(work, rel=1e-12)


def test_elastic_surfaces_have_no_hardness() -> None:
    elastic = CONTACT.solve(BALL, load=10.0)
    assert elastic.hardness is None
    assert elastic.plastic_work == 0
    assert elastic.indentation.shape == (48, 48)
    assert not elastic.indentation.any()
    same = CONTACT.solve(BALL, load=10.0, hardness=np.inf)
    assert (same.pressure == elastic.pressure).all()


def test_unloading_keeps_the_dent() -> None:
    """The result does not depend on how many steps lead to it, up to the tolerance of 1e-8."""
    steps = [LOADED]
    for load in (40.0, 70.0, 20.0):
        steps.append(CONTACT.solve(BALL, load=load, hardness=LIMIT, initial=steps[-1]))
        assert (steps[-1].indentation == LOADED.indentation).all()
    direct = CONTACT.solve(BALL, load=20.0, hardness=LIMIT, initial=LOADED)
    peak = direct.peak_pressure
    assert steps[-1].pressure == pytest.approx(direct.pressure, abs=1e-7 * peak)
    # A dented surface is flatter: an elastic ball has a higher peak.
    assert peak < 0.9 * CONTACT.solve(BALL, load=20.0).peak_pressure
    # An array is a pressure to start from, without a dent.
    fresh = CONTACT.solve(BALL, load=20.0, initial=LOADED.pressure)
    assert not fresh.indentation.any()


def test_a_history_keeps_the_grid_of_its_dent() -> None:
    first = nacre.solve(BALL, STEEL, load=100.0, hardness=LIMIT)
    second = nacre.solve(BALL, STEEL, load=10.0, hardness=LIMIT, initial=first)
    assert second.report.grid == first.report.grid
    with pytest.raises(ValueError, match="initial must be a solution on the grid of this contact"):
        CONTACT.solve(BALL, load=10.0, hardness=LIMIT, initial=first)


def test_a_dent_belongs_to_its_bodies() -> None:
    soft = nacre.Elastic(3e9, 0.35)
    first = nacre.solve(BALL, STEEL, grid=GRID, load=100.0, hardness=LIMIT)
    for body, counterbody in ((soft, None), (STEEL, STEEL)):
        with pytest.raises(ValueError, match="initial must be a solution of the body"):
            nacre.solve(BALL, body, counterbody, load=10.0, initial=first)
        contact = nacre.Contact(body, GRID, counterbody)
        with pytest.raises(ValueError, match="initial must be a solution of the body"):
            contact.solve(BALL, load=10.0, initial=first)
    # The pressure of other bodies is but a place to start from.
    fresh = nacre.solve(BALL, STEEL, grid=GRID, load=10.0)
    other = nacre.solve(BALL, soft, grid=GRID, load=10.0, initial=fresh)
    direct = nacre.solve(BALL, soft, grid=GRID, load=10.0)
    assert other.approach == pytest.approx(direct.approach, rel=1e-7)


def test_each_cell_may_have_its_hardness() -> None:
    cells = np.full(GRID.shape, LIMIT)
    cells[:24] = np.inf
    half = CONTACT.solve(BALL, load=100.0, hardness=cells)
    np.testing.assert_array_equal(half.hardness, cells)
    assert (half.pressure <= cells).all()
    assert half.pressure[:24].max() > 1.5 * LIMIT
    assert half.indentation[:24].max() == 0 < half.indentation[24:].max()


def test_many_cases_have_the_same_hardness() -> None:
    cases = [{"shape": BALL, "load": load} for load in (10.0, 100.0)]
    solutions = CONTACT.solve_many(cases, hardness=LIMIT)
    assert [s.plastic_work > 0 for s in solutions] == [False, True]
    assert (solutions[1].pressure == LOADED.pressure).all()


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan, "hard", np.ones((3, 3)), np.zeros((48, 48))])
def test_wrong_hardness_is_refused(wrong: Any) -> None:
    with pytest.raises((TypeError, ValueError), match=r"^hardness"):
        CONTACT.solve(BALL, load=10.0, hardness=wrong)


def test_too_much_load_is_refused_with_both_numbers() -> None:
    with pytest.raises(ValueError, match=r"hardness can carry .* 25, was 100:"):
        CONTACT.solve(BALL, load=100.0, hardness=1e8)


@pytest.mark.parametrize("hardness", [LIMIT, np.full(GRID.shape, LIMIT)], ids=["number", "cells"])
def test_files_and_pickles_keep_everything(hardness: Any, tmp_path: Path) -> None:
    solution = CONTACT.solve(BALL, load=100.0, hardness=hardness)
    assert nacre.load(solution.save(tmp_path / "dent.nc")) == solution
    assert pickle.loads(pickle.dumps(solution)) == solution
    again = CONTACT.solve(BALL, load=30.0, initial=nacre.load(tmp_path / "dent.nc"))
    assert (again.indentation == solution.indentation).all()
    assert again.hardness is None
    assert nacre.load(again.save(tmp_path / "elastic.nc")) == again
    dataset = solution.to_xarray()
    assert (dataset["indentation"].values == solution.indentation).all()
    assert ("hardness" in dataset) == isinstance(hardness, np.ndarray)
    solution.save(tmp_path / "dent.csv")
    header = (tmp_path / "dent.csv").read_text(encoding="utf-8").splitlines()[0]
    assert header.endswith("indentation [m]")
    solution.save(tmp_path / "dent.vtr")
    assert b"indentation" in (tmp_path / "dent.vtr").read_bytes()


def test_a_file_without_its_dent_is_refused(tmp_path: Path) -> None:
    path = LOADED.save(tmp_path / "dent.nc")
    with h5py.File(path, "r+") as file:
        del file["indentation"]
    with pytest.raises(ValueError, match="saved again by another program"):
        nacre.load(path)


def test_tables_and_pictures_show_the_dent() -> None:
    text = str(LOADED)
    assert "hardness       2 GPa" in text
    assert "at most, permanent" in text
    assert "hardness" not in str(CONTACT.solve(BALL, load=10.0))
    spread = np.linspace(2e9, 3e9, GRID.shape[0] * GRID.shape[1]).reshape(GRID.shape)
    assert "2 GPa to 3 GPa" in str(CONTACT.solve(BALL, load=100.0, hardness=spread))
    axes = plot.section(LOADED, "x", quantity="indentation")
    assert axes.get_ylabel() == "indentation [nm]"
    highest = max(np.max(line.get_ydata()) for line in axes.get_lines())
    assert highest == pytest.approx(1e9 * LOADED.indentation.max(), rel=1e-9)


def test_case_files_have_a_hardness() -> None:
    case: dict[str, Any] = {
        "shape": {"kind": "sphere", "radius": 5e-3},
        "body": {"substrate": {"young": 210e9, "poisson": 0.3}},
        "grid": {"shape": [48, 48], "size": [5e-4, 5e-4]},
        "solve": {"load": 100.0, "hardness": LIMIT},
    }
    assert (nacre.solve(**Case(case).arguments()).pressure == LOADED.pressure).all()
    with pytest.raises(CaseError, match=r"solve\.hardness"):
        Case(case | {"solve": {"load": 1.0, "hardness": "hard"}})
    outputs = ["peak_pressure", "plastic_work"]
    sweep = {"parameters": {"solve.hardness": [2e9, 3e9]}, "outputs": outputs}
    study = Case(case | {"sweep": sweep})
    found = nacre.sweep(study, **study.study())
    assert found["peak_pressure"].values == pytest.approx([2e9, 3e9], rel=1e-12)
    assert found["plastic_work"].values[0] > found["plastic_work"].values[1] > 0


def test_the_command_line_goes_on_from_a_file(tmp_path: Path, capsys: Capture) -> None:
    text = """
        shape = { kind = "sphere", radius = 5e-3 }
        body.substrate = { young = 210e9, poisson = 0.3 }
        grid = { shape = [48, 48], size = [5e-4, 5e-4] }
        solve = { load = LOAD, hardness = 2e9 }
    """
    saved = tmp_path / "loaded.nc"
    assert command("solve", written(tmp_path, text.replace("LOAD", "100")), "--save", saved) == 0
    assert "permanent" in capsys.readouterr().out
    less = written(tmp_path, text.replace("LOAD", "20"))
    assert command("solve", less, "--initial", saved, "--json") == 0
    direct = CONTACT.solve(BALL, load=20.0, hardness=LIMIT, initial=LOADED)
    found = json.loads(capsys.readouterr().out)
    assert found["peak_pressure"] == pytest.approx(direct.peak_pressure)
    assert found["hardness"] == LIMIT
    assert found["indentation"] == pytest.approx(direct.indentation.max())
    assert found["plastic_work"] == pytest.approx(direct.plastic_work)
    assert command("solve", less, "--initial", "nothing.nc") == 2
