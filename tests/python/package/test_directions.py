"""A direction is a pair of components or an axis, wherever one is taken."""

from __future__ import annotations

from typing import Any

import pytest

import nacre
from bodies import BALL, COATED, STEEL, quiet
from nacre import fatigue, plot
from nacre.case import Case

GRID = nacre.Grid((24, 24), (3e-4, 3e-4))
SOLUTION = quiet(nacre.solve, BALL, COATED, load=5.0, grid=GRID)
AXES: dict[str, tuple[float, float]] = {
    **{"+x": (1.0, 0.0), "-x": (-2.0, 0.0)},
    **{"+y": (0.0, 1.0), "-y": (0.0, -0.5)},
}


def stresses(direction: Any) -> list[Any]:
    sliding: dict[str, Any] = {"friction": 0.2, "direction": direction}
    output = {"stress": "xx", "interface": 0, **sliding}
    plan = SOLUTION.stress_plan()
    return [
        quiet(SOLUTION.stress_summary, **sliding),
        quiet(plan.summary, **sliding),
        quiet(plan.stress, 1e-6, **sliding).to_dict(),
        quiet(nacre.stress, COATED, GRID, SOLUTION.pressure, 1e-6, **sliding).peak(),
        quiet(SOLUTION.gradient, output).value,
        quiet(fatigue.assess, SOLUTION, **sliding),
    ]


@pytest.mark.parametrize(("axis", "pair"), AXES.items())
def test_stresses_take_both_forms(axis: str, pair: tuple[float, float]) -> None:
    (*words, assessed), (*pairs, expected) = stresses(axis), stresses(pair)
    for word, number in zip(words[:2], pairs[:2], strict=True):
        assert word == number
    assert words[3:] == pairs[3:]
    assert assessed.to_dict().keys() == expected.to_dict().keys()
    assert assessed.peak_pressure == expected.peak_pressure
    other = "-x" if axis != "-x" else "+x"
    assert quiet(SOLUTION.stress_summary, friction=0.2, direction=other) != words[0]


@pytest.mark.parametrize(("axis", "pair"), AXES.items())
def test_rolling_takes_both_forms(axis: Any, pair: tuple[float, float]) -> None:
    motion: dict[str, Any] = {"friction": 0.3, "creepage": (1e-3, 0.0), "load": 5.0, "grid": GRID}

    def rolled(direction: Any) -> Any:
        return quiet(nacre.roll, BALL, STEEL, STEEL, **motion, direction=direction, tolerance=1e-3)

    word, number = rolled(axis), rolled(pair)
    assert word == number
    assert word.direction == number.direction == axis


def test_case_files_take_both_forms() -> None:
    case: dict[str, Any] = {
        "shape": {"kind": "sphere", "radius": 5e-3},
        "body": {"substrate": {"young": 2e11, "poisson": 0.3}},
        "solve": {"load": 5.0},
        "stress": {"friction": 0.1, "direction": "+y"},
    }
    asked = Case(case).stress()
    assert asked is not None
    assert asked["direction"] == "+y"
    roll = {"friction": 0.1, "creepage": {"along": 1e-3}, "direction": [0.0, 1.0]}
    rolling = {name: case[name] for name in ("shape", "body", "solve")} | {"roll": roll}
    assert Case(rolling | {"counterbody": case["body"]})


@pytest.mark.parametrize("direction", ["x", "+z", (1, 1), (0, 0), (1, 2, 3), 1.0])
def test_other_directions_are_refused(direction: Any) -> None:
    if isinstance(direction, str):
        with pytest.raises(ValueError, match='"-x", "\\+y" or "-y", got'):
            SOLUTION.stress(1e-6, friction=0.1, direction=direction)
    with pytest.raises((TypeError, ValueError), match="direction must be"):
        nacre.roll(BALL, STEEL, STEEL, load=5.0, friction=0.1, spin=1.0, direction=direction)


def test_pictures_need_no_direction_where_the_summary_needs_none() -> None:
    assert SOLUTION.stress_summary(friction=0.1) == SOLUTION.stress_summary(
        friction=0.1, direction="+x"
    )
    plot.stress_section(SOLUTION, friction=0.1, rows=4)
    plot.stress_depth(SOLUTION, friction=0.1)
    plot.interface_map(SOLUTION, friction=0.1)
