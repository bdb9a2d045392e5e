"""
Stresses below a coated sphere
==============================

A ball is pressed on a coating twice as stiff as the steel below it. Stresses are higher in the
stiff coating: the von Mises stress jumps at the interface and is largest just above it, where the
coating bends. The cross marks the largest value.
"""

import nacre
from nacre import plot

steel = nacre.Elastic(young=210e9, poisson=0.3)
hard = nacre.Elastic(young=420e9, poisson=0.3)
body = nacre.HalfSpace(steel, layers=[nacre.Layer(hard, thickness=40e-6)])
solution = nacre.solve(nacre.Sphere(5e-3), body, load=100.0)
axes = plot.stress_section(solution)

# %%
# # In-plane stresses jump at the interface; tractions are continuous across it. Below the middle of
# the contact:
axes = plot.stress_depth(solution, ("xx", "zz", "von_mises"))

# %%
# The shear stress at the interface is largest in a ring below the edge of the contact. Arrows show
# the traction of the steel on the coating, which points inwards.
axes = plot.interface_map(solution)

# %%
# # A ball that slides with μ = 0.25 causes tension at the surface behind it. The picture shows the
# largest principal stress in the same section, with tension in red.
axes = plot.stress_section(solution, "tension", friction=0.25, direction=(1, 0))

# %%
# # The summary has the peaks, and safety factors against given limits; ``print(summary)`` prints
# the whole table, with the location of each peak.
summary = solution.stress_summary(
    friction=0.25, direction=(1, 0), yield_stress={0: 8e9, "substrate": 2.2e9}
)
for layer in summary.layers:
    mises, tension = layer.von_mises[0] / 1e9, layer.tension[0] / 1e9
    print(
        f"layers[{layer.layer}]: von Mises {mises:.2f} GPa, "
        f"tension {tension:.2f} GPa",
        end=", ",
    )
    print(f"safety factor {layer.yield_safety_factor:.2f}")
print(f"interface: shear {summary.interfaces[0].shear[0] / 1e9:.2f} GPa")
