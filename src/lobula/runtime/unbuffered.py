"""A standard stream without a buffer: a thread that waits in it holds no lock that others need to end the program."""

from __future__ import annotations

import os
import select
from typing import Protocol, TextIO


class Writable(Protocol):
    """What lines are written to."""

    def write(self, text: str, /) -> int:
        """Write ``text``."""

    def flush(self) -> None:
        """See to it that it is on its way."""


class Unbuffered:
    """Writes text to the file behind ``stream``."""

    def __init__(self, stream: TextIO) -> None:
        stream.flush()
        self._number = stream.fileno()

    def write(self, text: str) -> int:
        """Write all of ``text``, however long it takes.

        Raises
        ------
        OSError : it cannot be written
        """
        data = text.encode("utf-8", "backslashreplace")
        while data:
            try:
                data = data[os.write(self._number, data) :]
            except BlockingIOError:  # whoever made the file wanted nobody to wait in it
                select.select([], [self._number], [])
        return len(text)

    def flush(self) -> None:
        """Nothing waits here."""

    def fileno(self) -> int:
        """Return the file's number."""
        return self._number

    def isatty(self) -> bool:
        """Return whether it is a terminal."""
        return os.isatty(self._number)


def unbuffered(stream: TextIO) -> Writable:
    """Return ``stream`` without its buffer; itself where there is no file behind it."""
    try:
        return Unbuffered(stream)
    except (OSError, ValueError):
        return stream
