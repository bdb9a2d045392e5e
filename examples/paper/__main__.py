"""Solve the contacts of Spinu et al.: a table here, figures and all numbers in a folder."""

from __future__ import annotations

import argparse
import time
import warnings
from pathlib import Path

from rich import box
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

import nacre
from paper import PROBLEM, SERIES, Result, claims, deviations, run, thickness_note
from paper.evaluation import COLUMNS

# Width of the table, in a file as in a terminal.
WIDTH = 80
FRACTIONS = {0.25: "1/4", 0.5: "1/2", 1.0: "1", 2.0: "2", 4.0: "4"}


def main() -> None:
    """Solve a coated sphere and a coated roller of finite length, for five ratios of moduli each.

    There are seven figures (PNG) and their numbers (CSV).
    """
    parser = argparse.ArgumentParser(prog="paper", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder; made if need be")
    parser.add_argument("--threads", type=int, help="cases at a time; as many as cores by default")
    parser.add_argument("--quick", action="store_true", help="coarse grids, for a first look")
    asked = parser.parse_args()

    console = Console(width=WIDTH, highlight=False)
    console.print(PROBLEM)
    start = solved = time.perf_counter()

    def show(done: int, total: int) -> None:
        nonlocal solved
        solved = time.perf_counter()
        bar.update(task, completed=done, total=total)

    parts = (TextColumn("solving"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with warnings.catch_warnings(), Progress(*parts, console=console) as bar:
        # The reports have the warnings, which are printed below.
        warnings.simplefilter("ignore", nacre.NacreWarning)
        task = bar.add_task("", total=None)
        results = run(asked.out, threads=asked.threads, quick=asked.quick, progress=show)
    drawn = time.perf_counter()
    _print_results(console, results)
    _print_claims(console, results)
    _print_reference(console, results)
    grids = " on coarse grids" if asked.quick else ""
    console.print(
        f"\n{len(results)} solves{grids}, all converged: {solved - start:.1f} s; "
        f"figures: {drawn - solved:.1f} s, in {asked.out}",
        soft_wrap=True,
        markup=False,
    )


def _print_results(console: Console, results: list[Result]) -> None:
    """Print one table, with a heading for each series."""
    headings = ["E₁/E₂", *(f"{c.heading}\n{c.unit}".rstrip() for c in COLUMNS)]
    cells = [
        [FRACTIONS[r.ratio], *(f"{c.value(r):z.{c.decimals}f}" for c in COLUMNS)] for r in results
    ]
    widths = [
        max(map(len, [*heading.split("\n"), *column]))
        for heading, column in zip(headings, zip(*cells, strict=True), strict=True)
    ]
    for number, series in enumerate(SERIES):
        table = Table(
            title=f"\n{series.title}",
            title_justify="left",
            title_style="bold",
            box=box.SIMPLE_HEAD,
            padding=0,
            pad_edge=False,
            show_edge=False,
            show_header=number == 0,
        )
        for heading, width in zip(headings, widths, strict=True):
            table.add_column(heading, justify="right", min_width=width, vertical="bottom")
        for result, row in zip(results, cells, strict=True):
            if result.series == series:
                table.add_row(*row)
        console.print(table)
    for result in results:
        for warning in result.solution.report.warnings:
            console.print(f"{result.series.title}, E₁/E₂ = {FRACTIONS[result.ratio]}: {warning}")
    console.print(f"\n{thickness_note(results)}")


def _print_claims(console: Console, results: list[Result]) -> None:
    """Print the cases in which the closing claim of Spinu et al. holds."""
    console.print(
        "\n[bold]The closing claim of Spinu et al.[/bold]\n"
        "A compliant coating (E₁ < E₂) brings a smaller riser and a larger contact area than "
        "E₁ = E₂. Changes of riser and area:"
    )
    table = Table(box=box.SIMPLE, padding=(0, 1), pad_edge=False)
    for heading in ("", "E₁/E₂", "riser", "area", "claim"):
        table.add_column(heading, justify="left" if heading in ("", "claim") else "right")
    for series in SERIES[1:]:
        compliant = [c for c in claims(results) if c.series == series and c.ratio < 1]
        for number, c in enumerate(compliant):
            table.add_row(
                series.title if number == 0 else "",
                FRACTIONS[c.ratio],
                f"{c.riser:+.1%}",
                f"{c.area:+.1%}",
                "holds" if c.holds else "does not hold",
            )
    console.print(table)


def _print_reference(console: Console, results: list[Result]) -> None:
    """Print the deviations of the sphere from its reference."""
    found = deviations(results)
    peak, approach, pressure = (
        max((getattr(deviation, name) for deviation in found), key=abs)
        for name in ("peak", "approach", "pressure")
    )
    console.print(
        "[bold]The sphere against its reference values[/bold]\n"
        f"Largest deviations: peak pressure {peak:+.1e}, approach {approach:+.1e}; p(r) "
        f"{pressure:.1e} of p_H within 95 % of the contact radius."
    )


if __name__ == "__main__":
    main()
