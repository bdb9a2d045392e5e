"""Table of case files for histories of wear."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal

from pydantic import Field

import nacre
from nacre._tools.paths import by_layer
from nacre.case.friction import SHARED
from nacre.case.tables import Count, Number, Numbers, Table, from_signature, with_words

MOST_STATES = 10_000
"""Largest number of ends of steps: each takes a hundredth of a second at least."""
AnyRate = Annotated[
    Number | dict[str, Number],
    with_words('a finite number, or a table of them by layer or material and "substrate"'),
]
AnySteps = Annotated[
    Literal["auto"] | Count | Annotated[Numbers, Field(min_length=1, max_length=MOST_STATES)],
    with_words('"auto", an integer above 0, or a list of finite numbers'),
]
RATE = (
    "Specific wear rate κ of the {} [m²/N], at least 0: one number, or one of each layer, by its "
    'number, its name or that of its material, and of the "substrate". 1 m²/N is 1e9 mm³/(N m).'
)
TEXTS = {
    "rate": RATE.format("body"),
    "counter_rate": RATE.format("counterbody, or of the rigid shape"),
    "cycles": "Number of fretting cycles; the steps of `[slide]` are one.",
    "passes": "Number of passes of a wheel, which rolls as `[roll]` says.",
    "store": "File `.nc` in the folder of the case for the history in the end. Each state is added "
    "to a `.journal` beside it; where there is one, the calculation goes on from it.",
}
"""Descriptions of keys that are not those of the keywords."""


@from_signature(
    nacre.wear, SHARED, TEXTS, rate=AnyRate, counter_rate=AnyRate, steps=AnySteps, store=str | None
)
class Wear(Table):
    """Dry wear over one of sliding, cycles and passes; load and tilts stand in `[solve]`."""

    required_distance: Number | None = Field(
        None,
        description="Distance [m], cycles or passes, after which no layer may be through, for the "
        "verdict.",
    )

    def keywords(self) -> dict[str, Any]:
        """Return the keywords of `nacre.wear`."""
        arguments = super().keywords()
        arguments.pop("required_distance", None)
        return arguments


def numbers_by_layer(given: float | Mapping[str, float], names: Sequence[Sequence[str]]) -> Any:
    """Return a number or numbers by layer as calls take them, by the numbers of layers.

    Each part of the body, from the surface down, has its names, the first of which is its key.
    A `ValueError` names the keys that there may be.
    """
    if not isinstance(given, Mapping):
        return given
    if not names:
        raise ValueError("must be a number, as the shape is rigid without a counterbody")
    values = {str(key): value for key, value in by_layer(given).items()}
    known = list(dict.fromkeys(name for aliases in names for name in aliases))
    if unknown := [key for key in values if key not in known]:
        raise ValueError(f"must have keys among {', '.join(known)}, got {unknown[0]!r}")
    own_names = [next((name for name in aliases if name in values), None) for aliases in names]
    keys = [int(aliases[0]) if aliases[0].isdigit() else aliases[0] for aliases in names]
    return {
        key: values[name] for key, name in zip(keys, own_names, strict=True) if name is not None
    }
