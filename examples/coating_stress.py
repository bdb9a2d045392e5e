"""Where does a hard coating crack, and its substrate yield, when a ball slides on it?

A steel ball slides on steel with a coating of twice its modulus, for three thicknesses and a
coefficient of friction of 0.15. Tension in the coating can open cracks behind the ball and above
the interface, shear at the interface can detach the coating, and the von Mises stress can make the
substrate yield.
"""

import nacre

LOAD = 20.0
STRENGTH, YIELD = 3e9, 2e9

steel, coating = nacre.Elastic(210e9, 0.3), nacre.Elastic(420e9, 0.25)
grid = nacre.Grid(shape=(128, 128), size=(0.3e-3, 0.3e-3))

print("                                                 coating   interface   substrate")
print("h/µm   peak/GPa   tension/GPa   at x/µm    z/µm   safety   shear/GPa      safety")
for thickness in (2e-6, 10e-6, 40e-6):
    body = nacre.HalfSpace(steel, layers=[nacre.Layer(coating, thickness)])
    solution = nacre.solve(nacre.Sphere(5e-3), body, steel, grid=grid, load=LOAD)
    summary = solution.stress_summary(
        friction=0.15,
        direction=(1, 0),
        strength={0: STRENGTH},
        yield_stress={"substrate": YIELD},
        refine=0.1,  # where the cells of the grid leave more than 10 % uncertain
    )
    layer, substrate = summary.layers
    tension, (x, _, z) = layer.tension
    shear = summary.interfaces[0].shear[0]
    print(
        f"{thickness * 1e6:4.0f}   {solution.peak_pressure / 1e9:8.3f}   {tension / 1e9:11.3f}"
        f"   {x * 1e6:7.1f}   {z * 1e6:5.1f}"
        f"   {layer.strength_safety_factor:6.2f}   {shear / 1e9:9.3f}"
        f"   {substrate.yield_safety_factor:9.2f}"
    )
