"""A line of text on a bearing, such as "6205, C 14.8 kN, Fr 2 kN, 1500/min": what it says."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from nacre._tools.notices import heard
from nacre._tools.units import number_in
from nacre.app.answer import Measured
from nacre.app.cards import Card
from nacre.app.fields import Field, FieldError
from nacre.bearing import check, estimated_balls
from nacre.bearing.modified import SMALL
from nacre.results.rows import remark


class Symbol(NamedTuple):
    """A quantity that a line may have."""

    unit: str
    """Unit of its number."""
    keys: str
    """Words before its number."""
    certain: str = ""
    """Unit of a number that is typed without one; "" where a unit must be typed."""
    target: str = ""
    """Path of its field."""


SYMBOLS = {
    "C": Symbol("N", "C Cr C_r"),
    "C0": Symbol("N", "C0 C_0 C0r C_0r Cor Co C₀"),
    "Fr": Symbol("N", "Fr F_r radial", target="bearing.solve.force.x"),
    "Fa": Symbol("N", "Fa F_a axial", target="bearing.solve.force.z"),
    "n": Symbol("rad/s", "n speed Drehzahl", "1/min", target="bearing.solve.speed"),
    "d": Symbol("m", "d", "mm"),
    "D": Symbol("m", "D", "mm"),
    "B": Symbol("m", "B", "mm"),
    "Z": Symbol("", "Z count", "1", target="bearing.count"),
    "VG": Symbol("", "VG ISO\\sVG ISO-VG", "1", target="bearing.oil.grade"),
    "T": Symbol("°C", "T temperature Temperatur", target="bearing.oil.temperature"),
    "life": Symbol("h", "life L L10 L10h Lh Lebensdauer", "h", target="bearing.life.required_life"),
    "tilt": Symbol("rad", "tilt misalignment", target="bearing.solve.tilt.y"),
    "cleanliness": Symbol("", "", target="bearing.oil.cleanliness"),
}
"""Quantities of a line by their names."""
SPELLINGS = {"r/min": "1/min", "rev/min": "1/min", "hours": "h", "Std": "h", "degC": "°C"}
"""Units in other spellings."""
CERTAIN = {"n": ("/min", "1/min", "rpm", "U/min", "min-1", "min⁻¹"), "life": ("h",), "T": ("°C",)}
"""Units that say which quantity a number is."""
GRADES = (2, 3, 5, 7, 10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460, 680, 1000, 1500, 2200, 3200)
"""Viscosity grades of ISO 3448."""
NEEDED = {
    **{"C": "capacity", "C0": "static_capacity", "d": "bore", "D": "outside_diameter"},
}
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
KEYS = "|".join(sorted((k for s in SYMBOLS.values() for k in s.keys.split()), key=len)[::-1])
ITEM = re.compile(
    rf"(?:(?P<key>{KEYS})\s*[=:]?\s*)?(?P<number>{NUMBER})(?:(?P<gap>\s*)(?P<unit>1/\S+|[^\s\d]\S*))?"
)
"""A number with what is before and after it."""
THOUSANDS = re.compile(r"(?<![\w.,])(?:[1-9]\d{0,2}[.,]\d{3}(?!\d)|\d{1,3}(?:\s\d{3})+(?!\S*\d))")
"""Numbers in which a mark or a blank may be one of thousands: 14.800, 1 500."""
DESIGNATION = re.compile(
    r"(?P<rollers>NUP|NU|NJ|NF|N)?[ -]?(?P<code>\d{3,5})(?P<suffix>[-/]?[A-Z\d][\w/-]*)?"
    r"(?P<more>(?: (?:C[2-5]|CN|2?RS\d?|2Z|ZZ|EC[PJM]?))*)(?!\S)"
)
"""Designation of a bearing, with its suffixes."""
DEEP_GROOVE = re.compile(r"(?:6[0234]|16[01]|6[123]\d)\d\d|6[0-3][1-9]")
"""Designations of deep-groove ball bearings."""
BORES = {"00": 10, "01": 12, "02": 15, "03": 17}
"""Bores of the first codes [mm], as DIN 623-1 and catalogues have them; others are five times the
code."""
OUTSIDE = {
    "60": "26 28 32 35 42 47 55 62 68 75 80 90 95 100 110 115 125 130 140 145 150",
    "62": "30 32 35 40 47 52 62 72 80 85 90 100 110 120 125 130 140 150 160 170 180",
    "63": "35 37 42 47 52 62 72 80 90 100 110 120 130 140 150 160 170 180 190 200 215",
}
"""Outside diameters by series and bore code 00 to 20 [mm]: diameter series 0, 2 and 3 of ISO 15, as
tables of NTN (CAT. No. 2203) and INA quote them."""


class Line(NamedTuple):
    """What a line says, and what it does not say clearly."""

    designation: str
    """Designation without its suffixes, or ""."""
    is_roller: bool
    """Whether the designation is that of a cylindrical roller bearing."""
    values: dict[str, float | str]
    """Numbers in the units of `SYMBOLS`, and the word for the cleanliness, by symbol."""
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
    line = Line("", False, {}, [])
    if len(text) > LONGEST:
        return line._replace(asked=[f"a line has at most {LONGEST} characters"])
    is_first = True
    for part in re.split(r"[;\n]|,(?!\d)|(?<!\d),", text):
        part = re.sub(r"(?<=\d) (?=000\b)", "", " ".join(part.split()))  # 20 000
        if THOUSANDS.search(part):
            line.asked.append(
                f'"{part}": write numbers without blanks, and not with three decimals'
            )
            is_first = False
            continue
        pieces = list(_pieces(part, is_first))
        is_first = is_first and not part
        for at, (piece, known) in enumerate(pieces):
            beside = pieces[max(0, at - 1) : at + 2]
            if known is None:
                continue
            if any(other is None for _, other in beside):
                pieces[at] = piece, {}  # what is beside may be part of it
                continue
            for name, value in known.items():
                if name == "designation":
                    line = line._replace(designation=str(value), is_roller=known["is_roller"] == 1)
                elif name in line.values:
                    line.asked.append(f"{name} is given twice: {piece} was left out")
                elif name in SYMBOLS:
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
                length, known = named.end(), _designation(named)
        length = length or len(rest.split(" ")[0])
        yield rest[:length], known
        at += length + (part[at + length : at + length + 1] == " ")


def _item(rest: str) -> tuple[int, dict[str, float | str] | None]:
    """Return length and meaning of the number at the beginning of a text, if it has one."""
    found = ITEM.match(rest)
    if found is None:
        return 0, None
    number, unit = found["number"].replace(",", "."), found["unit"] or ""
    unit = SPELLINGS.get(unit, unit)
    if found["key"]:
        key = re.sub(r"\s", "\\\\s", found["key"])
        name = next(name for name, symbol in SYMBOLS.items() if key in symbol.keys.split())
        certain = SYMBOLS[name].certain
    else:
        name = next((name for name, units in CERTAIN.items() if unit in units), "")
        certain = ""
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
        if not SYMBOLS[name].unit:
            return float(text) if float(text) in (GRADES if name == "VG" else range(1000)) else None
        value = number_in(SYMBOLS[name].unit, text)
    except ValueError:
        return None
    return value if value > 0 or (name in ("Fa", "tilt") and value == 0) else None


def _designation(found: re.Match[str]) -> dict[str, float | str]:
    name = f"{found['rollers'] or ''} {found['code']}".strip()
    return {"designation": name, "is_roller": float(bool(found["rollers"]))}


def filled(text: str, cards: Mapping[str, Card], current: str) -> Filled:
    """Return the fields that a line fills, of the current card or of its designation's.

    Balls are estimated from C, C_0, d and D together, by `nacre.bearing.estimated_balls`.
    """
    line = read(text)
    asked, values, name = line.asked, dict[str, str](), line.designation
    if name and not (line.is_roller or DEEP_GROOVE.fullmatch(name)):
        kinds = "deep-groove ball bearings and cylindrical roller bearings"
        asked.append(f"the page has cards of {kinds}, and none of a {name}: nothing is filled in")
        return Filled(current, {}, {}, "", asked)
    card = cards[("bearing" if line.is_roller else "ball-bearing") if name else current]
    for symbol, value in line.values.items():
        if not (target := SYMBOLS[symbol].target):
            continue
        if (field := card.by_path.get(target)) is None:
            asked.append(f"{symbol} was left out: the card has no field for it")
            continue
        try:
            typed = _typed(field, value, SYMBOLS[symbol].unit)
            field.number(typed)
            values[field.path] = typed
        except FieldError as error:
            asked.append(str(error))
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
    known: dict[str, float] = {
        name: float(line.values.get(name, size)) for name, size in sizes.items()
    }
    known |= {name: float(line.values[name]) for name in NEEDED if name in line.values}
    if not known and not line.designation:
        return {}, ""
    if line.is_roller or card.name != "ball-bearing":
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
        agreement = check(ball, capacity=known["C"])
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
    outside = OUTSIDE.get(series, "").split()[int(code) : int(code) + 1]
    bore = {"d": BORES.get(code, 5 * int(code)) * 1e-3}
    return bore | ({"D": int(outside[0]) * 1e-3} if outside else {})
