"""Surface compliances of ten stacks, from the boundary-value problem: response_stacks.json."""

import sys

import mpmath

import layered
from common import main

NAME, SECONDS = "response_stacks.json", 15


def body(case):
    """Return the body of a case in mpmath's numbers, each exactly the number in the file."""

    def exact(m):
        words = {k: mpmath.mpf(str(v)) for k, v in m.items() if k != "interface"}
        return m | words

    rigid = case["substrate"] in (None, "rigid")
    base = None if rigid else exact(case["substrate"])
    return layered.body({"layers": [exact(m) for m in case["layers"]], "substrate": base})


def fill(content):
    mpmath.mp.dps = 30
    for case in content["cases"]:
        stack = body(case)
        for row in case["rows"]:
            alpha = mpmath.mpf(str(row["wavenumber"]))
            found = [*layered.exact(stack, alpha), layered.exact(stack, alpha, 2)]
            row |= dict(zip(("c11", "c12", "c22", "ct"), map(float, found), strict=True))


if __name__ == "__main__":
    main(sys.modules[__name__])
