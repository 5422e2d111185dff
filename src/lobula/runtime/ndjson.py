"""Records as NDJSON, one line each, on their way to the reader before the next frame is looked at."""

from __future__ import annotations

import errno
import json
from collections.abc import Mapping
from typing import Any

from ..errors import OutputError
from ..types import Reading
from .sinks import Picture
from .unbuffered import Writable

HEADER_KEYS = ("type", "version", "preset", "neurons", "settings_hash", "engine", "source", "width", "height", "fps")


class ReaderGoneError(OutputError):
    """Whoever read this output has closed it, as ``head`` does; no fault, and nothing to report."""


class NdjsonSink:
    """Writes header, events and summary to ``stream``.

    The header is written with the first frame, so that a request which is refused before has a summary alone.

    Raises
    ------
    ReaderGoneError : from any call, when the reader has closed its end
    OutputError : from any call, when the line cannot be written
    """

    def __init__(self, stream: Writable, name: str = "standard output") -> None:
        self._stream = stream
        self._name = name
        self._header: Mapping[str, Any] | None = None  # until it is written

    def open(self, header: Mapping[str, Any]) -> None:
        """Keep the header record for the first frame."""
        self._header = {key: header[key] for key in HEADER_KEYS if key in header}

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Write the header record if this is the first one; frames are the trace's business."""
        self._begin()

    def event(self, record: Mapping[str, Any]) -> None:
        """Write one state, collision or source record."""
        self._begin()
        self._write(record)

    def close(self, summary: Mapping[str, Any]) -> None:
        """Write the summary record."""
        if summary.get("status") != "refused":
            self._begin()
        self._write(summary)

    def _begin(self) -> None:
        header, self._header = self._header, None
        if header is not None:
            self._write(header)

    def _write(self, record: Mapping[str, Any]) -> None:
        try:
            self._stream.write(json.dumps(record, separators=(",", ":"), allow_nan=False) + "\n")
            self._stream.flush()
        except BrokenPipeError as error:
            raise ReaderGoneError(f"{self._name}: closed by its reader") from error
        except OSError as error:
            reason = "the disk is full" if error.errno == errno.ENOSPC else error.strerror
            raise OutputError(f"cannot write {self._name}: {reason}") from error
