"""Bearings: from their contacts to load, stiffness, edge pressure and life.

A bearing is described by what a catalogue or a drawing says of it. `CylindricalRoller.solve` and
its like find loads, tilts and pressures of all elements under forces, displacements, moments and
tilts of the inner ring, with contacts that nacre solves or those of ISO/TS 16281. A `Pair` has two
of them on one shaft.
"""

from typing import TYPE_CHECKING

from nacre._tools.renamed import warn_of
from nacre.bearing.balls import AngularContactBall, DeepGrooveBall
from nacre.bearing.basic import basic_life, equivalent_dynamic_load, mean_dynamic_load
from nacre.bearing.catalogue import CatalogueCheck, compare_ratings, estimated_balls
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
from nacre.bearing.modified import (
    contamination_range,
    fatigue_load_limit,
    life_modification_factor,
    reference_viscosity,
    reliability_factor,
    simple_fatigue_load_limit,
)
from nacre.bearing.oil import oil_viscosity
from nacre.bearing.pair import Pair, PairLife, PairSolution
from nacre.bearing.rating_life import BearingLife
from nacre.bearing.rollers import CylindricalRoller, SphericalRoller, TaperedRoller
from nacre.bearing.solution import BearingReport, BearingSolution
from nacre.bearing.static import StaticLoad, equivalent_static_load, static_rating

__all__ = [
    "AngularContactBall",
    "BearingLife",
    "BearingReport",
    "BearingSolution",
    "CatalogueCheck",
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
    "StaticLoad",
    "StressVolume",
    "TaperedRoller",
    "Zaretsky",
    "basic_life",
    "compare_ratings",
    "contamination_range",
    "edge_factors",
    "equivalent_dynamic_load",
    "equivalent_static_load",
    "estimated_balls",
    "fatigue_load_limit",
    "film_thickness",
    "life_modification_factor",
    "life_ratio",
    "load_integrals",
    "mean_dynamic_load",
    "oil_viscosity",
    "rating",
    "reference_viscosity",
    "reliability_factor",
    "simple_fatigue_load_limit",
    "static_rating",
    "stress_volume",
]
__dir__ = __all__.copy


def _old(name: str) -> object:
    if name == "check":
        warn_of("nacre.bearing.check", "nacre.bearing.compare_ratings")
        return compare_ratings
    raise AttributeError(f"module 'nacre.bearing' has no attribute {name!r}")


if not TYPE_CHECKING:  # a type checker would take any name
    __getattr__ = _old
