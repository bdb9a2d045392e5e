"""Shift and twist of a sticking circle on coated bodies: friction/stick_stiffness.json.

Galerkin's method in the wave numbers. The tractions q_x = q0 + q2 cos 2 theta, q_y = q2 sin 2
theta have the Hankel
transforms H0 (of order 0) and H2 (of order 2), series of the spherical Bessel functions j_2k(alpha
a):

    integral (s H0 - d H2) j_2k d alpha = delta at k = 0, else 0,   integral (d H0 - s H2) j_2k =
    0, k > 0
    s = alpha (c22 + ct)/2,  d = alpha (c22 - ct)/2,  Q = 2 pi H0(0)

and with j_2k+1 for the twist (derived here).
"""

import sys

import numpy as np
from scipy.special import spherical_jn

from common import main
from layered import Body, coat, compliances
from stress_disc import panels

NAME, SECONDS, MODES = "friction/stick_stiffness.json", 3, 24


def matrix(values, limit, alpha, weights, orders):
    """Integrals of values * j_m j_n over alpha, for a = 1, values -> limit."""
    j = np.array([spherical_jn(n, alpha) for n in orders])
    return (j * (weights * (values - limit))) @ j.T + np.diag(
        limit * np.pi / (2 * (2 * np.array(orders) + 1))
    )


def fill(content):
    for case in content["cases"]:
        if "layers" in case:
            parts = [
                (m["h_over_a"], m["E"] / (2 * (1 + m["nu"])), m["nu"], True) for m in case["layers"]
            ]
            base = case["substrate"]
            stack = Body(parts, (base["E"] / (2 * (1 + base["nu"])), base["nu"]))
        else:
            stack = coat(case["E1_over_E2"], case["h_over_a"], 0.3)
        (shear, nu), (shear2, nu2) = stack.top, stack.base
        alpha, weights = panels(21 / stack.layers[0][0], 0.3)
        c22, ct = compliances(stack, alpha)[2], compliances(stack, alpha, 2)
        even, odd = 2 * np.arange(MODES), 2 * np.arange(MODES) + 1
        s = matrix((c22 + ct) / 2, (2 - nu) / (2 * shear), alpha, weights, even)
        d = matrix((c22 - ct) / 2, -nu / (2 * shear), alpha, weights, even)
        system = np.block([[s, -d[:, 1:]], [d[1:], -s[1:, 1:]]])
        right = np.zeros(2 * MODES - 1)
        right[0] = 1
        case["stiffness_over_bare"] = (
            2 * np.pi * np.linalg.solve(system, right)[0] * (2 - nu2) / (8 * shear2)
        )
        twist = matrix(ct, 1 / shear, alpha, weights, odd)
        moment = 4 * np.pi / 3 * np.linalg.solve(twist, 2 / 3 * np.eye(MODES)[0])[0]
        case["torsion_over_bare"] = moment * 3 / (16 * shear2)


if __name__ == "__main__":
    main(sys.modules[__name__])
