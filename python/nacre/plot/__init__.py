"""Pictures of solutions and studies, with Matplotlib, and an interactive view with PyVista.

Every function draws into axes that are passed in, or into a new figure, and returns the axes. Axes
carry units with a prefix, SI or those of `nacre.display_units`. `nacre.Solution` has most of the
functions as methods.
"""

from nacre.plot.bearing import bearing, bearing_pair, elements_pressure, load_distribution
from nacre.plot.fatigue import fatigue_depth, shakedown_map
from nacre.plot.friction import creep_curve, friction, loop
from nacre.plot.interfaces import interface_map
from nacre.plot.maps import overview, pressure_map
from nacre.plot.optimise import course
from nacre.plot.relief import relief, view
from nacre.plot.rough import distribution, heights, load_curve, patches, spectrum
from nacre.plot.sections import compare, section
from nacre.plot.stress import stress_depth, stress_section
from nacre.plot.studies import chart, curve
from nacre.plot.style import STYLE
from nacre.plot.wear import animate_wear, wear

__all__ = [
    "STYLE",
    "animate_wear",
    "bearing",
    "bearing_pair",
    "chart",
    "compare",
    "course",
    "creep_curve",
    "curve",
    "distribution",
    "elements_pressure",
    "fatigue_depth",
    "friction",
    "heights",
    "interface_map",
    "load_curve",
    "load_distribution",
    "loop",
    "overview",
    "patches",
    "pressure_map",
    "relief",
    "section",
    "shakedown_map",
    "spectrum",
    "stress_depth",
    "stress_section",
    "view",
    "wear",
]
__dir__ = __all__.copy
