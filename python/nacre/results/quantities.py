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
        return _words(_docstrings(self.owner).get(self.name, self.name.replace("_", " ")))

    @property
    def is_field(self) -> bool:
        """Whether it has a value for each cell."""
        return self.dims[-2:] == CELLS

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
    **options: Any,
) -> Any:
    """Declare a quantity at its field; `options` are those of `Quantity`."""
    row = Quantity(unit=unit, line=line, dims=dims, label=label, **options)
    return dataclasses.field(metadata={Quantity: row})


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
def frozen(*, eq: bool = True) -> Callable[[type[Kind]], type[Kind]]:
    """Make a class a frozen dataclass with quantities, which has its own `__repr__`."""
    return dataclass(frozen=True, repr=False, eq=eq)


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
    return [replace(row, name=name, owner=kind) for name, row in rows.items()]


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

    def __get__(self, instance: object, owner: type) -> tuple[Quantity, ...]:
        """Return the quantities of the class."""
        return quantities_of(owner)


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
    """Return the first sentence of a docstring, up to the unit, or to a colon or semicolon."""
    sentence = re.split(r"\.(?:\s|$)", " ".join(docstring.split()), maxsplit=1)[0]
    words, unit, _ = sentence.partition(" [")
    words = words if unit else re.split(r"[:;] ", words, maxsplit=1)[0]
    words = re.sub(r",? ``.*?``", "", words)
    return words[0].lower() + words[1:] if words[1:2].islower() or words[1:2] == " " else words


CONTACT = (
    Quantity("load", "normal force", "N", "N/m", label="load"),
    Quantity("eccentricity", "point where the force acts", "m", dims=AXIS, label="acts at"),
    Quantity("moment", "first moments of the pressure", "N m", "N", AXIS, "moment"),
    Quantity("approach", "approach of the origin", "m", label="approach"),
    Quantity("tilt", "slopes", dims=AXIS, label="tilt"),
    Quantity("peak_pressure", "largest pressure of a cell", "Pa", label="peak pressure"),
    Quantity("peak_position", "centre of that cell", "m", dims=AXIS, label="at"),
    Quantity("contact_extent", "ends of the contact", "m", dims=("axis", "end"), label="contact"),
    Quantity("contact_area", "area in contact", "m²", "m", label="area"),
    Quantity("contact_share", "share of the grid in contact", label="share"),
    Quantity("central_pressure", "pressure at the origin", "Pa"),
    Quantity("elastic_energy", "elastic energy of the bodies", "J", "J/m"),
    Quantity("plastic_work", "energy that the permanent indentation has taken", "J", "J/m"),
    Quantity("pressure", "pressure", "Pa", dims=CELLS),
    Quantity("gap", "gap; infinite where the shape cannot touch", "m", dims=CELLS),
    Quantity("displacement", "normal displacement of both bodies together", "m", dims=CELLS),
    Quantity(
        "hardness", "largest pressure that the surfaces can carry", "Pa", None, CELLS, "hardness"
    ),
    Quantity("indentation", "permanent indentation", "m", None, CELLS, "indentation"),
    Quantity(
        "compliance",
        "compliance of springs between the surfaces",
        "m/Pa",
        None,
        CELLS,
        "springs",
    ),
    Quantity("in_contact", "whether a cell is in contact", dims=CELLS),
    Quantity("line_load", "force per length along x", "N/m", dims=("x",), follows=True),
    Quantity(
        "coefficients",
        "influence coefficients that the contact was given",
        "m/Pa",
        dims=("offset_x", "offset_y"),
    ),
    Quantity("x", "x of the cell centre", "m", dims=("x",)),
    Quantity("y", "y of the cell centre", "m", dims=("y",)),
)
"""Quantities of a normal contact, numbers first, in the order in which they are printed."""

WEAR = (
    Quantity("distance", "sliding distance, cycles or passes", "m", dims=("step",)),
    Quantity("volume", "volume removed", "m³", "m²", ("step", "member")),
    Quantity("deepest", "largest depth removed", "m", dims=("step", "member")),
    Quantity("peak_pressure", "largest pressure of a cell", "Pa", dims=("step",)),
    Quantity("contact_area", "area in contact", "m²", "m", ("step",)),
    Quantity("approach", "approach of the origin", "m", dims=("step",)),
    Quantity("load", "normal force", "N", "N/m", ("step",)),
    Quantity("depth", "last depth removed from the body", "m", dims=CELLS),
    Quantity("counter_depth", "last depth removed from the counterbody", "m", dims=CELLS),
    Quantity("pressure", "last pressure", "Pa", dims=CELLS),
)
"""Quantities of a history of wear."""
WORN = (
    Quantity("life", "distance after which the first layer is through", "m"),
    Quantity("worn_volume", "volume removed from both bodies", "m³", "m²"),
    *(replace(row, dims=()) for row in WEAR if row.dims[:1] == ("step",) and row.name != "volume"),
)
"""Numbers of a history of wear: those of its end."""

FRICTION = (
    Quantity("force", "force of the tractions on the body", "N", "N/m", AXIS, "force"),
    Quantity("torque", "torque of the tractions about the origin", "N m", "N", label="torque"),
    Quantity("shift", "shift of the counterbody over the body", "m", dims=AXIS, label="shift"),
    Quantity("twist", "twist of the counterbody over the body", "rad", label="twist"),
    Quantity("creepage", "creepages along and across", dims=AXIS, label="creepage"),
    Quantity("spin", "spin", "1/m", label="spin"),
    Quantity(
        "dissipated",
        "energy that friction dissipates",
        "J",
        "J/m",
        label="dissipated",
        rolling=("J/m", "J/m²"),
    ),
    Quantity("tangential_energy", "elastic energy that tractions add", "J", "J/m"),
    Quantity("elastic_energy", "elastic energy of pressure and tractions", "J", "J/m"),
    Quantity("stick_share", "share of the contact that sticks"),
    Quantity("convolutions", "convolutions of the solve", path="report.convolutions"),
    Quantity("traction", "traction on the body", "Pa", dims=VECTOR),
    Quantity("displacement", "displacement of the body less counterbody", "m", dims=VECTOR),
    Quantity(
        "slip", "slip in the step; over the way in rolling", "m", None, VECTOR, rolling=("", "")
    ),
    Quantity("stick", "whether a cell sticks", dims=CELLS, follows=True),
    Quantity("friction", "coefficient of friction", dims=CELLS),
)
"""Quantities of a contact with friction, numbers first, in the order in which they are printed."""

NORMAL = {name: name for name in ("load", "approach", "pressure", "gap", "coefficients")}
NORMAL |= {"displacement": "normal_displacement", "x": "x", "y": "y"}
"""Quantities of the normal contact that one with friction has too, and their names there."""
WITH_FRICTION = (
    *(
        replace(row, name=NORMAL[row.name], path=f"normal.{row.name}", label="")
        for row in CONTACT
        if row.name in NORMAL
    ),
    *FRICTION,
)
"""All quantities of a contact with friction."""

STRESS = tuple(
    Quantity(name, words, "Pa")
    for name, words in {
        "von_mises": "largest von Mises stress",
        "tension": "largest principal stress",
        "max_shear": "largest shear stress",
        "coating_tension": "largest principal stress in a layer",
        "interface_shear": "largest shear stress at an interface",
        "interface_tension": "largest tension at an interface",
    }.items()
)
"""Extremes of the stress that studies keep."""
ASSESSMENT = (
    Quantity("shakedown", "largest shear yield stress that a layer needs to shake down", "Pa"),
    Quantity("substrate_shakedown", "shear yield stress that the substrate needs", "Pa"),
    Quantity("orthogonal_shear", "largest range of the shear stress yz", "Pa"),
    Quantity("interface_shear_range", "largest range of the shear at an interface", "Pa"),
    Quantity("shakedown_safety_factor", "smallest safety factor of shakedown"),
    Quantity("first_yield_safety_factor", "smallest safety factor of first yield"),
    Quantity("fatigue_safety_factor", "smallest safety factor of the criteria of fatigue"),
)
"""Numbers of fatigue that studies keep."""

EXTREME_UNITS = dict.fromkeys(("depth", "depths"), "m") | dict.fromkeys(
    (
        *("von_mises", "max_shear", "tension", "compression", "shear", "jump", "uncertainty"),
        *("shakedown", "first_yield", "orthogonal_shear", "criteria", "shear_range"),
    ),
    "Pa",
)
"""SI units of fields of a layer or an interface in summaries of stress and fatigue."""

EXTREMES = (
    Quantity("part", "layer or interface"),
    Quantity("quantity", "name of the extreme"),
    Quantity("value", "largest value", "Pa"),
    Quantity("uncertainty", "error due to the size of the cells, estimated", "Pa"),
    Quantity("x", "x of the place", "m"),
    Quantity("y", "y of the place", "m"),
    Quantity("z", "depth of the place", "m"),
    Quantity("safety_factor", "yield stress or strength over the value"),
)
"""Columns of the table of a stress summary."""

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

FATIGUE = (
    Quantity("part", "layer or interface"),
    Quantity("quantity", "name of the value"),
    Quantity("value", "value", "Pa"),
    Quantity("x", "x of the place", "m"),
    Quantity("y", "y of the place", "m"),
    Quantity("z", "depth of the place", "m"),
    Quantity("safety_factor", "yield stress or limit over the value"),
)
"""Columns of the table of a summary of fatigue."""

SHAKEDOWN = (
    Quantity("layer", "layer"),
    Quantity("friction", "coefficient of friction"),
    Quantity("limits", "peak pressure over shear yield stress, for shakedown"),
    Quantity("first_yield", "peak pressure over shear yield stress, at first yield"),
    Quantity("depths", "depth that decides the shakedown", "m"),
)
"""Columns of the table of a shakedown map."""

INDENT = (
    Quantity("load", "load, below 0 where the tip is pulled", "N", label="load"),
    Quantity("approach", "approach", "m", label="approach"),
    Quantity("radius", "contact radius", "m", label="radius"),
    Quantity("stiffness", "stiffness of this contact area", "N/m", label="stiffness"),
    Quantity("outer_radius", "radius up to which the surfaces attract each other", "m"),
    Quantity("central_pressure", "pressure on the axis", "Pa", label="central pressure"),
    Quantity("pull_off_load", "load of the last stable contact of a tip that is pulled", "N"),
    Quantity("pull_off_approach", "approach of that contact", "m"),
    Quantity("pull_off_radius", "radius of that contact", "m"),
)
"""Quantities of an indentation."""

FIT = (
    Quantity("depth", "depth as measured", "m"),
    Quantity("force", "force as measured", "N"),
    Quantity("load", "load of the model", "N"),
    Quantity("approach", "depth without nuisances", "m"),
    Quantity("residual", "residual"),
)
"""Quantities at the points of the curves of a fit."""

PER_CONTACT, PER_LAMINA = ("element", "ring"), ("element", "ring", "lamina")
"""Dimensions of numbers of each contact of a bearing, and of its laminae."""
BEARING = (
    Quantity("displacement", "displacement of the ring", "m", None, ("direction",), "displacement"),
    Quantity("tilt", "slopes of the inner ring", dims=AXIS, label="tilt"),
    Quantity("force", "force on the inner ring", "N", None, ("direction",), "force"),
    Quantity("moment", "moment on the inner ring", "N m", dims=AXIS, label="moment"),
    Quantity("largest_load", "largest force of a contact", "N", label="largest load"),
    Quantity("peak_pressure", "largest pressure", "Pa", label="peak pressure"),
    Quantity("edge_pressure", "largest pressure in outer tenths", "Pa", label="edge pressure"),
    Quantity("reference_life", "life of ISO/TS 16281", "million revolutions"),
    Quantity("loaded", "number of loaded elements"),
    Quantity("cage_speed", "speed of the elements about the axis", "rad/s", label="cage speed"),
    Quantity("angles", "angles of the elements", "rad", dims=("element",)),
    Quantity("approaches", "approaches of the contacts", "m", dims=PER_CONTACT),
    Quantity("loads", "forces of the contacts", "N", None, PER_CONTACT, "load"),
    Quantity("tilts", "slopes of the elements to the rings", "", None, PER_CONTACT, "tilt"),
    Quantity("moments", "first moments of the pressure", "N m", dims=PER_CONTACT),
    Quantity("peak_pressures", "largest pressures", "Pa", None, PER_CONTACT, "peak pressure"),
    Quantity("edge_pressures", "pressures at the edges", "Pa", None, PER_CONTACT, "edge pressure"),
    Quantity("contact_angles", "contact angles", "rad", dims=PER_CONTACT),
    Quantity("lamina_loads", "loads of laminae", "N", dims=PER_LAMINA),
    Quantity("lamina_pressures", "largest pressures of laminae", "Pa", dims=PER_LAMINA),
)
"""Quantities of a bearing: of its rings, and of each element."""


def units(
    *,
    line: bool = False,
    rolls: bool = False,
    indents: bool = False,
    bears: bool = False,
    wears: bool = False,
) -> dict[str, str]:
    """Return the SI units of the quantities of a kind of result, by their names."""
    contact = (*FRICTION, *CONTACT, *STRESS, *ASSESSMENT)
    rows = INDENT if indents else BEARING if bears else WORN if wears else contact
    return {row.name: unit for row in rows if (unit := row.si(line=line, rolls=rolls))}
