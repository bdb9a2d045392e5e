"""Studies on a cluster of Dask with a store: killed workers, a killed client, a lost cluster."""

from __future__ import annotations

import importlib
import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import CancelledError, Executor, Future
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import xarray

import nacre
from bodies import BALL, STEEL
from support import HANG, Patch

CASE = {"shape": BALL, "body": STEEL, "grid": nacre.Grid((48, 48), (1.5e-4, 1.5e-4))}
CLUSTER: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": ":0"}
FRAGILE, FATAL = 3.0, 9.0
"""Loads [N] of the cases that kill their first worker, and each worker."""
HELD = 5.0
"""Load [N] from which on cases do not end where the environment has HELD."""

# Workers import it. Each case that begins is a line of the log beside it.
MODULE = f"""
import os, signal, threading, time
from pathlib import Path
from types import SimpleNamespace

FOLDER = Path(__file__).parent

def logged(solution):
    load = solution.report.motion["load"]
    with (FOLDER / "cases.log").open("a") as log:
        log.write(f"{{load}}\\n")
    return load

def fragile(solution):
    load = logged(solution)
    first = (FOLDER / "cases.log").read_text().split().count(str(load)) == 1
    if load == {FATAL} or (load == {FRAGILE} and first):
        os.kill(os.getpid(), signal.SIGKILL)
    return load

def held(solution):
    load = logged(solution)
    if "HELD" in os.environ and load >= {HELD}:
        threading.Event().wait()
    return load
"""

CLIENT = f"""
import cases, nacre
from distributed import Client, LocalCluster

if __name__ == "__main__":
    case = {{"shape": nacre.Sphere(5e-3), "body": nacre.Elastic(210e9, 0.3)}}
    case["grid"] = nacre.Grid((48, 48), (1.5e-4, 1.5e-4))
    with LocalCluster(**{CLUSTER}) as cluster, Client(cluster) as client:
        nacre.sweep(
            case,
            {{"load": [float(load) for load in range(1, 10)]}},
            outputs=[cases.held, "approach"],
            store="study.nc",
            executor=client.get_executor(),
        )
"""


def begun(folder: Path) -> list[float]:
    """Return the loads of the cases that workers have begun, in order."""
    log = folder / "cases.log"
    return [float(line) for line in log.read_text().split()] if log.exists() else []


def kept(folder: Path) -> list[float]:
    """Return the loads of the cases in the journal, also while it is written."""
    journal = folder / "study.journal"
    lines = journal.read_bytes().splitlines(keepends=True)[1:] if journal.exists() else []
    records = [json.loads(line.partition(b" ")[2]) for line in lines if line.endswith(b"\n")]
    return [record["parameters"]["load"] for record in records]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")
def test_a_killed_worker_costs_no_case_but_the_one_that_kills_all(
    tmp_path: Path, monkeypatch: Patch
) -> None:
    distributed = pytest.importorskip("distributed")
    (tmp_path / "cases.py").write_text(MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "cases", raising=False)
    outputs = ["peak_pressure", importlib.import_module("cases").fragile]
    loads = {"load": [1.0, 2.0, FRAGILE, 4.0, 5.0, 6.0]}
    options: dict[str, Any] = {"outputs": outputs, "store": tmp_path / "study.nc"}
    with (
        importlib.import_module("dask").config.set({"distributed.scheduler.allowed-failures": 1}),
        distributed.LocalCluster(**CLUSTER) as cluster,
        distributed.Client(cluster) as client,
    ):
        options["executor"] = client.get_executor()
        first = nacre.sweep(CASE, loads, **options)
        assert (first.error == "").all()
        assert Counter(begun(tmp_path))[FRAGILE] >= 2
        loads["load"].append(FATAL)
        with pytest.warns(nacre.NacreWarning, match="1 of 7 cases failed"):
            study = nacre.sweep(CASE, loads, **options)
    del options["executor"]
    *finished, failed = study.error.values
    assert finished == [""] * 6
    assert failed.startswith("KilledWorker: Attempted to run task")
    assert "all those workers died" in failed
    expected = nacre.sweep(CASE, {"load": loads["load"][:6]}, outputs=["peak_pressure"])
    assert (study.peak_pressure[:6] == expected.peak_pressure).all()
    assert study.peak_pressure.isnull().values.tolist() == [False] * 6 + [True]
    assert sorted(kept(tmp_path)) == loads["load"]
    # Each case is in the store: the same call, here without a cluster, begins none.
    cases = len(begun(tmp_path))
    with pytest.warns(nacre.NacreWarning, match="1 of 7 cases failed"):
        assert nacre.sweep(CASE, loads, **options).identical(study)
    assert len(begun(tmp_path)) == cases


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")
def test_a_killed_client_leaves_its_cases_in_the_store_and_no_process(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    (tmp_path / "cases.py").write_text(MODULE)
    (tmp_path / "client.py").write_text(CLIENT)
    command, held = [sys.executable, "client.py"], os.environ | {"HELD": "1"}
    pipe = subprocess.PIPE
    with subprocess.Popen(command, cwd=tmp_path, env=held, stdout=pipe, stderr=pipe) as process:
        # Both workers hold, and all cases before are kept: nothing changes any more.
        while len(set(begun(tmp_path))) < 6 or len(kept(tmp_path)) < 4:
            assert process.poll() is None, process.communicate()
            time.sleep(0.02)
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=HANG)  # until its workers, which have the pipes, have ended
    assert process.returncode == -signal.SIGKILL
    assert sorted(kept(tmp_path)) == [1.0, 2.0, 3.0, 4.0]
    assert not (tmp_path / "study.nc").exists()
    before = len(begun(tmp_path))
    subprocess.run(command, cwd=tmp_path, check=True, timeout=HANG)
    assert set(begun(tmp_path)[before:]) == {5.0, 6.0, 7.0, 8.0, 9.0}  # and no other again
    study = xarray.load_dataset(tmp_path / "study.nc", engine="h5netcdf")
    loads = [float(load) for load in range(1, 10)]
    assert study.held.values.tolist() == study["load"].values.tolist() == loads
    assert (
        study.approach == nacre.sweep(CASE, {"load": loads}, outputs=["approach"]).approach
    ).all()


class Lost(Executor):
    """A cluster that is lost after some cases."""

    def __init__(self, cases: int) -> None:
        self.cases = cases

    def submit(self, function: Any, /, *arguments: Any, **keywords: Any) -> Future[Any]:
        future: Future[Any] = Future()
        if self.cases > 0:
            self.cases -= 1
            future.set_result(function(*arguments, **keywords))
        else:
            future.cancel()
            future.set_running_or_notify_cancel()
        return future


@pytest.mark.parametrize("cases", [0, 2])
def test_a_lost_cluster_is_a_sentence_and_finished_cases_are_kept(
    cases: int, tmp_path: Path
) -> None:
    options: dict[str, Any] = {"outputs": ["approach"], "store": tmp_path / "study.nc"}
    loads = {"load": [1.0, 2.0, 3.0]}
    with pytest.raises(CancelledError, match="with a store, the same call solves what is not"):
        nacre.sweep(CASE, loads, executor=Lost(cases), **options)
    assert kept(tmp_path) == loads["load"][:cases]
    study = nacre.sweep(CASE, loads, executor=Lost(3 - cases), **options)  # just enough
    assert study.identical(nacre.sweep(CASE, loads, outputs=["approach"]))


class Deadly(Executor):
    """A cluster of which each worker dies that solves the first case."""

    def __init__(self) -> None:
        self.error: Exception | None = importlib.import_module("distributed").KilledWorker(
            "case", SimpleNamespace(address="tcp://a"), 3
        )

    def submit(self, function: Any, /, *arguments: Any, **keywords: Any) -> Future[Any]:
        future: Future[Any] = Future()
        if self.error is not None:
            future.set_exception(self.error)
            self.error = None
        else:
            future.set_result(function(*arguments, **keywords))
        return future


def test_the_other_cases_go_on_where_all_workers_of_a_case_have_died() -> None:
    pytest.importorskip("distributed")
    loads = {"load": [1.0, 2.0, 3.0]}
    with pytest.warns(nacre.NacreWarning, match="1 of 3 cases failed"):
        study = nacre.sweep(CASE, loads, outputs=["approach"], executor=Deadly())
    assert study.error[0].item().startswith("KilledWorker: ")
    expected = nacre.sweep(CASE, {"load": [2.0, 3.0]}, outputs=["approach"])
    assert study[{"load": [1, 2]}].approach.identical(expected.approach)
