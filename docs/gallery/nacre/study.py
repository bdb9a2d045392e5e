"""
A study over thickness and modulus
==================================

`nacre.sweep` solves every combination of parameters. Here the peak pressure under a ball, as a
function of the thickness of its coating, has a curve for each modulus. Error bars are the estimated
errors due to the size of the cells.
"""

import numpy as np

import nacre
from nacre import plot


def ball(young: float, thickness: float) -> dict[str, object]:
    """Return the contact of a ball of 5 mm under 20 N on coated steel."""
    steel = nacre.Elastic(young=210e9, poisson=0.3)
    layer = nacre.Layer(nacre.Elastic(young, poisson=0.3), thickness)
    return {
        "shape": nacre.Sphere(5e-3),
        "body": nacre.HalfSpace(steel, [layer]),
        "load": 20.0,
    }


parameters = {
    "young": [52.5e9, 105e9, 420e9, 840e9],
    "thickness": np.geomspace(1e-6, 200e-6, 13),
}
study = nacre.sweep(ball, parameters, outputs=["peak_pressure"], progress=False)
axes = plot.curve(study, "peak_pressure")
axes.set_ylim(0, None)
