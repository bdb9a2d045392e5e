"""The benchmark data set, and the program that compares a table with it."""

from __future__ import annotations

import csv
import importlib
import json
import re
import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import nacre
from bodies import quiet
from nacre import fatigue
from nacre.indent import Indentation, Tip
from support import DATA

SET = DATA / "benchmark"
Rows = dict[tuple[str, str, str], float]
Write = Callable[[Rows], str]


@pytest.fixture
def compare(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(SET))
    return importlib.import_module("compare")


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def table(rows: Rows) -> str:
        with (tmp_path / "results.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([["set", "case", "quantity", "value"]])
            csv.writer(file).writerows([[*place, value] for place, value in rows.items()])
        return str(tmp_path / "results.csv")

    return table


def truth(compare: Any) -> Rows:
    return {place: row[0] for place, row in compare.known().items()}


def body(given: dict[str, Any]) -> nacre.HalfSpace:
    base, layers = given["substrate"], []
    if coat := given.get("coating"):
        elastic = nacre.Elastic(coat["young_Pa"], coat["poisson"])
        layers = [nacre.Layer(elastic, coat["thickness_m"])]
    return nacre.HalfSpace(nacre.Elastic(base["young_Pa"], base["poisson"]), layers)


def nacres() -> Rows:
    """Numbers of nacre for the coated spheres and for indentations by paraboloids."""
    rows: Rows = {}
    for case in json.loads((SET / "coated_spheres.json").read_text(encoding="utf-8"))["cases"]:
        given = case["given"]
        state: Any = Indentation(body(given), Tip.paraboloid(given["radius_m"])).at(
            load=given["load_N"]
        )
        found = {"contact_radius_m": state.radius, "approach_m": state.approach}
        rows |= {("coated_spheres", case["name"], key): value for key, value in found.items()}
    for case in json.loads((SET / "indentations.json").read_text(encoding="utf-8"))["cases"]:
        given = case["given"]
        if given["tip"] == "paraboloid" and given["interface"] == "bonded":
            test = Indentation(body(given), Tip.paraboloid(given["tip_radius_m"]))
            for key in case["asked"]:
                radius = float(key.split()[-2])
                state = test.at(radius=radius)
                name = key.split("_")[0]
                rows["indentations", case["name"], key] = getattr(state, name)
    return rows


def test_files_follow_from_the_reference_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(DATA / "make"))
    for name, text in importlib.import_module("benchmark").contents():
        assert (SET / name).read_text(encoding="utf-8") == text, name


def test_the_checksums_are_those_of_the_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(DATA / "make"))
    sums = (SET / "SHA256SUMS").read_text(encoding="utf-8")
    assert importlib.import_module("benchmark").checksums() == sums
    listed = {line.partition("  ")[2] for line in sums.splitlines()}
    assert {"README.md", "LICENSE", "CITATION.cff", "read.py", "schema/set.json"} <= listed


def test_the_sets_follow_their_schema() -> None:
    schema = json.loads((SET / "schema" / "set.json").read_text(encoding="utf-8"))
    validator = jsonschema.Draft202012Validator(schema)
    for path in SET.glob("*.json"):
        content = json.loads(path.read_text(encoding="utf-8"))
        validator.validate(content)
        content["cases"][0]["asked"]["more"] = {"value": "1", "scale": 1.0, "error": 1e-3}
        assert not validator.is_valid(content)


def test_the_reader_has_every_number(monkeypatch: pytest.MonkeyPatch, compare: Any) -> None:
    tables = runpy.run_path(str(SET / "read.py"))["read"]()
    rows = {
        (name, str(row["case"]), str(row["quantity"])): (row["value"], row["scale"], row["error"])
        for name, table in tables.items()
        for row in table
    }
    assert rows == compare.known()
    lines = (SET / "read.py").read_text(encoding="utf-8").splitlines()
    assert len(lines) <= 40
    readme = (SET / "README.md").read_text(encoding="utf-8")
    counts = re.findall(r"^\| `(\w+)\.json` \| (\d+) \| (\d+) \|", readme, flags=re.MULTILINE)
    assert {name: (int(cases), int(numbers)) for name, cases, numbers in counts} == {
        name: (len(set(table["case"])), len(table)) for name, table in tables.items()
    }
    total = sum(len(table) for table in tables.values())
    cases = sum(len(set(table["case"])) for table in tables.values())
    assert readme.split("\n\n")[1].startswith(f"{total} numbers")
    assert f"{total} numbers of {cases} contacts" in (SET / "CITATION.cff").read_text("utf-8")


def test_cases_say_what_is_needed_to_compute_them() -> None:
    for path in sorted(SET.glob("*.json")):
        content = json.loads(path.read_text(encoding="utf-8"))
        for key in ("problem", "source", "method", "error", "licence"):
            assert content[key], f"{path.name} says no {key}"
        assert all(case["given"] and case["asked"] for case in content["cases"])


def test_nacre_meets_its_benchmark(
    compare: Any, write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    # Its indentations promise 1e-9.
    assert compare.main([write(nacres()), "--tolerance", "1e-9"]) == 0
    out = capsys.readouterr().out
    assert "coated_spheres" in out
    assert "indentations" in out
    assert "rollers" not in out  # rows without a value are not compared


def pressed(given: dict[str, Any]) -> nacre.Solution:
    """Solve the contact whose pressure is elliptic: of a cylinder, or of what that pressure bends.

    Outside the contact the shape of a coated body stays a little off, so that nothing touches.
    """
    half, peak, solid = given["half_width_m"], given["peak_pressure_Pa"], body(given)
    grid = nacre.Grid.line(160, 2.5 * half)
    base = nacre.Elastic(given["substrate"]["young_Pa"], given["substrate"]["poisson"])
    shape: Any = nacre.Cylinder(base.plane_strain_modulus * half / (2 * peak))
    if solid.layers:
        ends = np.clip((grid.y[:, None] + np.array([-0.5, 0.5]) * grid.spacing[1]) / half, -1, 1)
        area = (ends * np.sqrt(1 - ends**2) + np.arcsin(ends)) / 2
        pressure = peak * half / grid.spacing[1] * np.diff(area, axis=1).T
        bent = nacre.stress(solid, grid, pressure, 0.0, displacement=True).uz.reshape(1, -1)
        apart = np.clip(np.abs(grid.y) / half - 1, 0, None) ** 1.5
        bent = bent - apart * peak * half / base.young
        shape = nacre.HeightMap(np.repeat(bent, 2, axis=0), grid.spacing)
    solution: nacre.Solution = quiet(
        nacre.solve, shape, solid, load=np.pi / 2 * half * peak, grid=grid
    )
    return solution


@pytest.mark.parametrize(
    ("name", "tolerance"),
    [
        ("bare, mu 0", "1e-3"),
        ("bare, mu 0.2", "1e-3"),
        # The edge of the contact at the surface decides: as in fatigue/test_contacts.py.
        ("bare, mu 0.5", "5e-3"),
        ("ratio 2, h/b 0.3, mu 0", "1e-3"),
        ("ratio 4, h/b 1, mu 0", "1e-3"),
        pytest.param("ratio 0.5, h/b 0.3, mu 0.3", "1e-3", marks=pytest.mark.slow),
        pytest.param("ratio 2, h/b 1, mu 0.3", "1e-3", marks=pytest.mark.slow),
    ],
)
def test_nacre_meets_the_shakedown_of_its_benchmark(
    compare: Any, write: Write, name: str, tolerance: str
) -> None:
    cases = json.loads((SET / "shakedown.json").read_text(encoding="utf-8"))["cases"]
    given = next(case["given"] for case in cases if case["name"] == name)
    solution, rows = pressed(given), {}
    assert solution.peak_pressure == pytest.approx(given["peak_pressure_Pa"], rel=1e-4)
    rules: tuple[tuple[Any, str], ...] = (
        ("von_mises", "von Mises"),
        ("in_plane_tresca", "Tresca in the plane"),
    )
    for rule, text in rules:
        layers = quiet(fatigue.assess, solution, friction=given["friction"], rule=rule).layers
        parts = ("coating", "substrate")[-len(layers) :]
        for part, layer in zip(parts, layers, strict=True):
            limit = given["peak_pressure_Pa"] / layer.shakedown[0]
            rows["shakedown", name, f"p0/k shakedown, {text}, {part}"] = limit
            if rule == "von_mises":
                first = given["peak_pressure_Pa"] / layer.first_yield[0]
                rows["shakedown", name, f"p0/k first yield, {text}, {part}"] = first
    assert compare.main([write(rows), "--tolerance", tolerance]) == 0


def test_bare_bodies_shake_down_below_the_bound_of_friction(compare: Any) -> None:
    # Tresca's rule at the surface allows 1/mu, and 4 below it without friction (Johnson).
    found = truth(compare)
    for mu, limit in (("0", 4.0), ("0.4", 2.5), ("0.5", 2.0)):
        place = ("shakedown", f"bare, mu {mu}", "p0/k shakedown, Tresca in the plane, substrate")
        assert found[place] == pytest.approx(limit, rel=3e-6)


def test_a_wrong_number_is_named(
    compare: Any, write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = truth(compare)
    place = ("rollers", "C, nu 0.3", "pressure_Pa on the axis, 1.000e-04 m from the end")
    rows[place] *= 1.05
    assert compare.main([write(rows), "--tolerance", "1e-3"]) == 1
    line = next(one for one in capsys.readouterr().out.splitlines() if one.startswith("rollers"))
    assert place[1] in line
    assert place[2] in line
    off = 0.05 * truth(compare)[place] / 1e9  # of the mean line contact's pressure
    assert f"{off:.1e}" in line
    # Below what the reference itself is good for, nothing fails; nor without a tolerance.
    assert compare.main([write(rows), "--tolerance", "0.1"]) == 0
    assert compare.main([write(rows)]) == 0
    assert compare.main([write(rows), "coated_spheres", "--tolerance", "0"]) == 0


def test_every_row_can_be_printed(
    compare: Any, write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = truth(compare)
    assert compare.main([write(rows), "--all"]) == 0
    out = capsys.readouterr().out.splitlines()
    assert len(out) == 1 + len({place[0] for place in rows}) + len(rows)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("set,case,quantity\n", "has no column value"),
        ("set,case,quantity,value\na,b,c,1\n", "no such row in the benchmark: a, b, c"),
        ("set,case,quantity,value\na,b,c,x\n", "line 2: 'x' is no number"),
        ("set,case,quantity,value\na,b,c,1\na,b,c,1\n", "is there twice"),
        ("set,case,quantity,value\na,b,c,\n", "nothing to compare"),
        ("", "has no column"),
    ],
)
def test_tables_that_cannot_be_compared_are_refused(
    compare: Any, tmp_path: Path, text: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "results.csv"
    path.write_text(text, encoding="utf-8")
    assert compare.main([str(path)]) == 2
    assert message in capsys.readouterr().err


def test_a_number_that_is_none_is_infinitely_wrong(compare: Any, write: Write) -> None:
    rows = truth(compare)
    place = next(iter(rows))
    assert compare.differences(compare.read(write({place: float("nan")})))[0][0] == float("inf")


def test_the_template_has_every_row(compare: Any) -> None:
    with (SET / "template.csv").open(encoding="utf-8", newline="") as file:
        places = [tuple(row)[:3] for row in csv.reader(file)][1:]
    assert sorted(places) == sorted(compare.known())
