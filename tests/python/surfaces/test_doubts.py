"""Where a file leaves a choice, readers take the only certain one, or list what there is."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import scipy.io

import nacre

Arrays = dict[str, np.ndarray[Any, Any]]


def hdf5(path: Path, arrays: Arrays) -> None:
    with h5py.File(path, "w") as file:
        for name, values in arrays.items():
            file[f"scan/{name}"] = values


ARCHIVES: dict[str, Callable[[Path, Arrays], None]] = {
    "h5": hdf5,
    "npz": lambda path, arrays: np.savez(path, **arrays),  # type: ignore[arg-type]
    "mat": lambda path, arrays: scipy.io.savemat(path, arrays),
}
HEIGHTS = 1e-9 * np.random.default_rng(3).standard_normal((16, 12))
ONE: Arrays = {"height": HEIGHTS, "count": np.arange(3)[:, None, None]}
TWO: Arrays = {"error": HEIGHTS.round(9), "height": HEIGHTS}


@pytest.mark.parametrize("ending", ARCHIVES)
def test_of_two_arrays_one_is_named(ending: str, tmp_path: Path) -> None:
    options: dict[str, Any] = {"unit": "m", "spacing": 1e-7, "detrend": "none"}
    ARCHIVES[ending](tmp_path / f"one.{ending}", ONE)
    one = nacre.HeightMap.read(tmp_path / f"one.{ending}", **options)
    np.testing.assert_array_equal(one.heights, HEIGHTS)
    path = tmp_path / f"two.{ending}"
    ARCHIVES[ending](path, TWO)
    message = r"channel must be given, as one of 0 '.*error' \(16 x 12, no unit\), 1 '.*height'"
    with pytest.raises(ValueError, match=message):
        nacre.HeightMap.read(path, **options)
    assert nacre.HeightMap.read(path, channel=1, **options) == one
    name = "scan/height" if ending == "h5" else "height"
    assert nacre.HeightMap.read(path, channel=name, **options) == one
