"""Histories of wear that go on: from a store after a kill, and from another history."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from support import assert_close, python, taken

STEEL = nacre.Elastic(young=210e9, poisson=0.3)
DLC = nacre.Layer(nacre.Elastic(young=300e9, poisson=0.2), 2e-6, name="DLC")
COATED = nacre.HalfSpace(STEEL, layers=[DLC])
GRID = nacre.Grid.line(64, 6e-4)


def worn(**keywords: Any) -> nacre.types.WearHistory:
    """Return a history of a coated roller whose steps are Euler's, which forget what was before."""
    given: dict[str, Any] = {"shape": nacre.Cylinder(10e-3), "body": COATED, "counterbody": STEEL}
    given |= {"load": 1e5, "grid": GRID, "rate": {0: 1e-17, "substrate": 1e-16}}
    given |= {"sliding": 100.0, "steps": 2, "scheme": "euler"}
    return nacre.wear(**given | keywords)


def test_a_kill_leaves_a_store_that_the_same_call_goes_on_from(tmp_path: Path) -> None:
    """Also on a grid that nacre chooses, whatever of the last line is on the disk."""
    keywords: dict[str, Any] = {"load": 20.0, "rate": 1e-15, "sliding": 0.2, "steps": 2}
    keywords |= {"max_cells": 4096, "scheme": "euler"}
    ball, store = nacre.Sphere(5e-3), tmp_path / "ball.nc"
    whole = nacre.wear(ball, STEEL, **keywords)
    nacre.wear(ball, STEEL, store=store, progress=lambda state: state.distance == 0, **keywords)
    journal = store.with_suffix(".journal")
    lines = journal.read_bytes().splitlines(keepends=True)
    assert len(lines) == 3  # a heading, and the states at 0 and 0.1 m
    store.unlink()
    journal.write_bytes(b"".join(lines)[:-7])
    killed = nacre.load(journal)
    assert [*killed.distance] == [*whole.distance[:1]]
    assert not killed.report.converged
    went_on = nacre.wear(ball, STEEL, store=store, **keywords)
    assert_close(went_on.distance, whole.distance, rtol=1e-14)
    # Solves to 1e-8, in whose energy the pressure counts squared.
    assert_close(went_on.peak_pressure, whole.peak_pressure, rtol=1e-4)
    assert nacre.load(store) == went_on
    assert went_on.report.regrids == whole.report.regrids


def test_the_bytes_of_a_state_do_not_grow(tmp_path: Path) -> None:
    """The journal gains a line for each state, and the store is written once, in the end."""
    store = tmp_path / "store.nc"
    sizes: list[int] = []
    size = lambda _: sizes.append(store.with_suffix(".journal").stat().st_size)  # noqa: E731
    worn(steps=30, store=store, progress=size)
    gains = np.diff(sizes)
    assert len(gains) == 30
    # Lengths of printed numbers differ.
    assert gains.max() < 1.02 * gains.min()


def test_a_store_goes_on_from_a_history_and_from_a_depth(tmp_path: Path) -> None:
    first = worn(sliding=50.0, steps=1)
    for name, initial in (("history", first), ("depth", np.full(GRID.shape, 1e-8))):
        call: dict[str, Any] = {"store": tmp_path / f"{name}.nc", "initial": initial, "load": 2e5}
        base = float(first.distance[-1]) if initial is first else 0.0
        stopped = worn(progress=lambda state, base=base: state.distance < base + 50, **call)
        assert stopped.distance[-1] == base + 50
        went_on, whole = worn(**call), worn(initial=initial, load=2e5)
        assert_close(went_on.distance, whole.distance, rtol=1e-14)
        assert_close(went_on.deepest, whole.deepest, rtol=1e-4)
        assert went_on.inputs == whole.inputs
        assert worn(**call).states == went_on.states
    with pytest.raises(ValueError, match="store must be a history of the same initial"):
        worn(store=tmp_path / "depth.nc", load=2e5, initial=np.full(GRID.shape, 2e-8))


@pytest.mark.skipif(sys.platform == "win32", reason="the lock is another there")
def test_two_processes_do_not_write_one_store(tmp_path: Path) -> None:
    hold = """
import sys, nacre
steel, grid = nacre.Elastic(210e9, 0.3), nacre.Grid.line(64, 6e-4)
wait = lambda state: print("held", flush=True) or sys.stdin.read()
keywords = {"load": 1e5, "rate": 1e-17, "sliding": 1.0, "steps": 1, "grid": grid}
nacre.wear(nacre.Cylinder(1e-2), steel, store="store.nc", progress=wait, **keywords)
"""
    pipe = subprocess.PIPE
    command = [sys.executable, "-c", hold]
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, cwd=tmp_path) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"held\n"
        store = tmp_path / "store.nc"
        with pytest.raises(BlockingIOError, match=taken(store, process.pid, "history of wear")):
            worn(store=store)
        assert not store.exists()
        process.kill()
    # The lock has ended with its process, and what that has kept is there: of another body.
    with pytest.raises(ValueError, match="store must be a history of the same body"):
        worn(store=store)


def test_a_history_that_is_loaded_while_it_is_written_stays_locked(tmp_path: Path) -> None:
    store, refusals = tmp_path / "store.nc", []
    known: list[int] = []
    other = f"""
import nacre
steel, grid = nacre.Elastic(210e9, 0.3), nacre.Grid.line(64, 6e-4)
keywords = {{"load": 1e5, "rate": 1e-17, "sliding": 1.0, "steps": 1, "grid": grid}}
nacre.wear(nacre.Cylinder(1e-2), steel, store={str(store)!r}, **keywords)
"""

    def progress(_: nacre.types.WearState) -> None:
        known.append(len(nacre.load(store.with_suffix(".journal"))))
        if len(known) == 2:
            refusals.append(python("-c", other).stderr.splitlines()[-1])
            with pytest.raises(BlockingIOError, match="this process is running this history"):
                worn(store=store)

    history = worn(store=store, progress=progress)
    assert known == [1, 2, 3]
    (refusal,) = refusals
    assert re.search(taken(store, os.getpid(), "history of wear"), refusal)
    assert worn(store=store).states == history.states


def test_what_is_no_store_of_wear_stays_as_it_is(tmp_path: Path) -> None:
    store = tmp_path / "store.nc"
    content = nacre.solve(nacre.Sphere(5e-3), STEEL, load=1.0).save(store).read_bytes()
    with pytest.raises(ValueError, match="store must be a history of wear, got a Solution"):
        worn(store=store)
    assert store.read_bytes() == content
    assert not store.with_suffix(".journal").exists()
    with pytest.raises(ValueError, match=r"store must end in \.nc"):
        worn(store=tmp_path / "store.csv")
    nacre.sweep(
        {"shape": nacre.Sphere(5e-3), "body": STEEL}, {"load": [1.0]}, store=tmp_path / "a.nc"
    )
    for call in (lambda: worn(store=tmp_path / "b.nc"), lambda: nacre.load(tmp_path / "b.journal")):
        (tmp_path / "b.journal").write_bytes((tmp_path / "a.journal").read_bytes())
        with pytest.raises(ValueError, match="do not describe a WearHistory"):
            call()


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"shape": nacre.Cylinder(1e-1)}, r"shape, Cylinder\(radius=0.1\), got .*radius=0.01"),
        ({"counterbody": nacre.Elastic(70e9, 0.3)}, "counterbody, .*70000000000"),
        ({"counterbody": None}, "counterbody, rigid, got "),
        ({"body": STEEL, "rate": 1e-16}, "body, "),
        ({"thickness": "first order"}, "thickness, first order, got frozen"),
        ({"load": None, "approach": 1e-6}, "load, none, got 100000.0"),
        (
            {
                "sliding": None,
                "cycles": 2.0,
                "slide": {"friction": 0.3, "steps": [{"shift": (None, 1e-7)}]},
            },
            "cycles, 2.0, got none",
        ),
    ],
)
def test_a_history_of_something_else_is_refused(keywords: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=f"initial must be a history of the same .*{message}"):
        worn(initial=worn(steps=1), **keywords)


def test_inputs_of_a_history_that_goes_on_name_both_parts() -> None:
    first = worn(sliding=50.0, steps=1)
    second = worn(sliding=30.0, load=2e5, steps=1, initial=first)
    third = worn(sliding=20.0, load=2e5, counter_rate=1e-18, steps=1, initial=second)
    assert third.inputs["load"] == "100000.0 up to 50 m, then 200000.0"
    assert third.inputs["counter_rate"] == "0.0 up to 80 m, then 1e-18"
    assert third.inputs["sliding"] == "100.0"
    assert third.inputs["body"] == first.inputs["body"]
    # Loads times distances of the parts.
    assert third.volume[-1, 0] == pytest.approx(1e-17 * (50e5 + 50 * 2e5), rel=1e-12)
    report = {row.label: row.text for row in third._sections().inputs}
    assert report["load"] == "100000.0 up to 50 m, then 200000.0 N/m"
    assert report["sliding"] == "100 m"


def test_events_of_a_history_that_goes_on_count_from_its_beginning() -> None:
    whole = worn(sliding=700.0, steps="auto", until="through")
    life = whole.life
    assert life is not None
    part = worn(sliding=0.6 * life.distance, steps="auto")
    assert part.life is None
    rest = worn(sliding=600.0, steps="auto", until="through", initial=part)
    assert rest.life is not None
    # Steps of 1e-3 of the peak each, of the same scheme.
    assert rest.life.distance == pytest.approx(life.distance, rel=3e-3)
    # One of both cells beside the middle.
    assert np.abs(rest.life.position) == pytest.approx(np.abs(life.position))
    assert rest.events == rest.events[:1]
    with pytest.warns(nacre.NacreWarning, match="a layer is worn through"):
        after = worn(sliding=10.0, steps=1, initial=rest)
    assert after.events == rest.events
