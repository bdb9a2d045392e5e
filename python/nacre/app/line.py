"""A line of text on a bearing, such as "6205, C 14.8 kN, Fr 2 kN, 1500/min": what it says."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from nacre._tools.markup import text_of
from nacre._tools.notices import heard
from nacre._tools.units import number_in
from nacre.app.answer import Measured
from nacre.app.cards import MOST, Card
from nacre.app.fields import Field, FieldError
from nacre.bearing import compare_ratings, estimated_balls
from nacre.bearing.modified import SMALL
from nacre.results.rows import remark

TABLES: dict[str, dict[str, Any]] = tomllib.loads(text_of("nacre.app", "line.toml"))
"""Symbols, units and dimensions of bearings."""
SYMBOLS = TABLES["symbols"]
BY_KEY = {key: name for name, symbol in SYMBOLS.items() for key in symbol.get("keys", ())}
"""Names of symbols by the words before their numbers."""
NEEDED = dict(C="capacity", C0="static_capacity", d="bore", D="outside_diameter")
"""Arguments from which balls are estimated, by symbol."""
ESTIMATED = ("count", "diameter", "pitch_diameter")
"""Arguments of a bearing that are estimated."""
SHORT = 3
"""Number of digits of a designation whose last one is the bore [mm]: 608."""
TINY = 1e-6
"""Difference of dimensions of one bearing [m]; the next in a series differ by millimetres."""
LINES = ("bearing", "ball-bearing")
"""Cards that a line fills."""
LONGEST = 300
"""Largest number of characters of a line."""
NUMBER = r"[-+−]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?(?![\d.,])"
KEYS = "|".join(sorted(BY_KEY, key=len, reverse=True))
ITEM = re.compile(
    rf"(?:(?P<key>{KEYS})\s*[=:]?\s*)?(?P<number>{NUMBER})(?:(?P<gap>\s*)(?P<unit>1/\S+|[^\s\d]\S*))?"
)
"""A number with what is before and after it."""
THOUSANDS = re.compile(r"(?<![\w.,])(?:[1-9]\d{0,2}[.,]\d{3}(?!\d)|\d{1,3}(?:\s\d{3})+(?!\S*\d))")
"""Numbers in which a mark or a blank may be one of thousands: 14.800, 1 500."""
DESIGNATION = re.compile(
    r"(?:(?P<rollers>NUP|NU|NJ|NF|N)[ -]?(?P<size>(?:10|2[23]?|3|4)\d\d)|(?P<code>\d{3,5}))(?!\d)"
    r"(?:[-/]?[A-Z\d][\w/-]*)?(?: (?:C[2-5]|CN|2?RS\d?|2Z|ZZ|EC[PJM]?))*(?!\S)"
)
"""Designation of a bearing, with its suffixes."""
DEEP_GROOVE = re.compile(r"(?:6[0234]|16[01]|6[123]\d)\d\d|6[0-3][1-9]")
"""Designations of deep-groove ball bearings."""


class Line(NamedTuple):
    """What a line says, and what it does not say clearly."""

    designation: str
    """Designation without its suffixes, or ""; those of rollers begin with a letter."""
    values: dict[str, float | str]
    """Numbers in the units of line.toml, and the word for the cleanliness, by symbol."""
    asked: list[str]
    """Sentences on what was not understood, or is missing."""


class Filled(NamedTuple):
    """Fields that a line fills."""

    card: str
    """Name of the card."""
    values: dict[str, str]
    """Texts of fields, by path."""
    estimated: dict[str, str]
    """Those of them that are estimated."""
    note: str
    """From what they are estimated, and how they agree with ISO 281 and ISO 76."""
    asked: list[str]
    """Sentences on what was not understood, or is missing."""


def read(text: str) -> Line:
    """Return what a line of text says of a bearing; nothing in it is guessed.

    Parts are separated by commas, semicolons or blanks; a comma between digits is a decimal one. A
    part is a symbol and a number with its unit, a number whose unit is certain (1/min, h, °C), a
    degree of cleanliness of ISO 281, or at the beginning a designation.

    Parameters
    ----------
    text
        Line of text.

    Returns
    -------
    Line
        Designation, values and what was not understood.

    Examples
    --------
    >>> line = read("6205, C 14,8 kN, 1500/min, about 2 kN")
    >>> line.designation, line.values["C"], line.asked
    ('6205', 14800.0, ['not understood: "about 2 kN"'])
    """
    line = Line("", {}, [])
    if len(text) > LONGEST:
        return line._replace(asked=[f"a line has at most {LONGEST} characters"])
    parts = (" ".join(part.split()) for part in re.split(r"[;\n]|,(?!\d)|(?<!\d),", text))
    for number, spaced in enumerate(filter(None, parts)):
        part = re.sub(r"(?<=\d) (?=000\b)", "", spaced)  # 20 000
        if THOUSANDS.search(part):
            line.asked.append(
                f'"{part}": write numbers without blanks, and not with three decimals'
            )
            continue
        pieces = list(_pieces(part, not number))
        for at, (piece, known) in enumerate(pieces):
            beside = pieces[max(0, at - 1) : at + 2]
            if known and any(other is None for _, other in beside):
                known = {}  # what is beside may be part of it
                pieces[at] = piece, known
            for name, value in (known or {}).items():
                if name == "designation":
                    line = line._replace(designation=str(value))
                elif name in line.values:
                    line.asked.append(f"{name} is given twice: {piece} was left out")
                else:
                    line.values[name] = value
        unknown = " ".join(piece for piece, known in pieces if not known)
        if unknown:
            line.asked.append(f'not understood: "{unknown}"')
    return line


def _pieces(part: str, is_first: bool) -> Iterator[tuple[str, dict[str, float | str] | None]]:
    """Yield the pieces of a part, and what each says; None of what is not understood."""
    at = 0
    while at < len(part):
        rest = part[at:]
        known: dict[str, float | str] | None
        words = next((word for word in SMALL if rest.lower().startswith(word)), "")
        if words and not rest[len(words) :].strip()[:1].isalnum():
            length, known = len(words), {"cleanliness": words}
        else:
            length, known = _item(rest)
            named = DESIGNATION.match(rest)
            if known is None and named and (named["rollers"] or (is_first and at == 0)):
                name = f"{named['rollers']} {named['size']}" if named["rollers"] else named["code"]
                length, known = named.end(), {"designation": name}
        length = length or len(rest.split(" ")[0])
        yield rest[:length], known
        at += length + (part[at + length : at + length + 1] == " ")


def _item(rest: str) -> tuple[int, dict[str, float | str] | None]:
    """Return length and meaning of the number at the beginning of a text, if it has one."""
    found = ITEM.match(rest)
    if found is None:
        return 0, None
    number, unit = found["number"].replace(",", "."), found["unit"] or ""
    unit = str(TABLES["spellings"].get(unit, unit))
    name = BY_KEY[found["key"]] if found["key"] else TABLES["names"].get(unit, "")
    certain = SYMBOLS[name].get("certain", "") if found["key"] else ""
    if not name:
        return 0, None
    value = _value(name, f"{number} {unit}") if unit else None
    if value is None and certain and (found["gap"] or not unit):
        end = found.end("number")
        value = _value(name, f"{number} {certain}" if certain != "1" else number)
    else:
        end = found.end()
    return (end, {name: value}) if value is not None else (end if unit else 0, None)


def _value(name: str, text: str) -> float | None:
    """Return a number with its unit in the unit of a symbol, None if it cannot be one."""
    try:
        if name == "T":
            return float(text.removesuffix("°C")) if text.endswith("°C") else None
        if not (unit := SYMBOLS[name].get("unit")):
            allowed = TABLES["grades"].get(name, range(1, MOST["elements"] + 1))
            return float(text) if float(text) in allowed else None
        value = number_in(unit, text)
    except ValueError:
        return None
    return value if value > 0 or (name in ("Fa", "tilt") and value == 0) else None


def filled(text: str, cards: Mapping[str, Card], current: str) -> Filled:
    """Return the fields that a line fills, of the current card or of its designation's.

    Balls are estimated from C, C_0, d and D together, by `nacre.bearing.estimated_balls`.
    """
    line = read(text)
    asked, values, name = line.asked, dict[str, str](), line.designation
    is_roller = name[:1].isalpha()
    if name and not (is_roller or DEEP_GROOVE.fullmatch(name)):
        kinds = "deep-groove ball bearings and cylindrical roller bearings"
        asked.append(f"the page has cards of {kinds}, and none of a {name}: nothing is filled in")
        return Filled(current, {}, {}, "", asked)
    card = cards[("bearing" if is_roller else "ball-bearing") if name else current]
    is_radial = "Fr" in line.values and "Fa" not in line.values
    line.values.update({"Fa": 0.0} if is_radial else {})
    for symbol, value in line.values.items():
        if not (target := SYMBOLS[symbol].get("target")):
            continue
        if (field := card.by_path.get(target)) is None:
            asked.append(f"{symbol} was left out: the card has no field for it")
            continue
        try:
            typed = _typed(field, value, SYMBOLS[symbol].get("unit", ""))
            field.number(typed)
            values[field.path] = typed
        except FieldError as error:
            asked.append(str(error))
    if is_radial:
        asked.append("no axial load in the line: it is 0")
    targets = {SYMBOLS[symbol].get("target") for symbol in SYMBOLS.keys() - line.values.keys()}
    kept = [field.label for field in card.fields if field.path in targets - {"bearing.count"}]
    if line.values and kept:
        asked.append(f"not in the line, and left as it is: {', '.join(kept)}")
    estimated, note = dict[str, str](), ""
    try:
        estimated, note = _estimate(line, card)
    except ValueError as error:
        asked.append(f"geometry stays as it is in the fields: {error}")
    return Filled(card.name, values | estimated, estimated, note, asked)


def with_note(text: str, values: Mapping[str, object], card: Card) -> Measured:
    """Return what a card measures, with what a line has estimated and no value has replaced."""
    measured = card.measured
    line = filled(text, {name: card for name in LINES}, card.name) if card.name in LINES else None
    if line is None or not line.estimated:
        return measured
    for path, estimate in line.estimated.items():
        default = card.by_path[path].default
        if values.get(path, _typed(card.by_path[path], default or "", "")) != estimate:
            return measured
    row = remark("estimated", line.note)
    return measured._replace(files=[*measured.files, row], notes=[*measured.notes, line.note])


def _typed(field: Field, value: float | str, unit: str, digits: int = 9) -> str:
    """Return a value as it is typed in a field."""
    if isinstance(value, str):
        return value
    if unit and unit != field.unit:
        value = number_in(field.unit, f"{value!r} {unit}")
    return f"{value:.{digits}g}"


def _estimate(line: Line, card: Card) -> tuple[dict[str, str], str]:
    """Return number and sizes of the balls as they are typed, and how they were estimated.

    A `ValueError` says why they are not.
    """
    sizes = _dimensions(line.designation)
    given = {name: line.values[name] for name in NEEDED if name in line.values}
    known = {name: float(value) for name, value in (sizes | given).items()}
    if not known and not line.designation:
        return {}, ""
    if line.designation[:1].isalpha() or card.name != "ball-bearing":
        raise ValueError("number and size of rollers do not follow from the ratings")
    for name, size in sizes.items():
        if abs(known[name] - size) > TINY:
            raise ValueError(f"{name} of a {line.designation} is {size * 1e3:g} mm")
    if missing := ", ".join(name for name in NEEDED if name not in known):
        raise ValueError(f"it is estimated from C, C0, d and D; give {missing}")
    arguments: dict[str, Any] = {name: known[symbol] for symbol, name in NEEDED.items()}
    if "Z" in line.values:
        arguments["count"] = int(line.values["Z"])
    with heard() as notes:
        ball = estimated_balls(**arguments)
        agreement = compare_ratings(ball, capacity=known["C"])
    estimated = {}
    for name in ESTIMATED:
        field = card.by_path[f"bearing.{name}"]
        estimated[field.path] = _typed(field, getattr(ball, name), "m" if field.unit else "", 4)
    return estimated, f"{line.designation}: {notes[0]}; {agreement}".removeprefix(": ")


def _dimensions(designation: str) -> dict[str, float]:
    """Return the bore d, and where it is known the outside diameter D, of a ball bearing [m]."""
    series, code = designation[:-2], designation[-2:]
    if not designation:
        return {}
    if len(designation) == SHORT:
        return {"d": int(designation[-1]) * 1e-3}
    sizes = TABLES["outside"].get(series, ())[int(code) : int(code) + 1]
    bore = TABLES["bores"].get(code, 5 * int(code))
    return {"d": bore * 1e-3} | ({"D": sizes[0] * 1e-3} if sizes else {})
