"""Histories of wear at the face of Python: arguments, events, files, pictures, refusals."""

from __future__ import annotations

import csv
import sys
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import nacre
from nacre.results.charts import Chart
from support import assert_close, interrupted

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
DLC = nacre.Elastic(young=300e9, poisson=0.25)
COATED = nacre.HalfSpace(STEEL, layers=[nacre.Layer(DLC, thickness=2e-6, name="DLC")])
ROLLER = nacre.Cylinder(10e-3)
GRID = nacre.Grid.line(64, 6e-4)
LINE: dict[str, Any] = {"load": 1e5, "grid": GRID, "rate": {0: 1e-17, "substrate": 1e-15}}

# Two steps are enough for what is asked here, and their pressures err.


def worn(**keywords: Any) -> nacre.types.WearHistory:
    """Return a short history of a coated roller."""
    return nacre.wear(ROLLER, COATED, **{**LINE, "sliding": 100.0, "steps": 2, **keywords})


def test_worn_volume_is_that_of_the_law() -> None:
    history = worn(counter_rate=3e-18)
    due = np.outer(history.distance, [1e-17, 3e-18]) * 1e5
    # Sums of 64 cells.
    assert_close(history.volume, due, rtol=1e-12)
    assert history.life is None
    assert history.verdict().words.startswith("No layer is worn through")


@pytest.mark.filterwarnings("ignore:the worn layer counts as thick")
def test_the_coat_is_through_in_the_middle_and_the_verdict_says_when() -> None:
    history = worn(sliding=5e4, steps="auto", until="through")
    life = history.life
    assert life is not None
    assert (life.layer, life.body) == ("layers[0] DLC", "body")
    assert abs(life.position[1]) < GRID.spacing[1]
    assert history.distance[-1] == life.distance
    assert history.deepest[-1, 0] == pytest.approx(2e-6, rel=1e-5)
    assert history.verdict().words.startswith("Worn through after ")
    assert history.verdict().lines[0].startswith("First worn through: DLC of the body, at y = ")
    with pytest.warns(nacre.NacreWarning, match="a layer is worn through"):
        further = worn(sliding=1.2 * life.distance, steps=3, scheme="euler")
    assert further.life is not None
    # Three steps are late, and say so.
    late = further.life.distance - life.distance
    assert life.uncertainty is not None
    assert further.life.uncertainty is not None
    assert life.uncertainty < 1e-2 * life.distance
    assert 0 < late < further.life.uncertainty + life.uncertainty < 20 * late
    assert further.report.thickness_error is not None
    share = further.life.uncertainty / further.life.distance + further.report.thickness_error
    assert f" ± {100 * share:.2g} %." in further.verdict().words
    assert further.distance[-1] > further.life.distance


@pytest.mark.slow
def test_a_history_goes_on_and_comes_back_from_files(tmp_path: Path) -> None:
    whole = worn(steps=4, scheme="euler")
    half = worn(sliding=50.0, scheme="euler")
    rest = worn(sliding=50.0, scheme="euler", initial=half)
    assert_close(rest.distance, whole.distance, rtol=1e-14)
    # Solves to 1e-8, in whose energy the pressure counts squared.
    assert_close(rest.peak_pressure, whole.peak_pressure, rtol=1e-4, each=True)
    assert nacre.load(whole.save(tmp_path / "wear.nc")) == whole
    assert nacre.types.WearHistory.from_dict(whole.to_dict()) == whole
    for ending in (".csv", ".html", ".png"):
        assert whole.save(tmp_path / f"wear{ending}").stat().st_size > 0
    assert whole.animate(tmp_path / "wear.gif").stat().st_size > 0


def test_a_store_is_gone_on_from(tmp_path: Path) -> None:
    store = tmp_path / "store.nc"
    stopped = worn(steps=4, store=store, progress=lambda state: state.distance < 40)
    assert not stopped.report.converged
    assert len(stopped) == 3
    went_on = worn(steps=4, store=store)
    assert_close(went_on.distance, [0, 25, 50, 75, 100], rtol=1e-14)
    assert nacre.load(store) == went_on


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"grid": nacre.Grid.line(64, 7e-4)}, "store must be a history on the same grid"),
        ({"slip": np.full((1, 64), 0.5)}, "store must be a history of the same slip"),
        ({"scheme": "trapezoidal"}, "store must be a history of the same scheme"),
        ({"thickness": "first order"}, "store must be a history of the same thickness"),
        ({"sliding": 200.0}, "same sliding, 200.0, got 100.0"),
    ],
)
def test_a_store_of_something_else_is_refused(
    tmp_path: Path, keywords: dict[str, Any], message: str
) -> None:
    same: dict[str, Any] = {"store": tmp_path / "store.nc", "scheme": "euler"}
    worn(**same)
    with pytest.raises(ValueError, match=message):
        worn(**{**same, **keywords})


def test_a_history_goes_on_from_a_layer_that_is_through() -> None:
    """A depth beyond the coat is an event at 0; of a history, events come once, at its distance."""
    depth = np.full(GRID.shape, 3e-6)
    with pytest.warns(nacre.NacreWarning, match="a layer is worn through"):
        begun = worn(initial=depth, until="through")
    with pytest.warns(nacre.NacreWarning, match="a layer is worn through"):
        further = worn(initial=begun, until="through", sliding=10.0, scheme="euler")
    assert [event.distance for event in begun.events] == [0.0]
    # What was asked is answered, and nothing is required.
    assert begun.verdict().level == "unknown"
    assert begun.verdict().words == "Worn through from the start."
    failing = begun.verdict(required_distance=1.0)
    assert (failing.level, failing.factor) == ("bad", 0.0)
    assert failing.words == "Worn through from the start, 1 m required: too soon."
    assert list(begun.distance) == [0.0]
    assert further.events == begun.events
    assert list(further.distance) == [0.0, 5.0, 10.0]


@pytest.mark.filterwarnings("ignore:the contact is only 4 cells")
@pytest.mark.filterwarnings("ignore:a layer is worn through")
@pytest.mark.parametrize("below", [0.0, 1e-17, 1e-15])
def test_even_pressure_is_through_a_coat_at_the_exact_distance(below: float) -> None:
    """2 µm at 1e-17 m²/N and 100 MPa take 2000 m, whatever is below; half of it in one history."""
    grid = nacre.Grid((4, 8), (1e-3, 2e-3), periodic=(True, True))
    flat = nacre.HeightMap(np.zeros((4, 8)), grid.spacing, periodic=(True, True))
    rate = {"DLC": 1e-17, "substrate": below}
    keywords: dict[str, Any] = {"load": 200.0, "grid": grid, "rate": rate}
    first = nacre.wear(flat, COATED, sliding=1000.0, steps=1, **keywords)
    for steps in ("auto", 4):
        history = nacre.wear(flat, COATED, sliding=5e3, steps=steps, initial=first, **keywords)
        assert history.life is not None
        assert history.life.distance == pytest.approx(2000.0, rel=1e-5)
        assert nacre.types.WearHistory.from_dict(history.to_dict()).life == history.life


def test_nothing_presses_at_the_end_of_an_approach() -> None:
    with pytest.warns(nacre.NacreWarning, match="nothing presses any more at this approach"):
        history = nacre.wear(ROLLER, STEEL, approach=1e-6, grid=GRID, rate=1e-15, sliding=1e9)
    assert len(history) < 200
    # What the roller overlaps of the flat is worn off: 4/3 δ √(2Rδ).
    due = 4 / 3 * 1e-6 * np.sqrt(2 * 10e-3 * 1e-6)
    assert history.worn_volume == pytest.approx(due, rel=0.01)


def test_a_history_on_another_grid_is_refused() -> None:
    with pytest.raises(ValueError, match="initial must be a history on the same grid"):
        worn(initial=worn(), grid=nacre.Grid.line(64, 7e-4))


def test_fretting_wears_where_it_slips() -> None:
    grid = nacre.Grid((32, 32), (3e-4, 3e-4))
    contact = nacre.Contact(STEEL, grid, STEEL)
    cycle: dict[str, Any] = {
        "friction": 0.6,
        "steps": [{"force": (one, None)} for one in (3.0, -3.0)],
    }
    ball = nacre.Sphere(5e-3)
    history = contact.wear(ball, load=10.0, rate=1e-14, cycles=100.0, slide=cycle, steps=1)
    loop = contact.slide(ball, load=10.0, **cycle | {"steps": cycle["steps"] * 2})
    assert isinstance(loop, nacre.types.History)
    slip = sum(np.hypot(*step.slip) for step in loop[2:])
    worn_depth = history.states[-1].depth
    assert worn_depth[16, 16] < 1e-6 * worn_depth.max()
    assert np.corrcoef(worn_depth.ravel(), (slip * loop[0].pressure).ravel())[0, 1] > 0.99


@pytest.mark.parametrize(
    ("steps", "message"),
    [
        # The second time, the roller is where it was.
        ([{"shift": (None, 1e-6)}], "slip only in the first cycle, and nothing is worn"),
        # The pressure of the outermost cells carries a thousandth of the load.
        ([{"force": (None, f)} for f in (3.0, -3.0)], "no cell slips in the steps of slide"),
    ],
)
def test_cycles_that_wear_nothing_are_warned_of(steps: Any, message: str) -> None:
    contact = nacre.Contact(STEEL, nacre.Grid.line(129, 3.4e-4), STEEL)
    cycle: dict[str, Any] = {"friction": 0.6, "steps": steps}
    keywords: dict[str, Any] = {"load": 1e5, "rate": 1e-16, "cycles": 1e6, "slide": cycle}
    for choice in ("auto", 1):
        with pytest.warns(nacre.NacreWarning, match=message) as caught:
            history = contact.wear(ROLLER, steps=choice, **keywords)
        assert len(caught) == 1
        assert len(history.warnings) == 1
        # Rounding of displacements is 1e-16 of them, some 1e-21 m.
        assert history.deepest.max() < 1e-16


def test_a_rate_in_the_wrong_unit_is_warned_of() -> None:
    """1e-8 mm³/(N m) of DLC given as m²/N, and half of the limit of 1 mm³/(N m)."""
    keywords: dict[str, Any] = {"sliding": 1e-9, "steps": 1, "scheme": "euler"}
    match = r"^rate is in m²/N, and 1e-08 m²/N are 10 mm³/\(N m\), more"
    with pytest.warns(nacre.NacreWarning, match=match) as caught:
        history = worn(rate={0: 1e-8, "substrate": 1e-15}, **keywords)
    assert len(caught) == 1
    assert history.warnings == (str(caught[0].message),)
    match = "^counter_rate is in m²/N, and 1.5e-09"
    with pytest.warns(nacre.NacreWarning, match=match):
        worn(counter_rate=1.5e-9, **keywords)
    assert worn(counter_rate=0.5e-9, **keywords).warnings == ()


def test_bounds_of_rates_are_physical_in_any_units() -> None:
    """1e-9 mm³/(N m) are 1e-18 m²/N and 1e-12 mm²/N; a roller in millimetres and megapascals."""
    steel = nacre.Elastic(young=210e3, poisson=0.3)
    keywords: dict[str, Any] = {"load": 100.0, "grid": nacre.Grid.line(64, 0.6), "sliding": 1.0}
    keywords |= {"shape": nacre.Cylinder(10.0), "body": steel, "steps": 1}
    with nacre.display_units("N-mm-MPa"):
        assert nacre.wear(rate=1.1e-12, **keywords).warnings == ()
        assert nacre.wear(rate=0.9e-3, **keywords | {"sliding": 1e-9}).warnings == ()
        match = r"^rate is in mm²/N, and 9e-13 mm²/N are 9e-10 mm³/\(N m\), less .* is 0.001 mm²/N"
        with pytest.warns(nacre.NacreWarning, match=match):
            nacre.wear(rate=0.9e-12, **keywords)
        with pytest.warns(nacre.NacreWarning, match="rate is in mm²/N, and 0.0011 mm²/N .* more"):
            nacre.wear(rate=1.1e-3, **keywords | {"sliding": 1e-9})
    with pytest.warns(nacre.NacreWarning, match="^counter_rate is in m²/N, and 9e-19 .* less"):
        worn(counter_rate=0.9e-18)


def test_printed_rows_have_one_unit() -> None:
    """1e-17 m²/N of 1e5 N/m over 100 m are 100 µm²."""
    rows = {row.label: row.text for row in worn(counter_rate=1e-18)._rows()}
    assert rows["worn volume"] == "100 µm² of the body, 10 µm² of the counterbody"
    rows = {row.label: row.text for row in worn(sliding=50.0, steps=1)._rows()}
    assert rows["worn volume"] == "50 µm² of the body, 0 µm² of the counterbody"
    assert rows["peak pressure"].count("MPa") == 2


class Film:
    """What a film shows in the end, in place of the film."""

    shown: ClassVar[list[Any]] = []

    def __init__(self, figure: Any, draw: Any, frames: int) -> None:
        self.figure, self.draw, self.frames = figure, draw, frames

    def save(self, path: Path, writer: object) -> None:
        path.write_bytes(b"GIF89a")
        self.draw(self.frames - 1)
        self.shown[:] = [
            (axes.get_ylabel(), axes.lines[0].get_ydata()) for axes in self.figure.axes
        ]


def test_what_is_shown_is_of_both_bodies(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The counterbody wears half as fast as the coat."""
    history = worn(counter_rate=5e-18)
    last = history.states[-1]
    pressure, deepest = last.solution.pressure[0], history.deepest.sum(axis=1)
    depth = (last.depth + last.counter_depth)[0]
    assert_close(depth, 1.5 * last.depth[0])
    axes = history.plot()
    assert axes.get_ylabel() == "depth removed [nm]"
    assert_close(axes.lines[-1].get_ydata(), 1e9 * depth)
    assert_close(axes.lines[-1].get_xdata(), 1e6 * GRID.y)
    monkeypatch.setattr(sys.modules["nacre.plot.wear"], "FuncAnimation", Film)
    history.animate(tmp_path / "a.gif")
    (force, presses), (removed, film) = Film.shown
    assert (force, removed) == ("pressure [MPa]", "depth removed [nm]")
    assert_close(presses, 1e-6 * pressure)
    assert_close(film, 1e9 * depth)
    text = history.save(tmp_path / "a.csv").read_text("utf-8").splitlines()
    heads, *rows = csv.reader(line for line in text if not line.startswith("#"))
    for name, numbers in (("volume", history.volume), ("deepest", history.deepest)):
        for member, which in enumerate(("body", "counterbody")):
            (place,) = [k for k, head in enumerate(heads) if f"{name} {which} [" in head]
            assert [float(row[place]) for row in rows] == numbers[:, member].tolist()
    deepest_chart, peak_chart, *_, depth_chart = history._charts()
    shown = [
        (chart.curves[-1].x, chart.curves[-1].y)
        for chart in (deepest_chart, peak_chart, depth_chart)
        if isinstance(chart, Chart)
    ]
    due = [(history.distance, deepest), (history.distance, history.peak_pressure), (GRID.y, depth)]
    for pair, wanted in zip(shown, due, strict=True):
        np.testing.assert_array_equal(pair, wanted)


@pytest.mark.filterwarnings("ignore:the contact touches the edge of the grid")
def test_a_depth_beyond_the_width_of_the_contact_is_warned_of() -> None:
    """The scar is as wide as the grid b, and κ s W/b deep, but for 1e-2 of that at its rim."""
    keywords: dict[str, Any] = {"load": 1e5, "grid": GRID, "rate": 1e-15, "scheme": "euler"}
    distance = GRID.size[1] ** 2 / (1e-15 * 1e5)
    below = nacre.wear(ROLLER, STEEL, sliding=0.98 * distance, steps=1, **keywords)
    assert not any("wide" in note for note in below.warnings)
    with pytest.warns(nacre.NacreWarning, match="are worn off a contact that is 600 µm wide"):
        nacre.wear(ROLLER, STEEL, sliding=1.02 * distance, steps=1, **keywords)


def test_ctrl_c_ends_a_history() -> None:
    setup = """
import nacre
steel = nacre.Elastic(young=210e9, poisson=0.3)
contact = nacre.Contact(steel, nacre.Grid((128, 128), (4e-4, 4e-4)))
keywords = {"load": 10.0, "rate": 1e-16, "sliding": 1e3, "steps": 10**5}
"""
    call = "contact.wear(nacre.Sphere(5e-3), progress=lambda state: begin.set(), **keywords)"
    assert interrupted(setup, call, at="event") == 0


def test_ctrl_c_ends_a_history_within_a_cycle_of_friction() -> None:
    """After the first state, the slide of a cycle of two thousand steps is solved, twice."""
    setup = """
import nacre
steel = nacre.Elastic(young=210e9, poisson=0.3)
contact = nacre.Contact(steel, nacre.Grid((64, 64), (2e-4, 2e-4)), steel)
steps = [{"force": (force, None)} for force in 10**3 * (1.0, -1.0)]
slide = {"friction": 0.3, "steps": steps}
keywords = {"load": 10.0, "rate": 1e-16, "cycles": 1e3, "steps": 1, "slide": slide}
"""
    call = "contact.wear(nacre.Sphere(5e-3), progress=lambda state: begin.set(), **keywords)"
    assert interrupted(setup, call, at="event") == 0


def test_cells_that_come_into_contact_wear_by_what_passes_them() -> None:
    contact = nacre.Contact(STEEL, nacre.Grid.line(129, 3.4e-4), STEEL)
    steps = [{"force": (None, one)} for one in (3e4, -3e4)]
    cycle: dict[str, Any] = {"friction": 0.6, "steps": steps}
    motion: dict[str, Any] = {"load": 1e5, "rate": 1e-16, "steps": 1, "scheme": "euler"}
    worn_out = contact.wear(ROLLER, cycles=2e7, slide=cycle, **motion).states[-1]
    loop = contact.slide(ROLLER, load=1e5, friction=0.6, steps=steps * 2)
    assert isinstance(loop, nacre.types.History)
    shifts = np.array([step.shift for step in loop])[:, 1, None]
    passed = shifts - np.array([step.displacement[1, 0] for step in loop])
    slip = np.abs(np.diff(passed, axis=0))[1:].sum(axis=0)
    pressure = worn_out.solution.pressure[0]
    joined = (pressure > 0) & (loop[0].pressure[0] == 0)
    assert joined.sum() >= 4
    # Pressures of cells are the springs' to 1e-6 of the peak, and there a twentieth of it.
    due = 1e-16 * 2e7 * (slip * pressure)[joined]
    assert_close(worn_out.depth[0, joined], due, rtol=1e-4, each=True)


def test_a_pass_of_a_wheel_wears_the_whole_track() -> None:
    grid = nacre.Grid((32, 32), (3e-4, 3e-4))
    contact = nacre.Contact(STEEL, grid, STEEL)
    roll: dict[str, Any] = {"friction": 0.3, "creepage": (1e-3, None), "direction": "+x"}
    ball = nacre.Sphere(5e-3)
    history = contact.wear(ball, load=10.0, rate=1e-15, passes=1.0, roll=roll, steps=1)
    wheel = contact.roll(ball, load=10.0, **roll)
    # q·s/μ with the slip s = W − du/dx of central differences, x against the flow of material.
    (q_x, q_y), (u_x, u_y) = wheel.traction, wheel.displacement
    slope_x, slope_y = (np.gradient(u, grid.spacing[0], axis=0) for u in (u_x, u_y))
    work = q_x * (wheel.creepage[0] + slope_x) + q_y * (wheel.creepage[1] + slope_y)
    track = work.sum(axis=0) * grid.spacing[0] / 0.3 * 1e-15
    assert_close(history.states[-1].depth, np.tile(track, (32, 1)), rtol=1e-6)
    # All slip is at μp, and the pass takes it off along the whole grid.
    due = 1e-15 * wheel.dissipated / 0.3 * grid.size[0]
    assert history.volume[-1, 0] == pytest.approx(due, rel=1e-6)


def test_a_large_integer_is_a_distance() -> None:
    with pytest.warns(nacre.NacreWarning):
        history = worn(sliding=10**22, rate=1e-17)
    assert history.distance[-1] == 1e22


def test_thinner_layers_need_layers_that_are_known() -> None:
    response = nacre.Response(lambda k: 2.0 / (210e9 * k))
    keywords: dict[str, Any] = {"load": 1e5, "grid": GRID, "rate": 1e-17, "sliding": 1.0}
    with pytest.raises(ValueError, match='thickness must be "frozen" for a response'):
        nacre.wear(ROLLER, response, thickness="first order", **keywords)
    # A counterbody that does not wear may be one.
    nacre.wear(ROLLER, STEEL, response, thickness="first order", steps=1, **keywords)


def test_a_history_of_another_thickness_is_refused() -> None:
    with pytest.raises(ValueError, match="same thickness, first order, got frozen"):
        worn(initial=worn(), thickness="first order")


def test_the_verdict_on_bodies_without_layers_is_unknown() -> None:
    history = nacre.wear(ROLLER, STEEL, load=1e5, grid=GRID, rate=1e-17, sliding=1.0, steps=1)
    for required in (None, 1.0):
        assert history.verdict(required).level == "unknown"
        assert history.verdict(required).words.startswith("Worn after 1 m: ")
        assert history.verdict(required).question is None


@pytest.mark.parametrize(
    ("required", "level"), [(50.0, "good"), (66.0, "good"), (67.0, "fair"), (100.0, "fair")]
)
def test_a_history_in_which_no_layer_is_through_lasts_at_least_its_distance(
    required: float, level: str
) -> None:
    verdict = worn(steps="auto").verdict(required_distance=required)
    assert verdict.level == level
    assert verdict.factor == pytest.approx(100.0 / required)
    assert verdict.words.startswith(
        f"No layer is worn through after 100 m, {required:g} m required: "
    )
    assert " of 2 µm worn at most." in verdict.words


def test_a_history_that_ends_too_early_tells_nothing_of_a_longer_distance() -> None:
    verdict = worn().verdict(required_distance=120.0)
    assert verdict.level == "unknown"
    assert verdict.words == "Cannot tell: the history ends before the required distance."
    open_verdict = worn().verdict()
    assert open_verdict.level == "unknown"
    assert open_verdict.lines[-1] == "Give a required distance to judge it."
    with pytest.raises(ValueError, match="required_distance must be above 0"):
        worn().verdict(required_distance=0.0)
    apart = worn(load=None, approach=-1e-6)
    for required in (None, 1.0):
        assert apart.verdict(required).level == "unknown"
        assert apart.verdict(required).words == "Cannot tell: nothing has worn."


@pytest.mark.parametrize(
    ("factor", "level"), [(0.9, "bad"), (1.1, "fair"), (1.49, "fair"), (1.6, "good")]
)
def test_the_distance_to_wear_through_is_judged_with_its_error(factor: float, level: str) -> None:
    history = worn(sliding=5e4, steps="auto", until="through")
    life = history.life
    assert life is not None
    assert life.uncertainty is not None
    assert life.uncertainty < 0.01 * life.distance
    verdict = history.verdict(required_distance=life.distance / factor)
    assert verdict.level == level
    assert verdict.factor == pytest.approx(factor)
    assert verdict.words.endswith(" required: too soon." if factor < 1 else " required.")


def test_a_store_of_another_measured_surface_is_refused(tmp_path: Path) -> None:
    """The maps differ where their printed form leaves their heights out."""
    y = np.arange(64.0) - 31.5
    heights = -2e-9 * np.hypot(y[:, None], y) ** 2
    other = heights.copy()
    other[32, 32] += 1e-9
    keywords: dict[str, Any] = {"load": 0.1, "rate": 1e-16, "sliding": 1e-3, "steps": 1}
    store = tmp_path / "store.nc"
    steel = nacre.Contact(STEEL, nacre.Grid((64, 64), (64e-6, 64e-6)))
    map_of_heights = nacre.HeightMap(heights, (1e-6, 1e-6))
    history = steel.wear(map_of_heights, store=store, **keywords)
    assert steel.wear(map_of_heights, store=store, **keywords).states == history.states
    assert len(steel.wear(map_of_heights, initial=history, **keywords)) == 3
    with pytest.raises(ValueError, match="store must be a history of the same shape"):
        steel.wear(nacre.HeightMap(other, (1e-6, 1e-6)), store=store, **keywords)


def test_first_order_thins_the_coat_and_says_how_far_it_holds() -> None:
    """A soft, thick coat; warnings come beyond 40 % of it, and where it is through."""
    rubber = nacre.Elastic(young=1e9, poisson=0.4)
    body = nacre.HalfSpace(STEEL, layers=[nacre.Layer(rubber, thickness=20e-6, name="rubber")])
    contact = nacre.Contact(body, nacre.Grid.line(64, 2e-3))
    keywords: dict[str, Any] = {"load": 1e4, "rate": 1e-15, "steps": 4}
    frozen = contact.wear(ROLLER, sliding=100.0, **keywords)
    first = contact.wear(ROLLER, sliding=100.0, thickness="first order", **keywords)
    # A thinner soft coat gives less: the contact is smaller, and the pressure higher.
    assert first.peak_pressure[-1] > frozen.peak_pressure[-1]
    assert_close(first.volume, frozen.volume, rtol=1e-12)
    assert first.report.thickness_error is not None
    assert frozen.report.thickness_error is not None
    # A part of 0.15 is worn: what is left is of second order.
    assert first.report.thickness_error < 0.3 * frozen.report.thickness_error
    assert "thinner to first order in the depth" in str(first)
    assert "as thick as before" in str(frozen)
    keywords |= {"thickness": "first order", "scheme": "euler"}
    with pytest.warns(nacre.NacreWarning, match="layers count to first order, and .* of one is"):
        contact.wear(ROLLER, sliding=600.0, **keywords)
    with pytest.warns(nacre.NacreWarning, match="lacks it there to first order only"):
        contact.wear(ROLLER, sliding=2000.0, **keywords)


@pytest.mark.filterwarnings("ignore:a body with layers has a free end")
def test_the_error_by_the_thickness_keeps_free_ends() -> None:
    grid = nacre.Grid((24, 24), (4e-4, 4e-4))

    def ended(thickness: float) -> nacre.HalfSpace:
        layers = [nacre.Layer(DLC, thickness)]
        return nacre.HalfSpace(STEEL, layers=layers, ends=(-1.5e-4, None))

    case: dict[str, Any] = {"shape": nacre.Sphere(5e-3), "load": 20.0, "grid": grid}
    depth = np.full(grid.shape, 2e-6)
    history = nacre.wear(**case, body=ended(5e-6), rate=1e-16, sliding=0.0, initial=depth)
    pressure, thin = (
        nacre.solve(**case, body=ended(thickness)).pressure for thickness in (5e-6, 3e-6)
    )
    carries = np.pad((pressure > 0) & (thin > 0), 1, constant_values=True)
    around = np.lib.stride_tricks.sliding_window_view(carries, (3, 3)).all(axis=(2, 3))
    peaks = pressure.max(), thin.max()
    due = max(abs(pressure - thin)[around].max(), abs(peaks[0] - peaks[1])) / min(peaks)
    # Solves to 1e-8, in whose energy the pressure counts squared: 1e-4 of the pressure.
    assert history.report.thickness_error == pytest.approx(due, abs=1e-4)


@pytest.mark.filterwarnings("ignore:the contact is only")
def test_nothing_left_on_a_rigid_base_has_no_error_by_the_thickness() -> None:
    plate = nacre.HalfSpace(nacre.RIGID, layers=COATED.layers)
    with pytest.warns(nacre.NacreWarning, match="a layer is worn through"):
        history = nacre.wear(
            ROLLER,
            plate,
            **(LINE | {"rate": 1e-17, "sliding": 0.0, "initial": np.full(GRID.shape, 3e-6)}),
        )
    assert history.report.thickness_error is None


def test_an_event_that_does_not_settle_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    class Unsettled:
        def __init__(self, *arguments: Any) -> None:
            self.steps = steps(*arguments)

        def __iter__(self) -> Any:
            for *rest, (rings, _), grown in self.steps:
                yield (*rest, (rings, False), grown)

        def thickness_error(self) -> float | None:
            return self.steps.thickness_error()

    steps = nacre._core.wear
    monkeypatch.setattr(nacre._core, "wear", Unsettled)
    with pytest.warns(nacre.NacreWarning, match="did not settle, and a step ends near it"):
        history = worn()
    assert any("did not settle" in note for note in history.warnings)


def test_a_history_says_why_it_has_no_gradient() -> None:
    history = worn()
    with pytest.raises(AttributeError, match="a history of wear has no gradient: take differences"):
        history.gradient("life")  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="object has no attribute 'gradients'"):
        history.gradients  # type: ignore[attr-defined]  # noqa: B018
    assert history.states[-1].solution.gradient("approach")["load"] > 0
