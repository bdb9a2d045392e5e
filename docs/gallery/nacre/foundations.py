"""
A ball on springs and under a skin
==================================

A rubber mat given by its response: springs alone, and springs under a stretched skin. The pressure
on the springs falls to 0 at the edge. With the skin it ends in a jump, because the curvature of the
skin jumps there; the peak at the jump is one cell wide and belongs to the cells. The lower picture
shows the surface of the mat.
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre

k, T = 2e9, 2e3  # stiffness of the springs [Pa/m], tension of the skin [N/m]
bodies = {
    "springs": nacre.Response(lambda alpha: np.full_like(alpha, 1 / k)),
    "springs under a skin": nacre.Response(
        lambda alpha: 1 / (k + T * alpha**2)
    ),
}
grid = nacre.Grid(shape=(256, 256), size=(0.016, 0.016))
figure, (above, below) = plt.subplots(
    2, 1, figsize=(6.4, 5), layout="constrained", sharex=True
)
for name, body in bodies.items():
    solution = nacre.solve(
        nacre.Paraboloid(0.05, 0.05), body, grid=grid, load=5.0
    )
    middle = len(grid.y) // 2
    above.plot(1e3 * grid.x, solution.pressure[:, middle] / 1e3, label=name)
    below.plot(1e3 * grid.x, -1e6 * solution.displacement[:, middle])
ball = 1e6 * (grid.x**2 / (2 * 0.05) - solution.approach)
below.plot(
    1e3 * grid.x,
    ball,
    color="0.5",
    linestyle="--",
    label="the ball on the skin",
)
above.set(ylabel="pressure [kPa]", ylim=(0, None))
below.set(xlabel="x [mm]", ylabel="height of the surface [µm]", ylim=(-140, 60))
for axes in (above, below):
    axes.legend(frameon=False)
