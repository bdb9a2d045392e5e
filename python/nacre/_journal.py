"""Finished cases of a study, one line of JSON each, on the disk before the next one begins.

A line names the format and the version that wrote it; a line without them is of format 0.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

from nacre._core import __version__
from nacre.values import FORMAT

Record = dict[str, Any]


class Journal:
    """Records by key, kept in a file that only grows; without a path they are in memory only.

    A record is on the disk when `add` returns. A line that a kill cut short is dropped when the
    file is opened again. One process writes at a time; a second one is refused.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self.records: dict[str, Record] = {}
        self._file: IO[bytes] | None = None

    def __enter__(self) -> Self:
        if self.path is not None:
            self._file = self.path.open("a+b")
            try:
                _lock(self._file)
                self._read(self._file)
            except BaseException:
                self._file.close()
                raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._file is not None:
            self._file.close()

    def add(self, record: Record) -> None:
        """Keep a record by its ``key``; it replaces an earlier one with the same key."""
        self.records[record["key"]] = record
        if self._file is not None:
            head = {"format": FORMAT, "nacre": __version__}
            line = json.dumps(head | record, ensure_ascii=False) + "\n"
            self._file.write(line.encode())
            self._file.flush()
            os.fsync(self._file.fileno())

    def _read(self, file: IO[bytes]) -> None:
        file.seek(0)
        lines = file.read().splitlines(keepends=True)
        whole = 0
        for number, line in enumerate(lines):
            try:
                record = json.loads(line)
                written, version = record.pop("format", 0), record.pop("nacre", None)
                self.records[record["key"]] = record
            except (ValueError, KeyError, TypeError, AttributeError) as error:
                if number + 1 < len(lines):
                    message = f"{str(self.path)!r} is no journal of a study: line {number + 1}"
                    raise ValueError(message) from error
                break
            if written > FORMAT:
                raise ValueError(
                    f"{str(self.path)!r} has format {written}, written by nacre {version}; nacre "
                    f"{__version__} reads formats up to {FORMAT}: install a newer version"
                )
            if not line.endswith(b"\n"):
                del self.records[record["key"]]  # its end may be missing
                break
            whole += len(line)
        file.truncate(whole)


def _lock(file: IO[bytes]) -> None:
    """Lock the file for this process until it is closed; children do not inherit the lock."""
    try:
        if sys.platform == "win32":
            import msvcrt

            file.seek(1 << 40)  # beyond what is read and written
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        raise BlockingIOError(f"{file.name!r}: another process is running this study") from error
