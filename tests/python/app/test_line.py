"""Lines of text on bearings: each is understood in full, or asked back."""

from __future__ import annotations

import math
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nacre.app.answer import answer, file_text
from nacre.app.cards import cards
from nacre.app.line import SYMBOLS, TABLES, filled, read, with_note
from nacre.bearing import compare_ratings
from nacre.bearing.modified import SMALL
from support import assert_close, fuzz

TURNS = 2 * math.pi / 60
ARC = math.pi / 180 / 60
ALL = {"C": 14.8e3, "Fr": 2e3, "n": 1500 * TURNS, "VG": 68.0, "T": 70.0, "life": 20e3}
SIZES = {"d": 0.025, "D": 0.052, "B": 0.015}
UNDERSTOOD = [
    ("6205, C 14.8 kN, Fr 2 kN, 1500/min, VG 68, 70 °C, 20000 h", "6205", ALL),
    ("6205 C 14,8 kN Fr 2 kN n=1500 ISO VG 68 70°C L10h 20 000 h", "6205", ALL),
    ("6205-2RS/C3; C=14800N; Fr: 2000 N; n 25 Hz; VG68; T 70 °C; 20000 h", "6205", ALL),
    ("6205 2RS C3, C_r 14.8 kN, F_r 2 kN, 1500 rpm, ISO-VG 68, 70 °C, life 20000", "6205", ALL),
    ("20000 h,1500 U/min,C 14,8 kN,Fr 2 kN,70 °C,VG 68", "", ALL),
    ("d 25,D 52,B 15", "", SIZES),
    ("d=2,5 cm D=52mm B 15.0", "", SIZES),
    ("NU 209 ECP, Fr 10 kN, tilt 2'", "NU 209", {"Fr": 10e3, "tilt": 2 * ARC}),
    ("NU209, radial 10 kN, misalignment 0.5 mrad", "NU 209", {"Fr": 10e3, "tilt": 5e-4}),
    ("608, Fa 10 N", "608", {"Fa": 10.0}),
    ("6205 Z 9 C0 7,85 kN normal cleanliness", "6205", {"Z": 9.0, "C0": 7850.0}),
]
"""Lines, their designations, and their numbers."""
ASKED = [
    ("C 14.8, Fr 2 kN", "C 14.8", {"Fr": 2e3}),
    ("2 kN, 1500/min", "2 kN", {"n": 1500 * TURNS}),
    ("Fr 2 kM 1500/min", "Fr 2 kM 1500/min", {}),
    ("Fr about 2 kN, 1500/min", "Fr about 2 kN", {"n": 1500 * TURNS}),
    ("d 25 inch, D 52", "d 25 inch", {"D": 0.052}),
    ("C 14,800 N, Fr 2 kN", "C 14,800 N", {"Fr": 2e3}),
    ("n 1.500/min, Fr 2 kN", "n 1.500/min", {"Fr": 2e3}),
    ("n 1 500 1/min, Fr 2 kN", "n 1 500 1/min", {"Fr": 2e3}),
    ("VG 69, 70 °C", "VG 69", {"T": 70.0}),
    ("1500, Fr 2 kN, 3000", "3000", {"Fr": 2e3}),
    ("Fr 2 kN, Fr 3 kN", "Fr", {"Fr": 2e3}),
    ("70 K, Fr -2 kN", "Fr -2 kN", {}),
    ("C0 kN", "C0 kN", {}),
    ("idle for 20000 h", "idle for 20000 h", {}),
    ("25 degrees, 90 s, 0.3", "90 s", {}),
    ("N 1500, Fr 2 kN", "N 1500", {"Fr": 2e3}),
    ("Z 9.5, n 1500 hm", "Z 9.5", {}),
]
"""Lines, words of which are asked, and the numbers that are understood all the same."""


@pytest.mark.parametrize(("text", "designation", "values"), UNDERSTOOD)
def test_a_line_is_understood_in_full(
    text: str, designation: str, values: dict[str, float]
) -> None:
    line = read(text)
    assert (line.designation, line.asked) == (designation, [])
    numbers = {name: value for name, value in line.values.items() if name != "cleanliness"}
    assert numbers.keys() == values.keys()
    for name, value in values.items():
        assert_close(numbers[name], value, rtol=1e-14)


@pytest.mark.parametrize(("text", "words", "values"), ASKED)
def test_what_is_not_certain_is_asked(text: str, words: str, values: dict[str, float]) -> None:
    line = read(text)
    assert words in " ".join(line.asked)
    assert line.values.keys() == values.keys()
    for name, value in values.items():
        assert_close(line.values[name], value, rtol=1e-14)


@pytest.mark.parametrize("words", SMALL)
def test_degrees_of_cleanliness_are_those_of_the_standard(words: str) -> None:
    assert read(f"6205, {words.capitalize()}").values == {"cleanliness": words}
    assert read(f"{words}s").values == {}


@fuzz(200)
@given(st.text(st.sampled_from("6205 NUCFrandDBZVGT0.,;:=-/'°hkNm 1500 20000"), max_size=40))
def test_every_word_is_understood_or_asked(text: str) -> None:
    line = read(text)
    assert all(math.isfinite(float(v)) for k, v in line.values.items() if k != "cleanliness")
    said = line.designation or line.values or line.asked
    assert bool(said) == bool(text.strip(" ,;"))


def test_a_line_fills_the_card_of_its_designation() -> None:
    line = filled("NU 209, Fr 10 kN, n 1500, tilt 2', life 20000 h", cards(), "ball-bearing")
    assert line.card == "bearing"
    assert line.values == {
        "bearing.solve.force.x": "10",
        "bearing.solve.speed": "1500",
        "bearing.solve.tilt.y": "2",
        "bearing.life.required_life": "20000",
    }
    assert any("rollers do not follow from the ratings" in text for text in line.asked)


@pytest.mark.parametrize("name", ["7205", "30205", "22205", "51105", "1205"])
def test_bearings_without_a_card_fill_nothing(name: str) -> None:
    line = filled(f"{name}, Fr 2 kN", cards(), "ball-bearing")
    assert (line.values, len(line.asked)) == ({}, 1)
    assert name in line.asked[0]


def test_numbers_out_of_the_range_of_a_field_are_asked() -> None:
    line = filled("Fr 5 MN, n 3000", cards(), "ball-bearing")
    assert line.values == {"bearing.solve.speed": "3000", "bearing.solve.force.z": "0"}
    assert line.asked[0] == "radial load must be between 0.01 and 1000 kN, got 5000"


def test_a_radial_load_alone_has_no_axial_load_beside_it() -> None:
    line = filled("Fr 5 kN, life 1000", cards(), "ball-bearing")
    assert line.values["bearing.solve.force.z"] == "0"
    assert line.asked == [
        "no axial load in the line: it is 0",
        "not in the line, and left as it is: speed, oil, ISO VG, oil temperature, cleanliness",
    ]
    axial = filled("Fa 5 kN, life 1000", cards(), "ball-bearing")
    assert axial.asked[0].startswith("not in the line, and left as it is: radial load, speed")


# Balls of catalogues: 9 of 5/16", 9 of 3/8", 8 of 13/32" within a hundredth, by ratings of SKF and
# NTN that ISO 281 gives within 1 %.
@pytest.mark.parametrize(
    ("text", "count", "diameter", "pitch"),
    [
        ("6205, C 14 kN, C0 7.85 kN", 9, 7.9375, 38.5),
        ("d 25, D 52, C 14 kN, C0 7.85 kN", 9, 7.9375, 38.5),
        ("6206, C 19,5 kN, C0 11,3 kN", 9, 9.525, 46),
        ("6305, C 20.6 kN, C0 11.2 kN, Z 8", 8, 10.32, 43.5),
    ],
)
def test_balls_follow_from_the_ratings(
    text: str, count: int, diameter: float, pitch: float
) -> None:
    card = cards()["ball-bearing"]
    line = filled(text, cards(), "bearing" if text.startswith("6") else card.name)
    assert line.card == card.name
    assert [words for words in line.asked if "not in the line" not in words] == []
    assert line.estimated == line.values
    assert line.values["bearing.count"] == str(count)
    assert_close(float(line.values["bearing.diameter"]), diameter, rtol=1e-2)
    assert float(line.values["bearing.pitch_diameter"]) == pitch
    bearing = card.case(line.values).arguments()["bearing"]
    capacity = float(read(text).values["C"])
    difference = compare_ratings(bearing, capacity=capacity).capacity
    assert difference is not None
    assert abs(difference) < 0.05


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("6205", "give C, C0"),
        ("6205, C 14 kN", "give C0"),
        ("16005, C 8 kN, C0 4.75 kN", "give D"),
        ("6221, C 133 kN, C0 104 kN", "give D"),
        ("C 14 kN, C0 7.85 kN, D 52", "give d"),
        ("6205, d 30, C 14 kN, C0 7.85 kN", "d of a 6205 is 25 mm"),
        ("608, D 22, d 5, C 3.4 kN, C0 1.4 kN", "d of a 608 is 8 mm"),
        ("6205, C 14 N, C0 7.85 N", "are they in N?"),
    ],
)
def test_a_geometry_that_does_not_follow_is_asked(text: str, words: str) -> None:
    line = filled(text, cards(), "ball-bearing")
    assert words in line.asked[-1]
    assert (line.estimated, line.note) == ({}, "")


@pytest.mark.filterwarnings("ignore")
def test_an_estimate_is_marked_until_it_is_replaced() -> None:
    card, text = cards()["ball-bearing"], "6206, C 19.5 kN, C0 11.3 kN"
    line = filled(text, cards(), card.name)
    case, measured = card.case(line.values), with_note(text, line.values, card)
    assert f"# estimated: {line.note}" in file_text(case, measured).splitlines()
    assert tomllib.loads(file_text(case, measured)) == tomllib.loads(file_text(case))
    assert answer(case, "draft", measured=measured)["parts"]["warnings"][0] == line.note
    assert "estimates from the ratings" in answer(case, "report", measured=measured)["report"]
    other = line.values | {"bearing.diameter": "9.525"}
    assert with_note(text, other, card) is card.measured
    assert with_note("", line.values, card) is card.measured


def test_symbols_have_fields() -> None:
    fields = {path for name in ("bearing", "ball-bearing") for path in cards()[name].by_path}
    without = {name for name, symbol in SYMBOLS.items() if symbol.get("target") not in fields}
    assert without <= {"C", "C0", "d", "D", "B", "VG", "T", "cleanliness"}
    for sizes in (*TABLES["outside"].values(), *TABLES["grades"].values()):
        assert sizes == sorted(sizes)
