"""Materials, shapes and contacts that many tests share."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import nacre

NAN, INF = float("nan"), float("inf")

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
HARD = nacre.Elastic(young=420e9, poisson=0.2)
DLC = nacre.Elastic(young=420e9, poisson=0.3)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(HARD, thickness=20e-6)])
SLIPPING = nacre.HalfSpace(STEEL, [nacre.Layer(HARD, 20e-6, "frictionless")])
BALL = nacre.Sphere(5e-3)
ROD = nacre.Cylinder(5e-3)
HELD: dict[str, Any] = {"load": 10.0, "friction": 0.3}
"""Friction bears 3 N."""


def quiet(call: Callable[..., Any], *arguments: Any, **keywords: Any) -> Any:
    """Return what `call` returns, without warnings of nacre."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", nacre.NacreWarning)
        return call(*arguments, **keywords)


def coated(young: float, thickness: float, substrate: Any = STEEL) -> nacre.HalfSpace:
    """Return a body with one layer, whose Poisson's ratio is 0.3."""
    return nacre.HalfSpace(substrate, [nacre.Layer(nacre.Elastic(young, 0.3), thickness)])
