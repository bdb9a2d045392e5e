"""Pools of threads, also where none can be started, as in a browser."""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from typing import Any

CAN_START = sys.platform != "emscripten"
"""Whether threads can be started."""


def thread_pool(count: int) -> Executor:
    """Return a pool of `count` threads; without threads, what is submitted runs at once."""
    return ThreadPoolExecutor(count) if CAN_START else _AtOnce()


class _AtOnce(Executor):
    """Runs what is submitted before it returns."""

    def submit(self, function: Callable[..., Any], /, *args: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(function(*args, **named))
        except BaseException as error:  # as in a thread, it is raised by the future
            future.set_exception(error)
        return future
