"""Stresses, displacements and strains of layered bodies are those that other programs print."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import nacre
from support import DATA, assert_close

Array = npt.NDArray[np.float64]
PRINTED = json.loads((DATA / "outside.json").read_text(encoding="utf-8"))
ELLEA1, AMADEUS = PRINTED["ellea1"], PRINTED["amadeus"]
CELL = 2.5
"""Side of a cell [mm]. Cells at the edge of a disc have the pressure of their share of it."""
SUB = 32
"""Points along each side of a cell by which its share of a disc is counted."""
DISC = 4e-4
"""Error of a disc of such cells 10 mm below it, over the pressure; it falls as 1/z² or faster."""
QUADRATURE = 2.5e-4
"""Relative error of ELLEA1's integrals; at the surface they are off by 4e-3."""


def half_space(case: dict[str, Any]) -> nacre.HalfSpace:
    layers = [nacre.Layer(nacre.Elastic(e, nu), h) for h, e, nu in case["layers"]]
    return nacre.HalfSpace(nacre.Elastic(*case["base"]), layers)


def loaded(case: dict[str, Any], centres: list[float], extent: tuple[int, int]) -> Any:
    """Return the cells and the pressure of discs about these places on the y axis."""
    grid = nacre.Grid(extent, (extent[0] * CELL, extent[1] * CELL))
    points = (np.arange(SUB) + 0.5) / SUB - 0.5
    x = (grid.x[:, None] + points * CELL).ravel()[:, None]
    y = (grid.y[:, None] + points * CELL).ravel()
    share = np.zeros(extent)
    for centre in centres:
        inside = x**2 + (y - centre) ** 2 < case["radius"] ** 2
        share += inside.reshape(extent[0], SUB, extent[1], SUB).mean(axis=(1, 3))
    return grid, case["pressure"] * share


def beneath(case: dict[str, Any], depths: Any, place: tuple[float, float], load: Any) -> Any:
    """Return stress and displacement at depths beneath a place, above interfaces."""
    grid, pressure = load
    x, y = place
    field = nacre.stress(
        half_space(case), grid, pressure, depths, side="above", x=x, y=y, displacement=True
    )
    return {name: part.ravel() for name, part in (field.components | field.displacement).items()}  # type: ignore[operator]


@pytest.mark.parametrize(
    ("case", "centres", "extent", "names"),
    [
        ("single", [0.0], (121, 121), ["xx", "zz", "uz"]),
        ("dual", [-150.0, 150.0], (121, 241), ["xx", "yy", "zz", "uz"]),
    ],
)
def test_discs_on_layers_are_those_of_ellea1(
    case: str, centres: list[float], extent: tuple[int, int], names: list[str]
) -> None:
    rows = np.array(ELLEA1[case]["rows"])
    field = beneath(ELLEA1, rows[:, 0], (0.0, 0.0), loaded(ELLEA1, centres, extent))
    for k, name in enumerate(names, 1):
        computed = field[name] if name == "uz" else -field[name]
        error = np.abs(computed - rows[:, k]).max()
        assert error < DISC * ELLEA1["pressure"] + 5e-5, name


def test_shear_strains_between_discs_are_those_of_ellea1() -> None:
    rows = np.array(ELLEA1["shear"]["rows"])
    load = loaded(ELLEA1, [-150.0, 150.0], (121, 241))
    field = beneath(ELLEA1, rows[:, 0], (10.0, 20.0), load)
    moduli = [ELLEA1["layers"][0][1:]] * 2 + [ELLEA1["layers"][1][1:]] * 2 + [ELLEA1["base"]]
    compliance = np.array([(1 + nu) / young for young, nu in moduli])
    for k, name in enumerate(["xy", "yz", "xz"], 1):
        bound = 1e6 * compliance * DISC * ELLEA1["pressure"] * (10 / rows[:, 0]) ** 2
        bound += QUADRATURE * np.abs(rows[:, k]) + 5e-5
        assert (np.abs(-1e6 * compliance * field[name] - rows[:, k]) < bound).all(), name


def test_strains_of_a_road_are_those_of_three_programs() -> None:
    load = loaded(AMADEUS, [0.0], (123, 123))
    grid, pressure = load
    (first, *upper), (second, *lower) = AMADEUS["layers"]
    for place, printed in zip((0.0, AMADEUS["radius"]), AMADEUS["strains"], strict=True):
        strains = []
        for depth, side, (young, poisson), across in (
            (first, "above", upper, True),
            (first, "below", lower, False),
            (first + second, "below", AMADEUS["base"], False),
        ):
            field = nacre.stress(
                half_space(AMADEUS),
                grid,
                pressure,
                depth,
                side=side,  # type: ignore[arg-type]
                x=place,
                y=0.0,
            )
            xx, yy, zz = (float(getattr(field, name)) for name in ("xx", "yy", "zz"))
            one, others = (xx, yy + zz) if across else (zz, xx + yy)
            strains.append(-1e6 * (one - poisson * others) / young)
        # The programs differ by one in the fourth digit.
        assert_close(strains, printed, atol=0.15)


# The coated roller of the paper, by a program that shares nothing with nacre.

ROLLER = json.loads((DATA / "coated_roller.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("case", ROLLER["cases"])
def test_coated_rollers_are_those_of_another_program(case: dict[str, float]) -> None:
    young, poisson, load = (ROLLER["body"][name] for name in ("young", "poisson", "load"))
    coat = nacre.Elastic(case["modulus_ratio"] * young, poisson)
    body = nacre.HalfSpace(nacre.Elastic(young, poisson), [nacre.Layer(coat, case["thickness"])])
    shape, size = ROLLER["grid"]["shape"], ROLLER["grid"]["size"]
    solution = nacre.solve(
        nacre.Roller(
            ROLLER["roller"]["radius"], ROLLER["roller"]["flat_length"], ROLLER["roller"]["crown"]
        ),
        body,
        grid=nacre.Grid(shape, size),
        load=load,
        eccentricity=(case["eccentricity"], None),
        tolerance=1e-11,
    )
    assert solution.peak_pressure == pytest.approx(case["peak"], rel=1e-6)
    assert solution.approach == pytest.approx(case["approach"], rel=1e-6)
    assert -solution.tilt[0] == pytest.approx(case["slope"], rel=1e-5, abs=1e-12)
