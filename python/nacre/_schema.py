"""The schema of case files: one class for each table.

The tables of shapes whose arguments are all numbers, and the keywords of a solve, are made from the
signatures in `nacre._core` and from `nacre._keywords`.
"""

from __future__ import annotations

import inspect
import re
import types
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, get_args, get_type_hints

import numpy as np
from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    FiniteFloat,
    PositiveInt,
    create_model,
    model_validator,
)

import nacre
from nacre import _keywords

Pair = Annotated[list[FiniteFloat], Field(min_length=2, max_length=2)]


class Table(BaseModel):
    """A table with the named keys and no others."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class Material(Table):
    """Constants and strengths of an elastic material."""

    young: FiniteFloat
    poisson: FiniteFloat
    yield_stress: FiniteFloat | None = None
    strength: FiniteFloat | None = None

    def make(self) -> nacre.Elastic:
        """Return the elastic constants."""
        return nacre.Elastic(self.young, self.poisson)


class Layer(Table):
    """A layer, the interface below it, and the name that results show."""

    material: str | Material
    thickness: FiniteFloat
    interface: Literal["bonded", "frictionless"] = "bonded"
    name: str | None = None


class Body(Table):
    """A half-space: its substrate, by name or "rigid", and layers from the surface down."""

    substrate: str | Material
    layers: list[Layer] = []


class Grid(Table):
    """Cells of a grid, or the strips of a line contact."""

    shape: Annotated[list[PositiveInt], Field(min_length=2, max_length=2)] | None = None
    size: Pair | None = None
    center: Pair | FiniteFloat | None = None
    cells: PositiveInt | None = None
    width: FiniteFloat | None = None

    @model_validator(mode="after")
    def _one_kind(self) -> Grid:
        area, line = (self.shape, self.size), (self.cells, self.width)
        if (None in area or line != (None, None)) and (None in line or area != (None, None)):
            raise ValueError("either shape and size or, for a line contact, cells and width")
        return self

    def make(self) -> nacre.Grid:
        """Return the grid."""
        center: dict[str, Any] = {} if self.center is None else {"center": self.center}
        if self.cells is not None:
            return nacre.Grid.line(self.cells, self.width or 0.0, **center)
        return nacre.Grid(self.shape, self.size, **center)  # type: ignore[arg-type]


class Profile(Table):
    """An axial profile of a roller: the name of the function that makes it, and its arguments."""

    kind: Literal["logarithmic", "lundberg", "johns_gohar", "iso16281", "sampled"]
    amplitude: FiniteFloat | None = None
    length: FiniteFloat | None = None
    flat_length: FiniteFloat | None = None
    end_factor: FiniteFloat | None = None
    load: FiniteFloat | None = None
    contact_modulus: FiniteFloat | None = None
    radius: FiniteFloat | None = None
    diameter: FiniteFloat | None = None
    x: list[FiniteFloat] | None = None
    drop: list[FiniteFloat] | None = None

    def make(self) -> nacre.LogarithmicProfile | nacre.SampledProfile:
        """Return the profile."""
        given = self.model_dump(exclude={"kind"}, exclude_none=True)
        makers: dict[str, Any] = {
            "logarithmic": nacre.LogarithmicProfile,
            "sampled": nacre.SampledProfile,
        }
        maker = makers.get(self.kind) or getattr(nacre.LogarithmicProfile, self.kind)
        return _made(maker, given)  # type: ignore[no-any-return]


class Shape(Table):
    """Keys that every shape may have: a shift."""

    shift: Pair | None = None

    def make(self, folder: Path) -> nacre.Shape:
        """Return the shape."""
        given = self.model_dump(exclude={"kind", "shift"}, exclude_none=True)
        shape = self.unmoved(given, folder)
        return shape if self.shift is None else shape.shifted(*self.shift)

    def unmoved(self, given: dict[str, Any], folder: Path) -> nacre.Shape:
        """Return the shape without its shift."""
        kind: str = self.kind  # type: ignore[attr-defined]
        return _made(SHAPES[kind], given)  # type: ignore[no-any-return]


SHAPES: dict[str, type[nacre.Shape]] = {
    re.sub(r"(?<!^)(?=[A-Z])", "_", made.__name__).lower(): made
    for made in vars(nacre._core).values()
    if isinstance(made, type) and issubclass(made, nacre.Shape) and made is not nacre.Shape
}
"""Shapes by their names in case files: ``FlatPunch`` is "flat_punch"."""


class Roller(Shape):
    """A roller with a crown or another profile."""

    kind: Literal["roller"]
    radius: FiniteFloat
    flat_length: FiniteFloat | None = None
    crown_radius: FiniteFloat | None = None
    length: FiniteFloat | None = None
    profile: Profile | None = None

    def unmoved(self, given: dict[str, Any], folder: Path) -> nacre.Shape:
        """Return the shape without its shift."""
        profile = {} if self.profile is None else {"profile": self.profile.make()}
        return nacre.Roller(**(given | profile))


class HeightMap(Shape):
    """A measured surface in a file, with the arguments of `HeightMap.read`."""

    kind: Literal["height_map"]
    path: str
    spacing: FiniteFloat | Pair | None = None
    unit: str | None = None
    detrend: Literal["none", "mean", "plane", "quadratic"] = "plane"
    transpose: bool = False

    def unmoved(self, given: dict[str, Any], folder: Path) -> nacre.Shape:
        """Return the shape without its shift."""
        return nacre.HeightMap.read(folder / given.pop("path"), **given)


class Sum(Shape):
    """A sum of shapes."""

    kind: Literal["sum"]
    parts: Annotated[list[AnyShape], Field(min_length=1)]

    def unmoved(self, given: dict[str, Any], folder: Path) -> nacre.Shape:
        """Return the shape without its shift."""
        first, *others = (part.make(folder) for part in self.parts)
        for other in others:
            first = first + other
        return first


def _numbers(kind: str, made: type[nacre.Shape]) -> type[Shape]:
    """Return the table of a shape whose arguments are all numbers."""
    parameters = inspect.signature(made).parameters.values()
    fields: dict[str, Any] = {
        one.name: (FiniteFloat, ...) if one.default is one.empty else (FiniteFloat | None, None)
        for one in parameters
    }
    fields["kind"] = (Literal[kind], ...)
    return create_model(made.__name__, __base__=Shape, **fields)


OWN_TABLES: dict[str, type[Shape]] = {"roller": Roller, "height_map": HeightMap, "sum": Sum}
TABLES = {kind: _numbers(kind, made) for kind, made in SHAPES.items() if kind not in OWN_TABLES}
KINDS = ", ".join(repr(kind) for kind in TABLES | OWN_TABLES)

if TYPE_CHECKING:
    AnyShape = Shape
else:
    AnyShape = Annotated[
        Union[tuple((TABLES | OWN_TABLES).values())],  # noqa: UP007
        Field(discriminator="kind"),
    ]


class Freedoms(Table):
    """A value along x, along y, or both."""

    x: FiniteFloat | None = None
    y: FiniteFloat | None = None


def _checked(hint: Any) -> Any:
    """Return the type that a case file has for a keyword: finite numbers, positive integers."""
    known = {float: FiniteFloat, int: PositiveInt, _keywords.Freedoms: Freedoms | Pair}
    parts = get_args(hint) if isinstance(hint, types.UnionType) else (hint,)
    return Union[(*(known.get(part, part) for part in parts), None)]


class SolveKeywords(Table):
    """Keywords of `nacre.solve` that a case file may have."""

    def keywords(self) -> dict[str, Any]:
        """Return the keywords that were given."""
        found = {name: value for name, value in self if value is not None}
        for name, value in found.items():
            if isinstance(value, Freedoms):
                found[name] = (value.x, value.y)
            elif isinstance(value, list):
                found[name] = tuple(value)
        return found


def _solve() -> type[SolveKeywords]:
    """Return the table of those keywords."""
    groups = (_keywords.Motion, _keywords.Plan, _keywords.Search)
    hints = {name: hint for group in groups for name, hint in get_type_hints(group).items()}
    fields: dict[str, Any] = {name: (_checked(hint), None) for name, hint in hints.items()}
    return create_model("Solve", __base__=SolveKeywords, **fields)


if TYPE_CHECKING:
    Solve = SolveKeywords
else:
    Solve = _solve()


class Stress(Table):
    """Keywords of `Solution.stress_summary`."""

    body: Literal["body", "counterbody"] = "body"
    friction: FiniteFloat = 0.0
    direction: Pair | None = None

    def keywords(self) -> dict[str, Any]:
        """Return the keywords."""
        direction = {} if self.direction is None else {"direction": tuple(self.direction)}
        return {"body": self.body, "friction": self.friction, **direction}


class Range(Table):
    """Evenly spaced values, ends included."""

    first: FiniteFloat
    last: FiniteFloat
    count: PositiveInt
    scale: Literal["linear", "log"] = "linear"

    @model_validator(mode="after")
    def _logarithms_exist(self) -> Range:
        if self.scale == "log" and min(self.first, self.last) <= 0:
            raise ValueError("first and last must be above 0 on a logarithmic scale")
        return self

    def numbers(self) -> list[float]:
        """Return the values."""
        make = np.geomspace if self.scale == "log" else np.linspace
        return [float(value) for value in make(self.first, self.last, self.count)]


class Sweep(Table):
    """A study: values by dotted key of the case, the outputs and the file to store them in."""

    parameters: dict[str, Range | Annotated[list[Any], Field(min_length=1)]]
    outputs: list[str] | None = None
    store: str | None = None


class CaseTable(Table):
    """A whole case file."""

    materials: dict[str, Material] = {}
    shape: AnyShape
    body: Body
    counterbody: Body | None = None
    grid: Grid | None = None
    solve: Solve
    stress: Stress | None = None
    sweep: Sweep | None = None

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments of `nacre.solve`; a `ValueError` begins with the key at fault."""
        with _at("shape"):
            found: dict[str, Any] = {"shape": self.shape.make(folder)}
        for name, body in (("body", self.body), ("counterbody", self.counterbody)):
            if body is not None:
                found[name] = self._body(name, body)
        if self.grid is not None:
            with _at("grid"):
                found["grid"] = self.grid.make()
        return found | self.solve.keywords()

    def limits(self) -> dict[str, list[float | None]]:
        """Return yield stresses and strengths of the layers and the substrate."""
        body = self.body if self.stress is None or self.stress.body == "body" else self.counterbody
        if body is None:
            return {}
        named = [*(layer.material for layer in body.layers), body.substrate]
        found = [self.materials.get(one) if isinstance(one, str) else one for one in named]
        return {
            name: [getattr(material, name, None) for material in found]
            for name in ("yield_stress", "strength")
        }

    def _body(self, name: str, body: Body) -> nacre.HalfSpace:
        with _at(f"{name}.substrate"):
            rigid = body.substrate == "rigid" and "rigid" not in self.materials
            substrate = nacre.RIGID if rigid else self._material(body.substrate)
        layers = []
        for number, layer in enumerate(body.layers):
            with _at(f"{name}.layers.{number}"):
                material = self._material(layer.material)
                layers.append(nacre.Layer(material, layer.thickness, layer.interface, layer.name))
        with _at(name):
            return nacre.HalfSpace(substrate, layers)

    def _material(self, named: str | Material) -> nacre.Elastic:
        if isinstance(named, str):
            if named not in self.materials:
                known = ", ".join(self.materials) or "none"
                raise ValueError(f"must be one of the materials ({known}), got {named!r}")
            with _at(f"materials.{named}"):
                return self.materials[named].make()
        return named.make()


def _made(maker: Any, given: dict[str, Any]) -> Any:
    """Return what `maker` makes; a wrong argument is a `ValueError`."""
    try:
        return maker(**given)
    except TypeError as error:
        raise ValueError(str(error)) from error


@contextmanager
def _at(key: str) -> Iterator[None]:
    """Put a key before the message of a `ValueError`."""
    try:
        yield
    except (ValueError, OSError) as error:
        raise ValueError(f"{key}: {error}") from error
