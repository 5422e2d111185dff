"""A file of JSON lines that several processes add to and that outlives all of them."""

from __future__ import annotations

import errno
import fcntl
import json
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..errors import OutputError
from ..landing import writing

NO_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS)


class Lines:
    """Reads what is new in ``path`` and adds to it; every line there is whole, or is passed over.

    A line is added while the file is locked, by this process, another one, or one on another machine. A process that is
    killed inside a line leaves a torn one, which the next line that is added ends.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._read = 0

    def new(self) -> list[dict[str, Any]]:
        """Return the records that were added since the last call; at the first one all that there are.

        Raises
        ------
        OutputError : the file is there and cannot be read
        """
        try:
            with self.path.open("rb") as file:
                if os.fstat(file.fileno()).st_size < self._read:
                    self._read = 0  # another file by now
                file.seek(self._read)
                data = file.read()
        except FileNotFoundError:
            return []
        except OSError as error:
            raise OutputError(f"cannot read {self.path}: {error.strerror}") from error
        whole = data[: data.rfind(b"\n") + 1]  # what follows is being written
        self._read += len(whole)
        found = map(_record, whole.splitlines())
        return [record for record in found if record is not None]

    def add(self, record: Mapping[str, Any]) -> None:
        """Add a line; when this returns it is on the disk.

        Raises
        ------
        OutputError : it cannot be written; the file is as it was
        """
        data = json.dumps(record, separators=(",", ":"), allow_nan=False).encode() + b"\n"
        with writing(self.path), self.path.open("ab+", buffering=0) as file:
            lock(file.fileno(), fcntl.LOCK_EX, self.path)
            end = file.seek(0, os.SEEK_END)
            if end and os.pread(file.fileno(), 1, end - 1) != b"\n":
                data = b"\n" + data
            try:
                if file.write(data) != len(data):
                    raise OSError(errno.ENOSPC, "the disk is full")
            except OSError:
                with suppress(OSError):
                    file.truncate(end)
                raise
            os.fsync(file.fileno())


def lock(descriptor: int, how: int, path: Path) -> None:
    """Lock an open file: ``how`` as for ``flock``.

    Raises
    ------
    BlockingIOError : LOCK_NB, and somebody else has it
    OutputError : the file system has no locks
    """
    try:
        fcntl.flock(descriptor, how)
    except OSError as error:
        if error.errno in NO_LOCKS:
            raise OutputError(
                f"{path}: its file system has no locks ({error.strerror}): --out must be on one that has"
            ) from error
        raise


def _record(line: bytes) -> dict[str, Any] | None:
    try:
        record = json.loads(line)
    except ValueError:
        return None
    return record if isinstance(record, dict) else None
