"""What is printed with a unit is the number, read back with that unit."""

from __future__ import annotations

import asyncio
import importlib
import re
import sys
import threading
from collections import Counter
from collections.abc import Iterator

import numpy as np
import pytest

import nacre
from nacre._tools.units import Scale, symbol, system, written
from nacre.bearing import CylindricalRoller
from nacre.results.parameters import VALUES
from nacre.results.values import LATE, RESULTS

# Read by hand here, apart from the code that writes: units of SI in newtons, metres and others.
PREFIX = {"": 1.0, "p": 1e-12, "n": 1e-9, "µ": 1e-6, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9}
UNITS = {"N": {"N": 1}, "m": {"m": 1}, "Pa": {"N": 1, "m": -2}, "J": {"N": 1, "m": 1}}
UNITS |= {"s": {"s": 1}, "rad": {"rad": 1}, "million": {}, "revolutions": {"revolution": 1}}
UNITS |= {"W": {"N": 1, "m": 1, "s": -1}, "K": {"K": 1}}
IMPERIAL = {"lbf": (4.4482216152605, {"N": 1}), "in": (0.0254, {"m": 1})}
IMPERIAL |= {"psi": (4.4482216152605 / 0.0254**2, {"N": 1, "m": -2})}
SYSTEMS = {
    "SI": (1.0, 1.0),
    "N-mm-MPa": (1.0, 1e-3),
    "mN-µm-GPa": (1e-3, 1e-6),
    "lbf-in-psi": (4.4482216152605, 0.0254),
}
"""Newtons and metres in the units of force and length of each system."""


def one(factor: str) -> tuple[float, Counter[str]]:
    """Return size and dimensions of a unit with a prefix and a power."""
    power = {"²": 2, "³": 3, "⁴": 4}.get(factor[-1], 1)
    name = factor.rstrip("²³⁴")
    if name == "1":
        return 1.0, Counter()
    if name in IMPERIAL:
        size, dimensions = IMPERIAL[name]
    else:
        base = next(unit for unit in sorted(UNITS, key=len)[::-1] if name.endswith(unit))
        size, dimensions = PREFIX[name.removesuffix(base)], UNITS[base]
    return size**power, Counter({unit: power * count for unit, count in dimensions.items()})


def read(unit: str) -> tuple[float, Counter[str]]:
    """Return size and dimensions of a product or quotient of units."""
    above, _, below = unit.partition("/")
    size, dimensions = 1.0, Counter[str]()
    for factor in above.split():
        number, counts = one(factor)
        size *= number
        dimensions.update(counts)
    for factor in filter(None, below.split("/")):
        number, counts = one(factor)
        size /= number
        dimensions.subtract(counts)
    return size, Counter({unit: count for unit, count in dimensions.items() if count})


def all_units() -> Iterator[str]:
    """Yield the units of all quantities, and of parameters."""
    for module in LATE:
        importlib.import_module(module)
    for kind in RESULTS.values():
        for row in kind._QUANTITIES:
            yield from (row.unit, row.line or "", *(row.rolling or ()))
    yield from (*VALUES.values(), "Pa/m", "J/m³", "1/Pa", "m⁴")


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("unit", sorted({*all_units()} - {""}))
def test_every_unit_is_read_back_to_the_digits_that_are_printed(unit: str, name: str) -> None:
    force, length = SYSTEMS[name]
    _, dimensions = read(unit)
    own = force ** dimensions["N"] * length ** dimensions["m"]
    with nacre.display_units(name):
        size, in_heading = read(symbol(unit))
        assert size == pytest.approx(own, rel=1e-12)
        assert in_heading == dimensions
    for power in (-13, -10, -7, -4, -1, 2, 5, 10):
        value = 4.3627 * 10.0**power
        for number in (value, -value):
            with nacre.display_units(name):
                text, scale = written(number, unit), Scale.of(number, unit)
                data = Scale.in_unit(number, symbol(unit))
            digits, printed = text.split(" ", 1)
            size, counts = read(printed)
            assert counts == dimensions, text
            # Four digits are printed: half of the last one is 5e-4 at most of the number.
            assert float(digits) * size == pytest.approx(number * own, rel=5e-4), text
            for one_scale in (scale, data):
                size, counts = read(one_scale.unit)
                assert counts == dimensions
                assert one_scale.factor * size == pytest.approx(own, rel=1e-12)


def test_the_stiffness_of_springs_is_in_the_units_that_are_set() -> None:
    spring = nacre.Spring(1e7, 1e6)  # MPa/mm
    body = nacre.HalfSpace(
        nacre.Elastic(210e3, 0.3), [nacre.Layer(nacre.Elastic(4e5, 0.3), 2e-3, spring)]
    )
    solution = nacre.solve(nacre.Sphere(5.0), body, load=20.0)
    with nacre.display_units("N-mm-MPa"):
        found = re.search(
            r"springs: normal (\S+) (\S+), tangential (\S+) (\S+)$", str(solution), re.M
        )
    assert found
    for number, unit, stiffness in ((found[1], found[2], 1e7), (found[3], found[4], 1e6)):
        # 1 MPa/mm is 1e9 Pa/m.
        assert float(number) * read(unit)[0] == pytest.approx(1e9 * stiffness, rel=1e-12)


def test_dissipation_of_rolling_per_area_is_read_back() -> None:
    steel, grid = nacre.Elastic(210e9, 0.3), nacre.Grid.line(48, 2.4e-4)
    rolling = nacre.roll(
        nacre.Cylinder(5e-3), steel, steel, grid=grid, load=3e4, friction=0.3, creepage=(3e-4, 0.0)
    )
    assert 0.0 < rolling.dissipated < 1.0  # J/m²: below 1 it has a prefix
    found = re.search(r"^dissipated +(\S+) (\S+)", str(rolling), re.MULTILINE)
    assert found
    assert float(found[1]) * read(found[2])[0] == pytest.approx(rolling.dissipated, rel=5e-4)


# Threads and tasks.


def test_units_of_a_block_hold_in_its_thread_alone() -> None:
    """Each thread waits within its block until the other has looked."""
    inside, looked = threading.Barrier(2, timeout=60), threading.Barrier(2, timeout=60)
    texts: dict[str, str] = {}

    def work(name: str) -> None:
        with nacre.display_units(name):
            inside.wait()
            texts[name] = written(2.0, "m")
            looked.wait()

    threads = [threading.Thread(target=work, args=(name,)) for name in ("N-mm-MPa", "lbf-in-psi")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert texts == {"N-mm-MPa": "2 mm", "lbf-in-psi": "2 in"}
    assert written(2.0, "m") == "2 m"


def test_statements_of_the_main_thread_hold_in_others_and_theirs_only_in_them() -> None:
    texts = []

    def work() -> None:
        texts.append(written(2.0, "m"))
        nacre.display_units("lbf-in-psi")
        texts.append(written(2.0, "m"))

    nacre.display_units("N-mm-MPa")
    try:
        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        assert texts == ["2 mm", "2 in"]
        assert written(2.0, "m") == "2 mm"
    finally:
        nacre.display_units("SI")


def test_a_statement_within_a_block_ends_with_it() -> None:
    with nacre.display_units("N-mm-MPa"):
        nacre.display_units("lbf-in-psi")
        with nacre.display_units("SI"):
            assert symbol("m") == "m"
        assert symbol("m") == "in"
    assert system().name == "SI"
    again = nacre.display_units("N-mm-MPa")
    nacre.display_units("SI")
    for _ in range(2):
        with again, again:
            assert symbol("m") == "mm"
        assert symbol("m") == "m"


def test_tasks_have_their_own_units() -> None:
    async def work(name: str, inside: asyncio.Barrier) -> str:
        with nacre.display_units(name):
            await inside.wait()
            return symbol("m")

    async def both() -> list[str]:
        inside = asyncio.Barrier(2)
        return await asyncio.gather(work("N-mm-MPa", inside), work("SI", inside))  # type: ignore[return-value]

    assert asyncio.run(both()) == ["mm", "m"]
    assert symbol("m") == "m"


def test_printing_a_bearing_changes_the_units_of_no_other_thread() -> None:
    """The other thread prints at least once between any two looks."""
    arguments = {"count": 14, "diameter": 10e-3, "length": 9.6e-3, "pitch_diameter": 65e-3}
    ring = CylindricalRoller(**arguments).solve(force=(5e3, 0.0, None), model="iso16281")  # type: ignore[arg-type]
    stop, prints, texts = threading.Event(), threading.Semaphore(0), set()

    def work() -> None:
        while not stop.is_set():
            texts.add(str(ring))
            prints.release()

    expected, interval = str(ring), sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    thread = threading.Thread(target=work)
    try:
        with nacre.display_units("N-mm-MPa"):
            thread.start()
            for _ in range(20):
                assert prints.acquire(timeout=60)
                assert {written(2.0, "m") for _ in range(200)} == {"2 mm"}
    finally:
        stop.set()
        thread.join()
        sys.setswitchinterval(interval)
    assert texts == {expected}


def test_a_study_of_bearings_is_in_si_whatever_units_are_set() -> None:
    arguments = {"count": 14, "diameter": 10e-3, "length": 9.6e-3, "pitch_diameter": 65e-3}
    case = {
        "bearing": CylindricalRoller(**arguments),  # type: ignore[arg-type]
        "force": (5e3, 0.0, None),
        "model": "iso16281",
    }
    with nacre.display_units("N-mm-MPa"):
        study = nacre.sweep(case, {"force[0]": [4e3, 5e3]}, progress=False)
        assert symbol("m") == "mm"
    assert study["peak_pressure"].attrs["units"] == "Pa"
    assert study.attrs["unit_system"] == "SI"
    assert np.all(study["peak_pressure"].values > 1e8)
