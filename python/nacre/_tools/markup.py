"""Markup of pages, from parts in files; text in it is escaped here alone."""

from __future__ import annotations

import html
import re
from importlib import resources
from string import Template


class Markup(str):
    """Text that is markup, of which nothing is escaped."""


def text_of(package: str, name: str) -> str:
    """Return the text of a file of a package."""
    return (resources.files(package) / name).read_text("utf-8")


class Parts:
    r"""Parts of markup with places for values.

    Parameters
    ----------
    text
        All parts, each after a comment with its name.

    Examples
    --------
    >>> parts = Parts("<!-- item -->\n<li>$word</li>\n<!-- list -->\n<ul>$items</ul>\n")
    >>> parts("list", items=[parts("item", word=word) for word in ("a < b", 0.5)])
    '<ul><li>a &lt; b</li><li>0.5</li></ul>'
    """

    def __init__(self, text: str) -> None:
        _, *named = re.split(r"<!-- (\w+) -->\n", text)
        named_parts = zip(named[::2], named[1::2], strict=True)
        self._parts = {name: Template(snippet.rstrip("\n")) for name, snippet in named_parts}

    def __call__(self, name: str, /, **values: object) -> Markup:
        """Return a part with values in its places: markup, text, numbers, or several of them."""
        texts = {place: _html(value) for place, value in values.items()}
        return Markup(self._parts[name].substitute(texts))


def _html(value: object) -> str:
    if isinstance(value, list):
        return "".join(map(_html, value))
    if isinstance(value, Markup):
        return value
    if isinstance(value, float):
        return f"{value:.12g}"
    return "" if value is None else html.escape(str(value))
