"""Progress of a study: a bar in a terminal or a notebook with ipywidgets, lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import timedelta
from importlib.util import find_spec
from threading import Event, Thread, current_thread, main_thread

from nacre._tools import threads
from nacre._tools.extras import extra

_open_bars: list[str] = []
"""Work of which a bar may be there."""
SOON = 2.0
"""Time after which a bar shows that work goes on [s]."""
EVERY = 60.0
"""Shortest time between two lines in a log [s]: a night has a few hundred of them."""


def check_progress(progress: object) -> Callable[..., object] | None:
    """Return an argument that is a function or None, or raise a `TypeError`."""
    if progress is None or callable(progress):
        return progress
    raise TypeError(f"progress must be callable, got {progress!r}")


@contextmanager
def case_progress(progress: bool | None, total: int, stored: int) -> Iterator[Callable[[], None]]:
    """Yield a function that advances the progress by one case; `stored` cases need no solve."""
    if progress is not None and not isinstance(progress, bool):
        raise TypeError(f"progress must be True, False or None, got {progress!r}")
    if progress is False:
        yield lambda: None
        return
    with extra("files"):
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )
    console = Console(stderr=True)
    # Without ipywidgets, rich would show a warning and an empty line in a notebook.
    notebook = console.is_jupyter and find_spec("ipywidgets") is not None
    if not (threads.CAN_START and (console.is_terminal or notebook)):
        lines = _Lines(total, stored, at_once=bool(progress))
        yield lines.advance
        lines.end()
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console) as bar:
        task = bar.add_task(f"solving{_stored_text(stored, total)}", total=total, completed=stored)
        yield lambda: bar.advance(task)


@contextmanager
def lasting(what: str, progress: object = None) -> Iterator[Callable[..., object] | None]:
    """Yield what is called with the progress: `progress`, or a bar in a terminal or a notebook.

    It is called with the share that is done or with a text. Nothing is shown in the first two
    seconds, inside of other work that is shown, in threads, without rich, or where rich could start
    no thread.
    """
    callback = check_progress(progress)
    watched = threads.CAN_START and ("ipykernel" in sys.modules or sys.stderr.isatty())
    outermost = not _open_bars and current_thread() is main_thread()
    if callback is not None or not (watched and outermost) or find_spec("rich") is None:
        yield callback
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not (console.is_terminal or console.is_jupyter):  # ipykernel is imported, but not used
        yield callback
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    bar = Progress(*columns, console=console, transient=True)
    task, start = bar.add_task(what, total=None), time.monotonic()

    def tell(done: float | str) -> None:
        if isinstance(done, str):
            bar.update(task, description=f"{what}: {done}")
        else:
            bar.update(task, completed=done, total=1.0)
        if time.monotonic() - start > SOON:
            bar.start()

    _open_bars.append(what)
    try:
        yield tell
    finally:
        _open_bars.remove(what)
        bar.stop()


@contextmanager
def alive() -> Iterator[None]:
    """Write a line on standard error each minute, to show that a long solve goes on."""
    ended, start = Event(), time.monotonic()

    def write() -> None:
        while not ended.wait(EVERY):
            seconds = _time(time.monotonic() - start)
            print(f"nacre: solving, {seconds} so far", file=sys.stderr, flush=True)

    Thread(target=write, daemon=True).start()
    try:
        yield
    finally:
        ended.set()


def _stored_text(stored: int, total: int) -> str:
    return f" ({stored} of {total} found in the store)" if stored else ""


class _Lines:
    """Lines on standard error, at most one in `EVERY` seconds."""

    def __init__(self, total: int, stored: int, *, at_once: bool) -> None:
        self.total, self.stored, self.done = total, stored, stored
        self.start = self.last = time.monotonic()
        self.written = at_once
        if at_once:
            self.write()

    def advance(self) -> None:
        self.done += 1
        if time.monotonic() - self.last >= EVERY:
            self.written = True
            self.write()

    def end(self) -> None:
        """Write the last line, where there were others."""
        if self.written:
            self.write()

    def write(self) -> None:
        self.last = time.monotonic()
        seconds = self.last - self.start
        text = f"nacre.sweep: {self.done} of {self.total} cases"
        text += _stored_text(self.stored, self.total)
        new_cases = self.done - self.stored
        if new_cases:
            text += f", {_time(seconds)} so far"
            if left := self.total - self.done:
                text += f", about {_time(seconds * left / new_cases)} left"
        print(text, file=sys.stderr, flush=True)


def _time(seconds: float) -> str:
    return str(timedelta(seconds=round(seconds)))
