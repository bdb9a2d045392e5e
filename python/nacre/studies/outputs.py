"""Outputs of a study: the numbers that it keeps of each solution."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from nacre.results.quantities import AXIS, ERROR, Quantity
from nacre.results.values import result_class

if TYPE_CHECKING:
    from nacre.bearing.solution import BearingSolution
    from nacre.contact.friction import FrictionSolution
    from nacre.contact.solution import Solution
    from nacre.contact.stresses import StressSummary
    from nacre.contact.wear_solution import WearHistory
    from nacre.fatigue.summary import FatigueSummary
    from nacre.indent.solution import IndentSolution

Output = str | Callable[[Any], object]
CaseKind = Literal["contact", "wear", "indent", "bearing"]
"""What a study solves."""

OUTPUTS = (
    "load",
    "approach",
    "tilt",
    "eccentricity",
    "peak_pressure",
    "peak_position",
    "contact_area",
)
"""Outputs of a contact by default."""
INDENTED = ("load", "approach", "radius", "stiffness", "central_pressure")
"""Outputs of an indentation by default."""
OF_RINGS = ("displacement", "tilt", "largest_load", "peak_pressure", "edge_pressure")
"""Outputs of a bearing by default; its life is asked for, as it is a model."""
OF_HISTORIES = ("life", "worn_volume", "deepest", "peak_pressure", "contact_area")
"""Outputs of wear by default."""
USUAL: dict[CaseKind, tuple[str, ...]] = {
    "contact": OUTPUTS,
    "wear": OF_HISTORIES,
    "indent": INDENTED,
    "bearing": OF_RINGS,
}
"""Outputs by default."""

WORDS: dict[CaseKind, str] = {
    "wear": "a history of wear",
    "indent": "an indentation",
    "bearing": "a bearing",
}
"""What is no single contact."""
CLASSES: dict[CaseKind, str] = {
    "contact": "Solution",
    "wear": "WearHistory",
    "indent": "IndentSolution",
    "bearing": "BearingSolution",
}
"""Classes of results."""

TEXTS = ("error", "warnings", "verdict")
"""Variables of a study that are texts."""

Estimated = tuple[float, float]
"""A number, and its error due to the size of the cells, estimated; NaN where it is not known."""


def _extremes(regions: Iterable[Any], name: str) -> list[Estimated]:
    """Return an extreme of each layer or interface, with its error."""
    return [(getattr(region, name)[0], region.uncertainty.get(name, np.nan)) for region in regions]


STRESSES: dict[str, Callable[[StressSummary], list[Estimated]]] = {
    "von_mises": lambda summary: _extremes(summary.layers, "von_mises"),
    "tension": lambda summary: _extremes(summary.layers, "tension"),
    "max_shear": lambda summary: _extremes(summary.layers, "max_shear"),
    "coating_tension": lambda summary: _extremes(
        (layer for layer in summary.layers if np.isfinite(layer.depths[1])), "tension"
    ),
    "interface_shear": lambda summary: _extremes(summary.interfaces, "shear"),
    "interface_tension": lambda summary: _extremes(summary.interfaces, "tension"),
}
"""Outputs from `Solution.stress_summary`: each is the largest of these values, or NaN."""

FATIGUES: dict[str, Callable[[FatigueSummary], list[Estimated]]] = {
    "shakedown": lambda summary: _extremes(summary.layers, "shakedown"),
    "substrate_shakedown": lambda summary: _extremes(
        (layer for layer in summary.layers if layer.is_substrate), "shakedown"
    ),
    "orthogonal_shear": lambda summary: _extremes(summary.layers, "orthogonal_shear"),
    "interface_shear_range": lambda summary: [
        (face.shear_range, np.nan) for face in summary.interfaces
    ],
}
"""Outputs from `nacre.fatigue.assess`: each is the largest of these values, or NaN."""
MARGINS: dict[str, Callable[[FatigueSummary], list[float]]] = {
    "shakedown_safety_factor": lambda summary: _factors(summary, ["shakedown"]),
    "first_yield_safety_factor": lambda summary: _factors(summary, ["first_yield"]),
    "fatigue_safety_factor": lambda summary: _factors(
        summary, [type(criterion).__name__ for criterion in summary.criteria]
    ),
}
"""Outputs from `nacre.fatigue.assess`: each is the smallest of these values, or NaN."""
CONDUCTANCES = ("resistance", "conductance")
"""Outputs from `Solution.conductance`, of contacts and of the end of wear."""

ESTIMATED = ("peak_pressure", "approach", "load", "contact_area")
"""Outputs whose errors due to the size of the cells are estimated."""
ESTIMATED_OF_RINGS = ("peak_pressure", "edge_pressure")
"""The same of a bearing."""
ESTIMATED_OF_WEAR = ("life", *CONDUCTANCES)
"""Outputs of wear whose errors are estimated: due to the length of the steps, or to the cells."""
OF_SLIDING = ("force", "torque", "shift", "twist", "creepage", "dissipated", "stick_share")
"""The same of sliding and of steady rolling; those of pairs are of their lengths."""
OF_CONTACTS = (*ESTIMATED, *OF_SLIDING, *STRESSES, *FATIGUES, *CONDUCTANCES)
"""The same of contacts."""
NO_PART: Estimated = (np.nan, np.nan)
"""Extreme of a body that has no such part."""


def rows_of(kind: CaseKind) -> dict[str, Quantity]:
    """Return the quantities of a kind of result by their names."""
    rows = result_class(CLASSES[kind])._QUANTITIES
    return {row.name: row for row in rows if kind != "wear" or row.name != "volume"}


def _of_friction() -> dict[str, Quantity]:
    """Return the numbers that a contact with friction has beside those of its normal contact."""
    rows = result_class("FrictionSolution")._QUANTITIES
    own = (row for row in rows if not row.path.startswith("normal."))
    return {row.name: row for row in own if row.dims in ((), AXIS)}


def axes(kind: CaseKind) -> set[str]:
    """Return the outputs with a value along x and one along y."""
    rows = rows_of(kind) | (_of_friction() if kind == "contact" else {})
    return {name for name, row in rows.items() if row.dims == AXIS}


def _names(kind: CaseKind) -> set[str]:
    """Return the names of all outputs of a kind of result."""
    others = (_of_friction(), STRESSES, FATIGUES, MARGINS) if kind == "contact" else ()
    conducts = CONDUCTANCES if kind in ("contact", "wear") else ()
    return set(rows_of(kind)).union(conducts, *others)


def _choices(kind: CaseKind) -> str:
    """Return the outputs of a kind of result in words."""
    if kind == "contact":
        return (
            "attributes of Solution that hold numbers "
            f"({', '.join(sorted(rows_of(kind)))}), or of FrictionSolution "
            f"({', '.join(_of_friction())}), stresses ({', '.join(STRESSES)}), "
            f"fatigue ({', '.join((*FATIGUES, *MARGINS))}), {', '.join(CONDUCTANCES)}"
        )
    owner = "numbers of a history of wear"
    if kind != "wear":
        owner = f"attributes of {result_class(CLASSES[kind]).__module__.rpartition('.')[0]}."
        owner += f"{CLASSES[kind]} that hold numbers"
    names = [*rows_of(kind), *(CONDUCTANCES if kind == "wear" else ())]
    return f"{owner} ({', '.join(names)})"


def _factors(summary: FatigueSummary, names: list[str]) -> list[float]:
    """Return the safety factors of all layers that have these names."""
    by_layer = (layer.safety_factors for layer in summary.layers)
    return [factors[name] for factors in by_layer for name in names if name in factors]


def outputs_by_name(
    outputs: Sequence[Output] | Mapping[str, Output], kind: CaseKind | None = None
) -> dict[str, Output]:
    """Return outputs by name, checked: those of what a study solves, or of any."""
    if isinstance(outputs, str) or not isinstance(outputs, Mapping | Iterable):
        raise TypeError(f"outputs must be a sequence or a mapping, got {outputs!r}")
    if isinstance(outputs, Mapping):
        items = [(str(name), output) for name, output in outputs.items()]
    else:
        items = [(o if isinstance(o, str) else getattr(o, "__name__", repr(o)), o) for o in outputs]
    kinds: list[CaseKind] = ["indent", "contact", "wear", "bearing"] if kind is None else [kind]
    for name, output in items:
        if not (any(output in _names(kind) for kind in kinds) or callable(output)):
            all_choices = ", ".join(map(_choices, kinds))
            raise ValueError(f"outputs must be {all_choices}, or functions, got {output!r}")
        if name in TEXTS:
            raise ValueError(f"outputs must have other names than {', '.join(TEXTS)}, got {name!r}")
    by_name = dict(items)
    if not by_name or len(by_name) != len(items):
        names = [name for name, _ in items]
        raise ValueError(f"outputs must be at least one, under different names, got {names}")
    return by_name


def plain(
    solution: WearHistory | IndentSolution | BearingSolution,
    outputs: Mapping[str, Output],
    kind: CaseKind,
) -> dict[str, object]:
    """Return the outputs of wear, of an indentation or of a bearing as plain numbers."""
    own, words = rows_of(kind), WORDS[kind]
    number: Callable[[Any, str], Any] = wear_number if kind == "wear" else getattr
    numbers: dict[str, object] = {}
    for name, output in outputs.items():
        if kind == "wear" and output in CONDUCTANCES:
            continue  # `with_conductance` adds it
        if isinstance(output, str) and output not in own:
            raise ValueError(f"the output {output} is not one of {words}")
        value = number(solution, output) if isinstance(output, str) else output(solution)
        numbers[name] = np.asarray(value, dtype=np.float64).tolist()
    if kind == "wear":
        history: Any = solution
        for name in errors(outputs, outputs, ("life",)):
            error = history.life and history.life.uncertainty
            numbers[name] = np.nan if error is None else float(error)
    if kind == "bearing":
        report: Any = solution.report
        estimates = report.discretisation or {}
        for name, quantity in errors(outputs, outputs, ESTIMATED_OF_RINGS).items():
            estimate = estimates.get(quantity)
            numbers[name] = np.nan if estimate is None else float(estimate)
    return numbers


def wear_number(history: WearHistory, name: str) -> float:
    """Return a number of the end of a history of wear; its life is NaN if no layer is through."""
    if name == "life":
        return math.nan if history.life is None else history.life.distance
    return history.worn_volume if name == "worn_volume" else getattr(history, name)[-1].max()


def with_conductance(
    values: dict[str, object],
    solution: Solution,
    outputs: Mapping[str, Output],
    keywords: Mapping[str, Any],
) -> tuple[dict[str, object], dict[str, object]]:
    """Return the outputs with resistance and conductance where they are asked for, and units."""
    names = {name: output for name, output in outputs.items() if output in CONDUCTANCES}
    if not names:
        return values, {}
    conductance = solution.conductance(**keywords)
    share = conductance.uncertainty / conductance.resistance
    added = {name: getattr(conductance, str(output)) for name, output in names.items()}
    added |= {name + ERROR: share * value for name, value in added.items()}
    kept = {name: value for name, value in added.items() if name not in outputs or name in names}
    return values | kept, {"units": conductance._si_units()}


def errors(
    outputs: Mapping[str, Output], taken: Iterable[str], estimated: Sequence[str] = ESTIMATED
) -> dict[str, str]:
    """Return the names of the errors of outputs, each with the quantity that has this error."""
    return {
        name + ERROR: output
        for name, output in outputs.items()
        if isinstance(output, str) and output in estimated and name + ERROR not in taken
    }


def output_values(
    solution: Solution | FrictionSolution,
    outputs: Mapping[str, Output],
    stress: Mapping[str, Any],
    summaries: list[Any],
    assess: Callable[[], FatigueSummary],
) -> dict[str, object]:
    """Return the outputs of a solution as plain numbers; stresses and fatigue are summed up once.

    The errors of outputs are among them; they are NaN where there is no estimate. The summaries of
    stresses and fatigue are added to `summaries`.
    """
    summary = fatigue = None
    numbers: dict[str, object] = {}
    extreme_errors: dict[str, float | None] = {}
    for name, output in outputs.items():
        if not isinstance(output, str):
            value = output(solution)
        elif output in CONDUCTANCES:
            continue  # `with_conductance` adds it
        elif output in STRESSES:
            if summary is None:
                summary = solution.stress_summary(**stress)
                summaries.append(summary)
            value, extreme_errors[output] = max(STRESSES[output](summary), default=NO_PART)
        elif output in FATIGUES or output in MARGINS:
            if fatigue is None:
                fatigue = assess()
                summaries.append(fatigue)
            if output in FATIGUES:
                value, extreme_errors[output] = max(FATIGUES[output](fatigue), default=NO_PART)
            else:
                value = min(MARGINS[output](fatigue), default=np.nan)
        else:
            value = _attribute(solution, output)
        numbers[name] = np.asarray(value, dtype=np.float64).tolist()
    estimates = solution._normal.report.discretisation or {}
    tangential = (solution is not solution._normal and solution.report.discretisation) or {}
    estimates = tangential | estimates | extreme_errors
    for name, quantity in errors(outputs, outputs, OF_CONTACTS).items():
        estimate = estimates.get(quantity)
        numbers[name] = np.nan if estimate is None else float(estimate)
    return numbers


def _attribute(solution: Any, name: str) -> object:
    """Return an attribute of a solution, or of the normal contact of one with friction."""
    numbers, of_friction = rows_of("contact"), _of_friction()
    if name not in numbers and name in rows_of("indent"):
        raise ValueError(f"the output {name} needs an indentation, a case with a tip")
    if name not in numbers | of_friction and name in rows_of("bearing"):
        raise ValueError(f"the output {name} needs a bearing in the case")
    normal = getattr(solution, "normal", None)
    if normal is None:
        if name in of_friction and name not in numbers:
            raise ValueError(f"the output {name} needs friction in the case")
        return getattr(solution, name)
    if name not in of_friction:
        return getattr(normal, name)
    value = of_friction[name].of(solution)
    if value is None:
        raise ValueError(
            f"the output {name} is not one of {'rolling' if rolls(solution) else 'sliding'}"
        )
    return value


def rolls(solution: FrictionSolution) -> bool:
    """Return whether a solution is one of rolling."""
    return solution.shift is None


def check_direction(
    arguments: Mapping[str, object], friction: float = 0.0, direction: object = None, **_: object
) -> None:
    """Raise a `ValueError` before a solve whose stresses need a direction of friction."""
    grid, shape = arguments.get("grid"), arguments.get("shape")
    rolls = getattr(grid, "is_line", False) or getattr(shape, "rolling_direction", None)
    if friction > 0 and direction is None and not (rolls or _is_round(arguments)):
        raise ValueError(
            "direction must be given where friction is above 0: only rollers, cylinders and line "
            "contacts, and bodies of revolution that are pressed on their axis, have one to take "
            "instead; (1, 0) is along x"
        )


def _is_round(arguments: Mapping[str, object]) -> bool:
    """Return whether a body of revolution is pressed on its axis."""
    rotations: Any = [arguments.get(name) or () for name in ("eccentricity", "moment", "tilt")]
    is_centred = not any(value for pair in rotations for value in pair)
    return is_centred and getattr(arguments.get("shape"), "is_round", False)
