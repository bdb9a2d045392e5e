"""A verdict on a bearing says how long it lives, whether that is enough, and what is in doubt."""

from __future__ import annotations

import ast
import dataclasses
import functools
import html
import itertools
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import STEEL, quiet
from nacre._tools.units import plain
from nacre.bearing import (
    AngularContactBall,
    BearingLife,
    BearingSolution,
    CylindricalRoller,
    DeepGrooveBall,
    Pair,
    PairSolution,
)
from nacre.case import Case
from nacre.results.verdict import KINDS, TEXTS, Doubt
from support import Capture, assert_close, command

ROLLERS: dict[str, Any] = {"count": 14, "diameter": 10e-3, "length": 9.6e-3}
ROLLERS |= {"pitch_diameter": 65e-3, "clearance": 41e-6}
BALLS: dict[str, Any] = {"count": 7, "diameter": 11.5e-3, "pitch_diameter": 43.5e-3}
ANGULAR: dict[str, Any] = {"count": 12, "diameter": 11.1e-3, "pitch_diameter": 46e-3}
TURNING = 2 * math.pi * 25
"""Speed of 1500 revolutions a minute [rad/s]."""
LEVELS: list[tuple[float, float | None, str]] = [
    # What is reached over what is required, the share of its error, and the level.
    (0.1, 0.0, "bad"),
    (0.9, 0.0, "bad"),
    (0.999, 0.0, "bad"),
    (1.001, 0.0, "fair"),
    (1.1, 0.0, "fair"),
    (1.49, 0.0, "fair"),
    (1.51, 0.0, "good"),
    (12.0, 0.0, "good"),
    (0.97, 0.01, "bad"),
    (0.98, 0.03, "fair"),  # the error decides
    (1.02, 0.01, "fair"),
    (1.02, 0.03, "fair"),
    (1.51, 0.001, "good"),
    (1.51, 0.01, "fair"),  # 1.51 less 1 % is less than 1.5
    (1.6, 0.05, "good"),
    (1.6, 0.3, "fair"),
    (0.5, 0.3, "bad"),
    (2.0, None, "unknown"),
]


@functools.cache
def borne(kind: str, speed: float = 0.0) -> BearingSolution:
    bearing = CylindricalRoller(**ROLLERS) if kind == "rollers" else DeepGrooveBall(**BALLS)
    return bearing.solve(force=(1000.0, 0.0, None), speed=speed, model="iso16281")


@functools.cache
def paired(**keywords: Any) -> PairSolution:
    ball = AngularContactBall(**ANGULAR, contact_angle=math.radians(25))
    pair = Pair(ball, ball, arrangement="O", distance=30e-3, preload_force=200.0)
    load: dict[str, Any] = {"force": (4000.0, 0.0, 1500.0), "moment": (0.0, 3.0)}
    return pair.solve(**load, speed=300.0, model="iso16281", **keywords)


def pressed(
    kind: str, peak: float, edge: float = 0.0, errors: dict[str, float | None] | None = None
) -> BearingSolution:
    """Return a turning bearing with other pressures, of which the edge is a share of the peak."""
    solution = borne(kind, TURNING)
    edges = np.full_like(solution.edge_pressures, edge * peak if kind == "rollers" else np.nan)
    return dataclasses.replace(
        solution,
        peak_pressures=np.full_like(solution.peak_pressures, peak),
        edge_pressures=edges,
        report=dataclasses.replace(solution.report, discretisation=errors),
    )


@pytest.mark.parametrize(("reached", "error", "level"), LEVELS)
@pytest.mark.parametrize("kind", ["balls", "rollers", "pair"])
def test_a_required_life_decides(
    kind: str, reached: float, error: float | None, level: str
) -> None:
    solution: Any = paired() if kind == "pair" else borne(kind, TURNING)
    life = dataclasses.replace(solution.life(), uncertainty=error)
    required = life.hours / reached
    verdict = life.verdict(required)
    assert verdict.level == level
    assert verdict.factor == pytest.approx(reached, rel=1e-12)
    assert verdict.uncertainty == (error if error is None else pytest.approx(error, abs=1e-12))
    assert str(verdict.decided_by).startswith("life")
    assert f", {plain(required, 3)} h required: " in str(verdict)
    if error == 0:
        assert ("too short" in verdict.words) == (level == "bad")
        own = solution.life(required_life=required)
        assert own.verdict() == verdict
        assert type(own).from_dict(own.to_dict()) == own
        whole = solution.verdict(required_life=required)
        assert (whole.level, whole.words) == (level, verdict.words)
        assert str(own).startswith(verdict.words)
    else:
        whole = dataclasses.replace(solution, _life=life).verdict(required_life=required)
        assert (whole.level, whole.words) == (level, verdict.words)


@pytest.mark.parametrize(("reached", "error", "level"), LEVELS)
@pytest.mark.parametrize("kind", ["balls", "rollers"])
def test_a_static_safety_decides(
    kind: str, reached: float, error: float | None, level: str
) -> None:
    solution = pressed(kind, 1e9, 0.5)
    report = dataclasses.replace(solution.report, load_error=error)
    model: Any = "iso16281" if error == 0 else "solved"
    solution = dataclasses.replace(solution, report=report, model=model)
    if error != 0:
        errors: dict[str, float | None] = {"peak_pressure": 0.0, "edge_pressure": 0.0}
        report = dataclasses.replace(report, discretisation=errors)
        solution = dataclasses.replace(solution, report=report)
    required = solution.static_load().safety / reached
    verdict = solution.verdict(static_safety=required)
    assert verdict.level == level
    if level != "good":
        assert verdict.decided_by == "static safety"
    assert f"{plain(required, 3)} required (given)" in str(verdict)
    assert ("too low" in verdict.words) == (level == "bad")
    # Without one it is 1.5 of rollers and 1 of balls.
    usual = 1.5 if kind == "rollers" else 1.0
    heavier = solution.static_load().safety / (reached * usual)
    other = dataclasses.replace(solution, loads=heavier * solution.loads)
    assert other.static_load().safety == pytest.approx(reached * usual)
    assert other.verdict().level == ("bad" if level == "bad" else "unknown")
    light: Any = dataclasses.replace(borne(kind, TURNING).life(), caution=None)
    asked = dataclasses.replace(other, _life=light).verdict(required_life=light.hours / 20)
    assert asked.level == level
    safety = plain(other.static_load().safety, 3)
    assert f"Static safety {safety}, {usual:g} required (ISO 76)" in str(asked)


@pytest.mark.parametrize(
    ("kind", "peak", "edge", "error", "level"),
    [
        # Rollers: (4000/p)² is 1.5 at 3266 MPa. Balls: (4200/p)³ is 1.5 at 3669 MPa.
        ("rollers", 1739e6, 0.83, 0.0, "good"),
        ("rollers", 3250e6, 0.83, 0.0, "good"),
        ("rollers", 3250e6, 0.83, 0.01, "fair"),
        ("rollers", 3280e6, 0.83, 0.0, "fair"),
        ("rollers", 3990e6, 0.83, 0.0, "fair"),
        ("rollers", 4010e6, 0.83, 0.0, "bad"),
        ("rollers", 3990e6, 0.83, 0.01, "fair"),
        ("rollers", 4010e6, 0.83, 0.01, "fair"),  # the error decides
        ("rollers", 1739e6, 0.99, 0.0, "good"),
        ("rollers", 1739e6, 1.0, 0.0, "fair"),  # edge stress
        ("rollers", 1739e6, 0.83, None, "unknown"),
        ("balls", 3650e6, 0.0, 0.0, "good"),
        ("balls", 3690e6, 0.0, 0.0, "fair"),
        ("balls", 4190e6, 0.0, 0.0, "fair"),
        ("balls", 4210e6, 0.0, 0.0, "bad"),
    ],
)
def test_pressures_decide(
    kind: str, peak: float, edge: float, error: float | None, level: str
) -> None:
    errors = {name: error and error * peak for name in ("peak_pressure", "edge_pressure")}
    solution = pressed(kind, peak, edge, errors)
    assert solution.verdict().level == ("bad" if level == "bad" else "unknown")  # nobody asked
    verdict = solution.verdict(required_life=1.0)
    limit, power = (4.0e9, 2) if kind == "rollers" else (4.2e9, 3)
    assert verdict.level == level
    if peak > 3e9:
        assert verdict.decided_by == "peak pressure"
        assert verdict.factor == pytest.approx((limit / peak) ** power, rel=1e-12)
    first = {"bad": "Peak pressure", "unknown": "Cannot tell"}.get(level, "Lives ")
    assert verdict.words.startswith(first)
    assert f"limit {plain(limit / 1e9, 3)} GPa (ISO 76)" in str(verdict)
    assert ("no edge stress" in str(verdict)) == (kind == "rollers" and edge < 1)
    assert ("the largest pressure is at an edge" in str(verdict)) == (edge >= 1)


def test_an_edge_within_its_error_of_the_peak_is_edge_stress() -> None:
    errors: dict[str, float | None] = {"peak_pressure": 1e6, "edge_pressure": 20e6}
    for edge, level in ((0.98, "good"), (0.99, "fair")):
        solution = pressed("rollers", 1.7e9, edge, errors)
        assert solution.verdict(required_life=1.0).level == level


ROWS = KINDS | TEXTS


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("kind", ["balls", "rollers", "pair"])
def test_every_warning_leaves_its_level(kind: str, row: str) -> None:
    level, reason, leaves_model = ROWS[row]
    solution: Any = paired() if kind == "pair" else borne(kind, TURNING)
    notes: dict[str, Any] = {"warnings": (f"2 of 9 contacts: {row} here",)}
    notes["contact_kinds"] = (row,) if row in KINDS else None  # files of the first release
    singles = [*solution.bearings] if kind == "pair" else [solution]
    report = dataclasses.replace(singles[-1].report, **notes)
    warned = dataclasses.replace(singles[-1], report=report)
    solution = dataclasses.replace(solution, second=warned) if kind == "pair" else warned
    hours = solution.life().hours
    verdict = solution.verdict(required_life=hours / 2)
    assert verdict.level == ("good" if level == "any" else level)
    assert verdict.inside_model == (level == "any" or not leaves_model)
    assert (reason in str(verdict)) == (level != "any")
    assert verdict.doubts == (None if level == "any" else (reason,))
    assert solution.life().verdict(hours / 2).level == verdict.level
    is_steel = row != "rings are not of steel"
    # What fails is bad whatever is in doubt; but other rings have no life.
    failing = [solution.verdict(required_life=2 * hours), solution.life().verdict(2 * hours)]
    assert {verdict.level for verdict in failing} == {"bad" if is_steel else "unknown"}
    assert solution.verdict().level == "unknown"


def texts_of(module: str) -> list[str]:
    """Return the warnings in the source of a module, without their numbers."""
    source = Path(nacre.__file__).parent / "bearing" / f"{module}.py"

    def text_of(node: ast.AST) -> str:
        return " ".join(
            part.value
            for part in ast.walk(node)
            if isinstance(part, ast.Constant) and isinstance(part.value, str)
        )

    tree = ast.parse(source.read_text(encoding="utf-8"))
    texts = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "warn":
            texts.append(text_of(node.args[0]))
        if isinstance(node, ast.Yield) and node.value is not None:
            texts.append(text_of(node.value))
        for block in (getattr(node, "body", []), getattr(node, "orelse", [])):
            pairs = itertools.pairwise(block) if isinstance(block, list) else ()
            for before, after in pairs:  # a text that has a name
                if isinstance(before, ast.Assign) and "warn(text" in ast.unparse(after):
                    texts.append(text_of(before.value))
    return [text for text in texts if text]


@pytest.mark.parametrize("module", ["solving", "film", "catalogue", "modified", "life"])
def test_every_warning_of_bearings_stands_in_the_table(module: str) -> None:
    texts = [text for text in texts_of(module) if " contacts: " not in text]
    assert texts
    for text in texts:
        assert any(words in text for words in TEXTS), text


def test_lives_and_limits_of_steel_are_not_those_of_other_rings() -> None:
    polymer = nacre.Elastic(2.8e9, 0.35)
    bearing = DeepGrooveBall(**BALLS, inner=polymer, outer=polymer)
    solution = quiet(bearing.solve, force=(200.0, 0.0, None), speed=TURNING, model="iso16281")
    for verdict in (solution.verdict(), solution.verdict(1e3, 2.0), solution.life().verdict()):
        assert verdict.level == "unknown"
        assert not verdict.inside_model
        assert "bearing steel" in verdict.words
        assert "ISO 76" not in str(verdict)


def test_loads_and_tilts_beyond_the_usual_are_told() -> None:
    bearing = DeepGrooveBall(**BALLS)
    heavy = bearing.solve(force=(14e3, 0.0, None), speed=TURNING, model="iso16281")
    assert heavy.life().equivalent_load > 0.5 * heavy.life().capacity
    heavy_life: Any = heavy.life()
    verdict = heavy.verdict(required_life=heavy_life.hours / 20)
    assert "above half of the rating" in str(verdict)
    assert not verdict.inside_model
    rollers = CylindricalRoller(**ROLLERS)
    for minutes, is_told in ((3.9, False), (4.1, True)):
        tilt = math.tan(math.radians(minutes / 60))
        solution = rollers.solve(force=(4450.0, 0.0, None), tilt=(None, tilt), model="iso16281")
        assert ("the tilt is above the 4'" in str(solution.verdict())) == is_told


def test_sharp_ends_are_never_good() -> None:
    sharp = CylindricalRoller(**ROLLERS, profile=None)
    solution = quiet(sharp.solve, force=(4450.0, 0.0, None), speed=100.0, cells=(40, 16))
    verdict = solution.verdict(required_life=1.0)
    assert verdict.level == "unknown"
    assert "the pressure at an edge has no limit" in verdict.words
    # With factors from that pressure the error of the life is not known.
    assert solution.life("pressure").uncertainty is None
    assert "as it stands" in str(solution.life("pressure").verdict(1.0))


def test_an_unfinished_bearing_is_not_judged() -> None:
    solution = borne("balls", TURNING)
    report = dataclasses.replace(solution.report, termination="iteration limit")
    unfinished = dataclasses.replace(solution, report=report)
    for verdict in (unfinished.verdict(required_life=1.0), unfinished.life().verdict(1.0)):
        assert verdict.level == "unknown"
        assert verdict.words == "Cannot tell: the solution has not converged."
        assert verdict.lines[0].startswith("Lives ")


def test_without_a_load_nothing_is_judged() -> None:
    solution = DeepGrooveBall(**BALLS, clearance=10e-6).solve(model="iso16281")
    for verdict in (solution.verdict(), solution.life().verdict()):
        assert verdict.level == "unknown"
        assert verdict.sentences[:2] == (
            "Cannot tell: nothing is loaded.",
            "Lives without end: no element is loaded.",
        )


def test_a_limit_must_be_above_0_and_a_life_needs_a_speed() -> None:
    still, turning = borne("balls"), borne("balls", TURNING)
    for call in (still.life, still.verdict, still.life().verdict):
        with pytest.raises(ValueError, match="required_life must be given with a speed"):
            call(required_life=10.0)
    with pytest.raises(ValueError, match="required_life must be given with a speed"):
        still.bearing.solve(force=(1e3, 0.0, None), required_life=10.0)  # type: ignore[attr-defined]
    for name in ("required_life", "static_safety"):
        for wrong in (0.0, -1.0, math.nan, math.inf):
            with pytest.raises(ValueError, match=f"{name} must be"):
                turning.verdict(**{name: wrong})
            with pytest.raises(ValueError, match=f"{name} must be"):
                turning.bearing.solve(  # type: ignore[attr-defined]
                    force=(1e3, 0.0, None), speed=1.0, model="iso16281", **{name: wrong}
                )


def test_a_life_says_what_it_is_made_of() -> None:
    still, turning = borne("balls"), borne("balls", TURNING)
    millions = still.life().revolutions / 1e6
    basis = "90 %, ISO/TS 16281, without lubrication"
    assert (
        still.verdict().words == f"Lives {plain(millions, 3)} million revolutions (L10r; {basis})."
    )
    millions = turning.life().revolutions / 1e6
    hours = plain(1e6 * millions / 1500 / 60, 3)
    assert turning.verdict().words == (
        f"Lives {hours} h (L10r {plain(millions, 3)} million revolutions at 1500/min; {basis})."
    )
    assert turning.verdict().lines[-1] == "Give a required life to judge it."
    assert turning.life().verdict().lines == ("Give a required life to judge it.",)
    assert turning.verdict().question is None
    question = turning.verdict(20e3, 2.0).question
    assert question == "Does it reach a life of 20 000 h and a static safety of 2?"
    oiled = dataclasses.replace(
        still.life(), revolutions=1.28e9, reliability=0.95, modification_factor=2.0
    )
    assert (
        oiled.verdict().words == "Lives 1280 million revolutions (L5m; 95 %, ISO 281, with a_ISO)."
    )


@pytest.mark.parametrize(
    ("hours", "required", "text"),
    [
        (14203.0, 20e3, "Lives 14 200 h ± 4 % ("),
        (999e3, 20e3, "Lives 999 000 h ± 4 % ("),
        (1.01e6, 20e3, "Lives > 1 million hours ("),
        (7e12, None, "Lives > 1 million hours ("),
        (3e6, 2e6, "Lives 3 000 000 h ± 4 % ("),  # which is judged against millions
        (0.5, 20e3, "Lives 30 min ± 4 % ("),
        (0.01, 20e3, "Lives 36 s ± 4 % ("),
        (3.46e-9, 20e3, "Lives < 1 s ± 4 % ("),
    ],
)
def test_hours_are_readable(hours: float, required: float | None, text: str) -> None:
    life = dataclasses.replace(
        borne("balls", TURNING).life(),
        revolutions=hours * 90e3,
        hours=hours,
        uncertainty=0.04,
        required_life=required,
    )
    verdict = life.verdict()
    assert verdict.words.startswith(text)
    assert verdict.factor == (None if required is None else hours / required)


def test_a_coated_bearing_says_what_its_life_is_of() -> None:
    coated = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(300e9, 0.25), 2e-6)])
    bearing = DeepGrooveBall(**BALLS, inner=coated)
    for model in ("iso16281", "solved"):
        keywords: dict[str, Any] = {"model": model, "cells": (32, 32)}
        solution = quiet(bearing.solve, force=(100.0, 0.0, None), speed=TURNING, **keywords)
        verdict = solution.verdict(required_life=1.0)
        assert verdict.level == "fair"
        assert "With care: layers are not counted in the life, which is that of bare rings" in (
            str(verdict)
        )


def test_a_pair_has_the_life_of_both_and_then_the_weaker_bearing() -> None:
    solution = paired()
    life = solution.life()
    shorter = min(("first", "second"), key=lambda name: getattr(life, name))
    longer = "second" if shorter == "first" else "first"
    hours = {name: getattr(life, name) / 300 * 2 * math.pi / 3600 for name in ("first", "second")}
    words = solution.verdict().words
    assert words == life.verdict().words
    assert words.startswith(f"Lives {plain(life.hours or 0.0, 3)} h (")
    alone = [f"{name} bearing {plain(hours[name], 3)} h" for name in (shorter, longer)]
    assert words.endswith(f"; {alone[0]}, {alone[1]}.")
    assert life.hours < min(hours.values())
    # Static safety: that of the heavier element decides.
    safeties = {
        name: one.static_load().safety
        for name, one in zip(("first", "second"), solution.bearings, strict=True)
    }
    weaker = min(safeties, key=lambda name: safeties[name])
    verdict = solution.verdict(static_safety=1.01 * safeties[weaker])
    assert verdict.level == "bad"
    assert verdict.words.startswith(f"Static safety of the {weaker} bearing ")
    assert verdict.decided_by == f"static safety of the {weaker} bearing"
    assert solution.verdict(static_safety=0.5 * safeties[weaker]).level == "good"


def test_a_bearing_of_a_pair_that_carries_nothing_lives_without_end() -> None:
    ball = AngularContactBall(**ANGULAR, contact_angle=0.4)
    pair = Pair(ball, ball, arrangement="O", distance=16e-3, preload_force=200.0)
    solution = pair.solve(force=(0.0, 0.0, 2000.0), speed=0.0, model="iso16281")
    assert solution.life().second == math.inf
    assert solution.verdict().words.endswith("second bearing without end.")
    assert not str(solution.verdict()).startswith("Cannot tell")


# What is required, and what was asked, is kept.


def test_what_is_required_is_kept(tmp_path: Path) -> None:
    bearing = DeepGrooveBall(**BALLS)
    load: dict[str, Any] = {"force": (1000.0, 0.0, None), "speed": 100.0, "model": "iso16281"}
    asked = bearing.solve(**load, required_life=150e3, static_safety=30.0)
    plain_solution = bearing.solve(**load)
    assert asked.verdict() == plain_solution.verdict(required_life=150e3, static_safety=30.0)
    assert asked.life() == plain_solution.life(required_life=150e3)
    assert asked.verdict(required_life=300e3).words == (
        plain_solution.verdict(required_life=300e3, static_safety=30.0).words
    )
    back = nacre.load(asked.save(tmp_path / "asked.nc"))
    assert back == asked
    assert back.verdict() == asked.verdict()
    pair = paired(required_life=1e5, static_safety=3.0)
    assert pair.required_life == 1e5
    assert pair.verdict() == paired().verdict(required_life=1e5, static_safety=3.0)
    back = nacre.load(pair.save(tmp_path / "pair.nc"))
    assert back.verdict() == pair.verdict()


def test_states_without_requirements_are_read() -> None:
    state = borne("balls", TURNING).to_dict()
    for name in ("required_life", "static_safety", "life", "film"):
        del state[name]
    for name in ("load_error", "contact_kinds"):
        del state["report"][name]
    back = BearingSolution.from_dict(state)
    assert back.required_life is None
    assert back.verdict(required_life=1.0).level == "good"
    life = borne("balls", TURNING).life().to_dict()
    for name in ("uncertainty", "doubt", "caution"):
        del life[name]
    assert BearingLife.from_dict(life).verdict(1.0).level == "unknown"  # the error is not known
    with pytest.raises(ValueError, match="life"):
        BearingSolution.from_dict(borne("balls", TURNING).to_dict() | {"life": 5})


BALL_CASE = """
[bearing]
kind = "deep_groove_ball"
count = 7
diameter = 11.5e-3
pitch_diameter = 43.5e-3

[bearing.solve]
force = { x = 1000, y = 0 }
speed = 100
"""
PAIR_CASE = """
[bearing]
kind = "pair"
arrangement = "O"
distance = 30e-3
preload_force = 200

[bearing.first]
kind = "angular_contact_ball"
count = 12
diameter = 11.1e-3
pitch_diameter = 46e-3
contact_angle = 0.4363

[bearing.solve]
force = { x = 4000, y = 0, z = 1500 }
moment = { x = 0, y = 3 }
speed = 300
"""
FAST = 'model = "iso16281"\n'
OIL = 'viscosity_ratio = 0.5\ncontamination = "severe contamination"\n'
FILM = "[bearing.film]\nspeed = 2\nviscosity = 0.02\npressure_viscosity = 20e-9\nroughness = 2e-6\n"
SPECTRUM = (
    "spectrum = [{ share = 0.5, force = { x = 3000, y = 0 }, speed = 200 }, "
    "{ share = 0.5, force = { x = 500, y = 0 }, speed = 100 }]\n"
)
CASES = {
    "ball": f"{BALL_CASE}{FAST}[bearing.life]\n",
    "required": f"{BALL_CASE}{FAST}[bearing.life]\nrequired_life = 250e3\n",
    "reliability": f"{BALL_CASE}{FAST}[bearing.life]\nreliability = 0.99\n",
    "a_ISO": f"{BALL_CASE}{FAST}[bearing.life]\n{OIL}required_life = 5000\n",
    "spectrum": f"{BALL_CASE}{FAST}[bearing.life]\n{SPECTRUM}required_life = 20000\n",
    "film": f"{BALL_CASE}cells = [48, 48]\n[bearing.life]\nrequired_life = 5\n{FILM}",
    "film alone": f"{BALL_CASE}cells = [48, 48]\n{FILM}",
    "static": f"{BALL_CASE}{FAST}static_safety = 20\n[bearing.life]\nrequired_life = 5\n",
    "pair": f"{PAIR_CASE}{FAST}[bearing.life]\n",
    "pair, a_ISO": f"{PAIR_CASE}{FAST}[bearing.life]\n{OIL}reliability = 0.95\n",
    "pair, required": f"{PAIR_CASE}{FAST}static_safety = 3\n[bearing.life]\nrequired_life = 4e3\n",
}


@pytest.mark.parametrize("name", CASES)
def test_all_that_is_shown_begins_with_one_sentence(
    name: str, tmp_path: Path, capsys: Capture
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(CASES[name], encoding="utf-8")
    files = [tmp_path / f"case.{ending}" for ending in ("nc", "csv", "html")]
    saves = [word for file in files for word in ("--save", file)]
    assert command("solve", path, *saves) == 0
    printed = capsys.readouterr().out
    first = printed.partition("\n")[0]
    case = Case.read(path)
    arguments = case.arguments()
    bearing: Any = arguments.pop("bearing")
    solution = quiet(bearing.solve, **arguments)
    if (keywords := case.life()) is not None:
        life = solution.life(**keywords)
        if "static" in name:
            assert first == "Static safety 13.3, 20 required (given): too low."
        else:
            assert first == life.verdict().words
            assert plain(life.hours, 3) in first
    assert command("solve", path, "--json") == 0
    answer = json.loads(capsys.readouterr().out)["verdict"]["bearing"]
    assert answer["words"] == first
    assert {"level", "question", "decided_by", "doubts", "inside_model", "factor"} <= answer.keys()
    assert f"# verdict: {first}" in files[1].read_text(encoding="utf-8")
    page = html.unescape(files[2].read_text(encoding="utf-8"))
    assert f"<b>{answer['level']}: {first}</b>" in page
    back = nacre.load(files[0])
    assert str(back).startswith(f"{first}\n")
    assert back.verdict().words == first
    assert back.verdict().level == answer["level"]
    assert type(back).from_dict(back.to_dict()) == back
    again = back.save(tmp_path / "again.csv").read_text(encoding="utf-8")
    assert f"# verdict: {first}" in again
    if "film" in name:
        assert "λ = " in str(back.verdict())
        assert "oil film too thin" in str(back.verdict())
        assert answer["level"] == ("fair" if name == "film" else "unknown")


def test_the_command_judges_bearings_in_the_units_of_the_case(
    tmp_path: Path, capsys: Capture
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(
        'units = "N-mm-MPa"\n[bearing]\nkind = "deep_groove_ball"\ncount = 7\ndiameter = 11.5\n'
        "pitch_diameter = 43.5\n[bearing.life]\n[bearing.solve]\nmodel = 'iso16281'\n"
        "force = { x = 1000.0, y = 0.0 }\n",
        encoding="utf-8",
    )
    assert command("solve", path) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("Lives ")
    assert "MPa, limit 4200 MPa (ISO 76) at " in printed
    assert command("solve", path, "--json") == 0
    verdicts = json.loads(capsys.readouterr().out)["verdict"]
    assert set(verdicts) == {"bearing", "life"}
    assert any("4200 MPa (ISO 76)" in line for line in verdicts["bearing"]["lines"])


# Errors of lives.


def test_lives_fall_by_the_power_of_loads_that_their_errors_have() -> None:
    # L ∝ Q^-3 of balls; laminae have 4, which is not the 10/3 of the equivalent load.
    for kind, power in (("balls", 3.0), ("rollers", 4.0)):
        solution = borne(kind)
        laminae = solution.lamina_loads
        heavier = dataclasses.replace(
            solution,
            loads=1.1 * solution.loads,
            lamina_loads=None if laminae is None else 1.1 * laminae,
        )
        ratio = solution.life().l10r / heavier.life().l10r
        assert ratio == pytest.approx(1.1**power, rel=1e-12)
        doubtful = dataclasses.replace(
            solution,
            model="solved",
            report=dataclasses.replace(solution.report, load_error=0.01),
        )
        assert doubtful.life().uncertainty == pytest.approx(0.01 * power, rel=1e-9)
        assert solution.life().uncertainty == 0


def test_the_life_of_balls_errs_by_no_more_than_it_says() -> None:
    # Hertz's ellipses are a closed form of these contacts.
    bearing = DeepGrooveBall(**BALLS, clearance=20e-6)
    load: dict[str, Any] = {"force": (1000.0, 0.0, None)}
    exact = bearing.solve(**load, model="iso16281").life().l10r
    errors = []
    for cells in (16, 32):
        life = quiet(bearing.solve, **load, cells=(cells, cells)).life()
        assert life.uncertainty is not None
        assert abs(life.l10r / exact - 1) < life.uncertainty < 0.2
        errors.append(life.uncertainty)
    assert errors[1] < errors[0]


@pytest.mark.slow
@pytest.mark.parametrize("edge", ["standard", None, "pressure"])
@pytest.mark.parametrize("slope", [0.0, 1e-3])
def test_the_life_of_rollers_errs_by_no_more_than_it_says(edge: Any, slope: float) -> None:
    bearing = CylindricalRoller(**ROLLERS)
    load: dict[str, Any] = {"force": (4450.0, 0.0, None), "tilt": (None, slope)}
    coarse = quiet(bearing.solve, **load, cells=(80, 32)).life(edge)
    fine = quiet(bearing.solve, **load, cells=(160, 64)).life(edge)
    assert coarse.uncertainty is not None
    assert fine.uncertainty is not None
    assert abs(coarse.l10r / fine.l10r - 1) < coarse.uncertainty < 0.2
    assert fine.uncertainty < coarse.uncertainty


def test_the_error_of_a_modified_life_has_that_of_its_factor() -> None:
    solution = dataclasses.replace(
        borne("rollers", TURNING),
        model="solved",
        report=dataclasses.replace(borne("rollers", TURNING).report, load_error=0.01),
    )
    oil: dict[str, Any] = {
        "viscosity_ratio": 1.0,
        "contamination": 0.5,
        "fatigue_load_limit": 500.0,
    }
    life = solution.life(**oil)
    # A load that is 1 % larger on every lamina, in the life that is left.
    assert solution.lamina_loads is not None
    left = (1 - 0.04) ** -0.25
    heavier = dataclasses.replace(solution, lamina_loads=left * solution.lamina_loads).life(**oil)
    assert life.uncertainty == pytest.approx(1 - heavier.revolutions / life.revolutions, rel=1e-9)
    assert life.uncertainty is not None
    assert life.uncertainty > 0.04


def test_the_error_of_a_pair_is_the_mean_by_shares_of_failures() -> None:
    solution = paired()
    reports = [
        dataclasses.replace(one.report, load_error=e)
        for one, e in zip(solution.bearings, (0.01, 0.03), strict=True)
    ]
    first, second = (
        dataclasses.replace(one, model="solved", report=report)
        for one, report in zip(solution.bearings, reports, strict=True)
    )
    life = dataclasses.replace(solution, first=first, second=second).life()
    shares = np.array([life.first, life.second]) ** (-10 / 9)
    assert_close(shares.sum() ** -0.9, life.revolutions, rtol=1e-9)
    assert life.uncertainty is not None
    assert_close(life.uncertainty, 3 * (0.01 * shares[0] + 0.03 * shares[1]) / shares.sum(), 1e-9)


def test_a_row_has_a_level_and_a_reason() -> None:
    for doubt in ROWS.values():
        assert isinstance(doubt, Doubt)
        assert doubt.level in ("unknown", "fair", "any")
        assert doubt.reason
        assert "; " not in doubt.reason
