"""
Figure 3: a roller, pressure across its axis
============================================

The same contacts as in :doc:`figure 2 <figure_2>`, cut across the middle of the roller. A stiff
coating carries the load on a narrow strip, a soft one spreads it.
"""

from nacre import paper
from nacre.paper import figures

drawing = figures.figure(3, paper.solve())
