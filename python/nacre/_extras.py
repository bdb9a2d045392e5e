"""Libraries that come with extras: imported where used, and named where missing."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def extra(name: str) -> Iterator[None]:
    """Say in the error of a failing import which extra brings the library."""
    try:
        yield
    except ModuleNotFoundError as missing:
        library = (missing.name or "a library").partition(".")[0]
        message = f"this needs {library}: pip install 'nacre[{name}]'"
        raise ModuleNotFoundError(message, name=missing.name) from missing
