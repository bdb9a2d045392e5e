"""Partial slip and rolling of coated cylinders in plane strain: friction/line_contact.json.

With F = m c22 = A (1 + T) of both bodies, A that of two bare bodies of the coating, the tractions
q shift the surfaces by

    u'(x)/A = (1/pi) PV integral q(t)/(t - x) dt - (1/pi) integral q(t) integral T(m) sin(m (x -
    t)) dm dt

which is 0 (Cattaneo) or constant (rolling) where they stick. q = mu p - q*, with q* where they
stick, is a series of
sqrt(1 - xi^2) U_k(xi), whose principal value is -T_k+1(xi); adhesion everywhere: T_k(xi)/sqrt(1 -
xi^2) and U_k-1(xi).
"""

import sys

import numpy as np
from scipy.optimize import brentq

from axisym import Response
from common import main
from layered import coat, compliances
from line import Line
from stress_disc import panels

NAME, SECONDS, NU = "friction/line_contact.json", 40, 0.3


class Pair:
    def __init__(self, ratio, h):
        self.ratio, self.h = ratio, h
        stack = coat(ratio, h, NU)
        self.line = Line(Response(stack), 1.0)
        self.m, self.weights = panels(21 / h, min(0.7, 0.3 / h))
        self.rest = compliances(stack, self.m)[2] * stack.top[0] / (1 - NU) - 1  # T
        n = 40 + int(8 / h)
        angle = np.arange(1, n + 1) * np.pi / (n + 1)
        self.t, self.w = (
            np.cos(angle),
            np.pi / (n + 1) * np.sin(angle),
        )  # with sin: of sqrt(1 - t^2) U_k
        self.angle = angle

    def smooth(self, x, t):
        mx, mt, w = np.outer(x, self.m), np.outer(t, self.m), self.weights * self.rest
        return -((np.sin(mx) * w) @ np.cos(mt).T - (np.cos(mx) * w) @ np.sin(mt).T) / np.pi

    def by_pressure(self, x):
        """u'/A under the pressure."""
        k = np.arange(len(self.line.a))
        bare = -np.cos(np.outer(np.arccos(x), 2 * k + 1)) @ self.line.a
        return bare + self.smooth(x, self.t) @ (self.w * self.line.pressure(self.t))

    def stick(self, middle, half):
        """Coefficients of q* (mu = 1) on |x - middle| < half, and u'/A there."""
        n = 30 + int(6 * half / self.h)
        angle = (np.arange(n + 1) + 0.5) * np.pi / (n + 1)
        k = np.arange(n)
        x = middle + half * np.cos(angle)
        basis = (
            np.sin(np.outer(self.angle, k + 1)) * self.w[:, None]
        )  # sqrt(1 - t^2) U_k and the rule's weight
        matrix = (
            -np.cos(np.outer(angle, k + 1)) + half * self.smooth(x, middle + half * self.t) @ basis
        )
        found = np.linalg.solve(np.column_stack([matrix, np.ones(n + 1)]), self.by_pressure(x))
        return found[:-1], found[-1]

    def held(self, middle, half):
        """Force over mu P that is carried when this interval sticks."""
        return 1 - np.pi * half * self.stick(middle, half)[0][0] / 2 / self.line.P

    def shift(self, c):
        """Return u in |x| < c over mu P (1 - nu)/G2; far away it is -(T2/pi) ln|x|."""

        def logarithm(a, half):  # integral of ln|x| over sum a_k sqrt(1 - xi^2) U_2k
            k = np.arange(len(a) + 1)
            part = np.where(
                k > 0, -((-1.0) ** k) * np.pi / (2 * np.maximum(k, 1)), -np.pi * np.log(2)
            )
            return half * a @ (part[:-1] - part[1:]) / 2 + np.log(half) * np.pi * half * a[0] / 2

        a = self.stick(0.0, c)[0]
        held = 1 - np.pi * c * a[0] / 2 / self.line.P
        bare = -(logarithm(self.line.a, 1.0) - logarithm(a[::2], c)) / np.pi
        star = np.sin(np.outer(self.angle, np.arange(len(a)) + 1)) @ a * c
        m, w = panels(max(40.0, 21 / self.h), min(0.7, 0.3 / self.h))
        rest = (
            compliances(coat(self.ratio, self.h, NU), m)[2] / (1 - NU) * self.ratio / (2 * (1 + NU))
            - 1
        )
        wave = np.cos(np.outer(m, self.t)) @ (self.w * self.line.pressure(self.t))
        wave = wave - np.cos(np.outer(m, self.t * c)) @ (self.w * star)
        added = (w / m) @ (rest * wave - (self.ratio - 1) * np.exp(-m) * held * self.line.P) / np.pi
        return 2 * (bare + added) / self.line.P / self.ratio

    def full(self):
        """Force over the creepage, adhesion everywhere, over its value on two bare substrates."""
        n = 40 + int(8 / self.h)
        angle = (np.arange(n) + 1) * np.pi / (n + 1)
        middle = (np.arange(n + 1) + 0.5) * np.pi / (n + 1)
        k = np.arange(n + 1)
        bare = np.sin(np.outer(angle, k)) / np.sin(angle)[:, None]
        basis = np.cos(np.outer(middle, k)) * np.pi / (n + 1)
        matrix = bare + self.smooth(np.cos(angle), np.cos(middle)) @ basis
        found = np.linalg.solve(np.vstack([matrix, np.ones(n + 1)]), np.append(np.ones(n), 0.0))
        return abs(found[0]) * self.ratio


def fill(content):
    for case in content["carter_full"]:
        case["ratio"] = Pair(case["E1_over_E2"], case["h_over_b"]).full()
    for case in content["cattaneo"]:
        pair, share = Pair(case["E1_over_E2"], case["h_over_b"]), case["Q_over_muP"]
        c = brentq(lambda c, p=pair, q=share: p.held(0.0, c) - q, 1e-3, 1 - 1e-9, xtol=1e-14)
        case |= {"c_over_b": c, "shift": pair.shift(c)}
    for case in content["carter_partial"]:
        pair, share = Pair(case["E1_over_E2"], case["h_over_b"]), case["Q_over_muP"]
        half = brentq(lambda s, p=pair, q=share: p.held(1 - s, s) - q, 1e-3, 1 - 1e-9, xtol=1e-14)
        creep = abs(pair.stick(1 - half, half)[1]) * 2 * (1 - NU) / pair.ratio / pair.line.P
        case |= {
            "stick_from_over_b": 1 - 2 * half,
            "stick_to_over_b": 1.0,
            "creep_times_G2b_over_muP": creep,
        }


if __name__ == "__main__":
    main(sys.modules[__name__])
