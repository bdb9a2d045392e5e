"""Signatures, errors, case files and files know the same keywords, shapes and tips."""

import inspect
import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, STEEL
from nacre.results import values
from support import Capture, command

GRID = nacre.Grid((16, 16), (2e-4, 2e-4))
CONTACT = nacre.Contact(STEEL, GRID)
SOLUTION = CONTACT.solve(BALL, load=10.0)
PLAN = SOLUTION.stress_plan()
MOTION = {"load", "approach", "eccentricity", "moment", "tilt"}

FUNCTIONS: dict[str, Callable[..., Any]] = {
    "solve": lambda **k: nacre.solve(BALL, STEEL, **k),
    "Contact": lambda **k: nacre.Contact(STEEL, GRID, **k),
    "Contact.solve": lambda **k: CONTACT.solve(BALL, **k),
    "Contact.solve_many": lambda **k: CONTACT.solve_many([], **k),
}
DEFAULTS: dict[str, tuple[Callable[..., Any], tuple[Any, ...], dict[str, Any]]] = {
    "solve": (nacre.solve, (BALL, STEEL), {"load": 10.0}),
    "stress": (nacre.stress, (STEEL, GRID, np.ones((16, 16)), 0.0), {}),
    "Solution.stress": (SOLUTION.stress, (0.0,), {}),
    "Solution.stress_summary": (SOLUTION.stress_summary, (), {}),
    "StressPlan.stress": (PLAN.stress, (0.0,), {}),
    "StressPlan.summary": (PLAN.summary, (), {}),
}


def defaults(function: Callable[..., Any]) -> dict[str, Any]:
    """Return the keywords of a signature with their defaults."""
    parameters = inspect.signature(function).parameters.values()
    return {one.name: one.default for one in parameters if one.kind is one.KEYWORD_ONLY}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_keyword_that_there_is_not_is_refused(name: str) -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'nonsense'"):
        FUNCTIONS[name](nonsense=1)


@pytest.mark.parametrize("name", DEFAULTS)
def test_the_defaults_are_those_of_the_signature(name: str) -> None:
    function, arguments, given = DEFAULTS[name]
    found = function(*arguments, **defaults(function) | given)
    expected = function(*arguments, **given)
    if name == "solve":
        found, expected = found.pressure.tobytes(), expected.pressure.tobytes()
    assert found == expected
    with pytest.raises(TypeError, match="nonsense"):
        function(*arguments, nonsense=1, **given)


def test_a_case_names_all_that_says_how_it_is_pressed() -> None:
    with pytest.raises(TypeError, match="keys of a case must be among ") as caught:
        CONTACT.solve_many([{"nonsense": 1}])
    listed = str(caught.value).partition(" among ")[2].partition(", got ")[0]
    assert set(listed.split(", ")) == {"shape", *MOTION}
    assert set(defaults(CONTACT.solve)) >= MOTION


KINDS = {kind.__name__: kind for kind in values.FIELDS}


def test_files_and_case_files_know_every_keyword_shape_tip_and_adhesion(capsys: Capture) -> None:
    assert command("schema", "--json") == 0
    tables = json.loads(capsys.readouterr().out)["$defs"]
    # What is no number and no word is not a key.
    keys = set(defaults(nacre.solve)) - {"grid", "initial", "progress", "check"}
    assert set(tables["Solve"]["properties"]) == keys
    kinds = {
        table["properties"]["kind"]["const"].replace("_", "")
        for table in tables.values()
        if "const" in table["properties"].get("kind", {})
    }
    shapes = {kind.__name__ for kind in nacre.types.Shape.__subclasses__()}
    assert len(shapes) >= 6
    assert shapes <= set(KINDS)
    assert {shape.lower() for shape in shapes} | {"randomsurface", "sum"} <= kinds
    for family in (nacre.indent.Tip, nacre.indent.Adhesion):
        named = {name for name, one in vars(family).items() if isinstance(one, staticmethod)}
        made = named - {"__new__"}
        assert {f"{family.__name__}.{kind}" for kind in made} <= set(values.CALLS)
        assert {kind.replace("_", "") for kind in made} <= kinds


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_arguments_of_a_constructor_are_attributes(kind: str) -> None:
    for name in values.FIELDS[KINDS[kind]]:
        assert isinstance(inspect.getattr_static(KINDS[kind], name), property) or hasattr(
            KINDS[kind], name
        )


def test_the_public_names_are_those_of_the_stub() -> None:
    named = {*nacre.__all__, *nacre.types.__all__}
    compiled = vars(nacre._core)
    own = {name for name in named if getattr(nacre, name) is compiled.get(name)}
    assert own <= {*nacre._core.__all__}
    assert not [name for name in nacre._core.__all__ if name.startswith("_") and "__" not in name]
