"""The generators in tests/data/make find the numbers that tests/data holds.

Whole files where that takes a second or two, some cases of the others; `make references` takes all.
"""

import copy
import importlib
import json
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

DATA = Path(__file__).parents[2] / "data"
MAKE = DATA / "make"

# Generator, and what is recomputed: entries of lists in the file.
QUICK: list[tuple[str, dict[str, list[int]]]] = [
    ("axisym_tips", {"cases": [2, 9]}),
    ("sphere_coated", {"cases": [0, 7, 24]}),
    ("sphere_rigid_base", {"cases": [0, 9]}),
    ("sphere_derivatives", {"cases": [0]}),
    ("jkr", {"table": [4], "curves": [1]}),
    ("maugis", {"bare": [0, 6], "coated": []}),
    ("line_coated", {"cases": [0, 12, 24]}),
    ("line_contact", {"cattaneo": [11], "carter_full": [3], "carter_partial": []}),
    ("stick_stiffness", {"cases": [0, 11]}),
    ("response_stacks", {"cases": [0, 1, 5]}),
    ("response_derivatives", {"stacks": [0]}),
    ("springs", {"cases": [0, 9]}),
    ("stress_disc", {"cases": [2]}),
    ("stress_patch", {"cases": [0, 10, 27]}),
    ("shakedown", {"cases": [0, 8, 14]}),
    ("quarter_space_wave", {"cases": [0, 8, 14]}),
    ("coated_roller", {"cases": [1]}),
    ("fretting_limit", {"rows": [0, 3, 7]}),
    ("wave_decay", {"rows": [2, 13, 23]}),
]


@pytest.fixture(autouse=True)
def modules(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(MAKE))


def worst(name: str, chosen: dict[str, list[int]], off: float = 0.0) -> float:
    """Largest difference in units of the file's stated error; `off` spoils the stored numbers."""
    common, generator = importlib.import_module("common"), importlib.import_module(name)
    old = common.read(generator.NAME)
    for key, entries in chosen.items():
        old[key] = [old[key][k] for k in entries]
    new = copy.deepcopy(old)
    generator.fill(new)
    return max(
        (d[0] for d in common.differences(new, spoilt(old, off), old["tolerance"])), default=0.0
    )


def spoilt(value: Any, off: float) -> Any:
    if isinstance(value, dict):
        return {k: v if k == "tolerance" else spoilt(v, off) for k, v in value.items()}
    if isinstance(value, list):
        return [spoilt(v, off) for v in value]
    return value * (1 + off) if isinstance(value, float) else value


@pytest.mark.parametrize(
    ("name", "chosen"),
    [
        pytest.param(*row, marks=[pytest.mark.slow] if row[0] == "shakedown" else [])
        for row in QUICK
    ],
    ids=[name for name, _ in QUICK],
)
def test_generators_find_the_stored_numbers(name: str, chosen: dict[str, list[int]]) -> None:
    assert worst(name, chosen) <= 1


def test_a_number_that_is_off_by_a_millionth_is_found() -> None:
    assert worst("sphere_rigid_base", {"cases": [0]}, 1e-6) > 1


def test_files_say_where_their_numbers_come_from() -> None:
    for path in sorted(
        [
            *DATA.glob("*.json"),
            *(DATA / "friction").glob("*.json"),
            *(DATA / "wear").glob("*.json"),
            DATA / "fatigue/shakedown.json",
        ]
    ):
        content = json.loads(path.read_text(encoding="utf-8"))
        for key in ("description", "source", "method", "error"):
            assert content.get(key), f"{path.name} says no {key}"


def test_no_generator_imports_nacre() -> None:
    finer_cells = {"coat_ellipses.py"}  # no other program has ellipses on coats
    for path in sorted(path for path in MAKE.glob("*.py") if path.name not in finer_cells):
        for line in path.read_text(encoding="utf-8").splitlines():
            assert not line.lstrip().startswith(("import nacre", "from nacre")), path.name


def test_files_are_written_as_they_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    common = importlib.import_module("common")
    content = common.read("maugis.json")
    monkeypatch.setattr(common, "DATA", tmp_path)
    common.write("maugis.json", content)
    assert common.read("maugis.json") == content


def test_comparison_reports_what_differs() -> None:
    common = importlib.import_module("common")
    old = {
        "tolerance": {"": [0.0, 0.1], "b": [0.0, 1.0]},
        "a": 1.0,
        "b": {"c": [1.0, 2.0]},
        "d": "x",
    }
    new = copy.deepcopy(old) | {"a": 1.2, "b": {"c": [1.5, 2.0]}}
    found = [(round(d[0], 12), d[1]) for d in common.differences(new, old, old["tolerance"])]
    assert found == [(2.0, ("a",)), (0.5, ("b", "c", "0"))]
    assert next(common.differences({"a": float("nan")}, {"a": 1.0}, {"": [0, 1]}))[0] == float(
        "inf"
    )
    assert next(common.differences({"a": 1.0}, {"b": 1.0}, {"": [0, 1]}))[0] == float("inf")


def test_command_line_fails_where_a_number_is_off(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    common = importlib.import_module("common")
    monkeypatch.setattr(common, "DATA", tmp_path)
    common.write("one.json", {"tolerance": {"": [1e-6, 0.0]}, "x": 2.0})

    def fill(content: dict[str, float]) -> None:
        content["x"] = 2.1

    generator = SimpleNamespace(NAME="one.json", fill=fill, __doc__="One.")
    monkeypatch.setattr(sys, "argv", ["one.py"])
    with pytest.raises(SystemExit):
        common.main(generator)
    assert "x: 2.1, stored 2.0" in capsys.readouterr().out
    assert common.read("one.json")["x"] == 2.0
    monkeypatch.setattr(sys, "argv", ["one.py", "--write"])
    common.main(generator)
    assert common.read("one.json")["x"] == 2.1
