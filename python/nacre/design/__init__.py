"""Studies that a designer of coatings and bearings asks for, on top of `nacre.sweep`.

`optimise` and `joint_conductance` have modules of their own. Each other function returns an
`xarray.Dataset`, which `nacre.plot` draws. It passes on the other arguments of a solve, and
`store`, `version`, `executor`, `retry` and `progress` of `nacre.sweep`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.groups import names_itself
from nacre._tools.typing import ByLayer, Direction
from nacre._tools.units import symbol
from nacre.cards import Limits
from nacre.contact.solution import Solution
from nacre.contact.stresses import Bonds
from nacre.design.joint import JointConductance, joint_conductance
from nacre.design.optimise import Optimum, optimise
from nacre.studies import ARGUMENTS, sweep
from nacre.studies.outputs import Output, check_direction

if TYPE_CHECKING:
    import xarray

__all__ = [
    "JointConductance",
    "Optimum",
    "coating_chart",
    "force_table",
    "joint_conductance",
    "load_curve",
    "optimise",
    "tilt_curve",
]
__dir__ = __all__.copy

Values = Sequence[float] | npt.NDArray[np.float64]


@names_itself
def coating_chart(
    shape: core.Shape,
    substrate: core.Elastic | core.Rigid | core.Free,
    *,
    thickness: Values,
    young: Values,
    poisson: float = 0.3,
    friction: float = 0.0,
    direction: Direction | None = None,
    refine: bool | float | None = 0.2,
    yield_stress: Limits | None = None,
    strength: ByLayer | None = None,
    bond_strength: Bonds | None = None,
    **options: Any,
) -> xarray.Dataset:
    """Peak pressure and stresses for thicknesses and moduli of a single coating.

    The stresses are those of `Solution.stress_summary` that crack a coating and detach it: the
    largest tension (principal stress) in it, and the largest shear traction at the interface.

    Parameters
    ----------
    shape
        Shape that is pressed in.
    substrate
        Material under the coating.
    thickness, young
        Thicknesses [m] and Young's moduli [Pa] of the coating: every pair is solved.
    poisson
        Poisson's ratio of the coating.
    friction
        Coefficient of friction of sliding.
    direction
        Direction of the traction on the coating, ``(x, y)`` or ``"+x"`` to ``"-y"``. By default
        that of `Solution.stress`; for shapes without one it must be given where `friction` is above
        0.
    refine
        Largest estimated error of a stress, as a fraction of it, True for 0.05:
        `Solution.stress_summary` then solves finer cells around the most loaded places, which can
        take several times as long. None keeps the cells of the grid, as do contacts that cannot be
        refined: periodic ones and those with a hardness or given coefficients.
    yield_stress, strength, bond_strength : optional
        Limits as in `Solution.stress_summary`, for the verdict on each coating.
    options
        Arguments of `nacre.solve`, such as `load` and `counterbody`, and of `nacre.sweep`.

    Returns
    -------
    xarray.Dataset
        ``peak_pressure``, ``coating_tension``, ``interface_shear``, ``contact_area`` and
        ``approach``, as functions of ``thickness`` and ``young``; with limits also ``verdict``.

    Examples
    --------
    >>> from nacre import design
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> chart = design.coating_chart(
    ...     nacre.Sphere(5e-3), steel, thickness=[2e-6, 20e-6], young=[105e9, 420e9], load=10.0
    ... )
    >>> (chart.peak_pressure / 1e9).round(2).values
    array([[1.57, 1.62],
           [1.36, 1.82]])
    >>> (chart.coating_tension / 1e9).round(2).values
    array([[0.14, 0.34],
           [0.16, 0.26]])
    """
    contact_options, study = _split_options(options)

    def case(thickness: float, young: float) -> dict[str, object]:
        coating = core.Layer(core.Elastic(young, poisson), thickness)
        return {"shape": shape, "body": core.HalfSpace(substrate, [coating]), **contact_options}

    check_direction({"shape": shape, **contact_options}, friction, direction)
    refine = refine if _refinable(contact_options) else None
    stress = {
        **{"friction": friction, "direction": direction, "refine": refine},
        **{"yield_stress": yield_stress, "strength": strength, "bond_strength": bond_strength},
    }
    outputs = ["peak_pressure", "coating_tension", "interface_shear", "contact_area", "approach"]
    parameters = {"thickness": thickness, "young": young}
    dataset = sweep(case, parameters, outputs=outputs, stress=stress, **study)
    dataset["thickness"].attrs["units"] = symbol("m")
    dataset["young"].attrs = {"units": symbol("Pa"), "long_name": "Young's modulus of the coating"}
    return dataset


def _refinable(contact_options: Mapping[str, object]) -> bool:
    """Whether the stresses of a contact can be refined."""
    grid = contact_options.get("grid")
    has_cell_fields = any(
        contact_options.get(name) is not None
        for name in ("hardness", "indentation", "coefficients", "compliance")
    )
    return not (has_cell_fields or (isinstance(grid, core.Grid) and any(grid.periodic)))


@names_itself
def load_curve(
    shape: core.Shape, body: core.HalfSpace | core.Elastic, load: Values, **options: Any
) -> xarray.Dataset:
    """Approach, normal stiffness dW/dδ, area and peak pressure as functions of the load.

    The stiffness belongs to the approach alone, with the tilts held: it is the first element of
    `Solution.stiffness`.

    Parameters
    ----------
    shape, body
        Shape that is pressed in, and body that it is pressed into.
    load
        Forces [N].
    options
        Arguments of `nacre.solve` and of `nacre.sweep`.

    Returns
    -------
    xarray.Dataset
        ``approach``, ``stiffness``, ``contact_area`` and ``peak_pressure``, as functions of
        ``load``.

    Examples
    --------
    For a sphere W is proportional to δ to the 3/2, and the stiffness is 3/2 W/δ:

    >>> from nacre import design
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> curve = design.load_curve(nacre.Sphere(5e-3), steel, load=[1.0, 10.0])
    >>> (curve.stiffness * curve.approach / curve["load"]).round(2).values
    array([1.5, 1.5])
    """
    contact_options, study = _split_options(options)
    outputs: dict[str, Output] = {
        "approach": "approach",
        "stiffness": normal_stiffness,
        "contact_area": "contact_area",
        "peak_pressure": "peak_pressure",
    }
    case = {"shape": shape, "body": body, **contact_options}
    dataset = sweep(case, {"load": load}, outputs=outputs, **study)
    line = isinstance(contact_options.get("grid"), core.Grid) and contact_options["grid"].is_line
    dataset["load"].attrs["units"] = symbol("N/m" if line else "N")
    dataset["stiffness"].attrs["units"] = symbol("Pa" if line else "N/m")
    return dataset


@names_itself
def tilt_curve(
    shape: core.Shape,
    body: core.HalfSpace | core.Elastic,
    tilt: Values,
    *,
    load: float,
    **options: Any,
) -> xarray.Dataset:
    """Moment, point of the load and peak pressure as functions of the tilt along x, at one load.

    Parameters
    ----------
    shape, body
        Shape that is pressed in, and body that it is pressed into.
    tilt
        Slopes along x.
    load
        Force [N].
    options
        Arguments of `nacre.solve` and of `nacre.sweep`.

    Returns
    -------
    xarray.Dataset
        ``moment`` and ``eccentricity``, along x and y, ``approach`` and ``peak_pressure``, as
        functions of ``tilt``.

    Examples
    --------
    >>> from nacre import design
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5, length=30e-3)
    >>> curve = design.tilt_curve(roller, steel, [0.0, 3e-5], load=1e3, tolerance=1e-4)
    >>> round(1e3 * curve.eccentricity.sel(axis="x", tilt=3e-5).item(), 1)
    2.5
    """
    contact_options, study = _split_options(options)

    def case(tilt: float) -> dict[str, object]:
        return {"shape": shape, "body": body, "load": load, "tilt": (tilt, None), **contact_options}

    outputs = ("moment", "eccentricity", "approach", "peak_pressure")
    dataset = sweep(case, {"tilt": tilt}, outputs=outputs, **study)
    dataset["tilt"].attrs["units"] = symbol("rad")
    return dataset


@names_itself
def force_table(
    shape: core.Shape,
    body: core.HalfSpace | core.Elastic,
    approach: Values,
    *,
    tilt_x: Values = (0.0,),
    tilt_y: Values = (0.0,),
    **options: Any,
) -> xarray.Dataset:
    """Table of force, moments and stiffness for the contact element of a multibody program.

    ``table.to_netcdf`` and ``table.to_dataframe().to_csv`` write it. With a `grid`, all cases are
    solved on the same cells, and the table is smooth within the tolerance.

    Parameters
    ----------
    shape, body
        Shape that is pressed in, and body that it is pressed into.
    approach
        Approaches of the origin [m].
    tilt_x, tilt_y
        Slopes along x and along y.
    options
        Arguments of `nacre.solve` and of `nacre.sweep`.

    Returns
    -------
    xarray.Dataset
        ``load``, ``moment``, ``peak_pressure`` and ``stiffness`` as functions of ``approach``,
        ``tilt_x`` and ``tilt_y``. ``stiffness`` is `Solution.stiffness`, the derivatives of the
        load and of the first moments along x and y (``row``) with respect to the approach and the
        slopes (``column``).

    Examples
    --------
    >>> from nacre import design
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5, length=40e-3)
    >>> table = design.force_table(roller, steel, [2e-6, 3e-6], tilt_x=[0.0, 3e-5], tolerance=1e-4)
    >>> table["load"].shape, bool((table["load"].diff("approach") > 0).all())
    ((2, 2, 1), True)
    """
    contact_options, study = _split_options(options)

    def case(approach: float, tilt_x: float, tilt_y: float) -> dict[str, object]:
        motion = {"approach": approach, "tilt": (tilt_x, tilt_y)}
        return {"shape": shape, "body": body, **motion, **contact_options}

    parameters = {"approach": approach, "tilt_x": tilt_x, "tilt_y": tilt_y}
    outputs: dict[str, Output] = {
        **{name: name for name in ("load", "moment", "peak_pressure")},
        "stiffness": stiffness,
    }
    table = sweep(case, parameters, outputs=outputs, **study)
    line = isinstance(contact_options.get("grid"), core.Grid) and contact_options["grid"].is_line
    names = ["load", "moment x", "moment y"], ["approach", "tilt x", "tilt y"]
    if "stiffness_0" in table.dims:  # else all cases failed
        table = table.rename(stiffness_0="row", stiffness_1="column")
        table = table.assign_coords(row=names[0], column=names[1])
    per = symbol("Pa" if line else "N/m")
    table["stiffness"].attrs["units"] = f"{per} times {symbol('m')} for each moment and each tilt"
    table["approach"].attrs["units"] = symbol("m")
    for name in ("tilt_x", "tilt_y"):
        table[name].attrs["units"] = symbol("rad")
    return table


def stiffness(solution: Solution) -> npt.NDArray[np.float64]:
    """Return the stiffness of a solution."""
    return np.asarray(solution.stiffness())


def normal_stiffness(solution: Solution) -> float:
    """Return dW/dδ with the tilts held [N/m]."""
    return float(np.asarray(solution.stiffness())[0, 0])


def _split_options(options: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the options of `nacre.solve`, and the options of `nacre.sweep`."""
    bar = options.get("progress")
    study_names = ("store", "version", "executor", "retry")
    study = {name: options[name] for name in study_names if name in options}
    contact_options = {
        name: value for name, value in options.items() if name not in (*study, "progress")
    }
    for name in sorted(set(contact_options) - ARGUMENTS):
        words = "which neither nacre.solve nor nacre.sweep has"
        raise TypeError(f"unexpected keyword argument {name!r}, {words}")
    return contact_options, study | {"progress": bar}
