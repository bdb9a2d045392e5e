"""Which loads the contacts of a bearing can carry: the cone of their forces on the inner ring.

Contacts push and never pull, so that all their forces together are a cone. A load has an
equilibrium if and only if it lies in this cone. Otherwise the ring can move in a direction along
which the load does work and no contact deepens: the energy falls without end. Derived here.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

OUTSIDE = 1e-9
"""Distance from the cone over the load above which the load is outside.

It is the default tolerance of a bearing's balance, and far above rounding, 1e-14.
"""
NO_GAIN = 1e-12
"""Projection of what is left on a force of the cone, over the load, that is rounding."""
HALVINGS = 24
"""Halvings of a change of a load: 6e-8 of it is left, less than the digits that are printed."""
DIGITS = 6
"""Digits of a bound."""
AXIAL = np.array([0, 0, 1, 0, 0])
"""Direction of the bearing's axis among those of the ring."""
WORDS = ("force along x", "force along y", "force along z", "moment about x", "moment about y")
UNITS = ("N", "N", "N", "N m", "N m")


def _factors(generators: Array, load: Array) -> Array:
    """Return the factors, at least 0, of the forces that come nearest to a load together.

    By the active sets of Lawson and Hanson, Solving Least Squares Problems (1974), chapter 23,
    doi:10.1137/1.9781611971217. SciPy has it, but bearings need NumPy alone.
    """
    size = float(np.linalg.norm(load))
    lengths = np.linalg.norm(generators, axis=0)
    columns = generators / np.where(lengths > 0, lengths, 1.0)
    factors = np.zeros(columns.shape[1])
    active = np.zeros(columns.shape[1], dtype=bool)
    for _ in range(3 * columns.shape[1]):
        gain = np.where(active, 0.0, columns.T @ (load - columns @ factors))
        if gain.max(initial=0.0) <= NO_GAIN * size:
            break
        active[gain.argmax()] = True
        while active.any():
            best = np.zeros_like(factors)
            best[active] = np.linalg.lstsq(columns[:, active], load, rcond=None)[0]
            leaving = active & (best <= 0)
            if not leaving.any():
                factors = best
                break
            share = (factors[leaving] / (factors[leaving] - best[leaving])).min()
            factors = factors + share * (best - factors)
            active &= factors > NO_GAIN * size
            factors[~active] = 0.0
    return factors / np.where(lengths > 0, lengths, 1.0)


def _is_within(generators: Array, load: Array) -> bool:
    """Return whether a load lies in a cone."""
    left = load - generators @ _factors(generators, load)
    return float(np.linalg.norm(left)) <= OUTSIDE * float(np.linalg.norm(load))


def _change(generators: Array, load: Array, k: int) -> float | None:
    """Return the least change of one component that brings a load into a cone; None if none does.

    Components with which the load is inside are an interval, and the present one is outside.
    """
    unit = np.eye(len(load))[k]
    for way in (1.0, -1.0):
        wider = np.column_stack([generators, -way * unit])
        factors = _factors(wider, load)
        inside = 2 * float(factors[-1])
        if not _is_within(generators, load + inside * way * unit):
            inside = float(factors[-1])
        if not _is_within(generators, load + inside * way * unit):
            continue
        outside = 0.0
        for _ in range(HALVINGS):
            middle = (outside + inside) / 2
            if _is_within(generators, load + middle * way * unit):
                inside = middle
            else:
                outside = middle
        return inside * way
    return None


def _rounded_bound(bound: float, change: float) -> float:
    """Return a bound of `DIGITS` digits that lies farther along a change."""
    unit = 10.0 ** (math.floor(math.log10(max(abs(bound), OUTSIDE * abs(change)))) + 1 - DIGITS)
    return (math.ceil(bound / unit) if change > 0 else math.floor(bound / unit)) * unit


def check_carried(
    generators: Array, loads: Array, thrust: float, free: npt.NDArray[np.bool_], arm: float
) -> None:
    """Raise a `ValueError` unless contacts can carry the loads along the free directions.

    Parameters
    ----------
    generators : numpy.ndarray
        Forces and moments on the ring of unit forces of contacts ``(5, n)``.
    loads : numpy.ndarray
        Forces and moments that are asked of the ring ``(5,)``.
    thrust : float
        Force along z by which elements at speed push the ring [N].
    free : numpy.ndarray
        Directions that are loaded ``(5,)``; the others are held.
    arm : float
        Length that makes moments forces [m].
    """
    units = np.array([1, 1, 1, 1 / arm, 1 / arm])
    cone = (generators * units[:, None])[free]
    load = ((loads + thrust * AXIAL) * units)[free]
    if not load.any() or _is_within(cone, load):
        return
    rows = np.flatnonzero(free)
    for axes in ((2, 3, 4), (0, 1)):  # thrust and moments; forces across where these do not help
        bounds = []
        for k, row in enumerate(rows):
            if row in axes and (change := _change(cone, load, k)) is not None:
                bound = loads[row] + change / units[row]
                bound = 0.0 if abs(bound) < OUTSIDE * abs(change) else _rounded_bound(bound, change)
                side = "least" if change > 0 else "most"
                bounds.append(
                    f"{WORDS[row]} must be at {side} {bound:.{DIGITS}g} {UNITS[row]}, "
                    f"got {float(loads[row])!r} {UNITS[row]}"
                )
        if bounds:
            raise ValueError(f"{', or '.join(bounds)}: contacts only push and balance no such load")
    left = np.zeros(5)
    left[free] = load - cone @ _factors(cone, load)
    largest = int(np.abs(left).argmax())
    raise ValueError(
        f"{WORDS[largest]} must be one that contacts, which only push, balance; "
        f"{left[largest] / units[largest]:.6g} {UNITS[largest]} of it are left, "
        f"got {float(loads[largest])!r} {UNITS[largest]}"
    )
