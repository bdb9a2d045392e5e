"""Charts over coatings: how far bulk formulae hold, and how adhesion lets go."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre.indent.solution import Control, Indentation

__all__ = ["bulk_limit", "coated", "information", "pull_off_over_thickness"]

Array = npt.NDArray[np.float64]

EPSILON = 0.75
"""Factor ε of Oliver and Pharr for paraboloids."""
RADII = np.geomspace(1e-3, 3.0, 141)
"""Contact radii over thickness at which errors are computed; between them they are interpolated."""


def coated(ratio: float, thickness: float, poisson: float = 0.3) -> core.HalfSpace:
    """Return a layer of this ratio of moduli on a substrate of modulus 1."""
    layer = core.Layer(core.Elastic(ratio, poisson), thickness)
    return core.HalfSpace(core.Elastic(1.0, poisson), [layer])


def _numbers(name: str, values: npt.ArrayLike, low: float, high: float) -> Array:
    """Return numbers, at least one, or an error unless they lie between two others."""
    read = core.real_array if np.ndim(values) else core.real
    numbers = np.atleast_1d(read(name, values))
    if (wrong := numbers[~((numbers >= low) & (numbers <= high))]).size:
        raise ValueError(f"{name} must be between {low:g} and {high:g}, got {wrong.flat[0]}")
    return numbers


def bulk_limit(
    ratios: npt.ArrayLike, error: float = 0.01, *, poisson: float = 0.3
) -> dict[str, Array]:
    """Largest a/h up to which formulae of bare bodies give the layer's modulus, for a paraboloid.

    Parameters
    ----------
    ratios : array_like, (n,)
        Young's modulus of the layer over that of the substrate.
    error : float
        Relative error of the reduced modulus that is allowed.
    poisson : float
        Poisson's ratio of both.

    Returns
    -------
    dict of str to ndarray
        "hertz", "oliver_pharr" and "stiffness" (S/2a); NaN, which pictures leave out, where the
        limit is not between 0.001 and 3.

    Raises
    ------
    ValueError
        If the error is not above 0, or a ratio is not between 1e-6 and 1e6.

    Examples
    --------
    >>> limits = nacre.indent.charts.bulk_limit([0.1, 10.0])
    >>> limits["oliver_pharr"].round(4)
    array([0.011 , 0.0018])
    """
    if not error > 0:
        raise ValueError(f"error must be above 0, got {error}")
    names = ("hertz", "oliver_pharr", "stiffness")
    rows = [_limits(ratio, error, poisson) for ratio in _numbers("ratios", ratios, 1e-6, 1e6)]
    return dict(zip(names, np.array(rows).reshape(-1, 3).T, strict=True))


def _limits(ratio: float, error: float, poisson: float) -> list[float]:
    tip_radius = 1e3
    body = coated(ratio, 1.0, poisson)
    state = Indentation(body, core.Tip.paraboloid(tip_radius)).at(radius=RADII)
    load, approach, stiffness = (
        np.asarray(values) for values in (state.load, state.approach, state.stiffness)
    )
    contact = np.sqrt(2 * tip_radius * (approach - EPSILON * load / stiffness))
    moduli = (
        0.75 * load / (math.sqrt(tip_radius) * approach**1.5),
        stiffness / (2 * contact),
        stiffness / (2 * RADII),
    )
    true = ratio / (1 - poisson**2)
    return [_crossing(np.abs(modulus / true - 1), error) for modulus in moduli]


def _crossing(errors: Array, error: float) -> float:
    above = np.flatnonzero(errors > error)
    if not above.size or above[0] == 0:
        return math.nan
    pair = slice(above[0] - 1, above[0] + 1)
    log = np.interp(math.log(error), np.log(errors[pair]), np.log(RADII[pair]))
    return float(np.exp(log))


def pull_off_over_thickness(
    ratio: float, thickness: npt.ArrayLike, *, control: Control = "load", poisson: float = 0.3
) -> Array:
    """Pull-off force of a paraboloid by JKR over πwR, for layers of one ratio of moduli.

    Parameters
    ----------
    ratio : float
        Young's modulus of the layer over that of the substrate.
    thickness : array_like, (n,)
        Thicknesses over a0 = (9πwR²/8E2*)^(1/3), the pull-off radius on the bare substrate.
    control : str
        "load" or "approach".
    poisson : float
        Poisson's ratio of both.

    Returns
    -------
    ndarray, (n,)
        Forces over πwR; 1.5 on a bare body under load control.

    Raises
    ------
    ValueError
        If a thickness is not between 0.001 and 1e6.
    """
    work, radius = 1e-6, 1.0
    modulus = 1 / (1 - poisson**2)
    unit = (9 * math.pi * work * radius**2 / (8 * modulus)) ** (1 / 3)
    tip, adhesion = core.Tip.paraboloid(radius), core.Adhesion.jkr(work)
    forces = [
        Indentation(coated(ratio, unit * float(h), poisson), tip, adhesion=adhesion)
        .pull_off(control)
        .load
        for h in _numbers("thickness", thickness, 1e-3, 1e6)
    ]
    return -np.array(forces) / (math.pi * work * radius)


def information(
    ratio: float,
    reach: npt.ArrayLike,
    *,
    noise: float = 0.01,
    points: int = 60,
    substrate: bool = False,
    poisson: float = 0.3,
) -> dict[str, Array]:
    """Least standard deviations of ln E1 and ln h (Cramér-Rao) from one curve of a paraboloid.

    Parameters
    ----------
    ratio : float
        Young's modulus of the layer over that of the substrate.
    reach : array_like, (n,)
        Largest contact radius over the thickness.
    noise : float
        Relative standard deviation of each force.
    points : int
        Points, evenly from 5 % of the largest depth on.
    substrate : bool
        Whether the modulus of the substrate is unknown, too.
    poisson : float
        Poisson's ratio of both, which is known.

    Returns
    -------
    dict of str to ndarray
        "young" and "thickness".
    """
    values = {"body.layers[0].material.young": ratio, "body.layers[0].thickness": 1.0}
    if substrate:
        values["body.substrate.young"] = 1.0
    test = Indentation(coated(ratio, 1.0, poisson), core.Tip.paraboloid(1e3))
    rows = []
    points = core.integer("points", points)
    core.check_memory("points", points, 1000)
    for largest in np.atleast_1d(core.real_array("reach", reach)).tolist():
        depth = float(test.at(radius=largest).approach)
        curve = test.curve(approach=np.linspace(0.05, 1.0, points) * depth, wrt=list(values))
        slopes = np.asarray(curve.derivatives).T
        slopes = slopes * np.array(list(values.values()))[:, None] / curve.load
        rows.append(noise * np.sqrt(np.diag(np.linalg.inv(slopes @ slopes.T)))[:2])
    return dict(zip(("young", "thickness"), np.array(rows).reshape(-1, 2).T, strict=True))
