"""
How does a coating change the force of pull-off?
================================================

JKR pull-off force of a sphere (Johnson, Kendall and Roberts) as a function of the thickness of a
layer in units of the pull-off radius on the bare substrate. A bare body gives 1.5.
"""

import numpy as np

from nacre.indent.charts import pull_off_over_thickness
from nacre.plot import indent_charts

thickness = np.geomspace(0.03, 30, 91)
forces = {
    ratio: pull_off_over_thickness(ratio, thickness)
    for ratio in (0.1, 0.5, 2.0, 10.0)
}
axes = indent_charts.pull_off(thickness, forces)
