"""Indentation curves, and files that hold them."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal, NamedTuple, TypedDict, Unpack, overload

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.typing import among
from nacre._tools.units import written
from nacre.indent._columns import checked_units, chosen_tables, has_curve, quantities
from nacre.indent._segments import arrival, departure, find_hold
from nacre.indent._text import tables

Array = npt.NDArray[np.float64]

SPRING_CONSTANT = re.compile(r'"spring constant"\s*:\s*([0-9.eE+-]+)')
"""Spring constant [N/m] in the head of a table that afmformats wrote, in SI units."""
LEAST_POINTS = 3
"""Fewest points of a curve: with less, no law of two parameters could be tested."""
ROUNDING = 4 * float(np.finfo(np.float64).eps)
"""Relative error of a depth that was converted from another unit, and of a bound: a few roundings,
so that a point on a bound is kept."""


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Curve:
    """Force over depth of one indentation.

    Parameters
    ----------
    depth : array_like, (n,)
        Displacement of the tip into the sample [m], in the order of the measurement. Its zero may
        be anywhere, see `contact_point`.
    force : array_like, (n,)
        Force [N], positive in compression.
    time : array_like, (n,), optional
        Time [s], which does not fall.
    name : str
        Name in tables, pictures and messages.

    Raises
    ------
    ValueError
        If there are less than three points, lengths differ, a value is not finite, or time falls.
    TypeError
        If an argument is not made of real numbers, or the name is not a text.

    Notes
    -----
    All consistent units will do; those of `read` are SI. The arrays cannot be written to.

    Examples
    --------
    >>> depth = np.linspace(0.0, 100e-9, 51)
    >>> curve = nacre.indent.Curve(depth, 3.16e4 * depth**1.5, name="A1")
    >>> curve
    <Curve 'A1': 51 points, depth 0 m to 100 nm, force 0 N to 999.3 nN>
    >>> curve.between(20e-9, 60e-9).force.size
    21
    """

    depth: Array
    force: Array
    time: Array | None
    name: str
    note: str
    """What `loading` and `unloading` made of holds; "" where there are none."""

    __hash__: ClassVar[None]  # type: ignore[assignment]

    def __init__(
        self,
        depth: npt.ArrayLike,
        force: npt.ArrayLike,
        *,
        time: npt.ArrayLike | None = None,
        name: str = "",
    ) -> None:
        if not isinstance(name, str):
            raise TypeError(f"name must be a text, got {name!r}")
        arrays = {"depth": _frozen_array("depth", depth), "force": _frozen_array("force", force)}
        if time is not None:
            arrays["time"] = _frozen_array("time", time)
        for argument, array in arrays.items():
            if array.size != arrays["depth"].size:
                raise ValueError(
                    f"{argument} must have as many values as depth, {arrays['depth'].size}, got "
                    f"{array.size}"
                )
        if time is not None:
            falls = np.flatnonzero(np.diff(arrays["time"]) < 0)
            if falls.size:
                index = int(falls[0]) + 1
                before, after = arrays["time"][index - 1 : index + 1]
                raise ValueError(
                    f"time must not fall, got {after:.6g} after {before:.6g} at index {index}"
                )
        for attribute, value in ({"time": None} | arrays | {"name": name, "note": ""}).items():
            object.__setattr__(self, attribute, value)

    def __repr__(self) -> str:
        """Return the number of points and the ranges, in the units that are set."""
        depth, force = (
            f"{written(float(values.min()), unit)} to {written(float(values.max()), unit)}"
            for values, unit in ((self.depth, "m"), (self.force, "N"))
        )
        name = f" {self.name!r}" if self.name else ""
        note = f"; {self.note}" if self.note else ""
        return f"<Curve{name}: {len(self)} points, depth {depth}, force {force}{note}>"

    def __len__(self) -> int:
        """Return the number of points."""
        return self.depth.size

    def __eq__(self, other: object) -> bool:
        """Return whether all numbers and the names are equal."""
        if not isinstance(other, Curve):
            return NotImplemented
        pairs = ((self.depth, other.depth), (self.force, other.force), (self.time, other.time))
        return self.name == other.name and all(
            a is b or (a is not None and b is not None and np.array_equal(a, b)) for a, b in pairs
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Return what pickles and copies are made of; arrays alone would become writable."""
        return _curve, (self.depth, self.force, self.time, self.name, self.note)

    def loading(self) -> Curve:
        """Return the part in which the force rises to its largest, within the noise.

        A hold at the largest force is cut, see `hold`; what is before contact is kept, see
        `between` and `contact_point`, and so are partial unloadings and holds on the way. `note`
        says so.
        """
        end = arrival(self.force)
        note = _cut(self, slice(end + 1, departure(self.depth, self.force) + 1), "cut")
        if (way := find_hold(self.force[end::-1])) is not None:
            note = _notes(note, _cut(self, slice(end + 1 - way.stop, end + 1 - way.start), "kept"))
        return self._part(slice(0, end + 1), "up to its largest force", note)

    def hold(self) -> Curve:
        """Return the hold at the largest force or depth, between `loading` and `unloading`."""
        last = departure(self.depth, self.force)
        return self._part(slice(arrival(self.force), last + 1), "in a hold at its largest force")

    def unloading(self) -> Curve:
        """Return the part in which the force falls from its largest on, within the noise.

        A hold at the largest force or depth is cut. It ends where a force is held again, see
        `drift_hold`. `note` says so.
        """
        start, drifts = departure(self.depth, self.force), self._drift_hold()
        note = _cut(self, slice(arrival(self.force), start), "cut")
        if drifts is not None:
            note = _notes(note, _cut(self, drifts, "cut with what follows"))
        end = None if drifts is None else drifts.start
        return self._part(slice(start, end), "from its largest force on", note)

    def drift_hold(self) -> Curve:
        """Return the part of the unloading in which the force is held, as to measure drift.

        Instruments do that at a tenth of the largest force. A hold has ten points or more within
        the noise or 1 % of the force, five times as many as an even ramp has.

        Raises
        ------
        ValueError
            If there is no such part.
        """
        if (drifts := self._drift_hold()) is None:
            raise ValueError("the curve must have a hold during unloading, got none")
        return self._part(drifts, "in a hold during unloading")

    def _drift_hold(self) -> slice | None:
        start = departure(self.depth, self.force)
        hold = find_hold(self.force[start:])
        return None if hold is None else slice(start + hold.start, start + hold.stop)

    def drift(self) -> Drift:
        """Return the rate at which the depth rises while the force is held.

        Least squares of a line, over the `drift_hold` or, without one, the later half of the
        `hold`, in which a sample that creeps does so, too.

        Returns
        -------
        Drift
            Rate, its standard error and the number of points; `shifted` takes a drift out.

        Raises
        ------
        ValueError
            If the curve has no time, or no hold.

        Examples
        --------
        >>> time = np.arange(120.0)
        >>> force = np.interp(time, [0, 30, 90, 119], [0.0, 1e-3, 1e-3, 0.0])
        >>> depth = 100e-9 * force / 1e-3 + 0.06e-9 * time
        >>> curve = nacre.indent.Curve(depth, force, time=time)
        >>> print(f"{curve.drift().rate:.3g} m/s")
        6e-11 m/s
        >>> curve.loading().note
        'hold of 60 points at 100 % of the largest force, depth +3.5 nm in 59 s, cut'
        """
        if self.time is None:
            raise ValueError("the curve must have a time for its drift to be known")
        hold = self._drift_hold()
        if hold is None:
            first, last = arrival(self.force), departure(self.depth, self.force)
            hold = slice((first + last) // 2, last + 1)
        time, depth = self.time[hold], self.depth[hold]
        if time.size < LEAST_POINTS or np.ptp(time) == 0:
            raise ValueError(
                f"the curve must have a hold of {LEAST_POINTS} points at different times, got "
                f"{time.size}"
            )
        since = time - time.mean()
        rate = float(since @ depth / (since @ since))
        residuals = depth - depth.mean() - rate * since
        error = math.sqrt(float(residuals @ residuals) / (time.size - 2) / float(since @ since))
        return Drift(rate, error, time.size)

    def between(
        self, low: float = -math.inf, high: float = math.inf, *, by: str = "depth"
    ) -> Curve:
        """Return the points whose depth or force lies in a range.

        Parameters
        ----------
        low, high : float
            Bounds of the range [m] or [N]; points on a bound are kept.
        by : str
            "depth" or "force".

        Returns
        -------
        Curve
            Points in the order of the measurement.

        Raises
        ------
        ValueError
            If less than three points are left, or an argument is not one of those above.

        Examples
        --------
        >>> depth = np.linspace(0.0, 100e-9, 51)
        >>> curve = nacre.indent.Curve(depth, 10.0 * depth)
        >>> curve.between(0.2e-6, 0.5e-6, by="force")
        <Curve: 16 points, depth 20 nm to 50 nm, force 200 nN to 500 nN>
        """
        if not among(by, ("depth", "force")):
            raise ValueError(f"by must be 'depth' or 'force', got {by!r}")
        if not low < high:  # nor if one is not a number
            raise ValueError(f"high must be above low, {low:.6g}, got {high:.6g}")
        values = self.depth if by == "depth" else self.force
        low, high = low - ROUNDING * abs(low), high + ROUNDING * abs(high)
        return self._part((low <= values) & (values <= high), f"with {by} in the range")

    def shifted(self, *, depth: float = 0.0, force: float = 0.0, drift: float = 0.0) -> Curve:
        """Return the curve with its zero at this depth and force, which are subtracted.

        Parameters
        ----------
        depth : float
            Depth of the new zero [m], such as that of `contact_point`.
        force : float
            Force of the new zero [N], such as an offset of the sensor.
        drift : float
            Rate at which the depth drifts [m/s], from the first point on, as `drift` has it.

        Returns
        -------
        Curve
            Shifted curve.

        Raises
        ------
        ValueError
            If an argument is not finite, or a drift is given without a time.

        Examples
        --------
        >>> curve = nacre.indent.Curve([1.0, 2.0, 3.0], [0.0, 1.0, 2.0])
        >>> curve.shifted(depth=1.0).depth
        array([0., 1., 2.])
        """
        for name, value in (("depth", depth), ("force", force), ("drift", drift)):
            if not math.isfinite(value):
                raise ValueError(f"{name} must be finite, got {value}")
        depths = self.depth - depth
        if drift:
            if self.time is None:
                raise ValueError(f"drift must be 0 for a curve without a time, got {drift}")
            depths = depths - drift * (self.time - self.time[0])
        return _curve(depths, self.force - force, self.time, self.name, self.note)

    def _part(
        self, selection: slice | npt.NDArray[np.bool_], which: str, note: str | None = None
    ) -> Curve:
        depth = self.depth[selection]
        if depth.size < LEAST_POINTS:
            raise ValueError(
                f"the curve must have at least {LEAST_POINTS} points {which}, got {depth.size} of "
                f"{len(self)}"
            )
        time = None if self.time is None else self.time[selection]
        return _curve(depth, self.force[selection], time, self.name, note or self.note)


class Drift(NamedTuple):
    """The rate at which the depth rises while the force is held."""

    rate: float
    """Rate [m/s]."""
    error: float
    """Standard error by the scatter about a line [m/s]."""
    points: int
    """Number of points."""


def _curve(depth: Array, force: Array, time: Array | None, name: str, note: str = "") -> Curve:
    curve = Curve(depth, force, time=time, name=name)
    object.__setattr__(curve, "note", note)
    return curve


def _notes(*notes: str) -> str:
    return "; ".join(note for note in notes if note)


def _cut(curve: Curve, hold: slice, what: str) -> str:
    """Return in words what the depth does in a hold, and what became of it; "" without one."""
    depth, force = curve.depth[hold], curve.force[hold]
    if depth.size < LEAST_POINTS:
        return ""
    share = 100 * float(np.median(force)) / float(curve.force.max())
    seconds = ""
    if curve.time is not None:
        seconds = f" in {written(float(np.ptp(curve.time[hold])), 's')}"
    creep = written(float(depth[-1] - depth[0]), "m", 2)
    sign = "" if creep.startswith("-") else "+"
    return (
        f"hold of {depth.size} points at {share:.3g} % of the largest force, depth {sign}{creep}"
        f"{seconds}, {what}"
    )


def _frozen_array(name: str, values: npt.ArrayLike) -> Array:
    """Return values as an array that cannot be written to."""
    array = core.real_array(name, values)
    if array.ndim != 1:
        raise ValueError(f"{name} must have one dimension, got shape {array.shape}")
    if array.size < LEAST_POINTS:
        raise ValueError(f"{name} must have at least {LEAST_POINTS} values, got {array.size}")
    wrong = np.flatnonzero(~np.isfinite(array))
    if wrong.size:
        raise ValueError(f"{name} must be finite, got {array[wrong[0]]} at index {wrong[0]}")
    array.flags.writeable = False
    return array


class _Options(TypedDict, total=False):
    """Keywords of `read` but for the segment."""

    depth: str | int | None
    force: str | int | None
    time: str | int | None
    units: Mapping[str, str] | None
    decimal: str | None
    delimiter: str | None
    encoding: str | None
    spring_constant: float | None


@overload
def read(
    path: str | os.PathLike[str], *, segment: Literal["all"], **options: Unpack[_Options]
) -> list[Curve]: ...
@overload
def read(
    path: str | os.PathLike[str], *, segment: int | None = None, **options: Unpack[_Options]
) -> Curve: ...
def read(
    path: str | os.PathLike[str],
    *,
    depth: str | int | None = None,
    force: str | int | None = None,
    time: str | int | None = None,
    units: Mapping[str, str] | None = None,
    decimal: str | None = None,
    delimiter: str | None = None,
    segment: int | Literal["all"] | None = None,
    encoding: str | None = None,
    spring_constant: float | None = None,
) -> Curve | list[Curve]:
    r"""Read an indentation curve from a text file, such as instruments export, in SI units.

    Lines above the table, names and units of columns, delimiter, decimal mark and encoding are
    found from the file. Columns are known by common names with units, such as depth, displacement,
    force, load and time. For others, the error lists the columns and names the keyword.

    Parameters
    ----------
    path : str or path
        Text file.
    depth, force, time : str or int, optional
        Column of the quantity: its name, with or without the unit, or its number from 0. A minus
        before a name or a number, such as "-3", changes the sign. Time is optional.
    units : dict of str, optional
        Units of "depth", "force" and "time" where the file names none or wrong ones, such as
        ``{"depth": "nm", "force": "mN"}``. A time without a unit is in seconds.
    decimal : str, optional
        Decimal mark, "." or ",".
    delimiter : str, optional
        Mark between fields; " " is any white space.
    segment : int or "all", optional
        Table to read where the file holds several, or part of a table with a column of segments:
        its number from 0, or all that have a depth and a force. By default the only table that has
        them, or the whole of a table.
    encoding : str, optional
        Encoding, by a name that Python knows.
    spring_constant : float, optional
        Spring constant of a cantilever [N/m], where the file gives the height of its base: the
        depth is -(height + force / spring_constant). By default that of afmformats' head.

    Returns
    -------
    Curve or list of Curve
        Depth [m], force [N] and time [s]; a list for ``segment="all"``.

    Raises
    ------
    ValueError
        If the table, a column, a unit or the decimal mark cannot be found, or a value is missing.
    TypeError
        If an argument has the wrong type.
    FileNotFoundError
        If there is no such file.

    Warns
    -----
    NacreWarning
        If a time that was not asked for falls, and was left out.

    Notes
    -----
    Signs and zeros are the file's: a column that falls as the tip goes in, or a force that is
    negative in compression, needs a minus before its name. For the zero see `contact_point`.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "A1.txt"
    >>> text = "Depth [nm];Load [mN]\n0,0;0,0\n10,5;0,25\n20,0;0,75\n"
    >>> _ = path.write_text(text, encoding="utf-8")
    >>> curve = nacre.indent.read(path)
    >>> curve
    <Curve 'A1': 3 points, depth 0 m to 20 nm, force 0 N to 750 µN>
    """
    choices = {"depth": depth, "force": force, "time": time}
    units = checked_units(units)
    if decimal not in (None, ".", ","):
        raise ValueError(f"decimal must be '.' or ',', got {decimal!r}")
    if delimiter is not None and (not isinstance(delimiter, str) or len(delimiter) != 1):
        raise ValueError(f"delimiter must be one character, got {delimiter!r}")
    if delimiter is not None and delimiter == decimal:
        raise ValueError(f"delimiter must differ from decimal, got {delimiter!r} for both")
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{str(path)!r} is not a file")
    where = repr(str(path))
    file_tables = tables(path, delimiter, decimal, encoding)
    head = file_tables[0].head
    if "afmformats" in head:  # all in SI units
        units = {"depth": "m", "force": "N", **units}
        match = SPRING_CONSTANT.search(head)
        if match is not None and depth is None and spring_constant is None:
            spring_constant = float(match[1])
    if spring_constant is not None and not 0 < spring_constant < math.inf:
        raise ValueError(f"spring_constant must be positive and finite, got {spring_constant}")
    is_spring = spring_constant is not None
    curves = []
    chosen = chosen_tables(
        where, file_tables, segment, lambda table: has_curve(table, choices, is_spring)
    )
    for number, table in chosen.items():
        depths, forces, times = quantities(where, table, choices, units, spring_constant)
        name = path.stem if len(file_tables) == 1 else f"{path.stem} {number}"
        try:
            curves.append(Curve(depths, forces, time=times, name=name))
        except ValueError as error:
            raise ValueError(f"{where}: {error}") from error
    return curves if segment == "all" else curves[0]
