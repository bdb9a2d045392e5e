"""
How deep may I indent a coating?
================================

Largest contact radius, relative to the thickness, at which formulae for bare bodies give the
modulus of the layer within 1 %. There is no limit where both moduli are equal.
"""

import numpy as np

from nacre.indent.charts import bulk_limit
from nacre.plot import indent_charts

ratios = np.geomspace(0.01, 10, 31)
axes = indent_charts.bulk_limit(ratios, bulk_limit(ratios))
