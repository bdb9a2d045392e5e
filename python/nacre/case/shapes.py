"""Tables of shapes in case files.

The tables of most shapes and profiles are made from the signatures and docstrings in `nacre._core`.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union

from pydantic import AfterValidator, Field

import nacre
from nacre import rough
from nacre.case.tables import (
    Count,
    Counts,
    Flags,
    Number,
    Numbers,
    Pair,
    Table,
    parameter_texts,
    table_of,
)
from nacre.hertz import relative_radii

PROFILES: dict[str, Any] = {
    "logarithmic": nacre.LogarithmicProfile,
    "lundberg": nacre.LogarithmicProfile.lundberg,
    "johns_gohar": nacre.LogarithmicProfile.johns_gohar,
    "fujiwara_kawase": nacre.LogarithmicProfile.fujiwara_kawase,
    "iso16281": nacre.LogarithmicProfile.iso16281,
    "sampled": nacre.SampledProfile,
}
"""Callables that make the axial profiles of rollers, by their names in case files."""


class Profile(Table):
    """An axial profile of a roller."""

    def make(self) -> nacre.LogarithmicProfile | nacre.SampledProfile:
        """Return the profile."""
        arguments = self.model_dump(exclude={"kind"}, exclude_none=True)
        kind: str = self.kind  # type: ignore[attr-defined]
        return PROFILES[kind](**arguments)  # type: ignore[no-any-return]


PROFILE_TABLES = {
    kind: table_of(
        kind, maker, Profile, {"x": Numbers, "drop": Numbers, "smooth": bool, "corners": Numbers}
    )
    for kind, maker in PROFILES.items()
}

AnyProfile: Any = Annotated[
    Union[tuple(PROFILE_TABLES.values())],  # noqa: UP007
    Field(discriminator="kind"),
]


class Shape(Table):
    """Keys that every shape may have: a shift."""

    shift: Pair | None = Field(None, description="Distances by which the shape is moved [m].")

    def make(self, folder: Path, metres: float) -> nacre.types.Shape:
        """Return the shape; files are in `folder`, and the unit of length has so many metres."""
        shape = self.unmoved(folder, metres)
        return shape if self.shift is None else shape.shifted(*self.shift)

    def unmoved(self, folder: Path, metres: float) -> nacre.types.Shape:
        """Return the shape without its shift."""
        arguments = self.model_dump(exclude={"kind", "shift"}, exclude_none=True)
        if "profile" in arguments:
            arguments["profile"] = self.profile.make()  # type: ignore[attr-defined]
        kind: str = self.kind  # type: ignore[attr-defined]
        return SHAPES[kind](**arguments)  # type: ignore[no-any-return]


SHAPES: dict[str, Any] = {
    re.sub(r"(?<!^)(?=[A-Z])", "_", shape_class.__name__).lower(): shape_class
    for shape_class in vars(nacre._core).values()
    if isinstance(shape_class, type)
    and issubclass(shape_class, nacre.types.Shape)
    and shape_class is not nacre.types.Shape
}
"""Shapes by their names in case files: ``FlatPunch`` is "flat_punch"."""

READ = parameter_texts(nacre.HeightMap.read)


def _on_this_computer(path: str) -> str:
    """Return a path unless Windows would log in to another computer to open it."""
    if path.startswith(("\\\\", "//")):
        raise ValueError(f"must be a file of this computer, got {path!r}; copy it beside the case")
    return path


class HeightMap(Shape):
    """A measured surface in a file."""

    kind: Literal["height_map"] = Field(description="Kind, which decides on the other keys.")
    path: Annotated[str, AfterValidator(_on_this_computer)] = Field(
        description="File, relative to the folder of the case. " + READ["path"]
    )
    spacing: Number | Pair | None = Field(None, description=READ["spacing"])
    unit: str | None = Field(None, description=READ["unit"])
    detrend: Literal["none", "mean", "plane", "quadratic"] = Field(
        "plane", description=READ["detrend"]
    )
    transpose: bool = Field(False, description=READ.get("transpose"))
    channel: str | int | None = Field(None, description=READ["channel"])
    periodic: Flags | None = Field(None, description=READ["periodic"])

    def unmoved(self, folder: Path, metres: float) -> nacre.types.Shape:
        """Return the shape without its shift, in the unit of length of the case."""
        arguments = self.model_dump(exclude={"kind", "shift", "path"}, exclude_none=True)
        if self.spacing is not None:
            sides = self.spacing if isinstance(self.spacing, list) else [self.spacing] * 2
            arguments["spacing"] = tuple(metres * side for side in sides)
        height_map = nacre.HeightMap.read(folder / self.path, **arguments)
        if metres == 1.0:
            return height_map
        spacing, center = (
            (x / metres, y / metres) for x, y in (height_map.spacing, height_map.center)
        )
        return nacre.HeightMap(height_map.heights / metres, spacing, center, height_map.periodic)


RANDOM = parameter_texts(rough.random_surface)
CROSSED = parameter_texts(relative_radii)


class RandomSurface(Shape):
    """A self-affine random surface that repeats: `nacre.rough.random_surface`."""

    kind: Literal["random_surface"] = Field(description="Kind, which decides on the other keys.")
    shape: Counts = Field(description=RANDOM["shape"])
    size: Pair = Field(description=RANDOM["size"])
    hurst: Number = Field(description=RANDOM["hurst"])
    shortest: Number = Field(description=RANDOM["shortest"])
    longest: Number = Field(description=RANDOM["longest"])
    rms_slope: Number | None = Field(
        None, description="Root of the mean square of the slope, in place of that of the height."
    )
    rms_height: Number | None = Field(
        None,
        description="Root of the mean square of the height [m], in place of that of the slope.",
    )
    seed: Count = Field(
        description="Number that chooses the surface: the same one makes the same surface."
    )

    def unmoved(self, folder: Path, metres: float) -> nacre.types.Shape:
        """Return the shape without its shift."""
        arguments = self.model_dump(exclude={"kind", "shift"}, exclude_none=True)
        return rough.random_surface(rng=arguments.pop("seed"), **arguments)


class Crossed(Shape):
    """Two bodies at an angle, such as crossed cylinders: `nacre.hertz.relative_radii`.

    The x axis of the contact lies along the longer of the relative radii.
    """

    kind: Literal["crossed"] = Field(description="Kind, which decides on the other keys.")
    radius_x: float | None = Field(
        None, description="Radius of one body along x [m]; straight by default."
    )
    radius_y: float | None = Field(
        None, description="Radius of one body along y [m]; straight by default."
    )
    counter_radius_x: float | None = Field(
        None, description="Radius of the other body along its own x axis [m]; straight by default."
    )
    counter_radius_y: float | None = Field(
        None, description="Radius of the other body along its own y axis [m]; straight by default."
    )
    angle: Number = Field(description=CROSSED["angle"])

    def unmoved(self, folder: Path, metres: float) -> nacre.types.Shape:
        """Return the shape without its shift."""
        counter_radii = (self.counter_radius_x, self.counter_radius_y)
        radii, _ = relative_radii((self.radius_x, self.radius_y), counter_radii, self.angle)
        return nacre.Paraboloid(*radii)


class Sum(Shape):
    """A sum of shapes: their gaps are added."""

    kind: Literal["sum"] = Field(description="Kind, which decides on the other keys.")
    parts: Annotated[list[AnyShape], Field(min_length=1)] = Field(
        description="Shapes that are added, one at least."
    )

    def unmoved(self, folder: Path, metres: float) -> nacre.types.Shape:
        """Return the shape without its shift."""
        first, *addends = (shape.make(folder, metres) for shape in self.parts)
        for addend in addends:
            first = first + addend
        return first


FLAT: dict[str, dict[str, Any]] = {
    "cylinder": {"radius": float},
    "paraboloid": {"radius_x": float, "radius_y": float},
}
"""Types of radii that may be infinite, by kind of shape."""
COUNTER: dict[str, Any] = dict.fromkeys(
    ("counter_radius", "counter_radius_x", "counter_radius_y"), float | None
)
OWN_TABLES: dict[str, type[Shape]] = {
    "height_map": HeightMap,
    "random_surface": RandomSurface,
    "crossed": Crossed,
    "sum": Sum,
}
TABLES: dict[str, type[Shape]] = {
    kind: table_of(kind, shape_class, Shape, {"profile": AnyProfile} | COUNTER | FLAT.get(kind, {}))
    for kind, shape_class in SHAPES.items()
    if kind not in OWN_TABLES
} | OWN_TABLES
"""Tables of all shapes, by kind."""

if TYPE_CHECKING:
    AnyShape = Shape
else:
    AnyShape = Annotated[
        Union[tuple(TABLES.values())],  # noqa: UP007
        Field(discriminator="kind"),
    ]

Sum.model_rebuild()
