"""Warnings that point at the line of the user's call."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

import nacre._core as core

PACKAGE = str(Path(core.__file__).parent)


def warn(message: str, category: type[Warning] = core.NacreWarning) -> None:
    """Issue a warning, by default a `NacreWarning`, of the call that entered the package."""
    level, frame = 1, sys._getframe()
    while frame is not None and frame.f_code.co_filename.startswith(PACKAGE):
        level, frame = level + 1, frame.f_back  # type: ignore[assignment]
    warnings.warn(message, category, stacklevel=level)
