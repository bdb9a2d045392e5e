"""Lives from the volume under stress, as ratios: Lundberg–Palmgren, Ioannides–Harris, Zaretsky.

``ln(1/S) = A N^e ∫ (τ − τ_u)₊^c z^(−h) dV`` says how many of many equal contacts survive N cycles.
A is not known for coatings, and differs from steel to steel, so that only ratios of lives of equal
materials mean anything: ``L/L_ref = (I_ref/I)^(1/e)``. The forms and exponents are those of
Lundberg and Palmgren, Acta Polytechnica, Mech. Eng. Ser. 1 (1947) no. 3 and 2 (1952) no. 4;
Ioannides and Harris (1985), as papers quote them, whose depth is here z in place of a mean weighted
by the stress; and after Zaretsky, J. Propul. Power 3 (1987) 76, whose exponents were not compared
with the original.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ParamSpec, TypeVar

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.arguments import read_fields
from nacre._tools.notices import heard, warn
from nacre._tools.progress import check_progress, lasting
from nacre._tools.typing import Member
from nacre.bearing.film import is_line
from nacre.bearing.geometry import RINGS, Bearing, above
from nacre.bearing.solution import BearingSolution
from nacre.contact.solution import Solution, check_unyielded
from nacre.results.quantities import frozen, quantity
from nacre.results.rows import Row
from nacre.results.shown import TableResult

if TYPE_CHECKING:
    from nacre.contact.stresses import Stress

Array = npt.NDArray[np.float64]
P = ParamSpec("P")
T = TypeVar("T")

SHALLOWEST, DEEPEST = 0.05, 5.0
"""Depths between which the integral is taken, over the half-width of the contact.

Under a line, 0.24 % of Lundberg and Palmgren's lies above, and 1e-6 below. Zaretsky's has 1e-4
below. The change on beginning at half the depth is reported.
"""
NODES = 16
"""Gauss points in a decade of depth.

Twice as many change the integral of the largest shear stress by 3e-7, and that of the orthogonal
one, which cells make rough near the surface, by 1e-4.
"""
OF_RINGS = " of rings, "
"""Words in the model of a ratio of lives of bearings."""
LINE, POINT = 9 / 8, 10 / 9
"""Weibull slopes e of line and point contacts, Lundberg and Palmgren."""


@dataclass(frozen=True, kw_only=True)
class LundbergPalmgren:
    """Model of Lundberg and Palmgren: the orthogonal shear stress, without a limit.

    Parameters
    ----------
    c : float, optional
        Exponent of the stress.
    h : float, optional
        Exponent of the depth.
    e : float, optional
        Weibull slope; by default 9/8 of line contacts and 10/9 of others.
    weight : float, optional
        Factor of the integral, by which materials may differ.

    Raises
    ------
    ValueError
        If an argument is out of range.

    Examples
    --------
    >>> from nacre.bearing import LundbergPalmgren
    >>> round(LundbergPalmgren().c, 3)
    10.333
    """

    c: float = 31 / 3
    """Exponent of the stress."""
    h: float = 7 / 3
    """Exponent of the depth."""
    e: float | None = None
    """Weibull slope; None: 9/8 of line contacts and 10/9 of others."""
    weight: float = 1.0
    """Factor of the integral."""

    def __post_init__(self) -> None:
        """Check the exponents."""
        read_fields(self)
        for name, least in (("c", 0.0), ("e", 0.0), ("weight", 0.0), ("h", -math.inf)):
            value = getattr(self, name)
            if name != "e" or value is not None:
                above(name, value, least)

    @property
    def limit(self) -> float:
        """Stress below which nothing fails [Pa]."""
        return 0.0

    def slope(self, *, line: bool) -> float:
        """Return the Weibull slope of a line contact, or of another."""
        return self.e if self.e is not None else LINE if line else POINT

    def power(self, slope: float) -> float:
        """Return the exponent of the stress in the integral."""
        return self.c

    def shear(self, stress: Stress) -> Array:
        """Return the stress that counts, ``(nz, nx, ny)`` [Pa]."""
        return np.abs(stress.components["yz"])


LEAST_FATIGUE_LIMIT = 1e5
"""Smallest fatigue limit [Pa] of a solid: less was meant in MPa or GPa."""


@dataclass(frozen=True, kw_only=True)
class IoannidesHarris(LundbergPalmgren):
    """Model of Ioannides and Harris: as Lundberg and Palmgren's, with a fatigue limit.

    Parameters
    ----------
    fatigue_limit : float
        Orthogonal shear stress τ_u below which nothing fails [Pa].
    c, h, e, weight : float, optional
        As those of `LundbergPalmgren`.

    Raises
    ------
    ValueError
        If an argument is out of range.

    Examples
    --------
    >>> from nacre.bearing import IoannidesHarris
    >>> IoannidesHarris(fatigue_limit=300e6).limit
    300000000.0
    """

    fatigue_limit: float
    """Orthogonal shear stress below which nothing fails [Pa]."""

    def __post_init__(self) -> None:
        """Check the limit, too."""
        super().__post_init__()
        if not (math.isfinite(self.fatigue_limit) and self.fatigue_limit >= 0):
            message = f"must be finite and at least 0, got {self.fatigue_limit!r}"
            raise ValueError(f"fatigue_limit {message}")
        if 0 < self.fatigue_limit < LEAST_FATIGUE_LIMIT:
            raise ValueError(
                f"fatigue_limit must be 0, or at least {LEAST_FATIGUE_LIMIT:g} Pa, "
                f"got {self.fatigue_limit!r} Pa"
            )

    @property
    def limit(self) -> float:
        """Stress below which nothing fails [Pa]."""
        return self.fatigue_limit


@dataclass(frozen=True, kw_only=True)
class Zaretsky(LundbergPalmgren):
    """Model of Zaretsky: the largest shear stress, in the power c e, without depth or limit.

    Parameters
    ----------
    c, h, e, weight : float, optional
        As those of `LundbergPalmgren`, by default 9, 0 and 10/9.

    Raises
    ------
    ValueError
        If an argument is out of range.

    Examples
    --------
    >>> from nacre.bearing import Zaretsky
    >>> round(Zaretsky().power(10 / 9), 6)
    10.0
    """

    c: float = 9.0
    """Exponent of the stress, without the Weibull slope."""
    h: float = 0.0
    """Exponent of the depth."""
    e: float | None = 10 / 9
    """Weibull slope."""

    def power(self, slope: float) -> float:
        """Return the exponent of the stress in the integral."""
        return self.c * slope

    def shear(self, stress: Stress) -> Array:
        """Return the stress that counts, ``(nz, nx, ny)`` [Pa]."""
        stresses: Array = stress.max_shear.reshape(stress.z.size, stress.x.size, stress.y.size)
        return stresses


Model = LundbergPalmgren
Models = Model | Mapping[int | str, Model]


class _Beside(TableResult, is_base=True):
    """Base of results that have the extremes of coating and interfaces beside them."""

    interface_shear: float
    notes: tuple[str, ...]

    def _rows(self) -> list[Row]:
        """Return the numbers, those of layers only where there are some."""
        of_layers = ("coating_tension", "interface_shear", "interface_tension")
        rows = super()._rows()
        return [row for row in rows if self.interface_shear > 0 or row.key not in of_layers]


@frozen()
class StressVolume(_Beside):
    """Integral of the stress in the volume that one contact passes, per length of the track.

    Examples
    --------
    >>> from nacre.bearing import LundbergPalmgren, stress_volume
    >>> steel = nacre.Elastic(young=206e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, steel, load=10.0)
    >>> volume = stress_volume(solution, LundbergPalmgren())
    >>> volume.integral > 0, abs(volume.change) < 0.01
    (True, True)
    """

    _TITLE = "stress volume of a contact"

    integral: float = quantity()
    """Integral of the stress: ``∬ (τ − τ_u)₊^c z^(−h) dx dz``, in line contact ``∫ dz``."""
    change: float = quantity(label="change")
    """Change where it begins at half the depth: relative; 0 below layers."""
    largest: float = quantity("Pa", label="largest stress")
    """Largest stress that counts [Pa]."""
    slope: float = quantity(label="slope e")
    """Slope e of Weibull's distribution."""
    coating_tension: float = quantity("Pa", label="coating tension")
    """Largest tension in the layers [Pa]; 0 without layers."""
    interface_shear: float = quantity("Pa", label="interface shear")
    """Largest shear at an interface [Pa]: that of the traction; 0 without layers."""
    interface_tension: float = quantity("Pa", label="interface tension")
    """Largest tension there [Pa]; 0 without layers."""
    notes: tuple[str, ...]
    """What makes extremes of layers and interfaces uncertain, of those of `StressSummary`."""

    def _rows(self) -> list[Row]:
        text = f"{self.integral:.5g}" if self.integral > 0 else "0: no stress is above the limit"
        return [Row("integral", "integral", text, self.integral), *super()._rows()]


@frozen()
class LifeRatio(_Beside):
    """Life over that of a reference, both at the same probability: a model.

    Examples
    --------
    >>> from nacre.bearing import LundbergPalmgren, life_ratio
    >>> steel = nacre.Elastic(young=206e9, poisson=0.3)
    >>> light, heavy = (
    ...     nacre.solve(nacre.Sphere(5e-3), steel, steel, load=load) for load in (10.0, 20.0)
    ... )
    >>> round(life_ratio(heavy, light, LundbergPalmgren()).ratio, 2)
    0.12
    """

    _TITLE = "ratio of two lives"

    ratio: float = quantity()
    """Life over that of the reference; infinite where no stress is above the fatigue limit."""
    slope: float = quantity(label="slope e")
    """Slope e of Weibull's distribution."""
    largest: float = quantity("Pa", label="largest stress")
    """Largest stress that counts [Pa]."""
    reference_largest: float = quantity("Pa", label="of the reference")
    """The same of the reference [Pa]."""
    change: float = quantity(label="change")
    """Change where integrals begin at half the depth: the largest, relative."""
    coating_tension: float = quantity("Pa", label="coating tension")
    """Largest tension in the layers [Pa]; 0 without layers."""
    interface_shear: float = quantity("Pa", label="interface shear")
    """Largest shear at an interface [Pa]: that of the traction; 0 without layers."""
    interface_tension: float = quantity("Pa", label="interface tension")
    """Largest tension there [Pa]; 0 without layers."""
    model: str
    """Model in words."""
    notes: tuple[str, ...]
    """What makes extremes of layers and interfaces uncertain, of those of `StressSummary`."""

    @property
    def _IN_SI(self) -> bool:
        return OF_RINGS in self.model

    def _rows(self) -> list[Row]:
        text = f"{self.ratio:.5g}"
        if math.isinf(self.ratio):
            text = "infinite: no stress is above the fatigue limit"
        label = "life over that of the reference"
        return [Row("ratio", label, text, self.ratio), *super()._rows()]


def _maxima(values: Array) -> Array:
    """Return the maxima over y, by parabolas through three cells."""
    if values.shape[-1] < 3:
        return np.asarray(values.max(-1), dtype=np.float64)
    middle = np.clip(values.argmax(-1), 1, values.shape[-1] - 2)[..., None]
    left, top, right = (np.take_along_axis(values, middle + k, -1)[..., 0] for k in (-1, 0, 1))
    bend = left - 2 * top + right
    with np.errstate(divide="ignore", invalid="ignore"):
        raised = top - (right - left) ** 2 / (8 * bend)
    highest = np.maximum(np.maximum(left, right), top)
    inside = (bend < 0) & (np.abs(right - left) <= -2 * bend)
    maxima: Array = np.where(inside, np.maximum(raised, highest), highest)
    return maxima


def _nodes(first: float, last: float) -> tuple[Array, Array]:
    """Return Gauss points and weights between two depths, in the logarithm of the depth."""
    decades = math.log10(last / first)
    count = max(4, math.ceil(NODES * decades))
    points, weights = np.polynomial.legendre.leggauss(count)
    half = math.log(last / first) / 2
    depths = first * np.exp(half * (points + 1))
    return depths, weights * half * depths


def _ranges(
    body: core.HalfSpace, models: Mapping[int | str, Model], depth: float
) -> list[tuple[Model, float, float]]:
    """Return the ranges of depth of each model, from the surface down, to some `depth` at least.

    Layers that differ in nothing are one range, as their stress has no kink between them.
    """
    faces = [0.0, *body.interfaces]
    faces.append(max(depth, 2 * faces[-1]))
    names: list[int | str] = [*range(len(body.layers)), "substrate"]
    for layer in models:
        if layer not in names:
            choices = ", ".join(map(repr, names))
            raise ValueError(f"model must have layers among {choices}, got {layer!r}")
    materials = [*(layer.material for layer in body.layers), body.substrate]
    ranges: list[tuple[Model, float, float]] = []
    for k, name in enumerate(names):
        if (model := models.get(name)) is None:
            continue
        top, bottom = faces[k], faces[k + 1]
        if (
            ranges
            and (ranges[-1][0], ranges[-1][2]) == (model, top)
            and materials[k - 1] == materials[k]
            and body.layers[k - 1].interface == "bonded"
        ):
            top = ranges.pop()[1]
        ranges.append((model, top, bottom))
    return ranges


def _half_width(solution: Solution) -> float:
    """Return half of the contact's width in the direction of rolling [m]."""
    low, high = solution.contact_extent[1]
    if math.isnan(high):
        raise ValueError("solution must have a contact with ends along y, got one that repeats")
    return (high - low) / 2


def stress_volume(
    solution: Solution, model: Models, *, body: Member = "body", threads: int | None = None
) -> StressVolume:
    """Integral of the stress below a contact that rolls along y, in one of its bodies.

    Parameters
    ----------
    solution : Solution
        Solved contact.
    model : LundbergPalmgren, IoannidesHarris, Zaretsky or mapping
        Model of the substrate, as no coating has a known one; or those of layers, by number from
        the surface down, and of the ``"substrate"``, whose integrals add up.
    body : {"body", "counterbody"}, optional
        Body in which the stress is taken.
    threads : int, optional
        Number of threads; by default as for `nacre.Contact`.

    Returns
    -------
    StressVolume
        Integral, its uncertainty near the surface, and the extremes of coating and interfaces.

    Raises
    ------
    ValueError
        If nothing touches, the surfaces have yielded, a layer does not exist, the slopes of models
        differ, or the counterbody is rigid.

    Examples
    --------
    >>> from nacre.bearing import Zaretsky, stress_volume
    >>> steel = nacre.Elastic(young=206e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, steel, load=10.0)
    >>> stress_volume(solution, Zaretsky()).change < 1e-3
    True
    """
    if not isinstance(solution, Solution):
        raise TypeError(f"solution must be a Solution, got {solution!r}")
    if not solution.load > 0:
        raise ValueError("solution must be one in contact, got a load of 0")
    check_unyielded(solution)
    models: Mapping[int | str, Model] = (
        model if isinstance(model, Mapping) else {"substrate": model}
    )
    if not models or not all(isinstance(rule, Model) for rule in models.values()):
        raise TypeError(f"model must be a model of a life, or models by layer, got {model!r}")
    plan = solution.stress_plan(body, threads)
    half, line = _half_width(solution), solution.grid.is_line
    slopes = {rule.slope(line=is_line(solution)) for rule in models.values()}
    if len(slopes) > 1:
        raise ValueError(f"models must have the same slope e, got {sorted(slopes)}")
    (slope,) = slopes
    total, change, largest = 0.0, 0.0, 0.0
    across = 1.0 if line else solution.grid.spacing[0]
    for rule, top, bottom in _ranges(plan.body, models, DEEPEST * half):
        begin = SHALLOWEST * half
        ranges = [(max(top, begin), bottom)]
        if top < begin:
            ranges.append((max(top, begin / 2), begin))
        sums = []
        for first, last in ranges:
            if first >= last:
                sums.append(0.0)
                continue
            z, weights = _nodes(first, last)
            with heard():  # the change says it
                highest = _maxima(rule.shear(plan.stress(z)))
            highest = np.nan_to_num(highest)  # beyond a free end there is nothing
            above = np.maximum(highest - rule.limit, 0.0)
            largest = max(largest, float(highest.max()))
            inside = above ** rule.power(slope) * z[:, None] ** -rule.h
            sums.append(float((weights[:, None] * inside).sum()) * across * rule.weight)
        total += sums[0]
        change += sum(sums[1:])
    extremes, notes = (0.0, 0.0, 0.0), tuple[str, ...]()
    if plan.body.layers:
        with heard():
            summary = plan.summary()
        coats = [layer.tension[0] for layer in summary.layers[: len(plan.body.layers)]]
        shears = [interface.shear[0] for interface in summary.interfaces]
        tensions = [interface.tension[0] for interface in summary.interfaces]
        notes = tuple(text for text in summary.warnings if "substrate" not in text)
        extremes = max(coats), max(shears), max(tensions)
    share = change / total if total > 0 else 0.0
    return StressVolume(total, share, largest, slope, *extremes, notes)


def life_ratio(
    solution: Solution | BearingSolution,
    reference: Solution | BearingSolution,
    model: Models,
    *,
    body: Member = "body",
    progress: Callable[[float], object] | None = None,
) -> LifeRatio:
    """Life of a contact or of a bearing over that of a reference, by the stress in its volume.

    Of bearings, the rings count: a point of the ring that rotates sees the loads of all elements,
    one of the other ring those of one place. The lengths of the tracks and the number of
    cycles in a revolution count, too.

    Parameters
    ----------
    solution : Solution or BearingSolution
        Contact or bearing.
    reference : Solution or BearingSolution
        One of the same kind.
    model : LundbergPalmgren, IoannidesHarris, Zaretsky or mapping
        Model, as `stress_volume` explains.
    body : {"body", "counterbody"}, optional
        Body of contacts in which the stress is taken; of bearings it is the ring.
    progress : callable, optional
        Function that is called with the share of the contacts of bearings that are done.

    Returns
    -------
    LifeRatio
        Ratio, and the extremes of coating and interfaces beside it. Where no stress is above the
        fatigue limit it is infinite, and a warning says so.

    Raises
    ------
    ValueError
        If both lives are infinite, or a bearing's contacts are those of the standard.
    TypeError
        If the two are of different kinds.

    Examples
    --------
    >>> from nacre.bearing import LundbergPalmgren, life_ratio
    >>> steel = nacre.Elastic(young=206e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, steel, load=10.0)
    >>> life_ratio(solution, solution, LundbergPalmgren()).ratio
    1.0
    """
    if isinstance(solution, BearingSolution) != isinstance(reference, BearingSolution):
        raise TypeError("solution and reference must both be contacts, or both bearings")
    check_progress(progress)
    volume, standard = _stress_volumes(solution, reference, model, body, progress)
    if volume.slope != standard.slope:
        raise ValueError(
            f"solution and reference must have the same slope e, got {volume.slope:.5g} and "
            f"{standard.slope:.5g}: give the model an e"
        )
    if not math.isfinite(volume.integral + standard.integral):
        raise ValueError("model must have smaller exponents: its integrals overflow")
    if volume.integral == 0 and standard.integral == 0:
        raise ValueError(
            "solution and reference must not both have infinite lives: the largest stresses, "
            f"{volume.largest:.4g} and {standard.largest:.4g} Pa, are below the fatigue limit"
        )
    notes = volume.notes
    if volume.integral == 0:
        ratio = math.inf
        text = "the life is infinite in this model: no stress is above the fatigue limit"
        warn(text)
        notes = (*notes, text)
    else:
        ratio = (standard.integral / volume.integral) ** (1 / volume.slope)
    if standard.integral == 0:
        text = "the ratio is 0: no stress of the reference is above the fatigue limit"
        warn(text)
        notes = (*notes, text)
    models = model.values() if isinstance(model, Mapping) else [model]
    kinds = OF_RINGS if isinstance(solution, BearingSolution) else " of contacts, "
    names = " and ".join(dict.fromkeys(type(rule).__name__ for rule in models))
    return LifeRatio(
        ratio,
        volume.slope,
        volume.largest,
        standard.largest,
        max(abs(volume.change), abs(standard.change)),
        volume.coating_tension,
        volume.interface_shear,
        volume.interface_tension,
        f"{names}{kinds}a model: ratios of equal materials only",
        notes,
    )


def _stress_volumes(
    solution: Solution | BearingSolution,
    reference: Solution | BearingSolution,
    model: Models,
    body: Member,
    progress: Callable[[float], object] | None,
) -> tuple[StressVolume, StressVolume]:
    """Return the integrals of two contacts, or of two bearings."""
    if isinstance(solution, BearingSolution) and isinstance(reference, BearingSolution):
        with lasting("stresses", progress) as tell:
            volume, standard = (
                _ring_volume(bearing, model, tell, k / 2)
                for k, bearing in enumerate((solution, reference))
            )
    else:
        volume, standard = (
            stress_volume(contact, model, body=body)  # type: ignore[arg-type]
            for contact in (solution, reference)
        )
    return volume, standard


def _ring_volume(
    solution: BearingSolution, model: Models, tell: Callable[[float], object] | None, done: float
) -> StressVolume:
    """Return the integral of both rings of a bearing, in revolutions of one against the other.

    A ring sees ``Z r/(r_i + r_e)`` cycles in a revolution, r the radius of the other one's track:
    the inner one ``Z (1 + γ)/2``, the outer one ``Z (1 − γ)/2``. Cycles of different loads add up
    as Miner's (derived here: it gives the exponents of ISO/TS 16281).
    """
    bearing: Bearing = solution.bearing
    loaded = np.argwhere(solution.loads > 0)
    if not len(loaded):
        raise ValueError("solution must be one of a loaded bearing, got no load")
    volumes: dict[tuple[int, int], StressVolume] = {}
    for number, (j, r) in enumerate(loaded.tolist()):
        contact = solution.contact(j, RINGS[r])
        assert contact is not None
        volumes[j, r] = stress_volume(contact, model)
        if tell is not None:
            tell(done + (number + 1) / len(loaded) / 2)
    slope = next(iter(volumes.values())).slope
    total = changed = 0.0
    for r in range(2):
        integrals = np.zeros((2, bearing.elements))
        for (j, ring), volume in volumes.items():
            if ring == r:
                integrals[:, j] = volume.integral, volume.integral * (1 + volume.change)
        rows = integrals.reshape(2, bearing.rows, bearing.count)
        turns = RINGS[r] == solution.rotating
        means = (rows ** (1 / slope)).mean(2) ** slope if turns else rows.mean(2)
        cycles = bearing.count * bearing.tracks[1 - r] / sum(bearing.tracks)
        means = means.sum(1) * cycles**slope * 2 * math.pi * bearing.tracks[r]
        total, changed = total + float(means[0]), changed + float(means[1])

    def largest(name: str) -> float:
        return float(max(getattr(volume, name) for volume in volumes.values()))

    shear, tension = largest("interface_shear"), largest("interface_tension")
    change = changed / total - 1 if total > 0 else 0.0
    heaviest = tuple(np.unravel_index(solution.loads.argmax(), solution.loads.shape))
    notes = volumes[int(heaviest[0]), int(heaviest[1])].notes
    coats = largest("coating_tension"), shear, tension
    return StressVolume(total, change, largest("largest"), slope, *coats, notes)
