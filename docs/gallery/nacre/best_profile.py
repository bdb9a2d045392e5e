"""
The best profile of a coated roller
===================================

A straight roller has pressure peaks at its ends. Which profile keeps the pressure lowest? Here the
profile is free: the drop rises from each column of cells to the next by a parameter of its own, and
`nacre.design.optimise` minimises a norm that comes close to the largest pressure.
"""

import warnings

import matplotlib.pyplot as plt
import numpy as np

import nacre
from nacre import design

steel = nacre.Elastic(young=210e9, poisson=0.3)
modulus = steel.plane_strain_modulus / 2  # of two bodies of steel
length = 12e-3
warnings.filterwarnings(
    "ignore", "the contact reaches the end", nacre.NacreWarning
)  # as it should


def shape(x: np.ndarray, drop: np.ndarray) -> nacre.Roller:
    """Return the roller with these drops at places on both sides."""
    place = np.array([0.0, *x, length / 2])
    drop = np.array(
        [0.0, *drop, 1.5 * drop[-1] - 0.5 * drop[-2]]
    )  # goes on to the end
    profile = np.r_[-place[:0:-1], place], np.r_[drop[:0:-1], drop]
    return nacre.Roller(
        radius=5e-3, length=length, profile=profile, counter_radius=25e-3
    )


def best_drop(
    grid: nacre.Grid,
    load: float,
    body: nacre.HalfSpace | nacre.Elastic,
    tilts: list[float],
    exponents: list[float],
) -> tuple[np.ndarray, np.ndarray, list[nacre.Solution]]:
    """Return places, their best drops, and the solutions with them."""
    x = grid.x[grid.x > 0]
    rises = {f"rise{k}": 0.0 for k in range(len(x))}
    largest = 4 * load / (np.pi * length * modulus)

    def build(**rises: float) -> dict[str, object]:
        made = shape(x, np.cumsum(list(rises.values())))
        return dict(shape=made, body=body, counterbody=steel)

    for exponent in exponents:  # each goes on where the one before ended
        best = design.optimise(
            build,
            rises,
            objective=("pressure_norm", exponent),
            across=exponent,
            cases=[dict(load=load, tilt=(tilt, None)) for tilt in tilts],
            bounds={name: (0.0, largest) for name in rises},
            grid=grid,
        )
        rises = best.values
    return x, np.cumsum(list(rises.values())), best.solutions


# %%
# # Without tilt, the best profile is close to Lundberg's at the same load, and the pressure is
# uniform along the roller. The two differ near the ends, where Lundberg's drop has no limit.
load = 1e3
grid = nacre.Grid((64, 25), (length, 2e-4))
x, drop, (solution,) = best_drop(grid, load, steel, [0.0], [16.0, 64.0, 256.0])
lundberg = nacre.LogarithmicProfile.lundberg(length, load, modulus)
straight = nacre.solve(
    shape(x, 0 * x), steel, counterbody=steel, load=load, grid=grid
)

figure, (left, right) = plt.subplots(
    1, 2, figsize=(7.2, 3.4), layout="constrained"
)
fine = np.linspace(0.0, 0.499 * length, 300)
left.plot(1e3 * fine, 1e6 * lundberg.drop_at(fine), label="Lundberg")
left.plot(1e3 * x, 1e6 * drop, "o", ms=3, label="optimum")
left.set(xlabel="x [mm]", ylabel="drop [µm]")
left.legend()
for name, solved in {"straight": straight, "optimum": solution}.items():
    right.plot(1e3 * grid.x, solved.pressure.max(axis=1) / 1e9, label=name)
right.set(
    xlabel="x [mm]", ylabel="largest pressure across [GPa]", ylim=(0, None)
)
right.legend()

# %%
# # Now the roller tilts by up to 1 mrad and carries 100 µm of a polymer. The polymer is compliant,
# so the middle need not be as straight as that of a bare roller. More crown lowers the pressure at
# the largest tilt, and raises it without tilt.
load, tilts = 500.0, [0.0, 0.5e-3, 1e-3]
layer = nacre.Layer(nacre.Elastic(young=3.5e9, poisson=0.4), thickness=100e-6)
coated = nacre.HalfSpace(steel, layers=[layer])
grid = nacre.Grid((64, 25), (length, 7e-4))
drops = {}
bodies: dict[str, nacre.HalfSpace | nacre.Elastic] = {
    "bare": steel,
    "coated": coated,
}
for name, body in bodies.items():
    x, drops[name], _ = best_drop(grid, load, body, tilts, [16.0, 64.0])

figure, (left, right) = plt.subplots(
    1, 2, figsize=(7.2, 3.4), layout="constrained"
)
for name, drop in drops.items():
    left.plot(1e3 * x, 1e6 * drop, label=f"best for the {name} roller")
    tilted = nacre.solve(
        shape(x, drop),
        coated,
        counterbody=steel,
        load=load,
        tilt=(1e-3, None),
        grid=grid,
    )
    peaks = tilted.pressure.max(axis=1) / 1e6
    right.plot(1e3 * grid.x, peaks)
    print(
        f"best for the {name} roller: "
        f"{peaks[grid.x < 0.485 * length].max():.0f} MPa at 1 mrad"
    )
left.set(xlabel="x [mm]", ylabel="drop [µm]")
left.legend()
right.set(
    xlabel="x [mm]", ylabel="pressure at 1 mrad, coated [MPa]", ylim=(0, None)
)
