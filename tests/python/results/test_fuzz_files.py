"""Damaged and hostile files: an error or the same values, soon, in little memory.

A few mutations of each kind of file that are the same in every run; ``make fuzz`` tries many
others. They run in processes of their own, which can be ended: HDF5 may hang beyond any signal.
"""

from __future__ import annotations

import io
import json
import os
import random
import sys
import time
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
import pytest

import nacre
import results
from bodies import BALL, STEEL, quiet
from nacre.case import Case
from support import ASKED, HANG, python, sealed

STATE, SEAL = "nacre_solution", 48
"""Attribute of the state in a file, and bytes of the seal after it."""
COUNT = int(ASKED) if ASKED else 25
SECONDS = 20.0
"""Most time of the processor for one file of some kilobytes."""
MEMORY = 100_000_000
"""Most bytes beyond those of the file."""

GRID = nacre.Grid((16, 12), (3e-4, 2e-4))
CASE = """
[materials]
steel = { young = 210e9, poisson = 0.3 }

[shape]
kind = "sphere"
radius = 5e-3

[body]
substrate = "steel"
layers = [{ material = { young = 3e9, poisson = 0.4 }, thickness = 1e-6 }]

[solve]
load = 10

[sweep]
store = "study.nc"
parameters."solve.load" = { first = 1, last = 100, count = 3, scale = "log" }
"""


RESULTS = ("infinite gaps", "yielded", "cells, coupled", "sticky", "fit")


class Kind(NamedTuple):
    """A kind of file."""

    name: str
    """Name of a file."""
    write: Callable[[Path], object]
    read: Callable[[Path], Any]
    exact: bool = False
    """Whether damage is found, so that what is read is what was written."""


def plain(found: Any) -> str:
    """Return a text that tells every number of a result."""
    state = found.to_dict()
    return str(
        {name: np.asarray(v).tolist() if name != "normal" else v for name, v in state.items()}
    )


def swept(path: Path) -> Any:
    """Return a study, of which the journal is read where there is one."""
    case, store = {"shape": BALL, "body": STEEL, "grid": GRID}, path.with_suffix(".nc")
    return quiet(nacre.sweep, case, {"load": [1.0, 2.0, 4.0]}, store=store, progress=False)


def heights(path: Path) -> nacre.HeightMap:
    given: dict[str, Any] = {"unit": "nm"} if path.suffix == ".xyz" else {"spacing": 1e-6}
    return nacre.HeightMap.read(path, **given)


def described(path: Path) -> object:
    case = Case.read(path)
    return case.arguments(), case.study()


def saved(name: str, path: Path) -> None:
    results.solved(name).save(path)


ROUGH = np.random.default_rng(1).normal(size=(8, 6)) * 1e-8
POINTS = "".join(f"{2.5 * i} {2.5 * j} {z * 1e9:.3f}\n" for (i, j), z in np.ndenumerate(ROUGH))
TABLE = "# unit: nm\n# spacing: 1, 2\n" + "".join(
    "; ".join(f"{z * 1e9:.4f}".replace(".", ",") for z in row) + "\n" for row in ROUGH
)
CURVE = 'Test,"A 1"\n"Depth (nm)","Load, mN",Time_s\n' + "".join(
    f"{k},{k**1.5:.3f},{k / 10}\n" for k in range(40)
)

KINDS = {
    **{name: Kind("a.nc", partial(saved, name), nacre.load, exact=True) for name in RESULTS},
    "study": Kind("a.nc", swept, nacre.load, exact=True),
    "journal": Kind("a.journal", swept, swept),
    "npy": Kind("a.npy", lambda path: np.save(path, ROUGH), heights),
    "csv": Kind("a.csv", lambda path: path.write_text(TABLE), heights),
    "xyz": Kind("a.xyz", lambda path: path.write_text(POINTS), heights),
    "curve": Kind("a.txt", lambda path: path.write_text(CURVE), nacre.indent.read),
    "case": Kind("a.toml", lambda path: path.write_text(CASE), described),
}


def mutated(whole: bytes, how: random.Random) -> bytes:
    """Return a file with flipped bits, cut, or with a part that is left out, repeated or long."""
    content = bytearray(whole)
    place = how.randrange(len(whole))
    other = how.randrange(place, min(len(whole), place + 200))
    kind = how.randrange(6)
    if kind <= 1:
        for _ in range(how.choice((1, 1, 1, 8))):
            content[how.randrange(len(whole))] ^= 1 << how.randrange(8)
    elif kind == 2:
        del content[place:]
    elif kind == 3:
        del content[place : other + 1]
    elif kind == 4:
        content[place:place] = content[place : other + 1] * how.choice((1, 100))
    else:
        piece = how.choice(
            (b"1", b"9", b" ", b"_", b"(", b"[", b'"', b",", b"\0", b"\n", b"1e", b"a ")
        )
        content[place:place] = piece * how.choice((1, 500, 50_000))
    return bytes(content)


def main(name: str, count: int, seed: int, folder: Path) -> None:
    """Read mutations of a file, and assert how many are refused, and the largest costs."""
    import resource

    warnings.simplefilter("ignore")
    kind = KINDS[name]
    path = folder / kind.name
    kind.write(path)
    whole = path.read_bytes()
    right: Any = None if name == "study" else kind.read(path)
    how = random.Random(seed)
    refused, longest, slowest = 0, 0, 0.0
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for number in range(count):
        content = mutated(whole, how)
        path.write_bytes(content)
        print(name, number, file=sys.stderr, flush=True)
        start = time.process_time()
        try:
            found = kind.read(path)
        except (ValueError, OSError) as error:
            refused += 1
            longest = max(longest, len(str(error)))
        else:
            if kind.exact:
                assert plain(found) == plain(right)
            if name == "journal":
                assert found.identical(right)
        slowest = max(slowest, time.process_time() - start)
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    memory = (after - before) * (1 if sys.platform == "darwin" else 1024)
    assert slowest < SECONDS, slowest
    assert memory < MEMORY, memory
    assert longest < 5000, longest  # characters of an error
    if kind.exact:
        assert refused >= 0.99 * count, refused  # all but changes to nothing


@pytest.mark.skipif(sys.platform == "win32", reason="no measure of the memory")
def test_a_damaged_file_is_refused_or_read_soon(tmp_path: Path) -> None:
    seed = random.randrange(1 << 30) if ASKED else 1
    seconds = HANG + len(KINDS) * SECONDS * COUNT
    path = {"PYTHONPATH": os.pathsep.join(sys.path)}  # bodies and support are beside this folder
    done = python(
        *(__file__, COUNT, seed, tmp_path, *KINDS), timeout=seconds, env=os.environ | path
    )
    assert (done.returncode, done.stdout.splitlines()) == (0, [*KINDS]), (seed, done.stderr[-3000:])


# Files with a right seal.


def bombs() -> dict[str, Callable[[h5py.File, Path], object]]:
    large = 1 << 28  # 2 GB of real numbers
    sources = h5py.VirtualLayout((4, 4), "f8")
    return {
        "packed": lambda file, _: file.create_dataset(
            "pressure", (large,), "f8", chunks=(1 << 24,), compression=9
        ),
        "never written": lambda file, _: file.create_dataset("pressure", (large,), "f8"),
        "other numbers": lambda file, _: file.create_dataset("pressure", (4, 4), "i4"),
        "outside": lambda file, folder: file.create_dataset(
            "pressure", (4, 4), "f8", external=[(str(folder / "secret"), 0, 128)]
        ),
        "link": lambda file, _: file.__setitem__("pressure", h5py.SoftLink("/gap")),
        "link outside": lambda file, folder: file.__setitem__(
            "pressure", h5py.ExternalLink(str(folder / "a.nc"), "/gap")
        ),
        "virtual": lambda file, _: file.create_virtual_dataset("pressure", sources),
        "group": lambda file, _: file.create_group("pressure"),
    }


@pytest.mark.parametrize("name", bombs())
def test_arrays_are_read_from_the_file_alone_and_as_large_as_it(name: str, tmp_path: Path) -> None:
    path = results.solved("infinite gaps").save(tmp_path / "a.nc")
    (tmp_path / "secret").write_bytes(bytes(128))
    inner = tmp_path / "inner.nc"
    inner.write_bytes(path.read_bytes())
    with h5py.File(inner, "r+") as file:
        del file["pressure"]
        bombs()[name](file, tmp_path)
    start = time.process_time()
    with pytest.raises(ValueError, match="must be a result that nacre saved: it is no result"):
        nacre.load(sealed(inner.read_bytes(), tmp_path / "b.nc"))
    assert time.process_time() - start < SECONDS


WRONG: list[Any] = [
    *(None, True, 0, -1, 1.5, 10**400, float("nan"), float("inf"), "", "x", "1.5", "rigid"),
    *([], [1], ["a"], [[1.0], [1.0, 2.0]], {}, {"x": 1}, {"kind": []}, {"Elastic": {"young": 1}}),
]


def places(data: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths of all values, of long lists the first ones."""
    items = list(data.items()) if isinstance(data, dict) else list(enumerate(data))[:2]
    found = []
    for key, value in items:
        found.append((*path, key))
        if isinstance(value, dict | list):
            found += places(value, (*path, key))
    return found


def changed(state: Any, place: tuple[Any, ...], value: Any) -> Any:
    """Return a state with another value at a place; without that key for `...`."""
    found: Any = json.loads(json.dumps(state))
    table = found
    for key in place[:-1]:
        table = table[key]
    if value is ...:
        del table[place[-1]]
    else:
        table[place[-1]] = value
    return found


@pytest.mark.parametrize("name", RESULTS)
def test_a_state_with_a_right_seal_is_a_result_or_a_value_error(name: str, tmp_path: Path) -> None:
    result = results.solved(name)
    content = result.save(tmp_path / "a.nc").read_bytes()
    with h5py.File(io.BytesIO(content), "r") as file:
        state = json.loads(file.attrs[STATE])
    places_ = [(place, value) for place in places(state) for value in (*WRONG, ...)]
    random.Random(5).shuffle(places_)
    plain = name in ("sticky", "fit")  # all is in the state, without a file
    refused = 0
    changes = places_ if plain else places_[: 4 * COUNT]
    for number, (place, value) in enumerate(changes):
        wrong = changed(state, place, value)
        try:
            if plain and number >= COUNT:
                found: Any = type(result).from_dict(wrong)
            else:
                memory = io.BytesIO(content[:-SEAL])
                with h5py.File(memory, "r+") as file:
                    file.attrs[STATE] = json.dumps(wrong)
                found = nacre.load(sealed(memory.getvalue(), tmp_path / "b.nc"))
        except ValueError:
            refused += 1
            continue
        assert str(found)
        assert repr(found)
        assert found.to_dict()
        if number < COUNT:
            found.save(tmp_path / "c.nc")
    assert refused > 0.5 * len(changes)


if __name__ == "__main__":
    for kind in sys.argv[4:]:
        own = Path(sys.argv[3], kind)
        own.mkdir()
        child = os.fork()
        if child == 0:
            main(kind, int(sys.argv[1]), int(sys.argv[2]), own)
            os._exit(0)
        if os.waitpid(child, 0)[1] == 0:
            print(kind)
