"""Find the traction of a wheel of a locomotive at a given creepage."""

import math

import nacre
from nacre import hertz

steel = nacre.Elastic(young=2 * 82e9 * 1.28, poisson=0.28)
load, friction, radii = 106.7e3, 0.33, (0.625, 1 / (2 * 0.2814))
ellipse = hertz.Ellipse(*radii, hertz.contact_modulus(steel, steel), load)
a, b = ellipse.semi_axes
grid = nacre.Grid((48, 44), (2.2 * a, 2.2 * b))

solution = nacre.roll(
    nacre.Paraboloid(*radii),
    steel,
    steel,
    grid=grid,
    load=load,
    friction=friction,
    creepage=(8e-4, None),
    direction="+x",
    order=1,
)
ratio = solution.force[0] / (friction * load)
print(f"{100 * ratio:.2f} % of the full friction, {int(solution.stick.sum())} cells stick")

# Printed by CONTACT, example tractcurv, for the same cells.
assert math.isclose(ratio, 0.4742, rel_tol=6e-4)
assert int(solution.stick.sum()) == 976
