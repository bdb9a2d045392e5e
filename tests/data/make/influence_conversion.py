"""Errors of influence coefficients converted by inverse FFT: influence_conversion.json.

Cells of side 1, offsets -64 to 63. The exact coefficients are Love's integral for the coating and
the cell's integral of k_M(r), the Hankel transform of M = alpha c11/A1 - 1, smooth within a cell
for coatings of two cells and more. The conversions take c11 less the coating's A1/alpha
('difference'), or also less an image A1 M(0) exp(-2 h alpha)/alpha of known integral, on the wave
numbers of a domain `refinement` times as wide; the sample at 0 is the limit of the rest, with the
cell mean of what is left of 1/alpha.
"""

import itertools
import sys

import numpy as np
from scipy.special import j0

from axisym import Response
from common import main
from layered import coat

NAME, SECONDS, SIDE = "influence_conversion.json", 15, 128


def at_corners(corner):
    """Integral over the cells at all offsets i, j >= 0 from that over (0, x) x (0, y)."""
    edge = np.arange(SIDE // 2 + 2) - 0.5
    whole = corner(*np.meshgrid(edge, edge, indexing="ij"))
    return whole[1:, 1:] - whole[:-1, 1:] - whole[1:, :-1] + whole[:-1, :-1]


def image(depth):
    """Integral of 1/sqrt(r^2 + depth^2) over each cell."""

    def corner(x, y):
        r = np.sqrt(x**2 + y**2 + depth**2)
        part = x * np.arcsinh(y / np.hypot(x, depth)) + y * np.arcsinh(x / np.hypot(y, depth))
        return part - (depth * np.arctan(x * y / (depth * r)) if depth else 0)

    return at_corners(corner)


def exact(response, h):
    """Coefficients over A1 at the offsets 0 to 64."""
    far = SIDE / 2 * 1.5
    pieces = np.concatenate([np.linspace(0, 2 * h, 9), np.geomspace(2 * h, far, 20)[1:]])
    alpha, weights, m = response.nodes(far)
    x = np.cos(np.pi * (np.arange(16) + 0.5) / 16)
    gauss, rule = np.polynomial.legendre.leggauss(5)
    offset = np.arange(SIDE // 2 + 1)
    at = offset[:, None] + gauss / 2  # [offset, point]
    r = np.hypot(at[:, :, None, None], at)
    k = np.empty_like(r)
    for low, high in itertools.pairwise(pieces):
        inside = (r >= low) & (r < high)
        places = (low + high) / 2 + (high - low) / 2 * x
        values = j0(np.outer(places, alpha)) @ (weights * m)
        series = np.polynomial.chebyshev.chebfit(x, values, 15)
        k[inside] = np.polynomial.chebyshev.chebval(
            (2 * r[inside] - low - high) / (high - low), series
        )
    added = np.einsum("iajb,a,b->ij", k, rule / 2, rule / 2)
    return (image(0.0)[: SIDE // 2 + 1, : SIDE // 2 + 1] + added) / (2 * np.pi)


def converted(response, h, method, refinement, limits):
    """Coefficients over A1 at the offsets 0 to 64, by inverse FFT."""
    m0, c0 = limits
    n, step = SIDE * refinement, 2 * np.pi / (SIDE * refinement)
    wave = 2 * np.pi * np.fft.fftfreq(n)
    half = wave[: n // 2 + 1]
    alpha = np.hypot(wave[:, None], half)
    alpha[0, 0] = 1.0
    size = np.unique(alpha, return_inverse=True)
    rest = (response(size[0]) * (size[0] <= response.end))[size[1]].reshape(alpha.shape) / alpha
    rest[0, 0] = m0 * 4 * np.log(1 + np.sqrt(2)) / step + c0
    known = image(0.0)
    if method == "image":
        rest = rest - m0 * np.exp(-2 * h * alpha) / alpha
        rest[0, 0] = c0 + m0 * 2 * h
        known = known + m0 * image(2 * h)
    cell = np.sinc(wave / (2 * np.pi))[:, None] * np.sinc(half / (2 * np.pi))
    found = np.fft.irfft2(rest * cell, s=(n, n))
    count = SIDE // 2 + 1
    return found[:count, :count] + known[:count, :count] / (2 * np.pi)


def fill(content):
    for case in content["cases"]:
        ratio, h = case["modulus_ratio"], case["h_over_dx"]
        stack = coat(ratio, h, 0.3)
        response, g = Response(stack), 0.4 * ratio
        # Limits of alpha c11/A1 and of c11 - A/alpha, over A1, for alpha -> 0.
        limits = (ratio - 1, h * (1 + g) * (0.4 - g) / (2 * 0.7**2))
        truth = exact(response, h)
        for row in case["rows"]:
            found = converted(response, h, row["method"], row["refinement"], limits)
            error = found / truth - 1
            row |= {"loaded_cell": error[0, 0], "largest": np.abs(error).max()}


if __name__ == "__main__":
    main(sys.modules[__name__])
