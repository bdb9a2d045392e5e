"""How far do conversions by inverse FFT err in pressure and approach, and does refinement help?

The methods `plain`, `difference` and `image` are compared with the exact coefficients, for several
refinements χ of the spectral mesh: under a coated sphere on a square domain, and under a coated
roller on a domain forty times as long as wide. The program prints the errors and draws them, in a
PNG in the folder `--out`.
"""

import argparse
import itertools
from pathlib import Path
from typing import Final, Literal, TypeAlias

import matplotlib
import matplotlib.pyplot as plt

import nacre

matplotlib.use("Agg")

Conversion: TypeAlias = Literal["plain", "difference", "image"]
Errors: TypeAlias = list[tuple[float, float]]

CONVERSIONS: Final[tuple[Conversion, ...]] = ("plain", "difference", "image")
REFINEMENTS: Final = (1, 2, 4, 8)
TOLERANCE: Final = 1e-10  # far below the errors of any conversion
MARKERS: Final = dict(zip(CONVERSIONS, "os^", strict=True))

STEEL: Final = nacre.Elastic(young=210e9, poisson=0.3)
COATING: Final = nacre.Layer(nacre.Elastic(young=840e9, poisson=0.3), thickness=40e-6)
BODY: Final = nacre.HalfSpace(STEEL, layers=[COATING])


class Case:
    """A shape pressed into the coated body on a grid."""

    def __init__(self, name: str, shape: nacre.types.Shape, grid: nacre.Grid, load: float) -> None:
        self.name = name
        self.shape = shape
        self.grid = grid
        self.load = load
        self.exact = nacre.Contact(BODY, grid).solve(shape, load=load, tolerance=TOLERANCE)

    def errors(self, conversion: Conversion, refinement: int) -> tuple[float, float]:
        """Return the relative errors of peak pressure and approach."""
        converted = nacre.influence_coefficients(BODY, self.grid, conversion, refinement)
        contact = nacre.Contact(BODY, self.grid, coefficients=converted)
        solution = contact.solve(self.shape, load=self.load, tolerance=TOLERANCE)
        return (
            abs(solution.peak_pressure / self.exact.peak_pressure - 1),
            abs(solution.approach / self.exact.approach - 1),
        )


def draw(cases: dict[str, dict[Conversion, Errors]], file: Path) -> None:
    """Draw errors as a function of χ: a row for each quantity, a column for each case."""
    with plt.rc_context({"font.size": 8, "axes.titlesize": 8, "lines.markersize": 4}):
        figure, axes = plt.subplots(
            2, 2, figsize=(5.5, 4.2), sharex=True, sharey="row", layout="constrained"
        )
        for column, (name, errors) in enumerate(cases.items()):
            axes[0, column].set_title(name)
            axes[1, column].set_xlabel("refinement χ of the spectral mesh")
            for (conversion, pairs), row in itertools.product(errors.items(), (0, 1)):
                values = [pair[row] for pair in pairs]
                axis = axes[row, column]
                axis.loglog(REFINEMENTS, values, marker=MARKERS[conversion], label=conversion)
        for axis in axes.flat:
            axis.set_xticks(REFINEMENTS, [str(chi) for chi in REFINEMENTS])
            axis.minorticks_off()
            axis.grid(visible=True, linewidth=0.3)
        axes[0, 0].set_ylabel("error of the peak pressure")
        axes[1, 0].set_ylabel("error of the approach")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False)
        figure.savefig(file, dpi=200)
        plt.close(figure)


def main() -> None:
    """Solve, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder of the figure")
    out: Path = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)

    # Both contacts are about 0.2 mm wide.
    sphere = nacre.Sphere(5e-3)
    roller = nacre.Roller(radius=5e-3, flat_length=6e-3, crown_radius=1.0)
    cases = [
        Case("sphere, square domain", sphere, nacre.Grid((128, 128), (0.4e-3, 0.4e-3)), 60.0),
        Case("roller, domain 40 : 1", roller, nacre.Grid((512, 64), (16e-3, 0.4e-3)), 3000.0),
    ]
    found: dict[str, dict[Conversion, Errors]] = {}
    print("case                    conversion   χ   peak pressure   approach")
    for case in cases:
        found[case.name] = {}
        for conversion in CONVERSIONS:
            errors = [case.errors(conversion, chi) for chi in REFINEMENTS]
            found[case.name][conversion] = errors
            for chi, (peak, approach) in zip(REFINEMENTS, errors, strict=True):
                print(f"{case.name:22}  {conversion:10} {chi:3}   {peak:13.1e}   {approach:8.1e}")
    file = out / "conversion_error.png"
    draw(found, file)
    print(f"drawn in {file}")


if __name__ == "__main__":
    main()
