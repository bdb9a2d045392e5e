"""Fits of indentation curves that say how sure they are."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.notices import heard, warn
from nacre._tools.paths import numbered
from nacre._tools.progress import lasting
from nacre._tools.typing import among
from nacre.indent._addressed import System
from nacre.indent._model import OF_FORCE, Model, Noise
from nacre.indent._profile import Estimate, estimate_at, interval, minimum, reasons, shifted_starts
from nacre.indent._residuals import Examination, examine, likeliest_noise
from nacre.indent._result import Fit
from nacre.indent._verdict import UNFIT
from nacre.indent.checks import check, contact_point, suspicious_units
from nacre.indent.curves import Curve

Array = npt.NDArray[np.float64]
Data = Curve | Sequence[Curve] | tuple[npt.ArrayLike, npt.ArrayLike]

__all__ = ["Fit", "fit"]

WEAK = 100.0
"""Ratio of the moduli of a body up to which a Hertzian modulus is expected near their mean."""


def fit(
    data: Data,
    body: core.HalfSpace | core.Elastic,
    tip: core.Tip,
    free: Sequence[str],
    *,
    counterbody: core.HalfSpace | core.Elastic | None = None,
    adhesion: core.Adhesion | None = None,
    nuisance: Sequence[str] = (),
    noise: Literal["auto", "relative", "absolute"] = "auto",
    sigma: float | None = None,
    prior: Mapping[str, tuple[float, float]] | None = None,
    known: Mapping[str, tuple[float, float]] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    starts: Sequence[Mapping[str, float]] | None = None,
    profile: bool = True,
    progress: Callable[[str], object] | None = None,
) -> Fit:
    """Fit indentation curves by least squares; needs ``nacre-contact[fit]``.

    The true depth is d − d0 − v t − C F, with the nuisances contact point d0, drift v and
    compliance C of the machine. The force is that of the body plus F0 + s (d − d1), with the
    nuisances zero of the force F0 and slope s of the baseline from the first depth d1.

    Parameters
    ----------
    data : Curve, sequence of Curve, or pair of array_like
        Loading or unloading, as depth and force or as `Curve`; see `Curve.loading`. Several curves
        share the body and the tip, and have nuisances of their own.
    body : HalfSpace or Elastic
        Body with all that is known, and starting values of what is free.
    tip : Tip
        Tip, likewise.
    free : sequence of str
        Free parameters as `Indentation.parameters` lists them, such as
        ``"body.layers[0].material.young"``, ``"body.layers[0].thickness"``,
        ``"body.substrate.young"``, ``"tip.radius"`` or ``"tip.area"``.
    counterbody : HalfSpace or Elastic, optional
        Body of the tip; rigid by default.
    adhesion : Adhesion, optional
        Adhesion within the contact (JKR) or outside (DMT).
    nuisance : sequence of str
        Some of "contact_point", "drift" (curves with a time), "compliance", "force_offset" and
        "force_slope". The last two need points before contact.
    noise : {"auto", "relative", "absolute"}
        Noise of the force: a share of each force, or the same at each point. By default the
        likelier of these by what varies from point to point, or both where that is likelier.
    sigma : float, optional
        Standard deviation of the noise, a share or [N], where `noise` is given. By default it is
        estimated from the residuals, as a share of a curve's largest force where it is absolute;
        intervals are then Student's.
    prior : mapping, optional
        What is known otherwise of free parameters: value and standard deviation by name.
    known : mapping, optional
        What is known of parameters that are held: value, which takes the place of that of `body`
        and `tip`, and standard error by name, such as ``{"tip.radius": (5e-6, 5e-8)}``. Of all
        other moduli, thicknesses and numbers of the tip but an exponent 1 % is assumed; what else
        is held counts as exact.
    bounds : mapping, optional
        Least and largest value by name.
    starts : sequence of mapping, optional
        Further starts, values by name. By default three times and a third of each free thickness,
        or of the first parameter where no thickness is free.
    profile : bool
        Whether intervals are found by profile likelihood, and other starts are tried. Otherwise
        they are linear, and only these decide what is identifiable.
    progress : callable, optional
        Function that is called with a short text at each stage. By default a terminal or a notebook
        shows a bar after two seconds.

    Returns
    -------
    Fit
        Estimates, errors, intervals, and for each parameter whether the data tell it.

    Raises
    ------
    ValueError
        If an argument is not one of those above, or the data hold no contact.

    Warns
    -----
    NacreWarning
        If points are out of order, unloading is mixed in, a unit is likely to be wrong, or the
        model does not describe the data; `Fit.warnings` has what was said of the model.

    Notes
    -----
    Residuals must be noise: neighbours without correlation, by Durbin and Watson's ratio; without a
    part that a number held by the fit would explain, such as the contact point or a thickness, by
    score tests; and of the size of `sigma` where that is given. Otherwise no parameter is
    identifiable, the warning names what to free, and intervals are linear and wider: by the
    correlation, and by what the first remedy would change. What no residual shows, such as the
    radius of a paraboloid on a bare body, remains: estimates hold for the numbers that are given,
    and `Fit.sensitivity` says how they depend on them.

    A parameter is identifiable if its 95 % interval by profile likelihood closes within the bounds
    and is at most a factor of exp(0.5) either way, if this agrees with the linear interval within a
    factor of 1.5, and if no other start leads to a minimum outside of it with a χ² that is less
    than 3.84 above the least. These criteria were chosen here.

    Standard errors and intervals are those of the noise. `Fit.uncertainty` adds what the errors σ_q
    of each number q that is held do to the estimates x, by the implicit function theorem::

        dx/dq = −(JᵀJ)⁻¹ Jᵀ ∂r/∂q        u² = s² + Σ (dx/dq σ_q)²

    with the residuals r and their Jacobian J. As in Gauss and Newton's method products of residuals
    with their second derivatives are left out, and x is taken to be linear in q up to its error;
    errors of different numbers are taken to be independent.

    Moduli, thicknesses, radii and the work of adhesion are fitted by their logarithms.

    Examples
    --------
    >>> tip = nacre.indent.Tip.paraboloid(10e-6)
    >>> glass = nacre.Elastic(70e9, 0.2)
    >>> coating = nacre.Layer(nacre.Elastic(3e9, 0.3), 2e-6)
    >>> body = nacre.HalfSpace(glass, layers=[coating])
    >>> depth = np.linspace(10e-9, 300e-9, 40)
    >>> made = nacre.indent.Indentation(body, tip).curve(approach=depth)
    >>> noise = 1 + 0.01 * np.random.default_rng(1).standard_normal(40)
    >>> guess = nacre.HalfSpace(glass, layers=[nacre.Layer(nacre.Elastic(1e9, 0.3), 2e-6)])
    >>> young = "body.layers[0].material.young"
    >>> found = nacre.indent.fit((depth, made.load * noise), guess, tip, [young])
    >>> all(found.identifiable.values()), bool(abs(found.estimates[young] / 3e9 - 1) < 0.02)
    (True, True)
    """
    curves = _curves(data)
    _check_arguments(noise, sigma, nuisance)
    system = System.of(body, tip, counterbody, adhesion)
    free = free if isinstance(free, str) else numbered(vars(system), free)
    known = _checked_known(system.by_number(known or {}), system, free)
    starts = starts and [system.by_number(start) for start in starts]
    system = system.with_values({name: value for name, (value, _) in known.items()})
    doubts = _doubts(curves, system)
    for text in doubts:
        warn(text)

    def new_model(noise: Noise, floor: float = 0.0) -> Model:
        return Model(
            curves,
            system,
            free,
            nuisance,
            noise=noise,
            floor=floor,
            sigma=sigma,
            prior=system.by_number(prior or {}),
            bounds=system.by_number(bounds or {}),
        )

    model = new_model("absolute" if noise == "auto" else noise)
    if model.dof < 1:
        raise ValueError(
            f"data must have more points than free parameters, {len(model.names)}, got "
            f"{model.depth.size}"
        )
    with lasting("fit", progress) as tell:
        best = _model_fit(new_model, model, noise, starts, profile, tell or (lambda text: None))
    return replace(best, warnings=(*doubts, *best.warnings), known=known)


def _model_fit(
    new_model: Callable[..., Model],
    model: Model,
    noise: str,
    starts: Sequence[Mapping[str, float]] | None,
    profile: bool,
    tell: Callable[[str], object],
) -> Fit:
    """Return the fit of a model; `new_model` makes it again with another kind of noise."""
    tell("first estimate")
    start = _start(model)
    if noise == "auto":
        rough = minimum(model, start, rough=True)
        model = new_model(*likeliest_noise(model, rough))
        start = rough if math.isfinite(model.chi2(rough)) else _start(model)
    best = _weighed_minimum(model, start)
    minima: list[tuple[Array, float]] = []
    if profile:
        places = shifted_starts(model, best.x) if starts is None else _places(model, starts, best.x)
        for number, place in enumerate(places, 1):
            tell(f"start {number} of {len(places)}")
            x = minimum(model, np.clip(place, model.low, model.high), rough=True)
            if (chi2 := model.chi2(x)) < best.chi2 - 1e-3 * best.variance:
                minima.append((best.x, best.chi2))
                best = estimate_at(model, minimum(model, x))
            else:
                minima.append((x, chi2))
    examination = examine(model, best)
    for text in examination.warnings:
        warn(text)
    ends: dict[str, tuple[float, float]] = {}
    if profile and not examination.warnings:
        for k, unknown in enumerate(model.unknowns):
            if not unknown.kind:
                tell(f"interval of {unknown.name}")
                ends[unknown.name] = interval(model, best, k)
    return _result(model, examination, ends, minima, profile)


def _curves(data: Data) -> list[Curve]:
    if isinstance(data, Curve):
        return [data]
    items = list(data)
    if items and all(isinstance(item, Curve) for item in items):
        return [item for item in items if isinstance(item, Curve)]
    if len(items) in (2, 3) and not any(isinstance(item, Curve) for item in items):
        depth, force, *time = items
        return [Curve(depth, force, time=time[0] if time else None)]  # type: ignore[arg-type]
    raise TypeError(
        "data must be a Curve, a sequence of Curves, or depth and force (and time), got "
        f"{len(items)} items"
    )


def _check_arguments(noise: str, sigma: float | None, nuisance: Sequence[str]) -> None:
    if not among(noise, ("auto", "relative", "absolute")):
        raise ValueError(f"noise must be 'auto', 'relative' or 'absolute', got {noise!r}")
    if sigma is not None and not 0 < sigma < math.inf:
        raise ValueError(f"sigma must be positive and finite, got {sigma}")
    if sigma is not None and noise == "auto":
        raise ValueError(
            "noise must be 'relative' or 'absolute' where sigma is given, as a share or in newtons"
        )
    if isinstance(nuisance, str):
        raise TypeError(f"nuisance must be a sequence of names, got {nuisance!r}")


def _checked_known(
    known: Mapping[str, tuple[float, float]], system: System, free: Sequence[str]
) -> dict[str, tuple[float, float]]:
    """Return what is known of parameters that are held, as numbers."""
    held = system.held(free)
    for name in known:
        if name not in held:
            raise ValueError(
                f"known must name parameters that are held, {list(held)}, got {name!r}"
            )
    try:
        numbers = {name: (float(value), float(error)) for name, (value, error) in known.items()}
    except (TypeError, ValueError):
        raise TypeError(f"known must hold pairs of value and error, got {known!r}") from None
    for name, (value, error) in numbers.items():
        if not (0 <= error < math.inf and (name != "tip.area" or value == 1)):
            raise ValueError(
                f"known must hold a value and its standard error, not below 0, and 1 for an area "
                f"of the tip, got {name} = {(value, error)}"
            )
    return numbers


def _doubts(curves: Sequence[Curve], system: System) -> list[str]:
    """Return warnings about curves, and refuse those without contact."""
    with heard() as caught:
        for curve in curves:
            check(curve)
            _check_units(curve, system)
    return caught


def _check_units(curve: Curve, system: System) -> None:
    """Warn if depth or force is far from what the body's starting values say."""
    tip, body = system.tip, system.body
    size = tip.end_radius
    if size is None and "slope" in tip.numbers:
        # The sphere that has the cone's force at this depth, by Sneddon's and Hertz' laws.
        size = (1.5 / (math.pi * tip.numbers["slope"])) ** 2 * float(np.ptp(curve.depth))
    if size is None:
        return
    if not isinstance(body.substrate, core.Elastic):
        modulus = None  # a thin layer seems stiffer by any factor
    else:
        moduli = [layer.material.plane_strain_modulus for layer in body.layers]
        moduli.append(body.substrate.plane_strain_modulus)
        if max(moduli) > WEAK * min(moduli):
            return
        modulus = math.sqrt(max(moduli) * min(moduli))
        counterbody = system.counterbody
        if counterbody is not None and isinstance(counterbody.substrate, core.Elastic):
            modulus = 1 / (1 / modulus + 1 / counterbody.substrate.plane_strain_modulus)
    sentence = suspicious_units(curve, tip_size=size, modulus=modulus)
    if sentence is not None:
        name = f" of {curve.name!r}" if curve.name else ""
        warn(f"{sentence}{name}")


def _start(model: Model) -> Array:
    """Return where the fit starts: the given values, with moduli scaled to the forces."""
    x = np.zeros(len(model.unknowns))
    guessed = x.copy()
    kinds = {unknown.kind for unknown in model.unknowns}
    baseline: Literal["none", "constant", "linear"] = "none"
    if kinds & set(OF_FORCE):
        baseline = "linear" if "force_slope" in kinds else "constant"
    for k, unknown in enumerate(model.unknowns):
        if unknown.kind in ("contact_point", "force_offset"):
            curve = model.curves[unknown.curve]
            try:
                zero = contact_point(curve, baseline=baseline)
            except ValueError:
                continue
            if unknown.kind == "force_offset":
                guessed[k] = unknown.place(min(max(zero.force, unknown.low), unknown.high))
                continue
            zero_depth = zero.depth
            if model.noise == "relative":
                zero_depth = min(zero_depth, float(curve.depth.min()) - 1e-3 * unknown.scale)
            guessed[k] = unknown.place(min(max(zero_depth, unknown.low), unknown.high))
    places = [x] if np.array_equal(x, guessed) else [x, guessed]
    best = min((_scaled_start(model, place) for place in places), key=model.chi2)
    if not math.isfinite(model.chi2(best)):
        load, _ = model.loads(best)
        apart = int((load <= 0).sum())
        raise ValueError(
            f"data must lie in contact at the start, got {apart} of {load.size} points where "
            f"nothing touches: free the contact point, or shift the curve by contact_point(…).depth"
        )
    if not (model.approach(best) > 0).any() and model.system.adhesion is None:
        raise ValueError(
            "no depth lies in contact at the start: the depth has another zero or sign"
        )
    return best


def _scaled_start(model: Model, x: Array) -> Array:
    """Return x with the free moduli scaled to the mean force."""
    moduli = [k for k, name in enumerate(model.names) if name.endswith(".young")]
    if not moduli:
        return x
    try:
        load, _ = model.loads(x)
    except (ValueError, RuntimeError):
        return x
    touching = (load > 0.01 * load.max()) & (model.force > 0)
    if not touching.any() or load.max() <= 0:
        return x
    shift = float(np.median(np.log(model.force[touching] / load[touching])))
    scaled = x.copy()
    scaled[moduli] += shift
    scaled = np.clip(scaled, model.low, model.high)
    return scaled if abs(shift) > 0.3 and model.chi2(scaled) < model.chi2(x) else x


def _weighed_minimum(model: Model, start: Array) -> Estimate:
    best = estimate_at(model, minimum(model, start))
    if model.prior and not model.is_known:
        # Priors are weighed against residuals, whose size the residuals themselves tell.
        for _ in range(3):
            model.weigh_priors(math.sqrt(_scatter(model, best.x)))
            best = estimate_at(model, minimum(model, best.x))
    return best


def _scatter(model: Model, x: Array) -> float:
    residuals = model.at(x)[0][: model.depth.size]
    return float(residuals @ residuals) / max(residuals.size - len(model.unknowns), 1)


def _places(model: Model, starts: Sequence[Mapping[str, float]], x: Array) -> list[Array]:
    places = []
    for values in starts:
        place = x.copy()
        for name, value in values.items():
            if name not in model.names:
                raise ValueError(f"starts must name parameters of the fit, got {name!r}")
            k = model.names.index(name)
            place[k] = model.unknowns[k].place(value)
        places.append(place)
    return places


def _result(
    model: Model,
    examination: Examination,
    ends: dict[str, tuple[float, float]],
    minima: list[tuple[Array, float]],
    profile: bool,
) -> Fit:
    """Return the fit at the best estimate, with intervals from the ends of profiles, or linear."""
    best = examination.estimate
    x, rates = best.x, model.rates(best.x)
    spread = best.spread
    intervals = {}
    for k, unknown in enumerate(model.unknowns):
        half = best.quantile * spread[k]
        pair = ends.get(unknown.name, (float(x[k]) - half, float(x[k]) + half))
        low, high = (_value(unknown.value, end) for end in pair)
        intervals[unknown.name] = low, high
    load, _ = model.loads(x)
    residuals = -model.at(x)[0][: load.size] / model.weight
    approach = model.approach(x)
    sigma = 1 / float(model.weight[0]) * (1.0 if model.is_known else math.sqrt(best.variance))
    with np.errstate(invalid="ignore"):
        covariance = best.covariance * np.outer(rates, rates)
    system = model.system_at(x)
    curve_warnings = system.curve(approach).warnings
    for sentence in curve_warnings:
        warn(sentence)
    return Fit(
        estimates=model.values(x),
        standard_errors={n: float(s) for n, s in zip(model.names, spread * rates, strict=True)},
        covariance=covariance,
        correlation=best.correlation,
        intervals=intervals,
        reasons=reasons(model, best, ends, minima)
        | dict.fromkeys(model.free if examination.warnings else (), UNFIT),
        sensitivity=examination.sensitivity,
        residuals=[residuals[rows] for rows in model.slices],
        loads=[load[rows] for rows in model.slices],
        approaches=[approach[rows] for rows in model.slices],
        chi2=best.chi2,
        dof=model.dof,
        sigma=sigma,
        is_sigma_known=model.is_known,
        noise=model.noise,
        floor=model.floor,
        condition=best.condition,
        is_profiled=profile,
        free=tuple(model.free),
        curves=model.curves,
        body=system.body,
        tip=system.tip,
        counterbody=system.counterbody,
        adhesion=system.adhesion,
        evaluations=model.evaluations,
        warnings=(*examination.warnings, *curve_warnings),
    )


def _value(value: Callable[[float], float], end: float) -> float:
    """Return the value at an end, which may be open."""
    try:
        return value(end)
    except OverflowError:
        return math.inf
