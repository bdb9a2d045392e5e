"""Kalker's coefficients of two identical coated bodies on a circle: friction/kalker_coated.json.

Steady rolling towards +x without slip [J. J. Kalker, On the Rolling Contact of Two Elastic Bodies
in the Presence of Dry Friction (1967); Three-Dimensional Elastic Bodies in Rolling Contact (1990)].
With u the displacement of one body against the other, the creepages xi, eta and the spin phi,

    0 = W + du/dx,  W = (xi - phi y, eta + phi x);  u is continuous at the leading edge
    F_x = a b G C11 xi,  F_y = a b G (C22 eta + (a b)^(1/2) C23 phi)

Uniform tractions on square cells whose centres lie in the circle; du/dx is the difference over one
cell, from the centre forwards, and x in W is the middle of that (Kalker 1990). As the bodies are
identical, pressure and tractions do not affect each other, and u is twice that of one body.

A cell displaces by Cerruti's formula for the material of the coat, integrated over the cell in
closed form, and by what the substrate adds, integrated by Gauss points (derived here; t is the
angle of the vector from the load to the point):

    u_x = (k0 - k2 cos 2t) q_x - k2 sin 2t q_y,   u_y = -k2 sin 2t q_x + (k0 + k2 cos 2t) q_y
    k0, k2 = 1/(4 pi) integral of (c22 + ct) J0(alpha r), (c22 - ct) J2(alpha r) alpha d alpha

Lengths are in radii of the circle whose area is that of the cells, and E2 = 1.
"""

import itertools
import sys

import numpy as np
from scipy.fft import fft2, fftfreq, ifft2
from scipy.interpolate import make_interp_spline
from scipy.sparse.linalg import LinearOperator, gmres
from scipy.special import j0, j1

from common import main
from layered import Body, coat
from patch import Added

NAME, SECONDS = "friction/kalker_coated.json", 120
GRIDS = (64, 128, 256)  # cells to a diameter
NU, LEAST, GAUSS = 0.3, 1.5e-4, 4  # LEAST: smallest relative uncertainty; GAUSS: points of an edge
REACH = 3.0  # more than the diagonal of the square about the circle


def tables(added, thin):
    """Splines of k0 and k2 in the distance."""
    r, k = np.linspace(0, REACH, int(25 * REACH / thin)), []
    s, d = ((added.c22 + sign * added.ct) * added.weights / (4 * np.pi) for sign in (1, -1))
    for part in np.array_split(r, 1 + len(r) // 50):
        z = np.maximum(np.outer(part, added.alpha), 1e-12)
        zeroth = j0(z)
        k.append([zeroth @ s, (2 * j1(z) / z - zeroth) @ d])
    return make_interp_spline(r, np.concatenate(k, axis=1), 5, axis=1)


def cerruti(shear, nu, x, y):
    """Displacements xx, xy, yy of the bare half-space under a cell; x, y: edges from the point."""
    x, y = x[:, None], y[None, :]
    along, across = y * np.arcsinh(x / abs(y)), x * np.arcsinh(y / abs(x))
    love = (1 - nu) * (along + across)
    corners = np.array([love + nu * along, -nu * np.hypot(x, y), love + nu * across])
    return np.diff(np.diff(corners, axis=1), axis=2) / (2 * np.pi * shear)


def influence(stack, splines, step, n):
    """Displacements xx, xy, yy of one body at 0 ... n cells from the loaded one, in x and y."""
    edges, at = step * (np.arange(n + 2) - 0.5), step * np.arange(n + 1)
    found = cerruti(*stack.top, edges, edges)
    points, weights = np.polynomial.legendre.leggauss(GAUSS)
    for i, j in itertools.product(range(GAUSS if splines else 0), repeat=2):
        x, y = np.meshgrid(at + points[i] * step / 2, at + points[j] * step / 2, indexing="ij")
        r2 = x**2 + y**2  # not 0, as GAUSS is even
        k0, k2 = splines(np.sqrt(r2))
        cosine, sine = (x**2 - y**2) / r2, 2 * x * y / r2
        added = np.array([k0 - k2 * cosine, -k2 * sine, k0 + k2 * cosine])
        found += weights[i] * weights[j] * step**2 / 4 * added
    return found


def forces(stack, n, added=None, splines=None):
    """F_x under xi = 1, F_y under eta = 1 and under phi = 1."""
    centre = np.arange(n) + 0.5 - n / 2
    inside = np.add.outer(centre**2, centre**2) < (n / 2) ** 2
    step = np.sqrt(np.pi / inside.sum())
    # q -> -du/dx is a convolution; on twice the grid it does not wrap.
    turn = np.r_[: n + 1, 1 - n : 0]
    whole = 2 * influence(stack, splines, step, n)[:, abs(turn)[:, None], abs(turn)]
    whole[1] *= np.outer(np.sign(turn), np.sign(turn))
    xx, xy, yy = fft2((whole - np.roll(whole, -1, axis=1)) / step)
    # The preconditioner sums from the leading edge, then divides by the response to each wave.
    wave = 2 * np.pi * fftfreq(n, step)
    wave[0] = np.pi / (2 * n * step)  # any small one for 0
    alpha = np.hypot(wave[:, None], wave)
    m, k = wave[:, None] / alpha, wave / alpha
    c22, ct = (1 - stack.top[1]) / stack.top[0], 1 / stack.top[0]
    if added:
        c22 = c22 + np.interp(alpha, added.alpha, added.c22)
        ct = ct + np.interp(alpha, added.alpha, added.ct)

    def spread(q):
        found = np.zeros((2, n, n))
        found[:, inside] = q.reshape(2, -1)
        return found

    def gather(x, y):  # real fields from their transforms, by one transform back
        found = ifft2(x + 1j * y)[:n, :n][inside]
        return np.concatenate([found.real, found.imag])

    def product(q):
        x, y = fft2(spread(q), (2 * n, 2 * n))
        return gather(xx * x + xy * y, xy * x + yy * y)

    def inverse(w):
        x, y = fft2(np.cumsum(spread(w)[:, ::-1], axis=1)[:, ::-1])
        along, across = alpha / c22 * (m * x + k * y), alpha / ct * (m * y - k * x)
        return gather(m * along - k * across, k * along + m * across)

    size, found = 2 * inside.sum(), []
    b, about = (LinearOperator((size, size), f, dtype=float) for f in (product, inverse))
    x, y = (v[inside] * step for v in np.meshgrid(centre, centre, indexing="ij"))
    zero, one = np.zeros(len(x)), np.ones(len(x))
    for right, axis in (((one, zero), 0), ((zero, one), 1), ((-y, x + step / 2), 1)):
        q, failed = gmres(b, np.concatenate(right), rtol=1e-9, restart=200, maxiter=5, M=about)
        assert not failed
        found.append(step**2 * q.reshape(2, -1)[axis].sum())
    return np.array(found)


def store(case, values, digits):
    """Extrapolate linearly in 1/n; return the values of the finest grids and the last change."""
    before, last = (2 * fine - coarse for coarse, fine in itertools.pairwise(values))
    case |= zip(("C11", "C22", "C23"), (round(float(v), digits) for v in last), strict=True)
    return last, abs(last - before)


def fill(content):
    for case in content["bare_circle"]:
        bare = Body([], (1.0, case["nu"]))
        store(case, [forces(bare, n) for n in GRIDS], 4)
    shear = 0.5 / (1 + NU)
    plain = [forces(Body([], (shear, NU)), n) for n in GRIDS]
    for case in content["cases"]:
        stack = coat(case["E1_over_E2"], case["h_over_a"], NU)
        added = Added(stack, REACH)
        parts = added, tables(added, case["h_over_a"])
        found = [forces(stack, n, *parts) / bare for n, bare in zip(GRIDS, plain, strict=True)]
        last, change = store(case, found, 5)
        case["uncertainty"] = [round(float(e), 5) for e in np.maximum(2 * change, LEAST * last)]


if __name__ == "__main__":
    main(sys.modules[__name__])
