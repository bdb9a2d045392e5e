"""The files of the page: its cards as forms, its script and its style."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

import nacre
from nacre._tools.markup import Markup, Parts, text_of
from nacre.app.cards import Card
from nacre.app.fields import Field
from nacre.results import svg

Files = dict[str, tuple[str, bytes]]

markup = Parts(text_of("nacre.app", "static/page.html"))


def files(cards: Mapping[str, Card]) -> Files:
    """Return type and content of the files of the page by path."""
    first: dict[str, Card] = {}  # of each tab
    for card in cards.values():
        first.setdefault(card.group, card)
    tabs = [markup("tab", name=card.name, group=card.group) for card in first.values()]
    forms = [_form(card, cards.values()) for card in cards.values()]
    script, style = (text_of("nacre.app", f"static/page.{ending}") for ending in ("js", "css"))
    return {
        "/": ("text/html", markup("page", tabs=tabs, forms=forms).encode()),
        "/page.js": ("text/javascript", script.encode()),
        "/page.css": ("text/css", (style + svg.STYLE).encode()),
    }


def _form(card: Card, cards: Iterable[Card]) -> Markup:
    """Return the form of a card: variants, materials, main fields, and all others."""
    kinds = [one for one in cards if one.group == card.group]
    options = [markup("kind", name=one.name, title=one.title) for one in kinds]
    tables: dict[str, list[Markup]] = {}
    for one in card.more:
        tables.setdefault(one.path.partition(".")[0], []).append(_field(card, one))
    return markup(
        "form",
        name=card.name,
        group=card.group,
        menu=markup("menu", options=options) if len(kinds) > 1 else "",
        materials=list(_materials(card)),
        fields=[_field(card, one) for one in card.fields],
        tables=[
            markup("table", name=name, fields=fields) for name, fields in sorted(tables.items())
        ],
    )


def _field(card: Card, one: Field) -> Markup:
    """Return label, input, unit and slider of a field.

    Its key in a link is its last name, where no other field of the card has that.
    """
    lasts = Counter(path.rpartition(".")[2] for path in card.by_path)
    last = one.path.rpartition(".")[2]
    least, most = (one.low, one.high) if one.slides == "linear" else (-1, 1)
    return markup(
        "field",
        **one._asdict(),
        id=f"{card.name}:{one.path}",
        key=last if lasts[last] == 1 else one.path,
        size=one.size,
        placeholder="unknown" if one.may_be_empty else "",
        slider=markup("slider", **one._asdict(), least=least, most=most) if one.slides else "",
    )


def _materials(card: Card) -> Iterator[Markup]:
    """Yield a menu of known materials for each material of a card."""
    known = [_known(one) for one in nacre.materials.values()]
    for name in card.base.get("materials", {}):
        if f"materials.{name}.young" in card.by_path:
            yield markup("materials", name=name, known=known)


def _known(material: nacre.types.Card) -> Markup:
    """Return a known material as an option that holds its numbers in SI."""
    numbers = {key: one.value for key, one in material.numbers.items()}
    sources = "; ".join(dict.fromkeys(one.source for one in material.numbers.values()))
    source = f"{material.title}. {sources}"
    return markup("known", name=material.name, numbers=json.dumps(numbers), source=source)
