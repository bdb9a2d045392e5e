"""`examples/paper` draws and writes what nacre solves, on the grids of a first look."""

from __future__ import annotations

import contextlib
import csv
import functools
import io
import sys
import types
from pathlib import Path
from typing import Any, cast
from unittest import mock

import numpy as np
import pytest

import nacre
import paper
import paper.__main__ as program
from paper import cases, evaluation, figures

COARSE = 0.005  # error of the coarse grids in pressure, relative
NAMES = {"table.csv"} | {f"figure{k}.{kind}" for k in range(1, 8) for kind in ("png", "csv")}


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("paper") / "new" / "out"


@pytest.fixture(scope="module")
def results(out: Path) -> list[paper.Result]:
    return demo(out)[0]


@functools.cache
def demo(out: Path) -> tuple[list[paper.Result], str]:
    """Return what the demonstration found and printed, whose progress is told of each case."""
    calls: list[Any] = []
    found: list[paper.Result] = []

    def run(*given: Any, progress: Any, **options: Any) -> list[paper.Result]:
        found.extend(paper.run(*given, progress=lambda *c: calls.append(c), **options))
        progress(*calls[-1])
        return found

    with (
        mock.patch.object(sys, "argv", ["paper", "--quick", "--out", str(out)]),
        mock.patch.object(program, "run", run),
        contextlib.redirect_stdout(io.StringIO()) as printed,
        contextlib.redirect_stderr(io.StringIO()) as errors,
    ):
        program.main()
    assert errors.getvalue() == ""
    assert calls == [(done, 25) for done in range(1, 26)]
    return found, printed.getvalue()


def read(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def column(rows: list[dict[str, str]], name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.array([float(row[name]) for row in rows])


def test_every_file_is_there_and_nothing_else(results: list[paper.Result], out: Path) -> None:
    assert {path.name for path in out.iterdir()} == NAMES
    for path in out.glob("*.png"):
        start = path.read_bytes()[:24]
        assert start[:8] == b"\x89PNG\r\n\x1a\n"
        assert int.from_bytes(start[16:20], "big") == int(18 / 2.54 * 300)  # 18 cm at 300 dpi


def test_table_holds_what_nacre_solves(results: list[paper.Result], out: Path) -> None:
    rows = read(out / "table.csv")
    assert len(rows) == 25
    row = next(
        row
        for row in rows
        if (row["case"], row["h [mm]"], row["E1/E2"]) == ("roller, e/L = 0.3", "0.2", "2")
    )
    steel, coating = nacre.Elastic(210e9, 0.3), nacre.Elastic(420e9, 0.3)
    solution = nacre.solve(
        nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5),
        nacre.HalfSpace(steel, layers=[nacre.Layer(coating, thickness=0.2e-3)]),
        grid=nacre.Grid(shape=(225, 45), size=(31e-3, 0.18e-3)),
        load=1e3,
        eccentricity=(2.8695e-3, 0.0),
    )
    (left, right), _ = solution.contact_extent
    assert (
        row
        | {
            "peak [MPa]": f"{1e-6 * solution.peak_pressure:.9g}",
            "central [MPa]": f"{1e-6 * solution.central_pressure:.9g}",
            "riser": f"{solution.peak_pressure / solution.central_pressure:.9g}",
            "left end [mm]": f"{1e3 * left:.9g}",
            "right end [mm]": f"{1e3 * right:.9g}",
            "area [mm²]": f"{1e6 * solution.contact_area:.9g}",
            "approach [µm]": f"{1e6 * solution.approach:.9g}",
            "tilt [1e-5]": f"{1e5 * solution.tilt[0]:.9g}",
            "iterations": str(solution.report.iterations),
        }
        == row
    )


def test_roller_of_one_material_is_the_known_one(results: list[paper.Result]) -> None:
    for series in cases.CENTRED:
        result = next(r for r in paper.of_series(results, series) if r.ratio == 1)
        solution = result.solution
        assert solution.central_pressure == pytest.approx(774e6, rel=COARSE)
        assert solution.peak_pressure == pytest.approx(822e6, rel=COARSE)
        assert solution.approach == pytest.approx(0.878e-6, rel=COARSE)
        assert result.half_width == pytest.approx(0.0335e-3, rel=COARSE)
    for series in cases.ECCENTRIC:
        result = next(r for r in paper.of_series(results, series) if r.ratio == 1)
        assert result.solution.peak_pressure == pytest.approx(985e6, rel=COARSE)
        assert result.solution.tilt[0] == pytest.approx(3.40e-5, rel=COARSE)


def test_only_a_thick_soft_coating_lowers_the_riser(results: list[paper.Result]) -> None:
    """What docs/theory/paper.md says of the paper's closing claim."""
    thin, thick, thin_off_centre, thick_off_centre = (
        {r.ratio: r.riser - 1 for r in paper.of_series(results, series)}
        for series in cases.CENTRED + cases.ECCENTRIC
    )
    for series, bare, soft in (
        (thin, 0.0625, 0.061),
        (thick, 0.0625, 0.032),
        (thin_off_centre, 0.29, 0.343),
        (thick_off_centre, 0.29, 0.252),
    ):
        assert (series[1], series[0.25]) == pytest.approx((bare, soft), abs=COARSE)


def test_no_contact_needs_a_warning(results: list[paper.Result]) -> None:
    assert [result.solution.report.warnings for result in results] == 25 * [[]]


def test_grids_are_as_fine_as_promised() -> None:
    for series in cases.SERIES:
        least = (256, 256) if series is cases.SPHERE else (1024, 128)
        assert all(n >= m for n, m in zip(series.cells, least, strict=True))


def test_sphere_figure_shows_computed_and_reference_values(
    results: list[paper.Result], out: Path
) -> None:
    rows = [row for row in read(out / "figure1.csv") if row["E1/E2"] == "4"]
    computed = [row for row in rows if row["source"] == "computed"]
    reference = [row for row in rows if row["source"] == "reference"]
    assert len(reference) == 41
    assert float(reference[0]["p/p_H"]) == pytest.approx(2.28346598)  # pmax/p_H
    # Away from the edge the two curves are one.
    radius = column(reference, "r/a_H")[:30]
    there = np.interp(radius, column(computed, "r/a_H"), column(computed, "p/p_H"))
    assert there == pytest.approx(column(reference, "p/p_H")[:30], rel=0.02)


@pytest.mark.parametrize(
    ("figure", "axes", "series"),
    [(2, {"x"}, cases.CENTRED), (3, {"y"}, cases.CENTRED), (5, {"x", "y"}, cases.ECCENTRIC)],
)
def test_profiles_are_those_of_the_solutions(
    results: list[paper.Result],
    out: Path,
    figure: int,
    axes: set[str],
    series: tuple[cases.Series, cases.Series],
) -> None:
    rows = read(out / f"figure{figure}.csv")
    assert {row["along"] for row in rows} == axes
    assert {row["E1/E2"] for row in rows} == {"0.25", "0.5", "1", "2", "4"}
    for one in series:
        result = paper.of_series(results, one)[3]
        for axis in axes:
            key = (axis, f"{1e3 * one.thickness:.9g}", "2")
            drawn = [r for r in rows if (r["along"], r["h [mm]"], r["E1/E2"]) == key]
            middle = np.argmin(np.abs(column(drawn, "position [mm]")))
            # Both axes pass through a cell at the origin.
            central = result.solution.pressure[112, 22]
            assert column(drawn, "pressure [MPa]")[middle] == pytest.approx(1e-6 * central)


@pytest.mark.parametrize(("figure", "series"), [(4, cases.CENTRED[0]), (6, cases.ECCENTRIC[0])])
def test_surface_carries_the_load(
    results: list[paper.Result], out: Path, figure: int, series: cases.Series
) -> None:
    rows = read(out / f"figure{figure}.csv")
    shape = (-1, 81)
    x, y, pressure = (
        column(rows, name).reshape(shape) for name in ("x [mm]", "y [mm]", "pressure [MPa]")
    )
    line_load = np.trapezoid(pressure, y, axis=1)
    load = np.trapezoid(line_load, x[:, 0])
    assert load == pytest.approx(series.load, rel=0.02)
    assert series.eccentricity is not None
    moment = np.trapezoid(line_load * x[:, 0], x[:, 0])
    assert moment / load == pytest.approx(1e3 * series.eccentricity[0], abs=0.05)


def test_one_figure_is_that_of_all_and_others_are_refused(
    results: list[paper.Result], out: Path
) -> None:
    one, written = figures.figure(3, results), read(out / "figure3.csv")
    assert [*one.header] == list(written[0])
    assert [[f"{c:.9g}" if isinstance(c, float) else c for c in row] for row in one.rows] == [
        [*r.values()] for r in written
    ]
    with pytest.raises(ValueError, match="number must be one of 1, 2, 3, 4, 5, 6, got 7"):
        figures.figure(7, results)


def test_reference_values_are_hertz_where_coating_is_substrate() -> None:
    reference = next(r for r in evaluation.references() if r.ratio == 1)
    assert reference.pressure == pytest.approx(np.sqrt(1 - reference.radius**2), abs=1e-10)
    assert (reference.peak, reference.approach) == pytest.approx((1, 1))


def test_deviations_are_small_and_those_of_a_wrong_solution_are_not(
    results: list[paper.Result],
) -> None:
    for deviation in evaluation.deviations(results):
        assert abs(deviation.peak) < COARSE
        assert abs(deviation.approach) < 1e-3
        assert deviation.pressure < 0.05  # the steep edge, on few cells
    sphere = paper.of_series(results, cases.SPHERE)
    wrong = [cases.Result(cases.SPHERE, r.ratio, sphere[0].solution) for r in sphere]
    assert abs(evaluation.deviations(wrong)[-1].peak) > 0.5


def test_claim_needs_both_smaller_riser_and_larger_area() -> None:
    def result(series: cases.Series, ratio: float, riser: float, area: float) -> cases.Result:
        solution = types.SimpleNamespace(
            peak_pressure=riser, central_pressure=1.0, contact_area=area
        )
        return cases.Result(series, ratio, cast(nacre.Solution, solution))

    values = {0.25: (1.1, 3.0), 0.5: (1.3, 2.0), 1.0: (1.2, 1.0), 2.0: (1.1, 0.5), 4.0: (1.3, 0.2)}
    results = [
        result(series, ratio, *value)
        for series in cases.SERIES[1:]
        for ratio, value in values.items()
    ]
    claims = evaluation.claims(results)
    assert [claim.holds for claim in claims] == 4 * [True, False, False, False]
    assert (claims[0].riser, claims[0].area) == pytest.approx((1.1 / 1.2 - 1, 2.0))


def test_half_width_of_a_hertzian_line_is_exact_whatever_its_outermost_cell() -> None:
    y = np.linspace(-1.0, 1.0, 61)
    pressure = np.sqrt(np.maximum(0, 1 - (y / 0.77) ** 2))
    pressure[np.flatnonzero(pressure)[[0, -1]]] *= 0.3
    assert cases.half_width(y, pressure) == pytest.approx(0.77, rel=1e-12)


def test_free_ends_are_drawn(results: list[paper.Result], out: Path) -> None:
    rows = read(out / "figure7.csv")
    series = {(row["roller"], row["load"], row["bodies"]) for row in rows}
    assert len(series) == 12

    def pressure(bodies: str) -> np.ndarray[Any, np.dtype[np.float64]]:
        chosen = ("straight, sharp ends", "centred", bodies)
        lines = [row for row in rows if (row["roller"], row["load"], row["bodies"]) == chosen]
        return column(lines, "pressure [MPa]")

    # In the cell at the end, 0.075 mm long, the half-space has 1.8 times the pressure of the
    # middle, and a free end 1.14 times; in the middle both agree to 3 %.
    free, half_space = pressure("free ends"), pressure("half-space")
    middle = len(free) // 2
    assert free[middle] == pytest.approx(half_space[middle], rel=0.04)
    assert half_space[0] > 1.4 * free[0] > 1.5 * free[middle]


def test_note_says_why_there_are_two_thicknesses(results: list[paper.Result]) -> None:
    note = paper.thickness_note(results).replace("\u00a0", " ")
    assert "0.0335 mm" in note or "0.0336 mm" in note
    assert "about 35 kN" in note or "about 36 kN" in note


def test_a_file_in_place_of_the_directory_is_refused_before_solving(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(FileExistsError):
        paper.run(tmp_path / "file", progress=lambda done, total: pytest.fail("solved"))


def test_an_exception_of_the_callback_ends_the_run_and_leaves_no_files(tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    def stop(done: int, total: int) -> None:
        raise Enough

    with pytest.raises(Enough):
        paper.run(tmp_path, quick=True, progress=stop)
    assert list(tmp_path.iterdir()) == []


def test_a_solve_that_does_not_converge_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Contact:
        def __init__(self, *arguments: object, **options: object) -> None: ...

        def solve(self, *arguments: object, **options: object) -> None:
            raise nacre.ConvergenceError("residual 1e-3 after 9 iterations")

    monkeypatch.setattr(nacre, "Contact", Contact)
    with pytest.raises(nacre.ConvergenceError) as error:
        paper.run(tmp_path)
    assert error.value.__notes__[0].startswith("sphere, h = 0.1 mm, E1/E2 = ")
    assert list(tmp_path.iterdir()) == []


def test_the_demo_prints_table_claim_and_reference(out: Path) -> None:
    _, output = demo(out)
    assert max(map(len, output.splitlines())) <= 80 + len(str(out))
    for series in cases.SERIES:
        assert series.title in output
    rows = [line.split() for line in output.splitlines()]
    peaks = [row[1] for row in rows if row[:1] == ["1"] and len(row) == 12]
    assert peaks == ["1468", "823", "986", "823", "986"]  # MPa, E1 = E2
    assert "holds" in output
    assert "Largest deviations" in output
