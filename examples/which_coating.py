"""Which coating reduces the pressure most, and how thick must it be?

A study varies the thickness and Young's modulus of a coating on steel under a ball. With
``store="study.nc"``, a study that was interrupted would continue.
"""

import nacre

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
BALL = nacre.Sphere(5e-3)
THICKNESS = [2e-6, 10e-6, 50e-6]
YOUNG = [50e9, 100e9, 400e9]


def coated(thickness: float, young: float) -> dict[str, object]:
    """Return the arguments of `nacre.solve` for one case."""
    coating = nacre.Layer(nacre.Elastic(young, poisson=0.3), thickness)
    return {"shape": BALL, "body": nacre.HalfSpace(STEEL, layers=[coating]), "load": 20.0}


bare = nacre.solve(BALL, STEEL, load=20.0).peak_pressure
study = nacre.sweep(coated, {"thickness": THICKNESS, "young": YOUNG})
change = 100 * (study.peak_pressure / bare - 1)

print(f"bare steel {bare / 1e9:.2f} GPa; change of the peak pressure with")
print("thickness/µm" + "".join(f"{young / 1e9:8.0f} GPa" for young in YOUNG))
for thickness in THICKNESS:
    row = (f"{value:+10.1f} %" for value in change.sel(thickness=thickness).values)
    print(f"{thickness * 1e6:12.0f}" + "".join(row))
