"""What was measured, as CSV, as Markdown and as a plot."""

from __future__ import annotations

import csv
import os
import platform
from dataclasses import asdict, fields
from datetime import UTC, datetime
from pathlib import Path

from peers.figures import Figure, all_figures, ratio, times
from peers.measure import BESIDE, Bench, Row
from peers.programs import PROGRAMS, release

TITLES = {
    "hertz": "Hertz: a sphere on a square of side 2, contact radius 1/3",
    "rough": "Rough: self-affine, Hurst 0.8, rms slope 1, mean pressure 0.04 E*",
    "periodic": "Rough and periodic: the same spectrum, with the side as its period",
    "opened": "The same surface once, on a grid that does not repeat",
    "coated": "Hertz on a layer of four times the modulus, as thick as the contact radius",
    "batch": "1000 coated spheres, load by load; on several threads by `Contact.solve_many`",
    "roller": "Roller of Spinu et al., E1/E2 = 4, e/L = 0.3, with an eighth of the cells across",
}
FRICTION = "A ball pulled by half of the force that friction can carry"
CONVOLUTION = "One zero-padded convolution"


def write(bench: Bench, text: Path, image: Path, csv_file: Path) -> None:
    """Write the page, the picture and the table of numbers."""
    for file in (text, image, csv_file):
        file.parent.mkdir(parents=True, exist_ok=True)
    with csv_file.open("w", newline="", encoding="utf-8") as opened:
        writer = csv.DictWriter(opened, [f.name for f in fields(Row)], lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(row) for row in bench.rows)
    link = Path(os.path.relpath(image, text.parent)).as_posix()
    data = Path(os.path.relpath(csv_file, text.parent)).as_posix()
    text.write_text(markdown(bench, link, data), encoding="utf-8")
    plot(bench, image)


def markdown(bench: Bench, image: str, data: str) -> str:
    """Return the page."""
    names = [n for n in (*PROGRAMS, "SciPy") if any(row.program == n for row in bench.rows)]
    present = {row.program for row in bench.rows if row.seconds is not None}
    versions = ", ".join(f"{name} {release(name)}" for name in names if name in present)
    lines = [
        "# nacre compared with other solvers",
        "",
        "This page compares nacre with other solvers on equal problems, solved to equal residuals.",
        "`make peers` wrote it in one run; [`benches/README.md`](../benches/README.md) describes",
        f"the measurement. {datetime.now(UTC):%d %B %Y}, {machine()}, load average before the run",
        f"{bench.load:.2f}: {versions}. All numbers: [`{data}`]({data}).",
        "",
        f"![Time of a solve as a function of the number of cells]({image})",
        "",
        *glance(bench, [name for name in names if name in PROGRAMS and name != "nacre"]),
    ]
    for problem, title in TITLES.items():
        rows = [row for row in bench.rows if row.problem == problem]
        rows.sort(
            key=lambda row: (
                names.index(row.program),
                list(BESIDE).index(row.setting),
                row.threads,
                row.cells,
            )
        )
        if rows:
            lines += ["", f"## {title}", "", *table(HEADER, [cells(row) for row in rows])]
    if rows := [row for row in bench.rows if row.problem == "friction"]:
        lines += ["", f"## {FRICTION}", "", *friction(rows)]
    rows = [row for row in bench.rows if row.problem == "convolution"]
    if rows:
        lines += ["", f"## {CONVOLUTION}", "", *convolutions(rows)]
    lines += [
        "",
        "## Figures of nacre itself",
        "",
        *table(("quantity", "measured"), [(f.what, measured(f)) for f in all_figures(bench)]),
        "",
        "The time outside transforms is the share of a solve that is not spent in kernels,",
        "transforms and products, for the fastest of some hundred solves",
        "(`benches/convolution.rs`).",
        *shared(bench),
    ]
    return "\n".join(lines) + "\n"


def glance(bench: Bench, programs: list[str]) -> list[str]:
    """Return how many times nacre's time every other program takes, by problem."""
    rows = []
    for problem in ("hertz", "rough", "periodic"):
        if bench.find(problem, 1024, "nacre", 1) is None:
            continue
        found = [times(bench, problem, name) for name in programs]
        shown = ["–" if each is None else f"{each:.3g}" for each in found]
        rows.append((TITLES[problem], *shown))
    if not rows or not programs:
        return []
    return [
        "Time of a solve over that of nacre, 1024² cells, one thread. A dash: the program does not",
        "solve the problem, took too long, or did not reach the residual.",
        "",
        *table(("problem", *programs), rows),
    ]


def shared(bench: Bench) -> list[str]:
    """Return lines on the gain by a second core on this machine."""
    alone = bench.find("hertz", 1024, "nacre", 1, "idle")
    longer = ratio(bench.find("hertz", 1024, "nacre", 1, "shared"), alone)
    if longer is None:
        return []
    return [
        "",
        f"Two processes at once, each on one thread, take {longer:.2f} times as long per solve as",
        f"one process alone. An ideal solve on two threads would take {longer / 2:.2f} of the time",
        "on one thread.",
    ]


HEADER = (
    "cells",
    "program",
    "threads",
    "solve [s]",
    "planning [s]",
    "residual",
    "iterations",
    "convolutions",
    "bytes a cell",
    "",
)


def cells(row: Row) -> tuple[str, ...]:
    """Return the cells of a row of the table."""

    def form(found: float | None, how: str) -> str:
        return "–" if found is None else format(found, how)

    return (
        f"{row.cells}²" if row.problem != "roller" else f"{row.cells} × {row.cells // 8}",
        row.program,
        str(row.threads),
        form(row.seconds, ".3g"),
        form(row.planning, ".2g"),
        form(row.residual, ".1e"),
        form(row.iterations, "d"),
        form(row.work, ".1f"),
        form(row.bytes_per_cell, ".0f"),
        row.note,
    )


def friction(rows: list[Row]) -> list[str]:
    """Return the table of tractions, and what is compared."""
    ours = {row.cells: row.seconds for row in rows if row.program == "nacre"}
    lines: list[tuple[str, ...]] = []
    for row in rows:
        times = row.seconds, ours.get(row.cells)
        share = "–" if None in times else f"{(times[0] or 0) / (times[1] or 1):.3g}"
        work = "–" if row.work is None else f"{row.work:.0f}"
        seconds = "–" if row.seconds is None else f"{row.seconds:.3g}"
        lines.append((f"{row.cells}²", row.program, seconds, share, work, row.note))
    header = ("cells", "program", "solve [s]", "time over nacre's", "convolutions", "")
    return [
        "On one thread. nacre solves Coulomb's law on a half-space, pressure included; Tamaas its",
        "associated form on a periodic one: the effort is compared, not the tractions. Each stops",
        "at 1e-8 by its own account.",
        "",
        *table(header, lines),
    ]


def convolutions(rows: list[Row]) -> list[str]:
    """Return the table of one convolution, by nacre and by SciPy."""
    lines = []
    for theirs in (row for row in rows if row.program == "SciPy"):
        same = (theirs.cells, theirs.threads)
        ours = next(r for r in rows if r.program == "nacre" and (r.cells, r.threads) == same)
        times = [None if r.seconds is None else 1e3 * r.seconds for r in (ours, theirs)]
        shown = ["–" if time is None else f"{time:.3g}" for time in times]
        share = "–" if None in times else f"{(ours.seconds or 0) / (theirs.seconds or 1):.2f}"
        lines.append((f"{theirs.cells}²", str(theirs.threads), *shown, share))
    return table(("cells", "threads", "nacre [ms]", "SciPy [ms]", "nacre / SciPy"), lines)


def measured(figure: Figure) -> str:
    """Return the measured value, with its standard error where it is known."""
    if figure.measured is None:
        return "–"
    text = f"{figure.measured:.3g} {figure.unit}".strip()
    if figure.error is None:
        return text
    return f"{text} ± {figure.error * figure.measured:.1g}"


def table(header: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    """Return a table in Markdown."""
    lines = [header, ("---",) * len(header), *rows]
    return [f"| {' | '.join(line)} |" for line in lines]


def machine() -> str:
    """Return the processor."""
    model = platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        lines = info.read_text(encoding="utf-8").splitlines()
        found = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
        model = found[0] if found else model
    return f"{model}, {os.cpu_count()} cores"


COLOURS = {
    "nacre": "#0b6e5f",
    "ASPHER": "#c2571a",
    "Tamaas": "#5b5ea6",
    "ContactMechanics": "#8a8a8a",
}
SHOWN = {"hertz": "Hertz", "rough": "rough, 8 % contact"}


def plot(bench: Bench, file: Path) -> None:
    """Draw the time of a solve as a function of the number of cells; dashed for two threads."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FixedLocator, NullLocator

    figure, axes = plt.subplots(1, 2, figsize=(9, 4), sharey=True, layout="constrained")
    sizes = sorted({row.cells for row in bench.rows if row.problem in SHOWN and row.cells <= 2048})
    for ax, (problem, title) in zip(axes, SHOWN.items(), strict=True):
        for program, colour in COLOURS.items():
            for threads, style in ((1, "o-"), (2, "s--")):
                rows = [bench.find(problem, size, program, threads) for size in sizes]
                points = [(row.cells, row.seconds) for row in rows if row is not None]
                # One point with two threads shows that the program runs on one.
                if len(points) >= threads:
                    label = f"{program}, {threads} thread{'s' if threads > 1 else ''}"
                    x, y = zip(*points, strict=True)
                    ax.loglog(x, y, style, ms=4, color=colour, label=label)
        ax.set(title=title, xlabel="cells along a side")
        ax.xaxis.set_major_locator(FixedLocator(sizes))
        ax.xaxis.set_minor_locator(NullLocator())
        ax.set_xticklabels([f"{size}²" for size in sizes])
        ax.grid(alpha=0.25)
    axes[0].set_ylabel("solve to a residual of 1e-8 [s]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right center", frameon=False, fontsize="small")
    figure.savefig(file, dpi=150)
    plt.close(figure)
