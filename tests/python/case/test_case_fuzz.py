"""Wrong values at every key of case files are errors of one line that name the file and the key."""

from __future__ import annotations

import datetime
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nacre.case import Case, CaseError

MATERIAL = {"young": 210e9, "poisson": 0.3, "yield_stress": 1e9, "strength": 2e9}
LAYER = {"material": "steel", "thickness": 1e-5, "interface": "bonded", "name": "DLC"}
SHAPES: list[dict[str, Any]] = [
    {"kind": "sphere", "radius": 5e-3, "shift": [0.0, 1e-6]},
    {"kind": "roller", "radius": 5e-3, "flat_length": 1e-3, "crown_radius": 1.0, "length": 2e-3},
    *(
        {"kind": "roller", "radius": 5e-3, "profile": profile}
        for profile in (
            {"kind": "logarithmic", "amplitude": 1e-6, "length": 2e-3, "flat_length": 1e-3},
            {"kind": "lundberg", "length": 2e-3, "load": 10.0, "contact_modulus": 1e11},
            {
                "kind": "johns_gohar",
                "length": 2e-3,
                "load": 10.0,
                "contact_modulus": 1e11,
                "radius": 5e-3,
            },
            {"kind": "iso16281", "diameter": 1e-2, "length": 2e-3},
            {"kind": "sampled", "x": [0.0, 1e-3], "drop": [0.0, 1e-6]},
        )
    ),
    {"kind": "height_map", "path": "a.npy", "spacing": [1e-6, 1e-6], "detrend": "none"},
    {
        "kind": "sum",
        "parts": [{"kind": "cylinder", "radius": 1.0}, {"kind": "sphere", "radius": 1}],
    },
]
CASE: dict[str, Any] = {
    "units": "N-m-Pa",
    "materials": {"steel": MATERIAL, "dlc": MATERIAL},
    "shape": SHAPES[0],
    "body": {"substrate": "steel", "layers": [LAYER, {**LAYER, "material": MATERIAL}]},
    "counterbody": {"substrate": MATERIAL, "layers": [LAYER]},
    "grid": {"shape": [16, 16], "size": [1e-4, 1e-4], "center": [0.0, 0.0]},
    "solve": {
        "load": 10.0,
        "eccentricity": {"x": 1e-6},
        "tilt": [0.0, 0.0],
        "threads": 1,
        "tolerance": 1e-8,
        "max_iterations": 10,
        "algorithm": "cascade",
    },
    "stress": {"body": "body", "friction": 0.1, "direction": [1.0, 0.0]},
    "sweep": {
        "parameters": {
            "solve.load": [1.0, 2.0],
            "materials.dlc.young": {"first": 1e9, "last": 2e9, "count": 3, "scale": "log"},
        },
        "outputs": ["load", "von_mises"],
        "store": "a.nc",
    },
}
WRONG: list[Any] = [
    *("", "x", "rigid", -1, 0, 1, 10**400, -1.5, 1e308, 5e-324, float("nan"), float("inf")),
    *(True, [], [1], [1, "a"], [[1.0]], [{}], {}, {"x": 1}, {"kind": 3}, {"kind": [1]}),
    *(["a"] * 200, {"": {}}, datetime.date(2026, 1, 1), datetime.time(1), "é\n\x00\u2028", "a.npy"),
]
FOREIGN = re.compile(
    r"pydantic|Input |instance of|valid dict|should be|__init__|\(\) (got|missing)|Traceback|object"
    r"|NoneType|keyword argument|Sequence|<class|Freedoms"
)


def places(data: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the paths of all values."""
    items = data.items() if isinstance(data, dict) else enumerate(data)
    for key, value in items:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


def changed(case: dict[str, Any], path: tuple[Any, ...], value: Any) -> dict[str, Any]:
    """Return a case with another value at a path; without that key for `...`."""
    found: dict[str, Any] = json.loads(json.dumps(case))  # no table stands in two places
    table: Any = found
    for key in path[:-1]:
        table = table[key]
    if value is ...:
        del table[path[-1]]
    else:
        table[path[-1]] = value
    return found


def cases() -> Iterator[tuple[dict[str, Any], tuple[Any, ...]]]:
    """Yield cases that are wrong in one place, or right."""
    for number, shape in enumerate(SHAPES):
        whole = CASE | {"shape": shape}
        for path in places(whole):
            if number and path[0] != "shape":
                continue  # what is not the shape is varied once
            for value in (*WRONG, ...):
                yield changed(whole, path, value), path
            if isinstance(path[-1], str):
                yield changed(whole, (*path[:-1], f"{path[-1]}s"), 1), path


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")
def test_an_error_is_one_line_that_names_file_and_key(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.random.default_rng(1).normal(size=(8, 8)))
    count = errors = 0
    for data, path in cases():
        count += 1
        try:
            case = Case(data, "file.toml", tmp_path)
            case.arguments()
            case.stress()
            if "sweep" in data:
                case.study()
        except CaseError as error:
            errors += 1
            said = str(error)
            assert said.startswith("file.toml: "), said
            assert len(said) < 900, said
            assert len(said.splitlines()) == 1, repr(said)
            assert not FOREIGN.search(said), said
            # The key at fault, or the one that lacks what was changed.
            assert re.search(rf"\b{re.escape(str(path[0]))}\b|key is missing|materials", said), said
    assert count > 3000
    assert errors > 0.6 * count
