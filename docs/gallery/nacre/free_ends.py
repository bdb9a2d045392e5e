"""
Free ends of a roller
=====================

A straight steel roller of 10 mm with sharp ends lies on a wider race under 2 kN. As a half-space,
the roller has the pressure of a sharp punch at its ends. With free ends its body is more compliant
there, and most of that peak is gone. Where the race ends flush with the roller, there is no peak at
all.
"""

import warnings

import nacre
from nacre import plot

steel = nacre.Elastic(young=210e9, poisson=0.3)
roller = nacre.Roller(
    radius=5e-3, flat_length=10e-3, crown_radius=1.0, length=10e-3
)
whole, ended = nacre.HalfSpace(steel), nacre.HalfSpace(steel, ends=roller.ends)
grid = nacre.Grid(shape=(500, 64), size=(10e-3, 0.32e-3))
pairs = {
    "roller a half-space": (whole, whole),
    "roller with free ends": (whole, ended),
    "both with free ends": (ended, ended),
}
with warnings.catch_warnings():
    warnings.simplefilter("ignore", nacre.NacreWarning)  # of the ends
    solutions = {
        name: nacre.solve(roller, *pair, grid=grid, load=2e3)
        for name, pair in pairs.items()
    }
axes = plot.compare(solutions, at=0.0)
axes.set_ylim(0, 4.5)

# The peaks are in the outermost 2 % of the length.
inset = axes.inset_axes(
    (0.28, 0.42, 0.46, 0.44), xlim=(4.8, 5.0), ylim=(0, 4.5)
)
for line in axes.lines:
    inset.plot(
        *line.get_data(), color=line.get_color(), linestyle=line.get_linestyle()
    )
inset.set_title("the last 0.2 mm", fontsize=9)
inset.tick_params(labelsize=8)
