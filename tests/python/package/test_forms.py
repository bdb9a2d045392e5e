"""Every array argument may come in any form, with the same numbers at the end."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pandas  # type: ignore[import-untyped]
import pytest
import xarray

import nacre
from bodies import BALL, COATED, STEEL, quiet
from nacre import bearing, design, fatigue, hertz, indent, rough
from nacre.indent import charts
from support import assert_close

Array = npt.NDArray[Any]

GRID = nacre.Grid((16, 20), (3e-4, 3.3e-4))
CONTACT = nacre.Contact(STEEL, GRID)
TIP = indent.Tip.sphere(1e-5)
ROLLERS = {"count": 14, "diameter": 10e-3, "length": 9.6e-3, "pitch_diameter": 65e-3}
ROLLER = bearing.CylindricalRoller(**ROLLERS)  # type: ignore[arg-type]
BALLS = bearing.DeepGrooveBall(count=9, diameter=8e-3, pitch_diameter=39e-3)
ROWS, COLUMNS = np.indices(GRID.shape)
CREEP = {"load": 10.0, "friction": 0.25, "tolerance": 1e-3}


@cache
def pressed_ball() -> nacre.Solution:
    return quiet(CONTACT.solve, BALL, load=10.0)  # type: ignore[no-any-return]


@cache
def indented() -> indent.IndentSolution:
    return indent.Indentation(STEEL, TIP).at(load=1e-3)


def single(values: Any) -> Array:
    """Return numbers that single precision holds, so that each dtype has the same."""
    return np.asarray(values, dtype=np.float32).astype(np.float64)


# No symmetry that would hide another order.
MAP = single(((3 * ROWS + 5 * COLUMNS) % 101 + 1) / 128)
HISTORY = single([[1, 2, 3, 4, 5, 6], [2, 2, 1, 0, 1, 3], [0, 1, 4, 2, 2, 1]]) * 2.0**24


def asserted(solution: Any) -> Array:
    return np.concatenate([solution.pressure.ravel(), [solution.load, solution.approach]])


class Argument(NamedTuple):
    """An array argument of a public function."""

    array: Any
    call: Callable[[Any], Any]
    """Numbers that follow from it."""


def pressed(**given: Any) -> Array:
    return asserted(quiet(nacre.solve, BALL, STEEL, grid=GRID, **({"load": 10.0} | given)))


def solved(contact: nacre.Contact, **given: Any) -> Array:
    return asserted(quiet(contact.solve, BALL, load=10.0, **given))


def slid(**given: Any) -> Array:
    found = quiet(
        nacre.slide, BALL, STEEL, grid=GRID, **({"load": 10.0, "tolerance": 1e-4} | given)
    )
    return np.asarray(found.traction)


def rolled(**given: Any) -> Array:
    found = quiet(nacre.roll, BALL, STEEL, grid=GRID, direction="+x", **(CREEP | given))
    return np.asarray(found.traction)


def stressed(**given: Any) -> Array:
    options = {"z": [1e-5, 3e-5], "x": 0.0} | given
    return np.asarray(quiet(pressed_ball().stress, **options).von_mises)


def summed(**given: Any) -> Array:
    layered = quiet(nacre.solve, BALL, COATED, load=10.0, grid=GRID)
    return np.array([row.von_mises[0] for row in quiet(layered.stress_summary, **given).layers])


def assessed(**given: Any) -> Array:
    options = {"depths": [2e-5, 4e-5], "x": 0.0} | given
    return np.asarray(quiet(fatigue.assess, pressed_ball(), **options).profiles["first_yield"])


def mapped(**given: Any) -> Array:
    options = {"friction": [0.0, 0.25], "depths": [2e-5, 4e-5], "x": 0.0} | given
    found = quiet(fatigue.shakedown_map, pressed_ball(), **options)
    return np.concatenate([found.friction, found.limits.ravel()])


def turned(made: Any, **given: Any) -> Array:
    options = {"force": (64.0, 0.0, None), "model": "iso16281"} | given
    return np.asarray(quiet(made.solve, **options).loads)


def studied(study: Any) -> Array:
    return np.asarray(study.peak_pressure)


def made(grid: nacre.Grid) -> Array:
    return np.array([*grid.shape, *grid.size, *grid.center, *grid.periodic], dtype=np.float64)


def surface(heights: Any = MAP, spacing: Any = 1.0, **given: Any) -> Array:
    found = nacre.HeightMap(heights, spacing, **given)
    return np.array([*found.heights.ravel(), *found.spacing, *found.center, *found.periodic])


def curve(**given: Any) -> Array:
    columns = {name: np.arange(16.0) for name in ("depth", "force", "time")} | given
    found = indent.Curve(columns.pop("depth"), columns.pop("force"), **columns)
    assert found.time is not None
    return np.concatenate([found.depth, found.force, found.time])


def random(**given: Any) -> Array:
    options = {"shape": (16, 16), "size": (1.0, 1.0)} | given
    numbers = {"hurst": 0.8, "shortest": 0.2, "longest": 1.0, "rms_height": 1.0, "rng": 1}
    return rough.random_surface(**options, **numbers).heights  # type: ignore[arg-type]


def rough_curve(pressures: Any) -> Array:
    shape = rough.random_surface(
        (16, 16), (1e-4, 1e-4), hurst=0.8, shortest=2e-5, longest=1e-4, rms_height=1e-8, rng=1
    )
    return np.asarray(quiet(rough.load_curve, shape, STEEL, pressures)["load"])


def crept(creepages: Any) -> Array:
    keywords = CREEP | {"grid": GRID, "direction": "+x"}
    found = quiet(nacre.friction.creep_curve, BALL, STEEL, creepages=creepages, **keywords)
    return np.concatenate([found.creepage, found.traction_ratio])


def gradient(output: Any) -> Array:
    return quiet(pressed_ball().gradient, output).gap  # type: ignore[no-any-return]


MAPS: dict[str, Argument] = {
    "HeightMap": Argument(MAP, surface),
    "Contact(coefficients)": Argument(
        single(nacre.influence_coefficients(STEEL, GRID)),
        lambda a: solved(nacre.Contact(STEEL, GRID, coefficients=a)),
    ),
    "Convolution": Argument(MAP, lambda a: nacre.Convolution(a).apply(MAP)),
    "Convolution.apply": Argument(
        MAP, nacre.Convolution(nacre.influence_coefficients(STEEL, GRID)).apply
    ),
    "solve(hardness)": Argument(MAP * 2.0**31, lambda a: pressed(hardness=a)),
    "solve(compliance)": Argument(MAP * 2.0**-53, lambda a: pressed(compliance=a)),
    "Contact.solve(compliance)": Argument(MAP * 2.0**-53, lambda a: solved(CONTACT, compliance=a)),
    "solve(initial)": Argument(MAP, lambda a: pressed(initial=a)),
    "Contact.solve(hardness)": Argument(MAP * 2.0**31, lambda a: solved(CONTACT, hardness=a)),
    "Contact.solve(initial)": Argument(MAP, lambda a: solved(CONTACT, initial=a)),
    "Contact.solve_many(hardness)": Argument(
        MAP * 2.0**31,
        lambda a: asserted(
            quiet(CONTACT.solve_many, [{"shape": BALL, "load": 10.0}], hardness=a)[0]
        ),
    ),
    "slide(friction)": Argument(MAP, lambda a: slid(friction=a, force=(0.5, 0.0))),
    "Contact.slide(friction)": Argument(
        MAP,
        lambda a: (
            quiet(
                CONTACT.slide, BALL, load=10.0, friction=a, force=(0.5, 0.0), tolerance=1e-4
            ).traction
        ),
    ),
    "roll(friction)": Argument(MAP, lambda a: rolled(friction=a, creepage=(2.0**-9, 0.0))),
    "stress(pressure)": Argument(
        MAP, lambda a: quiet(nacre.stress, STEEL, GRID, a, [1e-5]).von_mises
    ),
    "Solution.jvp(gap)": Argument(MAP * 2.0**-20, lambda a: pressed_ball().jvp(gap=a).pressure),
    "Solution.vjp": Argument(MAP, lambda a: pressed_ball().vjp(a).gap),
    "shakedown": Argument(HISTORY, lambda a: fatigue.shakedown(a).shear_yield),
    "DangVan.stress": Argument(HISTORY, fatigue.DangVan(5e8, 3e8).stress),
    "Roller(profile)": Argument(
        single([[-0.5, 0.0, 0.25], [0.25, 0.0, 0.5]]),
        lambda a: nacre.Roller(1.0, length=0.75, profile=a).profile.drop_at([-0.25, 0.125]),  # type: ignore[union-attr]
    ),
    "frequency_response": Argument(MAP, lambda a: nacre.frequency_response(STEEL, a)),
    "surface_compliance": Argument(
        MAP, lambda a: np.concatenate([np.ravel(c) for c in nacre.surface_compliance(STEEL, a)])
    ),
    "LogarithmicProfile.drop_at": Argument(MAP, nacre.LogarithmicProfile(1e-6, 4.0).drop_at),
    "SampledProfile.drop_at": Argument(
        MAP, nacre.SampledProfile([0.0, 0.5, 1.0], [0.0, 1.0, 3.0]).drop_at
    ),
    "Tip.gap": Argument(MAP * 2.0**-20, TIP.gap),
    "Point.pressure": Argument(MAP, hertz.Point(1.0, 1.0, 1.0).pressure),
    "Line.pressure": Argument(MAP, hertz.Line(1.0, 1.0, 1.0).pressure),
    "Ellipse.pressure(x)": Argument(
        MAP, lambda a: hertz.Ellipse(1.0, 2.0, 1.0, 1.0).pressure(a, MAP)
    ),
    "Ellipse.pressure(y)": Argument(
        MAP, lambda a: hertz.Ellipse(1.0, 2.0, 1.0, 1.0).pressure(MAP, a)
    ),
    "IndentSolution.pressure": Argument(MAP * 2.0**-20, lambda a: indented().pressure(a)),
    "IndentSolution.displacement": Argument(MAP * 2.0**-20, lambda a: indented().displacement(a)),
    "IndentSolution.gap": Argument(MAP * 2.0**-20, lambda a: indented().gap(a)),
    "IndentSolution.stress": Argument(
        MAP[:3, :4] * 2.0**-20, lambda a: indented().stress(a, 1e-6)["zz"]
    ),
    "Indentation.at(load)": Argument(
        MAP[:3, :4], lambda a: indent.Indentation(STEEL, TIP).at(load=a).approach
    ),
}
"""Arguments of two dimensions."""

LISTS: dict[str, Argument] = {
    "SampledProfile(x)": Argument(
        single([-0.5, 0.0, 0.25]),
        lambda a: nacre.SampledProfile(a, [1, 0, 2]).drop_at([-0.25, 0.2]),
    ),
    "SampledProfile(drop)": Argument(
        single([1.0, 0.0, 2.0]), lambda a: nacre.SampledProfile([-1, 0, 1], a).drop_at([-0.25, 0.5])
    ),
    "SampledProfile(corners)": Argument(
        single([-0.5, 0.5]),
        lambda a: nacre.SampledProfile(
            np.linspace(-1, 1, 33), np.linspace(-1, 1, 33) ** 2, corners=a
        ).drop_at([-0.4, 0.3]),
    ),
    "Response": Argument(
        single(1e-9 * (1 + 1 / (1 + nacre.Response(lambda alpha: 1e-9 + 0 * alpha).wavenumbers))),
        lambda a: nacre.Response(lambda _: a).values,
    ),
    "graded_layers(breakpoints)": Argument(
        single([0.25, 0.5]),
        lambda a: [
            layer.thickness
            for layer in nacre.graded_layers(
                STEEL, 1.0, lambda z: 1e11 if z < 0.25 else 2e11 if z < 0.5 else 3e11, 0.3, 0.1, a
            )
        ],
    ),
    "Tip.profile(radii)": Argument(
        single([0.0, 0.5, 1.5]), lambda a: indent.Tip.profile(a, [0, 0.25, 1]).gap([0.25, 1.0])
    ),
    "Tip.profile(heights)": Argument(
        single([0.0, 0.25, 1.5]), lambda a: indent.Tip.profile([0, 0.5, 1], a).gap([0.25, 1.0])
    ),
    "Tip.area_function": Argument(
        single([24.5, 0.125]), lambda a: indent.Tip.area_function(a, 1.0).gap([0.25, 1.0])
    ),
    "Curve(depth)": Argument(single(np.arange(16) ** 2), lambda a: curve(depth=a)),
    "Curve(force)": Argument(single(np.arange(16) ** 2), lambda a: curve(force=a)),
    "Curve(time)": Argument(single(np.arange(16) ** 2), lambda a: curve(time=a)),
    "fit(data)": Argument(
        single(np.linspace(2e-8, 3e-7, 24)),
        lambda a: quiet(
            indent.fit,
            (a, indent.Indentation(STEEL, TIP).curve(approach=np.linspace(2e-8, 3e-7, 24)).load),
            STEEL,
            TIP,
            ["body.substrate.young"],
            profile=False,
        ).estimates["body.substrate.young"],
    ),
    "Indentation.curve": Argument(
        single([1e-8, 3e-8]), lambda a: indent.Indentation(STEEL, TIP).curve(approach=a).load
    ),
    "bulk_limit": Argument(single([0.5, 4.0]), lambda a: charts.bulk_limit(a)["hertz"]),
    "pull_off_over_thickness": Argument(
        single([0.5, 4.0]), lambda a: charts.pull_off_over_thickness(2.0, a)
    ),
    "information": Argument(
        single([0.5, 1.0]), lambda a: list(charts.information(2.0, a, points=12).values())
    ),
    "stress(z)": Argument(
        single([1e-5, 4e-5]), lambda a: quiet(nacre.stress, STEEL, GRID, MAP, a).von_mises
    ),
    "Solution.stress(z)": Argument(single([1e-5, 4e-5]), lambda a: stressed(z=a)),
    "Solution.stress(direction)": Argument(
        single([0.5, 1.0]), lambda a: stressed(friction=0.25, direction=a)
    ),
    "Solution.stress(residual)": Argument(single([2e8]), lambda a: stressed(residual=a)),
    "stress_summary(residual)": Argument(single([2e8, -1e8]), lambda a: summed(residual=a)),
    "stress_summary(yield_stress)": Argument(single([2e9, 1e9]), lambda a: summed(yield_stress=a)),
    "assess(depths)": Argument(single([1e-5, 4e-5]), lambda a: assessed(depths=a)),
    "assess(shear_yield)": Argument(single([6e8]), lambda a: assessed(shear_yield=a)),
    "assess(direction)": Argument(
        single([0.5, 1.0]), lambda a: assessed(friction=0.25, direction=a)
    ),
    "shakedown_map(friction)": Argument(single([0.0, 0.5]), lambda a: mapped(friction=a)),
    "shakedown_map(depths)": Argument(single([1e-5, 4e-5]), lambda a: mapped(depths=a)),
    "creep_curve": Argument(single([2.0**-12, 2.0**-8]), crept),
    "rough.load_curve": Argument(single([1e6, 4e6]), rough_curve),
    "design.load_curve": Argument(
        single([5.0, 10.0]),
        lambda a: studied(quiet(design.load_curve, BALL, STEEL, a, grid=GRID)),
    ),
    "tilt_curve": Argument(
        single([0.0, 1e-4]),
        lambda a: studied(quiet(design.tilt_curve, BALL, STEEL, a, load=10.0, grid=GRID)),
    ),
    "force_table(approach)": Argument(
        single([1e-6, 2e-6]), lambda a: quiet(design.force_table, BALL, STEEL, a, grid=GRID)["load"]
    ),
    "force_table(tilt_x)": Argument(
        single([0.0, 1e-4]),
        lambda a: quiet(design.force_table, BALL, STEEL, [1e-6], tilt_x=a, grid=GRID)["load"],
    ),
    "sweep": Argument(
        single([5.0, 10.0]),
        lambda a: studied(
            quiet(nacre.sweep, {"shape": BALL, "body": STEEL, "grid": GRID}, {"load": a})
        ),
    ),
    "CylindricalRoller.curvature": Argument(
        single([0.0, 1e-3]), lambda a: ROLLER.curvature("inner", a)
    ),
}
"""Arguments of one dimension."""

PAIRS: dict[str, Argument] = {
    "solve(eccentricity)": Argument(single([1e-5, 2e-5]), lambda a: pressed(eccentricity=a)),
    "solve(moment)": Argument(single([1e-5, 2e-5]), lambda a: pressed(moment=a)),
    "solve(tilt)": Argument(single([1e-4, 2e-4]), lambda a: pressed(tilt=a)),
    "slide(shift)": Argument(single([1e-7, 2e-7]), lambda a: slid(friction=0.25, shift=a)),
    "slide(force)": Argument(single([0.5, 1.0]), lambda a: slid(friction=0.25, force=a)),
    "roll(creepage)": Argument(single([1e-4, 2e-4]), lambda a: rolled(creepage=a)),
    "roll(force)": Argument(single([0.5, 0.25]), lambda a: rolled(force=a)),
    "Grid(shape)": Argument(np.array([16, 20]), lambda a: made(nacre.Grid(a, (1.0, 2.0)))),
    "Grid(size)": Argument(single([0.5, 0.75]), lambda a: made(nacre.Grid((4, 6), a))),
    "Grid(center)": Argument(
        single([0.5, 0.75]), lambda a: made(nacre.Grid((4, 6), (1.0, 2.0), center=a))
    ),
    "Grid(periodic)": Argument(
        np.array([True, False]), lambda a: made(nacre.Grid((4, 6), (1.0, 2.0), periodic=a))
    ),
    "HeightMap(spacing)": Argument(single([0.5, 0.75]), lambda a: surface(spacing=a)),
    "HeightMap(center)": Argument(single([0.5, 0.75]), lambda a: surface(center=a)),
    "HeightMap(periodic)": Argument(np.array([True, False]), lambda a: surface(periodic=a)),
    "HalfSpace(ends)": Argument(
        single([-0.5, 0.75]), lambda a: np.array(nacre.HalfSpace(STEEL, ends=a).ends)
    ),
    "relative_radii(radii)": Argument(
        single([0.5, 0.75]), lambda a: np.hstack(hertz.relative_radii(a, (1.0, 2.0), 0.5))
    ),
    "relative_radii(counter_radii)": Argument(
        single([0.5, 0.75]), lambda a: np.hstack(hertz.relative_radii((1.0, 2.0), a, 0.5))
    ),
    "creep_coefficients": Argument(
        single([0.5, 0.75]), lambda a: nacre.creep_coefficients(STEEL, None, a, cells=16).c11
    ),
    "random_surface(shape)": Argument(np.array([16, 20]), lambda a: random(shape=a)),
    "random_surface(size)": Argument(single([1.0, 1.5]), lambda a: random(size=a)),
    "Solution.gradient(place)": Argument(single([1e-5, 2e-5]), lambda a: gradient(("pressure", a))),
    "solve of a bearing (force)": Argument(
        single([64.0, 8.0, 16.0]), lambda a: turned(BALLS, force=a)
    ),
    "solve of a bearing (displacement)": Argument(
        single([1e-5, 2e-5, 1e-5]),
        lambda a: turned(BALLS, force=(None, None, None), displacement=a),
    ),
    "solve of a bearing (moment)": Argument(
        single([0.125, 0.25]), lambda a: turned(ROLLER, moment=a, tilt=(None, None))
    ),
    "solve of a bearing (tilt)": Argument(single([1e-4, 2e-4]), lambda a: turned(ROLLER, tilt=a)),
    "solve of a bearing (cells)": Argument(
        np.array([16, 8]), lambda a: turned(BALLS, model="solved", cells=a, tolerance=1e-2)
    ),
    "osculation": Argument(
        single([0.52, 0.54]),
        lambda a: np.array(
            bearing.DeepGrooveBall(
                count=9, diameter=8e-3, pitch_diameter=39e-3, osculation=a
            ).osculation
        ),
    ),
    "raceway_crown": Argument(
        single([1.0, 2.0]),
        lambda a: bearing.CylindricalRoller(**ROLLERS, raceway_crown=a).drop("outer"),  # type: ignore[arg-type]
    ),
    "raceway_diameters": Argument(
        single([0.055, 0.07502]),
        lambda a: np.array(
            bearing.CylindricalRoller(
                count=14, diameter=10e-3, length=9.6e-3, raceway_diameters=a
            ).raceways
        ),
    ),
}
"""Arguments of so many numbers."""


class Half:
    """Numbers in a unit of a half, as of pint: NumPy takes the magnitude, and loses the unit."""

    dimensionless = True

    def __init__(self, magnitude: Any) -> None:
        self.magnitude = magnitude

    def __array__(self, dtype: Any = None, copy: Any = None) -> Array:
        return np.asarray(self.magnitude, dtype=dtype)

    def __len__(self) -> int:
        return len(self.magnitude)

    def __getitem__(self, key: Any) -> Half:
        return Half(self.magnitude[key])

    def __float__(self) -> float:
        return float(self.magnitude) / 2

    def to_base_units(self) -> Half:
        return Half(np.asarray(self.magnitude) / 2)


def read_only(array: Array) -> Array:
    array = array.copy()
    array.setflags(write=False)
    return array


def strided(array: Array) -> Array:
    """Return a view of every second number along each axis."""
    spread = np.zeros([2 * n for n in array.shape], dtype=array.dtype)
    view = spread[tuple(slice(1, None, 2) for _ in array.shape)]
    view[...] = array
    return view


def reversed_twice(array: Array) -> Array:
    turn = tuple(slice(None, None, -1) for _ in array.shape)
    return np.ascontiguousarray(array[turn])[turn]


ANY: dict[str, Callable[[Array], Any]] = {
    "read-only": read_only,
    "strided": strided,
    "reversed": reversed_twice,
    "list": np.ndarray.tolist,
    "big-endian": lambda a: a.astype(a.dtype.newbyteorder(">")),
    "single precision": lambda a: a.astype({"f": "f4", "b": "?"}.get(a.dtype.kind, "i2")),
}


def of_file(array: Array) -> Array:
    """Return numbers as files may have them: big-endian, single precision, steps backwards."""
    narrow = ANY["single precision"](array)
    return strided(reversed_twice(narrow.astype(narrow.dtype.newbyteorder(">"))))


FORMS_OF_MAPS: dict[str, Callable[[Array], Any]] = ANY | {
    "Fortran order": np.asfortranarray,
    "transposed view": lambda a: np.ascontiguousarray(a.T).T,
    "DataFrame": pandas.DataFrame,
    "DataArray": lambda a: xarray.DataArray(a, dims=("x", "y")),
    "DataArray (y, x)": lambda a: xarray.DataArray(a.T, dims=("y", "x")),
    "DataArray (y, x) of a file": lambda a: xarray.DataArray(of_file(a).T, dims=("y", "x")),
    "unit of a ratio": lambda a: Half(2 * a),
}
FORMS_OF_LISTS: dict[str, Callable[[Array], Any]] = ANY | {
    "tuple": lambda a: tuple(a.tolist()),
    "Series": pandas.Series,
    "Series of a file": lambda a: pandas.Series(of_file(a)),
    "Series of rows": lambda a: pandas.Series(a, index=range(7, 7 + len(a))),
    "Series by name": lambda a: pandas.Series(a, index=[f"row {k}" for k in range(len(a))]),
    "Series backwards": lambda a: pandas.Series(a, index=range(len(a))[::-1]),
    "DataArray": lambda a: xarray.DataArray(a, dims="x"),
    "column": lambda a: pandas.DataFrame({"a": a})["a"],
    "column of an array": lambda a: np.column_stack([a, a])[:, 1],
    "unit of a ratio": lambda a: Half(2 * a) if a.dtype.kind == "f" else a,
}
STUDIES = (
    "sweep",
    "design.load_curve",
    "tilt_curve",
    "force_table(approach)",
    "force_table(tilt_x)",
)
"""Arguments whose items may be anything, and have no unit together."""
IN_ALL_FORMS = (
    *("HeightMap", "assess(shear_yield)", "CylindricalRoller.curvature"),
    *("Grid(center)", "HeightMap(periodic)"),
)
"""A map, numbers of layers, a list, and pairs of numbers and of bools.

All arguments have one reader, which these try. That the others have it too shows in what it alone
understands: names of axes, and units.
"""
BY_LAYER = ("residual", "shear_yield", "yield_stress")
"""Arguments whose index names layers."""


@cache
def expected(name: str) -> Array:
    table = MAPS | LISTS | PAIRS
    return np.asarray(table[name].call(np.array(table[name].array, order="C")), dtype=np.float64)


def tried(arguments: dict[str, Argument], forms: dict[str, Any]) -> pytest.MarkDecorator:
    """Parametrise a test by some arguments in all forms, and by all in those that tell readers."""
    pairs = [
        (name, form)
        for name in arguments
        for form in forms
        if name in IN_ALL_FORMS or form.endswith((" of a file", " of a ratio"))
    ]
    return pytest.mark.parametrize(("name", "form"), pairs)


@tried(MAPS, FORMS_OF_MAPS)
def test_maps_of_any_form_are_the_same(name: str, form: str) -> None:
    formed = FORMS_OF_MAPS[form](MAPS[name].array)
    np.testing.assert_array_equal(MAPS[name].call(formed), expected(name))


@tried(LISTS | PAIRS, FORMS_OF_LISTS)
def test_lists_of_any_form_are_the_same(name: str, form: str) -> None:
    argument = (LISTS | PAIRS)[name]
    formed = FORMS_OF_LISTS[form](argument.array)
    if form in ("Series of rows", "Series by name") and any(word in name for word in BY_LAYER):
        with pytest.raises(ValueError, match="numbers of layers"):
            argument.call(formed)
    elif form == "Series backwards" and any(word in name for word in BY_LAYER):
        assert np.array_equal(argument.call(formed), argument.call(argument.array[::-1]))
    elif form == "unit of a ratio" and name in STUDIES:
        with pytest.raises(TypeError, match="must be a sequence of values"):
            argument.call(formed)
    else:
        np.testing.assert_array_equal(argument.call(formed), expected(name))


@pytest.mark.parametrize("name", LISTS | PAIRS)
def test_a_table_is_no_list_of_its_headings(name: str) -> None:
    """Iteration over a DataFrame gives its headings, which may be numbers."""
    argument = (LISTS | PAIRS)[name]
    table = pandas.DataFrame([argument.array], columns=range(1, 1 + len(argument.array)))
    try:
        found = np.asarray(argument.call(table), dtype=np.float64)
    except (TypeError, ValueError):
        return
    if name in STUDIES:  # a row is a case, which fails and says so
        assert np.isnan(found).all()
    else:
        np.testing.assert_array_equal(found.ravel(), expected(name).ravel())


WRONG: dict[str, tuple[str, str, Callable[[Array], Any]]] = {
    "hardness": ("hardness", "above 0", lambda a: pressed(hardness=a)),
    "hardness of a plan": (
        "hardness",
        "above 0",
        lambda a: solved(CONTACT, hardness=a),
    ),
    "compliance": ("compliance", "at least 0|negative", lambda a: pressed(compliance=a)),
    "initial": ("initial", "at least 0|negative|below 0", lambda a: pressed(initial=a)),
    "friction": ("friction", "at least 0", lambda a: slid(friction=a)),
    "coefficients": (
        "coefficients",
        "",
        lambda a: nacre.Contact(STEEL, GRID, coefficients=a),
    ),
}


@pytest.mark.parametrize("wrong", [-1.0, np.nan])
@pytest.mark.parametrize(
    ("name", "form"),
    [
        *(("hardness", form) for form in FORMS_OF_MAPS),
        *((name, "DataArray (y, x) of a file") for name in WRONG if name != "hardness"),
    ],
)
def test_signs_and_nan_are_refused_in_any_form(name: str, form: str, wrong: float) -> None:
    word, requirement, call = WRONG[name]
    array = MAP * 2.0**31
    array[11, 3] = wrong
    with pytest.raises(ValueError, match=rf"{word} (is not finite|must be|.*{requirement})"):
        call(FORMS_OF_MAPS[form](array))


def test_units_of_text_are_converted_or_refused() -> None:
    def friction(units: str, values: Any) -> Array:
        return mapped(friction=xarray.DataArray(values, dims="x", attrs={"units": units}))

    right = mapped(friction=[0.0, 0.25])
    for units, values in (("%", [0.0, 25.0]), ("percent", [0, 25]), ("‰", [0.0, 250.0])):
        assert_close(friction(units, values), right, rtol=1e-14)
    np.testing.assert_array_equal(friction("1", [0.0, 0.25]), right)
    with pytest.raises(TypeError, match=r"(?s)friction must be .* with a unit"):
        friction("mm", [0.0, 0.25])
    tilt = xarray.DataArray([0.1, 0.2], dims="x", attrs={"units": "mrad"})
    assert_close(pressed(tilt=tilt), pressed(tilt=(1e-4, 2e-4)), rtol=1e-6)
    degrees = xarray.DataArray(45.0, attrs={"units": "degree"})
    radii, angle = hertz.relative_radii((1.0, 2.0), (1.0, 3.0), degrees)  # type: ignore[arg-type]
    same_radii, same_angle = hertz.relative_radii((1.0, 2.0), (1.0, 3.0), np.pi / 4)
    assert (*radii, angle) == pytest.approx((*same_radii, same_angle), rel=1e-14)


@pytest.fixture(autouse=True)
def _no_warning_of_a_lost_unit() -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield
