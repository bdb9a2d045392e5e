"""Contacts with friction: creep, and histories and creep curves, to one Dataset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.extras import extra
from nacre._tools.groups import names_itself
from nacre._tools.progress import lasting
from nacre._tools.units import energy, symbol
from nacre.contact import Contact, solve
from nacre.contact.arguments import MOTION
from nacre.contact.friction import FrictionSolution, History
from nacre.results.base import checked
from nacre.results.quantities import frozen, quantity
from nacre.results.rows import Row
from nacre.results.shown import TableResult

if TYPE_CHECKING:
    import xarray

__all__ = ["creep_coefficients", "creep_curve", "history"]
__dir__ = __all__.copy


@frozen()
class CreepCoefficients(TableResult):
    """Kalker's linear coefficients of an elliptic contact, with their estimated errors.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.25)
    >>> creep = nacre.creep_coefficients(steel, steel, (1e-3, 1e-3))
    >>> round(creep.c11, 1), round(creep.c22, 1), round(creep.c23, 1)
    (4.1, 3.7, 1.5)
    """

    _COMPILED = True
    _TITLE = "Kalker's coefficients"

    c11: float = quantity()
    """Coefficient of the longitudinal creepage: ``F_x = a b G C11 xi``."""
    c22: float = quantity()
    """Coefficient of the lateral creepage: ``F_y = a b G C22 eta``."""
    c23: float = quantity()
    """Coefficient of the spin in the lateral force: ``F_y = (a b)**1.5 G C23 phi``."""
    c33: float = quantity()
    """Coefficient of the spin in the torque: ``M_z = (a b)**2 G C33 phi``."""
    errors: tuple[float, float, float, float] = quantity(dims=("coefficient",))
    """Estimated errors of c11, c22, c23 and c33."""
    shear: float = quantity("Pa")
    """Shear modulus [Pa]: 1/G is the mean of 1/G of both substrates."""
    semi_axes: tuple[float, float] = quantity("m", dims=("semi_axis",))
    """Semi-axes along and across rolling ``(a, b)`` [m]."""

    def _rows(self) -> list[Row]:
        coefficients = (self.c11, self.c22, self.c23, self.c33)
        numbers = zip(("C11", "C22", "C23", "C33"), coefficients, self.errors, strict=True)
        return [
            Row(label.lower(), label, f"{c:.4f} ± {error:.4f}", c, "", error)
            for label, c, error in numbers
        ]


def creep_coefficients(
    body: core.HalfSpace | core.Elastic,
    counterbody: core.HalfSpace | core.Elastic | None,
    semi_axes: tuple[float, float],
    *,
    cells: int = 64,
) -> CreepCoefficients:
    """Kalker's linear coefficients of two bodies with any layers, by one call.

    Parameters
    ----------
    body, counterbody : HalfSpace, Elastic or None
        Bodies; a counterbody that is `None` is rigid.
    semi_axes : tuple of float
        Semi-axes ``(a, b)`` of the contact [m], a along the direction of rolling.
    cells : int, optional
        Cells along each axis of the ellipse, at least 8. The coefficients are extrapolated from
        these and from half as many.

    Returns
    -------
    CreepCoefficients
        C11, C22, C23 and C33, as Kalker (1990) defines them; those of coated bodies are derived
        here.

    Raises
    ------
    ValueError
        If a semi-axis is not above 0, there are fewer cells, both substrates are rigid, or a body
        has no response along its surface.
    ConvergenceError
        If the iteration did not converge.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.25)
    >>> rubber = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(50e9, 0.25), 0.5e-3)])
    >>> coated = nacre.creep_coefficients(rubber, rubber, (1e-3, 1e-3))
    >>> coated.c11 < 0.5 * nacre.creep_coefficients(steel, steel, (1e-3, 1e-3)).c11
    True
    """
    return CreepCoefficients._from_fields(
        core.creep_coefficients(body, counterbody, semi_axes, cells)
    )


def history(solutions: Sequence[FrictionSolution]) -> xarray.Dataset:
    """Dataset of the main numbers of a history, step by step; needs ``nacre-contact[files]``.

    Parameters
    ----------
    solutions : sequence of FrictionSolution
        Steps that `nacre.slide` or `Contact.roll` returned.

    Returns
    -------
    xarray.Dataset
        Load, force, torque, dissipated energy, share of the contact that sticks and the number of
        convolutions over ``step``; shift and twist of sliding, creepage of rolling.

    Raises
    ------
    TypeError
        If they are no sequence of FrictionSolution.
    ValueError
        If there is none, or some slide and some roll.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> steps = [{"force": (force, None)} for force in (2.0, -2.0, 2.0)]
    >>> loop = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, steps=steps)
    >>> study = nacre.friction.history(loop)
    >>> study.force.dims, bool((study.dissipated >= 0).all())
    (('step', 'component'), True)
    """
    return History(checked(solutions)).numbers()


@names_itself
def creep_curve(
    shape: core.Shape,
    body: core.HalfSpace | core.Elastic,
    counterbody: core.HalfSpace | core.Elastic | None = None,
    *,
    creepages: npt.ArrayLike,
    lateral: bool = False,
    **keywords: Any,
) -> xarray.Dataset:
    """Roll at several creepages, and return the forces; needs ``nacre-contact[files]``.

    Parameters
    ----------
    shape, body, counterbody
        As `nacre.roll`.
    creepages : array_like
        Creepages, one after the other.
    lateral : bool, optional
        Whether they are lateral ones, eta, instead of longitudinal ones, xi.
    **keywords
        Other keywords of `nacre.roll`: load, friction, direction, spin, grid, tolerance.

    Returns
    -------
    xarray.Dataset
        Force along and across rolling, torque, share of the contact that sticks, and power over
        the speed of rolling, over ``creepage``; the force along the creepage over friction
        times load as ``traction_ratio``, NaN where there is neither. Errors due to the size of the
        cells are ``force_discretisation``, of the length of the force, ``torque_discretisation``
        and ``power_discretisation``, NaN where there is no estimate.

    Raises
    ------
    TypeError
        If creepages are not real numbers.
    ValueError
        If creepages are not a sequence of numbers, or `nacre.roll` would raise.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> curve = nacre.friction.creep_curve(
    ...     nacre.Sphere(5e-3), steel, steel, creepages=[1e-4, 1e-2], load=10.0, friction=0.3,
    ...     direction="+x",
    ... )
    >>> curve.traction_ratio.round(3).values[-1]
    np.float64(1.0)
    """
    with extra("files"):
        import xarray

    values = core.real_array("creepages", creepages)
    if values.ndim != 1 or values.size == 0:
        raise ValueError(f"creepages must be a sequence of numbers, got shape {values.shape}")
    for name in ("creepage", "force", "cells", "initial"):
        if name in keywords:
            raise ValueError(f"{name} must not be given: creepages say what is asked")
    plan = {"threads": keywords.pop("threads", None)}
    grid, most = keywords.pop("grid", None), keywords.pop("max_cells", None)
    if grid is None:
        motion = {name: keywords[name] for name in MOTION if name in keywords}
        grid = solve(shape, body, counterbody, max_cells=most, **plan, **motion).report.grid
    contact = Contact(body, grid, counterbody, **plan)
    solutions = []
    with lasting("creepages") as tell:
        for value in values.tolist():
            creepage = (None, value) if lateral else (value, None)
            solutions.append(contact.roll(shape, creepage=creepage, **keywords))
            if tell is not None:
                tell(len(solutions) / values.size)
    columns = _columns(solutions, lateral)
    dataset = xarray.Dataset(
        {name: ("creepage", np.asarray(column)) for name, (column, _) in columns.items()},
        coords={"creepage": values},
    )
    for name, (_, unit) in columns.items():
        dataset[name].attrs = {"units": unit}
    dataset["creepage"].attrs = {
        "units": "1",
        "long_name": "lateral creepage" if lateral else "longitudinal creepage",
    }
    dataset.attrs = {"title": "creep curve", "source": f"nacre {core.__version__}"}
    return dataset


def _columns(solutions: Sequence[FrictionSolution], lateral: bool) -> dict[str, tuple[object, str]]:
    """Return the columns of a creep curve with their units."""
    along = {"+x": (0, 1), "-x": (0, -1), "+y": (1, 1), "-y": (1, -1)}
    axis, sign = along[str(solutions[0].direction)]
    # z x e: along +y for rolling towards +x, along -x for rolling towards +y.
    across = 1 - axis, sign if axis == 0 else -sign
    forces = np.array([s.force for s in solutions])
    area = [s.normal.load / (s.pressure.sum() or 1.0) for s in solutions]
    bears = np.array([s.bound.sum() * cell for s, cell in zip(solutions, area, strict=True)])
    bears[bears <= 0] = np.nan  # there is no ratio
    driven = across if lateral else (axis, sign)
    pulled = driven[1] * forces[:, driven[0]]
    line = solutions[0].grid.is_line
    unit = symbol("N/m" if line else "N")
    touching = np.array([np.count_nonzero(s.pressure) for s in solutions])
    columns: dict[str, tuple[object, str]] = {
        "longitudinal_force": (sign * forces[:, axis], unit),
        "lateral_force": (across[1] * forces[:, across[0]], unit),
        "torque": ([s.torque for s in solutions], symbol("N" if line else "N m")),
        "traction_ratio": (pulled / bears, "1"),
        "stick_share": ([s.stick.sum() for s in solutions] / np.maximum(touching, 1), "1"),
        "power_over_speed": ([s.dissipated for s in solutions], symbol(energy(line, rolls=True))),
    }
    units = {"force": unit, "torque": columns["torque"][1], "power": columns["power_over_speed"][1]}
    for name, size in units.items():
        quantity = "dissipated" if name == "power" else name
        errors = [(s.report.discretisation or {}).get(quantity, np.nan) for s in solutions]
        columns[name + "_discretisation"] = (errors, size)
    return columns
