"""Whatever takes the keywords and the shapes from elsewhere agrees with it."""

import functools
import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, STEEL
from nacre import _indent_tables, _schema, _shape_tables, studies, values
from nacre.contact import MOTION

GRID = nacre.Grid((16, 16), (2e-4, 2e-4))
SOLUTION = nacre.solve(BALL, STEEL, grid=GRID, load=10.0)
PLAN = SOLUTION.stress_plan()

FUNCTIONS: dict[str, Callable[..., Any]] = {
    "solve": lambda **k: nacre.solve(BALL, STEEL, **k),
    "Contact": lambda **k: nacre.Contact(STEEL, GRID, **k),
    "Contact.solve": lambda **k: nacre.Contact(STEEL, GRID).solve(BALL, **k),
    "Contact.solve_many": lambda **k: nacre.Contact(STEEL, GRID).solve_many([], **k),
}
PRESSURE = np.ones((16, 16))
STRESSES: dict[str, Callable[..., Any]] = {
    "stress": functools.partial(nacre.stress, STEEL, GRID, PRESSURE, 0.0),
    "Solution.stress": functools.partial(SOLUTION.stress, 0.0),
    "Solution.stress_summary": SOLUTION.stress_summary,
    "StressPlan.stress": functools.partial(PLAN.stress, 0.0),
    "StressPlan.summary": PLAN.summary,
}


def keywords(function: Callable[..., Any]) -> set[str]:
    parameters = inspect.signature(function).parameters.values()
    return {one.name for one in parameters if one.kind is one.KEYWORD_ONLY}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_keyword_that_there_is_not_is_refused(name: str) -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'nonsense'"):
        FUNCTIONS[name](nonsense=1)


@pytest.mark.parametrize("name", STRESSES)
def test_the_defaults_of_stresses_are_those_of_the_signature(name: str) -> None:
    call = STRESSES[name]
    parameters = inspect.signature(call).parameters.values()
    spelt = {one.name: one.default for one in parameters if one.kind is one.KEYWORD_ONLY}
    assert call(**spelt) == call()
    with pytest.raises(TypeError, match="unexpected keyword argument 'nonsense'"):
        call(nonsense=1)


def test_a_case_names_all_that_says_how_it_is_pressed() -> None:
    with pytest.raises(TypeError, match="keys of a case must be among ") as caught:
        nacre.Contact(STEEL, GRID).solve_many([{"nonsense": 1}])
    listed = str(caught.value).partition(" among ")[2].partition(", got ")[0]
    assert set(listed.split(", ")) == {"shape", *MOTION}


def test_the_defaults_are_those_of_the_signature() -> None:
    expected = nacre.solve(BALL, STEEL, load=10.0)
    parameters = inspect.signature(nacre.solve).parameters.values()
    spelt = {one.name: one.default for one in parameters if one.kind is one.KEYWORD_ONLY}
    again = nacre.solve(BALL, STEEL, **(spelt | {"load": 10.0}))
    assert again.pressure.tobytes() == expected.pressure.tobytes()


def test_case_files_know_the_keywords_of_a_solve() -> None:
    assert set(_schema.Solve.model_fields) == keywords(nacre.solve) - {*_schema.OBJECTS}


def shapes() -> dict[str, type[nacre.types.Shape]]:
    return {kind.__name__: kind for kind in nacre.types.Shape.__subclasses__()}


KINDS = {kind.__name__: kind for kind in values.FIELDS}


def test_files_and_case_files_know_every_shape() -> None:
    assert len(shapes()) >= 6
    assert set(shapes()) <= set(KINDS)
    assert {kind.__name__ for kind in _shape_tables.SHAPES.values()} == set(shapes())
    assert set(_shape_tables.SHAPES) | {"random_surface", "sum"} == set(_shape_tables.TABLES)


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_arguments_of_a_constructor_are_attributes(kind: str) -> None:
    for name in values.FIELDS[KINDS[kind]]:
        assert isinstance(inspect.getattr_static(KINDS[kind], name), property) or hasattr(
            KINDS[kind], name
        )


def test_files_and_case_files_know_every_tip_and_adhesion() -> None:
    for family in (nacre.indent.Tip, nacre.indent.Adhesion):
        named = {name for name, one in vars(family).items() if isinstance(one, staticmethod)}
        kinds = named - {"__new__"}
        assert {f"{family.__name__}.{kind}" for kind in kinds} <= set(values.CALLS)
        assert set(_indent_tables.TABLES[family.__name__]) == kinds


def test_a_study_knows_every_argument_of_an_indentation() -> None:
    assert set(inspect.signature(nacre.indent.solve).parameters) == studies.INDENT


def test_the_public_names_are_those_of_the_stub() -> None:
    named = {*nacre.__all__, *nacre.types.__all__}
    compiled = vars(nacre._core)
    own = {name for name in named if getattr(nacre, name) is compiled.get(name)}
    assert own <= {*nacre._core.__all__}
    assert not [name for name in nacre._core.__all__ if name.startswith("_") and "__" not in name]
