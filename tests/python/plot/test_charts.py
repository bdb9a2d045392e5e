"""Charts hold the numbers of results; each drawer puts them where its axes say."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

import matplotlib.pyplot as plt
import numpy as np
import pytest

import nacre
from bodies import BALL, HELD, ROD, STEEL, coated
from nacre import plot
from nacre.plot.drawer import draw
from nacre.results import svg
from nacre.results.charts import (
    Axis,
    Chart,
    Curve,
    Look,
    Map,
    contact_charts,
    enlarged_depth,
    section,
)
from results import CONTACT, solved
from support import assert_close

X = np.array([0.0, 1e-3, 2e-3])
Y = np.array([1e9, 3e9, 2e9])
SIDES = Axis("x", "m"), Axis("p", "Pa")


def chart(*looks: Look, **changes: Any) -> Chart:
    """Return a chart with a curve of each look, each twice as high as the one before."""
    curves = [Curve(X, 2**k * Y, f"{look} {k}", look) for k, look in enumerate(looks)]
    return Chart("", curves, SIDES)._replace(**changes)


def svg_of(picture: Chart) -> ElementTree.Element:
    return ElementTree.fromstring(svg.drawing(picture))


def heights(picture: Chart) -> list[list[float]]:
    """Return how high the points of each line of SVG are."""
    return [
        [-float(pair.split(",")[1]) for pair in line.get("points", "").split()]
        for line in svg_of(picture).iter("polyline")
    ]


# What charts hold.


def test_thin_layers_alone_are_enlarged() -> None:
    assert enlarged_depth([], 1.0) == 0
    assert enlarged_depth([0.1, 0.5], 1.0) == 0
    assert enlarged_depth([0.01, 0.09, 0.5], 1.0) == pytest.approx(0.27)


def test_a_chart_of_wear_has_a_section_of_each_state_through_the_deepest_in_the_end() -> None:
    history = nacre.wear(BALL, STEEL, load=10.0, rate=1e-16, sliding=1.0, steps=2)
    chart = history._depth_chart()
    depths = [state.depth + state.counter_depth for state in history.states]
    _, j = np.unravel_index(int(depths[-1].argmax()), depths[-1].shape)
    assert [curve.label for curve in chart.curves] == ["0 m", "500 mm", "1 m"]
    for curve, depth in zip(chart.curves, depths, strict=True):
        np.testing.assert_array_equal(curve.y, depth[:, j])
    assert chart.curves[-1].y.max() == history.deepest[-1].sum()
    assert_close(chart.axes[1].ends, (1.05 * history.deepest[-1].sum(), 0.0))
    axes = plot.wear(history)
    assert len(axes.lines) == len(depths)
    assert [one.caption for one in history._charts()][-1] == chart.caption


def test_a_chart_of_a_loop_has_all_steps() -> None:
    loop = CONTACT.slide(BALL, [{"force": (None, f)} for f in (2.0, -2.0)], **HELD)
    (picture,) = [one for one in loop._sections().pictures if "all steps" in one.caption]
    (line,) = ElementTree.fromstring(picture.drawing).iter("polyline")
    assert len(line.get("points", "").split()) == len(loop)
    assert "force along y [N]" in picture.drawing


def test_charts_of_a_contact_have_all_its_cells_where_they_are() -> None:
    solution = solved("both coated, tilted")
    along_x, along_y, cells = contact_charts(solution)
    i, j = np.unravel_index(solution.pressure.argmax(), solution.pressure.shape)
    for chart, line in ((along_x, solution.pressure[:, j]), (along_y, solution.pressure[i])):
        assert isinstance(chart, Chart)
        (curve,) = chart.curves
        assert curve.y.sum() == pytest.approx(line.sum(), rel=1e-12)
        loaded = np.flatnonzero(curve.y)
        assert loaded[0] == curve.y.size - 1 - loaded[-1] > 0  # as far beyond on both sides
    assert isinstance(cells, Map)
    assert np.nansum(cells.values) == pytest.approx(solution.pressure.sum(), rel=1e-12)
    assert np.isnan(cells.values[[0, -1]]).all()
    assert np.isnan(cells.values[:, [0, -1]]).all()
    place = np.unravel_index(np.nanargmax(cells.values), cells.values.shape)
    for axis, number, count, due in zip(
        cells.axes, place, cells.values.shape, (solution.x[i], solution.y[j]), strict=False
    ):
        low, high = axis.ends or (0.0, 0.0)
        assert low + (number + 0.5) * (high - low) / count == pytest.approx(due)


@pytest.mark.parametrize("kind", ["ball", "rod"])
def test_a_section_falls_to_nothing_at_the_edge(kind: str) -> None:
    """Hertz's contact of half-width a ends between two cells."""
    modulus = STEEL.young / (1 - STEEL.poisson**2)
    if kind == "ball":
        half = (0.75 * 20.0 * 5e-3 / modulus) ** (1 / 3)
        solution = nacre.solve(BALL, STEEL, load=20.0, max_cells=4096)
    else:
        half = np.sqrt(4 * 1e5 * 5e-3 / (np.pi * modulus))
        solution = nacre.solve(ROD, STEEL, load=1e5, grid=nacre.Grid.line(cells=128, width=6e-4))
    edge = solution.stress_plan().edge
    for axis in (1,) if kind == "rod" else (0, 1):
        x, pressure = section(solution, axis, edge)
        inside = np.abs(x) < 0.999 * half
        assert np.all(np.diff(x) > 0)
        assert np.all((pressure > 0) == inside)
        ends = np.flatnonzero(inside)[[0, -1]] + (-1, 1)
        assert_close(x[ends], half * np.array([-1, 1]), rtol=1e-3)  # a cell is 5 % of a, 9 % here
        x, pressure = section(solution, axis)
        assert set(x) < {*solution.x, *solution.y}


# The drawer of Matplotlib.


def test_matplotlib_draws_a_chart_with_the_units_of_its_axes() -> None:
    axes = draw(chart("line", "points", marks=[1e-3], title="above"))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x [mm]", "p [GPa]")
    assert axes.get_title(loc="left") == "above"
    line, points, mark = axes.lines
    assert_close(line.get_xydata(), np.transpose([1e3 * X, 1e-9 * Y]))
    assert (points.get_linestyle(), points.get_marker()) == ("None", "o")
    assert_close(mark.get_xdata(), [1.0, 1.0])
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["line 0", "points 1"]
    assert axes.get_ylim()[0] == 0


def test_matplotlib_gives_a_thin_curve_the_colour_of_that_before() -> None:
    axes = draw(chart("solid", "thin", "solid", "thin"))
    colours = [line.get_color() for line in axes.lines]
    assert colours[0] == colours[1] != colours[2] == colours[3]
    assert {line.get_linestyle() for line in axes.lines} == {"-"}
    draw(chart("solid"), axes)
    assert axes.lines[-1].get_color() not in colours


def test_a_later_chart_in_the_same_axes_is_in_the_picture() -> None:
    axes = draw(chart("line"))
    draw(chart("line", curves=[Curve(X, 10 * Y)]), axes)
    assert axes.get_ylim()[1] > 30


def test_matplotlib_draws_the_inset_beside_a_new_figure_only() -> None:
    inset = chart("line", inset=(0.0, 1e-6))
    whole, beside = draw(inset).figure.axes
    assert beside.get_xlim() == pytest.approx((0.0, 1.0))
    assert beside.get_xlabel() == "x [µm]"
    assert beside.get_ylim() == whole.get_ylim()
    _, axes = plt.subplots()
    assert draw(inset, axes).figure.axes == [axes]


def test_matplotlib_draws_ends_and_logarithmic_axes() -> None:
    depth = Axis("depth", "m", (3e-6, 0.0))
    assert draw(chart("line", axes=(SIDES[0], depth))).get_ylim() == pytest.approx((3.0, 0.0))
    axes = draw(chart("line", axes=(Axis("x"), Axis("y", scale="log"))))
    assert (axes.get_xscale(), axes.get_yscale()) == ("linear", "log")


# The drawer of SVG; `results/test_report.py` has where curves, insets, bars and cells lie.


def test_svg_gives_a_thin_curve_the_colour_of_that_before() -> None:
    groups = [group.get("class") for group in svg_of(chart("solid", "thin", "line")).iter("g")]
    assert [name for name in groups if name] == ["c0", "c0", "c1"]


def test_svg_marks_points_of_a_curve() -> None:
    picture = svg_of(chart("marked"))
    assert len([*picture.iter("circle")]) == len(X)
    assert len([*picture.iter("polyline")]) == 1
    assert not [*svg_of(chart("points")).iter("polyline")]


def test_svg_draws_equal_factors_equally_high_on_a_logarithmic_axis() -> None:
    curve = Curve(X, np.array([0.5, 5.0, 50.0]))
    picture = chart(curves=[curve], axes=(Axis("x"), Axis("y", scale="log")))
    ((low, middle, high),) = heights(picture)
    assert middle - low == pytest.approx(high - middle, abs=0.2)
    texts = {text.text for text in svg_of(picture).iter("text")}
    assert {"1", "10"} <= texts


def test_svg_draws_curves_up_to_the_end_between_two_points() -> None:
    part = chart("line", axes=(Axis("x", "m", (0.0, 1.5e-3)), SIDES[1]))
    (line,) = svg_of(part).iter("polyline")
    last = line.get("points", "").split()[-1].split(",")
    assert float(last[0]) == svg.WIDTH - svg.RIGHT
    ((bottom, top, end),) = heights(part)
    assert end - bottom == pytest.approx(0.75 * (top - bottom), abs=0.2)  # 2.5 of 1 to 3 GPa


def test_svg_turns_an_axis_with_its_ends() -> None:
    down = chart("line", axes=(SIDES[0], Axis("p", "Pa", (3e9, 0.0))))
    ((first, second, _),) = heights(down)
    assert second < first
    texts = {text.text for text in svg_of(down).iter("text")}
    assert {"0", "1", "2", "3"} <= texts


def test_svg_grades_colours_as_matplotlib_does() -> None:
    graded = chart("graded", "graded", "graded")
    groups = svg_of(graded).iter("g")
    strokes = [stroke for group in groups if (stroke := group.get("stroke"))]
    for stroke, line in zip(strokes, draw(graded).lines, strict=True):
        colour: Any = line.get_color()
        red, green, blue = (int(stroke[-6:][k : k + 2], 16) / 255 for k in (0, 2, 4))
        assert_close([red, green, blue], colour[:3], atol=0.03)


def test_many_labels_of_svg_stand_beside_each_other() -> None:
    def top(count: int) -> float:
        curves = [Curve(X, Y, f"curve {k}") for k in range(count)]
        (frame,) = svg_of(chart(curves=curves)).iter("rect")
        return float(frame.get("y", ""))

    assert top(4) == svg.TOP + 4 * svg.LINE
    assert top(8) < top(4)


def test_both_drawers_enlarge_the_same_coats() -> None:
    grid = nacre.Grid.line(96, 3e-4)
    solution = nacre.solve(nacre.Cylinder(5e-3), coated(420e9, 1e-6), load=1e5, grid=grid)
    summary = nacre.fatigue.assess(solution)
    (picture,) = summary._charts()
    assert_close(picture.inset, (0.0, 3e-6))
    assert len(plot.fatigue_depth(summary).figure.axes) == 2
    assert svg_of(picture).find("svg") is not None
