"""
Which coating reduces the pressure most?
========================================

Peak pressure under a ball as a function of the thickness and the modulus of a coating on steel.
A soft coating reduces the pressure unless it is thin compared with the contact; a stiff coating
increases it.
"""

import numpy as np

import nacre
from nacre import design, plot

steel = nacre.Elastic(young=210e9, poisson=0.3)
ball = nacre.Sphere(5e-3)
study = design.coating_chart(
    ball,
    steel,
    thickness=np.geomspace(1e-6, 100e-6, 13),
    young=np.geomspace(50e9, 800e9, 13),
    load=20.0,
    progress=False,
)
axes = plot.chart(study)
axes.set_title("peak pressure under a ball of 5 mm, 20 N")

# %%
# # The study also has the largest tension in the coating. In a thin coating it is beside the
# contact; in a thick, stiff coating it is at the interface below the middle, because the coating
# bends.
axes = plot.chart(study, "coating_tension")

# %%
# The shear at the interface is largest for coatings as thick as a fraction of the contact radius.
axes = plot.chart(study, "interface_shear")

# %%
# Bare steel, for comparison:
print(f"{nacre.solve(ball, steel, load=20.0).peak_pressure / 1e9:.3f} GPa")
