"""Random indentations: every returned state is a disc, every refusal a clear error."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import Phase, given
from hypothesis import strategies as st

import nacre
import support
from nacre.indent import Adhesion, Indentation, IndentState, Tip
from support import powers

fuzz = support.fuzz(4, phases=[Phase.generate])
# Contacts are random, and many are deep.
pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")

REFUSALS = (ValueError, nacre.ConvergenceError)


# Lengths are some thicknesses of the layers, and the modulus of an elastic base is 1.
materials = st.builds(nacre.Elastic, powers(-2.5, 3.0), st.floats(0.0, 0.499))
layers = st.builds(
    lambda material, thickness, slips: nacre.Layer(
        material, thickness, interface="frictionless" if slips else "bonded"
    ),
    materials,
    powers(-0.3, 0.7),
    st.integers(0, 4).map(lambda k: k == 0),
)
bases = st.one_of(st.just(nacre.RIGID), st.builds(nacre.Elastic, st.just(1.0), st.floats(0, 0.49)))
bodies = st.builds(nacre.HalfSpace, bases, st.lists(layers, min_size=1, max_size=3))

lengths = powers(-0.3, 1.5)
slopes = powers(-2.0, -0.5)
radii = powers(-1.0, 1.0)


def wavy(size: float, height: float) -> Tip:
    """Return a sampled tip whose flank is not convex."""
    r = np.linspace(0.0, 60.0, 121)
    return Tip.profile(r, r**2 / (2 * size) + height * (1 - np.cos(1.5 * r)))


ended = st.one_of(
    st.builds(Tip.paraboloid, lengths),
    st.builds(lambda radius: Tip.sphere(12.0 + radius), lengths),
    st.builds(lambda slope, radius: Tip.rounded_cone(radius, slope=slope), slopes, lengths),
)
others = st.one_of(
    st.builds(Tip.cone, slope=slopes),
    st.builds(Tip.power, powers(-2, -0.5), st.floats(0.6, 6.0)),
    st.builds(Tip.rounded_punch, powers(-1.0, 0.0), lengths),
    st.builds(Tip.flat_cone, powers(-1.0, 0.0), slope=slopes),
    st.builds(wavy, lengths, powers(-3.0, -1.0)),
)
punches = st.builds(Tip.flat_punch, powers(-1.0, 0.7))
works = powers(-4.0, -1.0)
maugis = st.builds(Adhesion.maugis, works, powers(-2.0, 0.5))
adhesions = st.one_of(st.builds(Adhesion.jkr, works), maugis)


def at(test: Indentation, **given: Any) -> IndentState | None:
    """Return a state that is in order, or None where nacre refuses with a reason."""
    try:
        state = test.at(**given)
    except REFUSALS as refusal:
        assert len(str(refusal)) > 10  # noqa: PT017
        return None
    assert_disc(test, state)
    return state


PLACES = 2000 if support.ASKED else 400


def assert_disc(test: Indentation, state: IndentState) -> None:
    """Look at pressure and gap on many places each, which the certificate does not use."""
    a, outer = state.radius, state.outer_radius
    adhesion: Any = test.adhesion
    tip: Any = test.tip
    kind = None if adhesion is None else adhesion.kind
    inside = a * np.sin(np.linspace(0.0, 0.5 * np.pi, PLACES + 2)[1:-1])
    pressure = state.pressure(inside)
    assert np.isfinite(pressure).all()
    mean = abs(state.load) / (np.pi * a * a)
    if kind in (None, "dmt"):
        if kind == "dmt":
            mean += 2 * adhesion.work * tip.end_radius / a**2
        # The certificate takes 1e-6 of the mean pressure for rounding.
        assert pressure.min() > -2e-6 * mean
    if kind == "maugis":
        assert pressure.min() > -adhesion.strength - 2e-6 * max(mean, adhesion.strength)
    if test.tip.kind == "flat_punch":
        return
    outside = a + a * np.geomspace(1e-4, 20.0, PLACES)
    profile = test.tip.gap(outside)
    outside = outside[
        np.isfinite(profile) & (outside < (60.0 if test.tip.kind == "profile" else np.inf))
    ]
    gap = state.gap(outside)
    opening = adhesion.work / adhesion.strength if kind == "maugis" else 0.0
    # The certificate takes 1e-9 of this for rounding, and the surface has errors of 1e-9.
    size = 1e-8 * (abs(state.approach) + test.tip.gap(outer) + opening)
    assert gap.min() > -size
    if kind == "maugis":
        assert gap[outside < outer].max(initial=0.0) < opening + size
        assert gap[outside > outer].min(initial=np.inf) > opening - size


@fuzz
@given(bodies, st.one_of(ended, others), st.none() | works.map(Adhesion.dmt), radii)
def test_states_without_singular_edges_are_discs(
    body: nacre.HalfSpace, tip: Tip, adhesion: Adhesion | None, radius: float
) -> None:
    if adhesion is not None and tip.end_radius is None:
        adhesion = None
    test = Indentation(body, tip, adhesion=adhesion)
    state = at(test, radius=radius)
    if state is None:
        return
    # The solution is unique: what was found by radius is found by load and by approach.
    for given_ in ({"load": state.load}, {"approach": state.approach}):
        again = at(test, **given_)
        assert again is not None
        # Where the load hardly changes with the radius, its rounding is magnified.
        assert abs(again.radius / radius - 1) < 1e-6


@fuzz
@given(bodies, punches, st.none() | works.map(Adhesion.jkr), powers(-4.0, -1.0))
def test_punches_bear_no_tension_without_adhesion(
    body: nacre.HalfSpace, tip: Tip, adhesion: Adhesion | None, approach: float
) -> None:
    at(Indentation(body, tip, adhesion=adhesion), approach=approach)


@fuzz
@given(bodies, st.one_of(ended, others), adhesions, radii)
def test_adhering_states_are_discs(
    body: nacre.HalfSpace, tip: Tip, adhesion: Adhesion, radius: float
) -> None:
    test = Indentation(body, tip, adhesion=adhesion)
    state = at(test, radius=radius)
    if state is None or adhesion.kind == "maugis":
        return
    for control in ("load", "approach"):
        try:
            last = test.pull_off(control)
        except REFUSALS as refusal:
            assert len(str(refusal)) > 10  # noqa: PT017
            continue
        assert_disc(test, test.at(radius=last.radius))
        stable = at(test, radius=1.1 * last.radius)
        if stable is not None:
            assert getattr(stable, control) >= getattr(last, control)


@fuzz
@given(bodies, st.one_of(ended, others), radii)
def test_curves_have_discs_alone(body: nacre.HalfSpace, tip: Tip, radius: float) -> None:
    test = Indentation(body, tip)
    state = at(test, radius=radius)
    if state is None:
        return
    depths = state.approach * np.linspace(0.05, 1.0, 6)
    try:
        curve = test.curve(approach=depths)
    except REFUSALS as refusal:
        assert len(str(refusal)) > 10  # noqa: PT017
        return
    for depth, load in zip(depths, curve.load, strict=True):
        single = at(test, approach=depth)
        assert single is not None
        assert abs(single.load / load - 1) < 1e-7
