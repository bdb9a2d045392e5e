"""
A fretting loop of a coated ball
================================

A ball of 5 mm radius is pressed by 20 N on steel with 20 µm of a coating twice as stiff, and cycled
along it. The force is always below the one at which the ball would slide, so a part of the contact
sticks. The area of the loop is the energy that friction dissipates in one cycle.
"""

import numpy as np

import nacre
from nacre import plot

steel = nacre.Elastic(young=210e9, poisson=0.3)
hard = nacre.Elastic(young=420e9, poisson=0.3)
plate = nacre.HalfSpace(steel, layers=[nacre.Layer(hard, thickness=20e-6)])

# %%
# # The force rises to 3.2 N, falls to −3.2 N, and rises again; friction can carry 4 N.
turns = [0.0, 3.2, -3.2, 3.2]
forces = np.interp(np.linspace(0, 3, 25), range(4), turns)
steps = [{"force": (force, None)} for force in forces]
loop = nacre.slide(
    nacre.Sphere(5e-3), plate, steel, load=20.0, friction=0.2, steps=steps
)
axes = plot.loop(loop)
dissipated = sum(step.dissipated for step in loop[9:])
print(f"dissipated in a cycle: {dissipated * 1e9:.0f} nJ")

# %%
# # On the way back, at a force of 0, the middle sticks and the rim slips. The tractions that the
# pull has left in the middle are balanced by those of the rim.
axes = loop[12].plot()
