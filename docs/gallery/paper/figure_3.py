"""
Figure 3: a roller, pressure across its axis
============================================

Sections across the middle of the roller, for the contacts of :doc:`figure 2 <figure_2>`. A stiff
coating carries the load on a narrow strip, a soft coating on a wide one.
"""

import paper
from paper import figures

drawing = figures.figure(3, paper.solve())
