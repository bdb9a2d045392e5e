"""Reference values of layers on springs and of plates with a free base.

Method: no recursion, no layer matrices. Each layer carries the in-plane potentials of Boussinesq
and Papkovich, 2 G u = grad(phi) and 2 G u = (3 - 4 nu) psi e_z - z grad(psi), with phi and psi
proportional to exp(-alpha z) and exp(+alpha z), and two exponentials for the twist; a substrate
carries the decaying ones only. The conditions at the surface, at the interfaces and at the lower
face form one dense linear system, solved with 120 digits by mpmath: the long waves of a plate lose
four powers of alpha h. An interface passes the tractions, and the displacement of its upper side
less that of the lower one is the traction over the stiffness. Derivatives are central differences
of a relative step of 1e-30, good to some 50 digits.

Convention as in response_random.py: u_z = W, u_L = i V, sigma_zz = -P, sigma_Lz = -i TAU,
u_T = U, sigma_Tz = -Q; at the surface (W, V) = [[c11, c12], [c12, c22]] (P, TAU) and U = ct Q.
"""

import copy
import sys

from mpmath import exp, lu_solve, matrix, mp, mpf, zeros

from common import main

mp.dps = 120
NAME, SECONDS = "springs.json", 60


def columns(nu, g, alpha, depth, sign):
    """States (W, V, P, TAU) of phi and psi at a depth below the plane where they are 1."""
    y, e = alpha * depth, exp(sign * alpha * depth)
    phi = (sign, 1, -1, -sign)
    psi = (3 - 4 * nu - sign * y, -y, -(2 * sign * (1 - nu) - y), -(1 - 2 * nu - sign * y))
    scale = 1 / (2 * g * alpha)
    return [[w * e * scale, v * e * scale, p * e, t * e] for w, v, p, t in (phi, psi)]


def twists(g, alpha, depth, sign):
    """State (U, Q) of a twist."""
    e = exp(sign * alpha * depth)
    return [[e / (g * alpha), -sign * e]]


def solved(body, alpha, axes):
    """States on top of the body under each unit traction; axes: 2 in the plane, 1 for the twist."""
    states, count = [], 0
    parts = body["layers"] + ([body["substrate"]] if isinstance(body["substrate"], dict) else [])
    for part in parts:
        nu, g = part["poisson"], part["young"] / (2 * (1 + part["poisson"]))
        h, signs = part.get("thickness"), (-1,) if "thickness" not in part else (-1, 1)

        def at(z):
            made = []
            for sign in signs:
                # Growing ones are 1 at the bottom.
                depth = z if sign < 0 else z - h
                made += (
                    columns(nu, g, alpha, depth, sign)
                    if axes == 2
                    else twists(g, alpha, depth, sign)
                )
            return made

        top = at(mpf(0))
        states.append((count, top, at(h) if h is not None else None))
        count += len(top)
    rows = []

    def row(*terms):
        line = [mpf(0)] * count
        for (start, face), entry, factor in terms:
            for k, column in enumerate(face):
                line[start + k] += factor * column[entry]
        rows.append(line)

    for axis in range(axes):
        row((states[0][:2], axes + axis, 1))
    for j, layer in enumerate(body["layers"]):
        upper = (states[j][0], states[j][2])
        lower = states[j + 1][:2] if j + 1 < len(states) else None
        for axis in range(axes):
            u, t = axis, axes + axis
            if lower is None and body["substrate"] == "free":
                row((upper, t, 1))
                continue
            across = axes == 2 and axis == 0
            interface = layer["interface"]
            slips = interface == "frictionless" or (
                isinstance(interface, dict) and interface["tangential"] == 0
            )
            if slips and not across:
                row((upper, t, 1))
                if lower:
                    row((lower, t, 1))
                continue
            k = (
                interface["normal" if across else "tangential"]
                if isinstance(interface, dict)
                else None
            )
            # u_upper = u_lower + t/k: a pressure and TAU, Q > 0 push the upper side into the body.
            jump = [(upper, t, -1 / mpf(k))] if k is not None else []
            row((upper, u, 1), *jump, *([(lower, u, -1)] if lower else []))
            if lower:
                row((upper, t, 1), (lower, t, -1))
    loads = zeros(count, axes)
    for axis in range(axes):
        loads[axis, axis] = 1
    found = []
    for axis in range(axes):
        x = lu_solve(matrix(rows), loads[:, axis])
        face = states[0][1]
        found.append([sum(face[k][u] * x[k] for k in range(len(face))) for u in range(axes)])
    return found


def exact(value):
    """Return the same data with numbers of 120 digits."""
    if isinstance(value, dict):
        return {key: exact(item) for key, item in value.items()}
    if isinstance(value, list):
        return [exact(item) for item in value]
    return mpf(value) if isinstance(value, int | float) else value


def numbers(body):
    """Yield paths of the numbers of a body, in the order of nacre, as keys and places."""
    for k, layer in enumerate(body["layers"]):
        for key, name in (
            ("young", "material.young"),
            ("poisson", "material.poisson"),
            ("thickness", "thickness"),
        ):
            yield f"layers[{k}].{name}", ("layers", k, key)
        if isinstance(layer["interface"], dict):
            for key in ("normal", "tangential"):
                if layer["interface"][key]:
                    yield f"layers[{k}].interface.{key}", ("layers", k, "interface", key)
    if isinstance(body["substrate"], dict):
        for key in ("young", "poisson"):
            yield f"substrate.{key}", ("substrate", key)


def moved(body, place, by):
    """Return a body with another number, and the change."""
    changed = copy.deepcopy(body)
    here = changed
    for key in place[:-1]:
        here = here[key]
    step = by * (abs(here[place[-1]]) or 1)
    here[place[-1]] += step
    return changed, step


def row_of(body, alpha):
    alpha = mpf(alpha)
    (c11, c21), (c12, c22) = solved(body, alpha, 2)
    assert abs(c12 - c21) < mpf("1e-40") * abs(c11)
    ((ct,),) = solved(body, alpha, 1)
    slopes = {}
    for path, place in numbers(body):
        (above, step), (below, _) = (moved(body, place, sign * mpf("1e-30")) for sign in (1, -1))
        change = solved(above, alpha, 2)[0][0] - solved(below, alpha, 2)[0][0]
        slopes[path] = float(change / (2 * step))
    values = {"c11": c11, "c12": c12, "c22": c22, "ct": ct}
    return (
        {"wavenumber": float(alpha)} | {k: float(v) for k, v in values.items()} | {"slopes": slopes}
    )


def fill(content):
    for case in content["cases"]:
        body = exact({"layers": case["layers"], "substrate": case["substrate"]})
        case["rows"] = [row_of(body, row["wavenumber"]) for row in case["rows"]]


if __name__ == "__main__":
    main(sys.modules[__name__])
