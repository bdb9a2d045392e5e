"""
A dent that stays
=================

A ball is pressed into steel and removed. Where the pressure would exceed the hardness, the surface
yields and a dent remains. Unloading is elastic; the area of the loop is the energy that the dent
has absorbed.
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
ball, hardness = nacre.Sphere(5e-3), 2e9
grid = nacre.Grid((128, 128), (6e-4, 6e-4))
contact = nacre.Contact(steel, grid)

loads = [1, 5, 10, 20, 40, 60, 80, 100]
steps = [contact.solve(ball, load=loads[0], hardness=hardness)]
for load in [*loads[1:], *reversed(loads[:-1])]:
    steps.append(
        contact.solve(ball, load=load, hardness=hardness, initial=steps[-1])
    )
loaded, unloaded = steps[len(loads) - 1], steps[-1]

figure, (left, right) = plt.subplots(
    1, 2, figsize=(7.2, 3.6), layout="constrained"
)
approach = 1e6 * np.array([step.approach for step in steps])
force = np.array([step.load for step in steps])
left.plot(approach[: len(loads)], force[: len(loads)], "o-", label="loading")
left.plot(
    approach[len(loads) - 1 :],
    force[len(loads) - 1 :],
    "s--",
    label="unloading",
)
left.set(xlabel="approach [µm]", ylabel="load [N]")
left.legend()

middle = grid.shape[1] // 2
for name, step in {"100 N": loaded, "1 N, unloaded": unloaded}.items():
    right.plot(
        1e6 * grid.x,
        step.pressure[:, middle] / 1e9,
        label=f"pressure at {name}",
    )
right.set(xlabel="x [µm]", ylabel="pressure [GPa]", xlim=(-200, 200))
dent = right.twinx()
dent.plot(
    1e6 * grid.x, -1e9 * unloaded.indentation[:, middle], "k:", label="dent"
)
dent.set_ylabel("height of the unloaded surface [nm]")
handles = [*right.get_lines(), *dent.get_lines()]
right.legend(
    handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.18), fontsize=8
)

# %%
# The energy of the dent, from its volume:
print(f"{1e6 * unloaded.plastic_work:.1f} µJ")
