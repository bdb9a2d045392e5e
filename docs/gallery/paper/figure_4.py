"""
Figure 4: a roller, pressure over the contact
=============================================

With equal coating and substrate under a centred load, there are two risers of equal height.
"""

from nacre import paper
from nacre.paper import figures

drawing = figures.figure(4, paper.solve())
