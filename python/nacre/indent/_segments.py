"""Where the loading of a curve ends, the unloading begins, and a force is held."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

OUTLIER = 6.0
"""Standard deviations of the noise that the largest of a hundred thousand normal values exceeds
once in ten thousand curves."""
NOISE_RANGE = 10.0
"""Standard deviations between the largest and the smallest of a hundred thousand normal values,
9 on average, and some to be safe."""
BEND = 0.25
"""Share of the largest value over which a rise is a parabola: the third order of a rise in two
decades per ramp, as at a constant strain rate, is 0.25³/3, below 1 % of the value."""
TRIALS = 50
"""Places that are compared at once: a thousand points take two rounds."""
HELD_BAND = 0.01
"""Share of the range within which a force is held, beside its noise: what controllers keep."""
LEAST_DWELL = 5.0
"""Points within that share over those of an even ramp from which a force is held. A power law of
exponent 2 has 2.2 times as many at a twentieth of its largest force, 1.6 at a tenth."""
LEAST_HELD = 10
"""Fewest points of a hold: to tell a rate from."""
LEAST_CONTACT_FORCE = 0.05
"""Share of the largest force below which an even force is a tip out of contact."""


def noise_of(values: Array) -> float:
    """Return the standard deviation of what varies from point to point, robustly.

    Second differences of noise have √6 of its standard deviation; the median of their size is
    0.6745 standard deviations.
    """
    return float(np.median(np.abs(np.diff(values, 2)))) / (0.6745 * math.sqrt(6.0))


def arrival(values: Array) -> int:
    """Return the first point at which values no longer rise to their largest, within the noise.

    Least squares of a parabola up to this point and of a constant from it on, among the points
    up to the largest one. Of several visits to the largest value the first counts.
    """
    start, top = _first_rise(values)
    return start + _end_of_rise(values[start : top + 1] - float(values.max()))


def _first_rise(values: Array) -> tuple[int, int]:
    """Return the ends of the first rise to the largest value: from a window below it to its top.

    The top is the largest value before values leave the window again.
    """
    noise = noise_of(values) if values.size > 2 else 0.0
    largest = float(values.max())
    floor = largest - max(BEND * float(np.ptp(values)), 2 * NOISE_RANGE * noise)
    visit = int(np.argmax(values >= largest - OUTLIER * noise))
    leaves = np.flatnonzero(values[visit:] < floor)
    leave = visit + int(leaves[0]) if leaves.size else values.size
    top = visit + int(np.argmax(values[visit:leave]))
    below = np.flatnonzero(values[:top] < floor)
    return int(below[-1]) if below.size else 0, top


def _end_of_rise(rise: Array) -> int:
    """Return the point with the least misfit, the last of equals: trials get closer by rounds."""
    low, high = 0, rise.size - 1
    while True:
        step = max(1, (high - low) // TRIALS)
        trials = np.arange(high, low - 1, -step)
        best = int(trials[np.argmin([_misfit(rise, int(trial)) for trial in trials])])
        if step == 1:
            return best
        low, high = max(low, best - step), min(high, best + step)


def _misfit(rise: Array, end: int) -> float:
    """Return the sum of squares about a parabola up to a point and its value from there on."""
    x = np.minimum(np.arange(rise.size) - end, 0) / rise.size
    basis = np.stack([np.ones_like(x), x, x**2], axis=1)
    misfit = rise - basis @ np.linalg.lstsq(basis, rise)[0]
    return float(misfit @ misfit)


def departure(depth: Array, force: Array) -> int:
    """Return the last point before the unloading: both force and depth are held up to there."""
    last = force.size - 1 - arrival(force[::-1])
    after = depth[last:]
    if after.size > 2 and np.ptp(after) > 2 * NOISE_RANGE * noise_of(after):
        last += after.size - 1 - arrival(after[::-1])  # a force that falls at a depth that is held
    return last


def find_hold(force: Array) -> slice | None:
    """Return the longest part of an unloading in which the force is held, or None.

    It has more points within `HELD_BAND` than an even ramp would have, and is no baseline of a tip
    that is out of contact.
    """
    noise = noise_of(force) if force.size > 2 else 0.0
    force_range = float(np.ptp(force))
    within = max(HELD_BAND * force_range, NOISE_RANGE * noise)
    if within >= 0.5 * force_range:
        return None
    # The longest run of points that are within the band.
    longest, start = slice(0, 0), 0
    for stop in range(1, force.size + 1):
        while np.ptp(force[start:stop]) > within:
            start += 1
        if stop - start > longest.stop - longest.start:
            longest = slice(start, stop)
    # Without its ends, which belong to the ramps.
    away = np.abs(force[longest] - np.median(force[longest]))
    near = longest.start + np.flatnonzero(away <= OUTLIER * np.median(away))
    longest = slice(int(near[0]), int(near[-1]) + 1)
    points = longest.stop - longest.start
    points_of_ramp = (force.size - points) * within / (force_range - within)
    # In contact: the force falls afterwards, or is above a baseline.
    level, after = float(force[longest].mean()), force[longest.stop :]
    falls_afterwards = after.size > 0 and float(after.min()) < level - within
    is_contact = falls_afterwards or level > max(
        LEAST_CONTACT_FORCE * float(force.max()), OUTLIER * noise / math.sqrt(points)
    )
    return (
        longest if points >= max(LEAST_HELD, LEAST_DWELL * points_of_ramp) and is_contact else None
    )
