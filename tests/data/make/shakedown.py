"""Shakedown and first yield under an elliptic pressure with friction: fatigue/shakedown.json.

Plane strain, b = p0 = 1: p = sqrt(1 - y^2) and the traction mu p along y. The stresses of a bare
body are McEwen's closed form (derived; the integrals for equal layers agree, to 1e-7). In a coat
they are these plus Fourier integrals of what the layers add; in the substrate, Fourier integrals.
Residual stresses r_yy, r_xx that do not change along y help each depth (Melan). They move freely
two coordinates of d = [(s_yy + s_xx - 2 s_zz)/sqrt 6, (s_yy - s_xx)/sqrt 2, sqrt 2 s_yz], where
d . d = 2 J2. So the yield stress in shear that is needed is 1/sqrt 2 of the radius of the smallest
ball about all d, their mirror images -d_3, and 0 (derived here). For Tresca in the plane alone,
d = [(s_yy - s_zz)/2, 0, s_yz], and it is the radius itself.
"""

import functools
import itertools
import operator
import sys

import numpy as np
from scipy.interpolate import BarycentricInterpolator, CubicSpline
from scipy.optimize import minimize_scalar
from scipy.special import j1

from common import main
from layered import Body, coat, plane, states
from stress_disc import panels, stresses

NAME, SECONDS = "fatigue/shakedown.json", 80
KEYS = ("shakedown", "shakedown_tresca_in_plane", "first_yield")
DEPTHS = 20  # Chebyshev points through the coat: what the layers add is analytic to z = 2h and -h
ODD = np.array([[0, 0, 1], [1, 1, 0]], bool)  # stresses of the pressure and the traction along y
DEEP = 2.5  # below the surface or the interface, whichever is further down: nothing decides there


def mcewen(y, z):
    """Stresses yy, zz, yz at a depth: of the pressure, and of an equal traction along y."""
    part = 1 - y**2 + z**2
    root = np.hypot(part, 2 * y * z)  # m^2 + n^2
    m = np.sqrt(np.maximum(root + part, 0) / 2)
    n = np.sign(y) * np.sqrt(np.maximum(root - part, 0) / 2)
    over = np.where(root > 0, root, 1)  # at the edge itself m = n = z = 0
    share = (z**2 + n**2) / over
    yy, zz, yz = 2 * z - m * (1 + share), -m * (1 - share), -n * (m**2 - z**2) / over
    return np.array([[yy, zz, yz], [n * (2 - (z**2 - m**2) / over) - 2 * y, yz, yy]])


class Field:
    """Stresses [load, component, y] at a depth; fine < 1: more points, further away."""

    def __init__(self, stack, fine):
        reach, h = 8 / fine, stack.layers[0][0] if stack.layers else 1.0
        near = np.linspace(-3, 3, 2 * round(2100 / fine) + 1)
        far = np.linspace(3, reach, round(400 / fine**2))
        self.y = np.unique([*-far, *near, *far, -1.0, 1.0])
        self.h, self.bare = h, not stack.layers
        if self.bare:
            return
        self.knots = np.linspace(0, reach, int(reach * 24 / (fine * h)))
        self.alpha, weights = panels(40 / h, 1.5 / reach)
        pressure, angle = weights * j1(self.alpha) / self.alpha, np.outer(self.alpha, self.knots)
        self.waves = [pressure[:, None] * f(angle) for f in (np.cos, np.sin)]
        self.base, part = stack.base, stack.layers[0][1:3]
        depths = h * (1 - np.cos(np.pi * np.arange(DEPTHS) / (DEPTHS - 1))) / 2
        pair = [[self.state(body, z) for z in depths] for body in (stack, Body(stack.layers, part))]
        added = np.array([self.transformed(a - b, part) for a, b in zip(*pair, strict=True)])
        self.added = BarycentricInterpolator(depths, added)
        self.top = self.state(stack, h)

    def state(self, stack, z):
        k, cut = stack.cut(z)
        return states(cut, self.alpha)[:, k]

    def transformed(self, state, part):
        """Fourier integrals over the states of both unit tractions, at the knots."""
        (cos, sin), pressed, pulled = self.waves, state[:, :, 0], state[:, :, 1]
        yy, yy2 = stresses(pressed, *part)[0], stresses(pulled, *part)[0]
        normal = [yy @ cos, -pressed[:, 2] @ cos, pressed[:, 3] @ sin]
        return np.array([normal, [yy2 @ sin, -pulled[:, 2] @ sin, -pulled[:, 3] @ cos]])

    def lower(self, z):
        """Integrals in the substrate, where (A + 1)^2 = 0 holds for the states."""
        x = (self.alpha * (z - self.h))[:, None, None]
        slope = np.array(plane(*self.base)) @ self.top + self.top
        return self.transformed(np.exp(-x) * (self.top + x * slope), self.base)

    def at(self, z, below):
        if self.bare:
            return mcewen(self.y, z)
        found = self.lower(z) if below else self.added(z)
        smooth = CubicSpline(self.knots, found, axis=-1)(abs(self.y))
        smooth[ODD] *= np.sign(self.y)
        return smooth if below else smooth + mcewen(self.y, z)


def ball(d):
    """Radius of the smallest ball with its centre in d_3 = 0 about points d [., 3], exactly."""
    flat, square = d[:, :2], (d**2).sum(axis=1)
    held = [int(square.argmax())]
    while True:
        for some in itertools.chain(*(itertools.combinations(held, n) for n in (1, 2, 3))):
            one, n = flat[list(some)], len(some)
            system = np.block([[2 * one @ one.T, np.ones((n, 1))], [np.ones((1, n)), 0.0]])
            weights = np.linalg.lstsq(system, np.append(square[list(some)], 1), rcond=1e-13)[0][:n]
            centre = weights @ one
            off = square - 2 * flat @ centre + centre @ centre
            radius = off[list(some)].min()
            if weights.min() >= -1e-12 and off[held].max() <= radius * (1 + 1e-10):
                break
        if off.max() <= radius * (1 + 1e-10):
            return np.sqrt(radius)
        held = [*some, int(off.argmax())]


def needed(stress, nu):
    """Yield stress in shear to shake down, the same of Tresca in the plane, and of first yield."""
    yy, zz, yz = np.append(stress, np.zeros((3, 1)), axis=1)  # none far away
    xx = nu * (yy + zz)
    d = np.array([(yy + xx - 2 * zz) / 6**0.5, (yy - xx) / 2**0.5, 2**0.5 * yz]).T
    flat = np.array([(yy - zz) / 2, 0 * yy, yz]).T
    return ball(d) / 2**0.5, ball(flat), np.sqrt((d**2).sum(axis=1).max() / 2)


def limits(field, mu, nu, low, high, below):
    """p0/k of KEYS between two depths: the largest needed k, between points first, then there."""

    @functools.cache
    def at(z):
        normal, tangential = field(z, below)
        return needed(normal + mu * tangential, nu)

    depths, found = np.linspace(low, high, 26), {}
    for k, key in enumerate(KEYS):
        best = int(np.argmax([at(z)[k] for z in depths]))
        bracket = depths[max(best - 1, 0)], depths[min(best + 1, 25)]
        peak = minimize_scalar(lambda z, k=k: -at(z)[k], bounds=bracket, options={"xatol": 1e-6})
        found[key] = float(1 / max(at(depths[best])[k], -peak.fun))
    return found


def fill(content, fine=1.0):
    body = operator.itemgetter("E1_over_E2", "h_over_b", "nu")
    for (ratio, h, nu), rows in itertools.groupby(content["cases"], body):
        field = functools.cache(Field(coat(ratio, h, nu) if h else Body([], (1.0, nu)), fine).at)
        for row in rows:
            if h:
                row["coating"] = limits(field, row["mu"], nu, 0.0, h, False)
            row["substrate"] = limits(field, row["mu"], nu, h, h + DEEP, True)


if __name__ == "__main__":
    main(sys.modules[__name__])
