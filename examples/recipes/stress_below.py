"""Find the largest shear stress below a ball, and its depth."""

import math

import numpy as np

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
solution = nacre.solve(nacre.Paraboloid(10e-3, 10e-3), steel, load=20.0)
radius = (3 * 20.0 * 10e-3 / (4 * steel.plane_strain_modulus)) ** (1 / 3)

depths = radius * np.linspace(0.3, 0.7, 41)
field = solution.stress(depths, x=0.0, y=0.0)
shear = np.abs(field.zz - field.xx).ravel() / 2  # the principal stresses on the axis
worst = int(shear.argmax())
print(f"{shear[worst] / 1e6:.0f} MPa at a depth of {depths[worst] * 1e6:.0f} µm")

# Johnson, Contact Mechanics (1985), section 3.4: 0.31 of the peak pressure at 0.48 of the radius.
assert math.isclose(shear[worst] / solution.peak_pressure, 0.31, abs_tol=0.005)
assert math.isclose(depths[worst] / radius, 0.48, abs_tol=0.015)
