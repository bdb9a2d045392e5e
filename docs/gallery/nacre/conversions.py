"""
Errors of the conversions by inverse FFT
========================================

Spinu et al. obtain influence coefficients by transforming the frequency response back on a mesh of
finite extent. The ``exact`` coefficients of nacre are free of the error of this conversion. The
picture shows the error relative to ``exact`` as a function of the offset along x, for a coating
four times as stiff as its substrate and eight cells thick (:ref:`conversions`).
"""

from typing import Literal

import matplotlib.pyplot as plt
import numpy as np

import nacre

soft, stiff = (
    nacre.Elastic(young=1.0, poisson=0.3),
    nacre.Elastic(young=4.0, poisson=0.3),
)
body = nacre.HalfSpace(soft, layers=[nacre.Layer(stiff, thickness=8.0)])
grid = nacre.Grid(shape=(64, 64), size=(64.0, 64.0))
exact = nacre.influence_coefficients(body, grid)

# %%
# A larger refinement χ of the spectral mesh moves the periodic images away and has no other effect.
figure, axes = plt.subplots(figsize=(6, 3.8), layout="constrained")
styles: dict[Literal["plain", "difference", "image"], str]
styles = {"plain": "-", "difference": "--", "image": ":"}
for method, style in styles.items():
    for refinement, colour in ((1, "#56B4E9"), (4, "#0072B2")):
        converted = nacre.influence_coefficients(body, grid, method, refinement)
        error = np.abs(converted / exact - 1)
        label = f"{method}, χ = {refinement}"
        axes.semilogy(error[:, 0], color=colour, linestyle=style, label=label)
        print(
            f"{label:20} loaded cell {error[0, 0]:.1e}, "
            f"largest {error.max():.1e}"
        )
axes.set(
    xlabel="offset [cells]",
    ylabel="relative error of the coefficient",
    xlim=(0, 63),
)
axes.legend(frameon=False, ncols=2)
