"""Find the peak pressure and the approach of a ball on a coated plate."""

import math

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
coating = nacre.Elastic(young=420e9, poisson=0.3)
plate = nacre.HalfSpace(steel, layers=[nacre.Layer(coating, thickness=21.65597763e-6)])
ball = nacre.Paraboloid(10e-3, 10e-3)  # its radii along x and y

solution = nacre.solve(ball, plate, load=20.0)
print(solution)

# Fredholm's integral equation, solved without nacre: docs, benchmark, coated_spheres.
assert math.isclose(solution.peak_pressure, 1.36669e9, rel_tol=1e-3)
assert math.isclose(solution.approach, 0.717212e-6, rel_tol=1e-3)
