"""What nacre computes for the numbers of ``printed.toml``, by the same names."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

import nacre
from nacre import bearing, fatigue, hertz, indent
from nacre._tools.notices import heard
from nacre._tools.typing import Side

Numbers = dict[str, float]
Array = npt.NDArray[np.float64]
CASES: dict[str, Callable[[], Numbers]] = {}
"""Computations by the name of the case."""


def _case(compute: Callable[[], Numbers]) -> Callable[[], Numbers]:
    """Add a computation, without warnings that belong to the printed problem."""

    def quiet() -> Numbers:
        with heard():
            return compute()

    CASES[compute.__name__.removeprefix("_")] = quiet
    return quiet


STEEL = nacre.Elastic(210e9, 0.3)
RAIL = nacre.Elastic(2 * 82e3 * 1.28, 0.28)
"""Steel of CONTACT's examples [MPa]: it states the shear modulus."""
ALUMINIUM = nacre.Elastic(2 * 23e3 * 1.31, 0.31)


@_case
def _hertz_circle() -> Numbers:
    solution = nacre.solve(nacre.Paraboloid(10e-3, 10e-3), STEEL, load=20.0)
    return {
        "peak pressure [GPa]": solution.peak_pressure / 1e9,
        "approach [µm]": solution.approach * 1e6,
    }


@_case
def _contact_carter() -> Numbers:
    length = 200.0
    solution = nacre.roll(
        nacre.Cylinder(500.0),
        RAIL,
        RAIL,
        grid=nacre.Grid.line(55, 55 * 0.04, center=0.03),
        load=35780.0 / length,
        friction=0.3,
        creepage=(-2.4e-4, None),
        order=1,
    )
    return {
        "traction force [N]": abs(float(np.asarray(solution.force[1]))) * length,
        "friction power [W s/m]": solution.dissipated * length,
        "sticking cells": int(solution.stick.sum()),
    }


@_case
def _contact_bentall() -> Numbers:
    numbers: Numbers = {}
    for friction, ratio in ((1e-4, 0.0), (10.0, 0.0), (0.05, 0.0), (0.05, -0.75), (0.05, 0.75)):
        load = 16.2019
        solution = nacre.roll(
            nacre.Cylinder(25.0),
            ALUMINIUM,
            RAIL,
            grid=nacre.Grid.line(216, 0.216),
            load=load,
            friction=friction,
            force=(ratio * friction * load, None),
            order=1,
        )
        place = f"friction {friction:g}, {ratio:g} of the full force"
        assert solution.creepage is not None
        numbers[f"creepage, {place}"] = solution.creepage[0]
        numbers[f"peak pressure [MPa], {place}"] = solution.normal.peak_pressure
        numbers[f"sticking cells, {place}"] = int(solution.stick.sum())
    return numbers


@_case
def _contact_cattaneo() -> Numbers:
    body, load, friction = nacre.Elastic(2 * 1.28, 0.28), 0.4705, 0.4013
    radius = 1 / (2 * 0.002963)
    contact = nacre.Contact(body, nacre.Grid((33, 33), (8.25, 8.25)), body)
    solution = contact.slide(
        nacre.Paraboloid(radius, radius),
        load=load,
        friction=friction,
        force=(0.657 * friction * load, None),
    )
    assert solution.shift is not None
    return {
        "peak pressure [MPa]": solution.normal.peak_pressure,
        "approach [mm]": solution.normal.approach,
        "shift [mm]": solution.shift[0],
        "friction work [mJ]": solution.dissipated,
        "sticking cells": int(solution.stick.sum()),
    }


@_case
def _contact_eurosprinter() -> Numbers:
    load, friction, radii = 106700.0, 0.33, (1 / (2 * 0.8e-3), 1 / (2 * 0.2814e-3))
    semi_axes = hertz.Ellipse(*radii, hertz.contact_modulus(RAIL, RAIL), load).semi_axes
    contact = nacre.Contact(
        RAIL, nacre.Grid((48, 44), (2.2 * semi_axes[0], 2.2 * semi_axes[1])), RAIL
    )
    numbers: Numbers = {
        "semi-axis along x [mm]": semi_axes[0],
        "semi-axis along y [mm]": semi_axes[1],
    }
    for creepage in (4e-4, 1.6e-3, 3.2e-3):
        solution = contact.roll(
            nacre.Paraboloid(*radii),
            load=load,
            friction=friction,
            creepage=(creepage, None),
            direction="+x",
            order=1,
        )
        place = f"creepage {creepage:g}"
        numbers[f"share of the full force, {place}"] = solution.force[0] / (friction * load)
        numbers[f"sticking cells, {place}"] = int(solution.stick.sum())
    numbers["peak pressure [MPa]"] = solution.normal.peak_pressure
    numbers["approach [mm]"] = solution.normal.approach
    return numbers


def _disc(radius: float, pressure: float, cells: int) -> tuple[nacre.Grid, Array]:
    """Return cells of 2.5 mm and the pressure of a disc: at its edge, by the share of each cell."""
    side, divisions = 2.5, 32
    grid = nacre.Grid((cells, cells), (cells * side, cells * side))
    places = (grid.x[:, None] + side * ((np.arange(divisions) + 0.5) / divisions - 0.5)).ravel()
    inside = places[:, None] ** 2 + places**2 < radius**2
    return grid, pressure * inside.reshape(cells, divisions, cells, divisions).mean(axis=(1, 3))


@_case
def _ellea1() -> Numbers:
    layers = [
        nacre.Layer(nacre.Elastic(3000.0, 0.3), 150.0),
        nacre.Layer(nacre.Elastic(200.0, 0.35), 600.0),
    ]
    body = nacre.HalfSpace(nacre.Elastic(40.0, 0.4), layers)
    grid, pressure = _disc(150.0, 1.1, 121)
    depths = np.array([10.0, 50, 100, 150, 200, 300, 500, 750, 1000])
    field = nacre.stress(
        body, grid, pressure, depths, side="above", x=0.0, y=0.0, displacement=True
    )
    assert field.displacement is not None
    components = {
        "stress along x [MPa]": -field.xx,
        "stress along z [MPa]": -field.zz,
        "displacement along z [mm]": field.displacement["uz"],
    }
    return {
        f"{name}, {depth:g} mm below": float(value)
        for name, values in components.items()
        for depth, value in zip(depths, np.ravel(values), strict=True)
    }


@_case
def _amadeus() -> Numbers:
    upper, lower, base = (5000.0, 0.35), (200.0, 0.4), (50.0, 0.45)
    layers = [nacre.Layer(nacre.Elastic(*upper), 260.0), nacre.Layer(nacre.Elastic(*lower), 500.0)]
    body, numbers = nacre.HalfSpace(nacre.Elastic(*base), layers), Numbers()
    grid, pressure = _disc(150.8, 0.7, 123)
    sides: tuple[tuple[str, float, Side, tuple[float, float]], ...] = (
        ("horizontal strain below the first layer", 260.0, "above", upper),
        ("vertical strain on the second layer", 260.0, "below", lower),
        ("vertical strain on the half-space", 760.0, "below", base),
    )
    for place, x in (("axis", 0.0), ("edge", 150.8)):
        for name, depth, side, (young, poisson) in sides:
            field = nacre.stress(body, grid, pressure, depth, side=side, x=x, y=0.0)
            xx, yy, zz = (float(getattr(field, component)) for component in ("xx", "yy", "zz"))
            along, across = (xx, yy + zz) if side == "above" else (zz, xx + yy)
            numbers[f"{name} [1e-6], {place}"] = -1e6 * (along - poisson * across) / young
    return numbers


@_case
def _spinu_rollers() -> Numbers:
    roller, numbers = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5), Numbers()
    grid = nacre.Grid((512, 64), (31e-3, 0.18e-3))
    centred = nacre.solve(roller, STEEL, grid=grid, load=1e3)
    numbers["pressure in the middle [MPa]"] = centred.central_pressure / 1e6
    numbers["peak pressure [MPa]"] = centred.peak_pressure / 1e6
    tilted = nacre.solve(roller, STEEL, grid=grid, load=1e3, eccentricity=(2.8695e-3, 0.0))
    numbers["peak pressure off the centre [MPa]"] = tilted.peak_pressure / 1e6
    numbers["tilt [1e-5]"] = tilted.tilt[0] * 1e5
    return numbers


def _punched(layers: Sequence[nacre.Layer] = ()) -> nacre.Solution:
    """Return the contact of a disc of radius 1 on layers over a half-space."""
    grid = nacre.Grid((256, 256), (2.1, 2.1))
    return nacre.solve(nacre.FlatPunch(1.0), nacre.HalfSpace(STEEL, layers), grid=grid, load=1.0)


@_case
def _conducting_disc() -> Numbers:
    through = _punched().conductance(conductivity=1.0, counter_conductivity=math.inf)
    return {"4 k a R": 4 * through.resistance}


@_case
def _layered_disc() -> Numbers:
    pressed, numbers = _punched([nacre.Layer(STEEL, 0.1)]), Numbers()
    for ratio in (0.1, 4.0, 100.0):
        through = pressed.conductance(conductivity=[ratio, 1.0], counter_conductivity=math.inf)
        numbers[f"4 k a R, layer {ratio:g} times as conductive"] = 4 * through.resistance
    return numbers


@_case
def _barber() -> Numbers:
    body, counterbody = nacre.Elastic(110e9, 0.34), nacre.Elastic(210e9, 0.3)
    solution = nacre.solve(nacre.Paraboloid(1e-3, 2e-3), body, counterbody, load=1.0)
    through = solution.conductance(conductivity=50.0, counter_conductivity=20.0)
    modulus, mean = hertz.contact_modulus(body, counterbody), 1 / (1 / 50.0 + 1 / 20.0)
    stiffness = solution.stiffness()[0, 0]
    return {"2 R k dW/dδ / E*": float(2 * through.resistance * mean * stiffness / modulus)}


@_case
def _coated_roller() -> Numbers:
    numbers = Numbers()
    for ratio, thickness in ((4.0, 4e-5), (0.25, 2e-4)):
        layers = [nacre.Layer(nacre.Elastic(ratio * 210e9, 0.3), thickness)]
        solution = nacre.solve(
            nacre.Roller(5e-3, 19.13e-3, 7.5),
            nacre.HalfSpace(STEEL, layers),
            grid=nacre.Grid((121, 41), (32e-3, 0.2e-3)),
            load=1e3,
            eccentricity=(2.8695e-3, None),
            tolerance=1e-11,
        )
        place = f"coating of {thickness * 1e6:g} µm, {ratio:g} times as stiff"
        numbers[f"peak pressure [MPa], {place}"] = solution.peak_pressure / 1e6
        numbers[f"approach [µm], {place}"] = solution.approach * 1e6
    return numbers


@_case
def _coated_sphere() -> Numbers:
    layers = [nacre.Layer(nacre.Elastic(420e9, 0.3), 2.165597763352258e-5)]
    pressed = nacre.solve(nacre.Paraboloid(10e-3, 10e-3), nacre.HalfSpace(STEEL, layers), load=20.0)
    return {
        "peak pressure [MPa]": pressed.peak_pressure / 1e6,
        "approach [µm]": pressed.approach * 1e6,
    }


@_case
def _coated_indentation() -> Numbers:
    layers = [nacre.Layer(nacre.Elastic(420e9, 0.3), 2.165597763352258e-5)]
    body = nacre.HalfSpace(STEEL, layers)
    state = indent.Indentation(body, indent.Tip.paraboloid(10e-3)).at(load=20.0)
    return {"contact radius [µm]": state.radius * 1e6, "approach [µm]": state.approach * 1e6}


@_case
def _hayes_punch() -> Numbers:
    body = nacre.HalfSpace(nacre.RIGID, [nacre.Layer(nacre.Elastic(1.0, 0.3), 1.0)])
    numbers, shear = Numbers(), 1 / 2.6
    for radius in (0.2, 0.4, 0.6, 0.8, 1.0):
        state = indent.Indentation(body, indent.Tip.flat_punch(radius)).at(approach=1e-3)
        numbers[f"κ, a/h = {radius:g}"] = state.load * 0.7 / (4 * shear * radius * 1e-3)
    return numbers


def _groove(gamma: float) -> bearing.DeepGrooveBall:
    return bearing.DeepGrooveBall(
        count=3, diameter=1e-3, pitch_diameter=1e-3 / gamma, rating_factor=1.0
    )


@_case
def _iso281_balls() -> Numbers:
    gammas = (0.01, 0.04, 0.07, 0.1, 0.13, 0.16, 0.19, 0.22, 0.25, 0.28)
    return {f"f_c, γ = {g:g}": bearing.rating(_groove(g)) / 3 ** (2 / 3) for g in gammas}


@_case
def _iso281_rollers() -> Numbers:
    def factor(gamma: float) -> float:
        rollers = bearing.CylindricalRoller(
            count=3, diameter=1e-3, length=1e-3, pitch_diameter=1e-3 / gamma, rating_factor=1.0
        )
        return bearing.rating(rollers) / 3**0.75

    gammas = (0.01, 0.04, 0.07, 0.1, 0.13, 0.16, 0.19, 0.22, 0.25, 0.28)
    return {f"f_c, γ = {g:g}": factor(g) for g in gammas}


@_case
def _iso281_example() -> Numbers:
    balls = bearing.AngularContactBall(
        count=27, diameter=7.5e-3, pitch_diameter=7.5e-3 / 0.091, contact_angle=math.radians(40)
    )
    return {"C_r [N]": bearing.rating(balls)}


CATALOGUE = {"6005": (10, 6.35, 36.0), "6205": (9, 7.9375, 38.5), "6206": (9, 9.525, 46.0)}
"""Count, diameter and pitch diameter of the balls [mm]."""


def _catalogue(name: str) -> bearing.DeepGrooveBall:
    count, diameter, pitch = CATALOGUE[name]
    return bearing.DeepGrooveBall(count=count, diameter=diameter / 1e3, pitch_diameter=pitch / 1e3)


@_case
def _nsk_dynamic() -> Numbers:
    return {f"C_r [N], {name}": bearing.rating(_catalogue(name)) for name in CATALOGUE}


@_case
def _nsk_static() -> Numbers:
    return {f"C_0r [N], {name}": bearing.static_rating(_catalogue(name)) for name in CATALOGUE}


@_case
def _masta() -> Numbers:
    numbers = Numbers()
    for force, clearance in (
        ((1000.0, None, None), 0.0),
        ((None, None, 1000.0), 0.0),
        ((None, None, 1000.0), 1e-5),
    ):
        balls = bearing.DeepGrooveBall(
            count=7,
            diameter=11.5e-3,
            pitch_diameter=43.5e-3,
            clearance=clearance,
            capacity=23400.0,
            element=STEEL,
            inner=STEEL,
            outer=STEEL,
        )
        solution = balls.solve(force=force, model="iso16281")
        axis, word = (0, "radial") if force[2] is None else (2, "axial")
        place = f"{word} load, clearance {clearance * 1e6:g} µm"
        numbers[f"displacement [µm], {place}"] = solution.displacement[axis] * 1e6
        numbers[f"L_10r [1e6], {place}"] = solution.life().l10r
    return numbers


@_case
def _crossland() -> Numbers:
    history = np.zeros((6, 6))
    history[:, 0] = [0, 411, 0, -411, 0, 411]
    history[:, 3] = [0, 205, 0, -205, 0, 205]
    criterion = fatigue.Crossland(540.97, 352.0)
    return {"stress less the limit [MPa]": float(criterion.stress(history)) - criterion.limit}


@_case
def _dang_van() -> Numbers:
    return {"factor a": fatigue.DangVan(220e6, 130e6).constants[0]}
