"""States that version 0.1.0 wrote, before its release: `tests/data/states_0_1_0.json`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nacre.results.values import decode

DATA = Path(__file__).parents[2] / "data" / "states_0_1_0.json"
STATES = json.loads(DATA.read_text(encoding="utf-8"))["states"]

NUMBERS: dict[str, tuple[Callable[[Any], object], object]] = {
    "creep_coefficients": (lambda one: one.c11, STATES["creep_coefficients"]["c11"]),
    # Its revolutions are those of L_10r, in millions.
    "life": (lambda one: one.l10, STATES["life"]["revolutions"]),
    "one": (lambda one: one.radius, STATES["one"]["radius"]),
    "maugis": (lambda one: one.outer_radius, STATES["maugis"]["outer_radius"]),
    "volume": (lambda one: one.integral, STATES["volume"]["integral"]),
    "shakedown_map": (lambda one: one.limits, STATES["shakedown_map"]["limits"]),
    "fatigue": (lambda one: one.layers[0].depths, STATES["fatigue"]["layers"][0]["depths"]),
    "summary": (
        lambda one: one.to_dict()["layers"][0]["von_mises"]["value"],
        STATES["summary"]["layers"][0]["von_mises"]["value"],
    ),
    "balls": (lambda one: one.loads, STATES["balls"]["loads"]),
    "line": (lambda one: one.pressure, STATES["line"]["pressure"]),
}


@pytest.mark.parametrize("name", STATES)
def test_states_of_0_1_0_are_read_with_their_numbers(name: str) -> None:
    result = decode(STATES[name])
    number, stored = NUMBERS[name]
    np.testing.assert_array_equal(number(result), stored)
    assert type(result).from_dict(result.to_dict()) == result
    assert str(result)
