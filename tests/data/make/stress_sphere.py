"""Stresses below rigid paraboloids on a bonded coating: stress_sphere.json.

Hankel integrals of the contact's density (axisym.py). On the surface, the closed form of the
coating's
material plus the integral of what the layers add, which converges exponentially (Delta = alpha c12
less
its value on a half-space of the coating).
"""

import sys

import numpy as np
from scipy.special import j0, j1

from axisym import Contact, lowest
from common import main
from layered import coat, compliances, states
from sphere_coated import press
from stress_disc import at, panels

NAME, SECONDS = "stress_sphere.json", 60


class Field:
    """Stresses over p_H below a contact; lengths in a_H."""

    def __init__(self, stack, young):
        thin, self.hertz = press(stack, young)
        self.contact = Contact(thin.response, thin.a, (thin.F, thin.dF))
        self.stack, self.a = stack, thin.a
        x, w = np.polynomial.legendre.leggauss(600)
        t, w = self.a * (x + 1) / 2, self.a * w / 2
        c = self.contact
        spectrum = c.weights * c.m * c.transform(c.density())
        self.phi = c.f * (c.delta - c.F(t)) - 2 / np.pi * np.cos(t[:, None] * c.alpha) @ spectrum
        self.t, self.w = t, w
        self.known = {}

    def transform(self, alpha):
        return np.concatenate(
            [
                np.cos(part[:, None] * self.t) @ (self.w * self.phi)
                for part in np.array_split(alpha, 20)
            ]
        )

    def below(self, r, z, layer):
        if z not in self.known:
            alpha, weights = panels(40 / z, 1.0)
            index, cut = self.stack.cut(z)
            self.known[z] = (
                cut,
                index,
                alpha,
                weights * self.transform(alpha),
                states(cut, alpha)[:, index, :, 0],
            )
        cut, index, alpha, weights, state = self.known[z]
        above = layer == 0 and abs(z - self.stack.layers[0][0]) < 1e-9
        part = [*[one[1:3] for one in cut.layers], cut.base][index - above]
        found = at(state, part, alpha, weights, r)
        stress = {k: float(v) / self.hertz for k, v in found.items() if k[0] == "s"}
        root = (stress["szz"] - stress["srr"]) ** 2 + (stress["szz"] - stress["stt"]) ** 2
        root = root + (stress["srr"] - stress["stt"]) ** 2 + 6 * stress["srz"] ** 2
        return stress | {"vm": np.sqrt(root / 2), "uz": float(found["uz"])}

    def surface(self, r):
        """sigma_rr and sigma_tt at z = 0."""
        c, (shear, nu) = self.contact, self.stack.top
        alpha, weights = panels(21 / self.stack.layers[0][0], 1.5 / max(self.a, r))
        extra = compliances(self.stack, alpha)[1] - (1 - 2 * nu) / (2 * shear)
        along = -2 * shear / (1 - nu) * extra  # sigma_LL; sigma_TT is nu times this
        w = weights * self.transform(alpha) * alpha
        x = alpha * r
        over = np.where(x > 1e-8, j1(x) / np.where(x > 0, x, 1), 0.5)
        srr = w @ (along * (j0(x) - (1 - nu) * over))
        stt = w @ (along * (nu * j0(x) + (1 - nu) * over))
        p = c.pressure(r) if r < self.a else 0.0
        if r == 0:
            mean = p / 2
        elif r < self.a:
            y, v = np.polynomial.legendre.leggauss(60)
            mean = (
                sum(v * c.pressure(s) * s for s, v in zip(r * (y + 1) / 2, r * v / 2, strict=True))
                / r**2
            )
        else:
            mean = c.P / (2 * np.pi * r**2)
        srr += -p + (1 - 2 * nu) * mean
        stt += -2 * nu * p - (1 - 2 * nu) * mean
        return srr / self.hertz, stt / self.hertz


def fill(content):
    for case in content["cases"]:
        nu, h = case["nu"], case["h_over_aH"]
        field = Field(coat(case["E1_over_E2"], h, nu), 1 / (1 - nu**2))
        contact, a = field.contact, field.a
        top = contact.pressure(0.0) / field.hertz
        case |= {"a_over_aH": a, "p0_over_pH": top, "delta_over_deltaH": contact.delta}
        for row in case["axis"]:
            if row["z_over_h"] == 0:
                srr = field.surface(0.0)[0]
                row |= {"szz": -top, "srr": srr, "vm": abs(srr + top)}
                continue
            found = field.below(0.0, row["z_over_h"] * h, row["layer"])
            row |= {k: found[k] for k in ("szz", "srr", "vm")} | {"uz_over_deltaH": found["uz"]}
        edge = [field.surface(k * a) for k in case["surface"]["r_over_a"]]
        case["surface"] |= {
            "srr_over_pH": [e[0] for e in edge],
            "stt_over_pH": [e[1] for e in edge],
        }
        case["srr_at_edge_over_pH"] = field.surface(a)[0]
        beyond = lowest(lambda k: -field.surface(k * a)[0], (1.5, 6.0), 1e-7)
        high = max((case["srr_at_edge_over_pH"], 1.0), (-beyond.fun, beyond.x))
        case |= {"surface_max_tensile_srr_over_pH": high[0], "at_r_over_a": high[1]}
        shear = lowest(lambda r: -abs(field.below(r, h, 1)["srz"]), (0.3, 1.5), 1e-9)
        case |= {"interface_shear_max_over_pH": -shear.fun, "interface_shear_at_r_over_aH": shear.x}
        case["interface_shear_sign"] = float(np.sign(field.below(shear.x, h, 1)["srz"]))
        if case.get("axis_vm_local_max_coating"):
            best = lowest(lambda k: -field.below(0.0, k * h, 0)["vm"], (0.2, 0.8), 1e-7)
            case["axis_vm_local_max_coating"] |= {"z_over_h": best.x, "vm_over_pH": -best.fun}
        sides = [field.below(0.0, h, k) for k in (0, 1)]
        case["interface_axis"] |= {
            "srr_coating": sides[0]["srr"],
            "srr_substrate": sides[1]["srr"],
            "szz": sides[0]["szz"],
        }
        profile = case["interface_profile"]
        for key in profile:
            if key != "r_over_aH":
                name, side = key.split("_") if "_" in key else (key, "coating")
                profile[key] = [
                    field.below(r, h, int(side == "substrate"))[name] for r in profile["r_over_aH"]
                ]


if __name__ == "__main__":
    main(sys.modules[__name__])
