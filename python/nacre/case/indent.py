"""Tables of case files for indentations: tips and adhesion by kind, and what is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Union

from pydantic import Field, create_model, model_validator

from nacre.case.schema import Bodies, at
from nacre.case.tables import Number, Numbers, Table
from nacre.results.values import CALLS

KEYS: dict[str, tuple[Any, str]] = {
    "radius": (Number, "Radius of the sphere, of the flat punch, or of the end [m]."),
    "slope": (Number, "Slope of the cone to the surface, at most 5, in place of a half angle."),
    "flat": (Number, "Radius of the flat end [m]."),
    "factor": (Number, "Factor of the profile factor · r^exponent; its unit makes this a length."),
    "exponent": (Number, "Exponent of that profile."),
    "radii": (Numbers, "Distances from the axis [m], ascending from 0."),
    "heights": (Numbers, "Heights of the profile there [m], from 0 on."),
    "coefficients": (
        Numbers,
        "Coefficients C0, C1, C2 and so on of the area C0 d² + C1 d + C2 √d + … at a distance d "
        "from the end.",
    ),
    "depth": (Number, "Distance from the end up to which the area holds [m]."),
    "work": (Number, "Work of adhesion [N/m]."),
    "strength": (Number, "Stress with which the surfaces attract each other [Pa]."),
}
"""Types and descriptions of the numbers of tips and adhesion."""
HALF_ANGLE = "Angle between axis and flank [rad], in place of a slope."


class MethodTable(Table):
    """Table of what a static method of a class makes."""

    call_name: ClassVar[str]

    def make(self) -> Any:
        """Return the tip or the adhesion."""
        arguments = self.model_dump(exclude={"kind"}, exclude_none=True)
        return CALLS[self.call_name][0](**arguments)


class Sloped(MethodTable):
    """Table of a tip with a slope, or with a half angle in its place."""

    @model_validator(mode="after")
    def _one_slope(self) -> Sloped:
        if (getattr(self, "slope", None) is None) == (getattr(self, "half_angle", None) is None):
            raise ValueError("must have exactly one of slope and half_angle")
        return self


def _table(name: str) -> type[MethodTable]:
    """Return the table for one static method: a key for each of its parameters."""
    make, parameters = CALLS[name]
    family, _, kind = name.partition(".")
    sloped = "slope" in parameters
    fields: dict[str, Any] = {
        "kind": (Literal[kind], Field(description="Kind, which decides on the other keys."))
    }
    for parameter in parameters:
        hint, description = KEYS[parameter]
        if parameter == "slope" or kind == "berkovich":  # the radius of its end may be left out
            fields[parameter] = (hint | None, Field(None, description=description))
        else:
            fields[parameter] = (hint, Field(description=description))
    if sloped:
        fields["half_angle"] = (Number | None, Field(None, description=HALF_ANGLE))
    summary = " ".join((make.__doc__ or "").split())
    title = kind.title().replace("_", "") + family
    base = Sloped if sloped else MethodTable
    table: type[MethodTable] = create_model(title, __base__=base, __doc__=summary, **fields)
    table.call_name = name
    return table


TABLES = {
    family: {
        name.partition(".")[2]: _table(name) for name in CALLS if name.startswith(f"{family}.")
    }
    for family in ("Tip", "Adhesion")
}
"""Tables of tips and of adhesion, by kind."""

if TYPE_CHECKING:
    AnyTip = MethodTable
    AnyAdhesion = MethodTable
else:
    AnyTip, AnyAdhesion = (
        Annotated[
            Union[tuple(tables.values())],  # noqa: UP007
            Field(discriminator="kind"),
        ]
        for tables in TABLES.values()
    )

MOST_CONTACTS = 10_000
"""Largest number of contacts: each takes a millisecond at least."""
Values = Number | Annotated[Numbers, Field(max_length=MOST_CONTACTS)]


class Indent(Table):
    """What is solved: exactly one of load, approach and radius."""

    load: Values | None = Field(None, description="Loads, negative for a pulled tip [N].")
    approach: Values | None = Field(None, description="Approaches [m].")
    radius: Values | None = Field(None, description="Contact radii [m].")
    branch: Literal["stable", "unstable"] = Field(
        "stable", description="Branch, if adhesion gives two contacts the same load or approach."
    )
    control: Literal["load", "approach"] = Field(
        "load", description="What is held while the tip is pulled off."
    )
    tolerance: Number | None = Field(
        None,
        description="Largest error of the modulus of the film, as a part of it, that is judged.",
    )

    @model_validator(mode="after")
    def _check_target(self) -> Indent:
        if sum(v is not None for v in (self.load, self.approach, self.radius)) != 1:
            raise ValueError("must have exactly one of load, approach and radius")
        return self


class IndentCase(Bodies):
    """Keys and tables of the case file of an indentation, for ``nacre indent``."""

    solved: ClassVar[tuple[str, ...]] = (
        "materials",
        "body",
        "counterbody",
        "tip",
        "adhesion",
        "indent",
    )

    tip: AnyTip = Field(description="Tip of revolution that is pressed in.")
    adhesion: AnyAdhesion | None = Field(None, description="Adhesion of the surfaces.")
    indent: Indent = Field(description="What is solved.")

    def arguments(self) -> dict[str, Any]:
        """Return the arguments of `nacre.indent.solve`."""
        keywords = self.bodies()
        with at("tip"):
            keywords["tip"] = self.tip.make()
        if self.adhesion is not None:
            with at("adhesion"):
                keywords["adhesion"] = self.adhesion.make()
        return keywords | self.indent.model_dump(exclude_none=True)
