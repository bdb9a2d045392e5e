"""
Creep curves of a coated wheel
==============================

A wheel rolls on a rail, both without coating or both with the same. The force along the direction
of rolling rises with the creepage until the whole contact slips. Where the creepage is small, the
slope follows from Kalker's coefficient C11.

*Left*: creep curves under the same load, with coatings a fifth as thick as the contact's radius.
*Right*: Kalker's coefficients of a circular contact over those without coatings.
"""

from typing import Any

import numpy as np
from matplotlib import pyplot as plt

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
wheel = nacre.Sphere(10e-3)
load, friction, a = 50.0, 0.3, 147e-6
grid = nacre.Grid(shape=(64, 64), size=(4.4e-4, 4.4e-4))
creepages = np.geomspace(1e-4, 8e-3, 12)


def coated(ratio: float, thickness: float) -> nacre.HalfSpace:
    """Return steel under a layer."""
    layer = nacre.Layer(nacre.Elastic(ratio * 210e9, 0.3), thickness)
    return nacre.HalfSpace(steel, [layer])


figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
bodies = {
    "hard coating, 4 : 1": coated(4, 0.2 * a),
    "no coating": steel,
    "soft coating, 1 : 4": coated(0.25, 0.2 * a),
}
for name, body in bodies.items():
    held: dict[str, Any] = {"load": load, "friction": friction, "direction": "+x", "grid": grid}
    curve = nacre.friction.creep_curve(wheel, body, body, creepages=creepages, **held)
    nacre.plot.creep_curve(curve, axes=left, label=name)
left.legend(fontsize="small")

thicknesses = np.array([0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0])
bare = nacre.creep_coefficients(steel, steel, (a, a), cells=32)
for ratio, colour in ((4, "C0"), (0.25, "C1")):
    pairs = [(coated(ratio, h), coated(ratio, h)) for h in thicknesses * a]
    found = [nacre.creep_coefficients(*pair, (a, a), cells=32) for pair in pairs]
    kind = "4 : 1" if ratio > 1 else "1 : 4"
    for name, style in (("c11", "o-"), ("c22", "s--"), ("c23", "^:")):
        values = [getattr(one, name) / getattr(bare, name) for one in found]
        label = f"{name.upper()}, {kind}"
        right.loglog(thicknesses, values, style, ms=4, color=colour, label=label)
right.axhline(1, color="0.6", lw=0.8)
right.set(
    xlabel="thickness of both coatings over radius a",
    ylabel="coefficient over that without coatings",
)
ticks = [0.25, 0.5, 1, 2, 4]
right.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
right.minorticks_off()
right.legend(fontsize="small", ncols=2, loc="center right")
