"""Verdict on a fit: how well the curves tell each parameter, with the sources of its error."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import nacre._core as core
from nacre.indent._model import unit_of
from nacre.indent._reading import UNASKED, tolerated
from nacre.results import display
from nacre.results.verdict import Demand, Verdict, judged, number, reasons, with_error

if TYPE_CHECKING:
    from nacre.indent._result import Fit

UNFIT = "the model does not fit the data"
"""Reason why no parameter is identifiable where the residuals are no noise."""
TOLD = 0.1
"""Share of the whole error from which a source of it is named."""
MOST_SOURCES = 4
"""Most sources that are named, the largest first."""
UNKNOWN_SLOPES = "the effect of errors of the fixed numbers is not known"
WORDS = {"young": "modulus", "poisson": "Poisson's ratio"}
"""Words for parameters that paths name otherwise."""


def fit_verdict(fit: Fit, tolerance: float | None = None) -> Verdict:
    """Return the verdict on a fit: the least certain parameter decides."""
    owners, sources = dict(_owners(fit)), fit.error_sources
    totals = {name: math.hypot(*by_source.values()) for name, by_source in sources.items()}
    demands = [
        Demand(
            *_words(name, owners),
            *_share(fit, name, sources[name]["noise"], total),
            limit=tolerance,
            unit="",
            sentence=_sentence(fit, name, sources[name], owners, tolerance),
            leads=True,
        )
        for name, total in totals.items()
    ]
    demands.sort(key=lambda demand: -demand.value)
    is_known = not any(map(math.isnan, totals.values()))
    held = dict.fromkeys(path for by_source in sources.values() for path in by_source)
    assumed = [path for path in held if path != "noise" and path not in fit.known]
    has_exact_ratios = any(
        path.endswith(".poisson") and path not in fit.known
        for slopes in fit.sensitivity.values()
        for path in slopes
    )
    return judged(
        demands,
        doubts=(*reasons(fit.warnings, "unknown"), *(() if is_known else (UNKNOWN_SLOPES,))),
        cautions=reasons(fit.warnings, "fair"),
        notes=[_assumption([" ".join(_words(path, owners)) for path in assumed], has_exact_ratios)],
        unasked=UNASKED if tolerance is None else None,
        question=None if tolerance is None else f"parameters{tolerated(tolerance)}",
    )


def _share(fit: Fit, name: str, noise: float, total: float) -> tuple[float, float | None]:
    """Return the error of a parameter as a share of it, and the error of that.

    It is infinite where the curves do not tell the parameter.
    """
    size = abs(fit.estimates[name])
    if fit.reasons.get(name, UNFIT) != UNFIT or not size or total == math.inf:
        return math.inf, 0.0
    if math.isnan(total):
        return noise / size, None
    # A standard deviation of noise that is estimated is itself known to a part 1/√(2 dof).
    scatter = (
        0.0
        if fit.is_sigma_known or not total
        else noise**2 / total / math.sqrt(2 * max(fit.dof, 1))
    )
    return total / size, scatter / size


def _sentence(
    fit: Fit,
    name: str,
    by_source: dict[str, float],
    owners: dict[str, str],
    tolerance: float | None,
) -> str:
    """Return a parameter with its error and the sources of that, or why the curves do not tell."""
    estimate, total = fit.estimates[name], math.hypot(*by_source.values())
    words = " ".join(_words(name, owners)).rstrip()
    start = f"{words[0].upper()}{words[1:]} {number(estimate, unit_of(name))}"
    if (reason := fit.reasons.get(name)) is not None:
        for path in fit.free:
            reason = reason.replace(path, f"the {' '.join(_words(path, owners))}")
        return f"{start}, not identified: {reason}."
    ranked = sorted(by_source, key=lambda path: -by_source[path])
    largest = [path for path in ranked[:MOST_SOURCES] if by_source[path] >= TOLD * total]
    texts = []
    for path in dict.fromkeys(("noise", *largest)):
        of = " ".join(_words(path, owners))
        what = path if path == "noise" else f"{of} ± {fit._held_share(path)}:"
        texts.append(f"{what} {display.share(by_source[path], estimate) or '0 %'}")
    error = with_error(estimate, total) if total < math.inf else ""
    return f"{start}{error} ({', '.join(texts)}){tolerated(tolerance)}."


def _assumption(assumed: list[str], has_exact_ratios: bool) -> str:
    """Return the sentence on what is assumed of numbers that are held."""
    ratios = ", such as Poisson's ratios," if has_exact_ratios else ""
    exact = f"hat else is held{ratios} counts as exact."
    if not assumed:
        return f"W{exact}"
    *some, last = (f"the {words}" for words in assumed)
    names = f"{', '.join(some)} and {last}" if some else last
    if len(assumed) > MOST_SOURCES:
        names = "each modulus, thickness and number of the tip that is held"
    return f"Errors of 1 % are assumed of {names}: give known errors instead. W{exact}"


def _words(name: str, owners: dict[str, str]) -> tuple[str, str]:
    """Return a parameter in words, and of what it is; those of curves have their own names."""
    place, _, last = name.replace(".material", "").rpartition(".")
    if place not in owners:
        return name, ""
    return WORDS.get(last, last.replace("_", " ")), f"of {owners[place]}"


def _owners(fit: Fit) -> Iterator[tuple[str, str]]:
    """Yield the paths of what has parameters, with words."""
    yield from {"tip": "the tip", "adhesion": "adhesion"}.items()
    for place, body in (("body", fit.body), ("counterbody", fit.counterbody)):
        further = "" if place == "body" else " of the counterbody"
        layers = body.layers if isinstance(body, core.HalfSpace) else ()
        yield f"{place}.substrate", f"the substrate{further}"
        for k, layer in enumerate(layers):
            film = "the film" if len(layers) == 1 and layer.name is None else None
            words = film or display.layer_in_words(k, layer.name, len(layers))
            yield f"{place}.layers[{k}]", words + further
