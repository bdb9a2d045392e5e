"""Response of layered half-spaces, by the equations of elasticity and nothing else.

A body is ``Body([(thickness, G, nu, bonded), ...], (G, nu) or None)``; None is a rigid base. z
points
into the body, alpha is the wave number. In the frame along the wave vector (L), across it (T) and
z,

    u_z = W,  u_L = i V,  sigma_zz = -P,  sigma_Lz = -i TAU,      u_T = U,  sigma_Tz = -Q,

and at the surface (W, V) = [[c11, c12], [c12, c22]] (P, TAU), U = ct Q. Hooke's law and
equilibrium are

    d/d(alpha z) of (alpha W, alpha V, P, TAU):   A = [[0, nu/(1-nu), -(1-2nu)/(2G(1-nu)), 0],
                                                       [-1, 0, 0, -1/G],
                                                       [0, 0, 0, 1],
                                                       [0, -2G/(1-nu), -nu/(1-nu), 0]]
    d/d(alpha z) of (alpha U, Q):                 A = [[0, -1/G], [-G, 0]]

(derived here; no layer matrices, no recursion). (A^2 - 1)^2 = 0 gives exp(A x) in closed form.

``states`` joins slabs of at most four wave units (multiple shooting: one linear system for each
wave number), in doubles, for real or complex arguments. Its error is some 1e-14 of the largest
state.
``exact`` solves the same system with one slab for each layer in mpmath's current precision.
"""

import dataclasses
import itertools

import mpmath
import numpy as np

DEEP = 39.0  # wave units, below which nothing is felt: exp(-39) = 1e-17


@dataclasses.dataclass(frozen=True)
class Body:
    layers: list  # (thickness, G, nu, bonded to what is below), from the surface down
    base: tuple | None  # (G, nu)

    @property
    def top(self):
        """Shear modulus and Poisson's ratio at the surface."""
        return self.layers[0][1:3] if self.layers else self.base

    def cut(self, depth):
        """Index of the slab whose top is at a depth, and the body with an interface there."""
        layers, above = [], 0.0
        for k, (h, shear, nu, bonded) in enumerate(self.layers):
            if abs(depth - above) <= 1e-12 * depth:
                return k, self
            if depth < above + h:
                parts = [(depth - above, shear, nu, True), (above + h - depth, shear, nu, bonded)]
                return k + 1, Body([*layers, *parts, *self.layers[k + 1 :]], self.base)
            layers.append((h, shear, nu, bonded))
            above += h
        if depth > above * (1 + 1e-12) and self.base is not None:
            layers.append((depth - above, *self.base, True))
        return len(layers), Body(layers, self.base)


def body(case):
    """Return the body of a reference file: layers with thickness, young, poisson, interface."""

    def shear(m):
        return m["young"] / (2 * (1 + m["poisson"]))

    base = case["substrate"]
    rigid = base is None or base == "rigid"
    layers = [
        (m["thickness"], shear(m), m["poisson"], m["interface"] == "bonded") for m in case["layers"]
    ]
    return Body(layers, None if rigid else (shear(base), base["poisson"]))


def coat(ratio, h, nu, rigid=False):
    """One bonded coating of modulus ratio E2, E2 = 1; on a rigid base, of modulus 1."""
    unit = 0.5 / (1 + nu)
    return Body([(h, (1 if rigid else ratio) * unit, nu, True)], None if rigid else (unit, nu))


def plane(shear, nu):
    e, g = (1 - 2 * nu) / (2 * shear * (1 - nu)), nu / (1 - nu)
    return [[0, g, -e, 0], [-1, 0, 0, -1 / shear], [0, 0, 0, 1], [0, -2 * shear / (1 - nu), -g, 0]]


def twist(shear, nu):
    return [[0, -1 / shear], [-shear, 0]]


def half_space(shear, nu, size):
    """Alpha times the compliance of a homogeneous half-space."""
    if size == 2:
        return [[1 / shear]]
    c12 = (1 - 2 * nu) / (2 * shear)
    return [[(1 - nu) / shear, c12], [c12, (1 - nu) / shear]]


def _exponential(matrix, x):
    """exp(A x) for an array of x."""
    a, x = np.array(matrix), np.asarray(x)[:, None, None]
    c, s, one = np.cosh(x), np.sinh(x), np.eye(len(a))
    if len(a) == 2:
        return c * one + s * a
    small = sum(x ** (2 * k + 1) * (2 * k / _factorial(2 * k + 1)) for k in range(1, 9))
    odd = np.where(abs(x) < 0.5, small, x * c - s)  # x cosh x - sinh x
    a2 = a @ a
    return (c - x * s / 2) * one + (s - odd / 2) * a + x * s / 2 * a2 + odd / 2 * (a2 @ a)


def _factorial(n):
    return float(np.prod(np.arange(1, n + 1, dtype=float)))


def states(stack, alpha, size=4):
    """States (alpha u, tractions) on top of each layer and of the base, for each unit traction.

    Returns an array [alpha, layer, component, load]; deeper layers than DEEP are left at 0.
    """
    law = plane if size == 4 else twist
    alpha, half = np.asarray(alpha), size // 2
    thick = [layer[0] for layer in stack.layers]
    counts = np.zeros((len(alpha), len(thick) + 1), int)  # slabs; the last column: last layer felt
    above = np.zeros(len(alpha))
    for k, h in enumerate(thick):
        felt = above < DEEP
        counts[:, k] = np.where(felt, np.ceil(np.minimum(alpha * h, DEEP).real / 4).clip(1), 0)
        above = above + (alpha * h).real
        counts[:, -1] += felt
    whole = above < DEEP  # so that the base is felt, too
    unit = stack.top[0].real
    kind = np.result_type(
        alpha,
        *[np.asarray(v) for layer in stack.layers for v in layer[:3]],
        *(stack.base or [0.0]),
        float,
    )
    found = np.zeros((len(alpha), len(thick) + 1, size, half), kind)
    scale = np.array([unit] * half + [1.0] * half)  # of displacements, against tractions
    keys = np.column_stack([counts, whole])
    for key in np.unique(keys, axis=0):
        rows = np.flatnonzero((keys == key).all(axis=1))
        last = key[-2]
        slabs = [k for k in range(last) for _ in range(key[k])]
        n = size * (len(slabs) + 1)
        system = np.zeros((len(rows), n, n), kind)
        right = np.zeros((n, half))
        for i in range(half):
            system[:, i, half + i] = right[i, i] = 1
        for m, k in enumerate(slabs):
            h, shear, nu, bonded = stack.layers[k]
            x = np.where((alpha[rows] * h).real < DEEP, alpha[rows] * h, DEEP)
            step = _exponential(law(shear, nu), x / key[k])
            step = step * scale[:, None] / scale[None, :]
            at, to = half + size * m, size * m
            system[:, at : at + size, to : to + size] = step
            for i in range(size):
                system[:, at + i, to + size + i] = -1
            if not bonded and (m + 1 == len(slabs) or slabs[m + 1] != k):  # no shear on either side
                system[:, at + half - 1] = system[:, at + size - 1] = 0
                system[:, at + size - 1, to : to + size] = step[:, size - 1]
                system[:, at + half - 1, to + 2 * size - 1] = 1
        base = stack.base if key[-1] else stack.layers[last - 1][1:3]
        end = n - half
        for i in range(half):
            system[:, end + i, n - size + i] = 1
            if base is not None:
                for j in range(half):
                    system[:, end + i, n - half + j] = -unit * half_space(*base, size)[i][j]
        solved = np.linalg.solve(system, np.broadcast_to(right, (len(rows), n, half)))
        solved = solved.reshape(len(rows), -1, size, half) / scale[:, None]
        tops = [slabs.index(k) for k in range(last)] + ([len(slabs)] if key[-1] else [])
        for layer, m in enumerate(tops):
            found[rows, layer] = solved[:, m]
    return found


def compliances(stack, alpha, size=4):
    """Alpha times (c11, c12, c22) for each alpha, or alpha ct with size 2."""
    top = states(stack, alpha, size)[:, 0]
    return top[:, 0, 0] if size == 2 else (top[:, 0, 0], top[:, 0, 1], top[:, 1, 1])


def excess(stack, alpha):
    """M = alpha c11/A1 - 1, A1 = (1 - nu1)/G1 of the top layer."""
    shear, nu = stack.top
    return compliances(stack, alpha)[0] * shear / (1 - nu) - 1


def exact(stack, alpha, size=4):
    """Compliances (c11, c12, c22) or ct in mpmath's precision; numbers may be mpf."""
    with mpmath.workdps(3 * mpmath.mp.dps + 20):  # exp(2 * DEEPEST) is 10**(1.1 * dps)
        return _exact(stack, mpmath.mpf(alpha), size)


def _exact(stack, alpha, size):
    law, half, count = (plane if size == 4 else twist), size // 2, len(stack.layers)
    n, deepest = size * (count + 1), mpmath.mp.dps * 0.43
    system, right = mpmath.zeros(n, n), mpmath.zeros(n, half)
    for i in range(half):
        system[i, half + i] = right[i, i] = 1
    for m, (h, shear, nu, bonded) in enumerate(stack.layers):
        x = min(alpha * h, deepest)
        a = mpmath.matrix(law(mpmath.mpf(shear), mpmath.mpf(nu)))
        c, s = mpmath.cosh(x), mpmath.sinh(x)
        step = c * mpmath.eye(size) + s * a
        if size == 4:
            step = (c - x * s / 2) * mpmath.eye(4) + (3 * s - x * c) / 2 * a
            step = step + x * s / 2 * a**2 + (x * c - s) / 2 * a**3
        at, to = half + size * m, size * m
        for i, j in itertools.product(range(size), range(size)):
            cut = not bonded and i in (half - 1, size - 1)
            system[at + i, to + j] = 0 if cut and i < size - 1 else step[i, j]
            system[at + i, to + size + j] = 0 if cut else -(i == j)
        if not bonded:
            system[at + half - 1, to + 2 * size - 1] = 1
    for i in range(half):
        system[n - half + i, n - size + i] = 1
        for j in range(half if stack.base is not None else 0):
            system[n - half + i, n - half + j] = -half_space(*map(mpmath.mpf, stack.base), size)[i][
                j
            ]
    found = [mpmath.lu_solve(system, right[:, j]) for j in range(half)]
    return (
        found[0][0] / alpha
        if size == 2
        else tuple(found[j][i] / alpha for i, j in ((0, 0), (0, 1), (1, 1)))
    )
