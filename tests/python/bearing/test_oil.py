"""Viscosity of oils by grade and temperature, and the oil of a case."""

from __future__ import annotations

import math
import tomllib
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from nacre.bearing import oil_viscosity
from nacre.bearing.oil import BASIS
from nacre.case import Case, CaseError, templates
from support import assert_close


@pytest.mark.parametrize("grade", [10, 32, 68, 220, 1500])
def test_a_grade_is_the_viscosity_at_40_degrees(grade: float) -> None:
    assert_close(oil_viscosity(grade, 40.0), grade * 1e-6, rtol=1e-12)


@pytest.mark.parametrize(
    ("viscosity", "low", "high"),
    [(4.0, 25.32, 19.56), (8.0, 100.0, 59.60), (12.0, 201.9, 108.0), (20.0, 493.2, 229.5)],
)
def test_the_table_has_the_oils_of_the_standard(viscosity: float, low: float, high: float) -> None:
    """Viscosities at 40 °C of the oils of index 0 and 100 in table 1 of ASTM D2270."""
    row = BASIS[np.searchsorted(BASIS[:, 0], viscosity, side="right") - 1]
    for k, expected in ((1, low), (4, high)):
        assert_close(np.polyval(row[k : k + 3], viscosity), expected, rtol=2e-3)


def test_the_parabolas_of_the_table_meet() -> None:
    for before, after in pairwise(BASIS):
        for k in (1, 4):
            ends = [np.polyval(row[k : k + 3], after[0]) for row in (before, after)]
            assert_close(ends[0], ends[1], rtol=2e-3)  # 10 times the digits of the standard


@pytest.mark.parametrize("grade", [15, 46, 150, 680])
def test_the_index_at_100_degrees_is_95(grade: float) -> None:
    at_100 = 1e6 * oil_viscosity(grade, 100.0)
    row = BASIS[np.searchsorted(BASIS[:, 0], at_100, side="right") - 1]
    low, high = (np.polyval(row[k : k + 3], at_100) for k in (1, 4))
    assert (low - grade) / (low - high) * 100 == pytest.approx(95.0, abs=0.5)


def test_oils_are_thinner_when_they_are_warmer_and_of_a_lower_grade() -> None:
    viscosities = [[oil_viscosity(g, t) for t in (0, 40, 80, 120)] for g in (22, 68, 320)]
    assert (np.diff(viscosities, axis=1) < 0).all()
    assert (np.diff(viscosities, axis=0) > 0).all()


@pytest.mark.parametrize(
    ("grade", "temperature", "words"),
    [
        (5, 40, "grade must be from 10 to 1500, got 5"),
        (68, 343, "temperature must be from -20 to 150 °C, got 343"),
        (math.nan, 40, "grade must be finite"),
    ],
)
def test_wrong_oils_are_refused(grade: float, temperature: float, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        oil_viscosity(grade, temperature)


def case_of(**oil: object) -> dict[str, Any]:
    """Return the data of the template of a roller bearing with an oil."""
    data: dict[str, Any] = tomllib.loads(templates.texts()["bearing"])
    data["bearing"]["oil"] = {"grade": 68, "temperature": 70} | oil
    return data


def test_the_oil_of_a_case_is_in_life_and_film() -> None:
    data = case_of(cleanliness="high cleanliness")
    life = Case(data).life()
    assert life is not None
    assert_close(life["kinematic_viscosity"], oil_viscosity(68, 70))
    assert life["contamination"] == "high cleanliness"
    film = Case(data).film()
    assert film is not None
    assert film["viscosity"] == 0.02  # which the template has
    del data["bearing"]["film"]["viscosity"]
    film = Case(data).film()
    assert film is not None
    assert_close(film["viscosity"], 870 * oil_viscosity(68, 70))
    # The inner ring rotates: both surfaces have half its speed against the rollers' centres.
    assert_close(film["speed"], 157.1 * 27.25e-3 * (76.545 / (54.5 + 76.545)), rtol=1e-12)
    data["bearing"]["life"] = {"viscosity_ratio": 2.0, "contamination": 0.5}
    assert "kinematic_viscosity" not in (Case(data).life() or {})


def test_a_film_needs_a_viscosity_or_an_oil() -> None:
    data = case_of()
    del data["bearing"]["oil"], data["bearing"]["film"]["viscosity"]
    with pytest.raises(CaseError, match=r"bearing\.film\.viscosity must be given"):
        Case(data)


def test_a_wrong_oil_of_a_case_names_its_table() -> None:
    with pytest.raises(ValueError, match=r"bearing\.oil: temperature must be"):
        Case(case_of(temperature=343)).life()
