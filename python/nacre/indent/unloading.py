"""Hardness and modulus from the unloading of an indent that yielded, after Oliver and Pharr."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.extras import extra
from nacre._tools.notices import warn
from nacre.indent._segments import NOISE_RANGE, OUTLIER, noise_of
from nacre.indent.curves import LEAST_POINTS, Curve
from nacre.results.quantities import frozen, quantity
from nacre.results.shown import TableResult

__all__ = ["OliverPharr", "oliver_pharr", "section"]

Array = npt.NDArray[np.float64]

EPSILON = 0.75
"""Factor ε of the depth at which a paraboloid's edge is below the surface; used for pyramids, too
(Oliver and Pharr 1992, doi:10.1557/JMR.1992.1564)."""
POWERS = 1.0, 2.5
"""Powers of unloadings: 1 for a flat punch, 2 for a cone, 1.2 to 1.6 measured with a Berkovich tip
(the same, table I), and half more. Others are no elastic unloading."""
BEYOND = 3.0
"""Standard errors by which a power is beyond those: that of a flat punch is by chance once in 700
curves."""
OFF = 0.02
"""Share by which the force at the largest depth may differ from the power law: what a modulus to a
few per cent can bear."""


@frozen()
class OliverPharr(TableResult):
    """Hardness and modulus from an unloading curve.

    Errors are standard errors by the scatter about the power law alone: those of the tip's area,
    the zero of the depth and the compliance of the machine come in addition.
    """

    _TITLE = "hardness and modulus from an unloading curve"

    hardness: float = quantity("Pa", label="hardness")
    """Hardness [Pa]: largest force over area."""
    hardness_error: float = quantity("Pa", label="±")
    """Its standard error [Pa]."""
    reduced_modulus: float = quantity("Pa", label="reduced modulus")
    """Reduced modulus, with the tip [Pa]: E_r of the sample and the tip's material together."""
    reduced_modulus_error: float = quantity("Pa", label="±")
    """Its standard error [Pa]."""
    modulus: float = quantity("Pa", label="modulus E/(1 − ν²)")
    """E/(1 − ν²) of the sample [Pa], without the tip's compliance."""
    modulus_error: float = quantity("Pa", label="±")
    """Its standard error [Pa]."""
    stiffness: float = quantity("N/m", label="slope")
    """Slope at the largest depth [N/m]: S of the unloading."""
    stiffness_error: float = quantity("N/m", label="±")
    """Its standard error [N/m]."""
    power: float = quantity(label="power m")
    """Power of the unloading: m of the law P = a (h − h_p)^m."""
    power_error: float = quantity(label="±")
    """Its standard error."""
    final_depth: float = quantity("m", label="final depth")
    """Depth at which the law has no force [m]: h_p."""
    largest_depth: float = quantity("m", label="largest depth")
    """Largest depth [m], at which the unloading begins."""
    largest_force: float = quantity("N", label="largest force")
    """Force of the law there [N]."""
    contact_depth: float = quantity("m", label="contact depth")
    """Depth of contact [m]: h_c."""
    area: float = quantity("m²", label="area")
    """Area of the tip's section there [m²]: A(h_c)."""
    epsilon: float = quantity(label="ε")
    """Factor ε of the depth of contact."""
    beta: float = quantity(label="β")
    """Factor β of the modulus."""
    points: int = quantity(label="points")
    """Number of points of the fit."""
    notes: tuple[str, ...]
    """What limits the validity. Each but that about films was issued as a warning, too."""


ON_FILMS = (
    "on a film these are numbers of film and substrate together: its own hardness needs contact "
    "depths below a tenth of its thickness, its modulus still smaller ones"
)
"""Note on thin films; the tenth is Bückle's rule (ISO 14577-4 extrapolates to no depth)."""


class _Theory(NamedTuple):
    """Elastic unloading from the largest depth, which gives hardness and moduli."""

    tip: core.Tip
    counterbody: core.Elastic | None
    deepest: float
    epsilon: float
    beta: float

    def contact_depth(self, load: float, slope: float) -> float:
        """Return the depth over which the tip touches [m]."""
        return self.deepest - self.epsilon * load / slope

    def numbers(self, load: float, slope: float) -> Array:
        """Return hardness, reduced modulus, modulus, area and contact depth."""
        contact = self.contact_depth(load, slope)
        area = math.pi * section(self.tip, contact) ** 2
        reduced = math.sqrt(math.pi / area) * slope / (2 * self.beta)
        own = 0.0 if self.counterbody is None else 1 / self.counterbody.plane_strain_modulus
        return np.array([load / area, reduced, 1 / (1 / reduced - own), area, contact])

    def checked_numbers(self, load: float, slope: float) -> list[float]:
        """Return the numbers, or raise a `ValueError` where there is no such contact."""
        contact = self.contact_depth(load, slope)
        # The section of a flat punch is one at all depths; without yield its contact depth is 0.
        if contact <= 0 and self.tip.kind != "flat_punch":
            raise ValueError(
                f"curve must have a contact depth above 0, got {contact:.4g} "
                f"at the largest depth {self.deepest:.4g}: its depth has another zero"
            )
        hardness, reduced, modulus, *section_numbers = self.numbers(load, slope).tolist()
        if not modulus > 0:
            raise ValueError(
                f"counterbody must be stiffer than the reduced modulus, {reduced:.4g}, got "
                f"{self.counterbody!r}"
            )
        return [hardness, reduced, modulus, *section_numbers]

    def errors(self, load: float, slope: float, covariance: Array) -> Array:
        """Return standard errors of hardness and moduli by the covariance of force and slope."""
        # Central differences: small beside the numbers, and large beside their rounding.
        steps = 1e-5 * np.array([load, slope])
        rates = np.stack(
            [
                (self.numbers(load + dp, slope + ds) - self.numbers(load - dp, slope - ds))
                / (2 * step)
                for (dp, ds), step in zip(np.diag(steps), steps, strict=True)
            ],
            axis=1,
        )[:3]
        variances: Array = np.einsum("ij,jk,ik->i", rates, covariance, rates)
        return np.sqrt(variances)


def oliver_pharr(
    curve: Curve,
    tip: core.Tip,
    part: tuple[float, float] = (0.2, 0.98),
    *,
    counterbody: core.Elastic | None = None,
    epsilon: float = EPSILON,
    beta: float = 1.0,
) -> OliverPharr:
    """Hardness and modulus from the unloading of an indent; needs ``nacre-contact[fit]``.

    A power law is fitted to the unloading, and its slope S and force P at the largest depth h give
    contact depth h_c, hardness H and reduced modulus E_r::

        P = a (h − h_p)^m                     h_c = h − ε P/S
        H = P/A(h_c)                          E_r = √π/(2 β) S/√A(h_c)
        1/E_r = (1 − ν²)/E + (1 − ν_i²)/E_i

    Parameters
    ----------
    curve : Curve
        Curve with an unloading, see `Curve.unloading`, whose zero of the depth is the contact.
    tip : Tip
        Tip, the area of whose section is A: `Tip.berkovich`, or `Tip.area_function` of a tip that
        was calibrated.
    part : tuple of float
        Shares of the largest force between which points are fitted: the beginning has creep, the
        end other laws.
    counterbody : Elastic, optional
        Material of the tip, such as diamond, ``Elastic(1141e9, 0.07)``; rigid by default.
    epsilon : float
        Factor ε: 0.75 for paraboloids and customary for pyramids, 0.72 for cones, 1 for flat
        punches.
    beta : float
        Factor β of tips that are not axisymmetric, 1 in ISO 14577; 1.034 for triangular pyramids
        by King (1987, doi:10.1016/0020-7683(87)90116-8), 1.05 by Oliver and Pharr (2004).

    Returns
    -------
    OliverPharr
        Numbers with standard errors.

    Raises
    ------
    ValueError
        If the curve has no unloading, too few points in the part, or no contact depth above 0.

    Warns
    -----
    NacreWarning
        If the power is none of an elastic unloading, or the force at the largest depth is not that
        of the law, as with creep; `OliverPharr.notes` has all of that.

    Notes
    -----
    Oliver and Pharr, J. Mater. Res. 7 (1992) 1564-1583, doi:10.1557/JMR.1992.1564, and 19 (2004)
    3-20, doi:10.1557/jmr.2004.19.1.3. The theory is that of a homogeneous body that sinks in at the
    edge: material that piles up has a larger area, and both numbers are too large. In a thin film
    they are those of film and substrate together. Neighbouring residuals that are correlated
    widen the errors by √((1 + r)/(1 − r)) of their correlation r.

    Examples
    --------
    >>> depth = np.linspace(500e-9, 302e-9, 200)
    >>> force = 10e-3 * ((depth - 300e-9) / 200e-9) ** 1.35
    >>> curve, tip = nacre.indent.Curve(depth, force), nacre.indent.Tip.berkovich()
    >>> found = nacre.indent.oliver_pharr(curve, tip)
    >>> print(f"{found.hardness / 1e9:.2f} GPa, {found.reduced_modulus / 1e9:.1f} GPa")
    2.70 GPa, 31.1 GPa
    """
    ends = _checked_part(part)
    for name, factor in (("epsilon", epsilon), ("beta", beta)):
        if not (isinstance(factor, int | float) and 0 < factor < math.inf):
            raise ValueError(f"{name} must be positive and finite, got {factor!r}")
    if counterbody is not None and not isinstance(counterbody, core.Elastic):
        raise TypeError(f"counterbody must be an Elastic, got {counterbody!r}")
    branch, points = _points(curve, *ends)
    depth, force = branch.depth[points], branch.force[points]
    deepest, size = float(branch.depth.max()), float(branch.force.max())
    law, covariance = _power_law((deepest - depth) / deepest, force / size)
    units = np.array([size, size / deepest, 1.0])
    load, slope, power = (float(number) for number in law * units)
    covariance = covariance * np.outer(units, units)
    theory = _Theory(tip, counterbody, deepest, epsilon, beta)
    hardness, reduced, modulus, area, contact = theory.checked_numbers(load, slope)
    errors = theory.errors(load, slope, covariance[:2, :2])
    power_error = math.sqrt(float(covariance[2, 2]))
    notes = _notes(branch, load, slope, power, power_error)
    for note in notes:
        warn(note)
    return OliverPharr(
        hardness=hardness,
        hardness_error=float(errors[0]),
        reduced_modulus=reduced,
        reduced_modulus_error=float(errors[1]),
        modulus=modulus,
        modulus_error=float(errors[2]),
        stiffness=slope,
        stiffness_error=math.sqrt(float(covariance[1, 1])),
        power=power,
        power_error=power_error,
        final_depth=deepest - power * load / slope,
        largest_depth=deepest,
        largest_force=load,
        contact_depth=contact,
        area=area,
        epsilon=float(epsilon),
        beta=float(beta),
        points=depth.size,
        notes=(*notes, ON_FILMS),
    )


def _checked_part(part: tuple[float, float]) -> tuple[float, float]:
    try:
        low, high = (float(share) for share in part)
    except (TypeError, ValueError):
        raise TypeError(f"part must be two shares of the largest force, got {part!r}") from None
    if not 0 <= low < high <= 1:
        raise ValueError(f"part must be two shares, 0 <= low < high <= 1, got {part!r}")
    return low, high


def _points(curve: Curve, low: float, high: float) -> tuple[Curve, slice]:
    """Return the unloading, and its points between two shares of the largest force."""
    if int(np.argmax(curve.force)) > len(curve) - LEAST_POINTS and curve.depth[0] < curve.depth[-1]:
        raise ValueError(
            "curve must have an unloading after its largest force, got a loading; one that is "
            "sorted by depth is Curve(depth[::-1], force[::-1])"
        )
    branch = curve.unloading()
    size = float(branch.force.max())
    first = int(np.argmax(branch.force <= high * size))
    below = np.flatnonzero(branch.force[first:] < low * size)
    span = slice(first, first + int(below[0]) if below.size else None)
    depth = branch.depth[span]
    if depth.size <= LEAST_POINTS or np.ptp(depth) == 0:
        raise ValueError(
            f"curve must have more than {LEAST_POINTS} points of its unloading between {low:g} and "
            f"{high:g} of the largest force, got {depth.size}"
        )
    return branch, span


def _power_law(below: Array, force: Array) -> tuple[Array, Array]:
    """Return P, S and m of P (1 − S x/(m P))^m, over x below the largest depth, with covariance."""
    with extra("fit"):
        from scipy.optimize import least_squares

    def law(numbers: Array) -> Array:
        load, slope, power = numbers
        return np.asarray(
            load * np.maximum(1 - slope * below / (power * load), 0.0) ** power - force
        )

    # A line through both ends of the part is less steep, and its force larger, than the law.
    start = np.array([1.0, float(np.ptp(force) / np.ptp(below)), 1.5])
    best = least_squares(law, start, x_scale="jac", bounds=([0.1, 0.0, 0.5], [10, np.inf, 10]))
    misfit, squares = best.fun, float(best.fun @ best.fun)
    variance = squares / max(force.size - 3, 1)
    along = float(misfit[1:] @ misfit[:-1]) / squares if variance > 0 else 0.0
    spread = (1 + along) / (1 - along) if 0 < along < 1 else 1.0
    return best.x, variance * spread * np.linalg.pinv(best.jac.T @ best.jac)


def _notes(branch: Curve, load: float, slope: float, power: float, power_error: float) -> list[str]:
    notes = []
    printed, sure = f"{power:.3g}", BEYOND * power_error
    if not POWERS[0] - sure <= float(printed) <= POWERS[1] + sure:
        notes.append(
            f"the power of the unloading is {printed}, where elastic ones have {POWERS[0]:g} to "
            f"{POWERS[1]:g}: look at the part, creep and drift"
        )
    deepest = int(np.argmax(branch.depth))
    top = slice(deepest, deepest + LEAST_POINTS)
    below = float(branch.depth[deepest]) - branch.depth[top]
    law = load * np.maximum(1 - slope * below / (power * load), 0.0) ** power
    excess = float(np.mean(branch.force[top] - law)) / load
    noise = noise_of(branch.force) / load / math.sqrt(LEAST_POINTS)
    if abs(excess) > OFF + OUTLIER * noise:
        notes.append(
            f"the force at the largest depth is {1 + excess:.3g} times that of the power law: the "
            "sample creeps, or the part begins too low; a longer hold helps"
        )
    rises = float(branch.depth.max() - branch.depth[0])
    if rises > OFF * float(np.ptp(branch.depth)) + NOISE_RANGE * noise_of(branch.depth):
        notes.append(
            f"the depth rises by another {rises:.3g} m after the force began to fall: the sample "
            "creeps, and the slope is too steep"
        )
    return notes


def section(tip: core.Tip, depth: float) -> float:
    """Return the radius of a tip's section at a depth above 0 from its apex."""
    if tip.kind == "flat_punch":
        return float(tip.numbers["radius"])
    low, high = 1e-3 * depth, 1e3 * depth
    for _ in range(200):
        middle = math.sqrt(low * high)
        try:
            is_inside = float(tip.gap(middle)) < depth
        except ValueError:
            is_inside = False
        low, high = (middle, high) if is_inside else (low, middle)
        if high / low < 1 + 1e-12:
            break
    return middle
