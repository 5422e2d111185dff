"""Readings made by hand, and a source, a network and an output that do as they are told."""

from __future__ import annotations

import numpy as np

from lobula.errors import OutputError
from lobula.frames import FrameStream
from lobula.frames.reconnect import News
from lobula.types import TRACE_DTYPE, Frame, Reading, Spikes

RATE_HZ = 30.0


def reading(time_s, collision=False, state="ok", lgmd1=0.5, lgmd2=0.5) -> Reading:
    return Reading(time_s, lgmd1, lgmd2, 0.0, 0.0, Spikes(), collision, state)


def trace(alarms, count: int, rate_hz: float = RATE_HZ, first: int = 0):
    """A trace of ``count`` frames with an alarm in each frame number of ``alarms``."""
    rows = [(i, i / rate_hz, 0.5, 0.5, 0.0, 0.0, 0, 0, 0, 0, i in alarms, "ok") for i in range(first, first + count)]
    return np.array(rows, TRACE_DTYPE)


class Network:
    """Answers with a collision in the frame numbers of ``alarms``."""

    def __init__(self, alarms=()):
        self.alarms, self.resets, self.rates_deg_s = set(alarms), 0, []

    def step(self, frame: Frame, *, yaw_rate_deg_s: float | None = None) -> Reading:
        self.rates_deg_s.append(yaw_rate_deg_s)
        return reading(frame.time_s, frame.index in self.alarms)

    def reset(self) -> None:
        self.resets += 1


class Source:
    """A recording whose script is frames, and perhaps an exception."""

    name, width, height, fps, live, dropped, damaged = "movie", 99, 72, 30.0, False, 0, 0
    frame_count = None

    def __init__(self, script):
        self.script, self.closed = list(script), 0
        self.notes: list[str] = []

    def __iter__(self):
        return self

    def __next__(self):
        if not self.script:
            raise StopIteration
        item = self.script.pop(0)
        if isinstance(item, BaseException):
            raise item
        return item

    def picture(self):
        return np.zeros((72, 99, 3), np.uint8)

    def close(self):
        self.closed += 1


class LiveSource(FrameStream):
    """A camera whose script is frames, for silence the seconds it lasts, and ``News``; time is its own ``clock``.

    ``breaks`` counts the news that the source is back or resized, as a stream does.
    """

    def __init__(self, script, clock):
        self.script, self.clock = list(script), clock
        self.breaks, self._news = 0, []
        self.name, self.width, self.height, self.fps, self.dropped = "camera", 99, 72, 30.0, 2
        self.frame_count = None

    damaged, notes = 0, ()

    @property
    def ended(self):
        return not self.script

    def news(self):
        news, self._news = self._news, []
        return news

    def poll(self, timeout_s):
        item = self.script.pop(0)
        if isinstance(item, News):
            self._news.append(item._replace(at_s=self.clock.now))
            self.breaks += item.phase in ("back", "resized")
            return None
        if isinstance(item, float):
            self.clock.now += item
            return None
        self.clock.now += 1 / RATE_HZ
        return item

    def picture(self):
        return np.zeros((72, 99, 3), np.uint8)

    def close(self):
        pass


class Clock:
    """Stands in for the module ``time``."""

    now = 0.0

    def monotonic(self):
        return self.now

    perf_counter = monotonic


class Sink:
    """Notes every call; fails in those named in ``fails``."""

    def __init__(self, fails=(), error=OutputError):
        self.fails, self.error, self.calls, self.summary = fails, error, [], None

    def _called(self, name):
        self.calls.append(name)
        if name in self.fails:
            raise self.error(f"cannot {name}")

    def open(self, header):
        self._called("open")

    def frame(self, index, reading, picture):
        self._called("frame")

    def event(self, record):
        self._called("event")

    def close(self, summary):
        self.summary = summary
        self._called("close")


def frames(count: int, first: int = 0, value=None):
    """Frames at 30 Hz; every picture differs from the one before unless ``value`` fixes its grey."""
    return [
        Frame(np.full((72, 99), (i % 250) if value is None else value, np.uint8), i / RATE_HZ, i)
        for i in range(first, first + count)
    ]
