"""Work that lasts shows a bar in a terminal after two seconds, and nothing elsewhere."""

from __future__ import annotations

import contextlib
import os
import sys
import threading

import pytest

from support import python

WORK = """
import nacre, nacre.design, nacre.friction, nacre.indent, nacre._tools.progress

nacre._tools.progress.SOON = -1.0
steel = nacre.Elastic(210e9, 0.3)
ball = nacre.Sphere(5e-3)
film = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(3e9, 0.4), 1e-6)])
grid = nacre.Grid((24, 24), (4e-4, 4e-4))
held = dict(load=10.0, friction=0.3, grid=grid)
nacre.solve(ball, steel, load=10.0, grid=grid).stress_summary()
nacre.slide(ball, steel, steel, **held, steps=[{"force": (f, None)} for f in (1.0, -1.0)])
nacre.friction.creep_curve(ball, steel, steel, creepages=[1e-4, 1e-3], direction="+x", **held)
depths = [k * 1e-8 for k in range(1, 12)]
forces = nacre.indent.Indentation(film, nacre.indent.Tip.sphere(5e-6)).at(approach=depths).load
tip = nacre.indent.Tip.sphere(5e-6)
nacre.indent.fit((depths, forces), film, tip, free=["body.layers[0].material.young"])
nacre.design.optimise(
    lambda radius: dict(shape=nacre.Sphere(radius), body=steel),
    {"radius": 5e-3}, objective="approach", cases=[{"load": 10.0}], grid=grid, max_solves=6,
    bounds={"radius": (4e-3, 6e-3)},
)
"""
NAMES = ("stresses", "steps", "creepages", "fit: ", "optimum: ")


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no terminals to open")
def test_a_terminal_shows_what_is_done() -> None:
    import pty

    ours, theirs = pty.openpty()
    pieces: list[bytes] = []

    def read() -> None:
        with contextlib.suppress(OSError):  # the end, on Linux
            while piece := os.read(ours, 1 << 16):
                pieces.append(piece)

    reader = threading.Thread(target=read)
    reader.start()
    done = python("-W", "ignore", "-c", WORK, capture_output=False, stderr=theirs)
    os.close(theirs)
    reader.join()
    os.close(ours)
    text = b"".join(pieces).decode()
    assert done.returncode == 0, text
    for name in NAMES:
        assert name in text, name


@pytest.mark.slow
def test_elsewhere_nothing_is_shown() -> None:
    done = python("-W", "ignore", "-c", WORK)
    assert (done.returncode, done.stderr) == (0, "")
