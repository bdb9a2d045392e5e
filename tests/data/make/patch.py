"""Surface displacements under a uniform load on a rectangle, |x| < a, |y| < b.

The bare top material in closed form; what the layers add by the double Fourier integral in polar
wave
numbers near the rectangle (no Bessel functions), by Hankel integrals and Gauss points on the
rectangle
far from it. Derived here; the bare forms are Love's and Cerruti's.
"""

import numpy as np
from scipy.special import j0, j1

from layered import compliances
from stress_disc import panels


class Added:
    """What layers add to alpha (c11, c12, c22, ct) of the top material, up to a reach."""

    def __init__(self, stack, reach, tangential=True):
        (shear, nu), thin = stack.top, stack.layers[0][0]
        whole = sum(layer[0] for layer in stack.layers)
        self.alpha, self.weights = panels(21 / thin, min(2.0 / reach, 0.3 / whole))
        parts = np.array_split(self.alpha, 1 + len(self.alpha) // 4000)
        c11, c12, c22 = np.concatenate([np.array(compliances(stack, p)) for p in parts], axis=1)
        self.c11, self.c12 = c11 - (1 - nu) / shear, c12 - (1 - 2 * nu) / (2 * shear)
        self.c22 = c22 - (1 - nu) / shear
        if tangential:
            self.ct = np.concatenate([compliances(stack, p, 2) for p in parts]) - 1 / shear

    def near(self, x, y, a, b, normal=False):
        """u_z under p, or (u_x, u_y, u_z) under q_x."""
        found = np.zeros(1 if normal else 3)
        for part in np.array_split(np.arange(len(self.alpha)), 1 + len(self.alpha) // 60):
            alpha, w = self.alpha[part, None], self.weights[part]
            top = self.alpha[part[-1]]
            n = 24 + int(top * (np.hypot(x, y) + np.hypot(a, b)) / 1.9)
            angle = np.linspace(0, np.pi / 2, n + 1)
            c, s = np.cos(angle), np.sin(angle)
            rule = np.full(n + 1, 2 * np.pi / n)  # four quadrants
            rule[[0, -1]] /= 2
            load = (
                4
                * a
                * b
                * np.sinc(alpha * c * a / np.pi)
                * np.sinc(alpha * s * b / np.pi)
                * rule
                / (4 * np.pi**2)
            )
            mx, ny = alpha * c * x, alpha * s * y
            even = load * np.cos(mx) * np.cos(ny)
            if normal:
                found[0] += (w * self.c11[part]) @ even.sum(1)
                continue
            c22, ct = w * self.c22[part], w * self.ct[part]
            found[0] += c22 @ (even @ c**2) + ct @ (even @ s**2)
            found[1] -= (c22 - ct) @ ((load * np.sin(mx) * np.sin(ny)) @ (c * s))
            found[2] += (w * self.c12[part]) @ ((load * np.sin(mx) * np.cos(ny)) @ c)
        return found[0] if normal else found

    def far(self, x, y, a, b, normal=False, order=(12, 12)):
        g, v = np.polynomial.legendre.leggauss(order[0])
        e, w = np.polynomial.legendre.leggauss(order[1])
        found = np.zeros(1 if normal else 3)
        for gx, vx in zip(g, v, strict=True):
            for gy, vy in zip(e, w, strict=True):
                dx, dy = x - a * gx, y - b * gy
                r, t, share = np.hypot(dx, dy), np.arctan2(dy, dx), a * b * vx * vy / (2 * np.pi)
                z = self.alpha * r
                zeroth = self.weights * j0(z)
                if normal:
                    found[0] += share * self.c11 @ zeroth
                    continue
                first = self.weights * j1(z)
                second = 2 * first / z - zeroth
                k0, k1 = (self.c22 + self.ct) / 2 @ zeroth, self.c12 @ first
                k2 = (self.c22 - self.ct) / 2 @ second
                found += share * np.array(
                    [k0 - k2 * np.cos(2 * t), -k2 * np.sin(2 * t), k1 * np.cos(t)]
                )
        return found[0] if normal else found


def corners(function, x, y, a, b):
    signs = ((1, 1), (-1, 1), (1, -1), (-1, -1))
    return sum(i * j * function(np.float64(x + i * a), np.float64(y + j * b)) for i, j in signs)


def times(factor, value):
    return factor * value if factor else 0.0


def love(x, y, a, b):
    """Integral of 1/r over the rectangle."""

    def corner(x, y):
        return times(x, np.arcsinh(y / abs(x)) if x else 0) + times(
            y, np.arcsinh(x / abs(y)) if y else 0
        )

    return corners(corner, x, y, a, b)


def bare(shear, nu, x, y, a, b):
    """(u_x, u_y, u_z) of a homogeneous half-space under q_x."""
    xx = corners(lambda x, y: times(y, np.arcsinh(x / abs(y)) if y else 0), x, y, a, b)
    xy = corners(lambda x, y: -np.hypot(x, y), x, y, a, b)
    up = corners(
        lambda x, y: times(y, np.log(np.hypot(x, y))) + times(x, np.arctan(y / x) if x else 0),
        x,
        y,
        a,
        b,
    )
    all_ = (1 - nu) * love(x, y, a, b) + nu * xx
    return np.array([all_, nu * xy, (1 - 2 * nu) / 2 * up]) / (2 * np.pi * shear)
