"""Boundary of nacre.indent with Python, charts over coatings, and contacts on grids."""

from __future__ import annotations

import json
import math
import pickle
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import STEEL, quiet
from nacre.indent import Adhesion, Indentation, IndentSolution, Tip, fit, slope_of, solve
from nacre.indent.charts import bulk_limit, information, pull_off_over_thickness
from nacre.indent.classical import gao_weights
from nacre.results.values import decode, encode
from support import DATA, errors, interrupted, refused, table


def bare(adhesion: Adhesion | None = None, radius: float = 1e-5) -> Indentation:
    return Indentation(STEEL, Tip.paraboloid(radius), adhesion=adhesion)


def test_states_have_the_shape_of_what_is_given() -> None:
    assert np.ndim(bare().at(load=1e-3).approach) == 0
    assert bare().at(load=[[1e-3, 2e-3]]).approach.shape == (1, 2)


def test_progress_counts_contacts_and_an_exception_ends_the_work() -> None:
    counts: list[tuple[int, int]] = []
    loads = [1e-3, 2e-3, 3e-3]
    state = bare().at(load=loads, progress=lambda *count: counts.append(count))
    assert counts == [(1, 3), (2, 3), (3, 3)]
    assert (state.load == bare().at(load=loads).load).all()

    def end(finished: int, _: int) -> None:
        counts.append((finished, 0))
        if finished == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        solve(STEEL, Tip.paraboloid(1e-5), load=loads, progress=end)
    assert counts[3:] == [(1, 0), (2, 0)]


@pytest.mark.parametrize(
    "value",
    [Tip.paraboloid(1e-5), Tip.cone(slope=0.3), Adhesion.jkr(0.1), Adhesion.dmt(0.1)],
    ids=repr,
)
def test_values_survive_pickles(value: object) -> None:
    assert pickle.loads(pickle.dumps(value)) == value


def test_pull_off_is_that_of_the_reference() -> None:
    for row in json.loads((DATA / "jkr.json").read_text())["table"]:
        if row["E1_over_E2"] in (0.1, 4.0):
            (force,) = pull_off_over_thickness(row["E1_over_E2"], [row["h_over_a0"]])
            # The digits that pull-off by this program and the reference share at least.
            assert force == pytest.approx(row["load_control"]["pull_off_over_piwR"], rel=1e-8)


@pytest.mark.parametrize(
    ("ratio", "limits"),
    [
        (0.1, (0.0128, 0.011, 0.0128)),
        (0.5, (0.0243, 0.0208, 0.0243)),
        (2.0, (0.0141, 0.0121, 0.0142)),
    ],
)
def test_limits_of_bulk_formulae(ratio: float, limits: tuple[float, float, float]) -> None:
    # Limits of an error of 1 %, found by another program to three digits.
    found = bulk_limit([ratio])
    for values, limit in zip(found.values(), limits, strict=True):
        assert values[0] == pytest.approx(limit, rel=0.01)


YOUNG, POISSON, THICKNESS = (
    "body.layers[0].material.young",
    "body.layers[0].material.poisson",
    "body.layers[0].thickness",
)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("thickness", [0.1, 1.0, 3.0])
def test_gaos_functions_are_derivatives_of_the_punchs_stiffness(
    poisson: float, thickness: float
) -> None:
    # Gao, Chiu and Lee (1992): a punch on a layer that differs from its substrate by d ln G and dν
    # has d ln S = I0 d ln G + I1 dν/(1 − ν), exactly to first order.
    steel = nacre.Elastic(1.0, poisson)
    body = nacre.HalfSpace(steel, [nacre.Layer(steel, thickness)])
    state = Indentation(body, Tip.flat_punch(1.0)).at(approach=0.1)
    found = state.derivatives([YOUNG, POISSON])
    shear, lateral = gao_weights(thickness, poisson)
    assert found[YOUNG].stiffness / state.stiffness == pytest.approx(shear, rel=1e-12)
    # At fixed shear modulus instead of Young's: d ln G/dν = −1/(1 + ν) at fixed E.
    own = found[POISSON].stiffness / state.stiffness + shear / (1 + poisson)
    assert own * (1 - poisson) == pytest.approx(lateral, rel=1e-12)


@pytest.mark.parametrize("ratio", [0.2, 10.0])
def test_information_is_what_a_fit_states(ratio: float) -> None:
    layer = nacre.Layer(nacre.Elastic(ratio, 0.3), 1.0)
    body = nacre.HalfSpace(nacre.Elastic(1.0, 0.3), [layer])
    tip = Tip.paraboloid(1e3)
    test = Indentation(body, tip)
    depth = np.linspace(0.05, 1.0, 60) * test.at(radius=1.5).approach
    force = test.curve(approach=depth).load
    free = [YOUNG, THICKNESS]
    found = fit((depth, force), body, tip, free, noise="relative", sigma=0.01, profile=False)
    least = information(ratio, [1.5])
    # Without noise the fit ends at the truth, to 1e-5 of an error.
    assert least["young"][0] == pytest.approx(found.standard_errors[YOUNG] / ratio, rel=1e-4)
    assert least["thickness"][0] == pytest.approx(found.standard_errors[THICKNESS], rel=1e-4)


def test_derivatives_are_by_path_in_the_shape_of_the_state() -> None:
    test = bare(Adhesion.jkr(0.1))
    state = test.at(load=[1e-3, 2e-3])
    found = state.derivatives()
    assert list(found) == test.parameters == list(found)
    assert found["adhesion.work"].approach.shape == (2,)
    h = 1e-6
    radii = (1e-5 * (1 + h), 1e-5 * (1 - h))
    more, less = (bare(Adhesion.jkr(0.1), radius).at(load=[1e-3, 2e-3]) for radius in radii)
    slope = (more.approach - less.approach) / (2e-5 * h)
    assert found["tip.radius"].approach == pytest.approx(slope, rel=1e-7)
    assert set(state.stress([0.0, 1e-7], 1e-7)) == {"rr", "tt", "zz", "rz", "von_mises"}
    assert state.stress([0.0, 1e-7], 1e-7)["zz"].shape == (2, 2)


def test_pressures_are_in_proportion_to_moduli_work_and_strength() -> None:
    # At a given radius: derivatives over logarithms add up to the pressure, of shapes to nothing.
    layer = nacre.Layer(nacre.Elastic(3e9, 0.4), 1e-6)
    body = nacre.HalfSpace(nacre.Elastic(70e9, 0.22), [layer])
    adhesion = Adhesion.maugis(work=0.05, strength=50e6)
    state = Indentation(body, Tip.sphere(5e-6), adhesion=adhesion).at(radius=[3e-7, 6e-7])
    numbers = {
        YOUNG: 3e9,
        "body.substrate.young": 70e9,
        "adhesion.work": 0.05,
        "adhesion.strength": 50e6,
    }
    found = state.derivatives(list(numbers))
    assert list(found) == list(numbers)
    inside, outside = [0.0, 1e-7], [7e-7, 2e-6]
    pressure = sum(found[path].pressure(inside) * value for path, value in numbers.items())
    assert pressure == pytest.approx(state.pressure(inside), rel=1e-9)
    moved = sum(found[path].displacement(outside) * value for path, value in numbers.items())
    assert np.abs(moved).max() < 1e-9 * state.displacement(outside).max()
    wider = sum(found[path].outer_radius * value for path, value in numbers.items())
    assert np.abs(wider).max() < 1e-9 * state.outer_radius.min()
    assert np.abs(found["adhesion.strength"].outer_radius).min() * 50e6 > 1e-9


WRONG = {
    "Tip.sphere(-1.0)": "radius must be finite and above 0, got -1",
    "Tip.sphere(5e-324)": "radius must be between 1e-100 and 1e100",
    "slope_of(70.3)": "half_angle must be between 0 and pi/2",
    "Tip.cone(slope=70)": "slope must be above 0 and at most 5.*half_angle=.*got 70",
    "Tip.cone(half_angle=70)": "half_angle must be between 0 and pi/2.*deg2rad.*70",
    "Tip.cone(half_angle=0.1)": "slope must be .* at most 5",
    "Tip.cone()": "exactly one of slope and half_angle",
    "Tip.cone(slope=0.3, half_angle=1.2)": "exactly one of slope and half",
    "Tip.rounded_cone(1e-7, slope=70)": "slope must be .*half_angle=",
    "Tip.flat_cone(1e-7, slope=70)": "slope must be .*half_angle=.*got 70",
    "Tip.flat_cone(1e-7)": "exactly one of slope",
    "Tip.profile([0.0, 2.0, 1.0], [0.0, 0.1, 0.2])": "profile radii must be ascending",
    "Tip.profile([0.0, 1.0], [0.0, 0.1])": "profile",
    "Tip.area_function([1.0, -1.0], 1.0)": "area function must be above 0",
    "Adhesion.maugis(0.1, 0.0)": "strength must be finite and above 0",
    "ball.at()": "exactly one of load, approach and radius",
    "ball.at(load=1e-3, approach=1e-9)": "load",
    "ball.at(load=-1.0)": "load must be above 0, or nothing touches, got -1",
    "ball.at(radius=1.0)": "radius must be below the radius of the sphere, got 1",
    "ball.at(load=[])": "array is empty",
    "ball.at(load=1.0, branch='upper')": 'branch must be "stable" or "unstable"',
    "ball.pull_off()": "give an adhesion",
    "ball.curve(approach=np.ones((1, 1)))": "approach must have one dimension",
    "ball.curve(approach=[1e-9], wrt=['tip.size'])": "wrt must be paths among",
    "ball.at(load=1e-3).pressure(-1.0)": "r must be finite and at least 0, got -1",
    "ball.at(load=1e-3).stress(0.0, 0.0)": "z must be at least 1e-2",
    "bulk_limit([0.1], error=0.0)": "error must be above 0",
    "pull_off_over_thickness(0.0, [1.0])": "young must be finite and above 0",
}


BY_NAME = {
    "Tip.cone(0.5)": r"cone\(\) takes 0 positional arguments",
    "Tip.rounded_cone(1e-7, 0.5)": r"rounded_cone\(\) takes 1 positional argument",
    "Tip.flat_cone(1e-7, 0.5)": r"flat_cone\(\) takes 1 positional argument",
    "Tip.rounded_cone(slope=0.3)": "radius",
}
"""Half the angle of a cone and its slope are both near 1: the name says which is meant."""


@table(*errors(ValueError, WRONG), *errors(TypeError, BY_NAME))
def test_bad_input_is_refused(call: str, kind: type[Exception], words: str) -> None:
    names = globals() | {"ball": Indentation(STEEL, Tip.sphere(1e-5)), "slope_of": slope_of}
    refused(call, kind, words, names)


def test_an_interrupt_ends_long_work_at_once() -> None:
    # A contact of 400 thicknesses takes some tenths of a second.
    setup = """
import numpy as np
import nacre
from nacre.indent import Indentation, Tip
film = nacre.Layer(nacre.Elastic(1e9, 0.3), 1e-7)
test = Indentation(nacre.HalfSpace(nacre.Elastic(210e9, 0.3), [film]), Tip.paraboloid(1.0))
"""
    assert interrupted(setup, "test.at(radius=np.full(10**5, 4e-5))") == 0


# Thousands of layers make a state slow.
LONG = """
import numpy as np
import nacre
from nacre.indent import Adhesion, Indentation, Tip
gels = [nacre.Layer(nacre.Elastic((1 + k % 3) * 1e6, 0.4999), 1e-7) for k in range(3000)]
body = nacre.HalfSpace(nacre.RIGID, gels)
test = Indentation(body, Tip.paraboloid(1e-3), adhesion=Adhesion.{adhesion})
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("adhesion", "call"),
    [
        ("maugis(0.05, 3e5)", "pull_off()"),
        ("maugis(0.05, 3e5)", "at(load=0.0)"),
        ("jkr(0.05)", "at(load=np.full(1000, 1e-4))"),
    ],
)
def test_ctrl_c_is_seen_at_once(adhesion: str, call: str) -> None:
    assert interrupted(LONG.format(adhesion=adhesion), f"test.{call}") == 0


# Tips by slope or half angle, and contacts that are too deep for small slopes.

ANGLE = np.deg2rad(70.3)


@pytest.mark.parametrize(
    ("by_angle", "by_slope"),
    [
        (Tip.cone(half_angle=ANGLE), Tip.cone(slope=1 / math.tan(ANGLE))),
        (
            Tip.rounded_cone(radius=1e-7, half_angle=ANGLE),
            Tip.rounded_cone(1e-7, slope=1 / math.tan(ANGLE)),
        ),
        (Tip.flat_cone(1e-7, half_angle=ANGLE), Tip.flat_cone(1e-7, slope=1 / math.tan(ANGLE))),
    ],
)
def test_a_half_angle_is_a_slope(by_angle: Tip, by_slope: Tip) -> None:
    assert by_angle.numbers == pytest.approx(by_slope.numbers, rel=1e-15)
    assert by_angle.numbers["slope"] == pytest.approx(0.35805, rel=1e-4)
    assert pickle.loads(pickle.dumps(by_angle)) == by_angle
    assert eval(repr(by_angle), {"Tip": Tip}) == by_angle
    assert decode(json.loads(json.dumps(encode(by_angle)))) == by_angle


@pytest.mark.parametrize(
    ("tip", "shallow", "deep"),
    [
        # The slope is a/√(R²−a²) of a sphere, a/R of a paraboloid; at 0.5 δ is 0.215 R and 0.25 R.
        (Tip.sphere(5e-6), 1.05e-6, 1.15e-6),
        (Tip.sphere(5e-6), 1e-7, 10e-6),
        (Tip.paraboloid(5e-6), 1.2e-6, 1.3e-6),
        # δ over a is π/2 times the slope of a cone, and so it is taken of a punch.
        (Tip.flat_punch(1e-6), 0.75e-6, 0.8e-6),
    ],
)
def test_deep_contacts_are_warned_of(tip: Tip, shallow: float, deep: float) -> None:
    test = Indentation(STEEL, tip)
    assert not test.at(approach=shallow).warnings
    assert not test.curve(approach=[shallow]).warnings
    assert not solve(STEEL, tip, approach=shallow).warnings
    for call in (
        lambda: test.at(approach=[shallow, deep]),
        lambda: test.curve(approach=[shallow, deep]),
        lambda: solve(STEEL, tip, approach=[shallow, deep]),
    ):
        with pytest.warns(nacre.NacreWarning, match="too deep for its radius") as told:
            found = call()
        assert [str(one.message) for one in told] == list(found.warnings)
    assert "warning: the contact is too deep" in str(found)
    assert isinstance(found, IndentSolution)
    assert IndentSolution.from_dict(found.to_dict()) == found


def test_steep_cones_are_warned_of_and_berkovichs_is_not() -> None:
    assert not Indentation(STEEL, Tip.berkovich()).at(load=1e-3).warnings
    with pytest.warns(nacre.NacreWarning, match="up to 0.60"):
        Indentation(STEEL, Tip.cone(slope=0.6)).at(load=1e-3)


def test_a_fit_is_warned_of_once() -> None:
    tip, depth = Tip.sphere(5e-6), np.linspace(1e-7, 2e-6, 20)
    load = quiet(Indentation(STEEL, tip).curve, approach=depth).load
    noise = np.exp(0.01 * np.random.default_rng(1).standard_normal(20))
    with pytest.warns(nacre.NacreWarning, match="too deep") as told:
        found = fit((depth, load * noise), STEEL, tip, ["body.substrate.young"], profile=False)
    assert [str(one.message) for one in told] == list(found.warnings)
    assert "warning: the contact is too deep" in str(found)


# Grids.

CASES = json.loads((DATA / "axisym.json").read_text(encoding="utf-8"))["cases"]
ROUND = [case for case in CASES if case["tip"]["kind"] in ("paraboloid", "sphere")]
assert len(ROUND) == 10


def body_of(case: dict[str, Any]) -> nacre.HalfSpace:
    def material(of: dict[str, Any]) -> nacre.Elastic:
        return nacre.Elastic(of["young"], of["poisson"])

    base = case["substrate"]
    layers = [
        nacre.Layer(material(layer), layer["thickness"], interface=layer["interface"])
        for layer in case["layers"]
    ]
    return nacre.HalfSpace(nacre.RIGID if base == "rigid" else material(base), layers)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:the contact is not small")  # both take half-spaces
@pytest.mark.filterwarnings("ignore:the peak pressure")  # soft tips, for the formulae only
@pytest.mark.parametrize("case", ROUND, ids=[case["name"] for case in ROUND])
def test_contacts_on_grids_agree_within_the_errors_that_they_state(case: dict[str, Any]) -> None:
    body, radius = body_of(case), case["tip"]["R"]
    is_sphere = case["tip"]["kind"] == "sphere"
    tip = Tip.sphere(radius) if is_sphere else Tip.paraboloid(radius)
    shape = nacre.Sphere(radius) if is_sphere else nacre.Paraboloid(radius, radius)
    a = case["rows"][len(case["rows"]) // 2]["a"]
    exact = Indentation(body, tip).at(radius=a)
    grid = nacre.Grid(shape=(256, 256), size=(2.4 * a, 2.4 * a))
    solution = nacre.solve(shape, body, load=exact.load, grid=grid)
    stated = solution.report.discretisation
    assert stated is not None
    assert stated["peak_pressure"] is not None
    assert abs(solution.approach - exact.approach) < stated["approach"] < 1e-3 * exact.approach
    # The centres of the four cells in the middle are half a cell off both axes.
    centre = exact.pressure(np.hypot(*grid.spacing) / 2)
    pressure = solution.pressure[127:129, 127:129].mean()
    assert abs(pressure - centre) < stated["peak_pressure"] < 1e-3 * centre


def test_tabors_parameter_is_that_of_maugis() -> None:
    """λ = σ0 (9 R / (2π w E*²))^(1/3), Maugis (1992), is 1.1570 μ: Johnson and Greenwood (1997)."""
    radius, modulus, work, strength = 1e-5, 7e10, 0.05, 2e8
    found = nacre.indent.tabor_parameter(radius, modulus, work, strength=strength)
    maugis = strength * (9 * radius / (2 * np.pi * work * modulus**2)) ** (1 / 3)
    assert maugis / found == pytest.approx(1.1570, abs=5e-5)
    reach = 16 * work / (9 * 3**0.5 * strength)
    again = nacre.indent.tabor_parameter(radius, modulus, work, distance=reach)
    assert again == pytest.approx(found, rel=1e-14)
    for wrong in ({}, {"distance": 1e-9, "strength": 1e8}):
        with pytest.raises(ValueError, match="exactly one of distance and strength"):
            nacre.indent.tabor_parameter(radius, modulus, work, **wrong)
    with pytest.raises(ValueError, match="work must be positive and finite, got -1"):
        nacre.indent.tabor_parameter(radius, modulus, -1, distance=1e-9)
