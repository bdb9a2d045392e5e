"""A straight roller with sharp ends on a flat race: finite_roller.json.

Half-spaces and quarter spaces. Lengths in b, pressures in p0, displacements of (1 - nu^2)/E = 1
for each body. Cells graded in x towards the ends, equal in y; the pressure of a cell is uniform and
the gap is met at its centre.
A half-space has u = (1/pi) integral of p/r. A free end adds the mirror image and, for each wave
number k along y (see quarter_space_wave.py; lengths in 1/k), what S = T (1 - T^2)^-1 T p displaces.
That is symmetric, hence K T = T' K for the half-space's kernel K and, from p to u,

    K T (1 - T^2)^-1 T = T' G T,   G = K (1 - T^2)^-1   (derived here; G is the same for all k).

The cosine integral over k is that of quarter_space_rectangle.py. Ends are superposed.
"""

import itertools
import sys

import numpy as np
from numpy.polynomial import chebyshev

from common import main
from quarter_space_wave import EDGES, NODES, WEIGHTS, displacing, kernels, operator

NAME, SECONDS = "finite_roller.json", 40
LENGTH, WIDTH = 20.0, 2.0  # the half width of the cells
AT = np.cos(np.pi * (np.arange(10) + 0.5) / 10)
LOWEST, PIECE, END = 1e-8, 2.5, 30.0  # of k; width of a piece in ln k; exponent that is neglected


def cells(count):
    """Edges of the cells of the whole length, count for each half, finest at the ends."""
    half = LENGTH / 2 * (np.arange(count + 1) / count) ** 2.5
    return np.concatenate([half, LENGTH - half[-2::-1]])


def green(poissons):
    """Weighted G at the nodes, for each nu."""
    k = np.stack([displacing(x) for x in NODES.ravel()])
    for nu in poissons:
        t = operator(nu)
        yield nu, WEIGHTS.ravel()[:, None] * np.linalg.solve((np.eye(len(t)) - t @ t).T, k.T).T


def loads(edges):
    """T of a unit pressure on each cell at the nodes: A and B."""
    x, w = np.polynomial.legendre.leggauss(6)
    top = np.exp(EDGES[-1])
    fine = np.concatenate([np.exp(EDGES[np.exp(EDGES) < edges[1]]), edges[1:]])
    owner = np.maximum(np.arange(len(fine) - 1) - (len(fine) - len(edges)), 0)
    low, high = np.minimum(fine[:-1], top), np.minimum(fine[1:], top)
    at = ((low + high) / 2)[:, None] + np.outer(high - low, x) / 2
    rule = np.outer(high - low, w) / 2
    for part in kernels(at.ravel()):
        pieces = (part * rule.ravel()).reshape(len(part), len(owner), -1).sum(2)
        yield np.stack([pieces[:, owner == j].sum(1) for j in range(len(edges) - 1)], axis=1)


def corrections(edges, step, count, poissons):
    """Return what S adds at the centres: {nu: [target, source, distance in y]}, from distance 0."""
    centres, y = (edges[1:] + edges[:-1]) / 2, step * np.arange(count)
    whole = dict(green(poissons))
    found = {nu: np.zeros((len(centres), len(centres), count)) for nu in poissons}
    pieces = np.arange(np.log(LOWEST), np.log(END / edges[1]) + PIECE, PIECE)
    x, w = np.polynomial.legendre.leggauss(20)
    for low, high in itertools.pairwise(pieces):
        values = {nu: [] for nu in poissons}
        for k in np.exp((low + high) / 2 + (high - low) / 2 * AT):
            first, second = loads(k * edges)
            there = kernels(np.minimum(k * centres, 600.0))
            for nu, g in whole.items():
                source, target = first + (1 - 2 * nu) * second, there[0] + (1 - 2 * nu) * there[1]
                values[nu].append(target.T @ (g @ source) / k)
        parts = 1 + int((np.exp(high) - np.exp(low)) * (y[-1] + step) / 4)
        ends = np.log(np.linspace(np.exp(low), np.exp(high), parts + 1))
        at = ((ends[1:] + ends[:-1]) / 2)[:, None] + np.diff(ends)[:, None] / 2 * x
        k, rule = np.exp(at).ravel(), (np.diff(ends)[:, None] / 2 * w).ravel()
        series = chebyshev.chebvander(((2 * at - low - high) / (high - low)).ravel(), len(AT) - 1)
        moments = (series.T * rule * np.sin(k * step / 2)) @ np.cos(np.outer(k, y))
        moments = np.linalg.solve(chebyshev.chebvander(AT, len(AT) - 1).T, moments)
        for nu, value in values.items():
            found[nu] += 4 / np.pi**2 * np.einsum("kij,ky->ijy", np.array(value), moments)
    return found


def half_space(places, edges, step, count):
    """Displacement at places (x, 0) under unit pressure on cells: [place, cell, distance in y]."""
    x, y = (edges[:, None] - places[:, None, None])[..., None], step * np.arange(count)
    x, y = x[..., 0], np.array([y - step / 2, y + step / 2])

    def corner(x, y):
        r = np.abs(x) + 0 * y, np.abs(y) + 0 * x
        return x * np.arcsinh(y / np.maximum(r[0], 1e-300)) + y * np.arcsinh(x / r[1])

    at = corner(x, y[1]) - corner(x, y[0])
    return np.diff(at, axis=1) / np.pi


def solve(influence, edges, step):
    """Pressure [x of half the length, y of half the width] and approach at the load."""
    n, m = (len(edges) - 1) // 2, influence.shape[-1] // 2
    both = influence[:n, :n] + influence[:n, : n - 1 : -1]
    near, far = np.abs(np.subtract.outer(range(m), range(m))), np.add.outer(range(m), range(m)) + 1
    matrix = (both[..., near] + both[..., far]).transpose(0, 2, 1, 3).reshape(n * m, n * m)
    y = step * (np.arange(m) + 0.5)
    gap, area = np.tile(2 * y**2, n), np.repeat(np.diff(edges)[:n] * step, m)
    touch = gap < 2
    while True:
        on = np.flatnonzero(touch)
        part = np.linalg.solve(matrix[np.ix_(on, on)], np.stack([gap[on], np.ones(len(on))], 1))
        approach = (LENGTH * np.pi / 8 + area[on] @ part[:, 0]) / (area[on] @ part[:, 1])
        p = np.zeros(n * m)
        p[on] = approach * part[:, 1] - part[:, 0]
        now = np.where(touch, p > 0, matrix @ p + gap < approach)
        if (now == touch).all():
            return p.reshape(n, m), approach
        touch = now


def grid(cases, n, m):
    """Pressures on the axis, loads per length and approach of each case, on n by m cells."""
    edges, step = cells(n), WIDTH / m
    centres = (edges[1:] + edges[:-1]) / 2
    plain = half_space(centres, edges, step, 2 * m)
    mirror = half_space(-centres, edges, step, 2 * m)
    added = corrections(edges, step, 2 * m, sorted({case["nu"] for case in cases}))
    for case in cases:
        nu, letter = case["nu"], case["case"].split()[1]
        psi = 1.29 - (0.08 - 0.5 * nu) / (1 - nu)
        end = {"A": 0 * mirror, "B": psi * mirror, "C": mirror + added[nu]}
        end["D"] = 2 * end["C"]
        p, approach = solve(2 * plain + end[letter] + end[letter][::-1, ::-1], edges, step)
        at, x = np.log(case["x_over_b"]), np.log(centres[:n])
        axis, line = (9 * p[:, 0] - p[:, 1]) / 8, p.sum(1) * step * 4 / np.pi
        axis, line = (np.exp(np.interp(at, x, np.log(value))) for value in (axis, line))
        yield {"approach": float(approach), "p_axis": axis.tolist(), "line_load": line.tolist()}


def fill(content):
    cases = content["cases"]
    for case, found in zip(cases, grid(cases, *content["cells"]), strict=True):
        case |= found


if __name__ == "__main__":
    main(sys.modules[__name__])
