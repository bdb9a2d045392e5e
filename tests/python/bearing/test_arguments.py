"""Arguments of bearings: what may be left out, what follows, and what is of other units."""

from __future__ import annotations

import dataclasses
import math
import pickle
from typing import Any

import numpy as np
import pytest

import nacre
from nacre.bearing import (
    AngularContactBall,
    CylindricalRoller,
    DeepGrooveBall,
    SphericalRoller,
    TaperedRoller,
    rating,
)

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
ROLLERS: dict[str, Any] = {"count": 14, "diameter": 10e-3, "length": 9.6e-3}
KINDS: dict[str, Any] = {
    "cylindrical": CylindricalRoller(**ROLLERS, pitch_diameter=65e-3),
    "tapered": TaperedRoller(
        count=17, diameter=8e-3, length=11e-3, pitch_diameter=48e-3, contact_angle=0.25
    ),
    "spherical": SphericalRoller(
        count=9,
        diameter=12e-3,
        length=11e-3,
        pitch_diameter=62e-3,
        contact_angle=0.23,
        profile_radius=35e-3,
    ),
    "deep groove": DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3),
    "angular": AngularContactBall(
        count=15, diameter=12.7e-3, pitch_diameter=70e-3, contact_angle=math.radians(40)
    ),
}
STANDARD: dict[str, Any] = {"model": "iso16281"}


@pytest.mark.parametrize("bearing", KINDS.values(), ids=KINDS)
def test_none_stands_for_none_along_all_axes(bearing: Any) -> None:
    left = bearing.solve(force=(500.0, 0.0, None), **STANDARD)
    for name in ("displacement", "moment", "tilt"):
        assert bearing.solve(force=(500.0, 0.0, None), **{name: None}, **STANDARD) == left
    assert bearing.solve(force=None, **STANDARD) == bearing.solve(**STANDARD)
    assert bearing.solve(force=np.array([500.0, 0.0, None]), **STANDARD) == left


def test_zero_is_taken_where_the_model_has_zero() -> None:
    rollers, barrels = KINDS["cylindrical"], KINDS["spherical"]
    left = rollers.solve(force=(5e3, 0.0, None), **STANDARD)
    assert rollers.solve(force=(5e3, 0.0, 0.0), **STANDARD) == left
    held = {"displacement": (None, None, 0.0)}
    assert rollers.solve(force=(5e3, 0.0, None), **held, **STANDARD) == left
    left = barrels.solve(force=(5e3, 0.0, 0.0), **STANDARD)
    assert barrels.solve(force=(5e3, 0.0, 0.0), moment=(0.0, 0), **STANDARD) == left
    for wrong in ({"force": (5e3, 0.0, 1.0)}, {"displacement": (None, None, 1e-6)}):
        with pytest.raises(ValueError, match=r"along z must be None or 0"):
            rollers.solve(**wrong, **STANDARD)
    with pytest.raises(ValueError, match="moment must be None or 0"):
        barrels.solve(moment=(1.0, 0.0), **STANDARD)


def test_what_is_left_out_follows() -> None:
    bearing = CylindricalRoller(**ROLLERS, raceway_diameters=(55e-3, 75.041e-3))
    assert bearing.pitch_diameter == pytest.approx(65.0205e-3, rel=1e-12)
    assert bearing.clearance == pytest.approx(41e-6, rel=1e-9)  # of a difference of 20 mm
    assert bearing.capacity == rating(bearing)
    assert KINDS["deep groove"].clearance == 0.0
    # The grooves' centres, 0.05 D apart, are 0.05 D cos α apart in the radial direction.
    assert KINDS["angular"].clearance == pytest.approx(
        2 * 0.05 * 12.7e-3 * (1 - math.cos(math.radians(40))), rel=1e-12
    )
    for one in (bearing, *KINDS.values()):
        again = eval(repr(one), vars(nacre.bearing) | {"Elastic": nacre.Elastic})
        assert again == one == pickle.loads(pickle.dumps(one))


def test_what_followed_gives_way_to_other_arguments() -> None:
    bearing = CylindricalRoller(**ROLLERS, raceway_diameters=(55e-3, 75.041e-3))
    other = dataclasses.replace(bearing, diameter=10.01e-3)
    assert other.clearance == pytest.approx(21e-6, rel=1e-9)
    assert other.capacity == rating(other) != bearing.capacity
    rated = dataclasses.replace(bearing, capacity=50e3)
    assert dataclasses.replace(rated, diameter=10.01e-3).capacity == 50e3
    # Without raceways the clearance of another bearing is an argument as any.
    alike = CylindricalRoller(
        **ROLLERS, pitch_diameter=bearing.pitch_diameter, clearance=bearing.clearance
    )
    assert alike.clearance == bearing.clearance
    steep = dataclasses.replace(KINDS["angular"], contact_angle=0.3)
    assert steep.clearance < KINDS["angular"].clearance
    for given, message in (
        ({"pitch_diameter": 66e-3}, "pitch_diameter must not be given beside"),
        ({"clearance": 40e-6}, "clearance must not be given beside"),
    ):
        with pytest.raises(ValueError, match=message):
            dataclasses.replace(bearing, **given)  # type: ignore[arg-type]


MILLIMETRES: list[tuple[str, dict[str, Any], str]] = [
    ("cylindrical", {"diameter": 10.0, "length": 9.6, "pitch_diameter": 65.0}, "^diameter must"),
    ("cylindrical", {"length": 9.6}, r"^length must be at most 1 m.*got 9\.6"),
    ("cylindrical", {"pitch_diameter": 65.0}, "^pitch_diameter must be at most 20 m"),
    (
        "cylindrical",
        {"pitch_diameter": None, "raceway_diameters": [55.0, 75.0]},
        "^raceway_diameters must be at most 20 m",
    ),
    ("cylindrical", {"clearance": 0.041}, "clearance must be at most a tenth .* got 41 mm"),
    ("cylindrical", {"clearance": 2e-3}, "clearance must be at most a tenth .*, 1 mm"),
    (
        "cylindrical",
        {"pitch_diameter": None, "raceway_diameters": (55e-3, 77.5e-3)},
        r"clearance must be at most a tenth .*got 2\.5 mm",
    ),
    ("tapered", {"clearance": 0.02}, "clearance must be at most a tenth"),
    ("tapered", {"diameter": 8.0, "length": 11.0, "pitch_diameter": 48.0}, "^diameter must"),
    ("spherical", {"profile_radius": 35.0}, "^profile_radius must be at most 20 m"),
    ("spherical", {"groove_radius": 36.0}, "^groove_radius must be at most 20 m"),
    ("spherical", {"clearance": 0.04}, "clearance must be at most a tenth"),
    ("deep groove", {"diameter": 7.92, "pitch_diameter": 34.55}, "^diameter must be at most"),
    ("deep groove", {"diameter": 0.4, "pitch_diameter": 1.2}, "^diameter must be at most"),
    ("angular", {"diameter": 12.7, "pitch_diameter": 70.0}, "^diameter must be at most"),
    ("angular", {"density": 7.85e-9}, "^density must be from 100 to 25000"),
    ("angular", {"inner": nacre.Elastic(210e3, 0.3)}, "^inner must have a modulus from"),
    ("angular", {"density": 7.85e12}, "^density must be from 100 to 25000"),
    ("angular", {"diameter": 12.7e-6}, "^diameter must be at least 5e-05 m"),
    ("tapered", {"outer": nacre.Elastic(210e15, 0.3)}, "^outer must have a modulus from"),
    ("deep groove", {"element": nacre.Elastic(310.0, 0.3)}, "^element must have a modulus"),
    (
        "deep groove",
        {"outer": nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(300e3, 0.3), 3e-6)])},
        r"^outer\.layers\[0\] must have a modulus from 1e\+06 to",
    ),
    (
        "deep groove",
        {"outer": nacre.HalfSpace(STEEL, [nacre.Layer(STEEL, 3.0)])},
        r"^outer\.layers\[0\] must be thinner than an element",
    ),
    (
        "deep groove",
        {"diameter": 1.2e-3, "pitch_diameter": 7.2},
        r"^pitch_diameter must be below 1000 diameters of an element, 1200 mm:.* got 7200 mm",
    ),
]


@pytest.mark.parametrize(("kind", "given", "message"), MILLIMETRES)
def test_millimetres_and_megapascals_are_refused(
    kind: str, given: dict[str, Any], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        dataclasses.replace(KINDS[kind], **given)
    with (
        nacre.display_units("N-mm-MPa"),
        pytest.raises(ValueError, match=message),
    ):
        dataclasses.replace(KINDS[kind], **given)


def test_a_refusal_names_the_units_that_are_set() -> None:
    steel = nacre.Elastic(210e3, 0.3)
    with (
        nacre.display_units("N-mm-MPa"),
        pytest.raises(ValueError, match="in N, m, Pa and kg whatever display_units says, N-mm-MPa"),
    ):
        DeepGrooveBall(count=8, diameter=8e-3, pitch_diameter=35e-3, element=steel)


def test_bearings_of_all_sizes_are_bearings() -> None:
    # A ball of 0.5 mm, a slewing ring of 6 m, a needle, plastic balls, and the loosest group of
    # ISO 5753-1.
    DeepGrooveBall(count=6, diameter=0.5e-3, pitch_diameter=2e-3)
    AngularContactBall(count=200, diameter=80e-3, pitch_diameter=6.0, contact_angle=0.7)
    CylindricalRoller(
        count=20, diameter=1.5e-3, length=13e-3, pitch_diameter=12e-3, clearance=30e-6
    )
    plastic = nacre.Elastic(2.8e9, 0.4)
    DeepGrooveBall(count=7, diameter=8e-3, pitch_diameter=35e-3, element=plastic, density=1400.0)
