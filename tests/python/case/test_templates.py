"""`nacre new` lists templates and writes one; each is solved as it is."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre.case import Case, templates
from support import Capture, command

STEEL = nacre.Elastic(young=210e9, poisson=0.3)


def solved(kind: str, folder: Path, capsys: Capture) -> dict[str, Any]:
    """Return the numbers of a template, solved by the command, in the units of its file."""
    path = folder / f"{kind}.toml"
    assert command("new", kind, path) == 0
    how = ("sweep", path, "--json") if kind == "sweep" else ("solve", path, "--json")
    assert command(*how) == 0
    numbers: dict[str, Any] = json.loads(capsys.readouterr().out)
    return numbers


def test_the_list_has_a_line_for_each(capsys: Capture) -> None:
    assert command("new") == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(templates.KINDS)
    assert all(len(line.split(maxsplit=1)[1]) > 20 for line in lines)


def test_every_file_of_the_folder_is_listed() -> None:
    files = {path.stem for path in Path(templates.__file__).parent.glob("*.toml")}
    assert files == set(templates.KINDS)


@pytest.mark.parametrize("kind", templates.KINDS)
def test_a_printed_template_is_the_written_one(kind: str, tmp_path: Path, capsys: Capture) -> None:
    assert command("new", kind) == 0
    printed = capsys.readouterr().out
    assert command("new", kind, tmp_path / "case.toml") == 0
    assert (tmp_path / "case.toml").read_text(encoding="utf-8") == printed
    assert f"nacre {'sweep' if kind == 'sweep' else 'solve'} FILE" in printed.splitlines()[0]


def test_a_file_is_never_overwritten(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "case.toml"
    path.write_text("mine")
    assert command("new", "line", path) == 2
    assert "exists already" in capsys.readouterr().err
    assert path.read_text() == "mine"


def test_unknown_kinds_are_refused_with_the_list(capsys: Capture) -> None:
    assert command("new", "ball") == 2
    assert "KIND must be one of bearing, ball-bearing, pair, contact" in capsys.readouterr().err


def test_the_contact_is_hertz_s_but_for_the_coat(tmp_path: Path, capsys: Capture) -> None:
    # A coat of 1/43 of the contact radius changes the peak by less than 1 % (Hertz: 1272 MPa).
    numbers = solved("contact", tmp_path, capsys)
    modulus = STEEL.plane_strain_modulus / 2
    peak = (6 * 20.0 * modulus**2 / (math.pi**3 * 5e-3**2)) ** (1 / 3)
    assert numbers["peak_pressure"] == pytest.approx(peak / 1e6, rel=0.01)
    factor = numbers["stress"]["layers"][1]["yield_safety_factor"]
    assert factor == pytest.approx(2.77, rel=0.01)


@pytest.mark.parametrize(
    ("kind", "load", "radius"), [("line", 100e3, 10e-3), ("fatigue", 400e3, 10e-3)]
)
def test_lines_are_hertz_s_but_for_the_coat(
    kind: str, load: float, radius: float, tmp_path: Path, capsys: Capture
) -> None:
    modulus = STEEL.plane_strain_modulus / 2
    peak = math.sqrt(load * modulus / (math.pi * radius))
    assert solved(kind, tmp_path, capsys)["peak_pressure"] == pytest.approx(peak / 1e6, rel=0.01)


def test_the_roller_carries_its_load_where_it_acts(tmp_path: Path, capsys: Capture) -> None:
    numbers = solved("roller", tmp_path, capsys)
    assert numbers["load"] == pytest.approx(500.0, rel=1e-8)
    assert numbers["eccentricity"][0] == pytest.approx(0.3, rel=1e-6)


def test_the_bearing_lives_as_the_standard_says(tmp_path: Path, capsys: Capture) -> None:
    numbers = solved("bearing", tmp_path, capsys)
    life = numbers["life"]
    millions = (life["capacity"] / life["equivalent_load"]) ** (10 / 3)
    assert millions == pytest.approx(1280, rel=0.01)
    bearing = Case.read(tmp_path / "bearing.toml").arguments()["bearing"]
    assert bearing.clearance == pytest.approx(45e-6, rel=1e-9)
    assert bearing.count == 16


def test_the_ball_bearing_has_the_rating_of_its_catalogue(tmp_path: Path, capsys: Capture) -> None:
    numbers = solved("ball-bearing", tmp_path, capsys)
    # Catalogues have 14.0 kN for a 6205.
    assert numbers["life"]["capacity"] == pytest.approx(14.0e3, rel=0.01)
    assert numbers["force"] == pytest.approx([3000.0, 0.0, 1000.0], abs=1e-5)


def test_the_sphere_and_the_cone_are_between_film_and_substrate(
    tmp_path: Path, capsys: Capture
) -> None:
    sphere = solved("indentation", tmp_path, capsys)
    film, glass = (nacre.Elastic(*pair).plane_strain_modulus for pair in ((3e9, 0.4), (70e9, 0.22)))
    # Pull-off of JKR: 3/2 π w R, from 1 on soft bodies.
    assert sphere["pull_off"]["load"] == pytest.approx(-1.5 * math.pi * 0.05 * 5, rel=0.01)
    stiffness, radius = sphere["stiffness"][-1], sphere["radius"][-1]
    assert film < stiffness / (2 * radius) * 1e6 < glass
    cone = solved("cone", tmp_path, capsys)
    assert cone["stiffness"][-1] / (2 * cone["radius"][-1]) * 1e6 > 100e9


def test_the_rough_surface_touches_at_a_share_of_its_area(tmp_path: Path, capsys: Capture) -> None:
    # Persson's and Hyun's law: κ p/(E* h′) of the area, κ about 2 (doi:10.1103/PhysRevE.70.026117).
    numbers = solved("rough", tmp_path, capsys)
    share = numbers["contact_area"] / 0.01
    assert 1.5 < share * STEEL.plane_strain_modulus / 1e6 * 0.01 / 100 < 2.6


def test_slides_and_rolls_carry_forces_within_friction(tmp_path: Path, capsys: Capture) -> None:
    slide = solved("slide", tmp_path, capsys)
    assert [step["force"][0] for step in slide["steps"]] == pytest.approx([3, -3, 3], rel=1e-6)
    roll = solved("roll", tmp_path, capsys)
    assert 0.3 < roll["force"][0] / (0.3 * 80e3) < 0.6
    # Power of the creepage, force times creepage.
    assert roll["dissipated"] == pytest.approx(1e-3 * roll["force"][0], rel=1e-6)


def test_the_coat_is_through_where_the_law_says(tmp_path: Path, capsys: Capture) -> None:
    numbers = solved("wear", tmp_path, capsys)
    assert numbers["life"] == numbers["distance"][-1]
    # Archard's law under a constant load: κ W s, to rounding of the sum over 129 cells.
    assert numbers["volume"][-1][0] == pytest.approx(1e-11 * 100 * numbers["life"], rel=1e-12)
    # A rigid cylinder is as deep where a³ = 3/2 R κ W s and a² = 2 R h; an elastic one is wider.
    radius, thickness = 10, 2e-3
    rigid = 2 / 3 * (2 * radius * thickness) ** 1.5 / (radius * 1e-11 * 100)
    assert rigid < numbers["life"] < 2 * rigid


def test_the_rough_surface_is_a_contact_below_its_hardness(tmp_path: Path, capsys: Capture) -> None:
    numbers = solved("rough", tmp_path, capsys)
    assert numbers["peak_pressure"] < numbers["hardness"]


@pytest.mark.parametrize("kind", [kind for kind in templates.KINDS if kind != "sweep"])
def test_every_template_has_a_verdict_that_judges(
    kind: str, tmp_path: Path, capsys: Capture
) -> None:
    verdicts = solved(kind, tmp_path, capsys)["verdict"].values()
    assert verdicts
    assert {verdict["level"] for verdict in verdicts} <= {"good", "fair", "bad"}


@pytest.mark.parametrize("kind", ["indentation", "cone"])
def test_pictures_of_indentation_are_curves(kind: str, tmp_path: Path, capsys: Capture) -> None:
    """A step turns the tangent by 15 degrees at most, in a picture as wide as high."""
    numbers = solved(kind, tmp_path, capsys)
    depth, load = (np.array(numbers[name]) / numbers[name][-1] for name in ("approach", "load"))
    turns = np.diff(np.degrees(np.arctan2(np.diff(load), np.diff(depth))))
    assert abs(turns).max() < 15


def test_the_sweep_has_all_its_cases(tmp_path: Path, capsys: Capture) -> None:
    numbers = solved("sweep", tmp_path, capsys)
    assert sum(map(len, numbers["data_vars"]["error"]["data"])) == 9
    levels = {level for row in numbers["data_vars"]["verdict"]["data"] for level in row}
    assert levels == {"good", "fair"}
