"""A robot that decides by itself and says so over a serial line: every reading of it, in order, as long as it talks."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace
from types import TracebackType
from typing import Self, cast

from ..errors import FrameSourceError
from ..frames.reconnect import KEPT_NEWS, News, Reconnecting
from ..frames.selection import Picture, Selection
from ..frames.timeline import Timeline
from ..telemetry import Action, Port, RobotHello, RobotReading, SerialLine, Succession
from ..types import Reading
from .robot_link import RobotLink

MOST_WAITING = 4096
"""Readings that wait while an output is slow, two minutes at 30 Hz; then the oldest go, and count as dropped."""

_PATIENCE_S = 1.0  # how long close() waits for the thread


@dataclass(frozen=True, slots=True)
class RobotFrame:
    """A reading of the robot in its place: ``index`` counts its pictures, ``reading.time_s`` its time, both from 0.

    ``step_s`` is how long its network took, 0 where it does not say; ``action`` what its wheels do, None without any.
    """

    index: int
    reading: Reading
    step_s: float
    action: Action | None

    @property
    def time_s(self) -> float:
        """The robot's own time, s."""
        return self.reading.time_s


class RobotStream:
    """The readings of one robot. A thread reads the line; ``poll`` gives what it found, one after the other.

    Parameters
    ----------
    port : where it is connected
    selection : which readings are wanted
    timeout_s : how long to wait for the robot to say what it is
    reconnect_s : how long to look for a port that went away; 0 not at all, infinity for ever

    Attributes are those of a frame source; ``hello``, what the robot said of itself first; ``last``, the reading that
    was delivered last, or None.

    Raises
    ------
    FrameSourceError : the port cannot be opened, or no robot says what it is in time
    """

    live = True
    frame_count: int | None

    def __init__(
        self, port: Port, selection: Selection, *, timeout_s: float = 10.0, reconnect_s: float = math.inf
    ) -> None:
        self.name = f"serial:{port.path}"
        self.hello: RobotHello
        self._selection = selection
        self._closing = threading.Event()
        self._changed = threading.Condition()
        self._waiting: deque[Picture | News] = deque()
        self._told: deque[News] = deque(maxlen=KEPT_NEWS)
        self._heard: RobotHello | None = None
        self._succession = Succession()
        self._overtaken = self._delivered = 0
        self.last: RobotFrame | None = None
        self._ended = False
        self._error: Exception | None = None

        def connected() -> RobotLink:
            return RobotLink(SerialLine(port), self.name, self._closing, self._hear)

        first = connected()
        self._link = Reconnecting(first, connected, reconnect_s)
        self._thread = threading.Thread(target=self._read, name=f"lobula {self.name}", daemon=True)
        self._thread.start()
        try:
            self.hello = self._introduced(first, port, timeout_s)
        except BaseException:
            self.close()
            raise
        self.width, self.height, self.fps = self.hello.width, self.hello.height, self.hello.rate_hz
        self.frame_count = selection.expected(None, self.fps)

    @property
    def dropped(self) -> int:
        """Readings that the robot made and that are not delivered: lost on the line, or overtaken here."""
        return self._succession.lost + self._overtaken

    @property
    def damaged(self) -> int:
        """Frames of the line that did not come as they were sent."""
        return self._link.damaged

    @property
    def notes(self) -> list[str]:
        """Lines for the user about what is odd but no error."""
        return self._link.notes

    @property
    def ended(self) -> bool:
        """True when no further reading will come."""
        with self._changed:
            return self._enough() or (self._ended and not self._waiting and self._error is None)

    def news(self) -> list[News]:
        """Return what became of the robot and its line since the last call and before the last reading."""
        news = sorted(self._told, key=lambda one: one.at_s)
        self._told.clear()
        return news

    def poll(self, timeout_s: float) -> RobotFrame | None:
        """Return the oldest reading not yet delivered, waiting up to ``timeout_s`` for one; None when none came.

        Raises
        ------
        FrameSourceError : the line broke and is not to be opened again, or in vain; raised after what came before
        """
        if self._enough():
            return None
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._ended, timeout_s)
            picture: Picture | None = None
            while self._waiting and picture is None:
                item = self._waiting.popleft()
                if isinstance(item, News):
                    self._told.append(item)
                else:
                    picture = item
            self._told += self._link.news(math.inf if picture is None else picture.connection)
            if picture is None and self._error is not None:
                error, self._error = self._error, None
                raise error
        if picture is None:
            return None
        self._delivered += 1
        self.last = _in_place(picture)
        return self.last

    def close(self) -> None:
        """Stop reading."""
        self._link.stop()
        self._closing.set()
        self._thread.join(_PATIENCE_S)
        with self._changed:
            self._ended = True
            self._waiting.clear()
            self._changed.notify_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _enough(self) -> bool:
        return self._delivered == self._selection.max_frames

    def _introduced(self, link: RobotLink, port: Port, timeout_s: float) -> RobotHello:
        """Wait for the first hello; what it lacks tells what is wrong."""
        with self._changed:
            self._changed.wait_for(lambda: self._heard is not None or self._ended, timeout_s)
            if self._heard is not None:
                return self._heard
            if self._error is not None:
                raise FrameSourceError(str(self._error)) from self._error
            waiting = bool(self._waiting)
        where = f"{self.name}: in {timeout_s:g} s"
        if waiting:
            raise FrameSourceError(f"{where} readings but no hello: the robot must say what it is, once a second or so")
        if link.received:
            odd = f"; {link.notes[0]}" if link.notes else ""
            raise FrameSourceError(
                f"{where} {link.received} bytes and no frame among them: {port.baud} baud must be the robot's rate, "
                f"and frames of docs/telemetry.md what it sends{odd}"
            )
        raise FrameSourceError(f"{where} nothing came: must be a robot that sends, on the line from its TX")

    def _hear(self, hello: RobotHello) -> None:
        """Take a hello; called by the thread."""
        with self._changed:
            before, self._heard = self._heard, hello
            if before is not None and before != hello:
                facts = {"preset": hello.preset, "settings_hash": hello.settings_hash}
                self._waiting.append(News("settings", time.monotonic(), facts))
            self._changed.notify_all()

    def _read(self) -> None:
        """Run in the thread: queue every wanted reading."""
        error: Exception | None = None
        try:
            for picture in self._selection.within(self._placed()):
                with self._changed:
                    self._waiting.append(picture)
                    if len(self._waiting) > MOST_WAITING:
                        self._overtaken += isinstance(self._waiting.popleft(), Picture)
                    self._changed.notify_all()
        except Exception as caught:  # travels to the consumer as a value: this thread has nobody to tell
            error = None if self._closing.is_set() else caught
        finally:
            self._link.close()
            with self._changed:
                self._ended, self._error = True, error
                self._changed.notify_all()

    def _placed(self) -> Iterator[Picture]:
        """Yield the readings in their places, over restarts and connections."""
        timeline, connection = Timeline(), 1
        for picture in self._link.pictures():
            if picture.connection != connection:
                connection = picture.connection
                self._succession.connect()
                timeline.connect()
            place = self._succession.place(picture.data)
            if place is None:
                continue
            if place.restarted:
                timeline.connect()
            assert picture.arrived_s is not None  # a link stamps what it reads
            time_s = timeline.place(place.stamp_s, picture.arrived_s)
            if time_s is None:
                self._overtaken += 1
                continue
            if place.restarted:
                with self._changed:
                    self._waiting.append(News("restarted", time.monotonic(), {}, connection))
            yield replace(picture, time_s=time_s, index=place.number)


def _in_place(picture: Picture) -> RobotFrame:
    told = cast(RobotReading, picture.data)
    reading = Reading(picture.time_s, *told.potentials, told.spikes, told.collision, told.state)
    return RobotFrame(picture.index, reading, told.step_us / 1e6, told.action)
