"""Case files, the command line and studies with friction give what the Python call gives."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import nacre
from bodies import BALL, HELD, STEEL
from nacre.case import Case, CaseError
from support import Capture, command, written

GRID = nacre.Grid((40, 36), (2.4e-4, 2.2e-4))

HEAD = """
[materials]
steel = { young = 210e9, poisson = 0.3 }
[shape]
kind = "sphere"
radius = 5e-3
[body]
substrate = "steel"
[counterbody]
substrate = "steel"
[grid]
shape = [40, 36]
size = [2.4e-4, 2.2e-4]
[solve]
load = 10.0
"""
SLIDE = HEAD + "[slide]\nfriction = 0.3\nforce = { x = 2.0 }\ntorque = 1e-5\n"
STEPS = (
    HEAD
    + "[slide]\nfriction = 0.3\n"
    + "".join(f"[[slide.steps]]\nforce = {{ x = {x} }}\n" for x in (2.0, -2.0))
)
ROLL = (
    HEAD
    + '[roll]\nfriction = 0.3\ndirection = "-y"\nspin = 3.0\ncreepage = { along = 1e-3 }\n'
    + "force = { across = 0.5 }\n"
)

BASE = tomllib.loads(HEAD)
CASE = {"shape": BALL, "body": STEEL, "counterbody": STEEL, "grid": GRID, **HELD}


def called(function: Any = nacre.slide, **keywords: Any) -> Any:
    return function(BALL, STEEL, STEEL, grid=GRID, **HELD | keywords)


CALLS: dict[str, Any] = {
    SLIDE: lambda: called(force=(2.0, None), torque=1e-5),
    STEPS: lambda: called(steps=[{"force": (2.0, None)}, {"force": (-2.0, None)}])[-1],
    ROLL: lambda: called(
        nacre.roll, direction="-y", spin=3.0, creepage=(1e-3, None), force=(None, 0.5)
    ),
}
each = pytest.mark.parametrize("text", CALLS, ids=["slide", "steps", "roll"])


# Keys.


def test_the_arguments_of_a_case_are_those_of_the_call() -> None:
    step = {
        **{"load": 5.0, "approach": None, "friction": 0.2, "shift": {"y": 1e-7}},
        **{"force": {"x": 1.0}, "twist": 1e-4},
    }
    step = {name: value for name, value in step.items() if value is not None}
    slide = {"friction": 0.3, "coupling": False, "steps": [step, {"approach": 1e-7, "torque": 0.0}]}
    found = Case(BASE | {"slide": slide}).arguments()
    assert (found["friction"], found["coupling"], found["load"]) == (0.3, False, 10.0)
    assert found["steps"] == [
        {**step, "shift": (None, 1e-7), "force": (1.0, None)},
        {"approach": 1e-7, "torque": 0.0},
    ]
    found = Case(BASE | {"slide": {"friction": 0, "shift": [1e-7, 0], "twist": 0.1}}).arguments()
    assert (found["shift"], found["twist"], "steps" in found) == ((1e-7, 0), 0.1, False)
    roll = {"friction": 0.3, "creepage": [1e-3, 2e-3], "cells": 3, "direction": "+x"}
    found = Case(BASE | {"roll": roll}).arguments()
    assert found["creepage"] == (1e-3, 2e-3)
    assert (found["cells"], found["direction"]) == (3, "+x")


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "no friction": ({"slide": {}}, "slide.friction: this key is missing"),
    "text": ({"slide": {"friction": "rough"}}, "slide.friction: must be a finite number, got 'rou"),
    "nan": ({"slide": {"friction": float("nan")}}, "slide.friction: must be a finite number"),
    "misspelt": ({"slide": {"friction": 0.3, "forse": 1}}, "slide.forse: there is no such key"),
    "a number": (
        {"slide": {"friction": 0.3, "force": 1}},
        "slide.force: must be a table with x, y",
    ),
    "axis": ({"slide": {"friction": 0.3, "force": {"z": 1}}}, "slide.force.z: there is no such"),
    "three": ({"slide": {"friction": 0.3, "shift": [1, 2, 3]}}, "slide.shift: must be a table"),
    "inside": (
        {"slide": {"friction": 0.3, "shift": {"x": "a"}}},
        "slide.shift.x: must be a finite",
    ),
    "steps": ({"slide": {"friction": 0.3, "steps": 3}}, "slide.steps: must be a list of tables"),
    "step": ({"slide": {"friction": 0.3, "steps": [3]}}, r"slide.steps\[0\]: "),
    "in step": (
        {"slide": {"friction": 0.3, "steps": [{}, {"colour": 1}]}},
        r"slide.steps\[1\].colour: there is no such key; the keys here are",
    ),
    "coupling": ({"slide": {"friction": 0.3, "coupling": 1}}, "slide.coupling: must be "),
    "no slide": ({"slide": 3}, "slide: must be a table"),
    "direction": (
        {"roll": {"friction": 0.3, "direction": "x"}},
        r"roll.direction: must be .*got 'x'",
    ),
    "cells": ({"roll": {"friction": 0.3, "cells": 0}}, "roll.cells: must be "),
    "half a cell": ({"roll": {"friction": 0.3, "cells": 2.5}}, "roll.cells: must be "),
    "x in roll": ({"roll": {"friction": 0.3, "force": {"x": 1}}}, "roll.force.x: there is no such"),
    "both": (
        {"slide": {"friction": 0.3}, "roll": {"friction": 0.3}},
        "roll: must not be given beside the table slide",
    ),
    "search": (
        {"solve": {"load": 1, "max_iterations": 3}, "slide": {"friction": 0.3}},
        "solve.max_iterations: must not be given beside the table slide",
    ),
    "hardness": (
        {"solve": {"load": 1, "hardness": 1e9}, "roll": {"friction": 0.3}},
        "solve.hardness: must not be given beside the table roll",
    ),
    "stress": (
        {"slide": {"friction": 0.3}, "stress": {"friction": 0.1}},
        "stress.friction: must be 0 beside the table slide: its tractions are known",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_key_is_named(name: str) -> None:
    data, message = WRONG[name]
    with pytest.raises(CaseError, match=f"^case: {message}"):
        Case(BASE | data).arguments()


# nacre solve.


@each
def test_solve_saves_the_bits_of_the_call(text: str, tmp_path: Path, capsys: Capture) -> None:
    files = [tmp_path / f"a.{ending}" for ending in ("nc", "vtr", "csv", "png")]
    saved = [option for file in files for option in ("--save", file)]
    assert command("solve", written(tmp_path, text), *saved) == 0
    expected = CALLS[text]()
    found = nacre.load(files[0])
    assert isinstance(found, nacre.types.History) == (text == STEPS)
    found = found[-1] if text == STEPS else found
    for name in ("traction", "slip", "displacement", "pressure"):
        assert getattr(found, name).tobytes() == getattr(expected, name).tobytes()
    assert all(file.stat().st_size > 0 for file in files)
    printed = capsys.readouterr().out
    assert printed.endswith(f"{expected}\n")
    if text == STEPS:
        rows = printed.splitlines()[:3]
        assert rows[0].split()[:3] == ["step", "force", "x"]
        forces = [re.split(r"  +", row.strip())[1] for row in rows[1:]]
        assert forces == ["2 N", "-2 N"]


@each
def test_json_holds_the_numbers_exactly(text: str, tmp_path: Path, capsys: Capture) -> None:
    assert command("solve", written(tmp_path, text + "[stress]\n"), "--json") == 0
    found, expected = json.loads(capsys.readouterr().out), CALLS[text]()
    assert tuple(found["force"]) == expected.force
    for name in ("torque", "dissipated", "tangential_energy"):
        assert found[name] == getattr(expected, name)
    motion = {"creepage", "spin"} if text == ROLL else {"shift", "twist"}
    assert {"creepage", "spin", "shift", "twist"} & found.keys() == motion
    assert found["friction_report"]["violation"] == expected.report.violation
    assert found["peak_pressure"] == expected.normal.peak_pressure
    assert len(found.get("steps", [])) == (2 if text == STEPS else 0)
    peak = found["stress"]["layers"][0]["von_mises"]["value"]
    assert peak == expected.stress_summary().layers[0].von_mises[0]


FAILS = {
    "force = { x = 3.5 }": "slide: force must be below what friction can carry",
    "friction = -1": "slide: friction must be finite and at least 0, got -1",
    "twist = 1e-3\ntorque = 1.0": "twist and torque, one must be given",
    "forse = 1": "slide.forse: there is no such key",
}


@pytest.mark.parametrize("line", FAILS)
def test_what_fails_is_one_line(line: str, tmp_path: Path, capsys: Capture) -> None:
    first = "" if line.startswith("friction") else "friction = 0.3\n"
    path, out = written(tmp_path, f"{HEAD}[slide]\n{first}{line}\n"), tmp_path / "out.nc"
    assert command("solve", path, "--save", out) == 2
    printed, err = capsys.readouterr()
    assert (printed, err.count("\n")) == ("", 1)
    assert FAILS[line] in err
    assert not out.exists()


@pytest.mark.slow
def test_what_does_not_converge_is_exit_code_1(tmp_path: Path, capsys: Capture) -> None:
    text = SLIDE.replace("load = 10.0", "load = 10.0\ntolerance = 1e-16")
    out = tmp_path / "out.nc"
    assert command("solve", written(tmp_path, text), "--save", out) == 1
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "not converged" in err
    assert not out.exists()


# Studies.

OUTPUTS = ["force", "torque", "shift", "twist", "dissipated", "tangential_energy", "load"]


def test_a_study_has_the_outputs_of_friction(tmp_path: Path) -> None:
    case = CASE | {"steps": [{"force": (1.0, None)}, {"force": (0.5, 0.2), "torque": 1e-6}]}
    parameters, store = {"friction": [0.2, 0.3]}, tmp_path / "a.nc"
    study = nacre.sweep(case, parameters, outputs=OUTPUTS, store=store, progress=False)
    for friction in (0.2, 0.3):
        one, expected = study.sel(friction=friction), called(steps=case["steps"], friction=friction)
        for name in OUTPUTS[:-1]:
            np.testing.assert_array_equal(one[name], getattr(expected[-1], name))
    assert study.force.dims[0] == "friction"
    assert {name: study[name].attrs["units"] for name in OUTPUTS} == {
        **{"force": "N", "torque": "N m", "shift": "m", "twist": "rad", "load": "N"},
        **{"dissipated": "J", "tangential_energy": "J"},
    }
    journal = (tmp_path / "a.journal").read_bytes()
    again = nacre.sweep(case, parameters, outputs=OUTPUTS, store=store, progress=False)
    xarray.testing.assert_identical(again, study)
    assert (tmp_path / "a.journal").read_bytes() == journal


def test_a_study_of_rolling() -> None:
    case = CASE | {"direction": "-x", "creepage": (1e-3, None)}
    outputs = ["force", "creepage", "dissipated", "von_mises"]
    with pytest.warns(nacre.NacreWarning, match="unresolved stress"):  # of 32 cells
        study = nacre.sweep(case, {"spin": [0.0, 10.0]}, outputs=outputs, progress=False)
    expected = called(nacre.roll, direction="-x", creepage=(1e-3, None), spin=10.0)
    one = study.sel(spin=10.0)
    for name in ("force", "creepage", "dissipated"):
        np.testing.assert_array_equal(one[name], getattr(expected, name))
    assert one.von_mises == expected.stress_summary(threads=1).layers[0].von_mises[0]
    assert study.dissipated.attrs["units"] == "J/m"


def test_outputs_that_the_case_has_not_are_the_cases_error() -> None:
    case = {name: value for name, value in CASE.items() if name != "counterbody"}
    for output, keywords, said in [
        ("creepage", {}, "the output creepage is not one of sliding"),
        ("shift", {"direction": "+x"}, "the output shift is not one of rolling"),
    ]:
        with pytest.warns(nacre.NacreWarning, match="1 cases failed|1 of 1 cases failed"):
            study = nacre.sweep(case | keywords, {"load": [9.0]}, outputs=[output], progress=False)
        assert said in study.error.item()
    del case["friction"]
    with pytest.warns(nacre.NacreWarning, match="failed"):
        study = nacre.sweep(case, {"load": [9.0]}, outputs=["force"], progress=False)
    assert "the output force needs friction in the case" in study.error.item()
    with pytest.raises(TypeError, match=r"or nacre\.indent\.solve, got \['cells', 'shift'\]"):
        nacre.sweep(case | {"shift": (1, 1), "cells": 3}, {"load": [9.0]}, progress=False)


def test_a_study_may_go_on_from_a_solution(tmp_path: Path) -> None:
    before = called(force=(2.0, None))
    case = CASE | {"initial": before, "force": (1.0, None)}
    keywords: dict[str, Any] = {"outputs": ["force", "dissipated"], "progress": False}
    store = tmp_path / "a.nc"
    study = nacre.sweep(case, {"friction": [0.3, 0.4]}, store=store, **keywords)
    expected = called(initial=before, force=(1.0, None))
    assert study.dissipated.values[0] == expected.dissipated
    # Another state is another case.
    case["initial"] = called(force=(-2.0, None))
    other = nacre.sweep(case, {"friction": [0.3, 0.4]}, store=tmp_path / "b.nc", **keywords)
    assert other.dissipated.values[0] != study.dissipated.values[0]
    del case["friction"]
    for name, kept in (("a", False), ("b", True)):
        journal = tmp_path / f"{name}.journal"
        before_it = journal.read_bytes()
        nacre.sweep(case, {"friction": [0.3, 0.4]}, store=tmp_path / f"{name}.nc", **keywords)
        assert (journal.read_bytes() == before_it) is kept


SWEPT: dict[str, tuple[str, str, list[float], Any]] = {
    "slide": (SLIDE, "slide.force.x", [1.0, 2.0], lambda x: called(force=(x, None), torque=1e-5)),
    "steps": (
        STEPS,
        "slide.steps[1].force.x",
        [-1.0, 1.0],
        lambda x: called(steps=[{"force": (2.0, None)}, {"force": (x, None)}])[-1],
    ),
    "roll": (
        ROLL,
        "roll.creepage.along",
        [1e-4, 1e-3],
        lambda x: called(
            nacre.roll, direction="-y", spin=3.0, creepage=(x, None), force=(None, 0.5)
        ),
    ),
}


@pytest.mark.parametrize("name", SWEPT)
def test_nacre_sweep_changes_keys_of_friction(name: str, tmp_path: Path, capsys: Capture) -> None:
    text, key, numbers, call = SWEPT[name]
    sweep = f'[sweep]\nparameters."{key}" = {numbers}\noutputs = ["force", "dissipated"]\n'
    path, store = written(tmp_path, text + sweep), tmp_path / "study.nc"
    assert command("sweep", path, "--store", store) == 0
    assert "2 cases, 0 failed" in capsys.readouterr().out
    study = xarray.load_dataset(store, engine="h5netcdf")
    for number in numbers:
        one, expected = study.sel({key: number}), call(number)
        assert one.dissipated.item() == expected.dissipated
        assert tuple(one.force.values) == expected.force


@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # the grid ends within the contact
def test_a_roller_rolls_in_a_study_without_a_direction(tmp_path: Path) -> None:
    data = BASE | {
        "shape": {"kind": "roller", "radius": 5e-3, "flat_length": 1e-4, "crown_radius": 0.02},
        "roll": {"friction": 0.3, "force": {"along": 1.0}},
        "sweep": {"parameters": {"solve.load": [10.0]}, "outputs": ["creepage", "force"]},
    }
    case = Case(data)
    study = nacre.sweep(case, progress=False, **case.study())
    assert study.error.values.tolist() == [""]
    assert study.force.values[0] == pytest.approx([0.0, 1.0], abs=1e-6)


def test_failed_cases_of_a_study_are_exit_code_1(tmp_path: Path, capsys: Capture) -> None:
    sweep = '[sweep]\nparameters."slide.force.x" = [1.0, 4.0]\noutputs = ["dissipated"]\n'
    assert command("sweep", written(tmp_path, SLIDE + sweep)) == 1
    out = capsys.readouterr().out
    assert "2 cases, 1 failed" in out
    assert "failed at slide.force.x = 4.0: ValueError: force must be below what friction" in out
