"""What is plausible of numbers of contacts: what lies beyond is warned of, with both numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

import nacre._core as core
from nacre._tools.units import are_declared, system, written
from nacre.results.verdict import SINGULAR

if TYPE_CHECKING:
    from nacre.contact.friction import FrictionSolution
    from nacre.contact.solution import Report, Solution

MOST = {
    "share of the modulus": (0.08, "diamond has a hardness of 0.08 of it; only rubber has more"),
    "widths of the contact": (1000.0, "what is below moves less than a thousandth of the layer"),
    "friction": (3.0, "clean metals in vacuum and soft rubber reach 1 to 3"),
    "creepage": (0.05, "wheels and rollers slide as a whole from 1 % on, and nobody steers 5 %"),
}
"""Largest plausible numbers, and why."""
STICKS = 1000.0
"""Coefficient of friction from which on nothing slips, which is what it is given for."""
MODULI = (1e3, 1.2e12)
"""Smallest and largest Young's modulus [Pa]: soft gels have 1 kPa, diamond has 1.2 TPa."""
INSTEAD = {*SINGULAR, "large contact", "coarse", "coarse spots"}
"""Warnings that say of a pressure that it is too large, or not known."""

Doubts = Iterator[tuple[str, str]]
"""Kinds and texts of warnings."""


def of_contact(solution: Solution, report: Report) -> Doubts:
    """Yield what is not plausible of pressure, layers and moduli; moduli where units are known."""
    bodies = [b for b in (report.body, report.counterbody) if isinstance(b, core.HalfSpace)]
    if solution.contact_area == 0 or not bodies:
        return
    bases = [body.substrate for body in bodies if isinstance(body.substrate, core.Elastic)]
    compliance = sum(1 / base.plane_strain_modulus for base in bases)
    share = solution.peak_pressure * compliance
    # Peaks of rough surfaces, which repeat, are those of the model, whatever the units are.
    if share > MOST["share of the modulus"][0] and not any(report.grid.periodic):
        if INSTEAD.isdisjoint(report.warning_kinds):
            peak, modulus = (written(n, "Pa") for n in (solution.peak_pressure, 1 / compliance))
            yield (
                "high pressure",
                f"the peak pressure, {peak}, is {share:.2g} of the contact modulus, {modulus}: "
                "above 0.08 only rubber is elastic; are lengths and forces in the units of moduli?",
            )
    layers = [layer for body in bodies for layer in body.layers]
    thickest = max((layer.thickness for layer in layers), default=0.0)
    width = float(np.nanmax(np.ptp(solution.contact_extent, axis=1), initial=0.0))
    if 0 < MOST["widths of the contact"][0] * width < thickest:
        yield (
            "thick layer",
            f"a layer is {written(thickest, 'm')} thick, and the contact {written(width, 'm')} "
            "wide: what lies below does not count; is the thickness in the unit of the radii?",
        )
    size, unit = system().unit("Pa")
    low, high = MODULI
    for material in [*bases, *(layer.material for layer in layers)] if are_declared() else []:
        if not low <= material.young * size <= high:
            yield (
                "odd modulus",
                f"Young's modulus is {written(material.young, 'Pa')}, and materials have 1 kPa to "
                f"1200 GPa: is it in {unit}?",
            )
            return


def of_friction(solution: FrictionSolution) -> Doubts:
    """Yield what is not plausible of friction and creepage."""
    yield from of_coefficient(solution.friction)
    largest = max(map(abs, solution.creepage or (0.0,)))
    is_large = "large motion" in solution.normal.report.warning_kinds
    if largest > MOST["creepage"][0] and not is_large:
        yield (
            "large creepage",
            f"the creepage is {largest:.3g}, and wheels reach 0.05 at most: is it in per cent?",
        )


def of_coefficient(friction: Any) -> Doubts:
    """Yield what is not plausible of coefficients of friction."""
    largest = 0.0 if friction is None else float(np.max(friction, initial=0.0))
    if MOST["friction"][0] < largest < STICKS:
        yield (
            "high friction",
            f"the coefficient of friction is {largest:.3g}, and materials reach 3 at most: is it "
            "in per cent?",
        )
