"""The schema of case files: one class for each table, with the words of its reference."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, Union

import numpy as np
from pydantic import Field, create_model, field_validator, model_validator

import nacre
from nacre._core import Free, Rigid
from nacre._tools.notices import warn
from nacre._tools.typing import Member
from nacre._tools.units import System
from nacre.cards import Card, unknown
from nacre.case.friction import SHARED, Roll, Slide
from nacre.case.shapes import AnyShape
from nacre.case.tables import (
    TWO,
    Count,
    Counts,
    Flags,
    Number,
    Pair,
    Table,
    from_signature,
    needed,
    parameter_texts,
    with_words,
)
from nacre.case.wear import Wear, numbers_by_layer
from nacre.studies.outputs import OUTPUTS

CONSTANTS = parameter_texts(nacre.Elastic)
SOLVE = parameter_texts(nacre.solve)
FATIGUE = parameter_texts(nacre.fatigue.assess)
CONDUCTANCE = parameter_texts(nacre.Solution.conductance)


class Material(Table):
    """An elastic material, with limits that stresses are compared with."""

    young: Number = Field(description=CONSTANTS["young"])
    poisson: Number = Field(description=CONSTANTS["poisson"])
    yield_stress: Number | None = Field(
        None, description="Yield stress [Pa], for safety factors of the von Mises stress."
    )
    strength: Number | None = Field(
        None, description="Tensile strength [Pa], for safety factors of the tension."
    )
    shear_yield: Number | None = Field(
        None, description="Yield stress in shear [Pa], for safety factors of shakedown."
    )

    def make(self) -> nacre.Elastic:
        """Return the elastic constants."""
        return nacre.Elastic(self.young, self.poisson)


AnyMaterial = Annotated[
    str | Material, with_words("the name of a material, or a table with young and poisson")
]


def material_of(name: str, units: str) -> Material:
    """Return the numbers of a card of `nacre.materials` in the units of a case.

    A warning says which value of a coating's range is taken.
    """
    card = nacre.materials[name]
    if card.kind == "coating":
        young = card.numbers["young"]
        warn(f"{name} has Young's modulus {young}")
    numbers = card._scaled(System(units).unit("Pa")[0]).numbers
    return Material(**{k: n.value for k, n in numbers.items() if k in Material.model_fields})


@from_signature(nacre.Spring)
class Spring(Table):
    """Springs between the two sides of an interface."""

    def make(self) -> nacre.Spring:
        """Return the springs."""
        return nacre.Spring(**self.keywords())


AnyInterface = Annotated[
    Literal["bonded", "frictionless"] | Spring,
    with_words('"bonded", "frictionless", or a table with normal and tangential'),
]


class Bond(Table):
    """What an interface bears, for the verdict on stresses."""

    shear: Number | None = Field(None, description="Shear strength [Pa].")
    tension: Number | None = Field(None, description="Tensile strength [Pa].")


@from_signature(nacre.Layer, material=AnyMaterial, interface=AnyInterface, name=str)
class Layer(Table):
    """A layer, the interface below it, and the name that results show."""

    bond_strength: Bond | None = Field(
        None, description="Shear and tension that the interface below it bears [Pa]."
    )
    if TYPE_CHECKING:
        material: str | Material
        interface: str | Spring
        name: str | None


Ends = Annotated[
    list[float], TWO, with_words("a pair of numbers, or of -inf and inf where the body has no end")
]
MOST_LAYERS = 1000
"""Largest number of layers: the time of a contact grows with it."""


class Body(Table):
    """A half-space: a substrate, and layers from the surface down; it may end along x."""

    substrate: AnyMaterial = Field(
        description='Material below the layers; "rigid" is a rigid base, and "free" none: the '
        "layers are a plate."
    )
    layers: Annotated[list[Layer], Field(max_length=MOST_LAYERS)] = Field(
        [], description="Layers from the surface down; a line [[body.layers]] begins each, too."
    )
    ends: Ends | None = Field(
        None,
        description="Coordinates x of free ends [m], the lower one first; -inf or inf where the "
        "body has no end, the default on both sides. Interfaces must then be bonded.",
    )


AREA, STRIPS = needed(nacre.Grid), needed(nacre.Grid.line)
"""Keys that the grid of an area and that of a line contact need."""


@from_signature(nacre.Grid.line, cells=Count | None, width=Number | None)
@from_signature(nacre.Grid, shape=Counts | None, size=Pair | None, periodic=Flags)
class Grid(Table):
    """Cells of an area, by shape and size; or strips of a line contact, by cells and width."""

    center: Number | Pair | None = Field(
        None, description="Centre [m]: a pair for an area, a number for a line. By default 0."
    )

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        keys = {name for name, value in self if value is not None}
        if (keys & AREA, keys & STRIPS) not in ((AREA, set()), (set(), STRIPS)):
            raise ValueError("must have shape and size or, for a line contact, cells and width")
        if "periodic" in keys and keys >= STRIPS:
            raise ValueError("periodic must not be given for a line contact")
        if self.center is not None and isinstance(self.center, list) != (keys >= AREA):
            requirement = "a pair of numbers" if keys >= AREA else "a number for a line contact"
            raise ValueError(f"center must be {requirement}, got {self.center!r}")
        return self

    def make(self) -> nacre.Grid:
        """Return the grid."""
        keywords = {name: value for name, value in self.keywords().items() if value is not None}
        return (nacre.Grid if keywords.keys() >= AREA else nacre.Grid.line)(**keywords)


@from_signature(nacre.solve, {"check"})  # a case is always checked
class Solve(Table):
    """The keywords of `nacre.solve`: exactly one of load and approach, and any of the others."""


class OfBody(Table):
    """Keywords of what is computed in one body."""

    if TYPE_CHECKING:
        body: Member
        friction: float

    def keywords(self) -> dict[str, Any]:
        """Return the keys that were given, the body and the friction, as keywords."""
        return {"body": self.body, "friction": self.friction} | super().keywords()


@from_signature(nacre.Solution.stress_summary, SHARED, parameter_texts(nacre.Solution.stress))
class Stress(OfBody):
    """The stresses that are printed and kept, as `Solution.stress_summary` has them."""


AnyConductivity = Annotated[
    float | dict[str, float],
    with_words('a number or inf, or a table of them by layer or material and "substrate"'),
]
CONDUCTIVITY = (
    "Conductivity of the {} [W/(m K), S/m]. Keys of a table are the layers, by number, name or "
    'material, and the "substrate". inf is a body at one temperature or voltage throughout.'
)


class Conductance(Table):
    """Resistance of the contact to heat or current, as `Solution.conductance` has it."""

    conductivity: AnyConductivity = Field(description=CONDUCTIVITY.format("body"))
    counter_conductivity: AnyConductivity = Field(
        description=CONDUCTIVITY.format("counterbody, or of the rigid shape")
    )
    film: Number = Field(0.0, description="Resistance per area of a film [m² K/W, Ω m²].")
    kind: Literal["thermal", "electrical"] = Field("thermal", description=CONDUCTANCE["kind"])
    required_resistance: Number | None = Field(
        None, description="Largest resistance [K/W, Ω], for the verdict."
    )


def _criterion(kind: str, maker: Any) -> type[Any]:
    """Return the table of a criterion of fatigue, whose limits must both be given."""
    descriptions = parameter_texts(maker)
    fields: dict[str, Any] = {
        "kind": (Literal[kind], Field(description="Kind of the criterion.")),
        **{
            name: (Number, Field(description=descriptions[name])) for name in ("bending", "torsion")
        },
    }
    title = f"{maker.__name__}Table"
    table: type[Any] = create_model(title, __base__=Table, __doc__=maker.__doc__, **fields)
    return table


CRITERIA = {kind: _criterion(kind, maker) for kind, maker in nacre.fatigue.CRITERIA.items()}
"""Tables of the criteria of fatigue, by kind."""

if TYPE_CHECKING:
    AnyCriterion = Table
else:
    AnyCriterion = Annotated[Union[tuple(CRITERIA.values())], Field(discriminator="kind")]  # noqa: UP007


@from_signature(nacre.fatigue.assess, SHARED)
class Fatigue(OfBody):
    """Shakedown and fatigue in steady rolling, as `nacre.fatigue.assess` has them."""

    criteria: list[AnyCriterion] = Field([], description=FATIGUE["criteria"])

    def keywords(self) -> dict[str, Any]:
        """Return the keywords."""
        arguments = super().keywords()
        criteria = []
        for number, criterion in enumerate(self.criteria):
            with at(f"fatigue.criteria[{number}]"):
                limits: Any = criterion
                make = nacre.fatigue.CRITERIA[limits.kind]
                criteria.append(make(bending=limits.bending, torsion=limits.torsion))
        return arguments | {"criteria": tuple(criteria)}


MOST_VALUES = 100_000
"""Largest number of cases of a study, so that a slip of the pen does not fill the memory."""


class Range(Table):
    """Evenly spaced values, ends included."""

    first: Number = Field(description="First value.")
    last: Number = Field(description="Last value.")
    count: Count = Field(description=f"Number of values, at most {MOST_VALUES}.")
    scale: Literal["linear", "log"] = Field(
        "linear", description="Whether steps or ratios are the same."
    )

    @model_validator(mode="after")
    def _logarithms_exist(self) -> Range:
        if self.scale == "log" and min(self.first, self.last) <= 0:
            raise ValueError("first and last must be above 0 on a logarithmic scale")
        if self.count > MOST_VALUES:
            raise ValueError(f"count must be at most {MOST_VALUES}, got {self.count}")
        return self

    def numbers(self) -> list[float]:
        """Return the values."""
        make = np.geomspace if self.scale == "log" else np.linspace
        return [float(value) for value in make(self.first, self.last, self.count)]


Values = Annotated[
    Range | Annotated[list[object], Field(min_length=1)],
    with_words("a list of values, or a table with first, last and count"),
]


class Sweep(Table):
    """A study, for ``nacre sweep``: every combination of values at some keys of the case."""

    parameters: Annotated[
        dict[str, Values], with_words("a table of lists, or of tables with first, last and count")
    ] = Field(
        description='Values by key, such as parameters."body.layers[0].thickness" = [1e-6, 2e-6].'
    )
    outputs: list[str] | None = Field(
        None,
        description="Numbers that are kept of each solution, as `nacre.sweep` has them; by default "
        f"{', '.join(OUTPUTS)}.",
    )
    store: str | None = Field(
        None, description="File for the study, .nc, in the folder of the case or below."
    )


class Head(Table):
    """What the head of a report says of the case; ``--save FILE.html`` writes it."""

    project: str | None = Field(None, description="Project.")
    part: str | None = Field(None, description="Part, or its drawing.")
    load_case: str | None = Field(None, description="Load case.")
    drawn_by: str | None = Field(None, description="Who made the calculation.")
    checked_by: str | None = Field(None, description="Who checked it.")


class Keys(Table):
    """Keys that all case files have: units, materials, a study, and the head of a report."""

    solved: ClassVar[tuple[str, ...]] = ()
    """Tables that describe a solve, whose values a study can change."""

    units: str = Field(
        "SI",
        description="Units of force, length and stress of all numbers in the file, and of what is "
        'printed: "SI" is "N-m-Pa"; "N-mm-MPa" and others must be consistent.',
    )
    materials: Annotated[dict[str, AnyMaterial], with_words("a table of materials")] = Field(
        {},
        description="Materials by name: tables, or names of `nacre.materials`, such as "
        '"100Cr6", which stand in other places, too.',
    )
    sweep: Sweep | None = Field(None, description="A study of the case.")
    report: Head | None = Field(None, description="Head of the report of the case.")

    @field_validator("units")
    @classmethod
    def _consistent(cls, units: str) -> str:
        System(units)
        return units

    def _body(self, name: str, body: Body) -> nacre.HalfSpace:
        with at(f"{name}.substrate"):
            base = self._base(body)
            substrate = self._material(body.substrate) if base is None else base
        layers = []
        for number, layer in enumerate(body.layers):
            with at(f"{name}.layers[{number}]"):
                arguments = layer.keywords()
                arguments.pop("bond_strength", None)  # of stresses
                with at("material"):
                    arguments["material"] = self._material(layer.material)
                with at("interface"):
                    if isinstance(layer.interface, Spring):
                        arguments["interface"] = layer.interface.make()
                layers.append(nacre.Layer(**arguments))
        ends = None if body.ends is None else (body.ends[0], body.ends[1])
        with at(name):
            return nacre.HalfSpace(substrate, layers, ends=ends)

    def _base(self, body: Body) -> Rigid | Free | None:
        """Return the base that the substrate names, or None if that is a material."""
        substrate = body.substrate
        if not isinstance(substrate, str) or substrate in self.materials:
            return None
        bases: dict[str, Rigid | Free] = {"rigid": nacre.RIGID, "free": nacre.FREE}
        return bases.get(substrate)

    def _material(self, material: str | Material) -> nacre.Elastic:
        if isinstance(material, str):
            known = self._material_table(material)
            if material not in self.materials:
                return known.make()
            with at(f"materials.{material}"):
                return known.make()
        return material.make()

    def _material_table(self, material: str | Material) -> Material:
        """Return the table of a material: its own, that of its name here, or that of a card."""
        if not isinstance(material, str):
            return material
        named = self.materials.get(material, material)
        if isinstance(named, Material):
            return named
        if named in nacre.materials:
            return material_of(named, self.units)
        if named is not material:
            with at(f"materials.{material}"):
                raise ValueError(unknown(named, nacre.materials))
        known = ", ".join(self.materials) or "none"
        hint = unknown(material, nacre.materials).partition("; ")[2]
        message = f"must be one of the materials ({known}), got {material!r}"
        raise ValueError(f"{message}; {hint} in nacre.materials" if hint else message)


class Bodies(Keys):
    """Keys of case files of contacts and indentations, too: bodies."""

    body: Body = Field(description="Body that the shape or the tip is pressed into.")
    counterbody: Body | None = Field(
        None, description="Body of the shape or the tip; rigid by default."
    )

    def bodies(self) -> dict[str, Any]:
        """Return the bodies by name."""
        members = (("body", self.body), ("counterbody", self.counterbody))
        return {name: self._body(name, body) for name, body in members if body is not None}


class CaseTable(Bodies):
    """Keys and tables of the case file of a contact."""

    solved: ClassVar[tuple[str, ...]] = (
        "materials",
        "shape",
        "body",
        "counterbody",
        "grid",
        "solve",
        "slide",
        "roll",
        "wear",
    )

    shape: AnyShape = Field(description="Shape that is pressed in.")
    grid: Grid | None = Field(None, description=SOLVE["grid"])
    solve: Solve = Field(description="Load or approach, and settings of the solver.")
    slide: Slide | None = Field(None, description="Friction, in one step or in a history.")
    roll: Roll | None = Field(None, description="Rolling with friction; without slide.")
    wear: Wear | None = Field(
        None, description="Wear by sliding, by the cycles of slide, or by the passes of roll."
    )
    stress: Stress | None = Field(
        None, description="Stresses below the surface; the table may be empty."
    )
    fatigue: Fatigue | None = Field(
        None, description="Shakedown and fatigue in steady rolling; the table may be empty."
    )
    conductance: Conductance | None = Field(
        None, description="Resistance of the contact to heat or current."
    )

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments of `nacre.solve`; a `ValueError` begins with the key at fault."""
        with at("shape"):
            shape = self.shape.make(folder, System(self.units).metres)
        keywords: dict[str, object] = {"shape": shape, **self.bodies()}
        if self.grid is not None:
            with at("grid"):
                keywords["grid"] = self.grid.make()
        return keywords | self.solve.keywords() | self._of_history()

    @property
    def history(self) -> Literal["wear", "slide", "roll"] | None:
        """Name of the table of a history, which is that of its function; None without one."""
        return "wear" if self.wear else "slide" if self.slide else "roll" if self.roll else None

    def _of_history(self) -> dict[str, object]:
        """Return the arguments of wear and friction beside those of `nacre.solve`."""
        if (name := self.history) is None:
            return {}
        if self.slide is not None and self.roll is not None:
            raise WrongValue("roll", "must not be given beside the table slide")
        parameters = inspect.signature(getattr(nacre, name)).parameters
        if surplus := sorted(self.solve.model_fields_set - parameters.keys()):
            raise WrongValue(f"solve.{surplus[0]}", f"must not be given beside the table {name}")
        return self._wear() if self.wear else self._friction(name)

    def _wear(self) -> dict[str, object]:
        """Return the arguments of `nacre.wear` beside those of `nacre.solve`."""
        assert self.wear is not None
        keywords = self.wear.keywords()
        self._number_layers("wear", "rate", keywords)
        motions = (("slide", self.slide), ("roll", self.roll))
        return keywords | {name: table.keywords() for name, table in motions if table is not None}

    def conductors(self) -> dict[str, Any] | None:
        """Return the arguments of `Solution.conductance`, or None without a table for it."""
        if self.conductance is None:
            return None
        keywords = self.conductance.keywords()
        self._number_layers("conductance", "conductivity", keywords)
        return keywords

    def _number_layers(self, table: str, key: str, keywords: dict[str, Any]) -> None:
        """Replace the names of layers in a keyword of each body by their numbers."""
        for name, body in ((key, self.body), (f"counter_{key}", self.counterbody)):
            if name in keywords:
                with at(f"{table}.{name}"):
                    keywords[name] = numbers_by_layer(keywords[name], self._names(body))

    @staticmethod
    def _names(body: Body | None) -> list[list[str]]:
        """Return the names of the layers of a body and of its substrate, the first their own."""
        if body is None:
            return []
        regions = [(str(k), layer.name, layer.material) for k, layer in enumerate(body.layers)]
        regions.append(("substrate", None, body.substrate))
        return [[name for name in region if isinstance(name, str)] for region in regions]

    def _friction(self, name: str) -> dict[str, object]:
        """Return the arguments of `nacre.slide` or `nacre.roll` beside those of `nacre.solve`."""
        motion = self.slide or self.roll
        assert motion is not None
        for place, table in (("stress", self.stress), ("fatigue", self.fatigue)):
            if table is not None and table.friction:
                raise WrongValue(
                    f"{place}.friction",
                    f"must be 0 beside the table {name}: its tractions are known",
                )
        return motion.keywords()

    def bonds(self, table: Stress) -> dict[str, dict[int, tuple[float | None, float | None]]]:
        """Return what the interfaces of the body of a table bear; nothing where none is given."""
        body = self.body if table.body == "body" else self.counterbody
        bonds = {
            place: (layer.bond_strength.shear, layer.bond_strength.tension)
            for place, layer in enumerate(body.layers if body is not None else ())
            if layer.bond_strength is not None
        }
        return {"bond_strength": bonds} if bonds else {}

    def limits(self, table: Stress | Fatigue | None, *names: str) -> dict[str, list[Any]]:
        """Return limits of the layers and the substrate of the body of a table, by their names."""
        body = self.body if table is None or table.body == "body" else self.counterbody
        if body is None:
            return {}
        entries = [*(layer.material for layer in body.layers)]
        entries += [body.substrate] if self._base(body) is None else []
        return {name: [self._limit(entry, name) for entry in entries] for name in names}

    def _limit(self, material: str | Material, name: str) -> float | Card | None:
        """Return a limit of a material; for a yield stress its card, in the units of the case."""
        named = self.materials.get(material, material) if isinstance(material, str) else material
        if isinstance(named, str) and name == "yield_stress" and named in nacre.materials:
            return nacre.materials[named]._scaled(System(self.units).unit("Pa")[0])
        limit: float | None = getattr(self._material_table(material), name)
        return limit


class WrongValue(ValueError):
    """An error about the value of a key."""

    def __init__(self, key: str, message: str) -> None:
        super().__init__(f"{key}: {message}")
        self.key, self.message = key, message


@contextmanager
def at(key: str) -> Iterator[None]:
    """Name the key whose value raises an error: a `WrongValue`."""
    try:
        yield
    except WrongValue as error:
        if error.key.startswith("materials."):  # a key of its own, wherever it is used
            raise
        raise WrongValue(f"{key}.{error.key}", error.message) from error
    except (ArithmeticError, OSError, TypeError, ValueError) as error:
        raise WrongValue(key, str(error)) from error
