"""
Full contact of a wave on three bodies
======================================

A wavy surface is pressed flat against a bare body, a body with a hard coating, and a soft layer on
a rigid base. The pressure at which the last gap closes is the height of the wave divided by the
response of the body to it: p* = Δ / (û/p̂), with waves Δ cos(2πx/λ).
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre

length, height, cells = 100e-6, 0.2e-6, 128
grid = nacre.Grid(
    (cells, 8), (length, 8 * length / cells), periodic=(True, True)
)
wave = np.repeat(
    height * np.cos(2 * np.pi * grid.x / length)[:, np.newaxis], 8, axis=1
)
shape = nacre.HeightMap(wave, spacing=length / cells, periodic=(True, True))

steel = nacre.Elastic(young=210e9, poisson=0.3)
hard = nacre.Layer(nacre.Elastic(young=420e9, poisson=0.3), thickness=10e-6)
soft = nacre.Layer(nacre.Elastic(young=3e9, poisson=0.4), thickness=20e-6)
bodies = {
    "bare steel": nacre.HalfSpace(steel),
    "hard coating of λ/10": nacre.HalfSpace(steel, [hard]),
    "polymer of λ/5 on a rigid base": nacre.HalfSpace(nacre.RIGID, [soft]),
}

figure, axes = plt.subplots(1, 3, figsize=(9, 3), layout="constrained")
for ax, (name, body) in zip(axes, bodies.items(), strict=True):
    alpha = 2 * np.pi / length
    full = height / (nacre.frequency_response(body, [alpha])[0])
    for share in (0.2, 0.5, 1.0):
        load = share * full * length * grid.size[1]
        solution = nacre.solve(shape, body, load=load, grid=grid)
        label = f"p̄ = {share:g} p*"
        ax.plot(1e6 * grid.x, solution.pressure[:, 0] / full, label=label)
    ax.set(xlabel="x [µm]", title=f"{name}\np* = {full / 1e6:.0f} MPa")
axes[0].set_ylabel("pressure / p*")
figure.legend(
    *axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3
)

# %%
# At p̄ = p* the pressure is p* (1 + cos(2πx/λ)) on every body, and the gap is closed:
print(f"largest gap {solution.gap.max() * 1e9:.3f} nm")
