"""Cards of materials have sources for all numbers, solve contacts, and stand in case files."""

from __future__ import annotations

import copy
import dataclasses
import html
import pickle
import re
import tomllib
from importlib import resources
from pathlib import Path
from typing import Any

import pytest

import nacre
from bodies import quiet
from nacre.cards import ASSUMED, NUMBERS
from nacre.case import Case
from support import Capture, assert_close, command

CARDS = list(nacre.materials.values())
STRESSES = {"young", "hardness", "yield_stress", "flexural_strength"}


@pytest.mark.parametrize("card", CARDS, ids=lambda card: card.name)
def test_every_number_has_a_source_and_lies_in_its_range(card: nacre.types.Card) -> None:
    assert {"young", "poisson"} <= card.numbers.keys() <= NUMBERS.keys()
    for name, number in card.numbers.items():
        # A DOI, an address, a journal, a maker's or supplier's sheet, or a data base by its name.
        pattern = r"doi:10\.|https://|\(\d{4}\)|sheet|secondary: .+|scattering \(.+\)"
        assert re.search(pattern, number.source) or (name, number.source) == ("poisson", ASSUMED)
        assert (number.low is None) == (number.high is None)
        if number.low is not None and number.high is not None:
            assert number.low <= number.value <= number.high
        assert number.unit == NUMBERS[name][1]
        if name in STRESSES:  # in Pa: from that of soft carbon to that of diamond
            assert 5e7 < number.value < 1.2e12
    assert card.elastic == nacre.Elastic(card.numbers["young"].value, card.numbers["poisson"].value)
    assert card.source == card.numbers["young"].source


SEEN = """
100Cr6: young 203.4e9 190e9 210e9, poisson 0.285 0.27 0.3
M50: young 214e9, poisson 0.29, conductivity 35
440C: young 209.6e9, poisson 0.28, yield_stress 1.896e9, conductivity 22.8
316L: young 200e9, poisson 0.28, yield_stress 190e6, conductivity 15
Ti-6Al-4V: young 114e9, poisson 0.33, yield_stress 965e6
Si3N4: young 310e9, poisson 0.27, flexural_strength 830e6, conductivity 30
Si3N4-GPS: young 310e9 300e9 315e9, poisson 0.24, flexural_strength 689e6, conductivity 29
Al2O3: young 375e9, poisson 0.22, flexural_strength 379e6, conductivity 35
SiC: young 410e9, poisson 0.14, flexural_strength 550e6 400e6 550e6, conductivity 120
WC: young 630e9 530e9 700e9, poisson 0.24, conductivity 85
fused silica: young 73e9, poisson 0.17, conductivity 1.4
borosilicate 7740: young 64e9, poisson 0.2, flexural_strength 69e6, conductivity 1.1
diamond: young 1102e9 1059e9 1144e9, poisson 0.078 0.07 0.085
a-C:H: young 259e9 87e9 300e9, poisson 0.2 0.1 0.3, hardness 27e9
a-C:H soft: young 110e9 87e9 133e9, poisson 0.2 0.1 0.3
a-C: young 287e9, poisson 0.2 0.1 0.3, hardness 24e9
ta-C: young 572e9 493e9 625e9, poisson 0.2 0.1 0.3, hardness 66e9 51e9 78e9
TiN: young 397e9, poisson 0.25 0.2 0.3, hardness 23.6e9
TiAlN: young 466e9, poisson 0.25 0.2 0.3, hardness 27.3e9
CrN: young 422e9 375e9 422e9, poisson 0.25 0.2 0.3, hardness 17.9e9
"""
"""Each number, its lowest and its highest, a second time: a digit that slips is found."""


def test_digits_are_those_of_the_sources() -> None:
    rows = dict(line.split(": ") for line in SEEN.strip().splitlines())
    assert rows.keys() == nacre.materials.keys()
    for name, row in rows.items():
        typed = {word: [*map(float, numbers)] for word, *numbers in map(str.split, row.split(", "))}
        stored = {
            word: [part for part in (number.value, number.low, number.high) if part is not None]
            for word, number in nacre.materials[name].numbers.items()
        }
        assert stored == typed, name


def test_strengths_stand_with_their_treatment_and_no_fatigue_limit_stands() -> None:
    assert not any("fatigue" in name or "shear" in name for card in CARDS for name in card.numbers)
    for card in CARDS:
        if "yield_stress" in card.numbers:
            source = card.numbers["yield_stress"].source
            assert re.search("tempered|annealed|aged", source)


def test_poisson_ratios_that_are_assumed_have_a_range() -> None:
    assumed = [card for card in CARDS if card.numbers["poisson"].source == ASSUMED]
    assert {card.kind for card in assumed} == {"coating"}
    assert all(card.numbers["poisson"].low is not None for card in assumed)
    assert "assumed" in str(nacre.materials["TiN"])


@pytest.mark.parametrize("card", CARDS, ids=lambda card: card.name)
def test_every_card_solves_a_contact(card: nacre.types.Card) -> None:
    steel = nacre.materials["100Cr6"].elastic
    ball = nacre.Sphere(5e-3)
    if card.kind == "coating":
        body: Any = nacre.HalfSpace(steel, [nacre.Layer(card.elastic, 2e-6)])
        grid = nacre.Grid((32, 32), (4e-4, 4e-4))
        solution = quiet(lambda: nacre.solve(ball, body, load=10.0, grid=grid))
        assert solution.load == pytest.approx(10.0, rel=1e-6)
        return
    solution = nacre.solve(ball, card.elastic, steel, load=10.0)
    modulus = nacre.hertz.contact_modulus(card.elastic, steel)
    expected = nacre.hertz.Ellipse(5e-3, 5e-3, modulus, 10.0)
    # The cells of the automatic grid.
    assert solution.peak_pressure == pytest.approx(expected.peak_pressure, rel=5e-3)


def test_elastic_constants_of_diamond_are_hills_mean() -> None:
    # c11 1062, c12 122, c44 541 GPa: Voigt's and Reuss' shear moduli of cubic crystals.
    bulk, voigt = (1062 + 2 * 122) / 3, (1062 - 122 + 3 * 541) / 5
    reuss = 5 * (1062 - 122) * 541 / (4 * 541 + 3 * (1062 - 122))
    shear = (voigt + reuss) / 2
    young = 9 * bulk * shear / (3 * bulk + shear)
    elastic = nacre.materials["diamond"].elastic
    assert elastic.young == pytest.approx(young * 1e9, rel=1e-3)
    assert elastic.poisson == pytest.approx(young / (2 * shear) - 1, abs=1e-3)


def test_numbers_of_other_units_are_converted() -> None:
    psi = 6894.757
    assert nacre.materials["100Cr6"].elastic.young == pytest.approx(29.5e6 * psi, rel=1e-4)
    steel = nacre.materials["440C"].numbers
    assert steel["young"].value == pytest.approx(30.4e6 * psi, rel=1e-4)
    assert steel["yield_stress"].value == pytest.approx(275e3 * psi, rel=1e-4)
    assert steel["conductivity"].value == pytest.approx(13.2 * 1.7307, rel=2e-3)


def test_the_file_has_no_entry_that_is_not_read() -> None:
    text = resources.files("nacre").joinpath("materials.toml").read_text("utf-8")
    for entry in tomllib.loads(text).values():
        assert entry.keys() <= {"title", "kind", "unsourced"} | NUMBERS.keys()
        assert set(entry.get("unsourced", ())) <= NUMBERS.keys() - entry.keys()
        for number in entry.values():
            if isinstance(number, dict):
                assert number.keys() <= {"value", "low", "high", "source"}


def test_cards_are_values() -> None:
    card = nacre.materials["a-C:H"]
    assert pickle.loads(pickle.dumps(card)) == card == copy.deepcopy(card)
    assert hash(pickle.loads(pickle.dumps(card))) == hash(card)
    assert card != nacre.materials["a-C"]
    assert eval(repr(card)) == card
    assert pickle.loads(pickle.dumps(nacre.materials)) is nacre.materials
    with pytest.raises(dataclasses.FrozenInstanceError):
        card.name = "other"  # type: ignore[misc]
    with pytest.raises(TypeError):
        card.numbers["young"] = card.numbers["poisson"]  # type: ignore[index]
    with pytest.raises(TypeError):
        nacre.materials["mine"] = card


def test_the_mapping_lists_its_names_and_prints_its_numbers() -> None:
    assert len(nacre.materials) == len(list(nacre.materials)) == len(CARDS)
    assert "100Cr6" in repr(nacre.materials)
    assert "100Cr6" in nacre.materials
    assert "steel" not in nacre.materials
    text = str(nacre.materials["100Cr6"])
    assert "Young's modulus  203.4 GPa (190 GPa to 210 GPa); maker's sheet" in text


@pytest.mark.parametrize(
    ("name", "close"), [("100cr6", "'100Cr6'"), ("Si3N5", "'Si3N4'"), ("TAC", "'ta-C'")]
)
def test_an_unknown_name_is_refused_with_close_ones(name: str, close: str) -> None:
    with pytest.raises(KeyError, match=f"got '{name}'; close to it are .*{close}"):
        nacre.materials[name]


@pytest.mark.parametrize("name", ["AISI 52100", "suj2", "1.3505", "DLC", "steel"])
def test_a_name_of_the_trade_is_found_in_titles(name: str) -> None:
    card = "'a-C:H', .* 'ta-C'" if name == "DLC" else "'100Cr6'"
    with pytest.raises(KeyError, match=f"got '{name}'; it is in the title of {card}"):
        nacre.materials[name]


def test_a_name_that_is_like_none_is_refused() -> None:
    with pytest.raises(KeyError, match=r"materials, got 'qqq'; the names are '100Cr6', 'M50'"):
        nacre.materials["qqq"]
    with pytest.raises(KeyError, match="got 3"):
        nacre.materials[3]  # type: ignore[index]


CASE = """
units = "{units}"

[materials]
steel = {steel}

[shape]
kind = "sphere"
radius = {radius}

[body]
substrate = {substrate}

[solve]
load = 10

[stress]
"""


def case(tmp_path: Path, **changes: Any) -> Path:
    defaults = {"units": "SI", "steel": '"100Cr6"', "substrate": '"steel"', "radius": 5e-3}
    path = tmp_path / "case.toml"
    path.write_text(CASE.format(**defaults | changes), encoding="utf-8")
    return path


def body_of(path: Path) -> Any:
    return Case.read(path).arguments()["body"]


def test_a_card_in_a_case_is_the_numbers_typed(tmp_path: Path) -> None:
    elastic = nacre.materials["100Cr6"].elastic
    typed = body_of(
        case(tmp_path, steel=f"{{ young = {elastic.young!r}, poisson = {elastic.poisson!r} }}")
    )
    assert body_of(case(tmp_path)) == typed
    # Where a material's name stands, a card's may.
    assert body_of(case(tmp_path, substrate='"100Cr6"')) == typed
    # A name of the case comes before a card's.
    text = case(tmp_path, substrate='"M50"').read_text("utf-8")
    path = tmp_path / "own.toml"
    path.write_text(text.replace("[shape]", '"M50" = { young = 1e11, poisson = 0.3 }\n\n[shape]'))
    assert body_of(path).substrate.young == 1e11


def test_a_card_is_in_the_units_of_the_case(tmp_path: Path) -> None:
    path = case(tmp_path, units="N-mm-MPa", radius=5.0, substrate='"440C"')
    substrate = body_of(path).substrate
    assert substrate.young == pytest.approx(209.6e3, rel=1e-12)
    assert substrate.poisson == 0.28


def test_the_yield_stress_of_a_card_makes_a_safety_factor(tmp_path: Path, capsys: Capture) -> None:
    typed = "{ young = 209.6e9, poisson = 0.28, yield_stress = 1.896e9 }"
    printed = []
    for steel in ('"440C"', typed):
        assert command("solve", case(tmp_path, steel=steel)) == 0
        printed.append(capsys.readouterr().out)
    assert printed[0] == printed[1].replace("(given)", "(card 440C)", 1)
    # 1896 MPa over the stress that is printed beside.
    assert re.search(r"von Mises .* 1\.9", printed[0])
    assert command("solve", case(tmp_path)) == 0  # the card of 100Cr6 has no yield stress
    assert not re.search(r"von Mises .* 1\.9", capsys.readouterr().out)


def test_a_coating_says_which_value_is_taken(tmp_path: Path) -> None:
    path = case(tmp_path)
    text = path.read_text("utf-8") + '\n[[body.layers]]\nmaterial = "ta-C"\nthickness = 2e-6\n'
    path.write_text(text, encoding="utf-8")
    with pytest.warns(nacre.NacreWarning, match="ta-C has Young's modulus 572 GPa .493 GPa to 625"):
        body = body_of(path)
    assert body.layers[0].material == nacre.materials["ta-C"].elastic


def test_a_bearing_takes_cards(tmp_path: Path) -> None:
    text = """
units = "{units}"
[materials]
balls = "Si3N4"
[bearing]
kind = "deep_groove_ball"
count = 9
diameter = {diameter}
pitch_diameter = {pitch}
element = {{ substrate = "balls" }}
inner = {{ substrate = "100Cr6" }}
[bearing.solve]
force = {{ x = 1000 }}
model = "iso16281"
[bearing.life]
speed = 100
kinematic_viscosity = {viscosity}
contamination = "high cleanliness"
spectrum = [
    {{ share = 0.5, force = {{ x = 1000 }}, speed = 100 }},
    {{ share = 0.5, force = {{ x = 500 }}, speed = 200 }},
]
""".replace("speed = 100\nkin", "kin")
    lives = []
    for units, diameter, pitch, viscosity in (
        ("SI", 9.525e-3, 46e-3, 20e-6),
        ("N-mm-MPa", 9.525, 46.0, 20.0),
    ):
        path = tmp_path / "bearing.toml"
        numbers = {"diameter": diameter, "pitch": pitch, "viscosity": viscosity}
        path.write_text(text.format(units=units, **numbers), encoding="utf-8")
        read: Any = Case.read(path)
        arguments = read.arguments()
        bearing = arguments.pop("bearing")
        assert bearing.element.substrate.young == pytest.approx(310e9, rel=1e-12)
        assert bearing.inner.substrate.young == pytest.approx(203.4e9, rel=1e-12)
        lives.append(bearing.solve(**arguments).life(**read.life()))
    for name in ("hours", "viscosity_ratio", "fatigue_load_limit"):
        assert_close(getattr(lives[0], name), getattr(lives[1], name), rtol=1e-9)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"substrate": '"100cr6"'},
            "body.substrate: must be one of the materials (steel), got '100cr6'; close to it are "
            "'100Cr6' in nacre.materials",
        ),
        ({"steel": '"440D"'}, "materials.steel: name must be one of nacre.materials, got '440D'"),
    ],
)
def test_an_unknown_card_in_a_case_is_named(
    tmp_path: Path, changes: dict[str, str], message: str
) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        body_of(case(tmp_path, **changes))


def test_a_notebook_shows_the_numbers_of_a_card() -> None:
    card = nacre.materials["100Cr6"]
    table = card._repr_html_()
    for number in card.numbers.values():
        assert html.escape(str(number)) in table
