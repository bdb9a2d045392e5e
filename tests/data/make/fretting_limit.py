"""End of fretting wear around a zone that sticks, in closed form: wear/fretting_limit.json.

The zone |x| < c or r < c keeps its shape, and all else has worn until it carries nothing: a contact
of known width with a parabola of radius 1, E* = 1 (derived here). With W = 2/pi times the load,

    cylinder:  p = (load/pi + (c^2 - 2x^2)/4)/sqrt(c^2 - x^2)
               wear = W t - (x^2 - c^2)/2 - c^2 (1 - exp(-2t))/4,   x = c cosh t
    ball:      p = ((d - c^2)/sqrt(c^2 - r^2) + 2 sqrt(c^2 - r^2))/pi,   load = 2 (d c - c^3/3)
               wear = d - r^2/2 - u(r),
               u = (2/pi) ((d - r^2/2) asin(c/r) + c sqrt(r^2 - c^2)/2)

`disagreement` is the largest of the relative differences in load, p_centre and p_at_half_c to dense
collocation.
"""

import itertools
import sys

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

from common import main

NAME, SECONDS = "wear/fretting_limit.json", 2
CELLS = 400
PLACES = np.array([0.1, 0.25, 0.5, 0.75])  # of the depths, from c to the outer border


def cylinder(c, load):
    """Pressure and wear as functions of the distance from the middle."""

    def pressure(x):
        return (load / np.pi + (c**2 - 2 * x**2) / 4) / np.sqrt(c**2 - x**2)

    def wear(x):
        t = np.arccosh(x / c)
        return 2 * load * t / np.pi - (x**2 - c**2) / 2 + c**2 * np.expm1(-2 * t) / 4

    return pressure, wear


def ball(c, approach):
    """Pressure and wear as functions of the radius."""

    def pressure(r):
        root = np.sqrt(c**2 - r**2)
        return ((approach - c**2) / root + 2 * root) / np.pi

    def wear(r):
        angle, root = np.arcsin(c / r), np.sqrt(r**2 - c**2)
        return approach - r**2 / 2 - 2 / np.pi * ((approach - r**2 / 2) * angle + c * root / 2)

    return pressure, wear


def strips(x, ends):
    """Displacement at x under unit pressure on strips between ends, but for a constant."""

    def primitive(s):
        return s * (np.log(abs(s)) - 1)

    far = x[:, None] - ends
    return 2 / np.pi * (primitive(far[:, 1:]) - primitive(far[:, :-1]))


def disc(r, a):
    """Displacement at the radii r under unit pressure on a disc of radius a (Johnson 1985)."""
    inner, outer = np.minimum(r / a, a / r), r > a
    square = inner**2
    inside = a * ellipe(square)
    outside = r * (ellipe(square) - (1 - square) * ellipkm1(1 - square))
    return 4 / np.pi * np.where(outer, outside, inside)


def dense(row):
    """Load and pressures at 0 and c/2 by constant cells, whose ends are c sin(angle)."""
    c = row["c"]
    if row["shape"] == "cylinder":
        ends = c * np.sin(np.linspace(-np.pi / 2, np.pi / 2, CELLS + 1))
        middles = (ends[1:] + ends[:-1]) / 2
        matrix, areas = strips(middles, ends), np.diff(ends)
        system = np.block([[matrix, -np.ones((CELLS, 1))], [areas, np.zeros(1)]])
        right = [*(-(middles**2) / 2), row["load"]]
        pressure = np.linalg.solve(system, right)[:-1]
    else:
        ends = c * np.sin(np.linspace(0, np.pi / 2, CELLS + 1))
        middles = (ends[1:] + ends[:-1]) / 2
        discs = [disc(middles, a) for a in ends[1:]]
        matrix = np.array([discs[0], *(b - a for a, b in itertools.pairwise(discs))])
        pressure = np.linalg.solve(matrix.T, row["approach"] - middles**2 / 2)
        areas = np.pi * np.diff(ends**2)
    at = np.interp([0, c / 2], middles, pressure)
    return np.array([areas @ pressure, *at])


def fill(content):
    for row in content["rows"]:
        c = row["c"]
        if row["shape"] == "cylinder":
            pressure, wear = cylinder(c, row["load"])
            weight, reach = (lambda x: 2.0), 2.0
        else:
            if row["given"] == "load":
                row["approach"] = (row["load"] / 2 + c**3 / 3) / c
            row["load"] = 2 * (row["approach"] * c - c**3 / 3)
            pressure, wear = ball(c, row["approach"])
            weight, reach = (lambda r: 2 * np.pi * r), 2.0
        outer = brentq(wear, c * (1 + 1e-3), reach, xtol=1e-15)
        # A square root at c is smooth in t.
        worn = quad(lambda t: wear(c + t**2) * weight(c + t**2) * 2 * t, 0, np.sqrt(outer - c))
        x = c + (outer - c) * PLACES
        numbers = {"p_centre": pressure(0.0), "p_at_half_c": pressure(c / 2)}
        exact = np.array([row["load"], *numbers.values()])
        numbers |= {"outer": outer, "worn": worn[0]}
        row |= {name: float(value) for name, value in numbers.items()}
        row |= {"x": x.tolist(), "wear": wear(x).tolist()}
        off = float(max(abs(dense(row) / exact - 1)))
        row["disagreement"] = float(f"{off:.2g}")


if __name__ == "__main__":
    main(sys.modules[__name__])
