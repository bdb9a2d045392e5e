"""
What can an indentation curve tell of a layer?
==============================================

Least standard deviations of modulus and thickness of a layer twice as stiff as its substrate, from
one curve of 60 points with a noise of 1 %, over the contact radius that the curve reaches.
"""

import numpy as np

from nacre.indent.charts import information
from nacre.plot import indent_charts

reach = np.geomspace(0.05, 5, 21)
axes = indent_charts.information(reach, information(2.0, reach))
