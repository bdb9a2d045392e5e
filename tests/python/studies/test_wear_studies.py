"""Studies of wear keep the life and the end of each history; a life that did not end is NaN."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import nacre

pytest.importorskip("xarray")
STEEL, DLC = nacre.Elastic(210e9, 0.3), nacre.Elastic(300e9, 0.2)
BODY = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 1e-6, name="DLC")])
CASE: dict[str, Any] = {
    "shape": nacre.Cylinder(10e-3),
    "body": BODY,
    "load": 1e5,
    "grid": nacre.Grid.line(64, 6e-4),
    "rate": {"DLC": 1e-17, "substrate": 1e-15},
    "sliding": 250.0,
    "until": "through",
}
FRETTING: dict[str, Any] = {
    "shape": nacre.Sphere(5e-3),
    "body": STEEL,
    "counterbody": STEEL,
    "grid": nacre.Grid((24, 24), (3e-4, 3e-4)),
    "load": 10.0,
    "rate": 1e-14,
    "cycles": 10.0,
    "slide": {"friction": 0.6, "steps": [{"force": (3.0, None)}, {"force": (-3.0, None)}]},
    "steps": 1,
}

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")


def test_lives_are_those_of_the_histories_and_nan_without_a_wear_through() -> None:
    study = nacre.sweep(CASE, {"rate.DLC": [1e-17, 2e-17], "sliding": [100.0, 250.0]})
    assert {*study.data_vars} == {
        *("life", "worn_volume", "deepest", "peak_pressure", "contact_area", "error", "warnings"),
        "life_discretisation",
    }
    assert (study.error == "").all()
    assert np.isnan(study.life.values).tolist() == [[True, False], [True, False]]
    history = nacre.wear(**CASE)
    assert history.life is not None
    assert study.life[0, 1] == history.life.distance
    assert study.life_discretisation[0, 1] == history.life.uncertainty
    assert study.life_discretisation.attrs == {
        "long_name": "error of life due to the length of the steps, estimated",
        "units": "m",
    }
    assert study.peak_pressure[0, 1] == history.peak_pressure[-1]
    assert study.worn_volume[0, 1] == history.worn_volume
    assert study.deepest[0, 1] == history.deepest[-1].max()
    units = {name: study[name].attrs["units"] for name in ("life", "worn_volume", "contact_area")}
    assert units == {"life": "m", "worn_volume": "m²", "contact_area": "m"}
    assert study["rate.DLC"].attrs["units"] == "m²/N"
    assert (study.warnings == "").all()
    beyond = nacre.sweep(CASE | {"until": None}, {"sliding": [250.0]})
    assert beyond.life[0] == pytest.approx(history.life.distance, rel=1e-4)
    assert "a layer is worn through" in str(beyond.warnings[0].values)


def test_cycles_have_no_unit_and_functions_see_the_history() -> None:
    outputs: dict[str, Any] = {
        "life": "life",
        "distance": "distance",
        "steps": lambda history: history.report.steps,
    }
    study = nacre.sweep(FRETTING, {"cycles": [10.0, 20.0]}, outputs=outputs)
    assert np.isnan(study.life.values).all()
    assert study.distance.values.tolist() == [10.0, 20.0]
    assert study.steps.values.tolist() == [1.0, 1.0]
    assert "units" not in study.life.attrs
    assert "units" not in study.distance.attrs


def test_a_case_that_fails_says_why() -> None:
    study = nacre.sweep(CASE, {"sliding": [-1.0, 1.0]}, outputs=["worn_volume"])
    assert study.error[0] == "ValueError: sliding must be finite and at least 0, got -1"
    assert study.worn_volume[1] == pytest.approx(1e-17 * 1e5, rel=1e-12)


def test_a_study_whose_cases_all_fail_has_the_columns_of_wear() -> None:
    failed = nacre.sweep(CASE, {"sliding": [-1.0, -2.0]})
    good = nacre.sweep(CASE, {"sliding": [1.0, 2.0]})
    assert (failed.error != "").all()
    assert list(failed.data_vars) == list(good.data_vars)
    for name in good.data_vars:
        assert failed[name].attrs == good[name].attrs, name
    cycles = nacre.sweep(FRETTING, {"cycles": [-1.0]})
    assert cycles.error[0] != ""
    assert "units" not in cycles.life.attrs
    assert cycles.worn_volume.attrs["units"] == "m³"


@pytest.mark.parametrize("name", ["store", "friction"])
def test_other_arguments_than_those_of_wear_are_refused(name: str) -> None:
    with pytest.raises(TypeError, match=rf"arguments of nacre.wear .* got \['{name}'\]"):
        nacre.sweep(CASE | {name: 0.1}, {"load": [1e5]})


def test_outputs_of_contacts_are_none_of_wear() -> None:
    with pytest.raises(ValueError, match="outputs must be numbers of a history of wear"):
        nacre.sweep(CASE, {"load": [1e5]}, outputs=["von_mises"])
    contact = {name: CASE[name] for name in ("shape", "body", "grid", "load")}
    with pytest.raises(ValueError, match="outputs must be attributes of Solution"):
        nacre.sweep(contact, {"load": [1e5]}, outputs=["life"])


def test_a_finished_study_is_not_solved_again(tmp_path: Any) -> None:
    parameters = {"load": [1e5, 2e5]}
    first = nacre.sweep(CASE, parameters, store=tmp_path / "study.nc")
    journal = (tmp_path / "study.journal").read_bytes()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        again = nacre.sweep(CASE, parameters, store=tmp_path / "study.nc")
    assert again.equals(first)
    assert (tmp_path / "study.journal").read_bytes() == journal
    assert first.life[0] > first.life[1]
