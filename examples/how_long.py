"""How long does my coating last?

A steel roller slides on a coat of DLC. The distance after which the coat is through depends on its
thickness, the load and the wear rate; twice the rate is half the distance.
"""

import nacre

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
DLC = nacre.Elastic(young=300e9, poisson=0.2)
THICKNESS = [1e-6, 2e-6, 4e-6]
LOAD = [5e4, 1e5, 2e5]

case = {
    "shape": nacre.Cylinder(10e-3),
    "body": nacre.HalfSpace(STEEL, layers=[nacre.Layer(DLC, thickness=1e-6)]),
    "counterbody": STEEL,
    "grid": nacre.Grid.line(128, 1.4e-3),
    "rate": {0: 1e-17, "substrate": 1e-15},  # m²/N: 1e-8 and 1e-6 mm³/(N m)
    "sliding": 1e4,
    "until": "through",
}
study = nacre.sweep(case, {"body.layers[0].thickness": THICKNESS, "load": LOAD})

print("km until the coat is through, under")
print("thickness/µm" + "".join(f"{load / 1e3:8.0f} N/mm" for load in LOAD))
for thickness, lives in zip(THICKNESS, study.life.values, strict=True):
    print(f"{thickness * 1e6:12.0f}" + "".join(f"{life / 1e3:13.2f}" for life in lives))
