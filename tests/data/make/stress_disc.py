"""Layered half-spaces under a uniform disc of pressure: stress_disc.json.

Hankel integrals of the states at each depth times the disc's transform q r0 J1(alpha r0)/alpha.
The first two cases are those of the pavement programs KENPAVE and AMADEUS/BISAR.
"""

import sys

import numpy as np
from scipy.special import j0, j1

from common import main
from layered import Body, excess, states

NAME, SECONDS = "stress_disc.json", 8


def panels(end, width, order=12):
    """Gauss panels from 0 to end, geometric at the start."""
    edges = np.concatenate(
        [[0.0], width * 2.0 ** np.arange(-24, 0), np.linspace(width, end, int(end / width) + 1)]
    )
    x, w = np.polynomial.legendre.leggauss(order)
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    return (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


def stresses(state, shear, nu):
    """sigma_LL, sigma_TT from a state [alpha, component]."""
    along = -nu / (1 - nu) * state[:, 2] - 2 * shear / (1 - nu) * state[:, 1]
    across = -nu / (1 - nu) * state[:, 2] - 2 * shear * nu / (1 - nu) * state[:, 1]
    return along, across


def at(state, part, alpha, weights, r):
    """Return uz, ur, szz, srz, srr, stt from states; weights include the pressure's transform."""
    along, across = stresses(state, *part)
    w, x = weights * alpha, alpha * r
    bessel0, bessel1 = j0(x), j1(x)
    over = np.where(x > 1e-8, bessel1 / np.where(x > 0, x, 1), 0.5)
    return {
        "uz": w @ (state[:, 0] / alpha * bessel0),
        "ur": -w @ (state[:, 1] / alpha * bessel1),
        "szz": -w @ (state[:, 2] * bessel0),
        "srz": w @ (state[:, 3] * bessel1),
        "srr": w @ (along * bessel0 - (along - across) * over),
        "stt": w @ (across * bessel0 + (along - across) * over),
    }


def fill(content):
    for case in content["cases"]:
        parts = [(e / (2 * (1 + nu)), nu) for _, e, nu in case["layers"]]
        thick = [h for h, _, _ in case["layers"][:-1]]
        stack = Body([(h, *part, True) for h, part in zip(thick, parts, strict=False)], parts[-1])
        radius, reach = case["load_radius"], max(row["r"] for row in case["rows"])
        for z in sorted({row["z"] for row in case["rows"]}):
            alpha, weights = panels(40 / z, min(1.5 / (radius + reach), 0.4 / thick[0]))
            weights = weights * case["q"] * radius * j1(alpha * radius) / alpha
            index, cut = stack.cut(z)
            state = states(cut, alpha)[:, index, :, 0]
            for row in case["rows"]:
                if row["z"] == z:  # side -1: of the layer above, whose state is the same
                    part = [*[layer[1:3] for layer in cut.layers], cut.base][index + row["side"]]
                    row |= at(state, part, alpha, weights, row["r"])
        bare = 2 * (1 - parts[0][1]) / (2 * parts[0][0]) * case["q"] * radius  # of the top material
        alpha, weights = panels(21 / thick[0], min(1.0 / radius, 0.3 / thick[0]))
        rest = weights * excess(stack, alpha) * j1(alpha * radius) / alpha
        case["surface_uz_centre"] = (
            bare + case["q"] * radius * (1 - parts[0][1]) / parts[0][0] * rest.sum()
        )


if __name__ == "__main__":
    main(sys.modules[__name__])
