"""Pictures of bearings show what the solutions hold."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

from nacre import plot
from nacre.bearing import (
    AngularContactBall,
    CylindricalRoller,
    DeepGrooveBall,
    Pair,
    SphericalRoller,
)
from support import assert_close

ROLLERS = CylindricalRoller(
    count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3, clearance=41e-6
)
STANDARD = ROLLERS.solve(force=(4450.0, 0.0, None), tilt=(None, 6e-4), model="iso16281")


def test_bars_are_the_loads() -> None:
    axes = plot.load_distribution(STANDARD)
    bars: list[Any] = list(axes.patches)
    heights = [bar.get_height() for bar in bars]
    assert_close(heights, STANDARD.loads[:, 0] / 1e3)  # kN
    fast = ROLLERS.solve(force=(4450.0, 0.0, None), speed=600.0, model="iso16281")
    both = plot.load_distribution(fast)
    bars = list(both.patches)
    assert_close([bar.get_height() for bar in bars], fast.loads.T.ravel() / 1e3)
    texts: Any = both.get_legend()
    assert [text.get_text() for text in texts.get_texts()] == ["inner ring", "outer ring"]


def test_each_row_and_ring_has_its_bars() -> None:
    """Two rows, of which the second carries more; bars stand about the angle of their element."""
    sizes: dict[str, Any] = {"count": 15, "diameter": 10e-3, "length": 9e-3}
    sizes |= {"pitch_diameter": 60e-3, "contact_angle": 0.2, "profile_radius": 32e-3}
    barrels = SphericalRoller(**sizes)
    solution = barrels.solve(force=(1e4, 0.0, 1e3), speed=600.0, model="iso16281")
    rows = solution.loads.reshape(2, 15, 2)
    assert rows[1].sum() != pytest.approx(rows[0].sum(), rel=0.1)
    bars: list[Any] = list(plot.load_distribution(solution).patches)
    heights = np.reshape([bar.get_height() for bar in bars], (2, 2, 15))
    assert_close(heights, rows.transpose(0, 2, 1) / 1e3)
    middles = np.reshape([bar.get_x() + bar.get_width() / 2 for bar in bars], (4, 15))
    assert_close(middles.mean(axis=0), solution.angles[:15], atol=1e-9)
    assert_close(np.diff(middles, axis=0), bars[0].get_width(), rtol=1e-9)


def test_curves_are_the_pressures_and_alike_elements_share_one() -> None:
    axes = plot.elements_pressure(STANDARD)
    assert STANDARD.lamina_pressures is not None
    labels = [str(line.get_label()) for line in axes.lines]
    assert [label.partition(" (")[0] for label in labels] == [
        "element 0",
        "elements 1, 13",
        "elements 2, 12",
    ]
    drawn: Any = axes.lines[0].get_ydata()
    assert_close(drawn, STANDARD.lamina_pressures[0, 0] / 1e9)
    solved = ROLLERS.solve(force=(4450.0, 0.0, None), cells=(40, 24))
    contact = solved.contact(0, "outer")
    assert contact is not None
    axes = plot.elements_pressure(solved, [0], ring="outer")
    drawn = axes.lines[0].get_ydata()
    assert_close(drawn, contact.pressure.max(1) / 1e9)


def test_parts_can_be_drawn_into_given_axes() -> None:
    figure = plt.figure()
    polar = figure.add_subplot(projection="polar")
    assert plot.bearing(STANDARD, polar) == {"loads": polar}
    with pytest.raises(ValueError, match="axes must be named loads and pressure, got 'map'"):
        plot.bearing(STANDARD, {"map": polar})
    with pytest.raises(ValueError, match='ring must be "inner" or "outer"'):
        plot.elements_pressure(STANDARD, ring="middle")  # type: ignore[arg-type]
    ball = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    drawn = plot.bearing(ball.solve(force=(1e3, 0.0, None), model="iso16281"))
    assert drawn["pressure"].get_title(loc="left") == "peak pressures, Hertz"
    unloaded = ball.solve(displacement=(0.0, 0.0, 0.0), model="iso16281")
    assert sorted(plot.bearing(unloaded)) == ["loads", "pressure"]


def test_labels_of_loads_lie_on_white_above_the_bars() -> None:
    axes = plot.load_distribution(STANDARD)
    assert [text.get_text() for text in axes.texts] == [f"{tick:g}" for tick in axes.get_yticks()]
    for text in axes.texts:
        box: Any = text.get_bbox_patch()
        assert box.get_facecolor() == (1.0, 1.0, 1.0, 1.0)
        assert text.get_zorder() > max(bar.get_zorder() for bar in axes.patches)


def test_both_bearings_of_a_pair_are_drawn(tmp_path: Path) -> None:
    ball = AngularContactBall(count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4)
    pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
    solution = pair.solve(force=(500.0, 0.0, 300.0), model="iso16281")
    panels = solution.plot()
    for name, one in zip(("first", "second"), solution.bearings, strict=True):
        bars: list[Any] = list(panels[f"{name} loads"].patches)
        assert_close([bar.get_height() for bar in bars], one.loads[:, 0])  # at rest
        title = panels[f"{name} pressure"].get_title(loc="left")
        assert title == f"{name} bearing, peak pressures, Hertz"
    assert solution.save(tmp_path / "pair.png").stat().st_size > 10_000
