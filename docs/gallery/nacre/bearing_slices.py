"""
Rollers against the laminae of ISO/TS 16281
===========================================

The approach of both rings to a roller of 10 mm by 9.6 mm with the profile of the standard, over the
load. The standard takes laminae that do not feel each other; nacre solves the contact. As
half-spaces the two agree within 6 %. Free ends make the roller softer, and the more so the farther
the contact reaches.
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre
from nacre import plot
from nacre.bearing import CylindricalRoller

steel = nacre.Elastic(young=210e9, poisson=0.3)
bearing = CylindricalRoller(
    count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3
)
loads = np.geomspace(200.0, 2000.0, 7)
grid = nacre.Grid((120, 48), (9.6e-3, 6e-4))
ended = nacre.HalfSpace(steel, ends=(-4.8e-3, 4.8e-3))
profile = nacre.LogarithmicProfile.iso16281(10e-3, 9.6e-3)
x = (np.arange(40) + 0.5) / 40 * 9.6e-3 - 4.8e-3


def carried(approach: float) -> float:
    """Return the load of the standard's laminae, in which lengths are in mm."""
    deflection = np.maximum(approach - 2 * profile.drop_at(x), 0.0) * 1e3
    return float((35948 * 9.6 ** (8 / 9) / 40 * deflection ** (10 / 9)).sum())


approaches = np.linspace(0.0, 25e-6, 500)
laminae = np.interp(loads, [carried(one) for one in approaches], approaches)
solved = {
    name: np.array(
        [
            sum(
                nacre.Contact(steel, grid, roller)
                .solve(bearing.shape(ring), load=load)
                .approach
                for ring in ("inner", "outer")
            )
            for load in loads
        ]
    )
    for name, roller in (("half-spaces", steel), ("free ends", ended))
}
with plt.rc_context(plot.STYLE):
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(7, 3.2), layout="constrained"
    )
    left.plot(loads, laminae * 1e6, "k-", label="ISO/TS 16281")
    for (name, values), colour in zip(
        solved.items(), ("#0072B2", "#D55E00"), strict=True
    ):
        left.plot(
            loads, values * 1e6, "o-", color=colour, markersize=3, label=name
        )
        right.plot(
            loads,
            100 * (values / laminae - 1),
            "o-",
            color=colour,
            markersize=3,
        )
left.set(xlabel="load of a roller [N]", ylabel="approach of both rings [µm]")
right.set(xlabel="load of a roller [N]", ylabel="against the laminae [%]")
right.axhspan(-6, 6, color="0.92", zorder=0)
left.legend(frameon=False)
