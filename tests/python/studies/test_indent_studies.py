"""Studies of indentations keep what each indentation has, go on after a kill, and record errors."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre.indent import Adhesion, IndentSolution, Tip, solve

pytest.importorskip("xarray")
GLASS, FILM = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
BODY = nacre.HalfSpace(GLASS, [nacre.Layer(FILM, 1e-6)])
CASE: dict[str, Any] = {"body": BODY, "tip": Tip.sphere(5e-6), "load": 1e-3}
THICKNESS = "body.layers[0].thickness"


def coated(thickness: float, radius: float) -> dict[str, Any]:
    body = nacre.HalfSpace(GLASS, [nacre.Layer(FILM, thickness)])
    return {"body": body, "tip": Tip.sphere(radius), "load": 1e-3}


def surface_pressure(solution: IndentSolution) -> float:
    return float(solution.state.pressure(0.5 * solution.radius))


def test_a_study_has_the_numbers_of_each_indentation() -> None:
    study = nacre.sweep(coated, {"thickness": [1e-6, 2e-6], "radius": [4e-6, 5e-6]})
    assert {"load", "approach", "radius"} & set(study.data_vars) == {"load", "approach"}
    assert not any(str(name).endswith("_discretisation") for name in study.data_vars)
    assert study.stiffness.attrs["units"] == "N/m"
    assert study.approach[0, 1] == solve(**CASE).approach
    assert study.central_pressure.shape == (2, 2)


def test_parameters_are_named_by_path() -> None:
    case = CASE | {"adhesion": Adhesion.jkr(0.05)}
    names = {THICKNESS: [1e-6, 2e-6], "tip.radius": [5e-6], "adhesion.work": [0.05, 0.1]}
    study = nacre.sweep(case, names, outputs=["approach", "pull_off_load"])
    body = nacre.HalfSpace(GLASS, [nacre.Layer(FILM, 2e-6)])
    alone = solve(body, Tip.sphere(5e-6), adhesion=Adhesion.jkr(0.1), load=1e-3)
    assert study.approach[1, 0, 1] == alone.approach
    assert study.pull_off_load[1, 0, 1] == alone.pull_off_load
    assert study.pull_off_load.attrs["units"] == "N"
    assert BODY.layers[0].thickness == 1e-6


def test_paths_work_for_contacts_on_grids_too() -> None:
    grid = nacre.Grid((16, 16), (4e-6, 4e-6))
    case = {"shape": nacre.Sphere(5e-6), "body": BODY, "load": 1e-3, "grid": grid}
    study = nacre.sweep(case, {THICKNESS: [1e-6, 2e-6]}, outputs=["approach"])
    assert study.approach[1] > study.approach[0]


@pytest.mark.parametrize(
    ("name", "told"), [("tip.slope", "no slope"), ("body.layers[3].thickness", "no 3")]
)
def test_a_path_to_nothing_is_refused(name: str, told: str) -> None:
    with pytest.raises(ValueError, match=f"{told}; the nearest are "):
        nacre.sweep(CASE, {name: [1.0]}, outputs=["load"])


def test_functions_and_arrays_are_outputs() -> None:
    case = CASE | {"load": [1e-4, 1e-3]}
    study = nacre.sweep(case, {"tip.radius": [4e-6, 5e-6]}, outputs=["load", "approach"])
    assert study.approach.shape == (2, 2)
    outputs: dict[str, Any] = {"p": surface_pressure, "radius": "radius"}
    study = nacre.sweep(CASE, {"tip.radius": [5e-6]}, outputs=outputs)
    assert study.p[0] == surface_pressure(solve(**CASE))


def test_processes_change_no_bit() -> None:
    names = {"tip.radius": [4e-6, 5e-6]}
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        apart = nacre.sweep(CASE, names, executor=pool)
    assert apart.identical(nacre.sweep(CASE, names))


def test_a_study_goes_on_where_it_was_killed(tmp_path: Path) -> None:
    store, journal = tmp_path / "a.nc", tmp_path / "a.journal"
    adhesion = [None, Adhesion.jkr(0.05), Adhesion.dmt(0.05)]
    parameters = {"tip": [Tip.sphere(5e-6), Tip.paraboloid(5e-6)], "adhesion": adhesion}
    first = nacre.sweep(CASE, parameters, store=store)
    lines = journal.read_text().splitlines(keepends=True)
    assert len(lines) == 7  # a head, and a line for each tip and adhesion
    journal.write_text("".join(lines[:3]))
    store.unlink()
    assert nacre.sweep(CASE, parameters, store=store).identical(first)
    kept = journal.read_text().splitlines(keepends=True)
    assert (len(kept), kept[:3]) == (7, lines[:3])
    assert nacre.sweep(CASE, parameters, store=store).identical(first)
    assert journal.read_text().splitlines(keepends=True) == kept


@pytest.mark.parametrize("name", ["grid", "friction", "threads"])
def test_arguments_of_other_solves_are_refused(name: str) -> None:
    with pytest.raises(TypeError, match=r"nacre\.indent\.solve beside a tip"):
        nacre.sweep(CASE | {name: None}, {"load": [1.0]})


def test_outputs_of_the_other_kind_are_errors_that_are_recorded() -> None:
    with pytest.raises(ValueError, match="IndentSolution"):
        nacre.sweep(CASE, {"load": [1e-3]}, outputs=["peak_pressure"])
    parameters = {"thickness": [1e-6], "radius": [5e-6]}
    with pytest.warns(nacre.NacreWarning, match="cases failed"):
        study = nacre.sweep(coated, parameters, outputs=["peak_pressure"])
    assert "not one of an indentation" in str(study.error.values[0])
    grid = nacre.Grid((16, 16), (4e-6, 4e-6))
    case = {"shape": nacre.Sphere(5e-6), "body": BODY, "grid": grid}
    with pytest.raises(ValueError, match="of Solution"):
        nacre.sweep(case, {"load": [1e-3]}, outputs=["radius"])
    with pytest.warns(nacre.NacreWarning, match="cases failed"):
        study = nacre.sweep(
            lambda load: case | {"load": load}, {"load": [1e-3]}, outputs=["radius"]
        )
    assert "needs an indentation" in str(study.error.values[0])
    assert np.isnan(study.radius[0])
