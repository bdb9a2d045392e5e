"""Derivatives of radius, approach and pressure of coated spheres: sphere_derivatives.json."""

import sys

import numpy as np

from axisym import Contact, Response, lowest, tip
from common import main
from layered import Body

NAME, SECONDS = "sphere_derivatives.json", 6
STEP = 1e-30  # along the imaginary axis: no cancellation


def contact(values, a):
    shear1, shear2 = (values[f"E{k}"] / (2 * (1 + values[f"nu{k}"])) for k in (1, 2))
    stack = Body([(values["h"], shear1, values["nu1"], True)], (shear2, values["nu2"]))
    return Contact(Response(stack), a, tip({"kind": values["tip"], "R": values["R"]}))


def logs(values, a):
    """Logarithms of load, approach and central pressure."""
    found = contact(values, a)
    return np.log(np.array([found.P, found.delta, found.pressure(0.0)]))


def fill(content):
    for case in content["cases"]:
        a = case["a"]
        found = contact(case, a)
        centre = found.pressure(0.0)
        case |= {"W": found.P, "delta": found.delta, "p0": centre}
        inner = lowest(lambda r: -found.pressure(r), (0.0, 0.95 * a), 1e-8 * a)
        case["peak_over_p0"] = max(1.0, round(-inner.fun / centre, 12))
        along = logs(case, a * (1 + 1j * STEP)).imag / STEP  # d/dln a of ln W, ln delta, ln p0
        for name, kept in case["derivatives"].items():
            key = name.removeprefix("d/d").removeprefix("ln")
            if key == "W":
                by_load = np.array([1.0, 0.0, 0.0])  # ln W itself rises by 1
                slope = 1 / along[0]
                change = [slope, slope * along[1], slope * along[2]]
            else:
                step = case[key] * 1j * STEP if "ln" in name else 1j * STEP
                by_load = logs(case | {key: case[key] + step}, a).imag / STEP
                slope = -by_load[0] / along[0]
                change = [slope, *(by_load[1:] + slope * along[1:])]
            kept |= dict(zip(("ln_a", "ln_delta", "ln_p0"), map(float, change), strict=True))


if __name__ == "__main__":
    main(sys.modules[__name__])
