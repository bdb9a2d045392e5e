"""
Stresses below a coated sphere
==============================

A ball on a coating twice as stiff as the steel below it. The stiffer coating carries more: von
Mises' stress jumps at the interface, and is largest just above it, where the coating bends.
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
hard = nacre.Elastic(young=420e9, poisson=0.3)
body = nacre.HalfSpace(steel, layers=[nacre.Layer(hard, thickness=40e-6)])
solution = nacre.solve(nacre.Sphere(5e-3), body, load=100.0)

# %%
# The section y = 0. Depths are cut at the interface, and each part is evaluated on its own side
# of it.
interface = body.interfaces[0]
coating = solution.stress(np.linspace(0, interface, 41), side="above", y=0.0)
below = solution.stress(np.linspace(interface, 4 * interface, 81), side="below", y=0.0)

figure, axes = plt.subplots(figsize=(7.1, 4.2), layout="constrained")
highest = max(part.peak("von_mises")[0] for part in (coating, below)) / 1e9
levels = np.linspace(0, highest, 25)
for part in (coating, below):
    values = part.von_mises / 1e9
    filled = axes.contourf(1e6 * part.x, 1e6 * part.z, values, levels, cmap="viridis")
axes.axhline(1e6 * interface, color="white", linewidth=1)
axes.set(xlabel="x [µm]", ylabel="depth z [µm]", aspect="equal", xlim=(-150, 150))
axes.invert_yaxis()
ticks = np.arange(0, highest, 0.5)
bar = figure.colorbar(filled, ax=axes, label="von Mises stress [GPa]", ticks=ticks)

# %%
# On the axis below the ball, and along the interface: what is in the plane jumps there, and
# what pulls or shears the interface is the same on both sides.
x = solution.x
middle = float(x[np.argmin(np.abs(x))])
above = solution.stress(interface, side="above", y=middle)
under = solution.stress(interface, side="below", y=middle)

figure, (left, right) = plt.subplots(1, 2, figsize=(7.1, 3.3), layout="constrained")
for part in (coating, below):
    column = np.argmin(np.abs(part.x))
    depth = 1e6 * part.z
    left.plot(part.zz[:, column] / 1e9, depth, "-", color="#0072B2", label="σzz")
    left.plot(part.xx[:, column] / 1e9, depth, "--", color="#D55E00", label="σxx")
left.axhline(1e6 * interface, color="0.7", linewidth=0.8)
left.invert_yaxis()
left.set(xlabel="stress on the axis [GPa]", ylabel="depth z [µm]")
left.legend(*(part[:2] for part in left.get_legend_handles_labels()), frameon=False)

position = 1e6 * above.x
right.plot(position, above.xx / 1e9, color="#D55E00", label="σxx above")
right.plot(position, under.xx / 1e9, color="#D55E00", linestyle="--", label="σxx below")
right.plot(position, under.xz / 1e9, color="#000000", linestyle=":", label="σxz, both")
right.set(xlabel="x [µm]", ylabel="stress at the interface [GPa]", xlim=(-150, 150))
right.legend(frameon=False)
