"""Rigid, frictionless, axisymmetric tips on layered half-spaces: Fredholm's equation by Nystroem.

With A1 = (1 - nu1)/G1 of the top layer, M = alpha c11/A1 - 1, f = 2/(pi A1) and a tip r -> g(r),

    phi(s) + (2/pi) integral K(s, t) phi(t) dt = f [delta - F(s)],   0 < s < a
    K = integral M cos(alpha s) cos(alpha t) d alpha,   F(s) = s integral g'(r)/sqrt(s^2 - r^2) dr
    p^(alpha) = integral phi(t) cos(alpha t) dt,   P = 2 pi integral phi
    p(r) = phi(a)/sqrt(a^2 - r^2) - integral_r^a phi'(t)/sqrt(t^2 - r^2) dt
    u(r > a) = A1 integral phi/sqrt(r^2 - t^2) + A1 integral M p^ J0(alpha r) d alpha

(Sneddon, Int. J. Eng. Sci. 3 (1965) 47, doi:10.1016/0020-7225(65)90019-4, for M = 0; the layers
enter
through M). Without adhesion phi(a) = 0. Moduli, lengths and the contact radius may be complex: the
derivative with respect to x is the imaginary part at x + 1e-30 i, over 1e-30.
"""

import math

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import j0

from layered import excess

DEGREE, TAIL = 24, 21.0  # of M's Chebyshev pieces; alpha h beyond which M is below 1e-15


class Response:
    """M of a stack, by Chebyshev pieces, with an error of some 1e-15."""

    def __init__(self, stack):
        self.stack, (self.shear, self.nu) = stack, stack.top
        self.a1 = (1 - self.nu) / self.shear
        h = np.real(stack.layers[0][0]) if stack.layers else 1.0
        whole = sum(np.real(layer[0]) for layer in stack.layers) or 1.0
        self.end = TAIL / h
        low = 0.5 / whole * 2.0 ** np.arange(-40, math.ceil(math.log2(whole / h)) + 1)
        low = low[low < 0.5 / h]
        self.breaks = np.concatenate([[0.0], low, np.arange(0.5, TAIL + 0.25, 0.5) / h])
        x = np.cos(np.pi * (np.arange(DEGREE) + 0.5) / DEGREE)
        middle, half = (self.breaks[1:] + self.breaks[:-1]) / 2, np.diff(self.breaks) / 2
        nodes = middle[:, None] + half[:, None] * x
        values = excess(stack, nodes.ravel()).reshape(nodes.shape)
        basis = np.cos(np.outer(np.arange(DEGREE), np.arccos(x))) * 2 / DEGREE
        basis[0] /= 2
        self.series = values @ basis.T

    def __call__(self, alpha):
        k = np.clip(np.searchsorted(self.breaks, alpha) - 1, 0, len(self.breaks) - 2)
        low, high = self.breaks[k], self.breaks[k + 1]
        x = (2 * alpha - low - high) / (high - low)
        before, now = 0.0, 0.0
        for j in range(DEGREE - 1, 0, -1):
            before, now = now, self.series[k, j] + 2 * x * now - before
        return self.series[k, 0] + x * now - before

    def nodes(self, reach, order=10):
        """Nodes, weights and M for integrals of M times functions that vary over 1/reach."""
        width = min(
            self.breaks[self.breaks > 0.4999 / sum(np.real(v[0]) for v in self.stack.layers)][0],
            1.5 / reach,
        )
        geometric = width * 2.0 ** np.arange(-30, 0)
        count = math.ceil(self.end / width)
        edges = np.concatenate([[0.0], geometric, np.linspace(width, self.end, count)])
        x, w = np.polynomial.legendre.leggauss(order)
        middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
        alpha = (middle[:, None] + half[:, None] * x).ravel()
        return alpha, (half[:, None] * w).ravel(), self(alpha)


def lowest(function, bounds, tolerance):
    """Minimum of a function between bounds: SciPy's result."""
    return minimize_scalar(function, bounds=bounds, method="bounded", options={"xatol": tolerance})


def tip(case):
    """F and F' of a tip of a reference file, kind and R (and n)."""
    kind, radius, n = case["kind"], case["R"], case.get("n", 2.0)
    if kind == "flat":
        return (lambda s: 0 * s), (lambda s: 0 * s)
    if kind == "paraboloid":
        return (lambda s: s**2 / radius), (lambda s: 2 * s / radius)
    if kind == "sphere":
        x = lambda s: s / radius  # noqa: E731
        return (lambda s: s * np.arctanh(x(s))), (
            lambda s: np.arctanh(x(s)) + x(s) / (1 - x(s) ** 2)
        )
    n = 1.0 if kind == "cone" else n
    factor = radius * n * math.sqrt(math.pi) / 2 * math.gamma(n / 2) / math.gamma((n + 1) / 2)
    return (lambda s: factor * s**n), (lambda s: factor * n * s ** (n - 1))


class Contact:
    """Tip on a contact of radius a: S = dP/d delta, and the loads without adhesion."""

    def __init__(self, response, a, shape, reach=None):
        self.response, self.a, (self.F, self.dF) = response, a, shape
        size, thin = np.real(a), np.real(response.stack.layers[0][0])
        n = 16 + math.ceil(6 * size / thin)
        self.f = 2 / (np.pi * response.a1)
        x, w = np.polynomial.legendre.leggauss(n)
        self.t, self.w = a * (x + 1) / 2, a * w / 2
        self.alpha, self.weights, self.m = response.nodes(max(size, reach or 0))
        self.cosines = np.cos(self.alpha[:, None] * self.t)
        kernel = (self.cosines.T * (self.weights * self.m)) @ self.cosines
        matrix = np.eye(n) + 2 / np.pi * kernel * self.w
        right = np.column_stack([self.f + 0 * self.t, self.f * self.F(self.t)])
        self.punch, self.shape = np.linalg.solve(matrix, right).T
        self.S, self.PF = 2 * np.pi * self.w @ self.punch, 2 * np.pi * self.w @ self.shape
        self.edge, self.edge_shape = (
            self.at(phi, one) for phi, one in ((self.punch, 1), (self.shape, self.F(a)))
        )
        self.delta = self.edge_shape / self.edge
        self.P = self.S * self.delta - self.PF
        self.dS = np.pi**2 * self.edge**2 * response.a1  # 2 pi^2 phi1(a)^2/E1*, E1* = 2/A1

    def at(self, phi, right):
        """phi(a) of a density with the right side f * right."""
        cosine = np.cos(self.alpha * self.a)
        return self.f * right - 2 / np.pi * (cosine * self.weights * self.m) @ self.transform(phi)

    def transform(self, phi):
        return self.cosines @ (self.w * phi)

    def density(self, delta=None):
        return (self.delta if delta is None else delta) * self.punch - self.shape

    def pressure(self, r, delta=None, n=96):
        """p(r) for r < a; on the axis of a smooth tip, too."""
        moved = self.delta if delta is None else delta
        phi = self.density(delta)
        x, w = np.polynomial.legendre.leggauss(max(n, len(self.t)))
        v, w = (x + 1) / 2, w / 2
        t = np.sqrt(r**2 + (self.a**2 - r**2) * v**2)
        sines = np.sin(t[:, None] * self.alpha) @ (
            self.weights * self.m * self.alpha * self.transform(phi)
        )
        slope = -self.f * self.dF(t) + 2 / np.pi * sines
        root = np.sqrt(self.a**2 - r**2)
        return (moved * self.edge - self.edge_shape) / root - root * w @ (slope / t)

    def outside(self, r, phi):
        """u(r) for r > a; the Contact must have been made with reach >= r."""
        near = (self.w * phi / np.sqrt(r**2 - self.t**2)).sum()
        return self.response.a1 * (
            near + (self.weights * self.m * j0(self.alpha * r)) @ self.transform(phi)
        )
