"""All outputs of a run together: one that fails is reported once and left out, the others go on."""

from __future__ import annotations

import errno
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from ..errors import LobulaError
from ..types import Reading
from .events import Record
from .ndjson import ReaderGoneError
from .sinks import NotingSink, OutputLapseError, Picture, Sink, WakefulSink

_DISK_FAILED = {errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG}


class Outputs:
    """Hands every call to each sink that still works.

    ``failures`` holds what went wrong, in the order it did; ``notes`` what the sinks had to say besides.
    """

    def __init__(self, sinks: Sequence[Sink], tell: Callable[[str], None]) -> None:
        self._sinks = tuple(sinks)
        self._tell = tell
        self._alive: list[Sink] = []
        self._tried: list[Sink] = []
        self.failures: list[str] = []
        self.notes: list[str] = []

    @property
    def deserted(self) -> bool:
        """True when there were outputs and none is left: nobody would see what comes."""
        return bool(self._sinks) and not self._alive

    def open(self, header: Mapping[str, Any]) -> None:
        """Open every sink, the last one first: its record of how a run ended is not to be lost by another's failure.

        Raises
        ------
        LobulaError : an output cannot be started at all, as in a folder that does not exist; a full disk is no such
            case, since it says nothing against the request
        """
        for sink in reversed(self._sinks):
            self._tried.insert(0, sink)
            try:
                sink.open(header)
            except LobulaError as error:
                if not (isinstance(error, ReaderGoneError) or disk_failed(error)):
                    raise
                self._fail(error)
            else:
                self._alive.insert(0, sink)
            for note in sink.notes if isinstance(sink, NotingSink) else ():
                self.notes.append(note)
                self._say(note)

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Hand a reading to the sinks."""
        self._each(lambda sink: sink.frame(index, reading, picture))

    def events(self, records: Iterable[Record]) -> None:
        """Hand records to the sinks, one after the other."""
        for record in records:
            self._event(record)

    def silence(self, index: int, time_s: float) -> None:
        """Tell the sinks that heed it that no frame has come since ``index``."""
        self._each(lambda sink: sink.silence(index, time_s) if isinstance(sink, WakefulSink) else None)

    def close(self, summary: Callable[[], Record]) -> None:
        """Close every sink that was tried, in order; each is given the summary as it is by then."""
        for sink in self._tried:
            try:
                sink.close(summary())
            except LobulaError as error:
                if sink in self._alive:
                    self._fail(error)
        self._tried = []

    def _event(self, record: Record) -> None:
        self._each(lambda sink: sink.event(record))

    def _each(self, call: Callable[[Sink], None]) -> None:
        for sink in tuple(self._alive):
            try:
                call(sink)
            except LobulaError as error:
                if not isinstance(error, OutputLapseError):
                    self._alive.remove(sink)
                self._fail(error)

    def _fail(self, error: LobulaError) -> None:
        if not isinstance(error, ReaderGoneError):
            self.failures.append(str(error))
            self._say(str(error))

    def _say(self, line: str) -> None:
        with suppress(OSError):
            self._tell(line)


def disk_failed(error: BaseException) -> bool:
    """Whether it is the disk that failed, and not the request that was wrong."""
    return getattr(error.__cause__, "errno", None) in _DISK_FAILED
