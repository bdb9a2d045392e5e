"""Press two crossed cylinders of different radii together."""

import math

import nacre
from nacre import hertz

steel = nacre.Elastic(young=210e9, poisson=0.3)
brass = nacre.Elastic(young=105e9, poisson=0.34)
shape = nacre.Paraboloid(8e-3, 4e-3)  # one cylinder is straight along y, the other along x

solution = nacre.solve(shape, steel, brass, load=50.0)
ellipse = hertz.Ellipse(8e-3, 4e-3, hertz.contact_modulus(steel, brass), 50.0)
print(f"{solution.peak_pressure / 1e9:.3f} GPa; Hertz {ellipse.peak_pressure / 1e9:.3f} GPa")

# Johnson, Contact Mechanics (1985), eqs (4.26) to (4.28), with elliptic integrals in 20 digits.
assert math.isclose(ellipse.peak_pressure, 1.2457007e9, rel_tol=1e-7)
assert math.isclose(solution.peak_pressure, 1.2457007e9, rel_tol=1e-3)
