"""A field of a value class is everywhere: in plain data, files, pickles, case files and paths."""

import inspect
import json
import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import STEEL, quiet
from nacre import _core as core
from nacre.results import values
from nacre.results.parameters import VALUES
from shapes import SHAPES
from support import python

COATING = nacre.Layer(nacre.Elastic(3e9, 0.4), 2e-6, "frictionless", "lacquer")
BONDED = nacre.Layer(COATING.material, COATING.thickness, name=COATING.name)
MADE: dict[str, list[dict[str, Any]]] = {
    "Elastic": [{"young": 2e11, "poisson": 0.25}],
    "Layer": [
        {"material": STEEL, "thickness": 1e-6, "interface": "frictionless", "name": "skin"},
    ],
    "Spring": [{"normal": 2e15, "tangential": 3e14}],
    "HalfSpace": [{"substrate": STEEL, "layers": (BONDED,), "ends": (-1e-2, 2e-2)}],
    "Response": [{"values": None, "local": 1e-13}],
    "Grid": [
        {"shape": (4, 6), "size": (1.0, 2.0), "center": (0.5, 0.1), "periodic": (True, False)},
    ],
    "Grid.line": [{"cells": 8, "width": 2.0, "center": 0.5}],
    "LogarithmicProfile": [
        {"amplitude": 1e-6, "length": 10e-3, "flat_length": 2e-3, "end_factor": 0.9},
    ],
    "SampledProfile": [
        {"x": (-1e-3, 0.0, 1e-3), "drop": (1e-6, 0.0, 2e-6), "smooth": False},
        {
            "x": (-1e-3, -5e-4, 5e-4, 1e-3),
            "drop": (1e-6, 0.0, 0.0, 2e-6),
            **{"corners": (5e-4,), "smoothing": 2e-4},
        },
    ],
    **{name: row.arguments for name, row in SHAPES.items()},
    "Tip.sphere": [{"radius": 1e-6}],
    "Tip.paraboloid": [{"radius": 1e-6}],
    "Tip.cone": [{"slope": 0.3}],
    "Tip.flat_punch": [{"radius": 1e-6}],
    "Tip.power": [{"factor": 2.0, "exponent": 1.5}],
    "Tip.rounded_cone": [{"slope": 0.3, "radius": 1e-7}],
    "Tip.rounded_punch": [{"flat": 1e-6, "radius": 1e-7}],
    "Tip.flat_cone": [{"flat": 1e-6, "slope": 0.3}],
    "Tip.profile": [{"radii": (0.0, 1e-6, 2e-6), "heights": (0.0, 1e-7, 3e-7)}],
    "Tip.area_function": [{"coefficients": (24.5, 1e-7), "depth": 1e-6}],
    "Tip.berkovich": [{"radius": 1e-7}],
    "Adhesion.jkr": [{"work": 0.1}],
    "Adhesion.dmt": [{"work": 0.1}],
    "Adhesion.maugis": [{"work": 0.1, "strength": 1e8}],
    **{
        name: [{"bending": 520e6, "torsion": 330e6}]
        for name in ("DangVan", "Crossland", "Findley", "Matake")
    },
}
"""Arguments of each call that makes a value: all of them, and none as it is by default."""
TABLES = {
    "Elastic": "Material",
    "HalfSpace": "Body",
    "Grid.line": "Grid",
    **{name: name for name in ("Layer", "Spring", "Grid", "HeightMap")},
    **{name: name for name in ("LogarithmicProfile", "SampledProfile")},
    **{name: f"{name}Table" for name in ("DangVan", "Crossland", "Findley", "Matake")},
}
"""Tables of case files where the name of the class does not say them."""
FROM_A_FILE = {("HeightMap", "heights"), ("HeightMap", "center")}
"""Fields that a case reads from a file."""
OTHERS = {"Tip.berkovich": "Tip.rounded_cone"}
"""Calls whose values are those of another call."""
SAMPLES = nacre.Response(lambda alpha: 1e-12 / alpha)

PAIRS = [(name, k) for name, made in MADE.items() for k in range(len(made))]
each = pytest.mark.parametrize(("name", "number"), PAIRS, ids=lambda part: str(part))


def value_of(name: str, number: int) -> tuple[Any, dict[str, Any]]:
    """Return a value, and the arguments that made it."""
    given = MADE[name][number]
    if name == "Response":
        given = given | {"values": SAMPLES.values}
    return values.CALLS[name][0](**given), given


def decoded(data: Any) -> Any:
    """Return a value of plain data, or the message of the error."""
    try:
        return values.decode(data)
    except ValueError as error:
        return str(error)


def table(name: str, schema: dict[str, Any]) -> set[str]:
    """Return the keys of a value in case files."""
    family, _, kind = name.partition(".")
    title = kind.title().replace("_", "") + family if family in ("Tip", "Adhesion") else ""
    return set(schema[TABLES.get(name) or title or f"{name}Shape"]["properties"])


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    done = python("-m", "nacre.cli", "schema", "--json")
    found: dict[str, Any] = json.loads(done.stdout)["$defs"]
    return found


def test_every_argument_of_every_value_is_tried() -> None:
    assert set(MADE) == set(values.CALLS)
    for name, (make, fields) in values.CALLS.items():
        assert set().union(*MADE[name]) == set(fields), name
        defaults = inspect.signature(make).parameters
        for given in MADE[name]:
            for field, value in given.items():
                default = defaults[field].default
                assert name == "Response" or default is inspect.Parameter.empty or value != default


def test_numbers_of_shapes_have_units() -> None:
    calls = (arguments for row in SHAPES.values() for arguments in row.arguments)
    numbers = {name for call in calls for name, value in call.items() if type(value) is float}
    assert numbers - VALUES.keys() == set(), "their docstrings must have units: [m], [1]"


@each
def test_a_field_is_everywhere(name: str, number: int, schema: dict[str, Any]) -> None:
    value, given = value_of(name, number)
    is_kept_in_plain_data(name, value, given)
    is_kept_in_pickles_and_text(name, value, given)
    if name != "Response":  # its values are no keys, and have no paths
        for field in given:
            assert field in table(name, schema) or (name, field) in FROM_A_FILE
        has_paths(value, given)


def is_kept_in_plain_data(name: str, value: Any, given: dict[str, Any]) -> None:
    ((kind, data),) = values.encode(value).items()
    assert kind == OTHERS.get(name, name)
    for field, argument in given.items():
        is_infinite = type(argument) is float and math.isinf(argument)  # which JSON does not have
        assert data[field] == (None if is_infinite else values.encode(argument))
        other = decoded({kind: {key: one for key, one in data.items() if key != field}})
        assert other != value
        assert not isinstance(other, str) or field in other
    assert values.decode(json.loads(json.dumps({kind: data}))) == value


def is_kept_in_pickles_and_text(name: str, value: Any, given: dict[str, Any]) -> None:
    again = pickle.loads(pickle.dumps(value))
    assert again == value
    assert values.encode(again) == values.encode(value)
    if name not in ("Response", *OTHERS):
        shown = given if name not in ("Layer", "HalfSpace") else list(given)[1:]
        assert all(f"{field}=" in repr(value) for field in shown)


def has_paths(value: Any, given: dict[str, Any]) -> None:
    paths = dict(core.numbers({"it": value}))
    for field, argument in given.items():
        leaves = argument if isinstance(argument, tuple) else (argument,)
        if not all(type(leaf) is float for leaf in leaves):
            continue
        for k, leaf in enumerate(leaves):
            if not leaf:  # where profiles begin
                continue
            path = f"it.{field}[{k}]" if isinstance(argument, tuple) else f"it.{field}"
            assert paths[path] == leaf
            other = 1.01 * leaf if math.isfinite(leaf) else 1.0
            changed = core.with_value({"it": value}, path, other)
            rest = dict(core.numbers(changed))
            assert {one for one in rest if rest[one] != paths[one]} == {path}
            assert rest[path] == other
            assert core.at(changed, path) == other
    assert dict(core.numbers({"it": value})) == paths


def test_a_solution_keeps_all_fields_of_bodies_and_grid(tmp_path: Path) -> None:
    body = nacre.HalfSpace(STEEL, [BONDED], ends=(None, 1.0))
    grid = nacre.Grid((16, 12), (4e-4, 3e-4), (1e-5, 2e-5))
    solution = quiet(nacre.solve, nacre.Sphere(5e-3), body, grid=grid, load=1.0)
    found = nacre.load(solution.save(tmp_path / "a.nc"))
    assert (found.report.body, found.report.grid) == (body, grid)
    assert np.array_equal(found.x, grid.x)
