"""
Cattaneo and Mindlin on coated bodies
=====================================

A ball of 5 mm radius is pressed by 20 N on a plate, both of steel, and pulled along it by half of
the force at which it would slide. Cattaneo and Mindlin give the shift and the radius of the stick
zone for bare bodies. The pictures show how far they are off with a coating, even when they are
given the contact radius and the approach of the coated bodies.
"""

import matplotlib.pyplot as plt
import numpy as np

import nacre

steel = nacre.Elastic(young=210e9, poisson=0.3)
ball = nacre.Sphere(5e-3)
load, friction, pull = 20.0, 0.3, 0.5  # pull: force over friction times load
modulus = nacre.hertz.contact_modulus(steel, steel)
radius = nacre.hertz.Point(5e-3, modulus, load=load).contact_radius
shares = np.geomspace(0.02, 10.0, 14)  # thickness over the radius on bare steel


def ratios(
    body: nacre.HalfSpace, counterbody: nacre.HalfSpace
) -> tuple[float, float]:
    """Return shift and stick radius over those of Cattaneo and Mindlin."""
    pressed = nacre.solve(ball, body, counterbody, load=load)
    force = pull * friction * load
    pulled = nacre.slide(
        *(ball, body, counterbody),
        load=load,
        friction=friction,
        force=(force, None),
        tolerance=1e-6,
    )
    assert pulled.shift
    compliance = (2 - steel.poisson) / (
        2 - 2 * steel.poisson
    )  # along over normal
    shift = (
        compliance * friction * pressed.approach * (1 - (1 - pull) ** (2 / 3))
    )
    stick = np.sqrt(pulled.stick.sum() / np.count_nonzero(pulled.pressure))
    return pulled.shift[0] / shift, stick / (1 - pull) ** (1 / 3)


# %%
# # Solid lines: a coated plate and a bare ball. Dashed lines: both bodies have the coating. Judged
# by its approach, a soft coating deforms more along the surface than Cattaneo and Mindlin predict,
# and a hard one less, most of all where it is a third of the contact radius thick. Bodies with the
# same coating have the predicted stick radius to some per cent, and return to Cattaneo and Mindlin
# for thick coatings. A thick coating on one body makes the bodies dissimilar: pressure alone then
# makes the edge of the contact slip, and less of it sticks.
figure, (upper, lower) = plt.subplots(
    2, 1, figsize=(6.2, 6.6), sharex=True, layout="constrained"
)
colours = {0.1: "#D55E00", 0.25: "#E69F00", 2.0: "#56B4E9", 4.0: "#0072B2"}
for stiffness, colour in colours.items():
    coating = nacre.Elastic(young=stiffness * 210e9, poisson=0.3)
    bodies = [
        nacre.HalfSpace(steel, [nacre.Layer(coating, share * radius)])
        for share in shares
    ]
    for both, style in ((False, "-"), (True, "--")):
        pairs = [
            (body, body if both else nacre.HalfSpace(steel)) for body in bodies
        ]
        values = np.array([ratios(*pair) for pair in pairs])
        label = None if both else f"E₁/E₂ = {stiffness:g}"
        for axes, column in zip((upper, lower), values.T, strict=True):
            axes.semilogx(
                shares, column, style, color=colour, linewidth=1.4, label=label
            )
        if not both:
            low, high = values[:, 0].min(), values[:, 0].max()
            print(
                f"E₁/E₂ = {stiffness:4}: "
                f"shift {low:.2f} to {high:.2f} of Cattaneo-Mindlin"
            )
for axes, name in ((upper, "shift"), (lower, "stick radius")):
    axes.axhline(1.0, color="0.5", linewidth=0.8)
    axes.set(ylabel=f"{name} over Cattaneo–Mindlin", xlim=shares[[0, -1]])
    axes.grid(alpha=0.3)
upper.legend(frameon=False, loc="upper right")
upper.set_title(
    "solid: coated plate; dashed: both bodies coated",
    fontsize="medium",
    loc="left",
)
lower.set_xlabel("thickness over contact radius on bare steel")
lower.set_xticks([0.02, 0.1, 1, 10], labels=["0.02", "0.1", "1", "10"])
print(f"bare steel: shift {ratios(*[nacre.HalfSpace(steel)] * 2)[0]:.4f}")
