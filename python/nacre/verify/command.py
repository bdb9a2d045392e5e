"""The command ``nacre verify``."""

from __future__ import annotations

import json
from typing import Annotated

import typer

import nacre
from nacre.app.command import commands
from nacre.case.commands import Command

__all__ = ["commands"]


@commands.command("verify", cls=Command)
def check(
    cases: Annotated[
        list[str] | None,
        typer.Argument(metavar="CASE", help="Cases; all by default.", show_default=False),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> int:
    """Compute printed numbers of other programs, standards and papers again, and compare."""
    from nacre import verify
    from nacre._tools.units import printable
    from nacre.results.display import aligned

    rows = list(verify.rows(cases or None))
    wrong = sum(row.verdict == "wrong" for row in rows)
    if as_json:
        content = {"version": nacre.__version__, "rows": [row.to_dict() for row in rows]}
        print(json.dumps(content, indent=1, ensure_ascii=False))
        return int(wrong > 0)
    for name in dict.fromkeys(row.case for row in rows):
        printed = verify.printed()[name]
        print(printable(f"{name}: {printed['problem']}\n  {printed['source']}"))
        table = [["", "expected", "got", "tolerance", "verdict"]]
        for row in rows:
            if row.case == name:
                numbers = (f"{row.expected:.9g}", f"{row.got:.9g}", f"{row.tolerance:.2g}")
                table.append([row.quantity, *numbers, row.verdict])
        print("\n".join(f"  {printable(line)}" for line in aligned(table)) + "\n")
    print(f"{len(rows)} numbers, {wrong} wrong")
    return int(wrong > 0)
