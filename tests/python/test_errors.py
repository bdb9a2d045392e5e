"""Bad input is refused by a message that names the argument, what it must be and what it was."""

import re
import subprocess
import sys
from functools import partial
from typing import Any

import numpy as np
import pytest

import nacre

NAN, INF = float("nan"), float("inf")
STEEL = nacre.Elastic(young=210e9, poisson=0.3)
SPHERE = nacre.Sphere(5e-3)
PROFILE = nacre.LogarithmicProfile(1e-6, length=1.0)
PUNCH = nacre.FlatPunch(1e-4)
GRID = nacre.Grid(shape=(16, 20), size=(4e-4, 4e-4))
CONTACT = nacre.Contact(STEEL, GRID)
ENDS = nacre.HalfSpace(STEEL, ends=(-1e-3, 1e-5))
ROLLER = nacre.Roller(5e-3, flat_length=8e-4, crown_radius=1.0, length=1e-3)
HEIGHTS = np.zeros((4, 5))
NAN_AT_1_2 = HEIGHTS.copy()
NAN_AT_1_2[1, 2] = NAN
TOO_LARGE = (2**20, 2**20)

VALUE_ERRORS = {
    # materials and bodies
    "Elastic(-1.0, 0.3)": r"young must be .*above 0, got -1",
    "Elastic(0.0, 0.3)": r"young must be .*above 0, got 0",
    "Elastic(NAN, 0.3)": r"young must be .*got NaN",
    "Elastic(INF, 0.3)": r"young must be finite.*got inf",
    "Elastic(10**400, 0.3)": r"young must be finite.*got inf",
    "Elastic(-10**400, 0.3)": r"young must be .*above 0, got -inf",
    "Elastic(1.0, 0.51)": r"poisson must be .*at most 0\.5, got 0\.51",
    "Elastic(1.0, -1.0)": r"poisson must be above -1.*got -1",
    "Elastic(1.0, NAN)": r"poisson must be .*got NaN",
    "Layer(STEEL, 0.0)": r"thickness must be .*above 0, got 0",
    "Layer(STEEL, -1e-6)": r"thickness must be .*above 0, got -(0\.000001|1e-6)",
    "Layer(STEEL, INF)": r"thickness must be finite.*got inf",
    "Layer(STEEL, 1.0, 'glued')": r"interface must be .*bonded.*frictionless.*glued",
    "Layer(STEEL, 1.0, name='')": r"name must be a text .*other than a number.*got \"\"",
    "Layer(STEEL, 1.0, name='substrate')": r"name must be .*got \"substrate\"",
    "HalfSpace(RIGID)": r"layers must .*at least one.*rigid",
    "HalfSpace(STEEL, ends=(1.0, 0.5))": r"ends must be in ascending order.*got 0\.5",
    "HalfSpace(STEEL, ends=(1.0, 1.0))": r"ends must be in ascending order.*got 1",
    "HalfSpace(STEEL, ends=(INF, None))": r"ends must be finite, got inf",
    "HalfSpace(STEEL, ends=(None, -INF))": r"ends must be finite, got -inf",
    "HalfSpace(STEEL, ends=(NAN, 1.0))": r"ends must be finite, got NaN",
    "HalfSpace(RIGID, [Layer(STEEL, 1.0)], ends=(0.0, None))": r"ends must not .*rigid substrate",
    # free ends and the grid: cells are 2.5e-5 long
    "Contact(ENDS, GRID)": r"ends must lie on edges of the grid's cells along x, or outside the "
    r"grid, was 1e-5 between the edges 0e0 and 2\.50*\d*e-5",
    "Contact(STEEL, GRID, counterbody=ENDS)": r"ends must lie on edges of the grid's cells",
    "Contact(ENDS, Grid.line(16, 1e-3))": r"ends must not be given in line contact",
    "solve(ROLLER, STEEL, ENDS, load=1.0)": r"ends of the counterbody must not lie within the "
    r"shape that it carries: it ends at x = 1e-5, and the shape at 5e-4",
    # shapes
    "Sphere(0.0)": r"radius must be .*above 0, got 0",
    "Sphere(INF)": r"radius must be finite.*got inf",
    "Paraboloid(1.0, -2.0)": r"radius_y must be .*above 0, got -2",
    "Paraboloid(NAN, 1.0)": r"radius_x must be .*got NaN",
    "Cylinder(-1.0)": r"radius must be .*above 0, got -1",
    "Cylinder(-30e-3)": r"radius must be .*raceway or groove use counter_radius.*got -0\.03",
    "Roller(-1.0, 1.0, 1.0)": r"radius must be .*counter_radius.*above 0, got -1",
    "Cylinder(5e-3, counter_radius=-4e-3)": r"counter_radius must be .*raceway.*wider.*got -0\.004",
    "Cylinder(5e-3, counter_radius=0.0)": r"counter_radius must be finite, and above 0.*got 0",
    "Sphere(5e-3, counter_radius_x=-5e-3)": r"counter_radius_x must be .*groove.*got -0\.005",
    "Sphere(5e-3, counter_radius_y=NAN)": r"counter_radius_y must be finite.*got NaN",
    "Paraboloid(1.0, 1.0, counter_radius_y=-0.5)": r"counter_radius_y must be .*got -0\.5",
    "hertz.equivalent_radius(5e-3, -4e-3)": r"1/radius \+ 1/counter_radius must be above 0",
    "hertz.equivalent_radius(0.0)": r"radius must be other than 0.*got 0",
    "hertz.Point(1.0, 0.0, 1.0)": r"contact_modulus must be .*above 0, got 0",
    "hertz.Line(1.0, 1.0, -1.0)": r"line_load must be .*above 0, got -1",
    "hertz.Ellipse(1.0, 1.0, 1.0, 1.0, counter_radius_x=-1.0)": r"must be convex together",
    "hertz.Ellipse(1.0, 1e300, 1.0, 1.0)": r"radii.*too different",
    "hertz.Point(1.0, 1.0, 1.0).max_shear(0.6)": r"poisson must be .*at most 0\.5, got 0\.6",
    "FlatPunch(0.0)": r"radius must be .*above 0, got 0",
    "Roller(0.0, 1.0, 1.0)": r"radius must be .*above 0, got 0",
    "Roller(1.0, -1.0, 1.0)": r"flat_length must be .*at least 0, got -1",
    "Roller(1.0, 1.0, 0.0)": r"crown_radius must be .*above 0, got 0",
    "Roller(1.0, 1.0, 1.0, length=0.5)": r"length must be at least flat_length.*got 0\.5",
    "Roller(1.0, 1.0, 1.0, length=NAN)": r"length must be .*got NaN",
    "Roller(1.0)": r"flat_length.*crown_radius.*profile",
    "Roller(1.0, 1.0)": r"flat_length.*crown_radius.*profile",
    "Roller(1.0, 1.0, 1.0, profile=PROFILE)": r"flat_length.*crown_radius.*profile",
    "LogarithmicProfile(0.0, 1.0)": r"amplitude must be .*above 0, got 0",
    "LogarithmicProfile(1.0, INF)": r"length must be finite.*got inf",
    "LogarithmicProfile(1.0, 1.0, 1.0)": r"flat_length must be .*below.*length, got 1",
    "LogarithmicProfile(1.0, 1.0, 0.0, 1.5)": r"end_factor must be .*at most 1, got 1\.5",
    "LogarithmicProfile.lundberg(0.0, 1.0, 1.0)": r"length must be .*above 0, got 0",
    "LogarithmicProfile.iso16281(-1.0, 1.0)": r"diameter must be .*above 0, got -1",
    "LogarithmicProfile.fujiwara_kawase(1.0, 1.0, 1.0, 0.0, 1.0, 1.0)": r"k1 must be .*above 0",
    "LogarithmicProfile.fujiwara_kawase(1.0, 1.0, 1.0, 1.0, 1.1, 1.0)": r"k2 must be .*at most 1",
    "LogarithmicProfile.fujiwara_kawase(1.0, 1.0, 1.0, 1.0, 1.0, -1.0)": r"z_m must be .*above 0",
    "SampledProfile([0.0, 1.0], [0.0])": r"drop.*\b2\b.*\b1\b",
    "SampledProfile([0.0], [0.0])": r"at least two",
    "SampledProfile([0.0, 0.0], [0.0, 1.0])": r"positions must be increasing, got 0",
    "SampledProfile([0.0, NAN], [0.0, 1.0])": r"not finite at .*1",
    "SampledProfile(HEIGHTS, HEIGHTS)": r"x must have one dimension.*\[4, 5\]",
    "SPHERE.shifted(NAN, 0.0)": r"x must be finite, got NaN",
    "SPHERE.shifted(0.0, INF)": r"y must be finite, got inf",
    # height maps
    "HeightMap(NAN_AT_1_2, 1.0)": r"heights is not finite at \[1, 2\]",
    "HeightMap(np.where(np.isnan(NAN_AT_1_2), INF, 0.0), 1.0)": r"heights is not finite at",
    "HeightMap([1.0, 2.0], 1.0)": r"heights must have two dimensions.*\[2\]",
    "HeightMap(np.zeros((2, 2, 2)), 1.0)": r"heights must have two dimensions.*\[2, 2, 2\]",
    "HeightMap([[1.0, 2.0]], 1.0)": "number of heights .* at least 2, got 1",
    "HeightMap(np.zeros((0, 0)), 1.0)": "number of heights .* at least 2, got 0",
    "HeightMap(HEIGHTS, 0.0)": r"spacing must be .*above 0, got 0",
    "HeightMap(HEIGHTS, (1.0, -1.0))": r"spacing must be .*above 0, got -1",
    "HeightMap(HEIGHTS, 1.0, center=(NAN, 0.0))": r"center must be finite, got NaN",
    "HeightMap(HEIGHTS, 1e-9).gaps(GRID)": r"grid spacing must be at most twice.*got (0\.0|2\.5e-)",
    # grids
    "Grid((0, 4), (1.0, 1.0))": r"shape must be .*at least 2.*got 0",
    "Grid((1, 4), (1.0, 1.0))": r"shape must be .*at least 2.*got 1",
    "Grid((-4, 4), (1.0, 1.0))": r"shape must be .*at least 2.*got -4",
    "Grid((4, 4, 4), (1.0, 1.0))": r"(?s)length 2.*3.*shape",
    "Grid((2**62, 2**62), (1.0, 1.0))": r"shape must be .*got 2126764793",
    "Grid((2**70, 4), (1.0, 1.0))": r"shape must be .*(count|at most).*got 11805916207174113",
    "Grid((4, 4), (0.0, 1.0))": r"size must be .*above 0, got 0",
    "Grid((4, 4), (1.0, INF))": r"size must be finite.*got inf",
    "Grid((4, 4), (1.0, 1.0, 1.0))": r"(?s)length 2.*3.*size",
    "Grid((4, 4), (1.0, 1.0), center=(0.0, NAN))": r"center must be finite, got NaN",
    "Grid.line(1, 1.0)": r"cells must be .*at least 2, got 1",
    "Grid.line(4, -1.0)": r"width must be .*above 0, got -1",
    # plans
    "Contact(STEEL, GRID, method='magic')": r"method must be .*exact.*plain.*magic",
    "Contact(STEEL, GRID, refinement=0)": r"refinement must be .*at least 1, got 0",
    "Contact(STEEL, GRID, threads=0)": r"threads must be .*at least 1, got 0",
    "Contact(STEEL, GRID, threads=-2)": r"threads must be .*at least 1, got -2",
    "influence_coefficients(STEEL, GRID, 'magic')": r"method must be .*exact.*plain.*magic",
    "influence_coefficients(STEEL, GRID, 'plain', 0)": r"refinement must be .*at least 1, got 0",
    # frequency response
    "frequency_response(STEEL, 0.0)": r"wavenumber must be .*above 0, got 0",
    "frequency_response(STEEL, [1.0, -2.0])": r"wavenumber must be .*above 0, got -2",
    "frequency_response(STEEL, 5e-324)": r"wavenumber must be .*finite: neither that small",
    "surface_compliance(STEEL, [1.0, 1e-323])": r"wavenumber must be .*neither that small",
    "frequency_response(STEEL, NAN)": r"wavenumber must be .*got NaN",
    "frequency_response(STEEL, INF)": r"wavenumber must be finite.*got inf",
    # graded coatings
    "graded_layers(STEEL, 0.0, 1e9, 0.3)": r"thickness must be .*above 0, got 0",
    "graded_layers(STEEL, 1.0, -1e9, 0.3)": r"young must be .*got -1000000000",
    "graded_layers(STEEL, 1.0, 1e9, lambda z: z)": r"poisson must be .*0\.5, got 0\.",
    "graded_layers(STEEL, 1.0, 1e9, 0.3, 2.0)": r"tolerance must be .*below 1, got 2",
    "graded_layers(STEEL, 1.0, 1e9, 0.3, breakpoints=[0.5, 1.0])": r"breakpoints must be .*got 1",
    # controls
    "press()": r"exactly one of load and approach",
    "press(load=1.0, approach=1e-6)": r"exactly one of load and approach",
    "press(load=0.0)": r"load must be .*above 0, got 0",
    "press(load=-1.0)": r"load must be .*above 0, got -1",
    "press(load=NAN)": r"load must be .*got NaN",
    "press(load=INF)": r"load must be finite.*got inf",
    "press(approach=NAN)": r"approach must be finite, got NaN",
    "press(load=1.0, eccentricity=(NAN, None))": r"eccentricity must be finite, got NaN",
    "press(load=1.0, moment=(None, INF))": r"moment must be finite, got inf",
    "press(load=1.0, tilt=(-INF, None))": r"tilt must be finite, got -inf",
    "press(approach=1e-6, eccentricity=(0.0, None))": r"eccentricity needs load",
    "press(approach=1e-6, eccentricity=(None, 0.0))": r"eccentricity needs load",
    "press(load=1.0, eccentricity=(0.0, None), tilt=(0.0, None))": r"along x at most one of",
    "press(load=1.0, eccentricity=(None, 0.0), moment=(None, 0.0))": r"along y at most one of",
    "press(load=1.0, moment=(0.0, None), tilt=(0.0, 0.0))": r"along x at most one of",
    # the load point, on a grid whose cell centres end at 1.875e-4
    "press(load=1.0, eccentricity=(1.9e-4, None))": r"load point \(1\.9.*must lie .*inside",
    "press(load=1.0, eccentricity=(None, -1.0))": r"load point \(0.*-1\.0.*must lie .*inside",
    "press(load=2.0, moment=(1.0, None))": r"load point \(5\.0*e-1.*must lie .*inside",
    "CONTACT.solve(PUNCH, load=1.0, eccentricity=(1.2e-4, 0.0))": r"load point \(1\.2.*inside",
    "CONTACT.solve(SPHERE.shifted(1.0, 0.0), load=1.0)": r"no cell .*can touch",
    # options
    "press(load=1.0, tolerance=0.0)": r"tolerance must be above 0.*got 0",
    "press(load=1.0, tolerance=1.0)": r"tolerance must be .*below 1, got 1",
    "press(load=1.0, tolerance=NAN)": r"tolerance must be .*got NaN",
    "press(load=1.0, max_iterations=-1)": r"max_iterations must be .*at least 0, got -1",
    "press(load=1.0, algorithm='magic')": r"algorithm must be .*magic",
    "press(load=1.0, initial=np.zeros((3, 4)))": r"initial.*shape \[16, 20\].*\[3, 4\]",
    "press(load=1.0, initial=np.zeros(20))": r"initial must have two dimensions.*\[20\]",
    "press(load=1.0, initial=np.full((16, 20), NAN))": r"initial is not finite at \[0, 0\]",
    "press(load=1.0, initial=np.full((16, 20), -3.0))": r"initial must be .*at least 0.*-3",
    "solve(Cylinder(5e-3), STEEL, load=1.0)": r"grid must be given",
}

TYPE_ERRORS = {
    "Elastic('hard', 0.3)": r"(?s)number.*young",
    "Elastic(1j, 0.3)": r"(?s)number.*young",
    "Elastic(np.complex128(1 + 2j), 0.3)": r"(?s)real number, got np.complex128.*young",
    "Elastic(np.array(1 + 0j), 0.3)": r"(?s)real number, got array.*young",
    "Layer(STEEL, np.complex64(1))": r"(?s)real number, got .*thickness",
    "Grid((4, 4), (1.0, np.complex128(1)))": r"(?s)pair of numbers, got .*size",
    "Elastic(1.0, None)": r"(?s)number.*poisson",
    "Layer('steel', 1.0)": r"(?s)Elastic.*material",
    "Layer(STEEL, 'thin')": r"(?s)number.*thickness",
    "Layer(STEEL, 1.0, 3)": r"(?s)str.*interface",
    "HalfSpace('steel')": r"substrate must be an Elastic or .*RIGID, got .*steel",
    "HalfSpace(None)": r"substrate must be an Elastic or .*RIGID, got None",
    "HalfSpace(STEEL, [STEEL])": r"layers must be a sequence of Layer, got Elastic.* in it",
    "HalfSpace(STEEL, Layer(STEEL, 1.0))": r"layers must be a sequence of Layer, got Layer",
    "HalfSpace(STEEL, ends=1.0)": r"ends must be a pair of numbers or None, got 1\.0",
    "HalfSpace(STEEL, ends=(0.0, 1.0, 2.0))": r"ends must be a pair.*got \(0\.0, 1\.0, 2\.0\)",
    "HalfSpace(STEEL, ends=('left', None))": r"ends must be a pair.*'left'",
    "HalfSpace(STEEL, [], (0.0, 1.0))": r"positional",
    "Sphere('round')": r"(?s)number.*radius",
    "Sphere([1.0, 2.0])": r"(?s)number.*radius",
    "SPHERE + Elastic(1.0, 0.3)": r"unsupported operand",
    "SPHERE.shifted('left', 0.0)": r"(?s)number.*x",
    "SPHERE.gaps('grid')": r"(?s)Grid.*grid",
    "Roller(1.0, profile=3)": r"profile must be .*LogarithmicProfile.*got 3",
    "Roller(1.0, profile=('a', 'b'))": r"x must be a real array.*<U1",
    "HeightMap(HEIGHTS, 'fine')": r"spacing must be .*number.*fine",
    "HeightMap(HEIGHTS, (1.0, 1.0, 1.0))": r"spacing must be .*1\.0, 1\.0, 1\.0",
    "HeightMap(HEIGHTS, 1.0, center=0.0)": r"(?s)(float|tuple|pair).*center",
    "Grid(4, (1.0, 1.0))": r"(?s)int.*shape",
    "Grid((4.0, 4.0), (1.0, 1.0))": r"shape must be an integer, got 4\.0",
    "Grid('ab', (1.0, 1.0))": r"shape must be an integer, got .*a",
    "Grid((4, 4), 1.0)": r"(?s)pair of numbers, got 1\.0.*size",
    "Grid.line(2.5, 1.0)": r"cells must be an integer, got 2\.5",
    "Contact('steel', GRID)": r"body.*must be a HalfSpace or an Elastic, got .*steel",
    "Contact(STEEL, (16, 20))": r"(?s)Grid.*grid",
    "Contact(STEEL, GRID, 'steel')": r"counterbody.*must be a HalfSpace.*steel",
    "Contact(STEEL, GRID, method=3)": r"method must be a str, got 3",
    "Contact(STEEL, GRID, refinement=1.5)": r"refinement must be an integer, got 1\.5",
    "Contact(STEEL, GRID, threads='all')": r"threads must be an integer, got .*all",
    "frequency_response('steel', 1.0)": r"body.*must be a HalfSpace.*steel",
    "graded_layers('steel', 1.0, 1e9, 0.3)": r"substrate must be .*steel",
    "graded_layers(STEEL, 1.0, 'hard', 0.3)": r"young must be .*hard",
    "graded_layers(STEEL, 1.0, lambda z: 'hard', 0.3)": r"young must be .*hard",
    "graded_layers(STEEL, 1.0, 1e9, 0.3, breakpoints=0.5)": r"breakpoints must be a sequence",
    "graded_layers(STEEL, 1.0, lambda z: 1e9 + 1j, 0.3)": r"young must be .*got \(1000000000",
    "CONTACT.solve('sphere', load=1.0)": r"shape must be a nacre\.Shape, got .*sphere",
    "solve(SPHERE, 'steel', load=1.0)": r"body.*must be a HalfSpace.*steel",
    "solve(SPHERE, STEEL, grid=(16, 20), load=1.0)": r"grid must be a nacre\.Grid, got \(16, 20\)",
    "press(load='1')": r"load must be a real number, got '1'",
    "press(load=1j)": r"load must be a real number, got 1j",
    "press(load=np.complex128(1))": r"load must be a real number, got np.complex128",
    "press(load=1.0, tilt=(0.0, np.complex64(1)))": r"tilt must be a pair",
    "SPHERE.shifted(np.complex128(1), 0.0)": r"(?s)real number, got .*x",
    "stress(STEEL, GRID, np.ones((16, 20)), 1e-5, residual=[1j])": r"residual must be .*numbers",
    "stress(STEEL, GRID, np.ones((16, 20)), 1e-5, residual=np.array([1e6 + 5e6j]))": (
        r"residual must be .*numbers, .*got array"
    ),
    "stress(STEEL, GRID, np.ones((16, 20)), 1e-5, residual={0: 1j})": r"residual must hold real",
    "stress(STEEL, GRID, np.ones((16, 20)), 1e-5, friction=np.complex128(1))": r"friction must",
    "stress(STEEL, GRID, np.ones((16, 20)), 1j)": r"z must be a real array",
    "press(approach=[1.0])": r"approach must be a real number, got \[1\.0\]",
    "press(load=1.0, eccentricity=1e-5)": r"eccentricity must be a pair.*got 1e-05",
    "press(load=1.0, eccentricity=(1e-5,))": r"eccentricity must be a pair.*got \(1e-05,\)",
    "press(load=1.0, moment=(1.0, 'b'))": r"moment must be a pair.*'b'",
    "press(load=1.0, tilt=(0.0, 0.0, 0.0))": r"tilt must be a pair.*\(0\.0, 0\.0, 0\.0\)",
    "press(load=1.0, tolerance='tight')": r"tolerance must be a real number, got 'tight'",
    "press(load=1.0, max_iterations=2.5)": r"max_iterations must be an integer, got 2\.5",
    "press(load=1.0, algorithm=1)": r"algorithm must be a str, got 1",
    "press(load=1.0, progress=3)": r"progress must be callable, got 3",
    "press(load=1.0, check='no')": r"check must be a bool, got 'no'",
    "press(load=1.0, weight=1.0)": r"Contact\.solve must be among load, .* got 'weight'",
    "press(1.0)": r"positional",
}


# nacre.hertz is imported when it is first used.
NAMES = globals() | vars(nacre) | {"hertz": nacre.hertz, "press": partial(CONTACT.solve, SPHERE)}


@pytest.mark.parametrize(("call", "message"), VALUE_ERRORS.items(), ids=VALUE_ERRORS)
def test_bad_values_are_refused(call: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        eval(call, NAMES)


@pytest.mark.parametrize(("call", "message"), TYPE_ERRORS.items(), ids=TYPE_ERRORS)
def test_bad_types_are_refused(call: str, message: str) -> None:
    # The match searches notes, too: where pyo3 finds the type wrong, they name the argument.
    with pytest.raises(TypeError, match=message):
        eval(call, NAMES)


@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # few cells are enough here
def test_a_list_or_an_array_is_as_good_as_a_tuple() -> None:
    pair = (4e-4, 4e-4)
    kinds: tuple[Any, ...] = (list, np.array)
    for like in kinds:
        assert nacre.Grid(like((16, 20)), like(pair)) == GRID
        assert nacre.HeightMap(HEIGHTS, like(pair)).spacing == pair
        assert nacre.HeightMap(HEIGHTS, pair, center=like(pair)).center == pair
        moved = CONTACT.solve(SPHERE, load=100.0, eccentricity=like((1e-5, 0.0)))
        assert moved.report.motion["eccentricity"] == (1e-5, 0.0)
        field = moved.stress(1e-5, friction=0.1, direction=like((0.0, 1.0)))
        assert field.friction == (0.0, 0.1)
    layers = [nacre.Layer(STEEL, 1e-6), nacre.Layer(STEEL, 2e-6)]
    for many in (tuple(layers), iter(layers), np.array(layers, dtype=object)):
        assert nacre.HalfSpace(STEEL, many) == nacre.HalfSpace(STEEL, layers)


def test_missing_samples_are_refused() -> None:
    missing = np.ma.masked_array(HEIGHTS, mask=np.isnan(NAN_AT_1_2))
    with pytest.raises((TypeError, ValueError), match=r"heights.*mask"):
        nacre.HeightMap(missing, spacing=1.0)


# Shapes of which one field alone does not fit: no plan can be asked of such a grid.
@pytest.mark.parametrize("shape", [TOO_LARGE, (2**50, 2)])
def test_a_grid_too_large_for_memory_is_refused(shape: tuple[int, int]) -> None:
    script = f"""
import nacre
try:
    nacre.Grid(shape={shape}, size=(1.0, 1.0)).x
except MemoryError as error:
    print(error)
"""
    # In a process of its own: where memory is not checked, the allocator ends the process.
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, run.stderr[:500]
    assert re.search(r"\d+.* cells needs about \d+ MiB, and \d+ MiB are available", run.stdout)


@pytest.mark.parametrize("name", ["Shape", "Solution", "Report"])
def test_results_cannot_be_made_by_hand(name: str) -> None:
    with pytest.raises(TypeError, match=name):
        getattr(nacre, name)()


def test_bad_input_is_not_a_convergence_error() -> None:
    assert not issubclass(nacre.ConvergenceError, ValueError)
    assert issubclass(nacre.ConvergenceError, RuntimeError)
    assert issubclass(nacre.NacreWarning, UserWarning)
