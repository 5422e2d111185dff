"""A live source that went away is opened again: at once, then after ever longer waits."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Literal, NamedTuple

from ..errors import FrameSourceError
from .selection import Picture
from .source import Reader

FIRST_WAIT_S, LONGEST_WAIT_S = 0.25, 10.0
"""Before the first and the later tries, s, each wait twice the one before; a connection that holds for longer than the
next wait makes them begin anew."""

KEPT_NEWS = 1000
"""So many wait for somebody to ask for them; the oldest go first."""


Phase = Literal["lost", "retry", "back", "resized", "restarted", "settings"]


class News(NamedTuple):
    """What became of a source, at ``at_s`` on the clock of ``time.monotonic``, and what there is to say of it.

    ``lost``: the connection broke (``reason``); ``retry``: a try failed (``attempt``, ``reason``); ``back``: a try
    succeeded (``attempt``, ``away_s`` since the loss); ``resized``: pictures have another size (``width``, ``height``).
    Of robots only, ``restarted``: it was switched on anew; ``settings``: it has others now (``preset``,
    ``settings_hash``).
    """

    phase: Phase
    at_s: float
    facts: Mapping[str, str | int | float]
    connection: int = 1
    """The connection that is lost, or is tried for in vain, is that before; the one that is back or resized is this."""


class Reconnecting:
    """A reader over all connections to one live source. Pictures are numbered on; stamps are each connection's own.

    Parameters
    ----------
    reader : the first connection
    reopen : makes another one, or raises FrameSourceError
    patience_s : how long to try before the loss is final; 0 does not try
    """

    def __init__(self, reader: Reader, reopen: Callable[[], Reader] | None = None, patience_s: float = 0.0) -> None:
        self.name, self.fps, self.frame_count = reader.name, reader.fps, reader.frame_count
        self.first = reader.first
        self._connection = 1
        self._reader = reader
        self._reopen = reopen if patience_s > 0 else None
        self._patience_s = patience_s
        self._stopping = threading.Event()
        self._lost_s: float | None = None
        self._damaged_before = 0
        self._notes_before: list[str] = []
        self._news: deque[News] = deque(maxlen=KEPT_NEWS)
        self._wait_s = FIRST_WAIT_S

    @property
    def rotation(self) -> int:
        """Degrees clockwise by which the present connection's pictures are to be turned."""
        return self._reader.rotation

    @property
    def damaged(self) -> int:
        """Pictures that could not be decoded, over all connections."""
        return self._damaged_before + self._reader.damaged

    @property
    def notes(self) -> list[str]:
        """Lines for the user, each once."""
        return list(dict.fromkeys([*self._notes_before, *self._reader.notes]))

    @property
    def away(self) -> bool:
        """True while there is no connection and it is being tried."""
        return self._lost_s is not None

    def news(self, connection: float = math.inf) -> list[News]:
        """Return what happened up to ``connection`` and was not told yet, oldest first."""
        news = []
        while self._news and self._news[0].connection <= connection:
            news.append(self._news.popleft())
        return news

    def _tell(self, phase: Phase, connection: int, **facts: str | int | float) -> None:
        """Add to the news."""
        self._news.append(News(phase, time.monotonic(), facts, connection))

    def stop(self) -> None:
        """Ask for an end, from any thread: no further try, no further picture."""
        self._stopping.set()

    def close(self) -> None:
        """Let go of the present connection."""
        self._reader.close()

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield the pictures of one connection after the other.

        Raises
        ------
        FrameSourceError : the source went away and is not to be tried, or was away for too long
        """
        first = 0
        while not self._stopping.is_set():
            count = first
            connected_s = time.monotonic()
            reason = f"{self.name}: the stream ended"
            try:
                for picture in self._reader.pictures():
                    if self._stopping.is_set():
                        return
                    count = first + picture.index + 1
                    yield replace(picture, index=first + picture.index, connection=self._connection)
            except FrameSourceError as error:
                reason = str(error)
                if self._reopen is None:
                    raise
            if self._reopen is None:
                raise FrameSourceError(reason, on_the_way=True)
            first = count
            if time.monotonic() - connected_s > self._wait_s:
                self._wait_s = FIRST_WAIT_S
            self._connect_again(reason, self._reopen)

    def _connect_again(self, reason: str, reopen: Callable[[], Reader]) -> None:
        """Replace the broken connection by a new one; on return there is one, or the end was asked for."""
        self._lost_s = time.monotonic()
        coming = self._connection + 1
        self._tell("lost", coming, reason=reason)
        self._reader.close()
        attempt, left_s = 0, self._patience_s
        while not self._stopping.wait(min(self._wait_s, left_s)):
            self._wait_s = min(2 * self._wait_s, LONGEST_WAIT_S)
            attempt += 1
            try:
                reader = reopen()
            except FrameSourceError as error:
                away_s = time.monotonic() - self._lost_s
                left_s = self._patience_s - away_s
                if left_s <= 0:
                    tries = f"given up after {away_s:.1f} s, tries: {attempt}"
                    raise FrameSourceError(f"{error}; {tries}", on_the_way=True) from error
                self._tell("retry", coming, attempt=attempt, reason=str(error))
                continue
            self._damaged_before, self._notes_before = self.damaged, self.notes
            self._reader = reader
            self._connection = coming
            self._tell("back", coming, attempt=attempt, away_s=round(time.monotonic() - self._lost_s, 3))
            self._lost_s = None
            return
