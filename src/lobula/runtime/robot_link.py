"""One connection to a robot, as a reader of frames is one connection to a camera."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator

from ..frames.selection import Picture
from ..telemetry import Decoder, RobotHello, RobotReading, SerialLine

_WAKE_S = 0.1


class RobotLink:
    """Gives each reading of one open line as a ``Picture`` whose data it is; hellos go to ``hear`` at once.

    Stamps are the robot's own, unwrapped and set in place by whoever sees all connections.
    """

    first = None
    fps = 0.0
    frame_count: int | None = None
    rotation = 0

    def __init__(
        self, line: SerialLine, name: str, stopping: threading.Event, hear: Callable[[RobotHello], None]
    ) -> None:
        self.name = name
        self._line = line
        self._stopping = stopping
        self._hear = hear
        self._decoder = Decoder()

    @property
    def received(self) -> int:
        """Bytes that came."""
        return self._decoder.received

    @property
    def damaged(self) -> int:
        """Frames that did not come as they were sent."""
        return self._decoder.damaged

    @property
    def notes(self) -> list[str]:
        """What is odd about frames that did."""
        return list(self._decoder.notes)

    def pictures(self, start_s: float | None = None) -> Iterator[Picture]:
        """Yield readings until the end is asked for.

        Raises
        ------
        FrameSourceError : the device went away
        """
        count = 0
        while not self._stopping.is_set():
            data = self._line.read(_WAKE_S)
            arrived_s = time.monotonic()
            for message in self._decoder.feed(data):
                if isinstance(message, RobotReading):
                    yield Picture(message, message.time_ms / 1000, count, arrived_s)
                    count += 1
                else:
                    self._hear(message)

    def close(self) -> None:
        """Let go of the line."""
        self._line.close()
