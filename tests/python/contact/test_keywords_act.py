"""Every keyword of solve, slide, roll and wear, and each key of a group, acts or is refused."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import STEEL, quiet
from nacre.contact.arguments import MOTION, STEP

BALL = nacre.Sphere(5e-3)
GRID = nacre.Grid((16, 16), (2.4e-4, 2.4e-4))
STIFF = nacre.Elastic(420e9, 0.2)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(STIFF, 1e-6, name="hard")])
QUIETLY = {"threads", "progress", "check"}
"""Keywords that change how a result comes about, and none of its numbers."""

PRESSED: dict[str, Any] = {
    "counterbody": nacre.Elastic(70e9, 0.3),
    "grid": nacre.Grid((18, 16), (2.4e-4, 2.4e-4)),
    "max_cells": 900,
    "load": 12.0,
    "approach": 1e-6,
    "eccentricity": (1e-5, None),
    "moment": (1e-4, None),
    "tilt": (1e-3, None),
    "tolerance": 1e-3,
}
"""Another value of each keyword."""
SOLVE = PRESSED | {
    "hardness": 8e8,
    "compliance": 1e-16,
    "max_iterations": 1,
    "algorithm": "polak-rose",
    "initial": np.full(GRID.shape, 1.0),
}
FRICTION = PRESSED | {
    "friction": 0.2,
    "force": (0.5, None),
    "max_convolutions": 1,
    "coupling": False,
    "initial": None,  # a solution, below
}
SLIDE = FRICTION | {"shift": (2e-7, None), "twist": 1e-4, "torque": 1e-5}
SLIDE |= {"steps": [{"force": (0.5, None)}]}
ROLL = FRICTION | {"creepage": (2e-3, 0.0), "spin": 2.0, "direction": "+y", "cells": 2, "order": 1}
WEAR = PRESSED | {
    "rate": {"hard": 3e-16, "substrate": 1e-16},
    "counter_rate": 1e-16,
    "sliding": 2.0,
    "cycles": 2.0,
    "slide": {"friction": 0.3, "steps": [{"shift": (1e-7, None)}, {"shift": (-1e-7, None)}]},
    "passes": 2.0,
    "roll": {"friction": 0.3, "creepage": (1e-3, 0.0), "direction": "+x"},
    "slip": np.full(GRID.shape, 0.5),
    "steps": 2,
    "step_tolerance": 1e-5,
    "scheme": "euler",
    "thickness": "first order",
    "initial": np.full(GRID.shape, 1e-7),
    "until": "through",
    "max_iterations": 1,
}
BACK_AND_FORTH = WEAR["slide"]
"""A cycle of fretting."""
CYCLES: dict[str, Any] = {"sliding": None, "cycles": 1e5, "slide": BACK_AND_FORTH}
ROLLED = WEAR["roll"] | {"force": None, "spin": 0.0, "order": 2, "coupling": True}
PASSES: dict[str, Any] = {"sliding": None, "passes": 1e6, "roll": ROLLED}


def wear(**keywords: Any) -> Any:
    given: dict[str, Any] = {"load": 10.0, "grid": GRID, "rate": 1e-16, "sliding": 100.0}
    given |= {"steps": 1, **keywords}
    return nacre.wear(BALL, COATED, given.pop("counterbody", STEEL), **given)


def pressed(function: Callable[..., Any], **given: Any) -> Callable[..., Any]:
    def call(**keywords: Any) -> Any:
        arguments = {"load": 10.0, "grid": GRID, **given, **keywords}
        counterbody = arguments.pop("counterbody", STEEL)
        return function(BALL, COATED, counterbody, **arguments)

    return call


slide = pressed(nacre.slide, friction=0.3, shift=(1e-7, None))
roll = pressed(nacre.roll, friction=0.3, creepage=(1e-3, 0.0), direction="+x")
CALLS: dict[str, tuple[Callable[..., Any], Callable[..., Any], dict[str, Any]]] = {
    "solve": (pressed(nacre.solve), nacre.solve, SOLVE),
    "slide": (slide, nacre.slide, SLIDE),
    "roll": (roll, nacre.roll, ROLL),
    "roll by cells": (
        lambda **given: roll(**{"cells": 2} | given),
        nacre.roll,
        ROLL | {"cells": 3},
    ),
    "wear": (wear, nacre.wear, WEAR),
}


def group(name: str, keywords: dict[str, Any]) -> Callable[..., Any]:
    """Return a call of wear that takes keys of a group."""

    def call(**keys: Any) -> Any:
        return wear(**keywords | {name: keywords[name] | keys})

    return call


def step(**keys: Any) -> Any:
    first, last = BACK_AND_FORTH["steps"]
    return wear(**CYCLES | {"slide": BACK_AND_FORTH | {"steps": [first | keys, last]}})


GROUPS: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
    "slide": (
        group("slide", CYCLES),
        {name: SLIDE[name] for name in ("tolerance", "max_convolutions", "coupling")}
        | {"friction": 0.1, "steps": BACK_AND_FORTH["steps"][1:], "force": (0.5, None)},
    ),
    "roll": (group("roll", PASSES), {name: one for name, one in ROLL.items() if name != "initial"}),
    "steps": (step, {name: SLIDE[name] for name in STEP}),
}


def numbers(result: Any) -> list[bytes]:
    """Return the fields of a result."""
    if isinstance(result, nacre.types.WearHistory):
        end = result.states[-1]
        fields = [end.depth, end.counter_depth, end.solution.pressure, result.distance]
        return [np.asarray(field).tobytes() for field in fields]
    last = result[-1] if isinstance(result, nacre.types.History | list) else result
    names = ("pressure", "gap", "approach", "traction", "slip")
    return [np.asarray(getattr(last, one)).tobytes() for one in names if hasattr(last, one)]


def acts(call: Callable[..., Any], name: str, value: object) -> bool:
    """Return whether a keyword changes the fields, or is refused by its name."""
    try:
        with np.errstate(all="ignore"):
            changed = quiet(call, **{name: value})
    except nacre.ConvergenceError:
        return name in ("max_iterations", "max_convolutions")
    except (ValueError, TypeError) as error:
        return name in str(error)
    return numbers(changed) != numbers(quiet(call))


@pytest.mark.parametrize("name", CALLS)
def test_every_keyword_acts_or_is_refused(name: str) -> None:
    call, function, values = CALLS[name]
    known = inspect.signature(function).parameters.values()
    keywords = {one.name for one in known if one.kind is one.KEYWORD_ONLY} - QUIETLY - {"store"}
    given = {key: value for key, value in values.items() if key not in ("counterbody", "initial")}
    assert keywords - {"initial"} == set(given)
    idle = {
        key for key, value in values.items() if value is not None and not acts(call, key, value)
    }
    assert not idle, (name, idle)


@pytest.mark.parametrize("name", GROUPS)
def test_every_key_of_a_group_of_wear_acts_or_is_refused(name: str) -> None:
    call, values = GROUPS[name]
    idle = {key for key, value in values.items() if not acts(call, key, value)}
    assert not idle, (name, idle)
    assert acts(call, "nonsense", 1)


def test_every_key_of_the_motion_is_tried() -> None:
    assert isinstance(PRESSED, Mapping)
    assert set(MOTION) <= set(PRESSED)
