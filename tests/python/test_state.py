"""Results have a named state: plain data, exact, refused where a key is wrong."""

import copy
import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import nacre
from nacre import values
from nacre._disk import write_dataset
from nacre._journal import Journal

STEEL = nacre.Elastic(210e9, 0.3)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(420e9, 0.25), 2e-5)])
GRID = nacre.Grid((24, 20), (3e-4, 2e-4), (1e-5, -2e-6))
SOLUTION = nacre.solve(
    nacre.Sphere(5e-3), COATED, STEEL, grid=GRID, load=10.0, tilt=(None, 1e-4), tolerance=1e-6
)
SUMMARY = SOLUTION.stress_summary(yield_stress={0: 2e9})
RESULTS: dict[str, Any] = {
    "Solution": SOLUTION,
    "Report": SOLUTION.report,
    "Stress": SOLUTION.stress(
        [0.0, 1e-5], x=0.0, friction=0.1, direction=(1.0, 0.0), displacement=True
    ),
    "StressSummary": SUMMARY,
    "LayerStress": SUMMARY.layers[1],
    "InterfaceStress": SUMMARY.interfaces[0],
}

every_result = pytest.mark.parametrize("kind", RESULTS)


def leaves(data: Any) -> set[type]:
    if isinstance(data, dict):
        assert all(isinstance(key, str) for key in data)
        return set().union(*map(leaves, data.values()))
    if isinstance(data, list):
        return set().union(*map(leaves, data))
    return {type(data)}


@every_result
def test_a_state_is_plain_data(kind: str) -> None:
    state = RESULTS[kind].to_dict()
    assert (state["format"], state["nacre"]) == (values.FORMAT, nacre.__version__)
    assert state["kind"] == kind
    assert leaves(state) <= {int, float, str, bool, type(None), np.ndarray}


@every_result
def test_a_state_gives_the_result_back(kind: str) -> None:
    result = RESULTS[kind]
    assert type(result).from_dict(result.to_dict()) == result


@every_result
def test_json_gives_the_result_back(kind: str) -> None:
    data = json.loads(json.dumps(values.encode(RESULTS[kind])))
    assert values.decode(data) == RESULTS[kind]


@every_result
def test_reading_leaves_the_state_alone(kind: str) -> None:
    state = RESULTS[kind].to_dict()
    before = repr(state)
    type(RESULTS[kind]).from_dict(state)
    assert repr(state) == before


@every_result
def test_pickles_hold_the_named_state(kind: str) -> None:
    make, (state,) = RESULTS[kind].__reduce__()
    assert make(state) == RESULTS[kind]
    assert state["format"] == values.FORMAT
    assert pickle.loads(pickle.dumps(RESULTS[kind])) == RESULTS[kind]


@every_result
def test_a_newer_format_is_refused_by_the_version_that_wrote_it(kind: str) -> None:
    state = RESULTS[kind].to_dict() | {"format": values.FORMAT + 1, "nacre": "7.3.1"}
    message = rf"{kind} has format 2, written by nacre 7\.3\.1; .* install a newer version"
    with pytest.raises(ValueError, match=message):
        type(RESULTS[kind]).from_dict(state)


LATER = {"rolling_direction", "uncertainty"}
"""Keys that states of format 1 did not have at first: without them they are None."""


@every_result
def test_a_missing_key_is_named(kind: str) -> None:
    for key in RESULTS[kind].to_dict().keys() - LATER:
        state = RESULTS[kind].to_dict()
        del state[key]
        with pytest.raises(ValueError, match=rf'{kind}: the key "{key}" is missing'):
            type(RESULTS[kind]).from_dict(state)


@every_result
def test_a_foreign_key_is_named(kind: str) -> None:
    state = RESULTS[kind].to_dict() | {"colour": "red"}
    with pytest.raises(ValueError, match=rf"{kind}: the key 'colour' is unknown"):
        type(RESULTS[kind]).from_dict(state)


@every_result
def test_a_value_that_does_not_fit_is_refused(kind: str) -> None:
    for key in RESULTS[kind].to_dict():
        with pytest.raises(ValueError, match=key):
            type(RESULTS[kind]).from_dict(RESULTS[kind].to_dict() | {key: object()})


@every_result
def test_another_kind_is_refused(kind: str) -> None:
    state = RESULTS[kind].to_dict() | {"kind": "Sandwich"}
    with pytest.raises(ValueError, match=rf'"kind" must be "{kind}", got "Sandwich"'):
        type(RESULTS[kind]).from_dict(state)
    with pytest.raises(ValueError, match="must name a result of nacre, got 'Sandwich'"):
        values.decode(state)


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
    r'"running", "converged", "iteration limit" or "stopped", got "bored"': lambda s: s[
        "report"
    ].update(termination="bored"),
    r'the array of the key "pressure" has the wrong number of dimensions: shape \[3\]': lambda s: (
        s.update(pressure=np.zeros(3))
    ),
    r"gap: expected shape \[24, 20\], got \[3, 3\]|gap: expected shape": lambda s: s.update(
        gap=np.zeros((3, 3))
    ),
    r'the key "kind" is missing': lambda s: s["report"].update(warnings=[{"axis": 0}]),
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


def test_a_newer_file_is_refused_by_the_version_that_wrote_it(tmp_path: Path) -> None:
    path = SOLUTION.save(tmp_path / "a.nc")
    dataset = xarray.load_dataset(path, engine="h5netcdf")
    state = json.loads(dataset.attrs["nacre_solution"]) | {"format": 2, "nacre": "7.3.1"}
    dataset.attrs["nacre_solution"] = json.dumps(state)
    write_dataset(dataset, tmp_path / "b.nc")
    with pytest.raises(ValueError, match=r"b\.nc.* has format 2, written by nacre 7\.3\.1"):
        nacre.load(tmp_path / "b.nc")


def test_a_newer_journal_is_refused_by_the_version_that_wrote_it(tmp_path: Path) -> None:
    path = tmp_path / "study.journal"
    with Journal(path) as journal:
        journal.add({"key": "a", "values": {}})
    head, record = path.read_text().splitlines()
    assert head == f"nacre {nacre.__version__}, journal of format 1"
    checksum, _, text = record.partition(" ")
    assert len(checksum) == 16
    assert json.loads(text) == {"key": "a", "values": {}}
    with Journal(path) as journal:
        assert journal.records == {"a": {"key": "a", "values": {}}}
    newer = f"nacre 7.3.1, journal of format 2\n{record}\n"
    path.write_text(newer)
    with pytest.raises(ValueError, match=r"has format 2, written by nacre 7\.3\.1"), Journal(path):
        pass
    assert path.read_text() == newer


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
        nacre.types.Stress.from_dict(RESULTS["Stress"].to_dict() | changes)
