"""Press a crowned roller off its centre, free to tilt, and find its peak pressure and its tilt."""

import math

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5)
grid = nacre.Grid(shape=(512, 64), size=(31e-3, 0.18e-3))

solution = nacre.solve(roller, steel, grid=grid, load=1e3, eccentricity=(2.8695e-3, 0.0))
print(f"{solution.peak_pressure / 1e6:.0f} MPa, tilt {solution.tilt[0]:.2e}")

# The roller of Spinu et al., of three digits.
assert math.isclose(solution.peak_pressure, 985e6, rel_tol=2e-3)
assert math.isclose(solution.tilt[0], 3.40e-5, rel_tol=2e-3)
