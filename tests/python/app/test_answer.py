"""Answers of the page: every card at every stage, and every value, an answer or a sentence."""

from __future__ import annotations

import hashlib
import html
import json
import math
import re
import time
import tomllib
import warnings
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import nacre
from nacre.app import answer as module
from nacre.app.answer import CONTACT_ROWS, STAGES, Stopped, answer, file_text
from nacre.app.cards import cards, check_size, own_card
from nacre.app.fields import Field, FieldError
from nacre.app.server import SECONDS
from nacre.case import Case, CaseError, templates, toml
from nacre.indent import _reading as reading
from support import Capture, command, fuzz, written

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")

CARDS = list(cards())
DRAFT: dict[str, Any] = {"model": "iso16281", "cells": None}
QUICK = [name for name in CARDS if name not in ("bearing", "roller")]
"""Cards whose full answers take less than a second or so."""


def solved(name: str, values: dict[str, object], folder: Path, capsys: Capture) -> dict[str, Any]:
    """Return what ``nacre solve --json`` makes of the case file of a card."""
    path = folder / f"{name}.toml"
    path.write_text(file_text(cards()[name].case(values)), encoding="utf-8")
    assert command("solve", path, "--json") == 0
    numbers: dict[str, Any] = json.loads(capsys.readouterr().out)
    return numbers


def main_number(parts: dict[str, Any]) -> tuple[float, str]:
    """Return the main number of an answer, and its unit."""
    value, unit = parts["peak"][1].removeprefix("about ").split()[:2]
    return float(value), unit


@pytest.mark.parametrize("name", [name for name in CARDS if name not in ("pair", "rough")])
def test_defaults_are_those_of_the_templates(name: str) -> None:
    data = tomllib.loads(templates.texts()[name])
    case = Case(cards()[name].base).data
    for one in cards()[name].fields:
        try:
            in_template = _at(data, one.path)
        except LookupError:
            continue  # not in the template
        if isinstance(in_template, float | int) and one.path != "adhesion.work":
            assert _at(case, one.path) == pytest.approx(in_template, rel=2e-3), one.path


def _at(data: Any, path: str) -> Any:
    for key in re.findall(r"[^.\[\]]+", path):
        data = data[int(key) if isinstance(data, list) else key]
    return data


@pytest.mark.parametrize("name", templates.KINDS)
def test_templates_are_the_same_after_a_round_through_text(name: str) -> None:
    data = tomllib.loads(templates.texts()[name])
    assert tomllib.loads(toml.text(data, ("a note\nin two lines",))) == data


words = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
values = st.recursive(
    st.booleans() | st.integers(-(2**60), 2**60) | st.floats(allow_nan=False) | words,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(words, inner, max_size=3),
)


@fuzz(100)
@given(st.dictionaries(words, values, max_size=4))
def test_any_data_are_read_back(data: dict[str, Any]) -> None:
    assert tomllib.loads(toml.text(data)) == data


def largest_pressure(numbers: dict[str, Any]) -> float:
    """Return the largest pressure of a result, of a history that of its end."""
    if "first" in numbers:  # a pair
        return max(largest_pressure(numbers[name]) for name in ("first", "second"))
    if "peak_pressures" in numbers:
        return float(max(map(max, numbers["peak_pressures"])))
    peaks = numbers["peak_pressure"]
    return float(peaks[-1] if isinstance(peaks, list) else peaks)


@pytest.mark.parametrize("name", QUICK)
def test_numbers_are_those_of_the_command_line(name: str, tmp_path: Path, capsys: Capture) -> None:
    load = next(
        one
        for one in cards()[name].fields
        if one.label in ("load", "largest load") or "load" in one.label
    )
    changed: dict[str, object] = {load.path: str(1.3 * float(load.default or 0))}
    numbers = solved(name, changed, tmp_path, capsys)
    stage = "stress" if name in ("contact", "line") else "full"
    parts = answer(cards()[name].case(changed), stage)["parts"]
    value, unit = main_number(parts)
    if name in ("indentation", "cone"):
        expected = max(numbers["approach"])
        value *= {"nm": 1e-3, "µm": 1.0}[unit]
    else:
        expected = largest_pressure(numbers)
        assert unit == "MPa"
    assert value == pytest.approx(expected, rel=1e-4)
    if stage == "stress":
        steel = numbers["stress"]["layers"][1]
        assert f"{steel['yield_safety_factor']:.3g}" in str(parts["verdict"])
        assert numbers["verdict"]["stress"] == parts["verdict"]


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(
            name, marks=[pytest.mark.slow] if name in ("bearing", "fatigue", "roller") else []
        )
        for name in templates.KINDS
    ],
)
def test_reports_are_those_of_the_command_line(name: str, tmp_path: Path, capsys: Capture) -> None:
    path, saved = tmp_path / f"{name}.toml", tmp_path / f"{name}.html"
    card = cards().get(name)
    case = card.case({}) if card else Case.read(written(tmp_path, templates.texts()[name]))
    path.write_text(file_text(case), encoding="utf-8")
    assert command("solve", path, "--save", saved) == 0
    capsys.readouterr()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", nacre.NacreWarning)
        on_page = answer(Case(case.data, name, tmp_path), "report")["report"]
    # The name of a card is in the first line of its file.
    on_disk = saved.read_text(encoding="utf-8").replace(f"# {case.name}:", f"# {name}:")
    assert html.escape('units = "') in on_page  # the case in full
    assert on_page == on_disk


VARIATIONS: dict[str, list[dict[str, str]]] = {
    "contact": [{"solve.load": "200"}, {"body.layers[0].thickness": "20"}, {"shape.radius": "50"}],
    "line": [{"solve.load": "900"}, {"body.layers[0].thickness": "20"}, {"shape.radius": "50"}],
    "bearing": [
        {"bearing.solve.force.x": "40"},
        {"bearing.solve.tilt.y": "8"},
        {"bearing.clearance": "5"},
    ],
    "pair": [
        {"bearing.solve.force.x": "400"},
        {"bearing.preload_force": "2000"},
        {"bearing.first.contact_angle": "15"},
    ],
    "rough": [{"solve.load": "5"}, {"shape.rms_slope": "0.03"}, {"shape.seed": "3"}],
    "wear": [
        {"solve.load": "400"},
        {"body.layers[0].thickness": "5"},
        {"wear.rate.substrate": "1e-8"},
    ],
    "relay": [
        {"solve.load": "5"},
        {"body.layers[0].thickness": "5"},
        {"conductance.conductivity.gold": "1"},
    ],
    "roll": [{"solve.load": "20"}, {"roll.creepage.across": "0.5"}, {"shape.radius_y": "80"}],
    "fatigue": [{"solve.load": "1500"}, {"shape.radius": "40"}, {"fatigue.friction": "0.3"}],
    "ball-bearing": [
        {"bearing.solve.force.x": "6"},
        {"bearing.solve.force.z": "3"},
        {"bearing.osculation[0]": "0.55"},
    ],
    "roller": [
        {"solve.load": "3000"},
        {"body.layers[0].thickness": "20"},
        {"solve.eccentricity.x": "1"},
    ],
    "indentation": [{"indent.load": "0.1"}, {"adhesion.work": "100"}, {"tip.radius": "1"}],
    "cone": [{"indent.load": "10"}, {"tip.half_angle": "60"}, {"materials.film.young": "10"}],
}
"""Values of each card besides its defaults, and three others."""


def stated(text: str) -> float:
    """Return the stated error of a number as a share."""
    return max(map(float, re.findall(r"± ([\d.]+) %", text)), default=0.0) / 100


@pytest.mark.parametrize(
    ("name", "values"),
    [
        pytest.param(name, values, marks=[] if name in QUICK else [pytest.mark.slow])
        for name in CARDS
        for values in [{}, *VARIATIONS[name]]
    ],
)
def test_drafts_are_within_their_error(name: str, values: dict[str, str]) -> None:
    case = cards()[name].case(values)
    draft, full = (answer(case, stage) for stage in ("draft", "full"))
    assert draft["next"] == "full"
    draft, full = draft["parts"], full["parts"]
    texts = draft["peak"][1], full["peak"][1]
    assert texts[0].startswith("about ")
    assert "about" not in texts[1]
    assert "<th>about" in draft["rows"]
    assert "<th>about" not in full["rows"]
    share = stated(texts[0])
    assert main_number(draft)[0] == pytest.approx(main_number(full)[0], rel=share + 1e-4)
    if "verdict" in draft:
        assert draft["verdict"]["words"].startswith("About: ")
        assert not full["verdict"]["words"].startswith("About: ")


def test_the_misalignment_is_the_tangent_of_its_angle() -> None:
    case = cards()["bearing"].case({"bearing.solve.tilt.y": "10"})
    assert _at(case.data, "bearing.solve.tilt.y") == math.tan(math.radians(10 / 60))


def test_the_reading_of_a_film_without_a_substrate_is_its_modulus() -> None:
    same = {"materials.glass.young": "3", "materials.glass.poisson": "0.4"}
    card = cards()["indentation"]
    parts = answer(card.case(same), "full", shown=card.shown)["parts"]
    assert parts["verdict"]["level"] == "good"
    assert "gives 3 GPa for a film of 3 GPa (1 times" in parts["verdict"]["words"]


def test_the_substrate_shows_below_a_deep_indentation() -> None:
    verdict = answer(cards()["indentation"].case({}), "full")["parts"]["verdict"]
    assert verdict["level"] == "bad"
    assert "(2.4 times, ± 10 % tolerated)" in verdict["words"]
    unasked = answer(cards()["indentation"].case({"indent.tolerance": ""}), "full")["parts"]
    assert unasked["verdict"]["level"] == "unknown"
    assert "only up to 1.91 nm" in verdict["lines"][0]


def test_sliding_contacts_have_stresses_over_depth() -> None:
    data = tomllib.loads(templates.texts()["slide"])
    data["grid"]["shape"] = [32, 32]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", nacre.NacreWarning)
        parts = answer(Case(data, "slide"), "stress")["parts"]
    assert "Von Mises stress" in parts["picture-2"]


def test_an_empty_limit_says_what_is_needed() -> None:
    empty = {"materials.steel.yield_stress": " ", "materials.coating.strength": ""}
    case = cards()["line"].case(empty)
    verdict = answer(case, "stress")["parts"]["verdict"]
    assert verdict["level"] == "unknown"
    assert sum("no limit is given" in line for line in (verdict["words"], *verdict["lines"])) == 3


@pytest.mark.parametrize("name", ["bearing", "ball-bearing"])
@pytest.mark.parametrize(("hours", "level"), [("1e6", "bad"), ("10", None), ("", "unknown")])
def test_a_required_life_is_judged(name: str, hours: str, level: str | None) -> None:
    case = cards()[name].case({"bearing.life.required_life": hours})
    verdict = answer(case, "draft")["parts"]["verdict"]
    assert (verdict["question"] is not None) == bool(hours)
    assert level in (None, verdict["level"])


def test_lines_have_grids_that_hold_them() -> None:
    for load in ("0.01", "100", "1e5"):
        reply = answer(cards()["line"].case({"solve.load": load}), "full")
        assert not any("grid" in text for text in reply["parts"]["warnings"]), load


@pytest.mark.parametrize(
    "typed", ["nan", "inf", "-1e999", "", "two", "1e9", "-3", "0x10", None, []]
)
def test_wrong_numbers_name_field_and_unit(typed: object) -> None:
    with pytest.raises(
        FieldError, match=r"^load must be between 0\.001 and 1000000 N, got"
    ) as error:
        cards()["contact"].case({"solve.load": typed})
    assert error.value.path == "solve.load"


def test_counts_are_whole_and_commas_are_points() -> None:
    with pytest.raises(FieldError, match="rollers must be a whole number"):
        cards()["bearing"].case({"bearing.count": "16.5"})
    case = cards()["contact"].case({"solve.load": "12,5"})
    assert _at(case.data, "solve.load") == 12.5


def test_what_the_solver_refuses_is_a_sentence() -> None:
    reply = answer(cards()["bearing"].case({"bearing.diameter": "60"}), "draft")
    assert set(reply) == {"error"}
    assert "rollers" in reply["error"] or "pitch" in reply["error"]


@pytest.mark.parametrize("name", CARDS)
@pytest.mark.parametrize("stage", [*STAGES, "report"])
def test_answers_that_nobody_wants_stop(name: str, stage: str) -> None:
    with pytest.raises(Stopped):
        answer(cards()[name].case({}), stage, lambda: False)


def test_an_indentation_is_given_up_between_two_loads() -> None:
    answers = iter([True, True, True])
    with pytest.raises(Stopped):
        answer(cards()["indentation"].case({}), "full", lambda: next(answers, False))
    assert list(answers) == []


def text_of(one: Field) -> st.SearchStrategy[str]:
    """Return what may be typed into a field: the ends of its range, and what lies between."""
    if one.choices:
        return st.sampled_from(one.choices)
    if one.is_count:
        return st.integers(int(one.low), int(one.high)).map(str)
    low, high = max(one.low, 1e-6), one.high
    powers = st.floats(math.log10(low), math.log10(high)).map(lambda p: f"{10**p:.4g}")
    ends = st.sampled_from([f"{one.low:g}", f"{one.high:g}"])
    return powers.filter(lambda text: one.low <= float(text) <= one.high) | ends


@pytest.mark.slow
@pytest.mark.parametrize("name", CARDS)
def test_any_values_have_an_answer_or_a_sentence(name: str) -> None:
    fields = cards()[name].fields

    @fuzz(8)
    @given(st.fixed_dictionaries({}, optional={one.path: text_of(one) for one in fields}))
    def check(typed: dict[str, str]) -> None:
        end = time.process_time() + SECONDS
        try:
            reply = answer(cards()[name].case(typed), "draft", lambda: time.process_time() < end)
        except Stopped:  # which the page says in a sentence
            return
        assert set(reply) in ({"error"}, {"parts", "next"})
        assert "Traceback" not in str(reply)
        assert "nan" not in str(reply.get("parts", {}).get("peak", "")).split()
        json.dumps(reply, allow_nan=False)

    check()


def test_a_file_is_a_card_of_its_own(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(templates.texts()["sweep"], encoding="utf-8")
    card = own_card(path)
    assert card.fields[0].path == "solve.load"
    assert "sweep" not in card.base
    reply = answer(card.case({"solve.load": "30"}), "full")
    assert "30 N" in reply["parts"]["rows"]


def test_a_material_may_have_digits_as_its_name(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(templates.texts()["contact"].replace("steel", "1045"), encoding="utf-8")
    card = own_card(path)
    assert card.by_path["materials.1045.young"].default == 210e3
    case = card.case({"materials.1045.young": "200e3"})
    assert _at(case.data, "materials.1045.young") == 200e3


def test_a_measured_surface_is_read_once(tmp_path: Path) -> None:
    heights = "\n".join(
        " ".join(str((i - 8) ** 2 + (k - 8) ** 2) for k in range(16)) for i in range(16)
    )
    (tmp_path / "map.txt").write_text(heights, encoding="utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(
        '[shape]\nkind = "height_map"\npath = "map.txt"\nspacing = 1e-6\nunit = "nm"\n'
        "[body]\nsubstrate = { young = 210e9, poisson = 0.3 }\n[solve]\nload = 1e-4\n",
        encoding="utf-8",
    )
    card = own_card(path)
    digest = hashlib.sha256((tmp_path / "map.txt").read_bytes()).hexdigest()
    (tmp_path / "map.txt").unlink()
    assert not any(one.path.startswith("shape") for one in card.by_path.values())
    reply = answer(card.case({}), "full", measured=card.measured)
    assert "error" not in reply
    text = answer(card.case({}), "case", measured=card.measured)["case"]
    assert tomllib.loads(text)["shape"]["path"] == "map.txt"
    with pytest.warns(nacre.NacreWarning):
        report = answer(card.case({}), "report", measured=card.measured)["report"]
    assert digest in report


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ("[solve]", "[grid]\nshape = [300, 300]\nsize = [1, 1]\n\n[solve]", "cells"),
        (
            "layers = [",
            "layers = [" + '{ material = "coating", thickness = 1e-3 }, ' * 20,
            "layers",
        ),
    ],
)
def test_large_files_are_refused(old: str, new: str, what: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(templates.texts()["contact"].replace(old, new, 1), encoding="utf-8")
    with pytest.raises(CaseError, match=f"{what} must be at most"):
        own_card(path)


@pytest.mark.parametrize(
    ("data", "what"),
    [
        ({"wear": {"steps": 201.0}}, "steps"),
        ({"slide": {"steps": [{}] * 201}}, "steps"),
        ({"roll": {"cells": 65_537.0}}, "cells"),
        ({"bearing": {"first": {"count": 101, "rows": 2}}}, "elements"),
    ],
)
def test_sizes_are_limited_wherever_they_stand(data: dict[str, Any], what: str) -> None:
    with pytest.raises(CaseError, match=f"{what} must be at most"):
        check_size(data)


@pytest.mark.parametrize("stage", ["full", "report"])
def test_what_does_not_converge_is_a_sentence(stage: str) -> None:
    data: dict[str, Any] = cards()["contact"].case({}).data
    data["solve"]["max_iterations"] = 1
    reply = answer(Case(data, "contact"), stage)
    assert "converge" in reply["error"]


def test_markup_in_names_is_text(tmp_path: Path) -> None:
    bad = "<img src=x onerror=alert(1)>"
    text = templates.texts()["contact"].replace("coating =", f'"{bad}" =', 1)
    text = text.replace('material = "coating"', f'material = "{bad}", name = "{bad}"', 1)
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    card = own_card(path)
    from nacre.app.page import files

    page = files({"own": card})["/"][1].decode()
    reply = answer(card.case({}), "stress")
    report = answer(card.case({}), "report")["report"]
    shown = [page, report, *(text for name, text in reply["parts"].items() if "picture" in name)]
    assert bad in str(reply["parts"]["verdict"])  # which the page sets as text
    assert not any("<img" in text for text in [*shown, reply["parts"]["rows"]])


def test_numbers_of_fields_are_typed_in_their_unit() -> None:
    one = Field("a.b", "thing", "µm", "m", 1, 0, 5)
    assert one.number(" 2,5 ") == 2.5
    assert one.in_case(2.5, "N-mm-MPa") == 0.0025


def test_rows_have_the_units_of_the_card_and_components_their_words() -> None:
    def rows(name: str, stage: str = "draft") -> str:
        card = cards()[name]
        parts = answer(card.case({}), stage, shown=card.shown)["parts"]
        return html.unescape(parts["rows"])

    of_bearing = rows("bearing")
    assert "<th>tilt</th><td>2′ about y</td>" in of_bearing
    assert re.search(r"ratings of contacts</th><td>[\d.]+ kN inner ring, [\d.]+ kN out", of_bearing)
    assert re.search(r"life in hours</th><td>[\d ]+ h<", of_bearing)
    assert "tilt" not in rows("ball-bearing")
    assert "′ along x" in rows("roller")
    assert "tilt" not in rows("contact")
    assert "0.1 % along x" in rows("roll")
    assert "<th>largest load</th><td>1 mN</td>" in rows("indentation")
    assert "inf" not in rows("cone")


@pytest.mark.parametrize("name", CARDS)
def test_units_of_the_answer_are_those_that_are_typed(name: str) -> None:
    card = cards()[name]
    stage = "full" if card.case({}).kind in ("bearing", "wear") else "stress"
    reply = answer(card.case({}), "draft" if name == "bearing" else stage, shown=card.shown)
    parts = reply["parts"]
    text = f"{parts['peak']} {parts['rows']} {parts['verdict']} {parts['warnings']}"
    typed = {one.unit for one in card.by_path.values()}
    for dimension in ("Pa", "N"):
        known = {unit for unit in typed if re.fullmatch(rf".?{dimension}", unit)}
        if dimension == "Pa" and dimension not in card.shown:
            known.add("MPa")  # of stresses, beside moduli in GPa
        units = set(re.findall(rf"\d ((?:[GMkmµ])?{dimension})\b(?![/ ]m)", text))
        assert not known or units <= known, (units, known)


def test_the_oil_acts_in_life_and_film() -> None:
    card = cards()["bearing"]
    lives, films = [], []
    for typed in ("20", "70", "110"):
        case = card.case({"bearing.oil.temperature": typed})
        parts = answer(case, "draft")["parts"]
        lives.append(float(re.findall(r"a_ISO</th><td>([\d.]+)", parts["rows"])[0]))
        film = case.film() or {}
        films.append(film["viscosity"])
        bearing = case.arguments()["bearing"]
        # Both surfaces have the mean of the speeds of a roller that rolls.
        gamma = bearing.diameter / bearing.pitch
        turns = 1500 * math.pi / 30
        assert film["speed"] == pytest.approx(turns * bearing.pitch / 4 * (1 - gamma**2))
    assert lives[0] > lives[1] > lives[2]
    assert films[0] > films[1] > films[2]


def test_readings_without_film_are_unknown() -> None:
    assert reading.substrate_verdict(None).level == "unknown"


def test_the_numbers_of_the_bare_body_stand_beside() -> None:
    stiff = {"materials.coating.young": "800", "body.layers[0].thickness": "20"}
    case = cards()["contact"].case(stiff)
    parts = answer(case, "stress")["parts"]
    rows = parts["rows"]
    assert "<tr><th></th><th>coated</th><th>bare</th></tr>" in rows
    bare = nacre.HalfSpace(case.arguments()["body"].substrate)
    with nacre.display_units(case.units), warnings.catch_warnings():
        warnings.simplefilter("ignore", nacre.NacreWarning)
        arguments = case.arguments()
        keywords = case.stress() or {}
        solutions = [nacre.solve(**arguments), nacre.solve(**arguments | {"body": bare})]
        coated = solutions[0].stress_summary(**keywords)
        other = solutions[1].stress_summary(friction=keywords["friction"])
        of_bare = {row.key: html.escape(row.text) for row in solutions[1]._rows()}
        for row in solutions[0]._rows():
            if row.key in CONTACT_ROWS - {"tilt"}:  # of 0, which is not shown
                pair = html.escape(row.text), of_bare[row.key]
                assert "<th>{}</th><td>{}</td><td>{}</td>".format(row.label, *pair) in rows
    largest = [max(part.tension[0] for part in one.layers) for one in (coated, other)]
    tensions = re.findall(
        r"<th>largest tension</th><td>([\d.]+) MPa ± .*?</td><td>([\d.]+) MPa", rows
    )
    assert [float(text) for text in tensions[0]] == pytest.approx(largest, rel=2e-3)
    assert largest[0] > 1.2 * largest[1]  # the coat is stiffer
    peaks = [solution.peak_pressure for solution in solutions]
    assert highest(parts["picture-1"], ["coated", "bare"], 1e-6 * peaks[0]) == pytest.approx(
        [1e-6 * peak for peak in peaks], rel=3e-3
    )


def highest(picture: str, names: list[str], top: float) -> list[float]:
    """Return the largest numbers of the curves of these names, of which the largest is known."""
    assert re.findall(r"<text class='start'[^>]*>([^<]*)</text>", picture) == names
    curves = re.findall(r"<polyline[^>]* points='([^']*)'", picture)
    floor = float(re.findall(r"<rect class='frame paper' [^>]*y='([\d.]+)'", picture)[0])
    height = float(re.findall(r"<rect class='frame paper' [^>]*height='([\d.]+)'", picture)[0])
    pixels = [min(float(pair.split(",")[1]) for pair in points.split()) for points in curves]
    above = [floor + height - pixel for pixel in pixels]  # pixels count downwards
    return [top * one / max(above) for one in above]


def test_pressures_that_one_picture_cannot_tell_apart_have_their_difference() -> None:
    for thickness, is_same in (("0.5", True), ("40", False)):
        values = {"body.layers[0].thickness": thickness, "materials.coating.young": "400"}
        case = cards()["contact"].case(values)
        picture = answer(case, "full")["parts"]["picture-1"]
        assert ("Difference of the pressures, coated less bare" in picture) == is_same
        assert (picture.count("<figure>") == 2) == is_same


def test_bars_of_loads_end_at_a_labelled_ring() -> None:
    parts = answer(cards()["ball-bearing"].case({}), "draft", shown={"N": "kN"})["parts"]
    ring = parts["picture-2"]
    largest = re.findall(r"largest load</th><td>([\d.]+) kN", parts["rows"])[0]
    assert f">largest {float(largest):.3g}<" in ring
    radii = [
        float(radius) for radius in re.findall(r"<circle class='frame'[^>]* r='([\d.]+)'", ring)
    ]
    x, y = map(float, re.findall(r"<circle class='frame' cx='([\d.]+)' cy='([\d.]+)'", ring)[0])
    bars = re.findall(r"<path class='c\d' [^>]* d='M[\d. ]+L([\d.]+) ([\d.]+)'", ring)
    ends = [math.hypot(float(a) - x, float(b) - y) for a, b in bars]
    assert max(ends) == pytest.approx(max(radii), abs=0.2)


def test_stages_share_their_solutions(monkeypatch: pytest.MonkeyPatch) -> None:
    """Coats of one bare body share it, too."""
    solve, solved = nacre.solve, []

    def counted(**keywords: Any) -> nacre.Solution:
        solved.append(keywords["body"])
        return solve(**keywords)

    monkeypatch.setattr(nacre, "solve", counted)
    module._recent.cache_clear()
    coats, answered = [{"body.layers[0].thickness": text} for text in ("2.5", "3.5")], []
    for values in coats:
        case = cards()["contact"].case(values)
        answered += [answer(case, stage)["parts"] for stage in ("full", "stress")]
    assert [len(body.layers) for body in solved] == [1, 0, 1]
    module._recent.cache_clear()
    again = answer(cards()["contact"].case(coats[0]), "stress")["parts"]
    assert again == answered[1]
    # With stresses, the pressure ends at the edge, and not in the next cell.
    assert answered[0]["picture-1"] != answered[1]["picture-1"]


def test_the_new_contact_stands_beside_the_worn_one() -> None:
    case = Case(tomllib.loads(templates.texts()["wear"]), "wear")
    parts = answer(case, "draft")["parts"]
    first, last = map(
        float, re.findall(r"<th>peak pressure</th><td>([\d.]+).*? to ([\d.]+)", parts["rows"])[0]
    )
    assert first > 1.05 * last
    assert highest(parts["picture-1"], ["worn", "new"], first) == pytest.approx(
        [last, first], rel=3e-3
    )


def test_aligned_rings_stand_beside_those_that_are_tilted() -> None:
    case = cards()["bearing"].case({"bearing.solve.tilt.y": "10"})
    picture = answer(case, "draft")["parts"]["picture-1"]
    tilted, aligned = (
        case.arguments()["bearing"].solve(
            **{k: v for k, v in (case.arguments() | own).items() if k != "bearing"}
        )
        for own in (DRAFT, DRAFT | {"tilt": (0.0, 0.0)})
    )
    peaks = [
        solution.lamina_pressures[solution.loads[:, 0].argmax(), 0].max()
        for solution in (tilted, aligned)
    ]
    assert peaks[0] > 1.1 * peaks[1]
    assert highest(picture, ["as it stands", "aligned"], peaks[0]) == pytest.approx(peaks, rel=3e-3)
