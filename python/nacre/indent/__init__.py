"""Indentation by axisymmetric tips: exact on any stack of layers, with adhesion, and fits.

The contact of a body of revolution is solved without a grid, from the frequency response of the
layers alone. For shapes that are not of revolution, loads off the axis and friction there is
`nacre.solve`.

Examples
--------
>>> glass, film = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
>>> body = nacre.HalfSpace(glass, [nacre.Layer(film, thickness=1e-6)])
>>> test = nacre.indent.Indentation(body, nacre.indent.Tip.sphere(5e-6))
>>> state = test.at(approach=[50e-9, 100e-9])
>>> state.load.round(5)
array([0.00021, 0.00076])
"""

from nacre._core import Adhesion, Tip, slope_of
from nacre.indent import charts
from nacre.indent.checks import ContactPoint, check, contact_point, suspicious_units
from nacre.indent.classical import Classical, classical, tabor_parameter
from nacre.indent.curves import Curve, Drift, read
from nacre.indent.fit import Fit, fit
from nacre.indent.solution import (
    Indentation,
    IndentCurve,
    IndentSolution,
    IndentState,
    PullOff,
    StateDerivative,
    solve,
)
from nacre.indent.unloading import OliverPharr, oliver_pharr

__all__ = [
    "Adhesion",
    "Classical",
    "ContactPoint",
    "Curve",
    "Drift",
    "Fit",
    "IndentCurve",
    "IndentSolution",
    "IndentState",
    "Indentation",
    "OliverPharr",
    "PullOff",
    "StateDerivative",
    "Tip",
    "charts",
    "check",
    "classical",
    "contact_point",
    "fit",
    "oliver_pharr",
    "read",
    "slope_of",
    "solve",
    "suspicious_units",
    "tabor_parameter",
]
__dir__ = __all__.copy
