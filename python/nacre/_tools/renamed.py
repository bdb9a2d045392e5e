"""Old names, which work for a release with a `DeprecationWarning` that names the new ones."""

from __future__ import annotations

from typing import Any

from nacre._tools.notices import warn


def warn_of(old: str, new: str) -> None:
    """Warn of the use of an old name."""
    warn(f"{old} is deprecated: write {new}", DeprecationWarning)


def renamed(old: str, new: str) -> Any:
    """Return the property of an old name that has the value of the new attribute."""

    def value(result: object) -> Any:
        warn_of(old, new)
        return getattr(result, new)

    return property(value, doc=f"Deprecated: `{new}`.")
