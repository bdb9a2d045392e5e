"""Runs everything, in an environment that has the programs: ``python -m peers.run``.

``python -m peers`` (`make peers`) makes that environment first.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from importlib.metadata import PackageNotFoundError
from pathlib import Path

from peers import report
from peers.figures import all_figures
from peers.friction import PLANS
from peers.measure import Bench
from peers.problems import Problem
from peers.programs import PROGRAMS, release

ROOT = Path(__file__).parents[2]
SIZES = [256, 512, 1024, 2048]
FRICTION_SIZES = [64, 128, 256]
TURNS = 64
"""Processes of each of what is measured in turn."""


def options() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog="make peers", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="256² and 512² alone, in four minutes")
    parser.add_argument("--full", action="store_true", help="all up to 2048², in hours")
    parser.add_argument("--sizes", help="cells along a side, such as 256,512")
    parser.add_argument("--programs", default=",".join(PROGRAMS), help="those to compare")
    parser.add_argument("--limit", type=float, default=400.0, help="seconds for one measurement")
    parser.add_argument("--out", type=Path, help="folder of peers.md, peers.csv and peers.png")
    parser.add_argument("--work", type=Path, default=ROOT / "target" / "peers", help="scratch")
    parser.add_argument("--convolution", type=Path, help="binary of benches/convolution.rs")
    return parser.parse_args()


def available(names: list[str]) -> list[str]:
    """Return the programs that are installed, and say which are not."""
    found = []
    for name in names:
        try:
            print(f"{name} {release(name)}", flush=True)
            found.append(name)
        except PackageNotFoundError:
            print(f"{name} is not installed: left out", flush=True)
    return found


def compare(bench: Bench, programs: list[str], sizes: list[int], soft: float) -> None:
    """Every program on all problems that it solves, with one thread and with two."""
    for problem in ("hertz", "rough", "periodic"):
        for program in programs:
            if problem == "periodic" and not PROGRAMS[program].repeats:
                continue
            bench.sweep(problem, program, 1, sizes, soft=soft)
            if PROGRAMS[program].parallel:
                bench.sweep(problem, program, 2, sizes, soft=soft)
                continue
            first = bench.solve(Problem(problem, sizes[0]), program, 2)
            if first.seconds is not None:
                first.note = "as pip installs it, it runs on one thread: finer grids left out"


def by_itself(bench: Bench, sizes: list[int], *, large: bool) -> None:
    """Measure what nacre alone is asked for."""
    middle = min(1024, sizes[-1])
    turns = TURNS if large else TURNS // 8
    bench.solve(Problem("roller", middle), "nacre", 1)
    bench.solve(Problem("opened", middle), "nacre", 1)
    bench.in_turn(max(4, turns // 8), [bench.batch(128, 1000, n) for n in (1, os.cpu_count() or 1)])
    sphere, coated = Problem("hertz", middle), Problem("coated", middle)
    asked = [bench.solves(sphere, threads, "idle") for threads in (1, 2)]
    asked += [bench.solves(sphere, 1, "shared"), bench.solves(coated, 1, "idle")]
    bench.in_turn(turns, asked)
    bench.in_turn(turns, [bench.solves(sphere, threads, "busy") for threads in (1, 2)])
    if large:
        bench.solve(Problem("hertz", 4096), "nacre", 2, seconds=0.0)


def main() -> None:
    """Run, write, print."""
    chosen = options()
    sizes = [256, 512] if chosen.quick else SIZES
    if chosen.sizes:
        sizes = [int(size) for size in chosen.sizes.split(",")]
    usual = not (chosen.quick or chosen.sizes)
    limit = 7200.0 if chosen.full else chosen.limit
    soft = limit if chosen.full else 45.0
    programs = available(chosen.programs.split(","))
    chosen.work.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=chosen.work) as folder:
        bench = Bench(Path(folder), limit)
        for cells in sizes:
            for threads in (1, 2):
                bench.convolutions(chosen.convolution, cells, threads)
        by_itself(bench, sizes, large=usual)
        compare(bench, programs, sizes, soft)
        for plan in PLANS:
            if plan.split()[0] in programs:
                bench.friction(plan, FRICTION_SIZES)
    if chosen.out or not usual:
        out = chosen.out or chosen.work
        files = out / "peers.md", out / "peers.png", out / "peers.csv"
    else:
        docs = ROOT / "docs"
        files = docs / "peers.md", docs / "images" / "peers.png", docs / "peers.csv"
    report.write(bench, *files)
    print()
    for figure in all_figures(bench):
        print(f"{figure.what:80}  {report.measured(figure)}")
    print(f"written: {', '.join(str(file) for file in files)}")


if __name__ == "__main__":
    main()
