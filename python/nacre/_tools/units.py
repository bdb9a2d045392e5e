"""Unit systems and prefixes of what is printed, drawn and tabulated.

Quantities are plain numbers in consistent units; `display_units` says which units they are.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
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
SIZES = {sign: float(f"1e{power}") for power, sign in PREFIXES.items()} | {"c": 1e-2, "T": 1e12}
READABLE = (0.1, 1e5)
"""Values that are written in a system's own unit, without another prefix; squared for areas."""


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
    if unit.endswith("²"):
        side = _simple(unit.removesuffix("²"))
        return side and (f"{side[0]}²", side[1] ** 2)
    for mark in "/ ":
        first, found, second = unit.partition(mark)
        if found:
            one, other = _simple(first), _simple(second)
            if one is None or other is None:
                return None
            size = one[1] / other[1] if mark == "/" else one[1] * other[1]
            return f"{one[0]}{mark}{other[0]}", size
    return _simple(unit)


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
        text = "".join(one if _has(encoding, one) else PLAIN.get(one, "?") for one in text)
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
        parts = ("N-m-Pa" if name == "SI" else name).split("-") if isinstance(name, str) else []
        sizes = [_simple(part) for part in parts]
        if [size and size[0] for size in sizes] != ["N", "m", "Pa"]:
            raise ValueError(
                "units must be force-length-stress, such as 'N-m-Pa' (or 'SI'), 'N-mm-MPa', "
                f"'mN-µm-GPa' or 'lbf-in-psi', got {name!r}"
            )
        force, length, stress = (size[1] for size in sizes if size)
        if not math.isclose(stress, force / length**2, rel_tol=1e-6):
            raise ValueError(
                f"units must be consistent, stress = force/length²; 1 {parts[0]}/{parts[1]}² is "
                f"{force / length**2 / stress:.6g} {parts[2]}, got {name!r}"
            )
        newton, metre, pascal = parts
        self.name = "SI" if parts == ["N", "m", "Pa"] else name
        self.imperial = any(part in IMPERIAL for part in parts)
        self.units = {
            "N": (force, newton),
            "m": (length, metre),
            "Pa": (stress, pascal),
            "m²": (length**2, f"{metre}²"),
            "N/m": (force / length, f"{newton}/{metre}"),
            "N m": (force * length, f"{newton} {metre}"),
            "m/N": (length / force, f"{metre}/{newton}"),
            "m/s": (length, f"{metre}/s"),
            "1/m": (1 / length, f"1/{metre}"),
            "m/Pa": (length / stress, f"{metre}/{pascal}"),
        }
        work = {"J": "N m", "J/m": "N", "J/m²": "N/m"}
        if self.name == "SI":
            self.units |= {unit: (1.0, unit) for unit in work}
        else:
            self.units |= {unit: self.units[same] for unit, same in work.items()}

    @property
    def metres(self) -> float:
        """Size of the unit of length in metres."""
        return self.units["m"][0]


SI = System("SI")
_system = SI


class Restoring:
    """The context in which units are set: they are restored at its end."""

    def __init__(self, before: System, now: System) -> None:
        self.before = before
        self.now = now

    def __repr__(self) -> str:
        """Name the units: a notebook shows this where `display_units` ends a cell."""
        return f"numbers are in {', '.join(self.now.units[unit][1] for unit in ('N', 'm', 'Pa'))}"

    def __enter__(self) -> None:
        """Begin the context, in which the units are set already."""

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Restore the units."""
        global _system
        _system = self.before


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
        Context at whose end the earlier units are restored. Without a ``with`` statement the units
        hold in this process until the next call.

    Raises
    ------
    ValueError
        If a unit is not known, or the three are not consistent.

    Notes
    -----
    Numbers below 0.1 or from 100 000 get another prefix: 0.002 mm is printed as 2 µm.
    `HeightMap.read` gives metres whatever is set.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e3, poisson=0.3)  # MPa
    >>> solution = nacre.solve(nacre.Sphere(5.0), steel, load=10.0)  # mm, N
    >>> with nacre.display_units("N-mm-MPa"):
    ...     print(str(solution).splitlines()[6])
    peak pressure  1603 MPa ± ...
    """
    global _system
    before, asked = _system, System(system)
    _system = SI if asked.name == SI.name else asked
    return Restoring(before, _system)


def system() -> System:
    """Return the system of units that is set."""
    return _system


def symbol(unit: str) -> str:
    """Return the unit that numbers have whose SI unit is `unit`.

    >>> symbol("N m")
    'N m'
    """
    return _system.units.get(unit, (1.0, unit))[1]


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
        size, own = _system.units.get(unit, (1.0, unit))
        return cls._chosen(largest, size, unit, own)

    @classmethod
    def given(cls, largest: float, unit: str) -> Scale:
        """Return the scale for numbers in any unit, as Datasets have it, in the units that are set.

        A unit that is not known is kept.
        """
        known = size_of(unit)
        if known is None:
            return cls(1.0, unit)
        dimension, size = known
        return cls._chosen(largest, size, dimension, unit)

    @classmethod
    def _chosen(cls, largest: float, size: float, dimension: str, own: str) -> Scale:
        """Return the scale for numbers in units of `size` in SI, which are called `own`."""
        # The prefix of an area is squared: mm² are 1e-6 m².
        power = 2 if dimension.endswith("²") else 1
        if not dimension or largest == 0 or not math.isfinite(largest) or dimension[0] == "1":
            return cls(1.0, own)  # nobody writes k1/m
        if _system is not SI and dimension in _system.units:
            target, name = _system.units[dimension]
            low, high = (bound**power for bound in READABLE)
            factor = 1.0 if size == target else size / target
            if _system.imperial or low <= abs(largest) * factor < high:
                return cls(factor, name)
        # A number just below 1000 is printed as 1000.
        digits = math.log10(abs(largest)) + math.log10(size * (1 + 1e-9))
        magnitude = math.floor(digits / (3 * power)) * 3
        exponent = min(max(magnitude, min(PREFIXES)), max(PREFIXES))
        if dimension in ("m", "m²"):
            exponent = min(exponent, 0)  # nobody writes kilometres
        factor = float(f"1e{-exponent * power}")
        return cls(size * factor, PREFIXES[exponent] + dimension)


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


def rounded(value: float, digits: int) -> str:
    """Return a number of so many digits, without an exponent below a million.

    >>> rounded(35329.1, 4), rounded(17.3, 1)
    ('35330', '20')
    """
    return f"{float(f'{value:.{digits}g}'):.{max(digits, 6)}g}"
