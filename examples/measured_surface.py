"""How much of a rough ball touches, and does a hard coating change it?

Noise without short waves replaces heights from a microscope. The heights are added to the shape of
a ball. By default, nacre then uses the grid of the measurement.
"""

import numpy as np

import nacre

LOAD = 0.5
CELLS, SPACING = 192, 1e-6
ROUGHNESS = 5e-9
SHORTEST_WAVE = 8e-6

waves = np.fft.fftfreq(CELLS, SPACING)
spectrum = np.fft.fft2(np.random.default_rng(7).standard_normal((CELLS, CELLS)))
spectrum[np.hypot(waves[:, None], waves[None, :]) > 1 / SHORTEST_WAVE] = 0
heights = np.fft.ifft2(spectrum).real
heights *= ROUGHNESS / heights.std()

ball = nacre.Sphere(5e-3) + nacre.HeightMap(heights, spacing=SPACING)
steel = nacre.Elastic(young=210e9, poisson=0.3)
hard = nacre.Layer(nacre.Elastic(young=420e9, poisson=0.3), thickness=2e-6)

print("              area/µm²   mean/GPa   peak/GPa")
for name, layers in {"bare steel": [], "coated": [hard]}.items():
    solution = nacre.solve(ball, nacre.HalfSpace(steel, layers=layers), load=LOAD)
    area, peak = solution.contact_area, solution.peak_pressure
    print(f"{name:12}  {area * 1e12:8.0f}   {LOAD / area / 1e9:8.2f}   {peak / 1e9:8.2f}")
