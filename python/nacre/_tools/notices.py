"""Warnings that point at the line of the user's call."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

import nacre._core as core

_HEARD: ContextVar[list[str] | None] = ContextVar("heard", default=None)
"""Texts of warnings that are not shown: filters of `warnings` belong to all threads."""
PACKAGE = str(Path(core.__file__).parent)


def warn(message: str, category: type[Warning] = core.NacreWarning) -> None:
    """Issue a warning, by default a `NacreWarning`, of the call that entered the package."""
    texts = _HEARD.get()
    if texts is not None and category is core.NacreWarning:
        texts.append(message)
        return
    level, frame = 1, sys._getframe()
    while frame is not None and frame.f_code.co_filename.startswith(PACKAGE):
        level, frame = level + 1, frame.f_back  # type: ignore[assignment]
    warnings.warn(message, category, stacklevel=level)


@contextmanager
def heard() -> Iterator[list[str]]:
    """Yield a list to which nacre's warnings are added, not shown, here and in `thread_pool`."""
    texts = list[str]()
    token = _HEARD.set(texts)
    try:
        yield texts
    finally:
        _HEARD.reset(token)
