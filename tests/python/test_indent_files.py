"""Indentations and fits come back from files as they were; tables and printed forms hold them."""

from __future__ import annotations

import csv
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre.indent import Adhesion, Fit, IndentSolution, Tip, fit, solve

pytest.importorskip("xarray")
GLASS, FILM = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
BODY = nacre.HalfSpace(GLASS, [nacre.Layer(FILM, 1e-6, name="film")])
BALL = Tip.sphere(5e-6)
SOLUTIONS: dict[str, Any] = {
    "one": {"load": 1e-3},
    "row": {"approach": [1e-9, 1e-8, 1e-7]},
    "plane": {"radius": [[1e-7, 2e-7], [3e-7, 4e-7]]},
    "sticky": {"load": [1e-4, 1e-3], "adhesion": Adhesion.jkr(0.05), "control": "approach"},
    "maugis": {"load": 1e-3, "adhesion": Adhesion.maugis(0.05, 1e7), "counterbody": GLASS},
    "sharp": {"load": [1e-3], "tip": Tip.cone(0.3)},
    "rough": {"load": 1e-4, "tip": Tip.profile(np.linspace(0, 4e-6, 5), np.arange(5.0) ** 2 / 1e7)},
}


def solved(name: str) -> IndentSolution:
    return solve(**({"body": BODY, "tip": BALL} | SOLUTIONS[name]))


@pytest.mark.parametrize("name", SOLUTIONS)
def test_an_indentation_comes_back_to_the_bit(name: str, tmp_path: Path) -> None:
    found = solved(name)
    again = nacre.load(found.save(tmp_path / "a.nc"))
    copies = [again, IndentSolution.from_dict(json.loads(json.dumps(found.to_dict())))]
    for copy in [*copies, pickle.loads(pickle.dumps(again))]:
        assert copy == found
        assert type(copy.load) is type(found.load)
        np.testing.assert_array_equal(copy.load, found.load)
        assert (copy.body, copy.tip, copy.adhesion) == (found.body, found.tip, found.adhesion)
        # The same program solves the same problem: no bit differs.
        np.testing.assert_array_equal(copy.state.load, found.load)
    assert found != solve(nacre.Elastic(1e9, 0.3), BALL, load=1e-3)


def test_the_file_says_what_its_numbers_are(tmp_path: Path) -> None:
    import xarray

    found = solved("sticky")
    with xarray.open_dataset(found.save(tmp_path / "a.nc")) as read:
        assert read.approach.dims == ("load",)
        assert read.approach.attrs["units"] == "m"
        assert read.attrs["source"] == f"nacre {nacre.__version__}"
        assert json.loads(read.attrs["tip"]) == {"Tip.sphere": {"radius": 5e-6}}
        assert json.loads(read.attrs["adhesion"]) == {"Adhesion.jkr": {"work": 0.05}}
        assert read.attrs["pull_off_load"] == found.pull_off_load
        np.testing.assert_array_equal(read.approach, found.approach)
    with nacre.display_units("mN-µm-GPa"):
        assert found.to_xarray()["load"].attrs["units"] == "mN"
    assert solved("plane").to_xarray().radius.dims == ("radius_0", "radius_1")


def test_changed_files_are_refused(tmp_path: Path) -> None:
    import h5py

    path = solved("row").save(tmp_path / "a.nc")
    with h5py.File(path, "r+") as file:
        file["load"][0] *= 2
    with pytest.raises(ValueError, match="changed, or saved again by another program"):
        nacre.load(path)
    state = solved("one").to_dict()
    with pytest.raises(ValueError, match="install a newer version"):
        IndentSolution.from_dict(state | {"format": 99})
    with pytest.raises(ValueError, match="'more'"):
        IndentSolution.from_dict(state | {"more": 1})


def test_tables_hold_the_contacts(tmp_path: Path) -> None:
    found = solved("row")
    with found.save(tmp_path / "a.csv").open(encoding="utf-8") as file:
        head, *rows = csv.reader(line for line in file if not line.startswith("#"))
    assert head[:2] == ["load [N]", "approach [m]"]
    np.testing.assert_array_equal(np.array(rows, float)[:, 0], found.load)
    with pytest.raises(ValueError, match=r"must end in \.nc or \.csv"):
        found.save(tmp_path / "a.txt")
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


def test_pull_off_is_that_of_the_indentation_and_nan_without_adhesion() -> None:
    found = solved("sticky")
    last = found.indentation.pull_off("approach")
    assert (found.pull_off_load, found.pull_off_radius) == (last.load, last.radius)
    assert np.isnan(solved("one").pull_off_load)
    with pytest.raises(ValueError, match="control"):
        solve(BODY, BALL, load=1e-3, control="force")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="load"):
        solve(BODY, BALL)


def test_printed_forms_have_units_and_agree() -> None:
    found = solved("sticky")
    assert repr(found).startswith("<IndentSolution: 2 contacts, load 100 µN to 1 mN, approach")
    text, markup = str(found), found._repr_html_()
    assert text.splitlines()[-1].startswith("pull-off: load -")
    for cell in ("115.3 nm", "1 mN", "central pressure"):
        assert (cell in text) == (cell in markup)
    assert "central pressure" in markup
    many = solve(BODY, BALL, load=np.linspace(1e-4, 1e-3, 40))
    assert "and 10 more contacts" in str(many)
    assert "inf" in str(solved("sharp"))


def fitted() -> Fit:
    depth = np.linspace(10e-9, 300e-9, 12)
    noise = np.exp(0.01 * np.random.default_rng(3).standard_normal((2, depth.size)))
    load = nacre.indent.Indentation(BODY, BALL).curve(approach=depth).load
    curves = [nacre.indent.Curve(depth, load * part, name=f"A{k}") for k, part in enumerate(noise)]
    young = "body.layers[0].material.young"
    return fit(curves, BODY, BALL, [young], nuisance=["contact_point"], profile=False)


def test_a_fit_comes_back_to_the_bit(tmp_path: Path) -> None:
    import xarray

    found = fitted()
    path = found.save(tmp_path / "fit.nc")
    again = nacre.load(path)
    assert isinstance(again, Fit)
    assert str(again) == str(found)
    assert again.curves == found.curves
    assert (again.estimates, again.body) == (found.estimates, found.body)
    np.testing.assert_array_equal(again.covariance, found.covariance)
    with xarray.open_dataset(path) as read:
        assert list(read.parameter.values) == list(found.estimates)
        np.testing.assert_array_equal(read.force[read.curve == 1], found.curves[1].force)
    with found.save(tmp_path / "fit.csv").open(encoding="utf-8") as file:
        _, head, *rows = csv.reader(file)
    assert head[:3] == ["parameter", "unit", "estimate"]
    assert [float(row[2]) for row in rows] == list(found.estimates.values())
    assert rows[0][1] == "Pa"
    assert "95 % interval" in found._repr_html_()
