"""Model of measured curves: an indentation, what of it is free, and nuisances of each curve."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from nacre.indent._addressed import System
from nacre.indent.curves import Curve
from nacre.results.parameters import VALUES

Array = npt.NDArray[np.float64]
Noise = Literal["relative", "absolute", "mixed"]

OF_FORCE = ("force_offset", "force_slope")
"""Nuisances of the force: its zero, and the slope of its baseline over the depth."""
NUISANCES = {
    "contact_point": "m",
    "drift": "m/s",
    "compliance": "m/N",
    "force_offset": "N",
    "force_slope": "N/m",
}
"""Nuisances of a curve, with their SI units: depth of its zero, compliance of the machine."""


def unit_of(name: str) -> str:
    """Return the SI unit of a parameter; "" where it has none."""
    return (VALUES | NUISANCES).get(name.rpartition(".")[2], "")


RANGES: dict[str, float | tuple[float, float]] = {
    "young": 100.0,
    "thickness": 30.0,
    "work": 1e4,
    "area": 10.0,
    "poisson": (0.0, 0.4999),
}
"""Factors by which parameters may differ from their start, and the range of a Poisson's ratio; an
incompressible layer has no limit of its derivatives."""
OTHER = 100.0
"""Factor by which other parameters may differ, such as the numbers of a tip."""
KEPT = 8
"""Evaluations that are remembered: SciPy asks for residuals and Jacobian one after the other."""
FARTHEST = 3.0
"""Range of a nuisance over the range of depth; the model needs some contact within the data."""


@dataclass(frozen=True)
class Unknown:
    """A parameter of the fit: its value is start·exp(x), or start + scale·x."""

    name: str
    start: float
    scale: float
    """Scale of x, 0 where x is a logarithm."""
    low: float
    high: float
    """Bounds of the value."""
    curve: int = -1
    """Number of the curve that a nuisance belongs to."""
    kind: str = ""
    """Kind of nuisance, empty for a parameter of the system."""

    @property
    def is_log(self) -> bool:
        """Whether x is a logarithm."""
        return self.scale == 0

    def value(self, x: float) -> float:
        """Return the value at x."""
        return self.start * math.exp(x) if self.is_log else self.start + self.scale * x

    def place(self, value: float) -> float:
        """Return x of a value."""
        if self.is_log:
            return math.log(value / self.start)
        return (value - self.start) / self.scale

    def rate(self, x: float) -> float:
        """Return the derivative of the value with respect to x."""
        return self.value(x) if self.is_log else self.scale

    @property
    def bounds(self) -> tuple[float, float]:
        """Bounds of x."""
        return self.place(self.low), self.place(self.high)


def uniform(force: Array, floor: Array) -> tuple[Array, Array]:
    """Return forces on a scale on which noise of √(F² + c²) is uniform, and the scale's rate.

    With the floor c it is arsinh F/c; ln F where that is 0, and F where it is infinite.
    B. P. Durbin et al., Bioinformatics 18 (2002) S105-S110,
    doi:10.1093/bioinformatics/18.suppl_1.S105.
    """
    if floor[0] == 0:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.log(force), 1 / force
    if math.isinf(floor[0]):
        return force, np.ones_like(force)
    return np.arcsinh(force / floor), 1 / np.hypot(force, floor)


class Model:
    """Weighted residuals of curves and their Jacobian.

    The true depth is d − d0 − v t − C F, and the load P that of the body plus F0 + s (d − d1), the
    baseline from the first depth d1. Residuals are ln P − ln F over the relative noise, P − F
    over the absolute noise, or arsinh P/c − arsinh F/c over the share where noise is of both kinds;
    a prior adds one residual.
    """

    def __init__(
        self,
        curves: Sequence[Curve],
        system: System,
        free: Sequence[str],
        nuisance: Sequence[str],
        *,
        noise: Noise,
        floor: float = 0.0,
        sigma: float | None,
        prior: Mapping[str, tuple[float, float]],
        bounds: Mapping[str, tuple[float, float]],
    ) -> None:
        self.curves, self.system, self.noise = list(curves), system, noise
        self.free = list(free)
        self.unknowns = _unknowns(self.curves, system, free, nuisance, bounds)
        self.names = [unknown.name for unknown in self.unknowns]
        self.depth = np.concatenate([curve.depth for curve in curves])
        self.force = np.concatenate([curve.force for curve in curves])
        ends = np.cumsum([0, *(len(curve) for curve in curves)])
        self.slices = [slice(int(a), int(b)) for a, b in itertools.pairwise(ends)]
        if noise == "relative":
            if (self.force <= 0).any():
                wrong = int((self.force <= 0).sum())
                raise ValueError(
                    f"force must be positive at each point for noise='relative', got {wrong} "
                    f"points that are not; use noise='absolute', or Curve.between"
                )
        self.pull = self.force
        """Force by which a compliance moves each point."""
        self.top = np.concatenate([np.full(len(c), c.force.max()) for c in self.curves])
        """Largest force of the curve of each point."""
        self.floor = {"relative": 0.0, "absolute": math.inf, "mixed": floor}[noise]
        """Force over the largest one below which the noise ceases to fall."""
        self.scaled, _ = uniform(self.force, self.floor * self.top)
        self.weight = 1 / self.top if noise == "absolute" else np.ones_like(self.depth)
        self.sigma = sigma
        self.is_known = sigma is not None
        if sigma is not None:
            self.weight = np.full_like(self.depth, 1 / sigma)
        self.prior = [(self.names.index(name), *pair) for name, pair in prior.items()]
        self.trust = 1.0
        """Standard deviation of the residuals, by which those of the prior are multiplied."""
        self._prior = prior
        self.low, self.high = (
            np.array([unknown.bounds[side] for unknown in self.unknowns]) for side in (0, 1)
        )
        self.evaluations = 0
        self._at: dict[bytes, tuple[Array, Array]] = {}
        self._loads: dict[bytes, tuple[Array, Array]] = {}

    @property
    def dof(self) -> int:
        """Degrees of freedom: points and priors less parameters."""
        return self.depth.size + len(self.prior) - len(self.unknowns)

    def values(self, x: Array) -> dict[str, float]:
        """Return the value of each parameter."""
        return {u.name: u.value(float(x[k])) for k, u in enumerate(self.unknowns)}

    def rates(self, x: Array) -> Array:
        """Return the derivative of each value with respect to its x."""
        return np.array([u.rate(float(x[k])) for k, u in enumerate(self.unknowns)])

    def system_at(self, x: Array) -> System:
        """Return the system at x, but for the area of the tip."""
        return self.system.with_values(self._system_values(x))

    def _system_values(self, x: Array) -> dict[str, float]:
        return {u.name: u.value(float(x[k])) for k, u in enumerate(self.unknowns) if not u.kind}

    def approach(self, x: Array) -> Array:
        """Return the true depth of each point."""
        depth = self.depth.copy()
        for k, unknown in enumerate(self.unknowns):
            if unknown.kind and unknown.kind not in OF_FORCE:
                rows = self.slices[unknown.curve]
                depth[rows] -= unknown.value(float(x[k])) * self._lever(unknown)
        return depth

    def _lever(self, unknown: Unknown) -> Array | float:
        """Return the derivative of the measured depth, or force, with respect to a nuisance."""
        curve = self.curves[unknown.curve]
        if unknown.kind == "force_slope":
            return np.asarray(curve.depth - curve.depth[0])
        if unknown.kind == "drift":
            assert curve.time is not None
            return np.asarray(curve.time - curve.time[0])
        return self.pull[self.slices[unknown.curve]] if unknown.kind == "compliance" else 1.0

    def loads(self, x: Array) -> tuple[Array, Array]:
        """Return the load of each point, and its derivatives with respect to x."""
        key = x.tobytes()
        if key not in self._loads:
            if len(self._loads) > KEPT:
                self._loads.clear()
            self._loads[key] = self._loads_at(x)
        return self._loads[key]

    def _loads_at(self, x: Array) -> tuple[Array, Array]:
        self.evaluations += 1
        values = self._system_values(x)
        area = values.pop("tip.area", 1.0)
        system = self.system.with_values(values)
        # A tip of all sections κ times as large, r → r√κ, is the old one on layers 1/√κ as thick
        # under √κ of the load: derived here, from the similarity of the integral equation.
        wider = math.sqrt(area)
        if area != 1:
            system = system.narrower_system(wider)
        wrt = [unknown.name for unknown in self.unknowns if not unknown.kind]
        curve = system.curve(self.approach(x), wrt)
        load = wider * curve.load
        columns = np.zeros((load.size, len(self.unknowns)))
        place = 0
        for k, unknown in enumerate(self.unknowns):
            if unknown.kind:
                rows = self.slices[unknown.curve]
                if unknown.kind in OF_FORCE:
                    load[rows] += unknown.value(float(x[k])) * self._lever(unknown)
                    columns[rows, k] = unknown.scale * self._lever(unknown)
                    continue
                rate = wider * curve.slope[rows] * self._lever(unknown)
                columns[rows, k] = -unknown.scale * rate
                continue
            factor = unknown.rate(float(x[k]))
            if area != 1:
                factor *= _factor(unknown.name, wider)
            columns[:, k] = factor * curve.derivatives[:, place]
            place += 1
        return load, columns

    def at(self, x: Array) -> tuple[Array, Array]:
        """Return residuals and Jacobian; not numbers where the model has no value."""
        key = x.tobytes()
        if key not in self._at:
            if len(self._at) > KEPT:
                self._at.clear()
            self._at[key] = self._residuals(x)
        return self._at[key]

    def _residuals(self, x: Array) -> tuple[Array, Array]:
        try:
            load, columns = self.loads(x)
        except (ValueError, RuntimeError, OverflowError):
            shape = self.depth.size + len(self.prior), len(self.unknowns)
            return np.full(shape[0], np.nan), np.full(shape, np.nan)
        scaled, rate = uniform(load, self.floor * self.top)
        residuals = (scaled - self.scaled) * self.weight
        with np.errstate(invalid="ignore"):
            jacobian = columns * (self.weight * rate)[:, None]
        if self.prior:
            rates = self.rates(x)
            rows = np.zeros((len(self.prior), len(self.unknowns)))
            more = np.empty(len(self.prior))
            for row, (k, value, spread) in enumerate(self.prior):
                more[row] = self.trust * (self.unknowns[k].value(float(x[k])) - value) / spread
                rows[row, k] = self.trust * rates[k] / spread
            residuals = np.concatenate([residuals, more])
            jacobian = np.concatenate([jacobian, rows])
        return residuals, jacobian

    def wider_model(self, free: Sequence[str], nuisance: Sequence[str], x: Array) -> Model:
        """Return the model with more that is free, and with these nuisances.

        A compliance is pulled by the loads at x: the noise of the force would be in its column, and
        correlate with the residuals.
        """
        model = Model(
            self.curves,
            self.system,
            [*self.free, *free],
            nuisance,
            noise=self.noise,
            floor=self.floor,
            sigma=self.sigma,
            prior=self._prior,
            bounds={},
        )
        model.trust, model.pull = self.trust, self.loads(x)[0]
        return model

    def weigh_priors(self, trust: float) -> None:
        """Set the standard deviation of the residuals against which priors are weighed."""
        self.trust = trust
        self._at.clear()

    def chi2(self, x: Array) -> float:
        """Return the sum of squares, infinite where the model has no value."""
        residuals, _ = self.at(x)
        square = float(residuals @ residuals)
        return square if math.isfinite(square) else math.inf


def _factor(path: str, wider: float) -> float:
    """Return the derivative of the load with respect to a path over that of the narrowed system."""
    if path == "tip.area":
        return wider / wider**2
    if path.endswith(".thickness"):
        return 1.0
    return wider**2 if path == "adhesion.work" else wider


def _unknowns(
    curves: Sequence[Curve],
    system: System,
    free: Sequence[str],
    nuisance: Sequence[str],
    bounds: Mapping[str, tuple[float, float]],
) -> list[Unknown]:
    """Return the parameters of a fit, those of the system first."""
    known = system.values()
    for names, allowed, what in ((free, known, "free"), (nuisance, tuple(NUISANCES), "nuisance")):
        for name in names:
            if name not in allowed:
                choices = ", ".join(allowed)
                raise ValueError(f"{what} must name parameters among {choices}, got {name!r}")
        if len(set(names)) < len(names):
            raise ValueError(f"{what} must name each parameter once, got {list(names)}")
    if not free:
        raise ValueError("free must name a parameter, got none")
    if "tip.area" in free and any(name.startswith("tip.") for name in free if name != "tip.area"):
        raise ValueError("free must not hold tip.area together with another number of the tip")
    unknowns = []
    for path in free:
        value = known[path]
        is_plain = path.endswith(".poisson")
        if value <= 0 and not is_plain:
            raise ValueError(f"{path} must be positive where it is free, got {value}")
        last = path.rpartition(".")[2]
        spread = RANGES.get(last, OTHER)
        usual = (value / spread, value * spread) if isinstance(spread, float) else spread
        low, high = _bounds(path, bounds.get(path, usual), is_plain)
        if not low <= value <= high:
            raise ValueError(
                f"bounds of {path} must include its start, {value:.6g}, got {low:.6g}, {high:.6g}"
            )
        unknowns.append(Unknown(path, value, 1.0 if is_plain else 0.0, low, high))
    for number, curve in enumerate(curves):
        reach, most = float(np.ptp(curve.depth)), float(curve.force.max())
        for kind in nuisance:
            scale = reach
            if kind == "drift":
                if curve.time is None or curve.time[-1] == curve.time[0]:
                    raise ValueError("drift needs the time of each point: Curve(…, time=…)")
                scale = reach / float(np.ptp(curve.time))
            elif kind == "compliance":
                scale = reach / most
            elif kind in OF_FORCE:
                scale = most if kind == "force_offset" else most / reach
            name = kind if len(curves) == 1 else f"curves[{number}].{kind}"
            low, high = bounds.get(name, bounds.get(kind, (-FARTHEST * scale, FARTHEST * scale)))
            if not low < 0 < high:
                raise ValueError(f"bounds of {name} must lie about 0, got {low:.6g}, {high:.6g}")
            unknowns.append(Unknown(name, 0.0, scale, low, high, number, kind))
    names = [unknown.name for unknown in unknowns]
    _check_names(bounds, [*names, *nuisance], "bounds")
    return unknowns


def _check_names(names: Iterable[str], known: Sequence[str], what: str) -> None:
    for name in names:
        if name not in known:
            raise ValueError(f"{what} must name parameters of the fit, {known}, got {name!r}")


def _bounds(path: str, pair: Iterable[float], is_plain: bool) -> tuple[float, float]:
    low, high = map(float, pair)
    if not low < high or (low <= 0 and not is_plain):
        raise ValueError(f"bounds of {path} must be positive and ascend, got {low:.6g}, {high:.6g}")
    return low, high
