"""Intervals by profile likelihood, and whether data tell a parameter at all."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre.indent._model import Model

Array = npt.NDArray[np.float64]

WIDEST = math.log(2.0)
"""Largest half-width of an interval of a logarithm at which its parameter counts as known: a factor
of two either way."""
WIDEST_PLAIN = 0.1
"""Largest half-width of the interval of a Poisson's ratio, a fifth of its range."""
AGREEMENT = 1.5
"""Largest factor between the widths of the profile interval and the linear one."""
CLOSE = 1e-3
"""Last step, over the linear half-width, at which an end is found."""
REACH = 1.6
"""Distance of an end at which an interval counts as open: a factor of five. Beyond it nothing
more is to be learnt, and points on ever thinner layers cost seconds."""
STEPS = 12
"""Most steps to an end; three or four suffice where the problem is nearly linear."""
DOUBLINGS = 60
"""Most doublings of a distance until it brackets an end: a factor of 1e18."""
LEAST = 1e-9
"""Least standard deviation of noise that is estimated, over the force: the accuracy of curves."""
BISECTIONS = 8
"""Bisections after which an end is known to 1 % of the interval."""
LONGEST = 1.0
"""Longest step of a parameter: a factor of e, or the range of a nuisance."""
SECOND = 3.84
"""χ² above the least one below which another minimum fits as well: the 95 % of one parameter."""


@dataclass(frozen=True)
class Estimate:
    """The minimum of a model, and its linear statistics."""

    x: Array
    chi2: float
    variance: float
    """Variance of the residuals by which covariances are multiplied: 1 where the noise is known."""
    quantile: float
    """Half-width of the 95 % interval over the standard error."""
    covariance: Array
    """Covariance of x; infinite variances where the data do not depend on a parameter."""
    correlation: Array
    condition: float
    """Condition number of the Jacobian with columns of unit length."""
    alone: Array
    """Standard error of each parameter if the others were known."""

    @property
    def spread(self) -> Array:
        """Standard errors of x."""
        return np.sqrt(np.diag(self.covariance))


def estimate_at(model: Model, x: Array) -> Estimate:
    """Return the statistics of a minimum at x."""
    with extra("fit"):
        from scipy.special import stdtrit

    residuals, jacobian = model.at(x)
    chi2, dof = float(residuals @ residuals), model.dof
    variance = 1.0 if model.is_known else max(chi2 / dof, LEAST**2)
    quantile = 1.959963984540054 if model.is_known else float(stdtrit(dof, 0.975))
    lengths = np.linalg.norm(jacobian, axis=0)
    with np.errstate(divide="ignore"):
        alone = np.sqrt(variance) / lengths
    count = x.size
    covariance = np.zeros((count, count))
    correlation = np.eye(count)
    sensitive = lengths > 1e-9 * max(float(lengths.max()), 1e-300)
    condition = math.inf
    if sensitive.any():
        scaled = jacobian[:, sensitive] / lengths[sensitive]
        _, sizes, rows = np.linalg.svd(scaled, full_matrices=False)
        sizes = np.maximum(sizes, 1e-13 * sizes[0])
        inverse = (rows.T / sizes**2) @ rows
        widths = np.sqrt(np.diag(inverse))
        correlation[np.ix_(sensitive, sensitive)] = inverse / np.outer(widths, widths)
        scale = np.sqrt(variance) / lengths[sensitive]
        covariance[np.ix_(sensitive, sensitive)] = inverse * np.outer(scale, scale)
        if sensitive.all():
            condition = float(sizes[0] / sizes[-1])
    covariance[~sensitive, ~sensitive] = math.inf
    return Estimate(x, chi2, variance, quantile, covariance, correlation, condition, alone)


def minimum(model: Model, x: Array, *, rough: bool = False, fixed: int | None = None) -> Array:
    """Return the place of the least sum of squares that is found from x; x[fixed] is kept."""
    with extra("fit"):
        from scipy.optimize import least_squares

    varied = np.arange(x.size) != fixed
    inside = 1e-9 * (model.high - model.low)
    x = np.clip(x, model.low + inside, model.high - inside)
    if not varied.any():
        return x

    def whole(values: Array) -> Array:
        place = x.copy()
        place[varied] = values
        return place

    optimum = least_squares(
        lambda values: model.at(whole(values))[0],
        x[varied],
        jac=lambda values: model.at(whole(values))[1][:, varied],
        bounds=(model.low[varied], model.high[varied]),
        method="trf",
        ftol=1e-4 if rough else 1e-9,
        xtol=1e-8,
        gtol=1e-10,
        max_nfev=15 if rough else 60,
    )
    return whole(np.asarray(optimum.x, dtype=np.float64))


def interval(model: Model, best: Estimate, k: int) -> tuple[float, float]:
    """Return the ends of x[k]'s 95 % interval by profile likelihood, infinite where it is open.

    An end is where the sum of squares, least over the other parameters, has grown by t² s². Each
    step solves for it with the residuals linearised about the last place. D. J. Venzon and S. H.
    Moolgavkar, Applied Statistics 37 (1988) 87-94, doi:10.2307/2347496, with the Hessian of Gauss
    and Newton.
    """
    low, high = (_end(model, best, k, side) for side in (-1.0, 1.0))
    return low, high


def _end(model: Model, best: Estimate, k: int, side: float) -> float:
    spread = best.spread[k]
    if not math.isfinite(spread):
        return side * math.inf
    width = best.quantile * spread
    if width > REACH:
        return side * math.inf
    level = best.chi2 + best.quantile**2 * best.variance
    varied = np.arange(best.x.size) != k
    whole = side * best.quantile * best.covariance[:, k] / spread
    x = best.x + whole * min(1.0, LONGEST / float(np.abs(whole).max()))
    for _ in range(STEPS):
        x = np.clip(x, model.low, model.high)
        residuals, jacobian = model.at(x)
        if not np.isfinite(residuals).all():
            x = 0.5 * (x + best.x)
            continue
        basis, triangle = np.linalg.qr(jacobian[:, varied])
        column = jacobian[:, k]
        own = column - basis @ (basis.T @ column)
        remainder = residuals - basis @ (basis.T @ residuals)
        square, mixed = float(own @ own), float(own @ remainder)
        if square == 0:
            return side * math.inf
        inside = mixed**2 - square * (float(remainder @ remainder) - level)
        along = (side * math.sqrt(max(inside, 0.0)) - mixed) / square
        step = np.empty_like(x)
        step[k] = along
        step[varied] = -np.linalg.lstsq(triangle, basis.T @ (residuals + column * along))[0]
        longest = float(np.abs(step).max())
        if not math.isfinite(longest):
            return side * math.inf
        if abs(along) < CLOSE * width and longest < 0.05 * LONGEST and inside >= 0:
            return float(x[k] + along)
        if (side > 0 and x[k] >= model.high[k]) or (side < 0 and x[k] <= model.low[k]):
            if along * side > 0:
                return side * math.inf
        x = x + step * min(1.0, LONGEST / longest)
        if float(np.abs(x - best.x).max()) > REACH:
            return side * math.inf
    return _bisected_end(model, best, k, side, level)


def _bisected_end(model: Model, best: Estimate, k: int, side: float, level: float) -> float:
    """Return an end by bisection of the least sum of squares over x[k], where steps do not settle.

    Contacts that jump, as with adhesion, make it rough.
    """
    x = best.x.copy()
    near, far = 0.0, best.quantile * float(best.spread[k])
    for _ in range(DOUBLINGS):
        x[k] = best.x[k] + side * far
        if far > REACH or not model.low[k] < x[k] < model.high[k]:
            return side * math.inf
        if _least(model, x, k) > level:
            break
        near, far = far, 2 * far
    else:
        return side * math.inf
    for _ in range(BISECTIONS):
        x[k] = best.x[k] + side * 0.5 * (near + far)
        if _least(model, x, k) > level:
            far = 0.5 * (near + far)
        else:
            near = 0.5 * (near + far)
    return float(best.x[k] + side * 0.5 * (near + far))


def _least(model: Model, x: Array, k: int) -> float:
    """Return the least sum of squares with x[k] as it is."""
    return model.chi2(minimum(model, x, rough=True, fixed=k))


def shifted_starts(model: Model, start: Array) -> list[Array]:
    """Return other places to start from: three times and a third of each free thickness.

    Where no thickness is free, of the first modulus.
    """
    logs = [u.name for u in model.unknowns if u.is_log]
    shifted_names = [name for name in logs if name.endswith(".thickness")] or logs[:1]
    places = []
    for name in shifted_names:
        for shift in (math.log(3.0), -math.log(3.0)):
            x = start.copy()
            x[model.names.index(name)] += shift
            places.append(x)
    return places


def reasons(
    model: Model,
    best: Estimate,
    intervals: dict[str, tuple[float, float]],
    minima: list[tuple[Array, float]],
) -> dict[str, str]:
    """Return why parameters of the system are not identifiable, for those that are not."""
    by_name: dict[str, str] = {}
    for k, unknown in enumerate(model.unknowns):
        if not unknown.kind:
            pair = intervals.get(unknown.name)
            reason = _reason(model, best, k, pair, minima)
            if reason is not None:
                by_name[unknown.name] = reason
    return by_name


def _reason(
    model: Model,
    best: Estimate,
    k: int,
    pair: tuple[float, float] | None,
    minima: list[tuple[Array, float]],
) -> str | None:
    unknown, x = model.unknowns[k], float(best.x[k])
    widest = WIDEST if unknown.is_log else WIDEST_PLAIN
    if best.quantile * best.alone[k] > widest:
        return (
            f"the forces hardly depend on it: even with all other parameters known it would be "
            f"uncertain by {_width(best.quantile * best.alone[k], unknown.is_log)}"
            f"{_structure(model, best, k)}"
        )
    partner = _partner(model, best, k)
    room = 1e-6 * (model.high[k] - model.low[k])
    if not model.low[k] + room < x < model.high[k] - room:
        return f"its estimate stands at a bound, {unknown.value(x):.4g}{partner}"
    linear = best.quantile * best.spread[k]
    if pair is None:
        if linear > widest:
            return f"its linear 95 % interval is {_width(linear, unknown.is_log)}{partner}"
        return None
    if not (math.isfinite(pair[0]) and math.isfinite(pair[1])):
        sides = [side for side, end in zip(("below", "above"), pair) if math.isinf(end)]  # noqa: B905
        return f"its 95 % interval does not close {' and '.join(sides)}{partner}"
    half = 0.5 * (pair[1] - pair[0])
    if half > widest:
        return f"its 95 % interval is {_width(half, unknown.is_log)}{partner}"
    if not 1 / AGREEMENT <= half / linear <= AGREEMENT:
        return (
            f"its 95 % interval is {half / linear:.2g} times as wide as the linear one, the data "
            f"are far from linear in it{partner}"
        )
    for place, chi2 in minima:
        apart = (chi2 - best.chi2) / best.variance
        if apart < SECOND and not pair[0] <= place[k] <= pair[1]:
            return (
                f"another minimum, at {unknown.value(float(place[k])):.4g}, fits about as well: "
                f"χ² is {apart:.2g} above the least one{partner}"
            )
    return None


def _width(half: float, is_log: bool) -> str:
    if not is_log:
        return f"± {half:.2g}"
    return f"a factor of {math.exp(min(half, 700.0)):.3g} either way"


def _partner(model: Model, best: Estimate, k: int) -> str:
    """Return with what a parameter trades, where it does."""
    row = np.abs(best.correlation[k]).copy()
    row[k] = 0.0
    if row.size < 2 or row.max() < 0.5:
        return ""
    rival = int(row.argmax())
    return f"; it trades with {model.names[rival]} (correlation {best.correlation[k, rival]:.3f})"


def _structure(model: Model, best: Estimate, k: int) -> str:
    """Return what degenerates, where it is known."""
    name = model.names[k]
    system = model.system_at(best.x)
    body = system.body
    if name.endswith(".thickness") and name.startswith("body.layers["):
        number = int(name[len("body.layers[") : name.index("]")])
        below = (
            body.layers[number + 1].material if number + 1 < len(body.layers) else body.substrate
        )
        own = body.layers[number].material
        if isinstance(below, type(own)) and abs(math.log(own.young / below.young)) < 0.1:
            return ". The layer is hardly stiffer or softer than what is beneath it"
    deeper = name.startswith("body.substrate") or name.endswith(".thickness")
    if deeper and body.layers:
        radius = float(system.curve(model.approach(best.x)).radius.max())
        share = radius / body.layers[0].thickness
        if share < 0.1:
            return f". The contact radius is at most {share:.2g} of the first layer's thickness"
    return ""
