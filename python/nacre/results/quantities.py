"""Quantities of results: each is declared once, at its field or its property.

Files, tables, printed forms, JSON, outputs of studies, labels and units follow from it. Its words
are the first sentence of its docstring.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache, reduce
from itertools import pairwise
from typing import Any, TypeVar, dataclass_transform

from nacre.results.values import result_class

AXIS = ("axis",)
"""Dimensions of a number along x and one along y."""
REMOVED = object()
"""In place of a value that is taken out of a state."""
CELLS, VECTOR = ("x", "y"), ("component", "x", "y")
"""Dimensions of a field, and of one with components along x and y."""


ERROR = "_discretisation"
"""Ending of the name under which such an error stands beside its output."""


@dataclass(frozen=True)
class Quantity:
    """What is known of a quantity, wherever it is shown."""

    name: str = ""
    """Name in files, outputs and JSON."""
    told: str = ""
    """What it is, where no docstring says so."""
    unit: str = ""
    """SI unit; "" where it has none."""
    line: str | None = None
    """SI unit in line contact, where it is another: loads, areas and energies are per length."""
    dims: tuple[str, ...] = ()
    """Dimensions; a number has none."""
    label: str = ""
    """Heading of its row in printed tables; "" where it is not printed."""
    path: str = ""
    """Attribute of the result, with dots; the name by default."""
    follows: bool = False
    """Whether files hold the field although it follows from the others."""
    rolling: tuple[str, str] | None = None
    """SI units in rolling, and in rolling line contact, where they are others."""
    after: str = ""
    """Quantity after which this one and the next ones stand; after all by default."""
    owner: type | None = None
    """Class that declares it."""

    @property
    def words(self) -> str:
        """What it is: the first sentence of its docstring, up to the unit."""
        if self.told or self.owner is None:
            return self.told
        attribute = (self.path or self.name).rpartition(".")[2]
        return _words(_docstrings(self.owner).get(attribute, attribute.replace("_", " ")))

    @property
    def is_field(self) -> bool:
        """Whether it has a value for each cell."""
        return self.dims[-2:] == CELLS

    def renamed(self, name: str) -> Quantity:
        """Return the quantity under another name in files."""
        return replace(self, name=name, path=self.path or self.name)

    def of(self, result: object) -> Any:
        """Return the value in a result."""
        return reduce(getattr, (self.path or self.name).split("."), result)

    def within(self, state: Mapping[str, Any]) -> Any:
        """Return the value in the state of a result, or None."""
        *places, name = (self.path or self.name).split(".")
        return reduce(lambda inner, place: inner[place], places, state).get(name)

    def put(self, state: dict[str, Any], value: object) -> None:
        """Put a value into the state of a result; `REMOVED` takes it out."""
        *places, name = (self.path or self.name).split(".")
        for place in places:
            state[place] = state = dict(state[place])
        state[name] = value
        if value is REMOVED:
            del state[name]

    def si(self, *, line: bool = False, rolls: bool = False) -> str:
        """Return the SI unit in a contact of this kind."""
        if rolls and self.rolling is not None:
            return self.rolling[line]
        return self.line if line and self.line is not None else self.unit


Kind = TypeVar("Kind")
Getter = TypeVar("Getter", bound=Callable[[Any], Any])


def quantity(
    unit: str = "",
    line: str | None = None,
    dims: tuple[str, ...] = (),
    label: str = "",
    *,
    default_factory: Any = dataclasses.MISSING,
    **options: Any,
) -> Any:
    """Declare a quantity at its field; `options` are those of `Quantity`."""
    row = Quantity(unit=unit, line=line, dims=dims, label=label, **options)
    return dataclasses.field(default_factory=default_factory, metadata={Quantity: row})


def derived(
    unit: str = "",
    line: str | None = None,
    dims: tuple[str, ...] = (),
    label: str = "",
    **options: Any,
) -> Callable[[Getter], Getter]:
    """Declare a quantity at its property, below ``@property``."""
    row = Quantity(unit=unit, line=line, dims=dims, label=label, **options)

    def declare(getter: Getter) -> Getter:
        vars(getter)["quantity"] = row
        return getter

    return declare


@dataclass_transform(frozen_default=True, field_specifiers=(quantity, dataclasses.field))
def frozen(*, eq: bool = True, repr: bool = False) -> Callable[[type[Kind]], type[Kind]]:
    """Make a class a frozen dataclass with quantities; as a rule it has its own `__repr__`."""
    return dataclass(frozen=True, repr=repr, eq=eq)


def declared(kind: type) -> list[Quantity]:
    """Return the quantities that the body of a class declares: fields, then properties."""
    inherited = {
        field
        for base in kind.__mro__[1:]
        for field in vars(base).get("__dataclass_fields__", {}).values()
    }
    rows: dict[str, Quantity] = {}
    for name, field in vars(kind).get("__dataclass_fields__", {}).items():
        if Quantity in field.metadata and field not in inherited:
            rows[name] = field.metadata[Quantity]
    for name, member in vars(kind).items():
        getter = getattr(member, "fget", None) or getattr(member, "func", None)
        if isinstance(row := getattr(getter, "quantity", None), Quantity):
            rows[name] = row
    return [
        replace(row, name=row.name or name, path=name if row.name else "", owner=kind)
        for name, row in rows.items()
    ]


@cache
def quantities_of(kind: type) -> tuple[Quantity, ...]:
    """Return the quantities of a class of results and its bases, as they are declared."""
    rows: list[Quantity] = []
    for base in reversed(kind.__mro__):
        place = len(rows)
        for row in declared(base):
            names = [quantity.name for quantity in rows]
            if row.name in names:
                rows[names.index(row.name)] = row
                continue
            place = names.index(row.after) + 1 if row.after else place
            rows.insert(place, row)
            place += 1
    return tuple(rows)


class Declared:
    """Attribute of a class of results: the quantities that it declares."""

    def __init__(self, of: Callable[[type], tuple[Quantity, ...]] = quantities_of) -> None:
        self._of = cache(of)

    def __get__(self, instance: object, owner: type) -> tuple[Quantity, ...]:
        """Return the quantities of the class."""
        return self._of(owner)


@cache
def _docstrings(kind: type) -> dict[str, str]:
    """Return the docstrings of the properties of a class, and of its fields, from its source."""
    import ast
    import inspect
    import textwrap

    docstrings = {name: member.__doc__ for name, member in vars(kind).items() if member.__doc__}
    try:
        source = textwrap.dedent(inspect.getsource(kind))
    except (OSError, TypeError):  # a program without its source
        return docstrings
    body = ast.parse(source).body[0].body  # type: ignore[attr-defined]
    for field, text in pairwise(body):
        if isinstance(field, ast.AnnAssign) and isinstance(text, ast.Expr):
            docstrings[ast.unparse(field.target)] = ast.literal_eval(text.value)
    return docstrings


def _words(docstring: str) -> str:
    """Return the first sentence of a docstring, up to a colon or the unit, else a semicolon."""
    sentence = re.split(r"\.(?:\s|$)|:\s", " ".join(docstring.split()), maxsplit=1)[0]
    words, unit, _ = sentence.partition(" [")
    words = words if unit else words.partition("; ")[0]
    words = re.sub(r",? ``.*?``", "", words)
    return words[0].lower() + words[1:] if words[1:2].islower() or words[1:2] == " " else words


PROFILE = (
    Quantity("depth", "depth; an interface is there twice, for its two sides", "m"),
    Quantity(
        "shakedown", "shear yield stress for shakedown", "Pa", label="shear yield for shakedown"
    ),
    Quantity(
        "first_yield", "shear yield stress at first yield", "Pa", label="shear yield at first yield"
    ),
    Quantity("orthogonal_shear", "range of the shear stress yz", "Pa", label="range of shear yz"),
    Quantity("DangVan", "equivalent stress of Dang Van", "Pa", label="Dang Van"),
    Quantity("Crossland", "equivalent stress of Crossland", "Pa", label="Crossland"),
    Quantity("Findley", "equivalent stress of Findley", "Pa", label="Findley"),
    Quantity("Matake", "equivalent stress of Matake", "Pa", label="Matake"),
)
"""What a material needs at each depth under a contact that rolls."""


EXTREMES_OF = {
    "LayerStress": ("", "coating_"),
    "LayerFatigue": ("", "substrate_"),
    "InterfaceStress": ("interface_",),
    "InterfaceFatigue": ("interface_",),
}
"""Classes of extremes that studies keep, and how the names of these begin there."""


def units(
    *,
    line: bool = False,
    rolls: bool = False,
    indents: bool = False,
    bears: bool = False,
    wears: bool = False,
) -> dict[str, str]:
    """Return the SI units of the quantities of a kind of result, by their names."""
    kinds = ["FrictionSolution", "Solution"]
    if indents or bears or wears:
        kinds = ["IndentSolution" if indents else "BearingSolution" if bears else "WearHistory"]
    rows = [row for kind in kinds for row in result_class(kind)._QUANTITIES]
    numbers = {row.name: unit for row in rows if (unit := row.si(line=line, rolls=rolls))}
    extremes = {
        prefix + row.name: row.unit
        for kind, prefixes in EXTREMES_OF.items()
        for row in result_class(kind)._QUANTITIES
        for prefix in prefixes
    }
    return numbers if len(kinds) == 1 else extremes | numbers
