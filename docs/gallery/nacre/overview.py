"""
Pictures of a solution
======================

A ball of 5 mm radius under 100 N on steel with a coating 40 µm thick and twice as stiff: the
contact of the :doc:`ten-minute start </start>`.
"""

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
hard = nacre.Elastic(young=420e9, poisson=0.3)
plate = nacre.HalfSpace(steel, layers=[nacre.Layer(hard, thickness=40e-6)])
solution = nacre.solve(nacre.Sphere(5e-3), plate, load=100.0)

# %%
# :py:meth:`nacre.Solution.plot` draws the pressure from above, its sections, and the most important
# numbers.
parts = solution.plot()

# %%
# :py:meth:`nacre.Solution.plot_3d` draws the pressure as a relief.
axes = solution.plot_3d()
