"""Connected cells of a contact or of its gap, and the sides of cells between both."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.extras import extra

Labels = npt.NDArray[np.int64]

CURVE = {
    "load": ("load", "N"),
    "contact_area": ("contact area of counted cells", "m²"),
    "corrected_area": ("contact area, corrected for the perimeter", "m²"),
    "share": ("share of the cells in contact", "1"),
    "corrected_share": ("share of the area in contact, corrected", "1"),
    "mean_gap": ("mean gap", "m"),
    "approach": ("approach", "m"),
    "stiffness": ("stiffness, change of the mean pressure over that of the approach", "Pa/m"),
    "patches": ("number of patches", "1"),
}
"""Columns of `rough.load_curve`: words and units."""


@contextmanager
def surfaces() -> Iterator[None]:
    """Import SurfaceTopography and SciPy, without a warning that MPI is missing."""
    with extra("surfaces"), warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)
        yield


def patch_labels(cells: npt.NDArray[np.bool_], grid: core.Grid) -> Labels:
    """Return numbers from 1 on of connected cells ``(nx, ny)``, and 0 in all others."""
    with surfaces():
        from scipy.ndimage import label
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

    labels, count = label(cells)
    first, second = [], []
    for axis, repeats in enumerate(grid.periodic):
        if repeats:
            low, high = np.take(labels, 0, axis), np.take(labels, -1, axis)
            both = (low > 0) & (high > 0)
            first.append(low[both])
            second.append(high[both])
    if not first:
        return np.asarray(labels, dtype=np.int64)
    edges = np.concatenate(first), np.concatenate(second)
    graph = coo_array((np.ones(edges[0].size), edges), shape=(count + 1, count + 1))
    _, joined = connected_components(graph, directed=False)
    # The label 0 stands alone, and keeps its number.
    numbers = np.unique(joined[labels], return_inverse=True)[1].reshape(labels.shape)
    return np.where(labels > 0, numbers + (0 if (labels == 0).any() else 1), 0)


def crosses(cells: npt.NDArray[np.bool_], grid: core.Grid, axis: int) -> bool:
    """Return whether connected cells lead from one side to the other along an axis."""
    with surfaces():
        from scipy.ndimage import label
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import breadth_first_order

    repeats = grid.periodic
    if not repeats[axis]:
        # Across the axis the grid may repeat: labels know that.
        across = core.Grid(grid.shape, grid.size, periodic=(repeats[0], repeats[1]))
        labels = patch_labels(cells, across)
        ends = [np.take(labels, k, axis) for k in (0, -1)]
        return bool(np.intersect1d(ends[0][ends[0] > 0], ends[1][ends[1] > 0]).size)
    # Each connected part has a place on the endless plane; a part that meets itself in another
    # period crosses. Steps over the seams carry the number of periods along the axis.
    labels, count = label(cells)
    links = []
    for seam, joined in enumerate(repeats):
        if joined:
            low, high = np.take(labels, 0, seam).ravel(), np.take(labels, -1, seam).ravel()
            both = (low > 0) & (high > 0)
            step = 1 if seam == axis else 0
            links += [(h, low_, step) for h, low_ in zip(high[both], low[both], strict=True)]
    neighbours: dict[int, list[tuple[int, int]]] = {}
    for a, b, step in set(links):
        neighbours.setdefault(int(a), []).append((int(b), step))
        neighbours.setdefault(int(b), []).append((int(a), -step))
    place: dict[int, int] = {}
    graph = coo_array(
        (np.ones(len(links)), ([a for a, _, _ in links], [b for _, b, _ in links])),
        shape=(count + 1, count + 1),
    ).tocsr()
    for start in sorted(neighbours):
        if start in place:
            continue
        place[start] = 0
        order, before = breadth_first_order(graph, start, directed=False)
        for node in order[1:]:
            step = next(s for b, s in neighbours[int(before[node])] if b == node)
            place[int(node)] = place[int(before[node])] + step
    return any(place[a] + step != place[b] for a in neighbours for b, step in neighbours[a])
