"""The quantities that have a required value, from the measurements."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from peers.measure import Bench, Row, Setting
from peers.problems import TOLERANCE


@dataclass(frozen=True)
class Figure:
    """One quantity: name, limit, goal and measured value."""

    what: str
    limit: float
    goal: float | None
    measured: float | None
    unit: str = ""
    least: bool = False
    """Whether the limit is a lower limit."""
    error: float | None = None
    """Relative standard error of the measured value, where it is a mean."""

    @property
    def met(self) -> str:
        """Whether the measured value keeps the limit, in words."""
        if self.measured is None:
            return "not measured"
        if self.error is not None and abs(self.measured - self.limit) <= self.error * self.measured:
            return "undecided: the limit is within the error"
        sign = -1 if self.least else 1
        if self.goal is not None and sign * self.measured <= sign * self.goal:
            return "met, also the goal"
        return "met" if sign * self.measured <= sign * self.limit else "missed"


def ratio(ours: Row | None, theirs: Row | None, field: str = "seconds") -> float | None:
    """Return the ratio of one field of two rows, where both were measured."""
    if ours is None or theirs is None:
        return None
    a, b = getattr(ours, field), getattr(theirs, field)
    return None if a is None or b is None else float(a / b)


def error(ours: Row | None, theirs: Row | None, field: str = "error") -> float | None:
    """Return the relative standard error of the ratio of two means."""
    errors = [value(row, field) for row in (ours, theirs)]
    known = [found for found in errors if found is not None]
    return math.hypot(*known) if len(known) == 2 else None


def value(row: Row | None, field: str) -> float | None:
    """Return a field of a row, where it was measured."""
    found = getattr(row, field) if row is not None else None
    return None if found is None else float(found)


def all_figures(bench: Bench) -> list[Figure]:
    """Return all quantities."""
    return [*convolution(bench), *hertz(bench), *rough(bench), *others(bench)]


def convolution(bench: Bench) -> Iterator[Figure]:
    """Return the times of one convolution relative to SciPy's."""
    for cells in (1024, 2048):
        for threads, limit, goal in ((1, 0.9, 0.7), (2, 0.75, 0.6)):
            ours = bench.find("convolution", cells, "nacre", threads)
            theirs = bench.find("convolution", cells, "SciPy", threads)
            what = f"one convolution, {cells}², relative to SciPy's; threads: {threads}"
            yield Figure(what, limit, goal, ratio(ours, theirs))


def against(
    bench: Bench, problem: str, limits: Iterable[tuple[str, float, float | None]]
) -> Iterator[Figure]:
    """Return times relative to those of other programs, at 1024² on one thread.

    Where a program misses the tolerance, the ratio is not measured.
    """
    ours = bench.find(problem, 1024, "nacre", 1)
    for program, limit, goal in limits:
        theirs = bench.find(problem, 1024, program, 1)
        what = f"{problem} 1024², 1 thread: time relative to {program}"
        same = all(row and row.residual and row.residual <= TOLERANCE for row in (ours, theirs))
        yield Figure(what, limit, goal, ratio(ours, theirs) if same else None)


def hertz(bench: Bench) -> Iterator[Figure]:
    """Return the quantities of the sphere."""
    one = bench.find("hertz", 1024, "nacre", 1)
    yield Figure("hertz 1024², 1 thread: work in convolutions", 12, 8, value(one, "work"))
    limits = (
        ("ASPHER", 1 / 5, 1 / 8),
        ("Tamaas", 1 / 50, 1 / 80),
        ("ContactMechanics", 1 / 90, 1 / 140),
    )
    yield from against(bench, "hertz", limits)
    fine = value(bench.find("hertz", 2048, "nacre", 1), "iterations")
    coarse = value(bench.find("hertz", 256, "nacre", 1), "iterations")
    more = None if fine is None or coarse is None else fine - coarse
    yield Figure("hertz: fine-grid iterations, 2048² minus 256²", 3, 1, more)
    outside = value(bench.find("convolution", 1024, "nacre", 1), "outside")
    yield Figure("hertz 1024², 1 thread: time outside transforms", 0.20, 0.10, outside)
    large = bench.find("hertz", 4096, "nacre", 2)
    extra = value(large, "bytes_per_cell")
    yield Figure("hertz 4096² solves: extra memory", 200, 120, extra, "bytes a cell")
    settings: tuple[tuple[Setting, float], ...] = (("idle", 0.6), ("busy", 1.1))
    for setting, limit in settings:
        one, two = (bench.find("hertz", 1024, "nacre", threads, setting) for threads in (1, 2))
        what = f"hertz 1024²: two threads relative to one, machine {setting}"
        yield Figure(what, limit, None, ratio(two, one), error=error(two, one))


def rough(bench: Bench) -> Iterator[Figure]:
    """Return the quantities of the rough surfaces."""
    yield from against(bench, "rough", (("ASPHER", 1 / 3, 1 / 6), ("Tamaas", 1 / 50, None)))
    limits = (("Tamaas", 1 / 10, 1 / 20), ("ContactMechanics", 1 / 10, None))
    yield from against(bench, "periodic", limits)
    ours, once = (bench.find(name, 1024, "nacre", 1) for name in ("periodic", "opened"))
    what = "periodic 1024², 1 thread: time relative to nacre's open solve of the same surface"
    yield Figure(what, 1 / 2, None, ratio(ours, once))


def others(bench: Bench) -> Iterator[Figure]:
    """Return the quantities of the problems that nacre alone solves."""
    roller = bench.find("roller", 1024, "nacre", 1)
    work = value(roller, "work")
    what = "roller of Spinu et al., 1024×128, E1/E2 = 4, e/L = 0.3: work in convolutions"
    yield Figure(what, 30, 20, work)
    bare, coated = (bench.find(name, 1024, "nacre", 1, "idle") for name in ("hertz", "coated"))
    what = "coated relative to bare, 1024², 1 thread, with planning"
    more = ratio(coated, bare, "together")
    yield Figure(what, 1.4, 1.2, more, error=error(coated, bare, "error_together"))
    cores = os.cpu_count() or 1
    alone, many = (bench.find("batch", 128, "nacre", threads, "idle") for threads in (1, cores))
    gain = ratio(alone, many)
    what = "1000 coated spheres at 128²: speed relative to cores × one alone"
    measured = None if gain is None else gain / cores
    yield Figure(what, 0.9, None, measured, least=True, error=error(alone, many))
