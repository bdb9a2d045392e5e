"""Table ``src/ends/plate.txt``: what a plate with two free ends adds to two quarter spaces.

Problem.  A body 0 <= x <= 1, z >= 0 (lengths in units of its length L) with free faces x = 0 and
x = 1 carries the pressure p(x) cos(ky) on z = 0.  With w = u_z pi G/(1 - nu), a half-space has
w = integral K0(k|x - x'|) p(x') dx'.  Let D(x, x') be the kernel of w for the body, less the sum of
the kernels of its two quarter spaces, in which that of the half-space is counted once.  Wanted is

    D_ab = integral integral phi_a(x) D(x, x') phi_b(x') dx dx',   phi_a = sqrt(2a + 1) P_a(2x - 1)

Equations.  The stress in the body is the sum of the stresses in two bodies:

    A  a half-space under the pressure P, continued evenly about x = 0 and x = 1 (period 2).  Both
       faces have neither shear nor u_x, but the normal stress Q = T_A P.
    B  a plate, infinite along z, under the pressure Q(|z|) on both faces, which makes them free.
       The plane z = 0 has neither shear nor u_z, but the normal stress T_B Q = P - p.

Hence (1 - T_A T_B) Q = T_A p and w = K_A P, where K_A is K0 summed over the images of the source.
P is even or odd about x = 1/2 (parity s = 1 or -1), so that 0 < x < 1/2 suffices.  With

    f(t, zeta) = -[(zeta/alpha)^2 (1 - alpha t) + 2 nu (k/alpha)^2] exp(-alpha t)
    T(z, x) = (2/pi) integral f(z, zeta) cos(zeta x) d zeta           alpha^2 = k^2 + zeta^2
            = -(2/pi) {k z x^2/R^2 [2 K1(kR)/R + k K0(kR)]            R^2 = x^2 + z^2
              - (1 - 2 nu) k^2 integral K0(k sqrt(x^2 + t^2)) dt over t > z},

the stress on the face from a line load at x and its mirror image, and c = alpha/2,
q = alpha (1/2 - x), the kernels are

    T_A(z, x) = sum of s^m [T(z, m + x) + s T(z, m + 1 - x)] over m >= 0, or a cosine series of f
    T_B(x, z) = (2/pi) integral g(x, zeta) cos(zeta z) d zeta
    g = -{(zeta/alpha)^2 [(sinh c - c cosh c) cosh q + q sinh c sinh q]
          + 2 nu (k/alpha)^2 sinh c cosh q} / (sinh c cosh c + s c)

for s = 1; for s = -1, sinh and cosh change places.  For T_B, g - f(x) - s f(1 - x) is integrated,
which is smooth and decays as exp(-zeta), and T(x, z) + s T(1 - x, z) added.  For one free end T_A
and T_B are T: P - p = T (1 - T^2)^-1 T p, one equation for all k with lengths in units of 1/k.

Discretisation.  Nystrom's method with the trapezoidal rule in ln(x/(1 - x)) and in ln z, which
converges exponentially; K0 phi_a is integrated by the double-exponential rule.

Accuracy.  At the places CHECKED, which are no nodes, the table differs from the mesh REFINED by at
most 2e-5 of pi (1 + 0.6 nu)/k, about the displacement under unit pressure; where a or b is above 1,
by at most 5e-6.

Needs numpy, scipy.  Run: python tests/data/make/plate.py (three minutes on one core).  With the
argument "check", it prints D_ab at the places CHECKED, as in src/ends/plate.rs, instead.
"""

import sys
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.legendre import leggauss, legvander
from scipy.special import expit, k0, k1

COUNT = 8  # polynomials phi
LENGTHS, POISSONS = 20, 6  # Chebyshev nodes in ln k and nu
RANGE = (0.1, 15.0)  # of k
FAR = 42.0  # k times a distance at which K0 has vanished
DEEPEST = 40.0  # k times the depth of the deepest node
SERIES = 0.4  # depth from which on T_A is a cosine series
PERIOD = 70.0  # of the trapezoidal sum over zeta, along k z
CHECKED = ((0.15, 0.3), (0.6, 0.05), (1.7, 0.28), (3.3, 0.45), (6.0, 0.3), (11.0, 0.5))
PATH = Path(__file__).parents[3] / "src" / "compliance" / "ends" / "plate.txt"
HEADER = """\
# Chebyshev coefficients c[p][q] of kL exp(kL/2) D_ab, the difference of a plate with two free ends
# from two quarter spaces: sum of c T_p(4 nu - 1) T_q(2 ln(kL/0.1)/ln 150 - 1) for
# 0.1 <= kL <= 15, 0 <= nu <= 1/2. For each pair a b a block: a line with a and b, then six lines p
# of twenty coefficients q. Made by tests/data/make/plate.py.
"""


class Mesh(NamedTuple):
    """Step of the trapezoidal rules, and where they begin."""

    step: float
    lowest: float


TABULATED = Mesh(0.3, 1e-8)
REFINED = Mesh(0.25, 1e-9)


def half_length(mesh):
    """Nodes and weights on 0 < x <= 1/2; the last node is shared with the other half."""
    t = -mesh.step * np.arange(np.ceil(-np.log(mesh.lowest) / mesh.step), -1, -1)
    x = expit(t)
    weights = mesh.step * x * (1 - x)
    weights[-1] /= 2
    return x, weights


def half_line(mesh, low, high):
    """Nodes and weights on low < z < high."""
    z = high * np.exp(mesh.step * np.arange(-np.ceil(np.log(high / low) / mesh.step), 1))
    return z, mesh.step * z


def polynomials(x):
    """phi_a(x): (points, a)."""
    return legvander(2 * x - 1, COUNT - 1) * np.sqrt(2 * np.arange(COUNT) + 1)


def interpolation(count):
    """Chebyshev nodes, and the matrix from values at them to coefficients."""
    nodes = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return nodes, np.linalg.inv(chebvander(nodes, count - 1))


GAUSS = (1 + leggauss(24)[0]) / 2  # nodes on 0 < x < 1, and the weighted phi at them
AT_GAUSS = leggauss(24)[1][:, None] / 2 * polynomials(GAUSS)


def remaining_integral(z, x):
    """Integral of K0(sqrt(x^2 + t^2)) over t > z: (z, x), summed from the deepest z upwards."""
    nodes, weights = leggauss(12)
    result, total = np.empty((len(z), len(x))), np.zeros(len(x))
    high = max(60.0, 1.0001 * z.max())
    for index in np.argsort(-z):
        low = z[index]
        pieces = np.ceil(max(1, np.log(high / low) / 1.2, min(high - low, 60) / 6))
        cuts = np.linspace(np.log(low), np.log(high), int(pieces) + 1)
        for start, end in pairwise(cuts):
            t = np.exp((start + end) / 2 + (end - start) / 2 * nodes)
            total = total + (end - start) / 2 * weights * t @ k0(np.hypot(x, t[:, None]))
        result[index], high = total, low
    return result


def traction(z, x, k, poisson):
    """T(z, x): (z, x)."""
    depth, along = k * z[:, None], k * x[None, :]
    radius = np.hypot(depth, along)
    direct = depth * (along / radius) ** 2 * (2 * k1(radius) / radius + k0(radius))
    lateral = (1 - 2 * poisson) * remaining_integral(k * z, k * x)
    return -2 / np.pi * k * (direct - lateral)


def end_transform(t, zeta, k, poisson):
    """f(t, zeta): (zeta, t)."""
    alpha = np.hypot(k, zeta)[:, None]
    ratio = (zeta[:, None] / alpha) ** 2
    return -(ratio * (1 - alpha * t) + 2 * poisson * (1 - ratio)) * np.exp(-alpha * t)


def plate_transform(x, zeta, k, poisson, parity):
    """g(x, zeta): (zeta, x)."""
    alpha = np.hypot(k, zeta)[:, None]
    ratio, c, q = (zeta[:, None] / alpha) ** 2, alpha / 2, alpha * (0.5 - x)
    # Hyperbolic functions divided by exp(c).
    near, far = np.exp(q - c), np.exp(-q - c)
    small = np.exp(-2 * c)
    cosh_c, sinh_c, cosh_q, sinh_q = (1 + small) / 2, (1 - small) / 2, near + far, near - far
    below = 2 * (sinh_c * cosh_c + parity * c * small)
    if parity < 0:
        cosh_c, sinh_c, cosh_q, sinh_q = sinh_c, cosh_c, sinh_q, cosh_q
        d = 4 * c**2  # the denominator cancels: a series
        series = 4 * c**3 / 3 * (1 + d / 20 * (1 + d / 42 * (1 + d / 72))) * small
        below = np.where(c < 0.15, series, below)
    above = ratio * ((sinh_c - c * cosh_c) * cosh_q + q * sinh_c * sinh_q)
    return -(above + 2 * poisson * (1 - ratio) * sinh_c * cosh_q) / below


def face_stress(z, x, k, poisson, parity):
    """T_A(z, x): (z, x)."""
    result = np.empty((len(z), len(x)))
    deep = z >= SERIES
    n = np.arange(0 if parity > 0 else 1, 45 / (np.pi * SERIES), 2)
    terms = np.where(n > 0, 4.0, 2.0) * np.cos(np.pi * n * x[:, None])
    result[deep] = end_transform(z[deep], np.pi * n, k, poisson).T @ terms.T

    def from_images(x, first, last):
        return sum(
            parity**m * traction(z[~deep], m + x, k, poisson)
            + parity ** (m + 1) * traction(z[~deep], m + 1 - x, k, poisson)
            for m in range(first, last)
        )

    result[~deep] = from_images(x, 0, 2)
    # Far images are polynomials of x: Chebyshev points on 0 < x < 1/2.
    nodes, inverse = interpolation(12)
    to_x = chebvander(4 * x - 1, 11) @ inverse
    result[~deep] += from_images((1 + nodes) / 4, 2, int(FAR / k) + 2) @ to_x.T
    return result


def surface_stress(x, z, k, poisson, parity):
    """T_B(x, z): (x, z)."""
    both = traction(np.concatenate([x, 1 - x]), z, k, poisson)
    step = 2 * np.pi * k / PERIOD
    zeta = step * np.arange(np.ceil(35 / step) + 1)
    zeta[0] = 1e-9 * k
    weights = step * np.where(np.arange(len(zeta)) > 0, 1.0, 0.5)
    smooth = plate_transform(x, zeta, k, poisson, parity) - end_transform(x, zeta, k, poisson)
    smooth -= parity * end_transform(1 - x, zeta, k, poisson)
    integral = (smooth * weights[:, None]).T @ np.cos(zeta[:, None] * z)
    return both[: len(x)] + parity * both[len(x) :] + 2 / np.pi * integral


def far_displacement(x, source, k):
    """Sum of K0 over all images of the source but itself and that at -x: (x, source)."""
    a, b = x[:, None], source
    return sum(
        k0(k * (2 * m + offset))
        for m in range(1, int(FAR / k) + 2)
        for offset in (a - b, b - a, a + b, -a - b)
    )


def displacement(x, k):
    """Integral of [K0(k|x - x'|) + K0(k(x + x'))] phi_a(x') over 0 < x' < 1: (x, a), x > 1 too."""
    t, step = np.linspace(-3.2, 3.2, 49, retstep=True)
    y, rest = expit(np.pi * np.sinh(t)), expit(-np.pi * np.sinh(t))
    weights = step * np.pi * np.cosh(t) * y * rest
    result = np.zeros((len(x), COUNT))
    for row, place in zip(result, x, strict=True):
        inside = min(place, 1.0)
        # Sources on the left and on the right, and their distances without cancellation.
        left = inside * y, place - inside + inside * rest, inside
        right = inside + (1 - inside) * y, (1 - inside) * y, 1 - inside
        for source, distance, length in (left, right):
            kernel = k0(k * np.maximum(distance, 1e-290)) + k0(k * (place + source))
            row += length * (weights * kernel) @ polynomials(source)
    return result


@cache
def quarter_space(poisson, mesh):
    """Nodes and weights along kz, and (1 - T^2)^-1."""
    z, weights = half_line(mesh, mesh.lowest, DEEPEST)
    operator = traction(z, z, 1.0, poisson) * weights
    return z, weights, np.linalg.inv(np.eye(len(z)) - operator @ operator)


def one_end(k, poisson, mesh):
    """Coefficients of what one free face adds to the mirror image."""
    scaled, weights, inverse = quarter_space(poisson, mesh)
    z = scaled / k
    half, half_weights = half_length(mesh)
    x, x_weights = np.concatenate([half, 1 - half]), np.tile(half_weights, 2)
    loaded = traction(z, x, k, poisson) @ (x_weights[:, None] * polynomials(x))
    beyond, beyond_weights = half_line(mesh, mesh.lowest * min(1, 1 / k), DEEPEST / k)
    x = np.concatenate([x, 1 + beyond])
    x_weights = np.concatenate([x_weights, beyond_weights])
    excess = (traction(x, z, k, poisson) * weights / k) @ (inverse @ loaded)
    return displacement(x, k).T @ (x_weights[:, None] * excess)


def both_ends(k, poisson, parity, mesh):
    """Coefficients, for the polynomials of one parity, of K_A (P - p)."""
    x, weights = half_length(mesh)
    z, z_weights = half_line(mesh, mesh.lowest * min(1, 1 / k), DEEPEST / k)
    phi = polynomials(x)
    a = face_stress(z, x, k, poisson, parity) * weights
    b = surface_stress(x, z, k, poisson, parity) * z_weights
    excess = b @ np.linalg.solve(np.eye(len(z)) - a @ b, a @ phi)
    response = displacement(x, k) + far_displacement(x, GAUSS, k) @ AT_GAUSS
    return 2 * response.T @ (weights[:, None] * excess)


def difference(k, poisson, mesh=TABULATED):
    """D_ab: (a, b)."""
    # Images of p itself, but for the mirror images, which the quarter spaces have.
    others = far_displacement(GAUSS, GAUSS, k) - k0(k * (2 - GAUSS[:, None] - GAUSS))
    full = AT_GAUSS.T @ others @ AT_GAUSS - 2 * one_end(k, poisson, mesh)
    result = np.zeros((COUNT, COUNT))
    for first, parity in ((0, 1), (1, -1)):
        part = np.s_[first::2, first::2]
        result[part] = full[part] + both_ends(k, poisson, parity, mesh)[part]
    return (result + result.T) / 2


def table():
    """Coefficients c: (p, q, a, b)."""
    (of_poisson, to_p), (of_length, to_q) = interpolation(POISSONS), interpolation(LENGTHS)
    low, high = np.log(RANGE)
    wavenumbers = np.exp(low + (high - low) * (1 + of_length) / 2)
    # A half of the decay: with all of it, the errors of small D would spread to long waves.
    scale = wavenumbers * np.exp(wavenumbers / 2)
    values = [[difference(k, (1 + t) / 4) for k in wavenumbers] for t in of_poisson]
    return np.einsum("pi,qj,j,ijab->pqab", to_p, to_q, scale, values)


def main():
    if sys.argv[1:] == ["check"]:
        for k, poisson in CHECKED:
            print(k, poisson, difference(k, poisson, REFINED), sep="\n")
        return
    lines, coefficients = [], table()
    for a in range(COUNT):
        for b in range(a, COUNT, 2):
            rows = coefficients[:, :, a, b]
            lines += [f"{a} {b}", *(" ".join(f"{c:.9e}" for c in row) for row in rows)]
    PATH.write_text(HEADER + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
