"""Finished cases of a study, one line of JSON each, on the disk before the next one begins.

A line names the format and the version that wrote it. Its last entry is a checksum of the others.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

import numpy as np

from nacre._core import __version__
from nacre.values import FORMAT, check_format

Record = dict[str, Any]

BEGINNING = b'{"format": '
"""How each line begins."""


class Journal:
    """Records by key, kept in a file that only grows; without a path they are in memory only.

    A record is on the disk when `add` returns; one that the disk has no room for leaves the file
    as it was. A line that a kill cut short is dropped when the file is opened again. One process
    writes at a time; a second one is refused.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self.records: dict[str, Record] = {}
        self._file: IO[bytes] | None = None

    def __enter__(self) -> Self:
        if self.path is not None:
            if self.path.exists() and not self.path.is_file():
                raise ValueError(f"{str(self.path)!r} is no journal of a study: it is not a file")
            self._file = self.path.open("a+b", buffering=0)
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
        if self._file is not None:
            head = {"format": FORMAT, "nacre": __version__}
            line = _text(head | record)
            self._write(self._file, _text(head | record | {"checksum": _checksum(line)}) + "\n")
        self.records[record["key"]] = record

    def _write(self, file: IO[bytes], line: str) -> None:
        end = os.fstat(file.fileno()).st_size
        rest = line.encode()
        try:
            while rest:
                rest = rest[file.write(rest) :]
            os.fsync(file.fileno())
        except BaseException:
            with suppress(OSError):
                file.truncate(end)
            raise

    def _read(self, file: IO[bytes]) -> None:
        file.seek(0)
        whole = 0
        with open(file.fileno(), "rb", closefd=False) as lines:
            for number, line in enumerate(lines, start=1):
                try:
                    record = _record(line)
                except (ArithmeticError, ValueError, RecursionError) as error:
                    if _is_cut(line, error):
                        break
                    message = f"{str(self.path)!r} is no journal of a study: line {number}"
                    raise ValueError(f"{message}: {error}") from error
                if not line.endswith(b"\n"):
                    break  # its end may be missing
                self.records[record["key"]] = record
                whole += len(line)
        file.truncate(whole)


def _is_cut(line: bytes, error: Exception) -> bool:
    """Return whether a line that is no record is the beginning of one, cut short by a kill."""
    # What is whole as JSON, or begins in another way, belongs to somebody else.
    return (
        isinstance(error, json.JSONDecodeError | UnicodeDecodeError)
        and not line.endswith(b"\n")
        and line[: len(BEGINNING)] == BEGINNING[: len(line)]
    )


def _text(entries: Record) -> str:
    # Names of files may hold surrogates, which no encoding has.
    return json.dumps(entries, ensure_ascii=False).encode("utf-8", "replace").decode()


def _checksum(line: str) -> str:
    return hashlib.sha256(line.encode()).hexdigest()[:16]


def _record(line: bytes) -> Record:
    """Return the record of a line; a line of none, or of an unknown format, is a `ValueError`."""
    record = json.loads(line)
    if not isinstance(record, dict):
        raise ValueError("it must hold an object of JSON")
    check_format(record.get("format"), record.get("nacre"), "it")
    if record.pop("checksum", None) != _checksum(_text(record)):
        raise ValueError("it was changed after nacre wrote it")
    del record["format"], record["nacre"]
    texts, values, kinds = (
        record.get(name, empty) for name, empty in (("warnings", []), ("values", {}), ("kinds", []))
    )
    if not (
        isinstance(record.get("key"), str)
        and isinstance(values, dict)
        and all(_is_numbers(value) for value in values.values())
        and isinstance(record.get("error", ""), str)
        and isinstance(texts, list)
        and isinstance(kinds, list)
        and all(isinstance(text, str) for text in texts + kinds)
        and ("values" in record or "error" in record)
    ):
        raise ValueError("it must hold a key, and values or an error")
    return record


def _is_numbers(value: Any) -> bool:
    """Return whether a value is a number, or an array of numbers as lists."""
    array = np.asarray(value)  # lists that are no array raise a `ValueError`
    return array.dtype.kind in "iufb"


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
