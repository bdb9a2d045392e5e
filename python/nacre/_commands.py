"""The command ``nacre``, with Typer, and what it says of itself."""

from __future__ import annotations

import os
from typing import Annotated

import numpy as np
import typer

import nacre

app = typer.Typer(
    help="Elastic contact of coated bodies.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


def _version(asked: bool) -> None:
    if asked:
        print(f"nacre {nacre.__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    """Elastic contact of coated bodies."""


@app.command()
def info() -> None:
    """Print versions and the number of threads."""
    print(f"nacre   {nacre.__version__}")
    print(f"numpy   {np.__version__}")
    print(f"threads {os.cpu_count()}")
