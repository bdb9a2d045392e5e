"""Missing heights are the means of their neighbours, wherever they are and however many."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import nacre
from nacre.surfaces.missing import CLOSE, harmonic
from support import assert_close

Array = npt.NDArray[np.float64]

ITERATIONS = 60
"""Most iterations: 33 were the most of maps up to 2048 x 2048 with a block, a border or half of the
points missing. Without levels it is some points a side of the block, hundreds here."""


def rough(shape: tuple[int, int]) -> Array:
    return np.random.default_rng(3).standard_normal(shape)


def block(heights: Array) -> None:
    nx, ny = heights.shape
    heights[nx // 4 : nx // 2, ny // 4 : ny // 2] = np.nan


def several_blocks(heights: Array) -> None:
    block(heights)
    heights[3:9, -12:-3] = np.nan
    heights[-1, -1] = np.nan


def borders(heights: Array) -> None:
    heights[:9] = np.nan
    heights[:, -7:] = np.nan


def lines(heights: Array) -> None:
    heights[1::3] = np.nan


def points(heights: Array) -> None:
    heights[np.random.default_rng(4).random(heights.shape) < 0.4] = np.nan


@pytest.mark.parametrize("remove", [block, several_blocks, borders, lines, points])
@pytest.mark.parametrize("wraps", [(False, False), (True, False), (True, True)])
def test_each_missing_height_is_the_mean_of_its_neighbours(
    remove: Callable[[Array], None], wraps: tuple[bool, bool]
) -> None:
    heights = rough((33, 26))
    remove(heights)
    missing = np.isnan(heights)
    shares: list[float] = []
    filled = harmonic(heights, wraps, shares.append)
    assert filled[~missing].tobytes() == heights[~missing].tobytes()
    # A dense solve of the same equations: sum over neighbours (height - neighbour) = 0.
    number = np.cumsum(missing).reshape(missing.shape) - 1
    matrix = np.zeros((missing.sum(), missing.sum()))
    right = np.zeros(missing.sum())
    for i, j in zip(*np.nonzero(missing), strict=True):
        for di, dj in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            near = [i + di, j + dj]
            for axis in (0, 1):
                if wraps[axis]:
                    near[axis] %= missing.shape[axis]
            if not (0 <= near[0] < missing.shape[0] and 0 <= near[1] < missing.shape[1]):
                continue
            k, (p, q) = number[i, j], near
            matrix[k, k] += 1
            if missing[p, q]:
                matrix[k, number[p, q]] -= 1
            else:
                right[k] += heights[p, q]
    exact = np.linalg.solve(matrix, right)
    # |error| <= |inverse| |residual|, and the heights were scaled to their range.
    bound = np.linalg.norm(np.linalg.inv(matrix), 2) * np.linalg.norm(right)
    assert np.abs(filled[missing] - exact).max() <= 2 * CLOSE * bound
    assert min(shares) >= 0
    assert max(shares) <= 1


@pytest.mark.parametrize("size", [64, 256])
def test_the_work_hardly_grows_with_the_size_of_a_block(size: int) -> None:
    heights = rough((size, size))
    block(heights)
    shares: list[float] = []
    harmonic(heights, (False, False), shares.append)
    assert len(shares) < ITERATIONS


def test_a_hole_at_the_end_of_a_periodic_map_is_filled_from_both_sides(tmp_path: Path) -> None:
    # Along x the heights are a straight line between the neighbours of the hole, 2 at index 4 and
    # 5 at index 0 of the next period, on a tilted table: the trend is taken off before.
    heights = np.repeat([[5.0], [1.0], [3.0], [4.0], [2.0], [np.nan], [np.nan]], 6, axis=1)
    path = tmp_path / "a.npy"
    np.save(path, heights)
    with pytest.warns(nacre.NacreWarning, match="12 of 42"):
        filled = nacre.HeightMap.read(
            path, spacing=1.0, unit="m", detrend="none", periodic=(True, False)
        )
    assert_close(filled.heights[-2:, 0], [3.0, 4.0], rtol=1e-11)
    tilt = 0.5 * np.arange(6)
    np.save(path, heights + tilt)
    with pytest.warns(nacre.NacreWarning, match="12 of 42"):
        tilted = nacre.HeightMap.read(path, spacing=1.0, unit="m", periodic=(True, True))
    np.save(path, heights)
    with pytest.warns(nacre.NacreWarning, match="12 of 42"):
        level = nacre.HeightMap.read(path, spacing=1.0, unit="m", periodic=(True, True))
    assert_close(tilted.heights, level.heights, atol=1e-10)
