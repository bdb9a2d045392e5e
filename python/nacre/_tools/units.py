"""Unit systems and prefixes of what is printed, drawn and tabulated.

Quantities are plain numbers in consistent units; `display_units` says which units they are.
"""

from __future__ import annotations

import math
import re
import sys
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from types import TracebackType

PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n", -12: "p"}

BASES = {
    "N": ("N", 1.0),
    "lbf": ("N", 4.4482216152605),
    "m": ("m", 1.0),
    "in": ("m", 0.0254),
    "Pa": ("Pa", 1.0),
    "psi": ("Pa", 4.4482216152605 / 0.0254**2),
    "J": ("J", 1.0),
    "rad": ("rad", 1.0),
}
"""Units that may be part of a unit: the SI unit of the quantity, and their size in it.

The pound-force and the inch are exact by definition; a psi is a pound-force per square inch.
"""
IMPERIAL = ("lbf", "in", "psi")
POWERS = {"": 1, "²": 2, "³": 3, "⁴": 4}
FACTORS = re.compile(r"([/ ]?)([^/ ²³⁴]+)([²³⁴]?)")
"""A unit in a product or a quotient: the sign before it, its name, and its power."""
WORK = {"J": "N m", "J/m": "N", "J/m²": "N/m", "J/m³": "Pa", "kg/m³": "Pa s²/m²"}
"""Units of energies and of densities in systems that have no name for them."""
SIZES = {sign: float(f"1e{power}") for power, sign in PREFIXES.items()} | {"c": 1e-2, "T": 1e12}
READABLE = (0.1, 1e5)
"""Values that are written in a system's own unit without another prefix, and with the smallest or
largest prefix beyond the prefixes; squared for areas."""


def _simple(unit: str) -> tuple[str, float] | None:
    """Return the SI unit and the size in it of a unit without products, such as "MPa"."""
    unit = unit.replace("μ", "µ")
    for base, (dimension, size) in BASES.items():
        prefix = unit.removesuffix(base)
        if unit.endswith(base) and prefix in ({""} if base in IMPERIAL else SIZES):
            return dimension, SIZES[prefix] * size
    return None


def size_of(unit: str) -> tuple[str, float] | None:
    """Return the SI unit and the size in it of a unit such as "N/mm" or "mm²", if it is known.

    >>> size_of("N/mm")
    ('N/m', 1000.0)
    """
    factors = FACTORS.findall(unit)
    sizes = {name: _simple(name) for _, name, _ in factors}
    if not factors or None in sizes.values() or "".join(map("".join, factors)) != unit:
        return None
    factor_sizes = {name: size for name, size in sizes.items() if size is not None}
    dimension = "".join(f"{mark}{factor_sizes[name][0]}{power}" for mark, name, power in factors)
    return dimension, _product(unit, {name: size for name, (_, size) in factor_sizes.items()})


def _product(unit: str, sizes: Mapping[str, float]) -> float:
    """Return the size of a product or quotient of units with these sizes, others with 1."""
    above, below = 1.0, 1.0
    for mark, name, power in FACTORS.findall(unit):
        size = sizes.get(name, 1.0) ** POWERS[power]
        above, below = (above, below * size) if mark == "/" else (above * size, below)
    return above / below


DEFINED = {
    **dict.fromkeys(("kg", "m", "s", "rad", "K", "A"), (1.0, "")),
    **{"g": (1e-3, "kg"), "t": (1e3, "kg"), "N": (1.0, "kg m/s²"), "J": (1.0, "N m")},
    **{"Pa": (1.0, "N/m²"), "bar": (1e5, "Pa"), "Nm": (1.0, "N m"), "Nmm": (1e-3, "N m")},
    **{"W": (1.0, "J/s"), "V": (1.0, "W/A"), "S": (1.0, "A/V")},
    **dict.fromkeys(("Ω", "ohm"), (1.0, "V/A")),
    **{"Pas": (1.0, "Pa s"), "P": (0.1, "Pa s"), "St": (1e-4, "m²/s"), "kgf": (9.80665, "N")},
    **{"lbf": (BASES["lbf"][1], "N"), "in": (BASES["in"][1], "m"), "psi": (1.0, "lbf/in²")},
    **{"ksi": (1e3, "psi"), "ft": (12.0, "in"), "min": (60.0, "s"), "h": (60.0, "min")},
    **dict.fromkeys(("°", "deg"), (math.pi / 180, "rad")),
    **dict.fromkeys(("′", "'", "arcmin"), (math.pi / 180 / 60, "rad")),
    **{"%": (1e-2, "1"), "‰": (1e-3, "1"), "1": (1.0, "1"), "Hz": (2 * math.pi, "rad/s")},
    **dict.fromkeys(("rpm", "U/min", "r/min", "rev/min"), (2 * math.pi / 60, "rad/s")),
    **dict.fromkeys(("1/min", "min-1"), (2 * math.pi / 60, "rad/s")),
}
"""Units in which people type numbers, by name: each is a multiple of another unit, but for six
base units. The inverse of a minute is a speed of rotation, since everybody counts turns in it."""
PREFIXED = (
    *("g", "m", "s", "N", "Pa", "J", "rad", "bar", "Nm", "Pas", "P", "St", "Hz"),
    *("W", "A", "V", "S", "Ω", "ohm"),
)
"""Units that may have a prefix."""
TYPED = re.compile(r"([+-]?(?:\d++\.?\d*+|\.\d++)(?:[eE][+-]?\d{1,3}+)?+)\s*((?!1$)\S.*)")
"""A number and its unit."""
LONGEST_TYPED = 60
"""Largest number of characters of a number with its unit."""
FACTOR = re.compile(r"(^| ?/ ?| )([^\W\d]+|[°′']|(?<!.)1(?= ?/))(-?\d)?")
"""A unit in a product or a quotient as it is typed: the sign before it, its name and its power. A
number 1 is above the line alone."""
SPELLINGS = str.maketrans(
    {"·": " ", "⋅": " ", "*": " ", "^": "", "μ": "µ", "\N{OHM SIGN}": "Ω"}
    | {sign: str(power) for sign, power in zip("²³⁴¹⁻", (2, 3, 4, 1, "-"), strict=True)}
)


@lru_cache
def _measure(unit: str) -> tuple[Fraction, dict[str, int]] | None:
    """Return the exact size in SI, and the powers of base units, of a unit as it is typed.

    It is None of a unit that is not known, or that can be read in two ways: "N/m m", "m m".
    """
    unit = unit.replace("**", "").translate(SPELLINGS).strip()
    unit = f"1{unit}" if unit.startswith("/") else unit
    # What is below the line is a product in parentheses, or has a line of its own.
    unit = re.sub(r"\(([^()/]+)\)$", lambda below: "/".join(below[1].split()), unit)
    factors = [(unit, unit, "")] if unit in DEFINED else FACTOR.findall(unit)
    names, signs = [name for _, name, _ in factors], [sign.strip() for sign, _, _ in factors]
    if unit not in DEFINED and "".join(map("".join, factors)) != unit:
        return None
    if len({*names}) < len(names) or ("/" in signs and "" in signs[signs.index("/") :]):
        return None
    size, powers = Fraction(1), dict[str, int]()
    for sign, (_, name, digit) in zip(signs, factors, strict=True):
        if (known := _defined(name)) is None:
            return None
        power = int(digit or 1) * (-1 if sign == "/" else 1)
        size *= known[0] ** power
        for base, exponent in known[1].items():
            powers[base] = powers.get(base, 0) + power * exponent
    return size, {base: power for base, power in powers.items() if power}


def _defined(name: str) -> tuple[Fraction, dict[str, int]] | None:
    """Return the exact size in SI and the powers of a unit without products, if it is known."""
    prefix, base = "", name
    if name not in DEFINED:
        prefix, base = name[:1].replace("u", "µ"), name[1:]
        is_slip = base == "m" and prefix in ("G", "M", "T")  # Mm is mm that was typed in haste
        if base not in PREFIXED or prefix not in SIZES or is_slip:
            return None
    size, of = DEFINED[base]
    exact = Fraction(str(SIZES[prefix])) * Fraction(str(size))
    inner = (Fraction(1), {base: 1} if of == "" else {}) if of in ("", "1") else _measure(of)
    assert inner is not None
    return exact * inner[0], inner[1]


def number_in(unit: str, text: str) -> float:
    """Return the number of a text with a unit, such as "5 mm", in another unit of its kind.

    A `ValueError` says which unit the text must have.

    >>> number_in("m", "5 mm"), number_in("rad/s", "30/min"), number_in("", "0.1 %")
    (0.005, 3.141592653589793, 0.001)
    """
    typed = TYPED.fullmatch(text.strip().replace("−", "-")) if len(text) <= LONGEST_TYPED else None
    target, source = _measure(unit or "1"), typed and _measure(typed[2])
    if typed and target and source and source[1] == target[1]:
        with suppress(OverflowError):
            return float(Fraction(typed[1]) * source[0] / target[0])
    must = f"in {unit} or in another unit of its kind" if unit else "without a unit, or in %"
    hint = "; a decimal mark is a point" if "," in text else ""
    raise ValueError(f"must be a number {must}, got {text!r}{hint}")


PLAIN = {
    "ν": "nu", "µ": "u", "μ": "u", "±": "+-", "×": "x", "²": "^2", "³": "^3", "·": "*", "°": "deg",
    "−": "-", "–": "-", "…": "...", "σ": "sigma", "δ": "delta", "χ": "chi",
}  # fmt: skip
"""What is printed for a letter where the encoding of the output lacks it."""


def printable(text: str) -> str:
    """Return a text with letters that the encoding of `sys.stdout` has, as on Windows."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        # Other letters, as in names of layers, become question marks.
        text = "".join(mark if _has(encoding, mark) else PLAIN.get(mark, "?") for mark in text)
    except LookupError:
        pass
    return text


def _has(encoding: str, letter: str) -> bool:
    try:
        letter.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


class System:
    """A consistent system of units: force, length, and stress as force per length squared.

    Parameters
    ----------
    name
        Units of the three, "N-mm-MPa"; "SI" is "N-m-Pa".

    Raises
    ------
    ValueError
        If a unit is not known, or the three are not consistent.
    """

    def __init__(self, name: str) -> None:
        units = ("N-m-Pa" if name == "SI" else name).split("-") if isinstance(name, str) else []
        sizes = [_simple(unit) for unit in units]
        if [size and size[0] for size in sizes] != ["N", "m", "Pa"]:
            raise ValueError(
                "units must be force-length-stress, such as 'N-m-Pa' (or 'SI'), 'N-mm-MPa', "
                f"'mN-µm-GPa' or 'lbf-in-psi', got {name!r}"
            )
        force, length, stress = (size[1] for size in sizes if size)
        if not math.isclose(stress, force / length**2, rel_tol=1e-6):
            raise ValueError(
                f"units must be consistent, stress = force/length²; 1 {units[0]}/{units[1]}² is "
                f"{force / length**2 / stress:.6g} {units[2]}, got {name!r}"
            )
        self.name = "SI" if units == ["N", "m", "Pa"] else name
        self.imperial = any(unit in IMPERIAL for unit in units)
        watts = {1.0: "W", 1e-3: "mW", 1e-6: "µW", 1e-9: "nW"}
        power = watts.get(float(f"{force * length:.12g}"), f"{units[0]} {units[1]}/s")
        self._names = dict(zip(("N", "m", "Pa"), units, strict=True)) | {"W": power}
        self._sizes = {"N": force, "m": length, "Pa": stress, "W": force * length}

    def unit(self, dimension: str) -> tuple[float, str]:
        """Return the size in SI and the name of the unit of numbers whose SI unit is `dimension`.

        >>> System("N-mm-MPa").unit("J/m²")
        (1000.0, 'N/mm')
        """
        if self.name != "SI":
            dimension = WORK.get(dimension, dimension)
        if "/" in self._names["W"]:  # which cannot be below a line itself
            dimension = dimension.replace("/W", " s/N/m")
        terms = FACTORS.findall(dimension)
        name = "".join(f"{mark}{self._names.get(base, base)}{power}" for mark, base, power in terms)
        return _product(dimension, self._sizes), name

    @property
    def metres(self) -> float:
        """Size of the unit of length in metres."""
        return self._sizes["m"]


SI = System("SI")

_block: ContextVar[System | None] = ContextVar("units of a with block", default=None)
"""Units of the innermost ``with`` block of this thread or task."""
_thread = threading.local()
"""Units that a statement has set in a thread other than the main one, as `_thread.system`."""
_process = SI
"""Units that a statement has set in the main thread."""


def system() -> System:
    """Return the system of units that is set here."""
    outside: System = getattr(_thread, "system", _process)
    return _block.get() or outside


def are_declared() -> bool:
    """Return whether the units of numbers are declared here, be they SI or others."""
    return _block.get() is not None or system() is not SI


def _hold(units: System) -> None:
    """Set units as a statement does: to the end of a block around it, or until the next call."""
    global _process
    if _block.get() is not None:
        _block.set(units)
    elif threading.current_thread() is threading.main_thread():
        _process = units
    else:
        _thread.system = units


_chosen: ContextVar[Mapping[str, str] | None] = ContextVar("units of numbers", default=None)
"""Units in which numbers are printed, by their SI units, in place of those that are readable."""


@contextmanager
def chosen(units: Mapping[str, str]) -> Iterator[None]:
    """Print numbers in some units, by their SI units, within the context, whatever their size.

    >>> with chosen({"Pa": "GPa"}):
    ...     written(7.19e6, "Pa")
    '0.00719 GPa'
    """
    token = _chosen.set(units)
    try:
        yield
    finally:
        _chosen.reset(token)


class Within:
    """A context in which units are set: the earlier ones are restored at its end."""

    def __init__(self, units: System) -> None:
        self._units = units
        self._outer: list[System | None] = []

    def __enter__(self) -> None:
        """Set the units for the lines of this block alone."""
        self._outer.append(_block.get())
        _block.set(self._units)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Restore the units."""
        _block.set(self._outer.pop())


class Restoring(Within):
    """The context that `display_units` returns, which has set its units already."""

    def __init__(self, before: System, now: System) -> None:
        super().__init__(now)
        self.before = before
        self.now = now
        self._is_statement = True
        _hold(now)

    def __repr__(self) -> str:
        """Name the units: a notebook shows this where `display_units` ends a cell."""
        return f"numbers are in {', '.join(self.now.unit(unit)[1] for unit in ('N', 'm', 'Pa'))}"

    def __enter__(self) -> None:
        """Set the units for this block, and no longer as a statement does."""
        if self._is_statement:
            self._is_statement = False
            _hold(self.before)
        super().__enter__()


def display_units(system: str) -> Restoring:
    """Set the units in which numbers are, for everything that is printed, drawn and tabulated.

    The library computes in any consistent units, and knows only numbers. Printed solutions and
    summaries, axes of plots, headings of tables and the units in Datasets and files are those that
    are set here, SI at first. No number and no result changes.

    Parameters
    ----------
    system : str
        Units of force, length and stress, such as "N-mm-MPa" or "mN-µm-GPa"; "SI" is "N-m-Pa".
        They must be consistent: stress is force per length squared.

    Returns
    -------
    context manager
        Context at whose end the earlier units are restored. Its units hold in this thread alone,
        or in this task of asyncio. Without a ``with`` statement the units hold until the next
        call: those of the main thread in all threads that set none, those of another thread in it.

    Raises
    ------
    ValueError
        If a unit is not known, or the three are not consistent.

    Notes
    -----
    Numbers below 0.1 or from 100 000 get another prefix: 0.002 mm is printed as 2 µm.
    `HeightMap.read` gives metres whatever is set. Bearings are in SI.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e3, poisson=0.3)  # MPa
    >>> solution = nacre.solve(nacre.Sphere(5.0), steel, load=10.0)  # mm, N
    >>> with nacre.display_units("N-mm-MPa"):
    ...     print(str(solution).splitlines()[6])
    peak pressure  1603 MPa ± ...
    """
    units = System(system)
    return Restoring(_system(), SI if units.name == SI.name else units)


_system = system


def symbol(unit: str) -> str:
    """Return the unit that numbers have whose SI unit is `unit`.

    >>> symbol("N m")
    'N m'
    """
    return system().unit(unit)[1]


@dataclass(frozen=True)
class Scale:
    """A unit with its prefix, and the factor that turns numbers into it."""

    factor: float
    unit: str

    @classmethod
    def of(cls, largest: float, unit: str) -> Scale:
        """Return the scale for numbers whose SI unit is `unit`, the largest of which is given.

        In SI, and where the unit of the system that is set is not readable, `largest` lies between
        1 and 1000 as far as prefixes go.
        """
        size, own = system().unit(unit)
        return cls._readable(largest, size, unit, own)

    @classmethod
    def in_unit(cls, largest: float, unit: str) -> Scale:
        """Return the scale for numbers in any unit, as Datasets have it, in the units that are set.

        A unit that is not known is kept.
        """
        dimension_size = size_of(unit)
        if dimension_size is None:
            return cls(1.0, unit)
        dimension, size = dimension_size
        own = unit if system() is SI or largest else system().unit(dimension)[1]
        return cls._readable(largest, size, dimension, own)

    @classmethod
    def _readable(cls, largest: float, size: float, dimension: str, own: str) -> Scale:
        """Return the scale for numbers in units of `size` in SI, which are called `own`."""
        if (
            not dimension
            or largest == 0
            or not math.isfinite(largest)
            or dimension.startswith(("1", "kg", "m²/N", "K", "m K", "m² K"))
        ):
            return cls(1.0, own)  # nobody writes k1/m, kkg, nm²/N or mK/W
        if (unit_chosen := (_chosen.get() or {}).get(dimension)) is not None:
            known = size_of(unit_chosen)
            assert known is not None
            return cls(size / known[1], unit_chosen)
        # A prefix has the power of the unit behind it: mm² are 1e-6 m², mJ/m² are 1e-3 J/m².
        power = POWERS[FACTORS.findall(dimension)[0][2]]
        low, high = (bound**power for bound in READABLE)
        units = system()
        if units is not SI:
            target, name = units.unit(dimension)
            factor = 1.0 if size == target else size / target
            # A small moment, or a force or an energy per length, has no metre among millimetres.
            low = 0.0 if dimension in ("N m", "N/m", "J/m") else low
            if units.imperial or low <= abs(largest) * factor < high:
                return cls(factor, name)
        # A number just below 1000 is printed as 1000.
        digits = math.log10(abs(largest)) + math.log10(size * (1 + 1e-9))
        exponent = math.floor(digits / (3 * power)) * 3
        if dimension in ("m", "m²"):
            exponent = min(exponent, 0)  # nobody writes kilometres
        nearest = min(max(exponent, min(PREFIXES)), max(PREFIXES))
        factor = size * float(f"1e{-nearest * power}")
        if nearest != exponent and not low <= abs(largest) * factor < high:
            return cls(size, dimension)  # 1e-20 m, and not 1e-08 pm
        return cls(factor, PREFIXES[nearest] + dimension)


def energy(line: bool, rolls: bool = False) -> str:
    """Return the SI unit of an energy: per length of a line contact, and per length rolled.

    >>> energy(line=False), energy(line=True), energy(line=True, rolls=True)
    ('J', 'J/m', 'J/m²')
    """
    return ("J", "J/m", "J/m²")[line + rolls]


def written(value: float, unit: str, digits: int = 4) -> str:
    """Return a number, whose SI unit is given, with the unit that is set.

    >>> written(1.46806e9, "Pa")
    '1.468 GPa'
    """
    scale = Scale.of(value, unit)
    return f"{rounded(scale.factor * value, digits)} {scale.unit}".rstrip()


def travelled(distance: float, unit: str) -> str:
    """Return a sliding distance, in metres or kilometres where it is long, or cycles or passes.

    >>> travelled(2500.0, "m"), travelled(2500.0, "cycles")
    ('2.5 km', '2500 cycles')
    """
    if unit != "m":
        return f"{distance:.4g} {unit}"
    metres = system().metres * distance
    if abs(metres) < 1 or system().imperial:
        return written(distance, "m")
    return f"{metres / 1e3:.4g} km" if abs(metres) >= 1e3 else f"{metres:.4g} m"


def plain(value: float, digits: int) -> str:
    """Return a number of so many digits, never with an exponent, in thousands from 10 000 on.

    >>> plain(14203.0, 3), plain(1.2345e-5, 3), plain(1739.0, 3)
    ('14 200', '0.0000123', '1740')
    """
    if not math.isfinite(value):
        return str(value)
    number = Decimal(f"{value:.{digits}g}").normalize()
    return f"{number:,f}".replace(",", " ") if abs(number) >= 1e4 else f"{number:f}"


def rounded(value: float, digits: int) -> str:
    """Return a number of so many digits, without an exponent below a million.

    >>> rounded(35329.1, 4), rounded(17.3, 1)
    ('35330', '20')
    """
    return f"{float(f'{value:.{digits}g}'):.{max(digits, 6)}g}"
