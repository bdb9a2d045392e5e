"""Reference influence coefficients of random coated half-spaces.

Claim: every ``c`` in ``influence_random.json`` is the normal displacement of
the surface at the offset (i dx, j dy) from the centre of a dx * dy rectangle
under unit pressure, and its error is below ``error``, the difference of two
evaluations that share no quadrature, and never less than the rounding of ``c``
and of the terms it is the sum of.  On a rigid base ``c`` fades exponentially;
far rows whose ``c`` is below ``error`` say only that it is that small.

Method.  With A1 = (1 - nu1)/G1 of the top layer, A the same of the substrate (0
for a rigid base) and M(alpha) = alpha c11 / A1 - 1, M(0) = M0 = A/A1 - 1,

    c = A1/(2 pi) [I0 + integral of k_M over the cell]
      = 1/(2 pi) [A I0 + A1 integral of k_N over the cell],    k_N = k_M - M0/r,

where I0 is the integral of 1/r over the cell (Love) and k_M the Hankel
transform of M.  c11 comes from the full boundary-value system in ball
arithmetic (response_random.py), also at complex wavenumbers: the path of

    k_N(r) = Re integral (M - M0) H0(alpha r) d alpha     (Hankel function, first kind)

is turned to the ray arg(alpha) = angle, below the poles of M, where nothing
oscillates and the trapezoidal rule in ln(alpha) converges exponentially.  The
same with H1 gives H_N(R), the integral of k_N r over 0 < r < R.

Evaluation 1: tensor Gauss quadrature over the cell, cut into pieces that are
small against their distance from the origin.  Evaluation 2, with another angle
and another step: for near cells the corner function, a line integral of
H_N(R)/R^2; for far cells, where its differences would cancel, quadrature of
another order with other pieces.  Besides, k_M is compared for every body with
a Gauss quadrature along the real axis, which no pole can mislead.

Everything after the tables is 80-bit arithmetic (x86 long double).
Needs numpy, python-flint.  Run: python tests/data/make/influence_random.py
"""

import math
import random
import sys
from fractions import Fraction

import numpy as np
from common import main
from flint import acb, arb, ctx, fmpq
from response_random import compliances, random_poisson, rounded, shear_modulus

NAME, SECONDS = "influence_random.json", 900
LD = np.longdouble
CLD = np.clongdouble
PI = LD("3.14159265358979323846264338327950288")
DESCRIPTION = (
    "Influence coefficients: c is the normal surface displacement at the offset (i dx, j dy) from the "
    "centre of a rectangle cell = [dx, dy] under unit pressure. Layers from the surface down; "
    "'interface' is the one below the layer; substrate null is a rigid base. Made by "
    "influence_random.py: Hankel kernels of the exact response on a turned path, cell integrals in "
    "80-bit arithmetic. 'error' is the difference of two independent evaluations (at least the rounding "
    "of c and of its terms; rigid base: a far c below its error is only known to be that small). Over "
    "all rows error / max(|c|, bare-substrate coefficient) is at most {elastic:.1e}; rigid base: "
    "error / bare-coating coefficient at most {rigid:.1e}."
)
SPAN = 0.5  # length in ln(r) of one interval of a table
DEGREE = 20
START = -1.0  # tables begin at ln(r/h) = START; a power series below
TERMS = 20  # of the power series
LOW, LOW_H = -27, -46  # ln(alpha r) where the integrals for k_N and H_N begin
HIGH = 5.25  # and where the Hankel functions have died
TOP = 4.25  # ln(alpha h) where M has died


def to_long(x):
    """Long double from a ball."""
    hi = float(x.mid())
    return LD(hi) + LD(float((x - arb(hi)).mid()))


def to_complex(z):
    return CLD(to_long(z.real)) + CLD(1j) * to_long(z.imag)


def modulus_ratio(body):
    return (1 - arb(body["poisson"])) / shear_modulus(body)


def polynomial(coefficients, index, t):
    """Chebyshev series by Clenshaw; coefficients[index] belong to the points t in -1..1."""
    b1 = b2 = np.zeros_like(t)
    for k in range(coefficients.shape[1] - 1, 0, -1):
        b1, b2 = 2 * t * b1 - b2 + coefficients[index, k], b1
    return t * b1 - b2 + coefficients[index, 0]


def gauss(n):
    """Gauss-Legendre nodes and weights on -1..1."""
    ctx.prec = 200
    pairs = [arb.legendre_p_root(n, k, weight=True) for k in range(n)]
    return tuple(np.array([to_long(p[m]) for p in pairs]) for m in (0, 1))


class Response:
    """M(alpha) of one body, as balls."""

    def __init__(self, layers, substrate):
        self.layers, self.substrate = layers, substrate
        self.h = arb(layers[0]["thickness"])
        self.bits = 400

    def constants(self):
        a1 = modulus_ratio(self.layers[0])
        a = modulus_ratio(self.substrate) if self.substrate else arb(0)
        return a1, a, a / a1 - 1

    def remainder(self, k, density, angle):
        """(M, M - M0, alpha h) at alpha h = exp(k/density + i angle)."""
        while self.bits <= 12800:
            ctx.prec = self.bits
            x = (arb(k) / density).exp() * acb(arb(angle).cos(), arb(angle).sin())
            alpha = x / self.h
            a1, _, m0 = self.constants()
            try:
                m = alpha * compliances(self.layers, self.substrate, alpha, twist=False)[0] / a1 - 1
                n = m - m0
                if bool(n.real.rad() + n.imag.rad() < 1e-24 * min(1.0, math.exp(k / density))):
                    return m, n, x
            except ZeroDivisionError:
                pass
            self.bits *= 2
        raise ArithmeticError("precision exhausted")


class HankelLattice:
    """z H0(z) and H1(z) at ln|z| = n/density + Chebyshev node, arg z = angle, times the step."""

    def __init__(self, angle, density):
        self.angle, self.density = angle, density
        k = np.arange(DEGREE + 1)
        nodes = np.cos((2 * k + 1) * PI / (2 * (DEGREE + 1)))
        self.offsets = np.array([float(v) for v in (nodes + 1) * LD(SPAN) / 2])
        exact = 4 * LD(1) / SPAN * self.offsets.astype(LD) / 2 - 1  # the nodes as rounded
        vandermonde = np.cos(k[None, :] * np.arccos(exact)[:, None])
        self.inverse = invert(vandermonde)
        self.first = LOW_H * density
        self.count = int(HIGH * density) - self.first + 1
        self.h0 = np.zeros((DEGREE + 1, self.count), CLD)
        self.h1 = np.zeros_like(self.h0)
        for a, offset in enumerate(self.offsets):
            for b in range(self.count):
                log_z = Fraction(self.first + b, density) + Fraction(float(offset))
                self.h0[a, b], self.h1[a, b] = (c / density for c in hankel(log_z, angle))


def hankel(log_z, angle):
    """z H0(z) and H1(z) at ln z = log_z + i angle, from H_n(z) = 2/(pi i^(n+1)) K_n(-i z)."""
    ctx.prec = 160
    while ctx.prec < 3000:
        z = arb(fmpq(log_z.numerator, log_z.denominator)).exp() * acb(arb(angle).cos(), arb(angle).sin())
        w = -acb(0, 1) * z
        h0 = 2 / (arb.pi() * acb(0, 1)) * w.bessel_k(0)
        h1 = -2 / arb.pi() * w.bessel_k(1)
        parts = [part for h in (z * h0, z * h1) for part in (h.real, h.imag)]
        if all(bool(part.rad() < 1e-25) for part in parts):
            return to_complex(z * h0), to_complex(h1)
        ctx.prec *= 2
    raise ArithmeticError("Hankel function")


def invert(matrix):
    """Inverse in long double: double inverse and Newton steps."""
    x = np.linalg.inv(matrix.astype(float)).astype(LD)
    for _ in range(3):
        x = x @ (2 * np.eye(len(matrix), dtype=LD) - matrix @ x)
    return x


class Kernel:
    """Tables of r k_N and H_N/R up to a largest r; lengths in units of the top layer's h."""

    def __init__(self, response, lattice, r_max):
        self.h = to_long(response.h)
        self.a1, self.a, self.m0 = (to_long(c) for c in response.constants())
        density = lattice.density
        intervals = int((math.log(r_max) - START) / SPAN) + 2 if r_max > math.exp(START) else 1
        first = LOW_H * density - int((START + SPAN * intervals) * density)
        last = int(TOP * density)
        samples = [response.remainder(k, density, lattice.angle) for k in range(first, last + 1)]
        m, n, x = (np.array([to_complex(s[q]) for s in samples]) for q in range(3))
        m1 = to_long((samples[0][1] / samples[0][2]).real)
        n = np.concatenate([n, np.full(lattice.count, -self.m0, CLD)])
        # r k_N and H_N / R at the Chebyshev nodes
        kernel = np.zeros((intervals, DEGREE + 1), LD)
        moment = np.zeros_like(kernel)
        skip = (LOW - LOW_H) * density
        for j in range(intervals):
            shift = lattice.first - int((START + SPAN * j) * density) - first
            part = n[shift : shift + lattice.count]
            kernel[j] = (lattice.h0[:, skip:] @ part[skip:]).real
            arc = 2 * m1 * LD(lattice.angle) / PI  # the arc around the origin
            radius = np.exp(LD(START) + LD(SPAN) * j + lattice.offsets.astype(LD))
            moment[j] = arc / radius + (lattice.h1 @ part).real
        self.kernel = kernel @ lattice.inverse.T
        self.moment = moment @ lattice.inverse.T
        # power series of k_M: (-1)^q / (4^q q!^2) * integral M alpha^(2 q)
        self.series, factor = [], LD(1)
        for q in range(TERMS):
            self.series.append(factor * (m * x ** (2 * q + 1)).sum().real / density)
            factor /= -4 * LD(q + 1) ** 2

    def _table(self, table, r):
        s = (np.log(r) - LD(START)) / LD(SPAN)
        index = np.floor(s).astype(int)
        if index.size and index.max() >= len(table):
            raise IndexError("table too short")
        return polynomial(table, index, 2 * (s - index) - 1)

    def k_n(self, r):
        """h k_N at r/h, beyond the power series."""
        return self._table(self.kernel, r) / r

    def k_m(self, r):
        out = np.empty_like(r)
        near = r < math.exp(START) * (1 + 1e-12)
        square, value = r[near] ** 2, np.zeros(near.sum(), LD)
        for c in reversed(self.series):
            value = value * square + c
        out[near] = value
        out[~near] = (self._table(self.kernel, r[~near]) + self.m0) / r[~near]
        return out

    def h_n_over_square(self, r):
        """H_N / R^2 (times h)."""
        out = np.empty_like(r)
        near = r < math.exp(START) * (1 + 1e-12)
        square, value = r[near] ** 2, np.zeros(near.sum(), LD)
        for q in reversed(range(TERMS)):
            value = value * square + self.series[q] / (2 * q + 2)
        out[near] = value - self.m0 / r[near]
        out[~near] = self._table(self.moment, r[~near]) / r[~near]
        return out


def rectangle(cell, i, j, h):
    """Edges x0, x1, y0, y1 of the loaded cell seen from the point, over h."""
    dx, dy = LD(cell[0]) / h, LD(cell[1]) / h
    half = LD("0.5")
    return (i - half) * dx, (i + half) * dx, (j - half) * dy, (j + half) * dy


def love(cell, i, j):
    """Integral of 1/r over the cell, from the corner function at 60 digits."""
    ctx.prec = 200
    dx, dy, total = arb(cell[0]), arb(cell[1]), arb(0)
    for sx in (-1, 1):
        for sy in (-1, 1):
            x, y = (i + arb(sx) / 2) * dx, (j + arb(sy) / 2) * dy
            total += sx * sy * (x * (y / abs(x)).asinh() + y * (x / abs(y)).asinh())
    return to_long(total)


def leaves(box, factor):
    """Cut the rectangle into pieces with sides below factor * max(distance, h), h = 1."""
    todo, done = np.array([box], LD), []
    while len(todo):
        x0, x1, y0, y1 = todo.T
        gap = [np.maximum(np.maximum(lo, -hi), 0) for lo, hi in ((x0, x1), (y0, y1))]
        limit = factor * np.maximum(np.hypot(*gap), 1)
        along_x = x1 - x0 >= y1 - y0
        split = np.maximum(x1 - x0, y1 - y0) > limit
        done.append(todo[~split])
        parts = []
        for axis, chosen in ((0, split & along_x), (2, split & ~along_x)):
            low, high = todo[chosen].copy(), todo[chosen].copy()
            middle = (low[:, axis] + low[:, axis + 1]) / 2
            low[:, axis + 1] = high[:, axis] = middle
            parts += [low, high]
        todo = np.concatenate(parts)
    return np.concatenate(done)


def by_cubature(kernel, cell, i, j, order, factor):
    box = rectangle(cell, i, j, kernel.h)
    near = max(box[0], 0) < 1 and max(box[2], 0) < 1
    function = kernel.k_m if near else kernel.k_n
    nodes, weights = order
    total = LD(0)
    pieces = leaves(box, LD(factor))
    for start in range(0, len(pieces), 2000):
        x0, x1, y0, y1 = (c[:, None, None] for c in pieces[start : start + 2000].T)
        x = (x0 + x1) / 2 + (x1 - x0) / 2 * nodes[None, :, None]
        y = (y0 + y1) / 2 + (y1 - y0) / 2 * nodes[None, None, :]
        r = np.sqrt(x * x + y * y)
        values = function(r.ravel()).reshape(r.shape)
        area = (x1 - x0) * (y1 - y0) / 4
        total += (values * weights[None, :, None] * weights[None, None, :] * area).sum()
    modulus = kernel.a1 if near else kernel.a
    return (modulus * love(cell, i, j) + kernel.a1 * kernel.h * total) / (2 * PI)


def edge_integral(kernel, x, y, order):
    """Integral of x H_N(R)/R^2, R^2 = x^2 + t^2, over 0 < t < y; x, y > 0."""
    edges = [LD(0)]
    while edges[-1] < y:
        edges.append(min(y, edges[-1] + LD("0.6") * np.hypot(x, edges[-1])))
    lo, hi = np.array(edges[:-1])[:, None], np.array(edges[1:])[:, None]
    t = (lo + hi) / 2 + (hi - lo) / 2 * order[0]
    r = np.sqrt(x * x + t * t)
    values = kernel.h_n_over_square(r.ravel()).reshape(r.shape)
    return x * (values * order[1] * (hi - lo) / 2).sum()


def by_corners(kernel, cell, i, j, order):
    x0, x1, y0, y1 = rectangle(cell, i, j, kernel.h)
    total = LD(0)
    for x, sx in ((x0, -1), (x1, 1)):
        for y, sy in ((y0, -1), (y1, 1)):
            sign = sx * sy * np.sign(x) * np.sign(y)
            corner = edge_integral(kernel, abs(x), abs(y), order)
            total += sign * (corner + edge_integral(kernel, abs(y), abs(x), order))
    return (kernel.a * love(cell, i, j) + kernel.a1 * kernel.h * total) / (2 * PI)


def real_axis_deviation(response, kernel, order):
    """Largest |k_M - its quadrature along the real axis| / max |k_M| at three radii."""
    edges = [2.0**e for e in range(-48, 0)] + [0.5 * q for q in range(1, 81)]
    nodes = [(a + b) / 2 + (b - a) / 2 * float(t) for a, b in zip(edges, edges[1:]) for t in order[0]]
    weights = [(b - a) / 2 * float(w) for a, b in zip(edges, edges[1:]) for w in order[1]]
    radii = np.array([0.2, 1.3, 5.0], LD)
    m = []
    for x in nodes:
        ctx.prec = max(response.bits, 100)
        x = arb(x)
        value = compliances(response.layers, response.substrate, x / response.h, twist=False)[0]
        m.append(to_long(x / response.h * value / response.constants()[0] - 1))
    ctx.prec = 100
    direct = [
        sum(w * f * to_long((arb(x) * arb(float(r))).bessel_j(0)) for x, w, f in zip(nodes, weights, m))
        for r in radii
    ]
    table = kernel.k_m(radii)
    return float(np.max(np.abs(table - np.array(direct))) / np.max(np.abs(table)))


def rounded_up(value):
    """Two digits, never below the value."""
    return float(f"{value * 1.05:.1e}")


def offsets(rng, cell, h):
    def any_index():
        return int(round(2049 ** rng.random())) - 1

    chosen = [(0, 0), (1, 0), (0, 1), (1, 1)]
    chosen += [(any_index(), any_index()) for _ in range(3)]
    reach = 10 ** rng.uniform(-0.5, 1.5) * h  # a point at a few thicknesses
    turn = rng.uniform(0, math.pi / 2)
    pair = (reach * math.cos(turn) / cell[0], reach * math.sin(turn) / cell[1])
    chosen.append(tuple(min(2048, int(round(v))) for v in pair))
    chosen.append(rng.choice([(2047, 2047), (2048, 0), (0, 2048), (any_index(), 0), (0, any_index())]))
    return sorted(set(chosen))


def bodies(rng):
    """(layers, substrate, cell) of all cases."""

    def layer(young, poisson, thickness, interface="bonded"):
        return {"young": young, "poisson": poisson, "thickness": thickness, "interface": interface}

    def cell():
        dx = rounded(10 ** rng.uniform(-1, 1))
        aspect = 10 ** rng.uniform(-3, 3) if rng.random() < 0.6 else rng.choice([1, 1, 2, 0.5])
        return [dx, rounded(dx / aspect)]

    def substrate():
        return {"young": rounded(10 ** rng.uniform(-1, 1)), "poisson": random_poisson(rng)}

    def contrast(base):
        return rounded(base["young"] * 10 ** rng.uniform(-3, 3))

    def thickness(size, low=-3, high=3):
        return rounded(size * 10 ** rng.uniform(low, high))

    for k in range(100):
        size, base = cell(), substrate()
        young = contrast(base)
        if k < 4:  # the corners of the range of contrasts
            young = rounded(base["young"] * (1e-3, 1e3)[k % 2])
            base["poisson"] = (0.5, 0.0)[k // 2]
        yield [layer(young, random_poisson(rng), thickness(size[0]))], base, size
    for k in range(16):
        size = cell()
        poisson = (0.5, 0.45, 0.3, random_poisson(rng))[k % 4]
        yield [layer(rounded(10 ** rng.uniform(-1, 1)), poisson, thickness(size[0]))], None, size
    for _ in range(9):
        size, base = cell(), substrate()
        young = contrast(base)
        yield [layer(young, random_poisson(rng), thickness(size[0]), "frictionless")], base, size
    yield [layer(1.0, 0.5, 2.0, "frictionless")], None, [1.0, 1.0]
    for k in range(10):
        size, base = cell(), substrate()
        stack = [
            layer(contrast(base), random_poisson(rng), thickness(size[0], -1.5, 1.5))
            for _ in range(2 + k % 4)
        ]
        yield stack, None if k == 9 else base, size


def fill(content):
    if np.finfo(LD).eps > 2e-19:
        raise SystemExit("needs a long double of at least 64 bits")
    rng = random.Random(20240612)
    lattices = HankelLattice(0.30, 24), HankelLattice(0.36, 28)
    orders = {n: gauss(n) for n in (10, 16, 22)}
    cases, worst = [], {"elastic": 0.0, "rigid": 0.0}
    worst_axis, corner_rows = 0.0, 0
    for number, (layers, substrate, cell) in enumerate(bodies(rng)):
        h = layers[0]["thickness"]
        chosen = offsets(rng, cell, h)
        r_max = max(math.hypot((i + 0.5) * cell[0], (j + 0.5) * cell[1]) for i, j in chosen) / h
        response = Response(layers, substrate)
        one, two = (Kernel(response, lattice, max(6.0, 1.01 * r_max)) for lattice in lattices)
        axis = real_axis_deviation(response, one, orders[16])
        worst_axis = max(worst_axis, axis)
        rows, case_worst = [], 0.0
        for i, j in chosen:
            first = by_cubature(one, cell, i, j, orders[10], 0.5)
            spread = ((i + 1) ** 2 * cell[0] / cell[1]) + (j + 1) ** 2 * cell[1] / cell[0]
            if spread < 2e4:
                second = by_corners(two, cell, i, j, orders[22])
                corner_rows += 1
            else:
                second = by_cubature(two, cell, i, j, orders[16], 0.8)
            bare, coating = (a * love(cell, i, j) / (2 * PI) for a in (one.a, one.a1))
            floor = max(abs(second) * 2.0**-53, max(bare, coating) * 2.0**-60)
            error = float(max(abs(first - second), floor))
            scale = float(max(abs(second), bare) if substrate else coating)
            case_worst = max(case_worst, error / scale)
            rows.append({"i": i, "j": j, "c": float(second), "error": rounded_up(error)})
        kind = "elastic" if substrate else "rigid"
        worst[kind] = max(worst[kind], case_worst)
        print(f"{number} {kind}, layers {len(layers)}: axis {axis:.1e}, error {case_worst:.1e}", flush=True)
        cases.append({"layers": layers, "substrate": substrate, "cell": cell, "rows": rows})
    if max(worst_axis, *worst.values()) > 1e-12:
        raise SystemExit(f"evaluations disagree: {worst}, real axis {worst_axis:.1e}")
    content["cases"] = cases
    content["description"] = DESCRIPTION.format(**{k: rounded_up(v) for k, v in worst.items()})
    print(f"{corner_rows} rows by corners, {worst}; largest deviation from the real axis {worst_axis:.1e}")


if __name__ == "__main__":
    main(sys.modules[__name__])
