"""Classes that a program names in annotations alone: nacre makes their instances."""

from nacre._core import (
    CreepCoefficients,
    Direction,
    FrictionReport,
    FrictionSolution,
    Gradient,
    InterfaceStress,
    LayerStress,
    Report,
    Shape,
    Stress,
    StressPlan,
    StressSummary,
)

__all__ = [
    "CreepCoefficients",
    "Direction",
    "FrictionReport",
    "FrictionSolution",
    "Gradient",
    "InterfaceStress",
    "LayerStress",
    "Report",
    "Shape",
    "Stress",
    "StressPlan",
    "StressSummary",
]
