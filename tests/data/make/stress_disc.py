"""Layered half-spaces under a uniform disc of pressure: stress_disc.json.

Hankel integrals of the states at each depth times the disc's transform q r0 J1(alpha r0)/alpha.
The first two cases are those of the pavement programs KENPAVE and AMADEUS/BISAR.
"""

import sys

import numpy as np
from common import main
from layered import Body, states
from scipy.special import j0, j1

NAME, SECONDS = "stress_disc.json", 8


def panels(end, width, order=12):
    """Gauss panels from 0 to end, geometric at the start."""
    edges = np.concatenate([[0.0], width * 2.0 ** np.arange(-24, 0), np.linspace(width, end, int(end / width) + 1)])
    x, w = np.polynomial.legendre.leggauss(order)
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    return (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


def stresses(state, shear, nu):
    """sigma_LL, sigma_TT from a state [alpha, component]."""
    along = -nu / (1 - nu) * state[:, 2] - 2 * shear / (1 - nu) * state[:, 1]
    across = -nu / (1 - nu) * state[:, 2] - 2 * shear * nu / (1 - nu) * state[:, 1]
    return along, across


def at(stack, r, z, above, transform, alpha, weights):
    """uz, ur, szz, srz, srr, stt at (r, z) under an axisymmetric pressure of known Hankel transform."""
    index, cut = stack.cut(z)
    state = states(cut, alpha)[:, index, :, 0]
    if above:  # V jumps at a frictionless interface: the state at the bottom of the layer above
        index -= 1
        index, cut = stack.cut(z * (1 - 1e-9))
        state = states(cut, alpha)[:, index, :, 0]
    part = [*[layer[1:3] for layer in cut.layers], cut.base][index]
    along, across = stresses(state, *part)
    w = weights * transform * alpha
    x = alpha * r
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
        layers = case["layers"]
        parts = [(*layer[:1], layer[1] / (2 * (1 + layer[2])), layer[2]) for layer in layers]
        slip = case["slip"]
        stack = Body([(*p, k not in slip) for k, p in enumerate(parts[:-1])], parts[-1][1:])
        radius = case["load_radius"]
        for row in case["rows"]:
            alpha, weights = panels(40 / row["z"], min(1.5 / (radius + row["r"]), 0.4 / layers[0][0]))
            transform = case["q"] * radius * j1(alpha * radius) / alpha
            row |= at(stack, row["r"], row["z"], row["side"] == -1, transform, alpha, weights)


if __name__ == "__main__":
    main(sys.modules[__name__])
