"""Results have a named state: plain data, exact, refused where a key is wrong."""

import copy
import dataclasses
import functools
from collections.abc import Callable
from typing import Any, get_type_hints

import numpy as np
import pytest
from pydantic import TypeAdapter

import nacre
import results
from bodies import BALL, STEEL
from nacre.results import values
from results import solved

GRID = nacre.Grid((24, 20), (3e-4, 2e-4), (1e-5, -2e-6))
SOLUTION = nacre.solve(
    BALL, results.COATED, STEEL, grid=GRID, load=10.0, tilt=(None, 1e-4), tolerance=1e-6
)
SUMMARY = SOLUTION.stress_summary(yield_stress={0: 2e9})
STRESS = SOLUTION.stress([0.0, 1e-5], x=0.0, friction=0.1, direction=(1.0, 0.0), displacement=True)
RESULTS: dict[str, Any] = {
    "Solution": SOLUTION,
    "Report": SOLUTION.report,
    "Stress": STRESS,
    "StressSummary": SUMMARY,
    "LayerStress": SUMMARY.layers[1],
    "InterfaceStress": SUMMARY.interfaces[0],
    **{kind: solved(kind) for kind in results.FRICTION},
    "FrictionReport": solved("slid").report,
    **{kind: solved(kind) for kind in results.LISTED},
}

every_result = pytest.mark.parametrize("kind", RESULTS)


LATER = {"rolling_direction", "uncertainty", "doubt"}
"""Keys that states of format 1 did not have at first: without them they are None."""
LATER_OF = {
    "StressSummary": {"friction", "caution", "bond_strength", "origins"},
    "fatigue": {"caution"},
    "FrictionReport": {"coupling_energy", "warnings"},
    "shakedown map": {"warnings"},
}
"""The same, of one kind."""


def test_what_the_compiled_module_hands_over_has_the_types_of_the_fields() -> None:
    """A tuple is no list, an infinite number no None, in reports of progress too."""
    seen: list[Any] = []
    nacre.solve(BALL, results.COATED, STEEL, grid=GRID, load=10.0, progress=seen.append)
    plan = nacre.Contact(STEEL, GRID, counterbody=STEEL)
    slide = functools.partial(plan.slide, BALL, load=9.0, friction=0.3, force=(1.0, 0.0))
    with pytest.warns(nacre.NacreWarning, match="16 cells across"):
        slide(progress=lambda step, report: seen.append(report))
    assert {type(report) for report in seen} == {type(SOLUTION.report), nacre.types.FrictionReport}
    compiled = ("Report", "StressSummary", "LayerStress", "InterfaceStress", "FrictionReport")
    for result in (*seen, *(RESULTS[kind] for kind in compiled), solved("creep coefficients")):
        kinds = get_type_hints(type(result))
        for field in dataclasses.fields(result):
            fits = TypeAdapter(kinds[field.name], config={"arbitrary_types_allowed": True})
            fits.validate_python(getattr(result, field.name), strict=True)


@every_result
def test_a_state_that_is_wrong_is_refused(kind: str) -> None:
    result = RESULTS[kind]
    restore, name, state = type(result).from_dict, type(result).__name__, result.to_dict()
    newer = rf"{name} has format 2, written by nacre 7\.3\.1; .* (install a newer|another) version"
    with pytest.raises(ValueError, match=newer):
        restore(state | {"format": values.FORMAT + 1, "nacre": "7.3.1"})
    for key in state:
        if key not in LATER | LATER_OF.get(kind, set()):
            less = {one: value for one, value in state.items() if one != key}
            with pytest.raises(ValueError, match=rf'{name}: the key "{key}" is missing'):
                restore(less)
        with pytest.raises(ValueError, match=key):
            restore(state | {key: object()})
    with pytest.raises(ValueError, match=rf"{name}: the key 'colour' is unknown"):
        restore(state | {"colour": "red"})
    other = state | {"kind": "Sandwich"}
    with pytest.raises(ValueError, match=rf'"kind" must be "{name}", got "Sandwich"'):
        restore(other)
    with pytest.raises(ValueError, match="must name a result of nacre, got 'Sandwich'"):
        values.decode(other)


def slower(state: Any) -> Any:
    """Return a state whose solves took a second more."""
    if isinstance(state, dict):
        later = {key: slower(value) for key, value in state.items()}
        return later | ({"seconds": state["seconds"] + 1.0} if "seconds" in state else {})
    return [slower(value) for value in state] if isinstance(state, list) else state


@every_result
def test_the_seconds_of_a_solve_do_not_count_in_comparisons(kind: str) -> None:
    result = RESULTS[kind]
    state = result.to_dict()
    assert kind == "Report" or type(result).from_dict(slower(state)) == result
    assert type(result).from_dict(state) == result


def test_a_contact_solved_twice_is_the_same_solution() -> None:
    again = nacre.solve(
        BALL, results.COATED, STEEL, grid=GRID, load=10.0, tilt=(None, 1e-4), tolerance=1e-6
    )
    assert again.report.seconds != SOLUTION.report.seconds
    assert again == SOLUTION


@pytest.mark.parametrize(
    ("key", "value"),
    [
        *(("force", [1.0]), ("force", "ab"), ("shift", True), ("shift", None), ("steps", 1.0)),
        *(("axis", "z"), ("names", [1]), ("is_line", 0)),
    ],
)
def test_a_field_of_another_type_is_refused(key: str, value: Any) -> None:
    with pytest.raises(ValueError, match=rf'Tried: the value of the key "{key}" does not fit'):
        results.Tried.from_dict(solved("tried").to_dict() | {key: value})


@pytest.mark.parametrize("data", [None, [], 3, "state"])
def test_what_is_no_dict_is_refused(data: Any) -> None:
    with pytest.raises(ValueError, match="Solution must be a dict of named fields, got"):
        nacre.Solution.from_dict(data)


def edited(edit: Callable[[dict[str, Any]], object]) -> dict[str, Any]:
    state = copy.deepcopy(SOLUTION.to_dict())
    edit(state)
    return state


WRONG_INSIDE: dict[str, Callable[[dict[str, Any]], object]] = {
    r'report: the key "residual" is missing': lambda s: s["report"].pop("residual"),
    r"report: the key 'colour' is unknown": lambda s: s["report"].update(colour=1),
    r'motion: the key "tilt" is missing': lambda s: s["report"]["motion"].pop("tilt"),
    r"balance: the key 'spin' is unknown": lambda s: s["report"]["balance"].update(spin=0),
    r"HalfSpace: the key 'layers' is missing": lambda s: s["report"]["body"]["HalfSpace"].pop(
        "layers"
    ),
    r"Elastic: the key 'hue' is unknown": lambda s: s["report"]["body"]["HalfSpace"]["substrate"][
        "Elastic"
    ].update(hue=1),
    r'the value of the key "body" does not fit': lambda s: s["report"].update(body={"Ball": {}}),
    r'the value of the key "grid" does not fit': lambda s: s["report"].update(grid="rigid"),
    r"unknown variant `bored`, expected one of `running`, `converged`": lambda s: s[
        "report"
    ].update(termination="bored"),
    r"pressure must have two dimensions \(nx, ny\), got shape \[3\]": lambda s: s.update(
        pressure=np.zeros(3)
    ),
    r"gap: expected shape \[24, 20\], got \[3, 3\]|gap: expected shape": lambda s: s.update(
        gap=np.zeros((3, 3))
    ),
    r"missing field `kind`": lambda s: s["report"].update(warnings=[{"axis": 0}]),
}


@pytest.mark.parametrize("message", WRONG_INSIDE)
def test_what_is_wrong_inside_is_named(message: str) -> None:
    with pytest.raises(ValueError, match=message):
        nacre.Solution.from_dict(edited(WRONG_INSIDE[message]))


PARTS: dict[str, Any] = {
    r"Sphere: the key 'radius' is missing": {"Sphere": {}},
    r"Sphere: the key 'size' is unknown": {"Sphere": {"radius": 1.0, "size": 2.0}},
    r"Sphere must be a dict of named fields, got 3": {"Sphere": 3},
    r"Sphere: .*number": {"Sphere": {"radius": "wide"}},
    r"Grid: the key 'size' is missing": {"Grid": {"shape": [2, 2], "center": [0, 0]}},
    r"sum must be a list of one shape or more, got \[\]": {"sum": []},
    r"sum must hold shapes, got 1": {"sum": [1, 2]},
    r"shifted must be a list of a shape and two numbers, got \[\]": {"shifted": []},
    r"shifted must hold a shape, got 1": {"shifted": [1, 2, 3]},
}


@pytest.mark.parametrize("message", PARTS)
def test_a_part_that_is_wrong_is_a_value_error(message: str) -> None:
    with pytest.raises(ValueError, match=message):
        values.decode(PARTS[message])


def test_the_name_of_a_layer_is_kept_and_may_be_missing() -> None:
    named = nacre.Layer(STEEL, 1e-6, name="DLC")
    plain = nacre.Layer(STEEL, 1e-6)
    assert values.decode(values.encode(named)) == named
    # As data that were written before layers had names.
    assert "name" not in values.encode(plain)["Layer"]
    assert values.decode(values.encode(plain)) == plain


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"axes": ["z", "q"]}, r'axes must be among \["z", "x", "y"\], got "q"'),
        ({"axes": []}, "axes must name each axis with more or less than one coordinate, got"),
        ({"z": np.array([0.0, np.nan])}, "coordinates of a stress must be finite, got NaN"),
    ],
)
def test_a_stress_with_wrong_axes_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        nacre.types.Stress.from_dict(STRESS.to_dict() | changes)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"traction": np.zeros((2, 3, 3))}, r"traction: expected shape .*, got \[3, 3\]"),
        ({"slip": np.zeros((3, *results.CELLS.shape))}, "2 components, got 3"),
        ({"slip": np.full((2, *results.CELLS.shape), np.nan)}, "slip is not finite at"),
        ({"friction": -1.0}, "friction must be finite and at least 0, got -1"),
    ],
)
def test_friction_with_wrong_fields_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        nacre.types.FrictionSolution.from_dict(solved("slid").to_dict() | changes)


@every_result
def test_numpy_makes_no_array_of_a_result(kind: str) -> None:
    result = RESULTS[kind]
    has_pressure = isinstance(result, nacre.Solution | nacre.types.FrictionSolution)
    name = r"pressure\b" if has_pressure else r"\w+"
    for call in (np.asarray, np.array, np.abs, lambda one: np.asarray([one, one])):
        with pytest.raises(
            TypeError, match=rf"a field of a {type(result).__name__}, such as {name}"
        ):
            call(result)


def test_numpy_makes_no_array_of_what_follows_from_results() -> None:
    history = nacre.types.History([solved("slid")])
    with pytest.raises(TypeError, match="a field of a History, such as "):
        np.asarray(history)
    for result, name in (
        (SOLUTION.gradient("approach"), "Gradient"),
        (SOLUTION.jvp({"load": 1.0}), "Direction, such as pressure"),
        (solved("one"), "IndentSolution, such as pressure"),
        (solved("one").derivatives()["tip.radius"], "StateDerivative"),
        (nacre.indent.Indentation(STEEL, results.ROUND).curve(approach=[1e-8]), "IndentCurve"),
        (solved("fit"), "Fit"),
    ):
        with pytest.raises(TypeError, match=f"a field of a {name}"):
            np.asarray(result)


def test_arrays_of_objects_hold_results() -> None:
    """As columns of pandas do."""
    column = np.empty(2, dtype=object)
    column[:] = [SOLUTION, SUMMARY]
    assert column[0] is SOLUTION
    assert column[1] is SUMMARY
    assert np.array([SOLUTION, SUMMARY], dtype=object)[1] is SUMMARY
