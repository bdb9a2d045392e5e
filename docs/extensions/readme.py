"""Sections of README on pages of the site, so that there is one text."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

README = Path(__file__).parents[2] / "README.md"


def section(name: str) -> str:
    """Section between README's comments, with links that hold from the folder of the pages."""
    text = README.read_text(encoding="utf-8")
    found = re.search(
        f"<!-- begin: {name} -->\n(.*?)<!-- end: {name} -->", text, re.DOTALL
    )
    if found is None:
        raise ValueError(f"README.md has no section {name!r}")
    return (
        found[1].replace("](docs/", "](").replace("](examples", "](../examples")
    )


def fill(app: Any, page: str, source: list[str]) -> None:
    """Put sections in the place of `{readme} SECTION` blocks."""
    source[0] = re.sub(
        r"```\{readme\} (\w+)\n```\n",
        lambda match: section(match[1]),
        source[0],
    )


def setup(app: Any) -> dict[str, bool]:
    """Fill pages when they are read."""
    app.connect("source-read", fill)
    return {"parallel_read_safe": True}
