"""A standard stream without a buffer: a thread that waits in it holds no lock that others need to end the program."""

from __future__ import annotations

import os
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
            data = data[os.write(self._number, data) :]
        return len(text)

    def flush(self) -> None:
        """Nothing waits here."""


def unbuffered(stream: TextIO) -> Writable:
    """Return ``stream`` without its buffer; itself where there is no file behind it."""
    try:
        return Unbuffered(stream)
    except (OSError, ValueError):
        return stream
