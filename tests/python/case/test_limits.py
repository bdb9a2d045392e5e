"""Limits of case files decide verdicts, prints, JSON and reports, and say where they are from."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest

import nacre
from nacre.case import Case, CaseError, templates, toml
from nacre.case.results import results_of
from support import Capture, command, written

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")

FIELDS = {"level", "question", "decided_by", "doubts", "inside_model", "factor", "words", "lines"}
"""Fields of the verdict in JSON."""


def contact(steel: Any = None, **layer: Any) -> dict[str, Any]:
    """Return the template of a coated ball on few cells, with other keys of its layer."""
    data = tomllib.loads(templates.texts()["contact"])
    data["solve"]["max_cells"] = 4096
    data["body"]["layers"][0] |= layer
    if steel is not None:
        data["materials"]["steel"] = steel
    return data


def wear(**keys: Any) -> dict[str, Any]:
    """Return the template of wear on few cells, with other keys of wear."""
    data = tomllib.loads(templates.texts()["wear"])
    data["grid"]["cells"] = 65
    data["wear"].pop("required_distance")
    data["wear"] |= keys
    return data


def verdict(data: dict[str, Any], name: str) -> nacre.types.Verdict:
    """Return the verdict on a result of a case."""
    case = Case(data)
    with nacre.display_units(case.units):
        judged: nacre.types.Verdict = results_of(case, case.arguments())[name].verdict()
    return judged


@pytest.mark.parametrize(
    ("steel", "origin"),
    [("440C", "card 440C"), ({"young": 209.6e3, "poisson": 0.28, "yield_stress": 1896}, "given")],
)
def test_a_limit_says_where_it_is_from(steel: Any, origin: str) -> None:
    judged = verdict(contact(steel), "stress")
    assert judged.factor is not None
    assert f"limit 1896 MPa ({origin})." in judged.words


def test_a_limit_of_a_card_is_in_the_units_of_the_case() -> None:
    numbers = Case(contact("440C")).stress()
    assert numbers is not None
    card = numbers["yield_stress"][1]
    assert (card.name, card.numbers["yield_stress"].value) == ("440C", 1896.0)


def test_a_steel_without_a_source_says_so() -> None:
    judged = verdict(contact("100Cr6"), "stress")
    assert judged.level == "unknown"
    assert "No yield stress of 100Cr6 with its source was found." in judged.lines


@pytest.mark.parametrize("key", ["substrate", "sequence"])
def test_cards_are_limits_in_python(key: str) -> None:
    card = nacre.materials["440C"]
    body = nacre.HalfSpace(card.elastic, [nacre.Layer(card.elastic, 2e-6)])
    solution = nacre.solve(nacre.Sphere(5e-3), body, load=5.0, max_cells=4096)
    limits: Any = {"substrate": card} if key == "substrate" else [None, card]
    plan = solution.stress_plan().summary(yield_stress=limits, bond_strength=(1e9, None))
    summary = solution.stress_summary(yield_stress=limits, bond_strength=(1e9, None))
    assert plan == summary
    assert summary.bond_strength == ((1e9, None),)
    typed = solution.stress_summary(yield_stress={"substrate": 1.896e9})
    assert summary.origins == plan.origins == (None, "440C")
    assert summary.verdict().words == typed.verdict().words.replace("given", "card 440C")
    assert type(summary).from_dict(summary.to_dict()) == summary


@pytest.mark.parametrize(
    ("bond", "factors"),
    [
        ({"shear": 20, "tension": 400}, ["shear", "tension"]),
        ({"shear": 20}, ["shear"]),
        ({"tension": 400}, ["tension"]),
        ({}, []),
    ],
)
def test_a_bond_strength_is_a_limit(bond: dict[str, float], factors: list[str]) -> None:
    judged = verdict(contact(bond_strength=bond), "stress")
    for name in ("shear", "tension"):
        said = [one for one in judged.sentences if f"{name} below the coating" in one]
        assert any("factor" in one and "(given)" in one for one in said) == (name in factors)
    assert (judged.level == "bad") == ("shear" in factors)  # which is above 20 MPa by far


def test_a_bond_strength_must_be_of_numbers() -> None:
    with pytest.raises(CaseError, match=r"body\.layers\[0\]\.bond_strength\.sheer: there is no"):
        Case(contact(bond_strength={"sheer": 60}))
    with pytest.raises(CaseError, match="bond_strength must be above 0"):
        verdict(contact(bond_strength={"shear": -60}), "stress")


@pytest.mark.parametrize(("required", "level"), [(1e5, "good"), (5e5, "fair"), (1e6, "bad")])
def test_a_required_distance_is_judged_everywhere(
    required: float, level: str, tmp_path: Path, capsys: Capture
) -> None:
    text = toml.text(wear(required_distance=required))
    path, report = written(tmp_path, text), tmp_path / "report.html"
    assert command("solve", path, "--json", "--save", report) == 0
    in_json = json.loads(capsys.readouterr().out)["verdict"]["wear"]
    assert in_json.keys() >= FIELDS
    assert in_json["level"] == level
    assert "required" in in_json["words"]
    assert in_json["question"] is not None
    assert command("solve", path) == 0
    assert capsys.readouterr().out.splitlines()[0] == in_json["words"]
    assert in_json["words"] in report.read_text(encoding="utf-8")


def test_without_a_required_distance_the_number_comes_first() -> None:
    judged = verdict(wear(), "wear")
    assert judged.level == "unknown"
    assert judged.words.startswith("Worn through after 58")
    assert judged.question is None


@pytest.mark.parametrize("key", ["wear.required_distance", "body.layers[0].bond_strength.shear"])
def test_limits_change_nothing_in_a_study(key: str) -> None:
    data = wear(required_distance=1e5)
    data["body"]["layers"][0]["bond_strength"] = {"shear": 1}
    data["sweep"] = {"parameters": {key: [1.0, 2.0]}}
    with pytest.raises(CaseError, match="changes nothing in a solve"):
        Case(data).study()


def test_json_has_all_fields_of_verdicts(tmp_path: Path, capsys: Capture) -> None:
    data = contact(bond_strength={"shear": 200, "tension": 100})
    assert command("solve", written(tmp_path, toml.text(data)), "--json") == 0
    judged = json.loads(capsys.readouterr().out)["verdict"]["stress"]
    assert judged.keys() >= FIELDS
    assert judged["question"] == "Do the largest stresses keep the limits?"
