"""``nacre indent``: indentations in case files."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Annotated, Any

import typer

import nacre.indent.solution as solving
from nacre._case_commands import CaseFile, Json, Units, plain, read_case
from nacre._commands import app
from nacre._core import NacreWarning
from nacre._progress import alive
from nacre.case import CaseError
from nacre.units import display_units


@app.command()
def indent(
    case: CaseFile,
    save: Annotated[
        list[Path] | None, typer.Option(help="File to write: .nc or .csv. May be repeated.")
    ] = None,
    units: Units = None,
    as_json: Json = False,
) -> None:
    """Solve the indentation that a case file describes: one with the tables [tip] and [indent]."""
    described = read_case(case, units)
    if not described.is_indentation:
        raise CaseError(f"{case}: this case is a contact, without [tip] and [indent]: nacre solve")
    for path in save or []:
        if path.suffix not in (".nc", ".csv"):
            raise CaseError(f"--save must end in .nc or .csv, got {str(path)!r}")
    arguments = described.arguments()
    with display_units(described.units), warnings.catch_warnings():
        warnings.simplefilter("ignore", NacreWarning)  # the printed solution has them
        try:
            with alive():
                solution = solving.solve(**arguments)
                found = numbers(solution)
        except (ArithmeticError, TypeError, ValueError) as error:
            raise CaseError(f"{case}: indent: {error}") from error
        for path in save or []:
            solution.save(path)
        print(json.dumps(plain(found), indent=2) if as_json else solution)


def numbers(solution: solving.IndentSolution) -> dict[str, Any]:
    """Return the named state of an indentation, the pull-off only with adhesion."""
    state = solution.to_dict()
    if solution.adhesion is None:
        del state["pull_off"]
    else:
        pulled = state["pull_off"].items()
        state["pull_off"] = {name.removeprefix("pull_off_"): value for name, value in pulled}
    return {name: value for name, value in state.items() if name not in ("format", "kind")}
