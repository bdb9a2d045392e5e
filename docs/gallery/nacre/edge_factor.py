"""
The edge factor of ISO/TS 16281, computed
=========================================

The standard multiplies the load of each lamina of a roller by a factor for the stress at its edges,
the same for every bearing. Here it is computed for the roller that carries most: the solved
pressure over that of Hertz under the lamina's load. The approximation is meant for tilts below 4'
(left). Beyond (right) the pressure rises where the roller is pressed in, but not at its very end.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

from nacre import plot
from nacre.bearing import CylindricalRoller, edge_factors

bearing = CylindricalRoller(
    count=14,
    diameter=10e-3,
    length=9.6e-3,
    pitch_diameter=65e-3,
    clearance=41e-6,
)
lamina = np.arange(1, 41)
with plt.rc_context(plot.STYLE):
    figure, pair = plt.subplots(
        1, 2, figsize=(7, 3.2), sharey=True, layout="constrained"
    )
    for axes, angles in zip(pair, ((0, 2, 4), (6, 8, 10)), strict=True):
        axes.plot(lamina, edge_factors(40), "k-", label="ISO/TS 16281, eq. 60")
        for angle, colour in zip(
            angles, ("#0072B2", "#D55E00", "#009E73"), strict=True
        ):
            tilt = math.tan(math.radians(angle / 60))
            solution = bearing.solve(
                force=(4450.0, 0.0, None), tilt=(None, tilt)
            )
            known = solution.edge_factors()[0, 0]
            known[np.asarray(solution.lamina_pressures)[0, 0] == 0] = np.nan
            axes.plot(
                lamina,
                known,
                "o-",
                color=colour,
                markersize=3,
                label=f"solved, {angle}'",
            )
        axes.set(
            xlabel="lamina",
            title="within 4'" if angles[0] == 0 else "beyond 4'",
        )
        axes.legend(frameon=False, loc="upper center")
pair[0].set(ylabel="edge factor", ylim=(0.8, 2.5))
