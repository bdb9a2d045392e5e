"""Heights of missing points, by the discrete Laplace equation."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

CLOSE = 1e-12
"""Residual over the first one at which the iteration ends: some roundings of a sum over a map."""
STIFFER = 1.8
"""Factor by which constants on blocks of points are stiffer than smooth heights: 2 on a wide
region, less on a narrow one (Braess 1995, doi:10.1007/BF02238488)."""
DAMPING = 0.8
"""Damping of Jacobi's iteration: 4/5 damps best, in two dimensions, what a level of half the points
a side cannot hold (Trottenberg, Oosterlee and Schüller, Multigrid, 2001, section 2.1.2)."""
SWEEPS = 2
"""Iterations of Jacobi before and after the correction on the coarser level."""
COARSEST = 100
"""Most points of a level that is solved by a dense factor, faster than a further level is."""


def harmonic(heights: Array, wraps: tuple[bool, bool], tell: Callable[[float], object]) -> Array:
    """Return heights in which each missing point, a NaN, is the mean of its neighbours.

    Conjugate gradients, preconditioned by a cycle over levels of blocks of 2 x 2 points: the number
    of iterations hardly depends on the size of what is missing.

    Parameters
    ----------
    heights : ndarray, (nx, ny)
        Heights, one of which at least is measured.
    wraps : tuple of bool
        Whether the first and the last points along x, and along y, are neighbours.
    tell : callable
        Function that is called with the share of the work that is done.
    """
    missing = ~np.isfinite(heights)
    scale, base = float(np.ptp(heights[~missing])) or 1.0, float(heights[~missing].mean())
    level, residual = _base_level(missing, np.where(missing, 0.0, (heights - base) / scale), wraps)
    filled = np.zeros_like(residual)
    preconditioned = level.cycle(residual)
    direction, size = preconditioned, float(residual @ preconditioned)
    first = norm = float(np.linalg.norm(residual))
    for _ in range(residual.size):  # as many as conjugate gradients need without rounding
        if norm <= CLOSE * first:
            break
        tell(max(math.log(norm / first) / math.log(CLOSE), 0.0))
        image = level.apply(direction)
        step = size / float(direction @ image)
        filled += step * direction
        residual -= step * image
        norm = float(np.linalg.norm(residual))
        preconditioned = level.cycle(residual)
        before, size = size, float(residual @ preconditioned)
        direction = preconditioned + size / before * direction
    whole = heights.copy()
    whole[missing] = base + scale * filled
    return whole


@dataclass
class _Level:
    """Points or blocks of points, and the links between those that are neighbours."""

    places: tuple[Indices, Indices]
    """Place of each point along x and along y."""
    first: Indices
    second: Indices
    """Points of each link."""
    weights: Array
    """Weight of each link."""
    degrees: Array
    """Sum of the weights of a point's links, those to measured points among them."""

    def apply(self, field: Array) -> Array:
        """Return the weighted differences of a field to its neighbours, summed at each point."""
        count = field.size
        forth = _sums(self.first, self.weights * field[self.second], count)
        back = _sums(self.second, self.weights * field[self.first], count)
        return self.degrees * field - forth - back

    def cycle(self, load: Array) -> Array:
        """Return nearly the field whose differences are `load`, linear and symmetric in it."""
        if load.size <= COARSEST:
            return np.asarray(np.linalg.solve(self._dense, load), np.float64)
        field = DAMPING * load / self.degrees
        for _ in range(SWEEPS - 1):
            field += DAMPING * (load - self.apply(field)) / self.degrees
        block, coarser = self._coarser_level
        residual = _sums(block, load - self.apply(field), coarser.degrees.size)
        field += STIFFER * coarser.cycle(residual)[block]
        for _ in range(SWEEPS):
            field += DAMPING * (load - self.apply(field)) / self.degrees
        return field

    @cached_property
    def _dense(self) -> Array:
        return np.stack([self.apply(unit) for unit in np.eye(self.degrees.size)])

    @cached_property
    def _coarser_level(self) -> tuple[Indices, Self]:
        """Return the block of each point, and the level of blocks: constants on blocks."""
        x, y = (place // 2 for place in self.places)
        _, first_points, block = np.unique(
            x * (int(y.max()) + 1) + y, return_index=True, return_inverse=True
        )
        count = first_points.size
        pairs = np.sort([block[self.first], block[self.second]], axis=0)
        between = pairs[0] != pairs[1]
        inner = _sums(pairs[0, ~between], self.weights[~between], count)
        keys, link = np.unique(pairs[0, between] * count + pairs[1, between], return_inverse=True)
        return block, type(self)(
            (x[first_points], y[first_points]),
            keys // count,
            keys % count,
            _sums(link, self.weights[between], keys.size),
            _sums(block, self.degrees, count) - 2 * inner,
        )


def _sums(index: Indices, terms: Array, count: int) -> Array:
    """Return the sums of terms with the same index."""
    return np.asarray(np.bincount(index, terms, count), np.float64)


def _base_level(
    missing: npt.NDArray[np.bool_], measured: Array, wraps: tuple[bool, bool]
) -> tuple[_Level, Array]:
    """Return the level of missing points, and the sum of measured neighbours at each of them."""
    number = np.where(missing, np.cumsum(missing).reshape(missing.shape) - 1, -1)
    count = int(missing.sum())
    degrees, sums = np.zeros(count), np.zeros(count)
    links = []
    for axis, wrap in enumerate(wraps):
        here = np.arange(missing.shape[axis] - (not wrap))
        there = (here + 1) % missing.shape[axis]
        ends = number.take(here, axis), number.take(there, axis)
        heights = measured.take(here, axis), measured.take(there, axis)
        for end, height in zip(ends, heights[::-1], strict=True):
            degrees += np.bincount(end[end >= 0], minlength=count)
            sums += _sums(end[end >= 0], height[end >= 0], count)
        both = (ends[0] >= 0) & (ends[1] >= 0)
        links.append((ends[0][both], ends[1][both]))
    first, second = np.concatenate(links, axis=1)
    x, y = np.nonzero(missing)
    return _Level((x, y), first, second, np.ones(first.size), degrees), sums
