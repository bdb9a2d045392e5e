"""The command ``nacre app``: it serves the page until Ctrl-C."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated

import typer

from nacre.case.commands import Command
from nacre.case.commands import app as commands

__all__ = ["commands"]

PORT = 8765
"""Port of the page, if it is free."""


@commands.command(cls=Command)
def app(
    case: Annotated[
        Path | None,
        typer.Argument(metavar="CASE.toml", help="A case as a card.", show_default=False),
    ] = None,
    port: Annotated[
        int, typer.Option(metavar="PORT", min=1, max=65535, help="Port, if it is free.")
    ] = PORT,
    browser: Annotated[bool, typer.Option(help="Open the page in a browser.")] = True,
) -> None:
    """Open a page for bearings, contacts and indentations, on this computer alone, until Ctrl-C."""
    import webbrowser
    from threading import Timer

    from nacre.app.cards import cards, own_card
    from nacre.app.server import open_server

    own = {} if case is None else {"own": own_card(case)}
    server = open_server(port, cards() | own)
    if server.server_port != port:
        print(f"port {port} is taken: {server.server_port} in its place")
    print(f"nacre is at {server.url}; Ctrl-C ends it", flush=True)
    if browser:
        Timer(0.2, webbrowser.open, [server.url_once + ("#card=own" if own else "")]).start()
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        sys.stdout.flush()
        os._exit(130)  # threads in compiled code do not survive the end of the interpreter
