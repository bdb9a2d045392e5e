"""Largest stresses of a coat below a rigid ball that slides: coat_stresses.json.

The pressure of a paraboloid on one bonded coat is integral_r^a g(t)/sqrt(t^2 - r^2) dt. Fredholm's
equation for g is solved by Nystroem's method; stresses of the pressure and of the traction
friction * pressure along x are Hankel integrals in the plane y = 0, where all are largest. At the
surface, those of a half-space of the coat are added in closed form. Forces of layers are those of
an Airy function in each: nothing is shared with layered.py and axisym.py.
"""

import sys

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import j0, j1

from common import main

NAME, SECONDS = "coat_stresses.json", 240
ON_SURFACE, DEEP = 22.0, 34.0  # wave units at which integrals end: exp(-22) of what layers add
THIN = 0.15  # thickness over contact radius below which three depths hold von Mises' extreme
SEED, BALLS = 20261129, 24


def gauss(edges, order):
    x, w = np.polynomial.legendre.leggauss(order)
    edges = np.asarray(edges)
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    return (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


def airy_functions(depth, below):
    """Four solutions exp(-depth), exp(-below) with their derivatives: of order 0 to 3."""
    down, up, y = np.exp(-depth), np.exp(-below), -below
    return [
        np.stack(rows, -1)
        for rows in (
            (down, depth * down, up, y * up),
            (-down, (1 - depth) * down, up, (1 + y) * up),
            (down, (depth - 2) * down, up, (2 + y) * up),
            (-down, (3 - depth) * down, up, (3 + y) * up),
        )
    ]


def airy_coefficients(kappa, materials):
    """Of coat (4) and substrate (2), of unit pressure and unit shear; kappa is wavenumber * h."""
    (young1, nu1), (young2, nu2) = materials
    soft = (1 + nu2) / young2 / ((1 + nu1) / young1)
    zero = np.zeros_like(kappa)
    top, bottom = airy_functions(zero, kappa), airy_functions(kappa, zero)
    base = [np.array(rows) for rows in ((1.0, 0.0), (-1.0, 1.0), (1.0, -2.0), (-1.0, 3.0))]
    system = np.zeros((*kappa.shape, 6, 6))
    system[..., 0, :4], system[..., 1, :4] = top[0], top[1]
    for k in (0, 1):  # tractions
        system[..., 2 + k, :4], system[..., 2 + k, 4:] = bottom[k], -base[k]
    system[..., 4, :4] = (1 - nu1) * bottom[2] + nu1 * bottom[0]  # displacements
    system[..., 4, 4:] = -soft * ((1 - nu2) * base[2] + nu2 * base[0])
    system[..., 5, :4] = (1 - nu1) * bottom[3] - (2 - nu1) * bottom[1]
    system[..., 5, 4:] = -soft * ((1 - nu2) * base[3] - (2 - nu2) * base[1])
    loads = np.zeros((*kappa.shape, 6, 2))
    loads[..., 0, 0] = loads[..., 1, 1] = 1
    return np.linalg.solve(system, loads)


def twist(s, h, materials, z, below):
    """Shear stresses of a traction across the wave: on planes z, and on planes across the wave."""
    shear1, shear2 = (young / (2 * (1 + nu)) for young, nu in materials)
    ratio, decay = shear2 / shear1, np.exp(-s * h)
    back = decay * (1 - ratio) / (1 + ratio)
    down = 1 / (1 - back * decay)
    up = back * down
    if below:
        passed = ratio * (down * decay + up) * np.exp(-s * (z - h))
        return -passed, passed
    falls, rises = np.exp(-s * z), np.exp(s * (z - h))
    return -down * falls + up * rises, down * falls + up * rises


def waves(s, h, materials, z, below):
    """Stresses at depth z of waves of pressure (p), of traction along (l) and across (t)."""
    coefficients = airy_coefficients(s * h, materials)
    if below:
        parts = [f[:, :2] for f in airy_functions(s * (z - h), np.zeros_like(s))]
        coefficients = coefficients[:, 4:]
    else:
        parts = airy_functions(s * z, s * (h - z))
        coefficients = coefficients[:, :4]
    f, slope, curvature = (np.einsum("sk,skc->sc", part, coefficients) for part in parts[:3])
    nu = materials[1 if below else 0][1]
    plane = {"pL": curvature[:, 0], "pZ": -f[:, 0], "pX": -slope[:, 0]}
    plane |= {"lL": -curvature[:, 1], "lZ": f[:, 1], "lX": -slope[:, 1]}
    across = {k + "T": nu * (plane[k + "L"] + plane[k + "Z"]) for k in "pl"}
    turned = dict(zip(("tY", "tS"), twist(s, h, materials, z, below), strict=True))
    return plane | across | turned


class Ball:
    """A contact of radius a between a rigid ball and a coat of thickness h."""

    def __init__(self, a, h, materials, radius):
        self.a, self.h, self.materials = a, h, materials
        self.panel = min(h, a / 16)
        modulus = self.modulus()
        kernel = self.kernel()
        ends = np.linspace(0, a, int(np.ceil(a / self.panel)) + 1)
        ends = np.concatenate([ends[:-2], np.linspace(ends[-3], a, 9)[1:]])
        t, w = gauss(ends, 6)

        def between(x):
            return (kernel(abs(x - t) / h) - kernel((x + t) / h)) / (np.pi * h) * w

        slope = 2 * modulus / (np.pi * radius)
        g = np.linalg.solve(np.eye(len(t)) + between(t[:, None]), slope * t)
        at_edge = slope * a - between(a) @ g
        self.t, self.gw = t, g * w
        self.density = CubicSpline([0, *t, a], [0, *g, at_edge])
        self.load = 2 * np.pi * self.gw @ t

    def modulus(self):
        """Contact modulus of short waves, E / (1 - nu^2) of the coat."""
        young, nu = self.materials[0]
        return young / (1 - nu**2)

    def excess(self, kappa):
        """Return what the substrate adds to the response of a coat; kappa is wavenumber * h."""
        nu = self.materials[0][1]
        top = airy_functions(np.zeros_like(kappa), kappa)
        first, third = (
            np.einsum("sk,sk->s", top[k], airy_coefficients(kappa, self.materials)[:, :4, 0])
            for k in (1, 3)
        )
        return ((1 - nu) * third - (2 - nu) * first) / (2 * (1 - nu)) - 1

    def waves(self, s, z, below):
        """Stresses at depth z of waves of pressure and traction."""
        return waves(s, self.h, self.materials, z, below)

    def kernel(self):
        """Cosine transform of the excess."""
        far = 2.05 * self.a / self.h
        fine = np.linspace(2, 25, max(600, int(23 * far / 5)))
        kappa, w = gauss([*np.linspace(0, 2, 451), *fine[1:]], 6)
        excess = self.excess(kappa)
        x = np.concatenate([np.linspace(0, 20, 1201), np.geomspace(20, max(40, far), 800)[1:]])
        return CubicSpline(x, [np.cos(kappa * each) @ (excess * w) for each in x])

    def pressure(self, r):
        values = np.zeros(len(r))
        for k, x in enumerate(r):
            if x < self.a:
                chord = np.sqrt(self.a**2 - x**2)
                v, w = gauss(np.linspace(0, chord, max(40, int(4 * chord / self.panel)) + 1), 4)
                t = np.sqrt(x * x + v * v)
                values[k] = w @ (self.density(np.minimum(t, self.a)) / t)
        return values

    def transform(self, s):
        blocks = np.array_split(s, len(s) // 2000 + 1)
        return np.concatenate([np.sin(part[:, None] * self.t) @ self.gw / part for part in blocks])

    def stress(self, x, z, friction, below=False):
        """xx, yy, zz, xz at y = 0."""
        r, sign = abs(x), np.where(x < 0, -1.0, 1.0)
        end = ON_SURFACE / self.h if z == 0 else DEEP / max(z, self.h if below else 0)
        count = int(np.ceil(end * self.a / 2))
        ends = np.linspace(0, end, count + 1)
        s, w = gauss([0, *np.geomspace(1e-4, 1, 6) * ends[1], *ends[2:]], 6)
        wave = self.waves(s, z, below)
        if z == 0:
            nu = self.materials[0][1]
            half_space = {"pL": -1, "pT": -2 * nu, "pZ": -1, "pX": 0, "lL": 2, "lT": 2 * nu}
            half_space |= {"lZ": 0, "lX": -1, "tY": -1, "tS": 1}
            wave = {key: value - half_space[key] for key, value in wave.items()}
        weights = s * w * self.transform(s)
        pressed, rubbed = np.zeros((2, 4, len(x)))
        for part in np.array_split(np.arange(len(s)), len(s) // 4000 + 1):
            pair = hankel({k: v[part] * weights[part] for k, v in wave.items()}, s[part, None] * r)
            pressed, rubbed = pressed + pair[0], rubbed + pair[1]
        if z == 0:
            for k in np.flatnonzero(r):
                pair = self.half_space(r[k])
                pressed[:, k], rubbed[:, k] = pressed[:, k] + pair[0], rubbed[:, k] + pair[1]
        odd = np.array([sign, sign, sign, np.ones_like(sign)])
        return pressed * odd * sign + friction * rubbed * odd

    def half_space(self, r):
        """Stresses on the surface of a half-space of the coat, of the pressure and its traction."""
        nu = self.materials[0][1]
        (p,) = self.pressure([r])
        inside = self.gw @ (self.t - np.sqrt(np.maximum(self.t**2 - r * r, 0)))
        second = 2 * inside / r**2 - p
        mean, half = -(1 + 2 * nu) / 2 * p, -(1 - 2 * nu) / 2 * second
        top = np.arcsin(min(1.0, self.a / r))
        share = np.linspace(0, 1, 201 if self.h > 0.02 * self.a else 1601)
        angle, w = gauss(top * (1 - (1 - share) ** 2 if r >= self.a else share), 5)
        density = self.density(np.minimum(r * np.sin(angle), self.a)) * w
        first, third = density @ np.sin(angle), density @ np.sin(3 * angle)
        cubed, mixed = (third - 3 * first) / 4, -(first + third) / 4
        pressed = [mean - half, mean + half, -p, 0]
        along = 2 * cubed + (2 * nu + 2) * mixed
        return pressed, [along, 2 * mixed + 2 * nu * cubed - 2 * mixed, 0, -p]


def hankel(wave, q):
    """Stresses of pressure and of traction, from weighted waves; q is wavenumber times radius."""
    zeroth, first = j0(q), j1(q)
    second = np.where(q > 1e-3, 2 * first / np.where(q > 1e-6, q, 1) - zeroth, q * q / 8)
    third = np.where(q > 0.05, 4 * second / np.where(q > 1e-6, q, 1) - first, q**3 / 48)
    mean, half = (wave["pL"] + wave["pT"]) / 2, (wave["pL"] - wave["pT"]) / 2
    pressed = [mean @ zeroth - half @ second, mean @ zeroth + half @ second]
    pressed += [wave["pZ"] @ zeroth, -wave["pX"] @ first]
    cubed, mixed = (third - 3 * first) / 4, -(first + third) / 4
    rubbed = [wave["lL"] @ cubed + (wave["lT"] + 2 * wave["tS"]) @ mixed]
    rubbed += [wave["lL"] @ mixed + wave["lT"] @ cubed - 2 * wave["tS"] @ mixed]
    rubbed += [-wave["lZ"] @ first]
    rubbed += [(wave["lX"] @ (zeroth - second) + wave["tY"] @ (zeroth + second)) / 2]
    return np.array(pressed), np.array(rubbed)


def von_mises(stress):
    xx, yy, zz, xz = stress
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xz**2)


def tension(stress):
    """Largest principal stress."""
    xx, yy, zz, xz = stress
    return np.maximum(yy, (xx + zz) / 2 + np.hypot((xx - zz) / 2, xz))


def places(ball, friction):
    """Coordinates x, dense at the edges: to a thousandth of h. Without friction, one side."""
    least = 1e-3 * min(1, ball.h / ball.a)
    inside, outside = -np.geomspace(0.3, least, 36), np.geomspace(least, 0.4, 36)
    edge = 1 + np.concatenate([inside, [0], outside])
    x = ball.a * np.concatenate([np.linspace(1e-3, 0.68, 24), edge, np.linspace(1.45, 3.5, 22)])
    return np.concatenate([-x[::-1], x]) if friction else x


def highest(ball, friction, z, quantity):
    """Find the largest value at a depth, and its place."""
    x = places(ball, friction)
    values = quantity(ball.stress(x, z, friction))
    best = int(values.argmax())
    return float(values[best]), float(x[best])


def apex(values, k):
    """Top of the parabola through a value and its neighbours; at an end, the value."""
    if not 0 < k < len(values) - 1:
        return values[k]
    low, top, high = values[k - 1 : k + 2]
    return top + (high - low) ** 2 / (8 * (2 * top - high - low))


def below_coat(ball, friction):
    """Largest von Mises stress of the substrate."""
    inner = np.linspace(-0.7, 0.7, 29)
    x = np.array([*inner, -1.01, -1.0, -0.97, 0.97, 1.0, 1.01]) * ball.a
    tops = []
    for depth in (0.0, *np.linspace(0.02, 0.9, 23)):
        values = von_mises(ball.stress(x, ball.h + depth * ball.a, friction, below=True))
        k = int(values.argmax())
        tops.append(apex(values[: len(inner)], k) if k < len(inner) else values[k])
    return float(apex(tops, int(np.argmax(tops))))


def drawn():
    """Draw inputs of random balls: logarithms of thickness and modulus are uniform."""
    random = np.random.default_rng(SEED)
    for k in range(BALLS):
        thin, soft = np.log([0.005, 0.3]), np.log([0.2, 4.0])
        thickness = float(f"{69e-6 * np.exp(random.uniform(*thin)):.4g}")
        young = float(f"{210e9 * np.exp(random.uniform(*soft)):.4g}")
        nu, friction = round(random.uniform(0.2, 0.35), 3), float(random.choice([0, 0.1, 0.3]))
        yield {
            "id": 100 + k,
            "radius": 5e-3,
            "contact_radius": 69e-6,
            "thickness": thickness,
            "coat": [young, nu],
            "substrate": [210e9, 0.3],
            "friction": friction,
        }


def fill(content):
    content["random"] = list(drawn())
    for case in content["cases"] + content["random"]:
        a, h, friction = case["contact_radius"], case["thickness"], case["friction"]
        ball = Ball(a, h, (case["coat"], case["substrate"]), case["radius"])
        depths = (0.0, h / 2, h)
        pulled = max(highest(ball, friction, z, tension) for z in depths)
        strained = max(highest(ball, friction, z, von_mises) for z in depths)
        sheared = highest(ball, friction, h, lambda stress: abs(stress[3]))
        pressed = highest(ball, friction, h, lambda stress: -stress[2])
        case |= {
            "load": float(ball.load),
            "p0": float(ball.pressure([0.0])[0]),
            "coat_tension": pulled[0],
            "coat_tension_x_over_a": pulled[1] / a,
            "coat_von_mises": strained[0] if h < THIN * a else None,
            "interface_shear": sheared[0],
            "interface_shear_x_over_a": sheared[1] / a,
            "interface_compression": pressed[0],
            "substrate_von_mises": below_coat(ball, friction),
        }


if __name__ == "__main__":
    main(sys.modules[__name__])
