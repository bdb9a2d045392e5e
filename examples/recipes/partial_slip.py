"""Pull a pressed ball sideways, and find where it sticks and where it slips."""

import math

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
load, friction, pull = 20.0, 0.2, 2.0
grid = nacre.Grid((96, 96), (2.4e-4, 2.4e-4))

solution = nacre.slide(
    nacre.Paraboloid(10e-3, 10e-3),
    steel,
    steel,
    grid=grid,
    load=load,
    friction=friction,
    force=(pull, 0.0),
)
pressed, stuck = int((solution.pressure > 0).sum()), int(solution.stick.sum())
print(f"{100 * stuck / pressed:.1f} % of the contact sticks")

# Cattaneo and Mindlin: c/a = (1 − Q/μP)^(1/3); counted cells are right to some per cent.
assert math.isclose(stuck / pressed, (1 - pull / (friction * load)) ** (2 / 3), rel_tol=0.02)
