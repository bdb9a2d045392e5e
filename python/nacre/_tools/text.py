"""Text files of instruments: their encoding, the fields of a line, and names with units."""

from __future__ import annotations

import codecs
import csv
import re
import unicodedata
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from nacre._tools.units import SIZES, size_of

MISSING = frozenset(
    "|-|--|---|*|***|?|#n/a|bad|invalid|masked|missing|n/a|na|nan|no data|none|null|void".split("|")
)
"""Words, in small letters, that stand for a point that was not measured."""

PREFIXES = {"pico": 1e-12, "nano": 1e-9, "micro": 1e-6, "milli": 1e-3, "mili": 1e-3, "mil": 1e-3}
PREFIXES |= {"centi": 1e-2, "zenti": 1e-2, "": 1.0, "kilo": 1e3, "quilo": 1e3, "mega": 1e6}
WORD = re.compile(
    rf"({'|'.join(PREFIXES)})[ -]?"
    r"(?:(met(?:er|re|ro|ri|r)(?:n|s)?)|(newtons?)|(secs?|second(?:[eio]|es)?s?|segundos?|sekunden?))"
)
"""Units in words without accents, in some languages: metres, newtons and seconds."""
LENGTHS = (
    (re.compile(r"angstr[oø]ms?|å"), 1e-10),
    (re.compile(r"microns?|micron[ei]|micras?"), 1e-6),
    (re.compile(r"inch(es)?"), 0.0254),
    (re.compile(r"mils?"), 2.54e-5),
)
"""Other names of lengths; a mil is a thousandth of an inch."""
FORCES = {"gf": 9.80665e-3, "mgf": 9.80665e-6, "kgf": 9.80665}
"""Grams-force in newtons: the gram times the standard acceleration of free fall, 9.80665 m/s²."""
UNIT_LAST = (
    re.compile(r"(.*?)\s*[(\[{]\s*([^()\[\]{}]+?)\s*[)\]}]"),
    re.compile(r"(.+?)\s*/\s*(\S+)"),
    re.compile(r"(.+?)(?:\s*,\s*|\s+in\s+|[_\s]+)(\S+)"),
)
"""Names that end in a unit: ``Depth (nm)``, ``h/µm``, and ``h_nm``, ``Load, mN``, ``h in µm``."""
CONTROLS = bytes([*range(0x09), *range(0x0E, 0x1A), *range(0x1C, 0x20)])
"""Bytes that no text has but for its padding: those of white space, end of file and escape are."""
LONGEST_HEADING = 200
"""Most characters of a heading with a unit: the time that it takes grows with a power of it."""


class Column(NamedTuple):
    """A column's heading as the file writes it, and what it says."""

    heading: str
    """Heading as written, with the unit; empty where the file has none."""
    name: str
    """Name without the unit."""
    unit: str | None
    """Unit: in a name one of length, force or time, in a row of units any."""


def is_text(content: bytes) -> bool:
    """Return whether the bytes of a file are text, in an encoding that `decoded` knows."""
    is_wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or wide(content)
    return bool(is_wide) or _is_clean(content) or _is_clean(content.rstrip(b"\0\x1a\r\n "))


def _is_clean(content: bytes) -> bool:
    return len(content.translate(None, CONTROLS)) == len(content)


def wide(content: bytes) -> str | None:
    """Return the kind of UTF-16 without a mark that bytes seem to be, or None.

    Every second byte of numbers and English in UTF-16 is zero.
    """
    start = content[:1000]
    for name, zeros in (("utf-16-le", start[1::2]), ("utf-16-be", start[::2])):
        if zeros.count(0) > 0.5 * len(zeros) > 0 and start.count(0) <= 0.5 * len(start):
            return name
    return None


def decoded(path: Path, encoding: str | None = None) -> str:
    """Return the text of a file in UTF-8, UTF-16 or else Windows' extension of Latin-1."""
    content = path.read_bytes()
    if encoding is not None:
        try:
            return content.decode(encoding)
        except (LookupError, UnicodeError) as error:
            raise ValueError(
                f"encoding must suit {str(path)!r}, got {encoding!r}: {error}"
            ) from None
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return content.decode("utf-16", errors="replace")
    if (name := wide(content)) is not None:
        return content.decode(name, errors="replace")
    if not is_text(content):
        raise ValueError(
            f"{str(path)!r} must be text, got binary data; export it as text or CSV from the "
            f"instrument's program"
        )
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252", errors="replace")


def listed(texts: Sequence[str], most: int = 10) -> str:
    """Return texts as a list with commas, of which the first ones are shown."""
    more = len(texts) - most
    return ", ".join(texts[:most]) + (f" and {more} more" if more > 0 else "")


def fields_of(line: str, delimiter: str) -> list[str]:
    """Return the fields of a line, without quotes and blanks around them."""
    if delimiter == " ":
        return [text.strip("\"'") for text in line.split()]
    if '"' in line:
        with suppress(csv.Error):  # of a field that is longer than numbers and names are
            texts = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
            return [text.strip() for text in texts]
    return [text.strip(" \t\xa0'") for text in line.split(delimiter)]


def unit_of(text: str) -> tuple[str, float] | None:
    """Return "m", "N" or "s" and the size in it of a unit such as "nm" or "uN", if it is known.

    >>> unit_of("nm"), unit_of("uN"), unit_of("V")
    (('m', 1e-09), ('N', 1e-06), None)
    """
    # A text in UTF-8 that was once read as Latin-1 has "Âµ".
    text = text.strip().replace("μ", "µ").replace("Âµ", "µ")
    letters = unicodedata.normalize("NFKD", text.lower().rstrip("."))
    word = "".join(c for c in letters if not unicodedata.combining(c)).replace("mikro", "micro")
    if match := WORD.fullmatch(word):
        return ("m" if match[2] else "N" if match[3] else "s"), PREFIXES[match[1]]
    for names, size in LENGTHS:
        if names.fullmatch(word) or names.fullmatch(text.lower()):
            return "m", size
    if len(text) > 1 and text.startswith("u"):
        text = "µ" + text[1:]
    if text == "min":
        return "s", 60.0
    if text.endswith("s") and text[:-1] in {"", "m", "µ"}:
        return "s", SIZES[text[:-1]]
    if text in FORCES:
        return "N", FORCES[text]
    known = size_of(text)
    if known is None and text in ("MM", "UM", "NM"):  # headings are often in capitals
        known = size_of(text.lower().replace("u", "µ"))
    return known if known is not None and known[0] in ("m", "N") else None


def column_of(heading: str) -> Column:
    for pattern in UNIT_LAST if len(heading) <= LONGEST_HEADING else ():
        match = pattern.fullmatch(heading)
        if match and unit_of(match[2]):
            return Column(heading, match[1].strip(" _,"), match[2])
    return Column(heading, heading, None)
