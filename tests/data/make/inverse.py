"""Synthetic indentation curves with noise, and what a fit can tell: inverse.json.

Inputs are the true numbers, the depths and the loads with their noise. Found are the loads without
noise, the Cramer-Rao bounds at the true numbers and the maximum of likelihood (Gauss and Newton's
steps from there). P(delta) comes from axisym.py at Chebyshev points of ln a; at a given depth

    dP/d theta = P_theta(a) - S delta_theta(a),   dP/d delta = S,

with complex steps at fixed radius. The row of seed 16 has no maximum of likelihood: the sum of
squares falls along a ridge, to thinner and softer coats without end.
"""

import sys

import numpy as np
from numpy.polynomial import chebyshev

from axisym import Contact, Response, tip
from common import main
from layered import Body

NAME, SECONDS, POINTS, STEP = "inverse.json", 150, 30, 1e-30


class Curve:
    """Load and its derivatives over true depths, for logarithms of E1, E2 and h."""

    def __init__(self, row, x, depth):
        true = row["true"]
        values = {f"ln{k}": np.log(true[k]) for k in ("E1", "E2", "h")} | x
        shape = tip({"kind": "paraboloid", "R": true["R"]})
        low, high = (
            np.log(0.5 * np.sqrt(depth.min() * true["R"])),
            np.log(1.6 * np.sqrt(depth.max() * true["R"])),
        )
        at = np.cos(np.pi * (np.arange(POINTS) + 0.5) / POINTS)
        radii = np.exp((low + high) / 2 + (high - low) / 2 * at)

        def contacts(moved):
            young1, young2, h = (np.exp(moved[k]) for k in ("lnE1", "lnE2", "lnh"))
            shears = young1 / (2 * (1 + true["nu1"])), young2 / (2 * (1 + true["nu2"]))
            body = Body([(h, shears[0], true["nu1"], True)], (shears[1], true["nu2"]))
            response = Response(body)
            found = [Contact(response, a, shape) for a in radii]
            return np.array([[one.P, one.delta, one.S] for one in found]).T

        load, delta, slope = contacts(values)
        fit = lambda v: chebyshev.chebfit(at, v, POINTS - 1)  # noqa: E731
        depths, rise = fit(np.log(delta)), chebyshev.chebder(fit(np.log(delta)))
        place = np.interp(np.log(depth), np.log(delta)[::-1], at[::-1])
        for _ in range(6):
            off = chebyshev.chebval(place, depths) - np.log(depth)
            place = place - off / chebyshev.chebval(place, rise)
        self.load = np.exp(chebyshev.chebval(place, fit(np.log(load))))
        self.slope = np.exp(chebyshev.chebval(place, fit(np.log(slope))))
        self.by = {}
        for key in x:
            moved = contacts(values | {key: values[key] + 1j * STEP}).imag / STEP
            share = (moved[0] - slope * moved[1]) / load
            self.by[key] = self.load * chebyshev.chebval(place, fit(share))


def model(row, x, clean=None):
    """Return loads, and residuals and their Jacobian in units of the noise."""
    depth, load = np.array(row["depth"]), np.array(row["load"])
    time, whole = np.linspace(0, 1, len(depth)), depth[-1]
    shifts = {k: row["true"][f"{k}_over_dmax"] for k in ("d0", "drift")} | x
    logs = {k: v for k, v in x.items() if k.startswith("ln")}
    curve = Curve(row, logs, depth - (shifts["d0"] + shifts["drift"] * time) * whole)
    by = curve.by | {"d0": -curve.slope * whole, "drift": -curve.slope * whole * time}
    columns = np.stack([by[k] for k in x], axis=1)
    if row["noise"] == "relative":
        return (
            curve.load,
            np.log(load / curve.load) / row["sigma"],
            columns / curve.load[:, None] / row["sigma"],
        )
    unit = row["sigma"] * (curve.load if clean is None else clean).max()
    return curve.load, (load - curve.load) / unit, columns / unit


def fill(content):
    for row in content["curves"]:
        true, free = row["true"], row["free"]
        x = {k: np.log(true[k[2:]]) if k.startswith("ln") else true[f"{k}_over_dmax"] for k in free}
        clean, _, jacobian = model(row, x)
        covariance = np.linalg.inv(jacobian.T @ jacobian)
        sigmas = np.sqrt(np.diag(covariance))
        row |= {
            "load_noise_free": clean.tolist(),
            "cramer_rao_sigma": dict(zip(free, sigmas.tolist(), strict=True)),
        }
        row["correlation"] = (covariance / np.outer(sigmas, sigmas)).tolist()
        if "scaled_jacobian_condition" in row:
            row["scaled_jacobian_condition"] = np.linalg.cond(
                jacobian / np.linalg.norm(jacobian, axis=0)
            )
        for _ in range(8 if "maximum_likelihood" in row else 0):
            _, rest, jacobian = model(row, x, clean)
            step = np.linalg.lstsq(jacobian, rest)[0]
            x = dict(zip(free, np.array(list(x.values())) + step, strict=True))
            if (np.abs(step) < 1e-7 * sigmas).all():
                break
        if "maximum_likelihood" in row:
            row["maximum_likelihood"] = {k: float(v) for k, v in x.items()}
            row["chi2"] = float((model(row, x, clean)[1] ** 2).sum())


if __name__ == "__main__":
    main(sys.modules[__name__])
