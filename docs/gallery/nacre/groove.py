"""
A ball in a groove
==================

A ball of 10 mm in a groove of osculation 0.52, as in a ball bearing, under 200 N. The contact is
long compared with the radius across: the circles of ball and groove part sooner than the parabolas
of Hertz's theory, and the contact is a little shorter than his ellipse.
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre
from nacre import plot

steel = nacre.Elastic(young=210e9, poisson=0.3)
modulus = nacre.hertz.contact_modulus(steel, steel)
ball = nacre.Sphere(5e-3, counter_radius_x=-5.2e-3, counter_radius_y=20e-3)
solution = nacre.solve(ball, steel, counterbody=steel, load=200.0)
ellipse = nacre.hertz.Ellipse(5e-3, 5e-3, modulus, 200.0, -5.2e-3, 20e-3)
a, b = ellipse.semi_axes

figure, (above, below) = plt.subplots(
    2, 1, figsize=(7, 4.6), layout="constrained"
)
plot.pressure_map(solution, axes=above)
angle = np.linspace(0, 2 * np.pi, 400)
above.plot(
    1e3 * a * np.cos(angle),
    1e6 * b * np.sin(angle),
    "--",
    color="#D55E00",
    label="Hertz",
)
above.set_title("x and y to different scales", loc="left")
above.set_xlim(-1.0, 1.0)
row = solution.pressure.shape[1] // 2
below.plot(
    1e3 * solution.x, solution.pressure[:, row] / 1e9, label="nacre: circles"
)
inside = np.sqrt(np.clip(1 - (solution.x / a) ** 2, 0, None))
hertz = ellipse.peak_pressure / 1e9 * inside
below.plot(
    1e3 * solution.x, hertz, "--", color="#D55E00", label="Hertz: parabolas"
)
below.set(
    xlabel="x, across the groove [mm]",
    ylabel="pressure [GPa]",
    xlim=(-1.0, 1.0),
    ylim=(0, None),
)
below.legend(frameon=False, loc="lower center")
