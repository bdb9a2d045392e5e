"""Bearings of several tests."""

import math
from dataclasses import replace

from nacre.bearing import AngularContactBall, SphericalRoller, TaperedRoller

ANGULAR = AngularContactBall(
    count=12, diameter=10e-3, pitch_diameter=60e-3, contact_angle=math.radians(40)
)
THRUST = replace(ANGULAR, contact_angle=math.radians(60))
SPHERICAL = SphericalRoller(
    count=19,
    diameter=12e-3,
    length=11e-3,
    pitch_diameter=82e-3,
    contact_angle=0.17,
    profile_radius=46.5e-3,
)
TAPERED = TaperedRoller(
    count=17, diameter=8e-3, length=11e-3, pitch_diameter=48e-3, contact_angle=math.radians(14)
)
