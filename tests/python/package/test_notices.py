"""Warnings that a function collects are kept from view in its own threads, and only there."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import pytest

import nacre
from nacre._tools.notices import heard, warn
from nacre._tools.threads import thread_pool


def test_warnings_of_a_pool_reach_the_function_that_started_it() -> None:
    with heard() as texts, thread_pool(2) as pool:
        assert [pool.submit(warn, text).result() for text in "ab"] == [None, None]
    assert texts == ["a", "b"]
    with pytest.warns(nacre.NacreWarning, match="^c$"):
        warn("c")


def test_threads_that_collect_warnings_leave_those_of_others() -> None:
    """Both threads are inside at once, the first ends first, and a third one is outside."""
    inside = Barrier(3)

    def collect(text: str) -> list[str]:
        with heard() as texts:
            inside.wait()
            warn(text)
            inside.wait()
        return texts

    with ThreadPoolExecutor(2) as pool:
        futures = [pool.submit(collect, text) for text in "ab"]
        inside.wait()
        with pytest.warns(nacre.NacreWarning, match="^outside$"):
            warn("outside")
        inside.wait()
        assert [future.result() for future in futures] == [["a"], ["b"]]
