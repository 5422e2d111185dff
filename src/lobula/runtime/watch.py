"""Steps the network over what a source gives, and tells stillness of the scene from a source that gives nothing."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Generic, Protocol

from ..frames.live import FrameStream
from ..frames.reconnect import News
from ..frames.source import FrameSource
from ..types import Frame, Reading
from .events import Record, source_record
from .sources import F
from .staleness import STALE_S, Staleness
from .tally import Tally


class Stepper(Protocol):
    """What the loop asks of a network."""

    def step(self, image: Frame, /, *, yaw_rate_deg_s: float | None = None) -> Reading:
        """Advance by one frame."""

    def reset(self) -> None:
        """Return to before the first frame."""


class Newsworthy(Protocol):
    """A source that can go away and come back."""

    def news(self) -> list[News]:
        """Return what became of it since the last call, oldest first."""


class SourceWatch(ABC, Generic[F]):
    """Turns the frames of a source into readings, and their lack into records: silence, what became of the line."""

    def __init__(self, stream: Newsworthy | None, tally: Tally) -> None:
        self._news_of = stream
        self._tally = tally
        self._stale = False
        self._arrived_s = time.monotonic()

    @property
    def now_s(self) -> float:
        """The time of the source, as it goes on while no frame comes."""
        return self._tally.last_s + time.monotonic() - self._arrived_s

    @abstractmethod
    def frame(self, frame: F) -> tuple[Reading, list[Record]]:
        """Return the reading of ``frame`` and the records of the events it starts or ends."""

    def silence(self) -> list[Record]:
        """Return the records that follow from no frame having come since the last one."""
        now_s = self.now_s
        records = self._news(now_s) + self._tally.log.elapse(now_s)
        if now_s - self._tally.last_s > STALE_S:
            records += self._lose(now_s)
        return records

    def _arrival(self, time_s: float) -> list[Record]:
        """Take note that a frame of ``time_s`` came; return the records of what happened before."""
        records = self._news(time_s)
        self._arrived_s = time.monotonic()
        return records

    def _lose(self, time_s: float) -> list[Record]:
        self._stale = True
        return self._tally.log.lose(self._tally.index, time_s)

    def _news(self, latest_s: float) -> list[Record]:
        """Return what became of the connection as records, none of them later than ``latest_s``."""
        records: list[Record] = []
        for news in () if self._news_of is None else self._news_of.news():
            time_s = min(self._tally.last_s + max(0.0, news.at_s - self._arrived_s), latest_s)
            records += self._tally.log.elapse(time_s)
            records.append(source_record(news.phase, self._tally.index, time_s, news.facts))
            if news.phase == "lost":
                self._tally.lose(news.at_s)
                records += self._lose(time_s)
            elif news.phase == "back":
                self._tally.regain(news.at_s)
        return records


class Watch(SourceWatch[Frame]):
    """Turns the frames and the silence of one source into readings and records.

    A source that went away, is silent or shows the same picture over and over is ``stale``; what comes after that, or
    after a change of its pictures' size, meets a network that remembers nothing.
    """

    def __init__(
        self,
        source: FrameSource,
        network: Stepper,
        tally: Tally,
        yaw_rate_deg_s: Callable[[float], float] | None = None,
    ) -> None:
        self._stream = source if isinstance(source, FrameStream) else None
        super().__init__(self._stream, tally)
        self._network = network
        self._yaw_rate_deg_s = yaw_rate_deg_s
        self._frozen = Staleness() if source.live else None
        self._breaks = 0

    def frame(self, frame: Frame) -> tuple[Reading, list[Record]]:
        """Return the reading of ``frame`` and the records of the events it starts or ends."""
        records = self._arrival(frame.time_s)
        stale = self._frozen is not None and self._frozen.is_stale(frame.image, frame.time_s)
        breaks = 0 if self._stream is None else self._stream.breaks
        if (self._stale and not stale) or breaks != self._breaks:
            self._network.reset()  # what moved meanwhile would read as one huge jump
        self._stale, self._breaks = stale, breaks
        rate_deg_s = None if self._yaw_rate_deg_s is None else self._yaw_rate_deg_s(frame.time_s)
        begun_s = time.perf_counter()
        reading = self._network.step(frame, yaw_rate_deg_s=rate_deg_s)
        duration_s = time.perf_counter() - begun_s
        if stale:
            reading = reading._replace(state="stale", collision=False)
        latency_s = None if frame.captured_s is None else time.monotonic() - frame.captured_s
        self._tally.count(frame, duration_s, latency_s)
        return reading, records + self._tally.log.step(frame.index, reading)
