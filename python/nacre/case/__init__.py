"""Case files: a contact, an indentation or a bearing, and a study of it, in TOML.

There is a table for each argument of `nacre.solve`, and for `Solution.stress_summary`,
`nacre.fatigue.assess`, `nacre.slide`, `nacre.roll` and `nacre.wear`; a file with the tables ``tip``
and ``indent`` is an indentation instead, for `nacre.indent.solve`, and one with the table
``bearing`` is a bearing of `nacre.bearing`.
Materials have names. ``nacre schema`` prints the reference of all tables and keys::

    units = "SI"  # or "N-mm-MPa" and others, of all numbers below; SI may be left out

    [materials]
    steel = { young = 210e9, poisson = 0.3, yield_stress = 1.5e9 }  # for safety factors
    dlc = { young = 420e9, poisson = 0.3, strength = 2e9 }

    [shape]
    kind = "roller"
    radius = 5e-3
    flat_length = 19.13e-3
    crown_radius = 7.5
    length = 30e-3

    [body]
    substrate = "steel"
    layers = [{ material = "dlc", thickness = 40e-6 }]

    [solve]
    load = 1e3
    eccentricity = { x = 2.87e-3 }  # free to tilt along x only

    [stress]  # may be left out, or empty
    friction = 0.1

    [fatigue]  # may be left out, or empty; shear_yield of materials is its limit
    criteria = [{ kind = "dang_van", bending = 520e6, torsion = 330e6 }]

    [sweep]  # for nacre sweep
    store = "study.nc"
    parameters."materials.dlc.young" = [105e9, 210e9, 420e9]
    parameters."solve.load" = { first = 100, last = 1000, count = 10, scale = "log" }
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from nacre.case.file import Case, CaseError

__all__ = ["Case", "CaseError"]
__dir__ = __all__.copy


def _imported(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module 'nacre.case' has no attribute {name!r}")
    from nacre.case import file  # when it is used: commands of all kinds are in this package

    return getattr(file, name)


if not TYPE_CHECKING:  # a type checker would take any name
    __getattr__ = _imported
