"""Pull-off of a rigid paraboloid with a cohesive zone of constant stress (Maugis): maugis.json.

The stress -sigma0 acts on a < r < c, where the gap reaches w/sigma0 at c. The density phi is
unknown on
(0, a) and -(2/pi) sigma0 sqrt(c^2 - t^2) on (a, c); continuity at a gives delta, the gap at c
gives c.
Lengths are in a0 (see jkr.py). Bare: Maugis, J. Colloid Interface Sci. 150 (1992) 243,
doi:10.1016/0021-9797(92)90285-T.
"""

import math
import sys

import numpy as np
from scipy.optimize import brentq, minimize_scalar
from scipy.special import j0

from axisym import Contact
from common import main
from jkr import MODULUS, SHAPE, WORK, response

NAME, SECONDS = "maugis.json", 60


def bare_load(a, strength):
    """Load over pi w R at the reduced radius a, Maugis' equations."""

    def gap(m):
        root = math.sqrt(m * m - 1)
        arc = math.atan(root)
        first = strength * a**2 / 2 * (root + (m * m - 2) * arc)
        return first + 4 * strength**2 * a / 3 * (root * arc - m + 1) - 1

    m = brentq(gap, 1.0, 1e6, xtol=1e-15, rtol=1e-15)
    root = math.sqrt(m * m - 1)
    return a**3 - strength * a**2 * (root + m * m * math.atan(root))


def coated_load(stack, a, strength):
    """Load over pi w R at the contact radius a."""
    stress = strength / (9 / (2 * np.pi * WORK * MODULUS**2)) ** (1 / 3)
    alpha, weights, m = stack.nodes(9 * a)
    contact = Contact(stack, a, SHAPE, 9 * a)
    x, w = np.polynomial.legendre.leggauss(80)
    n = len(contact.t)
    kernel = (contact.cosines.T * (weights * m)) @ contact.cosines
    matrix = np.eye(n) + 2 / np.pi * kernel * contact.w

    def solved(log):
        c = a * (1 + math.exp(log))
        low = math.asin(a / c)
        angle, dt = low + (math.pi / 2 - low) * (x + 1) / 2, w * (math.pi / 2 - low) / 2
        known = (
            -2 / np.pi * stress * c * np.cos(angle)
        )  # phi at t = c sin(angle), dt = c cos d angle
        dt = dt * c * np.cos(angle)
        cohesive = np.cos(alpha[:, None] * c * np.sin(angle)) @ (dt * known)
        right = -2 / np.pi * contact.cosines.T @ (weights * m * cohesive)
        pulled = np.linalg.solve(matrix, right)
        spectrum = contact.cosines @ (contact.w * pulled) + cohesive
        edge = -2 / np.pi * (np.cos(alpha * a) * weights * m) @ spectrum
        wanted = -2 / np.pi * stress * math.sqrt(c * c - a * a)
        delta = (wanted - edge + contact.edge_shape) / contact.edge
        phi = delta * contact.punch - contact.shape + pulled
        total = contact.cosines @ (contact.w * phi) + cohesive
        inside = c * np.sin(
            low * (x + 1) / 2
        )  # phi there by the equation itself, for 1/sqrt(c^2 - t^2)
        there = contact.f * (delta - contact.F(inside))
        there -= 2 / np.pi * np.cos(inside[:, None] * alpha) @ (weights * m * total)
        near = low / 2 * w @ there - 2 / np.pi * stress * (c - a)
        u = stack.a1 * (near + (weights * m * j0(alpha * c)) @ total)
        load = 2 * np.pi * ((contact.w * phi).sum() + (dt * known).sum())
        return c * c / 2 - delta + u - WORK / stress, load / (np.pi * WORK)

    log = brentq(lambda log: solved(log)[0], -16, math.log(8.0), xtol=1e-13)
    return solved(log)[1]


def deepest(load, radii):
    values = [load(a) for a in radii]
    k = int(np.argmin(values))
    found = minimize_scalar(load, (radii[k - 1], radii[k], radii[k + 1]), options={"xtol": 1e-10})
    return found.x, -found.fun


def fill(content):
    for row in content["bare"]:
        load = lambda a, s=row["lambda_"]: bare_load(a, s)  # noqa: E731
        row["pull_off_over_piwR"] = deepest(load, np.geomspace(0.02, 3, 60))[1]
    for case in content["coated"]:
        stack = response(case["E1_over_E2"], case["h_over_a0"])
        for row in case["rows"]:
            radii = row["a_over_a0"] * np.array([0.8, 1.0, 1.25])
            load = lambda a, r=stack, s=row["lambda_"]: coated_load(r, a, s)  # noqa: E731
            row["a_over_a0"], row["pull_off_over_piwR"] = deepest(load, radii)


if __name__ == "__main__":
    main(sys.modules[__name__])
