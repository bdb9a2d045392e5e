"""Uniform pressure on a rectangle near the end of a quarter space: quarter_space_rectangle.json.

For each wave number k along y, the equation of quarter_space_wave.py gives the part S that the
end face adds to the pressure, lengths in units of 1/k; u = Love + its mirror + a cosine integral

    (4/pi^2) integral sin(k w)/k cos(k y) D(k)/k dk,   D = integral [K0(|kx - t|) + K0(kx + t)] S dt

D/k is interpolated in ln k. At x = d = 0, D tends to (c - 2) pi/2, c that of the wave at the end,
and the same multiple of the half-space's is taken out of D and added in closed form.
"""

import itertools
import sys

import numpy as np
from numpy.polynomial import chebyshev
from scipy.linalg import lu_factor, lu_solve

from common import main
from patch import love
from quarter_space_wave import EDGES, NODES, ORDER, WEIGHTS, displaced, from_zero, kernels

NAME, SECONDS = "quarter_space_rectangle.json", 400
AT = np.cos(np.pi * (np.arange(12) + 0.5) / 12)
LOWEST, PIECE, END = 1e-10, 2.5, 34.0  # of k; width of a piece in ln k; exponent that is neglected


def integral(low, high):
    """Integral of A and of B over low < x < high, at the nodes."""
    count = max(1, int(np.ceil(np.log(high / low) / np.log(1.8))))
    edges = np.linspace(np.log(low), np.log(high), count + 1)
    x, w = np.polynomial.legendre.leggauss(ORDER)
    half = np.diff(edges)[:, None] / 2
    nodes = np.exp((edges[1:] + edges[:-1])[:, None] / 2 + half * x).ravel()
    weights = (half * w).ravel() * nodes
    return [part @ weights for part in kernels(nodes)]


def spectra(d, length, places, poissons):
    """D/k in pieces of ln k: {(nu, x): [(low, high, Chebyshev series)]}, and c of each nu."""
    first, second = (part * WEIGHTS.ravel() for part in kernels(NODES.ravel()))
    whole = {nu: first + (1 - 2 * nu) * second for nu in poissons}
    factor = {nu: lu_factor(np.eye(len(t)) - t @ t) for nu, t in whole.items()}
    ends = {
        nu: 2 + 2 * displaced(0, lu_solve(factor[nu], t @ t.sum(1))) / np.pi
        for nu, t in whole.items()
    }
    reach = min(x + d if x + d > 0 else length for x in places)
    pieces = np.arange(np.log(LOWEST), np.log(END / reach) + PIECE, PIECE)
    found = {(nu, x): [] for nu in poissons for x in places}
    for low, high in itertools.pairwise(pieces):
        values = {key: [] for key in found}
        for k in np.exp((low + high) / 2 + (high - low) / 2 * AT):
            if k * (d if d > 0 else length) > np.exp(EDGES[-1]):
                parts = [first.sum(1), second.sum(1)] if d == 0 else [0 * first[0], 0 * first[0]]
            elif d > 0:
                parts = integral(k * d, min(k * (d + length), np.exp(EDGES[-1])))
            else:  # all less what is beyond the load
                beyond = integral(k * length, np.exp(EDGES[-1]))
                parts = [t.sum(1) - b for t, b in zip((first, second), beyond, strict=True)]
            for nu, t in whole.items():
                s = lu_solve(factor[nu], t @ (parts[0] + (1 - 2 * nu) * parts[1]))
                for x in places:
                    less = (ends[nu] - 2) * from_zero(k * length) if x == d == 0 else 0.0
                    values[nu, x].append((displaced(k * x, s) - less) / k if k * x < 45 else 0.0)
        for key, value in values.items():
            found[key].append((low, high, chebyshev.chebfit(AT, value, len(AT) - 1)))
    return found, ends


def cosine(pieces, width, y):
    """Cosine integral of a piecewise D/k."""
    total, (x, w) = 0.0, np.polynomial.legendre.leggauss(20)
    for low, high, series in pieces:
        count = 1 + int((np.exp(high) - np.exp(low)) * (width + y) / 4)
        edges = np.log(np.linspace(np.exp(low), np.exp(high), count + 1))
        at = (edges[1:] + edges[:-1])[:, None] / 2 + np.diff(edges)[:, None] / 2 * x
        k, rule = np.exp(at), np.diff(edges)[:, None] / 2 * w
        value = chebyshev.chebval((2 * at - low - high) / (high - low), series)
        total += (rule * np.sin(k * width) * np.cos(k * y) * value).sum()
    return 4 / np.pi**2 * total


def fill(content):
    groups = {}
    for case in content["cases"]:
        groups.setdefault((case["d"], case["length"]), []).append(case)
    for (d, length), cases in groups.items():
        poissons = [float(nu) for nu in cases[0]["u_quarter"]]
        found, ends = spectra(d, length, sorted({case["x"] for case in cases}), poissons)
        for case in cases:
            x, y, w = case["x"], case["y"], case["half_width"]
            half = love(x - d - length / 2, y, length / 2, w) / np.pi
            mirror = love(x + d + length / 2, y, length / 2, w) / np.pi
            case |= {"u_half": half, "u_mirror": mirror}
            for name in case["u_quarter"]:
                nu = float(name)
                end = (ends[nu] - 2) * half if x == d == 0 else 0.0
                case["u_quarter"][name] = half + mirror + end + cosine(found[nu, x], w, y)
                case["ratio"][name] = case["u_quarter"][name] / half


if __name__ == "__main__":
    main(sys.modules[__name__])
