"""Files that the page opens: cases, height maps and profiles, and what their readers ask."""

from __future__ import annotations

import base64
import hashlib
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre._tools.markup import text_of
from nacre.app import opened as opened_module
from nacre.app.answer import answer, file_text
from nacre.app.opened import LARGEST, Asks, opened_card
from nacre.case import templates
from support import assert_close

SIDES = (16, 12)
HEIGHTS = np.add.outer((np.arange(16) - 8.0) ** 2, (np.arange(12) - 6.0) ** 2)
MATRIX = "\n".join(" ".join(map(str, row)) for row in HEIGHTS.T).encode()
CROWN = "x (mm);height (µm)\n" + "\n".join(f"{x};{-0.25 * (x - 6) ** 2}" for x in range(13))
CASE = b"""[shape]
kind = "height_map"
path = "PATH"
spacing = 1e-6
unit = "nm"
[body]
substrate = { young = 210e9, poisson = 0.3 }
[solve]
load = 1e-4
"""


def sent(reading: dict[str, str] | None = None, **contents: bytes) -> dict[str, Any]:
    """Return files as the page sends them; a name has "_" for its point."""
    texts = {
        name.replace("_", "."): base64.b64encode(content).decode()
        for name, content in contents.items()
    }
    return {"contents": texts, "reading": reading or {}}


def asked(files: Any) -> Asks:
    """Return what is asked."""
    with pytest.raises(Asks) as caught:
        opened_card(files)
    assert tempfile.gettempdir() not in str(caught.value)
    return caught.value


@pytest.fixture(autouse=True)
def nothing_is_left(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    """Check that no file and no folder is left, whatever is opened."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    yield
    assert not list(tmp_path.glob("nacre-*"))


@pytest.mark.parametrize("name", templates.KINDS)
def test_a_case_is_a_card(name: str) -> None:
    text = templates.texts()[name].encode()
    card = opened_card(sent(mine_toml=text))
    assert (card.name, card.title) == ("own", "mine.toml")
    saved = file_text(card.case({}), card.measured)
    assert f"# mine.toml: SHA-256 {hashlib.sha256(text).hexdigest()}" in saved.splitlines()


@pytest.mark.filterwarnings("ignore")
def test_a_case_and_its_map_are_opened_together() -> None:
    case = CASE.replace(b"PATH", b"map.txt")
    card = opened_card(sent(mine_toml=case, map_txt=MATRIX))
    case_text = answer(card.case({}), "case", measured=card.measured)["case"]
    report = answer(card.case({}), "report", measured=card.measured)["report"]
    for content in (case, MATRIX):
        digest = hashlib.sha256(content).hexdigest()
        assert digest in report
        assert digest in case_text
    assert tomllib.loads(case_text)["shape"]["path"] == "map.txt"


@pytest.mark.parametrize(
    "path", ["/etc/hostname", "../map.txt", "maps/map.txt", "other.txt", "~/map.txt", "."]
)
def test_no_path_of_this_computer_is_read(path: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(opened_module, "own_card", lambda path: pytest.fail(f"{path} was read"))
    error = asked(sent(mine_toml=CASE.replace(b"PATH", path.encode()), map_txt=MATRIX))
    assert "must be opened together with the case" in str(error)


def test_paths_in_sums_of_shapes_are_checked() -> None:
    case = (
        '[shape]\nkind = "sum"\nparts = [{ kind = "sphere", radius = 1.0 }, { kind = "height_map", '
        'path = "/etc/hostname", spacing = 1.0, unit = "m" }]\n[body]\nsubstrate = { young = 1.0, '
        "poisson = 0.3 }\n[solve]\nload = 1.0\n"
    )
    assert "opened together" in str(asked(sent(mine_toml=case.encode())))


@pytest.mark.parametrize(
    "name", ["../x.txt", "a/b.txt", "a\\b.txt", "", ".", "..", "C:x", "x" * 101]
)
def test_names_are_those_of_files_alone(name: str) -> None:
    files = {"contents": {name: ""}, "reading": {}}
    assert "the name of a file" in str(asked(files))


@pytest.mark.parametrize(
    "files",
    [
        *({}, {"contents": 1, "reading": {}}, {"contents": {"a": 1}, "reading": {}}),
        *({"contents": {"a": "?"}, "reading": {}}, {"contents": {"a": ""}}),
    ],
)
def test_other_files_are_a_sentence(files: Any) -> None:
    assert "as the page sends them" in str(asked(files))


def test_large_files_are_a_sentence() -> None:
    assert f"1 to {LARGEST} bytes" in str(asked(sent(a_npy=bytes(LARGEST + 1))))


def test_a_map_asks_until_it_is_certain() -> None:
    reading: dict[str, str] = {}
    for key, value in [("kind", "height_map"), ("spacing", "0.5 µm"), ("unit", "nm")]:
        assert asked(sent(reading, map_txt=MATRIX)).what in ("kind", "spacing", "unit")
        reading[key] = value
    card = opened_card(sent(reading, map_txt=MATRIX))
    surface = card.measured.arguments["shape"]
    assert surface.heights.shape == SIDES
    assert_close(surface.spacing, (0.5e-3, 0.5e-3), rtol=1e-12)
    assert_close(np.ptp(surface.heights), 1e-6 * np.ptp(HEIGHTS), rtol=0.5)  # less a plane
    # The mean pressure is the template's: 1 N on 0.1 mm × 0.1 mm.
    assert_close(card.case({}).data["solve"]["load"], 100 * 8e-3 * 6e-3, rtol=5e-3)


def test_a_channel_is_asked_by_its_candidates() -> None:
    two = b"first\n" + MATRIX + b"\n\nsecond\n" + MATRIX
    reading = {"kind": "height_map", "spacing": "1 µm", "unit": "nm"}
    error = asked(sent(reading, map_txt=two))
    assert error.what == "channel"
    assert opened_card(sent(reading | {"channel": "1"}, map_txt=two)).title == "map.txt"


@pytest.mark.filterwarnings("ignore")
def test_a_profile_is_that_of_a_roller() -> None:
    card = opened_card(sent({"kind": "profile"}, crown_csv=CROWN.encode()))
    shape = card.case({}).data["shape"]
    assert shape["length"] == 12
    assert shape["profile"]["x"] == [x - 6 for x in range(13)]
    assert_close(shape["profile"]["drop"], [0.25e-3 * (x - 6) ** 2 for x in range(13)], rtol=1e-9)
    assert not any("profile" in path for path in card.by_path)
    assert "error" not in answer(card.case({}), "draft", measured=card.measured)


def curve_text(film: nacre.Elastic, body: nacre.HalfSpace, head: str) -> bytes:
    """Return the text of a curve in nm and mN, with noise, an approach and an unloading."""
    tip = nacre.indent.Tip.sphere(8e-6)
    depth = np.linspace(-20e-9, 200e-9, 300)
    made = nacre.indent.Indentation(body, tip).curve(approach=depth[depth > 0])
    force = np.append(np.zeros(np.count_nonzero(depth <= 0)), made.load)
    noise = 0.002 * force.max() * np.random.default_rng(2).standard_normal(force.size)
    depth, force = (np.append(rise, rise[:150:-1]) for rise in (depth, force + noise))
    rows = (f"{1e9 * d:.4f};{1e3 * f:.8f}" for d, f in zip(depth, force, strict=True))
    return "\n".join([*([head] if head else []), *rows]).encode()


GLASS = nacre.Elastic(70e9, 0.22)


@pytest.mark.filterwarnings("ignore")  # of a wrong radius
@pytest.mark.parametrize("kind", ["curve", "film_curve"])
@pytest.mark.parametrize("young", [0.8e9, 40e9])
def test_a_curve_has_its_modulus(kind: str, young: float) -> None:
    film = nacre.Elastic(young, 0.3)
    layered = nacre.HalfSpace(GLASS, [nacre.Layer(film, 0.7e-6)])
    body = layered if kind == "film_curve" else nacre.HalfSpace(film)
    content = curve_text(film, body, "Depth [nm];Load [mN]")
    card = opened_card(sent({"kind": kind}, mine_txt=content))
    assert {"materials.film.young", "indent.load", "adhesion.work"}.isdisjoint(card.by_path)
    values = {"tip.radius": "8", "materials.film.poisson": "0.3", "indent.tolerance": "10"}
    values |= {"body.layers[0].thickness": "700"} if kind == "film_curve" else {}
    reply = answer(card.case(values), "draft", measured=card.measured, shown=card.shown)
    assert reply["next"] is None
    parts = reply["parts"]
    assert parts["peak"][0] == f"modulus of the {'film' if kind == 'film_curve' else 'substrate'}"
    assert all(("film" in field.label) <= (kind == "film_curve") for field in card.fields)
    number, unit = parts["peak"][1].split()
    assert_close(float(number), young / 1e9, rtol=0.02)  # ten times what its noise leaves
    assert unit == "GPa"
    assert "± " in parts["rows"]
    assert parts["verdict"]["level"] == "good"
    assert parts["picture-1"].count("<svg") == parts["picture-2"].count("<svg") == 1
    assert any("for the numbers in the fields" in text for text in parts["warnings"])
    report = answer(card.case(values), "report", measured=card.measured)["report"]
    assert hashlib.sha256(content).hexdigest() in report
    assert "10 % tolerated" in report
    wrong = answer(card.case(values | {"tip.radius": "16"}), "draft", measured=card.measured)
    assert wrong["parts"]["peak"] != parts["peak"]


def test_a_curve_asks_for_columns_and_units() -> None:
    content = curve_text(GLASS, nacre.HalfSpace(GLASS), "")
    reading = {"kind": "curve"}
    for key, value in [("columns", "0, 1"), ("units", "nm; mN")]:
        assert asked(sent(reading | {key: "0"}, c_txt=content)).what in ("columns", "units")
        error = asked(sent(reading, c_txt=content))
        assert error.what == key
        assert "=" not in str(error)  # no keywords of Python
        reading[key] = value
    curve = opened_card(sent(reading, c_txt=content)).measured.arguments["curve"]
    # In the units of the case, up to the largest force.
    assert_close(curve.depth[-1], 0.2, atol=2e-3)
    assert_close(curve.depth[0], -0.02, atol=1e-5)


def test_the_page_has_an_input_for_all_that_is_asked() -> None:
    page = text_of("nacre.app", "static/page.html")
    assert [kind for kind in opened_module.KINDS if f'<option value="{kind}">' not in page] == []
    for key in ("kind", "channel", "unit", "units", "spacing", "columns"):
        assert f'data-reading="{key}"' in page


def test_a_long_curve_is_thinned_and_says_so() -> None:
    rows = "\n".join(f"{d} {d**1.5:.6f}" for d in range(5001))
    card = opened_card(sent({"kind": "curve"}, c_txt=f"depth(nm) force(nN)\n{rows}".encode()))
    assert len(card.measured.arguments["curve"]) == 1667
    assert "of 5001 points one in 3 is fitted" in card.measured.notes


def test_what_readers_warn_of_is_shown() -> None:
    holes = MATRIX.replace(b"100.0", b"nan")
    reading = {"kind": "height_map", "spacing": "1 µm", "unit": "nm"}
    notes = opened_card(sent(reading, map_txt=holes)).measured.notes
    assert len(notes) == 1
    assert "were not measured" in notes[0] or "missing" in notes[0]


@pytest.mark.parametrize("content", [b"", b"\x00\xff" * 99, b"x y\n1 2", b"[[[", b"nan\n"])
@pytest.mark.parametrize("name", ["a.npy", "a.txt", "a.nc", "a.x3p", "a.toml", "a"])
@pytest.mark.parametrize("kind", ["height_map", "profile", "curve"])
def test_any_content_is_a_card_or_a_sentence(content: bytes, name: str, kind: str) -> None:
    files = {"contents": {name: base64.b64encode(content).decode()}, "reading": {"kind": kind}}
    assert str(asked(files))


def test_a_case_of_several_is_not_guessed() -> None:
    one = templates.texts()["contact"].encode()
    assert "one case" in str(asked(sent(a_toml=one, b_toml=one)))
    assert "one case" in str(asked(sent(a_txt=MATRIX, b_txt=MATRIX)))
