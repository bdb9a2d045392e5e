"""The commands of ``nacre``, with Typer and Rich."""

from __future__ import annotations

import os
import time
import warnings
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich import box
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

import nacre
from nacre.paper import (
    PROBLEM,
    SERIES,
    Result,
    claims,
    deviations,
    make_directory,
    run,
    thickness_note,
)
from nacre.paper.evaluation import COLUMNS

app = typer.Typer(
    help="Elastic contact of coated bodies.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

# Width of the table, in a file as in a terminal.
WIDTH = 80
FRACTIONS = {0.25: "1/4", 0.5: "1/2", 1.0: "1", 2.0: "2", 4.0: "4"}


def _version(asked: bool) -> None:
    if asked:
        print(f"nacre {nacre.__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    """Elastic contact of coated bodies."""


@app.command()
def info() -> None:
    """Print versions and the number of threads."""
    print(f"nacre   {nacre.__version__}")
    print(f"numpy   {np.__version__}")
    print(f"threads {os.cpu_count()}")


@app.command()
def paper(
    out: Annotated[
        Path, typer.Option(help="Directory for figures and numbers; made if need be.")
    ] = Path("out"),
    threads: Annotated[
        int | None,
        typer.Option(min=1, max=1024, help="Threads. [default: as many as cores]"),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Coarse grids, for a first look.")] = False,
) -> None:
    """Solve the contacts of Spinu et al. and draw their figures.

    A coated sphere and a coated roller of finite length, for five ratios of moduli each: a table
    here, seven figures (PNG) and all numbers (CSV) under OUT.
    """
    try:
        make_directory(out)
    except OSError as error:
        message = f"cannot write to {str(out)!r}: {error.strerror or error}"
        raise typer.BadParameter(message, param_hint="'--out'") from error

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
        results = run(out, threads=threads, quick=quick, progress=show)
    drawn = time.perf_counter()
    _print_results(console, results)
    _print_claims(console, results)
    _print_reference(console, results)
    grids = " on coarse grids" if quick else ""
    console.print(
        f"\n{len(results)} solves{grids}, all converged: {solved - start:.1f} s; "
        f"figures: {drawn - solved:.1f} s, in {out}",
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
