"""The benchmark data set, and the program that compares a table with it."""

from __future__ import annotations

import csv
import importlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import nacre
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
    coat, base = given["coating"], given["substrate"]
    layer = nacre.Layer(nacre.Elastic(coat["young_Pa"], coat["poisson"]), coat["thickness_m"])
    layers = [layer]
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
