"""
What can an indentation curve tell of a layer?
==============================================

Smallest standard deviations of the modulus and thickness of a layer twice as stiff as its
substrate, from one curve of 60 points with 1 % noise, as a function of the contact radius that the
curve reaches.
"""

import numpy as np

from nacre.indent.charts import information
from nacre.plot import indent_charts

reach = np.geomspace(0.05, 5, 21)
axes = indent_charts.information(reach, information(2.0, reach))
