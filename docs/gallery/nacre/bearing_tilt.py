"""
A misaligned roller bearing, bare and coated
============================================

What a tilt of the ring does to the rollers of a bearing: the largest pressure, and that in the
outer tenths of the rollers, bare and with 20 µm of bronze on both rings. Life is the reference life
of ISO/TS 16281, a model, of the bare bearing, with factors for the edges from the standard, from
the solved pressure, and without. The standard means its factors for tilts below 4' (shaded).
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import nacre
from nacre import plot
from nacre.bearing import CylindricalRoller

steel = nacre.Elastic(young=210e9, poisson=0.3)
bronze = nacre.Layer(nacre.Elastic(young=100e9, poisson=0.33), thickness=20e-6)
races = {
    "bare": nacre.HalfSpace(steel),
    "coated": nacre.HalfSpace(steel, [bronze]),
}
minutes = np.linspace(0.0, 10.0, 6)
with plt.rc_context(plot.STYLE):
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(7, 3.4), layout="constrained"
    )
    for (name, race), colour in zip(
        races.items(), ("#0072B2", "#D55E00"), strict=True
    ):
        bearing = CylindricalRoller(
            count=14,
            diameter=10e-3,
            length=9.6e-3,
            pitch_diameter=65e-3,
            clearance=41e-6,
            inner=race,
            outer=race,
        )
        solved = [
            bearing.solve(
                force=(4450.0, 0.0, None),
                tilt=(None, math.tan(math.radians(angle / 60))),
                cells=(80, 40),
            )
            for angle in minutes
        ]
        style = {"color": colour, "marker": "o", "markersize": 3}
        peak = [one.peak_pressure / 1e9 for one in solved]
        edge = [one.edge_pressure / 1e9 for one in solved]
        left.plot(minutes, peak, "-", label=f"{name}, largest", **style)
        left.plot(minutes, edge, "--", label=f"{name}, outer tenths", **style)
        if name == "coated":
            continue
        lives = {
            "ISO's factors": [one.life("standard").l10r for one in solved],
            "solved": [one.life("pressure").l10r for one in solved],
            "none": [one.life(None).l10r for one in solved],
        }
        for (words, life), dashes in zip(
            lives.items(), ("-", "--", ":"), strict=True
        ):
            right.plot(minutes, life, dashes, label=words, **style)
left.set(xlabel="tilt of the ring [']", ylabel="pressure [GPa]", ylim=(0, None))
right.set(
    xlabel="tilt of the ring [']",
    ylabel="life, a model [million rev.]",
    ylim=(0, None),
)
right.axvspan(0, 4, color="0.93", zorder=0)
for axes in (left, right):
    axes.legend(frameon=False, fontsize=7)
