"""Fits find the stored maximum likelihood, its standard errors, and what data cannot tell."""

import json
import math
import pickle
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import STEEL
from bodies import coated as coated_body
from nacre.indent import Curve, Fit, Tip, fit
from nacre.indent._profile import Estimate, reasons
from nacre.indent.classical import classical
from support import DATA

CURVES = json.loads((DATA / "inverse.json").read_text())["curves"]
PATHS = {
    "lnE1": "body.layers[0].material.young",
    "lnE2": "body.substrate.young",
    "lnh": "body.layers[0].thickness",
}
NUISANCES = {"d0": "contact_point", "drift": "drift"}


def fitted(case: dict[str, Any], *, is_exact: bool = False, profile: bool = True) -> Fit:
    """Return the fit of a stored curve, or of its loads without noise."""
    true = case["true"]
    layer = nacre.Layer(nacre.Elastic(true["E1"], true["nu1"]), true["h"])
    body = nacre.HalfSpace(nacre.Elastic(true["E2"], true["nu2"]), [layer])
    force = case["load_noise_free" if is_exact else "load"]
    curve = Curve(case["depth"], force, time=np.linspace(0, 1, len(force)))
    largest = 1.0 if case["noise"] == "relative" else max(case["load_noise_free"])
    return fit(
        curve,
        body,
        Tip.paraboloid(true["R"]),
        [PATHS[name] for name in case["free"] if name in PATHS],
        nuisance=[NUISANCES[name] for name in case["free"] if name in NUISANCES],
        noise=case["noise"],
        sigma=largest * case["sigma"],
        profile=profile,
    )


def scaled(case: dict[str, Any], found: Fit, name: str) -> tuple[float, float]:
    """Return an estimate and its standard error as the reference has them."""
    if name in PATHS:
        value = found.estimates[PATHS[name]]
        return math.log(value), found.standard_errors[PATHS[name]] / value
    deepest = case["depth"][-1]
    kind = NUISANCES[name]
    return found.estimates[kind] / deepest, found.standard_errors[kind] / deepest


KNOWN = [case for case in CURVES if "maximum_likelihood" in case]


@pytest.mark.parametrize("case", KNOWN, ids=lambda case: str(case["seed"]))
def test_estimates_are_the_stored_maximum_likelihood(case: dict[str, Any]) -> None:
    found = fitted(case, profile=False)
    for name, due in case["maximum_likelihood"].items():
        estimate, _ = scaled(case, found, name)
        assert abs(estimate - due) < 1e-4 * case["cramer_rao_sigma"][name], name


@pytest.mark.parametrize("case", KNOWN, ids=lambda case: str(case["seed"]))
def test_standard_errors_are_cramers_and_raos(case: dict[str, Any]) -> None:
    # Without noise the estimate is the truth, at which the bound is stored.
    found = fitted(case, is_exact=True, profile=False)
    for name, due in case["cramer_rao_sigma"].items():
        _, error = scaled(case, found, name)
        assert error == pytest.approx(due, rel=1e-4), name


TIP = Tip.paraboloid(1e-5)
STEEL_ON_STEEL = nacre.HalfSpace(STEEL, [nacre.Layer(STEEL, 1e-6)])
UNKNOWN: dict[str, tuple[Any, float, list[str], list[str]]] = {
    "a thickness of the substrate's material": (STEEL_ON_STEEL, 1e-7, ["lnh"], []),
    # a = √(Rδ) up to 1e-6, 1e-3 of the layer.
    "a substrate far below": (coated_body(3e9, 1e-3), 1e-7, ["lnE1", "lnE2"], ["lnE2"]),
    # Up to ten thicknesses, modulus trades for thickness.
    "a thin layer on a rigid base": (
        *(coated_body(3e9, 2.5e-8, nacre.RIGID), 3e-9),
        *(["lnE1", "lnh"], []),
    ),
}


@pytest.mark.parametrize("kind", UNKNOWN)
def test_what_data_cannot_tell_is_not_identifiable(kind: str) -> None:
    body, deepest, free, unknown = UNKNOWN[kind]
    depth = np.linspace(deepest / 20, deepest, 20)
    noise = np.exp(0.01 * np.random.default_rng(3).standard_normal(20))
    force = nacre.indent.Indentation(body, TIP).curve(approach=depth).load * noise
    found = fit((depth, force), body, TIP, [PATHS[name] for name in free])
    assert not all(found.identifiable.values())
    assert found.reasons
    assert not any(found.identifiable[PATHS[name]] for name in unknown)


def test_contact_point_and_drift_together_are_not_identifiable() -> None:
    [case] = [case for case in CURVES if case["seed"] == 16]
    found = fitted(case)
    # χ² falls along a narrow ridge, to thinner and softer coats.
    assert not any(found.identifiable.values())


def test_identifiable_fits_are_not_flagged() -> None:
    assert all(all(fitted(case).identifiable.values()) for case in KNOWN[:2])


DEPTH = np.linspace(5e-9, 2e-7, 40)
EXACT = 1e-6  # relative: loads are interpolated to 1e-9, and a fit stops at 1e-5 of an error


def coated(young: float = 3e9) -> nacre.HalfSpace:
    return coated_body(young, 1e-6, nacre.Elastic(70e9, 0.2))


def loads(depth: np.ndarray = DEPTH, tip: Tip = TIP) -> np.ndarray:
    return nacre.indent.Indentation(coated(), tip).curve(approach=depth).load


LOADS = loads()


def noisy(seed: int, share: float = 0.01) -> np.ndarray:
    return loads() * np.exp(share * np.random.default_rng(seed).standard_normal(DEPTH.size))


@pytest.mark.filterwarnings("ignore:the model does not describe", "ignore:the contact is too deep")
@pytest.mark.parametrize(("depth", "force"), [(1, 1e3), (1, 1e-3), (1, 1e6), (1e3, 1), (1e-3, 1)])
def test_a_wrong_unit_is_named(depth: float, force: float) -> None:
    data = DEPTH[::4] * depth, noisy(6)[::4] * force
    with pytest.warns(nacre.NacreWarning, match="in a wrong unit.* would be plausible"):
        fit(data, coated(), TIP, [PATHS["lnE1"]], profile=False)


def test_points_out_of_order_are_named() -> None:
    order = np.random.default_rng(7).permutation(DEPTH.size)
    with pytest.warns(nacre.NacreWarning, match="random order"):
        found = fit((DEPTH[order], noisy(6)[order]), coated(), TIP, [PATHS["lnE1"]])
    assert all(found.identifiable.values())  # the order does not matter without drift


@pytest.mark.filterwarnings("ignore:the model does not describe")
def test_unloading_is_named() -> None:
    depth = np.concatenate([DEPTH, DEPTH[::-1]])
    force = np.concatenate([noisy(6), 0.8 * noisy(7)[::-1]])
    with pytest.warns(nacre.NacreWarning, match=r"unloading is mixed in.*curve\.loading"):
        fit((depth, force), coated(), TIP, [PATHS["lnE1"]], profile=False)


CASES: list[tuple[Any, dict[str, Any], str]] = [
    (([1e-9, 2e-9, math.nan, 4e-9], [1e-6, 2e-6, 3e-6, 4e-6]), {}, "depth"),
    (([1e-9, 2e-9, 3e-9, 4e-9], [-1e-6, -2e-6, -3e-6, -4e-6]), {}, "force"),
    (
        (DEPTH, 1e-9 * np.random.default_rng(8).standard_normal(DEPTH.size)),
        {"noise": "absolute"},
        "the curve has no contact",
    ),
    ((DEPTH - 1e-6, LOADS), {"noise": "relative"}, "must lie in contact at the start"),
    ((DEPTH - 1e-6, LOADS), {}, "no depth lies in contact at the start"),
    # Negative forces have no relative noise.
    ((DEPTH, LOADS - 1e-5), {"noise": "relative"}, "noise='absolute'"),
    ((DEPTH, LOADS), {"free": ["body.layers[1].thickness"]}, "free must name parameters among"),
    ((DEPTH, LOADS), {"free": []}, "free must name a parameter"),
    ((DEPTH, LOADS), {"nuisance": ["drift"]}, "drift needs the time"),
    ((DEPTH, LOADS), {"nuisance": ["zero"]}, "nuisance must name"),
    ((DEPTH, LOADS), {"noise": "white"}, "noise must be 'auto', 'relative' or 'absolute'"),
    ((DEPTH, LOADS), {"sigma": 0.0}, "sigma must be positive"),
]


@pytest.mark.parametrize(("data", "options", "message"), CASES)
def test_wrong_data_and_arguments_are_refused(
    data: Any, options: dict[str, Any], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        fit(data, coated(), TIP, **({"free": [PATHS["lnE1"]]} | options))


def test_nuisances_of_several_curves_are_their_own() -> None:
    time = np.linspace(0.0, 10.0, DEPTH.size)
    zeros, drifts, compliance = (3e-9, -2e-9), (1e-10, -2e-10), 2e-6
    curves = []
    for zero, drift in zip(zeros, drifts, strict=True):
        force = loads()
        curves.append(Curve(DEPTH + zero + drift * time + compliance * force, force, time=time))
    nuisance = ("contact_point", "drift", "compliance")
    free = [PATHS["lnE1"]]
    body = coated(2e9)
    found = fit(curves, body, TIP, free, nuisance=nuisance, noise="absolute", profile=False)
    assert found.estimates[PATHS["lnE1"]] == pytest.approx(3e9, rel=1e-4)
    for number, (zero, drift) in enumerate(zip(zeros, drifts, strict=True)):
        name = f"curves[{number}]."
        assert found.estimates[f"{name}contact_point"] == pytest.approx(zero, rel=1e-3)
        assert found.estimates[f"{name}drift"] == pytest.approx(drift, rel=1e-3)
        assert found.estimates[f"{name}compliance"] == pytest.approx(compliance, rel=1e-3)


def test_the_area_of_a_paraboloid_is_its_radius() -> None:
    # Sections of a paraboloid are 2πRd: 1.2 of the area is 1.2 of the radius.
    force = loads(tip=Tip.paraboloid(1.2e-5))
    by_area = fit((DEPTH, force), coated(), TIP, ["tip.area"], profile=False)
    by_radius = fit((DEPTH, force), coated(), TIP, ["tip.radius"], profile=False)
    assert by_area.estimates["tip.area"] == pytest.approx(1.2, rel=EXACT)
    assert by_radius.estimates["tip.radius"] == pytest.approx(1.2e-5, rel=EXACT)
    force = force * np.exp(0.01 * np.random.default_rng(10).standard_normal(DEPTH.size))
    by_area, by_radius = (
        fit((DEPTH, force), coated(), TIP, [name], profile=False, noise="relative", sigma=0.01)
        for name in ("tip.area", "tip.radius")
    )
    assert 1e-5 * by_area.standard_errors["tip.area"] == pytest.approx(
        by_radius.standard_errors["tip.radius"], rel=1e-5
    )


def test_a_radius_trades_with_the_modulus_without_a_prior() -> None:
    steel = nacre.HalfSpace(nacre.Elastic(210e9, 0.3))
    force = nacre.indent.Indentation(steel, TIP).curve(approach=DEPTH).load
    force = force * np.exp(0.01 * np.random.default_rng(9).standard_normal(DEPTH.size))
    free = ["body.substrate.young", "tip.radius"]
    found = fit((DEPTH, force), steel, TIP, free)
    assert not any(found.identifiable.values())
    assert "trades with tip.radius" in found.reasons["body.substrate.young"]
    known = fit((DEPTH, force), steel, TIP, free, prior={"tip.radius": (1e-5, 2e-7)})
    assert all(known.identifiable.values())
    # The force goes with √R: 2 % of R are 1 % of E, beside 0.16 % by the noise.
    assert known.standard_errors["body.substrate.young"] / 210e9 == pytest.approx(0.0101, rel=0.05)


def test_residuals_are_kept_and_a_changed_state_is_refused() -> None:
    found = fit((DEPTH, noisy(6)), coated(), TIP, [PATHS["lnE1"]])
    state = json.loads(json.dumps(found.to_dict()))
    for copy in (Fit.from_dict(state), pickle.loads(pickle.dumps(found))):
        np.testing.assert_array_equal(copy.residuals[0], found.residuals[0])
    with pytest.raises(ValueError, match="another version may read it"):
        Fit.from_dict(state | {"format": 99})
    with pytest.raises(ValueError, match="Fit: the key 'more' is unknown"):
        Fit.from_dict(state | {"more": 1})


def test_fits_are_drawn(tmp_path: Path) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    found = fit((DEPTH, noisy(6)), coated(), TIP, [PATHS["lnE1"]])
    axes = found.plot()
    assert axes.get_ylabel().startswith("force [")
    assert len(axes.figure.axes) == 2
    for name in ("page.pdf", "page.png"):
        found.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 5000
    pyplot.close("all")


@pytest.mark.parametrize(("ratio", "due"), [(0.1, 1.36), (0.5, 0.47), (2.0, -0.39), (10.0, -0.84)])
def test_oliver_and_pharrs_bias_at_a_contact_as_wide_as_the_layer(ratio: float, due: float) -> None:
    # a = h, ν = 0.3; another program's biases, in whole per cents.
    body = coated_body(ratio, 1.0, nacre.Elastic(1.0, 0.3))
    test = nacre.indent.Indentation(body, Tip.paraboloid(1e3))
    depth = np.linspace(0.05, 1.0, 80) * test.at(radius=1.0).approach
    curve = Curve(depth, test.curve(approach=depth).load)
    rows = {row.method: row for row in classical(curve, body, test.tip)}
    assert rows["Oliver and Pharr"].bias == pytest.approx(due, abs=0.01)


def test_dimitriadis_modulus_is_that_of_his_series() -> None:
    # Equations (11) and (12) for a bonded layer with ν = 1/2: the coefficients follow from those of
    # his Green's function, and the printed last one has the other sign.
    alpha = -(1.2876 - 1.4678 * 0.5 + 1.3442 * 0.25) / 0.5
    beta = (0.6387 - 1.0277 * 0.5 + 1.5164 * 0.25) / 0.5
    coefficients = [
        1.0,
        -2 * alpha / math.pi,
        (2 * alpha / math.pi) ** 2,
        -8 / math.pi**3 * (alpha**3 + 4 * math.pi**2 / 15 * beta),
        -16 * alpha / math.pi**4 * (alpha**3 + 3 * math.pi**2 / 5 * beta),
    ]
    young, radius, thickness = 20e3, 5e-6, 1.5e-6
    depth = np.linspace(0.02e-6, 0.5e-6, 40)
    x = np.sqrt(radius * depth) / thickness
    series = sum(c * x**k for k, c in enumerate(coefficients))
    force = 16 / 9 * young * math.sqrt(radius) * depth**1.5 * series
    gel = nacre.Layer(nacre.Elastic(young, 0.5), thickness)
    rows = classical(
        Curve(depth, force), nacre.HalfSpace(nacre.RIGID, [gel]), Tip.paraboloid(radius)
    )
    (row,) = (row for row in rows if row.method == "Dimitriadis")
    # The paper prints four digits of each coefficient.
    assert row.modulus == pytest.approx(young / 0.75, rel=1e-3)


@pytest.mark.parametrize(("apart", "fits"), [(3.83, True), (3.85, False)])
def test_another_minimum_fits_as_well_up_to_the_95_per_cent_of_one_parameter(
    apart: float, fits: bool
) -> None:
    # χ² of one degree of freedom is below 3.8415 in 95 % of all cases.
    unknown = SimpleNamespace(
        name="body.layers[0].material.young", kind="", is_log=True, value=math.exp
    )
    model: Any = SimpleNamespace(unknowns=[unknown], names=[unknown.name], low=[-9.0], high=[9.0])
    one = np.ones((1, 1))
    best = Estimate(
        x=np.zeros(1),
        chi2=7.0,
        variance=2.0,
        quantile=1.96,
        covariance=1e-4 * one,
        correlation=one,
        condition=1.0,
        alone=np.array([0.01]),
    )
    minima = [(np.array([1.0]), 7.0 + 2.0 * apart)]
    told = reasons(model, best, {unknown.name: (-0.0196, 0.0196)}, minima)
    assert ("another minimum, at 2.718" in "".join(told.values())) == fits


def test_the_old_names_warn_and_give_the_same(tmp_path: Path) -> None:
    found = fit((DEPTH, noisy(6)), coated(), TIP, [PATHS["lnE1"]])
    with pytest.warns(DeprecationWarning, match=r"write all\(fit\.identifiable\.values\(\)\)"):
        assert found.is_identifiable == all(found.identifiable.values())
    with pytest.warns(DeprecationWarning, match=r"write save\(path\)"):
        found.report(tmp_path / "old.html")
    found.save(tmp_path / "new.html")
    assert (tmp_path / "old.html").stat().st_size > 5000
    assert (tmp_path / "new.html").stat().st_size > 5000
