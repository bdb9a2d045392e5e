"""A pressure cos(y) on the strip 0 < x < 1 of a quarter space: quarter_space_strip.json, 'hetenyi'.

The column 'finite_elements' is of another program and stays.
"""

import sys

import numpy as np

from common import main
from quarter_space_wave import NODES, added, displaced, from_zero

NAME, SECONDS = "quarter_space_strip.json", 6


def fill(content):
    strip = (NODES.ravel() < 1).astype(float)
    parts = {nu: added(nu, strip) for nu in sorted({case["nu"] for case in content["cases"]})}
    for case in content["cases"]:
        x = case["x"]
        bare = from_zero(x + 1) - from_zero(x - 1)
        case["hetenyi"] = (bare + displaced(x, parts[case["nu"]])) / np.pi


if __name__ == "__main__":
    main(sys.modules[__name__])
