"""Every keyword of bearings and indentations comes back with the number and the unit that went in.

Bearings are in SI, whatever the units of the case; indentations are in those that are set.
"""

from __future__ import annotations

import functools
import math
import re
import warnings
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest

import nacre
from nacre import indent
from nacre._tools.groups import keyword_units
from nacre._tools.units import size_of
from nacre.app.fields import entry_at, field_of, keys_of
from nacre.bearing import BearingSolution, CylindricalRoller, Pair, film_thickness
from nacre.bearing.geometry import KNOWN
from nacre.case import Case
from nacre.results.parameters import VALUES, quantity_of
from nacre.results.rows import Row
from nacre.results.values import CALLS, CONSTRUCTORS
from support import assert_close

SYSTEMS = ("SI", "N-mm-MPa")
MILLIMETRES = {"N": 1.0, "m": 1e-3, "Pa": 1e6, "N m": 1e-3, "N/m": 1e3, "m/s": 1e-3, "m²/s": 1e-6}
MILLIMETRES |= {"Pa s": 1e6, "1/Pa": 1e-6, "kg/m³": 1e12, "rad": 1.0, "rad/s": 1.0, "": 1.0}
"""Sizes in SI of the units that go with N, mm and MPa; of a density t/mm³."""
Entries = dict[str, tuple[Any, str]]
ROLLER: Entries = {
    "diameter": (10e-3, "m"),
    "length": (9.6e-3, "m"),
    "raceway_diameters": ([55e-3, 75.041e-3], "m"),
    "raceway_crown.inner": (5.0, "m"),
    "capacity": (3e4, "N"),
    "density": (7000.0, "kg/m³"),
    "solve.force.x": (4450.0, "N"),
    "solve.displacement.y": (2e-6, "m"),
    "solve.moment.y": (1.5, "N m"),
    "solve.tilt.x": (1e-4, "rad"),
    "solve.rotation": (0.1, "rad"),
    "solve.speed": (100.0, "rad/s"),
    "life.speed": (50.0, "rad/s"),
    "life.kinematic_viscosity": (20e-6, "m²/s"),
    "life.fatigue_load_limit": (3e3, "N"),
}
BALL: Entries = {
    "diameter": (11.1e-3, "m"),
    "pitch_diameter": (46e-3, "m"),
    "contact_angle": (0.4, "rad"),
    "shoulder_height": (3e-3, "m"),
    "solve.force.z": (2e3, "N"),
}
GROOVE: Entries = {
    "diameter": (11.5e-3, "m"),
    "pitch_diameter": (43.5e-3, "m"),
    "clearance": (10e-6, "m"),
    "solve.force.x": (2e3, "N"),
    "film.speed": (8.0, "m/s"),
    "film.viscosity": (0.02, "Pa s"),
    "film.pressure_viscosity": (20e-9, "1/Pa"),
    "film.roughness": (0.1e-6, "m"),
    "film.radius": (5e-3, "m"),
}
BARREL: Entries = {
    "diameter": (12e-3, "m"),
    "length": (10e-3, "m"),
    "pitch_diameter": (82e-3, "m"),
    "contact_angle": (0.17, "rad"),
    "profile_radius": (46.5e-3, "m"),
    "groove_radius": (47.5e-3, "m"),
    "solve.force.x": (2e3, "N"),
}
MOUNTED: Entries = {"distance": (16e-3, "m"), "solve.force.z": (300.0, "N")}
SINGLE = {f"first.{key}": BALL[key] for key in ("diameter", "pitch_diameter", "contact_angle")}
OF_PAIR = {"kind": "angular_contact_ball", "count": 12}
BEARINGS: dict[str, tuple[dict[str, Any], Entries]] = {
    "roller": ({"kind": "cylindrical_roller", "count": 14, "life": {"contamination": 0.5}}, ROLLER),
    "ball": ({"kind": "angular_contact_ball", "count": 12}, BALL),
    "groove": ({"kind": "deep_groove_ball", "count": 9}, GROOVE),
    "barrel": ({"kind": "spherical_roller", "count": 19}, BARREL),
    "force": (
        {
            "kind": "pair",
            "arrangement": "O",
            "first": OF_PAIR,
        },
        MOUNTED | SINGLE | {"preload_force": (200.0, "N")},
    ),
    "distance": (
        {
            "kind": "pair",
            "arrangement": "O",
            "first": OF_PAIR,
        },
        MOUNTED | SINGLE | {"preload_distance": (5e-6, "m")},
    ),
}
"""Keys without units, and numbers in SI by the keys that have one."""
CASES = [(name, key, units) for name, (_, e) in BEARINGS.items() for key in e for units in SYSTEMS]
OF_SOLVE = [case for case in CASES if not case[1].startswith(("life.", "film."))]
"""Those that a solve is given; a life and a film are asked of what it returns."""
SWEPT = [case for case in OF_SOLVE if case[0] != "groove" and case[1] != "raceway_diameters"]
"""Those of single numbers, but for contacts that are solved, which take long."""


def case(name: str, units: str) -> Case:
    """Return the case of a bearing in these units."""
    plain, entries = BEARINGS[name]
    model = "solved" if name == "groove" else "iso16281"
    table = {**plain, "solve": {"model": model}, "life": {**plain.get("life", {})}}
    table["first"] = {**plain.get("first", {})}
    for key, (value, unit) in entries.items():
        *places, last = key.split(".")
        inner = functools.reduce(lambda data, place: data.setdefault(place, {}), places, table)
        size = 1.0 if units == "SI" else MILLIMETRES[unit]
        inner[last] = (np.array(value) / size).tolist()
    return Case(
        {"units": units, "bearing": {key: entry for key, entry in table.items() if entry != {}}}
    )


def given(case: Case, key: str) -> Any:
    """Return the number at a key as the bearing, its solve, its life or its film is given it."""
    arguments = case.arguments()
    table, _, last = key.rpartition(".")
    if table in ("life", "film"):
        return (case.life() if table == "life" else case.film() or {})[last]  # type: ignore[index]
    names = keys_of(key.removeprefix("solve."))
    axes = {"x": 0, "y": 1, "z": 2, "inner": 0}
    owner = arguments if key.startswith("solve.") else arguments["bearing"]
    for name in names:
        if isinstance(owner, tuple):
            owner = owner[axes[name]]
        else:
            owner = owner[name] if isinstance(owner, dict) else getattr(owner, name)
    return owner


TIMED = {"mm/s": "m/s", "mm²/s": "m²/s", "MPa s": "Pa s", "1/MPa": "1/Pa", "MPa s²/mm²": "kg/m³"}
"""SI units of those with N, mm, MPa and seconds."""


TURNED = {
    **{"°": (math.pi / 180, "rad"), "′": (math.pi / 180 / 60, "rad")},
    **{"/min": (2 * math.pi / 60, "rad/s")},
}
"""Units of angles and speeds of rotation in reports, in SI."""


def in_si(number: float, unit: str) -> tuple[float, str]:
    """Return a number with a unit in SI, and its SI unit."""
    if unit in TURNED:
        size, turned = TURNED[unit]
        return number * size, turned
    timed = TIMED.get(unit, unit)
    dimension, size = size_of(unit) or (timed, 1.0 if timed == unit else MILLIMETRES[timed])
    return number * size, dimension


def quantities(text: str) -> list[float]:
    """Return the numbers in SI that a text says; a unit behind a bracket is that of all in it."""
    whole = re.search(r"\) (\S+)$", text)
    pattern = r"(-?\d[\d.]*(?:e[+-]?\d+)?) ?([^\d\s,()–±][^,()–±]*)?"
    return [
        in_si(float(number), whole[1] if whole else unit.strip())[0]
        for number, unit in re.findall(pattern, text)
    ]


def texts(rows: Iterable[Row]) -> dict[str, str]:
    """Return what rows say, by their keys."""
    return {row.key: row.text for row in rows}


def test_every_keyword_with_a_unit_is_tried() -> None:
    tried = {quantity_of(key) for _, entries in BEARINGS.values() for key in entries}
    asked = (CylindricalRoller.solve, BearingSolution.life, film_thickness)
    units = keyword_units(*KNOWN.values(), *asked, Pair)
    assert {name for name, unit in units.items() if unit} == tried


@pytest.mark.parametrize(("name", "key", "units"), CASES)
def test_case_files_of_bearings_are_read_in_si(name: str, key: str, units: str) -> None:
    assert_close(given(case(name, units), key), BEARINGS[name][1][key][0], rtol=1e-12)


@pytest.mark.parametrize(("name", "key", "units"), CASES)
def test_fields_of_the_page_have_the_unit_of_a_bearing(name: str, key: str, units: str) -> None:
    value, unit = BEARINGS[name][1][key]
    place = f"bearing.{key}" + ("[1]" if isinstance(value, list) else "")
    field = field_of(case(name, units).data, place)
    assert isinstance(field.default, float)
    number, dimension = in_si(field.default, field.unit)
    assert dimension == unit
    assert_close(number, value[1] if isinstance(value, list) else value, rtol=1e-9)


@functools.cache
def solved(name: str, units: str) -> Any:
    """Return what a case of a bearing solves."""
    arguments = case(name, units).arguments()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return arguments.pop("bearing").solve(**arguments)


@pytest.mark.parametrize(("name", "key", "units"), OF_SOLVE)
def test_prints_and_reports_say_what_a_bearing_was_given(name: str, key: str, units: str) -> None:
    value, _ = BEARINGS[name][1][key]
    table, _, last = key.rpartition(".")
    solution = solved(name, units)
    with nacre.display_units(units):
        sections, text = solution._sections(), str(solution)
    rows, asked = texts(sections.inputs), table.removeprefix("solve.")
    if table.startswith("solve."):  # loads and places of the ring are among the results
        printed = re.findall(rf"^{asked}  +(.*)", text, re.MULTILINE)[0]
        assert texts(sections.numbers)[asked] == printed
        number = quantities(printed)["xyz".index(last)]
    else:
        labels = (key, last, f"bearing.{last}", f"bearing.{table}")
        shown = next(rows[label] for label in labels if label in rows)
        number = quantities(shown)[isinstance(value, list)]
    assert_close(number, value[1] if isinstance(value, list) else value, rtol=1e-3)


@pytest.mark.parametrize("units", SYSTEMS)
def test_lives_and_films_say_what_they_were_given(units: str) -> None:
    life = solved("roller", units).life(**(case("roller", units).life() or {}))
    shown = re.findall(r"^fatigue load limit +(.*)", str(life), re.MULTILINE)[0]
    assert_close(quantities(shown)[0], ROLLER["life.fatigue_load_limit"][0], rtol=1e-3)
    keywords = case("groove", units).film() or {}
    contact = solved("groove", units).contact(0, keywords.pop("ring"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        film = film_thickness(contact, **keywords)
    shown = re.findall(r"^radius +(.*)", str(film), re.MULTILINE)[0]
    assert_close(quantities(shown)[0], GROOVE["film.radius"][0], rtol=1e-3)


@pytest.mark.parametrize(("name", "key", "units"), SWEPT)
def test_axes_of_studies_have_the_unit_of_a_bearing(name: str, key: str, units: str) -> None:
    value, unit = BEARINGS[name][1][key]
    read, path = case(name, units), f"bearing.{key}"
    entry = entry_at(read.data, path)
    with warnings.catch_warnings(), nacre.display_units(units):
        warnings.simplefilter("ignore")
        outputs = ["peak_pressure"]
        study = nacre.sweep(read, {path: [entry]}, outputs=outputs, progress=False)
    assert study.error.item() == ""
    number, dimension = in_si(study[path].item(), study[path].attrs["units"])
    assert dimension == unit
    assert_close(number, value, rtol=1e-9)


TIPS: dict[str, tuple[dict[str, Any], Entries]] = {
    "load": (
        {"tip": {"kind": "sphere"}, "indent": {}},
        {"tip.radius": (10e-6, "m"), "indent.load": (0.02, "N")},
    ),
    "approach": (
        {"tip": {"kind": "flat_cone", "slope": 0.3}, "indent": {}},
        {"tip.flat": (2e-6, "m"), "indent.approach": (50e-9, "m")},
    ),
    "radius": (
        {"tip": {"kind": "area_function", "coefficients": [24.5]}, "indent": {}},
        {"tip.depth": (2e-6, "m"), "indent.radius": (1e-6, "m")},
    ),
    "adhesion": (
        {"tip": {"kind": "sphere", "radius": 1e-5}, "adhesion": {"kind": "maugis"}, "indent": {}},
        {
            "tip.radius": (10e-6, "m"),
            "adhesion.work": (0.05, "N/m"),
            "adhesion.strength": (200e6, "Pa"),
            "indent.load": (1e-4, "N"),
        },
    ),
    "profile": (
        {"tip": {"kind": "profile"}, "indent": {}},
        {
            "tip.radii": ([0.0, 1e-6, 4e-6], "m"),
            "tip.heights": ([0.0, 1e-7, 1e-6], "m"),
            "indent.load": (0.002, "N"),
        },
    ),
}
"""Kinds of tips and adhesion, and numbers in SI by the keys that have a unit."""
INDENTED = [(name, key, units) for name, (_, e) in TIPS.items() for key in e for units in SYSTEMS]


def indentation(name: str, units: str) -> Case:
    """Return the case of an indentation in these units."""
    plain, entries = TIPS[name]
    sizes = {unit: 1.0 if units == "SI" else size for unit, size in MILLIMETRES.items()}
    young = 210e9 / sizes["Pa"]
    data = {key: {**table} for key, table in plain.items()}
    for key, (value, unit) in entries.items():
        table, _, last = key.partition(".")
        data[table][last] = (np.array(value) / sizes[unit]).tolist()
    body = {"substrate": {"young": young, "poisson": 0.3}}
    return Case({"units": units, "body": body, **data})


def test_every_number_of_an_indentation_with_a_unit_is_tried() -> None:
    tried = {key.partition(".")[2] for _, entries in TIPS.values() for key in entries}
    asked = {name for name, unit in keyword_units(indent.solve).items() if unit}
    of_tips = {name for kind in CONSTRUCTORS for name in CALLS[kind][1] if name in VALUES}
    assert asked | of_tips == tried


@pytest.mark.parametrize(("name", "key", "units"), INDENTED)
def test_indentations_give_back_what_went_in(name: str, key: str, units: str) -> None:
    value, unit = TIPS[name][1][key]
    read, last = indentation(name, units), key.partition(".")[2]
    place = f"{key}[2]" if isinstance(value, list) else key
    expected = value[2] if isinstance(value, list) else value
    field = field_of(read.data, place)
    assert isinstance(field.default, float)
    typed, dimension = in_si(field.default, field.unit)
    assert dimension == unit
    assert_close(typed, max(value) if isinstance(value, list) else value, rtol=1e-9)
    with warnings.catch_warnings(), nacre.display_units(units):
        warnings.simplefilter("ignore")
        solution = indent.solve(**read.arguments())
        sections, text = solution._sections(), str(solution)
        entry = entry_at(read.data, place)
        study = nacre.sweep(read, {place: [entry]}, progress=False)
    rows = texts(sections.inputs if key.startswith(("tip", "adhesion")) else sections.numbers)
    shown = rows[key if key in rows else last]
    assert shown in text or key in rows  # inputs are in the report alone
    assert_close(quantities(shown)[2 if isinstance(value, list) else 0], expected, rtol=1e-3)
    number, dimension = in_si(study[place].item(), study[place].attrs["units"])
    assert dimension == unit
    assert_close(number, expected, rtol=1e-9)
