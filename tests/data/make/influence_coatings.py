"""Influence coefficients of four coated bodies: influence_coatings.json."""

import sys

import numpy as np

from common import main
from layered import body
from patch import Added, love

NAME, SECONDS = "influence_coatings.json", 60


def fill(content):
    for case in content["cases"]:
        stack, (dx, dy) = body(case), case["cell"]
        a1 = (1 - stack.top[1]) / stack.top[0]
        close, reach = Added(stack, 5 * np.hypot(dx, dy), False), {}
        for row in case["rows"]:
            x, y, a, b = row["i"] * dx, row["j"] * dy, dx / 2, dy / 2
            r = np.hypot(x, y)
            if r < 4 * np.hypot(dx, dy):
                added = close.near(x, y, a, b, True)
            else:
                size = 2 ** np.ceil(np.log2(r + dx))
                reach[size] = reach.get(size) or Added(stack, size, False)
                added = reach[size].far(x, y, a, b, True, (6, 6))
            row["c"] = a1 / (2 * np.pi) * love(x, y, a, b) + added


if __name__ == "__main__":
    main(sys.modules[__name__])
