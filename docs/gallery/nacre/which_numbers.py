"""
Which numbers of a coated contact matter?
=========================================

Logarithmic derivatives of three outputs of a coated ball under 10 N: 1 % more of a number changes
an output by so many per cent. The ball is that of :doc:`/howto/gradients`.
"""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
coating = nacre.Layer(nacre.Elastic(young=420e9, poisson=0.2), thickness=20e-6)
body = nacre.HalfSpace(steel, [coating])
solution = nacre.solve(nacre.Sphere(radius=5e-3), body, load=10.0)

numbers = {
    "body.layers[0].material.young": ("modulus of the coating", 420e9),
    "body.layers[0].thickness": ("thickness of the coating", 20e-6),
    "body.substrate.young": ("modulus of the steel", 210e9),
    "shape.radius": ("radius of the ball", 5e-3),
    "load": ("load", 10.0),
}
outputs: dict[str, Any] = {
    "peak pressure": "peak_pressure",
    "approach": "approach",
    "shear at the interface": {
        "stress": "plane_shear",
        "interface": 0,
        "sharpness": 200.0,
    },
}
gradients = solution.gradient(list(outputs.values()), list(numbers))

figure, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
places, height = np.arange(len(numbers)), 0.26
for k, (name, gradient) in enumerate(zip(outputs, gradients, strict=True)):
    shares = [
        gradient[path] * value / gradient.value
        for path, (_, value) in numbers.items()
    ]
    bars = axes.barh(places + (k - 1) * height, shares, height, label=name)
    axes.bar_label(bars, fmt="%+.2f", padding=3, fontsize=8)
axes.axvline(0, color="black", linewidth=0.8)
axes.set_yticks(places, [words for words, _ in numbers.values()])
axes.invert_yaxis()
axes.set(xlabel="change in % for 1 % more", xlim=(-1.0, 1.0))
axes.legend(frameon=False, loc="upper left", bbox_to_anchor=(1, 1))
