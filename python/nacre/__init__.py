"""Elastic contact of coated bodies.

A shape is pressed into a half-space that carries any number of layers, by a force that may act
off-centre::

    g = h + u(p) - approach - tilt_x x - tilt_y y >= 0,    p >= 0,    p g = 0

Examples
--------
>>> import nacre
>>> steel = nacre.Elastic(young=210e9, poisson=0.3)
>>> dlc = nacre.Elastic(young=420e9, poisson=0.3)
>>> body = nacre.HalfSpace(steel, layers=[nacre.Layer(dlc, thickness=40e-6)])
>>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=100.0)
>>> round(solution.peak_pressure / 1e9, 2)
3.86
"""

from nacre import _core
from nacre._core import *  # noqa: F403  the public names, which _core.pyi lists
from nacre.files import load
from nacre.studies import sweep

__all__ = ["load", "sweep"]
__all__ += _core.__all__
