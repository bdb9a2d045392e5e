"""Classes that a program names in annotations alone: nacre makes their instances."""

from nacre._core import Shape
from nacre.cards import Card, Number
from nacre.contact.conductance import Conductance
from nacre.contact.friction import FrictionReport, FrictionSolution, History
from nacre.contact.gradient import Direction, Gradient
from nacre.contact.solution import Report
from nacre.contact.stresses import InterfaceStress, LayerStress, Stress, StressPlan, StressSummary
from nacre.contact.wear_solution import WearHistory, WearReport, WearState, WearThrough
from nacre.fatigue import FatigueSummary, InterfaceFatigue, LayerFatigue, ShakedownMap
from nacre.friction import CreepCoefficients
from nacre.results.verdict import Verdict

__all__ = [
    "Card",
    "Conductance",
    "CreepCoefficients",
    "Direction",
    "FatigueSummary",
    "FrictionReport",
    "FrictionSolution",
    "Gradient",
    "History",
    "InterfaceFatigue",
    "InterfaceStress",
    "LayerFatigue",
    "LayerStress",
    "Number",
    "Report",
    "ShakedownMap",
    "Shape",
    "Stress",
    "StressPlan",
    "StressSummary",
    "Verdict",
    "WearHistory",
    "WearReport",
    "WearState",
    "WearThrough",
]
__dir__ = __all__.copy
