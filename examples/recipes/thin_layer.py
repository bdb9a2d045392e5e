"""Indent a thin layer on a rigid base with a flat punch, and find what the base adds."""

import math

import nacre
from nacre.indent import Indentation, Tip

gel = nacre.Elastic(young=1e4, poisson=0.3)
layer = nacre.HalfSpace(nacre.RIGID, layers=[nacre.Layer(gel, thickness=1e-3)])
radius, approach = 1e-3, 1e-6

load = Indentation(layer, Tip.flat_punch(radius)).at(approach=approach).load
factor = load / (2 * gel.plane_strain_modulus * radius * approach)  # over that of a half-space
print(f"the layer is {factor:.3f} times as stiff as a half-space")

# Hayes et al., J. Biomech. 5 (1972) 541, table 1, which is low by 0.14 % here.
assert math.isclose(factor, 2.480, rel_tol=2e-3)
