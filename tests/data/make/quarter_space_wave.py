"""A pressure cos(k y) on all of a quarter space, by the distance x to its end.

Fills quarter_space_wave.json. Hetenyi's two overlapping half-spaces: a pressure P on z = 0,
continued evenly to x < 0, makes the end face x = 0 carry T P; the same on the end face makes z = 0
carry T T P, so that with the wave number k = 1, R^2 = x^2 + z^2,

    P = p + T^2 P,   u_z pi G/(1 - nu) = integral [K0(|x - t|) + K0(x + t)] P(t) dt
    T(z, x) = -(2/pi) {z x^2/R^2 [2 K1(R)/R + K0(R)] - (1 - 2 nu) J}
    J = integral of K0(sqrt(x^2 + t^2)) over t > z

(derived here from the half-space's stresses). S = P - p is smooth in ln x, also where p jumps:
Nystroem's method on panels that grow by a factor.
"""

import sys

import numpy as np
from scipy.special import iti0k0, k0, k1

from common import main

NAME, SECONDS = "quarter_space_wave.json", 6
RATIO, ORDER, LOWEST, HIGHEST = (
    1.8,
    12,
    -56,
    7,
)  # panels from 1.8^-56 = 5e-15 to 1.8^7 = 61; 1 is an edge
X, W = np.polynomial.legendre.leggauss(ORDER)
EDGES = np.log(RATIO) * np.arange(LOWEST, HIGHEST + 1)
HALF = np.log(RATIO) / 2
NODES = np.exp(((EDGES[1:] + EDGES[:-1]) / 2)[:, None] + HALF * X)  # [panel, node]
WEIGHTS = HALF * W * NODES


def integration():
    """Weights of the integral from each node of a panel to its end, by interpolation in ln x."""
    legendre = np.polynomial.legendre.legvander(X, ORDER)
    k = np.arange(1, ORDER)
    to_end = np.empty((ORDER, ORDER))
    to_end[:, 0] = 1 - X
    to_end[:, 1:] = (legendre[:, k - 1] - legendre[:, k + 1]) / (2 * k + 1)
    coefficients = legendre[:, :ORDER].T * W * (np.arange(ORDER)[:, None] + 0.5)
    return HALF * to_end @ coefficients


def kernels(x):
    """T(z, x) = A + (1 - 2 nu) B at the nodes z, for any x: A and B."""
    z = NODES.ravel()
    r = np.hypot(z[:, None], x)
    small = k0(r)
    # J: from z on, panel by panel, for each x.
    by_panel = (small * WEIGHTS.ravel()[:, None]).reshape(len(EDGES) - 1, ORDER, -1)
    later = by_panel.sum(1)[::-1].cumsum(0)[::-1] - by_panel.sum(1)
    inside = (small * z[:, None]).reshape(by_panel.shape)
    tail = np.einsum("ij,pjx->pix", integration(), inside) + later[:, None]
    first = z[:, None] * x**2 / r**2 * (2 * k1(r) / r + small)
    return -2 / np.pi * first, 2 / np.pi * tail.reshape(r.shape)


def operator(nu):
    """T at the nodes, with the weights of the integral over x."""
    first, second = kernels(NODES.ravel())
    return (first + (1 - 2 * nu) * second) * WEIGHTS.ravel()


def added(nu, p):
    """S = P - p at the nodes."""
    t = operator(nu)
    return np.linalg.solve(np.eye(len(t)) - t @ t, t @ (t @ p))


def displacing(x):
    """Weights of S at the nodes in the integral of [K0(|x - t|) + K0(x + t)] S(t) dt."""
    found = np.zeros(NODES.shape)
    bary = np.array([1 / np.prod(node - np.delete(X, k)) for k, node in enumerate(X)])
    fine, weights = np.polynomial.legendre.leggauss(16)
    for panel, (low, high) in enumerate(zip(np.exp(EDGES[:-1]), np.exp(EDGES[1:]), strict=True)):
        if x == 0 or not low / 3 < x < 3 * high:
            kernel = k0(np.abs(x - NODES[panel])) + k0(x + NODES[panel])
            found[panel] = WEIGHTS[panel] * kernel
            continue
        middle = min(max(x, low), high)  # pieces that shrink towards x
        shrink = np.concatenate([[0.0], 0.25 ** np.arange(22, -1, -1)])
        for a, b in ((middle, low), (middle, high)):
            ends = middle + (b - a) * shrink
            at = ((ends[1:] + ends[:-1]) / 2)[:, None] + (np.diff(ends) / 2)[:, None] * fine
            rule = np.abs(np.diff(ends) / 2)[:, None] * weights
            place = (np.log(at) - (EDGES[panel] + HALF)) / HALF
            away = place[..., None] - X
            away[away == 0] = 1e-300
            share = bary / away
            near = np.maximum(np.abs(x - at), 1e-300)
            rule = rule * (k0(near) + k0(np.maximum(x + at, 1e-300))) / share.sum(-1)
            found[panel] += np.tensordot(rule, share, 2)
    return found.ravel()


def displaced(x, s):
    """Integral of [K0(|x - t|) + K0(x + t)] S(t) dt."""
    return displacing(x) @ s


def from_zero(x):
    """Integral of K0(|t|) from 0 to x."""
    return np.sign(x) * iti0k0(abs(x))[1]


def fill(content):
    parts = {
        nu: added(nu, np.ones(NODES.size)) for nu in sorted({c["nu"] for c in content["cases"]})
    }
    for case in content["cases"]:
        x = case["kx"]
        half = (np.pi / 2 + from_zero(x)) / np.pi
        quarter = 1 + displaced(x, parts[case["nu"]]) / np.pi
        case |= {"u_half": half, "u_quarter": quarter, "ratio": quarter / half}


if __name__ == "__main__":
    main(sys.modules[__name__])
