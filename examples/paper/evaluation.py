"""Evaluation of the solved contacts: table, claim of Spinu et al., sphere and its reference."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from paper.cases import (
    CENTRED,
    HERTZ_APPROACH,
    HERTZ_PRESSURE,
    HERTZ_RADIUS,
    PRINTED_THICKNESS,
    ROLLER_LOAD,
    SERIES,
    SPHERE,
    Array,
    Result,
    Series,
    of_series,
)

NO_BREAK_SPACE = "\u00a0"


@dataclass(frozen=True)
class Claim:
    """Whether a coating brings what Spinu et al. claim: a smaller riser and a larger contact area.

    `riser` and `area` are relative changes against E1 = E2.
    """

    series: Series
    ratio: float
    riser: float
    area: float

    @property
    def holds(self) -> bool:
        """Smaller riser and larger area, both."""
        return self.riser < 0 < self.area


def claims(results: Iterable[Result]) -> list[Claim]:
    """Return how riser and area of the roller differ from E1 = E2, for each ratio but 1."""
    results = list(results)
    found = []
    for series in SERIES[1:]:
        plain = next(r for r in of_series(results, series) if r.ratio == 1)
        for result in of_series(results, series):
            riser = result.riser / plain.riser - 1
            area = result.solution.contact_area / plain.solution.contact_area - 1
            if result is not plain:
                found.append(Claim(series, result.ratio, riser, area))
    return found


@dataclass(frozen=True)
class Reference:
    """Reference values of the sphere for one ratio of moduli, relative to Hertz' contact."""

    ratio: float
    peak: float
    approach: float
    radius: Array
    pressure: Array


@cache
def references() -> list[Reference]:
    """Return the reference values of the coated sphere, from soft to stiff."""
    text = Path(__file__).with_name("sphere_coated.json").read_text()
    return [
        Reference(
            case["E1_over_E2"],
            case["pmax_over_pH"],
            case["delta_over_deltaH"],
            np.array(case["r_over_aH"]),
            np.array(case["p_over_pH"]),
        )
        for case in json.loads(text)["cases"]
    ]


@dataclass(frozen=True)
class Deviation:
    """Deviation of the sphere from its reference for one ratio of moduli.

    `peak` and `approach` are relative; `pressure` is the largest difference over p_H within 95 %
    of the contact radius: at the edge p falls with infinite slope, which no cell can follow.
    """

    ratio: float
    peak: float
    approach: float
    pressure: float


def deviations(results: Iterable[Result]) -> list[Deviation]:
    """Return how far the solved spheres are from their reference values."""
    found = []
    for result, reference in zip(of_series(results, SPHERE), references(), strict=True):
        solution = result.solution
        radius, pressure = sphere_profile(result)
        inner = reference.radius < 0.95 * reference.radius[-1]
        # p² is nearly linear in r², and is interpolated so.
        squares = np.interp(reference.radius[inner] ** 2, radius**2, pressure**2)
        found.append(
            Deviation(
                result.ratio,
                solution.peak_pressure / HERTZ_PRESSURE / reference.peak - 1,
                solution.approach / HERTZ_APPROACH / reference.approach - 1,
                float(np.max(np.abs(np.sqrt(squares) - reference.pressure[inner]))),
            )
        )
    return found


def sphere_profile(result: Result) -> tuple[Array, Array]:
    """Return r/a_H and p/p_H of the cells along x in the positive quadrant."""
    x, pressure = result.profile("x")
    offset = np.min(np.abs(result.solution.y))
    half = x > 0
    return np.hypot(x, offset)[half] / HERTZ_RADIUS, pressure[half] / HERTZ_PRESSURE


def thickness_note(results: Iterable[Result]) -> str:
    """Return why two thicknesses are shown, with the half-width that was computed."""
    plain = next(r for r in results if r.series == CENTRED[0] and r.ratio == 1)
    growth = PRINTED_THICKNESS / plain.half_width
    note = (
        "The paper prints h~=~0.04~R, which is 0.2~mm, and says that this closely matches the "
        "half-width of the contact for E₁~=~E₂. That half-width is "
        f"{1e3 * plain.half_width:.4f}~mm, to which 0.04~mm is close; a half-width of 0.2~mm "
        f"would need about {1e-3 * ROLLER_LOAD * growth**2:.0f}~kN instead of "
        f"{1e-3 * ROLLER_LOAD:g}~kN. So h~=~0.04~mm is the main case, and 0.2~mm stands beside it."
    )
    return note.replace("~", NO_BREAK_SPACE)


@dataclass(frozen=True)
class Column:
    """A column of the table: its quantity, its unit and the number of decimals.

    `heading` is its name over several lines, for a narrow table.
    """

    name: str
    heading: str
    unit: str
    decimals: int
    value: Callable[[Result], float]


COLUMNS = (
    Column("peak", "peak", "MPa", 0, lambda r: 1e-6 * r.solution.peak_pressure),
    Column("central", "central", "MPa", 0, lambda r: 1e-6 * r.solution.central_pressure),
    Column("riser", "riser", "", 3, lambda r: r.riser),
    Column("half-width", "half-\nwidth", "mm", 4, lambda r: 1e3 * r.half_width),
    Column("left end", "left\nend", "mm", 2, lambda r: 1e3 * r.solution.contact_extent[0][0]),
    Column("right end", "right\nend", "mm", 2, lambda r: 1e3 * r.solution.contact_extent[0][1]),
    Column("area", "area", "mm²", 3, lambda r: 1e6 * r.solution.contact_area),
    Column("approach", "ap-\nproach", "µm", 3, lambda r: 1e6 * r.solution.approach),
    Column("tilt", "tilt", "1e-5", 2, lambda r: 1e5 * r.solution.tilt[0]),
    Column("iterations", "iter-\nations", "", 0, lambda r: r.solution.report.iterations),
    Column("time", "time", "s", 1, lambda r: r.solution.report.seconds),
)


def table(results: Iterable[Result]) -> tuple[list[str], list[list[str | float]]]:
    """Return header and rows of the table, as they go into ``table.csv``."""
    header = [
        "case",
        "h [mm]",
        "E1/E2",
        *(f"{c.name} [{c.unit}]" if c.unit else c.name for c in COLUMNS),
    ]
    rows: list[list[str | float]] = [
        [r.series.name, 1e3 * r.series.thickness, r.ratio, *(c.value(r) for c in COLUMNS)]
        for r in results
    ]
    return header, rows
