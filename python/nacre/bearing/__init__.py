"""Bearings: from their contacts to load, stiffness, edge pressure and life.

A bearing is described by what a catalogue or a drawing says of it. `CylindricalRoller.solve` and
its like find loads, tilts and pressures of all elements under forces, displacements, moments and
tilts of the inner ring, with contacts that nacre solves or those of ISO/TS 16281. A `Pair` has two
of them on one shaft.
"""

from nacre.bearing.balls import AngularContactBall, DeepGrooveBall
from nacre.bearing.film import Film, film_thickness
from nacre.bearing.iso import edge_factors, load_integrals, rating
from nacre.bearing.life import (
    IoannidesHarris,
    LifeRatio,
    LundbergPalmgren,
    StressVolume,
    Zaretsky,
    life_ratio,
    stress_volume,
)
from nacre.bearing.pair import Pair, PairLife, PairSolution
from nacre.bearing.rollers import CylindricalRoller, SphericalRoller, TaperedRoller
from nacre.bearing.solution import BearingLife, BearingReport, BearingSolution

__all__ = [
    "AngularContactBall",
    "BearingLife",
    "BearingReport",
    "BearingSolution",
    "CylindricalRoller",
    "DeepGrooveBall",
    "Film",
    "IoannidesHarris",
    "LifeRatio",
    "LundbergPalmgren",
    "Pair",
    "PairLife",
    "PairSolution",
    "SphericalRoller",
    "StressVolume",
    "TaperedRoller",
    "Zaretsky",
    "edge_factors",
    "film_thickness",
    "life_ratio",
    "load_integrals",
    "rating",
    "stress_volume",
]
