"""Rigid paraboloid on a bonded coating, under a given load: sphere_coated.json."""

import sys

import numpy as np
from scipy.optimize import brentq

from axisym import Contact, Response, tip
from common import main
from layered import coat

NAME, SECONDS = "sphere_coated.json", 4


def press(stack, young):
    """Press a paraboloid of radius 1 whose Hertz contact on `young` has the radius 1."""
    response, shape = Response(stack), tip({"kind": "paraboloid", "R": 1.0})
    load = 4 * young / 3
    log = brentq(
        lambda x: np.log(Contact(response, np.exp(x), shape).P / load), -2.5, 2.5, xtol=1e-14
    )
    return Contact(response, np.exp(log), shape), 3 * load / (2 * np.pi)


def fill(content, rigid=False):
    for case in content["cases"]:
        nu = case["poisson"]
        stack = coat(case.get("modulus_ratio", 1.0), case["h"], nu, rigid)
        contact, hertz = press(stack, 1 / (1 - nu**2))
        peak = contact.pressure(0.0) / hertz
        case |= {"peak": peak, "radius": contact.a, "approach": contact.delta}


if __name__ == "__main__":
    main(sys.modules[__name__])
