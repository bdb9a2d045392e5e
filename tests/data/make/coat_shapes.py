"""Largest stresses of coats below lines and balls: stacks of layers, on either body or both.

The pressure of a line is a series of Chebyshev polynomials times sqrt(1 - t^2); its coefficients
follow from the response of the bodies by Galerkin's method, whose integrals hold Bessel functions.
Stresses are Fourier integrals. Balls are those of coat_stresses.py, with any number of layers.
Forces of layers are those of an Airy function in each: nothing is shared with layered.py.
"""

import sys

import numpy as np
from scipy.special import j0, j1, jv

import coat_stresses
from coat_stresses import airy_functions, gauss, tension, von_mises
from common import main

NAME, SECONDS = "coat_shapes.json", 600
DEEP, ON_SURFACE = 34.0, 22.0  # wavenumber times depth, or coat, at which integrals end
SUBSTRATE = [210e9, 0.3]
HALF_WIDTH, RADIUS = 100e-6, 10e-3
TERMS = 60, 100  # of the pressure of a line: the last is below 1e-6 of the first; on thin coats
THIN = 0.02
SEEDS = 20261130, 20261201
COUNTS = {
    "line": {"lines": 32, "layers": 16, "counterbodies": 14, "rigid-bases": 8},
    "ball": {"layers": 8, "counterbodies": 7, "rigid-bases": 3},
}
SHARES = np.linspace(0, 1, 5)  # of its thickness, at which a layer is searched


class Stack:
    """Bonded layers (thickness, Young's modulus, Poisson's ratio) on a substrate; None is rigid."""

    def __init__(self, layers, substrate):
        self.layers, self.is_rigid = layers, substrate is None
        self.materials = [tuple(layer[1:]) for layer in layers]
        if not self.is_rigid:
            self.materials.append(tuple(substrate))
        self.thicknesses = [layer[0] for layer in layers]
        self.faces = np.cumsum([0.0, *self.thicknesses])

    @property
    def top(self):
        return self.thicknesses[0] if self.layers else np.inf

    def coefficients(self, s):
        """Of Airy's functions, (wavenumber, function, load): of unit pressure and unit shear."""
        zero, count = np.zeros_like(s), 4 * len(self.layers) + (0 if self.is_rigid else 2)
        system, loads = np.zeros((len(s), count, count)), np.zeros((len(s), count, 2))
        loads[:, 0, 0] = loads[:, 1, 1] = 1
        base = [f[:, :2] for f in airy_functions(zero, zero)]
        uppers = [airy_functions(zero, s * h) for h in self.thicknesses] + [base]
        system[:, 0, : uppers[0][0].shape[1]] = uppers[0][0]
        system[:, 1, : uppers[0][1].shape[1]] = uppers[0][1]
        for i, h in enumerate(self.thicknesses):
            sides = [(1, airy_functions(s * h, zero), i)]
            is_end = self.is_rigid and i + 1 == len(self.layers)
            if not is_end:
                sides.append((-1, uppers[i + 1], i + 1))
            row = 4 * i + 2
            for sign, f, number in sides:
                young, nu = self.materials[number]
                soft = sign * (1 + nu) / young * self.materials[0][0]
                columns = slice(4 * number, 4 * number + f[0].shape[1])
                along = soft * ((1 - nu) * f[2] + nu * f[0])
                normal = soft * ((1 - nu) * f[3] - (2 - nu) * f[1])
                rows = [along, normal] if is_end else [sign * f[0], sign * f[1], along, normal]
                for k, values in enumerate(rows):
                    system[:, row + k, columns] = values
        return np.linalg.solve(system, loads)

    def response(self, s):
        """Wavenumber times normal displacement of a wave of unit pressure."""
        (young, nu), size = self.materials[0], 4 if self.layers else 2
        found = self.coefficients(s)[:, :size, 0]
        top = airy_functions(np.zeros_like(s), s * self.top if self.layers else np.zeros_like(s))
        first, third = (np.einsum("sk,sk->s", top[k][:, :size], found) for k in (1, 3))
        return (1 + nu) / young * ((1 - nu) * third - (2 - nu) * first)

    def place(self, z, number):
        """Return the depth below the upper face of a layer, and its thickness."""
        return z - self.faces[number], self.thicknesses[number]

    def airy(self, s, z, number, coefficients):
        """Airy's function in a layer and its first two derivatives, (wavenumber, load)."""
        depth, h = self.place(z, number)
        parts = airy_functions(s * depth, s * (h - depth))
        found = coefficients[:, 4 * number : 4 * number + 4]
        return [np.einsum("sk,skc->sc", part, found) for part in parts[:3]]

    def twist(self, s, z, number):
        """Shear stresses of a traction across the wave: on planes z, and on planes across it."""
        shears = [young / (2 * (1 + nu)) for young, nu in self.materials]
        up, states = np.zeros_like(s), []
        for i in reversed(range(len(self.layers))):  # rising over falling part at the lower face
            if i + 1 == len(shears):
                lower = -np.ones_like(s)
            else:
                admittance = (1 - up) / (1 + up) * shears[i + 1] / shears[i]
                lower = (1 - admittance) / (1 + admittance)
            decay = np.exp(-s * self.thicknesses[i])
            states.insert(0, (lower, decay))
            up = lower * decay * decay
        falling = 1 / (1 - up)  # stress -1 at the surface
        for i, (lower, decay) in enumerate(states):
            depth, h = self.place(z, i)
            if i == number:
                down = falling * np.exp(-s * depth)
                rise = falling * lower * decay * np.exp(-s * (h - depth))
                return -down + rise, down + rise
            ratio = shears[i + 1] / shears[i]
            at_face = falling * decay * (1 + lower)  # displacement times shear modulus of i
            after = states[i + 1] if i + 1 < len(states) else (0.0, 0.0)
            falling = at_face / (1 + after[0] * after[1] ** 2) * ratio
        raise ValueError(number)

    def waves(self, s, z, number):
        """Stresses of waves, named as those of coat_stresses.waves."""
        f, slope, curvature = self.airy(s, z, number, self.coefficients(s))
        nu = self.materials[number][1]
        plane = {"pL": curvature[:, 0], "pZ": -f[:, 0], "pX": -slope[:, 0]}
        plane |= {"lL": -curvature[:, 1], "lZ": f[:, 1], "lX": -slope[:, 1]}
        across = {k + "T": nu * (plane[k + "L"] + plane[k + "Z"]) for k in "pl"}
        turned = dict(zip(("tY", "tS"), self.twist(s, z, number), strict=True))
        return plane | across | turned


def bare_waves(depth, nu):
    """Stresses in a bare half-space, as `Stack.waves` has them; depth is that times wavenumber."""
    decay = np.exp(-depth)
    wave = {"pL": (depth - 1) * decay, "pZ": -(1 + depth) * decay, "pX": depth * decay}
    wave |= {"lL": (2 - depth) * decay, "lZ": depth * decay, "lX": (depth - 1) * decay}
    wave |= {k + "T": nu * (wave[k + "L"] + wave[k + "Z"]) for k in "pl"}
    return wave | {"tY": -decay, "tS": decay}


def odd_bessel(kappa, count):
    """Bessel functions of the orders 1, 3, 5, ..., a row each."""
    table = np.empty((count, len(kappa)))
    is_low = kappa < 2 * count
    table[:, is_low] = jv(2 * np.arange(count)[:, None] + 1, kappa[is_low])
    high = kappa[~is_low]
    before, here = j0(high), j1(high)
    for n in range(1, 2 * count, 2):
        table[n // 2, ~is_low] = here
        even = 2 * n / high * here - before
        before, here = even, 2 * (n + 1) / high * even - here
    return table


class Line:
    """A contact of half-width a of a parabola of a radius between two bodies."""

    FAR = np.geomspace(3.1, 12, 40)  # coats on stiff layers bend: tension as far as 5 a

    def __init__(self, a, radius, bodies, terms=None):
        self.a, self.bodies = a, bodies
        top = min(body.top for body in bodies)
        terms = terms or TERMS[top < THIN * a]
        end = ON_SURFACE * a / (2 * top) + 10
        edges = np.concatenate([[0], np.geomspace(1e-3, 1, 16), np.arange(2, end + 1)])
        kappa, w = gauss(edges, 6)
        surfaces = [body.materials[0] for body in bodies]
        shortest = sum(2 * (1 - nu * nu) / young for young, nu in surfaces)
        excess = sum(body.response(kappa / a) for body in bodies) / shortest - 1
        orders, signs = 2 * np.arange(terms) + 1, (-1.0) ** np.arange(terms)
        waves = odd_bessel(kappa, terms)
        system = (waves * (excess * w / kappa)) @ waves.T
        system = signs[:, None] * system * signs + np.diag(1 / (2 * orders))
        right = np.zeros(terms)
        right[0] = a / (2 * radius * shortest)
        self.c = np.linalg.solve(system, right) / orders
        self.orders, self.signs = orders, signs
        self.load = a * np.pi / 2 * self.c[0]
        self.p0 = float(self.signs @ self.c)

    def transform(self, kappa):
        """Transform of the pressure at wavenumbers kappa / a."""
        weights = self.c * self.signs * self.orders
        return np.pi * self.a * (weights @ odd_bessel(kappa, len(weights))) / kappa

    def half_space(self, x, z):
        """In-plane stresses xx, zz, xz of a bare half-space, of the pressure and its traction."""
        place = (np.asarray(x) + 1j * z) / self.a
        root = np.sqrt(place - 1) * np.sqrt(place + 1)
        powers = (place - root)[:, None] ** self.orders
        total = powers @ self.c
        slope = -(powers @ (self.c * self.orders)) / np.where(root == 0, 1, root) * (z / self.a)
        pressed = [total.imag + slope.real, total.imag - slope.real, -slope.imag]
        return pressed, [-2 * total.real + slope.imag, -slope.imag, pressed[0]]

    def stress(self, member, x, z, number, friction):
        """In-plane xx and zz, yy along the line, and xz: in a layer of a body."""
        x = np.asarray(x)
        is_far = abs(x) > 3 * self.a
        if is_far.any() and not is_far.all():  # far places need closer wavenumbers
            both = np.empty((4, len(x)))
            for part in (is_far, ~is_far):
                both[:, part] = self.stress(member, x[part], z, number, friction)
            return both
        body = self.bodies[member]
        nu = body.materials[number][1]
        end = DEEP / max(z, body.top)
        reach = 12 if is_far.any() else 3
        ends = np.linspace(0, end, int(np.ceil(end * self.a * (1 + reach) / 8)) + 1)
        s, w = gauss([0, *np.geomspace(1e-4, 1, 8) * ends[1], *ends[2:]], 6)
        wave = body.waves(s, z, number)
        if number == 0:
            bare = bare_waves(s * z, nu)
            wave = {key: value - bare[key] for key, value in wave.items()}
        weights = w / np.pi * self.transform(s * self.a)
        wave = {key: value * weights for key, value in wave.items()}
        total = np.zeros((3, len(x)))
        distances, which = np.unique(abs(x), return_inverse=True)
        for part in np.array_split(np.arange(len(s)), len(s) // 4000 + 1):
            phase = s[part, None] * distances
            even, odd = np.cos(phase)[:, which], np.sin(phase)[:, which] * np.sign(x)
            get = {key: value[part] for key, value in wave.items()}
            total[0] += get["pL"] @ even - friction * (get["lL"] @ odd)
            total[1] += get["pZ"] @ even - friction * (get["lZ"] @ odd)
            total[2] += -(get["pX"] @ odd) + friction * (get["lX"] @ even)
        if number == 0:
            pressed, rubbed = self.half_space(x, z)
            total += np.array(pressed) + friction * np.array(rubbed)
        return np.array([total[0], nu * (total[0] + total[1]), total[1], total[2]])


class Ball(coat_stresses.Ball):
    """A contact of radius a of a ball of a radius between two bodies."""

    FAR = ()

    def __init__(self, a, radius, bodies):
        self.bodies = bodies
        super().__init__(a, min(body.top for body in bodies), None, radius)
        self.p0 = float(self.pressure([0.0])[0])

    def modulus(self):
        surfaces = [body.materials[0] for body in self.bodies]
        self.shortest = sum(2 * (1 - nu * nu) / young for young, nu in surfaces)
        return 2 / self.shortest

    def excess(self, kappa):
        return sum(body.response(kappa / self.h) for body in self.bodies) / self.shortest - 1

    def waves(self, s, z, below):
        return self.body.waves(s, z, self.number)

    def stress(self, member, x, z, number, friction):
        """xx, yy, zz, xz at y = 0 in a layer of a body."""
        self.body, self.number = self.bodies[member], number
        self.materials, shortest = self.body.materials, self.h
        self.h = self.body.top
        found = super().stress(np.asarray(x), z, friction, below=number > 0)
        self.h = shortest
        return found


def places(thickness, far):
    """Coordinates over the half-width: to a thousandth of the thickness towards the edge."""
    least = 1e-3 * thickness
    inside, outside = -np.geomspace(0.3, least, 40), np.geomspace(least, 0.4, 40)
    edge = 1 + np.concatenate([inside, [0], outside])
    return np.concatenate([np.linspace(1e-3, 0.68, 30), edge, np.linspace(1.45, 3, 18), far])


def shear(stress):
    return abs(stress[3])


QUANTITIES = {"tension": tension, "von_mises": von_mises, "interface_shear": shear}


def largest(contact, member, number, friction):
    """Find the largest stresses in a layer, among depths that are `SHARES` of its thickness."""
    body, a = contact.bodies[member], contact.a
    above, h = body.faces[number], body.thicknesses[number]
    x = a * places(body.top / a, contact.FAR)
    x = np.concatenate([-x[::-1], x])
    best = dict.fromkeys(QUANTITIES, (-np.inf, 0, 0.0))
    for share in SHARES:
        z = above + share * h
        stress = contact.stress(member, x, z, number, friction)
        for name, quantity in QUANTITIES.items():
            if name != "interface_shear" or share == 1:
                values = quantity(stress)
                k = int(values.argmax())
                best[name] = max(best[name], (float(values[k]), k, z))
    for name, (value, k, z) in best.items():  # a closer look between the neighbours
        closer = np.linspace(x[max(k - 1, 0)], x[min(k + 1, len(x) - 1)], 9)
        top = QUANTITIES[name](contact.stress(member, closer, z, number, friction)).max()
        best[name] = float(f"{max(value, top):.6g}")
    return best


def extremes(contact, friction):
    """Find the largest stresses of all layers of both bodies, by name."""
    return {
        f"{name} {number}": largest(contact, member, number, friction)
        for member, name in enumerate(("body", "counterbody")[: len(contact.bodies)])
        for number in range(len(contact.bodies[member].layers))
    }


def drawn_layers(random, count, total, substrate=SUBSTRATE):
    """Draw layers of a total thickness, none thinner than a fifth of their mean."""
    shares = random.uniform(0.2, 1.0, count)
    thicknesses = total * shares / shares.sum()
    rows = []
    for h in thicknesses:
        young = substrate[0] * np.exp(random.uniform(*np.log([0.3, 3.0])))
        rows.append([float(f"{h:.4g}"), float(f"{young:.4g}"), round(random.uniform(0.2, 0.35), 3)])
    return rows


def thickness(random, thinnest=0.005):
    """Draw a total thickness, of which the logarithm is uniform."""
    return HALF_WIDTH * np.exp(random.uniform(np.log(thinnest), np.log(0.3)))


def drawn(kind, counts, seed):
    """Draw inputs: layers (thickness, Young's modulus, Poisson's ratio) of both bodies.

    A counterbody is rigid where it is None; without layers it is bare.
    """
    random = np.random.default_rng(seed)
    for family, count in counts.items():
        for _ in range(count):
            layers, counter = int(random.integers(2, 4)) if family == "layers" else 1, None
            is_rigid = family == "rigid-bases"
            rows = drawn_layers(random, layers, thickness(random, 0.02 if is_rigid else 0.005))
            if family == "counterbodies":
                counter = drawn_layers(random, int(random.integers(1, 3)), thickness(random))
                if random.random() < 0.4:
                    rows = []
            friction = float(random.choice([0, 0.1, 0.3]))
            case = {"contact": kind, "family": family, "layers": rows, "counter": counter}
            case |= {"substrate": None if is_rigid else SUBSTRATE, "friction": friction}
            yield case | {"half_width": HALF_WIDTH, "radius": RADIUS}


def fill(content):
    content["cases"] = [
        case
        for seed, (kind, counts) in zip(SEEDS, COUNTS.items(), strict=True)
        for case in drawn(kind, counts, seed)
    ]
    for number, case in enumerate(content["cases"]):
        bodies = [Stack(case["layers"], case["substrate"])]
        if case["counter"] is not None:
            bodies.append(Stack(case["counter"], SUBSTRATE))
        kind = Line if case["contact"] == "line" else Ball
        contact = kind(case["half_width"], case["radius"], bodies)
        case |= {"id": number, "load": float(contact.load), "p0": float(contact.p0)}
        case["extremes"] = extremes(contact, case["friction"])


if __name__ == "__main__":
    main(sys.modules[__name__])
