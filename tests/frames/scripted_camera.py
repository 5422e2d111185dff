"""A camera whose pictures come when the test says so."""

from __future__ import annotations

import threading
import time

import numpy as np

from lobula.frames.selection import Picture


class ScriptedCamera:
    """A reader whose pictures come when the test says so; ``None`` ends it, an exception is raised."""

    name, fps, frame_count, rotation, damaged = "camera", 30.0, None, 0, 0

    def __init__(self):
        self.first = np.zeros((72, 99), np.uint8)
        self.notes: list[str] = []
        self.closed = threading.Event()
        self._script: list[object] = []
        self._more = threading.Condition()

    def give(self, *items):
        with self._more:
            self._script += items
            self._more.notify_all()

    def pictures(self, start_s=None):
        while True:
            with self._more:
                self._more.wait_for(lambda: self._script or self.closed.is_set(), 10)
                item = self._script.pop(0) if self._script else None
            if item is None:
                return
            if isinstance(item, Exception):
                raise item
            yield item

    def close(self):
        self.closed.set()


def picture(index, time_s=None):
    return Picture(np.full((72, 99), index, np.uint8), index / 30 if time_s is None else time_s, index)


def wait_until(true):
    deadline = time.monotonic() + 10
    while not true():
        assert time.monotonic() < deadline
        time.sleep(0.002)
