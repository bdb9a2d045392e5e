"""Time from Ctrl-C to the exception, for calls that would take hours: at most 0.2 s.

.venv/bin/python benches/interrupts.py
"""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable

import numpy as np

import nacre
from nacre.indent import Indentation, Tip

REPETITIONS = 5
DELAY = 0.5
"""Time from the call to Ctrl-C [s]."""


def calls() -> dict[str, Callable[[], object]]:
    """Return calls without end by name."""
    steel, ball = nacre.Elastic(210e9, 0.3), nacre.Sphere(5e-3)
    grid = nacre.Grid(shape=(512, 512), size=(3e-4, 3e-4))
    contact, pair = nacre.Contact(steel, grid), nacre.Contact(steel, grid, steel)
    film = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(1e9, 0.3), 1e-7)])
    layered = nacre.HalfSpace(steel, 300 * [nacre.Layer(nacre.Elastic(4e11, 0.3), 1e-6)])
    solution = nacre.solve(ball, layered, grid=grid, load=5.0)
    depths = np.linspace(0.0, 1e-3, 500)
    indentation = Indentation(film, Tip.paraboloid(1.0))
    steps = [{"force": (force, None)} for force in (1.0, -1.0)]
    return {
        "solve": lambda: contact.solve(ball, load=5.0, tolerance=1e-300, max_iterations=10**12),
        "slide": lambda: pair.slide(ball, 10**4 * steps, load=5.0, friction=0.3),
        "wear": lambda: contact.wear(ball, load=5.0, rate=1e-16, sliding=1e9, steps=10**6),
        "fretting": lambda: pair.wear(
            ball,
            load=5.0,
            rate=1e-16,
            cycles=1e9,
            steps=10**6,
            slide={"friction": 0.3, "steps": steps},
        ),
        "roll": lambda: pair.roll(
            ball, cells=10**6, creepage=(1e-3, None), direction="+x", load=5.0, friction=0.3
        ),
        "stress": lambda: solution.stress(depths, friction=0.3, direction=(1.0, 0.0)),
        "gradient": lambda: solution.gradient([("pressure_norm", 8.0)] * 10**6),
        "indentation": lambda: indentation.at(radius=np.full(10**5, 4e-5)),
    }


def delay(call: Callable[[], object]) -> float:
    """Return the time from Ctrl-C to the exception [s]."""
    sent = []

    def interrupt() -> None:
        sent.append(time.perf_counter())
        signal.raise_signal(signal.SIGINT)

    threading.Timer(DELAY, interrupt).start()
    try:
        call()
    except KeyboardInterrupt:
        return time.perf_counter() - sent[0]
    raise RuntimeError("the call ended before it could be interrupted")


def main() -> None:
    """Print the longest of some delays of each call."""
    for name, call in calls().items():
        print(f"{name:12} {max(delay(call) for _ in range(REPETITIONS)):.3f} s")


if __name__ == "__main__":
    main()
