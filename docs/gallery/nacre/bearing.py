"""
A cylindrical roller bearing
============================

Fourteen rollers of 10 mm under 4.45 kN, with a ring that is tilted by 2'. Left, the load of each
roller; right, the pressure along the one that carries most, on both rings. The tilt moves the
pressure towards one end.
"""

import math

from nacre.bearing import CylindricalRoller

bearing = CylindricalRoller(
    count=14,
    diameter=10e-3,
    length=9.6e-3,
    pitch_diameter=65e-3,
    clearance=41e-6,
)
solution = bearing.solve(
    force=(4450.0, 0.0, None), tilt=(None, math.tan(math.radians(2 / 60)))
)
axes = solution.plot()
