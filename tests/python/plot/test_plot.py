"""Pictures show the numbers of the solution, in the units that their axes name."""

from __future__ import annotations

import itertools
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
import pytest
import xarray
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.markers import CARETDOWN
from matplotlib.quiver import Quiver
from matplotlib.text import Text

import nacre
import support
from bodies import BALL, ROD, STEEL
from bodies import coated as layered
from nacre import design, plot
from nacre._tools.units import Scale, written
from support import assert_close, errors, table

Array = npt.NDArray[np.float64]
ROLLER = nacre.Roller(5e-3, 8e-3, 2.0)
LONG = nacre.Grid((96, 24), (14e-3, 3e-4))


@pytest.fixture(scope="module")
def tilted() -> nacre.Solution:
    return nacre.solve(ROLLER, STEEL, grid=LONG, load=1e3, eccentricity=(1e-3, None))


@pytest.fixture(scope="module")
def ball() -> nacre.Solution:
    return nacre.solve(BALL, STEEL, load=100.0)


@pytest.fixture(scope="module")
def line() -> nacre.Solution:
    return nacre.solve(ROD, STEEL, grid=nacre.Grid.line(64, 4e-4), load=5e4)


@pytest.fixture(scope="module")
def nothing() -> nacre.Solution:
    return nacre.solve(BALL, STEEL, grid=LONG, approach=-1e-6)


def curve_of(axes: Axes) -> tuple[Array, Array]:
    """Return what the last curve shows."""
    data = np.asarray(axes.lines[-1].get_xydata(), dtype=np.float64)
    return data[:, 0], data[:, 1]


def drawn(figure: Any) -> None:
    """Draw for real: what is off the page or cannot be laid out would warn or raise here."""
    assert isinstance(figure, Figure)
    figure.canvas.draw()


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (1.46806e9, "Pa", "1.468 GPa"),
        (999.99, "Pa", "1000 Pa"),
        (1000.0, "Pa", "1 kPa"),
        (-2.5e-6, "m", "-2.5 µm"),
        (3e4, "m", "30000 m"),
        (1.243e-6, "m²", "1.243 mm²"),
        (3.53e-8, "m²", "35300 µm²"),
        (0.0, "N", "0 N"),
        (0.5, "", "0.5"),
        (1.141e12, "Pa", "1141 GPa"),
        (5e-13, "m", "0.5 pm"),
        # No prefix beside an exponent.
        (1e-20, "m", "1e-20 m"),
        (1e16, "Pa", "1e+16 Pa"),
    ],
)
def test_numbers_have_sensible_prefixes(value: float, unit: str, text: str) -> None:
    assert written(value, unit) == text


def test_a_scale_turns_si_into_the_unit_it_names() -> None:
    assert Scale.of(2e-3, "m") == Scale(1e3, "mm")
    assert Scale.of(2e-6, "m²") == Scale(1e6, "mm²")
    assert Scale.of(5e9, "Pa") == Scale(1e-9, "GPa")


def test_the_overview_has_map_sections_and_numbers(tilted: nacre.Solution) -> None:
    axes = tilted.plot()
    assert sorted(axes) == ["map", "numbers", "x", "y"]
    assert axes["map"].get_xlabel() == "x [mm]"
    assert axes["map"].get_ylabel() == "y [µm]"
    assert "different scales" in axes["map"].get_title(loc="left")
    (image,) = axes["map"].images
    values: Array = np.ma.filled(image.get_array(), 0.0).T  # type: ignore[arg-type]
    left, right, bottom, top = image.get_extent()
    inside = [
        (low < scale * places) & (scale * places < high)
        for scale, places, low, high in (
            (1e3, tilted.x, left, right),
            (1e6, tilted.y, bottom, top),
        )
    ]
    assert_close(values, 1e-9 * tilted.pressure[np.ix_(*inside)], rtol=1e-12)
    assert values.sum() == pytest.approx(1e-9 * tilted.pressure.sum(), rel=1e-12)
    said = " ".join(text.get_text() for text in axes["numbers"].texts)
    assert written(tilted.peak_pressure, "Pa") in said
    drawn(axes["map"].figure)


def test_the_map_of_a_round_contact_is_true_to_scale(ball: nacre.Solution) -> None:
    axes = plot.pressure_map(ball)
    assert axes.get_aspect() == 1.0
    assert axes.get_xlabel() == "x [µm]"
    half = 0.5 * (ball.contact_extent[0][1] - ball.contact_extent[0][0])
    assert 1e6 * half < axes.get_xlim()[1] < 1.5e6 * half


def test_the_cross_marks_where_the_force_acts(tilted: nacre.Solution) -> None:
    axes = plot.pressure_map(tilted)
    assert curve_of(axes)[0] == pytest.approx(1.0, rel=1e-6)  # mm; the balance of moments is 1e-8


def test_a_section_is_a_row_of_cells(tilted: nacre.Solution) -> None:
    axes = tilted.plot_section("x")
    x, pressure = curve_of(axes)
    j = int(np.argmax(tilted.pressure.max(axis=0)))
    assert_close(x, 1e3 * tilted.x, rtol=1e-12)
    assert_close(pressure, 1e-9 * tilted.pressure[:, j], rtol=1e-12)
    assert axes.get_ylabel() == "pressure [GPa]"
    axes = tilted.plot_section("y", at=2e-3, quantity="gap")
    i = int(np.argmin(np.abs(tilted.x - 2e-3)))
    gap = curve_of(axes)[1]
    assert_close(gap, 1e6 * tilted.gap[i], rtol=1e-12)
    assert axes.get_ylabel() == "gap [µm]"
    axes = tilted.plot_section("x", quantity="line_load")
    assert axes.get_ylabel() == "line load [kN/m]"
    drawn(axes.figure)


def test_axes_are_taken_and_returned(tilted: nacre.Solution, ball: nacre.Solution) -> None:
    figure, (left, right) = plt.subplots(1, 2)
    assert tilted.plot_section(axes=left) is left
    assert plot.compare({"a": ball, "b": tilted}, axes=right) is right
    assert ball.plot(left) == {"map": left}
    mosaic = plt.figure().subplot_mosaic([["y", "map"]])
    assert ball.plot(mosaic) == mosaic
    solid = plt.figure().add_subplot(projection="3d")
    assert ball.plot_3d(solid) is solid
    assert plt.get_fignums() == [1, 2, 3]
    drawn(figure)


def test_a_comparison_names_each_curve_and_its_peak(ball: nacre.Solution) -> None:
    other = nacre.solve(BALL, STEEL, load=200.0)
    axes = plot.compare({"100 N": ball, "200 N": other}, "y")
    legend = axes.get_legend()
    assert legend is not None
    labels = [text.get_text() for text in legend.get_texts()]
    peaks = [written(s.peak_pressure, "Pa", 3) for s in (ball, other)]
    assert labels == [f"100 N (peak {peaks[0]})", f"200 N (peak {peaks[1]})"]
    looks = {(line.get_color(), line.get_linestyle()) for line in axes.lines}
    assert len(looks) == 2  # by colour and by dashes
    assert len(plot.compare([ball, other]).lines) == 2
    drawn(axes.figure)


def test_the_relief_shows_the_peak(tilted: nacre.Solution) -> None:
    axes = tilted.plot_3d()
    assert axes.get_zlabel() == "pressure [GPa]"
    assert axes.get_zlim()[1] >= 0.99e-9 * tilted.peak_pressure
    drawn(axes.figure)


def test_the_interactive_view_holds_the_pressure(tilted: nacre.Solution) -> None:
    plotter = plot.view(tilted, show=False)
    drawn_pressure = plotter.meshes[0].point_data["pressure [GPa]"]
    assert drawn_pressure.max() == 1e-9 * tilted.peak_pressure
    plotter.close()


def test_a_line_contact_has_one_section(line: nacre.Solution) -> None:
    axes = line.plot()
    assert sorted(axes) == ["numbers", "y"]
    drawn(axes["y"].figure)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")
def test_no_text_is_cut_off() -> None:
    half = 7e-3
    coat = nacre.Layer(nacre.Elastic(230e9, 0.22), 2.5e-6, name="DLC")
    body = nacre.HalfSpace(STEEL, [coat], ends=(-half, half))
    roller = nacre.Roller(5e-3, profile=nacre.LogarithmicProfile.iso16281(10e-3, 2 * half))
    grid = nacre.Grid((48, 32), (2 * half, 5e-4))
    solution = nacre.solve(roller, STEEL, body, load=6e3, tilt=(3e-4, None), grid=grid)
    axes = [*solution.plot().values(), plot.stress_section(solution, body="counterbody")]
    for one in axes:
        drawn(one.figure)
        frame = one.figure.bbox
        written_out = {text.get_text() for text in one.texts} | {one.get_title(loc="left")}
        for text in (text for text in one.findobj(Text) if text.get_text() in written_out):
            assert text.get_window_extent().x1 <= frame.x1, text.get_text()


def test_without_contact_there_is_a_picture_that_says_so(nothing: nacre.Solution) -> None:
    axes = nothing.plot()
    assert "nothing touches" in axes["map"].get_title(loc="left")
    drawn(axes["map"].figure)
    drawn(nothing.plot_3d().figure)


@pytest.fixture(scope="module")
def chart() -> Any:
    lists: Any = {"thickness": [1e-5, 5e-5, 2e-4], "young": [1e11, 2e11, 4e11]}
    return design.coating_chart(BALL, STEEL, load=10.0, tolerance=1e-4, **lists)


@pytest.mark.slow
@pytest.mark.parametrize("quantity", ["peak_pressure", "coating_tension", "interface_shear"])
def test_a_chart_has_units_and_levels_within_its_frame(chart: Any, quantity: str) -> None:
    axes = plot.chart(chart, quantity)
    drawn(axes.figure)
    assert axes.get_xlabel() == "thickness [µm]"
    assert axes.get_xscale() == "log"
    assert axes.get_ylabel() == "Young's modulus of the coating [GPa]"
    if quantity != "peak_pressure":
        highest = axes.collections[0].get_clim()[1]
        assert highest == pytest.approx(1e-6 * chart[quantity].max().item(), rel=0.2)  # levels
    frame = axes.get_window_extent()
    boxes = [text.get_window_extent() for text in axes.texts]
    assert len(boxes) >= 4
    for box in boxes:
        assert frame.x0 < box.x0 < box.x1 < frame.x1
        assert frame.y0 < box.y0 < box.y1 < frame.y1


def test_contours_of_a_chart_are_smooth_over_sides_as_they_are_drawn() -> None:
    """ln²x + ln²y on intervals of 0.8: straight lines between the values miss by 0.8²/2 = 0.32."""
    side = np.linspace(0.0, 4.0, 6)
    field = side[:, None] ** 2 + side[None, :] ** 2
    places = {name: (name, np.exp(side), {"units": "1"}) for name in ("first", "second")}
    values = {"peak_pressure": (("first", "second"), field, {"units": "1"})}
    axes = plot.chart(xarray.Dataset(values, places))
    lines = axes.collections[1]
    assert isinstance(lines, ContourSet)
    curves = [
        (level, points)
        for level, parts in zip(lines.levels, lines.allsegs, strict=True)
        for points in parts
        if len(points)
    ]
    assert len(curves) >= 6
    for level, points in curves:
        assert abs((np.log(points) ** 2).sum(axis=1) - level).max() < 0.16


@pytest.mark.slow
def test_a_curve_has_units_and_bars_of_its_errors(chart: Any) -> None:
    curve = design.load_curve(BALL, STEEL, [10.0, 20.0, 30.0], tolerance=1e-4)
    axes = plot.curve(curve, "stiffness")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("load [N]", "stiffness [MN/m]")
    x, y = curve_of(axes)
    np.testing.assert_array_equal(x, curve["load"])
    assert_close(y, 1e-6 * curve.stiffness, rtol=1e-12)
    both: Any = plot.curve(chart, "peak_pressure")
    lines = [line for line in both.lines if len(line.get_ydata()) > 1]
    assert len(both.get_legend().get_texts()) == len(chart.peak_pressure)
    for line, values in zip(lines, chart.peak_pressure.values, strict=True):
        assert_close(line.get_ydata(), 1e-9 * values, rtol=1e-12)
    # The estimated errors are bars of a curve, and stand in the label of a chart.
    axes = plot.curve(curve, "approach")
    (container,) = axes.containers
    drawn(axes.figure)
    heights = [0.5 * np.ptp(bar[:, 1]) for bar in container[2][0].get_segments()]
    errors = abs(curve.approach_discretisation.values)
    assert_close(heights, 1e6 * errors, rtol=1e-6)
    assert (errors > 0).all()
    share = 100 * (abs(chart.peak_pressure_discretisation) / chart.peak_pressure).max().item()
    label = plot.chart(chart).figure.axes[1].get_ylabel()
    assert label == f"peak pressure [GPa], ± {share:.2g} % at most"


def test_colours_differ_in_lightness_for_those_who_see_no_hue() -> None:
    # The first three, which most pictures need: by luminance, as a grey copy shows them.
    weights = np.array([0.2126, 0.7152, 0.0722])
    colours = [np.array(mpl.colors.to_rgb(c)) for c in plot.style.COLOURS[:3]]
    greys = sorted(float(weights @ c**2.2) for c in colours)
    assert min(np.diff(greys)) > 0.05


@pytest.fixture(scope="module")
def coated() -> nacre.Solution:
    body = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(420e9, 0.25), 30e-6)])
    grid = nacre.Grid((61, 51), (5e-4, 4e-4))
    return nacre.solve(BALL, body, grid=grid, load=20.0)


def meshes(axes: Axes) -> list[QuadMesh]:
    return [child for child in axes.collections if isinstance(child, QuadMesh)]


@pytest.mark.parametrize("quantity", ["von_mises", "xx", "tension"])
def test_a_stress_section_shows_the_stress(coated: nacre.Solution, quantity: str) -> None:
    axes = plot.stress_section(
        coated, quantity, along="y", at=1e-5, rows=12, friction=0.2, direction=(1.0, 0.0)
    )
    drawn(axes.figure)
    (mesh,) = meshes(axes)
    shown = np.asarray(mesh.get_array(), dtype=np.float64)
    edges = np.asarray(mesh.get_coordinates())[:, 0, 1] / 1e6
    assert 30e-6 in edges.round(12)
    depths = 0.5 * (edges[1:] + edges[:-1])
    field = coated.stress(depths, x=1e-5, friction=0.2, direction=(1.0, 0.0))
    values = field.principal[0] if quantity == "tension" else getattr(field, quantity)
    assert axes.get_ylim()[1] == 0.0
    assert_close(shown, values / 1e9, atol=1e-9)
    title = axes.get_title(loc="left")
    assert written(float(values.max()), "Pa", 3) in title
    assert "the cross marks the largest value" in title


@pytest.mark.parametrize("at", [0.0, 5e-5])
def test_triangles_mark_the_edge_of_the_contact(ball: nacre.Solution, at: float) -> None:
    radius = (0.75 * 100.0 * 5e-3 * (1 - STEEL.poisson**2) / STEEL.young) ** (1 / 3)
    axes = plot.stress_section(ball, along="y", at=at, rows=6)
    drawn(axes.figure)
    (triangles,) = (line for line in axes.lines if line.get_marker() == CARETDOWN)
    half = 1e6 * np.sqrt(radius**2 - at**2)
    assert_close(np.asarray(triangles.get_xdata()), [-half, half], rtol=1e-3)
    assert not np.any(triangles.get_ydata())


def test_curves_over_depth_hold_both_sides_of_an_interface(coated: nacre.Solution) -> None:
    axes = plot.stress_depth(coated, ["xx"], depth=90e-6, points=12)
    drawn(axes.figure)
    curve = np.asarray(axes.lines[0].get_xydata(), dtype=np.float64)
    (rows,) = np.nonzero(np.abs(curve[:, 0] - 30.0) < 1e-9)
    assert rows.size == 2
    for row, side in zip(rows, ("above", "below"), strict=True):
        value = coated.stress(30e-6, x=0.0, y=0.0, side=side).xx  # type: ignore[arg-type]
        assert curve[row, 1] == pytest.approx(float(value) / 1e9)
    assert axes.get_xlim() == pytest.approx((0.0, 90.0))


def test_a_thin_coat_is_enlarged_in_a_new_figure() -> None:
    grid = nacre.Grid((32, 32), (4e-4, 4e-4))
    thin = nacre.solve(BALL, layered(420e9, 1e-6), load=10.0, grid=grid)
    enlarged = plot.stress_section(thin, rows=12).figure.axes[1]
    drawn(enlarged.figure)
    assert enlarged.get_ylim() == pytest.approx((3.0, 0.0))
    curves, enlarged = plot.stress_depth(thin, ["xx"], points=12).figure.axes
    drawn(enlarged.figure)
    assert enlarged.get_xlim() == pytest.approx((0.0, 3.0))
    depths, _ = np.asarray(enlarged.lines[0].get_xydata()).T
    assert (depths < 3.0).sum() >= 8
    given = plot.stress_depth(thin, ["xx"], points=12, axes=curves)
    assert given.figure.axes == [curves, enlarged]


def test_an_interface_map_shows_the_traction(coated: nacre.Solution) -> None:
    field = coated.stress(30e-6, friction=0.1, direction=(1.0, 0.0))
    axes = plot.interface_map(coated, friction=0.1, direction=(1.0, 0.0))
    drawn(axes.figure)
    (mesh,) = meshes(axes)
    shear = np.hypot(field.xz, field.yz).T / 1e6
    assert_close(np.asarray(mesh.get_array()), shear, rtol=1e-9)
    (arrows,) = (child for child in axes.collections if isinstance(child, Quiver))
    places = [
        np.searchsorted(1e6 * side, xy - 1e-6)
        for side, xy in ((coated.x, np.asarray(arrows.X)), (coated.y, np.asarray(arrows.Y)))
    ]
    assert_close(arrows.U, field.xz[*places])
    assert_close(arrows.V, field.yz[*places])
    axes = plot.interface_map(coated, quantity="normal", friction=0.1, direction=(1.0, 0.0))
    (mesh,) = meshes(axes)
    assert_close(np.asarray(mesh.get_array()), field.zz.T / 1e9, rtol=1e-9)


def test_what_is_long_is_drawn_out_of_scale_and_says_so(coated: nacre.Solution) -> None:
    body = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(420e9, 0.25), 30e-6)])
    roller = nacre.solve(ROLLER, body, grid=LONG, load=1e3)
    for axes, unit, height in (
        (plot.stress_section(roller, rows=6, depth=90e-6), "z [µm]", 90.0),
        (plot.interface_map(roller), "y [µm]", None),
    ):
        assert axes.get_aspect() == "auto"
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("x [mm]", unit)
        assert axes.get_title(loc="left").endswith("to different scales")
        assert height is None or axes.get_ylim()[0] == pytest.approx(height)
        edges = np.asarray(meshes(axes)[0].get_coordinates())[0, :, 0]
        assert (edges[0], edges[-1]) == pytest.approx((-7.0, 7.0))  # mm
        drawn(axes.figure)
    for axes in (plot.stress_section(coated, rows=6), plot.interface_map(coated)):
        assert axes.get_aspect() == 1.0
        assert "scales" not in axes.get_title(loc="left")


def test_stress_of_lines_and_of_nothing_can_be_drawn(
    line: nacre.Solution, nothing: nacre.Solution
) -> None:
    for axes in (
        plot.stress_section(line, along="y", rows=6),
        plot.stress_depth(line, points=6),
        plot.stress_section(nothing, rows=4),
        plot.stress_depth(nothing, points=4),
    ):
        drawn(axes.figure)


CURVE = "design.load_curve(BALL, STEEL, [10.0], tolerance=1e-4)"


WRONG = {
    "plot.section(tilted, 'z')": "along must be 'x' or 'y', got 'z'",
    "plot.section(tilted, quantity='force')": "quantity must be one of .*, got 'force'",
    "plot.section(tilted, 'y', quantity='line_load')": "along must be 'x' for the line load",
    "plot.section(tilted, at=1.0)": r"at must lie on the grid, -0\.00015 to 0\.00015, got 1",
    "tilted.plot({'z': plt.figure().add_subplot()})": "axes must be named map, x, y or "
    "numbers, got 'z'",
    "plot.compare([])": "at least one solution",
    f"plot.chart({CURVE}, 'approach')": "quantity must depend on 2 parameters",
    f"plot.curve({CURVE}, 'force')": "quantity must be one of .*, got 'force'",
    "plot.stress_section(coated, 'pressure')": r"^quantity must be one of xx, .*, got "
    "'pressure'$",
    "plot.stress_section(coated, along='z')": r"^along must be 'x' or 'y', got 'z'$",
    "plot.stress_depth(coated, depth=-1.0)": r"^depth must be finite and above 0, got -1$",
    "plot.stress_depth(coated, [])": r"^quantities must hold at least one name",
    "plot.stress_depth(coated, points=0)": r"^the number of depths must be at least 1, got 0$",
    "plot.interface_map(coated, 1)": r"^interface must be from 0 to 0, got 1$",
    "plot.interface_map(coated, quantity='xx')": r"^quantity must be 'shear' or 'normal', "
    "got 'xx'$",
    "plot.interface_map(ball)": r"^a solution must have layers for a map of an interface",
    "plot.interface_map(line)": r"^the grid of a solution must have cells along x",
    "plot.pressure_map(line)": "must have cells along x",
    "plot.relief(line)": "must have cells along x",
}


@table(*errors(ValueError, WRONG))
def test_bad_arguments_are_named(
    call: str, kind: type[Exception], words: str, request: pytest.FixtureRequest
) -> None:
    needed = [name for name in ("tilted", "coated", "ball", "line") if name in call]
    made = {name: request.getfixturevalue(name) for name in needed}
    support.refused(call, kind, words, {"plot": plot, "plt": plt, "design": design} | made)


def test_settings_of_the_user_stay(ball: nacre.Solution) -> None:
    # A backend that is loaded by the first figure may switch the interactive mode on.
    before = dict(mpl.rcParams)
    with plot.style.styled():
        mpl.rcParams["interactive"] = not before["interactive"]
    assert mpl.rcParams["interactive"] is not before["interactive"]
    mpl.rcParams["interactive"] = before["interactive"]
    assert dict(mpl.rcParams) == before


def test_an_outline_is_thinner_than_what_it_surrounds(ball: nacre.Solution) -> None:
    def width(axes: Axes) -> float:
        (outline,) = (c for c in axes.collections if isinstance(c, ContourSet))
        return float(np.ravel(outline.get_linewidth())[0])

    assert width(plot.pressure_map(ball)) == plot.style.THICKEST
    # A ball with ridges, 60 µm from one to the next, on a map of 1 mm.
    x = np.linspace(-5e-4, 5e-4, 256)
    ridges = np.broadcast_to(2e-6 * np.cos(2 * np.pi * x / 6e-5)[:, np.newaxis], (256, 256))
    surface = nacre.HeightMap(np.ascontiguousarray(ridges), spacing=(1e-3 / 256, 1e-3 / 256))
    with pytest.warns(nacre.NacreWarning, match="the spots that carry the load"):
        rough = nacre.solve(nacre.Sphere(5e-2) + surface, STEEL, load=100.0)
    axes = plot.pressure_map(rough)
    patch = 72 * axes.get_window_extent().width / axes.figure.dpi * 16 / 256  # a whole ridge [pt]
    assert 0 < width(axes) < patch / 6


def test_curves_of_one_picture_differ(tilted: nacre.Solution) -> None:
    axes = tilted.plot_section("y")
    axes.axhline(0.1)  # a line of the user's own does not count
    tilted.plot_section("y", at=2e-3, axes=axes)
    first, _, second = axes.lines
    assert [first.get_color(), second.get_color()] == list(plot.style.COLOURS[:2])
    curve = design.tilt_curve(ROLLER, STEEL, [0.0, 1e-4], load=1e3, grid=LONG, tolerance=1e-4)
    axes = plot.curve(curve, "moment")
    plot.curve(curve, "moment", axes)
    assert axes.get_xlabel() == "tilt [µrad]"
    assert curve_of(axes)[0].tolist() == [0.0, 100.0]
    first, second = axes.lines
    assert first.get_color() != second.get_color()


def test_axes_of_a_user_s_own_sweep_have_units() -> None:
    study = nacre.sweep(
        {"shape": nacre.Sphere(5e-3), "body": STEEL, "tolerance": 1e-4},
        {"load": [1.0, 10.0, 100.0, 1e3, 1e4]},
        outputs=["peak_pressure"],
        progress=False,
    )
    axes = plot.curve(study, "peak_pressure")
    assert (axes.get_xlabel(), axes.get_xscale()) == ("load [N]", "log")
    drawn(axes.figure)
    labels = [label for label in axes.get_xticklabels() if label.get_text()]
    boxes = [label.get_window_extent() for label in labels]
    assert len(boxes) >= 3
    assert all(left.x1 < right.x0 for left, right in itertools.pairwise(boxes))


def test_axes_carry_the_units_that_are_set() -> None:
    steel = nacre.Elastic(210e3, 0.3)  # MPa
    body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e3, 0.3), 0.02)])
    solution = nacre.solve(nacre.Sphere(5.0), body, load=100.0)
    si = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
    study = design.load_curve(BALL, si, load=[10.0, 20.0])
    with nacre.display_units("N-mm-MPa"):
        axes = plot.section(solution, "x")
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("x [mm]", "pressure [MPa]")
        assert curve_of(axes)[1].max() == solution.peak_pressure
        assert plot.stress_depth(solution, points=4).get_ylabel() == "stress [MPa]"
        # A Dataset has units of its own, whatever is set.
        axes = plot.curve(study, "peak_pressure")
        assert axes.get_ylabel() == "peak pressure [MPa]"
        assert_close(curve_of(axes)[1], study.peak_pressure / 1e6, rtol=1e-12)
    assert plot.curve(study, "peak_pressure").get_ylabel() == "peak pressure [GPa]"
