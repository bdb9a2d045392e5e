"""Displacement and stress under a uniform square of p, q_x or q_y: stress_patch.json.

Double Fourier integral in polar wave numbers of the states at each depth; z is at least 0.3 here.
"""

import sys

import numpy as np

from common import main
from layered import Body, states
from stress_disc import panels, stresses

NAME, SECONDS = "stress_patch.json", 25


def response(stack, z, side, kind, x, y, size=0.5):
    alpha, weights = panels(40 / z, 0.6)
    index, cut = stack.cut(z)
    part = [*[layer[1:3] for layer in cut.layers], cut.base][index + side]
    plane, twist = states(cut, alpha)[:, index], states(cut, alpha, 2)[:, index, :, 0]
    names = ("ux", "uy", "uz", "szz", "sxz", "syz", "sxx", "syy", "sxy")
    found = np.zeros(9)
    n = 24 + int(2.2 * alpha[-1] * (np.hypot(x, y) + size * 1.5))
    angle = np.arange(n) * 2 * np.pi / n
    c, s = np.cos(angle), np.sin(angle)
    for k in np.array_split(np.arange(len(alpha)), 1 + len(alpha) // 40):
        a = alpha[k, None]
        load = (2 * size) ** 2 * np.sinc(a * c * size / np.pi) * np.sinc(a * s * size / np.pi)
        load = load * np.exp(1j * a * (c * x + s * y)) * weights[k, None] * a / (2 * np.pi * n)
        p, ql, qt = {"p": (1, 0, 0), "qx": (0, c, -s), "qy": (0, s, c)}[kind]
        state = (
            plane[k, None, :, 0] * np.multiply.outer(p, np.ones(n))[None, :, None]
            if kind == "p"
            else 0
        )
        if kind != "p":
            state = plane[k, None, :, 1] * (-1j * ql)[None, :, None]
        other = twist[k, None] * (qt * np.ones(n))[None, :, None]
        along, across = (v.reshape(state.shape[:2]) for v in stresses(state.reshape(-1, 4), *part))
        w, v, press, tau = np.moveaxis(state, 2, 0)
        u, q = np.moveaxis(other, 2, 0)
        ul, ut, lz, tz, lt = 1j * v / a, u / a, -1j * tau, -q, 1j * part[0] * u
        all_ = (c * ul - s * ut, s * ul + c * ut, w / a, -press, c * lz - s * tz, s * lz + c * tz,
                c**2 * along + s**2 * across - 2 * c * s * lt, s**2 * along + c**2 * across + 2 * c
                * s * lt,
                c * s * (along - across) + (c**2 - s**2) * lt)  # fmt: skip
        found += [float((load * one).sum().real) for one in all_]
    return dict(zip(names, map(float, found), strict=True))


def fill(content):
    for case in content["cases"]:
        parts = [(e / (2 * (1 + nu)), nu) for _, e, nu in case["layers"]]
        thick = [h for h, _, _ in case["layers"][:-1]]
        stack = Body([(h, *part, True) for h, part in zip(thick, parts, strict=False)], parts[-1])
        case |= response(stack, case["z"], case["side"], case["load"], case["x"], case["y"])


if __name__ == "__main__":
    main(sys.modules[__name__])
