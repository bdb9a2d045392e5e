"""Each row of README's table "to do this | write" runs on README's own roller, in seconds."""

import contextlib
import re
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
import nacre.bearing
import nacre.design
import nacre.indent
import nacre.verify
from support import ROOT, command

README = (ROOT / "README.md").read_text(encoding="utf-8")
SECONDS = 3.0
"""Processor time of a row, as README has it."""
CELLS = "grid=nacre.Grid((64, 32), (30e-3, 160e-6))"
"""Cells over the whole roller, and over twice the width of the contact."""
PRESSED = f"roller, body, load=1e3, {CELLS}"
RUBBED = f"roller, body, body, load=1e3, {CELLS}"
PROFILE = (
    '{"shape": roller, "body": body}, {"shape.crown_radius": 7.5}, objective="peak_pressure",'
    f' cases=[{{"load": 1e3}}], bounds={{"shape.crown_radius": (5.0, 10.0)}}, {CELLS}'
)
STUDY = (
    f"dict(shape=roller, body=body, load=1e3, {CELLS}),"
    ' {"body.layers[0].thickness": [20e-6, 40e-6]}'
)
BEARING = "count=14, diameter=10e-3, length=30e-3, pitch_diameter=65e-3, outer=body"
ROWS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "draw the": ((), ("values[0]['map'].dataLim.bounds",)),
    "compute stresses": ((), ("values[0].von_mises",)),
    "find the": ((), ("[peak.von_mises[0] for peak in values[0].layers]",)),
    "slide or": (
        (RUBBED, '{"force": (0, 100.0)}', RUBBED),
        ("values[0][-1].shift", "values[1].force"),
    ),
    "compute wear": ((PRESSED,), ("values[0].worn_volume", "values[0].events[0].position")),
    "save the": (
        ("1e-5, 1e-4",),
        ("nacre.load('roller.nc').pressure", "Path('roller.vtr').stat().st_size"),
    ),
    "run a": ((STUDY,), ("values[0].peak_pressure",)),
    "solve a bearing": (
        (BEARING, "force=(0, 3e3, None), cells=(40, 8)"),
        ("values[0].loads", "values[0].peak_pressures", "values[0].displacement"),
    ),
    "compute indentation": (
        ("body, tip", "(depths, curve.load), softer, tip, [young]"),
        ("values[1].estimates[young] / 420e9",),
    ),
    "differentiate a": (
        ('"peak_pressure"', PROFILE),
        ("list(values[0].values())", "list(values[1].values.values())"),
    ),
    "read a": ((), ("values[0].heights",)),
}
"""What stands for each `…` of the rows that are Python, and numbers that the calls return.

Keys are the words with which a row begins."""
COMMANDS = {
    "assess a": ("nacre app",),
    "solve a case": ("nacre new", "nacre new bearing case.toml", "nacre solve case.toml"),
    "compare the": ("nacre verify",),
}
"""Rows of commands."""


def rows() -> list[tuple[str, list[str]]]:
    """README's table: what is done, and what is written, as pieces of code."""
    table = README.partition("| to do this | write |\n|---|---|\n")[2].partition("\n\n")[0]
    cells = [line.strip("| ").split(" | ", 1) for line in table.splitlines()]
    return [(task, re.findall(r"`([^`]+)`", write)) for task, write in cells]


@pytest.fixture(scope="module")
def names() -> dict[str, Any]:
    """README's own program, on fewer cells, and what the rows name beside it."""
    (program,) = re.findall(r"^```python\n(.*?)^```", README, flags=re.MULTILINE | re.DOTALL)
    found: dict[str, Any] = {"Path": Path, "z": 1e-4, "young": "body.layers[0].material.young"}
    exec(program.replace("load=1e3,", f"load=1e3, {CELLS},"), found)
    softer = nacre.Layer(nacre.Elastic(young=300e9, poisson=0.3), 40e-6, name="DLC")
    tip, depths = nacre.indent.Tip.paraboloid(1e-3), np.linspace(0.1e-6, 2e-6, 20)
    found |= {"tip": tip, "depths": depths, "print": lambda value: (str(value), value)[1]}
    found["softer"] = nacre.HalfSpace(found["steel"], layers=[softer])
    found["curve"] = nacre.indent.Indentation(found["body"], tip).curve(approach=depths)
    return found


def filled(code: list[str], filling: tuple[str, ...]) -> list[str]:
    """Put what is missing in the place of each `…`, in order."""
    parts = iter(filling)
    whole = [re.sub("…", lambda _: next(parts), call) for call in code]
    assert list(parts) == []
    return whole


@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # the cells are coarse
@pytest.mark.parametrize("words", ROWS)
def test_a_row_runs_on_the_roller(words: str, names: dict[str, Any], tmp_path: Path) -> None:
    ((_, code),) = (row for row in rows() if row[0].startswith(words))
    filling, numbers = ROWS[words]
    heights = np.random.default_rng(1).normal(0.0, 1e-7, (16, 16))
    head = "unit: m\nspacing: 1e-6 1e-6"
    np.savetxt(tmp_path / "surface.csv", heights, delimiter=",", header=head)
    with contextlib.chdir(tmp_path):
        began = time.process_time()
        values = [eval(call, names) for call in filled(code, filling)]
        taken = time.process_time() - began
        for number in numbers:
            value = np.asarray(eval(number, names, {"values": values}), dtype=float)
            assert value.size > 0, number
            assert np.isfinite(value).all(), number
            assert np.any(value != 0), number
    assert taken < SECONDS


@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")
@pytest.mark.parametrize("words", COMMANDS)
def test_a_row_of_commands_runs(
    words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ((task, code),) = (row for row in rows() if row[0].startswith(words))
    assert tuple(code) == COMMANDS[words]
    began = time.process_time()
    with contextlib.chdir(tmp_path):
        for line in code:
            arguments = line.split()[1:]
            if arguments == ["app"]:
                arguments.append("--help")  # it serves until it is stopped
            assert command(*arguments) == 0
    assert time.process_time() - began < SECONDS
    printed = capsys.readouterr().out
    assert "nan" not in printed
    if "nacre verify" in code:
        (count,) = re.findall(r"\d+", task)
        assert len(printed.splitlines()) > int(count) == len(list(nacre.verify.rows()))


def test_every_row_is_tried() -> None:
    for task, _ in rows():
        assert sum(task.startswith(words) for words in [*ROWS, *COMMANDS]) == 1, task
    assert len(rows()) == len(ROWS) + len(COMMANDS)
    assert f"less than {SECONDS:g} s on one core" in README
