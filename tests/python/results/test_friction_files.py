"""Solutions with friction come back bit for bit; text shows their numbers."""

from __future__ import annotations

import copy
import csv
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
import results
from bodies import BALL, HELD, STEEL
from nacre.results import values
from results import CONTACT, solved

ROLLED = ("rolled", "line rolled")
PREFIX = {"": 1.0, "m": 1e-3, "µ": 1e-6, "n": 1e-9, "p": 1e-12}
every = pytest.mark.parametrize("kind", results.FRICTION)


def shift_of(solution: nacre.types.FrictionSolution) -> tuple[float, float]:
    assert solution.shift is not None
    return solution.shift


def test_a_history_goes_on_from_a_copy_to_the_bit() -> None:
    solution = solved("slid")
    back = pickle.loads(pickle.dumps(solution))
    first, second = (CONTACT.slide(BALL, force=(-1.0, None), initial=s) for s in (solution, back))
    assert first.traction.tobytes() == second.traction.tobytes()


@every
def test_the_dataset_has_units_and_the_numbers(kind: str) -> None:
    solution = solved(kind)
    dataset = solution.to_xarray()
    rolls = kind in ROLLED
    units = {str(name): dataset[name].attrs["units"] for name in ("x", "y", *dataset.data_vars)}
    assert units == {
        **{"x": "m", "y": "m", "pressure": "Pa", "gap": "m", "normal_displacement": "m"},
        **{"traction": "Pa", "displacement": "m", "slip": "1" if rolls else "m", "stick": "1"},
        **({"friction": "1"} if "cells" in kind else {}),
        **({"coefficients": "m/Pa"} if "given" in kind else {}),
    }
    assert dataset.traction.dims == ("component", "x", "y")
    for component, name in enumerate(dataset.component.values):
        found = dataset.traction.sel(component=name)
        np.testing.assert_array_equal(found, solution.traction[component])
    np.testing.assert_array_equal(dataset.x, solution.x)
    np.testing.assert_array_equal(dataset.stick.astype(bool), solution.stick)
    said = dataset.attrs
    assert said["source"] == f"nacre {nacre.__version__}"
    assert tuple(said["force"]) == solution.force
    assert (said["load"], said["dissipated"]) == (solution.normal.load, solution.dissipated)
    assert (said["termination"], said["violation"], said["tolerance"]) == (
        solution.report.termination,
        solution.report.violation,
        1e-8,
    )
    motion = {"creepage", "spin", "direction"} if rolls else {"shift", "twist"}
    assert {"creepage", "spin", "direction", "shift", "twist"} & said.keys() == motion
    for name in motion:
        assert said[name] == getattr(solution, name)


def test_other_units_change_the_names_of_units_alone() -> None:
    solution = solved("slid")
    with nacre.display_units("N-mm-MPa"):
        dataset = solved("slid").to_xarray()
        assert (dataset.traction.units, dataset.slip.units) == ("MPa", "mm")
        assert dataset.attrs["unit_system"] == "N-mm-MPa"
        assert f"{shift_of(solution)[0] * 1e9:.4g} pm" in str(solution)  # its numbers are mm now
        assert "spin           3 /mm" in str(solved("rolled"))
    np.testing.assert_array_equal(dataset.traction, solution.traction)


# Histories.


@pytest.mark.parametrize("kind", ["slid", "rolled"])
def test_a_history_is_saved_whole_and_goes_on_to_the_bit(kind: str, tmp_path: Path) -> None:
    rolls: dict[str, Any] = {"creepage": (1e-3, None), "direction": "+x"}
    forces: Any = [{"force": (f, 0.1)} for f in (1.0, -1.0, 0.5)]

    def onward(count: int, initial: Any = None) -> Any:
        if kind == "rolled":
            return CONTACT.roll(BALL, **HELD, **rolls, cells=count, initial=initial)
        return CONTACT.slide(BALL, **HELD, steps=forces[:count], initial=initial)

    history = onward(3)
    back = nacre.load(history.save(tmp_path / "a.nc"))
    assert type(back) is nacre.types.History
    from_dict = nacre.types.History.from_dict(history.to_dict())
    for found in (back, pickle.loads(pickle.dumps(history)), copy.deepcopy(history), from_dict):
        assert type(found) is nacre.types.History
        assert found == history
    first, second = (onward(1, begun)[0] for begun in (history[-1], back))
    assert first.traction.tobytes() == second.traction.tobytes()
    dataset = history.to_xarray()
    assert dataset.traction.dims == ("step", "component", "x", "y")
    np.testing.assert_array_equal(dataset.slip[-1], history[-1].slip)
    np.testing.assert_array_equal(dataset.force, [step.force for step in history])
    numbers = nacre.friction.history(history)
    assert set(numbers.data_vars) == {n for n, v in dataset.data_vars.items() if "x" not in v.dims}


def test_a_history_is_a_table_and_a_picture(tmp_path: Path) -> None:
    steps = [{"force": (f, 0.1)} for f in (1.0, -1.0, 0.5)]
    history = CONTACT.slide(BALL, **HELD, steps=steps)
    lines = history.save(tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if line[0] != "#"))
    assert [float(row["force x [N]"]) for row in rows] == [step.force[0] for step in history]
    assert [float(row["torque [N m]"]) for row in rows] == [step.torque for step in history]
    assert history.save(tmp_path / "a.png").stat().st_size > 0
    head, *table = str(history).splitlines()
    assert head.split()[:3] == ["step", "force", "x"]
    assert [line.split()[1] for line in table] == ["1", "-1", "500"]
    for line, step in zip(table, history, strict=True):
        _, *cells = re.split(r"\s{2,}", line.strip())
        assert step.shift is not None
        for cell, number in zip(cells, (*step.force, *step.shift), strict=False):
            value, unit = cell.split(" ± ")[0].split(" ")[:2]
            size = PREFIX[unit[:-1]]
            assert float(value) * size == pytest.approx(number, rel=5e-4, abs=1e-15)
    for word in (word for line in table for word in re.split(r"\s{2,}", line.strip())):
        assert word in history._repr_html_()
    assert repr(history).startswith("<History of 3 steps, the last <FrictionSolution on")


def test_a_history_keeps_what_changes_its_kind_and_its_parts_are_histories(tmp_path: Path) -> None:
    cells = np.full(CONTACT.grid.shape, 0.3)
    for pair in ((0.3, cells), (cells, 0.3)):
        steps: Any = [{"force": (0.5, None), "friction": friction} for friction in pair]
        history = CONTACT.slide(BALL, steps=steps, load=10.0)
        assert nacre.load(history.save(tmp_path / "a.nc")) == history
    for part in (history[:1], history + history[1:], history.copy()):
        assert type(part) is nacre.types.History
        assert nacre.load(part.save(tmp_path / "a.nc")) == part
    assert values.decode(values.encode(history)) == history
    empty = history[:0]
    assert str(empty) == "a history of 0 steps"
    assert "0 steps" in empty._repr_html_()
    assert nacre.types.History.from_dict(empty.to_dict()) == empty
    with pytest.raises(ValueError, match="must hold at least one solution"):
        empty.save(tmp_path / "b.nc")
    other = nacre.slide(BALL, STEEL, STEEL, **HELD, force=(0.5, None))
    with pytest.raises(ValueError, match="must be on one grid"):
        nacre.types.History([*history, other]).to_xarray()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.nc"]


def test_the_load_holds_where_a_history_goes_on() -> None:
    first = nacre.slide(BALL, STEEL, STEEL, load=9.0, friction=0.3, force=(1.0, 0.0))
    onward = nacre.slide(BALL, STEEL, STEEL, friction=0.3, force=(0.5, 0.0), initial=first)
    assert onward.normal.load == pytest.approx(9.0, rel=1e-12)


# Text.


def test_text_shows_the_numbers_with_units() -> None:
    slid, rolled, line = (str(solved(kind)) for kind in ("slid", "rolled", "line slid"))
    for said in ("force          (2 N, 1 N)", "torque         10 µN m", "E 210 GPa, ν 0.3"):
        assert said in slid
    solution = solved("slid")
    stick, all_cells = solution.stick.sum(), (solution.pressure > 0).sum()
    assert solution.report.discretisation is not None
    error = np.ceil(solution.report.discretisation["stick_share"] * all_cells)
    assert f"{stick} ± {error:.0f} of {all_cells} cells stick" in slid
    x, y = shift_of(solution)
    assert f"({x * 1e9:.4g} nm, {y * 1e9:.4g} nm)" in slid
    for said in ("creepage       (0.001, 0.0002)", "spin           3 /m", "towards -x"):
        assert said in rolled
    assert "(0 kN/m, 1 kN/m)" in line
    assert "twist" not in line
    assert "all slips" in str(CONTACT.slide(BALL, **HELD, shift=(1e-3, 0.0)))


@every
def test_every_row_of_the_text_has_its_own_name_and_is_in_the_html(kind: str) -> None:
    solution = solved(kind)
    names = [line.split("  ")[0] for line in str(solution).splitlines()]
    rows = [name for name in names if name and not name.startswith("warning: ")]
    assert len(set(rows)) == len(rows)
    markup = solution._repr_html_()
    for name in rows:
        assert f">{name}</td>" in markup
    nx, ny = solution.grid.shape
    state = "not converged" if kind.startswith("not converged") else "converged"
    pattern = rf"<FrictionSolution on {nx} x {ny} cells: force \(.*, {state}>"
    assert re.fullmatch(pattern, repr(solution))
    assert repr(solution.report).startswith(
        f"<FrictionReport: {solution.report.termination}, {solution.report.convolutions} conv"
    )


def test_coefficients_print_their_errors() -> None:
    creep = nacre.creep_coefficients(STEEL, STEEL, (1e-3, 1e-3))
    assert repr(creep).startswith("<CreepCoefficients: C11 4.29")
    assert [line.split()[0] for line in str(creep).splitlines()] == ["C11", "C22", "C23", "C33"]


def test_listed_numbers_have_names_and_units_everywhere(tmp_path: Path) -> None:
    tried = solved("tried")
    assert str(tried) == "force  (1 N, -2 N)\nshift  333.3 pm"
    assert repr(tried) == "<Tried: force (1 N, -2 N), shift 333.3 pm>"
    assert ">force</td>" in tried._repr_html_()
    source, head, row = tried.save(tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    assert source == f"# source: nacre {nacre.__version__}"
    assert head == "force x [N],force y [N],shift [m]"
    assert row == f"1.0,-2.0,{1e-9 / 3}"
    dataset = tried.to_xarray()
    assert (dataset.force.dims, dataset.force.units) == (("axis",), "N")
    assert dataset["shift"].long_name == "a length"
    creep = solved("creep coefficients").to_xarray()
    assert (creep.shear.units, creep.c11.units, creep.errors.size) == ("Pa", "1", 4)
