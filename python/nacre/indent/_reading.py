"""What an indentation of a film would tell of it if it were read without the substrate."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.units import plain
from nacre.results.verdict import DIGITS, Demand, Verdict, judged, number, reasons

if TYPE_CHECKING:
    from nacre.indent.solution import IndentSolution

Array = npt.NDArray[np.float64]

UNASKED = "Give a tolerance to judge it."
READ = 0.05
"""Largest error of a modulus of which the film is said to be read."""
TOLERATED = 0.10
"""Error of the modulus up to whose depth a verdict tells where no tolerance is given."""
DEPTHS, SHALLOWEST = 40, 1e-3
"""Number of depths, and the smallest over the largest."""


@dataclass(frozen=True, eq=False)
class Reading:
    """Moduli of a film, of bare half-spaces that bear the same load at the same depth."""

    depths: Array
    """Depths [m]."""
    moduli: Array
    """Young's moduli that are read there [Pa]."""
    modulus: float
    """Young's modulus of the film [Pa]."""
    has_adhesion: bool
    """Whether the indentation has adhesion, which the loads here have not."""
    warnings: tuple[str, ...] = ()
    """Warnings about the indentation."""
    tolerance: float | None = None
    """Largest error of the modulus that is tolerated, if given."""


def apparent_modulus(solution: IndentSolution) -> Reading | None:
    """Return the readings of an indentation up to its largest depth, or None without a film.

    With a stiffness E' = E/(1 − ν²) of the tip, loads at one depth are as 1/(1/E'_film + 1/E'_tip).
    """
    body = solution.body
    largest = float(np.max(solution.approach))
    if not body.layers or not largest > 0:
        return None
    film, depths = body.layers[0].material, largest * np.geomspace(SHALLOWEST, 1.0, DEPTHS)
    loads, bare = (
        core.Indentation(sample, solution.tip, solution.counterbody, None)
        .at("stable", approach=depths)
        .number("load")
        for sample in (body, core.HalfSpace(film))
    )
    tip = solution.counterbody and solution.counterbody.substrate
    compliance = 1 / tip.plane_strain_modulus if isinstance(tip, core.Elastic) else 0.0
    reduced = loads / bare / (1 / film.plane_strain_modulus + compliance)
    # Beyond the tip's own stiffness no film can be read.
    left = 1 / reduced - compliance
    with np.errstate(divide="ignore"):
        moduli = np.where(left > 0, (1 - film.poisson**2) / left, math.inf)
    has_adhesion = solution.adhesion is not None
    return Reading(depths, moduli, film.young, has_adhesion, solution.warnings, solution.tolerance)


def checked_tolerance(tolerance: float | None) -> float | None:
    """Return a tolerance, which must be above 0 and finite if there is one."""
    if tolerance is not None and not 0 < core.real("tolerance", tolerance) < math.inf:
        raise ValueError(f"tolerance must be above 0 and finite, got {tolerance:g}")
    return tolerance


def tolerated(tolerance: float | None) -> str:
    """Return a tolerance at the end of a phrase, if there is one."""
    return "" if tolerance is None else f", ± {plain(100 * tolerance, DIGITS)} % tolerated"


def substrate_verdict(reading: Reading | None, tolerance: float | None = None) -> Verdict:
    """Return whether the largest depth tells the modulus of the film, to a tolerance if any."""
    if reading is None:
        return Verdict("unknown", "Cannot tell: there is no film, or no depth above 0.")
    tolerance = reading.tolerance if tolerance is None else tolerance
    ratio = float(reading.moduli[-1]) / reading.modulus
    error = abs(ratio - 1)
    read, film = number(float(reading.moduli[-1]), "Pa"), number(reading.modulus, "Pa")
    start = "The film is read" if error <= (tolerance or READ) else "The substrate shows"
    words = f"{start}: as a bare film, this curve gives {read} for a film of {film} "
    words += f"({plain(ratio, DIGITS)} times{tolerated(tolerance)})."
    if not math.isfinite(ratio):
        words = "The substrate shows: at this depth the curve tells nothing of the film."
    left_out = ["Adhesion is left out of this reading."] if reading.has_adhesion else []
    return judged(
        [
            Demand(
                "modulus",
                "of the film",
                error,
                0.0,
                None,
                tolerance,
                "given",
                "",
                sentence=words,
                leads=True,
            )
        ],
        doubts=reasons(reading.warnings, "unknown"),
        notes=[_depth(reading, tolerance or TOLERATED), *left_out],
        unasked=UNASKED if tolerance is None else None,
        question=None if tolerance is None else f"modulus of the film{tolerated(tolerance)}",
    )


def _depth(reading: Reading, tolerance: float) -> str:
    """Return up to which depth the error is tolerated."""
    errors = np.abs(reading.moduli / reading.modulus - 1)
    beyond = np.flatnonzero(errors > tolerance)
    share = f"{plain(100 * tolerance, DIGITS)} %"
    if not beyond.size:
        return f"The error is below {share} at all these depths."
    if not (first := int(beyond[0])):
        least = number(float(reading.depths[0]), "m")
        return f"The error is above {share} from {least} of depth on."
    ends = slice(first - 1, first + 1)
    depth = np.interp(tolerance, errors[ends], reading.depths[ends])
    return f"The error is below {share} only up to {number(float(depth), 'm')} of depth."
