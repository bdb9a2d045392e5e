"""
Where to remove material
========================

A ball with ripples on a coated body. The derivative of a norm of the pressure with respect to the
gap of each cell is a field: where it is negative, removing material lowers the norm. All
derivatives cost one solve. ``nacre.jax`` and ``nacre.torch`` hand the same field to other programs
(:doc:`/howto/differentiable`).
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
coating = nacre.Layer(nacre.Elastic(young=420e9, poisson=0.2), thickness=20e-6)
body = nacre.HalfSpace(steel, [coating])
grid = nacre.Grid(shape=(128, 128), size=(1.8e-4, 1.8e-4))
ripples = (
    2e-8 * np.cos(2 * np.pi * grid.x / 4e-5)[:, None] * np.ones(grid.shape)
)
shape = nacre.Sphere(5e-3) + nacre.HeightMap(-ripples, spacing=grid.spacing)
solution = nacre.solve(shape, body, grid=grid, load=10.0)
norm = solution.gradient(("pressure_norm", 16.0), ["load"])

figure, (left, right) = plt.subplots(
    1, 2, figsize=(8, 3.2), layout="constrained", sharey=True
)
sides = 1e6 * grid.x, 1e6 * grid.y
pressure = np.ma.masked_equal(solution.pressure, 0.0) / 1e9
drawn = left.pcolormesh(*sides, pressure.T, shading="nearest")
figure.colorbar(drawn, ax=left, label="pressure [GPa]")
field = 100 * norm.gap * 1e-9 / norm.value / (1e6**2 * np.prod(grid.spacing))
limit = abs(field).max()
drawn = right.pcolormesh(
    *sides, field.T, shading="nearest", cmap="RdBu_r", vmin=-limit, vmax=limit
)
figure.colorbar(drawn, ax=right, label="change [% / nm / µm²]")
for axes in (left, right):
    axes.set(xlabel="x [µm]", aspect="equal", xlim=(-70, 70), ylim=(-70, 70))
left.set_ylabel("y [µm]")
