"""Histories and creep curves are Datasets; pictures show their numbers, with units on the axes."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.quiver import Quiver, QuiverKey

import nacre
import results
from bodies import BALL, HELD, STEEL
from nacre import plot
from nacre._tools.units import Scale, written
from results import CELLS, CONTACT, solved
from support import assert_close

SOLVED = {name: solved(name) for name in results.FRICTION if "not" not in name}
every = pytest.mark.parametrize("kind", SOLVED)


# Studies of histories and creep.


def test_a_history_is_a_dataset() -> None:
    loop = CONTACT.slide(BALL, [{"force": (f, None)} for f in (2.0, -2.0)], **HELD)
    study = nacre.friction.history(loop)
    for name in ("force", "shift", "torque", "dissipated", "twist"):
        np.testing.assert_array_equal(study[name], [getattr(s, name) for s in loop])
    units = {
        **{"load": "N", "force": "N", "torque": "N m", "dissipated": "J", "stick_share": "1"},
        **{"convolutions": "1", "shift": "m", "twist": "rad"},
        **{"approach": "m", "tangential_energy": "J"},
    }
    assert {name: study[name].units for name in units} == units
    share = [s.stick.sum() / np.count_nonzero(s.pressure) for s in loop]
    assert study.stick_share.values.tolist() == share
    assert nacre.friction.history([SOLVED["apart"]]).stick_share.item() == 0
    rolls = nacre.friction.history([SOLVED["rolled"]])
    np.testing.assert_array_equal(rolls.creepage, [SOLVED["rolled"].creepage])
    assert (rolls.dissipated.units, "shift" in rolls) == ("J/m", False)
    assert nacre.friction.history([SOLVED["line slid"]]).force.units == "N/m"


@pytest.mark.filterwarnings("ignore:the creepage is 0.1")
@pytest.mark.parametrize("direction", ["+x", "-x", "+y", "-y"])
@pytest.mark.parametrize("lateral", [False, True])
def test_a_creep_curve_counts_along_and_across_rolling(direction: str, lateral: bool) -> None:
    grid = nacre.Grid((40, 40), (2.4e-4, 2.4e-4))
    keywords: dict[str, Any] = {**HELD, "direction": direction, "grid": grid}
    creepages = [1e-4, 1e-1]
    curve = nacre.friction.creep_curve(
        BALL, STEEL, STEEL, creepages=creepages, lateral=lateral, **keywords
    )
    # All slips at the second one. Surfaces deform by 5e-3 of the length, at which the slip of each
    # cell differs from the creepage; that takes 3e-3 of the power on these cells.
    first, other = ("lateral", "longitudinal") if lateral else ("longitudinal", "lateral")
    assert curve[f"{first}_force"].values[1] == pytest.approx(3.0, rel=1e-5)
    assert 0.1 < curve[f"{first}_force"].values[0] < 0.2
    # 1e-3 of the force: slip turns aside where nu is not 0.
    assert_close(curve[f"{other}_force"], 0, atol=3e-3)
    assert curve.traction_ratio.values[1] == pytest.approx(1.0, rel=1e-5)
    assert curve.stick_share.values[1] == 0
    assert curve.power_over_speed.values[1] == pytest.approx(1e-1 * 3.0, rel=4e-3)
    assert curve.creepage.long_name == f"{first} creepage"


@pytest.mark.parametrize("wrong", [{"friction": 0.0}, {"load": None, "approach": -1e-6}])
def test_without_friction_or_contact_there_is_no_ratio(wrong: dict[str, Any]) -> None:
    curve = nacre.friction.creep_curve(
        BALL, STEEL, STEEL, creepages=[1e-3], grid=CELLS, direction="+x", **HELD | wrong
    )
    assert np.isnan(curve.traction_ratio.item())
    assert curve.longitudinal_force.item() == 0


# Pictures.


@every
def test_the_picture_has_units_on_its_axes(kind: str) -> None:
    axes = SOLVED[kind].plot()
    axes.figure.canvas.draw()
    if "line" in kind:
        assert axes.get_xlabel() == "y [µm]"
        assert axes.get_ylabel() == "traction [MPa]"
        solution, scale = SOLVED[kind], Scale.of(float(SOLVED[kind].bound.max()), "Pa")
        drawn = {line.get_label(): line for line in axes.lines}["traction along y"]
        assert_close(np.asarray(drawn.get_ydata()), scale.factor * solution.traction[1, 0])
    else:
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("x [µm]", "y [µm]")
        (mesh,) = (c for c in axes.collections if hasattr(c, "get_coordinates"))
        states: Any = np.ma.filled(np.ma.asarray(mesh.get_array()), -1).reshape(36, 40).T
        np.testing.assert_array_equal(states == 0, SOLVED[kind].stick)
        slips = (SOLVED[kind].pressure > 0) & ~SOLVED[kind].stick
        np.testing.assert_array_equal(states == 1, slips)
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()][-2:] == ["sticks", "slips"]


def test_pictures_go_into_given_axes() -> None:
    _, axes = plt.subplots()
    assert SOLVED["slid"].plot(axes) is axes
    assert SOLVED["slid"].plot(axes=axes) is axes
    with pytest.raises(TypeError, match="axes must be axes of Matplotlib, got 'here'"):
        plot.friction(SOLVED["line slid"], "here")  # type: ignore[arg-type]


def test_a_loop_and_a_creep_curve_show_their_numbers() -> None:
    loop: Any = CONTACT.slide(BALL, [{"force": (f, None)} for f in (2.0, -2.0, 2.0)], **HELD)
    axes: Axes = plot.loop(loop)
    axes.figure.canvas.draw()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("shift along x [nm]", "force along x [N]")
    shown = np.asarray(axes.lines[-1].get_xydata())
    assert_close(shown, [(1e9 * s.shift[0], s.force[0]) for s in loop])
    for along in ("z", 0, None):
        with pytest.raises(ValueError, match="along must be 'x' or 'y', got"):
            plot.loop(loop, along)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="must be steps of sliding, got one of rolling"):
        plot.loop([SOLVED["rolled"]])
    curve = nacre.friction.creep_curve(
        BALL, STEEL, STEEL, creepages=[1e-4, 1e-3], grid=CELLS, direction="+x", **HELD
    )
    axes = plot.creep_curve(curve)
    assert axes.get_xlabel() == "longitudinal creepage [10⁻³]"
    assert axes.get_ylabel() == "force over friction times load"
    shown = np.asarray(axes.lines[-1].get_xydata())
    assert_close(shown[:, 0], [0.1, 1.0])
    assert_close(shown[:, 1], curve.traction_ratio)
    axes = plot.creep_curve(curve, quantity="longitudinal_force")
    assert axes.get_ylabel() == "longitudinal force [N]"
    assert_close(axes.lines[-1].get_ydata(), curve.longitudinal_force)
    with pytest.raises(ValueError, match=r"quantity must be one of longitudinal_force, .* got 'x'"):
        plot.creep_curve(curve, quantity="x")


@pytest.mark.parametrize(("direction", "drawn"), [("+x", (1, 0)), ("-y", (0, -1))])
def test_an_arrow_shows_where_it_rolls_and_another_the_scale(
    direction: Any, drawn: tuple[int, int]
) -> None:
    solution = CONTACT.roll(BALL, **HELD, creepage=(1e-3, None), direction=direction)
    axes = solution.plot()
    (arrow,) = (text for text in axes.texts if getattr(text, "arrow_patch", None))
    way = np.subtract(arrow.xy, arrow.get_position())
    assert_close(way / np.abs(way).max(), drawn, rtol=0, atol=1e-12)
    (key,) = (child for child in axes.get_children() if isinstance(child, QuiverKey))
    (arrows,) = (child for child in axes.get_children() if isinstance(child, Quiver))
    largest = np.nanmax(np.hypot(np.ma.filled(arrows.U, np.nan), np.ma.filled(arrows.V, np.nan)))
    assert key.text.get_text() == written(float(largest), "Pa", 3)
    assert largest <= np.hypot(*solution.traction).max()
