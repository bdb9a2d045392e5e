"""
Figure 4: a roller, pressure over the contact
=============================================

With equal coating and substrate under a centred load, there are two risers of equal height.
"""

import paper
from paper import figures

drawing = figures.figure(4, paper.solve())
