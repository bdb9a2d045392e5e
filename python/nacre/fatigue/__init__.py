"""Shakedown and fatigue of contacts that roll or slide.

A point of a body that rolls sees the stresses on the line through it along the direction of
rolling, one after the other. `assess` says which load each layer of a solved contact can carry:
without yielding, after it has shaken down, and by criteria of multiaxial fatigue. `shakedown` and
the criteria also take histories of any origin.

Examples
--------
>>> from nacre import fatigue
>>> steel = nacre.Elastic(young=210e9, poisson=0.3)
>>> grid = nacre.Grid.line(96, 3e-4)
>>> solution = nacre.solve(nacre.Cylinder(5e-3), steel, load=1e5, grid=grid)
>>> summary = fatigue.assess(solution, shear_yield=600e6, friction=0.1)
>>> round(summary.layers[0].safety_factors["shakedown"], 2)
1.77
"""

from nacre.fatigue.criteria import CRITERIA as CRITERIA
from nacre.fatigue.criteria import Crossland, DangVan, Findley, Matake, Shakedown, shakedown
from nacre.fatigue.map import ShakedownMap, shakedown_map
from nacre.fatigue.summary import FatigueSummary, InterfaceFatigue, LayerFatigue, assess

__all__ = [
    "Crossland",
    "DangVan",
    "FatigueSummary",
    "Findley",
    "InterfaceFatigue",
    "LayerFatigue",
    "Matake",
    "Shakedown",
    "ShakedownMap",
    "assess",
    "shakedown",
    "shakedown_map",
]
__dir__ = __all__.copy
