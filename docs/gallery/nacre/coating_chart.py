"""
Which coating spares the most pressure?
=======================================

Peak pressure under a ball over the thickness and the modulus of a coating on steel. A soft
coating helps once it is not thin against the contact; a stiff one costs.
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
# The same study has the largest tension in the coating. A thin one is pulled most beside the
# contact; a stiff and thicker one at the interface below the middle, where it bends.
axes = plot.chart(study, "coating_tension")

# %%
# The interface is sheared most where it lies at a fraction of the contact's radius.
axes = plot.chart(study, "interface_shear")

# %%
# Bare steel, for comparison:
print(f"{nacre.solve(ball, steel, load=20.0).peak_pressure / 1e9:.3f} GPa")
