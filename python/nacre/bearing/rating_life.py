"""Rating life of a solved bearing: reference life, modified life, and that of a load spectrum."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self, TypeVar

import numpy as np

import nacre._core as core
from nacre._tools.renamed import renamed
from nacre._tools.typing import among
from nacre._tools.units import rounded
from nacre.bearing.basic import ROLLERS, UNREAD, known_load, life_under, mean_dynamic_load
from nacre.bearing.contact_laws import LAMINAE
from nacre.bearing.geometry import RINGS, Bearing, Ring, above
from nacre.bearing.iso import Edge, ReferenceLife, edge_factors, equivalent_load, reference_life
from nacre.bearing.kinds import CurvedRaceways, RollerBearing
from nacre.bearing.modified import (
    Lubrication,
    fatigue_load_limit,
    reliability_factor,
    simple_fatigue_load_limit,
)
from nacre.bearing.plausible import doubts_on
from nacre.bearing.static import static_rating
from nacre.bearing.verdict import doubts_and_cautions, life_verdict
from nacre.results.display import number
from nacre.results.quantities import frozen, quantity
from nacre.results.report import Rows
from nacre.results.rows import Row, remark
from nacre.results.shown import TableResult
from nacre.results.verdict import Verdict, asked

if TYPE_CHECKING:
    from nacre.bearing.pair import PairLife
    from nacre.bearing.solution import BearingSolution

EDGES = {
    "standard": "edge factors of ISO/TS 16281, eq. 60",
    "pressure": "edge factors from the solved pressure, eqs 58 and 59",
    None: "without edge factors",
}
"""Words for the factors of a life."""
BARRELS = "barrels have none of the standard's edge factors"
"""The same of spherical rollers."""
LATER = ("uncertainty", "doubt", "caution", "basic_life", "comparison", "notes")
"""Fields of lives that older files do not have."""
ROUNDING = 1e-6
"""Share of a force below which its radial or axial component is the rounding of the equilibrium:
bearings are solved to 1e-9 by default."""
ROUNDED = 1e-3
"""Largest difference of a sum of shares and 1: thirds with three digits are as good."""

Duty = tuple[float, Sequence[float | None], float]
"""A part of a load spectrum: share of the time, forces along x, y and z [N], speed [rad/s]."""


@frozen()
class BearingLife(TableResult):
    """Rating life of ISO/TS 16281 and ISO 281: a model.

    Without lubrication only the reference life counts; neither residual stress nor roughness does.
    Of coated bodies the life is that of bare ones under the same loads, or pressures.

    Examples
    --------
    >>> from nacre.bearing import DeepGrooveBall
    >>> bearing = DeepGrooveBall(
    ...     count=7, diameter=11.5e-3, pitch_diameter=43.5e-3, capacity=23.4e3
    ... )
    >>> life = bearing.solve(force=(1000.0, 0.0, None), speed=100.0, model="iso16281").life()
    >>> 13e3 < life.l10r < 13.3e3, round(life.hours / life.revolutions * 3600 * 100, 3)
    (True, 6.283)
    """

    _TITLE = "rating life of a bearing"
    _IN_SI = True
    _LATER = (
        *("hours", "l10r", "reliability", "reliability_factor", "modification_factor"),
        *("viscosity_ratio", "contamination_factor", "required_life", *LATER),
        *("fatigue_load_limit", "simple_fatigue_load_limit"),
        "basic_load",
    )

    revolutions: float = quantity()
    """Life in revolutions: ``a_1 a_ISO L_10r``; infinite without load."""
    hours: float | None = quantity()
    """Life in hours of operation; None where the bearing is at rest, as without a speed."""
    l10r: float = quantity()
    """Reference rating life L_10r in millions of revolutions; infinite without load."""
    equivalent_load: float = quantity("N", label="equivalent load")
    """Equivalent reference load [N]; of a spectrum that of its L_10r."""
    capacity: float = quantity("N", label="rating")
    """Dynamic load rating [N]: C_r of the bearing, or C_a of a thrust bearing."""
    ring_capacities: tuple[float, float] = quantity("N", dims=("ring",), label="of contacts")
    """Ratings of contacts [N]: of one element with inner and outer ring."""
    reliability: float = quantity()
    """Share of bearings that reach the life."""
    reliability_factor: float = quantity()
    """Factor a_1."""
    modification_factor: float | None = quantity(label="a_ISO")
    """Factor a_ISO: of a spectrum that of the whole; None without lubrication."""
    viscosity_ratio: float | None = quantity(label="viscosity ratio κ")
    """Viscosity ratio κ: of a spectrum the smallest; None without lubrication."""
    contamination_factor: float | None = quantity(label="contamination e_C")
    """Contamination factor e_C; None without lubrication."""
    fatigue_load_limit: float | None = quantity("N", label="fatigue load limit")
    """Fatigue load limit C_u [N]; None without lubrication."""
    simple_fatigue_load_limit: float | None = quantity("N", label="by C_0 alone")
    """C_u by the standard's simple formula [N]: C_0/22 or C_0/8.2."""
    basic_life: float | None = quantity()
    """Basic rating life L_10 of ISO 281 in millions of revolutions; None where X and Y are not
    known."""
    basic_load: float | None = quantity("N")
    """Equivalent dynamic load P of ISO 281 [N], by X and Y: of a spectrum the mean one."""
    model: str
    """Model in words."""
    comparison: str | None = None
    """Why the basic life differs, or is not known; None of balls with one."""
    notes: tuple[str, ...] = ()
    """Numbers beyond their plausible ranges, which were warned of."""
    required_life: float | None = None
    """Life that is required [h], which decides the verdict; None without."""
    uncertainty: float | None = None
    """Estimated error, as a share of the life, due to the cells of solved contacts.

    It is 0 of the standard's contacts, which are formulas, and None where it is not known.
    """
    doubt: str | None = None
    """What leaves the verdict unknown; None without."""
    caution: str | None = None
    """What leaves the verdict fair at best; None without."""

    _of: ClassVar[str] = ""

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        fields = dict(state)
        if fields.get("l10r") is None:  # states of 0.1.0, of L_10r in millions of revolutions alone
            fields |= {"l10r": state["revolutions"], "revolutions": state["revolutions"] * 1e6}
            fields |= {"hours": None, "reliability": 0.9, "reliability_factor": 1.0}
        fields["notes"] = tuple(fields.get("notes") or ())
        return super()._restored(fields)

    @asked
    def verdict(self, required_life: float | None = None) -> Verdict:
        """Verdict: how long the bearing lives; bad below the required life, good from 1.5 of it.

        Parameters
        ----------
        required_life : float, optional
            Life that is required [h], by default that of the life.

        Returns
        -------
        Verdict
            Verdict; unknown where no life is required.
        """
        return life_verdict(required(self, required_life))

    def _rows(self) -> list[Row]:
        if math.isinf(self.l10r):
            words = "infinite: no element is loaded"
            return [Row("l10r", "life", words, self.l10r), *super()._rows()]
        text = f"{rounded(self.l10r, 4)} million revolutions"
        rows = [Row("l10r", "life L10r", text, self.l10r)]
        if self._is_modified or self.reliability_factor != 1:
            label = f"life L{round(100 * (1 - self.reliability), 6):g}{'m' * self._is_modified}"
            text = f"{rounded(self.revolutions / 1e6, 4)} million revolutions"
            rows.append(Row("revolutions", label, text, self.revolutions))
        if self.hours is not None and math.isfinite(self.hours):
            rows.append(Row("hours", "hours", rounded(self.hours, 4), self.hours))
        if self.basic_life is not None and self.basic_load is not None:
            row = basic_row(self.basic_life, hours_per_revolution(self))
            load = f"{row.text}, P {number(self.basic_load, 'N')}"
            rows.append(row._replace(text=load))
        return [*rows, *super()._rows()]

    def _remarks(self) -> list[Row]:
        return [*compared(self.comparison), *super()._remarks()]

    def _report_rows(self) -> Rows:
        return self._rows()

    l10 = renamed("l10", "l10r")

    @property
    def _is_modified(self) -> bool:
        return self.modification_factor is not None


def basic_row(life: float, hours: float) -> Row:
    """Return the row of a basic life; also in hours, where a revolution takes a finite time [h]."""
    text = f"L10 {rounded(life, 4)} million revolutions"
    if math.isfinite(hours):
        text += f", {rounded(life * 1e6 * hours, 4)} h"
    return Row("basic_life", "ISO 281, catalogue", text, life)


def hours_per_revolution(life: BearingLife | PairLife) -> float:
    """Return the time of a revolution [h]; infinite at rest."""
    return life.hours / life.revolutions if life.hours else math.inf


def compared(words: str | None) -> list[Row]:
    """Return the row of why the basic life differs or is not known, if any."""
    return [remark("catalogue", words)] if words else []


class _Rate(NamedTuple):
    """Life of a bearing under one load."""

    reference: ReferenceLife
    basic: float | None
    """Equivalent dynamic load of ISO 281 [N]; None where it is not known."""
    cycles: float
    """Share of the time, times the speed [rad/s]."""
    least: float | None
    """Share of the life that is left with its error; None where that is not known."""
    factor: float
    """Factor a_ISO, 1 without lubrication."""
    kappa: float | None


class _Terms(NamedTuple):
    """What a life counts: edges, the ring that rotates, lubrication and fatigue load limit [N]."""

    edge: Edge
    rotating: Ring
    lubrication: Lubrication
    limit: float | None

    def rate(self, solution: BearingSolution, share: float, speed: float) -> _Rate:
        """Return the life under the load of a solution, for a share of the time."""
        bearing, cycles = solution.bearing, share * abs(speed)
        reference = reference_of(solution, self.edge, self.rotating)
        x, y, z = solution.force
        radial, axial = math.hypot(x, y), abs(z)
        least_force = ROUNDING * math.hypot(radial, axial)
        basic = known_load(
            bearing, *(force if force > least_force else 0.0 for force in (radial, axial))
        )
        least = _least(solution, self.edge, reference.load_power)
        if self.limit is None:
            return _Rate(reference, basic, cycles, least, 1.0, None)
        limit, load = self.limit, reference.equivalent_load
        factor = self.lubrication.factor(bearing, speed, limit, load)
        if least:  # the load is then larger, and a_ISO smaller
            more = equivalent_load(bearing, least) / equivalent_load(bearing, 1.0)
            least *= self.lubrication.factor(bearing, speed, limit, load * more) / factor
        return _Rate(
            reference, basic, cycles, least, factor, self.lubrication.kappa(bearing, speed)
        )


def _least(solution: BearingSolution, edge: Edge, power: float) -> float | None:
    """Return the share of a reference life that is left with its error; None if not known.

    With ``L ∝ Q^-p`` the share of the error is ``δL/L = p δQ/Q``. p is 3 of balls and 4 of the
    laminae of rollers: `ReferenceLife.load_power`, which is not the exponent 10/3 of the equivalent
    load. Loads err by `BearingReport.load_error`; those with factors from the pressure also by the
    share by which the peak pressure does, as these factors are pressures over Hertz's.
    """
    report = solution.report
    error = 0.0 if solution.model == "iso16281" else report.load_error
    peak = (report.discretisation or {}).get("peak_pressure") if edge == "pressure" else 0.0
    if error is None or peak is None:
        return None
    return max(0.0, 1 - power * (error + peak / (solution.peak_pressure or 1.0)))


def reference_of(solution: BearingSolution, edge: Edge, rotating: Ring) -> ReferenceLife:
    """Return the reference life of a solution with these factors for the edges."""
    loads, factors = solution.loads, np.array(1.0)
    if solution.lamina_loads is not None:
        loads = solution.lamina_loads
        if edge == "standard" and not isinstance(solution.bearing, CurvedRaceways):
            factors = edge_factors(LAMINAE)
        elif edge == "pressure":
            factors = solution.edge_factors()
    return reference_life(solution.bearing, loads, factors, rotating)


def _words(solution: BearingSolution, edge: Edge, reliability: float) -> str:
    """Return the model of the reference life in words."""
    words = f"ISO/TS 16281, {100 * reliability:g} % reliability, a model"
    if solution.lamina_loads is None:
        return words
    barrels = edge == "standard" and isinstance(solution.bearing, CurvedRaceways)
    return f"{words}; {BARRELS if barrels else EDGES[edge]}"


def _duties(
    solution: BearingSolution, spectrum: Iterable[Duty]
) -> list[tuple[float, dict[str, object], float]]:
    """Return the parts of a spectrum, checked, with shares that sum to 1."""
    duties = list(spectrum) if isinstance(spectrum, Iterable) else []
    if not duties or not all(isinstance(duty, Sequence) and len(duty) == 3 for duty in duties):
        raise TypeError(
            f"spectrum must be a list of shares, forces and speeds, such as "
            f"(0.5, (1000.0, 0.0, None), 100.0), got {spectrum!r}"
        )
    places = [f"spectrum[{k}]" for k in range(len(duties))]
    shares = [above(f"share of {at}", duty[0]) for at, duty in zip(places, duties, strict=True)]
    if abs(sum(shares) - 1) > ROUNDED:
        raise ValueError(f"spectrum must have shares that sum to 1, got {sum(shares):g}")
    checked = []
    for place, share, (_, force, speed) in zip(places, shares, duties, strict=True):
        rotation = above(f"speed of {place}", speed, -math.inf, "rad/s")
        if rotation == 0:
            raise ValueError(f"speed of {place} must not be 0: at rest there are no revolutions")
        checked.append((share / sum(shares), _conditions(solution, place, force), rotation))
    return checked


def _conditions(solution: BearingSolution, place: str, force: object) -> dict[str, object]:
    """Return the keywords of `solve` for a force of a spectrum; all else is as in the solution."""
    loaded = solution.loaded_directions
    if loaded is None:
        raise ValueError(
            "spectrum must be that of a solution whose loaded directions are known, got one of a "
            "file of nacre 0.1.0: solve it again"
        )
    forces = core.vector(f"force of {place}", 3, force)
    for axis, value, is_loaded in zip("xyz", forces, loaded, strict=False):
        if value is None and is_loaded:
            raise ValueError(f"force of {place} must have a number along {axis}, which is loaded")
    moved = zip(forces, solution.displacement, strict=True)
    tilts = list(zip(solution.tilt, solution.moment, loaded[3:], strict=True))
    return {
        "force": forces,
        "displacement": [place if value is None else None for value, place in moved],
        "moment": [moment if is_loaded else None for _, moment, is_loaded in tilts],
        "tilt": [None if is_loaded else tilt for tilt, _, is_loaded in tilts],
    }


def _duty_solution(
    solution: BearingSolution, conditions: dict[str, object], speed: float
) -> BearingSolution:
    """Return the bearing solved under a load of a spectrum."""
    bearing: Any = solution.bearing
    keywords = conditions | {"rotation": solution.rotation, "rotating": solution.rotating}
    model, cells = solution.model, solution.cells
    solved: BearingSolution = bearing.solve(**keywords, speed=speed, model=model, cells=cells)
    return solved


def life_of(
    solution: BearingSolution,
    edge: Edge,
    rotating: Ring | None,
    speed: float | None,
    reliability: float,
    lubrication: Lubrication,
    limit: float | None,
    spectrum: Iterable[Duty] | None,
) -> BearingLife:
    """Return what `BearingSolution.life` documents."""
    if not among(edge, EDGES):
        raise ValueError(f'edge must be "standard", "pressure" or None, got {edge!r}')
    rotating = solution.rotating if rotating is None else rotating
    if not among(rotating, RINGS):
        raise ValueError(f'rotating must be "inner" or "outer", got {rotating!r}')
    factor = reliability_factor(reliability)
    lubrication.check(solution.bearing)
    limit = _limit(solution.bearing, lubrication, limit)
    terms = _Terms(edge, rotating, lubrication, limit)
    if spectrum is None:
        rotation = solution.speed if speed is None else above("speed", speed, -math.inf, "rad/s")
        rates = [terms.rate(solution, 1.0, rotation)]
    elif speed is not None:
        raise ValueError("speed must not be given with spectrum, which has speeds")
    else:
        rates = [
            terms.rate(_duty_solution(solution, conditions, turns), share, turns)
            for share, conditions, turns in _duties(solution, spectrum)
        ]
    words = _words(solution, edge, reliability)
    if lubrication.is_known:
        words += f"; a_ISO of ISO 281, {lubrication.cleanliness(solution.bearing)[1]}"
    if spectrum is not None:
        words += f"; Miner's sum of {len(rates)} loads"
    life = _life_of_spectrum(solution.bearing, terms, rates, (float(reliability), factor), words)
    fastest = max(rate.cycles for rate in rates) if spectrum is None else 0.0
    life = replace(life, notes=_notes(solution.bearing, life, terms, fastest))
    doubt, caution = doubts_and_cautions(solution, life)
    return replace(life, doubt=doubt or None, caution=caution or None)


def _notes(bearing: Bearing, life: BearingLife, terms: _Terms, speed: float) -> tuple[str, ...]:
    """Return what numbers of a life ask that are beyond their plausible ranges."""
    texts = doubts_on("speed times pitch_diameter", speed * bearing.pitch)
    load = life.equivalent_load
    light = doubts_on("equivalent load", load, life.capacity) if load > 0 else []
    if not light and life.hours is not None and math.isfinite(life.hours):
        texts += doubts_on("life", life.hours)
    texts += light
    if terms.limit is not None and life.viscosity_ratio is not None:
        texts += doubts_on("fatigue_load_limit", terms.limit, static_rating(bearing))
        texts += terms.lubrication.doubts(life.viscosity_ratio)
    return tuple(texts)


Life = TypeVar("Life", "BearingLife", "PairLife")


def required(life: Life, hours: float | None) -> Life:
    """Return a life with the required one [h], checked."""
    if hours is None:
        return life
    if life.hours is None and math.isfinite(life.revolutions):
        raise ValueError("required_life must be given with a speed, got none: there are no hours")
    return replace(life, required_life=above("required_life", hours))


def _limit(bearing: Bearing, lubrication: Lubrication, limit: float | None) -> float | None:
    """Return the fatigue load limit [N]: the argument, or that of the bearing; None without oil."""
    if lubrication.is_known:
        return fatigue_load_limit(bearing) if limit is None else above("fatigue_load_limit", limit)
    if limit is not None:
        raise ValueError("fatigue_load_limit must be given with a lubrication, got none")
    return None


def _life_of_spectrum(
    bearing: Bearing,
    terms: _Terms,
    rates: Sequence[_Rate],
    reliability: tuple[float, float],
    words: str,
) -> BearingLife:
    """Return the life under all loads, of which each uses up its share: Miner."""
    turned, is_known = sum(rate.cycles for rate in rates), terms.lubrication.is_known
    shares = [rate.cycles / turned for rate in rates] if turned else [1.0]
    l10r = _harmonic(shares, [rate.reference.l10r for rate in rates])
    lives = [rate.reference.l10r * rate.factor for rate in rates]
    modified, uncertainty = _harmonic(shares, lives), None
    if all(rate.least is not None for rate in rates):
        left = [life * (rate.least or 0.0) for rate, life in zip(rates, lives, strict=True)]
        uncertainty = 1 - _harmonic(shares, left) / modified if math.isfinite(modified) else 0.0
    revolutions = reliability[1] * modified * 1e6
    loads = [rate.basic for rate in rates if rate.basic is not None]
    basic = mean_dynamic_load(bearing, loads, shares) if len(loads) == len(rates) else None
    is_roller = isinstance(bearing, RollerBearing)
    return BearingLife(
        revolutions=revolutions,
        hours=revolutions * 2 * math.pi / turned / 3600 if turned else None,
        l10r=l10r,
        equivalent_load=equivalent_load(bearing, l10r),
        capacity=float(bearing.capacity or 0.0),
        ring_capacities=rates[0].reference.capacities,
        reliability=reliability[0],
        reliability_factor=reliability[1],
        modification_factor=(
            (modified / l10r if math.isfinite(l10r) else rates[0].factor) if is_known else None
        ),
        viscosity_ratio=min((rate.kappa for rate in rates if rate.kappa is not None), default=None),
        contamination_factor=terms.lubrication.cleanliness(bearing)[0] if is_known else None,
        fatigue_load_limit=terms.limit,
        simple_fatigue_load_limit=simple_fatigue_load_limit(bearing) if is_known else None,
        basic_life=None if basic is None else life_under(bearing, basic),
        basic_load=basic,
        comparison=UNREAD if basic is None else ROLLERS if is_roller else None,
        model=words,
        uncertainty=uncertainty,
    )


def _harmonic(shares: Sequence[float], lives: Sequence[float]) -> float:
    """Return the mean of lives by Miner's rule; infinite where all are, and 0 where one is."""
    if min(lives) == 0:
        return 0.0
    used = sum(share / life for share, life in zip(shares, lives, strict=True))
    return 1 / used if used > 0 else math.inf
