"""
Creep curves of a coated wheel
==============================

A wheel rolls on a rail of its own kind, both bare or both coated. The force along the direction of rolling rises with
the creepage until the whole contact slips. At small creepage its slope is Kalker's coefficient C11 times the area; a
coating changes it by more than it changes the contact.

*Left*: creep curves of equal loads. *Right*: Kalker's coefficients of a circular contact over those of bodies without
coating, as functions of the thickness of the coating.
"""

# %%
from matplotlib import pyplot as plt

import numpy as np

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
wheel = nacre.Sphere(10e-3)
load, friction, a = 50.0, 0.3, 147e-6
grid = nacre.Grid(shape=(64, 64), size=(4.4e-4, 4.4e-4))
creepages = np.geomspace(1e-4, 8e-3, 12)


def coated(ratio, thickness):
    """Return steel under a layer."""
    layer = nacre.Layer(nacre.Elastic(ratio * 210e9, 0.3), thickness)
    return nacre.HalfSpace(steel, [layer])


figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
bodies = {"hard coating, 4 : 1": coated(4, 0.2 * a), "no coating": steel, "soft coating, 1 : 4": coated(0.25, 0.2 * a)}
for name, body in bodies.items():
    curve = nacre.friction.creep_curve(
        wheel, body, body, creepages=creepages, load=load, friction=friction, direction="+x", grid=grid, tolerance=1e-5
    )
    nacre.plot.creep_curve(curve, axes=left, label=name)
left.legend(fontsize="small")

thicknesses = np.array([0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0])
bare = nacre.creep_coefficients(steel, steel, (a, a), cells=32)
for ratio, colour in ((4, "C0"), (0.25, "C1")):
    found = [nacre.creep_coefficients(*[coated(ratio, h * a)] * 2, (a, a), cells=32) for h in thicknesses]
    for name, style in (("c11", "o-"), ("c22", "s--"), ("c23", "^:")):
        values = [getattr(one, name) / getattr(bare, name) for one in found]
        right.loglog(thicknesses, values, style, ms=4, color=colour, label=f"{name.upper()}, {ratio:g} : 1")
right.axhline(1, color="0.6", lw=0.8)
right.set(xlabel="thickness of both coatings over radius a", ylabel="coefficient over that without coating")
right.legend(fontsize="small", ncols=2)
plt.show()
