"""
Tilting stiffness of a roller
=============================

Moment as a function of the tilt for the roller of Spinu et al. under 1 kN, bare and with 40 µm of
a coating a quarter as stiff. The slope at the origin is the tilting stiffness, as bearing
calculations need it. It agrees with the tangent that :py:meth:`nacre.Solution.stiffness` returns.
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre
from nacre import design, plot

steel = nacre.Elastic(young=210e9, poisson=0.3)
soft = nacre.Elastic(young=52.5e9, poisson=0.3)
bodies = {
    "bare": nacre.HalfSpace(steel),
    "40 µm, E₁ = E₂/4": nacre.HalfSpace(
        steel, layers=[nacre.Layer(soft, 40e-6)]
    ),
}
roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5)
grid = nacre.Grid(shape=(384, 64), size=(32e-3, 0.16e-3))
tilts = np.linspace(0, 6e-5, 13)

# %%
# # The thin lines are tangents, each from one solution of the roller without tilt. Because the
# force is constant and the approach is free, the tilting stiffness is a Schur complement.
figure, axes = plt.subplots(figsize=(5.2, 3.6), layout="constrained")
for (name, body), colour in zip(
    bodies.items(), ("#0072B2", "#D55E00"), strict=True
):
    curve = design.tilt_curve(
        roller, body, tilts, load=1e3, grid=grid, progress=False
    )
    plot.curve(curve, "moment", axes, label=name, color=colour)
    upright = nacre.solve(roller, body, grid=grid, load=1e3)
    tangent = upright.stiffness()
    slope = tangent[1, 1] - tangent[0, 1] ** 2 / tangent[0, 0]
    print(f"{name:18} {slope / 1e3:.1f} N m per mrad")
    axes.plot(1e3 * tilts, slope * tilts, color="0.6", linewidth=0.8, zorder=0)
axes.set_ylim(0, 6)
axes.legend(frameon=False)
