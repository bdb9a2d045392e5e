"""Ratios and other figures, from the measurements."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import dataclass

from peers.measure import Bench, Row, Setting
from peers.problems import TOLERANCE


@dataclass(frozen=True)
class Figure:
    """One quantity: name and measured value."""

    what: str
    measured: float | None
    unit: str = ""
    error: float | None = None
    """Relative standard error of the measured value, where it is a mean."""


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


def times(bench: Bench, problem: str, program: str) -> float | None:
    """Return the time of another program over nacre's, at 1024² on one thread.

    Where a program misses the tolerance, the ratio is not measured.
    """
    ours, theirs = (bench.find(problem, 1024, name, 1) for name in ("nacre", program))
    same = all(row and row.residual and row.residual <= TOLERANCE for row in (ours, theirs))
    return ratio(theirs, ours) if same else None


def all_figures(bench: Bench) -> Iterator[Figure]:
    """Return the quantities of nacre itself."""
    for cells in (1024, 2048):
        for threads in (1, 2):
            ours = bench.find("convolution", cells, "nacre", threads)
            theirs = bench.find("convolution", cells, "SciPy", threads)
            what = f"one convolution, {cells}², relative to SciPy's; threads: {threads}"
            yield Figure(what, ratio(ours, theirs))
    one = bench.find("hertz", 1024, "nacre", 1)
    yield Figure("hertz 1024², 1 thread: work in convolutions", value(one, "work"))
    fine = value(bench.find("hertz", 2048, "nacre", 1), "iterations")
    coarse = value(bench.find("hertz", 256, "nacre", 1), "iterations")
    more = None if fine is None or coarse is None else fine - coarse
    yield Figure("hertz: fine-grid iterations, 2048² minus 256²", more)
    outside = value(bench.find("convolution", 1024, "nacre", 1), "outside")
    yield Figure("hertz 1024², 1 thread: time outside transforms", outside)
    extra = value(bench.find("hertz", 4096, "nacre", 2), "bytes_per_cell")
    yield Figure("hertz 4096² solves: extra memory", extra, "bytes a cell")
    settings: tuple[Setting, ...] = ("idle", "busy")
    for setting in settings:
        one, two = (bench.find("hertz", 1024, "nacre", threads, setting) for threads in (1, 2))
        what = f"hertz 1024²: two threads relative to one, machine {setting}"
        yield Figure(what, ratio(two, one), error=error(two, one))
    rough = bench.find("rough", 1024, "nacre", 1)
    yield Figure("rough 1024², 1 thread: work in convolutions", value(rough, "work"))
    periodic, once = (bench.find(name, 1024, "nacre", 1) for name in ("periodic", "opened"))
    what = "periodic 1024², 1 thread: time relative to the open solve of the same surface"
    yield Figure(what, ratio(periodic, once))
    roller = bench.find("roller", 1024, "nacre", 1)
    what = "roller of Spinu et al., 1024×128, E1/E2 = 4, e/L = 0.3: work in convolutions"
    yield Figure(what, value(roller, "work"))
    bare, coated = (bench.find(name, 1024, "nacre", 1, "idle") for name in ("hertz", "coated"))
    what = "coated relative to bare, 1024², 1 thread, with planning"
    found = ratio(coated, bare, "together")
    yield Figure(what, found, error=error(coated, bare, "error_together"))
    cores = os.cpu_count() or 1
    alone, many = (bench.find("batch", 128, "nacre", threads, "idle") for threads in (1, cores))
    gain = ratio(alone, many)
    what = "1000 coated spheres at 128²: speed relative to cores × one alone"
    yield Figure(what, None if gain is None else gain / cores, error=error(alone, many))
