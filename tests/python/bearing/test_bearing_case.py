"""A case file describes a bearing: solved, saved, loaded, swept and drawn."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest

import nacre
from bodies import quiet
from nacre.bearing import (
    AngularContactBall,
    BearingSolution,
    CylindricalRoller,
    DeepGrooveBall,
    Pair,
    SphericalRoller,
    TaperedRoller,
    film_thickness,
)
from nacre.case import Case, CaseError
from nacre.case.bearing import TABLES, sizes_of
from nacre.case.schema import Material
from nacre.case.tables import Directions, unit_of
from support import Capture, assert_close, command, written

CASE = """
[materials]
steel = { young = 210e9, poisson = 0.3 }
dlc = { young = 300e9, poisson = 0.25 }

[bearing]
kind = "cylindrical_roller"
count = 14
diameter = 10e-3
length = 9.6e-3
pitch_diameter = 65e-3
clearance = 41e-6
raceway_crown = { inner = 50.0 }
inner = { substrate = "steel", layers = [{ material = "dlc", thickness = 3e-6 }] }

[bearing.solve]
force = { x = 4450, y = 0 }
tilt = { y = 5e-4 }
cells = [40, 24]

[bearing.life]
edge = "pressure"

[bearing.film]
speed = 8
viscosity = 0.02
pressure_viscosity = 20e-9
roughness = 0.1e-6

[sweep]
store = "study.nc"
parameters."bearing.solve.tilt.y" = [0.0, 5e-4]
parameters."bearing.clearance" = [20e-6, 41e-6]
outputs = ["peak_pressure", "edge_pressure", "reference_life", "tilt", "loads"]
"""
BALL = """
[bearing]
kind = "deep_groove_ball"
count = 7
diameter = 11.5e-3
pitch_diameter = 43.5e-3
osculation = [0.515, 0.525]
solve = { force = { z = 1000 }, model = "iso16281" }
"""


TAPERED = """
[bearing]
kind = "tapered_roller"
count = 17
diameter = 8e-3
length = 11e-3
pitch_diameter = 48e-3
contact_angle = 0.25
profile = "straight"
solve = { force = { x = 3000, z = 4000 }, model = "iso16281" }
life = { edge = "none" }

[sweep]
store = "study.nc"
parameters."bearing.contact_angle" = [0.2, 0.25]
outputs = ["peak_pressure", "reference_life", "loads"]
"""
SPHERICAL = """
[bearing]
kind = "spherical_roller"
count = 19
rows = 2
diameter = 12e-3
length = 11e-3
pitch_diameter = 82e-3
contact_angle = 0.17
profile_radius = 46.5e-3
groove_radius = 47.5e-3
solve = { force = { x = 20000, z = 2000 }, tilt = { y = 0.01 }, model = "iso16281" }
life = {}

[sweep]
store = "study.nc"
parameters."bearing.profile_radius" = [46e-3, 46.5e-3]
outputs = ["peak_pressure", "reference_life", "loads"]
"""


def test_arguments_are_those_of_the_bearing() -> None:
    steel = nacre.Elastic(young=210e9, poisson=0.3)
    found = Case(tomllib.loads(CASE)).arguments()
    layer = nacre.Layer(nacre.Elastic(300e9, 0.25), 3e-6)
    assert found == {
        "bearing": CylindricalRoller(
            count=14,
            diameter=10e-3,
            length=9.6e-3,
            pitch_diameter=65e-3,
            clearance=41e-6,
            raceway_crown=(50.0, None),
            inner=nacre.HalfSpace(steel, [layer]),
        ),
        "force": (4450, 0, None),
        "tilt": (None, 5e-4),
        "cells": (40, 24),
    }
    ball = Case(tomllib.loads(BALL)).arguments()
    made = DeepGrooveBall(
        count=7, diameter=11.5e-3, pitch_diameter=43.5e-3, osculation=(0.515, 0.525)
    )
    assert ball["bearing"] == made


MILLIMETRES = """
units = "N-mm-MPa"

[materials]
steel = { young = 210e3, poisson = 0.3 }
dlc = { young = 300e3, poisson = 0.25 }

[bearing]
kind = "cylindrical_roller"
count = 14
diameter = 10
length = 9.6
pitch_diameter = 65
clearance = 41e-3
raceway_crown = { inner = 50e3 }
capacity = 50000
density = 7.85e-9
inner = { substrate = "steel", layers = [{ material = "dlc", thickness = 3e-3 }] }
profile = { kind = "sampled", x = [-4.8, 0, 4.8], drop = [0.01, 0, 0.01] }

[bearing.solve]
force = { x = 4450, y = 0 }
tilt = { y = 5e-4 }
speed = 3
cells = [40, 24]

[bearing.film]
speed = 8000
viscosity = 0.02e-6
pressure_viscosity = 20e-3
roughness = 0.1e-3
"""


def test_other_units_are_converted_once() -> None:
    case = Case(tomllib.loads(MILLIMETRES))
    found, steel = case.arguments(), nacre.Elastic(young=210e9, poisson=0.3)
    bearing = found["bearing"]
    expected = {
        "diameter": 10e-3,
        "length": 9.6e-3,
        "pitch_diameter": 65e-3,
        "clearance": 41e-6,
        "capacity": 50e3,
        "density": 7850.0,
        "count": 14,
    }
    for name, value in expected.items():
        assert getattr(bearing, name) == pytest.approx(value, rel=1e-15)
    assert bearing.raceway_crown == (50.0, None)
    assert bearing.inner.layers[0].thickness == pytest.approx(3e-6, rel=1e-15)
    assert bearing.inner.layers[0].material.young == pytest.approx(300e9, rel=1e-15)
    assert bearing.inner.substrate == bearing.outer == steel
    assert_close(bearing.profile.drop, (10e-6, 0.0, 10e-6), rtol=1e-15)
    assert_close(bearing.profile.x, (-4.8e-3, 0.0, 4.8e-3), rtol=1e-15)
    assert found["force"] == (4450.0, 0.0, None)
    assert (found["tilt"], found["speed"], found["cells"]) == ((None, 5e-4), 3.0, (40, 24))
    film = case.film() or {}
    assert film.pop("ring") == "inner"
    expected = {"speed": 8.0, "viscosity": 0.02, "pressure_viscosity": 20e-9, "roughness": 0.1e-6}
    assert film == pytest.approx(expected, rel=1e-15)
    # A pound-force, an inch: density in lbf s²/in⁴.
    imperial = Case(tomllib.loads(MILLIMETRES)).in_units("lbf-in-psi")
    with pytest.raises(CaseError, match="bearing: diameter must be at most"):
        imperial(**{"bearing.diameter": 12.0})
    pounds = sizes_of("lbf-in-psi")
    assert pounds["kg/m³"] == pytest.approx(0.45359237 * 9.80665 / 0.0254**4, rel=1e-12)
    assert pounds["N m"] == pytest.approx(0.45359237 * 9.80665 * 0.0254, rel=1e-12)


def test_each_number_of_a_case_has_a_unit() -> None:
    """Keys without one are known: counts, ratios and powers."""
    plain = {
        *("count", "rows", "poisson", "rating_factor", "osculation", "tolerance", "end_factor"),
        *("max_iterations", "cells", "k1", "k2", "film_ratio", "viscosity_ratio", "share"),
        *("contamination", "reliability", "grade", "temperature"),
        "static_safety",
    }

    def units(table: Any, path: tuple[str, ...]) -> dict[str, str]:
        found: dict[str, str] = {}
        for name, field in table.model_fields.items():
            kinds = [kind for kind in parts(field.annotation) if hasattr(kind, "model_fields")]
            for kind in kinds:
                if not issubclass(kind, Directions):
                    found |= units(kind, (name,))
            own = set(parts(field.annotation)) & {float, int}
            if own or any(issubclass(kind, Directions) for kind in kinds):
                found[".".join((*path, name))] = unit_of(field)
        return found

    def parts(hint: Any) -> list[Any]:
        inner = [part for one in get_args(hint) for part in parts(one)]
        return inner or [hint]

    declared = units(Material, ())
    for table in TABLES.values():
        declared |= units(table, ())
    expected = {"diameter": "m", "solve.force": "N", "profile.x": "m", "layers.thickness": "m"}
    expected |= {"film.speed": "m/s", "solve.speed": "rad/s", "density": "kg/m³"}
    assert expected.items() <= declared.items()
    known = {*sizes_of("SI"), "rad", "rad/s", "h"}
    for key, unit in declared.items():
        assert (unit in known) != (key.rpartition(".")[2] in plain and not unit), key


def test_other_units_are_printed(tmp_path: Path, capsys: Capture) -> None:
    metres = BALL.replace("solve =", "shoulder_height = 3e-3\nlife = {}\nsolve =")
    changes = (
        ("[bearing]", 'units = "N-mm-MPa"\n[bearing]'),
        ("11.5e-3", "11.5"),
        ("43.5e-3", "43.5"),
        ("shoulder_height = 3e-3", "shoulder_height = 3"),
        ("z = 1000", "z = 1000.0"),
    )
    millimetres = metres
    for old, new in changes:
        assert old in millimetres
        millimetres = millimetres.replace(old, new, 1)
    told = {}
    for name, text in (("SI", metres), ("N-mm-MPa", millimetres)):
        path = written(tmp_path, text)
        assert command("solve", path, "--json") == 0
        told[name] = json.loads(capsys.readouterr().out)
        assert told[name]["units"] == name
        assert command("solve", path, "--save", tmp_path / f"{name}.nc") == 0
        told[f"{name} in words"] = capsys.readouterr().out
    one, other = told["SI"], told["N-mm-MPa"]
    for name, factor in (
        ("displacement", 1e3),
        ("force", 1.0),
        ("peak_pressures", 1e-6),
        ("approaches", 1e3),
        ("contact_angles", 1.0),
    ):
        assert_close(other[name], np.multiply(one[name], factor), rtol=1e-8)
    # N/m and N; N and N m: with mm, 1e-3 and 1; 1 and 1e3.
    blocks = np.array([[1e-3] * 3 + [1.0] * 2] * 3 + [[1.0] * 3 + [1e3] * 2] * 2)
    largest = np.abs(other["tangent"]).max()
    assert_close(other["tangent"], blocks * one["tangent"], rtol=1e-8, atol=1e-9 * largest)
    for name in ("l10r", "revolutions", "equivalent_load", "capacity"):
        assert other["life"][name] == pytest.approx(one["life"][name], rel=1e-8)
    assert other["bearing"]["DeepGrooveBall"]["diameter"] == pytest.approx(11.5, rel=1e-15)
    assert other["bearing"]["DeepGrooveBall"]["element"]["Elastic"]["young"] == 210e3
    pressure = np.max(other["peak_pressures"])
    assert f"peak pressure  {pressure:.4g} MPa" in told["N-mm-MPa in words"]
    assert f"peak pressure  {pressure / 1e3:.4g} GPa" in told["SI in words"]
    # Files are in SI.
    loaded = nacre.load(tmp_path / "N-mm-MPa.nc")
    assert_close(loaded.peak_pressures, one["peak_pressures"], rtol=1e-8)


def test_a_study_in_other_units_names_them(tmp_path: Path) -> None:
    text = MILLIMETRES.replace("cells = [40, 24]", 'model = "iso16281"').partition("[bearing.film]")
    study = 'parameters."bearing.clearance" = [20e-3, 41e-3]\noutputs = ["peak_pressure"]'
    case = Case.read(written(tmp_path, f"{text[0].replace('speed = 3', '')}\n[sweep]\n{study}"))
    with nacre.display_units(case.units):
        found = quiet(nacre.sweep, case, progress=False, **case.study())
    assert found.peak_pressure.attrs["units"] == "Pa"
    assert 1e9 < float(found.peak_pressure[0]) < 3e9
    expected = quiet(
        case(**{"bearing.clearance": 20e-3})["bearing"].solve,
        **{k: v for k, v in case.arguments().items() if k != "bearing"},
    )
    assert float(found.peak_pressure[0]) == pytest.approx(expected.peak_pressure, rel=1e-12)


def test_case_is_solved_saved_loaded_drawn_and_swept(tmp_path: Path, capsys: Capture) -> None:
    path, saved = written(tmp_path, CASE), tmp_path / "bearing.nc"
    assert command("solve", path, "--save", saved, "--save", tmp_path / "bearing.png") == 0
    out = capsys.readouterr().out
    assert "loaded         5 of 14 elements" in out
    assert "edge factors from the solved pressure" in out
    solution = nacre.load(saved)
    assert isinstance(solution, BearingSolution)
    assert solution.report.converged
    assert (tmp_path / "bearing.png").stat().st_size > 10_000
    assert command("solve", path, "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert_close(told["loads"], solution.loads, rtol=1e-12)
    assert told["life"]["l10r"] == pytest.approx(solution.life("pressure").l10r)
    contact = solution.contact(int(solution.loads[:, 0].argmax()), "inner")
    assert contact is not None
    film = film_thickness(
        contact, speed=8.0, viscosity=0.02, pressure_viscosity=20e-9, roughness=0.1e-6
    )
    for name in ("minimum", "film_ratio", "load"):
        assert told["film"][name] == pytest.approx(getattr(film, name), rel=1e-6)
    assert told["film"]["ellipticity"] is None  # infinite
    assert f"film ratio λ    {film.film_ratio:.4g}" in out
    assert command("sweep", path) == 0
    printed = capsys.readouterr().out
    assert "bearing.clearance [µm]" in printed
    assert "reference_life [million revolutions]" in printed
    assert "4 cases, 0 failed" in printed
    import xarray

    with xarray.open_dataset(tmp_path / "study.nc") as study:
        assert study.loads.shape == (2, 2, 14, 2)
        assert study.tilt.dims[-1] == "axis"
        assert study.peak_pressure.attrs["units"] == "Pa"
        pressure = study.edge_pressure.sel({"bearing.clearance": 41e-6}).values
        assert pressure[1] > pressure[0]
        assert pressure[1] == pytest.approx(solution.edge_pressure, rel=1e-9)


def test_a_study_of_a_pair_has_the_numbers_of_its_solutions() -> None:
    ball = AngularContactBall(count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4)
    pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
    keywords: dict[str, Any] = {"force": (400.0, 0.0, 150.0), "model": "iso16281"}
    study = nacre.sweep({"bearing": pair, **keywords}, {"speed": [100.0, 200.0]}, progress=False)
    assert study["error"].values.tolist() == ["", ""]
    for number, speed in enumerate((100.0, 200.0)):
        solution = pair.solve(speed=speed, **keywords)
        assert study["peak_pressure"].values[number] == solution.peak_pressure
        assert study["largest_load"].values[number] == solution.largest_load
    assert np.isnan(study["edge_pressure"]).all()  # balls have no edges


def test_a_function_makes_a_study_of_bearings() -> None:
    def case(clearance: float) -> dict[str, Any]:
        bearing = DeepGrooveBall(
            count=7, diameter=11.5e-3, pitch_diameter=43.5e-3, clearance=clearance
        )
        return {"bearing": bearing, "force": (1000.0, 0.0, None), "model": "iso16281"}

    study = nacre.sweep(case, {"clearance": [0.0, 20e-6]}, progress=False)
    assert set(study.data_vars) >= {"displacement", "largest_load", "peak_pressure"}
    assert float(study.largest_load[1]) > float(study.largest_load[0])
    wrong = quiet(nacre.sweep, case, {"clearance": [-1.0]}, progress=False)
    assert "clearance must be at least" in str(wrong.error.values[0])
    with pytest.raises(TypeError, match="keywords of the solve of a bearing"):
        nacre.sweep({"bearing": case(0.0)["bearing"], "load": 1.0}, {"speed": [1.0]})
    with pytest.raises(ValueError, match=r"nacre\.bearing\.BearingSolution"):
        nacre.sweep({"bearing": case(0.0)["bearing"]}, {"speed": [1.0]}, outputs=["approach"])


@pytest.mark.parametrize(
    ("text", "bearing", "elements"),
    [
        (
            TAPERED,
            TaperedRoller(
                count=17,
                diameter=8e-3,
                length=11e-3,
                pitch_diameter=48e-3,
                contact_angle=0.25,
                profile=None,
            ),
            17,
        ),
        (
            SPHERICAL,
            SphericalRoller(
                count=19,
                diameter=12e-3,
                length=11e-3,
                pitch_diameter=82e-3,
                contact_angle=0.17,
                profile_radius=46.5e-3,
                groove_radius=47.5e-3,
            ),
            38,
        ),
    ],
    ids=["tapered", "spherical"],
)
def test_other_rollers_are_solved_and_swept(
    text: str, bearing: Any, elements: int, tmp_path: Path, capsys: Capture
) -> None:
    path, saved = written(tmp_path, text), tmp_path / "bearing.nc"
    assert Case.read(path).arguments()["bearing"] == bearing
    assert command("solve", path, "--save", saved) == 0
    assert "life L10r" in capsys.readouterr().out
    solution = nacre.load(saved)
    assert isinstance(solution, BearingSolution)
    assert solution.bearing == bearing
    assert command("sweep", path) == 0
    import xarray

    with xarray.open_dataset(tmp_path / "study.nc") as study:
        assert study.loads.shape == (2, elements, 2)
        assert study.peak_pressure.values[1] == pytest.approx(solution.peak_pressure, rel=1e-12)
        lives = study.reference_life.values
        assert lives[1] == pytest.approx(solution.reference_life, rel=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("count = 14", "count = 30", "bearing: count must be at most 20"),
        ("diameter = 10e-3", "diametre = 1", "bearing.diametre: there is no such key"),
        ('kind = "cylindrical_roller"', 'kind = "sleeve"', "bearing.kind: must be one of"),
        ("[materials]", 'units = "N-mm-Pa"\n[materials]', "units must be consistent"),
        (
            "[materials]",
            'units = "N-mm-MPa"\n[materials]',
            r"bearing: inner must have a modulus from 1e\+09 to 2e\+12",
        ),
        ('edge = "pressure"', 'edge = "sharp"', "bearing.life.edge: must be"),
        ("viscosity = 0.02", "viscocity = 0.02", "bearing.film.viscocity: there is no such key"),
        ("viscosity = 0.02", "", "bearing.film.viscosity must be given, or the table bearing.oil"),
        ("speed = 8", 'speed = "fast"', "bearing.film.speed: must be a finite number"),
        ("speed = 8", 'speed = 8\nring = "cage"', "bearing.film.ring: must be"),
        (
            "cells = [40, 24]",
            'model = "iso16281"',
            'bearing.solve.model must be "solved" for bearing.film',
        ),
        ('substrate = "steel"', 'substrate = "bronze"', "bearing.inner.substrate: must be one of"),
    ],
)
def test_wrong_cases_are_refused(old: str, new: str, message: str, tmp_path: Path) -> None:
    path = written(tmp_path, CASE.replace(old, new, 1))
    with pytest.raises(CaseError, match=message):
        Case.read(path).arguments()


def test_films_of_both_rings_and_wrong_ones(tmp_path: Path, capsys: Capture) -> None:
    film = "film = { speed = 5, viscosity = 0.02, pressure_viscosity = 20e-9, ring = 'outer' }"
    text = BALL.replace(', model = "iso16281"', ", cells = [32, 32]") + film
    path = written(tmp_path, text)
    assert command("solve", path, "--json") == 0
    told = json.loads(capsys.readouterr().out)["film"]
    # Hamrock and Dowson's point; the radius is that of ball and outer raceway, 1/(2/D − 2/d).
    assert told["radius"] == pytest.approx(1 / (2 / 11.5e-3 - 2 / 55e-3), rel=1e-3)
    assert told["film_ratio"] is None
    for old, new, message in (
        ("speed = 5", "speed = 0", "bearing.film: speed must be finite and above 0"),
        ("force = { z = 1000 }", "force = { z = 0 }", "bearing.film: no element is loaded"),
    ):
        assert command("solve", written(tmp_path, text.replace(old, new))) == 2
        assert message in capsys.readouterr().err


def test_a_sweep_of_a_film_is_refused(tmp_path: Path) -> None:
    key = 'parameters."bearing.clearance"'
    path = written(tmp_path, CASE.replace(key, 'parameters."bearing.film.speed"', 1))
    with pytest.raises(CaseError, match=r"bearing\.film\.speed.* changes nothing in a solve"):
        Case.read(path).study()


def test_bearing_has_no_initial_solution_and_no_fields(tmp_path: Path) -> None:
    path = written(tmp_path, BALL)
    assert command("solve", path, "--initial", path) == 2
    assert command("solve", path, "--save", tmp_path / "x.vtr") == 2
    assert command("indent", path) == 2
