"""Materials by name: numbers with their ranges and sources, and the elastic constants they make."""

from __future__ import annotations

import difflib
import html
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from importlib import resources
from types import MappingProxyType
from typing import Any, Literal

import nacre._core as core
from nacre._tools.paths import by_layer
from nacre._tools.typing import ByLayer
from nacre._tools.units import SI, Within, printable, written

NUMBERS = {
    "young": ("Young's modulus", "Pa"),
    "poisson": ("Poisson's ratio", ""),
    "hardness": ("hardness", "Pa"),
    "yield_stress": ("yield stress", "Pa"),
    "flexural_strength": ("flexural strength", "Pa"),
    "conductivity": ("thermal conductivity", "W/(m K)"),
}
"""What the numbers of cards are, with their SI units."""
ASSUMED = "assumed"
"""Source of a Poisson's ratio that was not measured."""


@dataclass(frozen=True)
class Number:
    """A number of a material, in SI, with the range of its sources.

    Examples
    --------
    >>> young = nacre.materials["ta-C"].numbers["young"]
    >>> young.value, young.low, young.high, young.unit
    (572000000000.0, 493000000000.0, 625000000000.0, 'Pa')
    """

    value: float
    """Value that a calculation takes."""
    low: float | None
    """Lower end of the range; None where the source has no range."""
    high: float | None
    """Upper end of the range."""
    unit: str
    """SI unit."""
    source: str
    """Source that was read, or "assumed"."""

    def __str__(self) -> str:
        """Return value, range and source."""
        with Within(SI):  # cards are in SI, whatever the units of results
            text = _text(self.value, self.unit)
            if self.low is not None and self.high is not None:
                text += f" ({_text(self.low, self.unit)} to {_text(self.high, self.unit)})"
        return printable(f"{text}; {self.source}")


def _text(value: float, unit: str) -> str:
    """Return a number with its unit, which prefixes are set before where it is a stress."""
    return written(value, unit) if unit == "Pa" else f"{value:g} {unit}".rstrip()


@dataclass(frozen=True, repr=False)
class Card:
    """A material: numbers with ranges and sources, and its elastic constants.

    Cards come from `nacre.materials`. Strengths are on a card only with their heat treatment;
    limits of fatigue are on none, as no source was read that has cycles and load ratio. Numbers
    of coatings are those of some films: yours has others, within the range or beyond.

    Examples
    --------
    >>> card = nacre.materials["100Cr6"]
    >>> card.elastic
    Elastic(young=203400000000.0, poisson=0.285)
    >>> card.numbers["young"].low, card.numbers["young"].high
    (190000000000.0, 210000000000.0)
    """

    name: str
    """Name, as in `nacre.materials` and in case files."""
    title: str
    """What it is, with its treatment."""
    kind: Literal["body", "coating"]
    """Whether it is a body's material or a coating's."""
    elastic: core.Elastic
    """Elastic constants, of the values of Young's modulus and Poisson's ratio."""
    numbers: Mapping[str, Number] = field(hash=False)
    """Numbers by name: ``young`` and ``poisson``, and others that have a source; read-only."""
    source: str
    """Source of Young's modulus."""
    unsourced: tuple[str, ...] = ()
    """Names of numbers for which no source was found, such as the yield stress of a steel."""

    def __post_init__(self) -> None:
        """Make the numbers read-only."""
        object.__setattr__(self, "numbers", MappingProxyType(dict(self.numbers)))

    def __reduce__(self) -> tuple[object, ...]:
        """Return what makes the card again."""
        values = vars(self) | {"numbers": dict(self.numbers)}
        return Card, tuple(values.values())

    def _scaled(self, size: float) -> Card:
        """Return the card with its stresses in a unit of a size [Pa]."""
        numbers = {
            name: replace(number, value=number.value / size) if number.unit == "Pa" else number
            for name, number in self.numbers.items()
        }
        return replace(self, numbers=numbers)

    @property
    def numbers_in_words(self) -> list[tuple[str, str]]:
        """What each number is, and its value with range and source."""
        known = [(NUMBERS[name][0], str(number)) for name, number in self.numbers.items()]
        return known + [
            (NUMBERS[name][0], "unknown: no source was found") for name in self.unsourced
        ]

    @property
    def gaps(self) -> list[str]:
        """Sentences on the numbers for which no source was found, without full stops."""
        return [
            f"No {NUMBERS[name][0]} of {self.name} with its source was found"
            for name in self.unsourced
        ]

    def __repr__(self) -> str:
        """Return where the card is from."""
        return f"nacre.materials[{self.name!r}]"

    def __str__(self) -> str:
        """Return a table of all numbers with their sources."""
        width = max(len(words) for words, _ in self.numbers_in_words)
        rows = (f"{words:<{width}}  {number}" for words, number in self.numbers_in_words)
        return printable("\n".join([f"{self.name}: {self.title}", *rows]))

    def _repr_html_(self) -> str:
        cells = (
            f"<tr><td>{html.escape(words)}</td><td>{html.escape(number)}</td></tr>"
            for words, number in self.numbers_in_words
        )
        title = html.escape(f"{self.name}: {self.title}")
        return f"<p>{title}</p><table>{''.join(cells)}</table>"


def _card(name: str, entry: Mapping[str, Any]) -> Card:
    """Return the card that an entry of the file describes."""
    numbers = {
        key: Number(row["value"], row.get("low"), row.get("high"), NUMBERS[key][1], row["source"])
        for key, row in entry.items()
        if key in NUMBERS
    }
    elastic = core.Elastic(numbers["young"].value, numbers["poisson"].value)
    source = numbers["young"].source
    unsourced = tuple(entry.get("unsourced", ()))
    return Card(name, entry["title"], entry["kind"], elastic, numbers, source, unsourced)


def _similar(name: object, known: Mapping[str, Card]) -> str:
    """Return in words which cards have a name close to this, or have it in their titles; or ""."""
    text, lower = str(name).casefold(), {card.casefold(): card for card in known}
    close = [lower[folded] for folded in difflib.get_close_matches(text, lower)]
    word = re.compile(rf"(?<!\w){re.escape(text or '-')}(?!\w)")
    titled = [card.name for card in known.values() if word.search(card.title.casefold())]
    titled = [card for card in titled if card not in close]
    hints = [f"close to it are {', '.join(map(repr, close))}"] if close else []
    if titled:
        hints.append(f"it is in the title of {', '.join(map(repr, titled))}")
    return "; ".join(hints)


def unknown(name: object, known: Mapping[str, Card]) -> str:
    """Return a message about a name that no card has, with those that are close or have it."""
    hint = _similar(name, known)
    return f"name must be one of nacre.materials, got {name!r}" + (f"; {hint}" if hint else "")


class Materials(Mapping[str, Card]):
    """Materials by name, read-only, as `nacre.materials`.

    Examples
    --------
    >>> "TiN" in nacre.materials, nacre.materials["Si3N4"].elastic.young / 1e9
    (True, 310.0)
    >>> coating = nacre.Layer(nacre.materials["ta-C"].elastic, thickness=2e-6)
    """

    @cached_property
    def _cards(self) -> dict[str, Card]:
        """Cards of the file, which is read when the first one is used."""
        text = resources.files("nacre").joinpath("materials.toml").read_text("utf-8")
        return {name: _card(name, entry) for name, entry in tomllib.loads(text).items()}

    def __getitem__(self, name: str) -> Card:
        """Return the card of a name, or raise a `KeyError` that names others."""
        if isinstance(name, str) and name in self._cards:
            return self._cards[name]
        hint = _similar(name, self._cards)
        names = "" if hint else f"; the names are {', '.join(map(repr, self._cards))}"
        raise KeyError(unknown(name, self._cards) + names)

    def __iter__(self) -> Iterator[str]:
        """Return the names in the order of the file."""
        return iter(self._cards)

    def __len__(self) -> int:
        """Return the number of cards."""
        return len(self._cards)

    def __repr__(self) -> str:
        """Return the names."""
        return f"<nacre.materials: {', '.join(self)}>"

    def __reduce__(self) -> str:
        """Return the name under which the one instance is known."""
        return "materials"


materials = Materials()
"""Materials by name, each a `nacre.types.Card`."""

Limits = Mapping[int | str, float | Card] | Sequence[float | Card | None]
"""Limits of layers, by number or name or from the surface down; cards stand for their numbers."""


def numbers_of(limits: Limits | None, name: str) -> ByLayer | None:
    """Return limits with the numbers of this name of cards in place of these."""

    def number(limit: Any) -> Any:
        known = limit.numbers.get(name) if isinstance(limit, Card) else None
        return known.value if known else None if isinstance(limit, Card) else limit

    limits = by_layer(limits)
    if isinstance(limits, Mapping):
        numbers = {key: number(limit) for key, limit in limits.items()}
        return {
            k: v for k, v in numbers.items() if v is not None or not isinstance(limits[k], Card)
        }
    plain: Any = [*map(number, limits)] if isinstance(limits, list | tuple) else limits
    return plain  # type: ignore[no-any-return]


def names_of(limits: Limits | None, body: object) -> tuple[str | None, ...] | None:
    """Return the names of the cards in limits of a body, from the surface down; None without."""
    limits = by_layer(limits)
    if isinstance(limits, Mapping) and isinstance(body, core.HalfSpace):
        known = {key: limit.name for key, limit in limits.items() if isinstance(limit, Card)}
        numbers = {key: float(place) for place, key in enumerate(known)}
        places = core.layer_values(body, "limits", numbers)
        names = [None if place is None else [*known.values()][int(place)] for place in places]
    else:
        entries = limits if isinstance(limits, list | tuple) else ()
        names = [limit.name if isinstance(limit, Card) else None for limit in entries]
    return tuple(names) if any(names) else None
