"""Pull-off of a rigid paraboloid with JKR's adhesion on a bonded coating: jkr.json.

Griffith: the edge density of Fredholm's equation is phi(a) = -sqrt(2 a E1* w/pi), w the work of
adhesion
(E1* of the coating). Lengths are in a0, E2 = 1, R = 1: a0^3 = 9 pi w R^2/(8 E2*) = 1.
"""

import functools
import sys

import numpy as np
from scipy.optimize import brentq

from axisym import Contact, Response, tip
from common import main
from layered import coat

NAME, SECONDS, NU = "jkr.json", 150, 0.3
MODULUS = 1 / (1 - NU**2)
WORK = 8 * MODULUS / (9 * np.pi)
SHAPE = tip({"kind": "paraboloid", "R": 1.0})
STEP = 1e-30


@functools.lru_cache(4)
def response(ratio, h):
    return Response(coat(ratio, h, NU))


def state(stack, a):
    """Load over pi w R and approach at a contact radius, which may be complex."""
    contact = Contact(stack, a, SHAPE)
    edge = -np.sqrt(4 * a * WORK / (np.pi * stack.a1))  # E1* = 2/A1
    delta = (edge + contact.edge_shape) / contact.edge
    return np.array([(contact.S * delta - contact.PF) / (np.pi * WORK), delta])


def minimum(stack, which, radii, values):
    """Deepest minimum of load (0) or approach (1) over the radius, and the number of minima."""
    inner = values[1:-1]
    places = np.flatnonzero((inner < values[:-2]) & (inner < values[2:])) + 1
    k = places[np.argmin(values[places])]

    def slope(x):
        return state(stack, np.exp(x) * (1 + 1j * STEP))[which].imag / STEP

    return np.exp(brentq(slope, np.log(radii[k - 1]), np.log(radii[k + 1]), xtol=1e-14)), len(
        places
    )


def fill(content):
    for row in content["table"]:
        stack = response(row["E1_over_E2"], row["h_over_a0"])
        radii = np.geomspace(0.05, 5, 34)
        scan = np.array([state(stack, a) for a in radii])
        for which, key in enumerate(("load_control", "displacement_control")):
            a, count = minimum(stack, which, radii, scan[:, which])
            load, delta = state(stack, a)
            row[key] |= {
                "pull_off_over_piwR": -load,
                "a_over_a0": a,
                "delta_over_d0": delta,
                "minima": count,
            }
        low = high = row["load_control"]["a_over_a0"]
        while state(stack, high)[0] < 0:
            low, high = high, 1.3 * high
        a = brentq(lambda a: state(stack, a)[0], low, high, xtol=1e-14)
        row["zero_load"] |= {"a_over_a0": a, "delta_over_d0": state(stack, a)[1]}
    for curve in content["curves"]:
        stack = response(curve["E1_over_E2"], curve["h_over_a0"])
        curve["rows"] = [[row[0], *state(stack, row[0])] for row in curve["rows"]]


if __name__ == "__main__":
    main(sys.modules[__name__])
