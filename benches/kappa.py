"""Area of rough contacts at light loads, of bare and of coated bodies: ``make kappa``.

    kappa = A E* h' / (A0 p)

is the share of the area in contact, over the mean pressure p in units of contact modulus E* and rms
slope h'. Surfaces are self-affine, Hurst exponent 0.8, on 1024² points; their waves are from 16
points to a quarter of the period long. It writes docs/kappa.csv and docs/images/kappa.png.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np

import nacre
from nacre import rough

CELLS, SHORTEST, LONGEST, SLOPE = 1024, 16, 256, 0.01
PRESSURES = np.array([0.0045, 0.01, 0.02, 0.03, 0.048])
"""Mean pressures in units of E* h': shares of the area from 0.01 to 0.1."""
SEEDS = range(1, 21)
COATED_SEEDS = range(1, 6)
MODULI = (0.25, 4.0)
"""Young's moduli of layers, in those of the substrate."""
THICKNESSES = (4, 16, 64)
"""Thicknesses of layers, in points; the shortest wave has 16."""
DOCS = Path(__file__).parents[1] / "docs"


def body(young: float, thickness: float) -> nacre.HalfSpace:
    """Return a body of E* = 1 below a layer, or bare where the thickness is 0."""
    substrate = nacre.Elastic(1.0, 0.0)
    layers = [nacre.Layer(nacre.Elastic(young, 0.0), thickness)] if thickness else []
    return nacre.HalfSpace(substrate, layers)


def kappas(young: float, thickness: float, seeds: range) -> list[list[float]]:
    """Return kappa of each seed at each pressure, of counted cells and then corrected."""
    grid = nacre.Grid((CELLS, CELLS), (CELLS, CELLS), periodic=(True, True))
    contact = nacre.Contact(body(young, thickness), grid)
    found = []
    for seed in seeds:
        surface = rough.random_surface(
            grid.shape,
            grid.size,
            hurst=0.8,
            rms_slope=SLOPE,
            shortest=SHORTEST,
            longest=LONGEST,
            rng=seed,
        )
        last, row = None, []
        for pressure in PRESSURES:
            last = contact.solve(surface, load=pressure * SLOPE * CELLS**2, initial=last)
            row += [last.contact_area, rough.corrected_area(last)]
        found.append([area / CELLS**2 / PRESSURES[k // 2] for k, area in enumerate(row)])
        print(f"young {young}, thickness {thickness}, seed {seed}: {found[-1][1::2]}", flush=True)
    return found


def main() -> None:
    """Solve, write, draw."""
    cases = [(1.0, 0, SEEDS)]
    cases += [(young, thick, COATED_SEEDS) for young in MODULI for thick in THICKNESSES]
    rows: list[dict[str, Any]] = []
    for young, thickness, seeds in cases:
        values = np.array(kappas(young, float(thickness), seeds)).reshape(len(seeds), -1, 2)
        for k, pressure in enumerate(PRESSURES):
            counted, corrected = values[:, k, 0], values[:, k, 1]
            rows.append(
                {
                    "young": young,
                    "thickness": thickness,
                    "seeds": len(seeds),
                    "pressure": pressure,
                    "share": (corrected * pressure).mean(),
                    "kappa_counted": counted.mean(),
                    "kappa": corrected.mean(),
                    "standard_error": corrected.std(ddof=1) / np.sqrt(len(seeds)),
                }
            )
    with (DOCS / "kappa.csv").open("w", newline="", encoding="utf-8") as opened:
        writer = csv.DictWriter(opened, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({k: f"{v:.5g}" for k, v in row.items()} for row in rows)
    draw(rows, DOCS / "images" / "kappa.png")


def draw(rows: list[dict[str, Any]], file: Path) -> None:
    """Draw kappa over the share of the area."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.5, 4), layout="constrained")
    for young, thickness in dict.fromkeys((row["young"], row["thickness"]) for row in rows):
        these = [r for r in rows if (r["young"], r["thickness"]) == (young, thickness)]
        label = f"E1/E2 = {young:g}, h = {thickness / SHORTEST:g} λ" if thickness else "bare"
        marker = "o" if not thickness else "s" if young > 1 else "^"
        axes.errorbar(
            [100 * r["share"] for r in these],
            [r["kappa"] for r in these],
            [r["standard_error"] for r in these],
            marker=marker,
            label=label,
            lw=1.2 if thickness else 2.0,
            ms=4,
        )
    axes.axhspan(2.0, 2.3, color="0.9", zorder=0)
    axes.set(xlabel="area in contact [%]", ylabel="κ = A E* h' / (A₀ p), E* of the substrate")
    axes.set_yscale("log")
    axes.set_yticks([0.5, 1, 2, 4, 8], ["0.5", "1", "2", "4", "8"])
    axes.minorticks_off()
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    figure.savefig(file, dpi=150)


if __name__ == "__main__":
    main()
