"""Warnings that point at the line of the user's call."""

from __future__ import annotations

import sys
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import nacre._core as core

HEARING = threading.Lock()
"""Lock of the filters of warnings, which all threads share."""
PACKAGE = str(Path(core.__file__).parent)


def warn(message: str, category: type[Warning] = core.NacreWarning) -> None:
    """Issue a warning, by default a `NacreWarning`, of the call that entered the package."""
    level, frame = 1, sys._getframe()
    while frame is not None and frame.f_code.co_filename.startswith(PACKAGE):
        level, frame = level + 1, frame.f_back  # type: ignore[assignment]
    warnings.warn(message, category, stacklevel=level)


@contextmanager
def heard() -> Iterator[list[str]]:
    """Yield a list to which the warnings of nacre in this thread are added, not shown."""
    texts, thread = list[str](), threading.get_ident()

    def add(message: Warning | str, *_: object, **__: object) -> None:
        if threading.get_ident() == thread:
            texts.append(str(message))

    with HEARING, warnings.catch_warnings():
        warnings.simplefilter("always", core.NacreWarning)
        warnings.showwarning = add
        yield texts
