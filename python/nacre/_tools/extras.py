"""Optional libraries: imported where they are used, named by an error where they are missing."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def extra(name: str) -> Iterator[None]:
    """Name the extra that brings the library, in the error of a failing import."""
    try:
        yield
    except ModuleNotFoundError as missing:
        library = (missing.name or "a library").partition(".")[0]
        message = f"this needs {library}: pip install 'nacre-contact[{name}]'"
        raise ModuleNotFoundError(message, name=missing.name) from missing
