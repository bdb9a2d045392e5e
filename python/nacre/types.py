"""Classes that a program names in annotations alone: nacre makes their instances."""

from nacre._core import (
    Direction,
    Gradient,
    InterfaceStress,
    LayerStress,
    Report,
    Shape,
    Stress,
    StressPlan,
    StressSummary,
)
from nacre._friction_result import FrictionReport, FrictionSolution
from nacre.friction import CreepCoefficients

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
