"""
Figure 4: a roller, pressure over the contact
=============================================

Coating and substrate alike, load in the middle: two risers of the same height.
"""

from nacre import paper
from nacre.paper import figures

drawing = figures.figure(4, paper.solve())
