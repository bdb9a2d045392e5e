"""One measurement, in a process of its own: ``python -m peers.worker JSON`` prints JSON.

A request holds `task`, "solve", "batch", "convolution" or "friction", `cells` and `threads`; to
solve also `problem`, `program`, `tolerance`, the file of `gaps`, and `seconds` for repetitions; for
a batch its `cases`, and for friction `program` and `seconds`.
"""

from __future__ import annotations

import gc
import json
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import nacre
from peers import friction
from peers.judge import Convolution, judge
from peers.problems import Problem
from peers.programs import PROGRAMS, Answer

REPETITIONS = 5


def memory(field: str) -> int:
    """Return a figure of this process [bytes]: VmRSS now, VmHWM at most; 0 where not known."""
    status = Path("/proc/self/status")
    if not status.exists():
        return 0
    lines = dict(line.split(":", 1) for line in status.read_text().splitlines())
    return int(lines[field].split()[0]) * 1024


def forget_peak() -> None:
    """Let the peak begin with what is in use now."""
    gc.collect()
    if (file := Path("/proc/self/clear_refs")).exists():
        file.write_text("5")


def solve(request: dict[str, Any]) -> dict[str, Any]:
    """Plan and solve; repeat while there is time, each time planned anew; judge the pressure."""
    problem = Problem(request["problem"], request["cells"])
    gaps = np.load(request["gaps"])
    program = PROGRAMS[request["program"]](problem, gaps, request["threads"])
    forget_peak()
    before, extra = memory("VmRSS"), 0
    plans: list[float] = []
    solves: list[float] = []
    processors: list[float] = []
    answer: Answer | None = None
    begin = time.perf_counter()
    while len(solves) < REPETITIONS and (
        not solves or time.perf_counter() - begin + plans[-1] + solves[-1] < request["seconds"]
    ):
        answer = read = None
        start = time.perf_counter()
        program.plan()
        planned, processor = time.perf_counter(), time.process_time()
        read = program.solve(request["tolerance"])
        end = time.perf_counter()
        processors.append((time.process_time() - processor) / (end - planned))
        answer = read()
        plans.append(planned - start + answer.planning)
        solves.append(end - planned - answer.planning)
        extra = extra or memory("VmHWM") - before
    if answer is None:
        raise RuntimeError("no repetition was made")
    taken = int(np.argmin(solves))
    together = [a + b for a, b in zip(plans, solves, strict=True)]
    result: dict[str, Any] = {
        "seconds": solves[taken],
        "planning": min(plans),
        "together": min(together),
        "bytes_per_cell": extra / gaps.size,
        "processors": processors[taken],
        "each": {
            "seconds": solves,
            "planning": plans,
            "together": together,
            "processors": processors,
        },
        "iterations": answer.iterations,
        "work": answer.work,
        "reported": answer.reported,
        "ended": answer.note,
    }
    if problem.eccentricity is None:
        result |= vars(judge(answer.pressure, gaps, problem.body, problem.grid, problem.load))
    else:
        result |= {"residual": answer.reported}
    return result


def batch(request: dict[str, Any]) -> dict[str, Any]:
    """Solve coated spheres under loads of half to one and a half that of `problems`.

    With one thread it is one `solve` after the other, and no solution is kept. The first time is
    not counted: memory that the system has never given to anybody is slow.
    """
    problem = Problem("coated", request["cells"])
    shape, threads = problem.shape(), request["threads"]
    loads = problem.load * np.linspace(0.5, 1.5, request["cases"])
    contact = nacre.Contact(problem.body, problem.grid, threads=threads)
    for _ in range(2):
        start = time.perf_counter()
        if threads == 1:
            worst = max(contact.solve(shape, load=load).report.residual for load in loads)
        else:
            solutions = contact.solve_many([{"shape": shape, "load": load} for load in loads])
            worst = max(solution.report.residual for solution in solutions)
            del solutions
        seconds = time.perf_counter() - start
    return {"each": {"seconds": [seconds], "together": [seconds]}, "residual": worst}


def convolution(request: dict[str, Any]) -> dict[str, Any]:
    """Time SciPy's convolution of random pressures; the first is not counted."""
    problem = Problem("hertz", request["cells"])
    coefficients = nacre.influence_coefficients(problem.body, problem.grid)
    convolve = Convolution(coefficients, workers=request["threads"])
    pressure = np.random.default_rng(0).random(coefficients.shape)
    times = []
    for _ in range(1 + REPETITIONS):
        start = time.perf_counter()
        convolve(pressure)
        times.append(time.perf_counter() - start)
    return {"seconds": min(times[1:])}


def main() -> None:
    """Answer the request."""
    request = json.loads(sys.argv[1])
    # A rough surface touches up to the edge of its map.
    warnings.simplefilter("ignore", nacre.NacreWarning)
    tasks = {
        "solve": solve,
        "batch": batch,
        "convolution": convolution,
        "friction": friction.measure,
    }
    result = tasks[request["task"]](request)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
