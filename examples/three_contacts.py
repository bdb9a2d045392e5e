"""What does nacre compute: a coated roller, a rough contact, the fit of an indentation?

The roller of Spinu et al. carries 1 kN off its centre, bare and with a coating; a random surface is
pressed into a coated body; and the modulus of a film is fitted to a load curve with 3 % of noise.
The program prints the main numbers, and draws all three in a PNG.
"""

import argparse
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import numpy as np

import nacre
from nacre import indent, plot, rough
from nacre.indent import Indentation, Tip

matplotlib.use("Agg")

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--out", type=Path, default=Path("uses.png"))
out = parser.parse_args().out

steel, hard = nacre.Elastic(young=210e9, poisson=0.3), nacre.Elastic(840e9, 0.3)
soft = nacre.Elastic(52.5e9, 0.3)

# The roller, with 0.2 mm of a coating.
roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5, length=30e-3)
grid = nacre.Grid(shape=(384, 64), size=(32e-3, 0.2e-3))
coats = {"bare": [], "soft coating": [nacre.Layer(soft, 200e-6)]}
coats["hard coating"] = [nacre.Layer(hard, 200e-6)]
rollers = {
    name: nacre.solve(
        roller, nacre.HalfSpace(steel, coat), grid=grid, load=1e3, eccentricity=(2.87e-3, None)
    )
    for name, coat in coats.items()
}
for name, solution in rollers.items():
    print(
        f"{name:14} {solution.peak_pressure / 1e6:5.0f} MPa, tilt {solution.tilt[0] * 1e6:.1f} µrad"
    )

# The rough surface.
side = 256e-6
surface = rough.random_surface(
    (256, 256), (side, side), hurst=0.8, rms_slope=0.02, shortest=16e-6, longest=64e-6, rng=2
)
coated = nacre.HalfSpace(steel, [nacre.Layer(hard, 5e-6)])
pressed = nacre.solve(surface, coated, load=400e6 * side**2)
print(f"rough surface  {100 * rough.corrected_area(pressed) / side**2:.1f} % in contact")

# The fit: a film of polymer on glass.
glass, polymer = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
tip, young = Tip.sphere(5e-6), "body.layers[0].material.young"
test = Indentation(nacre.HalfSpace(glass, [nacre.Layer(polymer, 1e-6)]), tip)
depth = np.linspace(10e-9, 200e-9, 60)
noise = 0.03 * np.random.default_rng(1).standard_normal(60)
guess = nacre.HalfSpace(glass, [nacre.Layer(nacre.Elastic(2e9, 0.4), 1e-6)])
fit = indent.fit((depth, test.curve(approach=depth).load * np.exp(noise)), guess, tip, [young])
low, high = fit.intervals[young]
print(f"film           E between {low / 1e9:.2f} and {high / 1e9:.2f} GPa")

with plot.style.styled():
    size = (plot.style.WIDTH, 0.62 * plot.style.WIDTH)
    figure = plt.figure(figsize=size, layout="constrained")
    panels = figure.subplot_mosaic(
        [["roller", "roller"], ["rough", "fit"]], height_ratios=(1, 1.15)
    )
    plot.compare(rollers, at=0.0, axes=panels["roller"])
    panels["roller"].legend(loc="upper left")
    panels["roller"].set_title("a roller that is loaded off its centre")
    plot.pressure_map(pressed, axes=panels["rough"])
    panels["rough"].set_title("a rough surface on a hard coating")
    fit.plot(axes=panels["fit"])
    panels["fit"].set_title(f"the modulus of a film: {low / 1e9:.2f} to {high / 1e9:.2f} GPa")
figure.savefig(out, dpi=230)
