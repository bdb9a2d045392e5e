"""Rigid cylinder on a bonded coating in plane strain, under a given load: line_coated.json."""

import sys

import numpy as np
from scipy.optimize import brentq

from axisym import Response, lowest
from common import main
from layered import coat
from line import Line

NAME, SECONDS = "line_coated.json", 4


def press(stack, young):
    """Press a cylinder of radius 1 whose Hertz contact on `young` has half-width 1; also p_H."""
    response, load = Response(stack), np.pi * young / 4
    log = brentq(lambda x: np.log(Line(response, np.exp(x)).P / load), -2.5, 2.5, xtol=1e-14)
    return Line(response, np.exp(log)), 2 * load / np.pi


def fill(content):
    for case in content["cases"]:
        nu = case["poisson"]
        line, hertz = press(coat(case["modulus_ratio"], case["h"], nu), 1 / (1 - nu**2))
        found = line.pressure([0.0, 0.25, 0.5, 0.75]) / hertz
        high = lowest(lambda x: -line.pressure(x), (0.0, 0.95), 1e-9)
        centred = -high.fun / hertz <= found[0] * (1 + 1e-12)
        case |= {"pressure": found.tolist(), "centre": found[0], "half_width": line.b}
        case |= {
            "peak": found[0] if centred else -high.fun / hertz,
            "peak_at": 0.0 if centred else high.x * line.b,
        }


if __name__ == "__main__":
    main(sys.modules[__name__])
