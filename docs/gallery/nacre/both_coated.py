"""
Stresses in both coated bodies
==============================

A ceramic ball on a steel plate, both coated with the same carbon. The section shows the von Mises
stress in both bodies on one scale: the ball above the plane of contact, the plate below it.
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
carbon = nacre.Elastic(young=180e9, poisson=0.2)
ceramic = nacre.Elastic(young=310e9, poisson=0.26)
plate = nacre.HalfSpace(steel, layers=[nacre.Layer(carbon, thickness=12e-6)])
ball = nacre.HalfSpace(ceramic, layers=[nacre.Layer(carbon, thickness=6e-6)])
grid = nacre.Grid(shape=(192, 192), size=(0.24e-3, 0.24e-3))
solution = nacre.solve(nacre.Sphere(5e-3), plate, ball, grid=grid, load=20.0)

depths = np.linspace(1e-6, 80e-6, 80)
below = solution.stress(depths, y=0.0, body="body").von_mises / 1e9
above = solution.stress(depths, y=0.0, body="counterbody").von_mises / 1e9
highest = max(above.max(), below.max())
figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
for sign, field in ((1, below), (-1, above)):
    drawn = axes.pcolormesh(
        *(1e6 * solution.x, sign * 1e6 * depths, field),
        vmin=0,
        vmax=highest,
        shading="nearest",
    )
for depth in (-6e-6, 0.0, 12e-6):
    axes.axhline(
        1e6 * depth, color="white", linewidth=1.6 if depth == 0 else 0.8
    )
axes.invert_yaxis()
axes.yaxis.set_major_formatter(lambda value, _: f"{abs(value):g}")
axes.set_aspect("equal")
for y, name in (
    (-70, "ceramic ball, 6 µm of carbon"),
    (74, "steel plate, 12 µm of carbon"),
):
    axes.text(-116, y, name, color="white", va="center")
axes.set(xlabel="x [µm]", ylabel="distance from the plane of contact [µm]")
figure.colorbar(drawn, ax=axes, label="von Mises stress [GPa]")
