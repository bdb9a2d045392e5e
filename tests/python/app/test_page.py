"""The files of the page: contrasts of its colours, menus and labels."""

from __future__ import annotations

import re

import pytest

from nacre.app.cards import cards
from nacre.app.page import files

STYLE = files(cards())["/page.css"][1].decode()
PAPERS = {
    "paper": ("ink", "soft", "faded", "link", "warn"),
    "desk": ("ink", "soft", "faded"),
    "note": ("ink",),
    "bad-paper": ("bad-ink",),
    "link": ("on",),
}
"""Colours of texts by those of what is behind them: stale and disabled ones are faded."""
EDGES = {"paper": ("edge", "bad", "fair", "good", "ring", "c0"), "desk": ("edge", "ring")}
"""Colours of frames, curves and bars, which are no text."""


def schemes() -> dict[str, dict[str, str]]:
    """Return the colours by name of the light page, the dark one and the printed one."""
    blocks = re.findall(r":root\{(.*?)\}", STYLE)
    return dict(
        zip(
            ("light", "dark", "print"),
            (dict(re.findall(r"--([\w-]+):(#\w+)", block)) for block in blocks),
            strict=True,
        )
    )


def luminance(colour: str) -> float:
    """Return the relative luminance of a colour: WCAG 2.2."""
    digits = colour[1:] if len(colour) == 7 else "".join(2 * digit for digit in colour[1:])
    shares = [int(digits[k : k + 2], 16) / 255 for k in (0, 2, 4)]
    linear = [s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4 for s in shares]
    return sum(part * c for part, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one: str, other: str) -> float:
    """Return the contrast of two colours: WCAG 2.2."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark", "print"])
def test_colours_have_the_contrast_of_level_aa(scheme: str) -> None:
    colours = schemes()["light"] | schemes()[scheme]
    for pairs, least in ((PAPERS, 4.5), (EDGES, 3.0)):
        for paper, names in pairs.items():
            for name in names:
                got = contrast(colours[name], colours[paper])
                assert got >= least, (scheme, name, paper, got)


def test_texts_have_no_colours_but_those_of_schemes() -> None:
    own = STYLE[STYLE.rindex("--c6") :].partition("svg text{font")[0]
    assert re.findall(r"[;{]color:#\w+", own) == []
    assert "opacity" not in re.sub(r"\.stale polyline.*?\}|::placeholder.*?\}", "", own)


@pytest.mark.parametrize("name", cards())
def test_labels_are_words_and_fields_are_few(name: str) -> None:
    card = cards()[name]
    assert 5 <= len(card.fields) <= 10
    labels = [field.label for field in card.by_path.values()]
    assert len(set(labels)) == len(labels)
    for label in labels:
        assert not re.search(r"_|\[|\b(solve|materials|body)\b|\b\d$", label), label


def test_tabs_are_trades() -> None:
    page = files(cards())["/"][1].decode()
    tabs = re.findall(r'class="tab"[^>]*>([^<]*)<', page)
    assert tabs == ["Bearing", "Coated contact", "Indentation", "Wear and rolling"]


def test_tips_alone_are_of_diamond() -> None:
    page = files(cards())["/"][1].decode()
    forms = dict(re.findall(r'<form name="([\w-]+)"(.*?)</form>', page, re.DOTALL))
    assert {name for name, form in forms.items() if ">diamond</option>" in form} <= {
        "indentation",
        "cone",
    }
    assert ">diamond</option>" in forms["cone"]
