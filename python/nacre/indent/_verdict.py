"""Verdict on a fit: which parameters the curves tell, and how well."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import nacre._core as core
from nacre.indent._model import unit_of
from nacre.results import display
from nacre.results.verdict import DIGITS, Level, Verdict, number

if TYPE_CHECKING:
    from nacre.indent._result import Fit

FAIR = 0.20
"""Largest standard error of fair estimates, as a share of them; chosen here."""
MOST_DIGITS = 6
"""Largest number of digits of an estimate."""
NOISE = (
    "Errors are those of noise alone: that of a radius of the tip, a thickness or a modulus that "
    "is held fixed comes on top."
)
WORDS = {"young": "modulus", "poisson": "Poisson's ratio"}
"""Words for parameters that paths name otherwise."""


def fit_verdict(fit: Fit) -> Verdict:
    """Return the verdict on a fit: the least certain parameter decides."""
    shares = {name: _share(fit, name) for name in dict.fromkeys((*fit.free, *fit.reasons))}
    if not shares:
        return Verdict("unknown", "No parameter was fitted.")
    worst, *better = sorted(shares, key=lambda name: -shares[name])
    share, owners = shares[worst], dict(_owners(fit))
    # Errors of what is held fixed are in none of the standard errors: no fit is good.
    level: Level = "bad" if share > FAIR else "fair"
    words, *lines = [_sentence(fit, name, owners) for name in (worst, *better)]
    lines.append(NOISE)
    uncertainty = share if math.isfinite(share) else None
    return Verdict(level, words, tuple(lines), None, _words(worst, owners), uncertainty)


def _share(fit: Fit, name: str) -> float:
    """Return the standard error as a share of the estimate, infinite where the data do not tell."""
    estimate, error = fit.estimates[name], fit.standard_errors[name]
    if name in fit.reasons or not estimate or not math.isfinite(error):
        return math.inf
    return error / abs(estimate)


def _sentence(fit: Fit, name: str, owners: dict[str, str]) -> str:
    """Return a parameter with its error, and whether it is identified."""
    unit, estimate, words = unit_of(name), fit.estimates[name], _words(name, owners)
    if (reason := fit.reasons.get(name)) is not None:
        return f"{words} {number(estimate, unit)}, not identified: {reason}."
    return f"{words} {_with_error(estimate, fit.standard_errors[name], unit)}, identified."


def _with_error(value: float, error: float, unit: str) -> str:
    """Return a number of three digits or more, as many as its error tells."""
    scale = display.scale_of(value, unit)
    value, error = scale.factor * value, scale.factor * error
    first = math.floor(math.log10(abs(value))) if 0 < abs(value) < math.inf else 0
    decimals = DIGITS - 1 - first
    if math.isfinite(error) and error > 0:
        decimals = max(decimals, -math.floor(math.log10(error)))
    decimals = max(min(decimals, MOST_DIGITS - 1 - first), 0)
    errors = f" ± {error:.{decimals}f}" if round(error, decimals) else ""
    return f"{value:.{decimals}f}{errors} {scale.unit}".rstrip()


def _words(name: str, owners: dict[str, str]) -> str:
    """Return a parameter in words; those of curves have the names that they are given by."""
    place, _, last = name.replace(".material", "").rpartition(".")
    if place not in owners:
        return name
    return f"{WORDS.get(last, last.replace('_', ' '))} of {owners[place]}"


def _owners(fit: Fit) -> Iterator[tuple[str, str]]:
    """Yield the paths of what has parameters, with words."""
    yield from {"tip": "the tip", "adhesion": "adhesion"}.items()
    for place, body in (("body", fit.body), ("counterbody", fit.counterbody)):
        further = "" if place == "body" else " of the counterbody"
        layers = body.layers if isinstance(body, core.HalfSpace) else ()
        yield f"{place}.substrate", f"the substrate{further}"
        for k, layer in enumerate(layers):
            only = "the film" if len(layers) == 1 else f"layers[{k}]"
            yield f"{place}.layers[{k}]", (f"the {layer.name}" if layer.name else only) + further
