"""Conductance of joints: Barber's theorem, its errors, Mikic's numbers, and files of programs."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.special import erfc

import nacre
from nacre import design, rough
from nacre.design.joint import EXPONENT, FACTOR
from support import assert_close

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # spots of few cells

STEEL = nacre.Elastic(210e9, 0.3)
NICKEL = nacre.Elastic(200e9, 0.31)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(NICKEL, 2e-6)])
WAVES: dict[str, Any] = {"hurst": 0.8, "shortest": 16e-6, "longest": 32e-6, "rms_slope": 0.1}
SIDE = 64e-6
PRESSURES = [50e6, 200e6]
BARE: dict[str, Any] = {"conductivity": 46.0, "counter_conductivity": 90.0}


def surface(seed: int) -> nacre.HeightMap:
    return rough.random_surface((64, 64), (SIDE, SIDE), rng=seed, **WAVES)


SURFACE = surface(1)
JOINT = design.joint_conductance(SURFACE, STEEL, NICKEL, pressures=PRESSURES, **BARE)


def barber(shape: nacre.HeightMap, pressure: float) -> float:
    """Return 2k/E* of the stiffness per area, with 1/k = 1/k₁ + 1/k₂ (Barber 2003)."""
    solution = nacre.solve(shape, STEEL, NICKEL, load=pressure * SIDE**2)
    modulus = nacre.hertz.contact_modulus(STEEL, NICKEL)
    both = 2 / (1 / 46.0 + 1 / 90.0)
    return float(both / modulus * solution.stiffness()[0, 0] / SIDE**2)


def test_bare_joints_follow_barbers_theorem() -> None:
    expected = [barber(SURFACE, pressure) for pressure in PRESSURES]
    # Both are of the cells in contact: what remains are the tolerances of two linear systems. The
    # cells are those of a solve to the default tolerance from another start.
    assert_close(JOINT.conductance, expected, rtol=1e-9)
    assert (JOINT.pressure == PRESSURES).all()
    assert JOINT.deviation is None
    assert JOINT.surfaces == 1


def test_the_scale_of_lengths_and_of_pressures() -> None:
    """Twice the heights and the modulus half: the same contact at the same pressure."""
    higher = nacre.HeightMap(2 * SURFACE.heights, SURFACE.spacing, periodic=(True, True))
    softer = [nacre.Elastic(body.young / 2, body.poisson) for body in (STEEL, NICKEL)]
    same = design.joint_conductance(higher, *softer, pressures=PRESSURES, **BARE)
    assert_close(same.conductance, JOINT.conductance, rtol=1e-9)
    assert_close(same.share, JOINT.share, rtol=1e-12)
    # Lengths three times as long divide it by three.
    larger = nacre.HeightMap(3 * SURFACE.heights, 3 * SURFACE.spacing[0], periodic=(True, True))
    third = design.joint_conductance(larger, STEEL, NICKEL, pressures=PRESSURES, **BARE)
    assert_close(3 * third.conductance, JOINT.conductance, rtol=1e-9)
    assert JOINT.mikic is not None
    assert third.mikic is not None
    assert same.mikic is not None
    assert_close(3 * third.mikic, JOINT.mikic, rtol=1e-9)
    assert_close(same.mikic, JOINT.mikic, rtol=1e-9)


@pytest.mark.parametrize("film", [0.0, 1e-8])
@pytest.mark.parametrize("body", [STEEL, COATED])
def test_the_error_of_the_cells_holds_against_four_times_as_many(body: Any, film: float) -> None:
    coarse, fine = (
        design.joint_conductance(
            shape,
            body,
            NICKEL,
            pressures=PRESSURES,
            film=film,
            **BARE,
        )
        for shape in (surface(7), refined(surface(7)))
    )
    # Errors are of first order: that of the fine cells, half as large, is in the difference too.
    assert (np.abs(coarse.conductance - fine.conductance) < coarse.uncertainty).all()
    assert (fine.uncertainty < 0.7 * coarse.uncertainty).all()
    assert (coarse.uncertainty < 0.4 * coarse.conductance).all()


def refined(shape: nacre.HeightMap) -> nacre.HeightMap:
    """Return the same waves on twice the points along each side."""
    waves = np.fft.fft2(shape.heights)
    n = len(waves)
    number = np.fft.fftfreq(n, 1 / n)
    # Centres of the finer cells are a quarter of a cell before those of the coarser ones.
    wide = np.zeros((2 * n, 2 * n), dtype=complex)
    places = number.astype(int) % (2 * n)
    shift = np.exp(-2j * np.pi * 0.25 / n * (number[:, None] + number))
    wide[np.ix_(places, places)] = waves * shift
    heights = 4 * np.fft.ifft2(wide).real
    return nacre.HeightMap(heights, SIDE / (2 * n), periodic=(True, True))


def test_several_surfaces_have_their_mean_and_its_deviation() -> None:
    seeds, told = (1, 2, 3), list[float]()
    joint = design.joint_conductance(
        [surface(seed) for seed in seeds],
        STEEL,
        NICKEL,
        pressures=PRESSURES,
        progress=told.append,
        **BARE,
    )
    single = np.array([[barber(surface(seed), p) for p in PRESSURES] for seed in seeds])
    assert_close(joint.conductance, single.mean(axis=0), rtol=1e-9)
    assert joint.deviation is not None
    assert_close(joint.deviation, single.std(axis=0, ddof=1) / math.sqrt(3), rtol=1e-6)
    assert joint.surfaces == 3
    assert told == pytest.approx([k / 6 for k in range(1, 7)])
    assert "± of 3 surfaces" in str(joint)


def test_mikics_numbers_are_those_of_gaussian_surfaces() -> None:
    """Spots of half the area in which Gaussian heights overlap, at gaps of 2 to 4.75 σ."""
    gap = np.linspace(2.0, 4.75, 100)
    area = erfc(gap / math.sqrt(2)) / 4  # √2 p/(E* m)
    conductance = np.exp(-(gap**2) / 2) / (4 * math.sqrt(math.pi)) / (1 - np.sqrt(area)) ** 1.5
    assert_close(FACTOR * area**EXPONENT, conductance, rtol=0.06)


def test_mikics_correlation_of_a_surface() -> None:
    assert JOINT.mikic is not None
    ratio = math.sqrt(2 * math.pi) * PRESSURES[0]
    ratio /= nacre.hertz.contact_modulus(STEEL, NICKEL) * 0.1
    k = 2 * 46.0 * 90.0 / (46.0 + 90.0)
    slope = 0.1 / math.sqrt(math.pi)
    assert JOINT.mikic[0] == pytest.approx(1.55 * k * slope / SURFACE.heights.std() * ratio**0.94)
    # Other surfaces differ from it by some tens of per cent.
    assert (np.abs(JOINT.conductance / JOINT.mikic - 1) < 0.7).all()
    rigid = design.joint_conductance(
        SURFACE, STEEL, pressures=[5e7], conductivity=46.0, counter_conductivity=math.inf
    )
    assert rigid.mikic is not None
    ratio = math.sqrt(2 * math.pi) * 5e7 / (STEEL.plane_strain_modulus * 0.1)
    scale = slope / SURFACE.heights.std()
    assert rigid.mikic[0] == pytest.approx(1.55 * 2 * 46.0 * scale * ratio**0.94)
    coated = design.joint_conductance(SURFACE, COATED, NICKEL, pressures=[5e7], **BARE)
    assert coated.mikic is None
    assert "Mikic" not in str(coated)


def test_a_hardness_and_a_film_lower_the_conductance_as_they_should() -> None:
    film = design.joint_conductance(SURFACE, STEEL, NICKEL, pressures=PRESSURES, film=1e-7, **BARE)
    assert (film.conductance < JOINT.conductance).all()
    # A film in series with all spots bounds it.
    assert (film.conductance < 1.3 * film.share / 1e-7).all()
    soft = design.joint_conductance(
        SURFACE, STEEL, NICKEL, pressures=PRESSURES, hardness=3e9, **BARE
    )
    assert (soft.conductance > JOINT.conductance).all()  # dents are larger spots


def test_current_is_conducted_alike() -> None:
    numbers: dict[str, Any] = {"conductivity": 4.6e6, "counter_conductivity": 9.0e6}
    joint = design.joint_conductance(
        SURFACE, STEEL, NICKEL, pressures=PRESSURES, kind="electrical", **numbers
    )
    assert_close(joint.conductance, 1e5 * JOINT.conductance, rtol=1e-9)
    assert "S/m²" in str(joint)


def test_a_shape_that_is_no_map_is_pressed_on_a_grid() -> None:
    grid = nacre.Grid((32, 32), (SIDE, SIDE), periodic=(True, True))
    ball = nacre.Sphere(1e-3)
    joint = design.joint_conductance(ball, STEEL, NICKEL, pressures=[1e6], grid=grid, **BARE)
    solution = nacre.solve(ball, STEEL, NICKEL, load=1e6 * SIDE**2, grid=grid)
    through = solution.conductance(**BARE)
    assert joint.conductance[0] == pytest.approx(through.conductance, rel=1e-9)
    assert joint.mikic is None
    share = joint.uncertainty[0] / joint.conductance[0]
    assert share == pytest.approx(through.uncertainty / through.resistance, rel=1e-9)


OPEN = nacre.HeightMap(SURFACE.heights, SURFACE.spacing)
ALONG = nacre.HeightMap(SURFACE.heights, SURFACE.spacing, periodic=(True, False))


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"pressures": [0.0, 1e6]}, "pressures must be numbers above 0 that rise"),
        ({"pressures": [-1e6]}, "pressures must be numbers above 0 that rise"),
        ({"pressures": [2e6, 1e6]}, "pressures must be numbers above 0 that rise"),
        ({"pressures": []}, "pressures must be numbers above 0 that rise"),
        ({"pressures": [math.nan]}, "pressures must be"),
        ({"pressures": [math.inf]}, "pressures must be"),
        ({"surface": []}, "surface must be a shape or several"),
        ({"surface": OPEN}, "grid must repeat along x and y"),
        ({"surface": ALONG}, "grid must repeat along x and y"),
        ({"surface": [SURFACE, OPEN]}, "grid must repeat along x and y"),
        ({"surface": nacre.Sphere(1e-3)}, "grid must be given"),
        ({"conductivity": 2e-7, "kind": "electrical"}, "is it a resistivity"),
        ({"conductivity": 0.0}, "conductivity must be above 0"),
        ({"counter_conductivity": None}, "counter_conductivity must be given"),
        ({"film": -1e-8}, "film must be"),
        ({"kind": "magnetic"}, "kind must be one of"),
    ],
)
def test_what_is_refused(changed: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = {"surface": SURFACE, "pressures": [5e7], **BARE, **changed}
    with pytest.raises(ValueError, match=message):
        design.joint_conductance(given.pop("surface"), STEEL, NICKEL, **given)


def test_the_table_and_the_state_are_saved(tmp_path: Path) -> None:
    assert nacre.load(JOINT.save(tmp_path / "joint.nc")) == JOINT
    assert JOINT.from_dict(JOINT.to_dict()) == JOINT
    lines = JOINT.save(tmp_path / "joint.csv").read_text("utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if line[0] != "#"))
    assert [float(row["pressure [Pa]"]) for row in rows] == PRESSURES
    assert [float(row["conductance [W/K/m²]"]) for row in rows] == JOINT.conductance.tolist()
    assert [float(row["share"]) for row in rows] == JOINT.share.tolist()
    assert "Mikic" in JOINT.save(tmp_path / "joint.html").read_text("utf-8")


def test_the_table_of_calculix_is_read_as_gapconductances_reads_it(tmp_path: Path) -> None:
    """Comments begin with **; a card, then lines of three numbers of at most 20 characters."""
    text = JOINT.save_table(tmp_path / "joint.inp", program="calculix").read_text("utf-8")
    card, *lines = [line for line in text.splitlines() if not line.startswith("**")]
    assert card == "*GAP CONDUCTANCE"
    cells = [[cell.strip() for cell in line.split(",")] for line in lines]
    assert all(len(row) == 3 and max(map(len, row)) <= 20 for row in cells)
    conductance, pressure, temperature = np.array(cells, dtype=float).T
    assert_close(conductance, [0.0, *JOINT.conductance], rtol=1e-11)
    assert_close(pressure, [0.0, *PRESSURES], rtol=1e-11)
    assert len({*temperature}) == 1  # else it begins another table


def test_the_table_of_moose_is_read_as_a_piecewise_linear_function(tmp_path: Path) -> None:
    """Columns of numbers divided by commas, comments after #, abscissae that rise."""
    path = JOINT.save_table(tmp_path / "joint.csv", program="moose")
    x, y = np.loadtxt(path, delimiter=",", comments="#").T
    assert (np.diff(x) > 0).all()
    assert_close(x, [0.0, *PRESSURES], rtol=1e-15)
    assert_close(y, [0.0, *JOINT.conductance], rtol=1e-15)


@pytest.mark.parametrize(
    ("name", "program", "message"),
    [
        ("joint.csv", "calculix", "path must end in .inp"),
        ("joint.inp", "moose", "path must end in .csv"),
        ("joint.csv", "pybamm", "program must be one of"),
    ],
)
def test_a_table_of_another_program_is_refused(
    tmp_path: Path, name: str, program: Any, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        JOINT.save_table(tmp_path / name, program=program)


def test_the_picture_has_the_correlation_as_a_thin_line() -> None:
    axes = JOINT.plot()
    computed, mikic = axes.lines
    assert computed.get_label() == "computed"
    assert mikic.get_label() == "Mikic"
    assert mikic.get_linewidth() < computed.get_linewidth()
    assert axes.get_xscale() == axes.get_yscale() == "log"
