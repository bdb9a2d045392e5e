"""Indentations and fits come back from files as they were; tables and printed forms hold them."""

from __future__ import annotations

import csv
import dataclasses
import json
import pickle
from pathlib import Path

import numpy as np
import pytest
import xarray

import nacre
from nacre.indent import IndentSolution, solve
from results import FILM, ROUND, solved


def test_the_file_says_what_its_numbers_are(tmp_path: Path) -> None:
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
    with pytest.raises(ValueError, match="another version may read it"):
        IndentSolution.from_dict(state | {"format": 99})
    with pytest.raises(ValueError, match="'more'"):
        IndentSolution.from_dict(state | {"more": 1})


def test_tables_hold_the_contacts(tmp_path: Path) -> None:
    found = solved("row")
    with found.save(tmp_path / "a.csv").open(encoding="utf-8") as file:
        head, *rows = csv.reader(line for line in file if not line.startswith("#"))
    assert head[:2] == ["load [N]", "approach [m]"]
    np.testing.assert_array_equal(np.array(rows, float)[:, 0], found.load)
    with pytest.raises(ValueError, match=r"must end in \.nc, \.csv, \.png, \.pdf, \.svg, \.html"):
        found.save(tmp_path / "a.txt")
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


def test_other_indentations_differ() -> None:
    assert solved("one") != solve(nacre.Elastic(1e9, 0.3), ROUND, load=1e-3)


def test_pull_off_is_that_of_the_indentation_and_nan_without_adhesion() -> None:
    found = solved("sticky")
    last = found.indentation.pull_off("approach")
    assert (found.pull_off_load, found.pull_off_radius) == (last.load, last.radius)
    assert np.isnan(solved("one").pull_off_load)
    with pytest.raises(ValueError, match="control"):
        solve(FILM, ROUND, load=1e-3, control="force")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="load"):
        solve(FILM, ROUND)


def test_printed_forms_have_units_and_agree() -> None:
    found = solved("sticky")
    assert repr(found).startswith("<IndentSolution: 2 contacts, load 100 µN to 1 mN, approach")
    text, markup = str(found), found._repr_html_()
    assert text.splitlines()[-1].startswith("pull-off: load -")
    for cell in ("115.3 nm", "1 mN", "central pressure"):
        assert (cell in text) == (cell in markup)
    assert "central pressure" in markup
    many = solve(FILM, ROUND, load=np.linspace(1e-4, 1e-3, 40))
    assert "and 10 more contacts" in str(many)
    assert "inf" in str(solved("sharp"))


def test_the_files_of_a_fit_say_what_its_numbers_are(tmp_path: Path) -> None:
    found = solved("fit")
    with xarray.open_dataset(found.save(tmp_path / "fit.nc")) as read:
        assert list(read.parameter.values) == list(found.estimates)
        np.testing.assert_array_equal(read.force[read.curve == 1], found.curves[1].force)
    with found.save(tmp_path / "fit.csv").open(encoding="utf-8") as file:
        _, _, head, *rows = csv.reader(file)
    assert head[:3] == ["parameter", "unit", "estimate"]
    assert [float(row[2]) for row in rows] == list(found.estimates.values())
    assert rows[0][1] == "Pa"
    assert "95 % of noise" in found._repr_html_()


def test_fits_are_equal_where_all_is(tmp_path: Path) -> None:
    found = solved("fit")
    assert nacre.load(found.save(tmp_path / "fit.nc")) == found
    assert pickle.loads(pickle.dumps(found)) == found
    unknown = [dataclasses.replace(found, condition=float("nan")) for _ in range(2)]
    assert unknown[0] == unknown[1]
    assert unknown[0] != found
    residuals = [part + 1e-15 for part in found.residuals]
    assert dataclasses.replace(found, residuals=residuals) != found
    assert found != 1
