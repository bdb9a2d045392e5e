"""
Figure 2: a roller, pressure along its axis
===========================================

The roller of Spinu et al. under a centred load of 1 kN. Where the straight part ends and the
crowned part begins, the curvature of the profile jumps, and the pressure rises to a peak, the
riser.
"""

import paper
from paper import figures

results = paper.solve()
drawing = figures.figure(2, results)

# %%
# Spinu et al. state that a more compliant coating lowers the riser and enlarges the contact. The
# area does increase with both coatings. The riser decreases with a coating of 0.2 mm, and hardly
# changes with one of 0.04 mm, about the half-width of the contact. Changes are relative to E1 = E2.
print(f"{'':34}E1/E2     riser      area")
for claim in paper.claims(results):
    if claim.series in paper.CENTRED:
        print(
            f"{claim.series.title:34}{claim.ratio:5.2f}"
            f"{100 * claim.riser:+8.1f} %"
            f"{100 * claim.area:+8.0f} %"
        )
