"""
Figure 6: the pressure of a tilted roller
=========================================

Equal coating and substrate, with the load at 0.3 of the half-length of the straight part. The riser
on the loaded side increases, and the other one decreases.
"""

import paper
from paper import figures

drawing = figures.figure(6, paper.solve())
