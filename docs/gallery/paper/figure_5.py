"""
Figure 5: a roller under an off-centre load
===========================================

The load acts at 0.3 of the half-length of the straight part, and the roller is free to tilt along
its axis. The sections are along and across the axis, for two thicknesses of the coating. The
pressure increases towards the load, most with a stiff coating as thick as the contact is wide.
"""

import paper
from paper import figures

results = paper.solve()
drawing = figures.figure(5, results)

# %%
# The tilt that balances the moment, and the riser as the ratio of peak to central pressure.
print("h/mm   E1/E2   tilt/1e-5   peak/MPa   riser")
for series in paper.ECCENTRIC:
    for result in paper.of_series(results, series):
        solution = result.solution
        tilt, peak = 1e5 * solution.tilt[0], 1e-6 * solution.peak_pressure
        case = f"{1e3 * series.thickness:4.2f}   {result.ratio:5.2f}"
        print(f"{case}   {tilt:9.2f}   {peak:8.0f}   {result.riser:5.3f}")
