"""Oliver and Pharr's numbers of unloading curves, with errors that hold."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import nacre
from nacre.indent import Curve, Indentation, OliverPharr, Tip, fit, oliver_pharr
from nacre.indent.classical import classical

DIAMOND = nacre.Elastic(1141e9, 0.07)
"""Oliver and Pharr (1992), section II."""
LOAD, DEEPEST, LEFT, POWER = 10e-3, 500e-9, 300e-9, 1.35
SLOPE = POWER * LOAD / (DEEPEST - LEFT)
CONTACT = DEEPEST - 0.75 * LOAD / SLOPE
AREA = 24.5 * CONTACT**2
"""Area of an ideal Berkovich tip."""
REDUCED = SLOPE / 2 * math.sqrt(math.pi / AREA)
BERKOVICH = Tip.berkovich()


def unloading(points: int = 200, noise: float = 0.0, seed: int = 0) -> Curve:
    depth = np.linspace(DEEPEST, LEFT + 2e-9, points)
    force = LOAD * ((depth - LEFT) / (DEEPEST - LEFT)) ** POWER
    return Curve(depth, force + noise * np.random.default_rng(seed).standard_normal(points))


@pytest.mark.parametrize("part", [(0.2, 0.98), (0.5, 0.95), (0.0, 1.0)])
def test_a_power_law_has_the_numbers_of_the_formulae(part: tuple[float, float]) -> None:
    one = oliver_pharr(unloading(), BERKOVICH, part)
    expected = {
        "hardness": LOAD / AREA,
        "reduced_modulus": REDUCED,
        "modulus": REDUCED,
        "stiffness": SLOPE,
        "power": POWER,
        "final_depth": LEFT,
        "largest_depth": DEEPEST,
        "largest_force": LOAD,
        "contact_depth": CONTACT,
        "area": AREA,
    }
    # Berkovich's 24.5 is rounded: 24.494 (3 sqrt(3) tan² 65.27°), 3e-4 of the area.
    for name, number in expected.items():
        assert getattr(one, name) == pytest.approx(number, rel=5e-4), name
    assert f"{one.reduced_modulus / 1e9:.1f} {one.hardness / 1e9:.2f}" == "31.1 2.70"
    assert one.notes[:-1] == ()
    assert "film and substrate together" in one.notes[-1]


def test_the_tip_and_the_factors_enter_by_their_formulae() -> None:
    plain = oliver_pharr(unloading(), BERKOVICH)
    other = oliver_pharr(unloading(), BERKOVICH, counterbody=DIAMOND, beta=1.034, epsilon=0.72)
    contact = DEEPEST - 0.72 * LOAD / SLOPE
    reduced = REDUCED / 1.034 * CONTACT / contact
    assert other.contact_depth == pytest.approx(contact, rel=1e-6)
    assert other.reduced_modulus == pytest.approx(reduced, rel=5e-4)
    assert other.hardness == pytest.approx(plain.hardness * (CONTACT / contact) ** 2, rel=1e-6)
    own = (1 - 0.07**2) / 1141e9
    assert other.modulus == pytest.approx(1 / (1 / reduced - own), rel=5e-4)


def test_elastic_contacts_give_back_the_modulus() -> None:
    """A paraboloid is Hertz' contact, for which 0.75 is exact; so is 1 for a flat punch."""
    glass = nacre.Elastic(70e9, 0.2)
    depth = np.linspace(200e-9, 2e-9, 150)
    for tip, epsilon, exponent in (
        (Tip.paraboloid(10e-6), 0.75, 1.5),
        (Tip.flat_punch(2e-6), 1.0, 1.0),
    ):
        load = Indentation(glass, tip).curve(approach=depth[::-1]).load[::-1]
        one = oliver_pharr(Curve(depth, load), tip, epsilon=epsilon)
        assert one.power == pytest.approx(exponent, rel=1e-6)
        assert one.modulus == pytest.approx(70e9 / 0.96, rel=1e-4)
        assert one.notes[:-1] == ()


def test_noise_alone_is_no_power_beyond_those_of_elastic_unloadings() -> None:
    """Half the powers of a flat punch with noise are below 1."""
    glass, tip = nacre.Elastic(70e9, 0.2), Tip.flat_punch(2e-6)
    depth = np.linspace(200e-9, 2e-9, 150)
    load = Indentation(glass, tip).curve(approach=depth[::-1]).load[::-1]
    powers = []
    for seed in range(20):
        noise = 1e-3 * load[0] * np.random.default_rng(seed).standard_normal(150)
        powers.append(oliver_pharr(Curve(depth, load + noise), tip, epsilon=1).power)
    assert 5 <= sum(power < 1 for power in powers) <= 15


def test_nine_of_ten_and_more_intervals_hold_the_truth() -> None:
    noise, inside = 2e-5, 0
    for seed in range(60):
        one = oliver_pharr(unloading(noise=noise, seed=seed), BERKOVICH)
        inside += abs(one.stiffness - SLOPE) < 2 * one.stiffness_error
        assert 0 < one.stiffness_error < 0.05 * SLOPE
    # Binomial of 0.954 and 60 trials: 51 or fewer have a probability of 0.6 %.
    assert inside >= 52
    # The error of H by that of h_c and P: dominated by h_c, 2 dh_c/h_c.
    assert one.hardness_error / one.hardness < 2 * one.stiffness_error / SLOPE


def test_a_whole_curve_with_holds_gives_the_same() -> None:
    rise = np.linspace(5e-9, DEEPEST, 200)
    back = unloading()
    held = np.full(100, DEEPEST)
    depth = np.concatenate([rise, held, back.depth])
    force = np.concatenate([LOAD * (rise / DEEPEST) ** 2, np.full(100, LOAD), back.force])
    whole = oliver_pharr(Curve(depth, force), BERKOVICH)
    assert whole.reduced_modulus == pytest.approx(REDUCED, rel=5e-4)


def test_creep_and_powers_that_none_has_are_warned_of() -> None:
    depth = np.linspace(DEEPEST, LEFT, 200)
    x = (depth - LEFT) / (DEEPEST - LEFT)
    with pytest.warns(nacre.NacreWarning, match="power of the unloading is 4, where elastic"):
        one = oliver_pharr(Curve(depth, LOAD * x**4), BERKOVICH)
    assert "power of the unloading" in one.notes[0]
    # A tenth more force over the last fiftieth of the depth, above the part that is fitted.
    nose = LOAD * (x**POWER + 0.1 * np.exp(-((1 - x) / 0.02)))
    with pytest.warns(nacre.NacreWarning, match="times that of the power law: the sample creeps"):
        oliver_pharr(Curve(depth, nose), BERKOVICH)


def test_what_is_no_unloading_is_refused() -> None:
    depth = np.linspace(1e-9, 100e-9, 50)
    rising = Curve(depth, 1e9 * depth**2)
    with pytest.raises(ValueError, match=r"unloading after its largest force, got a loading"):
        oliver_pharr(rising, BERKOVICH)
    one = unloading()
    for part in ((0.98, 0.2), (-0.1, 0.5), (0.2, 1.1)):
        with pytest.raises(ValueError, match="part must be two shares, 0 <= low < high <= 1"):
            oliver_pharr(one, BERKOVICH, part)
    with pytest.raises(TypeError, match=r"part must be two shares of the largest force, got 0\.2"):
        oliver_pharr(one, BERKOVICH, 0.2)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"between 0.5 and 0.5001 of the largest force, got \d"):
        oliver_pharr(one, BERKOVICH, (0.5, 0.5001))
    with pytest.raises(ValueError, match="epsilon must be positive and finite, got 0"):
        oliver_pharr(one, BERKOVICH, epsilon=0)
    with pytest.raises(ValueError, match="contact depth above 0, got -"):
        oliver_pharr(one.shifted(depth=400e-9), BERKOVICH)
    with pytest.raises(ValueError, match="counterbody must be stiffer than the reduced modulus"):
        oliver_pharr(one, BERKOVICH, counterbody=nacre.Elastic(10e9, 0.3))
    with pytest.raises(TypeError, match="counterbody must be an Elastic"):
        oliver_pharr(one, BERKOVICH, counterbody=nacre.RIGID)  # type: ignore[arg-type]


@pytest.mark.parametrize("noise", [0.0, 5e-5])
def test_classical_formulae_refuse_an_unloading_and_name_what_takes_it(noise: float) -> None:
    glass = nacre.Elastic(70e9, 0.2)
    with pytest.raises(ValueError, match=r"unloading curve .* oliver_pharr\(curve, tip\)"):
        classical(unloading(noise=noise), glass, BERKOVICH)
    soft = nacre.HalfSpace(glass, [nacre.Layer(nacre.Elastic(0.7e9, 0.4), 100e-9)])
    depth = np.linspace(1e-9, 100e-9, 60)
    for body in (nacre.HalfSpace(glass), soft):
        load = Indentation(body, BERKOVICH).curve(approach=depth).load
        assert classical(Curve(depth, load), body, BERKOVICH)  # elastic, whatever its law


def test_the_result_prints_and_is_data() -> None:
    one = oliver_pharr(unloading(noise=1e-5), BERKOVICH)
    assert "reduced modulus" in str(one)
    assert OliverPharr.from_dict(one.to_dict()) == one


def test_a_report_says_that_no_elastic_formula_is_for_an_unloading(tmp_path: Path) -> None:
    glass = nacre.HalfSpace(nacre.Elastic(70e9, 0.2))
    with pytest.warns(nacre.NacreWarning, match="does not describe"):
        wrong = fit(unloading(points=40), glass, BERKOVICH, ["body.substrate.young"], profile=False)
    with pytest.raises(ValueError, match="oliver_pharr"):
        wrong.classical()
    wrong.save(tmp_path / "a.svg")
    assert (tmp_path / "a.svg").stat().st_size > 0
