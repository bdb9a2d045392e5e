"""Pressures of other programs on periodic rough surfaces: writes periodic_peers.json.

Needs ContactMechanics 1.8.3 and Tamaas 2.9.0, which tests do not: they read the numbers alone.
"""

import json
from pathlib import Path

import ContactMechanics
import numpy as np
import tamaas
from SurfaceTopography import Topography

CELLS, SIDE, PRESSURE, POISSON, THICKNESS = 32, 2.0, 0.02, 0.3, 0.2
WAVES = [(1, 0, 0.010, 0.3), (0, 1, 0.008, 1.1), (2, 1, 0.006, 2.2), (3, -2, 0.004, 0.7), (1, 4, 0.003, 5.0)]


def heights():
    """Sum of a cos(2π (k x + l y)/SIDE + φ) at the centres of the cells, the highest point at 0."""
    x = (np.arange(CELLS) + 0.5) / CELLS
    found = sum(
        a * np.cos(2 * np.pi * (k * x[:, None] + l * x[None, :]) + phase) for k, l, a, phase in WAVES
    )
    return found - found.max()


def contact_mechanics(h, **substrate):
    half_space = ContactMechanics.PeriodicFFTElasticHalfSpace((CELLS, CELLS), 1.0, (SIDE, SIDE), **substrate)
    surface = Topography(h, physical_sizes=(SIDE, SIDE), periodic=True)
    system = ContactMechanics.make_system(substrate=half_space, surface=surface)
    load = PRESSURE * SIDE**2
    found = system.minimize_proxy(
        external_force=load, pentol=1e-16, forcetol=1e-16, thermotol=1e-13, maxiter=5000
    )
    assert found.success, found.message
    return np.asarray(found.jac) / (SIDE / CELLS) ** 2


def with_tamaas(h):
    model = tamaas.Model(tamaas.model_type.basic_2d, [SIDE, SIDE], [CELLS, CELLS])
    model.E, model.nu = 1.0, 0.0
    solver = tamaas.PolonskyKeerRey(model, h, 1e-13)
    solver.max_iter = 20000
    solver.solve(PRESSURE)
    return np.array(model.traction)


if __name__ == "__main__":
    h = heights()
    content = {
        "about": "pressures [E*] under a mean pressure; rows along x. Versions: ContactMechanics 1.8.3, Tamaas 2.9.0",
        "cells": CELLS,
        "side": SIDE,
        "mean_pressure": PRESSURE,
        "waves": WAVES,
        "layer": {"young": 1.0, "poisson": POISSON, "thickness": THICKNESS},
        "contact_mechanics": contact_mechanics(h).tolist(),
        "contact_mechanics_layer": contact_mechanics(h, thickness=THICKNESS, poisson=POISSON).tolist(),
        "tamaas": with_tamaas(h).tolist(),
    }
    Path(__file__).with_name("periodic_peers.json").write_text(json.dumps(content) + "\n")
