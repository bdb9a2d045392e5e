"""Ratings, load distribution and lives are those of ISO 281 and ISO/TS 16281."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import quiet
from nacre.bearing import (
    AngularContactBall,
    CylindricalRoller,
    DeepGrooveBall,
    edge_factors,
    load_integrals,
    rating,
)
from nacre.bearing.iso import pressure_factors, reference_life
from support import DATA, assert_close

FOLDER = DATA / "bearing"
PRINTED = json.loads((DATA / "printed.json").read_text("utf-8"))


def rows(name: str) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads((FOLDER / f"{name}.json").read_text("utf-8"))["rows"]
    return found


@pytest.mark.parametrize("row", rows("sjovall"), ids=lambda row: f"{row['eps']:.3g}")
def test_load_integrals_are_those_of_adaptive_quadrature(row: dict[str, Any]) -> None:
    # The bar; the table is right to 1e-12.
    for name, exponent in (("1.5", 1.5), ("10/9", 10 / 9), ("1", 1.0)):
        found = load_integrals(row["eps"], exponent)
        expected = row[f"Jr_n={name}"], row[f"Ja_n={name}"]
        assert_close(found, expected, rtol=1e-10)


@pytest.mark.parametrize("row", rows("iso281_capacity"), ids=lambda row: row["name"])
def test_rating_of_rollers(row: dict[str, Any]) -> None:
    bearing = CylindricalRoller(
        count=row["Z"],
        diameter=row["D_mm"] / 1e3,
        length=row["L_mm"] / 1e3,
        pitch_diameter=row["dm_mm"] / 1e3,
    )
    # The factors are written with 8 digits at least; the arithmetic is right to rounding.
    assert rating(bearing) == pytest.approx(row["C_r_bm1_1_N"], rel=1e-9)


@pytest.mark.parametrize("row", PRINTED["factor_of_balls"]["rows"], ids=lambda row: row["gamma"])
def test_factor_of_balls_is_that_of_the_table(row: dict[str, float]) -> None:
    bearing = DeepGrooveBall(
        count=3, diameter=1e-3, pitch_diameter=1e-3 / row["gamma"], rating_factor=1.0
    )
    # Half a unit of the third digit.
    assert rating(bearing) / 3 ** (2 / 3) == pytest.approx(row["printed"], abs=0.05)


@pytest.mark.parametrize("row", PRINTED["factor_of_rollers"]["rows"], ids=lambda row: row["gamma"])
def test_factor_of_rollers_is_that_of_the_table(row: dict[str, float]) -> None:
    bearing = CylindricalRoller(
        count=3,
        diameter=1e-3,
        length=1e-3,
        pitch_diameter=1e-3 / row["gamma"],
        rating_factor=1.0,
    )
    # The table is the formula to 0.13 %, and has three digits.
    assert rating(bearing) / 3**0.75 == pytest.approx(row["printed"], rel=row["tolerance"])


def test_rating_of_the_example_of_the_standard() -> None:
    (row,) = PRINTED["rating"]["rows"]
    diameter = row["D_mm"] / 1e3
    bearing = AngularContactBall(
        count=row["Z"],
        diameter=diameter,
        pitch_diameter=diameter / row["D_over_dm"],
        contact_angle=math.radians(row["alpha_deg"]),
    )
    assert rating(bearing) == pytest.approx(row["printed"], rel=row["tolerance"])


@pytest.mark.parametrize("row", PRINTED["catalogue"]["rows"], ids=lambda row: row["name"])
def test_rating_of_a_catalogue(row: dict[str, Any]) -> None:
    bearing = DeepGrooveBall(
        count=row["Z"], diameter=row["D_mm"] / 1e3, pitch_diameter=row["d_m_mm"] / 1e3
    )
    assert rating(bearing) == pytest.approx(row["printed"], rel=row["tolerance"])


def test_rating_falls_continuously_beyond_the_grooves_of_the_table() -> None:
    def rated(gamma: float, *osculation: float) -> float:
        pitch = 10e-3 / gamma
        return rating(
            DeepGrooveBall(count=7, diameter=10e-3, pitch_diameter=pitch, osculation=osculation)  # type: ignore[arg-type]
        )

    def formula(gamma: float, inner: float, outer: float) -> float:
        """Return f_c of ISO/TR 1281-1:2021, formula (15), over what the grooves leave as it is."""
        fit = (inner / outer * (2 * outer - 1) / (2 * inner - 1)) ** 0.41
        inside = 1.04 * ((1 - gamma) / (1 + gamma)) ** 1.72 * fit
        factor = (2 * inner / (2 * inner - 1)) ** 0.41 * (1 + inside ** (10 / 3)) ** -0.3
        return float(factor)

    for gamma in (0.05, 0.10, 0.16):
        table = rated(gamma, 0.52, 0.53)
        assert rated(gamma, 0.515, 0.505) == table
        # Steps of 1e-6 of the groove change the rating by some 1e-5.
        assert rated(gamma, 0.52, 0.530001) == pytest.approx(table, rel=2e-5)
        assert rated(gamma, 0.520001, 0.51) == pytest.approx(table, rel=2e-5)
        ratio = formula(gamma, 0.54, 0.54) / formula(gamma, 0.52, 0.53)
        assert rated(gamma, 0.54, 0.54) / table == pytest.approx(ratio, rel=1e-12)
    # ISO 281:2007, annex C, converts from 0.52/0.53 to 0.54/0.54 by 1.24, without a γ: the formula
    # has it at γ = 0.1.
    assert rated(0.1, 0.52, 0.53) / rated(0.1, 0.54, 0.54) == pytest.approx(1.24, abs=0.005)


@pytest.mark.parametrize("row", rows("iso16281_roller"), ids=lambda row: row["name"])
def test_rollers_of_the_standard(row: dict[str, Any]) -> None:
    given, expected = row["input"], row["result"]
    bearing = CylindricalRoller(
        count=int(given["Z"]),
        diameter=given["D"] / 1e3,
        length=given["L"] / 1e3,
        pitch_diameter=given["dm"] / 1e3,
        clearance=given["s"] / 1e3,
        capacity=given["C"],
        profile="iso16281" if given.get("profile", True) else None,
    )
    tilt = math.tan(given.get("tilt", 0.0))
    solution = bearing.solve(
        force=(given["Fr"], None, None), tilt=(None, tilt), model="iso16281", tolerance=1e-12
    )
    life = solution.life("standard" if given.get("edge", True) else None)
    near: dict[str, Any] = {"rtol": 1e-9}  # the bar; the table is right to 1e-10
    assert_close(solution.displacement[0] * 1e3, expected["delta_r"], **near)
    assert_close(
        solution.loads, np.transpose([expected["Qj"]] * 2), atol=1e-9 * given["Fr"], rtol=0
    )
    assert_close(life.l10r, expected["L10r"], **near)
    assert_close(life.equivalent_load, expected["Pref"], **near)
    assert_close(life.ring_capacities, [expected["Qci"], expected["Qce"]], **near)
    assert solution.lamina_loads is not None
    assert_close(solution.lamina_loads.max(), expected["q_max_lamina"], **near)
    # The standard's tilt is −x tan ψ: its moment has the other sign.
    assert_close(solution.moment[1] * 1e3, -expected["moment"], rtol=1e-9, atol=1e-7 * given["Fr"])


@pytest.mark.parametrize("row", rows("iso16281_ball_masta"), ids=lambda row: row["case"])
@pytest.mark.parametrize("model", ["iso16281", "solved"])
@pytest.mark.filterwarnings("ignore:.*not small compared")
def test_ball_bearing_of_masta(row: dict[str, Any], model: Any) -> None:
    steel = nacre.Elastic(young=210e9, poisson=0.3)
    bearing = DeepGrooveBall(
        count=7,
        diameter=11.5e-3,
        pitch_diameter=43.5e-3,
        clearance=row["s_mm"] / 1e3,
        capacity=23400.0,
        element=steel,
        inner=steel,
        outer=steel,
    )
    radial = row["Fr"] > 0
    force = (row["Fr"], None, None) if radial else (None, None, row["Fa"])
    solution = bearing.solve(force=force, model=model)
    found = solution.displacement[0 if radial else 2] * 1e6
    name = "delta_r_um" if radial else "delta_a_um"
    # The bar is 1e-4 for both; that of nacre's own contacts is the size of the cells.
    assert found == pytest.approx(row["exact_hertz"][name], rel=1e-4)
    assert found == pytest.approx(row["masta"][name], rel=1e-4)
    assert solution.life().l10r == pytest.approx(row["masta"]["L10r"], rel=1e-4)


def test_sjovalls_integrals_hold_for_many_elements() -> None:
    # J is the limit of many elements: the error of the sum falls as a power above 2 of 1/Z, the
    # integrand being smooth but for an end where it vanishes as x^(10/9).
    bearing = CylindricalRoller(
        count=120,
        diameter=2e-3,
        length=4e-3,
        pitch_diameter=100e-3,
        clearance=10e-6,
        profile=None,
    )
    solution = bearing.solve(force=(5000.0, 0.0, None), model="iso16281")
    epsilon = 0.5 * (1 - 10e-6 / (2 * solution.displacement[0]))
    radial, _ = load_integrals(epsilon, 10 / 9)
    assert 5000.0 == pytest.approx(120 * solution.largest_load * radial, rel=1e-3)


def test_axial_load_is_shared() -> None:
    bearing = AngularContactBall(
        count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=math.radians(25)
    )
    solution = bearing.solve(force=(0.0, 0.0, 2000.0), model="iso16281")
    share = 2000.0 / 12 / np.sin(solution.contact_angles)
    # The balance of 1e-9 is over all loads together, and the axial force their part sin α.
    assert_close(solution.loads, share, rtol=1e-9 / math.sin(math.radians(25)))


def test_life_has_the_exponents_of_the_standard() -> None:
    bearing = CylindricalRoller(count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3)
    loads = np.random.default_rng(3).uniform(0.0, 50.0, (14, 2, 40))
    once, twice = (reference_life(bearing, k * loads, 1.0) for k in (1.0, 2.0))
    assert once.l10r / twice.l10r == pytest.approx(16.0, rel=1e-12)
    # P = C L^(−3/10), with L ∝ q^−4: 2^(4·3/10).
    assert twice.equivalent_load / once.equivalent_load == pytest.approx(2**1.2, rel=1e-12)


def power_mean(loads: Any, power: float) -> Any:
    """Return the power mean over the elements."""
    return np.mean(np.asarray(loads) ** power, axis=0) ** (1 / power)


@pytest.mark.parametrize("rotating", ["inner", "outer"])
def test_the_ring_that_rotates_has_the_lower_power_of_the_mean_load(rotating: str) -> None:
    # ISO/TS 16281:2008, equations (25) to (29) of balls and (61) to (65) of rollers: the ring that
    # rotates has powers of 3 and 4, the other one 10/3 and 9/2.
    order = 1 if rotating == "inner" else -1
    random = np.random.default_rng(5)
    ball = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    loads = random.uniform(0.0, 500.0, (7, 2)) * [1.0, 2.0]
    life = reference_life(ball, loads, 1.0, rotating)
    powers = [3.0, 10 / 3][::order]
    sums = sum(
        (power_mean(loads[:, k], powers[k]) / life.capacities[k]) ** (10 / 3) for k in range(2)
    )
    assert life.l10r == pytest.approx(sums**-0.9, rel=1e-12)

    roller = CylindricalRoller(count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3)
    loads = random.uniform(0.0, 50.0, (14, 2, 40)) * np.array([1.0, 2.0])[:, None]
    life = reference_life(roller, loads, 1.0, rotating)
    powers = [4.0, 4.5][::order]
    sums = 0.0
    for k in range(2):
        lamina = life.capacities[k] * 40 ** (-7 / 9)
        sums += ((power_mean(loads[:, k], powers[k]) / lamina) ** 4.5).sum()
    assert life.l10r == pytest.approx(sums ** (-8 / 9), rel=1e-12)


def test_edge_factor_of_the_pressure_is_1_under_hertz() -> None:
    # ISO/TS 16281, eqs 58 and 59, in mm, N and MPa; its constant 271 has three digits: 2e-3.
    bearing = CylindricalRoller(count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3)
    loads, gamma = np.full((1, 2, 40), 40.0), np.array([[[bearing.gamma]]])
    signs = np.array([1, -1])[:, None]
    hertz = 271 * np.sqrt(loads * 40 / (9.6 * 10 * (1 - signs * gamma))) * 1e6
    assert_close(pressure_factors(bearing, loads, hertz), 1.0, rtol=2e-3, each=True)


def test_edge_factors_are_those_of_equation_60() -> None:
    factors = edge_factors(40)
    assert factors[0] == pytest.approx(2.33, abs=0.005)  # as quoted
    np.testing.assert_array_equal(factors, factors[::-1])
    # The lamina in the middle of an odd number has the limit, 1 for a distance of 0.
    odd = edge_factors(41)
    assert odd[20] == 1.0
    assert odd[0] == pytest.approx(1 - 0.01 / math.log(1.985 / 2), rel=1e-12)
    with pytest.raises(ValueError, match="count must be a number of laminae of at least 2, got 1"):
        edge_factors(1)
    for wrong in (40.5, True):
        with pytest.raises(TypeError, match=f"count must be an integer, got {wrong}"):
            edge_factors(wrong)  # type: ignore[arg-type]
    np.testing.assert_array_equal(edge_factors(40.0), factors)  # type: ignore[arg-type]


def test_unloaded_bearing_has_an_infinite_life_in_words() -> None:
    bearing = CylindricalRoller(
        count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3, clearance=41e-6
    )
    solution = bearing.solve(displacement=(1e-6, 0.0, None), model="iso16281")
    life = solution.life()
    assert "element" not in str(solution).splitlines()  # no table of none
    assert life.l10r == math.inf
    assert life.equivalent_load == 0.0
    assert "infinite: no element is loaded" in str(life)


@pytest.mark.parametrize(("count", "ratio"), [(8, 0.4568), (12, 0.555), (16, 0.595)])
def test_stiffness_across_the_load_over_that_along_it(count: int, ratio: float) -> None:
    # Without clearance the loads are as cos^(3/2) φ, and their rates as cos^(1/2) φ.
    bearing = DeepGrooveBall(count=count, diameter=11.5e-3, pitch_diameter=60e-3, clearance=0.0)
    tangent = bearing.solve(force=(1000.0, 0.0, None), model="iso16281").stiffness()
    angle = 2 * np.pi * np.arange(count) / count
    rate = np.sqrt(np.maximum(np.cos(angle), 0.0))
    closed = (rate @ np.sin(angle) ** 2) / (rate @ np.cos(angle) ** 2)
    assert closed == pytest.approx(ratio, abs=5e-4)
    # The approach, 2e-4 of the pitch radius, turns the directions of the loads a little.
    assert tangent[1, 1] / tangent[0, 0] == pytest.approx(closed, rel=1e-6)


@pytest.mark.parametrize(("count", "loaded"), [(8, 45.0), (12, 60.0), (16, 67.5)])
def test_stiffness_across_and_along_the_load_are_sums_over_the_loaded_half(
    count: int, loaded: float
) -> None:
    # Of elements with a load as δⁿ, δ = x cos θ: Σ cos^(n−1) sin² / Σ cos^(n+1) (derived); those at
    # 90° touch with no deflection, and carry nothing.
    theta = np.radians(np.arange(-loaded, loaded + 1, 360 / count))
    size: dict[str, Any] = {"count": count, "diameter": 5e-3, "pitch_diameter": 250e-3}
    for bearing, power in (
        (DeepGrooveBall(**size), 1.5),
        (CylindricalRoller(**size, length=5e-3, profile=None), 10 / 9),
    ):
        along = (np.cos(theta) ** (power + 1)).sum()
        across = (np.cos(theta) ** (power - 1) * np.sin(theta) ** 2).sum()
        solution = quiet(bearing.solve, force=(2000.0, 0.0, None), model="iso16281")
        stiffness = solution.stiffness()
        assert stiffness[1, 1] / stiffness[0, 0] == pytest.approx(across / along, rel=1e-4)
