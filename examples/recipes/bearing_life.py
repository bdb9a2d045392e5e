"""Find the displacement and the life of a deep-groove ball bearing by ISO/TS 16281."""

import math

import nacre
from nacre import bearing

steel = nacre.Elastic(young=210e9, poisson=0.3)
balls = bearing.DeepGrooveBall(
    count=7,
    diameter=11.5e-3,
    pitch_diameter=43.5e-3,
    clearance=10e-6,
    capacity=23.4e3,
    element=steel,
    inner=steel,
    outer=steel,
)
solution = balls.solve(force=(None, None, 1000.0), model="iso16281")
life = solution.life().l10r
print(f"{solution.displacement[2] * 1e6:.2f} µm, {life:.1f} million revolutions")

# Printed by MASTA.
assert math.isclose(solution.displacement[2], 149.1717e-6, rel_tol=1e-4)
assert math.isclose(life, 3115.8781, rel_tol=1e-4)
