"""Ball bearings carry on the shoulders that they have, and above 45 degrees are thrust bearings."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import quiet
from nacre.bearing import AngularContactBall, DeepGrooveBall, SphericalRoller, rating
from support import assert_close

SIZE: dict[str, Any] = {"count": 15, "diameter": 12.7e-3, "pitch_diameter": 70e-3}
BALLS = AngularContactBall(**SIZE, contact_angle=math.radians(40))
BARRELS = SphericalRoller(
    count=9,
    diameter=12e-3,
    length=11e-3,
    pitch_diameter=62e-3,
    contact_angle=0.23,
    profile_radius=35e-3,
    rows=1,
)
STANDARD: dict[str, Any] = {"model": "iso16281"}
OTHER_SIDE = r"element bears at a contact angle of .* degrees, where the rings have no shoulder"


@pytest.mark.parametrize("bearing", [BALLS, BARRELS], ids=["balls", "barrels"])
@pytest.mark.parametrize("model", ["iso16281", "solved"])
def test_a_single_row_carries_thrust_to_one_side(bearing: Any, model: Any) -> None:
    cone = math.tan(bearing.nominal_angle)
    for force, least in (
        ((0.0, 0.0, -1000.0), "0 N"),
        ((5000.0, 0.0, 0.0), f"{5000 * cone:.6g} N"),
        ((3000.0, -4000.0, 0.99 * 5000 * cone), f"{5000 * cone:.6g} N"),
    ):
        with pytest.raises(ValueError, match=f"force along z must be at least {least}"):
            bearing.solve(force=force, model=model)
    # The reaction of a prescribed displacement is outside the cone, too.
    with pytest.raises(ValueError, match="force along z must be at least"):
        bearing.solve(force=(None, None, 10.0), displacement=(60e-6, 0.0, None), model=model)


def test_loads_within_the_cone_are_carried_at_positive_angles() -> None:
    for asked in (
        {"force": (5000.0, 0.0, None)},  # locked along z
        {"force": (3000.0, -4000.0, 1.01 * 5000 * math.tan(BALLS.contact_angle))},
        {"force": (0.0, 0.0, 2000.0), "moment": (10.0, 0.0)},
    ):
        solution = BALLS.solve(**asked, **STANDARD)
        carried = solution.loads[:, 0] > 1e-6 * solution.largest_load
        assert (solution.contact_angles[carried, 0] > 0).all()
        pulled = solution.loads[:, 0] * np.sin(solution.contact_angles[:, 0])
        assert pulled.sum() == pytest.approx(solution.force[2], rel=1e-8)


def test_the_other_flank_of_a_groove_is_no_shoulder() -> None:
    # Grooves whose centres are 0.05 D apart: the balls touch the other flanks 2 · 0.05 D sin 40°
    # away, 0.82 mm; between both they carry nothing.
    idle = BALLS.solve(displacement=(0.0, 0.0, -0.5e-3), **STANDARD)
    assert idle.largest_load == 0.0
    with pytest.raises(ValueError, match=OTHER_SIDE):
        BALLS.solve(displacement=(0.0, 0.0, -0.84e-3), **STANDARD)
    with pytest.raises(ValueError, match="moment about y must be at most"):
        BALLS.solve(force=(0.0, 0.0, 2000.0), moment=(0.0, 100.0), **STANDARD)
    # Deep grooves have both shoulders.
    deep = DeepGrooveBall(**SIZE)
    both = [deep.solve(force=(0.0, 0.0, load), **STANDARD) for load in (1000.0, -1000.0)]
    assert_close(both[0].loads, both[1].loads, rtol=1e-8)


def test_steep_bearings_have_the_life_of_thrust_bearings() -> None:
    # All balls share the load: ISO/TS 16281's sum is (C_a/F_a)³ at the nominal angle, and a ball
    # carries F/(Z sin α) at that under load.
    axial, capacity = 5e3, 25e3
    bearing = AngularContactBall(
        count=16,
        diameter=7.144e-3,
        pitch_diameter=45e-3,
        contact_angle=math.radians(60),
        capacity=capacity,
    )
    solution = bearing.solve(force=(0.0, 0.0, axial), **STANDARD)
    found = solution.life()
    steeper = math.sin(solution.contact_angles[0, 0]) / math.sin(math.radians(60))
    assert 1 < steeper < 1.02
    assert found.l10r == pytest.approx((capacity / axial * steeper) ** 3, rel=1e-8)
    assert found.equivalent_load == pytest.approx(axial / steeper, rel=1e-8)


def _thrust(gamma: float, angle: float, grooves: tuple[float, float]) -> float:
    """Return f_c of thrust ball bearings, ISO/TR 1281-1:2021, formula (20), with table 1's λ, η."""
    inner, outer = grooves
    fit = (inner / outer * (2 * outer - 1) / (2 * inner - 1)) ** 0.41
    inside = fit * ((1 - gamma) / (1 + gamma)) ** 1.72
    factor = 98.0665 * 0.90 * (1 - math.sin(angle) / 3) * (2 * inner / (2 * inner - 1)) ** 0.41
    factor *= gamma**0.3 * (1 - gamma) ** 1.39 / (1 + gamma) ** (1 / 3)
    return float(factor * (1 + inside ** (10 / 3)) ** -0.3)


@pytest.mark.parametrize("degrees", [45.001, 60.0, 75.0, 89.99])
def test_axial_rating_of_steep_bearings(degrees: float) -> None:
    angle = math.radians(degrees)
    bearing = AngularContactBall(**SIZE, contact_angle=angle)
    gamma = 12.7 * math.cos(angle) / 70
    size = 1.3 * math.cos(angle) ** 0.7 * math.tan(angle) * 15 ** (2 / 3) * 12.7**1.8
    expected = _thrust(gamma, angle, (0.535, 0.535)) * size
    assert rating(bearing) == pytest.approx(expected, rel=1e-12)
    wide = dataclasses.replace(bearing, osculation=(0.55, 0.54))
    shares = [_thrust(gamma, angle, grooves) for grooves in ((0.55, 0.54), (0.54, 0.54))]
    assert rating(wide) == pytest.approx(expected * shares[0] / shares[1], rel=1e-12)
    # Near 90° the rating goes over into that of formula (23), whose γ is D/d_m.
    if degrees > 89:
        flat = 98.0665 * 0.6 * (1.07 / 0.07) ** 0.41 * (12.7 / 70) ** 0.3 * 2**-0.3
        assert rating(bearing) == pytest.approx(1.3 * flat * 15 ** (2 / 3) * 12.7**1.8, rel=1e-4)


def test_a_contact_beyond_the_shoulder_is_warned_of() -> None:
    low = dataclasses.replace(BALLS, shoulder_height=3e-3)
    # acos(1 − h/(f D)) of the grooves.
    expected = [math.acos(1 - 3 / (f * 12.7)) for f in (0.52, 0.53)]
    assert low.shoulders == pytest.approx(expected, rel=1e-12)
    light = quiet(low.solve, force=(0.0, 0.0, 1000.0), **STANDARD)
    reach = math.asin(_half_width(light) / 6.35e-3) + light.contact_angles[0, 0]
    assert reach < expected[0]
    assert not light.report.warnings
    heavy = quiet(low.solve, force=(0.0, 0.0, 20e3), **STANDARD)
    reach = math.asin(_half_width(heavy) / 6.35e-3) + heavy.contact_angles[0, 0]
    assert reach > expected[0]
    assert heavy.report.warnings[0].startswith(
        f"contacts with the inner ring reach {math.degrees(reach):.3g} degrees from the bottom of "
        f"the groove, beyond its shoulder at {math.degrees(expected[0]):.3g}"
    )
    # Nothing is warned of by default below the static rating, at any angle.
    for angle in (15, 40, 60):
        bearing = AngularContactBall(**SIZE, contact_angle=math.radians(angle))
        assert not quiet(bearing.solve, force=(0.0, 0.0, 20e3), **STANDARD).report.warnings
    deep = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    assert not quiet(deep.solve, force=(0.0, 0.0, 10e3), **STANDARD).report.warnings
    heavy = quiet(deep.solve, force=(0.0, 0.0, 40e3), **STANDARD)
    assert any("beyond its shoulder" in warning for warning in heavy.report.warnings)


def _half_width(solution: Any) -> float:
    """Return Hertz's half-width across the inner groove of a ball."""
    load, (along, rolling) = solution.loads[0, 0], solution.bearing.radii[0]
    ball, modulus = solution.bearing.radius, solution.bearing.modulus[0]
    found: float = nacre.hertz.Ellipse(ball, ball, modulus, load, along, rolling).semi_axes[0]
    return found


@pytest.mark.parametrize(("height", "message"), [(0.0, "above 0"), (6.4e-3, r"radius .* 6\.35 mm")])
def test_shoulders_of_no_height_and_beyond_the_middle_are_refused(
    height: float, message: str
) -> None:
    with pytest.raises(ValueError, match=f"shoulder_height must be .*{message}"):
        dataclasses.replace(BALLS, shoulder_height=height)
