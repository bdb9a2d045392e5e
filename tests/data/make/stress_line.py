"""Stresses below rigid cylinders on a bonded coating in plane strain: stress_line.json."""

import sys

import numpy as np

from axisym import lowest
from common import main
from layered import coat, compliances, states
from line_coated import press
from stress_disc import panels, stresses

NAME, SECONDS = "stress_line.json", 40


def fill(content):
    for case in content["cases"]:
        nu, h = case["nu"], case["h_over_bH"]
        stack = coat(case["E1_over_E2"], h, nu)
        line, hertz = press(stack, 1 / (1 - nu**2))
        known = {}

        def below(x, z, layer, stack=stack, line=line, known=known, h=h, hertz=hertz):
            if z not in known:
                m, weights = panels(40 / z, 1.0)
                index, cut = stack.cut(z)
                known[z] = (
                    cut,
                    index,
                    m,
                    weights * line.transform(m) / np.pi,
                    states(cut, m)[:, index, :, 0],
                )
            cut, index, m, w, state = known[z]
            above = layer == 0 and abs(z - h) < 1e-9
            along, across = stresses(
                state, *[*[one[1:3] for one in cut.layers], cut.base][index - above]
            )
            c, s = np.cos(m * x) / hertz, np.sin(m * x) / hertz
            return -(w * c) @ state[:, 2], (w * c) @ along, (w * c) @ across, (w * s) @ state[:, 3]

        case |= {"b_over_bH": line.b, "p0_over_pH": float(line.pressure(0.0)) / hertz}
        for row in case["axis"]:
            szz, sxx, syy, _ = below(0.0, row["z_over_h"] * h, row["layer"])
            mises = np.sqrt(((szz - sxx) ** 2 + (szz - syy) ** 2 + (sxx - syy) ** 2) / 2)
            row |= {"szz": szz, "sxx": sxx, "tau_max_xz": abs(szz - sxx) / 2, "vm": mises}
        shear = lowest(lambda x: -abs(below(x, h, 1)[3]), (0.3, 1.5), 1e-9)
        case |= {"interface_shear_max_over_pH": -shear.fun, "at_x_over_bH": shear.x}
        surface = case["surface"]
        x = np.array(surface["x_over_b"]) * line.b
        m, weights = panels(21 / h, 1.5 / x.max())
        shear1, nu1 = stack.top
        extra = -2 * shear1 / (1 - nu1) * (compliances(stack, m)[1] - (1 - 2 * nu1) / (2 * shear1))
        rest = np.cos(np.outer(x, m)) @ (weights * extra * line.transform(m)) / np.pi
        inside = np.where(x < line.b, line.pressure(np.minimum(x / line.b, 1.0)), 0.0)
        surface["sxx_over_pH"] = ((rest - inside) / hertz).tolist()


if __name__ == "__main__":
    main(sys.modules[__name__])
