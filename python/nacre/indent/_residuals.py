"""Whether the residuals of a fit are noise: its kind, its structure, and what would remove that.

The size of the noise of a curve is seen from point to point, in second differences of the
residuals, which neither a wrong model nor a slow drift changes much. Structure is tested with
Durbin and Watson's ratio of the mean square difference of neighbours to the variance, after von
Neumann, and by score tests: of each number that the fit holds, the residuals' projection on its
column of the Jacobian, which is what is left of it beside the free parameters. Under the null
hypothesis the latter is Student's, the former nearly a beta variable with its exact moments.

J. von Neumann, Ann. Math. Stat. 12 (1941) 367-395, doi:10.1214/aoms/1177731677.
J. Durbin and G. S. Watson, Biometrika 37 (1950) 409-428, doi:10.1093/biomet/37.3-4.409, eqs. (9)
to (11), and 38 (1951) 159-178, doi:10.1093/biomet/38.1-2.159, § 4.
C. R. Rao, Math. Proc. Camb. Phil. Soc. 44 (1948) 50-57, doi:10.1017/S0305004100023987.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from nacre._tools.extras import extra
from nacre.indent._model import NUISANCES, Model, Noise, uniform
from nacre.indent._profile import Estimate

Array = npt.NDArray[np.float64]

LEVEL = 0.003
"""Probability of a false alarm of each test; that of a fit, with the criteria of identifiability,
stays below 0.02."""
ROUNDING = 1e-6
"""Size of residuals, over the force or the given noise, below which they are rounding of the data
or the model; no instrument has so little noise."""
FLOORS = (0.0, *(10.0 ** (k / 2) for k in range(-8, 1)), math.inf)
"""Forces over the largest one below which noise that goes with the force ceases to fall."""
GAIN = 1.0
"""Logarithm of the likelihood by which noise of both kinds must exceed noise of one: of curves with
one kind, less than a tenth are said to have both."""
PLAUSIBLE = {"": math.log(2.0), "poisson": 0.2} | dict.fromkeys(NUISANCES, 1.0)
"""Largest change that a message names as the remedy: of a logarithm, of a Poisson's ratio, and of
a nuisance over what shifts the deepest point by the range of depth."""
NAMED = 4
"""Most remedies that a message names."""
OTHERWISE = "noise is correlated, or the model is another in kind"
CLOSE = 1.4
"""Sum of squares that a remedy leaves over that of the best one, up to which it is named too."""


def likeliest_noise(model: Model, x: Array) -> tuple[Noise, float]:
    """Return the kind of noise by likelihood, and its floor over the largest force.

    The noise has the standard deviation σ·√(F² + c²): relative for c = 0, absolute for c → ∞. The
    likelihood is that of the second differences of residuals at x, half of which are independent.
    """
    load, _ = model.loads(x)
    likelihoods = []
    for floor in FLOORS:
        if floor == 0 and min(load.min(), model.force.min()) <= 0:
            likelihoods.append(-math.inf)
            continue
        least = floor * model.top
        value, rate = uniform(model.force, least)
        misfit = value - uniform(load, least)[0]
        square = np.concatenate([np.diff(misfit[rows], 2) ** 2 / 6 for rows in model.slices]).mean()
        size = model.force.size * math.log(square + (0.01 * ROUNDING) ** 2)
        likelihoods.append(0.5 * (float(np.log(rate).sum()) - 0.5 * size))
    best = int(np.argmax(likelihoods))
    pure = 0 if likelihoods[0] >= likelihoods[-1] else len(FLOORS) - 1
    if likelihoods[best] < likelihoods[pure] + GAIN:
        best = pure
    kind: Noise = "relative" if best == 0 else "mixed" if best < len(FLOORS) - 1 else "absolute"
    return kind, FLOORS[best]


@dataclass(frozen=True)
class FixedParameters:
    """Numbers that a fit holds: the columns that they would add to its Jacobian."""

    names: list[str]
    columns: Array
    """Derivatives of the residuals with respect to x of each, as of free parameters."""

    @classmethod
    def of(cls, model: Model, x: Array) -> FixedParameters:
        """Return what a fit holds, but for what cannot be free there."""
        free = [*model.system.held(model.free)]
        is_timed = all(c.time is not None and np.ptp(c.time) > 0 for c in model.curves)
        kinds = [kind for kind in NUISANCES if kind != "drift" or is_timed]
        try:
            wider = model.wider_model(free, kinds, x)
            place = np.zeros(len(wider.names))
            place[[wider.names.index(name) for name in model.names]] = x
            _, jacobian = wider.at(place)
        except (ValueError, RuntimeError):
            return cls([], np.zeros((model.at(x)[0].size, 0)))
        more = [k for k, name in enumerate(wider.names) if name not in model.names]
        columns = jacobian[:, more]
        finite = np.flatnonzero(np.isfinite(columns).all(axis=0)).tolist()
        return cls([wider.names[more[k]] for k in finite], columns[:, finite])


@dataclass(frozen=True)
class Examination:
    """What the residuals of a fit say."""

    estimate: Estimate
    """The estimate, with wider errors where the residuals are no noise."""
    warnings: list[str]
    """Why they are no noise, and what to free; empty where they are."""
    sensitivity: dict[str, dict[str, float]]
    """Change of x of each free parameter over that of x of each number that is held."""


def examine(model: Model, best: Estimate) -> Examination:
    """Return whether the residuals at a minimum are noise, and how it depends on what is held."""
    with extra("fit"):
        from scipy.special import chdtrc, ndtr, stdtr

    residuals, jacobian = model.at(best.x)
    fixed = FixedParameters.of(model, best.x)
    moves = -np.linalg.lstsq(jacobian, fixed.columns)[0]
    sensitivity = {
        name: dict(zip(fixed.names, moves[k].tolist(), strict=True))
        for k, name in enumerate(model.names)
        if name in model.free
    }
    basis, _ = np.linalg.qr(jacobian)
    remainder = residuals - basis @ (basis.T @ residuals)
    chi2, dof, count = float(remainder @ remainder), model.dof, model.depth.size
    size = math.sqrt(chi2 / dof)
    if dof < 3 or size < ROUNDING:
        return Examination(best, [], sensitivity)

    own = fixed.columns - basis @ (basis.T @ fixed.columns)
    lengths = np.linalg.norm(own, axis=0)
    independent = lengths > 1e-6 * np.linalg.norm(fixed.columns, axis=0)
    share = np.zeros(len(fixed.names))
    share[independent] = own[:, independent].T @ remainder / lengths[independent]
    if model.is_known:
        chances = 2 * ndtr(-np.abs(share))
    else:
        left = np.maximum(chi2 - share**2, 1e-30 * chi2) / (dof - 1)
        chances = 2 * stdtr(dof - 1, -np.abs(share) / np.sqrt(left))
    ratio, due, chance = durbin_watson(remainder[:count], basis[:count], model.slices)
    is_structured = chance < LEVEL and not (model.is_known and chi2 < 0.5 * dof)
    is_large = model.is_known and float(chdtrc(dof, chi2)) < LEVEL
    is_explained = bool((chances[independent] < LEVEL / max(independent.sum(), 1)).any())
    if not (is_structured or is_large or is_explained):
        return Examination(best, [], sensitivity)

    change = np.zeros(len(fixed.names))
    change[independent] = -share[independent] / lengths[independent]
    left = chi2 - share**2
    remedies = _remedies(fixed.names, chances, np.abs(change), left)
    text, shift = _sentence(model, remainder[:count], size, ratio), np.zeros_like(best.x)
    if remedies:
        listing = ", ".join(
            f"{fixed.names[k]} (leaves {_share(model, math.sqrt(left[k] / dof))})" for k in remedies
        )
        text += f"; free, where it is not sure, {listing}"
        first = min(remedies, key=lambda k: float(left[k]))
        shift = moves[:, first] * change[first]
        after = remainder - own[:, first] * share[first] / lengths[first]
        if durbin_watson(after[:count], basis[:count], model.slices)[2] < LEVEL:
            text += f"; none of these alone makes the rest noise: {OTHERWISE}"
    else:
        text += f"; {OTHERWISE}"
    # Points that are correlated by r count as (1 − r)/(1 + r): G. V. Bayley and J. M. Hammersley,
    # Suppl. J. R. Stat. Soc. 8 (1946) 184-197, doi:10.2307/2983560.
    fewer = max(due / ratio * 2 - 1, 1.0) * (max(1.0, chi2 / dof) if model.is_known else 1.0)
    covariance = fewer * best.covariance + np.outer(shift, shift)
    return Examination(replace(best, covariance=covariance), [text], sensitivity)


def durbin_watson(
    residuals: Array, basis: Array, slices: Sequence[slice]
) -> tuple[float, float, float]:
    """Return Durbin and Watson's ratio of residuals, its mean, and the chance of less.

    Neighbours are within a part. The chance is that of a beta variable on 0 to 4 that has the exact
    mean and variance for residuals beside the space of a basis.
    """
    with extra("fit"):
        from scipy.special import betainc

    def differences(values: Array) -> Array:
        """Return A·values, where rᵀAr is the sum of squared differences of neighbours."""
        product = np.zeros_like(values)
        for rows in slices:
            step = np.diff(values[rows], axis=0)
            product[rows][:-1] -= step
            product[rows][1:] += step
        return product

    dof = residuals.size - basis.shape[1]
    mapped = differences(basis)
    inner = basis.T @ mapped
    first = sum(2 * (rows.stop - rows.start - 1) for rows in slices) - np.trace(inner)
    second = (
        sum(6 * (rows.stop - rows.start) - 8 for rows in slices)
        - 2 * float((mapped**2).sum())
        + float((inner**2).sum())
    )
    ratio = float(residuals @ differences(residuals) / (residuals @ residuals))
    mean = float(first) / dof
    variance = 2 * (second - float(first) * mean) / (dof * (dof + 2))
    a = 0.25 * mean
    both = a * (1 - a) / (variance / 16) - 1
    return ratio, mean, float(betainc(a * both, (1 - a) * both, min(0.25 * ratio, 1.0)))


def _remedies(names: Sequence[str], chances: Array, change: Array, left: Array) -> list[int]:
    """Return which numbers would remove most of the structure if free, nuisances first."""
    kinds = [name.rpartition(".")[2] for name in names]
    candidates = [
        k
        for k in np.argsort(left).tolist()
        if chances[k] < LEVEL and change[k] < PLAUSIBLE.get(kinds[k], PLAUSIBLE[""])
    ]
    close = [k for k in candidates if left[k] < CLOSE * left[candidates[0]]]
    return sorted(close, key=lambda k: kinds[k] not in NUISANCES)[:NAMED]


def _share(model: Model, size: float) -> str:
    """Return the size of residuals as a share of a force."""
    percent = 100 * size / (model.weight[0] * (1.0 if model.noise != "absolute" else model.top[0]))
    return f"{percent:.2g} %"


def _sentence(model: Model, residuals: Array, size: float, ratio: float) -> str:
    local = np.concatenate([np.diff(residuals[rows], 2) for rows in model.slices])
    near = math.sqrt(float(local @ local) / (6 * local.size))
    of = "largest force" if model.noise == "absolute" else "force"
    return (
        f"the model does not describe the data: residuals are {_share(model, size)} of the {of}, "
        f"where noise from point to point is {_share(model, near)}, and Durbin and Watson's ratio "
        f"is {ratio:.2g} in place of 2"
    )
