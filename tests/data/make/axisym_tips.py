"""Rigid tips on layered half-spaces at given contact radii: axisym.json."""

import sys

from axisym import Contact, Response, tip
from common import main
from layered import body

NAME, SECONDS = "axisym.json", 4


def fill(content):
    for case in content["cases"]:
        response = Response(body(case))
        shape, flat = tip(case["tip"]), case["tip"]["kind"] == "flat"
        for row in case["rows"]:
            a = row["a"]
            reach = a * max(map(float, row["u_at_r_over_a"]))
            one = Contact(response, a, shape)
            far = Contact(response, a, shape, reach)
            row |= {"S": one.S, "edge_density_unit_punch": one.edge, "dS_da": one.dS}
            phi = far.punch if flat else far.density()
            row["u_at_r_over_a"] = {k: far.outside(float(k) * a, phi) for k in row["u_at_r_over_a"]}
            if not flat:
                row |= {"P": one.P, "delta": one.delta}
            if "p_at_r_over_a" in row:
                row["p_at_r_over_a"] = {k: one.pressure(float(k) * a) for k in row["p_at_r_over_a"]}


if __name__ == "__main__":
    main(sys.modules[__name__])
