"""
Heat through a joint
====================

Three random surfaces of one spectrum are pressed into steel, and heat flows through their spots.
The mean of their conductances per area is nearly proportional to the mean pressure. Mikic's
correlation needs only the rms height and the mean slope of the surfaces.
"""

import numpy as np

import nacre
from nacre import design, rough

surfaces = [
    rough.random_surface(
        (256, 256),
        (256e-6, 256e-6),
        hurst=0.8,
        shortest=16e-6,
        longest=64e-6,
        rms_slope=0.1,
        rng=seed,
    )
    for seed in (1, 2, 3)
]
steel = nacre.Elastic(young=210e9, poisson=0.3)
joint = design.joint_conductance(
    surfaces,
    steel,
    steel,
    pressures=np.geomspace(10e6, 1e9, 7).tolist(),
    conductivity=46.0,
    counter_conductivity=46.0,
)
axes = joint.plot()
