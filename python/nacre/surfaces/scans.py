"""Single profiles in text with a head: SMD of ISO 5436-2, SDF of ISO 25178-71, and PRF.

NPL's software gauges are in these forms, whose examples are at
http://resource.npl.co.uk/softgauges/Help.htm.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import numpy.typing as npt

from nacre.surfaces.heights import metres, without_sentinels

Array = npt.NDArray[np.float64]

BEGIN = 2000
"""Bytes in which a head names its form."""
AXES = re.compile(rb"\bPRF\b[^\r\n]*\s+CX[\s\0]")
"""What the heads of SMD and PRF have in common."""
SDF = re.compile(rb"a.{1,15}\r?\n(?s:.*)^NumProfiles\s*=\s*1\s*$", re.MULTILINE | re.IGNORECASE)
END = re.compile(r"^\s*(?:EOR|\x03|\*)[ \t]*$", re.MULTILINE)
"""Ends of records; those of the standard's SMD are no letters."""


def scan(path: Path) -> tuple[Array, Array] | None:
    """Return places and heights of a profile [m]; None where a file is another one."""
    with path.open("rb") as file:
        begin = file.read(BEGIN)
    form = "SDF" if SDF.match(begin) else "SMD or PRF" if AXES.search(begin) else ""
    if not form:
        return None
    text = path.read_text(encoding="latin-1").replace("\0", " ")
    try:
        records = END.split(text)
        count, step, size = (_sdf if form == "SDF" else _axes)(records)
        fields = records[1 if form == "SDF" else 2].split()
        if len(fields) != count or count < 2 or not (0 < step < np.inf and 0 < size < np.inf):
            raise ValueError(
                f"its head has {count:g} points, {step:g} m apart, and heights in {size:g} m, and "
                f"it has {len(fields)} heights"
            )
        heights = np.array([np.nan if text == "BAD" else float(text) for text in fields])
    except (ValueError, LookupError, StopIteration) as error:
        reason = str(error)[:200] if type(error) is ValueError else "a number or a unit is missing"
        raise ValueError(
            f"{str(path)!r} must be whole, as a profile in {form}: {reason}"
        ) from error
    return step * np.arange(count), size * without_sentinels(heights)


def _sdf(records: list[str]) -> tuple[float, float, float]:
    """Return the number of points, their distance, and the unit of the heights [m]."""
    pairs = [line.partition("=") for line in records[0].splitlines()]
    values = {name.strip().lower(): value for name, _, value in pairs}
    count, step, size = (float(values[name]) for name in ("numpoints", "xscale", "zscale"))
    return count, step, size


def _axes(records: list[str]) -> tuple[float, float, float]:
    """Return what `_sdf` does, of lines CX and CZ: kind, points, unit, factor, type, and step.

    In PRF the step is in a line ``SPACING CX`` of the second record. Some programs write numbers
    in front of units.
    """
    lines = [line.split() for line in records[0].splitlines()]
    lines = [line for line in lines if line[:1] in (["CX"], ["CZ"])]
    axes = {line[0]: line[1:] for line in lines}
    if len(axes) < len(lines):
        raise ValueError("its head has several lines CX or CZ")
    if axes["CX"][0] == "A":
        raise ValueError("its places are absolute (CX A), and must have even steps (CX I)")
    sizes, numbers = {}, {}
    for name, fields in axes.items():
        sizes[name] = next(size for field in fields[2:] if (size := metres(field)))
        numbers[name] = [float(field) for field in fields[2:] if re.match(r"[\d.+-]", field)]
    is_standard = metres(axes["CX"][2]) is not None
    steps = numbers["CX"][1:] if is_standard else numbers["CX"]
    spacings = [line.split()[2:] for line in records[1].splitlines() if "SPACING CX" in line]
    if len(spacings) > 1:
        raise ValueError("it has several lines SPACING CX")
    step = float(spacings[0][0]) if spacings else steps[0]
    factor = numbers["CX"][0] if is_standard else 1.0
    places, count = (float(axes[name][1]) for name in ("CX", "CZ"))
    if places != count:
        raise ValueError(f"its head has {places:g} places and {count:g} heights")
    return count, step * factor * sizes["CX"], numbers["CZ"][0] * sizes["CZ"]
