"""Find how the peak pressure depends on load and modulus without solving again."""

import math

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
solution = nacre.solve(nacre.Paraboloid(10e-3, 10e-3), steel, load=20.0)
peak = solution.gradient("peak_pressure")
for path, number in (("load", 20.0), ("body.substrate.young", 210e9)):
    exponent = peak[path] * number / peak.value
    print(f"the peak pressure grows as {path} to the power of {exponent:.3f}")

# Hertz: 1/3 and 2/3.
assert math.isclose(peak["load"] * 20.0 / peak.value, 1 / 3, rel_tol=5e-3)
assert math.isclose(peak["body.substrate.young"] * 210e9 / peak.value, 2 / 3, rel_tol=5e-3)
