"""What results print and keep: numbers are attributes, warnings stand in the report, dust is 0."""

from __future__ import annotations

import dataclasses
import json
import re
import warnings
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, ROD, STEEL, quiet
from nacre import bearing, fatigue
from nacre.indent import Curve, Indentation, fit
from nacre.results import files
from nacre.results.quantities import Quantity
from results import FILM, FITS, FRICTION, INDENT, LISTED, NORMAL, ROUND, solved
from support import assert_close

SIZES = {"": 1.0, "p": 1e-12, "n": 1e-9, "µ": 1e-6, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9}
NUMBER = re.compile(
    r"(-?\d[\d.]*(?:e[+-]?\d+)?)(?: ([pnµmkMG]?)(?:N|Pa|J|m|rad)(?![A-Za-z])(²?)\S*)?"
)
REPORTED = {
    "motion": "report.motion",
    "body": "report.body",
    "counterbody": "report.counterbody",
    "grid": "report.grid",
    "ended": "report.termination",
}
"""Rows of contacts that are no quantities, and the attributes that they are of."""


def read(text: str) -> list[float]:
    """Return the numbers in a text, in SI units, without their errors."""
    text = re.sub(r" ± (?:(?:over )?[\d.]+ %|\(.*?\))", "", text)
    return [
        float(number) * SIZES[prefix] ** (2 if square else 1)
        for number, prefix, square in NUMBER.findall(text)
    ]


def attribute(result: Any, path: str) -> Any:
    for name in path.split("."):
        result = getattr(result, name)
    return result


@pytest.mark.parametrize("kind", [*NORMAL, *FRICTION])
def test_printed_numbers_of_contacts_are_attributes(kind: str) -> None:
    result = solved(kind)
    tables: tuple[Quantity, ...] = (*nacre.Solution._QUANTITIES, *type(result)._QUANTITIES)
    labels = {row.label: row for row in tables if row.label}
    normal: Any = getattr(result, "normal", result)
    for label, text in re.findall(r"^(\S.*?)  +(\S.*)$", str(result), re.MULTILINE):
        if label in REPORTED:
            attribute(normal, REPORTED[label])
            continue
        if label.startswith(("E*", "layers", "free", "friction", "rolls", "warning")):
            continue  # of bodies, and words
        value = np.ravel(getattr(result, labels[label].name)).astype(float)
        numbers = read(text)
        if label == "contact":
            value = np.diff(value.reshape(2, 2))[:, 0][-len(numbers) :]
        elif label == "at":
            half = (0.5 + 1e-9) * np.array(normal.grid.spacing)
            value = np.where(np.abs(value) <= half, 0.0, value)
        elif label == "share":
            value = 100 * value
        elif label == "springs":
            value = np.array([value.min(), value.max()])
        elif label in ("hardness", "indentation"):
            value = np.array([value.max()])
        if "nothing touches" in text:
            continue
        found = numbers[: value.size]
        assert len(found) == value.size, (label, text)
        # Four digits are printed, and 0 for what is rounding beside the other component.
        noise = 1e-8 * max(np.abs(value).max(), 1e-30)
        if np.any(found):
            assert_close(found, value, rtol=6e-4, atol=noise)


@pytest.mark.parametrize("kind", list(FRICTION))
def test_numbers_of_the_normal_contact_are_those_of_one_with_friction(kind: str) -> None:
    result = solved(kind)
    for row in nacre.Solution._QUANTITIES:
        if row.name not in ("displacement", "elastic_energy", "coefficients"):
            ours, theirs = getattr(result, row.name), getattr(result.normal, row.name)
            np.testing.assert_equal(ours, theirs, err_msg=row.name)
    total = result.normal.elastic_energy + result.tangential_energy
    assert result.elastic_energy == total


ROLLERS = {"count": 14, "diameter": 10e-3, "length": 9.6e-3, "pitch_diameter": 65e-3}


def bearings() -> dict[str, Any]:
    solution = bearing.CylindricalRoller(**ROLLERS).solve(force=(5e3, 0.0, None), model="iso16281")  # type: ignore[arg-type]
    line = nacre.solve(ROD, STEEL, STEEL, grid=nacre.Grid.line(64, 2e-4), load=1e4)
    model = bearing.LundbergPalmgren()
    film = quiet(bearing.film_thickness, line, speed=2.0, viscosity=0.02, pressure_viscosity=2e-8)
    return {
        "bearing": solution,
        "life": solution.life(),
        "volume": bearing.stress_volume(line, model),
        "ratio": bearing.life_ratio(line, line, model),
        "film": film,
    }


def test_every_result_has_its_warnings_in_its_report() -> None:
    kinds = [*NORMAL, *FRICTION, *INDENT, *LISTED]
    history = solved("line slid")
    others = {
        "history": nacre.types.History([history]),
        "stress": history.stress([1e-5]),
        "summary": quiet(history.stress_summary),
    }
    for name, result in ({kind: solved(kind) for kind in kinds} | bearings() | others).items():
        assert all(isinstance(text, str) for text in result.report.warnings), name
    assert all(isinstance(text, str) for text in solved(next(iter(FITS))).warnings)


def test_warnings_of_friction_are_those_that_were_issued() -> None:
    """A contact of few cells: steps of a history, rolling, and the saved history."""
    coarse = nacre.Contact(STEEL, nacre.Grid((16, 16), (6e-4, 6e-4)), STEEL)
    load: dict[str, Any] = {"load": 1.0, "friction": 0.3}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        history = coarse.slide(BALL, **load, steps=[{"force": (f, None)} for f in (0.1, 0.2)])
        rolled = coarse.roll(BALL, **load, creepage=(1e-4, 0.0), direction="+x")
    issued = {str(one.message) for one in caught}
    assert issued
    assert {*history.report.warnings, *rolled.report.warnings} == issued
    assert set(history[-1].report.warnings) <= issued
    again = nacre.types.History.from_dict(json.loads(json.dumps(history.to_dict(), default=list)))
    assert again.report.warnings == history.report.warnings
    report = rolled.report
    assert nacre.types.FrictionReport.from_dict(report.to_dict()) == report
    old = {k: v for k, v in report.to_dict().items() if k not in ("warnings", "coupling_energy")}
    assert nacre.types.FrictionReport.from_dict(old) == dataclasses.replace(report, warnings=())


def test_warnings_of_fits_and_lives_are_kept() -> None:
    depth = np.linspace(10e-9, 300e-9, 12)
    load = Indentation(FILM, ROUND).curve(approach=depth).load
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        # Forces in micronewtons: moduli a million times too large.
        found = fit(Curve(depth, 1e6 * load), FILM, ROUND, ["body.layers[0].material.young"])
    issued = [str(one.message) for one in caught if one.category is nacre.NacreWarning]
    assert issued
    assert {*found.warnings} == {*issued}
    light, heavy = (nacre.solve(BALL, STEEL, STEEL, load=load) for load in (1.0, 50.0))
    # A third of the pressure is above the largest shear of the light contact, which is 0.3 of it.
    model = bearing.IoannidesHarris(fatigue_limit=light.peak_pressure / 3)
    with pytest.warns(nacre.NacreWarning, match="infinite"):
        ratio = bearing.life_ratio(light, heavy, model)
    assert any("infinite" in text for text in ratio.report.warnings)


# Periodic contacts.


def bumps(periodic: tuple[bool, bool], at: tuple[float, float]) -> nacre.Solution:
    """Return a bump on 32 × 32 cells of 1 µm, around a place in micrometres."""
    n, cell = 32, 1e-6
    grid = nacre.Grid((n, n), (n * cell, n * cell), periodic=periodic)
    x, y = np.meshgrid(1e6 * grid.x, 1e6 * grid.y, indexing="ij")
    waves = [np.cos(2 * np.pi * (p - a) / n) for p, a in zip((x, y), at, strict=True)]
    heights = nacre.HeightMap(2e-8 * (waves[0] + waves[1]), cell, periodic=periodic)
    return nacre.solve(heights, STEEL, grid=grid, load=2e-3)


@pytest.mark.parametrize("periodic", [(True, True), (True, False), (False, True), (False, False)])
def test_what_has_no_meaning_on_a_periodic_axis_is_nowhere(
    periodic: tuple[bool, bool], tmp_path: Any
) -> None:
    for middle in (0.0, 4.0, 16.0):
        at = (middle if periodic[0] else 2.0, middle if periodic[1] else 2.0)
        solution = quiet(bumps, periodic, at)
        for name in ("eccentricity", "moment"):
            assert np.isnan(getattr(solution, name)).tolist() == list(periodic)
        wraps = [p and middle == 16.0 for p in periodic]
        assert np.isnan(solution.contact_extent).any(axis=1).tolist() == wraps
        assert np.isnan(solution.contact_extent).all(axis=1).tolist() == wraps
        kept = [k for k in range(2) if not periodic[k]]
        for k in kept:  # the middle of the bump, to a part of a cell
            assert solution.eccentricity[k] == pytest.approx(2e-6, abs=1e-7)
        text, known = str(solution), bool(kept)
        assert "nan" not in text + repr(solution) + solution._repr_html_()
        assert ("acts at" in text, "moment" in text) == (known, known)
        assert ("contact  " in text) == (not all(wraps))
        attributes = solution.to_xarray().attrs
        assert {"eccentricity", "moment"} & {*attributes} == (
            {"eccentricity", "moment"} if known else set()
        )
        page = solution.save(tmp_path / "a.csv", whole=True).read_text("utf-8")
        assert ("# eccentricity" in page, "# moment" in page) == (known, known)
        assert nacre.load(solution.save(tmp_path / "a.nc")) == solution
        axes = solution.plot()
        assert "nan" not in "".join(one.get_title(loc="left") for one in axes.values())
        solution.plot_section("x")
        solution.plot_section("y")


def test_studies_of_periodic_contacts_have_no_moments() -> None:
    grid = nacre.Grid((16, 16), (1e-5, 1e-5), periodic=(True, False))
    case = {"shape": ROD, "body": STEEL, "grid": grid}
    outputs = ["eccentricity", "moment", "peak_pressure"]
    study = quiet(nacre.sweep, case, {"load": [1e-2, 2e-2]}, outputs=outputs, progress=False)
    for name in ("eccentricity", "moment"):
        assert np.isnan(study[name].sel(axis="x")).all()
        assert np.isfinite(study[name].sel(axis="y")).all()


# Rounding.


def test_places_that_are_rounding_and_the_unloaded_state_are_words() -> None:
    coat = nacre.Layer(nacre.Elastic(300e9, 0.25), 3e-6)
    solution = nacre.solve(nacre.Sphere(6e-3), nacre.HalfSpace(STEEL, [coat]), STEEL, load=50.0)
    summary = quiet(
        fatigue.assess, solution, criteria=[fatigue.DangVan(bending=520e6, torsion=330e6)]
    )
    text = str(summary)
    assert not re.search(r"\binf\b|\bnan\b|e-\d+ pm", text)
    places = [peak[1][1] for layer in summary.layers for peak in layer._peaks().values()]
    half = 0.5 * float(np.ptp(solution.contact_extent[1]))
    assert all(y == 0 or abs(y) > 1e-9 * half for y in places)
    assert ("unloaded" in text) == any(map(np.isinf, places))
    assert not re.search(r"e-\d+ pm", str(solution) + str(quiet(solution.stress_summary)))


@pytest.mark.parametrize("control", ["eccentricity", "moment"])
def test_a_tilt_that_is_rounding_is_printed_as_0(control: Any) -> None:
    grid = nacre.Grid((40, 40), (3e-4, 3e-4))
    solution = nacre.solve(BALL, STEEL, grid=grid, load=10.0, **{control: (0.0, 0.0)})  # type: ignore[arg-type]
    assert re.search(r"^tilt +\(0, 0\) ± ", str(solution), re.MULTILINE)
    tilted = nacre.solve(BALL, STEEL, grid=grid, load=10.0, tilt=(1e-7, None))
    assert re.search(r"^tilt +\(1e-07, 0\)( ±|$)", str(tilted), re.MULTILINE)


def test_files_load_with_what_is_nowhere(tmp_path: Any) -> None:
    solution = quiet(bumps, (True, True), (0.0, 0.0))
    assert files.load(solution.save(tmp_path / "b.nc")).report.warnings == solution.report.warnings
