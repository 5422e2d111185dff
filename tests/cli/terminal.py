"""A stand-in for a terminal, since a test has none."""

from __future__ import annotations

import io


class Terminal(io.StringIO):
    """Keeps what it is shown."""

    def isatty(self):
        return True
