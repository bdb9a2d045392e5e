"""Bad input is refused by a message that names the argument, what it must be and what it was."""

import dataclasses
import inspect
import re
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

import nacre
import support
from bodies import BALL, COATED, HARD, HELD, NAN, ROD, STEEL, quiet
from nacre import bearing
from shapes import SHAPES
from support import errors, table

PROFILE = nacre.LogarithmicProfile(1e-6, length=1.0)
PUNCH = nacre.FlatPunch(1e-4)
GRID = nacre.Grid(shape=(16, 20), size=(4e-4, 4e-4))
CONTACT = nacre.Contact(STEEL, GRID)
ENDS = nacre.HalfSpace(STEEL, ends=(-1e-3, 1e-5))
ROLLER = nacre.Roller(5e-3, flat_length=8e-4, crown_radius=1.0, length=1e-3)
PLATE = nacre.HalfSpace(nacre.FREE, [nacre.Layer(STEEL, 1e-3)])
HEIGHTS = np.zeros((4, 5))
NAN_AT_1_2 = np.where(np.arange(20).reshape(4, 5) == 7, NAN, 0.0)
TOO_LARGE = (2**20, 2**20)

VALUES = {
    "press(load=1.0, tilt=(0.0, 0.0, 0.0))": r"tilt must be a pair.*\(0\.0, 0\.0, 0\.0\)",
    "press(load=1.0, eccentricity=(1e-5,))": r"eccentricity must be a pair.*got \(1e-05,\)",
    "HalfSpace(STEEL, ends=(0.0, 1.0, 2.0))": r"ends must be a pair.*got \(0\.0, 1\.0, 2\.0\)",
    # materials and bodies
    "Elastic(-1.0, 0.3)": r"young must be .*above 0, got -1",
    "Elastic(10**400, 0.3)": r"young must be finite.*got inf",
    "Elastic(-10**400, 0.3)": r"young must be .*above 0, got -inf",
    "Elastic(1.0, -1.0)": r"poisson must be above -1.*got -1",
    "Layer(STEEL, -1e-6)": r"thickness must be .*above 0, got -(0\.000001|1e-6)",
    "Layer(STEEL, 1.0, 'glued')": r"interface must be .*bonded.*frictionless.*Spring.*glued",
    "Spring()": r"normal or tangential must be given.*bonded",
    "Spring(0.0)": r"normal must be finite and above 0, got 0",
    "Spring(INF)": r"normal must be finite and above 0, got inf",
    "Spring(1.0, -1.0)": r"tangential must be finite and at least 0, got -1",
    "HalfSpace(nacre.FREE)": r"layers must .*at least one.*free",
    "HalfSpace(nacre.FREE, [Layer(STEEL, 1.0, 'frictionless')])": r"interface of the lowest .*",
    "HalfSpace(nacre.FREE, [Layer(STEEL, 1.0)], ends=(0.0, None))": r"ends must not .*free base",
    "HalfSpace(STEEL, [Layer(STEEL, 1.0, Spring(1.0))], ends=(0.0, None))": r"ends .*springs",
    "HalfSpace(STEEL, [Layer(STEEL, 1.0, 'frictionless')], ends=(None, 0.0))": r"ends must not"
    r" .*slips.*bonded",
    "solve(BALL, PLATE, load=1.0)": r"must not have a free base.*RIGID.*periodic",
    "solve(BALL, STEEL, PLATE, load=1.0)": r"must not have a free base",
    "Contact(PLATE, GRID)": r"must not have a free base",
    "slide(BALL, PLATE, load=1.0, friction=0.1)": r"must not have a free base",
    "nacre.indent.Indentation(PLATE, nacre.indent.Tip.sphere(1e-6))": r"must not have a free base",
    "influence_coefficients(PLATE, GRID)": r"must not have a free base",
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
    "hertz.equivalent_radius(5e-3, -4e-3)": r"1/radius \+ 1/counter_radius must be above 0",
    "hertz.relative_radii((None, 5e-3), (None, 5e-3), 0.0)": r"parallel cylinders touch along",
    "hertz.relative_radii((None, 0.0), (None, 5e-3), 1.0)": r"radii must be .*other than 0.*got 0",
    "hertz.equivalent_radius(0.0)": r"radius must be .*other than 0.*got 0",
    "hertz.Point(1.0, 0.0, 1.0)": r"contact_modulus must be .*above 0, got 0",
    "hertz.Line(1.0, 1.0, -1.0)": r"line_load must be .*above 0, got -1",
    "hertz.Ellipse(1.0, 1.0, 1.0, 1.0, counter_radius_x=-1.0)": r"must be convex together",
    "hertz.Ellipse(1.0, 1e300, 1.0, 1.0)": r"radii.*too different",
    "hertz.Point(1.0, 1.0, 1.0).max_shear(0.6)": r"poisson must be .*at most 0\.5, got 0\.6",
    "LogarithmicProfile(0.0, 1.0)": r"amplitude must be .*above 0, got 0",
    "LogarithmicProfile(1.0, INF)": r"length must be finite.*got inf",
    "LogarithmicProfile(1.0, 1.0, 1.0)": r"flat_length must be .*below.*length, got 1",
    "LogarithmicProfile.lundberg(0.0, 1.0, 1.0)": r"length must be .*above 0, got 0",
    "LogarithmicProfile.iso16281(-1.0, 1.0)": r"diameter must be .*above 0, got -1",
    "LogarithmicProfile.fujiwara_kawase(1.0, 1.0, 1.0, 0.0, 1.0, 1.0)": r"k1 must be .*above 0",
    "LogarithmicProfile.fujiwara_kawase(1.0, 1.0, 1.0, 1.0, 1.1, 1.0)": r"k2 must be .*at most 1",
    "LogarithmicProfile.fujiwara_kawase(1.0, 1.0, 1.0, 1.0, 1.0, -1.0)": r"z_m must be .*above 0",
    "SampledProfile([0.0, 1.0], [0.0])": r"drop.*\b2\b.*\b1\b",
    "SampledProfile([0.0], [0.0])": r"at least two",
    "SampledProfile([0.0, NAN], [0.0, 1.0])": r"not finite at .*1",
    "SampledProfile(HEIGHTS, HEIGHTS)": r"x must have one dimension.*\[4, 5\]",
    "BALL.shifted(NAN, 0.0)": r"x must be finite, got NaN",
    # height maps
    "HeightMap(HEIGHTS, 1e-9).gaps(GRID)": r"grid spacing must be at most twice.*got (0\.0|2\.5e-)",
    # grids
    "Grid((-4, 4), (1.0, 1.0))": r"shape must be .*at least 2.*got -4",
    "Grid((4, 4, 4), (1.0, 1.0))": r"(?s)length 2.*3.*shape",
    "Grid((2**62, 2**62), (1.0, 1.0))": r"shape must be .*got 2126764793",
    "Grid((2**70, 4), (1.0, 1.0))": r"shape must be .*(count|at most).*got 11805916207174113",
    "Grid((4, 4), (1.0, INF))": r"size must be finite.*got inf",
    "Grid((4, 4), (1.0, 1.0, 1.0))": r"(?s)length 2.*3.*size",
    "Grid((4, 4), (1.0, 1.0), center=(0.0, NAN))": r"center must be finite, got NaN",
    "Grid.line(1, 1.0)": r"cells must be .*at least 2, got 1",
    "Grid.line(4, -1.0)": r"width must be .*above 0, got -1",
    # plans
    "Contact(STEEL, GRID, coefficients=np.ones((16, 16)))": r"\[16, 20\].*\[16, 16\]",
    "Contact(STEEL, GRID, coefficients=np.full((16, 20), NAN))": "coefficients is not finite at",
    "Contact(STEEL, GRID, coefficients=-np.ones((16, 20)))": "not positive definite",
    "Contact(STEEL, GRID, threads=0)": r"threads must be .*at least 1, got 0",
    "Contact(STEEL, GRID, threads=-2)": r"threads must be .*at least 1, got -2",
    "influence_coefficients(STEEL, GRID, 'magic')": r"method must be .*exact.*plain.*magic",
    "influence_coefficients(STEEL, GRID, 'plain', 0)": r"refinement must be .*at least 1, got 0",
    # frequency response
    "frequency_response(STEEL, 0.0)": r"wavenumber must be .*above 0, got 0",
    "frequency_response(STEEL, [1.0, -2.0])": r"wavenumber must be .*above 0, got -2",
    "frequency_response(STEEL, 5e-324)": r"wavenumber must be .*finite: neither that small",
    "surface_compliance(STEEL, [1.0, 1e-323])": r"wavenumber must be .*neither that small",
    # graded coatings
    "graded_layers(STEEL, 0.0, 1e9, 0.3)": r"thickness must be .*above 0, got 0",
    "graded_layers(STEEL, 1.0, -1e9, 0.3)": r"young must be .*got -1000000000",
    "graded_layers(STEEL, 1.0, 1e9, lambda z: z)": r"poisson must be .*0\.5, got 0\.",
    "graded_layers(STEEL, 1.0, 1e9, 0.3, 2.0)": r"tolerance must be .*below 1, got 2",
    "graded_layers(STEEL, 1.0, 1e9, 0.3, breakpoints=[0.5, 1.0])": r"breakpoints must be .*got 1",
    # controls
    "press()": r"exactly one of load and approach",
    "press(load=1.0, approach=1e-6)": r"exactly one of load and approach",
    "press(load=-1.0)": r"load must be .*above 0, got -1",
    "press(approach=NAN)": r"approach must be finite, got NaN",
    "press(load=1.0, eccentricity=(NAN, None))": r"eccentricity must be finite, got NaN",
    "press(load=1.0, moment=(None, INF))": r"moment must be finite, got inf",
    "press(approach=1e-6, eccentricity=(None, 0.0))": r"eccentricity needs load",
    "press(load=1.0, eccentricity=(0.0, None), tilt=(0.0, None))": r"along x at most one of",
    # the load point, on a grid whose cell centres end at 1.875e-4
    "press(load=1.0, eccentricity=(1.9e-4, None))": r"load point \(1\.9.*must lie .*inside",
    "press(load=1.0, eccentricity=(None, -1.0))": r"load point \(0.*-1\.0.*must lie .*inside",
    "press(load=2.0, moment=(1.0, None))": r"load point \(5\.0*e-1.*must lie .*inside",
    "CONTACT.solve(PUNCH, load=1.0, eccentricity=(1.2e-4, 0.0))": r"load point \(1\.2.*inside",
    # options
    "press(load=1.0, tolerance=1.0)": r"tolerance must be .*below 1, got 1",
    "press(load=1.0, max_iterations=-1)": r"max_iterations must be .*at least 0, got -1",
    "press(load=1.0, algorithm='magic')": r"algorithm must be .*magic",
    "press(load=1.0, initial=np.zeros((3, 4)))": r"initial.*shape \[16, 20\].*\[3, 4\]",
    "press(load=1.0, initial=np.zeros(20))": r"initial must have two dimensions.*\[20\]",
    "press(load=1.0, initial=np.full((16, 20), NAN))": r"initial is not finite at \[0, 0\]",
    "press(load=1.0, initial=np.full((16, 20), -3.0))": r"initial must be .*at least 0.*-3",
    "solve(Cylinder(5e-3), STEEL, load=1.0)": r"grid must be given",
}

TYPES = {
    **dict.fromkeys(
        (
            "HalfSpace(nacre.materials['100Cr6'])",
            "Layer(nacre.materials['100Cr6'], 1.0)",
            "nacre.solve(BALL, nacre.materials['100Cr6'], load=1.0)",
        ),
        r"Elastic.*got .*100Cr6.*: give its \.elastic",
    ),
    "Elastic('hard', 0.3)": r"(?s)number.*young",
    "Elastic(1j, 0.3)": r"(?s)number.*young",
    "Elastic(np.complex128(1 + 2j), 0.3)": r"(?s)real number, got np.complex128.*young",
    "Elastic(np.array(1 + 0j), 0.3)": r"(?s)real number, got array.*young",
    "Layer(STEEL, np.complex64(1))": r"(?s)real number, got .*thickness",
    "Grid((4, 4), (1.0, np.complex128(1)))": r"(?s)pair of numbers, got .*size",
    "Elastic(1.0, None)": r"(?s)number.*poisson",
    "Layer('steel', 1.0)": "material must be an Elastic, got 'steel'",
    "Layer(STEEL, 'thin')": r"(?s)number.*thickness",
    "Layer(STEEL, 1.0, 3)": r"interface must be .*Spring, got 3",
    "HalfSpace('steel')": r"substrate must be an Elastic, .*RIGID or .*FREE, got .*steel",
    "HalfSpace(None)": r"substrate must be an Elastic, .*RIGID or .*FREE, got None",
    "HalfSpace(STEEL, [STEEL])": r"layers must be a sequence of Layer, got Elastic.* in it",
    "HalfSpace(STEEL, Layer(STEEL, 1.0))": r"layers must be a sequence of Layer, got Layer",
    "HalfSpace(STEEL, ends=1.0)": r"ends must be a pair of numbers or None, got 1\.0",
    "HalfSpace(STEEL, ends=('left', None))": r"ends must be a pair.*'left'",
    "HalfSpace(STEEL, [], (0.0, 1.0))": r"positional",
    "Sphere('round')": r"(?s)number.*radius",
    "Sphere([1.0, 2.0])": r"(?s)number.*radius",
    "BALL + Elastic(1.0, 0.3)": r"unsupported operand",
    "BALL.shifted('left', 0.0)": r"(?s)number.*x",
    "BALL.gaps('grid')": r"(?s)Grid.*grid",
    "Roller(1.0, profile=3)": r"profile must be .*LogarithmicProfile.*got 3",
    "Roller(1.0, profile=('a', 'b'))": r"x must be a real array.*<U1",
    "HeightMap(HEIGHTS, 'fine')": r"spacing must be .*number.*fine",
    "HeightMap(HEIGHTS, (1.0, 1.0, 1.0))": r"spacing must be .*1\.0, 1\.0, 1\.0",
    "HeightMap(HEIGHTS, 1.0, center=0.0)": r"(?s)(float|tuple|pair).*center",
    "Grid(4, (1.0, 1.0))": r"(?s)expected a sequence, got 4.*shape",
    "Grid((4.5, 4), (1.0, 1.0))": r"shape must be an integer, got 4\.5",
    "Grid((True, 4), (1.0, 1.0))": r"shape must be an integer, got True",
    "Grid('ab', (1.0, 1.0))": r"(?s)expected a sequence, got 'ab'.*shape",
    "Grid((4, 4), 1.0)": r"(?s)pair of numbers, got 1\.0.*size",
    "Grid.line(2.5, 1.0)": r"cells must be an integer, got 2\.5",
    "Contact('steel', GRID)": r"body.*must be a HalfSpace, an Elastic or a Response, got .*steel",
    "Contact(STEEL, (16, 20))": r"(?s)Grid.*grid",
    "Contact(STEEL, GRID, 'steel')": r"counterbody.*must be a HalfSpace.*steel",
    "Contact(STEEL, GRID, coefficients='exact')": r"coefficients must be a real array.*<U5",
    "Contact(STEEL, GRID, method='exact')": r"unexpected keyword argument 'method'",
    "influence_coefficients(STEEL, GRID, 3)": "(?s)int.*method",
    "influence_coefficients(STEEL, GRID, 'plain', 1.5)": r"refinement must be an integer, got 1\.5",
    "Contact(STEEL, GRID, threads='all')": r"threads must be an integer, got .*all",
    "frequency_response('steel', 1.0)": r"body.*must be a HalfSpace.*steel",
    "graded_layers('steel', 1.0, 1e9, 0.3)": r"substrate must be .*steel",
    "graded_layers(STEEL, 1.0, 'hard', 0.3)": r"young must be .*hard",
    "graded_layers(STEEL, 1.0, lambda z: 'hard', 0.3)": r"young must be .*hard",
    "graded_layers(STEEL, 1.0, 1e9, 0.3, breakpoints=0.5)": r"breakpoints must be a sequence",
    "graded_layers(STEEL, 1.0, lambda z: 1e9 + 1j, 0.3)": r"young must be .*got \(1000000000",
    "CONTACT.solve('sphere', load=1.0)": r"shape must be a nacre\.Shape, got .*sphere",
    "solve(BALL, 'steel', load=1.0)": r"body.*must be a HalfSpace.*steel",
    "solve(BALL, STEEL, grid=(16, 20), load=1.0)": r"grid must be a nacre\.Grid, got \(16, 20\)",
    "press(load='1')": r"load must be a real number, got '1'",
    "press(load=1j)": r"load must be a real number, got 1j",
    "press(load=np.complex128(1))": r"load must be a real number, got np.complex128",
    "press(load=1.0, tilt=(0.0, np.complex64(1)))": r"tilt must be a pair",
    "BALL.shifted(np.complex128(1), 0.0)": r"(?s)real number, got .*x",
    "stress(STEEL, GRID, np.ones((16, 20)), 1e-5, residual=[1j])": r"residual must be .*numbers",
    "stress(STEEL, GRID, np.ones((16, 20)), 1e-5, residual=np.array([1e6 + 5e6j]))": (
        r"residual must be .*numbers, .*got array"
    ),
    "stress(STEEL, GRID, np.ones((16, 20)), 1e-5, residual={0: 1j})": r"residual must hold real",
    "stress(STEEL, GRID, np.ones((16, 20)), 1e-5, friction=np.complex128(1))": r"friction must",
    "stress(STEEL, GRID, np.ones((16, 20)), 1j)": r"z must be a real array",
    "press(approach=[1.0])": r"approach must be a real number, got \[1\.0\]",
    "press(load=1.0, eccentricity=1e-5)": r"eccentricity must be a pair.*got 1e-05",
    "press(load=1.0, moment=(1.0, 'b'))": r"moment must be a pair.*'b'",
    "press(load=1.0, tolerance='tight')": r"tolerance must be a real number, got 'tight'",
    "press(load=1.0, max_iterations=2.5)": r"max_iterations must be an integer, got 2\.5",
    "press(load=1.0, algorithm=1)": r"algorithm must be a str, got 1",
    "press(load=1.0, progress=3)": r"progress must be callable, got 3",
    "press(load=1.0, check='no')": r"check must be a bool, got 'no'",
    "press(load=1.0, weight=1.0)": r"unexpected keyword argument 'weight'",
    "press(1.0)": r"positional",
}

# Friction.

CELLS = nacre.Grid((32, 28), (2e-4, 1.8e-4))
BOTH = nacre.Contact(STEEL, CELLS, STEEL)
OTHER = nacre.Contact(STEEL, nacre.Grid((16, 20), (2e-4, 1.8e-4)), STEEL)
LINE = nacre.Contact(STEEL, nacre.Grid.line(64, 4e-4), STEEL)
LAST = BOTH.slide(BALL, **HELD, force=(1.0, None))
ROLLED = BOTH.roll(BALL, **HELD, direction="+x")
FREE = nacre.HalfSpace(STEEL, ends=(-1e-3, 1e-3))
ONE = {"force": (1.0, None)}


def slides(**keywords: Any) -> Any:
    return BOTH.slide(BALL, **HELD | keywords)


def rolls(**keywords: Any) -> Any:
    return BOTH.roll(BALL, **HELD | {"direction": "+x"} | keywords)


def history(*steps: Any, **keywords: Any) -> Any:
    return BOTH.slide(BALL, steps, **HELD | keywords)


FRICTION_VALUES = {
    "slides(shift=(1e-6,))": r"shift must be a pair.*got \(1e-06,\)",
    # friction
    "slides(friction=-0.1)": r"friction must be finite and at least 0, got -0\.1",
    "slides(friction=NAN)": r"friction must be finite.*got NaN",
    "slides(friction=INF)": r"friction must be finite.*got inf",
    "slides(friction=None)": r"first step must have a coefficient of friction",
    "rolls(friction=None)": r"friction must be given in rolling",
    "slides(friction=np.ones((3, 4)))": r"friction: expected shape \[32, 28\], got \[3, 4\]",
    "slides(friction=np.zeros((0, 0)))": r"friction: expected shape \[32, 28\], got \[0, 0\]",
    "rolls(friction=np.ones((28, 32)))": r"friction: expected shape \[32, 28\], got \[28, 32\]",
    "slides(friction=np.full((32, 28), NAN))": r"friction must be finite.*got NaN",
    "slides(friction=np.full((32, 28), -2))": r"friction must be .*at least 0, got -2",
    # motion
    "slides(shift=(NAN, None))": r"shift must be finite, got NaN",
    "slides(shift=(None, -INF))": r"shift must be finite, got -inf",
    "slides(force=(NAN, None))": r"force must be finite, got NaN",
    "slides(force=(10**400, None))": r"force must be finite, got inf",
    "slides(twist=NAN)": r"twist must be finite, got NaN",
    "slides(torque=INF)": r"torque must be finite, got inf",
    "slides(shift=(1e-7, None), force=(1.0, None))": r"shift and force along one axis.*not both",
    "slides(twist=1e-3, torque=1e-6)": r"twist and torque, one must be given, not both",
    "rolls(creepage=(NAN, None))": r"creepage must be finite, got NaN",
    "rolls(force=(None, INF))": r"force must be finite, got inf",
    "rolls(spin=NAN)": r"spin must be finite, got NaN",
    "rolls(creepage=(0, None), force=(1, None))": r"creepage and force along one axis.*not both",
    "rolls(direction=None)": r"direction must be \"\+x\", .* any direction",
    "rolls(direction='x')": r"direction must be \"\+x\", .*got \"x\"",
    "rolls(cells=0)": r"cells must be an integer of at least 1, got 0",
    "rolls(cells=10**30)": r"cells must be an integer that this machine can count to, got 10000",
    "rolls(initial=LAST)": r"initial must be given with cells",
    "rolls(load=1e3)": r"contact must end a cell or more before the edge of the grid",
    # load
    "slides(load=None)": r"first step must have a load or an approach",
    "slides(load=0.0)": r"load must be .*above 0, got 0",
    "slides(approach=1e-6)": r"exactly one of load and approach",
    "rolls(load=None)": r"exactly one of load and approach",
    # line contact
    "LINE.slide(ROD, load=1e4, friction=0.3, twist=1e-3)": r"twist and torque must not .* line",
    "LINE.slide(ROD, load=1e4, friction=0.3, torque=0)": r"twist and torque must not .* line",
    "LINE.roll(ROD, load=1e4, friction=0.3, spin=1.0)": r"in line contact.*spin 0",
    "LINE.roll(ROD, load=1e4, friction=0.3, direction='+x')": r"in line contact.*\+y or -y",
    # histories
    "history(ONE, force=(1.0, None))": r"shift, force, twist and torque must be .* in the steps",
    "history(ONE, twist=0.0)": r"shift, force, twist and torque must be .* in the steps",
    "history(ONE, {'force': (NAN, None)})": r"force must be finite, got NaN",
    "history(ONE, {'load': -3})": r"load must be .*above 0, got -3",
    "history(ONE, {'friction': -1})": r"friction must be .*at least 0, got -1",
    "BOTH.slide(BALL, [ONE])": r"first step must have a load or an approach",
    # search
    "slides(tolerance=0)": r"tolerance must be above 0 and below 1, got 0",
    "rolls(tolerance=NAN)": r"tolerance must be above 0 and below 1, got NaN",
    "slides(max_convolutions=0)": r"max_convolutions must be an integer of at least 1, got 0",
    # bodies
    "slide(BALL, FREE, STEEL, **HELD)": r"friction needs bodies without free ends along x",
    "slide(BALL, STEEL, SLIPPING, **HELD)": r"friction needs .*without frictionless interfaces",
    "roll(BALL, SLIPPING, direction='+x', **HELD)": r"without frictionless interfaces",
    "slide(ROD, STEEL, **HELD)": r"grid must be given",
    "slide(BALL, STEEL, friction=0.3)": r"load or approach must be given",
    "slide(BALL, STEEL, threads=0, **HELD)": r"threads must be .*at least 1, got 0",
    # coefficients
    "coefficients(STEEL, STEEL, (1e-3, 0.0))": r"semi_axes must be finite and above 0, got 0",
    "coefficients(STEEL, STEEL, (NAN, 1.0))": r"semi_axes must be finite and above 0, got NaN",
    "coefficients(STEEL, STEEL, (1.0, 1.0), cells=4)": r"cells must be .* at least 8, got 4",
    "coefficients(SLIPPING, STEEL, (1.0, 1.0))": r"without frictionless interfaces",
    # results
    "LAST.save('a.txt')": r"path must end in \.nc, \.vtr, \.csv.*got 'a\.txt'",
    "LAST.stress(0.0, friction=0.1)": r"friction must be 0: the tractions .* are known",
    "LAST.stress_plan().stress(0.0, friction=0.1)": r"friction must be 0: the tractions",
    "LAST.stress(-1.0)": r"z must be .*at least 0",
    "friction.history([])": r"solutions must hold at least one solution, got none",
    "curve(creepages=[[1e-3]])": r"creepages must be a sequence of numbers, got shape \(1, 1\)",
    "curve(creepages=[])": r"creepages must be a sequence of numbers, got shape \(0,\)",
    "curve(creepages=1e-3)": r"creepages must be a sequence of numbers, got shape \(\)",
    "curve(creepages=[1e-3], force=(1, None))": r"force must not be given: creepages say",
    "curve(creepages=[1e-3], cells=3)": r"cells must not be given: creepages say",
    "friction.history([LAST, ROLLED])": r"solutions must all slide or all roll",
    "plot.loop([])": r"solutions must hold at least one solution, got none",
    "OTHER.slide(BALL, initial=LAST, **HELD)": "initial must be a solution on",
    "slides(shift=(1e300, None))": "shift must be at most a million times",
    "rolls(creepage=(1e300, None))": "creepage must be at most a million",
    "rolls(spin=1e300)": "spin must be at most a million over",
    "slides(torque=1.0)": "torque must be below what friction can carry",
    "slide(BALL, STEEL, steps=[], **HELD)": "steps must",
    "slides(friction=np.ones(28))": "friction must have two dimensions",
    "coefficients(STEEL, STEEL, (1.0, 1.0), cells=-4)": "cells must be .*at least 8",
    "coefficients(FREE, STEEL, (1.0, 1.0))": "without free ends along x",
}

FRICTION_TYPES = {
    "slides(friction='rough')": r"friction must be a real array, got dtype <U5",
    "slides(friction=1j)": r"friction must be a real array, got dtype complex128",
    "slides(friction=np.ma.masked_equal(np.ones((32, 28)), 2))": r"friction must .*without a mask",
    "slides(shift=1e-6)": r"shift must be a pair of numbers or None, got 1e-06",
    "slides(shift='ab')": r"shift must be a pair.*got 'ab'",
    "slides(force=(1j, None))": r"force must be a pair.*got \(1j, None\)",
    "slides(twist='x')": r"twist must be a real number, got 'x'",
    "slides(torque=[1])": r"torque must be a real number, got \[1\]",
    "slides(coupling='no')": r"coupling must be a bool, got 'no'",
    "slides(check='no')": r"check must be a bool, got 'no'",
    "slides(progress=3)": r"progress must be callable, got 3",
    "slides(initial=3)": r"initial must be a nacre\.types\.FrictionSolution, got 3",
    "slides(initial=LAST.normal)": r"initial must be a nacre\.types\.FrictionSolution, got <Sol",
    "slides(max_iterations=3)": r"unexpected keyword argument 'max_iterations'",
    "slides(creepage=(1e-3, None))": r"unexpected keyword argument 'creepage'",
    "rolls(creepage=1e-3)": r"creepage must be a pair.*got 0\.001",
    "rolls(spin='x')": r"spin must be a real number, got 'x'",
    "rolls(cells=2.5)": r"cells must be an integer, got 2\.5",
    "rolls(twist=3)": r"unexpected keyword argument 'twist'",
    "history(ONE, 3)": r"a step must be a mapping of keywords of `slide`, got 3",
    "history(ONE, None)": r"a step must be a mapping.*got None",
    "history(ONE, {'shift': 3})": r"(?s)shift must be a pair.*step 1",
    "history(ONE, {'colour': 1})": r"(?s)keys of a step must be among load, .*'colour'.*step 1",
    "history({3: 4})": r"(?s)keys of a step must be among .* got 3.*step 0",
    "history(ONE, {'tolerance': 1e-6})": r"keys of a step must be among .* got 'tolerance'",
    "BOTH.slide(BALL, ONE, **HELD)": r"a step must be a mapping.*got 'force'",
    "BOTH.slide('ball', **HELD)": r"shape must be a nacre\.Shape, got 'ball'",
    "slide(BALL, STEEL, grid=3, **HELD)": r"grid must be a nacre\.Grid, got 3",
    "slide(BALL, nacre.RIGID, STEEL, **HELD)": r"body.*must be a HalfSpace.*got RIGID",
    "slide(BALL, STEEL, weight=1, **HELD)": r"unexpected keyword argument 'weight'",
    "roll(BALL, STEEL, weight=1, direction='+x', **HELD)": r"unexpected keyword argument 'weight'",
    "coefficients('steel', STEEL, (1.0, 1.0))": r"must be a HalfSpace or an Elastic, got 'steel'",
    "coefficients(STEEL, 3, (1.0, 1.0))": r"must be a HalfSpace or an Elastic, got 3",
    "coefficients(STEEL, STEEL, ('a', 1.0))": r"(?s)pair of numbers, got \('a', 1.0\).*semi_axes",
    "coefficients(STEEL, STEEL, (1.0, 1.0), cells=8.5)": r"(?s)integer.*cells",
    "LAST.plot(3)": r"axes must be axes of Matplotlib, got 3",
    "curve(creepages=['fast'])": r"creepages must be a real array, got dtype <U4",
    "curve(creepages=[1j])": r"creepages must be a real array, got dtype complex",
    "curve(creepages=np.ma.masked_equal([1e-3, 2e-3], 1e-3))": r"creepages must .*without a mask",
    "friction.history([3])": r"solutions must be a sequence of FrictionSolution, got \[3\]",
    "friction.history(LAST)": r"solutions must be a sequence of FrictionSolution, got <Fric",
    "friction.history(None)": r"solutions must be a sequence of FrictionSolution, got None",
    "plot.loop(LAST)": r"solutions must be a sequence of FrictionSolution, got <Fric",
    "plot.loop([LAST], axes=3)": r"axes must be axes of Matplotlib, got 3",
    "plot.creep_curve(None, axes=3)": r"axes must be axes of Matplotlib, got 3",
    "plot.friction(3)": r"solution must be a FrictionSolution, got 3",
    "curve(creepages=[1e-3], colour=3)": r"unexpected keyword argument 'colour'",
    "nacre.types.FrictionSolution()": r"FrictionSolution",
    "slides(steps=3)": "steps must be",
    "rolls(direction=3)": "direction must be",
    "coefficients(STEEL, STEEL, 1.0)": "pair of numbers",
}

# Convolutions, periodic grids, stresses and gradients.

SMALL = nacre.Grid(shape=(12, 9), size=(1.2e-5, 6e-6))
CONVOLUTION = nacre.Convolution.of_bodies(STEEL, SMALL)
SOFT = nacre.Elastic(1.0, 0.0)
SQUARE = nacre.Grid((4, 4), (1.0, 1.0))
OPEN = nacre.Grid((32, 24), (1.0, 0.75))
REPEATING = nacre.Grid((32, 24), (1.0, 0.75), periodic=(True, True))
HALF = nacre.Grid((16, 24), (0.5, 0.75), periodic=(True, True))
X, Y = np.meshgrid(REPEATING.x, REPEATING.y, indexing="ij")
WAVES = 1e-3 * np.cos(2 * np.pi * X) + 5e-4 * np.cos(2 * np.pi * Y / 0.75)
MAP = nacre.HeightMap(WAVES, 1 / 32, periodic=(True, True))
MEAN = WAVES.max() - WAVES.mean()

FINE = nacre.Grid(shape=(41, 31), size=(4.1e-4, 3.1e-4))
ON_RIGID = nacre.HalfSpace(nacre.RIGID, [nacre.Layer(STEEL, 1e-5)])
PRESSED = nacre.solve(BALL, COATED, HARD, grid=FINE, load=5.0)
BY_RIGID = nacre.solve(BALL, COATED, grid=FINE, load=5.0)
UNFINISHED = quiet(nacre.solve, BALL, STEEL, grid=FINE, load=5.0, max_iterations=1, check=False)
ON_STEEL = nacre.solve(BALL, STEEL, grid=FINE, load=5.0)
PLAN = BY_RIGID.stress_plan()
PRESSURE = PRESSED.pressure

FIELD_VALUES = {
    "Convolution([1.0, 2.0])": "coefficients must have two dimensions",
    "Convolution([[1.0, NAN]])": r"coefficients is not finite at",
    "Convolution(np.zeros((0, 2)))": r"coefficients.*\[0, 2\]",
    "Convolution([[1.0]], threads=0)": "threads must be .*at least 1, got 0",
    "CONVOLUTION.apply(np.zeros((9, 12)))": r"shape \[12, 9\].*\[9, 12\]",
    "CONVOLUTION.apply(np.full((12, 9), NAN))": "pressure is not finite at",
    "surface_compliance(STEEL, 0.0)": "wavenumber must be .*above 0, got 0",
    # periodic grids
    "solve(MAP, SOFT, load=1.0, tilt=(1e-3, None))": "along x the grid is",
    "Contact(SOFT, REPEATING).solve(Sphere(9.0).shifted(0.2, 0), load=1e-3)": "shape must repeat "
    "along x",
    "influence_coefficients(SOFT, REPEATING, 'image')": '"exact" or "spectral" on a periodic',
    "influence_coefficients(SOFT, SQUARE, 'spectral')": "periodic along x and along y",
    "Contact(SOFT, REPEATING, coefficients=influence_coefficients(SOFT, OPEN))": "at the offsets",
    "slide(MAP, SOFT, SOFT, load=1e-3, friction=0.1)": "not periodic",
    "solve(MAP, SOFT, grid=OPEN, load=1e-3)": r"repeat along x as the shape does, with its period "
    r"1e0 .* was a grid that does not repeat",
    # The height at both ends of half a period is the same.
    "solve(MAP, SOFT, grid=HALF, load=1e-3)": r"repeat along x as the shape does, with its period "
    r"1e0 .* was a grid of period 5e-1",
    "solve(MAP, SOFT, grid=Grid.line(24, 0.75), load=1e-3)": "repeat along y",
    "solve(MAP + MAP, SOFT, grid=OPEN, load=1e-3)": "repeat along x",
    "solve(MAP, SOFT, approach=1.01 * MEAN)": r"approach must be below 0\.00149\d*, the mean gap.*"
    r"was 0\.0015\d*",
    # stresses
    "PRESSED.stress(-1e-6)": r"^z must be finite and at least 0, got -0.000001$",
    "PRESSED.stress(NAN)": r"^z must be finite and at least 0, got NaN$",
    "PRESSED.stress([[0.0]])": r"^z must be a depth or a sequence of depths, got shape \[1, 1\]$",
    "PRESSED.stress(0.0, side='left')": r'^side must be "above" or "below", got "left"$',
    "PRESSED.stress(0.0, body='both')": r'^body must be "body" or "counterbody", got "both"$',
    "PRESSED.stress(0.0, x=1.0)": r"^x must be on the grid, got 1$",
    "PRESSED.stress(0.0, y=INF)": r"^y must be finite, got inf$",
    "PRESSED.stress(0.0, friction=-0.1)": r"^friction must be at least 0 \(turn the direction\), "
    "got -0.1$",
    "PRESSED.stress(0.0, friction=NAN)": r"^friction must be finite, got NaN$",
    "PRESSED.stress(0.0, direction=(0.0, 0.0))": r"^direction must be a vector of finite length "
    "above 0, got 0$",
    "PRESSED.stress(0.0, residual={2: 1e9})": r'^keys of residual must be "substrate"',
    "PRESSED.stress(0.0, residual={'DLC': 1e9})": r"or names of layers \(here they have none\), "
    "got 'DLC'$",
    "PRESSED.stress(0.0, residual=[1.0, 2.0, 3.0])": r"^residual must hold at most 2 values",
    "PRESSED.stress(0.0, residual={0: INF})": r"^residual must be finite, got inf$",
    "PRESSED.stress(0.0, threads=0)": r"^threads must be an integer of at least 1, got 0$",
    "BY_RIGID.stress(0.0, body='counterbody')": r'^body must be "body" where the counterbody is '
    "rigid$",
    "stress(ON_RIGID, FINE, PRESSURE, 1e-5)": r"^z must be above the rigid substrate",
    "stress(SLIPPING, FINE, PRESSURE, 0.0, friction=0.1)": r"^friction must be 0 on a body with a "
    "frictionless",
    "stress(COATED, FINE, np.zeros((3, 3)), 0.0)": r"^pressure: expected shape \[41, 31\]",
    "stress(COATED, Grid((2, 2), (1.0, 1.0)), [[0.0, INF], [0.0, 0.0]], 0.0)": r"^pressure is not "
    r"finite at \[0, 1\]$",
    "PRESSED.stress_summary(yield_stress=[-1.0])": r"^yield_stress must be finite and above 0, got "
    "-1$",
    "PRESSED.stress_summary(refine=0.0)": r"^refine must be above 0 and below 1: .*, got 0$",
    "PRESSED.stress_summary(refine=1.0)": r"^refine must be above 0 and below 1: .*, got 1$",
    "PRESSED.stress_plan('table')": 'body must be "body" or "counterbody", got "table"',
    "PRESSED.stress_plan(threads=0)": r"threads must be .*at least 1, got 0",
    "BY_RIGID.stress_plan('counterbody')": 'body must be "body" where the counterbody is rigid',
    # gradients
    "PRESSED.gradient('contact_area')": "participation area",
    "PRESSED.gradient('contact_extent')": "area estimate",
    "PRESSED.gradient('resistance')": "the conductance changes in steps",
    "PRESSED.gradient('peak')": 'output must be "approach"',
    "PRESSED.gradient(('peak', 8.0))": "pressure_norm",
    "PRESSED.gradient({'stress': 'zz'})": "exactly one of the keys",
    "PRESSED.gradient({'stress': 'mises', 'interface': 0})": 'stress must be "xx"',
    "PRESSED.gradient({'stress': 'zz', 'interface': 0, 'depth': 1.0})": "keys of a stress",
    "PRESSED.gradient({'stress': 'zz', 'interface': 3})": "counted from 0",
    "PRESSED.gradient(('pressure', (1.0, 0.0)))": "x must be on the grid",
    "PRESSED.gradient('approach', ['moment[0]'])": r"moment\[0\] has no derivative",
    "PRESSED.gradient('approach', tolerance=0.0)": "tolerance must be above 0",
    "PRESSED.vjp(np.ones((2, 2)))": "expected shape",
    "UNFINISHED.gradient('approach')": "did not converge",
}

FIELD_TYPES = {
    "Convolution([['a']])": "coefficients must be a real array",
    "CONVOLUTION.apply(1j * np.ones((12, 9)))": "pressure must be a real array",
    "Convolution.of_bodies(STEEL, SMALL, mehtod='exact')": "unexpected keyword argument .mehtod",
    "Convolution.of_bodies('steel', SMALL)": "must be a HalfSpace, an Elastic or a Response",
    "surface_compliance(STEEL, ['a'])": "wavenumber must be a real array",
    "surface_compliance('steel', 1.0)": "must be a HalfSpace or an Elastic",
    "Grid((4, 4), (1.0, 1.0), periodic=True)": "periodic must be a pair of bools",
    "Grid((4, 4), (1.0, 1.0), periodic=(1, 0))": "periodic must be a pair",
    "HeightMap(WAVES, 1.0, periodic=(True,))": "periodic must be a pair",
    "PRESSED.stress_summary(strength=3.0)": r"^strength must be a dict",
    "PLAN.stress(0.0, threads=1)": r"StressPlan\.stress.* unexpected keyword argument 'threads'",
    "PLAN.summary(side='above')": r"StressPlan\.summary.* unexpected keyword argument 'side'",
    "PRESSED.gradient(3.0)": "a word, a pair or a dict",
}

# Bearings and wear.

ROLLERS = {"count": 14, "diameter": 10e-3, "length": 9.6e-3, "pitch_diameter": 65e-3}
BALL_SIZES = {"count": 7, "diameter": 11.5e-3, "pitch_diameter": 43.5e-3}
BARRELS = {"count": 19, "diameter": 12e-3, "length": 11e-3, "pitch_diameter": 82e-3}
BARRELS |= {"profile_radius": 46.5e-3, "contact_angle": 0.17}
CONES = {"count": 17, "diameter": 8e-3, "length": 11e-3, "pitch_diameter": 48e-3}
CONES |= {"contact_angle": 0.25}


def made(kind: Any, sizes: dict[str, Any]) -> Callable[..., Any]:
    """Return a function that makes a bearing of these sizes, but for those that are given."""
    return lambda **given: kind(**sizes | given)


def worn(**keywords: Any) -> Any:
    """Call for a short history of a coated roller."""
    coat = nacre.Layer(nacre.Elastic(300e9, 0.25), 2e-6, name="DLC")
    given: dict[str, Any] = {"load": 1e5, "grid": nacre.Grid.line(64, 6e-4)}
    given |= {"rate": {0: 1e-17, "substrate": 1e-15}, "sliding": 100.0, "steps": 2}
    return nacre.wear(ROD, nacre.HalfSpace(STEEL, [coat]), **given | keywords)


BEARINGS = {
    "rollers(count=21)": "count must be at most 20",
    "rollers(count=1)": "count must be at least 2, got 1",
    "rollers(pitch_diameter=0.009)": "10 mm, for there is no room",
    "rollers(clearance=-0.001)": "clearance must be at least -0.2 mm.*got -1 mm",
    "rollers(length=0.0)": "length must be finite and above 0, got 0",
    "rollers(diameter=NAN)": "diameter must be finite and above 0, got nan",
    "rollers(raceway_diameters=(0.055, 0.0751))": "pitch_diameter must not be given",
    "rollers(pitch_diameter=None)": "pitch_diameter or raceway_diameters must be",
    "rollers(profile='round')": "profile must be a profile.*got 'round'",
    "rollers(raceway_crown=(0.0, None))": "raceway_crown must not be 0",
    "rollers(density=-1.0)": "density must be finite and above 0",
    "rollers(element=nacre.HalfSpace(STEEL, ends=(0.0, 1.0)))": "element must have no ends",
    "rollers(inner=nacre.HalfSpace(nacre.RIGID, [nacre.Layer(STEEL, 0.001)]))": (
        "inner must have an elastic substrate"
    ),
    "balls(osculation=(0.5, 0.53))": "osculation must be finite and above 0.5, got 0.5",
    "balls(osculation=(0.515, 0.515), clearance=0.001)": "clearance must be below twice the "
    r"distance.*0\.69 mm, got 1 mm",
    "balls(pitch_diameter=None)": "pitch_diameter must be given",
    "nacre.bearing.AngularContactBall(**BALL_SIZES, contact_angle=2.0)": "contact_angle must be "
    r"below π/2, in radians, got 2\.0",
    "rollers().solve(force=(1.0, None, 5.0))": "force along z must be None or 0: rollers without "
    "a contact angle",
    "rollers().solve(force=(1.0, None))": "force must be 3 numbers or None",
    "rollers().solve(force=(INF, None, None))": "force must be finite",
    "rollers().solve(force=(1.0, None, None), displacement=(1e-06, None, None))": (
        "force and displacement must not both be given along x, got 1.0 and 1e-06"
    ),
    "rollers().solve(moment=(None, 1.0), tilt=(None, 0.0001))": "moment and tilt must not both "
    "be given about y",
    "rollers().solve(model='hertz')": 'model must be "solved" or "iso16281"',
    "rollers().solve(cells=(50, 20))": "the first a multiple of 40, got",
    "rollers().solve(tolerance=0.0)": "tolerance must be finite and above 0, got 0.0",
    "rollers().solve(speed=NAN)": "speed must be finite, in rad/s, got nan",
    "barrels(rows=3)": "rows must be 1 or 2, got 3",
    "barrels(contact_angle=0.8)": "contact_angle must be at most π/4, in radians, got 0.8",
    "barrels(contact_angle=0.1)": "contact_angle must be larger for two rows.*overlap by .* mm",
    "barrels(profile_radius=0.048)": "profile_radius must be below those of the raceways, "
    r"47\.5997",
    "barrels(groove_radius=0.046)": "profile_radius must be below those of the raceways, 46 mm",
    "barrels(profile_radius=0.005)": "length must be below that at which the barrel is pointed",
    "barrels(pitch_diameter=None)": "pitch_diameter must be given",
    "barrels(length=-1.0)": "length must be finite and above 0, got -1",
    "tapered(contact_angle=0.0)": "contact_angle must be finite and above 0, got 0",
    "tapered(contact_angle=0.8)": "contact_angle must be at most π/4, in radians, got 0.8",
    "tapered(pitch_diameter=None)": "pitch_diameter must be given",
    "tapered(length=0.3)": r"length must be below 225\.6.* mm, where the roller ends at its apex",
    "tapered(count=19)": "count must be at most 18",
    "barrels().solve(force=(20e3, 1e3, 2e3), moment=(None, 1.0))": "moment must be None.*aligns "
    r"itself.*got \(None, 1\.0\)",
    "barrels(rows=1).solve(force=(1e3, None, 100.0))": "force along z must be at least 171",
    "tapered().solve(force=(1000.0, None, 100.0))": r"force along z must be at least 255\.342 "
    r"N.*got 100\.0 N",
}

WEAR = {
    "worn(rate=-1.0)": "rate must be finite and at least 0, got -1",
    "worn(rate={'TiN': 1e-17})": "TiN",
    "worn(rate={0: 1e-17})": "rate must hold a rate for substrate",
    "worn(sliding=None)": "one of sliding, cycles and passes must be given, got none",
    "worn(cycles=2.0)": "got sliding and cycles",
    "worn(sliding=-1.0, steps='auto')": "sliding must be finite and at least 0, got -1",
    "worn(sliding=-1.0)": "sliding must be finite and at least 0, got -1",
    "worn(sliding=None, cycles=-2.0)": "cycles must be finite and at least 0, got -2",
    "worn(sliding=INF)": "sliding must be finite and at least 0, got inf",
    "worn(slip=np.zeros((1, 64)))": "slip must be above 0 somewhere",
    "worn(steps=[50.0, 20.0, 100.0])": "steps must be finite, above 0 and increasing",
    "worn(steps=[50.0])": "steps must end at 100",
    "worn(steps='few')": 'steps must be "auto"',
    "worn(scheme='explicit')": "scheme must be",
    "worn(thickness='thin')": 'thickness must be "frozen" or "first order", got "thin"',
    "worn(until='worn')": "until must be",
    "worn(initial=np.full((1, 64), -1.0))": "initial",
    "worn(load=None)": "load or approach must be given",
}

WEAR_KINDS = {
    "worn(sliding=None, cycles=1.0, slide=5)": "slide must be a mapping of keywords, got 5",
    "worn(sliding=None, passes=1.0, roll='x')": "roll must be a mapping of keywords, got",
    "worn(sliding=None, cycles=1.0, slide={'friction': 0.3, 'steps': [5]})": "steps of slide "
    r"must be a list of mappings, got \[5\]",
    "worn(sliding=None, cycles=1.0, slide={'friction': 0.3, 5: 1})": "slide and roll must not "
    "have 5",
    "worn(sliding=1.0, steps=[[1.0]])": r"steps must be .*, got an array of shape \(1, 1\)",
    "worn(steps=[])": r"steps must be .*, got an array of shape \(0,\)",
    "worn(steps=2 ** 63)": "steps must be at least 1 and at most 1000000, got 9223372036854775808",
    "worn(until=np.ones((2, 2)))": "until must be None or",
    "worn(grid=np.ones((3, 3)))": "grid must be a nacre.Grid, got",
    "worn(initial='x')": "initial must be a real array, got",
    "worn(step_tolerance='a')": "step_tolerance must be a real number, got 'a'",
    "worn(step_tolerance=0.01)": "step_tolerance must not be given beside steps",
    "barrels(free_ends=1)": "free_ends must be True or False, got 1",
}

# Outside of the model.

BEARING = bearing.CylindricalRoller(**ROLLERS)  # type: ignore[arg-type]
BALLS = bearing.DeepGrooveBall(**BALL_SIZES)  # type: ignore[arg-type]
RADIAL = {"force": (1000.0, 0.0, None), "model": "iso16281"}
WORDS = np.array(["solved", "iso16281"])

OUTSIDE = {
    # functions
    "BEARING.solve(**RADIAL, progress=1)": "progress must be",
    "fatigue.assess(PRESSED, progress=1)": "progress must be callable",
    "sweep({'load': [1.0]}, progress=1)": "progress must be True, False or None",
    "fatigue.shakedown_map(PRESSED, friction=[0.0], progress='x')": "progress must be callable, "
    "got 'x'",
    "bearing.life_ratio(PRESSED, PRESSED, bearing.LundbergPalmgren(), progress=1)": "progress must "
    "be callable, got 1",
    # words
    "BEARING.solve(**RADIAL | {'model': WORDS})": 'model must be "solved"',
    "BEARING.solve(**RADIAL).life(edge=WORDS)": 'edge must be "standard"',
    "BEARING.solve(**RADIAL).life(rotating=['inner'])": 'rotating must be "inner"',
    "fatigue.assess(PRESSED, rule=WORDS)": "rule must be 'von_mises'",
    "fatigue.shakedown(np.zeros((2, 6)), rule=WORDS)": 'rule must be "von_mises"',
    "indented(branch=WORDS)": "branch must be 'stable'",
    "indented(control=WORDS)": "control must be 'load'",
    "replace(BEARING, profile=WORDS)": "profile must be a profile",
    # truth values for numbers
    "slides(friction=True, force=(0.5, 0.0))": "friction must be a number.* got True",
    "history({'friction': np.True_, 'force': (0.5, None)})": "friction must be a number",
    "fatigue.assess(PRESSED, friction=True)": "friction must be a real number",
    "fatigue.shakedown_map(PRESSED, friction=[True, False])": "friction must be a real array",
    # limits in MPa beside moduli in Pa
    "bearing.IoannidesHarris(fatigue_limit=350.0)": "fatigue_limit must be 0, or at least 100000 "
    r"Pa, got 350\.0",
    "ON_STEEL.stress_summary(yield_stress={'substrate': 900.0})": "yield_stress must be in the "
    r"units of the moduli, .* 2\.1e\+11; got 900",
    "ON_STEEL.stress_plan().summary(strength=[1200.0])": "strength must be in the units of the "
    "moduli",
    "fatigue.assess(ON_STEEL, shear_yield=600.0)": "shear_yield must be in the units of the moduli",
    "fatigue.assess(ON_STEEL, criteria=[fatigue.DangVan(520.0, 330.0)])": "bending must be in the "
    "units of the moduli",
    # sizes beyond any bearing
    "BEARING.solve(force=(1e300, 0.0, None))": "force must be at most",
    "BEARING.solve(displacement=(1e300, 0.0, None))": r"displacement must be at most 0\.01",
    "BEARING.solve(moment=(1e300, None))": "moment must be at most",
    "BEARING.solve(tilt=(1e300, None))": "tilt must be at most 1",
    "BEARING.solve(**RADIAL, speed=1e300)": "speed must be lower: elements .* at most",
    "BEARING.solve(**RADIAL, rotation=1e300)": "rotation must be at most",
    "replace(BEARING, capacity=48.4)": r"capacity must be in N, some 4\.84e\+04",
    "replace(BEARING, rating_factor=1e300)": "rating_factor must be from",
    "replace(BEARING, raceway_crown=(1e-300, None))": "raceway_crown must be at least the length",
    "replace(BALLS, osculation=(1e300, 0.53))": "osculation must be at most 100",
    "bearing.film_thickness(BY_RIGID, speed=1e300, viscosity=0.02, pressure_viscosity=20e-9)": "spe"
    "ed times viscosity must be between",
    "fatigue.assess(PRESSED, friction=1e300)": "friction must be a number, finite",
}

NAMES = globals() | {
    "plot": nacre.plot,
    "fatigue": nacre.fatigue,
    "friction": nacre.friction,
    "rollers": made(bearing.CylindricalRoller, ROLLERS | {"clearance": 41e-6}),
    "balls": made(bearing.DeepGrooveBall, BALL_SIZES),
    "barrels": made(bearing.SphericalRoller, BARRELS),
    "tapered": made(bearing.TaperedRoller, CONES),
    "replace": dataclasses.replace,
    "sweep": partial(nacre.sweep, {"shape": BALL, "body": STEEL, "grid": GRID, "load": 1.0}),
    "indented": partial(nacre.indent.solve, STEEL, nacre.indent.Tip.sphere(1e-6), load=1e-3),
    "press": partial(CONTACT.solve, BALL),
    "coefficients": nacre.creep_coefficients,
    "curve": partial(
        nacre.friction.creep_curve, BALL, STEEL, STEEL, grid=CELLS, direction="+x", **HELD
    ),
}


@table(
    *errors(ValueError, VALUES | FRICTION_VALUES | FIELD_VALUES | BEARINGS | WEAR),
    *(row for shape in SHAPES.values() for row in errors(ValueError, shape.refused)),
    *errors(TypeError, TYPES | FRICTION_TYPES | FIELD_TYPES),
    *errors((TypeError, ValueError), OUTSIDE | WEAR_KINDS),
    ("slides(force=(1.0, None), max_convolutions=1)", nacre.ConvergenceError, "max_convolutions"),
)
def test_bad_input_is_refused(call: str, kind: type[Exception], words: str) -> None:
    # The match searches notes, too: where pyo3 finds the type wrong, they name the argument.
    support.refused(call, kind, words, NAMES)


CALLS: dict[str, tuple[Callable[..., object], dict[str, Any]]] = {
    "solve": (partial(nacre.solve, BALL, STEEL), {"load": 10.0}),
    "Contact.solve": (partial(CONTACT.solve, BALL), {"load": 10.0}),
    "slide": (partial(nacre.slide, BALL, STEEL), HELD),
    "roll": (partial(nacre.roll, BALL, STEEL), {"grid": CELLS, "direction": "+x", **HELD}),
    "wear": (
        partial(nacre.wear, BALL, STEEL),
        {"grid": CELLS, "load": 10.0, "rate": 1e-16, "sliding": 1.0},
    ),
}
KEYWORDS = [
    (call, name)
    for call, (function, _) in CALLS.items()
    for name, parameter in inspect.signature(function).parameters.items()
    if parameter.kind is parameter.KEYWORD_ONLY
]


@pytest.mark.parametrize(("call", "name"), KEYWORDS)
def test_each_keyword_refuses_what_is_none_of_its_values(call: str, name: str) -> None:
    function, keywords = CALLS[call]
    with pytest.raises((TypeError, ValueError), match=rf"\b{name}\b"):
        function(**keywords | {name: object()})


@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # few cells are enough here
@pytest.mark.parametrize("like", [list, np.array])
def test_a_list_or_an_array_is_as_good_as_a_tuple(like: Any) -> None:
    pair = (4e-4, 4e-4)
    assert nacre.Grid(like((16, 20)), like(pair)) == GRID
    assert nacre.HeightMap(HEIGHTS, like(pair)).spacing == pair
    assert nacre.HeightMap(HEIGHTS, pair, center=like(pair)).center == pair
    moved = CONTACT.solve(BALL, load=100.0, eccentricity=like((1e-5, 0.0)))
    assert CONTACT.solve(BALL, load=100.0, tilt=like((1e-4, 2e-4))).tilt == (1e-4, 2e-4)
    assert moved.report.motion["eccentricity"] == (1e-5, 0.0)
    field = moved.stress(1e-5, friction=0.1, direction=like((0.0, 1.0)))
    assert field.friction == (0.0, 0.1)
    assert slides(force=like((1.0, 0.0))).force == pytest.approx((1.0, 0.0), abs=1e-7)
    nacre.creep_coefficients(STEEL, STEEL, like((1.0, 1.0)), cells=8)


@pytest.mark.parametrize("many", [tuple, iter, lambda rows: np.array(rows, dtype=object)])
def test_any_sequence_is_as_good_as_a_list(many: Any) -> None:
    layers = [nacre.Layer(STEEL, 1e-6), nacre.Layer(STEEL, 2e-6)]
    assert nacre.HalfSpace(STEEL, many(layers)) == nacre.HalfSpace(STEEL, layers)
    found = BOTH.slide(BALL, many([ONE, {"force": [2.0, None]}]), **HELD)
    assert [s.force[0] for s in found] == pytest.approx([1.0, 2.0])


def test_missing_samples_are_refused() -> None:
    missing = np.ma.masked_array(HEIGHTS, mask=np.isnan(NAN_AT_1_2))
    with pytest.raises((TypeError, ValueError), match=r"heights.*mask"):
        nacre.HeightMap(missing, spacing=1.0)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"force": (NAN, None)}, "force must be finite"),
        ({"force": (3.1, None)}, "force must be below what friction can carry"),
        ({"friction": np.ones((3, 3))}, "friction: expected shape"),
    ],
)
def test_an_error_in_a_step_keeps_the_steps_before_it(wrong: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words) as caught:
        history(ONE, wrong, ONE)
    (kept,) = getattr(caught.value, "solutions")  # noqa: B009
    assert kept == LAST or kept.traction.tobytes() == LAST.traction.tobytes()


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
    run = support.python("-c", script)
    assert run.returncode == 0, run.stderr[:500]
    assert re.search(r"\d+.* cells needs about \d+ MiB, and \d+ MiB are available", run.stdout)


@pytest.mark.parametrize("name", ["Shape", "Solution", "Report", "FrictionSolution"])
def test_results_cannot_be_made_by_hand(name: str) -> None:
    with pytest.raises(TypeError, match=name):
        getattr(nacre, name)()


def test_bad_input_is_not_a_convergence_error() -> None:
    assert not issubclass(nacre.ConvergenceError, ValueError)
    assert issubclass(nacre.ConvergenceError, RuntimeError)
    assert issubclass(nacre.NacreWarning, UserWarning)
