"""The command ``nacre indent``."""

import json
from pathlib import Path

import pytest

import nacre
from nacre.case import Case, CaseError
from support import ROOT, Capture, command, written

EXAMPLE = ROOT / "examples" / "indent.toml"


TEXT = EXAMPLE.read_text(encoding="utf-8")


def test_the_example_is_printed_and_written(tmp_path: Path, capsys: Capture) -> None:
    rows = tmp_path / "a.csv"
    assert command("indent", EXAMPLE, "--save", rows) == 0
    assert "pull-off" in capsys.readouterr().out
    version, verdict, head, *lines = rows.read_text().splitlines()
    assert version == f"# source: nacre {nacre.__version__}"
    assert verdict.startswith("# verdict: The substrate shows")
    assert head.startswith("load [N],approach [m]")
    assert command("indent", EXAMPLE, "--json") == 0
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
    text = TEXT.replace('kind = "sphere"\nradius = 5e-6', tip)
    text = text.replace('"jkr"', f'"{adhesion}"')
    text = text.replace("[indent]\n", '[indent]\ncontrol = "approach"\n')
    assert command("indent", written(tmp_path, text)) == 0


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"sphere"', '"nope"', "tip"),
        (
            '"sphere"',
            '"cone"',
            "tip.radius: there is no such key; the keys here are kind, slope, half_angle",
        ),
        ('"sphere"', '"gap"', "tip.kind: must be one of"),
        ('"jkr"', '"maugis"', "adhesion.strength: this key is missing"),
        ("work = 0.05", "work = -1.0", "adhesion"),
        ("work = 0.05", "wrk = 0.05", "adhesion"),
        ("load = ", "radius = 1e-6\nload = ", "exactly one"),
        ('"glass"\n', '"gold"\n', "body.substrate"),
        ("[tip]", "[tip", "TOML"),
        (
            "radius = 5e-6",
            "radus = 5e-6",
            "tip.radus: there is no such key; the keys here are radius",
        ),
        ('"jkr"', '"jrk"', "adhesion.kind: must be one of 'jkr'"),
        ("load = ", "laod = ", "indent.laod: there is no such key; the keys here are load"),
        (
            '"sphere"\nradius',
            '"cone"\nhalf_angle = 1.0\nslope',
            "exactly one of slope and half_angle",
        ),
        ("load = [1e-4, 1e-3]", "load = true", "indent.load: must be a finite number or a list"),
        ("load = [1e-4, 1e-3]", "load = -1.0", "indent: "),
    ],
)
def test_bad_input_is_one_line(
    old: str, new: str, told: str, tmp_path: Path, capsys: Capture
) -> None:
    path = written(tmp_path, TEXT.replace(old, new))
    assert command("indent", path) == 2
    said = capsys.readouterr().err
    assert told in said
    assert said.count("\n") == 1


SWEEP = """
[sweep]
store = "film.nc"
outputs = ["approach", "pull_off_load"]
parameters."body.layers[0].thickness" = [0.5e-6, 1e-6]
parameters."tip.radius" = [5e-6, 6e-6]
"""


def test_a_study_of_an_indentation_is_run_and_kept(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "film.toml"
    example = TEXT.partition("[sweep]")[0]
    text = example.replace("[1e-4, 1e-3]", "1e-3")
    path.write_text(text + SWEEP, encoding="utf-8")
    assert command("sweep", path) == 0
    assert "4 cases, 0 failed" in capsys.readouterr().out
    assert (tmp_path / "film.nc").is_file()
    case = Case.read(path)
    alone = nacre.indent.solve(**case(**{"tip.radius": 6e-6}))
    study = nacre.sweep(case, **case.study())
    assert study.approach[1, 1] == alone.approach
    path.write_text(text + SWEEP.replace("tip.radius", "tip.radus"), encoding="utf-8")
    assert command("sweep", path) == 2
    assert "the nearest are tip.radius" in capsys.readouterr().err
    path.write_text(text + SWEEP.replace("pull_off_load", "peak_pressure"), encoding="utf-8")
    assert command("sweep", path) == 2
    assert "nacre.indent.IndentSolution" in capsys.readouterr().err


def test_indent_names_solve_for_a_contact_and_solve_takes_both(capsys: Capture) -> None:
    assert command("indent", EXAMPLE, "--json") == 0
    numbers = capsys.readouterr().out
    assert command("solve", EXAMPLE, "--json") == 0
    assert capsys.readouterr().out == numbers
    assert command("indent", EXAMPLE.with_name("roller.toml")) == 2
    assert "nacre solve" in capsys.readouterr().err


def test_a_saved_case_is_loaded(tmp_path: Path, capsys: Capture) -> None:
    assert (
        command("indent", EXAMPLE, "--save", tmp_path / "a.nc", "--save", tmp_path / "a.csv") == 0
    )
    found = nacre.indent.solve(**Case.read(EXAMPLE).arguments())
    assert nacre.load(tmp_path / "a.nc") == found
    assert command("indent", EXAMPLE, "--save", tmp_path / "a.png") == 2
    assert "--save must end in" in capsys.readouterr().err


def test_a_case_from_python_has_the_arguments_of_solve() -> None:
    case = Case.read(EXAMPLE)
    assert case.is_indentation
    assert case.arguments()["tip"] == nacre.indent.Tip.sphere(5e-6)
    with pytest.raises(CaseError, match="sweep: this table is missing"):
        Case({k: v for k, v in case.data.items() if k != "sweep"}).study()
