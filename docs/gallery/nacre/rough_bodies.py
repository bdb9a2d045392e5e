"""
A rough surface on bare, coated and graded bodies
=================================================

The same random surface is pressed with the same mean pressure into three bodies: bare steel, a hard
coating, and a graded coating whose modulus falls from that of the hard coating at the surface to
that of the steel. The titles state the share of the area in contact.
"""

import matplotlib.pyplot as plt

import nacre
from nacre import plot, rough

side = 256e-6
surface = rough.random_surface(
    (256, 256),
    (side, side),
    hurst=0.8,
    rms_slope=0.02,
    shortest=16e-6,
    longest=64e-6,
    rng=2,
)
steel, hard = (
    nacre.Elastic(young=210e9, poisson=0.3),
    nacre.Elastic(young=630e9, poisson=0.3),
)
graded = nacre.graded_layers(
    steel,
    10e-6,
    young=lambda z: 630e9 - 420e9 * z / 10e-6,
    poisson=0.3,
    tolerance=1e-2,
)
bodies = {
    "bare": nacre.HalfSpace(steel),
    "coating of 10 µm": nacre.HalfSpace(steel, [nacre.Layer(hard, 10e-6)]),
    "graded over 10 µm": nacre.HalfSpace(steel, graded),
}

figure, axes = plt.subplots(2, 3, figsize=(10, 6), layout="constrained")
for column, (name, body) in zip(axes.T, bodies.items(), strict=True):
    solution = nacre.solve(surface, body, load=400e6 * side**2)
    plot.patches(solution, axes=column[0])
    share = rough.corrected_area(solution) / side**2
    column[0].set_title(f"{name}: {100 * share:.1f} %", loc="left", fontsize=9)
    plot.distribution(rough.pressure_distribution(solution), axes=column[1])
    column[1].set(xlim=(0, 20), ylim=(0, 0.06))
