"""
A coat that wears through
=========================

A cylinder slides on 2 µm of a hard coat, and the coat wears. The contact widens and its pressure
falls, so that wear becomes slower; in the middle, the coat is through first. Bare steel that wears
a hundred times faster is deeper after a tenth of the distance.
"""

import matplotlib.pyplot as plt

import nacre
from nacre import plot

steel = nacre.Elastic(young=210e9, poisson=0.3)
dlc = nacre.Elastic(young=300e9, poisson=0.2)
coated = nacre.HalfSpace(steel, layers=[nacre.Layer(dlc, thickness=2e-6)])
roller, grid = nacre.Cylinder(10e-3), nacre.Grid.line(256, 1e-3)
rates: dict[str | int, float] = {0: 1e-17, "substrate": 1e-15}

history = nacre.wear(
    roller,
    coated,
    steel,
    load=1e5,
    grid=grid,
    rate=rates,
    sliding=5e3,
    until="through",
)
assert history.life is not None
distance = history.life.distance
bare = nacre.wear(
    roller,
    steel,
    steel,
    load=1e5,
    grid=grid,
    rate=1e-15,
    sliding=distance / 10,
    scheme="euler",
)

# %%
# # Depth and pressure over the distance.
figure, (left, right) = plt.subplots(
    1, 2, figsize=(7.2, 3.4), layout="constrained"
)
plot.wear(history, left)
for name, one in {"coated": history, "bare": bare}.items():
    right.loglog(one.distance[1:], one.deepest[1:, 0] * 1e6, label=name)
right.axhline(2.0, color="k", ls=":", label="thickness of the coat")
right.set(xlabel="sliding distance [m]", ylabel="deepest wear [µm]")
right.legend(loc="upper left", fontsize=8)

# %%
# # The verdict has the distance and the place.
print(history.verdict())
