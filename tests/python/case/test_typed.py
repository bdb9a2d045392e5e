"""Numbers of case files as texts with units, and mistakes that people type."""

from __future__ import annotations

import json
import math
import re
import tomllib
import warnings
from pathlib import Path
from typing import Any

import pytest

import nacre
import nacre._core as core
from nacre._tools.units import System, number_in
from nacre.app.cards import cards
from nacre.app.fields import FieldError, keys_of
from nacre.case import Case, CaseError, templates, toml
from nacre.case.typed import si_unit, steps_of
from support import Capture, command

OTHERS = {
    "m": ("mm", "in"),
    "N": ("kN", "lbf"),
    "Pa": ("GPa", "psi"),
    "N m": ("Nmm", "kN·m"),
    "N/m": ("N/mm", "lbf/in"),
    "rad": ("°", "mrad"),
    "rad/s": ("rpm", "1/min"),
    "m²/N": ("mm³/(N m)", "µm²/mN"),
    "m/s": ("mm/s", "m/min"),
    "Pa s": ("mPa s", "cP"),
    "1/Pa": ("1/GPa", "mm²/N"),
    "h": ("min", "s"),
    "": ("%", "‰"),
}
"""Units in which the numbers of templates are typed, by SI unit."""
SIZES = {
    **{"mm": 1e-3, "in": 0.0254, "kN": 1e3, "lbf": 4.4482216152605, "GPa": 1e9, "Nmm": 1e-3},
    **{"psi": 4.4482216152605 / 0.0254**2, "kN·m": 1e3, "N/mm": 1e3, "°": math.pi / 180},
    **{
        "lbf/in": 4.4482216152605 / 0.0254,
        "mrad": 1e-3,
        "rpm": math.pi / 30,
        "1/min": math.pi / 30,
    },
    **{"mm³/(N m)": 1e-9, "µm²/mN": 1e-9, "mm/s": 1e-3, "m/min": 1 / 60, "mPa s": 1e-3, "cP": 1e-3},
    **{"1/GPa": 1e-9, "mm²/N": 1e-6, "min": 1 / 60, "s": 1 / 3600, "%": 1e-2, "‰": 1e-3},
}
"""Sizes of these units in SI, hours in place of seconds: computed apart from the parser's table."""
WHOLE = {"count", "cells", "seed", "max_cells"}
"""Keys of whole numbers, which have no units; so have the numbers of cells, ``shape``."""


def put(data: dict[str, Any], path: str, entry: object) -> None:
    """Put an entry into the data of a case, whose lists are those of numbers too."""
    *steps, last = keys_of(path)
    table: Any = data
    for step in steps:
        table = table[step]
    table[last] = entry


def typed(kind: str, which: int) -> tuple[dict[str, Any], dict[str, Any], list[str]]:
    """Return a template as numbers, the same with texts, and the paths of the texts."""
    plain = tomllib.loads(templates.texts()[kind])
    text = tomllib.loads(templates.texts()[kind])
    paths = []
    study = plain.get("sweep", {}).get("parameters", {})
    for path, number in core.numbers({key: plain[key] for key in plain if key != "sweep"}):
        if WHOLE.isdisjoint(keys_of(path)) and not path.startswith(("grid.shape", "shape.shape")):
            put(text, path, as_text(plain, tuple(keys_of(path)), number, which))
            paths.append(path)
    for of, values in study.items():
        keys = steps_of(plain, of)
        table = text["sweep"]["parameters"]
        if isinstance(values, list):
            table[of] = [as_text(plain, keys, value, which) for value in values]
        else:
            ends = {end: as_text(plain, keys, values[end], which) for end in ("first", "last")}
            table[of] = values | ends
        paths.append(of)
    return plain, text, paths


def as_text(plain: dict[str, Any], keys: tuple[Any, ...], number: float, which: int) -> str:
    """Return a number of a case in one of the other units of its kind, in all digits."""
    si = si_unit(plain, keys)
    unit = OTHERS[si][which]
    return f"{number * System(plain.get('units', 'SI')).unit(si)[0] / SIZES[unit]!r} {unit}"


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("kind", templates.KINDS)
def test_every_number_of_a_template_may_have_a_unit(kind: str, which: int) -> None:
    plain, text, paths = typed(kind, which)
    assert len(paths) >= 5
    known, read = (dict(core.numbers(Case(data).data)) for data in (plain, text))
    assert read.keys() == known.keys()
    # A text is rounded three times: its number, its size, and the number that is read.
    assert read == {path: pytest.approx(number, rel=1e-14) for path, number in known.items()}
    assert Case(text).data["units"] == plain["units"]


@pytest.mark.parametrize("kind", ["contact", "bearing", "indentation"])
def test_texts_are_arguments_of_the_same_solve(kind: str) -> None:
    plain, text, _ = typed(kind, 0)
    known, read = (
        dict(core.numbers(list(Case(data).arguments().values()))) for data in (plain, text)
    )
    assert read == {path: pytest.approx(number, rel=1e-13) for path, number in known.items()}


@pytest.mark.parametrize(
    ("unit", "text", "number"),
    [
        ("m", "5 mm", 5e-3),
        ("m", "5mm", 5e-3),
        ("mm", " 5 mm ", 5.0),
        ("m", "-2.5e-1 µm", -2.5e-7),
        ("m", "−2 um", -2e-6),
        ("m", "2 μm", 2e-6),
        ("m", "1 ft", 0.3048),
        ("MPa", "210 GPa", 210e3),
        ("Pa", "3 N/mm2", 3e6),
        ("Pa", "3 N/mm^2", 3e6),
        ("Pa", "3 N mm⁻²", 3e6),
        ("Pa", "2 bar", 2e5),
        ("N", "1 kgf", 9.80665),
        ("N m", "3 Nm", 3.0),
        ("N mm", "3 N·m", 3e3),
        ("N/mm", "100 kN/m", 100.0),
        ("psi", "30 ksi", 30e3),
        ("rad/s", "30/min", math.pi),
        ("rad/s", "30 1/min", math.pi),
        ("rad/s", "30 min-1", math.pi),
        ("rad/s", "30 min⁻¹", math.pi),
        ("rad/s", "30 rpm", math.pi),
        ("rad/s", "30 r/min", math.pi),
        ("rad/s", "180 °/s", math.pi),
        ("rad", "180°", math.pi),
        ("rad", "10800'", math.pi),
        ("rad", "2 mrad", 2e-3),
        ("m²/N", "1e-6 mm³/(N m)", 1e-15),
        ("m²/N", "1e-6 mm³/N/m", 1e-15),
        ("mm²/N", "1e-6 mm³/Nm", 1e-9),
        ("m²/N", "1e-15 m²/N", 1e-15),
        ("MPa s", "20 mPas", 2e-8),
        ("m²/s", "68 cSt", 68e-6),
        ("MPa s²/mm²", "7850 kg/m³", 7.85e-9),
        ("µN/µm", "50 mJ/m²", 0.05),
        ("", "0.1 %", 1e-3),
        ("h", "90 min", 1.5),
    ],
)
def test_a_text_is_the_number_nearest_to_it(unit: str, text: str, number: float) -> None:
    assert number_in(unit, text) == pytest.approx(number, rel=2.3e-16)


@pytest.mark.parametrize(
    ("unit", "text"),
    [
        ("m", "5"),
        ("m", "5 m m"),
        ("m", "5 mm 3"),
        ("m", "5 mm 1"),
        ("m", "5 % m"),
        ("Pa", "5 1 Pa"),
        ("m", "5 Mm"),
        ("m", "5 MPa"),
        ("m", '5"'),
        ("m", "5,0 mm"),
        ("m", "1 500 mm"),
        ("m", "nan mm"),
        ("m", "1e400 mm"),
        ("m", "1e999999999 mm"),
        ("m", "9" * 1000 + " mm"),
        ("m", "5 °C"),
        ("m²", "4 m m"),
        ("Pa", "210 Gpa"),
        ("rad/s", "25 1/s"),
        ("rad", "2"),
        ("m²/N", "1e-6 mm³/N m"),
        ("m²/N", "1e-6 mm³/(N/m)"),
        ("", "0.1"),
        ("", "2 mm"),
    ],
)
def test_other_texts_are_refused_with_the_unit(unit: str, text: str) -> None:
    with pytest.raises(ValueError, match=rf"^must be a number .*{re.escape(unit) or '%'}.*, got"):
        number_in(unit, text)


def test_a_comma_is_no_decimal_mark_in_files() -> None:
    with pytest.raises(ValueError, match=r"got '1,5 mm'; a decimal mark is a point$"):
        number_in("m", "1,5 mm")


CONTACT: dict[str, Any] = {
    "units": "N-mm-MPa",
    "materials": {"steel": {"young": 210e3, "poisson": 0.3}},
    "shape": {"kind": "sphere", "radius": 5.0},
    "body": {
        "substrate": "steel",
        "layers": [{"material": "steel", "thickness": 2e-3, "name": "skin"}],
    },
    "counterbody": {"substrate": "steel"},
    "grid": {"shape": [32, 32], "size": [0.3, 0.3]},
    "solve": {"load": 20.0},
}
LINE = {"shape": {"kind": "cylinder", "radius": 10.0}, "grid": {"cells": 65, "width": 0.6}}
ROLL = {"friction": 0.3, "direction": "+x", "creepage": {"along": 1e-3, "across": 0.0}}
WEAR = {"rate": 1e-11, "sliding": 1e3, "steps": 1}
BEARING = tomllib.loads(templates.texts()["bearing"])
TIP = tomllib.loads(templates.texts()["cone"])


def with_entry(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Return the data of a case with other entries."""
    data: dict[str, Any] = json.loads(json.dumps(base))
    for path, entry in changes.items():
        if path in data or "." not in path:
            data[path] = entry
        else:
            put(data, path, entry)
    return data


REFUSED: list[tuple[dict[str, Any], dict[str, Any], str]] = [
    (CONTACT, {"shape.radius": "5 MPa"}, r"shape\.radius: .* in mm .*'5 MPa'"),
    (CONTACT, {"shape.radius": "5"}, r"shape\.radius: .* in mm .*'5'"),
    (CONTACT, {"shape.radius": "5 m m"}, r"shape\.radius: .* in mm .*'5 m m'"),
    (
        CONTACT,
        {"materials.steel.young": "210 kN"},
        r"materials\.steel\.young: .* in MPa .*'210 kN'",
    ),
    (
        CONTACT,
        {"materials.steel.poisson": "0.3 m"},
        r"materials\.steel\.poisson: .* without a unit",
    ),
    (CONTACT, {"solve.load": "20 N/mm"}, r"solve\.load: .* in N .*'20 N/mm'"),
    (CONTACT, {"solve.load": "2 kg"}, r"solve\.load: .* in N .*'2 kg'"),
    (CONTACT, {"body.layers[0].thickness": "2 mm²"}, r"body\.layers\[0\]\.thickness: .* in mm "),
    (CONTACT, {"body.layers[0].thickness": "2 µ"}, r"body\.layers\[0\]\.thickness: .* in mm "),
    (CONTACT, {"grid.size": ["0.3 mm", "0.3 s"]}, r"grid\.size\[1\]: .* in mm .*'0\.3 s'"),
    (CONTACT, {"solve.tilt": {"x": "2 mm"}}, r"solve\.tilt\.x: .* in rad .*'2 mm'"),
    (CONTACT | LINE, {"solve.load": "100 N"}, r"solve\.load: .* in N/mm .*'100 N'"),
    (CONTACT, {"roll": ROLL | {"creepage": {"along": "1 mm"}}}, r"roll\.creepage\.along: .* in %"),
    (CONTACT, {"roll": ROLL | {"spin": "1 mm"}}, r"roll\.spin: .* in 1/mm "),
    (CONTACT, {"wear": WEAR | {"rate": "1e-6 mm³/N m"}}, r"wear\.rate: .* in mm²/N "),
    (CONTACT, {"wear": WEAR | {"sliding": "1 h"}}, r"wear\.sliding: .* in mm .*'1 h'"),
    (CONTACT, {"wear": {"rate": 1e-11, "cycles": 9.0, "steps": ["1 m"]}}, r"steps\[0\]: .*without"),
    (
        CONTACT,
        {"sweep": {"parameters": {"solve.load": ["1 N", "2 m"]}}},
        r"solve\.load\[1\]: .* in N ",
    ),
    (CONTACT, {"wear": WEAR | {"steps": "10 m"}}, r"wear\.steps: .* an integer .*'10 m'"),
    (
        CONTACT,
        {"sweep": {"parameters": {"solve.load": {"first": 1, "last": 2, "count": "3 N"}}}},
        r"solve\.load\.count: must be an integer above 0, got '3 N'",
    ),
    (CONTACT, {"sweep": {"parameters": {"solve.load": "1 N"}}}, r"a list of values, .*'1 N'"),
    (BEARING, {"bearing.solve.speed": "25 1/s"}, r"bearing\.solve\.speed: .* in rad/s .*'25 1/s'"),
    (BEARING, {"bearing.film.viscosity": "68 cSt"}, r"bearing\.film\.viscosity: .* in MPa s "),
    (BEARING, {"bearing.solve.force": {"x": "10 kg"}}, r"bearing\.solve\.force\.x: .* in N "),
    (TIP, {"tip.half_angle": "70.25 %"}, r"tip\.half_angle: .* in rad .*'70.25 %'"),
    (TIP, {"indent.approach": ["20 nm", "50 mN"]}, r"indent\.approach\[1\]: .* in µm .*'50 mN'"),
]
"""Mistakes that are refused: the case, its entries, and what the error says."""


@pytest.mark.parametrize(("base", "changes", "message"), REFUSED)
def test_a_wrong_unit_is_refused_with_key_unit_and_text(
    base: dict[str, Any], changes: dict[str, Any], message: str
) -> None:
    with pytest.raises(CaseError, match=message):
        Case(with_entry(base, changes))


WARNED: list[tuple[dict[str, Any], dict[str, Any], str]] = [
    (CONTACT, {"materials.steel.young": 210e9}, r"2\.1e\+17 Pa.*1200 GPa: is it in MPa\?"),
    (CONTACT, {"materials.steel.young": 1e-4, "solve.load": 1e-9}, r"100 Pa.*is it in MPa\?"),
    (
        CONTACT,
        {"body.layers[0].thickness": 2e3},
        r"a layer is 2000 mm thick, and the contact 0.* mm wide",
    ),
    (CONTACT, {"roll": ROLL | {"friction": 30.0}}, r"friction is 30, .* is it in per cent"),
    (
        CONTACT,
        {"roll": ROLL | {"creepage": {"along": 0.1}}},
        r"creepage is 0\.1, .*is it in per cent",
    ),
    (
        CONTACT,
        {"stress": {"friction": 30.0, "direction": [1, 0]}},
        r"friction is 30, .*is it in per cent",
    ),
    (CONTACT | LINE, {"solve.load": 100.0, "fatigue": {"friction": 30.0}}, r"friction is 30, "),
]
"""Mistakes that are warned of."""


@pytest.mark.parametrize(("base", "changes", "message"), WARNED)
def test_an_implausible_number_is_warned_of_with_both_numbers(
    base: dict[str, Any], changes: dict[str, Any], message: str, tmp_path: Path, capsys: Capture
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(toml.text(with_entry(base, changes)), encoding="utf-8")
    command("solve", path)
    assert re.search(message, " ".join(capsys.readouterr().out.split()))


@pytest.mark.parametrize("load", [19e3, 20e3])
def test_no_solid_bears_a_twelfth_of_its_modulus(load: float) -> None:
    # Hertz: the peak reaches 0.08 E* at 15.2 kN, where a/R is 0.126.
    steel = nacre.Elastic(210e9, 0.3)
    with pytest.warns(nacre.NacreWarning, match=r"contact modulus, 230\.8 GPa: above 0\.08"):
        solution = nacre.solve(nacre.Sphere(5e-3), steel, load=load, max_cells=4096)
    assert solution.report.warning_kinds == ["high pressure"]
    assert nacre.Solution.from_dict(solution.to_dict()).report.warnings == solution.report.warnings
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", nacre.NacreWarning)
        verdict = solution.stress_summary(yield_stress={"substrate": 100e9}).verdict()
    assert (verdict.level, verdict.inside_model) == ("fair", False)
    quiet = nacre.solve(nacre.Sphere(5e-3), steel, load=15e3, max_cells=4096)
    assert quiet.report.warnings == []


def test_a_study_has_numbers_of_the_texts_of_its_axes() -> None:
    values = {
        "shape.radius": ["5 mm", "4 in", 7.0],
        "solve.load": {"first": "10 N", "last": "0.02 kN", "count": 2},
    }
    study = Case(with_entry(CONTACT, {"sweep": {"parameters": values}})).study()
    assert study["parameters"] == {"shape.radius": [5.0, 4 * 25.4, 7.0], "solve.load": [10.0, 20.0]}
    named = {"body.layers.skin.thickness": ["1 µm", "2 µm"]}
    study = Case(with_entry(CONTACT, {"sweep": {"parameters": named}})).study()
    assert study["parameters"] == {"body.layers.skin.thickness": [1e-3, 2e-3]}


def test_other_units_leave_texts_what_they_are() -> None:
    case = Case(with_entry(CONTACT, {"shape.radius": "5 mm"}))
    known: Any = case.in_units("SI").data
    assert (known["shape"]["radius"], known["solve"]["load"], known["units"]) == (5e-3, 20.0, "SI")


def test_a_written_case_reads_back_the_same(tmp_path: Path) -> None:
    case = Case(with_entry(CONTACT, {"shape.radius": "0.2 in", "solve.load": "5 lbf"}))
    path = tmp_path / "case.toml"
    path.write_text(toml.text(case.data), encoding="utf-8")
    assert Case.read(path).data == case.data


def test_texts_that_are_no_numbers_stay() -> None:
    names = {"materials": {"1.3505": CONTACT["materials"]["steel"], "steel": "100Cr6"}}
    case = Case(with_entry(CONTACT, names | {"body.substrate": "1.3505"}))
    assert case.data["body"]["substrate"] == "1.3505"


def test_an_editor_takes_texts_for_numbers(capsys: Capture) -> None:
    assert command("schema", "--json") == 0
    schema = json.loads(capsys.readouterr().out)
    young = schema["$defs"]["Material"]["properties"]["young"]
    assert young["type"] == ["number", "string"]
    assert schema["$defs"]["SphereShape"]["properties"]["radius"]["type"] == ["number", "string"]


@pytest.mark.parametrize(
    ("card", "path", "text", "number"),
    [
        ("contact", "solve.load", "0.02 kN", 20.0),
        ("contact", "shape.radius", "5 mm", 5.0),
        ("contact", "shape.radius", "0,2 in", 5.08),
        ("contact", "shape.radius", "5", 5.0),
        ("bearing", "bearing.solve.speed", "25 Hz", 50 * math.pi),
        ("bearing", "bearing.solve.tilt.y", "1 mrad", math.tan(1e-3)),
        ("bearing", "bearing.life.required_life", "90 min", 1.5),
        ("cone", "tip.half_angle", "1.2 rad", 1.2),
    ],
)
def test_the_page_takes_texts_in_other_units(
    card: str, path: str, text: str, number: float
) -> None:
    data = cards()[card].case({path: text}).data
    entry = core.at(data, path)
    assert (max(entry) if isinstance(entry, list) else entry) == pytest.approx(number, rel=1e-11)


def test_the_page_refuses_another_unit_with_its_own() -> None:
    with pytest.raises(FieldError, match=r"must be between .* mm, got 5 MPa"):
        cards()["contact"].case({"shape.radius": "5 MPa"})
