"""Printed forms of contacts with friction: a line, a table; in a notebook as HTML."""

from __future__ import annotations

import html
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from nacre import values
from nacre._display import numbers as normal_numbers
from nacre.units import energy, printable, symbol, written

if TYPE_CHECKING:
    from nacre._friction_result import FrictionSolution

NOISE = 1e-8
"""Share of a vector below which a component is printed as 0."""


def has_friction(solution: object) -> bool:
    """Return whether this is a contact with friction."""
    return type(solution) is values.RESULTS.get("FrictionSolution")


def checked(solutions: object) -> list[FrictionSolution]:
    """Return solutions as a list, with one of them at least, and all of one kind.

    Raises
    ------
    TypeError
        If they are no sequence of FrictionSolution.
    ValueError
        If there is none, or some slide and some roll, or some are line contacts.
    """
    found: list[Any] = list(solutions) if isinstance(solutions, Iterable) else [None]
    if not all(map(has_friction, found)):
        raise TypeError(f"solutions must be a sequence of FrictionSolution, got {solutions!r}")
    if not found:
        raise ValueError("solutions must hold at least one solution, got none")
    if len({(s.shift is None, s.grid.is_line) for s in found}) > 1:
        raise ValueError(
            "solutions must all slide or all roll, in line contact or not, got some of each"
        )
    return found


def numbers(solution: FrictionSolution) -> list[tuple[str, str]]:
    """Return names and values of the main numbers, with units."""
    line = solution.grid.is_line
    force = "N/m" if line else "N"
    report = solution.report
    rows = [("force", _pair(solution.force, force))]
    if not line:
        arm = max(solution.grid.size)
        noise = NOISE * arm * max(abs(part) for part in solution.force)
        torque = solution.torque if abs(solution.torque) > noise else 0.0
        rows.append(("torque", written(torque, "N m")))
    if solution.shift is not None:
        rows.append(("shift", _pair(solution.shift, "m")))
        if not line:
            rows.append(("twist", f"{solution.twist:.4g} rad"))
    else:
        xi, eta = solution.creepage or (0.0, 0.0)
        rows.append(("creepage", f"({xi:.4g}, {eta:.4g})"))
        rows.append(("spin", f"{solution.spin:.4g} /{symbol('m')}"))
        rows.append(("rolls", f"towards {solution.direction}"))
    touching = int((solution.pressure > 0).sum())
    sticking = int(solution.stick.sum())
    state = "all slips" if report.full_slip else f"{sticking} of {touching} cells stick"
    rows.append(("friction", state if touching else "nothing touches"))
    # Power over speed in rolling, and rounding where nothing slips.
    work = max(map(abs, solution.force)) * max(map(abs, solution.shift or (1.0,)))
    dissipated = solution.dissipated if solution.dissipated > NOISE * work else 0.0
    rows.append(("dissipated", written(dissipated, energy(line, solution.shift is None))))
    coupled = f", {report.sweeps} sweeps" if report.coupled else ""
    rows.append(
        (
            "ended",
            f"{report.termination}, violation {report.violation:.0e}, "
            f"imbalance {report.imbalance:.0e}{coupled}",
        )
    )
    return rows


def shown(values: tuple[float, float]) -> list[float]:
    """Return two components; one that is rounding beside the other is 0."""
    largest = max(abs(value) for value in values)
    return [value if abs(value) > NOISE * largest else 0.0 for value in values]


def _pair(values: tuple[float, float], unit: str) -> str:
    first, second = shown(values)
    return f"({written(first, unit)}, {written(second, unit)})"


def line(solution: FrictionSolution) -> str:
    """Return the line that ``repr(solution)`` shows."""
    nx, ny = solution.grid.shape
    unit = "N/m" if solution.grid.is_line else "N"
    shift, creepage = solution.shift, solution.creepage
    motion = (
        f"shift {_pair(shift, 'm')}"
        if shift is not None
        else f"creepage ({(creepage or (0.0, 0.0))[0]:.4g}, {(creepage or (0.0, 0.0))[1]:.4g})"
    )
    return printable(
        f"<FrictionSolution on {nx} x {ny} cells: force {_pair(solution.force, unit)}, "
        f"{motion}, {'converged' if solution.report.converged else 'not converged'}>"
    )


def text(solution: FrictionSolution) -> str:
    """Return the table that ``print(solution)`` shows."""
    rows = _rows(solution)
    width = max(len(name) for name, _ in rows)
    lines = [f"{name:{width}}  {value}" for name, value in rows]
    lines += [f"warning: {warning}" for warning in solution.normal.report.warnings]
    return printable("\n".join(lines))


def _rows(solution: FrictionSolution) -> list[tuple[str, str]]:
    """Return the numbers of the normal contact, and those of friction."""
    normal = [row for row in normal_numbers(solution.normal) if row[0] != "ended"]
    return [*normal, *numbers(solution)]


def markup(solution: FrictionSolution) -> str:
    """Return the HTML that a notebook shows."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
        f"<td>{html.escape(value)}</td></tr>"
        for name, value in _rows(solution)
    )
    warnings = "".join(
        f"<p>warning: {html.escape(warning)}</p>" for warning in solution.normal.report.warnings
    )
    return f"<table>{rows}</table>{warnings}"
