"""The basic life of ISO 281 is that of catalogues, and numbers in another unit are asked about."""

from __future__ import annotations

import itertools
import json
import math
import re
import tomllib
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bearings import ANGULAR, SPHERICAL, TAPERED, THRUST
from nacre.app.answer import answer
from nacre.bearing import (
    AngularContactBall,
    BearingLife,
    CylindricalRoller,
    DeepGrooveBall,
    Pair,
    PairLife,
    basic_life,
    contamination_range,
    equivalent_dynamic_load,
    estimated_balls,
    mean_dynamic_load,
    reference_viscosity,
    reliability_factor,
    static_rating,
)
from nacre.bearing.plausible import RANGES, doubts_on
from nacre.case import Case
from nacre.results.verdict import TEXTS
from support import Capture, command, written

TURN = math.pi / 30
"""Angular velocity of a revolution per minute [rad/s]."""
SKF_6309 = DeepGrooveBall(count=8, diameter=17.5e-3, pitch_diameter=72.5e-3, capacity=55.3e3)
NU = CylindricalRoller(count=13, diameter=18e-3, length=18e-3, pitch_diameter=96e-3, capacity=137e3)
OIL: dict[str, Any] = {"kinematic_viscosity": 20e-6, "contamination": 0.8}


def over_basic(life: BearingLife) -> float:
    """Return the reference life over the basic one."""
    assert life.basic_life is not None
    return life.l10r / life.basic_life


def turning(bearing: Any, load: float, axial: float | None = None, per_minute: float = 3000) -> Any:
    force = (load, 0.0, axial)
    return bearing.solve(force=force, model="iso16281", speed=per_minute * TURN)


def warned(call: Any) -> list[str]:
    """Return what a call warns of, or the error with which it refuses."""
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        try:
            call()
        except ValueError as error:
            return [str(error)]
    return [str(warning.message) for warning in seen]


def test_basic_lives_of_printed_examples() -> None:
    # SKF's catalogue, 6309 under 10 kN at 3000/min: 940 h; its C and P have three digits.
    hours = basic_life(SKF_6309, 10e3) * 1e6 / 60 / 3000
    assert hours == pytest.approx(940, rel=5e-3)
    life = turning(SKF_6309, 10e3).life()
    assert f"{hours:.1f} h, P 10 kN" in str(life)
    assert basic_life(NU, 10e3) == pytest.approx(13.7 ** (10 / 3), rel=1e-12)
    # Koyo prints X 0.56, Y 1.55 at f_0 F_a/C_0 = 1.03: P = 0.56 · 4 + 1.55 · 2.27 kN.
    axial = 1.03 * 8 * 17.5**2
    load = equivalent_dynamic_load(SKF_6309, 4e3, axial)
    assert load == pytest.approx(0.56 * 4e3 + 1.55 * axial, rel=1e-12)
    assert static_rating(SKF_6309) == pytest.approx(8 * 17.5**2 * 13.0, rel=0.02)  # f_0 of the 6309


@pytest.mark.parametrize(
    ("degrees", "x", "y", "e"),
    [
        (20, 0.43, 1.00, 0.57),
        (25, 0.41, 0.87, 0.68),
        (30, 0.39, 0.76, 0.80),
        (35, 0.37, 0.66, 0.95),
        (40, 0.35, 0.57, 1.14),
        (45, 0.33, 0.50, 1.34),
    ],
)
def test_factors_of_angular_contact(degrees: float, x: float, y: float, e: float) -> None:
    bearing = replace(ANGULAR, contact_angle=math.radians(degrees))
    assert equivalent_dynamic_load(bearing, 0.0, 1e3) == pytest.approx(y * 1e3, rel=1e-9)
    assert equivalent_dynamic_load(bearing, 1e3, 2e3) == pytest.approx(x * 1e3 + y * 2e3, rel=1e-9)
    # Up to e the axial load does not count; e has two digits.
    assert equivalent_dynamic_load(bearing, 1e3, 0.985 * e * 1e3) == 1e3
    assert equivalent_dynamic_load(bearing, 1e3, 1.02 * e * 1e3) > 1e3


@pytest.mark.parametrize(
    ("relative", "groove", "flat", "e"),
    [(0.172, 2.30, 1.47, 0.38), (1.38, 1.45, 1.19, 0.47), (6.89, 1.00, 1.00, 0.56)],
)
def test_factors_that_depend_on_the_load(
    relative: float, groove: float, flat: float, e: float
) -> None:
    bearing = replace(ANGULAR, contact_angle=math.radians(15))
    axial = relative * 12 * 10**2
    deep = DeepGrooveBall(count=12, diameter=10e-3, pitch_diameter=60e-3)
    assert equivalent_dynamic_load(deep, 0.0, axial) == pytest.approx(groove * axial, rel=1e-12)
    assert equivalent_dynamic_load(bearing, 0.0, axial) == pytest.approx(flat * axial, rel=1e-12)
    assert equivalent_dynamic_load(bearing, axial / e / 0.98, axial) == axial / e / 0.98


def test_factors_of_rollers() -> None:
    cot = 1 / math.tan(math.radians(14))
    for share in (0.0, 0.5, 0.99, 1.0, 1.5, 4.0):
        axial = share * 1.5 / cot * 1e3  # over e = 1.5 tan α
        single, double = 1e3, 1e3 + 0.45 / math.tan(0.17) * axial
        if share > 1:
            single = 400 + 0.4 * cot * axial
        assert equivalent_dynamic_load(TAPERED, 1e3, axial) == pytest.approx(single, rel=1e-9)
        if axial <= 1.5 * math.tan(0.17) * 1e3:
            found = equivalent_dynamic_load(SPHERICAL, 1e3, axial)
        else:
            double = 670 + 0.67 / math.tan(0.17) * axial
            found = equivalent_dynamic_load(SPHERICAL, 1e3, axial)
        assert found == pytest.approx(double, rel=1e-9)


def test_equivalent_loads_rise_and_scale() -> None:
    for bearing in (SKF_6309, NU, ANGULAR, TAPERED, SPHERICAL, THRUST):
        axials = [0.0] if bearing is NU else [0.0, 300.0, 1e3, 3e3, 1e4]
        radial = 0.0 if bearing is THRUST else 1e3
        loads = [equivalent_dynamic_load(bearing, radial, axial) for axial in axials]
        assert loads == sorted(loads)
        assert loads[0] == radial
        doubled = basic_life(bearing, 2 * radial, 2 * axials[-1])
        if bearing is not SKF_6309:  # whose Y falls with the load
            power = bearing.standards.life_exponent
            ratio = basic_life(bearing, radial, axials[-1]) / doubled
            assert ratio == pytest.approx(2**power, rel=1e-9)
    assert basic_life(NU, 0.0) == math.inf


@pytest.mark.parametrize(
    ("bearing", "forces"),
    [
        (NU, (1e3, 10.0)),
        (THRUST, (10.0, 1e3)),
        (replace(ANGULAR, contact_angle=math.radians(12)), (1e3, 2e3)),
        (replace(SPHERICAL, rows=1, contact_angle=0.0), (1e3, 10.0)),
    ],
    ids=["cylindrical", "thrust", "12°", "barrel"],
)
def test_factors_that_were_not_read_are_left_out(bearing: Any, forces: Any) -> None:
    with pytest.raises(ValueError, match="X and Y for this bearing under these forces are not in"):
        basic_life(bearing, *forces)
    assert basic_life(bearing, *(0.0 if bearing is THRUST else 1e3, 0.0)) > 0
    with pytest.raises(ValueError, match="radial must be finite and at least 0"):
        basic_life(bearing, -1.0)


@pytest.mark.parametrize("model", ["iso16281", "solved"])
def test_thrust_bearings_under_thrust_have_a_basic_life(model: Any) -> None:
    # The equilibrium leaves some 1e-17 of the force across the axis.
    life = THRUST.solve(force=(0.0, 0.0, 2e3), speed=100.0, model=model).life()
    assert life.basic_load == pytest.approx(2e3, rel=1e-6)
    assert life.basic_life == pytest.approx((life.capacity / 2e3) ** 3, rel=1e-6)


def test_a_left_out_life_is_said() -> None:
    life = turning(replace(ANGULAR, contact_angle=math.radians(12)), 1e3, 2e3).life()
    assert life.basic_life is life.basic_load is None
    assert "ISO 281, catalogue" not in str(life)
    assert "X and Y for this bearing under these forces are not in nacre" in str(life)


def test_mean_loads_live_as_long_as_all_loads() -> None:
    for bearing in (SKF_6309, NU):
        loads, shares = [2e3, 5e3, 9e3], [0.5, 0.3, 0.2]
        mean = mean_dynamic_load(bearing, loads, shares)
        used = sum(s / basic_life(bearing, p) for s, p in zip(shares, loads, strict=True))
        assert basic_life(bearing, mean) == pytest.approx(1 / used, rel=1e-12)
        assert mean_dynamic_load(bearing, [5e3], [1.0]) == pytest.approx(5e3, rel=1e-12)
        assert mean_dynamic_load(bearing, [0.0], [1.0]) == 0.0
        pairs: list[tuple[list[float], list[float]]] = [([1.0, 2.0], [1.0]), ([1.0], [0.5])]
        for loads, shares in [*pairs, ([], []), ([1.0, 1.0], [2.0, -1.0])]:
            with pytest.raises(ValueError, match=r"shares must be as many as loads, above 0, with"):
                mean_dynamic_load(bearing, loads, shares)
        for wrong in ([-1.0], [math.inf], [[1.0]]):
            with pytest.raises(ValueError, match="loads must be a list of finite numbers, at"):
                mean_dynamic_load(bearing, wrong, [1.0])  # type: ignore[arg-type]
        for kind in ("12", None, [True]):
            with pytest.raises(TypeError, match="loads must be a real array"):
                mean_dynamic_load(bearing, kind, [1.0])  # type: ignore[arg-type]
    solution = turning(SKF_6309, 5e3)
    spectrum = [(0.5, (2e3, 0.0, None), 100.0), (0.5, (6e3, 0.0, None), 300.0)]
    mean = mean_dynamic_load(SKF_6309, [2e3, 6e3], [0.25, 0.75])
    assert solution.life(spectrum=spectrum).basic_load == pytest.approx(mean, rel=1e-9)


# What the sentence of the print says: some 2 to 4 times, less with clearance.
@pytest.mark.parametrize("bearing", [NU, TAPERED, replace(SPHERICAL, clearance=0.0)])
def test_reference_lives_of_rollers_are_longer(bearing: Any) -> None:
    ratios = []
    for over in (3, 6, 12, 20):
        load = bearing.capacity / over
        axial = None if bearing is NU else load * math.tan(bearing.nominal_angle) * 1.26
        life = turning(bearing, load, axial).life()
        ratios.append(over_basic(life))
        assert "2 to 4 times as long" in life.comparison
    assert 2.0 < min(ratios)
    assert max(ratios) < 4.0
    loose = turning(replace(NU, clearance=40e-6), 137e3 / 12).life()
    assert over_basic(loose) < 2.4 < max(ratios)
    # Contacts rated without 0.83 alone are 0.83^-4 times as good.
    assert 0.83**-4 == pytest.approx(2.1, abs=0.01)
    for over in (3, 20):  # balls agree
        life = turning(SKF_6309, 55.3e3 / over).life()
        assert over_basic(life) == pytest.approx(1.0, abs=0.03)
        assert life.comparison is None


def test_the_basic_life_reaches_files_and_pairs(tmp_path: Path) -> None:
    life = turning(NU, 10e3, per_minute=2000).life()
    assert life.basic_load == pytest.approx(10e3, rel=1e-9)
    assert BearingLife.from_dict(life.to_dict()) == life
    assert nacre.load(life.save(tmp_path / "life.nc")) == life
    table = life.save(tmp_path / "life.csv").read_text("utf-8")
    assert "basic" in table
    assert f"{life.basic_life}" in table
    report = life.save(tmp_path / "life.html").read_text("utf-8")
    assert "ISO 281, catalogue" in report
    state = life.to_dict()
    for name in ("basic_life", "basic_load", "comparison", "notes"):  # older files
        del state[name]
    assert BearingLife.from_dict(state).notes == ()
    pair = Pair(ANGULAR, ANGULAR, arrangement="O", distance=30e-3, preload_force=500.0)
    both = pair.solve(force=(4e3, 0.0, 1e3), model="iso16281", speed=100.0)
    lives = [single.life().to_dict()["basic_life"] for single in both.bearings]
    found = both.life()
    # Lundberg and Palmgren's slope of balls.
    expected = sum(one ** (-10 / 9) for one in lives) ** (-0.9)
    assert found.basic_life == pytest.approx(expected, rel=1e-9)
    assert "ISO 281, catalogue" in str(found)
    assert PairLife.from_dict(found.to_dict()) == found


CASE = """
[bearing]
kind = "deep_groove_ball"
count = 8
diameter = 17.5e-3
pitch_diameter = 72.5e-3
capacity = 55.3e3

[bearing.solve]
force = { x = 10e3, y = 0 }
speed = 314.16
model = "iso16281"

[bearing.life]
reliability = 0.93
"""


@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")
def test_the_basic_life_reaches_case_files_and_the_page(tmp_path: Path, capsys: Capture) -> None:
    path = written(tmp_path, CASE)
    assert command("solve", path) == 0
    assert "ISO 281, catalogue  L10 169.1 million revolutions, 939.5 h, P 10 kN" in (
        capsys.readouterr().out
    )
    assert command("solve", path, "--json") == 0
    told = json.loads(capsys.readouterr().out)["life"]
    assert told["basic_life"] == pytest.approx(5.53**3, rel=1e-9)
    assert told["reliability_factor"] == pytest.approx(reliability_factor(0.93))
    parts = answer(Case(tomllib.loads(CASE)), "draft")["parts"]
    assert "ISO 281, catalogue" in parts["rows"]
    light = CASE.replace("10e3, y", "10, y")  # in kN
    assert any("are forces in N?" in text for text in answer_warnings(light))
    assert command("solve", written(tmp_path, light)) == 0
    assert "are forces in N?" in capsys.readouterr().out


def answer_warnings(text: str) -> list[str]:
    """Return the warnings on the page of a case."""
    warnings: list[str] = answer(Case(tomllib.loads(text)), "draft")["parts"]["warnings"]
    return warnings


RIGHT = turning(SKF_6309, 10e3)
RIGHT_NU = turning(NU, 10e3)
LIMIT = OIL | {"fatigue_load_limit": 1340.0}
BEYOND: dict[str, tuple[Any, str, str]] = {
    "limit in kN": (lambda: RIGHT.life(**LIMIT | {"fatigue_load_limit": 1.34}), "1.34 N", "in N?"),
    "limit in mN": (lambda: RIGHT.life(**LIMIT | {"fatigue_load_limit": 1.34e6}), "C_0", "in N?"),
    "limit of a roller in kN": (
        lambda: RIGHT_NU.life(**OIL, fatigue_load_limit=16.0),
        "16 N",
        "in N?",
    ),
    "limit for C_0": (lambda: RIGHT.life(**OIL, fatigue_load_limit=31.5e3), "0.5 C_0", "in N?"),
    "κ in percent": (lambda: RIGHT.life(viscosity_ratio=400.0, contamination=0.5), "400", "perce"),
    "κ of 50": (lambda: RIGHT.life(viscosity_ratio=50.0, contamination=0.5), "above 20", "perce"),
    "λ in nm": (lambda: RIGHT.life(film_ratio=250.0, contamination=0.5), "250", "length"),
    "η for ν": (lambda: RIGHT.life(**OIL | {"kinematic_viscosity": 0.018}), "0.018", "dynamic"),
    "η of thin oil for ν": (
        lambda: RIGHT.life(**OIL | {"kinematic_viscosity": 0.005}),
        "above 20",
        "dynamic",
    ),
    "ν in mm²/s": (lambda: RIGHT.life(**OIL | {"kinematic_viscosity": 20.0}), "20", "mm²/s"),
    "force in kN": (lambda: turning(SKF_6309, 10.0).life(), "0.001 C", "forces in N?"),
    "force of a roller in kN": (lambda: turning(NU, 10.0).life(), "0.001 C", "forces in N?"),
    "thrust in kN": (lambda: turning(ANGULAR, 0.0, 5.0).life(), "0.001 C", "forces in N?"),
    "speed in turns per hour": (
        lambda: RIGHT.life(speed=1e-5),
        "above 1 000 000 000 h",
        "speed in rad/s",
    ),
    "speed in 1/min": (lambda: RIGHT.life(speed=1500.0), "109 m/s", "rad/s, not in 1/min"),
    "speed of a solve in 1/min": (
        lambda: turning(NU, 10e3, per_minute=3000 / TURN).life(),
        "above 100 m/s",
        "rad/s, not in 1/min",
    ),
    "a load beyond C": (lambda: turning(SKF_6309, 400e3).life(), "below 0.0167 h", "rad/s"),
    "d_m in mm": (lambda: contamination_range("normal cleanliness", 72.5), "20 m", "in mm?"),
    "d_m in mm of a small one": (
        lambda: contamination_range("normal cleanliness", 15.0),
        "above 1 m",
        "not mm?",
    ),
    "d_m in mm for ν_1": (lambda: reference_viscosity(314.0, 72.5), "20 m", "in mm?"),
    "d_m in mm of a small one for ν_1": (
        lambda: reference_viscosity(314.0, 4.5),
        "4.5 m",
        "not mm?",
    ),
    "infinite speed": (lambda: RIGHT.life(speed=math.inf), "inf", "in rad/s"),
    "speed that bursts": (lambda: turning(NU, 1e3, per_minute=1e6), "1000 m/s", "rad/s: is it in"),
}


@pytest.mark.parametrize("name", BEYOND)
def test_numbers_in_other_units_are_asked_about(name: str) -> None:
    call, number, question = BEYOND[name]
    texts = warned(call)
    assert any(number in text and question in text for text in texts), texts


def test_right_numbers_are_not_asked_about() -> None:
    for call in (
        lambda: RIGHT.life(**LIMIT),
        lambda: RIGHT.life(**OIL),
        lambda: RIGHT_NU.life(**OIL | {"kinematic_viscosity": 80e-6}, reliability=0.9995),
        lambda: contamination_range("high cleanliness", 0.9),
        lambda: reference_viscosity(100.0, 3e-3),
        lambda: turning(SKF_6309, 400.0).life(),
        lambda: RIGHT.life(speed=-10.0),
    ):
        assert warned(call) == []


def test_what_is_asked_is_kept_and_judged() -> None:
    with pytest.warns(nacre.NacreWarning, match="is implausible"):
        life = RIGHT.life(**LIMIT | {"fatigue_load_limit": 1.34}, required_life=1.0)
    assert "warning: fatigue_load_limit 1.34 N is implausible, below" in str(life)
    verdict = life.verdict()
    assert verdict.level == "unknown"
    assert "may be in a wrong unit" in str(verdict)
    # A print of a bearing warns of nothing, and says it.
    solution = turning(SKF_6309, 10.0)
    assert warned(lambda: str(solution)) == []
    assert "may be in a wrong unit" in str(solution)


@pytest.mark.parametrize("name", RANGES)
def test_every_range_has_a_reason_and_a_level(name: str) -> None:
    known = RANGES[name]
    assert len(known.reason) > 20
    assert known.question.endswith("?")
    for end, way in ((known.least, 0.999), (known.most, 1.001)):
        if not 0 < end < math.inf:
            continue
        (text,) = (
            doubts_on(name, end * way * 7.0, 7.0) if known.scale else doubts_on(name, end * way)
        )
        assert known.question in text
        assert sum(words in text for words in TEXTS) == 1
        inside = end / way
        assert not (doubts_on(name, inside * 7.0, 7.0) if known.scale else doubts_on(name, inside))


# ISO 281:2007, table 12.
TABLE = {
    **{0.9: 1.0, 0.95: 0.64, 0.96: 0.55, 0.97: 0.47, 0.98: 0.37, 0.99: 0.25, 0.992: 0.22},
    **{0.994: 0.19, 0.996: 0.16, 0.998: 0.12, 0.999: 0.093, 0.9992: 0.087, 0.9994: 0.080},
    **{0.9995: 0.077},
}


def test_any_reliability_has_a_factor() -> None:
    for reliability, factor in TABLE.items():
        assert reliability_factor(reliability) == factor
        assert reliability_factor(1 - (1 - reliability)) == factor  # rounded
    shares = np.linspace(0.9, 0.9995, 400)
    factors = [reliability_factor(share) for share in shares]
    assert all(before > after for before, after in itertools.pairwise(factors))
    # Weibull's law, of which the table has two digits.
    weibull = 0.05 + 0.95 * (np.log(shares) / math.log(0.9)) ** (1 / 1.5)
    assert np.abs(weibull - factors).max() < 6e-3
    # A straight line in the share itself would be some 0.02 too large here.
    assert reliability_factor(0.92) == pytest.approx(0.05 + 0.95 * (0.7914 ** (2 / 3)), abs=6e-3)
    for wrong in (0.89, 0.9996, 1.0, 95.0, math.nan, -0.9):
        with pytest.raises(ValueError, match=r"reliability must be a share from 0.9 to 0.9995"):
            reliability_factor(wrong)


CATALOGUE = [
    # A maker's improved class: bore, outside diameter [mm], C, C_0 [N]; numbers of balls by eye.
    (25, 62, 23400.0, 11600.0, 7),
    (25, 52, 14800.0, 7800.0, 9),
    (30, 62, 20300.0, 11200.0, 9),
    (45, 100, 55300.0, 31500.0, 8),
]


@pytest.mark.parametrize("row", CATALOGUE, ids=lambda row: f"{row[0]} x {row[1]}")
def test_other_numbers_of_balls_are_named(row: Any) -> None:
    bore, outside, capacity, static, count = row
    keywords: dict[str, Any] = {"capacity": capacity, "static_capacity": static}
    keywords |= {"bore": bore * 1e-3, "outside_diameter": outside * 1e-3}
    (text,) = warned(lambda: estimated_balls(**keywords))
    assert re.search(rf"(?:count|,|are) {count}\b", text), text
    with pytest.warns(nacre.NacreWarning, match=f"count {count}, diameter"):
        known = estimated_balls(**keywords, count=count)
    assert known.count == count
    assert static_rating(known) == pytest.approx(static, rel=1e-6)


def test_estimates_of_angular_contact_bearings() -> None:
    # A bearing of known balls, whose ratings are those of the standards, is found again.
    for degrees, count in ((25, 14), (40, 12), (15, 20)):
        true = AngularContactBall(
            count=count,
            diameter=10e-3 if count < 20 else 6e-3,
            pitch_diameter=60e-3,
            contact_angle=math.radians(degrees),
        )
        assert true.capacity is not None
        with pytest.warns(nacre.NacreWarning, match=f"count {count}, diameter"):
            found = estimated_balls(
                bore=40e-3,
                outside_diameter=80e-3,
                capacity=true.capacity,
                static_capacity=static_rating(true),
                contact_angle=math.radians(degrees),
            )
        assert isinstance(found, AngularContactBall)
        assert found.diameter == pytest.approx(true.diameter, rel=1e-6)


@pytest.mark.parametrize("scale", [1e-3, 1e3, 0.102])
def test_ratings_in_other_units_are_refused(scale: float) -> None:
    ratings: dict[str, Any] = {"capacity": 19.5e3 * scale, "static_capacity": 11.3e3 * scale}
    if scale == 0.102:  # kgf: balls of a third would do, were there room for a few
        ratings["capacity"] = 19.5e3
    with pytest.raises(ValueError, match=r"are they in N\?"):
        estimated_balls(bore=30e-3, outside_diameter=62e-3, **ratings)
