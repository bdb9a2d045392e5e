"""Coverage of the intervals of `nacre.indent.fit` on noisy curves: docs/indent_coverage.csv.

The scenarios are the identifiable ones of tests/data/inverse.json: five coated bodies, their
curves without noise, and the size of the noise. Each curve gets fresh noise, and is fitted as a
user would: from a poor start, with unknown noise. Per free parameter: the share of the 95 %
intervals by profile likelihood that hold the true value, and of the linear ones; per scenario: the
share of curves with a parameter that is said not to be identifiable, which is false. The widest
interval at which a parameter counts as known was chosen with the noise of numbers below 2000, so
that the figures are of the next ones.

    .venv/bin/python benches/indent_coverage.py --curves 2000
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import multiprocessing
import os
import re
import sys
import warnings
from collections import Counter
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
IDENTIFIABLE = (11, 12, 14, 15, 17)
"""Seeds of the scenarios that are identifiable."""
PATHS = {
    "lnE1": "body.layers[0].material.young",
    "lnE2": "body.substrate.young",
    "lnh": "body.layers[0].thickness",
}
START = {"lnE1": 1.4, "lnE2": 0.8, "lnh": 1.2}
"""Start over truth of each parameter."""
BLOCK = 20
"""Curves of one task."""


def scenarios() -> dict[int, dict[str, Any]]:
    """Return the scenarios by seed."""
    data = json.loads((ROOT / "tests/data/inverse.json").read_text(encoding="utf-8"))
    return {case["seed"]: case for case in data["curves"] if case["seed"] in IDENTIFIABLE}


def block(task: tuple[int, int, int]) -> tuple[int, Counter[str]]:
    """Return seed and counts of a block of curves."""
    import numpy as np

    import nacre
    from nacre.indent.fit import fit

    seed, first, count = task
    case = scenarios()[seed]
    true = case["true"]
    keys = {"lnE1": "E1", "lnE2": "E2", "lnh": "h"}
    start = {
        name: true[key] * (START[name] if name in case["free"] else 1.0)
        for name, key in keys.items()
    }
    layer = nacre.Layer(nacre.Elastic(start["lnE1"], true["nu1"]), start["lnh"])
    body = nacre.HalfSpace(nacre.Elastic(start["lnE2"], true["nu2"]), layers=[layer])
    tip = nacre.indent.Tip.paraboloid(true["R"])
    depth, clean = np.array(case["depth"]), np.array(case["load_noise_free"])
    counts: Counter[str] = Counter()
    for number in range(first, first + count):
        noise = np.random.default_rng([seed, number]).standard_normal(depth.size)
        force = clean * np.exp(case["sigma"] * noise)
        free = [PATHS[name] for name in case["free"]]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", nacre.NacreWarning)
            found = fit((depth, force), body, tip, free)
        counts["curves"] += 1
        counts[f"reason noise {found.noise}"] += 1
        counts["reason of all: a warning"] += bool(found.warnings)
        counts["alarms"] += not found.is_identifiable
        counts["evaluations"] += found.evaluations
        quantile = float(stdtrit(found.dof))
        for name in case["free"]:
            value = true[keys[name]]
            low, high = found.intervals[PATHS[name]]
            counts[name] += low <= value <= high
            estimate = found.estimates[PATHS[name]]
            spread = found.standard_errors[PATHS[name]] / estimate
            counts[f"{name} linear"] += abs(math.log(value / estimate)) <= quantile * spread
        for reason in found.reasons.values():
            kind = re.sub(r"-?\d[\d.e+-]*", "…", reason.partition(";")[0])
            counts[f"reason {kind}"] += 1
    return seed, counts


def stdtrit(dof: int) -> float:
    """Return the 97.5 % quantile of Student's distribution."""
    from scipy import special

    return float(special.stdtrit(dof, 0.975))


def main() -> int:
    """Run the study; return 1 if a figure is out of its range."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--curves", type=int, default=2000, help="curves of each scenario")
    parser.add_argument(
        "--first",
        type=int,
        default=2000,
        help="number of the first curve; numbers choose the noise",
    )
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--output", type=Path, default=ROOT / "docs/indent_coverage.csv")
    options = parser.parse_args()
    os.environ["RAYON_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    from rich.console import Console
    from rich.progress import track

    cases = scenarios()
    last = options.first + options.curves
    tasks = [
        (seed, first, min(BLOCK, last - first))
        for first in range(options.first, last, BLOCK)
        for seed in cases
    ]
    totals: dict[int, Counter[str]] = {seed: Counter() for seed in cases}
    # A forked process could inherit threads that are at work.
    with multiprocessing.get_context("spawn").Pool(options.processes) as pool:
        results = pool.imap_unordered(block, tasks)
        bar = track(results, "fitting", total=len(tasks), console=Console(stderr=True))
        for seed, counts in bar:
            totals[seed] += counts
    is_good = True
    rows = []
    for seed, counts in totals.items():
        curves = counts["curves"]
        alarms = counts["alarms"] / curves
        is_good &= alarms < 0.02
        for name in cases[seed]["free"]:
            covered = counts[name] / curves
            is_good &= 0.935 <= covered <= 0.965
            linear = counts[f"{name} linear"] / curves
            row = [cases[seed]["name"], name.removeprefix("ln"), curves, covered, linear, alarms]
            rows.append(row)
            print(f"{row[0]:28} {row[1]:3} {covered:.4f} linear {linear:.4f} alarms {alarms:.4f}")
        for name, count in counts.items():
            if name.startswith("reason "):
                print(f"    {count} × {name}")
        print(f"    {counts['evaluations'] / curves:.1f} curves computed for each fit")
    with options.output.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(
            ["scenario", "parameter", "curves", "coverage", "linear coverage", "false alarms"]
        )
        writer.writerows([*row[:3], *(f"{value:.4f}" for value in row[3:])] for row in rows)
    return 0 if is_good else 1


if __name__ == "__main__":
    sys.exit(main())
