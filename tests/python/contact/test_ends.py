"""Free ends of bodies reach the solver from Python, and come back from files, cases and studies."""

from __future__ import annotations

import json
import tomllib
import warnings
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import nacre
from bodies import BALL, STEEL
from nacre.case import Case
from nacre.results import values

LAYERS = [nacre.Layer(nacre.Elastic(420e9, 0.25), 2e-6)]
COATED = nacre.HalfSpace(STEEL, LAYERS)

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # the ends are sharp


# Arguments.


@pytest.mark.parametrize(
    ("given", "ends"),
    [
        ((None, None), (None, None)),
        ((-1e-3, 2e-3), (-1e-3, 2e-3)),
        ([-1, None], (-1.0, None)),
        (np.array([0.25, 0.5]), (0.25, 0.5)),
        ((-inf, 2e-3), (None, 2e-3)),
        ((-1e-3, inf), (-1e-3, None)),
        ((-inf, inf), (None, None)),
    ],
)
def test_ends_may_be_missing_or_infinite(
    given: Any, ends: tuple[float | None, float | None]
) -> None:
    body = nacre.HalfSpace(STEEL, LAYERS, ends=given)
    assert body.ends == ends
    assert (body == nacre.HalfSpace(STEEL, LAYERS)) == (ends == (None, None))


def test_bodies_go_on_by_default_and_differ_by_their_ends() -> None:
    assert nacre.HalfSpace(STEEL).ends == (None, None)
    assert repr(nacre.HalfSpace(STEEL)).endswith("layers=[])")
    bodies = [nacre.HalfSpace(STEEL, ends=ends) for ends in [(None, 1.0), (0.0, 1.0), (0.0, None)]]
    assert len({nacre.HalfSpace(STEEL), *bodies}) == 4


def test_a_roller_knows_its_ends() -> None:
    crowned = nacre.Roller(5e-3, flat_length=8e-3, crown_radius=1.0)
    assert crowned.ends == (None, None)
    profile = nacre.LogarithmicProfile.iso16281(10e-3, 12e-3)
    logarithmic = nacre.Roller(5e-3, profile=profile)
    assert logarithmic.ends == (-0.5 * profile.length, 0.5 * profile.length)
    assert nacre.Roller(5e-3, profile=profile, length=10e-3).ends == (-5e-3, 5e-3)
    sampled = nacre.Roller(5e-3, profile=([-4e-3, 0.0, 6e-3], [1e-6, 0.0, 1e-6]))
    assert sampled.ends == (-4e-3, 6e-3)


# Solves.


def test_each_end_of_a_roller_is_warned_of_where_the_other_body_goes_on() -> None:
    roller = nacre.Roller(5e-3, flat_length=2e-4, crown_radius=1.0, length=2e-4)
    whole, free = nacre.HalfSpace(STEEL), nacre.HalfSpace(STEEL, ends=roller.ends)
    grid = nacre.Grid((24, 24), (2.4e-4, 2.4e-4))
    for bodies, kinds in (
        ((whole, whole), ["sharp end"]),
        ((whole, free), ["free end"]),
        ((free, free), []),
    ):
        assert nacre.solve(roller, *bodies, grid=grid, load=10.0).report.warning_kinds == kinds


def test_a_plan_has_the_ends_of_its_bodies() -> None:
    contact = nacre.Contact(
        nacre.HalfSpace(STEEL, ends=(-1e-4, None)), nacre.Grid((32, 32), (4e-4, 4e-4)), COATED
    )
    assert isinstance(contact.body, nacre.HalfSpace)
    assert contact.body.ends == (-1e-4, None)
    assert isinstance(contact.counterbody, nacre.HalfSpace)
    assert contact.counterbody.ends == (None, None)
    solution = contact.solve(BALL, load=10.0)
    assert solution.report.body == contact.body
    # Nothing touches beyond the end.
    assert not solution.pressure[solution.x < -1e-4].any()


def test_a_grid_is_found_beside_an_end_just_outside_the_contact() -> None:
    body = nacre.HalfSpace(STEEL, ends=(None, 1.03e-4))
    radius = 0.97e-4  # without the end
    load = 4 / 3 * STEEL.plane_strain_modulus / 2 * radius**3 / BALL.radius
    found = nacre.solve(BALL, body, STEEL, load=load)
    edges = found.grid.center[0] + np.array([-0.5, 0.5]) * found.grid.size[0]
    assert edges[1] == pytest.approx(1.03e-4, rel=1e-6)
    # A margin of a quarter of the contact's width, up to some of its 64 cells across.
    (left, right), _ = found.contact_extent
    assert (left - edges[0]) / (right - left) == pytest.approx(0.25, abs=5 / 64)
    # The end lowers the stiffness: the ball goes deeper.
    assert found.approach > nacre.solve(BALL, STEEL, STEEL, load=load).approach


def test_an_approach_is_refused_where_far_ends_leave_the_operator_indefinite() -> None:
    """On a grid that repeats along y, u counts from the period; two far ends lower its mean."""
    unit = nacre.Elastic(1.0, 0.0)
    bodies = [nacre.HalfSpace(unit, ends=(None, end)) for end in (1.5, 10.5)]
    grid = nacre.Grid((8, 4), (1.0, 1.0), periodic=(False, True))
    heights = np.random.default_rng(0).uniform(0.0, 1e-3, grid.shape)
    shape = nacre.HeightMap(heights, grid.spacing, center=grid.center, periodic=grid.periodic)
    solution = nacre.solve(shape, *bodies, grid=grid, load=2e-4)
    with pytest.raises(ValueError, match="approach cannot be prescribed"):
        nacre.solve(shape, *bodies, grid=grid, approach=solution.approach)


def test_the_report_says_how_ends_are_counted() -> None:
    grid = nacre.Grid((48, 48), (2.4e-4, 2.4e-4))

    def told(body: nacre.HalfSpace | nacre.Elastic) -> dict[str, bool | float | None] | None:
        return nacre.solve(BALL, body, grid=grid, load=10.0).report.free_ends

    assert told(STEEL) is None
    assert told(nacre.HalfSpace(STEEL, ends=(-1e-4, None))) == {"plates": False, "error": 1e-5}
    assert told(nacre.HalfSpace(STEEL, ends=(-1e-3, 1e-4))) == {"plates": True, "error": 1e-3}
    for ratio, error in [(2.0, 0.04), (8.0, 0.09), (12.0, None)]:
        layer = nacre.Layer(nacre.Elastic(ratio * STEEL.young, 0.3), 2e-6)
        body = nacre.HalfSpace(STEEL, [layer], ends=(None, 1e-4))
        assert told(body) == {"plates": False, "error": error}


# What is saved.


def test_a_file_gives_the_ends_back(tmp_path: Path) -> None:
    grid = nacre.Grid((32, 32), (4e-4, 4e-4))
    body = nacre.HalfSpace(STEEL, LAYERS, ends=(-1e-4 / 0.8, None))
    solution = nacre.solve(BALL, body, STEEL, grid=grid, load=10.0)
    assert "coated end" in solution.report.warning_kinds
    saved = nacre.load(solution.save(tmp_path / "a.nc"))
    assert saved == solution
    assert saved.report.body == solution.report.body
    assert saved.report.warning_kinds == solution.report.warning_kinds
    assert nacre.Solution.from_dict(solution.to_dict()) == solution


def test_bodies_without_ends_are_kept_as_before_there_were_ends() -> None:
    # Older versions read them, and older studies are found again.
    assert set(values.encode(COATED)["HalfSpace"]) == {"substrate", "layers"}
    assert COATED.__reduce__() == (nacre.HalfSpace, (STEEL, COATED.layers))
    assert values.decode(values.encode(COATED)) == COATED


@pytest.mark.parametrize("ends", [(-1e-2 / 3, 1e-2 / 7), (None, 0.5), (-0.5, None)])
def test_plain_data_hold_the_ends_under_their_name(ends: tuple[float | None, float | None]) -> None:
    body = nacre.HalfSpace(STEEL, LAYERS, ends=ends)
    data = json.loads(json.dumps(values.encode(body)))
    # Versions before there were ends refuse a key that they do not know.
    assert data["HalfSpace"]["ends"] == list(ends)
    assert values.decode(data) == body


def test_wrong_ends_in_data_are_a_value_error() -> None:
    data = values.encode(nacre.HalfSpace(STEEL, ends=(0.0, 1.0)))
    for wrong in ([1.0, 0.0], [1.0], "both", 3):
        data["HalfSpace"]["ends"] = wrong
        with pytest.raises(ValueError, match="ends must be"):
            values.decode(data)


# Studies and cases.


def test_a_study_takes_bodies_with_ends_and_counts_their_warnings(tmp_path: Path) -> None:
    grid = nacre.Grid((24, 24), (2.4e-4, 2.4e-4))
    roller = nacre.Roller(5e-3, flat_length=2e-4, crown_radius=1.0, length=2e-4)
    bodies = {
        "whole": nacre.HalfSpace(STEEL),
        "free": nacre.HalfSpace(STEEL, ends=roller.ends),
        "coated": nacre.HalfSpace(STEEL, LAYERS, ends=roller.ends),
    }
    case = {"shape": roller, "body": STEEL, "grid": grid, "load": 10.0}
    parameters, store = {"counterbody": bodies}, tmp_path / "a.nc"
    with pytest.warns(nacre.NacreWarning) as issued:
        study = nacre.sweep(case, parameters, store=store, progress=False)
    (said,) = (str(warning.message) for warning in issued)
    assert "free end (2)" in said
    assert "coated end (1)" in said
    assert "sharp end (1)" in said
    approach = study.approach.sel(counterbody=["whole", "free"]).values
    assert approach[0] < approach[1]
    journal = (tmp_path / "a.journal").read_bytes()
    with pytest.warns(nacre.NacreWarning):
        again = nacre.sweep(case, parameters, store=store, progress=False)
    xarray.testing.assert_identical(again, study)
    assert (tmp_path / "a.journal").read_bytes() == journal  # nothing was solved again


CASE: dict[str, Any] = tomllib.loads("""
shape = { kind = "roller", radius = 5.0, flat_length = 0.2, crown_radius = 1e3, length = 0.2 }
body.substrate = { young = 210e3, poisson = 0.3 }
counterbody = { substrate = { young = 210e3, poisson = 0.3 }, ends = [-0.1, 0.1] }
grid = { shape = [24, 24], size = [0.24, 0.24] }
solve.load = 10.0
""")


def test_a_case_is_the_call_in_python() -> None:
    arguments = Case(CASE | {"units": "N-mm-MPa"}).arguments()
    assert arguments["counterbody"].ends == arguments["shape"].ends == (-0.1, 0.1)
    case = Case(CASE | {"body": CASE["body"] | {"ends": [-inf, 0.1]}})
    assert case.arguments()["body"].ends == (None, 0.1)


def test_the_ends_of_a_case_can_be_swept(tmp_path: Path) -> None:
    lists = [[-0.1, 0.1], [-0.1, inf], [-inf, inf]]
    sweep = {"parameters": {"counterbody.ends": lists}, "outputs": ["approach"]}
    case = Case(CASE | {"sweep": sweep})
    study = nacre.sweep(case, progress=False, store=tmp_path / "a.nc", **case.study())
    both, one, none = study.approach.values
    assert none < one < both
    sweep = {"parameters": {"counterbody.ends[1]": [0.1, inf]}, "outputs": ["approach"]}
    case = Case(CASE | {"sweep": sweep})
    single = nacre.sweep(case, progress=False, **case.study())
    assert single.approach.values.tolist() == [both, one]


def test_no_warning_without_contact_at_the_ends() -> None:
    # A ball far from both ends.
    body = nacre.HalfSpace(STEEL, ends=(-1e-3, 1e-3))
    with warnings.catch_warnings():
        warnings.simplefilter("error", nacre.NacreWarning)
        nacre.solve(BALL, body, load=1.0)


def test_stresses_near_ends_of_periodic_grids_are_refused() -> None:
    body = nacre.HalfSpace(STEEL, ends=(-1e-4, None))
    grid = nacre.Grid((32, 32), (4e-4, 4e-4), periodic=(False, True))
    solution = nacre.solve(BALL, body, grid=grid, load=1.0)
    with pytest.raises(ValueError, match="need a grid that has cells along x and is not periodic"):
        solution.stress(1e-5)
