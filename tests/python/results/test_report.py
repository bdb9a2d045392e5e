"""A report holds all of a result: inputs, numbers with ±, limits, warnings; it runs nothing."""

from __future__ import annotations

import base64
import dataclasses
import functools
import hashlib
import html
import json
import math
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.image import imread

import nacre
import results
from bodies import BALL, ROD, STEEL, quiet
from nacre import bearing, design, fatigue
from nacre.case import templates
from nacre.contact import stresses
from nacre.results import display, report, svg
from nacre.results.charts import Axis, Bars, Chart, Curve, Map, contact_charts, contact_map
from nacre.results.report import Sections, in_words, input_rows, page, table, write
from nacre.results.rows import remark
from nacre.results.verdict import asked
from nacre.studies.report import Study, save_report
from support import Capture, assert_close, command, written

LARGEST = 300_000
"""Bytes of a page that mail and archives take."""
CHAPTERS = [
    *("Given", "Results", "Pictures", "Parts", "Model and limits", "Warnings", "Case file"),
]
EVIL = "<img src=http://x.org/a onerror=alert(1)>"
GRID = nacre.Grid((32, 32), (4e-4, 4e-4))
ROLLERS: dict[str, Any] = {
    **{"count": 14, "diameter": 10e-3, "length": 9.6e-3},
    **{"pitch_diameter": 65e-3, "clearance": 41e-6},
}


@functools.cache
def ball() -> nacre.Solution:
    """Return a contact with a grid of its own, whose errors are known, and a layer with markup."""
    layer = nacre.Layer(nacre.Elastic(420e9, 0.25), 2e-6, name=EVIL)
    body = nacre.HalfSpace(STEEL, [layer])
    return nacre.solve(nacre.Sphere(5e-3), body, load=20.0, max_cells=4096)


def loop() -> nacre.types.History:
    steps = [{"force": (force, None)} for force in (1.0, 2.0, -2.0)]
    contact = nacre.Contact(STEEL, GRID, STEEL)
    history = contact.slide(BALL, load=10.0, friction=0.3, steps=steps)
    assert isinstance(history, nacre.types.History)
    return history


def loads() -> bearing.BearingSolution:
    return bearing.CylindricalRoller(**ROLLERS).solve(
        force=(4450.0, 0.0, None), tilt=(None, 6e-4), model="iso16281"
    )


def optimum() -> design.Optimum:
    roller = nacre.Roller(radius=5e-3, flat_length=6e-3, crown_radius=1.0)
    return design.optimise(
        {"shape": roller, "body": STEEL},
        {"shape.crown_radius": 1.0},
        objective=("pressure_norm", 16),
        cases=[{"load": 1e3}],
        grid=nacre.Grid((48, 24), (13e-3, 2.4e-4)),
        max_solves=6,
    )


def volume() -> bearing.StressVolume:
    line = nacre.Contact(STEEL, nacre.Grid.line(64, 2e-4), STEEL).solve(ROD, load=1e4)
    return bearing.stress_volume(line, bearing.LundbergPalmgren())


KINDS: dict[str, Callable[[], Any]] = {
    **{
        kind: functools.partial(results.solved, kind)
        for kind in (
            *results.NORMAL,
            *("slid", "line slid", "rolled", "apart", "not converged in friction"),
            *results.WEAR,
            *results.INDENT,
            *results.FITS,
            *results.LISTED,
        )
    },
    "ball": ball,
    "history": loop,
    "summary": lambda: ball().stress_summary(yield_stress={"substrate": 2e9}),
    "bearing": loads,
    "balls": lambda: bearing.DeepGrooveBall(
        count=7, diameter=11.5e-3, pitch_diameter=43.5e-3, clearance=1e-5
    ).solve(force=(20.0, 0.0, None), cells=(32, 32)),
    "two rows": lambda: bearing.SphericalRoller(
        count=15,
        diameter=10e-3,
        length=9e-3,
        pitch_diameter=60e-3,
        contact_angle=0.2,
        profile_radius=32e-3,
    ).solve(force=(1e4, 0.0, 0.0), model="iso16281"),
    "life": lambda: loads().life(),
    "volume": volume,
    "optimum": optimum,
}


class Page(HTMLParser):
    """Tags with their attributes, and the text of a page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.source = path.read_text(encoding="utf-8")
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.pieces: list[str] = []
        self.feed(self.source)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.pieces.append(data)

    @property
    def text(self) -> str:
        return "\n".join(self.pieces)


def check_safe(read: Page) -> None:
    """Check that a page runs nothing and asks for nothing."""
    names = {tag for tag, _ in read.tags}
    assert names.isdisjoint({"script", "img", "link", "iframe", "object", "form", "a", "base"})
    for tag, attributes in read.tags:
        for name, value in attributes.items():
            assert not name.startswith("on"), (tag, name)
            if name in ("src", "href", "action", "data") or name.endswith(":href"):
                assert str(value).startswith("data:image/png;base64,"), (tag, name)
            assert "url(" not in str(value)
    policies = [a["content"] for tag, a in read.tags if tag == "meta" and "http-equiv" in a]
    assert policies == ["default-src 'none'; style-src 'unsafe-inline'; img-src data:"]
    assert "@import" not in read.source
    assert "url(" not in read.source
    for figure in re.findall(r"<figure>.*?</figure>", read.source, re.DOTALL):
        ElementTree.fromstring(figure)


@pytest.mark.parametrize("kind", KINDS)
def test_every_result_saves_a_page_that_runs_nothing(kind: str, tmp_path: Path) -> None:
    result = quiet(KINDS[kind])
    read = Page(quiet(result.save, tmp_path / "case 7.html"))
    assert [path.name for path in tmp_path.iterdir()] == ["case 7.html"]
    assert len(read.source.encode()) <= LARGEST
    check_safe(read)
    assert f"nacre {nacre.__version__}" in read.text
    assert "case 7" in read.text
    assert "signature" in read.text
    chapters = [name for name in re.findall(r"<h2>(.*?)</h2>", read.source)]
    assert chapters == [name for name in CHAPTERS if name in chapters]
    assert {"Warnings"} <= {*chapters}
    own = (design.Optimum, nacre.types.History, nacre.types.WearHistory, nacre.indent.Fit)
    texts = result.warnings if isinstance(result, own) else result.report.warnings
    for warning in texts:
        assert in_words(warning) in read.text
    # The stress in a picture may be uncertain where nothing else is.
    doubts = [*texts, *re.findall("is uncertain|are uncertain", read.text)]
    assert ("no warnings" in read.text) == (not doubts)
    assert not re.search(r"\bnan\b|>inf\b|\bNone\b|0e\+00", read.source)


FORBIDDEN = {
    "path": r"\w\[\d+\]|\w\.(young|poisson|thickness|radius|load)\b",
    "repr": r"\w\(\w+=|\bobject at|\{['\d]|\barray\(",
    "radian": r"\d rad\b|\[rad\]|rad/s",
}
METRES = r"\d [pnµmk]?(m|N m|N/m|J/m)(?![\w/²³])|\[[pnµmk]?(m|N m|N/m)\]"
"""A metre beside a number or in a heading: a prefix makes µm and nm of it, and mm."""
UNSCALED = "distance|sliding|[Tt]hrough|worn|springs|contact point|esistance"
"""Rows in metres in all units, and of numbers that only SI has; thermal ones have no prefix."""
SMALL = r"\d[pnµ]?e-(1[3-9]|[2-9]\d)"


def check_words(source: str, units: str) -> None:
    """Check that a page has no path, no repr, no radian, no rounding and no metre among mm."""
    shown = re.sub(r"<svg.*?</svg>|<style>.*?</style>", "", source, flags=re.DOTALL)
    rows = re.split(r"</(?:tr|p|h3|figcaption)>", shown.partition("<h2>Case file")[0])
    for row in (html.unescape(re.sub("<[^>]+>", "|", row)) for row in rows):
        for name, pattern in FORBIDDEN.items():
            assert not re.search(pattern, row), (name, row)
        # Rates of wear, springs and points of contact within their noise are that small in SI.
        is_small = re.search("rate|springs|contact point", row)
        assert is_small or not re.search(SMALL, row), row
        # Distances that bodies slide are in metres and kilometres in all units.
        if units != "SI" and not re.search(UNSCALED, row):
            found = [m[0] for m in re.finditer(METRES, row)]
            assert not [text for text in found if not re.search(r"\b[pnµm]m\b", text)], row


@pytest.mark.parametrize("units", ["SI", "N-mm-MPa"])
@pytest.mark.parametrize("kind", KINDS)
def test_pages_have_words_and_their_units(kind: str, units: str, tmp_path: Path) -> None:
    result = quiet(KINDS[kind])
    with nacre.display_units(units), display.shown_in(units):
        source = quiet(result.save, tmp_path / "a.html").read_text(encoding="utf-8")
    check_words(source, units)


CHEAP = ["contact", "line", "indentation", "cone", "pair", "ball-bearing", "wear", "roll", "sweep"]
"""Templates that are solved in a second."""


@pytest.mark.parametrize("name", CHEAP)
def test_reports_of_cases_have_words_their_units_and_a_head(name: str, tmp_path: Path) -> None:
    text = templates.texts()[name] + '\n[report]\nproject = "Mill <3>"\nchecked_by = "Eve"\n'
    run = "sweep" if name == "sweep" else "solve"
    assert command(run, written(tmp_path, text), "--save", tmp_path / "a.html") == 0
    source = (tmp_path / "a.html").read_text(encoding="utf-8")
    check_words(source, "N-mm-MPa")
    assert "<td>project</td><td>Mill &lt;3&gt;</td>" in source
    assert "<td>checked by Eve</td>" in source


def test_the_name_of_a_case_is_on_every_page(tmp_path: Path) -> None:
    source = ball().save(tmp_path / 'a";}<b.html').read_text(encoding="utf-8")
    (running,) = re.findall(r'@top-left{content:"(.*?)";', source)
    assert re.sub(r"\\([0-9a-f]+) ", lambda code: chr(int(code[1], 16)), running) == 'a";}<b'
    assert 'counter(page) " of " counter(pages)' in source


def test_a_pair_says_its_own_life_first_and_what_is_given(tmp_path: Path) -> None:
    ball_bearing = bearing.AngularContactBall(
        count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
    )
    pair = bearing.Pair(
        ball_bearing, ball_bearing, arrangement="O", distance=16e-3, preload_force=200.0
    )
    solution = pair.solve(force=(100.0, 0.0, 300.0), model="iso16281")
    life = solution.life()
    source = dataclasses.replace(solution, _life=life).save(tmp_path / "a.html").read_text("utf-8")
    given, results_of_pair = source.split("<h2>Results</h2>")
    assert "<td>force</td><td>(100 N, 0 N, 300 N)</td>" in given
    assert "<td>second</td><td>as the first</td>" in given
    first, *_ = re.findall("<td>(.*?)</td>", results_of_pair)
    assert first == life._rows()[0].label


def test_creepages_and_loads_that_are_given_are_inputs() -> None:
    rolled = results.solved("rolled")
    labels = {row.label for row in rolled._inputs()}
    assert labels >= {"creepage", "direction", "friction"}
    inputs = {row.label: row.text for row in loads()._inputs()}
    assert inputs["force along x"] == "4.45 kN"
    assert inputs["tilt along y"] == f"{6e-4 * 60 * math.degrees(1.0):.6g} minutes of arc"


def test_points_of_a_fit_are_on_top_of_its_line() -> None:
    looks = [curve.look for curve in results.solved("fit")._charts()[0].curves]
    assert looks == ["line", "points"] * (len(looks) // 2)


def test_cases_of_a_study_say_whether_their_cells_resolve_the_stress() -> None:
    thin = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(420e9, 0.2), 2e-6)])
    case = {"shape": BALL, "body": thin, "grid": nacre.Grid((16, 16), (4e-4, 4e-4))}
    study = quiet(nacre.sweep, case, {"load": [5.0, 10.0]}, outputs=["coating_tension"])
    (cases,) = Study(study)._tables()
    doubts = ["uncertain" in text for text in study["warnings"].values.tolist()]
    assert any(doubts)
    assert [row[-1] for row in cases.rows] == ["no" if doubt else "yes" for doubt in doubts]
    assert cases.head[-1] == "resolved"


LIMITS: dict[str, Any] = {
    "yield_stress": {"substrate": 1.2e9},
    "strength": {0: 0.9e9},
    "bond_strength": (4e8, 4e8),
}


def test_cases_of_a_study_have_the_verdict_of_their_own_summary() -> None:
    def coated(load: float) -> dict[str, Any]:
        body = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(420e9, 0.2), 5e-6)])
        return {"shape": BALL, "body": body, "load": load, "max_cells": 4096}

    loads, outputs = [2.0, 20.0, 200.0], ["von_mises", "interface_shear"]
    study = quiet(nacre.sweep, coated, {"load": [*loads, -1.0]}, outputs=outputs, stress=LIMITS)
    levels = [quiet(nacre.solve(**coated(load)).verdict, **LIMITS).level for load in loads]
    assert len(set(levels)) > 1
    assert study["verdict"].values.tolist() == [*levels, ""]
    (cases, _) = Study(study)._tables()
    column = cases.head.index("verdict")
    assert [row[column] for row in cases.rows] == [*levels, ""]
    rows = {row.key or row.label: row.text for row in Study(study)._report_rows()}
    counts = dict(text.split()[::-1] for text in rows["verdicts"].split(", "))
    assert counts == {level: str(levels.count(level)) for level in levels}
    assert "± of interface shear" in cases.head
    without = quiet(nacre.sweep, coated, {"load": loads[:1]}, outputs=outputs)
    assert "verdict" not in without
    chart = design.coating_chart(
        *(BALL, STEEL),
        thickness=[5e-6],
        young=[420e9],
        poisson=0.2,
        refine=None,
        load=loads[1],
        max_cells=4096,
        **LIMITS,
    )
    assert chart["verdict"].values.tolist() == [[levels[1]]]


def test_bearings_of_a_study_have_their_verdict() -> None:
    ball = bearing.AngularContactBall(
        count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
    )
    case = {"bearing": ball, "model": "iso16281", "static_safety": 1.5}
    forces = [(1e3, 0.0, 2e3), (3e3, 0.0, 9e3)]
    study = quiet(nacre.sweep, case, {"force": forces}, outputs=["peak_pressure"])
    assert study["verdict"].values.tolist() == [
        ball.solve(force=force, model="iso16281").verdict(static_safety=1.5).level
        for force in forces
    ]


def test_curves_of_a_study_have_their_errors() -> None:
    case = {"shape": nacre.Sphere(5e-3), "body": STEEL, "max_cells": 4096}
    study = quiet(nacre.sweep, case, {"load": [5.0, 10.0]}, outputs=["peak_pressure"])
    (chart,) = Study(study)._charts_of("peak_pressure")
    line, low, high = chart.curves
    assert (line.look, low.look, high.look) == ("line", "thin", "thin")
    error = study["peak_pressure_discretisation"].values
    assert_close(high.y - line.y, error, rtol=1e-6)
    assert_close(line.y - low.y, error, rtol=1e-6)


def test_numbers_are_those_that_are_printed_with_errors(tmp_path: Path) -> None:
    read = Page(ball().save(tmp_path / "ball.html"))
    for row in ball()._rows():
        if row.key.split(".")[0] not in ("motion", "body", "counterbody", "tilt"):
            assert f"<td>{row.label}</td><td>{row.text}</td>" in read.source
    assert re.search(r"peak pressure</td><td>[\d.]+ GPa ± [\d.]+ %", read.source)
    assert "<td>shape, radius</td><td>5 mm</td>" in read.source
    assert "<td>body, layer 1, Young&#x27;s modulus</td><td>420 GPa</td>" in read.source
    assert "<td>load</td><td>20 N</td>" in read.source
    assert "inset: the first three thicknesses" in read.text


def test_pages_have_the_units_that_are_set(tmp_path: Path) -> None:
    steel = nacre.Elastic(young=210e3, poisson=0.3)
    grid = nacre.Grid((32, 32), (0.4, 0.4))
    with nacre.display_units("N-mm-MPa"):
        solution = nacre.solve(nacre.Sphere(5.0), steel, load=10.0, grid=grid)
        source = solution.save(tmp_path / "a.html").read_text(encoding="utf-8")
    assert "<td>shape, radius</td><td>5 mm</td>" in source
    assert ">pressure [MPa]<" in source
    assert "<td>body, substrate, Young&#x27;s modulus</td><td>210 GPa</td>" in source
    assert re.search(r"<td>peak pressure</td><td>1\d\d\d MPa", source)


def test_names_with_markup_are_text(tmp_path: Path) -> None:
    read = Page(ball().save(tmp_path / "a.html"))
    check_safe(read)
    assert EVIL in read.text
    again = Page(quiet(ball().stress_summary).save(tmp_path / "b.html"))
    check_safe(again)
    assert EVIL in again.text


def test_pages_are_the_same_but_for_the_date(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    pages = [ball().save(tmp_path / place) for place in ("a.html", "b/a.html")]
    first, second = (re.sub(r"\d{4}-\d\d-\d\d", "", p.read_text("utf-8")) for p in pages)
    assert first == second


class Stub:
    """A result with a verdict."""

    def __init__(self, known: Any = None, *, fails: bool = False) -> None:
        self.known, self.fails = known, fails

    @asked
    def verdict(self) -> Any:
        return self.known

    def _sections(self) -> Sections:
        if self.fails:
            raise RuntimeError("no sections")
        return Sections("a stub", [remark("load", "1 N")])


class Words(NamedTuple):
    """A verdict."""

    level: str
    words: str
    lines: tuple[str, ...] = ()


class Open(Stub):
    """A result whose verdict has to be computed."""

    def verdict(self) -> Any:
        if self.fails:
            raise ValueError("stresses are not known")
        return self.known


def test_pages_begin_with_the_verdict(tmp_path: Path) -> None:
    path, bad = tmp_path / "a.html", Words("bad", "Fails, 0.5 times: <coat>.", ("Bare: 3 MPa.",))
    write(path, [Stub(bad)])
    read = Page(path)
    (attributes,) = [a for _, a in read.tags if "verdict" in str(a.get("class"))]
    assert attributes == {"class": "verdict bad"}
    assert "bad: Fails, 0.5 times: <coat>." in read.text
    assert "Bare: 3 MPa." in read.text
    assert read.source.index("Fails") < read.source.index("<h2>")


def test_verdicts_are_computed_only_where_there_is_no_other(tmp_path: Path) -> None:
    good: Any = Words("good", "Holds.")
    other: Any = Words("fair", "Cannot tell.")
    assert [*report.verdicts([Open(other)])] == [other]
    assert [*report.verdicts([Open(other), Stub(good)])] == [good]
    assert [*report.verdicts([Open(fails=True)])] == []
    assert [*report.verdicts([object()])] == []  # type: ignore[list-item]


def test_an_error_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "a.html"
    path.write_text("before", encoding="utf-8")
    solution = ball()
    broken = functools.partial(nacre.results.files.save, path, report.writer(Stub(fails=True)))
    with pytest.raises(RuntimeError, match="no sections"):
        broken()
    assert path.read_text(encoding="utf-8") == "before"
    assert [one.name for one in tmp_path.iterdir()] == ["a.html"]
    with pytest.raises(FileNotFoundError):
        solution.save(tmp_path / "nowhere" / "a.html")


CASE = """units = "N-mm-MPa"  # <script>alert(1)</script>
[materials]
steel = { young = 210e3, poisson = 0.3, yield_stress = 1500 }
dlc = { young = 420e3, poisson = 0.3 }
[shape]
kind = "sphere"
radius = 5
[body]
substrate = "steel"
layers = [{ material = "dlc", thickness = 4e-3 }]
[solve]
load = 10
max_cells = 4096
[stress]
friction = 0.1
direction = [1, 0]
"""


def test_the_case_in_a_report_gives_the_same_numbers(tmp_path: Path, capsys: Capture) -> None:
    assert command("solve", written(tmp_path, CASE), "--save", tmp_path / "a.html", "--json") == 0
    numbers = json.loads(capsys.readouterr().out)
    read = Page(tmp_path / "a.html")
    check_safe(read)
    assert CASE in read.text
    assert "<td>stress, yield stress</td><td>–, 1500 MPa</td>" in read.source
    assert f"<td>peak pressure</td><td>{numbers['peak_pressure']:.4g} MPa" in read.source
    (again := tmp_path / "again").mkdir()
    position = read.pieces.index(CASE)
    assert command("solve", written(again, read.pieces[position]), "--json") == 0
    repeated = json.loads(capsys.readouterr().out)
    assert min(numbers.pop("seconds"), repeated.pop("seconds")) > 0
    assert repeated == numbers


BEARING = """units = "N-mm-MPa"
[bearing]
kind = "deep_groove_ball"
count = 7
diameter = 11.5
pitch_diameter = 43.5
[bearing.solve]
force = { x = 1000, y = 0 }
model = "iso16281"
[bearing.life]
"""
INDENT = """
[materials]
glass = { young = 70e9, poisson = 0.22 }
film = { young = 3e9, poisson = 0.4 }
[tip]
kind = "sphere"
radius = 5e-6
[body]
substrate = "glass"
layers = [{ material = "film", thickness = 1e-6 }]
[indent]
load = [1e-4, 1e-3]
"""
SWEEP = """
[materials]
steel = { young = 210e9, poisson = 0.3 }
[shape]
kind = "sphere"
radius = 5e-3
[body]
substrate = "steel"
[solve]
load = 10
max_cells = 4096
[sweep]
parameters."solve.load" = [5, 10, 20]
"""


@pytest.mark.parametrize(
    ("name", "case", "texts"),
    [
        ("solve", BEARING, ("bearing, diameter</td><td>11.5 mm<", "life L10r", "1791 MPa")),
        ("indent", INDENT, ("tip, radius</td><td>5 µm<", "<td>load</td><td>100 µN to 1 mN")),
        ("sweep", SWEEP, ("3, 0 failed", "solve, load</td><td>5 N, 10 N, 20 N")),
    ],
)
def test_commands_save_reports(
    name: str, case: str, texts: tuple[str, ...], tmp_path: Path
) -> None:
    assert command(name, written(tmp_path, case), "--save", tmp_path / "a.html") == 0
    read = Page(tmp_path / "a.html")
    check_safe(read)
    assert case in read.text
    for text in texts:
        assert text in read.source


def test_measured_files_stand_by_their_hash(tmp_path: Path) -> None:
    heights = 1e-7 * np.random.default_rng(1).random((16, 12))
    np.save(tmp_path / "surface.npy", heights)
    case = CASE.replace('"N-mm-MPa"', '"SI"').replace("e3,", "e9,").replace("1500", "1.5e9")
    case = case.replace("load = 10\nmax_cells = 4096", "load = 0.01")
    case = (
        case.replace("4e-3", "4e-6")
        .partition("[stress]")[0]
        .replace(
            'kind = "sphere"\nradius = 5',
            'kind = "height_map"\npath = "surface.npy"\nspacing = 1e-6\nunit = "m"',
        )
    )
    assert command("solve", written(tmp_path, case), "--save", tmp_path / "a.html") == 0
    digest = hashlib.sha256((tmp_path / "surface.npy").read_bytes()).hexdigest()
    read = Page(tmp_path / "a.html")
    assert f"surface.npy</td><td>SHA-256 {digest}" in read.source
    array = np.arange(6.0).reshape(2, 3)
    sha = hashlib.sha256(array.tobytes()).hexdigest()
    assert input_rows({"map": array}) == [remark("map", f"2 × 3 numbers, SHA-256 {sha}")]


def test_reports_of_studies_name_what_failed(tmp_path: Path) -> None:
    case = {"shape": nacre.Sphere(5e-3), "body": STEEL, "grid": GRID}
    study = quiet(nacre.sweep, case, {"load": [-1.0, 5.0, 10.0]})
    read = Page(save_report(study, tmp_path / "study.html"))
    check_safe(read)
    assert "3, 1 failed" in read.text
    assert "Cases that failed" in read.text
    assert "load must be" in read.text


def test_tables_have_one_unit_a_column_and_zeros() -> None:
    rows: list[list[Any]] = [["x [m]", "force x [N]", "force y [N]", "names"]]
    rows.append([1e-3, 10.0, 1e-9, "a"])
    members = table("Parts", [*rows, [2.5e-3, 2e3, math.nan, "b"]])
    assert members.head == ["x [mm]", "force x [kN]", "force y [N]", "names"]
    assert members.rows == [("1", "0.01", "0", "a"), ("2.5", "2", "", "b")]


def test_long_tables_are_cut_and_wide_ones_continued() -> None:
    rows: list[list[Any]] = [[f"c{k}" for k in range(25)], *([[1.0] * 25] * 500)]
    members = table("Parts", rows)
    assert members.notes == ["and 200 more rows"]
    source = page("a", "", [Sections("a", tables=[members])], [])
    assert [source.count(f"<th>c{k}</th>") for k in (0, 1, 10, 24)] == [3, 1, 1, 1]


def drawn(text: str) -> ElementTree.Element:
    return ElementTree.fromstring(text)


PIXEL = 0.06
"""Coordinates are written to a tenth of a pixel; 1 % of a picture is some pixels."""


def test_curves_are_where_their_numbers_are() -> None:
    axes = Axis("x", "m", (0.0, 4e-3)), Axis("p", "Pa", (0.0, 2e9))
    picture = drawn(
        svg.drawing(
            Chart("", [Curve(np.array([1e-3, 3e-3]), np.array([5e8, 2e9]))], axes, marks=[2e-3])
        )
    )
    (curve,) = picture.iter("polyline")
    points = [tuple(map(float, pair.split(","))) for pair in curve.get("points", "").split()]
    width, height = svg.WIDTH - svg.LEFT - svg.RIGHT, svg.HEIGHT - svg.TOP - svg.BOTTOM
    due = [(svg.LEFT + width / 4, svg.TOP + 0.75 * height), (svg.LEFT + 0.75 * width, svg.TOP)]
    assert_close(points, due, atol=PIXEL)
    (mark,) = [one for one in picture.iter("path") if one.get("class") == "mark"]
    assert mark.get("d", "").startswith(f"M{svg.LEFT + width / 2:.1f} ")
    labels = [one for one in picture.iter("text") if one.get("class") == "middle"]
    texts = {one.text: float(one.get("x", "")) for one in labels}
    assert texts["1"] == pytest.approx(due[0][0], abs=PIXEL)
    assert {"x [mm]", "p [GPa]"} <= texts.keys()


def test_ticks_are_where_their_numbers_are() -> None:
    chart = Chart(
        "", [Curve(np.array([0.0, 7.3]), np.array([-40.0, 90.0]))], (Axis("x"), Axis("y"))
    )
    picture = drawn(svg.drawing(chart))
    (curve,) = picture.iter("polyline")
    (_, low), (_, high) = (map(float, pair.split(",")) for pair in curve.get("points", "").split())
    ticks = [t for t in picture.iter("text") if t.get("class") == "end"]
    assert len(ticks) >= 3
    for tick in ticks:
        share = (float(tick.text or "") + 40) / 130
        # The baseline of the text is 4 pixels below the tick.
        assert float(tick.get("y", "")) - 4 == pytest.approx(low + share * (high - low), abs=0.2)


def test_ticks_lie_in_the_picture() -> None:
    for low, high in ((-0.3, 0.92), (1.7e-9, 4.1e-9), (0.0, 600.0), (1.0, 1.0)):
        ticks = svg.round_numbers(low, high, 6)
        assert len(ticks) >= (2 if high > low else 1)
        room = 1e-8 * (high - low)
        assert low - room <= ticks.min() <= ticks.max() <= high + room


def test_the_stress_over_depth_is_that_of_the_solution() -> None:
    (chart,) = quiet(lambda: [*stresses.depth_charts(ball())])
    (curve,) = chart.curves
    assert [axis.unit for axis in chart.axes] == ["m", "Pa"]
    assert (chart.marks, chart.inset) == ([2e-6], (0.0, 6e-6))
    x, y = ball().peak_position
    z, count = curve.x, np.count_nonzero(curve.x <= 2e-6)
    assert np.all(np.diff(z) >= 0)
    assert np.count_nonzero(z == 2e-6) == 2  # the coat first, then the steel below it
    for part, side in ((slice(0, count - 1), "above"), (slice(count - 1, None), "below")):
        due = quiet(ball().stress, z[part], x=x, y=y, side=side).von_mises
        # Components are cubic parabolas between the depths: 0.03 % of balls, lines and rollers.
        assert_close(curve.y[part], due, rtol=1e-3)
    width = np.diff(ball().contact_extent[1])[0]
    assert z[-1] == pytest.approx(1.25 * width)


@pytest.mark.parametrize("axis", [0, 1])
def test_sections_go_through_the_largest_pressure(axis: int) -> None:
    """They hold the contact, and a margin of a tenth of it and a cell."""
    solution = results.solved("both coated, tilted")
    chart = contact_charts(solution)[axis]
    assert isinstance(chart, Chart)
    (curve,) = chart.curves
    places = (solution.x, solution.y)[axis]
    row = np.abs((solution.y, solution.x)[axis] - solution.peak_position[1 - axis]).argmin()
    whole = np.take(solution.pressure, row, axis=1 - axis)
    first, last = np.flatnonzero(solution.pressure.any(axis=1 - axis))[[0, -1]]
    margin = 1 + (last - first) // 10
    kept = slice(max(first - margin, 0), last + margin + 1)
    np.testing.assert_array_equal(curve.x, places[kept])
    np.testing.assert_array_equal(curve.y, whole[kept])
    assert max(curve.y) == solution.peak_pressure
    assert "xy"[axis] in chart.caption


def test_maps_have_x_to_the_right_and_y_upwards(tmp_path: Path) -> None:
    solution = results.solved("both coated, tilted")
    values = np.where(np.arange(31) > 14, 1.0, 0.5) * np.ones((40, 1))
    values[:20] *= 0.25
    axis = Axis("p", "Pa", (0.0, 1.0))
    picture = drawn(svg.drawing(contact_map(solution, values, axis, "a map")))
    image = next(picture.iter("image")).get("href", "").partition("base64,")[2]
    (tmp_path / "a.png").write_bytes(base64.b64decode(image))
    pixels = imread(tmp_path / "a.png")[..., :3]
    cells = [np.flatnonzero(solution.pressure.any(axis=k))[[0, -1]] for k in (1, 0)]
    (left, right), (low, high) = [(a - 1 - (b - a) // 10, b + 2 + (b - a) // 10) for a, b in cells]
    loaded = np.where(solution.pressure > 0, values, np.nan)[left:right, low:high]
    due = colormaps["viridis"](np.nan_to_num(loaded.T[::-1]))[..., :3]
    due[np.isnan(loaded.T[::-1])] = 1.0
    assert_close(pixels, due, atol=0.02)
    assert len(np.unique(loaded[np.isfinite(loaded)])) == 4  # all quarters are in it
    labels = {text.text: text for text in picture.iter("text")}
    assert {"x [µm]", "y [µm]", "p [Pa]"} <= labels.keys()


@pytest.mark.parametrize("axis", [0, 1])
def test_a_loop_is_along_the_axis_of_the_force(axis: int) -> None:
    pair = [(0.1, force)[:: 1 if axis else -1] for force in (1.0, -1.0)]
    history = results.CONTACT.slide(
        BALL, load=10.0, friction=0.3, steps=[{"force": f} for f in pair]
    )
    chart = history._charts()[0]
    assert isinstance(chart, Chart)
    (curve,) = chart.curves
    shifts = [step.shift[axis] for step in history if step.shift is not None]
    np.testing.assert_array_equal(curve.x, shifts)
    np.testing.assert_array_equal(curve.y, [step.force[axis] for step in history])
    assert chart.axes[0].name == f"shift along {'xy'[axis]}"


def test_bars_and_curves_are_those_of_the_elements() -> None:
    solution = quiet(KINDS["two rows"])
    _, angles, heights, _, labels = quiet(solution._charts)[0]
    assert labels == [f"row {row}, {ring} ring" for row in (1, 2) for ring in ("inner", "outer")]
    for element, ring in ((0, 0), (3, 1), (15, 0), (29, 1)):
        row, place = divmod(element, 15)
        assert heights[place, 2 * row + ring] == solution.loads[element, ring]
        assert angles[place, 2 * row + ring] == solution.angles[element]
    rollers = loads()
    _, chart = rollers._charts()
    assert isinstance(chart, Chart)
    inner, outer = chart.curves
    assert max(inner.y) == rollers.peak_pressures[:, 0].max()
    assert max(outer.y) == pytest.approx(rollers.lamina_pressures[0, 1].max())  # type: ignore[index]
    assert inner.x[0] == pytest.approx(-9.6e-3 / 2 * 39 / 40)  # the middle of the first of 40


def test_pictures_of_studies_have_units_of_their_own() -> None:
    study = design.load_curve(BALL, STEEL, load=[10.0, 20.0])
    with nacre.display_units("N-mm-MPa"):
        (chart,) = Study(study)._charts_of("peak_pressure")
        texts = [*drawn(svg.drawing(chart)).iter("text")]
    assert "peak pressure [MPa]" in {text.text for text in texts}
    low, high = study.peak_pressure.values / 1e6
    ticks = [float(text.text or "") for text in texts if text.get("class") == "end"]
    assert len(ticks) >= 3
    assert 0.9 * low < min(ticks) < max(ticks) < 1.1 * high


def test_long_curves_keep_their_peaks() -> None:
    x = np.linspace(0.0, 1.0, 10_001)
    y = np.exp(-(((x - 0.123_4) / 1e-4) ** 2))
    axes = Axis("x"), Axis("y", "", (0.0, 1.0))
    (curve,) = drawn(svg.drawing(Chart("", [Curve(x, y)], axes))).iter("polyline")
    points = [tuple(map(float, pair.split(","))) for pair in curve.get("points", "").split()]
    assert len(points) <= svg.MOST_POINTS
    assert min(y for _, y in points) == pytest.approx(svg.TOP, abs=PIXEL)


def test_an_inset_is_a_part_of_the_curve() -> None:
    curve = Curve(np.array([0.0, 1.0, 2.0, 10.0]), np.array([0.0, 3.0, 4.0, 1.0]), "a")
    picture = drawn(svg.drawing(Chart("", [curve], (Axis("x"), Axis("y")), (), (0.0, 2.0))))
    inner = picture.find("svg")
    assert inner is not None
    whole, part = picture.iter("polyline")
    assert len(part.get("points", "").split()) == 3
    # The inset lies above the curve.
    highest = min(float(p.split(",")[1]) for p in whole.get("points", "").split())
    assert float(inner.get("y", "")) + float(inner.get("height", "")) < highest


def test_bars_point_where_the_elements_are() -> None:
    loads = np.array([[400.0], [200.0], [0.0]])
    angles = np.array([[0.0], [math.pi / 2], [math.pi]])
    picture = drawn(svg.drawing(Bars("", angles, loads, Axis("load", "N"))))
    ends = [
        [float(n) for n in re.findall(r"-?[\d.]+", one.get("d", ""))]
        for one in picture.iter("path")
        if one.get("class") == "c0"
    ]
    x, y = svg.WIDTH / 2, svg.TOP + svg.LINE + svg.OUTER
    half = (svg.INNER + svg.OUTER) / 2
    due = [(x + svg.INNER, y, x + svg.OUTER, y), (x, y - svg.INNER, x, y - half)]
    assert_close(ends, due, atol=PIXEL)


def test_maps_are_images_of_their_cells(tmp_path: Path) -> None:
    shares = np.array([[0.0, 0.25, math.nan], [1.0, 0.5, 0.75]])
    (tmp_path / "a.png").write_bytes(svg.png(shares))
    pixels = imread(tmp_path / "a.png")[..., :3]
    assert pixels.shape == (3, 2, 3)  # y upwards, so that its last row is first
    due = colormaps["viridis"](np.nan_to_num(shares.T[::-1]))[..., :3]
    due[0, 0] = 1.0
    # Ten colours stand for 256: their interpolation is off by 0.02 at most.
    assert_close(pixels, due, atol=0.02)
    ends = Axis("x", "m", (0.0, 2e-3)), Axis("y", "m", (0.0, 3e-3)), Axis("p", "Pa")
    (cells, _) = drawn(svg.drawing(Map("", 1e9 * shares, ends))).iter("image")
    size = [float(cells.get(name, "")) for name in ("width", "height")]
    assert size[1] / size[0] == pytest.approx(1.5, rel=1e-3)


def test_labels_with_markup_are_text() -> None:
    curve = Curve(np.array([0.0, 1.0]), np.array([0.0, 1.0]), EVIL)
    picture = drawn(svg.drawing(Chart("", [curve], (Axis(EVIL), Axis("y")))))
    assert [t.text for t in picture.iter("text")].count(EVIL) == 2


def test_fits_report_to_html_or_as_a_picture(tmp_path: Path) -> None:
    fit = results.solved("fit")
    fit.save(tmp_path / "a.html")
    read = Page(tmp_path / "a.html")
    check_safe(read)
    digest = hashlib.sha256(fit.curves[0].force.tobytes()).hexdigest()
    assert f"curve 1, force</td><td>12 numbers, SHA-256 {digest}" in read.source
    assert "± " in read.text
    fit.save(tmp_path / "a.pdf")
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")


def test_shakedown_and_fatigue_stand_beside_the_contact(tmp_path: Path) -> None:
    line = nacre.solve(nacre.Cylinder(5e-3), STEEL, load=1e5, grid=nacre.Grid.line(96, 3e-4))
    write(tmp_path / "a.html", [line, quiet(fatigue.assess, line, shear_yield=6e8)])
    read = Page(tmp_path / "a.html")
    assert "<h3>shakedown and fatigue</h3>" in read.source
    assert "safety factor" in read.text
