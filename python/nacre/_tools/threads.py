"""Pools of threads, also where none can be started, as in a browser."""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextvars import copy_context
from typing import Any

CAN_START = sys.platform != "emscripten"
"""Whether threads can be started."""


def thread_pool(count: int) -> Executor:
    """Return a pool of `count` threads; without threads, what is submitted runs at once."""
    return _Threads(count) if CAN_START else _AtOnce()


class _Threads(ThreadPoolExecutor):
    """Runs what is submitted in the context of the call that submits it."""

    def submit(self, function: Callable[..., Any], /, *args: Any, **named: Any) -> Future[Any]:
        return super().submit(copy_context().run, function, *args, **named)


class _AtOnce(Executor):
    """Runs what is submitted before it returns."""

    def submit(self, function: Callable[..., Any], /, *args: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(function(*args, **named))
        except BaseException as error:  # as in a thread, it is raised by the future
            future.set_exception(error)
        return future
