"""Every keyword of a contact comes back with the number and the unit that went in.

Tried are two systems of units, areas and lines; the units are those of the groups of keywords.
"""

from __future__ import annotations

import re
import warnings
from typing import Any

import pytest

import nacre
from nacre._tools.arguments import keywords_of
from nacre._tools.groups import keyword_units
from nacre._tools.units import System, size_of
from nacre.app.fields import field_of
from nacre.case import Case
from nacre.contact.wear_march import KEYWORDS
from support import assert_close

SYSTEMS = ("SI", "N-mm-MPa")
STEEL, BALL, CYLINDER = (210e9, 0.3), 5e-3, 10e-3
"""Young's modulus [Pa], Poisson's ratio, and radii [m]."""
VALUES: dict[str, Any] = {
    "load": 5.0,
    "approach": 1e-6,
    "eccentricity": (1e-5, None),
    "moment": (5e-5, None),
    "tilt": (1e-5, None),
    "hardness": 5e9,
    "compliance": 1e-15,
    "shift": (1e-8, None),
    "force": (0.5, None),
    "twist": 1e-5,
    "torque": 1e-5,
    "spin": 0.1,
    "rate": 1e-15,
    "counter_rate": 2e-16,
    "sliding": 10.0,
}
"""Numbers in SI of the keywords with units."""
LINE: dict[str, Any] = {
    "load": 1e5,
    "approach": 1e-6,
    "eccentricity": (None, 1e-6),
    "moment": (None, 0.1),
    "tilt": (None, 1e-5),
    "hardness": 5e9,
    "compliance": 1e-15,
    "shift": (None, 1e-8),
    "force": (None, 1e4),
    "rate": 1e-15,
    "counter_rate": 2e-16,
    "sliding": 10.0,
}
"""The same in line contact."""
GIVEN_TO: dict[str, str] = {
    **dict.fromkeys(("shift", "force", "twist", "torque"), "slide"),
    "spin": "roll",
    **dict.fromkeys(("rate", "counter_rate", "sliding"), "wear"),
}
"""Functions that have the keyword; `solve` where none is named."""


def scaled(value: Any, size: float) -> Any:
    """Return a number in a unit of this size, or both of a pair."""
    if isinstance(value, tuple):
        return tuple(None if part is None else part / size for part in value)
    return value / size


def case(name: str, units: str, line: bool) -> tuple[str, dict[str, Any]]:
    """Return the function that has a keyword, and its arguments in these units."""
    system, values = System(units), LINE if line else VALUES
    metre, pascal = system.unit("m")[0], system.unit("Pa")[0]
    function = GIVEN_TO.get(name, "solve")
    names = {
        "solve": ["load"],
        "slide": ["load"],
        "roll": ["load"],
        "wear": ["load", "rate", "sliding"],
    }
    given = [*names[function], name]
    if name == "approach":
        given.remove("load")
    declared = keyword_units(*KEYWORDS, line=line)
    numbers = {key: scaled(values[key], system.unit(declared[key])[0]) for key in given}
    steel = nacre.Elastic(STEEL[0] / pascal, STEEL[1])
    if line:
        shape: nacre.types.Shape = nacre.Cylinder(CYLINDER / metre)
        grid = nacre.Grid.line(32, 6e-4 / metre)
    else:
        shape, grid = nacre.Sphere(BALL / metre), nacre.Grid((16, 16), (4e-4 / metre, 4e-4 / metre))
    arguments = {"shape": shape, "body": steel, "counterbody": steel, "grid": grid, **numbers}
    if function in ("slide", "roll"):
        arguments["friction"] = 0.3
    if name in ("twist", "torque"):
        arguments["shift"] = (0.0, 0.0)
    if function == "roll":
        arguments |= {"direction": "+x", "creepage": (1e-4, 0.0)}
    if function == "wear":
        arguments["steps"] = 1
    return function, arguments


CASES = [
    (name, units, line)
    for line, values in ((False, VALUES), (True, LINE))
    for name in values
    for units in SYSTEMS
]
ONE_NUMBER = [case for case in CASES if not isinstance(VALUES[case[0]], tuple)]


def test_every_keyword_with_a_unit_is_tried() -> None:
    declared = {name for name, unit in keyword_units(*KEYWORDS).items() if unit}
    assert declared - {"initial"} == set(VALUES)
    # An endless cylinder neither twists nor spins about its normal in line contact.
    assert set(VALUES) - set(LINE) == {"twist", "torque", "spin"}


def in_si(number: float, unit: str) -> tuple[float, str]:
    """Return a number with a unit in SI, and its SI unit."""
    inverse = unit.removeprefix("1").removeprefix("/")
    dimension, size = size_of(inverse) or ("", 1.0)
    return (number * size, dimension) if inverse == unit else (number / size, f"1/{dimension}")


def quantity(text: str) -> float:
    """Return the number in SI that a text says; of a pair the one that is not 0."""
    pattern = r"(-?\d[\d.]*(?:e[+-]?\d+)?) ?([^\d\s,()–][^,()–]*)?"
    numbers = [(float(number), unit.strip()) for number, unit in re.findall(pattern, text)]
    return next(in_si(number, unit)[0] for number, unit in numbers if number)


@pytest.mark.parametrize(("name", "units", "line"), CASES)
def test_reports_give_back_what_went_in(name: str, units: str, line: bool) -> None:
    function, arguments = case(name, units, line)
    expected = next(v for v in _parts((LINE if line else VALUES)[name]) if v)
    with warnings.catch_warnings(), nacre.display_units(units):
        warnings.simplefilter("ignore")
        result = getattr(nacre, function)(**arguments)
        sections = result._sections()
    # What moves tangentially is found or given: its row is among the results.
    moves = name in ("shift", "force", "twist", "torque", "spin")
    rows = sections.numbers if moves else sections.inputs
    shown = next(row.text for row in rows if row.key.split(".")[0] == name)
    assert_close(quantity(shown), expected, rtol=1e-3)


def _parts(value: Any) -> tuple[float | None, ...]:
    return value if isinstance(value, tuple) else (value,)


@pytest.mark.parametrize(("name", "units", "line"), ONE_NUMBER)
def test_axes_of_studies_have_the_unit_of_the_keyword(name: str, units: str, line: bool) -> None:
    _, arguments = case(name, units, line)
    value = arguments.pop(name)
    with warnings.catch_warnings(), nacre.display_units(units):
        warnings.simplefilter("ignore")
        study = nacre.sweep(arguments, {name: [value]}, progress=False)
    number, dimension = in_si(value, study[name].attrs["units"])
    assert dimension == keyword_units(*KEYWORDS, line=line)[name]
    assert_close(number, (LINE if line else VALUES)[name], rtol=1e-9)


def file_of(name: str, units: str, line: bool) -> tuple[str, Case]:
    """Return the table of a case file that has a keyword, and the file of its contact."""
    function, arguments = case(name, units, line)
    shape, steel = arguments.pop("shape"), arguments.pop("body")
    body = {"substrate": {"young": steel.young, "poisson": steel.poisson}}
    kind = {"kind": "cylinder" if line else "sphere", "radius": shape.radius}
    grid = arguments.pop("grid")
    sizes = {"shape": list(grid.shape), "size": list(grid.size)}
    strips = {"cells": grid.shape[1], "width": grid.size[1]}
    data: dict[str, Any] = {
        "units": units,
        "shape": kind,
        "grid": strips if line else sizes,
        "solve": {},
    }
    data |= {"body": body, "counterbody": body}
    del arguments["counterbody"]
    for key, value in arguments.items():
        pair = value if isinstance(value, tuple) else None
        sides = zip("xy", pair or (), strict=False)
        entry = {axis: part for axis, part in sides if part is not None} if pair else value
        table = "solve" if key in keywords_of(nacre.solve) else function
        data.setdefault(table, {})[key] = list(pair) if pair and None not in pair else entry
    return "solve" if name in data["solve"] else function, Case(data)


PRINTED = {"eccentricity": "acts at", "compliance": "springs", "sliding": "distance"}
"""Rows of prints whose names are not those of the keywords."""


@pytest.mark.parametrize(("name", "units", "line"), CASES)
def test_case_files_and_prints_give_back_what_went_in(name: str, units: str, line: bool) -> None:
    function, arguments = case(name, units, line)
    _, file = file_of(name, units, line)
    given = file.arguments()
    assert given[name] == arguments[name]
    if name in ("rate", "counter_rate"):
        return  # which are inputs, and not printed
    with warnings.catch_warnings(), nacre.display_units(units):
        warnings.simplefilter("ignore")
        text = str(getattr(nacre, function)(**given))
    rows = re.findall(rf"^{PRINTED.get(name, name)}  +(.*)", text, re.MULTILINE)
    expected = next(v for v in _parts((LINE if line else VALUES)[name]) if v)
    assert_close(quantity(rows[-1]), expected, rtol=1e-3)


@pytest.mark.parametrize(("name", "units", "line"), CASES)
def test_fields_of_the_page_have_the_unit_of_the_keyword(name: str, units: str, line: bool) -> None:
    table, file = file_of(name, units, line)
    pair = isinstance(file.arguments()[name], tuple)
    field = field_of(file.data, f"{table}.{name}" + (f".{'y' if line else 'x'}" if pair else ""))
    assert isinstance(field.default, float)
    number, dimension = in_si(field.default, field.unit)
    assert dimension == keyword_units(*KEYWORDS, line=line)[name]
    expected = next(v for v in _parts((LINE if line else VALUES)[name]) if v)
    assert_close(number, expected, rtol=1e-9)
