"""Line contact on layered half-spaces in plane strain, by Chebyshev's polynomials.

A pressure on |x| < b, xi = x/b, p = sum a_k sqrt(1 - xi^2) U_2k(xi), has the cosine transform
p^(m) = pi sum (-1)^k (2k+1) a_k J_{2k+1}(m b)/m, and a rigid cylinder x^2/2R gives (derived here)

    a_j + sum_k 2 (-1)^{j+k} (2k+1) a_k integral M J_{2j+1}(mb) J_{2k+1}(mb) dm/m = delta_j0 b/(A1
    R)
"""

import numpy as np


def bessel(count, z):
    """J_1, J_3 ... of z, by the midpoint rule of Bessel's integral: exponential convergence."""
    n = int((np.max(z) + 2 * count) / 4 * 1.15) + 20
    angle = (np.arange(n) + 0.5) * np.pi / (2 * n)
    odd = np.sin(np.outer(2 * np.arange(count) + 1, angle)) / n
    return np.concatenate(
        [odd @ np.sin(np.outer(np.sin(angle), part)) for part in np.array_split(z, 20)], axis=1
    )


class Line:
    """Contact of half-width b with a rigid cylinder of radius 1."""

    def __init__(self, response, b, terms=None):
        self.b, self.response = b, response
        thin = response.stack.layers[0][0]
        n = terms or 14 + int(3 * b / thin)
        self.alpha, weights, self.m = response.nodes(2 * b)
        self.weights = weights
        k = np.arange(n)
        waves = bessel(n, self.alpha * b)
        matrix = (waves * (weights * self.m / self.alpha)) @ waves.T
        signs = (-1.0) ** k
        matrix = np.eye(n) + 2 * signs[:, None] * signs * (2 * k + 1) * matrix
        right = np.zeros(n)
        right[0] = b / response.a1
        self.a = np.linalg.solve(matrix, right)
        self.P = np.pi * b * self.a[0] / 2

    def pressure(self, xi):
        angle = np.arccos(np.asarray(xi, float))
        k = np.arange(len(self.a))
        return (self.a * np.sin(np.multiply.outer(angle, 2 * k + 1))).sum(-1)

    def transform(self, m):
        k = np.arange(len(self.a))
        return np.pi * (-1.0) ** k * (2 * k + 1) * self.a @ bessel(len(k), m * self.b) / m
