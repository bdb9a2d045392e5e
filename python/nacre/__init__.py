"""Elastic contact of coated bodies.

A shape is pressed into a half-space that carries any number of layers, by a force that may act
off-centre::

    g = h + u(p) - approach - tilt_x x - tilt_y y >= 0,    p >= 0,    p g = 0

Examples
--------
>>> import nacre
>>> steel = nacre.Elastic(young=210e9, poisson=0.3)
>>> dlc = nacre.Elastic(young=420e9, poisson=0.3)
>>> body = nacre.HalfSpace(steel, layers=[nacre.Layer(dlc, thickness=40e-6)])
>>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=100.0)
>>> round(solution.peak_pressure / 1e9, 2)
3.86
"""

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING

from nacre._core import (
    FREE,
    RIGID,
    ConvergenceError,
    Cylinder,
    Elastic,
    FlatPunch,
    Grid,
    HalfSpace,
    HeightMap,
    Layer,
    LogarithmicProfile,
    NacreWarning,
    Paraboloid,
    Response,
    Roller,
    SampledProfile,
    Sphere,
    Spring,
    __version__,
)

if TYPE_CHECKING:
    from nacre import bearing as bearing
    from nacre import case as case
    from nacre import design as design
    from nacre import fatigue as fatigue
    from nacre import friction as friction
    from nacre import hertz as hertz
    from nacre import indent as indent
    from nacre import jax as jax
    from nacre import plot as plot
    from nacre import rough as rough
    from nacre import torch as torch
    from nacre import types as types
    from nacre import verify as verify
    from nacre._tools.units import display_units
    from nacre.cards import materials as materials
    from nacre.contact import Contact, roll, slide, solve, wear
    from nacre.contact.compliance import (
        Convolution,
        frequency_response,
        graded_layers,
        influence_coefficients,
        surface_compliance,
    )
    from nacre.contact.solution import Solution
    from nacre.contact.stresses import stress
    from nacre.friction import creep_coefficients
    from nacre.results.files import load
    from nacre.studies import sweep

__all__ = [
    "FREE",
    "RIGID",
    "Contact",
    "ConvergenceError",
    "Convolution",
    "Cylinder",
    "Elastic",
    "FlatPunch",
    "Grid",
    "HalfSpace",
    "HeightMap",
    "Layer",
    "LogarithmicProfile",
    "NacreWarning",
    "Paraboloid",
    "Response",
    "Roller",
    "SampledProfile",
    "Solution",
    "Sphere",
    "Spring",
    "__version__",
    "creep_coefficients",
    "display_units",
    "frequency_response",
    "graded_layers",
    "influence_coefficients",
    "load",
    "roll",
    "slide",
    "solve",
    "stress",
    "surface_compliance",
    "sweep",
    "wear",
]


_MODULES = (
    *("bearing", "case", "design", "fatigue", "friction", "hertz"),
    *("indent", "jax", "plot", "rough", "torch", "types", "verify"),
)
"""Modules that are imported when they are first used, as `nacre.plot`."""
_HOMES = {
    **dict.fromkeys(("Contact", "roll", "slide", "solve", "wear"), "contact"),
    **dict.fromkeys(("Convolution", "frequency_response", "graded_layers"), "contact.compliance"),
    **dict.fromkeys(("influence_coefficients", "surface_compliance"), "contact.compliance"),
    "Solution": "contact.solution",
    "stress": "contact.stresses",
    "creep_coefficients": "friction",
    "display_units": "_tools.units",
    "load": "results.files",
    "materials": "cards",
    "sweep": "studies",
}
"""Modules of the names that are imported when they are first used."""


class _Reader(staticmethod):  # type: ignore[type-arg]
    """Static method of a compiled class that `nacre.surfaces` has, imported when it is used."""

    def __init__(self, name: str, of: type) -> None:
        super().__init__(_Reader)
        self.name, self.qualname = name, f"{of.__name__}.read"

    def __get__(self, surface: object, owner: type | None = None) -> Callable[..., object]:
        from nacre import surfaces

        read: Callable[..., object] = getattr(surfaces, self.name)
        read.__module__, read.__qualname__ = "nacre", self.qualname  # as errors and pickles name it
        return read


def _markup(surface: HeightMap) -> str:
    from nacre import rough

    return rough.markup(surface)


# Of the compiled classes, whose files are read and whose pictures are drawn in Python.
HeightMap._repr_html_ = _markup  # type: ignore[attr-defined]
HeightMap.read = _Reader("read_map", HeightMap)  # type: ignore[method-assign]
SampledProfile.read = _Reader("read_profile", SampledProfile)  # type: ignore[method-assign]


def _imported(name: str) -> object:
    if name in _MODULES:
        return import_module(f"nacre.{name}")
    if name in _HOMES:
        value = globals()[name] = getattr(import_module(f"nacre.{_HOMES[name]}"), name)
        return value
    if name[:1].isupper():
        from nacre import types

        if name in types.__all__:  # as the docstrings of the compiled module name them
            return getattr(types, name)
    raise AttributeError(f"module 'nacre' has no attribute {name!r}")


if not TYPE_CHECKING:  # a type checker would take any name
    __getattr__ = _imported


def __dir__() -> list[str]:
    return sorted({*__all__, *_MODULES, "materials"})
