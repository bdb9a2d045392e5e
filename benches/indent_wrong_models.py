"""What fits say of models that are wrong: docs/indent_wrong_models.csv.

Curves are made with one set of numbers and fitted with another, by the free modulus of a film, or
of a bare body: 60 points from 10 to 200 nm, a load that grows at a constant rate for 30 s, a tip of
5 µm, 3 GPa on 70 GPa. Per scenario: the share of curves whose true modulus lies outside of the 95 %
interval, with and without a warning; the share that is warned of, and how often the warning names
what is wrong. Without structure in the residuals no test can warn: under noise of 1 % of the
largest force at each point a wrong radius looks like another modulus, on a bare body always.

    .venv/bin/python benches/indent_wrong_models.py --curves 300
"""

from __future__ import annotations

import argparse
import csv
import math
import multiprocessing
import os
import sys
import warnings
from collections import Counter
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
POINTS = 60
YOUNG = 3e9
FILM = {"thickness": 1e-6, "poisson": 0.4, "radius": 5e-6}
"""Numbers of the curves."""
WRONG: dict[str, dict[str, Any]] = {
    "right model": {},
    "contact point 2 nm": {"zero": 2e-9},
    "contact point 5 nm": {"zero": 5e-9},
    "drift 0.2 nm/s": {"drift": 0.2e-9},
    "compliance 1 nm/mN": {"compliance": 1e-6},
    "thickness + 30 %": {"thickness": 1.3e-6},
    "radius + 20 %": {"radius": 6e-6},
    "Poisson's ratio - 0.1": {"poisson": 0.3},
    "correlated noise, 0.9": {"correlation": 0.9},
}
"""What differs: errors of the measured depth and noise, or numbers that the fit is given."""
CAUSES = {
    "zero": "contact_point",
    "drift": "drift",
    "compliance": "compliance",
    "thickness": "body.layers[0].thickness",
    "radius": "tip.radius",
    "poisson": "body.layers[0].material.poisson",
    "correlation": "noise is correlated",
}
"""Words by which a warning names what is wrong."""
NOISES = {
    "1 % of the force": (0.01, 0.0),
    "0.2 % of the largest force": (0.0, 0.002),
    "1 % of the force and 0.3 % of the largest": (0.01, 0.003),
    "1 % of the largest force": (0.0, 0.01),
}
"""Standard deviations over the force, and over the largest force."""
FIRST = next(iter(NOISES))
"""Noise with which the residuals show each wrong number of a film: there are ten times as many
curves of it."""
BARE = ("right model", "contact point 2 nm", "radius + 20 %", "Poisson's ratio - 0.1")
"""Scenarios without a film."""
BLOCK = 20
"""Curves of one task."""
Task = tuple[str, str, str, int, int]


def block(task: Task) -> tuple[tuple[str, str, str], Counter[str]]:
    """Return the scenario of a block of curves, and counts."""
    import numpy as np

    import nacre
    from nacre.indent import Curve, Indentation, Tip
    from nacre.indent.fit import fit

    on, name, noise, first, count = task
    wrong = WRONG[name]
    path = "body.layers[0].material.young" if on == "film" else "body.substrate.young"

    def body(young: float, numbers: dict[str, float]) -> nacre.HalfSpace:
        material = nacre.Elastic(young, numbers["poisson"])
        if on == "bare":
            return nacre.HalfSpace(material)
        layer = nacre.Layer(material, numbers["thickness"])
        return nacre.HalfSpace(nacre.Elastic(70e9, 0.22), [layer])

    depth = np.linspace(10e-9, 200e-9, POINTS)
    load = Indentation(body(YOUNG, FILM), Tip.paraboloid(FILM["radius"])).curve(approach=depth).load
    time = 30 * load / load[-1]
    measured = depth + wrong.get("zero", 0.0)
    measured = measured + wrong.get("drift", 0.0) * time + wrong.get("compliance", 0.0) * load
    given = FILM | {key: value for key, value in wrong.items() if key in FILM}
    guess, tip = body(0.7 * YOUNG, given), Tip.paraboloid(given["radius"])
    relative, absolute = NOISES[noise]
    counts: Counter[str] = Counter()
    for number in range(first, first + count):
        rng = np.random.default_rng([number, list(WRONG).index(name), list(NOISES).index(noise)])
        share, same = rng.standard_normal((2, POINTS))
        if rho := wrong.get("correlation"):
            for k in range(1, POINTS):
                for values in (share, same):
                    values[k] = rho * values[k - 1] + math.sqrt(1 - rho**2) * values[k]
        force = load * np.exp(relative * share) + load[-1] * absolute * same
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", nacre.NacreWarning)
            found = fit(Curve(measured, force, time=time), guess, tip, [path], profile=False)
        low, high = found.intervals[path]
        is_outside = not low <= YOUNG <= high
        counts["curves"] += 1
        counts["warned"] += bool(found.warnings)
        counts["outside"] += is_outside
        counts["outside, not warned"] += is_outside and not found.warnings
        counts["named"] += any(CAUSES[key] in text for text in found.warnings for key in wrong)
        counts[f"noise {found.noise}"] += 1
    return (on, name, noise), counts


def main() -> int:
    """Run the study; return 1 if a scenario that residuals show is out of its range."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--curves",
        type=int,
        default=300,
        help="curves of a scenario, a tenth of them with other noise or without a film",
    )
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--output", type=Path, default=ROOT / "docs/indent_wrong_models.csv")
    options = parser.parse_args()
    for name in ("RAYON_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ[name] = "1"
    from rich.console import Console
    from rich.progress import track

    cases = [("film", name, noise) for noise in NOISES for name in WRONG]
    cases += [("bare", name, FIRST) for name in BARE]
    tasks = [
        (*case, first, min(BLOCK, count - first))
        for case in cases
        for count in [options.curves if case[::2] == ("film", FIRST) else options.curves // 10]
        for first in range(0, count, BLOCK)
    ]
    totals: dict[tuple[str, str, str], Counter[str]] = {case: Counter() for case in cases}
    with multiprocessing.get_context("spawn").Pool(options.processes) as pool:
        results = pool.imap_unordered(block, tasks)
        bar = track(results, "fitting", total=len(tasks), console=Console(stderr=True))
        for case, counts in bar:
            totals[case] += counts
    columns = ("warned", "named", "outside", "outside, not warned")
    with options.output.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["body", "scenario", "noise", "curves", *columns])
        for case, counts in totals.items():
            shares = [counts[name] / counts["curves"] for name in columns]
            writer.writerow([*case, counts["curves"], *(f"{share:.4f}" for share in shares)])
            kinds = {name: count for name, count in counts.items() if name.startswith("noise ")}
            print(*case, *(f"{n} {s:.3f}" for n, s in zip(columns, shares, strict=True)), kinds)
    visible = [totals["film", name, FIRST] for name in WRONG if WRONG[name]]
    is_good = all(counts["outside, not warned"] < 0.05 * counts["curves"] for counts in visible)
    return 0 if is_good else 1


if __name__ == "__main__":
    sys.exit(main())
