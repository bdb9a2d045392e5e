"""The files of the page: its cards as forms, its script and its style."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable, Mapping
from importlib import resources
from itertools import groupby

import nacre
from nacre.app.cards import Card
from nacre.app.fields import Field
from nacre.results import svg

Files = dict[str, tuple[str, bytes]]


def files(cards: Mapping[str, Card]) -> Files:
    """Return type and content of the files of the page by path."""
    folder = resources.files(__package__) / "static"
    names = ("page.html", "page.js", "page.css")
    texts = {name: (folder / name).read_text("utf-8") for name in names}
    first: dict[str, Card] = {}  # of each tab
    for card in cards.values():
        first.setdefault(card.group, card)
    tabs = "".join(map(_tab, first.values()))
    markup = texts["page.html"].replace("<!-- tabs -->", tabs)
    forms = "".join(_form(card, cards) for card in cards.values())
    markup = markup.replace("<!-- cards -->", forms)
    return {
        "/": ("text/html", markup.encode()),
        "/page.js": ("text/javascript", texts["page.js"].encode()),
        "/page.css": ("text/css", (texts["page.css"] + svg.STYLE).encode()),
    }


def _tab(card: Card) -> str:
    group, name = html.escape(card.group), html.escape(card.name)
    return (
        f'<button type="button" class="tab" data-group="{group}" data-testid="card:{name}">'
        f"{group}</button>"
    )


def _form(card: Card, cards: Mapping[str, Card]) -> str:
    """Return the form of a card: variants, materials, main fields, and all others."""
    variants = [one for one in cards.values() if one.group == card.group]
    options = "".join(
        f'<option value="{one.name}"{" selected" * (one is card)}>{html.escape(one.title)}</option>'
        for one in variants
    )
    menu = f'<label class="menu">kind <select class="variant">{options}</select></label>'
    paths = [one.path.rpartition(".")[2] for one in card.by_path.values()]
    keys = {
        path: last if paths.count(last) == 1 else path
        for path, last in zip(card.by_path, paths, strict=True)
    }
    main = "".join(_field(card.name, one, keys[one.path]) for one in card.fields)
    others = [
        f"<fieldset><legend>{html.escape(table)}</legend>"
        f"{''.join(_field(card.name, one, keys[one.path]) for one in members)}</fieldset>"
        for table, members in _by_table(card.more)
    ]
    return (
        f'<form data-card="{card.name}" data-group="{html.escape(card.group)}" hidden '
        f'autocomplete="off">'
        f"{menu if len(variants) > 1 else ''}{''.join(_materials(card))}{main}"
        f'<details data-testid="more"><summary>more …</summary>{"".join(others)}</details></form>'
    )


def _by_table(fields: Iterable[Field]) -> list[tuple[str, list[Field]]]:
    def table(one: Field) -> str:
        return one.path.partition(".")[0]

    return [(name, list(members)) for name, members in groupby(sorted(fields, key=table), table)]


def _field(card: str, one: Field, key: str) -> str:
    """Return label, input, unit and slider of a field."""
    path, label, words = (html.escape(text) for text in (one.path, one.label, one.help))
    name = html.escape(f"{card}:{one.path}")
    default = "" if one.default is None else f"{one.default:.12g}"
    bounds = f'data-low="{one.low:g}" data-high="{one.high:g}"'
    about = f'aria-describedby="{name}:help" title="{words}"' if words else ""
    note = f'<span class="help" id="{name}:help">{words}</span>' if words else ""
    slider = ""
    if one.slides:
        ends = (one.low, one.high) if one.slides == "linear" else (-1, 1)
        slider = (
            f'<input type="range" data-testid="slider:{path}" data-scale="{one.slides}" {bounds} '
            f'min="{ends[0]:g}" max="{ends[1]:g}" step="any" aria-label="{label}, slider">'
        )
    empty = ' placeholder="unknown"' if one.may_be_empty else ""
    return (
        f'<div class="field"><label for="{name}">{label}</label>'
        f'<input id="{name}" name="{path}" data-key="{html.escape(key)}" '
        f'data-testid="field:{path}" '
        f'data-default="{default}" value="{default}" data-si="{one.size:g}" inputmode="decimal" '
        f'{about}{empty}><span class="unit">{html.escape(one.unit)}</span>{slider}{note}</div>'
    )


def _materials(card: Card) -> Iterable[str]:
    """Yield a menu of known materials for each material of a card."""
    for name, table in card.base.get("materials", {}).items():
        if isinstance(table, Mapping) and f"materials.{name}.young" in card.by_path:
            label = html.escape(name)
            yield (
                f'<label class="menu">{label} <select class="material" data-material="{label}">'
                f'<option value="">own numbers</option>{_options()}</select></label>'
                f'<p class="source" hidden></p>'
            )


def _options() -> str:
    """Return the known materials as options that hold their numbers in SI."""
    texts = []
    for name, card in nacre.materials.items():
        numbers = json.dumps({key: one.value for key, one in card.numbers.items()})
        source = "; ".join(dict.fromkeys(one.source for one in card.numbers.values()))
        texts.append(
            f'<option data-numbers="{html.escape(numbers)}" '
            f'data-source="{html.escape(f"{card.title}. {source}")}">{html.escape(name)}</option>'
        )
    return "".join(texts)
