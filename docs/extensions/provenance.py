"""Table of the files of reference numbers, from what each says of itself, and their tests."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
DATA = ROOT / "tests" / "data"
SUFFIXES = {".py", ".rs"}


def files() -> dict[str, dict[str, Any]]:
    """Files of reference numbers by name, without those made from others."""
    return {
        path.relative_to(DATA).as_posix(): json.loads(
            path.read_text(encoding="utf-8")
        )
        for path in sorted(DATA.rglob("*.json"))
        if path.parent.name not in {"benchmark", "schema"}
    }


def readers(name: str) -> list[str]:
    """Return the tests that name a file."""
    stem = Path(name).stem
    words = (f'"{stem}"', f"{stem}.json", f'"{name.removesuffix(".json")}"')
    return sorted(
        path.relative_to(ROOT).as_posix()
        for folder in ("tests", "src")
        for path in (ROOT / folder).rglob("*")
        if path.suffix in SUFFIXES
        and "make" not in path.parts
        and any(word in path.read_text(encoding="utf-8") for word in words)
    )


def cell(text: object) -> str:
    """Text of a cell of a table, on one line."""
    return " ".join(str(text).split()).replace("|", "\\|").replace("*", "\\*")


def table() -> str:
    """Markdown table: file, source, how the numbers were made and checked, error, tests."""
    lines = [
        "| file | source | made and checked | error | tests |",
        "|---|---|---|---|---|",
    ]
    for name, content in files().items():
        tests = ", ".join(f"`{Path(path).name}`" for path in readers(name))
        parts = (cell(content[key]) for key in ("source", "method", "error"))
        lines.append(f"| `{name}` | {' | '.join(parts)} | {tests} |")
    return "\n".join(lines) + "\n"


def fill(app: Any, page: str, source: list[str]) -> None:
    """Put the table in the place of a `{provenance}` block."""
    source[0] = source[0].replace("```{provenance}\n```\n", table())


def setup(app: Any) -> dict[str, bool]:
    """Fill pages when they are read."""
    app.connect("source-read", fill)
    return {"parallel_read_safe": True}
