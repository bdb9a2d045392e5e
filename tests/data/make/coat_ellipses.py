"""Largest stresses of coats below ellipses and rollers, by nacre on finer cells.

No other program has them: this generator alone imports nacre. Three grids of cells four to six
times smaller than those that nacre chooses, of other sizes and places, give three values. The
median is the reference, and its error the largest difference from it. Lines and balls, by programs
that share nothing with nacre, are in coat_shapes.py.
"""

import sys
import warnings

import numpy as np

import nacre
from common import main

NAME, SECONDS = "coat_ellipses.json", 900
SUBSTRATE = 210e9, 0.3
HALF_WIDTH, RADIUS = 1e-4, 10e-3  # of the narrow side, about
SEEDS, ELLIPSES, ROLLERS = (5, 6), 16, 4
GRIDS = [(384, 1.22, -1), (480, 1.26, 0), (576, 1.30, 1)]  # cells, size over contact, place
ALONG = 2  # times as many cells along a roller, and half as many across
NEEDED = 3e-3  # error of a reference, over the value or a fifth of the peak, above which it goes


def drawn_layers(random, count, total):
    """Draw layers of a total thickness, none thinner than a fifth of the others."""
    shares = random.uniform(0.2, 1, count)
    return [
        [
            float(f"{thickness:.4g}"),
            float(f"{SUBSTRATE[0] * np.exp(random.uniform(*np.log([0.3, 3]))):.4g}"),
            round(random.uniform(0.2, 0.35), 3),
        ]
        for thickness in total * shares / shares.sum()
    ]


def ellipses(random):
    """Draw contacts 1.2 to 5 times as long as wide; every fifth has two layers."""
    for k in range(ELLIPSES):
        ratio = np.exp(random.uniform(np.log(1.3), np.log(12)))
        long, size = float(f"{RADIUS * ratio:.4g}"), HALF_WIDTH * ratio**0.33
        modulus = SUBSTRATE[0] / (1 - SUBSTRATE[1] ** 2)
        load = float(f"{4 * modulus * size**3 / (3 * np.sqrt(RADIUS * long)):.4g}")
        total = HALF_WIDTH * np.exp(random.uniform(*np.log([0.005, 0.3])))
        layers = drawn_layers(random, 2 if k % 5 == 4 else 1, total)
        angle = [0, 90, round(float(random.uniform(10, 80)), 1)][int(random.integers(3))]
        shape = {"radius_x": RADIUS, "radius_y": long}
        slides = {"friction": float(random.choice([0, 0.1, 0.3])), "angle": angle}
        yield {"family": "ellipses", "shape": shape, "layers": layers, "load": load} | slides


def rollers(random):
    """Draw rollers with a flat length between two crowns, in contact on both."""
    for k in range(ROLLERS):
        total = HALF_WIDTH * np.exp(random.uniform(*np.log([0.01, 0.3])))
        crown = float(f"{random.uniform(0.1, 0.4):.3g}")
        shape = {"radius": RADIUS, "flat_length": 0.4e-3, "crown_radius": crown}
        layers = drawn_layers(random, 1, total)
        load = float(f"{random.uniform(120, 200):.3g}")
        slides = {"friction": [0, 0.1, 0.3, 0.3][k], "angle": [0, 90, 0, 35.0][k]}
        yield {"family": "rollers", "shape": shape, "layers": layers, "load": load} | slides


def solved(case, **how):
    """Solution of a contact and the largest stresses of its layers."""
    layers = [nacre.Layer(nacre.Elastic(young, nu), h) for h, young, nu in case["layers"]]
    body = nacre.HalfSpace(nacre.Elastic(*SUBSTRATE), layers)
    shape = (nacre.Paraboloid if "radius_x" in case["shape"] else nacre.Roller)(**case["shape"])
    solution = nacre.solve(shape, body, load=case["load"], threads=1, **how)
    angle, sliding = np.radians(case["angle"]), {}
    if case["friction"]:
        direction = float(np.cos(angle)), float(np.sin(angle))
        sliding = {"friction": case["friction"], "direction": direction}
    summary = solution.stress_summary(threads=1, **sliding)
    values = [
        {
            "tension": summary.layers[k].tension[0],
            "von_mises": summary.layers[k].von_mises[0],
            "interface_shear": summary.interfaces[k].shear[0],
        }
        for k in range(len(layers))
    ]
    return solution, values


def reference(case):
    """Fill in peak and half-widths of the contact, largest stresses, and their errors."""
    solution, _ = solved(case)
    case["p0"] = solution.peak_pressure
    sizes = [high - low for low, high in solution.contact_extent]
    case["half_widths"] = [size / 2 for size in sizes]
    found = []
    stretch = 1 if case["family"] == "ellipses" else ALONG
    for cells, factor, place in GRIDS:
        sides = [factor * size for size in sizes]
        shape = cells * stretch, cells // stretch
        center = 0.31 * place * sides[0] / shape[0], 0.27 * place * sides[1] / shape[1]
        found.append(solved(case, grid=nacre.Grid(shape, sides, center))[1])
    case["extremes"], case["errors"] = {}, {}
    for k in range(len(case["layers"])):
        values = {name: [each[k][name] for each in found] for name in found[0][k]}
        middle = {name: float(np.median(each)) for name, each in values.items()}
        errors = {n: float(max(abs(np.array(each) - middle[n]))) for n, each in values.items()}
        scales = {name: max(value, 0.2 * case["p0"]) for name, value in middle.items()}
        kept = {n: float(f"{v:.6g}") for n, v in middle.items() if errors[n] < NEEDED * scales[n]}
        case["extremes"][f"body {k}"] = kept
        case["errors"][f"body {k}"] = {name: float(f"{errors[name]:.2g}") for name in kept}


def fill(content):
    warnings.simplefilter("ignore", nacre.NacreWarning)
    content["cases"] = []
    for seed, draw in zip(SEEDS, (ellipses, rollers), strict=True):
        for case in draw(np.random.default_rng(seed)):
            reference(case)
            content["cases"].append({"id": len(content["cases"])} | case)


if __name__ == "__main__":
    main(sys.modules[__name__])
