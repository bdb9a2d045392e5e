"""Displacements under a uniform tangential cell: friction/tangential_coefficients.json."""

import sys

import numpy as np

from common import main
from layered import Body
from patch import Added, bare

NAME, SECONDS = "friction/tangential_coefficients.json", 120


def fill(content):
    for case in content["stacks"]:
        parts = [(m["h"], m["E"] / (2 * (1 + m["nu"])), m["nu"], True) for m in case["layers"]]
        base = case["substrate"]
        stack = Body(
            parts, None if base == "rigid" else (base["E"] / (2 * (1 + base["nu"])), base["nu"])
        )
        dx, dy = case["dx"], case["dy"]
        a, b = dx / 2, dy / 2
        close, reach = Added(stack, 2 * np.hypot(dx, dy)), {}
        for row in case["rows"]:
            x, y = row["i"] * dx, row["j"] * dy
            r = np.hypot(x, y)
            if r < 3 * dx:
                added = close.near(x, y, a, b)
            else:
                size = 2 ** np.ceil(np.log2(r + np.hypot(a, b)))
                reach[size] = reach.get(size) or Added(stack, size)
                n = 8 if r < 10 * dx else 4  # Gauss points of an edge
                added = reach[size].far(x, y, a, b, order=(n, n if dy == dx else 3 * n))
            row |= dict(
                zip(
                    ("ux", "uy", "uz"),
                    map(float, bare(*stack.top, x, y, a, b) + added),
                    strict=True,
                )
            )


if __name__ == "__main__":
    main(sys.modules[__name__])
