"""The commands of ``nacre``, with Typer: contacts, indentations, bearings and studies of them.

What stands behind a command is imported in the command: ``nacre --help`` needs none of it.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

import nacre


class Command(TyperCommand):
    """Command whose usage names its file without braces."""

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return the parts of the line of usage."""
        return [piece.strip("{}") for piece in super().collect_usage_pieces(ctx)]


app = typer.Typer(
    help="Elastic contact of coated bodies.",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

CaseFile = Annotated[
    Path, typer.Argument(metavar="CASE.toml", help="The case.", show_default=False)
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, in the units of the case.")]
Units = Annotated[
    str | None,
    typer.Option(
        metavar="UNITS",
        help="Units of the numbers in the case, N-mm-MPa; in place of its key units.",
    ),
]


def _in_folder(paths: Path | list[Path] | None) -> Path | list[Path] | None:
    """Return the paths of an option, or the path; a folder that is missing is an error."""
    if not paths:
        return paths
    from nacre._tools.disk import check_folder

    for path in paths if isinstance(paths, list | tuple) else [paths]:
        try:
            check_folder(path)
        except FileNotFoundError as error:
            raise typer.BadParameter(str(error)) from error
    return paths


def _version(show: bool) -> None:
    if show:
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


@app.command(cls=Command)
def info() -> None:
    """Print versions and the number of threads."""
    import numpy as np

    from nacre.studies import default_threads

    print(f"nacre   {nacre.__version__}")
    print(f"numpy   {np.__version__}")
    print(f"threads {default_threads()}")


@app.command(cls=Command)
def solve(
    case: CaseFile,
    save: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE",
            callback=_in_folder,
            help="File to write: .nc, .vtr, .csv, a picture, or .html, a report; of wear .gif, "
            "too. May be repeated.",
        ),
    ] = None,
    initial: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Solution to start from, a .nc file: the surfaces keep its permanent indentation. "
            "Or a history of wear to continue.",
        ),
    ] = None,
    units: Units = None,
    as_json: Json = False,
) -> None:
    """Solve the contact, wear, indentation or bearing of a case file."""
    from nacre.case import running
    from nacre.results.display import wrapped

    with wrapped():
        running.solve(case, save or [], initial, units, as_json)


@app.command(cls=Command)
def sweep(
    case: CaseFile,
    store: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=_in_folder,
            help="NetCDF file, in place of the file in the case.",
        ),
    ] = None,
    save: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE",
            callback=_in_folder,
            help="File to write: .csv or .html. May be repeated.",
        ),
    ] = None,
    retry: Annotated[bool, typer.Option("--retry", help="Try failed cases again.")] = False,
    units: Units = None,
    as_json: Json = False,
) -> None:
    """Solve the study of a case file, or the rest of it after a kill."""
    from nacre.case import running
    from nacre.results.display import wrapped

    with wrapped():
        running.sweep(case, store, save or [], retry, units, as_json)


@app.command(cls=Command)
def indent(
    case: CaseFile,
    save: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE",
            callback=_in_folder,
            help="File to write: .nc, .csv or .html. May be repeated.",
        ),
    ] = None,
    units: Units = None,
    as_json: Json = False,
) -> None:
    """Solve the indentation of a case file, as solve does."""
    from nacre.case import running
    from nacre.results.display import wrapped

    with wrapped():
        running.indent(case, save or [], units, as_json)


def _case_error(message: str) -> ValueError:
    """Return the error of a case, whose class comes with all that reads cases."""
    from nacre.case import CaseError

    return CaseError(message)


@app.command(cls=Command)
def new(
    kind: Annotated[
        str | None,
        typer.Argument(metavar="KIND", help="Kind of the case.", show_default=False),
    ] = None,
    file: Annotated[
        Path | None,
        typer.Argument(
            metavar="FILE", help="File to write; by default it is printed.", show_default=False
        ),
    ] = None,
) -> None:
    """List commented case files to start from; print or write one."""
    from nacre.case import templates

    texts = templates.texts()
    if kind is None:
        width = max(map(len, texts))
        for name, text in texts.items():
            print(f"{name:{width}}  {templates.title(text)}")
        return
    if kind not in texts:
        raise _case_error(f"KIND must be one of {', '.join(texts)}, got {kind!r}")
    if file is None:
        print(texts[kind], end="")
        return
    try:
        stream = file.open("x", encoding="utf-8")
    except FileExistsError:
        raise _case_error(f"{str(file)!r} exists already: give a new file") from None
    try:
        with stream:
            stream.write(texts[kind])
    except OSError as error:
        file.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror, str(file)) from error


@app.command(cls=Command)
def schema(
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON schema.")] = False,
) -> None:
    """Print the reference of case files: all tables and keys."""
    from nacre.case import reference

    print(
        json.dumps(reference.for_editors(reference.schema()), indent=2)
        if as_json
        else reference.text()
    )
