"""What is outside of the model is refused by one error that names the argument."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nacre
from bodies import quiet
from nacre import bearing, fatigue, indent

STEEL = nacre.Elastic(210e9, 0.3)
BALL = nacre.Sphere(5e-3)
GRID = nacre.Grid((16, 16), (3e-4, 3e-4))
ROLLERS: dict[str, Any] = {
    "count": 14,
    "diameter": 10e-3,
    "length": 9.6e-3,
    "pitch_diameter": 65e-3,
}
BEARING = bearing.CylindricalRoller(**ROLLERS)
BALLS = bearing.DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
RADIAL: dict[str, Any] = {"force": (1000.0, 0.0, None), "model": "iso16281"}
WORDS = np.array(["solved", "iso16281"])
CRITERION = fatigue.DangVan(520.0, 330.0)


@pytest.fixture(scope="module")
def pressed() -> nacre.Solution:
    """Return a ball on cells of a fifth of its contact."""
    fine = nacre.Grid((24, 24), (3e-4, 3e-4))
    return nacre.solve(BALL, STEEL, load=40.0, grid=fine)


def slide(**given: Any) -> Any:
    return nacre.slide(BALL, STEEL, grid=GRID, load=10.0, **given)


def sweep(**given: Any) -> Any:
    case = {"shape": BALL, "body": STEEL, "grid": GRID, "load": 1.0}
    return nacre.sweep(case, {"load": [1.0]}, **given)


def life(**given: Any) -> Any:
    return BEARING.solve(**RADIAL).life(**given)


CALLS: dict[str, tuple[Any, str]] = {
    # functions
    "progress of a bearing": (lambda _: BEARING.solve(**RADIAL, progress=1), "progress must be"),  # type: ignore[arg-type]
    "progress of fatigue": (lambda s: fatigue.assess(s, progress=1), "progress must be callable"),  # type: ignore[arg-type]
    "progress of a study": (lambda _: sweep(progress=1), "progress must be True, False or None"),
    "progress of a map": (
        lambda s: fatigue.shakedown_map(s, friction=[0.0], progress="x"),  # type: ignore[arg-type]
        "progress must be callable, got 'x'",
    ),
    "progress of a ratio": (
        lambda s: bearing.life_ratio(s, s, bearing.LundbergPalmgren(), progress=1),  # type: ignore[arg-type]
        "progress must be callable, got 1",
    ),
    # words
    "model": (lambda _: BEARING.solve(**RADIAL | {"model": WORDS}), 'model must be "solved"'),
    "edge": (lambda _: life(edge=WORDS), 'edge must be "standard"'),
    "rotating": (lambda _: life(rotating=["inner"]), 'rotating must be "inner"'),
    "rule": (lambda s: fatigue.assess(s, rule=WORDS), "rule must be 'von_mises'"),  # type: ignore[arg-type]
    "rule of a history": (
        lambda _: fatigue.shakedown(np.zeros((2, 6)), rule=WORDS),  # type: ignore[arg-type]
        'rule must be "von_mises"',
    ),
    "branch": (
        lambda _: indent.solve(STEEL, indent.Tip.sphere(1e-6), load=1e-3, branch=WORDS),  # type: ignore[arg-type]
        "branch must be 'stable'",
    ),
    "control": (
        lambda _: indent.solve(STEEL, indent.Tip.sphere(1e-6), load=1e-3, control=WORDS),  # type: ignore[arg-type]
        "control must be 'load'",
    ),
    "profile": (
        lambda _: bearing.CylindricalRoller(**ROLLERS, profile=WORDS),  # type: ignore[arg-type]
        "profile must be a profile",
    ),
    # truth values for numbers
    "friction of a slide": (
        lambda _: slide(friction=True, force=(0.5, 0.0)),
        "friction must be a number.* got True",
    ),
    "friction of a step": (
        lambda _: slide(friction=0.1, steps=[{"friction": np.True_, "force": (0.5, None)}]),
        "friction must be a number",
    ),
    "friction of fatigue": (
        lambda s: fatigue.assess(s, friction=True),
        "friction must be a real number",
    ),
    "friction of a map": (
        lambda s: fatigue.shakedown_map(s, friction=[True, False]),
        "friction must be a real array",
    ),
    # limits in MPa beside moduli in Pa
    "fatigue_limit": (
        lambda _: bearing.IoannidesHarris(fatigue_limit=350.0),
        r"fatigue_limit must be 0, or at least 100000 Pa, got 350\.0",
    ),
    "yield_stress": (
        lambda s: s.stress_summary(yield_stress={"substrate": 900.0}),
        r"yield_stress must be in the units of the moduli, .* 2\.1e\+11; got 900",
    ),
    "strength of a plan": (
        lambda s: s.stress_plan().summary(strength=[1200.0]),
        "strength must be in the units of the moduli",
    ),
    "shear_yield": (
        lambda s: fatigue.assess(s, shear_yield=600.0),
        "shear_yield must be in the units of the moduli",
    ),
    "bending": (
        lambda s: fatigue.assess(s, criteria=[CRITERION]),
        "bending must be in the units of the moduli",
    ),
    # sizes beyond any bearing
    "force": (lambda _: BEARING.solve(force=(1e300, 0.0, None)), "force must be at most"),
    "displacement": (
        lambda _: BEARING.solve(displacement=(1e300, 0.0, None)),
        r"displacement must be at most 0\.01",
    ),
    "moment": (lambda _: BEARING.solve(moment=(1e300, None)), "moment must be at most"),
    "tilt": (lambda _: BEARING.solve(tilt=(1e300, None)), "tilt must be at most 1"),
    "speed": (
        lambda _: BEARING.solve(**RADIAL, speed=1e300),
        "speed must be lower: elements .* at most",
    ),
    "rotation": (lambda _: BEARING.solve(**RADIAL, rotation=1e300), "rotation must be at most"),
    "capacity": (
        lambda _: bearing.CylindricalRoller(**ROLLERS, capacity=48.4),
        r"capacity must be in N, some 4\.84e\+04",
    ),
    "rating_factor": (
        lambda _: bearing.CylindricalRoller(**ROLLERS, rating_factor=1e300),
        "rating_factor must be from",
    ),
    "crown": (
        lambda _: bearing.CylindricalRoller(**ROLLERS, raceway_crown=(1e-300, None)),
        "raceway_crown must be at least the length",
    ),
    "osculation": (
        lambda _: bearing.DeepGrooveBall(
            count=7, diameter=11.5e-3, pitch_diameter=43.5e-3, osculation=(1e300, 0.53)
        ),
        "osculation must be at most 100",
    ),
    "film": (
        lambda s: bearing.film_thickness(s, speed=1e300, viscosity=0.02, pressure_viscosity=20e-9),
        "speed times viscosity must be between",
    ),
    "friction beyond all": (
        lambda s: fatigue.assess(s, friction=1e300),
        "friction must be a number, finite",
    ),
}


@pytest.mark.parametrize("name", CALLS)
def test_one_error_names_the_argument(name: str, pressed: nacre.Solution) -> None:
    call, message = CALLS[name]
    with pytest.raises((TypeError, ValueError), match=message):
        call(pressed)


def test_pressures_at_sharp_ends_have_two_digits() -> None:
    sharp = bearing.CylindricalRoller(**ROLLERS, profile=None)
    solved = quiet(sharp.solve, force=(4000.0, 0.0, None), cells=(40, 24))
    text = str(solved)
    assert f"peak pressure  {solved.peak_pressure / 1e9:.2g} GPa" in text
    assert "ends are sharp: their pressure has no limit" in text
    rounded = quiet(BEARING.solve, force=(4000.0, 0.0, None), cells=(40, 24))
    assert f"peak pressure  {rounded.peak_pressure / 1e9:.4g} GPa" in str(rounded)
    assert "sharp" not in str(rounded) + str(sharp.solve(**RADIAL))
