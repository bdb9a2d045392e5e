"""Rows: the numbers of a result as they are shown, and words about it."""

from __future__ import annotations

from typing import Any, NamedTuple


class Row(NamedTuple):
    """A number of a result with its label, or words about the result."""

    key: str
    """Name of the quantity, or path of an input."""
    label: str
    """What stands before the text."""
    text: str
    """Number, unit and error in the units that were set, or words."""
    value: Any = None
    """Number or components in SI; None of words."""
    unit: str = ""
    """SI unit."""
    error: Any = None
    """Estimated error in the unit; None where it is not known."""


def remark(label: str, text: str) -> Row:
    """Return words about a result, whose key is their label."""
    return Row(label.replace(" ", "_"), label, text)
