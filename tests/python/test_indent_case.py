"""The command ``nacre indent``."""

import json
from pathlib import Path

import pytest

import nacre
from nacre.cli import main

EXAMPLE = Path(__file__).parents[2] / "examples" / "indent.toml"


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["indent", *arguments])
    return int(ended.value.code or 0)


def test_the_example_is_printed_and_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = tmp_path / "a.csv"
    assert run(str(EXAMPLE), "--save", str(rows)) == 0
    assert "pull-off" in capsys.readouterr().out
    version, head, *lines = rows.read_text().splitlines()
    assert version == f"# source: nacre {nacre.__version__}"
    assert head.startswith("load [N],approach [m]")
    assert run(str(EXAMPLE), "--json") == 0
    found = json.loads(capsys.readouterr().out)
    glass, film = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
    test = nacre.indent.Indentation(
        nacre.HalfSpace(glass, [nacre.Layer(film, 1e-6)]),
        nacre.indent.Tip.sphere(5e-6),
        adhesion=nacre.indent.Adhesion.jkr(0.05),
    )
    assert found["approach"] == test.at(load=[1e-4, 1e-3]).approach.tolist()
    assert found["pull_off"]["load"] == test.pull_off().load
    assert [float(line.split(",")[1]) for line in lines] == found["approach"]


@pytest.mark.parametrize(
    ("tip", "adhesion"),
    [
        ('kind = "cone"\nhalf_angle = 1.2', "jkr"),
        ('kind = "berkovich"', "jkr"),
        ('kind = "rounded_cone"\nslope = 0.3\nradius = 1e-6', "dmt"),
        (
            'kind = "profile"\nradii = [0.0, 1e-6, 2e-6, 4e-6]\nheights = [0.0, 1e-7, 4e-7, 16e-7]',
            "jkr",
        ),
        ('kind = "area_function"\ncoefficients = [24.5, 1e-7]\ndepth = 2e-6', "jkr"),
    ],
)
def test_tips_of_all_kinds(tip: str, adhesion: str, tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    text = EXAMPLE.read_text(encoding="utf-8").replace('kind = "sphere"\nradius = 5e-6', tip)
    text = text.replace('"jkr"', f'"{adhesion}"') + 'control = "approach"\n'
    path.write_text(text, encoding="utf-8")
    assert run(str(path)) == 0


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"sphere"', '"nope"', "tip"),
        ('"sphere"', '"cone"', "a tip of kind cone has slope, got radius"),
        ('"sphere"', '"gap"', "kind must be one of sphere"),
        ('"jkr"', '"maugis"', "strength must be given"),
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
