"""A study gives the same Dataset wherever it runs, and survives kills and failures."""

from __future__ import annotations

import importlib
import itertools
import json
import math
import multiprocessing
import os
import random
import re
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import nacre
from bodies import BALL, ROD, STEEL, coated, quiet
from nacre import design
from nacre._tools import disk, threads
from nacre.bearing import CylindricalRoller
from support import Capture, Patch, assert_close, python, taken

Output = str | Callable[[Any], Any]
GRID = nacre.Grid((24, 20), (2e-4, 2e-4))


def ball(thickness: float, young: float, load: float = 10.0) -> dict[str, Any]:
    return {"shape": BALL, "body": coated(young, thickness), "grid": GRID, "load": load}


THICKNESS, YOUNG = [5e-6, 2e-5, 4e-5], [105e9, 420e9]
PARAMETERS = {"thickness": THICKNESS, "young": YOUNG}
ONE = {"thickness": [1e-5], "young": [1e11]}
MAPPED = {"shape": BALL, "body": coated(1e11, 1e-5), "grid": GRID, "load": 20.0}
BEARING = CylindricalRoller(count=14, diameter=1e-2, length=1e-2, pitch_diameter=65e-3)


def mean_pressure(solution: nacre.Solution) -> float:
    return solution.load / solution.contact_area


OUTPUTS: list[Output] = ["peak_pressure", "tilt", "contact_extent", mean_pressure, "pressure"]

# Other processes import functions by name: from here, in a file of its own.
# `logged` waits for ever from its LAST different case on, and sends Ctrl-C at case INTERRUPTED.
MODULE = """
import os, signal, threading
from pathlib import Path

def fatal(solution):
    return os._exit(1) if solution.load > 2.5 else 0.0

def mean_pressure(solution):
    return solution.load / solution.contact_area

def logged(solution):
    path = Path(__file__).with_suffix(".log")
    with path.open("a") as log:
        log.write(f"{solution.report.motion['load']}\\n")
    cases = len(set(path.read_text().split()))
    if cases >= float(os.environ.get("LAST", "inf")):
        threading.Event().wait()
    if cases == int(os.environ.get("INTERRUPTED", "0")):
        signal.raise_signal(signal.SIGINT)
    return solution.peak_pressure
"""


def journaled(journal: Path) -> list[dict[str, Any]]:
    """Return the records of a journal, also while it is written or after a kill."""
    lines = journal.read_bytes().splitlines(keepends=True)[1:] if journal.exists() else []
    return [json.loads(line.partition(b" ")[2]) for line in lines if line.endswith(b"\n")]


def bits(dataset: xarray.Dataset) -> dict[str, bytes]:
    return {str(name): dataset[name].values.tobytes() for name in dataset.variables}


def test_each_case_is_the_solve_it_describes() -> None:
    study = nacre.sweep(ball, PARAMETERS, outputs=OUTPUTS)
    assert dict(study.peak_pressure.sizes) == {"thickness": 3, "young": 2}
    for thickness in THICKNESS:
        for young in YOUNG:
            one = study.sel(thickness=thickness, young=young)
            solution = nacre.solve(**ball(thickness, young))
            assert float(one.peak_pressure) == solution.peak_pressure
            assert tuple(one.tilt.values) == solution.tilt
            assert one.contact_extent.values.tolist() == [list(e) for e in solution.contact_extent]
            assert float(one.mean_pressure) == mean_pressure(solution)
            assert one.pressure.values.tobytes() == solution.pressure.tobytes()
    assert (study.error == "").all()


@pytest.mark.parametrize(
    "parameters",
    [
        {"bearing.clearance": [1e-5, 2e-5]},  # None in the case
        {"bearing.count": [12, 14], "bearing.diameter": [9e-3, 1e-2]},
        {"bearing.pitch_diameter": [40e-3], "bearing.diameter": [6e-3]},  # no room for 14 of 10 mm
        {"bearing.inner.young": [100e9, 210e9], "bearing.raceway_crown[0]": [50.0]},
    ],
)
def test_numbers_in_a_bearing_are_its_own_fields(parameters: dict[str, list[Any]]) -> None:
    asked: dict[str, Any] = {"force": (6000.0, 0.0, None), "model": "iso16281"}
    study = quiet(nacre.sweep, {"bearing": BEARING, **asked}, parameters, outputs=["loads"])
    for values in itertools.product(*parameters.values()):
        given = {name.split(".")[1]: v for name, v in zip(parameters, values, strict=True)}
        if "raceway_crown[0]" in given:
            given["raceway_crown"] = (given.pop("raceway_crown[0]"), None)
            given["inner"] = nacre.Elastic(given["inner"], 0.3)
        one = study.sel(dict(zip(parameters, values, strict=True)))
        expected = quiet(replace(BEARING, **given).solve, **asked).loads
        assert one.error.item() == ""
        assert one.loads.values[: len(expected)].tolist() == expected.tolist()


def test_a_path_that_some_cases_have_fails_only_in_the_others() -> None:
    bodies = {"bare": STEEL, "coated": coated(1e11, 1e-5)}
    study = quiet(nacre.sweep, MAPPED, {"body": bodies, "body.layers[0].thickness": [2e-5]})
    assert study.error.sel(body="coated").item() == ""
    assert "body.layers[0].thickness" in study.error.sel(body="bare").item()


def shear_of_summary(solution: nacre.Solution) -> float:
    return solution.stress_summary(friction=0.2, direction=(1.0, 0.0)).interfaces[0].shear[0]


STRESSES = [
    "von_mises",
    "tension",
    "max_shear",
    "coating_tension",
    "interface_shear",
    "interface_tension",
]


@pytest.mark.filterwarnings("ignore:2 of 2 cases have warnings")
def test_stresses_are_outputs_by_name_and_by_function(tmp_path: Path) -> None:
    outputs: list[Output] = [*STRESSES, shear_of_summary]
    case = {"thickness": [2e-5], "young": YOUNG}
    store = tmp_path / "study.nc"
    study = nacre.sweep(
        ball, case, outputs=outputs, stress={"friction": 0.2, "direction": (1, 0)}, store=store
    )
    for young in YOUNG:
        one = study.sel(thickness=2e-5, young=young)
        summary = nacre.solve(**ball(2e-5, young)).stress_summary(
            friction=0.2, direction=(1.0, 0.0)
        )
        (coating, substrate), (interface,) = summary.layers, summary.interfaces
        assert one.von_mises == max(coating.von_mises[0], substrate.von_mises[0])
        assert one.tension == max(coating.tension[0], substrate.tension[0])
        assert one.max_shear == max(coating.max_shear[0], substrate.max_shear[0])
        assert one.coating_tension == coating.tension[0]
        assert one.interface_shear == one.shear_of_summary == interface.shear[0]
        assert one.interface_tension == interface.tension[0]
    assert {study[name].attrs["units"] for name in STRESSES} == {"Pa"}
    # Without friction they are others, and not what the journal holds.
    other = nacre.sweep(ball, case, outputs=outputs, store=store)
    assert (other.shear_of_summary == study.shear_of_summary).all()
    assert (other.interface_shear < study.interface_shear).all()


@pytest.mark.filterwarnings("ignore:.* unresolved")  # few cells below the ball
def test_friction_without_a_direction_is_refused_before_a_solve() -> None:
    message = "direction must be given where friction is above 0"
    oval = nacre.Paraboloid(5e-3, 4e-3)
    with pytest.warns(nacre.NacreWarning):
        study = nacre.sweep(
            lambda **parameters: ball(**parameters) | {"shape": oval},
            {"thickness": [2e-5], "young": YOUNG},
            outputs=["tension"],
            stress={"friction": 0.2},
        )
    assert all(message in str(error) for error in study.error.values.ravel())
    ways: list[tuple[nacre.types.Shape, dict[str, Any]]] = [(oval, {}), (BALL, {"tilt": (1e-3, 0)})]
    for shape, tilt in ways:
        with pytest.raises(ValueError, match=message):
            design.coating_chart(
                shape, STEEL, thickness=[2e-5], young=YOUNG, friction=0.2, load=1.0, **tilt
            )
    # Below a ball friction acts along x.
    study = nacre.sweep(ball, ONE, outputs=["coating_tension"], stress={"friction": 0.2})
    along = {"friction": 0.2, "direction": (1, 0)}
    same = nacre.sweep(ball, ONE, outputs=["coating_tension"], stress=along)
    assert study.coating_tension.item() == same.coating_tension.item()
    # A cylinder has a rolling direction.
    grid = nacre.Grid.line(96, 1.2e-4)
    chart = design.coating_chart(
        ROD,
        STEEL,
        thickness=[2e-5],
        young=[420e9],
        friction=0.2,
        grid=grid,
        load=1e4,
    )
    solution = nacre.solve(ROD, coated(420e9, 2e-5), grid=grid, load=1e4)
    summary = solution.stress_summary(friction=0.2, direction=(0, 1))
    assert chart.coating_tension.item() == summary.layers[0].tension[0]


def test_a_bare_body_has_no_stress_in_a_coating() -> None:
    study = nacre.sweep(
        {"shape": BALL, "body": STEEL, "grid": GRID},
        {"load": [5.0]},
        outputs=STRESSES,
    )
    missing = [name for name in STRESSES if np.isnan(study[name].item())]
    assert missing == ["coating_tension", "interface_shear", "interface_tension"]
    assert study.error.item() == ""


@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")  # fork, Python 3.12
@pytest.mark.filterwarnings("ignore:os.fork:RuntimeWarning")  # JAX, which other tests have begun
@pytest.mark.parametrize("kind", ["one thread", "fork", "forkserver", "spawn", "dask"])
def test_the_executor_changes_no_bit(kind: str, tmp_path: Path, monkeypatch: Patch) -> None:
    if kind not in ("one thread", "dask", *multiprocessing.get_all_start_methods()):
        pytest.skip(f"no {kind} here")
    name = f"study_on_{kind.replace(' ', '_')}"
    (tmp_path / f"{name}.py").write_text(MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    outputs: list[Output] = [
        "peak_pressure",
        "pressure",
        importlib.import_module(name).mean_pressure,
    ]
    expected = nacre.sweep(ball, PARAMETERS, outputs=outputs)
    with ExitStack() as stack:
        executor: Executor
        if kind == "dask":
            from distributed import Client, LocalCluster

            cluster = stack.enter_context(
                LocalCluster(  # type: ignore[no-untyped-call]
                    n_workers=2, threads_per_worker=1, dashboard_address=":0"
                )
            )
            client = stack.enter_context(Client(cluster))  # type: ignore[no-untyped-call]
            executor = stack.enter_context(client.get_executor())
        elif kind == "one thread":
            executor = stack.enter_context(ThreadPoolExecutor(1))
        else:
            context = multiprocessing.get_context(kind)
            executor = stack.enter_context(ProcessPoolExecutor(2, mp_context=context))
        study = nacre.sweep(ball, PARAMETERS, outputs=outputs, executor=executor)
    assert study.identical(expected)
    assert bits(study) == bits(expected)


@pytest.mark.slow
def test_a_study_on_dask_keeps_its_store_and_goes_on(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    store = tmp_path / "study.nc"
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=":0"
        ) as cluster,
        distributed.Client(cluster) as client,
        client.get_executor() as executor,
    ):
        options: Any = {"store": store, "executor": executor}
        nacre.sweep(ball, PARAMETERS | {"young": YOUNG[:1]}, **options)
        assert disk.is_study(store)
        assert len(journaled(store.with_suffix(".journal"))) == 3
        study = nacre.sweep(ball, PARAMETERS, **options)
        assert len(journaled(store.with_suffix(".journal"))) == 6  # none is solved again
        solution = nacre.solve(**ball(THICKNESS[0], YOUNG[0]))
        solution.save(tmp_path / "solution.nc")
    assert nacre.load(tmp_path / "solution.nc") == solution
    assert study.identical(nacre.sweep(ball, PARAMETERS))
    assert xarray.load_dataset(store).identical(study)


def test_where_no_thread_can_be_started_no_bit_changes(monkeypatch: Patch) -> None:
    def refused(_: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")  # what Python says in a browser

    def solved() -> tuple[Any, Any]:
        study = nacre.sweep(ball, PARAMETERS, outputs=["peak_pressure", "pressure"])
        return study, quiet(BEARING.solve, force=(1e3, 0.0, None), cells=(40, 24)).loads

    study, loads = solved()
    monkeypatch.setitem(sys.modules, "ipykernel", threads)  # as in a notebook, where bars are shown
    monkeypatch.setattr("nacre._tools.progress.SOON", 0.0)
    monkeypatch.setattr(threads, "CAN_START", False)
    monkeypatch.setattr(threading.Thread, "start", refused)
    alone, alone_loads = solved()
    assert alone.identical(study)
    assert bits(alone) == bits(study)
    assert np.array_equal(alone_loads, loads)


def test_parameters_that_share_a_dimension_vary_together() -> None:
    pairs = {
        "thickness": xarray.DataArray(THICKNESS, dims="coating", coords={"coating": list("abc")}),
        "young": xarray.DataArray([1e11, 2e11, 3e11], dims="coating"),
        "load": [5, 10],
    }
    study = nacre.sweep(ball, pairs)
    assert dict(study.approach.sizes) == {"coating": 3, "load": 2}
    one = study.sel(coating="b", load=10)
    assert (float(one.thickness), float(one.young)) == (THICKNESS[1], 2e11)
    assert float(one.peak_pressure) == nacre.solve(**ball(THICKNESS[1], 2e11, 10)).peak_pressure


@pytest.mark.filterwarnings("ignore:.* cases have warnings")  # few cells under the small sphere
def test_shapes_and_pairs_are_parameters_with_labels() -> None:
    shapes = {"small": nacre.Sphere(1e-3), "large": BALL}
    tilts = [(None, None), (1e-4, None)]
    case = {"body": STEEL, "load": 5.0, "grid": GRID}
    study = nacre.sweep(case, {"shape": shapes, "tilt": tilts}, outputs=["peak_pressure"])
    assert study["shape"].values.tolist() == ["small", "large"]
    assert study["tilt"].values.tolist() == ["(None, None)", "(0.0001, None)"]
    expected = nacre.solve(shapes["large"], STEEL, load=5.0, grid=GRID, tilt=(1e-4, None))
    found = study.peak_pressure.sel(shape="large", tilt="(0.0001, None)")
    assert float(found) == expected.peak_pressure


def test_each_solve_has_one_thread_unless_the_case_says_otherwise(
    monkeypatch: Patch,
) -> None:
    asked = []

    def solve(**arguments: Any) -> nacre.Solution:
        asked.append(arguments["threads"])
        return nacre.solve(**arguments)

    monkeypatch.setattr("nacre.studies.solve", solve)
    nacre.sweep(ball, {"thickness": [1e-5], "young": YOUNG})
    assert asked == [1, 1]
    nacre.sweep(lambda load: ball(1e-5, 1e11, load) | {"threads": 2}, {"load": [5.0]})
    assert asked == [1, 1, 2]


def test_a_failure_is_recorded_and_stops_nothing(tmp_path: Path) -> None:
    def fails(solution: nacre.Solution) -> float:
        return math.sqrt(solution.approach - limit)

    limit = 0.0
    parameters = {"thickness": [1e-5, -1.0], "young": [1e11], "load": [5.0, 0.0, 10.0]}
    store = tmp_path / "study.nc"
    with pytest.warns(nacre.NacreWarning, match="4 of 6 cases failed"):
        study = nacre.sweep(ball, parameters, store=store)
    errors = study.error.sel(young=1e11)
    assert "thickness must be finite and above 0" in str(errors.sel(thickness=-1.0, load=5).item())
    assert "load must be finite and above 0" in str(errors.sel(thickness=1e-5, load=0).item())
    assert (np.isnan(study.peak_pressure) == (study.error != "")).all()
    one = study.peak_pressure.sel(thickness=1e-5, load=10).item()
    assert one == nacre.solve(**ball(1e-5, 1e11, 10)).peak_pressure
    assert xarray.load_dataset(store, engine="h5netcdf").identical(study)

    limit = 1.0
    with pytest.warns(nacre.NacreWarning, match="1 of 1 cases failed"):
        study = nacre.sweep(ball, ONE, outputs=[fails, "tilt"])
    assert "math domain error" in str(study.error.item())
    assert np.isnan(study.fails).all()
    assert study.tilt.sizes["axis"] == 2


def test_a_failure_beside_a_warning_stops_nothing() -> None:
    parameters = {"thickness": [1e-5], "young": [1e11], "load": [0.0, 3e2]}
    with (
        pytest.warns(nacre.NacreWarning, match="1 of 2 cases failed"),
        pytest.warns(nacre.NacreWarning, match=r"1 of 2 cases have warnings: grid edge \(1\)"),
    ):
        study = nacre.sweep(ball, parameters)
    assert (study.error != "").values.ravel().tolist() == [True, False]


def test_warnings_of_the_cases_are_in_the_dataset_and_counted_by_kind(tmp_path: Path) -> None:
    parameters = {"thickness": [1e-5], "young": [1e11], "load": [5.0, 1e-3, 3e2, 4e2]}
    store = tmp_path / "study.nc"
    counted = r"^3 of 4 cases have warnings: grid edge \(2\), coarse \(1\); see warnings in the"
    with pytest.warns(nacre.NacreWarning, match=counted):
        study = nacre.sweep(ball, parameters, store=store)
    found = ["edge of the grid" in text for text in study.warnings.values.ravel()]
    assert found == [False, False, True, True]
    with pytest.warns(nacre.NacreWarning, match=counted):  # from the journal
        nacre.sweep(ball, parameters, store=store)


def test_estimated_errors_stand_beside_their_quantities() -> None:
    grid = nacre.Grid((64, 64), (2e-4, 2e-4))
    case: dict[str, Any] = {"shape": BALL, "body": STEEL, "grid": grid}
    study = nacre.sweep(case, {"load": [5.0, 10.0]}, outputs={"peak": "peak_pressure"})
    assert study.peak_discretisation.attrs["units"] == "Pa"
    for load in (5.0, 10.0):
        estimates = nacre.solve(**case, load=load).report.discretisation
        assert estimates is not None
        one = study.peak_discretisation.sel(load=load).item()
        assert one == estimates["peak_pressure"]
        assert one > 0
    # Without a coarser grid there is no estimate, and a user's own output of that name stays.
    few = nacre.sweep(
        {**case, "grid": GRID, "algorithm": "polonsky-keer"},
        {"load": [5.0]},
        outputs={"approach": "approach", "load_discretisation": "load"},
    )
    assert np.isnan(few.approach_discretisation.item())
    assert few.load_discretisation.item() == pytest.approx(5.0)


def count_solves(monkeypatch: Patch) -> list[None]:
    solves: list[None] = []

    def solve(**arguments: Any) -> nacre.Solution:
        solves.append(None)
        return nacre.solve(**arguments)

    monkeypatch.setattr("nacre.studies.solve", solve)
    return solves


def test_what_is_finished_is_not_repeated(tmp_path: Path, monkeypatch: Patch) -> None:
    solves = count_solves(monkeypatch)
    store = tmp_path / "study.nc"
    first = nacre.sweep(ball, PARAMETERS, store=store)
    assert len(solves) == 6
    assert nacre.sweep(ball, PARAMETERS, store=store).identical(first)
    assert len(solves) == 6
    nacre.sweep(ball, PARAMETERS | {"young": [*YOUNG, 1e12]}, store=store)
    assert len(solves) == 9  # only those that are new
    nacre.sweep(ball, PARAMETERS, store=store, outputs=["contact_area"])
    assert len(solves) == 15  # another question
    nacre.sweep(ball, {"thickness": [1e-6, 1e-6], "young": [1e11]})
    assert len(solves) == 16  # the same case twice in one study


def test_what_cannot_be_compared_is_solved_again_or_has_a_version(
    tmp_path: Path, monkeypatch: Patch
) -> None:
    solves = count_solves(monkeypatch)
    factors = (factor for factor in (1.0, 2.0, 3.0, 4.0))  # a generator: nothing can look into it

    def scaled(solution: nacre.Solution) -> float:
        return solution.load * next(factors)

    def found(version: str | None = None) -> float:
        case = ONE
        store = tmp_path / "study.nc"
        study = nacre.sweep(ball, case, outputs=[scaled], store=store, version=version)
        return float(round(study.scaled.item() / 10.0, 6))

    message = r"cannot be compared with an earlier run: scaled\.factors \(a generator\); all cases"
    for expected in (1.0, 2.0):
        with pytest.warns(nacre.NacreWarning, match=message):
            assert found() == expected
    assert found("first") == found("first") == 3.0
    assert found("second") == 4.0
    assert len(solves) == 4
    with pytest.raises(TypeError, match=r"version must be a text or an integer, got 1\.5"):
        nacre.sweep(ball, PARAMETERS, version=1.5)  # type: ignore[arg-type]


CHANGES = {
    "text": ("def f(s): return s.load", "load", "approach"),
    "text of a lambda": ("f = lambda s: s.load", "load", "approach"),
    "text of a method": ("class A:\n def m(self, s): return 1\nf = A().m", "1", "2"),
    "text of a call": ("class A:\n def __call__(self, s): return 1\nf = A()", "1", "2"),
    "default": ("def g(k):\n def f(s, k=[k]): return k\n return f\nf = g(1)", "g(1)", "g(2)"),
    "keyword": ("def g(k):\n def f(s, *, k=k): return k\n return f\nf = g(1)", "g(1)", "g(2)"),
    "closure": ("def g(k):\n def f(s): return k\n return f\nf = g(1)", "g(1)", "g(2)"),
    "type": ("def g(k):\n def f(s): return k\n return f\nf = g(1)", "g(1)", "g(1.0)"),
    "set": ("def g(k):\n return lambda s: k\nf = g({'a', 'b'})", "'b'", "'c'"),
    "array": ("import numpy\ndef g(k):\n return lambda s: k\nf = g(numpy.ones(3))", "3", "4"),
    "long array": (  # whose repr leaves out the middle
        "import numpy\nw = numpy.ones(5000)\nw[2500] = 1.5\ndef g(k):\n return lambda s: k.sum()\n"
        "f = g(w)",
        "1.5",
        "2.5",
    ),
    "function": ("def g(k):\n return lambda s: k(s)\nf = g(lambda s: s + 1)", "+ 1", "+ 2"),
    "object": (
        "class A:\n def m(self, s): return self.k\na = A()\na.k = 1\nf = a.m",
        "k = 1",
        "k = 2",
    ),
    "partial": (
        "from functools import partial\ndef g(s, k): return k\nf = partial(g, k=1)",
        "k=1",
        "k=2",
    ),
    "cache": ("from functools import cache\n@cache\ndef f(s): return 1", "return 1", "return 2"),
    "decorated": (
        "from functools import wraps\ndef w(k):\n def d(g):\n  @wraps(g)\n  def h(s): return k\n"
        "  return h\n return d\n@w(1)\ndef f(s): return 0",
        "w(1)",
        "w(2)",
    ),
    "nested": ("def g(k):\n return lambda s: k[0]['a']\nf = g([{'a': 1}])", "1", "2"),
    "itself": ("def g(k):\n def f(s): return f(s) + k\n return f\nf = g(1)", "g(1)", "g(2)"),
}


UNKNOWN = {
    "f.k (a generator)": "def g(k):\n return lambda s: next(k)\nf = g(k for k in [1])",
    "f.k (a lock)": "import threading\ndef g(k):\n return lambda s: k\nf = g(threading.Lock())",
    "f.k['a'] (has no source text)": (
        "def g(k):\n return lambda s: k\nf = g({'a': eval('lambda s: 1')})"
    ),
    "f (has no source text)": "f = eval('lambda s: 1')",
}


QUESTIONS = """
import importlib, sys, warnings
import nacre

warnings.simplefilter("always")
case = {"shape": nacre.Sphere(5e-3), "body": nacre.Elastic(2e11, 0.3)}
case["grid"] = nacre.Grid((8, 8), (2e-4, 2e-4))
for name in sys.argv[1:]:
    f = importlib.import_module(name).f
    nacre.sweep(case, {"load": [9.0]}, outputs={"f": f}, store=f"{name}.nc", progress=False)
"""


def asked(folder: Path, sources: Iterable[str], seed: int) -> tuple[list[int], str]:
    """Return how many cases studies with the functions `f` of modules have kept, and warnings.

    They run in another process, and each study has its store.
    """
    names = []
    for number, source in enumerate(sources):
        names.append(f"user{number}")
        (folder / f"user{number}.py").write_text(source)
    environment = os.environ | {"PYTHONHASHSEED": str(seed), "PYTHONDONTWRITEBYTECODE": "1"}
    done = python("-c", QUESTIONS, *names, folder=folder, env=environment)
    assert done.returncode == 0, done.stderr
    return [len(journaled(folder / f"{name}.journal")) for name in names], done.stderr


def test_a_changed_function_is_another_one_and_the_same_is_so_in_every_process(
    tmp_path: Path,
) -> None:
    sources = [source for source, _, _ in CHANGES.values()]
    changed = [source.replace(old, new) for source, old, new in CHANGES.values()]
    assert all(source.count(old) == 1 for source, old, _ in CHANGES.values())
    for these, seed, kept in ((sources, 1, 1), (sources, 2, 1), (changed, 1, 2)):
        found, warned = asked(tmp_path, these, seed)
        assert dict(zip(CHANGES, found, strict=True)) == dict.fromkeys(CHANGES, kept)
        assert "cannot be compared" not in warned


def test_what_a_function_hides_is_known_to_be_unknown(tmp_path: Path) -> None:
    _, warned = asked(tmp_path, UNKNOWN.values(), 1)
    for reason in UNKNOWN:
        assert f"cannot be compared with an earlier run: {reason}; all cases" in warned


def test_a_log_gets_a_line_now_and_then(
    tmp_path: Path, capsys: Capture, monkeypatch: Patch
) -> None:
    for name in ("FORCE_COLOR", "TTY_COMPATIBLE"):
        monkeypatch.delenv(name, raising=False)  # Rich would take any stream for a terminal
    store = tmp_path / "study.nc"
    nacre.sweep(ball, {"thickness": [5e-6], "young": YOUNG}, store=store)
    assert capsys.readouterr().err == ""  # nothing in the first minute
    nacre.sweep(ball, PARAMETERS, store=store, progress=True)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "nacre.sweep: 2 of 6 cases (2 of 6 found in the store)"
    assert lines[-1].startswith("nacre.sweep: 6 of 6 cases (2 of 6 found in the store), 0:00:0")
    assert len(lines) == 2
    with monkeypatch.context() as patch:  # a clock on which each look is a minute later
        now, minutes = time.monotonic(), itertools.count(0, 60)
        patch.setattr("time.monotonic", lambda: now + next(minutes))
        nacre.sweep(ball, PARAMETERS, outputs=["load"])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 7  # one for each case, and the last
    assert re.match(r"nacre.sweep: 3 of 6 cases, 0:\d\d:00 so far, about .* left", lines[2])
    nacre.sweep(ball, PARAMETERS, progress=False)
    assert capsys.readouterr().err == ""


def test_failed_cases_are_tried_again_when_asked(tmp_path: Path, monkeypatch: Patch) -> None:
    store, case = tmp_path / "study.nc", ONE

    def exhausted(**_: object) -> None:
        raise MemoryError("no room")

    with monkeypatch.context() as patch:
        patch.setattr("nacre.studies.solve", exhausted)
        with pytest.warns(nacre.NacreWarning, match="1 of 1"):
            nacre.sweep(ball, case, store=store)
    with pytest.warns(nacre.NacreWarning, match="1 of 1"):
        assert "no room" in str(nacre.sweep(ball, case, store=store).error.item())
    assert nacre.sweep(ball, case, store=store, retry=True).error.item() == ""
    assert nacre.sweep(ball, case, store=store).error.item() == ""


def test_a_line_cut_short_is_dropped_and_a_damaged_one_is_refused(
    tmp_path: Path, monkeypatch: Patch
) -> None:
    store, journal = tmp_path / "study.nc", tmp_path / "study.journal"
    expected = nacre.sweep(ball, PARAMETERS, store=store)
    whole = journal.read_bytes()
    solves = count_solves(monkeypatch)
    for cut in (1, 2, 60):
        journal.write_bytes(whole[:-cut])
        assert nacre.sweep(ball, PARAMETERS, store=store).identical(expected)
        assert len(solves) == 1
        solves.clear()
        assert len(journaled(journal)) == 6
    journal.write_bytes(whole.replace(b"values", b"valves", 1))
    with pytest.raises(ValueError, match="is no journal of a study: line 2: it was changed"):
        nacre.sweep(ball, PARAMETERS, store=store)
    journal.write_bytes(b"{" + whole)
    with pytest.raises(ValueError, match="is no journal of a study: line 1"):
        nacre.sweep(ball, PARAMETERS, store=store)


def test_only_a_study_is_continued_or_replaced(tmp_path: Path) -> None:
    one = ONE
    store, journal = tmp_path / "study.nc", tmp_path / "study.journal"
    saved = nacre.solve(BALL, STEEL, load=1.0).save(store)
    for content in (saved.read_bytes(), b"", b"a text"):
        store.write_bytes(content)
        with pytest.raises(ValueError, match="store must be a new file or a study, got"):
            nacre.sweep(ball, one, store=store)
        assert store.read_bytes() == content
        assert not journal.exists()
    store.unlink()
    study = nacre.sweep(ball, one, store=store)
    study.to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    with pytest.raises(ValueError, match="store must be"):
        nacre.sweep(ball, one, store=tmp_path / "other.nc")
    with pytest.raises(ValueError, match="it is a study"):
        nacre.load(store)


@pytest.mark.parametrize(
    "content",
    [
        *(b"{", b"{}", b'{"a": 1}', b'{"key": "a", "values": 3}\n', b"[]", b"\n", b"no journal"),
        *(b"nacre is a word\n", b"nacre 0.1.0, journal of format x\n"),
        *(b"nacre 0.1, jou", b"\xff\n"),
    ],
)
def test_a_foreign_file_is_no_journal_and_stays_as_it_is(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "study.journal"
    path.write_bytes(content)
    with pytest.raises(ValueError, match="is no journal of a study: line 1"):
        nacre.sweep(ball, ONE, store=tmp_path / "study.nc")
    assert path.read_bytes() == content


def test_a_newer_journal_is_refused_by_the_version_that_wrote_it(tmp_path: Path) -> None:
    store, path = tmp_path / "study.nc", tmp_path / "study.journal"
    path.write_bytes(b"nacre ")  # the first line may have been cut there
    nacre.sweep(ball, ONE, store=store)
    head, record = path.read_text().splitlines()
    assert head == f"nacre {nacre.__version__}, journal of format 1"
    assert len(record.partition(" ")[0]) == 16
    newer = f"nacre 7.3.1, journal of format 2\n{record}\n"
    path.write_text(newer)
    with pytest.raises(ValueError, match=r"has format 2, written by nacre 7\.3\.1"):
        nacre.sweep(ball, ONE, store=store)
    assert path.read_text() == newer


def test_a_journal_on_a_full_disk_stays_whole(tmp_path: Path, monkeypatch: Patch) -> None:
    store, journal = tmp_path / "study.nc", tmp_path / "study.journal"
    nacre.sweep(ball, ONE, store=store)
    before = journal.read_bytes()

    def fail(*_: object) -> None:
        raise OSError("no space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("os.fsync", fail)
        with pytest.raises(OSError, match="no space"):
            nacre.sweep(ball, PARAMETERS, store=store)
    assert journal.read_bytes() == before
    nacre.sweep(ball, PARAMETERS, store=store)
    assert journal.read_bytes().startswith(before)
    assert len(journaled(journal)) == 1 + 6


KILLED = """
import sys
import nacre, cases

def ball(load):
    steel = nacre.Elastic(210e9, 0.3)
    body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(1e11, 0.3), 1e-5)])
    grid = nacre.Grid((24, 20), (2e-4, 2e-4))
    return dict(shape=nacre.Sphere(5e-3), body=body, grid=grid, load=load)

parameters = {"load": [5 + 0.01 * k for k in range(int(sys.argv[1]))]}
nacre.sweep(ball, parameters, outputs=[cases.logged, "approach"], store="study.nc")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")
def test_a_killed_study_loses_no_case_and_repeats_none(tmp_path: Path) -> None:
    count, kills = 110, 2
    (tmp_path / "cases.py").write_text(MODULE)
    (tmp_path / "script.py").write_text(KILLED)
    store, journal, log = (tmp_path / name for name in ("study.nc", "study.journal", "cases.log"))
    command = [sys.executable, "script.py", str(count)]

    def finished() -> list[str]:
        return [record["key"] for record in journaled(journal)]

    rng = random.Random(7)
    kept: list[str] = []
    for kill in range(kills):
        target = len(kept) + rng.randint(5, 45)
        # It waits for the kill at the end, and so cannot end before it on any machine.
        with subprocess.Popen(command, cwd=tmp_path, env=os.environ | {"LAST": "100"}) as process:
            while process.poll() is None and len(finished()) < target:
                time.sleep(1e-4)
            time.sleep(0.003 * rng.random())
            process.send_signal(signal.SIGKILL)
        assert process.returncode == -signal.SIGKILL, f"it ended before kill {kill}"
        assert finished()[: len(kept)] == kept  # none lost
        kept = finished()
        assert not store.exists()
    subprocess.run(command, cwd=tmp_path, check=True)

    assert len(finished()) == len(set(finished())) == count  # none twice
    assert finished()[: len(kept)] == kept
    # Solved again is only what a kill interrupted: at most one case for each thread.
    solved = Counter(log.read_text().split())
    assert len(solved) == count
    assert sum(solved.values()) - count <= kills * (os.cpu_count() or 1)
    study = xarray.load_dataset(store, engine="h5netcdf")
    assert (study.error == "").all()
    for load in (5.0, 5.5, 6.09):
        one = study.sel(load=load, method="nearest")
        expected = nacre.solve(**ball(1e-5, 1e11, one["load"].item()))
        assert one.logged.item() == expected.peak_pressure


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one process")
def test_ctrl_c_stops_a_study_and_keeps_what_is_finished(tmp_path: Path) -> None:
    (tmp_path / "cases.py").write_text(MODULE)
    (tmp_path / "script.py").write_text(KILLED)
    journal = tmp_path / "study.journal"
    environment = os.environ | {"INTERRUPTED": "10"}
    run = python("script.py", "5000", folder=tmp_path, env=environment)
    assert run.stderr.splitlines()[-1] == "KeyboardInterrupt"
    records = journaled(journal)
    assert 0 < len(records) < 5000
    assert not any("error" in record for record in records)
    # What was being solved was finished and kept: nothing that was logged is missing.
    assert len(records) == len((tmp_path / "cases.log").read_text().splitlines())


@pytest.mark.skipif(sys.platform == "win32", reason="the lock is another there")
def test_two_processes_do_not_write_one_study(tmp_path: Path) -> None:
    hold = """
import sys, nacre
steel, ball = nacre.Elastic(210e9, 0.3), nacre.Sphere(5e-3)
wait = lambda solution: len((print("held", flush=True) or sys.stdin.read()))
case = {"shape": ball, "body": steel}
nacre.sweep(case, {"load": [1.0]}, outputs={"wait": wait}, store="study.nc", progress=False)
"""
    store, pipe = tmp_path / "study.nc", subprocess.PIPE
    command = [sys.executable, "-c", hold]
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, cwd=tmp_path) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"held\n"
        with pytest.raises(BlockingIOError, match=taken(store, process.pid, "study")):
            nacre.sweep(ball, PARAMETERS, store=store)
        process.communicate()
    assert nacre.sweep(ball, PARAMETERS, store=store).error.size == 6


def test_two_threads_do_not_write_one_study(tmp_path: Path, monkeypatch: Patch) -> None:
    """The store may have another name there; the one that is refused takes no lock away."""
    store, refusals = tmp_path / "study.nc", []
    monkeypatch.chdir(tmp_path)

    def other(solution: nacre.Solution) -> float:
        try:
            nacre.sweep(ball, PARAMETERS, store="study.nc")
        except BlockingIOError as error:
            refusals.append(str(error))
        writes = f"import nacre; nacre.sweep({{}}, {{'load': [1.0]}}, store={str(store)!r})"
        refusals.append(python("-c", writes).stderr.splitlines()[-1])
        return solution.load

    nacre.sweep(ball, ONE, outputs=[other], store=store, progress=False)
    assert refusals[0] == ("store 'study.nc' is being written: this process is running this study")
    assert re.search(taken(store, os.getpid(), "study"), refusals[1])
    assert nacre.sweep(ball, PARAMETERS, store=store).error.size == 6


def test_a_broken_executor_is_an_error_and_finished_cases_are_kept(
    tmp_path: Path, monkeypatch: Patch
) -> None:
    (tmp_path / "study_that_breaks.py").write_text(MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    fatal = importlib.import_module("study_that_breaks").fatal
    parameters = {"thickness": [1e-5], "young": [1e11], "load": [1.0, 2.0, 3.0, 4.0]}
    with (
        ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor,
        pytest.raises(BrokenProcessPool),
    ):
        nacre.sweep(
            ball, parameters, outputs=[fatal], store=tmp_path / "study.nc", executor=executor
        )
    records = journaled(tmp_path / "study.journal")
    assert [record["parameters"]["load"] for record in records] == [1.0, 2.0]
    assert not any("error" in record for record in records)


@pytest.mark.parametrize(
    ("arguments", "options", "kind", "message"),
    [
        ((ball, {"thickness": 1.0}), {}, TypeError, "thickness must be a sequence"),
        ((ball, {"thickness": "ab"}), {}, TypeError, "thickness must be a sequence"),
        ((ball, {"thickness": []}), {}, ValueError, "thickness must have at least one value"),
        ((ball, PARAMETERS), {"outputs": ["peak"]}, ValueError, "outputs must be attributes"),
        ((ball, PARAMETERS), {"outputs": []}, ValueError, "outputs must be at least one"),
        ((ball, PARAMETERS), {"outputs": ["load", "load"]}, ValueError, "different names"),
        ((ball, PARAMETERS), {"outputs": "load"}, TypeError, "outputs must be a sequence"),
        ((ball, PARAMETERS), {"outputs": {"error": "load"}}, ValueError, "other names"),
        ((ball, PARAMETERS), {"outputs": {"young": "load"}}, ValueError, "other names"),
        ((ball, PARAMETERS), {"store": "study.txt"}, ValueError, r"store must end in \.nc"),
        ((ball, {"thick": [1.0]}), {}, TypeError, "thick"),
        (
            (ball, PARAMETERS),
            {"outputs": ["tension"], "stress": {"mu": 1}},
            TypeError,
            "stress must",
        ),
        ((lambda load: BALL, {"load": [1.0]}), {}, TypeError, "case must return the arguments"),
        (({"body": STEEL}, {"force": [1.0]}), {}, TypeError, "case must give arguments .*force"),
        (({"progress": print}, {"load": [1.0]}), {}, TypeError, "is not a value that can be kept"),
        ((MAPPED, {"shape.radus": [1e-3]}), {}, ValueError, "no radus; the nearest are shape.rad"),
        ((MAPPED, {"body.layers[1].thickness": [1e-6]}), {}, ValueError, r"are body\.layers\[0\]"),
        ((MAPPED, {"shap.radius": [1e-3]}), {}, ValueError, "the nearest are shape.radius"),
        (
            ({"bearing": BEARING}, {"bearing.clearence": [1e-5]}),
            {},
            ValueError,
            r"no clearence; the nearest are bearing\.clearance",
        ),
        ((ball, ONE), {"store": "nodir/x.nc"}, FileNotFoundError, "^'nodir' is not a folder$"),
    ],
)
def test_bad_input_is_refused_before_anything_is_solved(
    arguments: tuple[Any, ...], options: dict[str, Any], kind: type[Exception], message: str
) -> None:
    with pytest.raises(kind, match=message):
        nacre.sweep(*arguments, **options)


def test_a_force_table_is_the_solves_and_its_stiffness_the_slope() -> None:
    step = 1e-9
    options: dict[str, Any] = {"grid": GRID, "tolerance": 1e-12}
    approaches = [6e-7 - step, 6e-7, 6e-7 + step]
    slopes = [-step / 1e-4, 0.0, step / 1e-4]
    table = design.force_table(BALL, STEEL, approaches, tilt_x=slopes, progress=False, **options)
    here = dict(approach=1, tilt_x=1, tilt_y=0)
    solution = nacre.solve(BALL, STEEL, approach=6e-7, tilt=(0.0, 0.0), **options)
    assert table["load"][here].item() == solution.load
    assert table.stiffness[here].values.tolist() == solution.stiffness().tolist()
    # No cell joins or leaves: what is left is rounding over the step, 1e-12 · 6e-7 / 1e-9.
    along = table["load"].differentiate("approach")[here].item()
    expected = table.stiffness.sel(row="load", column="approach")[here].item()
    assert along == pytest.approx(expected, rel=1e-7)
    turned = table.moment.sel(axis="x").differentiate("tilt_x")[here].item()
    expected = table.stiffness.sel(row="moment x", column="tilt x")[here].item()
    assert turned == pytest.approx(expected, rel=1e-7)
    assert table.approach.units == "m"


def test_the_load_curve_of_a_sphere_is_that_of_hertz() -> None:
    curve = design.load_curve(BALL, STEEL, [1.0, 10.0, 100.0])
    radius = (0.75 * curve["load"] * 5e-3 / STEEL.plane_strain_modulus) ** (1 / 3)
    # Discretisation with 64 cells over the contact: approach 1e-3, stiffness follows the area of
    # whole cells, 3e-3.
    assert_close(curve.approach, radius**2 / 5e-3, rtol=2e-3, each=True)
    hertz = 2 * STEEL.plane_strain_modulus * radius
    assert_close(curve.stiffness, hertz, rtol=5e-3, each=True)
    # And it is the slope of the curve: a difference quotient of the same discrete contact.
    near = design.load_curve(BALL, STEEL, [9.99, 10.01], grid=GRID)
    slope = float(near["load"].diff("load")[0] / near.approach.diff("load")[0])
    mean = float(near.stiffness.mean())
    # The contact gains cells one by one, each of 1/n of the stiffness of n cells: below 5e-3.
    assert slope == pytest.approx(mean, rel=5e-3)


def test_a_coating_of_the_substrates_modulus_changes_nothing_in_the_chart() -> None:
    with pytest.warns(nacre.NacreWarning, match="5 of 6 cases have warnings: unresolved stress"):
        chart = design.coating_chart(
            BALL,
            STEEL,
            thickness=[1e-6, 1e-4],
            young=[105e9, 210e9, 420e9],
            load=10.0,
            grid=GRID,
            refine=None,
        )
    bare = nacre.solve(BALL, STEEL, load=10.0, grid=GRID)
    same = chart.peak_pressure.sel(young=210e9)
    assert_close(same, bare.peak_pressure, rtol=1e-6)  # tolerance of the solver, 1e-8
    assert (chart.peak_pressure.diff("young") > 0).all()
    assert chart.peak_pressure.attrs["units"] == "Pa"
    assert chart["thickness"].attrs["units"] == "m"


@pytest.mark.filterwarnings("ignore:.*(uncertain|unresolved)")
@pytest.mark.parametrize(
    "options",
    [{"hardness": 0.5e9}, {"grid": nacre.Grid((32, 32), (4e-4, 4e-4), periodic=(True, True))}],
    ids=["hardness", "periodic"],
)
def test_contacts_that_cannot_be_refined_have_their_chart(options: dict[str, Any]) -> None:
    lists: dict[str, Any] = {"thickness": [3e-6], "young": [300e9]}
    charts = [
        design.coating_chart(BALL, STEEL, load=10.0, refine=refine, **lists, **options)
        for refine in (0.2, None)
    ]
    assert np.isfinite(charts[0].coating_tension).all()
    assert charts[0].equals(charts[1])


@pytest.mark.filterwarnings("ignore:.*(uncertain|unresolved)")
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_the_stresses_of_the_chart_are_those_of_the_summary(friction: float) -> None:
    # Compliant and stiff, thin and thick: the largest tension is at the edge of the contact, or
    # below its middle at the interface.
    thickness, young = [1e-5, 1e-4], [52.5e9, 840e9][friction > 0 :]
    options: dict[str, Any] = {"grid": GRID, "load": 10.0}
    chart = design.coating_chart(
        BALL,
        STEEL,
        thickness=thickness,
        young=young,
        friction=friction,
        direction=(1.0, 0.0),
        **options,
    )
    depths = set()
    for h in thickness:
        for modulus in young:
            summary = nacre.solve(**ball(h, modulus)).stress_summary(
                friction=friction, direction=(1.0, 0.0), refine=0.2
            )
            one = chart.sel(thickness=h, young=modulus)
            tension, (_, _, z) = summary.layers[0].tension
            depths.add(round(z / h, 9))
            assert one.coating_tension.item() == pytest.approx(tension, rel=1e-12)
            assert one.interface_shear.item() == pytest.approx(
                summary.interfaces[0].shear[0], rel=1e-12
            )
    assert depths == ({0.0, 1.0} if friction == 0 else {0.0})  # behind what slides
    assert chart.coating_tension.attrs["units"] == chart.interface_shear.attrs["units"] == "Pa"


def test_the_tilt_curve_is_odd_and_inverts_the_eccentricity() -> None:
    roller = nacre.Roller(5e-3, 8e-3, 2.0)
    grid = nacre.Grid((128, 24), (16e-3, 3e-4))
    curve = design.tilt_curve(roller, STEEL, [-3e-5, 0.0, 3e-5], load=1e3, grid=grid)
    moment = curve.moment.sel(axis="x").values
    # Symmetric to the tolerance of the solver, 1e-8, against W times half the side.
    assert abs(moment[1]) < 1e-6 * 1e3 * 8e-3
    assert moment[2] == pytest.approx(-moment[0], rel=1e-6)
    solution = nacre.solve(
        roller, STEEL, load=1e3, eccentricity=(float(moment[2]) / 1e3, None), grid=grid
    )
    assert solution.tilt[0] == pytest.approx(3e-5, rel=1e-5)


def test_an_unknown_option_of_a_helper_is_refused() -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'force', which neither"):
        design.load_curve(BALL, STEEL, [1.0], force=3)


def test_a_case_that_is_no_case_is_named() -> None:
    with pytest.raises(TypeError, match="case must be callable or a mapping of arguments, got 3"):
        nacre.sweep(3, PARAMETERS)  # type: ignore[arg-type]
