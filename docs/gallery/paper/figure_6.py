"""
Figure 6: the pressure of a tilted roller
=========================================

Coating and substrate alike, load at 0.3 of the straight part's half-length: the riser on the
loaded side grows, the other one fades.
"""

from nacre import paper
from nacre.paper import figures

drawing = figures.figure(6, paper.solve())
