"""Tables of case files for bearings: by kind, with what is asked of them."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Union

from pydantic import Field, create_model, model_validator

from nacre._tools.groups import keyword_units
from nacre._tools.units import System
from nacre.bearing import (
    AngularContactBall,
    BearingSolution,
    CylindricalRoller,
    DeepGrooveBall,
    Pair,
    SphericalRoller,
    TaperedRoller,
    film_thickness,
    oil_viscosity,
)
from nacre.bearing.arguments import Model
from nacre.bearing.bearings import Solvable
from nacre.bearing.geometry import RINGS, Ring
from nacre.bearing.modified import SMALL
from nacre.bearing.pair import ARRANGEMENTS, Arrangement
from nacre.case.schema import Body, Keys, at
from nacre.case.shapes import AnyProfile
from nacre.case.tables import (
    Count,
    Directions,
    Number,
    Table,
    from_signature,
    parameter_texts,
    unit_of,
    with_words,
)
from nacre.case.tables import Pair as Two
from nacre.results.parameters import VALUES

KINDS: dict[str, type[Solvable]] = {
    bearing_class.kind: bearing_class
    for bearing_class in (
        CylindricalRoller,
        TaperedRoller,
        SphericalRoller,
        DeepGrooveBall,
        AngularContactBall,
    )
}
"""Bearings by their names in case files."""
PAIR = parameter_texts(Pair)
DENSITY = 870.0
"""Density of mineral oil in bearings, 850 to 890 [kg/m³]."""


SIZED = ("N", "m", "Pa", "N m", "N/m", "m/s", "m²/s", "Pa s", "1/Pa", "Pa/m", "kg/m³")
"""SI units of bearings that are others in other systems."""


def sizes_of(units: str) -> dict[str, float]:
    """Return the sizes in SI of the units that are consistent with those of a case."""
    system = System(units)  # which checks them
    return {unit: system.unit(unit)[0] for unit in SIZED}


KAPPA = {"viscosity_ratio", "kinematic_viscosity", "film_ratio"}
"""Keys of a life that say what the table of the oil says."""
ENCODED = VALUES | keyword_units(Pair, *KINDS.values())
"""SI units of the numbers of bearings and pairs as data, by key."""


def scaled(
    entry: Any, sizes: Mapping[str, float], units: Mapping[str, str], size: float = 1.0
) -> Any:
    """Return tables as data in which numbers are multiplied by the sizes of their units.

    Data have `units` by key; `size` is that of numbers that have no unit of their own.
    """
    own = units
    if isinstance(entry, Table):
        own = {name: unit_of(key) for name, key in type(entry).model_fields.items()}
        entry = {name: getattr(entry, name) for name in entry.model_fields_set}
    if isinstance(entry, dict):
        return {
            key: scaled(value, sizes, units, sizes.get(own.get(key, ""), size))
            for key, value in entry.items()
        }
    if isinstance(entry, list):
        return [scaled(value, sizes, units, size) for value in entry]
    is_number = isinstance(entry, float) or (type(entry) is int and size != 1)
    return entry * size if is_number else entry


class InSpace(Directions):
    """A value along x, y, z, or several of them."""

    x: Number | None = Field(None, description="Value along x.")
    y: Number | None = Field(None, description="Value along y.")
    z: Number | None = Field(None, description="Value along z, the bearing's axis.")


class About(Directions):
    """A value about x, about y, or both."""

    x: Number | None = Field(None, description="Value about x.")
    y: Number | None = Field(None, description="Value about y.")


class Rings(Directions):
    """A value of the inner ring, of the outer one, or both."""

    inner: Number | None = Field(None, description="Value of the inner ring.")
    outer: Number | None = Field(None, description="Value of the outer ring.")


@from_signature(
    Solvable.solve,
    {"threads", "check", "required_life"},  # which is a key of the life
    force=InSpace | None,
    displacement=InSpace | None,
    moment=About | None,
    tilt=About | None,
)
class BearingSolve(Table):
    """What is asked of the inner ring: each direction loaded, prescribed, or locked at 0."""

    if TYPE_CHECKING:
        model: Model


class Duty(Table):
    """A part of a load spectrum."""

    share: Number = Field(description="Share of the time; all shares sum to 1.")
    force: InSpace = Field(description="Forces on the inner ring [N].")
    speed: Number = Field(description="Angular velocity of the ring that rotates [rad/s].")


@from_signature(BearingSolution.life, {"spectrum"})
class Rating(Table):
    """Keys of a rating life, under one load."""

    edge: Literal["standard", "pressure", "none"] = Field(
        "standard",
        description="Edge factors: of the standard, of the solved pressure, or none.",
    )
    rotating: Ring | None = Field(
        None,
        description="Ring that rotates against the load; by default that of `[bearing.solve]`.",
    )


class BearingLife(Rating):
    """Rating life of ISO/TS 16281 and ISO 281, which is printed; the table may be empty."""

    spectrum: list[Duty] = Field(
        [],
        description="Load spectrum in place of the solved load: tables with share, force and "
        "speed, whose lives add up by Miner's rule.",
    )

    def keywords(self) -> dict[str, Any]:
        """Return the keywords of `BearingSolution.life`."""
        keywords = super().keywords() | {"spectrum": None}
        if self.edge == "none":
            keywords["edge"] = None
        if self.spectrum:
            keywords["spectrum"] = [
                (duty.share, duty.force.pair(), duty.speed) for duty in self.spectrum
            ]
        return keywords


@from_signature(film_thickness, {"solution"})
class Oil(Table):
    """Keys of the oil and how it flows."""


class BearingFilm(Oil):
    """Oil film in the heaviest contact of a ring, which is printed; for solved contacts."""

    ring: Ring = Field("inner", description="Ring of the contact.")
    speed: Number | None = Field(
        None,
        description="Entrainment speed, the mean of the speeds of both surfaces [m/s]; by default "
        "that of elements which roll, at the speed of the bearing.",
    )
    viscosity: Number | None = Field(
        None,
        description="Dynamic viscosity at ambient pressure and the temperature of the inlet "
        f"[Pa s]; by default that of the table `oil`, with {DENSITY:g} kg/m³.",
        json_schema_extra={"unit": "Pa s"},
    )


class BearingOil(Table):
    """Mineral oil of the viscosity index 95, for the film, and for a life with a_ISO of ISO 281."""

    grade: Number = Field(description="ISO VG, the viscosity at 40 °C in mm²/s.")
    temperature: Number = Field(description="Temperature of operation in °C.")
    cleanliness: Literal[tuple(SMALL)] = Field(  # type: ignore[valid-type]
        "normal cleanliness", description="Degree of cleanliness of ISO 281, table 13."
    )

    def viscosity(self) -> float:
        """Return the kinematic viscosity [m²/s]."""
        with at("bearing.oil"):
            return oil_viscosity(self.grade, self.temperature)


class SingleKind(Table):
    """Keys of a bearing."""

    bearing_class: ClassVar[type[Any]]


class BearingKind(SingleKind):
    """Keys that every bearing may have: what is solved, a life, its oil, and a film."""

    solve: BearingSolve = Field(description="What is solved.")
    life: BearingLife | None = Field(None, description="Life that is printed.")
    oil: BearingOil | None = Field(None, description="Oil, for the life and the film.")
    film: BearingFilm | None = Field(None, description="Oil film that is printed.")


TYPES: dict[str, Any] = {
    "count": Count,
    "rows": Count,
    "raceway_diameters": Two | None,
    "osculation": Two,
    "profile": Annotated[
        Literal["iso16281", "iso16281_cylindrical", "straight"] | AnyProfile,
        with_words('"iso16281", "iso16281_cylindrical", "straight", or a table with the key kind'),
    ],
    "raceway_crown": Rings | None,
    "free_ends": bool,
    "element": Body | None,
    "inner": Body | None,
    "outer": Body | None,
}
"""Types of keys that are no numbers."""
FOLLOWS = {"angular_contact_ball": ("clearance",)}
"""Arguments that are no keys, since others say what they are: the contact angle, the clearance."""


def _table(kind: str, base: type[SingleKind], suffix: str) -> Any:
    """Return the table of a bearing: a key for each argument, and those of its base."""
    bearing_class = KINDS[kind]
    descriptions, units = parameter_texts(bearing_class), keyword_units(bearing_class)
    fields: dict[str, Any] = {
        "kind": (Literal[kind], Field(description="Kind, which decides on the other keys."))
    }
    for field in dataclasses.fields(bearing_class):
        name, default = field.name, field.default
        hint = TYPES.get(name, Number)
        if name in FOLLOWS.get(kind, ()):
            continue
        if default is dataclasses.MISSING:
            default = ...
        elif default is None or name in ("element", "inner", "outer", "raceway_crown"):
            hint, default = hint | None, None
        default = list(default) if isinstance(default, tuple) else default
        extra: Any = {"json_schema_extra": {"unit": units[name]}} if name in units else {}
        fields[name] = (hint, Field(default, description=descriptions.get(name, ""), **extra))
    summary = inspect.cleandoc(bearing_class.__doc__ or "").partition("\n")[0]
    title = bearing_class.__name__ + suffix
    table: type[SingleKind] = create_model(title, __base__=base, __doc__=summary, **fields)
    table.bearing_class = bearing_class
    return table


if TYPE_CHECKING:
    AnySingle = SingleKind
else:
    AnySingle = Annotated[
        _table("angular_contact_ball", SingleKind, "OfPair")
        | _table("tapered_roller", SingleKind, "OfPair"),
        Field(discriminator="kind"),
    ]


@from_signature(Pair)
class Mounted(Table):
    """Keys of two bearings on a shaft."""

    kind: Literal["pair"] = Field(description="Kind, which decides on the other keys.")
    first: AnySingle = Field(description="Bearing at `z = -distance/2`.")
    second: AnySingle | None = Field(
        None, description="Bearing at `z = distance/2`; by default it is equal to the first."
    )
    arrangement: Annotated[Arrangement, with_words(ARRANGEMENTS)] = Field(
        description=PAIR["arrangement"]
    )


class PairKind(Mounted):
    """Two angular contact ball or two tapered roller bearings on one rigid shaft."""

    film: ClassVar[None] = None

    solve: BearingSolve = Field(description="What is solved.")
    life: BearingLife | None = Field(None, description="Life that is printed.")
    oil: BearingOil | None = Field(None, description="Oil, for the life.")


TABLES = {kind: _table(kind, BearingKind, "Case") for kind in KINDS} | {"pair": PairKind}
"""Tables of bearings, by kind."""

if TYPE_CHECKING:
    AnyBearing = BearingKind | PairKind
else:
    AnyBearing = Annotated[
        Union[tuple(TABLES.values())],  # noqa: UP007
        Field(discriminator="kind"),
    ]


class BearingCase(Keys):
    """Keys and tables of the case file of a bearing, for ``nacre solve``.

    Its numbers are in the units of the case, densities in those of force times time² over length⁴:
    t/mm³ in "N-mm-MPa". They are converted to SI, in which bearings are.
    """

    solved: ClassVar[tuple[str, ...]] = ("materials", "bearing")

    bearing: AnyBearing = Field(description="Bearing and its requirements.")

    @model_validator(mode="after")
    def _with_contacts(self) -> BearingCase:
        if self.bearing.film is not None and self.bearing.solve.model != "solved":
            raise ValueError(
                f'bearing.solve.model must be "solved" for bearing.film, which is that of a '
                f"contact; got {self.bearing.solve.model!r}"
            )
        if (
            self.bearing.film is not None
            and self.bearing.film.viscosity is None
            and self.bearing.oil is None
        ):
            raise ValueError("bearing.film.viscosity must be given, or the table bearing.oil")
        return self

    def _si(self) -> BearingCase:
        """Return the same case in SI."""
        if System(self.units).name == "SI":
            return self
        data = scaled(self, sizes_of(self.units), {}) | {"units": "SI", "sweep": None}
        return type(self).model_validate(data)

    def arguments(self) -> dict[str, Any]:
        """Return the bearing, or the pair of them, and the keywords of its ``solve``, in SI."""
        return self._si()._arguments()

    def _arguments(self) -> dict[str, object]:
        """Return the bearing and the keywords of its ``solve``, where all numbers are in SI."""
        table = self.bearing
        if isinstance(table, PairKind):
            first = self._single("bearing.first", table.first)
            second = first if table.second is None else self._single("bearing.second", table.second)
            names = ("arrangement", "distance", "preload_force", "preload_distance")
            with at("bearing"):
                pair = Pair(first, second, **{name: getattr(table, name) for name in names})
            return {"bearing": pair, **table.solve.keywords()}
        return {"bearing": self._single("bearing", table), **table.solve.keywords()}

    def _single(self, path: str, table: SingleKind) -> Any:
        """Return the bearing of a table at a path."""
        arguments = table.model_dump(
            exclude={"kind", "solve", "life", "oil", "film"}, exclude_unset=True
        )
        for name in arguments:
            value = getattr(table, name)
            if isinstance(value, Body):
                arguments[name] = self._body(f"{path}.{name}", value)
            elif isinstance(value, Directions):
                arguments[name] = value.pair()
            elif name == "profile":
                with at(f"{path}.profile"):
                    straight = None if value == "straight" else value
                    arguments[name] = straight if isinstance(value, str) else value.make()
            elif isinstance(value, list):
                arguments[name] = tuple(value)
        with at(path):
            return table.bearing_class(**arguments)

    def life(self) -> dict[str, Any] | None:
        """Return the keywords of the life, or None where none is asked for."""
        bearing = self._si().bearing
        if bearing.life is None:
            return None
        keywords, oil = bearing.life.keywords(), bearing.oil
        if oil is not None and keywords.keys().isdisjoint(KAPPA):
            known = {"kinematic_viscosity": oil.viscosity(), "contamination": oil.cleanliness}
            keywords = known | keywords
        return keywords

    def film(self) -> dict[str, Any] | None:
        """Return the ring and keywords of the film in SI, or None where none is asked for."""
        si = self._si()
        table, oil = si.bearing.film, si.bearing.oil
        if table is None:
            return None
        keywords = {"ring": table.ring, **table.keywords()}
        if oil is not None:
            keywords.setdefault("viscosity", DENSITY * oil.viscosity())
        if table.speed is None:
            keywords["speed"] = _rolling_speed(si._arguments(), table.ring)
        return keywords


def _rolling_speed(arguments: dict[str, Any], ring: Ring) -> float:
    """Return the speed of both surfaces in the contacts of a ring whose elements roll [m/s]."""
    bearing, speed = arguments["bearing"], arguments.get("speed", 0.0)
    rotating = arguments.get("rotating", "inner")
    turns = speed if rotating == ring else 0.0
    cage = bearing.cage_speed(speed, rotating)
    return float(abs(turns - cage) * bearing.tracks[RINGS.index(ring)])
