"""The command ``nacre indent``."""

import json
from pathlib import Path

import pytest

from nacre.cli import main

EXAMPLE = Path(__file__).parents[2] / "examples" / "indent.toml"


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["indent", *arguments])
    return int(ended.value.code or 0)


def test_the_example_is_printed_and_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    numbers, rows = tmp_path / "a.json", tmp_path / "a.csv"
    assert run(str(EXAMPLE), "--json", str(numbers), "--csv", str(rows)) == 0
    assert "pull-off" in capsys.readouterr().out
    found = json.loads(numbers.read_text())
    assert found["load"] == pytest.approx([1e-4, 1e-3])
    assert found["pull_off"]["load"] < 0
    assert len(rows.read_text().splitlines()) == 3


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"sphere"', '"nope"', "tip"),
        ("work = 0.05", "work = -1.0", "adhesion"),
        ("work = 0.05", "wrk = 0.05", "adhesion"),
        ("load = ", "radius = 1e-6\nload = ", "exactly one"),
        ('"glass"\n', '"gold"\n', "body.substrate"),
        ("[tip]", "[tip", "TOML"),
    ],
)
def test_bad_input_is_one_line(
    old: str, new: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(EXAMPLE.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    assert run(str(path)) == 2
    said = capsys.readouterr().err
    assert told in said
    assert said.count("\n") == 1
