"""The cases and figures of Spinu et al.: a coated sphere and a coated roller of finite length.

``python -m paper`` in the folder of examples solves all of them, prints a table, and writes the
figures and all numbers. From Python, `run` does so, and `solve` only solves.
"""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from paper import figures, finite
from paper.cases import (
    CENTRED,
    ECCENTRIC,
    PROBLEM,
    RATIOS,
    SERIES,
    SPHERE,
    Result,
    Series,
    of_series,
    solve,
)
from paper.evaluation import claims, deviations, table, thickness_note

__all__ = [
    "CENTRED",
    "ECCENTRIC",
    "PROBLEM",
    "RATIOS",
    "SERIES",
    "SPHERE",
    "Result",
    "Series",
    "claims",
    "deviations",
    "of_series",
    "run",
    "solve",
    "table",
    "thickness_note",
]


def run(
    out: str | os.PathLike[str] = "out",
    *,
    threads: int | None = None,
    quick: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> list[Result]:
    """Solve every case of Spinu et al. and write table, figures and their numbers.

    Parameters
    ----------
    out
        Directory for ``table.csv`` and ``figure1.png``, ``figure1.csv`` to ``figure7.png``,
        ``figure7.csv``. The first six are the paper's; the seventh is its roller with free ends.
        It is made if need be; nothing is written unless every solve converged.
    threads, quick, progress
        As in `solve`.

    Returns
    -------
    list of Result
        As `solve` returns it.

    Raises
    ------
    OSError
        Where `out` cannot be made; this is tried before solving.
    nacre.ConvergenceError
        Where a solve does not converge.
    """
    out = Path(out)
    out.mkdir(parents=True, exist_ok=True)
    results = solve(threads=threads, quick=quick, progress=progress)
    files = {"table.csv": _csv(*table(results))}
    drawings = [*figures.draw(results), finite.draw(finite.solve(quick=quick))]
    for number, drawing in enumerate(drawings, start=1):
        files[f"figure{number}.png"] = drawing.png
        files[f"figure{number}.csv"] = _csv(drawing.header, drawing.rows)
    for name, content in files.items():
        (out / name).write_bytes(content)
    return results


def _csv(header: Sequence[str], rows: Iterable[Sequence[str | float]]) -> bytes:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    for row in rows:
        writer.writerow([cell if isinstance(cell, str) else f"{cell:.9g}" for cell in row])
    return text.getvalue().encode()
