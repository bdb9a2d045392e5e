"""Coordinates of labelled maps: their spacing is that of the map, and they ascend."""

from typing import Any

import numpy as np
import pytest
import xarray

import nacre
from bodies import quiet

X, Y = 2e-6 * np.arange(12), 3e-6 * np.arange(10) + 1.0
HEIGHTS = (3 * np.indices((12, 10))[0] + 5 * np.indices((12, 10))[1]) % 101 * 1e-8


def table(x: Any = X, y: Any = Y, units: str | None = None) -> xarray.DataArray:
    """Return a map with coordinates, in a unit if it is given."""
    made = xarray.DataArray(HEIGHTS, dims=("x", "y"))
    for name, places in (("x", x), ("y", y)):
        if places is not None:
            made = made.assign_coords({name: places})
            made[name].attrs.update({} if units is None else {"units": units})
    return made


ROUNDED = np.round(X / 2e-6 / 3, 2)
"""Thirds of two digits, up to 2 % of a step off."""
RIGHT: dict[str, tuple[Any, Any]] = {
    "both": (table(), (2e-6, 3e-6)),
    "turned": (table().T, (2e-6, 3e-6)),
    "single precision": (table(X.astype(np.float32), None), (2e-6, 3e-6)),
    "rounded": (table(ROUNDED, None), (1 / 3, 3e-6)),
    "x alone": (table(y=None), (2e-6, 7.0)),
    "y alone": (table(x=None), (7.0, 3e-6)),
    "no coordinates": (table(None, None), 7.0),
    "numbers of samples": (table(np.arange(12), np.arange(10) + 1), 1e-6),
    "in micrometres": (table(1e6 * X, 1e6 * (Y - 1), "µm"), (2e-6, 3e-6)),
    "all in millimetres": (table(1e3 * X, 1e3 * (Y - 1), "mm"), (2e-3, 3e-3)),
    "words": (table(None, [f"row {k}" for k in range(10)]), 7.0),
    "other names": (table().rename(x="row", y="column"), (2e-6, 3e-6)),
}
WRONG: dict[str, tuple[Any, Any, str]] = {
    "one spacing for two": (table(), 2e-6, "spacing along y must be .* 0.000003.*, got 2e-6|2"),
    "x": (table(), (1e-6, 3e-6), "spacing along x must be that of the coordinates of heights"),
    "turned": (table().T, (3e-6, 2e-6), "spacing along x must be that of the coordinates"),
    "x alone": (table(y=None), (1e-6, 3e-6), "spacing along x must be"),
    "one per cent": (table(y=None), (2.02e-6, 3e-6), "spacing along x must be"),
    "one in ten thousand": (table(y=None), (2.0002e-6, 3e-6), "spacing along x must be"),
    "micrometres": (table(1e6 * X, None, "um"), (2e-5, 1.0), "spacing along x must be"),
    "two samples": (table()[:2], (1e-6, 3e-6), "spacing along x must be"),
    "falling": (table()[::-1], (2e-6, 3e-6), r"ascending coordinates x.*sortby\(.x.\)"),
    "falling rows of an image": (table().T[::-1], (2e-6, 3e-6), "ascending coordinates y"),
    "falling numbers": (table(np.arange(12)[::-1], None), 1e-6, "ascending coordinates x"),
    "twice": (table(np.repeat(X[:6], 2), None), (1e-6, 3e-6), "ascending coordinates x"),
    "irregular": (table(X**2, None), (2e-6, 3e-6), "coordinates x at equal distances.*interpolate"),
    "a gap": (table(X + 2e-6 * (np.arange(12) > 6), None), (2e-6, 3e-6), "equal distances"),
    "not a number": (table(np.where(X > 1e-5, np.nan, X), None), 2e-6, "ascending coordinates x"),
    "other names": (table().rename(x="row", y="column"), (1e-6, 3e-6), "spacing along row"),
}


@pytest.mark.parametrize("periodic", [(False, False), (True, True)])
@pytest.mark.parametrize("name", RIGHT)
def test_a_spacing_that_is_that_of_the_coordinates(name: str, periodic: tuple[bool, bool]) -> None:
    heights, spacing = RIGHT[name]
    found = nacre.HeightMap(heights, spacing, periodic=periodic)
    assert found == nacre.HeightMap(HEIGHTS, spacing, periodic=periodic)


@pytest.mark.parametrize("periodic", [(False, False), (True, True)])
@pytest.mark.parametrize("name", WRONG)
def test_a_spacing_that_contradicts_the_coordinates(name: str, periodic: tuple[bool, bool]) -> None:
    heights, spacing, message = WRONG[name]
    with pytest.raises(ValueError, match=message):
        nacre.HeightMap(heights, spacing, periodic=periodic)


def test_maps_on_a_grid_ascend_too() -> None:
    grid, steel = nacre.Grid((12, 10), (24e-6, 30e-6)), nacre.Elastic(2e11, 0.3)
    options: dict[str, Any] = {"grid": grid, "load": 0.01}
    hardness = 1e9 + 1e14 * table()
    quiet(nacre.solve, nacre.Sphere(1e-3), steel, hardness=hardness, **options)
    with pytest.raises(ValueError, match="hardness must have ascending coordinates y"):
        nacre.solve(nacre.Sphere(1e-3), steel, hardness=hardness[:, ::-1], **options)  # type: ignore[arg-type]
