"""The files of the page: its cards as forms, its script and its style."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

import nacre
from nacre._tools.markup import Markup, Parts, text_of
from nacre.app.cards import Card
from nacre.app.fields import Field
from nacre.app.line import LINES
from nacre.results import svg

ONLY_TIPS = ("diamond",)
"""Bodies of which tips alone are made."""
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


def opened(card: Card) -> dict[str, str]:
    """Return the form of a card of files that were opened, and its tab."""
    return {"form": _form(card, [card]), "tab": markup("tab", name=card.name, group=card.group)}


def _form(card: Card, cards: Iterable[Card]) -> Markup:
    """Return the form of a card: variants, materials, main fields, and all others."""
    kinds = [variant for variant in cards if variant.group == card.group]
    options = [markup("kind", name=variant.name, title=variant.title) for variant in kinds]
    tables: dict[str, list[Markup]] = {}
    for field in card.more:
        tables.setdefault(field.path.partition(".")[0], []).append(_field(card, field))
    return markup(
        "form",
        name=card.name,
        group=card.group,
        line=markup("line", name=card.name) if card.name in LINES else "",
        menu=markup("menu", options=options) if len(kinds) > 1 else "",
        materials=list(_materials(card)),
        fields=[_field(card, field) for field in card.fields],
        tables=[
            markup("table", name=name, fields=fields) for name, fields in sorted(tables.items())
        ],
    )


def _field(card: Card, field: Field) -> Markup:
    """Return label, input or menu, unit and slider of a field.

    Its key in a link is its last name, where no other field of the card has that.
    """
    lasts = Counter(path.rpartition(".")[2] for path in card.by_path)
    last = field.path.rpartition(".")[2]
    least, most = (field.low, field.high) if field.slides == "linear" else (-1, 1)
    parts = field._asdict() | {
        "id": f"{card.name}:{field.path}",
        "key": last if lasts[last] == 1 else field.path,
        "size": field.size,
        "placeholder": "unknown" if field.may_be_empty else "",
        "options": [
            markup("word", word=word, selected="selected" if word == field.default else "")
            for word in field.choices
        ],
    }
    return markup(
        "field",
        **parts,
        input=markup("choice" if field.choices else "input", **parts),
        slider=markup("slider", **parts, least=least, most=most) if field.slides else "",
    )


def _materials(card: Card) -> Iterator[Markup]:
    """Yield a menu of known materials for each material of a card: of coatings, or of bodies."""
    parts = [*map(card.base.get, ("body", "counterbody")), *card.base.get("bearing", {}).values()]
    bodies = [body for body in parts if isinstance(body, dict)]
    layers = {layer["material"] for body in bodies for layer in body.get("layers", ())}
    for name in card.base.get("materials", {}):
        if f"materials.{name}.young" in card.by_path:
            kind = "coating" if name in layers else "body"
            left = () if "tip" in card.base else ONLY_TIPS
            known = [
                _known(each)
                for each in nacre.materials.values()
                if each.kind == kind and each.name not in left
            ]
            yield markup("materials", name=name, known=known)


def _known(material: nacre.types.Card) -> Markup:
    """Return a known material as an option that holds its numbers in SI.

    What is brittle has no yield stress: null. Other numbers that a card has not stay as typed.
    """
    numbers = {key: number.value for key, number in material.numbers.items()}
    is_brittle = material.kind == "body" and "yield_stress" not in {*numbers, *material.unsourced}
    own: dict[str, float | None] = {"yield_stress": None} if is_brittle else {}
    sources = "; ".join(dict.fromkeys(number.source for number in material.numbers.values()))
    source = ". ".join([sources, *material.gaps])
    return markup(
        "known",
        name=material.name,
        numbers=json.dumps(own | numbers),
        title=material.title,
        source=source,
    )
