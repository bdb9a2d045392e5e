"""
Creep curves of a coated wheel
==============================

A crowned steel wheel of 20 mm radius rolls on steel under 200 N and transmits a force, with a
coating of 50 µm or without. A wheel that transmits a force turns a little faster or slower than it
rolls: the creepage is the difference of the velocities divided by that of rolling.
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
wheel = nacre.Roller(radius=20e-3, flat_length=0.0, crown_radius=60e-3)
wheels: dict[str, nacre.HalfSpace] = {"bare": nacre.HalfSpace(steel)}
for name, young in {
    "soft coating, E₁ = E₂/4": 52.5e9,
    "hard coating, E₁ = 4 E₂": 840e9,
}.items():
    layer = nacre.Layer(
        nacre.Elastic(young=young, poisson=0.3), thickness=50e-6
    )
    wheels[name] = nacre.HalfSpace(steel, layers=[layer])

# %%
# # Dashed lines have the slope of Kalker's coefficient C11 of the same bodies: the force on a
# contact that sticks everywhere.
load, friction = 200.0, 0.3
creepages = np.linspace(-4e-3, 4e-3, 17)
figure, axes = plt.subplots(figsize=(6.2, 4.0), layout="constrained")
for (name, body), colour in zip(
    wheels.items(), ("0.3", "#E69F00", "#0072B2"), strict=True
):
    curve = nacre.friction.creep_curve(
        *(wheel, steel, body),
        creepages=creepages,
        load=load,
        friction=friction,
        tolerance=1e-6,
    )
    force = curve.longitudinal_force / (friction * load)
    axes.plot(1e3 * creepages, force, color=colour, marker=".", label=name)
    free = np.interp(0.0, force, creepages)
    pressed = nacre.solve(wheel, steel, body, load=load)
    (x0, x1), (y0, y1) = pressed.contact_extent
    creep = nacre.creep_coefficients(
        steel, body, ((y1 - y0) / 2, (x1 - x0) / 2)
    )
    slope = (
        creep.c11 * creep.shear * np.prod(creep.semi_axes) / (friction * load)
    )
    short = free + np.array([-1, 1]) * 0.65 / slope
    axes.plot(
        1e3 * short,
        slope * (short - free),
        color=colour,
        linewidth=0.8,
        linestyle="--",
    )
    print(f"{name:24} rolls freely at a creepage of {1e3 * free:+.2f}e-3")
axes.set(
    xlabel="longitudinal creepage [10⁻³]",
    ylabel="force over friction times load",
)
axes.legend(frameon=False)
axes.grid(alpha=0.3)

# %%
# # The soft coating makes the curve flatter, the hard one steeper. With a coating the bodies are
# dissimilar: pressure stretches their surfaces by different amounts, and the wheel rolls freely at
# a creepage other than 0. At half of the force that friction can carry, the leading part of the
# contact sticks. The wheel rolls towards +y.
rolling = nacre.roll(
    wheel, steel, steel, load=load, friction=friction, force=(30.0, None)
)
axes = rolling.plot()
