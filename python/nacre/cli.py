"""The command ``nacre``.

The command needs the extra ``nacre-contact[cli]``. Its exit code is 0 if everything converged, 1 if
something failed, 2 for bad input, 130 after Ctrl-C and 141 if nobody reads its output any more.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib.util import find_spec
from typing import TextIO


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit.

    Parameters
    ----------
    arguments
        Arguments after the name of the command; those of the process by default.
    """
    try:
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="replace")  # not every terminal has Greek letters
        code = _run(arguments)
    except KeyboardInterrupt:
        code = 130
    except BrokenPipeError:
        code = 141
    except OSError as error:
        code = _fail(str(error), 1)
    for stream in (sys.stdout, sys.stderr):
        code = _flushed(stream, code)
    if code == 130:
        os._exit(code)  # the end of the interpreter takes half a second
    sys.exit(code)


def _flushed(stream: TextIO | None, code: int) -> int:
    """Return the exit code once a stream is flushed; one that takes no more is at its end."""
    if stream is None:
        return code
    try:
        stream.flush()
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        if isinstance(error, BrokenPipeError):
            return code or 141
        return code or _fail(f"{stream.name}: {error}", 1)
    return code


def _run(arguments: Sequence[str] | None) -> int:
    """Run one command and return its exit code; an error is one line on stderr."""
    import nacre

    argv = sys.argv[1:] if arguments is None else list(arguments)
    if argv == ["--version"]:  # soon, without the libraries of all commands
        print(f"nacre {nacre.__version__}")
        return 0
    for name in ("typer", "pydantic"):
        if find_spec(name) is None:
            return _fail(f"the command line needs {name}: pip install 'nacre-contact[cli]'", 2)
    import typer

    from nacre.verify.command import commands

    try:
        if not argv:
            commands(["--help"], prog_name="nacre", standalone_mode=False)
            return 2
        return int(commands(arguments, prog_name="nacre", standalone_mode=False) or 0)
    except typer.TyperException as error:
        return _fail(error.format_message(), 2)
    except (ValueError, ModuleNotFoundError) as error:
        return _fail(str(error), 2)
    except SystemExit as end:  # of Typer, which meets a closed pipe
        raise end.__context__ or end from None
    except BrokenPipeError:
        raise
    except nacre.ConvergenceError as error:
        return _fail("; ".join([*getattr(error, "__notes__", ()), str(error)]), 1)
    except (MemoryError, OSError) as error:
        return _fail(str(error), 1)


def _fail(message: str, code: int) -> int:
    with suppress(OSError):
        print(f"nacre: {' '.join(message.split())}", file=sys.stderr)
    return code


if __name__ == "__main__":
    main()
