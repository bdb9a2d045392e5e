"""A solution prints forces, bodies and motion, in the units that are set; a notebook a map too."""

from __future__ import annotations

import base64
import io
import re
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread

import nacre
from nacre import design
from nacre._tools.units import Scale, rounded, size_of, written
from nacre.bearing import DeepGrooveBall
from nacre.results import display

STEEL, DLC = nacre.Elastic(210e9, 0.3), nacre.Elastic(420e9, 0.2)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 2e-6)])


def table(solution: nacre.Solution) -> dict[str, str]:
    pairs = (re.split(r"\s{2,}", line.strip(), maxsplit=1) for line in str(solution).splitlines())
    return {pair[0]: pair[1] for pair in pairs if len(pair) == 2}


def test_the_table_names_bodies_modulus_motion_and_resultant() -> None:
    shape = nacre.Sphere(5e-3)
    solution = nacre.solve(shape, COATED, STEEL, load=10.0, eccentricity=(1e-6, None))
    rows = table(solution)
    assert rows["load"] == "10 N"
    assert rows["acts at"] == "(1 µm, 0 µm)"
    assert rows["motion"] == "load; tilt x free, y locked"
    assert rows["body"] == "E 210 GPa, ν 0.3"
    assert rows["layers[0]"] == "2 µm, E 420 GPa, ν 0.2"
    assert rows["counterbody"] == "E 210 GPa, ν 0.3"
    # 1/E* is the sum of both compliances (1 - ν²)/E.
    assert rows["E* (substrates)"] == f"{210 / 0.91 / 2:.4g} GPa"
    assert rows["E* (surfaces)"] == f"{1 / (0.96 / 420 + 0.91 / 210):.4g} GPa"
    assert rows["ended"].startswith("converged")


def test_the_contact_has_a_width_and_its_error_along_each_side() -> None:
    grid = nacre.Grid((60, 24), (3e-4, 3e-4))
    solution = nacre.solve(nacre.Paraboloid(5e-3, 1e-2), STEEL, grid=grid, load=10.0)
    errors = (solution.report.discretisation or {})["contact_extent"]
    sides = re.findall(r"([\d.]+) µm ± ([\d.]+) %", table(solution)["contact"])
    widths = np.ptp(solution.contact_extent, axis=1)
    shares = 200 * np.array(errors) / widths
    assert widths[1] > 1.2 * widths[0]
    assert shares[1] > 2 * shares[0]
    for side, width, share in zip(sides, widths, shares, strict=True):
        assert float(side[0]) == pytest.approx(1e6 * width, rel=1e-3)
        assert float(side[1]) == pytest.approx(share, rel=0.34)  # one digit


def test_a_rigid_counterbody_and_what_is_given_are_said() -> None:
    grid = nacre.Grid((16, 16), (1e-3, 1e-3))
    solution = nacre.solve(nacre.Sphere(5e-3), STEEL, grid=grid, approach=-1e-6, tilt=(1e-5, None))
    rows = table(solution)
    assert rows["counterbody"] == "rigid"
    assert rows["E*"] == f"{210 / 0.91:.4g} GPa"
    assert rows["motion"] == "approach; tilt x given, y locked"
    assert rows["acts at"] == "nothing touches"


def test_many_layers_are_one_row() -> None:
    body = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 1e-6)] * 20)
    assert table(nacre.solve(nacre.Sphere(5e-3), body, load=10.0))["layers"] == "20, together 20 µm"


def test_free_ends_are_a_row() -> None:
    grid = nacre.Grid((48, 48), (2.4e-4, 2.4e-4))
    one = nacre.HalfSpace(STEEL, ends=(-9e-5, None))
    two = nacre.HalfSpace(STEEL, ends=(-1e-3, 2e-3))
    solution = nacre.solve(nacre.Sphere(5e-3), one, two, grid=grid, load=10.0)
    rows = table(solution)
    assert rows["free end"] == "x = -90 µm"
    assert rows["free ends"] == "x = -1 mm and x = 2 mm"
    assert "x = -1 mm and x = 2 mm" in solution._repr_html_()
    assert "ends=(-0.001, 0.002)" in repr(solution)


def picture_of(result: Any) -> str:
    """Return the picture that a notebook shows, as SVG."""
    encoded = re.search(r"image/svg\+xml;base64,([^']+)'", result._repr_html_())
    assert encoded
    return base64.b64decode(encoded[1]).decode()


def map_of(result: Any) -> Any:
    """Return the red, green and blue of each pixel of its map, from 0 to 255."""
    encoded = re.search(r"image/png;base64,([^']+)'", picture_of(result))
    assert encoded
    image = imread(io.BytesIO(base64.b64decode(encoded[1])))
    return (image[..., :3] * 255).round().astype(int)


def test_the_map_has_x_to_the_right_and_y_upwards() -> None:
    grid = nacre.Grid((40, 20), (4e-4, 2e-4))
    pressure = np.zeros((40, 20))
    pressure[5:36, 4:17] = 1.0
    pressure[30:33, 12:15] = 4.0
    state = nacre.solve(nacre.Sphere(5e-3), STEEL, grid=grid, load=10.0).to_dict()
    image = map_of(nacre.Solution.from_dict(state | {"pressure": pressure}))
    height, width, _ = image.shape
    rows, columns = np.nonzero((image == (253, 231, 37)).all(axis=-1))  # the top of viridis
    assert columns.min() > 0.6 * width
    assert rows.max() < 0.5 * height
    assert (image[0] == 255).all()  # white where nothing touches


def test_a_notebook_shows_a_table_and_a_map_with_axes_and_scale() -> None:
    solution = nacre.solve(nacre.Sphere(5e-3), COATED, load=10.0)
    html = solution._repr_html_()
    assert "<td" in html
    assert "E 420 GPa" in html
    drawing = picture_of(solution)
    for label in ("x [µm]", "y [µm]", "pressure [GPa]"):
        assert f">{label}</text>" in drawing
    assert len(html) < 60_000


def test_a_notebook_shows_stick_and_slip_and_the_loads_of_bearings() -> None:
    grid = nacre.Grid((48, 48), (2.4e-4, 2.4e-4))
    creep: dict[str, Any] = {"friction": 0.2, "creepage": (1e-4, 0.0), "direction": "+x"}
    rolled = nacre.roll(nacre.Sphere(5e-3), STEEL, grid=grid, load=20.0, **creep)
    drawing = picture_of(rolled)
    assert ">traction over its bound</text>" in drawing
    top = (map_of(rolled) == (253, 231, 37)).all(axis=-1).sum()
    slipping = (rolled.pressure > 0).sum() - rolled.stick.sum()
    assert top == pytest.approx(slipping, abs=0.03 * rolled.pressure.size)
    bearing = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    solution = bearing.solve(force=(1000.0, 0.0, None), model="iso16281")
    assert ">load of each element [N]</text>" in picture_of(solution)


def test_warnings_are_part_of_what_is_printed() -> None:
    grid = nacre.Grid((8, 8), (1e-4, 1e-4))
    with pytest.warns(nacre.NacreWarning, match="cells wide"):
        solution = nacre.solve(nacre.Sphere(5e-3), STEEL, grid=grid, load=1.0)
    assert solution.report.warnings
    for said in solution.report.warnings:
        assert f"warning: {said}" in str(solution)
        assert said in solution._repr_html_()


def test_an_estimate_of_the_error_stands_with_the_figure() -> None:
    solution = nacre.solve(nacre.Sphere(5e-3), STEEL, load=10.0)
    estimate = solution.report.discretisation
    assert estimate is not None
    error = estimate["peak_pressure"]
    assert error is not None
    percent = 100 * error / solution.peak_pressure
    assert table(solution)["peak pressure"].endswith(f"GPa ± {percent:.1g} %")
    # What is prescribed has no error.
    solution = nacre.solve(nacre.Sphere(5e-3), STEEL, approach=6e-7)
    assert table(solution)["approach"] == "600 nm"


def test_a_peak_without_limit_has_no_estimate(tmp_path: Path) -> None:
    with pytest.warns(nacre.NacreWarning, match="sharp edge"):
        solution = nacre.solve(nacre.FlatPunch(1e-4), STEEL, load=10.0)
    estimate = solution.report.discretisation
    assert estimate is not None
    assert estimate["peak_pressure"] is None
    assert estimate["approach"]
    assert solution.report.warning_kinds == ["sharp edge"]
    assert table(solution)["peak pressure"].endswith("(error not known: see the warning)")
    assert "±" in table(solution)["approach"]
    assert nacre.types.Report.from_dict(solution.report.to_dict()) == solution.report
    saved = nacre.load(solution.save(tmp_path / "punch.nc"))
    assert saved.report == solution.report
    assert '"peak_pressure": null' in solution.to_xarray().attrs["discretisation"]


def test_a_large_estimate_is_printed_without_an_exponent() -> None:
    assert rounded(17.3, 1) == "20"
    assert rounded(0.0123, 1) == "0.01"
    assert written(3.53291e-8, "m²") == "35330 µm²"
    grid = nacre.Grid((24, 24), (4e-4, 4e-4))
    with pytest.warns(nacre.NacreWarning, match="sharp edge"):
        solution = nacre.solve(nacre.FlatPunch(1e-4), STEEL, grid=grid, load=10.0)
    assert "e+" not in str(solution)


def test_a_summary_is_a_table_in_a_notebook() -> None:
    solution = nacre.solve(nacre.Sphere(5e-3), COATED, load=10.0)
    summary = solution.stress_summary(yield_stress={0: 1e9})
    html = summary._repr_html_()
    assert html.count("<table>") == html.count("</table>") == 1
    # The verdict is in paragraphs above the table, and an empty line in print; warnings are below.
    assert html.count("<tr>") + html.count("<p>") == len(str(summary).splitlines()) - 1
    assert "safety factor" in html
    assert "layers[0], 0 m to 2 µm" in html
    for value, _ in (summary.layers[0].von_mises, summary.interfaces[0].shear):
        assert f">{written(value, 'Pa')}</td>" in html


def test_a_tension_that_falls_to_nothing_is_zero_and_has_no_place() -> None:
    # The interface is under pressure everywhere: σ_zz rises to 0 far away.
    summary = nacre.solve(nacre.Sphere(5e-3), COATED, load=10.0).stress_summary()
    tension = summary.interfaces[0].tension[0]
    assert 0 < abs(tension) < 1e-8 * summary.layers[0].von_mises[0]
    (line,) = [row for row in str(summary).splitlines() if row.startswith("interfaces[0] at")]
    assert "tension        0 Pa" in line
    assert "-" not in line


def test_results_are_lines_with_prefixes() -> None:
    solution = nacre.solve(nacre.Sphere(5e-3), COATED, load=10.0)
    summary = solution.stress_summary()
    assert f"peak pressure {solution.peak_pressure / 1e9:.6g} GPa" in repr(solution)
    value = written(summary.layers[0].von_mises[0], "Pa")
    assert repr(summary.layers[0]).startswith(
        f"<LayerStress of layers[0]: von Mises {value}, tension "
    )
    assert repr(summary.interfaces[0]).startswith(
        "<InterfaceStress of interfaces[0] at 2 µm: shear "
    )


# Units.

BALL = nacre.solve(nacre.Sphere(5.0), nacre.Elastic(210e3, 0.3), load=10.0)  # N, mm, MPa


def test_units_that_are_set_are_printed() -> None:
    si = nacre.solve(nacre.Sphere(5e-3), STEEL, load=10.0)
    with nacre.display_units("N-mm-MPa"):
        rows = table(BALL)
        assert rows["peak pressure"].startswith(f"{BALL.peak_pressure:.4g} MPa ±")
        assert rows["body"] == "E 210 GPa, ν 0.3"
        # What is too small for mm has another prefix.
        assert rows["approach"].split(" ±")[0] == table(BALL)["approach"].split(" ±")[0]
        assert rows["approach"].startswith(f"{si.approach * 1e9:.4g} nm")
        assert " mm" in rows["contact"].split(" ×")[0]
        assert rows["moment"] == "(0 N mm, 0 N mm)"
        assert " MPa" in repr(BALL)
        assert " MPa" in str(BALL.stress_summary())
    # The library's numbers are the same.
    assert float(table(si)["peak pressure"].split()[0]) == pytest.approx(
        BALL.peak_pressure / 1e3, rel=1e-3
    )


def test_units_are_restored_and_hold_until_the_next_call() -> None:
    nacre.display_units("N-mm-MPa")
    try:
        assert written(1000.0, "Pa") == "1000 MPa"
        with nacre.display_units("mN-µm-GPa"):
            assert written(5.0, "m") == "5 µm"
            assert written(2.0, "Pa") == "2 GPa"
        with suppress(ZeroDivisionError), nacre.display_units("lbf-in-psi"):
            assert written(4e5, "Pa") == "400000 psi"
            assert written(2e-5, "m") == "2e-05 in"
            _ = 1 / 0
        assert written(1000.0, "Pa") == "1000 MPa"
        nacre.display_units("SI")
        assert written(1000.0, "Pa") == "1 kPa"
    finally:
        nacre.display_units("SI")


def test_a_notebook_shows_the_units_that_were_set() -> None:
    with nacre.display_units("SI"):
        assert repr(nacre.display_units("N-mm-MPa")) == "numbers are in N, mm, MPa"
        assert repr(nacre.display_units("SI")) == "numbers are in N, m, Pa"


@pytest.mark.parametrize("name", ["N-mm-Pa", "mm-N-MPa", "N-mm", "N-mm-bar", "", "SI-SI-SI"])
def test_units_that_are_not_consistent_are_refused(name: str) -> None:
    with pytest.raises(ValueError, match=r"^units must be .*got "):
        nacre.display_units(name)
    with pytest.raises(ValueError, match=r"^units must be .*got None"):
        nacre.display_units(None)  # type: ignore[arg-type]
    assert written(1000.0, "Pa") == "1 kPa"


def test_units_of_a_dataset_are_its_own() -> None:
    assert Scale.in_unit(2000.0, "MPa") == Scale(1e-3, "GPa")
    assert Scale.in_unit(2.0, "mm²").unit == "mm²"
    assert Scale.in_unit(0.002, "rad") == Scale(1e3, "mrad")
    assert Scale.in_unit(2e3, "parsec") == Scale(1.0, "parsec")
    with nacre.display_units("N-mm-MPa"):
        assert Scale.in_unit(2e9, "Pa") == Scale(1e-6, "MPa")
        assert Scale.in_unit(0.5, "mm") == Scale(1.0, "mm")
        assert Scale.in_unit(3.0, "N/mm") == Scale(1.0, "N/mm")
    assert size_of("kN mm") == ("N m", 1.0)
    assert size_of("1/m") is None


def test_units_that_are_set_are_in_tables_and_files(tmp_path: Path) -> None:
    ball, steel = nacre.Sphere(5.0), nacre.Elastic(210e3, 0.3)
    case = {"shape": ball, "body": steel}
    study = nacre.sweep(case, {"load": [1.0, 2.0]}, store=tmp_path / "a.nc", progress=False)
    with nacre.display_units("N-mm-MPa"):
        # The journal knows the cases: units are no part of what they are.
        before = (tmp_path / "a.journal").read_bytes()
        again = nacre.sweep(case, {"load": [1.0, 2.0]}, store=tmp_path / "a.nc", progress=False)
        assert (tmp_path / "a.journal").read_bytes() == before
        assert BALL.to_xarray().pressure.attrs["units"] == "MPa"
        BALL.save(tmp_path / "a.csv")
        BALL.save(tmp_path / "ball.nc")
        assert design.load_curve(ball, steel, [1.0, 2.0]).stiffness.attrs["units"] == "N/mm"
    assert again.peak_pressure.attrs["units"] == "MPa"
    assert study.peak_pressure.attrs["units"] == "Pa"
    assert again.peak_pressure.values.tobytes() == study.peak_pressure.values.tobytes()
    heading = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()[0]
    assert heading == "along,x [mm],y [mm],pressure [MPa],gap [mm],displacement [mm]"
    assert nacre.load(tmp_path / "ball.nc") == BALL


def test_a_study_of_lines_has_loads_and_areas_per_length() -> None:
    grid = nacre.Grid.line(64, 4e-4)
    case = {"shape": nacre.Cylinder(5e-3), "body": STEEL, "grid": grid, "load": 5e4}
    outputs = ["load", "moment", "contact_area", "peak_pressure"]
    study = nacre.sweep(case, {}, outputs=outputs, progress=False)
    units = [study[name].attrs["units"] for name in outputs]
    assert units == ["N/m", "N", "m", "Pa"]
    steel, grid = nacre.Elastic(210e3, 0.3), nacre.Grid.line(64, 0.4)
    with nacre.display_units("N-mm-MPa"):
        curve = design.load_curve(nacre.Cylinder(5.0), steel, [50.0], grid=grid)
    assert curve["load"].attrs["units"] == "N/mm"
    assert curve.stiffness.attrs["units"] == "MPa"


def test_a_history_prints_0_where_a_force_is_rounding() -> None:
    """Forces of 0 are met to rounding of the largest force of the history."""
    grid = nacre.Grid((30, 30), (2.4e-4, 2.4e-4))
    steps: list[Any] = [{"force": (0.0, 0.0)}, {"force": (2.0, 0.0)}, {"force": (0.0, 0.0)}]
    bodies: list[Any] = [nacre.Sphere(5e-3), nacre.Elastic(210e9, 0.3), nacre.Elastic(115e9, 0.33)]
    loop = nacre.slide(*bodies, steps=steps, load=10.0, friction=0.3, grid=grid)
    _, first, pulled, back = (line.split("  ") for line in str(loop).splitlines()[:4])
    assert [cell.strip() for cell in first if cell][1:5] == ["0 N", "0 N", "0 m", "0 m"]
    assert [cell.strip() for cell in pulled if cell][1:3] == ["2 N", "0 N"]
    assert [cell.strip() for cell in back if cell][1:3] == ["0 N", "0 N"]


LONG = ["element", "load inner [N]", "a heading of many words [MPa]", "x"]


@pytest.mark.parametrize("columns", [40, 60, 80, 137])
def test_lines_and_tables_are_no_wider_than_the_terminal(
    columns: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    text = "Lives 14 200 h ± 0.16 %, L10r 1280 million revolutions; " * 4 + "10 000 h required"
    cells = [[str(j), *(f"{j * 1e3:.0f} ± 1 %" for _ in range(9))] for j in range(3)]
    heads = [LONG[0], *(f"{LONG[1 + k % 3]} {k}" for k in range(9))]
    with display.wrapped():
        lines, rows = display.wrap(text), display.aligned([heads, *cells])
    assert max(map(len, [*lines, *rows])) <= columns
    assert " ".join(" ".join(lines).split()) == text  # nothing is lost
    assert not [line for line in lines if re.match(r" *(000|200) h", line)]
    words = " ".join(rows).split()
    assert [words.count(f"{j * 1000}") for j in (1, 2)] == [9, 9]
    blocks = "\n".join(rows).split("\n\n")
    assert all(block.splitlines()[-1].split()[0] == "2" for block in blocks)


def test_tables_that_fit_and_prints_of_python_are_not_wrapped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    rows = [LONG, ["0", "10", "20", "30"]]
    with display.wrapped():
        assert len(display.aligned(rows)) == 2
    assert len(display.aligned([[*LONG, *LONG], ["1"] * 8])) == 2
    assert display.wrap("a word " * 30) == ["a word " * 30]


@pytest.mark.parametrize("values", [(0.0, 2e-6), (1e-4, 2e-7), (0.0, 0.0)])
def test_components_have_one_unit_and_zeros_that_of_the_case(values: tuple[float, float]) -> None:
    with display.shown_in("N-mm-MPa"):
        first, second = display.pair(values, "m").strip("()").split(", ")
    assert first.split()[1] == second.split()[1]
    assert first.split()[1] in ("mm", "µm")
