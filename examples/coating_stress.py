"""Where does a hard coating under a sliding ball crack, and how strongly is it sheared off?

A hard coating on steel, thin and thick, under a ball at rest and under one whose friction draws
it along x: the largest tension in the coating, and the largest shear traction at the interface.
"""

import nacre

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
HARD = nacre.Elastic(young=600e9, poisson=0.2)

print("friction  coating/µm  tension/GPa  at x, y, z/µm         interface shear/MPa")
for friction in (0.0, 0.2):
    for thickness in (2e-6, 30e-6):
        body = nacre.HalfSpace(STEEL, layers=[nacre.Layer(HARD, thickness)])
        solution = nacre.solve(nacre.Sphere(5e-3), body, load=20.0)
        summary = solution.stress_summary(friction=friction)
        tension, place = summary.layers[0].tension
        at = ", ".join(f"{1e6 * along:.1f}" for along in place)
        shear, _ = summary.interfaces[0].shear
        print(
            f"{friction:8.1f}  {1e6 * thickness:10.0f}  {tension / 1e9:11.2f}  {at:20}"
            f"  {shear / 1e6:19.1f}"
        )
