"""Lines for people on standard error, which nobody may be there to read."""

from __future__ import annotations

import sys
from contextlib import suppress

from .unbuffered import Writable, unbuffered


def say(text: str) -> None:
    """Write one line on standard error, at once; where nobody can be told any more, nobody is."""
    if sys.stderr is None:  # as it is in a program that was started without one
        return
    # a terminal's own stream keeps lines clear of a bar; elsewhere what cannot be written must not wait in a buffer
    write_line(sys.stderr if sys.stderr.isatty() else unbuffered(sys.stderr), text)


def write_line(stream: Writable, text: str) -> None:
    """Write ``text`` and a line break; one that cannot be written is left out."""
    with suppress(OSError):
        stream.write(f"{text}\n")
        stream.flush()
