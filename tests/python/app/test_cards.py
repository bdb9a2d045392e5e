"""Every field of the page acts, and every entry of its menus is accepted by its card."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path
from typing import Any

import pytest

import nacre
from nacre.app.answer import Answer, answer
from nacre.app.cards import Card, cards, own_card
from nacre.app.fields import Field, FieldError
from nacre.app.page import files
from nacre.case import Case, templates

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")

FACTORS = (1.13, 0.7, 3.0, 0.05)
"""Factors of a number that is changed, the first that is accepted and acts."""
LIMITS = (500.0, 50.0, 5000.0, 0.05)
"""Numbers of an empty field."""
LEVELS = ("bad", "unknown", "fair", "good")
LAST = {"contact": "stress", "wear": "full", "bearing": "full", "indent": "full"}
"""Stage with all parts of an answer, by kind of case."""
COATINGS = ("coating", "film", "dlc", "gold", "nickel")
"""Materials of layers."""
CARDS = list(cards())


def parts_of(card: Card, values: dict[str, str], stage: str = "") -> Answer:
    """Return the parts of a stage, or of the last, on few cells, or an error in a sentence."""
    case = card.case(values)
    data: dict[str, Any] = case.data
    if case.kind == "contact" and "grid" not in data and "solve.max_cells" not in values:
        data["solve"]["max_cells"] = 4096
    if case.kind == "bearing":
        data["bearing"]["solve"].setdefault("cells", [40, 8])
    reply = answer(Case(data, case.name), stage or LAST[case.kind], measured=card.measured)
    parts: Answer = reply.get("parts", reply)
    verdict = parts.get("verdict", {})
    for key in verdict.keys() & {"factor", "uncertainty"}:
        # What changes by rounding alone does not act.
        verdict[key] = verdict[key] and float(f"{verdict[key]:.9g}")
    return parts


def material_of(case: Case, name: str) -> object:
    """Return the entry of a material of a case."""
    materials: Any = case.data["materials"]
    return materials[name]


def others(field: Field) -> list[str]:
    """Return other values of a field, as they are typed."""
    if isinstance(field.default, str):
        return [word for word in field.choices if word != field.default]
    numbers = LIMITS if not field.default else [field.default * factor for factor in FACTORS]
    if field.is_count:
        numbers = [round(number) for number in numbers if round(number) != field.default]
    return [f"{number:.12g}" for number in numbers if field.low <= number <= field.high]


def acts(card: Card, field: Field, before: list[Answer], may_be_refused: bool) -> bool:
    """Return whether another value changes the draft or, which takes longer, the last answer."""
    for typed in others(field):
        for stage, parts in zip(("draft", ""), before, strict=True):
            try:
                after = parts_of(card, {field.path: typed}, stage)
            except FieldError:
                continue
            except ValueError as error:
                after = {"error": str(error)}
            if after != parts and ("error" not in after or may_be_refused):
                return True
    return False


@pytest.mark.slow
@pytest.mark.parametrize("name", CARDS)
def test_every_field_of_a_card_acts(name: str) -> None:
    card = cards()[name]
    before = [parts_of(card, {}, stage) for stage in ("draft", "")]
    assert all("error" not in parts for parts in before)
    idle = [field.path for field in card.by_path.values() if not acts(card, field, before, False)]
    assert idle == []


@pytest.mark.slow
@pytest.mark.parametrize("name", templates.KINDS)
def test_every_number_of_a_template_acts(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{name}.toml"
    path.write_text(templates.texts()[name], encoding="utf-8")
    card = own_card(path)
    before = [parts_of(card, {}, stage) for stage in ("draft", "")]
    assert all("error" not in parts for parts in before)
    idle = [field.path for field in card.by_path.values() if not acts(card, field, before, True)]
    assert idle == []


def menu_entries(name: str) -> list[tuple[str, str, dict[str, float | None]]]:
    """Return material of the card, name of the entry and its numbers in SI, of all menus."""
    page = files(cards())["/"][1].decode()
    form = re.findall(rf'<form name="{name}".*?</form>', page, re.DOTALL)[0]
    entries = []
    for material, options in re.findall(
        r'<select class="material" data-material="(.*?)">(.*?)</select>', form, re.DOTALL
    ):
        for numbers, entry in re.findall(
            r'<option data-numbers="(.*?)" data-title=".*?" data-source=".*?">(.*?)</option>',
            options,
        ):
            entries.append((material, entry, json.loads(html.unescape(numbers))))
    return entries


def chosen(card: Card, material: str, numbers: dict[str, float | None]) -> dict[str, str]:
    """Return the values of the fields that an entry fills, as the page types them."""
    values = {}
    for field in card.by_path.values():
        key = field.path.rpartition(".")[2]
        if field.path.startswith(f"materials.{material}.") and key in numbers:
            number = numbers[key]
            values[field.path] = "" if number is None else f"{number / field.size:.9g}"
    return values


@pytest.mark.parametrize("name", CARDS)
def test_menus_offer_materials_of_their_kind(name: str) -> None:
    kinds: dict[str, set[str]] = {}
    for material, entry, _ in menu_entries(name):
        kinds.setdefault(material, set()).add(nacre.materials[entry].kind)
    for material, offered in kinds.items():
        assert offered == {"coating" if material in COATINGS else "body"}


@pytest.mark.slow
@pytest.mark.parametrize("name", CARDS)
def test_every_entry_is_accepted_and_no_worse_than_its_numbers(name: str) -> None:
    card = cards()[name]
    for material, entry, numbers in menu_entries(name):
        values = chosen(card, material, numbers)
        case = card.case(values)
        by_name = parts_of(card, values)
        assert "error" not in by_name, (material, entry, by_name)
        # Numbers that are typed, each in its last digit another: no card has them.
        typed = {
            path: f"{float(text) * (1 + 1e-7):.9g}" if text else "" for path, text in values.items()
        }
        by_hand = parts_of(card, typed)
        if material_of(case, material) == entry:
            assert "(given)" not in str(by_name["verdict"]) or "(given)" in str(by_hand["verdict"])
        levels = [LEVELS.index(parts["verdict"]["level"]) for parts in (by_name, by_hand)]
        assert levels[0] >= levels[1], (material, entry)


def test_a_steel_without_a_source_keeps_the_yield_stress_that_was_typed() -> None:
    entries = {entry: numbers for material, entry, numbers in menu_entries("contact")}
    assert "yield_stress" not in entries["100Cr6"]
    assert entries["440C"]["yield_stress"] == 1.896e9
    assert entries["Si3N4"]["yield_stress"] is None  # which is brittle
    verdict = parts_of(cards()["contact"], chosen(cards()["contact"], "steel", entries["100Cr6"]))
    assert "limit 2200 MPa (given)" in str(verdict["verdict"])


def test_a_chosen_card_is_named_in_case_and_verdict() -> None:
    card = cards()["contact"]
    entries = {entry: numbers for material, entry, numbers in menu_entries("contact")}
    values = chosen(card, "steel", entries["440C"])
    assert material_of(card.case(values), "steel") == "440C"
    assert "(card 440C)" in str(parts_of(card, values)["verdict"])
    typed = values | {"materials.steel.yield_stress": "1900"}
    assert "(given)" in str(parts_of(card, typed)["verdict"])


def test_a_card_of_a_case_file_becomes_fields(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    text = templates.texts()["contact"]
    path.write_text(re.sub(r"steel = .*", 'steel = "440C"', text), encoding="utf-8")
    card = own_card(path)
    assert card.by_path["materials.steel.yield_stress"].default == 1896.0
    assert material_of(card.case({}), "steel") == "440C"
    assert "(card 440C)" in str(parts_of(card, {})["verdict"])


def test_a_bond_strength_is_a_field() -> None:
    for name in ("contact", "line"):
        card = cards()[name]
        values = {f"body.layers[0].bond_strength.{key}": "1" for key in ("shear", "tension")}
        verdict: Any = parts_of(card, values)["verdict"]
        assert verdict["level"] == "bad"
        assert "below the coating" in verdict["words"]
        assert "limit 1 MPa (given)" in verdict["words"]


def test_the_verdict_of_the_page_has_all_fields() -> None:
    verdict = parts_of(cards()["line"], {})["verdict"]
    names = "level question decided_by doubts inside_model factor words lines"
    assert verdict.keys() >= set(names.split())
