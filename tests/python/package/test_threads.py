"""Eight threads solve, print, save and sweep at once, and find the bits that one finds alone.

It needs nacre, NumPy and pytest alone, so that a Python without the global lock can run it; what
needs the extra `files` is left out where that is missing.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

import nacre

THREADS = 8
OPERATIONS = 10_000
STEEL = nacre.Elastic(210e9, 0.3)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(420e9, 0.2), 2e-5)])
GRID = nacre.Grid((12, 10), (3e-4, 2.5e-4))
CONTACTS = [nacre.Contact(body, GRID) for body in (STEEL, COATED)]
BALLS = [nacre.Sphere(radius) for radius in (4e-3, 5e-3, 6e-3)]
FILES = importlib.util.find_spec("h5netcdf") is not None


def solved(k: int) -> nacre.Solution:
    """Return one of 30 contacts."""
    return CONTACTS[k % 2].solve(BALLS[k % 3], load=5.0 + k % 5)


def pressures(k: int, _: Path) -> Any:
    return solved(k).pressure.tobytes()


def prints(k: int, _: Path) -> Any:
    with nacre.display_units(("SI", "N-mm-MPa")[k % 2]):
        return str(solved(k))


def reports(k: int, _: Path) -> Any:
    solution = solved(k)
    return repr(solution), solution.report.iterations, solution.contact_area


def pickles(k: int, _: Path) -> Any:
    return nacre.Solution.from_dict(solved(k).to_dict()).pressure.tobytes()


def files(k: int, folder: Path) -> Any:
    path = folder / f"{k}.nc"
    solution = nacre.load(solved(k).save(path))
    path.unlink()
    return solution.pressure.tobytes()


def sweeps(k: int, _: Path) -> Any:
    case = {"shape": BALLS[k % 3], "body": STEEL, "grid": GRID}
    study = nacre.sweep(case, {"load": [5.0, 6.0 + k % 5]}, outputs=["peak_pressure"])
    return study.peak_pressure.values.tobytes()


LIGHT: list[Callable[[int, Path], Any]] = [pressures, prints, reports, pickles]


def operation(k: int) -> Callable[[int, Path], Any]:
    """Return what the operation of this number does: each hundredth writes a file, or sweeps."""
    if FILES and k % 100 in (0, 50):
        return files if k % 100 else sweeps
    return LIGHT[k // 30 % len(LIGHT)]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")
def test_eight_threads_find_what_one_finds(tmp_path: Path) -> None:
    alone: dict[tuple[str, int], Any] = {}
    for k in range(OPERATIONS):
        work = operation(k)
        key = (work.__name__, k % 30)
        if key not in alone:
            alone[key] = work(k % 30, tmp_path)

    def differs(k: int) -> bool:
        work = operation(k)
        folder = tmp_path / str(k)
        if work is files:
            folder.mkdir()
        return bool(work(k % 30, folder) != alone[work.__name__, k % 30])

    with ThreadPoolExecutor(THREADS) as pool:
        assert sum(pool.map(differs, range(OPERATIONS), chunksize=1)) == 0
    kinds = {operation(k).__name__ for k in range(OPERATIONS)}
    assert kinds >= {work.__name__ for work in LIGHT}
    assert not FILES or {"files", "sweeps"} <= kinds
