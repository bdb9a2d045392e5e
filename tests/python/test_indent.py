"""Boundary of nacre.indent with Python, and charts over coatings."""

from __future__ import annotations

import json
import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import nacre
from nacre.indent import Adhesion, Indentation, Tip
from nacre.indent.charts import bulk_limit, pull_off_over_thickness

DATA = Path(__file__).parents[1] / "data"
STEEL = nacre.Elastic(210e9, 0.3)


def test_states_have_the_shape_of_what_is_given() -> None:
    test = Indentation(STEEL, Tip.paraboloid(1e-5))
    assert np.ndim(test.at(load=1e-3).approach) == 0
    assert test.at(load=[[1e-3, 2e-3]]).approach.shape == (1, 2)


def test_exactly_one_of_load_approach_and_radius_is_given() -> None:
    test = Indentation(STEEL, Tip.paraboloid(1e-5))
    with pytest.raises(ValueError, match="load"):
        test.at(load=1e-3, approach=1e-9)


def test_values_survive_pickles() -> None:
    for value in (Tip.paraboloid(1e-5), Tip.cone(0.3), Adhesion.jkr(0.1), Adhesion.dmt(0.1)):
        assert pickle.loads(pickle.dumps(value)) == value


def test_jkr_on_a_bare_body_is_the_closed_form() -> None:
    radius, work = 1e-5, 0.1
    test = Indentation(STEEL, Tip.paraboloid(radius), adhesion=Adhesion.jkr(work))
    # Johnson, Kendall and Roberts 1971: 3/2 πwR.
    assert test.pull_off().load == pytest.approx(-1.5 * math.pi * work * radius, rel=1e-9)


def test_pull_off_is_that_of_the_reference() -> None:
    for row in json.loads((DATA / "jkr.json").read_text())["table"]:
        if row["E1_over_E2"] in (0.1, 4.0):
            (force,) = pull_off_over_thickness(row["E1_over_E2"], [row["h_over_a0"]])
            # The digits that pull-off by this program and the reference share at least.
            assert force == pytest.approx(row["load_control"]["pull_off_over_piwR"], rel=1e-8)


@pytest.mark.parametrize(
    ("ratio", "limits"),
    [
        (0.1, (0.0128, 0.011, 0.0128)),
        (0.5, (0.0243, 0.0208, 0.0243)),
        (2.0, (0.0141, 0.0121, 0.0142)),
    ],
)
def test_limits_of_bulk_formulae(ratio: float, limits: tuple[float, float, float]) -> None:
    # Rows of the table of INDENT.md, section 5, at an error of 1 %, to its three digits.
    found = bulk_limit([ratio])
    for values, limit in zip(found.values(), limits, strict=True):
        assert values[0] == pytest.approx(limit, rel=0.01)
