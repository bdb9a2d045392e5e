"""Classes that a program names in annotations alone: nacre makes their instances."""

from nacre._core import (
    Direction,
    FrictionReport,
    FrictionSolution,
    Gradient,
    Report,
    Shape,
)
from nacre.friction import CreepCoefficients
from nacre.stresses import InterfaceStress, LayerStress, Stress, StressPlan, StressSummary

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
