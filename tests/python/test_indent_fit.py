"""Fits find the stored maximum likelihood, its standard errors, and what data cannot tell."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre.indent import Curve, Fit, Tip, fit

DATA = json.loads((Path(__file__).parents[1] / "data" / "inverse.json").read_text())
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
    return fit(
        curve,
        body,
        Tip.paraboloid(true["R"]),
        [PATHS[name] for name in case["free"] if name in PATHS],
        nuisance=[NUISANCES[name] for name in case["free"] if name in NUISANCES],
        noise=case["noise"],
        sigma=case["sigma"],
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


RELATIVE = [case for case in DATA["curves"] if case["noise"] == "relative"]


@pytest.mark.parametrize("case", RELATIVE, ids=lambda case: str(case["seed"]))
def test_estimates_are_the_stored_maximum_likelihood(case: dict[str, Any]) -> None:
    found = fitted(case, profile=False)
    for name, due in case["maximum_likelihood"].items():
        estimate, _ = scaled(case, found, name)
        assert abs(estimate - due) < 1e-4 * case["cramer_rao_sigma"][name], name


@pytest.mark.parametrize("case", RELATIVE, ids=lambda case: str(case["seed"]))
def test_standard_errors_are_cramers_and_raos(case: dict[str, Any]) -> None:
    # Without noise the estimate is the truth, at which the bound is stored.
    found = fitted(case, is_exact=True, profile=False)
    for name, due in case["cramer_rao_sigma"].items():
        _, error = scaled(case, found, name)
        assert error == pytest.approx(due, rel=1e-4), name


def test_a_thickness_of_the_substrates_material_is_not_identifiable() -> None:
    steel = nacre.Elastic(210e9, 0.3)
    body = nacre.HalfSpace(steel, [nacre.Layer(steel, 1e-6)])
    tip = Tip.paraboloid(1e-5)
    depth = np.linspace(5e-9, 1e-7, 40)
    noise = np.exp(0.01 * np.random.default_rng(3).standard_normal(40))
    force = nacre.indent.Indentation(body, tip).curve(approach=depth).load * noise
    found = fit((depth, force), body, tip, [PATHS["lnh"]])
    assert not found.is_identifiable
    assert PATHS["lnh"] in str(found.reasons) or found.reasons


def test_a_substrate_far_below_is_not_identifiable() -> None:
    layer = nacre.Layer(nacre.Elastic(3e9, 0.3), 1e-3)
    body = nacre.HalfSpace(nacre.Elastic(210e9, 0.3), [layer])
    tip = Tip.paraboloid(1e-5)
    # a = √(Rδ) up to 1e-6, 1e-3 of the layer.
    depth = np.linspace(5e-9, 1e-7, 40)
    noise = np.exp(0.01 * np.random.default_rng(4).standard_normal(40))
    force = nacre.indent.Indentation(body, tip).curve(approach=depth).load * noise
    found = fit((depth, force), body, tip, [PATHS["lnE1"], PATHS["lnE2"]])
    assert not found.identifiable[PATHS["lnE2"]]


def test_contact_point_and_drift_together_are_not_identifiable() -> None:
    [case] = [case for case in DATA["curves"] if case["seed"] == 16]
    assert not fitted(case).is_identifiable


@pytest.mark.filterwarnings("ignore:depth or force may be in a wrong unit")
def test_a_thin_layer_on_a_rigid_base_trades_modulus_for_thickness() -> None:
    layer = nacre.Layer(nacre.Elastic(3e9, 0.3), 2e-8)
    body = nacre.HalfSpace(nacre.RIGID, [layer])
    tip = Tip.paraboloid(1e-5)
    depth = np.linspace(1e-10, 3e-9, 40)
    noise = np.exp(0.01 * np.random.default_rng(5).standard_normal(40))
    force = nacre.indent.Indentation(body, tip).curve(approach=depth).load * noise
    found = fit((depth, force), body, tip, [PATHS["lnE1"], PATHS["lnh"]])
    assert not found.is_identifiable


def test_identifiable_fits_are_not_flagged() -> None:
    assert all(fitted(case).is_identifiable for case in RELATIVE[:2])


@pytest.mark.parametrize(
    ("depth", "force", "message"),
    [
        ([1e-9, 2e-9, math.nan, 4e-9], [1e-6, 2e-6, 3e-6, 4e-6], "depth"),
        ([1e-9, 2e-9, 3e-9, 4e-9], [-1e-6, -2e-6, -3e-6, -4e-6], "force"),
    ],
)
def test_wrong_data_are_refused(depth: list[float], force: list[float], message: str) -> None:
    body = nacre.HalfSpace(nacre.Elastic(3e9, 0.3))
    with pytest.raises(ValueError, match=message):
        fit((depth, force), body, Tip.paraboloid(1e-5), ["body.substrate.young"])
