"""
Figure 1: a coated sphere
=========================

Pressure as a function of the radius under a rigid sphere, for coatings from a quarter to four times
as stiff as the substrate and as thick as the Hertzian contact radius. Circles are reference values
from the :ref:`Fredholm equation <sphere-by-fredholm>` of the axisymmetric problem, solved to eleven
digits.
"""

import paper
from paper import figures

results = paper.solve()
drawing = figures.figure(1, results)

# %%
# # Errors of peak and approach relative to the reference, and the largest error of the pressure
# within 95 % of the contact radius, relative to the Hertzian peak pressure.
print("E1/E2      peak   approach   pressure")
for deviation in paper.deviations(results):
    print(
        f"{deviation.ratio:5.2f}   {deviation.peak:+.1e}"
        f"   {deviation.approach:+.1e}   {deviation.pressure:.1e}"
    )
