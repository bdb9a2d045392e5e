"""Conductance of contacts: closed forms, other methods, invariants, its error, and bad input."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import nacre
from bodies import quiet
from support import DATA, assert_close

STEEL = nacre.Elastic(210e9, 0.3)
SOFT = nacre.Elastic(1.0, 0.0)
BALL = nacre.Sphere(5e-3)
DISCS = [
    row
    for row in json.loads((DATA / "conductance_disc.json").read_text("utf-8"))["rows"]
    if not any(row["H"])
]
Array = npt.NDArray[np.float64]


def on_cells(
    touches: npt.NDArray[np.bool_], spacing: tuple[float, float], body: Any = SOFT
) -> nacre.Solution:
    """Return a contact of these cells."""
    mask = nacre.HeightMap(np.where(touches, 0.0, -1.0), spacing=spacing)
    size = tuple(n * d for n, d in zip(touches.shape, spacing, strict=True))
    grid = nacre.Grid(touches.shape, size)
    solution: nacre.Solution = quiet(nacre.solve, mask, body, load=1e-9, grid=grid)
    assert (solution.in_contact == touches).all()
    return solution


def stack(thicknesses: list[float]) -> nacre.HalfSpace:
    return nacre.HalfSpace(SOFT, [nacre.Layer(SOFT, h) for h in thicknesses])


def first_kind(m: float) -> float:
    """Return the complete elliptic integral K(m), by means."""
    a, g = 1.0, math.sqrt(1 - m)
    while abs(a - g) > 1e-15:
        a, g = (a + g) / 2, math.sqrt(a * g)
    return math.pi / 2 / a


def ellipse(rng: np.random.Generator) -> tuple[Any, float]:
    """Return the conductance of an ellipse at any place and angle, and its exact resistance.

    K(e)/2πka: Holm, Electric Contacts (1967), §4; e is the eccentricity.
    """
    across, ratio, angle = rng.uniform(3, 24), rng.uniform(0.2, 1), rng.uniform(0, np.pi)
    b = 1.0
    a, d = b / ratio, b / across
    n = int(2.3 * a / d)
    x, y = (((np.arange(n) - n / 2 + 0.5) * d) + d * rng.uniform(-0.5, 0.5) for _ in "xy")
    c, s = math.cos(angle), math.sin(angle)
    u, v = np.add.outer(c * x, s * y), np.add.outer(-s * x, c * y)
    through = on_cells((u / a) ** 2 + (v / b) ** 2 < 1, (d, d)).conductance(
        conductivity=1.0, counter_conductivity=math.inf
    )
    return through, first_kind(1 - ratio**2) / (2 * math.pi * a)


def coated_disc(rng: np.random.Generator) -> tuple[Any, float]:
    """Return the conductance of a disc on layers, at any place, and its resistance."""
    row = DISCS[rng.integers(len(DISCS))]
    n = int(np.exp(rng.uniform(np.log(16), np.log(80))))
    d = rng.uniform(2.2, 3.0) / n
    x, y = (((np.arange(n) - n / 2 + 0.5) * d) + d * rng.uniform(-0.5, 0.5) for _ in "xy")
    touches = np.hypot.outer(x, y) < 1
    base = math.inf if row["k_sub"] == "sink" else row["k_sub"]
    through = on_cells(touches, (d, d), stack(row["h"])).conductance(
        conductivity=[*row["k"], base], counter_conductivity=math.inf
    )
    return through, row["R4k2a"] / 4


def two_spots(rng: np.random.Generator) -> tuple[Any, float]:
    """Return the conductance of two discs, and that of cells a quarter as long."""
    gap, radius, n = rng.uniform(0.1, 1), rng.uniform(0.4, 1), int(rng.uniform(40, 100))
    shift = rng.uniform(-0.5, 0.5, 2)

    def through(count: int) -> Any:
        d = 4.4 / count
        x, y = ((np.arange(count) - count / 2 + 0.5) * d + s * 4.4 / n for s in shift)
        first = np.hypot.outer(x + radius + gap / 2, y) < radius
        second = np.hypot.outer(x - 0.6 - gap / 2, y) < 0.6
        return on_cells(first | second, (d, d)).conductance(
            conductivity=1.0, counter_conductivity=math.inf
        )

    return through(n), through(4 * n).resistance


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "count"), [(ellipse, 240), (coated_disc, 330), (two_spots, 30)])
def test_the_error_holds(kind: Any, count: int) -> None:
    rng = np.random.default_rng(11)
    for _ in range(count):
        through, exact = kind(rng)
        assert abs(through.resistance - exact) < through.uncertainty
        assert through.uncertainty < 0.25 * exact


@pytest.mark.slow
def test_the_error_holds_on_rough_surfaces() -> None:
    """Random surfaces with spots of few cells, on the same points four times as dense."""
    for seed in range(6):
        fine = nacre.rough.random_surface(
            (256, 256), (1e-4, 1e-4), hurst=0.8, shortest=1e-5, longest=5e-5, rms_slope=0.05,
            rng=seed,
        )  # fmt: skip
        grids = [nacre.Grid((n, n), (1e-4, 1e-4), periodic=(True, True)) for n in (128, 256)]
        pair = [nacre.solve(fine, STEEL, STEEL, load=5.0, grid=grid) for grid in grids]
        coarse, dense = (s.conductance(conductivity=46.0, counter_conductivity=46.0) for s in pair)
        assert coarse.per_area
        assert abs(coarse.resistance - dense.resistance) < coarse.uncertainty + dense.uncertainty
        assert coarse.uncertainty < 0.5 * coarse.resistance


def test_layers_of_a_joint_have_their_own_resistance() -> None:
    """Under the mean flux: each thickness over its conductivity."""
    grid = nacre.Grid((32, 32), (1e-4, 1e-4), periodic=(True, True))
    layers = [nacre.Layer(STEEL, 2e-6), nacre.Layer(STEEL, 3e-6)]
    for body, count in ((STEEL, 0), (nacre.HalfSpace(STEEL, layers), 1)):
        joint = quiet(nacre.solve, BALL, body, STEEL, load=0.1, grid=grid)
        through = joint.conductance(
            conductivity=[10.0, 30.0, 46.0] if count else 46.0, counter_conductivity=46.0
        )
        assert through.per_area
        assert str(through).count("of the layers") == count
        if count:
            assert through.layer_resistance is not None
            assert_close(through.layer_resistance, 2e-6 / 10 + 3e-6 / 30, rtol=1e-12)
            alike = joint.conductance(conductivity=46.0, counter_conductivity=46.0)
            assert alike.layer_resistance is not None
            assert_close(alike.layer_resistance, 5e-6 / 46, rtol=1e-12)
    open_contact = coated().conductance(conductivity=[1.0, 2.0, 3.0], counter_conductivity=46.0)
    assert open_contact.layer_resistance is None


def test_lines_count_from_their_datum() -> None:
    """R' = ln(r/b) / (π k) + a constant: Carslaw and Jaeger's strip at one temperature."""
    grid = nacre.Grid.line(2000, 6e-4)
    found = []
    for load in (2e4, 8e4):
        solution = nacre.solve(nacre.Cylinder(1e-2), STEEL, load=load, grid=grid)
        through = solution.conductance(conductivity=46.0, counter_conductivity=math.inf)
        found.append(through)
    # Twice the width.
    fall = found[0].resistance - found[1].resistance
    error = found[0].uncertainty + found[1].uncertainty
    assert abs(fall - math.log(2) / (math.pi * 46.0)) < error < 0.02 * fall
    assert "m K/W" in str(found[0])
    assert "datum" in str(found[0])


def test_an_insulating_film_adds_its_own_resistance() -> None:
    """A film over which nearly all falls passes the same flux in each cell: R = ρ/A."""
    solution = nacre.solve(BALL, STEEL, STEEL, load=10.0)
    film = 1e3
    through = solution.conductance(conductivity=46.0, counter_conductivity=46.0, film=film)
    assert_close(through.resistance, film / solution.contact_area, rtol=1e-6)
    cells = solution.conductance(
        conductivity=46.0, counter_conductivity=46.0, film=np.full(solution.grid.shape, film)
    )
    assert_close(cells.resistance, through.resistance, rtol=1e-12)
    flux = through.flux[solution.in_contact]
    assert_close(flux, np.full(flux.shape, 1 / flux.size), rtol=1e-5)


COATED = nacre.HalfSpace(STEEL, [nacre.Layer(STEEL, 2e-6, name="top"), nacre.Layer(STEEL, 5e-6)])


def coated(**keywords: Any) -> nacre.Solution:
    grid = nacre.Grid((48, 40), (4e-4, 3.6e-4))
    return nacre.solve(BALL, COATED, STEEL, load=10.0, grid=grid, **keywords)


def test_conductivities_of_layers_are_given_in_each_form() -> None:
    solution = coated()
    forms: list[Any] = [
        [10.0, 30.0, 46.0],
        {"top": 10.0, 1: 30.0, "substrate": 46.0},
        {"layers[0]": 10.0, "layers[1]": 30.0, "substrate": 46.0},
    ]
    numbers = [
        solution.conductance(conductivity=form, counter_conductivity=46.0).resistance
        for form in forms
    ]
    assert numbers[0] == numbers[1] == numbers[2]
    alike = solution.conductance(conductivity=46.0, counter_conductivity=46.0).resistance
    layers = solution.conductance(conductivity=[46.0, 46.0, 46.0], counter_conductivity=46.0)
    assert_close(layers.resistance, alike, rtol=1e-9)
    assert numbers[0] > alike
    card = nacre.materials["M50"].numbers["conductivity"].value
    by_name = solution.conductance(conductivity="M50", counter_conductivity=card).resistance
    assert_close(by_name, alike * 46.0 / card, rtol=1e-9)


def test_split_layers_mirrors_scales_threads_and_files_change_nothing(tmp_path: Path) -> None:
    solution = coated()
    keywords: dict[str, Any] = {"conductivity": [10.0, 30.0, 46.0], "counter_conductivity": 90.0}
    through = solution.conductance(**keywords)
    assert_close(through.flux, through.flux[::-1, ::-1], atol=1e-9 * through.flux.max())
    # A layer in two.
    layers = [nacre.Layer(STEEL, h) for h in (2e-6, 2e-6, 3e-6)]
    split = nacre.solve(BALL, nacre.HalfSpace(STEEL, layers), STEEL, load=10.0, grid=solution.grid)
    parts = split.conductance(conductivity=[10.0, 30.0, 30.0, 46.0], counter_conductivity=90.0)
    assert_close(parts.resistance, through.resistance, rtol=1e-9)
    # Lengths in millimetres, forces in newtons.
    layers = [nacre.Layer(nacre.Elastic(210e3, 0.3), h) for h in (2e-3, 5e-3)]
    small = nacre.solve(
        nacre.Sphere(5.0),
        nacre.HalfSpace(nacre.Elastic(210e3, 0.3), layers),
        nacre.Elastic(210e3, 0.3),
        load=10.0,
        grid=nacre.Grid((48, 40), (0.4, 0.36)),
    ).conductance(**keywords)
    assert_close(small.resistance, 1e-3 * through.resistance, rtol=1e-9)
    with nacre.display_units("N-mm-MPa"):
        assert "K/mW" in str(small)
    # The bodies change places.
    other = nacre.solve(BALL, STEEL, COATED, load=10.0, grid=solution.grid)
    turned = other.conductance(conductivity=90.0, counter_conductivity=[10.0, 30.0, 46.0])
    assert_close(turned.resistance, through.resistance, rtol=1e-9)
    one = coated(threads=1).conductance(**keywords)
    assert one.resistance == through.resistance
    loaded = nacre.load(solution.save(tmp_path / "contact.nc")).conductance(**keywords)
    assert_close(loaded.resistance, through.resistance, rtol=1e-12)
    assert nacre.load(through.save(tmp_path / "through.nc")) == through
    assert nacre.types.Conductance.from_dict(through.to_dict()) == through
    text = through.save(tmp_path / "through.csv").read_text("utf-8")
    assert "resistance [K/W]" in text
    assert "Resistance" in through.save(tmp_path / "through.html").read_text("utf-8")
    assert through.plot().get_ylabel() == "flux density over its mean"


def test_contacts_that_yield_wear_tilt_or_lie_on_springs_count_by_their_cells() -> None:
    keywords: dict[str, Any] = {"conductivity": 46.0, "counter_conductivity": 46.0}
    yields = quiet(coated, hardness=1e9)
    springs = quiet(coated, compliance=1e-15)
    tilted = quiet(coated, eccentricity=(2e-5, 0.0))
    history = quiet(nacre.wear, BALL, STEEL, load=10.0, rate=1e-15, sliding=1.0)
    for solution in (yields, springs, tilted, history.states[-1].solution):
        through = solution.conductance(**keywords)
        cells = on_cells(solution.in_contact, solution.grid.spacing).conductance(**keywords)
        assert_close(through.resistance, cells.resistance, rtol=1e-9)
        assert (through.flux[~solution.in_contact] == 0).all()


def test_a_required_resistance_is_judged_with_its_error() -> None:
    through = coated().conductance(conductivity=46.0, counter_conductivity=46.0)
    r, error = through.resistance, through.uncertainty
    assert through.verdict(required_resistance=2 * r).level == "good"
    assert through.verdict(required_resistance=r + 0.5 * error).level == "fair"
    assert through.verdict(required_resistance=0.9 * r).level == "bad"
    assert through.verdict().level == "unknown"
    for wrong in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="required_resistance"):
            through.verdict(required_resistance=wrong)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"conductivity": 46.0}, "counter_conductivity must be given"),
        ({"conductivity": 0.0}, "conductivity must be above 0, got 0"),
        ({"conductivity": math.nan}, "conductivity must be above 0, got nan"),
        ({"conductivity": {"top": 10.0, "substrate": 46.0}}, r"conductivity for layers\[1\]"),
        ({"conductivity": [1.0, 2.0]}, r"must hold a conductivity for substrate"),
        ({"conductivity": {"bottom": 1.0}}, "bottom"),
        ({"conductivity": "unobtainium"}, "unobtainium"),
        ({"conductivity": "TiN"}, "card with a conductivity"),
        ({"conductivity": 9e-8, "kind": "electrical"}, "is it a resistivity"),
        ({"conductivity": "M50", "kind": "electrical"}, "thermal conductivities only"),
        ({"conductivity": 1e-5}, "is it a resistivity"),
        ({"conductivity": 46.0, "film": -1.0}, "film must be finite and at least 0"),
        ({"conductivity": 46.0, "film": math.nan}, "film must be finite and at least 0"),
        ({"conductivity": 46.0, "film": "thin"}, "film must be"),
        ({"conductivity": 46.0, "kind": ["thermal"]}, "kind must be one of"),
        ({"conductivity": 46.0, "film": np.zeros((2, 2))}, r"of shape \(48, 40\)"),
        ({"conductivity": 46.0, "kind": "magnetic"}, "kind must be one of"),
        ({"conductivity": math.inf, "counter_conductivity": math.inf}, "perfect conductors"),
        ({"conductivity": [math.inf, 1.0, 1.0]}, "conductivity of layers must be finite"),
    ],
)
def test_wrong_arguments_are_named(keywords: dict[str, Any], message: str) -> None:
    if "given" not in message:
        keywords = {"counter_conductivity": 46.0, **keywords}
    with pytest.raises((KeyError, TypeError, ValueError), match=message):
        coated().conductance(**keywords)


def test_contacts_without_conductance_are_refused() -> None:
    keywords: dict[str, Any] = {"conductivity": 46.0, "counter_conductivity": 46.0}
    grid = nacre.Grid((32, 32), (4e-4, 4e-4))
    apart = nacre.solve(BALL, STEEL, approach=-1e-6, grid=grid)
    with pytest.raises(ValueError, match="no cell is in contact"):
        apart.conductance(**keywords)
    ended = nacre.HalfSpace(STEEL, ends=(-2e-4, 2e-4))
    with pytest.raises(ValueError, match="free ends"):
        quiet(nacre.solve, BALL, ended, load=1.0, grid=grid).conductance(**keywords)
    half = nacre.Grid((32, 32), (4e-4, 4e-4), periodic=(True, False))
    with pytest.raises(ValueError, match="both axes"):
        quiet(nacre.solve, BALL, STEEL, load=1.0, grid=half).conductance(**keywords)
    plate = nacre.HalfSpace(nacre.FREE, [nacre.Layer(STEEL, 1e-3)])
    both = nacre.Grid((32, 32), (4e-4, 4e-4), periodic=(True, True))
    bent = quiet(nacre.solve, BALL, plate, load=1.0, grid=both)
    with pytest.raises(ValueError, match="free base"):
        bent.conductance(**keywords)
