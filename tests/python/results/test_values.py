"""Public values pickle, copy and compare, and print as the call that makes them."""

import copy
import functools
import itertools
import json
import pickle
from collections.abc import Callable
from operator import getitem
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
import results
from bodies import BALL, STEEL, quiet
from nacre import fatigue
from nacre._tools.units import written
from nacre.results import values
from nacre.results.base import Fields
from results import solved
from shapes import LOGARITHMIC, SAMPLED
from shapes import VALUES as SHAPES
from support import DATA, python

DLC = nacre.Elastic(young=1e11 / 3, poisson=0.25)
COATED = nacre.HalfSpace(STEEL, layers=[nacre.Layer(DLC, thickness=1e-5 / 3)])
FLOATING = nacre.HalfSpace(
    nacre.RIGID, layers=[nacre.Layer(DLC, 1e-6, "frictionless"), nacre.Layer(STEEL, 1e-3)]
)
GRID = nacre.Grid(shape=(48, 50), size=(4e-4, 4.1e-4))
SMALL = nacre.Grid(shape=(16, 12), size=(4e-4, 4.1e-4))
THIRDS = np.arange(12).reshape(3, 4) / 3e6  # no finite number of decimals gives them
SOLUTION = nacre.solve(BALL, COATED, load=10.0, grid=GRID)
SLID = nacre.slide(BALL, COATED, STEEL, load=10.0, grid=GRID, friction=0.1, force=(0.3, None))
SUMMARY = SOLUTION.stress_summary(strength={0: 1e9}, threads=1)
ASSESSED = quiet(fatigue.assess, SOLUTION, depths=[1e-5, *COATED.interfaces], threads=1)

MADE_BY_A_CALL: dict[str, Any] = {
    "elastic": STEEL,
    "layer": nacre.Layer(DLC, thickness=1e-5 / 3),
    "frictionless layer": nacre.Layer(DLC, thickness=1e-5 / 3, interface="frictionless"),
    "named layer": nacre.Layer(DLC, thickness=1e-5 / 3, name="DLC"),
    "layer of an odd name": nacre.Layer(DLC, thickness=1e-5 / 3, name='it\'s 2\\3 "µm"'),
    "spring": nacre.Spring(1e15 / 3, 1e14 / 7),
    "spring along": nacre.Spring(tangential=0.0),
    "layer on springs": nacre.Layer(DLC, 1e-5 / 3, nacre.Spring(normal=1e15 / 3)),
    "rigid": nacre.RIGID,
    "free": nacre.FREE,
    "plate": nacre.HalfSpace(nacre.FREE, [nacre.Layer(DLC, 1e-3 / 3)]),
    "half-space": nacre.HalfSpace(STEEL),
    "coated": COATED,
    "two layers on a rigid base": FLOATING,
    "body with two ends": nacre.HalfSpace(STEEL, ends=(-1e-2 / 3, 1e-2 / 7)),
    "coated body with one end": nacre.HalfSpace(STEEL, COATED.layers, ends=(None, 1e-2 / 3)),
    "grid": GRID,
    "grid off the origin": nacre.Grid(shape=(48, 50), size=(4e-4, 4.1e-4), center=(-1e-3 / 7, 0.1)),
    "line grid": nacre.Grid.line(cells=48, width=1e-3 / 3, center=1e-4 / 7),
    **SHAPES,
    "logarithmic profile": LOGARITHMIC,
    "sampled profile": SAMPLED,
    "point contact": nacre.hertz.Point(5e-3, 1e11 / 3, 10.0),
    "line contact": nacre.hertz.Line(5e-3, 1e11 / 3, 1e4 / 3),
    "ellipse": nacre.hertz.Ellipse(5e-3, None, 1e11 / 3, 10.0, counter_radius_y=0.1 / 3),
    "shifted": BALL.shifted(1e-3 / 3, -2e-3),
    "sum": BALL + nacre.FlatPunch(1e-3),
    "sum of three": (BALL + nacre.FlatPunch(1e-3)) + nacre.Cylinder(5e-3),
    "shifted sum": (BALL + nacre.FlatPunch(1e-3)).shifted(1e-3, 0.0),
    "sum of shifted": BALL.shifted(1e-3, 0.0) + nacre.FlatPunch(1e-3).shifted(0.0, 1e-3),
    "contact": nacre.Contact(STEEL, GRID),
    "contact with everything": nacre.Contact(
        COATED,
        SMALL,
        FLOATING,
        coefficients=nacre.influence_coefficients(COATED, SMALL, "image", 2),
        threads=1,
    ),
}
NOT_KEPT = {"point contact", "line contact", "ellipse", "contact", "contact with everything"}
WORN = nacre.wear(
    nacre.Sphere(5e-3), STEEL, grid=nacre.Grid((32, 32), (3e-4, 3e-4)), load=10.0, rate=1e-16,
    sliding=1.0, steps=1,
)  # fmt: skip
VALUES = MADE_BY_A_CALL | {
    "wear history": WORN,
    "wear state": WORN.states[-1],
    "wear report": WORN.report,
    "wear through": nacre.types.WearThrough(2e3, (0.0, 1e-4), 0, "DLC", "body"),
    "solution": SOLUTION,
    "response": nacre.Response(lambda alpha: 1e-12 / alpha, local=1e-13),
    "convolution": nacre.Convolution(THIRDS, threads=2),
    "report": SOLUTION.report,
    "stress": SOLUTION.stress(
        [0.0, 1e-6], y=0.0, friction=0.1, direction=(1.0, 0.0), displacement=True
    ),
    "stress plan": SOLUTION.stress_plan(threads=1),
    "gradient": SOLUTION.gradient("peak_pressure"),
    "weighted gradient": SOLUTION.vjp(np.ones((48, 50)), ["load"]),
    "direction": SOLUTION.jvp({"load": 1.0}),
    "card": nacre.materials["TiN"],
    "number of a card": nacre.materials["TiN"].numbers["young"],
    "friction solution": SLID,
    "friction report": SLID.report,
    "stress summary": SUMMARY,
    "layer stress": SUMMARY.layers[0],
    "interface stress": SUMMARY.interfaces[0],
    "verdict": SUMMARY.verdict(),
    "fatigue summary": ASSESSED,
    "layer fatigue": ASSESSED.layers[-1],
    "interface fatigue": ASSESSED.interfaces[0],
}

OF_OTHERS = {"indentation"}
"""Attributes that are other objects, without an equality."""
DEPRECATED = {"is_identifiable", "l10"}
"""Old names, which warn."""
PLAIN = {int, float, str, bool, type(None), np.ndarray}


@pytest.fixture(params=[*VALUES, *results.RESULTS])
def value(request: pytest.FixtureRequest) -> Any:
    """Return each value, and each result."""
    name = request.param
    return VALUES[name] if name in VALUES else solved(name)


def public_classes() -> set[type]:
    public = (getattr(module, name) for module in (nacre, nacre.types) for name in module.__all__)
    found = {c for c in public if isinstance(c, type) and not issubclass(c, BaseException)}
    return found - {nacre.types.Shape, nacre.types.History}  # a base, and a list


def attributes(value: object) -> dict[str, Any]:
    names = [name for name in dir(value) if not name.startswith("_") and name not in DEPRECATED]
    return {name: getattr(value, name) for name in names if not callable(getattr(value, name))}


def test_every_public_class_has_a_value_here() -> None:
    made = [*VALUES.values(), *map(solved, results.LISTED)]
    assert public_classes() - {type(value) for value in made} == set()


def leaves(data: Any) -> set[type]:
    if isinstance(data, dict):
        assert all(isinstance(key, str) for key in data)
        return set().union(*map(leaves, data.values()))
    if isinstance(data, list):
        return set().union(*map(leaves, data))
    return {type(data)}


def states(value: Any) -> list[Any]:
    """Return what comes back from the plain data of a result."""
    state = value.to_dict()
    before = repr(state)
    assert (state["format"], state["nacre"]) == (values.FORMAT, nacre.__version__)
    assert state["kind"] == type(value).__name__
    nested = {name: part for name, part in state.items() if not isinstance(part, dict)}
    assert leaves(nested if "normal" in state else state) <= PLAIN
    back = [type(value).from_dict(state)]
    if type(value) is not nacre.types.WearHistory:  # its arrays are not written as text
        back.append(values.decode(json.loads(json.dumps(values.encode(value)))))
    assert repr(state) == before  # reading leaves it alone
    return back


def test_it_comes_back_to_the_bit_and_is_like_nothing_else(value: Any, tmp_path: Path) -> None:
    pickles = [pickle.dumps(value, protocol) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
    copies = [*map(pickle.loads, pickles), copy.copy(value), copy.deepcopy(value)]
    if hasattr(value, "to_dict"):
        copies += states(value)
    if hasattr(value, "save"):
        copies.append(nacre.load(value.save(tmp_path / "a.nc")))
        copies.append(pickle.loads(pickle.dumps(copies[-1])))
        assert [path.name for path in tmp_path.iterdir()] == ["a.nc"]
    own = attributes(value)
    for back in copies:
        assert type(back) is type(value)
        assert back == value
        assert (repr(back), str(back)) == (repr(value), str(value))
    for back in (copies[pickle.HIGHEST_PROTOCOL], copies[-1]):
        for name, attribute in attributes(back).items():
            if name not in OF_OTHERS:
                np.testing.assert_equal(attribute, own[name], err_msg=name)
                if isinstance(attribute, np.ndarray):
                    assert attribute.tobytes() == own[name].tobytes(), name
    for name, attribute in own.items():
        with pytest.raises(AttributeError):
            setattr(value, name, attribute)
    assert value != repr(value)
    assert value != 1.0
    assert value != None  # noqa: E711
    try:
        digest = hash(value)
    except TypeError:
        return
    assert hash(copies[-1]) == digest
    with np.printoptions(precision=2):
        assert hash(value) == digest


def test_a_problem_comes_back_and_is_solved_alike(tmp_path: Path) -> None:
    sticky = solved("sticky")
    back = nacre.load(sticky.save(tmp_path / "a.nc"))
    np.testing.assert_array_equal(back.state.load, sticky.load)


STATES = json.loads((DATA / "states_0_1_0.json").read_text(encoding="utf-8"))["states"]
"""States that version 0.1.0 wrote, before its release."""
STORED: dict[str, tuple[Callable[[Any], object], tuple[Any, ...]]] = {
    "creep_coefficients": (lambda one: one.c11, ("c11",)),
    "life": (lambda one: one.l10r, ("revolutions",)),  # those of L_10r, in millions
    "one": (lambda one: one.radius, ("radius",)),
    "maugis": (lambda one: one.outer_radius, ("outer_radius",)),
    "volume": (lambda one: one.integral, ("integral",)),
    "shakedown_map": (lambda one: one.limits, ("limits",)),
    "fatigue": (lambda one: one.layers[0].depths, ("layers", 0, "depths")),
    "summary": (
        lambda one: one.to_dict()["layers"][0]["von_mises"]["value"],
        ("layers", 0, "von_mises", "value"),
    ),
    "balls": (lambda one: one.loads, ("loads",)),
    "line": (lambda one: one.pressure, ("pressure",)),
}


@pytest.mark.parametrize("name", STATES)
def test_states_of_0_1_0_are_read_with_their_numbers(name: str) -> None:
    result = values.decode(STATES[name])
    number, keys = STORED[name]
    np.testing.assert_array_equal(number(result), functools.reduce(getitem, keys, STATES[name]))
    assert type(result).from_dict(result.to_dict()) == result
    assert str(result)


def test_a_notebook_shows_every_result_as_a_table() -> None:
    hard = nacre.HalfSpace(STEEL)
    test = nacre.indent.Indentation(hard, nacre.indent.Tip.paraboloid(1e-5))
    state = test.at(load=[1e-3, 2e-3])
    shown = [
        *VALUES.values(),
        *map(solved, results.LISTED),
        state.derivatives(["body.substrate.young"])["body.substrate.young"],
        test.curve(approach=[1e-8, 2e-8]),
        nacre.indent.Indentation(
            hard, nacre.indent.Tip.paraboloid(1e-5), adhesion=nacre.indent.Adhesion.jkr(0.05)
        ).pull_off(),
    ]
    for result in shown:
        if isinstance(result, Fields) and not isinstance(result, nacre.types.Verdict):
            table = result._repr_html_()
            assert table.count("<tr>") > 1, result
            assert "array(" not in table, result
    layer = SUMMARY.layers[0]
    assert written(layer.von_mises[0], "Pa") in layer._repr_html_()


@pytest.mark.parametrize("value", MADE_BY_A_CALL.values(), ids=MADE_BY_A_CALL.keys())
def test_repr_is_the_call_that_makes_it(value: object) -> None:
    back = eval(repr(value), {"array": np.array, "inf": np.inf} | vars(nacre) | vars(nacre.hertz))
    assert back == value


@pytest.mark.parametrize("name", sorted(MADE_BY_A_CALL.keys() - NOT_KEPT))
def test_values_survive_as_plain_data(name: str) -> None:
    data = json.loads(json.dumps(values.encode(MADE_BY_A_CALL[name])))
    assert values.decode(data) == MADE_BY_A_CALL[name]


def test_different_values_differ() -> None:
    for a, b in itertools.permutations([*VALUES.values(), *map(solved, results.RESULTS)], 2):
        assert a != b
        assert not a == b


SIGNED_ZEROS: list[tuple[Any, Any]] = [
    (nacre.HalfSpace(STEEL, ends=(0.0, 1.0)), nacre.HalfSpace(STEEL, ends=(-0.0, 1.0))),
    (nacre.Elastic(1.0, 0.0), nacre.Elastic(1.0, -0.0)),
    (nacre.Grid((2, 2), (1.0, 1.0)), nacre.Grid((2, 2), (1.0, 1.0), (-0.0, 0.0))),
    (nacre.Grid.line(2, 1.0), nacre.Grid.line(2, 1.0, -0.0)),
    (nacre.Roller(1.0, 0.0, 1.0), nacre.Roller(1.0, -0.0, 1.0)),
    (nacre.LogarithmicProfile(1.0, 1.0, 0.0), nacre.LogarithmicProfile(1.0, 1.0, -0.0)),
    (BALL.shifted(0.0, 1.0), BALL.shifted(-0.0, 1.0)),
    (nacre.HeightMap(np.zeros((2, 2)), 1.0), nacre.HeightMap(-np.zeros((2, 2)), 1.0)),
    (
        nacre.HeightMap(np.zeros((2, 2)), 1.0, center=(0.0, 0.0)),
        nacre.HeightMap(np.zeros((2, 2)), 1.0, center=(0.0, -0.0)),
    ),
]


@pytest.mark.parametrize(("zero", "minus"), SIGNED_ZEROS, ids=range(len(SIGNED_ZEROS)))
def test_the_sign_of_zero_does_not_tell_values_apart(zero: object, minus: object) -> None:
    assert zero == minus
    assert hash(zero) == hash(minus)


def test_sums_and_shifts_are_one_list() -> None:
    punch, cylinder = nacre.FlatPunch(1e-3), nacre.Cylinder(5e-3)
    assert BALL + (punch + cylinder) == (BALL + punch) + cylinder
    assert hash(BALL + (punch + cylinder)) == hash((BALL + punch) + cylinder)
    moved = (BALL.shifted(1e-3, 0.0) + punch).shifted(0.0, 2e-3)
    assert moved == BALL.shifted(1e-3, 2e-3) + punch.shifted(0.0, 2e-3)
    assert BALL.shifted(0.0, 0.0) == BALL
    assert hash(BALL.shifted(0.0, 0.0)) == hash(BALL)
    assert BALL + punch != punch + BALL
    # As studies and files of two parts have them.
    assert values.decode({"sum": [values.encode(BALL), values.encode(punch)]}) == BALL + punch


SUMS = """
import functools, operator, pickle, nacre
from nacre._tools.units import written
from nacre.results import values
from nacre.results.base import Fields

part = nacre.Paraboloid(1.0, 1.0)
grid = nacre.Grid((8, 8), (1e-3, 1e-3))
contact = nacre.Contact(nacre.Elastic(1e9, 0.3), grid)
for make in (operator.add, lambda a, b: b + a, lambda a, b: a.shifted(1e-9, 0.0) + b):
    many = functools.reduce(make, [part] * 100_000)
    assert contact.solve(many, load=1.0).report.converged
    del many
moved = functools.reduce(lambda shape, _: shape.shifted(1e-9, 0.0), range(100_000), part)
assert repr(moved).count("shifted") == 1
some = functools.reduce(operator.add, [part] * 5000)
for protocol in (0, 5):
    assert pickle.loads(pickle.dumps(some, protocol)) == some
assert values.decode(values.encode(some)) == some
print(hash(some) == hash(functools.reduce(operator.add, [part] * 5000)))
"""


@pytest.mark.slow
def test_a_hundred_thousand_shapes_can_be_added() -> None:
    # In a process of its own: without lists, recursion ends the process.
    run = python("-c", SUMS)
    assert (run.returncode, run.stdout) == (0, "True\n"), run.stderr


def test_rigid_is_one_object() -> None:
    assert copy.deepcopy(nacre.RIGID) is nacre.RIGID
    assert copy.deepcopy(nacre.FREE) is pickle.loads(pickle.dumps(nacre.FREE)) is nacre.FREE
    assert pickle.loads(pickle.dumps(nacre.RIGID)) is nacre.RIGID
    assert FLOATING.substrate is nacre.RIGID


def test_numbers_are_kept_to_the_bit() -> None:
    heights = nacre.HeightMap(THIRDS, spacing=(0.1, 0.7), center=(1e-6, -2e-6))
    assert heights.spacing == (0.1, 0.7)
    assert heights.center == (1e-6, -2e-6)
    np.testing.assert_array_equal(heights.heights, THIRDS)
    assert (DLC.young, DLC.poisson) == (1e11 / 3, 0.25)
    assert GRID.size == (4e-4, 4.1e-4)


def test_a_pickled_plan_solves_alike() -> None:
    contact = nacre.Contact(COATED, GRID)
    back = pickle.loads(pickle.dumps(contact))
    np.testing.assert_array_equal(
        back.solve(BALL, load=10.0).pressure, contact.solve(BALL, load=10.0).pressure
    )


def test_a_convergence_error_pickles_with_its_solution() -> None:
    with pytest.raises(nacre.ConvergenceError) as caught:
        nacre.solve(BALL, COATED, load=10.0, grid=GRID, max_iterations=3)
    back = pickle.loads(pickle.dumps(caught.value))
    assert str(back) == str(caught.value)
    assert back.solution == caught.value.solution


def test_a_solution_prints_what_was_solved() -> None:
    rigid = repr(SOLUTION)
    elastic = repr(nacre.solve(BALL, COATED, STEEL, load=10.0, grid=GRID))
    for text in (rigid, elastic):
        assert "48" in text
        assert "converged" in text
        assert "counterbody" in text
    assert "rigid" in rigid.lower()
    assert "rigid" not in elastic.lower()


@pytest.mark.parametrize("kind", ["TableResult", "Shown", "Result", "", None, ["Solution"]])
def test_a_kind_that_is_no_result_is_refused(kind: Any) -> None:
    with pytest.raises(ValueError, match="must name a result of nacre"):
        values.decode(values.heading("") | {"kind": kind})
