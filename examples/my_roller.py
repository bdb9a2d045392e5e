"""What pressure does my own roller make, and how far does the contact reach?

A steel roller of 10 mm diameter with crowned ends, on steel with a coating of 2 µm. Replace the
numbers by yours: nacre chooses the grid, and warns where the model does not hold.
"""

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
coating = nacre.Layer(nacre.Elastic(young=250e9, poisson=0.25), thickness=2e-6)
roller = nacre.Roller(radius=5e-3, flat_length=6e-3, crown_radius=1.0)
race = nacre.HalfSpace(steel, layers=[coating])
solution = nacre.solve(roller, race, counterbody=steel, load=1000.0)

(x0, x1), (y0, y1) = solution.contact_extent
print(f"peak pressure  {solution.peak_pressure / 1e6:8.0f} MPa")
print(f"in the middle  {solution.central_pressure / 1e6:8.0f} MPa")
print(f"contact length {(x1 - x0) * 1e3:8.2f} mm")
print(f"contact width  {(y1 - y0) * 1e3:8.3f} mm")
print(f"approach       {solution.approach * 1e6:8.3f} µm")
