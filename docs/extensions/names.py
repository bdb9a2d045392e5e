"""Table of the names of the reference, with a line on each, from the pages and the docstrings."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path
from typing import Any

API = Path(__file__).parents[1] / "api"
DIRECTIVE = re.compile(
    r"^\.\. (?:auto|py:)(?!module)\w+:: (nacre[\w.]+)$", re.MULTILINE
)


def expanded(text: str) -> str:
    """Text of a page, with the classes of all shapes in place of ``.. shapes::``."""
    shapes = import_module("nacre.types").Shape.__subclasses__()
    classes = (f".. autoclass:: nacre.{shape.__name__}\n" for shape in shapes)
    return text.replace(".. shapes::\n", "\n".join(classes))


def reference(page: str) -> str:
    """Text of a page of the reference."""
    return expanded((API / f"{page}.rst").read_text(encoding="utf-8"))


def names() -> dict[str, str]:
    """Names in the order of the pages, each with its page."""
    pages = re.findall(
        r"^(\w+)$", (API / "index.md").read_text(encoding="utf-8"), re.MULTILINE
    )
    return {
        name: page
        for page in pages
        for name in DIRECTIVE.findall(reference(page))
    }


def sentence(name: str) -> str:
    """First sentence of the docstring; "" of what cannot be imported, or is a value."""
    module, _, attribute = name.rpartition(".")
    try:
        value = getattr(import_module(module), attribute)
    except ImportError:
        return ""
    words = value.__doc__ or "" if callable(value) else ""
    return " ".join(words.split("\n\n")[0].split())


def table() -> str:
    """Markdown table of names, each with a link and a line."""
    lines = ["| name | |", "|---|---|"]
    for name, page in names().items():
        lines.append(
            f"| [`{name.removeprefix('nacre.')}`]({page}.rst) | {sentence(name)} |"
        )
    return "\n".join(lines) + "\n"


def fill(app: Any, page: str, source: list[str]) -> None:
    """Put the table in the place of a `{names}` block, and the shapes in that of theirs."""
    source[0] = expanded(source[0].replace("```{names}\n```\n", table()))


def setup(app: Any) -> dict[str, bool]:
    """Fill pages when they are read."""
    app.connect("source-read", fill)
    return {"parallel_read_safe": True}
