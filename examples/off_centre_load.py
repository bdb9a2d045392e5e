"""How much does a roller tilt, and its pressure rise, when the force acts off its centre?

The roller of Spinu et al. has a coating twice as stiff as the substrate and is free to tilt along
its axis. The contact is planned once and solved for each position of the force.
"""

import nacre

HALF_FLAT = 19.13e-3 / 2

steel = nacre.Elastic(young=210e9, poisson=0.3)
coating = nacre.Layer(nacre.Elastic(young=420e9, poisson=0.3), thickness=40e-6)
roller = nacre.Roller(radius=5e-3, flat_length=2 * HALF_FLAT, crown_radius=7.5)
grid = nacre.Grid(shape=(384, 48), size=(32e-3, 0.1e-3))
contact = nacre.Contact(nacre.HalfSpace(steel, layers=[coating]), grid)

print("e/L   tilt/1e-5   peak/MPa   contact from/mm   to/mm")
for fraction in (0.0, 0.1, 0.2, 0.3):
    solution = contact.solve(roller, load=1e3, eccentricity=(fraction * HALF_FLAT, None))
    start, end = solution.contact_extent[0]
    print(
        f"{fraction:3.1f}   {solution.tilt[0] * 1e5:9.3f}   {solution.peak_pressure / 1e6:8.0f}"
        f"   {start * 1e3:15.2f}   {end * 1e3:5.2f}"
    )
