"""
Shakedown of coated steel
=========================

A roller presses on bare steel and on steel with a stiff coating of 0.3 half-widths. Each layer
shakes down where the peak pressure is below its line; below the thin line of the same colour it
never yields. The coating lowers the limit of the steel below it, as long as friction is small; with
more friction the surface of bare steel is worse off than steel under the coating.
"""

import nacre
from nacre import fatigue, plot

steel = nacre.Elastic(young=210e9, poisson=0.3)
hard = nacre.Elastic(young=420e9, poisson=0.3)
coated = nacre.HalfSpace(
    steel, layers=[nacre.Layer(hard, thickness=15e-6, name="coat")]
)
roller, grid = nacre.Cylinder(5e-3), nacre.Grid.line(160, 150e-6)

friction = [0.05 * k for k in range(9)]
axes = None
for name, body in (("bare", steel), ("coated", coated)):
    solution = nacre.solve(roller, body, load=1e5, grid=grid)
    found = fatigue.shakedown_map(solution, friction=friction)
    axes = plot.shakedown_map(found, label=name, axes=axes)

# %%
# # What each depth needs, with both sides of the interface: the largest yield stress decides.
summary = fatigue.assess(
    solution,
    criteria=[fatigue.DangVan(bending=520e6, torsion=330e6)],
    friction=0.1,
)
axes = summary.plot()
