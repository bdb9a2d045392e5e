"""State of a contact with friction in a file: its arrays, and back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

import nacre._core as core

Array = npt.NDArray[np.float64]

NORMAL = ("pressure", "gap", "displacement", "coefficients")
"""Arrays of the normal contact; the displacement is called normal_displacement in Datasets."""
VECTORS = ("traction", "displacement", "slip")
"""Fields with components along x and y."""


def named(name: str) -> str:
    """Return the name in a Dataset of a field of the normal contact."""
    return "normal_displacement" if name == "displacement" else name


def restored(state: Mapping[str, Any], arrays: Mapping[str, Array]) -> core.FrictionSolution:
    """Return the solution of a file: its state, and its arrays by their names there."""
    whole = {**state, **{name: arrays[name] for name in VECTORS if name in arrays}}
    found = {name: arrays[named(name)] for name in NORMAL if named(name) in arrays}
    whole["normal"] = {**state["normal"], **found}
    if "friction" in arrays:
        whole["friction"] = arrays["friction"]
    return core.FrictionSolution.from_dict(whole)
