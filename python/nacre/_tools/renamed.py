"""Old names, which work for a release with a `DeprecationWarning` that names the new ones."""

from __future__ import annotations

import warnings
from typing import Any


def warn_of(old: str, new: str, depth: int = 3) -> None:
    """Warn that an old name is used; `depth` is the frame of the user's call."""
    warnings.warn(f"{old} is deprecated: write {new}", DeprecationWarning, stacklevel=depth)


def renamed(old: str, new: str) -> Any:
    """Return the property of an old name that has the value of the new attribute."""

    def value(result: object) -> Any:
        warn_of(old, new)
        return getattr(result, new)

    return property(value, doc=f"Deprecated: `{new}`.")
