"""
Partial slip of a coated ball
=============================

A ball between two equal bodies is pressed with the load P, and pulled with three quarters of the
force that friction bears. Without coatings, the superposition of Cattaneo and Mindlin holds: the
traction is μ times the pressure, less μ times that of a smaller load, and the shift is
μ (2 − ν)/(2 − 2ν) times the difference of the two approaches. On coated bodies, the ratio of the
tangential compliance to the normal one depends on the wavelength, and the superposition fails.

*Left*: the shift over that of the superposition of nacre's own pressures. *Right*: the traction
across the middle of the contact with a hard coating, and that of the superposition.
"""

from typing import Any

import numpy as np
from matplotlib import pyplot as plt

import nacre

POISSON, FRICTION, SHARE, RADIUS = 0.3, 0.3, 0.75, 10e-3
steel = nacre.Elastic(young=210e9, poisson=POISSON)
load, a = 50.0, 147e-6  # Hertz: two steel bodies
ball = nacre.Sphere(RADIUS)
grid = nacre.Grid(shape=(120, 120), size=(5e-4, 5e-4))


def pulled(ratio: float, thickness: float) -> tuple[Any, Any, float]:
    """Solve, and superpose."""
    layer = nacre.Layer(nacre.Elastic(ratio * 210e9, POISSON), thickness)
    body = nacre.HalfSpace(steel, [layer])
    contact = nacre.Contact(body, grid, counterbody=body)
    force = SHARE * FRICTION * load
    solution = contact.slide(ball, load=load, friction=FRICTION, force=(force, None))
    less = contact.solve(ball, load=(1 - SHARE) * load)
    shift = (2 - POISSON) / (2 - 2 * POISSON) * (solution.normal.approach - less.approach)
    shift *= FRICTION
    return solution, FRICTION * (solution.pressure - less.pressure), solution.shift[0] / shift


thicknesses = a * np.array([0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0])
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
for ratio in (8, 4, 2, 0.5, 0.25):
    shifts = [pulled(ratio, thickness)[2] for thickness in thicknesses]
    (line,) = left.semilogx(thicknesses / a, shifts, "o-", ms=4)
    text = f"{ratio} : 1" if ratio > 1 else f"1 : {1 / ratio:g}"
    left.text(2.3, shifts[-1], text, color=line.get_color(), va="center")
left.axhline(1, color="0.6", lw=0.8)
left.set(
    xlim=(0.015, 5.0),
    xlabel="thickness of both coatings over radius a",
    ylabel="shift over that of the superposition",
    title="moduli of coating and substrate",
)

solution, superposed, _ = pulled(8, 0.2 * a)
middle = 60
x = solution.x * 1e6
right.plot(x, FRICTION * solution.pressure[:, middle] / 1e6, color="0.6", lw=0.8, label="μ p")
right.plot(x, solution.traction[0][:, middle] / 1e6, label="traction")
right.plot(x, superposed[:, middle] / 1e6, "--", label="superposition")
right.set(xlabel="x [µm]", ylabel="traction [MPa]", title="moduli 8 : 1, thickness a/5")
right.set(ylim=(0, 450))
right.legend(fontsize="small", loc="upper center", ncols=3)
