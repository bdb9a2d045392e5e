"""
A rough surface in contact
==========================

A ball with a rough surface in contact with a coated body. In place of a measurement, the heights
are noise of 5 nm rms without short wavelengths. The picture is ``solution.plot()``.
"""

import numpy as np

import nacre

cells, spacing, shortest_wave, height = 256, 1e-6, 8e-6, 5e-9
waves = np.fft.fftfreq(cells, spacing)
spectrum = np.fft.fft2(np.random.default_rng(7).standard_normal((cells, cells)))
spectrum[np.hypot(waves[:, None], waves[None, :]) > 1 / shortest_wave] = 0
heights = np.fft.ifft2(spectrum).real
heights *= height / heights.std()

ball = nacre.Sphere(5e-3) + nacre.HeightMap(heights, spacing=spacing)
steel = nacre.Elastic(young=210e9, poisson=0.3)
hard = nacre.Layer(nacre.Elastic(young=420e9, poisson=0.3), thickness=2e-6)
body = nacre.HalfSpace(steel, layers=[hard])
solution = nacre.solve(ball, body, load=2.0)
parts = solution.plot()

# %%
# The smooth ball on the same cells, for comparison:
smooth = nacre.solve(
    nacre.Sphere(5e-3), body, grid=solution.report.grid, load=2.0
)
for name, solved in {"smooth": smooth, "rough": solution}.items():
    peak, area = solved.peak_pressure, solved.contact_area
    print(f"{name:8} peak {peak / 1e9:.2f} GPa, area {area * 1e12:.0f} µm²")
