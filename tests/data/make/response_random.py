"""Reference values of the surface compliances of random layered half-spaces.

Claim: every number in ``response_random.json`` is the correctly rounded double
(to within one unit in the last place) of the surface compliance of the stack
whose moduli, Poisson's ratios, thicknesses and wavenumber are exactly the
doubles written in the file.  A c12 that is smaller than 1e-30 sqrt(c11 c22) is
written as 0.

Method: no recursion, no layer matrices.  Each layer carries the four in-plane
potentials of Boussinesq and Papkovich,

    2 G u = grad(phi),      2 G u = (3 - 4 nu) psi e_z - z grad(psi),

with phi, psi proportional to exp(-alpha z) and exp(+alpha z), and two
exponentials for the twist; the substrate carries the decaying ones only.  The
conditions at the surface and at all interfaces form one linear system, solved
in ball arithmetic (Arb), which returns a proven bound of the error; the
precision is doubled until that bound is below 1e-25.

Convention, z into the body, rotated frame (L along the wave vector, T across):
u_z = W, u_L = i V, sigma_zz = -P, sigma_Lz = -i TAU, u_T = U, sigma_Tz = -Q;
at the surface (W, V) = [[c11, c12], [c12, c22]] (P, TAU) and U = ct Q.

Needs python-flint.  Run: python tests/data/make/response_random.py
"""

import math
import random
import sys

from common import main
from flint import acb, acb_mat, arb, arb_mat, ctx

TOLERANCE = 1e-25  # proven relative error demanded of each compliance
NEGLIGIBLE = 1e-30  # c12 / sqrt(c11 c22) below which c12 is written as 0


def shear_modulus(body):
    return arb(body["young"]) / (2 * (1 + arb(body["poisson"])))


def in_plane_columns(nu, y, decaying, decay):
    """(2 G alpha W, 2 G alpha V, sigma_zz, sigma_Lz / i) of the two potentials.

    y is alpha times the distance below the plane where the exponential is 1,
    and decay is the value of the exponential.
    """
    s = -1 if decaying else 1
    phi = (s * decay, decay, decay, s * decay)
    psi = (
        (3 - 4 * nu - s * y) * decay,
        -y * decay,
        (2 * s * (1 - nu) - y) * decay,
        (1 - 2 * nu - s * y) * decay,
    )
    return phi, psi


def plane_states(layers, substrate, alpha):
    """For each body its in-plane and twist states (W, V, sigma_zz, S) at top and bottom.

    A state is a list of columns, one for each unknown of the body.
    """
    bodies = []
    for body in layers + ([substrate] if substrate else []):
        nu, g = arb(body["poisson"]), shear_modulus(body)
        half_space = "thickness" not in body
        x = 0 if half_space else alpha * arb(body["thickness"])
        one, far = alpha / alpha, (0 if half_space else (-x).exp())
        flexibility = 1 / (2 * g * alpha)

        def physical(columns):
            return [(w * flexibility, v * flexibility, n, t) for w, v, n, t in columns]

        top = list(in_plane_columns(nu, 0 * one, True, one))
        bottom = [] if half_space else list(in_plane_columns(nu, x, True, far))
        twist_top = [(1 / (g * alpha), -one)]  # (U, sigma_Tz)
        twist_bottom = [] if half_space else [(far / (g * alpha), -far)]
        if not half_space:
            top += in_plane_columns(nu, -x, False, far)
            bottom += in_plane_columns(nu, 0 * one, False, one)
            twist_top.append((far / (g * alpha), far))
            twist_bottom.append((one / (g * alpha), one))
        bodies.append((physical(top), physical(bottom), twist_top, twist_bottom))
    return bodies


def assemble(tops, bottoms, interfaces, displacements, rigid):
    """Rows of the system: surface tractions first, then each interface.

    The leading `displacements` entries of a state are displacements, the rest
    the tractions on the same axes; axis 0 is the normal in the in-plane case,
    where there are two axes, and the only axis is tangential in the twist.
    """
    starts = [sum(len(t) for t in tops[:j]) for j in range(len(tops) + 1)]
    size = starts[-1]
    rows = []

    def row(*terms):
        line = [0] * size
        for body, columns, entry, sign in terms:
            for k, column in enumerate(columns):
                line[starts[body] + k] = sign * column[entry]
        rows.append(line)

    for axis in range(displacements):
        row((0, tops[0], displacements + axis, 1))
    for j, interface in enumerate(interfaces):
        below = None if rigid and j == len(interfaces) - 1 else tops[j + 1]
        for axis in range(displacements):
            tangential = axis == displacements - 1
            u, t = axis, displacements + axis
            if tangential and interface == "frictionless":
                row((j, bottoms[j], t, 1))
                if below:
                    row((j + 1, below, t, 1))
            else:
                row(*[(j, bottoms[j], u, 1)] + ([(j + 1, below, u, -1)] if below else []))
                if below:
                    row((j, bottoms[j], t, 1), (j + 1, below, t, -1))
    return rows


def solve(rows, loads):
    matrix = acb_mat if any(isinstance(a, acb) for line in rows for a in line) else arb_mat
    rhs = [[load[i] if i < len(load) else 0 for load in loads] for i in range(len(rows))]
    return matrix(rows).solve(matrix(rhs))


def compliances(layers, substrate, alpha, twist=True):
    """(c11, c12, c22, ct) as balls; alpha an arb, or an acb for the analytic continuation."""
    bodies = plane_states(layers, substrate, alpha)
    interfaces = [layer["interface"] for layer in layers]
    rows = assemble([b[0] for b in bodies], [b[1] for b in bodies], interfaces, 2, not substrate)
    # Unit P: sigma_zz = -1.  Unit TAU: sigma_Lz / i = -1.
    x = solve(rows, [(-1, 0), (0, -1)])
    top = bodies[0][0]
    c11, c21 = (sum(top[k][axis] * x[k, 0] for k in range(len(top))) for axis in (0, 1))
    c12, c22 = (sum(top[k][axis] * x[k, 1] for k in range(len(top))) for axis in (0, 1))
    if not (c12 - c21).contains(0):
        raise ArithmeticError("the compliance is not symmetric")
    if not twist:
        return c11, c12, c22
    rows = assemble([b[2] for b in bodies], [b[3] for b in bodies], interfaces, 1, not substrate)
    x = solve(rows, [(-1,)])
    ct = sum(bodies[0][2][k][0] * x[k, 0] for k in range(len(bodies[0][2])))
    return c11, c12, c22, ct


def certified_row(layers, substrate, wavenumber):
    bits = 400
    while bits <= 12800:
        ctx.prec = bits
        bits *= 2
        try:
            c11, c12, c22, ct = compliances(layers, substrate, arb(wavenumber))
        except ZeroDivisionError:  # the matrix ball contains a singular matrix
            continue
        scale = (c11 * c22).sqrt()
        if bool(abs(c12) < NEGLIGIBLE * scale):
            c12 = arb(0)
        if all(bool(c.rad() <= TOLERANCE * abs(c.mid())) for c in (c11, c12, c22, ct)):
            values = (float(c.mid()) for c in (c11, c12, c22, ct))
            return {"wavenumber": wavenumber} | dict(zip(("c11", "c12", "c22", "ct"), values))
    raise ArithmeticError(f"no certified value: {layers} {substrate} {wavenumber}")


def rounded(value, digits=5):
    return float(f"{value:.{digits - 1}e}")


def random_poisson(rng):
    return rng.choice([0.0, 0.3, 0.5, 0.499] + 5 * [round(rng.uniform(0, 0.5), 4)])


def random_young(rng):
    return rounded(10 ** rng.uniform(-2, 2))


def random_stack(rng, count):
    kind = rng.random()
    layers = []
    for _ in range(count):
        slip = rng.random() < (0.25 if kind < 0.4 else 0)
        layers.append(
            {
                "young": random_young(rng),
                "poisson": random_poisson(rng),
                "thickness": rounded(10 ** rng.uniform(-2, 2)),
                "interface": "frictionless" if slip else "bonded",
            }
        )
    rigid = rng.random() < 0.25
    return layers, None if rigid else {"young": random_young(rng), "poisson": random_poisson(rng)}


def deliberate_stacks():
    """Corners that chance would miss."""

    def layer(young, poisson, thickness, interface="bonded"):
        return {"young": young, "poisson": poisson, "thickness": thickness, "interface": interface}

    def base(young, poisson):
        return {"young": young, "poisson": poisson}

    yield [layer(1.0, 0.3, 1.0)], base(1.0, 0.3)  # homogeneous
    yield [layer(1.0, 0.5, 1.0), layer(1.0, 0.5, 10.0)], base(1.0, 0.5)  # c12 = 0
    yield [layer(100.0, 0.0, 1.0)], base(0.01, 0.5)
    yield [layer(0.01, 0.5, 1.0)], base(100.0, 0.0)
    yield [layer(1.0, 0.5, 1.0)], None
    yield [layer(1.0, 0.0, 1.0)], None
    yield [layer(1.0, 0.5, 1.0, "frictionless")], None  # lubricated rigid base
    yield [layer(1.0, 0.3, 1.0, "frictionless")], None
    yield [layer(4.0, 0.3, 1.0, "frictionless")], base(1.0, 0.3)
    yield [layer(0.01, 0.5, 1.0, "frictionless")], base(100.0, 0.5)
    yield [layer(100.0, 0.5, 0.01), layer(0.01, 0.5, 100.0)], None
    yield [layer(0.01, 0.5, 0.01), layer(100.0, 0.0, 0.01)] * 3, base(1.0, 0.3)
    # a plate free to slide on both faces
    yield [layer(1.0, 0.3, 1.0, "frictionless"), layer(2.0, 0.4, 0.5, "frictionless")], base(1.0, 0.2)


def wavenumbers(rng, layers):
    """alpha h_min over 1e-8 .. 1e4, half of them where the response varies."""
    thinnest = min(layer["thickness"] for layer in layers)
    thickest = max(layer["thickness"] for layer in layers)
    exponents = [rng.uniform(-8, -3), rng.uniform(1, 4)][: 1 + (rng.random() < 0.4)]
    low, high = -3 - math.log10(thickest / thinnest), 1.2
    exponents += [rng.uniform(max(low, -8), high) for _ in range(3)]
    return [rounded(10**e / thinnest) for e in sorted(exponents)]


NAME, SECONDS = "response_random.json", 60


def fill(content):
    rng = random.Random(20240611)
    stacks = list(deliberate_stacks()) + [random_stack(rng, 1 + k % 6) for k in range(72)]
    content["cases"] = []
    for layers, substrate in stacks:
        rows = [certified_row(layers, substrate, a) for a in wavenumbers(rng, layers)]
        content["cases"].append({"layers": layers, "substrate": substrate, "rows": rows})


if __name__ == "__main__":
    main(sys.modules[__name__])
