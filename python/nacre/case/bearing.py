"""Tables of case files for bearings: by kind, with what is asked of them."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Union

from pydantic import Field, create_model, model_validator

from nacre._tools.units import System, size_of
from nacre.bearing import (
    AngularContactBall,
    BearingSolution,
    CylindricalRoller,
    DeepGrooveBall,
    Pair,
    SphericalRoller,
    TaperedRoller,
    film_thickness,
)
from nacre.bearing.bearings import Solvable
from nacre.bearing.geometry import Ring
from nacre.bearing.pair import Arrangement
from nacre.case.schema import Body, Keys, at
from nacre.case.shapes import AnyProfile
from nacre.case.tables import (
    Count,
    Counts,
    Directions,
    Number,
    Table,
    parameter_texts,
    with_words,
)
from nacre.case.tables import Pair as Two

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
SOLVE = parameter_texts(Solvable.solve)
LIFE = parameter_texts(BearingSolution.life)
FILMS = parameter_texts(film_thickness)
PAIR = parameter_texts(Pair)


UNITS: dict[str, str] = (
    dict.fromkeys(
        (
            *("diameter", "length", "pitch_diameter", "raceway_diameters", "raceway_crown"),
            *("profile_radius", "groove_radius", "clearance", "shoulder_height", "thickness"),
            *("displacement", "roughness", "radius", "amplitude", "flat_length", "z_m"),
            *("distance", "preload_distance"),
            *("profile.x", "SampledProfile.x", "drop", "corners", "smoothing", "ends"),
        ),
        "m",
    )
    | dict.fromkeys(("force", "preload_force", "capacity", "load", "fatigue_load_limit"), "N")
    | dict.fromkeys(("young", "yield_stress", "strength", "shear_yield", "contact_modulus"), "Pa")
    | {"moment": "N m", "density": "kg/m³", "film.speed": "m/s"}
    | {"viscosity": "Pa s", "pressure_viscosity": "1/Pa", "kinematic_viscosity": "m²/s"}
    | dict.fromkeys(("normal", "tangential"), "Pa/m")
)
"""SI units of the numbers at keys, or of all in the tables there; the others have none, or rad."""


def sizes_of(units: str) -> dict[str, float]:
    """Return the sizes in SI of the units that are consistent with those of a case."""
    system = System(units)  # which checks them
    parts = ("N", "m", "Pa") if system.name == "SI" else tuple(units.split("-"))
    force, length, stress = (size[1] for part in parts if (size := size_of(part)))
    return {
        "N": force,
        "m": length,
        "Pa": stress,
        "N m": force * length,
        "N/m": force / length,
        "m/s": length,
        "m²/s": length**2,
        "Pa s": stress,
        "1/Pa": 1 / stress,
        "Pa/m": stress / length,
        "kg/m³": stress / length**2,  # ρ v² is a stress
    }


def scaled(data: object, sizes: Mapping[str, float]) -> Any:
    """Return data in which the numbers at the keys of a bearing are multiplied by their sizes."""

    def inner(data: Any, path: tuple[str, ...], size: float) -> Any:
        if isinstance(data, dict):
            return {
                key: inner(value, (*path, key), sizes.get(_unit((*path, key)), size))
                for key, value in data.items()
            }
        if isinstance(data, list):
            return [inner(value, path, size) for value in data]
        is_number = isinstance(data, float) or (type(data) is int and size != 1)
        return data * size if is_number else data

    return inner(data, (), 1.0)


def _unit(path: tuple[str, ...]) -> str:
    """Return the SI unit of the numbers at a path, if it is not that of the table around it."""
    return UNITS.get(".".join(path[-2:])) or UNITS.get(path[-1], "")


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


class BearingSolve(Table):
    """What is asked of the inner ring: each direction loaded, prescribed, or locked at 0."""

    force: InSpace | None = Field(None, description=SOLVE["force"])
    displacement: InSpace | None = Field(None, description=SOLVE["displacement"])
    moment: About | None = Field(None, description=SOLVE["moment"])
    tilt: About | None = Field(None, description=SOLVE["tilt"])
    rotation: Number = Field(0.0, description=SOLVE["rotation"])
    speed: Number = Field(0.0, description=SOLVE["speed"])
    rotating: Ring = Field("inner", description=SOLVE["rotating"])
    model: Literal["solved", "iso16281"] = Field("solved", description=SOLVE["model"])
    cells: Counts | None = Field(None, description=SOLVE["cells"])
    tolerance: Number = Field(1e-9, description=SOLVE["tolerance"])
    max_iterations: Count = Field(50, description=SOLVE["max_iterations"])


class Duty(Table):
    """A part of a load spectrum."""

    share: Number = Field(description="Share of the time; those of all parts sum to 1.")
    force: InSpace = Field(description="Forces on the inner ring [N].")
    speed: Number = Field(description="Angular velocity of the ring that rotates [rad/s].")


class BearingLife(Table):
    """Rating life of ISO/TS 16281 and ISO 281, which is printed; the table may be empty."""

    edge: Literal["standard", "pressure", "none"] = Field(
        "standard",
        description="Edge factors: those of the standard, those of the solved pressure, or none.",
    )
    rotating: Ring | None = Field(
        None,
        description="Ring that rotates against the load; by default that of `[bearing.solve]`.",
    )
    speed: Number | None = Field(None, description=LIFE["speed"])
    reliability: Number = Field(0.9, description=LIFE["reliability"])
    viscosity_ratio: Number | None = Field(None, description=LIFE["viscosity_ratio"])
    kinematic_viscosity: Number | None = Field(None, description=LIFE["kinematic_viscosity"])
    film_ratio: Number | None = Field(None, description=LIFE["film_ratio"])
    contamination: str | Number | None = Field(None, description=LIFE["contamination"])
    additives: bool = Field(False, description=LIFE["additives"])
    fatigue_load_limit: Number | None = Field(None, description=LIFE["fatigue_load_limit"])
    spectrum: list[Duty] = Field(
        [],
        description="Load spectrum in place of the solved load: tables with share, force and "
        "speed, whose lives add up by Miner's rule.",
    )
    required_life: Number | None = Field(None, description=LIFE["required_life"])

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


class BearingFilm(Table):
    """Oil film in the heaviest contact of a ring, which is printed; for solved contacts."""

    speed: Number = Field(description=FILMS["speed"])
    viscosity: Number = Field(description=FILMS["viscosity"])
    pressure_viscosity: Number = Field(description=FILMS["pressure_viscosity"])
    roughness: Number | None = Field(None, description=FILMS["roughness"])
    radius: Number | None = Field(None, description=FILMS["radius"])
    ring: Ring = Field("inner", description="Ring of the contact.")


class SingleKind(Table):
    """Keys of a bearing."""

    bearing_class: ClassVar[type[Any]]


class BearingKind(SingleKind):
    """Keys that every bearing may have: what is solved, a life, and a film."""

    solve: BearingSolve = Field(description="What is solved.")
    life: BearingLife | None = Field(None, description="Life that is printed.")
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
    descriptions = parameter_texts(bearing_class)
    fields: dict[str, Any] = {
        "kind": (Literal[kind], Field(description="Kind, which decides on the other keys."))
    }
    for one in dataclasses.fields(bearing_class):
        hint, default = TYPES.get(one.name, Number), one.default
        if one.name in FOLLOWS.get(kind, ()):
            continue
        if default is dataclasses.MISSING:
            fields[one.name] = (hint, Field(description=descriptions.get(one.name, "")))
            continue
        if default is None or one.name in ("element", "inner", "outer", "raceway_crown"):
            hint, default = hint | None, None
        default_value = list(default) if isinstance(default, tuple) else default
        fields[one.name] = (
            hint,
            Field(default=default_value, description=descriptions.get(one.name, "")),
        )
    summary = inspect.cleandoc(bearing_class.__doc__ or "").partition("\n")[0]
    name = bearing_class.__name__ + suffix
    table: type[SingleKind] = create_model(name, __base__=base, __doc__=summary, **fields)
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


class PairKind(Table):
    """Two angular contact ball or two tapered roller bearings on one rigid shaft."""

    film: ClassVar[None] = None

    kind: Literal["pair"] = Field(description="Kind, which decides on the other keys.")
    first: AnySingle = Field(description="Bearing at `z = -distance/2`.")
    second: AnySingle | None = Field(
        None, description="Bearing at `z = distance/2`; by default it is equal to the first."
    )
    arrangement: Arrangement = Field(description=PAIR["arrangement"])
    distance: Number = Field(description=PAIR["distance"])
    preload_force: Number | None = Field(None, description=PAIR["preload_force"])
    preload_distance: Number | None = Field(None, description=PAIR["preload_distance"])
    solve: BearingSolve = Field(description="What is solved.")
    life: BearingLife | None = Field(None, description="Life that is printed.")


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

    bearing: AnyBearing = Field(description="Bearing, and what is asked of it.")

    @model_validator(mode="after")
    def _with_contacts(self) -> BearingCase:
        if self.bearing.film is not None and self.bearing.solve.model != "solved":
            raise ValueError(
                f'bearing.solve.model must be "solved" for bearing.film, which is that of a '
                f"contact; got {self.bearing.solve.model!r}"
            )
        return self

    def _si(self) -> BearingCase:
        """Return the same case in SI."""
        if System(self.units).name == "SI":
            return self
        data = self.model_dump(exclude={"units", "sweep"}, exclude_unset=True)
        return type(self).model_validate(scaled(data, sizes_of(self.units)))

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
        arguments = table.model_dump(exclude={"kind", "solve", "life", "film"}, exclude_unset=True)
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
        table = self._si().bearing.life
        return None if table is None else table.keywords()

    def film(self) -> dict[str, Any] | None:
        """Return the ring and keywords of the film in SI, or None where none is asked for."""
        table = self._si().bearing.film
        return None if table is None else {"ring": table.ring, **table.keywords()}
