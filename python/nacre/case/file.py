"""The case of a file: read, checked, and what it describes."""

from __future__ import annotations

import copy
import math
import os
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import nacre._core as core
from nacre._tools.extras import extra
from nacre.cards import Card, materials
from nacre.studies.outputs import CaseKind, outputs_by_name

with extra("cli"):
    from pydantic import ValidationError

    from nacre.case.bearing import BearingCase
    from nacre.case.indent import IndentCase
    from nacre.case.reference import Place, nearest, place, table_for
    from nacre.case.schema import MOST_VALUES, CaseTable, Keys, Range, WrongValue, at
    from nacre.case.typed import with_numbers

MOST_CHARACTERS = 60
"""Largest number of characters of a wrong value that an error shows."""
MATERIALS = ("substrate", "material")
"""Keys whose texts name materials."""
LONGEST = 1000
"""Largest number of characters of an error, whose keys may be long."""
LARGEST = 10_000_000
"""Largest size of a case file in bytes, which takes a few seconds to read."""
DEVICE = re.compile(r"(?i):[^\\/]*$|(^|[\\/])(con|prn|aux|nul|com\d|lpt\d)(\.[^\\/]*)?$")
"""Names of devices, drives and streams on Windows, which no file can have."""


class CaseError(ValueError):
    """A case file that cannot be used; the message names the key and what was expected."""

    __module__ = "nacre.case"

    def __init__(self, message: str) -> None:
        super().__init__(message if len(message) <= LONGEST else f"{message[:LONGEST]}...")


class Case:
    """A case file, read and checked.

    Parameters
    ----------
    data
        Content of the file; a number may be a text with its unit, "5 mm".
    name
        Name of the case in errors.
    folder
        Folder to which its paths are relative.
    """

    __module__ = "nacre.case"

    def __init__(
        self, data: Mapping[str, object], name: str = "case", folder: Path | None = None
    ) -> None:
        self.name = name
        self.folder = folder or Path()
        try:
            self._typed = copy.deepcopy(dict(data))
            self.data = with_numbers(self._typed)
            self._table = self._keys_of(self.data)
        except RecursionError:
            raise CaseError(f"{name}: tables and lists are nested too deeply") from None
        except WrongValue as error:
            raise CaseError(f"{name}: {error}") from None

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Case:
        """Return the case of a file; an unusable one is a `CaseError`."""
        path = Path(path)
        try:
            if path.exists() and not path.is_file():
                raise CaseError(f"{path}: must be a file")
            if path.stat().st_size > LARGEST:
                raise CaseError(f"{path}: must have at most {LARGEST} bytes")
            data = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        except CaseError:
            raise
        except UnicodeDecodeError as error:
            raise CaseError(f"{path}: not a TOML file: its letters must be UTF-8") from error
        except ValueError as error:
            raise CaseError(f"{path}: not a TOML file: {error}") from error
        except RecursionError:
            raise CaseError(f"{path}: tables and lists are nested too deeply") from None
        except OSError as error:
            raise CaseError(f"{path}: {error.strerror or error}") from error
        return cls(data, str(path), path.parent)

    @property
    def units(self) -> str:
        """Units of the numbers, as `nacre.display_units` takes them."""
        return self._table.units

    @property
    def signed(self) -> dict[str, str]:
        """Texts of the table report, by the words of the head of a report."""
        head = self._table.report
        return {} if head is None else {k.replace("_", " "): v for k, v in head.keywords().items()}

    def in_units(self, units: str) -> Case:
        """Return the case with its numbers in other units; texts with units stay what they are."""
        return Case({**self._typed, "units": units}, self.name, self.folder)

    @property
    def is_indentation(self) -> bool:
        """Whether the case is an indentation, with a tip, and no contact on a grid."""
        return isinstance(self._table, IndentCase)

    @property
    def kind(self) -> CaseKind:
        """What the case is: a contact, its wear, an indentation or a bearing."""
        if isinstance(self._table, BearingCase):
            return "bearing"
        if isinstance(self._table, CaseTable) and self._table.wear:
            return "wear"
        return "indent" if self.is_indentation else "contact"

    @property
    def friction(self) -> str | None:
        """Name of the table of friction, "slide" or "roll"; None without one, and of wear."""
        if not isinstance(self._table, CaseTable) or self._table.history == "wear":
            return None
        return self._table.history

    def arguments(self) -> dict[str, Any]:
        """Return the arguments that the case describes.

        They are those of `nacre.solve`, or of `nacre.wear`, or with friction of `nacre.slide` or
        `nacre.roll`; those of an indentation are of `nacre.indent.solve`, and those of a bearing
        the bearing and the keywords of its ``solve``.
        """
        table = self._table
        try:
            if isinstance(table, CaseTable):
                arguments = table.arguments(self.folder)
                if (store := arguments.get("store")) is not None:
                    arguments["store"] = self._inside("wear.store", store)
                return arguments
            assert isinstance(table, IndentCase | BearingCase)
            return table.arguments()
        except WrongValue as error:
            raise CaseError(f"{self.name}: {error}") from error

    def measured(self) -> list[Path]:
        """Return the files that the case reads: those of measured surfaces."""
        return [self.folder / path for path in _paths(self.data)]

    def cards(self) -> list[Card]:
        """Return the cards of `nacre.materials` whose numbers the case takes."""
        own: Any = self.data.get("materials", {})
        names = {str(own.get(name, name)) for name in _material_names(self.data)}
        return [card for name, card in materials.items() if name in names]

    def stress(self) -> dict[str, Any] | None:
        """Return the arguments of `Solution.stress_summary`, or None without a table ``stress``."""
        table = self._table
        if not isinstance(table, CaseTable) or table.stress is None:
            return None
        keywords = table.stress.keywords() | table.limits(table.stress, "yield_stress", "strength")
        return self._without_friction(keywords | table.bonds(table.stress))

    def fatigue(self) -> dict[str, Any] | None:
        """Return the arguments of `nacre.fatigue.assess`, or None without a table ``fatigue``."""
        table = self._table
        if not isinstance(table, CaseTable) or table.fatigue is None:
            return None
        try:
            keywords = table.fatigue.keywords() | table.limits(table.fatigue, "shear_yield")
        except WrongValue as error:
            raise CaseError(f"{self.name}: {error}") from error
        return self._without_friction(keywords)

    def conductance(self) -> dict[str, Any] | None:
        """Return the arguments of `Solution.conductance`, or None without a table for it."""
        table = self._table
        try:
            return table.conductors() if isinstance(table, CaseTable) else None
        except WrongValue as error:
            raise CaseError(f"{self.name}: {error}") from error

    def _without_friction(self, keywords: dict[str, object]) -> dict[str, object]:
        """Return keywords without those of friction where the tractions are known."""
        left = () if self.friction is None else ("friction", "direction")
        return {name: value for name, value in keywords.items() if name not in left}

    def required_distance(self) -> float | None:
        """Return the distance that a coat must survive, or None without one."""
        wear = self._table.wear if isinstance(self._table, CaseTable) else None
        return None if wear is None else wear.required_distance

    def life(self) -> dict[str, Any] | None:
        """Return the arguments of `BearingSolution.life`, or None without a table for it."""
        return self._table.life() if isinstance(self._table, BearingCase) else None

    def film(self) -> dict[str, Any] | None:
        """Return a ring and the arguments of `film_thickness`, or None without a table for it."""
        return self._table.film() if isinstance(self._table, BearingCase) else None

    def __call__(self, **values: object) -> dict[str, Any]:
        """Return the arguments with other values at some keys, ``{"solve.load": 10.0}``."""
        data = self.data
        # A material is changed by its name before it is changed in one place alone.
        for key in sorted(values, key=lambda key: not key.startswith("materials.")):
            data = core.with_value(self._with_key(data, key), key, values[key])
        return Case(data, self.name, self.folder).arguments()

    @property
    def has_sweep(self) -> bool:
        """Whether the case has a table of a study."""
        return self._table.sweep is not None

    def study(self, store: Path | None = None) -> dict[str, Any]:
        """Return the arguments of `nacre.sweep` besides the case, with another store if given.

        The store of the case must lie in the folder of the case.
        """
        sweep = self._table.sweep
        if sweep is None:
            raise CaseError(f"{self.name}: sweep: this table is missing")
        if "store" in self.arguments():  # the case as it stands must be one
            raise CaseError(f"{self.name}: wear.store: must not be given beside a study")
        for key in sweep.parameters:
            self._with_key(self.data, key)
            if (
                not key.startswith(self._table.solved)
                or key.startswith(("bearing.film.", "bearing.oil."))
                or key.endswith((".yield_stress", ".strength", ".shear_yield"))
                or ".bond_strength." in key
                or key == "wear.required_distance"
            ):
                message = (
                    f"{self.name}: sweep.parameters: {_short_repr(key)} changes nothing in a solve"
                )
                raise CaseError(message)
        arguments: dict[str, Any] = {
            "parameters": {
                key: values.numbers() if isinstance(values, Range) else values
                for key, values in sweep.parameters.items()
            }
        }
        if sweep.outputs is not None:
            try:
                with at("sweep"):
                    outputs_by_name(sweep.outputs, self.kind)
            except WrongValue as error:
                raise CaseError(f"{self.name}: {error}") from error
            arguments["outputs"] = sweep.outputs
        count = math.prod(map(len, arguments["parameters"].values()))
        if count > MOST_VALUES:
            raise CaseError(
                f"{self.name}: sweep.parameters: must make at most {MOST_VALUES} cases, got {count}"
            )
        if store is None and sweep.store is not None:
            store = self._inside("sweep.store", sweep.store)
        if store is not None:
            arguments["store"] = store
        if (stress := self.stress()) is not None:
            arguments["stress"] = stress
        if (fatigue := self.fatigue()) is not None:
            arguments["fatigue"] = fatigue
        if (conductance := self.conductance()) is not None:
            conductance.pop("required_resistance", None)
            arguments["conductance"] = conductance
        return arguments

    def _inside(self, key: str, store: str) -> Path:
        """Return the path of a store, which must be in the folder of the case, as its journal."""
        path, folder = self.folder / store, self.folder.resolve()
        try:
            ends = [file.resolve() for file in (path, path.with_suffix(".journal"))]
        except (OSError, RuntimeError, ValueError) as error:  # a name that no file can have
            raise CaseError(f"{self.name}: {key}: {error}") from error
        if DEVICE.search(store):
            raise CaseError(
                f"{self.name}: {key}: must be a name that Windows allows for a file, got "
                f"{_short_repr(store)}"
            )
        if not all(end.is_relative_to(folder) for end in ends):
            hint = "; nacre sweep --store takes a file anywhere" if key == "sweep.store" else ""
            raise CaseError(
                f"{self.name}: {key}: must be in the folder of the case, got "
                f"{_short_repr(store)}{hint}"
            )
        return path

    def _with_key(self, data: dict[str, Any], key: str) -> dict[str, Any]:
        """Return tables of the case that have a value at a key, or raise an error.

        A layer is named by its number, ``body.layers[0]`` or ``body.layers.0``, or by its name. A
        body whose material has a name gets its own copy where the key is a number of the material.
        """
        place = key.rpartition(".")[0]
        try:
            if place.endswith(MATERIALS) and isinstance(name := core.at(data, place), str):
                material = data.get("materials", {}).get(name)
                data = core.with_value(data, place, copy.deepcopy(material))
            core.at(data, key)
            return data
        except LookupError as error:
            solved_tables = {t: self.data[t] for t in self._table.solved if t in self.data}
            keys = ", ".join(nearest(key, [path for path, _ in core.numbers(solved_tables)])[:3])
            raise CaseError(
                f"{self.name}: sweep.parameters: {_short_repr(key)} is not a key of this case; the "
                f"nearest are {keys}"
            ) from error

    def _keys_of(self, data: Mapping[str, object]) -> Keys:
        try:
            return table_for(data).model_validate(data)
        except ValidationError as error:
            raise CaseError(f"{self.name}: {_first(error, data)}") from None


def _paths(data: object) -> Iterator[str]:
    """Yield the paths in the tables of shapes."""
    if isinstance(data, Mapping):
        if data.get("kind") == "height_map":
            yield data["path"]
        yield from (path for value in data.values() for path in _paths(value))
    elif isinstance(data, list):
        yield from (path for value in data for path in _paths(value))


def _material_names(data: object) -> Iterator[str]:
    """Yield the names of materials in the tables of bodies and layers."""
    if isinstance(data, Mapping):
        yield from (name for key in MATERIALS if isinstance(name := data.get(key), str))
        yield from (name for value in data.values() for name in _material_names(value))
    elif isinstance(data, list):
        yield from (name for value in data for name in _material_names(value))


def _first(error: ValidationError, data: object) -> str:
    """Return a message about the first error: key, expected value and value found."""
    errors = error.errors(include_url=False)
    # A misspelt key is often also a missing one; the misspelt one says more. Of the errors of
    # alternatives, the innermost belongs to the one that was meant.
    places = [(entry, place(data, entry["loc"])) for entry in errors]
    misspelt = [pair for pair in places if pair[0]["type"] == "extra_forbidden"]
    first, here = misspelt[0] if misspelt else max(places, key=lambda pair: len(pair[1].path))
    kind = first["type"]
    if kind == "extra_forbidden":
        return _no_key(here, str(first["loc"][-1]))
    if kind == "missing":
        return f"{here.key}: this key is missing"
    if kind == "recursion_loop":
        return f"{'.'.join(map(str, here.path[:2]))}: tables and lists are nested too deeply"
    if kind.startswith("union_tag") and isinstance(here.value, dict):
        got = here.value.get("kind")
        kinds = ", ".join(map(repr, nearest(str(got), here.kinds())))
        problem = f"got {_short_repr(got)}" if "kind" in here.value else "this key is missing"
        return f"{here.key}.kind: must be one of {kinds}; {problem}"
    if kind == "value_error":
        return f"{here.key}: {first['ctx']['error']}".removeprefix(": ")  # of the whole file
    return f"{here.key}: must be {here.words()}, got {_short_repr(here.value)}"


def _no_key(here: Place, name: str) -> str:
    """Return a message about a key that a table cannot have, with the keys that it can have."""
    key = f"{here.key}.{name}".removeprefix(".")
    return f"{key}: there is no such key; the keys here are {', '.join(nearest(name, here.keys()))}"


def _short_repr(value: object) -> str:
    """Return a value as an error shows it."""
    text = repr(value)
    return text if len(text) <= MOST_CHARACTERS else f"{text[:MOST_CHARACTERS]}..."
