"""What many tests do: comparisons, commands, interrupts, tables of errors, random numbers."""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import re
import runpy
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

import bodies
import nacre
import nacre.cli

ROOT = Path(__file__).parents[2]
DATA = ROOT / "tests" / "data"

Capture = pytest.CaptureFixture[str]
Patch = pytest.MonkeyPatch

ASKED = os.environ.get("NACRE_FUZZ")
"""Number of random examples, others in each run; without it a few that are always the same."""


def fuzz(examples: int, **options: Any) -> settings:
    """Return the settings of a test with so many random examples."""
    return settings(
        max_examples=int(ASKED) if ASKED else examples,
        derandomize=ASKED is None,
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
        **options,
    )


def powers(low: float, high: float) -> st.SearchStrategy[float]:
    """Return numbers between powers of ten."""
    return st.floats(low, high).map(lambda power: 10.0**power)


def written(folder: Path, text: str) -> Path:
    """Return the path of a case file with this text."""
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return path


def command(*arguments: object) -> int:
    """Return the exit code of ``nacre``, run in this process."""
    with pytest.raises(SystemExit) as error:
        nacre.cli.main([str(argument) for argument in arguments])
    assert isinstance(error.value.code, int)
    return error.value.code


ROUNDING = 1e-12
"""Bound of what symmetry makes zero over the largest number: rounding of thousands of terms."""


def assert_close(
    actual: Any,
    expected: Any,
    rtol: float = 1e-7,
    atol: float | None = None,
    *,
    each: bool = False,
) -> None:
    """
    Assert that numbers differ by no more than a part of the largest that is expected.

    A number that symmetry makes zero is the rounding of the others, and differs from one processor
    to the next. With `each`, every number is known to this part of itself, but for rounding of the
    largest: where small numbers matter. With `atol`, to this part and `atol`, as in NumPy.
    """
    if atol is None:
        sizes = np.abs(np.asarray(expected))
        scale = float(np.max(sizes, initial=0.0, where=np.isfinite(sizes)))
        assert scale > 0 or not sizes.size, "zeros have no scale: atol= says what is zero"
        rtol, atol = (rtol, ROUNDING * scale) if each else (0.0, rtol * scale)
    np.testing.assert_allclose(actual, expected, rtol=rtol, atol=atol)


HANG = 900.0
"""Time [s] after which a process hangs. No test takes a tenth of it on a busy machine."""


def python(*arguments: object, folder: Path | None = None, **options: Any) -> Any:
    """Return a finished process of Python, with its exit code and what it printed."""
    asked = [sys.executable, *map(str, arguments)]
    options = {"capture_output": True, "text": True, "timeout": HANG} | options
    return subprocess.run(asked, cwd=folder, check=False, **options)


def taken(store: Path, process: int, kind: str) -> str:
    """Return the pattern of the error of a store that another process writes."""
    holder = f"process {process}" if sys.platform == "linux" else "another process"
    return re.escape(f"store {str(store)!r} is being written: {holder} is running this {kind}")


def printed(program: Path, folder: Path) -> str:
    """Return what a program prints in this process, in a folder and with warnings as errors."""
    with (
        contextlib.chdir(folder),
        warnings.catch_warnings(),
        contextlib.redirect_stdout(io.StringIO()) as output,
        mock.patch.object(sys, "argv", [str(program)]),
        nacre.display_units("SI"),
    ):
        warnings.simplefilter("error")
        runpy.run_path(str(program), run_name="__main__")
    return output.getvalue()


INTERRUPTED = """
import signal, sys, threading
begin = threading.Event()

def interrupt():
    begin.wait()
    signal.raise_signal(signal.SIGINT)

{setup}
threading.Thread(target=interrupt, daemon=True).start()
sys.setswitchinterval(1e6)
{begin}
try:
    {call}
except KeyboardInterrupt as error:
    print("interrupted", len(getattr(error, "solutions", None) or []))
"""


def interrupted(setup: str, call: str, at: str = "call") -> int:
    """
    Interrupt a call that takes hours by Ctrl-C and return how many solutions it had finished.

    The signal is sent by a thread, which the switch interval keeps waiting until the call lets
    other threads run; with `at="event"`, until the call, by its progress, has set `begin` too.
    An interrupt that is not seen is a process that hangs.
    """
    begin = "begin.set()" if at == "call" else ""
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join(sys.path)
    }  # `bodies` stands beside this file
    run = python("-c", INTERRUPTED.format(setup=setup, begin=begin, call=call), env=environment)
    word, _, count = run.stdout.strip().partition(" ")
    assert (word, run.returncode) == ("interrupted", 0), run
    return int(count)


RESULT, STUDY = b"\nnacre result\n\0\0", b"\nnacre study\n\0\0\0"


def sealed(content: bytes, path: Path, mark: bytes = RESULT) -> Path:
    """Write a file of HDF5 with a right seal, as nacre or malice would."""
    path.write_bytes(content + mark + hashlib.sha256(content).digest())
    return path


def resealed(dataset: Any, path: Path, mark: bytes = RESULT) -> Path:
    """Write any dataset as nacre writes it."""
    encoding = {name: {"_FillValue": None} for name in dataset.variables}
    content = bytes(dataset.to_netcdf(engine="h5netcdf", encoding=encoding))
    return sealed(content, path, mark)


def table(*rows: tuple[str, type[Exception], str]) -> pytest.MarkDecorator:
    """Parametrise a test by calls, their exceptions and words of their messages."""
    return pytest.mark.parametrize(("call", "kind", "words"), rows, ids=[row[0] for row in rows])


def errors(kind: Any, calls: dict[str, str]) -> list[tuple[str, type[Exception], str]]:
    """Return rows of a table whose exceptions are all of one kind, or of some."""
    return [(call, kind, words) for call, words in calls.items()]


def refused(call: str, kind: type[Exception], words: str, names: dict[str, Any]) -> None:
    """Evaluate a call, which has to raise with these words."""
    own = {name: getattr(nacre, name) for name in nacre.__all__}
    known = own | {"nacre": nacre, "hertz": nacre.hertz} | vars(bodies) | names
    with pytest.raises(kind, match=words):
        eval(call, known)
