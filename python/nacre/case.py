"""Case files: a contact, and a study of it, in TOML.

There is a table for each argument of `nacre.solve`, and one for `Solution.stress_summary`;
materials have names::

    [materials]
    steel = { young = 210e9, poisson = 0.3, yield_stress = 1.5e9 }  # for margins
    dlc = { young = 420e9, poisson = 0.3, strength = 2e9 }

    [shape]
    kind = "roller"
    radius = 5e-3
    flat_length = 19.13e-3
    crown_radius = 7.5

    [body]
    substrate = "steel"
    layers = [{ material = "dlc", thickness = 40e-6 }]

    [solve]
    load = 1e3
    eccentricity = { x = 2.87e-3 }  # free to tilt along x only

    [stress]  # may be left out, or empty
    friction = 0.1

    [sweep]  # for nacre sweep
    store = "study.nc"
    parameters."materials.dlc.young" = [105e9, 210e9, 420e9]
    parameters."solve.load" = { first = 100, last = 1000, count = 10, scale = "log" }
"""

from __future__ import annotations

import copy
import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nacre._extras import extra

with extra("cli"):
    from pydantic import ValidationError

    from nacre._schema import KINDS, CaseTable, Range


class CaseError(ValueError):
    """A case file that cannot be used; the message names the key and what was expected."""


class Case:
    """A case file, read and checked.

    Parameters
    ----------
    data
        Content of the file.
    name
        Name of the case in errors.
    folder
        Folder to which its paths are relative.
    """

    def __init__(
        self, data: Mapping[str, Any], name: str = "case", folder: Path | None = None
    ) -> None:
        self.data = copy.deepcopy(dict(data))
        self.name = name
        self.folder = folder or Path()
        self._table = self._checked(self.data)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Case:
        """Return the case of a file; an unusable one is a `CaseError`."""
        path = Path(path)
        try:
            data = tomllib.loads(path.read_text(encoding="utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise CaseError(f"{path}: not a TOML file: {error}") from error
        except OSError as error:
            raise CaseError(f"{path}: {error.strerror or error}") from error
        return cls(data, str(path), path.parent)

    def arguments(self) -> dict[str, Any]:
        """Return the arguments of `nacre.solve` that the case describes."""
        try:
            return self._table.arguments(self.folder)
        except ValueError as error:
            raise CaseError(f"{self.name}: {error}") from error

    def stress(self) -> dict[str, Any] | None:
        """Return the arguments of `Solution.stress_summary`, or None without a table ``stress``."""
        asked = self._table.stress
        return None if asked is None else asked.keywords() | self._table.limits()

    def __call__(self, **values: Any) -> dict[str, Any]:
        """Return the arguments with other values at some keys, ``{"solve.load": 10.0}``."""
        data = copy.deepcopy(self.data)
        for key, value in values.items():
            table, last = self._place(data, key)
            table[last] = value
        return Case(data, self.name, self.folder).arguments()

    def study(self) -> dict[str, Any]:
        """Return the arguments of `nacre.sweep` besides the case."""
        sweep = self._table.sweep
        if sweep is None:
            raise CaseError(f"{self.name}: sweep: this table is missing")
        self.arguments()  # the case as it stands must be one
        for key in sweep.parameters:
            self._place(self.data, key)
            if key.startswith("stress.") or key.endswith((".yield_stress", ".strength")):
                message = f"{self.name}: sweep.parameters: {key!r} changes nothing in a solve"
                raise CaseError(message)
        found: dict[str, Any] = {
            "parameters": {
                key: values.numbers() if isinstance(values, Range) else values
                for key, values in sweep.parameters.items()
            }
        }
        if sweep.outputs is not None:
            found["outputs"] = sweep.outputs
        if sweep.store is not None:
            found["store"] = self.folder / sweep.store
        if self._table.stress is not None:
            found["stress"] = self._table.stress.keywords()
        return found

    def _place(self, data: Any, key: str) -> tuple[Any, Any]:
        """Return the table or list that holds a dotted key, and the last part of the key."""
        parts: list[Any] = [int(part) if part.isdigit() else part for part in key.split(".")]
        table = data
        try:
            for part in parts[:-1]:
                table = table[part]
            table[parts[-1]]
        except (LookupError, TypeError) as error:
            message = f"{self.name}: sweep.parameters: {key!r} is not a key of this case"
            raise CaseError(message) from error
        return table, parts[-1]

    def _checked(self, data: Mapping[str, Any]) -> CaseTable:
        try:
            return CaseTable.model_validate(data)
        except ValidationError as error:
            raise CaseError(f"{self.name}: {_first(error, data)}") from error


def _first(error: ValidationError, data: Any) -> str:
    """Return a message about the first error: key, expected value and value found."""
    found = error.errors(include_url=False)
    # A misspelt key is often also a missing one; the misspelt one says more.
    first = next((e for e in found if e["type"] == "extra_forbidden"), found[0])
    key = ".".join(str(part) for part in _path(first["loc"], data))
    if first["type"] == "missing":
        return f"{key}: this key is missing"
    if first["type"] == "extra_forbidden":
        return f"{key}: there is no such key"
    if first["type"].startswith("union_tag"):
        kinds = first["ctx"].get("expected_tags", KINDS)
        return f"{key}.kind: should be one of {kinds}, got {first['ctx'].get('tag')!r}"
    message = first["msg"].removeprefix("Value error, ").removeprefix("Input ")
    value = first["input"]
    got = "" if isinstance(value, dict) else f", got {value!r}"
    return f"{key}: {message[:1].lower()}{message[1:]}{got}"


def _path(location: tuple[int | str, ...], data: Any) -> list[int | str]:
    """Return a location without the names of alternatives that pydantic inserts."""
    path: list[int | str] = []
    for number, part in enumerate(location):
        last = number == len(location) - 1
        inside = part in data if isinstance(data, dict) else isinstance(data, list)
        if inside and isinstance(part, int) == isinstance(data, list):
            path.append(part)
            data = data[part] if not isinstance(part, int) or part < len(data) else None
        elif last and isinstance(data, dict) and _is_key(part):
            path.append(part)
    return path


def _is_key(part: int | str) -> bool:
    return isinstance(part, str) and part.isidentifier()
