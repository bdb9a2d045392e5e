"""What is saved comes back bit for bit; what cannot be written leaves nothing behind."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista
import xarray

import nacre
import nacre.indent
import results
import support
from bodies import BALL, STEEL
from nacre.results import values
from results import DLC, GRID, solved
from support import Patch, assert_close, python, resealed


@pytest.mark.parametrize("kind", [*results.NORMAL, *results.FRICTION])
def test_other_programs_read_the_file_as_the_dataset(kind: str, tmp_path: Path) -> None:
    result = solved(kind)
    read = xarray.load_dataset(result.save(tmp_path / "a.nc"), engine="h5netcdf")
    dataset = result.to_xarray()
    assert read.equals(dataset)
    for name, variable in dataset.variables.items():
        assert read.variables[name].attrs == variable.attrs


def test_the_attributes_repeat_the_run() -> None:
    solution = solved("both coated, tilted")
    said = solution.to_xarray().attrs
    body, counterbody, grid, motion = (
        values.decode(json.loads(said[name])) for name in ("body", "counterbody", "grid", "motion")
    )
    again = nacre.solve(BALL, body, counterbody, grid=grid, tolerance=said["tolerance"], **motion)
    assert again.pressure.tobytes() == solution.pressure.tobytes()
    # The gap of the shape is in the fields too, to rounding: that of numbers of size u.
    x, y = np.meshgrid(solution.x, solution.y, indexing="ij")
    tilted = said["approach"] + said["tilt"][0] * x + said["tilt"][1] * y
    gaps = solution.gap - solution.displacement + tilted
    rounding = 8 * np.finfo(float).eps * np.abs(solution.gap).max()
    assert_close(gaps, BALL.gaps(grid), rtol=0, atol=rounding)


def test_units_and_coordinates_are_there() -> None:
    dataset = solved("infinite gaps").to_xarray()
    assert {str(n): dataset[n].attrs["units"] for n in dataset.variables} == {
        "pressure": "Pa",
        "gap": "m",
        "displacement": "m",
        "line_load": "N/m",
        "x": "m",
        "y": "m",
    }
    assert float(dataset.pressure.sel(x=1e-5, y=0, method="nearest")) > 0


@pytest.mark.parametrize(
    "kind", ["both coated, tilted", "infinite gaps", "nothing touches", *results.FRICTION]
)
def test_pyvista_reads_the_vtk_file_back(kind: str, tmp_path: Path) -> None:
    solution = solved(kind)
    mesh = pyvista.read(solution.save(tmp_path / "a.vtr"))
    assert isinstance(mesh, pyvista.RectilinearGrid)
    shape = solution.pressure.shape
    slides = kind in results.FRICTION
    for name in ("pressure", "stick") if slides else ("pressure", "gap", "displacement"):
        read = np.asarray(mesh.cell_data[name]).reshape(shape, order="F")
        np.testing.assert_array_equal(read, getattr(solution, name))
    for name in ("traction", "displacement", "slip") if slides else ():
        vectors = np.asarray(mesh.cell_data[name]).reshape(*shape, 3, order="F")
        np.testing.assert_array_equal(vectors[..., :2], np.moveaxis(getattr(solution, name), 0, -1))
        assert not vectors[..., 2].any()
    for edges, centres in ((mesh.x, solution.x), (mesh.y, solution.y)):
        middles = 0.5 * (np.asarray(edges)[1:] + np.asarray(edges)[:-1])
        assert_close(middles, centres, rtol=0, atol=1e-12)


@pytest.mark.parametrize("kind", ["both coated, tilted", "line"])
def test_stresses_in_the_vtk_file_are_those_of_the_solution(kind: str, tmp_path: Path) -> None:
    solution = solved(kind)
    depths = [0.0, 2e-5, 4e-5, 5e-5, 8e-5]  # interfaces at 40 and 50 µm
    options: dict[str, Any] = {"body": "body", "displacement": True, "residual": {0: -1e9}}
    mesh = pyvista.read(solution.save(tmp_path / "a.vtr", depths=depths, **options))
    assert isinstance(mesh, pyvista.RectilinearGrid)
    np.testing.assert_array_equal(mesh.x, solution.x)
    np.testing.assert_array_equal(mesh.y, solution.y)
    np.testing.assert_array_equal(mesh.z, [0.0, 2e-5, 4e-5, 4e-5, 5e-5, 5e-5, 8e-5])
    shape = (*solution.pressure.shape, 7)

    def read(name: str) -> Any:
        return np.asarray(mesh.point_data[name]).reshape(shape, order="F")

    for name in ("pressure", "gap"):
        for plane in range(7):
            np.testing.assert_array_equal(read(name)[..., plane], getattr(solution, name))
    above = solution.stress(depths, side="above", **options)
    below = solution.stress(depths, **options)
    rows = [(below, 0), (below, 1), (above, 2), (below, 2), (above, 3), (below, 3), (below, 4)]
    for plane, (field, row) in enumerate(rows):
        for name in ("xx", "yy", "zz", "xy", "yz", "xz"):
            found = read(f"stress_{name}")[..., plane]
            np.testing.assert_array_equal(found, getattr(field, name)[row])
        np.testing.assert_array_equal(read("von_mises")[..., plane], field.von_mises[row])
        np.testing.assert_array_equal(read("max_shear")[..., plane], field.max_shear[row])
        np.testing.assert_array_equal(read("tension")[..., plane], field.principal[0][row])
    vectors = np.asarray(mesh.point_data["displacement"]).reshape((*shape, 3), order="F")
    for axis, name in enumerate(("ux", "uy", "uz")):
        np.testing.assert_array_equal(vectors[..., -1, axis], getattr(below, name)[-1])
    assert np.any(read("stress_xx")[..., 2] != read("stress_xx")[..., 3])


def test_on_a_rigid_base_the_vtk_file_ends_above_it(tmp_path: Path) -> None:
    body = nacre.HalfSpace(nacre.RIGID, [nacre.Layer(DLC, 1e-5), nacre.Layer(STEEL, 2e-5)])
    solution = nacre.solve(BALL, body, DLC, grid=GRID, load=10.0)
    bottom = body.interfaces[-1]
    mesh = pyvista.read(
        solution.save(tmp_path / "a.vtr", depths=[1e-5, bottom], friction=0.1, direction=(1.0, 0.0))
    )
    np.testing.assert_array_equal(mesh.z, [1e-5, 1e-5, bottom])
    found = np.asarray(mesh.point_data["stress_xz"]).reshape((*GRID.shape, 3), order="F")
    expected = solution.stress(bottom, side="above", friction=0.1, direction=(1.0, 0.0)).xz
    np.testing.assert_array_equal(found[..., -1], expected)
    path = solution.save(tmp_path / "b.vtr", depths=3e-5, body="counterbody")
    mesh = pyvista.read(path)
    found = np.asarray(mesh.point_data["von_mises"]).reshape(GRID.shape, order="F")
    np.testing.assert_array_equal(found, solution.stress(3e-5, body="counterbody").von_mises)


@pytest.mark.parametrize(
    ("name", "arguments", "kind", "message"),
    [
        ("a.nc", {"depths": [0.0]}, ValueError, r"must end in \.vtr where depths are given, got"),
        ("a.vtr", {"depths": []}, ValueError, r"depths must be at least one, .* got \[\]"),
        ("a.vtr", {"depths": [1e-6, 1e-6]}, ValueError, "depths must be at least one, each above"),
        ("a.vtr", {"depths": [-1e-6]}, ValueError, "z must be finite and at least 0"),
        ("a.vtr", {"depths": [float("nan")]}, ValueError, "z must be finite and at least 0"),
        ("a.vtr", {"depths": [0.0], "friction": -1.0}, ValueError, "friction must be at least 0"),
        ("a.vtr", {"depths": [0.0], "x": 0.0}, TypeError, "options must be among body, .* got x"),
        ("a.vtr", {"friction": 0.1}, TypeError, "'friction': without depths there are no options"),
        ("a.vtr", {"whole": True}, ValueError, r"must end in \.csv where whole is given, got"),
    ],
)
def test_wrong_depths_leave_no_file(
    name: str, arguments: dict[str, Any], kind: type[Exception], message: str, tmp_path: Path
) -> None:
    with pytest.raises(kind, match=message):
        solved("infinite gaps").save(tmp_path / name, **arguments)
    assert list(tmp_path.iterdir()) == []


def test_csv_holds_the_sections_through_the_peak(tmp_path: Path) -> None:
    solution = solved("both coated, tilted")
    with solution.save(tmp_path / "a.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    i, j = np.unravel_index(solution.pressure.argmax(), solution.pressure.shape)
    for along, section in (("x", solution.pressure[:, j]), ("y", solution.pressure[i])):
        read = [float(row["pressure [Pa]"]) for row in rows if row["along"] == along]
        assert read == section.tolist()  # repr of a float is exact
    assert {float(row["y [m]"]) for row in rows if row["along"] == "x"} == {solution.y[j]}


CELLS = ["both coated, tilted", "infinite gaps", "line", "slid", "rolled", "line slid"]


@pytest.mark.parametrize("kind", CELLS)
def test_csv_may_hold_every_cell_after_a_block_of_comments(kind: str, tmp_path: Path) -> None:
    solution = solved(kind)
    slides = kind in results.FRICTION
    path = solution.save(tmp_path / "a.csv", **({} if slides else {"whole": True}))
    lines = path.read_text(encoding="utf-8").splitlines()
    said = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    x, y = np.meshgrid(solution.x, solution.y, indexing="ij")
    expected = {"x [m]": x, "y [m]": y, "pressure [Pa]": solution.pressure}
    if slides:
        assert said["source"] == f"nacre {nacre.__version__}"
        slip = "" if kind == "rolled" else " [m]"
        expected["stick"] = solution.stick
        expected["gap [m]"] = solution.normal.gap
        expected["normal displacement [m]"] = solution.normal.displacement
        for n, axis in enumerate("xy"):
            expected[f"traction {axis} [Pa]"] = solution.traction[n]
            expected[f"displacement {axis} [m]"] = solution.displacement[n]
            expected[f"slip {axis}{slip}"] = solution.slip[n]
    else:
        expected |= {"gap [m]": solution.gap, "displacement [m]": solution.displacement}
        assert float(said[f"load [{'N/m' if kind == 'line' else 'N'}]"]) == solution.load
        assert float(said["peak pressure [Pa]"]) == solution.peak_pressure
        nx, ny = solution.pressure.shape
        assert said["cells"] == f"{nx} x {ny}, y varies fastest"
    rows = list(csv.DictReader(lines[len(said) :]))
    assert set(rows[0]) == set(expected)
    for name, field in expected.items():
        assert [float(row[name]) for row in rows] == field.ravel().tolist()


@pytest.mark.parametrize("ending", [".png", ".pdf", ".svg"])
def test_a_picture_is_saved_and_closed(ending: str, tmp_path: Path) -> None:
    from matplotlib import pyplot

    before = pyplot.get_fignums()
    content = solved("both coated, tilted").save(tmp_path / f"a{ending}").read_bytes()
    assert content.startswith({".png": b"\x89PNG", ".pdf": b"%PDF", ".svg": b"<?xml"}[ending])
    assert pyplot.get_fignums() == before


@pytest.mark.parametrize("name", ["a.txt", "a", "a.vtu"])
def test_another_ending_is_refused(name: str, tmp_path: Path) -> None:
    endings = r"\.nc, \.vtr, \.csv, \.png, \.pdf, \.svg, \.html"
    with pytest.raises(ValueError, match=f"path must end in {endings}, got"):
        solved("line").save(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kind", ["line", "slid"])
@pytest.mark.parametrize("ending", [".nc", ".vtr", ".csv", ".png"])
def test_a_failed_write_keeps_the_old_file_and_leaves_no_other(
    kind: str, ending: str, tmp_path: Path, monkeypatch: Patch
) -> None:
    path = tmp_path / f"a{ending}"
    path.write_text("old")

    def fail(*_: object) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr("os.replace", fail)
    with pytest.raises(OSError, match="no space"):
        solved(kind).save(path)
    assert path.read_text() == "old"
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


KILLED = """
import os, signal, sys
from pathlib import Path
from nacre._tools.disk import replacing

with replacing(Path(sys.argv[1])) as temporary:
    temporary.write_text("half")
    print(temporary, flush=True)
    if sys.argv[2:]:
        input()
    else:
        os.kill(os.getpid(), signal.SIGKILL)
"""
POSIX = pytest.mark.skipif(sys.platform == "win32", reason="modes, links and signals of POSIX")


@POSIX
@pytest.mark.parametrize("ending", [".nc", ".vtr", ".csv", ".png", ".html"])
def test_the_next_save_removes_what_a_kill_left(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"a{ending}"
    done = python("-c", KILLED, path)
    assert done.returncode == -signal.SIGKILL
    assert [file.name for file in tmp_path.iterdir()] == [f".a.nacre-tmp{ending}"]
    solved("line").save(path)
    assert list(tmp_path.iterdir()) == [path]
    assert b"nacre-tmp" not in path.read_bytes()


@POSIX
def test_two_saves_at_once_are_whole(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    asked = [sys.executable, "-c", KILLED, str(path), "waits"]
    pipe = subprocess.PIPE
    with subprocess.Popen(asked, stdin=pipe, stdout=pipe, text=True) as other:
        assert other.stdout is not None
        other.stdout.readline()
        solved("line").save(path)
        assert path.read_text().startswith("along")
        assert len(list(tmp_path.iterdir())) == 2
        other.communicate("\n")
    assert path.read_text() == "half"
    assert list(tmp_path.iterdir()) == [path]


@POSIX
def test_a_file_keeps_its_mode_and_a_link_its_target(tmp_path: Path) -> None:
    path, link = tmp_path / "a.csv", tmp_path / "b" / "link.csv"
    link.parent.mkdir()
    link.symlink_to(path)
    assert solved("line").save(link) == link
    assert path.stat().st_mode & 0o777 == 0o666 & ~umask()
    for mode in (0o640, 0o600, 0o444):
        path.write_text("old")
        path.chmod(mode)
        solved("line").save(link)
        assert link.readlink() == path
        assert path.stat().st_mode & 0o777 == mode
        assert path.read_text().startswith("along")
        path.chmod(0o600)
    assert list(link.parent.iterdir()) == [link]


def umask() -> int:
    """Return the bits that modes of new files lack."""
    os.umask(mask := os.umask(0))
    return mask


@POSIX
def test_what_others_put_in_the_way_is_not_written(tmp_path: Path) -> None:
    path, victim = tmp_path / "a.csv", tmp_path / "victim"
    victim.write_text("old")
    (tmp_path / ".a.nacre-tmp.csv").symlink_to(victim)
    solved("line").save(path)
    assert victim.read_text() == "old"
    assert path.read_text().startswith("along")


FULL = """
import os, resource, signal, sys
import nacre

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
solution = nacre.solve(
    nacre.Sphere(5e-3),
    nacre.Elastic(210e9, 0.3),
    load=5.0,
    grid=nacre.Grid((96, 96), (4e-4, 4e-4)),
)
import h5netcdf, matplotlib.pyplot, pyevtk, xarray
resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))  # as little room as on a full disk
for name, options in {
    "a.nc": {},
    "a.vtr": {},
    "b.vtr": {"depths": [0.0, 1e-5]},
    "a.csv": {"whole": True},
    "a.png": {},
}.items():
    try:
        solution.save(name, **options)
    except OSError as error:
        assert error.filename == os.path.realpath(name), error
        print(name, error.errno)
report = solution.report
case = {"shape": nacre.Sphere(5e-3), "body": report.body, "grid": report.grid}
try:
    nacre.sweep(case, {"load": [5.0]}, outputs=["pressure"], store="study.nc", progress=False)
except OSError as error:
    assert os.path.basename(error.filename) == "study.journal", error
    print("study", error.errno)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no limit of the size of a file")
def test_a_full_disk_is_an_error_and_the_process_goes_on(tmp_path: Path) -> None:
    done = python("-c", FULL, folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    names = [line.split()[0] for line in done.stdout.splitlines()]
    assert names == ["a.nc", "a.vtr", "b.vtr", "a.csv", "a.png", "study"]
    assert [path.name for path in tmp_path.iterdir()] == ["study.journal"]
    head = f"nacre {nacre.__version__}, journal of format 1\n"
    assert (tmp_path / "study.journal").read_text() == head


def rewritten(path: Path, **changes: Any) -> Path:
    """Write the dataset of a file to another one as nacre does, with something changed."""
    dataset = xarray.load_dataset(path, engine="h5netcdf")
    for name, value in changes.items():
        if name in dataset.variables:
            dataset[name] = dataset[name].copy(data=value)
        elif value is None:
            del dataset.attrs[name]
        else:
            dataset.attrs[name] = value
    resealed(dataset, path.with_name("changed.nc"))
    return path.with_name("changed.nc")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "fields"),
    [
        ("both coated, tilted", ("gap",)),
        ("cells, coupled", ("traction", "slip", "friction", "gap", "normal_displacement")),
    ],
)
def test_files_are_read_as_nacre_wrote_them_alone(
    kind: str, fields: tuple[str, ...], tmp_path: Path
) -> None:
    dataset = xarray.load_dataset(solved(kind).save(tmp_path / "a.nc"), engine="h5netcdf")
    path = tmp_path / "b.nc"
    dataset.to_netcdf(path, engine="h5netcdf")
    with pytest.raises(ValueError, match=r"b\.nc.*saved again by another program"):
        nacre.load(path)
    for field in fields:
        key = field.removeprefix("normal_")
        resealed(dataset.drop_vars(field), path)
        with pytest.raises(ValueError, match=rf'b\.nc.*the key "{key}" is missing'):
            nacre.load(path)
        dataset.assign({field: 2 * dataset[field]}).to_netcdf(path, engine="h5netcdf")
        with pytest.raises(ValueError, match=r"b\.nc.*changed, or saved again by another program"):
            nacre.load(path)
        resealed(dataset.assign({field: dataset[field].isel(x=0)}), path)
        with pytest.raises(ValueError, match=rf"b\.nc.*{key}"):
            nacre.load(path)
    resealed(dataset, path, support.STUDY)
    with pytest.raises(ValueError, match=r"b\.nc.*it is a study"):
        nacre.load(path)
    state = json.loads(dataset.attrs["nacre_solution"]) | {"format": 2, "nacre": "7.3.1"}
    resealed(dataset.assign_attrs(nacre_solution=json.dumps(state)), path)
    with pytest.raises(ValueError, match=r"b\.nc.* has format 2, written by nacre 7\.3\.1"):
        nacre.load(path)


@pytest.mark.parametrize("length", [0, 100, 5000])
def test_half_a_file_is_refused(length: int, tmp_path: Path) -> None:
    path = solved("slid").save(tmp_path / "a.nc")
    path.write_bytes(path.read_bytes()[:length])
    with pytest.raises(ValueError, match=r"a\.nc.*not that of a file of nacre: .*cut"):
        nacre.load(path)


def damaged(name: str, value: object) -> dict[str, Any]:
    """Return a change of one entry of the report in the state."""
    return {"report": {name: value}}


CHANGED: dict[str, dict[str, Any]] = {
    "pressure is not finite at": {"pressure": np.nan},
    "pressure must be at least 0, got -1": {"pressure": -1.0},
    "displacement is not finite at": {"displacement": np.inf},
    r"gap must be a number or \+inf, got -inf": {"gap": -np.inf},
    "nacre_solution must be a text, got .*3": {"nacre_solution": 3},
    "it is no result that nacre wrote: .*attribute": {"nacre_solution": None},
    "nacre_solution must hold named fields, got 'null'": {"nacre_solution": "null"},
    r"nacre_solution must hold named fields, got '\[\]'": {"nacre_solution": "[]"},
    "nacre_solution must hold JSON": {"nacre_solution": "[" * 100_000 + "]" * 100_000},
    "nacre_solution must hold JSON: Expecting": {"nacre_solution": "{"},
    "it has format None, written by nacre None": {"nacre_solution": "{}"},
    "it has format 0, written by nacre None": {"nacre_solution": '{"format": 0}'},
    'Solution: the key "nacre" is missing': {"nacre_solution": '{"format": 1}'},
    'value of the key "approach" does not fit: nan': {"state": {"approach": np.nan}},
    'value of the key "residual" does not fit: nan': {"state": damaged("residual", np.nan)},
    "seconds must be finite and at least 0, got -1": {"state": damaged("seconds", -1.0)},
    'value of the key "iterations" does not fit: invalid value: integer `-1`': {
        "state": damaged("iterations", -1)
    },
    'value of the key "balance" does not fit: .*inf': {
        "state": damaged("balance", {"force": np.inf, "moment": [0.0, 0.0]})
    },
    'value of the key "tolerance" does not fit': {"state": damaged("tolerance", 10**400)},
    'value of the key "body" does not fit': {"state": damaged("body", [])},
    "young must be finite and above 0": {
        "state": damaged("counterbody", {"Elastic": {"young": 10**400, "poisson": 0.3}})
    },
}


@pytest.mark.parametrize("message", CHANGED)
def test_a_damaged_file_is_refused_by_its_name(message: str, tmp_path: Path) -> None:
    solution = solved("both coated, tilted")
    path = solution.save(tmp_path / "a.nc")
    changes = dict(CHANGED[message])
    for name, value in changes.items():
        if isinstance(value, float):
            field = np.array(getattr(solution, name))
            field.flat[3] = value
            changes[name] = field
    if "state" in changes:
        state = json.loads(solution.to_xarray().attrs["nacre_solution"])
        for key, value in changes.pop("state").items():
            state[key] = state[key] | value if isinstance(value, dict) else value
        changes["nacre_solution"] = json.dumps(state)
    with pytest.raises(ValueError, match=f"changed.nc' must be a result .*{message}"):
        nacre.load(rewritten(path, **changes))


def test_what_is_no_solution_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"none\.nc"):
        nacre.load(tmp_path / "none.nc")
    (tmp_path / "text.nc").write_text("text")
    xarray.Dataset({"a": 1.0}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    for name in ("text.nc", "other.nc"):
        with pytest.raises(ValueError, match="must be a result that nacre saved"):
            nacre.load(tmp_path / name)


def test_digests_tell_arrays_apart() -> None:
    maps = [nacre.HeightMap(np.full((3, 3), h), 1e-6) for h in (0.0, np.nextafter(0, 1))]
    first, second = (values.encode(one, digest=True) for one in maps)
    assert first != second
    assert first == values.encode(maps[0], digest=True)


def test_what_is_no_value_is_refused() -> None:
    with pytest.raises(TypeError, match="is not a value that can be kept"):
        values.encode(object())


EXTRAS = [
    ("xarray", "files", "s.to_xarray()"),
    ("h5netcdf", "files", "s.save('a.nc')"),
    ("pyevtk", "files", "s.save('a.vtr')"),
    ("h5py", "files", "nacre.load('a.nc')"),
    ("xarray", "files", "nacre.sweep({}, {})"),
    ("matplotlib", "plot", "s.plot()"),
    ("pyvista", "view", "s.plot_3d(interactive=True)"),
    ("SurfaceTopography", "surfaces", "nacre.HeightMap.read(__file__)"),
    ("pydantic", "cli", "from nacre.case import Case"),
]
WITHOUT = f"""
import sys, nacre
s = nacre.solve(nacre.Sphere(5e-3), nacre.Elastic(210e9, 0.3), load=1.0)
for missing, _, call in {EXTRAS}:
    sys.modules[missing] = None
    try:
        exec(call)
    except ModuleNotFoundError as error:
        print(error)
    del sys.modules[missing]
"""


@pytest.mark.slow
def test_a_missing_extra_is_named(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(WITHOUT)
    assert python(script, folder=tmp_path).stdout.splitlines() == [
        f"this needs {missing}: pip install 'nacre-contact[{extra}]'"
        for missing, extra, _ in EXTRAS
    ]
    assert [path.name for path in tmp_path.iterdir()] == ["script.py"]
