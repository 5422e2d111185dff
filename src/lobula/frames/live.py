"""The newest frame of a live source: a thread decodes, the consumer takes what is newest, the rest is counted."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator

from ..errors import FrameSourceError
from ..types import Frame
from .geometry import View
from .resize import Resizer
from .selection import Picture, Selection
from .source import FrameSource, Reader

_PATIENCE_S = 1.0  # how long close() waits for a decoder that waits for its camera
_WAKE_S = 0.1


class FrameStream(FrameSource):
    """The newest frame whenever one is asked for; ``dropped`` counts those that were overtaken.

    Frames whose stamp does not come after the one before count as dropped too. ``__next__`` waits ``timeout_s``.
    """

    live = True

    def __init__(
        self,
        reader: Reader,
        view: View,
        selection: Selection,
        resizer: Resizer | None = None,
        timeout_s: float = 10.0,
    ) -> None:
        super().__init__(reader, view, selection, resizer)
        self.frame_count = selection.expected(None, reader.fps)
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

    def poll(self, timeout_s: float) -> Frame | None:
        """Return the newest frame not yet delivered, waiting up to ``timeout_s`` for one; None when none came.

        Raises
        ------
        FrameSourceError : the source failed; raised after the frames that came before
        """
        if self._enough():
            return None
        with self._changed:
            self._changed.wait_for(lambda: self._newest is not None or self._ended, timeout_s)
            picture, self._newest = self._newest, None
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
            if left_s <= 0 and not self.ended:
                raise FrameSourceError(f"{self.name}: no frame for {self._timeout_s:g} s", on_the_way=True)
        raise StopIteration

    def close(self) -> None:
        """Stop reading; a decoder still waiting for its camera is left to time out."""
        self._closing.set()
        self._thread.join(_PATIENCE_S)
        with self._changed:
            self._ended = True
            self._newest = None
            self._changed.notify_all()

    def _read(self) -> None:
        """Run in the thread: put every wanted picture where the consumer finds it, over the one that lies there."""
        error: Exception | None = None
        try:
            for picture in self._selection.within(self._later_ones()):
                with self._changed:
                    self.dropped += self._newest is not None
                    self._newest = picture
                    self._changed.notify_all()
        except Exception as caught:  # travels to the consumer as a value: this thread has nobody to tell
            error = caught
        finally:
            self._reader.close()
            with self._changed:
                self._ended, self._error = True, error
                self._changed.notify_all()

    def _later_ones(self) -> Iterator[Picture]:
        """Yield the pictures until the stream is closed, without those whose stamps do not increase."""
        previous_s = -math.inf
        for picture in self._reader.pictures():
            if self._closing.is_set():
                return
            if picture.time_s > previous_s:
                previous_s = picture.time_s
                yield picture
            else:
                with self._changed:
                    self.dropped += 1
        if not self._closing.is_set():
            raise FrameSourceError(f"{self.name}: the stream ended", on_the_way=True)
