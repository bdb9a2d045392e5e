"""Every shape: the arguments that make it, and calls that are refused.

Tests of fields, values, case files and messages take their rows from here.
"""

import math
import re
from typing import Any, NamedTuple

import nacre

CROWNED = {"radius": 5e-3, "flat_length": 19.13e-3, "crown_radius": 7.5}
LOGARITHMIC = nacre.LogarithmicProfile(1e-5 / 3, 20e-3, flat_length=5e-3, end_factor=0.9)
SAMPLED = nacre.SampledProfile(x=[-1e-2, 1e-3 / 3, 1e-2], drop=[1e-5 / 3, 0.0, 1e-6 / 7])
THIRDS = tuple(tuple((4 * i + j) / 3e6 for j in range(4)) for i in range(3))


class Row(NamedTuple):
    """Tests of one shape."""

    arguments: list[dict[str, Any]]
    """Arguments of calls: together all of them, and none as it is by default."""
    refused: dict[str, str]
    """Calls that raise a `ValueError`, with its words; `package/test_errors.py` has their names."""


SHAPES = {
    "Sphere": Row(
        [
            {"radius": 5e-3},
            {"radius": 5e-3, "counter_radius_x": -5e-3 * 1.04, "counter_radius_y": 1e-2 / 3},
            {"radius": 5e-3, "counter_radius_y": -6e-3},
        ],
        {
            "Sphere(0.0)": r"radius must be .*above 0, got 0",
            "Sphere(1.0, counter_radius_x=-1.0)": r"counter_radius_x must be .*groove.*got -1",
            "Sphere(5e-3, counter_radius_y=NAN)": r"counter_radius_y must be above 0.*got NaN",
        },
    ),
    "Paraboloid": Row(
        [
            {"radius_x": 5e-3, "radius_y": 1.0},
            {"radius_x": 5e-3, "radius_y": 1.0, "counter_radius_x": -1e-2 / 3 * 2},
            {"radius_x": 5e-3, "radius_y": 1.0, "counter_radius_x": 0.1, "counter_radius_y": -3.0},
            {"radius_x": math.inf, "radius_y": 1.0},
            {"radius_x": 5e-3, "radius_y": math.inf, "counter_radius_y": 0.1},
        ],
        {
            "Paraboloid(1.0, -INF)": r"radius_y must be .*above 0, got -inf",
            "Paraboloid(1.0, -2.0)": r"radius_y must be .*above 0, got -2",
            "Paraboloid(1.0, 1.0, counter_radius_y=-0.5)": r"counter_radius_y must be .*got -0\.5",
        },
    ),
    "Cylinder": Row(
        [
            {"radius": 5e-3},
            {"radius": 5e-3, "counter_radius": 1e-1 / 3},
            {"radius": math.inf},
            {"radius": math.inf, "counter_radius": 0.1},
        ],
        {
            "Cylinder(-2.0)": r"radius must be .*raceway or groove use counter_radius.*got -2",
            "Cylinder(1.0, -0.5)": r"counter_radius must be .*raceway.*wider.*got -0\.5",
            "Cylinder(1.0, 0.0)": r"counter_radius must be above 0.*got 0",
            "Cylinder(INF, -1.0)": r"counter_radius must be .*wider than the shape.*got -1",
            "Cylinder(NAN)": r"radius must be .*above 0, got NaN",
        },
    ),
    "Roller": Row(
        [
            CROWNED,
            CROWNED | {"length": 26e-3},
            CROWNED | {"counter_radius": -0.1 / 3, "apex": 0.4 / 3},
            {"radius": 5e-3, "profile": LOGARITHMIC},
            {"radius": 5e-3, "profile": SAMPLED, "length": 18e-3},
        ],
        {
            "Roller(-1.0, 1.0, 1.0)": r"radius must be .*counter_radius.*above 0, got -1",
            "Roller(1.0, 1.0, 1.0, apex=0.0)": r"apex must be finite and not 0, got 0",
            "Roller(0.0, 1.0, 1.0)": r"radius must be .*above 0, got 0",
            "Roller(1.0, -1.0, 1.0)": r"flat_length must be .*at least 0, got -1",
            "Roller(1.0, 1.0, 0.0)": r"crown_radius must be .*above 0, got 0",
            "Roller(1.0, 1.0, 1.0, length=0.5)": r"length must be at least flat_length.*got 0\.5",
            "Roller(1.0)": r"flat_length.*crown_radius.*profile",
            "Roller(1.0, 1.0)": r"flat_length.*crown_radius.*profile",
            "Roller(1.0, 1.0, 1.0, profile=PROFILE)": r"flat_length.*crown_radius.*profile",
        },
    ),
    "FlatPunch": Row([{"radius": 1e-3}], {"FlatPunch(0.0)": r"radius must be .*above 0, got 0"}),
    "HeightMap": Row(
        [
            {
                **{"heights": ((0.0, 1e-6), (2e-6, 3e-6)), "spacing": (1e-6, 2e-6)},
                **{"center": (1e-6, 0.0), "periodic": (True, True)},
            },
            {"heights": THIRDS, "spacing": (0.1, 0.1), "center": (1e-6, -2e-6)},
        ],
        {
            "HeightMap(NAN_AT_1_2, 1.0)": r"heights is not finite at \[1, 2\]",
            "HeightMap([1.0, 2.0], 1.0)": r"heights must have two dimensions.*\[2\]",
            "HeightMap(np.zeros((2, 2, 2)), 1.0)": r"heights must have two dimensions.*\[2, 2, 2\]",
            "HeightMap([[1.0, 2.0]], 1.0)": "number of heights .* at least 2, got 1",
            "HeightMap(np.zeros((0, 0)), 1.0)": "number of heights .* at least 2, got 0",
            "HeightMap(HEIGHTS, (1.0, -1.0))": r"spacing must be .*above 0, got -1",
            "HeightMap(HEIGHTS, 1.0, center=(NAN, 0.0))": r"center must be finite, got NaN",
        },
    ),
}
"""Tests of all shapes, by the names of their classes."""
VALUES: dict[str, nacre.types.Shape] = {
    f"{name} {number}": getattr(nacre, name)(**arguments)
    for name, row in SHAPES.items()
    for number, arguments in enumerate(row.arguments)
}
"""Shapes of those arguments."""
TABLES: list[tuple[dict[str, Any], nacre.types.Shape]] = [
    (
        {"kind": re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()} | arguments,
        VALUES[f"{name} {number}"],
    )
    for name, row in SHAPES.items()
    for number, arguments in enumerate(row.arguments)
    if all(isinstance(value, float) for value in arguments.values())
]
"""Tables of case files, and the shapes that they describe, of arguments that are numbers."""
