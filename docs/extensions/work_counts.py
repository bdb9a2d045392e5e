"""The table of counted work over the releases, from benches/counts.csv."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

TABLE = Path(__file__).parents[2] / "benches" / "counts.csv"
SHOWN = 6
"""Releases that have columns, the newest ones."""


def table(rows: list[dict[str, str]]) -> str:
    """Markdown: millions of instructions of each case, with their change, and convolutions."""
    releases = list(dict.fromkeys(row["release"] for row in rows))[-SHOWN:]
    by_place = {(row["release"], row["case"]): row for row in rows}
    lines = [
        f"| case | {' | '.join(releases)} | convolutions |",
        "|---|" + "---|" * (len(releases) + 1),
    ]
    for case in dict.fromkeys(
        row["case"] for row in rows if row["release"] == releases[-1]
    ):
        cells: list[str] = []
        before = None
        for release in releases:
            row = by_place.get((release, case))
            cells.append(cell(row, before) if row else "")
            before = row or before
        solved = by_place[releases[-1], case]["convolutions"]
        cells.append(f"{float(solved):.3g}" if solved else "")
        lines.append(f"| `{case}` | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def cell(row: dict[str, str], before: dict[str, str] | None) -> str:
    """Millions of instructions, and their change where both were counted by the same tools."""
    count = float(row["instructions"])
    words = f"{count / 1e6:.4g}"
    if before and before["tools"] == row["tools"]:
        words += f", {100 * (count / float(before['instructions']) - 1):+.1f} %"
    return words


def fill(app: Any, page: str, source: list[str]) -> None:
    """Put the table in the place of the `{counts}` block."""
    if "```{counts}\n```\n" in source[0]:
        with TABLE.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        source[0] = source[0].replace("```{counts}\n```\n", table(rows))


def setup(app: Any) -> dict[str, bool]:
    """Fill the page when it is read."""
    app.connect("source-read", fill)
    return {"parallel_read_safe": True}
