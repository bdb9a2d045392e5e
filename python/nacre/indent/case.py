"""``nacre indent``: indentations in case files."""

from __future__ import annotations

import csv
import json
import math
import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import typer
from pydantic import Field, ValidationError, model_validator

import nacre._core as core
from nacre._case_tables import Number, Numbers, Table, Text, Words
from nacre._commands import app
from nacre._disk import replacing
from nacre._schema import Body, CaseTable, Material, WrongValue, at
from nacre.case import CaseError
from nacre.units import display_units, symbol, written

Values = Annotated[Number | Numbers, Words("a finite number, or a list of them")]


NUMBERS: dict[str, tuple[str, ...]] = {
    "sphere": ("radius",),
    "paraboloid": ("radius",),
    "cone": ("slope",),
    "flat_punch": ("radius",),
    "power": ("factor", "exponent"),
    "rounded_cone": ("slope", "radius"),
    "rounded_punch": ("flat", "radius"),
    "flat_cone": ("flat", "slope"),
    "profile": ("radii", "heights"),
    "area_function": ("coefficients", "depth"),
    "berkovich": (),
}
"""Keys of each kind of tip; a Berkovich tip may have a radius, and half_angle stands for slope."""


class TipTable(Table):
    """Tip: its kind and the numbers of that kind."""

    kind: Text = "sphere"
    radius: Number | None = None
    slope: Number | None = None
    half_angle: Number | None = None
    flat: Number | None = None
    factor: Number | None = None
    exponent: Number | None = None
    radii: Numbers | None = None
    heights: Numbers | None = None
    coefficients: Numbers | None = None
    depth: Number | None = None

    def make(self) -> core.Tip:
        """Return the tip."""
        if self.kind not in NUMBERS:
            raise ValueError(f"kind must be one of {', '.join(NUMBERS)}, got {self.kind!r}")
        given = self.model_dump(exclude={"kind"}, exclude_none=True)
        if "half_angle" in given:
            if "slope" in given:
                raise ValueError("there must be one of slope and half_angle, got both")
            given["slope"] = core.slope_of(given.pop("half_angle"))
        needed = set(NUMBERS[self.kind])
        optional = {"radius"} if self.kind == "berkovich" else set()
        if not needed <= set(given) <= needed | optional:
            keys = ", ".join(NUMBERS[self.kind]) or "no further key but radius"
            raise ValueError(f"a tip of kind {self.kind} has {keys}, got {', '.join(given)}")
        return getattr(core.Tip, self.kind)(**given)  # type: ignore[no-any-return]


class AdhesionTable(Table):
    """Adhesion."""

    kind: Literal["jkr", "dmt", "maugis"]
    work: Number
    strength: Number | None = None

    def make(self) -> core.Adhesion:
        """Return the adhesion."""
        if (self.strength is None) != (self.kind != "maugis"):
            raise ValueError("strength must be given for maugis, and for no other kind")
        given = self.model_dump(exclude={"kind"}, exclude_none=True)
        return getattr(core.Adhesion, self.kind)(**given)  # type: ignore[no-any-return]


class IndentTable(Table):
    """Exactly one of load, approach and radius."""

    load: Values | None = None
    approach: Values | None = None
    radius: Values | None = None
    control: Literal["load", "approach"] = "load"

    @model_validator(mode="after")
    def _one(self) -> IndentTable:
        if sum(v is not None for v in (self.load, self.approach, self.radius)) != 1:
            raise ValueError("must have exactly one of load, approach and radius")
        return self


class IndentCase(Table):
    """Keys and tables of a case file of ``nacre indent``."""

    units: Text = "SI"
    materials: dict[str, Material] = Field({})
    body: Body
    counterbody: Body | None = None
    tip: TipTable
    adhesion: AdhesionTable | None = None
    indent: IndentTable

    def solve(self) -> dict[str, Any]:
        """Return columns, and the pull-off where there is adhesion."""
        reader = CaseTable.model_construct(materials=self.materials)
        body = reader._body("body", self.body)
        other = self.counterbody
        counter = None if other is None else reader._body("counterbody", other)
        with at("tip"):
            tip = self.tip.make()
        with at("adhesion"):
            adhesion = None if self.adhesion is None else self.adhesion.make()
        with at("indent"):
            test = core.Indentation(body, tip, counter, adhesion=adhesion)
            asked: dict[str, Any] = self.indent.model_dump(exclude={"control"}, exclude_none=True)
            points: dict[str, Any] = {k: np.atleast_1d(v) for k, v in asked.items()}
            state = test.at(**points)
            names = ("load", "approach", "radius", "stiffness")
            found: dict[str, Any] = {n: np.atleast_1d(getattr(state, n)).tolist() for n in names}
            found["central_pressure"] = np.ravel(state.pressure(0.0)).tolist()
            if adhesion is not None:
                off = test.pull_off(self.indent.control)
                found["pull_off"] = {n: getattr(off, n) for n in names[:3]}
        return found


COLUMNS = {
    **{"load": "N", "approach": "m", "radius": "m", "stiffness": "N/m"},
    "central_pressure": "Pa",
}


def read(path: Path) -> IndentCase:
    """Return the case of a file; an unusable one is a `CaseError`."""
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        case = IndentCase.model_validate(data)
        with at("units"), display_units(case.units):
            return case
    except OSError as error:
        raise CaseError(f"{path}: {error.strerror or error}") from error
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(map(str, first["loc"]))
        raise CaseError(f"{path}: {key}: {first['msg']}") from None
    except WrongValue as error:
        raise CaseError(f"{path}: {error}") from error
    except (ValueError, RecursionError) as error:
        raise CaseError(f"{path}: not a TOML file: {error}") from error


def _said(value: float, unit: str) -> str:
    return written(value, unit, 4) if math.isfinite(value) else str(value)


def _table(found: dict[str, Any]) -> str:
    rows = [[name.replace("_", " ") for name in COLUMNS]]
    for values in zip(*(found[name] for name in COLUMNS), strict=True):
        units = COLUMNS.values()
        rows.append([_said(v, u) for v, u in zip(values, units, strict=True)])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(f"{c:>{w}}" for c, w in zip(r, widths, strict=True)) for r in rows]
    if "pull_off" in found:
        said = (f"{n} {_said(v, COLUMNS[n])}" for n, v in found["pull_off"].items())
        lines.append(f"pull-off: {', '.join(said)}")
    return "\n".join(lines)


def _finite(data: Any) -> Any:
    if isinstance(data, dict):
        return {name: _finite(value) for name, value in data.items()}
    if isinstance(data, list):
        return [_finite(value) for value in data]
    return None if isinstance(data, float) and not math.isfinite(data) else data


def _write(found: dict[str, Any], path: Path) -> None:
    """Write a CSV file after a line that says which version wrote it, whole or not at all."""
    head = [f"{name} [{symbol(unit)}]" for name, unit in COLUMNS.items()]
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        file.write(f"# source: nacre {core.__version__}\n")
        rows = csv.writer(file)
        rows.writerow(head)
        rows.writerows(zip(*(found[name] for name in COLUMNS), strict=True))


@app.command()
def indent(
    case: Annotated[Path, typer.Argument(metavar="CASE.toml", show_default=False)],
    save: Annotated[Path | None, typer.Option(help="CSV file to write.")] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON, in the units of the case.")
    ] = False,
) -> None:
    """Solve the indentation that a case file describes.

    Tables units, materials, body and counterbody are those of `nacre schema`. [tip] has kind
    (sphere, cone, ...) and its numbers; a cone has slope or half_angle, in radians. [adhesion],
    which may be left out, has kind (jkr, dmt, maugis), work and, for maugis, strength. [indent] has
    one of load, approach and radius, a number or a list, and control of the pull-off (load,
    approach).
    """
    described = read(case)
    if save is not None and save.suffix != ".csv":
        raise CaseError(f"--save must end in .csv, got {str(save)!r}")
    try:
        found = described.solve()
    except WrongValue as error:
        raise CaseError(f"{case}: {error}") from error
    with display_units(described.units):
        if as_json:
            print(json.dumps(_finite(found), indent=2))
        else:
            print(_table(found))
        if save is not None:
            _write(found, save)
