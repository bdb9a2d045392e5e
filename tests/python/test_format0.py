"""Files that were written before states had names and a format number load with the same bits.

`tests/data/format0/make_fixtures.py` wrote them, with the last version that had no format number.
"""

import json
import pickle
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import nacre
from nacre import _identity, values

FOLDER = Path(__file__).parents[1] / "data" / "format0"
STEEL = nacre.Elastic(210e9, 0.3)
DLC = nacre.Elastic(420e9, 0.25)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 4e-5), nacre.Layer(STEEL, 1e-5)])
GRID = nacre.Grid((24, 20), (3e-4, 2e-4), (1e-5, -2e-6))
NUMBERS = dict(np.load(FOLDER / "numbers.npz"))


def same(found: Any, name: str) -> bool:
    expected = NUMBERS[name]
    array = np.asarray(found, dtype=np.float64)
    return bool(array.shape == expected.shape and array.tobytes() == expected.tobytes())


def figures(solution: nacre.Solution) -> list[float | None]:
    report = solution.report
    return [
        solution.approach,
        *solution.tilt,
        report.residual,
        report.overlap,
        *report.balance,
        report.iterations,
        report.convolutions,
        report.tolerance,
        report.seconds,
        *(report.discretisation or {}).values(),
    ]


def pickled() -> dict[str, Any]:
    kept: dict[str, Any] = pickle.loads((FOLDER / "values.pickle").read_bytes())
    return kept


@pytest.mark.parametrize("name", ["ball", "line"])
@pytest.mark.parametrize("kind", ["netcdf", "pickle"])
def test_solutions_load_to_the_bit(name: str, kind: str) -> None:
    solution = nacre.load(FOLDER / f"{name}.nc") if kind == "netcdf" else pickled()[name]
    for field in ("pressure", "gap", "displacement"):
        assert same(getattr(solution, field), f"{name}.{field}")
    assert same(figures(solution), f"{name}.figures")


def test_what_was_asked_is_read_too() -> None:
    report = nacre.load(FOLDER / "ball.nc").report
    assert report.body == COATED
    assert report.counterbody == nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 2e-5)])
    assert report.grid == GRID
    assert report.motion == {"load": 10.0, "eccentricity": (1e-6, None), "tilt": (None, 1e-4)}
    assert (report.method, report.refinement, report.termination) == ("exact", 4, "converged")
    line = nacre.load(FOLDER / "line.nc").report
    assert line.grid == nacre.Grid.line(64, 2e-4, 1e-6)
    assert line.body.layers[0].interface == "frictionless"


def test_pickles_of_stresses_load_to_the_bit() -> None:
    kept = pickled()
    for field in ("xx", "xz", "uz", "z"):
        assert same(getattr(kept["stress"], field), f"stress.{field}")
    summary = kept["summary"]
    peaks = [
        number
        for part in (*summary.layers, *summary.interfaces)
        for name in ("von_mises", "tension", "max_shear", "compression", "shear", "jump")
        if (peak := getattr(part, name, None)) is not None
        for number in (peak[0], *peak[1])
    ]
    assert same(peaks, "summary.figures")
    assert (kept["layer"], kept["interface"]) == (summary.layers[0], summary.interfaces[0])


def test_pickles_of_the_parts_load() -> None:
    kept = pickled()
    assert kept["report"] == kept["ball"].report
    heights = nacre.HeightMap(np.arange(6).reshape(2, 3) / 3e6, 1e-6)
    assert kept["shape"] == (nacre.Sphere(5e-3) + heights).shifted(1e-3, 0.0)
    assert kept["roller"] == nacre.Roller(5e-3, profile=nacre.LogarithmicProfile(1e-6, 1e-2))
    assert kept["punch"] == nacre.FlatPunch(1e-3)
    assert kept["contact"] == nacre.Contact(COATED, GRID, method="image", refinement=2, threads=1)


def test_what_is_loaded_can_be_saved_in_the_new_format(tmp_path: Path) -> None:
    solution = nacre.load(FOLDER / "ball.nc")
    path = solution.save(tmp_path / "new.nc")
    with xarray.open_dataset(path, engine="h5netcdf") as dataset:
        assert json.loads(dataset.attrs["nacre_solution"])["format"] == values.FORMAT
    assert nacre.load(path) == solution


def case(load: float) -> dict[str, Any]:
    return {"shape": nacre.Sphere(5e-3), "body": COATED, "grid": GRID, "load": load}


@pytest.mark.filterwarnings("ignore:.* cases have warnings")
def test_a_study_goes_on_from_its_journal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    journal = tmp_path / "study.journal"
    shutil.copy(FOLDER / "study.journal", journal)
    before = journal.read_bytes()

    def fail(*_: object) -> None:
        raise AssertionError("this case is in the journal")

    # A version solves its own cases only; this one stands for the version that wrote the journal.
    monkeypatch.setattr(_identity, "__version__", "0.1.0")
    monkeypatch.setattr("nacre.studies._solve", fail)
    store = tmp_path / "study.nc"
    with pytest.warns(nacre.NacreWarning, match="1 of 3 cases failed"):
        study = nacre.sweep(case, {"load": [5.0, 10.0, -1.0]}, store=store, progress=False)
    assert journal.read_bytes() == before
    expected = xarray.load_dataset(FOLDER / "study.nc", engine="h5netcdf")
    # The estimated errors are newer than the journal.
    new = ["approach_discretisation", "peak_pressure_discretisation"]
    assert all(np.isnan(study[name]).all() for name in new)
    xarray.testing.assert_identical(study.drop_attrs().drop_vars(new), expected.drop_attrs())
