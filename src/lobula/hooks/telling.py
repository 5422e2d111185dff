"""Tells the reader of a run how its hooks fare: their records among the events, their counts in the summary."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ..runtime.events import Record
from ..runtime.sinks import Picture, Sink, WakefulSink
from ..types import Reading
from .office import PostOffice


class Telling:
    """``reader``, a sink, with the news of ``office`` put between what it is given.

    A hook's record has the ``frame`` and ``time_s`` at which it is told, also while the source is silent; ``also`` is
    given it as well. Close it after the office, whose counts are final only then.
    """

    def __init__(self, reader: Sink, office: PostOffice, also: Callable[[Record], None] | None = None) -> None:
        self._reader = reader
        self._office = office
        self._also = also
        self._at: dict[str, Any] = {"frame": 0, "time_s": 0.0}

    def open(self, header: Mapping[str, Any]) -> None:
        """Open the reader."""
        self._reader.open(header)

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Hand on a frame, then the news."""
        self._at = {"frame": index, "time_s": round(reading.time_s, 6)}
        self._reader.frame(index, reading, picture)
        self._tell()

    def silence(self, index: int, time_s: float) -> None:
        """Tell the news, though no frame comes."""
        self._at = {"frame": index, "time_s": round(time_s, 6)}
        self._tell()
        if isinstance(self._reader, WakefulSink):
            self._reader.silence(index, time_s)

    def event(self, record: Mapping[str, Any]) -> None:
        """Hand on a record, after the news."""
        self._tell()
        self._reader.event(record)

    def close(self, summary: Mapping[str, Any]) -> None:
        """Tell the last news and close the reader with ``hooks`` in its summary."""
        if summary.get("status") == "refused":
            self._reader.close(summary)
            return
        try:
            self._tell()
        finally:
            self._reader.close({**summary, "hooks": self._office.tallies()})

    def _tell(self) -> None:
        for news in self._office.news():
            record = news | self._at
            if self._also is not None:
                self._also(record)
            self._reader.event(record)
