"""
Fretting wear around a zone that sticks
=======================================

A cylinder is pressed on a coated flat and cycled across by half of what friction can carry. The rim
of the contact slips and wears, and hands its pressure over to the edge of the zone that sticks.
"""

import matplotlib.pyplot as plt

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
hard = nacre.Elastic(young=420e9, poisson=0.3)
flat = nacre.HalfSpace(steel, layers=[nacre.Layer(hard, thickness=5e-6)])
grid = nacre.Grid.line(257, 3.4e-4)
cycle = {
    "friction": 0.6,
    "steps": [{"force": (None, 3e4)}, {"force": (None, -3e4)}],
}
history = nacre.wear(
    nacre.Cylinder(10e-3),
    flat,
    steel,
    load=1e5,
    grid=grid,
    slide=cycle,
    rate={0: 1e-16, "substrate": 1e-15},
    cycles=3e7,
    steps=[1e6, 3e6, 1e7, 2e7, 3e7],
)

# %%
# # Pressure and depth across the contact, new and after more and more cycles.
figure, (left, right) = plt.subplots(
    1, 2, figsize=(7.2, 3.4), layout="constrained"
)
colours = plt.colormaps["viridis"]
for k, state in enumerate(history):
    style = {
        "color": colours(k / 6),
        "label": f"{state.distance / 1e6:g} million cycles",
    }
    pressure = state.solution.pressure[0]
    left.plot(1e6 * grid.y, pressure / 1e6, **style)
    right.plot(1e6 * grid.y, 1e9 * state.depth[0], **style)
left.set(xlabel="y [µm]", ylabel="pressure [MPa]")
right.set(xlabel="y [µm]", ylabel="depth removed [nm]")
right.invert_yaxis()
left.legend(loc="lower center", fontsize=7)

# %%
# # The coat is 5 µm thick, and far from through:
print(history.verdict())
