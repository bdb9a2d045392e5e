"""A case file and the Python call give the same bits; an error in one names its key."""

from __future__ import annotations

import functools
import json
import math
import operator
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import nacre
from bodies import STEEL, coated
from nacre.case import Case, CaseError
from shapes import TABLES
from support import Capture, command, python, written

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

ROLLER = nacre.Roller(5e-3, 8e-3, 2)


def same_call(young: float = 420e9, load: float = 1e3) -> nacre.Solution:
    grid = nacre.Grid((96, 40), (14e-3, 2e-4))
    return nacre.solve(
        ROLLER, coated(young, 40e-6), grid=grid, load=load, eccentricity=(1e-3, None)
    )


def test_a_case_file_and_the_python_call_give_the_same_bits(
    tmp_path: Path, capsys: Capture
) -> None:
    out = tmp_path / "out.nc"
    assert command("solve", written(tmp_path, TEXT), "--save", out) == 0
    assert capsys.readouterr().out == f"{same_call()}\n"
    saved, expected = nacre.load(out), same_call()
    for name in ("pressure", "gap", "displacement"):
        assert getattr(saved, name).tobytes() == getattr(expected, name).tobytes()
    assert (saved.approach, saved.tilt) == (expected.approach, expected.tilt)


def test_json_holds_the_numbers_exactly(tmp_path: Path, capsys: Capture) -> None:
    assert command("solve", written(tmp_path, TEXT), "--json") == 0
    found = json.loads(capsys.readouterr().out)
    expected = same_call()
    assert found["peak_pressure"] == expected.peak_pressure
    assert tuple(found["tilt"]) == expected.tilt
    assert found["termination"] == "converged"
    assert found["nacre"] == nacre.__version__


def test_a_study_in_a_case_file_is_that_of_sweep(tmp_path: Path, capsys: Capture) -> None:
    path = written(tmp_path, TEXT)
    assert command("sweep", path) == 0
    printed = capsys.readouterr().out
    assert printed.split()[:4] == ["materials.dlc.young", "[GPa]", "solve.load", "[kN]"]
    assert printed.splitlines()[1].split()[:2] == ["105", "0.5"]
    assert "6 cases, 0 failed" in printed
    study = xarray.load_dataset(tmp_path / "study.nc", engine="h5netcdf")
    loads = [float(load) for load in np.geomspace(500, 1000, 3)]
    assert study["solve.load"].values.tolist() == loads
    for young in (105e9, 420e9):
        one = study.sel({"materials.dlc.young": young, "solve.load": loads[1]})
        expected = same_call(young, loads[1])
        assert float(one.peak_pressure) == expected.peak_pressure
        assert f"{expected.peak_pressure / 1e9:.5g}" in printed
        assert tuple(one.tilt.values) == expected.tilt
    journal = (tmp_path / "study.journal").read_bytes()
    assert command("sweep", path, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["data_vars"]["peak_pressure"]["data"] == study.peak_pressure.values.tolist()
    assert (tmp_path / "study.journal").read_bytes() == journal  # nothing was solved again


def test_a_printed_study_has_estimated_errors_and_counts_warnings(
    tmp_path: Path, capsys: Capture
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
    assert command("sweep", written(tmp_path, text)) == 0
    printed = capsys.readouterr().out
    grid = nacre.Grid((64, 64), (2e-4, 2e-4))
    expected = nacre.solve(nacre.Sphere(5e-3), STEEL, grid=grid, load=5.0)
    assert expected.report.discretisation is not None
    error = expected.report.discretisation["peak_pressure"]
    assert error is not None
    share = 100 * abs(error / expected.peak_pressure)
    assert f"{expected.peak_pressure / 1e9:.5g} ± {share:.1g} %" in printed
    assert "1 of 2 cases have warnings: grid edge (1); see warnings in the Dataset\n" in printed


def test_failed_cases_of_a_study_are_exit_code_1(tmp_path: Path, capsys: Capture) -> None:
    text = TEXT.replace("first = 500", "first = -500").replace(', scale = "log"', "")
    assert command("sweep", written(tmp_path, text), "--store", tmp_path / "b.nc") == 1
    out = capsys.readouterr().out
    assert "6 cases, 2 failed" in out
    assert out.count("load must be finite and above 0, got -500") == 2


def test_a_solve_that_does_not_converge_is_exit_code_1(tmp_path: Path, capsys: Capture) -> None:
    text = TEXT.replace("load = 1e3", "load = 1e3\nmax_iterations = 1")
    out = tmp_path / "out.nc"
    assert command("solve", written(tmp_path, text), "--save", out) == 1
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "residual" in err
    assert not out.exists()


def test_a_layer_has_the_name_of_the_case_file(tmp_path: Path) -> None:
    text = TEXT.replace("thickness = 40e-6", 'thickness = 40e-6, name = "DLC"')
    assert text != TEXT
    body = Case.read(written(tmp_path, text)).arguments()["body"]
    assert [layer.name for layer in body.layers] == ["DLC"]


ROLLED = 'kind = "roller"\nradius = 5e-3\nflat_length = 8e-3\ncrown_radius = 2'
SPHERE = 'kind = "sphere"\nradius = 5e-3'
STRESSED = (
    TEXT.replace("[sweep]", '[stress]\nfriction = 0.2\n\n[sweep]\nstore = "b.nc"', 1)
    .replace('\nstore = "study.nc"', "")
    .replace("poisson = 0.3 }", "poisson = 0.3, strength = 2e9, yield_stress = 3e9 }", 1)
)


@pytest.mark.slow
def test_stresses_that_a_case_asks_for_are_those_of_the_summary(
    tmp_path: Path, capsys: Capture
) -> None:
    solution = same_call()
    summary = solution.stress_summary(
        friction=0.2, yield_stress={"substrate": 3e9}, strength={"substrate": 2e9}
    )
    path = written(tmp_path, STRESSED)
    assert command("solve", path) == 0
    assert capsys.readouterr().out == f"{summary}\n\n{solution}\n"
    assert command("solve", path, "--json") == 0
    found = json.loads(capsys.readouterr().out)["stress"]
    coating, substrate = found["layers"]
    value, place = summary.layers[1].von_mises
    error = summary.layers[1].uncertainty["von_mises"]
    assert substrate["von_mises"] == {"value": value, "at": list(place), "uncertainty": error}
    assert substrate["yield_safety_factor"] == 3e9 / value
    assert coating["yield_safety_factor"] is None
    assert coating["depths"] == [0.0, 40e-6]
    assert substrate["depths"] == [40e-6, None]
    assert found["interfaces"][0]["shear"]["value"] == summary.interfaces[0].shear[0]


@pytest.mark.slow
def test_stresses_of_a_study_have_the_friction_of_the_case(tmp_path: Path) -> None:
    outputs = 'outputs = ["peak_pressure", "tilt"]'
    text = STRESSED.replace(outputs, 'outputs = ["interface_shear"]').replace("[105e9, ", "[")
    path = written(tmp_path, text.replace("count = 3", "count = 2"))
    assert command("sweep", path) == 0
    study = xarray.load_dataset(tmp_path / "b.nc", engine="h5netcdf")
    one = study.sel({"materials.dlc.young": 420e9, "solve.load": 1000.0}, method="nearest")
    expected = same_call(load=one["solve.load"].item()).stress_summary(friction=0.2)
    assert one.interface_shear == expected.interfaces[0].shear[0]


ERRORS = {
    'radius = 5e-3 -> radius = "5"': "shape.radius: must be a number in m or in another "
    "unit of its kind, got '5'",
    "radius = 5e-3 -> radius = -5": "shape: radius must be that of a convex shape",
    "radius = 5e-3 -> radius = nan": "shape.radius: must be a finite number, got nan",
    "radius = 5e-3 -> ": "shape.radius: this key is missing",
    "flat_length -> flt_length": "shape.flt_length: there is no such key; the keys here are flat_",
    "crown_radius = 2 -> ": "shape: either flat_length and crown_radius or profile must be given",
    '"roller" -> "roler"': "shape.kind: must be one of 'roller', ",
    '"roller" -> ["roller"]': "shape.kind: must be one of ",
    'kind = "roller" -> ': "; this key is missing",
    "load = 1e3 -> load = true": "solve.load: must be a finite number, got True",
    "load = 1e3 -> load = 1979-05-27": "solve.load: must be a finite number, got datetime.date(",
    "load = 1e3 -> ": "solve: exactly one of load and approach must be given",
    "load = 1e3 -> load = 1\napproach = 1": "solve: exactly one of load and approach",
    "{ x = 1e-3 } -> { z = 1e-3 }": "solve.eccentricity.z: there is no such key; the keys here",
    "{ x = 1e-3 } -> [1e-3]": "solve.eccentricity: must be a table with x, y or both, or a pair of "
    "finite numbers, got [0.001]",
    '"dlc", -> "dlx",': "body.layers[0].material: must be one of the materials (steel, dlc)",
    '"steel" -> "stel"': "body.substrate: must be one of the materials (steel, dlc), got 'stel'",
    "thickness = 40e-6 -> thickness = 0": "body.layers[0]: thickness must be finite and above 0",
    "thickness = 40e-6 -> thick = 1": "layers[0].thick: there is no such key; the keys here are",
    "young = 420e9 -> young = -1": "materials.dlc: young must be finite and above 0, got -1",
    "[solve] -> [solv]": "solv: there is no such key; the keys here are solve, ",
    "[96, 40] -> [96]": "grid.shape: must be a pair of integers above 0, got [96]",
    "[96, 40] -> [96, 0]": "grid.shape: must be a pair of integers above 0, got [96, 0]",
    "shape = [96, 40] -> ": "grid: must have shape and size or, for a line contact, cells",
    "[materials] -> [materials": "not a TOML file",
    "[materials] -> x = [materials]": "not a TOML file",
    "size = [14e-3, 2e-4] -> size = [14e-3, 2e-4]\ncenter = 1e-3": "grid: center must be a pair of",
    "shape = [96, 40] -> cells = 96\nwidth = 1e-3\ncenter = [0, 0]\n#": "grid: must have shape and",
    'substrate = "steel" -> substrate = 3': "body.substrate: must be the name of a material, or a "
    "table with young and poisson, got 3",
    "poisson = 0.3 } -> poison = 0.3 }": "materials.steel.poison: there is no such key; the keys",
    "[materials] -> units = 'N-mm-kPa'\n[materials]": "units: units must be consistent, ",
    "[body]\n -> [body]\nends = [1e-3]\n": "body.ends: must be a pair of numbers, or of -inf "
    "and inf where the body has no end, got [0.001]",
    '[body]\n -> [body]\nends = "none"\n': "body.ends: must be a pair of numbers, or",
    "[body]\n -> [body]\nends = [1, -1]\n": "body: ends must be in ascending order",
    "[body]\n -> [body]\nends = [inf, 1]\n": "body: ends must be finite, got inf",
    "[materials] -> units = 3\n[materials]": "units: must be a text, got 3",
}


STUDY_ERRORS = {
    '"materials.dlc -> "materials.dlx': "'materials.dlx.young' is not a key of this case",
    '"solve.load" -> "solve.approach"': "'solve.approach' is not a key of this case",
    "count = 3 -> count = 0": "sweep.parameters.solve.load",
    "first = 500 -> first = 0": "must be above 0 on a logarithmic scale",
    "[105e9, 420e9] -> []": "sweep.parameters.materials.dlc.young",
    '"peak_pressure" -> "peak"': "sweep: outputs must be attributes of Solution",
    '"peak_pressure" -> "stiffness"': "sweep: outputs must be attributes of Solution",
    '"peak_pressure" -> "report"': "sweep: outputs must be attributes of Solution",
    "[105e9, 420e9] -> 105e9": "sweep.parameters.materials.dlc.young: must be a list of values",
    '"materials.dlc -> "body.layers[1]': "is not a key of this case; the nearest are body.",
    '"solve.load" -> "sweep.store"': "changes nothing in a solve",
    '"study.nc" -> "study.txt"': "store must end in .nc",
}
STRESS_ERRORS = {
    'friction = 0.2 -> refine = "fine"': "stress.refine: must be true or false or a finite number",
    "friction = 0.2 -> friction = -1": "stress: friction must be at least 0",
    "friction = 0.2 -> fiction = 1": "stress.fiction: there is no such key; the keys here are fric",
    'friction = 0.2 -> body = "x"': 'stress.body: must be "body" or "counterbody", got',
    'friction = 0.2 -> body = "counterbody"': 'stress: body must be "body" where',
    "strength = 2e9 -> strength = -2": "stress: strength must be finite and above 0",
    f"{ROLLED} -> {SPHERE}": "stress: direction must be given where friction is above 0",
}
STRESS_STUDY_ERRORS = {
    '"solve.load" -> "stress.friction"': "'stress.friction' changes nothing in a",
    '"materials.dlc.young" -> "materials.steel.strength"': "strength' changes nothing in a solve",
}

CALLS = [
    *(("solve", TEXT, change, message) for change, message in ERRORS.items()),
    # Whether a motion is complete is found when it is solved; a study records it.
    *(
        ("sweep", TEXT, change, message)
        for change, message in (ERRORS | STUDY_ERRORS).items()
        if not message.startswith("solve: ")
    ),
    *(("solve", STRESSED, change, message) for change, message in STRESS_ERRORS.items()),
    *(("sweep", STRESSED, change, message) for change, message in STRESS_STUDY_ERRORS.items()),
]


@pytest.mark.parametrize(("verb", "text", "change", "message"), CALLS)
def test_an_error_is_one_line_that_names_the_key(
    verb: str, text: str, change: str, message: str, tmp_path: Path, capsys: Capture
) -> None:
    old, new = change.split(" -> ")
    assert old in text
    path = written(tmp_path, text.replace(old, new, 1))
    assert command(verb, path) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"nacre: {path}: ")
    assert err.count("\n") == 1
    assert message in err
    assert [file.name for file in tmp_path.iterdir()] == ["case.toml"]


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (
            'body.layers = [LAYER]\n[shape]\nkind = "sphere"\nradius = 1\n[solve]\nload = 1\n',
            r"body\.layers: must be a list of tables, at most 1000, got",
        ),
        (
            'body.layers = []\n[shape]\nkind = "sphere"\nradius = 1\n[solve]\nload = 1\n'
            "[slide]\nfriction = 0.1\nsteps = [STEP]\n",
            r"slide\.steps: must be a list of tables, at most 10000, got",
        ),
        (
            'body.layers = []\n[tip]\nkind = "sphere"\nradius = 1\n[indent]\nload = [LOAD]\n',
            r"indent\.load: must be a finite number or a list of finite numbers, at most 10000",
        ),
    ],
    ids=["layers", "steps", "loads"],
)
def test_what_would_take_hours_by_a_slip_of_the_pen_is_refused(table: str, message: str) -> None:
    head = "body.substrate = { young = 210e9, poisson = 0.3 }\n"
    material = "{ material = { young = 1e9, poisson = 0.3 }, thickness = 1e-6 }, "
    text = table.replace("LAYER", material * 1001).replace("STEP", "{ load = 1 }, " * 10_001)
    data = tomllib.loads(head + text.replace("LOAD", "1.0, " * 10_001))
    with pytest.raises(CaseError, match=message) as error:
        Case(data)
    assert len(str(error.value)) < 300


def test_a_study_has_no_more_cases_than_the_memory_bears() -> None:
    values = {"first": 1.0, "last": 2.0, "count": 400}
    data = tomllib.loads(TEXT)
    data["sweep"]["parameters"] = {"solve.load": values, "shape.radius": values}
    with pytest.raises(CaseError, match="must make at most 100000 cases, got 160000"):
        Case(data).study()


def test_without_a_study_or_a_file_there_is_an_error(tmp_path: Path, capsys: Capture) -> None:
    assert command("sweep", written(tmp_path, TEXT.partition("[sweep]")[0])) == 2
    assert "sweep: this table is missing" in capsys.readouterr().err
    assert command("solve", tmp_path / "none.toml") == 2
    assert "No such file" in capsys.readouterr().err
    assert command("solve", written(tmp_path, TEXT), "--save", "a.txt") == 2
    assert "must end in .csv" in capsys.readouterr().err


def test_in_a_process_there_is_no_traceback(tmp_path: Path) -> None:
    path = written(tmp_path, TEXT.replace("[solve]", "[solv]"))
    done = python("-m", "nacre.cli", "solve", path)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)


def base(**tables: Any) -> dict[str, Any]:
    body = {"substrate": {"young": 210e9, "poisson": 0.3}}
    return {"shape": {"kind": "sphere", "radius": 1}, "body": body, "solve": {"load": 1}} | tables


def of(kind: str, **keys: Any) -> dict[str, Any]:
    """Return the table of a shape."""
    return {"kind": kind, "radius": 1} | keys


MAP = {"kind": "height_map", "path": "a.npy", "spacing": 0.5, "detrend": "none"}
FUJIWARA = {
    **{"kind": "fujiwara_kawase", "length": 0.02, "load": 1e3, "contact_modulus": 1e11},
    **{"k1": 1.5, "k2": 0.5, "z_m": 1e-5},
}
SHAPES: list[tuple[dict[str, Any], nacre.types.Shape]] = [
    *TABLES,
    (of("sphere", shift=[1, 2]), nacre.Sphere(1).shifted(1, 2)),
    (
        of("roller", length=9, profile={"kind": "logarithmic", "amplitude": 1e-6, "length": 2}),
        nacre.Roller(1, length=9, profile=nacre.LogarithmicProfile(1e-6, 2)),
    ),
    (
        of("roller", profile={"kind": "iso16281", "diameter": 2, "length": 3}),
        nacre.Roller(1, profile=nacre.LogarithmicProfile.iso16281(2, 3)),
    ),
    (
        of("roller", profile=FUJIWARA),
        nacre.Roller(
            1, profile=nacre.LogarithmicProfile.fujiwara_kawase(0.02, 1e3, 1e11, 1.5, 0.5, 1e-5)
        ),
    ),
    (
        of("roller", profile={"kind": "sampled", "x": [0, 1, 2], "drop": [0, 0, 1e-3]}),
        nacre.Roller(1, profile=([0, 1, 2], [0, 0, 1e-3])),
    ),
    (
        {"kind": "crossed", "radius_y": 1, "counter_radius_y": 3, "angle": 1.2},
        nacre.Paraboloid(*nacre.hertz.relative_radii((None, 1), (None, 3), 1.2)[0]),
    ),
    (
        {"kind": "crossed", "radius_y": 1, "counter_radius_y": 1, "angle": math.pi / 2},
        nacre.Paraboloid(1, 1),
    ),
    (
        {"kind": "sum", "parts": [of("sphere"), MAP]},
        nacre.Sphere(1) + nacre.HeightMap([[0.0, 1.0], [2.0, 3.0]], 0.5),
    ),
    (
        {"kind": "sum", "parts": 5000 * [of("sphere", shift=[1e-9, 0.0])]},
        functools.reduce(operator.add, [nacre.Sphere(1).shifted(1e-9, 0.0)] * 5000),
    ),
]


@pytest.mark.parametrize(("table", "shape"), SHAPES, ids=range(len(SHAPES)))
def test_every_shape_can_be_described(
    table: dict[str, Any], shape: nacre.types.Shape, tmp_path: Path
) -> None:
    np.save(tmp_path / "a.npy", np.arange(4.0).reshape(2, 2))
    assert Case(base(shape=table), folder=tmp_path).arguments()["shape"] == shape


INF = math.inf


def test_an_infinite_radius_is_a_straight_line() -> None:
    hertz, paraboloid = nacre.hertz, {"kind": "paraboloid", "radius_x": 1, "radius_y": 2}
    for table in ({"kind": "cylinder", "radius": 1}, paraboloid):
        name = "counter_radius" + "_x" * (table is paraboloid)
        assert (
            Case(base(shape=table | {name: INF})).arguments() == Case(base(shape=table)).arguments()
        )
    crossed = {"kind": "crossed", "radius_y": 1, "counter_radius_y": 3, "angle": 1.2}
    same = Case(base(shape=crossed | {"radius_x": -INF})).arguments()
    assert same == Case(base(shape=crossed)).arguments()
    assert hertz.equivalent_radius(1.0, INF) == hertz.equivalent_radius(INF, 1.0) == 1.0
    assert hertz.relative_radii((INF, 1), (INF, 2), 1) == hertz.relative_radii(
        (None, 1), (None, 2), 1
    )
    assert hertz.Ellipse(1, 2, 3, 4, INF) == hertz.Ellipse(1, 2, 3, 4)
    with pytest.raises(ValueError, match="radius: must be a finite number"):
        Case(base(shape={"kind": "sphere", "radius": INF})).arguments()


def test_bodies_grids_and_motions_can_be_described() -> None:
    layer = {"material": {"young": 1e9, "poisson": 0.5}, "thickness": 1e-3}
    found = Case(
        base(
            body={
                "substrate": "rigid",
                "layers": [
                    layer | {"interface": {"normal": 1e12, "tangential": 2e11}},
                    layer | {"interface": "frictionless"},
                ],
            },
            counterbody={"substrate": {"young": 3, "poisson": 0.1}, "ends": [-1, float("inf")]},
            grid={"cells": 64, "width": 2, "center": 0.5},
            solve={"approach": 1, "tilt": [1, 2], "moment": {"y": 3}, "threads": 2},
        )
    ).arguments()
    soft = nacre.Layer(nacre.Elastic(1e9, 0.5), 1e-3, "frictionless")
    joined = nacre.Layer(soft.material, 1e-3, nacre.Spring(1e12, 2e11))
    assert found == {
        "shape": nacre.Sphere(1),
        "body": nacre.HalfSpace(nacre.RIGID, [joined, soft]),
        "counterbody": nacre.HalfSpace(nacre.Elastic(3, 0.1), ends=(-1, None)),
        "grid": nacre.Grid.line(64, 2, 0.5),
        "approach": 1,
        "tilt": (1, 2),
        "moment": (None, 3),
        "threads": 2,
    }


def test_a_byte_order_mark_is_taken(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(TEXT, encoding="utf-8-sig")
    assert Case.read(path).arguments()["load"] == 1e3


@pytest.mark.parametrize(
    "text",
    ["a = " + "{ b = " * 500 + "1" + " }" * 500, ".".join("a" * 500) + " = 1", "a = " + "[" * 9999],
    ids=["tables", "key", "lists"],
)
def test_what_is_nested_too_deeply_is_refused(text: str, tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="tables and lists are nested too deeply"):
        Case.read(written(tmp_path, text))


def test_nested_sums_are_refused_or_solved() -> None:
    def nested(depth: int) -> dict[str, Any]:
        shape: dict[str, Any] = {"kind": "sphere", "radius": 1}
        for _ in range(depth):
            shape = {"kind": "sum", "parts": [shape]}
        return shape

    assert Case(base(shape=nested(20))).arguments()["shape"] == nacre.Sphere(1)
    with pytest.raises(CaseError, match="tables and lists are nested too deeply"):
        Case(base(shape=nested(500)))


@pytest.mark.parametrize(
    ("grid", "message"),
    [
        ({"cells": 8, "width": 1, "center": [0, 0]}, "grid: center must be a number for a line"),
        ({"shape": [8, 8], "size": [1, 1], "center": 1}, "grid: center must be a pair of numbers"),
        (
            {"shape": [8, 8], "size": [1, 1], "center": "middle"},
            "grid.center: must be a finite number or a pair",
        ),
    ],
)
def test_the_centre_of_a_grid_is_of_its_kind(grid: dict[str, Any], message: str) -> None:
    with pytest.raises(CaseError, match=f"^case: {re.escape(message)}"):
        Case(base(grid=grid))


def test_a_profile_has_the_keys_of_its_kind() -> None:
    roller = {"kind": "roller", "radius": 1}
    profile = {"kind": "iso16281", "diameter": 2}
    with pytest.raises(CaseError, match=r"shape.profile.length: this key is missing"):
        Case(base(shape=roller | {"profile": profile}))
    profile |= {"length": 3, "radius": 1}
    with pytest.raises(CaseError, match=r"profile.radius: .* keys here are diameter, kind, length"):
        Case(base(shape=roller | {"profile": profile}))


def test_a_rigid_base_has_stresses_in_its_layers(tmp_path: Path, capsys: Capture) -> None:
    text = STRESSED.replace('substrate = "steel"', 'substrate = "rigid"')
    assert command("solve", written(tmp_path, text)) == 0
    assert "layers[0], 0 m to 40 µm" in capsys.readouterr().out


def test_layers_of_a_study_are_named_by_number_or_name() -> None:
    layer = {"material": {"young": 1e9, "poisson": 0.5}, "thickness": 1e-3, "name": "DLC"}
    body = {"substrate": "rigid", "layers": [layer]}
    keys = ("body.layers[0].thickness", "body.layers.0.thickness", "body.layers.DLC.thickness")
    for key in keys:
        case = Case(base(body=body, sweep={"parameters": {key: [1e-3, 2e-3]}}))
        assert case.study()["parameters"] == {key: [1e-3, 2e-3]}
        assert case(**{key: 2e-3})["body"].layers[0].thickness == 2e-3
    with pytest.raises(CaseError, match="is not a key of this case"):
        Case(base(body=body))(**{"body.layers.TiN.thickness": 1.0})
    with pytest.raises(CaseError, match="is not a key of this case"):
        Case(base(body=body | {"layers": [layer, layer]}))(**{"body.layers.DLC.thickness": 1.0})


MILLIMETRES = """
units = "N-mm-MPa"
shape = { kind = "height_map", path = "a.npy", spacing = 0.01, unit = "um", detrend = "none" }
body = { substrate = { young = 210e3, poisson = 0.3 } }
solve = { load = 10 }
stress = {}
"""


def test_units_of_a_case_are_those_of_its_map_and_of_what_is_printed(
    tmp_path: Path, capsys: Capture
) -> None:
    x = np.linspace(-1, 1, 32)
    np.save(tmp_path / "a.npy", -(x**2) - x[:, np.newaxis] ** 2)
    case = Case.read(written(tmp_path, MILLIMETRES))
    shape = case.arguments()["shape"]
    assert shape.spacing == pytest.approx((0.01, 0.01), rel=1e-15)
    assert np.ptp(shape.heights) == pytest.approx(2e-3, rel=0.01)
    assert command("solve", written(tmp_path, MILLIMETRES)) == 0
    printed = capsys.readouterr().out
    solution = nacre.solve(**case.arguments())
    assert f"peak pressure  {solution.peak_pressure:.4g} MPa" in printed
    text = MILLIMETRES.replace('units = "N-mm-MPa"', "")
    assert command("solve", written(tmp_path, text), "--units", "N-mm-MPa") == 0
    assert capsys.readouterr().out == printed
    assert command("solve", written(tmp_path, text), "--units", "N-mm-MPa", "--json") == 0
    assert json.loads(capsys.readouterr().out)["units"] == "N-mm-MPa"
    assert command("solve", written(tmp_path, text), "--units", "N-mm-Pa") == 2
    assert "units must be consistent" in capsys.readouterr().err
    assert f"{solution.peak_pressure:.6g} Pa," in repr(solution)  # SI again


def test_the_reference_has_every_table_and_key(capsys: Capture) -> None:
    assert command("schema", "--json") == 0
    tables = json.loads(capsys.readouterr().out)["$defs"]
    assert command("schema") == 0
    text = capsys.readouterr().out
    keys = {name: node for table in tables.values() for name, node in table["properties"].items()}
    for name, node in keys.items():
        assert node["description"], name
        assert "const" in node or f"- `{name}`: " in text, name
    kinds = {
        node["const"]
        for table in tables.values()
        for node in table["properties"].values()
        if "const" in node
    }
    assert kinds >= {"sphere", "random_surface", "sum", "iso16281", "maugis", "berkovich"}
    assert [kind for kind in kinds if f'kind = "{kind}"' not in text] == []
    assert "- `radius`: finite number [m]; required. Radius, above 0." in text
    assert "- `tolerance`: finite number; default `1e-08`." in text
    assert "half_angle" in text
    assert "`ends`: pair of numbers, or of -inf and inf where the body has no end [m]" in " ".join(
        text.split()
    )
    # No line that is wrapped begins another item.
    marks = [line for line in text.splitlines() if re.match(r"\s*([-+*>#]|\d+[.)]) ", line)]
    assert all(line.startswith(("- `", "## ")) for line in marks)
    assert max(map(len, text.splitlines())) <= 120
    for head in ("[slide]", "[[slide.steps]]", "[roll]", "[tip]", "[adhesion]"):
        assert f"## `{head}`" in text


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


@pytest.mark.slow
def test_the_case_of_the_page_is_one(tmp_path: Path, capsys: Capture) -> None:
    page = (Path(__file__).parents[3] / "docs" / "cases.md").read_text(encoding="utf-8")
    text = page.partition(":caption: ball.toml\n")[2].partition("```")[0]
    path = written(tmp_path, text)
    assert command("sweep", path) == 0
    printed = capsys.readouterr().out
    assert "peak_pressure [MPa]" in printed
    assert "9 cases, 0 failed" in printed
    assert command("solve", path) == 0
    assert "safety factor" in capsys.readouterr().out


@pytest.mark.parametrize("path", [r"\\server\share\a.npy", "//server/share/a.npy", r"\\?\UNC\b"])
def test_a_case_opens_no_file_of_another_computer(path: str) -> None:
    table = tomllib.loads(TEXT) | {"shape": MAP | {"path": path}}
    with pytest.raises(CaseError, match=r"shape\.path: must be a file of this computer, got"):
        Case(table)
