"""What the data of an indentation curve tell before any fit: order, contact, units, zero."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from nacre._tools.notices import warn
from nacre._tools.typing import among
from nacre.indent._segments import NOISE_RANGE, OUTLIER, noise_of
from nacre.indent.curves import Curve

Array = npt.NDArray[np.float64]

RISE = 5.0
"""Standard errors between mean forces of shallow and deep points that are a contact. In 2000 random
curves each, noise alone passed in 1, 19 and no curves of 50, 12 and 200 points; a force of ten
standard deviations was missed in none but 51 of the curves of 12 points."""
LEAST_FALL = 0.01, 0.05
"""Shares of the range of depth and of force that a fall must exceed too. A creeping stage drifts
less in depth during a measurement; a force relaxes by more in any hold that matters to a fit."""
SHORT = 0.05
"""Share of the points below which what precedes the largest force is no loading, but noise."""
DEEP = (0.1, 0.3, 0.5)
"""Shares of the points, the deepest, whose mean force is compared with that of the others."""
SHUFFLED = 6
"""Points to a change of direction: values in random order turn at two of three points, and their
path is a third of their number times their range."""

YOUNG = 1e2, 2e12
"""Plausible reduced moduli [Pa]: softer than cells and mucus, and stiffer than diamond on diamond
(1.1e12 over 1 − 0.07², halved for two bodies), each with room for the estimate's error."""
ROOM = 10**1.5
"""Factor about a modulus that is given: half-way, in decades, to a force that is wrong by 1e3."""
TOO_DEEP = 300.0
"""Depth over tip size that no contact has. Sharp AFM tips (10 nm) reach 50 in cells; a wrong unit
is 1e3 off."""
FACTORS = (1e3, 1e-3, 1e6, 1e-6)
"""Factors by which units are confused, the likelier first."""

CANDIDATES = 120
"""Zeros that are tried at first: the sum of squares over the zero is smooth on a hundredth of the
range, and has its lowest minimum on that scale."""
GOLDEN = (math.sqrt(5) - 1) / 2
NARROWINGS = 60
"""Golden sections after which the zero is known to 0.618⁶⁰ = 3e-13 of two candidates' distance."""


def check(curve: Curve) -> None:
    """Refuse a curve without contact, and warn of unloading and of points out of order.

    Fits call it with the data that they are given.

    Parameters
    ----------
    curve : Curve
        Curve, loading or unloading.

    Returns
    -------
    None
        Nothing: a curve without fault gives neither error nor warning.

    Raises
    ------
    ValueError
        If depth or force does not vary, no force is positive, or no force rises above the noise.

    Warns
    -----
    NacreWarning
        If depths are in random order, or depth or force falls after it rose, by more than the
        noise and by more than 1 % or 5 % of its range.

    Notes
    -----
    The noise is estimated from second differences, which a smooth curve hardly has. A curve that
    falls throughout, as `Curve.unloading` gives it, is as good as one that rises throughout.

    Examples
    --------
    >>> depth = np.linspace(0.0, 100e-9, 51)
    >>> nacre.indent.check(nacre.indent.Curve(depth, 31.6 * depth**1.5))
    >>> nacre.indent.check(nacre.indent.Curve(depth, -31.6 * depth**1.5))
    Traceback (most recent call last):
    ...
    ValueError: force must be positive somewhere, got at most ...: the curve has no contact, ...
    """
    depth, force = curve.depth, curve.force
    name = f" of {curve.name!r}" if curve.name else ""
    for argument, values in (("depth", depth), ("force", force)):
        if np.ptp(values) == 0:
            raise ValueError(f"{argument} must vary, got {values[0]:.6g} at each point{name}")
    if force.max() <= 0:
        raise ValueError(
            f"force must be positive somewhere, got at most {force.max():.4g}{name}: the curve has "
            f"no contact, or its force has the other sign"
        )
    if _is_shuffled(depth):
        warn(
            f"depths{name} are in random order; np.argsort(depth, kind='stable') orders them, and "
            f"drift can only be fitted to points in the order of the measurement",
        )
        return
    noise = noise_of(force)
    if not _rises(depth, force, noise):
        raise ValueError(
            f"force must rise with depth above its noise, got a range of {np.ptp(force):.4g} with "
            f"noise of {noise:.2g}, and the largest force at depth {depth[np.argmax(force)]:.4g}"
            f"{name}: the curve has no contact, or its depth has the other sign"
        )
    fall = _fall(depth, force)
    if fall is not None and _fall(depth[::-1], force[::-1]) is not None:
        index, which = fall
        warn(
            f"{which} falls from index {index} on{name}, at depth {depth[index]:.4g} and force "
            f"{force[index]:.4g}: unloading is mixed in, or points are out of order; "
            f"curve.loading() is the part that rises to the largest force",
        )


def _is_shuffled(depth: Array) -> bool:
    path = float(np.abs(np.diff(depth)).sum())
    return path > max(3.0, depth.size / SHUFFLED) * float(np.ptp(depth))


def _rises(depth: Array, force: Array, noise: float) -> bool:
    """Return whether the largest force, or the mean of deep points, exceeds what noise can do."""
    is_deep = depth[np.argmax(force)] >= np.median(depth)
    if is_deep and float(force.max() - np.median(force)) > OUTLIER * noise:
        return True
    ordered = force[np.argsort(depth, kind="stable")]
    for share in DEEP:
        count = max(1, round(share * force.size))
        error = noise * math.sqrt(1 / count + 1 / (force.size - count))
        if float(ordered[-count:].mean() - ordered[:-count].mean()) > RISE * error:
            return True
    return False


def _fall(depth: Array, force: Array) -> tuple[int, str] | None:
    """Return where depth falls, or else force after its largest value, and which of them."""
    least = max(NOISE_RANGE * noise_of(depth), LEAST_FALL[0] * float(np.ptp(depth)))
    highest = np.maximum.accumulate(depth)
    below = np.flatnonzero(highest - depth > least)
    if below.size:
        return int(np.flatnonzero(depth[: below[0]] == highest[below[0]])[-1]), "depth"
    # Before its maximum a force may fall in a loading: snap-in, pop-in.
    least = max(NOISE_RANGE * noise_of(force), LEAST_FALL[1] * float(np.ptp(force)))
    top = int(np.argmax(force))
    if float(force[top] - force[top:].min()) > least:
        return top, "force"
    return None


def suspicious_units(curve: Curve, *, tip_size: float, modulus: float | None = None) -> str | None:
    """Return a sentence if depth or force seems to be in a wrong unit, and None otherwise.

    Hertz' law with the force and depth of the curve gives a modulus::

        E* = F / (4/3 √R d^1.5)

    which is compared with what materials have, or with a modulus that is expected. The depth is
    counted from the contact: between F/2 and F it grows by (1 − 0.5^(2/3)) d.

    Parameters
    ----------
    curve : Curve
        Curve in SI units.
    tip_size : float
        Radius of the tip, or another length that is typical of it [m].
    modulus : float, optional
        Reduced modulus that is expected, to within a factor of thirty [Pa].

    Returns
    -------
    str or None
        Sentence that names the numbers and the factors that would make them plausible.

    Raises
    ------
    ValueError
        If `tip_size` or `modulus` is not positive and finite.

    Notes
    -----
    The test was devised here. Without a modulus a range of ten decades is plausible, from 100 Pa to
    2e12 Pa, and a force that is wrong by 1e3 often stays within it.

    Examples
    --------
    >>> depth = np.linspace(0.0, 100e-9, 51)
    >>> curve = nacre.indent.Curve(depth, 4 / 3 * 70e9 * 1e-6**0.5 * depth**1.5)
    >>> nacre.indent.suspicious_units(curve, tip_size=1e-6)
    >>> wrong = nacre.indent.Curve(depth * 1e-3, curve.force)  # nm taken for pm
    >>> print(nacre.indent.suspicious_units(wrong, tip_size=1e-6, modulus=1e11))
    depth or force may be in a wrong unit: a force ... the depth times 1000 or ...
    """
    for name, value in (("tip_size", tip_size), ("modulus", modulus)):
        if value is not None and not 0 < value < math.inf:
            raise ValueError(f"{name} must be positive and finite, got {value}")
    point = _depth_in_contact(curve)
    if point is None:
        return None
    depth, force = point
    low, high = YOUNG if modulus is None else (modulus / ROOM, modulus * ROOM)

    def hertz(depth: float, force: float) -> float:
        return force / (4 / 3 * math.sqrt(tip_size * depth) * depth)

    def is_plausible(depth: float, force: float) -> bool:
        return low <= hertz(depth, force) <= high and depth <= TOO_DEEP * tip_size

    if is_plausible(depth, force):
        return None
    remedies = [
        f"the {name} times {factor:.7g}"
        for factor in FACTORS
        for name, pair in (("depth", (factor * depth, force)), ("force", (depth, factor * force)))
        if is_plausible(*pair)
    ]
    remedy = f"; {' or '.join(remedies)} would be plausible" if remedies else ""
    return (
        f"depth or force may be in a wrong unit: a force of {force:.3g} N at {depth:.3g} m with a "
        f"tip of {tip_size:.3g} m means a modulus of {hertz(depth, force):.2g} Pa, plausible are "
        f"{low:.2g} to {high:.2g} Pa and a depth up to {TOO_DEEP * tip_size:.2g} m{remedy}"
    )


def _depth_in_contact(curve: Curve) -> tuple[float, float] | None:
    """Return depth from the contact, by Hertz' law, and force at the largest force."""
    depth, force = (values[::-1] for values in _rising_points(curve))
    below = np.flatnonzero(force < 0.5 * force[0])
    if force[0] <= 0 or not below.size:
        return None
    half = int(below[0])
    around = [half, half - 1]
    grown = float(depth[0] - np.interp(0.5 * force[0], force[around], depth[around]))
    return (grown / (1 - 0.5 ** (2 / 3)), float(force[0])) if grown > 0 else None


class ContactPoint(NamedTuple):
    """A curve's zero as `contact_point` finds it."""

    depth: float
    """Depth at which contact begins [m]."""
    uncertainty: float
    """Standard deviation of the depth by the noise alone [m]."""
    force: float
    """Force there, an offset of the sensor [N]; 0 for ``baseline="none"``."""


def contact_point(
    curve: Curve, *, baseline: str = "constant", exponent: float = 1.5, up_to: float = 0.3
) -> ContactPoint:
    """Return an estimate of the depth at which contact begins, to start a fit from.

    Least squares of a baseline and a power law over the first part of the loading::

        F = b0 + b1 d + k max(d − d0, 0)^n

    The sum of squares is minimised over d0 by trial of depths on a grid, and by golden sections
    about the best one; the other coefficients are linear.

    Parameters
    ----------
    curve : Curve
        Curve with an approach, or one that starts near the contact. Only the part up to the largest
        force is used; if there is hardly one, the curve is taken as unloading.
    baseline : str
        Force before contact: "constant", "linear" (a tilt with depth), or "none" (zero).
    exponent : float
        Exponent n: 1.5 for a sphere, 2 for a cone or pyramid.
    up_to : float
        Share of the largest force up to which points are used. Layers, and other tips than those of
        the exponent, change the law at greater depth.

    Returns
    -------
    ContactPoint
        Named tuple of depth [m], its standard deviation [m], and the force there [N].

    Raises
    ------
    ValueError
        If too few points are in range, the force does not rise with depth, or an argument is not
        one of those above.

    Notes
    -----
    A variant, devised here, of the sequential search of Lin, Dimitriadis and Horkay, J. Biomech.
    Eng. 129 (2007) 430-440, doi:10.1115/1.2720924, who fit the baseline and the contact separately.
    The uncertainty is that of linearised least squares with noise of equal size at each point. It
    does not know of adhesion, roughness, or a wrong exponent; and it is large where the curve
    starts in contact.

    Examples
    --------
    >>> depth = np.linspace(0.0, 100e-9, 101)
    >>> force = 2e-9 + 31.6 * np.maximum(depth - 40e-9, 0.0) ** 1.5
    >>> found = nacre.indent.contact_point(nacre.indent.Curve(depth, force))
    >>> print(f"{found.depth:.4g} m, {found.force:.4g} N")
    4e-08 m, 2e-09 N
    """
    if not among(baseline, ("none", "constant", "linear")):
        raise ValueError(f"baseline must be 'none', 'constant' or 'linear', got {baseline!r}")
    if not 1 <= exponent <= 10:
        raise ValueError(f"exponent must be between 1 and 10, got {exponent}")
    if not 0 < up_to <= 1:
        raise ValueError(f"up_to must be above 0 and at most 1, got {up_to}")
    terms = ("none", "constant", "linear").index(baseline)
    depth, force = _first_part(curve, up_to)
    if depth.size < terms + 3:
        raise ValueError(
            f"the curve must have at least {terms + 3} points up to {up_to:g} of its largest "
            f"force, got {depth.size}; raise up_to"
        )
    start, reach, size = float(depth.min()), float(np.ptp(depth)), float(np.ptp(force))
    if reach == 0 or size == 0:
        raise ValueError("depth and force must vary up to the largest force, got one value of them")
    x, y = (depth - start) / reach, force / size

    def fitted(zero: float) -> tuple[float, Array, Array]:
        """Return the sum of squares, the coefficients, and the columns that they multiply."""
        columns = [*[np.ones_like(x), x][:terms], np.maximum(x - zero, 0.0) ** exponent]
        matrix = np.stack(columns, axis=1)
        best = np.asarray(np.linalg.lstsq(matrix, y)[0], dtype=np.float64)
        misfit = y - matrix @ best
        return (float(misfit @ misfit) if best[-1] > 0 else math.inf), best, matrix

    # A curve that starts in contact has its zero before the first point; the last needs some after.
    trials = np.linspace(-1.0, float(np.sort(x)[-3]), CANDIDATES, endpoint=False)
    squares = [fitted(float(zero))[0] for zero in trials]
    lowest = int(np.argmin(squares))
    if not math.isfinite(squares[lowest]):
        raise ValueError("force must rise with depth, got none that does: there is no contact")
    step = float(trials[1] - trials[0])
    low, high = float(trials[lowest]) - step, float(trials[lowest]) + step
    for _ in range(NARROWINGS):
        left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        if fitted(left)[0] <= fitted(right)[0]:
            high = right
        else:
            low = left
    zero = 0.5 * (low + high)
    square, best, matrix = fitted(zero)
    # Derivative of the law by its zero; a base is needed for 0⁰ where the exponent is 1.
    slope = -best[-1] * exponent * np.maximum(x - zero, 0.0) ** (exponent - 1) * (x > zero)
    jacobian = np.column_stack([matrix, slope])
    variance = square / max(x.size - jacobian.shape[1], 1)
    spread = math.sqrt(variance * max(float(np.linalg.pinv(jacobian.T @ jacobian)[-1, -1]), 0.0))
    there = float(best[:terms] @ np.array([1.0, zero])[:terms])
    return ContactPoint(start + reach * zero, reach * spread, size * there)


def _first_part(curve: Curve, up_to: float) -> tuple[Array, Array]:
    """Return depth and force of the loading up to the last point below a share of the force."""
    depth, force = _rising_points(curve)
    least = float(force.min())
    below = np.flatnonzero(force <= least + up_to * (float(force.max()) - least))
    end = int(below[-1]) + 1
    return depth[:end], force[:end]


def _rising_points(curve: Curve) -> tuple[Array, Array]:
    """Return depth and force up to the largest force: of the loading, or of unloading backwards."""
    top = int(np.argmax(curve.force))
    side = slice(top + 1) if top >= max(2, SHORT * len(curve)) else slice(None, None, -1)
    depth, force = curve.depth[side], curve.force[side]
    end = int(np.argmax(force)) + 1
    return depth[:end], force[:end]
