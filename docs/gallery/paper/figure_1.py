"""
Figure 1: a coated sphere
=========================

Pressure over the radius under a rigid sphere, for coatings from a quarter to four times as
stiff as what they are on and as thick as the contact radius of Hertz. Circles are reference
values: the Fredholm equation of the axisymmetric problem, solved to eleven digits (:ref:`how
<sphere-by-fredholm>`).
"""

from nacre import paper
from nacre.paper import figures

results = paper.solve()
drawing = figures.figure(1, results)

# %%
# How far the solutions are from the reference, relative to it; of the pressure, the largest
# difference within 95 % of the contact radius, over the peak of Hertz.
print("E1/E2      peak   approach   pressure")
for deviation in paper.deviations(results):
    print(
        f"{deviation.ratio:5.2f}   {deviation.peak:+.1e}   {deviation.approach:+.1e}"
        f"   {deviation.pressure:.1e}"
    )
