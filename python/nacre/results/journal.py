"""Cases of a study or states of a history of wear, one line each, on the disk before the next.

The first line names the version that began the file and its format. Each other line is a checksum
and a record as JSON.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import struct
import sys
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

from nacre._core import __version__
from nacre._tools.disk import naming, sync_folder
from nacre.results.values import FORMAT, check_format

Record = dict[str, Any]

HEAD = f"nacre {__version__}, journal of format {FORMAT}\n".encode()
OPEN: dict[tuple[int, str], Journal] = {}
"""Journals that are open, by process and path: the lock of the system does not tell threads apart,
and ends where any reader of the file in this process closes it."""


class Journal:
    """Records by key, kept in a file that only grows; without a path they are in memory only.

    A record is on the disk when `add` returns; one that the disk has no room for leaves the file
    as it was. A line that a kill cut short is dropped when the file is opened again. One call
    writes at a time; a second one, of this process or of another, is refused.
    """

    def __init__(self, path: Path | None, kind: str = "study") -> None:
        self.path = path
        self.kind = kind
        self.records: dict[str, Record] = {}
        self._file: IO[bytes] | None = None
        self._key = _key(path or Path())

    def __enter__(self) -> Self:
        """Open the file, and read what it holds."""
        if self.path is not None:
            if self.path.exists() and not self.path.is_file():
                raise ValueError(f"{self._no_journal}: it is not a file")
            if OPEN.setdefault(self._key, self) is not self:
                raise _taken(self.path, "this process", self.kind)
            try:
                self._file = self.path.open("a+b", buffering=0)
                _lock(self._file, self.kind)
                self._file.seek(0)
                with open(self._file.fileno(), "rb", closefd=False) as lines:
                    end = self._read(lines)
                self._file.truncate(end)
                if end == 0:
                    _append(self._file, HEAD)
                    sync_folder(self.path)
            except BaseException:
                self._close()
                raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Close the file."""
        self._close()

    def _close(self) -> None:
        if self._file is not None:
            self._file.close()
        if self.path is not None:
            del OPEN[self._key]

    @property
    def _no_journal(self) -> str:
        return f"{str(self.path)!r} is no journal of a {self.kind}"

    def add(self, record: Record) -> None:
        """Keep a record by its ``key``; it replaces an earlier one with the same key."""
        self.append(record)
        self.records[record["key"]] = record

    def append(self, record: Record) -> None:
        """Write a record to the file, if there is one, and do not keep it in memory."""
        if self._file is not None:
            text = json.dumps(record).encode()
            _append(self._file, _checksum(text) + b" " + text + b"\n")

    @classmethod
    def stored(cls, path: Path, kind: str) -> dict[str, Record]:
        """Return the records of a file, which this or another process may be writing."""
        journal, writer = cls(path, kind), OPEN.get(_key(path))
        own = writer._file if writer else None
        with open(own.fileno() if own else path, "rb", closefd=own is None) as lines:
            lines.seek(0)
            journal._read(lines)
        return journal.records

    def _read(self, lines: IO[bytes]) -> int:
        """Read all records, and return where the last one ends that no kill cut short."""
        end = 0
        for number, line in enumerate(lines, start=1):
            cut = not line.endswith(b"\n")
            if cut and (number > 1 or HEAD.startswith(line)):
                break
            try:
                if number == 1:
                    _check_head(line)
                else:
                    record = _record(line.removesuffix(b"\n"))
                    self.records[record["key"]] = record
            except ValueError as error:
                raise ValueError(f"{self._no_journal}: line {number}: {error}") from error
            end += len(line)
        return end


def _check_head(line: bytes) -> None:
    match = re.fullmatch(r"nacre (\S+), journal of format (\d+)\n", line.decode("latin-1"))
    if match is None:
        raise ValueError("it is not the first line that nacre writes")
    check_format(int(match[2]), match[1], "it")


def _record(line: bytes) -> Record:
    checksum, _, text = line.partition(b" ")
    if checksum != _checksum(text):
        raise ValueError("it was changed after nacre wrote it")
    record: Record = json.loads(text)
    return record


def _checksum(text: bytes) -> bytes:
    return hashlib.sha256(text).hexdigest()[:16].encode()


def _append(file: IO[bytes], line: bytes) -> None:
    """Write a line to the disk, whole or not at all."""
    end = os.fstat(file.fileno()).st_size
    with naming(Path(file.name)):
        try:
            while line:
                line = line[file.write(line) :]
            os.fsync(file.fileno())
        except BaseException:
            with suppress(OSError):
                file.truncate(end)
            raise


def _lock(file: IO[bytes], kind: str) -> None:
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
        raise _taken(Path(file.name), _holder(file), kind) from error


def _holder(file: IO[bytes]) -> str:
    """Return the process that has the lock of a file, with its number where Linux tells it."""
    number = 0
    if sys.platform == "linux":
        import fcntl

        layout = "hhqqi4x"  # of `struct flock`: kind, reference, begin, length, process
        asked = struct.pack(layout, fcntl.F_WRLCK, os.SEEK_SET, 0, 0, 0)
        with suppress(OSError):
            *_, number = struct.unpack(layout, fcntl.fcntl(file, fcntl.F_GETLK, asked))
    return f"process {number}" if number > 0 else "another process"  # not on another computer


def _taken(path: Path, holder: str, kind: str) -> BlockingIOError:
    """Return the error of a journal that is being written."""
    store = str(path.with_suffix(".nc"))
    return BlockingIOError(f"store {store!r} is being written: {holder} is running this {kind}")


def _key(path: Path) -> tuple[int, str]:
    return os.getpid(), os.path.realpath(path)
