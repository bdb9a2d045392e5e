"""The files of the page: its cards as forms, its script and its style."""

from __future__ import annotations

import html
import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from importlib import resources
from string import Template

import nacre
from nacre.app.cards import Card
from nacre.app.fields import Field
from nacre.results import svg

Files = dict[str, tuple[str, bytes]]


class Markup(str):
    """Text that is markup, of which nothing is escaped."""


def _text(name: str) -> str:
    return (resources.files(__package__) / "static" / name).read_text("utf-8")


_, *SPLIT = re.split(r"<!-- (\w+) -->\n", _text("page.html"))
PARTS = {name: Template(part.rstrip()) for name, part in zip(SPLIT[::2], SPLIT[1::2], strict=True)}
"""Parts of the page by name, with places for values."""


def _part(name: str, /, **values: object) -> Markup:
    """Return a part of the page with values in its places: markup, numbers, and text."""
    return Markup(PARTS[name].substitute({place: _written(one) for place, one in values.items()}))


def _written(value: object) -> str:
    if isinstance(value, Markup):
        return value
    if isinstance(value, float):
        return f"{value:.12g}"
    return "" if value is None else html.escape(str(value))


def _joined(parts: Iterable[Markup]) -> Markup:
    return Markup("".join(parts))


def files(cards: Mapping[str, Card]) -> Files:
    """Return type and content of the files of the page by path."""
    first: dict[str, Card] = {}  # of each tab
    for card in cards.values():
        first.setdefault(card.group, card)
    tabs = (_part("tab", name=card.name, group=card.group) for card in first.values())
    forms = (_form(card, cards.values()) for card in cards.values())
    page = _part("page", tabs=_joined(tabs), forms=_joined(forms))
    return {
        "/": ("text/html", page.encode()),
        "/page.js": ("text/javascript", _text("page.js").encode()),
        "/page.css": ("text/css", (_text("page.css") + svg.STYLE).encode()),
    }


def _form(card: Card, cards: Iterable[Card]) -> Markup:
    """Return the form of a card: variants, materials, main fields, and all others."""
    kinds = [
        _part("kind", name=one.name, title=one.title) for one in cards if one.group == card.group
    ]
    tables = sorted({one.path.partition(".")[0] for one in card.more})
    groups = ([one for one in card.more if one.path.startswith(f"{name}.")] for name in tables)
    return _part(
        "form",
        name=card.name,
        group=card.group,
        menu=_part("menu", kinds=_joined(kinds)) if len(kinds) > 1 else "",
        materials=_joined(_materials(card)),
        fields=_fields(card, card.fields),
        tables=_joined(
            _part("table", name=name, fields=_fields(card, group))
            for name, group in zip(tables, groups, strict=True)
        ),
    )


def _fields(card: Card, fields: Iterable[Field]) -> Markup:
    """Return label, input, unit and slider of fields.

    The key of one in a link is its last name, if no other field of the card has that.
    """
    counts = Counter(_last(path) for path in card.by_path)
    parts = []
    for one in fields:
        least, most = (one.low, one.high) if one.slides == "linear" else (-1, 1)
        slider = _part("slider", **one._asdict(), least=least, most=most) if one.slides else ""
        key = _last(one.path) if counts[_last(one.path)] == 1 else one.path
        own = {"id": f"{card.name}:{one.path}", "key": key, "size": one.size, "slider": slider}
        empty = "unknown" if one.may_be_empty else ""
        parts.append(_part("field", **one._asdict(), **own, placeholder=empty))
    return _joined(parts)


def _last(path: str) -> str:
    return path.rpartition(".")[2]


def _materials(card: Card) -> Iterator[Markup]:
    """Yield a menu of known materials for each material of a card."""
    known = _joined(map(_known, nacre.materials.values()))
    for name in card.base.get("materials", {}):
        if f"materials.{name}.young" in card.by_path:
            yield _part("materials", name=name, known=known)


def _known(material: nacre.types.Card) -> Markup:
    """Return a known material as an option that holds its numbers in SI."""
    numbers = {key: one.value for key, one in material.numbers.items()}
    sources = "; ".join(dict.fromkeys(one.source for one in material.numbers.values()))
    source = f"{material.title}. {sources}"
    return _part("known", name=material.name, numbers=json.dumps(numbers), source=source)
