"""Decay of waves of pressure on stacks that wear, from their compliance: wear/wave_decay.json."""

import sys

import mpmath

import layered
from common import main

NAME, SECONDS = "wear/wave_decay.json", 4
STEPS = 10  # of implicit Euler


def body(stack):
    """Return the body of a stack of the file in mpmath's numbers, each exactly the one in it."""

    def material(one):
        young, poisson = (mpmath.mpf(str(one[key])) for key in ("E", "nu"))
        return young / (2 * (1 + poisson)), poisson

    *layers, base = stack
    return layered.Body(
        [(mpmath.mpf(str(one["h"])), *material(one), True) for one in layers], material(base)
    )


def fill(content):
    mpmath.mp.dps = 30
    for row in content["rows"]:
        alpha = mpmath.mpf(str(row["wavenumber"]))
        c11 = layered.exact(body(content["stacks"][row["stack"]]), alpha)[0]
        row["c11"] = float(c11)
        row["decay_at_1"] = float(mpmath.exp(-1 / c11))
        row["euler_10_steps_at_1"] = float((1 + 1 / (STEPS * c11)) ** -STEPS)


if __name__ == "__main__":
    main(sys.modules[__name__])
