"""Starts workers, each in a process of its own, and keeps what they measured."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, Literal

import numpy as np

from peers.problems import TOLERANCE, Name, Problem

# Residuals aimed at, so that a program does hardly more than was asked, and hardly ever less.
AIM = 5e-9
LEAST = 2e-9
TRIES = 6
# Tightening and loosening are tried again only where that costs little [s].
CHEAP = 8.0
# Time grows so much, at the most, when the cells of a side are doubled.
GROWTH = 7.0
THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

Setting = Literal["", "idle", "shared", "busy"]
Request = dict[str, Any]
"""A request to a worker, as JSON."""
Times = dict[str, list[float]]
"""Seconds, planning, both together and processors in use, for each solve of one process."""
BESIDE: dict[Setting, str] = {
    "": "",
    "idle": "",
    "shared": ", two at once",
    "busy": ", beside one spinning process for each core",
}


class Failure(Exception):
    """A worker that took too long, or ended with an error."""


@dataclass
class Row:
    """One measurement; a field that was not measured is None, and `note` says why."""

    problem: str
    cells: int
    program: str
    threads: int
    seconds: float | None = None
    planning: float | None = None
    together: float | None = None
    residual: float | None = None
    overlap: float | None = None
    balance: float | None = None
    contact: float | None = None
    tolerance: float | None = None
    iterations: int | None = None
    work: float | None = None
    reported: float | None = None
    bytes_per_cell: float | None = None
    processors: float | None = None
    outside: float | None = None
    """Share of a solve of the sphere that is not transforms and products."""
    setting: Setting = ""
    """State of the machine in measurements that alternate with those they are compared with: idle,
    shared by two processes that do the same, or kept busy."""
    error: float | None = None
    """Relative standard error of the seconds, where these are a mean."""
    error_together: float | None = None
    """Relative standard error of planning and solving together, where these are a mean."""
    cases: int | None = None
    """Number of cases of a batch."""
    note: str = ""


@dataclass
class Bench:
    """Everything measured in one run."""

    folder: Path
    """Folder of the arrays that every program reads."""
    limit: float
    """Largest duration [s] of a measurement; a longer one is stopped, or not begun if foreseen."""
    rows: list[Row] = field(default_factory=list)
    load: float = field(default_factory=lambda: os.getloadavg()[0])
    """Load average of the machine before the run."""
    scales: dict[tuple[str, str], float] = field(default_factory=dict)
    """Residual over the program's own tolerance, by program and problem."""

    def solve(
        self,
        problem: Problem,
        program: str,
        threads: int,
        *,
        seconds: float = 10.0,
    ) -> Row:
        """Measure one solve, at the tolerance that gives the residual asked."""
        row = Row(problem.name, problem.cells, program, threads)
        self.rows.append(row)
        key = (program, problem.name)
        scale = self.scales.get(key, AIM / TOLERANCE)
        tolerance = TOLERANCE if program == "nacre" else AIM / scale
        request = self.request(problem, program, threads, seconds)
        for _ in range(TRIES):
            try:
                found = self.work(request | {"tolerance": tolerance})
            except Failure as failure:
                row.note = row.note if row.seconds else str(failure)
                break
            residual = found["residual"]
            # Of those that meet the tolerance the fastest counts.
            met = residual <= TOLERANCE
            if (
                row.residual is None
                or row.residual > TOLERANCE
                or (met and found["seconds"] < (row.seconds or np.inf))
            ):
                keep(row, found, tolerance)
                row.note = found["ended"]
            if program == "nacre" or residual == 0:
                break
            self.scales[key] = residual / tolerance
            cheap = found["together"] < CHEAP
            if met and not (cheap and residual < LEAST):
                break
            tolerance *= AIM / residual
        if row.residual is not None and row.residual > TOLERANCE:
            row.note = f"residual {row.residual:.1e} is the best it reached"
        show(row)
        return row

    def request(self, problem: Problem, program: str, threads: int, seconds: float) -> Request:
        """Return what a worker is asked for, but for the tolerance."""
        return {
            "task": "solve",
            "problem": problem.name,
            "cells": problem.cells,
            "program": program,
            "threads": threads,
            "gaps": str(self.gaps(problem)),
            "seconds": seconds,
        }

    def in_turn(self, turns: int, asked: Iterable[tuple[Row, Request]]) -> None:
        """Measure what is compared with itself in turn, each so many times in a process of its own.

        So whatever else goes on meets all alike. The mean over the processes counts: on a busy
        machine one that has a core to itself by luck, which one thread has more often than two,
        takes half the time of one that has not; and cores of a virtual machine are not always as
        fast.
        """
        asked = list(asked)
        by_process: list[list[Times]] = [[] for _ in asked]
        for _ in range(turns):
            for (row, request), processes in zip(asked, by_process, strict=True):
                at_once = 2 if row.setting == "shared" else 1
                # Spinning processes are started afresh: where these run is part of the luck.
                spinning = busy_machine() if row.setting == "busy" else nullcontext()
                with spinning, ThreadPoolExecutor(at_once) as pool:
                    try:
                        for found in pool.map(self.work, [request] * at_once):
                            keep(row, found, TOLERANCE)
                            processes.append(found["each"])
                    except Failure as failure:
                        row.note = str(failure)
        for (row, _), processes in zip(asked, by_process, strict=True):
            if len(processes) < 2:
                row.seconds = row.together = None
            else:
                means = mean(processes)
                for name, (value, _) in means.items():
                    setattr(row, name, value)
                row.error, row.error_together = means["seconds"][1], means["together"][1]
                fastest = min(min(process["seconds"]) for process in processes)
                row.note = f"mean of {len(processes)} processes, ± {row.error:.1%}"
                row.note += BESIDE[row.setting]
                row.note += f"; the fastest {fastest:.3g} s"
                if row.cases is not None and row.seconds is not None:
                    row.note += f"; {row.cases / row.seconds:.0f} solves a second"
            self.rows.append(row)
            show(row)

    def solves(self, problem: Problem, threads: int, setting: Setting) -> tuple[Row, Request]:
        """Return what `in_turn` is asked for solves of nacre's."""
        row = Row(problem.name, problem.cells, "nacre", threads, setting=setting)
        return row, self.request(problem, "nacre", threads, 3.0) | {"tolerance": TOLERANCE}

    def batch(self, cells: int, cases: int, threads: int) -> tuple[Row, Request]:
        """Return the same of many coated spheres: one after the other, or side by side."""
        row = Row("batch", cells, "nacre", threads, setting="idle", cases=cases)
        return row, {"task": "batch", "cells": cells, "threads": threads, "cases": cases}

    def sweep(
        self, name: Name, program: str, threads: int, sizes: list[int], *, soft: float
    ) -> None:
        """Measure one program on finer and finer grids, while the time expected is allowed.

        Up to 1024 cells that is the limit; above, the softer `soft`.
        """
        last: Row | None = None
        for cells in sizes:
            allowed = self.limit if cells <= 1024 else soft
            if last is not None:
                doublings = np.log2(cells / last.cells)
                expected = (last.together or np.inf) * GROWTH**doublings
                if last.seconds is None or expected > allowed:
                    row = Row(name, cells, program, threads)
                    row.note = f"left out: expected to take {expected:.0f} s, allowed {allowed:g} s"
                    if last.seconds is None:
                        row.note = "left out: a coarser grid failed"
                    self.rows.append(row)
                    show(row)
                    continue
            last = self.solve(Problem(name, cells), program, threads)

    def friction(self, program: str, sizes: list[int]) -> None:
        """Measure a ball that is pulled, on one thread, until a grid takes too long."""
        for cells in sizes:
            row = Row("friction", cells, program, 1, tolerance=TOLERANCE)
            self.rows.append(row)
            request = {"task": "friction", "program": program, "cells": cells, "threads": 1}
            try:
                keep(row, self.work(request | {"seconds": 10.0}), TOLERANCE)
            except Failure as failure:
                row.note = str(failure)
            show(row)
            if row.seconds is None:
                break

    def gaps(self, problem: Problem) -> Path:
        """Return the file of the undeformed gap, which every program reads."""
        file = self.folder / f"{problem.name}_{problem.cells}.npy"
        if not file.exists():
            np.save(file, problem.gaps())
        return file

    def work(self, request: Request) -> dict[str, Any]:
        """Return what a worker measured.

        Raises
        ------
        Failure
            Where it took too long, or ended with an error.
        """
        environment = os.environ | dict.fromkeys(THREAD_VARIABLES, str(request["threads"]))
        environment["PYTHONPATH"] = str(Path(__file__).parents[1])
        command = [sys.executable, "-m", "peers.worker", json.dumps(request)]
        try:
            done = subprocess.run(
                command, env=environment, capture_output=True, text=True, timeout=self.limit
            )
        except subprocess.TimeoutExpired as error:
            raise Failure(f"given up after {self.limit:g} s") from error
        if done.returncode != 0:
            lines = done.stderr.strip().splitlines() or [f"ended with {done.returncode}"]
            raise Failure(f"failed: {lines[-1][:120]}")
        result: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
        return result

    def find(
        self, problem: str, cells: int, program: str, threads: int, setting: Setting = ""
    ) -> Row | None:
        """Return the first measurement of that."""
        sought = (problem, cells, program, threads, setting)
        for row in self.rows:
            found = (row.problem, row.cells, row.program, row.threads, row.setting)
            if found == sought and row.seconds is not None:
                return row
        return None

    def convolutions(self, binary: Path | None, cells: int, threads: int) -> None:
        """Time one convolution, SciPy's and nacre's in turn; of each the best of 5 × 5."""
        ours = Row("convolution", cells, "nacre", threads)
        theirs = Row("convolution", cells, "SciPy", threads)
        request = {"task": "convolution", "cells": cells, "threads": threads}
        solves: list[tuple[float, float]] = []
        for _ in range(REPETITIONS):
            try:
                theirs.seconds = min(theirs.seconds or np.inf, self.work(request)["seconds"])
            except Failure as failure:
                theirs.note = str(failure)
            if binary is None:
                ours.note = "left out: no binary of benches/convolution.rs"
                continue
            command = [str(binary), str(cells), str(threads)]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            found = json.loads(done.stdout)
            ours.seconds = min(ours.seconds or np.inf, found["seconds"])
            solves.append((found["solve"], found["outside"]))
            ours.outside = min(solves)[1]
        for row in (theirs, ours):
            self.rows.append(row)
            show(row)


REPETITIONS = 5
"""Processes for one convolution."""


def mean(processes: list[Times]) -> dict[str, tuple[float, float]]:
    """Return the mean of each figure over several processes, and its relative standard error."""
    means = {}
    for name in processes[0]:
        each = np.array([np.mean(process[name]) for process in processes])
        means[name] = (each.mean(), each.std(ddof=1) / np.sqrt(each.size) / each.mean())
    return means


@contextmanager
def busy_machine() -> Iterator[None]:
    """Keep every core busy with a process that spins."""
    command = [sys.executable, "-c", "while True: pass"]
    spinners = [subprocess.Popen(command) for _ in range(os.cpu_count() or 1)]
    try:
        yield
    finally:
        for spinner in spinners:
            spinner.kill()
            spinner.wait()


def keep(row: Row, found: dict[str, Any], tolerance: float) -> None:
    """Write what a worker measured into its row."""
    names = {f.name for f in fields(Row)}
    for name, value in found.items():
        if name in names:
            setattr(row, name, value)
    row.tolerance = tolerance


def show(row: Row) -> None:
    """Print a row as it is finished."""
    title = f"{row.problem:12} {row.cells:5} {row.program:17} {row.threads} thr"
    if row.seconds is None:
        print(f"{title}  {row.note}", flush=True)
        return
    extra = "" if row.residual is None else f"  residual {row.residual:.1e}"
    planning = "" if row.planning is None else f"  planning {row.planning:8.4f} s"
    print(f"{title}  {row.seconds:9.4f} s{planning}{extra}  {row.note}", flush=True)
