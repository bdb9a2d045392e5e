"""Coated quarter spaces: the layered half-space beside them, quarter_space_coated.json.

The displacements of the quarter spaces themselves are of a finite-element program, and stay.
"""

import sys

import numpy as np

from common import main
from layered import coat
from patch import Added, love

NAME, SECONDS = "quarter_space_coated.json", 15


def fill(content):
    for case in content["cases"]:
        stack = coat(case["E1_over_E2"], case["h_over_b"], 0.3)
        places = case["d_over_b"] + 1 - np.array(case["x_over_b"])  # from the middle of the load
        added = Added(stack, np.abs(places).max() + 2, False)
        a1 = (1 - stack.top[1]) / stack.top[0] / (2 * np.pi)
        case["u_layered_half_space"] = [
            a1 * love(x, 0.0, 1.0, 1.0) + added.near(x, 0.0, 1.0, 1.0, True) for x in places
        ]


if __name__ == "__main__":
    main(sys.modules[__name__])
