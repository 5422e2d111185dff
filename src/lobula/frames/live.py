"""The newest frame of a live source: a thread decodes, the consumer takes what is newest, the rest is counted."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace

from ..errors import FrameSourceError
from ..types import Frame
from .geometry import View
from .luma import kind_of
from .reconnect import KEPT_NEWS, News, Reconnecting
from .resize import Resizer
from .selection import Picture, Selection
from .source import FrameSource, Reader
from .timeline import Timeline, Transit

_PATIENCE_S = 1.0  # how long close() waits for a decoder that waits for its camera
_WAKE_S = 0.1


class FrameStream(FrameSource):
    """The newest frame whenever one is asked for; ``dropped`` counts those that were overtaken.

    Frames out of order count as dropped too. ``__next__`` waits ``timeout_s``, and as long as a source that went away
    is being tried. With ``reopen`` that goes on for ``reconnect_s``; ``news`` tells of it. ``breaks`` counts where the
    last frame's past ends: another connection, another count of stamps, pictures of another size. What looks at frame
    after frame should begin anew there.
    """

    live = True

    def __init__(
        self,
        reader: Reader,
        view: View,
        selection: Selection,
        resizer: Resizer | None = None,
        timeout_s: float = 10.0,
        reopen: Callable[[], Reader] | None = None,
        reconnect_s: float = 0.0,
    ) -> None:
        link = Reconnecting(reader, reopen, reconnect_s)
        super().__init__(link, view, selection, resizer)
        self.frame_count = selection.expected(None, reader.fps)
        self.breaks = 0
        self._link = link
        self._resized = 0
        self._told: deque[News] = deque(maxlen=KEPT_NEWS)
        self._timeout_s = timeout_s
        self._changed = threading.Condition()
        self._newest: Picture | None = None
        self._ended = False
        self._error: Exception | None = None
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._read, name=f"lobula {reader.name}", daemon=True)
        self._thread.start()

    @property
    def ended(self) -> bool:
        """True when no further frame will come: the wanted stretch is over, or the stream was closed."""
        with self._changed:
            return self._enough() or (self._ended and self._newest is None and self._error is None)

    @property
    def away(self) -> bool:
        """True while there is no connection and it is being tried again."""
        return self._link.away

    def news(self) -> list[News]:
        """Return what became of the connection since the last call and before the last frame, oldest first."""
        news = list(self._told)
        self._told.clear()
        return news

    def poll(self, timeout_s: float) -> Frame | None:
        """Return the newest frame not yet delivered, waiting up to ``timeout_s`` for one; None when none came.

        Raises
        ------
        FrameSourceError : the source failed; raised after the frames that came before
        ParameterError : its pictures are of another size now, in which the region of interest or the mask has no place
        """
        if self._enough():
            return None
        with self._changed:
            self._changed.wait_for(lambda: self._newest is not None or self._ended, timeout_s)
            picture, self._newest = self._newest, None
            # with the lock held: what is told is no later than what is delivered
            self._told += self._link.news(math.inf if picture is None else picture.connection)
            if picture is None and self._error is not None:
                error, self._error = self._error, None
                raise error
        return None if picture is None else self._deliver(picture)

    def __next__(self) -> Frame:
        """Return the newest frame, waiting up to ``timeout_s`` of the stream.

        Raises
        ------
        FrameSourceError : nothing came in time, or the source failed
        """
        deadline_s = time.monotonic() + self._timeout_s
        while not self.ended:
            left_s = deadline_s - time.monotonic()
            frame = self.poll(min(_WAKE_S, max(0.0, left_s)))
            if frame is not None:
                return frame
            if self.away:
                deadline_s = time.monotonic() + self._timeout_s
            elif left_s <= 0 and not self.ended:
                raise FrameSourceError(f"{self.name}: no frame for {self._timeout_s:g} s", on_the_way=True)
        raise StopIteration

    def close(self) -> None:
        """Stop reading; a decoder still waiting for its camera is left to time out."""
        self._closing.set()
        self._link.stop()
        self._thread.join(_PATIENCE_S)
        with self._changed:
            self._ended = True
            self._newest = None
            self._changed.notify_all()

    def _deliver(self, picture: Picture) -> Frame:
        now = kind_of(picture.data)
        if now[:2] != self._sampler.kind[:2]:
            facts = {"width": now[0], "height": now[1]}
            self._told.append(News("resized", time.monotonic(), facts, picture.connection))
            self._lay_out(picture.data)
            self._resized += 1
        self.breaks = picture.breaks + self._resized
        return super()._deliver(picture)

    def _read(self) -> None:
        """Run in the thread: put every wanted picture where the consumer finds it, over the one that lies there."""
        error: Exception | None = None
        try:
            for picture in self._selection.within(self._placed()):
                with self._changed:
                    self.dropped += self._newest is not None
                    self._newest = picture
                    self._changed.notify_all()
        except Exception as caught:  # travels to the consumer as a value: this thread has nobody to tell
            error = None if self._closing.is_set() else caught
        finally:
            self._link.close()
            with self._changed:
                self._ended, self._error = True, error
                self._changed.notify_all()

    def _placed(self) -> Iterator[Picture]:
        """Yield the pictures until the stream is closed, each with its place in time, without those out of order."""
        timeline, transit = Timeline(), Transit()
        connection, breaks = 1, 0
        for picture in self._link.pictures():
            if self._closing.is_set():
                return
            if picture.connection != connection:
                connection = picture.connection
                timeline.connect()
            arrived_s = time.monotonic() if picture.arrived_s is None else picture.arrived_s
            time_s = timeline.place(picture.time_s, arrived_s)
            if time_s is None:
                with self._changed:
                    self.dropped += 1
                continue
            if timeline.breaks != breaks:
                breaks = timeline.breaks
                transit.restart()
            estimate_s = transit.captured(time_s, arrived_s)
            captured_s = estimate_s if picture.captured_s is None else picture.captured_s
            yield replace(picture, time_s=time_s, captured_s=captured_s, breaks=breaks)
