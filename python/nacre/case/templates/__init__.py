"""Commented case files to start from, which ``nacre new`` prints and writes."""

from __future__ import annotations

from importlib import resources

KINDS = (
    *("bearing", "ball-bearing", "pair", "contact", "roller", "line", "indentation", "cone"),
    *("rough", "relay", "slide", "roll", "wear", "fatigue", "sweep"),
)
"""Names of the templates, in the order of the list."""


def texts() -> dict[str, str]:
    """Return the templates by name."""
    folder = resources.files(__name__)
    return {kind: (folder / f"{kind}.toml").read_text(encoding="utf-8") for kind in KINDS}


def title(text: str) -> str:
    """Return the first line of a template, without how it is solved."""
    return text.partition("\n")[0].removeprefix("# ").rpartition(": nacre ")[0]
