"""The printed digits of CONTACT's examples, in N, mm and MPa.

CONTACT solves the same discrete problem: piecewise constant tractions on the same cells, and steady
rolling to first order in them. What differs is said at each example.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import quiet
from support import assert_close

PRINTED: dict[str, Any] = json.loads(
    (Path(__file__).parents[2] / "data" / "friction" / "contact_examples.json").read_text()
)
STEEL = nacre.Elastic(2 * 82e3 * 1.28, 0.28)
ALUMINIUM = nacre.Elastic(2 * 23e3 * 1.31, 0.31)
DIGITS = 6e-4
"""Half of the last of four digits."""


def test_carter_and_fromm_on_a_line() -> None:
    printed, length = PRINTED["carter2d"], 200.0
    line_load, friction = 35780.0 / length, 0.3
    solution = nacre.roll(
        nacre.Cylinder(500.0),
        STEEL,
        STEEL,
        grid=nacre.Grid.line(55, 55 * 0.04, center=0.03),
        load=line_load,
        friction=friction,
        creepage=(-2.4e-4, None),
        order=1,
    )
    first, pressure = printed["first_pressed"], np.zeros(55)
    pressure[first : first + 50] = printed["pressure"]
    # CONTACT's cells are 200 mm long, not endless.
    assert_close(solution.pressure[0], pressure, atol=1e-4 * printed["peak"])
    traction = solution.traction[1, 0][printed["first_sticking"] : first + 50]
    assert_close(np.abs(traction), printed["traction"], rtol=6e-3, each=True)
    assert solution.stick.sum() == printed["stick"]
    assert np.abs(solution.force[1]) == pytest.approx(printed["force"] / length, rel=DIGITS)
    assert solution.dissipated == pytest.approx(printed["power"] / length, rel=DIGITS)
    # A load on 200 mm sinks to zero at infinity, nacre's at the width of the grid: both surfaces
    # differ by the displacement 2 W' (1 - nu²)/(pi E) log(200/2.2).
    compliance = line_load / (np.pi * STEEL.plane_strain_modulus)
    datum = 2 * 2 * compliance * np.log(length / (55 * 0.04))
    assert solution.normal.approach + datum == pytest.approx(printed["approach"], rel=DIGITS)


@pytest.mark.filterwarnings("ignore:the coefficient of friction is 10")  # its second row
@pytest.mark.parametrize("printed", PRINTED["bentall"])
def test_bentall_and_johnson(printed: dict[str, float]) -> None:
    load, friction = 16.2019, printed["friction"]
    solution = nacre.roll(
        nacre.Cylinder(25.0),
        ALUMINIUM,
        STEEL,
        grid=nacre.Grid.line(216, 0.216),
        load=load,
        friction=friction,
        force=(printed["ratio"] * friction * load, None),
        order=1,
    )
    assert solution.creepage is not None
    assert solution.creepage[0] == pytest.approx(printed["creepage"], rel=DIGITS)
    assert solution.normal.peak_pressure == pytest.approx(printed["peak"], rel=DIGITS)
    assert np.count_nonzero(solution.pressure) == printed["pressed"]
    assert solution.stick.sum() == printed["stick"]
    assert solution.dissipated == pytest.approx(printed["power"] / 1e3, rel=DIGITS, abs=1e-12)


def test_from_cattaneo_to_carter() -> None:
    printed = PRINTED["cattaneo_to_carter"]
    body, load, friction = nacre.Elastic(2 * 1.28, 0.28), 0.4705, 0.4013
    ball = nacre.Paraboloid(1 / (2 * 0.002963), 1 / (2 * 0.002963))
    contact = nacre.Contact(body, nacre.Grid((33, 33), (8.25, 8.25)), body)
    pulled: dict[str, Any] = {
        "load": load,
        "friction": friction,
        "force": (0.657 * friction * load, None),
    }
    shifted = contact.slide(ball, **pulled)
    assert shifted.normal.peak_pressure == pytest.approx(printed["peak"], rel=DIGITS)
    assert shifted.normal.approach == pytest.approx(printed["approach"], rel=DIGITS)
    assert np.count_nonzero(shifted.pressure) == printed["pressed"]
    assert shifted.shift[0] == pytest.approx(printed["shift"], rel=DIGITS)
    assert shifted.stick.sum() == printed["stick"]
    assert shifted.dissipated == pytest.approx(printed["work"], rel=DIGITS)
    cells = printed["steps"][-1]["cells"]
    rolled = contact.roll(ball, **pulled, cells=cells, direction="+x", order=1, initial=shifted)
    for step in printed["steps"]:
        solution = rolled[step["cells"] - 1]
        assert solution.creepage[0] == pytest.approx(step["creepage"], rel=DIGITS)
        assert solution.stick.sum() == step["stick"]
        assert solution.dissipated == pytest.approx(step["power"], rel=DIGITS)


def test_the_creep_curve_of_a_eurosprinter() -> None:
    printed = PRINTED["eurosprinter"]
    load, friction, radii = 106700.0, 0.33, (1 / (2 * 0.8e-3), 1 / (2 * 0.2814e-3))
    modulus = nacre.hertz.contact_modulus(STEEL, STEEL)
    semi_axes = nacre.hertz.Ellipse(*radii, modulus, load).semi_axes
    assert_close(semi_axes, printed["semi_axes"], rtol=DIGITS, each=True)
    sides = (2.2 * semi_axes[0], 2.2 * semi_axes[1])
    contact = nacre.Contact(STEEL, nacre.Grid((48, 44), sides), STEEL)
    for point in printed["curve"]:
        solution = contact.roll(
            nacre.Paraboloid(*radii),
            load=load,
            friction=friction,
            creepage=(point["creepage"], None),
            direction="+x",
            order=1,
        )
        assert solution.force[0] / (friction * load) == pytest.approx(point["ratio"], rel=DIGITS)
        assert solution.stick.sum() == point["stick"]
        if "power" in point:
            assert solution.dissipated == pytest.approx(point["power"], rel=DIGITS)
    assert solution.normal.peak_pressure == pytest.approx(printed["peak"], rel=DIGITS)
    assert solution.normal.approach == pytest.approx(printed["approach"], rel=DIGITS)
    assert np.count_nonzero(solution.pressure) == printed["pressed"]


def test_a_ball_that_is_pressed_in_35_steps_sticks_and_slips_as_in_contact() -> None:
    # Spence's problem: a ball of G = 1/2 and ν = 0 on a body that is all but rigid.
    printed = PRINTED["spence35"]
    grid = nacre.Grid((45, 45), (9.0, 9.0), (1e-4, 1e-4))
    bodies = nacre.Elastic(young=1.0, poisson=0.0), nacre.Elastic(young=2e5, poisson=0.0)
    radius = 0.5 / 0.004116
    steps = [{"load": (k / 45) ** 3} for k in range(1, 36)]
    ball, contact = nacre.Paraboloid(radius, radius), nacre.Contact(bodies[0], grid, bodies[1])
    last = quiet(contact.slide, ball, friction=0.2986, steps=steps)[-1]
    pressed = last.normal.pressure > 0
    assert last.normal.approach == pytest.approx(printed["approach"], abs=0.5e-5)
    assert last.normal.peak_pressure == pytest.approx(printed["peak"], abs=0.5e-5)
    assert int(pressed.sum()) == printed["pressed"]
    assert int((pressed & last.stick).sum()) == printed["stick"]
    assert last.dissipated == pytest.approx(printed["work"], abs=0.5e-8)
