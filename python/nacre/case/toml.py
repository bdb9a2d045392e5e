"""Case files as text: TOML that `nacre.case.Case.read` reads back."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping

BARE = re.compile(r"[A-Za-z0-9_-]+")
"""Keys that need no quotation marks."""


def text(data: Mapping[str, object], comments: Iterable[str] = ()) -> str:
    """Return the TOML of a case, after comments.

    Examples
    --------
    >>> print(text({"units": "SI", "solve": {"load": 20.0}}, ("a ball",)), end="")
    # a ball
    units = "SI"
    <BLANKLINE>
    [solve]
    load = 20.0
    """
    notes = [f"# {' '.join(note.split())}" for note in comments]
    return "\n".join([*notes, *_table(data, ())]) + "\n"


def _table(data: Mapping[str, object], path: tuple[str, ...]) -> Iterator[str]:
    """Yield the lines of a table: its values first, then the tables in it."""
    tables = {key: value for key, value in data.items() if isinstance(value, Mapping)}
    values = {key: value for key, value in data.items() if key not in tables}
    if path and (values or not tables):
        yield from ("", f"[{'.'.join(map(_key, path))}]")
    for key, value in values.items():
        yield f"{_key(key)} = {_value(value)}"
    for key, value in tables.items():
        yield from _table(value, (*path, key))


def _key(key: str) -> str:
    return key if BARE.fullmatch(key) else _text(key)


def _text(words: str) -> str:
    return json.dumps(words, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: object) -> str:
    """Return a value: a text, true or false, a number, or a list or a table in one line."""
    if isinstance(value, Mapping):
        items = (f"{_key(key)} = {_value(item)}" for key, item in value.items())
        return f"{{ {', '.join(items)} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    return _text(value) if isinstance(value, str) else repr(value)
