"""What holds of every contact, tried on every kind: a matrix of contacts and invariants.

A new kind of contact is a function in `CONTACTS`, which solves it on the scene that it is passed.
`EXCLUDED` says which invariants it has not, and why.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import nacre
from bodies import quiet
from nacre.bearing import CylindricalRoller
from support import assert_close

Array = npt.NDArray[np.float64]
Layers = list[nacre.Layer]

SOLVED = 1e-11
"""Tolerance of the iterations."""
SAME = 1e-7
"""Difference of pressures, relative to the peak, of two formulations that are solved so far."""
SLID = 2e-6
"""The same of tractions, relative to their bound: their iterations end at 1e-7."""


@dataclass(frozen=True)
class Scene:
    """Variations of a contact whose answers follow from that of the first."""

    metre: float = 1.0
    """Units of length in a metre."""
    newton: float = 1.0
    """Units of force in a newton."""
    side: int = 1
    """-1 for the mirror image about x = 0."""
    cells: int = 1
    """Cells along each side for one of the first."""
    same: bool = False
    """Whether the substrate has two layers of its own material."""

    def steel(self) -> nacre.Elastic:
        return nacre.Elastic(210e9 * self.newton / self.metre**2, 0.3)

    def film(self, interface: Any = "bonded") -> Layers:
        hard = nacre.Elastic(420e9 * self.newton / self.metre**2, 0.2)
        return [nacre.Layer(hard, 20e-6 * self.metre, interface)]

    def body(self, layers: Layers | None = None, **keywords: Any) -> nacre.HalfSpace:
        same = (
            [nacre.Layer(self.steel(), h * self.metre) for h in (7e-6, 40e-6)] if self.same else []
        )
        return nacre.HalfSpace(self.steel(), [*(layers or []), *same], **keywords)

    def grid(
        self, shape: tuple[int, int] = (72, 64), size: float = 3e-4, **keywords: Any
    ) -> nacre.Grid:
        cells = (shape[0] * self.cells, shape[1] * self.cells)
        return nacre.Grid(cells, (size * self.metre, 0.9 * size * self.metre), **keywords)

    def ball(self) -> Any:
        shape = nacre.Paraboloid(5e-3 * self.metre, 7e-3 * self.metre)
        return shape.shifted(1e-5 * self.metre * self.side, 6e-6 * self.metre)

    def pressed(self, body: Any, **keywords: Any) -> nacre.Solution:
        """Press a ball by a force beside its lowest point, free to tilt about one axis."""
        chosen: dict[str, Any] = {"grid": self.grid(), "tolerance": SOLVED} | keywords
        arm = (1.2e-5 * self.metre * self.side, None)
        motion = {"load": 10 * self.newton, "eccentricity": arm}
        return quiet(nacre.solve, self.ball(), body, **motion, **chosen)  # type: ignore[no-any-return]


def bare(scene: Scene, **keywords: Any) -> Any:
    return scene.pressed(scene.body(), **keywords)


def coated(scene: Scene, **keywords: Any) -> Any:
    return scene.pressed(scene.body(scene.film()), **keywords)


def both_coated(scene: Scene, **keywords: Any) -> Any:
    thin = nacre.Layer(
        nacre.Elastic(7e10 * scene.newton / scene.metre**2, 0.35), 5e-6 * scene.metre
    )
    other = nacre.HalfSpace(scene.steel(), [thin])
    return scene.pressed(scene.body(scene.film()), counterbody=other, **keywords)


def spring(scene: Scene, **keywords: Any) -> Any:
    stiffness = scene.newton / scene.metre**3
    interface = nacre.Spring(3e15 * stiffness, 1e15 * stiffness)
    return scene.pressed(scene.body(scene.film(interface)), **keywords)


def frictionless(scene: Scene, **keywords: Any) -> Any:
    return scene.pressed(scene.body(scene.film("frictionless")), **keywords)


def periodic(scene: Scene, **keywords: Any) -> Any:
    grid = scene.grid((64, 72), periodic=(True, True))
    # The highest point is the centre of a cell, also on grids of odd multiples of cells.
    top = 5 * scene.cells + scene.cells // 2
    x = 2 * np.pi * (grid.x - scene.side * grid.x[top]) / grid.size[0]
    y = 2 * np.pi * (grid.y - grid.y[top]) / grid.size[1]
    heights = np.cos(x)[:, None] * np.cos(y) + 0.3 * np.cos(2 * x)[:, None]
    shape = nacre.HeightMap(2e-8 * scene.metre * heights, grid.spacing, periodic=(True, True))
    chosen: dict[str, Any] = {
        "grid": grid,
        "load": 2 * scene.newton,
        "tolerance": SOLVED,
    } | keywords
    return quiet(nacre.solve, shape, scene.body(scene.film()), **chosen)


def rough_shape(scene: Scene, periodic: tuple[bool, bool]) -> tuple[nacre.Grid, nacre.HeightMap]:
    """Return a random map, which no symmetry maps onto itself, and a grid that repeats alike."""
    heights = np.random.default_rng(5).normal(size=(18, 16))
    if scene.side < 0:
        heights = np.flip(heights, 0)
    grid = scene.grid((18, 16), size=6e-5, periodic=periodic)
    spacing = (grid.spacing[0] * scene.cells, grid.spacing[1] * scene.cells)
    return grid, nacre.HeightMap(5e-8 * scene.metre * heights, spacing, periodic=periodic)


def rough(scene: Scene, **keywords: Any) -> Any:
    grid, shape = rough_shape(scene, (True, True))
    chosen = {"grid": grid, "load": 2 * scene.newton, "tolerance": SOLVED} | keywords
    return quiet(nacre.solve, shape, scene.body(scene.film()), **chosen)


def worn(
    scene: Scene, periodic: tuple[bool, bool] = (False, True), **keywords: Any
) -> nacre.types.WearHistory:
    """Wear both rough bodies, by some of the height of the map, in two histories."""
    grid, shape = rough_shape(scene, periodic)
    unit = scene.metre**2 / scene.newton
    chosen = {"grid": grid, "load": 2 * scene.newton, "tolerance": SOLVED, "steps": 2} | keywords
    rates = {"rate": 1e-15 * unit, "counter_rate": 4e-16 * unit, "scheme": "euler"}
    bodies = (scene.body(scene.film()), scene.steel())
    history = None
    for sliding in (0.05, 0.1):
        distance = {"sliding": sliding * scene.metre, "initial": history}
        history = quiet(nacre.wear, shape, *bodies, **chosen, **rates, **distance)
    return history  # type: ignore[return-value]


def worn_rough(scene: Scene, **keywords: Any) -> Any:
    return worn(scene, **keywords).states[-1].solution


def line(scene: Scene, **keywords: Any) -> Any:
    grid = nacre.Grid.line(128 * scene.cells, 3e-4 * scene.metre)
    shape = nacre.Cylinder(5e-3 * scene.metre).shifted(0.0, 1e-5 * scene.metre * scene.side)
    chosen: dict[str, Any] = {"grid": grid, "tolerance": SOLVED} | keywords
    load = 3e4 * scene.newton / scene.metre
    return quiet(nacre.solve, shape, scene.body(scene.film()), load=load, **chosen)


def ended(scene: Scene, layers: Layers, **keywords: Any) -> Any:
    end = 6.25e-5 * scene.metre  # an edge of cells
    ends = (None, end) if scene.side > 0 else (-end, None)
    return scene.pressed(scene.body(layers, ends=ends), **keywords)


def free_end(scene: Scene, **keywords: Any) -> Any:
    return ended(scene, [], **keywords)


def coated_end(scene: Scene, **keywords: Any) -> Any:
    return ended(scene, scene.film(), **keywords)


def hardness(scene: Scene, **keywords: Any) -> Any:
    limit = 1.2e9 * scene.newton / scene.metre**2
    return scene.pressed(scene.body(scene.film()), hardness=limit, **keywords)


def friction(scene: Scene, **keywords: Any) -> Any:
    force = (1.5 * scene.newton * scene.side, 0.5 * scene.newton)
    motion = {"load": 10 * scene.newton, "friction": 0.3, "force": force}
    grid = {"grid": scene.grid((40, 36)), "tolerance": 1e-7}
    return quiet(
        nacre.slide,
        scene.ball(),
        scene.body(scene.film()),
        scene.steel(),
        **motion,
        **grid,
        **keywords,
    )


def rolling(scene: Scene, **keywords: Any) -> Any:
    direction = "+x" if scene.side > 0 else "-x"
    creepage = {"creepage": (1e-3, 4e-4 * scene.side), "direction": direction}
    motion = {"load": 10 * scene.newton, "friction": 0.3} | creepage
    grid = {"grid": scene.grid(), "tolerance": 1e-7}
    return quiet(
        nacre.roll,
        scene.ball(),
        scene.body(scene.film()),
        scene.steel(),
        **motion,
        **grid,
        **keywords,
    )


def sampled_profile(scene: Scene, **keywords: Any) -> Any:
    x = np.linspace(-1.0, 1.0, 41)
    drop = 1e-6 * x**2 + 4e-7 * np.maximum(x * scene.side, 0) ** 3
    length = 4e-4 * scene.metre
    profile = nacre.SampledProfile(x * length / 2, drop * scene.metre)
    shape = nacre.Roller(5e-3 * scene.metre, length=length, profile=profile)
    grid = scene.grid((72, 64), size=4e-4)
    chosen: dict[str, Any] = {
        "grid": grid,
        "load": 20 * scene.newton,
        "tolerance": SOLVED,
    } | keywords
    return quiet(nacre.solve, shape, scene.body(scene.film()), **chosen)


def bearing(scene: Scene) -> Any:
    # The outer ring is coated; mirrored about x = 0, force and tilt about y change their signs.
    size = {"count": 10, "diameter": 10e-3, "length": 9.6e-3, "pitch_diameter": 65e-3}
    rings = {"inner": scene.body(), "outer": scene.body(scene.film()), "clearance": 2e-5}
    bearing = CylindricalRoller(**size, **rings, free_ends=False)  # type: ignore[arg-type]
    motion = {"force": (3e3 * scene.side, 0.0, None), "tilt": (None, 4e-4 * scene.side)}
    return quiet(bearing.solve, **motion, cells=(40 * scene.cells, 24 * scene.cells), threads=1)


CONTACTS: dict[str, Callable[..., Any]] = {
    contact.__name__: contact
    for contact in (
        *(bare, coated, both_coated, spring, frictionless, periodic, line, free_end, coated_end),
        *(rough, worn_rough),
        *(hardness, friction, rolling, sampled_profile, bearing),
    )
}


@cache
def solved(name: str, scene: Scene) -> Any:
    return CONTACTS[name](scene)


def tolerance(name: str) -> float:
    return SLID if name in ("friction", "rolling") else SAME


def numbers(name: str, scene: Scene) -> dict[str, Array]:
    """Return numbers and fields of a contact in SI, turned back where it is mirrored."""
    result, side = solved(name, scene), scene.side
    if name == "bearing":
        return {
            "displacement": np.asarray(result.displacement)[:2] * [side, 1],
            # Mirrored, the element at angle φ is at π − φ.
            "loads": result.loads if side > 0 else np.roll(result.loads[::-1], 6, axis=0),
            "peak": np.asarray(result.peak_pressure),
        }
    pascal = scene.newton / scene.metre**2
    axis = 1 if name == "line" else 0
    turned: Callable[[Array], Array] = lambda field: np.flip(field, axis) if side < 0 else field  # noqa: E731
    normal = result.normal if name in ("friction", "rolling") else result
    fields = {
        "pressure": turned(normal.pressure) / pascal,
        "approach": normal.approach / scene.metre,
    }
    if normal is not result:
        fields["along"] = turned(result.traction[0]) * side / pascal
        fields["across"] = turned(result.traction[1]) / pascal
    return {name: np.asarray(field) for name, field in fields.items()}


def assert_alike(name: str, scene: Scene, limit: float) -> None:
    first, other = numbers(name, Scene()), numbers(name, scene)
    for quantity, expected in first.items():
        # Tractions are measured by their bound.
        scale = 0.3 * first["pressure"] if quantity in ("along", "across") else expected
        error = np.abs(other[quantity] - expected).max() / np.abs(scale).max()
        assert error < limit, (name, quantity, error)


# Invariants.


def balance(name: str) -> None:
    result = solved(name, Scene())
    if name == "bearing":
        directions = np.array([np.cos(result.angles), np.sin(result.angles)])
        carried = directions @ result.loads[:, 0]
        assert_close(carried, [3e3, 0.0], atol=3e3 * 1e-8)
        return
    normal = getattr(result, "normal", result)
    grid = normal.grid
    area = grid.spacing[1] if name == "line" else grid.spacing[0] * grid.spacing[1]
    load = {
        "periodic": 2.0,
        "rough": 2.0,
        "worn_rough": 2.0,
        "line": 3e4,
        "sampled_profile": 20.0,
    }.get(name, 10.0)
    assert normal.pressure.sum() * area == pytest.approx(load, rel=1e-9)
    if name == "friction":
        force = result.traction.sum(axis=(1, 2)) * area
        assert_close(force, [1.5, 0.5], rtol=1e-6)
    elif name not in ("periodic", "rough", "worn_rough", "line", "rolling", "sampled_profile"):
        arm = (normal.pressure.sum(axis=1) * grid.x).sum() * area / load
        assert arm == pytest.approx(1.2e-5, rel=1e-6)


def mirror(name: str) -> None:
    assert_alike(name, Scene(side=-1), tolerance(name))


def units(name: str) -> None:
    # Millimetres and newtons; inches and tonnes-force.
    for scene in (Scene(metre=1e3), Scene(metre=39.37, newton=1 / 9806.65)):
        assert_alike(name, scene, tolerance(name))


def equal_layers(name: str) -> None:
    # Ends of a layered body are computed otherwise than those of a bare one: see `limits`.
    assert_alike(name, Scene(same=True), 2e-4 if name == "free_end" else tolerance(name))


def finer_grid(name: str) -> None:
    result, fine = solved(name, Scene()), solved(name, Scene(cells=3))
    if name != "rolling":  # which states its own errors
        result, fine = getattr(result, "normal", result), getattr(fine, "normal", fine)
    stated = result.report.discretisation
    assert stated is not None
    least = {"rolling": {"force", "dissipated"}, "bearing": {"edge_pressure"}}
    assert set(stated) >= least.get(name, {"peak_pressure", "approach"})
    for quantity, error in stated.items():
        if hasattr(result, quantity):
            value = getattr(result, quantity)
            change = np.abs(np.subtract(getattr(fine, quantity), value))
            bounds = np.array(np.nan if error is None else error, dtype=float)
            if np.ndim(value) > bounds.ndim:  # an error of the ends along each axis
                bounds = bounds[..., None]
            is_within = change <= bounds + SAME * np.abs(value)
            # Ends have none along an axis that repeats.
            assert (is_within | np.isnan(bounds)).all(), (quantity, change, error)


def saved(name: str, folder: Path) -> None:
    result = solved(name, Scene())
    result.save(folder / "a.nc")
    loaded = nacre.load(folder / "a.nc")
    assert loaded == result
    assert str(loaded) == str(result)


def printed(name: str) -> None:
    result = solved(name, Scene())
    cells = [re.split(r" {2,}", row, maxsplit=1) for row in str(result).splitlines()]
    rows = {row[0]: row[1] for row in cells if len(row) == 2}
    compared = 0
    for quantity in (*nacre.Solution._QUANTITIES, *nacre.types.FrictionSolution._QUANTITIES):
        text = rows.get(quantity.label, "")
        if (
            not quantity.label
            or not hasattr(result, quantity.name)
            or quantity.dims not in ((), ("axis",))
        ):
            continue
        stored = np.ravel(getattr(result, quantity.name))
        parsed = [*parsed_numbers(text.partition("±")[0])]
        if len(parsed) != len(stored):
            continue
        for (number, unit), exact in zip(parsed, stored, strict=True):
            # A peak in a cell at the middle is printed in the middle.
            cell = max(result.grid.spacing) if quantity.name == "peak_position" else 0.0
            assert number == pytest.approx(exact, abs=max(unit, cell)), (quantity.name, text, exact)
        compared += 1
    assert compared >= (2 if name == "bearing" else 5), rows


PREFIXES = {"": 1.0, "G": 1e9, "M": 1e6, "k": 1e3, "m": 1e-3, "µ": 1e-6, "n": 1e-9, "p": 1e-12}


def parsed_numbers(text: str) -> Iterator[tuple[float, float]]:
    """Yield the numbers of a printed row in SI, each with half of its last digit's unit."""
    units = "N m|N/m|Pa|J/m|J|N|m²|m|1/m|rad|%"
    text = re.sub(r"\(([^,()]+), ([^,()]+)\) (\S+)", r"(\1 \3, \2 \3)", text)  # one unit of both
    for digits, prefix, unit in re.findall(
        rf"(-?[\d.]+(?:e[-+]\d+)?)(?: ([GMkmµnp]?)({units})(?![\w²/]))?", text
    ):
        scale = 0.01 if unit == "%" else PREFIXES[prefix] ** (2 if unit == "m²" else 1)
        mantissa, _, exponent = digits.partition("e")
        whole, point, decimals = mantissa.strip("-").partition(".")
        # Four digits count: the last one of 84370 is the 7.
        last = -len(decimals) if point else max(len(whole) - 4, 0)
        yield float(digits) * scale, 0.5001 * 10.0 ** (int(exponent or 0) + last) * scale


def initial(name: str) -> None:
    contact = CONTACTS[name]
    first = solved(name, Scene())
    again = contact(Scene(), initial=first.pressure)
    error = np.abs(again.pressure - first.pressure).max() / first.pressure.max()
    assert error < SAME, error


INVARIANTS: dict[str, Callable[..., None]] = {
    test.__name__: test
    for test in (balance, mirror, units, equal_layers, finer_grid, saved, printed, initial)
}
EXCLUDED = {
    ("bearing", "units"): "bearings are in SI",
    ("bearing", "initial"): "a bearing starts from its own laws",
    ("hardness", "finer_grid"): "no error is stated where cells yield",
    ("friction", "finer_grid"): "no error is stated where tractions press, too",
    ("rough", "finer_grid"): "summits of a map that no cell resolves have no error",
    ("worn_rough", "finer_grid"): "summits of a map that no cell resolves have no error",
    ("worn_rough", "initial"): "it is the history before",
    ("friction", "initial"): "it is the state before",
    ("rolling", "initial"): "it is the state before",
}


@pytest.mark.parametrize("invariant", INVARIANTS)
@pytest.mark.parametrize("name", CONTACTS)
def test_matrix(name: str, invariant: str, tmp_path: Path) -> None:
    if (name, invariant) in EXCLUDED:
        pytest.skip(EXCLUDED[name, invariant])
    test = INVARIANTS[invariant]
    test(name, tmp_path) if test is saved else test(name)


@pytest.mark.parametrize("periodic", [(True, True), (True, False), (False, True)])
@pytest.mark.parametrize("thickness", ["frozen", "first order"])
def test_wear_of_rough_surfaces_is_that_of_the_law_wherever_they_begin(
    periodic: tuple[bool, bool], thickness: Any
) -> None:
    """The volume is rate x load x distance, and a map that begins elsewhere wears alike there."""
    if thickness != "frozen" and not all(periodic):
        with pytest.raises(ValueError, match="thickness must be"):
            worn(Scene(), periodic, thickness=thickness)
        return
    grid, shape = rough_shape(Scene(), periodic)
    steps = tuple(7 if repeats else 0 for repeats in periodic)
    moved = nacre.HeightMap(np.roll(shape.heights, steps, (0, 1)), grid.spacing, periodic=periodic)
    keywords: dict[str, Any] = {"load": 2.0, "grid": grid, "rate": 1e-15, "sliding": 0.1}
    keywords |= {"steps": 2, "tolerance": SOLVED, "thickness": thickness}
    bodies = (Scene().body(Scene().film()), Scene().steel())
    first, other = (quiet(nacre.wear, one, *bodies, **keywords) for one in (shape, moved))
    assert first.volume[-1, 0] == pytest.approx(1e-15 * 2.0 * 0.1, rel=1e-12)
    depth = np.roll(first.states[-1].depth, steps, (0, 1))
    # Sums of transforms that begin elsewhere differ by rounding.
    assert_close(other.states[-1].depth, depth, atol=1e-10 * depth.max())
