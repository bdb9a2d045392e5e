"""Counts that need more memory than there is are refused by name."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import nacre
from nacre import bearing, rough

STEEL = nacre.Elastic(210e9, 0.3)
LINE: dict[str, Any] = {
    "grid": nacre.Grid.line(64, 3e-4),
    "load": 1e5,
    "friction": 0.3,
    "direction": "+y",
}


@pytest.mark.parametrize("count", [2**40, 2**62, np.uint64(2**63)])
@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("cells", lambda n: nacre.creep_coefficients(STEEL, None, semi_axes=(1e-3, 1e-3), cells=n)),
        ("cells", lambda n: nacre.roll(nacre.Cylinder(5e-3), STEEL, STEEL, cells=n, **LINE)),
        ("count", bearing.edge_factors),
        (
            "shape",
            lambda n: rough.random_surface(
                (int(n), 64),
                (1.0, 1.0),
                hurst=0.8,
                shortest=0.1,
                longest=0.5,
                rms_slope=0.1,
            ),
        ),
    ],
    ids=["creep", "roll", "laminae", "rough"],
)
def test_counts_ask_for_memory(name: str, call: Callable[[object], object], count: int) -> None:
    with pytest.raises(MemoryError, match=f"{name}.*needs about .* MiB"):
        call(count)
