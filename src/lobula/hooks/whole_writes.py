"""A file that grows by whole pieces only, whatever the disk does."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from ..landing import make_empty


class WholeWrites:
    """What is written waits in memory until ``flush`` has all of it in the file, or takes it back and keeps it."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file = -1
        self._waiting = bytearray()
        self._written = 0

    def create(self) -> None:
        """Make the file, or empty it.

        Raises
        ------
        OutputError : nothing can be written there
        """
        make_empty(self._path)

    def open(self) -> None:
        """Open the file, which must be there, at its end."""
        self._file = os.open(self._path, os.O_WRONLY | os.O_APPEND)

    def write(self, data: bytes) -> int:
        """Take note of ``data`` for the next ``flush``."""
        self._waiting += data
        return len(data)

    def tell(self) -> int:
        """Return how long the file will be once all is flushed."""
        return self._written + len(self._waiting)

    def flush(self) -> None:
        """Write what waits.

        Raises
        ------
        OSError : not all of it could be written; the file is as it was before
        """
        data, done = bytes(self._waiting), 0
        try:
            while done < len(data):
                done += os.write(self._file, data[done:])
        except OSError:
            with suppress(OSError):
                os.ftruncate(self._file, self._written)
            raise
        self._written += done
        self._waiting.clear()

    def close(self) -> None:
        """Let go of the file; what waits is kept."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1
