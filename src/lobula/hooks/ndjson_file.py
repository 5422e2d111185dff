"""``ndjson:FILE``: the records of a run as lines of a file, or of a named pipe."""

from __future__ import annotations

import errno
import os
import select
import time
from contextlib import suppress
from pathlib import Path

from ..errors import OutputError, ParameterError
from ..runtime.events import Record
from .hook import TIMEOUT_S, Hook
from .message import Message, header_told, line

_UNREAD = "nobody reads it"


def make(target: str) -> Hook:
    """Return the hook of ``ndjson:FILE``.

    Raises
    ------
    ParameterError : no file is named
    """
    name = target.partition(":")[2]
    if name in ("", "-"):
        raise ParameterError(f"hook {target}: must be ndjson:FILE; records on standard output are --json")
    return NdjsonFile(Path(name))


class NdjsonFile(Hook):
    """Writes the header, then a line for each record. A file that is there is replaced, as by ``--trace``.

    When the disk was full and has room again the file goes on; no line in it is ever torn.
    """

    readings_kept = 10_000  # a recording is read faster than real time, and a disk may take a moment

    def __init__(self, path: Path) -> None:
        super().__init__(f"ndjson:{path}")
        self.path: Path = path
        self._file = -1
        self._begun = False

    def check(self) -> None:
        """Make the file, or empty it; it stays open, for whoever reads a named pipe takes a closing for the end.

        Raises
        ------
        OutputError : nothing can be written there
        """
        try:
            self._open(os.O_TRUNC)
        except OSError as error:
            if error.errno != errno.ENXIO:  # a named pipe whose reader is not there yet
                raise OutputError(f"cannot write {self.path}: {error.strerror}") from error

    def connect(self, header: Record) -> None:
        """Open the file at its end, if it is not open; the first time, write the header."""
        if self._file < 0:
            self._open()
        if not self._begun:
            self._write(line(header_told(header)))
            self._begun = True

    def send(self, message: Message) -> None:
        """Write one line."""
        self._write(line(message.record))

    def disconnect(self) -> None:
        """Close the file."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def _open(self, how: int = 0) -> None:
        try:
            self._file = os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_APPEND | os.O_NONBLOCK | how, 0o666)
        except OSError as error:
            if error.errno == errno.ENXIO:  # a named pipe
                raise OSError(errno.ENXIO, _UNREAD) from error
            raise

    def _write(self, data: bytes) -> None:
        """Write a whole line, or take back what was written of it."""
        written = 0
        deadline_s = time.monotonic() + TIMEOUT_S
        try:
            while written < len(data):
                _, ready, _ = select.select([], [self._file], [], max(0.0, deadline_s - time.monotonic()))
                if not ready:
                    raise TimeoutError(errno.ETIMEDOUT, _UNREAD)
                written += os.write(self._file, data[written:])
        except OSError:
            if written:
                with suppress(OSError):
                    os.ftruncate(self._file, os.fstat(self._file).st_size - written)
            raise
