"""A case file and the Python call give the same bits; an error in one names its key."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import nacre
import nacre.cli
from nacre.case import Case, CaseError

TEXT = """
[materials]
steel = { young = 210e9, poisson = 0.3 }
dlc = { young = 420e9, poisson = 0.3 }

[shape]
kind = "roller"
radius = 5e-3
flat_length = 8e-3
crown_radius = 2

[body]
substrate = "steel"
layers = [{ material = "dlc", thickness = 40e-6 }]

[grid]
shape = [96, 40]
size = [14e-3, 2e-4]

[solve]
load = 1e3
eccentricity = { x = 1e-3 }

[sweep]
store = "study.nc"
outputs = ["peak_pressure", "tilt"]
parameters."materials.dlc.young" = [105e9, 420e9]
parameters."solve.load" = { first = 500, last = 1000, count = 3, scale = "log" }
"""

STEEL, DLC = nacre.Elastic(210e9, 0.3), nacre.Elastic(420e9, 0.3)
ROLLER = nacre.Roller(5e-3, 8e-3, 2)


def written(folder: Path, text: str = TEXT) -> Path:
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return path


def same_call(young: float = 420e9, load: float = 1e3) -> nacre.Solution:
    body = nacre.HalfSpace(STEEL, layers=[nacre.Layer(nacre.Elastic(young, 0.3), 40e-6)])
    grid = nacre.Grid((96, 40), (14e-3, 2e-4))
    return nacre.solve(ROLLER, body, grid=grid, load=load, eccentricity=(1e-3, None))


def nacre_command(*arguments: object) -> int:
    with pytest.raises(SystemExit) as error:
        nacre.cli.main([str(argument) for argument in arguments])
    assert isinstance(error.value.code, int)
    return error.value.code


def test_a_case_file_and_the_python_call_give_the_same_bits(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out.nc"
    assert nacre_command("solve", written(tmp_path), "--save", out) == 0
    assert capsys.readouterr().out == f"{same_call()}\n"
    saved, expected = nacre.load(out), same_call()
    for name in ("pressure", "gap", "displacement"):
        assert getattr(saved, name).tobytes() == getattr(expected, name).tobytes()
    assert (saved.approach, saved.tilt) == (expected.approach, expected.tilt)


def test_json_holds_the_numbers_exactly(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert nacre_command("solve", written(tmp_path), "--json") == 0
    found = json.loads(capsys.readouterr().out)
    expected = same_call()
    assert found["peak_pressure"] == expected.peak_pressure
    assert tuple(found["tilt"]) == expected.tilt
    assert found["termination"] == "converged"
    assert found["nacre"] == nacre.__version__


def test_a_study_in_a_case_file_is_that_of_sweep(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path)
    assert nacre_command("sweep", path) == 0
    printed = capsys.readouterr().out
    assert "6 cases, 0 failed" in printed
    study = xarray.load_dataset(tmp_path / "study.nc", engine="h5netcdf")
    loads = [float(load) for load in np.geomspace(500, 1000, 3)]
    assert study["solve.load"].values.tolist() == loads
    for young in (105e9, 420e9):
        one = study.sel({"materials.dlc.young": young, "solve.load": loads[1]})
        expected = same_call(young, loads[1])
        assert float(one.peak_pressure) == expected.peak_pressure
        assert f"{expected.peak_pressure:.5g}" in printed
        assert tuple(one.tilt.values) == expected.tilt
    journal = (tmp_path / "study.journal").read_bytes()
    assert nacre_command("sweep", path, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["data_vars"]["peak_pressure"]["data"] == study.peak_pressure.values.tolist()
    assert (tmp_path / "study.journal").read_bytes() == journal  # nothing was solved again


def test_a_printed_study_has_estimated_errors_and_counts_warnings(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (
        TEXT.partition("[shape]")[0]
        + """
[shape]
kind = "sphere"
radius = 5e-3

[body]
substrate = "steel"

[grid]
shape = [64, 64]
size = [2e-4, 2e-4]

[sweep]
outputs = ["peak_pressure"]
parameters."solve.load" = [5.0, 1e3]
[solve]
load = 1.0
"""
    )
    assert nacre_command("sweep", written(tmp_path, text)) == 0
    printed = capsys.readouterr().out
    grid = nacre.Grid((64, 64), (2e-4, 2e-4))
    expected = nacre.solve(nacre.Sphere(5e-3), STEEL, grid=grid, load=5.0)
    assert expected.report.discretisation is not None
    share = 100 * abs(expected.report.discretisation["peak_pressure"] / expected.peak_pressure)
    assert f"{expected.peak_pressure:.5g} ± {share:.1g} %" in printed
    assert "1 of 2 cases have warnings: grid edge (1); see warnings in the Dataset\n" in printed


def test_failed_cases_of_a_study_are_exit_code_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = TEXT.replace("first = 500", "first = -500").replace(', scale = "log"', "")
    assert nacre_command("sweep", written(tmp_path, text), "--store", tmp_path / "b.nc") == 1
    out = capsys.readouterr().out
    assert "6 cases, 2 failed" in out
    assert out.count("load must be finite and above 0, got -500") == 2


def test_a_solve_that_does_not_converge_is_exit_code_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = TEXT.replace("load = 1e3", "load = 1e3\nmax_iterations = 1")
    out = tmp_path / "out.nc"
    assert nacre_command("solve", written(tmp_path, text), "--save", out) == 1
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "residual" in err
    assert not out.exists()


def test_a_layer_has_the_name_of_the_case_file(tmp_path: Path) -> None:
    text = TEXT.replace("thickness = 40e-6", 'thickness = 40e-6, name = "DLC"')
    assert text != TEXT
    body = Case.read(written(tmp_path, text)).arguments()["body"]
    assert [layer.name for layer in body.layers] == ["DLC"]


STRESSED = (
    TEXT.replace("[sweep]", '[stress]\nfriction = 0.2\n\n[sweep]\nstore = "b.nc"', 1)
    .replace('\nstore = "study.nc"', "")
    .replace("poisson = 0.3 }", "poisson = 0.3, strength = 2e9, yield_stress = 3e9 }", 1)
)


def test_stresses_that_a_case_asks_for_are_those_of_the_summary(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    solution = same_call()
    summary = solution.stress_summary(
        friction=0.2, yield_stress={"substrate": 3e9}, strength={"substrate": 2e9}
    )
    path = written(tmp_path, STRESSED)
    assert nacre_command("solve", path) == 0
    assert capsys.readouterr().out == f"{solution}\n\n{summary}\n"
    assert nacre_command("solve", path, "--json") == 0
    found = json.loads(capsys.readouterr().out)["stress"]
    coating, substrate = found["layers"]
    value, place = summary.layers[1].von_mises
    assert substrate["von_mises"] == {"value": value, "at": list(place)}
    assert substrate["yield_margin"] == 3e9 / value
    assert coating["yield_margin"] is None
    assert coating["depths"] == [0.0, 40e-6]
    assert substrate["depths"] == [40e-6, None]
    assert found["interfaces"][0]["shear"]["value"] == summary.interfaces[0].shear[0]


def test_stresses_of_a_study_have_the_friction_of_the_case(tmp_path: Path) -> None:
    outputs = 'outputs = ["peak_pressure", "tilt"]'
    path = written(tmp_path, STRESSED.replace(outputs, 'outputs = ["interface_shear"]'))
    assert nacre_command("sweep", path) == 0
    study = xarray.load_dataset(tmp_path / "b.nc", engine="h5netcdf")
    one = study.sel({"materials.dlc.young": 420e9, "solve.load": 1000.0}, method="nearest")
    expected = same_call(load=one["solve.load"].item()).stress_summary(friction=0.2)
    assert one.interface_shear == expected.interfaces[0].shear[0]


@pytest.mark.parametrize(
    ("command", "change", "message"),
    [
        ("solve", "friction = 0.2 -> friction = -1", "stress: friction must be at least 0"),
        ("solve", "friction = 0.2 -> fiction = 1", "stress.fiction: there is no such key"),
        ("solve", 'friction = 0.2 -> body = "x"', "stress.body: should be 'body' or 'counterbody'"),
        ("solve", 'friction = 0.2 -> body = "counterbody"', 'stress: body must be "body" where'),
        ("solve", "strength = 2e9 -> strength = -2", "stress: strength must be finite and above 0"),
        ("sweep", '"solve.load" -> "stress.friction"', "'stress.friction' changes nothing in a"),
        (
            "sweep",
            '"materials.dlc.young" -> "materials.steel.strength"',
            "'materials.steel.strength' changes nothing in a solve",
        ),
    ],
)
def test_an_error_about_stresses_is_one_line(
    command: str, change: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new = change.split(" -> ")
    assert old in STRESSED
    assert nacre_command(command, written(tmp_path, STRESSED.replace(old, new, 1))) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert message in err


ERRORS = {
    'radius = 5e-3 -> radius = "5"': "shape.radius: should be a valid number, got '5'",
    "radius = 5e-3 -> radius = -5": "shape: radius must be finite and above 0, got -5",
    "radius = 5e-3 -> radius = nan": "shape.radius: should be a finite number, got nan",
    "radius = 5e-3 -> ": "shape.radius: this key is missing",
    "flat_length -> flt_length": "shape.flt_length: there is no such key",
    "crown_radius = 2 -> ": "shape: either flat_length and crown_radius or profile must be given",
    '"roller" -> "roler"': "shape.kind: should be one of 'sphere'",
    'kind = "roller" -> ': "shape.kind: should be one of 'sphere'",
    "load = 1e3 -> load = true": "solve.load: should be a valid number, got True",
    "load = 1e3 -> ": "solve: exactly one of load and approach must be given",
    "load = 1e3 -> load = 1\napproach = 1": "solve: exactly one of load and approach",
    "{ x = 1e-3 } -> { z = 1e-3 }": "solve.eccentricity.z: there is no such key",
    "{ x = 1e-3 } -> [1e-3]": "solve.eccentricity",
    '"dlc", -> "dlx",': "body.layers.0: must be one of the materials (steel, dlc), got 'dlx'",
    '"steel" -> "stel"': "body.substrate: must be one of the materials (steel, dlc), got 'stel'",
    "thickness = 40e-6 -> thickness = 0": "body.layers.0: thickness must be finite and above 0",
    "thickness = 40e-6 -> thick = 1": "body.layers.0.thick: there is no such key",
    "young = 420e9 -> young = -1": "materials.dlc: young must be finite and above 0, got -1",
    "[solve] -> [solv]": "solv: there is no such key",
    "[96, 40] -> [96]": "grid.shape: list should have at least 2 items",
    "[96, 40] -> [96, 0]": "grid.shape.1: should be greater than 0, got 0",
    "shape = [96, 40] -> ": "grid: either shape and size or, for a line contact, cells and width",
    "[materials] -> [materials": "not a TOML file",
}


# Whether a motion is complete is found when it is solved; a study records it.
CALLS = [("solve", change) for change in ERRORS]
CALLS += [("sweep", change) for change in ERRORS if not ERRORS[change].startswith("solve: ")]


@pytest.mark.parametrize(("command", "change"), CALLS)
def test_an_error_is_one_line_that_names_the_key(
    command: str, change: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new = change.split(" -> ")
    assert old in TEXT
    path = written(tmp_path, TEXT.replace(old, new, 1))
    assert nacre_command(command, path) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"nacre: {path}: ")
    assert err.count("\n") == 1
    assert ERRORS[change] in err
    assert [file.name for file in tmp_path.iterdir()] == ["case.toml"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ('"materials.dlc -> "materials.dlx', "'materials.dlx.young' is not a key of this case"),
        ('"solve.load" -> "solve.approach"', "'solve.approach' is not a key of this case"),
        ("count = 3 -> count = 0", "sweep.parameters.solve.load"),
        ("first = 500 -> first = 0", "must be above 0 on a logarithmic scale"),
        ("[105e9, 420e9] -> []", "sweep.parameters.materials.dlc.young"),
        ('"peak_pressure" -> "peak"', "outputs must be attributes of Solution"),
        ('"study.nc" -> "study.txt"', "store must end in .nc"),
    ],
)
def test_an_error_in_a_study_is_found_before_it_begins(
    change: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new = change.split(" -> ")
    assert old in TEXT
    assert nacre_command("sweep", written(tmp_path, TEXT.replace(old, new, 1))) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert message in err
    assert [file.name for file in tmp_path.iterdir()] == ["case.toml"]


def test_without_a_study_or_a_file_there_is_an_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert nacre_command("sweep", written(tmp_path, TEXT.partition("[sweep]")[0])) == 2
    assert "sweep: this table is missing" in capsys.readouterr().err
    assert nacre_command("solve", tmp_path / "none.toml") == 2
    assert "No such file" in capsys.readouterr().err
    assert nacre_command("solve", written(tmp_path), "--save", "a.txt") == 2
    assert "must end in .csv" in capsys.readouterr().err


def test_in_a_process_there_is_no_traceback(tmp_path: Path) -> None:
    path = written(tmp_path, TEXT.replace("[solve]", "[solv]"))
    command = [sys.executable, "-m", "nacre.cli", "solve", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)


def base(**tables: Any) -> dict[str, Any]:
    body = {"substrate": {"young": 210e9, "poisson": 0.3}}
    return {"shape": {"kind": "sphere", "radius": 1}, "body": body, "solve": {"load": 1}} | tables


@pytest.mark.parametrize(
    ("table", "shape"),
    [
        ({"kind": "sphere", "radius": 1}, nacre.Sphere(1)),
        ({"kind": "cylinder", "radius": 1.5}, nacre.Cylinder(1.5)),
        ({"kind": "flat_punch", "radius": 1}, nacre.FlatPunch(1)),
        ({"kind": "paraboloid", "radius_x": 1, "radius_y": 2}, nacre.Paraboloid(1, 2)),
        ({"kind": "sphere", "radius": 1, "shift": [1, 2]}, nacre.Sphere(1).shifted(1, 2)),
        (
            {
                "kind": "roller",
                "radius": 1,
                "length": 9,
                "profile": {"kind": "logarithmic", "amplitude": 1e-6, "length": 2},
            },
            nacre.Roller(1, length=9, profile=nacre.LogarithmicProfile(1e-6, 2)),
        ),
        (
            {
                "kind": "roller",
                "radius": 1,
                "profile": {"kind": "iso16281", "diameter": 2, "length": 3},
            },
            nacre.Roller(1, profile=nacre.LogarithmicProfile.iso16281(2, 3)),
        ),
        (
            {
                "kind": "roller",
                "radius": 1,
                "profile": {"kind": "sampled", "x": [0, 1, 2], "drop": [0, 0, 1e-3]},
            },
            nacre.Roller(1, profile=([0, 1, 2], [0, 0, 1e-3])),
        ),
        (
            {
                "kind": "sum",
                "parts": [
                    {"kind": "sphere", "radius": 1},
                    {"kind": "height_map", "path": "a.npy", "spacing": 0.5, "detrend": "none"},
                ],
            },
            nacre.Sphere(1) + nacre.HeightMap([[0.0, 1.0], [2.0, 3.0]], 0.5),
        ),
    ],
    ids=lambda value: value["kind"] if isinstance(value, dict) else None,
)
def test_every_shape_can_be_described(
    table: dict[str, Any], shape: nacre.Shape, tmp_path: Path
) -> None:
    np.save(tmp_path / "a.npy", np.arange(4.0).reshape(2, 2))
    assert Case(base(shape=table), folder=tmp_path).arguments()["shape"] == shape


def test_bodies_grids_and_motions_can_be_described() -> None:
    layer = {"material": {"young": 1e9, "poisson": 0.5}, "thickness": 1e-3}
    found = Case(
        base(
            body={"substrate": "rigid", "layers": [layer | {"interface": "frictionless"}]},
            counterbody={"substrate": {"young": 3, "poisson": 0.1}},
            grid={"cells": 64, "width": 2, "center": 0.5},
            solve={"approach": 1, "tilt": [1, 2], "moment": {"y": 3}, "threads": 2},
        )
    ).arguments()
    soft = nacre.Layer(nacre.Elastic(1e9, 0.5), 1e-3, "frictionless")
    assert found == {
        "shape": nacre.Sphere(1),
        "body": nacre.HalfSpace(nacre.RIGID, [soft]),
        "counterbody": nacre.HalfSpace(nacre.Elastic(3, 0.1)),
        "grid": nacre.Grid.line(64, 2, 0.5),
        "approach": 1,
        "tilt": (1, 2),
        "moment": (None, 3),
        "threads": 2,
    }


def test_a_case_can_be_called_with_other_values() -> None:
    case = Case(base())
    assert case(**{"shape.radius": 3.0})["shape"] == nacre.Sphere(3)
    assert case()["shape"] == nacre.Sphere(1)
    with pytest.raises(CaseError, match=re.escape("'shape.size' is not a key of this case")):
        case(**{"shape.size": 1})


def test_the_case_in_the_documentation_is_one(tmp_path: Path) -> None:
    doc = nacre.case.__doc__ or ""
    text = "\n".join(line.removeprefix("    ") for line in doc.split("::", 1)[1].splitlines())
    case = Case.read(written(tmp_path, text))
    assert case.arguments()["load"] == 1e3
    assert len(case.study()["parameters"]["solve.load"]) == 10
