"""Contacts on grids agree with exact indentations within the errors that they state."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre.indent import Indentation, Tip

DATA = Path(__file__).parents[1] / "data/axisym.json"
CASES = json.loads(DATA.read_text(encoding="utf-8"))["cases"]
ROUND = [case for case in CASES if case["tip"]["kind"] in ("paraboloid", "sphere")]


def body_of(case: dict[str, Any]) -> nacre.HalfSpace:
    def material(of: dict[str, Any]) -> nacre.Elastic:
        return nacre.Elastic(of["young"], of["poisson"])

    base = case["substrate"]
    layers = [
        nacre.Layer(material(layer), layer["thickness"], interface=layer["interface"])
        for layer in case["layers"]
    ]
    return nacre.HalfSpace(nacre.RIGID if base == "rigid" else material(base), layers)


@pytest.mark.filterwarnings("ignore:the contact is not small")  # both take half-spaces
@pytest.mark.parametrize("case", ROUND, ids=[case["name"] for case in ROUND])
def test_approach_and_central_pressure(case: dict[str, Any]) -> None:
    body, radius = body_of(case), case["tip"]["R"]
    is_sphere = case["tip"]["kind"] == "sphere"
    tip = Tip.sphere(radius) if is_sphere else Tip.paraboloid(radius)
    shape = nacre.Sphere(radius) if is_sphere else nacre.Paraboloid(radius, radius)
    a = case["rows"][len(case["rows"]) // 2]["a"]
    exact = Indentation(body, tip).at(radius=a)
    grid = nacre.Grid(shape=(256, 256), size=(2.4 * a, 2.4 * a))
    solution = nacre.solve(shape, body, load=exact.load, grid=grid)
    stated = solution.report.discretisation
    assert stated is not None
    assert stated["peak_pressure"] is not None
    assert abs(solution.approach - exact.approach) < stated["approach"] < 1e-3 * exact.approach
    # The centres of the four cells in the middle are half a cell off both axes.
    centre = exact.pressure(np.hypot(*grid.spacing) / 2)
    pressure = solution.pressure[127:129, 127:129].mean()
    assert abs(pressure - centre) < stated["peak_pressure"] < 1e-3 * centre


def test_the_cases_are_those_of_the_file() -> None:
    assert len(ROUND) == 10
