"""What does a coating change: pressure, contact and the place where the steel is most stressed?

A ball of 5 mm radius is pressed with 20 N on bare steel, and on steel with 20 µm of a coating half
and twice as stiff. The program prints peak pressure, contact radius and the largest von Mises
stress in the substrate, and draws pressure and stresses in a PNG, the headline picture of nacre.
"""

import argparse
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt

import nacre
from nacre import plot

matplotlib.use("Agg")

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--out", type=Path, default=Path("coating.png"))
out = parser.parse_args().out

steel = nacre.Elastic(young=210e9, poisson=0.3)
coatings = {"soft": nacre.Elastic(105e9, 0.3), "hard": nacre.Elastic(420e9, 0.3)}
bodies = {"bare": nacre.HalfSpace(steel)}
for name, material in coatings.items():
    bodies[f"{name} coating"] = nacre.HalfSpace(steel, [nacre.Layer(material, 20e-6)])

grid = nacre.Grid(shape=(160, 160), size=(0.2e-3, 0.2e-3))
solutions = {
    name: nacre.solve(nacre.Sphere(5e-3), body, grid=grid, load=20.0)
    for name, body in bodies.items()
}
print("                peak/GPa   radius/µm   von Mises in the steel/GPa")
for name, solution in solutions.items():
    (left, right), _ = solution.contact_extent
    steel_below = solution.stress_summary().layers[-1]
    print(
        f"{name:14}   {solution.peak_pressure / 1e9:6.3f}     {(right - left) / 2e-6:6.1f}"
        f"      {steel_below.von_mises[0] / 1e9:6.3f}"
    )

sections = ("bare", "hard coating")
with plot.style.styled():
    figure = plt.figure(figsize=(plot.style.WIDTH, 0.65 * plot.style.WIDTH), layout="constrained")
    panels = figure.subplot_mosaic([["pressure", "pressure"], [*sections]], height_ratios=(1.1, 1))
    plot.compare(solutions, axes=panels["pressure"])
    panels["pressure"].legend(loc="lower center")
    for name in sections:
        axes = plot.stress_section(solutions[name], depth=85e-6, axes=panels[name])
        axes.collections[0].set_clim(0, 1.6)
        axes.set_title(f"{name}, 20 N")
figure.savefig(out, dpi=160)
