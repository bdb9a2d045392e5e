"""Whatever repeats the keywords and the shapes agrees with the compiled module."""

import functools
import inspect
from collections.abc import Callable
from typing import Any, get_type_hints

import numpy as np
import pytest

import nacre
from bodies import BALL, STEEL
from nacre import _indent_tables, _keywords, _schema, _shape_tables, studies, values

GRID = nacre.Grid((16, 16), (2e-4, 2e-4))
SOLUTION = nacre.solve(BALL, STEEL, grid=GRID, load=10.0)
SOLVE = (_keywords.Motion, _keywords.Threads, _keywords.Search)
PLAN = SOLUTION.stress_plan()

# What is no number and no word: types of it are in the stub.
OBJECTS = {"grid", "initial", "progress", "check"}
FUNCTIONS: dict[str, tuple[Callable[..., Any], tuple[type, ...], Callable[..., Any]]] = {
    "solve": (nacre.solve, SOLVE, lambda **k: nacre.solve(BALL, STEEL, **k)),
    "Contact": (nacre.Contact, (_keywords.Plan,), lambda **k: nacre.Contact(STEEL, GRID, **k)),
    "Contact.solve": (
        nacre.Contact.solve,
        (_keywords.Motion, _keywords.Search),
        lambda **k: nacre.Contact(STEEL, GRID).solve(BALL, **k),
    ),
    "Contact.solve_many": (
        nacre.Contact.solve_many,
        (_keywords.Search,),
        lambda **k: nacre.Contact(STEEL, GRID).solve_many([], **k),
    ),
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
def test_signature_types_and_meaning_have_the_same_keywords(name: str) -> None:
    function, types, call = FUNCTIONS[name]
    typed = {keyword for group in types for keyword in get_type_hints(group)}
    assert keywords(function) - OBJECTS == typed - OBJECTS
    with pytest.raises(TypeError, match=f"^keywords of {name} must be among ") as caught:
        call(nonsense=1)
    listed = str(caught.value).partition(" among ")[2].partition(", got ")[0]
    assert set(listed.split(", ")) == keywords(function)


@pytest.mark.parametrize("name", STRESSES)
def test_the_defaults_of_stresses_are_those_of_the_signature(name: str) -> None:
    call = STRESSES[name]
    parameters = inspect.signature(call).parameters.values()
    spelt = {one.name: one.default for one in parameters if one.kind is one.KEYWORD_ONLY}
    assert call(**spelt) == call()
    with pytest.raises(TypeError, match="unexpected keyword argument 'nonsense'"):
        call(nonsense=1)


def test_the_compiled_module_refuses_keywords_of_stresses_that_it_does_not_know() -> None:
    with pytest.raises(TypeError, match=r"^keywords of a stress must be among .* got 'nonsense'"):
        nacre._core.stress(STEEL, GRID, PRESSURE, 0.0, {"nonsense": 1})
    with pytest.raises(TypeError, match=r"^keywords of a summary must be among .* got 'nonsense'"):
        SOLUTION.stress_plan()._plan.summary({"nonsense": 1})


def test_a_case_names_all_that_says_how_it_is_pressed() -> None:
    with pytest.raises(TypeError, match="a case's keys must be among ") as caught:
        nacre.Contact(STEEL, GRID).solve_many([{"nonsense": 1}])
    listed = str(caught.value).partition(" among ")[2].partition(", got ")[0]
    assert set(listed.split(", ")) == {"shape", *_keywords.Motion.__annotations__}


def test_the_defaults_are_those_of_the_signature() -> None:
    expected = nacre.solve(BALL, STEEL, load=10.0)
    parameters = inspect.signature(nacre.solve).parameters.values()
    spelt = {one.name: one.default for one in parameters if one.kind is one.KEYWORD_ONLY}
    again = nacre.solve(BALL, STEEL, **(spelt | {"load": 10.0}))
    assert again.pressure.tobytes() == expected.pressure.tobytes()


def test_case_files_know_the_keywords_of_a_solve() -> None:
    assert set(_schema.Solve.model_fields) == keywords(nacre.solve) - OBJECTS


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


def test_the_types_can_be_read() -> None:
    for group in SOLVE:
        assert get_type_hints(group)
