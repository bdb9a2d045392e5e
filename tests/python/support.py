"""What many tests do: commands and scripts, interrupts, tables of errors, random numbers."""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import runpy
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path
from typing import Any, NamedTuple
from unittest import mock

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


def python(*arguments: object, folder: Path | None = None, **options: Any) -> Any:
    """Return a finished process of Python, with its exit code and what it printed."""
    asked = [sys.executable, *map(str, arguments)]
    options = {"capture_output": True, "text": True, "timeout": 300} | options
    return subprocess.run(asked, cwd=folder, check=False, **options)


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


class Interrupted(NamedTuple):
    """How a process ended that was sent Ctrl-C at a time."""

    code: int
    first: str
    lines: list[str]
    errors: str
    sent: float
    waited: float


def interrupted(*arguments: object, wait: float = 0.0, stream: str = "stdout") -> Interrupted:
    """Send Ctrl-C to a process of Python `wait` after its first line, the others are `lines`."""
    asked = [sys.executable, *map(str, arguments)]
    pipe = subprocess.PIPE
    with subprocess.Popen(asked, stdout=pipe, stderr=pipe, text=True) as process:
        try:
            first = getattr(process, stream).readline()
            assert first
            time.sleep(wait)
            assert process.poll() is None, "it ended before it could be interrupted"
            sent = time.monotonic()
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=60)
        finally:
            process.kill()
    waited = time.monotonic() - sent
    return Interrupted(process.returncode, first, out.splitlines(), err, sent, waited)


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


def errors(kind: type[Exception], calls: dict[str, str]) -> list[tuple[str, type[Exception], str]]:
    """Return rows of a table whose exceptions are all of one kind."""
    return [(call, kind, words) for call, words in calls.items()]


def refused(call: str, kind: type[Exception], words: str, names: dict[str, Any]) -> None:
    """Evaluate a call, which has to raise with these words."""
    known = vars(nacre) | {"nacre": nacre, "hertz": nacre.hertz} | vars(bodies) | names
    with pytest.raises(kind, match=words):
        eval(call, known)
