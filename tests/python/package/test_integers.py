"""Integers and numbers may be those of NumPy, integers also whole floats; nothing else."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, COATED, STEEL, quiet
from nacre import bearing, fatigue, indent, rough
from nacre.contact.gradient import described

GRID = nacre.Grid((16, 20), (3e-4, 3.3e-4))
CONTACT = nacre.Contact(STEEL, GRID)
SOLUTION = quiet(CONTACT.solve, BALL, load=10.0)
LAYERED = quiet(nacre.solve, BALL, COATED, load=10.0, grid=GRID)
BALLS: dict[str, Any] = {"count": 9, "diameter": 8e-3, "pitch_diameter": 39e-3}
ROLLERS: dict[str, Any] = {"count": 14, "diameter": 0.01, "length": 0.009, "pitch_diameter": 0.065}
BARRELS: dict[str, Any] = {
    **{"count": 16, "diameter": 12e-3, "length": 11e-3, "pitch_diameter": 78e-3},
    **{"contact_angle": 0.2, "profile_radius": 0.04},
}
TURNED = quiet(bearing.DeepGrooveBall(**BALLS).solve, force=(64.0, 0.0, None), cells=(16, 16))


def table(path: Path) -> Path:
    """Return a file with columns of numbers without names."""
    path.write_text("".join(f"{k} {k * k} {3 * k}\n" for k in range(40)))
    return path


def frictional(**given: Any) -> Any:
    options = {"load": 10.0, "friction": 0.3, "tolerance": 1e-2} | given
    return quiet(CONTACT.slide, BALL, force=(1.0, 0.0), **options).traction


def rolled(**given: Any) -> Any:
    options = {"load": 10.0, "friction": 0.3, "direction": "+x", "tolerance": 1e-2} | given
    return quiet(CONTACT.roll, BALL, creepage=(1e-3, 0.0), **options)


def random(**given: Any) -> Any:
    options: dict[str, Any] = {"shape": (16, 16), "size": (1.0, 1.0), "rng": 1} | given
    numbers = {"hurst": 0.8, "shortest": 0.2, "longest": 1.0, "rms_height": 1.0}
    return rough.random_surface(**options, **numbers)  # type: ignore[arg-type]


def turned(**given: Any) -> Any:
    options = {"force": (64.0, 0.0, None), "cells": (16, 16)} | given
    return quiet(bearing.DeepGrooveBall(**BALLS).solve, **options)


def read_curve(path: Path, **given: Any) -> Any:
    options = {"depth": 0, "force": 1, "units": {"depth": "nm", "force": "µN"}} | given
    return indent.read(table(path / "a.txt"), **options)  # type: ignore[call-overload]


def read_profile(path: Path, **given: Any) -> Any:
    options = {"unit": ("mm", "mm"), "x": 0, "drop": 1} | given
    return nacre.SampledProfile.read(table(path / "a.txt"), **options)  # type: ignore[arg-type]


INTEGERS: dict[str, tuple[int, Callable[[Any], Any]]] = {
    "Grid(shape)": (16, lambda n: nacre.Grid((n, 20), (1.0, 1.0))),
    "Grid.line": (16, lambda n: nacre.Grid.line(n, 1.0)),
    "Contact(threads)": (1, lambda n: nacre.Contact(STEEL, GRID, threads=n)),
    "Convolution(threads)": (
        1,
        lambda n: nacre.Convolution(np.ones((4, 4)) + np.eye(4), threads=n),
    ),
    "influence_coefficients": (2, lambda n: nacre.influence_coefficients(STEEL, GRID, "plain", n)),
    "solve(max_cells)": (
        4096,
        lambda n: quiet(nacre.solve, BALL, STEEL, load=1.0, max_cells=n, tolerance=1e-2),
    ),
    "solve(threads)": (
        1,
        lambda n: quiet(nacre.solve, BALL, STEEL, load=1.0, grid=GRID, threads=n),
    ),
    "solve(max_iterations)": (99, lambda n: quiet(CONTACT.solve, BALL, load=1.0, max_iterations=n)),
    "slide(max_convolutions)": (4000, lambda n: frictional(max_convolutions=n)),
    "roll(cells)": (2, lambda n: rolled(cells=n)),
    "creep_coefficients": (8, lambda n: nacre.creep_coefficients(STEEL, None, (1.0, 2.0), cells=n)),
    "stress(threads)": (
        1,
        lambda n: quiet(nacre.stress, STEEL, GRID, SOLUTION.pressure, 1e-5, threads=n),
    ),
    "stress(residual by layer)": (
        1,
        lambda n: quiet(LAYERED.stress, [3e-5], x=0.0, residual={n: 1e8}),
    ),
    "gradient(layer)": (
        0,
        lambda n: described({"stress": "von_mises", "layer": n, "depths": n + 1}),
    ),
    "gradient(interface)": (
        0,
        lambda n: described({"stress": "max_shear", "interface": n}),
    ),
    "assess(threads)": (1, lambda n: quiet(fatigue.assess, SOLUTION, depths=[1e-5], threads=n)),
    "pressure_distribution": (8, lambda n: rough.pressure_distribution(SOLUTION, n)),
    "random_surface(shape)": (16, lambda n: random(shape=(n, 16))),
    "random_surface(rng)": (3, lambda n: random(rng=n)),
    "count of balls": (9, lambda n: bearing.DeepGrooveBall(**BALLS | {"count": n})),
    "count of rollers": (14, lambda n: bearing.CylindricalRoller(**ROLLERS | {"count": n})),
    "count of tapered rollers": (
        14,
        lambda n: bearing.TaperedRoller(**ROLLERS | {"count": n, "contact_angle": 0.25}),
    ),
    "count of barrels": (16, lambda n: bearing.SphericalRoller(**BARRELS | {"count": n})),
    "rows": (1, lambda n: bearing.SphericalRoller(**BARRELS, rows=n)),
    "solve of a bearing (cells)": (16, lambda n: turned(cells=(n, 16)).loads),
    "solve of a bearing (threads)": (1, lambda n: turned(threads=n).loads),
    "solve of a bearing (max_iterations)": (50, lambda n: turned(max_iterations=n).loads),
    "contact of an element": (0, lambda n: TURNED.contact(n, "inner").load),
    "edge_factors": (40, bearing.edge_factors),
}
FILES: dict[str, tuple[int, Callable[[Path, Any], Any]]] = {
    "read(depth)": (0, lambda path, n: read_curve(path, depth=n).depth),
    "read(segment)": (0, lambda path, n: read_curve(path, segment=n).depth),
    "SampledProfile.read(drop)": (1, lambda path, n: read_profile(path, drop=n)),
}
NUMBERS: dict[str, tuple[float, Callable[[Any], Any]]] = {
    "Elastic": (0.25, lambda x: nacre.Elastic(1.0, x)),
    "Sphere": (0.25, nacre.Sphere),
    "solve(load)": (0.25, lambda x: quiet(CONTACT.solve, BALL, load=x).pressure),
    "diameter": (2.0**-7, lambda x: bearing.DeepGrooveBall(**BALLS | {"diameter": x})),
    "clearance": (2.0**-16, lambda x: bearing.DeepGrooveBall(**BALLS, clearance=x)),
    "length": (2.0**-7, lambda x: bearing.CylindricalRoller(**ROLLERS | {"length": x})),
    "raceway_crown": (0.5, lambda x: bearing.CylindricalRoller(**ROLLERS, raceway_crown=(x, None))),
    "osculation": (0.53125, lambda x: bearing.DeepGrooveBall(**BALLS, osculation=(x, 0.5625))),
    "rotation": (0.25, lambda x: turned(rotation=x).loads),
    "speed": (8.0, lambda x: turned(speed=x).loads),
    "LundbergPalmgren": (9.5, lambda x: bearing.LundbergPalmgren(c=x)),
    "IoannidesHarris": (2.0**28, lambda x: bearing.IoannidesHarris(fatigue_limit=x)),
    "DangVan": (2.0**29, lambda x: fatigue.DangVan(x, 2.0**28)),
    "Point": (0.25, lambda x: nacre.hertz.Point(x, 1.0, 1.0)),
    "load_integrals": (0.5, lambda x: bearing.load_integrals(x, 1.5)),
    "windowed": (0.25, lambda x: rough.windowed(random(), x)),
    "tabor_parameter": (0.25, lambda x: indent.tabor_parameter(x, 1e6, 0.05, distance=1e-9)),
    "assess(friction)": (
        0.25,
        lambda x: quiet(fatigue.assess, SOLUTION, depths=[1e-5], friction=x).profiles[
            "first_yield"
        ],
    ),
    "assess(shear_yield)": (
        2.0**29,
        lambda x: quiet(fatigue.assess, SOLUTION, depths=[1e-5], shear_yield=x),
    ),
}
WHOLE: list[Callable[[int], Any]] = [float, np.int64, np.uint8, np.int32, np.float32, np.float64]
NOT_WHOLE = [True, np.True_, 9.5, np.float32(9.5), float("nan"), float("inf"), "9", 9j, None, [9]]


def same(one: Any, other: Any) -> bool:
    """Return whether results are equal, and print alike: no number of NumPy is kept."""
    if isinstance(one, np.ndarray) or hasattr(one, "dims"):
        return np.array_equal(one, other)
    if isinstance(one, nacre.Solution):
        return np.array_equal(one.pressure, other.pressure)
    if isinstance(one, nacre.types.History):
        return all(
            np.array_equal(*(s.traction for s in pair))  # type: ignore[arg-type]
            for pair in zip(one, other, strict=True)
        )
    if isinstance(one, nacre.types.Stress):
        return np.array_equal(one.von_mises, other.von_mises)
    return bool(one == other) and repr(one) == repr(other)


def holds(kind: Callable[[Any], Any], number: float) -> bool:
    """Return whether a type has this number."""
    try:
        with np.errstate(over="raise"):
            return float(kind(number)) == number
    except (OverflowError, FloatingPointError):
        return False


def refused(call: Callable[[Any], Any], wrong: Any) -> None:
    with pytest.raises((TypeError, ValueError)) as error:
        call(wrong)
    assert "object is not" not in str(error.value)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        *(("Grid(shape)", kind) for kind in WHOLE),
        *((name, np.int64) for name in INTEGERS if name != "Grid(shape)"),
        *((name, np.float32) for name in INTEGERS if name != "Grid(shape)"),
    ],
)
def test_whole_numbers_are_integers(name: str, kind: Callable[[int], Any]) -> None:
    number, call = INTEGERS[name]
    if not holds(kind, number):
        pytest.skip("the type does not hold it")
    assert same(call(kind(number)), call(number))


@pytest.mark.parametrize("name", INTEGERS)
def test_other_things_are_no_integers(name: str) -> None:
    for wrong in NOT_WHOLE:
        if wrong is None and any(
            word in name for word in ("threads", "max_", "cells", "influence", "rng")
        ):
            continue  # the default
        refused(INTEGERS[name][1], wrong)


@pytest.mark.parametrize("kind", [int, np.int64, np.float32, float], ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("name", FILES)
def test_whole_numbers_choose_columns(name: str, kind: Any, tmp_path: Path) -> None:
    number, call = FILES[name]
    assert same(call(tmp_path, kind(number)), call(tmp_path, number))
    for wrong in (True, 0.5, float("nan")):
        refused(lambda x: call(tmp_path, x), wrong)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        *(("Sphere", kind) for kind in (np.float64, np.float16, np.array)),
        *((name, np.float32) for name in NUMBERS),
    ],
)
def test_numbers_of_numpy_are_numbers(name: str, kind: Callable[[float], Any]) -> None:
    number, call = NUMBERS[name]
    if not holds(kind, number):
        pytest.skip("the type does not hold it")
    assert same(call(kind(number)), call(number))
    for wrong in (True, np.True_, "1", 1j, [1.0]):
        refused(call, wrong)
