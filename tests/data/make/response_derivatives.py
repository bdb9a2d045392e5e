"""Derivatives of alpha c11 by each layer's numbers, 40 digits: response_derivatives.json.

Central differences of the whole boundary-value problem, with more digits than they cancel.
"""

import copy
import sys

import mpmath

from common import main
from layered import exact
from response_stacks import body

NAME, SECONDS = "response_derivatives.json", 90
DIGITS, STEP = (
    130,
    40,
)  # differences of steps 1e-40: errors 1e-80 relative to the step's square, and 1e-90


def value(case, alpha):
    return alpha * exact(body(case), alpha)[0]


def fill(content):
    mpmath.mp.dps = DIGITS
    for case in content["stacks"]:
        for row in case["rows"]:
            alpha = mpmath.mpf(row["alpha"])
            row["alpha_c11"] = mpmath.nstr(value(case, alpha), 50)
            for key in row:
                if not key.startswith("d_"):
                    continue
                _, name, place = key.split("_")
                ends = []
                for sign in (1, -1):
                    moved = copy.deepcopy(case)
                    part = (
                        moved["substrate"] if place == "substrate" else moved["layers"][int(place)]
                    )
                    number = mpmath.mpf(part[name]) + sign * mpmath.mpf(10) ** -STEP
                    part[name] = mpmath.nstr(number, DIGITS)
                    ends.append(value(moved, alpha))
                row[key] = mpmath.nstr((ends[0] - ends[1]) / 2 * mpmath.mpf(10) ** STEP, 50)


if __name__ == "__main__":
    main(sys.modules[__name__])
