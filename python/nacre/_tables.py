"""CSV files of solutions, for spreadsheets: two sections, or every cell."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import nacre._core as core
from nacre.units import UNITS, symbol

if TYPE_CHECKING:
    from _csv import Writer

    from nacre.solution import Solution

FIELDS = ("pressure", "gap", "displacement")
"""Fields of every solution's state."""
YIELDED = ("indentation", "hardness")
"""Further fields, of surfaces that have yielded or whose cells each have a hardness."""
GIVEN = ("coefficients",)
"""Further arrays, of contacts that were given them."""


def shown(solution: Solution) -> tuple[str, ...]:
    """Return the fields that tables and pictures show."""
    return (*FIELDS, "indentation") if solution.indentation.any() else FIELDS


def columns(fields: Iterable[str]) -> list[str]:
    """Return the headings of x, y and the fields, with the units that are set."""
    units = {"x": "m", "y": "m", **{name: UNITS[name] for name in fields}}
    return [f"{name} [{symbol(unit)}]" for name, unit in units.items()]


def write_sections(solution: Solution, path: Path) -> None:
    """Write the sections along x and along y through the largest pressure."""
    i, j = (
        int(np.argmin(np.abs(side - place)))
        for side, place in zip((solution.x, solution.y), solution.peak_position, strict=True)
    )
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["along", *columns(shown(solution))])
        _write(writer, solution, ((k, j) for k in range(solution.x.size)), "x")
        _write(writer, solution, ((i, k) for k in range(solution.y.size)), "y")


def write_cells(solution: Solution, path: Path) -> None:
    """Write every cell, after a block of comments with the most important numbers."""
    report, grid = solution.report, solution.report.grid
    head = {
        "source": f"nacre {core.__version__}",
        "cells": "{} x {}, y varies fastest".format(*grid.shape),
        f"spacing [{symbol('m')}]": "{} {}".format(*grid.spacing),
        f"load [{symbol('N/m' if grid.is_line else 'N')}]": solution.load,
        f"approach [{symbol('m')}]": solution.approach,
        "tilt": "{} {}".format(*solution.tilt),
        f"peak pressure [{symbol('Pa')}]": solution.peak_pressure,
        "termination": report.termination,
        **{f"warning {k}": text for k, text in enumerate(report.warnings, start=1)},
    }
    nx, ny = grid.shape
    with path.open("w", newline="", encoding="utf-8") as file:
        file.writelines(f"# {name}: {value}\n" for name, value in head.items())
        writer = csv.writer(file)
        writer.writerow(columns(shown(solution)))
        _write(writer, solution, ((i, j) for i in range(nx) for j in range(ny)))


def _write(
    writer: Writer, solution: Solution, cells: Iterable[tuple[int, int]], *first: str
) -> None:
    x, y = solution.x.tolist(), solution.y.tolist()
    fields = [getattr(solution, name).tolist() for name in shown(solution)]
    writer.writerows([*first, x[i], y[j], *(f[i][j] for f in fields)] for i, j in cells)
