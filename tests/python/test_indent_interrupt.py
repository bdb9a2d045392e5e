"""Ctrl-C is seen at once during long indentations."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import pytest

LONG = """
import nacre
from nacre.indent import Adhesion, Indentation, Tip
gel = nacre.HalfSpace(nacre.RIGID, [nacre.Layer(nacre.Elastic(1e6, 0.4999), 1e-6)])
test = Indentation(gel, Tip.paraboloid(1e-3), adhesion=Adhesion.{adhesion})
print("begun", flush=True)
test.{call}
"""


@pytest.mark.parametrize(
    ("adhesion", "call"),
    [
        ("maugis(0.05, 3e5)", "pull_off()"),
        ("maugis(0.05, 3e5)", "at(load=0.0)"),
        ("jkr(5.0)", "curve(approach=[1e-6, 2e-6])"),
    ],
)
def test_interrupts(adhesion: str, call: str) -> None:
    command = [sys.executable, "-c", LONG.format(adhesion=adhesion, call=call)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True) as process:
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(0.3)
        if process.poll() is not None:
            pytest.skip("the machine is faster than this test")
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        _, errors = process.communicate(timeout=60)
        waited = time.monotonic() - begun
    assert "KeyboardInterrupt" in errors
    # Signals are seen within 50 ms; the rest is the end of the interpreter on a busy machine.
    assert waited < 2.0
