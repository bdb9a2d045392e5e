"""What `make peers` measures is right, and it goes on without the programs it compares with."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import numpy as np
import pytest

import nacre
from peers import report
from peers.figures import all_figures, times
from peers.judge import Convolution, judge
from peers.measure import Bench, Row, mean
from peers.problems import HURST, Problem, periodic_heights, rough_heights, rough_waves

# Sums of some thousand terms, and transforms, in double precision.
ROUNDING = 1e-13


def solve(problem: Problem) -> nacre.Solution:
    """Return nacre's solution."""
    contact = nacre.Contact(problem.body, problem.grid, coefficients=problem.coefficients())
    return contact.solve(problem.shape(), load=problem.load)


def test_the_convolution_of_the_judge_is_the_double_sum() -> None:
    random = np.random.default_rng(1)
    coefficients, pressure = random.random((5, 4)), random.random((5, 4))
    i, j = np.indices((5, 4))
    direct = [
        [np.sum(coefficients[abs(i - k), abs(j - m)] * pressure) for m in range(4)]
        for k in range(5)
    ]
    assert Convolution(coefficients)(pressure) == pytest.approx(np.array(direct), rel=ROUNDING)


@pytest.mark.parametrize("name", ["hertz", "coated"])
def test_the_judge_finds_the_residual_that_nacre_reports(name: str) -> None:
    problem = Problem("hertz" if name == "hertz" else "coated", 48)
    solution = solve(problem)
    verdict = judge(solution.pressure, problem.gaps(), problem.body, problem.grid, problem.load)
    # Both are relative to the displacement, whose rounding is all that they differ by.
    assert verdict.residual == pytest.approx(solution.report.residual, abs=ROUNDING)
    assert verdict.overlap == pytest.approx(solution.report.overlap, abs=ROUNDING)
    assert verdict.balance < ROUNDING
    assert verdict.contact == solution.in_contact.mean()


def test_the_judge_finds_the_error_of_a_pressure_that_is_one_per_cent_too_large() -> None:
    problem = Problem("hertz", 48)
    solution = solve(problem)
    wrong = 1.01 * solution.pressure
    verdict = judge(wrong, problem.gaps(), problem.body, problem.grid, problem.load)
    # In contact h = δ − u, so that the gap becomes a hundredth of u less its mean there.
    u, p = solution.displacement, solution.pressure
    excess = 0.01 * np.abs(u - u[p > 0].mean())
    expected = np.sum(p * excess) / np.sum(p * 1.01 * u)
    # The solution itself is exact within its tolerance.
    assert verdict.residual == pytest.approx(expected, rel=1e-4)
    assert verdict.balance == pytest.approx(0.01, rel=1e-9)


def test_the_judge_of_what_repeats_knows_the_waves() -> None:
    """The solution is judged good; 1 % more pressure has a gap of 1 % of u, less its mean."""
    problem = Problem("periodic", 64)
    solution, gaps = solve(problem), problem.gaps()
    args = (gaps, problem.body, problem.grid, problem.load)
    good = judge(solution.pressure, *args)
    # nacre's tolerance is relative to the displacement, which is of the size of the heights.
    assert good.residual < 1e-7
    assert good.balance < ROUNDING
    wrong = judge(1.01 * solution.pressure, *args)
    u, p = solution.displacement, solution.pressure
    excess = 0.01 * np.abs(u - u[p > 0].mean())
    assert wrong.residual == pytest.approx(np.sum(p * excess) / p.sum() / gaps.std(), rel=1e-3)


def test_the_periodic_surface_repeats_and_has_slope_one() -> None:
    heights = periodic_heights(128)
    spectrum = np.fft.rfft2(heights)
    q = (
        2
        * np.pi
        * np.hypot(np.fft.fftfreq(128, 2 / 128)[:, None], np.fft.rfftfreq(128, 2 / 128)[None, :])
    )
    kept = np.abs(spectrum) > 1e-9 * np.abs(spectrum).max()
    # Waves from half the side to eight cells: a jump at the seam would have others.
    assert q[kept].min() == pytest.approx(2 * np.pi / 1.0)
    assert q[kept].max() <= 2 * np.pi / (8 * 2 / 128) * (1 + ROUNDING)
    double = np.where(np.isin(np.arange(65), (0, 64)), 1, 2)[None, :]
    slope = np.sqrt(np.sum(double * (q * np.abs(spectrum)) ** 2)) / 128**2
    assert slope == pytest.approx(1, rel=1e-10)


def test_the_rough_surface_has_the_spectrum_it_states() -> None:
    waves, qx, qy = rough_waves(128, 2 / 64, seed=3)
    q, amplitude = np.hypot(qx, qy), np.abs(waves)
    inside = amplitude > 0
    slope, _ = np.polyfit(np.log(q[inside]), np.log(amplitude[inside]), 1)
    # The density is the square of the amplitude.
    assert 2 * slope == pytest.approx(-2 * (HURST + 1), rel=1e-10)
    # Waves from half the side to eight cells.
    assert q[inside].min() == pytest.approx(2 * np.pi / 1.0)
    assert q[inside].max() == pytest.approx(2 * np.pi / (8 * 2 / 64))


def test_the_rough_surface_has_slope_one() -> None:
    heights, spacing = rough_heights(256), 2 / 256

    def derivative(axis: int) -> np.ndarray:
        """Return that of fourth order, 1.2 % too small for the shortest wave, of inner cells."""
        one, two = (np.roll(heights, -k, axis) - np.roll(heights, k, axis) for k in (1, 2))
        return ((8 * one - two) / (12 * spacing))[2:-2, 2:-2]

    slope = np.sqrt(np.mean(derivative(0) ** 2 + derivative(1) ** 2))
    assert slope == pytest.approx(1, rel=0.012)
    assert np.abs(heights[0] - heights[-1]).max() > 0.1 * heights.std()


def in_turn(
    problem: str, threads: int, seconds: float, together: float, errors: tuple[float, float]
) -> Row:
    """Return a row of what was measured in turn."""
    row = Row(problem, 128 if problem == "batch" else 1024, "nacre", threads, seconds=seconds)
    row.together, row.setting = together, "idle"
    row.error, row.error_together = errors
    return row


def test_figures_are_ratios() -> None:
    bench = Bench(Path(), limit=1.0)
    bench.rows = [
        Row("hertz", 1024, "nacre", 1, seconds=2.0, together=3.0, work=12.5, residual=1e-9),
        Row("hertz", 1024, "ASPHER", 1, seconds=9.0, residual=1e-8),
        Row("hertz", 1024, "Tamaas", 1, seconds=180.0, residual=9e-9),
        Row("hertz", 1024, "ContactMechanics", 1, seconds=900.0, residual=1.1e-8),
        # Measured in turn: relative standard errors of the seconds, and with planning.
        in_turn("hertz", 1, 2.2, 3.0, (0.03, 0.05)),
        in_turn("hertz", 2, 1.1, 2.0, (0.04, 0.10)),
        in_turn("coated", 1, 2.5, 3.3, (0.02, 0.12)),
        in_turn("batch", 1, 4.0, 4.0, (0.03, 0.03)),
        in_turn("batch", os.cpu_count() or 1, 2.0, 2.0, (0.04, 0.04)),
    ]
    found = {figure.what: figure for figure in all_figures(bench)}
    assert found["hertz 1024², 1 thread: work in convolutions"].measured == 12.5
    assert times(bench, "hertz", "ASPHER") == 4.5
    assert times(bench, "hertz", "Tamaas") == 90
    # It missed the tolerance.
    assert times(bench, "hertz", "ContactMechanics") is None
    coated = found["coated relative to bare, 1024², 1 thread, with planning"]
    assert coated.measured == pytest.approx(1.1)
    assert coated.error == pytest.approx(0.13)  # of 5 and 12 %
    assert report.measured(coated) == "1.1 ± 0.1"
    idle = found["hertz 1024²: two threads relative to one, machine idle"]
    assert (idle.measured, idle.error) == pytest.approx((0.5, 0.05))
    assert found["hertz 1024²: two threads relative to one, machine busy"].measured is None
    batch = found["1000 coated spheres at 128²: speed relative to cores × one alone"]
    assert batch.measured == pytest.approx(2 / (os.cpu_count() or 1))
    lines = report.glance(bench, ["ASPHER", "Tamaas", "ContactMechanics"])
    assert "| problem | ASPHER | Tamaas | ContactMechanics |" in lines
    assert f"| {report.TITLES['hertz']} | 4.5 | 90 | – |" in lines


@pytest.fixture
def no_tamaas(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the processes of a run from importing Tamaas, installed or not."""
    text = "raise ModuleNotFoundError(\"No module named 'tamaas'\")\n"
    (tmp_path / "tamaas.py").write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)  # `python -m` looks there first


@pytest.mark.usefixtures("no_tamaas")
def test_a_run_goes_on_where_a_program_is_missing_and_writes_what_it_has(tmp_path: Path) -> None:
    bench = Bench(tmp_path, limit=60.0)
    bench.sweep("hertz", "nacre", 1, [32, 64], soft=60.0)
    bench.sweep("hertz", "Tamaas", 1, [32, 64], soft=60.0)
    bench.convolutions(None, 32, 1)
    files = [tmp_path / name for name in ("peers.md", "peers.png", "peers.csv")]
    report.write(bench, *files)
    with files[2].open(encoding="utf-8") as opened:
        rows = list(csv.DictReader(opened))
    ours = [row for row in rows if row["program"] == "nacre" and row["problem"] == "hertz"]
    assert [row["cells"] for row in ours] == ["32", "64"]
    assert all(0 < float(row["residual"]) <= 1e-8 for row in ours)
    # Before the judge nobody's figure is taken from the program itself.
    assert all(abs(float(row["residual"]) - float(row["reported"])) < ROUNDING for row in ours)
    theirs = [row["note"] for row in rows if row["program"] == "Tamaas"]
    assert theirs == [
        "failed: ModuleNotFoundError: No module named 'tamaas'",
        "left out: a coarser grid failed",
    ]
    assert files[1].read_bytes().startswith(b"\x89PNG")
    text = files[0].read_text(encoding="utf-8")
    assert "| 64² | nacre | 1 |" in text
    assert "![Time of a solve as a function of the number of cells](peers.png)" in text


def test_what_is_measured_in_turn_counts_by_the_mean_over_processes() -> None:
    processes = [{"seconds": [1.0, 3.0], "together": [5.0]}, {"seconds": [4.0], "together": [7.0]}]
    found = mean(processes)
    # Processes of 2 and 4 s: their deviation is √2 s, the mean's √2/√2 = 1 s, a third of 3 s.
    assert found["seconds"] == pytest.approx((3.0, 1 / 3))
    assert found["together"] == pytest.approx((6.0, 1 / 6))


def test_solves_in_turn_are_rows_with_an_error(tmp_path: Path) -> None:
    bench = Bench(tmp_path, limit=60.0)
    problem = Problem("hertz", 32)
    asked = [bench.solves(problem, 1, "idle"), bench.solves(problem, 1, "shared")]
    bench.in_turn(2, [*asked, bench.batch(16, 3, 1)])
    sphere, both, batch = bench.rows
    assert bench.find("hertz", 32, "nacre", 1, "idle") is sphere
    assert bench.find("hertz", 32, "nacre", 1) is None
    for row in (sphere, both, batch):
        assert (row.seconds or 0) > 0
        assert (row.error or 0) > 0
        assert 0 < (row.residual or 0) <= 1e-8
    assert sphere.together == pytest.approx((sphere.seconds or 0) + (sphere.planning or 0))
    assert both.note.startswith("mean of 4 processes, ± ")
    assert ", two at once; the fastest " in both.note
    assert batch.note.startswith("mean of 2 processes, ± ")
    assert batch.note.endswith(f"; {3 / (batch.seconds or 1):.0f} solves a second")


@pytest.mark.usefixtures("no_tamaas")
def test_what_fails_in_turn_says_why(tmp_path: Path) -> None:
    bench = Bench(tmp_path, limit=60.0)
    row, request = bench.solves(Problem("hertz", 32), 1, "idle")
    bench.in_turn(2, [(row, request | {"program": "Tamaas"})])
    assert bench.rows == [row]
    assert row.seconds is None
    assert row.note == "failed: ModuleNotFoundError: No module named 'tamaas'"
