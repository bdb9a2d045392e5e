"""Tables of accuracy from claims.json: of pages, and of README.

Run this file to write README's table anew.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

DOCS = Path(__file__).parents[1]
HEAD = "| problem | error | reference |\n|---|---|---|\n"


def claims() -> list[dict[str, Any]]:
    """All claims: name, section, problem, figure, bar, reference, test."""
    rows: list[dict[str, Any]] = json.loads(
        (DOCS / "claims.json").read_text(encoding="utf-8")
    )
    return rows


def number(value: float) -> str:
    """Two digits, as 1.2e-4 or 0.34."""
    if value >= 0.01:
        return f"{value:.2g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"


def section(name: str) -> str:
    """Markdown table of a section: the measured figure beside the bar that its test asserts.

    Rows of stated errors have the share that holds, and as figure their median over the true ones.
    """
    chosen = [row for row in claims() if row["section"] == name]
    if all("within" in row for row in chosen):
        lines = [
            "| number | within ± | ± over error, median | tried on | test |",
            "|---|---|---|---|---|",
        ]
        lines += [
            f"| {row['problem']} | {100 * row['within']:g} % | {number(row['figure'])}, bar "
            f"{number(row['bar'])} | {row['reference']} | `{Path(row['test']).stem}` |"
            for row in chosen
        ]
        return "\n".join(lines) + "\n"
    lines = [
        "| problem | error | bar of the test | reference | test |",
        "|---|---|---|---|---|",
    ]
    for row in chosen:
        figure = f"{number(row['figure'])} {row.get('of', '')}".strip()
        test = Path(row["test"]).stem
        lines.append(
            f"| {row['problem']} | {figure} | {number(row['bar'])} | {row['reference']} "
            f"| `{test}` |"
        )
    return "\n".join(lines) + "\n"


def readme() -> str:
    """README's table."""
    rows = [row for row in claims() if row.get("readme")]
    return HEAD + "".join(
        f"| {row['problem']} | {number(row['figure'])} {row.get('of', '')}".rstrip()
        + f" | {row['reference']} |\n"
        for row in rows
    )


def fill(app: Any, page: str, source: list[str]) -> None:
    """Put tables in the place of `{claims} SECTION` blocks."""
    source[0] = re.sub(
        r"```\{claims\} (\w+)\n```\n",
        lambda match: section(match[1]),
        source[0],
    )


def setup(app: Any) -> dict[str, bool]:
    """Fill pages when they are read."""
    app.connect("source-read", fill)
    return {"parallel_read_safe": True}


if __name__ == "__main__":
    path = DOCS.parent / "README.md"
    text = path.read_text(encoding="utf-8")
    before, rest = text.split(HEAD)
    path.write_text(
        before + readme() + rest[rest.index("\n\n") + 1 :], encoding="utf-8"
    )
