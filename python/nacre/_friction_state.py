"""State of a contact with friction in a file: its arrays, their checksum, and back."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

import nacre._core as core

Array = npt.NDArray[np.float64]

NORMAL = ("pressure", "gap", "displacement")
"""Fields of the normal contact; the last is called normal_displacement in Datasets."""
VECTORS = ("traction", "displacement", "slip")
"""Fields with components along x and y."""


def named(name: str) -> str:
    """Return the name in a Dataset of a field of the normal contact."""
    return "normal_displacement" if name == "displacement" else name


def checksum(state: str, arrays: Mapping[str, Array]) -> str:
    """Return the SHA-256 of a state and its arrays."""
    digest = hashlib.sha256(state.encode())
    for name in sorted(arrays):
        digest.update(np.ascontiguousarray(arrays[name], dtype="<f8").tobytes())
    return digest.hexdigest()


def restored(
    state: Mapping[str, Any], written: str, found: object, arrays: Mapping[str, Array]
) -> core.FrictionSolution:
    """Return the solution of a file: its state, its text and checksum there, and its arrays.

    Raises
    ------
    ValueError
        If an array is missing, or the content is not what was saved.
    """
    names = [*VECTORS, *map(named, NORMAL)]
    if "friction" not in state:
        names.append("friction")
    if missing := [name for name in names if name not in arrays]:
        raise ValueError(f"the variable {missing[0]} is missing")
    kept = {name: arrays[name] for name in names}
    version = state.get("format")
    is_newer = isinstance(version, int) and version > core._FORMAT  # `from_dict` says so
    if not is_newer and found != checksum(written, kept):
        raise ValueError("its content is not what was saved: it was changed or damaged")
    normal = dict(state["normal"]) | {name: kept[named(name)] for name in NORMAL}
    whole = dict(state) | {name: kept[name] for name in VECTORS} | {"normal": normal}
    if "friction" in kept:
        whole["friction"] = kept["friction"]
    return core.FrictionSolution.from_dict(whole)
