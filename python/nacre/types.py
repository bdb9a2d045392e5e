"""Classes that a program names in annotations alone: nacre makes their instances."""

from nacre._core import Shape
from nacre._friction_result import FrictionReport, FrictionSolution
from nacre.friction import CreepCoefficients
from nacre.gradient import Direction, Gradient
from nacre.solution import Report
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
