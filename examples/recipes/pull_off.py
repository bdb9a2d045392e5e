"""Find the force that pulls an adhering ball off a soft body."""

import math

import nacre
from nacre.indent import Adhesion, Indentation, Tip

radius, energy = 10e-6, 0.05  # m, J/m²
rubber = nacre.Elastic(young=2e6, poisson=0.49)
contact = Indentation(rubber, Tip.paraboloid(radius), adhesion=Adhesion.jkr(energy))
force = contact.pull_off().load
print(f"{-force * 1e6:.4f} µN")

# Johnson, Kendall and Roberts (1971): 3/2 π w R.
assert math.isclose(-force, 1.5 * math.pi * energy * radius, rel_tol=1e-6)
